//! Each law has its residual when a state, a mode or a force is corrupted by hand, and holds before.

use super::{Law, LawElement, LawResidual, ResidualKind};
use crate::actuation::{Motor, MotorMode};
use crate::constraint::LoopJointKind;
use crate::contact::Material;
use crate::geometry::{MassProperties, Shape, Surface};
use crate::joint::JointKind;
use crate::model::{BodySpec, JointSpec, LoopJointSpec, Model, ModelBuilder, NodeId};
use crate::signal::Signal;
use crate::spatial::{Pose, Vec3};
use crate::state::State;
use crate::world::{MethodKind, World};

const H: f64 = 0.01;

fn slider(axis: [f64; 3]) -> JointSpec {
    JointSpec::new(JointKind::Prismatic { axis })
}

/// A cart of 2 kg on a slider along x.
fn cart(spec: JointSpec) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let slide = b.joint("slide", NodeId::WORLD, Pose::identity(), spec);
    let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
    b.body("cart", slide, Pose::identity(), BodySpec { mass });
    b.build().unwrap().0
}

/// A world after ten ticks from `x`.
fn ran(model: Model<f64>, x: State<f64>) -> World {
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    for k in 0..10 {
        world.advance(f64::from(k) * H, H).unwrap();
    }
    world
}

fn residual(world: &mut World, law: Law) -> LawResidual {
    *world.observe(10.0 * H).law_residuals().get(law).expect("something is subject to the law")
}

/// Residual of a law in the forces as they stand, without solving for them.
fn residual_of_forces(world: &World, law: Law) -> LawResidual {
    *world.observation(10.0 * H).law_residuals().get(law).expect("something is subject to the law")
}

#[test]
fn an_open_loop_is_found_at_both_levels() {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let x = b.joint("x", NodeId::WORLD, Pose::identity(), slider([1.0, 0.0, 0.0]));
    let z = b.joint("z", x, Pose::identity(), slider([0.0, 0.0, 1.0]));
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
    let bob = b.body("bob", z, Pose::identity(), BodySpec { mass });
    b.body("carrier", x, Pose::identity(), BodySpec { mass });
    let (kind, poses) = (LoopJointKind::Distance(1.0), [Pose::identity(); 2]);
    b.loop_joint("string", LoopJointSpec { kind, ends: [bob, NodeId::WORLD], poses });
    let model = b.build().unwrap().0;
    let mut start = State::new(&model);
    start.q.copy_from_slice(&[0.6, -0.8]);
    let mut world = ran(model, start);
    for law in [Law::LoopPosition, Law::LoopVelocity] {
        assert!(residual(&mut world, law).relative() < 1e-11, "{law:?}");
    }
    let before = world.state.clone();
    world.state.v[0] += 1e-6;
    let found = residual(&mut world, Law::LoopVelocity);
    assert!(found.value > 1e-7 && found.value < 1e-6, "{found:?}");
    world.state = before;
    world.state.q[0] += 1e-6;
    let found = residual(&mut world, Law::LoopPosition);
    assert!(found.value > 1e-7 && found.value < 1e-6, "{found:?}");
    assert_eq!((found.element.name(world.model()), found.kind), ("string".to_owned(), ResidualKind::Length));
}

#[test]
fn a_passed_limit_is_found() {
    let model = cart(JointSpec { limits: vec![(-0.5, 0.5)], ..slider([1.0, 0.0, 0.0]) });
    let x = State::new(&model);
    let mut world = ran(model, x);
    assert_eq!(residual(&mut world, Law::JointLimit).value, 0.0);
    world.state.q[0] = -0.625;
    let found = residual(&mut world, Law::JointLimit);
    assert_eq!((found.value, found.element.name(world.model()).as_str()), (0.125, "slide"));
}

/// A ball on the floor.
fn ball() -> World {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let material = Material { friction: 0.5, ..Material::default() };
    b.collider(NodeId::WORLD, Pose::identity(), Surface::HalfSpace, material);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let shape = Shape::Sphere { radius: 0.25 };
    let it = b.body("ball", free, Pose::identity(), BodySpec { mass: shape.mass_properties(1000.0) });
    b.collider(it, Pose::translation(Vec3::zero()), Surface::Solid(shape), material);
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.q[2] = 0.25;
    ran(model, x)
}

#[test]
fn penetration_adhesion_and_friction_beyond_the_cone_are_found() {
    let mut world = ball();
    for law in [Law::Penetration, Law::NormalForce, Law::FrictionCone] {
        assert!(residual(&mut world, law).relative() < 1e-9, "{law:?}");
    }
    let c = world.mechanism.constraints.as_deref_mut().unwrap();
    let (normal, friction) = (c.blocks[0].row, c.blocks[0].groups[0].unwrap().row);
    let weight = c.lambda[normal];
    c.lambda[friction] = 0.75 * weight;
    let found = residual_of_forces(&world, Law::FrictionCone);
    assert!((found.value - 0.25).abs() < 1e-6, "{found:?}");
    assert!(matches!(found.element, LawElement::Pair(0)));
    world.mechanism.constraints.as_deref_mut().unwrap().lambda[normal] = -weight;
    assert!((residual_of_forces(&world, Law::NormalForce).value - 1.0).abs() < 1e-6);
    world.state.q[2] -= 0.0625;
    assert!((residual(&mut world, Law::Penetration).value - 0.0625).abs() < 1e-9);
}

/// A cart whose velocity motor has to hold 3 N; its limit.
fn driven(max_torque: f64) -> World {
    let motor = Motor { max_torque, ..Motor::new(MotorMode::Velocity) };
    let spec = JointSpec { motor: vec![motor], torque: vec![Signal::Constant(-3.0)], ..slider([1.0, 0.0, 0.0]) };
    let model = cart(spec);
    let mut x = State::new(&model);
    x.commands[0] = 0.5;
    ran(model, x)
}

#[test]
fn a_drive_in_a_wrong_mode_is_found() {
    let mut world = driven(1000.0);
    for law in [Law::DriveVelocity, Law::DriveForce] {
        assert!(residual(&mut world, law).relative() < 1e-11, "{law:?}");
    }
    world.state.v[0] += 0.25;
    let found = residual(&mut world, Law::DriveVelocity);
    assert_eq!((found.value, found.kind, found.element), (0.25, ResidualKind::Speed, LawElement::Drive(0)));
    // its limit does not suffice: it is saturated upwards, and slips downwards
    let mut world = driven(1.0);
    assert_eq!((world.state.drives[0], residual(&mut world, Law::DriveMode).value), (1.0, 0.0));
    world.state.drives[0] = -1.0;
    assert!(residual(&mut world, Law::DriveMode).value > 0.5);
    world.state.drives[0] = 0.0;
    let found = residual(&mut world, Law::DriveForce);
    assert!((found.value - 2.0 / 4.0).abs() < 1e-12, "{found:?}");
}

#[test]
fn drives_are_not_audited_after_a_change_from_outside_until_the_next_tick() {
    let mut world = driven(1.0);
    world.state.drives[0] = -1.0;
    world.mark_changed();
    assert_eq!(world.observe(10.0 * H).law_residuals().get(Law::DriveMode), None);
    world.advance(10.0 * H, H).unwrap();
    assert_eq!(world.observe(11.0 * H).law_residuals().get(Law::DriveMode).map(|found| found.value), Some(0.0));
}

#[test]
fn numbers_that_are_not_finite_are_counted() {
    let mut world = driven(1.0);
    assert_eq!(residual(&mut world, Law::Finiteness).value, 0.0);
    world.state.v[0] = f64::NAN;
    let found = residual(&mut world, Law::Finiteness);
    assert!(found.value >= 1.0 && found.element == LawElement::Dof(0), "{found:?}");
}

//! World k of a batch has the bits it would have alone.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;

use crate::random::Random;

const METHODS: [MethodKind; 3] = [MethodKind::SemiImplicitEuler, MethodKind::Rk4, MethodKind::Implicit];

/// An arm with every kind of joint whose numbers depend on `r`; `friction` makes worlds want sub-steps of their own.
fn arm(r: &mut Random, friction: f64) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let kinds = [
        JointKind::Revolute { axis: [0.0, 0.0, -1.0] },
        JointKind::Revolute { axis: [0.0, 1.0, 0.0] },
        JointKind::Prismatic { axis: [1.0, 0.0, 0.0] },
        JointKind::Ball,
        JointKind::Screw { axis: [0.0, 0.0, 1.0], pitch: 0.1 },
        JointKind::Free,
    ];
    let mut parent = NodeId::WORLD;
    for (i, kind) in kinds.into_iter().enumerate() {
        let mut spec = JointSpec::new(kind);
        if i == 0 {
            spec.motor = vec![Motor::new(MotorMode::Velocity)];
        }
        if i == 1 {
            spec.spring = vec![(5.0 + r.unit(), r.unit())];
            spec.damping = vec![0.2 + 0.1 * r.unit()];
            spec.friction = vec![friction.into()];
            let sine = Signal::Sine { amplitude: r.unit(), angular_frequency: 3.0, phase: r.unit(), offset: 0.0 };
            spec.torque = vec![sine];
        }
        let at = Pose::translation(Vec3([0.1 + 0.01 * r.unit(), 0.0, 0.2]));
        let joint = b.joint(&format!("j{i}"), parent, at, spec);
        let mass = Shape::Cuboid { size: [0.1, 0.2, 0.3] }.mass_properties(100.0 + 10.0 * r.unit());
        parent = b.body(&format!("b{i}"), joint, Pose::translation(Vec3([0.1, 0.0, 0.0])), BodySpec { mass });
    }
    b.build().unwrap().0
}

fn worlds(friction: f64) -> Vec<BatchWorld> {
    let mut r = Random::new(7);
    (0..19)
        .map(|_| {
            let model = arm(&mut r, friction);
            let mut x = State::new(&model);
            x.v.iter_mut().for_each(|v| *v = r.unit());
            x.q[1] = r.unit();
            let mut world = BatchWorld::new(model, x);
            world.commands = (0..40).map(|k| if k < 20 { r.unit() } else { 0.3 }).collect();
            world
        })
        .collect()
}

#[test]
fn a_lane_has_the_bits_of_the_world_alone() {
    for friction in [0.0, 0.05] {
        for method in METHODS {
            let settings = BatchSettings { method, h: 0.004, n_steps: 40, record_every: 4 };
            let (mut together, mut alone) = (worlds(friction), worlds(friction));
            advance(&mut together, &settings).unwrap();
            alone.iter_mut().for_each(|w| advance_alone(w, &settings));
            for (a, b) in together.iter().zip(&alone) {
                assert_eq!(a.record.len(), 11 * (a.model.n_q() + a.model.n_v()));
                let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&a.record), bits(&b.record), "{method:?} {friction}");
                assert_eq!((bits(&a.state.q), a.state.tick), (bits(&b.state.q), b.state.tick));
            }
        }
    }
}

#[test]
fn a_world_that_blows_up_leaves_its_neighbours_alone() {
    let settings = BatchSettings { method: MethodKind::Rk4, h: 0.004, n_steps: 20, record_every: 0 };
    let (mut with, mut without) = (worlds(0.0), worlds(0.0));
    with[3].state.v[1] = 1e200;
    advance(&mut with, &settings).unwrap();
    advance(&mut without, &settings).unwrap();
    assert!(with[3].stop.is_some());
    for k in (0..19).filter(|k| *k != 3) {
        assert_eq!(with[k].state, without[k].state);
    }
}

#[test]
fn worlds_of_another_structure_are_refused() {
    let mut mixed = worlds(0.0);
    let mut b = ModelBuilder::new([0.0; 3]);
    let joint = b.joint("j", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Ball));
    let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1.0);
    b.body("b", joint, Pose::identity(), BodySpec { mass });
    let other = b.build().unwrap().0;
    mixed[1] = BatchWorld::new(other.clone(), State::new(&other));
    let settings = BatchSettings { method: MethodKind::Rk4, h: 0.004, n_steps: 1, record_every: 0 };
    let message = advance(&mut mixed, &settings).unwrap_err().to_string();
    assert!(message.contains("links and joints"), "{message}");
}

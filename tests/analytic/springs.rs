//! Springs of ball and free joints: closed forms, and torques as the gradient of the stored energy.

use sincro_dynamics::energy::energy_at;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId};
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use sincro_math::elementary::sin_cos;

use crate::mechanisms::run;

fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// A body of 2 kg on a joint, without gravity; inertia 0.5, 0.7, 0.9 kg·m².
fn sprung(kind: JointKind, spring: Vec<(f64, f64)>) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    // turned: the axes of joint and world differ
    let pose = Pose { rot: Quat::exp(Vec3([0.4, -0.2, 0.9])).matrix(), pos: Vec3([0.1, 0.2, 0.3]) };
    let joint = b.joint("joint", NodeId::WORLD, pose, JointSpec { spring, ..JointSpec::new(kind) });
    let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.5, 0.0, 0.0, 0.7, 0.0, 0.9] };
    b.body("body", joint, Pose::identity(), BodySpec { mass });
    b.build().unwrap().0
}

#[test]
fn a_body_on_a_ball_joint_swings_about_a_principal_axis_as_a_torsion_pendulum() {
    let (stiffness, rest, angle) = (3.0, 0.2, 2.5);
    let model = sprung(JointKind::Ball, vec![(1.0, 0.0), (stiffness, rest), (2.0, 0.0)]);
    for (kind, tolerance) in [(MethodKind::DormandPrince, 1e-8), (MethodKind::Stiff, 1e-8), (MethodKind::Rk4, 1e-6)] {
        let mut x = State::new(&model);
        Quat::exp(Vec3([0.0, rest + angle, 0.0])).write(&mut x.q);
        let mut world = World::new(model.clone(), x, kind, 1e-11, 1e-3);
        run(&mut world, 0.01, 300);
        let expected = rest + angle * cos((stiffness / 0.7_f64).sqrt() * 3.0);
        let found = Quat::from_slice(&world.state.q).log();
        assert!((found[1] - expected).abs() < tolerance, "{kind:?} {} {expected}", found[1]);
        assert!(found[0].abs() + found[2].abs() < 1e-12);
    }
}

#[test]
fn a_free_body_swings_along_each_axis_of_its_joint_frame() {
    let (stiffness, rest) = ([10.0, 20.0, 30.0], [0.1, -0.2, 0.3]);
    let mut spring = vec![(0.0, 0.0); 3];
    spring.extend(stiffness.into_iter().zip(rest));
    let model = sprung(JointKind::Free, spring);
    let mut x = State::new(&model);
    x.q[..3].copy_from_slice(&[0.5, 0.4, -0.3]);
    // it turns meanwhile: forces are along the joint frame all the same
    x.v[2] = 1.0;
    let start = x.q.clone();
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    run(&mut world, 0.01, 200);
    for k in 0..3 {
        let expected = rest[k] + (start[k] - rest[k]) * cos((stiffness[k] / 2.0).sqrt() * 2.0);
        assert!((world.state.q[k] - expected).abs() < 1e-8, "{k}: {} {expected}", world.state.q[k]);
    }
}

#[test]
fn torques_are_the_gradient_of_the_stored_energy() {
    let spring = vec![(5.0, 0.3), (2.0, 0.0), (1.0, -0.4), (10.0, 0.1), (20.0, 0.0), (30.0, -0.2)];
    let model = sprung(JointKind::Free, spring);
    let mut scratch = Scratch::new(&model);
    for (phi, at) in
        [([0.01, -0.02, 0.03], [0.0; 3]), ([1.2, -0.7, 2.0], [0.3, -0.4, 0.5]), ([3.0, 0.1, 0.2], [1.0; 3])]
    {
        let turn = Quat::exp(Vec3(phi));
        let q = |dof: usize, step: f64| {
            let mut delta = [0.0; 6];
            delta[dof] = step;
            let moved = turn.mul(&Quat::exp(Vec3([delta[0], delta[1], delta[2]])));
            let along = turn.matrix().mul_vec(Vec3([delta[3], delta[4], delta[5]]));
            let mut q = vec![0.0; 7];
            (0..3).for_each(|k| q[k] = at[k] + along[k]);
            moved.write(&mut q[3..]);
            q
        };
        for dof in 0..6 {
            let mut energy = |step: f64| energy_at(&model, &q(dof, step), &[0.0; 6], &mut scratch).potential;
            // central differences of order 4
            let h = 1e-3;
            let slope = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
            let torque = model.spring_torque(dof, &q(dof, 0.0));
            assert!((torque + slope).abs() < 1e-9, "{phi:?} {dof}: {torque} {}", -slope);
        }
    }
}

#[test]
fn friction_on_the_axes_of_a_ball_joint_stops_each_by_itself() {
    let mut b = ModelBuilder::new([0.0; 3]);
    let friction = vec![0.1.into(), 0.2.into(), 0.3.into()];
    let joint =
        b.joint("joint", NodeId::WORLD, Pose::identity(), JointSpec { friction, ..JointSpec::new(JointKind::Ball) });
    let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.5, 0.0, 0.0, 0.7, 0.0, 0.9] };
    b.body("body", joint, Pose::identity(), BodySpec { mass });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.v[1] = 1.0;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    run(&mut world, 0.01, 400);
    // I ω²/(2 τ)
    let angle = Quat::from_slice(&world.state.q).log()[1];
    assert_eq!(world.state.v, [0.0; 3]);
    assert!((angle - 0.7 / 0.4).abs() < 1e-9, "{angle}");
}

//! Whitened rows against the Delassus matrix, islands, and the laws of contact on the result of sweeps.

use crate::mechanism::Mechanism;
use crate::mechanism::constraints::ActivationRule;
use crate::prelude::*;
use crate::recursions::kinematics;

const EDGE: f64 = 0.2;

fn boxes_and_an_arm(rough: Material) -> (Model<f64>, State<f64>) {
    let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    builder.collider(NodeId::WORLD, Pose::identity(), Surface::HalfSpace, rough);
    let mass =
        |mass: f64| MassProperties { mass, center_of_mass: [0.0; 3], inertia: [0.01, 0.0, 0.0, 0.01, 0.0, 0.01] };
    let mut q = Vec::new();
    // an arm whose last link is a box that lies on the first free one
    let spec = |axis: [f64; 3]| JointSpec::new(JointKind::Revolute { axis });
    let shoulder = builder.joint("shoulder", NodeId::WORLD, at(0.0, 0.0, 1.5 * EDGE), spec([0.0, 1.0, 0.0]));
    let upper = builder.body("upper", shoulder, Pose::identity(), BodySpec { mass: mass(2.0) });
    let elbow = builder.joint("elbow", upper, at(0.5, 0.0, 0.0), spec([0.0, 0.0, 1.0]));
    let fore = builder.body("fore", elbow, Pose::identity(), BodySpec { mass: mass(1.0) });
    let cube = || Surface::Solid(Shape::Cuboid { size: [EDGE; 3] });
    builder.collider(fore, Pose::identity(), cube(), rough);
    q.extend([0.0, 0.0]);
    for k in 0..3 {
        let joint = builder.joint(&format!("air{k}"), NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let body = builder.body(&format!("box{k}"), joint, Pose::identity(), BodySpec { mass: mass(1.0 + k as f64) });
        builder.collider(body, Pose::identity(), cube(), rough);
        q.extend([0.55 + 0.6 * k as f64, 0.02, 0.5 * EDGE, 1.0, 0.0, 0.0, 0.0]);
    }
    let (model, _) = builder.build().unwrap();
    let mut state = State::new(&model);
    state.q.copy_from_slice(&q);
    (model, state)
}

fn at(x: f64, y: f64, z: f64) -> Pose<f64> {
    Pose { pos: Vec3([x, y, z]), ..Pose::identity() }
}

#[test]
fn products_of_whitened_rows_are_the_delassus_matrix() {
    let rough = Material { friction: 0.5, rolling_friction: 0.01, ..Material::default() };
    let (model, state) = boxes_and_an_arm(rough);
    let mut mechanism = Mechanism::new(model, false);
    let mut y = vec![0.0; crate::integrate::System::dim(&mechanism)];
    mechanism.load(&state, &mut y);
    mechanism.detect_contacts(&state.v, ActivationRule::All);
    mechanism.factor();
    let Mechanism { model, scratch, constraints, .. } = &mut mechanism;
    let c = constraints.as_deref_mut().unwrap();
    kinematics::chain_poses(model, scratch);
    c.motions.place(model, scratch, &state.v);
    c.assemble(model, &state.q, &state.v, scratch, false);
    c.assemble_delassus(model, scratch);
    let (m, n) = (c.rows.len(), model.n_v());
    assert!(m > 60, "the boxes lie on the floor and the arm on one of them: {m} rows");
    let rows: Vec<Vec<f64>> = c
        .rows
        .iter()
        .map(|row| {
            let mut whitened = vec![0.0; n];
            c.delassus_factors
                .factor_row(model, c.motions.columns(), row, |dof, value| whitened[dof as usize] += value);
            whitened
        })
        .collect();
    for i in 0..m {
        for j in 0..m {
            let product: f64 = rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum();
            assert!((product - c.a[i * m + j]).abs() < 1e-12, "{i} {j}: {product} for {}", c.a[i * m + j]);
        }
    }
}

#[test]
fn sweeps_and_the_active_set_find_the_same_motion() {
    // three boxes and an arm that lies on one of them, thrown: solved by sweeps as one problem, and box by box directly
    let rough = Material { friction: 0.5, ..Material::default() };
    let (model, mut state) = boxes_and_an_arm(rough);
    let n = model.n_v();
    for k in 0..3 {
        // straight ahead and without rolling friction: else how the corners share the weight has several answers
        state.v[2 + 6 * k + 3] = 0.2 + 0.4 * k as f64;
    }
    let mut world = World::new(model, state.clone(), MethodKind::SemiImplicitEuler, 1e-6, 1e-3);
    world.initialize(0.0);
    let mut single = Vec::new();
    for k in 1..3 {
        let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
        builder.collider(NodeId::WORLD, Pose::identity(), Surface::HalfSpace, rough);
        let joint = builder.joint("air", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let inertia = [0.01, 0.0, 0.0, 0.01, 0.0, 0.01];
        let mass = MassProperties { mass: 1.0 + f64::from(k), center_of_mass: [0.0; 3], inertia };
        let body = builder.body("box", joint, Pose::identity(), BodySpec { mass });
        builder.collider(body, Pose::identity(), Surface::Solid(Shape::Cuboid { size: [EDGE; 3] }), rough);
        let (model, _) = builder.build().unwrap();
        let mut alone = State::new(&model);
        let of = 2 + 7 * k as usize;
        alone.q.copy_from_slice(&state.q[of..of + 7]);
        let of = 2 + 6 * k as usize;
        alone.v.copy_from_slice(&state.v[of..of + 6]);
        let mut world = World::new(model, alone, MethodKind::SemiImplicitEuler, 1e-6, 1e-3);
        world.initialize(0.0);
        single.push(world);
    }
    for step in 0..300 {
        let t = f64::from(step) * 1e-3;
        world.advance(t, 1e-3).unwrap();
        for (k, alone) in (1..).zip(&mut single) {
            alone.advance(t, 1e-3).unwrap();
            let together = &world.state.v[2 + 6 * k..8 + 6 * k];
            for (x, y) in together.iter().zip(&alone.state.v) {
                assert!((x - y).abs() < 2e-5, "step {step}, box {k}: {together:?} for {:?}", alone.state.v);
            }
        }
    }
    let report = world.solver_report().unwrap();
    assert!(report.islands > 800 && report.unconverged_islands == 0, "{report:?}");
    assert!(single.iter().all(|world| world.solver_report().unwrap().islands == 0));
    assert!(world.state.v[n - 6..].iter().all(|v| v.abs() < 1e-3), "the last box has come to rest");
}

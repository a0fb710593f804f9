//! Bushings: closed forms of one axis, energy, momentum, invariance, agreement of methods, lanes.

use sincro_dynamics::actuation::Bushing;
use sincro_dynamics::actuation::bushing::LinkFrame;
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::energy::{energy_at, momentum};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::{
    BodySpec, BushingSpec, JointSpec, LoopJointSpec, MassProperties, Model, ModelBuilder, NodeId,
};
use sincro_dynamics::spatial::{Motion, Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::stiffness::{StiffElement, stiffest};
use sincro_dynamics::world::{MethodKind, World};
use sincro_math::Real;
use sincro_math::random::SplitMix64;

use crate::mechanisms::{ALL, distance, run};

fn body(mass: f64, [x, y, z]: [f64; 3]) -> BodySpec {
    BodySpec { mass: MassProperties { mass, center_of_mass: [0.0; 3], inertia: [x, 0.0, 0.0, y, 0.0, z] } }
}

/// A body of 2 kg with moments 0.3, 0.5 and 0.7 kg·m² on a bushing to the world at its centre of mass, without gravity.
fn mounted(stiffness: [f64; 6], damping: [f64; 6]) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let own = b.body("body", free, Pose::identity(), body(2.0, [0.3, 0.5, 0.7]));
    let (ends, poses) = ([NodeId::WORLD, own], [Pose::identity(), Pose::identity()]);
    b.bushing("mount", BushingSpec { ends, poses, stiffness, damping });
    b.build().unwrap().0
}

const INERTIAS: [f64; 6] = [2.0, 2.0, 2.0, 0.3, 0.5, 0.7];

/// Coordinate of a damped oscillator m ẍ + c ẋ + k x = 0 that starts at rest at `x`.
fn oscillator(m: f64, c: f64, k: f64, x: f64, t: f64) -> f64 {
    let decay = 0.5 * c / m;
    let w = (k / m - decay * decay).sqrt();
    let (sin, cos) = Real::sin_cos(w * t);
    x * libm::exp(-decay * t) * (cos + decay / w * sin)
}

#[test]
fn each_axis_swings_as_a_damped_oscillator() {
    let stiffness = [800.0, 450.0, 200.0, 30.0, 60.0, 110.0];
    let damping = [3.0, 0.0, 5.0, 0.2, 0.0, 0.5];
    let model = mounted(stiffness, damping);
    for axis in 0..6 {
        // rotations about one principal axis are linear for any angle below π
        let start = if axis < 3 { 0.4 } else { 2.5 };
        let mut x = State::new(&model);
        if axis < 3 {
            x.q[axis] = start;
        } else {
            Quat::exp(Vec3::along(axis - 3, start)).write(&mut x.q[3..7]);
        }
        let mut world = World::new(model.clone(), x, MethodKind::DormandPrince, 1e-11, 0.01);
        run(&mut world, 0.01, 150);
        let q = &world.state.q;
        let found = if axis < 3 { q[axis] } else { Quat::from_slice(&q[3..7]).log()[axis - 3] };
        let expected = oscillator(INERTIAS[axis], damping[axis], stiffness[axis], start, 1.5);
        assert!((found - expected).abs() < 1e-9, "{axis}: {found} for {expected}");
    }
}

#[test]
fn the_stiffest_axis_is_found() {
    for axis in 0..6 {
        let mut stiffness = [10.0; 6];
        stiffness[axis] = 1e5;
        let model = mounted(stiffness, [0.0; 6]);
        let found = stiffest(&model, &State::new(&model)).unwrap();
        assert!(matches!(found.element, StiffElement::Bushing(0)));
        assert!((found.rate - (1e5 / INERTIAS[axis]).sqrt()).abs() < 1e-9 * found.rate, "{axis}: {found:?}");
    }
}

/// Uniform numbers from −`scale` to `scale`.
fn numbers<const N: usize>(random: &mut SplitMix64, scale: f64) -> [f64; N] {
    core::array::from_fn(|_| scale * (2.0 * random.unit() - 1.0))
}

fn pose(random: &mut SplitMix64, length: f64) -> Pose<f64> {
    Pose { rot: Quat::exp(Vec3(numbers(random, 1.2))).matrix(), pos: Vec3(numbers(random, length)) }
}

#[test]
fn the_force_is_minus_the_gradient_of_the_energy() {
    let mut random = SplitMix64::new(7);
    for _ in 0..200 {
        let ends = core::array::from_fn(|k| LinkFrame { link: Some(k), pose: pose(&mut random, 0.5) });
        let stiffness = numbers::<6>(&mut random, 100.0).map(f64::abs);
        let element = Bushing { ends, stiffness, damping: [0.0; 6] };
        let poses = [pose(&mut random, 1.0), pose(&mut random, 1.0)];
        let twists: [Motion<f64>; 2] = core::array::from_fn(|_| Motion {
            ang: Vec3(numbers(&mut random, 1.0)),
            lin: Vec3(numbers(&mut random, 1.0)),
        });
        // links moved by a step of their twists
        let moved = |h: f64| {
            let pose_of = |k: usize| {
                let step = Pose { rot: Quat::exp(twists[k].ang.scale(h)).matrix(), pos: twists[k].lin.scale(h) };
                poses[k].compose(&step)
            };
            element.potential(&element.motion(|k| (twists[k], pose_of(k))))
        };
        let h = 1e-5;
        let rate = (moved(h) - moved(-h)) / (2.0 * h);
        let at = element.motion(|k| (twists[k], poses[k]));
        let force = element.elastic(&at);
        let power: f64 = (0..2).map(|k| twists[k].dot(&element.wrench(k, &at, &force, &poses[k]))).sum();
        let of_rates: f64 = force.iter().zip(at.rates).map(|(f, v)| f * v).sum();
        let scale = element.potential(&at) + 1.0;
        assert!((power + rate).abs() < 1e-7 * scale && (power - of_rates).abs() < 1e-12 * scale, "{power} {rate}");
    }
}

/// Two free bodies joined by a bushing off their centres; the world turned by `turn`, lengths by `length`, masses by
/// `mass`, and the bodies in the other order if `is_swapped`. The state moves and turns both.
fn pair(turn: &Pose<f64>, length: f64, mass: f64, is_swapped: bool) -> (Model<f64>, State<f64>) {
    let mut random = SplitMix64::new(11);
    let mut b = ModelBuilder::new([0.0; 3]);
    let inertia = mass * length * length;
    let specs = [
        body(2.0 * mass, [0.3, 0.5, 0.7].map(|x| x * inertia)),
        body(0.5 * mass, [0.05, 0.04, 0.06].map(|x| x * inertia)),
    ];
    let order = if is_swapped { [1, 0] } else { [0, 1] };
    let mut nodes = [NodeId::WORLD; 2];
    for k in order {
        let free = b.joint(&format!("free{k}"), NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        nodes[k] = b.body(&format!("body{k}"), free, Pose::identity(), specs[k].clone());
    }
    let along = |x: f64| if x > 0.0 { x * mass } else { 0.0 };
    let about = |x: f64| x * inertia;
    let [a, c, d] = [300.0, 90.0, 150.0];
    let stiffness = [along(a), along(c), along(d), about(9.0), about(2.0), about(6.0)];
    let damping = [along(0.5), along(2.0), 0.0, about(0.05), about(0.1), 0.0];
    let mut at = || pose(&mut random, 0.3);
    let poses = [at(), at()].map(|pose| Pose { pos: pose.pos.scale(length), ..pose });
    b.bushing("joint", BushingSpec { ends: nodes, poses, stiffness, damping });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    for k in 0..2 {
        let info = model.names().joint(&format!("free{k}")).unwrap().clone();
        let (start, angular, linear) =
            (pose(&mut random, 0.4), numbers::<3>(&mut random, 1.5), numbers::<3>(&mut random, 1.0));
        let start = Pose { pos: start.pos.scale(length), ..start };
        let start = turn.compose(&start);
        x.q[info.q_idx..info.q_idx + 3].copy_from_slice(&start.pos.0);
        Quat::from_matrix(&start.rot).write(&mut x.q[info.q_idx + 3..]);
        x.v[info.v_idx..info.v_idx + 3].copy_from_slice(&angular);
        x.v[info.v_idx + 3..info.v_idx + 6].copy_from_slice(&linear.map(|x| x * length));
    }
    (model, x)
}

#[test]
fn energy_and_momentum_are_accounted_for() {
    let (model, x) = pair(&Pose::identity(), 1.0, 1.0, false);
    for kind in ALL {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-10, 2e-4);
        let seen = |world: &mut World| {
            let (q, v) = (world.state.q.clone(), world.state.v.clone());
            let energy = energy_at(&model, &q, &v, world.mechanism().scratch()).total();
            let scratch = world.mechanism().scratch();
            kinematics::motions(&model, &q, &v, &v, scratch);
            (energy, momentum(&model, scratch))
        };
        let (e0, p0) = seen(&mut world);
        run(&mut world, 2e-4, 5000);
        let (e1, p1) = seen(&mut world);
        let [work, heat] = [world.state.totals[0], world.state.totals[1]];
        let bound = match kind {
            MethodKind::SemiImplicitEuler => 2e-2,
            MethodKind::Implicit => 1e-3,
            _ => 2e-6,
        };
        assert!(work.abs() < bound && (e1 - e0 - work + heat).abs() < bound, "{kind:?}: {}", e1 - e0 - work + heat);
        assert!(heat > 0.1 && (p1.lin - p0.lin).norm() < bound && (p1.ang - p0.ang).norm() < bound, "{kind:?}");
    }
}

#[test]
fn turned_scaled_and_reordered_mechanisms_move_the_same() {
    let plain = |turn: &Pose<f64>, length: f64, mass: f64, is_swapped: bool| {
        let (model, x) = pair(turn, length, mass, is_swapped);
        let mut world = World::new(model.clone(), x, MethodKind::DormandPrince, 1e-11, 1e-2);
        run(&mut world, 1e-2, 100);
        let of = |k: usize| {
            let info = model.names().joint(&format!("free{k}")).unwrap();
            let v = &world.state.v[info.v_idx..];
            [v[0], v[1], v[2], v[3] / length, v[4] / length, v[5] / length]
        };
        [of(0), of(1)].concat()
    };
    let expected = plain(&Pose::identity(), 1.0, 1.0, false);
    let turn = Pose { rot: Quat::exp(Vec3([1.1, -2.0, 0.6])).matrix(), pos: Vec3([3.0, -1.0, 2.0]) };
    for other in
        [plain(&turn, 1.0, 1.0, false), plain(&turn, 0.2, 30.0, false), plain(&Pose::identity(), 1.0, 1.0, true)]
    {
        for (a, b) in expected.iter().zip(&other) {
            assert!((a - b).abs() < 1e-7, "{expected:?} {other:?}");
        }
    }
}

#[test]
fn methods_agree_and_the_implicit_one_is_of_second_order() {
    let (model, x) = pair(&Pose::identity(), 1.0, 1.0, false);
    let after = |kind: MethodKind, h: f64| {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-11, h);
        run(&mut world, h, (0.5 / h).round() as u32);
        world.state.clone()
    };
    let exact = after(MethodKind::DormandPrince, 1e-2);
    assert!(distance(&model, &exact, &after(MethodKind::Stiff, 1e-2)) < 1e-7);
    let [coarse, fine] = [2e-3, 1e-3].map(|h| distance(&model, &exact, &after(MethodKind::Implicit, h)));
    assert!(fine < 1e-2 && coarse / fine > 3.5, "{coarse:e} {fine:e}");
}

/// Two bodies on a stiff bushing that is soft about y, the second one held by a point of the world, too.
fn stiff_pair() -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let mut free = |name: &str, mass: f64| {
        let joint = b.joint(&format!("{name}.free"), NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        b.body(name, joint, Pose::identity(), body(mass, [0.02 * mass, 0.03 * mass, 0.04 * mass]))
    };
    let [one, two] = [free("one", 1.0), free("two", 2.0)];
    let at = |x: f64, y: f64, z: f64| Pose::translation(Vec3([x, y, z]));
    let (stiffness, damping) = ([1e9, 1e9, 1e9, 1e8, 1e3, 1e8], [1e4, 1e4, 1e4, 1e3, 1.0, 1e3]);
    b.bushing(
        "joint",
        BushingSpec { ends: [one, two], poses: [at(0.3, 0.0, 0.0), at(0.3, 0.0, 0.0)], stiffness, damping },
    );
    let poses = [Pose::identity(), at(-0.2, 0.1, 0.0)];
    b.loop_joint("pin", LoopJointSpec { kind: LoopJointKind::Point, ends: [NodeId::WORLD, two], poses });
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    for k in 0..2 {
        x.q[7 * k..7 * k + 3].copy_from_slice(&[0.2, -0.1, 0.0]);
    }
    // the body turns about the pin: its origin moves
    (x.v[0], x.v[6]) = (3.0, 3.0);
    let lin = Vec3([3.0, 0.0, 0.0]).cross(Vec3([0.2, -0.1, 0.0]));
    x.v[3..6].copy_from_slice(&lin.0);
    x.v[9..12].copy_from_slice(&lin.0);
    (model, x)
}

#[test]
fn a_stiff_bushing_in_a_loop_is_a_weld_for_implicit_methods() {
    let (model, x) = stiff_pair();
    for kind in [MethodKind::Implicit, MethodKind::Stiff] {
        let mut world = World::new(model.clone(), x.clone(), kind, 1e-8, 1e-3);
        run(&mut world, 1e-3, 500);
        let (q, v) = (world.state.q.clone(), world.state.v.clone());
        kinematics::motions(&model, &q, &v, &v, world.mechanism().scratch());
        let scratch = world.mechanism().scratch();
        let element = &model.bushings()[0];
        let at = element.motion(|link| (scratch.twist(link), scratch.link_poses()[link]));
        assert!(at.deflection[..3].iter().all(|x| x.abs() < 1e-5), "{kind:?}: {:?}", at.deflection);
        assert!(at.deflection[3].abs() < 1e-4 && at.deflection[5].abs() < 1e-4, "{kind:?}: {:?}", at.deflection);
        let start = energy_at(&model, &x.q, &x.v, world.mechanism().scratch()).total();
        let end = energy_at(&model, &q, &v, world.mechanism().scratch()).total();
        let balance = end - start - world.state.totals[0] + world.state.totals[1];
        assert!(balance.abs() < 0.05, "{kind:?}: {balance}");
    }
}

#[test]
fn lanes_have_the_bits_of_single_worlds() {
    let (models, states): (Vec<_>, Vec<_>) =
        (0..4).map(|k| pair(&Pose::identity(), 1.0, 1.0 + 0.3 * f64::from(k), false)).unzip();
    for method in [MethodKind::Rk4, MethodKind::Implicit] {
        let settings = BatchSettings { method, h: 1e-3, n_steps: 50, record_every: 0 };
        let start = || -> Vec<BatchWorld> {
            let each = models.iter().zip(&states).enumerate();
            // orientations on both sides of the pivots of Shepperd's choice
            each.map(|(k, (model, x))| {
                let mut x: State<f64> = x.clone();
                Quat::exp(Vec3([0.9 * k as f64, 0.3, -0.4 * k as f64])).write(&mut x.q[3..7]);
                BatchWorld::new(model.clone(), x)
            })
            .collect()
        };
        let (mut together, mut alone) = (start(), start());
        advance(&mut together, &settings).unwrap();
        alone.iter_mut().for_each(|world| advance_alone(world, &settings));
        for (one, other) in together.iter().zip(&alone) {
            assert_eq!((&one.state.q, &one.state.v), (&other.state.q, &other.state.v), "{method:?}");
        }
    }
}

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut BushingSpec)| {
        let mut b = ModelBuilder::new([0.0; 3]);
        let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let own = b.body("body", free, Pose::identity(), body(1.0, [0.1; 3]));
        let (ends, poses) = ([NodeId::WORLD, own], [Pose::identity(), Pose::identity()]);
        let mut spec = BushingSpec { ends, poses, stiffness: [1.0; 6], damping: [0.0; 6] };
        change(&mut spec);
        b.bushing("mount", spec);
        b.build().unwrap_err().to_string()
    };
    type Change = fn(&mut BushingSpec);
    let cases: [(Change, &str); 4] = [
        (|s| s.stiffness[1] = -2.0, "stiffness -2 N/m of bushing `mount`"),
        (|s| s.damping[5] = f64::NAN, "rotational_damping NaN N·m·s/rad of bushing `mount`"),
        (|s| s.stiffness[3] = f64::INFINITY, "rotational_stiffness inf N·m/rad of bushing `mount`"),
        (|s| s.ends[0] = s.ends[1], "both ends of bushing `mount` are fixed in one another"),
    ];
    for (change, message) in cases {
        let text = refused(&change);
        assert!(text.contains(message), "{text}");
    }
}

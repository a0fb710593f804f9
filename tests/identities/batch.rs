//! World k of a batch has the bits it would have alone.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone, obstacle_to_lanes};
use sincro_dynamics::contact::Material;
use sincro_dynamics::geometry::Surface;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;

use crate::random::Random;

const METHODS: [MethodKind; 3] = [MethodKind::SemiImplicitEuler, MethodKind::Rk4, MethodKind::Implicit];

/// An arm with every kind of joint whose numbers depend on `r`; with `friction` explicit methods want sub-steps of
/// their own in each world.
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

/// Joint of an arm that switches.
#[derive(Clone)]
struct Switching {
    kind: JointKind,
    has_motor: bool,
    has_friction: bool,
    range: Option<(f64, f64)>,
    restitution: f64,
}

impl Switching {
    fn random(r: &mut Random, has_ranges: bool) -> Self {
        let axis = [r.unit(), r.unit(), 1.0 + 0.5 * r.unit()];
        let is_prismatic = r.unit() > 0.5;
        let size = if is_prismatic { 0.2 } else { 0.5 };
        let range = (-0.05 - size * r.unit().abs(), 0.05 + size * r.unit().abs());
        Self {
            kind: if is_prismatic { JointKind::Prismatic { axis } } else { JointKind::Revolute { axis } },
            has_motor: r.unit() > -0.6,
            has_friction: r.unit() > -0.2,
            range: (has_ranges && r.unit() > -0.4).then_some(range),
            restitution: if r.unit() > 0.0 { 0.5 } else { 0.0 },
        }
    }
}

/// An arm whose drives have limits from those that hold everything to those that hold nothing.
fn switching_arm(r: &mut Random, joints: &[Switching]) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let mut parent = NodeId::WORLD;
    for (i, of_joint) in joints.iter().enumerate() {
        let mut spec = JointSpec::new(of_joint.kind);
        let mut limit = || 10.0_f64.powi((r.unit() * 3.0).round() as i32 - 1) * (1.5 + r.unit());
        if of_joint.has_motor {
            spec.motor = vec![Motor { max_torque: limit(), ..Motor::new(MotorMode::Velocity) }];
        }
        if of_joint.has_friction {
            spec.friction = vec![(0.3 * limit()).into()];
        }
        spec.limits = of_joint.range.into_iter().collect();
        spec.limit_restitution = of_joint.restitution;
        let at = Pose::translation(Vec3([0.1, 0.0, 0.05 * r.unit()]));
        let joint = b.joint(&format!("j{i}"), parent, at, spec);
        let mass = Shape::Cuboid { size: [0.1, 0.2, 0.3] }.mass_properties(200.0 + 50.0 * r.unit());
        parent = b.body(&format!("b{i}"), joint, Pose::translation(Vec3([0.1, 0.0, 0.0])), BodySpec { mass });
    }
    b.build().unwrap().0
}

/// Number of steps of the worlds that switch.
const SWITCHING_STEPS: u32 = 60;

/// A world of such an arm whose commands are held for some steps, so that motors arrive.
fn switching_world(r: &mut Random, joints: &[Switching]) -> BatchWorld {
    let model = switching_arm(r, joints);
    let mut x = State::new(&model);
    x.v.iter_mut().for_each(|v| *v = if r.unit() > 0.0 { 3.0 * r.unit() } else { 0.0 });
    let mut world = BatchWorld::new(model, x);
    let n = world.model.n_commands();
    for k in 0..SWITCHING_STEPS {
        for i in 0..n {
            let held = world.commands.len().checked_sub(n).filter(|_| k % 15 > 0);
            world.commands.push(held.map_or_else(|| [r.unit(), 0.0][i % 2], |k| world.commands[k]));
        }
    }
    world
}

fn bits(x: &[f64]) -> Vec<u64> {
    x.iter().map(|x| x.to_bits()).collect()
}

/// Advances worlds together, and compares them with each alone.
fn advance_and_compare(together: &mut [BatchWorld]) {
    let settings =
        BatchSettings { method: MethodKind::SemiImplicitEuler, h: 0.004, n_steps: SWITCHING_STEPS, record_every: 1 };
    advance_and_compare_by(together, &settings);
}

fn advance_and_compare_by(together: &mut [BatchWorld], settings: &BatchSettings) {
    assert_eq!(obstacle_to_lanes(&together[0].model, settings.method), None);
    let mut alone = together.to_vec();
    advance(together, settings).unwrap();
    alone.iter_mut().for_each(|w| advance_alone(w, settings));
    for (a, b) in together.iter().zip(&alone) {
        assert_eq!(bits(&a.record), bits(&b.record));
        assert_eq!((a.stop, a.state.tick), (b.stop, b.state.tick));
        assert_eq!((bits(&a.state.q), bits(&a.state.v)), (bits(&b.state.q), bits(&b.state.v)));
        assert_eq!((bits(&a.state.rotors), bits(&a.state.commands)), (bits(&b.state.rotors), bits(&b.state.commands)));
        assert_eq!((&a.state.drives, bits(&a.state.contacts)), (&b.state.drives, bits(&b.state.contacts)));
    }
}

#[test]
fn each_lane_decides_its_limited_drives_by_itself() {
    let mut r = Random::new(11);
    let mut modes = [0_usize; 3];
    for _ in 0..40 {
        let n = 1 + (2.5 * (1.0 + r.unit())) as usize;
        let joints: Vec<_> = (0..n).map(|_| Switching::random(&mut r, false)).collect();
        let mut worlds: Vec<_> = (0..19).map(|_| switching_world(&mut r, &joints)).collect();
        advance_and_compare(&mut worlds);
        for world in &worlds {
            assert!(world.steps_alone == 0 || sincro_math::lanes::width() == 1);
            world.state.drives.iter().for_each(|mode| modes[(mode + 1.0) as usize] += 1);
        }
    }
    assert!(modes.iter().all(|n| *n > 200), "locked and saturated ones, at the end alone: {modes:?}");
}

#[test]
fn a_lane_that_reaches_a_limit_of_a_joint_makes_its_step_alone() {
    let mut r = Random::new(12);
    let (mut n_alone, mut n_steps) = (0, 0);
    for _ in 0..40 {
        let n = 1 + (2.5 * (1.0 + r.unit())) as usize;
        let mut joints: Vec<_> = (0..n).map(|_| Switching::random(&mut r, true)).collect();
        joints[0].range = Some((-0.3, 0.2));
        let mut worlds: Vec<_> = (0..19).map(|_| switching_world(&mut r, &joints)).collect();
        advance_and_compare(&mut worlds);
        n_alone += worlds.iter().map(|world| world.steps_alone).sum::<u64>();
        n_steps += worlds.len() as u64 * u64::from(SWITCHING_STEPS);
    }
    let share = n_alone as f64 / n_steps as f64;
    assert!((0.05..0.8).contains(&share) || sincro_math::lanes::width() == 1, "{share}");
}

/// A free body and an arm that hangs from it, above a floor and beside a table, of shapes drawn once.
fn flying_arm(r: &mut Random, shapes: &[Shape; 2], material: Material) -> BatchWorld {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    b.collider(NodeId::WORLD, Pose::identity(), Surface::HalfSpace, material);
    let table = Surface::Solid(Shape::Cuboid { size: [0.5, 0.5, 0.4] });
    b.collider(NodeId::WORLD, Pose::translation(Vec3([1.0, 0.0, 0.2])), table, material);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let body = |shape: &Shape| BodySpec { mass: shape.mass_properties(900.0) };
    let base = b.body("base", free, Pose::identity(), body(&shapes[0]));
    b.collider(base, Pose::identity(), Surface::Solid(shapes[0]), material);
    let mut spec = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    spec.motor = vec![Motor { max_torque: 2.0, ..Motor::new(MotorMode::Velocity) }];
    spec.limits = vec![(-1.0, 1.0)];
    let hinge = b.joint("hinge", base, Pose::translation(Vec3([0.0, 0.0, -0.15])), spec);
    let arm = b.body("arm", hinge, Pose::translation(Vec3([0.0, 0.0, -0.2])), body(&shapes[1]));
    b.collider(arm, Pose::identity(), Surface::Solid(shapes[1]), material);
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.q[..3].copy_from_slice(&[0.5 + r.unit(), 0.5 * r.unit(), 1.1 + 0.2 * r.unit()]);
    x.v.iter_mut().for_each(|v| *v = 3.0 * r.unit());
    let mut world = BatchWorld::new(model, x);
    world.commands = (0..SWITCHING_STEPS).map(|k| if k % 20 == 0 { r.unit() } else { 0.5 }).collect();
    world
}

#[test]
fn a_lane_that_may_touch_something_makes_its_step_alone() {
    let mut r = Random::new(14);
    let (mut n_alone, mut n_steps) = (0, 0);
    for draw in 0..30 {
        let shape = |r: &mut Random| match (r.unit() * 1.5).round() as i32 {
            -1 | -2 => Shape::Sphere { radius: 0.08 },
            0 => Shape::Cuboid { size: [0.1, 0.15, 0.12] },
            _ => Shape::Capsule { radius: 0.05, length: 0.1 },
        };
        let shapes = [shape(&mut r), shape(&mut r)];
        let rigid =
            Material { friction: 0.5, restitution: if draw % 3 == 0 { 0.5 } else { 0.0 }, ..Material::default() };
        let material = if draw % 5 == 0 { Material { stiffness: 1e5, ..rigid } } else { rigid };
        let mut worlds: Vec<_> = (0..19).map(|_| flying_arm(&mut r, &shapes, material)).collect();
        advance_and_compare(&mut worlds);
        n_alone += worlds.iter().map(|world| world.steps_alone).sum::<u64>();
        n_steps += worlds.len() as u64 * u64::from(SWITCHING_STEPS);
    }
    let share = n_alone as f64 / n_steps as f64;
    assert!((0.05..0.8).contains(&share) || sincro_math::lanes::width() == 1, "{share}");
}

#[test]
fn a_world_that_stops_in_a_step_alone_keeps_its_last_state() {
    let mut r = Random::new(15);
    let shapes = [Shape::Sphere { radius: 0.08 }, Shape::Capsule { radius: 0.05, length: 0.1 }];
    let stiff = Material { friction: 0.5, stiffness: 1e5, ..Material::default() };
    let mut worlds: Vec<_> = (0..19).map(|_| flying_arm(&mut r, &shapes, stiff)).collect();
    for (k, world) in worlds.iter_mut().enumerate().filter(|(k, _)| k % 3 == 0) {
        // the arm in the middle of the table
        world.state.q[..3].copy_from_slice(&[0.93, 0.01 * k as f64, 0.56]);
    }
    advance_and_compare(&mut worlds);
    assert!(worlds.iter().any(|world| world.stop.is_some()));
}

#[test]
fn a_world_that_stops_in_the_lanes_keeps_its_last_state() {
    for method in METHODS {
        let mut worlds = worlds(0.0);
        for (k, world) in worlds.iter_mut().enumerate().filter(|(k, _)| k % 3 == 0) {
            // more than a double holds after a few steps, one for each doubling of the exponent
            world.state.v[1] = 10.0_f64.powi(5 << (k / 3));
        }
        let settings = BatchSettings { method, h: 0.004, n_steps: 10, record_every: 1 };
        advance_and_compare_by(&mut worlds, &settings);
        let ticks: Vec<_> = worlds.iter().filter(|w| w.stop.is_some()).map(|w| w.state.tick).collect();
        assert!(ticks.len() > 2 && ticks.iter().any(|tick| *tick > 0), "{ticks:?}");
        // they stay where they are; the others go on, in lanes
        let stopped = worlds.clone();
        advance_and_compare_by(&mut worlds, &settings);
        assert!(worlds.iter().all(|w| w.steps_alone == 0) || sincro_math::lanes::width() == 1);
        for (now, then) in worlds.iter().zip(&stopped) {
            let of = |w: &BatchWorld| (w.stop, w.state.tick, bits(&w.state.q), bits(&w.state.v), w.record.len());
            assert_eq!(then.stop.is_some(), of(now) == of(then));
        }
    }
}

/// Worlds of an arm whose first joint feels the torques of a signal, at the ticks given.
fn worlds_with_a_signal(signal: &Signal, ticks: impl Fn(u64) -> u64) -> Vec<BatchWorld> {
    let mut r = Random::new(16);
    (0..19)
        .map(|k| {
            let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
            let mut spec = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
            spec.torque = vec![signal.clone()];
            let joint = b.joint("j", NodeId::WORLD, Pose::identity(), spec);
            let mass = Shape::Cuboid { size: [0.1, 0.2, 0.3] }.mass_properties(100.0 + 10.0 * r.unit());
            b.body("b", joint, Pose::translation(Vec3([0.1, 0.0, 0.0])), BodySpec { mass });
            let model = b.build().unwrap().0;
            let state = State { q: vec![r.unit()], v: vec![r.unit()], tick: ticks(k), ..State::new(&model) };
            BatchWorld::new(model, state)
        })
        .collect()
}

#[test]
fn worlds_with_other_clocks_feel_their_own_forces() {
    let sine = Signal::Sine { amplitude: 3.0, angular_frequency: 7.0, phase: 0.2, offset: 0.0 };
    for method in METHODS {
        let settings = BatchSettings { method, h: 0.004, n_steps: 30, record_every: 1 };
        let width = sincro_math::lanes::width() as u64;
        let signals = [&sine, &Signal::Constant(0.7)];
        for (signal, in_lanes) in [(signals[0], false), (signals[1], true)] {
            let mut worlds = worlds_with_a_signal(signal, |k| 11 * k);
            advance_and_compare_by(&mut worlds, &settings);
            let n_alone = worlds.iter().filter(|w| w.steps_alone > 0).count() as u64;
            assert_eq!(n_alone == 0, in_lanes && width > 1, "{method:?}");
        }
        let mut worlds = worlds_with_a_signal(&sine, |_| 130);
        advance_and_compare_by(&mut worlds, &settings);
        assert!(worlds.iter().all(|w| w.steps_alone == 0) || width == 1);
    }
}

#[test]
fn corners_of_inputs_keep_worlds_from_lanes_where_they_end_steps() {
    // from 0.5 s on, tick 125 of 4 ms; the last one between two ticks
    for start in [0.5, 0.5015] {
        let step = Signal::Step { time: start, from: 1.0, to: -2.0 };
        for method in METHODS {
            let settings = BatchSettings { method, h: 0.004, n_steps: 30, record_every: 1 };
            for tick in [80, 95, 110, 125, 126] {
                let [from, to] = [tick, tick + 30].map(|tick| 0.004 * tick as f64);
                let is_outside = !(from < start && start <= to);
                let mut worlds = worlds_with_a_signal(&step, |_| tick);
                advance_and_compare_by(&mut worlds, &settings);
                let in_lanes = is_outside || method == MethodKind::SemiImplicitEuler;
                let n_alone = worlds.iter().filter(|w| w.steps_alone > 0).count();
                assert!(sincro_math::lanes::width() == 1 || (n_alone == 0) == in_lanes, "{method:?}, tick {tick}");
            }
        }
    }
}

#[test]
fn worlds_with_other_limits_of_joints_are_advanced_alone() {
    let mut r = Random::new(13);
    let mut joint = Switching::random(&mut r, false);
    let mut worlds: Vec<_> = (0..8)
        .map(|k| {
            joint.range = Some((-0.1, 0.1 + 0.01 * f64::from(k)));
            switching_world(&mut r, std::slice::from_ref(&joint))
        })
        .collect();
    advance_and_compare(&mut worlds);
    assert!(worlds.iter().all(|world| world.steps_alone == u64::from(SWITCHING_STEPS)));
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

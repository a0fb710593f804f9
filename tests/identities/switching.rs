//! Arms and closed loops with many limited drives: every draw runs through without a fallback, and two methods agree on
//! it.
//!
//! The number of draws is that of the environment variable `SINCRO_DRAWS` (default 16).

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, LoopJointSpec, MassProperties, Model, ModelBuilder, NodeId};
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::random::Random;

/// Duration of a run `[s]` and its tick.
const DURATION: f64 = 0.5;
const TICK: f64 = 0.005;

/// Command of one motor: nothing, a sine, or its sign.
#[derive(Clone, Copy)]
struct Command {
    shape: usize,
    amplitude: f64,
    rate: f64,
    phase: f64,
}

impl Command {
    fn at(&self, t: f64) -> f64 {
        let sine = self.amplitude * libm::sin(self.rate * t + self.phase);
        match self.shape {
            0 => 0.0,
            1 => sine,
            _ => self.amplitude.copysign(sine),
        }
    }
}

/// 10 to a power drawn between two.
fn decade(r: &mut Random, low: f64, high: f64) -> f64 {
    libm::pow(10.0, low + (high - low) * 0.5 * (1.0 + r.unit()))
}

/// A revolute joint, mostly with a velocity motor of limit 1e-3 to 1e6 N·m, sometimes with friction.
fn joint(r: &mut Random, axis: [f64; 3], commands: &mut Vec<Command>, motors: usize) -> JointSpec {
    let mut joint = JointSpec::new(JointKind::Revolute { axis });
    if r.below(4) < motors {
        joint.motor = vec![Motor { max_torque: decade(r, -3.0, 6.0), ..Motor::new(MotorMode::Velocity) }];
        commands.push(Command {
            shape: r.below(3),
            amplitude: 1.0 + 0.8 * r.unit(),
            rate: 3.0 + 2.5 * r.unit(),
            phase: 3.0 * r.unit(),
        });
    }
    if r.below(3) == 0 {
        joint.friction = vec![decade(r, -3.0, 1.0).into()];
    }
    joint
}

/// An arm of 2 to 8 links under gravity, a motor in each joint.
fn arm(draw: u64) -> (Model<f64>, State<f64>, Vec<Command>) {
    let r = &mut Random::new(1000 + draw);
    let is_planar = r.below(2) == 0;
    let (mut b, mut parent, mut commands) = (ModelBuilder::new([0.0, 0.0, -9.81]), NodeId::WORLD, Vec::new());
    for k in 0..2 + r.below(7) {
        let axis = if is_planar || r.below(3) == 0 { [0.0, 1.0, 0.0] } else { r.vector() };
        let at = Pose::translation(Vec3([0.0, 0.0, if k == 0 { 0.0 } else { -0.4 }]));
        parent = b.joint(&format!("joint{k}"), parent, at, joint(r, axis, &mut commands, 4));
        let m = 1.2 + 0.8 * r.unit();
        let inertia = [0.02 * m, 0.0, 0.0, 0.02 * m, 0.0, 0.004 * m];
        let mass = MassProperties { mass: m, center_of_mass: [0.0, 0.0, -0.2], inertia };
        b.body(&format!("link{k}"), parent, Pose::identity(), BodySpec { mass });
    }
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.q.iter_mut().for_each(|q| *q = 2.0 * r.unit());
    (model, x, commands)
}

/// A planar loop of 3 to 6 moving links in a plane turned at random, motors in most joints.
fn closed_loop(draw: u64) -> (Model<f64>, State<f64>, Vec<Command>) {
    let r = &mut Random::new(5000 + draw);
    let rot = Quat::exp(Vec3(r.vector()).scale(2.0)).matrix();
    let (mut b, mut commands) = (ModelBuilder::new(rot.mul_vec(Vec3([0.0, 0.0, -9.81])).0), Vec::new());
    let n = 3 + r.below(4);
    // corners near an arc
    let corner = |k: usize, r: &mut Random| {
        let angle = 3.0 * k as f64 / n as f64;
        Vec3([1.0 - libm::cos(angle) + 0.1 * r.unit(), 0.0, libm::sin(angle) + 0.1 * r.unit()])
    };
    let corners: Vec<Vec3<f64>> = (0..=n).map(|k| corner(k, r)).collect();
    let ground = b.frame("ground", NodeId::WORLD, Pose { rot, pos: Vec3::zero() });
    let (mut parent, mut at) = (ground, corners[0]);
    for k in 0..n {
        let spec = joint(r, [0.0, 1.0, 0.0], &mut commands, 3);
        parent = b.joint(&format!("joint{k}"), parent, Pose::translation(at), spec);
        at = corners[k + 1] - corners[k];
        let m = 1.2 + 0.8 * r.unit();
        let i = m * at.dot(at) / 12.0;
        let mass = MassProperties { mass: m, center_of_mass: at.scale(0.5).0, inertia: [i, 0.0, 0.0, i, 0.0, i] };
        b.body(&format!("link{k}"), parent, Pose::identity(), BodySpec { mass });
    }
    let turn = Mat3::rotation::<0>(-1.0, 0.0);
    let kind = [LoopJointKind::Hinge, LoopJointKind::Point][r.below(2)];
    let poses = [at, corners[n]].map(|pos| Pose { rot: turn, pos });
    b.loop_joint("pin", LoopJointSpec { kind, ends: [parent, ground], poses });
    let model = b.build().unwrap().0;
    let x = State::new(&model);
    (model, x, commands)
}

type Draw = fn(u64) -> (Model<f64>, State<f64>, Vec<Command>);

/// Runs draw `draw` with all positions moved by `nudge`.
fn run(mechanism: Draw, draw: u64, kind: MethodKind, accuracy: f64, substeps: u32, nudge: f64) -> World {
    let (model, mut x, commands) = mechanism(draw);
    x.q.iter_mut().for_each(|q| *q += nudge);
    let mut world = World::new(model, x, kind, accuracy, TICK);
    world.set_substeps(substeps);
    world.initialize(0.0);
    for k in 0..(DURATION / TICK).round() as u32 {
        let t = TICK * f64::from(k);
        for (slot, command) in world.state.commands.iter_mut().zip(&commands) {
            *slot = command.at(t);
        }
        if let Err((t, reason)) = world.advance(t, TICK) {
            panic!("draw {draw}, {kind:?}: stopped at {t} s: {reason}");
        }
    }
    let statistics = world.statistics();
    assert_eq!(
        (statistics.fallback_steps, statistics.undecided_modes, world.jams().count),
        (0, 0, 0),
        "draw {draw}, {kind:?}: {statistics:?}"
    );
    world
}

fn difference(a: &World, b: &World) -> f64 {
    a.state.q.iter().zip(&b.state.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn draws() -> u64 {
    std::env::var("SINCRO_DRAWS").ok().and_then(|n| n.parse().ok()).unwrap_or(16)
}

#[test]
fn any_number_of_limited_drives_is_decided_together() {
    let mut events = 0;
    for draw in 0..draws() {
        let explicit = run(arm, draw, MethodKind::DormandPrince, 1e-9, 1, 0.0);
        events += explicit.statistics().events;
        let off = difference(&explicit, &run(arm, draw, MethodKind::Stiff, 1e-9, 1, 0.0));
        // some draws are chaotic: they amplify what moves their start
        let amplified = difference(&explicit, &run(arm, draw, MethodKind::DormandPrince, 1e-9, 1, 1e-9));
        assert!(off < 1e-7 || amplified > 1e-7, "draw {draw}: the methods differ by {off:e} rad ({amplified:e})");
    }
    assert!(events > 20 * draws(), "{events} events: the draws test nothing");
}

#[test]
fn limited_drives_in_closed_loops_are_decided_together() {
    let mut events = 0;
    for draw in 0..draws() {
        let explicit = run(closed_loop, draw, MethodKind::DormandPrince, 1e-9, 1, 0.0);
        events += explicit.statistics().events;
        let off = difference(&explicit, &run(closed_loop, draw, MethodKind::Stiff, 1e-10, 1, 0.0));
        assert!(off < 1e-6, "draw {draw}: the methods differ by {off:e} rad");
    }
    assert!(events > 10 * draws(), "{events} events: the draws test nothing");
}

/// Semi-implicit Euler converges to the trajectories with located events, draw by draw, and on the average at first
/// order. Chaotic draws, which amplify a start moved by 1e-9 a hundredfold, are left out, and a few in which loops pass
/// singular positions, where it does not stay on the branch.
fn time_stepping_converges(mechanism: Draw) {
    let (mut coarse, mut fine, mut n, mut singular) = (0.0, 0.0, 0.0, 0);
    for draw in 0..draws() {
        let located = run(mechanism, draw, MethodKind::DormandPrince, 1e-9, 1, 0.0);
        if difference(&located, &run(mechanism, draw, MethodKind::DormandPrince, 1e-9, 1, 1e-9)) > 1e-7 {
            continue;
        }
        let error = |n: u32| difference(&located, &run(mechanism, draw, MethodKind::SemiImplicitEuler, 1e-9, n, 0.0));
        let [one, two] = [error(20), error(200)];
        if two > 1e-3 && located.passed_singularities().count > 0 {
            singular += 1;
            continue;
        }
        // of large errors the order is looked at once more
        let converges = two < 1e-3 || error(2000) < 0.2 * two;
        assert!(converges, "draw {draw}: {one:e}, {two:e} rad");
        (coarse, fine, n) = (coarse + one, fine + two, n + 1.0);
    }
    assert!(fine < 0.2 * coarse, "mean errors {:e} and {:e} rad of {n} draws", coarse / n, fine / n);
    assert!(singular <= 2 + draws() / 20, "{singular} draws left the branch at a singular position");
    assert!(2.0 * n >= draws() as f64, "{n} draws are compared");
}

#[test]
fn time_stepping_converges_to_the_located_events_of_arms() {
    time_stepping_converges(arm);
}

#[test]
fn time_stepping_converges_to_the_located_events_of_closed_loops() {
    time_stepping_converges(closed_loop);
}

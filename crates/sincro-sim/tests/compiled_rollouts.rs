//! Worlds whose steps are compiled have the bits of worlds whose steps are not.

use sincro_dynamics::batch::{BatchSettings, BatchWorld};
use sincro_dynamics::prelude::*;
use sincro_math::random::splitmix64;
use sincro_sim::rollout::{Compile, Rollout, StepsBy};

const METHODS: [MethodKind; 3] = [MethodKind::SemiImplicitEuler, MethodKind::Rk4, MethodKind::Implicit];

/// Random numbers in [0, 1).
struct Random(u64, u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.1 += 1;
        (splitmix64(self.0, self.1) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A machine with every kind of joint, springs and an ideal motor, its numbers drawn.
fn machine(r: &mut Random) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let kinds = [
        JointKind::Revolute { axis: [0.0, 0.0, -1.0] },
        JointKind::Revolute { axis: [0.0, 1.0, 0.0] },
        JointKind::Prismatic { axis: [1.0, 0.0, 0.0] },
        JointKind::Ball,
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
        }
        let at = Pose::translation(Vec3([0.1 + 0.01 * r.unit(), 0.0, 0.2]));
        let joint = b.joint(&format!("j{i}"), parent, at, spec);
        let mass = Shape::Cuboid { size: [0.1, 0.2, 0.3] }.mass_properties(100.0 + 10.0 * r.unit());
        parent = b.body(&format!("b{i}"), joint, Pose::translation(Vec3([0.1, 0.0, 0.0])), BodySpec { mass });
    }
    b.build().unwrap().0
}

/// Worlds of drawn starts and commands: of one model, or of as many.
fn worlds(is_one_model: bool, n_steps: usize) -> Vec<BatchWorld> {
    let r = &mut Random(11, 0);
    let shared = machine(r);
    let of = |r: &mut Random| {
        let model = if is_one_model { shared.clone() } else { machine(r) };
        let mut state = State::new(&model);
        state.v.iter_mut().for_each(|v| *v = r.unit() - 0.5);
        state.q[1] = r.unit();
        let mut world = BatchWorld::new(model, state);
        world.commands = (0..n_steps).map(|_| r.unit()).collect();
        world
    };
    (0..35).map(|_| of(r)).collect()
}

fn bits(x: &[f64]) -> Vec<u64> {
    x.iter().map(|x| x.to_bits()).collect()
}

fn is_same(a: &[BatchWorld], b: &[BatchWorld]) {
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        assert_eq!(bits(&a.record), bits(&b.record), "world {k}");
        assert_eq!((bits(&a.state.q), bits(&a.state.v)), (bits(&b.state.q), bits(&b.state.v)), "world {k}");
        assert_eq!((a.state.tick, &a.stop), (b.state.tick, &b.stop), "world {k}");
    }
}

/// Worlds after their run, compiled and not.
fn both(worlds: &[BatchWorld], settings: BatchSettings) -> [Vec<BatchWorld>; 2] {
    [Compile::IfPossible, Compile::Never].map(|compile| {
        let mut rollout = Rollout::new(worlds.to_vec(), settings, compile);
        let is_compiled = matches!(rollout.steps_by(), StepsBy::Compiled { .. });
        let can_be = sincro_math::lanes::width() > 1 && std::env::var_os("SINCRO_COMPILE").is_none();
        assert_eq!(is_compiled, can_be && compile == Compile::IfPossible, "{:?}", rollout.steps_by());
        rollout.advance(2).unwrap();
        rollout.into_worlds()
    })
}

#[test]
fn compiled_steps_have_the_bits_of_the_recursions() {
    for method in METHODS {
        for is_one_model in [true, false] {
            let settings = BatchSettings { method, h: 0.004, n_steps: 40, record_every: 4 };
            let [compiled, plain] = both(&worlds(is_one_model, 40), settings);
            is_same(&compiled, &plain);
            assert!(compiled.iter().all(|world| world.stop.is_none() && world.state.v.iter().any(|v| *v != 0.0)));
        }
    }
}

#[test]
fn states_that_a_program_does_not_know_are_left_to_the_recursions() {
    let settings = BatchSettings { method: MethodKind::Rk4, h: 0.004, n_steps: 20, record_every: 1 };
    let mut worlds = worlds(true, 20);
    worlds[3].state.v[1] = 1e200; // stops
    worlds[9].state.q[0] = 2.5e6; // beyond the reduction of angles
    worlds[17].state.q[2] = f64::NAN;
    let [compiled, plain] = both(&worlds, settings);
    is_same(&compiled, &plain);
    let stopped: Vec<usize> = (0..worlds.len()).filter(|k| plain[*k].stop.is_some()).collect();
    assert_eq!(stopped, [3, 17]);
}

#[test]
fn a_rollout_can_be_restarted() {
    let settings = BatchSettings { method: MethodKind::SemiImplicitEuler, h: 0.004, n_steps: 10, record_every: 1 };
    let worlds = worlds(true, 10);
    let mut rollout = Rollout::new(worlds.clone(), settings, Compile::IfPossible);
    rollout.advance(1).unwrap();
    let first = rollout.worlds().to_vec();
    for (k, world) in worlds.iter().enumerate() {
        rollout.restart(k, &world.state);
    }
    rollout.advance(2).unwrap();
    is_same(rollout.worlds(), &first);
}

#[test]
fn short_batches_are_not_compiled() {
    let settings = BatchSettings { method: MethodKind::Rk4, h: 0.004, n_steps: 10, record_every: 0 };
    let rollout = Rollout::new(worlds(true, 10), settings, Compile::IfItPays);
    let StepsBy::Recursions { reason } = rollout.steps_by() else { panic!("ten steps are no work") };
    assert_eq!(reason, "it would take longer than the steps");
}

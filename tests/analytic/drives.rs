//! Velocity motors and Coulomb friction: exact tracking, impulses, saturation, sticking.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::joint::{Friction, JointKind};
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, cart, motor, run, slider};

fn velocity_motor(max_torque: f64) -> Motor<f64> {
    Motor { max_torque, ..Motor::new(MotorMode::Velocity) }
}

#[test]
fn a_velocity_motor_has_its_velocity_exactly_and_reports_the_impulse() {
    for kind in ALL {
        let model = cart(1e-12, motor(velocity_motor(f64::INFINITY)));
        let mut x = State::new(&model);
        x.commands[0] = 1.0;
        let mut world = World::new(model, x, kind, 1e-9, 1e-3);
        world.advance(0.0, 0.005).unwrap();
        assert_eq!(world.state.v[0], 1.0, "{kind:?}");
        assert!((world.state.totals[2] / 1e-12 - 1.0).abs() < 1e-12, "{kind:?}");
        run(&mut world, 0.005, 3);
        assert!((world.state.q[0] - 0.02).abs() < 1e-15, "{kind:?}");
    }
}

#[test]
fn a_limited_motor_needs_its_impulse_over_its_limit() {
    // steps to reach Δv: ceil(m Δv/(F h)), as in the thesis's experiment 1
    for (limit, steps) in [(1e-10, 2), (0.7e-10, 3), (3e-11, 7)] {
        for kind in ALL {
            let model = cart(1e-12, motor(velocity_motor(limit)));
            let mut x = State::new(&model);
            x.commands[0] = 1.0;
            let mut world = World::new(model, x, kind, 1e-9, 1e-3);
            let reached = (1..20).find(|k| {
                world.advance(f64::from(k - 1) * 0.005, 0.005).unwrap();
                (world.state.v[0] - 1.0).abs() < 1e-12
            });
            assert_eq!(reached, Some(steps), "{kind:?} {limit:e}");
            assert!((world.state.totals[2] / 1e-12 - 1.0).abs() < 1e-9, "{kind:?}");
        }
    }
}

#[test]
fn drives_that_reach_their_targets_in_one_step_do_so_one_after_the_other() {
    // two carts of 2 kg on rails of their own: each is pushed with its limit up to its target, whichever comes first
    let target = 1.0;
    for limits in [[40.0, 100.0], [100.0, 40.0], [40.0, 40.5]] {
        let mut b = ModelBuilder::new([0.0; 3]);
        for (k, limit) in limits.into_iter().enumerate() {
            let rail = b.joint(&format!("rail{k}"), NodeId::WORLD, Pose::identity(), motor(velocity_motor(limit)));
            let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
            b.body(&format!("cart{k}"), rail, Pose::identity(), BodySpec { mass });
        }
        let model = b.build().unwrap().0;
        for kind in [
            MethodKind::Rk4,
            MethodKind::Implicit,
            MethodKind::DormandPrince,
            MethodKind::DormandPrince8,
            MethodKind::Stiff,
        ] {
            let mut x = State::new(&model);
            x.commands.fill(target);
            let mut world = World::new(model.clone(), x, kind, 1e-9, 0.1);
            run(&mut world, 0.1, 3);
            for (k, limit) in limits.into_iter().enumerate() {
                // v² m/(2 F) until the target is reached
                let expected = target * 0.3 - 0.5 * target * target * 2.0 / limit;
                let found = world.state.q[k];
                assert!((found - expected).abs() < 1e-11, "{kind:?} {limits:?} {k}: {found} {expected}");
            }
        }
    }
}

/// Two carts in a row: the second one rides on the first.
fn carts(first: JointSpec, second: JointSpec) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let mass = |m: f64| BodySpec {
        mass: MassProperties { mass: m, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] },
    };
    let a = b.joint("a", NodeId::WORLD, Pose::identity(), first);
    let a = b.body("first", a, Pose::identity(), mass(2.0));
    let c = b.joint("b", a, Pose::translation(Vec3([0.1, 0.0, 0.0])), second);
    b.body("second", c, Pose::identity(), mass(3.0));
    b.build().unwrap().0
}

#[test]
fn a_jump_leaves_the_momentum_of_everything_else() {
    // the second cart is not pushed: its absolute velocity stays while the first one jumps
    for kind in ALL {
        let model = carts(motor(velocity_motor(f64::INFINITY)), slider());
        let mut x = State::new(&model);
        x.commands[0] = 0.5;
        let mut world = World::new(model, x, kind, 1e-9, 1e-3);
        world.advance(0.0, 0.01).unwrap();
        assert_eq!(world.state.v[0], 0.5);
        assert!((world.state.v[1] + 0.5).abs() < 1e-15, "{kind:?}");
    }
}

#[test]
fn friction_sticks_just_below_its_limit_and_slips_just_above() {
    for kind in ALL {
        for (share, slips) in [(0.999_999, false), (1.000_001, true)] {
            let torque = vec![Signal::Constant(share * 4.0)];
            let model = cart(2.0, JointSpec { friction: vec![4.0.into()], torque, ..slider() });
            let x = State::new(&model);
            let mut world = World::new(model, x, kind, 1e-9, 1e-3);
            run(&mut world, 0.01, 100);
            assert_eq!(world.state.v[0] != 0.0, slips, "{kind:?} {share}");
            if slips {
                // a = (F − limit)/m
                assert!((world.state.v[0] - 2e-6).abs() < 1e-9, "{kind:?} {}", world.state.v[0]);
            } else {
                assert_eq!(world.state.q[0], 0.0);
            }
        }
    }
}

#[test]
fn friction_stops_a_sliding_body_where_the_closed_form_says() {
    // v0²/(2 limit/m), then rest, exactly
    for kind in [
        MethodKind::Rk4,
        MethodKind::Implicit,
        MethodKind::DormandPrince,
        MethodKind::DormandPrince8,
        MethodKind::Stiff,
    ] {
        let model = cart(2.0, JointSpec { friction: vec![4.0.into()], ..slider() });
        let mut x = State::new(&model);
        x.v[0] = 1.3;
        let mut world = World::new(model, x, kind, 1e-9, 1e-3);
        run(&mut world, 0.1, 20);
        assert_eq!(world.state.v[0], 0.0, "{kind:?}");
        assert!((world.state.q[0] - 1.3 * 1.3 / 4.0).abs() < 1e-9, "{kind:?} {}", world.state.q[0]);
        assert!((world.state.totals[1] - 0.5 * 2.0 * 1.3 * 1.3).abs() < 1e-9, "{kind:?}");
    }
}

#[test]
fn stiction_breaks_at_its_limit_and_stribecks_curve_stops_a_body_where_its_integral_says() {
    let friction = Friction { stribeck_velocity: 0.2, at_rest: 6.0, ..Friction::coulomb(4.0) };
    for kind in ALL {
        for (share, slips) in [(0.999_999, false), (1.000_001, true)] {
            let torque = vec![Signal::Constant(share * 6.0)];
            let model = cart(2.0, JointSpec { friction: vec![friction], torque, ..slider() });
            let mut world = World::new(model.clone(), State::new(&model), kind, 1e-9, 1e-3);
            run(&mut world, 0.01, 100);
            assert_eq!(world.state.v[0] > 0.0, slips, "{kind:?} {share}");
        }
    }
    // m v dv = −F(v) dx, by Simpson's rule
    let (m, v0, n) = (2.0, 1.3, 20_000);
    let integrand = |k: usize| {
        let v = v0 * k as f64 / n as f64;
        m * v / friction.limit_at(v)
    };
    let weight = |k: usize| if k == 0 || k == n { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
    let distance = (0..=n).map(|k| weight(k) * integrand(k)).sum::<f64>() * v0 / n as f64 / 3.0;
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let model = cart(m, JointSpec { friction: vec![friction], ..slider() });
        let mut x = State::new(&model);
        x.v[0] = v0;
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        run(&mut world, 0.1, 20);
        assert_eq!(world.state.v[0], 0.0, "{kind:?}");
        assert!((world.state.q[0] - distance).abs() < 2e-9, "{kind:?} {} {distance}", world.state.q[0]);
        assert!((world.state.totals[1] - 0.5 * m * v0 * v0).abs() < 2e-9, "{kind:?}");
    }
}

#[test]
fn friction_on_a_spring_ends_where_it_can_hold() {
    // Coulomb-damped oscillator: each half swing loses 2 limit/k of amplitude, exactly
    let (k, limit) = (100.0, 1.0);
    let model = cart(1.0, JointSpec { friction: vec![limit.into()], spring: vec![(k, 0.0)], ..slider() });
    let mut x = State::new(&model);
    x.q[0] = 0.055;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    run(&mut world, 0.01, 300);
    // 0.055 → −0.035 → 0.015 → 0.005: holds, for k·0.005 < limit
    assert_eq!(world.state.v[0], 0.0);
    assert!((world.state.q[0] - 0.005).abs() < 1e-9, "{}", world.state.q[0]);
}

#[test]
fn a_motor_and_friction_on_one_joint_share_the_torque() {
    let model = cart(2.0, JointSpec { friction: vec![0.5.into()], ..motor(velocity_motor(10.0)) });
    let mut x = State::new(&model);
    x.commands[0] = 1.0;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    run(&mut world, 0.01, 100);
    let (a, torque) = world.rates(1.0);
    assert_eq!(a[0], 0.0);
    // holding 1 m/s against friction takes just the friction
    assert!((torque[0] - 0.5).abs() < 1e-12, "{}", torque[0]);
    // (10 − 0.5)/2 m/s² to reach it
    assert!((world.state.q[0] - (1.0 - 0.5 * 2.0 / 9.5)).abs() < 1e-9);
}

#[test]
fn a_position_motor_settles_exponentially_at_its_command() {
    // latched every tick: q⁺ = q + h kp (c − q)
    let model = cart(2.0, motor(Motor { kp: 4.0, max_velocity: 10.0, ..Motor::new(MotorMode::Position) }));
    let mut x = State::new(&model);
    x.commands[0] = 0.8;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    let mut expected = 0.0;
    for k in 0..100 {
        world.advance(f64::from(k) * 0.01, 0.01).unwrap();
        expected += 0.01 * 4.0 * (0.8 - expected);
    }
    assert!((world.state.q[0] - expected).abs() < 1e-13);
}

#[test]
fn any_stiffness_is_stable_at_one_millisecond() {
    // error control follows an undamped swing of 1e6 rad/s, which takes its time
    for (kind, ticks) in [(MethodKind::Implicit, 1000), (MethodKind::Stiff, 20)] {
        for (k, c) in [(1e12, 0.0), (1e12, 1e9), (0.0, 1e12), (1e3, 1e-3)] {
            let joint = JointSpec { spring: vec![(k, 0.0)], damping: vec![c], ..slider() };
            let model = carts(joint.clone(), joint);
            let mut x = State::new(&model);
            (x.q[0], x.q[1]) = (1e-3, -2e-3);
            let mut world = World::new(model, x, kind, 1e-6, 1e-3);
            run(&mut world, 1e-3, ticks);
            assert!(world.state.q.iter().all(|q| q.abs() < 3e-3), "{kind:?} k {k:e} c {c:e}: {:?}", world.state.q);
        }
    }
}

#[test]
fn an_elastic_joint_behind_a_held_motor_swings_at_its_own_frequency() {
    let revolute = |spec: JointSpec| JointSpec { kind: JointKind::Revolute { axis: [0.0, 0.0, 1.0] }, ..spec };
    let spring = JointSpec { spring: vec![(12.0, 0.0)], ..slider() };
    let model = carts(revolute(motor(velocity_motor(f64::INFINITY))), spring);
    let mut x = State::new(&model);
    x.q[1] = 0.02;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    run(&mut world, 0.05, 20);
    // the motor holds zero: q = q0 cos(√(k/m) t)
    assert!((world.state.q[1] - 0.02 * libm::cos(2.0)).abs() < 1e-9);
}

#[test]
fn an_ideal_motor_stops_short_of_the_limits_of_its_joint() {
    let modes = [Motor::new(MotorMode::Velocity), Motor { kp: 5.0, ..Motor::new(MotorMode::Position) }];
    for (kind, mode) in ALL.into_iter().flat_map(|kind| modes.map(|mode| (kind, mode))) {
        for command in [-2.0, 3.0] {
            let limited = JointSpec { limits: vec![(-0.5, 0.3)], ..motor(mode) };
            let model = cart(1.5, limited);
            let mut x = State::new(&model);
            x.commands[0] = command;
            let mut world = World::new(model, x, kind, 1e-9, 1e-3);
            let mut furthest = 0.0_f64;
            for k in 0..100 {
                world.advance(f64::from(k) * 0.02, 0.02).unwrap();
                furthest = furthest.max(world.state.q[0] * command.signum());
            }
            let bound = if command < 0.0 { 0.5 } else { 0.3 };
            let q = world.state.q[0] * command.signum();
            assert!(furthest <= bound && bound - q < 3e-9, "{kind:?} {mode:?} {furthest} {q}");
            assert!(world.state.v[0].abs() < 1e-12, "{kind:?} {mode:?}");
            // away from it at once
            world.state.commands[0] = -command;
            world.advance(2.0, 0.02).unwrap();
            assert!(world.state.v[0] * command < 0.0, "{kind:?} {mode:?}");
        }
    }
}

#[test]
fn ideal_motors_at_limits_have_the_bits_of_worlds_alone_in_lanes() {
    let position = Motor { kp: 5.0, ..Motor::new(MotorMode::Position) };
    let model = cart(1.5, JointSpec { limits: vec![(-0.5, 0.3)], ..motor(position) });
    let start = || -> Vec<BatchWorld> {
        let state = |k: i32| {
            let mut x = State::new(&model);
            x.commands[0] = 0.4 * f64::from(k) - 1.5;
            x
        };
        (0..8).map(|k| BatchWorld::new(model.clone(), state(k))).collect()
    };
    for method in [MethodKind::Rk4, MethodKind::SemiImplicitEuler] {
        let settings = BatchSettings { method, h: 0.02, n_steps: 60, record_every: 0 };
        let (mut together, mut alone) = (start(), start());
        advance(&mut together, &settings).unwrap();
        alone.iter_mut().for_each(|world| advance_alone(world, &settings));
        for (one, other) in together.iter().zip(&alone) {
            assert_eq!((&one.state.q, &one.state.v), (&other.state.q, &other.state.v), "{method:?}");
            assert!((-0.5..=0.3).contains(&one.state.q[0]), "{method:?} {:?}", one.state.q);
        }
    }
}

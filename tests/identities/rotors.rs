//! Identities of every rotor in every state.

use sincro_dynamics::aero::rotor::{Drag, Load, Rotor, RotorSpec, Spin, Validity};
use sincro_dynamics::spatial::Vec3;
use sincro_math::{Dual, LaneVisitor, Lanes, Real, lanes};

use crate::random::Random;

const DENSITY: f64 = 1.225;

fn between(r: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * (0.5 + 0.5 * r.unit())
}

/// Any rotor of reasonable shape, pitch of either sign included.
fn random_rotor(r: &mut Random, pitch: (f64, f64)) -> RotorSpec {
    RotorSpec {
        radius: between(r, 0.03, 3.0),
        chord: between(r, 0.005, 0.05),
        n_blades: 1 + r.below(5) as u32,
        lift_slope: between(r, 4.0, 6.3),
        collective_pitch: between(r, pitch.0, pitch.1),
        drag: Drag { cd0: between(r, 0.0, 0.02), k_cd: between(r, 0.0, 0.5) },
        spin: if r.below(2) == 0 { Spin::Clockwise } else { Spin::CounterClockwise },
    }
}

/// A state in which the theory is meant to work: tips at 60 to 200 m/s.
fn working_state(r: &mut Random, rotor: &RotorSpec) -> (f64, Vec3<f64>) {
    let tip = between(r, 60.0, 200.0);
    let velocity = Vec3([0.1 * tip * r.unit(), 0.1 * tip * r.unit(), tip * between(r, -0.02, 0.05)]);
    (tip / rotor.radius, velocity)
}

fn parts(load: &Load<f64>) -> [f64; 4] {
    [load.thrust, load.torque, load.inflow, load.power]
}

#[test]
fn thrust_grows_with_the_square_of_the_speed_at_equal_ratios() {
    let mut r = Random::new(21);
    for _ in 0..2000 {
        let spec = random_rotor(&mut r, (-0.3, 0.3));
        let rotor = Rotor::new(spec).unwrap();
        let (speed, velocity) = working_state(&mut r, &spec);
        let factor = between(&mut r, 0.1, 5.0);
        let one = rotor.evaluate(DENSITY, speed, velocity);
        let two = rotor.evaluate(DENSITY, factor * speed, velocity.scale(factor));
        let size = DENSITY * rotor.area() * (speed * spec.radius) * (speed * spec.radius) * factor * factor;
        assert!((two.thrust - factor * factor * one.thrust).abs() < 1e-13 * size);
        assert!((two.torque - factor * factor * one.torque).abs() < 1e-13 * size * spec.radius);
    }
}

#[test]
fn climb_costs_thrust_and_dual_numbers_know_how_much() {
    let mut r = Random::new(22);
    let (mut n_valid, mut worst) = (0, 0.0f64);
    for _ in 0..2000 {
        let spec = random_rotor(&mut r, (0.08, 0.3));
        let rotor = Rotor::new(spec).unwrap();
        let (speed, velocity) = working_state(&mut r, &spec);
        let load = rotor.evaluate(DENSITY, speed, velocity);
        if rotor.validity(speed, velocity, &load, 0) != Validity::Valid {
            continue;
        }
        n_valid += 1;
        let [x, y, z] = velocity.0;
        let inputs = [speed, x, y, z];
        let at = |u: [f64; 4]| parts(&rotor.evaluate(DENSITY, u[0], Vec3([u[1], u[2], u[3]])));
        let dual = |k: usize| Dual::<4>::variable(inputs[k], k);
        let tip = speed * spec.radius;
        let force = DENSITY * rotor.area() * tip * tip;
        let units = [force, force * spec.radius, tip, force * tip];
        let d = rotor.evaluate(DENSITY, dual(0), Vec3([dual(1), dual(2), dual(3)]));
        assert!(d.thrust.partials[3] < 0.0, "{spec:?} {speed} {velocity:?}");
        for k in 0..4 {
            let scale = if k == 0 { speed } else { speed * spec.radius };
            let step = 1e-5 * scale;
            let moved = |by: f64| {
                let mut u = inputs;
                u[k] += by;
                at(u)
            };
            let (ahead, back) = (moved(step), moved(-step));
            for (j, part) in [d.thrust, d.torque, d.inflow, d.power].into_iter().enumerate() {
                let difference = (ahead[j] - back[j]) / (2.0 * step);
                worst = worst.max((part.partials[k] - difference).abs() * scale / units[j]);
            }
        }
        let values = [d.thrust.value, d.torque.value, d.inflow.value, d.power.value];
        assert_eq!(values.map(f64::to_bits), parts(&load).map(f64::to_bits));
    }
    assert!(n_valid > 1500, "{n_valid}");
    // in units of ρAV² by V; the differences' own error is the square of the step by the third derivative, 1e-10 · 1e3
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn the_derivative_in_hover_is_the_closed_form() {
    let drag = Drag { cd0: 0.0087, k_cd: 0.4 };
    let spin = Spin::CounterClockwise;
    let (radius, chord, pitch) = (0.2032, 0.025, 0.1412);
    let spec = RotorSpec { radius, chord, n_blades: 4, lift_slope: 5.7, collective_pitch: pitch, drag, spin };
    let rotor = Rotor::new(spec).unwrap();
    let speed = 720.597;
    let z = Dual::<1>::variable(0.0, 0);
    let load = rotor.evaluate(DENSITY, Dual::constant(speed), Vec3([Dual::zero(), Dual::zero(), z]));
    let k1 = rotor.solidity() * 5.7 / 8.0;
    let x = load.inflow.value / (speed * radius);
    let expected = -2.0 * DENSITY * rotor.area() * speed * radius * k1 * x / (2.0 * x + k1);
    assert!((load.thrust.partials[0] / expected - 1.0).abs() < 1e-14);
    assert!((load.thrust.partials[0] + 1.355_162).abs() < 1e-6);
}

#[test]
fn momentum_is_balanced() {
    let mut r = Random::new(23);
    for _ in 0..5000 {
        let spec = random_rotor(&mut r, (-0.3, 0.3));
        let rotor = Rotor::new(spec).unwrap();
        let tip = between(&mut r, 1.0, 200.0);
        let velocity = Vec3(r.vector()).scale(30.0);
        let load = rotor.evaluate(DENSITY, tip / spec.radius, velocity);
        let (h2, v, w) = (velocity[0] * velocity[0] + velocity[1] * velocity[1], velocity[2], load.inflow);
        let momentum = 2.0 * DENSITY * rotor.area() * (w - v) * (w * w + h2).sqrt();
        assert!((load.thrust - momentum).abs() < 1e-10 * (1.0 + load.thrust.abs()), "{spec:?} {tip} {velocity:?}");
    }
}

#[test]
fn spin_turns_the_torque_round_and_nothing_else() {
    let mut r = Random::new(24);
    for _ in 0..500 {
        let spec = random_rotor(&mut r, (-0.3, 0.3));
        let (speed, velocity) = working_state(&mut r, &spec);
        let turned = |spin| Rotor::new(RotorSpec { spin, ..spec }).unwrap().evaluate(DENSITY, speed, velocity);
        let (left, right) = (turned(Spin::CounterClockwise), turned(Spin::Clockwise));
        assert_eq!(
            (left.thrust, left.torque, left.inflow, left.power),
            (right.thrust, -right.torque, right.inflow, right.power)
        );
        // the reaction is against the motion
        assert!(left.torque * left.power <= 0.0);
    }
}

#[test]
fn a_rotor_that_turns_backwards_is_its_mirror_image() {
    let mut r = Random::new(25);
    for _ in 0..500 {
        let spec = random_rotor(&mut r, (-0.3, 0.3));
        let rotor = Rotor::new(spec).unwrap();
        let (speed, Vec3([x, y, z])) = working_state(&mut r, &spec);
        let (there, here) = (Vec3([x, y, z]), Vec3([x, y, -z]));
        let (a, b) = (rotor.evaluate(DENSITY, speed, there), rotor.evaluate(DENSITY, -speed, here));
        assert_eq!((a.thrust, a.torque, a.inflow, a.power), (-b.thrust, -b.torque, -b.inflow, b.power));
        assert_eq!(rotor.validity(speed, there, &a, 0), rotor.validity(-speed, here, &b, 0));
    }
}

#[test]
fn in_axial_flight_power_is_thrust_times_inflow_and_drag() {
    let mut r = Random::new(26);
    for _ in 0..2000 {
        let spec = random_rotor(&mut r, (-0.3, 0.3));
        let rotor = Rotor::new(spec).unwrap();
        let (speed, Vec3([_, _, z])) = working_state(&mut r, &spec);
        let load = rotor.evaluate(DENSITY, speed, Vec3([0.0, 0.0, z]));
        let (tip, w, pitch, s) = (speed * spec.radius, load.inflow, spec.collective_pitch, rotor.solidity());
        let Drag { cd0, k_cd } = spec.drag;
        let of_drag =
            s * (cd0 + k_cd * pitch * pitch) * tip * tip / 8.0 + 0.25 * s * k_cd * w * (w - 4.0 * pitch * tip / 3.0);
        let expected = load.thrust * w + DENSITY * rotor.area() * tip * of_drag;
        let size = DENSITY * rotor.area() * tip * tip * tip;
        assert!((load.power - expected).abs() < 1e-14 * size, "{} {expected}", load.power);
        assert!((load.power + spec.spin.sign() * load.torque * speed).abs() < 1e-14 * size);
    }
}

/// Speeds and velocities of every size, rest, and both signs.
fn any_number(r: &mut Random, size: f64) -> f64 {
    match r.below(12) {
        0 => 0.0,
        1 => -0.0,
        2 => 1e-5 * r.unit(),
        3 => 1e-160 * r.unit(),
        4 => 5e-324,
        5 => 1e150 * r.unit(),
        6 => {
            if r.below(2) == 0 {
                f64::MAX
            } else {
                -f64::MAX
            }
        }
        _ => size * r.unit(),
    }
}

#[test]
fn every_state_has_a_finite_load() {
    let mut r = Random::new(27);
    for _ in 0..20_000 {
        let rotor = Rotor::new(random_rotor(&mut r, (-1.5, 1.5))).unwrap();
        let speed = any_number(&mut r, 1000.0);
        let velocity = Vec3([any_number(&mut r, 20.0), any_number(&mut r, 20.0), any_number(&mut r, 20.0)]);
        let load = rotor.evaluate(DENSITY, speed, velocity);
        assert!(parts(&load).iter().all(|x| x.is_finite()), "{rotor:?} {speed} {velocity:?}: {load:?}");
        let validity = rotor.validity(speed, velocity, &load, 0);
        assert!(speed != 0.0 || validity == Validity::Standing);
        let dual = |x: f64, k: usize| Dual::<4>::variable(x, k);
        let [x, y, z] = velocity.0;
        let d = rotor.evaluate(DENSITY, dual(speed, 0), Vec3([dual(x, 1), dual(y, 2), dual(z, 3)]));
        assert_eq!(d.thrust.value.to_bits(), load.thrust.to_bits());
        assert!(d.thrust.partials.iter().all(|p| p.is_finite()), "{rotor:?} {speed} {velocity:?}: {d:?}");
    }
}

#[test]
fn the_extremes_of_shape_stay_finite() {
    let drag = Drag { cd0: 1e3, k_cd: 1e3 };
    for (radius, chord) in [(1e-6, 1e6), (1e6, 1e-6), (1e6, 1e6), (1e-6, 1e-6)] {
        for collective_pitch in [-1.5, 0.0, 1.5] {
            let spin = Spin::Clockwise;
            let spec = RotorSpec { radius, chord, n_blades: u32::MAX, lift_slope: 1e3, collective_pitch, drag, spin };
            let rotor = Rotor::new(spec).unwrap();
            for speed in [0.0, 1.0, f64::MAX, -f64::MAX] {
                for v in [0.0, 1.0, f64::MAX, -f64::MAX] {
                    for h in [0.0, 1.0, f64::MAX] {
                        let load = rotor.evaluate(DENSITY, speed, Vec3([h, 0.0, v]));
                        assert!(parts(&load).iter().all(|x| x.is_finite()), "{spec:?} {speed} {v} {h}: {load:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_not_finite_is_not_hidden() {
    let rotor = Rotor::new(random_rotor(&mut Random::new(28), (0.1, 0.2))).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(rotor.evaluate(DENSITY, bad, Vec3([0.0; 3])).thrust.is_nan());
        assert!(rotor.evaluate(DENSITY, 100.0, Vec3([0.0, bad, 0.0])).thrust.is_nan());
        assert!(rotor.evaluate(DENSITY, 100.0, Vec3([0.0, 0.0, bad])).thrust.is_nan());
    }
}

/// Evaluates a rotor in lanes of any kind and compares each lane with the scalar.
struct EachLane<'a>(&'a Rotor, &'a [[f64; 4]]);

impl LaneVisitor for EachLane<'_> {
    type Output = ();
    #[inline(always)]
    fn visit<R: Real>(self) {
        let Self(rotor, states) = self;
        for states in states.chunks_exact(R::LANES) {
            let number = |j: usize| R::from_lanes(|k| states[k][j]);
            let load = rotor.evaluate(DENSITY, number(0), Vec3([number(1), number(2), number(3)]));
            for (k, [speed, x, y, z]) in states.iter().enumerate() {
                let alone = rotor.evaluate(DENSITY, *speed, Vec3([*x, *y, *z]));
                let lane = [load.thrust, load.torque, load.inflow, load.power].map(|part| part.lane(k));
                assert_eq!(lane.map(f64::to_bits), parts(&alone).map(f64::to_bits));
            }
        }
    }
}

#[test]
fn lanes_have_the_bits_of_single_rotors() {
    let mut r = Random::new(29);
    for _ in 0..200 {
        let rotor = Rotor::new(random_rotor(&mut r, (-0.3, 0.3))).unwrap();
        let mut state = || {
            let speed = any_number(&mut r, 1000.0);
            [speed, any_number(&mut r, 20.0), any_number(&mut r, 20.0), any_number(&mut r, 20.0)]
        };
        let states: [[f64; 4]; 32] = core::array::from_fn(|_| state());
        lanes::dispatch_lanes(EachLane(&rotor, &states));
        EachLane(&rotor, &states).visit::<Lanes<4>>();
    }
}

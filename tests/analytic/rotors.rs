//! Rotors against computed tables, hover in closed form, and what the published script gives.
//!
//! `states.csv` of the scene `rotor-bemt` and `rotor-inflow-grid.csv` were computed independently (Brent's method in
//! Python) with twelve digits; the columns of the printed script are a transcription that was compared with the Lua
//! text in a Lua interpreter.

use sincro_dynamics::aero::rotor::{CoefficientTable, TableRow};
use sincro_dynamics::aero::rotor::{Drag, Rotor, RotorSpec, Spin, StockPropeller, Validity, printed};
use sincro_dynamics::spatial::{Mat3, Vec3};

const TABLE: &str = include_str!("../../scenes/rotor-bemt/states.csv");
const GRID: &str = include_str!("../third-party/data/rotor-inflow-grid.csv");

const DENSITY: f64 = 1.225;

/// The printed script for an upright rotor that moves at `velocity`.
fn printed_at(speed: f64, velocity: [f64; 3]) -> printed::Printed<f64> {
    printed::evaluate(&spec(), DENSITY, speed, Vec3(velocity), &Mat3::identity())
}

/// The quadrotor's rotor of the thesis; drag of a common section.
fn spec() -> RotorSpec {
    RotorSpec {
        radius: 0.2032,
        chord: 0.025,
        n_blades: 4,
        lift_slope: 5.7,
        collective_pitch: 0.1412,
        drag: Drag { cd0: 0.0087, k_cd: 0.4 },
        spin: Spin::CounterClockwise,
    }
}

fn rotor() -> Rotor {
    Rotor::new(spec()).unwrap()
}

/// Rows of numbers below a header.
fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

/// States of the table: speed, forward and vertical velocity, thrust, torque, inflow, flag, the printed script's
/// thrust.
fn states() -> Vec<Vec<f64>> {
    // the first two columns are times of the scene
    rows(TABLE).into_iter().map(|row| row[2..].to_vec()).collect()
}

/// The tables have twelve digits.
fn close(x: f64, expected: f64) -> bool {
    (x - expected).abs() <= 1e-9 * expected.abs() + 1e-12
}

#[test]
fn the_table_of_states_is_reproduced() {
    let (rotor, rows) = (rotor(), states());
    assert_eq!(rows.len(), 168);
    for row in rows {
        let [speed, h, v, thrust, torque, inflow, flag] = row[..7] else { panic!("a row of seven and one") };
        let velocity = Vec3([0.6 * h, -0.8 * h, v]);
        let load = rotor.evaluate(DENSITY, speed, velocity);
        assert!(close(load.thrust, thrust), "thrust {} at {row:?}", load.thrust);
        assert!(close(load.torque, torque), "torque {} at {row:?}", load.torque);
        assert!(close(load.inflow, inflow), "inflow {} at {row:?}", load.inflow);
        assert!(close(load.power, -torque * speed), "power {} at {row:?}", load.power);
        let validity = rotor.validity(speed, velocity, &load, 0);
        assert_eq!(validity == Validity::Valid, flag == 0.0, "{validity:?} at {row:?}");
    }
}

#[test]
fn the_grid_of_inflow_ratios_is_reproduced() {
    let (rotor, rows) = (rotor(), rows(GRID));
    assert_eq!(rows.len(), 195);
    for row in rows {
        let tip = 100.0 * 0.2032;
        let load = rotor.evaluate(DENSITY, 100.0, Vec3([row[0] * tip, 0.0, row[1] * tip]));
        assert!(close(load.inflow / tip, row[2]), "{row:?}");
    }
}

#[test]
fn hover_is_the_closed_form() {
    let rotor = rotor();
    let k1 = rotor.solidity() * 5.7 / 8.0;
    let k2 = k1 * 0.1412 * 2.0 / 3.0;
    let x = (-k1 + (k1 * k1 + 4.0 * k2).sqrt()) / 2.0;
    let load = rotor.evaluate(DENSITY, 1.0, Vec3([0.0; 3]));
    assert!((rotor.solidity() - 0.156_648_566_0).abs() < 1e-10 && (k1 - 0.111_612_103_3).abs() < 1e-10);
    assert!((x - 0.060_901_851_787).abs() < 1e-12);
    // a few roundings
    assert!((load.inflow / 0.2032 - x).abs() < 1e-15);
    assert!((load.thrust / 4.867_116_789_9e-5 - 1.0).abs() < 1e-10);
    // the thesis rounds to 1.9468e-4 for four
    assert!((load.thrust / (1.9468e-4 / 4.0) - 1.0).abs() < 2.5e-5);
    assert!((-load.torque / 8.7564e-7 - 1.0).abs() < 1e-4);
    let merit = load.thrust * (load.thrust / (2.0 * DENSITY * rotor.area())).sqrt() / load.power;
    assert!((merit - 0.688).abs() < 5e-4, "{merit}");
    let speed = (10.305 * 9.81 / 4.0 / load.thrust).sqrt();
    assert!((speed - 720.597).abs() < 5e-4);
    assert!((rotor.evaluate(DENSITY, speed, Vec3([0.0; 3])).inflow - 8.918).abs() < 5e-4);
}

#[test]
fn in_axial_flight_the_printed_script_agrees() {
    for speed in [300.0, 600.0, 750.0, 900.0] {
        for k in 0..29 {
            let v = -4.0 + f64::from(k) * 0.5;
            let good = rotor().evaluate(DENSITY, speed, Vec3([0.0, 0.0, v]));
            let bad = printed_at(speed, [0.0, 0.0, v]);
            // its guard of 1e-6 in the arc sine
            assert!((good.thrust - bad.thrust).abs() < 2e-5, "{speed} {v}: {}", good.thrust - bad.thrust);
        }
    }
}

#[test]
fn the_printed_script_is_not_a_number_where_it_was() {
    let mut n_bad = 0;
    for row in rows(GRID) {
        let tip = 100.0 * 0.2032;
        let x = printed_at(100.0, [row[0] * tip, 0.0, row[1] * tip]).inflow_ratio;
        assert!(x.is_nan() == row[4].is_nan() && (x.is_nan() || (x - row[4]).abs() < 1e-9), "{x} {row:?}");
        n_bad += usize::from(x.is_nan());
    }
    assert_eq!(n_bad, 79); // of 180 with forward speed, none of 15 without
    // at 1e-5 rad/s in axial flight its discriminant is the rounding of its cosine (3e-16 of its terms): of either sign
    for row in states().into_iter().filter(|row| row[0] > 0.0 || row[1] > 0.0) {
        let bad = printed_at(row[0] + 1e-5, [row[1], 0.0, row[2]]).thrust;
        assert!(bad.is_nan() == row[7].is_nan() && (bad.is_nan() || close(bad, row[7])), "{bad} {row:?}");
    }
}

#[test]
fn the_printed_script_fails_on_half_of_the_envelope() {
    let counts = [20.0, 50.0, 100.0, 200.0, 400.0, 600.0, 750.0, 900.0].map(|speed| {
        let states = (0..31).flat_map(|i| (0..61).map(move |j| (f64::from(i) * 0.5, f64::from(j) * 0.5 - 15.0)));
        states.filter(|(x, z)| printed_at(speed, [*x, 0.0, *z]).thrust.is_nan()).count()
    });
    assert_eq!(counts, [1872, 1826, 1672, 1350, 622, 106, 0, 0]); // 7448 of 15128
}

#[test]
fn the_printed_script_loses_thrust_in_forward_flight() {
    for (mu, lost) in [(0.02, 2.5), (0.05, 12.0), (0.1, 29.0), (0.2, 44.0)] {
        let along = mu * 100.0 * 0.2032;
        let good = rotor().evaluate(DENSITY, 100.0, Vec3([along, 0.0, 0.0])).thrust;
        let bad = printed_at(100.0, [along, 0.0, 0.0]).thrust;
        assert!((100.0 * (1.0 - bad / good) - lost).abs() < 0.5, "{mu}: {}", 100.0 * (1.0 - bad / good));
    }
}

#[test]
fn particles_are_counted_exactly() {
    let propeller = StockPropeller::default();
    // the step is the fraction that was typed, not that of its bits
    for (step, numerator, denominator) in [
        (1e-9, 1, 1_000_000_000),
        (0.005, 5, 1000),
        (0.01, 1, 100),
        (0.05, 1, 20),
        (0.3, 3, 10),
        (0.033333333, 33_333_333, 1_000_000_000),
        (1.5, 3, 2),
    ] {
        let mut sum = 0;
        for k in 0..4000_u64 {
            sum += propeller.count(k, step);
            assert_eq!(sum, 430 * (k + 1) * numerator / denominator, "step {step} at {k}");
        }
    }
    let counts = |step: f64, n: u64| -> Vec<u64> { (0..n).map(|k| propeller.count(k, step)).collect() };
    assert_eq!(counts(0.05, 6), [21, 22, 21, 22, 21, 22]);
    assert_eq!(counts(0.005, 14), [2, 2, 2, 2, 2, 2, 3, 2, 2, 2, 2, 2, 2, 3]);
    // a century of milliseconds in: no drift, no overflow
    let century = 3_155_760_000_000_u64;
    assert_eq!((0..100).map(|k| propeller.count(century + k, 0.001)).sum::<u64>(), 43);
    // 0.3333333333333333 is less than a third
    assert_eq!((0..3000).map(|k| propeller.count(k, 1.0 / 3.0)).sum::<u64>(), 429_999);
    assert_eq!(propeller.count(5, 0.0), 0);
}

#[test]
fn the_stock_propeller_gives_its_mean_force() {
    let propeller = StockPropeller::default();
    assert!((propeller.mean_force(1.0) - 0.239_219_190_601).abs() < 1e-12);
    assert_eq!(propeller.torque(20.0), -0.04);
    for (step, n) in [(0.05, 2_u64), (0.005, 20)] {
        // a whole number of cycles: 43 particles in 0.1 s
        let force = |k: u64| propeller.flow(k, step) * 7.5;
        let mean = (0..n).map(force).sum::<f64>() / n as f64;
        assert!((mean / propeller.mean_force(7.5) - 1.0).abs() < 1e-9, "{mean}");
        // a second anywhere: to one particle
        let per_second = (1.0 / step).round() as u64;
        for start in 0..50 {
            let mean = (start..start + per_second).map(force).sum::<f64>() / per_second as f64;
            assert!((mean / propeller.mean_force(7.5) - 1.0).abs() <= 1.0 / 430.0 + 1e-12);
        }
    }
}

#[test]
fn a_table_of_coefficients_is_linear_inside_and_constant_outside() {
    let row = |advance, thrust, torque| TableRow { advance, thrust, torque };
    let rows = vec![row(0.0, 0.1, 0.01), row(0.5, 0.06, 0.008), row(1.0, -0.02, 0.001)];
    let table = CoefficientTable::new(0.4, Spin::Clockwise, rows).unwrap();
    let turns = 50.0;
    let speed = turns * core::f64::consts::TAU;
    let square = DENSITY * turns * turns * 0.4f64.powi(4);
    for (j, c_t, c_q) in [(-1.0, 0.1, 0.01), (0.25, 0.08, 0.009), (0.75, 0.02, 0.004_5), (2.0, -0.02, 0.001)] {
        let load = table.evaluate(DENSITY, speed, Vec3([3.0, 0.0, j * turns * 0.4]));
        let torque = square * 0.4 * c_q;
        assert!((load.thrust - square * c_t).abs() < 1e-12 * square && (load.torque - torque).abs() < 1e-12 * square);
        assert!((load.power - torque * speed).abs() < 1e-9 * torque * speed);
        let mirrored = table.evaluate(DENSITY, -speed, Vec3([3.0, 0.0, -j * turns * 0.4]));
        assert_eq!((mirrored.thrust, mirrored.torque), (-load.thrust, -load.torque));
    }
    for v in [-5.0, 0.0, 5.0] {
        assert_eq!(table.evaluate(DENSITY, 0.0, Vec3([0.0, 0.0, v])).thrust.abs(), 0.0);
    }
    let single = CoefficientTable::new(0.4, Spin::Clockwise, vec![row(0.3, 0.1, 0.01)]).unwrap();
    assert!((single.evaluate(DENSITY, speed, Vec3([0.0; 3])).thrust - square * 0.1).abs() < 1e-12 * square);
}

#[test]
fn wrong_numbers_are_refused_all_at_once() {
    let drag = Drag { cd0: -1.0, k_cd: f64::INFINITY };
    let bad = RotorSpec {
        radius: 0.0,
        chord: f64::NAN,
        n_blades: 0,
        lift_slope: -1.0,
        collective_pitch: 9.0,
        drag,
        ..spec()
    };
    let diagnostics = Rotor::new(bad).unwrap_err();
    assert_eq!(diagnostics.len(), 7, "{diagnostics:?}");
    assert_eq!(diagnostics[0], "`radius` is 0 m: expected a number from 0.000001 to 1000000 m");
    let row = TableRow { advance: 0.0, thrust: f64::NAN, torque: 0.0 };
    assert_eq!(CoefficientTable::new(-1.0, Spin::Clockwise, vec![row, row]).unwrap_err().len(), 4);
    assert_eq!(CoefficientTable::new(1.0, Spin::Clockwise, vec![]).unwrap_err().len(), 1);
    assert_eq!(StockPropeller { density: -1.0, ..StockPropeller::default() }.problems().len(), 1);
}

/// Near the ground w = κ v_i in hover, κ = 1 − (R/4z)²: of w²/κ + a w − S = 0 the positive root.
#[test]
fn hover_near_the_ground_is_the_closed_form() {
    let (rotor, speed) = (rotor(), 720.6);
    let tip = speed * spec().radius;
    let lift = rotor.solidity() * spec().lift_slope / 8.0;
    let (a, supply) = (lift * tip, lift * spec().collective_pitch * (2.0 / 3.0) * tip * tip);
    for (height, effective) in [(0.15, 0.15), (0.3, 0.3), (1.0, 1.0), (0.01, 0.5 * spec().radius)] {
        let ratio: f64 = spec().radius / (4.0 * effective);
        let kappa = 1.0 - ratio * ratio;
        let w = 0.5 * (-kappa * a + (kappa * kappa * a * a + 4.0 * kappa * supply).sqrt());
        let load = rotor.evaluate_near_ground(1.225, speed, Vec3([0.0; 3]), height);
        assert!((load.inflow - w).abs() < 1e-12 * w, "{height}: {} {w}", load.inflow);
        let thrust = 2.0 * 1.225 * rotor.area() * (supply - a * w);
        assert!((load.thrust - thrust).abs() < 1e-11 * thrust);
    }
}

/// In fast forward flight, and far up, the ground does nothing; its effect falls with height and with speed.
#[test]
fn the_ground_effect_fades_with_height_and_speed() {
    let thrust = |velocity: [f64; 3], height: f64| {
        let velocity = Vec3(velocity);
        let near = rotor().evaluate_near_ground(1.225, 720.6, velocity, height);
        near.thrust / rotor().evaluate(1.225, 720.6, velocity).thrust - 1.0
    };
    let over_height: Vec<f64> = [0.15, 0.3, 0.6, 1.2, 100.0].map(|height| thrust([0.0; 3], height)).to_vec();
    assert!(over_height.windows(2).all(|pair| pair[0] > pair[1]) && over_height[4] < 1e-6, "{over_height:?}");
    let over_speed: Vec<f64> = [0.0, 5.0, 15.0, 40.0].map(|v| thrust([v, 0.0, 0.0], 0.2)).to_vec();
    assert!(over_speed.windows(2).all(|pair| pair[0] > pair[1]) && over_speed[3] < 2e-3, "{over_speed:?}");
}

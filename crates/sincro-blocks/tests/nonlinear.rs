//! Nonlinear blocks against what their words say, at and beside their corners.

mod common;

use std::sync::Arc;

use common::{Samples, add, answer, block, faults, list, rows, value};
use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::Diagram;
use sincro_blocks::library::nonlinear::LookupTable;
use sincro_blocks::library::sources::Constant;
use sincro_blocks::reader::Value;
use sincro_blocks::runner::Runner;
use sincro_blocks::simulator::Simulator;
use sincro_math::Dual;

const STEP: f64 = 0.125;

#[test]
fn a_saturation_has_limits_for_every_component() {
    let limits = || block("saturation", &[("lower", list(&[-1.0, -2.0, -3.0])), ("upper", 1.5.into())]);
    assert_eq!(value(&[-5.0, -5.0, 5.0], limits()), [-1.0, -2.0, 1.5]);
    assert_eq!(value(&[-5.0], block("saturation", &[("upper", 1.0.into())])), [-5.0]);
    assert!(faults("saturation", &[("lower", list(&[0.0, 2.0])), ("upper", 1.0.into())]).contains("is above"));
    assert_eq!(limits().label(), "[-1 -2 -3] … 1.5");
}

#[test]
fn a_dead_zone_takes_its_width_away() {
    let zone = || block("dead-zone", &[("lower", (-1.0).into()), ("upper", 2.0.into())]);
    assert_eq!(value(&[-3.0, -1.0, 0.5, 2.0, 2.5], zone()), [-2.0, 0.0, 0.0, 0.0, 0.5]);
}

#[test]
fn a_quantizer_rounds_halves_away_from_zero() {
    let y = value(&[0.124, 0.125, -0.125, 0.7], block("quantizer", &[("interval", 0.25.into())]));
    assert_eq!(y, [0.0, 0.25, -0.25, 0.75]);
    let zero = value(&[-0.1, -0.0], block("quantizer", &[("interval", 0.25.into())]));
    assert!(zero.iter().all(|y| y.is_sign_positive()), "{zero:?}");
}

#[test]
fn single_precision_has_24_bits_and_rounds_ties_to_even() {
    let tie = 1.0 + f64::from(f32::EPSILON) / 2.0;
    let y = value(&[0.1, tie, -16_777_217.0, 1e-60, 1e300], block("single-precision", &[]));
    assert_eq!(y, [f64::from(0.1_f32), 1.0, -16_777_216.0, 0.0, f64::INFINITY]);
}

#[test]
fn friction_acts_with_the_sign_of_the_velocity() {
    let y = value(&[-2.0, 0.0, 3.0], block("coulomb-friction", &[("coulomb", 0.5.into()), ("viscous", 2.0.into())]));
    assert_eq!(y, [-4.5, 0.0, 6.5]);
}

#[test]
fn nothing_hides_what_is_not_a_number() {
    let blocks: [(&str, Vec<(&str, Value)>); 9] = [
        ("single-precision", vec![]),
        ("saturation", vec![("lower", 0.0.into()), ("upper", 1.0.into())]),
        ("dead-zone", vec![("lower", 0.0.into()), ("upper", 1.0.into())]),
        ("quantizer", vec![("interval", 1.0.into())]),
        ("coulomb-friction", vec![("coulomb", 1.0.into())]),
        ("rate-limiter", vec![("rising", 1.0.into())]),
        ("backlash", vec![("width", 1.0.into())]),
        ("relay", vec![("on_above", 1.0.into()), ("off_below", 0.0.into())]),
        ("lookup-table", vec![("breakpoints", list(&[0.0, 1.0])), ("values", list(&[0.0, 1.0]))]),
    ];
    for (kind, parameters) in blocks {
        let y = answer(&[0.5, f64::NAN], STEP, block(kind, &parameters));
        assert!(!y[0].is_nan() && y[1].is_nan(), "{kind} {y:?}");
    }
}

#[test]
fn a_rate_limiter_climbs_at_its_rate_and_then_follows_to_the_bit() {
    let u = [0.1, 1.1, 1.1, 1.1, 1.1, 0.0];
    let y = answer(&u, STEP, block("rate-limiter", &[("rising", 4.0.into()), ("falling", 8.0.into())]));
    assert_eq!(y, [0.1, 0.6, 1.1, 1.1, 1.1, 1.1 - 1.0]);
    let from_zero = block("rate-limiter", &[("rising", 4.0.into()), ("initial", 0.0.into())]);
    assert_eq!(answer(&[-2.0; 4], STEP, from_zero), [-0.5, -1.0, -1.5, -2.0]);
}

#[test]
fn backlash_moves_only_at_the_ends_of_its_gap() {
    let u = [0.0, 0.5, 1.0, 2.0, 1.5, 1.0, 0.5, 0.0];
    let y = answer(&u, STEP, block("backlash", &[("width", 1.0.into())]));
    assert_eq!(y, [0.0, 0.0, 0.5, 1.5, 1.5, 1.5, 1.0, 0.5]);
}

#[test]
fn a_relay_keeps_its_state_between_its_thresholds() {
    let u = [0.5, 1.0, 1.1, 0.5, 0.0, -0.1, 0.5, 1.1];
    let parameters = [("on_above", 1.0.into()), ("off_below", 0.0.into()), ("on", 5.0.into()), ("off", (-5.0).into())];
    let y = answer(&u, STEP, block("relay", &parameters));
    assert_eq!(y, [-5.0, -5.0, 5.0, 5.0, 5.0, -5.0, -5.0, 5.0]);
    let swapped = [("on_above", 0.0.into()), ("off_below", 1.0.into())];
    assert!(faults("relay", &swapped).contains("`off_below` 1 is above `on_above` 0"));
}

fn table(extra: &[(&'static str, Value)]) -> Box<dyn sincro_blocks::instance::DynBlock> {
    let mut parameters = vec![("breakpoints", list(&[0.0, 1.0, 3.0])), ("values", list(&[0.0, 10.0, -10.0]))];
    parameters.extend_from_slice(extra);
    block("lookup-table", &parameters)
}

#[test]
fn a_table_interpolates_and_holds_or_goes_on() {
    let u = [-1.0, 0.0, 0.25, 1.0, 2.0, 3.0, 4.0];
    assert_eq!(value(&u, table(&[])), [0.0, 0.0, 2.5, 10.0, 0.0, -10.0, -10.0]);
    let on = table(&[("extrapolation", "linear".into())]);
    assert_eq!(value(&u, on), [-10.0, 0.0, 2.5, 10.0, 0.0, -10.0, -20.0]);
    let nearest = table(&[("interpolation", "nearest".into())]);
    assert_eq!(value(&[-1.0, 0.49, 0.5, 1.9, 2.0, 9.0], nearest), [0.0, 0.0, 10.0, 10.0, -10.0, -10.0]);
    let previous = table(&[("interpolation", "previous".into())]);
    assert_eq!(value(&[-1.0, 0.99, 1.0, 2.9, 3.0, 9.0], previous), [0.0, 0.0, 10.0, 10.0, -10.0, -10.0]);
}

#[test]
fn a_table_may_stand_in_a_file() {
    assert_eq!(value(&[0.25, 2.0], block("lookup-table", &[("file", "table.csv".into())])), [2.5, 0.0]);
    let wrong = faults("lookup-table", &[("file", "table.csv".into()), ("values_column", "z".into())]);
    assert!(wrong.contains("no column `z`"), "{wrong}");
}

#[test]
fn tables_that_do_not_rise_or_fit_are_refused() {
    let of = |x: &[f64], y: &[f64]| faults("lookup-table", &[("breakpoints", list(x)), ("values", list(y))]);
    assert!(of(&[0.0, 0.0], &[1.0, 2.0]).contains("`breakpoints` has 0 after 0"));
    assert!(of(&[0.0, 1.0], &[1.0]).contains("there are 2 breakpoints and 1 values"));
}

#[test]
fn a_table_of_two_arguments_is_bilinear() {
    let grid = |extrapolation: &str| {
        let parameters = [
            ("row_breakpoints", list(&[0.0, 2.0])),
            ("column_breakpoints", list(&[0.0, 1.0, 4.0])),
            ("values", rows(&[&[0.0, 1.0, 4.0], &[2.0, 5.0, 14.0]])),
            ("extrapolation", extrapolation.into()),
        ];
        block("lookup-table-2d", &parameters)
    };
    let at = |u1: f64, u2: f64, extrapolation: &str| {
        let mut d = Diagram::new();
        d.block("a", Constant::new(u1)).block("b", Constant::new(u2));
        add(&mut d, "y", grid(extrapolation));
        d.wire("a", "y.u1").wire("b", "y.u2");
        Simulator::new(&d, STEP).unwrap().output("y")[0]
    };
    // the values are those of u1 + u2 + u1·u2
    for (u1, u2) in [(0.0, 0.0), (1.0, 0.5), (2.0, 4.0), (0.5, 3.0)] {
        assert!((at(u1, u2, "hold") - (u1 + u2 + u1 * u2)).abs() < 1e-14);
    }
    assert_eq!(at(9.0, 9.0, "hold"), 14.0);
    assert!((at(3.0, 5.0, "linear") - 23.0).abs() < 1e-13);
}

#[test]
fn a_table_on_dual_numbers_has_the_slope_of_its_line() {
    let mut d = Diagram::new();
    d.block("u", Constant::new(2.0)).block("y", LookupTable::new(&[0.0, 1.0, 3.0], &[0.0, 10.0, -10.0]));
    d.sampled("held", STEP, sincro_blocks::library::discrete::ZeroOrderHold).wire("u", "held").wire("held", "y");
    let program = std::sync::Arc::new(compile(&d, &Interface::new(STEP)).unwrap());
    let mut runner = Runner::<Dual<1>>::new(program);
    runner.signals_mut()[0] = Dual::variable(2.0, 0);
    runner.evaluate(0, 0.0);
    let y = runner.signals()[2];
    assert_eq!((y.value, y.partials), (0.0, [-10.0]));
}

#[test]
fn a_saturation_counts_and_tells_when_it_limits() {
    let run = |samples: &[f64]| {
        let limits = [("lower", 0.0.into()), ("upper", 4.0.into()), ("report", true.into())];
        let mut d = Diagram::new();
        d.block("u", Samples { values: samples.to_vec() });
        add(&mut d, "limit", block("saturation", &limits));
        d.wire("u", "limit");
        let mut runner = Runner::<f64>::new(Arc::new(compile(&d, &Interface::new(0.5)).unwrap()));
        for tick in 0..samples.len() as u64 {
            runner.evaluate(tick, 0.5 * tick as f64);
            runner.update(tick, 0.5 * tick as f64);
        }
        let notices = runner.notices();
        notices.first().map(|(path, words)| format!("{path}: {words}"))
    };
    assert_eq!(run(&[0.0, 1.0, 4.0]), None, "a value at a limit is not limited");
    let once = "limit: was limited to its least value once: at t = 0.500000 s, where y was to be -3, not 0";
    assert_eq!(run(&[1.0, -3.0, 2.0]).unwrap(), once);
    let often = "limit: was limited to its least value once: at t = 1.000000 s, where y was to be -1, not 0; was limited to its \
                 greatest value in 2 samples: first at t = 0.500000 s, where y was to be 7, not 4, last at t = 2.000000 s";
    assert_eq!(run(&[1.0, 7.0, -1.0, 2.0, 5.0, 2.0]).unwrap(), often);
}

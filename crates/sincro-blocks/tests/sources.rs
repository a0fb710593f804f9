//! Sources against their closed forms.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::Diagram;
use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::Described;
use sincro_blocks::library::continuous::Integrator;
use sincro_blocks::library::sources::{
    Chirp, Clock, Constant, Distribution, Noise, Pulse, Ramp, Sawtooth, Sine, Step, Table,
};
use sincro_blocks::reader::{Files, Reader, Value};
use sincro_blocks::runner::Runner;
use sincro_blocks::simulator::Simulator;
use sincro_math::elementary::sin_cos;

/// The first `n + 1` samples of a source.
fn samples(source: impl DynBlock + 'static, step: f64, n: usize) -> Vec<f64> {
    let mut d = Diagram::new();
    d.block("source", source);
    Simulator::new(&d, step).unwrap().record("source", n)
}

/// The integral of a source over `n` steps of the method of order 4, which is exact for polynomials of degree 3 only
/// where it is told of every corner.
fn integral(source: impl DynBlock + 'static, step: f64, n: usize) -> f64 {
    let mut d = Diagram::new();
    d.block("source", source).block("x", Integrator::new(0.0)).wire("source", "x");
    Simulator::new(&d, step).unwrap().record("x", n)[n]
}

#[test]
fn a_step_has_its_new_value_at_its_instant() {
    assert_eq!(samples(Step::new(0.3, 2.0), 0.1, 5), [0.0, 0.0, 0.0, 2.0, 2.0, 2.0]);
    assert_eq!(samples(Step { time: 0.0, from: vec![5.0], to: vec![1.0] }, 0.1, 1), [1.0, 1.0]);
}

#[test]
fn a_vector_may_jump_from_one_number_to_several() {
    let mut d = Diagram::new();
    d.block("step", Step { time: 0.1, from: vec![1.0], to: vec![2.0, 3.0] });
    let mut simulator = Simulator::new(&d, 0.1).unwrap();
    assert_eq!(simulator.output("step"), [1.0, 1.0]);
    simulator.advance();
    assert_eq!(simulator.output("step"), [2.0, 3.0]);
}

#[test]
fn an_integral_ends_exactly_at_the_corners_of_its_source() {
    // rounding only: some ten additions of numbers below 1
    let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-14, "{found} {exact}");
    close(integral(Step::new(0.3, 2.0), 0.1, 5), 0.4);
    close(integral(Pulse::new(0.3, 0.1), 0.1, 9), 0.3);
    close(integral(Ramp { start: 0.2, slope: vec![2.0], from: vec![1.0], until: 0.4 }, 0.1, 6), 0.6 + 0.04 + 0.08);
    let hold = Table { hold: true, ..Table::new(&[0.1, 0.3, 0.4], &[1.0, 3.0, -1.0]) };
    close(integral(hold, 0.1, 6), 0.1 + 0.2 + 0.3 - 0.2);
    // before its jump a sawtooth is looked at 2 ns early
    assert!((integral(Sawtooth::new(0.2), 0.1, 6) - 0.3).abs() < 1e-8);
}

#[test]
fn a_ramp_is_constant_before_and_after() {
    let ramp = Ramp { start: 0.2, slope: vec![10.0], from: vec![1.0], until: 0.4 };
    let found = samples(ramp, 0.1, 6);
    for (found, expected) in found.iter().zip([1.0, 1.0, 1.0, 2.0, 3.0, 3.0, 3.0]) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}

#[test]
fn a_sine_is_one_with_phase_and_offset() {
    let sine = Sine { phase: vec![0.5], offset: vec![3.0], ..Sine::new(2.0, 4.0) };
    for (k, y) in samples(sine, 0.1, 50).iter().enumerate() {
        assert_eq!(*y, 3.0 + 2.0 * sin_cos(4.0 * (k as f64 * 0.1) + 0.5).0);
    }
}

#[test]
fn a_chirp_starts_and_ends_with_its_frequencies() {
    let (h, chirp) = (1e-4, Chirp::new(1.0, 5.0, 2.0));
    let y = samples(chirp, h, 30_000);
    // 6 cycles in the sweep; then 5 in the third second: it is back at zero, rising with 2π·5
    assert!(y[20_000].abs() < 1e-12 && y[30_000].abs() < 1e-11);
    // one-sided differences of order 1: the second derivative is below (2π·5)² = 1000
    assert!((y[1] / h - TAU).abs() < 1000.0 * h);
    assert!(((y[20_000] - y[19_999]) / h - 5.0 * TAU).abs() < 1000.0 * h);
    assert!(((y[20_001] - y[20_000]) / h - 5.0 * TAU).abs() < 1000.0 * h);
}

#[test]
fn a_pulse_train_has_its_duty_cycle() {
    let pulse = Pulse { low: vec![-1.0], high: vec![2.0], start: 0.05, ..Pulse::new(0.1, 0.03) };
    let y = samples(pulse, 0.01, 1004);
    assert!(y[..5].iter().all(|y| *y == -1.0));
    for (k, y) in y[5..].iter().enumerate() {
        assert_eq!(*y, if k % 10 < 3 { 2.0 } else { -1.0 }, "{k}");
    }
}

#[test]
fn a_sawtooth_falls_back_in_every_period() {
    let y = samples(Sawtooth { low: vec![1.0], high: vec![2.0], ..Sawtooth::new(0.1) }, 0.01, 1000);
    for (k, y) in y.iter().enumerate() {
        // the phase has the rounding of the time, 1e-15, over a period of 0.1
        assert!((y - 1.0 - (k % 10) as f64 / 10.0).abs() < 1e-13, "{k} {y}");
    }
}

#[test]
fn a_table_goes_through_its_points_and_is_constant_outside() {
    let y = samples(Table::new(&[0.1, 0.2, 0.4], &[1.0, 2.0, -2.0]), 0.05, 10);
    let expected = [1.0, 1.0, 1.0, 1.5, 2.0, 1.0, 0.0, -1.0, -2.0, -2.0, -2.0];
    for (y, expected) in y.iter().zip(expected) {
        assert!((y - expected).abs() < 1e-14, "{y} {expected}");
    }
}

#[test]
fn a_held_table_changes_at_its_instants_and_repeats() {
    let table = Table { hold: true, repeat: 0.3, ..Table::new(&[0.1, 0.2], &[1.0, 2.0]) };
    assert_eq!(samples(table, 0.1, 9), [1., 1., 2., 2., 1., 2., 2., 1., 2., 2.]);
}

#[test]
fn every_corner_of_a_table_is_told_in_every_period() {
    let table = Table { repeat: 0.5, ..Table::new(&[0.1, 0.2], &[1.0, 2.0]) };
    let (mut t, mut corners) = (-1.0, Vec::new());
    while t < 1.2 {
        t = DynBlock::next_time_event(&table, t);
        corners.push((t * 1e6).round() / 1e6);
    }
    assert_eq!(corners, [0.1, 0.2, 0.6, 0.7, 1.1, 1.2]);
}

#[test]
fn a_clock_shows_the_time_in_seconds() {
    assert_eq!(samples(Clock, 0.25, 3), [0.0, 0.25, 0.5, 0.75]);
    let mut d = Diagram::new();
    d.block("clock", Clock);
    d.entries[0].unit = vec!["ms".into()];
    assert!(compile(&d, &Interface::new(0.1)).is_err());
}

#[test]
fn noise_is_new_in_every_sample_and_the_same_again_from_anywhere() {
    let mut d = Diagram::new();
    d.sampled("a", 0.02, Noise::new(1.0)).sampled("b", 0.02, Noise::new(1.0));
    d.block("wide", Noise { mean: vec![0.0, 0.0], ..Noise::new(1.0) });
    let mut simulator = Simulator::new(&d, 0.01).unwrap();
    let a = simulator.record("a", 9);
    assert!(a.chunks(2).all(|pair| pair[0] == pair[1]), "held between samples");
    assert!(a.chunks(2).zip(a.chunks(2).skip(1)).all(|(now, next)| now[0] != next[0]));
    assert_ne!(simulator.output("a"), simulator.output("b"));
    assert_ne!(simulator.output("wide")[0], simulator.output("wide")[1]);
    // evaluated at one tick alone
    let mut runner = Runner::<f64>::new(simulator.runner.program().clone());
    runner.evaluate(8, 0.08);
    let place = runner.program().outputs().find(|(name, ..)| name == "a").unwrap().1;
    assert_eq!(runner.signals()[place][0], a[8]);
    // another run, another noise
    let other = compile(&d, &Interface { seed: 1, ..Interface::new(0.01) }).unwrap();
    let mut other = Runner::<f64>::new(other.into());
    other.evaluate(0, 0.0);
    let place = other.program().outputs().find(|(name, ..)| name == "a").unwrap().1;
    assert_ne!(other.signals()[place][0], a[0]);
}

#[test]
fn uniform_noise_fills_its_interval() {
    let uniform = Distribution::Uniform;
    let noise = Noise { distribution: uniform, low: vec![2.0], high: vec![4.0], ..Noise::new(1.0) };
    let n = 20_000;
    let y = samples(noise, 0.001, n - 1);
    assert!(y.iter().all(|y| (2.0..=4.0).contains(y)));
    let mean = y.iter().sum::<f64>() / n as f64;
    let variance = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / n as f64;
    // width²/12 = 1/3; four standard deviations of the estimates
    assert!((mean - 3.0).abs() < 4.0 * (1.0 / 3.0 / n as f64).sqrt(), "{mean}");
    assert!((variance - 1.0 / 3.0).abs() < 4.0 * ((1.0 / 5.0 - 1.0 / 9.0) / n as f64).sqrt(), "{variance}");
}

/// A file `data.csv` with the columns `t`, `x`, `y`.
struct Data;

impl Files for Data {
    fn column(&self, file: &str, column: &str) -> Result<Vec<f64>, String> {
        match (file, column) {
            ("data.csv", "t") => Ok(vec![0.0, 0.1, 0.3]),
            ("data.csv", "x") => Ok(vec![1.0, 2.0, 4.0]),
            ("data.csv", "y") => Ok(vec![0.0, -1.0, -1.0]),
            _ => Err(format!("`{file}` has no column `{column}`")),
        }
    }
}

/// A source from parameters, and what is wrong with them.
fn read<S: Described>(given: &[(&str, Value)]) -> (S, Vec<String>) {
    let given: BTreeMap<String, Value> = given.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let scope = BTreeMap::new();
    let mut reader = Reader::new(S::KIND, &given, &scope, &Data);
    let source = S::read(&mut reader);
    (source, reader.finish().into_iter().map(|fault| fault.message).collect())
}

#[test]
fn a_table_is_read_from_lists_rows_or_columns() {
    let rows = vec![vec![1.0, 0.0], vec![2.0, -1.0], vec![4.0, -1.0]];
    let (lists, faults) = read::<Table>(&[("times", vec![0.0, 0.1, 0.3].into()), ("values", rows.into())]);
    assert_eq!(faults, [""; 0]);
    let (columns, faults) = read::<Table>(&[("file", "data.csv".into()), ("columns", vec!["x", "y"].into())]);
    assert_eq!(faults, [""; 0]);
    assert_eq!(lists, columns);
    let (plain, _) = read::<Table>(&[("times", vec![0.0, 1.0].into()), ("values", vec![5.0, 6.0].into())]);
    assert_eq!(plain, Table::new(&[0.0, 1.0], &[5.0, 6.0]));
}

#[test]
fn a_table_that_makes_no_sense_is_refused() {
    let first = |given: &[(&str, Value)]| read::<Table>(given).1.join("; ");
    let pair = |a: f64, b: f64| -> Value { vec![a, b].into() };
    assert_eq!(first(&[]), "`table` has neither `times` nor `file`");
    let found = first(&[("times", pair(1.0, 1.0)), ("values", pair(0.0, 0.0))]);
    assert_eq!(found, "the time 1 s comes after 1 s");
    let found = first(&[("times", pair(0.0, 1.0)), ("values", pair(0.0, 0.0)), ("repeat", 0.5.into())]);
    assert_eq!(found, "`repeat` is 0.5 s, the table is 1 s long");
    let three: Value = vec![1.0, 2.0, 3.0].into();
    assert_eq!(first(&[("times", pair(0.0, 1.0)), ("values", three)]), "`values` has 1 rows for 2 times");
    assert!(first(&[("file", "data.csv".into()), ("columns", "z".into())]).contains("`data.csv` has no column `z`"));
}

#[test]
fn a_sine_has_exactly_one_frequency() {
    let (sine, faults) = read::<Sine>(&[("frequency_hz", 2.0.into())]);
    assert_eq!((sine.omega, faults.len()), (vec![2.0 * TAU], 0));
    assert_eq!(read::<Sine>(&[]).1, ["`sine` has no frequency"]);
    let both = [("frequency_hz", 2.0.into()), ("angular_frequency", 2.0.into())];
    assert_eq!(read::<Sine>(&both).1, ["`sine` has two frequencies"]);
}

#[test]
fn noise_has_the_parameters_of_its_distribution() {
    let given = [("distribution", "uniform".into()), ("std", 1.0.into())];
    assert_eq!(read::<Noise>(&given).1, ["uniform noise has no `std`"]);
    assert_eq!(read::<Noise>(&[("std", (-1.0).into())]).1, ["a standard deviation is negative"]);
}

#[test]
fn a_constant_is_evaluated_once() {
    assert_eq!(samples(Constant::new(2.5), 0.1, 2), [2.5; 3]);
}

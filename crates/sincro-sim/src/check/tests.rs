//! Claims about whole checks, with numbers worked by hand.

use std::sync::Arc;

use sincro_blocks::unit::Unit;
use sincro_math::expression::Expression;

use super::*;
use sincro_scene::diagnostic::{Located, Location, SourceText};
use sincro_scene::experiment::check::{Reference, Subject};

fn nowhere() -> Location {
    Location { source: Arc::new(SourceText { path: "experiment.toml".into(), text: String::new() }), span: 0..0 }
}

fn located(name: &str) -> Located<String> {
    Located { value: name.into(), at: nowhere() }
}

/// `signal` is `value`, tolerance 0.25.
fn check(signal: &str, value: f64) -> Check {
    Check {
        name: "claim".into(),
        what: Subject::Signal(located(signal)),
        aliases: Vec::new(),
        unit: None,
        parameters: Arc::new([("k".into(), 2.0)]),
        expected: Expected::Value(value),
        sense: Sense::Equal,
        measure: Measure::Error,
        target: None,
        band: 0.02,
        at: None,
        window: None,
        tolerance: 0.25,
        relative: false,
        floor: 0.0,
        location: nowhere(),
    }
}

fn reference(rows: &[(f64, f64)]) -> Expected {
    Expected::Reference(Reference {
        file: "scenes/a/reference.csv".into(),
        key_column: "t".into(),
        column: "x".into(),
        scale: 1.0,
        offset: 0.0,
        keys: rows.iter().map(|row| row.0).collect(),
        values: rows.iter().map(|row| row.1).collect(),
        location: nowhere(),
    })
}

/// A formula of the alias `x`, `t` and the parameter `k`.
fn formula(text: &str) -> Expression {
    Expression::parse(text, &["x", "t", "k"]).unwrap()
}

fn of_x(text: &str, value: &str) -> Check {
    Check {
        what: Subject::Formula(formula(text)),
        aliases: vec![("x".into(), located("/j.position"))],
        expected: Expected::Formula(formula(value)),
        ..check("", 0.0)
    }
}

/// Position 0, 1, 4, 9, 16 rad and a NaN velocity at the last of t = 0, 0.1, 0.2, 0.3, 0.4 s.
fn table() -> Table {
    let mut table = Table::new([("t", "s"), ("/j.position", "rad"), ("/j.velocity", "rad/s")], 5);
    for (k, x) in [0.0, 1.0, 4.0, 9.0, 16.0].into_iter().enumerate() {
        let v = if k == 4 { f64::NAN } else { 10.0 * k as f64 };
        table.push_row(&[k as f64 * 0.1, x, v]);
    }
    table
}

fn judged(check: Check) -> Outcome {
    evaluate(&[check], &table(), None).remove(0)
}

fn stopped(check: Check) -> Outcome {
    evaluate(&[check], &table(), Some(0.4)).remove(0)
}

fn reason(outcome: Outcome) -> String {
    assert_eq!((outcome.measured, outcome.expected, outcome.deviation), (None, None, None));
    match outcome.verdict {
        Verdict::NotMade(reason) => reason,
        verdict => panic!("{verdict:?}"),
    }
}

fn numbers(outcome: &Outcome) -> (f64, f64, f64, Option<f64>) {
    (outcome.measured.unwrap(), outcome.expected.unwrap(), outcome.deviation.unwrap(), outcome.at)
}

#[test]
fn the_worst_row_counts() {
    let outcome = judged(check("/j.position", 5.0));
    assert_eq!(numbers(&outcome), (16.0, 5.0, 11.0, Some(0.4)));
    assert_eq!((outcome.verdict, outcome.unit.as_str(), outcome.n_rows), (Verdict::Fails, "rad", 5));
    assert_eq!(outcome.about, "/j.position against 5");
    assert_eq!((outcome.signal.as_deref(), outcome.series), (Some("/j.position"), None));
}

#[test]
fn a_bound_holds_on_its_side_and_shows_the_row_nearest_to_it() {
    let bound = |sense, value| judged(Check { sense, tolerance: 0.0, ..check("/j.position", value) });
    let outcome = bound(Sense::AtMost, 16.0);
    assert_eq!((numbers(&outcome), outcome.verdict), ((16.0, 16.0, 0.0, Some(0.4)), Verdict::Holds));
    assert_eq!(outcome.about, "/j.position at most 16");
    let outcome = bound(Sense::AtMost, 15.5);
    assert_eq!((numbers(&outcome), outcome.verdict), ((16.0, 15.5, 0.5, Some(0.4)), Verdict::Fails));
    let outcome = bound(Sense::AtLeast, -1.0);
    assert_eq!((numbers(&outcome), outcome.verdict), ((0.0, -1.0, 0.0, Some(0.0)), Verdict::Holds));
    let nan = Check { sense: Sense::AtMost, tolerance: 0.0, ..check("/j.velocity", 1e9) };
    assert_eq!(judged(nan).verdict, Verdict::Fails);
}

#[test]
fn what_takes_for_ever_is_within_no_bound() {
    for sense in [Sense::AtMost, Sense::AtLeast] {
        let rising = Check { sense, measure: Measure::RiseTime, target: Some(100.0), ..check("/j.position", 1.0) };
        let outcome = judged(Check { tolerance: 0.0, ..rising });
        assert_eq!((outcome.measured, outcome.verdict), (Some(f64::INFINITY), Verdict::Fails));
        assert_eq!(outcome.unit, "s");
    }
}

#[test]
fn a_deviation_equal_to_the_tolerance_holds() {
    let at = |value| judged(Check { at: Some(0.1), ..check("/j.position", value) });
    assert_eq!(at(1.25).verdict, Verdict::Holds);
    assert_eq!(at(1.25 + 1e-15).verdict, Verdict::Fails);
    assert_eq!(at(0.75).verdict, Verdict::Holds);
}

#[test]
fn a_time_matches_its_row_within_a_nanosecond() {
    // 3·0.1 is not 0.3
    let outcome = judged(Check { at: Some(0.3), ..check("/j.position", 9.0) });
    assert_eq!((outcome.verdict, outcome.deviation, outcome.n_rows), (Verdict::Holds, Some(0.0), 1));
    assert_eq!(outcome.about, "/j.position against 9, at t = 0.3 s");
    assert_eq!(judged(Check { at: Some(0.3 + 9e-10), ..check("/j.position", 9.0) }).verdict, Verdict::Holds);
    let reason = reason(judged(Check { at: Some(0.3 + 2e-9), ..check("/j.position", 9.0) }));
    assert_eq!(reason, "no row was recorded at t = 0.300000002 s; the nearest are at 0.3 and 0.4 s");
}

#[test]
fn a_window_includes_its_ends() {
    let outcome = judged(Check { window: Some((0.1, 0.3)), ..check("/j.position", 5.0) });
    assert_eq!(numbers(&outcome), (1.0, 5.0, 4.0, Some(0.1)), "the first of equals");
    assert_eq!(outcome.n_rows, 3);
    let one = judged(Check { window: Some((0.2, 0.2)), ..check("/j.position", 4.0) });
    assert_eq!((one.verdict, one.n_rows), (Verdict::Holds, 1));
    let none = judged(Check { window: Some((0.11, 0.19)), ..check("/j.position", 4.0) });
    assert_eq!(reason(none), "no row was recorded from t = 0.11 s to 0.19 s");
}

#[test]
fn formulas_know_aliases_time_and_parameters() {
    let mut own = of_x("x + k", "100*t^2 + 2");
    own.tolerance = 1e-12;
    let outcome = judged(own);
    // a parameter in a sum has the unit of what it is added to
    assert_eq!((outcome.verdict.clone(), outcome.unit.as_str()), (Verdict::Holds, "rad"));
    let series = outcome.series.unwrap();
    assert_eq!((series.times[2], series.values[2]), (0.2, 100.0 * (0.2 * 0.2) + 2.0));
    assert_eq!((outcome.about.as_str(), outcome.signal), ("x + k against 100*t^2 + 2", None));
}

#[test]
fn units_of_formulas_follow_are_declared_or_are_those_of_what_is_expected() {
    let unit = |check: Check| judged(check).unit;
    assert_eq!(unit(of_x("sqrt(x^2)", "k")), "rad");
    assert_eq!(unit(of_x("x*t", "k")), "rad·s");
    assert_eq!(unit(of_x("k*x", "k")), "");
    assert_eq!(unit(of_x("k*x", "x")), "rad");
    let declared = Unit::parse("N·m").ok();
    assert_eq!(unit(Check { unit: declared.clone(), ..of_x("k*x", "k") }), "N·m");
    assert_eq!(unit(Check { unit: declared, measure: Measure::Integral, ..of_x("k*x", "k") }), "N·m·s");
}

#[test]
fn a_formula_that_is_only_an_alias_is_its_signal() {
    let outcome = judged(of_x("x", "k"));
    assert_eq!((outcome.signal.as_deref(), outcome.unit.as_str()), (Some("/j.position"), "rad"));
    assert_eq!(outcome.series.unwrap().values, [2.0; 5]);
}

#[test]
fn each_measure_is_compared_with_one_number() {
    let with = |measure| judged(Check { measure, ..check("/j.position", 1.0) });
    assert_eq!(numbers(&with(Measure::Final)), (16.0, 1.0, 15.0, Some(0.4)));
    assert_eq!(numbers(&with(Measure::Min)), (0.0, 1.0, 1.0, Some(0.0)));
    assert_eq!(numbers(&with(Measure::Max)), (16.0, 1.0, 15.0, Some(0.4)));
    // trapezoids: (0+1)/2 + (1+4)/2 + (4+9)/2 + (9+16)/2 = 22, times 0.1 s, over 0.4 s
    let mean = with(Measure::Mean);
    assert!((mean.measured.unwrap() - 5.5).abs() < 1e-14 && mean.at.is_none());
    let integral = with(Measure::Integral);
    assert!((integral.measured.unwrap() - 2.2).abs() < 1e-14);
    assert_eq!((integral.unit.as_str(), integral.about.as_str()), ("rad·s", "integral of /j.position against 1"));
    let time = with(Measure::TimeOfMax);
    assert_eq!((time.measured, time.unit.as_str(), time.at), (Some(0.4), "s", None));
}

#[test]
fn the_integral_of_a_window_is_that_between_its_rows() {
    let window = Some((0.1, 0.3));
    let outcome = judged(Check { window, measure: Measure::Integral, ..check("/j.position", 1.3) });
    // (1 + 4)/2 + (4 + 9)/2, times 0.1 s
    assert!((outcome.measured.unwrap() - 0.9).abs() < 1e-14);
    let one = judged(Check { at: Some(0.1), measure: Measure::Integral, ..check("/j.position", 1.3) });
    assert_eq!(reason(one), "the measure `integral` needs two rows, there is one");
}

#[test]
fn what_varies_is_measured_as_the_signal_is() {
    let with = |measure, value: &str| judged(Check { measure, ..of_x("x", value) });
    assert_eq!(numbers(&with(Measure::Final, "k")), (16.0, 2.0, 14.0, Some(0.4)), "a number");
    assert_eq!(with(Measure::Integral, "1.1*k").verdict, Verdict::Holds, "a number, not its integral 0.88");
    assert_eq!(with(Measure::Final, "100*t^2").verdict, Verdict::Holds, "the formula at the last row");
    let mean = with(Measure::Mean, "10*t");
    // 0, 1, 2, 3, 4 have the mean 2
    assert!((mean.expected.unwrap() - 2.0).abs() < 1e-15);
    let expected = reference(&[(0.1, 7.0), (0.3, 5.0), (0.4, 6.0)]);
    let peak = judged(Check { measure: Measure::Max, expected: expected.clone(), ..check("/j.position", 0.0) });
    assert_eq!(numbers(&peak), (16.0, 7.0, 9.0, Some(0.4)));
    let least = judged(Check { measure: Measure::TimeOfMin, expected, ..check("/j.position", 0.0) });
    assert_eq!((least.measured, least.expected), (Some(0.1), Some(0.1 * 3.0)), "over the rows of the reference");
}

#[test]
fn relative_deviations_are_divided_by_the_expected_value_or_the_floor() {
    let with = |at, value, floor| {
        judged(Check { relative: true, floor, at: Some(at), ..check("/j.position", value) }).deviation.unwrap()
    };
    assert_eq!(with(0.1, -4.0, 0.0), 1.25);
    assert_eq!(with(0.1, 0.5, 2.0), 0.25);
    assert_eq!(with(0.0, 0.0, 0.0), 0.0, "zero of zero");
    assert_eq!(with(0.1, 0.0, 0.0), f64::INFINITY);
    assert_eq!(with(0.1, 0.0, 10.0), 0.1);
    let infinite = judged(Check { relative: true, at: Some(0.1), ..check("/j.position", 0.0) });
    assert_eq!(infinite.verdict, Verdict::Fails);
}

#[test]
fn the_worst_row_of_a_relative_check_is_the_relatively_worst() {
    let expected = reference(&[(0.1, 0.5), (0.4, 12.0)]);
    let outcome = judged(Check { relative: true, expected, ..check("/j.position", 0.0) });
    assert_eq!(numbers(&outcome), (1.0, 0.5, 1.0, Some(0.1)));
}

#[test]
fn a_nan_never_holds() {
    for measure in [Measure::Error, Measure::Final, Measure::Max, Measure::Mean, Measure::TimeOfMin] {
        let outcome = judged(Check { measure, tolerance: f64::INFINITY, ..check("/j.velocity", 0.0) });
        assert_eq!(outcome.verdict, Verdict::Fails, "{measure:?}");
        assert!(outcome.deviation.unwrap().is_nan());
    }
    let worst = judged(check("/j.velocity", 0.0));
    assert_eq!(worst.at, Some(0.4), "the row that is not a number");
    let infinite = judged(Check { tolerance: f64::INFINITY, ..check("/j.position", f64::INFINITY) });
    assert_eq!(infinite.verdict, Verdict::Fails);
    let undefined = judged(Check { tolerance: f64::INFINITY, ..of_x("x", "sqrt(0.1 - t)") });
    assert_eq!((undefined.verdict, undefined.at), (Verdict::Fails, Some(0.2)));
    let relative = Check { relative: true, floor: 1.0, ..check("/j.velocity", 0.0) };
    assert_eq!(judged(relative).verdict, Verdict::Fails);
}

#[test]
fn a_nan_outside_the_window_does_not_matter() {
    let outcome = judged(Check { window: Some((0.0, 0.3)), tolerance: 30.0, ..check("/j.velocity", 0.0) });
    assert_eq!(outcome.verdict, Verdict::Holds);
}

#[test]
fn a_reference_may_have_fewer_rows_and_begin_later() {
    let outcome = judged(Check { expected: reference(&[(0.2, 4.0), (0.3, 8.0)]), ..check("/j.position", 0.0) });
    assert_eq!(numbers(&outcome), (9.0, 8.0, 1.0, Some(3.0 * 0.1)));
    assert_eq!(outcome.n_rows, 2);
    assert_eq!(outcome.about, "/j.position against column x of reference.csv");
    assert_eq!(outcome.series, Some(Series { times: vec![0.2, 0.3], values: vec![4.0, 8.0] }));
}

#[test]
fn rows_of_a_reference_outside_the_run_and_the_window_do_not_matter() {
    let rows = [(-0.1, 7.0), (0.05, 7.0), (0.1, 1.0), (0.2, 4.0), (0.25, 7.0), (0.6, 7.0)];
    let window = Some((0.1, 0.2));
    let outcome = judged(Check { window, expected: reference(&rows), ..check("/j.position", 0.0) });
    assert_eq!((outcome.verdict, outcome.n_rows), (Verdict::Holds, 2));
    let whole =
        judged(Check { expected: reference(&[(-0.1, 7.0), (0.4, 16.0), (0.5, 7.0)]), ..check("/j.position", 0.0) });
    assert_eq!((whole.verdict, whole.n_rows), (Verdict::Holds, 1));
}

#[test]
fn a_reference_between_the_rows_names_its_row_and_the_step() {
    let expected = reference(&[(0.0, 0.0), (0.05, 0.2), (0.1, 1.0)]);
    let outcome = judged(Check { expected, ..check("/j.position", 0.0) });
    assert_eq!(outcome.series.as_ref().map(|s| s.times.len()), Some(3), "it can be plotted all the same");
    assert_eq!(
        reason(outcome),
        "the row t = 0.05 s of reference.csv falls between the recorded rows, and nothing is interpolated: `step` times \
         `record_every` must be 0.05 s or a whole fraction of it"
    );
    let after_the_last_row = reference(&[(0.4, 16.0), (0.45, 20.0)]);
    let outcome = judged(Check { expected: after_the_last_row, ..check("/j.position", 0.0) });
    assert!(reason(outcome).starts_with("the row t = 0.45 s of reference.csv falls between"));
}

#[test]
fn a_reference_without_a_row_in_the_run_is_not_compared() {
    let outcome = judged(Check { expected: reference(&[(1.0, 0.0), (2.0, 0.0)]), ..check("/j.position", 0.0) });
    assert_eq!(reason(outcome), "reference.csv has no row in the part of the run that is checked");
    let at = judged(Check { at: Some(0.2), expected: reference(&[(0.1, 1.0)]), ..check("/j.position", 0.0) });
    assert_eq!(reason(at), "reference.csv has no row in the part of the run that is checked");
}

#[test]
fn what_is_not_recorded_is_not_compared() {
    assert_eq!(reason(judged(check("/k.position", 0.0))), "`/k.position` is not recorded");
    let alias = Check { aliases: vec![("x".into(), located("/k.position"))], ..of_x("x", "k") };
    assert_eq!(reason(judged(alias)), "`/k.position` is not recorded");
    let empty = Table::new([("t", "s"), ("/j.position", "rad")], 0);
    assert_eq!(reason(evaluate(&[check("/j.position", 0.0)], &empty, Some(0.0)).remove(0)), "nothing was recorded");
}

#[test]
fn a_check_beyond_the_end_of_the_recording_is_not_made() {
    let window = judged(Check { window: Some((0.3, 0.5)), ..check("/j.position", 0.0) });
    assert_eq!(reason(window), "the recording ends at t = 0.4 s, the check looks to t = 0.5 s");
    let later = judged(Check { window: Some((0.5, 0.6)), ..check("/j.position", 0.0) });
    assert_eq!(reason(later), "the recording ends at t = 0.4 s, the check looks from t = 0.5 s to 0.6 s");
    let at = judged(Check { at: Some(2.0), ..check("/j.position", 0.0) });
    assert_eq!(reason(at), "the recording ends at t = 0.4 s, the check looks at t = 2 s");
    let between_rows = judged(Check { window: Some((0.1, 0.45)), tolerance: 20.0, ..check("/j.position", 0.0) });
    assert_eq!(between_rows.verdict, Verdict::Holds, "no row between 0.4 and 0.5 s is missing");
}

#[test]
fn a_stopped_run_has_only_the_checks_of_the_time_before() {
    let whole = stopped(Check { tolerance: 1e9, ..check("/j.position", 0.0) });
    assert_eq!(reason(whole), "the run stopped at t = 0.4 s, the check looks at the whole run");
    let last = stopped(Check { measure: Measure::Final, ..check("/j.position", 16.0) });
    assert_eq!(reason(last), "the run stopped at t = 0.4 s, the check looks at the whole run");
    let window = stopped(Check { window: Some((0.1, 0.5)), ..check("/j.position", 0.0) });
    assert_eq!(reason(window), "the run stopped at t = 0.4 s, the check looks to t = 0.5 s");
    let at = stopped(Check { at: Some(0.5), ..check("/j.position", 0.0) });
    assert_eq!(reason(at), "the run stopped at t = 0.4 s, the check looks at t = 0.5 s");
    let longer = stopped(Check { expected: reference(&[(0.1, 1.0), (0.5, 25.0)]), ..check("/j.position", 0.0) });
    assert_eq!(longer.series.as_ref().map(|s| s.times.clone()), Some(vec![0.1]), "drawn as far as the run came");
    assert_eq!(reason(longer), "the run stopped at t = 0.4 s, the reference reaches to t = 0.5 s");

    let before = stopped(Check { window: Some((0.1, 0.3)), tolerance: 5.0, ..check("/j.position", 5.0) });
    assert_eq!(before.verdict, Verdict::Holds);
    assert_eq!(stopped(Check { at: Some(0.2), ..check("/j.position", 4.0) }).verdict, Verdict::Holds);
    let shorter = stopped(Check { expected: reference(&[(0.1, 1.0), (0.2, 4.0)]), ..check("/j.position", 0.0) });
    assert_eq!(shorter.verdict, Verdict::Holds);
}

/// Angles of rest 0.5, 0.25, 0.125 rad at stiffness 1, 2, 4, run in another order.
fn sweep() -> Sweep {
    let mut sweep = Sweep::new("k", "N·m/rad", [("/j.position", "rad")], 3);
    sweep.push(4.0, &[0.125]);
    sweep.push(1.0, &[0.5]);
    sweep.push(2.0, &[0.25]);
    sweep
}

fn swept(check: Check) -> Outcome {
    evaluate_sweep(&[check], &sweep()).remove(0)
}

#[test]
fn a_sweep_is_compared_along_its_parameter() {
    let expected = reference(&[(1.0, 0.5), (2.0, 0.5), (4.0, 0.125)]);
    let outcome = swept(Check { expected, ..check("/j.position", 0.0) });
    assert_eq!(numbers(&outcome), (0.25, 0.5, 0.25, Some(2.0)));
    assert_eq!((outcome.verdict, outcome.n_rows), (Verdict::Holds, 3));
    let at = swept(Check { at: Some(4.0), ..check("/j.position", 0.125) });
    assert_eq!((at.deviation, at.about.as_str()), (Some(0.0), "/j.position against 0.125, at k = 4 N·m/rad"));
}

#[test]
fn a_reference_of_a_sweep_may_have_more_rows_or_fewer_but_not_both() {
    let with = |rows: &[(f64, f64)]| swept(Check { expected: reference(rows), ..check("/j.position", 0.0) });
    let more = with(&[(1.0, 0.5), (2.0, 0.25), (3.0, 0.1), (4.0, 0.125), (5.0, 0.0)]);
    assert_eq!((more.verdict, more.n_rows), (Verdict::Holds, 3));
    let fewer = with(&[(1.0, 0.5), (4.0, 0.125)]);
    assert_eq!((fewer.verdict, fewer.n_rows), (Verdict::Holds, 2));
    assert_eq!(
        reason(with(&[(1.0, 0.5), (3.0, 0.1), (4.0, 0.125)])),
        "the reference has a row at k = 3 N·m/rad where the sweep has no point, and the sweep has points between its rows; \
         nothing is interpolated"
    );
}

#[test]
fn formulas_of_a_sweep_see_its_value_of_the_parameter_and_no_time() {
    let own = [Check { tolerance: 0.0, ..of_x("x", "0.5/k") }];
    let parameter = Sweep { parameter: "parameters.k".into(), ..sweep() };
    let outcome = evaluate_sweep(&own, &parameter).remove(0);
    assert_eq!((outcome.verdict, outcome.n_rows), (Verdict::Holds, 3));
    assert_eq!(evaluate_sweep(&own, &sweep()).remove(0).at, Some(1.0), "a key of the scene is no parameter: k stays 2");
    let reason = reason(swept(of_x("x", "0.5*t")));
    assert_eq!(reason, "`0.5*t` depends on `t`, which the final values of a sweep do not have");
}

#[test]
fn points_of_a_sweep_match_on_their_own_scale() {
    let mut fine = Sweep::new("/motor.armature", "", [("/j.position", "rad")], 2);
    fine.push(1e-12, &[1.0]);
    fine.push(2e-12, &[2.0]);
    let expected = reference(&[(1e-12, 1.0), (2e-12 * (1.0 + 1e-12), 2.0)]);
    let outcome = evaluate_sweep(&[Check { tolerance: 0.0, expected, ..check("/j.position", 0.0) }], &fine).remove(0);
    assert_eq!((outcome.verdict, outcome.n_rows), (Verdict::Holds, 2));
}

#[test]
fn a_stopped_run_of_a_sweep_is_not_compared() {
    let mut sweep = sweep();
    sweep.push_stopped(3.0, 0.3, "the state is not finite");
    let outcome = evaluate_sweep(&[Check { tolerance: 1e9, ..check("/j.position", 0.0) }], &sweep).remove(0);
    assert_eq!(reason(outcome), "the run at k = 3 N·m/rad stopped at t = 0.3 s: the state is not finite");
    let others = Check { window: Some((1.0, 2.0)), tolerance: 1.0, ..check("/j.position", 0.0) };
    assert_eq!(evaluate_sweep(&[others], &sweep).remove(0).verdict, Verdict::Holds);
}

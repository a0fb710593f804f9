//! Claims about `run.json`.

use serde_json::Value;

use super::*;
use crate::file::test_folder;

fn settings() -> Settings {
    Settings {
        integrator: "rk4".into(),
        step: 0.005,
        accuracy: 1e-10,
        duration: 3.0,
        record_every: 1,
        seed: 0,
        overrides: vec![Override { path: "/rod.mass".into(), value: "2".into() }],
    }
}

fn energy() -> EnergyReport {
    EnergyReport {
        kinetic_start: 0.0,
        kinetic_end: 0.1,
        potential_start: 1.0,
        potential_end: 0.5,
        work: 0.0,
        dissipated: 0.4,
        residual: 1e-17,
    }
}

fn check() -> CheckReport {
    CheckReport {
        name: "angle".into(),
        about: "/j.position against 0".into(),
        verdict: VerdictReport::Holds,
        reason: None,
        measured: Some(0.1 + 0.2),
        expected: Some(0.3),
        deviation: Some(5.551_115_123_125_783e-17),
        sense: Sense::Equal,
        limit: 1e-9,
        relative: false,
        unit: "rad".into(),
        at: Some(1.0),
        n_rows: 601,
    }
}

fn report() -> RunReport {
    RunReport {
        sincro_version: "0.1.0".into(),
        scene: "spring-dynamic".into(),
        scene_path: "scenes/spring-dynamic".into(),
        title: "Spring, dynamics".into(),
        status: Status::Completed,
        settings: settings(),
        model_hash: "0123456789abcdef".into(),
        trace_hash: "fedcba9876543210".into(),
        n_dof: 1,
        columns: vec![ColumnReport::without_error_bar("t", "s")],
        energy: Some(energy()),
        audit: AuditReport::default(),
        checks: vec![check()],
        sweep: None,
        variants: Vec::new(),
        outside_theory: Vec::new(),
        warnings: vec!["the step is coarse".into()],
        messages: Vec::new(),
        changes: Vec::new(),
        wall_time_s: 0.25,
        real_time_factor: 12.0,
        compile_time_s: None,
    }
}

fn outcome(verdict: Verdict, deviation: Option<f64>) -> Outcome {
    Outcome {
        name: "a".into(),
        verdict,
        about: String::new(),
        measured: deviation,
        expected: deviation.map(|_| 0.0),
        deviation,
        sense: Sense::Equal,
        limit: 1.0,
        relative: false,
        unit: String::new(),
        at: None,
        n_rows: 1,
        signal: None,
        series: None,
    }
}

#[test]
fn fields_stand_in_their_order_and_numbers_have_all_their_digits() {
    let text = report().to_json();
    let places: Vec<usize> =
        ["\"sincro_version\"", "\"status\"", "\"trace_hash\"", "\"checks\"", "\"warnings\"", "\"not_finite\""]
            .iter()
            .map(|key| text.find(key).unwrap())
            .collect();
    assert!(places.is_sorted(), "{text}");
    assert!(text.contains("\"measured\": 0.30000000000000004"), "{text}");
    assert_eq!(text, report().to_json());
}

#[test]
fn a_report_reads_back_as_it_was_written() {
    let folder = test_folder("report");
    let mut whole = report();
    whole.status =
        Status::Stopped { tick: 7, time: 0.035, reason: "not finite".into(), help: "a smaller `step`".into() };
    whole.write(&folder).unwrap();
    assert_eq!(RunReport::read(&folder).unwrap(), whole);
    assert_eq!(whole.status.stopped_at(), Some(0.035));
    assert_eq!(Status::Completed.stopped_at(), None);
}

#[test]
fn statuses_have_a_word() {
    let json = |status: Status| serde_json::to_value(status).unwrap();
    assert_eq!(json(Status::Completed), serde_json::json!({"state": "completed"}));
    assert_eq!(json(Status::Interrupted { tick: 2, time: 0.01 })["state"], "interrupted");
}

#[test]
fn what_is_not_finite_is_null_and_named() {
    let mut whole = report();
    whole.energy = Some(EnergyReport { residual: f64::NAN, ..energy() });
    whole.real_time_factor = f64::INFINITY;
    let stopped = CheckReport { measured: Some(f64::NEG_INFINITY), ..check() };
    whole.checks.push(stopped);
    let json: Value = serde_json::from_str(&whole.to_json()).unwrap();
    assert!(json["energy"]["residual"].is_null() && json["real_time_factor"].is_null());
    assert_eq!(
        json["not_finite"],
        serde_json::json!({"/energy/residual": "NaN", "/real_time_factor": "inf", "/checks/1/measured": "-inf"})
    );
    for pointer in json["not_finite"].as_object().unwrap().keys() {
        assert!(json.pointer(pointer).is_some_and(Value::is_null), "{pointer}");
    }
    let folder = test_folder("not-finite");
    whole.write(&folder).unwrap();
    let back = RunReport::read(&folder).unwrap();
    assert!(back.energy.unwrap().residual.is_nan() && back.checks[1].measured.is_none());
}

#[test]
fn every_number_of_variants_and_sweep_is_looked_at() {
    let mut whole = report();
    let bad = CheckReport { deviation: Some(f64::NAN), ..check() };
    let column = ColumnReport { error_bar: Some(f64::INFINITY), ..ColumnReport::without_error_bar("t", "s") };
    whole.variants.push(VariantReport {
        name: "rk4".into(),
        description: String::new(),
        status: Status::Completed,
        settings: settings(),
        model_hash: String::new(),
        trace_hash: String::new(),
        columns: vec![column.clone()],
        energy: None,
        audit: AuditReport::of(vec![Finding {
            law: "loop-position".into(),
            element: "/loop".into(),
            time: 0.5,
            value: f64::NAN,
            limit: 1e-9,
            unit: "m".into(),
            help: String::new(),
        }]),
        checks: vec![bad.clone()],
        outside_theory: Vec::new(),
        warnings: Vec::new(),
        wall_time_s: 0.1,
    });
    let sweep = Sweep::new("K", "", [("/j.position", "rad")], 0);
    whole.sweep = Some(SweepReport { checks: vec![bad], ..SweepReport::new(&sweep, &[]) });
    let json: Value = serde_json::from_str(&whole.to_json()).unwrap();
    let keys: Vec<&String> = json["not_finite"].as_object().unwrap().keys().collect();
    assert_eq!(
        keys,
        [
            "/sweep/checks/0/deviation",
            "/variants/0/audit/findings/0/value",
            "/variants/0/audit/laws/0/value",
            "/variants/0/checks/0/deviation",
            "/variants/0/columns/0/error_bar"
        ]
    );
}

#[test]
fn a_check_says_why_it_was_not_made_or_is_not_finite() {
    let reason = |outcome: Outcome| CheckReport::from(&outcome).reason;
    assert_eq!(
        reason(outcome(Verdict::NotMade("nothing was recorded".into()), None)).as_deref(),
        Some("nothing was recorded")
    );
    assert_eq!(
        reason(outcome(Verdict::Fails, Some(f64::NAN))).as_deref(),
        Some("the deviation is NaN: measured NaN, expected 0")
    );
    assert_eq!(reason(outcome(Verdict::Fails, Some(2.0))), None);
    assert_eq!(reason(outcome(Verdict::Holds, Some(0.5))), None);
}

#[test]
fn a_sweep_reports_the_value_at_which_a_run_stopped() {
    let mut sweep = Sweep::new("/j.spring.stiffness", "N·m/rad", [("/j.position", "rad")], 2);
    sweep.push(1.0, &[0.5]);
    sweep.push_stopped(2.0, 0.3, "not finite");
    let report = SweepReport::new(&sweep, &[]);
    assert_eq!((report.n_runs, report.columns.len()), (2, 1));
    assert_eq!(report.stops, [SweepStopReport { value: 2.0, time: 0.3, reason: "not finite".into() }]);
}

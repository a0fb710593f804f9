//! Audit of runs: findings for corrupted results and for inputs above half the step rate, error bars, `run.json`.

use std::sync::atomic::AtomicBool;

use serde_json::Value;
use sincro_scene::overrides::Override;
use sincro_sim::audit::{AuditReport, Finding, source_findings};
use sincro_sim::campaign::{Campaign, audit, run_campaign};
use sincro_sim::run::{RunMonitor, RunOptions, Simulated, simulate};
use sincro_sim::{Extensions, Loaded, load};
use sincro_testing::SceneFolder;
use sincro_testing::scenes::{refused, sprung_arm};

/// A short run without checks, variants and sweep.
const EXPERIMENT: &str = r#"title = "Audited"
duration = 0.5
step = 0.005
record = ["/shoulder.position", "/wrist.velocity", "energy.total", "energy.balance"]
"#;

const COMMAND: &str = "command = { ramp = { slope = 1.0 } }";

fn folder() -> SceneFolder {
    let folder = sprung_arm();
    folder.write("experiment.toml", &EXPERIMENT.replace("/wrist", "/shoulder/rod/tip/wrist"));
    folder
}

fn campaign(folder: &SceneFolder, set: &[&str], extensions: Extensions) -> Campaign {
    let set: Vec<Override> = set.iter().map(|text| Override::parse(text).unwrap()).collect();
    let loaded = load(folder, &set, extensions).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    run_campaign(folder, &set, &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap()
}

fn simulated(loaded: &Loaded, refined: bool) -> Simulated {
    let interrupt = AtomicBool::new(false);
    let options = RunOptions { refined, ..RunOptions::default() };
    simulate(loaded, options, &mut RunMonitor { interrupt: &interrupt, progress: &mut |_| {} }).unwrap()
}

fn found<'a>(report: &'a AuditReport, law: &str) -> Option<&'a Finding> {
    report.findings.iter().find(|finding| finding.law == law)
}

#[test]
fn a_good_run_has_no_findings_and_says_what_it_was_measured_against() {
    let report = campaign(&folder(), &[], Extensions::default()).report;
    assert!(report.audit.ok && report.audit.findings.is_empty(), "{:?}", report.audit);
    let laws: Vec<&str> = report.audit.laws.iter().map(|law| law.law.as_str()).collect();
    assert_eq!(laws, ["finiteness", "drive-velocity", "energy-balance"]);
    let text: Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!((&text["audit"]["ok"], &text["audit"]["findings"]), (&Value::Bool(true), &Value::Array(Vec::new())));
}

#[test]
fn a_sine_above_half_the_step_rate_is_a_finding() {
    let folder = folder();
    folder.change("scene.toml", COMMAND, "command = { sine = { amplitude = 1.0, frequency_hz = 400.0 } }");
    let report = campaign(&folder, &[], Extensions::default()).report;
    let finding = found(&report.audit, "source-frequency").expect("the sine is above 100 Hz");
    assert_eq!((finding.element.as_str(), finding.unit.as_str()), ("/shoulder/rod/tip/wrist", "Hz"));
    assert!((finding.value - 400.0).abs() < 1e-9 && (finding.limit - 100.0).abs() < 1e-9, "{finding:?}");
    assert!(finding.help.contains("step = 0.0005") || finding.help.contains("step = 0.00"), "{}", finding.help);
    let text: Value = serde_json::from_str(&report.to_json()).unwrap();
    let written = &text["audit"]["findings"][0];
    assert_eq!(text["audit"]["ok"], Value::Bool(false));
    for key in ["law", "element", "time", "value", "limit"] {
        assert!(!written[key].is_null(), "{key}: {written}");
    }
    // at a step that follows it, it is none
    assert!(campaign(&folder, &["step=0.001"], Extensions::default()).report.audit.ok);
}

#[test]
fn sources_of_a_diagram_are_looked_at_at_their_own_rates() {
    let folder = folder();
    let table = "times = [0.0, 0.004, 0.008, 0.012, 1.0]\nvalues = [0.0, 1.0, 0.0, 1.0, 1.0]";
    for (source, sample_time, frequency) in [
        ("type = \"sine\"\nfrequency_hz = 30.0", "sample_time = 0.02\n", Some(30.0)),
        ("type = \"sine\"\nfrequency_hz = 30.0", "", None),
        ("type = \"chirp\"\nfrom_hz = 1.0\nto_hz = 401.0\nduration = 1.0", "", Some(201.0)),
        ("type = \"chirp\"\nfrom_hz = 1.0\nto_hz = 101.0\nduration = 1.0", "", None),
        (&format!("type = \"table\"\n{table}"), "", Some(125.0)),
        // a pulse that may fall between two readings, and one that cannot
        ("type = \"pulse\"\nperiod = 0.004\nwidth = 0.001", "", Some(500.0)),
        ("type = \"pulse\"\nperiod = 0.4\nwidth = 0.1", "", None),
    ] {
        let wire = "wires = [\"source -> /shoulder/rod/tip/wrist\"]";
        let diagram = format!("{wire}\n[[block]]\nname = \"source\"\n{source}\n{sample_time}");
        folder.write("diagram.toml", &diagram);
        let loaded = folder.load(&["diagram=\"diagram.toml\""]).unwrap_or_else(|message| panic!("{message}"));
        let value = source_findings(&loaded).first().map(|finding| finding.value);
        match (value, frequency) {
            (Some(value), Some(expected)) => assert!((value - expected).abs() < 1e-9, "{source}: {value}"),
            (value, expected) => assert_eq!(value, expected, "{source}{sample_time}"),
        }
    }
}

#[test]
fn an_accuracy_beyond_double_precision_is_refused() {
    let message = refused("experiment.toml", "step = 0.01", "step = 0.01\naccuracy = 1e-23");
    assert!(message.contains("`accuracy` is 1e-23") && message.contains("1e-14"), "{message}");
    assert!(refused("experiment.toml", "step = 0.01", "step = 0.01\naccuracy = 1e-14").starts_with("loads"));
}

#[test]
fn an_energy_balance_that_the_finer_run_does_not_explain_is_a_finding() {
    let loaded = folder().load(&[]).unwrap();
    let (mut run, mut finer) = (simulated(&loaded, false), simulated(&loaded, true));
    assert!(audit(&loaded, &run, Some(&finer)).ok);
    // the same wrong balance in both: a law is missed, not the integration
    for balances in [&mut run.balances, &mut finer.balances] {
        balances[40] += 0.5;
    }
    let report = audit(&loaded, &run, Some(&finer));
    let finding = found(&report, "energy-balance").expect("0.5 J are missing");
    assert!((finding.time - 0.2).abs() < 1e-12 && (finding.value - 0.5).abs() < 1e-6, "{finding:?}");
    assert!(finding.help.contains("accuracy = 1e-11 instead of 1e-9"), "{}", finding.help);
    // an error of integration is smaller in the finer run, and the error bar covers it
    finer.balances[40] -= 0.25;
    assert!(audit(&loaded, &run, Some(&finer)).ok);
    assert!(audit(&loaded, &run, None).ok);
}

#[test]
fn help_names_no_setting_that_the_run_has_already() {
    let loaded = folder().load(&["integrator=\"rk4\""]).unwrap();
    let (mut run, mut finer) = (simulated(&loaded, false), simulated(&loaded, true));
    run.balances[1] += 1.0;
    finer.balances[1] += 1.0;
    let report = audit(&loaded, &run, Some(&finer));
    let help = &found(&report, "energy-balance").unwrap().help;
    assert!(help.contains("integrator = \"auto\" instead of \"rk4\"") && !help.contains("accuracy"), "{help}");
    let loaded = folder().load(&["accuracy=1e-13"]).unwrap();
    let report = audit(&loaded, &run_with_method(&loaded, &run), Some(&finer));
    let help = &found(&report, "energy-balance").unwrap().help;
    assert!(help.contains("step = 0.0005") && !help.contains("accuracy") && !help.contains("auto"), "{help}");
}

/// A run with the method of `loaded` and the balances of another one.
fn run_with_method(loaded: &Loaded, other: &Simulated) -> Simulated {
    Simulated { balances: other.balances.clone(), ..simulated(loaded, false) }
}

#[test]
fn the_bar_of_an_energy_is_never_below_the_balance() {
    let report = campaign(&folder(), &["integrator=\"semi-implicit-euler\""], Extensions::default()).report;
    let balance = report.energy.unwrap().residual;
    for column in report.columns.iter().filter(|column| column.path.starts_with("energy.")) {
        assert!(balance > 0.0 && column.error_bar.unwrap() >= balance, "{column:?}, {balance:e}");
    }
}

#[test]
fn signals_of_scripts_have_error_bars_where_the_step_of_scripts_can_be_halved() {
    let folder = folder();
    let scene = std::fs::read_to_string(folder.join("scene.toml")).unwrap();
    folder.write("scene.toml", &format!("{scene}\n[[script]]\nobject = \"/shoulder/rod\"\nfile = \"a.lua\"\n"));
    folder.write("a.lua", "function sysCall_actuation() end\n");
    let extensions = Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() };
    let report = campaign(&folder, &[], extensions).report;
    assert!(report.columns.iter().all(|column| column.error_bar.is_none()));
    assert!(report.columns[1].error_bar_method.contains("scripts"), "{}", report.columns[1].error_bar_method);
    assert!(report.audit.ok && report.audit.laws.iter().all(|law| law.law != "energy-balance"));
    let report = campaign(&folder, &["simulation_step=0.01"], extensions).report;
    assert!(report.columns.iter().skip(1).all(|column| column.error_bar.is_some()));
    assert!(report.columns[1].error_bar_method.contains("step of scripts halved"));
}

/// An attraction without limit, −1/x², beside a limited motor that has nothing to do with it: no step passes x = 0.
#[test]
fn a_force_without_limit_is_a_finding_beside_a_limited_motor() {
    let folder = SceneFolder::new();
    folder.write(
        "scene.toml",
        r#"
[[joint]]
name = "x"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
initial = { position = 1.0, velocity = -1.0 }
spring = { rest = 0.0, law = "-1/(x*x)" }

[[body]]
name = "b"
parent = "/x"
mass = 1.0
inertia = { xx = 1e-2, yy = 1e-2, zz = 2e-3 }

[[joint]]
name = "m"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
motor = { mode = "velocity", max_torque = 1.0, command = 1.0 }

[[body]]
name = "c"
parent = "/m"
mass = 1.0
inertia = { xx = 1e-2, yy = 1e-2, zz = 2e-3 }
"#,
    );
    folder.write(
        "experiment.toml",
        "title = \"S\"\nscene = \"scene.toml\"\nduration = 2.0\nstep = 0.005\nerror_bar = \"none\"\nrecord = [\"/x.position\"]\n",
    );
    let done = campaign(&folder, &[], Extensions::default());
    assert_eq!(done.main.simulated.warnings, Vec::<String>::new());
    assert!(!done.report.audit.ok, "{:?}", done.report.audit);
}

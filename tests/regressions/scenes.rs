//! Every scene and model folder: all checks of the run, its variants and its sweep hold, and the trace hash is the
//! committed one.
//!
//! The hash is the same in debug and release builds and on every machine; `SINCRO_BLESS=1` writes the file anew after a
//! change that is meant to move trajectories (which `CHANGELOG.md` then tells under Trajectories).

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use sincro_sim::campaign::run_campaign;
use sincro_sim::load;
use sincro_sim::results::{CheckReport, RunReport, VerdictReport};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Problems of `scenes/third-party` that are tested here: each kind once. `.ci/run` runs all of them.
const THIRD_PARTY: [&str; 12] = [
    "a01-pendulum",
    "a03-andrews",
    "a04-bricard",
    "adams-distance",
    "adams-revolute-skew",
    "bicycle",
    "coulomb-incline",
    "gazebo-boxes-complex",
    "hover-bemt",
    "nasa-08-wind-shear",
    "pinched-capsule",
    "slider-crank-universal",
];

fn experiments(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let mut found: Vec<PathBuf> =
        entries.map(|e| e.unwrap().path()).filter(|p| p.join("experiment.toml").is_file()).collect();
    found.sort();
    found
}

fn folders() -> Vec<PathBuf> {
    let mut folders = experiments("scenes");
    folders.extend(THIRD_PARTY.map(|name| root().join("scenes/third-party").join(name)));
    folders.extend(experiments("models"));
    folders
}

fn run(folder: &Path) -> RunReport {
    let loaded =
        load(folder, &[], sincro_testing::with_scripts()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    run_campaign(folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap().report
}

fn all_checks(report: &RunReport) -> impl Iterator<Item = &CheckReport> {
    let variants = report.variants.iter().flat_map(|v| &v.checks);
    let sweep = report.sweep.iter().flat_map(|s| &s.checks);
    report.checks.iter().chain(variants).chain(sweep)
}

/// Scenes whose audit has findings, with their laws: run and law. Every other scene must have none.
const FINDINGS: [(&str, &str, &str); 0] = [];

#[test]
fn every_scene_holds_its_checks_and_its_bits() {
    let (mut traces, mut findings) = (String::new(), Vec::new());
    for folder in folders() {
        let report = run(&folder);
        assert!(report.status.is_good(), "{}: {:?}", folder.display(), report.status);
        for check in all_checks(&report) {
            assert_eq!(check.verdict, VerdictReport::Holds, "{}: {check:?}", folder.display());
        }
        assert!(all_checks(&report).count() > 0, "{} checks nothing", folder.display());
        let found = report.findings().map(|(run, finding)| (report.scene.clone(), run.to_owned(), finding.law.clone()));
        findings.extend(found);
        writeln!(traces, "{} {}", report.scene, report.trace_hash).unwrap();
        for variant in &report.variants {
            writeln!(traces, "{}/{} {}", report.scene, variant.name, variant.trace_hash).unwrap();
        }
    }
    let known = FINDINGS.map(|(scene, run, law)| (scene.to_owned(), run.to_owned(), law.to_owned()));
    assert_eq!(findings, known, "findings of the audit have changed");
    let committed = root().join("tests/regressions/traces.txt");
    if std::env::var_os("SINCRO_BLESS").is_some() {
        std::fs::write(&committed, &traces).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&committed).unwrap(), traces, "trajectories have moved");
}

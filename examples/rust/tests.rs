//! The examples run, and come to what they say.

use std::path::Path;
use std::process::Command;

/// Standard output of a program that ends well.
fn output(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    let (stdout, stderr) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{program}: {stderr}");
    stdout
}

/// The number behind a label in the last line that has it.
fn number(text: &str, label: &str) -> f64 {
    let line = text.lines().rfind(|line| line.contains(label)).unwrap_or_else(|| panic!("{label}: {text}"));
    let rest = line.split(label).nth(1).unwrap().trim();
    rest.split_whitespace().next().unwrap().parse().unwrap()
}

#[test]
fn the_pendulum_keeps_its_energy() {
    let text = output(env!("CARGO_BIN_EXE_pendulum"), &[]);
    assert!(number(&text, "energy drift over 2 s:") < 1e-7, "{text}");
}

#[test]
fn the_pid_reaches_its_setpoint() {
    let text = output(env!("CARGO_BIN_EXE_pid"), &[]);
    assert!(number(&text, "control error after 3 s:") < 1e-2, "{text}");
}

#[test]
fn the_scene_is_run_with_its_report() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
    let out = std::env::temp_dir().join(format!("sincro-examples-{}", std::process::id()));
    let text = output(env!("CARGO_BIN_EXE_run-scene"), &[scene.to_str().unwrap(), out.to_str().unwrap()]);
    assert!(text.contains("all checks hold") && out.join("report.html").is_file(), "{text}");
    std::fs::remove_dir_all(&out).unwrap();
}

#[test]
fn the_linearisation_has_two_stable_poles() {
    let text = output(env!("CARGO_BIN_EXE_linearize"), &[]);
    let poles: Vec<&str> = text.lines().filter(|line| line.starts_with("pole -")).collect();
    assert!(poles.len() == 2 && text.contains("gains K"), "{text}");
}

#[test]
fn the_controller_reaches_its_setpoint() {
    let text = output(env!("CARGO_BIN_EXE_controller"), &[]);
    assert!(number(&text, "control error after 3 s:") < 1e-4, "{text}");
}

//! The first hour: templates, schemas, completions, the manual page, converting, parts of an experiment, formats.

use std::fs;

use sincro_testing::{CommandLine, SceneFolder};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

#[test]
fn every_template_runs_and_its_checks_hold() {
    let folder = SceneFolder::new();
    for template in ["arm", "cart-pole", "quadrotor", "mobile", "empty"] {
        let (_, stderr, status) = SINCRO.call_in(&folder, &["new", template, "--template", template]);
        assert_eq!(status, 0, "{stderr}");
        let (stdout, stderr, status) = SINCRO.call_in(&folder, &["run", template, "--out", &format!("out-{template}")]);
        assert_eq!(status, 0, "{template}: {stdout}{stderr}");
        let (said, _, status) = SINCRO.call_in(&folder, &["convert", "--check", template]);
        assert!(status <= 1, "{said}");
    }
    let (_, stderr, status) = SINCRO.call_in(&folder, &["new", "arm"]);
    assert!(status == 2 && stderr.contains("the folder `arm` is not empty"), "{stderr}");
}

#[test]
fn parts_of_an_experiment_run_alone_and_several_scenes_at_once() {
    let folder = SceneFolder::new();
    for template in ["arm", "empty"] {
        assert_eq!(SINCRO.call_in(&folder, &["new", template, "--template", template]).2, 0);
    }
    let (stdout, stderr, status) = SINCRO.call_in(&folder, &["run", "arm", "--only", "main", "--out", "main"]);
    assert!(status == 0 && !stdout.contains("variant"), "{stdout}{stderr}");
    assert!(!folder.join("main/variants").exists());
    let (stdout, stderr, status) = SINCRO.call_in(&folder, &["run", "arm", "--only", "heavy", "--out", "heavy"]);
    assert!(status == 0 && stdout.contains("all 2 checks hold"), "{stdout}{stderr}");
    assert!(fs::read_to_string(folder.join("heavy/run.json")).unwrap().contains("\"parameters.mass\""));
    let (_, stderr, status) = SINCRO.call_in(&folder, &["run", "arm", "--only", "light"]);
    assert!(status == 2 && stderr.contains("main, heavy"), "{stderr}");
    let (stdout, stderr, status) = SINCRO.call_in(&folder, &["run", "arm", "empty", "--out", "both", "--quiet"]);
    assert_eq!((stdout.as_str(), stderr.as_str(), status), ("", "", 0));
    let (stdout, stderr, status) =
        SINCRO.call_in(&folder, &["run", "arm", "-q", "--only", "main", "--set", "/shoulder.initial.velocity=1e300"]);
    assert!(status == 3 && stdout.is_empty() && stderr.contains("stopped: "), "{status} {stdout}{stderr}");
    assert!(folder.join("both/arm/run.json").is_file() && folder.join("both/empty/run.json").is_file());
}

#[test]
fn signals_are_written_in_other_formats() {
    let folder = SceneFolder::new();
    assert_eq!(SINCRO.call_in(&folder, &["new", "empty", "--template", "empty"]).2, 0);
    let run = ["run", "empty", "--out", "out", "--format", "npz,mat,parquet"];
    assert_eq!(SINCRO.call_in(&folder, &run).2, 0);
    for (name, start) in [("npz", "PK"), ("mat", "MATLAB 5.0"), ("parquet", "PAR1")] {
        let bytes = fs::read(folder.join(format!("out/signals.{name}"))).unwrap();
        assert!(bytes.starts_with(start.as_bytes()), "{name}");
    }
    assert_eq!(SINCRO.call_in(&folder, &run).2, 0, "they are part of a result");
}

#[test]
fn editors_and_shells_are_served() {
    let folder = SceneFolder::new();
    assert_eq!(SINCRO.call_in(&folder, &["schema"]).2, 0);
    for name in
        ["schemas/scene.schema.json", "schemas/experiment.schema.json", "schemas/diagram.schema.json", ".taplo.toml"]
    {
        assert!(folder.join(name).is_file(), "{name}");
    }
    let (printed, _, _) = SINCRO.call_in(&folder, &["schema", "--print", "scene"]);
    assert_eq!(printed, fs::read_to_string(folder.join("schemas/scene.schema.json")).unwrap());
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let (text, _, status) = SINCRO.call_in(&folder, &["completions", shell]);
        assert!(status == 0 && text.contains("only"), "{shell}");
    }
    assert!(SINCRO.call_in(&folder, &["man"]).0.contains(".TH sincro 1"));
    assert_eq!(SINCRO.call_in(&folder, &["man", "pages"]).2, 0);
    assert!(folder.join("pages/sincro.1").is_file() && folder.join("pages/sincro-run.1").is_file());
}

#[test]
fn converting_rewrites_a_folder_once() {
    let folder = SceneFolder::new();
    assert_eq!(SINCRO.call_in(&folder, &["new", "empty", "--template", "empty"]).2, 0);
    folder.change("empty/scene.toml", "format = 2\n", "");
    folder.change("empty/scene.toml", "sphere = { radius = 0.1 }", "box = { size = [0.2, 0.2, 0.2] }");
    assert_eq!(SINCRO.call_in(&folder, &["run", "empty", "--out", "before"]).2, 0);
    let (said, _, status) = SINCRO.call_in(&folder, &["convert", "empty", "--check"]);
    assert_eq!((said.as_str(), status), ("empty/scene.toml is of an older format\n", 1));
    assert_eq!(SINCRO.call_in(&folder, &["convert", "empty"]).2, 0);
    let text = fs::read_to_string(folder.join("empty/scene.toml")).unwrap();
    assert!(
        text.contains("cuboid = { size") && text.contains("format = 2") && text.starts_with("# A floor and a ball")
    );
    assert_eq!(SINCRO.call_in(&folder, &["run", "empty", "--out", "after"]).2, 0);
    assert_eq!(SINCRO.call_in(&folder, &["diff", "before", "after", "--out", "-"]).2, 0);
    assert_eq!(SINCRO.call_in(&folder, &["convert", "empty"]).0, "nothing to convert\n");
}

//! Folders of results from the command line: numbers, `latest`, replacing, refusing, interrupts, `sincro runs`.

use std::fs;
use std::path::{Path, PathBuf};

use sincro_testing::{CommandLine, SceneFolder};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

const SCENE: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
initial = { position = 0.3 }

[[body]]
name = "rod"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.0, 0.0, -0.5]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }
"#;

const EXPERIMENT: &str = r#"
title = "Pendulum"
duration = 0.1
step = 0.01
record = ["/hinge.position"]

[[check]]
name = "it falls"
signal = "/hinge.position"
at = 0.1
at_most = 0.3
"#;

/// A folder to work in, with the scene `pendulum`.
fn place() -> SceneFolder {
    let folder = SceneFolder::new();
    fs::create_dir(folder.join("pendulum")).unwrap();
    folder.with("pendulum/scene.toml", SCENE).with("pendulum/experiment.toml", EXPERIMENT)
}

/// Every file and folder below, with hidden ones, sorted.
fn tree(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut stack = vec![folder.to_owned()];
    while let Some(at) = stack.pop() {
        for entry in fs::read_dir(&at).unwrap() {
            let entry = entry.unwrap();
            found.push(entry.path().strip_prefix(folder).unwrap().to_owned());
            if entry.file_type().unwrap().is_dir() {
                stack.push(entry.path());
            }
        }
    }
    found.sort();
    found
}

#[test]
fn runs_without_out_get_numbered_folders() {
    let folder = place();
    for number in ["0001", "0002"] {
        let (stdout, stderr, status) = SINCRO.call_in(&folder, &["run", "pendulum"]);
        assert_eq!(status, 0, "{stdout}{stderr}");
        assert!(stdout.contains(&format!("report results/pendulum/{number}/report.html")), "{stdout}");
        assert!(folder.join("results/pendulum").join(number).join("run.json").is_file());
        #[cfg(unix)]
        assert_eq!(fs::read_link(folder.join("results/pendulum/latest")).unwrap(), Path::new(number));
    }
    let hidden = |path: &PathBuf| path.components().any(|c| c.as_os_str().to_string_lossy().starts_with('.'));
    let partial = |path: &PathBuf| path.extension().is_some_and(|e| e == "partial");
    let all = tree(&folder.join("results"));
    assert!(!all.iter().any(|path| hidden(path) || partial(path)), "{all:?}");
}

#[test]
fn out_is_replaced_whole_or_refused_untouched() {
    let folder = place();
    let run = |more: &[&str]| SINCRO.call_in(&folder, &[&["run", "pendulum", "--out", "out"], more].concat());
    assert_eq!(run(&["--mcap", "--frames"]).2, 0);
    assert!(folder.join("out/run.mcap").is_file() && folder.join("out/frames/0001.svg").is_file());
    assert_eq!(run(&[]).2, 0);
    assert!(!folder.join("out/run.mcap").exists() && !folder.join("out/frames").exists(), "nothing of two runs mixes");
    fs::write(folder.join("out/notes.txt"), "mine").unwrap();
    let before = tree(&folder.join("out"));
    let (_, stderr, status) = run(&["--until", "0.05"]);
    assert_eq!(status, 2);
    assert!(stderr.contains("holds `notes.txt`, which is no part of a result"), "{stderr}");
    assert_eq!(before, tree(&folder.join("out")));
    assert_eq!(fs::read_to_string(folder.join("out/signals.csv")).unwrap().lines().count(), 12);
    // not even a scene is taken for a result
    let (_, stderr, status) = SINCRO.call_in(&folder, &["run", "pendulum", "--out", "pendulum"]);
    assert!(status == 2 && stderr.contains("holds `experiment.toml`"), "{stderr}");
}

#[test]
fn bad_input_writes_nothing() {
    let folder = place();
    let (_, _, status) = SINCRO.call_in(&folder, &["run", "pendulum", "--set", "/nothing.mass=1"]);
    assert_eq!((status, tree(&folder).len()), (2, 3));
}

#[cfg(unix)]
#[test]
fn a_termination_signal_keeps_what_was_recorded() {
    use std::process::Stdio;
    let folder = place();
    let mut child = SINCRO
        .command(&["run", "pendulum", "--until", "50000", "--set", "record_every=1000"])
        .current_dir(&*folder)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    while !folder.join("results/pendulum/.0001.running/signals.csv.partial").exists() {
        std::thread::sleep(std::time::Duration::from_millis(10));
        assert!(child.try_wait().unwrap().is_none(), "ended before it was interrupted");
    }
    // another run at the same time gets a folder of its own
    assert_eq!(SINCRO.call_in(&folder, &["run", "pendulum"]).2, 0);
    let sent = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    assert_eq!(child.wait().unwrap().code(), Some(3));
    let json = fs::read_to_string(folder.join("results/pendulum/0001/run.json")).unwrap();
    assert!(json.contains("\"interrupted\"") && folder.join("results/pendulum/0002/run.json").is_file());
}

#[test]
fn runs_are_listed_compared_and_pruned() {
    let folder = place();
    for position in ["0.1", "0.2", "0.3"] {
        assert_eq!(
            SINCRO.call_in(&folder, &["run", "pendulum", "--set", &format!("/hinge.initial.position={position}")]).2,
            0
        );
    }
    let (list, _, status) = SINCRO.call_in(&folder, &["runs"]);
    assert_eq!((status, list.lines().count()), (0, 3), "{list}");
    assert!(list.contains("results/pendulum/0002") && list.contains("/hinge.initial.position=0.2"), "{list}");
    assert!(list.contains("the check holds"), "{list}");
    // a scene stands for its results
    assert_eq!(SINCRO.call_in(&folder, &["runs", "pendulum"]).0, list);
    let (table, _, status) = SINCRO.call_in(&folder, &["runs", "compare", "results/pendulum/0001", "results/pendulum"]);
    assert_eq!(status, 0);
    let row = table.lines().find(|line| line.contains("/hinge.initial.position")).unwrap();
    assert!(row.contains("0.1") && row.contains("0.3") && table.contains("it falls"), "{table}");
    assert!(table.lines().any(|line| line.contains("it falls") && line.contains("(at most 0.3)")), "{table}");
    fs::write(folder.join("results/pendulum/0001/notes.txt"), "mine").unwrap();
    let (said, _, _) = SINCRO.call_in(&folder, &["runs", "prune", "--keep", "1", "--dry-run"]);
    assert!(said.contains("1 run would be removed") && folder.join("results/pendulum/0002").is_dir(), "{said}");
    let (said, _, status) = SINCRO.call_in(&folder, &["runs", "prune", "--keep", "1"]);
    assert!(status == 0 && said.contains("0001 stays: it holds `notes.txt`"), "{said}");
    assert!(!folder.join("results/pendulum/0002").exists() && folder.join("results/pendulum/0003").is_dir());
    // the numbers go on
    assert_eq!(SINCRO.call_in(&folder, &["run", "pendulum"]).2, 0);
    assert!(folder.join("results/pendulum/0004").is_dir());
}

#[test]
fn the_latest_run_of_a_scene_is_meant_by_its_folder() {
    let folder = place();
    for _ in 0..2 {
        assert_eq!(SINCRO.call_in(&folder, &["run", "pendulum"]).2, 0);
    }
    let (stdout, stderr, status) =
        SINCRO.call_in(&folder, &["diff", "results/pendulum", "results/pendulum/0001", "--out", "-"]);
    assert_eq!(status, 0, "{stdout}{stderr}");
}

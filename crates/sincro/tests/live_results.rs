//! A live run is saved as a result, whatever was done to it by hand: it is computed again with the same trace hash.

use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, channel};

use sincro::view::keep;
use sincro_testing::{SceneFolder, repository_scene};
use sincro_viewer::live::{Command, Engine, KeptRun, Source};

/// An engine of a scene whose runs that are kept come through the receiver.
fn engine(scene: &Path) -> (SyncSender<Command>, Receiver<KeptRun>) {
    let (kept, receiver) = channel();
    let keep = move |run: &KeptRun| {
        kept.send(run.clone()).map_err(|error| error.to_string())?;
        Ok("kept".to_owned())
    };
    let engine = Engine::open(Source {
        folder: scene.to_owned(),
        settings: Vec::new(),
        extensions: sincro::extensions(),
        draw: Box::new(|_| String::new()),
        keep: Box::new(keep),
    });
    (engine.unwrap().start(), receiver)
}

fn step(commands: &SyncSender<Command>, n: usize) {
    (0..n).for_each(|_| commands.send(Command::Step {}).unwrap());
}

fn branch(run: usize, t: f64, set: &[(&str, &str)], joints: &[(usize, f64)]) -> Command {
    let set = set.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    Command::Branch { run, t, set, joints: joints.to_vec(), play: false }
}

/// Saves run `run` and returns the sentence, and `run.json`.
fn saved(
    scene: &Path,
    commands: &SyncSender<Command>,
    receiver: &Receiver<KeptRun>,
    run: usize,
) -> (KeptRun, String, serde_json::Value) {
    commands.send(Command::Keep { run }).unwrap();
    let kept = receiver.recv().unwrap();
    let results = SceneFolder::new();
    let said = keep(scene, &results, &kept).unwrap();
    let folder = results.join(scene.file_name().unwrap()).join("0001");
    assert!(folder.join("report.html").is_file() && folder.join("signals.csv").is_file());
    let json = std::fs::read_to_string(folder.join("run.json")).unwrap();
    (kept, said, serde_json::from_str(&json).unwrap())
}

#[test]
fn a_run_that_was_branched_changed_placed_and_pulled_is_saved_whole() {
    let scene = repository_scene("double-pendulum");
    let (commands, receiver) = engine(&scene);
    step(&commands, 30);
    // from within the first run, with another mass
    commands.send(branch(0, 0.02, &[("/upper/lower/bob2.mass", "2.5")], &[])).unwrap();
    step(&commands, 20);
    // from within that, placed elsewhere
    commands.send(branch(1, 1e9, &[("/upper/lower/bob2.mass", "2.5")], &[(0, 1.0)])).unwrap();
    step(&commands, 5);
    commands.send(Command::Push { object: 1, point: [0.0, 0.0, -0.5], force: [3.0, 0.0, 1.0] }).unwrap();
    step(&commands, 7);
    commands.send(Command::Release {}).unwrap();
    step(&commands, 10);
    let (kept, said, json) = saved(&scene, &commands, &receiver, 2);
    assert_eq!(kept.segments.len(), 3);
    assert!(said.contains("with the same trace hash"), "{said}");
    assert_eq!(json["trace_hash"], kept.trace);
    let said: Vec<&str> =
        json["messages"].as_array().unwrap().iter().map(|message| message["text"].as_str().unwrap()).collect();
    assert!(said[0].contains("/upper/lower/bob2.mass = 2.5 from here on"), "{said:?}");
    assert!(said[1].contains("coordinate 0 was placed at 1"), "{said:?}");
    assert!(said[2].contains("pulled by hand") && said[3] == "let go", "{said:?}");
    // what a change adds to the energy is no error of the balance
    assert_eq!(json["audit"]["ok"], true, "{}", json["audit"]);
}

#[test]
fn a_run_from_the_files_is_saved_with_error_bars() {
    let scene = repository_scene("double-pendulum");
    let (commands, receiver) = engine(&scene);
    step(&commands, 10);
    let (kept, said, json) = saved(&scene, &commands, &receiver, 0);
    assert!(kept.is_from_files() && said.contains("with the same trace hash"), "{said}");
    assert!(json["columns"].as_array().unwrap().iter().any(|column| column["error_bar"].is_number()), "{json}");
}

#[test]
fn a_run_that_was_only_pulled_and_a_diagram_that_was_branched_are_saved_whole() {
    let scene = repository_scene("cart-pole-lqr");
    let (commands, receiver) = engine(&scene);
    step(&commands, 4);
    commands.send(Command::Push { object: 1, point: [0.0; 3], force: [2.0, 0.0, 0.0] }).unwrap();
    step(&commands, 6);
    let (kept, said, _) = saved(&scene, &commands, &receiver, 0);
    assert!(!kept.is_from_files() && said.contains("with the same trace hash"), "{said}");
    // the force goes on in a branch only as long as it did before
    commands.send(branch(0, 1e9, &[], &[])).unwrap();
    step(&commands, 5);
    let (kept, said, _) = saved(&scene, &commands, &receiver, 1);
    assert!(kept.segments.len() == 2 && said.contains("with the same trace hash"), "{said}");
}

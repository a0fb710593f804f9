//! Equilibria of all scenes of the repository: what `trim` finds, a scene can start from, and there it stays.

use std::path::{Path, PathBuf};

use sincro_analysis::linearize::{Request, TrimRequest, Trimmed, linearize, operating_point, trim};
use sincro_scene::overrides::Override;
use sincro_sim::run::LockStep;
use sincro_sim::{Extensions, Loaded, load_without_variants};

/// Folders of the repository's scenes, in the order of their names.
fn scenes() -> Vec<PathBuf> {
    let root = sincro_testing::repository_scene("");
    let folders = |of: &Path| {
        let entries = std::fs::read_dir(of).unwrap().map(|entry| entry.unwrap().path());
        entries.filter(|path| path.join("experiment.toml").is_file()).collect::<Vec<_>>()
    };
    let mut all = folders(&root);
    all.extend(folders(&root.join("third-party")));
    all.sort();
    all
}

/// `--set` of the positions that `trim` found.
fn settings(found: &Trimmed) -> Vec<Override> {
    let one = |(joint, q): &(String, Vec<f64>)| {
        let position = if let [one] = q[..] { format!("{one:?}") } else { format!("{q:?}") };
        Override::new(&format!("{joint}.initial"), &format!("{{ position = {position} }}"))
    };
    found.trim.initial.iter().map(one).collect()
}

/// Start of a scene, with the commands of another run.
fn start_with_commands_of(loaded: &Loaded, other: &LockStep) -> LockStep {
    let mut at = operating_point(loaded, 0.0).unwrap();
    let mut state = at.state().clone();
    state.commands.clone_from(&other.state().commands);
    state.rotors.clone_from(&other.state().rotors);
    at.set_state(state, &[]);
    at
}

#[test]
fn a_scene_can_start_in_every_equilibrium_that_is_found_and_stays_there() {
    let (mut n_found, mut n_not_found, mut n_unloaded) = (0, 0, 0);
    for folder in scenes() {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        // scripts and FMUs are not known to this crate
        let Ok(loaded) = load_without_variants(&folder, &[], Extensions::default()) else {
            n_unloaded += 1;
            continue;
        };
        let at = operating_point(&loaded, 0.0).unwrap();
        let found = match trim(&loaded, &at, &TrimRequest::default()) {
            Ok(found) => found,
            Err(why) => {
                eprintln!("{name}: {why}");
                n_not_found += 1;
                continue;
            }
        };
        n_found += 1;
        let again = load_without_variants(&folder, &settings(&found), Extensions::default())
            .unwrap_or_else(|refused| panic!("{name} cannot start in its equilibrium: {refused}"));
        let start = start_with_commands_of(&again, &found.at);
        let once_more =
            trim(&again, &start, &TrimRequest::default()).unwrap_or_else(|why| panic!("{name}, from there: {why}"));
        eprintln!("{name}: {} steps, then {}", found.trim.iterations, once_more.trim.iterations);
        assert_eq!(once_more.trim.iterations, 0, "{name}");
        for (a, b) in found.at.state().q.iter().zip(&once_more.at.state().q) {
            assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0), "{name}: {a} {b}");
        }
    }
    eprintln!("{n_found} equilibria, {n_not_found} scenes without, {n_unloaded} not loaded");
    assert!(n_found > 30, "{n_found}");
}

/// A start at rest whose linearisation calls it an equilibrium is one for `trim`, too.
#[test]
fn a_start_in_equilibrium_is_not_moved() {
    let mut n_steady = 0;
    for folder in scenes() {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let Ok(loaded) = load_without_variants(&folder, &[], Extensions::default()) else { continue };
        let at = operating_point(&loaded, 0.0).unwrap();
        let is_steady = match linearize(&loaded, &at, &Request::default()) {
            Ok(linear) => linear.drift() <= 1e-10,
            Err(_) => false,
        };
        if !is_steady || at.state().v.iter().any(|v| *v != 0.0) {
            continue;
        }
        n_steady += 1;
        let found = trim(&loaded, &at, &TrimRequest::default()).unwrap_or_else(|why| panic!("{name}: {why}"));
        let moved = found.at.state().q.iter().zip(&at.state().q).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(found.trim.iterations == 0 && moved == 0.0, "{name}: {} steps, {moved:e}", found.trim.iterations);
    }
    assert!(n_steady > 5, "{n_steady}");
}

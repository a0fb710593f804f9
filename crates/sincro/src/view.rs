//! A scene live, or a finished run, in the browser.

use std::fmt;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use sincro_figures::campaign;
use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::overrides::Override;
use sincro_sim::campaign::judge;
use sincro_sim::result_folder::{ResultFolder, find_result};
use sincro_sim::results::Override as Setting;
use sincro_viewer::live::{Engine, KeptRun, Source};
use sincro_viewer::replay::FORMAT;

pub use sincro_viewer::server::{Server, ViewerContent};

use crate::load::{extensions, load, scene_name};
use crate::results;
use crate::run::RunRequest;

/// Error of [`replay`]: a folder cannot be shown as a finished run.
#[derive(Debug)]
pub struct ReplayError {
    /// Reason, with the path of the file.
    pub message: String,
    /// Remedy, in words.
    pub help: &'static str,
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message, self.help)
    }
}

impl std::error::Error for ReplayError {}

/// Returns true if a folder holds a finished run, or numbered ones, and no scene: show it with [`replay`], else with
/// [`live`].
#[must_use]
pub fn is_finished_run(folder: &Path) -> bool {
    find_result(folder).join("replay.json").is_file() && !folder.join("experiment.toml").is_file()
}

/// Opens the replay of a finished run, or of the latest one in a folder of numbered ones, to be given to
/// [`Server::bind`].
///
/// # Errors
///
/// The folder has no `replay.json`, or one of another version of the format; the error has a remedy.
pub fn replay(run: &Path) -> Result<ViewerContent, ReplayError> {
    let file = find_result(run).join("replay.json");
    let text = std::fs::read_to_string(&file).map_err(|e| ReplayError {
        message: format!("`{}` cannot be read: {e}", file.display()),
        help: "name the folder that `sincro run` wrote, such as results/SCENE/0001, or results/SCENE for the latest",
    })?;
    if !text.starts_with(&format!("{{\"format\":\"{FORMAT}\"")) {
        let message = format!("`{}` is no replay that this version of sincro shows", file.display());
        return Err(ReplayError { message, help: "run the scene again with this version" });
    }
    Ok(ViewerContent::Replay(text.into()))
}

/// Starts a live run of a scene, paused at its start, to be given to [`Server::bind`]. Its thread ends when the result
/// is dropped.
///
/// # Errors
///
/// All problems of the scene and the overrides, each with its place in the file.
pub fn live(scene: &Path, overrides: Vec<Override>) -> Result<ViewerContent, Diagnostics> {
    let world = scene_name(scene);
    let draw = Box::new(move |controller: &_| campaign::diagram(controller, "", &world, true));
    let folder = scene.to_owned();
    let keep = Box::new(move |kept: &KeptRun| keep(&folder, Path::new("results"), kept));
    let source = Source { folder: scene.to_owned(), settings: overrides, extensions: extensions(), draw, keep };
    let engine = Engine::open(source)?;
    let live_state = engine.live_state();
    Ok(ViewerContent::Live(live_state, engine.start()))
}

/// Writes a live run into the next numbered folder of its scene below `results`, as `sincro run` does: the run is
/// computed again from the files and settings. One that was branched from others, or pulled by hand, is computed again
/// with them, from its start; it cannot be refined, so its signals have no error bars, and variants are left out.
/// Returns a sentence with the path of the report, and whether the trace hash is the same.
///
/// # Errors
///
/// A sentence: the scene does not load any more, or a file cannot be written.
pub fn keep(scene: &Path, results: &Path, kept: &KeptRun) -> Result<String, String> {
    let folder = ResultFolder::numbered(&results.join(scene_name(scene))).map_err(|error| error.to_string())?;
    let trace = match kept.is_from_files() {
        true => run_again(scene, kept, folder.path())?,
        false => replay_again(scene, kept, folder.path())?,
    };
    let path = folder.publish().map_err(|error| error.to_string())?;
    let report = path.join("report.html");
    match trace == kept.trace {
        true => Ok(format!("saved as {}, with the same trace hash {trace}", report.display())),
        false => Ok(format!(
            "saved as {}; its trace hash {trace} is not that of the run in this window, {}: a file of the scene has changed",
            report.display(),
            kept.trace
        )),
    }
}

/// Runs a scene with the settings of a live run into a folder; returns the trace hash.
fn run_again(scene: &Path, kept: &KeptRun, out: &Path) -> Result<String, String> {
    let mut settings = kept.settings().to_vec();
    if let Some(duration) = kept.duration {
        settings.push(Override::new("duration", &duration.to_string()));
    }
    let mut loaded = load(scene, &settings).map_err(|diagnostics| diagnostics.to_string())?;
    loaded.experiment.variants.clear();
    loaded.experiment.sweep = None;
    let request = RunRequest { scene, overrides: &settings, loaded: &loaded, index: None };
    let campaign = request.run_into(out, &AtomicBool::new(false), &mut |_, _| {});
    Ok(campaign.map_err(|error| error.to_string())?.report.trace_hash)
}

/// Repeats a live run with all that was done to it into a folder; returns the trace hash.
fn replay_again(scene: &Path, kept: &KeptRun, out: &Path) -> Result<String, String> {
    let (mut loaded, simulated) = kept.replay(scene, extensions(), &out.join("signals.csv"))?;
    loaded.experiment.variants.clear();
    loaded.experiment.sweep = None;
    let mut campaign = judge(scene, &loaded, simulated);
    let setting = |set: &Override| Setting { path: set.path.value.clone(), value: set.value.value.clone() };
    campaign.report.settings.overrides = kept.settings().iter().map(setting).collect();
    campaign.report.write(out).map_err(|error| error.to_string())?;
    results::write(&loaded, &campaign, out, None).map_err(|error| error.to_string())?;
    Ok(campaign.report.trace_hash)
}

/// Finds a camera of what is shown by its path or the last part of that, and returns its path.
///
/// # Errors
///
/// No camera has that name; the error has the paths of all cameras, in the order of the scene.
pub fn camera(show: &ViewerContent, name: &str) -> Result<String, Vec<String>> {
    let cameras = show.cameras();
    let found = cameras.iter().find(|path| *path == name || path.rsplit('/').next() == Some(name));
    found.cloned().ok_or(cameras)
}

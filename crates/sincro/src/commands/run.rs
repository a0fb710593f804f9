//! `sincro run`: one scene, its checks, its report.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use crate::extensions::extensions;
use clap::Args;
use sincro_scene::overrides::Override;
use sincro_scene::problem::Problems;
use sincro_scene::scene::ObjectKind;
use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_sim::results::{Override as Setting, VerdictReport};
use sincro_sim::{Loaded, load};

use super::console::{self, Bar};
use crate::{Exit, diagnostics, present};

/// What `run` takes.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or its experiment.toml
    scene: PathBuf,
    /// Set a number of the scene (/link.mass=2) or of the experiment (parameters.m=3); may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Simulate until this time `[s]`
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    until: Option<f64>,
    /// Base step `[s]`
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    step: Option<f64>,
    /// auto, semi-implicit-euler, rk4, implicit, dormand-prince or stiff
    #[arg(long, value_name = "NAME")]
    integrator: Option<String>,
    /// Local tolerance of the variable-step integrators
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    accuracy: Option<f64>,
    /// Where the results go [default: results/SCENE]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Seed of everything random
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Write run.mcap too, for Foxglove, Lichtblick or Rerun
    #[arg(long)]
    mcap: bool,
    /// Write pictures of the run too, as SVG files in `frames`: 30 a simulated second, 1800 at most
    #[arg(long)]
    frames: bool,
    /// Take the pictures of --frames through this camera of the scene, as PNG files
    #[arg(long, value_name = "NAME", requires = "frames")]
    camera: Option<String>,
    /// Print run.json on standard output instead of the summary
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let overrides = match overrides(arguments) {
        Ok(overrides) => overrides,
        Err(problems) => return diagnostics::refuse_problems(&problems),
    };
    let loaded = match load(&arguments.scene, &overrides, extensions()) {
        Ok(loaded) => loaded,
        Err(problems) => return diagnostics::refuse_problems(&problems),
    };
    let camera = match arguments.camera.as_deref().map(|name| camera_of(&loaded, name)).transpose() {
        Ok(camera) => camera,
        Err(exit) => return exit,
    };
    let name = scene_name(&arguments.scene);
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("results").join(&name));
    let job = Job { scene: &arguments.scene, overrides: &overrides, loaded: &loaded, out: &out, up: None };
    let campaign = match job.run() {
        Ok(campaign) => campaign,
        Err(exit) => return exit,
    };
    if arguments.mcap
        && let Err(error) = sincro_viewer::mcap::write(&campaign.main, &out.join("run.mcap"))
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.frames
        && let Err(error) = match camera {
            Some(k) => present::write_photographs(&loaded, &campaign.main, k, &out),
            None => present::write_frames(&campaign.main, &out),
        }
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.json {
        say!("{}", campaign.report.to_json());
    } else {
        diagnostics::print_problems(&loaded.warnings);
        console::print_summary(&loaded, &campaign, &out);
    }
    verdict(&campaign)
}

/// The place among the objects of a camera that is named by its path or by the last part of that.
fn camera_of(loaded: &Loaded, name: &str) -> Result<usize, Exit> {
    let objects = &loaded.scene.objects;
    let is_camera = |k: &usize| matches!(objects[*k].kind, ObjectKind::Camera { .. });
    let cameras: Vec<usize> = (0..objects.len()).filter(is_camera).collect();
    let found = cameras.iter().find(|k| objects[**k].path == name || objects[**k].name == name);
    found.copied().ok_or_else(|| {
        let paths: Vec<&str> = cameras.iter().map(|k| objects[*k].path.as_str()).collect();
        let help = match paths.as_slice() {
            [] => "the scene has none: add a [[camera]] to it".to_owned(),
            _ => format!("cameras here: {}", paths.join(", ")),
        };
        diagnostics::refuse(&format!("there is no camera `{name}`"), Some(&help))
    })
}

/// What stands after every `--set`.
pub(crate) fn parse_settings(texts: &[String]) -> Result<Vec<Override>, Problems> {
    let (mut problems, mut overrides) = (Problems::new(), Vec::new());
    for text in texts {
        match Override::parse(text) {
            Ok(setting) => overrides.push(setting),
            Err(problem) => problems.push(problem),
        }
    }
    if problems.any_error() { Err(problems) } else { Ok(overrides) }
}

/// Everything set on the command line, in the order of reading.
fn overrides(arguments: &Arguments) -> Result<Vec<Override>, Problems> {
    let mut overrides = parse_settings(&arguments.set)?;
    let number = |x: Option<f64>| x.map(|x| format!("{x:?}"));
    let flags = [
        ("duration", number(arguments.until)),
        ("step", number(arguments.step)),
        ("integrator", arguments.integrator.as_ref().map(|word| format!("\"{word}\""))),
        ("accuracy", number(arguments.accuracy)),
        ("seed", arguments.seed.map(|n| n.to_string())),
    ];
    for (path, value) in flags {
        overrides.extend(value.map(|value| Override::new(path, &value)));
    }
    Ok(overrides)
}

/// Name of a scene: that of its folder.
pub(crate) fn scene_name(path: &Path) -> String {
    let folder = if path.is_file() { path.parent().unwrap_or(path) } else { path };
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    whole.file_name().map_or_else(|| "scene".into(), |name| name.to_string_lossy().into_owned())
}

/// A run with everything it writes.
pub(crate) struct Job<'a> {
    pub(crate) scene: &'a Path,
    pub(crate) overrides: &'a [Override],
    pub(crate) loaded: &'a Loaded,
    pub(crate) out: &'a Path,
    /// Label and address of the page above, if there is one.
    pub(crate) up: Option<(String, String)>,
}

impl Job<'_> {
    /// Runs it and writes signals, `run.json`, figures and the report.
    pub(crate) fn run(&self) -> Result<Campaign, Exit> {
        sincro_sim::file::prepare(self.out).map_err(|e| diagnostics::refuse_file(&e))?;
        let bar = Bar::new(&scene_name(self.scene));
        let mut tell = |words: &str, share: f64| bar.show(words, share);
        let interrupt = interrupt();
        let done = run_campaign(self.scene, self.overrides, self.loaded, Some(self.out), &interrupt, &mut tell);
        let mut campaign = done.map_err(|e| diagnostics::refuse_run(&e))?;
        bar.finish();
        let set = self.overrides.iter().map(|s| Setting { path: s.path.value.clone(), value: s.value.value.clone() });
        campaign.report.settings.overrides = set.collect();
        campaign.report.write(self.out).map_err(|e| diagnostics::refuse_file(&e))?;
        present::write(self.loaded, &campaign, self.out, self.up.clone()).map_err(|e| diagnostics::refuse_file(&e))?;
        Ok(campaign)
    }
}

/// Set by Ctrl-C; a second one ends the program at once.
pub(crate) fn interrupt() -> Arc<AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    let flag = FLAG.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let seen = flag.clone();
        let handler = move || {
            if seen.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        };
        // without a handler Ctrl-C ends the program as usual
        let _ = ctrlc::set_handler(handler);
        flag
    });
    flag.clone()
}

/// The exit status of a campaign.
pub(crate) fn verdict(campaign: &Campaign) -> Exit {
    let report = &campaign.report;
    let statuses = [&report.status].into_iter().chain(report.variants.iter().map(|v| &v.status));
    let sweep_stopped = report.sweep.as_ref().is_some_and(|s| !s.stops.is_empty());
    if statuses.into_iter().any(|s| !s.is_good()) || sweep_stopped {
        return Exit::Stopped;
    }
    let mut checks = report
        .checks
        .iter()
        .chain(report.variants.iter().flat_map(|v| &v.checks))
        .chain(report.sweep.iter().flat_map(|s| &s.checks));
    if checks.all(|c| c.verdict == VerdictReport::Holds) { Exit::Holds } else { Exit::Fails }
}

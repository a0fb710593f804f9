//! `sincro run`: one scene, its checks, its report.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use clap::Args;
use sincro::results::{write_camera_frames, write_frames, write_mcap};
use sincro::{Campaign, Diagnostics, Loaded, Override, RunRequest, Verdict, load, scene_name};

use super::console::{self, Bar};
use super::robot_file::SceneSource;
use crate::{Exit, diagnostics};

/// Arguments of `run`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file (URDF, SDF, MJCF)
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
    /// Folder of the results [default: results/SCENE]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Seed of all random generators
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
        Err(diagnostics) => return diagnostics::refuse_diagnostics(&diagnostics),
    };
    let source = match SceneSource::open(&arguments.scene) {
        Ok(source) => source,
        Err(exit) => return exit,
    };
    let loaded = match load(source.folder(), &overrides) {
        Ok(loaded) => loaded,
        Err(diagnostics) => return diagnostics::refuse_diagnostics(&diagnostics),
    };
    let camera = match arguments.camera.as_deref().map(|name| camera_of(&loaded, name)).transpose() {
        Ok(camera) => camera,
        Err(exit) => return exit,
    };
    let name = scene_name(source.folder());
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("results").join(&name));
    let request = RunRequest { scene: source.folder(), overrides: &overrides, loaded: &loaded, out: &out, index: None };
    let campaign = match run_with_progress(&request) {
        Ok(campaign) => campaign,
        Err(exit) => return exit,
    };
    if arguments.mcap
        && let Err(error) = write_mcap(&campaign.main, &out.join("run.mcap"))
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.frames
        && let Err(error) = match camera {
            Some(k) => write_camera_frames(&loaded, &campaign.main, k, &out),
            None => write_frames(&campaign.main, &out),
        }
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.json {
        say!("{}", campaign.report.to_json());
    } else {
        diagnostics::print_diagnostics(&loaded.warnings);
        console::print_summary(&loaded, &campaign, &out);
    }
    Verdict::of(&campaign).into()
}

/// Index among the objects of a camera that is named by its path or by the last part of that.
fn camera_of(loaded: &Loaded, name: &str) -> Result<usize, Exit> {
    sincro::camera(&loaded.scene, name).map_err(|cameras| diagnostics::refuse_camera(name, &cameras))
}

/// Parses the texts that stand after `--set`.
pub(crate) fn parse_settings(texts: &[String]) -> Result<Vec<Override>, Diagnostics> {
    let (mut diagnostics, mut overrides) = (Diagnostics::new(), Vec::new());
    for text in texts {
        match Override::parse(text) {
            Ok(setting) => overrides.push(setting),
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    if diagnostics.any_error() { Err(diagnostics) } else { Ok(overrides) }
}

/// Everything set on the command line, in the order of reading.
fn overrides(arguments: &Arguments) -> Result<Vec<Override>, Diagnostics> {
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

/// Runs an experiment with a progress bar on a terminal, until its end or Ctrl-C.
pub(crate) fn run_with_progress(request: &RunRequest<'_>) -> Result<Campaign, Exit> {
    let bar = Bar::new(&scene_name(request.scene));
    let done = request.run(&interrupt(), &mut |words, share| bar.show(words, share));
    bar.finish();
    done.map_err(|failure| diagnostics::refuse_run(&failure))
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

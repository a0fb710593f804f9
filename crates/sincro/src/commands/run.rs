//! `sincro run`: one scene, its checks, its report.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use clap::Args;
use signal_hook::consts::{SIGINT, SIGTERM};
#[cfg(feature = "adapters")]
use sincro::results::write_mcap;
use sincro::results::{write_camera_frames, write_frames};
use sincro::{Campaign, Diagnostics, Loaded, Override, RunRequest, Verdict, scene_name};
use sincro_scene::open::settings_with;
use sincro_sim::file::FileError;
use sincro_sim::formats;
use sincro_sim::result_folder::ResultFolder;

use super::console::{self, Bar};
use super::robot_file::{OpenedScene, SceneSource};
use super::whole_number;
use crate::{Exit, diagnostics};

/// Arguments of `run`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folders of scenes, each with its experiment.toml, or robot files (URDF, SDF, MJCF)
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<PathBuf>,
    /// Run only this part of the experiment: `main`, or a variant by its name
    #[arg(long, value_name = "main|VARIANT")]
    only: Option<String>,
    /// Set a number of the scene (/link.mass=2, '/rotor*.speed=700'), the diagram (pid.kp=4, inner/pid.kp=4) or the
    /// experiment (parameters.m=3); may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Simulate until this time `[s]`
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// Base step `[s]`
    #[arg(long, value_name = "S")]
    step: Option<f64>,
    /// auto, semi-implicit-euler, rk4, implicit, dormand-prince, dormand-prince-8 or stiff
    #[arg(long, value_name = "NAME")]
    integrator: Option<String>,
    /// Local tolerance of the variable-step integrators
    #[arg(long, value_name = "X")]
    accuracy: Option<f64>,
    /// Folder of the results: absent, empty, or an earlier result, which is replaced; of several scenes a folder of
    /// each below it [default: the next of results/SCENE/0001, 0002 …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Seed of all random generators
    #[arg(long, value_name = "N", value_parser = whole_number::<u64>)]
    seed: Option<u64>,
    /// Write run.mcap too, for Foxglove, Lichtblick or Rerun
    #[cfg(feature = "adapters")]
    #[arg(long)]
    mcap: bool,
    /// Write pictures of the run too, as SVG files in `frames`: 30 a simulated second, 1800 at most
    #[arg(long)]
    frames: bool,
    /// Take the pictures of --frames through this camera of the scene, as PNG files
    #[arg(long, value_name = "NAME", requires = "frames")]
    camera: Option<String>,
    /// Write the signals in more formats than CSV: signals.npz, signals.mat, signals.parquet
    #[arg(long, value_name = "FORMAT", value_enum, value_delimiter = ',')]
    format: Vec<Format>,
    /// Print run.json on standard output instead of the summary
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// Formats of the recorded signals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// CSV, which is always written.
    Csv,
    /// NumPy: one array for each signal.
    Npz,
    /// MATLAB 5, also for Octave: t, signals, names, units.
    Mat,
    /// Apache Parquet: one column for each signal.
    Parquet,
}

/// A scene that is ready to run.
struct Ready {
    source: SceneSource,
    overrides: Vec<Override>,
    loaded: Loaded,
    camera: Option<usize>,
    folder: ResultFolder,
    /// Folder of the results as it is shown, if it was named.
    shown: Option<PathBuf>,
}

/// Runs the command. Nothing runs before all scenes are known to be sound.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let mut ready = Vec::new();
    let mut refused = None;
    for scene in &arguments.scenes {
        match prepare(arguments, scene, &ready) {
            Ok(scene) => ready.push(scene),
            Err(exit) => refused = Some(exit),
        }
    }
    if let Some(exit) = refused {
        return exit;
    }
    let mut worst = Exit::Holds;
    for scene in ready {
        let exit = run_one(arguments, scene);
        worst = if u8::from(exit) > u8::from(worst) { exit } else { worst };
        if interrupt().load(std::sync::atomic::Ordering::Relaxed) {
            break;
        }
    }
    worst
}

/// Loads a scene and begins its folder of results, another one than those of the scenes that are ready.
fn prepare(arguments: &Arguments, scene: &Path, others: &[Ready]) -> Result<Ready, Exit> {
    let overrides = overrides(arguments).map_err(|found| diagnostics::refuse_diagnostics(&found))?;
    let OpenedScene { source, set: mut overrides, mut loaded } = OpenedScene::with_settings(scene, overrides)?;
    if let Some(part) = &arguments.only {
        (loaded, overrides) = only(loaded, overrides, part)?;
    }
    let camera = arguments.camera.as_deref().map(|name| camera_of(&loaded, name)).transpose()?;
    let name = scene_name(source.folder());
    let shown = match &arguments.out {
        Some(out) if arguments.scenes.len() > 1 => Some(out.join(&name)),
        out => out.clone(),
    };
    if let Some(out) = shown.as_ref().filter(|_| others.iter().any(|other| other.shown == shown)) {
        let message = format!("two of the scenes are named `{name}`, both would write `{}`", out.display());
        return Err(diagnostics::refuse(&message, Some("run them one by one, each with its own --out DIR")));
    }
    let folder = match &shown {
        Some(out) => ResultFolder::replace(out),
        None => ResultFolder::numbered(&Path::new("results").join(&name)),
    };
    let folder = folder.map_err(|error| diagnostics::refuse_folder(&error))?;
    Ok(Ready { source, overrides, loaded, camera, folder, shown })
}

fn run_one(arguments: &Arguments, ready: Ready) -> Exit {
    let Ready { source, overrides, loaded, camera, folder, shown } = ready;
    let request = RunRequest { scene: source.folder(), overrides: &overrides, loaded: &loaded, index: None };
    let campaign = match run_with_progress(&request, folder.path(), arguments.quiet) {
        Ok(campaign) => campaign,
        Err(exit) => return exit,
    };
    let more = write_more(arguments, &loaded, &campaign, camera, folder.path());
    let out = match more.and_then(|()| folder.publish()) {
        Ok(published) => shown.unwrap_or(published),
        Err(error) => return diagnostics::refuse_file(&error),
    };
    if arguments.json {
        say!("{}", campaign.report.to_json());
    } else if !arguments.quiet {
        diagnostics::print_diagnostics(&loaded.warnings);
        if std::io::stderr().is_terminal() {
            diagnostics::note_older_format(source.folder(), &loaded);
        }
        console::print_summary(&loaded, &campaign, &out);
    } else {
        console::print_stops(&campaign);
    }
    Verdict::of(&campaign).into()
}

/// The main run or a variant alone, with the settings that it is made with.
fn only(mut loaded: Loaded, overrides: Vec<Override>, part: &str) -> Result<(Loaded, Vec<Override>), Exit> {
    let mut settings = overrides;
    if part != "main" {
        let variants = &loaded.experiment.variants;
        let Some(variant) = variants.iter().find(|variant| variant.name == part).cloned() else {
            let names: Vec<&str> = ["main"].into_iter().chain(variants.iter().map(|v| v.name.as_str())).collect();
            let message = format!("there is no variant `{part}`");
            return Err(diagnostics::refuse(
                &message,
                Some(&format!("parts of this experiment: {}", names.join(", "))),
            ));
        };
        settings = settings_with(&settings, &variant.set);
        loaded = loaded
            .with_overrides_without_variants(&settings)
            .map_err(|found| diagnostics::refuse_diagnostics(&found))?;
        let inherited = if variant.inherit_checks { std::mem::take(&mut loaded.experiment.checks) } else { Vec::new() };
        loaded.experiment.checks = variant.checks.into_iter().chain(inherited).collect();
        loaded.experiment.title += &format!(" ({part})");
    }
    loaded.experiment.keep_one_run();
    Ok((loaded, settings))
}

/// Writes what was asked for beside the results that every run has.
fn write_more(
    arguments: &Arguments,
    loaded: &Loaded,
    campaign: &Campaign,
    camera: Option<usize>,
    out: &Path,
) -> Result<(), FileError> {
    let tables = std::iter::once((out.to_owned(), &campaign.main));
    let variants = campaign.variants.iter().map(|(v, done)| (out.join("variants").join(&v.name), done));
    for (folder, done) in tables.chain(variants) {
        let table = &done.simulated.table;
        for format in &arguments.format {
            match format {
                Format::Csv => {}
                Format::Npz => formats::write_npz(table, &folder.join("signals.npz"))?,
                Format::Mat => formats::write_mat(table, &folder.join("signals.mat"))?,
                Format::Parquet => formats::write_parquet(table, &folder.join("signals.parquet"))?,
            }
        }
    }
    #[cfg(feature = "adapters")]
    if arguments.mcap {
        write_mcap(&campaign.main, &out.join("run.mcap"))?;
    }
    match camera {
        _ if !arguments.frames => Ok(()),
        Some(k) => write_camera_frames(loaded, &campaign.main, k, out),
        None => write_frames(&campaign.main, out),
    }
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

/// Runs an experiment into a folder with a progress bar on a terminal, until its end, Ctrl-C or SIGTERM.
pub(crate) fn run_with_progress(request: &RunRequest<'_>, out: &Path, is_quiet: bool) -> Result<Campaign, Exit> {
    let bar = if is_quiet { Bar::none() } else { Bar::new(&scene_name(request.scene)) };
    let done = request.run_into(out, &interrupt(), &mut |words, share| bar.show(words, share));
    bar.finish();
    done.map_err(|failure| diagnostics::refuse_run(&failure))
}

/// Set by Ctrl-C or SIGTERM; a second one ends the program at once.
pub(crate) fn interrupt() -> Arc<AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    let flag = FLAG.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        for (signal, status) in [(SIGINT, 130), (SIGTERM, 143)] {
            // without a handler the signal ends the program as usual; the order matters: the second signal ends it
            let _ = signal_hook::flag::register_conditional_shutdown(signal, status, flag.clone());
            let _ = signal_hook::flag::register(signal, flag.clone());
        }
        flag
    });
    flag.clone()
}

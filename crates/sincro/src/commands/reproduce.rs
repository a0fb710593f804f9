//! `sincro reproduce`: every experiment, one page.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;

use clap::Args;
use sincro::results::{Link, card, write_text};
use sincro::{RunRequest, Verdict, load, scene_name};
use sincro_figures::plot::number::significant;
use sincro_figures::report::{Card, IndexPage, index_html};
use sincro_sim::result_folder::ResultFolder;
use sincro_sim::workers::on_all_processors;

use super::console::verdict_line;
use super::gallery::Place;
use super::run::run_with_progress;
use crate::{Exit, diagnostics};

/// Arguments of `reproduce`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the results
    #[arg(long, value_name = "DIR", default_value = "results/reproduce")]
    out: PathBuf,
    /// Folder of the scenes [default: scenes, here or in the source tree this program was built from]
    #[arg(long, value_name = "DIR")]
    scenes: Option<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let clock = Instant::now();
    let scenes = match find_scenes(arguments.scenes.as_deref()) {
        Ok(scenes) => scenes,
        Err(message) => return diagnostics::refuse(&message, Some("name the folder with --scenes DIR")),
    };
    let lines: Vec<OnceLock<Option<String>>> = scenes.iter().map(|_| OnceLock::new()).collect();
    let job = |k: usize| {
        let done = one(&scenes[k], &arguments.out);
        let _ = lines[k].set(done.as_ref().ok().map(|done| done.line.clone()));
        done
    };
    // in the order of the page, whatever ends first
    let mut said = 0;
    let mut say_next = || {
        while let Some(line) = lines.get(said).and_then(OnceLock::get) {
            if let Some(line) = line {
                say!("{line}");
            }
            said += 1;
        }
    };
    let all = on_all_processors(scenes.len(), &job, &mut say_next);
    say_next();
    let (mut cards, mut worst) = (Vec::new(), Exit::Holds);
    for done in all {
        match done {
            Ok(Reproduced { card, exit, .. }) => {
                cards.push(card);
                worst = if worst == Exit::Holds { exit } else { worst };
            }
            Err(exit) => worst = exit,
        }
    }
    let page = IndexPage {
        title: "sincro reproduces the thesis".into(),
        description: "Every experiment of «V-REP como herramienta de simulación de sistemas dinámicos» (Á. Morales, Seville, \
                      2019), chapter by chapter, and textbook scenes apart, run from their scene folders and checked against \
                      their equations. Published problems of others: `sincro reproduce --scenes scenes/third-party`."
            .into(),
        cards,
        settings: vec![
            ("sincro".into(), env!("CARGO_PKG_VERSION").into()),
            ("vector instructions".into(), sincro_math::lanes::instruction_set().into()),
            ("time for all".into(), format!("{} s", significant(clock.elapsed().as_secs_f64(), 2))),
        ],
        notes: vec!["Results do not depend on the machine, the number of threads or the build profile: the trace hash in each \
                     report says so."
            .into()],
    };
    if let Err(error) = write_text(&arguments.out.join("index.html"), &index_html(&page)) {
        return diagnostics::refuse_file(&error);
    }
    say!("{} experiments in {} s", scenes.len(), significant(clock.elapsed().as_secs_f64(), 2));
    say!("open {}", arguments.out.join("index.html").display());
    worst
}

/// One scene that was run.
struct Reproduced {
    card: Card,
    exit: Exit,
    /// Name, verdict and trace hash, for the console.
    line: String,
}

/// Runs one scene into its folder below `out`.
fn one(scene: &Path, out: &Path) -> Result<Reproduced, Exit> {
    let loaded = load(scene, &[]).map_err(|diagnostics| diagnostics::refuse_diagnostics(&diagnostics))?;
    let name = scene_name(scene);
    let folder = out.join(&name);
    let index = Some(Link { label: "all experiments", href: "../index.html" });
    let output = ResultFolder::replace(&folder).map_err(|error| diagnostics::refuse_folder(&error))?;
    let request = RunRequest { scene, overrides: &[], loaded: &loaded, index };
    let campaign = run_with_progress(&request, output.path(), true)?;
    output.publish().map_err(|error| diagnostics::refuse_file(&error))?;
    let exit = Verdict::of(&campaign).into();
    let line = format!("{:<25} {:<28} {}", name, verdict_line(&campaign.report), campaign.report.trace_hash);
    let place = Place::of(scene);
    let card = card(&loaded, &campaign, &format!("{name}/report.html"));
    let card = Card { group: place.group.into(), source: place.source(&name), ..card };
    Ok(Reproduced { card, exit, line })
}

/// The scene folders, chapter by chapter in the order of the thesis.
fn find_scenes(asked: Option<&Path>) -> Result<Vec<PathBuf>, String> {
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let candidates: Vec<&Path> = match asked {
        Some(dir) => vec![dir],
        None => vec![Path::new("scenes"), &built_from],
    };
    let dir = candidates.iter().find(|dir| dir.is_dir());
    let dir = dir.ok_or_else(|| format!("there is no folder of scenes at `{}`", candidates[0].display()))?;
    let entries = std::fs::read_dir(dir).map_err(|e| format!("the folder `{}` cannot be read: {e}", dir.display()))?;
    let mut scenes: Vec<PathBuf> =
        entries.filter_map(Result::ok).map(|e| e.path()).filter(|p| p.join("experiment.toml").is_file()).collect();
    scenes.sort_by_key(|path| (Place::of(path), path.clone()));
    if scenes.is_empty() { Err(format!("no scene in `{}`", dir.display())) } else { Ok(scenes) }
}

//! Opening a scene folder: reads, sets, checks and compiles everything in it, and reports all problems at once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;

use crate::apply_overrides::{Target, apply_all, names_of_blocks, whole_paths};
use crate::diagnostic::{Diagnostic, Diagnostics, Located, SourceText};
use crate::diagram::{self, ControlDiagram, diagram_schema};
use crate::document::{Document, escape};
use crate::expand::expand;
use crate::experiment::{self, Experiment, Plot, experiment_schema};
use crate::fmu::Loaders;
use crate::folder::Folder;
use crate::instance_settings::adopt_included;
use crate::names::resolve_signals;
use crate::normalize::{Parameters, newer_format, normalize, parameters_of};
use crate::overrides::Override;
use crate::record::{Recorder, catalogue};
use crate::scene::{self, Scene, SceneSource, scene_schema};
use crate::schema::validate;
use crate::script::ScriptParser;
use crate::tree;
use crate::unused;

/// The file that makes a folder an experiment.
const EXPERIMENT: &str = "experiment.toml";

/// Numbers that a recording may have: 800 MB.
const MAX_NUMBERS: u64 = 100_000_000;

/// Scene folder that was opened: experiment, scene and diagram, ready to run; result of [`open`].
///
/// ```
/// use sincro_scene::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let opened = open(folder.as_ref(), &[], Default::default(), true)?;
/// assert_eq!(opened.scene.model.n_v(), 2); // two hinges
/// assert!(opened.controller.is_none() && opened.warnings.is_empty());
/// assert!(opened.sources.len() >= 2); // the experiment and its scene
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Opened {
    /// Experiment: times, recorded signals, checks, variants.
    pub experiment: Experiment,
    /// Compiled scene with its model.
    pub scene: Scene,
    /// Block diagram that controls the scene, if there is one.
    pub controller: Option<ControlDiagram>,
    /// Warnings about the files, in their order; errors would have been refused.
    pub warnings: Vec<Diagnostic>,
    /// Every text file that was read, for a hash of the inputs.
    pub sources: Vec<Arc<SourceText>>,
    /// Cache of the folder's files, for [`open_in`].
    pub folder: Arc<Folder>,
}

/// Opens a scene folder, or its `experiment.toml`, with the settings `overrides`, which win over the files (later ones
/// over earlier ones). `loaders` read scripts and FMUs. With `with_others` its variants and the first and last point of
/// its sweep are opened on trial, too, so that errors in their settings show before anything runs.
///
/// # Errors
///
/// All findings about the files and the settings, warnings included, in the order of the files.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let longer = Override::new("duration", "42");
/// let opened = open(folder.as_ref(), &[longer], Default::default(), false)?;
/// assert_eq!(opened.experiment.duration, 42.0); // [s]
///
/// let wrong = open("no-such-folder".as_ref(), &[], Default::default(), true).unwrap_err();
/// assert!(wrong.to_string().contains("there is no folder `no-such-folder`"));
/// # Ok(())
/// # }
/// ```
pub fn open(folder: &Path, overrides: &[Override], loaders: Loaders, with_others: bool) -> Result<Opened, Diagnostics> {
    open_in(&Arc::new(Folder::new(&find_folder(folder)?)), overrides, loaders, with_others)
}

/// As [`open`], of a folder whose files are cached: those that were read before are not read again.
///
/// # Errors
///
/// As [`open`].
pub fn open_in(
    folder: &Arc<Folder>,
    overrides: &[Override],
    loaders: Loaders,
    with_others: bool,
) -> Result<Opened, Diagnostics> {
    let opened = open_one(folder, overrides, loaders)?;
    let further = if with_others { opened.trials(overrides) } else { Vec::new() };
    let tried = further.iter().map(|settings| open_one(folder, settings, loaders)).collect();
    Ok(opened.with_trials(tried)?.0)
}

impl Opened {
    /// Settings with which this experiment, opened with the settings `overrides`, is to be opened on trial before it
    /// runs: those of its variants, and of the first and last run of its sweep. None if it is opened as a variant.
    #[must_use]
    pub fn trials(&self, overrides: &[Override]) -> Vec<Vec<Override>> {
        // a variant was opened with the main run: its own settings must not meet those of the others
        let file = self.folder.path_of(EXPERIMENT);
        if overrides.iter().any(|setting| setting.path.at.source.path == file) {
            return Vec::new();
        }
        let Experiment { variants, sweep, .. } = &self.experiment;
        let of_variants = variants.iter().map(|variant| variant.set.clone());
        let ends = sweep.iter().flat_map(|sweep| {
            let ends = [sweep.values.first(), sweep.values.last()].into_iter().flatten();
            ends.map(|value| sweep.settings(*value).collect())
        });
        of_variants.chain(ends).map(|setting: Vec<_>| settings_with(overrides, &setting)).collect()
    }

    /// Adds what was found where it was opened on trial, warnings included; returns the trials beside it.
    ///
    /// # Errors
    ///
    /// All findings, if there is an error among them.
    pub fn with_trials(mut self, tried: Vec<Result<Self, Diagnostics>>) -> Result<(Self, Vec<Self>), Diagnostics> {
        let mut diagnostics = Diagnostics(std::mem::take(&mut self.warnings));
        for trial in &tried {
            diagnostics.merge(match trial {
                Ok(trial) => Diagnostics(trial.warnings.clone()),
                Err(found) => found.clone(),
            });
        }
        if diagnostics.any_error() {
            return Err(diagnostics.sorted());
        }
        let sources = self.folder.sources();
        Ok((Self { warnings: diagnostics.sorted().0, sources, ..self }, tried.into_iter().flatten().collect()))
    }
}

/// Returns the name of a scene, that of its folder; `path` is the folder or its `experiment.toml`. `scene` if the path
/// has no name.
#[must_use]
pub fn folder_name(path: &Path) -> String {
    let folder =
        if path.file_name().is_some_and(|name| name == EXPERIMENT) { path.parent().unwrap_or(path) } else { path };
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    whole.file_name().map_or_else(|| "scene".into(), |name| name.to_string_lossy().into_owned())
}

/// Returns the settings `overrides` followed by those of a variant, which win. Settings of blocks belong to the diagram
/// that they were given for: they are left out if the variant replaces the diagram.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let outer = [Override::new("step", "0.01"), Override::new("duration", "5")];
/// let variant = [Override::new("step", "0.002")];
/// // those of the variant are the last: they win
/// let all = settings_with(&outer, &variant);
/// let texts: Vec<&str> = all.iter().map(|setting| setting.value.value.as_str()).collect();
/// assert_eq!(texts, ["0.01", "5", "0.002"]);
/// ```
#[must_use]
pub fn settings_with(overrides: &[Override], variant: &[Override]) -> Vec<Override> {
    let exchanges = variant.iter().any(|setting| setting.path.value == "diagram");
    let outer = overrides.iter().filter(|setting| !(exchanges && setting.target() == Target::Diagram));
    outer.chain(variant).cloned().collect()
}

/// The folder that is meant by a folder or by the experiment file in it.
fn find_folder(path: &Path) -> Result<PathBuf, Diagnostics> {
    let shown = path.display();
    let help = "name a folder with an `experiment.toml`";
    let Ok(metadata) = std::fs::metadata(path) else {
        return Err(Diagnostic::without_location(format!("there is no folder `{shown}`")).with_help(help).into());
    };
    if metadata.is_dir() {
        if path.join(EXPERIMENT).exists() {
            return Ok(path.to_owned());
        }
        let found = experiments_below(path);
        let help = if found.is_empty() { help.to_owned() } else { format!("there is one in {}", found.join(", ")) };
        return Err(Diagnostic::without_location(format!("the folder `{shown}` has no `{EXPERIMENT}`"))
            .with_help(help)
            .into());
    }
    if path.file_name().is_some_and(|name| name == EXPERIMENT) {
        let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
        return Ok(parent.unwrap_or(Path::new(".")).to_owned());
    }
    Err(Diagnostic::without_location(format!("`{shown}` is not a folder and not an `{EXPERIMENT}`"))
        .with_help(help)
        .into())
}

/// Up to five folders in a folder that are experiments.
fn experiments_below(path: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
    let with_file = entries.map(|entry| entry.path()).filter(|p| p.join(EXPERIMENT).is_file());
    let mut found: Vec<String> = with_file.map(|p| format!("`{}`", p.display())).collect();
    found.sort();
    found.truncate(5);
    found
}

/// Returns true if the recorded times are others than those the file was written for. Checks that look between them are
/// then not refused, they cannot be made: who shortens a run to have a look at it has not made a mistake in the file.
fn sets_times(overrides: &[Override]) -> bool {
    overrides.iter().any(|setting| matches!(setting.path.value.as_str(), "duration" | "step" | "record_every"))
}

/// Refuses a recording that no memory would hold.
fn too_large(experiment: &Experiment) -> Diagnostics {
    let rows = experiment.n_steps / experiment.record_every + 1;
    let numbers = rows.saturating_mul(experiment.record.len() as u64 + 1);
    if numbers <= MAX_NUMBERS {
        return Diagnostics::new();
    }
    let message = format!("{rows} rows of {} signals are more than memory is asked to hold", experiment.record.len());
    let help = format!(
        "record fewer rows: record_every = {} or more",
        experiment.record_every * numbers.div_ceil(MAX_NUMBERS)
    );
    Diagnostics::from(Diagnostic::error(&experiment.record[0].at, message).with_help(help))
}

/// The files of an experiment as documents: everything reused written out, all settings applied.
pub(crate) struct Documents {
    pub experiment: Document,
    pub scene: Option<Document>,
    pub diagram: Option<Document>,
}

/// Reads the files of a folder with settings. What is wrong with the scene or the diagram is noted, and the rest read
/// all the same.
pub(crate) fn read_documents(
    folder: &Folder,
    overrides: &[Override],
    diagnostics: &mut Diagnostics,
) -> Result<Documents, Diagnostics> {
    let mut experiment = Document::parse(&folder.read(EXPERIMENT)?)?;
    diagnostics.merge(newer_format(&experiment).map(Diagnostics::from).unwrap_or_default());
    let names_scene: Vec<Override> = overrides.iter().filter(|s| s.path.value == "scene").cloned().collect();
    diagnostics.merge(apply_all(&mut experiment, Target::Experiment, &names_scene));
    let scene = read_scene(&experiment, folder, diagnostics);
    if let Some(scene) = &scene {
        adopt_parameters(&mut experiment, scene);
    }
    // parameters first: formulas may stand anywhere
    let sets_parameters = |s: &&Override| s.target() == Target::Experiment && s.path.value.starts_with("parameters");
    let mut of_parameters: Vec<Override> = overrides.iter().filter(sets_parameters).cloned().collect();
    if let Some(scene) = &scene {
        of_parameters = adopt_included(&mut experiment, scene, folder, of_parameters, diagnostics);
    }
    diagnostics.merge(apply_all(&mut experiment, Target::Experiment, &of_parameters));
    let parameters = parameters_of(&experiment);
    diagnostics.merge(normalize(&mut experiment, experiment_schema(), &parameters));
    let others: Vec<Override> = overrides.iter().filter(|s| !sets_parameters(s)).cloned().collect();
    let experiment = prepared(experiment, Target::Experiment, &others, &parameters, diagnostics);
    let diagram = read_diagram(&experiment, folder, diagnostics);
    let blocks = diagram.as_ref().map(names_of_blocks).unwrap_or_default();
    // a block may have a parameter `parameters`, too
    let is_of_block = |s: &Override| blocks.iter().any(|block| s.path.value.split('.').next() == Some(block));
    let (mut settings, others): (Vec<_>, Vec<_>) = overrides.iter().cloned().partition(is_of_block);
    let scene = match scene {
        Some(mut scene) => {
            diagnostics.merge(apply_all(&mut scene, Target::Scene, &early(&others)));
            settings.extend(expand(&mut scene, folder, &parameters, &others, diagnostics));
            Some(scene)
        }
        None => {
            settings.extend(others);
            None
        }
    };
    let paths: Vec<String> = scene.iter().flat_map(tree::raw_objects).map(|object| object.path).collect();
    let overrides = whole_paths(&settings, scene.as_ref(), &paths, &blocks, diagnostics);
    let scene = scene.map(|scene| prepared(scene, Target::Scene, &overrides, &parameters, diagnostics));
    let diagram = match diagram {
        Some(mut diagram) => {
            diagnostics.merge(apply_all(&mut diagram, Target::Diagram, &overrides));
            Some(diagram)
        }
        None => {
            let is_read = experiment.located("/diagram").is_some();
            for setting in overrides.iter().filter(|s| s.target() == Target::Diagram && !is_read) {
                diagnostics.push(setting.without_diagram());
            }
            None
        }
    };
    Ok(Documents { experiment, scene, diagram })
}

/// Settings of what is written out before all others are applied.
fn early(overrides: &[Override]) -> Vec<Override> {
    let first = |setting: &Override| setting.path.value.split(['.', '[']).next().unwrap_or("").to_owned();
    let is_early = |setting: &&Override| matches!(first(setting).as_str(), "instance" | "default" | "include");
    overrides.iter().filter(is_early).cloned().collect()
}

/// Parameters of the scene file are parameters of the experiment, unless that gives them itself.
fn adopt_parameters(experiment: &mut Document, scene: &Document) {
    let Some(table) = scene.get("/parameters").and_then(Value::as_object) else { return };
    if experiment.get("/parameters").is_none() {
        experiment.put_silently("/parameters", Value::Object(serde_json::Map::new()), &scene.at("/parameters"));
    }
    for name in table.keys() {
        let pointer = format!("/parameters/{}", escape(name));
        if experiment.get(&pointer).is_none() && experiment.get("/parameters").is_some_and(Value::is_object) {
            experiment.copy_from(&pointer, scene, &pointer);
        }
    }
}

/// One experiment without its variants.
fn open_one(folder: &Arc<Folder>, overrides: &[Override], loaders: Loaders) -> Result<Opened, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let Documents { experiment: mut document, scene, diagram } = read_documents(folder, overrides, &mut diagnostics)?;
    let seed = document.get("/seed").and_then(Value::as_u64).unwrap_or(0);
    let parser = loaders.scripts.map(|parser| parser as &dyn ScriptParser);
    let scene_document = scene;
    let scene =
        scene_document.as_ref().and_then(|document| compile_scene(document, folder, (seed, parser), &mut diagnostics));
    if let Some(scene) = &scene {
        let blocks = diagram.as_ref().map(names_of_blocks).unwrap_or_default();
        let known: Vec<String> = catalogue(&scene.model).into_iter().map(|entry| entry.name).collect();
        diagnostics.merge(resolve_signals(&mut document, &known, &blocks));
    }
    let found = validate(&document, experiment_schema());
    let fits = !found.any_error();
    diagnostics.merge(found);
    let experiment = fits.then(|| {
        let (experiment, found) = experiment::resolve(&document, folder, !sets_times(overrides));
        diagnostics.merge(found);
        experiment
    });
    let experiment = experiment.flatten();
    let against = (experiment.as_ref(), scene.as_ref().zip(scene_document.as_ref()));
    let controller =
        diagram.as_ref().and_then(|diagram| compile_diagram(diagram, folder, against, loaders, &mut diagnostics));
    if let (Some(scene), Some(scene_document), Some(diagram)) = (&scene, &scene_document, &diagram) {
        diagnostics.merge(unused::warn_of_blocks(diagram, &document));
        // a scene file of another folder belongs to more experiments than this, and `simulation_step` is for clients
        let is_own = !document.text("/scene").is_some_and(|file| file.contains(".."));
        if is_own && document.get("/simulation_step").is_none() {
            diagnostics.merge(unused::warn_of_objects(scene, [&document, scene_document, diagram]));
        }
    }
    let experiment = match (experiment, &controller, &scene) {
        (Some(experiment), Some(controller), Some(scene)) => Some(with_scopes(experiment, controller, scene)),
        (experiment, ..) => experiment,
    };
    let is_whole = document.located("/diagram").is_some() == controller.is_some();
    if let (Some(experiment), Some(scene), true) = (&experiment, &scene, is_whole) {
        let signals = controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        if let Err(found) = Recorder::new(&experiment.record, &scene.model, &signals) {
            diagnostics.merge(found);
        }
        if let Some(task) = &experiment.task {
            diagnostics.merge(experiment::task::check(task, &scene.model, &signals));
        }
    }
    if let Some(experiment) = &experiment {
        if let Some(scene) = &scene {
            diagnostics.merge(experiment::check_sample_times(&scene.sensors, experiment));
        }
        diagnostics.merge(experiment::stop::check_recorded(experiment));
        diagnostics.merge(too_large(experiment));
    }
    match (experiment, scene) {
        (Some(experiment), Some(mut scene)) if !diagnostics.any_error() => {
            diagnostics.merge(Diagnostics(scene.warnings.clone()));
            let source =
                |document| Arc::new(SceneSource { document, folder: folder.clone(), seed, parked: BTreeMap::new() });
            scene.source = scene_document.map(source);
            Ok(Opened {
                experiment,
                scene,
                controller,
                warnings: diagnostics.0,
                sources: Vec::new(),
                folder: folder.clone(),
            })
        }
        _ => Err(diagnostics.sorted()),
    }
}

/// The scene file that an experiment names.
fn read_scene(experiment: &Document, folder: &Folder, diagnostics: &mut Diagnostics) -> Option<Document> {
    let read = match (experiment.located("/scene"), experiment.get("/scene")) {
        (Some(name), _) => folder.read_named(&name),
        (None, None) => folder
            .read("scene.toml")
            .map_err(|p| p.with_help("name the scene file in `experiment.toml`: scene = \"scene.toml\"")),
        (None, Some(_)) => return None,
    };
    let document = read.map_err(Diagnostics::from).and_then(|source| Document::parse(&source));
    let document = document.map_err(|found| diagnostics.merge(found)).ok()?;
    diagnostics.merge(newer_format(&document).map(Diagnostics::from).unwrap_or_default());
    Some(document)
}

/// Compiles the scene, also if the experiment has problems of its own.
fn compile_scene(
    document: &Document,
    folder: &Folder,
    (seed, parser): (u64, Option<&dyn ScriptParser>),
    diagnostics: &mut Diagnostics,
) -> Option<Scene> {
    let found = validate(document, scene_schema());
    if found.any_error() {
        diagnostics.merge(found);
        return None;
    }
    scene::compile(document, folder, seed, parser).map_err(|found| diagnostics.merge(found)).ok()
}

/// The diagram file that an experiment names, if there is one.
fn read_diagram(experiment: &Document, folder: &Folder, diagnostics: &mut Diagnostics) -> Option<Document> {
    let name = experiment.located("/diagram")?;
    let read = folder.read_named(&name).map_err(Diagnostics::from);
    let document = read.and_then(|source| Document::parse(&source));
    let mut document = document.map_err(|found| diagnostics.merge(found)).ok()?;
    name_types(&mut document);
    Some(document)
}

/// Blocks of a diagram that say `kind`, as objects of a scene do, are understood.
fn name_types(document: &mut Document) {
    let length = |document: &Document, list: &str| document.get(list).and_then(Value::as_array).map_or(0, Vec::len);
    let mut lists = vec!["/block".to_owned()];
    lists.extend((0..length(document, "/diagram")).map(|k| format!("/diagram/{k}/block")));
    for list in lists {
        for k in 0..length(document, &list) {
            if document.get(&format!("{list}/{k}/type")).is_none() {
                document.rename(&format!("{list}/{k}/kind"), "type");
            }
        }
    }
}

/// Compiles a diagram. It is validated even if scene or experiment have problems, but connected only to a scene that
/// has none.
fn compile_diagram(
    document: &Document,
    folder: &Folder,
    (experiment, scene): (Option<&Experiment>, Option<(&Scene, &Document)>),
    loaders: Loaders,
    diagnostics: &mut Diagnostics,
) -> Option<ControlDiagram> {
    let found = validate(document, diagram_schema());
    if found.any_error() {
        diagnostics.merge(found);
        return None;
    }
    let (experiment, (scene, scene_document)) = (experiment?, scene?);
    let setting = diagram::Setting {
        model: &scene.model,
        scene: Some(scene_document),
        step: experiment.step,
        seed: experiment.seed,
        parameters: &experiment.parameters,
        loaders,
    };
    diagram::open(document, folder, setting).map_err(|found| diagnostics.merge(found)).ok()
}

/// Adds the signals of the diagram's scopes to the recorded and plotted ones.
fn with_scopes(mut experiment: Experiment, controller: &ControlDiagram, scene: &Scene) -> Experiment {
    let at = experiment.record[0].at.clone();
    for (title, names) in controller.scopes(&scene.model).into_iter().filter(|(_, names)| !names.is_empty()) {
        let signals: Vec<Located<String>> = names.into_iter().map(|value| Located { value, at: at.clone() }).collect();
        for signal in &signals {
            if !experiment.record.iter().any(|known| known.value == signal.value) {
                experiment.record.push(signal.clone());
            }
        }
        experiment.plots.push(Plot {
            title,
            is_path: false,
            signals,
            reference: None,
            compares_variants: None,
            variants: None,
        });
    }
    experiment
}

/// The document with the settings that are for it, in the units and words of its schema.
fn prepared(
    mut document: Document,
    target: Target,
    overrides: &[Override],
    parameters: &Parameters,
    diagnostics: &mut Diagnostics,
) -> Document {
    diagnostics.merge(apply_all(&mut document, target, overrides));
    let schema = if target == Target::Scene { scene_schema() } else { experiment_schema() };
    diagnostics.merge(normalize(&mut document, schema, parameters));
    document
}

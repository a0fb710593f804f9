//! `sincro convert`: scene folders in the present format, comments kept.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, SourceText};
use sincro_scene::document::Document;
use sincro_scene::experiment::experiment_schema;
use sincro_scene::folder::read_text;
use sincro_scene::normalize::convert;
use sincro_scene::scene::scene_schema;
use sincro_sim::file::write_atomically;

use crate::{Exit, diagnostics};

/// Arguments of `convert`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folders of scenes
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<PathBuf>,
    /// Say which files would change, and change nothing; exit status 1 if there are any
    #[arg(long)]
    check: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let mut all = Vec::new();
    let mut found = Diagnostics::new();
    for scene in &arguments.scenes {
        match files(scene) {
            Ok(files) => all.extend(files),
            Err(diagnostics) => found.merge(diagnostics),
        }
    }
    // nothing is written before everything is read
    if found.any_error() {
        return diagnostics::refuse_diagnostics(&found);
    }
    all.retain(|(source, new)| source.text != *new);
    all.dedup_by(|a, b| a.0.path == b.0.path);
    for (source, new) in &all {
        if !arguments.check
            && let Err(error) = write_atomically(&source.path, new.as_bytes())
        {
            return diagnostics::refuse_file(&error);
        }
        say!("{}{}", source.path.display(), if arguments.check { " is of an older format" } else { "" });
    }
    if all.is_empty() {
        say!("nothing to convert");
    }
    if arguments.check && !all.is_empty() { Exit::Fails } else { Exit::Holds }
}

/// A file and its text in the present format.
type Converted = (Arc<SourceText>, String);

/// The experiment and the scene files that it reads.
fn files(scene: &Path) -> Result<Vec<Converted>, Diagnostics> {
    let folder = if scene.is_file() { scene.parent().unwrap_or(Path::new(".")) } else { scene };
    let experiment = read(&folder.join("experiment.toml"))?;
    let document = Document::parse(&experiment)?;
    let mut waiting = vec![document.text("/scene").unwrap_or("scene.toml").to_owned()];
    let mut converted = vec![(experiment.clone(), convert(&experiment, experiment_schema())?)];
    let mut seen = Vec::new();
    while let Some(name) = waiting.pop() {
        if seen.contains(&name) {
            continue;
        }
        let source = read(&folder.join(&name))?;
        let document = Document::parse(&source)?;
        let texts = |pointer: &str| document.get(pointer).and_then(|v| v.as_array()).cloned().unwrap_or_default();
        waiting.extend(texts("/include").iter().filter_map(|v| v.as_str()).map(str::to_owned));
        waiting.extend(texts("/instance").iter().filter_map(|v| v.get("file")?.as_str()).map(str::to_owned));
        converted.push((source.clone(), convert(&source, scene_schema())?));
        seen.push(name);
    }
    Ok(converted)
}

fn read(path: &Path) -> Result<Arc<SourceText>, Diagnostics> {
    let text = read_text(path).map_err(Diagnostic::without_location)?;
    Ok(Arc::new(SourceText { path: path.to_owned(), text }))
}

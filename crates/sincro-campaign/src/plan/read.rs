//! Reading of a plan file: every problem in it at once, each at its place.

use std::path::Path;
use std::sync::Arc;

use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Location, SourceText};
use toml::Spanned;

use super::Plan;
use super::file::{ExperimentFile, PlanFile};
use super::resolve::resolve;

/// Places in a plan file.
pub(super) struct Places {
    pub(super) source: Arc<SourceText>,
}

impl Places {
    pub(super) fn of<T>(&self, value: &Spanned<T>) -> Location {
        Location { source: self.source.clone(), span: value.span() }
    }

    pub(super) fn start(&self) -> Location {
        Location { source: self.source.clone(), span: 0..0 }
    }

    pub(super) fn error<T>(&self, value: &Spanned<T>, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(&self.of(value), message)
    }
}

/// Reads the text of a plan file.
pub(super) fn plan(path: &Path, text: String) -> Result<Plan, Diagnostics> {
    let source = Arc::new(SourceText { path: path.to_path_buf(), text });
    let refuse = |error: toml::de::Error| {
        let at = Location { source: source.clone(), span: error.span().unwrap_or(0..0) };
        Diagnostic::error(&at, error.message().trim().to_owned())
    };
    let places = Places { source: source.clone() };
    let start = places.start();
    let file: PlanFile = if is_experiment(path) {
        let file: ExperimentFile = toml::from_str(&source.text).map_err(refuse)?;
        let file = file.campaign.ok_or_else(|| {
            let problem = Diagnostic::error(&start, "the experiment has no campaign");
            problem.with_help("give it a table [campaign], or name a plan file")
        })?;
        if let Some(scene) = &file.scene {
            let problem = places.error(scene, "the campaign of an experiment names a scene");
            return Err(problem.with_help("leave it away: it is that of the experiment").into());
        }
        file
    } else {
        let file: PlanFile = toml::from_str(&source.text).map_err(refuse)?;
        if file.scene.is_none() {
            let problem = Diagnostic::error(&start, "the plan names no scene");
            return Err(problem.with_help("add scene = \"FOLDER\", relative to the plan").into());
        }
        file
    };
    resolve(file, &places)
}

/// True for the experiment file of a scene, whose table `[campaign]` is the plan.
fn is_experiment(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name == "experiment.toml")
}

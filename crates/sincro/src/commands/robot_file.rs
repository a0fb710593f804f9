//! Scenes of the command line: folders, and robot files that are imported into a temporary folder first, opened with
//! the settings of `--set`.

use std::path::{Path, PathBuf};

use sincro::{Loaded, load};
#[cfg(feature = "formats")]
use sincro_import::{Imported, Options, import, is_robot_file};
use sincro_scene::overrides::Override;

use super::run::parse_settings;
use crate::{Exit, diagnostics};

/// The scene that a command works on, opened.
pub(crate) struct OpenedScene {
    /// Its folder.
    pub source: SceneSource,
    /// Settings that it was opened with.
    pub set: Vec<Override>,
    /// Its content.
    pub loaded: Loaded,
}

impl OpenedScene {
    /// Opens the scene folder or robot file `path` with the settings `set`, each `PATH=VALUE`.
    ///
    /// # Errors
    ///
    /// Robot, settings or scene are refused; the reasons have been printed.
    pub fn open(path: &Path, set: &[String]) -> Result<Self, Exit> {
        let set = parse_settings(set).map_err(|found| diagnostics::refuse_diagnostics(&found))?;
        Self::with_settings(path, set)
    }

    /// As [`OpenedScene::open`], with settings that have been read.
    pub fn with_settings(path: &Path, set: Vec<Override>) -> Result<Self, Exit> {
        let source = SceneSource::open(path)?;
        let loaded = load(source.folder(), &set).map_err(|found| diagnostics::refuse_diagnostics(&found))?;
        Ok(Self { source, set, loaded })
    }
}

/// A scene folder, or that of a robot file, which lives as long as this.
#[derive(Debug)]
pub(crate) struct SceneSource {
    folder: PathBuf,
    temporary: Option<PathBuf>,
}

impl SceneSource {
    /// The folder `path`, or the scene of the robot file `path`.
    ///
    /// # Errors
    ///
    /// The robot is refused; the reasons have been printed.
    pub fn open(path: &Path) -> Result<Self, Exit> {
        if is_robot_file(path) && path.is_file() {
            return Self::import(path);
        }
        Ok(Self { folder: path.to_path_buf(), temporary: None })
    }

    #[cfg(feature = "formats")]
    fn import(path: &Path) -> Result<Self, Exit> {
        let imported = import(path, &Options::default()).map_err(|found| diagnostics::refuse_import(&found))?;
        let name = path.file_stem().map_or_else(|| "robot".into(), |stem| stem.to_os_string());
        let temporary = std::env::temp_dir().join(format!("sincro-robot-{}", std::process::id()));
        let folder = temporary.join(name);
        let source = Self { folder, temporary: Some(temporary) };
        imported.write(&source.folder).map_err(|error| {
            diagnostics::refuse(&format!("`{}` cannot be written: {error}", source.folder.display()), None)
        })?;
        tell(path, &imported);
        Ok(source)
    }

    #[cfg(not(feature = "formats"))]
    fn import(path: &Path) -> Result<Self, Exit> {
        let message = format!("`{}` is a robot file, and this program was built without their import", path.display());
        Err(diagnostics::refuse(
            &message,
            Some("build it with `--features run,formats`, or import the robot elsewhere"),
        ))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

impl Drop for SceneSource {
    fn drop(&mut self) {
        if let Some(folder) = &self.temporary {
            let _ = std::fs::remove_dir_all(folder);
        }
    }
}

/// By its name.
#[cfg(not(feature = "formats"))]
fn is_robot_file(path: &Path) -> bool {
    path.extension()
        .is_some_and(|kind| ["urdf", "xacro", "xml", "mjcf", "sdf", "world"].iter().any(|known| kind == *known))
}

/// Says in one line that something was lost, if it was.
#[cfg(feature = "formats")]
fn tell(path: &Path, imported: &Imported) {
    let (counts, warnings) = (imported.report.counts, imported.warnings.len());
    if counts.dropped > 0 || warnings > 0 {
        eprintln!(
            "{}: {} elements and attributes are not in the scene, {}; `sincro import` writes the report",
            path.display(),
            counts.dropped,
            diagnostics::count(warnings, "warning")
        );
    }
}

//! Temporary scene folders.

use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use sincro_scene::overrides::Override;
use sincro_sim::{Extensions, Loaded, load};

use crate::serve::OpenSession;

/// A temporary folder of its own for each value, so that tests can run side by side; removed when dropped.
///
/// It dereferences to its path.
#[derive(Debug)]
pub struct SceneFolder {
    path: PathBuf,
}

impl SceneFolder {
    /// Creates an empty folder.
    #[must_use]
    #[expect(clippy::new_without_default, reason = "it creates something on disk")]
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("sincro-test-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        // a process before this one may have had the same number and been killed
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("the temporary folder takes folders");
        Self { path }
    }

    /// Creates a folder with `scene.toml` and `experiment.toml`.
    #[must_use]
    pub fn of(scene: &str, experiment: &str) -> Self {
        Self::new().with("scene.toml", scene).with("experiment.toml", experiment)
    }

    /// Adds a file, as a builder.
    #[must_use]
    pub fn with(self, name: &str, text: &str) -> Self {
        self.write(name, text);
        self
    }

    /// Writes a file, in place of an earlier one of the same name; folders of its name are made.
    pub fn write(&self, name: &str, text: &str) {
        let path = self.path.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    /// Puts `to` in place of the first `from` in a file, which must contain it.
    pub fn change(&self, name: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(self.path.join(name)).unwrap();
        assert!(text.contains(from), "{name} has no {from:?}");
        self.write(name, &text.replacen(from, to, 1));
    }

    /// Loads the scene with settings as `--set` takes them, without scripts.
    ///
    /// # Errors
    ///
    /// The diagnostics as text, without the folder's path.
    pub fn load(&self, settings: &[&str]) -> Result<Loaded, String> {
        let settings: Result<Vec<Override>, _> = settings.iter().map(|text| Override::parse(text)).collect();
        let settings = settings.map_err(|diagnostic| diagnostic.to_string())?;
        load(&self.path, &settings, Extensions::default()).map_err(|diagnostics| self.short(&diagnostics.to_string()))
    }

    /// A message without the folder's path.
    #[must_use]
    pub fn short(&self, message: &str) -> String {
        message.replace(&format!("{}/", self.path.display()), "").replace(&self.path.display().to_string(), "FOLDER")
    }

    /// Opens the folder as a session, which keeps it; `sample_time` is that of the clients `[s]`.
    #[must_use]
    pub fn session(self, extensions: Extensions, sample_time: Option<f64>) -> OpenSession {
        OpenSession::open(self, &[], extensions, sample_time)
    }
}

impl Deref for SceneFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.path
    }
}

impl AsRef<Path> for SceneFolder {
    fn as_ref(&self) -> &Path {
        &self.path
    }
}

impl Drop for SceneFolder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

/// Path of a folder of the repository's `scenes/`.
#[must_use]
pub fn repository_scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

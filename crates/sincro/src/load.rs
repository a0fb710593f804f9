//! Opening a scene folder with every script language that sincro has.

use std::path::Path;
#[cfg(feature = "adapters")]
use std::{path::PathBuf, sync::OnceLock};

#[cfg(feature = "adapters")]
use sincro_fmu::import::isolated::IsolatedLoader;
use sincro_scene::diagnostic::Diagnostics;
#[cfg(feature = "adapters")]
use sincro_scene::fmu::FmuLoader;
use sincro_scene::overrides::Override;
use sincro_scene::scene::{ObjectKind, Scene};
use sincro_sim::{Extensions, Loaded};

/// Opens a scene folder, or the `experiment.toml` in it, with Lua as the language of its scripts.
///
/// `overrides` win over the files; see [`Override::parse`] for their paths. Variants and sweep of the experiment are
/// opened on trial, so that nothing is run before everything is known to be sound.
///
/// # Errors
///
/// All problems of the files and the overrides at once, each with its place in the file.
///
/// ```
/// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
/// let loaded = sincro::load(&scene, &[])?;
/// assert_eq!(loaded.scene.freedom().dofs(), 6);
/// # Ok::<(), sincro::Diagnostics>(())
/// ```
pub fn load(scene: &Path, overrides: &[Override]) -> Result<Loaded, Diagnostics> {
    sincro_sim::load(scene, overrides, extensions())
}

/// Extensions with which [`load`] opens scenes: Lua for scripts, the loader of FMUs, and the linearisation that warns
/// of control loops that are too fast for their step. Without the feature `adapters` there is neither Lua nor the
/// loader, and scenes that need them are refused; without `analysis` nothing warns of fast loops.
#[must_use]
pub fn extensions() -> Extensions {
    #[cfg(feature = "adapters")]
    let (scripts, fmus) = (Some(sincro_lua::engine()), Some(fmu_loader()));
    #[cfg(not(feature = "adapters"))]
    let (scripts, fmus) = (None, None);
    #[cfg(feature = "analysis")]
    let fastest_poles = Some(sincro_analysis::linearize::fastest_poles as _);
    #[cfg(not(feature = "analysis"))]
    let fastest_poles = None;
    Extensions { scripts, fmus, fastest_poles }
}

/// Loader whose FMUs run in processes of their own, if that was asked for.
#[cfg(feature = "adapters")]
static ISOLATED: OnceLock<IsolatedLoader> = OnceLock::new();

/// Lets FMUs of all scenes that are opened from now on run in processes of their own: `program` with `arguments`, which
/// calls [`sincro_fmu::import::isolated::serve`].
#[cfg(feature = "adapters")]
#[cfg_attr(not(feature = "run"), expect(dead_code, reason = "the command line calls it"))]
pub(crate) fn isolate_fmus(program: PathBuf, arguments: Vec<String>) {
    let _ = ISOLATED.set(IsolatedLoader::new(program, arguments));
}

#[cfg(feature = "adapters")]
fn fmu_loader() -> &'static dyn FmuLoader {
    match ISOLATED.get() {
        Some(isolated) => isolated,
        None => sincro_fmu::import::loader(),
    }
}

/// Name of a scene, which results and reports have: that of its folder, or `scene` if that has none. `path` is the
/// folder or a file in it.
#[must_use]
pub fn scene_name(path: &Path) -> String {
    let folder = if path.is_file() { path.parent().unwrap_or(path) } else { path };
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    whole.file_name().map_or_else(|| "scene".into(), |name| name.to_string_lossy().into_owned())
}

/// Finds a camera by its path or the last part of that: its index in the objects of the scene, for
/// [`results::write_camera_frames`](crate::results::write_camera_frames).
///
/// # Errors
///
/// No camera has that name; the error has the paths of all cameras, in the order of the scene.
pub fn camera(scene: &Scene, name: &str) -> Result<usize, Vec<String>> {
    let objects = &scene.objects;
    let is_camera = |k: &usize| matches!(objects[*k].kind, ObjectKind::Camera { .. });
    let cameras: Vec<usize> = (0..objects.len()).filter(is_camera).collect();
    let found = cameras.iter().find(|k| objects[**k].path == name || objects[**k].name == name);
    found.copied().ok_or_else(|| cameras.iter().map(|k| objects[*k].path.clone()).collect())
}

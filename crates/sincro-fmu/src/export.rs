//! Export: a loaded scene as an FMU.
//!
//! The FMU holds `modelDescription.xml`, one prebuilt shared library for each platform, the same for all scenes, and
//! the files of the scene as resources. No compiler is needed.

use std::hash::Hasher;
use std::path::{Component, Path, PathBuf};

use sincro_scene::overrides::Override;
use sincro_sim::Loaded;
use twox_hash::XxHash3_64;

use crate::archive::{ArchiveFile, pack};
use crate::description::{Description, FmiVersion, Kinds, TOOL};
use crate::instance::can_save;
use crate::manifest::{FILE, Manifest};
use crate::names::c_identifier;
use crate::platform::Platform;
use crate::switching;
use crate::variables::{Catalogue, Outputs, Role};

/// Scene to be exported as an FMU, with the choices of the export: the argument of [`export()`].
#[derive(Debug)]
pub struct ExportRequest<'a> {
    /// Loaded scene, whose files go into the FMU as resources.
    pub loaded: &'a Loaded,
    /// Overrides that the scene was loaded with; the FMU applies them again.
    pub overrides: &'a [Override],
    /// Name of the model, usually that of the scene's folder.
    pub name: &'a str,
    /// Version of the FMI standard.
    pub version: FmiVersion,
    /// Interface types that the FMU offers.
    pub kinds: Kinds,
    /// Signals that become outputs.
    pub outputs: Outputs,
    /// Content of the shared libraries of the crate `sincro-fmi`, one for each platform.
    pub libraries: &'a [Vec<u8>],
    /// Files for the folder `documentation` of the FMU, by their paths in it.
    pub documentation: &'a [ArchiveFile],
}

/// Exported FMU, the result of [`export()`]: the file, its variables and its platforms.
#[derive(Debug)]
pub struct Exported {
    /// Content of the `.fmu` file.
    pub bytes: Vec<u8>,
    /// Variables of the FMU, in the order of their value references.
    pub catalogue: Catalogue,
    /// Folders below `binaries`, one for each library of the request, in its order: `linux64`.
    pub platforms: Vec<&'static str>,
}

impl Exported {
    /// Number of parameters, of inputs and of outputs, in this order.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        let count = |is: fn(&Role) -> bool| self.catalogue.variables.iter().filter(|v| is(&v.role)).count();
        [
            count(|role| matches!(role, Role::Fixed(_) | Role::Tunable(..))),
            count(|role| matches!(role, Role::Input(_))),
            count(|role| matches!(role, Role::Output(_))),
        ]
    }
}

/// Packs a loaded scene as an FMU, in memory: model description, shared libraries, documentation, files of the scene.
///
/// # Errors
///
/// Model exchange is asked for and the scene switches (with the reasons), a library is for no platform that FMI names,
/// two are for one platform, a recorded signal does not exist, or a file is too large for the archive.
pub fn export(request: &ExportRequest<'_>) -> Result<Exported, String> {
    let ExportRequest { loaded, overrides, name, version, kinds, outputs, .. } = *request;
    if kinds.model_exchange {
        let reasons = switching::reasons(loaded);
        if !reasons.is_empty() {
            let words = "the scene switches, which model exchange cannot follow";
            return Err(format!("{words}: {}; use --kind cs", reasons.join("; ")));
        }
    }
    let catalogue =
        Catalogue::new(loaded, overrides, outputs, kinds.model_exchange).map_err(|found| found.to_string())?;
    let (folder, files) = scene_files(loaded);
    let identifier = c_identifier(name);
    let settings = overrides.iter().map(|s| (s.path.value.clone(), s.value.value.clone())).collect();
    let mut manifest = Manifest {
        version: env!("CARGO_PKG_VERSION").into(),
        token: String::new(),
        scene: format!("scene/{folder}").trim_end_matches('/').to_owned(),
        settings,
        outputs,
        has_states: kinds.model_exchange,
    };
    manifest.token = token(&manifest, &files, version);
    let experiment = &loaded.experiment;
    let description = Description {
        name,
        identifier: &identifier,
        token: &manifest.token,
        text: &experiment.title,
        kinds,
        catalogue: &catalogue,
        stop_time: experiment.duration,
        step_size: experiment.step * experiment.record_every as f64,
        base_step: experiment.step,
        can_save: can_save(loaded),
    };
    let mut packed: Vec<ArchiveFile> = vec![("modelDescription.xml".into(), description.to_xml(version).into_bytes())];
    let mut platforms = Vec::new();
    for library in request.libraries {
        let platform = Platform::of_library(library).ok_or("a library is not one of a platform that FMI names")?;
        let folder = platform.folder(version);
        if platforms.contains(&folder) {
            return Err(format!("two libraries are for {folder}"));
        }
        platforms.push(folder);
        packed.push((format!("binaries/{folder}/{identifier}.{}", platform.ending()), library.clone()));
    }
    for (name, bytes) in request.documentation {
        packed.push((format!("documentation/{name}"), bytes.clone()));
    }
    packed.push((format!("resources/{FILE}"), manifest.to_json().into_bytes()));
    packed.extend(files.into_iter().map(|(name, bytes)| (format!("resources/scene/{name}"), bytes)));
    Ok(Exported { bytes: pack(&packed)?, catalogue, platforms })
}

/// Files that the scene was read from, and its folder: both relative to the deepest folder that holds all of them.
fn scene_files(loaded: &Loaded) -> (String, Vec<ArchiveFile>) {
    let own = normalized(loaded.folder.path());
    let mut files: Vec<(PathBuf, Vec<u8>)> =
        loaded.folder.files().into_iter().map(|(path, bytes)| (normalized(&path), bytes)).collect();
    files.sort();
    files.dedup_by(|a, b| a.0 == b.0);
    let mut root = own.as_path();
    while !files.iter().all(|(path, _)| path.starts_with(root)) {
        match root.parent() {
            Some(parent) => root = parent,
            None => break,
        }
    }
    let inside = |path: &Path| {
        let parts = path.strip_prefix(root).unwrap_or(path).components();
        parts.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect::<Vec<_>>().join("/")
    };
    (inside(&own), files.iter().map(|(path, bytes)| (inside(path), bytes.clone())).collect())
}

/// An absolute path without `..`.
fn normalized(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut out = PathBuf::new();
    for part in whole.components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

/// Identifier of an FMU in the form of a GUID: a hash of everything that its numbers depend on.
fn token(manifest: &Manifest, files: &[ArchiveFile], version: FmiVersion) -> String {
    let half = |seed: u64| {
        let mut hasher = XxHash3_64::with_seed(seed);
        hasher.write(TOOL.as_bytes());
        hasher.write(format!("{version:?}").as_bytes());
        hasher.write(manifest.to_json().as_bytes());
        for (name, bytes) in files {
            for part in [name.as_bytes(), bytes] {
                hasher.write(&(part.len() as u64).to_le_bytes());
                hasher.write(part);
            }
        }
        hasher.finish()
    };
    let hex = format!("{:016x}{:016x}", half(0), half(1));
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

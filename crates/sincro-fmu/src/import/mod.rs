//! Import: FMUs of other tools.
//!
//! An FMU is foreign code that runs in this process with its rights: open one only where the user names it.
//! [`ForeignFmu::read`] reads it; a [`Slave`], one instance, loads its library from a temporary folder; [`loader`]
//! makes it a block of a diagram, in this process or, by [`isolated`], in others, and [`FmuController`] lets one
//! command a scene in lock-step.

mod block;
mod clocks;
mod controller;
mod description;
mod instance;
pub mod isolated;
mod library;
mod slave;

use std::fmt;
use std::hash::Hasher;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use sincro_scene::fmu::{FmuInterface, FmuLoader, FmuModel};
use twox_hash::XxHash3_64;

use block::Model;
pub use controller::{FmuController, Wiring};
pub use description::{ClockRule, ForeignClock, ForeignDescription, ForeignInterface, ForeignVariable, NumberKind};
pub use slave::Slave;

use crate::archive::{ArchiveFile, unpack, write_files};
use crate::description::FmiVersion;
use crate::platform::Platform;
use library::Functions;

/// FMU of another tool, read and checked; its library is loaded, and its code runs, with the first instance.
pub struct ForeignFmu {
    description: ForeignDescription,
    /// Hash of the archive.
    hash: u64,
    files: Vec<ArchiveFile>,
    /// Libraries of the interfaces, in the order of the description.
    opened: Vec<OnceLock<Result<Functions, String>>>,
    /// Goes last: libraries are unloaded before their files are removed.
    folder: OnceLock<Result<Folder, String>>,
}

/// The same for the same archive, whatever was done with it: hashes of models are made from this text.
impl fmt::Debug for ForeignFmu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ForeignFmu({:?}, {:016x})", self.description.name, self.hash)
    }
}

/// Temporary folder, removed when dropped.
#[derive(Debug)]
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, String> {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        for _ in 0..1_000 {
            let name = format!("sincro-fmu-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
            let path = std::env::temp_dir().join(name);
            // a folder that is there already may be somebody else's
            match std::fs::create_dir(&path) {
                Ok(()) => return Ok(Self(path)),
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(format!("`{}` cannot be made: {error}", path.display())),
            }
        }
        Err("no temporary folder can be made".into())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl ForeignFmu {
    /// Reads the content of an `.fmu` file; none of its code runs.
    ///
    /// # Errors
    ///
    /// The archive is damaged or hostile, the model description cannot be read or is of another version than FMI 2.0
    /// and 3.0, or the FMU has no library for this platform (the text says which it has).
    pub fn read(bytes: &[u8]) -> Result<Arc<Self>, String> {
        let files = unpack(bytes)?;
        let text = files.iter().find(|(name, _)| name == "modelDescription.xml");
        let text = text.ok_or("the archive has no modelDescription.xml")?;
        let text = std::str::from_utf8(&text.1).map_err(|_| "modelDescription.xml is not UTF-8")?;
        let mut description = ForeignDescription::read(text)?;
        if description.interfaces.is_empty() {
            return Err("the FMU has no interface by which it could be simulated".into());
        }
        let platform = Platform::here().ok_or("FMI has no name for this platform")?;
        for interface in &description.interfaces {
            let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
            if interface.library.is_empty() || !interface.library.chars().all(is_plain) {
                return Err(format!("`{}` is no name of a library", interface.library.escape_debug()));
            }
        }
        let version = description.version;
        let has = |library: &str| files.iter().any(|(name, _)| *name == library_path(platform, version, library));
        description.interfaces.retain(|interface| has(&interface.library));
        if description.interfaces.is_empty() {
            return Err(missing_platform(&files, platform.folder(version)));
        }
        let mut hasher = XxHash3_64::with_seed(0);
        hasher.write(bytes);
        let opened = description.interfaces.iter().map(|_| OnceLock::new()).collect();
        Ok(Arc::new(Self { description, hash: hasher.finish(), files, opened, folder: OnceLock::new() }))
    }

    /// The folder into which it is unpacked.
    fn folder(&self) -> Result<&Folder, String> {
        let unpack = || {
            let folder = Folder::new()?;
            write_files(&folder.0, &self.files)?;
            Ok(folder)
        };
        self.folder.get_or_init(unpack).as_ref().map_err(Clone::clone)
    }

    /// Functions of an interface, from its library: code of whoever made it runs from now on.
    fn functions(&self, kind: FmuInterface) -> Result<&Functions, String> {
        let place = self.description.interfaces.iter().position(|interface| interface.kind == kind);
        let place = place.ok_or_else(|| format!("the FMU has no {}", word(kind)))?;
        let load = || {
            let platform = Platform::here().ok_or("FMI has no name for this platform")?;
            let library = &self.description.interfaces[place].library;
            let path = library_path(platform, self.description.version, library);
            Functions::load(&self.folder()?.0.join(path), self.description.version)
        };
        self.opened[place].get_or_init(load).as_ref().map_err(Clone::clone)
    }

    /// Model description of the FMU: its variables with their value references, types and units.
    #[must_use]
    pub fn description(&self) -> &ForeignDescription {
        &self.description
    }

    /// Location of the resources, as the version wants it.
    fn resources(&self) -> Result<String, String> {
        let path = self.folder()?.0.join("resources");
        // the standard does not promise that there are some
        std::fs::create_dir_all(&path).map_err(|error| format!("`{}` cannot be made: {error}", path.display()))?;
        let path = path.display().to_string();
        Ok(match self.description.version {
            FmiVersion::V2 => {
                format!("file://{}{}", if path.starts_with('/') { "" } else { "/" }, path.replace(' ', "%20"))
            }
            FmiVersion::V3 => format!("{path}/"),
        })
    }
}

/// Path of a library in the archive.
fn library_path(platform: Platform, version: FmiVersion, library: &str) -> String {
    format!("binaries/{}/{library}.{}", platform.folder(version), platform.ending())
}

fn missing_platform(files: &[ArchiveFile], wanted: &str) -> String {
    let inner = files.iter().filter_map(|(name, _)| name.strip_prefix("binaries/")?.split_once('/'));
    let mut there: Vec<&str> = inner.map(|(platform, _)| platform).collect();
    there.dedup();
    let there = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
    format!("the FMU has no library for {wanted}; it has: {there}")
}

/// Name of an interface in messages.
fn word(kind: FmuInterface) -> &'static str {
    match kind {
        FmuInterface::CoSimulation => "co-simulation",
        FmuInterface::ModelExchange => "model exchange",
        FmuInterface::ScheduledExecution => "scheduled execution",
    }
}

/// Loader of FMUs for the blocks of diagrams: the field `fmus` of [`sincro_sim::Extensions`], an argument of
/// [`sincro_sim::load()`]. Without it, scenes with such blocks are refused.
#[must_use]
pub fn loader() -> &'static dyn FmuLoader {
    &Loader
}

#[derive(Debug)]
struct Loader;

impl FmuLoader for Loader {
    fn read(&self, bytes: &[u8]) -> Result<Arc<dyn FmuModel>, String> {
        Ok(Arc::new(Model::new(ForeignFmu::read(bytes)?)))
    }
}

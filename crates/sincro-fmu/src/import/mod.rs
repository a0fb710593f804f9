//! Import: FMUs of other tools, for co-simulation.
//!
//! An FMU is foreign code that runs in this process with its rights: open one only where the user names it.
//! [`ForeignFmu::open`] unpacks it into a temporary folder and loads its library; a [`Slave`] is one instance of it;
//! [`FmuController`] lets one command a scene in lock-step.

mod controller;
mod description;
mod library;
mod slave;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

pub use controller::{FmuController, Wiring};
pub use description::{ForeignDescription, ForeignVariable};
pub use slave::Slave;

use crate::archive::{unpack, write_files};
use crate::description::FmiVersion;
use crate::platform::Platform;
use library::Functions;

/// An FMU that was opened.
#[derive(Debug)]
pub struct ForeignFmu {
    description: ForeignDescription,
    functions: Functions,
    /// Goes last: the library is unloaded before its file is removed.
    folder: Folder,
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
    /// Unpacks an FMU and loads its library, which runs code of whoever made it.
    ///
    /// # Errors
    ///
    /// The archive is damaged or hostile, the model description cannot be read, there is no co-simulation or no library
    /// for this platform, or the library lacks a function.
    pub fn open(bytes: &[u8]) -> Result<Arc<Self>, String> {
        let files = unpack(bytes)?;
        let text = files.iter().find(|(name, _)| name == "modelDescription.xml");
        let text = text.ok_or("the archive has no modelDescription.xml")?;
        let text = std::str::from_utf8(&text.1).map_err(|_| "modelDescription.xml is not UTF-8")?;
        let description = ForeignDescription::read(text)?;
        let identifier =
            description.co_simulation.clone().ok_or("the FMU has no co-simulation, only model exchange")?;
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
        if identifier.is_empty() || !identifier.chars().all(is_plain) {
            return Err(format!("`{}` is no name of a library", identifier.escape_debug()));
        }
        let platform = Platform::here().ok_or("FMI has no name for this platform")?;
        let wanted = platform.folder(description.version);
        let library = format!("binaries/{wanted}/{identifier}.{}", platform.ending());
        if !files.iter().any(|(name, _)| *name == library) {
            let mut there: Vec<&str> = files
                .iter()
                .filter_map(|(name, _)| name.strip_prefix("binaries/")?.split_once('/'))
                .map(|(platform, _)| platform)
                .collect();
            there.dedup();
            let there = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
            return Err(format!("the FMU has no library for {wanted}; it has: {there}"));
        }
        let folder = Folder::new()?;
        write_files(&folder.0, &files)?;
        let functions = Functions::load(&folder.0.join(library), description.version)?;
        Ok(Arc::new(Self { description, functions, folder }))
    }

    /// Its model description.
    #[must_use]
    pub fn description(&self) -> &ForeignDescription {
        &self.description
    }

    /// Location of its resources, as the version wants it.
    fn resources(&self) -> String {
        let path = self.folder.0.join("resources").display().to_string();
        match self.description.version {
            FmiVersion::V2 => {
                format!("file://{}{}", if path.starts_with('/') { "" } else { "/" }, path.replace(' ', "%20"))
            }
            FmiVersion::V3 => format!("{path}/"),
        }
    }
}

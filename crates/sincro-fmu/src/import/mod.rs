//! Import: FMUs of other tools, for co-simulation.
//!
//! An FMU is foreign code that runs in this process with its rights: open one only where the user names it.
//! [`ForeignFmu::read`] reads it; a [`Slave`], one instance, loads its library from a temporary folder; [`loader`]
//! makes it a block of a diagram, and [`FmuController`] lets one command a scene in lock-step.

mod controller;
mod description;
mod library;
mod slave;

use std::fmt;
use std::hash::Hasher;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use sincro_scene::fmu::{FmuInstance, FmuLoader, FmuModel};
use twox_hash::XxHash3_64;

pub use controller::{FmuController, Wiring};
pub use description::{ForeignDescription, ForeignVariable, NumberKind};
pub use slave::Slave;

use crate::archive::{ArchiveFile, unpack, write_files};
use crate::description::FmiVersion;
use crate::platform::Platform;
use library::Functions;

/// FMU of another tool for co-simulation, read and checked; its library is loaded, and its code runs, with the first
/// [`Slave`].
pub struct ForeignFmu {
    description: ForeignDescription,
    /// Hash of the archive.
    hash: u64,
    files: Vec<ArchiveFile>,
    /// Path of its library in the archive.
    library: String,
    opened: OnceLock<Result<Opened, String>>,
}

/// The same for the same archive, whatever was done with it: hashes of models are made from this text.
impl fmt::Debug for ForeignFmu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ForeignFmu({:?}, {:016x})", self.description.name, self.hash)
    }
}

/// An unpacked FMU with its library.
#[derive(Debug)]
struct Opened {
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
    /// Reads the content of an `.fmu` file; none of its code runs.
    ///
    /// # Errors
    ///
    /// The archive is damaged or hostile, the model description cannot be read or is of another version than FMI 2.0
    /// and 3.0, the FMU has no co-simulation, or no library for this platform (the text says which it has).
    pub fn read(bytes: &[u8]) -> Result<Arc<Self>, String> {
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
        let mut hasher = XxHash3_64::with_seed(0);
        hasher.write(bytes);
        Ok(Arc::new(Self { description, hash: hasher.finish(), files, library, opened: OnceLock::new() }))
    }

    /// Its library, unpacked and loaded: code of whoever made it runs from now on.
    fn opened(&self) -> Result<&Opened, String> {
        let open = || {
            let folder = Folder::new()?;
            write_files(&folder.0, &self.files)?;
            let functions = Functions::load(&folder.0.join(&self.library), self.description.version)?;
            Ok(Opened { functions, folder })
        };
        self.opened.get_or_init(open).as_ref().map_err(Clone::clone)
    }

    /// Model description of the FMU: its variables with their value references, types and units.
    #[must_use]
    pub fn description(&self) -> &ForeignDescription {
        &self.description
    }
}

impl Opened {
    /// Location of the resources, as the version wants it.
    fn resources(&self, version: FmiVersion) -> String {
        let path = self.folder.0.join("resources").display().to_string();
        match version {
            FmiVersion::V2 => {
                format!("file://{}{}", if path.starts_with('/') { "" } else { "/" }, path.replace(' ', "%20"))
            }
            FmiVersion::V3 => format!("{path}/"),
        }
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
        Ok(Arc::new(Model(ForeignFmu::read(bytes)?)))
    }
}

/// An FMU as a block knows it: by its numbers.
#[derive(Debug)]
struct Model(Arc<ForeignFmu>);

impl Model {
    fn numbers(&self) -> impl Iterator<Item = (&ForeignVariable, NumberKind)> {
        self.0.description.variables.iter().filter_map(|variable| Some((variable, variable.number()?)))
    }
}

impl FmuModel for Model {
    fn name(&self) -> &str {
        &self.0.description.name
    }

    fn variables(&self) -> Vec<(&str, &str, Option<&str>)> {
        self.numbers().map(|(v, _)| (&*v.name, &*v.causality, v.unit.as_deref())).collect()
    }

    fn has_feedthrough(&self) -> bool {
        self.0.description.has_feedthrough
    }

    fn instantiate(&self, t: f64, parameters: &[(usize, f64)]) -> Result<Box<dyn FmuInstance>, String> {
        let variables: Vec<(NumberKind, u32)> = self.numbers().map(|(v, kind)| (kind, v.reference)).collect();
        let mut slave = Slave::new(&self.0, &self.0.description.name)?;
        let given = |(k, value): &(usize, f64)| (variables[*k].0, variables[*k].1, *value);
        slave.start(t, &parameters.iter().map(given).collect::<Vec<_>>())?;
        Ok(Box::new(Instance { slave, variables }))
    }
}

#[derive(Debug)]
struct Instance {
    slave: Slave,
    /// Types and value references of the numbers.
    variables: Vec<(NumberKind, u32)>,
}

impl Instance {
    /// Value references, if all are of the type Float64: they go in one call.
    fn references(&self, places: &[usize]) -> Option<Vec<u32>> {
        let real = |k: &usize| matches!(self.variables[*k].0, NumberKind::Float64).then_some(self.variables[*k].1);
        places.iter().map(real).collect()
    }
}

impl FmuInstance for Instance {
    fn set(&mut self, places: &[usize], values: &[f64]) -> Result<(), String> {
        if let Some(references) = self.references(places) {
            return self.slave.set(&references, values);
        }
        for (k, value) in places.iter().zip(values) {
            let (kind, reference) = self.variables[*k];
            self.slave.set_number(kind, reference, *value)?;
        }
        Ok(())
    }

    fn get(&mut self, places: &[usize], values: &mut [f64]) -> Result<(), String> {
        if let Some(references) = self.references(places) {
            return self.slave.get(&references, values);
        }
        for (k, value) in places.iter().zip(values) {
            let (kind, reference) = self.variables[*k];
            *value = self.slave.get_number(kind, reference)?;
        }
        Ok(())
    }

    fn step(&mut self, t: f64, h: f64) -> Result<(), String> {
        if self.slave.step(t, h)? { Ok(()) } else { Err("it ended the simulation".into()) }
    }
}

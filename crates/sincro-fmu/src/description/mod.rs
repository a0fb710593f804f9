//! Model descriptions: `modelDescription.xml` of FMI 2.0 and 3.0 from the variables of a scene.

mod fmi2;
mod fmi3;
mod variables;
mod xml;

use crate::variables::Catalogue;

/// Version of the FMI standard that an FMU is written or read in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0.
    #[default]
    V2,
    /// FMI 3.0.
    V3,
}

/// Interface types of the FMI standard that an exported FMU offers; at least one is expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinds {
    /// True for co-simulation: the FMU integrates itself, with the methods of the scene.
    pub co_simulation: bool,
    /// True for model exchange: the importer integrates; not for scenes that switch ([`crate::switching`]).
    pub model_exchange: bool,
}

/// Everything that a model description says.
#[derive(Debug)]
pub(crate) struct Description<'a> {
    pub name: &'a str,
    /// Name of the shared library.
    pub identifier: &'a str,
    pub token: &'a str,
    pub text: &'a str,
    pub kinds: Kinds,
    pub catalogue: &'a Catalogue,
    pub stop_time: f64,
    /// Communication step that is proposed `[s]`.
    pub step_size: f64,
    /// Base step `[s]`.
    pub base_step: f64,
    pub can_save: bool,
}

impl Description<'_> {
    /// The text of the file.
    pub(crate) fn to_xml(&self, version: FmiVersion) -> String {
        match version {
            FmiVersion::V2 => fmi2::write(self),
            FmiVersion::V3 => fmi3::write(self),
        }
    }
}

/// Name and version of this program.
pub(crate) const TOOL: &str = concat!("sincro ", env!("CARGO_PKG_VERSION"));

//! File in the resources of an exported FMU: where its scene is, and how it was exported.

use std::path::Path;

use serde::{Deserialize, Serialize};
use sincro_scene::overrides::Override;

use crate::variables::Outputs;

/// Name of the file in the folder of resources.
pub(crate) const FILE: &str = "sincro.json";

/// Choices of the export, which the shared library must know to have the same variables.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Manifest {
    /// Version of sincro that exported the FMU.
    pub version: String,
    /// Globally unique identifier, or instantiation token.
    pub token: String,
    /// Folder of the scene, relative to that of the resources.
    pub scene: String,
    /// Settings as they stand after `--set`.
    pub settings: Vec<(String, String)>,
    /// Signals that are outputs.
    pub outputs: Outputs,
    /// True if there are continuous states among the variables: the FMU has model exchange.
    pub has_states: bool,
}

impl Manifest {
    /// Reads the file in a folder of resources.
    ///
    /// # Errors
    ///
    /// There is none, or it is damaged.
    pub(crate) fn read(resources: &Path) -> Result<Self, String> {
        let path = resources.join(FILE);
        let text = std::fs::read_to_string(&path).map_err(|error| {
            format!("`{}` cannot be read: {error}; the resources of the FMU are incomplete", path.display())
        })?;
        serde_json::from_str(&text).map_err(|error| format!("`{}` is damaged: {error}", path.display()))
    }

    /// The settings that the scene is loaded with.
    #[must_use]
    pub(crate) fn overrides(&self) -> Vec<Override> {
        self.settings.iter().map(|(path, value)| Override::new(path, value)).collect()
    }

    pub(crate) fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a manifest is plain text")
    }
}

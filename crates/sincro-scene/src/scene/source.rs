//! File that a scene was compiled from, for [`crate::draft`].

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::{Map, Value};

use crate::document::Document;
use crate::folder::Folder;

/// Scene file with everything in it written out, and what else a scene is compiled from.
#[derive(Clone, Debug)]
pub struct SceneSource {
    /// Tables of the file: includes, instances, defaults and settings are written out.
    pub document: Document,
    /// Folder that files in it are relative to.
    pub folder: Arc<Folder>,
    /// Seed of the turbulence.
    pub seed: u64,
    /// Frames that were joints, by the numbers of their objects, with the keys that they had as joints.
    pub parked: BTreeMap<usize, Map<String, Value>>,
}

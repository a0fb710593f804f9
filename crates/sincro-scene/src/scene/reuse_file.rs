//! Reuse in scene files as it is written: instances of other files, repeated objects, defaults. It is written out
//! before the rest is read.

use std::collections::BTreeMap;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

/// Another scene file below a frame of its own: `/NAME` is the frame, `/NAME/…` are the objects of the file.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]})))]
#[allow(dead_code)] // written out before
pub(crate) struct InstanceFile {
    /// Scene file, its path relative to the folder.
    pub file: String,
    /// Name of the frame; default that of the file. Copies, and instances of one name, get an index, counted from 1.
    pub name: Option<String>,
    /// Path of the body, joint or frame that carries it; `/` is the world.
    #[serde(default = "super::file::world")]
    pub parent: String,
    /// Origin of its frame in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw of the frame in its parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of the frame in its parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Values of the file's `parameters`; formulas may use `i`, `ix`, `iy`, `iz`, the numbers of the copy, from 0.
    #[serde(default)]
    pub parameters: BTreeMap<String, InstanceParameterFile>,
    /// Copies of it.
    pub repeat: Option<RepeatFile>,
}

/// Number or formula, evaluated for each copy.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
#[allow(dead_code)] // written out before
pub(crate) enum InstanceParameterFile {
    /// A number.
    Number(f64),
    /// A formula of the parameters, `i`, `ix`, `iy` and `iz`.
    Formula(String),
}

/// Copies along a line, or in a grid.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[allow(dead_code)] // written out before
pub(crate) struct RepeatFile {
    /// Number of copies along the line, or along x, y and z.
    pub count: CountFile,
    /// From one to the next: of a line the whole vector, of a grid along each axis [m].
    pub step: [f64; 3],
}

/// Number of copies.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
#[allow(dead_code)] // written out before
pub(crate) enum CountFile {
    /// Along a line.
    Line(u64),
    /// Along x, y and z.
    Grid([u64; 3]),
}

/// Keys of all objects of a kind that do not give them. Of two defaults for one object the later one wins.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[allow(dead_code)] // written out before
pub(crate) struct DefaultFile {
    /// List of the objects: `joint`, `body`, `rotor` ….
    pub of: DefaultOfFile,
    /// Paths of the objects, with `*` for a part of one name and `**` for anything; default all.
    pub group: Option<String>,
    /// The keys, as they stand in the objects.
    pub keys: BTreeMap<String, serde_json::Value>,
}

/// Lists of objects.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum DefaultOfFile {
    /// Joints.
    Joint,
    /// Bodies.
    Body,
    /// Frames.
    Frame,
    /// Forces.
    Force,
    /// Rotors.
    Rotor,
    /// Drag elements.
    Drag,
    /// Sensors.
    Sensor,
    /// Cameras.
    Camera,
}

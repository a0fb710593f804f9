//! The objects of a scene file by their paths, before anything else is known of them.

use serde_json::Value;

use crate::document::Document;

/// Keys of the lists of a scene file that hold objects, in the order in which they are read.
pub const KINDS: [&str; 13] = [
    "joint",
    "body",
    "frame",
    "force",
    "rotor",
    "drag",
    "sensor",
    "camera",
    "closure",
    "coupling",
    "spring_damper",
    "tendon",
    "bushing",
];

/// Keys of the lists whose elements join objects: their path is `/` and the name, wherever they stand.
pub(crate) const JOINING: [&str; 5] = ["closure", "coupling", "spring_damper", "tendon", "bushing"];

/// Object of a scene file by path and place, before it is validated; found by [`raw_objects`].
#[derive(Clone, Debug)]
pub struct RawObject {
    /// Path: that of the parent, `/`, and the name.
    pub path: String,
    /// JSON pointer of its table in the document, such as `/joint/0`.
    pub pointer: String,
}

/// Returns every object of a scene file that has a name, in the order of [`KINDS`] and of the lists.
pub fn raw_objects(document: &Document) -> Vec<RawObject> {
    let mut found = Vec::new();
    for kind in KINDS {
        let list = document.root.get(kind).and_then(Value::as_array);
        for (k, object) in list.into_iter().flatten().enumerate() {
            let Some(name) = object.get("name").and_then(Value::as_str) else { continue };
            let parent = object.get("parent").and_then(Value::as_str).unwrap_or("/");
            found.push(RawObject { path: join(parent, name), pointer: format!("/{kind}/{k}") });
        }
    }
    found
}

/// Path of the child `name` of `parent`.
pub(crate) fn join(parent: &str, name: &str) -> String {
    format!("{}/{name}", parent.trim_end_matches('/'))
}

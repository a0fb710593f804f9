//! The objects of a scene file by their paths, before anything else is known of them.

use serde_json::Value;

use crate::document::Document;

/// The lists of a scene file that hold objects.
pub const KINDS: [&str; 11] =
    ["joint", "body", "frame", "force", "rotor", "drag", "sensor", "camera", "closure", "coupling", "spring_damper"];

/// An object as the file has it.
#[derive(Clone, Debug)]
pub struct RawObject {
    /// Parent's path, `/` and name.
    pub path: String,
    /// Its table, such as `/joint/0`.
    pub pointer: String,
}

/// Every object that has a name, in the order of the lists.
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
pub fn join(parent: &str, name: &str) -> String {
    format!("{}/{name}", parent.trim_end_matches('/'))
}

//! Numbers of a scene folder that settings reach: parameters of its FMU.
//!
//! Every number that stands in the scene, in the parameters of the experiment or in a block of the diagram, under the
//! path that `--set` knows it by. Names, numbers that say how many there are, cameras and the structure of the run
//! (duration, steps) are no parameters.

use serde_json::{Map, Value};
use sincro_scene::apply_overrides::{Target, apply_all};
use sincro_scene::diagnostic::{Diagnostics, Located};
use sincro_scene::diagram::diagram_schema;
use sincro_scene::document::{Document, escape};
use sincro_scene::experiment::experiment_schema;
use sincro_scene::folder::Folder;
use sincro_scene::overrides::Override;
use sincro_scene::scene::scene_schema;
use sincro_scene::schema::{alternatives, description, property, units};
use sincro_scene::tree::raw_objects;

/// Longest list whose entries are parameters; longer ones are tables.
const MAX_ENTRIES: usize = 16;

/// A number that a setting reaches.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Number {
    /// Path as for `--set`.
    pub path: String,
    /// Its value in the files, under the settings given.
    pub value: f64,
    /// Unit; empty if none is known.
    pub unit: String,
    /// Description of the key.
    pub description: String,
}

/// All numbers of a folder, in the order of the files.
///
/// # Errors
///
/// The files cannot be read or the settings do not fit: not after the folder was opened with the same settings.
pub(crate) fn numbers(folder: &Folder, overrides: &[Override]) -> Result<Vec<Number>, Diagnostics> {
    let mut list = Vec::new();
    let experiment = prepared(Document::parse(&folder.read("experiment.toml")?)?, Target::Experiment, overrides)?;
    let parameters = experiment.get("/parameters").and_then(Value::as_object);
    for (name, value) in parameters.into_iter().flatten() {
        let at = Place { root: experiment_schema(), schema: None, path: format!("parameters.{name}") };
        walk(value, &at, &mut list);
    }
    let scene = match experiment.located("/scene") {
        Some(name) => folder.read_named(&name)?,
        None => folder.read("scene.toml")?,
    };
    scene_numbers(&prepared(Document::parse(&scene)?, Target::Scene, overrides)?, &mut list);
    if let Some(name) = experiment.located("/diagram") {
        diagram_numbers(folder, &name, overrides, &mut list)?;
    }
    Ok(list)
}

fn prepared(mut document: Document, target: Target, overrides: &[Override]) -> Result<Document, Diagnostics> {
    let found = apply_all(&mut document, target, overrides);
    if found.any_error() { Err(found) } else { Ok(document) }
}

/// Objects of the scene by their paths, then the keys of the scene itself.
fn scene_numbers(scene: &Document, list: &mut Vec<Number>) {
    let root = scene_schema();
    let top = root.as_object().expect("a schema is a table");
    for object in raw_objects(scene) {
        let kind = object.pointer.split('/').nth(1).unwrap_or("");
        if kind == "camera" {
            continue;
        }
        let schema = property(top, kind).and_then(|s| s.get("items"));
        if let Some(value) = scene.get(&object.pointer) {
            walk(value, &Place { root, schema, path: object.path }, list);
        }
    }
    for (key, value) in scene.root.as_object().into_iter().flatten() {
        let is_list_of_tables = value.as_array().is_some_and(|list| list.iter().any(Value::is_object));
        if !is_list_of_tables {
            walk(value, &Place { root, schema: property(top, key), path: key.clone() }, list);
        }
    }
}

/// Parameters of the diagram's blocks.
fn diagram_numbers(
    folder: &Folder,
    name: &Located<String>,
    overrides: &[Override],
    list: &mut Vec<Number>,
) -> Result<(), Diagnostics> {
    let diagram = prepared(Document::parse(&folder.read_named(name)?)?, Target::Diagram, overrides)?;
    let root = diagram_schema();
    for block in diagram.get("/block").and_then(Value::as_array).into_iter().flatten() {
        let (Some(block_name), Some(table)) = (block.get("name").and_then(Value::as_str), block.as_object()) else {
            continue;
        };
        let unit = block.get("unit").and_then(Value::as_str).unwrap_or("");
        for (key, value) in table.iter().filter(|(key, _)| *key != "sample_time") {
            let plain = format!("{block_name}.{key}");
            // a block that is named as a key of another file is reached through `diagram`
            let is_reached = Override::new(&plain, "0").target() == Target::Diagram;
            let path = if is_reached { plain } else { format!("diagram.{plain}") };
            let first = list.len();
            walk(value, &Place { root, schema: None, path }, list);
            // a source gives its numbers in the unit of its output
            let gives = matches!(key.as_str(), "value" | "from" | "to" | "amplitude" | "offset");
            list[first..].iter_mut().filter(|_| gives).for_each(|number| number.unit = unit.to_owned());
        }
    }
    Ok(())
}

/// Place in a document: schema of the value there, if it is known, and its path.
struct Place {
    root: &'static Value,
    schema: Option<&'static Value>,
    path: String,
}

impl Place {
    fn inner(&self, key: &str) -> Self {
        let tables = self.schema.map(|schema| alternatives(self.root, schema)).unwrap_or_default();
        let of_table = || tables.iter().find_map(|table| property(table, key));
        let of_list = || tables.iter().find_map(|table: &&Map<String, Value>| table.get("items"));
        let schema = of_table().or_else(of_list);
        Self { root: self.root, schema, path: format!("{}.{key}", self.path) }
    }
}

fn walk(value: &Value, place: &Place, list: &mut Vec<Number>) {
    match value {
        Value::Number(number) if counts_nothing(place) => {
            let words = place.schema.map_or("", |schema| description(place.root, schema));
            let known = units(words);
            let unit = if let [only] = known[..] { only.trim_matches('`').to_owned() } else { String::new() };
            let (path, value) = (place.path.clone(), number.as_f64().unwrap_or(f64::NAN));
            list.push(Number { path, value, unit, description: words.to_owned() });
        }
        Value::Array(items) if items.len() <= MAX_ENTRIES => {
            items.iter().enumerate().for_each(|(k, item)| walk(item, &place.inner(&k.to_string()), list));
        }
        Value::Object(table) => {
            let names = table.iter().filter(|(key, _)| escape(key) == **key && !key.contains(['.', '[', ']']));
            names.for_each(|(key, value)| walk(value, &place.inner(key), list));
        }
        _ => {}
    }
}

/// Returns true unless the schema says that the number is an integer, such as a number of blades.
fn counts_nothing(place: &Place) -> bool {
    let Some(schema) = place.schema else { return true };
    let kinds = alternatives(place.root, schema);
    kinds.is_empty() || kinds.iter().any(|kind| kind.get("type").and_then(Value::as_str) != Some("integer"))
}

//! Every number that stands in the files of a scene, with the path by which a setting reaches it.
//!
//! What the viewer offers for editing is what `--set` takes: one list, from the documents themselves, so that a key
//! that is added to the format is there without a word here.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::Serialize;
use serde_json::Value;

use crate::load::Loaded;
use sincro_scene::apply_overrides::{Target, apply_all};
use sincro_scene::diagnostic::Location;
use sincro_scene::document::{Document, escape};
use sincro_scene::experiment::experiment_schema;
use sincro_scene::overrides::Override;
use sincro_scene::scene::scene_schema;
use sincro_scene::schema::{alternatives, description, property, units};
use sincro_scene::tree;

/// Number in the files of a scene as the viewer lists and edits it; found by [`properties`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Property {
    /// Path of the object that it belongs to; `/` for the scene itself, `experiment`, or `diagram/BLOCK`.
    pub owner: String,
    /// Path of the setting as after `--set`: `/arm/link.mass`.
    pub path: String,
    /// Path of the key below the owner: `mass`, `inertia.xx`.
    pub key: String,
    /// Value in `unit`.
    pub value: f64,
    /// Unit as text; empty if the file format has none for this key.
    pub unit: String,
    /// Description of the key; may be empty.
    pub about: String,
    /// Location in its file.
    #[serde(skip)]
    pub at: Location,
}

/// Returns all numbers of the files that a scene was loaded from, with the settings `settings` that it was loaded with,
/// in the order of scene, experiment, diagram.
#[must_use]
pub fn properties(loaded: &Loaded, settings: &[Override]) -> Vec<Property> {
    let mut found = Vec::new();
    let parsed = |name: &str, target: Target| {
        let source = loaded.sources.iter().find(|s| s.path.file_name().is_some_and(|file| file == name))?;
        let mut document = Document::parse(source).ok()?;
        let diagnostics = apply_all(&mut document, target, settings);
        (!diagnostics.any_error()).then_some(document)
    };
    let Some(experiment) = parsed("experiment.toml", Target::Experiment) else { return found };
    let file_of = |key: &str| experiment.text(&format!("/{key}")).map(|name| base_name(name).to_owned());
    let scene = file_of("scene").unwrap_or_else(|| "scene.toml".into());
    if let Some(scene) = parsed(&scene, Target::Scene) {
        of_scene(&scene, loaded, &mut found);
    }
    of_experiment(&experiment, &mut found);
    if let Some(diagram) = file_of("diagram").and_then(|name| parsed(&name, Target::Diagram)) {
        of_diagram(&diagram, &mut found);
    }
    found
}

/// Writes settings into the texts of the files and returns those that change, by their paths; comments and order stay.
/// Nothing is written to the disk.
///
/// # Errors
///
/// One message for each setting whose path is no number that stands in a file, or whose value is no number.
pub fn edited(loaded: &Loaded, settings: &[Override]) -> Result<BTreeMap<PathBuf, String>, Vec<String>> {
    let known = properties(loaded, &[]);
    // the last setting of a path wins; keyed by file and place
    let mut edits: BTreeMap<(PathBuf, usize), (&Location, &str)> = BTreeMap::new();
    let mut refused = Vec::new();
    for setting in settings {
        let (path, value) = (setting.path.value.as_str(), setting.value.value.as_str());
        let flat = path.replace('[', ".").replace(']', "");
        let property = known.iter().find(|p| p.path == flat || p.path.strip_prefix("diagram.") == Some(&flat));
        match (property, value.parse::<f64>()) {
            (Some(Property { at, .. }), Ok(_)) => {
                edits.insert((at.source.path.clone(), at.span.start), (at, value));
            }
            (None, _) => refused.push(format!("`{path}` does not stand in a file as a number: write it there by hand")),
            (_, Err(_)) => refused.push(format!("`{path}` takes a number: `{value}` is none")),
        }
    }
    if !refused.is_empty() {
        return Err(refused);
    }
    let mut texts = BTreeMap::new();
    // from the end on, so that places before stay where they are
    for ((path, _), (at, value)) in edits.into_iter().rev() {
        texts.entry(path).or_insert_with(|| at.source.text.clone()).replace_range(at.span.clone(), value);
    }
    Ok(texts)
}

fn base_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// Whole path of an object whose parent may be named by the end of its path.
fn whole_path<'a>(loaded: &'a Loaded, written: &'a str) -> &'a str {
    let objects = &loaded.scene.objects;
    if objects.iter().any(|object| object.path == written) {
        return written;
    }
    let end = format!("/{}", written.trim_start_matches('/'));
    let mut fitting = objects.iter().filter(|object| object.path.ends_with(&end));
    match (fitting.next(), fitting.next()) {
        (Some(object), None) => &object.path,
        _ => written,
    }
}

fn of_scene(document: &Document, loaded: &Loaded, found: &mut Vec<Property>) {
    let schema = scene_schema();
    let mut world = Walk { document, root: schema, owner: "/", prefix: "", second_unit: false, found };
    for key in ["gravity", "air_density"] {
        if let Some(value) = document.root.get(key) {
            world.value(value, property_of(schema, schema, key), key, &format!("/{key}"));
        }
    }
    for object in tree::raw_objects(document) {
        let list = object.pointer.split('/').nth(1).unwrap_or("");
        let (Some(Value::Object(table)), items) = (document.get(&object.pointer), &schema["properties"][list]["items"])
        else {
            continue;
        };
        let owner = whole_path(loaded, &object.path);
        let prefix = format!("{owner}.");
        let is_prismatic = table.get("kind").and_then(Value::as_str) == Some("prismatic");
        let mut walk = Walk { document, root: schema, owner, prefix: &prefix, second_unit: is_prismatic, found };
        for (key, value) in table {
            walk.value(value, property_of(schema, items, key), key, &format!("{}/{}", object.pointer, escape(key)));
        }
    }
}

fn of_experiment(document: &Document, found: &mut Vec<Property>) {
    let schema = experiment_schema();
    let mut walk = Walk { document, root: schema, owner: "experiment", prefix: "", second_unit: false, found };
    for key in ["duration", "step", "accuracy", "parameters"] {
        if let Some(value) = document.root.get(key) {
            walk.value(value, property_of(schema, schema, key), key, &format!("/{key}"));
        }
    }
}

fn of_diagram(document: &Document, found: &mut Vec<Property>) {
    let blocks = document.root.get("block").and_then(Value::as_array);
    for (k, block) in blocks.into_iter().flatten().enumerate() {
        let (Some(name), Value::Object(table)) = (block.get("name").and_then(Value::as_str), block) else { continue };
        let (owner, prefix) = (format!("diagram/{name}"), format!("diagram.{name}."));
        let mut walk = Walk { document, root: &Value::Null, owner: &owner, prefix: &prefix, second_unit: false, found };
        for (key, value) in table {
            walk.value(value, None, key, &format!("/block/{k}/{}", escape(key)));
        }
    }
}

/// The schema of a key, whichever of the alternatives knows it.
fn property_of<'s>(root: &'s Value, schema: &'s Value, key: &str) -> Option<&'s Value> {
    alternatives(root, schema).into_iter().find_map(|table| property(table, key))
}

/// A walk through the values of one owner.
struct Walk<'a> {
    document: &'a Document,
    root: &'a Value,
    owner: &'a str,
    /// Prefix of the key in a path.
    prefix: &'a str,
    /// True if the second of two units applies: that of prismatic joints.
    second_unit: bool,
    found: &'a mut Vec<Property>,
}

impl Walk<'_> {
    fn value(&mut self, value: &Value, schema: Option<&Value>, key: &str, pointer: &str) {
        match value {
            Value::Number(number) => self.number(number.as_f64().unwrap_or(f64::NAN), schema, key, pointer),
            Value::Array(list) => {
                for (k, entry) in list.iter().enumerate() {
                    // the description of a list says what its entries are
                    let inner = schema.and_then(|s| {
                        let choices = alternatives(self.root, s).into_iter();
                        choices.filter_map(|choice| choice.get("items")).find(|items| items.get("$ref").is_some())
                    });
                    self.value(entry, inner.or(schema), &format!("{key}.{k}"), &format!("{pointer}/{k}"));
                }
            }
            Value::Object(table) => {
                for (name, entry) in table {
                    let inner = schema.and_then(|s| property_of(self.root, s, name));
                    self.value(entry, inner, &format!("{key}.{name}"), &format!("{pointer}/{}", escape(name)));
                }
            }
            _ => {}
        }
    }

    fn number(&mut self, value: f64, schema: Option<&Value>, key: &str, pointer: &str) {
        let about = schema.map_or("", |schema| description(self.root, schema));
        let units = units(about);
        let unit = units.get(usize::from(self.second_unit)).or(units.first()).copied().unwrap_or("");
        self.found.push(Property {
            owner: self.owner.to_owned(),
            path: format!("{}{key}", self.prefix),
            key: key.to_owned(),
            value,
            unit: unit.to_owned(),
            about: about.to_owned(),
            at: self.document.at(pointer),
        });
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{Extensions, load, load_without_variants};

    #[test]
    fn every_number_on_offer_can_be_set() {
        for scene in ["quadrotor-open-loop", "two-dof-position", "flexible-open-loop"] {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(scene);
            let all = properties(&load(&folder, &[], Extensions::default()).unwrap(), &[]);
            assert!(all.len() > 10, "{scene}: {}", all.len());
            for one in &all {
                let same = Override::new(&one.path, &one.value.to_string());
                let loaded = load_without_variants(&folder, std::slice::from_ref(&same), Extensions::default())
                    .unwrap_or_else(|p| panic!("{}: {p}", one.path));
                let again = properties(&loaded, &[same]);
                let numbers = |list: &[Property]| list.iter().map(|p| (p.path.clone(), p.value)).collect::<Vec<_>>();
                assert_eq!(numbers(&again), numbers(&all), "{}", one.path);
            }
        }
    }

    #[test]
    fn numbers_belong_to_their_objects_where_parents_have_short_names() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/newcomer/cart-two-pendulums");
        let all = properties(&load(&folder, &[], Extensions::default()).unwrap(), &[]);
        let mass = all.iter().find(|p| p.path == "/rail/cart/long/long_rod.mass").unwrap();
        assert_eq!((mass.owner.as_str(), mass.value), ("/rail/cart/long/long_rod", 0.3));
    }

    #[test]
    fn units_are_those_of_the_format() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/quadrotor-open-loop");
        let all = properties(&load(&folder, &[], Extensions::default()).unwrap(), &[]);
        let unit = |path: &str| all.iter().find(|p| p.path == path).map(|p| p.unit.as_str());
        assert_eq!(unit("/air/quadrotor.mass"), Some("kg"));
        assert_eq!(unit("/air/quadrotor.inertia.xx"), Some("kg·m²"));
        assert_eq!(unit("/air/quadrotor/rotor1.blade.radius"), Some("m"));
        assert_eq!(unit("gravity.2"), Some("m/s²"));
        assert_eq!(unit("step"), Some("s"));
    }

    #[test]
    fn saving_changes_the_numbers_and_nothing_else() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/quadrotor-open-loop");
        let loaded = load(&folder, &[], Extensions::default()).unwrap();
        let set = [Override::new("/air/quadrotor.mass", "12.5"), Override::new("gravity[2]", "-1.62")];
        let texts = edited(&loaded, &set).unwrap();
        let (path, text) = texts.iter().next().unwrap();
        assert!(texts.len() == 1 && path.ends_with("scene.toml"));
        let before = std::fs::read_to_string(folder.join("scene.toml")).unwrap();
        assert_eq!(*text, before.replace("mass = 10.305 ", "mass = 12.5 ").replace("-9.81]", "-1.62]"));
        assert!(text.contains("# [kg] [T]"), "comments stay");
        assert_eq!(edited(&loaded, &[Override::new("scene", "constant.toml")]).unwrap_err().len(), 1);
    }
}

//! The numbers of a scene folder: every number of scene, diagram and parameters that a setting reaches, with its path
//! and its place in the files.
//!
//! They are what a sensitivity study or a mutation test changes. Left out: names, texts, whole numbers that are sizes,
//! sample times, the method of the run (`step`, `duration`, `accuracy` …), checks and plots, cameras, colours, and
//! shapes that are shown only.

use std::sync::Arc;

use serde_json::Value as Json;
use sincro_blocks::kind::{Parameter, ValueKind};
use sincro_blocks::library;

use crate::diagnostic::{Diagnostics, Location};
use crate::diagram::{DiagramFile, robot};
use crate::document::{Document, escape};
use crate::folder::Folder;
use crate::open::read_documents;
use crate::overrides::Override;
use crate::tree::{KINDS, raw_objects};

/// Number in the files of a scene that a setting can change, for sensitivity studies and mutation tests; found by
/// [`numbers`].
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Path of the number, as for `--set`.
    pub path: String,
    /// Value as it stands in the file, in the unit of its key.
    pub value: Value,
    /// Location of the value; for the default of a block that of the block.
    pub at: Location,
}

/// Value of a [`Quantity`] as it is written.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Plain number.
    Number(f64),
    /// Formula of the parameters, in a diagram.
    Formula(String),
}

impl Quantity {
    /// Returns the setting that multiplies the number by `factor` (dimensionless).
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Override {
        let value = match &self.value {
            Value::Number(x) => format!("{:?}", x * factor),
            Value::Formula(text) => format!("\"({text})*{factor:?}\""),
        };
        Override::new(&self.path, &value)
    }
}

/// Keys of a scene file that are no quantities of the scene.
const NO_QUANTITIES: [&str; 6] = ["format", "parameters", "instance", "default", "include", "script"];

/// Returns all numbers of a scene folder with the settings `overrides` applied, in the order of scene, diagram,
/// parameters. Sizes, sample times, settings of the method, checks, plots and cameras are left out.
///
/// # Errors
///
/// All findings about the files and the settings, each at its place.
pub fn numbers(folder: &Arc<Folder>, overrides: &[Override]) -> Result<Vec<Quantity>, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let documents = read_documents(folder, overrides, &mut diagnostics)?;
    if diagnostics.any_error() {
        return Err(diagnostics.sorted());
    }
    let mut found = Vec::new();
    if let Some(scene) = &documents.scene {
        of_scene(scene, &mut found);
    }
    if let Some(diagram) = &documents.diagram {
        of_diagram(diagram, &mut found);
    }
    leaves(&documents.experiment, "/parameters", "parameters", &mut found);
    Ok(found)
}

fn of_scene(document: &Document, found: &mut Vec<Quantity>) {
    let is_camera = |pointer: &str| pointer.starts_with("/camera/");
    for object in raw_objects(document).into_iter().filter(|object| !is_camera(&object.pointer)) {
        let Some(table) = document.get(&object.pointer).and_then(Json::as_object) else { continue };
        let is_shown_only = table.contains_key("inertia") && !table.contains_key("contact");
        for key in table.keys().filter(|key| *key != "visual" && !(is_shown_only && *key == "shape")) {
            leaves(document, &format!("{}/{}", object.pointer, escape(key)), &format!("{}.{key}", object.path), found);
        }
    }
    let of_file = document.root.as_object().into_iter().flatten().map(|(key, _)| key.as_str());
    for key in of_file.filter(|key| !KINDS.contains(key) && !NO_QUANTITIES.contains(key)) {
        leaves(document, &format!("/{}", escape(key)), key, found);
    }
}

/// Every number at and below a pointer.
fn leaves(document: &Document, pointer: &str, path: &str, found: &mut Vec<Quantity>) {
    match document.get(pointer) {
        Some(Json::Number(x)) => {
            let value = Value::Number(x.as_f64().unwrap_or(f64::NAN));
            found.push(Quantity { path: path.to_owned(), value, at: document.at(pointer) });
        }
        Some(Json::Array(list)) => {
            for k in 0..list.len() {
                leaves(document, &format!("{pointer}/{k}"), &format!("{path}.{k}"), found);
            }
        }
        Some(Json::Object(table)) => {
            for key in table.keys().filter(|key| *key != "color") {
                leaves(document, &format!("{pointer}/{}", escape(key)), &format!("{path}.{key}"), found);
            }
        }
        _ => {}
    }
}

/// Deepest nesting of diagrams that is looked into; deeper ones are refused when the scene is opened.
const MAX_DEPTH: usize = 256;

fn of_diagram(document: &Document, found: &mut Vec<Quantity>) {
    let Ok(file) = serde_json::from_value::<DiagramFile>(document.root.clone()) else { return };
    blocks(document, &file, ("", ""), 0, found);
    leaves(document, "/parameters", "diagram.parameters", found);
    formulas(document, "/parameters", "diagram.parameters", found);
}

/// Parameters of the blocks of the table at `pointer`, whose blocks have the path `prefix` before their names.
fn blocks(
    document: &Document,
    file: &DiagramFile,
    (pointer, prefix): (&str, &str),
    depth: usize,
    found: &mut Vec<Quantity>,
) {
    let list = document.get(&format!("{pointer}/block")).and_then(Json::as_array).map_or(0, Vec::len);
    for k in 0..list {
        let at = format!("{pointer}/block/{k}");
        let word = |key: &str| document.get(&format!("{at}/{key}")).and_then(Json::as_str).unwrap_or("").to_owned();
        let (name, kind) = (word("name"), word("type"));
        // a key of the experiment may have the block's name
        let path = if prefix.is_empty() { format!("diagram.{name}") } else { format!("{prefix}/{name}") };
        match file.diagram.iter().position(|definition| definition.name == kind) {
            Some(d) if depth < MAX_DEPTH => {
                for key in file.diagram[d].parameters.keys() {
                    let given = format!("{at}/{}", escape(key));
                    let default = format!("/diagram/{d}/parameters/{}", escape(key));
                    let pointer = if document.get(&given).is_some() { given } else { default };
                    leaves(document, &pointer, &format!("{path}.{key}"), found);
                    formulas(document, &pointer, &format!("{path}.{key}"), found);
                }
                blocks(document, file, (&format!("/diagram/{d}"), &path), depth + 1, found);
            }
            _ => {
                for parameter in parameters_of_kind(&kind).iter().filter(|p| takes_quantities(p)) {
                    let pointer = format!("{at}/{}", parameter.name);
                    leaves(document, &pointer, &format!("{path}.{}", parameter.name), found);
                    formulas(document, &pointer, &format!("{path}.{}", parameter.name), found);
                }
            }
        }
    }
}

fn parameters_of_kind(kind: &str) -> &'static [Parameter] {
    let of_library = library::find(kind).map(|item| item.kind.parameters);
    of_library.or_else(|| robot::find(kind).map(|item| item.kind.parameters)).unwrap_or(&[])
}

/// Sizes and places are whole numbers, and no quantities.
fn takes_quantities(parameter: &Parameter) -> bool {
    // `set` has paths for keys, which no setting reaches
    let is_size = matches!(parameter.name, "indices" | "sizes" | "widths" | "set");
    let takes = parameter.takes;
    !is_size
        && matches!(
            takes,
            ValueKind::Number | ValueKind::Positive | ValueKind::Numbers | ValueKind::Matrix | ValueKind::Names
        )
}

/// Every formula with a number in it, at and below a pointer.
fn formulas(document: &Document, pointer: &str, path: &str, found: &mut Vec<Quantity>) {
    match document.get(pointer) {
        Some(Json::String(text)) if has_number(text) => {
            let value = Value::Formula(text.clone());
            found.push(Quantity { path: path.to_owned(), value, at: document.at(pointer) });
        }
        Some(Json::Array(list)) => {
            for k in 0..list.len() {
                formulas(document, &format!("{pointer}/{k}"), &format!("{path}.{k}"), found);
            }
        }
        Some(Json::Object(table)) => {
            for key in table.keys() {
                formulas(document, &format!("{pointer}/{}", escape(key)), &format!("{path}.{key}"), found);
            }
        }
        _ => {}
    }
}

/// Returns true if a text has a digit that is not part of a name.
fn has_number(text: &str) -> bool {
    let mut before = ' ';
    text.chars().any(|c| {
        let begins = c.is_ascii_digit() && !before.is_alphanumeric() && before != '_';
        before = c;
        begins
    })
}

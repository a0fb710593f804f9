//! Warnings of what nothing uses: blocks whose output goes nowhere, and sensors and frames that are measured by nobody
//! (a frame with a visual is seen).
//!
//! A thing is used if its name stands as a word in any text of scene, experiment or diagram, so that a warning is never
//! about something that is named. Scripts and clients find objects by other ways: scenes with scripts, with a
//! `simulation_step`, or without a diagram, which clients may control, are not looked at.

use serde_json::Value;
use sincro_blocks::kind::Category;
use sincro_blocks::library;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::scene::{ObjectKind, Scene};
use crate::words::Words;

/// Warns of sensors, and of frames without children, that no text of the files names.
pub(crate) fn warn_of_objects(scene: &Scene, documents: [&Document; 3]) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    let words = Words::of(documents);
    if !scene.scripts.is_empty() || words.has_pattern {
        return diagnostics;
    }
    for (k, object) in scene.objects.iter().enumerate() {
        let (word, help) = match &object.kind {
            ObjectKind::Frame
                if object.visuals.is_empty() && scene.objects.iter().all(|child| child.parent != Some(k)) =>
            {
                ("frame", "record `.position` or another signal of it, or leave it out")
            }
            ObjectKind::Sensor => ("sensor", "record its signals, or wire them into the diagram"),
            _ => continue,
        };
        if !words.words.contains(&object.name) {
            let message = format!("nothing uses the {word} `{}`", object.path);
            diagnostics.push(Diagnostic::error(&object.location, message).as_warning().with_help(help));
        }
    }
    diagnostics
}

/// Warns of blocks of a diagram whose output no wire takes and `experiment` does not name.
pub(crate) fn warn_of_blocks(diagram: &Document, experiment: &Document) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    let named = Words::of([experiment]);
    if named.has_pattern {
        return diagnostics;
    }
    let n_inner = diagram.get("/diagram").and_then(Value::as_array).map_or(0, Vec::len);
    for place in std::iter::once(String::new()).chain((0..n_inner).map(|k| format!("/diagram/{k}"))) {
        let wires = diagram.get(&format!("{place}/wires")).and_then(Value::as_array);
        let mut taken = Words::default();
        for wire in wires.into_iter().flatten().filter_map(Value::as_str) {
            // the last end of a chain takes, all others give
            taken.text(wire.rsplit_once("->").map_or("", |(sources, _)| sources));
        }
        let n_blocks = diagram.get(&format!("{place}/block")).and_then(Value::as_array).map_or(0, Vec::len);
        for k in 0..n_blocks {
            let pointer = format!("{place}/block/{k}");
            let text = |key: &str| diagram.text(&format!("{pointer}/{key}")).unwrap_or("");
            let (name, kind) = (text("name"), text("type"));
            // blocks of other kinds are diagrams, scripts or FMUs, which may do more than give an output
            let gives = library::find(kind).is_some_and(|item| item.kind.category != Category::Sinks);
            if gives && !taken.words.contains(name) && !named.words.contains(name) {
                let message = format!("nothing uses the output of block `{name}`");
                let diagnostic = Diagnostic::error(&diagram.at(&format!("{pointer}/name")), message).as_warning();
                diagnostics.push(diagnostic.with_help("wire it to a block or a motor, record it, or leave it out"));
            }
        }
    }
    diagnostics
}

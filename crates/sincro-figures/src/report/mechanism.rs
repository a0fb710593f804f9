//! Section of a report about the mechanism: labelled sketch, equations of the scene and of motion, tables of joints
//! and bodies.

use super::shell::{cell, table};
use super::{BodyRow, JointRow, Mechanism, derivation};
use crate::plot::{escape, escape_raised};

/// Rows of a table; more are counted.
const MAX_ROWS: usize = 40;

/// The content of the section.
pub(super) fn html(mechanism: &Mechanism) -> String {
    let sketch = match mechanism.sketch.is_empty() {
        true => String::new(),
        false => format!("<div class=\"mechanism\">{}</div>\n", mechanism.sketch),
    };
    let sizes: String = mechanism
        .sizes
        .iter()
        .map(|(name, text)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(text)))
        .collect();
    format!(
        "{sketch}{}{}{}{}{}<p class=\"equation\">{}</p>\n<dl class=\"settings\">\n{sizes}</dl>\n",
        derivation::html(&mechanism.derivation),
        table("fold", &JOINT_COLUMNS, &rows(&mechanism.joints, joint)),
        more(mechanism.joints.len(), "joints"),
        table("fold", &BODY_COLUMNS, &rows(&mechanism.bodies, body)),
        more(mechanism.bodies.len(), "bodies"),
        escape(&mechanism.equation),
    )
}

fn rows<T>(all: &[T], row: fn(&T) -> String) -> Vec<String> {
    all.iter().take(MAX_ROWS).map(row).collect()
}

fn code(text: &str) -> String {
    format!("<code>{}</code>", escape(text))
}

fn more(n: usize, what: &str) -> String {
    if n > MAX_ROWS { format!("<p class=\"key\">and {} more {what}</p>\n", n - MAX_ROWS) } else { String::new() }
}

const JOINT_COLUMNS: [(&str, &str); 7] = [
    ("", "Joint"),
    ("", "Kind"),
    ("", "Carried by"),
    ("", "Axis"),
    ("", "Coordinates"),
    ("", "At the start [m, rad]"),
    ("", "Actuation"),
];

fn joint(row: &JointRow) -> String {
    [
        cell("Joint", "name", &code(&row.path)),
        cell("Kind", "", &escape(&row.kind)),
        cell("Carried by", "", &code(&row.parent)),
        cell("Axis", "", &escape_raised(&row.axes)),
        cell("Coordinates", "unit", &escape(&row.coordinates)),
        cell("At the start [m, rad]", "", &escape_raised(&row.start)),
        cell("Actuation", "", &escape_raised(&row.actuation)),
    ]
    .concat()
}

const BODY_COLUMNS: [(&str, &str); 5] =
    [("", "Body"), ("", "Carried by"), ("num", "Mass [kg]"), ("", "Centre of mass [m]"), ("", "Ixx, Iyy, Izz [kg·m²]")];

fn body(row: &BodyRow) -> String {
    [
        cell("Body", "name", &code(&row.path)),
        cell("Carried by", "", &code(&row.parent)),
        cell("Mass [kg]", "num", &escape_raised(&row.mass)),
        cell("Centre of mass [m]", "", &escape_raised(&row.center)),
        cell("Ixx, Iyy, Izz [kg·m²]", "", &escape_raised(&row.inertia)),
    ]
    .concat()
}

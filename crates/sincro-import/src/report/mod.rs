//! The import report: the fate of every element, the comparison before and after, repairs and choices.

mod html;

use serde::Serialize;
use sincro_scene::diagnostic::{Diagnostic, Location};

use crate::Repair;
use crate::source::{ElementStatus, Entry};

/// Report of an import: status of every element, comparison of the robot with the scene. Written as
/// `import-report.json` and `import-report.html`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of sincro that made the import.
    pub sincro: &'static str,
    /// Path of the file that was imported.
    pub source: String,
    /// Format of the source: `URDF`, `SDF` or `MJCF`.
    pub format: &'static str,
    /// Name of the robot in the source.
    pub robot: String,
    /// Numbers of elements and attributes by their status.
    pub counts: Counts,
    /// Quantities of the whole robot before and after: mass, degrees of freedom, reach.
    pub comparison: Vec<Comparison>,
    /// Mass properties before and after, link by link, in the order of the source.
    pub links: Vec<LinkComparison>,
    /// Repairs that were asked for and made.
    pub repairs: Vec<RepairMade>,
    /// Choices that were made where the source leaves something open, one sentence each.
    pub choices: Vec<String>,
    /// Warnings in the order of the source.
    pub warnings: Vec<Warning>,
    /// Collision meshes that are missing in the scene, each with the reason.
    pub missing_collision_meshes: Vec<String>,
    /// Every element, and every attribute that is not read, with its status, in the order of the source.
    pub elements: Vec<Entry>,
}

/// Numbers of elements and attributes of the source by their [`ElementStatus`].
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Counts {
    /// Number of those in the scene as they stand in the source.
    pub kept: usize,
    /// Number of those in the scene in another form.
    pub changed: usize,
    /// Number of those not in the scene.
    pub dropped: usize,
}

/// Quantity of the whole robot in the source, and in the scene that was written and read again.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the quantity: `mass`.
    pub quantity: &'static str,
    /// Unit of both values; empty for numbers.
    pub unit: &'static str,
    /// Value in the source, before any repair.
    pub before: f64,
    /// Value in the scene.
    pub after: f64,
    /// True if both agree to 12 digits.
    pub equal: bool,
}

impl Comparison {
    /// Compares two values.
    pub(crate) fn new(quantity: &'static str, unit: &'static str, before: f64, after: f64) -> Self {
        Self { quantity, unit, before, after, equal: close(before, after) }
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}

/// Mass properties of a link in the source, and of its body in the scene: mass `[kg]`, then the three principal moments
/// of inertia `[kg·m²]`.
#[derive(Clone, Debug, Serialize)]
pub struct LinkComparison {
    /// Name of the link in the source.
    pub link: String,
    /// Line of the link in the source, from 1.
    pub line: usize,
    /// Mass and principal moments in the source, before any repair; none for a link without mass.
    pub before: Option<(f64, [f64; 3])>,
    /// Mass and principal moments in the scene; none if the link has become a frame.
    pub after: Option<(f64, [f64; 3])>,
    /// True if both agree to 12 digits.
    pub equal: bool,
}

impl LinkComparison {
    /// Compares two bodies.
    pub(crate) fn new(
        link: &str,
        at: &Location,
        before: Option<(f64, [f64; 3])>,
        after: Option<(f64, [f64; 3])>,
    ) -> Self {
        let equal = match (&before, &after) {
            (None, None) => true,
            (Some((m, i)), Some((n, j))) => {
                let scale = i.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                close(*m, *n) && i.iter().zip(j).all(|(a, b)| (a - b).abs() <= 1e-12 * scale)
            }
            _ => false,
        };
        Self { link: link.to_owned(), line: at.line_column().0, before, after, equal }
    }
}

/// Repair of mass properties that was asked for and made on one link.
#[derive(Clone, Debug, Serialize)]
pub struct RepairMade {
    /// Name of the repair, as [`Repair::word`] gives it.
    pub repair: &'static str,
    /// Name of the link in the source.
    pub link: String,
    /// Line of the link in the source, from 1.
    pub line: usize,
    /// Values before and after, with their units, in words.
    pub what: String,
}

impl RepairMade {
    /// A repair of a link.
    pub(crate) fn new(repair: Repair, at: &Location, link: &str, what: String) -> Self {
        Self { repair: repair.word(), link: link.to_owned(), line: at.line_column().0, what }
    }
}

/// Warning about the source, which does not keep it from being imported.
#[derive(Clone, Debug, Serialize)]
pub struct Warning {
    /// Line in the source, from 1; none if it concerns the whole.
    pub line: Option<usize>,
    /// Message, in words.
    pub message: String,
    /// Advice on what to change, if there is any.
    pub help: Option<String>,
}

impl From<&Diagnostic> for Warning {
    fn from(diagnostic: &Diagnostic) -> Self {
        Self {
            line: diagnostic.line_column().map(|(line, _)| line),
            message: diagnostic.message.clone(),
            help: diagnostic.help.clone(),
        }
    }
}

impl Counts {
    /// Counts the entries.
    pub(crate) fn of(entries: &[Entry]) -> Self {
        let n = |fate: ElementStatus| entries.iter().filter(|e| e.status == fate).count();
        Self { kept: n(ElementStatus::Kept), changed: n(ElementStatus::Changed), dropped: n(ElementStatus::Dropped) }
    }
}

impl Report {
    /// Report in JSON, the content of `import-report.json`.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Report as one HTML page that needs no other file, the content of `import-report.html`.
    #[must_use]
    pub fn html(&self) -> String {
        html::page(self)
    }

    /// Sentences about the quantities and links that are not equal before and after; empty if source and scene agree.
    #[must_use]
    pub fn differences(&self) -> Vec<String> {
        let totals = self.comparison.iter().filter(|c| !c.equal);
        let totals = totals.map(|c| format!("{}: {} before, {} after {}", c.quantity, c.before, c.after, c.unit));
        let links = self.links.iter().filter(|l| !l.equal).map(|l| format!("mass properties of link `{}`", l.link));
        totals.chain(links).collect()
    }
}

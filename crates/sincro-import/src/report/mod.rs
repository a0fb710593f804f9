//! The import report: the fate of every element, the comparison before and after, repairs and choices.

mod html;

use serde::Serialize;
use sincro_scene::diagnostic::{Diagnostic, Location};

use crate::Repair;
use crate::source::{ElementStatus, Entry};

/// Report of an import: `import-report.json`, and as a page `import-report.html`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of sincro.
    pub sincro: &'static str,
    /// The file that was imported.
    pub source: String,
    /// URDF, SDF or MJCF.
    pub format: &'static str,
    /// Name of the robot.
    pub robot: String,
    /// Numbers of elements and attributes by their fate.
    pub counts: Counts,
    /// Quantities of the whole robot.
    pub comparison: Vec<Comparison>,
    /// Mass properties link by link.
    pub links: Vec<LinkComparison>,
    /// Repairs that were asked for and made.
    pub repairs: Vec<RepairMade>,
    /// Choices that the source leaves open.
    pub choices: Vec<String>,
    /// Warnings in the order of the source.
    pub warnings: Vec<Warning>,
    /// Collision meshes that are missing, with the reason.
    pub missing_collision_meshes: Vec<String>,
    /// Every element, and every attribute that is not read.
    pub elements: Vec<Entry>,
}

/// Numbers of elements and attributes by their fate.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Counts {
    /// As they stand in the source.
    pub kept: usize,
    /// In another form.
    pub changed: usize,
    /// Not in the scene.
    pub dropped: usize,
}

/// A quantity in the source and in the scene that was written and read again.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name.
    pub quantity: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// In the source, before any repair.
    pub before: f64,
    /// In the scene.
    pub after: f64,
    /// True if they agree to 12 digits.
    pub equal: bool,
}

impl Comparison {
    /// Compares two values.
    pub fn new(quantity: &'static str, unit: &'static str, before: f64, after: f64) -> Self {
        Self { quantity, unit, before, after, equal: close(before, after) }
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}

/// Mass `[kg]` and principal moments [kg·m²] of a link, before and after.
#[derive(Clone, Debug, Serialize)]
pub struct LinkComparison {
    /// Name in the source.
    pub link: String,
    /// Line in the source.
    pub line: usize,
    /// In the source; none without mass.
    pub before: Option<(f64, [f64; 3])>,
    /// In the scene; none for a frame.
    pub after: Option<(f64, [f64; 3])>,
    /// True if they agree to 12 digits.
    pub equal: bool,
}

impl LinkComparison {
    /// Compares two bodies.
    pub fn new(link: &str, at: &Location, before: Option<(f64, [f64; 3])>, after: Option<(f64, [f64; 3])>) -> Self {
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

/// A repair that was asked for and made.
#[derive(Clone, Debug, Serialize)]
pub struct RepairMade {
    /// Its name on the command line.
    pub repair: &'static str,
    /// Link.
    pub link: String,
    /// Line in the source.
    pub line: usize,
    /// Values before and after.
    pub what: String,
}

impl RepairMade {
    /// A repair of a link.
    pub(crate) fn new(repair: Repair, at: &Location, link: &str, what: String) -> Self {
        Self { repair: repair.word(), link: link.to_owned(), line: at.line_column().0, what }
    }
}

/// A remark on the source that changes nothing: its place and its words.
#[derive(Clone, Debug, Serialize)]
pub struct Warning {
    /// Line in the source, if it has one.
    pub line: Option<usize>,
    /// Message.
    pub message: String,
    /// Advice.
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
    /// Text of the report in JSON, `import-report.json`.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Text of `import-report.html`: one page that needs no other file.
    #[must_use]
    pub fn html(&self) -> String {
        html::page(self)
    }

    /// Quantities and links that are not equal before and after.
    #[must_use]
    pub fn differences(&self) -> Vec<String> {
        let totals = self.comparison.iter().filter(|c| !c.equal);
        let totals = totals.map(|c| format!("{}: {} before, {} after {}", c.quantity, c.before, c.after, c.unit));
        let links = self.links.iter().filter(|l| !l.equal).map(|l| format!("mass properties of link `{}`", l.link));
        totals.chain(links).collect()
    }
}

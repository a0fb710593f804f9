//! Pages of one run (`report.html`), of two runs (`diff.html`) and of many (the index of `sincro reproduce`).
//!
//! Each is one self-contained file: styles, figures and the replay inline, nothing fetched. Its scripts are the replay
//! and a small one that reads values from the figures and magnifies them; without them the page is whole. It follows
//! the reader's light or dark preference, prints in black and white on A4, and fits a phone.
//! [`Page`] and [`IndexPage`] are plain data; whoever fills them need not know any HTML. All text in them may come from
//! a scene: it is escaped by [`crate::plot::escape`].
//!
//! Verdicts are derived from the checks and findings, so a banner cannot contradict its tables.

mod checks;
mod comparison;
mod index;
mod mechanism;
pub(crate) mod page;
pub mod shell;

use sincro_scene::experiment::check::Sense;

use crate::plot::Figure;
pub use page::figure;

/// The report of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Title of the experiment.
    pub title: String,
    /// One or two sentences under the title.
    pub description: String,
    /// Link back to the index (label, address), if there is one.
    pub up: Option<(String, String)>,
    /// Reason for an early end; `None`: it came to its end.
    pub stop: Option<Stop>,
    /// Warnings that the reader should know before trusting the numbers; shown right under the verdict.
    pub warnings: Vec<String>,
    /// The replay as HTML with its program; may be empty.
    pub replay: String,
    /// The simulated mechanism, if anything moves.
    pub mechanism: Option<Mechanism>,
    /// Figures in order, each over the full width.
    pub figures: Vec<Figure>,
    /// Block diagrams as SVG for a page, each with its title.
    pub diagrams: Vec<(String, String)>,
    /// Findings of the audit.
    pub findings: Vec<FindingRow>,
    /// The table of checks.
    pub checks: Vec<CheckRow>,
    /// The recorded signals with their error bars.
    pub signals: Vec<SignalRow>,
    /// The balance of energy over the run.
    pub energy: Option<Energy>,
    /// Name and value: scene, integrator, step, accuracy, duration, seed, overrides, hashes, versions.
    pub settings: Vec<(String, String)>,
    /// Messages of scripts and clients: time, sender, text.
    pub messages: Vec<(String, String, String)>,
    /// Remarks at the end.
    pub notes: Vec<String>,
}

/// Joints, bodies and equations of motion of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mechanism {
    /// Labelled picture of the scene as SVG; may be empty.
    pub sketch: String,
    /// Structure of the equations of motion: `M(q) v̇ + c(q, v) = τ`.
    pub equation: String,
    /// Symbols of the equation, with size and meaning.
    pub sizes: Vec<(String, String)>,
    /// Joints that move.
    pub joints: Vec<JointRow>,
    /// Bodies.
    pub bodies: Vec<BodyRow>,
}

/// A joint, as text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointRow {
    /// Its path.
    pub path: String,
    /// Kind of motion: `revolute`.
    pub kind: String,
    /// Path of what carries it, or `world`.
    pub parent: String,
    /// Axes in the joint's frame; empty where it has none.
    pub axes: String,
    /// Its coordinates: `q0`.
    pub coordinates: String,
    /// Coordinates at the start, in SI units.
    pub start: String,
    /// Motor and springs; may be empty.
    pub actuation: String,
}

/// A body, as text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyRow {
    /// Its path.
    pub path: String,
    /// Path of what carries it, or `world`.
    pub parent: String,
    /// Mass `[kg]`.
    pub mass: String,
    /// Centre of mass in the frame of the body `[m]`.
    pub center: String,
    /// Moments of inertia Ixx, Iyy, Izz about the centre of mass [kg·m²].
    pub inertia: String,
}

/// A run that ended before its time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stop {
    /// Time of the end `[s]`.
    pub time: f64,
    /// Event and culprit, in words.
    pub reason: String,
    /// Setting that would avoid it; may be empty.
    pub help: String,
    /// True: the experiment asked for this end.
    pub is_good: bool,
}

/// One check, judged. The deviation is given, not derived: for a check over a window it is the worst one.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckRow {
    /// The check's name.
    pub name: String,
    /// Subject of the check: a signal, a formula, the run it belongs to; may be empty.
    pub about: String,
    /// The value measured; at the worst time, if the check covers a window. `None`: there is none to show.
    pub measured: Option<f64>,
    /// The value expected at the same place. `None`: the measured value itself is what must be small.
    pub expected: Option<f64>,
    /// Kind of the expected value: a value to be met, or a bound.
    pub sense: Sense,
    /// |measured − expected|, divided by the expected value if `is_relative`; for a bound the distance beyond it.
    pub deviation: f64,
    /// Largest deviation allowed.
    pub limit: f64,
    /// The deviation and its limit are relative, hence without unit.
    pub is_relative: bool,
    /// Unit of measured and expected.
    pub unit: String,
    /// Time of the measured value `[s]`, if it belongs to one.
    pub at: Option<f64>,
    /// The judgement.
    pub verdict: CheckVerdict,
}

/// Finding of the audit: a law whose residual exceeds its limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FindingRow {
    /// Name of the run; empty for the main run.
    pub run: String,
    /// Name of the law.
    pub law: String,
    /// Element concerned.
    pub element: String,
    /// Time of the value `[s]`.
    pub time: f64,
    /// The value.
    pub value: f64,
    /// Largest value allowed.
    pub limit: f64,
    /// Unit of both; empty for relative residuals.
    pub unit: String,
    /// The setting that would help; may be empty.
    pub help: String,
}

/// The judgement of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckVerdict {
    /// The deviation is within its limit.
    Holds,
    /// It is not.
    Fails,
    /// The run stopped before the check could be made.
    NotMade,
}

/// A recorded signal with its error bar.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalRow {
    /// Its path: `/shoulder.position`.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// Greatest magnitude in the run, for scale.
    pub largest: Option<f64>,
    /// Estimated integration error, in the same unit; `None` if it was not estimated.
    pub error_bar: Option<f64>,
    /// Method of the estimate.
    pub method: String,
}

/// The balance of energy over a run `[J]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Total at the start.
    pub start: f64,
    /// Total at the end.
    pub end: f64,
    /// Work done by motors and applied forces.
    pub work: f64,
    /// Energy taken by dampers and friction.
    pub dissipated: f64,
    /// Greatest |total − total(0) − work + dissipated| during the run.
    pub residual: f64,
}

/// The index of many runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IndexPage {
    /// Title of the whole.
    pub title: String,
    /// One or two sentences under the title.
    pub description: String,
    /// Cards of the experiments, in order.
    pub cards: Vec<Card>,
    /// Versions, machine, total time.
    pub settings: Vec<(String, String)>,
    /// Remarks at the end.
    pub notes: Vec<String>,
}

/// One experiment in the index.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    /// Title of the experiment.
    pub title: String,
    /// Place of the original: `§4.2, figure 4.5`.
    pub source: String,
    /// One sentence.
    pub summary: String,
    /// Address of its report, relative to the index.
    pub href: String,
    /// Address of its replay, relative to the index; may be empty.
    pub replay: String,
    /// A picture of the scene as SVG; may be empty.
    pub picture: String,
    /// Its first panel becomes the thumbnail.
    pub figure: Option<Figure>,
    /// All its checks. The card shows four: those that fail first, then in this order.
    pub checks: Vec<CheckRow>,
    /// Number of findings of the audit.
    pub n_findings: usize,
    /// Reason for an early end; `None`: it came to its end.
    pub stop: Option<Stop>,
    /// Wall time in words: `0.02 s`.
    pub run_time: String,
}

/// The comparison of two runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ComparisonPage {
    /// Titles of both runs.
    pub title: String,
    /// Result of the comparison in one sentence.
    pub verdict: String,
    /// Both replays over each other as HTML with their program; may be empty.
    pub replay: String,
    /// One for each signal that both runs have.
    pub signals: Vec<DifferenceRow>,
    /// Settings and versions in which the runs differ: name, both values.
    pub settings: Vec<(String, String)>,
}

/// A signal of two runs.
#[derive(Clone, Debug, PartialEq)]
pub struct DifferenceRow {
    /// Its path: `/shoulder.position`.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// First time at which the bits differ `[s]`; `None`: they are the same everywhere.
    pub first: Option<f64>,
    /// Greatest difference, in the unit of the signal.
    pub greatest: f64,
    /// Time of the greatest difference `[s]`.
    pub greatest_at: f64,
}

/// The page of one run as HTML.
#[must_use]
pub fn html(page: &Page) -> String {
    page::html(page)
}

/// The index of many runs as HTML.
#[must_use]
pub fn index_html(page: &IndexPage) -> String {
    index::html(page)
}

/// The comparison of two runs as HTML.
#[must_use]
pub fn comparison_html(page: &ComparisonPage) -> String {
    comparison::html(page)
}

#[cfg(test)]
mod tests;

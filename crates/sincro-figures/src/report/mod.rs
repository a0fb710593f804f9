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
pub mod derivation;
mod index;
mod mechanism;
pub(crate) mod page;
pub mod shell;

use sincro_scene::experiment::check::Sense;

use crate::plot::Figure;
pub use page::figure;

/// Content of the report page of one run, as plain data; [`html`] makes the page of it.
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
    /// Findings of the audit; empty if there are none.
    pub findings: Vec<FindingRow>,
    /// Checks of the run, in the order of the experiment.
    pub checks: Vec<CheckRow>,
    /// Recorded signals with their error bars, in the order of recording.
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

/// Joints, bodies and equations of motion of a scene, a section of the report [`Page`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mechanism {
    /// Labelled picture of the scene as SVG; may be empty.
    pub sketch: String,
    /// Equations of the scene in the words of its README, Markdown ([`derivation::section_of`]); may be empty.
    pub derivation: String,
    /// Structure of the equations of motion: `M(q) v̇ + c(q, v) = τ`.
    pub equation: String,
    /// Symbols of the equation, each with its size and meaning as one text.
    pub sizes: Vec<(String, String)>,
    /// Joints that move, in the order of the scene.
    pub joints: Vec<JointRow>,
    /// Bodies, in the order of the scene.
    pub bodies: Vec<BodyRow>,
}

/// Joint of a [`Mechanism`] as a row of its table; all cells are text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointRow {
    /// Path in the scene: `/arm/hinge`.
    pub path: String,
    /// Joint type: `revolute`.
    pub kind: String,
    /// Path of the object that carries it, or `world`.
    pub parent: String,
    /// Axes in the joint's frame; empty where it has none.
    pub axes: String,
    /// Its coordinates: `q0`.
    pub coordinates: String,
    /// Values of the coordinates at the start, with their SI units.
    pub start: String,
    /// Motor and springs with their parameters; may be empty.
    pub actuation: String,
}

/// Body of a [`Mechanism`] as a row of its table; all cells are text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyRow {
    /// Path in the scene: `/arm`.
    pub path: String,
    /// Path of the object that carries it, or `world`.
    pub parent: String,
    /// Mass `[kg]`.
    pub mass: String,
    /// Centre of mass x, y, z in the frame of the body `[m]`.
    pub center: String,
    /// Moments of inertia Ixx, Iyy, Izz about the centre of mass, in the body's axes `[kg·m²]`.
    pub inertia: String,
}

/// End of a run before its duration, shown at the top of the report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stop {
    /// Simulated time of the end `[s]`.
    pub time: f64,
    /// Event and culprit, in words.
    pub reason: String,
    /// Setting that would avoid it; may be empty.
    pub help: String,
    /// True if the experiment asked for this end (a stop condition was met).
    pub is_good: bool,
}

/// Check of a run as a row of the report, judged by the caller. The deviation is given, not derived: for a check over a
/// window it is the worst one.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckRow {
    /// The check's name.
    pub name: String,
    /// Subject of the check: a signal, a formula, the run it belongs to; may be empty.
    pub about: String,
    /// Measured value in `unit`; at the worst time if the check covers a window. `None`: there is none to show.
    pub measured: Option<f64>,
    /// Expected value in `unit` at the same time. `None`: the measured value itself must be small.
    pub expected: Option<f64>,
    /// Kind of the expected value: a value to be met, or a bound.
    pub sense: Sense,
    /// Deviation |measured − expected| in `unit`, divided by the expected value if `is_relative`; for a bound the
    /// distance beyond it.
    pub deviation: f64,
    /// Largest deviation allowed, in the unit of `deviation`.
    pub limit: f64,
    /// True if the deviation and its limit are relative, hence dimensionless.
    pub is_relative: bool,
    /// Unit of the measured and the expected value; may be empty.
    pub unit: String,
    /// Simulated time of the measured value `[s]`; `None`: it belongs to no instant.
    pub at: Option<f64>,
    /// The judgement.
    pub verdict: CheckVerdict,
}

/// Finding of the audit as a row of the report: a law (conservation of energy, contact law …) whose residual exceeds
/// its limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FindingRow {
    /// Name of the run; empty for the main run.
    pub run: String,
    /// Name of the law: `contact-island`.
    pub law: String,
    /// Path of the element concerned: a body, joint or pair of bodies.
    pub element: String,
    /// Simulated time of the residual `[s]`.
    pub time: f64,
    /// Residual of the law, in `unit`.
    pub value: f64,
    /// Largest residual allowed, in `unit`.
    pub limit: f64,
    /// Unit of residual and limit; empty for relative residuals (dimensionless).
    pub unit: String,
    /// The setting that would help; may be empty.
    pub help: String,
}

/// Judgement of a check of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckVerdict {
    /// The deviation is within its limit.
    Holds,
    /// It is not.
    Fails,
    /// The run stopped before the check could be made.
    NotMade,
}

/// Recorded signal with its error bar as a row of the report.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalRow {
    /// Path of the signal: `/shoulder.position`.
    pub path: String,
    /// Unit of the signal; may be empty.
    pub unit: String,
    /// Greatest magnitude in the run, in `unit`; `None`: no value is finite.
    pub largest: Option<f64>,
    /// Estimated integration error (half width of the error bar), in `unit`; `None`: it was not estimated.
    pub error_bar: Option<f64>,
    /// Method of the estimate, in words.
    pub method: String,
}

/// Energy balance over a run, a table of the report; all values in `[J]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Total energy at the start `[J]`.
    pub start: f64,
    /// Total energy at the end `[J]`.
    pub end: f64,
    /// Work done by motors and applied forces over the run `[J]`.
    pub work: f64,
    /// Energy dissipated by dampers and friction over the run `[J]`.
    pub dissipated: f64,
    /// Greatest `|total − total(0) − work + dissipated|` during the run `[J]`.
    pub residual: f64,
}

/// Content of the index page of many runs; [`index_html`] makes the page of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IndexPage {
    /// Title of the whole.
    pub title: String,
    /// One or two sentences under the title.
    pub description: String,
    /// Cards of the experiments, in order.
    pub cards: Vec<Card>,
    /// Name and value of facts about the whole: versions, machine, total time.
    pub settings: Vec<(String, String)>,
    /// Remarks at the end.
    pub notes: Vec<String>,
}

/// Experiment on an [`IndexPage`]; [`crate::campaign::card`] makes one of the results of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    /// Title of the experiment.
    pub title: String,
    /// Heading under which it stands, with others of the same; may be empty.
    pub group: String,
    /// Place of the original: `§4.2, figure 4.5`.
    pub source: String,
    /// Summary in one sentence.
    pub summary: String,
    /// Address of its report, relative to the index.
    pub href: String,
    /// Address of its replay, relative to the index; may be empty.
    pub replay: String,
    /// A picture of the scene as SVG; may be empty.
    pub picture: String,
    /// Figure whose first panel is shown small; `None`: no figure.
    pub figure: Option<Figure>,
    /// All its checks. The card shows four: those that fail first, then in this order.
    pub checks: Vec<CheckRow>,
    /// Number of findings of the audit.
    pub n_findings: usize,
    /// Reason for an early end; `None`: it came to its end.
    pub stop: Option<Stop>,
    /// Wall time of the run with its unit: `0.02 s`.
    pub run_time: String,
}

/// Content of the page that compares two runs; [`comparison_html`] makes the page of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ComparisonPage {
    /// Titles of both runs.
    pub title: String,
    /// Result of the comparison in one sentence.
    pub verdict: String,
    /// Both replays over each other as HTML with their program; may be empty.
    pub replay: String,
    /// Signals that both runs have, in the order of the first.
    pub signals: Vec<DifferenceRow>,
    /// Settings and versions in which the runs differ: the name, and both values as one text.
    pub settings: Vec<(String, String)>,
}

/// Difference of one signal between two runs, a row of the [`ComparisonPage`].
#[derive(Clone, Debug, PartialEq)]
pub struct DifferenceRow {
    /// Path of the signal: `/shoulder.position`.
    pub path: String,
    /// Unit of the signal; may be empty.
    pub unit: String,
    /// First time at which the bits differ `[s]`; `None`: they are the same everywhere.
    pub first: Option<f64>,
    /// Greatest difference, in the unit of the signal.
    pub greatest: f64,
    /// Time of the greatest difference `[s]`.
    pub greatest_at: f64,
}

/// Report page of one run as one HTML text that needs no other file.
#[must_use]
pub fn html(page: &Page) -> String {
    page::html(page)
}

/// Index page of many runs as one HTML text, with links to their reports.
#[must_use]
pub fn index_html(page: &IndexPage) -> String {
    index::html(page)
}

/// Page of the comparison of two runs as one HTML text that needs no other file.
#[must_use]
pub fn comparison_html(page: &ComparisonPage) -> String {
    comparison::html(page)
}

#[cfg(test)]
mod tests;

//! The pages of sincro: `report.html` of one run, and the index of `sincro reproduce`.
//!
//! Each is one self-contained file: styles, figures and the replay inline, nothing fetched; only the replay is a script. It follows the reader's light or
//! dark preference, prints in black and white on A4, and fits a phone. [`Page`] and [`IndexPage`] are plain data; whoever
//! fills them need not know any HTML. All text in them may come from a scene: it is escaped by [`crate::plot::escape`].
//!
//! Verdicts are derived from the checks, so a banner cannot contradict its table.

mod checks;
mod index;
pub(crate) mod page;
pub(crate) mod shell;

use sincro_scene::experiment::check::Sense;

use crate::plot::Figure;

/// The report of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Page {
    /// Title of the experiment.
    pub(crate) title: String,
    /// One or two sentences under the title.
    pub(crate) description: String,
    /// Link back to the index (label, address), if there is one.
    pub(crate) up: Option<(String, String)>,
    /// Why the run ended early, if it did.
    pub(crate) stop: Option<Stop>,
    /// What the reader should know before trusting the numbers; shown right under the verdict.
    pub(crate) warnings: Vec<String>,
    /// The replay as HTML with its program; may be empty.
    pub(crate) replay: String,
    /// Drawn in order, each over the full width.
    pub(crate) figures: Vec<Figure>,
    /// Block diagrams as SVG for a page, each with its title.
    pub(crate) diagrams: Vec<(String, String)>,
    /// The table of checks.
    pub(crate) checks: Vec<CheckRow>,
    /// The recorded signals with their error bars.
    pub(crate) signals: Vec<SignalRow>,
    /// The balance of energy over the run.
    pub(crate) energy: Option<Energy>,
    /// Name and value: scene, integrator, step, accuracy, duration, seed, overrides, hashes, versions.
    pub(crate) settings: Vec<(String, String)>,
    /// What scripts and clients said: when, who, what.
    pub(crate) messages: Vec<(String, String, String)>,
    /// Remarks at the end.
    pub(crate) notes: Vec<String>,
}

/// A run that ended before its time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Stop {
    /// When `[s]`.
    pub(crate) time: f64,
    /// What happened, and to whom.
    pub(crate) reason: String,
    /// The setting that mends it; may be empty.
    pub(crate) help: String,
    /// Whether it was to end there.
    pub(crate) is_good: bool,
}

/// One check, judged. The deviation is given, not derived: for a check over a window it is the worst one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CheckRow {
    /// The check's name.
    pub(crate) name: String,
    /// What it looks at: a signal, a formula, the run it belongs to; may be empty.
    pub(crate) about: String,
    /// The value measured; at the worst time, if the check covers a window. `None`: there is none to show.
    pub(crate) measured: Option<f64>,
    /// The value expected at the same place. `None`: the measured value itself is what must be small.
    pub(crate) expected: Option<f64>,
    /// Whether the expected value is a bound.
    pub(crate) sense: Sense,
    /// |measured − expected|, divided by the expected value if `is_relative`; how far beyond a bound.
    pub(crate) deviation: f64,
    /// Largest deviation allowed.
    pub(crate) limit: f64,
    /// The deviation and its limit are relative, hence without unit.
    pub(crate) is_relative: bool,
    /// Unit of measured and expected.
    pub(crate) unit: String,
    /// Time of the measured value `[s]`, if it belongs to one.
    pub(crate) at: Option<f64>,
    /// The judgement.
    pub(crate) verdict: CheckVerdict,
}

/// The judgement of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CheckVerdict {
    /// The deviation is within its limit.
    Holds,
    /// It is not.
    Fails,
    /// The run stopped before the check could be made.
    NotMade,
}

/// A recorded signal and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SignalRow {
    /// Its path: `/shoulder.position`.
    pub(crate) path: String,
    /// Its unit.
    pub(crate) unit: String,
    /// Greatest magnitude in the run, for scale.
    pub(crate) largest: Option<f64>,
    /// Estimated integration error, in the same unit; `None` if it was not estimated.
    pub(crate) error_bar: Option<f64>,
    /// How it was estimated.
    pub(crate) method: String,
}

/// The balance of energy over a run `[J]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Energy {
    /// Total at the start.
    pub(crate) start: f64,
    /// Total at the end.
    pub(crate) end: f64,
    /// Work done by motors and applied forces.
    pub(crate) work: f64,
    /// Energy taken by dampers and friction.
    pub(crate) dissipated: f64,
    /// Greatest |total − total(0) − work + dissipated| during the run.
    pub(crate) residual: f64,
}

/// The gallery of many runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct IndexPage {
    /// Title of the whole.
    pub(crate) title: String,
    /// What was reproduced and from where.
    pub(crate) description: String,
    /// One for each experiment, in order.
    pub(crate) cards: Vec<Card>,
    /// Versions, machine, total time.
    pub(crate) settings: Vec<(String, String)>,
    /// Remarks at the end.
    pub(crate) notes: Vec<String>,
}

/// One experiment in the gallery.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Card {
    /// Title of the experiment.
    pub(crate) title: String,
    /// Where the original stands: `§4.2, figure 4.5`.
    pub(crate) source: String,
    /// One sentence.
    pub(crate) summary: String,
    /// Address of its report, relative to the index.
    pub(crate) href: String,
    /// Address of its replay, relative to the index; may be empty.
    pub(crate) replay: String,
    /// A picture of the scene as SVG; may be empty.
    pub(crate) picture: String,
    /// Its first panel becomes the thumbnail.
    pub(crate) figure: Option<Figure>,
    /// All its checks. The card shows four: those that fail first, then in this order.
    pub(crate) checks: Vec<CheckRow>,
    /// Why the run ended early, if it did.
    pub(crate) stop: Option<Stop>,
    /// How long it took, in words: `0.02 s`.
    pub(crate) run_time: String,
}

/// The page of one run as HTML.
pub(crate) fn html(page: &Page) -> String {
    page::html(page)
}

/// The gallery of many runs as HTML.
pub(crate) fn index_html(page: &IndexPage) -> String {
    index::html(page)
}

#[cfg(test)]
mod tests;

//! Numbers that are kept of a run: measures of signals and formulas, in the words of checks.

use std::sync::Arc;

use sincro_math::expression::Expression;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located, Location};
use sincro_scene::experiment::Experiment;
use sincro_scene::experiment::check::{Check, Expected, Measure, Sense, Subject as CheckSubject};

/// Measure of a campaign: one number that is kept of each run, with the limits of a good run; a `[[measure]]` of the
/// plan.
#[derive(Clone, Debug)]
pub struct MeasurePlan {
    /// Name of its column in the results.
    pub name: String,
    /// Series and the measure that makes one number of it.
    pub source: Source,
    /// Unit as text, for reports; may be empty.
    pub unit: String,
    /// Upper limit of a good run, in the measure's unit, if there is one.
    pub at_most: Option<f64>,
    /// Lower limit of a good run, in the measure's unit, if there is one.
    pub at_least: Option<f64>,
    /// Location in the plan file, for messages.
    pub location: Location,
}

/// Origin of a measure: a series over the time of a run, and the rule by which one number is made of it.
#[derive(Clone, Debug)]
pub struct Source {
    /// Series: a signal or a formula.
    pub subject: Subject,
    /// Rule, such as the maximum or the settling time.
    pub kind: Measure,
    /// Time `[s]` at which the series is read, for a value at one time.
    pub at: Option<f64>,
    /// First and last time `[s]` of the window that is looked at; `None`: the whole run.
    pub window: Option<(f64, f64)>,
    /// Final value of a step response, in the unit of the series; `None`: its last value.
    pub target: Option<f64>,
    /// Half width of the band of the settling time, relative to the step's height (0.02 is 2 %).
    pub band: f64,
}

/// Series that a measure is made of: a recorded signal or a formula of signals.
#[derive(Clone, Debug)]
pub enum Subject {
    /// Recorded signal by its name, such as `/arm.position`.
    Signal(Located<String>),
    /// Formula of aliases of signals, of the time `t` `[s]` and of the parameters of the experiment.
    Formula {
        /// Text of the formula.
        text: Located<String>,
        /// Aliases with the names of their signals.
        signals: Vec<(String, Located<String>)>,
    },
}

impl Subject {
    /// The signals that it needs.
    pub(crate) fn signals(&self) -> Vec<&Located<String>> {
        match self {
            Self::Signal(signal) => vec![signal],
            Self::Formula { signals, .. } => signals.iter().map(|(_, signal)| signal).collect(),
        }
    }
}

/// Measures that make one number of a series.
const MEASURES: [Measure; 13] = [
    Measure::Final,
    Measure::Mean,
    Measure::Min,
    Measure::Max,
    Measure::MaxAbs,
    Measure::Rms,
    Measure::Std,
    Measure::Integral,
    Measure::TimeOfMin,
    Measure::TimeOfMax,
    Measure::Overshoot,
    Measure::RiseTime,
    Measure::SettlingTime,
];

/// The measure of a word.
#[must_use]
pub(crate) fn measure_of_word(word: &str) -> Option<Measure> {
    MEASURES.into_iter().find(|measure| measure.word() == word)
}

/// All words of measures.
#[must_use]
pub(crate) fn words_of_measures() -> Vec<&'static str> {
    MEASURES.iter().map(|measure| measure.word()).collect()
}

impl MeasurePlan {
    /// The measure as a check of an experiment, whose verdict is not used.
    ///
    /// # Errors
    ///
    /// The formula means nothing.
    pub(crate) fn check(&self, experiment: &Experiment) -> Result<Check, Diagnostics> {
        let parameters: Arc<[(String, f64)]> = experiment.parameters.iter().map(|(n, x)| (n.clone(), *x)).collect();
        let (what, aliases) = match &self.source.subject {
            Subject::Signal(signal) => (CheckSubject::Signal(signal.clone()), Vec::new()),
            Subject::Formula { text, signals } => {
                let names: Vec<&str> = signals
                    .iter()
                    .map(|(alias, _)| alias.as_str())
                    .chain(["t"])
                    .chain(parameters.iter().map(|(name, _)| name.as_str()))
                    .collect();
                let formula = Expression::parse(&text.value, &names).map_err(|error| {
                    let problem = Diagnostic::error(&text.at, format!("`{}`: {}", text.value, error.message));
                    Diagnostics::from(match error.help {
                        Some(help) => problem.with_help(help),
                        None => problem,
                    })
                })?;
                (CheckSubject::Formula(formula), signals.clone())
            }
        };
        Ok(Check {
            name: self.name.clone(),
            what,
            aliases,
            unit: None,
            parameters,
            expected: Expected::Value(0.0),
            sense: Sense::Equal,
            measure: self.source.kind,
            target: self.source.target,
            band: self.source.band,
            at: self.source.at,
            window: self.source.window,
            tolerance: 0.0,
            relative: false,
            floor: 0.0,
            location: self.location.clone(),
        })
    }
}

//! Numbers that are kept of a run: measures of signals and formulas, in the words of checks.

use std::sync::Arc;

use sincro_math::expression::Expression;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located, Location};
use sincro_scene::experiment::Experiment;
use sincro_scene::experiment::check::{Check, Expected, Measure, Sense, Subject as CheckSubject};

/// A number that is kept of each run, with the limits that a good run keeps.
#[derive(Clone, Debug)]
pub struct MeasurePlan {
    /// Name of its column.
    pub name: String,
    /// Series and measure.
    pub source: Source,
    /// Unit; may be empty.
    pub unit: String,
    /// A good run is not above.
    pub at_most: Option<f64>,
    /// A good run is not below.
    pub at_least: Option<f64>,
    /// Its place, for messages.
    pub location: Location,
}

/// A series and how one number is made of it.
#[derive(Clone, Debug)]
pub struct Source {
    /// The series.
    pub subject: Subject,
    /// Its measure.
    pub kind: Measure,
    /// The one time `[s]` that is looked at, if given.
    pub at: Option<f64>,
    /// First and last time `[s]` that are looked at.
    pub window: Option<(f64, f64)>,
    /// Final value of a step response.
    pub target: Option<f64>,
    /// Band of the settling time, relative to the step's height.
    pub band: f64,
}

/// A series: a signal or a formula of signals.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A signal by its name.
    Signal(Located<String>),
    /// A formula of aliases of signals, `t` and the parameters of the experiment.
    Formula {
        /// Its text.
        text: Located<String>,
        /// Aliases and their signals.
        signals: Vec<(String, Located<String>)>,
    },
}

impl Subject {
    /// The signals that it needs.
    pub fn signals(&self) -> Vec<&Located<String>> {
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
pub fn measure_of_word(word: &str) -> Option<Measure> {
    MEASURES.into_iter().find(|measure| measure.word() == word)
}

/// All words of measures.
#[must_use]
pub fn words_of_measures() -> Vec<&'static str> {
    MEASURES.iter().map(|measure| measure.word()).collect()
}

impl MeasurePlan {
    /// The measure as a check of an experiment, whose verdict is not used.
    ///
    /// # Errors
    ///
    /// The formula means nothing.
    pub fn check(&self, experiment: &Experiment) -> Result<Check, Diagnostics> {
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

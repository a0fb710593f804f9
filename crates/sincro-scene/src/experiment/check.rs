//! Checks of a run: plain data, read and resolved; `sincro-sim` evaluates them.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sincro_math::expression::Expression;

use crate::diagnostic::{Located, Location};

/// One expectation about a run, or about all runs of a sweep.
///
/// Formulas of a check (its own and that of the expected value) share their names, in this order: the aliases, then
/// `t`, then the parameters. [`Check::values`] fills the slots.
#[derive(Clone, Debug)]
pub struct Check {
    /// Name in the report.
    pub name: String,
    /// Measured series.
    pub what: Subject,
    /// Names of recorded signals in formulas, in the order of the first slots; empty if `what` is a signal.
    pub aliases: Vec<(String, Located<String>)>,
    /// Names and values of the experiment's parameters, in the order of the last slots.
    pub parameters: Arc<[(String, f64)]>,
    /// Expected value.
    pub expected: Expected,
    /// Comparison: equal, at most or at least.
    pub sense: Sense,
    /// Measure of the series that is compared.
    pub measure: Measure,
    /// Final value of the step for `overshoot`, `rise-time` and `settling-time`; that of the last row if not given.
    pub target: Option<f64>,
    /// Half the width of the band of `settling-time` around the target, relative to the step's height.
    pub band: f64,
    /// The one time `[s]` that is looked at, if given; it excludes `window`.
    pub at: Option<f64>,
    /// First and last time `[s]` that are looked at, ends included; all if not given.
    pub window: Option<(f64, f64)>,
    /// Largest |measured − expected| that holds, in the unit of what is measured (or 1, if `relative`); not negative,
    /// and 0 if `sense` is not `Equal`.
    pub tolerance: f64,
    /// True if the difference is divided by max(|expected|, floor).
    pub relative: bool,
    /// Least divisor of a relative difference; zero unless given.
    pub floor: f64,
    /// The check's `name` in the file, for messages.
    pub location: Location,
}

/// Comparison of measured and expected value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sense {
    /// They are equal within the tolerance.
    #[default]
    Equal,
    /// The measured value is not greater.
    AtMost,
    /// The measured value is not less.
    AtLeast,
}

/// Series that a check measures: a recorded signal, or a formula of signals.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A recorded signal by its name.
    Signal(Located<String>),
    /// A formula of the aliases, `t` and the parameters.
    Formula(Expression),
}

/// Expected value of a check: a number, a formula or a reference series.
#[derive(Clone, Debug)]
pub enum Expected {
    /// The same number at all times.
    Value(f64),
    /// A formula of the aliases, `t` and the parameters.
    Formula(Expression),
    /// A column of a CSV file.
    Reference(Reference),
}

/// A column of a CSV file against another: rows of a reference. The file has been read and checked.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The file; the folder of the experiment is part of it.
    pub file: PathBuf,
    /// Name of the column of times `[s]` (in a sweep: of the values of the swept parameter).
    pub key_column: String,
    /// Name of the column of values.
    pub column: String,
    /// Factor on the column's values.
    pub scale: f64,
    /// Added after scaling.
    pub offset: f64,
    /// Times (or parameter values) of the rows, strictly increasing.
    pub keys: Arc<[f64]>,
    /// Values of the rows, `scale` and `offset` already applied.
    pub values: Arc<[f64]>,
    /// The name of the column in the experiment file, for messages.
    pub location: Location,
}

/// Measure of a series that is compared with the expected value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Every row with the expected value of its time; the largest difference counts.
    Error,
    /// The last row.
    Final,
    /// Mean over time (trapezoidal rule).
    Mean,
    /// Least value.
    Min,
    /// Greatest value.
    Max,
    /// Greatest absolute value.
    MaxAbs,
    /// Root of the mean square over time.
    Rms,
    /// Standard deviation over time.
    Std,
    /// Integral over time: Σ x_k·(t_k − t_{k−1}) over the intervals between the rows that are looked at. A row's value
    /// stands for the interval that ends at it, which is exact for mean values of a step such as `motor_torque`.
    Integral,
    /// Time `[s]` of the least value.
    TimeOfMin,
    /// Time `[s]` of the greatest value.
    TimeOfMax,
    /// Overshoot of a step response beyond its target, relative to the step's height. The step leads from the first row
    /// that is looked at to the target.
    Overshoot,
    /// Time `[s]` between the first crossings of 10 % and of 90 % of the step's height.
    RiseTime,
    /// Time `[s]` from the first row to the last instant at which the response enters the band around its target.
    SettlingTime,
    /// The magnitude in the first row in which it is greater than the expected value, or its greatest if it never is.
    Divergence,
}

impl Measure {
    /// The word in the file.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Final => "final",
            Self::Mean => "mean",
            Self::Min => "min",
            Self::Max => "max",
            Self::MaxAbs => "max-abs",
            Self::Rms => "rms",
            Self::Std => "std",
            Self::Integral => "integral",
            Self::TimeOfMin => "time-of-min",
            Self::TimeOfMax => "time-of-max",
            Self::Overshoot => "overshoot",
            Self::RiseTime => "rise-time",
            Self::SettlingTime => "settling-time",
            Self::Divergence => "diverges",
        }
    }

    /// Returns true if it is one of a step response, which has a target.
    #[must_use]
    pub fn is_of_step(self) -> bool {
        matches!(self, Self::Overshoot | Self::RiseTime | Self::SettlingTime)
    }
}

impl Check {
    /// Names of the recorded signals it needs, as they are in the file.
    pub fn signals(&self) -> impl Iterator<Item = &Located<String>> {
        let own = match &self.what {
            Subject::Signal(name) => Some(name),
            Subject::Formula(_) => None,
        };
        own.into_iter().chain(self.aliases.iter().map(|(_, signal)| signal))
    }

    /// The slots of the check's formulas for one row: the aliases' values in their order, the time `[s]`, the
    /// parameters.
    #[must_use]
    pub fn values(&self, aliases: &[f64], t: f64) -> Vec<f64> {
        let parameters = self.parameters.iter().map(|(_, value)| *value);
        aliases.iter().copied().chain([t]).chain(parameters).collect()
    }
}

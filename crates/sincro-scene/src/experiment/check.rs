//! Checks of a run: plain data, read and resolved; `sincro-sim` evaluates them.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sincro_blocks::unit::Unit;
use sincro_math::expression::Expression;

use crate::diagnostic::{Located, Location};

/// Check of a run: one expectation about a recorded signal or a formula, or about all runs of a sweep. Read from
/// `[[check]]` of the experiment; a simulation is judged by it.
///
/// Formulas of a check (its own and that of the expected value) share their arguments, in this order: the aliases, `t`
/// `[s]`, the parameters. [`Check::values`] lists the values of one row in that order.
#[derive(Clone, Debug)]
pub struct Check {
    /// Name in the report.
    pub name: String,
    /// Series that is measured.
    pub what: Subject,
    /// Names in formulas with the recorded signals that they stand for; empty if `what` is a signal.
    pub aliases: Vec<(String, Located<String>)>,
    /// Declared unit of the formula that is measured; `None`: it is deduced.
    pub unit: Option<Unit>,
    /// Names and values of the experiment's parameters.
    pub parameters: Arc<[(String, f64)]>,
    /// Expected value.
    pub expected: Expected,
    /// Comparison of measured and expected value.
    pub sense: Sense,
    /// Rule by which the series becomes the number that is compared.
    pub measure: Measure,
    /// Final value of the step for `overshoot`, `rise-time` and `settling-time`, in the unit of the series; `None`: the
    /// value of the last row.
    pub target: Option<f64>,
    /// Half width of the band of `settling-time` around the target, relative to the step's height (0.02 is 2 %).
    pub band: f64,
    /// Time `[s]` (in a sweep: value of the parameter) of the only row that is looked at; excludes `window`.
    pub at: Option<f64>,
    /// First and last time `[s]` (in a sweep: value of the parameter) that are looked at, ends included; `None`: all.
    pub window: Option<(f64, f64)>,
    /// Largest |measured − expected| that holds, in the unit of the measured value (dimensionless if `relative`); not
    /// negative, and 0 if `sense` is not `Equal`.
    pub tolerance: f64,
    /// True if the difference is divided by max(|expected|, floor).
    pub relative: bool,
    /// Least divisor of a relative difference, in the unit of the measured value; 0 unless given.
    pub floor: f64,
    /// Location of the check's `name` in the file, for messages.
    pub location: Location,
}

/// Comparison of the measured with the expected value of a check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sense {
    /// Equal within the tolerance.
    #[default]
    Equal,
    /// Not greater than expected.
    AtMost,
    /// Not less than expected.
    AtLeast,
}

/// Series that a check measures.
#[derive(Clone, Debug)]
pub enum Subject {
    /// Recorded signal by its name, such as `/shoulder.position`.
    Signal(Located<String>),
    /// Formula of the check's aliases, of `t` `[s]` and of the parameters.
    Formula(Expression),
}

/// Expected value of a check, in the unit of what is measured.
#[derive(Clone, Debug)]
pub enum Expected {
    /// Number that does not change over time.
    Value(f64),
    /// Formula of the check's aliases, of `t` `[s]` and of the parameters, evaluated for each row.
    Formula(Expression),
    /// Reference series from a CSV file, interpolated at the times of the rows.
    Reference(Reference),
}

/// Reference series of a check or plot: a column of a CSV file over a column of times, read and validated when the
/// experiment is opened.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Path of the file, the folder of the experiment included.
    pub file: PathBuf,
    /// Name of the column of times `[s]`; in a sweep, of values of the swept parameter.
    pub key_column: String,
    /// Name of the column of values.
    pub column: String,
    /// Factor that the file's values were multiplied by.
    pub scale: f64,
    /// Number that was added after scaling, in the unit of the checked signal.
    pub offset: f64,
    /// Times `[s]` (or parameter values) of the rows, strictly increasing.
    pub keys: Arc<[f64]>,
    /// Values of the rows, `scale` and `offset` already applied, in the unit of the checked signal; as many as `keys`.
    pub values: Arc<[f64]>,
    /// Location of the column's name in the experiment file, for messages.
    pub location: Location,
}

/// Measure of a series: the rule by which its rows become the number that a check compares. In the unit of the series
/// unless stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Difference of every row from the expected value at its time; the largest counts.
    Error,
    /// Value of the last row.
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
    /// Integral over time, unit of the series times `[s]`: by the trapezoidal rule; of `motor_torque`, the mean over
    /// each step, Σ x_k·(t_k − t_{k−1}), which is exact where every step is recorded.
    Integral,
    /// Time `[s]` of the least value.
    TimeOfMin,
    /// Time `[s]` of the greatest value.
    TimeOfMax,
    /// Overshoot of a step response beyond its target, relative to the step's height (dimensionless). The step leads
    /// from the first row to the target.
    Overshoot,
    /// Time `[s]` between the first crossings of 10 % and of 90 % of the step's height.
    RiseTime,
    /// Time `[s]` from the first row to the last instant at which the response enters the band around its target.
    SettlingTime,
    /// Magnitude in the first row in which it is greater than the expected value, or the greatest magnitude if it never
    /// is.
    Divergence,
}

impl Measure {
    /// Returns the name of the measure in the file, such as `settling-time`.
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
    pub(crate) fn is_of_step(self) -> bool {
        matches!(self, Self::Overshoot | Self::RiseTime | Self::SettlingTime)
    }
}

impl Check {
    /// Returns the names of the recorded signals that the check needs, with their locations in the file.
    pub fn signals(&self) -> impl Iterator<Item = &Located<String>> {
        let own = match &self.what {
            Subject::Signal(name) => Some(name),
            Subject::Formula(_) => None,
        };
        own.into_iter().chain(self.aliases.iter().map(|(_, signal)| signal))
    }

    /// Returns the arguments of the check's formulas for one row: `aliases`, the values of the aliased signals in the
    /// order of [`Check::aliases`], then the time `t` `[s]`, then the parameters.
    #[must_use]
    pub fn values(&self, aliases: &[f64], t: f64) -> Vec<f64> {
        let parameters = self.parameters.iter().map(|(_, value)| *value);
        aliases.iter().copied().chain([t]).chain(parameters).collect()
    }
}

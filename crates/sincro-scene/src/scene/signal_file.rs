//! Signals as they are written, and what the builder makes of them.

#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};
use sincro_dynamics::signal::Signal;

use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::document::Document;
use crate::folder::Folder;
use crate::series;

/// A number that depends on time: a number, or a table with one kind of signal.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum SignalFile {
    /// The same at all times.
    Number(f64),
    /// One kind of signal.
    Kind(Box<SignalKindFile>),
}

/// Only defaults are ever written, into the schema; they are numbers.
impl Serialize for SignalFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(x) => serializer.serialize_f64(*x),
            Self::Kind(_) => serializer.serialize_unit(),
        }
    }
}

/// Exactly one kind of signal.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [
    {"required": ["constant"]}, {"required": ["step"]}, {"required": ["ramp"]}, {"required": ["sine"]},
    {"required": ["pulse"]}, {"required": ["table"]}
])))]
pub(crate) struct SignalKindFile {
    /// The same at all times.
    pub constant: Option<f64>,
    /// A jump.
    pub step: Option<StepFile>,
    /// A straight rise.
    pub ramp: Option<RampFile>,
    /// offset + amplitude·sin(ω·t + phase).
    pub sine: Option<SineFile>,
    /// A train of pulses.
    pub pulse: Option<PulseFile>,
    /// Given points, constant before the first and after the last.
    pub table: Option<TableFile>,
}

/// A jump.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct StepFile {
    /// Instant of the jump [s].
    #[serde(default)]
    pub time: f64,
    /// Value before it.
    #[serde(default)]
    pub from: f64,
    /// Value from `time` on.
    pub to: f64,
}

/// A straight rise.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct RampFile {
    /// Where it begins [s].
    #[serde(default)]
    pub start: f64,
    /// Rise a second.
    pub slope: f64,
    /// Value until `start`.
    #[serde(default)]
    pub from: f64,
    /// Where it ends, constant from then on; never if left out or inf [s].
    #[cfg_attr(test, schemars(extend("x-infinite" = true)))]
    pub until: Option<f64>,
}

/// offset + amplitude·sin(ω·t + phase).
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["angular_frequency"]}, {"required": ["frequency_hz"]}])))]
pub(crate) struct SineFile {
    /// Peak value.
    pub amplitude: f64,
    /// ω [rad/s].
    pub angular_frequency: Option<f64>,
    /// ω/2π [Hz].
    pub frequency_hz: Option<f64>,
    /// A cosine has 1.5707963267948966 [rad].
    #[serde(default)]
    pub phase: f64,
    /// Mean value.
    #[serde(default)]
    pub offset: f64,
}

/// A train of pulses.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct PulseFile {
    /// From one rising edge to the next [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub period: f64,
    /// Length of a pulse [s].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub width: f64,
    /// Value between pulses.
    #[serde(default)]
    pub low: f64,
    /// Value of a pulse.
    #[serde(default = "one")]
    pub high: f64,
    /// First rising edge [s].
    #[serde(default)]
    pub start: f64,
}

/// Points in a CSV file, or given here.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["file"]}, {"required": ["times"]}])))]
pub(crate) struct TableFile {
    /// CSV file, its path relative to the folder.
    pub file: Option<String>,
    /// Column of times in the file; default `t`.
    pub time: Option<String>,
    /// Column of values in the file.
    pub column: Option<String>,
    /// Increasing times, in place of a file [s].
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub times: Option<Vec<f64>>,
    /// Values at these times.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub values: Option<Vec<f64>>,
    /// What is between the points.
    #[serde(default)]
    pub interpolation: InterpolationFile,
}

/// What is between points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum InterpolationFile {
    /// Straight lines.
    #[default]
    Linear,
    /// The value of the point before.
    Hold,
}

fn one() -> f64 {
    1.0
}

/// Reader of a signal at a location, for its diagnostics.
pub(crate) struct SignalReader<'a> {
    pub document: &'a Document,
    pub folder: &'a Folder,
    pub diagnostics: &'a mut Diagnostics,
}

impl SignalReader<'_> {
    /// The signal at `pointer`; a problem is noted and zero returned if it makes no sense.
    pub fn read(&mut self, file: &SignalFile, pointer: &str) -> Signal {
        let kind = match file {
            SignalFile::Number(x) => return Signal::Constant(*x),
            SignalFile::Kind(kind) => kind,
        };
        match &**kind {
            SignalKindFile { step: Some(s), .. } => Signal::Step { time: s.time, from: s.from, to: s.to },
            SignalKindFile { ramp: Some(ramp), .. } => self.ramp(ramp, pointer),
            SignalKindFile { sine: Some(sine), .. } => sine.signal(),
            SignalKindFile { pulse: Some(pulse), .. } => self.pulse(pulse, pointer),
            SignalKindFile { table: Some(table), .. } => self.table(table, &format!("{pointer}/table")),
            SignalKindFile { constant, .. } => Signal::Constant(constant.unwrap_or(0.0)),
        }
    }

    fn ramp(&mut self, ramp: &RampFile, pointer: &str) -> Signal {
        let until = ramp.until.unwrap_or(f64::INFINITY);
        if until < ramp.start {
            let at = self.document.at(&format!("{pointer}/ramp/until"));
            let message = format!("the ramp ends at {until} s, before it starts at {} s", ramp.start);
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("`until` is a time after `start`"));
        }
        Signal::Ramp { start: ramp.start, slope: ramp.slope, from: ramp.from, until }
    }

    fn pulse(&mut self, pulse: &PulseFile, pointer: &str) -> Signal {
        let &PulseFile { period, width, low, high, start } = pulse;
        if width > period {
            let at = self.document.at(&format!("{pointer}/pulse/width"));
            let message = format!("pulses of {width} s do not fit in a period of {period} s");
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("`width` is at most `period`"));
        }
        Signal::Pulse { period, width, low, high, start }
    }

    fn table(&mut self, table: &TableFile, pointer: &str) -> Signal {
        let linear = table.interpolation == InterpolationFile::Linear;
        let points =
            if table.file.is_some() { self.points_of_file(table, pointer) } else { self.points(table, pointer) };
        match points {
            Some((times, values)) => Signal::Table { times: times.into(), values: values.into(), linear },
            None => Signal::Constant(0.0),
        }
    }

    fn points_of_file(&mut self, table: &TableFile, pointer: &str) -> Option<(Vec<f64>, Vec<f64>)> {
        self.refuse(pointer, &["values"], "the points are in the file");
        let located = |key: &str, value: &String| Located {
            value: value.clone(),
            at: self.document.at(&format!("{pointer}/{key}")),
        };
        let Some(column) = table.column.as_ref().map(|value| located("column", value)) else {
            let at = self.document.at(pointer);
            let diagnostic = Diagnostic::error(&at, "`column` is missing in `table`");
            self.diagnostics.push(diagnostic.with_help("`column` names the column of values in the file"));
            return None;
        };
        let file = located("file", table.file.as_ref()?);
        let key = located("time", table.time.as_ref().unwrap_or(&"t".to_owned()));
        let query = series::Query { file: &file, key: &key, column: &column };
        series::read(self.folder, &query, self.diagnostics).map(|columns| (*columns).clone().into())
    }

    fn points(&mut self, table: &TableFile, pointer: &str) -> Option<(Vec<f64>, Vec<f64>)> {
        self.refuse(pointer, &["time", "column"], "they name columns of a `file`");
        let times = table.times.clone().unwrap_or_default();
        let Some(values) = table.values.clone() else {
            let at = self.document.at(pointer);
            let diagnostic = Diagnostic::error(&at, "`values` is missing in `table`");
            self.diagnostics.push(diagnostic.with_help("give one value for each of `times`"));
            return None;
        };
        if values.len() != times.len() {
            let at = self.document.at(&format!("{pointer}/values"));
            let message = format!("{} values for {} times", values.len(), times.len());
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("give one value for each of `times`"));
            return None;
        }
        if let Some(k) = (1..times.len()).find(|&k| times[k] <= times[k - 1]) {
            let at = self.document.at(&format!("{pointer}/times/{k}"));
            let message = format!("time {} s does not come after {} s", times[k], times[k - 1]);
            self.diagnostics.push(Diagnostic::error(&at, message).with_help("times increase"));
            return None;
        }
        Some((times, values))
    }

    fn refuse(&mut self, pointer: &str, keys: &[&str], why: &str) {
        for key in keys {
            let inner = format!("{pointer}/{key}");
            if self.document.get(&inner).is_some() {
                let at = self.document.key_at(&inner);
                self.diagnostics
                    .push(Diagnostic::error(&at, format!("`{key}` has no meaning in this table")).with_help(why));
            }
        }
    }
}

impl SineFile {
    fn signal(&self) -> Signal {
        let turns = self.frequency_hz.map(|f| f * core::f64::consts::TAU);
        Signal::Sine {
            amplitude: self.amplitude,
            angular_frequency: self.angular_frequency.or(turns).unwrap_or(0.0),
            phase: self.phase,
            offset: self.offset,
        }
    }
}

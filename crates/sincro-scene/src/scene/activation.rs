//! Activation of actuators in scene files: as written, and as the builder takes it.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::actuation::{Activation, ActivationDynamics};

use super::signal_file::SignalReader;
use crate::diagnostic::Diagnostic;

/// Activation of an actuator: a state of first order between its command and what acts, in the unit of the command.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ActivationFile {
    /// Its dynamics.
    pub kind: ActivationKindFile,
    /// Kind `filter`: time constant τ, above 0 [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub time_constant: Option<f64>,
    /// Ends of the activation, where it stops without windup.
    pub range: Option<ActivationRangeFile>,
    /// Limits of the input: the command within them is what counts.
    pub input_range: Option<ActivationRangeFile>,
    /// Activation at the start; default 0.
    #[serde(default)]
    pub initial: f64,
}

/// Range of an activation or its input, in the unit of the command.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ActivationRangeFile {
    /// Lower end; none if left out.
    pub lower: Option<f64>,
    /// Upper end; none if left out.
    pub upper: Option<f64>,
}

impl ActivationRangeFile {
    /// Both ends, infinite for none.
    fn ends(self) -> [f64; 2] {
        [self.lower.unwrap_or(f64::NEG_INFINITY), self.upper.unwrap_or(f64::INFINITY)]
    }
}

/// Dynamics of an activation a under the input u.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum ActivationKindFile {
    /// ȧ = u: the command is the rate of the activation.
    Integrator,
    /// ȧ = (u − a)/τ.
    Filter,
}

impl ActivationFile {
    /// The specification of the activation written at `pointer`, for the builder; notes keys that are missing or have
    /// no meaning, and numbers that are none. `of` is the actuator as messages call it.
    pub(super) fn spec(&self, of: &str, pointer: &str, signals: &mut SignalReader<'_>) -> Activation<f64> {
        let dynamics = match (self.kind, self.time_constant) {
            (ActivationKindFile::Integrator, time_constant) => {
                if time_constant.is_some() {
                    let at = signals.document.key_at(&format!("{pointer}/time_constant"));
                    let message = format!("`time_constant` has no meaning for the activation of {of}, an integrator");
                    signals.diagnostics.push(Diagnostic::error(&at, message).with_help("leave it out"));
                }
                ActivationDynamics::Integrator
            }
            (ActivationKindFile::Filter, Some(time_constant)) => ActivationDynamics::Filter { time_constant },
            (ActivationKindFile::Filter, None) => {
                let at = signals.document.at(&format!("{pointer}/kind"));
                let message = format!("`time_constant` is missing in the activation of {of}, a filter");
                signals.diagnostics.push(Diagnostic::error(&at, message).with_help("give `time_constant` [s]"));
                ActivationDynamics::Filter { time_constant: 1.0 }
            }
        };
        let plain = Activation::new(dynamics);
        let spec = Activation {
            range: self.range.map_or(plain.range, ActivationRangeFile::ends),
            input_range: self.input_range.map_or(plain.input_range, ActivationRangeFile::ends),
            initial: self.initial,
            ..plain
        };
        for (key, message, help) in spec.problems(of) {
            let at = signals.document.at(&format!("{pointer}/{key}"));
            signals.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
        }
        spec
    }
}

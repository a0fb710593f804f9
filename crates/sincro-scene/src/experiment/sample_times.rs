//! Sample times of a scene's sensors against the base step of the experiment.

use super::{Experiment, short};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::sensor::{SensorSpec, every};

/// Refuses sample times that are no whole number of base steps.
pub(crate) fn check_sample_times(specs: &[SensorSpec], experiment: &Experiment) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    for spec in specs {
        let Some(sample_time) = spec.sample_time.as_ref().filter(|_| every(spec, experiment.step).is_none()) else {
            continue;
        };
        let (step, ratio) = (experiment.step, sample_time.value / experiment.step);
        let message = format!(
            "the sample time of sensor `{}`, {} s, is no whole number of base steps of {step} s",
            spec.path, sample_time.value
        );
        let near = [ratio.floor().max(1.0), ratio.ceil().max(1.0)].map(|n| short(n * step));
        let help = if near[0] == near[1] {
            format!("use {} or a smaller `step`", near[0])
        } else {
            format!("use {} or {}, or another `step`", near[0], near[1])
        };
        diagnostics.push(Diagnostic::error(&sample_time.at, message).with_help(help));
    }
    diagnostics
}

//! A linear system in text, figures and a page.
//!
//! [`Analysis::of`] computes once what all of them show. A system of many inputs and outputs has a figure for each of
//! its first six channels; the files hold all of them.

mod figures;
mod page;
mod text;

use sincro_analysis::linear::{Bode, Complex, DMatrix, LinearError, Mode, StateSpace, StepResponse, SubspaceRank};
use sincro_analysis::linearize::OpenLoop;

pub use figures::all as figures;
pub use page::html;
pub use text::text;

/// Channels that are shown in full.
pub(crate) const MAX_CHANNELS: usize = 6;

/// Linear system with everything that its text, figures and report page show; [`Analysis::of`] computes it.
#[derive(Clone, Debug)]
pub struct Analysis<'a> {
    /// Title of text and page, usually that of the scene.
    pub title: String,
    /// Matrices A, B, C, D with the names and units of states, inputs and outputs.
    pub system: &'a StateSpace,
    /// Poles `[1/s]` (of a sampled system in the z plane) with damping ratio and natural frequency `[rad/s]`, slowest
    /// first.
    pub poles: Vec<Mode>,
    /// Rank of the controllable subspace, among the number of states.
    pub controllability: SubspaceRank,
    /// Rank of the observable subspace, among the number of states.
    pub observability: SubspaceRank,
    /// Transfer functions of every input to every output that depends on it, input by input.
    pub channels: Vec<Channel>,
    /// Inputs without an effect on an output: a message for each such pair.
    pub silent: Vec<String>,
    /// Equations (constraints) that were eliminated before, one sentence each; empty if there were none.
    pub reduction: Vec<String>,
    /// Loops of a sampled system that were opened, with their margins; may be empty.
    pub loops: &'a [OpenLoop],
}

/// Transfer function of one input to one output, with what is derived from it.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Index of the input in [`Analysis::system`].
    pub input: usize,
    /// Index of the output in [`Analysis::system`].
    pub output: usize,
    /// Zeros `[1/s]`, by modulus; those of a sampled system in the z plane (dimensionless).
    pub zeros: Vec<Complex<f64>>,
    /// Static gain, in [`Analysis::gain_unit`]; `None`: the system integrates.
    pub gain: Option<f64>,
    /// Magnitude and phase over the angular frequencies `[rad/s]` that all channels share.
    pub bode: Bode,
    /// Response to a unit step over the times `[s]` that all channels share.
    pub step: StepResponse,
}

impl<'a> Analysis<'a> {
    /// Derives poles, zeros, Bode data and step responses of a system for all pairs of inputs and outputs; `title`
    /// heads text and page.
    #[must_use]
    pub fn of(title: impl Into<String>, system: &'a StateSpace) -> Self {
        let omega = system.frequencies();
        let responses = system.frequency_responses(&omega);
        let pairs = (0..system.n_inputs()).flat_map(|i| (0..system.n_outputs()).map(move |o| (i, o)));
        let (mut channels, mut silent) = (Vec::new(), Vec::new());
        for (input, output) in pairs {
            match Channel::of(system, input, output, (&omega, &responses)) {
                Ok(channel) => channels.push(channel),
                Err(problem) => silent.push(problem.to_string()),
            }
        }
        Self {
            title: title.into(),
            system,
            poles: system.poles(),
            controllability: system.controllability(),
            observability: system.observability(),
            channels,
            silent,
            reduction: Vec::new(),
            loops: &[],
        }
    }

    /// Sets [`Analysis::loops`].
    #[must_use]
    pub fn with_loops(self, loops: &'a [OpenLoop]) -> Self {
        Self { loops, ..self }
    }

    /// Sets [`Analysis::reduction`]: one sentence for each constraint that was eliminated before.
    #[must_use]
    pub fn with_reduction(self, reduction: Vec<String>) -> Self {
        Self { reduction, ..self }
    }

    /// Channels that text and page show in full: the first six; the files hold all of them.
    #[must_use]
    pub fn shown(&self) -> &[Channel] {
        &self.channels[..self.channels.len().min(MAX_CHANNELS)]
    }

    /// Names of the channels beyond [`MAX_CHANNELS`], which are only in the files.
    #[must_use]
    pub(crate) fn unshown(&self) -> Vec<String> {
        self.channels.iter().skip(MAX_CHANNELS).map(|channel| self.name(channel)).collect()
    }

    /// Name of a channel, by the names of its input and output: `from /motor.command to /arm/hinge.position`.
    #[must_use]
    pub fn name(&self, channel: &Channel) -> String {
        let (input, output) = (&self.system.inputs[channel.input], &self.system.outputs[channel.output]);
        format!("from {} to {}", input.name, output.name)
    }

    /// Unit of the static gain of a channel, that of its output over that of its input: `rad/(N·m)`; empty if they are
    /// the same.
    #[must_use]
    pub fn gain_unit(&self, channel: &Channel) -> String {
        let (input, output) = (&self.system.inputs[channel.input].unit, &self.system.outputs[channel.output].unit);
        match (output.as_str(), input.as_str()) {
            (output, "") => output.to_owned(),
            (output, input) if output == input => String::new(),
            ("", input) => quotient("1", input),
            (output, input) if input.contains('/') => format!("({output})/({input})"),
            (output, input) => match output.split_once('/') {
                Some((top, bottom)) => quotient(top, &format!("{}·{input}", bottom.trim_matches(['(', ')']))),
                None => quotient(output, input),
            },
        }
    }
}

/// A unit by another, in brackets where it needs them.
fn quotient(top: &str, bottom: &str) -> String {
    if bottom.contains(['·', '/']) { format!("{top}/({bottom})") } else { format!("{top}/{bottom}") }
}

impl Channel {
    fn of(
        system: &StateSpace,
        input: usize,
        output: usize,
        (omega, responses): (&[f64], &[DMatrix<Complex<f64>>]),
    ) -> Result<Self, LinearError> {
        let values = responses.iter().map(|g| g[(output, input)]).collect();
        Ok(Self {
            input,
            output,
            zeros: system.zeros(input, output)?,
            gain: system.gain(input, output),
            bode: system.bode_of(input, output, omega, values)?,
            step: system.step_response(input, output, None),
        })
    }
}

#[cfg(test)]
mod tests;

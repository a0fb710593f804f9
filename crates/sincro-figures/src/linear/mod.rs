//! A linear system in text, figures and a page.
//!
//! [`Analysis::of`] computes once what all of them show. A system of many inputs and outputs has a figure for each of
//! its first [`MAX_CHANNELS`] channels; the files hold all of them.

mod figures;
mod page;
mod text;

use sincro_analysis::linear::{Bode, Complex, Mode, Problem, Reach, StateSpace, StepResponse};

pub use figures::all as figures;
pub use page::html;
pub use text::text;

/// Channels that are shown in full.
pub const MAX_CHANNELS: usize = 6;

/// A linear system and what is derived from it.
#[derive(Clone, Debug)]
pub struct Analysis<'a> {
    /// Title of the scene.
    pub title: String,
    /// The matrices.
    pub system: &'a StateSpace,
    /// Slowest first.
    pub poles: Vec<Mode>,
    /// Controllability: the dimensions that the inputs reach.
    pub controllability: Reach,
    /// Observability: the dimensions that the outputs see.
    pub observability: Reach,
    /// Every input with every output, input by input.
    pub channels: Vec<Channel>,
    /// Channels without a path, by name, in words.
    pub silent: Vec<String>,
}

/// One input, one output that depends on it.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Index of the input.
    pub input: usize,
    /// Index of the output.
    pub output: usize,
    /// By modulus.
    pub zeros: Vec<Complex<f64>>,
    /// Static gain; `None`: the system integrates.
    pub gain: Option<f64>,
    /// Over the frequencies that all channels share.
    pub bode: Bode,
    /// Over the times that all channels share.
    pub step: StepResponse,
}

impl<'a> Analysis<'a> {
    /// Derives everything that is shown.
    pub fn of(title: impl Into<String>, system: &'a StateSpace) -> Self {
        let omega = system.frequencies();
        let pairs = (0..system.n_inputs()).flat_map(|i| (0..system.n_outputs()).map(move |o| (i, o)));
        let (mut channels, mut silent) = (Vec::new(), Vec::new());
        for (input, output) in pairs {
            match Channel::of(system, input, output, &omega) {
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
        }
    }

    /// Channels shown in full.
    pub fn shown(&self) -> &[Channel] {
        &self.channels[..self.channels.len().min(MAX_CHANNELS)]
    }

    /// Names of the channels that are only in the files.
    pub fn unshown(&self) -> Vec<String> {
        self.channels.iter().skip(MAX_CHANNELS).map(|channel| self.name(channel)).collect()
    }

    /// `from /motor.command to /arm/hinge.position`.
    pub fn name(&self, channel: &Channel) -> String {
        let (input, output) = (&self.system.inputs[channel.input], &self.system.outputs[channel.output]);
        format!("from {} to {}", input.name, output.name)
    }

    /// Unit of the gain of a channel: `rad/(N·m)`, `rad/(s·V)`.
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
    fn of(system: &StateSpace, input: usize, output: usize, omega: &[f64]) -> Result<Self, Problem> {
        Ok(Self {
            input,
            output,
            zeros: system.zeros(input, output)?,
            gain: system.gain(input, output),
            bode: system.bode_at(input, output, omega)?,
            step: system.step_response(input, output, None),
        })
    }
}

#[cfg(test)]
mod tests;

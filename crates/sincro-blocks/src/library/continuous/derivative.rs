//! `y = s/(time_constant·s + 1)·u`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// The rate of change of a signal, smoothed by a first-order lag.
///
/// A derivative without a lag would need the future. The shorter the time constant, the truer and the noisier it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivative {
    /// Of the lag `[s]`, one for all components or one for each.
    pub time_constant: Vec<f64>,
    /// Value that the input had before the start.
    pub initial_input: Vec<f64>,
}

impl Derivative {
    /// Of an input that was zero before the start; `time_constant` in `[s]`.
    #[must_use]
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant: vec![time_constant], initial_input: vec![0.0] }
    }
}

impl Described for Derivative {
    const KIND: &'static Kind = &Kind {
        name: "derivative",
        group: Group::Continuous,
        summary: "The rate of change of a signal, smoothed by a first-order lag.",
        equation: "y = (u − x)/time_constant, x' = y, x(0) = initial_input",
        parameters: &[
            Parameter::required("time_constant", Takes::Numbers, "of the lag [s]: shorter is truer and noisier"),
            Parameter::optional("initial_input", Takes::Numbers, "value that u had before the start", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { time_constant: p.positives("time_constant"), initial_input: p.numbers("initial_input") }
    }
}

impl Block for Derivative {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let parameters = [("time_constant", self.time_constant.len()), ("initial_input", self.initial_input.len())];
        Ok(vec![elementwise(inputs, &parameters)?])
    }

    fn pace(&self) -> Pace {
        Pace::Continuous
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: node.n_out(), discrete: 0 }
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        for (i, x) in states.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial_input, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = (at.component(0, i) - at.states[i]) / R::splat(of(&self.time_constant, i));
        }
    }

    fn slope<R: Real>(&self, at: &At<'_, R>, (): &mut (), slope: &mut [R]) {
        self.output(at, &mut (), slope);
    }

    fn decay<R: Real>(&self, _: &At<'_, R>, decay: &mut [R]) {
        for (i, decay) in decay.iter_mut().enumerate() {
            *decay = R::splat(1.0 / of(&self.time_constant, i));
        }
    }

    fn label(&self) -> String {
        match &self.time_constant[..] {
            [tau] => super::Rational::new(&[1.0, 0.0], &[*tau, 1.0]).map_or("d/dt".into(), |g| g.text('s')),
            _ => "s/(τs + 1)".into(),
        }
    }
}

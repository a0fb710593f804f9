//! `time_constant·y' + y = dc_gain·u`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// A first-order lag. Its output does not depend at once on its input: it breaks algebraic loops.
#[derive(Clone, Debug, PartialEq)]
pub struct LowPass {
    /// After this time a step is answered to 63 % `[s]`, one for all components or one for each.
    pub time_constant: Vec<f64>,
    /// What a constant input is multiplied with in the end.
    pub dc_gain: Vec<f64>,
    /// Output at the start.
    pub initial: Vec<f64>,
}

impl LowPass {
    /// With gain 1, from zero; `time_constant` in `[s]`.
    #[must_use]
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant: vec![time_constant], dc_gain: vec![1.0], initial: vec![0.0] }
    }
}

impl Described for LowPass {
    const KIND: &'static Kind = &Kind {
        name: "low-pass",
        group: Group::Continuous,
        summary: "A first-order lag, which does not feed through at once.",
        equation: "y' = (dc_gain·u − y)/time_constant, y(0) = initial",
        parameters: &[
            Parameter::required("time_constant", Takes::Numbers, "time after which a step is answered to 63 % [s]"),
            Parameter::optional("dc_gain", Takes::Numbers, "gain for a constant input", "1"),
            Parameter::optional("initial", Takes::Numbers, "y at the start", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let time_constant = p.positives("time_constant");
        Self { time_constant, dc_gain: p.numbers("dc_gain"), initial: p.numbers("initial") }
    }
}

impl Block for LowPass {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let parameters = [
            ("time_constant", self.time_constant.len()),
            ("dc_gain", self.dc_gain.len()),
            ("initial", self.initial.len()),
        ];
        Ok(vec![elementwise(inputs, &parameters)?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        // any other gain may have a unit
        Ok(vec![inputs[0].clone().filter(|_| self.dc_gain.iter().all(|g| *g == 1.0))])
    }

    fn pace(&self) -> Pace {
        Pace::Continuous
    }

    fn feeds_through(&self, _: usize) -> bool {
        false
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: node.n_out(), discrete: 0 }
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        for (i, x) in states.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.states);
    }

    fn slope<R: Real>(&self, at: &At<'_, R>, (): &mut (), slope: &mut [R]) {
        for (i, slope) in slope.iter_mut().enumerate() {
            let target = R::splat(of(&self.dc_gain, i)) * at.component(0, i);
            *slope = (target - at.states[i]) / R::splat(of(&self.time_constant, i));
        }
    }

    fn decay<R: Real>(&self, _: &At<'_, R>, decay: &mut [R]) {
        for (i, decay) in decay.iter_mut().enumerate() {
            *decay = R::splat(1.0 / of(&self.time_constant, i));
        }
    }

    fn label(&self) -> String {
        match (&self.dc_gain[..], &self.time_constant[..]) {
            ([gain], [tau]) => super::Rational::new(&[*gain], &[*tau, 1.0]).map_or("lag".into(), |g| g.text('s')),
            _ => "1/(τs + 1)".into(),
        }
    }
}

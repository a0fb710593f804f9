//! `y' = u`, within limits, with reset.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Integrates its input over time.
///
/// At a limit it stands still as long as the input pushes outwards. With `reset` it has a second input: while that is greater
/// than zero at a tick, the state is put back to the initial value.
#[derive(Clone, Debug, PartialEq)]
pub struct Integrator {
    /// Value at the start, one for all components or one for each.
    pub initial: Vec<f64>,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Whether there is an input `reset`.
    pub reset: bool,
}

impl Integrator {
    /// Without limits and reset.
    #[must_use]
    pub fn new(initial: f64) -> Self {
        Self { initial: vec![initial], lower: f64::NEG_INFINITY, upper: f64::INFINITY, reset: false }
    }
}

impl Described for Integrator {
    const KIND: &'static Kind = &Kind {
        name: "integrator",
        group: Group::Continuous,
        summary: "Integrates its input over time, within limits.",
        equation: "y' = u, lower ≤ y ≤ upper; y = initial while reset > 0",
        parameters: &[
            Parameter::optional("initial", Takes::Numbers, "y at the start", "0"),
            Parameter::optional("lower", Takes::Number, "least y", "-inf"),
            Parameter::optional("upper", Takes::Number, "greatest y", "inf"),
            Parameter::optional("reset", Takes::Flag, "whether there is an input `reset`", "false"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let new = Self {
            initial: p.numbers("initial"),
            lower: p.limit("lower"),
            upper: p.limit("upper"),
            reset: p.flag("reset"),
        };
        if new.lower > new.upper {
            p.fault("lower", format!("`lower` {} is above `upper` {}", new.lower, new.upper), "exchange them");
        } else if let Some(x) = new.initial.iter().find(|x| **x < new.lower || **x > new.upper) {
            p.fault("initial", format!("`initial` {x} is beyond the limits"), "start between `lower` and `upper`");
        }
        new
    }
}

impl Block for Integrator {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(if self.reset { &["u", "reset"] } else { &["u"] }, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&inputs[..1], &[("initial", self.initial.len())])?])
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
        for (y, x) in y.iter_mut().zip(at.states) {
            *y = x.max(R::splat(self.lower)).min(R::splat(self.upper));
        }
    }

    fn slope<R: Real>(&self, at: &At<'_, R>, (): &mut (), slope: &mut [R]) {
        let (lower, upper, zero) = (R::splat(self.lower), R::splat(self.upper), R::zero());
        for (i, slope) in slope.iter_mut().enumerate() {
            let (x, u) = (at.states[i], at.component(0, i));
            // beyond a limit only the way back is free
            let up = x.if_less(upper, u, u.min(zero));
            *slope = lower.if_less(x, up, up.max(zero));
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), _: &mut [R], states: &mut [R]) {
        if self.reset && at.scalar(1).lane(0) > 0.0 {
            self.start(at.node, states, &mut []);
        }
        // the last step may have gone a little beyond a limit
        for x in states {
            *x = x.max(R::splat(self.lower)).min(R::splat(self.upper));
        }
    }

    fn label(&self) -> String {
        "1/s".into()
    }
}

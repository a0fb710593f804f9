//! `y[k] = initial + gain·Ts·Σ u`, within limits, with reset.
//!
//! With the sample time Ts and `a = gain·Ts·u[k]`:
//!
//! ```text
//! y[k] = limited(s[k] + α·a),   s[k+1] = limited(y[k] + (1 − α)·a),   s[0] = initial
//! α = 0 forward Euler, 1 backward Euler, ½ trapezoidal
//! ```

use sincro_math::Real;

use super::Method;
use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Sums its input over time.
///
/// With `reset` it has a second input: while that is greater than zero at a sample, the next sample starts from the initial value.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteIntegrator {
    /// Rule of the integral. Only forward Euler does not feed through.
    pub method: Method,
    /// Factor, one for all components or one for each.
    pub gain: Vec<f64>,
    /// Value at the start.
    pub initial: Vec<f64>,
    /// Least value.
    pub lower: Vec<f64>,
    /// Greatest value.
    pub upper: Vec<f64>,
    /// Whether there is an input `reset`.
    pub reset: bool,
}

impl DiscreteIntegrator {
    /// From zero, without limits and reset.
    #[must_use]
    pub fn new(method: Method) -> Self {
        let (lower, upper) = (vec![f64::NEG_INFINITY], vec![f64::INFINITY]);
        Self { method, gain: vec![1.0], initial: vec![0.0], lower, upper, reset: false }
    }

    #[inline(always)]
    fn limited<R: Real>(&self, x: R, i: usize) -> R {
        x.max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)))
    }

    /// `part·gain·Ts·u`.
    #[inline(always)]
    fn advance<R: Real>(&self, at: &At<'_, R>, part: f64, i: usize) -> R {
        R::splat(part * at.node.period() * of(&self.gain, i)) * at.component(0, i)
    }

    #[inline(always)]
    fn present<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        let weight = self.method.weight();
        let s = at.memory[i];
        self.limited(if weight == 0.0 { s } else { s + self.advance(at, weight, i) }, i)
    }
}

impl Described for DiscreteIntegrator {
    const KIND: &'static Kind = &Kind {
        name: "discrete-integrator",
        group: Group::Discrete,
        summary: "Sums its input over time, within limits.",
        equation: "y[k+1] = y[k] + gain·Ts·u[k] (forward Euler), lower ≤ y ≤ upper; y = initial after reset > 0",
        parameters: &[
            super::METHOD,
            Parameter::optional("gain", Takes::Numbers, "factor", "1"),
            Parameter::optional("initial", Takes::Numbers, "y at the start", "0"),
            Parameter::optional("lower", Takes::Numbers, "least y", "-inf"),
            Parameter::optional("upper", Takes::Numbers, "greatest y", "inf"),
            Parameter::optional("reset", Takes::Flag, "whether there is an input `reset`", "false"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let method = Method::read(p);
        let (gain, initial) = (p.numbers("gain"), p.numbers("initial"));
        let (lower, upper) = (p.limits("lower"), p.limits("upper"));
        crate::library::nonlinear::check_limits(p, &lower, &upper);
        Self { method, gain, initial, lower, upper, reset: p.flag("reset") }
    }
}

impl Block for DiscreteIntegrator {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(if self.reset { &["u", "reset"] } else { &["u"] }, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let parameters = [
            ("gain", self.gain.len()),
            ("initial", self.initial.len()),
            ("lower", self.lower.len()),
            ("upper", self.upper.len()),
        ];
        Ok(vec![elementwise(&inputs[..1], &parameters)?])
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn feeds_through(&self, input: usize) -> bool {
        input == 0 && self.method != Method::ForwardEuler
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.present(at, i);
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        if self.reset && at.scalar(1).lane(0) > 0.0 {
            self.start(at.node, &mut [], memory);
            return;
        }
        let rest = 1.0 - self.method.weight();
        for (i, s) in memory.iter_mut().enumerate() {
            let y = self.present(at, i);
            *s = if rest == 0.0 { y } else { self.limited(y + self.advance(at, rest, i), i) };
        }
    }

    fn label(&self) -> String {
        match self.method {
            Method::ForwardEuler => "Ts/(z − 1)",
            Method::BackwardEuler => "Ts·z/(z − 1)",
            Method::Trapezoidal => "Ts/2·(z + 1)/(z − 1)",
        }
        .into()
    }
}

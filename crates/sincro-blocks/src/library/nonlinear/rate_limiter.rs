//! `−falling ≤ Δy/Ts ≤ rising`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// Limits how fast a signal changes. It works at samples, or at every tick if it has no sample time.
#[derive(Clone, Debug, PartialEq)]
pub struct RateLimiter {
    /// Fastest rise `[unit of u / s]`, one for all components or one for each.
    pub rising: Vec<f64>,
    /// Fastest fall, a positive number `[unit of u / s]`, one for all components or one for each.
    pub falling: Vec<f64>,
    /// Output before the start; `None`: it starts at its input.
    pub initial: Option<Vec<f64>>,
}

impl RateLimiter {
    /// Both ways alike, started at the input; `rate` in `[unit of u / s]`.
    #[must_use]
    pub fn new(rate: f64) -> Self {
        Self { rising: vec![rate], falling: vec![rate], initial: None }
    }

    #[inline(always)]
    fn limited<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        let u = at.component(0, i);
        if at.tick == 0 && self.initial.is_none() {
            return u;
        }
        let (before, ts) = (at.memory[i], at.node.period());
        let (low, high) = (R::splat(-of(&self.falling, i) * ts), R::splat(of(&self.rising, i) * ts));
        let change = u - before;
        // within the limits the output is the input to the bit
        let up = high.if_less(change, before + high, u);
        change.if_less(low, before + low, up)
    }
}

impl Described for RateLimiter {
    const KIND: &'static Kind = &Kind {
        name: "rate-limiter",
        group: Group::Nonlinear,
        summary: "Limits how fast a signal changes.",
        equation: "y[k] = y[k−1] + min(max(u[k] − y[k−1], −falling·Ts), rising·Ts)",
        parameters: &[
            Parameter::required("rising", Takes::Numbers, "fastest rise [unit of u / s]"),
            Parameter::optional("falling", Takes::Numbers, "fastest fall, a positive number [unit of u / s]", "rising"),
            Parameter::optional("initial", Takes::Numbers, "y before the start", "u"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let rising = p.limits("rising");
        let falling = if p.has("falling") { p.limits("falling") } else { rising.clone() };
        for (key, list) in [("rising", &rising), ("falling", &falling)] {
            if let Some(bad) = list.iter().find(|x| **x <= 0.0) {
                p.fault(key, format!("`{key}` is {bad}"), "both rates are positive numbers");
            }
        }
        let initial = p.has("initial").then(|| p.numbers("initial"));
        Self { rising, falling, initial }
    }
}

impl Block for RateLimiter {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let initial = self.initial.as_ref().map_or(1, Vec::len);
        let parameters = [("rising", self.rising.len()), ("falling", self.falling.len()), ("initial", initial)];
        Ok(vec![elementwise(inputs, &parameters)?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(self.initial.as_ref().map_or(0.0, |initial| of(initial, i)));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.limited(at, i);
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = self.limited(at, i);
        }
    }

    fn label(&self) -> String {
        format!("±{}/s", crate::library::short_list(&self.rising))
    }
}

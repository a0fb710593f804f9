//! `y[k] = y[k−1] + 1` at a rising edge of `u`, 0 while `reset` is true.

use sincro_math::Real;

use super::truth::is_true;
use crate::block::{At, Block, Memory, Node, Pace, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Counts how often its input became true. Zero is false, any other number true.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counter {
    /// Count before the first sample.
    pub initial: usize,
    /// Whether there is an input `reset`, which puts the count back to 0 while it is true.
    pub reset: bool,
}

impl Counter {
    /// From 0 on, without reset.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

impl Described for Counter {
    const KIND: &'static Kind = &Kind {
        name: "counter",
        group: Group::Logic,
        summary: "Counts how often its input became true.",
        equation: "y[k] = y[k−1] + (1 if u[k] and not u[k−1], else 0); y[k] = 0 while reset[k]",
        parameters: &[
            Parameter::optional("initial", Takes::Count, "y before the first sample", "0"),
            Parameter::optional("reset", Takes::Flag, "whether there is an input `reset`", "false"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { initial: p.count("initial"), reset: p.flag("reset") }
    }
}

impl Block for Counter {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(if self.reset { &["u", "reset"] } else { &["u"] }, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        match inputs.iter().position(|width| width.is_some_and(|w| w != 1)) {
            Some(k) => Err(format!("input {} has {} components instead of 1", k + 1, inputs[k].unwrap_or(0))),
            None => Ok(vec![Some(1)]),
        }
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    /// The count and the input of the sample before.
    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: 0, discrete: 2 }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory[0] = R::splat(self.initial as f64);
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (u, count) = (at.scalar(0), at.memory[0]);
        // 0, or NaN if an input is
        let poison = R::zero() * if self.reset { u + at.scalar(1) } else { u };
        let has_risen = is_true(u) && !is_true(at.memory[1]);
        let counted = if has_risen { count + R::one() } else { count };
        y[0] = if self.reset && is_true(at.scalar(1)) { R::zero() } else { counted } + poison;
    }

    fn update<R: Real>(&self, at: &At<'_, R>, work: &mut (), memory: &mut [R], _: &mut [R]) {
        self.output(at, work, &mut memory[..1]);
        memory[1] = at.scalar(0);
    }

    fn label(&self) -> String {
        "n + 1".into()
    }
}

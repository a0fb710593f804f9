//! `y = on` from `u > on_above` until `u < off_below`, else `off`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// A switch with hysteresis. It works at samples, or at every tick if it has no sample time.
#[derive(Clone, Debug, PartialEq)]
pub struct Relay {
    /// Above this it switches on.
    pub on_above: f64,
    /// Below this it switches off.
    pub off_below: f64,
    /// Output while on.
    pub on: f64,
    /// Output while off.
    pub off: f64,
    /// Whether it is on before the start.
    pub initially_on: bool,
}

impl Relay {
    /// From off, with the outputs 1 and 0.
    #[must_use]
    pub fn new(on_above: f64, off_below: f64) -> Self {
        Self { on_above, off_below, on: 1.0, off: 0.0, initially_on: false }
    }

    /// Whether component `i` is now on; its memory is 1 while on.
    #[inline(always)]
    fn is_on<R: Real>(&self, at: &At<'_, R>, i: usize) -> bool {
        let u = at.component(0, i).lane(0);
        u > self.on_above || (at.memory[i].lane(0) > 0.5 && u >= self.off_below)
    }
}

impl Described for Relay {
    const KIND: &'static Kind = &Kind {
        name: "relay",
        group: Group::Nonlinear,
        summary: "A switch with hysteresis.",
        equation: "y = on from u > on_above until u < off_below, else off",
        parameters: &[
            Parameter::required("on_above", Takes::Number, "above this it switches on"),
            Parameter::required("off_below", Takes::Number, "below this it switches off, at most `on_above`"),
            Parameter::optional("on", Takes::Number, "y while on", "1"),
            Parameter::optional("off", Takes::Number, "y while off", "0"),
            Parameter::optional("initially_on", Takes::Flag, "whether it is on before the start", "false"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let (on_above, off_below) = (p.number("on_above"), p.number("off_below"));
        if off_below > on_above {
            let message = format!("`off_below` {off_below} is above `on_above` {on_above}");
            p.fault("off_below", message, "exchange them");
        }
        Self { on_above, off_below, on: p.number("on"), off: p.number("off"), initially_on: p.flag("initially_on") }
    }
}

impl Block for Relay {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory.fill(R::splat(f64::from(u8::from(self.initially_on))));
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let u = at.component(0, i);
            // what is not a number is neither on nor off
            let is_unknown = u.lane(0).is_nan();
            *y = if is_unknown { u } else { R::splat(if self.is_on(at, i) { self.on } else { self.off }) };
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(f64::from(u8::from(self.is_on(at, i))));
        }
    }
}

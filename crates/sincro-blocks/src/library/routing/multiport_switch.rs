//! `y = u1` if `selector` is 1, `u2` if it is 2 …

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::maths::n_inputs;
use crate::reader::Reader;
use crate::unit::{Unit, common};

/// Passes on the input of a number, counted from 1 as the inputs are.
///
/// A `selector` that is none of 1 … n, or not whole, makes NaN: the run stops and names this block. Nothing is rounded or limited:
/// `function = "round"` and a saturation do that where it is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MultiportSwitch {
    /// How many inputs it chooses from.
    pub inputs: usize,
}

impl MultiportSwitch {
    /// With so many inputs to choose from, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }
}

impl Described for MultiportSwitch {
    const KIND: &'static Kind = &Kind {
        name: "multiport-switch",
        group: Group::Routing,
        summary: "Passes on the input of a number, from 1 on; any other number stops the run and names the block.",
        equation: "y = u1 if selector = 1, u2 if selector = 2, …",
        parameters: &[Parameter::optional("inputs", Takes::Count, "number of inputs to choose from", "2")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::new(n_inputs(p))
    }
}

impl Block for MultiportSwitch {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        let numbered = (1..=self.inputs).map(|k| format!("u{k}"));
        Ports { inputs: core::iter::once("selector".into()).chain(numbered).collect(), outputs: vec!["y".into()] }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        match inputs[0] {
            Some(width) if width != 1 => Err(format!("`selector` has {width} components instead of 1")),
            _ => Ok(vec![elementwise(inputs, &[])?]),
        }
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![common(&inputs[1..])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let selector = at.scalar(0).lane(0);
        let chosen = (1..=self.inputs).find(|k| *k as f64 == selector);
        for (i, y) in y.iter_mut().enumerate() {
            *y = chosen.map_or(R::splat(f64::NAN), |k| at.component(k, i));
        }
    }

    fn label(&self) -> String {
        format!("1 … {}", self.inputs)
    }
}

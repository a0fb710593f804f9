//! Block `multiport-switch`.

use crate::library::prelude::*;

declare_block! {
    /// Passes on the input of a number, from 1 on; any other number stops the run and names the block.
    ///
    /// A `selector` that is none of 1 … n, or not
    /// whole, makes NaN: the run stops and names this block. Nothing is rounded or limited: `function = "round"` and a
    /// saturation do that where it is meant.
    pub struct MultiportSwitch("multiport-switch", Routing): "y = u1 if selector = 1, u2 if selector = 2, …" {
        /// Number of inputs to choose from.
        pub inputs: usize as InputCount = "2",
    }
}

impl MultiportSwitch {
    /// Creates the block with so many inputs to choose from, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
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

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Same((1..=self.inputs).collect())
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

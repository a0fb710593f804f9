//! `y1 = u[0 … n₁−1]`, `y2` = the next `n₂` …

use crate::library::prelude::*;

/// Block `demux`: divides a vector into one output for each entry of `sizes`. A wire from `a[0:2]` takes one piece
/// without a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Demux {
    /// Widths of the outputs (numbers of components), in the order of the vector; together the width of the input.
    pub sizes: Vec<usize>,
}

impl Demux {
    /// Creates a block that divides a vector into pieces of these widths (numbers of components).
    #[must_use]
    pub fn new(sizes: &[usize]) -> Self {
        Self { sizes: sizes.to_vec() }
    }
}

impl Described for Demux {
    const KIND: &'static Kind = &Kind {
        name: "demux",
        category: Category::Routing,
        summary: "Cuts a vector into pieces.",
        equation: "[y1, y2, …] = u",
        parameters: &[Parameter::required("sizes", ValueKind::Numbers, "number of components of y1, y2 …")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { sizes: p.counts("sizes", 1) }
    }
}

impl Block for Demux {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports { inputs: vec!["u".into()], outputs: (1..=self.sizes.len()).map(|k| format!("y{k}")).collect() }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let sum: usize = self.sizes.iter().sum();
        match inputs[0] {
            Some(width) if width != sum => Err(format!("the sizes add up to {sum}, the input has {width} components")),
            _ => Ok(self.sizes.iter().map(|size| Some(*size)).collect()),
        }
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![inputs[0].clone(); self.sizes.len()])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::InOrder
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.input(0));
    }
}

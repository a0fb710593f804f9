//! `y = [u[i₀], u[i₁], …]`.

use crate::library::prelude::*;

/// Block `selector`: selects components of a vector, in any order and any number of times.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selector {
    /// Indices of the components, counted from 0, in the order of the output.
    pub indices: Vec<usize>,
}

impl Selector {
    /// Creates a block that selects these components, counted from 0; indices beyond the input are errors of the
    /// compiler.
    #[must_use]
    pub fn new(indices: &[usize]) -> Self {
        Self { indices: indices.to_vec() }
    }
}

impl Described for Selector {
    const KIND: &'static Kind = &Kind {
        name: "selector",
        category: Category::Routing,
        summary: "Takes components of a vector, in any order and as often as wanted.",
        equation: "y = [u[i₀], u[i₁], …], i = indices",
        parameters: &[Parameter::required("indices", ValueKind::Numbers, "components, counted from 0")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { indices: p.counts("indices", 0) }
    }
}

impl Block for Selector {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let beyond = |width: usize| self.indices.iter().find(|index| **index >= width);
        match inputs[0].and_then(|width| beyond(width).map(|index| (width, index))) {
            Some((width, index)) => {
                Err(format!("there is no component {index}: the input has {width}, counted from 0"))
            }
            None => Ok(vec![Some(self.indices.len())]),
        }
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Components(self.indices.clone())
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, index) in y.iter_mut().zip(&self.indices) {
            *y = at.input(0)[*index];
        }
    }

    fn label(&self) -> String {
        let list: Vec<String> = self.indices.iter().take(4).map(ToString::to_string).collect();
        format!("u[{}{}]", list.join(" "), if self.indices.len() > 4 { " …" } else { "" })
    }
}

//! `y = [u[i₀], u[i₁], …]`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// Takes components of a vector, in any order and as often as wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selector {
    /// Which components, counted from 0.
    pub indices: Vec<usize>,
}

impl Selector {
    /// These components, counted from 0.
    #[must_use]
    pub fn new(indices: &[usize]) -> Self {
        Self { indices: indices.to_vec() }
    }
}

impl Described for Selector {
    const KIND: &'static Kind = &Kind {
        name: "selector",
        group: Group::Routing,
        summary: "Takes components of a vector, in any order and as often as wanted.",
        equation: "y = [u[i₀], u[i₁], …], i = indices",
        parameters: &[Parameter::required("indices", Takes::Numbers, "which components, counted from 0")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let indices = p.numbers("indices");
        if let Some(bad) = indices.iter().find(|x| x.fract() != 0.0 || !(0.0..1e6).contains(*x)) {
            p.fault("indices", format!("`indices` has {bad}"), "indices are whole numbers from 0 on");
        }
        Self { indices: indices.iter().map(|x| *x as usize).collect() }
    }
}

impl Block for Selector {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let beyond = |width: usize| self.indices.iter().find(|index| **index >= width);
        match inputs[0].and_then(|width| beyond(width).map(|index| (width, index))) {
            Some((width, index)) => {
                Err(format!("there is no component {index}: the input has {width}, counted from 0"))
            }
            None => Ok(vec![Some(self.indices.len())]),
        }
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

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

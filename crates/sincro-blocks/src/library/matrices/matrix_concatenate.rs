//! `y = [U1 U2 …]`: matrices side by side.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::maths::n_inputs;
use crate::reader::Reader;

/// Puts matrices with the same number of rows side by side. (One below the other is a `mux`: they are held row by row.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MatrixConcatenate {
    rows: usize,
    n_inputs: usize,
}

impl MatrixConcatenate {
    /// So many matrices of so many rows.
    ///
    /// # Panics
    ///
    /// If either is 0.
    #[must_use]
    pub fn new(rows: usize, n_inputs: usize) -> Self {
        assert!(rows > 0 && n_inputs > 0, "nothing to put side by side");
        Self { rows, n_inputs }
    }
}

impl Described for MatrixConcatenate {
    const KIND: &'static Kind = &Kind {
        name: "matrix-concatenate",
        group: Group::Matrices,
        summary: "Puts matrices of as many rows side by side; one below the other is a `mux`.",
        equation: "y = [U1 U2 …], all row by row",
        parameters: &[
            Parameter::required("rows", Takes::Count, "number of rows of every input and of y"),
            Parameter::optional("inputs", Takes::Count, "number of inputs", "2"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { rows: p.positive_count("rows"), n_inputs: n_inputs(p) }
    }
}

impl Block for MatrixConcatenate {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(self.n_inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        for (k, width) in inputs.iter().enumerate() {
            if let Some(width) = width
                && width % self.rows != 0
            {
                return Err(format!("input {} has {width} components: no matrix of {} rows", k + 1, self.rows));
            }
        }
        Ok(vec![inputs.iter().copied().sum()])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let columns = y.len() / self.rows;
        for (i, row) in y.chunks_exact_mut(columns).enumerate() {
            let mut rest = row;
            for k in 0..self.n_inputs {
                let width = at.node.inputs[k] / self.rows;
                let (piece, after) = rest.split_at_mut(width);
                piece.copy_from_slice(&at.input(k)[i * width..(i + 1) * width]);
                rest = after;
            }
        }
    }

    fn label(&self) -> String {
        "[U1 U2]".into()
    }
}

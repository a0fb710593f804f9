//! `y = K·u`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::{Matrix, Reader};

/// Multiplies a vector by a constant matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct MatrixGain {
    /// A row for every output component, a column for every input component.
    pub gain: Matrix,
}

impl MatrixGain {
    /// From its rows.
    ///
    /// # Panics
    ///
    /// If they are not of one length.
    #[must_use]
    pub fn new(rows: &[&[f64]]) -> Self {
        Self { gain: Matrix::from_rows(rows) }
    }
}

impl Described for MatrixGain {
    const KIND: &'static Kind = &Kind {
        name: "matrix-gain",
        group: Group::Maths,
        summary: "Multiplies a vector by a constant matrix.",
        equation: "y = K·u, K = gain",
        parameters: &[Parameter::required(
            "gain",
            Takes::Matrix,
            "matrix: a row for every component of y, a column for every component of u; one list of numbers is one row",
        )],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let gain = p.matrix("gain");
        if gain.columns == 0 {
            p.fault("gain", "the matrix is empty", "give rows such as [[1, 0], [0, 1]]");
        }
        Self { gain }
    }
}

impl Block for MatrixGain {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        match inputs[0] {
            Some(width) if width != self.gain.columns => {
                Err(format!("the matrix has {} columns, the input {width} components", self.gain.columns))
            }
            _ => Ok(vec![Some(self.gain.rows)]),
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let products = at.input(0).iter().enumerate().map(|(k, u)| R::splat(self.gain.at(i, k)) * *u);
            *y = products.fold(R::zero(), |sum, product| sum + product);
        }
    }

    fn label(&self) -> String {
        "K·u".into()
    }
}

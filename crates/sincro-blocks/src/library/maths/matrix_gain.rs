//! Block `matrix-gain`.

use crate::library::prelude::*;

declare_block! {
    /// Multiplies a vector by a constant matrix.
    pub struct MatrixGain("matrix-gain", Maths): "y = K·u, K = gain" {
        /// Matrix: a row for every component of y, a column for every component of u; one list of numbers is one row.
        pub gain: Matrix as Rows,
    }
}

impl MatrixGain {
    /// Creates the block from its rows.
    ///
    /// # Panics
    ///
    /// If they are not of one length.
    #[must_use]
    pub fn new(rows: &[&[f64]]) -> Self {
        Self { gain: Matrix::from_rows(rows) }
    }
}

impl Block for MatrixGain {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.gain.columns == 0 {
            p.fault("gain", "the matrix is empty", "give rows such as [[1, 0], [0, 1]]");
        }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        match inputs[0] {
            Some(width) if width != self.gain.columns => {
                Err(format!("the matrix has {} columns, the input {width} components", self.gain.columns))
            }
            _ => Ok(vec![Some(self.gain.rows)]),
        }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::zero();
            for (k, u) in at.input(0).iter().enumerate() {
                *y += R::splat(self.gain.at(i, k)) * *u;
            }
        }
    }

    fn label(&self) -> String {
        "K·u".into()
    }
}

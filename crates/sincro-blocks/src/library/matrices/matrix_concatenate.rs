//! Block `matrix-concatenate`.

use crate::library::prelude::*;

declare_block! {
    /// Puts matrices of as many rows side by side; one below the other is a `mux`.
    pub struct MatrixConcatenate("matrix-concatenate", Matrices): "y = [U1 U2 …], all row by row" {
        /// Number of rows of every input and of y.
        rows: usize as PositiveCount,
        /// Number of inputs.
        pub inputs: usize as InputCount = "2",
    }
}

impl MatrixConcatenate {
    /// So many matrices of so many rows.
    ///
    /// # Panics
    ///
    /// If either is 0.
    #[must_use]
    pub fn new(rows: usize, inputs: usize) -> Self {
        assert!(rows > 0 && inputs > 0, "nothing to put side by side");
        Self { rows, inputs }
    }
}

impl Block for MatrixConcatenate {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
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

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let columns = y.len() / self.rows;
        for (i, row) in y.chunks_exact_mut(columns).enumerate() {
            let mut rest = row;
            for k in 0..self.inputs {
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

//! Block `matrix-product`.

use crate::library::prelude::*;

declare_block! {
    /// Multiplies a matrix by a matrix or vector, both signals; a matrix comes row by row.
    pub struct MatrixProduct("matrix-product", Matrices): "y = A·B, or y = Aᵀ·B if transposed" {
        /// Number of rows of A as it comes.
        rows: usize as PositiveCount,
        /// Takes Aᵀ in place of A.
        transposed: bool as Flag = "false",
    }
}

impl MatrixProduct {
    /// Creates the block with so many rows of the first factor as it comes, taken transposed or not.
    ///
    /// # Panics
    ///
    /// If there are no rows.
    #[must_use]
    pub fn new(rows: usize, transposed: bool) -> Self {
        assert!(rows > 0, "a matrix has a row");
        Self { rows, transposed }
    }

    /// Rows and columns of the first factor as it is multiplied.
    fn shape(&self, width: usize) -> (usize, usize) {
        let columns = width / self.rows;
        if self.transposed { (columns, self.rows) } else { (self.rows, columns) }
    }
}

impl Block for MatrixProduct {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::new(&["a", "b"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let Some(a) = inputs[0] else { return Ok(vec![None]) };
        if a % self.rows != 0 {
            return Err(format!("`a` has {a} components: no matrix of {} rows", self.rows));
        }
        let (rows, columns) = self.shape(a);
        match inputs[1] {
            None => Ok(vec![None]),
            Some(b) if b % columns != 0 => {
                let name = if self.transposed { "aᵀ" } else { "a" };
                Err(format!("`{name}` is {rows} × {columns}, `b` has {b} components: no matrix of {columns} rows"))
            }
            Some(b) => Ok(vec![Some(rows * (b / columns))]),
        }
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::SumOfProducts
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (a, b) = (at.input(0), at.input(1));
        let (rows, inner) = self.shape(a.len());
        let columns = b.len() / inner;
        // a[i, k] of the factor as it is multiplied
        let (down, along) = if self.transposed { (1, rows) } else { (inner, 1) };
        for (i, row) in y.chunks_exact_mut(columns).enumerate() {
            for (j, y) in row.iter_mut().enumerate() {
                *y = R::zero();
                for k in 0..inner {
                    *y += a[i * down + k * along] * b[k * columns + j];
                }
            }
        }
    }

    fn label(&self) -> String {
        if self.transposed { "Aᵀ·B" } else { "A·B" }.into()
    }
}

//! Block `lookup-table-2d`.

use super::table::{Extrapolation, check_breakpoints, interval};
use crate::library::prelude::*;

declare_block! {
    /// A function of two arguments given by points on a grid, bilinear in between.
    ///
    /// Vectors are taken component by component.
    pub struct LookupTable2d("lookup-table-2d", Nonlinear): "y = values(u1, u2), bilinear between breakpoints" {
        /// Values of u1 for the rows, rising.
        pub row_breakpoints: Vec<f64> as List,
        /// Values of u2 for the columns, rising.
        pub column_breakpoints: Vec<f64> as List,
        /// A row for every row breakpoint.
        pub values: Matrix as Rows,
        /// Beyond the ends: the value there, or the line through the last two points.
        pub extrapolation: Extrapolation as Choice = "hold",
    }
}

impl LookupTable2d {
    /// Value and derivatives by both arguments.
    fn at(&self, u1: f64, u2: f64) -> (f64, f64, f64) {
        let (i, r, by_u1) = interval(&self.row_breakpoints, u1, self.extrapolation);
        let (k, c, by_u2) = interval(&self.column_breakpoints, u2, self.extrapolation);
        let (i2, k2) = ((i + 1).min(self.values.rows - 1), (k + 1).min(self.values.columns - 1));
        let (v11, v12) = (self.values.at(i, k), self.values.at(i, k2));
        let (v21, v22) = (self.values.at(i2, k), self.values.at(i2, k2));
        let (upper, lower) = (v11 + c * (v12 - v11), v21 + c * (v22 - v21));
        let by_c = (v12 - v11) + r * ((v22 - v21) - (v12 - v11));
        (upper + r * (lower - upper), (lower - upper) * by_u1, by_c * by_u2)
    }
}

impl Block for LookupTable2d {
    type Work<R: Real> = ();

    fn validate(&mut self, p: &mut Reader<'_>) {
        let (rows, columns) = (&self.row_breakpoints, &self.column_breakpoints);
        let is_rising =
            check_breakpoints(p, "row_breakpoints", rows) & check_breakpoints(p, "column_breakpoints", columns);
        let (r, c) = (self.values.rows, self.values.columns);
        if (r, c) != (rows.len(), columns.len()) {
            let message = format!("`values` is {r} × {c}, the breakpoints are {} × {}", rows.len(), columns.len());
            let help = "give a row for every row breakpoint, with a number for every column breakpoint";
            p.fault("values", message, help);
        } else if is_rising {
            return;
        }
        // what stands for a table with errors
        self.values = Matrix::from_rows(&[&[0.0]]);
        (self.row_breakpoints, self.column_breakpoints) = (vec![0.0], vec![0.0]);
    }

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i).map2(at.component(1, i), |u1, u2| self.at(u1, u2));
        }
    }
}

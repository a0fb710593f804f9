//! `y = values(u1, u2)`, interpolated between breakpoints of both.

use sincro_math::Real;

use super::table::{EXTRAPOLATION, Extrapolation, check_breakpoints, interval};
use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::{Matrix, Reader};

/// A function of two arguments given by points on a grid, bilinear in between. Vectors are taken component by component.
#[derive(Clone, Debug, PartialEq)]
pub struct LookupTable2d {
    /// Values of `u1` for the rows, rising.
    pub row_breakpoints: Vec<f64>,
    /// Values of `u2` for the columns, rising.
    pub column_breakpoints: Vec<f64>,
    /// Values at the points of the grid.
    pub values: Matrix,
    /// Beyond the ends.
    pub extrapolation: Extrapolation,
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

impl Described for LookupTable2d {
    const KIND: &'static Kind = &Kind {
        name: "lookup-table-2d",
        group: Group::Nonlinear,
        summary: "A function of two arguments given by points on a grid, bilinear in between.",
        equation: "y = values(u1, u2), bilinear between breakpoints",
        parameters: &[
            Parameter::required("row_breakpoints", Takes::Numbers, "values of u1 for the rows, rising"),
            Parameter::required("column_breakpoints", Takes::Numbers, "values of u2 for the columns, rising"),
            Parameter::required("values", Takes::Matrix, "a row for every row breakpoint"),
            EXTRAPOLATION,
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let (rows, columns) = (p.numbers("row_breakpoints"), p.numbers("column_breakpoints"));
        let values = p.matrix("values");
        let extrapolation = Extrapolation::read(p);
        let rises =
            check_breakpoints(p, "row_breakpoints", &rows) & check_breakpoints(p, "column_breakpoints", &columns);
        if (values.rows, values.columns) != (rows.len(), columns.len()) {
            let (r, c) = (values.rows, values.columns);
            let message = format!("`values` is {r} × {c}, the breakpoints are {} × {}", rows.len(), columns.len());
            p.fault(
                "values",
                message,
                "give a row for every row breakpoint, with a number for every column breakpoint",
            );
        } else if rises {
            return Self { row_breakpoints: rows, column_breakpoints: columns, values, extrapolation };
        }
        let values = Matrix::from_rows(&[&[0.0]]);
        Self { row_breakpoints: vec![0.0], column_breakpoints: vec![0.0], values, extrapolation }
    }
}

impl Block for LookupTable2d {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i).map2(at.component(1, i), |u1, u2| self.at(u1, u2));
        }
    }
}

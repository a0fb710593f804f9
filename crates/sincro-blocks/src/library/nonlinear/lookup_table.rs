//! `y = values(u)`, interpolated between breakpoints.

use super::table::{Extrapolation, check_breakpoints, interval};
use crate::library::prelude::*;

/// Block `lookup-table`: function of one variable given by points, written down or from two columns of a CSV file. A
/// vector is processed component by component.
#[derive(Clone, Debug, PartialEq)]
pub struct LookupTable {
    /// Arguments of the points, strictly increasing, in the unit of the input.
    pub breakpoints: Vec<f64>,
    /// Values at the points, as many as `breakpoints`, in the unit of the output.
    pub values: Vec<f64>,
    /// Interpolation between the points.
    pub interpolation: Interpolation,
    /// Extrapolation beyond the ends; only for linear interpolation.
    pub extrapolation: Extrapolation,
}

choice! {
    /// Values between the points of a table.
    pub enum Interpolation {
        /// The line between both.
        Linear = "linear",
        /// The value of the nearer one; in the middle, of the upper one.
        Nearest = "nearest",
        /// The value of the lower one.
        Previous = "previous",
    }
}

impl LookupTable {
    /// Creates the block with linear interpolation between the points (`breakpoints[k]`, `values[k]`), in the units of
    /// input and output; held beyond the ends.
    ///
    /// # Panics
    ///
    /// If the breakpoints do not increase, or are none, or not as many as the values.
    #[must_use]
    pub fn new(breakpoints: &[f64], values: &[f64]) -> Self {
        assert!(!values.is_empty() && breakpoints.len() == values.len(), "a value for every breakpoint");
        assert!(breakpoints.windows(2).all(|pair| pair[0] < pair[1]), "rising breakpoints");
        Self {
            breakpoints: breakpoints.to_vec(),
            values: values.to_vec(),
            interpolation: Interpolation::Linear,
            extrapolation: Extrapolation::Hold,
        }
    }

    /// Value and slope.
    fn at(&self, u: f64) -> (f64, f64) {
        let (k, part, rate) = interval(&self.breakpoints, u, self.extrapolation);
        let low = self.values[k];
        let high = self.values[(k + 1).min(self.values.len() - 1)];
        match self.interpolation {
            _ if part.is_nan() => (part, part),
            // the ends of an interval to the bit
            Interpolation::Linear if part == 1.0 => (high, (high - low) * rate),
            Interpolation::Linear => (low + (high - low) * part, (high - low) * rate),
            Interpolation::Nearest => (if part < 0.5 { low } else { high }, 0.0),
            Interpolation::Previous => (if part < 1.0 { low } else { high }, 0.0),
        }
    }
}

impl Described for LookupTable {
    const KIND: &'static Kind = &Kind {
        name: "lookup-table",
        category: Category::Nonlinear,
        summary: "A function given by points, written down or from a CSV file.",
        equation: "y = values(u), interpolated between breakpoints",
        parameters: &[
            Parameter::optional("breakpoints", ValueKind::Numbers, "arguments of the points, rising", "[]"),
            Parameter::optional("values", ValueKind::Numbers, "values at the points", "[]"),
            Parameter::optional("file", ValueKind::File, "CSV file instead of `breakpoints` and `values`", ""),
            Parameter::optional("breakpoints_column", ValueKind::Text, "column of the file with the arguments", "x"),
            Parameter::optional("values_column", ValueKind::Text, "column of the file with the values", "y"),
            Parameter::optional(
                "interpolation",
                ValueKind::Choice(Interpolation::WORDS),
                "value between the points",
                "linear",
            ),
            Parameter::optional(
                "extrapolation",
                ValueKind::Choice(Extrapolation::WORDS),
                "beyond the ends: the value there, or the line through the last two points",
                "hold",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let interpolation = <Choice as ParameterType<Interpolation>>::read(p, "interpolation");
        let extrapolation = <Choice as ParameterType<Extrapolation>>::read(p, "extrapolation");
        let (breakpoints, values) = points(p);
        if breakpoints.len() != values.len() {
            let message = format!("there are {} breakpoints and {} values", breakpoints.len(), values.len());
            p.fault("values", message, "give a value for every breakpoint");
        } else if !breakpoints.is_empty() && check_breakpoints(p, "breakpoints", &breakpoints) {
            return Self { breakpoints, values, interpolation, extrapolation };
        }
        Self::new(&[0.0], &[0.0])
    }
}

/// Breakpoints and values, from the parameters or from a file; empty after a fault.
fn points(p: &mut Reader<'_>) -> (Vec<f64>, Vec<f64>) {
    let is_written = p.has("breakpoints") || p.has("values");
    let (file, of_breakpoints, of_values) = (p.text("file"), p.text("breakpoints_column"), p.text("values_column"));
    if !p.has("file") {
        return (p.numbers("breakpoints"), p.numbers("values"));
    }
    if is_written {
        p.fault("file", "both a file and points are given", "leave `file`, or `breakpoints` and `values` out");
    }
    let breakpoints = p.column("file", &file, &of_breakpoints);
    (breakpoints, p.column("file", &file, &of_values))
}

impl Block for LookupTable {
    type Work<R: Real> = ();

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i).map(|u| self.at(u));
        }
    }
}

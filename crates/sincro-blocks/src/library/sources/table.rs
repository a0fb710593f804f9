//! `y = values(t)`: given at instants, in between linear or held, constant outside.

use super::cycle::Cycle;
use crate::library::prelude::*;

/// Block `table` of sources: signal given at instants, as lists or as columns of a CSV file; constant before the first
/// and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Instants `[s]`, strictly increasing.
    pub times: Vec<f64>,
    /// Values in the unit of the output: a row for each instant, a column for each component.
    pub values: Matrix,
    /// True to hold a value until the next instant, false for linear interpolation.
    pub hold: bool,
    /// Period `[s]`, counted from the first instant, after which the table begins anew; infinite for no repetition.
    pub repeat: f64,
}

impl Table {
    /// Creates a scalar signal from its values (in the unit of the output) at the increasing `times` `[s]`, with linear
    /// interpolation.
    ///
    /// # Panics
    ///
    /// If there are no values, or not as many as times.
    #[must_use]
    pub fn new(times: &[f64], values: &[f64]) -> Self {
        assert!(times.len() == values.len() && !times.is_empty(), "a value for every instant");
        let values = Matrix { rows: values.len(), columns: 1, entries: values.to_vec() };
        Self { times: times.to_vec(), values, hold: false, repeat: f64::INFINITY }
    }

    fn cycle(&self) -> Cycle {
        Cycle { start: self.times[0], period: self.repeat }
    }

    /// The instant whose values hold at `t`.
    fn folded(&self, t: f64) -> f64 {
        if self.repeat.is_infinite() {
            return t;
        }
        self.times[0] + self.cycle().phase(t).unwrap_or(0.0)
    }

    /// Times and values as lists.
    fn lists(p: &mut Reader<'_>) -> (Vec<f64>, Matrix) {
        refuse(
            p,
            &["time_column", "columns"],
            "without `file`",
            "give the `file` that has it, instead of `times` and `values`",
        );
        let (times, mut values) = (p.numbers("times"), p.matrix("values"));
        // a plain list is one component over time
        if values.rows == 1 && values.columns == times.len() {
            values = Matrix { rows: times.len(), columns: 1, entries: values.entries };
        }
        if values.rows != times.len() || values.columns == 0 {
            let message = format!("`values` has {} rows for {} times", values.rows, times.len());
            p.fault("values", message, "give a number, or a list of numbers, for every time");
        }
        (times, values)
    }

    /// Times and values from a CSV file.
    fn columns(p: &mut Reader<'_>) -> (Vec<f64>, Matrix) {
        refuse(p, &["times", "values"], "beside `file`", "give either lists or a file");
        let (file, time, names) = (p.text("file"), p.text("time_column"), p.texts("columns"));
        if names.is_empty() {
            p.fault("columns", "no column is named", "give columns = [\"…\"]: one for every component");
        }
        let times = p.column("time_column", &file, &time);
        let columns: Vec<Vec<f64>> = names.iter().map(|name| p.column("columns", &file, name)).collect();
        let mut entries = Vec::with_capacity(times.len() * columns.len());
        for i in 0..times.len() {
            // a column that could not be read has been noted
            entries.extend(columns.iter().map(|column| column.get(i).copied().unwrap_or(f64::NAN)));
        }
        (times.clone(), Matrix { rows: times.len(), columns: columns.len(), entries })
    }

    fn check(&self, key: &str, p: &mut Reader<'_>) {
        if self.times.is_empty() {
            return p.fault(key, "the table has no rows", "give at least one");
        }
        if let Some(k) = self.times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let message = format!("the time {} s comes after {} s", self.times[k + 1], self.times[k]);
            p.fault(key, message, "times must increase from row to row");
        }
        if self.times.iter().chain(&self.values.entries).any(|x| !x.is_finite()) {
            p.fault(key, "the table has a number that is not finite", "every row must have all its numbers");
        }
        let length = self.times[self.times.len() - 1] - self.times[0];
        if self.repeat < length {
            let message = format!("`repeat` is {} s, the table is {length} s long", self.repeat);
            p.fault("repeat", message, "it must be at least as long as the table");
        }
    }
}

/// Faults for parameters that would be passed over.
fn refuse(p: &mut Reader<'_>, keys: &[&str], wherever: &str, help: &str) {
    for key in keys {
        if p.has(key) {
            p.fault(key, format!("`{key}` is given {wherever}"), help);
        }
    }
}

impl Described for Table {
    const KIND: &'static Kind = &Kind {
        name: "table",
        category: Category::Sources,
        summary: "A signal that is given at instants, as lists or as columns of a CSV file.",
        equation: "y = values at times; in between linear or held, outside constant",
        parameters: &[
            Parameter::optional("times", ValueKind::Numbers, "instants, increasing [s]; with `values`", "[]"),
            Parameter::optional("values", ValueKind::Matrix, "for every time a number, or a row of components", "[]"),
            Parameter::optional("file", ValueKind::File, "a CSV file, instead of `times` and `values`", "none"),
            Parameter::optional("time_column", ValueKind::Text, "column of the times [s] in the file", "t"),
            Parameter::optional("columns", ValueKind::Texts, "columns of the components in the file", "[]"),
            Parameter::optional(
                "interpolation",
                ValueKind::Choice(&["linear", "hold"]),
                "between two times: the line between the values, or the former value",
                "linear",
            ),
            Parameter::optional(
                "repeat",
                ValueKind::Number,
                "begins anew every so many seconds after the first time [s]",
                "inf",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let hold = p.choice("interpolation") == 1;
        let repeat = p.limit("repeat");
        if repeat <= 0.0 {
            p.fault("repeat", format!("`repeat` is {repeat}"), "it must be greater than 0");
        }
        let (key, (times, values)) = match (p.has("file"), p.has("times")) {
            (true, _) => ("file", Self::columns(p)),
            (false, true) => ("times", Self::lists(p)),
            (false, false) => {
                let help = "give times = […] and values = […], or file = \"….csv\"";
                p.fault("times", "`table` has neither `times` nor `file`", help);
                return Self::new(&[0.0], &[0.0]);
            }
        };
        let new = Self { times, values, hold, repeat };
        new.check(key, p);
        new
    }
}

impl Block for Table {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(self.values.columns)])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let t = self.folded(at.time());
        // rows up to `next` are past; an instant that rounding puts just after `t` counts as reached
        let next = self.times.partition_point(|time| *time <= t + SAME_INSTANT);
        let (before, after) = (next.saturating_sub(1), next.min(self.times.len() - 1));
        let share = if self.hold || before == after {
            0.0
        } else {
            ((t - self.times[before]) / (self.times[after] - self.times[before])).max(0.0)
        };
        for (i, y) in y.iter_mut().enumerate() {
            let (from, to) = (self.values.at(before, i), self.values.at(after, i));
            *y = R::splat(if share == 0.0 { from } else { from + share * (to - from) });
        }
    }

    fn next_time_event(&self, t: f64) -> f64 {
        let folded = self.folded(t);
        let next = self.times.partition_point(|time| *time <= folded + SAME_INSTANT);
        match self.times.get(next) {
            Some(_) if t + SAME_INSTANT < self.times[0] => self.times[0],
            Some(time) => t + (time - folded),
            None if self.repeat.is_finite() => self.cycle().next(t, 0.0),
            None => f64::INFINITY,
        }
    }

    /// Frequency of the component that turns fastest; between ticks its corners are time events.
    fn highest_frequency(&self, until: f64, is_sampled: bool) -> f64 {
        if !is_sampled {
            return 0.0;
        }
        let of = |i| sincro_math::series::highest_frequency(&self.times, |k| self.values.at(k, i), until);
        (0..self.values.columns).map(of).fold(0.0, f64::max)
    }
}

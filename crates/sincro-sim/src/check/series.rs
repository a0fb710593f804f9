//! The series that a check compares, taken from the recorded columns.

use sincro_math::expression::Expression;

use super::along::Along;
use super::rows::Rows;
use crate::table::Column;
use sincro_scene::experiment::check::{Check, Expected, Subject};

/// A check with the columns it names.
pub(super) struct Source<'a> {
    check: &'a Check,
    along: &'a Along<'a>,
    /// The columns of the aliases, in their order.
    aliases: Vec<&'a Column>,
    /// Which of the check's parameters is the one that the sweep varies.
    swept: Option<usize>,
}

impl<'a> Source<'a> {
    /// Finds the columns.
    pub(super) fn new(check: &'a Check, along: &'a Along<'a>) -> Result<Self, String> {
        let aliases: Result<_, _> = check.aliases.iter().map(|(_, signal)| column(along, &signal.value)).collect();
        let key = along.table.columns[0].name.as_str();
        let swept = key.strip_prefix("parameters.").filter(|_| along.is_sweep());
        let swept = swept.and_then(|swept| check.parameters.iter().position(|(name, _)| name == swept));
        Ok(Self { check, along, aliases: aliases?, swept })
    }

    /// Returns true if the measured values are means over the steps that end at the rows, or come from such alone.
    pub(super) fn has_step_means(&self) -> bool {
        let is_mean = |name: &str| {
            let whole = [".x", ".y", ".z"].iter().find_map(|axis| name.strip_suffix(axis)).unwrap_or(name);
            whole.ends_with(".motor_torque") || whole.ends_with(".motor_force")
        };
        match &self.check.what {
            Subject::Signal(name) => is_mean(&name.value),
            Subject::Formula(_) => {
                let aliases = &self.check.aliases;
                !aliases.is_empty() && aliases.iter().all(|(_, signal)| is_mean(&signal.value))
            }
        }
    }

    /// Measured values in the given rows.
    pub(super) fn measured(&self, row_idxs: &[usize]) -> Result<Vec<f64>, String> {
        match &self.check.what {
            Subject::Signal(name) => {
                let column = column(self.along, &name.value)?;
                Ok(row_idxs.iter().map(|row_idx| column.values[*row_idx]).collect())
            }
            Subject::Formula(formula) => self.formula(formula, row_idxs),
        }
    }

    /// Expected values in the given rows.
    pub(super) fn expected(&self, rows: &Rows) -> Result<Vec<f64>, String> {
        match (&self.check.expected, &rows.reference) {
            (Expected::Value(value), _) => Ok(vec![*value; rows.idxs.len()]),
            (Expected::Formula(formula), _) => self.formula(formula, &rows.idxs),
            (Expected::Reference(_), Some(values)) => Ok(values.clone()),
            (Expected::Reference(_), None) => unreachable!("rows of a check with a reference have its values"),
        }
    }

    /// Expected value, if it is the same in all rows.
    pub(super) fn expected_number(&self, rows: &Rows) -> Result<Option<f64>, String> {
        match &self.check.expected {
            Expected::Value(value) => Ok(Some(*value)),
            Expected::Formula(formula) if !self.varies(formula) => Ok(Some(self.formula(formula, &rows.idxs[..1])?[0])),
            Expected::Formula(_) | Expected::Reference(_) => Ok(None),
        }
    }

    /// A formula in the given rows.
    pub(super) fn formula(&self, formula: &Expression, row_idxs: &[usize]) -> Result<Vec<f64>, String> {
        let t_slot = self.aliases.len();
        if self.along.is_sweep() && formula.uses(t_slot) {
            return Err(format!("`{formula}` depends on `t`, which the final values of a sweep do not have"));
        }
        let mut slots = self.check.values(&vec![0.0; t_slot], 0.0);
        let mut stack = formula.scratch();
        let value = |row_idx: &usize| {
            for (slot, column) in slots.iter_mut().zip(&self.aliases) {
                *slot = column.values[*row_idx];
            }
            let key = self.along.keys()[*row_idx];
            slots[t_slot] = key;
            if let Some(parameter) = self.swept {
                slots[t_slot + 1 + parameter] = key;
            }
            formula.eval(&slots, &mut stack)
        };
        Ok(row_idxs.iter().map(value).collect())
    }

    /// Returns true if a formula can differ from row to row.
    fn varies(&self, formula: &Expression) -> bool {
        let t_slot = self.aliases.len();
        (0..=t_slot).any(|slot| formula.uses(slot)) || self.swept.is_some_and(|k| formula.uses(t_slot + 1 + k))
    }
}

fn column<'a>(along: &Along<'a>, name: &str) -> Result<&'a Column, String> {
    along.table.column(name).ok_or_else(|| format!("`{name}` is not recorded"))
}

/// The recorded signal that a check measures as it is: named outright, or by a formula that is nothing but its alias.
pub(super) fn plain_signal(check: &Check) -> Option<&str> {
    match &check.what {
        Subject::Signal(name) => Some(&name.value),
        Subject::Formula(formula) => {
            let alias = |(alias, _): &&(String, _)| alias == formula.text().trim();
            check.aliases.iter().find(alias).map(|(_, signal)| signal.value.as_str())
        }
    }
}

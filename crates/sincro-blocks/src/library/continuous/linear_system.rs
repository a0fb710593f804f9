//! The four matrices of a linear system, with their sizes checked.

use sincro_math::Real;

use crate::block::{At, of};
use crate::reader::{Matrix, Reader};

/// Linear system by its four matrices, `x' = a x + b u`, `y = c x + d u` (or, discrete, `x[k+1] = a x + b u`), for the
/// blocks [`StateSpace`](super::StateSpace) and `DiscreteStateSpace`. Entries have the units that states, inputs and
/// outputs give them; with n states, m inputs, p outputs:
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSystem {
    /// System matrix, n × n.
    pub a: Matrix,
    /// Input matrix, n × m.
    pub b: Matrix,
    /// Output matrix, p × n.
    pub c: Matrix,
    /// Feedthrough matrix, p × m.
    pub d: Matrix,
    /// Initial states, one number for all or one for each (n), in the units of the states.
    pub initial: Vec<f64>,
}

impl LinearSystem {
    /// Creates a system of the four matrices, with initial states of zero.
    ///
    /// # Errors
    ///
    /// A message that names the matrix whose size does not fit.
    pub fn new(a: Matrix, b: Matrix, c: Matrix, d: Matrix) -> Result<Self, String> {
        let new = Self { a, b, c, d, initial: vec![0.0] };
        match new.misfit() {
            None => Ok(new),
            Some((_, words)) => Err(words),
        }
    }

    /// Reads the parameters `a`, `b`, `c`, `d` and `initial`.
    pub(in crate::library) fn read(p: &mut Reader<'_>) -> Self {
        let (a, b, c) = (p.matrix("a"), p.matrix("b"), p.matrix("c"));
        // a list is a row; with one input, b may be written as one
        let b = if b.rows == 1 && a.rows == b.columns { Matrix { rows: b.columns, columns: 1, ..b } } else { b };
        let zeros = Matrix { rows: c.rows, columns: b.columns, entries: vec![0.0; c.rows * b.columns] };
        let d = if p.has("d") { p.matrix("d") } else { zeros };
        let new = Self { a, b, c, d, initial: p.numbers("initial") };
        if let Some((key, words)) = new.misfit() {
            p.fault(key, words, "with n states, m inputs and p outputs a is n × n, b n × m, c p × n and d p × m");
            return Self::zero();
        }
        new
    }

    fn zero() -> Self {
        let zero = || Matrix::from_rows(&[&[0.0]]);
        Self { a: zero(), b: zero(), c: zero(), d: zero(), initial: vec![0.0] }
    }

    /// The matrix that does not fit, and why.
    fn misfit(&self) -> Option<(&'static str, String)> {
        let (a, b, c, d) = (&self.a, &self.b, &self.c, &self.d);
        let size = |name: &str, m: &Matrix| format!("`{name}` is {} × {}", m.rows, m.columns);
        if a.rows != a.columns {
            return Some(("a", format!("{}: it must be square", size("a", a))));
        }
        if b.rows != a.rows {
            return Some(("b", format!("{}, {}: both need a row for each state", size("b", b), size("a", a))));
        }
        if c.columns != a.rows {
            return Some(("c", format!("{}, {}: both need a column for each state", size("c", c), size("a", a))));
        }
        if (d.rows, d.columns) != (c.rows, b.columns) {
            let words = format!("{}, it must be {} × {} as `c` and `b` have it", size("d", d), c.rows, b.columns);
            return Some(("d", words));
        }
        if self.initial.len() != 1 && self.initial.len() != a.rows {
            let words = format!("`initial` has {} numbers, {}", self.initial.len(), size("a", a));
            return Some(("initial", words));
        }
        None
    }

    /// Number of states n.
    #[must_use]
    pub fn n_states(&self) -> usize {
        self.a.rows
    }

    /// Returns true if an output depends on the present input (`d` is not zero).
    #[must_use]
    pub fn has_direct_feedthrough(&self) -> bool {
        self.d.entries.iter().any(|x| *x != 0.0)
    }

    /// Width of the output, the input being of width `input`.
    pub(in crate::library) fn width(&self, input: Option<usize>) -> Result<Vec<Option<usize>>, String> {
        match input {
            Some(width) if width != self.b.columns => {
                Err(format!("`u` has {width} components, `b` has {} columns", self.b.columns))
            }
            _ => Ok(vec![Some(self.c.rows)]),
        }
    }

    pub(in crate::library) fn start<R: Real>(&self, states: &mut [R]) {
        for (i, x) in states.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial, i));
        }
    }

    /// `y = c x + d u`; `u` is read only with direct feedthrough.
    #[inline(always)]
    pub(in crate::library) fn output<R: Real>(&self, at: &At<'_, R>, x: &[R], y: &mut [R]) {
        row_by_row(&self.c, x, y, false);
        if self.has_direct_feedthrough() {
            row_by_row(&self.d, at.input(0), y, true);
        }
    }

    /// `a x + b u`.
    #[inline(always)]
    pub(in crate::library) fn next<R: Real>(&self, at: &At<'_, R>, x: &[R], next: &mut [R]) {
        row_by_row(&self.a, x, next, false);
        row_by_row(&self.b, at.input(0), next, true);
    }
}

/// `out = m x`, or `out += m x`.
#[inline(always)]
fn row_by_row<R: Real>(m: &Matrix, x: &[R], out: &mut [R], is_added: bool) {
    for (i, out) in out.iter_mut().enumerate() {
        let mut sum = if is_added { *out } else { R::zero() };
        for (k, x) in x.iter().enumerate() {
            sum += R::splat(m.at(i, k)) * *x;
        }
        *out = sum;
    }
}

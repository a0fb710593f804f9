//! Invariant zeros of one channel: the frequencies that do not get from an input to an output. Cost: 10 n³ or so.
//!
//! Zeros are the finite `s` at which the pencil `[A − sI, b; c, d]` loses rank. While `d` is zero, the output equation
//! says that the state along `c` vanishes: a reflection turns `c` into one component, that component is struck out, and
//! the equation of its rate becomes the output equation of a system smaller by one. Once `d` is not zero, the zeros are
//! the eigenvalues of `A − b c / d` (key `emami1982`; with one input and one output its compressions of rows and
//! columns are single reflections).

use super::modes::eigenvalues;
use super::{Complex, DMatrix, DVector, LinearError, StateSpace};

/// Threshold of rounding relative to matrices of norm 1: such a `d` would put a zero at 10¹² times the fastest rate.
const NOTHING: f64 = 1e-12;

impl StateSpace {
    /// Returns the invariant zeros from input `input` to output `output` (indices from 0), ascending in modulus,
    /// without those at infinity: `[1/s]`, dimensionless of a sampled system. Of a mode that the input does not reach
    /// or the output does not see, the pole is a zero as well.
    ///
    /// # Errors
    ///
    /// [`LinearError::NoPath`]: the output does not depend on the input.
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    pub fn zeros(&self, input: usize, output: usize) -> Result<Vec<Complex<f64>>, LinearError> {
        let no_path = || LinearError::NoPath {
            input: self.inputs[input].name.clone(),
            output: self.outputs[output].name.clone(),
        };
        let d = self.d[(output, input)];
        let (b, c) = (self.b.column(input).into_owned(), self.c.row(output).transpose());
        let (size_b, size_c) = (b.norm(), c.norm());
        if size_b == 0.0 || size_c == 0.0 {
            return if d == 0.0 { Err(no_path()) } else { Ok(eigenvalues(&self.a)) };
        }
        // all norms become 1: units of input, output and time do not decide what is nothing
        let rate = if self.a.norm() > 0.0 { self.a.norm() } else { 1.0 };
        let channel = Channel { a: &self.a / rate, b: b / size_b, c: c / size_c, d: d * rate / (size_b * size_c) };
        let zeros = channel.zeros().ok_or_else(no_path)?;
        // relative to the system's own rates, less than rounding is zero
        let exact = |zero: Complex<f64>| {
            if zero.norm_sqr() <= NOTHING * NOTHING { Complex::new(0.0, 0.0) } else { zero * rate }
        };
        Ok(zeros.into_iter().map(exact).collect())
    }
}

/// One input, one output.
struct Channel {
    a: DMatrix<f64>,
    b: DVector<f64>,
    c: DVector<f64>,
    d: f64,
}

impl Channel {
    /// The zeros, or `None` if the transfer function is zero.
    fn zeros(mut self) -> Option<Vec<Complex<f64>>> {
        while self.d.abs() <= NOTHING {
            if self.a.is_empty() || self.c.norm() <= NOTHING {
                return None;
            }
            self = self.reduced();
        }
        Some(eigenvalues(&(&self.a - &self.b * self.c.transpose() / self.d)))
    }

    /// The channel without the state along `c`.
    fn reduced(self) -> Self {
        let last = self.a.nrows() - 1;
        // H = I − 2 w wᵀ takes c to the last axis
        let mut w = self.c.clone();
        let size = w.norm();
        w[last] += if w[last] < 0.0 { -size } else { size };
        w /= w.norm();
        let mut a = self.a;
        let row = w.transpose() * &a;
        a -= &w * row * 2.0;
        let column = &a * &w;
        a -= column * w.transpose() * 2.0;
        let b = &self.b - &w * (2.0 * w.dot(&self.b));
        Self {
            c: a.row(last).columns(0, last).transpose(),
            d: b[last],
            b: b.rows(0, last).into_owned(),
            a: a.view((0, 0), (last, last)).into_owned(),
        }
    }
}

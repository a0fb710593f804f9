//! Analysis of linear systems: poles, zeros, frequency and step response, controllability, regulators, trim.
//!
//! [`StateSpace`] holds the four matrices of `ẋ = A x + B u`, `y = C x + D u` about an operating point, with the names
//! and units of their rows and columns. Everything else is derived from it and kept nowhere.
//!
//! The bits are the same on every machine: the matrix library is built without its vectorised kernels, and whatever is
//! not `+ − × ÷ √` goes through [`sincro_math::elementary`].

pub mod bode;
mod error;
mod loop_margins;
pub mod lqr;
pub mod lyapunov;
pub mod modes;
pub mod newton;
pub mod step;
pub mod structure;
mod zeros;

pub use bode::{Bode, Margin};
pub use error::LinearError;
pub use loop_margins::LoopMargins;
pub use lqr::{Regulator, dlqr, lqr};
pub use modes::{Mode, Stability};
pub use nalgebra::{Complex, DMatrix, DVector};
pub use step::{StepInfo, StepResponse};
pub use structure::SubspaceRank;

/// Name and unit of one state, input or output: the label of a row or column of the matrices of a [`StateSpace`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// let one = DMatrix::identity(1, 1);
/// let mut tank = StateSpace::from_matrices(-0.1 * &one, one.clone(), one.clone(), 0.0 * &one)?;
/// assert_eq!(tank.inputs[0], Axis::new("u1", ""));
/// tank.inputs[0] = Axis::new("/valve.flow", "m³/s");
/// assert_eq!(tank.inputs[0].name, "/valve.flow");
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// Name, the path of a signal such as `/cart/rail.position`, or `x1`, `u1`, `y1` where none was given.
    pub name: String,
    /// Unit as text, such as `m`; empty if dimensionless or unknown.
    pub unit: String,
}

impl Axis {
    /// Creates an axis of this name and unit (empty: dimensionless or unknown).
    #[must_use]
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// Linear system of `n` states, `m` inputs and `p` outputs: `ẋ = A x + B u`, `y = C x + D u`, all quantities as
/// differences from the operating point. Its methods compute poles, zeros, frequency and step responses;
/// [`crate::linearize::linearize`] makes one of a scene, [`StateSpace::from_matrices`] one of plain matrices.
///
/// Entry (i, k) of a matrix has the unit of its row (the rate of state i, or output i) per unit of its column (state or
/// input k).
///
/// ```
/// use sincro_analysis::linear::{DMatrix, StateSpace};
///
/// // a mass of 1 kg on a spring of 4 N/m: force in, position out
/// let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, 0.0]);
/// let b = DMatrix::from_row_slice(2, 1, &[0.0, 1.0]);
/// let c = DMatrix::from_row_slice(1, 2, &[1.0, 0.0]);
/// let system = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1)).unwrap();
/// assert!((system.poles()[0].natural_frequency - 2.0).abs() < 1e-12);
/// assert!((system.gain(0, 0).unwrap() - 0.25).abs() < 1e-15);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// System matrix A, `n×n`: row i is the rate of state i, column k its derivative by state k.
    pub a: DMatrix<f64>,
    /// Input matrix B, `n×m`: derivatives of the rates by the inputs.
    pub b: DMatrix<f64>,
    /// Output matrix C, `p×n`: derivatives of the outputs by the states.
    pub c: DMatrix<f64>,
    /// Feedthrough matrix D, `p×m`: derivatives of the outputs by the inputs.
    pub d: DMatrix<f64>,
    /// Names and units of the `n` states, in the order of the rows of A.
    pub states: Vec<Axis>,
    /// Names and units of the `m` inputs, in the order of the columns of B.
    pub inputs: Vec<Axis>,
    /// Names and units of the `p` outputs, in the order of the rows of C.
    pub outputs: Vec<Axis>,
    /// Time of the operating point `[s]`.
    pub t: f64,
    /// Sample time `[s]` of a discrete system `x⁺ = A x + B u`; `None`: the system is continuous.
    pub sample_time: Option<f64>,
}

impl StateSpace {
    /// Creates a continuous system of A (`n×n`), B (`n×m`), C (`p×n`) and D (`p×m`), with axes named `x1`, `u1`, `y1`
    /// and so on, without units, at `t` = 0.
    ///
    /// # Errors
    ///
    /// As [`StateSpace::check`].
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// // a velocity with friction: v' = −2 v + u, y = v
    /// let one = DMatrix::identity(1, 1);
    /// let system = StateSpace::from_matrices(-2.0 * &one, one.clone(), one.clone(), 0.0 * &one)?;
    /// assert_eq!((system.n_states(), system.n_inputs(), system.n_outputs()), (1, 1, 1));
    /// assert_eq!(system.gain(0, 0), Some(0.5));
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_matrices(
        a: DMatrix<f64>,
        b: DMatrix<f64>,
        c: DMatrix<f64>,
        d: DMatrix<f64>,
    ) -> Result<Self, LinearError> {
        let names = |letter: char, n: usize| (1..=n).map(|k| Axis::new(format!("{letter}{k}"), "")).collect();
        let (states, inputs, outputs) = (names('x', a.nrows()), names('u', b.ncols()), names('y', c.nrows()));
        let system = Self { a, b, c, d, states, inputs, outputs, t: 0.0, sample_time: None };
        system.check().map(|()| system)
    }

    /// Checks that the shapes of the matrices fit the numbers of states, inputs and outputs, and that all entries are
    /// finite; for systems whose public fields were changed.
    ///
    /// # Errors
    ///
    /// [`LinearError::Size`] or [`LinearError::NotFinite`] for the first matrix, in the order A, B, C, D, that fails.
    pub fn check(&self) -> Result<(), LinearError> {
        let (n, m, p) = (self.n_states(), self.n_inputs(), self.n_outputs());
        error::expect_size("A", &self.a, (n, n))?;
        error::expect_size("B", &self.b, (n, m))?;
        error::expect_size("C", &self.c, (p, n))?;
        error::expect_size("D", &self.d, (p, m))?;
        for (what, matrix) in [("A", &self.a), ("B", &self.b), ("C", &self.c), ("D", &self.d)] {
            error::expect_finite(what, matrix)?;
        }
        Ok(())
    }

    /// Returns the number of states, `n`.
    #[must_use]
    pub fn n_states(&self) -> usize {
        self.states.len()
    }

    /// Returns the number of inputs, `m`.
    #[must_use]
    pub fn n_inputs(&self) -> usize {
        self.inputs.len()
    }

    /// Returns the number of outputs, `p`.
    #[must_use]
    pub fn n_outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Returns the static gain from an input to an output `[unit of the output / unit of the input]`: `D − C A⁻¹ B`, or
    /// `D + C (I − A)⁻¹ B` of a sampled system. Modes that the input does not reach or the output does not see are left
    /// out. Meaningful for stable channels only; `None` if the channel integrates (has a pole at `s = 0`, or `z = 1`).
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    #[must_use]
    pub fn gain(&self, input: usize, output: usize) -> Option<f64> {
        let channel = self.minimal(input, output);
        let n = channel.n_states();
        let rest = match self.sample_time {
            None => -&channel.a,
            Some(_) => DMatrix::identity(n, n) - &channel.a,
        };
        if n == 0 {
            return Some(channel.d[0]);
        }
        if is_singular(&rest) {
            return None;
        }
        let x = rest.lu().solve(&channel.b)?;
        Some(channel.d[0] + (channel.c * x)[0])
    }
}

/// A row or column below this share of the largest entry is the rounding of a reduction, not a slow mode.
const ROUNDING: f64 = 1e-13;

/// Returns true if a square matrix is singular to working precision. Its rows are scaled first, so that units do not
/// decide.
fn is_singular(matrix: &DMatrix<f64>) -> bool {
    let mut scaled = matrix.clone();
    let largest = matrix.amax();
    for mut row in scaled.row_iter_mut() {
        let size = row.amax();
        if size <= ROUNDING * largest {
            return true;
        }
        row /= size;
    }
    for mut column in scaled.column_iter_mut() {
        let size = column.amax();
        if size <= ROUNDING {
            return true;
        }
        column /= size;
    }
    let sizes = scaled.singular_values();
    // what rounding leaves of a zero, for matrices of a hundred rows
    sizes.min() <= 1e-14 * sizes.max()
}

/// Modulus of a complex number.
fn modulus(z: Complex<f64>) -> f64 {
    sincro_math::elementary::hypot(z.re, z.im).0
}

#[cfg(test)]
mod tests;

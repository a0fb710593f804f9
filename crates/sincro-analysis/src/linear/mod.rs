//! Analysis of linear systems: poles, zeros, frequency and step response, controllability, regulators, trim.
//!
//! [`StateSpace`] holds the four matrices of `ẋ = A x + B u`, `y = C x + D u` about an operating point, with the names
//! and units of their rows and columns. Everything else is derived from it and kept nowhere.
//!
//! The bits are the same on every machine: the matrix library is built without its vectorised kernels, and whatever is
//! not `+ − × ÷ √` goes through [`sincro_math::elementary`].

pub mod bode;
mod error;
pub mod lqr;
pub mod lyapunov;
pub mod modes;
pub mod newton;
pub mod step;
pub mod structure;
mod zeros;

pub use bode::{Bode, Margin};
pub use error::LinearError;
pub use lqr::{Regulator, dlqr, lqr};
pub use modes::{Mode, Stability};
pub use nalgebra::{Complex, DMatrix, DVector};
pub use step::{StepInfo, StepResponse};
pub use structure::SubspaceRank;

/// Name and unit of a state, an input or an output.
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
    /// Its path: `/cart/rail.position`.
    pub name: String,
    /// Its unit: `m`; may be empty.
    pub unit: String,
}

impl Axis {
    /// An axis of that name and unit.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }
}

/// A linear system: `ẋ = A x + B u`, `y = C x + D u`, all quantities as differences from the operating point.
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
    /// `n×n`: how the states drive one another.
    pub a: DMatrix<f64>,
    /// `n×m`: how the inputs drive the states.
    pub b: DMatrix<f64>,
    /// `p×n`: how the outputs see the states.
    pub c: DMatrix<f64>,
    /// `p×m`: how the outputs see the inputs without delay.
    pub d: DMatrix<f64>,
    /// The `n` states.
    pub states: Vec<Axis>,
    /// The `m` inputs.
    pub inputs: Vec<Axis>,
    /// The `p` outputs.
    pub outputs: Vec<Axis>,
    /// Time of the operating point `[s]`.
    pub t: f64,
    /// `None`: continuous. Otherwise the system is `x⁺ = A x + B u` from tick to tick of that length `[s]`.
    pub sample_time: Option<f64>,
}

impl StateSpace {
    /// A continuous system of these matrices, with axes named `x1`, `u1`, `y1` and so on.
    ///
    /// # Errors
    ///
    /// The matrices do not fit one another.
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

    /// Checks that the sizes of matrices and names fit, and that all entries are finite.
    ///
    /// # Errors
    ///
    /// The first thing that does not.
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

    /// Number of states.
    #[must_use]
    pub fn n_states(&self) -> usize {
        self.states.len()
    }

    /// Number of inputs.
    #[must_use]
    pub fn n_inputs(&self) -> usize {
        self.inputs.len()
    }

    /// Number of outputs.
    #[must_use]
    pub fn n_outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Static gain from an input to an output `[unit of the output / unit of the input]`: `D − C A⁻¹ B`, or `D + C (I −
    /// A)⁻¹ B` if it is sampled; modes that the channel does not show do not count.
    ///
    /// `None`: the channel integrates.
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

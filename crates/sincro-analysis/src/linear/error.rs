//! Errors of the analysis of linear systems.

use std::fmt;

use super::DMatrix;

/// Error of an analysis of a linear system: matrices that do not fit, weights of the wrong sign, or a problem without a
/// solution. Its text (`Display`) is a message for the user.
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// let (a, b) = (DMatrix::identity(2, 2), DMatrix::from_row_slice(2, 1, &[1.0, 0.0]));
/// // the input reaches the first mode only, and the second grows
/// let error = lqr(&a, &b, &DMatrix::identity(2, 2), &DMatrix::identity(1, 1)).unwrap_err();
/// assert_eq!(error, LinearError::NotStabilisable { mode: (1.0, 0.0) });
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum LinearError {
    /// A matrix has the wrong size.
    Size {
        /// Name of the matrix, such as `A`.
        what: &'static str,
        /// Expected numbers of rows and columns.
        expected: (usize, usize),
        /// Actual numbers of rows and columns.
        found: (usize, usize),
    },
    /// The system has no state or no input, so that there is nothing to regulate.
    Empty,
    /// A matrix has an entry that is not finite.
    NotFinite {
        /// Name of the matrix, such as `A`.
        what: &'static str,
        /// Row and column of the first such entry, counted from 0.
        at: (usize, usize),
    },
    /// A weight matrix is not symmetric.
    NotSymmetric {
        /// Name of the matrix, `Q` or `R`.
        what: &'static str,
    },
    /// The weight R of the inputs is not positive definite.
    NotPositiveDefinite {
        /// Name of the matrix, `R`.
        what: &'static str,
    },
    /// The weight Q of the states has a negative eigenvalue.
    NotPositiveSemidefinite {
        /// Name of the matrix, `Q`.
        what: &'static str,
        /// Its least eigenvalue, in the unit of the entries.
        eigenvalue: f64,
    },
    /// No input reaches a mode that does not decay by itself.
    NotStabilisable {
        /// Real and imaginary part of its eigenvalue: `[1/s]` of a continuous system, dimensionless of a sampled one.
        mode: (f64, f64),
    },
    /// No stabilising solution of the Riccati equation was found: a mode that does not decay has no weight in Q, or the
    /// matrices are too badly scaled.
    NotDetectable,
    /// The output does not depend on the input.
    NoPath {
        /// Name of the input, [`Axis::name`](super::Axis::name).
        input: String,
        /// Name of the output.
        output: String,
    },
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { what, expected, found } => {
                write!(f, "`{what}` is {}×{}, expected {}×{}", found.0, found.1, expected.0, expected.1)
            }
            Self::Empty => f.write_str("there is nothing to regulate: no state or no input"),
            Self::NotFinite { what, at } => {
                write!(f, "`{what}` is not finite in row {}, column {}", at.0 + 1, at.1 + 1)
            }
            Self::NotSymmetric { what } => write!(f, "`{what}` is not symmetric"),
            Self::NotPositiveDefinite { what } => {
                write!(f, "`{what}` is not positive definite: every combination of inputs must cost something")
            }
            Self::NotPositiveSemidefinite { what, eigenvalue } => {
                write!(f, "`{what}` has the negative eigenvalue {eigenvalue:.3e}: no state may earn something")
            }
            Self::NotStabilisable { mode: (re, im) } => {
                let imaginary = if *im == 0.0 { String::new() } else { format!(" ± {:.6}j", im.abs()) };
                write!(f, "not stabilisable: no input reaches the mode at {re:.6}{imaginary}, which does not decay")
            }
            Self::NotDetectable => {
                f.write_str(
                "no stabilising solution found: a mode that does not decay costs nothing in `Q`, or the matrices are too badly scaled",
            )
            }
            Self::NoPath { input, output } => write!(f, "`{output}` does not depend on `{input}`"),
        }
    }
}

impl std::error::Error for LinearError {}

/// Refuses a matrix of another size.
pub(super) fn expect_size(
    what: &'static str,
    matrix: &DMatrix<f64>,
    expected: (usize, usize),
) -> Result<(), LinearError> {
    let found = matrix.shape();
    if found == expected { Ok(()) } else { Err(LinearError::Size { what, expected, found }) }
}

/// Refuses a matrix with an entry that is not finite.
pub(super) fn expect_finite(what: &'static str, matrix: &DMatrix<f64>) -> Result<(), LinearError> {
    match matrix.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(k) => Err(LinearError::NotFinite { what, at: (k % matrix.nrows(), k / matrix.nrows()) }),
    }
}

/// Refuses a matrix that is not symmetric up to rounding.
pub(super) fn expect_symmetric(what: &'static str, matrix: &DMatrix<f64>) -> Result<(), LinearError> {
    let skew = (matrix - matrix.transpose()).amax();
    if skew <= 1e-12 * matrix.amax() { Ok(()) } else { Err(LinearError::NotSymmetric { what }) }
}

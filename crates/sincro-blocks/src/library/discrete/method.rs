//! How an integral is made into a sum.

use crate::kind::{Parameter, Takes};
use crate::reader::Reader;

/// The rule of a discrete integral.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// `y[k] = y[k−1] + Ts·u[k−1]`: does not feed through.
    ForwardEuler,
    /// `y[k] = y[k−1] + Ts·u[k]`.
    BackwardEuler,
    /// `y[k] = y[k−1] + Ts·(u[k−1] + u[k])/2`.
    Trapezoidal,
}

/// Its description as a parameter.
pub(super) const METHOD: Parameter = Parameter::optional(
    "method",
    Takes::Choice(&["forward-euler", "backward-euler", "trapezoidal"]),
    "rule of the integral",
    "forward-euler",
);

impl Method {
    pub(super) fn read(p: &mut Reader<'_>) -> Self {
        match p.choice("method") {
            0 => Self::ForwardEuler,
            1 => Self::BackwardEuler,
            _ => Self::Trapezoidal,
        }
    }

    /// Part of the present sample that counts at once.
    pub(super) fn weight(self) -> f64 {
        match self {
            Self::ForwardEuler => 0.0,
            Self::BackwardEuler => 1.0,
            Self::Trapezoidal => 0.5,
        }
    }
}

//! Rules of discrete integration.

use crate::library::prelude::*;

choice! {
    /// Rule of a discrete integral.
    pub enum Method {
        /// `y[k] = y[k−1] + Ts·u[k−1]`: no direct feedthrough.
        ForwardEuler = "forward-euler",
        /// `y[k] = y[k−1] + Ts·u[k]`.
        BackwardEuler = "backward-euler",
        /// `y[k] = y[k−1] + Ts·(u[k−1] + u[k])/2`.
        Trapezoidal = "trapezoidal",
    }
}

impl Method {
    /// Weight of the present sample.
    pub(super) fn weight(self) -> f64 {
        match self {
            Self::ForwardEuler => 0.0,
            Self::BackwardEuler => 1.0,
            Self::Trapezoidal => 0.5,
        }
    }
}

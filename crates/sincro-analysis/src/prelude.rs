//! Names for linearising scenes and judging linear systems: `use sincro_analysis::prelude::*`.

pub use crate::linear::{
    Axis, Bode, Complex, DMatrix, DVector, LinearError, Margin, Mode, Regulator, Stability, StateSpace, StepResponse,
    dlqr, lqr,
};
pub use crate::linearize::{
    Linearization, Request, Trim, TrimRequest, Trimmed, UnstableLoop, fastest_poles, linearize, operating_point, trim,
    unstable_loop,
};

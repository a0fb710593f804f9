//! Linear analysis of simulated systems.
//!
//! | modules | hold |
//! |---|---|
//! | [`linearize`](mod@linearize) | linearisation and trim of a scene at an operating point, by dual numbers |
//! | [`linear`] | linear systems: poles, zeros, frequency and step response, Lyapunov equations, LQR |

pub mod linear;
pub mod linearize;

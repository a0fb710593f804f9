#![doc = include_str!("../README.md")]
//! # Integrators
//!
//! An integrator knows nothing of joints. It advances a vector y in the chart that a [`System`] lays at the start of
//! each step, so that a quaternion is three numbers like any others and stays a unit quaternion exactly; and it works
//! on lanes as on one world.
//!
//! | name | order | for |
//! |---|---|---|
//! | [`SemiImplicitEuler`] | 1 | what most engines do; joint damping is implicit |
//! | [`Rk4`] | 4 | smooth mechanisms at a fixed step |
//! | [`Extrapolated`], two rows | 2 | fixed step, stable for any stiffness and damping of joints |
//! | [`DormandPrince`] | 5(4) | smooth mechanisms, error control |
//! | [`DormandPrince8`] | 8(5,3) | smooth mechanisms at high accuracy, error control |
//! | [`Extrapolated`], with [`Extrapolated::control`] | 2…8 | stiff mechanisms, error control |
//!
//! [`Adaptive`] is any of those with error control. [`Bracket`] locates events between two instants, and a [`Hermite`]
//! polynomial tells what may have happened within a step; [`quadrature`] integrates functions of one variable.

mod adaptive;
mod bracket;
mod dormand_prince;
mod dormand_prince_8;
mod embedded;
mod euler;
mod extrapolated;
mod hermite;
mod quadrature;
mod rk4;

pub use adaptive::{Adaptive, AdaptiveKind};
pub use bracket::{Bracket, Sample};
pub use dormand_prince::DormandPrince;
pub use dormand_prince_8::DormandPrince8;
pub use euler::SemiImplicitEuler;
pub use extrapolated::Extrapolated;
pub use hermite::{Hermite, dip, distance_dip};
pub use quadrature::quadrature;
pub use rk4::Rk4;

use sincro_math::{Branches, Real};

/// System of ordinary differential equations dy/dt = f(t, y) for an integrator, in local coordinates (a chart that is
/// laid anew after every step); implemented by the
/// `Mechanism` of `sincro-dynamics`.
pub trait System<R: Real> {
    /// Number of unknowns: length of y.
    fn dim(&self) -> usize;

    /// Returns true if entry `k` of y (0 to dim − 1) takes part in error control; the others are quadratures that
    /// nothing depends on.
    fn is_controlled(&self, k: usize) -> bool;

    /// Computes `slope = f(t, y)` at time `t` `[s]`; both vectors have [`System::dim`] entries, `slope` those of `y`
    /// per second.
    fn slope(&mut self, t: f64, y: &[R], slope: &mut [R]);

    /// Computes one linearly implicit Euler step of length `h` `[s]` from (`t`, `y`): `slope` such that the new y is
    /// `y + h·slope`, all of [`System::dim`] entries. It depends smoothly on h, as extrapolation needs; the terms named
    /// by `implicit` are taken at the new state.
    fn implicit_slope(&mut self, t: f64, h: f64, implicit: Implicit, y: &[R], slope: &mut [R]);

    /// Begins a trial step from the present chart; by default nothing.
    fn begin_step(&mut self) {}

    /// Stages since [`System::begin_step`] that were at a singular point, where slopes have no digits; by default none.
    fn singular_stages(&self) -> SingularStages {
        SingularStages::None
    }

    /// Branches that laws in pieces take in the state `y` ([`System::dim`] entries); `None`, the default, if no law is.
    /// Methods whose stages say little of the end of a step look at them there.
    fn branches(&mut self, _y: &[R]) -> Option<Branches> {
        None
    }

    /// Removes from an error estimate, in the units of `y`, the part across the manifold of the system at `y`, which
    /// the projection after the step removes anyway; by default nothing. Both have [`System::dim`] entries.
    fn project_error(&mut self, _y: &[R], _error: &mut [R]) {}

    /// Centres the chart at `y` ([`System::dim`] entries), in place: afterwards `y` describes the same state in the new
    /// chart.
    fn rechart(&mut self, y: &mut [R]);

    /// Centres the chart at `y` as [`System::rechart`], after one step with [`Implicit::Dampers`] from its centre. The
    /// velocities have the axes at the start of the step, and are turned into those at its end; by default nothing is.
    #[inline(always)]
    fn rechart_at_velocity_level(&mut self, y: &mut [R]) {
        self.rechart(y);
    }

    /// Typical magnitude of controlled entry `k`, in its unit, for relative errors: that of the state that `y`
    /// describes.
    fn magnitude(&self, y: &[R], k: usize) -> f64;
}

/// Stages of a trial step that were at a singular point of the system, from [`System::singular_stages`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SingularStages {
    /// None.
    None,
    /// The first stage: another step size does not avoid it, the step begins there.
    First,
    /// A later stage: a step of another size avoids it.
    Later,
}

/// Terms that a linearly implicit step evaluates at the new state, argument of [`System::implicit_slope`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Implicit {
    /// Dampers only; springs at the old state leave an undamped oscillation undamped.
    Dampers,
    /// Springs and dampers: stable for any stiffness and damping.
    SpringsAndDampers,
}

impl Implicit {
    /// Times `[s]` over which dampers and springs, in this order, are implicit in a step of length `h` `[s]`: h or 0.
    #[must_use]
    pub fn steps(self, h: f64) -> (f64, f64) {
        match self {
            Self::Dampers => (h, 0.0),
            Self::SpringsAndDampers => (h, h),
        }
    }
}

/// Integration method with a fixed step, generic over the system.
pub trait FixedStep<R: Real> {
    /// Advances `y` ([`System::dim`] entries, in a fresh chart before and after) from time `t` `[s]` by `h` `[s]`.
    fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &mut [R]);
}

/// Cause for which an integrator could not make a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// State or slopes are not finite.
    NotFinite {
        /// Start of the failed step `[s]`.
        t: f64,
    },
    /// Error control asked for a step too small to advance time.
    StepTooSmall {
        /// Start of the failed step `[s]`.
        t: f64,
        /// Step size that error control asked for `[s]`.
        h: f64,
    },
}

impl core::fmt::Display for Failure {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { t } => write!(f, "the state is not finite after the step from t = {t} s"),
            Self::StepTooSmall { t, h } => write!(f, "error control asks for a step of {h:.1e} s at t = {t} s"),
        }
    }
}

impl std::error::Error for Failure {}

/// Step-size control of a method with error control: tolerance and next step. Part of a snapshot of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Local error allowed in a step, relative to max(|y|, 1) (dimensionless).
    pub accuracy: f64,
    /// Size of the next step `[s]`.
    pub h: f64,
    /// Error estimate of the last accepted step over the tolerance (dimensionless, 0 to 1).
    pub last_error: f64,
}

impl Control {
    /// Creates a step-size control with the local error `accuracy` allowed in a step, relative to max(|y|, 1)
    /// (dimensionless), and a first step of `h` `[s]`.
    #[must_use]
    pub fn new(accuracy: f64, h: f64) -> Self {
        Self { accuracy, h, last_error: 1.0 }
    }

    /// Largest error over the controlled entries as a share of the tolerance; infinite if any is not finite.
    fn share<R: Real, S: System<R>>(&self, system: &S, y: &[R], error: &[R]) -> f64 {
        let mut worst = 0.0_f64;
        for k in (0..y.len()).filter(|&k| system.is_controlled(k)) {
            let share = error[k].lane(0).abs() / (self.accuracy * system.magnitude(y, k).max(1.0));
            // a NaN must not pass for a small error
            worst = if share.is_nan() { f64::INFINITY } else { worst.max(share) };
        }
        worst
    }
}

/// Smallest step in units of rounding of the time itself.
fn too_small(t: f64, h: f64) -> bool {
    h < 16.0 * f64::EPSILON * t.abs().max(1e-3)
}

/// `out = y + h · Σ c_i k_i`.
#[inline(always)]
fn combine<R: Real>(out: &mut [R], y: &[R], h: f64, terms: &[(f64, &[R])]) {
    let (n, (c_0, k_0)) = (out.len(), terms[0]);
    let (y, k_0) = (&y[..n], &k_0[..n]);
    for i in 0..n {
        let mut sum = R::splat(c_0) * k_0[i];
        for (c, k) in &terms[1..] {
            sum += R::splat(*c) * k[i];
        }
        out[i] = y[i] + R::splat(h) * sum;
    }
}

/// Power with the same bits on every platform.
fn power(base: f64, exponent: f64) -> f64 {
    sincro_math::elementary::pow(base, exponent).0
}

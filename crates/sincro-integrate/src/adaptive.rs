//! Methods with error control as one type, so that a run can change between them.

use sincro_math::Real;

use crate::{Control, DormandPrince, DormandPrince8, Extrapolated, Failure, System};

/// Rows of the extrapolation of the stiff method at its start: it has order 8 at most.
const STIFF_ROWS: usize = 6;

/// Method with error control, which chooses its steps by an estimate of their error, and its working memory.
///
/// ```
/// use sincro_integrate::{Adaptive, AdaptiveKind, Control, Implicit, System};
///
/// struct Decay;
/// impl System<f64> for Decay {
///     fn dim(&self) -> usize {
///         1
///     }
///     fn is_controlled(&self, _: usize) -> bool {
///         true
///     }
///     fn slope(&mut self, _: f64, y: &[f64], slope: &mut [f64]) {
///         slope[0] = -y[0];
///     }
///     fn implicit_slope(&mut self, _: f64, h: f64, _: Implicit, y: &[f64], slope: &mut [f64]) {
///         slope[0] = -y[0] / (1.0 + h);
///     }
///     fn rechart(&mut self, _: &mut [f64]) {}
///     fn magnitude(&self, y: &[f64], k: usize) -> f64 {
///         y[k].abs()
///     }
/// }
///
/// // steps from 0 to 1 s at a local error of 1e-12, and the error at the end
/// let run = |kind| {
///     let (mut method, mut t, mut y, mut n) = (Adaptive::new(kind, 1, Control::new(1e-12, 0.1)), 0.0, [1.0], 0);
///     while t < 1.0 {
///         t += method.step(&mut Decay, t, 1.0 - t, &mut y).unwrap();
///         n += 1;
///     }
///     (n, (y[0] - (-1.0_f64).exp()).abs())
/// };
/// let ((n_5, e_5), (n_8, e_8)) = (run(AdaptiveKind::DormandPrince), run(AdaptiveKind::DormandPrince8));
/// assert!(5 * n_8 < n_5 && e_5 < 1e-10 && e_8 < 1e-10, "{n_5} {e_5} {n_8} {e_8}");
/// ```
#[derive(Clone, Debug)]
pub enum Adaptive<R = f64> {
    /// Dormand–Prince 5(4).
    DormandPrince(DormandPrince<R>),
    /// Dormand–Prince 8(5,3).
    DormandPrince8(DormandPrince8<R>),
    /// Extrapolated linearly implicit Euler.
    Stiff(Extrapolated<R>),
}

/// Kind of a method with error control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AdaptiveKind {
    /// Dormand–Prince 5(4), explicit.
    DormandPrince,
    /// Dormand–Prince 8(5,3), explicit.
    DormandPrince8,
    /// Extrapolated linearly implicit Euler, order 2 to 8.
    Stiff,
}

impl<R: Real> Adaptive<R> {
    /// Creates a method for systems with `dim` unknowns ([`System::dim`]).
    #[must_use]
    pub fn new(kind: AdaptiveKind, dim: usize, control: Control) -> Self {
        match kind {
            AdaptiveKind::DormandPrince => Self::DormandPrince(DormandPrince::new(dim, control)),
            AdaptiveKind::DormandPrince8 => Self::DormandPrince8(DormandPrince8::new(dim, control)),
            AdaptiveKind::Stiff => Self::Stiff(Extrapolated::new(dim, STIFF_ROWS, control)),
        }
    }

    /// Kind of the method.
    #[must_use]
    pub fn kind(&self) -> AdaptiveKind {
        match self {
            Self::DormandPrince(_) => AdaptiveKind::DormandPrince,
            Self::DormandPrince8(_) => AdaptiveKind::DormandPrince8,
            Self::Stiff(_) => AdaptiveKind::Stiff,
        }
    }

    /// Tolerance and next step size.
    #[must_use]
    pub fn control(&self) -> Control {
        match self {
            Self::DormandPrince(method) => method.control,
            Self::DormandPrince8(method) => method.control,
            Self::Stiff(method) => method.control,
        }
    }

    /// Sets tolerance and next step size.
    pub fn set_control(&mut self, control: Control) {
        match self {
            Self::DormandPrince(method) => method.control = control,
            Self::DormandPrince8(method) => method.control = control,
            Self::Stiff(method) => method.control = control,
        }
    }

    /// Number of vectors of [`System::dim`] entries that the method keeps.
    #[must_use]
    pub fn vector_count(&self) -> usize {
        match self {
            Self::DormandPrince(_) => 9,
            Self::DormandPrince8(_) => 15,
            Self::Stiff(_) => 10,
        }
    }

    /// Makes one accepted step from `t` `[s]`, no longer than `h_max` `[s]`, and returns its length `[s]`. `y`
    /// ([`System::dim`] entries) is the state in a fresh chart before and after.
    ///
    /// # Errors
    ///
    /// [`Failure::StepTooSmall`] if no step meets the tolerance, [`Failure::NotFinite`] if slopes are not finite.
    #[inline]
    pub fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h_max: f64, y: &mut [R]) -> Result<f64, Failure> {
        match self {
            Self::DormandPrince(method) => method.step(system, t, h_max, y),
            Self::DormandPrince8(method) => method.step(system, t, h_max, y),
            Self::Stiff(method) => method.adaptive_step(system, t, h_max, y),
        }
    }
}

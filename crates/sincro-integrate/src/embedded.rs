//! Steps of explicit embedded pairs: a trial step, its error as a share of the tolerance, and the next step size.
//!
//! Step size control by proportional–integral feedback: key `hairer1993`, section II.4, and key `hairer1996`, section
//! IV.2.

use sincro_math::Real;

use crate::{Control, Failure, SingularStages, System, power, too_small};

/// Factor on a step that has a stage at a singular point, and how often it is tried.
const DETOUR: f64 = 0.83;
const MAX_DETOURS: u32 = 20;

/// Explicit Runge–Kutta method with an error estimate from the same stages.
pub(crate) trait EmbeddedPair<R: Real> {
    /// Order of the step size in the error estimate.
    const ERROR_ORDER: f64;
    /// Integral part of the step-size controller.
    const BETA: f64;

    /// Tolerance and next step size.
    fn control(&mut self) -> &mut Control;

    /// Makes all stages of a step of `h` from (`t`, `y`), and keeps the new y and its error estimate.
    fn stages<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R]);

    /// New y of the last stages.
    fn new_y(&self) -> &[R];

    /// Error estimate of the last stages as a share of the tolerance; infinite if it is not finite.
    fn share<S: System<R>>(&mut self, system: &mut S) -> f64;
}

/// Makes one accepted step, and returns its length; [`crate::DormandPrince::step`] for the arguments.
#[inline(always)]
pub(crate) fn step<R: Real, P: EmbeddedPair<R>, S: System<R>>(
    pair: &mut P,
    system: &mut S,
    t: f64,
    h_max: f64,
    y: &mut [R],
) -> Result<f64, Failure> {
    let (mut h_max, mut detours) = (h_max, 0);
    let exponent = 1.0 / P::ERROR_ORDER;
    loop {
        let h = pair.control().h.min(h_max);
        system.begin_step();
        pair.stages(system, t, h, y);
        match system.singular_stages() {
            SingularStages::Later if detours < MAX_DETOURS => {
                (h_max, detours) = (DETOUR * h, detours + 1);
                continue;
            }
            SingularStages::None => {}
            // its error estimate would be rounding
            _ => {
                y.copy_from_slice(pair.new_y());
                system.rechart(y);
                return Ok(h);
            }
        }
        let share = pair.share(system);
        let control = pair.control();
        if share <= 1.0 {
            let proportional = power(share.max(1e-10), -(exponent - 0.75 * P::BETA));
            let factor = 0.9 * proportional * power(control.last_error, P::BETA);
            // a step cut short by the tick says little about the next one
            let grown = h * factor.clamp(0.2, 5.0);
            control.h = if h < control.h { control.h.max(grown) } else { grown };
            control.last_error = share.max(1e-4);
            y.copy_from_slice(pair.new_y());
            system.rechart(y);
            return Ok(h);
        }
        let factor = if share.is_finite() { 0.9 * power(share, -exponent) } else { 0.1 };
        control.h = h * factor.clamp(0.1, 0.9);
        if too_small(t, control.h) {
            let h = control.h;
            return Err(if share.is_finite() { Failure::StepTooSmall { t, h } } else { Failure::NotFinite { t } });
        }
    }
}

/// Slope of a stage: one copy for all pairs, which would each have the whole system within their stages.
#[inline(never)]
pub(crate) fn slope<R: Real, S: System<R>>(system: &mut S, t: f64, y: &[R], slope: &mut [R]) {
    system.slope(t, y, slope);
}

/// `out = y + Σ (h a_j) k_j` over `S` slopes, added in their order, one unknown after the other; one copy for all
/// systems.
#[inline(never)]
pub(crate) fn add_weighted<R: Real, const S: usize>(out: &mut [R], y: &[R], k: [&[R]; S], a: [f64; S], h: f64) {
    let n = out.len();
    let y = &y[..n];
    let k = k.map(|slope| &slope[..n]);
    let weights: [R; S] = std::array::from_fn(|j| R::splat(h * a[j]));
    for i in 0..n {
        let mut sum = y[i];
        for (slope, weight) in k.iter().zip(weights) {
            sum += weight * slope[i];
        }
        out[i] = sum;
    }
}

/// `error = h Σ e_j k_j` over `S` slopes; one copy for all systems.
#[inline(never)]
pub(crate) fn find_error<R: Real, const S: usize>(error: &mut [R], k: [&[R]; S], e: [f64; S], h: f64) {
    let n = error.len();
    let k = k.map(|slope| &slope[..n]);
    for (i, error) in error.iter_mut().enumerate() {
        let mut sum = R::zero();
        for (slope, e) in k.iter().zip(e) {
            sum += R::splat(e) * slope[i];
        }
        *error = R::splat(h) * sum;
    }
}

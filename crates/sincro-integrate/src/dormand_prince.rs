//! Dormand–Prince 5(4): explicit, error-controlled, the field's workhorse for smooth problems.
//!
//! Source: key `hairer1993`, section II.5, table 5.2; step size control by proportional–integral feedback, section II.4
//! and key `hairer1996`, section IV.2 (β = 0.04). The last stage could be the next step's first; here it is evaluated
//! again, because motors may have new commands and a snapshot should hold no slopes.

use sincro_math::Real;

use crate::{Control, Failure, SingularStages, System, power, too_small};

const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A: [&[f64]; 7] = [
    &[],
    &[0.2],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Fifth-order minus fourth-order weights.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Integral part of the step-size controller.
const BETA: f64 = 0.04;

/// Factor on a step that has a stage at a singular point, and how often it is tried.
const DETOUR: f64 = 0.83;
const MAX_DETOURS: u32 = 20;

/// Dormand–Prince method of order 5 with error control (embedded order 4), and its working memory: for smooth systems.
/// On dual numbers the values alone are controlled: the steps are those of plain numbers.
#[derive(Clone, Debug)]
pub struct DormandPrince<R = f64> {
    /// Tolerance and next step size.
    pub control: Control,
    k: [Vec<R>; 7],
    stage: Vec<R>,
    error: Vec<R>,
}

impl<R: Real> DormandPrince<R> {
    /// Creates the method for systems with `dim` unknowns ([`System::dim`]).
    #[must_use]
    pub fn new(dim: usize, control: Control) -> Self {
        let zero = vec![R::zero(); dim];
        Self { control, k: std::array::from_fn(|_| zero.clone()), stage: zero.clone(), error: zero }
    }

    /// Makes one accepted step from `t` `[s]`, no longer than `h_max` `[s]`, and returns its length `[s]`. `y`
    /// ([`System::dim`] entries) is the state in a fresh chart before and after.
    ///
    /// # Errors
    ///
    /// [`Failure::StepTooSmall`] if no step meets the tolerance, [`Failure::NotFinite`] if slopes are not finite.
    pub fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h_max: f64, y: &mut [R]) -> Result<f64, Failure> {
        let (mut h_max, mut detours) = (h_max, 0);
        loop {
            let h = self.control.h.min(h_max);
            system.begin_step();
            self.stages(system, t, h, y);
            match system.singular_stages() {
                SingularStages::Later if detours < MAX_DETOURS => {
                    (h_max, detours) = (DETOUR * h, detours + 1);
                    continue;
                }
                SingularStages::None => {}
                // its error estimate would be rounding
                _ => {
                    y.copy_from_slice(&self.stage);
                    system.rechart(y);
                    return Ok(h);
                }
            }
            system.project_error(&self.stage, &mut self.error);
            let share = self.control.share(system, &self.stage, &self.error);
            if share <= 1.0 {
                let factor = 0.9 * power(share.max(1e-10), -(0.2 - 0.75 * BETA)) * power(self.control.last_error, BETA);
                // a step cut short by the tick says little about the next one
                let grown = h * factor.clamp(0.2, 5.0);
                self.control.h = if h < self.control.h { self.control.h.max(grown) } else { grown };
                self.control.last_error = share.max(1e-4);
                y.copy_from_slice(&self.stage);
                system.rechart(y);
                return Ok(h);
            }
            let factor = if share.is_finite() { 0.9 * power(share, -0.2) } else { 0.1 };
            self.control.h = h * factor.clamp(0.1, 0.9);
            if too_small(t, self.control.h) {
                let h = self.control.h;
                return Err(if share.is_finite() { Failure::StepTooSmall { t, h } } else { Failure::NotFinite { t } });
            }
        }
    }

    /// All stages; the new y is left in `stage`, the error estimate in `error`.
    fn stages<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R]) {
        for s in 0..7 {
            let (done, rest) = self.k.split_at_mut(s);
            let stage = &mut self.stage[..];
            match s {
                0 => stage.copy_from_slice(y),
                1 => add_weighted::<_, 1>(stage, y, (done, A[s]), h),
                2 => add_weighted::<_, 2>(stage, y, (done, A[s]), h),
                3 => add_weighted::<_, 3>(stage, y, (done, A[s]), h),
                4 => add_weighted::<_, 4>(stage, y, (done, A[s]), h),
                5 => add_weighted::<_, 5>(stage, y, (done, A[s]), h),
                _ => add_weighted::<_, 6>(stage, y, (done, A[s]), h),
            }
            system.slope(t + C[s] * h, &self.stage, &mut rest[0]);
        }
        find_error(&mut self.error, &self.k, h);
    }
}

/// `error = h Σ e_j k_j`; one copy for all systems.
#[inline(never)]
fn find_error<R: Real>(error: &mut [R], k: &[Vec<R>; 7], h: f64) {
    let n = error.len();
    let slopes: [&[R]; 7] = std::array::from_fn(|j| &k[j][..n]);
    for (i, error) in error.iter_mut().enumerate() {
        let mut sum = R::zero();
        for (slope, e) in slopes.iter().zip(E) {
            sum += R::splat(e) * slope[i];
        }
        *error = R::splat(h) * sum;
    }
}

/// `out = y + Σ (h a_j) k_j` over `S` slopes, added in their order, one unknown after the other; one copy for all
/// systems.
#[inline(never)]
fn add_weighted<R: Real, const S: usize>(out: &mut [R], y: &[R], (k, a): (&[Vec<R>], &[f64]), h: f64) {
    let n = out.len();
    let y = &y[..n];
    let slopes: [&[R]; S] = std::array::from_fn(|j| &k[j][..n]);
    let weights: [R; S] = std::array::from_fn(|j| R::splat(h * a[j]));
    for i in 0..n {
        let mut sum = y[i];
        for (slope, weight) in slopes.iter().zip(weights) {
            sum += weight * slope[i];
        }
        out[i] = sum;
    }
}

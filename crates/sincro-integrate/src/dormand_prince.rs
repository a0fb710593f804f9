//! Dormand–Prince 5(4): explicit, error-controlled, the field's workhorse for smooth problems.
//!
//! Source: key `hairer1993`, section II.5, table 5.2; step size control with β = 0.04: key `hairer1996`, section IV.2.
//! The last stage could be the next step's first; here it is evaluated again, because motors may have new commands and
//! a snapshot should hold no slopes.

use sincro_math::Real;

use crate::embedded::{self, EmbeddedPair, add_weighted, find_error, slope};
use crate::{Control, Failure, System};

const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A_1: [f64; 1] = [0.2];
const A_2: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
const A_3: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
const A_4: [f64; 4] = [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0];
const A_5: [f64; 5] = [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0];
const A_6: [f64; 6] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
/// Fifth-order minus fourth-order weights.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

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
        embedded::step(self, system, t, h_max, y)
    }
}

impl<R: Real> EmbeddedPair<R> for DormandPrince<R> {
    const ERROR_ORDER: f64 = 5.0;
    const BETA: f64 = 0.04;

    fn control(&mut self) -> &mut Control {
        &mut self.control
    }

    fn stages<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R]) {
        for s in 0..7 {
            let ([k_0, k_1, k_2, k_3, k_4, k_5, _], stage) = (self.k.each_ref().map(|k| &k[..]), &mut self.stage[..]);
            match s {
                0 => stage.copy_from_slice(y),
                1 => add_weighted(stage, y, [k_0], A_1, h),
                2 => add_weighted(stage, y, [k_0, k_1], A_2, h),
                3 => add_weighted(stage, y, [k_0, k_1, k_2], A_3, h),
                4 => add_weighted(stage, y, [k_0, k_1, k_2, k_3], A_4, h),
                5 => add_weighted(stage, y, [k_0, k_1, k_2, k_3, k_4], A_5, h),
                _ => add_weighted(stage, y, [k_0, k_1, k_2, k_3, k_4, k_5], A_6, h),
            }
            slope(system, t + C[s] * h, &self.stage, &mut self.k[s]);
        }
        find_error(&mut self.error, self.k.each_ref().map(|k| &k[..]), E, h);
    }

    fn new_y(&self) -> &[R] {
        &self.stage
    }

    fn share<S: System<R>>(&mut self, system: &mut S) -> f64 {
        system.project_error(&self.stage, &mut self.error);
        self.control.share(system, &self.stage, &self.error)
    }
}

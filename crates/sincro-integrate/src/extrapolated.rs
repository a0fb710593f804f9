//! Extrapolated linearly implicit Euler: the implicit methods of fixed and of variable step.
//!
//! One step H is done by 1, 2, 3 … linearly implicit Euler steps of H, H/2, H/3 …; their results have an error
//! expansion in powers of the small step, and Aitken–Neville elimination takes away one power a row: T_jj has order j,
//! T_jj − T_j,j−1 estimates its error. Only the base step is implicit, and it costs one forward-dynamics call with a
//! diagonal added to the mass matrix: no Jacobian, no dense matrix, linear in the number of links. The expansion holds
//! for any stiff part taken implicitly, so that the order does not depend on it. T_22 (the fixed-step method) is
//! L-stable for the implicit part; T_jj is A(89.7°)-stable.
//!
//! Source: key `hairer1996`, section IV.9 (linearly implicit Euler extrapolation, SEULEX), table 9.1; order and step
//! size after section II.9 of key `hairer1993`, simplified: a step is accepted at the first row that meets the
//! tolerance. A step over the border of a law in pieces ([`System::branches`]) must be so short that the jump there is
//! below the tolerance.

use sincro_math::Real;

use crate::{Control, Failure, FixedStep, Implicit, System, power, too_small};

/// Least factor from a rejected step to the next trial.
const LEAST_REJECTED: f64 = 0.05;

/// Maximum number of rows of the tableau.
const MAX_ROWS: usize = 8;

/// Extrapolated linearly implicit Euler method, with fixed or variable step, and its working memory: for stiff systems.
#[derive(Clone, Debug)]
pub struct Extrapolated<R> {
    /// Tolerance and next step size, for variable steps.
    pub control: Control,
    /// Number of rows of the tableau, 1 to 8: of fixed steps the order, of variable steps the number expected for the
    /// next.
    pub rows: usize,
    /// The last row of the tableau: entry k has order k + 1.
    tableau: Vec<Vec<R>>,
    slope: Vec<R>,
    error: Vec<R>,
}

impl<R: Real> Extrapolated<R> {
    /// Creates the method for systems with `dim` unknowns ([`System::dim`]) and `rows` rows, 1 to 8; fixed steps do not
    /// use `control`.
    #[must_use]
    pub fn new(dim: usize, rows: usize, control: Control) -> Self {
        let zero = vec![R::zero(); dim];
        Self { control, rows, tableau: vec![zero.clone(); MAX_ROWS], slope: zero.clone(), error: zero }
    }

    /// Computes row `j` (0-based): j + 1 base steps, then elimination; the row's results replace the tableau's.
    #[inline(always)]
    fn row<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R], j: usize) {
        let n = j + 1;
        let small = h / n as f64;
        // the newest T_j1 is built in place `j`, then carried through the older ones
        let (older, newest) = self.tableau.split_at_mut(j);
        let x = &mut newest[0];
        for i in 0..n {
            let from = if i == 0 { y } else { &**x };
            system.implicit_slope(t + i as f64 * small, small, Implicit::SpringsAndDampers, from, &mut self.slope);
            if i == 0 {
                for ((x, y), k) in x.iter_mut().zip(y).zip(&self.slope) {
                    *x = *y + R::splat(small) * *k;
                }
            } else {
                for (x, k) in x.iter_mut().zip(&self.slope) {
                    *x += R::splat(small) * *k;
                }
            }
        }
        // older[k] holds T_{j,k+1} of the row before; afterwards entry k holds T_{j+1,k+1}
        for k in 0..j {
            // T_{j,k+1} = T_{j,k} + (T_{j,k} − T_{j−1,k}) / (n_j/n_{j−k} − 1)
            let ratio = 1.0 / (n as f64 / (j - k) as f64 - 1.0);
            for (old, new) in older[k].iter_mut().zip(x.iter_mut()) {
                let previous = *old;
                *old = *new;
                *new += R::splat(ratio) * (*new - previous);
            }
        }
    }

    /// The best value after row `j`.
    fn best(&self, j: usize) -> &[R] {
        &self.tableau[j]
    }
}

impl<R: Real> FixedStep<R> for Extrapolated<R> {
    #[inline(always)]
    fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &mut [R]) {
        for j in 0..self.rows {
            self.row(system, t, h, y, j);
        }
        y.copy_from_slice(self.best(self.rows - 1));
        system.rechart(y);
    }
}

impl<R: Real> Extrapolated<R> {
    /// Makes one accepted step from `t` `[s]`, no longer than `h_max` `[s]`, and returns its length `[s]`. `y`
    /// ([`System::dim`] entries) is the state in a fresh chart before and after.
    ///
    /// # Errors
    ///
    /// [`Failure::StepTooSmall`] if no step meets the tolerance, [`Failure::NotFinite`] if slopes are not finite.
    pub fn adaptive_step<S: System<R>>(
        &mut self,
        system: &mut S,
        t: f64,
        h_max: f64,
        y: &mut [R],
    ) -> Result<f64, Failure> {
        loop {
            let h = self.control.h.min(h_max);
            system.begin_step();
            let (rows, share) = self.attempt(system, t, h, y);
            if share <= 1.0 {
                self.propose(h, rows, share);
                y.copy_from_slice(&self.tableau[rows - 1]);
                system.rechart(y);
                return Ok(h);
            }
            let factor = if share.is_finite() { 0.8 * power(0.5 / share, 1.0 / rows as f64) } else { 0.1 };
            self.control.h = h * factor.clamp(LEAST_REJECTED, 0.7);
            if too_small(t, self.control.h) {
                let h = self.control.h;
                return Err(if share.is_finite() { Failure::StepTooSmall { t, h } } else { Failure::NotFinite { t } });
            }
        }
    }

    /// Adds rows until the error is below the tolerance; returns the rows made and the error's share of the tolerance.
    fn attempt<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R]) -> (usize, f64) {
        let (mut share, at_start) = (f64::INFINITY, system.branches(y));
        for j in 0..MAX_ROWS {
            self.row(system, t, h, y, j);
            if j == 0 {
                continue;
            }
            for (i, e) in self.error.iter_mut().enumerate() {
                *e = self.tableau[j][i] - self.tableau[j - 1][i];
            }
            system.project_error(&self.tableau[j], &mut self.error);
            let before = share;
            share = self.control.share(system, &self.tableau[j], &self.error);
            if share <= 1.0 && at_start.is_some() && system.branches(&self.tableau[j]) != at_start {
                let jump = self.jump_share(system, t, h, y, j);
                // it goes as the length of the step
                return if jump > 1.0 { (1, jump) } else { (j + 1, share.max(jump)) };
            }
            // rows that no longer help mean a step far too long
            if share <= 1.0 || (j >= 3 && share > 0.9 * before) || !share.is_finite() {
                return (j + 1, share);
            }
        }
        (MAX_ROWS, share)
    }

    /// Bound on the error of a step over the border between two branches of a law, as a share of the tolerance, after
    /// row `j`: the change of the slope, smooth or not, over the whole step. No stage is at the end of a step, so that
    /// the rows may agree and all have missed a jump there.
    #[cold]
    fn jump_share<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &[R], j: usize) -> f64 {
        if too_small(t, LEAST_REJECTED * h) {
            return 0.0;
        }
        system.implicit_slope(t, h, Implicit::SpringsAndDampers, y, &mut self.error);
        system.implicit_slope(t + h, h, Implicit::SpringsAndDampers, &self.tableau[j], &mut self.slope);
        for (error, slope) in self.error.iter_mut().zip(&self.slope) {
            *error = R::splat(h) * (*slope - *error);
        }
        system.project_error(&self.tableau[j], &mut self.error);
        self.control.share(system, &self.tableau[j], &self.error)
    }

    /// Next step: the step that would meet the tolerance with a middling number of rows.
    fn propose(&mut self, h: f64, rows: usize, share: f64) {
        let factor = 0.9 * power(0.6 / share.max(1e-12), 1.0 / rows as f64);
        // fewer rows than the target: a longer step is cheaper a second; more: a shorter one
        let towards_target = if rows < self.rows { 1.5 } else { 1.0 };
        let grown = h * (factor * towards_target).clamp(0.3, 4.0);
        self.control.h = if h < self.control.h { self.control.h.max(grown) } else { grown };
        self.control.last_error = share;
    }
}

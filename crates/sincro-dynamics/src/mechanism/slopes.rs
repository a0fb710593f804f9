//! Slopes of positions, velocities, totals and rotor states at a stage, explicit and linearly implicit.

use sincro_math::{Real, Task};

use super::Mechanism;
use crate::integrate::Implicit;
use crate::state::displace;

/// Runs a stage: one compiled copy for the steps of all methods, whose code is large.
#[inline(always)]
fn run_stage<R: Real, T: Task>(stage: T) -> T::Output {
    if const { R::LANES > 1 } { R::run_hot(stage) } else { run_out_of_line(stage) }
}

#[inline(never)]
fn run_out_of_line<T: Task>(stage: T) -> T::Output {
    stage.run()
}

/// Slope of an explicit stage.
struct ExplicitStage<'a, R> {
    mechanism: &'a mut Mechanism<R>,
    t: f64,
    y: &'a [R],
    slope: &'a mut [R],
}

impl<R: Real> Task for ExplicitStage<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.mechanism.find_explicit_slope(self.t, self.y, self.slope);
    }
}

/// Slope of a linearly implicit stage of length `h` `[s]`.
struct LinearlyImplicitStage<'a, R> {
    mechanism: &'a mut Mechanism<R>,
    t: f64,
    h: f64,
    implicit: Implicit,
    y: &'a [R],
    slope: &'a mut [R],
}

impl<R: Real> Task for LinearlyImplicitStage<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.mechanism.find_linearly_implicit_slope(self.t, self.h, self.implicit, self.y, self.slope);
    }
}

impl<R: Real> Mechanism<R> {
    /// Slope at a stage of either kind; at a singular position of loops those rows are left out that vanish.
    #[inline(never)]
    pub(super) fn plain_slope(&mut self, t: f64, implicit: Option<(f64, Implicit)>, y: &[R], slope: &mut [R]) {
        match implicit {
            None => self.explicit_slope(t, y, slope),
            Some((h, implicit)) => self.linearly_implicit_slope(t, h, implicit, y, slope),
        }
    }

    /// Slope of an explicit stage.
    #[inline(always)]
    pub(super) fn explicit_slope(&mut self, t: f64, y: &[R], slope: &mut [R]) {
        run_stage::<R, _>(ExplicitStage { mechanism: self, t, y, slope });
    }

    /// Slope of a linearly implicit Euler step of length `h` `[s]`.
    #[inline(always)]
    pub(super) fn linearly_implicit_slope(&mut self, t: f64, h: f64, implicit: Implicit, y: &[R], slope: &mut [R]) {
        run_stage::<R, _>(LinearlyImplicitStage { mechanism: self, t, h, implicit, y, slope });
    }

    #[inline(always)]
    fn find_explicit_slope(&mut self, t: f64, y: &[R], slope: &mut [R]) {
        self.place_stage(y);
        let projected = if R::IS_SCALAR && self.singular.is_near { Some(self.project_stage(y)) } else { None };
        let v = if let Some(v) = &projected { v } else { &y[self.layout.velocities()] };
        self.find_placed_slope(t, y, v, slope);
        if let Some(v) = projected {
            self.singular.v = v;
        }
    }

    #[inline(always)]
    fn find_linearly_implicit_slope(&mut self, t: f64, h: f64, implicit: Implicit, y: &[R], slope: &mut [R]) {
        self.place_stage(y);
        // a step of semi-implicit Euler is one at velocity level
        let is_projected = R::IS_SCALAR && self.singular.is_near && implicit != Implicit::Dampers;
        let projected = if is_projected { Some(self.project_stage(y)) } else { None };
        let v = if let Some(v) = &projected { v } else { &y[self.layout.velocities()] };
        self.find_placed_implicit_slope((t, h, implicit), y, v, slope);
        if let Some(v) = projected {
            self.singular.v = v;
        }
    }

    /// Places the mechanism at the displacement of a stage.
    #[inline(always)]
    fn place_stage(&mut self, y: &[R]) {
        displace(&self.model, &self.base, &y[self.layout.displacement()], &mut self.q);
    }

    /// Slope of an explicit stage at the coordinates placed with the velocities `v`.
    #[inline(always)]
    fn find_placed_slope(&mut self, t: f64, y: &[R], v: &[R], slope: &mut [R]) {
        let n = self.model.n_v();
        let (delta, rotors) = (&y[..n], &y[self.layout.rotor_states()]);
        let (rate, rest) = slope.split_at_mut(n);
        self.chart_rate(delta, v, rate);
        self.accelerations(t, v, rotors, None, &mut rest[..n]);
        self.note_evaluation(t, v, &rest[..n]);
        if self.layout.tracks_totals() {
            self.total_rates(t, (v, rotors), v, (R::zero(), R::zero()), &mut rest[n..]);
        }
        self.element_rates(y, 0.0, slope);
    }

    /// Slope of a linearly implicit stage at the coordinates placed with the velocities `v`.
    #[inline(always)]
    fn find_placed_implicit_slope(
        &mut self,
        (t, h, implicit): (f64, f64, Implicit),
        y: &[R],
        v: &[R],
        slope: &mut [R],
    ) {
        let n = self.model.n_v();
        let (delta, rotors) = (&y[..n], &y[self.layout.rotor_states()]);
        let (rate, rest) = slope.split_at_mut(n);
        self.accelerations(t, v, rotors, Some((h, implicit)), &mut rest[..n]);
        self.note_evaluation(t, v, &rest[..n]);
        // the position moves with the new velocity; forces do their work over the mean of old and new
        let step = R::splat(h);
        let (over, v_dot, v) = (&mut self.step_velocity[..n], &rest[..n], &v[..n]);
        for k in 0..n {
            over[k] = v[k] + step * v_dot[k];
        }
        self.chart_rate(delta, &self.step_velocity, rate);
        if self.layout.tracks_totals() {
            let half = R::splat(0.5);
            let over = &mut self.step_velocity[..n];
            for k in 0..n {
                over[k] = half * (over[k] + v[k]);
            }
            let mean = core::mem::take(&mut self.step_velocity);
            let of_springs = R::splat(implicit.steps(h).1);
            self.total_rates(t, (v, rotors), &mean, (step, of_springs), &mut rest[n..]);
            self.step_velocity = mean;
        }
        self.element_rates(y, h, slope);
    }

    /// Notes the conditioning of the loops and the laws of limited drives in an evaluation; not those of drives where
    /// forces of loops are rounding.
    #[inline(always)]
    fn note_evaluation(&mut self, t: f64, v: &[R], v_dot: &[R]) {
        if R::IS_SCALAR {
            self.note_conditioning();
            if self.drive_monitor.is_active && !self.singular.needs_limit() {
                self.monitor_drives(t, v, v_dot);
            }
        }
    }

    /// Notes a stage, and replaces its slope by the limit along the branch at a singular position; nothing without
    /// constraints.
    #[inline(always)]
    pub(super) fn finish_stage(&mut self, t: f64, implicit: Option<(f64, Implicit)>, y: &[R], slope: &mut [R]) {
        if self.constraints.is_none() {
            return;
        }
        if self.singular.needs_limit() && !matches!(implicit, Some((_, Implicit::Dampers))) {
            self.take_limit(t, implicit, y, slope);
        } else {
            self.note_stage(t, self.singular.conditioning);
        }
    }
}

//! Passage of singular positions of loops.
//!
//! On the branch that a mechanism moves along, the motion through a singular position is smooth; only its computation
//! is 0/0 where the smallest singular value of the loops' rows passes zero. Near such a position
//!
//! - every stage is put on the manifold, positions and velocities, before accelerations are evaluated;
//! - the local error is measured along the branch: what lies across it, projection takes away;
//! - where the rows are dependent but for rounding, slopes are their limits along the branch: of positions displaced
//!   forwards and backwards in the direction of motion, extrapolated to no displacement. A tick may thus stand at a
//!   singular instant.
//!
//! Momentum thus decides the branch. Without motion there is no direction: a mechanism at rest in a singular position
//! moves without the vanishing rows, its steps have another length if a later stage stands there, and no error test.
//! Source: key `ascher1998`, section 10.2 (projected invariants).

use sincro_math::Real;

use super::Mechanism;
use crate::constraint::SINGULAR;
use crate::integrate::{Implicit, SingularStages};
use crate::occurrences::Occurrences;
use crate::state::displace;

/// Conditioning of the loops' rows below which a position counts as near a singular one: about the square of the
/// smallest singular value relative to the sizes of the rows.
const NEAR: f64 = 1e-2;

/// Conditioning below which slopes are limits along the branch. It is far above [`SINGULAR`], because the error of a
/// stage across the branch must be small beside the distance to the singular position for projection to remove it.
const BRANCH_LIMIT: f64 = 1e-5;

/// Conditioning at the start of a step below which a singular position may have been passed, and the least value of the
/// parabola, relative to its ends, at which it has been.
const NEAR_PASSAGE: f64 = 0.25;
const PASSED: f64 = 0.1;

/// Displacement at which the limit's conditioning is looked for first `[rad]` or `[m]`, and the conditioning that the
/// smallest displacement of the limit has. Errors: its square to the third power by extrapolation, rounding over it.
const FIRST_DISPLACEMENT: f64 = 1e-3;
const CONDITIONING_OF_LIMIT: f64 = 1e-4;

/// Displacements that are tried: coordinates outside of the loops may be a thousand times faster.
const MAX_DISPLACEMENTS: usize = 5;

/// Weights of the means over ± 1, 2, 3 displacements whose sum has no terms of second and fourth order.
const WEIGHTS: [f64; 3] = [1.5, -0.6, 0.1];

/// Rank tolerance of projections of stages.
const STAGE_RANK: f64 = 1e-11;

/// Iterations that put the positions of a stage on the manifold.
const MAX_ITERATIONS: usize = 4;

/// Residual at which they are there `[m]` or `[rad]`, of a mechanism of 1 m or more.
const ON_MANIFOLD: f64 = 1e-14;

/// Passage of a singular position: conditioning of the loops in the last evaluations.
#[derive(Clone, Debug)]
pub(super) struct SingularPassage<R> {
    /// True if the last evaluation was near a singular position.
    pub is_near: bool,
    /// Conditioning in the last evaluation.
    pub conditioning: f64,
    /// Conditioning at the first stage of the trial step, and the smallest of all its stages.
    stages: Option<(f64, f64)>,
    /// Working memory: velocities of a stage on the manifold, change, chart's origin.
    pub v: Vec<R>,
    change: Vec<R>,
    base: Vec<R>,
    /// Conditioning at the starts of the last three steps, with their times.
    starts: [(f64, f64); 3],
    /// Positions that were passed in the run.
    passed: Occurrences,
    /// Working memory of limits: displaced state, its slope, direction of motion, limit.
    displaced: Vec<R>,
    slope: Vec<R>,
    direction: Vec<R>,
    limit: Vec<R>,
}

impl<R> Default for SingularPassage<R> {
    fn default() -> Self {
        Self {
            is_near: false,
            conditioning: 1.0,
            stages: None,
            v: Vec::new(),
            change: Vec::new(),
            base: Vec::new(),
            starts: [(f64::NAN, f64::NAN); 3],
            passed: Occurrences::default(),
            displaced: Vec::new(),
            slope: Vec::new(),
            direction: Vec::new(),
            limit: Vec::new(),
        }
    }
}

impl<R> SingularPassage<R> {
    /// True if the last evaluation was so near a singular position that its slopes are rounding.
    pub fn needs_limit(&self) -> bool {
        self.is_near && self.conditioning < BRANCH_LIMIT
    }

    /// Begins a trial step.
    pub fn begin_step(&mut self) {
        self.stages = None;
    }

    /// Notes the conditioning at the start of a step, at time `t` `[s]`. The conditioning is about the square of the
    /// distance to a singular position, so that a parabola through three of its values tells a passage and its time.
    fn note_start(&mut self, t: f64, conditioning: f64) {
        let [_, before, last] = self.starts;
        if t <= last.0 {
            // a step that was made again
            if t == last.0 {
                self.starts[2].1 = conditioning;
            }
            return;
        }
        self.starts = [before, last, (t, conditioning)];
        let [(t0, c0), (t1, c1), (t2, c2)] = self.starts;
        if !(c1 < NEAR_PASSAGE && c1 <= c0 && c1 < c2) {
            return;
        }
        let (rise, fall) = ((c2 - c1) / (t2 - t1), (c1 - c0) / (t1 - t0));
        let curvature = (rise - fall) / (t2 - t0);
        let slope = fall + curvature * (t1 - t0);
        let least = c1 - 0.25 * slope * slope / curvature;
        if least < PASSED * c0.max(c2) {
            self.passed.note(t1 - 0.5 * slope / curvature);
        }
    }

    /// Singular stages of the trial step.
    pub fn stages(&self) -> SingularStages {
        match self.stages {
            Some((first, _)) if first < SINGULAR => SingularStages::First,
            Some((_, smallest)) if smallest < SINGULAR => SingularStages::Later,
            _ => SingularStages::None,
        }
    }
}

/// Stage at a singular position and the direction in which it is displaced.
struct DisplacedStage<'a, R> {
    t: f64,
    implicit: Option<(f64, Implicit)>,
    y: &'a [R],
    /// Rates of the chart's coordinates, n_v.
    direction: &'a [R],
}

impl<R: Real> Mechanism<R> {
    /// Notes the conditioning of the loops in the last evaluation.
    #[inline(always)]
    pub(super) fn note_conditioning(&mut self) {
        if let Some(c) = &self.constraints {
            self.singular.is_near = c.conditioning < NEAR;
            self.singular.conditioning = c.conditioning;
        }
    }

    /// Singular positions of loops passed so far.
    pub(crate) fn passed_singularities(&self) -> Occurrences {
        self.singular.passed
    }

    /// Forgets the last evaluation: what follows depends on the state alone.
    pub(super) fn forget_conditioning(&mut self) {
        (self.singular.is_near, self.singular.conditioning) = (false, 1.0);
    }

    /// Begins a step of a method without trial steps.
    pub(crate) fn begin_fixed_step(&mut self) {
        self.singular.begin_step();
    }

    /// Notes a stage of a trial step at time `t` `[s]` of that conditioning.
    #[inline(always)]
    pub(super) fn note_stage(&mut self, t: f64, conditioning: f64) {
        if self.singular.stages.is_none() {
            self.singular.note_start(t, self.singular.conditioning);
        }
        let (first, smallest) = self.singular.stages.unwrap_or((conditioning, conditioning));
        self.singular.stages = Some((first, smallest.min(conditioning)));
    }

    /// Replaces the slope of a stage at a singular position by its limit along the branch on which the mechanism moves.
    #[inline(never)]
    pub(super) fn take_limit(&mut self, t: f64, implicit: Option<(f64, Implicit)>, y: &[R], slope: &mut [R]) {
        let conditioning = self.singular.conditioning;
        let mut displaced = core::mem::take(&mut self.singular.displaced);
        displaced.resize(y.len(), R::zero());
        let mut displaced_slope = core::mem::take(&mut self.singular.slope);
        displaced_slope.resize(y.len(), R::zero());
        let mut direction = core::mem::take(&mut self.singular.direction);
        direction.clear();
        direction.extend_from_slice(&slope[self.layout().displacement()]);
        let at = DisplacedStage { t, implicit, y, direction: &direction };
        let has_limit = match self.displacement(&at, &mut displaced, &mut displaced_slope) {
            Some(displacement) => {
                let mut limit = core::mem::take(&mut self.singular.limit);
                limit.clear();
                limit.resize(y.len(), R::zero());
                for (k, weight) in WEIGHTS.iter().enumerate() {
                    for sign in [1.0, -1.0] {
                        self.slope_displaced(
                            &at,
                            sign * (k + 1) as f64 * displacement,
                            &mut displaced,
                            &mut displaced_slope,
                        );
                        for (limit, part) in limit.iter_mut().zip(&displaced_slope) {
                            *limit += R::splat(0.5 * weight) * *part;
                        }
                    }
                }
                // what follows reads poses, velocities and torques of the stage itself
                self.plain_slope(t, implicit, y, slope);
                slope.copy_from_slice(&limit);
                self.singular.limit = limit;
                true
            }
            None => {
                self.plain_slope(t, implicit, y, slope);
                if self.drive_monitor.is_active {
                    let velocities = self.layout().velocities();
                    self.monitor_drives(t, &y[velocities.clone()], &slope[velocities]);
                }
                false
            }
        };
        (self.singular.displaced, self.singular.slope, self.singular.direction) =
            (displaced, displaced_slope, direction);
        self.note_stage(t, if has_limit { 1.0 } else { conditioning });
    }

    /// Displacement along the direction of motion, in seconds of it, at which the loops have the conditioning of
    /// limits; none without motion, or where the position stays singular.
    fn displacement(&mut self, at: &DisplacedStage<'_, R>, y: &mut [R], slope: &mut [R]) -> Option<f64> {
        let largest = at.direction.iter().fold(0.0_f64, |largest, rate| largest.max(rate.lane(0).abs()));
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let (mut shift, mut last) = (FIRST_DISPLACEMENT / largest, 0.0);
        for _ in 0..MAX_DISPLACEMENTS {
            self.slope_displaced(at, shift, y, slope);
            let conditioning = self.singular.conditioning;
            let growth = (CONDITIONING_OF_LIMIT / conditioning).sqrt();
            if conditioning >= BRANCH_LIMIT {
                return Some(growth.max(0.01) * shift);
            }
            if conditioning < 2.0 * last {
                return None;
            }
            (shift, last) = (growth.min(100.0) * shift, conditioning);
        }
        None
    }

    /// Slope of a stage displaced by `shift` seconds of its motion; `y` is overwritten with its state.
    fn slope_displaced(&mut self, at: &DisplacedStage<'_, R>, shift: f64, y: &mut [R], slope: &mut [R]) {
        y.copy_from_slice(at.y);
        for (y, rate) in y.iter_mut().zip(at.direction) {
            *y += R::splat(shift) * *rate;
        }
        self.singular.is_near = true;
        self.plain_slope(at.t, at.implicit, y, slope);
    }

    /// Puts the coordinates `self.q` of a stage `y` near a singular position on the manifold of the loops, and returns
    /// velocities on it.
    #[cold]
    #[inline(never)]
    pub(super) fn project_stage(&mut self, y: &[R]) -> Vec<R> {
        let v = &y[self.layout.velocities()];
        let mut on_manifold = core::mem::take(&mut self.singular.v);
        on_manifold.clear();
        on_manifold.extend_from_slice(v);
        self.with_stage_as_base(|this| {
            for _ in 0..MAX_ITERATIONS {
                this.place_loops(v);
                let c = this.constraints.as_deref().expect("near a singular position there are loops");
                if c.residual.iter().all(|x| x.lane(0).abs() <= this.projection_scale * ON_MANIFOLD) {
                    break;
                }
                this.change_loops(None);
                displace(&this.model, &this.base, &this.singular.change, &mut this.q);
                core::mem::swap(&mut this.base, &mut this.q);
            }
            this.place_loops(v);
            this.change_loops(Some(v));
        });
        for (v, change) in on_manifold.iter_mut().zip(&self.singular.change) {
            *v += *change;
        }
        on_manifold
    }

    /// Removes from the error of positions and velocities at `y` what lies across the loops.
    #[inline(never)]
    pub(super) fn project_error_along_loops(&mut self, y: &[R], error: &mut [R]) {
        let n = self.model.n_v();
        displace(&self.model, &self.base, &y[self.layout().displacement()], &mut self.q);
        let motion = self.layout.motion();
        self.with_stage_as_base(|this| {
            for part in error[motion].chunks_exact_mut(n) {
                this.place_loops(part);
                this.change_loops(Some(part));
                for (e, change) in part.iter_mut().zip(&this.singular.change) {
                    *e += *change;
                }
            }
        });
    }

    /// Calls `act` with the chart's origin at `self.q`, where the origin then is left in `self.q`, and puts it back.
    fn with_stage_as_base(&mut self, act: impl FnOnce(&mut Self)) {
        let mut base = core::mem::take(&mut self.singular.base);
        base.clear();
        base.extend_from_slice(&self.base);
        self.base.copy_from_slice(&self.q);
        self.singular.change.resize(self.model.n_v(), R::zero());
        act(self);
        self.q.copy_from_slice(&self.base);
        self.base.copy_from_slice(&base);
        self.singular.base = base;
    }

    /// Finds the smallest change of positions that removes the residuals of the loops, or of `v` that removes its
    /// rates.
    fn change_loops(&mut self, v: Option<&[R]>) {
        let c = self.constraints.as_deref_mut().expect("near a singular position there are loops");
        c.project_to(STAGE_RANK, &self.model, &mut self.scratch, v, &mut self.singular.change);
    }
}

//! Passage of singular positions of loops.
//!
//! On the branch that a mechanism moves along, the motion through a singular position is smooth; only its computation
//! is 0/0 where the smallest singular value of the loops' rows passes zero. Near such a position
//!
//! - every stage is put on the manifold, positions and velocities, before accelerations are evaluated;
//! - the local error is measured along the branch: what lies across it, projection takes away;
//! - no stage stands where the rows are dependent but for rounding: the step takes another length. A step that must
//!   begin or end there, because a tick does, is made without the vanishing rows and without an error test.
//!
//! Momentum thus decides the branch. Source: key `ascher1998`, section 10.2 (projected invariants).

use sincro_math::Real;

use super::Mechanism;
use crate::constraint::SINGULAR;
use crate::integrate::SingularStages;
use crate::state::displace;

/// Conditioning of the loops' rows below which a position counts as near a singular one: about the square of the
/// smallest singular value relative to the sizes of the rows.
const NEAR: f64 = 1e-2;

/// Rank tolerance of projections of stages.
const STAGE_RANK: f64 = 1e-11;

/// Iterations that put the positions of a stage on the manifold.
const MAX_ITERATIONS: usize = 4;

/// Residual at which they are there `[m]` or `[rad]`, of a mechanism of 1 m or more.
const ON_MANIFOLD: f64 = 1e-14;

/// Passage of a singular position: conditioning of the loops in the last evaluations.
#[derive(Clone, Debug, Default)]
pub(super) struct SingularPassage<R> {
    /// True if the last evaluation was near a singular position.
    pub is_near: bool,
    /// Conditioning at the first stage of the trial step, and the smallest of all its stages.
    stages: Option<(f64, f64)>,
    /// Working memory: velocities of a stage on the manifold, change, chart's origin.
    pub v: Vec<R>,
    change: Vec<R>,
    base: Vec<R>,
}

impl<R> SingularPassage<R> {
    /// Begins a trial step.
    pub fn begin_step(&mut self) {
        self.stages = None;
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

impl<R: Real> Mechanism<R> {
    /// Notes the conditioning of the loops in the last evaluation.
    #[inline(always)]
    pub(super) fn note_conditioning(&mut self) {
        if let Some(c) = &self.constraints {
            self.singular.is_near = c.conditioning < NEAR;
            let (first, smallest) = self.singular.stages.unwrap_or((c.conditioning, c.conditioning));
            self.singular.stages = Some((first, smallest.min(c.conditioning)));
        }
    }

    /// Puts the coordinates `self.q` on the manifold of the loops, and returns velocities on it.
    #[inline(never)]
    pub(super) fn project_stage(&mut self, v: &[R]) -> Vec<R> {
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
        displace(&self.model, &self.base, &y[..n], &mut self.q);
        self.with_stage_as_base(|this| {
            for part in error[..2 * n].chunks_exact_mut(n) {
                this.place_loops(part);
                this.change_loops(Some(part));
                for (e, change) in part.iter_mut().zip(&this.singular.change) {
                    *e += *change;
                }
            }
        });
    }

    /// Does something with the chart's origin at `self.q`; where that leaves it is `self.q` afterwards.
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

//! Projection of positions and velocities onto the constraints, in the metric of the mass matrix: Δq = M⁻¹ Jᵀ λ with G
//! λ = −residual.

use sincro_complementarity::{ContactMode, ContactProblem, PROJECTION_RANK, UnilateralConstraint};
use sincro_math::Real;

use super::Constraints;
use crate::model::Model;
use crate::scratch::Scratch;

impl Constraints<f64> {
    /// Keeps the rows that hold as equations: bilateral rows, closed contacts (with `inside` only penetrating ones),
    /// and with `sticking` the rows of sticking groups.
    pub fn keep_equations(&mut self, sticking: bool, inside: bool) {
        let n_free = self.n_free;
        let mut keep = core::mem::take(&mut self.kept);
        keep.clear();
        keep.extend(0..n_free);
        let residual = &self.residual;
        let holds = |b: &&UnilateralConstraint<f64>| !b.open && b.given.is_none() && (!inside || residual[b.row] < 0.0);
        for block in self.blocks.iter().filter(holds) {
            keep.push(block.row);
            for group in block.groups.iter().flatten() {
                if sticking && group.mode == ContactMode::Stick {
                    keep.extend(group.row..group.row + group.dim);
                }
            }
        }
        for (into, from) in keep.iter().enumerate() {
            self.rows[into] = self.rows[*from];
            self.residual[into] = self.residual[*from];
        }
        self.rows.truncate(keep.len());
        self.residual.truncate(keep.len());
        self.n_free = keep.len();
        self.blocks.clear();
        self.lambda.clear();
        self.lambda.resize(keep.len(), 0.0);
        self.kept = keep;
    }

    /// Returns true once after contacts or limits that carry a force have closed.
    pub fn take_closed(&mut self) -> bool {
        let mut any = false;
        for block in self.blocks.iter().filter(|block| !block.open && block.given.is_none()) {
            any |= self.memory.take_new(block.slot);
        }
        any
    }

    /// Size of the work of the impulses that the last projection removed rates by `[J]`.
    pub fn rate_work(&self) -> f64 {
        // the mean of the rates before and after, of which the latter are zero
        self.lambda.iter().zip(&self.b).map(|(impulse, rate)| 0.5 * impulse * rate).sum::<f64>().abs()
    }

    /// Largest residual and largest rate of the rows, for joint rates `v`.
    pub fn worst(&self, v: &[f64]) -> (f64, f64) {
        let distance = self.residual.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let rate = self.rows.iter().map(|row| self.motions.rate(row, v).abs()).fold(0.0, f64::max);
        (distance, rate)
    }

    /// Smallest change, in the metric of the mass matrix, of positions that removes the residuals, or of velocities
    /// that removes the rates; the scratch then has the impulses of locked degrees of freedom as reactions.
    pub fn project(&mut self, model: &Model<f64>, scratch: &mut Scratch<f64>, v: Option<&[f64]>, out: &mut [f64]) {
        self.project_to(PROJECTION_RANK, model, scratch, v, out);
    }
}

impl<R: Real> Constraints<R> {
    /// Keeps the bilateral rows.
    pub fn keep_loop_joints(&mut self) {
        self.rows.truncate(self.n_free);
        self.residual.truncate(self.n_free);
        self.blocks.clear();
        self.lambda.clear();
        self.lambda.resize(self.n_free, R::zero());
    }

    /// As [`Constraints::project`], with another rank tolerance.
    pub fn project_to(
        &mut self,
        rank: f64,
        model: &Model<R>,
        scratch: &mut Scratch<R>,
        v: Option<&[R]>,
        out: &mut [R],
    ) {
        self.assemble_delassus(model, scratch);
        self.b.clear();
        match v {
            Some(v) => self.b.extend(self.rows.iter().map(|row| self.motions.rate(row, v))),
            None => self.b.extend_from_slice(&self.residual),
        }
        self.solver.rank = rank;
        // against what they are elsewhere: rows may be small for good, beside a light end
        let squares = core::mem::take(&mut self.row_squares);
        self.drop_rows_below(rank, &squares);
        self.row_squares = squares;
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        self.solver.correct(&problem, &[], &mut self.lambda);
        out.fill(R::zero());
        scratch.reaction.fill(R::zero());
        self.push(model, scratch, out, v.is_some() && !model.params.drives.is_empty(), None);
    }
}

//! Impacts, projections, and what there is to see of contacts: what is done with rows outside of the evaluation of rates.

use super::active_set::ContactProblem;
use super::cone::{ContactMode, UnilateralConstraint};
use super::dense::PROJECTION_RANK;
use super::{Constraints, ContactPoint, dot, pair_of, restitution};
use crate::contact::candidate::tangents;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Vec3;

impl Constraints<f64> {
    /// Velocity changes of an impact: approaching contacts bounce, nothing goes into what it touches, closures stay closed. `scratch` holds what an
    /// impulse meets. Returns the energy that is lost `[J]`.
    pub fn impact(&mut self, model: &Model<f64>, v: &mut [f64], scratch: &mut Scratch<f64>, has_drives: bool) -> f64 {
        let n = model.n_v();
        // no forces of the motion before are meant here
        self.lambda.fill(0.0);
        self.blocks.iter_mut().for_each(|b| b.open = false);
        for block in &mut self.blocks {
            for group in block.groups.iter_mut().flatten() {
                (group.slides, group.grip, group.give) = (false, ContactMode::Stick, None);
            }
            // what is compliant takes its time
            if block.given.is_some() {
                block.given = Some(0.0);
            }
        }
        self.assemble_delassus(model, scratch);
        self.b.clear();
        self.b.extend((0..self.rows.len()).map(|i| dot(&self.jacobian[i * n..(i + 1) * n], v)));
        self.before.clone_from(&self.b);
        for k in 0..self.blocks.len() {
            let block = &self.blocks[k];
            if self.b[block.row] < -model.constraints.rest_speed && block.given.is_none() {
                self.b[block.row] += restitution(model, block.slot) * self.before[block.row];
            }
        }
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        self.solver.solve(&problem, &mut self.blocks, &mut self.lambda);
        let mut change = core::mem::take(&mut self.velocity_change);
        change.fill(0.0);
        self.push(model, scratch, &mut change, has_drives);
        let mut lost = 0.0;
        for i in 0..self.rows.len() {
            let row = &self.jacobian[i * n..(i + 1) * n];
            lost -= self.lambda[i] * (self.before[i] + 0.5 * dot(row, &change));
        }
        for (v, change) in v.iter_mut().zip(&change) {
            *v += *change;
        }
        self.velocity_change = change;
        lost
    }

    /// Keeps the rows of closures.
    pub fn keep_loop_joints(&mut self) {
        self.rows.truncate(self.n_free);
        self.residual.truncate(self.n_free);
        self.blocks.clear();
        self.lambda.clear();
        self.lambda.resize(self.n_free, 0.0);
    }

    /// Keeps the rows that hold as equations: closures, what presses (with `inside` only where it has gone in), and with `sticking` what
    /// sticks.
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
                if sticking && group.grip == ContactMode::Stick {
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

    /// Largest residual, and largest rate for joint rates `v`, of the rows.
    pub fn worst(&self, v: &[f64]) -> (f64, f64) {
        let distance = self.residual.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let rate = self.rows.iter().map(|row| self.motions.rate(row, v).abs()).fold(0.0, f64::max);
        (distance, rate)
    }

    /// The smallest change (in the metric of the mass matrix) of positions that undoes the residuals, or of rates that stops them.
    pub fn project(&mut self, model: &Model<f64>, scratch: &mut Scratch<f64>, v: Option<&[f64]>, out: &mut [f64]) {
        self.assemble_delassus(model, scratch);
        self.b.clear();
        match v {
            Some(v) => self.b.extend(self.rows.iter().map(|row| self.motions.rate(row, v))),
            None => self.b.extend_from_slice(&self.residual),
        }
        self.solver.rank = PROJECTION_RANK;
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        self.solver.correct(&problem, &[], &mut self.lambda);
        out.fill(0.0);
        self.push(model, scratch, out, false);
    }

    /// Torque of the stops on a degree of freedom, as of the last evaluation.
    pub fn limit_torque(&self, model: &Model<f64>, dof: usize) -> f64 {
        let limits = &model.constraints.limits;
        let on = |b: &&UnilateralConstraint<f64>| limits.get(b.slot).is_some_and(|l| l.dof == dof);
        self.blocks.iter().filter(on).map(|b| limits[b.slot].sign * self.lambda[b.row]).sum()
    }

    /// Points of contact that press, with their forces, as of the last evaluation.
    pub fn points(&self, model: &Model<f64>, scratch: &Scratch<f64>) -> impl Iterator<Item = ContactPoint> {
        let set = &model.constraints;
        self.blocks.iter().filter(|b| b.slot >= set.limits.len() && !b.open).filter_map(move |block| {
            let k = block.slot - set.limits.len();
            let at = self.candidates[k]?.kinematics(&self.motions.at(scratch));
            let (t1, t2) = tangents(at.normal);
            let mut force = at.normal.scale(self.lambda[block.row]);
            let mut torque = Vec3::zero();
            for (g, group) in block.groups.iter().enumerate() {
                let Some(group) = group else { continue };
                let l = |k: usize| self.lambda[group.row + k];
                match g {
                    0 => force += t1.scale(l(0)) + t2.scale(l(1)),
                    1 => torque += t1.scale(l(0)) + t2.scale(l(1)),
                    _ => torque += at.normal.scale(l(0)),
                }
            }
            let pair = pair_of(set, k);
            let [one, two] = [set.pairs[pair].a, set.pairs[pair].b];
            // a spot may have its rounded side on either
            let surfaces = if set.colliders[one].link == self.candidates[k]?.a { [one, two] } else { [two, one] };
            Some(ContactPoint {
                pair,
                surfaces,
                point: at.point,
                normal: at.normal,
                force,
                torque,
                distance: at.distance,
            })
        })
    }
}

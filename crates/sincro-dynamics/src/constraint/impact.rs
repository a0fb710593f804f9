//! Impacts and contact points: constraint rows outside of the evaluation of rates.

use super::active_set::ContactProblem;
use super::cone::{ContactMode, UnilateralConstraint};
use super::{Constraints, ContactPoint, dot, pair_of, restitution};
use crate::contact::candidate::tangents;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Vec3;

impl Constraints<f64> {
    /// Solves an impact (Newton restitution on approaching contacts, loop joints and closed contacts kept) and adds the
    /// velocity changes to `v`. `scratch` has the factors of the mass matrix. Returns the energy lost `[J]`.
    pub fn impact(&mut self, model: &Model<f64>, v: &mut [f64], scratch: &mut Scratch<f64>, has_drives: bool) -> f64 {
        let n = model.n_v();
        // forces of the motion before have no meaning here
        self.lambda.fill(0.0);
        self.blocks.iter_mut().for_each(|b| b.open = false);
        for block in &mut self.blocks {
            for group in block.groups.iter_mut().flatten() {
                (group.slides, group.mode, group.compliance) = (false, ContactMode::Stick, None);
            }
            // a compliant contact transmits no impulse
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

    /// Torque of the joint limits on a degree of freedom, as of the last evaluation.
    pub fn limit_torque(&self, model: &Model<f64>, dof: usize) -> f64 {
        let limits = &model.constraints.limits;
        let on = |b: &&UnilateralConstraint<f64>| limits.get(b.slot).is_some_and(|l| l.dof == dof);
        self.blocks.iter().filter(on).map(|b| limits[b.slot].sign * self.lambda[b.row]).sum()
    }

    /// Contact points with a force, as of the last evaluation.
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
            // a candidate may have its rounded side on either surface
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

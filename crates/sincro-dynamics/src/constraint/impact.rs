//! Impacts and contact points: constraint rows outside of the evaluation of rates.

use sincro_complementarity::{ContactMode, ContactProblem, Load, UnilateralConstraint};
use sincro_math::dot;

use super::assembly::restitution;
use super::{Constraints, ContactPoint, LOCATED_DISTANCE, pair_of};
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Vec3;

/// Law of restitution of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RestitutionLaw {
    Newton,
    Poisson,
    None,
}

/// Rounding of the energy lost, relative to the works that it is the difference of.
const ROUNDING: f64 = 1e-12;

/// Speed above which no contacts come to rest, however short their way [m/s], [rad/s].
const MAX_SETTLING_SPEED: f64 = 1e-4;

/// Returns true if the energy does not rise.
fn is_loss((lost, works): (f64, f64)) -> bool {
    lost >= -ROUNDING * works
}

impl Constraints<f64> {
    /// Solves an impact (loop joints and closed contacts kept) and adds the velocity changes to `v`. `scratch` has the
    /// factors of the mass matrix. Returns the energy lost `[J]`.
    ///
    /// Restitution is Newton's, of approaching velocities. Where friction lets that raise the energy, or redundant rows
    /// leave no such velocities, it is Poisson's, of the impulses that stop the approach; where that raises the energy
    /// too, there is none. Source: key `brogliato2016` (chapter 4).
    pub fn impact(&mut self, model: &Model<f64>, v: &mut [f64], scratch: &mut Scratch<f64>, has_drives: bool) -> f64 {
        let n = model.n_v();
        self.assemble_delassus(model, scratch);
        self.before.clear();
        self.before.extend((0..self.rows.len()).map(|i| dot(&self.jacobian[i * n..(i + 1) * n], v)));
        let report = self.solver.report;
        if self.settles() {
            return self.settle(model, v, scratch, has_drives);
        }
        let mut lost = self.solve_impact(model, RestitutionLaw::Newton);
        if !lost.is_ok_and(is_loss) && self.restores(model) {
            self.solver.report.discard(&report);
            lost = self.solve_impact(model, RestitutionLaw::Poisson);
            if !lost.is_ok_and(is_loss) {
                self.solver.report.discard(&report);
                lost = self.solve_impact(model, RestitutionLaw::None);
            }
        }
        self.apply_impulses(model, v, scratch, has_drives);
        let (Ok((lost, _)) | Err((lost, _))) = lost;
        lost
    }

    /// Adds the velocity changes by the impulses to `v`.
    fn apply_impulses(&mut self, model: &Model<f64>, v: &mut [f64], scratch: &mut Scratch<f64>, has_drives: bool) {
        let mut change = core::mem::take(&mut self.velocity_change);
        change.fill(0.0);
        self.push(model, scratch, &mut change, has_drives, None);
        for (v, change) in v.iter_mut().zip(&change) {
            *v += *change;
        }
        self.velocity_change = change;
    }

    /// Returns true if all contacts that are closed approach or separate so slowly that they come to rest: a body that
    /// rocks from one contact to the other would otherwise make ever shorter and slower impacts without end. So do
    /// those that have come no further, from one event to the next, than what the instants of closing are located to:
    /// where large forces bring them back, their speeds are those of that distance and get no smaller.
    fn settles(&self) -> bool {
        let rates = self.blocks.iter().filter(|block| !block.is_compliant).map(|block| self.before[block.row]);
        let fastest = rates.fold(0.0, |largest: f64, rate| largest.max(rate.abs()));
        let has_not_left = fastest < MAX_SETTLING_SPEED && fastest * self.time_since_event < 10.0 * LOCATED_DISTANCE;
        fastest < self.settling_speed || has_not_left
    }

    /// Brings the normal rates of all closed contacts to zero. Returns the energy lost `[J]`, which is never negative:
    /// the velocities are projected in the metric of the mass matrix.
    fn settle(&mut self, model: &Model<f64>, v: &mut [f64], scratch: &mut Scratch<f64>, has_drives: bool) -> f64 {
        self.reset_impact();
        for block in &mut self.blocks {
            block.groups = [None; 3];
        }
        self.b.clone_from(&self.before);
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        self.solver.hold(&problem, &mut self.blocks, &mut self.lambda, Load::Shared);
        self.apply_impulses(model, v, scratch, has_drives);
        self.work_of_impulses().0
    }

    /// Energy lost by the impulses, and the sum of the works that it is the difference of `[J]`.
    fn work_of_impulses(&self) -> (f64, f64) {
        let m = self.rows.len();
        let (mut lost, mut works) = (0.0, 0.0);
        for i in 0..m {
            let change = dot(&self.a[i * m..(i + 1) * m], &self.lambda);
            lost -= self.lambda[i] * (self.before[i] + 0.5 * change);
            works += (self.lambda[i] * self.before[i]).abs() + (self.lambda[i] * change).abs();
        }
        (lost, works)
    }

    /// Returns true if a contact that approaches has restitution.
    fn restores(&self, model: &Model<f64>) -> bool {
        self.blocks.iter().any(|block| self.coefficient(model, block) > 0.0)
    }

    /// Coefficient of restitution of a constraint in this impact: zero if it does not approach.
    fn coefficient(&self, model: &Model<f64>, block: &UnilateralConstraint<f64>) -> f64 {
        let approaches = self.before[block.row] < -model.params.constraints.rest_speed && !block.is_compliant;
        if approaches { restitution(model, block.slot) } else { 0.0 }
    }

    /// Finds the impulses under a law of restitution. Returns the energy lost and the sum of the works that it is the
    /// difference of `[J]`; as an error if the problem has no solution.
    fn solve_impact(&mut self, model: &Model<f64>, law: RestitutionLaw) -> Result<(f64, f64), (f64, f64)> {
        self.reset_impact();
        self.b.clone_from(&self.before);
        if law == RestitutionLaw::Newton {
            for k in 0..self.blocks.len() {
                let (row, e) = (self.blocks[k].row, self.coefficient(model, &self.blocks[k]));
                if e > 0.0 {
                    self.b[row] += e * self.before[row];
                }
            }
        }
        let failures = self.solver.report.not_converged;
        self.solve_impulses();
        if law == RestitutionLaw::Poisson {
            for k in 0..self.blocks.len() {
                let e = self.coefficient(model, &self.blocks[k]);
                if e > 0.0 && !self.blocks[k].open {
                    self.blocks[k].given = Some((1.0 + e) * self.lambda[self.blocks[k].row]);
                }
            }
            self.solve_impulses();
            self.block_approach();
        }
        let work = self.work_of_impulses();
        if self.solver.report.not_converged > failures { Err(work) } else { Ok(work) }
    }

    /// Takes back prescribed impulses under which a contact still approaches.
    fn block_approach(&mut self) {
        let m = self.rows.len();
        for _ in 0..self.blocks.len() {
            let mut taken_back = false;
            for block in self.blocks.iter_mut().filter(|block| !block.is_compliant && block.given.is_some()) {
                let rate = self.b[block.row] + dot(&self.a[block.row * m..(block.row + 1) * m], &self.lambda);
                if rate < 0.0 {
                    block.given = None;
                    taken_back = true;
                }
            }
            if !taken_back {
                return;
            }
            self.solve_impulses();
        }
    }

    fn solve_impulses(&mut self) {
        let problem = ContactProblem { a: &self.a, b: &self.b, n_free: self.n_free };
        self.solver.solve(&problem, &mut self.blocks, &mut self.lambda);
    }

    /// Puts multipliers and modes to the start of an impact: forces of the motion before have no meaning in it.
    fn reset_impact(&mut self) {
        self.lambda.fill(0.0);
        for block in &mut self.blocks {
            block.open = false;
            for group in block.groups.iter_mut().flatten() {
                (group.is_sliding, group.mode, group.compliance) = (false, ContactMode::Stick, None);
            }
            // a compliant contact transmits no impulse
            block.given = block.is_compliant.then_some(0.0);
        }
    }

    /// Torque of the joint limits on a degree of freedom, as of the last evaluation.
    pub fn limit_torque(&self, model: &Model<f64>, dof: usize) -> f64 {
        let limits = &model.params.constraints.limits;
        let on = |b: &&UnilateralConstraint<f64>| limits.get(b.slot).is_some_and(|l| l.dof == dof);
        self.blocks.iter().filter(on).map(|b| limits[b.slot].sign * self.lambda[b.row]).sum()
    }

    /// Contact points with a force, as of the last evaluation.
    pub fn points(&self, model: &Model<f64>, scratch: &Scratch<f64>) -> impl Iterator<Item = ContactPoint> {
        let set = &model.params.constraints;
        self.blocks.iter().filter(|b| b.slot >= set.limits.len() && !b.open && !b.is_drive()).filter_map(move |block| {
            let k = block.slot - set.limits.len();
            let candidate = self.candidates.get(k)?;
            let at = candidate.kinematics(&self.motions.at(scratch));
            let mut force = at.normal.scale(self.lambda[block.row]);
            let mut torque = Vec3::zero();
            for (g, group) in block.groups.iter().enumerate() {
                let Some(group) = group else { continue };
                // rows of a sliding group are turned along its velocity
                for k in group.row..group.row + group.dim {
                    let (row, lambda) = (&self.rows[k], self.lambda[k]);
                    if g == 0 {
                        force += row.wa.lin.scale(lambda);
                    } else {
                        torque += row.wa.ang.scale(lambda);
                    }
                }
            }
            let pair = pair_of(set, k);
            let [one, two] = [set.pairs[pair].a, set.pairs[pair].b];
            // a candidate may have its rounded side on either surface
            let surfaces = if set.colliders[one].link == candidate.a { [one, two] } else { [two, one] };
            Some(ContactPoint {
                pair,
                surfaces,
                point: candidate.friction_point(&at, block.is_compliant),
                normal: at.normal,
                force,
                torque,
                distance: at.distance,
            })
        })
    }
}

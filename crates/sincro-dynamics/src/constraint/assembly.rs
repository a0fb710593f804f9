//! Assembly of the contact problem: rows, residuals and unilateral constraints of everything closed; the Delassus
//! matrix; the vector b at velocity level.

use sincro_complementarity::{ContactMode, FrictionGroup, SlowSliding, UnilateralConstraint};
use sincro_math::{Real, dot};

use super::row::{Row, force_at, force_rate};
use super::{CLOSED_DISTANCE, Constraints, ModeRule, pair_of};
use crate::contact::Pair;
use crate::contact::candidate::{ContactCandidate, ContactKinematics, tangents};
use crate::contact::candidate_list::SlotCandidate;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::{Force, Vec3};

impl<R: Real> Constraints<R> {
    /// Assembles rows, residuals and unilateral constraints of everything closed, at the poses of `scratch` and the
    /// twists of `motions`. `within` a sub-step friction slides as classified at its start, and what has left since
    /// is no constraint any more: it may well be approached, and meets with an impact.
    pub fn assemble(&mut self, model: &Model<R>, q: &[R], v: &[R], scratch: &Scratch<R>, within: bool) {
        let set = &*model.params.constraints;
        self.assemble_loops(model, q, v, scratch);
        for (slot, limit) in set.limits.iter().enumerate() {
            if self.memory.is_closed(slot) {
                let sign = R::splat(limit.sign);
                let distance = sign * (q[limit.coordinate] - R::splat(limit.bound));
                if within && self.has_left(slot, distance, sign * v[limit.dof]) {
                    continue;
                }
                self.rows.push(Row::of_joints([(limit.dof as u32, sign), (crate::joint::WORLD, R::zero())]));
                self.residual.push(distance);
                let row = self.rows.len() - 1;
                self.blocks.push(UnilateralConstraint::contact(slot, row, [None; 3]));
            }
        }
        let candidates = core::mem::take(&mut self.candidates);
        for (k, SlotCandidate { slot, pair, candidate }) in candidates.iter().enumerate() {
            let slot = set.limits.len() + *slot as usize;
            if self.memory.is_closed(slot) {
                // a problem of sweeps is at velocity level: that of the instant of the classification
                let classified = self.kinematics.get(k).filter(|_| self.sweeps && !within).copied();
                let at = classified.unwrap_or_else(|| candidate.kinematics(&self.motions.at(scratch)));
                self.contact((slot, candidate), &at, &set.pairs[*pair as usize], v, within);
            }
        }
        self.candidates = candidates;
        self.lambda.clear();
        self.lambda.resize(self.rows.len(), R::zero());
        self.memory.restore(&mut self.blocks, &mut self.lambda, self.mode_rule != ModeRule::Decided);
    }

    /// Assembles the rows and residuals of loop joints and gears that are used, and nothing else.
    pub fn assemble_loops(&mut self, model: &Model<R>, q: &[R], v: &[R], scratch: &Scratch<R>) {
        let set = &*model.params.constraints;
        self.rows.clear();
        self.residual.clear();
        self.blocks.clear();
        for joint in &set.loop_joints {
            joint.rows(scratch, &self.motions, &mut self.rows, &mut self.residual);
        }
        for gear in &set.gears {
            let [one, two] = gear.dofs.map(|k| k as u32);
            let q1 = q[gear.coordinates[0]];
            let row = Row::of_joints([(one, -gear.slope(q1)), (two, R::one())]);
            let square = |rate: R| rate * rate;
            let bias = gear.is_polynomial().then(|| -(gear.curvature(q1) * square(v[gear.dofs[0]])));
            self.rows.push(Row { bias, ..row });
            self.residual.push(gear.residual(q));
        }
        let mut is_used = self.is_independent.iter();
        self.rows.retain(|_| *is_used.next().unwrap_or(&true));
        let mut is_used = self.is_independent.iter();
        self.residual.retain(|_| *is_used.next().unwrap_or(&true));
        self.n_free = self.rows.len();
    }

    fn contact(
        &mut self,
        (slot, candidate): (usize, &ContactCandidate),
        at: &ContactKinematics<R>,
        pair: &Pair,
        v: &[R],
        within: bool,
    ) {
        let row = self.rows.len();
        let n = at.normal;
        // points of a face that lie in one plane do not contradict each other in friction
        let c = if self.sweeps { at.point - n.scale(at.distance) } else { at.point };
        let normal =
            Row::between(candidate.a, candidate.b, force_at(c, n), force_rate(c, n, at.point_dot, at.normal_dot));
        let material = &pair.material;
        if within && !material.stiffness.is_finite() && self.has_left(slot, at.distance, self.motions.rate(&normal, v))
        {
            return;
        }
        self.add(normal, at.distance);
        let given = material.stiffness.is_finite().then(|| {
            let rate = self.motions.rate(&normal, v);
            let k = R::splat(material.stiffness);
            let force = -(k * at.distance) * (R::one() - R::splat(material.dissipation) * rate);
            // no adhesion
            force.max(R::zero())
        });
        let is_compliant = given.is_some() && !self.sweeps;
        let c = if is_compliant { candidate.friction_point(at, true) } else { c };
        let c_dot = candidate.friction_point_dot(at, self.motions.twist_of(candidate.b), is_compliant);
        let (t1, t2) = tangents(n);
        let zero = Vec3::zero();
        let mut groups = [None; 3];
        let wanted = [(2, material.friction), (2, material.rolling_friction), (1, material.spinning_friction)];
        for (g, (dim, coefficient)) in wanted.into_iter().enumerate() {
            if coefficient <= 0.0 {
                continue;
            }
            let first = self.rows.len();
            let axes = if g == 2 { [n, n] } else { [t1, t2] };
            for t in axes.into_iter().take(dim) {
                // tangents turn with the normal: a contact that sinks in or spins has a rate along it
                let t_dot = if g == 2 { at.normal_dot } else { n.scale(-at.normal_dot.dot(t)) };
                let (force, rate) = match g {
                    0 => (force_at(c, t), force_rate(c, t, c_dot, t_dot)),
                    _ => (Force { ang: t, lin: zero }, Force { ang: t_dot, lin: zero }),
                };
                self.add(Row::between(candidate.a, candidate.b, force, rate), R::zero());
            }
            let is_sliding = within && self.memory.is_sliding(slot, g);
            let mut group = FrictionGroup {
                row: first,
                dim,
                coefficient,
                slack: 1.0,
                is_sliding,
                mode: ContactMode::Stick,
                direction: [R::zero(); 2],
                compliance: None,
                slow_sliding: SlowSliding::default(),
            };
            if is_sliding {
                group.mode = ContactMode::Slip;
                let (direction, speed) = self.direction_against(first, dim, v, self.memory.direction(slot, g));
                group.direction = self.memory.set_direction(slot, g, direction, speed);
                if dim == 2 {
                    self.align(&mut group, speed);
                }
            }
            groups[g] = Some(group);
        }
        self.blocks.push(UnilateralConstraint { slot, row, open: false, given, is_compliant: given.is_some(), groups });
    }

    /// Returns true if a slot that was open at the start of the sub-step is apart now, or comes back with an impact.
    fn has_left(&self, slot: usize, distance: R, rate: R) -> bool {
        (distance.lane(0) > CLOSED_DISTANCE || rate.lane(0) < -self.zero_speed) && self.memory.starts_open(slot)
    }

    pub(super) fn add(&mut self, row: Row<R>, residual: R) {
        self.rows.push(row);
        self.residual.push(residual);
    }

    /// Unit direction opposite to the velocity of a group of rows, and the speed; `last` where the velocity is zero.
    fn direction_against(&self, first: usize, dim: usize, v: &[R], last: [R; 2]) -> ([R; 2], R) {
        let mut u = [R::zero(); 2];
        for k in 0..dim {
            u[k] = self.motions.rate(&self.rows[first + k], v);
        }
        let square = u[0] * u[0] + u[1] * u[1];
        if square.lane(0) < 1e-28 {
            return (last, R::zero());
        }
        let speed = square.sqrt();
        let inverse = R::one() / speed;
        (u.map(|x| -(x * inverse)), speed)
    }

    /// Rotates the two rows of a sliding group to one along and one across the sliding direction; stores the speed.
    fn align(&mut self, group: &mut FrictionGroup<R>, speed: R) {
        let (i, j) = (group.row, group.row + 1);
        let (one, two, d) = (self.rows[i], self.rows[j], group.direction);
        self.rows[i] = one.combined(&two, -d[0], -d[1]);
        self.rows[j] = one.combined(&two, d[1], -d[0]);
        group.direction = [-R::one(), R::zero()];
        group.compliance = Some(speed);
    }

    /// Jacobian and Delassus matrix of the rows.
    pub fn assemble_delassus(&mut self, model: &Model<R>, scratch: &Scratch<R>) {
        let (m, n) = (self.rows.len(), model.n_v());
        self.solver.reserve(m);
        self.jacobian.clear();
        self.jacobian.resize(m * n, R::zero());
        for (row, j) in self.rows.iter().zip(self.jacobian.chunks_exact_mut(n.max(1))) {
            self.motions.jacobian(model, row, j);
        }
        self.delassus_factors.products(model, scratch, self.motions.columns(), &self.rows, &mut self.a);
    }

    /// Vector b at velocity level: (J v)/h + J v̇, relaxed by the remaining distance of open constraints, with
    /// restitution for impacts.
    pub(super) fn velocity_level_rates(&mut self, model: &Model<R>, h: f64, v: &[R], v_dot: &[R]) {
        let n = model.n_v();
        let per_h = R::splat(1.0 / h);
        for i in 0..self.rows.len() {
            let row = &self.jacobian[i * n..(i + 1) * n];
            let mut sum = R::zero();
            for k in 0..n {
                sum += row[k] * (v[k] * per_h + v_dot[k]);
            }
            self.b.push(sum);
        }
        let rest_speed = model.params.constraints.rest_speed;
        for block in self.blocks.iter().filter(|block| !block.is_drive()) {
            let i = block.row;
            let row = &self.jacobian[i * n..(i + 1) * n];
            let speed = dot(row, v);
            let bounce = restitution(model, block.slot);
            let has_impact = self.residual[i].lane(0) + h * h * self.b[i].lane(0) <= 0.0;
            if speed.lane(0) < -rest_speed && bounce > 0.0 && has_impact {
                // from the present distance: to close it first would take the approach velocity away
                self.b[i] += speed * per_h * R::splat(bounce);
            } else if self.residual[i].lane(0) > CLOSED_DISTANCE {
                // a distance that is zero but for rounding is not used: several distances of one face would contradict
                // each other
                self.b[i] += self.residual[i] * per_h * per_h;
            }
        }
    }
}

pub(super) fn restitution<R: Real>(model: &Model<R>, slot: usize) -> f64 {
    let set = &model.params.constraints;
    match set.limits.get(slot) {
        Some(limit) => limit.restitution,
        None => set.pairs[pair_of(set, slot - set.limits.len())].material.restitution,
    }
}

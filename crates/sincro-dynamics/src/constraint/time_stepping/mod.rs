//! Time-stepping level: the frictional contact problem of a whole step at velocity level, for many contacts.
//!
//! Moreau–Jean time-stepping poses one complementarity problem a step, w = G λ + b with w = J v⁺/h. Where it has many
//! rows, the Delassus matrix G = J M⁻¹ Jᵀ is never formed. With the innovations factorisation M⁻¹ = Aᵀ A of the
//! articulated-body algorithm ([`super::delassus`]) each row is yᵢ = A Jᵢᵀ, which has one number for each degree of
//! freedom on the ways of its two links to the base, and G_ij = yᵢ·yⱼ. With the whitened velocities z = Σ λᵢ yᵢ a rate
//! is wᵢ = bᵢ + yᵢ·z: a sweep over all contacts costs as much as the rows are long, for free bodies and robots alike.
//!
//! Bodies that touch each other directly or through others form an *island*; islands do not depend on each other and
//! are solved one by one ([`sincro_complementarity::sweeps`]): Gauss–Seidel sweeps with the solution of each contact's
//! own problem and Anderson acceleration. The residual of the Coulomb law is the test of convergence, and reported
//! where it misses the tolerance.
//!
//! The constraint residual enters the vector b: a distance is used up within the step, a penetration reduced, over the
//! points of a face as the motion of a rigid body can do it ([`UsableDistance`]).
//!
//! Sources: keys `acary2008` (chapters 10 and 13), `jain2011` (chapter 7), `jean1999`.

#[cfg(test)]
mod tests;

use sincro_complementarity::sweeps::islands::Islands;
use sincro_complementarity::sweeps::usable_distance::UsableDistance;
use sincro_complementarity::sweeps::whitening::Contact;
use sincro_complementarity::sweeps::{Law, Sweeper};
use sincro_complementarity::{ContactMode, UnilateralConstraint};
use sincro_math::Real;

use super::assembly::restitution;
use super::row::Row;
use super::{Constraints, pair_of};
use crate::joint::WORLD;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Force;

/// Number of rows above which a step at velocity level is solved here, and not by an active set.
pub(crate) const DIRECT_ROWS: usize = 24;

/// Velocity of a correction that is not made, over that which counts as none: at the arm of a meter it takes more than
/// bodies at rest may have.
const NO_CORRECTION: f64 = 10.0;

/// Share of the friction limit beyond which a group counts as one that slips.
const AT_LIMIT: f64 = 1.0 - 1e-9;

/// Working memory; grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub(super) struct TimeStepping {
    islands: Islands,
    sweeper: Sweeper,
    /// Place of each block among those of the same two links, and the items of an island in the order of sweeps.
    places: Vec<u32>,
    order: Vec<(u32, usize)>,
    /// Numbers of one row, and its degrees of freedom.
    values: Vec<f64>,
    dofs: Vec<u32>,
}

impl<R: Real> Constraints<R> {
    /// Returns true if the constraints last classified as closed have so many rows that a problem at velocity level is
    /// solved by sweeps.
    pub fn is_large(&self, model: &Model<R>) -> bool {
        let set = &*model.params.constraints;
        let of_slots = self.memory.closed_slots().map(|slot| match slot.checked_sub(set.limits.len()) {
            Some(contact) => set.pairs[pair_of(set, contact)].rows_per_point(),
            None => 1,
        });
        let mut rows = self.is_independent.iter().filter(|used| **used).count();
        rows > DIRECT_ROWS
            || of_slots.into_iter().any(|more| {
                rows += more;
                rows > DIRECT_ROWS
            })
    }

    /// Solves the problem of a step of length `h` and adds the constraint forces to the accelerations `v_dot` of the
    /// free motion; `v` are the velocities at its start.
    pub(super) fn apply_by_sweeps(
        &mut self,
        model: &Model<R>,
        (h, v): (f64, &[R]),
        scratch: &mut Scratch<R>,
        v_dot: &mut [R],
        has_drives: bool,
    ) {
        for (row, force) in self.blocks.iter().filter_map(|block| Some((block.row, block.given?))) {
            self.lambda[row] = force;
        }
        self.find_step_rates(model, (h, v), v_dot);
        self.aim_at_targets(h);
        let mut sweeps = core::mem::take(&mut self.time_stepping);
        self.find_islands(model, scratch, &mut sweeps.islands);
        self.rest.begin_solution(v, v_dot, &sweeps.islands);
        self.collect_blocks(model, &mut sweeps);
        sweeps.sweeper.solve(h, self.given_forces, &mut self.solver.report);
        self.read_blocks(&sweeps);
        self.memory.keep(&self.blocks, &self.lambda);
        let n_limits = model.params.constraints.limits.len();
        let id = |slot: usize| self.candidates.get(slot - n_limits).map_or(0, |candidate| candidate.id);
        self.memory.keep_features(|slot| if slot < n_limits { 0 } else { id(slot) });
        (self.conditioning, self.is_swept) = (1.0, true);
        (self.violation, self.lost_modes) = (None, false);
        self.push_wrenches(model, scratch, v_dot, has_drives);
        self.rest.settle((v, h), &sweeps.islands, &sweeps.sweeper, v_dot);
        self.keep_slots_at_rest(model);
        self.time_stepping = sweeps;
        self.take_drive_torques(false, scratch, v_dot);
    }

    /// Keeps the warm start of the contacts at rest.
    fn keep_slots_at_rest(&mut self, model: &Model<R>) {
        let (set, rest) = (&*model.params.constraints, &self.rest);
        let has_sleepers = rest.has_sleepers();
        self.memory.keep_resting(|slot| {
            let contact = slot.checked_sub(set.limits.len()).filter(|_| has_sleepers);
            contact.is_some_and(|contact| rest.rests(set.links_of(&set.pairs[pair_of(set, contact)])))
        });
    }

    /// Ends a step at velocity level in which everything that touches is left out.
    pub(super) fn leave_all_out(&mut self) {
        self.contact_torque.fill(R::zero());
        (self.conditioning, self.is_swept) = (1.0, true);
        (self.violation, self.lost_modes) = (None, false);
    }

    /// Vector b: rates of the free motion over the step, by its length, with distances and restitution.
    fn find_step_rates(&mut self, model: &Model<R>, (h, v): (f64, &[R]), v_dot: &[R]) {
        let per_h = 1.0 / h;
        let mut velocity = core::mem::take(&mut self.velocity_change);
        for ((out, v), v_dot) in velocity.iter_mut().zip(v).zip(v_dot) {
            *out = *v * R::splat(per_h) + *v_dot;
        }
        self.motions.place_velocities(model, &velocity);
        self.velocity_change = velocity;
        self.b.clear();
        self.b.extend(self.rows.iter().map(|row| self.motions.placed_rate(row, &self.velocity_change)));
        let set = &*model.params.constraints;
        let pair = |slot: usize| slot.checked_sub(set.limits.len()).map(|contact| &set.pairs[pair_of(set, contact)]);
        let mut k = 0;
        while let Some(first) = self.blocks.get(k).filter(|block| !block.is_drive()) {
            let of_pair = first.slot..pair(first.slot).map_or(0, |pair| set.limits.len() + pair.first + pair.slots);
            let is_same = |block: &&UnilateralConstraint<R>| of_pair.contains(&block.slot);
            let more = self.blocks[k + 1..].iter().take_while(|block| !block.is_drive()).take_while(is_same).count();
            let manifold = k..k + 1 + more;
            k = manifold.end;
            let bounce = restitution(model, first.slot);
            let distances = self.blocks[manifold.clone()].iter().map(|block| self.residual[block.row].lane(0));
            let usable = UsableDistance::of(distances, NO_CORRECTION * h * self.rest.quiet_speed());
            for block in &self.blocks[manifold] {
                let i = block.row;
                let distance = self.residual[i].lane(0);
                let correction = usable.at(distance) * per_h * per_h;
                if bounce > 0.0 && distance + h * h * self.b[i].lane(0) <= 0.0 {
                    let speed = self.motions.rate(&self.rows[i], v).lane(0);
                    if speed < -set.rest_speed {
                        // from the present distance: to close it first would take the approach velocity away; but out
                        // of a penetration that bouncing does not remove
                        self.b[i] += R::splat((speed * per_h * bounce).min(correction));
                        continue;
                    }
                }
                self.b[i] += R::splat(correction);
            }
        }
    }

    /// Islands of all constraints: bilateral rows come first, then unilateral constraints and drives.
    fn find_islands(&mut self, model: &Model<R>, scratch: &Scratch<R>, islands: &mut Islands) {
        self.delassus_factors.place(model, scratch);
        // the last row of a constraint is that of a drive, whose first one acts on nothing
        let last_row = |block: &UnilateralConstraint<R>| {
            block.groups[0].as_ref().filter(|_| block.is_drive()).map_or(block.row, |group| group.row)
        };
        let items = (0..self.n_free).chain(self.blocks.iter().map(last_row));
        islands.find(items.map(|row| self.delassus_factors.trees(&self.rows[row])));
    }

    /// Place of each block in the order of sweeps: limits and the first points of all manifolds, then their second
    /// ones, and so on, at last the drives. Points that follow each other so move different bodies, and a processor
    /// computes them at once.
    fn find_places(&self, places: &mut Vec<u32>) {
        places.clear();
        let mut last = None;
        for block in &self.blocks {
            let row = &self.rows[block.row];
            let links = Some((row.a, row.b)).filter(|(a, b)| a != b);
            let place = match places.last() {
                _ if block.is_drive() => u32::MAX,
                Some(before) if links.is_some() && links == last => before + 1,
                _ => 0,
            };
            places.push(place);
            last = links;
        }
    }

    /// Whitened rows of all blocks, island by island.
    fn collect_blocks(&mut self, model: &Model<R>, sweeps: &mut TimeStepping) {
        let TimeStepping { islands, sweeper, places, order, values, dofs } = sweeps;
        let rows = &self.rows;
        sweeper.clear(model.n_v());
        self.find_places(places);
        let columns = self.motions.columns();
        self.delassus_factors.place_mass_factors(columns);
        for k in 0..islands.len() {
            order.clear();
            order.extend(islands.items(k).map(|item| {
                let block = item.checked_sub(self.n_free);
                (block.map_or(0, |block| places[block]), item)
            }));
            order.sort_unstable();
            for &(_, item) in order.iter() {
                let mut add = |sweeper: &mut Sweeper, law: Law, first: usize, n: usize| {
                    values.clear();
                    for row in &rows[first..first + n] {
                        dofs.clear();
                        self.delassus_factors.factor_row(model, columns, row, |dof, value| {
                            dofs.push(dof);
                            values.push(value.lane(0));
                        });
                    }
                    let of = |list: &[R]| -> [f64; 3] {
                        core::array::from_fn(|k| if k < n { list[first + k].lane(0) } else { 0.0 })
                    };
                    sweeper.add(law, first, n, dofs, values, of(&self.b), of(&self.lambda));
                };
                if item < self.n_free {
                    add(sweeper, Law::Bilateral, item, 1);
                    continue;
                }
                let block = &self.blocks[item - self.n_free];
                let normal = sweeper.block_count();
                let mut groups = block.groups.iter();
                match (block.given, block.groups[0]) {
                    (Some(_), _) if block.is_drive() => {
                        let group = block.groups[0].expect("a drive is a friction group");
                        let limit = group.coefficient * self.lambda[block.row].lane(0);
                        add(sweeper, Law::Interval { limit }, group.row, 1);
                        continue;
                    }
                    (Some(force), _) => {
                        add(sweeper, Law::Given { force: force.lane(0) }, block.row, 1);
                    }
                    // the rows of a contact's sliding friction follow its normal row
                    (None, Some(group)) if group.row == block.row + 1 => {
                        self.add_contact(sweeper, block.row, group.coefficient);
                        groups.next();
                    }
                    (None, _) => add(sweeper, Law::Unilateral, block.row, 1),
                }
                for group in groups.flatten() {
                    add(sweeper, Law::Disc { coefficient: group.coefficient, normal }, group.row, group.dim);
                }
            }
            sweeper.end_island(self.rest.stillness(k));
        }
    }

    /// Adds a contact, whose rows are of its two links alone.
    fn add_contact(&self, sweeper: &mut Sweeper, row: usize, friction: f64) {
        let rows = &self.rows[row..row + 3];
        let wrench = core::array::from_fn(|i| {
            let of = |row: &Row<R>| (if i < 3 { row.wa.ang[i] } else { row.wa.lin[i - 3] }).lane(0);
            [of(&rows[0]), of(&rows[1]), of(&rows[2]), 0.0]
        });
        let of = |list: &[R]| -> [f64; 3] { core::array::from_fn(|k| list[row + k].lane(0)) };
        let (b, lambda) = (of(&self.b), of(&self.lambda));
        let mass = self.delassus_factors.mass_factors();
        sweeper.add_contact(mass, &Contact { friction, row, links: [rows[0].a, rows[0].b], wrench, b, lambda });
    }

    /// Multipliers and modes of the blocks.
    fn read_blocks(&mut self, sweeps: &TimeStepping) {
        sweeps.sweeper.read(|row, lambda| self.lambda[row] = R::splat(lambda));
        for block in &mut self.blocks {
            let normal = self.lambda[block.row];
            block.open = block.given.is_none() && normal.lane(0) <= 0.0;
            read_modes(block, normal.lane(0), &self.lambda, &self.b);
        }
    }

    /// Adds the response to the constraint forces to accelerations and reactions, from the wrenches on the links.
    fn push_wrenches(&mut self, model: &Model<R>, scratch: &mut Scratch<R>, v_dot: &mut [R], has_drives: bool) {
        let of_drives = self.blocks.iter().find(|block| block.is_drive()).map_or(self.rows.len(), |block| block.row);
        self.find_torques(model, 0..of_drives);
        self.contact_torque.copy_from_slice(&self.torque);
        for i in of_drives..self.rows.len() {
            for (dof, c) in self.rows[i].joints.into_iter().filter(|(dof, _)| *dof != WORLD) {
                self.torque[dof as usize] += c * self.lambda[i];
            }
        }
        self.respond(model, scratch, v_dot, has_drives);
    }

    /// Generalized forces Jᵀ λ of a range of rows.
    fn find_torques(&mut self, model: &Model<R>, rows: core::ops::Range<usize>) {
        self.wrenches.fill(Force::zero());
        self.torque.fill(R::zero());
        for (row, lambda) in self.rows[rows.clone()].iter().zip(&self.lambda[rows]) {
            if *lambda == R::zero() {
                continue;
            }
            if row.a != WORLD {
                self.wrenches[row.a as usize] += row.wa.scale(*lambda);
            }
            if row.b != WORLD {
                self.wrenches[row.b as usize] -= row.wb.scale(*lambda);
            }
            for (dof, c) in row.joints.into_iter().filter(|(dof, _)| *dof != WORLD) {
                self.torque[dof as usize] += c * *lambda;
            }
        }
        let columns = self.motions.columns();
        for (i, link) in model.links.iter().enumerate().rev() {
            let wrench = self.wrenches[i];
            let first = link.v_idx as usize;
            for k in first..first + link.kind.n_v() {
                self.torque[k] += columns[k].dot(&wrench);
            }
            if link.parent != WORLD {
                self.wrenches[link.parent as usize] += wrench;
            }
        }
    }
}

/// Modes of the friction groups of a constraint, from its multipliers.
fn read_modes<R: Real>(block: &mut UnilateralConstraint<R>, normal: f64, lambda: &[R], b: &[R]) {
    let is_drive = block.is_drive();
    for group in block.groups.iter_mut().flatten() {
        let force: [f64; 2] = core::array::from_fn(|k| if k < group.dim { lambda[group.row + k].lane(0) } else { 0.0 });
        let size = (force[0] * force[0] + force[1] * force[1]).sqrt();
        if size > 0.0 && size > AT_LIMIT * group.coefficient * normal {
            (group.mode, group.direction) = (ContactMode::Slip, force.map(|x| R::splat(x / size)));
        } else if is_drive && group.coefficient * normal <= 0.0 {
            // a drive without any force is saturated, against the rate that it does not change
            let against = if b[group.row].lane(0) > 0.0 { -1.0 } else { 1.0 };
            (group.mode, group.direction) = (ContactMode::Slip, [R::splat(against), R::zero()]);
        } else {
            group.mode = ContactMode::Stick;
        }
    }
}

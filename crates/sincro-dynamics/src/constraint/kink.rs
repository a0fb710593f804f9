//! Limited drives at the kink of their law, as constraints of the contact problem.
//!
//! A limited motor is dry friction with a moving surface: −(v − v*) ∈ N_C(τ) with C = [−L, L]. Where contacts or limits
//! are closed, the drives whose velocity is their target are therefore constraints of the same problem, each a friction
//! group of one row, the velocity of its joint, under a given normal force: all modes are decided together, and where
//! drives and contacts are redundant (a robot that brakes four wheels on the ground) they share the load. Source: key
//! `acary2008`, chapter 3 (set-valued laws).

use sincro_actuation::Kink;
use sincro_complementarity::{ContactMode, FrictionGroup, HELD_RATE, NO_SLOT, UnilateralConstraint};
use sincro_math::Real;

use super::Constraints;
use super::row::Row;
use crate::joint::WORLD;
use crate::scratch::Scratch;

/// Normal force under which the limit of a drive is friction `[N]`: a power of two, and far below any force that could
/// give a problem its scale.
const NORMAL: f64 = 1.0 / (1_u128 << 100) as f64;

/// Tolerance of torques beyond the limit, relative to that of friction forces.
const LIMIT_SLACK: f64 = 1e-2;

impl<R: Real> Constraints<R> {
    /// Adds the rows of the drives at their kink.
    pub(super) fn add_kinks(&mut self) {
        for k in 0..self.kinks.len() {
            let Kink { dof, saturation, load, .. } = self.kinks[k];
            let limit = self.kinks[k].limit_under(load);
            let row = self.rows.len();
            let none = (WORLD, R::zero());
            self.add(Row::of_joints([none, none]), R::zero());
            self.add(Row::of_joints([(dof as u32, R::one()), none]), R::zero());
            self.lambda.extend([R::splat(NORMAL), R::splat(saturation * limit)]);
            let group = FrictionGroup {
                slack: LIMIT_SLACK,
                mode: if saturation == 0.0 { ContactMode::Stick } else { ContactMode::Slip },
                direction: [R::splat(saturation), R::zero()],
                ..FrictionGroup::sticking(row + 1, 1, limit / NORMAL)
            };
            self.blocks.push(UnilateralConstraint {
                given: Some(R::splat(NORMAL)),
                ..UnilateralConstraint::contact(NO_SLOT, row, [Some(group), None, None])
            });
        }
    }

    /// Vector b of the drives at velocity level, less the rates of their targets over a step of length `h`.
    pub(super) fn aim_at_targets(&mut self, h: f64) {
        for (group, kink) in drive_groups(&self.blocks).zip(&self.kinks) {
            self.b[group.row] -= R::splat(kink.target / h);
        }
    }

    /// Takes the torques of the drives from the last solution as reactions, and the accelerations of locked ones as
    /// zero.
    pub(super) fn take_drive_torques(&mut self, at_rest: bool, scratch: &mut Scratch<R>, v_dot: &mut [R]) {
        if self.kinks.is_empty() {
            return;
        }
        for kink in &self.kinks {
            scratch.reaction[kink.dof] = R::zero();
        }
        let (rates, largest) = (self.solver.rates(), self.b.iter().fold(0.0_f64, |s, x| s.max(x.lane(0).abs())));
        for (group, kink) in drive_groups(&self.blocks).zip(&self.kinks) {
            scratch.reaction[kink.dof] += self.lambda[group.row];
            if at_rest && group.mode == ContactMode::Stick && rates[group.row].lane(0).abs() <= HELD_RATE * largest {
                v_dot[kink.dof] = R::zero();
            }
        }
    }

    /// Modes of the drives in the last solution, in the order in which they were given.
    pub fn read_kinks(&self, kinks: &mut [Kink]) {
        for (group, kink) in drive_groups(&self.blocks).zip(kinks) {
            kink.saturation = match group.mode {
                ContactMode::Stick => 0.0,
                ContactMode::Slip => group.direction[0].lane(0).signum(),
            };
        }
    }

    /// Returns true if drive `n` of those last posed needs all of its limit, or more.
    pub fn posed_kink_slips(&self, n: usize) -> bool {
        drive_groups(&self.blocks).nth(n).is_some_and(|group| group.mode == ContactMode::Slip)
    }
}

/// Friction groups of the drives among constraints, in the order in which the drives were given.
pub(super) fn drive_groups<R: Real>(blocks: &[UnilateralConstraint<R>]) -> impl Iterator<Item = &FrictionGroup<R>> {
    blocks.iter().filter(|block| block.is_drive()).filter_map(|block| block.groups[0].as_ref())
}

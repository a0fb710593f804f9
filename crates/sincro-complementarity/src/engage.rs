//! Solution of a problem with redundant contacts in which all of them take part.
//!
//! Rigid bodies on more contacts than they need have many solutions: some contacts may as well be open. Which of them
//! the active set finds follows from its warm start. Taken is the one in which every contact that does not separate is
//! closed, and all friction without slip sticks, if there is one; the load is then shared as by equally stiff
//! constraints ([`super::load_share`]), whatever came before.

use sincro_math::Real;

use super::active_set::ContactProblem;
use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::held::Load;
use super::solver::{Solver, Tolerances, norm, pair};

/// Number of turns of impending slip after which those that converge do so steadily.
const SETTLING_TURNS: usize = 2;

/// Maximum number of friction groups whose modes are all tried.
const MAX_ENUMERATED: usize = 6;

impl<R: Real> Solver<R> {
    /// Takes the solution in which open contacts that do not separate are closed, and friction without slip sticks,
    /// where there is one.
    pub(crate) fn engage(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) {
        let small = Tolerances::of(problem, blocks, (lambda, &self.active_set.rates));
        if !blocks.iter().any(|block| is_idle(block, small, &self.active_set.rates)) {
            return;
        }
        self.found.keep(blocks, lambda, &self.active_set.rates);
        self.close_idle(small, blocks);
        if self.iterate_active_set(problem, blocks, lambda) || self.enumerate_friction(problem, small, blocks, lambda) {
            return;
        }
        blocks.copy_from_slice(&self.found.blocks);
        lambda.copy_from_slice(&self.found.lambda);
        self.active_set.find_rates(problem, lambda);
    }

    /// Closes what is open without separating in the solution found first, and lets friction without slip stick.
    fn close_idle(&self, small: Tolerances, blocks: &mut [UnilateralConstraint<R>]) {
        blocks.iter_mut().for_each(|block| engage(block, small, &self.found.rates));
    }

    /// Tries all modes of friction without sliding, where the iteration goes round in circles: it changes all violated
    /// modes at once, before the directions of impending slip have converged. Returns true if one of them keeps all
    /// laws.
    fn enumerate_friction(
        &mut self,
        problem: &ContactProblem<'_, R>,
        small: Tolerances,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        blocks.copy_from_slice(&self.found.blocks);
        self.close_idle(small, blocks);
        let n = undecided(blocks).count();
        if n > MAX_ENUMERATED {
            return false;
        }
        undecided(blocks).for_each(FrictionGroup::stick);
        // forces that would let all stick tell the directions of impending slip
        lambda.copy_from_slice(&self.found.lambda);
        self.hold_modes(problem, blocks, lambda, (Load::Shared, SETTLING_TURNS));
        self.sticking.keep(blocks, lambda, &self.active_set.rates);
        (0..1_u32 << n).any(|slipping| {
            blocks.copy_from_slice(&self.sticking.blocks);
            lambda.copy_from_slice(&self.sticking.lambda);
            for (_, group) in undecided(blocks).enumerate().filter(|(k, _)| slipping >> k & 1 == 1) {
                let force = pair(group, &self.sticking.lambda);
                let size = norm(force);
                if size > 0.0 {
                    group.slip(force.map(|x| R::splat(x / size)), None);
                }
            }
            self.hold_modes(problem, blocks, lambda, (Load::Shared, SETTLING_TURNS))
                && self.worst_law(problem, blocks, lambda).is_none()
        })
    }
}

/// Friction groups of closed constraints whose mode the solution decides.
fn undecided<R: Real>(blocks: &mut [UnilateralConstraint<R>]) -> impl Iterator<Item = &mut FrictionGroup<R>> {
    let closed = blocks.iter_mut().filter(|block| !block.open);
    closed.flat_map(|block| block.groups.iter_mut().flatten()).filter(|group| !group.is_sliding)
}

/// Returns true if a constraint is open without separating, or friction that could stick slips without a rate.
fn is_idle<R: Real>(block: &UnilateralConstraint<R>, small: Tolerances, rates: &[R]) -> bool {
    if block.open {
        return rates[block.row].lane(0).abs() <= small.held;
    }
    block.groups.iter().flatten().any(|group| is_idle_friction(group, small, rates))
}

fn is_idle_friction<R: Real>(group: &FrictionGroup<R>, small: Tolerances, rates: &[R]) -> bool {
    !group.is_sliding && group.mode == ContactMode::Slip && norm(pair(group, rates)) <= small.stick
}

/// Closes a constraint that is open without separating, and lets friction that slips without a rate stick.
fn engage<R: Real>(block: &mut UnilateralConstraint<R>, small: Tolerances, rates: &[R]) {
    if block.open && is_idle(block, small, rates) {
        block.open = false;
    }
    for group in block.groups.iter_mut().flatten() {
        if is_idle_friction(group, small, rates) {
            group.stick();
        }
    }
}

//! Search for a second solution of a problem that has one.
//!
//! Coulomb friction of redundant contacts, and sliding friction in general, can leave several sets of forces that keep
//! all laws and give different accelerations. Which of them a solver returns is then a matter of rounding. The search
//! starts the active-set iteration from modes that differ from those of the solution in one place or two, and from all
//! closed and all open. It finds none where there is one only, and may miss one where there are several. Source: key
//! `acary2008` (existence and uniqueness with Coulomb friction).

use sincro_math::Real;

use super::active_set::ContactProblem;
use super::cone::{ContactMode, UnilateralConstraint};
use super::held::{Solution, differ};
use super::solver::{RANK, Solver, norm, pair};

/// Least difference of rates of another motion, relative to the largest rate.
const OTHER_MOTION: f64 = 1e-6;

/// Number of starts at which all constraints have the same mode.
const UNIFORM: usize = 2;

/// Maximum number of starts that are tried in pairs too.
const MAX_PAIRED: usize = UNIFORM + 4 * 8;

/// Maximum number of rows of a problem that is searched.
const MAX_ROWS: usize = 48;

impl<R: Real> Solver<R> {
    /// Returns true if other modes than those of the solution `blocks`, `lambda` keep all laws as well and give other
    /// rates, and `takes` them then; else the solution stays as it is. One that is approximate has no other.
    pub fn has_other_solution(
        &mut self,
        problem: &ContactProblem<'_, R>,
        takes: bool,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        if blocks.is_empty() || problem.m() > MAX_ROWS || self.is_approximate {
            return false;
        }
        let report = self.report;
        self.rank = RANK;
        self.active_set.find_rates(problem, lambda);
        if self.worst_law(problem, blocks, lambda).is_some() {
            return false;
        }
        let mut first = core::mem::take(&mut self.other);
        first.keep(blocks, lambda, &self.active_set.rates);
        let n = n_starts(blocks);
        let paired = if n <= MAX_PAIRED { n } else { 0 };
        let found = (0..n).any(|one| {
            // another start alone, then together with each of the earlier ones
            self.leads_elsewhere(problem, &first, (one, None), blocks, lambda)
                || (UNIFORM..one.min(paired)).any(|two| {
                    one >= UNIFORM && self.leads_elsewhere(problem, &first, (one, Some(two)), blocks, lambda)
                })
        });
        if !(found && takes) {
            blocks.copy_from_slice(&first.blocks);
            lambda.copy_from_slice(&first.lambda);
            self.active_set.find_rates(problem, lambda);
        }
        self.other = first;
        self.report = report;
        found
    }

    /// Returns true if the active-set iteration from one or two changes of the modes of the `first` solution finds
    /// another one.
    fn leads_elsewhere(
        &mut self,
        problem: &ContactProblem<'_, R>,
        first: &Solution<R>,
        (one, two): (usize, Option<usize>),
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        blocks.copy_from_slice(&first.blocks);
        lambda.copy_from_slice(&first.lambda);
        set_start(one, blocks, lambda)
            && two.is_none_or(|two| set_start(two, blocks, lambda))
            && self.iterate_away_from(Some(&first.blocks), problem, blocks, lambda)
            && self.keeps_laws_elsewhere(problem, first, blocks, lambda)
    }

    /// Returns true if the solution just found keeps all laws with other rates than the `first`, all redundant contacts
    /// taking part in both: that one of them might as well carry nothing is no other motion.
    fn keeps_laws_elsewhere(
        &mut self,
        problem: &ContactProblem<'_, R>,
        first: &Solution<R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        if !differ(problem, &self.active_set.rates, &first.rates, OTHER_MOTION) {
            return false;
        }
        self.engage(problem, blocks, lambda);
        self.worst_law(problem, blocks, lambda).is_none()
            && differ(problem, &self.active_set.rates, &first.rates, OTHER_MOTION)
    }
}

/// Number of starts of the search: all closed, all open, and each mode that can differ.
fn n_starts<R: Real>(blocks: &[UnilateralConstraint<R>]) -> usize {
    UNIFORM + 4 * blocks.len()
}

/// Sets the modes of a start; returns false if they are those of the solution.
fn set_start<R: Real>(start: usize, blocks: &mut [UnilateralConstraint<R>], lambda: &[R]) -> bool {
    match start {
        0 => blocks.iter_mut().fold(false, |differs, block| close(block) | differs),
        1 => blocks.iter_mut().fold(false, |differs, block| open(block) | differs),
        _ => {
            let (block, part) = (&mut blocks[(start - UNIFORM) / 4], (start - UNIFORM) % 4);
            match part.checked_sub(1) {
                None => {
                    let can_change = block.given.is_none();
                    block.open ^= can_change;
                    can_change
                }
                Some(group) => !block.open && flip_friction(block, group, lambda),
            }
        }
    }
}

/// Closes a constraint and lets its friction stick; returns true if it was not so.
fn close<R: Real>(block: &mut UnilateralConstraint<R>) -> bool {
    let mut differs = core::mem::take(&mut block.open);
    for group in block.groups.iter_mut().flatten().filter(|group| !group.is_sliding) {
        differs |= group.mode == ContactMode::Slip;
        group.stick();
    }
    differs
}

/// Opens a constraint; returns true if it was closed.
fn open<R: Real>(block: &mut UnilateralConstraint<R>) -> bool {
    block.given.is_none() && !core::mem::replace(&mut block.open, true)
}

/// Lets sticking friction slip along its force, slipping friction stick; returns true if it could.
fn flip_friction<R: Real>(block: &mut UnilateralConstraint<R>, group: usize, lambda: &[R]) -> bool {
    let Some(group) = block.groups[group].as_mut().filter(|group| !group.is_sliding) else { return false };
    let force = pair(group, lambda);
    let size = norm(force);
    match group.mode {
        ContactMode::Slip => group.stick(),
        ContactMode::Stick if size > 0.0 => group.slip(force.map(|x| R::splat(x / size)), None),
        ContactMode::Stick => return false,
    }
    true
}

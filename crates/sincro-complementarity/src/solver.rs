//! Solution of the frictional contact problem w = G λ + b: active set first, then ADMM.
//!
//! The active set (contact modes) starts from the warm start; the multipliers follow from one linear system
//! (`active_set`), solved with its rank revealed (`dense`), as a correction of the last ones; redundant
//! constraints share the load evenly (`load_share`). If the multipliers satisfy the complementarity
//! conditions, the problem is solved. If not, the violated modes are changed, a few times; for slip directions this is
//! Newton's method. If that does not converge, ADMM (`admm`) finds the solution without an active set, and the
//! linear system of the modes it implies makes it exact; the last resorts are Gauss–Seidel sweeps, all sets of closed
//! contacts, and sweeps with the forces of each contact found together.

use sincro_math::Real;

use super::active_set::{ActiveSet, ContactProblem};
use super::admm::{Admm, activate_all};
use super::cone::{ContactMode, FrictionGroup, SlowSliding, UnilateralConstraint};
use super::dense::Dense;
pub(crate) use super::dense::RANK;
use super::gauss_seidel::{self, LocalProblem};
use super::held::Solution;
use super::load_share::LoadShare;

/// Complementarity tolerance, relative to the largest force or rate.
pub(crate) const SLACK: f64 = 1e-9;

/// Tolerance of rates that must be zero, relative to the largest rate: redundant contacts whose distances differ by
/// rounding contradict each other by as much; an inconsistent active set leaves far more.
pub const HELD_RATE: f64 = 1e-6;

/// Multiple of the rates that the forces of constraints with friction cause which tolerances of friction are relative
/// to at most: beside a strong motor that presses a joint against its limit, all of them are small.
const OWN_RATES: f64 = 10.0;

/// Relative rate above which a solution of the linear system is refined once.
const REFINED: f64 = 1e-12;

/// Maximum number of mode updates before ADMM is used.
const MAX_MODE_UPDATES: usize = 8;

/// Error of slow friction up to which a solution stands whose directions have not converged within their turns.
const NEARLY_TURNED: f64 = 1e-8;

/// Maximum number of contacts whose sets of closed ones are enumerated.
const MAX_ENUMERATED: usize = 5;

/// Numbers of Gauss–Seidel sweeps after which their active set is tried.
const SWEEPS: [usize; 5] = [20, 40, 80, 160, 320];

/// Maximum number of turns of slow sliding friction.
pub(crate) const MAX_TURNS: usize = 20;

/// Iterations of ADMM before its active set is tried the first time; doubled after each trial.
const FIRST_ITERATIONS: usize = 25;

/// Statistics of the solver of constraints since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolverReport {
    /// Number of complementarity problems solved.
    pub solved: u64,
    /// Number of those that ADMM solved, because the active-set method did not converge.
    pub split: u64,
    /// Number of problems in accepted steps with a complementarity residual above 1e-9.
    pub not_converged: u64,
    /// Largest complementarity residual of those, relative to the largest force or rate (dimensionless).
    pub worst_residual: f64,
    /// Number of contact islands solved by sweeps at the velocity level.
    pub islands: u64,
    /// Number of sweeps over all contacts of an island, summed over the islands.
    pub sweeps: u64,
    /// Number of islands with a residual above 1e-6 at the iteration limit.
    pub unconverged_islands: u64,
    /// Largest residual of an island: natural map of the Coulomb law over its largest force (dimensionless).
    pub worst_island: f64,
}

impl SolverReport {
    /// Takes back the failures since `before`, of steps that were not accepted.
    pub fn discard(&mut self, before: &Self) {
        self.not_converged = before.not_converged;
        self.worst_residual = before.worst_residual;
        (self.islands, self.sweeps) = (before.islands, before.sweeps);
        (self.unconverged_islands, self.worst_island) = (before.unconverged_islands, before.worst_island);
    }
}

/// Solver of small problems, with its working memory, which grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub struct Solver<R> {
    dense: Dense<R>,
    pub(crate) active_set: ActiveSet<R>,
    admm: Admm,
    delta: Vec<R>,
    all_active: Vec<UnilateralConstraint<R>>,
    start: Vec<R>,
    /// Multipliers and rates of Gauss–Seidel sweeps.
    swept: Vec<R>,
    swept_rates: Vec<R>,
    locals: Vec<LocalProblem>,
    share: LoadShare<R>,
    /// Solution found first, and the one in which all friction sticks (`engage`).
    pub(crate) found: Solution<R>,
    pub(crate) sticking: Solution<R>,
    /// First solution while a second one is sought (`uniqueness`).
    pub(crate) other: Solution<R>,
    /// Statistics since it was made.
    pub report: SolverReport,
    /// Report at the start of the trial step that is being made, none outside of one.
    trial: Option<SolverReport>,
    /// True if the last problem was left as ADMM solved it, with friction that is a little within its limit.
    pub is_approximate: bool,
    /// Rank tolerance of corrections.
    pub rank: f64,
    /// Smallest scaled pivot of the last linear system.
    pub smallest_pivot: f64,
}

impl<R: Real> Solver<R> {
    /// Memory for problems of `m` rows.
    pub fn reserve(&mut self, m: usize) {
        self.dense.reserve(m);
        self.active_set.reserve(m);
        let more = |len: usize| m.saturating_sub(len);
        for list in [&mut self.delta, &mut self.start, &mut self.swept, &mut self.swept_rates] {
            list.reserve(more(list.len()));
        }
        self.all_active.reserve(more(self.all_active.len()));
        self.locals.reserve(more(self.locals.len()));
        self.found.reserve(m);
        self.sticking.reserve(m);
        self.other.reserve(m);
    }

    /// Begins a trial step: one that was begun before and not accepted does not count.
    pub fn begin_trial(&mut self) {
        if let Some(before) = self.trial {
            self.report.discard(&before);
        }
        self.trial = Some(self.report);
    }

    /// Accepts the trial step.
    pub fn accept_trial(&mut self) {
        self.trial = None;
    }

    /// Finds λ and the contact modes by the active set alone, from those of the warm start; returns true on
    /// convergence.
    pub fn solve_nearby(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        self.report.solved += 1;
        self.rank = RANK;
        let is_solved = self.iterate_active_set(problem, blocks, lambda);
        if is_solved {
            self.engage(problem, blocks, lambda);
        }
        is_solved
    }

    /// Finds λ, which holds the warm start (or zeros) before, and the contact modes.
    pub fn solve(&mut self, problem: &ContactProblem<'_, R>, blocks: &mut [UnilateralConstraint<R>], lambda: &mut [R]) {
        self.is_approximate = false;
        if self.solve_nearby(problem, blocks, lambda) {
            return;
        }
        self.report.split += 1;
        // from zero: the warm start did not fit
        lambda.fill(R::zero());
        activate_all(blocks);
        let mut all_active = core::mem::take(&mut self.all_active);
        all_active.clear();
        all_active.extend_from_slice(blocks);
        self.admm.begin(problem, &mut self.active_set, &mut self.dense, blocks, lambda);
        let mut iterations = FIRST_ITERATIONS;
        loop {
            let done = self.admm.run(iterations);
            blocks.copy_from_slice(&all_active);
            self.active_set.take(problem.n_free, blocks, lambda);
            self.admm.finish(&self.active_set, blocks, lambda);
            self.start.clear();
            self.start.extend_from_slice(lambda);
            if self.iterate_active_set(problem, blocks, lambda) {
                break;
            }
            if done {
                if self.sweep(problem, (&all_active, false), blocks, lambda)
                    || self.sweep(problem, (&all_active, true), blocks, lambda)
                    || self.enumerate(problem, (&all_active, false), blocks, lambda)
                    || self.enumerate(problem, (&all_active, true), blocks, lambda)
                    || self.sweep_contacts(problem, &all_active, blocks, lambda)
                {
                    break;
                }
                // feasible, only not exact
                self.is_approximate = true;
                lambda.copy_from_slice(&self.start);
                blocks.copy_from_slice(&all_active);
                self.active_set.take(problem.n_free, blocks, lambda);
                self.admm.finish(&self.active_set, blocks, lambda);
                self.record_residual(problem, blocks, lambda);
                self.all_active = all_active;
                return;
            }
            iterations *= 2;
        }
        self.all_active = all_active;
        self.engage(problem, blocks, lambda);
    }

    /// Active-set iteration from what Gauss–Seidel sweeps find; returns true on convergence. `explicit` as in
    /// [`Solver::enumerate`].
    fn sweep(
        &mut self,
        problem: &ContactProblem<'_, R>,
        (all_active, explicit): (&[UnilateralConstraint<R>], bool),
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        restart(all_active, explicit, blocks);
        self.begin_sweeps(problem);
        SWEEPS.into_iter().any(|sweeps| {
            gauss_seidel::sweep(problem, sweeps, blocks, (&mut self.swept, &mut self.swept_rates));
            lambda.copy_from_slice(&self.swept);
            self.iterate_active_set(problem, blocks, lambda)
        })
    }

    /// Begins sweeps from no forces.
    fn begin_sweeps(&mut self, problem: &ContactProblem<'_, R>) {
        self.swept.clear();
        self.swept.resize(problem.m(), R::zero());
        self.swept_rates.clear();
        self.swept_rates.extend_from_slice(problem.b);
    }

    /// Sweeps with the forces of each contact found together; returns true where these keep all laws, or the active set
    /// from them does.
    fn sweep_contacts(
        &mut self,
        problem: &ContactProblem<'_, R>,
        all_active: &[UnilateralConstraint<R>],
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        restart(all_active, false, blocks);
        self.begin_sweeps(problem);
        self.locals.clear();
        self.locals.extend(blocks.iter().map(|block| gauss_seidel::local_problem(problem, block)));
        // the residual does not tell whether slow sliding has turned
        let slides_slowly =
            blocks.iter().flat_map(|block| block.groups.iter().flatten()).any(|g| g.slow_sliding.h > 0.0);
        SWEEPS.into_iter().any(|sweeps| {
            let (forces, locals) = ((&mut self.swept[..], &mut self.swept_rates[..]), &mut self.locals[..]);
            gauss_seidel::sweep_contacts(problem, sweeps, (blocks, locals), forces);
            lambda.copy_from_slice(&self.swept);
            let is_finite = lambda.iter().all(|force| force.lane(0).is_finite());
            let is_solved = is_finite && !slides_slowly && self.residual(problem, blocks, lambda) <= SLACK;
            is_solved || (is_finite && self.iterate_active_set(problem, blocks, lambda))
        })
    }

    /// Active-set iteration from every set of closed contacts, of small problems; returns true on convergence. Sliding
    /// friction couples forces one way, so that neither the iteration nor ADMM need find the solution there is. With
    /// `explicit` friction that slides slowly is that of its velocity now.
    fn enumerate(
        &mut self,
        problem: &ContactProblem<'_, R>,
        (all_active, explicit): (&[UnilateralConstraint<R>], bool),
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        let free = blocks.iter().filter(|block| block.given.is_none()).count();
        if free > MAX_ENUMERATED {
            return false;
        }
        // most contacts closed first
        (0..1_u32 << free).rev().any(|closed| {
            restart(all_active, explicit, blocks);
            for (k, block) in blocks.iter_mut().filter(|block| block.given.is_none()).enumerate() {
                block.open = closed >> k & 1 == 0;
            }
            lambda.fill(R::zero());
            self.iterate_active_set(problem, blocks, lambda)
        })
    }

    /// Active-set iteration: corrects the multipliers and updates violated modes; returns true on convergence.
    pub(crate) fn iterate_active_set(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        self.iterate_away_from(None, problem, blocks, lambda)
    }

    /// As [`Solver::iterate_active_set`], but returns false where the modes become those of a `known` solution.
    pub(crate) fn iterate_away_from(
        &mut self,
        known: Option<&[UnilateralConstraint<R>]>,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        let (mut updates, mut turns) = (0, 0);
        while updates < MAX_MODE_UPDATES {
            self.correct(problem, blocks, lambda);
            if blocks.is_empty() {
                return true;
            }
            self.active_set.find_rates(problem, lambda);
            let rates = &self.active_set.rates;
            if update_modes(problem, rates, blocks, lambda) {
                updates += 1;
                if known.is_some_and(|known| blocks.iter().zip(known).all(|(block, known)| block.has_modes_of(known))) {
                    return false;
                }
            } else if turns < MAX_TURNS && turn_slow_sliding(rates, blocks, lambda) {
                turns += 1;
            } else {
                if turns == MAX_TURNS && turning_error(rates, blocks, lambda) > NEARLY_TURNED {
                    return false;
                }
                self.refine(problem, blocks, lambda);
                // sweeps may have gone beyond all bounds, and what is not a number violates no law
                return lambda.iter().all(|force| force.lane(0).is_finite());
            }
        }
        false
    }

    /// Repeats the correction where elimination left more than rounding.
    pub(crate) fn refine(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) {
        let rates = &self.active_set.rates;
        let small = Tolerances::of(problem, blocks, (lambda, rates)).none;
        let holds = |block: &&UnilateralConstraint<R>| !block.open && block.given.is_none();
        let normals = blocks.iter().filter(holds).map(|block| rates[block.row]);
        if rates[..problem.n_free].iter().copied().chain(normals).any(|rate| rate.lane(0).abs() > small) {
            self.correct(problem, blocks, lambda);
            self.active_set.find_rates(problem, lambda);
        }
    }

    /// Solves the linear system of the current active set; redundant constraints share the load.
    pub fn correct(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>], lambda: &mut [R]) {
        self.correct_rates(problem, blocks, lambda);
        self.share_load(problem, blocks, lambda);
    }

    /// Solves the linear system of the current active set; how redundant constraints share the load, which changes no
    /// rate, follows from λ before.
    pub(crate) fn correct_rates(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) {
        self.active_set.take(problem.n_free, blocks, lambda);
        self.active_set.find_rates(problem, lambda);
        self.active_set.system(problem, blocks, lambda, &mut self.dense);
        self.delta.clear();
        self.delta.resize(self.active_set.len(), R::zero());
        self.dense.solve(self.rank, &mut self.delta);
        self.smallest_pivot = self.dense.smallest_pivot;
        self.active_set.change(blocks, &self.delta, lambda);
    }

    /// Lets redundant constraints share the load of the linear system last solved; returns true if there are any.
    pub(crate) fn share_load(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        let is_redundant = self.dense.rank < self.dense.n;
        if is_redundant {
            self.share.apply(problem, (&self.dense, &self.active_set), blocks, lambda);
        }
        is_redundant
    }

    /// Counts a problem left at a residual beyond the tolerance.
    fn record_residual(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>], lambda: &[R]) {
        let residual = self.residual(problem, blocks, lambda);
        if residual > SLACK {
            self.report.not_converged += 1;
            self.report.worst_residual = self.report.worst_residual.max(residual);
        }
    }

    /// Complementarity residual relative to the largest rate (dimensionless), of forces within their bounds.
    fn residual(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>], lambda: &[R]) -> f64 {
        self.active_set.find_rates(problem, lambda);
        let largest = problem.b.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        let rate = |i: usize| self.active_set.rates[i].lane(0);
        let mut worst = (0..problem.n_free).map(|i| rate(i).abs()).fold(0.0, f64::max);
        for block in blocks {
            if block.given.is_none() {
                let r = rate(block.row);
                worst = worst.max(if block.open { (-r).max(0.0) } else { r.abs() });
            }
            for group in block.groups.iter().flatten().filter(|g| !g.is_sliding && !block.open) {
                let w = pair(group, &self.active_set.rates);
                let d = group.direction.map(|d| d.lane(0));
                // a sticking group has no rate, a slipping one none but against its force
                worst = worst.max(match group.mode {
                    ContactMode::Stick => norm(w),
                    ContactMode::Slip => (w[0] * d[1] - w[1] * d[0]).abs().max(w[0] * d[0] + w[1] * d[1]),
                });
            }
        }
        worst / largest
    }
}

/// Absolute tolerances of one problem.
#[derive(Clone, Copy)]
pub(crate) struct Tolerances {
    pub force: f64,
    pub rate: f64,
    /// Rate that must be zero, but of friction.
    pub held: f64,
    /// Rate of friction that must be zero.
    pub stick: f64,
    /// Rate of a slip up to which it has no direction.
    pub slip: f64,
    none: f64,
}

impl Tolerances {
    /// The force scale includes the force that would stop the largest rate of the lightest row: where everything opens,
    /// nothing else gives forces a scale.
    pub fn of<R: Real>(
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        (lambda, rates): (&[R], &[R]),
    ) -> Self {
        let largest = |x: &[R]| x.iter().fold(0.0_f64, |s, x| s.max(x.lane(0).abs()));
        let m = problem.m();
        let lightest = (0..m).fold(0.0_f64, |s, i| s.max(problem.a[i * m + i].lane(0)));
        let undoing = if lightest > 0.0 { largest(problem.b) / lightest } else { 0.0 };
        let [force, rate] = [largest(lambda).max(undoing), largest(problem.b)].map(|x| x + f64::MIN_POSITIVE);
        let own = OWN_RATES * own_rates(problem, blocks, lambda, rates);
        let (small, held, none) = (SLACK * rate, HELD_RATE * rate, REFINED * rate);
        let (stick, slip) = ((HELD_RATE * own).clamp(small, held), (SLACK * own).clamp(none, small));
        Self { force: SLACK * force, rate: small, held, stick, slip, none }
    }
}

/// Largest rate that a force of a closed constraint with friction causes along itself, or that is left there.
fn own_rates<R: Real>(
    problem: &ContactProblem<'_, R>,
    blocks: &[UnilateralConstraint<R>],
    lambda: &[R],
    rates: &[R],
) -> f64 {
    let m = problem.m();
    let rate = |i: usize| rates[i].lane(0).abs() + (problem.a[i * m + i] * lambda[i]).lane(0).abs();
    let closed = blocks.iter().filter(|block| !block.open);
    closed.fold(0.0, |largest, block| {
        let rows = block.groups.iter().flatten().flat_map(|group| group.row..group.row + group.dim);
        let of_friction = rows.map(rate).fold(0.0, f64::max);
        let has_normal = block.given.is_none() && block.groups.iter().any(Option::is_some);
        largest.max(of_friction).max(if has_normal { rate(block.row) } else { 0.0 })
    })
}

/// Updates the contact modes that violate the complementarity conditions; returns true if any did.
fn update_modes<R: Real>(
    problem: &ContactProblem<'_, R>,
    rates: &[R],
    blocks: &mut [UnilateralConstraint<R>],
    lambda: &[R],
) -> bool {
    let small = Tolerances::of(problem, blocks, (lambda, rates));
    let mut changed = false;
    for block in blocks.iter_mut() {
        if block.open {
            if rates[block.row].lane(0) < -small.rate {
                block.open = false;
                changed = true;
            }
            continue;
        }
        let (normal, rate) = (lambda[block.row].lane(0), rates[block.row].lane(0));
        // an inconsistent active set leaves rates that should be zero
        if block.given.is_none() && (normal < -small.force || rate > small.held) {
            block.open = true;
            changed = true;
            continue;
        }
        changed |= block.given.is_none() && rate < -small.held;
        for group in block.groups.iter_mut().flatten().filter(|g| !g.is_sliding) {
            changed |= update_friction_mode(group, normal.max(0.0), small, rates, lambda);
        }
    }
    changed
}

/// Sets all constraints active again; with `explicit` friction that slides slowly is that of its velocity now.
fn restart<R: Real>(all_active: &[UnilateralConstraint<R>], explicit: bool, blocks: &mut [UnilateralConstraint<R>]) {
    blocks.copy_from_slice(all_active);
    if explicit {
        blocks.iter_mut().for_each(fix_slow_sliding);
    }
}

/// Fixes the friction of the groups of a constraint that slide slowly to their velocity now.
fn fix_slow_sliding<R: Real>(block: &mut UnilateralConstraint<R>) {
    for group in block.groups.iter_mut().flatten().filter(|g| g.slow_sliding.h > 0.0) {
        group.slow_sliding = SlowSliding::default();
        group.slip([-R::one(), R::zero()], None);
    }
}

/// Turns the friction of all groups that slide slowly; returns true if any was not turned yet.
fn turn_slow_sliding<R: Real>(rates: &[R], blocks: &mut [UnilateralConstraint<R>], lambda: &[R]) -> bool {
    let mut turned = false;
    for block in blocks.iter_mut().filter(|block| !block.open) {
        let normal = lambda[block.row].lane(0);
        for group in block.groups.iter_mut().flatten() {
            turned |= turn_slow_friction(group, normal, rates, lambda);
        }
    }
    turned
}

/// Largest error of the friction of groups that slide slowly: relative force beyond its limit, or a hundredth of the
/// angle to its velocity at the end of the step.
fn turning_error<R: Real>(rates: &[R], blocks: &[UnilateralConstraint<R>], lambda: &[R]) -> f64 {
    let closed = blocks.iter().filter(|block| !block.open);
    let groups = closed.flat_map(|block| block.groups.iter().flatten().map(|group| (block.row, group)));
    groups.fold(0.0, |largest, (row, group)| {
        let normal = lambda[row].lane(0);
        let Some(sliding) = group.sliding_rate(normal) else { return largest };
        let ([d0, d1], rate) = (group.direction.map(|d| d.lane(0)), pair(group, rates));
        let beyond = norm(pair(group, lambda)) / (group.coefficient * normal) - 1.0;
        let across = d0 * rate[1] - d1 * sliding;
        largest.max(beyond).max(0.01 * across.abs() / norm([sliding, rate[1]]))
    })
}

/// Turns the friction of a group that slides slowly against its velocity at the end of the step; returns true if it was
/// not turned so yet.
pub(crate) fn turn_slow_friction<R: Real>(
    group: &mut FrictionGroup<R>,
    normal: f64,
    rates: &[R],
    lambda: &[R],
) -> bool {
    let Some(sliding) = group.sliding_rate(normal) else {
        let was_turned = group.is_sliding && group.compliance.is_some();
        if was_turned {
            group.slip([-R::one(), R::zero()], None);
        }
        return was_turned;
    };
    let (limit, force, rate) = (group.coefficient * normal, pair(group, lambda), pair(group, rates));
    let size = norm(force);
    let d = if size > 0.0 { force.map(|x| x / size) } else { group.direction.map(|x| x.lane(0)) };
    let velocity = [sliding, rate[1]];
    let across = d[0] * velocity[1] - d[1] * velocity[0];
    let is_turned = size <= limit * (1.0 + SLACK) && across.abs() <= SLACK * norm(velocity);
    group.slip(d.map(R::splat), Some(R::splat(norm(velocity) / limit)));
    !is_turned
}

fn update_friction_mode<R: Real>(
    group: &mut FrictionGroup<R>,
    normal: f64,
    small: Tolerances,
    rates: &[R],
    lambda: &[R],
) -> bool {
    if group.mode == ContactMode::Stick {
        let force = pair(group, lambda);
        let size = norm(force);
        if size > group.coefficient * normal + small.force * group.slack {
            group.slip(force.map(|x| R::splat(x / size)), None);
            return true;
        }
        return norm(pair(group, rates)) > small.stick;
    }
    turn_impending_slip(group, normal, small, rates, lambda).unwrap_or_else(|| {
        group.stick();
        true
    })
}

/// Turns friction at its limit against the impending slip; returns true if it was not turned so yet, none if the slip
/// goes along the force: it sticks then.
pub(crate) fn turn_impending_slip<R: Real>(
    group: &mut FrictionGroup<R>,
    normal: f64,
    small: Tolerances,
    rates: &[R],
    lambda: &[R],
) -> Option<bool> {
    let limit = group.coefficient * normal;
    let (force, rate) = (pair(group, lambda), pair(group, rates));
    let (size, speed) = (norm(force), norm(rate));
    let beyond = size > limit + small.force * group.slack;
    if speed <= small.slip {
        // at its limit without a rate; a direction that can turn must not have turned beyond the limit
        // and a compliant direction must not creep
        let creeps = group.compliance.is_some() && speed > small.none && size > 0.0;
        if beyond || creeps {
            group.slip(force.map(|x| R::splat(x / size)), None);
        }
        return Some(beyond || creeps);
    }
    let d = group.direction.map(|d| d.lane(0));
    if rate[0] * d[0] + rate[1] * d[1] > 0.0 {
        return None;
    }
    // turn the force against the impending slip
    let turned = norm([rate[0] + speed * d[0], rate[1] + speed * d[1]]);
    let compliance = Some(speed / limit).filter(|c| c.is_finite());
    // without a normal force nothing tells how contacts share the load: that is left to ADMM
    if compliance.is_some() && turned <= SLACK * speed && !beyond {
        return Some(false);
    }
    group.slip(rate.map(|x| R::splat(-x / speed)), compliance.map(R::splat));
    Some(true)
}

/// Components of a group in a list over rows.
pub(crate) fn pair<R: Real>(group: &FrictionGroup<R>, list: &[R]) -> [f64; 2] {
    std::array::from_fn(|k| if k < group.dim { list[group.row + k].lane(0) } else { 0.0 })
}

pub(crate) fn norm(x: [f64; 2]) -> f64 {
    (x[0] * x[0] + x[1] * x[1]).sqrt()
}

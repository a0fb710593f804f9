//! The constraint problem of one instant: w = A λ + b with free rows, normal rows and discs of friction.
//!
//! Who lets go, sticks or slips is guessed from the last solution; the forces then follow from one linear system ([`super::active_set`]), solved with its
//! rank revealed ([`Dense`]), as a correction to the last ones, so that redundant contacts keep the share they had. If the forces fit the guess,
//! that was all. If not, what does not fit is changed, a few times, which for directions of slipping is Newton's method. If that does not help,
//! the problem is solved without a guess ([`super::admm`]), and the linear system makes its result exact.

use sincro_math::Real;

use super::active_set::{ActiveSet, ContactProblem};
use super::admm::{Admm, activate_all};
use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::dense::{Dense, RANK};

/// Share of the largest force or rate that counts as zero in judging a guess.
const SLACK: f64 = 1e-9;

/// Share of the largest rate that may be left where there should be none: redundant contacts whose gaps differ by rounding contradict each other by
/// as much; a guess that contradicts itself leaves far more.
const HELD_RATE: f64 = 1e-6;

/// Share of the largest rate that elimination may leave without another look.
const REFINED: f64 = 1e-12;

/// Changes of a guess before splitting decides.
const MAX_MODE_UPDATES: usize = 8;

/// Iterations of splitting before its result is tried as a guess, the first time; then twice as many, and so on.
const FIRST_ITERATIONS: usize = 25;

/// What solving took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolverReport {
    /// Problems solved.
    pub solved: u64,
    /// Problems that no guess solved.
    pub split: u64,
    /// Problems whose forces do not fit their laws within a share of 1e-9.
    pub not_converged: u64,
    /// The largest misfit among those, as a share of the largest force or rate.
    pub worst_residual: f64,
}

/// Working memory; grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solver<R> {
    dense: Dense<R>,
    active_set: ActiveSet<R>,
    admm: Admm,
    delta: Vec<R>,
    all_active: Vec<UnilateralConstraint<R>>,
    start: Vec<R>,
    pub report: SolverReport,
    /// Scaled pivots below this are dropped in corrections.
    pub rank: f64,
    /// Rows without bounds that the last linear system found redundant.
    pub redundant: usize,
}

impl<R: Real> Solver<R> {
    /// Memory for problems of `m` rows.
    pub fn reserve(&mut self, m: usize) {
        self.dense.reserve(m);
        self.active_set.reserve(m);
        let more = |len: usize| m.saturating_sub(len);
        for list in [&mut self.delta, &mut self.start] {
            list.reserve(more(list.len()));
        }
        self.all_active.reserve(more(self.all_active.len()));
    }

    /// Finds λ, which holds the last solution (or zeros) before, and the state of the blocks.
    pub fn solve(&mut self, problem: &ContactProblem<'_, R>, blocks: &mut [UnilateralConstraint<R>], lambda: &mut [R]) {
        self.report.solved += 1;
        self.rank = RANK;
        self.search(problem, blocks, lambda);
        self.mark_effects(problem, blocks, lambda);
    }

    fn search(&mut self, problem: &ContactProblem<'_, R>, blocks: &mut [UnilateralConstraint<R>], lambda: &mut [R]) {
        if self.iterate_active_set(problem, blocks, lambda) {
            return;
        }
        self.report.split += 1;
        // from nothing, so that redundant contacts share alike: what they had did not fit
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
                // feasible, only not exact
                lambda.copy_from_slice(&self.start);
                blocks.copy_from_slice(&all_active);
                self.active_set.take(problem.n_free, blocks, lambda);
                self.admm.finish(&self.active_set, blocks, lambda);
                self.record_residual(problem, blocks, lambda);
                break;
            }
            iterations *= 2;
        }
        self.all_active = all_active;
    }

    /// Corrects, and changes what does not fit, until everything fits; says whether it does.
    fn iterate_active_set(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &mut [UnilateralConstraint<R>],
        lambda: &mut [R],
    ) -> bool {
        for _ in 0..MAX_MODE_UPDATES {
            self.correct(problem, blocks, lambda);
            if blocks.is_empty() {
                return true;
            }
            self.active_set.find_rates(problem, lambda);
            if !update_modes(problem, &self.active_set.rates, blocks, lambda) {
                self.refine(problem, blocks, lambda);
                return true;
            }
        }
        false
    }

    /// Once more, where elimination left more than rounding.
    fn refine(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>], lambda: &mut [R]) {
        let small = Tolerances::of(problem, lambda).none;
        let rates = &self.active_set.rates;
        let holds = |block: &&UnilateralConstraint<R>| !block.open && block.given.is_none();
        let normals = blocks.iter().filter(holds).map(|block| rates[block.row]);
        if rates[..problem.n_free].iter().copied().chain(normals).any(|rate| rate.lane(0).abs() > small) {
            self.correct(problem, blocks, lambda);
            self.active_set.find_rates(problem, lambda);
        }
    }

    /// The linear system of the guess.
    pub fn correct(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>], lambda: &mut [R]) {
        self.active_set.take(problem.n_free, blocks, lambda);
        self.active_set.find_rates(problem, lambda);
        self.active_set.system(problem, blocks, lambda, &mut self.dense);
        self.delta.clear();
        self.delta.resize(self.active_set.len(), R::zero());
        self.dense.solve(self.rank, &mut self.delta);
        self.redundant = self.dense.redundant().iter().filter(|k| **k < problem.n_free).count();
        self.active_set.change(blocks, &self.delta, lambda);
    }

    /// Notes what can be seen of every block.
    fn mark_effects(&mut self, problem: &ContactProblem<'_, R>, blocks: &mut [UnilateralConstraint<R>], lambda: &[R]) {
        let small = 10.0 * Tolerances::of(problem, lambda).rate;
        let rates = &self.active_set.rates;
        for block in blocks.iter_mut() {
            block.effect = 0;
            if block.open {
                block.effect = u8::from(rates[block.row].lane(0) > small);
                continue;
            }
            for (g, group) in block.groups.iter().enumerate() {
                let Some(group) = group.filter(|g| !g.slides && g.grip == ContactMode::Slip) else { continue };
                let rate = rates[group.row..group.row + group.dim].iter().map(|r| r.lane(0).abs()).fold(0.0, f64::max);
                block.effect |= u8::from(rate > small) << (g + 1);
            }
        }
    }

    /// How far forces and rates are from their laws, as a share of the largest.
    fn record_residual(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>], lambda: &[R]) {
        self.active_set.find_rates(problem, lambda);
        let largest = problem.b.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        let rate = |i: usize| self.active_set.rates[i].lane(0);
        let mut worst = (0..problem.n_free).map(|i| rate(i).abs()).fold(0.0, f64::max);
        for block in blocks {
            if block.given.is_none() {
                let r = rate(block.row);
                worst = worst.max(if block.open { (-r).max(0.0) } else { r.abs() });
            }
            for group in block.groups.iter().flatten().filter(|g| !g.slides && !block.open) {
                let w = pair(group, &self.active_set.rates);
                let d = group.direction.map(|d| d.lane(0));
                // what sticks has no rate, what slips none but against its force
                worst = worst.max(match group.grip {
                    ContactMode::Stick => norm(w),
                    ContactMode::Slip => (w[0] * d[1] - w[1] * d[0]).abs().max(w[0] * d[0] + w[1] * d[1]),
                });
            }
        }
        let residual = worst / largest;
        if residual > SLACK {
            self.report.not_converged += 1;
            self.report.worst_residual = self.report.worst_residual.max(residual);
        }
    }
}

/// What counts as zero beside the largest force and the largest rate.
#[derive(Clone, Copy)]
struct Tolerances {
    force: f64,
    rate: f64,
    held: f64,
    none: f64,
}

impl Tolerances {
    /// Forces are measured by what would undo the largest rate of the lightest, too: where everything lets go, nothing else gives them a size.
    fn of<R: Real>(problem: &ContactProblem<'_, R>, lambda: &[R]) -> Self {
        let largest = |x: &[R]| x.iter().fold(0.0_f64, |s, x| s.max(x.lane(0).abs()));
        let m = problem.m();
        let lightest = (0..m).fold(0.0_f64, |s, i| s.max(problem.a[i * m + i].lane(0)));
        let undoing = if lightest > 0.0 { largest(problem.b) / lightest } else { 0.0 };
        let [force, rate] = [largest(lambda).max(undoing), largest(problem.b)].map(|x| x + f64::MIN_POSITIVE);
        Self { force: SLACK * force, rate: SLACK * rate, held: HELD_RATE * rate, none: REFINED * rate }
    }
}

/// Changes what does not fit; says whether anything did not.
fn update_modes<R: Real>(
    problem: &ContactProblem<'_, R>,
    rates: &[R],
    blocks: &mut [UnilateralConstraint<R>],
    lambda: &[R],
) -> bool {
    let small = Tolerances::of(problem, lambda);
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
        // where the guess contradicts itself, the linear system leaves rates that should be none
        if block.given.is_none() && (normal < -small.force || rate > small.held) {
            block.open = true;
            changed = true;
            continue;
        }
        changed |= block.given.is_none() && rate < -small.held;
        for group in block.groups.iter_mut().flatten().filter(|g| !g.slides) {
            changed |= update_friction_mode(group, normal.max(0.0), small, rates, lambda);
        }
    }
    changed
}

fn update_friction_mode<R: Real>(
    group: &mut FrictionGroup<R>,
    normal: f64,
    small: Tolerances,
    rates: &[R],
    lambda: &[R],
) -> bool {
    let limit = group.coefficient * normal;
    let (force, rate) = (pair(group, lambda), pair(group, rates));
    let (size, speed) = (norm(force), norm(rate));
    if group.grip == ContactMode::Stick {
        if size > limit + small.force {
            group.slip(force.map(|x| R::splat(x / size)), None);
            return true;
        }
        return speed > small.held;
    }
    if speed <= small.rate {
        // at its limit and still; what can turn must not have turned beyond it
        let beyond = size > limit + small.force;
        // and what gives way has no reason to creep
        let creeps = group.give.is_some() && speed > small.none && size > 0.0;
        if beyond || creeps {
            group.slip(force.map(|x| R::splat(x / size)), None);
        }
        return beyond || creeps;
    }
    let d = group.direction.map(|d| d.lane(0));
    if rate[0] * d[0] + rate[1] * d[1] > 0.0 {
        group.stick();
        return true;
    }
    // turn the force against what it is about to do
    let turned = norm([rate[0] + speed * d[0], rate[1] + speed * d[1]]);
    if turned <= SLACK * speed {
        return false;
    }
    let give = R::splat(speed / limit.max(f64::MIN_POSITIVE));
    group.slip(rate.map(|x| R::splat(-x / speed)), Some(give));
    true
}

/// The numbers of a group in a list over rows.
fn pair<R: Real>(group: &FrictionGroup<R>, list: &[R]) -> [f64; 2] {
    std::array::from_fn(|k| if k < group.dim { list[group.row + k].lane(0) } else { 0.0 })
}

fn norm(x: [f64; 2]) -> f64 {
    (x[0] * x[0] + x[1] * x[1]).sqrt()
}

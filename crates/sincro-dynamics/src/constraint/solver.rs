//! The constraint problem of one instant: w = A λ + b with free rows, normal rows and discs of friction.
//!
//! Who lets go, sticks or slips is guessed from the last solution; the forces then follow from one linear system ([`super::active_set`]), solved with its
//! rank revealed ([`Dense`]), as a correction to the last ones, so that redundant contacts keep the share they had. If the forces fit the guess,
//! that was all. If not, what does not fit is changed, a few times, which for directions of slipping is Newton's method. If that does not help,
//! the problem is solved without a guess ([`super::admm`]), and the linear system makes its result exact.

use sincro_math::Real;

use super::active_set::{Guess, Instant};
use super::admm::{Splitting, ask_all};
use super::cone::{Block, Grip, Group};
use super::dense::{Dense, RANK};

/// Share of the largest force or rate that counts as zero in judging a guess.
const SLACK: f64 = 1e-9;

/// Share of the largest rate that may be left where there should be none: redundant contacts whose gaps differ by rounding contradict each other by
/// as much; a guess that contradicts itself leaves far more.
const HELD: f64 = 1e-6;

/// Share of the largest rate that elimination may leave without another look.
const REFINED: f64 = 1e-12;

/// Changes of a guess before splitting decides.
const REPAIRS: usize = 8;

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
    guess: Guess<R>,
    splitting: Splitting,
    delta: Vec<R>,
    asked: Vec<Block<R>>,
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
        self.guess.reserve(m);
        let more = |len: usize| m.saturating_sub(len);
        for list in [&mut self.delta, &mut self.start] {
            list.reserve(more(list.len()));
        }
        self.asked.reserve(more(self.asked.len()));
    }

    /// Finds λ, which holds the last solution (or zeros) before, and the state of the blocks.
    pub fn solve(&mut self, instant: &Instant<'_, R>, blocks: &mut [Block<R>], lambda: &mut [R]) {
        self.report.solved += 1;
        self.rank = RANK;
        self.search(instant, blocks, lambda);
        self.note_effects(instant, blocks, lambda);
    }

    fn search(&mut self, instant: &Instant<'_, R>, blocks: &mut [Block<R>], lambda: &mut [R]) {
        if self.mend(instant, blocks, lambda) {
            return;
        }
        self.report.split += 1;
        // from nothing, so that redundant contacts share alike: what they had did not fit
        lambda.fill(R::zero());
        ask_all(blocks);
        let mut asked = core::mem::take(&mut self.asked);
        asked.clear();
        asked.extend_from_slice(blocks);
        self.splitting.begin(instant, &mut self.guess, &mut self.dense, blocks, lambda);
        let mut iterations = FIRST_ITERATIONS;
        loop {
            let done = self.splitting.run(iterations);
            blocks.copy_from_slice(&asked);
            self.guess.take(instant.n_free, blocks, lambda);
            self.splitting.finish(&self.guess, blocks, lambda);
            self.start.clear();
            self.start.extend_from_slice(lambda);
            if self.mend(instant, blocks, lambda) {
                break;
            }
            if done {
                // feasible, only not exact
                lambda.copy_from_slice(&self.start);
                blocks.copy_from_slice(&asked);
                self.guess.take(instant.n_free, blocks, lambda);
                self.splitting.finish(&self.guess, blocks, lambda);
                self.note_misfit(instant, blocks, lambda);
                break;
            }
            iterations *= 2;
        }
        self.asked = asked;
    }

    /// Corrects, and changes what does not fit, until everything fits; says whether it does.
    fn mend(&mut self, instant: &Instant<'_, R>, blocks: &mut [Block<R>], lambda: &mut [R]) -> bool {
        for _ in 0..REPAIRS {
            self.correct(instant, blocks, lambda);
            if blocks.is_empty() {
                return true;
            }
            self.guess.find_rates(instant, lambda);
            if !repair(instant, &self.guess.rates, blocks, lambda) {
                self.refine(instant, blocks, lambda);
                return true;
            }
        }
        false
    }

    /// Once more, where elimination left more than rounding.
    fn refine(&mut self, instant: &Instant<'_, R>, blocks: &[Block<R>], lambda: &mut [R]) {
        let small = Small::of(instant, lambda).none;
        let rates = &self.guess.rates;
        let holds = |block: &&Block<R>| !block.open && block.given.is_none();
        let normals = blocks.iter().filter(holds).map(|block| rates[block.row]);
        if rates[..instant.n_free].iter().copied().chain(normals).any(|rate| rate.lane(0).abs() > small) {
            self.correct(instant, blocks, lambda);
            self.guess.find_rates(instant, lambda);
        }
    }

    /// The linear system of the guess.
    pub fn correct(&mut self, instant: &Instant<'_, R>, blocks: &[Block<R>], lambda: &mut [R]) {
        self.guess.take(instant.n_free, blocks, lambda);
        self.guess.find_rates(instant, lambda);
        self.guess.system(instant, blocks, lambda, &mut self.dense);
        self.delta.clear();
        self.delta.resize(self.guess.len(), R::zero());
        self.dense.solve(self.rank, &mut self.delta);
        self.redundant = self.dense.redundant().iter().filter(|k| **k < instant.n_free).count();
        self.guess.change(blocks, &self.delta, lambda);
    }

    /// Notes what can be seen of every block.
    fn note_effects(&mut self, instant: &Instant<'_, R>, blocks: &mut [Block<R>], lambda: &[R]) {
        let small = 10.0 * Small::of(instant, lambda).rate;
        let rates = &self.guess.rates;
        for block in blocks.iter_mut() {
            block.effect = 0;
            if block.open {
                block.effect = u8::from(rates[block.row].lane(0) > small);
                continue;
            }
            for (g, group) in block.groups.iter().enumerate() {
                let Some(group) = group.filter(|g| !g.slides && g.grip == Grip::Slip) else { continue };
                let rate = rates[group.row..group.row + group.dim].iter().map(|r| r.lane(0).abs()).fold(0.0, f64::max);
                block.effect |= u8::from(rate > small) << (g + 1);
            }
        }
    }

    /// How far forces and rates are from their laws, as a share of the largest.
    fn note_misfit(&mut self, instant: &Instant<'_, R>, blocks: &[Block<R>], lambda: &[R]) {
        self.guess.find_rates(instant, lambda);
        let largest = instant.b.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        let rate = |i: usize| self.guess.rates[i].lane(0);
        let mut worst = (0..instant.n_free).map(|i| rate(i).abs()).fold(0.0, f64::max);
        for block in blocks {
            if block.given.is_none() {
                let r = rate(block.row);
                worst = worst.max(if block.open { (-r).max(0.0) } else { r.abs() });
            }
            for group in block.groups.iter().flatten().filter(|g| !g.slides && !block.open) {
                let w = pair(group, &self.guess.rates);
                let d = group.direction.map(|d| d.lane(0));
                // what sticks has no rate, what slips none but against its force
                worst = worst.max(match group.grip {
                    Grip::Stick => norm(w),
                    Grip::Slip => (w[0] * d[1] - w[1] * d[0]).abs().max(w[0] * d[0] + w[1] * d[1]),
                });
            }
        }
        let misfit = worst / largest;
        if misfit > SLACK {
            self.report.not_converged += 1;
            self.report.worst_residual = self.report.worst_residual.max(misfit);
        }
    }
}

/// What counts as zero beside the largest force and the largest rate.
#[derive(Clone, Copy)]
struct Small {
    force: f64,
    rate: f64,
    held: f64,
    none: f64,
}

impl Small {
    /// Forces are measured by what would undo the largest rate of the lightest, too: where everything lets go, nothing else gives them a size.
    fn of<R: Real>(instant: &Instant<'_, R>, lambda: &[R]) -> Self {
        let largest = |x: &[R]| x.iter().fold(0.0_f64, |s, x| s.max(x.lane(0).abs()));
        let m = instant.m();
        let lightest = (0..m).fold(0.0_f64, |s, i| s.max(instant.a[i * m + i].lane(0)));
        let undoing = if lightest > 0.0 { largest(instant.b) / lightest } else { 0.0 };
        let [force, rate] = [largest(lambda).max(undoing), largest(instant.b)].map(|x| x + f64::MIN_POSITIVE);
        Self { force: SLACK * force, rate: SLACK * rate, held: HELD * rate, none: REFINED * rate }
    }
}

/// Changes what does not fit; says whether anything did not.
fn repair<R: Real>(instant: &Instant<'_, R>, rates: &[R], blocks: &mut [Block<R>], lambda: &[R]) -> bool {
    let small = Small::of(instant, lambda);
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
            changed |= repair_group(group, normal.max(0.0), small, rates, lambda);
        }
    }
    changed
}

fn repair_group<R: Real>(group: &mut Group<R>, normal: f64, small: Small, rates: &[R], lambda: &[R]) -> bool {
    let limit = group.coefficient * normal;
    let (force, rate) = (pair(group, lambda), pair(group, rates));
    let (size, speed) = (norm(force), norm(rate));
    if group.grip == Grip::Stick {
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
fn pair<R: Real>(group: &Group<R>, list: &[R]) -> [f64; 2] {
    std::array::from_fn(|k| if k < group.dim { list[group.row + k].lane(0) } else { 0.0 })
}

fn norm(x: [f64; 2]) -> f64 {
    (x[0] * x[0] + x[1] * x[1]).sqrt()
}

//! The constraint problem of one instant: w = A λ + b with free rows, normal rows and discs of friction.
//!
//! Who lets go, sticks or slips is guessed from the last solution; the forces then follow from one linear system, solved with its rank revealed
//! ([`Dense`]), as a correction to the last ones, so that redundant contacts keep the share they had. If the forces fit the guess, that
//! was all. If not, and there are redundant contacts, the load is spread: among all forces that solve the system those are taken that are
//! least in proportion to what each contact can bear, a few times with the limits found last, which is affine scaling towards the inside of the
//! cones. If that does not help, what does not fit is changed, a few times; then sweeps ([`super::cone`]) decide, and the linear system makes their result exact.

use sincro_math::Real;

use super::cone::{Block, Grip, Problem};
use super::dense::{Dense, RANK};

/// Share of the largest force or rate that counts as zero in judging a guess.
const SLACK: f64 = 1e-9;

/// Times that a load is spread.
const SPREADS: usize = 8;

/// Changes of a guess before sweeps decide.
const REPAIRS: usize = 16;

/// What solving took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolverReport {
    /// Problems solved.
    pub solved: u64,
    /// Problems that needed sweeps.
    pub swept: u64,
    /// Problems whose forces do not fit their laws within a share of 1e-9.
    pub not_converged: u64,
    /// The largest misfit among those, as a share of the largest force or rate.
    pub worst_residual: f64,
}

/// Working memory; grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solver<R> {
    dense: Dense<R>,
    kept: Vec<usize>,
    delta: Vec<R>,
    flat_a: Vec<f64>,
    flat_b: Vec<f64>,
    flat: Vec<f64>,
    blocks: Vec<Block<f64>>,
    saved: Vec<Block<R>>,
    weights: Vec<R>,
    square: Vec<R>,
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
        let more = |len: usize, wanted: usize| wanted.saturating_sub(len);
        self.kept.reserve(more(self.kept.len(), m));
        for list in [&mut self.delta, &mut self.weights] {
            list.reserve(more(list.len(), m));
        }
        self.square.reserve(more(self.square.len(), m * m));
        self.saved.reserve(more(self.saved.len(), m));
    }

    /// Finds λ, which holds the last solution (or zeros) before, and the state of the blocks.
    pub fn solve(&mut self, a: &[R], b: &[R], n_free: usize, blocks: &mut [Block<R>], lambda: &mut [R]) {
        self.report.solved += 1;
        self.rank = RANK;
        self.search(a, b, n_free, blocks, lambda);
        note_effects(a, b, blocks, lambda);
    }

    fn search(&mut self, a: &[R], b: &[R], n_free: usize, blocks: &mut [Block<R>], lambda: &mut [R]) {
        for k in 0..REPAIRS {
            self.correct(a, b, n_free, blocks, lambda);
            self.saved.clear();
            self.saved.extend_from_slice(blocks);
            if blocks.is_empty() || !repair(a, b, blocks, lambda) {
                return;
            }
            if k == 0 && self.dense.rank < self.dense.n && self.spread(a, b, n_free, blocks, lambda) {
                return;
            }
        }
        self.report.swept += 1;
        self.sweep(a, b, n_free, blocks, lambda);
        for _ in 0..REPAIRS {
            self.correct(a, b, n_free, blocks, lambda);
            if !repair(a, b, blocks, lambda) {
                return;
            }
        }
        // the sweeps' own result is feasible, only not exact
        self.sweep(a, b, n_free, blocks, lambda);
        let misfit = misfit(a, b, n_free, blocks, lambda);
        if misfit > SLACK {
            self.report.not_converged += 1;
            self.report.worst_residual = self.report.worst_residual.max(misfit);
        }
    }

    /// The rows that a guess solves for.
    fn keep(&mut self, n_free: usize, blocks: &[Block<R>], lambda: &mut [R]) {
        self.kept.clear();
        self.kept.extend(0..n_free);
        for block in blocks {
            impose(block, lambda);
            if block.open {
                continue;
            }
            if block.given.is_none() {
                self.kept.push(block.row);
            }
            for group in block.groups.iter().flatten().filter(|g| g.grip == Grip::Stick) {
                self.kept.extend(group.row..group.row + group.dim);
            }
            self.kept.extend(block.groups.iter().flatten().filter(|g| g.is_slow()).map(|g| g.row + 1));
        }
    }

    /// The linear system of the guess.
    pub fn correct(&mut self, a: &[R], b: &[R], n_free: usize, blocks: &[Block<R>], lambda: &mut [R]) {
        let m = b.len();
        self.keep(n_free, blocks, lambda);
        let n = self.kept.len();
        self.dense.reset(n);
        for (i, &row) in self.kept.iter().enumerate() {
            for (j, &column) in self.kept.iter().enumerate() {
                self.dense.set(i, j, a[row * m + column]);
            }
            self.dense.rhs[i] = -w(a, b, row, lambda);
        }
        for group in blocks.iter().flat_map(|b| b.groups.iter().flatten()) {
            if let (Some(give), Some(i)) = (group.give, self.kept.iter().position(|k| *k == group.row + 1)) {
                let row = group.row + 1;
                self.dense.set(i, i, a[row * m + row] + give);
                self.dense.rhs[i] -= give * lambda[row];
            }
        }
        // a slipping group's force goes with its normal force
        for block in blocks.iter().filter(|b| !b.open && b.given.is_none()) {
            let slipping = || block.groups.iter().flatten().filter(|g| g.grip == Grip::Slip);
            if slipping().next().is_none() {
                continue;
            }
            let j = self.kept.iter().position(|k| *k == block.row).expect("the normal row is kept");
            for (i, &row) in self.kept.iter().enumerate() {
                let mut sum = a[row * m + block.row];
                for group in slipping() {
                    for k in 0..group.dim {
                        sum += a[row * m + group.row + k] * R::splat(group.coefficient) * group.direction[k];
                    }
                }
                self.dense.set(i, j, sum);
            }
        }
        self.delta.clear();
        self.delta.resize(n, R::zero());
        self.dense.solve(self.rank, &mut self.delta);
        self.redundant = self.dense.redundant().iter().filter(|k| self.kept[**k] < n_free).count();
        for (&row, &change) in self.kept.iter().zip(&self.delta) {
            lambda[row] += change;
        }
        for block in blocks {
            impose(block, lambda);
        }
    }

    /// Spreads the load of the guess before it was repaired; says whether that fits.
    fn spread(&mut self, a: &[R], b: &[R], n_free: usize, blocks: &mut [Block<R>], lambda: &mut [R]) -> bool {
        // every contact is asked, and none is known to slip that does not slide
        for block in self.saved.iter_mut().filter(|b| b.given.is_none()) {
            block.open = false;
            for group in block.groups.iter_mut().flatten().filter(|g| !g.slides) {
                group.grip = Grip::Stick;
            }
        }
        let guess = core::mem::take(&mut self.saved);
        self.weights.clear();
        self.weights.resize(b.len(), R::one());
        let mut fits = false;
        for _ in 0..SPREADS {
            lambda.fill(R::zero());
            self.weigh(a, b, n_free, &guess, lambda);
            self.correct(a, b, n_free, &guess, lambda);
            if !unfit(a, b, &guess, lambda) {
                fits = true;
                break;
            }
            self.set_weights(&guess, lambda);
        }
        // where it does not fit, what the spread load asks too much of is the better guess of what slips
        blocks.copy_from_slice(&guess);
        if !fits {
            repair(a, b, blocks, lambda);
        }
        self.saved = guess;
        fits
    }

    /// How much each force may be, from the normal forces found last: where all slide alike, friction in proportion to load.
    fn set_weights(&mut self, blocks: &[Block<R>], lambda: &[R]) {
        let largest = lambda.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        self.weights.fill(R::splat(largest));
        for block in blocks {
            let normal = lambda[block.row].lane(0).max(1e-3 * largest);
            self.weights[block.row] = R::splat(normal);
            for group in block.groups.iter().flatten() {
                let limit = group.coefficient * normal;
                self.weights[group.row..group.row + group.dim].fill(R::splat(limit));
            }
        }
    }

    /// λ = W Aᵀ (A W Aᵀ)⁺ (−b) over the rows of the guess.
    fn weigh(&mut self, a: &[R], b: &[R], n_free: usize, blocks: &[Block<R>], lambda: &mut [R]) {
        let m = b.len();
        self.keep(n_free, blocks, lambda);
        let n = self.kept.len();
        self.square.clear();
        self.square.resize(n * n, R::zero());
        for (i, &row) in self.kept.iter().enumerate() {
            for (j, &column) in self.kept.iter().enumerate() {
                self.square[i * n + j] = a[row * m + column];
            }
        }
        self.dense.reset(n);
        for i in 0..n {
            for j in 0..n {
                let mut sum = R::zero();
                for (k, &row) in self.kept.iter().enumerate() {
                    sum += self.square[i * n + k] * self.weights[row] * self.square[j * n + k];
                }
                self.dense.set(i, j, sum);
            }
            self.dense.rhs[i] = -w(a, b, self.kept[i], lambda);
        }
        self.delta.clear();
        self.delta.resize(n, R::zero());
        self.dense.solve(RANK, &mut self.delta);
        for (k, &row) in self.kept.iter().enumerate() {
            let mut sum = R::zero();
            for i in 0..n {
                sum += self.square[i * n + k] * self.delta[i];
            }
            lambda[row] += self.weights[row] * sum;
        }
    }

    fn sweep(&mut self, a: &[R], b: &[R], n_free: usize, blocks: &mut [Block<R>], lambda: &mut [R]) {
        let fill = |into: &mut Vec<f64>, from: &[R]| {
            into.clear();
            into.extend(from.iter().map(|x| x.lane(0)));
        };
        fill(&mut self.flat_a, a);
        fill(&mut self.flat_b, b);
        fill(&mut self.flat, lambda);
        self.blocks.clear();
        self.blocks.extend(blocks.iter().map(|block| Block {
            slot: block.slot,
            effect: block.effect,
            row: block.row,
            open: block.open,
            given: block.given.map(|x| x.lane(0)),
            groups: block.groups.map(|g| {
                g.map(|g| super::cone::Group {
                    row: g.row,
                    dim: g.dim,
                    coefficient: g.coefficient,
                    slides: g.slides,
                    grip: g.grip,
                    direction: g.direction.map(|x| x.lane(0)),
                    give: g.give.map(|x| x.lane(0)),
                })
            }),
        }));
        let problem = Problem { m: b.len(), a: &self.flat_a, b: &self.flat_b, n_free };
        problem.sweep(&self.blocks, &mut self.flat, 1e-13);
        for (into, from) in lambda.iter_mut().zip(&self.flat) {
            *into = R::splat(*from);
        }
        for block in blocks.iter_mut() {
            let normal = self.flat[block.row];
            block.open = block.given.is_none() && normal <= 0.0;
            for group in block.groups.iter_mut().flatten() {
                let force: [f64; 2] =
                    std::array::from_fn(|k| if k < group.dim { self.flat[group.row + k] } else { 0.0 });
                let size = (force[0] * force[0] + force[1] * force[1]).sqrt();
                if group.slides {
                    continue;
                }
                let at_limit = size >= group.coefficient * normal * (1.0 - 1e-10);
                group.grip = if at_limit && !block.open { Grip::Slip } else { Grip::Stick };
                if group.grip == Grip::Slip && size > 0.0 {
                    group.direction = force.map(|x| R::splat(x / size));
                }
            }
        }
    }
}

/// w of one row.
pub(crate) fn w<R: Real>(a: &[R], b: &[R], i: usize, lambda: &[R]) -> R {
    let m = b.len();
    let mut sum = b[i];
    for (x, l) in a[i * m..(i + 1) * m].iter().zip(lambda) {
        sum += *x * *l;
    }
    sum
}

/// Writes what a block's state says of its forces: none where it lets go, the limit along its direction where it slips.
fn impose<R: Real>(block: &Block<R>, lambda: &mut [R]) {
    if let Some(force) = block.given {
        lambda[block.row] = force;
    }
    if block.open {
        lambda[block.row] = R::zero();
    }
    for group in block.groups.iter().flatten() {
        for k in 0..group.dim {
            if k == 1 && group.is_slow() && !block.open {
                continue;
            }
            if block.open {
                lambda[group.row + k] = R::zero();
            } else if group.grip == Grip::Slip {
                lambda[group.row + k] = R::splat(group.coefficient) * lambda[block.row] * group.direction[k];
            }
        }
    }
}

/// Scales of forces and rates: what counts as zero beside them.
fn scales<R: Real>(b: &[R], lambda: &[R]) -> (f64, f64) {
    let largest = |x: &[R]| x.iter().fold(0.0_f64, |s, x| s.max(x.lane(0).abs()));
    (SLACK * largest(lambda) + f64::MIN_POSITIVE, SLACK * largest(b) + f64::MIN_POSITIVE)
}

/// Notes what can be seen of every block.
fn note_effects<R: Real>(a: &[R], b: &[R], blocks: &mut [Block<R>], lambda: &[R]) {
    let small = 10.0 * scales(b, lambda).1;
    for block in blocks.iter_mut() {
        block.effect = 0;
        if block.open {
            block.effect = u8::from(w(a, b, block.row, lambda).lane(0) > small);
            continue;
        }
        for (g, group) in block.groups.iter().enumerate() {
            let Some(group) = group.filter(|g| !g.slides && g.grip == Grip::Slip) else { continue };
            let rate: f64 = (0..group.dim).map(|k| w(a, b, group.row + k, lambda).lane(0).abs()).fold(0.0, f64::max);
            block.effect |= u8::from(rate > small) << (g + 1);
        }
    }
}

/// Whether a guess does not fit its forces.
fn unfit<R: Real>(a: &[R], b: &[R], blocks: &[Block<R>], lambda: &[R]) -> bool {
    let (small_force, small_rate) = scales(b, lambda);
    blocks.iter().any(|block| {
        let normal = lambda[block.row].lane(0);
        if block.open {
            return w(a, b, block.row, lambda).lane(0) < -small_rate;
        }
        let beyond = |g: &super::cone::Group<R>| {
            let square: f64 = lambda[g.row..g.row + g.dim].iter().map(|x| x.lane(0) * x.lane(0)).sum();
            g.grip == Grip::Stick && square.sqrt() > g.coefficient * normal.max(0.0) + small_force
        };
        (block.given.is_none() && normal < -small_force) || block.groups.iter().flatten().any(beyond)
    })
}

/// Changes what does not fit; says whether anything did not.
fn repair<R: Real>(a: &[R], b: &[R], blocks: &mut [Block<R>], lambda: &[R]) -> bool {
    let (small_force, small_rate) = scales(b, lambda);
    let mut changed = false;
    for block in blocks.iter_mut() {
        let rate = w(a, b, block.row, lambda).lane(0);
        if block.open {
            if rate < -small_rate {
                block.open = false;
                changed = true;
            }
            continue;
        }
        let normal = lambda[block.row].lane(0);
        if block.given.is_none() && normal < -small_force {
            block.open = true;
            changed = true;
            continue;
        }
        for group in block.groups.iter_mut().flatten().filter(|g| !g.slides) {
            changed |= repair_group(a, b, group, normal, (small_force, small_rate), lambda);
        }
    }
    changed
}

fn repair_group<R: Real>(
    a: &[R],
    b: &[R],
    group: &mut super::cone::Group<R>,
    normal: f64,
    (small_force, small_rate): (f64, f64),
    lambda: &[R],
) -> bool {
    let pick = |f: &dyn Fn(usize) -> f64| -> [f64; 2] {
        std::array::from_fn(|k| if k < group.dim { f(group.row + k) } else { 0.0 })
    };
    let norm = |x: [f64; 2]| (x[0] * x[0] + x[1] * x[1]).sqrt();
    let force = pick(&|i| lambda[i].lane(0));
    match group.grip {
        Grip::Stick => {
            let size = norm(force);
            if size <= group.coefficient * normal.max(0.0) + small_force {
                return false;
            }
            group.grip = Grip::Slip;
            group.direction = force.map(|x| R::splat(x / size));
            true
        }
        Grip::Slip => {
            let rate = pick(&|i| w(a, b, i, lambda).lane(0));
            let size = norm(rate);
            if size <= small_rate {
                return false;
            }
            let along = rate[0] * group.direction[0].lane(0) + rate[1] * group.direction[1].lane(0);
            if along > 0.0 {
                group.grip = Grip::Stick;
                return true;
            }
            // turn the force against what it is about to do
            let turned =
                norm([rate[0] + size * group.direction[0].lane(0), rate[1] + size * group.direction[1].lane(0)]);
            if turned <= 1e-13 * size {
                return false;
            }
            group.direction = rate.map(|x| R::splat(-x / size));
            turned > 1e-9 * size
        }
    }
}

/// How far forces and rates are from their laws, as a share of the largest.
fn misfit<R: Real>(a: &[R], b: &[R], n_free: usize, blocks: &[Block<R>], lambda: &[R]) -> f64 {
    let largest = b.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
    let rate = |i: usize| w(a, b, i, lambda).lane(0);
    let mut worst = (0..n_free).map(|i| rate(i).abs()).fold(0.0, f64::max);
    for block in blocks {
        let r = rate(block.row);
        let closed = block.given.is_none() && lambda[block.row].lane(0) > 0.0;
        worst = worst.max(if closed {
            r.abs()
        } else if block.given.is_none() {
            (-r).max(0.0)
        } else {
            0.0
        });
        for group in block.groups.iter().flatten().filter(|g| !g.slides && g.grip == Grip::Stick) {
            for k in 0..group.dim {
                worst = worst.max(rate(group.row + k).abs());
            }
        }
    }
    worst / largest
}

//! What a guess about every block leaves unknown, and the linear system of it.
//!
//! | unknown | what it moves | what it makes zero |
//! |---|---|---|
//! | a row that holds (closures, what sticks) | its force | its rate |
//! | the normal force of what presses | it, and the friction c λₙ d of each group that slips along d | the normal rate |
//! | the force across the slipping, where it can turn | λₑ along e ⟂ d | wₑ + give λₑ |
//!
//! Friction that slips opposes the slipping. With d = −w/|w| known from before, the change of direction is linear in the rate across:
//! λₑ = −(c λₙ/|w|) wₑ, so give = |w|/(c λₙ). That is Newton's method for the cone.

use sincro_math::Real;

use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::dense::Dense;

/// A row of A with its coefficient.
type Term<R> = (usize, R);

/// One unknown: the terms it moves and the terms it is tested with.
#[derive(Clone, Copy, Debug)]
enum Unknown {
    /// A row that holds.
    Row(usize),
    /// The normal row of a block.
    Normal(usize),
    /// The direction across a slipping group: block and group.
    Across(usize, usize),
}

/// Most terms of an unknown: a normal row and three groups of friction.
const MAX_TERMS: usize = 6;

/// The unknowns of a guess; grows to the largest problem it has seen.
#[derive(Clone, Debug)]
pub(crate) struct ActiveSet<R> {
    unknowns: Vec<Unknown>,
    tested: Vec<usize>,
    across: Vec<usize>,
    column: Vec<R>,
    /// A λ + b.
    pub rates: Vec<R>,
}

impl<R> Default for ActiveSet<R> {
    fn default() -> Self {
        Self { unknowns: Vec::new(), tested: Vec::new(), across: Vec::new(), column: Vec::new(), rates: Vec::new() }
    }
}

/// The problem of one instant: w = A λ + b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactProblem<'a, R> {
    /// Row by row, symmetric.
    pub a: &'a [R],
    pub b: &'a [R],
    /// Rows without bounds come first.
    pub n_free: usize,
}

impl<R: Real> ContactProblem<'_, R> {
    pub fn m(&self) -> usize {
        self.b.len()
    }

    fn row(&self, i: usize) -> &[R] {
        let m = self.m();
        &self.a[i * m..(i + 1) * m]
    }
}

impl<R: Real> ActiveSet<R> {
    /// Memory for problems of `m` rows.
    pub fn reserve(&mut self, m: usize) {
        let more = |len: usize| m.saturating_sub(len);
        self.unknowns.reserve(more(self.unknowns.len()));
        self.tested.reserve(more(self.tested.len()));
        self.across.reserve(more(self.across.len()));
        for list in [&mut self.column, &mut self.rates] {
            list.reserve(more(list.len()));
        }
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.unknowns.len()
    }

    /// Row of A that holds unknown `k`, for what is not across.
    pub fn row(&self, k: usize, blocks: &[UnilateralConstraint<R>]) -> Option<usize> {
        match self.unknowns[k] {
            Unknown::Row(row) => Some(row),
            Unknown::Normal(block) => Some(blocks[block].row),
            Unknown::Across(..) => None,
        }
    }

    /// Lists what the blocks leave unknown, and makes λ fit what they say.
    pub fn take(&mut self, n_free: usize, blocks: &[UnilateralConstraint<R>], lambda: &mut [R]) {
        self.unknowns.clear();
        self.unknowns.extend((0..n_free).map(Unknown::Row));
        for (k, block) in blocks.iter().enumerate() {
            impose(block, lambda);
            if block.open {
                continue;
            }
            if block.given.is_none() {
                self.unknowns.push(Unknown::Normal(k));
            }
            for (g, group) in block.groups.iter().enumerate() {
                let Some(group) = group else { continue };
                if group.grip == ContactMode::Stick {
                    self.unknowns.extend((group.row..group.row + group.dim).map(Unknown::Row));
                } else if group.give.is_some() {
                    self.unknowns.push(Unknown::Across(k, g));
                }
            }
        }
    }

    /// The rates that λ makes.
    pub fn find_rates(&mut self, problem: &ContactProblem<'_, R>, lambda: &[R]) {
        self.rates.clear();
        self.rates.extend_from_slice(problem.b);
        // A is symmetric: its columns are its rows
        for (i, x) in lambda.iter().enumerate().filter(|(_, x)| **x != R::zero()) {
            for (rate, a) in self.rates.iter_mut().zip(problem.row(i)) {
                *rate += *a * *x;
            }
        }
    }

    /// The linear system: how the tested rates answer the unknowns, and what they are to change by. Rates must be those of λ.
    pub fn system(
        &mut self,
        problem: &ContactProblem<'_, R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &[R],
        dense: &mut Dense<R>,
    ) {
        let n = self.unknowns.len();
        dense.reset(n);
        let mut column = core::mem::take(&mut self.column);
        self.list_tested(blocks);
        for j in 0..n {
            let unknown = self.unknowns[j];
            self.answer(problem, unknown, blocks, &mut column);
            for (i, row) in self.tested.iter().enumerate() {
                dense.set(i, j, column[*row]);
            }
            for i in self.across.iter().copied() {
                dense.set(i, j, self.test(self.unknowns[i], blocks, &column));
            }
            let mut rest = self.test(unknown, blocks, &self.rates);
            if let Unknown::Across(k, g) = unknown {
                let group = group(blocks, k, g);
                let give = group.give.unwrap_or(R::zero());
                dense.add(j, j, give);
                rest += give * across(group, lambda);
            }
            dense.rhs[j] = -rest;
        }
        self.column = column;
    }

    /// The row that each unknown is tested with (for what is tested across, any), and which are tested across.
    fn list_tested(&mut self, blocks: &[UnilateralConstraint<R>]) {
        self.tested.clear();
        self.across.clear();
        for (k, unknown) in self.unknowns.iter().enumerate() {
            self.tested.push(match *unknown {
                Unknown::Row(row) => row,
                Unknown::Normal(block) | Unknown::Across(block, _) => blocks[block].row,
            });
            if let Unknown::Across(..) = unknown {
                self.across.push(k);
            }
        }
    }

    /// Adds changes of the unknowns to λ.
    pub fn change(&self, blocks: &[UnilateralConstraint<R>], delta: &[R], lambda: &mut [R]) {
        for (unknown, delta) in self.unknowns.iter().zip(delta) {
            let mut terms = [(0, R::zero()); MAX_TERMS];
            for (row, c) in moved(*unknown, blocks, &mut terms) {
                lambda[*row] += *c * *delta;
            }
        }
    }

    /// What all rates answer to one unknown.
    fn answer(
        &self,
        problem: &ContactProblem<'_, R>,
        unknown: Unknown,
        blocks: &[UnilateralConstraint<R>],
        out: &mut Vec<R>,
    ) {
        let mut terms = [(0, R::zero()); MAX_TERMS];
        out.clear();
        let terms = moved(unknown, blocks, &mut terms);
        let (first, c) = terms[0];
        out.extend(problem.row(first).iter().map(|a| *a * c));
        for (row, c) in &terms[1..] {
            for (out, a) in out.iter_mut().zip(problem.row(*row)) {
                *out += *a * *c;
            }
        }
    }

    fn test(&self, unknown: Unknown, blocks: &[UnilateralConstraint<R>], rates: &[R]) -> R {
        match unknown {
            Unknown::Row(row) => rates[row],
            Unknown::Normal(k) => rates[blocks[k].row],
            Unknown::Across(k, g) => across(group(blocks, k, g), rates),
        }
    }
}

fn group<R>(blocks: &[UnilateralConstraint<R>], k: usize, g: usize) -> &FrictionGroup<R> {
    blocks[k].groups[g].as_ref().expect("it was listed")
}

/// Component across the direction of a group.
fn across<R: Real>(group: &FrictionGroup<R>, x: &[R]) -> R {
    let [d0, d1] = group.direction;
    d0 * x[group.row + 1] - d1 * x[group.row]
}

/// The forces that an unknown moves.
fn moved<'a, R: Real>(
    unknown: Unknown,
    blocks: &[UnilateralConstraint<R>],
    terms: &'a mut [Term<R>; MAX_TERMS],
) -> &'a [Term<R>] {
    let mut n = 0;
    let mut add = |row: usize, c: R| {
        terms[n] = (row, c);
        n += 1;
    };
    match unknown {
        Unknown::Row(row) => add(row, R::one()),
        Unknown::Across(k, g) => {
            let group = group(blocks, k, g);
            add(group.row, -group.direction[1]);
            add(group.row + 1, group.direction[0]);
        }
        Unknown::Normal(k) => {
            add(blocks[k].row, R::one());
            for group in blocks[k].groups.iter().flatten().filter(|g| g.grip == ContactMode::Slip) {
                for i in 0..group.dim {
                    add(group.row + i, R::splat(group.coefficient) * group.direction[i]);
                }
            }
        }
    }
    &terms[..n]
}

/// Writes what a block's state says of its forces: none where it lets go, the limit along its direction where it slips, and across it what there was
/// if it can turn.
fn impose<R: Real>(block: &UnilateralConstraint<R>, lambda: &mut [R]) {
    if let Some(force) = block.given {
        lambda[block.row] = force;
    }
    if block.open {
        lambda[block.row] = R::zero();
    }
    for group in block.groups.iter().flatten() {
        if block.open {
            lambda[group.row..group.row + group.dim].fill(R::zero());
        } else if group.grip == ContactMode::Slip {
            let limit = R::splat(group.coefficient) * lambda[block.row];
            let turned = if group.give.is_some() { across(group, lambda) } else { R::zero() };
            let [d0, d1] = group.direction;
            lambda[group.row] = limit * d0 - turned * d1;
            if group.dim == 2 {
                lambda[group.row + 1] = limit * d1 + turned * d0;
            }
        }
    }
}

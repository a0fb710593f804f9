//! Linear system of the current active set: the unknown multipliers and the rates they must bring to zero.
//!
//! | unknown | forces it moves | condition |
//! |---|---|---|
//! | bilateral row, or row of a sticking group | its multiplier | its rate is zero |
//! | normal force λₙ of a closed contact | λₙ, and μ λₙ d of each group slipping along d | the normal rate is zero |
//! | friction across the slip direction, where it can turn | λₑ along e ⟂ d | wₑ + c λₑ = 0 |
//!
//! Slipping friction opposes the slip rate. With d = −w/|w| of the last iterate, the change of direction is linear in
//! the rate across: λₑ = −(μ λₙ/|w|) wₑ, so c = |w|/(μ λₙ). This is Newton's method for the friction cone. Source: key
//! `acary2008`, chapter 13.

use sincro_math::{Real, Task};

use super::cone::{ContactMode, FrictionGroup, UnilateralConstraint};
use super::dense::Dense;

/// Row of G with its coefficient.
type Term<R> = (usize, R);

/// Unknown of the linear system.
#[derive(Clone, Copy, Debug)]
enum Unknown {
    /// Bilateral row, or row of a sticking group.
    Row(usize),
    /// Normal row of a unilateral constraint.
    Normal(usize),
    /// Direction across a slipping group: indices of constraint and group.
    Across(usize, usize),
}

/// Maximum number of terms of an unknown: a normal row and three groups of friction.
const MAX_TERMS: usize = 6;

/// Unknowns of an active set; grows to the largest problem it has seen.
#[derive(Clone, Debug)]
pub(crate) struct ActiveSet<R> {
    unknowns: Vec<Unknown>,
    tested: Vec<usize>,
    across: Vec<usize>,
    column: Vec<R>,
    /// w = G λ + b.
    pub rates: Vec<R>,
}

impl<R> Default for ActiveSet<R> {
    fn default() -> Self {
        Self { unknowns: Vec::new(), tested: Vec::new(), across: Vec::new(), column: Vec::new(), rates: Vec::new() }
    }
}

/// Frictional contact problem w = G λ + b at one instant.
#[derive(Clone, Copy, Debug)]
pub struct ContactProblem<'a, R> {
    /// Delassus matrix G, row by row, symmetric.
    pub a: &'a [R],
    /// Rates without forces.
    pub b: &'a [R],
    /// Number of bilateral rows, which come first.
    pub n_free: usize,
}

impl<R: Real> ContactProblem<'_, R> {
    /// Number of rows.
    #[must_use]
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

    /// Row of G whose multiplier unknown `k` is; none for an unknown across a slip direction.
    pub fn row(&self, k: usize, blocks: &[UnilateralConstraint<R>]) -> Option<usize> {
        match self.unknowns[k] {
            Unknown::Row(row) => Some(row),
            Unknown::Normal(block) => Some(blocks[block].row),
            Unknown::Across(..) => None,
        }
    }

    /// Lists the unknowns of the current contact modes, and makes λ consistent with the modes.
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
                if group.mode == ContactMode::Stick {
                    self.unknowns.extend((group.row..group.row + group.dim).map(Unknown::Row));
                } else if group.compliance.is_some() {
                    self.unknowns.push(Unknown::Across(k, g));
                }
            }
        }
    }

    /// Finds the rates w of λ.
    pub fn find_rates(&mut self, problem: &ContactProblem<'_, R>, lambda: &[R]) {
        R::run_hot(Rates { rates: &mut self.rates, problem, lambda });
    }

    /// Fills the linear system: derivatives of the tested rates by the unknowns, and minus the rates. `rates` must be
    /// those of λ.
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
                let compliance = group.compliance.unwrap_or(R::zero());
                dense.add(j, j, compliance);
                rest += compliance * across(group, lambda);
                if let Some(rate) = group.sliding_rate(lambda[blocks[k].row].lane(0)) {
                    rest -= group.direction[1] * R::splat(rate);
                }
            }
            dense.rhs[j] = -rest;
        }
        self.column = column;
    }

    /// Lists the row that each unknown is tested with, and the unknowns tested across a slip direction.
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

    /// Rates that the conditions of the unknowns test, of a list over rows.
    pub fn tests(&self, blocks: &[UnilateralConstraint<R>], rates: &[R], out: &mut Vec<R>) {
        out.clear();
        out.extend(self.unknowns.iter().map(|unknown| self.test(*unknown, blocks, rates)));
    }

    /// Changes of the multipliers by changes of the unknowns, of `n` lists at once: row `i` of `deltas` has those of
    /// unknown `i`, row `k` of `out` those of multiplier `k`.
    #[inline(always)]
    pub fn changes(&self, blocks: &[UnilateralConstraint<R>], deltas: &[R], n: usize, out: &mut [R]) {
        out.fill(R::zero());
        for (unknown, deltas) in self.unknowns.iter().zip(deltas.chunks_exact(n)) {
            let mut terms = [(0, R::zero()); MAX_TERMS];
            for (row, c) in moved(*unknown, blocks, &mut terms) {
                for (x, delta) in out[row * n..(row + 1) * n].iter_mut().zip(deltas) {
                    *x += *c * *delta;
                }
            }
        }
    }

    /// Rates that the conditions of the unknowns test, of `n` lists over rows at once, laid out as in
    /// [`ActiveSet::changes`].
    #[inline(always)]
    pub fn test_all(&self, blocks: &[UnilateralConstraint<R>], rates: &[R], n: usize, out: &mut [R]) {
        let row = |k: usize| &rates[k * n..(k + 1) * n];
        for (unknown, out) in self.unknowns.iter().zip(out.chunks_exact_mut(n)) {
            match *unknown {
                Unknown::Row(k) => out.copy_from_slice(row(k)),
                Unknown::Normal(k) => out.copy_from_slice(row(blocks[k].row)),
                Unknown::Across(k, g) => {
                    let group = group(blocks, k, g);
                    let ([d0, d1], one, two) = (group.direction, row(group.row), row(group.row + 1));
                    for (out, (x, y)) in out.iter_mut().zip(one.iter().zip(two)) {
                        *out = if group.is_sliding { d0 * *y } else { d0 * *y - d1 * *x };
                    }
                }
            }
        }
    }

    /// Derivatives of all rates by one unknown.
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
            Unknown::Across(k, g) => turning_rate(group(blocks, k, g), rates),
        }
    }
}

fn group<R>(blocks: &[UnilateralConstraint<R>], k: usize, g: usize) -> &FrictionGroup<R> {
    blocks[k].groups[g].as_ref().expect("it was listed")
}

/// Rate that turns the direction of a group: across it; of one that slides, of its component across the velocity.
fn turning_rate<R: Real>(group: &FrictionGroup<R>, rates: &[R]) -> R {
    if group.is_sliding { group.direction[0] * rates[group.row + 1] } else { across(group, rates) }
}

/// Component across the direction of a group.
fn across<R: Real>(group: &FrictionGroup<R>, x: &[R]) -> R {
    let [d0, d1] = group.direction;
    d0 * x[group.row + 1] - d1 * x[group.row]
}

/// Multipliers that an unknown moves.
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
            for group in blocks[k].groups.iter().flatten().filter(|g| g.mode == ContactMode::Slip) {
                for i in 0..group.dim {
                    add(group.row + i, R::splat(group.coefficient) * group.direction[i]);
                }
            }
        }
    }
    &terms[..n]
}

/// Makes the multipliers of a constraint consistent with its mode: zero if open, at the friction limit along the
/// direction if slipping, the component across kept if it can turn.
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
        } else if group.mode == ContactMode::Slip {
            let limit = R::splat(group.coefficient) * lambda[block.row];
            let turned = if group.compliance.is_some() { across(group, lambda) } else { R::zero() };
            let [d0, d1] = group.direction;
            lambda[group.row] = limit * d0 - turned * d1;
            if group.dim == 2 {
                lambda[group.row + 1] = limit * d1 + turned * d0;
            }
        }
    }
}

/// [`ActiveSet::find_rates`], for the best registers of the processor.
struct Rates<'a, 'p, R> {
    rates: &'a mut Vec<R>,
    problem: &'a ContactProblem<'p, R>,
    lambda: &'a [R],
}

impl<R: Real> Task for Rates<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rates, problem, lambda } = self;
        rates.clear();
        rates.extend_from_slice(problem.b);
        // G is symmetric: its columns are its rows
        for (i, x) in lambda.iter().enumerate().filter(|(_, x)| **x != R::zero()) {
            for (rate, a) in rates.iter_mut().zip(problem.row(i)) {
                *rate += *a * *x;
            }
        }
    }
}

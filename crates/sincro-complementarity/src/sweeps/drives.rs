//! Forces of the limited drives of an island under given contact forces, by principal pivoting.
//!
//! Sweeps end at a residual relative to the largest force of an island. That of a blow may be 10⁵ times the limit of a
//! weak drive, whose mode would then be rounding. Under given forces of contacts and joint limits, the drives of a
//! mechanism and the loop joints and gears beside them are a small problem with bounds of its own,
//!
//! w = A λ + c, |λᵢ| ≤ Lᵢ, wᵢ = 0 inside the bounds, wᵢ ≤ 0 at +Lᵢ, wᵢ ≥ 0 at −Lᵢ,
//!
//! with L = ∞ for bilateral rows. It is solved to rounding wherever sweeps would end, and their residual is that of the
//! contacts beside these drives: sweeps go on where it is too large. Drives and loops may be redundant (a four-bar with
//! friction in all its joints), so that A is singular: each pass solves A + ε with the forces of the last one as its
//! centre, a proximal-point method. Principal pivoting changes all infeasible rows while that helps, then only the last
//! one, which ends for every positive definite matrix. Sources: keys `judice1994`, `murty1974` (pivoting),
//! `acary2008` (section 12.4, augmented Lagrangian).

use core::ops::Range;

use super::disjoint_sets::DisjointSets;
use super::{Law, Local, Sweeper};

/// ε, relative to the diagonal of the matrix.
const PROXIMAL: f64 = 1e-9;

/// Rate that is left, relative to the terms that it is the sum of.
const TOLERANCE: f64 = 1e-13;

/// Rates and forces beyond their bounds by less than this, relative to the terms that they are the sum of, are within.
const ROUNDING: f64 = 1e-12;

/// Limit of passes.
const MAX_PASSES: usize = 8;

/// Changes of all infeasible rows without progress before single ones.
const BLOCK_CHANGES: usize = 3;

/// Drives and bilateral rows of an island, by group; grows to the largest island it has seen.
#[derive(Clone, Debug, Default)]
pub(super) struct Drives {
    /// Index of the block of each row, group by group.
    blocks: Vec<usize>,
    groups: Vec<Group>,
    /// Matrices of all groups.
    a: Vec<f64>,
    /// Velocities of the island that rows couple.
    velocities: DisjointSets,
    /// One row, by place in z.
    row: Vec<f64>,
    problem: BoundedProblem,
}

/// Rows of drives and loops that act on each other.
#[derive(Clone, Debug)]
struct Group {
    /// Velocity that stands for it.
    root: u32,
    /// Rows in the list of all.
    rows: Range<usize>,
    /// First number of its matrix.
    a: usize,
    has_drive: bool,
}

impl Drives {
    /// Takes the drives of an island with these blocks and velocities, and the bilateral rows beside them, or with
    /// `all` every bilateral row.
    pub fn collect(&mut self, sweeper: &Sweeper, blocks: Range<usize>, z: Range<usize>, all: bool) {
        self.blocks.clear();
        self.groups.clear();
        self.a.clear();
        let is_wanted = |law: Law| matches!(law, Law::Interval { .. }) || (all && law == Law::Bilateral);
        if !sweeper.blocks[blocks.clone()].iter().any(|block| is_wanted(block.law)) {
            return;
        }
        self.velocities.clear();
        self.velocities.extend_to(z.len());
        let rows = |blocks: Range<usize>| {
            blocks.filter(|k| {
                let block = &sweeper.blocks[*k];
                let is_row = matches!(block.law, Law::Interval { .. } | Law::Bilateral);
                is_row && matches!(block.local, Local::Scalar { .. })
            })
        };
        // rows of odd length end with the place of no velocity, in front of all others
        let places = |k: usize| sweeper.first_row(k).filter_map(|(i, _)| i.checked_sub(z.start));
        for k in rows(blocks.clone()) {
            let mut places = places(k);
            let Some(first) = places.next() else { continue };
            places.for_each(|place| self.velocities.join(first as u32, place as u32));
        }
        for k in rows(blocks.clone()) {
            let Some(place) = places(k).next() else { continue };
            let root = self.velocities.root(place as u32);
            let is_drive = matches!(sweeper.blocks[k].law, Law::Interval { .. });
            match self.groups.iter_mut().find(|group| group.root == root) {
                Some(known) => known.has_drive |= is_drive,
                None => self.groups.push(Group { root, rows: 0..0, a: 0, has_drive: is_drive }),
            }
        }
        self.groups.retain(|group| all || group.has_drive);
        for m in 0..self.groups.len() {
            let (first, root) = (self.blocks.len(), self.groups[m].root);
            for k in rows(blocks.clone()) {
                if places(k).next().is_some_and(|place| self.velocities.root(place as u32) == root) {
                    self.blocks.push(k);
                }
            }
            let a = self.a.len();
            let of_group = &self.blocks[first..];
            self.row.clear();
            self.row.resize(z.end, 0.0);
            for i in of_group {
                sweeper.first_row(*i).for_each(|(place, y)| self.row[place] = y);
                let entry = |j: &usize| sweeper.first_row(*j).map(|(place, y)| y * self.row[place]).sum::<f64>();
                self.a.extend(of_group.iter().map(entry));
                sweeper.first_row(*i).for_each(|(place, _)| self.row[place] = 0.0);
            }
            let group = &mut self.groups[m];
            (group.rows, group.a) = (first..self.blocks.len(), a);
        }
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// Solves the problems of all drives under the present forces of contacts.
    pub fn settle(&mut self, sweeper: &mut Sweeper) {
        let Self { blocks, groups, a, problem, .. } = self;
        for group in &*groups {
            let blocks = &blocks[group.rows.clone()];
            problem.clear();
            for k in blocks {
                let limit = match sweeper.blocks[*k].law {
                    Law::Interval { limit } => limit,
                    _ => f64::INFINITY,
                };
                problem.add(sweeper.rates_of_others(*k)[0], sweeper.lambda[*k][0], limit);
            }
            if !problem.solve(&a[group.a..]) {
                continue;
            }
            for (k, force) in blocks.iter().zip(&problem.x) {
                let change = force - sweeper.lambda[*k][0];
                if change != 0.0 {
                    // the velocities along a row are those of its rate last taken
                    sweeper.rates_of_others(*k);
                    sweeper.lambda[*k][0] = *force;
                    sweeper.change_others(*k, [change, 0.0, 0.0]);
                }
            }
        }
    }
}

/// Problem with bounds of one group.
#[derive(Clone, Debug, Default)]
struct BoundedProblem {
    /// Rates at the forces `centre`, then c.
    c: Vec<f64>,
    centre: Vec<f64>,
    limit: Vec<f64>,
    /// Solution.
    x: Vec<f64>,
    /// ±1 at a bound, 0 within.
    mode: Vec<f64>,
    is_infeasible: Vec<bool>,
    /// Rows within their bounds, and the factor of their matrix by rows, with the inverse diagonal.
    inner: Vec<usize>,
    factor: Vec<f64>,
    y: Vec<f64>,
}

impl BoundedProblem {
    fn clear(&mut self) {
        [&mut self.c, &mut self.centre, &mut self.limit].into_iter().for_each(Vec::clear);
    }

    /// Adds a row with its rate and force, and the limit of the force.
    fn add(&mut self, rate: f64, force: f64, limit: f64) {
        self.c.push(rate);
        self.centre.push(force);
        self.limit.push(limit);
    }

    /// Solves the problem with the matrix `a`, by rows, from the present forces. Returns false if no solution is found.
    fn solve(&mut self, a: &[f64]) -> bool {
        let n = self.c.len();
        self.x.clone_from(&self.centre);
        self.mode.clear();
        for i in 0..n {
            let free = self.x[i] - self.c[i] / a[i * n + i];
            self.mode.push(if free.abs() < self.limit[i] { 0.0 } else { free.signum() });
        }
        for i in 0..n {
            self.c[i] -= product(&a[i * n..(i + 1) * n], &self.x).0;
        }
        for _ in 0..MAX_PASSES {
            if !self.pivot(a) {
                return false;
            }
            let is_left = |i: &usize| {
                let (rate, size) = self.rate(a, *i);
                rate.abs() > TOLERANCE * size
            };
            if !self.inner.iter().any(is_left) {
                break;
            }
            self.centre.clone_from(&self.x);
        }
        self.x.iter().all(|x| x.is_finite())
    }

    /// Solves the problem of A + ε about the centre. Returns false if pivoting does not end.
    fn pivot(&mut self, a: &[f64]) -> bool {
        let n = self.c.len();
        let (mut fewest, mut left) = (usize::MAX, BLOCK_CHANGES);
        for _ in 0..16 + 16 * n {
            self.solve_modes(a);
            let infeasible = self.mark_infeasible(a);
            if infeasible == 0 {
                return true;
            }
            if infeasible < fewest {
                (fewest, left) = (infeasible, BLOCK_CHANGES);
            } else {
                left = left.saturating_sub(1);
            }
            for i in (0..n).rev().filter(|i| self.is_infeasible[*i]) {
                self.mode[i] = if self.mode[i] == 0.0 { self.x[i].signum() } else { 0.0 };
                if left == 0 {
                    break;
                }
            }
        }
        false
    }

    /// Marks the rows that contradict their modes, and counts them.
    fn mark_infeasible(&mut self, a: &[f64]) -> usize {
        let n = self.c.len();
        self.is_infeasible.clear();
        for i in 0..n {
            let is_infeasible = if self.mode[i] == 0.0 {
                self.x[i].abs() > self.limit[i] * (1.0 + ROUNDING)
            } else {
                let (rate, size) = self.rate(a, i);
                let rate = rate + PROXIMAL * a[i * n + i] * (self.x[i] - self.centre[i]);
                self.limit[i] > 0.0 && rate * self.mode[i] > ROUNDING * size
            };
            self.is_infeasible.push(is_infeasible);
        }
        self.is_infeasible.iter().filter(|is| **is).count()
    }

    /// Rate of a row, and the sum of the sizes of its terms.
    fn rate(&self, a: &[f64], i: usize) -> (f64, f64) {
        let n = self.c.len();
        let (sum, size) = product(&a[i * n..(i + 1) * n], &self.x);
        (self.c[i] + sum, self.c[i].abs() + size)
    }

    /// Forces in the present modes, by Cholesky's method.
    fn solve_modes(&mut self, a: &[f64]) {
        let n = self.c.len();
        let Self { c, centre, limit, x, mode, inner, factor, y, .. } = self;
        inner.clear();
        inner.extend((0..n).filter(|i| mode[*i] == 0.0));
        for i in 0..n {
            x[i] = if mode[i] == 0.0 { 0.0 } else { mode[i] * limit[i] };
        }
        factor.clear();
        y.clear();
        for (r, i) in inner.iter().enumerate() {
            let row = &a[i * n..(i + 1) * n];
            let (shift, start) = (PROXIMAL * row[*i], factor.len());
            for (s, j) in inner[..r].iter().enumerate() {
                let other = &factor[s * (s + 1) / 2..];
                let entry = (row[*j] - product(&factor[start..], &other[..s]).0) * other[s];
                factor.push(entry);
            }
            let this = &factor[start..];
            let inverse = 1.0 / (row[*i] + shift - product(this, this).0).max(0.5 * shift).sqrt();
            y.push((shift * centre[*i] - c[*i] - product(row, x).0 - product(this, y).0) * inverse);
            factor.push(inverse);
        }
        for r in (0..inner.len()).rev() {
            let this = &factor[r * (r + 1) / 2..];
            y[r] *= this[r];
            for s in 0..r {
                y[s] -= this[s] * y[r];
            }
        }
        for (i, y) in inner.iter().zip(y) {
            x[*i] = *y;
        }
    }
}

/// Scalar product, and the sum of the sizes of its terms.
fn product(x: &[f64], y: &[f64]) -> (f64, f64) {
    x.iter().zip(y).fold((0.0, 0.0), |(sum, size), (x, y)| (sum + x * y, size + (x * y).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number in (−1, 1).
    fn number(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Largest violation of the laws of a solution: of rates, relative to the terms of each, and of forces, relative to
    /// the limits.
    fn violation(problem: &BoundedProblem, a: &[f64], c: &[f64]) -> f64 {
        let n = c.len();
        let of_row = |i: usize| {
            let (sum, size) = product(&a[i * n..(i + 1) * n], &problem.x);
            let (rate, x, limit) = ((c[i] + sum) / (c[i].abs() + size), problem.x[i], problem.limit[i]);
            let of_rate = match x {
                x if x.abs() < limit * (1.0 - 1e-9) => rate.abs(),
                x => (rate * x.signum()).max(0.0),
            };
            let beyond = if limit > 0.0 { (x.abs() / limit - 1.0).max(0.0) } else { x.abs() };
            if limit > 0.0 { of_rate.max(beyond) } else { beyond }
        };
        (0..n).map(of_row).fold(0.0, f64::max)
    }

    #[test]
    fn bounded_problems_are_solved_to_rounding_redundant_or_not() {
        let seed = &mut 3;
        let mut at_bounds = [0; 2];
        for draw in 0..2000 {
            let (n, m) = (1 + draw % 9, 1 + draw % 7);
            // fewer velocities than rows make the rows depend on each other
            let y: Vec<f64> = (0..n * m).map(|_| number(seed)).collect();
            let row = |i: usize| &y[i * m..(i + 1) * m];
            let a: Vec<f64> = (0..n * n).map(|k| product(row(k / n), row(k % n)).0).collect();
            // rates that some motion has, as those of a mechanism: consistent where rows depend on each other
            let z: Vec<f64> = (0..m).map(|_| 100.0 * number(seed)).collect();
            let c: Vec<f64> = (0..n).map(|i| product(row(i), &z).0).collect();
            let mut problem = BoundedProblem::default();
            let limits: Vec<f64> =
                (0..n).map(|i| [0.0, f64::INFINITY, 1e-9, 1e-3, 1.0, 30.0, 1e4][(draw / 7 + 3 * i) % 7]).collect();
            let start: Vec<f64> = limits.iter().map(|limit| number(seed).clamp(-limit, *limit)).collect();
            for i in 0..n {
                problem.add(c[i] + product(&a[i * n..(i + 1) * n], &start).0, start[i], limits[i]);
            }
            assert!(problem.solve(&a), "draw {draw}");
            let violation = violation(&problem, &a, &c);
            assert!(violation < 1e-11, "draw {draw}: {violation:e}");
            for mode in &problem.mode {
                at_bounds[usize::from(*mode != 0.0)] += 1;
            }
        }
        assert!(at_bounds[0] > 2000 && at_bounds[1] > 2000, "{at_bounds:?}");
    }
}

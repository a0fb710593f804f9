//! Semismooth Newton step of an island whose sweeps converge slowly: bodies that share their load over many points.
//!
//! In the mode that the sweeps have brought it to, each law is linear: an open contact has no force, one that sticks
//! has the force λ − ρ w with its rates w and a large ρ, which says w = 0 up to 1/ρ (an augmented Lagrangian), and one
//! that slides so in its normal direction, with friction at its limit, against the sliding rate. With f the forces at
//! the present rates, D what they lose by a growth of the rates, and λ eliminated, the whitened velocities z = Σ yᵢ λᵢ
//! obey
//!
//! (1 + Σ Yᵀ D Y) Δz = Σ Yᵀ f − z,
//!
//! one symmetric positive definite system of the size of the bodies, however redundant their contacts are: forces that
//! move nothing stay as they are. It is factored by Cholesky's method within its envelope. That friction follows the
//! normal force is left out of the matrix, which stays symmetric, and done afterwards. The forces are projected on
//! their laws, and sweeps follow each step, which find the next modes. Sources: keys `alart1991`, `acary2008`
//! (section 13.4).

use core::ops::Range;

use sincro_math::{LaneVisitor, Real};

use super::body_rows::{Bodies, BodyRows};
use super::local::product;
use super::{Law, Sweeper, minus};

/// ρ, in units of that of the natural map.
const RHO: f64 = 1e4;

/// Size of a matrix beyond which an island is left to its sweeps: 32 MiB, and seconds for a thousand steps.
const MAX_NUMBERS: usize = 1 << 22;

/// Working memory of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct NewtonStep {
    /// First column of each row of the matrix, the one behind its last, and place of the first entry. Rows end with the
    /// diagonal, or with the last velocity of their body, and numbers beyond the diagonal are not used.
    first: Vec<usize>,
    end: Vec<usize>,
    row: Vec<usize>,
    matrix: Vec<f64>,
    /// Right-hand side, then the change of the velocities.
    x: Vec<f64>,
    laws: Vec<LinearLaw>,
}

/// Law of a block in its present mode.
#[derive(Clone, Copy, Debug)]
struct LinearLaw {
    /// Force at the present rates.
    force: [f64; 3],
    /// Symmetric matrix D: entries 00, 01, 02, 11, 12, 22.
    slope: [f64; 6],
    /// Friction coefficient of a contact that slides, else 0.
    friction: f64,
}

impl NewtonStep {
    /// Prepares a step from the present forces of the `blocks` of an island, with the velocities `z`.
    pub fn prepare<'a>(
        &'a mut self,
        sweeper: &'a mut Sweeper,
        blocks: Range<usize>,
        z: Range<usize>,
    ) -> IslandStep<'a> {
        IslandStep { step: self, sweeper, blocks, z }
    }

    /// Envelope of the matrix: a row begins with the first velocity that one of its blocks moves. Returns false if it
    /// has too many numbers.
    fn lay_out(&mut self, sweeper: &Sweeper, blocks: Range<usize>, z: Range<usize>) -> bool {
        self.first.clear();
        self.first.extend(0..z.len());
        self.end.clear();
        self.end.extend(1..=z.len());
        for block in &sweeper.blocks[blocks] {
            match block.bodies {
                Bodies::One(one) => self.lay_out_body(one - z.start, one - z.start),
                Bodies::Two(one, two) => {
                    let least = one.min(two) - z.start;
                    self.lay_out_body(one - z.start, least);
                    self.lay_out_body(two - z.start, least);
                }
                Bodies::Other => {
                    let index = &sweeper.index[block.index..block.index + block.len];
                    let places = || index.iter().filter_map(|i| (*i as usize).checked_sub(z.start));
                    let least = places().min().unwrap_or(0);
                    places().for_each(|i| self.first[i] = self.first[i].min(least));
                }
            }
        }
        self.row.clear();
        let mut length = 0;
        for (end, first) in self.end.iter().zip(&self.first) {
            self.row.push(length);
            length += end - first;
        }
        if length > MAX_NUMBERS {
            return false;
        }
        self.matrix.clear();
        self.matrix.resize(length, 0.0);
        for (i, first) in self.first.iter().enumerate() {
            self.matrix[self.row[i] + i - first] = 1.0;
        }
        true
    }

    /// Lets the rows of six velocities begin at `least` or before, and end with the last of them or behind: those of
    /// two contacts of a robot may overlap.
    fn lay_out_body(&mut self, at: usize, least: usize) {
        self.first[at..at + 6].iter_mut().for_each(|first| *first = least.min(*first));
        self.end[at..at + 6].iter_mut().for_each(|end| *end = (at + 6).max(*end));
    }

    /// Adds a block to matrix and right-hand side.
    #[inline(always)]
    fn add<V: Real>(&mut self, sweeper: &Sweeper, k: usize, start: usize, law: &LinearLaw) {
        let block = &sweeper.blocks[k];
        let rows = &sweeper.rows[block.rows..];
        match block.bodies {
            Bodies::One(one) => self.add_bodies::<V, 1>(&BodyRows::first_of(rows, [one - start]), law),
            Bodies::Two(one, two) => {
                self.add_bodies::<V, 2>(&BodyRows::first_of(rows, [one - start, two - start]), law);
            }
            Bodies::Other => self.add_others(sweeper, k, start, law),
        }
    }

    /// The same for a contact of free bodies.
    #[inline(always)]
    fn add_bodies<V: Real, const N: usize>(&mut self, rows: &BodyRows<'_, N>, law: &LinearLaw) {
        rows.add_to::<V>(law.force, &mut self.x);
        if law.slope == [0.0; 6] {
            return;
        }
        let [a, b, c, d, e, f] = law.slope;
        let slope = [
            [V::splat(a), V::splat(b), V::splat(c)],
            [V::splat(b), V::splat(d), V::splat(e)],
            [V::splat(c), V::splat(e), V::splat(f)],
        ];
        // rows of D Y, packed
        let mut pushed = [[V::zero(); 3]; 3];
        for i in 0..=N {
            for c in 0..3 {
                pushed[i][c] = rows.part(i, slope[c]);
            }
        }
        for s in 0..N {
            for r in 0..6 {
                let (i, column) = (rows.at[s] + r, rows.columns[6 * s + r]);
                let column = [V::splat(column[0]), V::splat(column[1]), V::splat(column[2])];
                let mut last = [0.0; 4];
                combined(pushed[N], column).to_row(&mut last);
                for t in 0..N {
                    if rows.at[t] <= rows.at[s] {
                        let from = self.row[i] + rows.at[t] - self.first[i];
                        let entries = &mut self.matrix[from..from + 6];
                        (V::from_row(entries) + combined(pushed[t], column)).to_row(entries);
                        entries[4] += last[2 * t];
                        entries[5] += last[2 * t + 1];
                    }
                }
            }
        }
    }

    /// The same for any rows.
    fn add_others(&mut self, sweeper: &Sweeper, k: usize, start: usize, law: &LinearLaw) {
        let block = &sweeper.blocks[k];
        let (len, n) = (block.len, block.n);
        let y = &sweeper.values[block.values..block.values + n * len];
        let index = &sweeper.index[block.index..block.index + len];
        for (a, i) in index.iter().enumerate() {
            let Some(i) = (*i as usize).checked_sub(start) else { continue };
            let column = core::array::from_fn(|c| if c < n { y[c * len + a] } else { 0.0 });
            for c in 0..n {
                self.x[i] += column[c] * law.force[c];
            }
            if law.slope == [0.0; 6] {
                continue;
            }
            let pushed = product(&law.slope, column);
            let row = &mut self.matrix[self.row[i]..=self.row[i] + i - self.first[i]];
            for (b, j) in index.iter().enumerate() {
                let Some(j) = (*j as usize).checked_sub(start).filter(|j| *j <= i) else { continue };
                let entry = &mut row[j - self.first[i]];
                for c in 0..n {
                    *entry += pushed[c] * y[c * len + b];
                }
            }
        }
    }

    /// Lays out the matrix 1 + Yᵀ D Y of an island, with D `scale` times the step lengths of the blocks, and factors
    /// it. Returns false if it has too many numbers.
    #[inline(always)]
    pub fn factor_scaled<V: Real>(
        &mut self,
        sweeper: &Sweeper,
        blocks: Range<usize>,
        z: Range<usize>,
        scale: f64,
    ) -> bool {
        if !self.lay_out(sweeper, blocks.clone(), z.clone()) {
            return false;
        }
        self.x.clear();
        self.x.resize(z.len(), 0.0);
        for k in blocks {
            let d = scale * sweeper.blocks[k].step_length();
            let law = LinearLaw { force: [0.0; 3], slope: [d, 0.0, 0.0, d, 0.0, d], friction: 0.0 };
            self.add::<V>(sweeper, k, z.start, &law);
        }
        self.factor::<V>();
        true
    }

    /// Clears the right-hand side.
    pub fn clear_right_hand_side(&mut self) {
        self.x.fill(0.0);
    }

    /// Adds Yᵀ f of a block to the right-hand side.
    #[inline(always)]
    pub fn push<V: Real>(&mut self, sweeper: &Sweeper, k: usize, start: usize, f: [f64; 3]) {
        self.add::<V>(sweeper, k, start, &LinearLaw { force: f, slope: [0.0; 6], friction: 0.0 });
    }

    /// Factors the matrix.
    #[inline(always)]
    fn factor<V: Real>(&mut self) {
        let Self { first, row, matrix, .. } = self;
        for i in 0..first.len() {
            let (done, this) = matrix.split_at_mut(row[i]);
            let this = &mut this[..=i - first[i]];
            for j in first[i]..i {
                let from = if first[i] > first[j] { first[i] } else { first[j] };
                let other = &done[row[j]..=row[j] + j - first[j]];
                let sum = long_dot::<V>(&this[from - first[i]..j - first[i]], &other[from - first[j]..j - first[j]]);
                this[j - first[i]] = (this[j - first[i]] - sum) * other[j - first[j]];
            }
            let (left, diagonal) = this.split_at_mut(i - first[i]);
            // the inverse of the root stands on the diagonal; the matrix is at least the unit matrix
            let square = diagonal[0] - long_dot::<V>(left, left);
            diagonal[0] = 1.0 / (if square > 1.0 { square } else { 1.0 }).sqrt();
        }
    }

    /// Solves for the change of the velocities, from the right-hand side and the factored matrix.
    #[inline(always)]
    pub fn substitute<V: Real>(&mut self) {
        let Self { first, row, matrix, x, .. } = self;
        for i in 0..first.len() {
            let this = &matrix[row[i]..=row[i] + i - first[i]];
            let (left, diagonal) = this.split_at(i - first[i]);
            x[i] = (x[i] - long_dot::<V>(left, &x[first[i]..i])) * diagonal[0];
        }
        for i in (0..first.len()).rev() {
            let this = &matrix[row[i]..=row[i] + i - first[i]];
            let (left, diagonal) = this.split_at(i - first[i]);
            let (before, rest) = x.split_at_mut(i);
            rest[0] *= diagonal[0];
            subtract::<V>(&mut before[first[i]..], left, rest[0]);
        }
    }

    /// Growth of the rates of a block with the change of the velocities.
    #[inline(always)]
    pub fn growth<V: Real>(&self, sweeper: &Sweeper, k: usize, start: usize) -> [f64; 3] {
        let block = &sweeper.blocks[k];
        let rows = &sweeper.rows[block.rows..];
        match block.bodies {
            Bodies::One(one) => BodyRows::first_of(rows, [one - start]).rates::<V>(&[0.0; 4], &self.x),
            Bodies::Two(one, two) => {
                BodyRows::first_of(rows, [one - start, two - start]).rates::<V>(&[0.0; 4], &self.x)
            }
            Bodies::Other => self.growth_of_others(sweeper, k, start),
        }
    }

    fn growth_of_others(&self, sweeper: &Sweeper, k: usize, start: usize) -> [f64; 3] {
        let block = &sweeper.blocks[k];
        let mut growth = [0.0; 3];
        let rows = sweeper.values[block.values..].chunks_exact(block.len.max(1));
        for (growth, y) in growth.iter_mut().zip(rows).take(block.n) {
            for (y, i) in y.iter().zip(&sweeper.index[block.index..]) {
                if let Some(i) = (*i as usize).checked_sub(start) {
                    *growth += y * self.x[i];
                }
            }
        }
        growth
    }
}

/// A step on an island: changes its forces, and the velocities, which follow them; those of an island of hundreds of
/// bodies stay.
pub(super) struct IslandStep<'a> {
    step: &'a mut NewtonStep,
    sweeper: &'a mut Sweeper,
    blocks: Range<usize>,
    z: Range<usize>,
}

impl LaneVisitor for IslandStep<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<V: Real>(self) {
        let Self { step, sweeper, blocks, z } = self;
        if !step.lay_out(sweeper, blocks.clone(), z.clone()) {
            return;
        }
        step.x.clear();
        step.x.extend_from_slice(&sweeper.z[z.clone()]);
        for x in &mut step.x {
            *x = -*x;
        }
        step.laws.clear();
        for k in blocks.clone() {
            let u = sweeper.rates::<V>(k);
            let law = LinearLaw::of(sweeper, k, u);
            step.add::<V>(sweeper, k, z.start, &law);
            step.laws.push(law);
        }
        step.factor::<V>();
        step.substitute::<V>();
        for k in blocks.clone() {
            let growth = step.growth::<V>(sweeper, k, z.start);
            let LinearLaw { force, slope, friction } = &step.laws[k - blocks.start];
            let lost = product(slope, growth);
            let mut moved = minus(*force, lost);
            if *friction > 0.0 {
                let (old, limit) = (length(force[1], force[2]), if moved[0] > 0.0 { friction * moved[0] } else { 0.0 });
                let share = if old > 0.0 { limit / old } else { 0.0 };
                (moved[1], moved[2]) = (force[1] * share - lost[1], force[2] * share - lost[2]);
            }
            let admitted = sweeper.admitted(k, moved).0;
            sweeper.rates::<V>(k);
            sweeper.change::<V>(k, admitted);
        }
    }
}

impl LinearLaw {
    /// Law of block `k` at its rates `u`.
    #[inline(always)]
    fn of(sweeper: &Sweeper, k: usize, u: [f64; 3]) -> Self {
        let block = &sweeper.blocks[k];
        let rho = RHO * block.step_length();
        let (force, slope) = sweeper.projected(k, u);
        let held = minus(sweeper.lambda[k], [rho * u[0], rho * u[1], rho * u[2]]);
        if slope == [0.0; 6] {
            return Self { force, slope, friction: 0.0 };
        }
        if slope[0] == 1.0 && (block.n == 1 || slope[3] == 1.0) {
            // at rest in all its directions; those it does not have are zero
            return Self { force: held, slope: [rho, 0.0, 0.0, rho, 0.0, rho], friction: 0.0 };
        }
        let Law::Coulomb { friction } = block.law else {
            // rolling and spinning friction at its limit
            return Self { force, slope: slope.map(|x| x * block.step_length()), friction: 0.0 };
        };
        let (size, sliding) = (length(force[1], force[2]), length(u[1], u[2]));
        let (t1, t2) = if size > 0.0 { (force[1] / size, force[2] / size) } else { (0.0, 0.0) };
        let limit = friction * sweeper.lambda[k][0];
        // across the sliding direction friction turns with it
        let turn = if sliding > 0.0 { (limit / sliding).min(rho) } else { rho };
        let slope = [rho, 0.0, 0.0, turn * t2 * t2, -turn * t1 * t2, turn * t1 * t1];
        Self { force: [held[0], limit * t1, limit * t2], slope, friction }
    }
}

/// Length of a vector in a plane; the standard library's function may have other bits elsewhere.
#[inline(always)]
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Combination of three rows.
#[inline(always)]
fn combined<V: Real>(rows: [V; 3], by: [V; 3]) -> V {
    (rows[0] * by[0] + rows[1] * by[1]) + rows[2] * by[2]
}

/// Scalar product of two lists, in four lanes and a rest.
#[inline(always)]
fn long_dot<V: Real>(x: &[f64], y: &[f64]) -> f64 {
    let (n, mut k) = (x.len(), 0);
    let y = &y[..n];
    let mut sums = V::zero();
    while k + 4 <= n {
        sums += V::from_row(&x[k..k + 4]) * V::from_row(&y[k..k + 4]);
        k += 4;
    }
    let mut lanes = [0.0; 4];
    sums.to_row(&mut lanes);
    let mut rest = 0.0;
    while k < n {
        rest += x[k] * y[k];
        k += 1;
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + rest
}

/// Subtracts `y`, times `by`, from `x`.
#[inline(always)]
fn subtract<V: Real>(x: &mut [f64], y: &[f64], by: f64) {
    let (n, mut k) = (y.len(), 0);
    let (x, factor) = (&mut x[..n], V::splat(by));
    while k + 4 <= n {
        (V::from_row(&x[k..k + 4]) - V::from_row(&y[k..k + 4]) * factor).to_row(&mut x[k..k + 4]);
        k += 4;
    }
    while k < n {
        x[k] -= y[k] * by;
        k += 1;
    }
}

#[cfg(test)]
mod tests {
    use sincro_math::{LaneVisitor, Lanes, Real, lanes};

    use super::super::{GivenForces, Island, Law, Stillness, Sweeper, Sweeps, TOLERANCE};
    use super::{Bodies, NewtonStep};
    use crate::solver::SolverReport;

    /// Number in (−1, 1).
    fn number(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Two plates on each other and on a floor, each on `points` points at random, with their weight and pushed.
    fn plates(points: usize, seed: u64) -> Sweeper {
        let (mut sweeper, mut seed) = (Sweeper::default(), seed);
        sweeper.clear(12);
        let push: Vec<f64> = (0..12).map(|_| 2.0 * number(&mut seed)).collect();
        for k in 0..2 * points {
            let (x, y) = (number(&mut seed), number(&mut seed));
            let upper = k >= points;
            // angular, then linear; mass 1 kg, inertia 1/3 kg·m²
            let own = |a: [f64; 3], l: [f64; 3]| [a[0], a[1], a[2], l[0], l[1], l[2]];
            let turn = 3.0_f64.sqrt();
            let rows = [
                own([turn * y, -turn * x, 0.0], [0.0, 0.0, 1.0]),
                own([0.0, 0.0, -turn * y], [1.0, 0.0, 0.0]),
                own([0.0, 0.0, turn * x], [0.0, 1.0, 0.0]),
            ];
            let dofs: Vec<u32> = if upper { (0..12).collect() } else { (0..6).collect() };
            let mut values = Vec::new();
            let mut b = [0.0; 3];
            for (row, b) in rows.iter().zip(&mut b) {
                // the lower plate is the second body of the upper contacts
                let mut whole: Vec<f64> = if upper { row.iter().map(|x| -x).collect() } else { row.to_vec() };
                whole.extend(if upper { row.to_vec() } else { Vec::new() });
                *b = whole.iter().zip(&push).map(|(y, f)| y * f).sum();
                values.extend(whole);
            }
            b[0] -= if upper { 0.0 } else { 9.81 };
            sweeper.add(Law::Coulomb { friction: 0.5 }, 3 * k, 3, &dofs, &values, b, [0.0; 3]);
        }
        sweeper.end_island(Stillness::CanRest);
        sweeper
    }

    #[test]
    fn redundant_points_share_a_load_within_the_tolerance() {
        for seed in 1..200 {
            let mut sweeper = plates(20, seed);
            let mut report = SolverReport::default();
            sweeper.solve(0.01, GivenForces::Start, &mut report);
            assert_eq!(report.unconverged_islands, 0, "seed {seed}: {report:?}");
            assert!(report.worst_island <= TOLERANCE, "seed {seed}: {report:?}");
        }
    }

    #[test]
    fn splitting_alone_finds_how_points_share_a_load() {
        for seed in 1..200 {
            let mut sweeper = plates(20, seed);
            sweeper.resize_buffers();
            let (blocks, z) = (0..40, 1..13);
            let mut island = Island { sweeper: &mut sweeper, blocks, z, rest_rate: 0.0, stillness: Stillness::CanRest };
            island.keep();
            let residual = island.split(&mut NewtonStep::default(), f64::INFINITY);
            assert!(residual <= TOLERANCE, "seed {seed}: {residual:e}");
            assert_eq!(residual.to_bits(), {
                island.find_velocities();
                island.residual().to_bits()
            });
        }
    }

    #[test]
    fn a_newton_step_follows_a_changed_load_better_than_sweeps() {
        let mut better = 0;
        for seed in 1..200 {
            let mut solved = plates(20, seed);
            solved.solve(0.01, GivenForces::Start, &mut SolverReport::default());
            for block in &mut solved.blocks {
                // the same modes, other forces
                block.b.iter_mut().for_each(|b| *b *= 1.01);
            }
            let residual = |with_step: bool| {
                let (mut sweeper, blocks, z) = (solved.clone(), 0..40, 1..13);
                if with_step {
                    let mut newton = NewtonStep::default();
                    lanes::dispatch_four_lanes(newton.prepare(&mut sweeper, blocks.clone(), z.clone()));
                }
                Island { sweeper: &mut sweeper, blocks, z, rest_rate: 0.0, stillness: Stillness::Awake }
                    .sweep(4)
                    .residual
            };
            better += u32::from(residual(true) < 0.5 * residual(false));
        }
        assert!(better > 120, "{better} of 199");
    }

    #[test]
    fn a_problem_that_is_posed_again_has_the_same_solution() {
        let forces = |sweeper: &Sweeper| {
            let mut forces = Vec::new();
            sweeper.read(|_, force| forces.push(force.to_bits()));
            forces
        };
        let (mut sweeper, mut once) = (plates(8, 3), SolverReport::default());
        sweeper.solve(0.01, GivenForces::Start, &mut once);
        let first = forces(&sweeper);
        let start = plates(8, 3);
        sweeper.blocks.clone_from(&start.blocks);
        sweeper.lambda.clone_from(&start.lambda);
        let mut twice = once;
        sweeper.solve(0.01, GivenForces::Start, &mut twice);
        assert_eq!(forces(&sweeper), first);
        assert_eq!((twice.islands, twice.sweeps), (2 * once.islands, 2 * once.sweeps));
        // another one is solved anew
        (sweeper.blocks, sweeper.lambda) = (start.blocks, start.lambda);
        sweeper.blocks[0].b[0] -= 1.0;
        sweeper.solve(0.01, GivenForces::Start, &mut once);
        assert_ne!(forces(&sweeper), first);
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_projections() {
        let mut seed = 5;
        let mut sweeper = plates(1, 1);
        sweeper.clear(12);
        let dofs: Vec<u32> = (0..6).collect();
        let laws = [
            (Law::Coulomb { friction: 0.7 }, 3),
            (Law::Unilateral, 1),
            (Law::Interval { limit: 0.4 }, 1),
            (Law::Disc { coefficient: 0.3, normal: 0 }, 2),
            (Law::Bilateral, 1),
        ];
        for (law, n) in laws {
            let values: Vec<f64> = (0..6 * n).map(|_| number(&mut seed)).collect();
            sweeper.add(law, 0, n, &dofs, &values, [0.0; 3], [1.0, 0.0, 0.0]);
        }
        for _ in 0..1000 {
            let x: [f64; 3] = core::array::from_fn(|_| 2.0 * number(&mut seed));
            let d: [f64; 3] = core::array::from_fn(|_| 1e-6 * number(&mut seed));
            for (k, (law, n)) in laws.iter().enumerate() {
                let moved = |sign: f64| sweeper.admitted(k, core::array::from_fn(|c| x[c] + sign * d[c])).0;
                let (plus, minus) = (moved(1.0), moved(-1.0));
                let wanted = crate::sweeps::local::product(&sweeper.admitted(k, x).1, d);
                for c in 0..*n {
                    let found = 0.5 * (plus[c] - minus[c]);
                    // but where it has a kink within the difference
                    let kink = (plus[c] + minus[c] - 2.0 * sweeper.admitted(k, x).0[c]).abs() > 1e-10;
                    assert!(kink || (found - wanted[c]).abs() < 1e-10, "{law:?}: {found:e} for {:e}", wanted[c]);
                }
            }
        }
    }

    #[test]
    fn a_step_and_sweeps_have_the_same_bits_on_every_processor() {
        struct Both<'a>(&'a mut Sweeper);
        impl LaneVisitor for Both<'_> {
            type Output = Vec<u64>;
            #[inline(always)]
            fn visit<V: Real>(self) -> Vec<u64> {
                // not a multiple of four numbers
                let (blocks, z) = (0..39, 1..13);
                NewtonStep::default().prepare(self.0, blocks.clone(), z.clone()).visit::<V>();
                let mut island = Island { sweeper: self.0, blocks, z, rest_rate: 0.0, stillness: Stillness::Awake };
                Sweeps { island: &mut island, most: 6 }.visit::<V>();
                let numbers = self.0.lambda.as_flattened().iter().chain(&self.0.z);
                numbers.map(|x| x.to_bits()).collect()
            }
        }
        for seed in 1..50 {
            let mut solved = plates(20, seed);
            solved.solve(0.01, GivenForces::Start, &mut SolverReport::default());
            for block in &mut solved.blocks {
                block.b.iter_mut().for_each(|b| *b *= 1.1);
            }
            let baseline = Both(&mut solved.clone()).visit::<Lanes<4>>();
            assert_eq!(lanes::dispatch_four_lanes(Both(&mut solved.clone())), baseline, "seed {seed}");
        }
    }

    #[test]
    fn runs_of_velocities_that_overlap_have_the_same_step_as_any_others() {
        let mut seed = 3;
        for _ in 0..50 {
            let mut sweeper = Sweeper::default();
            sweeper.clear(14);
            // runs of six velocities that overlap without being the same
            for dofs in [0..12, 3..9, 2..8, 8..14] {
                let dofs: Vec<u32> = dofs.collect();
                let values: Vec<f64> = (0..3 * dofs.len()).map(|_| number(&mut seed)).collect();
                let b = [-1.0 - number(&mut seed), number(&mut seed), number(&mut seed)];
                sweeper.add(Law::Coulomb { friction: 0.5 }, 0, 3, &dofs, &values, b, [0.1, 0.0, 0.0]);
            }
            sweeper.end_island(Stillness::Awake);
            assert!(sweeper.blocks.iter().all(|block| block.bodies != Bodies::Other));
            let mut others = sweeper.clone();
            others.blocks.iter_mut().for_each(|block| block.bodies = Bodies::Other);
            let forces = [&mut sweeper, &mut others].map(|sweeper| {
                sweeper.resize_buffers();
                lanes::dispatch_four_lanes(NewtonStep::default().prepare(sweeper, 0..4, 1..15));
                sweeper.lambda.as_flattened().to_vec()
            });
            for (one, other) in forces[0].iter().zip(&forces[1]) {
                assert!((one - other).abs() <= 1e-6 * (1.0 + other.abs()), "{forces:?}");
            }
        }
    }
}

//! Share of the load among redundant constraints.
//!
//! Where rows depend on each other, multipliers without effect on their rates may be added to any solution. The one
//! taken is the limit of equally stiff constraints as their stiffness grows: with a compliance ε gᵢ of each row, gᵢ the
//! diagonal of the Delassus matrix (its mean over the rows of a friction group; of a compliant contact over its share
//! of the largest normal force, since friction is as stiff as its load), the rates ε gᵢ λᵢ must be compatible
//! with a motion of the bodies, yᵀ g λ = 0 for every combination y of rows that vanishes. Where no contact slips that
//! is the least Σ gᵢ λᵢ². It depends on the state alone: not on the history, the frame, the order of bodies, or the
//! units of lengths and masses, and it does not jump where a contact begins to slip. Where contacts slide, the share
//! decides about the motion.
//!
//! **Friction at its limit.** A sticking contact whose share is beyond its friction creeps within the compliances of
//! the others. Where its creep relieves nothing (it alone holds the body, and what slides beside it presses on it), the
//! load shifts instead: of all shares with friction at its limit, the one taken is nearest to that of equal stiffness,
//! by Σ gᵢ Δλᵢ². So friction that some share can keep within its limit does not slip.

use sincro_math::{Real, Task};

use super::active_set::{ActiveSet, ContactProblem};
use super::cone::{ContactMode, UnilateralConstraint};
use super::dense::{Dense, RANK};
use super::solver::{norm, pair};

/// Least stiffness of friction under a given load, relative to that under the largest.
const LEAST_STIFFNESS: f64 = 1e-6;

/// Maximum number of updates of the friction that creeps.
const MAX_CREEPING: usize = 12;

/// Maximum number of shifts of the load: directions of friction at its limit change with each.
const MAX_SHIFTS: usize = 60;

/// Number of shifts in a row that may come no nearer, by half, to friction within its limits: what converges within
/// [`MAX_SHIFTS`] comes nearer.
const PATIENCE: usize = 8;

/// Square of the effect of shares on friction at its limit, relative to that of their terms, that is none.
const NO_EFFECT: f64 = 1e-20;

/// Excess of friction over its limit, relative to the largest force, above which it creeps.
const CREEPS: f64 = 1e-10;

/// Sticking friction at its limit whose rows are redundant: its contact creeps within the compliances of the others,
/// and does not slip.
#[derive(Clone, Copy, Debug)]
struct Creeping<R> {
    row: usize,
    dim: usize,
    normal: usize,
    coefficient: f64,
    /// Direction of its force.
    direction: [R; 2],
}

impl<R: Real> Creeping<R> {
    /// Force along the direction beyond the limit, by the multiplier of each row.
    fn beyond(&self, lambda: impl Fn(usize) -> R) -> R {
        let mut sum = -self.limit(&lambda);
        for k in 0..self.dim {
            sum += self.direction[k] * lambda(self.row + k);
        }
        sum
    }

    fn limit(&self, lambda: impl Fn(usize) -> R) -> R {
        lambda(self.normal) * R::splat(self.coefficient)
    }
}

/// Working memory; grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadShare<R> {
    /// Compliance of each row, but for ε.
    compliances: Vec<R>,
    deformation: Vec<R>,
    tests: Vec<R>,
    sums: Vec<R>,
    /// Unknowns without effect, vanishing combinations of rows, and multipliers without effect: a row for each unknown,
    /// row or multiplier, with its share in each combination.
    unknowns: Vec<R>,
    vanishing: Vec<R>,
    kernel: Vec<R>,
    /// Deformations by the multipliers without effect, and their tests, laid out alike.
    deformations: Vec<R>,
    all_tests: Vec<R>,
    /// Deformation incompatible with the motion of the bodies, by each of the multipliers without effect and by those
    /// before anything is added: row by row of the vanishing combinations.
    incompatible: Vec<R>,
    of_elastic: Vec<R>,
    /// Metric of the multipliers without effect, row by row.
    metric: Vec<R>,
    system: Dense<R>,
    parts: Vec<R>,
    creeping: Vec<Creeping<R>>,
    /// Multipliers before anything is added.
    elastic: Vec<R>,
    /// Multipliers of equally stiff constraints without creep, and those of the least shift from them.
    equal: Vec<R>,
    shifted: Vec<R>,
}

impl<R: Real> LoadShare<R> {
    /// Adds multipliers without effect to λ so that redundant constraints share the load. `dense` must hold the system
    /// of the active set, solved.
    pub fn apply(
        &mut self,
        problem: &ContactProblem<'_, R>,
        (dense, active_set): (&Dense<R>, &ActiveSet<R>),
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) {
        R::run_hot(Sharing { share: self, problem, dense, active_set, blocks, lambda });
    }

    #[inline(always)]
    fn find(
        &mut self,
        problem: &ContactProblem<'_, R>,
        (dense, active_set): (&Dense<R>, &ActiveSet<R>),
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) {
        let (m, n, redundant) = (problem.m(), dense.n, dense.n - dense.rank);
        self.find_compliances(problem, blocks);
        self.find_kernels((m, n, redundant), (dense, active_set), blocks);
        self.creeping.clear();
        self.elastic.clear();
        self.elastic.extend_from_slice(lambda);
        self.find_incompatible((m, n, redundant), active_set, blocks);
        for updates in 0..MAX_CREEPING {
            self.assemble((m, redundant), active_set, blocks);
            self.solve_parts(redundant);
            lambda.copy_from_slice(&self.elastic);
            self.add_parts(redundant, lambda);
            if self.system.rank < self.parts.len() {
                if updates > 0 && self.find_creeping(blocks, lambda).is_some() {
                    self.shift_load((m, redundant), blocks, lambda);
                }
                return;
            }
            if updates == 0 {
                self.equal.clear();
                self.equal.extend_from_slice(lambda);
            }
            if self.find_creeping(blocks, lambda).is_none() {
                return;
            }
        }
    }

    /// Solves the system for the parts of the multipliers without effect, and for one unknown of each creeping group.
    #[inline(always)]
    fn solve_parts(&mut self, redundant: usize) {
        self.parts.clear();
        self.parts.resize(redundant + self.creeping.len(), R::zero());
        self.system.solve_part(RANK, &mut self.parts);
    }

    /// Adds the parts of the multipliers without effect.
    #[inline(always)]
    fn add_parts(&self, redundant: usize, lambda: &mut [R]) {
        for (lambda, shares) in lambda.iter_mut().zip(self.kernel.chunks_exact(redundant)) {
            for (x, part) in shares.iter().zip(&self.parts) {
                *lambda += *part * *x;
            }
        }
    }

    /// Shifts the load to the share nearest to that of equal stiffness in which the friction that is listed as creeping
    /// is at its limit; where there is none, λ stays as it is.
    #[inline(always)]
    fn shift_load(&mut self, (m, redundant): (usize, usize), blocks: &[UnilateralConstraint<R>], lambda: &mut [R]) {
        self.find_metric((m, redundant));
        let mut shifted = core::mem::take(&mut self.shifted);
        let (mut least, mut since) = (f64::INFINITY, 0);
        for _ in 0..MAX_SHIFTS {
            if !self.assemble_shift(redundant) {
                break;
            }
            self.solve_parts(redundant);
            if self.system.rank < self.parts.len() {
                break;
            }
            shifted.clear();
            shifted.extend_from_slice(&self.equal);
            self.add_parts(redundant, &mut shifted);
            let Some(excess) = self.find_creeping(blocks, &shifted) else {
                lambda.copy_from_slice(&shifted);
                break;
            };
            // shares that are none come no nearer
            since += 1;
            if excess < 0.5 * least {
                (least, since) = (excess, 0);
            } else if since > PATIENCE {
                break;
            }
        }
        self.shifted = shifted;
    }

    /// Metric Σ gᵢ Δλᵢ² of the multipliers without effect.
    #[inline(always)]
    fn find_metric(&mut self, (m, redundant): (usize, usize)) {
        self.metric.clear();
        self.metric.resize(redundant * redundant, R::zero());
        for (shares, compliance) in self.kernel.chunks_exact(redundant).zip(&self.compliances[..m]) {
            for (row, x) in self.metric.chunks_exact_mut(redundant).zip(shares) {
                for (sum, y) in row.iter_mut().zip(shares) {
                    *sum += *x * *y * *compliance;
                }
            }
        }
    }

    /// Fills the linear system of the least shift, with one multiplier of each friction at its limit; returns false if
    /// shares have no effect on one of them.
    #[inline(always)]
    fn assemble_shift(&mut self, redundant: usize) -> bool {
        self.system.reset(redundant + self.creeping.len());
        for (i, row) in self.metric.chunks_exact(redundant).enumerate() {
            for (j, x) in row.iter().enumerate() {
                self.system.set(i, j, *x);
            }
        }
        let shares = &self.kernel;
        let kernel = |j: usize| move |row: usize| shares[row * redundant + j];
        for (k, creeping) in self.creeping.iter().enumerate() {
            let row = redundant + k;
            let (mut effect, mut terms) = (0.0, 0.0);
            for j in 0..redundant {
                let size = self.metric[j * redundant + j].lane(0).max(f64::MIN_POSITIVE);
                let (beyond, limit) = (creeping.beyond(kernel(j)).lane(0), creeping.limit(kernel(j)).lane(0));
                effect += beyond * beyond / size;
                let of_terms = (beyond + limit).abs() + limit.abs();
                terms += of_terms * of_terms / size;
            }
            if effect <= NO_EFFECT * terms {
                return false;
            }
            // of size one beside the metric, whatever the units
            let scale = R::splat(1.0 / effect.sqrt());
            for j in 0..redundant {
                let scaled = creeping.beyond(kernel(j)) * scale;
                self.system.set(row, j, scaled);
                self.system.set(j, row, scaled);
            }
            self.system.rhs[row] = -(creeping.beyond(|row| self.equal[row]) * scale);
        }
        true
    }

    /// Finds the incompatible deformations, which are the same wherever friction creeps.
    #[inline(always)]
    fn find_incompatible(
        &mut self,
        (m, n, redundant): (usize, usize, usize),
        active_set: &ActiveSet<R>,
        blocks: &[UnilateralConstraint<R>],
    ) {
        for (list, len) in [
            (&mut self.deformations, m * redundant),
            (&mut self.all_tests, n * redundant),
            (&mut self.incompatible, redundant * redundant),
        ] {
            list.clear();
            list.resize(len, R::zero());
        }
        let deformations = self.deformations.chunks_exact_mut(redundant).zip(self.kernel.chunks_exact(redundant));
        for ((deformations, shares), compliance) in deformations.zip(&self.compliances) {
            for (deformation, x) in deformations.iter_mut().zip(shares) {
                *deformation = *x * *compliance;
            }
        }
        active_set.test_all(blocks, &self.deformations, redundant, &mut self.all_tests);
        for (y, tests) in self.vanishing.chunks_exact(redundant).zip(self.all_tests.chunks_exact(redundant)) {
            for (sums, y) in self.incompatible.chunks_exact_mut(redundant).zip(y) {
                for (sum, test) in sums.iter_mut().zip(tests) {
                    *sum += *y * *test;
                }
            }
        }
        self.deformation.clear();
        self.deformation.extend(self.elastic.iter().zip(&self.compliances).map(|(x, compliance)| *x * *compliance));
        active_set.tests(blocks, &self.deformation, &mut self.tests);
        combine(&self.vanishing, redundant, &self.tests, &mut self.of_elastic);
    }

    /// Fills the linear system: compatible deformations, and friction at its limit where it creeps.
    #[inline(always)]
    fn assemble(
        &mut self,
        (m, redundant): (usize, usize),
        active_set: &ActiveSet<R>,
        blocks: &[UnilateralConstraint<R>],
    ) {
        self.system.reset(redundant + self.creeping.len());
        for (i, sums) in self.incompatible.chunks_exact(redundant).enumerate() {
            for (j, sum) in sums.iter().enumerate() {
                self.system.set(i, j, *sum);
            }
            self.system.rhs[i] = -self.of_elastic[i];
        }
        for (k, creeping) in self.creeping.iter().enumerate() {
            let (at, dim) = (redundant + k, creeping.dim);
            self.deformation.clear();
            self.deformation.resize(m, R::zero());
            self.deformation[creeping.row..creeping.row + dim].copy_from_slice(&creeping.direction[..dim]);
            active_set.tests(blocks, &self.deformation, &mut self.tests);
            combine(&self.vanishing, redundant, &self.tests, &mut self.sums);
            for (i, sum) in self.sums.iter().enumerate() {
                self.system.set(i, at, *sum);
            }
            for j in 0..redundant {
                self.system.set(at, j, creeping.beyond(|row| self.kernel[row * redundant + j]));
            }
            self.system.rhs[at] = -creeping.beyond(|row| self.elastic[row]);
        }
    }

    /// Lists the sticking friction that is beyond its limit, which creeps as far as the compliances of the others let
    /// it; returns the largest excess, relative to the largest force, none if all is within its limits.
    fn find_creeping(&mut self, blocks: &[UnilateralConstraint<R>], lambda: &[R]) -> Option<f64> {
        let force = lambda.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        let mut largest: Option<f64> = None;
        for block in blocks.iter().filter(|block| !block.open) {
            for group in block.groups.iter().flatten().filter(|group| group.mode == ContactMode::Stick) {
                let size = norm(pair(group, lambda));
                let excess = size - group.coefficient * lambda[block.row].lane(0).max(0.0);
                if excess <= CREEPS * force {
                    continue;
                }
                largest = Some(largest.unwrap_or(0.0).max(excess / force));
                let direction = std::array::from_fn(|k| {
                    if k < group.dim { lambda[group.row + k] * R::splat(1.0 / size) } else { R::zero() }
                });
                let creeping = Creeping {
                    row: group.row,
                    dim: group.dim,
                    normal: block.row,
                    coefficient: group.coefficient,
                    direction,
                };
                match self.creeping.iter_mut().find(|other| other.row == group.row) {
                    Some(other) => *other = creeping,
                    None => self.creeping.push(creeping),
                }
            }
        }
        largest
    }

    #[inline(always)]
    fn find_kernels(
        &mut self,
        (m, n, redundant): (usize, usize, usize),
        (dense, active_set): (&Dense<R>, &ActiveSet<R>),
        blocks: &[UnilateralConstraint<R>],
    ) {
        for (list, len) in [
            (&mut self.unknowns, n * redundant),
            (&mut self.vanishing, n * redundant),
            (&mut self.kernel, m * redundant),
        ] {
            list.clear();
            list.resize(len, R::zero());
        }
        dense.left_kernel(&mut self.vanishing, &mut self.sums);
        dense.kernel(&mut self.unknowns, &mut self.sums);
        active_set.changes(blocks, &self.unknowns, redundant, &mut self.kernel);
    }

    fn find_compliances(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>]) {
        let m = problem.m();
        self.compliances.clear();
        self.compliances.extend((0..m).map(|i| problem.a[i * m + i]));
        for group in blocks.iter().flat_map(|block| block.groups.iter().flatten()).filter(|group| group.dim == 2) {
            let mean = (self.compliances[group.row] + self.compliances[group.row + 1]) * R::splat(0.5);
            self.compliances[group.row..group.row + 2].fill(mean);
        }
        // a corner that hardly touches must not be the first at its limit
        let is_given = |block: &&UnilateralConstraint<R>| block.is_compliant && block.given.is_some();
        let given = |block: &UnilateralConstraint<R>| block.given.unwrap_or(R::zero());
        let largest = blocks.iter().filter(is_given).map(given).fold(R::zero(), R::max);
        if largest.lane(0) <= 0.0 {
            return;
        }
        for block in blocks.iter().filter(is_given) {
            let factor = largest / given(block).max(R::splat(LEAST_STIFFNESS) * largest);
            for group in block.groups.iter().flatten() {
                self.compliances[group.row..group.row + group.dim].iter_mut().for_each(|g| *g *= factor);
            }
        }
    }
}

/// Sums of a list over the rows, weighted by each of `n` combinations.
#[inline(always)]
fn combine<R: Real>(combinations: &[R], n: usize, list: &[R], sums: &mut Vec<R>) {
    sums.clear();
    sums.resize(n, R::zero());
    for (shares, x) in combinations.chunks_exact(n).zip(list) {
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum += *share * *x;
        }
    }
}

struct Sharing<'a, R> {
    share: &'a mut LoadShare<R>,
    problem: &'a ContactProblem<'a, R>,
    dense: &'a Dense<R>,
    active_set: &'a ActiveSet<R>,
    blocks: &'a [UnilateralConstraint<R>],
    lambda: &'a mut [R],
}

impl<R: Real> Task for Sharing<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { share, problem, dense, active_set, blocks, lambda } = self;
        share.find(problem, (dense, active_set), blocks, lambda);
    }
}

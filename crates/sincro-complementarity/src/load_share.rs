//! Share of the load among redundant constraints.
//!
//! Where rows depend on each other, multipliers without effect on their rates may be added to any solution. The one
//! taken is the limit of equally stiff constraints as their stiffness grows: with a compliance ε gᵢ of each row, gᵢ the
//! diagonal of the Delassus matrix (its mean over the rows of a friction group), the rates ε gᵢ λᵢ must be compatible
//! with a motion of the bodies, yᵀ g λ = 0 for every combination y of rows that vanishes. Where no contact slips that
//! is the least Σ gᵢ λᵢ². It depends on the state alone: not on the history, the frame, the order of bodies, or the
//! units of lengths and masses, and it does not jump where a contact begins to slip. Where contacts slide, the share
//! decides about the motion.
//!
//! **Friction at its limit.** A sticking contact whose share is beyond its friction creeps within the compliances of
//! the others. Where its creep relieves nothing (it alone holds the body, and what slides beside it presses on it), the
//! load shifts instead: of all shares with friction at its limit, the one taken is nearest to that of equal stiffness,
//! by Σ gᵢ Δλᵢ². So friction that some share can keep within its limit does not slip.

use sincro_math::{Real, dot};

use super::active_set::{ActiveSet, ContactProblem};
use super::cone::{ContactMode, UnilateralConstraint};
use super::dense::{Dense, RANK};
use super::solver::{norm, pair};

/// Maximum number of updates of the friction that creeps.
const MAX_CREEPING: usize = 12;

/// Maximum number of shifts of the load: directions of friction at its limit change with each.
const MAX_SHIFTS: usize = 60;

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
    /// Force along the direction beyond the limit.
    fn beyond(&self, lambda: &[R]) -> R {
        let mut sum = -self.limit(lambda);
        for k in 0..self.dim {
            sum += self.direction[k] * lambda[self.row + k];
        }
        sum
    }

    fn limit(&self, lambda: &[R]) -> R {
        lambda[self.normal] * R::splat(self.coefficient)
    }
}

/// Working memory; grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadShare<R> {
    /// Compliance of each row, but for ε.
    compliances: Vec<R>,
    deformation: Vec<R>,
    tests: Vec<R>,
    /// Changes of the unknowns or of the tests, and of the multipliers.
    unknowns: Vec<R>,
    /// Vanishing combinations of rows, and multipliers without effect, one after the other.
    vanishing: Vec<R>,
    kernel: Vec<R>,
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
        let (m, n, redundant) = (problem.m(), dense.n, dense.n - dense.rank);
        self.find_compliances(problem, blocks);
        self.find_kernels((m, n, redundant), (dense, active_set), blocks);
        self.creeping.clear();
        self.elastic.clear();
        self.elastic.extend_from_slice(lambda);
        for updates in 0..MAX_CREEPING {
            self.assemble((m, n, redundant), active_set, blocks);
            self.solve_parts(redundant);
            lambda.copy_from_slice(&self.elastic);
            self.add_parts(m, lambda);
            if self.system.rank < self.parts.len() {
                if updates > 0 && self.find_creeping(blocks, lambda) {
                    self.shift_load((m, redundant), blocks, lambda);
                }
                return;
            }
            if updates == 0 {
                self.equal.clear();
                self.equal.extend_from_slice(lambda);
            }
            if !self.find_creeping(blocks, lambda) {
                return;
            }
        }
    }

    /// Solves the system for the parts of the multipliers without effect, and for one unknown of each creeping group.
    fn solve_parts(&mut self, redundant: usize) {
        self.parts.clear();
        self.parts.resize(redundant + self.creeping.len(), R::zero());
        self.system.solve(RANK, &mut self.parts);
    }

    /// Adds the parts of the multipliers without effect.
    fn add_parts(&self, m: usize, lambda: &mut [R]) {
        for (combination, part) in self.kernel.chunks_exact(m).zip(&self.parts) {
            for (lambda, x) in lambda.iter_mut().zip(combination) {
                *lambda += *part * *x;
            }
        }
    }

    /// Shifts the load to the share nearest to that of equal stiffness in which the friction that is listed as creeping
    /// is at its limit; where there is none, λ stays as it is.
    fn shift_load(&mut self, (m, redundant): (usize, usize), blocks: &[UnilateralConstraint<R>], lambda: &mut [R]) {
        let mut shifted = core::mem::take(&mut self.shifted);
        for _ in 0..MAX_SHIFTS {
            if !self.assemble_shift((m, redundant)) {
                break;
            }
            self.solve_parts(redundant);
            if self.system.rank < self.parts.len() {
                break;
            }
            shifted.clear();
            shifted.extend_from_slice(&self.equal);
            self.add_parts(m, &mut shifted);
            if !self.find_creeping(blocks, &shifted) {
                lambda.copy_from_slice(&shifted);
                break;
            }
        }
        self.shifted = shifted;
    }

    /// Fills the linear system of the least shift, with one multiplier of each friction at its limit; returns false if
    /// shares have no effect on one of them.
    fn assemble_shift(&mut self, (m, redundant): (usize, usize)) -> bool {
        self.system.reset(redundant + self.creeping.len());
        let kernel = |k: usize| &self.kernel[k * m..(k + 1) * m];
        for (i, j) in (0..redundant).flat_map(|i| (0..redundant).map(move |j| (i, j))) {
            let products = kernel(i).iter().zip(kernel(j)).zip(&self.compliances);
            let metric = products.fold(R::zero(), |sum, ((x, y), compliance)| sum + *x * *y * *compliance);
            self.system.set(i, j, metric);
        }
        for (k, creeping) in self.creeping.iter().enumerate() {
            let row = redundant + k;
            let (mut effect, mut terms) = (0.0, 0.0);
            for j in 0..redundant {
                let size = self.system.get(j, j).lane(0).max(f64::MIN_POSITIVE);
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
            self.system.rhs[row] = -(creeping.beyond(&self.equal) * scale);
        }
        true
    }

    /// Fills the linear system: compatible deformations, and friction at its limit where it creeps.
    fn assemble(
        &mut self,
        (m, n, redundant): (usize, usize, usize),
        active_set: &ActiveSet<R>,
        blocks: &[UnilateralConstraint<R>],
    ) {
        let size = redundant + self.creeping.len();
        self.system.reset(size);
        for j in 0..=size {
            // the last column is the right-hand side
            self.deformation.clear();
            let multipliers = if j < redundant { &self.kernel[j * m..(j + 1) * m] } else { &self.elastic[..] };
            if j < redundant || j == size {
                let products = multipliers.iter().zip(&self.compliances).map(|(x, compliance)| *x * *compliance);
                self.deformation.extend(products);
            } else {
                self.deformation.resize(m, R::zero());
                let Creeping { row, dim, direction, .. } = self.creeping[j - redundant];
                self.deformation[row..row + dim].copy_from_slice(&direction[..dim]);
            }
            active_set.tests(blocks, &self.deformation, &mut self.tests);
            for (i, y) in self.vanishing.chunks_exact(n).enumerate() {
                let sum = dot(y, &self.tests);
                if j < size { self.system.set(i, j, sum) } else { self.system.rhs[i] = -sum }
            }
            for (i, creeping) in self.creeping.iter().enumerate().filter(|_| j < redundant || j == size) {
                let beyond = creeping.beyond(multipliers);
                if j < size {
                    self.system.set(redundant + i, j, beyond);
                } else {
                    self.system.rhs[redundant + i] = -beyond;
                }
            }
        }
    }

    /// Lists the sticking friction that is beyond its limit, which creeps as far as the compliances of the others let
    /// it; returns true if there is any that was not listed so yet.
    fn find_creeping(&mut self, blocks: &[UnilateralConstraint<R>], lambda: &[R]) -> bool {
        let force = lambda.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.lane(0).abs()));
        let mut found = false;
        for block in blocks.iter().filter(|block| !block.open) {
            for group in block.groups.iter().flatten().filter(|group| group.mode == ContactMode::Stick) {
                let size = norm(pair(group, lambda));
                if size - group.coefficient * lambda[block.row].lane(0).max(0.0) <= CREEPS * force {
                    continue;
                }
                found = true;
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
        found
    }

    fn find_kernels(
        &mut self,
        (m, n, redundant): (usize, usize, usize),
        (dense, active_set): (&Dense<R>, &ActiveSet<R>),
        blocks: &[UnilateralConstraint<R>],
    ) {
        for (list, len) in
            [(&mut self.unknowns, n), (&mut self.vanishing, redundant * n), (&mut self.kernel, redundant * m)]
        {
            list.clear();
            list.resize(len, R::zero());
        }
        for (k, combination) in self.vanishing.chunks_exact_mut(n).enumerate() {
            dense.left_kernel(k, combination);
        }
        for (k, combination) in self.kernel.chunks_exact_mut(m).enumerate() {
            dense.kernel(k, &mut self.unknowns);
            active_set.change(blocks, &self.unknowns, combination);
        }
    }

    fn find_compliances(&mut self, problem: &ContactProblem<'_, R>, blocks: &[UnilateralConstraint<R>]) {
        let m = problem.m();
        self.compliances.clear();
        self.compliances.extend((0..m).map(|i| problem.a[i * m + i]));
        for group in blocks.iter().flat_map(|block| block.groups.iter().flatten()).filter(|group| group.dim == 2) {
            let mean = (self.compliances[group.row] + self.compliances[group.row + 1]) * R::splat(0.5);
            self.compliances[group.row..group.row + 2].fill(mean);
        }
    }
}

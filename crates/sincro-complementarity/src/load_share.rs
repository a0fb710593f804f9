//! Share of the load among redundant constraints.
//!
//! Where rows depend on each other, multipliers without effect on their rates may be added to any solution. The one
//! taken is the limit of equally stiff constraints as their stiffness grows: with a compliance ε gᵢ of each row, gᵢ the
//! diagonal of the Delassus matrix (its mean over the rows of a friction group), the rates ε gᵢ λᵢ must be compatible
//! with a motion of the bodies, yᵀ g λ = 0 for every combination y of rows that vanishes. Where no contact slips that
//! is the least Σ gᵢ λᵢ². It depends on the state alone: not on the history, the frame, the order of bodies, or the
//! units of lengths and masses, and it does not jump where a contact begins to slip. Where contacts slide, the share
//! decides about the motion.

use sincro_math::{Real, dot};

use super::active_set::{ActiveSet, ContactProblem};
use super::cone::{ContactMode, UnilateralConstraint};
use super::dense::{Dense, RANK};
use super::solver::{norm, pair};

/// Maximum number of updates of the friction that creeps.
const MAX_CREEPING: usize = 12;

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
        let mut sum = -(lambda[self.normal] * R::splat(self.coefficient));
        for k in 0..self.dim {
            sum += self.direction[k] * lambda[self.row + k];
        }
        sum
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
        for _ in 0..MAX_CREEPING {
            self.assemble((m, n, redundant), active_set, blocks);
            self.parts.clear();
            self.parts.resize(redundant + self.creeping.len(), R::zero());
            self.system.solve(RANK, &mut self.parts);
            lambda.copy_from_slice(&self.elastic);
            for (combination, part) in self.kernel.chunks_exact(m).zip(&self.parts) {
                for (lambda, x) in lambda.iter_mut().zip(combination) {
                    *lambda += *part * *x;
                }
            }
            if self.system.rank < self.parts.len() || !self.find_creeping(blocks, lambda) {
                return;
            }
        }
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

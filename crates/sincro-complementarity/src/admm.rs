//! ADMM for the frictional contact problem w = G λ + b, λ ∈ K, used when the active-set iteration does not converge.
//!
//! The alternating direction method of multipliers splits the problem: x satisfies the linear system, y lies in the
//! product K of friction cones, z is the scaled multiplier of x = y. Coulomb friction is not associated; the de Saxcé
//! correction wₙ + μ|w_t| turns it into a cone complementarity problem, and the correction is taken from the last
//! iterate. Rows are scaled to a unit diagonal, each friction group as a whole, so that discs stay discs. Redundant
//! contacts share the load evenly, relative to the start. The result is always feasible, and accurate to the tolerance;
//! [`super::solver`] makes it exact by the linear system of the active set that it implies.
//!
//! x ← (G + ρ 1)⁻¹ (ρ y − z − g − s), y ← P_K(x + z/ρ), z ← z + ρ (x − y), with s the de Saxcé shift.
//!
//! Sources: keys `acary2008` (section 3.9.4, the correction), `carpentier2024` (the method).

use super::active_set::{ActiveSet, ContactProblem};
use super::cone::{FrictionGroup, UnilateralConstraint};
use super::dense::{Dense, Factor};
use sincro_math::Real;

/// Iteration limit; beyond it the last iterate is returned with its residual.
const MAX_ITERATIONS: usize = 4000;

/// Iterations between updates of the penalty ρ.
const BALANCE: usize = 20;

/// Ratio of scaled forces to the largest rate beyond which the iteration has diverged.
const DIVERGED: f64 = 1e9;

/// Relative reduction of the friction discs: a group that sticks exactly at its limit, of redundant contacts, is then
/// found a little inside, where the linear system can make it exact; slipping groups are recognised by their rate.
const INSIDE: f64 = 1e-5;

/// Slip threshold of a group at its limit, relative to the largest rate.
const SLIPS: f64 = 1e-6;

/// Convergence tolerance of both residuals, relative to the largest force and the largest rate.
const TOLERANCE: f64 = 1e-12;

/// Friction disc among the unknowns.
#[derive(Clone, Copy, Debug)]
struct Disc {
    first: usize,
    dim: usize,
    /// Scaled coefficient, or the limit itself where the normal force is given.
    size: f64,
}

/// Friction cone: a normal force, which may be prescribed, and its discs.
#[derive(Clone, Copy, Debug)]
struct Cone {
    normal: Option<usize>,
    discs: [Option<Disc>; 3],
}

/// Working memory; grows to the largest problem it has seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Admm {
    factor: Factor,
    matrix: Vec<f64>,
    g: Vec<f64>,
    scale: Vec<f64>,
    shift: Vec<f64>,
    last: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    cones: Vec<Cone>,
    rho: f64,
    /// Iterations of the last solution so far.
    pub iterations: usize,
}

impl Admm {
    /// Prepares the problem of all constraints closed and sticking. `blocks` must be the result of [`activate_all`]; λ
    /// is the start.
    pub fn begin<R: Real>(
        &mut self,
        problem: &ContactProblem<'_, R>,
        active_set: &mut ActiveSet<R>,
        dense: &mut Dense<R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &mut [R],
    ) {
        active_set.take(problem.n_free, blocks, lambda);
        active_set.find_rates(problem, lambda);
        active_set.system(problem, blocks, lambda, dense);
        let n = active_set.len();
        self.list_cones(active_set, blocks, lambda, dense);
        self.matrix.clear();
        for i in 0..n {
            self.matrix.extend((0..n).map(|j| dense.get(i, j).lane(0) * self.scale[i] * self.scale[j]));
        }
        // x starts as λ in the unknowns; across a slow group, from nothing
        self.x.clear();
        self.x.extend((0..n).map(|k| active_set.row(k, blocks).map_or(0.0, |row| lambda[row].lane(0)) / self.scale[k]));
        // the right-hand side is −(G x + g)
        self.g.clear();
        for i in 0..n {
            let now = -dense.rhs[i].lane(0) * self.scale[i];
            let of_x: f64 = self.matrix[i * n..(i + 1) * n].iter().zip(&self.x).map(|(a, x)| a * x).sum();
            self.g.push(now - of_x);
        }
        self.y.clone_from(&self.x);
        self.z.clear();
        self.z.resize(n, 0.0);
        self.shift.clear();
        self.shift.resize(n, 0.0);
        self.rho = 0.1;
        self.iterations = 0;
        self.factor();
    }

    fn list_cones<R: Real>(
        &mut self,
        active_set: &ActiveSet<R>,
        blocks: &[UnilateralConstraint<R>],
        lambda: &[R],
        dense: &Dense<R>,
    ) {
        let n = active_set.len();
        self.cones.clear();
        self.scale.clear();
        for k in 0..n {
            let d = dense.get(k, k).lane(0).abs();
            self.scale.push(if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 });
        }
        let place = |row: usize| (0..n).find(|k| active_set.row(*k, blocks) == Some(row));
        for block in blocks {
            let normal = if block.given.is_some() { None } else { place(block.row) };
            let mut discs = [None; 3];
            for (disc, group) in discs.iter_mut().zip(&block.groups) {
                let Some(group) = group.filter(|g| !g.is_sliding) else { continue };
                let Some(first) = place(group.row) else { continue };
                let d: f64 = (0..group.dim).map(|k| dense.get(first + k, first + k).lane(0).abs()).sum();
                let scale = if d > 0.0 { (group.dim as f64 / d).sqrt() } else { 1.0 };
                self.scale[first..first + group.dim].fill(scale);
                let of_normal = normal.map_or_else(|| lambda[block.row].lane(0), |k| self.scale[k]);
                *disc =
                    Some(Disc { first, dim: group.dim, size: group.coefficient * of_normal / scale * (1.0 - INSIDE) });
            }
            self.cones.push(Cone { normal, discs });
        }
    }

    fn factor(&mut self) {
        let (n, rho) = (self.g.len(), self.rho);
        let matrix = &self.matrix;
        self.factor.factor(n, |i, j| if i == j { matrix[i * n + j] + rho } else { matrix[i * n + j] });
    }

    /// Runs up to `iterations`; returns true if it has converged, diverged or reached the limit.
    pub fn run(&mut self, iterations: usize) -> bool {
        let mut since = 0;
        for _ in 0..iterations {
            self.iterations += 1;
            since += 1;
            let (apart, moved) = self.iterate();
            // scaled, a force and the rate it makes are of one size
            let rates = self.g.iter().fold(f64::MIN_POSITIVE, |s, x| s.max(x.abs()));
            let forces = self.y.iter().fold(rates, |s, x| s.max(x.abs()));
            let (primal, dual) = (apart / forces, moved / rates);
            // a maximum passes over what is not a number
            let is_finite = self.y.iter().sum::<f64>().is_finite();
            if is_finite && primal <= TOLERANCE && dual <= TOLERANCE {
                return true;
            }
            if forces > DIVERGED * rates || !is_finite {
                // sliding friction can make a problem without a solution (Painlevé paradox): zero forces are returned
                self.y.fill(0.0);
                return true;
            }
            if since == BALANCE {
                since = 0;
                self.balance(primal, dual);
            }
        }
        self.iterations >= MAX_ITERATIONS
    }

    /// Adapts ρ so that the primal and the dual residual stay of one magnitude.
    fn balance(&mut self, primal: f64, dual: f64) {
        let ratio = (primal / dual.max(f64::MIN_POSITIVE)).clamp(1e-4, 1e4).sqrt();
        if (0.5..2.0).contains(&ratio) {
            return;
        }
        let rho = (self.rho * ratio).clamp(1e-6, 1e3);
        if rho != self.rho {
            self.rho = rho;
            self.factor();
        }
    }

    /// One iteration; returns the primal residual |x − y| and the dual residual ρ|Δy|.
    fn iterate(&mut self) -> (f64, f64) {
        let n = self.g.len();
        for cone in &self.cones {
            let Some(normal) = cone.normal else { continue };
            let size = |disc: &Disc| disc.size * norm(&self.z[disc.first..disc.first + disc.dim]);
            self.shift[normal] = cone.discs.iter().flatten().map(size).sum();
        }
        for k in 0..n {
            self.x[k] = self.rho * self.y[k] - self.z[k] - self.g[k] - self.shift[k];
        }
        self.factor.solve(&mut self.x);
        let (mut apart, mut moved) = (0.0_f64, 0.0_f64);
        self.last.clone_from(&self.y);
        // unknowns outside of every cone are unbounded
        for k in 0..n {
            self.y[k] = self.x[k] + self.z[k] / self.rho;
        }
        for cone in &self.cones {
            project(cone, &mut self.y);
        }
        for k in 0..n {
            moved = moved.max(self.rho * (self.y[k] - self.last[k]).abs());
            let gap = self.x[k] - self.y[k];
            apart = apart.max(gap.abs());
            self.z[k] += self.rho * gap;
        }
        (apart, moved)
    }

    /// Writes the feasible forces and the contact modes that they imply.
    pub fn finish<R: Real>(&self, active_set: &ActiveSet<R>, blocks: &mut [UnilateralConstraint<R>], lambda: &mut [R]) {
        for k in 0..self.y.len() {
            if let Some(row) = active_set.row(k, blocks) {
                lambda[row] = R::splat(self.y[k] * self.scale[k]);
            }
        }
        let rates = self.g.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        for (block, cone) in blocks.iter_mut().zip(&self.cones) {
            block.open = cone.normal.is_some_and(|k| self.y[k] <= 0.0);
            for (group, disc) in block.groups.iter_mut().zip(&cone.discs) {
                let (Some(group), Some(disc)) = (group, disc) else { continue };
                let (force, rate) =
                    (&self.y[disc.first..disc.first + disc.dim], &self.z[disc.first..disc.first + disc.dim]);
                let limit = cone.normal.map_or(1.0, |k| self.y[k]) * disc.size;
                let (size, speed) = (norm(force), norm(rate));
                let slips = size > 0.0 && size >= limit * (1.0 - 1e-9) && speed > SLIPS * rates;
                if slips && !block.open {
                    let scale = self.scale[disc.first];
                    slip(group, force, norm(rate) / (limit * scale * scale));
                } else {
                    group.stick();
                }
            }
        }
    }
}

/// Sets a group to slip along its force, with a compliance across it.
fn slip<R: Real>(group: &mut FrictionGroup<R>, force: &[f64], across: f64) {
    let size = norm(force);
    let mut d = [R::zero(); 2];
    for (d, x) in d.iter_mut().zip(force) {
        *d = R::splat(x / size);
    }
    group.slip(d, Some(R::splat(across)));
}

/// Sets every constraint closed and every group sticking unless it slides with a velocity.
pub(crate) fn activate_all<R: Real>(blocks: &mut [UnilateralConstraint<R>]) {
    for block in blocks.iter_mut() {
        block.open = false;
        for group in block.groups.iter_mut().flatten().filter(|g| !g.is_sliding) {
            group.stick();
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    match x {
        [one] => one.abs(),
        _ => x.iter().map(|x| x * x).sum::<f64>().sqrt(),
    }
}

/// Projection onto a friction cone: every group within its share of one normal force.
fn project(cone: &Cone, y: &mut [f64]) {
    let mut limit = 1.0;
    if let Some(normal) = cone.normal {
        // minimises (n − n₀)² + Σ max(0, |x_g| − c_g n)²; the active terms are found by iteration, there are three at
        // most
        let mut n = y[normal];
        for _ in 0..4 {
            let (mut top, mut bottom) = (y[normal], 1.0);
            for disc in cone.discs.iter().flatten() {
                let size = norm(&y[disc.first..disc.first + disc.dim]);
                if size > disc.size * n {
                    top += disc.size * size;
                    bottom += disc.size * disc.size;
                }
            }
            let next = top / bottom;
            if next == n {
                break;
            }
            n = next;
        }
        y[normal] = n.max(0.0);
        limit = y[normal];
    }
    for disc in cone.discs.iter().flatten() {
        let part = &mut y[disc.first..disc.first + disc.dim];
        let (size, limit) = (norm(part), disc.size * limit);
        if size > limit {
            part.iter_mut().for_each(|x| *x *= limit / size);
        }
    }
}

//! CMA-ES (Hansen, *The CMA evolution strategy: a tutorial*, 2016) on the unit cube, by ranks alone.
//!
//! Draws are counter-based and the candidates of a generation are ranked as a whole, so that the result depends on
//! neither the number of threads nor their timing.

use sincro_analysis::linear::{DMatrix, DVector};
use sincro_math::elementary::{exp, ln};

use crate::design::inverse_normal;
use crate::design::random::{Purpose, uniform};

/// Step size, relative to the width of the bounds, at which the search has converged.
const SMALLEST_STEP: f64 = 1e-5;

/// State of the search.
#[derive(Debug)]
pub struct Cma {
    seed: u64,
    n: usize,
    /// Candidates of a generation.
    population: usize,
    weights: Vec<f64>,
    effective: f64,
    mean: DVector<f64>,
    step: f64,
    covariance: DMatrix<f64>,
    path_step: DVector<f64>,
    path_covariance: DVector<f64>,
    generation: u64,
    /// Axes and lengths of the present distribution.
    axes: DMatrix<f64>,
    lengths: DVector<f64>,
}

impl Cma {
    /// A search from `start` in the unit cube with a first step of `step`.
    #[must_use]
    pub fn new(start: &[f64], step: f64, seed: u64) -> Self {
        let n = start.len();
        let population = 4 + (3.0 * ln(n as f64).0) as usize;
        let n_parents = population / 2;
        let raw: Vec<f64> = (1..=n_parents).map(|i| ln((population as f64 + 1.0) / 2.0).0 - ln(i as f64).0).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let effective = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        Self {
            seed,
            n,
            population,
            weights,
            effective,
            mean: DVector::from_column_slice(start),
            step,
            covariance: DMatrix::identity(n, n),
            path_step: DVector::zeros(n),
            path_covariance: DVector::zeros(n),
            generation: 0,
            axes: DMatrix::identity(n, n),
            lengths: DVector::from_element(n, 1.0),
        }
    }

    /// Candidates of the next generation, inside the cube.
    #[must_use]
    pub fn ask(&self) -> Vec<Vec<f64>> {
        let candidate = |i: usize| {
            let index = self.generation * self.population as u64 + i as u64;
            let z = DVector::from_fn(self.n, |j, _| {
                self.lengths[j] * inverse_normal(uniform(self.seed, Purpose::Mutation, j as u32, index))
            });
            let x = &self.mean + self.step * (&self.axes * z);
            x.iter().map(|x| x.clamp(0.0, 1.0)).collect()
        };
        (0..self.population).map(candidate).collect()
    }

    /// Moves to the better candidates, which come first in `ranked`.
    pub fn tell(&mut self, ranked: &[Vec<f64>]) {
        let n = self.n as f64;
        let old = self.mean.clone();
        let parents: Vec<DVector<f64>> =
            ranked.iter().take(self.weights.len()).map(|x| DVector::from_column_slice(x)).collect();
        self.mean = DVector::zeros(self.n);
        for (w, x) in self.weights.iter().zip(&parents) {
            self.mean += *w * x;
        }
        let moved = (&self.mean - &old) / self.step;
        let c_step = (self.effective + 2.0) / (n + self.effective + 5.0);
        let d_step = 1.0 + 2.0 * (((self.effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_step;
        let c_path = (4.0 + self.effective / n) / (n + 4.0 + 2.0 * self.effective / n);
        let c_one = 2.0 / ((n + 1.3) * (n + 1.3) + self.effective);
        let c_mu = (1.0 - c_one)
            .min(2.0 * (self.effective - 2.0 + 1.0 / self.effective) / ((n + 2.0) * (n + 2.0) + self.effective));
        let inverse = DVector::from_fn(self.n, |j, _| 1.0 / self.lengths[j]);
        let whitened = &self.axes * inverse.component_mul(&(self.axes.transpose() * &moved));
        self.path_step =
            (1.0 - c_step) * &self.path_step + (c_step * (2.0 - c_step) * self.effective).sqrt() * whitened;
        self.generation += 1;
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let norm = self.path_step.norm();
        let remembered = 1.0 - exp(2.0 * self.generation as f64 * ln(1.0 - c_step).0).0;
        let is_steady = norm / remembered.sqrt() < (1.4 + 2.0 / (n + 1.0)) * expected;
        let h = f64::from(u8::from(is_steady));
        self.path_covariance =
            (1.0 - c_path) * &self.path_covariance + h * (c_path * (2.0 - c_path) * self.effective).sqrt() * moved;
        let mut covariance = (1.0 - c_one - c_mu + (1.0 - h) * c_one * c_path * (2.0 - c_path)) * &self.covariance
            + c_one * &self.path_covariance * self.path_covariance.transpose();
        for (w, x) in self.weights.iter().zip(&parents) {
            let y = (x - &old) / self.step;
            covariance += c_mu * *w * &y * y.transpose();
        }
        self.covariance = 0.5 * (&covariance + covariance.transpose());
        self.step = (self.step * exp((c_step / d_step) * (norm / expected - 1.0)).0).clamp(1e-12, 1.0);
        let eigen = self.covariance.clone().symmetric_eigen();
        self.axes = eigen.eigenvectors;
        self.lengths = eigen.eigenvalues.map(|x| x.max(1e-20).sqrt());
    }

    /// Returns true if the distribution has shrunk to a point.
    #[must_use]
    pub fn has_converged(&self) -> bool {
        self.step * self.lengths.max() < SMALLEST_STEP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn least(of: impl Fn(&[f64]) -> f64, n: usize, generations: usize) -> Vec<f64> {
        let mut search = Cma::new(&vec![0.8; n], 0.3, 1);
        let mut best = (f64::INFINITY, Vec::new());
        for _ in 0..generations {
            let mut ranked = search.ask();
            ranked.sort_by(|a, b| of(a).total_cmp(&of(b)));
            if of(&ranked[0]) < best.0 {
                best = (of(&ranked[0]), ranked[0].clone());
            }
            search.tell(&ranked);
        }
        best.1
    }

    #[test]
    fn a_bent_valley_is_followed_to_its_end() {
        // Rosenbrock's function with its minimum at 0.55, 0.55
        let of = |x: &[f64]| {
            let (a, b) = (4.0 * x[0] - 1.2, 4.0 * x[1] - 1.2);
            (1.0 - a) * (1.0 - a) + 100.0 * (b - a * a) * (b - a * a)
        };
        let found = least(of, 2, 300);
        assert!((found[0] - 0.55).abs() < 1e-4 && (found[1] - 0.55).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn an_optimum_at_a_bound_is_found() {
        let found = least(|x| x.iter().sum(), 4, 200);
        assert!(found.iter().all(|x| *x < 1e-3), "{found:?}");
    }
}

//! Block `fir-filter`.

use crate::library::prelude::*;

declare_block! {
    /// A weighted sum of the last samples.
    ///
    /// A vector is taken component by component. Samples before the start are zero.
    pub struct FirFilter("fir-filter", Discrete): "y[k] = Σ coefficients[j]·u[k−j]" {
        /// Weights, of the present sample first.
        pub coefficients: Vec<f64> as List,
    }
}

impl FirFilter {
    /// Creates the block from weights, that of the present sample first.
    ///
    /// # Panics
    ///
    /// If there are none.
    #[must_use]
    pub fn new(coefficients: &[f64]) -> Self {
        assert!(!coefficients.is_empty(), "a filter has at least one weight");
        Self { coefficients: coefficients.to_vec() }
    }

    fn n_kept(&self) -> usize {
        self.coefficients.len() - 1
    }
}

impl Block for FirFilter {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        // an average keeps the unit, other weights may have one
        let sum: f64 = self.coefficients.iter().sum();
        Ok(vec![inputs[0].clone().filter(|_| (sum - 1.0).abs() < 1e-9)])
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.coefficients[0] != 0.0
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() * self.n_kept() }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let n = self.n_kept();
        let is_read = self.coefficients[0] != 0.0;
        for (i, y) in y.iter_mut().enumerate() {
            let mut sum = if is_read { R::splat(self.coefficients[0]) * at.component(0, i) } else { R::zero() };
            for (j, u) in at.memory[i * n..(i + 1) * n].iter().enumerate() {
                sum += R::splat(self.coefficients[j + 1]) * *u;
            }
            *y = sum;
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        let n = self.n_kept();
        if n == 0 {
            return;
        }
        for (i, (new, old)) in memory.chunks_exact_mut(n).zip(at.memory.chunks_exact(n)).enumerate() {
            new[0] = at.component(0, i);
            new[1..].copy_from_slice(&old[..n - 1]);
        }
    }

    fn label(&self) -> String {
        format!("FIR {}", self.n_kept())
    }
}

//! `y = Γ·Φᵀ·(I + Φ·Γ·Φᵀ)⁻¹·ε`: the direction of a normalised gradient law.
//!
//! For a plant that is linear in unknown parameters, ε = Φ·(θ* − θ), the law θ ← θ + a·y lets (θ* − θ)ᵀΓ⁻¹(θ* − θ) fall
//! for every a in (0, 2), however large Γ and Φ are: the normalisation I + ΦΓΦᵀ is what an un-normalised law Γ·Φᵀ·ε
//! lacks. Source: Goodwin & Sin, *Adaptive Filtering, Prediction and Control*, section 3.3 (projection algorithm), for
//! several outputs.
//!
//! Notation: Φ — regressor, m × n; ε — error, m; Γ — gain, n positive numbers; S = I + ΦΓΦᵀ — m × m, symmetric,
//! eigenvalues ≥ 1.

use crate::library::prelude::*;

declare_block! {
    /// The change of unknown parameters that an error asks for, normalised so that it is stable with every gain.
    pub struct NormalizedGradient("normalized-gradient", Adaptation):
        "y = Γ·Φᵀ·(I + Φ·Γ·Φᵀ)⁻¹·ε, Γ = diag(gain), Φ = regressor, row by row" {
        /// Diagonal of Γ, one number for every parameter or one for all, positive.
        gain: Vec<f64> as Positives,
    }
}

impl NormalizedGradient {
    /// Creates the block with the diagonal of Γ; one number stands for all.
    ///
    /// # Panics
    ///
    /// If one is not positive.
    #[must_use]
    pub fn new(gain: &[f64]) -> Self {
        assert!(!gain.is_empty() && gain.iter().all(|g| *g > 0.0), "gains are positive");
        Self { gain: gain.to_vec() }
    }
}

impl Block for NormalizedGradient {
    type Work<R: Real> = Vec<R>;
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::new(&["regressor", "error"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let (Some(regressor), Some(error)) = (inputs[0], inputs[1]) else { return Ok(vec![None]) };
        if regressor % error != 0 {
            return Err(format!("`error` has {error} components, `regressor` {regressor}: no matrix of {error} rows"));
        }
        let n = regressor / error;
        if self.gain.len() != 1 && self.gain.len() != n {
            return Err(format!("`gain` has {} numbers, the regressor {n} columns", self.gain.len()));
        }
        Ok(vec![Some(n)])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Vec<R>, y: &mut [R]) {
        let (phi, error) = (at.input(0), at.input(1));
        let (m, n) = (error.len(), y.len());
        work.resize(m * m + m, R::zero());
        let (s, x) = work.split_at_mut(m * m);
        // S = I + ΦΓΦᵀ, lower triangle
        for i in 0..m {
            for j in 0..=i {
                let mut sum = if i == j { R::one() } else { R::zero() };
                for k in 0..n {
                    sum += phi[i * n + k] * R::splat(of(&self.gain, k)) * phi[j * n + k];
                }
                s[i * m + j] = sum;
            }
        }
        x.copy_from_slice(error);
        solve(s, x);
        // y = ΓΦᵀx
        for (k, y) in y.iter_mut().enumerate() {
            let mut sum = R::zero();
            for i in 0..m {
                sum += phi[i * n + k] * x[i];
            }
            *y = R::splat(of(&self.gain, k)) * sum;
        }
    }

    fn label(&self) -> String {
        format!("Γ = {}", short_list(&self.gain))
    }
}

/// x ← S⁻¹·x by S = LLᵀ; S is overwritten.
#[inline(always)]
fn solve<R: Real>(s: &mut [R], x: &mut [R]) {
    let m = x.len();
    for i in 0..m {
        for j in 0..=i {
            let mut sum = s[i * m + j];
            for k in 0..j {
                sum -= s[i * m + k] * s[j * m + k];
            }
            s[i * m + j] = if i == j { sum.sqrt() } else { sum / s[j * m + j] };
        }
    }
    for i in 0..m {
        let mut sum = x[i];
        for k in 0..i {
            sum -= s[i * m + k] * x[k];
        }
        x[i] = sum / s[i * m + i];
    }
    for i in (0..m).rev() {
        let mut sum = x[i];
        for k in i + 1..m {
            sum -= s[k * m + i] * x[k];
        }
        x[i] = sum / s[i * m + i];
    }
}

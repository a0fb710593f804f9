//! `y = Π(u)`: the point of an ellipsoid that is nearest to `u` in the metric of the adaptation.
//!
//! yᵢ = uᵢ/(1 + μ·Γᵢ·wᵢ) with μ ≥ 0 the root of h(μ) = Σ wᵢ·yᵢ² − bound, μ = 0 inside. h falls and is convex, so that
//! Newton's method from μ = 0 rises to the root without overshooting it. The map does not expand distances in the
//! metric Γ⁻¹: parameters that lie inside come nearer, never farther.

use crate::library::prelude::*;

/// Newton steps at most. Far from the root each one multiplies μ by 1.5 or more: 900 pass through all squares that a
/// double can hold.
const MAX_STEPS: usize = 1000;

declare_block! {
    /// Keeps a vector inside an ellipsoid: the nearest point of it, measured by Γ⁻¹.
    pub struct EllipsoidProjection("ellipsoid-projection", Adaptation):
        "y = argmin (y − u)ᵀ·Γ⁻¹·(y − u) with Σ weightsᵢ·yᵢ² ≤ bound, Γ = diag(gain)" {
        /// Greatest value of the weighted sum of squares.
        bound: f64 as Positive,
        /// Weights of the squares, positive.
        weights: Vec<f64> as Positives = "1",
        /// Diagonal of Γ, as in the adaptation, positive.
        gain: Vec<f64> as Positives = "1",
    }
}

impl EllipsoidProjection {
    /// Onto Σ wᵢ·yᵢ² ≤ bound, nearest in the metric Γ⁻¹; a list of one number stands for all components.
    ///
    /// # Panics
    ///
    /// If a number is not positive.
    #[must_use]
    pub fn new(bound: f64, weights: &[f64], gain: &[f64]) -> Self {
        let all = [&[bound], weights, gain];
        assert!(all.iter().all(|list| !list.is_empty() && list.iter().all(|x| *x > 0.0)), "all numbers are positive");
        Self { bound, weights: weights.to_vec(), gain: gain.to_vec() }
    }

    /// h(μ) and −h'(μ)/2.
    #[inline(always)]
    fn excess<R: Real>(&self, u: &[R], mu: R) -> (R, R) {
        let (mut excess, mut fall) = (-R::splat(self.bound), R::zero());
        for (i, u) in u.iter().enumerate() {
            let (w, rate) = (R::splat(of(&self.weights, i)), R::splat(of(&self.weights, i) * of(&self.gain, i)));
            let shrink = R::one() + mu * rate;
            let y = *u / shrink;
            excess += w * y * y;
            fall += w * y * y * rate / shrink;
        }
        (excess, fall)
    }
}

/// 1 in lanes where `a` is above `b`, else 0.
#[inline(always)]
fn is_above<R: Real>(a: R, b: R) -> R {
    R::from_lanes(|k| f64::from(u8::from(a.lane(k) > b.lane(k))))
}

impl Block for EllipsoidProjection {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let lists = [("weights", &self.weights), ("gain", &self.gain)];
        for (name, list) in lists {
            if let Some(width) = inputs[0]
                && list.len() != 1
                && list.len() != width
            {
                return Err(format!("`{name}` has {} numbers, the input {width} components", list.len()));
            }
        }
        Ok(vec![inputs[0]])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let u = at.input(0);
        let mut mu = R::zero();
        // 1 in lanes that iterate
        let mut goes_on = is_above(self.excess(u, mu).0, R::zero());
        for _ in 0..MAX_STEPS {
            if (0..R::LANES).all(|k| goes_on.lane(k) == 0.0) {
                break;
            }
            let (excess, fall) = self.excess(u, mu);
            let next = mu + excess / (fall + fall);
            let has_risen = is_above(next, mu);
            mu = R::zero().if_less(goes_on, next, mu);
            goes_on *= has_risen;
        }
        for (i, y) in y.iter_mut().enumerate() {
            *y = u[i] / (R::one() + mu * R::splat(of(&self.weights, i) * of(&self.gain, i)));
        }
    }

    fn label(&self) -> String {
        format!("Σ w·u² ≤ {}", short(self.bound))
    }
}

//! Damped least squares of small problems with more unknowns than equations, or with equations that contradict each
//! other.

/// Damped least squares: the step Δx = Jᵀ (J Jᵀ + λ² 1)⁻¹ e for the `rows` of J (one entry an unknown), the errors `e`,
/// one a row, and `damping` = λ², in the unit of J²; `None` if the equations are not finite.
#[must_use]
pub fn damped_step(rows: &[Vec<f64>], e: &[f64], damping: f64) -> Option<Vec<f64>> {
    let m = rows.len();
    let l = cholesky(rows, damping);
    let mut x = e.to_vec();
    for i in 0..m {
        x[i] = (0..i).fold(x[i], |sum, k| sum - l[i][k] * x[k]) / l[i][i];
    }
    for i in (0..m).rev() {
        x[i] = (i + 1..m).fold(x[i], |sum, k| sum - l[k][i] * x[k]) / l[i][i];
    }
    let n = rows.first().map_or(0, Vec::len);
    let change = |k: usize| rows.iter().zip(&x).map(|(row, x)| row[k] * x).sum();
    x.iter().all(|x| x.is_finite()).then(|| (0..n).map(change).collect())
}

/// Lower Cholesky factor of J Jᵀ + λ² 1 for the `rows` of J and `damping` = λ²; no pivot falls below half of λ².
#[must_use]
pub fn cholesky(rows: &[Vec<f64>], damping: f64) -> Vec<Vec<f64>> {
    let m = rows.len();
    let mut l = vec![vec![0.0; m]; m];
    for i in 0..m {
        for j in 0..=i {
            let product: f64 = rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum();
            let sum = (0..j).fold(product + if i == j { damping } else { 0.0 }, |sum, k| sum - l[i][k] * l[j][k]);
            l[i][j] = if i == j { sum.max(0.5 * damping).sqrt() } else { sum / l[j][j] };
        }
    }
    l
}

//! Small dense linear systems, for mass matrices that are written as formulas.

use sincro_math::Real;

/// `matrix·x = right`, with `x` left in `right`: Gaussian elimination with partial pivoting, both overwritten, nothing
/// allocated. A singular matrix gives numbers that are not finite.
pub(super) fn solve<R: Real>(matrix: &mut [R], right: &mut [R]) {
    let n = right.len();
    debug_assert_eq!(matrix.len(), n * n, "a square matrix for the right-hand side");
    for k in 0..n {
        let pivot = pivot_row(matrix, n, k);
        if pivot != k {
            for c in k..n {
                matrix.swap(k * n + c, pivot * n + c);
            }
            right.swap(k, pivot);
        }
        for i in k + 1..n {
            let factor = matrix[i * n + k] / matrix[k * n + k];
            for c in k + 1..n {
                let above = matrix[k * n + c];
                matrix[i * n + c] -= factor * above;
            }
            let above = right[k];
            right[i] -= factor * above;
        }
    }
    for k in (0..n).rev() {
        for c in k + 1..n {
            let known = right[c];
            right[k] -= matrix[k * n + c] * known;
        }
        right[k] = right[k] / matrix[k * n + k];
    }
}

/// The row from `k` on with the largest entry in column `k`.
fn pivot_row<R: Real>(matrix: &[R], n: usize, k: usize) -> usize {
    let size = |i: usize| matrix[i * n + k].lane(0).abs();
    (k + 1..n).fold(k, |best, i| if size(i) > size(best) { i } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_on_the_diagonal_is_no_obstacle() {
        let (mut m, mut f) = ([0.0, 2.0, 1.0, 4.0, 0.0, -1.0, 1.0, 1.0, 1.0], [7.0, 1.0, 6.0]);
        // x = (1, 2, 3)
        solve(&mut m, &mut f);
        assert!(f.iter().zip([1.0, 2.0, 3.0]).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-14), "{f:?}");
    }

    #[test]
    fn a_singular_matrix_shows() {
        for mut f in [[1.0, 1.0], [0.0, 0.0]] {
            let mut m = [1.0, 2.0, 2.0, 4.0];
            solve(&mut m, &mut f);
            assert!(f.iter().any(|x: &f64| !x.is_finite()), "{f:?}");
        }
    }
}

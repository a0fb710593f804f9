//! Bounds of principal moments of inertia, as the compiler of the format sets them.

use sincro_dynamics::spatial::Mat3;

use crate::robot::turned_inertia;

/// Sweeps of Jacobi's method; it converges quadratically, and 3 × 3 needs less than ten.
const MAX_SWEEPS: usize = 30;

/// Inertia (xx, xy, xz, yy, yz, zz) whose principal moments are at least `least`, and with `is_balanced` all equal to
/// their mean where the sum of two of them is less than the third.
pub(super) fn bounded(inertia: [f64; 6], least: f64, is_balanced: bool) -> [f64; 6] {
    let (moments, axes) = principal(inertia);
    let mut found = moments.map(|x| x.max(least));
    let sum: f64 = found.iter().sum();
    if is_balanced && found.iter().any(|x| sum - x < *x) {
        found = [sum / 3.0; 3];
    }
    if found == moments {
        return inertia;
    }
    turned_inertia(&axes, [found[0], 0.0, 0.0, found[1], 0.0, found[2]])
}

/// Principal moments, and their axes as columns: Jacobi's method, Golub & Van Loan, 8.5.
fn principal([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> ([f64; 3], Mat3<f64>) {
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut axes = Mat3::identity();
    for _ in 0..MAX_SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let tangent = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            let mut turn = Mat3::identity();
            (turn.0[p][p], turn.0[q][q], turn.0[p][q], turn.0[q][p]) = (cosine, cosine, sine, -sine);
            a = turn.transpose().mul(&Mat3(a)).mul(&turn).0;
            (a[p][q], a[q][p]) = (0.0, 0.0);
            axes = axes.mul(&turn);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], axes)
}

//! Gram–Schmidt orthogonalisation of a few rows. Source: key `golub2013`, sections 5.2 and 5.4.

/// Euclidean norm, in the unit of the entries.
#[must_use]
pub fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Removes from a vector its part along a unit vector of the same length. Twice is enough: the second pass removes the
/// rounding of the first.
pub fn remove(x: &mut [f64], unit: &[f64]) {
    for _ in 0..2 {
        let along: f64 = x.iter().zip(unit).map(|(x, u)| x * u).sum();
        x.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
    }
}

/// Indices in ascending order of independent ones among `rows` of one length, by pivoted orthogonalisation: the row
/// with the largest remainder relative to its size comes next, until that ratio is no larger than `least`. `sizes` has
/// one size a row in the unit of its norm; a row of size zero is dependent. The rows are overwritten by their
/// remainders.
///
/// ```
/// use sincro_math::orthogonalization::independent_rows;
///
/// let mut rows = vec![vec![1.0, 0.0, 1.0], vec![2.0, 0.0, 2.0], vec![0.0, 1.0, 0.0]];
/// assert_eq!(independent_rows(&mut rows, &[1.0, 1.0, 1.0], 1e-9), [1, 2]);
/// ```
#[must_use]
pub fn independent_rows(rows: &mut [Vec<f64>], sizes: &[f64], least: f64) -> Vec<usize> {
    let (m, n) = (rows.len(), rows.first().map_or(0, Vec::len));
    let mut independent = Vec::new();
    for _ in 0..m.min(n) {
        let share = |i: usize| norm(&rows[i]) / sizes[i];
        let is_left = |i: &usize| !independent.contains(i) && sizes[*i] > 0.0;
        let Some(best) = (0..m).filter(is_left).reduce(|a, b| if share(b) > share(a) { b } else { a }) else {
            break;
        };
        if share(best) <= least {
            break;
        }
        let size = norm(&rows[best]);
        let unit: Vec<f64> = rows[best].iter().map(|x| x / size).collect();
        rows.iter_mut().for_each(|row| remove(row, &unit));
        independent.push(best);
    }
    independent.sort_unstable();
    independent
}

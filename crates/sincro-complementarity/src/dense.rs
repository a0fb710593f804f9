//! Dense linear system solved by elimination with pivoting, complete where pivots are small: reveals the rank, and
//! redundant unknowns get zero. Rows and columns are first scaled to a unit diagonal, so that the rank does not depend
//! on masses and units.

use sincro_math::{Real, Task};

/// Rank tolerance: scaled pivots below this are rounding, their rows depend on the others.
pub(crate) const RANK: f64 = 1e-11;

/// Rank tolerance of projections: close to a singular position of a loop (0.2° off one for arms of equal length) an
/// error of a thousandth of a micrometre across the loop is a micrometre along it, and correcting it would move the
/// mechanism to another branch.
pub const PROJECTION_RANK: f64 = 1e-5;

/// Scaled pivots on the diagonal above this are accepted without a search.
const LARGE: f64 = 0.05;

/// Matrix, right-hand side and orders of elimination; grows to the largest system it has seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Dense<R> {
    pub n: usize,
    a: Vec<R>,
    pub rhs: Vec<R>,
    columns: Vec<usize>,
    rows: Vec<usize>,
    scale: Vec<f64>,
    /// Rank found by the last [`Dense::solve`].
    pub rank: usize,
    /// Smallest pivot of the last [`Dense::solve`], of rows scaled to a unit diagonal: about the square of the smallest
    /// singular value of the rows relative to the largest.
    pub smallest_pivot: f64,
}

impl<R: Real> Dense<R> {
    /// Memory for systems of `n` unknowns.
    pub fn reserve(&mut self, n: usize) {
        let more = |len: usize, wanted: usize| wanted.saturating_sub(len);
        self.a.reserve(more(self.a.len(), n * n));
        self.rhs.reserve(more(self.rhs.len(), n));
        self.scale.reserve(more(self.scale.len(), n));
        self.columns.reserve(more(self.columns.len(), n));
        self.rows.reserve(more(self.rows.len(), n));
    }

    /// A system of `n` unknowns, all zero.
    pub fn reset(&mut self, n: usize) {
        self.n = n;
        self.a.clear();
        self.a.resize(n * n, R::zero());
        self.rhs.clear();
        self.rhs.resize(n, R::zero());
        self.columns.clear();
        self.columns.extend(0..n);
        self.rows.clear();
        self.rows.extend(0..n);
    }

    pub fn set(&mut self, i: usize, j: usize, x: R) {
        self.a[i * self.n + j] = x;
    }

    pub fn add(&mut self, i: usize, j: usize, x: R) {
        self.a[i * self.n + j] += x;
    }

    pub fn get(&self, i: usize, j: usize) -> R {
        self.a[i * self.n + j]
    }

    #[inline(always)]
    fn normalize(&mut self) {
        let n = self.n;
        self.scale.clear();
        for i in 0..n {
            let d = self.a[i * n + i].lane(0).abs();
            self.scale.push(if d > 0.0 && d.is_finite() { 1.0 / d.sqrt() } else { 1.0 });
        }
        for i in 0..n {
            for j in 0..n {
                self.a[i * n + j] *= R::splat(self.scale[i] * self.scale[j]);
            }
            self.rhs[i] *= R::splat(self.scale[i]);
        }
    }

    /// Solves the system; unknowns that nothing determines, to the tolerance `rank`, are zero. The matrix is
    /// overwritten.
    pub fn solve(&mut self, rank: f64, out: &mut [R]) {
        R::run_hot(Elimination { dense: self, rank, out });
    }

    /// [`Dense::solve`] as a part of another task.
    #[inline(always)]
    pub fn solve_part(&mut self, rank: f64, out: &mut [R]) {
        self.find(rank, out);
    }

    /// Combinations of unknowns that the last [`Dense::solve`] found to have no effect, `n − rank` of them: row `i` of
    /// `out` has the shares of unknown `i` in each.
    #[inline(always)]
    pub fn kernel(&self, out: &mut [R], sums: &mut Vec<R>) {
        self.substitute(&self.columns, |i, j| self.a[i * self.n + j], out, sums);
    }

    /// Combinations of rows that the last [`Dense::solve`] found to vanish, as [`Dense::kernel`].
    #[inline(always)]
    pub fn left_kernel(&self, out: &mut [R], sums: &mut Vec<R>) {
        // elimination leaves the multiples of its pivots below them
        self.substitute(&self.rows, |i, j| self.a[j * self.n + i], out, sums);
    }

    /// Solves U x = −u for the columns u beyond the rank, all at once.
    #[inline(always)]
    fn substitute(&self, order: &[usize], entry: impl Fn(usize, usize) -> R, out: &mut [R], sums: &mut Vec<R>) {
        let (rank, redundant) = (self.rank, self.n - self.rank);
        out.fill(R::zero());
        for k in 0..redundant {
            out[order[rank + k] * redundant + k] = R::one();
        }
        for i in (0..rank).rev() {
            sums.clear();
            sums.extend((0..redundant).map(|k| -entry(i, rank + k)));
            for j in i + 1..rank {
                let (factor, known) = (entry(i, j), order[j] * redundant);
                for (sum, x) in sums.iter_mut().zip(&out[known..known + redundant]) {
                    *sum -= factor * *x;
                }
            }
            let at = order[i] * redundant;
            for (x, sum) in out[at..at + redundant].iter_mut().zip(&*sums) {
                *x = *sum / entry(i, i);
            }
        }
        for (row, scale) in out.chunks_exact_mut(redundant).zip(&self.scale) {
            for x in row {
                *x *= R::splat(*scale);
            }
        }
    }

    #[inline(always)]
    fn find(&mut self, rank: f64, out: &mut [R]) {
        self.normalize();
        let n = self.n;
        (self.rank, self.smallest_pivot) = (n, 1.0);
        for k in 0..n {
            let (p, q, size) = self.pivot(k);
            self.smallest_pivot = self.smallest_pivot.min(size);
            if size <= rank {
                self.rank = k;
                break;
            }
            self.swap(k, p, q);
            self.eliminate(k);
        }
        out[..n].fill(R::zero());
        for k in (0..self.rank).rev() {
            let mut sum = self.rhs[k];
            for j in k + 1..self.rank {
                sum -= self.a[k * n + j] * out[self.columns[j]];
            }
            out[self.columns[k]] = sum / self.a[k * n + k];
        }
        for (x, scale) in out.iter_mut().zip(&self.scale) {
            *x *= R::splat(*scale);
        }
    }

    /// Row, column and size of the next pivot: the next one unless it is small, else the largest of the diagonal, and
    /// where all that is left of it is small, the largest of all.
    #[inline(always)]
    fn pivot(&self, k: usize) -> (usize, usize, f64) {
        let n = self.n;
        let size = |i: usize, j: usize| self.a[i * n + j].lane(0).abs();
        if size(k, k) > LARGE {
            return (k, k, size(k, k));
        }
        let d = (k + 1..n).fold(k, |d, i| if size(i, i) > size(d, d) { i } else { d });
        if size(d, d) > LARGE {
            return (d, d, size(d, d));
        }
        let (mut best, mut largest) = ((k, k), -1.0);
        for i in k..n {
            for j in k..n {
                if size(i, j) > largest {
                    (best, largest) = ((i, j), size(i, j));
                }
            }
        }
        (best.0, best.1, largest)
    }

    #[inline(always)]
    fn swap(&mut self, k: usize, p: usize, q: usize) {
        let n = self.n;
        if p != k {
            for j in 0..n {
                self.a.swap(k * n + j, p * n + j);
            }
            self.rhs.swap(k, p);
            self.rows.swap(k, p);
        }
        if q != k {
            for i in 0..n {
                self.a.swap(i * n + k, i * n + q);
            }
            self.columns.swap(k, q);
        }
    }

    #[inline(always)]
    fn eliminate(&mut self, k: usize) {
        let n = self.n;
        let inverse = R::one() / self.a[k * n + k];
        // bodies on each other couple neighbours alone: nothing is taken away beyond the last entry of the pivot's row
        let row = &self.a[k * n..k * n + n];
        let end = (k + 1..n).rev().find(|j| row[*j] != R::zero()).map_or(k + 1, |last| last + 1);
        for i in k + 1..n {
            let factor = self.a[i * n + k] * inverse;
            if factor == R::zero() {
                continue;
            }
            let (above, below) = self.a.split_at_mut(i * n);
            for (x, p) in below[k + 1..end].iter_mut().zip(&above[k * n + k + 1..k * n + end]) {
                *x -= factor * *p;
            }
            let of_pivot = self.rhs[k];
            self.rhs[i] -= factor * of_pivot;
        }
    }
}

struct Elimination<'a, R> {
    dense: &'a mut Dense<R>,
    rank: f64,
    out: &'a mut [R],
}

impl<R: Real> Task for Elimination<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.dense.find(self.rank, self.out);
    }
}

/// A regular system factored once and solved many times: elimination with row pivoting.
#[derive(Clone, Debug, Default)]
pub(crate) struct Factor {
    n: usize,
    lu: Vec<f64>,
    order: Vec<usize>,
    work: Vec<f64>,
}

impl Factor {
    /// Factors a matrix given row by row.
    pub fn factor(&mut self, n: usize, matrix: impl Fn(usize, usize) -> f64) {
        self.n = n;
        self.lu.clear();
        self.lu.extend((0..n * n).map(|k| matrix(k / n, k % n)));
        self.order.clear();
        self.order.extend(0..n);
        for k in 0..n {
            let p = (k + 1..n).fold(k, |p, i| if self.lu[i * n + k].abs() > self.lu[p * n + k].abs() { i } else { p });
            if p != k {
                for j in 0..n {
                    self.lu.swap(k * n + j, p * n + j);
                }
                self.order.swap(k, p);
            }
            let inverse = 1.0 / self.lu[k * n + k];
            let (above, below) = self.lu.split_at_mut((k + 1) * n);
            let pivot = &above[k * n + k + 1..];
            for row in below.chunks_exact_mut(n) {
                let factor = row[k] * inverse;
                row[k] = factor;
                if factor != 0.0 {
                    for (x, p) in row[k + 1..].iter_mut().zip(pivot) {
                        *x -= factor * *p;
                    }
                }
            }
        }
    }

    /// Replaces a right-hand side by the solution.
    pub fn solve(&mut self, x: &mut [f64]) {
        let n = self.n;
        self.work.clear();
        self.work.extend(self.order.iter().map(|k| x[*k]));
        for i in 0..n {
            let row = &self.lu[i * n..i * n + i];
            let sum: f64 = row.iter().zip(&self.work).map(|(l, y)| l * y).sum();
            self.work[i] -= sum;
        }
        for i in (0..n).rev() {
            let row = &self.lu[i * n..(i + 1) * n];
            let sum: f64 = row[i + 1..].iter().zip(&self.work[i + 1..]).map(|(u, y)| u * y).sum();
            self.work[i] = (self.work[i] - sum) / row[i];
        }
        x.copy_from_slice(&self.work);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_system_is_solved_and_a_redundant_row_is_told() {
        let mut d = Dense::<f64>::default();
        let a = [[2.0, 1.0, 3.0], [1.0, 4.0, 4.0], [3.0, 5.0, 7.0]];
        d.reset(3);
        for i in 0..3 {
            for j in 0..3 {
                d.set(i, j, a[i][j]);
            }
            // of x = (1, −2, 1)
            d.rhs[i] = a[i][0] - 2.0 * a[i][1] + a[i][2];
        }
        let mut x = [9.0; 3];
        d.solve(RANK, &mut x);
        assert_eq!(d.rank, 2);
        for i in 0..3 {
            let r: f64 = (0..3).map(|j| a[i][j] * (x[j] - [1.0, -2.0, 1.0][j])).sum();
            assert!(r.abs() < 1e-14);
        }
    }
}

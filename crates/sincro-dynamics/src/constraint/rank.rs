//! Rank of the equations of loop joints and gears, and a set of independent ones.
//!
//! A closed loop has more equations than it takes away degrees of freedom: a planar four-bar with a hinge has five, of
//! which two act. The rank is decided on the rows of J M^(−1/2) (the innovations of the articulated-body recursion,
//! whose products are G) by Gram–Schmidt elimination with pivoting; elimination on G itself would see the square of a
//! remainder. A row counts if its remainder exceeds [`INDEPENDENT`] of its *size*: the norm of the velocities of both
//! ends of the joint before they are projected on an axis and subtracted, in the same metric. An idle row,
//! perpendicular to the plane of a loop say, is rounding by that measure, whatever the frame, the units and the masses;
//! by its own norm it would be as good as any other.
//!
//! Source: key `golub2013`, section 5.4 (rank by pivoted orthogonalisation).

use sincro_math::orthogonalization::{independent_rows, norm};

use super::Constraints;
use crate::model::Model;
use crate::scratch::Scratch;

/// Least remainder of an independent row relative to its size, at a configuration that closes the loops.
pub(crate) const INDEPENDENT: f64 = 1e-9;

/// The same while loops are being closed: the rows of an overconstrained spatial loop are independent in proportion to
/// its residual.
pub(crate) const INDEPENDENT_OPEN: f64 = 1e-3;

impl Constraints<f64> {
    /// Independent bilateral rows among those assembled, after `factor`, to the relative tolerance `least`: indices
    /// in ascending order into `independent`.
    pub fn find_independent_rows(
        &mut self,
        model: &Model<f64>,
        scratch: &Scratch<f64>,
        least: f64,
        independent: &mut Vec<usize>,
    ) {
        let (m, n) = (self.rows.len(), model.n_v());
        let sizes = self.row_sizes(model, scratch);
        let mut rows = vec![vec![0.0; n]; m];
        let values = self.delassus_factors.factors(model, scratch, self.motions.columns(), &self.rows);
        for (k, values) in values.chunks_exact(m.max(1)).enumerate() {
            for (row, x) in rows.iter_mut().zip(values) {
                row[k] = *x;
            }
        }
        let squares: Vec<f64> = rows.iter().map(|row| norm(row) * norm(row)).collect();
        independent.clear();
        independent.extend(independent_rows(&mut rows, &sizes, least));
        self.row_sizes.clear();
        self.row_sizes.extend(independent.iter().map(|i| sizes[*i] * sizes[*i]));
        self.row_squares.clear();
        self.row_squares.extend(independent.iter().map(|i| squares[*i]));
    }

    /// Size of each assembled bilateral row.
    fn row_sizes(&mut self, model: &Model<f64>, scratch: &Scratch<f64>) -> Vec<f64> {
        let set = &*model.params.constraints;
        let mut sizes = Vec::with_capacity(self.rows.len());
        let mut ends = Vec::new();
        for joint in &set.loop_joints {
            ends.clear();
            joint.end_rows(scratch, &mut ends);
            let values = self.delassus_factors.factors(model, scratch, self.motions.columns(), &ends);
            let square = |range: core::ops::Range<usize>| {
                let of_dof = |v: &[f64]| v[range.clone()].iter().map(|x| x * x).sum::<f64>();
                values.chunks_exact(ends.len()).map(of_dof).sum::<f64>().sqrt()
            };
            let (translation, rotation) = (square(0..6), square(6..12));
            for k in 0..joint.kind.rows() {
                sizes.push(if k < joint.kind.n_translations() { translation } else { rotation });
            }
        }
        let first = sizes.len();
        let values = self.delassus_factors.factors(model, scratch, self.motions.columns(), &self.rows[first..]);
        let m = self.rows.len() - first;
        sizes.extend((0..m).map(|i| values.iter().skip(i).step_by(m).map(|x| x * x).sum::<f64>().sqrt()));
        sizes
    }

    /// Uses only these of the bilateral rows from now on.
    pub fn use_rows(&mut self, independent: &[usize], n_bilateral: usize) {
        self.is_independent.clear();
        self.is_independent.resize(n_bilateral, false);
        independent.iter().for_each(|i| self.is_independent[*i] = true);
    }

    /// Uses all bilateral rows again.
    pub fn use_all_rows(&mut self) {
        self.is_independent.fill(true);
    }

    /// Keeps these of the assembled rows as equations, for a projection.
    pub fn keep_rows(&mut self, kept: &[usize]) {
        for (into, from) in kept.iter().enumerate() {
            self.rows[into] = self.rows[*from];
            self.residual[into] = self.residual[*from];
        }
        self.n_free = kept.len();
        self.keep_loop_joints();
    }
}

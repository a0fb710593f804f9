//! Which states the inputs reach and the outputs see. Cost: n³.
//!
//! The reachable subspace is spanned by `B, AB, A²B, …`. The columns are made orthogonal as they come, each new one
//! from the last orthogonal one (block Arnoldi, key `golub2013`, 10.5): powers of A never appear, so stiff systems do
//! not drown in rounding as they do in the singular values of the controllability matrix.

use super::{Axis, DMatrix, DVector, StateSpace};

/// Norm below which the remainder of a unit vector, after removal of its components along others, is rounding.
const NOTHING: f64 = 1e-11;

/// Dimension of the controllable or observable subspace of a system; result of [`StateSpace::controllability`] and
/// [`StateSpace::observability`].
#[derive(Clone, Debug, PartialEq)]
pub struct SubspaceRank {
    /// Dimension of the subspace, 0 to `n_states`.
    pub rank: usize,
    /// Number of states; the system is controllable (or observable) if `rank` is the same.
    pub n_states: usize,
    /// Indices of the states (from 0, ascending) that lie wholly outside the subspace: that no input moves, or no
    /// output shows.
    pub outside: Vec<usize>,
}

impl SubspaceRank {
    /// Returns true if the subspace is the whole state space: the system is controllable, or observable.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.rank == self.n_states
    }
}

impl StateSpace {
    /// Returns the dimension of the controllable subspace, which all inputs together reach, and the states outside of
    /// it.
    ///
    /// ```
    /// use sincro_analysis::prelude::*;
    ///
    /// # fn main() -> Result<(), LinearError> {
    /// // two separate lags, of which the input drives the first
    /// let a = DMatrix::from_row_slice(2, 2, &[-1.0, 0.0, 0.0, -2.0]);
    /// let (b, c) = (DMatrix::from_row_slice(2, 1, &[1.0, 0.0]), DMatrix::from_row_slice(1, 2, &[1.0, 1.0]));
    /// let system = StateSpace::from_matrices(a, b, c, DMatrix::zeros(1, 1))?;
    /// assert_eq!((system.controllability().rank, system.controllability().outside), (1, vec![1]));
    /// assert!(system.observability().is_full());
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn controllability(&self) -> SubspaceRank {
        krylov_rank(&self.a, &self.b)
    }

    /// Returns the dimension of the observable subspace, which all outputs together see, and the states outside of it.
    #[must_use]
    pub fn observability(&self) -> SubspaceRank {
        krylov_rank(&self.a.transpose(), &self.c.transpose())
    }

    /// Returns the minimal realisation of one channel, a system with one input, one output and the same transfer
    /// function: modes that the input does not reach or the output does not see are left out. Its states are
    /// combinations of the original ones, named `x1`, `x2`, … without units.
    ///
    /// # Panics
    ///
    /// If `input` or `output` is no index of an input or output.
    #[must_use]
    pub fn minimal(&self, input: usize, output: usize) -> Self {
        let (b, c) = (self.b.columns(input, 1).into_owned(), self.c.rows(output, 1).into_owned());
        let (a, b, c) = within(&krylov_basis(&self.a, &b), &self.a, &b, &c);
        let (a, b, c) = within(&krylov_basis(&a.transpose(), &c.transpose()), &a, &b, &c);
        Self {
            states: (1..=a.nrows()).map(|k| Axis::new(format!("x{k}"), "")).collect(),
            inputs: vec![self.inputs[input].clone()],
            outputs: vec![self.outputs[output].clone()],
            d: DMatrix::from_element(1, 1, self.d[(output, input)]),
            t: self.t,
            sample_time: self.sample_time,
            a,
            b,
            c,
        }
    }
}

/// The system in coordinates along an orthonormal basis.
fn within(
    basis: &[DVector<f64>],
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    c: &DMatrix<f64>,
) -> (DMatrix<f64>, DMatrix<f64>, DMatrix<f64>) {
    let q = DMatrix::from_fn(a.nrows(), basis.len(), |row, column| basis[column][row]);
    (q.transpose() * a * &q, q.transpose() * b, c * q)
}

/// Rank and unreached states of the Krylov subspace `span(B, A B, A² B, …)`.
fn krylov_rank(a: &DMatrix<f64>, b: &DMatrix<f64>) -> SubspaceRank {
    let n_states = a.nrows();
    let basis = krylov_basis(a, b);
    let share = |state: usize| basis.iter().map(|q| q[state] * q[state]).sum::<f64>();
    let outside = (0..n_states).filter(|&state| share(state) <= NOTHING).collect();
    SubspaceRank { rank: basis.len(), n_states, outside }
}

/// Orthonormal basis of the Krylov subspace `span(B, A B, A² B, …)`, vectors of n_states.
fn krylov_basis(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Vec<DVector<f64>> {
    let rate = a.norm();
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for column in b.column_iter() {
        let size = column.norm();
        if size > 0.0 {
            push_new_direction(&mut basis, column / size);
        }
    }
    let mut next = 0;
    while next < basis.len() && rate > 0.0 {
        let driven = a * &basis[next] / rate;
        push_new_direction(&mut basis, driven);
        next += 1;
    }
    basis
}

/// Adds the component of a vector orthogonal to the basis, normalised, unless it is rounding alone.
fn push_new_direction(basis: &mut Vec<DVector<f64>>, mut vector: DVector<f64>) {
    // twice is enough: the second time takes away what rounding left of the first
    for _ in 0..2 {
        for q in basis.iter() {
            let along = q.dot(&vector);
            vector -= q * along;
        }
    }
    let size = vector.norm();
    if size > NOTHING && basis.len() < vector.len() {
        basis.push(vector / size);
    }
}

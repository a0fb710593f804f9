//! Which states the inputs reach and the outputs see. Cost: n³.
//!
//! The reachable subspace is spanned by `B, AB, A²B, …`. The columns are made orthogonal as they come, each new one
//! from the last orthogonal one (block Arnoldi, key `golub2013`, 10.5): powers of A never appear, so stiff systems do
//! not drown in rounding as they do in the singular values of the controllability matrix.

use super::{Axis, DMatrix, DVector, StateSpace};

/// Norm below which the remainder of a unit vector, after removal of its components along others, is rounding.
const NOTHING: f64 = 1e-11;

/// Dimension of the controllable or observable subspace.
#[derive(Clone, Debug, PartialEq)]
pub struct SubspaceRank {
    /// Dimension of the subspace.
    pub rank: usize,
    /// Number of states; the system is controllable (or observable) if `rank` is the same.
    pub n_states: usize,
    /// States that lie wholly outside the subspace, by index.
    pub outside: Vec<usize>,
}

impl SubspaceRank {
    /// Returns true if it is the whole space.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.rank == self.n_states
    }
}

impl StateSpace {
    /// Dimension of the controllable subspace, and the states outside of it.
    #[must_use]
    pub fn controllability(&self) -> SubspaceRank {
        krylov_rank(&self.a, &self.b)
    }

    /// Dimension of the observable subspace, and the states outside of it.
    #[must_use]
    pub fn observability(&self) -> SubspaceRank {
        krylov_rank(&self.a.transpose(), &self.c.transpose())
    }

    /// One channel without the modes that its input does not reach or its output does not see: the same transfer
    /// function by the fewest states, which have no names.
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

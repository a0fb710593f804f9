//! Symmetric 3×3 matrices: rotational inertias, the diagonal blocks of an articulated inertia.

use sincro_math::Real;

use super::{Mat3, Vec3};

/// Symmetric 3×3 matrix, stored as its upper triangle by rows: xx, xy, xz, yy, yz, zz. For rotational inertias and the
/// diagonal blocks of articulated ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sym3<R>(pub [R; 6]);

/// Index of element (i, j) in the packed triangle.
const PACKED: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

/// The element at each place of the packed triangle.
pub(super) const ELEMENTS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

impl<R: Real> Sym3<R> {
    /// Symmetric matrix of zeros, of any unit.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([R::zero(); 6])
    }

    /// Product of the scalar `k` with the identity matrix, in the unit of `k`.
    #[inline(always)]
    pub fn scalar(k: R) -> Self {
        let o = R::zero();
        Self([k, o, o, k, o, k])
    }

    /// Symmetric matrix of the constants xx, xy, xz, yy, yz, zz, in this order, in numbers of type `R`; the units stay.
    pub fn splat(m: [f64; 6]) -> Self {
        Self(m.map(R::splat))
    }

    /// Symmetric matrix with the elements `f(i, j)`, 0 ≤ i ≤ j ≤ 2, in one unit.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize, usize) -> R) -> Self {
        Self([f(0, 0), f(0, 1), f(0, 2), f(1, 1), f(1, 2), f(2, 2)])
    }

    /// Element of row `i` and column `j`, each 0, 1 or 2, in the unit of the entries. Panics for other indices.
    #[inline(always)]
    pub fn at(&self, i: usize, j: usize) -> R {
        self.0[PACKED[i][j]]
    }

    /// Sets elements (i, j) and (j, i) to `x`, in the unit of the entries; indices 0, 1 or 2. Panics for others.
    #[inline(always)]
    pub fn set(&mut self, i: usize, j: usize, x: R) {
        self.0[PACKED[i][j]] = x;
    }

    /// Column (or row) `k`, 0, 1 or 2, in the unit of the entries. Panics for other indices.
    #[inline(always)]
    pub fn col(&self, k: usize) -> Vec3<R> {
        Vec3([self.at(0, k), self.at(1, k), self.at(2, k)])
    }

    /// Product of the matrix with a vector; the units multiply.
    #[inline(always)]
    pub fn mul_vec(&self, v: Vec3<R>) -> Vec3<R> {
        Vec3([self.col(0).dot(v), self.col(1).dot(v), self.col(2).dot(v)])
    }

    /// Vector x with `self·x = v`, by Cramer's rule, in the unit of `v` over that of the entries; zero for a singular
    /// matrix.
    #[inline(always)]
    pub fn solve(&self, v: Vec3<R>) -> Vec3<R> {
        let [a, b, c] = [self.col(0), self.col(1), self.col(2)];
        let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
        let determinant = a.dot(cofactors[0]);
        let share = R::zero().if_less(determinant.abs(), R::one() / determinant, R::zero());
        Vec3(cofactors.map(|cofactor| cofactor.dot(v) * share))
    }

    /// Mean of the gyroscopic torque ω×L of this rotational inertia [kg·m²] over a step of length `h` `[s]` of free
    /// rotation that begins at `omega` `[rad/s]`, in the axes of the body `[N·m]`: (L − cay(−h ω_m) L)/h with cay the
    /// Cayley transform, a rotation, and ω_m the angular velocity in the middle of the step. So |L| does not change,
    /// and the kinetic energy to third order.
    #[inline(always)]
    pub fn mean_gyroscopic_torque(&self, omega: Vec3<R>, h: f64) -> Vec3<R> {
        let half = R::splat(0.5 * h);
        let momentum = self.mul_vec(omega);
        let middle = omega - self.solve(omega.cross(momentum)).scale(half);
        let (turn, once) = (middle.scale(half), middle.cross(momentum));
        (once - turn.cross(once)).scale(R::one() / (R::one() + turn.dot(turn)))
    }

    /// Same matrix with all nine entries, in their unit.
    #[inline(always)]
    pub fn full(&self) -> Mat3<R> {
        Mat3([self.col(0).0, self.col(1).0, self.col(2).0])
    }

    /// Sum `self + b` of matrices of one unit.
    #[inline(always)]
    pub fn plus(&self, b: &Self) -> Self {
        let mut out = *self;
        for k in 0..6 {
            out.0[k] += b.0[k];
        }
        out
    }

    /// Difference `self − a·bᵀ` for parallel `a` and `b`, so that it is symmetric; the product has the unit of the
    /// entries.
    #[inline(always)]
    pub fn minus_outer(&self, a: Vec3<R>, b: Vec3<R>) -> Self {
        let mut out = *self;
        for (k, (i, j)) in ELEMENTS.into_iter().enumerate() {
            out.0[k] -= a[i] * b[j];
        }
        out
    }

    /// Congruence `E·self·Eᵀ` with the rotation `E` about coordinate axis `A` (0, 1, 2) by the angle with this sine and
    /// cosine; the unit stays.
    #[inline(always)]
    pub fn rotated<const A: usize>(&self, sin: R, cos: R) -> Self {
        let (b, c) = ((A + 1) % 3, (A + 2) % 3);
        let (bb, bc, cc) = (self.at(b, b), self.at(b, c), self.at(c, c));
        let (ab, ac) = (self.at(A, b), self.at(A, c));
        // rows first, then columns of the (b, c) block
        let (t_bb, t_bc) = (cos * bb - sin * bc, cos * bc - sin * cc);
        let (t_cb, t_cc) = (sin * bb + cos * bc, sin * bc + cos * cc);
        let mut out = *self;
        out.0[PACKED[A][b]] = cos * ab - sin * ac;
        out.0[PACKED[A][c]] = sin * ab + cos * ac;
        out.0[PACKED[b][b]] = t_bb * cos - t_bc * sin;
        out.0[PACKED[b][c]] = t_bb * sin + t_bc * cos;
        out.0[PACKED[c][c]] = t_cb * sin + t_cc * cos;
        out
    }
}

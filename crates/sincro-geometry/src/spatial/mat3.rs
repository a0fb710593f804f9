//! General 3×3 matrices: rotations and the coupling block of an articulated inertia.

use sincro_math::Real;

use super::Vec3;
use super::sym3::{ELEMENTS, Sym3};

/// Matrix of 3×3 numbers, stored by rows (`m.0[i][j]` is row i, column j). As a rotation `r_ab` it takes components in
/// frame B to components in frame A.
///
/// ```
/// use sincro_geometry::spatial::{Mat3, Vec3};
///
/// // a quarter of a turn about z takes x to y; a rotation times its transpose is the identity
/// let (sin, cos) = (1.0, 0.0);
/// let r_ab = Mat3::rotation::<2>(sin, cos);
/// assert_eq!(r_ab.mul_vec(Vec3([1.0, 0.0, 0.0])), Vec3([0.0, 1.0, 0.0]));
/// assert_eq!(r_ab.mul(&r_ab.transpose()), Mat3::identity());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mat3<R>(pub [[R; 3]; 3]);

impl<R: Real> Mat3<R> {
    /// Identity matrix, dimensionless.
    #[inline(always)]
    pub fn identity() -> Self {
        let (o, l) = (R::zero(), R::one());
        Self([[l, o, o], [o, l, o], [o, o, l]])
    }

    /// Matrix of zeros, of any unit.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([[R::zero(); 3]; 3])
    }

    /// Matrix of the constants `m`, given by rows, in numbers of type `R`; the units stay.
    #[inline(always)]
    pub fn splat(m: [[f64; 3]; 3]) -> Self {
        let [x, y, z] = m;
        Self([Vec3::splat(x).0, Vec3::splat(y).0, Vec3::splat(z).0])
    }

    /// Rotation about coordinate axis `A` (0 is x, 1 y, 2 z) by the angle with this sine and cosine (dimensionless):
    /// takes components in the turned frame to components in the fixed one.
    #[inline(always)]
    pub fn rotation<const A: usize>(sin: R, cos: R) -> Self {
        let (b, c) = ((A + 1) % 3, (A + 2) % 3);
        let mut m = Self::identity();
        m.0[b][b] = cos;
        m.0[b][c] = -sin;
        m.0[c][b] = sin;
        m.0[c][c] = cos;
        m
    }

    /// Skew-symmetric matrix of `v`, in its unit: `skew(v).mul_vec(b)` is `v × b`.
    #[inline(always)]
    pub fn skew(v: Vec3<R>) -> Self {
        let o = R::zero();
        Self([[o, -v[2], v[1]], [v[2], o, -v[0]], [-v[1], v[0], o]])
    }

    /// Column `k` (0, 1 or 2), in the unit of the entries. Panics for other indices.
    #[inline(always)]
    pub fn col(&self, k: usize) -> Vec3<R> {
        Vec3([self.0[0][k], self.0[1][k], self.0[2][k]])
    }

    /// Row `k` (0, 1 or 2), in the unit of the entries. Panics for other indices.
    #[inline(always)]
    pub fn row(&self, k: usize) -> Vec3<R> {
        Vec3(self.0[k])
    }

    /// Transposed matrix; of a rotation `r_ab` the inverse, `r_ba`.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        Self([self.col(0).0, self.col(1).0, self.col(2).0])
    }

    /// Product of the matrix with a vector; the units multiply.
    #[inline(always)]
    pub fn mul_vec(&self, v: Vec3<R>) -> Vec3<R> {
        Vec3([self.row(0).dot(v), self.row(1).dot(v), self.row(2).dot(v)])
    }

    /// Product of the transposed matrix with a vector; the units multiply.
    #[inline(always)]
    pub fn tr_mul_vec(&self, v: Vec3<R>) -> Vec3<R> {
        Vec3([self.col(0).dot(v), self.col(1).dot(v), self.col(2).dot(v)])
    }

    /// Matrix product `self · b`; the units multiply.
    #[inline(always)]
    pub fn mul(&self, b: &Self) -> Self {
        let mut out = Self::zero();
        for i in 0..3 {
            for j in 0..3 {
                out.0[i][j] = self.row(i).dot(b.col(j));
            }
        }
        out
    }

    /// Sum `self + b` of matrices of one unit.
    #[inline(always)]
    pub fn plus(&self, b: &Self) -> Self {
        let mut out = *self;
        for i in 0..3 {
            for j in 0..3 {
                out.0[i][j] += b.0[i][j];
            }
        }
        out
    }

    /// Congruence `self · m · selfᵀ` of a symmetric `m`: for a rotation `r_ab` the tensor `m` of B in the axes of A, in
    /// its unit.
    #[inline(always)]
    pub fn congruence_sym(&self, m: &Sym3<R>) -> Sym3<R> {
        let t = [m.mul_vec(self.row(0)), m.mul_vec(self.row(1)), m.mul_vec(self.row(2))];
        let mut out = Sym3::zero();
        for (k, (i, j)) in ELEMENTS.into_iter().enumerate() {
            out.0[k] = t[i].dot(self.row(j));
        }
        out
    }

    /// Congruence `self · m · selfᵀ` of any matrix `m`: for a rotation `r_ab` the tensor `m` of B in the axes of A, in
    /// its unit.
    #[inline(always)]
    pub fn congruence(&self, m: &Self) -> Self {
        self.mul(m).mul(&self.transpose())
    }
}

//! Inertias: of a rigid body (ten numbers) and articulated (twenty-one).
//!
//! In blocks, angular part first, about the origin of the frame they are expressed in:
//!
//! ```text
//!     rigid:  [ I   h× ]      articulated:  [ I   H ]     wrench = inertia · acceleration
//!             [ −h× m  ]                    [ Hᵀ  M ]
//! ```
//!
//! Source: key `featherstone2008`, sections 2.13 and 7.1.

use sincro_math::Real;

use super::sym3::{ELEMENTS, Sym3};
use super::{Force, Mat3, Motion, Vec3};

/// Spatial inertia of a rigid body about the origin of its frame, in the axes of that frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidInertia<R> {
    /// Mass m `[kg]`.
    pub mass: R,
    /// First moment of mass h = m·c `[kg·m]`, c the centre of mass in the frame.
    pub moment: Vec3<R>,
    /// Rotational inertia about the frame's origin [kg·m²].
    pub rotational: Sym3<R>,
}

impl<R: Real> RigidInertia<R> {
    /// Inertia without mass: all ten numbers zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { mass: R::zero(), moment: Vec3::zero(), rotational: Sym3::zero() }
    }

    /// Spatial inertia about the frame's origin from `mass` `[kg]`, centre of mass `com` `[m]` and rotational inertia
    /// about the centre of mass `[kg·m²]`, all in the frame's axes (parallel axis theorem).
    pub fn from_center_of_mass(mass: R, com: Vec3<R>, inertia: &Sym3<R>) -> Self {
        // Steiner: I_o = I_c + m (|c|² 1 − c cᵀ)
        let cc = com.dot(com);
        let steiner = Sym3::from_fn(|i, j| {
            let diagonal = if i == j { cc } else { R::zero() };
            mass * (diagonal - com[i] * com[j])
        });
        Self { mass, moment: com.scale(mass), rotational: inertia.plus(&steiner) }
    }

    /// Centre of mass c `[m]`, in the frame; its origin for an inertia without mass.
    #[inline(always)]
    pub fn center_of_mass(&self) -> Vec3<R> {
        self.moment.scale(R::zero().if_less(self.mass, R::one() / self.mass, R::zero()))
    }

    /// Spatial momentum `I·v` of the body moving with the twist `v` (`[rad/s]`, `[m/s]`): angular part about the origin
    /// `[kg·m²/s]`, linear part `[kg·m/s]`. With a spatial acceleration instead, the wrench `[N·m]`, `[N]`.
    #[inline(always)]
    pub fn mul(&self, v: &Motion<R>) -> Force<R> {
        Force {
            ang: self.rotational.mul_vec(v.ang) + self.moment.cross(v.lin),
            lin: v.lin.scale(self.mass) - self.moment.cross(v.ang),
        }
    }

    /// Sum of two inertias given in the same frame: that of the two bodies fixed to each other.
    #[inline(always)]
    pub fn plus(&self, b: &Self) -> Self {
        Self {
            mass: self.mass + b.mass,
            moment: self.moment + b.moment,
            rotational: self.rotational.plus(&b.rotational),
        }
    }

    /// Same inertia about the origin of another frame, in which this one's origin lies at `r` `[m]`; axes parallel.
    #[inline(always)]
    pub fn shifted(&self, r: Vec3<R>) -> Self {
        // I' = I + (2 r·h + m r²) 1 − r hᵀ − h rᵀ − m r rᵀ,  h' = h + m r
        let h = self.moment;
        let k = h + r.scale(self.mass);
        let diag = r.dot(h + k);
        let mut rotational = self.rotational;
        for (e, (i, j)) in ELEMENTS.into_iter().enumerate() {
            let d = if i == j { diag } else { R::zero() };
            rotational.0[e] += d - r[i] * k[j] - h[i] * r[j];
        }
        Self { mass: self.mass, moment: k, rotational }
    }

    /// Same inertia in other axes: `e` = R_ab takes components in B (of `self`) to components in A (of the result).
    #[inline(always)]
    pub fn turned(&self, e: &Mat3<R>) -> Self {
        Self { mass: self.mass, moment: e.mul_vec(self.moment), rotational: e.congruence_sym(&self.rotational) }
    }

    /// Same inertia in the general form of articulated bodies, in the same frame.
    #[inline(always)]
    pub fn articulated(&self) -> ArticulatedInertia<R> {
        ArticulatedInertia {
            rotational: self.rotational,
            coupling: Mat3::skew(self.moment),
            linear: Sym3::scalar(self.mass),
        }
    }
}

/// Articulated-body inertia: resistance of a link to acceleration together with all that hangs on it through joints,
/// about the origin of its frame. Intermediate result of the articulated-body algorithm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArticulatedInertia<R> {
    /// Rotational block I `[kg·m²]`: moment over angular acceleration.
    pub rotational: Sym3<R>,
    /// Coupling block H `[kg·m]`: moment over linear acceleration; its transpose is force over angular acceleration.
    pub coupling: Mat3<R>,
    /// Linear block M `[kg]`: force over linear acceleration; direction-dependent, unlike a mass.
    pub linear: Sym3<R>,
}

impl<R: Real> ArticulatedInertia<R> {
    /// Wrench (`[N·m]` about the origin, `[N]`) that gives the spatial acceleration `a` (`[rad/s²]`, `[m/s²]`), in the
    /// same frame.
    #[inline(always)]
    pub fn mul(&self, a: &Motion<R>) -> Force<R> {
        Force {
            ang: self.rotational.mul_vec(a.ang) + self.coupling.mul_vec(a.lin),
            lin: self.coupling.tr_mul_vec(a.ang) + self.linear.mul_vec(a.lin),
        }
    }

    /// Inertia `self − u·(ku)ᵀ` that remains when one degree of freedom is released: `u` is the inertia times the axis
    /// of the joint, `ku` is `u` over the inertia at the joint, a multiple of `u` (so that the result is symmetric).
    #[inline(always)]
    pub fn minus_outer(&self, u: &Force<R>, ku: &Force<R>) -> Self {
        let mut coupling = self.coupling;
        for i in 0..3 {
            for j in 0..3 {
                coupling.0[i][j] -= u.ang[i] * ku.lin[j];
            }
        }
        Self {
            rotational: self.rotational.minus_outer(u.ang, ku.ang),
            coupling,
            linear: self.linear.minus_outer(u.lin, ku.lin),
        }
    }

    /// Sum of two inertias given in the same frame.
    #[inline(always)]
    pub fn plus(&self, b: &Self) -> Self {
        Self {
            rotational: self.rotational.plus(&b.rotational),
            coupling: self.coupling.plus(&b.coupling),
            linear: self.linear.plus(&b.linear),
        }
    }

    /// Same inertia in other axes: components turned from child to parent axes, where the child is turned about
    /// coordinate axis `A` (0, 1, 2) by the angle with this sine and cosine.
    #[inline(always)]
    pub fn rotated<const A: usize>(&self, sin: R, cos: R) -> Self {
        let (b, c) = ((A + 1) % 3, (A + 2) % 3);
        let mut h = self.coupling;
        for j in 0..3 {
            let (x, y) = (h.0[b][j], h.0[c][j]);
            h.0[b][j] = cos * x - sin * y;
            h.0[c][j] = sin * x + cos * y;
        }
        for i in 0..3 {
            let (x, y) = (h.0[i][b], h.0[i][c]);
            h.0[i][b] = cos * x - sin * y;
            h.0[i][c] = sin * x + cos * y;
        }
        Self {
            rotational: self.rotational.rotated::<A>(sin, cos),
            coupling: h,
            linear: self.linear.rotated::<A>(sin, cos),
        }
    }

    /// Same inertia in other axes: `e` = R_ab takes components in B (of `self`) to components in A (of the result).
    #[inline(always)]
    pub fn turned(&self, e: &Mat3<R>) -> Self {
        Self {
            rotational: e.congruence_sym(&self.rotational),
            coupling: e.congruence(&self.coupling),
            linear: e.congruence_sym(&self.linear),
        }
    }

    /// Same inertia about the origin of another frame, in which this one's origin lies at `r` `[m]`; axes parallel.
    #[inline(always)]
    pub fn shifted(&self, r: Vec3<R>) -> Self {
        // G = H + r×M;  I' = I − H r× + r× Gᵀ
        let (h, m) = (&self.coupling.0, self.linear.full().0);
        let mut g = self.coupling;
        for i in 0..3 {
            let (p, q) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                g.0[i][j] += r[p] * m[q][j] - r[q] * m[p][j];
            }
        }
        let mut rotational = self.rotational;
        for (e, (i, j)) in ELEMENTS.into_iter().enumerate() {
            let (p, q) = ((i + 1) % 3, (i + 2) % 3);
            let (s, t) = ((j + 1) % 3, (j + 2) % 3);
            // (−H r×)_ij = r_s H_it − r_t H_is ;  (r× Gᵀ)_ij = r_p G_jq − r_q G_jp
            rotational.0[e] += (r[s] * h[i][t] - r[t] * h[i][s]) + (r[p] * g.0[j][q] - r[q] * g.0[j][p]);
        }
        Self { rotational, coupling: g, linear: self.linear }
    }

    /// Same as [`Self::shifted`] by `r` `[m]` along coordinate axis `K` (0, 1, 2), without the products by zero.
    #[inline(always)]
    pub fn shifted_along<const K: usize>(&self, r: R) -> Self {
        let (b, c) = ((K + 1) % 3, (K + 2) % 3);
        let (h, m) = (&self.coupling.0, &self.linear);
        // G = H + r×M touches rows b and c;  I' = I − H r× + r× Gᵀ
        let mut g = *h;
        for j in 0..3 {
            g[b][j] = h[b][j] - r * m.at(c, j);
            g[c][j] = h[c][j] + r * m.at(b, j);
        }
        let i = &self.rotational;
        let mut out = *i;
        out.set(K, b, i.at(K, b) - r * h[K][c]);
        out.set(K, c, i.at(K, c) + r * h[K][b]);
        out.set(b, b, i.at(b, b) - r * (h[b][c] + g[b][c]));
        out.set(b, c, i.at(b, c) + r * (h[b][b] - g[c][c]));
        out.set(c, c, i.at(c, c) + r * (h[c][b] + g[c][b]));
        Self { rotational: out, coupling: Mat3(g), linear: self.linear }
    }

    /// Sum with the inertia of a rigid body given in the same frame.
    #[inline(always)]
    pub fn plus_rigid(&self, b: &RigidInertia<R>) -> Self {
        let (mut h, mut m, [x, y, z]) = (self.coupling.0, self.linear, b.moment.0);
        h[0][1] -= z;
        h[0][2] += y;
        h[1][0] += z;
        h[1][2] -= x;
        h[2][0] -= y;
        h[2][1] += x;
        for k in 0..3 {
            m.set(k, k, m.at(k, k) + b.mass);
        }
        Self { rotational: self.rotational.plus(&b.rotational), coupling: Mat3(h), linear: m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> RigidInertia<f64> {
        let i = Sym3([0.3, 0.02, -0.01, 0.4, 0.03, 0.5]);
        RigidInertia::from_center_of_mass(2.5, Vec3([0.1, -0.2, 0.3]), &i)
    }

    fn close(a: &Force<f64>, b: &Force<f64>) -> bool {
        (a.ang - b.ang).norm() + (a.lin - b.lin).norm() < 1e-13
    }

    #[test]
    fn articulated_form_of_a_rigid_body_is_the_rigid_one() {
        let (rigid, r) = (sample(), Vec3([0.4, 0.5, -0.6]));
        let v = Motion { ang: Vec3([1.0, -2.0, 0.5]), lin: Vec3([0.3, 0.7, -1.1]) };
        let e = Mat3::rotation::<1>(0.6, 0.8);
        assert!(close(&rigid.mul(&v), &rigid.articulated().mul(&v)));
        assert!(close(&rigid.shifted(r).mul(&v), &rigid.articulated().shifted(r).mul(&v)));
        assert!(close(&rigid.turned(&e).mul(&v), &rigid.articulated().turned(&e).mul(&v)));
        assert!(close(&rigid.turned(&e).mul(&v), &rigid.articulated().rotated::<1>(0.6, 0.8).mul(&v)));
    }

    #[test]
    fn a_shift_along_an_axis_is_a_shift() {
        let ia = sample().articulated().rotated::<2>(0.6, 0.8).plus_rigid(&sample().shifted(Vec3([0.3, 0.1, 0.7])));
        let u = Force { ang: Vec3([0.2, 0.1, -0.3]), lin: Vec3([0.1, 0.5, 0.2]) };
        let ia = ia.minus_outer(&u, &u.scale(0.7));
        let v = Motion { ang: Vec3([1.0, -2.0, 0.5]), lin: Vec3([0.3, 0.7, -1.1]) };
        let along = [ia.shifted_along::<0>(0.4), ia.shifted_along::<1>(0.4), ia.shifted_along::<2>(0.4)];
        for (k, along) in along.iter().enumerate() {
            assert!(close(&along.mul(&v), &ia.shifted(Vec3::along(k, 0.4)).mul(&v)), "axis {k}");
        }
    }

    #[test]
    fn shift_obeys_steiner() {
        let (mass, com, i) = (2.0, Vec3([0.1, 0.2, -0.3]), Sym3([0.3, 0.0, 0.0, 0.4, 0.0, 0.5]));
        let r = Vec3([1.0, -0.5, 0.25]);
        let direct = RigidInertia::from_center_of_mass(mass, com + r, &i);
        let shifted = RigidInertia::from_center_of_mass(mass, com, &i).shifted(r);
        for k in 0..6 {
            assert!((direct.rotational.0[k] - shifted.rotational.0[k]).abs() < 1e-14);
        }
    }
}

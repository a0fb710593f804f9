//! Mass properties of a body and what makes them impossible.

use crate::spatial::{Mat3, Sym3, Vec3};

/// Mass, centre of mass and inertia of one body in its own frame.
///
/// ```
/// use sincro_geometry::MassProperties;
///
/// // two balls of 1 kg, 2 m apart: the parallel axis theorem gives 2·m·(1 m)² across their line
/// let ball = |x: f64| MassProperties { mass: 1.0, center_of_mass: [x, 0.0, 0.0], inertia: [0.0; 6] };
/// let dumbbell = MassProperties::sum(&[ball(0.0), ball(2.0)]);
/// assert_eq!((dumbbell.mass, dumbbell.center_of_mass), (2.0, [1.0, 0.0, 0.0]));
/// assert_eq!(dumbbell.principal_moments(), [0.0, 2.0, 2.0]); // [kg·m²]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass `[kg]`.
    pub mass: f64,
    /// Centre of mass (x, y, z) in the body's frame `[m]`.
    pub center_of_mass: [f64; 3],
    /// Rotational inertia about the centre of mass, in the axes of the body's frame: xx, xy, xz, yy, yz, zz `[kg·m²]`.
    /// Products of inertia are elements of the matrix, that is with the sign of −∫xy dm.
    pub inertia: [f64; 6],
}

impl MassProperties {
    /// Principal moments of inertia about the centre of mass, in ascending order `[kg·m²]`.
    #[must_use]
    pub fn principal_moments(&self) -> [f64; 3] {
        eigenvalues(&Sym3(self.inertia))
    }

    /// Violation of the triangle inequality of the principal moments a ≤ b ≤ c: (c − a − b)/c (dimensionless). At most
    /// 0 for every rigid body; 0 where c is not positive.
    #[must_use]
    pub fn triangle_excess(&self) -> f64 {
        let [a, b, c] = self.principal_moments();
        if c > 0.0 { (c - a - b) / c } else { 0.0 }
    }

    /// Mass properties of several bodies taken together, each given in the same frame. NaN if the total mass is zero.
    #[must_use]
    pub fn sum(parts: &[Self]) -> Self {
        let mass: f64 = parts.iter().map(|p| p.mass).sum();
        let mut center_of_mass = [0.0; 3];
        for p in parts {
            for k in 0..3 {
                center_of_mass[k] += p.mass * p.center_of_mass[k] / mass;
            }
        }
        let mut inertia = [0.0; 6];
        for p in parts {
            let r = Vec3(p.center_of_mass) - Vec3(center_of_mass);
            let steiner = Sym3::from_fn(|i, j| p.mass * (if i == j { r.dot(r) } else { 0.0 } - r[i] * r[j]));
            for k in 0..6 {
                inertia[k] += p.inertia[k] + steiner.0[k];
            }
        }
        Self { mass, center_of_mass, inertia }
    }

    /// Same body described in another frame A: `rot` (from body to A) and `pos` `[m]` are rotation and origin of its
    /// frame in A.
    #[must_use]
    pub fn placed(&self, rot: &Mat3<f64>, pos: Vec3<f64>) -> Self {
        Self {
            mass: self.mass,
            center_of_mass: (pos + rot.mul_vec(Vec3(self.center_of_mass))).0,
            inertia: rot.congruence_sym(&Sym3(self.inertia)).0,
        }
    }
}

/// Eigenvalues of a symmetric matrix, ascending, by Jacobi rotations (exact to rounding, also for tiny matrices).
fn eigenvalues(m: &Sym3<f64>) -> [f64; 3] {
    let mut a = m.full().0;
    for _sweep in 0..30 {
        let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        if off == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] != 0.0 {
                jacobi_rotation(&mut a, p, q);
            }
        }
    }
    let mut e = [a[0][0], a[1][1], a[2][2]];
    e.sort_by(f64::total_cmp);
    e
}

fn jacobi_rotation(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let t = if theta.is_finite() { t } else { 0.0 };
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..3 {
        let (x, y) = (a[k][p], a[k][q]);
        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
    }
    for k in 0..3 {
        let (x, y) = (a[p][k], a[q][k]);
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
    }
    if t == 0.0 || a[p][q].abs() < 1e-300 {
        a[p][q] = 0.0;
        a[q][p] = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_moments_do_not_depend_on_the_axes() {
        let (s, c) = sincro_math::elementary::sin_cos(0.7);
        let turned = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [1e-9, 0.0, 0.0, 3e-9, 0.0, 2e-9] }
            .placed(&Mat3::rotation::<0>(s, c).mul(&Mat3::rotation::<2>(c, s)), Vec3([1.0, 2.0, 3.0]));
        let e = turned.principal_moments();
        for (got, want) in e.iter().zip([1e-9, 2e-9, 3e-9]) {
            assert!((got - want).abs() < 1e-22, "{e:?}");
        }
    }

    #[test]
    fn a_flat_plate_is_the_limit_of_the_triangle_inequality() {
        let plate = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 2.0, 0.0, 3.0] };
        assert_eq!(plate.triangle_excess(), 0.0);
        let impossible = MassProperties { inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 3.0], ..plate };
        assert!((impossible.triangle_excess() - 1.0 / 3.0).abs() < 1e-15);
    }
}

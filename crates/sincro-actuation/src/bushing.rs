//! Bushing: a compliant element with six degrees of freedom between two frames, each fixed in a link or in the world.
//!
//! With the pose of the second frame B in the first one A, position p and rotation vector φ, it has the energy
//! V = ½ pᵀ K p + ½ φᵀ K_φ φ, with diagonal stiffnesses along and about the axes of A. The force on B is
//! f = −K p − C ṗ, the torque on it τ = −J⁻ᵀ(φ) K_φ φ − C_φ ω, where φ̇ = J⁻¹(φ) ω: minus the gradient of V for any
//! rotation below π, and damping of the relative angular velocity. Both act at the origin of B, their reactions on the
//! link of A at the same point: momentum is conserved. At φ = π the rotation vector turns round, and with it the
//! torque, not V.
//!
//! At the end of a linearly implicit step the torque is τ − h T ω − h (C_φ + h T) ω̇ with the positive semidefinite
//! T = J⁻ᵀ K_φ J⁻¹. Two terms of the derivative of force and torque are left out, and so are explicit: that of J⁻ᵀ(φ)
//! at constant K_φ φ, of the order of the elastic torque, zero at φ = 0; and that of the axes, in which f and τ stay
//! constant while A turns, of the order of force and torque. The matrix of ω̇ is U D Uᵀ, U unit lower triangular:
//! three rows Uᵀ ω, each with its own coefficient.
//!
//! Sources: key `drake`, `LinearBushingRollPitchYaw`; key `iserles2000`, section 2.5, for J.
//!
//! | symbol | meaning | frame |
//! |---|---|---|
//! | p, φ | position of B `[m]`, rotation vector of B `[rad]`, in A | A |
//! | ṗ, ω | their rates: velocity of the origin of B, angular velocity of B, as seen from A | A |
//! | f, τ | force `[N]` and torque `[N·m]` on the link of B | A |

use sincro_math::Real;

use sincro_geometry::spatial::{Force, Mat3, Motion, Pose, Quat, Vec3};

/// Frame fixed in a link, or in the world: one end of a [`Bushing`].
#[derive(Clone, Copy, Debug)]
pub struct LinkFrame<R> {
    /// Index of the link in `Model::links`; `None` for the world.
    pub link: Option<usize>,
    /// Pose in the link's frame, or in the world `[m]`.
    pub pose: Pose<R>,
}

/// Compliant element with six degrees of freedom between two frames; from
/// `BushingSpec`. Lists of six have x, y, z of the translation, then of the rotation.
#[derive(Clone, Copy, Debug)]
pub struct Bushing<R> {
    /// The frames A and B.
    pub ends: [LinkFrame<R>; 2],
    /// Stiffness along the axes of A `[N/m]`, then about them `[N·m/rad]`.
    pub stiffness: [R; 6],
    /// Damping along the axes of A `[N·s/m]`, then about them `[N·m·s/rad]`.
    pub damping: [R; 6],
}

/// Deflection of a [`Bushing`] and its rate at one instant; from [`Bushing::motion`].
#[derive(Clone, Copy, Debug)]
pub struct BushingMotion<R> {
    /// Position of B in A `[m]` and rotation vector of B in A `[rad]`, axes of A.
    pub deflection: [R; 6],
    /// Velocity of the origin of B `[m/s]` and angular velocity of B `[rad/s]` as seen from A, axes of A.
    pub rates: [R; 6],
    /// Rotation of A in the world.
    pub axes: Mat3<R>,
    /// Origin of B in the world `[m]`.
    pub point: Vec3<R>,
    /// Velocity of the origin of B in the world `[m/s]`.
    pub velocity: Vec3<R>,
    /// Angular velocity of A in the world `[rad/s]`.
    pub turning: Vec3<R>,
    /// Uᵀ: its rows are those of the rotation in a linearly implicit step.
    pub rotation_rows: Mat3<R>,
}

/// Components `from` to `from + 2` of a list of six.
fn part<R: Real>(of: &[R; 6], from: usize) -> Vec3<R> {
    Vec3([of[from], of[from + 1], of[from + 2]])
}

fn six<R: Real>(translation: Vec3<R>, rotation: Vec3<R>) -> [R; 6] {
    let ([a, b, c], [d, e, f]) = (translation.0, rotation.0);
    [a, b, c, d, e, f]
}

/// Products of two lists, entry by entry.
fn scaled<R: Real, const N: usize>(a: [R; N], b: [R; N]) -> [R; N] {
    core::array::from_fn(|k| a[k] * b[k])
}

impl<R: Real> Bushing<R> {
    /// Deflection and rate at one instant. `at` gives, for the index of a link, its twist about its origin in link axes
    /// (`[rad/s]`, `[m/s]`) and its pose in the world `[m]`.
    #[inline(always)]
    pub fn motion(&self, at: impl Fn(usize) -> (Motion<R>, Pose<R>)) -> BushingMotion<R> {
        let [(x_wa, v_a, w_a), (x_wb, v_b, w_b)] = self.ends.map(|end| match end.link {
            None => (end.pose, Vec3::zero(), Vec3::zero()),
            Some(link) => {
                let (twist, x_wl) = at(link);
                let velocity = x_wl.rot.mul_vec(twist.lin + twist.ang.cross(end.pose.pos));
                (x_wl.compose(&end.pose), velocity, x_wl.rot.mul_vec(twist.ang))
            }
        });
        let (apart, axes) = (x_wb.pos - x_wa.pos, x_wa.rot);
        let phi = Quat::from_matrix(&axes.transpose().mul(&x_wb.rot)).log();
        BushingMotion {
            deflection: six(axes.tr_mul_vec(apart), phi),
            rates: six(axes.tr_mul_vec(v_b - v_a - w_a.cross(apart)), axes.tr_mul_vec(w_b - w_a)),
            axes,
            point: x_wb.pos,
            velocity: v_b,
            turning: w_a,
            rotation_rows: Mat3::identity(),
        }
    }

    /// Elastic force `[N]` and torque `[N·m]` on the link of B at a deflection, axes of A: minus the gradient of the
    /// potential energy.
    #[inline(always)]
    pub fn elastic(&self, at: &BushingMotion<R>) -> [R; 6] {
        let of = scaled(self.stiffness, at.deflection);
        let (phi, gradient) = (part(&at.deflection, 3), part(&of, 3));
        six(part(&of, 0), phi.rotation_rate(gradient)).map(|x| -x)
    }

    /// Damping force `[N]` and torque `[N·m]` on the link of B at `rates` of the deflection, axes of A.
    #[inline(always)]
    pub fn dissipative(&self, rates: [R; 6]) -> [R; 6] {
        scaled(self.damping, rates).map(|x| -x)
    }

    /// Force `[N]` and torque `[N·m]` on the link of B, axes of A.
    #[inline(always)]
    pub fn force(&self, at: &BushingMotion<R>) -> [R; 6] {
        let (elastic, damping) = (self.elastic(at), self.dissipative(at.rates));
        core::array::from_fn(|k| elastic[k] + damping[k])
    }

    /// Potential energy `[J]` at a deflection.
    #[inline(always)]
    pub fn potential(&self, at: &BushingMotion<R>) -> R {
        let squares = scaled(at.deflection, at.deflection);
        let mut sum = R::zero();
        for x in scaled(self.stiffness, squares) {
            sum += x;
        }
        sum * R::splat(0.5)
    }

    /// Wrench of a `force` on B (axes of A, `[N]`, `[N·m]`) on the link of end `k` (0: A, 1: B): moment about the
    /// link's origin `[N·m]` and force `[N]`, in link axes. `x_wl` is the pose of that link in the world `[m]`.
    #[inline(always)]
    pub fn wrench(&self, k: usize, at: &BushingMotion<R>, force: &[R; 6], x_wl: &Pose<R>) -> Force<R> {
        // no large closure on lanes: it would be compiled for the baseline instruction set
        let (mut lin, mut torque) = (part(force, 0), part(force, 3));
        if k == 0 {
            (lin, torque) = (-lin, -torque);
        }
        let lin = x_wl.rot.tr_mul_vec(at.axes.mul_vec(lin));
        let torque = x_wl.rot.tr_mul_vec(at.axes.mul_vec(torque));
        Force { ang: torque + x_wl.rot.tr_mul_vec(at.point - x_wl.pos).cross(lin), lin }
    }

    /// Prepares a linearly implicit step with the steps of dampers and springs `[s]`: sets the rows of `at`, writes
    /// their coefficients to `kappa`, and returns the part of the force that the springs have by the present rates.
    #[inline(always)]
    pub fn implicit(&self, at: &mut BushingMotion<R>, steps: (R, R), kappa: &mut [R]) -> [R; 6] {
        let phi = part(&at.deflection, 3);
        let (k_phi, skew) = (part(&self.stiffness, 3), Mat3::skew(phi));
        let half = Mat3(skew.0.map(|row| row.map(|x| x * R::splat(-0.5))));
        let c = phi.rotation_rate_coefficient();
        let twice = Mat3(skew.mul(&skew).0.map(|row| row.map(|x| x * c)));
        let inverse = Mat3::identity().plus(&half).plus(&twice);
        let tangent = inverse.transpose().mul(&Mat3(core::array::from_fn(|k| inverse.0[k].map(|x| x * k_phi[k]))));
        let of_springs =
            six(Vec3(scaled(part(&self.stiffness, 0).0, part(&at.rates, 0).0)), tangent.mul_vec(part(&at.rates, 3)));
        for k in 0..3 {
            kappa[k] = steps.0 * (self.damping[k] + steps.1 * self.stiffness[k]);
        }
        let coupled: [[R; 3]; 3] = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                let own = if i == j { self.damping[3 + i] } else { R::zero() };
                steps.0 * (own + steps.1 * tangent.0[i][j])
            })
        });
        at.rotation_rows = factored(coupled, &mut kappa[3..6]);
        of_springs.map(|x| -steps.1 * x)
    }
}

/// Uᵀ of a positive semidefinite matrix U D Uᵀ, whose D goes to `diagonal`.
#[inline(always)]
fn factored<R: Real>(mut a: [[R; 3]; 3], diagonal: &mut [R]) -> Mat3<R> {
    let mut rows = Mat3::identity();
    for k in 0..3 {
        diagonal[k] = a[k][k].max(R::zero());
        // a pivot of zero has a column of zeros
        let inverse = R::one() / diagonal[k].max(R::splat(f64::MIN_POSITIVE));
        for i in k + 1..3 {
            rows.0[k][i] = R::zero().if_less(diagonal[k], a[i][k] * inverse, R::zero());
        }
        for i in k + 1..3 {
            for j in k + 1..3 {
                a[i][j] -= rows.0[k][i] * diagonal[k] * rows.0[k][j];
            }
        }
    }
    rows
}

impl<R: Real> BushingMotion<R> {
    /// Rates `[m/s]`, `[rad/s]` of the deflection from those of the rows of a linearly implicit step.
    pub fn rates_of_rows(&self, rows: [R; 6]) -> [R; 6] {
        let (mut rates, u) = (rows, &self.rotation_rows.0);
        rates[4] -= u[1][2] * rates[5];
        rates[3] -= u[0][1] * rates[4] + u[0][2] * rates[5];
        rates
    }
}

//! Solution of the problem of one contact, all other forces given: exact where it is open or sticks.
//!
//! With the own matrix G (normal first) and the rates w that the contact has without its own force, w + G λ and λ obey
//! Signorini's condition and Coulomb's law in one of three modes: open, λ = 0; stick, λ = −G⁻¹ w; slip, where the
//! friction opposes the sliding rate, w_t + … = −s λ_t with s > 0. Eliminating the normal force, the friction of a slip
//! is λ_t(s) = (A + s 1)⁻¹ r with the Schur complement A of the normal row, and s is the root of ‖λ_t(s)‖ = μ λₙ(s).
//! The left side is larger at s = 0 (the contact does not stick), the right side for large s (it is closed), so that a
//! root always exists; Newton's method comes near it within a bracket, from that of the last sweep: sweep by sweep to
//! rounding. Forces are on the limit of friction at once.

/// Iteration limit of Newton's method; a dozen bisections among them suffice.
const MAX_ITERATIONS: usize = 40;

/// Tolerance of the friction limit, relative to the friction.
const TOLERANCE: f64 = 1e-10;

/// Change of the friction by a step of Newton's method, relative to the friction, below which the step is the last: it
/// is taken along the slope, without another look, and the next sweep goes on from there.
const LAST_CHANGE: f64 = 0.1;

/// Amount added to the diagonal of a matrix that may be singular, relative to the largest entry of the problem: a
/// contact that cannot be moved in a direction needs no exact force there.
const REGULARISATION: f64 = 1e-12;

/// Friction problem in a plane: symmetric 2 × 2 matrix A with the solution of (A + s 1) x = r under a limit on ‖x‖.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TangentialProblem {
    a: [f64; 3],
    /// Root of the last solution.
    s: f64,
}

impl TangentialProblem {
    /// The problem of a matrix that may be singular, for a `scale` of its entries above zero.
    pub fn new(a: [f64; 3], scale: f64) -> Self {
        let (more, diagonal) = (REGULARISATION * scale, [a[0].max(0.0), a[2].max(0.0)]);
        // rounding may leave a matrix that is not even semidefinite
        let off = (diagonal[0] * diagonal[1]).sqrt();
        Self { a: [diagonal[0] + more, a[1].clamp(-off, off), diagonal[1] + more], s: 0.0 }
    }

    /// x = (A + s 1)⁻¹ r and dx/ds.
    #[inline(always)]
    fn at(&self, s: f64, r: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let [a, b, c] = [self.a[0] + s, self.a[1], self.a[2] + s];
        let inverse = 1.0 / (a * c - b * b);
        let x = [(c * r[0] - b * r[1]) * inverse, (a * r[1] - b * r[0]) * inverse];
        (x, [(b * x[1] - c * x[0]) * inverse, (b * x[0] - a * x[1]) * inverse])
    }

    /// x with (A) x = r, or where it is larger than `limit`, the x of a slip at the limit.
    #[inline(always)]
    pub fn slip_or_stick(&mut self, r: [f64; 2], limit: f64) -> [f64; 2] {
        let (x, _) = self.at(0.0, r);
        let size = (x[0] * x[0] + x[1] * x[1]).sqrt();
        if size <= limit {
            return x;
        }
        let Slip { x, size, .. } = self.slip(r, |_| limit, |_| 0.0);
        let share = if size > 0.0 { limit / size } else { 0.0 };
        [x[0] * share, x[1] * share]
    }

    /// Finds x with ‖x‖ = limit(x), where ‖x‖ is larger for s = 0, from the root last found: by one step of Newton's
    /// method where that is near. `slope` is the derivative of the limit along a change of x.
    #[inline(always)]
    pub fn slip(&mut self, r: [f64; 2], limit: impl Fn([f64; 2]) -> f64, slope: impl Fn([f64; 2]) -> f64) -> Slip {
        let (mut low, mut high, mut s) = (0.0, f64::INFINITY, self.s);
        let mut found = Slip { x: [0.0; 2], size: 0.0, limit: 0.0 };
        for _ in 0..MAX_ITERATIONS {
            let (x, dx) = self.at(s, r);
            let size = (x[0] * x[0] + x[1] * x[1]).sqrt();
            let most = limit(x);
            found = Slip { x, size, limit: most };
            let excess = size - most;
            if excess.abs() <= TOLERANCE * size {
                break;
            }
            if excess > 0.0 {
                low = s;
            } else {
                high = s;
            }
            // the rate of the excess, times the size
            let rate = (x[0] * dx[0] + x[1] * dx[1]) - slope(dx) * size;
            let newton = s - excess * size / rate;
            s = if newton > low && newton < high {
                let change = [dx[0] * (newton - s), dx[1] * (newton - s)];
                if change[0] * change[0] + change[1] * change[1] <= LAST_CHANGE * LAST_CHANGE * size * size {
                    let x = [x[0] + change[0], x[1] + change[1]];
                    found = Slip { x, size: (x[0] * x[0] + x[1] * x[1]).sqrt(), limit: limit(x) };
                    s = newton;
                    break;
                }
                newton
            } else if high.is_finite() {
                0.5 * (low + high)
            } else {
                2.0 * s + self.a[0] + self.a[2]
            };
        }
        self.s = s;
        found
    }
}

/// Solution of a problem in a plane on its limit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slip {
    x: [f64; 2],
    /// ‖x‖.
    size: f64,
    /// The limit at x.
    limit: f64,
}

/// The problem of one contact with sliding friction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ContactLocal {
    /// Own matrix: nn, nt₁, nt₂, t₁t₁, t₁t₂, t₂t₂.
    g: [f64; 6],
    /// Its inverse, in the same order.
    inverse: [f64; 6],
    /// That of the normal row alone.
    inverse_normal: f64,
    tangential: TangentialProblem,
}

impl ContactLocal {
    /// Prepares the problem of a contact with matrix `g`, not zero: nn, nt₁, nt₂, t₁t₁, t₁t₂, t₂t₂.
    pub fn new(g: [f64; 6]) -> Self {
        let scale = g[0] + g[3] + g[5];
        let g = [g[0].max(REGULARISATION * scale), g[1], g[2], g[3], g[4], g[5]];
        let [nn, n1, n2, a, b, c] = g;
        let schur = [a - n1 * n1 / nn, b - n1 * n2 / nn, c - n2 * n2 / nn];
        let tangential = TangentialProblem::new(schur, scale);
        let [p, q, r] = tangential.a;
        // by the Schur complement, regularised alike
        let d = 1.0 / (p * r - q * q);
        let (i11, i12, i22) = (r * d, -q * d, p * d);
        let (c1, c2) = (n1 / nn, n2 / nn);
        let (t1, t2) = (i11 * c1 + i12 * c2, i12 * c1 + i22 * c2);
        Self {
            g,
            inverse: [1.0 / nn + c1 * t1 + c2 * t2, -t1, -t2, i11, i12, i22],
            inverse_normal: 1.0 / nn,
            tangential,
        }
    }

    /// Trace of the own matrix.
    pub fn trace(&self) -> f64 {
        self.g[0] + self.g[3] + self.g[5]
    }

    /// The force, from the present one and the rates `u` with it.
    #[inline(always)]
    pub fn solve(&mut self, friction: f64, force: [f64; 3], u: [f64; 3]) -> [f64; 3] {
        let own = product(&self.g, force);
        // rates without the force
        let w = [u[0] - own[0], u[1] - own[1], u[2] - own[2]];
        if w[0] >= 0.0 {
            return [0.0; 3];
        }
        let stick = product(&self.inverse, [-w[0], -w[1], -w[2]]);
        let limit = friction * stick[0];
        if stick[0] > 0.0 && stick[1] * stick[1] + stick[2] * stick[2] <= limit * limit {
            return stick;
        }
        let ([_, n1, n2, ..], inverse) = (self.g, self.inverse_normal);
        let (c1, c2) = (n1 * inverse, n2 * inverse);
        let r = [c1 * w[0] - w[1], c2 * w[0] - w[2]];
        let normal = move |x: [f64; 2]| -(w[0] * inverse + c1 * x[0] + c2 * x[1]);
        let Slip { x, size, limit } =
            self.tangential.slip(r, |x| friction * normal(x), |dx| -friction * (c1 * dx[0] + c2 * dx[1]));
        // on the limit to the last digit
        let most = limit.max(0.0);
        let share = if size > 0.0 { most / size } else { 0.0 };
        [most / friction, x[0] * share, x[1] * share]
    }
}

/// Product of a symmetric matrix, in the order of [`ContactLocal`], with a vector.
#[inline(always)]
pub(super) fn product(g: &[f64; 6], x: [f64; 3]) -> [f64; 3] {
    [
        g[0] * x[0] + g[1] * x[1] + g[2] * x[2],
        g[1] * x[0] + g[3] * x[1] + g[4] * x[2],
        g[2] * x[0] + g[4] * x[1] + g[5] * x[2],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in (−1, 1).
    fn numbers() -> impl FnMut() -> f64 {
        let mut seed = 7_u64;
        move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn contacts_that_cannot_move_in_some_directions_have_finite_forces() {
        // a piston, a wheel whose point of contact moves along one line, and directions that rounding alone moves
        for g in [[2.0, 0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 2.0, 3.0, 4.0, 6.0, 9.0], [1e-34, 0.0, 1e-18, 1.0, 1.0, 1.0]] {
            for w in [[-1.0, 0.3, -0.2], [-1e-9, 1.0, 1.0], [-3.0, 0.0, 0.0]] {
                for friction in [0.1, 1.0, 10.0] {
                    let mut local = ContactLocal::new(g);
                    let force = local.solve(friction, [0.0; 3], w);
                    assert!(force.iter().all(|f| f.is_finite()) && force[0] >= 0.0, "{force:?}");
                    assert!(force[1].hypot(force[2]) <= friction * force[0] * (1.0 + 1e-12), "{force:?}");
                    // the same from forces that move next to nothing on
                    let mut other = force;
                    for _ in 0..30 {
                        other = [other[0], other[1] + 0.1, other[2] - 0.1];
                        let pushed = product(&local.g, other);
                        other = local.solve(friction, other, core::array::from_fn(|k| w[k] + pushed[k]));
                        assert!(other.iter().all(|f| f.is_finite()) && other[0] >= 0.0, "{other:?}");
                        assert!(other[1].hypot(other[2]) <= friction * other[0] * (1.0 + 1e-12), "{other:?}");
                    }
                }
            }
        }
        let mut piston = ContactLocal::new([2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(piston.solve(0.5, [0.5, 0.2, -0.1], [0.0; 3]), [0.5, 0.0, 0.0]);
        assert!((piston.solve(0.5, [0.0; 3], [-1.0, 0.0, 0.0])[0] - 0.5).abs() < 1e-9);
    }

    #[test]
    fn the_force_obeys_signorini_and_coulomb_for_any_matrix() {
        let mut number = numbers();
        let mut modes = [0; 3];
        for _ in 0..20_000 {
            let y: [[f64; 4]; 3] = core::array::from_fn(|_| core::array::from_fn(|_| number()));
            let dot = |i: usize, j: usize| (0..4).map(|k| y[i][k] * y[j][k]).sum::<f64>();
            let g = [dot(0, 0), dot(0, 1), dot(0, 2), dot(1, 1), dot(1, 2), dot(2, 2)];
            let (friction, w) = (number().abs() + 1e-3, [number(), number(), number()]);
            let mut local = ContactLocal::new(g);
            // as often as sweeps come by
            let force = (0..6).map(|_| local.solve(friction, [0.0; 3], w)).last().expect("there are six");
            let pushed = product(&local.g, force);
            let u: [f64; 3] = core::array::from_fn(|k| w[k] + pushed[k]);
            let (tangential, limit) = (force[1].hypot(force[2]), friction * force[0]);
            let scale = 1.0 + force[0];
            if force[0] == 0.0 {
                assert!(u[0] >= 0.0 && tangential == 0.0);
                modes[0] += 1;
            } else if tangential < limit * (1.0 - 1e-12) {
                assert!(u.iter().all(|u| u.abs() < 1e-8 * scale), "{u:?} {force:?} {g:?}");
                modes[1] += 1;
            } else {
                assert!(force[0] > 0.0 && (tangential - limit).abs() <= 1e-12 * scale);
                assert!(u[0].abs() < 1e-8 * scale, "{u:?} {force:?} {g:?}");
                let sliding = u[1].hypot(u[2]);
                assert!(
                    (force[1] * u[1] + force[2] * u[2] + sliding * tangential).abs() < 1e-7 * scale * (1.0 + sliding)
                );
                modes[2] += 1;
            }
        }
        assert!(modes.iter().all(|n| *n > 500), "{modes:?}");
    }
}

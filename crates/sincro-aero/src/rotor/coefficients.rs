//! Rotors by their coefficients: constant ones, and ones measured over the advance ratio.
//!
//! Source: key `leishman2006`, coefficients of propellers: T = ρ n²D⁴ c_T(J), Q = ρ n²D⁵ c_Q(J), J = v/(nD), with n =
//! Ω/2π turns a second, D the diameter and v the velocity along the axis. A rotor that turns backwards is its mirror
//! image.

use core::f64::consts::TAU;

use sincro_math::Real;

use super::{Load, Spin, Validity, outside};
use sincro_geometry::spatial::Vec3;
use sincro_math::error::InvalidParameters;

/// Rotor with constant coefficients, T = b Ω·abs(Ω) and Q = k Ω·abs(Ω), whatever the flow: for control design near
/// hover.
///
/// ```
/// use sincro_aero::rotor::{ConstantCoefficients, Spin};
///
/// let rotor = ConstantCoefficients { thrust: 5e-5, torque: 9e-7, spin: Spin::CounterClockwise };
/// let load = rotor.evaluate(-100.0);
/// assert_eq!((load.thrust, load.torque), (-0.5, 0.009));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantCoefficients {
    /// Thrust over the square of the speed, b `[N·s²/rad²]`.
    pub thrust: f64,
    /// Magnitude of the reaction torque over the square of the speed, k `[N·m·s²/rad²]`; its direction follows from
    /// `spin`.
    pub torque: f64,
    /// Sense of rotation at positive speed.
    pub spin: Spin,
}

impl ConstantCoefficients {
    /// Load at `speed` Ω `[rad/s]`: thrust b Ω·abs(Ω) `[N]`, reaction torque −s k Ω·abs(Ω) `[N·m]` (s the sign of the
    /// spin), power k abs(Ω)³ `[W]`; inflow zero.
    #[inline(always)]
    pub fn evaluate<R: Real>(&self, speed: R) -> Load<R> {
        let signed_square = speed * speed.abs();
        let torque = R::splat(self.torque) * signed_square;
        Load {
            gyroscopic: [R::zero(); 2],
            thrust: R::splat(self.thrust) * signed_square,
            torque: R::splat(-self.spin.sign()) * torque,
            inflow: R::zero(),
            power: torque * speed,
        }
    }
}

/// Row of a [`CoefficientTable`]: coefficients of a propeller at one advance ratio, all dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableRow {
    /// Advance ratio J = v/(n D): axial velocity over turns per second times diameter (dimensionless).
    pub advance: f64,
    /// Thrust coefficient c_T = T/(ρ n² D⁴) (dimensionless).
    pub thrust: f64,
    /// Torque coefficient c_Q = Q/(ρ n² D⁵) (dimensionless), positive while the shaft drives.
    pub torque: f64,
}

/// Propeller with coefficients measured over the advance ratio: linear between the rows, constant beyond the first and
/// the last. For propellers from a data sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct CoefficientTable {
    diameter: f64,
    spin: Spin,
    rows: Vec<TableRow>,
}

/// Turns a second times diameter below which a propeller counts as standing `[m/s]`: J has no meaning there, and the
/// load is zero for any.
const STANDING: f64 = 1e-100;

impl CoefficientTable {
    /// Creates a propeller of `diameter` `[m]` with `rows` in the order of increasing advance ratio; one row is enough.
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] with one sentence for each fault: a diameter outside 1e-6 to 1e6 m, no rows, a row with a
    /// number that is not finite, advance ratios that do not increase.
    pub fn new(diameter: f64, spin: Spin, rows: Vec<TableRow>) -> Result<Self, InvalidParameters> {
        let mut problems: Vec<String> = outside("diameter", diameter, (1e-6, 1e6), "m").into_iter().collect();
        if rows.is_empty() {
            problems.push("the table of coefficients is empty: expected at least one row".to_owned());
        }
        for (k, row) in rows.iter().enumerate() {
            let is_finite = row.advance.is_finite() && row.thrust.is_finite() && row.torque.is_finite();
            if !is_finite {
                problems.push(format!("row {} of the table has a number that is not finite", k + 1));
            }
            if k > 0 && row.advance <= rows[k - 1].advance {
                let before = rows[k - 1].advance;
                let message = format!("row {} has advance ratio {} after {before}: expected more", k + 1, row.advance);
                problems.push(message);
            }
        }
        if problems.is_empty() { Ok(Self { diameter, spin, rows }) } else { Err(InvalidParameters::new(problems)) }
    }

    /// Sense of rotation at positive speed.
    #[must_use]
    pub fn spin(&self) -> Spin {
        self.spin
    }

    /// Validity at a rotor `speed` `[rad/s]` and a `velocity` of the hub relative to the air `[m/s]`, in rotor axes (z
    /// along the thrust): [`Validity::OutsideTable`] where the advance ratio was not measured, [`Validity::Standing`]
    /// at no speed. Of lanes, that of number `lane` is examined.
    #[must_use]
    pub fn validity<R: Real>(&self, speed: R, velocity: Vec3<R>, lane: usize) -> Validity {
        let by_turn = speed.lane(lane) * (self.diameter / TAU);
        if by_turn.abs() < STANDING {
            return Validity::Standing;
        }
        let advance = velocity[2].lane(lane) / by_turn;
        let is_inside = advance >= self.rows[0].advance && advance <= self.rows[self.rows.len() - 1].advance;
        if is_inside { Validity::Valid } else { Validity::OutsideTable }
    }

    /// Thrust, reaction torque and power in air of `density` `[kg/m³]` at `speed` `[rad/s]`, with the hub moving at
    /// `velocity` `[m/s]` relative to the air, in rotor axes, of which only z counts; inflow zero.
    #[inline(always)]
    pub fn evaluate<R: Real>(&self, density: f64, speed: R, velocity: Vec3<R>) -> Load<R> {
        let d = self.diameter;
        let turns = speed * R::splat(1.0 / TAU);
        let by_turn = turns * R::splat(d);
        let standing = R::splat(STANDING);
        let advance = velocity[2] / by_turn.abs().if_less(standing, standing, by_turn);
        let (c_t, c_q) = self.coefficients(advance);
        // ρ n·abs(n) D⁴
        let force = R::splat(density * (d * d)) * (by_turn * by_turn.abs());
        let torque = R::splat(d) * force * c_q;
        Load {
            gyroscopic: [R::zero(); 2],
            thrust: force * c_t,
            torque: R::splat(-self.spin.sign()) * torque,
            inflow: R::zero(),
            power: torque * speed,
        }
    }

    /// c_T and c_Q at advance ratio J.
    #[inline(always)]
    fn coefficients<R: Real>(&self, advance: R) -> (R, R) {
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let inside = advance.max(R::splat(first.advance)).min(R::splat(last.advance));
        let segment = |k: usize| self.segment(inside.lane(k));
        let since = inside - R::from_lanes(|k| segment(k).0.advance);
        let linear = |column: fn(&TableRow) -> f64| {
            let start = R::from_lanes(|k| column(&segment(k).0));
            let slope = R::from_lanes(|k| {
                let (a, b) = segment(k);
                if b.advance > a.advance { (column(&b) - column(&a)) / (b.advance - a.advance) } else { 0.0 }
            });
            start + slope * since
        };
        (linear(|row| row.thrust), linear(|row| row.torque))
    }

    /// The rows on both sides of advance ratio `x`, which lies within the table; of a table of one row that one twice.
    fn segment(&self, x: f64) -> (TableRow, TableRow) {
        let last = self.rows.len() - 1;
        let after = self.rows.partition_point(|row| row.advance <= x).clamp(1, last.max(1)).min(last);
        (self.rows[after.saturating_sub(1)], self.rows[after])
    }
}

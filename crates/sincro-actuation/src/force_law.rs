//! Force law of a spring and damper over a deflection x and its rate ẋ: F = preload − k x − c ẋ + N(x, ẋ).
//!
//! A positive force acts towards larger x. N is a table over x or a formula of x and ẋ. The elastic part F(x, 0) is
//! conservative, U(x) = −∫₀ˣ F(s, 0) ds; the rest, F(x, ẋ) − F(x, 0), is dissipated.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x, ẋ | deflection, its rate | m, m/s or rad, rad/s |
//! | k, c | stiffness, damping | N/m, N·s/m or N·m/rad, N·m·s/rad |
//! | F, U | force or torque, potential energy | N or N·m, J |

use std::sync::Arc;

use sincro_integrate::quadrature;
use sincro_math::dual::Dual;
use sincro_math::error::InvalidParameters;
use sincro_math::expression::Expression;
use sincro_math::{Branches, Real};

/// Names in the formula of a [`NonlinearLaw`], in the order that [`Expression::parse`] takes: `x`, the deflection `[m]`
/// or `[rad]`, and `v`, its rate `[m/s]` or `[rad/s]`.
pub const FORMULA_NAMES: [&str; 2] = ["x", "v"];

/// Largest number of intermediate values of a formula: its stack stands in the function that evaluates it.
const MAX_STACK: usize = 16;

/// Force law of a spring and damper, F = preload − k x − c ẋ + N(x, ẋ) over deflection x and rate ẋ; a positive force
/// acts towards larger x. Units below are those of a line; of a joint with an angle they are N·m, rad, rad/s.
///
/// ```
/// use sincro_actuation::ForceLaw;
///
/// let law = ForceLaw { stiffness: 200.0, damping: 5.0, preload: 0.0, nonlinear: None };
/// assert_eq!(law.force(0.1, -2.0), -200.0 * 0.1 + 5.0 * 2.0); // [N]
/// assert!((law.potential(0.1) - 0.5 * 200.0 * 0.1 * 0.1).abs() < 1e-15); // [J]
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ForceLaw<R> {
    /// Stiffness k `[N/m]`.
    pub stiffness: R,
    /// Damping coefficient c `[N·s/m]`.
    pub damping: R,
    /// Force at zero deflection and rate `[N]`.
    pub preload: R,
    /// Nonlinear part N, added to the linear one; `None` for a linear law.
    pub nonlinear: Option<Arc<NonlinearLaw>>,
}

/// Nonlinear part N(x, ẋ) of a force law, of a joint spring or of a [`ForceLaw`] between two points.
#[derive(Clone, Debug, PartialEq)]
pub enum NonlinearLaw {
    /// Force `[N]` or torque `[N·m]` as a table over the deflection; no damping.
    Table(ForceTable),
    /// Force as a formula of deflection and rate ([`FORMULA_NAMES`]).
    Formula(Expression),
    /// Sum of forces that act outside of ranges of the deflection.
    Ranges(Vec<FreeRange>),
}

/// Range of the deflection without force: beyond its ends a spring and damper pushes back, and never pulls on. Used in
/// [`NonlinearLaw::Ranges`] for the slack and the limits of tendons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeRange {
    /// Smallest deflection without force `[m]`; −∞ for none.
    pub low: f64,
    /// Largest deflection without force `[m]`; ∞ for none.
    pub high: f64,
    /// Stiffness beyond them `[N/m]`.
    pub stiffness: f64,
    /// Damping beyond them `[N·s/m]`.
    pub damping: f64,
}

impl FreeRange {
    /// Force at deflection `x` and rate `v`: −k (x − high) − c v above, −k (x − low) − c v below, as far as it points
    /// back into the range.
    #[inline(always)]
    fn force<R: Real>(&self, x: R, v: R) -> R {
        let (zero, k, c) = (R::zero(), R::splat(self.stiffness), R::splat(self.damping));
        let (low, high) = (R::splat(self.low), R::splat(self.high));
        let above = zero.min(-(k * (x - high)) - c * v);
        let below = zero.max(-(k * (x - low)) - c * v);
        high.if_less(x, above, x.if_less(low, below, zero))
    }

    /// Energy stored at deflection `x` `[J]`.
    fn energy(&self, x: f64) -> f64 {
        let beyond = (x - self.high).max(self.low - x).max(0.0);
        0.5 * self.stiffness * beyond * beyond
    }
}

impl NonlinearLaw {
    /// Creates the law of a formula that was parsed with [`FORMULA_NAMES`] and gives the force `[N]` or torque `[N·m]`.
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] if the formula needs more than 16 intermediate values at once.
    ///
    /// # Panics
    ///
    /// If the formula was parsed with other names than [`FORMULA_NAMES`].
    pub fn formula(formula: Expression) -> Result<Self, InvalidParameters> {
        if formula.stack_depth() > MAX_STACK {
            let message = format!(
                "the formula needs {} intermediate values at once, more than {MAX_STACK}: give names to its parts, or a table",
                formula.stack_depth()
            );
            return Err(InvalidParameters::new(vec![message]));
        }
        assert!(!(2..8).any(|slot| formula.uses(slot)), "the formula has names beside x and v");
        Ok(Self::Formula(formula))
    }

    /// Force N(x, ẋ) `[N]` or torque `[N·m]` at deflection `x` `[m]` or `[rad]` and rate `v` `[m/s]` or `[rad/s]`.
    #[inline(always)]
    pub fn force<R: Real>(&self, x: R, v: R) -> R {
        match self {
            Self::Table(table) => x.map(|x| table.value(x)),
            Self::Ranges(ranges) => {
                // no closure on lanes: it would be compiled for the baseline instruction set
                let mut sum = R::zero();
                for range in ranges {
                    sum += range.force(x, v);
                }
                sum
            }
            Self::Formula(formula) => formula.eval_in(&[x, v], &mut [R::zero(); MAX_STACK]),
        }
    }

    /// Notes the branches that the law takes at deflection `x` and rate `v`, units as of [`NonlinearLaw::force`]: where
    /// they stay the same it is smooth.
    pub fn note_branches(&self, x: f64, v: f64, branches: &mut Branches) {
        match self {
            Self::Table(table) => branches.note(table.interval(x).0 as u64),
            Self::Ranges(ranges) => ranges.iter().for_each(|range| branches.note_side(range.force(x, v), 0.0)),
            Self::Formula(formula) => formula.note_branches(&[x, v], &mut [0.0; MAX_STACK], branches),
        }
    }

    /// Potential energy −∫₀ˣ N(s, 0) ds `[J]` at deflection `x` `[m]` or `[rad]`, zero at none; of a formula by
    /// quadrature, of ranges zero within them.
    pub fn potential<R: Real>(&self, x: R) -> R {
        let of = |x: f64| match self {
            Self::Table(table) => table.integral(0.0) - table.integral(x),
            Self::Ranges(ranges) => ranges.iter().map(|range| range.energy(x)).sum(),
            Self::Formula(_) => -quadrature(&|s| self.force(s, 0.0), 0.0, x),
        };
        x.map(|x| (of(x), -self.force(x, 0.0)))
    }

    /// −∂N/∂x and −∂N/∂ẋ, without derivatives of their own; zero where a slope is infinite or none, as that of a square
    /// root at 0, which is then taken explicitly.
    #[inline]
    pub fn negated_partials<R: Real>(&self, x: R, v: R) -> (R, R) {
        let partial = |i: usize| {
            R::from_lanes(|l| {
                let at = [Dual::<2>::variable(x.lane(l), 0), Dual::<2>::variable(v.lane(l), 1)];
                let partial = -self.force(at[0], at[1]).partials[i];
                if partial.is_finite() { partial } else { 0.0 }
            })
        };
        (partial(0), partial(1))
    }
}

/// Force over the deflection as a table, linear between its points and continued with the first and last slope beyond
/// them. Used in [`NonlinearLaw::Table`].
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTable {
    deflections: Vec<f64>,
    forces: Vec<f64>,
    /// ∫ of the force from the first deflection to each `[J]`.
    integrals: Vec<f64>,
}

impl ForceTable {
    /// Creates a table from points `[deflection, force]`, in units of `[m]` and `[N]` or `[rad]` and `[N·m]`.
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] for fewer than two points, numbers that are not finite, deflections that do not increase.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, InvalidParameters> {
        let mut problems = Vec::new();
        if points.len() < 2 {
            problems.push(format!("a table needs two points or more, not {}", points.len()));
        }
        if let Some(k) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            problems.push(format!("point {} of the table, {:?}, is not finite", k + 1, points[k]));
        } else if let Some(k) = points.windows(2).position(|p| p[1][0] <= p[0][0]) {
            problems.push(format!(
                "the deflections of a table increase: {} is followed by {}",
                points[k][0],
                points[k + 1][0]
            ));
        }
        if !problems.is_empty() {
            return Err(InvalidParameters::new(problems));
        }
        let mut integrals = vec![0.0];
        for p in points.windows(2) {
            integrals.push(integrals[integrals.len() - 1] + 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0]));
        }
        Ok(Self {
            deflections: points.iter().map(|p| p[0]).collect(),
            forces: points.iter().map(|p| p[1]).collect(),
            integrals,
        })
    }

    /// Interval that a deflection is in, the first and the last one continued, and the slope there.
    fn interval(&self, x: f64) -> (usize, f64) {
        let k = self.deflections.partition_point(|d| *d <= x).clamp(1, self.deflections.len() - 1) - 1;
        (k, (self.forces[k + 1] - self.forces[k]) / (self.deflections[k + 1] - self.deflections[k]))
    }

    /// Force and its slope.
    fn value(&self, x: f64) -> (f64, f64) {
        let (k, slope) = self.interval(x);
        (self.forces[k] + slope * (x - self.deflections[k]), slope)
    }

    /// ∫ of the force from the first deflection.
    fn integral(&self, x: f64) -> f64 {
        let (k, slope) = self.interval(x);
        let d = x - self.deflections[k];
        self.integrals[k] + (self.forces[k] + 0.5 * slope * d) * d
    }
}

impl<R: Real> ForceLaw<R> {
    /// Force F(x, ẋ) `[N]` or torque `[N·m]` at deflection `x` `[m]` or `[rad]` and rate `v` `[m/s]` or `[rad/s]`.
    #[inline(always)]
    pub fn force(&self, x: R, v: R) -> R {
        let linear = self.preload - self.stiffness * x - self.damping * v;
        match &self.nonlinear {
            None => linear,
            Some(law) => linear + law.force(x, v),
        }
    }

    /// Potential energy U(x) `[J]` at deflection `x` `[m]` or `[rad]`, zero at x = 0.
    #[inline(always)]
    pub fn potential(&self, x: R) -> R {
        let linear = (R::splat(0.5) * self.stiffness * x - self.preload) * x;
        match &self.nonlinear {
            None => linear,
            Some(law) => linear + law.potential(x),
        }
    }

    /// Stiffness −∂F/∂x `[N/m]` and damping −∂F/∂ẋ `[N·s/m]` (or their angular units) at `x` and `v`, negative ones
    /// taken as zero: the terms that a linearly implicit step evaluates at the new state. They carry no derivatives
    /// themselves.
    #[inline(always)]
    pub fn implicit_terms(&self, x: R, v: R) -> (R, R) {
        let (mut k, mut c) = (self.stiffness, self.damping);
        if let Some(law) = &self.nonlinear {
            let (of_x, of_v) = law.negated_partials(x, v);
            k += of_x;
            c += of_v;
        }
        (k.max(R::zero()), c.max(R::zero()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formula(text: &str) -> ForceLaw<f64> {
        let formula = Expression::parse(text, &FORMULA_NAMES).unwrap();
        let nonlinear = Some(Arc::new(NonlinearLaw::formula(formula).unwrap()));
        ForceLaw { stiffness: 3.0, damping: 0.5, preload: 2.0, nonlinear }
    }

    #[test]
    fn the_potential_of_a_formula_is_its_integral() {
        // −∫ (2 − 3 s − 10 |s| s) ds = −2 x + 3/2 x² + 10/3 |x|³
        let law = formula("-10*abs(x)*x - 5*v");
        for x in [-1.3, -0.2, 0.0, 0.7, 2.4] {
            let exact = -2.0 * x + 1.5 * x * x + 10.0 / 3.0 * f64::abs(x * x * x);
            assert!((law.potential(x) - exact).abs() < 1e-13 * (1.0 + exact.abs()), "{x}");
        }
        let law = formula("sin(3*x)");
        let exact = -2.0 * 1.7 + 1.5 * 1.7 * 1.7 - (1.0 - libm::cos(5.1)) / 3.0;
        assert!((law.potential(1.7) - exact).abs() < 1e-14);
    }

    #[test]
    fn a_table_is_linear_between_its_points_and_beyond() {
        let table = ForceTable::new(&[[-1.0, 4.0], [0.0, 0.0], [2.0, -6.0]]).unwrap();
        let nonlinear = Some(Arc::new(NonlinearLaw::Table(table)));
        let law = ForceLaw { stiffness: 0.0, damping: 0.0, preload: 0.0, nonlinear };
        for (x, force) in [(-2.0, 8.0), (-0.5, 2.0), (1.0, -3.0), (3.0, -9.0)] {
            assert_eq!(law.force(x, 7.0), force);
        }
        // ½·4·x² on the left, ½·3·x² on the right
        for (x, energy) in [(-2.0, 8.0), (-0.5, 0.5), (1.0, 1.5), (3.0, 13.5)] {
            assert!((law.potential(x) - energy).abs() < 1e-15, "{x}: {}", law.potential(x));
        }
        assert_eq!(law.implicit_terms(-0.5, 0.0), (4.0, 0.0));
    }

    #[test]
    fn beyond_a_range_a_spring_and_damper_pushes_back_and_never_pulls_on() {
        let range = FreeRange { low: -0.1, high: 0.3, stiffness: 100.0, damping: 4.0 };
        let nonlinear = Some(Arc::new(NonlinearLaw::Ranges(vec![range])));
        let law = ForceLaw { stiffness: 0.0, damping: 0.0, preload: 0.0, nonlinear };
        for (x, v, force) in [(0.0, 9.0, 0.0), (0.5, 0.0, -20.0), (0.5, 2.0, -28.0), (-0.2, -1.0, 14.0)] {
            assert!((law.force(x, v) - force).abs() < 1e-12, "{x}, {v}");
        }
        // it leaves faster than the spring follows
        assert_eq!((law.force(0.31, -5.0), law.force(-0.11, 5.0)), (0.0, 0.0));
        assert!((law.potential(0.5) - 2.0).abs() < 1e-14 && (law.potential(-0.2) - 0.5).abs() < 1e-14);
        assert_eq!((law.potential(0.2), law.implicit_terms(0.2, 1.0)), (0.0, (0.0, 0.0)));
        let (k, c) = law.implicit_terms(0.5, 2.0);
        assert!((k - 100.0).abs() < 1e-12 && (c - 4.0).abs() < 1e-12);
        let open = FreeRange { low: f64::NEG_INFINITY, ..range };
        assert_eq!((open.force(-1e9, -3.0), open.energy(-1e9)), (0.0, 0.0));
    }

    #[test]
    fn implicit_terms_are_the_negated_partial_derivatives_where_positive() {
        let law = formula("-10*x^3 + 2*v*x");
        let (k, c) = law.implicit_terms(0.5, 1.0);
        assert!((k - (3.0 + 7.5 - 2.0)).abs() < 1e-15 && c == 0.0);
    }

    #[test]
    fn derivatives_pass_through() {
        let law = formula("-10*abs(x)*x");
        let wide = ForceLaw {
            stiffness: Dual::<1>::constant(3.0),
            damping: Dual::constant(0.5),
            preload: Dual::constant(2.0),
            nonlinear: law.nonlinear.clone(),
        };
        let x = Dual::<1>::variable(0.4, 0);
        assert!((wide.force(x, Dual::constant(0.0)).partials[0] + 3.0 + 8.0).abs() < 1e-14);
        assert!((wide.potential(x).partials[0] + law.force(0.4, 0.0)).abs() < 1e-14);
    }

    #[test]
    fn tables_that_cannot_be_are_refused() {
        let refused = |points: &[[f64; 2]]| ForceTable::new(points).unwrap_err().to_string();
        assert!(refused(&[[0.0, 1.0]]).contains("two points"));
        assert!(refused(&[[0.0, 1.0], [0.0, 2.0]]).contains("0 is followed by 0"));
        assert!(refused(&[[0.0, f64::NAN], [1.0, 2.0]]).contains("point 1"));
    }
}

//! Scalar field: a formula of the position in space, such as a density or a component of a force field.

use crate::Real;
use crate::error::InvalidParameters;
use crate::expression::Expression;

/// Names in the formula of a [`ScalarField`], in the order that [`Expression::parse`] takes: coordinates of the
/// position `[m]`.
pub const POSITION_NAMES: [&str; 3] = ["x", "y", "z"];

/// Largest number of intermediate values of the formula: its stack stands in the function that evaluates it.
const MAX_STACK: usize = 16;

/// Formula of the position, evaluated without allocation on any kind of number.
///
/// ```
/// use sincro_math::expression::Expression;
/// use sincro_math::scalar_field::{POSITION_NAMES, ScalarField};
///
/// let density = ScalarField::new(Expression::parse("1.225*exp(-z/8500)", &POSITION_NAMES)?)?;
/// assert_eq!(density.at([3.0, -2.0, 0.0]), 1.225); // kg/m³
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ScalarField(Expression);

impl ScalarField {
    /// Creates the field of a formula that was parsed with [`POSITION_NAMES`].
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] if the formula needs more than 16 intermediate values at once.
    ///
    /// # Panics
    ///
    /// If the formula was parsed with more names than [`POSITION_NAMES`].
    pub fn new(formula: Expression) -> Result<Self, InvalidParameters> {
        if formula.stack_depth() > MAX_STACK {
            let message = format!(
                "the formula needs {} intermediate values at once, more than {MAX_STACK}",
                formula.stack_depth()
            );
            return Err(InvalidParameters::new(vec![message]));
        }
        assert!(!(3..8).any(|slot| formula.uses(slot)), "the formula has names beside x, y and z");
        Ok(Self(formula))
    }

    /// Value at a position `[m]`, in the unit of the formula.
    #[inline(always)]
    pub fn at<R: Real>(&self, position: [R; 3]) -> R {
        self.0.eval_in(&position, &mut [R::zero(); MAX_STACK])
    }

    /// Formula as it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        self.0.text()
    }
}

//! Relation between the units of the inputs and outputs of a block, as far as it follows from the block's definition.
//!
//! From these relations the compiler deduces the units of signals that nobody declares, along wires and against them
//! (`compile/deduced_units.rs`). They serve display only: units that are declared or follow by
//! [`Block::units`](crate::block::Block::units) are compared and win.

use sincro_math::expression::Expression;

use crate::unit::Unit;

/// Relation between the units of the inputs and outputs of a block; see
/// [`Block::unit_rule`](crate::block::Block::unit_rule).
#[derive(Clone, Debug, PartialEq)]
pub enum UnitRule {
    /// Nothing follows, as for a `gain`, whose factor may have any unit.
    Unknown,
    /// Outputs and the inputs of these ports have the same unit, component by component; a scalar counts for all.
    Same(Vec<usize>),
    /// All components of all inputs and outputs have one unit.
    Uniform,
    /// The components of the outputs are those of the inputs, in the same order.
    InOrder,
    /// Component k of the output is component `indices[k]` of the input.
    Components(Vec<usize>),
    /// Output port k has the unit of the first input times the second to the power of entry k.
    TimesSeconds(Vec<i8>),
    /// The output is the product of these powers of the inputs, component by component.
    Powers(Vec<i8>),
    /// The output is the square root of the input, component by component.
    SquareRoot,
    /// Every component of the output is a sum of products of one component of each input.
    SumOfProducts,
    /// Formulas of the inputs and, after these, the time: one for all components, or one for each with scalar inputs.
    Formulas(Vec<Expression>),
    /// Units of the components of all outputs, one after the other; one alone counts for all.
    Fixed(Vec<Option<Unit>>),
}

impl UnitRule {
    /// Rule of outputs whose components have these units.
    ///
    /// ```
    /// use sincro_blocks::unit_rule::UnitRule;
    ///
    /// let position_and_speed = UnitRule::fixed(["m", "m/s"]);
    /// assert!(matches!(position_and_speed, UnitRule::Fixed(units) if units.len() == 2));
    /// ```
    ///
    /// # Panics
    ///
    /// If a text is not a unit.
    #[must_use]
    pub fn fixed<'a>(units: impl IntoIterator<Item = &'a str>) -> Self {
        Self::Fixed(units.into_iter().map(|text| Some(Unit::parse(text).expect("a unit of the library"))).collect())
    }
}

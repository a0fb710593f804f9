//! Unilateral constraints with friction: who presses, sticks, slips or lets go.
//!
//! A block is a normal row with λ ≥ 0 ⊥ w ≥ 0 and up to three groups of friction rows: tangential (2 rows, coefficient μ), rolling (2 rows, a length)
//! and spinning (1 row, a length). Each group obeys |λ_g| ≤ c λ_n and opposes its own w_g with all of it where w_g ≠ 0: a disc, not a polygon.

use sincro_math::Real;

/// What a group of friction rows does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactMode {
    Stick,
    Slip,
}

/// One group of friction rows of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionGroup<R> {
    pub row: usize,
    pub dim: usize,
    pub coefficient: f64,
    /// Whether it slides with a velocity that gives the direction; else the direction follows from what it is about to do.
    pub slides: bool,
    pub grip: ContactMode,
    /// Direction of its force, if it slips.
    pub direction: [R; 2],
    /// How much rate across its direction a unit of force across it comes with, where it can turn. Of a group that slides so slowly that friction
    /// could turn its velocity within the step, so that the force is that of the end of the step: else friction that turns with a small velocity
    /// would be stiff without bound. And of one whose direction follows from what it is about to do ([`super::active_set`]).
    pub give: Option<R>,
}

impl<R: Real> FrictionGroup<R> {
    /// Sticks.
    pub fn stick(&mut self) {
        (self.grip, self.give) = (ContactMode::Stick, None);
    }

    /// Slips with its force along `direction`, giving way across it by `give` if that is known.
    pub fn slip(&mut self, direction: [R; 2], give: Option<R>) {
        (self.grip, self.direction) = (ContactMode::Slip, direction);
        self.give = give.filter(|_| self.dim == 2);
    }
}

/// A unilateral constraint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnilateralConstraint<R> {
    pub slot: usize,
    pub row: usize,
    /// Whether it lets go.
    pub open: bool,
    /// A normal force that is given, of a compliant contact.
    pub given: Option<R>,
    pub groups: [Option<FrictionGroup<R>>; 3],
    /// What can be seen of it: bit 0, it leaves; bits 1 to 3, a group starts to move. One of several redundant contacts may bear nothing and
    /// still neither leave nor move.
    pub effect: u8,
}

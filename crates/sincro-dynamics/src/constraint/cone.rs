//! Unilateral constraints with friction: contact modes (open, stick, slip) and friction groups.
//!
//! Unilateral constraint: a joint limit or a contact.

use sincro_math::Real;

/// Contact mode of a friction group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactMode {
    Stick,
    Slip,
}

/// Friction group of a unilateral constraint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionGroup<R> {
    pub row: usize,
    pub dim: usize,
    pub coefficient: f64,
    /// True if it slides with a velocity that gives the direction; else the direction follows from the solution
    /// (impending slip).
    pub slides: bool,
    pub mode: ContactMode,
    /// Direction of its force if it slips.
    pub direction: [R; 2],
    /// Compliance across its direction, rate over force, where the direction can turn. Of a group that slides so slowly
    /// that friction could turn its velocity within the step: the force is then that of the end of the step, since
    /// friction that turns with a small velocity would be stiff without bound. And of a group whose direction follows
    /// from the solution ([`super::active_set`]).
    pub compliance: Option<R>,
}

impl<R: Real> FrictionGroup<R> {
    /// Sets the group to stick.
    pub fn stick(&mut self) {
        (self.mode, self.compliance) = (ContactMode::Stick, None);
    }

    /// Sets the group to slip with its force along `direction`, and with a compliance across it if that is known.
    pub fn slip(&mut self, direction: [R; 2], compliance: Option<R>) {
        (self.mode, self.direction) = (ContactMode::Slip, direction);
        self.compliance = compliance.filter(|_| self.dim == 2);
    }
}

/// A unilateral constraint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnilateralConstraint<R> {
    pub slot: usize,
    pub row: usize,
    /// True if it is open (no force).
    pub open: bool,
    /// Prescribed normal force of a compliant contact.
    pub given: Option<R>,
    pub groups: [Option<FrictionGroup<R>>; 3],
    /// Observable change: bit 0, the constraint opens; bits 1 to 3, a group starts to slip. One of several redundant
    /// contacts may carry no force and yet neither open nor slip.
    pub effect: u8,
}

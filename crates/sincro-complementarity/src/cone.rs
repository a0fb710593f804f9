//! Unilateral constraints with friction: contact modes (open, stick, slip) and friction groups.
//!
//! Unilateral constraint: a joint limit or a contact.

use sincro_math::Real;

/// Contact mode of a friction group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactMode {
    /// Its rate is zero, its force within the cone.
    Stick,
    /// Its force is at its limit.
    Slip,
}

/// Friction group of a unilateral constraint: one or two rows, |λ_t| ≤ `coefficient`·λₙ.
#[derive(Clone, Copy, Debug)]
pub struct FrictionGroup<R> {
    /// First row of the problem.
    pub row: usize,
    /// Number of rows, 1 or 2.
    pub dim: usize,
    /// Friction coefficient (rolling and spinning: in metres).
    pub coefficient: f64,
    /// Factor on the tolerance by which its force may exceed its limit: a limit that is given is kept more closely than
    /// one that follows from a force which is a part of the solution.
    pub slack: f64,
    /// True if it slides with a velocity that gives the direction; else the direction follows from the solution
    /// (impending slip).
    pub is_sliding: bool,
    /// Contact mode: the start, and in the solution.
    pub mode: ContactMode,
    /// Direction of its force if it slips.
    pub direction: [R; 2],
    /// Compliance across its direction, rate over force, where the direction can turn: of a group whose direction
    /// follows from the solution (Newton's method), and of one that slides slowly
    /// ([`FrictionGroup::sliding_rate`]).
    pub compliance: Option<R>,
    /// Sliding at the start of the step, along the first row.
    pub slow_sliding: SlowSliding,
}

/// Sliding of a group that friction may turn within the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct SlowSliding {
    /// Speed [m/s] or [rad/s].
    pub speed: f64,
    /// Length of the step `[s]`.
    pub h: f64,
    /// Entry of G across the sliding direction.
    pub mobility: f64,
}

/// Distance of the speed from that which friction could not turn, relative to it, where the sliding rate ends.
const SLOWEST_RISE: f64 = 1e-6;

/// Largest difference of the components of directions that are the same.
const SAME_DIRECTION: f64 = 1e-6;

impl<R: Real> FrictionGroup<R> {
    /// Group of `dim` rows (1 or 2) from `row` on, sticking.
    #[must_use]
    pub fn sticking(row: usize, dim: usize, coefficient: f64) -> Self {
        Self {
            row,
            dim,
            coefficient,
            slack: 1.0,
            is_sliding: false,
            mode: ContactMode::Stick,
            direction: [R::zero(); 2],
            compliance: None,
            slow_sliding: SlowSliding::default(),
        }
    }

    /// Sliding velocity over the length of the step, for a `normal` force by which friction could turn it within the
    /// step. With the rate of the problem across it, it gives the direction at the end of the step, which the force
    /// then opposes: friction that turns with a small velocity would be stiff without bound. The rate grows without
    /// bound where the velocity comes near that which friction could not turn, so that the force is smooth there.
    #[must_use]
    pub fn sliding_rate(&self, normal: f64) -> Option<f64> {
        let SlowSliding { speed, h, mobility } = self.slow_sliding;
        let reach = h * self.coefficient * normal * mobility;
        let is_slow = self.is_sliding && normal > 0.0 && speed < reach * (1.0 - SLOWEST_RISE);
        is_slow.then(|| {
            let share = 1.0 - (speed / reach) * (speed / reach);
            speed / (h * share * share)
        })
    }

    /// Returns true if it sticks as `other` does, or slips in the same direction.
    fn has_mode_of(&self, other: &Self) -> bool {
        let is_near = |(x, y): (&R, &R)| (*x - *y).lane(0).abs() <= SAME_DIRECTION;
        self.mode == other.mode
            && (self.mode == ContactMode::Stick || self.direction.iter().zip(&other.direction).all(is_near))
    }

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

/// Slot of a constraint that is a limited drive.
pub const NO_SLOT: usize = usize::MAX;

/// Unilateral constraint: 0 ≤ λₙ ⊥ wₙ ≥ 0 in its normal row, with its friction.
#[derive(Clone, Copy, Debug)]
pub struct UnilateralConstraint<R> {
    /// Index in the caller's lists; [`NO_SLOT`] for a limited drive.
    pub slot: usize,
    /// Normal row of the problem.
    pub row: usize,
    /// True if it is open (no force).
    pub open: bool,
    /// Prescribed normal force: of a compliant contact, or impulse of an impact.
    pub given: Option<R>,
    /// True for a compliant contact.
    pub is_compliant: bool,
    /// Sliding, rolling and spinning friction.
    pub groups: [Option<FrictionGroup<R>>; 3],
}

impl<R: Real> UnilateralConstraint<R> {
    /// Closed rigid contact or joint limit with its normal force in `row`.
    #[must_use]
    pub fn contact(slot: usize, row: usize, groups: [Option<FrictionGroup<R>>; 3]) -> Self {
        Self { slot, row, open: false, given: None, is_compliant: false, groups }
    }

    /// Returns true if it is open as `other` is, or closed with the same modes of friction.
    pub(crate) fn has_modes_of(&self, other: &Self) -> bool {
        let same = |(one, two): (&Option<FrictionGroup<R>>, &Option<FrictionGroup<R>>)| match (one, two) {
            (Some(one), Some(two)) => one.has_mode_of(two),
            _ => one.is_none() && two.is_none(),
        };
        self.open == other.open && (self.open || self.groups.iter().zip(&other.groups).all(same))
    }

    /// Returns true if the constraint is a limited drive.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        self.slot == NO_SLOT
    }
}

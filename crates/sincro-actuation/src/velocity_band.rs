//! Width within which the velocity of a drive counts as its target.

/// Relative width below which two velocities count as equal.
const SAME_VELOCITY: f64 = 1e-12;

/// Width within which the velocity of a drive counts as its target.
///
/// ```
/// use sincro_actuation::VelocityBand;
///
/// let band = VelocityBand::default();
/// assert_eq!(band.error(2.0, 2.0 - 1e-13), 0.0);
/// // a drive that pushes forwards has passed its target
/// assert!(band.is_beyond(2.0, 2.1, 1.0) && !band.is_beyond(2.0, 2.1, -1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct VelocityBand {
    /// Least velocity that the width is relative to [rad/s] or [m/s].
    least: f64,
}

impl Default for VelocityBand {
    fn default() -> Self {
        Self { least: 1e-3 }
    }
}

impl VelocityBand {
    /// Band where constraints hold what drives push against: its velocity drifts by the rounding of their solution.
    pub const CONSTRAINED: Self = Self { least: 1.0 };

    fn width(self, target: f64, v: f64) -> f64 {
        SAME_VELOCITY * target.abs().max(v.abs()).max(self.least)
    }

    /// Target minus present velocity, zero within the band [rad/s] or [m/s].
    #[must_use]
    pub fn error(self, target: f64, v: f64) -> f64 {
        let missing = target - v;
        if missing.abs() <= self.width(target, v) { 0.0 } else { missing }
    }

    /// Distance of a velocity beyond its target, in the direction in which a drive pushes (the sign of `saturation`),
    /// and beyond the band [rad/s] or [m/s].
    #[must_use]
    pub fn passage(self, target: f64, v: f64, saturation: f64) -> f64 {
        (v - target) * saturation.signum() - self.width(target, v)
    }

    /// Returns true if a velocity is beyond its target in the direction in which a drive pushes.
    #[must_use]
    pub fn is_beyond(self, target: f64, v: f64, saturation: f64) -> bool {
        saturation != 0.0 && self.passage(target, v, saturation) > 0.0
    }
}

//! A rotor on a link: from the motion of its hub to the wrench on the airframe.

use sincro_math::Real;

use super::{CoefficientTable, ConstantCoefficients, Load, Rotor, Validity};
use crate::spatial::{Force, Motion, Pose, Vec3};

/// How thrust and torque follow from speed and motion.
#[derive(Clone, Debug, PartialEq)]
pub enum RotorLaw {
    /// Blade elements and momentum.
    Blade(Rotor),
    /// T = bΩ², Q = kΩ².
    Constant(ConstantCoefficients),
    /// Coefficients over the advance ratio.
    Table(CoefficientTable),
}

/// A rotor fixed on a link; its speed is a command of the world.
#[derive(Clone, Debug)]
pub struct MountedRotor<R> {
    /// The link.
    pub link: usize,
    /// Hub frame in the link; the thrust axis is z.
    pub pose: Pose<R>,
    /// Its law.
    pub law: RotorLaw,
    /// Which of the commands is its speed [rad/s].
    pub command: usize,
    /// Density of the air [kg/m³].
    pub density: f64,
}

impl<R: Real> MountedRotor<R> {
    /// Velocity of the hub [m/s] in hub axes, for the twist of its link in link axes: ω×r is part of it.
    #[inline(always)]
    pub fn hub_velocity(&self, twist: &Motion<R>) -> Vec3<R> {
        self.pose.rot.tr_mul_vec(twist.lin + twist.ang.cross(self.pose.pos))
    }

    /// Thrust, torque, inflow and power at `speed` [rad/s] with the link moving with `twist`.
    #[inline(always)]
    pub fn load(&self, speed: R, twist: &Motion<R>) -> Load<R> {
        let velocity = self.hub_velocity(twist);
        match &self.law {
            RotorLaw::Blade(rotor) => rotor.evaluate(self.density, speed, velocity),
            RotorLaw::Constant(law) => law.evaluate(speed),
            RotorLaw::Table(law) => law.evaluate(self.density, speed, velocity),
        }
    }

    /// The wrench of a load on the link, about the link's origin, link axes.
    #[inline(always)]
    pub fn wrench(&self, load: &Load<R>) -> Force<R> {
        let axis = self.pose.rot.mul_vec(Vec3([R::zero(), R::zero(), R::one()]));
        let lin = axis.scale(load.thrust);
        Force { ang: axis.scale(load.torque) + self.pose.pos.cross(lin), lin }
    }

    /// Whether the law holds there; only blade elements say no.
    #[must_use]
    pub fn validity(&self, speed: R, twist: &Motion<R>, load: &Load<R>) -> Validity {
        match &self.law {
            RotorLaw::Blade(rotor) => rotor.validity(speed, self.hub_velocity(twist), load),
            _ => Validity::Valid,
        }
    }
}

//! A rotor on a link: from the motion of its hub to the wrench on the airframe, and where its speed comes from.

use sincro_math::Real;

use super::printed::PrintedScript;
use super::{CoefficientTable, ConstantCoefficients, Load, Rotor, Spin, StockPropeller, Validity};
use crate::drag::velocity_in_air;
use crate::wind::Air;
use sincro_geometry::spatial::{Force, Motion, Pose, Vec3};

/// Aerodynamic law of a rotor: thrust and torque from speed and motion.
#[derive(Clone, Debug, PartialEq)]
pub enum RotorLaw {
    /// Blade elements and momentum.
    Blade(Rotor),
    /// T = bΩ², Q = kΩ².
    Constant(ConstantCoefficients),
    /// Coefficients over the advance ratio.
    Table(CoefficientTable),
    /// V-REP's jet of particles; its speed is their velocity [m/s].
    Stock(StockPropeller),
    /// The script as published, defects and NaN included.
    Printed(PrintedScript),
}

impl RotorLaw {
    /// Sense of rotation at positive speed; none where the law has none.
    #[must_use]
    pub fn spin(&self) -> Option<Spin> {
        match self {
            Self::Blade(rotor) => Some(rotor.spec().spin),
            Self::Constant(law) => Some(law.spin),
            Self::Table(law) => Some(law.spin()),
            Self::Stock(_) | Self::Printed(_) => None,
        }
    }
}

/// Source of a rotor's speed [rad/s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedSource<R> {
    /// It is this command.
    Command(usize),
    /// It follows a command with a first-order lag, Ω' = (command − Ω)/τ.
    Lag {
        /// The command.
        command: usize,
        /// Index among the states of rotors.
        state: usize,
        /// τ `[s]`.
        time_constant: R,
        /// Initial speed [rad/s].
        initial: R,
    },
    /// Velocity of the particles of a stock propeller [m/s], which is this command.
    Particles {
        /// The command.
        command: usize,
        /// Index among the states of rotors of the mass flow during the present tick [kg/s].
        state: usize,
    },
    /// It turns with a joint.
    Joint {
        /// The joint's degree of freedom.
        dof: usize,
        /// Speed by the rate of the joint: +1 or −1.
        sign: f64,
    },
}

impl<R: Real> SpeedSource<R> {
    /// Speed of the rotor `[rad/s]` for velocities `v` (n_v), commands and states of rotors.
    #[inline(always)]
    pub fn value(&self, v: &[R], commands: &[R], rotors: &[R]) -> R {
        match *self {
            Self::Command(command) | Self::Particles { command, .. } => commands[command],
            Self::Lag { state, .. } => rotors[state],
            Self::Joint { dof, sign } => R::splat(sign) * v[dof],
        }
    }

    /// The command it takes, if it takes one.
    #[must_use]
    pub fn command(&self) -> Option<usize> {
        match *self {
            Self::Command(command) | Self::Particles { command, .. } | Self::Lag { command, .. } => Some(command),
            Self::Joint { .. } => None,
        }
    }

    /// Returns true if the load is a direct feedthrough of the command.
    #[must_use]
    pub fn follows_at_once(&self) -> bool {
        matches!(self, Self::Command(_) | Self::Particles { .. })
    }

    /// Index among the states of rotors, if it has one.
    #[must_use]
    pub fn state(&self) -> Option<usize> {
        match *self {
            Self::Lag { state, .. } | Self::Particles { state, .. } => Some(state),
            Self::Command(_) | Self::Joint { .. } => None,
        }
    }

    /// Initial value of the rotor's own state, a speed `[rad/s]`, if it has one.
    #[must_use]
    pub fn initial(&self) -> Option<R> {
        match *self {
            Self::Lag { initial, .. } => Some(initial),
            Self::Particles { .. } => Some(R::zero()),
            Self::Command(_) | Self::Joint { .. } => None,
        }
    }

    /// Time constant `[s]` and initial speed `[rad/s]` of a lag.
    #[must_use]
    pub fn lag(&self) -> Option<(R, R)> {
        match *self {
            Self::Lag { time_constant, initial, .. } => Some((time_constant, initial)),
            _ => None,
        }
    }

    /// Structure without numbers, which the worlds of a batch share: index of the command, index of the state, and
    /// degree of freedom with the bits of its sign.
    #[must_use]
    pub fn structure(&self) -> (Option<usize>, Option<usize>, Option<(usize, u64)>) {
        let joint = match *self {
            Self::Joint { dof, sign } => Some((dof, sign.to_bits())),
            _ => None,
        };
        (self.command(), self.state(), joint)
    }

    /// Counts the command from `by` on.
    pub fn shift_command(&mut self, by: usize) {
        match self {
            Self::Command(command) | Self::Particles { command, .. } | Self::Lag { command, .. } => *command += by,
            Self::Joint { .. } => {}
        }
    }
}

/// The hub of a rotor at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Hub<'a, R> {
    /// Velocity in the air [m/s], axes of the rotor: ω×r is part of it.
    pub velocity: Vec3<R>,
    /// Angular velocity of the airframe [rad/s], axes of the rotor.
    pub angular_velocity: Vec3<R>,
    /// Pose of the link in the world.
    pub x_wl: &'a Pose<R>,
}

/// A rotor fixed on a link.
#[derive(Clone, Debug)]
pub struct MountedRotor<R> {
    /// The link.
    pub link: usize,
    /// Hub frame in the link; the thrust axis is z.
    pub pose: Pose<R>,
    /// Its law.
    pub law: RotorLaw,
    /// Source of its speed.
    pub speed: SpeedSource<R>,
    /// Density of the air [kg/m³].
    pub density: f64,
    /// Moment of inertia of the turning part about its axis [kg·m²]: that of the gyroscopic moment alone, the airframe
    /// holds the mass; 0 for none.
    pub inertia: f64,
    /// True if the ground at z = 0 holds the induced velocity back; of blade elements only.
    pub ground_effect: bool,
}

impl<R: Real> MountedRotor<R> {
    /// Motion of the hub and the air at it, for the twist of its link in link axes `[rad/s]`, `[m/s]` and the link's
    /// pose in the world `[m]`.
    #[inline(always)]
    pub fn hub<'a>(&self, twist: &Motion<R>, x_wl: &'a Pose<R>, air: Option<&Air<'_>>) -> Hub<'a, R> {
        let angular_velocity = self.pose.rot.tr_mul_vec(twist.ang);
        Hub { velocity: velocity_in_air(&self.pose, twist, x_wl, air), angular_velocity, x_wl }
    }

    /// Thrust, torque, inflow and power at `speed` [rad/s]; `rotors` are the states of all rotors.
    #[inline(always)]
    pub fn load(&self, speed: R, rotors: &[R], hub: &Hub<'_, R>) -> Load<R> {
        let mut load = self.aerodynamic_load(speed, rotors, hub);
        if self.inertia != 0.0 {
            // −ω × h, h = I Ω along the axis
            let momentum = R::splat(self.inertia * self.law.spin().map_or(0.0, Spin::sign)) * speed;
            let [x, y, _] = hub.angular_velocity.0;
            load.gyroscopic = [-(y * momentum), x * momentum];
        }
        load
    }

    #[inline(always)]
    fn aerodynamic_load(&self, speed: R, rotors: &[R], hub: &Hub<'_, R>) -> Load<R> {
        match &self.law {
            RotorLaw::Blade(rotor) if self.ground_effect => {
                let height = hub.x_wl.point(self.pose.pos)[2];
                rotor.evaluate_near_ground(self.density, speed, hub.velocity, height)
            }
            RotorLaw::Blade(rotor) => rotor.evaluate(self.density, speed, hub.velocity),
            RotorLaw::Constant(law) => law.evaluate(speed),
            RotorLaw::Table(law) => law.evaluate(self.density, speed, hub.velocity),
            RotorLaw::Stock(law) => {
                let flow = self.speed.state().map_or(R::zero(), |state| rotors[state]);
                Load { thrust: flow * speed, torque: law.torque(speed), ..Load::default() }
            }
            RotorLaw::Printed(script) => {
                let r_wh = hub.x_wl.rot.mul(&self.pose.rot);
                script.load(self.density, speed, r_wh.mul_vec(hub.velocity), &r_wh)
            }
        }
    }

    /// Wrench of a load on the link, about the link's origin `[N·m]`, `[N]`, in link axes.
    #[inline(always)]
    pub fn wrench(&self, load: &Load<R>) -> Force<R> {
        let axis = self.pose.rot.mul_vec(Vec3([R::zero(), R::zero(), R::one()]));
        let lin = axis.scale(load.thrust);
        let mut ang = axis.scale(load.torque) + self.pose.pos.cross(lin);
        if self.inertia != 0.0 {
            let [x, y] = load.gyroscopic;
            ang += self.pose.rot.mul_vec(Vec3([x, y, R::zero()]));
        }
        Force { ang, lin }
    }

    /// Validity of the rotor's theory at a speed `[rad/s]` and a load; only the first lane is examined. Constant
    /// coefficients and V-REP's particles are always valid.
    #[must_use]
    pub fn validity(&self, speed: R, hub: &Hub<'_, R>, load: &Load<R>) -> Validity {
        match &self.law {
            RotorLaw::Blade(rotor) => rotor.validity(speed, hub.velocity, load),
            RotorLaw::Table(law) => law.validity(speed, hub.velocity),
            RotorLaw::Printed(_) if !load.thrust.lane(0).is_finite() || !load.torque.lane(0).is_finite() => {
                Validity::NotANumber
            }
            RotorLaw::Constant(_) | RotorLaw::Stock(_) | RotorLaw::Printed(_) => Validity::Valid,
        }
    }
}

//! A rotor on a link: from the motion of its hub to the wrench on the airframe, and where its speed comes from.

use std::sync::Arc;

use sincro_math::Real;
use sincro_math::scalar_field::ScalarField;

use super::printed::PrintedScript;
use super::{CoefficientTable, ConstantCoefficients, Load, Rotor, Spin, StockPropeller, Validity};
use crate::drag::velocity_in_air;
use crate::wind::Air;
use sincro_geometry::spatial::{Force, Motion, Pose, Vec3};

/// Aerodynamic law of a [`MountedRotor`]: thrust and reaction torque from rotor speed and motion of the hub.
#[derive(Clone, Debug, PartialEq)]
pub enum RotorLaw {
    /// Blade elements with momentum theory.
    Blade(Rotor),
    /// Constant coefficients: T = bΩ², Q = kΩ².
    Constant(ConstantCoefficients),
    /// Measured coefficients over the advance ratio.
    Table(CoefficientTable),
    /// V-REP's jet of particles; its "speed" is the velocity of the particles `[m/s]`.
    Stock(StockPropeller),
    /// A published script as it stands, defects and NaN included; for comparison.
    Printed(PrintedScript),
}

impl RotorLaw {
    /// Sense of rotation at positive speed; `None` for the laws without one (stock propeller, published script).
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

/// Source of a rotor's speed `[rad/s]`, or of the particles' velocity of a stock propeller `[m/s]`.
///
/// Indices of commands count the commands of the model (`State::commands`), those of states the model's rotor states
/// (`State::rotors`): one for each rotor with a `Lag` or `Particles`, in the order of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedSource<R> {
    /// The speed is the command of this index `[rad/s]`.
    Command(usize),
    /// The speed follows a command with a first-order lag, Ω' = (command − Ω)/τ.
    Lag {
        /// Index of the command `[rad/s]`.
        command: usize,
        /// Index of the rotor state that holds the speed Ω `[rad/s]`.
        state: usize,
        /// Time constant τ `[s]`, positive.
        time_constant: R,
        /// Speed at the start `[rad/s]`.
        initial: R,
    },
    /// Stock propeller: the command is the velocity of the particles `[m/s]`.
    Particles {
        /// Index of the command `[m/s]`.
        command: usize,
        /// Index of the rotor state that holds the mass flow during the present base step `[kg/s]`.
        state: usize,
    },
    /// The rotor turns with a joint of the model.
    Joint {
        /// Index of the joint's degree of freedom in the generalized velocities, 0 to n_v − 1.
        dof: usize,
        /// Rotor speed over the rate of the joint: +1 or −1 (dimensionless).
        sign: f64,
    },
}

impl<R: Real> SpeedSource<R> {
    /// Speed of the rotor `[rad/s]` (of a stock propeller: velocity of the particles `[m/s]`).
    ///
    /// `v` are the generalized velocities (n_v), `commands` all commands and `rotors` all rotor states of the model, in
    /// its order.
    ///
    /// # Panics
    ///
    /// If a slice is too short for the index that the source holds in it.
    #[inline(always)]
    pub fn value(&self, v: &[R], commands: &[R], rotors: &[R]) -> R {
        match *self {
            Self::Command(command) | Self::Particles { command, .. } => commands[command],
            Self::Lag { state, .. } => rotors[state],
            Self::Joint { dof, sign } => R::splat(sign) * v[dof],
        }
    }

    /// Index of its command in the commands of the model; `None` for a rotor on a joint.
    #[must_use]
    pub fn command(&self) -> Option<usize> {
        match *self {
            Self::Command(command) | Self::Particles { command, .. } | Self::Lag { command, .. } => Some(command),
            Self::Joint { .. } => None,
        }
    }

    /// Returns true if the load is a direct feedthrough of the command: a rotor without lag.
    #[must_use]
    pub fn follows_at_once(&self) -> bool {
        matches!(self, Self::Command(_) | Self::Particles { .. })
    }

    /// Index of its rotor state in `State::rotors`; `None` if it has none (`Command`, `Joint`).
    #[must_use]
    pub fn state(&self) -> Option<usize> {
        match *self {
            Self::Lag { state, .. } | Self::Particles { state, .. } => Some(state),
            Self::Command(_) | Self::Joint { .. } => None,
        }
    }

    /// Initial value of its rotor state: of a lag the speed `[rad/s]`, of a stock propeller the mass flow `[kg/s]`,
    /// zero. `None` if it has no state.
    #[must_use]
    pub fn initial(&self) -> Option<R> {
        match *self {
            Self::Lag { initial, .. } => Some(initial),
            Self::Particles { .. } => Some(R::zero()),
            Self::Command(_) | Self::Joint { .. } => None,
        }
    }

    /// Time constant `[s]` and initial speed `[rad/s]` of a lag, in this order; `None` for the other sources.
    #[must_use]
    pub fn lag(&self) -> Option<(R, R)> {
        match *self {
            Self::Lag { time_constant, initial, .. } => Some((time_constant, initial)),
            _ => None,
        }
    }

    /// Structure without parameters, which the worlds of a batch must share: index of the command, index of the rotor
    /// state, and degree of freedom of the joint with the bits of its sign (`f64::to_bits`); each `None` where the
    /// source has none.
    #[must_use]
    pub fn structure(&self) -> (Option<usize>, Option<usize>, Option<(usize, u64)>) {
        let joint = match *self {
            Self::Joint { dof, sign } => Some((dof, sign.to_bits())),
            _ => None,
        };
        (self.command(), self.state(), joint)
    }

    /// Adds `by` to the index of the command: the builder numbers the rotors' commands from 0, the model puts them
    /// after those of motors and external forces. No effect on a rotor on a joint.
    pub fn shift_command(&mut self, by: usize) {
        match self {
            Self::Command(command) | Self::Particles { command, .. } | Self::Lag { command, .. } => *command += by,
            Self::Joint { .. } => {}
        }
    }
}

/// Motion of a rotor's hub at one instant: from [`MountedRotor::hub`], argument of [`MountedRotor::load`].
#[derive(Clone, Copy, Debug)]
pub struct Hub<'a, R> {
    /// Velocity of the hub relative to the air `[m/s]`, in rotor axes; includes ω × r of the link's rotation.
    pub velocity: Vec3<R>,
    /// Angular velocity of the link that carries the rotor `[rad/s]`, in rotor axes.
    pub angular_velocity: Vec3<R>,
    /// Pose of the link in the world `[m]`.
    pub x_wl: &'a Pose<R>,
}

/// Rotor fixed on a link, with its law, the source of its speed and the air: a force element of the model
/// (`Model::rotors` of `sincro-dynamics`).
#[derive(Clone, Debug)]
pub struct MountedRotor<R> {
    /// Index of the link that carries it, counted from 0 in the model's links.
    pub link: usize,
    /// Pose of the rotor's axes in the link `[m]`: the origin is the hub, z the thrust axis.
    pub pose: Pose<R>,
    /// Aerodynamic law.
    pub law: RotorLaw,
    /// Source of its speed.
    pub speed: SpeedSource<R>,
    /// Density of the air [kg/m³]; 1 where `atmosphere` gives it.
    pub density: f64,
    /// Density of the air [kg/m³] over the position of the hub in the world; `None`: the same everywhere.
    pub atmosphere: Option<Arc<ScalarField>>,
    /// Moment of inertia of the turning part about its axis `[kg·m²]`, for the gyroscopic moment only (its mass belongs
    /// to the link); 0 for none.
    pub inertia: f64,
    /// True if the ground at z = 0 of the world holds the induced velocity back; only of [`RotorLaw::Blade`].
    pub ground_effect: bool,
}

impl<R: Real> MountedRotor<R> {
    /// Motion of the hub relative to the air.
    ///
    /// `twist` is that of the link about its origin, in link axes (angular `[rad/s]`, linear `[m/s]`); `x_wl` is the
    /// pose of the link in the world `[m]`; without `air` the air rests.
    #[inline(always)]
    pub fn hub<'a>(&self, twist: &Motion<R>, x_wl: &'a Pose<R>, air: Option<&Air<'_>>) -> Hub<'a, R> {
        let angular_velocity = self.pose.rot.tr_mul_vec(twist.ang);
        Hub { velocity: velocity_in_air(&self.pose, twist, x_wl, air), angular_velocity, x_wl }
    }

    /// Load at the rotor's `speed` where it does not depend on the motion of the hub: that of constant coefficients and
    /// of V-REP's particles, without a gyroscopic moment. `None` for other rotors; see [`MountedRotor::load`].
    ///
    /// # Panics
    ///
    /// As [`MountedRotor::load`].
    #[inline(always)]
    pub fn load_at_any_motion(&self, speed: R, rotors: &[R]) -> Option<Load<R>> {
        if self.inertia != 0.0 {
            return None;
        }
        match &self.law {
            RotorLaw::Constant(law) => Some(law.evaluate(speed)),
            RotorLaw::Stock(law) => Some(self.load_of_particles(law, speed, rotors)),
            RotorLaw::Blade(_) | RotorLaw::Table(_) | RotorLaw::Printed(_) => None,
        }
    }

    /// Returns true if the load depends on the motion of the hub: [`MountedRotor::load_at_any_motion`] is `None`.
    #[inline(always)]
    #[must_use]
    pub fn feels_motion(&self) -> bool {
        self.inertia != 0.0 || !matches!(self.law, RotorLaw::Constant(_) | RotorLaw::Stock(_))
    }

    /// Thrust, reaction torque, inflow, gyroscopic moment and power at the rotor's `speed` (from
    /// [`SpeedSource::value`]).
    ///
    /// `rotors` are all rotor states of the model, of which a stock propeller reads its mass flow `[kg/s]`.
    ///
    /// # Panics
    ///
    /// For a stock propeller, if `rotors` is shorter than the index of its state.
    #[inline(always)]
    pub fn load(&self, speed: R, rotors: &[R], hub: &Hub<'_, R>) -> Load<R> {
        let mut load = self.aerodynamic_load(speed, rotors, hub);
        if let Some(density) = &self.atmosphere
            && matches!(self.law, RotorLaw::Blade(_) | RotorLaw::Table(_) | RotorLaw::Printed(_))
        {
            // those of a density of 1: forces are proportional to it, the inflow does not depend on it
            let density = density.at(hub.x_wl.point(self.pose.pos).0);
            load = Load {
                thrust: density * load.thrust,
                torque: density * load.torque,
                power: density * load.power,
                ..load
            };
        }
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
            RotorLaw::Stock(law) => self.load_of_particles(law, speed, rotors),
            RotorLaw::Printed(script) => {
                let r_wh = hub.x_wl.rot.mul(&self.pose.rot);
                script.load(self.density, speed, r_wh.mul_vec(hub.velocity), &r_wh)
            }
        }
    }

    #[inline(always)]
    fn load_of_particles(&self, law: &StockPropeller, speed: R, rotors: &[R]) -> Load<R> {
        let flow = match self.speed.state() {
            Some(state) => rotors[state],
            None => R::zero(),
        };
        Load { thrust: flow * speed, torque: law.torque(speed), ..Load::default() }
    }

    /// Wrench of `load` on the link: moment about the link's origin `[N·m]` and force `[N]`, in link axes.
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

    /// Validity of the rotor's theory for a `load` that [`MountedRotor::load`] returned for the same `speed` and `hub`.
    ///
    /// Constant coefficients and V-REP's particles are always valid; the published script unless its load is not
    /// finite. Of lanes, that of number `lane` is examined.
    #[must_use]
    pub fn validity(&self, speed: R, hub: &Hub<'_, R>, load: &Load<R>, lane: usize) -> Validity {
        match &self.law {
            RotorLaw::Blade(rotor) => rotor.validity(speed, hub.velocity, load, lane),
            RotorLaw::Table(law) => law.validity(speed, hub.velocity, lane),
            RotorLaw::Printed(_) if !load.thrust.lane(lane).is_finite() || !load.torque.lane(lane).is_finite() => {
                Validity::NotANumber
            }
            RotorLaw::Constant(_) | RotorLaw::Stock(_) | RotorLaw::Printed(_) => Validity::Valid,
        }
    }
}

//! Motors, with the modes that V-REP has.
//!
//! | mode | torque |
//! |---|---|
//! | `Free` | none |
//! | `Torque` | the command, limited |
//! | `Velocity` | whatever holds the commanded velocity exactly, limited |
//! | `Position` | as `Velocity`, towards the commanded position: velocity kp·(command − q), limited |
//! | `Spring` | stiffness·(command − q) − damping·q̇, limited |
//! | `Voltage` | that of a direct-current motor's winding, see [`winding`](crate::winding) |
//!
//! `Velocity` and `Position` are constraints, not stiff gains: drives, see [`kink`](crate::kink).

use sincro_math::Real;

/// Distance from a limit of its joint at which an ideal motor stops `[rad]` or `[m]`: a limit counts as closed at 1e-9.
pub const LEFT_TO_LIMIT: f64 = 2e-9;

/// Control mode of a [`Motor`]: the meaning and unit of its command.
///
/// ```
/// use sincro_actuation::{Motor, MotorMode};
///
/// // an ideal servo: it holds the commanded velocity exactly, whatever the load
/// let motor = Motor::new(MotorMode::Velocity);
/// assert!(motor.is_drive() && motor.target_velocity(0.3, 2.0) == 2.0);
/// // towards a position: 5 rad/s for each radian of error, 1 rad/s at most
/// let motor = Motor { kp: 5.0, max_velocity: 1.0, ..Motor::new(MotorMode::Position) };
/// assert!((motor.target_velocity(0.3, 0.4) - 0.5).abs() < 1e-15);
/// assert_eq!(motor.target_velocity(0.3, 2.0), 1.0);
/// assert!(!Motor::new(MotorMode::Torque).is_drive());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MotorMode {
    /// No torque; the command is ignored.
    Free,
    /// The command is the torque `[N·m]` or force `[N]`.
    Torque,
    /// The command is the velocity `[rad/s]` or `[m/s]`, held exactly within the torque limit.
    Velocity,
    /// The command is the position `[rad]` or `[m]`, approached at a velocity of `kp` times the error.
    Position,
    /// The command is the rest position `[rad]` or `[m]` of a spring and damper.
    Spring,
    /// The command is the voltage `[V]` across the motor's [`Winding`](crate::Winding); without one no torque.
    Voltage,
}

/// Motor on one degree of freedom, with its mode, limits and gains; attached to a joint by `JointSpec::motor`.
///
/// ```
/// use sincro_actuation::{Motor, MotorMode};
///
/// let motor = Motor { max_torque: 2.0, ..Motor::new(MotorMode::Torque) };
/// let explicit = (0.0, 0.0);
/// assert_eq!(motor.torque(0.3, 1.0, 10.0, explicit).0, 2.0); // [N·m], of 10 wanted
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor<R> {
    /// Index of the degree of freedom, 0 to n_v − 1; set when the model is built.
    pub dof: usize,
    /// Control mode.
    pub mode: MotorMode,
    /// Largest torque [N·m] or force `[N]`; infinite for an ideal motor.
    pub max_torque: R,
    /// Position mode: velocity per unit of position error `[1/s]`.
    pub kp: R,
    /// Position mode: largest velocity [rad/s] or [m/s]; infinite for none.
    pub max_velocity: R,
    /// Spring mode: stiffness `[N·m/rad]` or `[N/m]`.
    pub stiffness: R,
    /// Spring mode: damping `[N·m·s/rad]` or `[N·s/m]`.
    pub damping: R,
}

impl Motor<f64> {
    /// Motor without limits, all gains zero, on degree of freedom 0 until the model is built.
    #[must_use]
    pub fn new(mode: MotorMode) -> Self {
        let inf = f64::INFINITY;
        Self { dof: 0, mode, max_torque: inf, kp: 0.0, max_velocity: inf, stiffness: 0.0, damping: 0.0 }
    }

    /// Parameters with their field names, for checks: `max_torque` `[N·m]` or `[N]`, `kp` `[1/s]`, `max_velocity`
    /// `[rad/s]` or `[m/s]`, `stiffness` `[N·m/rad]` or `[N/m]`, `damping` `[N·m·s/rad]` or `[N·s/m]`.
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, f64); 5] {
        [
            ("max_torque", self.max_torque),
            ("kp", self.kp),
            ("max_velocity", self.max_velocity),
            ("stiffness", self.stiffness),
            ("damping", self.damping),
        ]
    }
}

impl<R: Real> Motor<R> {
    /// Returns true if the motor is a velocity constraint (a drive): in velocity and position mode.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        matches!(self.mode, MotorMode::Velocity | MotorMode::Position)
    }

    /// Target velocity of a drive `[rad/s]` or `[m/s]` at the coordinate `q` `[rad]` or `[m]`: in position mode
    /// kp·(`command` − q), limited; else the command. `command` is in the unit of the mode.
    #[inline(always)]
    pub fn target_velocity(&self, q: R, command: R) -> R {
        match self.mode {
            MotorMode::Position => (self.kp * (command - q)).clamp_abs(self.max_velocity),
            _ => command,
        }
    }

    /// Torque in modes that are not constraints, and the implicit diagonal, for a step that takes dampers implicitly
    /// over `steps.0` and springs over `steps.1` (0: explicit).
    #[inline(always)]
    pub fn torque(&self, q: R, v: R, command: R, steps: (R, R)) -> (R, R) {
        match self.mode {
            MotorMode::Torque => (command.clamp_abs(self.max_torque), R::zero()),
            MotorMode::Spring => {
                let wanted = self.stiffness * (command - (q + steps.1 * v)) - self.damping * v;
                let implicit = steps.0 * (self.damping + steps.1 * self.stiffness);
                // a saturated motor has a constant torque
                let within = wanted.abs().if_less(self.max_torque, implicit, R::zero());
                (wanted.clamp_abs(self.max_torque), within)
            }
            MotorMode::Free | MotorMode::Velocity | MotorMode::Position | MotorMode::Voltage => (R::zero(), R::zero()),
        }
    }
}

//! Motors, with the modes that V-REP has.
//!
//! | mode | torque |
//! |---|---|
//! | `Free` | none |
//! | `Torque` | the command, limited |
//! | `Velocity` | whatever holds the commanded velocity exactly, limited |
//! | `Position` | as `Velocity`, towards the commanded position: velocity kp·(command − q), limited |
//! | `Spring` | stiffness·(command − q) − damping·q̇, limited |
//!
//! `Velocity` and `Position` are constraints, not stiff gains: see [`crate::actuation::drive`].

use sincro_math::Real;

/// Control mode of a motor, which gives its command a meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MotorMode {
    /// Nothing.
    Free,
    /// Command: torque [N·m] or force `[N]`.
    Torque,
    /// Command: velocity [rad/s] or [m/s].
    Velocity,
    /// Command: position `[rad]` or `[m]`.
    Position,
    /// Command: rest position `[rad]` or `[m]`.
    Spring,
}

/// A motor on one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor<R> {
    /// The degree of freedom; set when the model is built.
    pub dof: usize,
    /// Mode.
    pub mode: MotorMode,
    /// Largest torque [N·m] or force `[N]`; infinite for an ideal motor.
    pub max_torque: R,
    /// Position mode: velocity a unit of error [1/s].
    pub kp: R,
    /// Position mode: largest velocity [rad/s] or [m/s]; infinite for none.
    pub max_velocity: R,
    /// Spring mode [N·m/rad] or [N/m].
    pub stiffness: R,
    /// Spring mode [N·m·s/rad] or [N·s/m].
    pub damping: R,
}

impl Motor<f64> {
    /// A motor without limits; gains zero.
    #[must_use]
    pub fn new(mode: MotorMode) -> Self {
        let inf = f64::INFINITY;
        Self { dof: 0, mode, max_torque: inf, kp: 0.0, max_velocity: inf, stiffness: 0.0, damping: 0.0 }
    }

    /// Every number of the motor with its name, in SI units.
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
    /// Returns true if the motor is a velocity constraint.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        matches!(self.mode, MotorMode::Velocity | MotorMode::Position)
    }

    /// Target velocity of a drive [rad/s] or [m/s] for a latched command, at coordinate `q` at the tick.
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
    pub(crate) fn torque(&self, q: R, v: R, command: R, steps: (R, R)) -> (R, R) {
        match self.mode {
            MotorMode::Torque => (command.clamp_abs(self.max_torque), R::zero()),
            MotorMode::Spring => {
                let wanted = self.stiffness * (command - (q + steps.1 * v)) - self.damping * v;
                let implicit = steps.0 * (self.damping + steps.1 * self.stiffness);
                // a saturated motor has a constant torque
                let within = wanted.abs().if_less(self.max_torque, implicit, R::zero());
                (wanted.clamp_abs(self.max_torque), within)
            }
            MotorMode::Free | MotorMode::Velocity | MotorMode::Position => (R::zero(), R::zero()),
        }
    }
}

//! Electric circuit of a direct-current motor: resistance, inductance and back-EMF behind a joint.
//!
//! L di/dt = V − R i − N k_e q̇ and τ = N k_t i on the joint. The command is the voltage V, limited to that of the
//! supply; the current i is a state of the model, or without inductance i = (V − N k_e q̇)/R: torque over speed is then
//! the straight line from the stall torque N k_t V/R to the no-load speed V/(N k_e).
//!
//! A linearly implicit step of length h takes the current and the speed at its end:
//! (L + h R) i⁺ = L i + h (V − N k_e q̇⁺). The torque N k_t i⁺ has the known part at q̇ and the term
//! h² N² k_t k_e/(L + h R) in the diagonal. At L = 0 both are those of the straight line.
//!
//! Energy: the source gives V i; ½ L i² is stored; N k_t i q̇ moves the joint; the rest, R i² where k_e = k_t, is heat.
//! Source: key `ogata2010` (armature-controlled motor).

use sincro_math::Real;

/// Winding of a direct-current motor with its gear, on one degree of freedom; attached to a joint by
/// `JointSpec::winding` beside a motor in mode `Voltage`.
///
/// ```
/// use sincro_actuation::Winding;
///
/// // 24 V across 2 Ω: 12 A at stall
/// let winding = Winding { max_voltage: 24.0, ..Winding::new(2.0, 0.05) };
/// assert_eq!(winding.current(0.0, 0.0, 24.0), 12.0);
/// // at V/k_e no current flows
/// assert_eq!(winding.current(0.0, 24.0 / 0.05, 30.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding<R> {
    /// Index of the motor whose command is the voltage; set when the model is built.
    pub motor: usize,
    /// Index of the degree of freedom, 0 to n_v − 1; set when the model is built.
    pub dof: usize,
    /// Index of the current in the states of elements; `None` without inductance. Set when the
    /// model is built.
    pub state: Option<usize>,
    /// Resistance R `[Ω]`, above 0.
    pub resistance: R,
    /// Inductance L `[H]`; 0: the current follows at once.
    pub inductance: R,
    /// Torque constant k_t of the motor `[N·m/A]`.
    pub torque_constant: R,
    /// Back-EMF constant k_e of the motor `[V·s/rad]`; in these units that of an ideal motor is its torque constant.
    pub back_emf_constant: R,
    /// Gear ratio N: turns of the motor over those of the joint, or angle over displacement `[rad/m]`.
    pub gear_ratio: R,
    /// Inertia J of the motor's rotor `[kg·m²]`; N² J is added to the armature of the joint.
    pub rotor_inertia: R,
    /// Voltage of the supply `[V]`: commands are limited to ± this; infinite for none.
    pub max_voltage: R,
}

impl Winding<f64> {
    /// Winding without inductance, gear and limit, with `resistance` `[Ω]` and `torque_constant` `[N·m/A]`, which is
    /// the back-EMF constant too.
    #[must_use]
    pub fn new(resistance: f64, torque_constant: f64) -> Self {
        Self {
            motor: 0,
            dof: 0,
            state: None,
            resistance,
            inductance: 0.0,
            torque_constant,
            back_emf_constant: torque_constant,
            gear_ratio: 1.0,
            rotor_inertia: 0.0,
            max_voltage: f64::INFINITY,
        }
    }

    /// Parameters with their field names and units, for checks.
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, f64); 7] {
        [
            ("resistance", self.resistance),
            ("inductance", self.inductance),
            ("torque_constant", self.torque_constant),
            ("back_emf_constant", self.back_emf_constant),
            ("gear_ratio", self.gear_ratio),
            ("rotor_inertia", self.rotor_inertia),
            ("max_voltage", self.max_voltage),
        ]
    }

    /// This winding for the motor of that index on a degree of freedom; its current, if it is a state, is entry `state`
    /// of the states of elements.
    pub fn mounted(self, motor: usize, dof: usize, state: usize) -> Self {
        Self { motor, dof, state: (self.inductance > 0.0).then_some(state), ..self }
    }
}

/// Power of a [`Winding`] `[W]`, from [`Winding::power`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindingPower<R> {
    /// Power of the source V i.
    pub electrical: R,
    /// Heat: of the source what is neither stored nor moves the joint.
    pub heat: R,
}

impl<R: Real> Winding<R> {
    /// Voltage `[V]` across the motor for a command `[V]`.
    #[inline(always)]
    pub fn voltage(&self, command: R) -> R {
        command.clamp_abs(self.max_voltage)
    }

    /// Back-EMF `[V]` at the rate `v` of the joint `[rad/s]` or `[m/s]`.
    #[inline(always)]
    pub fn back_emf(&self, v: R) -> R {
        self.gear_ratio * self.back_emf_constant * v
    }

    /// Torque of one ampere on the joint `[N·m/A]` or `[N/A]`.
    #[inline(always)]
    pub fn torque_per_ampere(&self) -> R {
        self.gear_ratio * self.torque_constant
    }

    /// Current `[A]`: its `state`, or without inductance what follows from the rate `v` of the joint and the command
    /// `[V]`.
    #[inline(always)]
    pub fn current(&self, state: R, v: R, command: R) -> R {
        self.current_after(state, v, command, R::zero())
    }

    /// State of this winding among the states of elements; 0 if it has none.
    #[inline(always)]
    pub fn state_in(&self, states: &[R]) -> R {
        self.state.map_or(R::zero(), |k| states[k])
    }

    /// Current at the end of a linearly implicit step of length `h` `[s]` (0: now) with the rate `v_end` there.
    #[inline(always)]
    pub fn current_after(&self, state: R, v_end: R, command: R, h: R) -> R {
        let drive = self.voltage(command) - self.back_emf(v_end);
        if self.state.is_none() {
            return drive / self.resistance;
        }
        (self.inductance * state + h * drive) / (self.inductance + h * self.resistance)
    }

    /// Torque on the joint for its rate `v` at the start, and the implicit diagonal, of a step of length `h` `[s]` (0:
    /// explicit).
    #[inline(always)]
    pub fn torque(&self, state: R, v: R, command: R, h: R) -> (R, R) {
        let tau = self.torque_per_ampere() * self.current_after(state, v, command, h);
        let damping = self.torque_per_ampere() * self.back_emf(h);
        let share =
            if self.state.is_none() { R::one() / self.resistance } else { h / (self.inductance + h * self.resistance) };
        (tau, damping * share)
    }

    /// Damping of the joint by the winding in short circuit at constant speed, N² k_t k_e/R `[N·m·s/rad]` or `[N·s/m]`.
    #[inline(always)]
    pub fn shorted_damping(&self) -> R {
        self.torque_per_ampere() * self.back_emf(R::one()) / self.resistance
    }

    /// Rate of the current `[A/s]` over a linearly implicit step of length `h` `[s]` (0: now) with the rate `v_end` at
    /// its end.
    #[inline(always)]
    pub fn current_rate(&self, state: R, v_end: R, command: R, h: R) -> R {
        let drive = self.voltage(command) - self.back_emf(v_end) - self.resistance * state;
        drive / (self.inductance + h * self.resistance)
    }

    /// Mean power over a step of length `h` `[s]` (0: now), with the rates of the joint at its end and in the mean.
    #[inline(always)]
    pub fn power(&self, state: R, (v_end, v_mean): (R, R), command: R, h: R) -> WindingPower<R> {
        let end = self.current_after(state, v_end, command, h);
        let (mean, stored) = if self.state.is_none() {
            (end, R::zero())
        } else {
            let mean = R::splat(0.5) * (state + end);
            (mean, (self.voltage(command) - self.resistance * end - self.back_emf(v_end)) * mean)
        };
        let electrical = self.voltage(command) * mean;
        WindingPower { electrical, heat: electrical - stored - self.torque_per_ampere() * end * v_mean }
    }

    /// Energy of the magnetic field ½ L i² `[J]`.
    #[inline(always)]
    pub fn energy(&self, state: R) -> R {
        R::splat(0.5) * self.inductance * state * state
    }
}

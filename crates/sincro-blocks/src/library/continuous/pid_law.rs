//! Control law shared by the continuous and the discrete PID controller: parameters, ports, and the sum of the three
//! terms.
//!
//! ```text
//! v = kp·(b·r − m) + I + D + feedforward,   output = lower ≤ v ≤ upper
//! ```
//!
//! with the setpoint r, the measurement m, the integral term I of ki·(r − m) and the filtered derivative D of kd·(c·r −
//! m). With one input, the error e = r − m stands for all three brackets. Source of the form with setpoint weights and
//! back-calculation: K. J. Åström, T. Hägglund, *Advanced PID Control*, ISA 2006, chapter 3.

use crate::library::prelude::*;

declare_parameters! {
    /// Parameters of a PID controller: each one number for all components, or one for each.
    pub struct PidLaw {
        /// Proportional gain.
        pub kp: Vec<f64> as PerComponent = "0",
        /// Integral gain `[unit of kp / s]`.
        pub ki: Vec<f64> as PerComponent = "0",
        /// Derivative gain `[unit of kp · s]`.
        pub kd: Vec<f64> as PerComponent = "0",
        /// Time constant of the lag in the derivative term `[s]`, 1/N.
        pub filter_time_constant: Vec<f64> as PerComponent = "0.01",
        /// Least output.
        pub lower: Vec<f64> as Limits = "-inf",
        /// Greatest output.
        pub upper: Vec<f64> as Limits = "inf",
        /// Protection against windup of the integral term at a limit.
        pub anti_windup: AntiWindup as Choice = "back-calculation",
        /// Time constant of back-calculation `[s]`; 0 for kp/ki.
        pub tracking_time_constant: Vec<f64> as PerComponent = "0",
        /// Time constant of a first-order lag on the output `[s]`; 0 for none.
        pub output_time_constant: f64 as Number = "0",
        /// Replaces the error `u` by the inputs `setpoint` and `measurement`.
        pub separate: bool as Flag = "false",
        /// Weight b of the setpoint in the proportional term, with separate inputs.
        pub setpoint_weight: Vec<f64> as PerComponent = "1",
        /// Weight c of the setpoint in the derivative term, with separate inputs.
        pub derivative_setpoint_weight: Vec<f64> as PerComponent = "0",
        /// Adds an input `feedforward`, which is added to the output.
        pub feedforward: bool as Flag = "false",
        /// Integral term at the start.
        pub initial: Vec<f64> as PerComponent = "0",
        /// Value that the derivative's filter has settled on before the start.
        pub initial_input: Vec<f64> as PerComponent = "0",
    }
}

choice! {
    /// Protection of the integral term against windup while the output is limited.
    pub enum AntiWindup {
        /// The part that the limit cuts off is fed back into the integral term.
        BackCalculation = "back-calculation",
        /// The integral term does not go on in the direction in which the output is limited.
        Clamping = "clamping",
        /// No protection.
        None = "none",
    }
}

/// Errors that the three terms are made from, for one component.
pub(in crate::library) struct Errors<R> {
    /// Proportional term: b·r − m.
    pub weighted: R,
    /// Integral term: r − m.
    pub plain: R,
    /// Derivative term: c·r − m.
    pub differentiated: R,
}

impl PidLaw {
    /// Gains alone: no limits, the error as its only input.
    #[must_use]
    pub fn new(kp: f64, ki: f64, kd: f64) -> Self {
        Self { kp: vec![kp], ki: vec![ki], kd: vec![kd], ..super::Pid::with_defaults().law }
    }

    /// Checks the parameters against each other. `needs_filter`: the derivative cannot do without a lag.
    pub(in crate::library) fn validate(&self, p: &mut Reader<'_>, needs_filter: bool) {
        let times = [
            ("filter_time_constant", &self.filter_time_constant[..]),
            ("tracking_time_constant", &self.tracking_time_constant[..]),
            ("output_time_constant", core::slice::from_ref(&self.output_time_constant)),
        ];
        for (key, times) in times {
            if let Some(bad) = times.iter().find(|t| **t < 0.0) {
                p.fault(key, format!("`{key}` is {bad}"), "a time cannot be less than 0");
            }
        }
        if needs_filter && self.has_derivative() && self.filter_time_constant.contains(&0.0) {
            let help = "a derivative needs a lag: give a tenth of the shortest time that matters, or less";
            p.fault("filter_time_constant", "`filter_time_constant` is 0", help);
        }
        crate::library::nonlinear::check_limits(p, &self.lower, &self.upper);
        let is_limited = self.lower.iter().chain(&self.upper).any(|x| x.is_finite());
        let tracks = is_limited && self.anti_windup == AntiWindup::BackCalculation;
        let lists = [&self.kp, &self.ki, &self.tracking_time_constant];
        let n = lists.iter().map(|list| list.len()).max().unwrap_or(1);
        let fits = lists.iter().all(|list| list.len() == 1 || list.len() == n);
        if tracks && fits && (0..n).any(|i| of(&self.ki, i) != 0.0 && self.tracking(i) == 0.0) {
            let message = "back-calculation needs `tracking_time_constant`: it is kp/ki by default, and kp is 0";
            p.fault("tracking_time_constant", message, "give it [s], or set anti_windup = \"clamping\"");
        }
    }

    /// Time constant of back-calculation for component `i` `[s]`.
    pub(in crate::library) fn tracking(&self, i: usize) -> f64 {
        let given = of(&self.tracking_time_constant, i);
        if given > 0.0 { given } else { (of(&self.kp, i) / of(&self.ki, i)).abs() }
    }

    pub(in crate::library) fn has_derivative(&self) -> bool {
        self.kd.iter().any(|k| *k != 0.0)
    }

    pub(in crate::library) fn has_lag(&self) -> bool {
        self.output_time_constant > 0.0
    }

    pub(in crate::library) fn ports(&self) -> Ports {
        let mut ports = Ports::new(if self.separate { &["setpoint", "measurement"] } else { &["u"] }, &["y"]);
        if self.feedforward {
            ports.inputs.push("feedforward".into());
        }
        ports
    }

    /// Component `i` of the errors.
    #[inline(always)]
    pub(in crate::library) fn errors<R: Real>(&self, at: &At<'_, R>, i: usize) -> Errors<R> {
        let r = at.component(0, i);
        if !self.separate {
            return Errors { weighted: r, plain: r, differentiated: r };
        }
        let m = at.component(1, i);
        Errors {
            weighted: R::splat(of(&self.setpoint_weight, i)) * r - m,
            plain: r - m,
            differentiated: R::splat(of(&self.derivative_setpoint_weight, i)) * r - m,
        }
    }

    /// Component `i` of the feedforward.
    #[inline(always)]
    pub(in crate::library) fn added<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        if self.feedforward { at.component(1 + usize::from(self.separate), i) } else { R::zero() }
    }

    /// Between the limits.
    #[inline(always)]
    pub(in crate::library) fn limited<R: Real>(&self, v: R, i: usize) -> R {
        v.max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)))
    }

    /// Rate of the integral term: `ki·e`, but for what `anti_windup` takes away where `v` is beyond a limit.
    /// `tracking`: time constant of back-calculation `[s]`.
    #[inline(always)]
    pub(in crate::library) fn integral_rate<R: Real>(&self, error: R, v: R, tracking: f64, i: usize) -> R {
        let ki = of(&self.ki, i);
        if ki == 0.0 {
            return R::zero();
        }
        let rate = R::splat(ki) * error;
        match self.anti_windup {
            AntiWindup::None => rate,
            AntiWindup::BackCalculation if tracking > 0.0 => rate + (self.limited(v, i) - v) / R::splat(tracking),
            AntiWindup::BackCalculation => rate,
            AntiWindup::Clamping => {
                let zero = R::zero();
                let below = R::splat(of(&self.upper, i)).if_less(v, rate.min(zero), rate);
                v.if_less(R::splat(of(&self.lower, i)), below.max(zero), below)
            }
        }
    }

    /// Terms in use, such as `PI` or `PID`.
    pub(in crate::library) fn label(&self) -> String {
        let has = |gain: &[f64]| gain.iter().any(|k| *k != 0.0);
        let terms = [('P', &self.kp), ('I', &self.ki), ('D', &self.kd)];
        terms.into_iter().filter(|(_, gain)| has(gain)).map(|(letter, _)| letter).collect()
    }
}

//! `y = kp·e + ki·∫e + kd·e'`, filtered, limited, without windup.
//!
//! ```text
//! v  = kp·(b·r − m) + I + D + feedforward
//! D  = kd·(w − f)/Tf,   f' = (w − f)/Tf,   w = c·r − m
//! I' = ki·(r − m) + (limited(v) − v)/Tt                       back-calculation
//! y  = limited(v),   or   y' = (limited(v) − y)/output_time_constant
//! ```
//!
//! States, each for all components: I, then f (if there is a derivative term), then y (if there is an output lag).

use super::PidLaw;
use super::pid_law::AntiWindup;
use crate::library::prelude::*;

/// Block `pid`: continuous PID controller; it has no direct feedthrough if its output has a lag.
#[derive(Clone, Debug, PartialEq)]
pub struct Pid {
    /// Gains, limits and options.
    pub law: PidLaw,
}

impl Pid {
    /// Creates a controller with the gains `kp` `[output/error]`, `ki` `[output/(error·s)]` and `kd`
    /// `[output·s/error]`: no limits, the error as its only input, a derivative filter of 0.01 s.
    #[must_use]
    pub fn new(kp: f64, ki: f64, kd: f64) -> Self {
        Self { law: PidLaw::new(kp, ki, kd) }
    }

    /// Indices at which the filter's states begin, the lag's begin, and all end, for outputs of a width.
    fn layout(&self, width: usize) -> (usize, usize, usize) {
        let lag = if self.law.has_derivative() { 2 * width } else { width };
        (width, lag, if self.law.has_lag() { lag + width } else { lag })
    }

    /// Component `i` before the limits.
    #[inline(always)]
    fn unlimited<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        let law = &self.law;
        let errors = law.errors(at, i);
        let mut v = R::splat(of(&law.kp, i)) * errors.weighted + at.states[i] + law.added(at, i);
        if law.has_derivative() {
            let rate = self.filter_rate(errors.differentiated, at.states[at.node.n_out() + i], i);
            v += R::splat(of(&law.kd, i)) * rate;
        }
        v
    }

    #[inline(always)]
    fn filter_rate<R: Real>(&self, w: R, f: R, i: usize) -> R {
        (w - f) / R::splat(of(&self.law.filter_time_constant, i))
    }
}

impl Described for Pid {
    const KIND: &'static Kind = &Kind {
        name: "pid",
        category: Category::Continuous,
        summary: "A PID controller with filtered derivative, output limits and anti-windup.",
        equation: "y = kp·u + ki·∫u dt + kd·s/(filter_time_constant·s + 1)·u, lower ≤ y ≤ upper",
        parameters: PidLaw::PARAMETERS,
    };

    fn parameter_widths(&self) -> Vec<(&'static str, usize)> {
        self.law.widths()
    }

    fn read(p: &mut Reader<'_>) -> Self {
        let law = PidLaw::read(p);
        law.validate(p, true);
        Self { law }
    }
}

impl Block for Pid {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;

    fn ports(&self) -> Ports {
        self.law.ports()
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        !self.law.has_lag()
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: self.layout(node.n_out()).2, discrete: 0 }
    }

    fn start<R: Real>(&self, node: &Node, states: &mut [R], _: &mut [R]) {
        let (filter, lag, end) = self.layout(node.n_out());
        for i in 0..node.n_out() {
            states[i] = R::splat(of(&self.law.initial, i));
            if lag > filter {
                states[filter + i] = R::splat(of(&self.law.initial_input, i));
            }
            if end > lag {
                states[lag + i] = self.law.limited(states[i], i);
            }
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (_, lag, end) = self.layout(y.len());
        if end > lag {
            y.copy_from_slice(&at.states[lag..end]);
            return;
        }
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.law.limited(self.unlimited(at, i), i);
        }
    }

    fn derivatives<R: Real>(&self, at: &At<'_, R>, (): &mut (), derivatives: &mut [R]) {
        let (filter, lag, end) = self.layout(at.node.n_out());
        for i in 0..at.node.n_out() {
            let (errors, v) = (self.law.errors(at, i), self.unlimited(at, i));
            derivatives[i] = self.law.integral_rate(errors.plain, v, self.law.tracking(i), i);
            if lag > filter {
                derivatives[filter + i] = self.filter_rate(errors.differentiated, at.states[filter + i], i);
            }
            if end > lag {
                let behind = self.law.limited(v, i) - at.states[lag + i];
                derivatives[lag + i] = behind / R::splat(self.law.output_time_constant);
            }
        }
    }

    fn neg_jacobian_diagonal<R: Real>(&self, at: &At<'_, R>, diagonal: &mut [R]) {
        let (filter, lag, end) = self.layout(at.node.n_out());
        for i in 0..at.node.n_out() {
            let tracking = self.law.tracking(i);
            if self.law.anti_windup == AntiWindup::BackCalculation && of(&self.law.ki, i) != 0.0 && tracking > 0.0 {
                // only beyond a limit
                let v = self.unlimited(at, i).lane(0);
                let is_limited = v < of(&self.law.lower, i) || v > of(&self.law.upper, i);
                diagonal[i] = R::splat(if is_limited { 1.0 / tracking } else { 0.0 });
            }
            if lag > filter {
                diagonal[filter + i] = R::splat(1.0 / of(&self.law.filter_time_constant, i));
            }
            if end > lag {
                diagonal[lag + i] = R::splat(1.0 / self.law.output_time_constant);
            }
        }
    }

    fn label(&self) -> String {
        self.law.label()
    }
}

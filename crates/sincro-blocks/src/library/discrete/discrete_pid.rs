//! `y[k] = kp·e[k] + ki·Σ e·Ts + kd·Δe/Ts`, filtered, limited, without windup.
//!
//! With the sample time Ts, the setpoint r, the measurement m (or the error e = r − m for all three brackets):
//!
//! ```text
//! v[k] = kp·(b·r − m) + I[k] + D[k] + feedforward,   y[k] = limited(v[k])
//! D[k] = kd·(w[k] − f[k−1])/(Tf + Ts),   f[k] = (Tf·f[k−1] + Ts·w[k])/(Tf + Ts),   w = c·r − m        backward Euler
//! I[k] = s[k] + α·Ts·ki·e[k],   s[k+1] = s[k] + Ts·ki·e[k],   s[0] = initial
//!        α = 0 forward Euler, 1 backward Euler, ½ trapezoidal
//! ```
//!
//! Back-calculation adds `min(Ts/Tt, 1)·(limited(v) − v)` to s; clamping leaves s as it is while the limit is pushed
//! against. An output lag T is `y[k] = (T·y[k−1] + Ts·limited(v[k]))/(T + Ts)`. Memory, each for all components: s, f,
//! y.

use super::Method;
use crate::library::continuous::PidLaw;
use crate::library::prelude::*;

/// Block `discrete-pid`: PID controller that is evaluated at its sample time.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscretePid {
    /// Gains, limits and options, those of the continuous `pid`.
    pub law: PidLaw,
    /// Integration rule of the integral term.
    pub method: Method,
}

/// One component at a sample.
struct Terms<R> {
    /// Error of the integral term.
    error: R,
    /// Before the limits.
    v: R,
    /// The filter's new state.
    filtered: R,
}

impl DiscretePid {
    /// Creates a controller with the gains `kp` `[output/error]`, `ki` `[output/(error·s)]` and `kd`
    /// `[output·s/error]`: no limits, the error as its only input, forward Euler, a derivative filter of 0.01 s.
    #[must_use]
    pub fn new(kp: f64, ki: f64, kd: f64) -> Self {
        Self { law: PidLaw::new(kp, ki, kd), method: Method::ForwardEuler }
    }

    #[inline(always)]
    fn terms<R: Real>(&self, at: &At<'_, R>, i: usize) -> Terms<R> {
        let (law, n, ts) = (&self.law, at.node.n_out(), at.node.period());
        let errors = law.errors(at, i);
        let advance = R::splat(self.method.weight() * ts * of(&law.ki, i));
        let integral = at.memory[i] + advance * errors.plain;
        let (tf, f) = (of(&law.filter_time_constant, i), at.memory[n + i]);
        let change = (errors.differentiated - f) / R::splat(tf + ts);
        let mut v = R::splat(of(&law.kp, i)) * errors.weighted + integral + law.added(at, i);
        if law.has_derivative() {
            v += R::splat(of(&law.kd, i)) * change;
        }
        Terms { error: errors.plain, v, filtered: f + R::splat(ts) * change }
    }

    #[inline(always)]
    fn result<R: Real>(&self, at: &At<'_, R>, v: R, i: usize) -> R {
        let (limited, lag, ts) = (self.law.limited(v, i), self.law.output_time_constant, at.node.period());
        if !self.law.has_lag() {
            return limited;
        }
        let before = at.memory[2 * at.node.n_out() + i];
        before + R::splat(ts / (lag + ts)) * (limited - before)
    }
}

/// Parameters of the continuous controller, and the method.
const PARAMETERS: [Parameter; PidLaw::PARAMETERS.len() + 1] = {
    let doc = "rule of the integral";
    let mut all = [Parameter::optional("method", ValueKind::Choice(Method::WORDS), doc, "forward-euler"); _];
    let mut k = 0;
    while k < PidLaw::PARAMETERS.len() {
        all[k] = PidLaw::PARAMETERS[k];
        k += 1;
    }
    all
};

impl Described for DiscretePid {
    const KIND: &'static Kind = &Kind {
        name: "discrete-pid",
        category: Category::Discrete,
        summary: "A PID controller at its sample time, with filtered derivative, output limits and anti-windup.",
        equation: "y[k] = kp·u[k] + ki·Σ u·Ts + kd·(u[k] − f[k−1])/(filter_time_constant + Ts), lower ≤ y ≤ upper",
        parameters: &PARAMETERS,
    };

    fn parameter_widths(&self) -> Vec<(&'static str, usize)> {
        self.law.widths()
    }

    fn read(p: &mut Reader<'_>) -> Self {
        let law = PidLaw::read(p);
        law.validate(p, false);
        Self { law, method: <Choice as ParameterType<Method>>::read(p, "method") }
    }
}

impl Block for DiscretePid {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn ports(&self) -> Ports {
        self.law.ports()
    }

    fn memory(&self, node: &Node) -> Memory {
        let parts = if self.law.has_lag() { 3 } else { 2 };
        Memory { continuous: 0, discrete: parts * node.n_out() }
    }

    fn start<R: Real>(&self, node: &Node, _: &mut [R], memory: &mut [R]) {
        let n = node.n_out();
        for i in 0..n {
            memory[i] = R::splat(of(&self.law.initial, i));
            memory[n + i] = R::splat(of(&self.law.initial_input, i));
            if self.law.has_lag() {
                memory[2 * n + i] = self.law.limited(memory[i], i);
            }
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.result(at, self.terms(at, i).v, i);
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        let (n, ts) = (at.node.n_out(), at.node.period());
        for i in 0..n {
            let terms = self.terms(at, i);
            // faster than a sample it would overshoot
            let tracking = self.law.tracking(i).max(ts);
            memory[i] = at.memory[i] + R::splat(ts) * self.law.integral_rate(terms.error, terms.v, tracking, i);
            memory[n + i] = terms.filtered;
            if self.law.has_lag() {
                memory[2 * n + i] = self.result(at, terms.v, i);
            }
        }
    }

    fn label(&self) -> String {
        self.law.label()
    }
}

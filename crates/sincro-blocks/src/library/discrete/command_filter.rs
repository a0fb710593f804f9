//! A smooth reference with its first two derivatives: a second-order filter, exact for an input that is held.
//!
//! With e = y − u, ω = natural_frequency, ζ = damping_ratio and the input u held over a sample of length T:
//!
//! ```text
//! y'' = −ω²·(y − u) − 2ζω·y'
//! y[k+1]  = u + x·( c·e + s·(y' + ζω·e) ),   x = e^(−ζωT)
//! y'[k+1] =     x·( c·y' − s·(ω²·e + ζω·y') )
//! ζ < 1: c = cos(ω_d·T),  s = sin(ω_d·T)/ω_d,    ω_d = ω·√(1 − ζ²)
//! ζ = 1: c = 1,           s = T
//! ζ > 1: c = cosh(ω_d·T), s = sinh(ω_d·T)/ω_d,   ω_d = ω·√(ζ² − 1)
//! ```
//!
//! Such filters stand before backstepping and inversion controllers, which need derivatives of the reference
//! (`farrell2009`).

use crate::library::prelude::*;

declare_block! {
    /// Makes a reference smooth and gives its first two derivatives; discretised exactly.
    pub struct CommandFilter("command-filter", Discrete):
        "y'' = −ω²·(y − u) − 2ζω·y', u held over a sample; outputs y, rate = y', acceleration = y''" {
        /// ω `[rad/s]`.
        pub natural_frequency: Vec<f64> as PerComponent,
        /// ζ; at 1 or more nothing overshoots.
        pub damping_ratio: Vec<f64> as PerComponent = "1",
        /// y at the start, at rest.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl CommandFilter {
    /// Critically damped, from zero.
    #[must_use]
    pub fn new(natural_frequency: f64) -> Self {
        Self { natural_frequency: vec![natural_frequency], damping_ratio: vec![1.0], initial: vec![0.0] }
    }

    /// `(x, c, s)` of the head of this file for component `i`.
    fn transition(&self, i: usize, t: f64) -> (f64, f64, f64) {
        let (w, z) = (of(&self.natural_frequency, i), of(&self.damping_ratio, i));
        let x = elementary::exp(-z * w * t).0;
        let wd = w * (1.0 - z * z).abs().sqrt();
        let a = wd * t;
        if a == 0.0 {
            (x, 1.0, t)
        } else if z < 1.0 {
            let (sin, cos) = elementary::sin_cos(a);
            (x, cos, sin / wd)
        } else {
            // together with x, so that neither overflows
            let (slow, fast) = (elementary::exp(a - z * w * t).0, elementary::exp(-a - z * w * t).0);
            (1.0, 0.5 * (slow + fast), 0.5 * (slow - fast) / wd)
        }
    }
}

impl Block for CommandFilter {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.natural_frequency.iter().any(|w| *w <= 0.0) {
            p.fault("natural_frequency", "a natural frequency is not positive", "it must be greater than 0");
        }
        if self.damping_ratio.iter().any(|z| *z < 0.0) {
            p.fault("damping_ratio", "a damping ratio is negative", "it must be 0 or more; 1 is critically damped");
        }
    }

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y", "rate", "acceleration"])
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: 2 * node.outputs[0] }
    }

    fn start<R: Real>(&self, node: &Node, _: &mut [R], memory: &mut [R]) {
        for i in 0..node.outputs[0] {
            memory[i] = R::splat(of(&self.initial, i));
        }
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::TimesSeconds(vec![0, -1, -2])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let n = at.node.outputs[0];
        for i in 0..n {
            let (w, z) = (of(&self.natural_frequency, i), of(&self.damping_ratio, i));
            let (position, rate) = (at.memory[i], at.memory[n + i]);
            y[i] = position;
            y[n + i] = rate;
            y[2 * n + i] = R::splat(-w * w) * (position - at.component(0, i)) - R::splat(2.0 * z * w) * rate;
        }
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        let n = at.node.outputs[0];
        for i in 0..n {
            let (w, z) = (of(&self.natural_frequency, i), of(&self.damping_ratio, i));
            let (x, c, s) = self.transition(i, at.node.period());
            let (x, c, s) = (R::splat(x), R::splat(c), R::splat(s));
            let (u, rate) = (at.component(0, i), at.memory[n + i]);
            let e = at.memory[i] - u;
            memory[i] = u + x * (c * e + s * (rate + R::splat(z * w) * e));
            memory[n + i] = x * (c * rate - s * (R::splat(w * w) * e + R::splat(z * w) * rate));
        }
    }

    fn label(&self) -> String {
        "y, y', y''".into()
    }
}

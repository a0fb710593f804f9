//! Block `derivative`.

use crate::library::prelude::*;

declare_block! {
    /// The rate of change of a signal, smoothed by a first-order lag.
    ///
    /// A derivative without a lag would need the future. The shorter the time constant, the truer and the noisier it
    /// is.
    pub struct Derivative("derivative", Continuous): "y = (u − x)/time_constant, x' = y, x(0) = initial_input" {
        /// Time constant of the lag `[s]`: shorter is truer and noisier.
        pub time_constant: Vec<f64> as Positives,
        /// Value that u had before the start.
        pub initial_input: Vec<f64> as PerComponent = "0",
    }
}

impl Derivative {
    /// For an input that was zero before the start; `time_constant` in `[s]`.
    #[must_use]
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant: vec![time_constant], initial_input: vec![0.0] }
    }
}

impl Block for Derivative {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;
    const STATE: Memory = Memory::CONTINUOUS;

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        fill(states, &self.initial_input);
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::TimesSeconds(vec![-1])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = (at.component(0, i) - at.states[i]) / R::splat(of(&self.time_constant, i));
        }
    }

    fn derivatives<R: Real>(&self, at: &At<'_, R>, (): &mut (), derivatives: &mut [R]) {
        self.output(at, &mut (), derivatives);
    }

    fn neg_jacobian_diagonal<R: Real>(&self, _: &At<'_, R>, diagonal: &mut [R]) {
        for (i, entry) in diagonal.iter_mut().enumerate() {
            *entry = R::splat(1.0 / of(&self.time_constant, i));
        }
    }

    fn label(&self) -> String {
        match &self.time_constant[..] {
            [tau] => super::Rational::new(&[1.0, 0.0], &[*tau, 1.0]).map_or("d/dt".into(), |g| g.text('s')),
            _ => "s/(τs + 1)".into(),
        }
    }
}

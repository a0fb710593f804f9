//! Block `discrete-derivative`.

use crate::library::prelude::*;

declare_block! {
    /// The change since the sample before, over the sample time.
    pub struct DiscreteDerivative("discrete-derivative", Discrete):
        "y[k] = gain·(u[k] − u[k−1])/Ts, u[−1] = initial_input" {
        /// Factor.
        pub gain: Vec<f64> as PerComponent = "1",
        /// Value that u had before the start.
        pub initial_input: Vec<f64> as PerComponent = "0",
    }
}

impl DiscreteDerivative {
    /// For an input that was zero before the start.
    #[must_use]
    pub fn new(gain: f64) -> Self {
        Self { gain: vec![gain], initial_input: vec![0.0] }
    }
}

impl Block for DiscreteDerivative {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        fill(memory, &self.initial_input);
    }

    fn unit_rule(&self) -> UnitRule {
        // any other gain may have a unit
        let is_plain = self.gain.iter().all(|g| *g == 1.0);
        if is_plain { UnitRule::TimesSeconds(vec![-1]) } else { UnitRule::Unknown }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let change = at.component(0, i) - at.memory[i];
            *y = R::splat(of(&self.gain, i)) * change / R::splat(at.node.period());
        }
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        at.copy_input(0, memory);
    }

    fn label(&self) -> String {
        "(z − 1)/(Ts·z)".into()
    }
}

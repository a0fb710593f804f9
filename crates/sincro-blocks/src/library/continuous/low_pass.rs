//! Block `low-pass`.

use crate::library::prelude::*;

declare_block! {
    /// A first-order lag, without direct feedthrough.
    ///
    /// It breaks algebraic loops.
    pub struct LowPass("low-pass", Continuous): "y' = (dc_gain·u − y)/time_constant, y(0) = initial" {
        /// Time after which a step is answered to 63 % `[s]`.
        pub time_constant: Vec<f64> as Positives,
        /// Gain for a constant input.
        pub dc_gain: Vec<f64> as PerComponent = "1",
        /// y at the start.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl LowPass {
    /// Creates the block with gain 1, from zero; `time_constant` in `[s]`.
    #[must_use]
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant: vec![time_constant], dc_gain: vec![1.0], initial: vec![0.0] }
    }
}

impl Block for LowPass {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;
    const STATE: Memory = Memory::CONTINUOUS;

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        // any other gain may have a unit
        Ok(vec![inputs[0].clone().filter(|_| self.dc_gain.iter().all(|g| *g == 1.0))])
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        false
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        fill(states, &self.initial);
    }

    fn unit_rule(&self) -> UnitRule {
        if self.dc_gain.iter().all(|g| *g == 1.0) { UnitRule::Same(vec![0]) } else { UnitRule::Unknown }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.states);
    }

    #[inline(always)]
    fn derivatives<R: Real>(&self, at: &At<'_, R>, (): &mut (), derivatives: &mut [R]) {
        for (i, rate) in derivatives.iter_mut().enumerate() {
            let target = R::splat(of(&self.dc_gain, i)) * at.component(0, i);
            *rate = (target - at.states[i]) / R::splat(of(&self.time_constant, i));
        }
    }

    #[inline(always)]
    fn neg_jacobian_diagonal<R: Real>(&self, _: &At<'_, R>, diagonal: &mut [R]) {
        for (i, entry) in diagonal.iter_mut().enumerate() {
            *entry = R::splat(1.0 / of(&self.time_constant, i));
        }
    }

    fn label(&self) -> String {
        match (&self.dc_gain[..], &self.time_constant[..]) {
            ([gain], [tau]) => super::Rational::new(&[*gain], &[*tau, 1.0]).map_or("lag".into(), |g| g.text('s')),
            _ => "1/(τs + 1)".into(),
        }
    }
}

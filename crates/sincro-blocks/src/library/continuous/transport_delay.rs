//! `y(t) = u(t − delay)`.
//!
//! The input is remembered at every tick, in a ring: tick k stands in slot k mod n. In between it is interpolated
//! linearly. With D steps of delay the output needs the ticks from ⌊k − D⌋ on, k being the last one: n = ⌈D⌉ + 1.

use crate::library::prelude::*;

declare_block! {
    /// The input of some time ago, interpolated between ticks.
    ///
    /// For a belt, a pipe or a network. The delay is at least one base step.
    pub struct TransportDelay("transport-delay", Continuous): "y(t) = u(t − delay), y = initial for t < delay" {
        /// Delay `[s]`, at least one base step.
        pub delay: f64 as Positive,
        /// y before the first input has arrived.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl TransportDelay {
    /// Creates the block with zero before the first input; `delay` in `[s]`.
    #[must_use]
    pub fn new(delay: f64) -> Self {
        Self { delay, initial: vec![0.0] }
    }

    /// Delay in base steps; what is but rounding away from a whole number is whole.
    fn steps(&self, node: &Node) -> f64 {
        let steps = self.delay / node.step;
        if (steps - steps.round()).abs() <= SAME_TICK * steps.max(1.0) { steps.round() } else { steps }
    }
}

/// Parts of a step that are taken for rounding.
const SAME_TICK: f64 = 1e-9;

impl Block for TransportDelay {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        false
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() * (self.steps(node).ceil() as usize + 1) }
    }

    fn check(&self, node: &Node) -> Result<(), (String, String)> {
        let steps = self.steps(node);
        if steps < 1.0 {
            let message = format!("a delay of {} s is shorter than the base step of {} s", self.delay, node.step);
            return Err((message, format!("delay by {} s or more, or take a smaller `step`", node.step)));
        }
        if steps > MAX_STEPS {
            let (delay, steps) = (short(self.delay), short(steps.ceil()));
            let message = format!("a delay of {delay} s is {steps} base steps of {} s", node.step);
            return Err((message, format!("at most {MAX_STEPS} steps are remembered: take a larger `step`")));
        }
        Ok(())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (width, step) = (y.len(), at.node.step);
        let n = at.memory.len() / width;
        // ticks since the start of what arrives now, from the last tick on: no digits are lost late in a run
        let after = (at.t - at.tick as f64 * step) / step - self.steps(at.node);
        let back = (-after).ceil();
        let (back, part) = if (-after - (back - 1.0)) <= SAME_TICK { (back - 1.0, 0.0) } else { (back, after + back) };
        let part = if part <= SAME_TICK { 0.0 } else { part };
        let Some(tick) = at.tick.checked_sub(back as u64) else {
            for (i, y) in y.iter_mut().enumerate() {
                *y = R::splat(of(&self.initial, i));
            }
            return;
        };
        let slot = |tick: u64| (tick % n as u64) as usize * width;
        let (this, next) = (slot(tick), slot(tick + 1));
        for (i, y) in y.iter_mut().enumerate() {
            let u = at.memory[this + i];
            // on a tick the next one may not be known yet
            *y = if part == 0.0 { u } else { u + R::splat(part) * (at.memory[next + i] - u) };
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        let width = at.node.n_out();
        let slot = (at.tick % (memory.len() / width) as u64) as usize * width;
        for i in 0..width {
            memory[slot + i] = at.component(0, i);
        }
    }

    fn label(&self) -> String {
        format!("{} s", short(self.delay))
    }
}

/// Samples of one delay: a hundred seconds at ten microseconds.
const MAX_STEPS: f64 = 1e7;

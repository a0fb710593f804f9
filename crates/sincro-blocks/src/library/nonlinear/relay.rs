//! Block `relay`.

use crate::library::prelude::*;

declare_block! {
    /// A switch with hysteresis.
    ///
    /// It works at samples, or at every tick if it has no sample time.
    pub struct Relay("relay", Nonlinear): "y = on from u > on_above until u < off_below, else off" {
        /// Above this it switches on.
        pub on_above: f64 as Number,
        /// Below this it switches off, at most `on_above`.
        pub off_below: f64 as Number,
        /// y while on.
        pub on: f64 as Number = "1",
        /// y while off.
        pub off: f64 as Number = "0",
        /// State before the start: on or off.
        pub initially_on: bool as Flag = "false",
    }
}

impl Relay {
    /// Creates the block: from off, with the outputs 1 and 0.
    #[must_use]
    pub fn new(on_above: f64, off_below: f64) -> Self {
        Self { on_above, off_below, on: 1.0, off: 0.0, initially_on: false }
    }

    /// Returns true if component `i` is now on; its memory is 1 while on.
    #[inline(always)]
    fn is_on<R: Real>(&self, at: &At<'_, R>, i: usize) -> bool {
        let u = at.component(0, i).lane(0);
        u > self.on_above || (at.memory[i].lane(0) > 0.5 && u >= self.off_below)
    }
}

impl Block for Relay {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.off_below > self.on_above {
            let message = format!("`off_below` {} is above `on_above` {}", self.off_below, self.on_above);
            p.fault("off_below", message, "exchange them");
        }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory.fill(R::splat(f64::from(u8::from(self.initially_on))));
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let u = at.component(0, i);
            // what is not a number is neither on nor off
            let is_unknown = u.lane(0).is_nan();
            *y = if is_unknown { u } else { R::splat(if self.is_on(at, i) { self.on } else { self.off }) };
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(f64::from(u8::from(self.is_on(at, i))));
        }
    }
}

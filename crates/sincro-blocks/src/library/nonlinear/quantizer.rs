//! Block `quantizer`.

use crate::library::prelude::*;

declare_block! {
    /// Rounds to whole multiples of an interval, as an encoder or a converter does.
    ///
    /// A zero is never negative. The derivative is zero.
    pub struct Quantizer("quantizer", Nonlinear): "y = interval·round(u/interval), halves away from zero" {
        /// Distance of two values of y.
        pub interval: Vec<f64> as Positives,
    }
}

impl Quantizer {
    /// Creates the block with one interval for all components.
    #[must_use]
    pub fn new(interval: f64) -> Self {
        Self { interval: vec![interval] }
    }
}

impl Block for Quantizer {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let interval = of(&self.interval, i);
            // a zero is a positive one: wires that carry whole numbers know no other
            *y = at.component(0, i).map(|u| (interval * (u / interval).round() + 0.0, 0.0));
        }
    }

    fn label(&self) -> String {
        short_list(&self.interval)
    }
}

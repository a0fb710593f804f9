//! Block `gain`.

use crate::library::prelude::*;

declare_block! {
    /// Multiplies by a constant.
    pub struct Gain("gain", Maths): "y = gain·u" {
        /// Factor, one for all components or one for each.
        pub gain: Vec<f64> as PerComponent,
    }
}

impl Gain {
    /// One factor for all components.
    #[must_use]
    pub fn new(gain: f64) -> Self {
        Self { gain: vec![gain] }
    }
}

impl Block for Gain {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(&self.gain, i)) * at.component(0, i);
        }
    }

    fn label(&self) -> String {
        short_list(&self.gain)
    }
}

//! Block `zero-order-hold`.

use crate::library::prelude::*;

declare_block! {
    /// The input at the last sample, held until the next one.
    pub struct ZeroOrderHold("zero-order-hold", Discrete): "y(t) = u(t_k), t_k ≤ t < t_{k+1}";
}

impl Block for ZeroOrderHold {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.input(0));
    }

    fn label(&self) -> String {
        "ZOH".into()
    }
}

//! Takes a signal that nobody needs.

use crate::library::prelude::*;

declare_block! {
    /// Takes a signal that nobody needs.
    pub struct Terminator("terminator", Sinks): "u goes nowhere";
}

impl Block for Terminator {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &[])
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(Vec::new())
    }

    #[inline(always)]
    fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), _: &mut [R]) {}

    fn label(&self) -> String {
        "⊣".into()
    }
}

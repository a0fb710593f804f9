//! Takes a signal that nobody needs.

use crate::library::prelude::*;

declare_block! {
    /// Takes a signal that nobody needs.
    pub struct Terminator("terminator", Sinks): "u goes nowhere";
}

impl Block for Terminator {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &[])
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(Vec::new())
    }

    fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), _: &mut [R]) {}

    fn label(&self) -> String {
        "⊣".into()
    }
}

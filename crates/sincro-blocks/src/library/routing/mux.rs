//! Block `mux`.

use crate::library::prelude::*;

declare_block! {
    /// Puts its inputs one after the other into one vector, as a wire from `[a, b]` does.
    pub struct Mux("mux", Routing): "y = [u1, u2, …]" {
        /// Number of inputs.
        pub inputs: usize as PortCount = "2",
    }
}

impl Mux {
    /// Creates the block with so many inputs.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }
}

impl Block for Mux {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![inputs.iter().copied().sum()])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        // components may differ; the vector then has no unit, nor if that of one is unknown
        let all_known = inputs.iter().all(Option::is_some);
        Ok(vec![common(inputs).ok().flatten().filter(|_| all_known)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::InOrder
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let mut from = 0;
        for k in 0..self.inputs {
            let u = at.input(k);
            y[from..from + u.len()].copy_from_slice(u);
            from += u.len();
        }
    }
}

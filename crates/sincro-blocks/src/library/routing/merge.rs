//! Block `merge`.

use crate::library::prelude::*;

declare_block! {
    /// Passes on the input that changed last.
    ///
    /// For several senders of one command, of which only one is active at a time. An input has changed if any of its
    /// components is another number than in the sample before. If several have changed, the one with the lowest number
    /// counts; before anything changes it is `u1`. It looks at ticks only.
    pub struct Merge("merge", Routing):
        "y[k] = u_j[k], j the lowest number with u_j[k] ≠ u_j[k−1], else j as before; at first 1" {
        /// Number of inputs.
        pub inputs: usize as InputCount = "2",
    }
}

impl Merge {
    /// Creates the block with so many inputs, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }

    /// The number of the input to pass on, from 0. The memory holds it, then 1 from the second sample on, then all
    /// inputs of the sample before.
    fn active<R: Real>(&self, at: &At<'_, R>) -> usize {
        let before = at.memory[0].lane(0) as usize;
        if at.memory[1].lane(0) == 0.0 {
            return before;
        }
        let width = at.node.outputs[0];
        let has_changed = |k: &usize| {
            let then = &at.memory[2 + k * width..2 + (k + 1) * width];
            then.iter().enumerate().any(|(i, then)| then.lane(0) != at.input(*k)[i].lane(0))
        };
        (0..self.inputs).find(has_changed).unwrap_or(before)
    }
}

impl Block for Merge {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let mut known = inputs.iter().flatten();
        let first = known.next();
        match known.find(|width| Some(*width) != first) {
            Some(other) => Err(format!("all inputs have the same size, not {} and {other}", first.unwrap_or(other))),
            None => Ok(vec![first.copied()]),
        }
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: 2 + node.inputs.iter().sum::<usize>() }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.input(self.active(at)));
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        memory[0] = R::splat(self.active(at) as f64);
        memory[1] = R::one();
        let width = at.node.outputs[0];
        for k in 0..self.inputs {
            memory[2 + k * width..2 + (k + 1) * width].copy_from_slice(at.input(k));
        }
    }
}

//! Functions that were compiled from recordings, as what they were recorded from sees them.

use core::fmt;
use std::sync::Arc;

use crate::Real;

/// Compiled code of a [`Program`](crate::record::Program), with the bits of the algorithm that it was recorded from.
pub trait CompiledFunction: fmt::Debug + Send + Sync {
    /// Evaluates the function. Returns false, with `outputs` undefined, where it does not have the bits of its
    /// algorithm.
    fn evaluate(&self, inputs: &[f64], outputs: &mut [f64]) -> bool;
}

/// Compiled function of a state with its working memory.
#[derive(Clone, Debug)]
pub struct CompiledEvaluation {
    function: Arc<dyn CompiledFunction>,
    inputs: Vec<f64>,
    outputs: Vec<f64>,
    n_evaluations: u64,
}

impl CompiledEvaluation {
    /// Creates the working memory of a function with these numbers of inputs and outputs.
    #[must_use]
    pub fn new(function: Arc<dyn CompiledFunction>, n_inputs: usize, n_outputs: usize) -> Self {
        Self { function, inputs: vec![0.0; n_inputs], outputs: vec![0.0; n_outputs], n_evaluations: 0 }
    }

    /// Evaluates the function of a state, in several parts, and of what acts on it, which are its inputs in this order.
    /// Returns `None` where it does not have the bits of its algorithm: programs leave out x + 0, which is exact but
    /// for a state of −0.
    ///
    /// # Panics
    ///
    /// If there are more numbers than the function has inputs.
    #[inline]
    pub fn evaluate<R: Real, const N: usize>(&mut self, state: [&[R]; N], action: &[R]) -> Option<&[f64]> {
        let (mut has_negative_zero, mut rest) = (false, &mut self.inputs[..]);
        for part in state {
            let (of_part, after) = rest.split_at_mut(part.len());
            // not one after the other, and all: the comparisons are made in lanes
            has_negative_zero |= copy(part, of_part);
            rest = after;
        }
        copy(action, rest);
        if has_negative_zero || !self.function.evaluate(&self.inputs, &mut self.outputs) {
            return None;
        }
        self.n_evaluations += 1;
        Some(&self.outputs)
    }

    /// Number of evaluations that were not refused.
    #[must_use]
    pub fn n_evaluations(&self) -> u64 {
        self.n_evaluations
    }
}

/// Copies numbers; returns true if there is a −0 among them.
#[inline]
fn copy<R: Real>(from: &[R], to: &mut [f64]) -> bool {
    let mut has_negative_zero = false;
    for (x, to) in from.iter().zip(to) {
        *to = x.lane(0);
        has_negative_zero |= to.to_bits() == (-0.0_f64).to_bits();
    }
    has_negative_zero
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Sum;

    impl CompiledFunction for Sum {
        fn evaluate(&self, inputs: &[f64], outputs: &mut [f64]) -> bool {
            outputs[0] = inputs.iter().sum();
            inputs[0] < 10.0
        }
    }

    #[test]
    fn states_that_the_function_does_not_know_are_refused() {
        let mut sum = CompiledEvaluation::new(Arc::new(Sum), 4, 1);
        assert_eq!(sum.evaluate([&[1.0, 2.0], &[3.0]], &[-0.0]), Some(&[6.0][..]));
        assert_eq!(sum.evaluate([&[10.0, 2.0], &[3.0]], &[4.0]), None);
        assert_eq!(sum.evaluate([&[1.0, -0.0], &[3.0]], &[4.0]), None);
        assert_eq!(sum.n_evaluations(), 1);
    }
}

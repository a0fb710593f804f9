//! `x[k+1] = a x[k] + b u[k]`, `y[k] = c x[k] + d u[k]`.

use crate::library::continuous::LinearSystem;
use crate::library::prelude::*;

/// Block `discrete-state-space`: linear recursion `x[k+1] = a x + b u`, `y = c x + d u`. It has direct feedthrough only
/// where `d` is not zero.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteStateSpace {
    /// Matrices and initial states.
    pub system: LinearSystem,
}

impl DiscreteStateSpace {
    /// Creates the block of a linear system.
    #[must_use]
    pub fn new(system: LinearSystem) -> Self {
        Self { system }
    }
}

impl Described for DiscreteStateSpace {
    const KIND: &'static Kind = &Kind {
        name: "discrete-state-space",
        category: Category::Discrete,
        summary: "A linear recursion given by its four matrices.",
        equation: "x[k+1] = a x[k] + b u[k], y[k] = c x[k] + d u[k], x[0] = initial",
        parameters: &[
            Parameter::required("a", ValueKind::Matrix, "system matrix, n × n"),
            Parameter::required("b", ValueKind::Matrix, "input matrix, n × inputs; of one input, a list will do"),
            Parameter::required("c", ValueKind::Matrix, "output matrix, outputs × n"),
            Parameter::optional("d", ValueKind::Matrix, "feedthrough matrix, outputs × inputs; zero if left out", "[]"),
            Parameter::optional("initial", ValueKind::Numbers, "x at the start, one for all or one for each", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { system: LinearSystem::read(p) }
    }
}

impl Block for DiscreteStateSpace {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        self.system.width(inputs[0])
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.system.has_direct_feedthrough()
    }

    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: 0, discrete: self.system.n_states() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        self.system.start(memory);
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        self.system.output(at, at.memory, y);
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        self.system.next(at, at.memory, memory);
    }

    fn label(&self) -> String {
        "x⁺ = Ax + Bu".into()
    }
}

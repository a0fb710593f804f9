//! `x' = a x + b u`, `y = c x + d u`.

use super::LinearSystem;
use crate::library::prelude::*;

/// Block `state-space`: continuous linear system of its four matrices. It has direct feedthrough only where `d` is not
/// zero.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// Matrices and initial states; `a` `[1/s]` between states of one unit.
    pub system: LinearSystem,
}

impl StateSpace {
    /// Creates the block of a linear system.
    #[must_use]
    pub fn new(system: LinearSystem) -> Self {
        Self { system }
    }
}

impl Described for StateSpace {
    const KIND: &'static Kind = &Kind {
        name: "state-space",
        category: Category::Continuous,
        summary: "A linear system given by its four matrices.",
        equation: "x' = a x + b u, y = c x + d u, x(0) = initial",
        parameters: &[
            Parameter::required("a", ValueKind::Matrix, "system matrix, n × n [1/s]"),
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

impl Block for StateSpace {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        self.system.width(inputs[0])
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.system.has_direct_feedthrough()
    }

    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: self.system.n_states(), discrete: 0 }
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        self.system.start(states);
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        self.system.output(at, at.states, y);
    }

    #[inline(always)]
    fn derivatives<R: Real>(&self, at: &At<'_, R>, (): &mut (), derivatives: &mut [R]) {
        self.system.next(at, at.states, derivatives);
    }

    #[inline(always)]
    fn neg_jacobian_diagonal<R: Real>(&self, _: &At<'_, R>, diagonal: &mut [R]) {
        for (i, entry) in diagonal.iter_mut().enumerate() {
            *entry = R::splat(-self.system.a.at(i, i));
        }
    }

    fn label(&self) -> String {
        "x' = Ax + Bu".into()
    }
}

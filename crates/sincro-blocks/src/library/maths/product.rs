//! Block `product`.

use crate::library::prelude::*;

declare_block! {
    /// Multiplies its inputs component by component, or all components of a single input.
    pub struct Product("product", Maths): "y = u1·u2·…; of one input y = Π uᵢ" {
        /// Number of inputs.
        pub inputs: usize as InputCount = "2",
    }
}

impl Product {
    /// Creates the block with so many inputs, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }
}

impl Block for Product {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![if self.inputs == 1 { Some(1) } else { elementwise(inputs, &[])? }])
    }

    fn unit_rule(&self) -> UnitRule {
        if self.inputs == 1 { UnitRule::Unknown } else { UnitRule::Powers(vec![1; self.inputs]) }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        if self.inputs == 1 {
            y[0] = R::one();
            for u in at.input(0) {
                y[0] *= *u;
            }
            return;
        }
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i);
            for k in 1..self.inputs {
                *y *= at.component(k, i);
            }
        }
    }

    fn label(&self) -> String {
        if self.inputs == 1 { "Π".into() } else { "×".into() }
    }
}

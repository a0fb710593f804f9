//! `y = ±u1 ±u2 …`.

use crate::library::prelude::*;

declare_block! {
    /// Adds and subtracts its inputs.
    pub struct Sum("sum", Maths): "y = ±u1 ±u2 …" {
        /// A `+` or `-` for every input.
        pub signs: String as Text = "++",
    } with {
        /// True for the inputs that are subtracted.
        minus: Vec<bool> = Vec::new(),
    }
}

impl Sum {
    /// Creates the block from signs such as `"+-"`.
    ///
    /// # Panics
    ///
    /// If there is anything but `+` and `-`, or nothing.
    #[must_use]
    pub fn new(signs: &str) -> Self {
        assert!(are_signs(signs), "a sum has a `+` or `-` for every input");
        Self { signs: signs.into(), minus: minus(signs) }
    }
}

fn are_signs(signs: &str) -> bool {
    !signs.is_empty() && signs.chars().all(|c| matches!(c, '+' | '-'))
}

fn minus(signs: &str) -> Vec<bool> {
    signs.chars().map(|c| c == '-').collect()
}

impl Block for Sum {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;

    fn validate(&mut self, p: &mut Reader<'_>) {
        if !are_signs(&self.signs) {
            let message = format!("`{}` are no signs", self.signs);
            p.fault("signs", message, "write a `+` or `-` for every input, such as \"+-\"");
            self.signs = "+".into();
        }
        self.minus = minus(&self.signs);
    }

    fn ports(&self) -> Ports {
        Ports::numbered(self.minus.len())
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let first = at.component(0, i);
            let mut sum = if self.minus[0] { -first } else { first };
            for k in 1..self.minus.len() {
                let u = at.component(k, i);
                sum = if self.minus[k] { sum - u } else { sum + u };
            }
            *y = sum;
        }
    }

    fn label(&self) -> String {
        self.minus.iter().map(|minus| if *minus { '−' } else { '+' }).collect()
    }
}

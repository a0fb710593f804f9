//! `y = ±u1 ±u2 …`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::{Unit, common};

/// Adds and subtracts its inputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sum {
    /// A sign for every input: whether it is subtracted.
    pub minus: Vec<bool>,
}

impl Sum {
    /// From signs such as `"+-"`.
    ///
    /// # Panics
    ///
    /// If there is anything but `+` and `-`, or nothing.
    #[must_use]
    pub fn new(signs: &str) -> Self {
        let minus: Vec<bool> = signs
            .chars()
            .map(|c| {
                if c == '+' {
                    false
                } else {
                    assert!(c == '-');
                    true
                }
            })
            .collect();
        assert!(!minus.is_empty(), "a sum has at least one sign");
        Self { minus }
    }
}

impl Described for Sum {
    const KIND: &'static Kind = &Kind {
        name: "sum",
        group: Group::Maths,
        summary: "Adds and subtracts its inputs.",
        equation: "y = ±u1 ±u2 …",
        parameters: &[Parameter::optional("signs", Takes::Text, "a `+` or `-` for every input", "++")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let signs = p.text("signs");
        if signs.is_empty() || !signs.chars().all(|c| matches!(c, '+' | '-')) {
            p.fault("signs", format!("`{signs}` are no signs"), "write a `+` or `-` for every input, such as \"+-\"");
            return Self::new("+");
        }
        Self::new(&signs)
    }
}

impl Block for Sum {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(self.minus.len())
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![common(inputs)?])
    }

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

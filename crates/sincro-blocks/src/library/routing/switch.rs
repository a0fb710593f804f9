//! `y = on` where `control > threshold`, else `off`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::logic::Comparison;
use crate::library::logic::truth::choose;
use crate::library::short;
use crate::reader::Reader;
use crate::unit::{Unit, common};

/// Passes on one of two inputs, component by component, as a third one says. A `control` that is NaN makes NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// How `control` is compared with the threshold.
    pub criterion: Comparison,
    /// What `control` is compared with.
    pub threshold: f64,
}

impl Switch {
    /// `on` while `control` is above the threshold.
    #[must_use]
    pub fn new(threshold: f64) -> Self {
        Self { criterion: Comparison::Greater, threshold }
    }
}

impl Described for Switch {
    const KIND: &'static Kind = &Kind {
        name: "switch",
        group: Group::Routing,
        summary: "Passes on one of two inputs, as a third one says.",
        equation: "y = on if control criterion threshold, else off",
        parameters: &[
            Parameter::optional(
                "criterion",
                Takes::Choice(&[">", ">=", "!="]),
                "how `control` is compared with the threshold",
                ">",
            ),
            Parameter::optional("threshold", Takes::Number, "what `control` is compared with", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let criteria = [Comparison::Greater, Comparison::GreaterEqual, Comparison::NotEqual];
        Self { criterion: criteria[p.choice("criterion")], threshold: p.number("threshold") }
    }
}

impl Block for Switch {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["on", "control", "off"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![common(&[inputs[0].clone(), inputs[2].clone()])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let is_on = self.criterion.of(at.component(1, i), R::splat(self.threshold));
            *y = choose(is_on, at.component(0, i), at.component(2, i));
        }
    }

    fn label(&self) -> String {
        format!("{} {}", self.criterion.sign(), short(self.threshold))
    }
}

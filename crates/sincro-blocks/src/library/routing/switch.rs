//! Block `switch`.

use crate::library::logic::Comparison;
use crate::library::logic::truth::choose;
use crate::library::prelude::*;

declare_block! {
    /// Passes on one of two inputs, as a third one says.
    ///
    /// It works component by component. A `control` that is NaN makes NaN.
    pub struct Switch("switch", Routing): "y = on if control criterion threshold, else off" {
        /// Comparison of `control` with the threshold.
        pub criterion: Comparison as Criterion = ">",
        /// Threshold of `control`.
        pub threshold: f64 as Number = "0",
    }
}

/// The comparisons that a switch knows.
enum Criterion {}

impl ParameterType<Comparison> for Criterion {
    const VALUE_KIND: ValueKind = ValueKind::Choice(&[">", ">=", "!="]);

    fn read(reader: &mut Reader<'_>, key: &str) -> Comparison {
        [Comparison::Greater, Comparison::GreaterEqual, Comparison::NotEqual][reader.choice(key)]
    }
}

impl Switch {
    /// `on` while `control` is above the threshold.
    #[must_use]
    pub fn new(threshold: f64) -> Self {
        Self { criterion: Comparison::Greater, threshold }
    }
}

impl Block for Switch {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["on", "control", "off"], &["y"])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![common(&[inputs[0].clone(), inputs[2].clone()])?])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Same(vec![0, 2])
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

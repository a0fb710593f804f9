//! `y = u^exponent` or `y = u1^u2`.

use sincro_math::{Real, elementary};

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;

/// Raises to a power, component by component.
///
/// A negative number to a power that is not whole is not a number: the run stops and names this block.
#[derive(Clone, Debug, PartialEq)]
pub struct Power {
    /// The exponent, one for all components or one for each; none if it is the second input.
    pub exponent: Option<Vec<f64>>,
}

impl Power {
    /// With a constant exponent.
    #[must_use]
    pub fn new(exponent: f64) -> Self {
        Self { exponent: Some(vec![exponent]) }
    }
}

impl Described for Power {
    const KIND: &'static Kind = &Kind {
        name: "power",
        group: Group::Maths,
        summary: "Raises to a power, component by component.",
        equation: "y = u^exponent; without the parameter y = u1^u2",
        parameters: &[Parameter::optional(
            "exponent",
            Takes::Numbers,
            "exponent; if it is left out, there is a second input in its place",
            "none",
        )],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { exponent: p.has("exponent").then(|| p.numbers("exponent")) }
    }
}

impl Block for Power {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(if self.exponent.is_some() { 1 } else { 2 })
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let own = self.exponent.as_ref().map_or(1, Vec::len);
        Ok(vec![elementwise(inputs, &[("exponent", own)])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let base = at.component(0, i);
            *y = match &self.exponent {
                None => base.map2(at.component(1, i), elementary::pow),
                Some(exponent) => base.map(|u| {
                    let (power, by_base, _) = elementary::pow(u, of(exponent, i));
                    (power, by_base)
                }),
            };
        }
    }

    fn label(&self) -> String {
        match &self.exponent {
            Some(exponent) => format!("u^{}", short_list(exponent)),
            None => "u1^u2".into(),
        }
    }
}

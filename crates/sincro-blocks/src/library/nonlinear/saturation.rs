//! `y = u`, between `lower` and `upper`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;
use crate::unit::Unit;

/// Limits a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Saturation {
    /// Least value, one for all components or one for each.
    pub lower: Vec<f64>,
    /// Greatest value, one for all components or one for each.
    pub upper: Vec<f64>,
}

impl Saturation {
    /// With the same limits for all components.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower: vec![lower], upper: vec![upper] }
    }
}

impl Described for Saturation {
    const KIND: &'static Kind = &Kind {
        name: "saturation",
        group: Group::Nonlinear,
        summary: "Limits a signal.",
        equation: "y = min(max(u, lower), upper)",
        parameters: &[
            Parameter::optional("lower", Takes::Numbers, "least y", "-inf"),
            Parameter::optional("upper", Takes::Numbers, "greatest y", "inf"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let (lower, upper) = (p.limits("lower"), p.limits("upper"));
        super::check_limits(p, &lower, &upper);
        Self { lower, upper }
    }
}

impl Block for Saturation {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[("lower", self.lower.len()), ("upper", self.upper.len())])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i).max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)));
        }
    }

    fn label(&self) -> String {
        format!("{} … {}", short_list(&self.lower), short_list(&self.upper))
    }
}

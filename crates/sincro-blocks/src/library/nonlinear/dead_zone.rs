//! `y = 0` between `lower` and `upper`; beyond, what is left over.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;
use crate::unit::Unit;

/// Lets small values pass as zero and shortens the others.
#[derive(Clone, Debug, PartialEq)]
pub struct DeadZone {
    /// Where the zone begins, one for all components or one for each.
    pub lower: Vec<f64>,
    /// Where it ends, one for all components or one for each.
    pub upper: Vec<f64>,
}

impl DeadZone {
    /// With the same zone for all components.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower: vec![lower], upper: vec![upper] }
    }
}

impl Described for DeadZone {
    const KIND: &'static Kind = &Kind {
        name: "dead-zone",
        group: Group::Nonlinear,
        summary: "Lets small values pass as zero and shortens the others.",
        equation: "y = u − min(max(u, lower), upper)",
        parameters: &[
            Parameter::required("lower", Takes::Numbers, "where the zone begins"),
            Parameter::required("upper", Takes::Numbers, "where the zone ends"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let (lower, upper) = (p.limits("lower"), p.limits("upper"));
        super::check_limits(p, &lower, &upper);
        Self { lower, upper }
    }
}

impl Block for DeadZone {
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
            let u = at.component(0, i);
            *y = u - u.max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)));
        }
    }

    fn label(&self) -> String {
        format!("{} … {}", short_list(&self.lower), short_list(&self.upper))
    }
}

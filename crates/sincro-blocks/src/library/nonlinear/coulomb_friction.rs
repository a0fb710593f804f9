//! `y = coulomb·sign(u) + viscous·u`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Friction against a velocity: a constant part with its sign, and a part in proportion. Zero at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct CoulombFriction {
    /// Size of the constant part, one for all components or one for each.
    pub coulomb: Vec<f64>,
    /// Slope of the proportional part, one for all components or one for each.
    pub viscous: Vec<f64>,
}

impl CoulombFriction {
    /// The same for all components.
    #[must_use]
    pub fn new(coulomb: f64, viscous: f64) -> Self {
        Self { coulomb: vec![coulomb], viscous: vec![viscous] }
    }
}

impl Described for CoulombFriction {
    const KIND: &'static Kind = &Kind {
        name: "coulomb-friction",
        group: Group::Nonlinear,
        summary: "Friction against a velocity: a constant part with its sign, and a part in proportion.",
        equation: "y = coulomb·sign(u) + viscous·u",
        parameters: &[
            Parameter::required("coulomb", Takes::Numbers, "constant part [unit of y]"),
            Parameter::optional("viscous", Takes::Numbers, "proportional part [unit of y / unit of u]", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { coulomb: p.numbers("coulomb"), viscous: p.numbers("viscous") }
    }
}

impl Block for CoulombFriction {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let parameters = [("coulomb", self.coulomb.len()), ("viscous", self.viscous.len())];
        Ok(vec![elementwise(inputs, &parameters)?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let zero = R::zero();
        for (i, y) in y.iter_mut().enumerate() {
            let (u, c) = (at.component(0, i), R::splat(of(&self.coulomb, i)));
            let constant = zero.if_less(u, c, u.if_less(zero, -c, zero));
            *y = constant + R::splat(of(&self.viscous, i)) * u;
        }
    }
}

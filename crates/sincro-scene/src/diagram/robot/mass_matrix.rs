//! `y = M(q), row by row`.

use std::sync::Arc;

use sincro_blocks::block::{At, Block, Ports};
use sincro_blocks::kind::{Category, Described, Kind};
use sincro_blocks::reader::Reader;
use sincro_dynamics::crba::mass_matrix;
use sincro_dynamics::model::Model;
use sincro_math::Real;

use super::{Context, Item, MODEL, Robot, SET, check_widths};

/// Block `mass-matrix`: input `q` (n_q), output `y`, the mass matrix row by row (n_v × n_v): `[kg·m²]`, `[kg·m]` or
/// `[kg]` by the kinds of the two degrees of freedom.
#[derive(Clone, Debug)]
pub struct MassMatrix {
    model: Arc<Model<f64>>,
}

pub(super) const ITEM: Item = Item { kind: MassMatrix::KIND, read: |_, context| Box::new(MassMatrix::new(context)) };

impl MassMatrix {
    /// Creates the block; it computes with the model of `context`, that of the scene.
    #[must_use]
    pub fn new(context: &Context) -> Self {
        Self { model: context.model.clone() }
    }
}

impl Described for MassMatrix {
    const KIND: &'static Kind = &Kind {
        name: "mass-matrix",
        category: Category::Robot,
        summary: "The joint-space mass matrix, row by row.",
        equation: "y = M(q), n_v × n_v, row by row",
        parameters: &[MODEL, SET],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        unreachable!("made with the model, by its item")
    }
}

impl Block for MassMatrix {
    type Work<R: Real> = Robot<R>;

    fn ports(&self) -> Ports {
        Ports::new(&["q"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let (n_q, n_v) = (self.model.n_q(), self.model.n_v());
        check_widths(inputs, &[("q", n_q)])?;
        Ok(vec![Some(n_v * n_v)])
    }

    fn work<R: Real>(&self) -> Robot<R> {
        Robot::new(&self.model)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, robot: &mut Robot<R>, y: &mut [R]) {
        let (model, scratch, _) = robot.parts();
        mass_matrix(model, at.input(0), scratch, y);
    }

    fn label(&self) -> String {
        "M(q)".into()
    }
}

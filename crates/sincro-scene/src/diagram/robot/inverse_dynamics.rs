//! `y = M(q)·a + h(q, v)`.

use std::sync::Arc;

use sincro_blocks::block::{At, Block, Ports};
use sincro_blocks::kind::{Category, Described, Kind};
use sincro_blocks::reader::Reader;
use sincro_blocks::unit_rule::UnitRule;
use sincro_dynamics::model::Model;
use sincro_dynamics::rnea::inverse_dynamics;
use sincro_math::Real;

use super::{Context, Item, MODEL, Robot, SET, check_widths, force_units};

/// Block `inverse-dynamics`: inputs `q` (n_q), `v` and `a` (n_v each), output `y` (n_v), the generalized forces that
/// cause these accelerations, gravity included, `[N·m]` or `[N]`.
#[derive(Clone, Debug)]
pub struct InverseDynamics {
    model: Arc<Model<f64>>,
}

pub(super) const ITEM: Item =
    Item { kind: InverseDynamics::KIND, read: |_, context| Box::new(InverseDynamics::new(context)) };

impl InverseDynamics {
    /// Creates the block; it computes with the model of `context`, that of the scene.
    #[must_use]
    pub fn new(context: &Context) -> Self {
        Self { model: context.model.clone() }
    }
}

impl Described for InverseDynamics {
    const KIND: &'static Kind = &Kind {
        name: "inverse-dynamics",
        category: Category::Robot,
        summary: "The joint torques that given accelerations take: for computed torque and feed-forward.",
        equation: "y = M(q)·a + h(q, v), gravity included",
        parameters: &[MODEL, SET],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        unreachable!("made with the model, by its item")
    }
}

impl Block for InverseDynamics {
    type Work<R: Real> = Robot<R>;

    fn ports(&self) -> Ports {
        Ports::new(&["q", "v", "a"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let (n_q, n_v) = (self.model.n_q(), self.model.n_v());
        check_widths(inputs, &[("q", n_q), ("v", n_v), ("a", n_v)])?;
        Ok(vec![Some(n_v)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Fixed(force_units(&self.model))
    }

    fn work<R: Real>(&self) -> Robot<R> {
        Robot::new(&self.model)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, robot: &mut Robot<R>, y: &mut [R]) {
        let (model, scratch, _) = robot.parts();
        inverse_dynamics(model, at.input(0), at.input(1), at.input(2), None, scratch, y);
    }

    fn label(&self) -> String {
        "M a + h".into()
    }
}

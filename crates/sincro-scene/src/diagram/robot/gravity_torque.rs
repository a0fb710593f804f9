//! `y = g(q)`.

use std::sync::Arc;

use sincro_blocks::block::{At, Block, Ports};
use sincro_blocks::kind::{Category, Described, Kind};
use sincro_blocks::reader::Reader;
use sincro_blocks::unit_rule::UnitRule;
use sincro_dynamics::model::Model;
use sincro_dynamics::rnea::inverse_dynamics;
use sincro_math::Real;

use super::{Context, Item, MODEL, Robot, SET, check_widths, force_units};

/// Block `gravity-torque`: input `q` (n_q coordinates), output `y` (n_v), the generalized forces that hold the model at
/// rest against gravity `[N·m]` or `[N]`, in the order of the velocities.
#[derive(Clone, Debug)]
pub struct GravityTorque {
    model: Arc<Model<f64>>,
}

pub(super) const ITEM: Item =
    Item { kind: GravityTorque::KIND, read: |_, context| Box::new(GravityTorque::new(context)) };

impl GravityTorque {
    /// Creates the block; it computes with the model of `context`, that of the scene.
    #[must_use]
    pub fn new(context: &Context) -> Self {
        Self { model: context.model.clone() }
    }
}

impl Described for GravityTorque {
    const KIND: &'static Kind = &Kind {
        name: "gravity-torque",
        category: Category::Robot,
        summary: "The joint torques that hold the model still against gravity.",
        equation: "y = g(q)",
        parameters: &[MODEL, SET],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        unreachable!("made with the model, by its item")
    }
}

impl Block for GravityTorque {
    type Work<R: Real> = Robot<R>;
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::new(&["q"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let (n_q, n_v) = (self.model.n_q(), self.model.n_v());
        check_widths(inputs, &[("q", n_q)])?;
        Ok(vec![Some(n_v)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Fixed(force_units(&self.model))
    }

    fn work<R: Real>(&self) -> Robot<R> {
        Robot::new(&self.model)
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, robot: &mut Robot<R>, y: &mut [R]) {
        let (model, scratch, zero) = robot.parts();
        inverse_dynamics(model, at.input(0), zero, zero, None, scratch, y);
    }

    fn label(&self) -> String {
        "g(q)".into()
    }
}

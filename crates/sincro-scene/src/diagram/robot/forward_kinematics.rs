//! Position and orientation of a frame, with `v` its velocity too.

use std::sync::Arc;

use sincro_blocks::block::{At, Block, Ports};
use sincro_blocks::kind::{Category, Described, Kind, Parameter, ValueKind};
use sincro_blocks::reader::Reader;
use sincro_blocks::unit_rule::UnitRule;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::spatial::Quat;
use sincro_math::Real;

use super::{Context, Item, MODEL, Robot, SET, check_widths, frame};
use crate::record::probe::attached;

/// Block `forward-kinematics`: input `q` (n_q coordinates), outputs `position` of a body or frame in the world (3,
/// `[m]`) and its `quaternion` (w, x, y, z). With velocities: also an input `v` (n_v), and outputs `velocity` of its
/// origin (3, `[m/s]`) and `angular_velocity` (3, `[rad/s]`), both in world axes.
#[derive(Clone, Debug)]
pub struct ForwardKinematics {
    model: Arc<Model<f64>>,
    frame: usize,
    velocity: bool,
}

pub(super) const ITEM: Item = Item {
    kind: ForwardKinematics::KIND,
    read: |reader, context| {
        let velocity = reader.flag("velocity");
        Box::new(ForwardKinematics::new(context, frame(reader, context), velocity))
    },
};

impl ForwardKinematics {
    /// Creates the block for the frame with index `frame` among the frames of the model's names; `velocity`: with the
    /// input `v` and the outputs of velocities.
    #[must_use]
    pub fn new(context: &Context, frame: usize, velocity: bool) -> Self {
        Self { model: context.model.clone(), frame, velocity }
    }
}

impl Described for ForwardKinematics {
    const KIND: &'static Kind = &Kind {
        name: "forward-kinematics",
        category: Category::Robot,
        summary: "Where a body or frame is in the world, and how fast it moves if asked for.",
        equation: "position = p(q), quaternion = (w, x, y, z) of R(q); velocity = ṗ, angular_velocity = ω, world axes",
        parameters: &[
            Parameter::required("frame", ValueKind::Text, "path of the body or frame"),
            Parameter::optional(
                "velocity",
                ValueKind::Flag,
                "whether there is an input `v` and outputs for velocities",
                "false",
            ),
            MODEL,
            SET,
        ],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        unreachable!("made with the model, by its item")
    }
}

impl Block for ForwardKinematics {
    type Work<R: Real> = Robot<R>;
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        match self.velocity {
            true => Ports::new(&["q", "v"], &["position", "quaternion", "velocity", "angular_velocity"]),
            false => Ports::new(&["q"], &["position", "quaternion"]),
        }
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        check_widths(inputs, &[("q", self.model.n_q()), ("v", self.model.n_v())])?;
        Ok([3, 4, 3, 3][..if self.velocity { 4 } else { 2 }].iter().copied().map(Some).collect())
    }

    fn unit_rule(&self) -> UnitRule {
        let ports = [("m", 3), ("1", 4), ("m/s", 3), ("rad/s", 3)].into_iter().take(if self.velocity { 4 } else { 2 });
        UnitRule::fixed(ports.flat_map(|(unit, width)| std::iter::repeat_n(unit, width)))
    }

    fn work<R: Real>(&self) -> Robot<R> {
        Robot::new(&self.model)
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, robot: &mut Robot<R>, y: &mut [R]) {
        let (model, scratch, zero) = robot.parts();
        let v = if self.velocity { at.input(1) } else { zero };
        kinematics::motions(model, at.input(0), v, zero, scratch);
        let frame = attached(model, self.frame);
        let pose = kinematics::frame_pose(scratch, &frame);
        y[..3].copy_from_slice(&pose.pos.0);
        Quat::from_matrix(&pose.rot).write(&mut y[3..7]);
        if self.velocity {
            let twist = kinematics::frame_velocity(scratch, &frame);
            y[7..10].copy_from_slice(&twist.lin.0);
            y[10..13].copy_from_slice(&twist.ang.0);
        }
    }

    fn label(&self) -> String {
        "p(q)".into()
    }
}

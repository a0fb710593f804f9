//! `y = J(q)`, row by row: `[ω; ṗ] = J(q)·v`.

use std::sync::Arc;

use sincro_blocks::block::{At, Block, Ports};
use sincro_blocks::kind::{Category, Described, Kind, Parameter, ValueKind};
use sincro_blocks::reader::Reader;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_math::Real;

use super::{Context, Item, MODEL, Robot, SET, check_widths, frame};
use crate::record::probe::attached;

/// Block `jacobian`: input `q` (n_q), output `y`, the Jacobian of a body or frame row by row: angular velocity (3 rows,
/// `[rad/s]` per unit of velocity), then velocity of the origin (3 rows, `[m/s]`), both in world axes, n_v columns.
#[derive(Clone, Debug)]
pub struct Jacobian {
    model: Arc<Model<f64>>,
    frame: usize,
    rows: Rows,
}

/// Choice of rows of the Jacobian of a [`Jacobian`] block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// Six rows: angular velocity, then velocity of the origin.
    All,
    /// Three rows: angular velocity.
    Angular,
    /// Three rows: velocity of the origin.
    Linear,
}

impl Rows {
    fn range(self) -> core::ops::Range<usize> {
        match self {
            Self::All => 0..6,
            Self::Angular => 0..3,
            Self::Linear => 3..6,
        }
    }
}

pub(super) const ITEM: Item = Item {
    kind: Jacobian::KIND,
    read: |reader, context| {
        let rows = [Rows::All, Rows::Angular, Rows::Linear][reader.choice("rows")];
        Box::new(Jacobian::new(context, frame(reader, context), rows))
    },
};

impl Jacobian {
    /// Creates the block for the frame with index `frame` among the frames of the model's names.
    #[must_use]
    pub fn new(context: &Context, frame: usize, rows: Rows) -> Self {
        Self { model: context.model.clone(), frame, rows }
    }
}

impl Described for Jacobian {
    const KIND: &'static Kind = &Kind {
        name: "jacobian",
        category: Category::Robot,
        summary: "The Jacobian of a body or frame: from joint velocities to its velocity in the world, row by row.",
        equation: "[ω; ṗ] = J(q)·v, world axes, y = rows of J",
        parameters: &[
            Parameter::required("frame", ValueKind::Text, "path of the body or frame"),
            Parameter::optional("rows", ValueKind::Choice(&["all", "angular", "linear"]), "which rows", "all"),
            MODEL,
            SET,
        ],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        unreachable!("made with the model, by its item")
    }
}

impl Block for Jacobian {
    type Work<R: Real> = (Robot<R>, Vec<R>);
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::new(&["q"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        check_widths(inputs, &[("q", self.model.n_q())])?;
        Ok(vec![Some(self.rows.range().len() * self.model.n_v())])
    }

    fn work<R: Real>(&self) -> (Robot<R>, Vec<R>) {
        (Robot::new(&self.model), vec![R::zero(); 6 * self.model.n_v()])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (robot, whole): &mut (Robot<R>, Vec<R>), y: &mut [R]) {
        let (model, scratch, _) = robot.parts();
        kinematics::jacobian(model, at.input(0), &attached(model, self.frame), scratch, whole);
        let rows = self.rows.range();
        y.copy_from_slice(&whole[rows.start * model.n_v()..rows.end * model.n_v()]);
    }

    fn label(&self) -> String {
        "J(q)".into()
    }
}

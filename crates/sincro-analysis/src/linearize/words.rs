//! Record of a reduction to independent coordinates, in numbers and in words.

use sincro_dynamics::actuation::drive::DriveKind;
use sincro_dynamics::constraint::ActiveSource;
use sincro_dynamics::model::Model;

use super::lens::EquationSource;
use super::reduction::{Equations, Tangent};

/// Element of the scene whose constraint equations [`linearize`](super::linearize) eliminated; an entry of
/// [`Reduction::elements`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReducedElement {
    /// Name of the loop joint, gear or joint; of a contact the two bodies as `A–B`.
    pub name: String,
    /// Reason why its equations hold at the operating point.
    pub kind: ReducedKind,
    /// Number of scalar equations, redundant ones included.
    pub equations: usize,
}

/// Kind of an element whose equations were eliminated, by the reason why they hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReducedKind {
    /// Closed loop or gear.
    Loop,
    /// Velocity motor whose command is an input: the joint's velocity is given.
    MotorInput,
    /// Velocity motor whose command is no input: its joint is held.
    HeldMotor,
    /// Position motor: the joint's velocity follows from its position.
    PositionMotor,
    /// Joint stuck in Coulomb friction, which no small force moves.
    Stuck,
    /// Joint pressed against a position limit.
    AtLimit,
    /// Closed contact, in its normal direction.
    Contact,
    /// Contact that sticks or rolls without slipping, in its tangential directions.
    Sticking,
}

impl ReducedKind {
    /// Identifier of the kind in `linearization.json`, such as `loop`.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::MotorInput => "velocity_motor_input",
            Self::HeldMotor => "held_motor",
            Self::PositionMotor => "position_motor",
            Self::Stuck => "stuck_friction",
            Self::AtLimit => "joint_limit",
            Self::Contact => "contact",
            Self::Sticking => "sticking_contact",
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Loop => "closed loops and gears",
            Self::MotorInput => "velocities given by motors that are inputs",
            Self::HeldMotor => "joints held by velocity motors that are no inputs",
            Self::PositionMotor => "joints whose velocity a position motor gives",
            Self::Stuck => "joints stuck in friction, which no small force moves",
            Self::AtLimit => "joints pressed against a limit",
            Self::Contact => "closed contacts, which do not open for small motions",
            Self::Sticking => "contacts that roll or stick without slipping (nonholonomic: the coordinates remain)",
        }
    }
}

/// Record of the elimination that leads from the states of the tree to independent ones, part of a
/// [`Linearization`](super::Linearization); lists name states as `system.states` would.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reduction {
    /// Elements whose equations were eliminated, ordered by kind.
    pub elements: Vec<ReducedElement>,
    /// Number of independent velocity equations: so many speeds are no states.
    pub rank: usize,
    /// Number of those equations that hold for coordinates, too: so many coordinates are no states.
    pub holonomic_rank: usize,
    /// Names of the coordinates that follow from the states.
    pub dependent_coordinates: Vec<String>,
    /// Names of the speeds that follow from the states.
    pub dependent_speeds: Vec<String>,
    /// Names of the states on which no other rate depends, in the order of the states; each has a pole at zero. They
    /// are not eliminated.
    pub cyclic: Vec<String>,
}

impl Reduction {
    /// Describes what was eliminated.
    pub(super) fn of(
        model: &Model<f64>,
        equations: &Equations,
        tangent: &Tangent,
        names: &[crate::linear::Axis],
        locks: &[super::lens::Lock],
    ) -> Self {
        let n_v = equations.rate_by_v.ncols();
        let mut elements: Vec<ReducedElement> = Vec::new();
        let set = model.constraints();
        for (i, source) in equations.sources.iter().enumerate() {
            let of_pair = |pair: usize| {
                let pair = &set.pairs[pair];
                format!("{}–{}", set.colliders[pair.a].name, set.colliders[pair.b].name)
            };
            let (name, kind) = match *source {
                EquationSource::Constraint(ActiveSource::LoopJoint(k)) => {
                    (set.loop_joints[k].name.clone(), ReducedKind::Loop)
                }
                EquationSource::Constraint(ActiveSource::Gear(k)) => (set.gears[k].name.clone(), ReducedKind::Loop),
                EquationSource::Constraint(ActiveSource::Limit(k)) => {
                    (model.names().dof_name(set.limits[k].dof).to_owned(), ReducedKind::AtLimit)
                }
                EquationSource::Constraint(ActiveSource::Contact(pair)) => (of_pair(pair), ReducedKind::Contact),
                EquationSource::Constraint(ActiveSource::StickingFriction(pair)) => {
                    (of_pair(pair), ReducedKind::Sticking)
                }
                EquationSource::Drive(drive) => {
                    let held = locks.iter().any(|lock| lock.drive == drive && lock.holds_position);
                    let drive = &model.drives()[drive];
                    let kind = match drive.kind {
                        DriveKind::Friction => ReducedKind::Stuck,
                        // degrees of freedom of a force sensor are none
                        DriveKind::Lock => continue,
                        DriveKind::Motor(_) if held => ReducedKind::HeldMotor,
                        DriveKind::Motor(id) if equations.rate_by_q.row(i).iter().all(|x| *x == 0.0) => {
                            let _ = id;
                            ReducedKind::MotorInput
                        }
                        DriveKind::Motor(_) => ReducedKind::PositionMotor,
                    };
                    (model.names().dof_name(drive.dof).to_owned(), kind)
                }
            };
            match elements.iter_mut().find(|e| e.name == name && e.kind == kind) {
                Some(known) => known.equations += 1,
                None => elements.push(ReducedElement { name, kind, equations: 1 }),
            }
        }
        // loops count with all their equations, of which the mechanism uses an independent set
        for element in elements.iter_mut().filter(|e| e.kind == ReducedKind::Loop) {
            if let Some(joint) = set.loop_joints.iter().find(|joint| joint.name == element.name) {
                element.equations = joint.kind.rows();
            }
        }
        elements.sort_by_key(|e| e.kind);
        let missing = |range: core::ops::Range<usize>| {
            range.filter(|k| !tangent.states.contains(k)).map(|k| names[k].name.clone()).collect()
        };
        Self {
            elements,
            rank: tangent.rank.0,
            holonomic_rank: tangent.rank.1,
            dependent_coordinates: missing(0..n_v),
            dependent_speeds: missing(n_v..2 * n_v),
            cyclic: Vec::new(),
        }
    }

    /// Returns true if no element was eliminated and no state is cyclic.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.elements.is_empty() && self.cyclic.is_empty()
    }

    /// Describes the reduction in English for a report, one sentence per kind of element and list of names; empty if
    /// nothing was reduced.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut rest = &self.elements[..];
        while let Some(first) = rest.first() {
            let n = rest.iter().take_while(|e| e.kind == first.kind).count();
            let equations: usize = rest[..n].iter().map(|e| e.equations).sum();
            let list = listed(rest[..n].iter().map(|e| e.name.as_str()));
            let s = if equations == 1 { "" } else { "s" };
            lines.push(format!("{}: {list} ({equations} equation{s})", first.kind.words()));
            rest = &rest[n..];
        }
        if !self.dependent_coordinates.is_empty() {
            let list = listed(self.dependent_coordinates.iter().map(String::as_str));
            lines.push(format!("coordinates that follow from the states: {list}"));
        }
        if !self.dependent_speeds.is_empty() {
            let list = listed(self.dependent_speeds.iter().map(String::as_str));
            lines.push(format!("speeds that follow from the states: {list}"));
        }
        if !self.cyclic.is_empty() {
            let list = listed(self.cyclic.iter().map(String::as_str));
            lines.push(format!("states on which no other rate depends, each with a pole at zero: {list}"));
        }
        lines
    }
}

/// Names in backticks, the first few of many.
fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 8;
    let n = names.len();
    let list = names.take(SHOWN).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    if n > SHOWN { format!("{list} and {} more", n - SHOWN) } else { list }
}

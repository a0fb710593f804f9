//! Inertias that forces along a tendon, or between two frames, meet, to translate soft constraints that are given by
//! their time constant.

use sincro_dynamics::actuation::ForceLaw;
use sincro_dynamics::joint::JointKind as ModelKind;
use sincro_dynamics::model::{BodySpec, BushingSpec, JointSpec, ModelBuilder, NodeId, PathSpec, SpringDamperSpec};
use sincro_dynamics::state::State;
use sincro_dynamics::stiffness::{inverse_inertias_of_bushings, stiffest};

use crate::policy::properties;
use crate::robot::{Joint, JointKind, Placement, Robot, TendonPath};

/// A robot as a model under construction.
struct Built {
    builder: ModelBuilder,
    /// Node of each link.
    links: Vec<NodeId>,
    /// Node of each joint.
    joints: Vec<NodeId>,
}

/// The masses, joints and armatures of a robot.
fn built(robot: &Robot) -> Built {
    let mut builder = ModelBuilder::new([0.0; 3]);
    let mut links = vec![NodeId::WORLD; robot.links.len()];
    let mut joints = vec![NodeId::WORLD; robot.joints.len()];
    let carriers = robot.carriers();
    let mut stack: Vec<(usize, NodeId)> =
        (0..robot.links.len()).filter(|k| carriers[*k].is_none()).map(|root| (root, NodeId::WORLD)).collect();
    let children = |link: Option<usize>| (0..robot.joints.len()).filter(move |k| robot.joints[*k].parent == link);
    let mut open: Vec<usize> = children(None).collect();
    loop {
        while let Some((link, carrier)) = stack.pop() {
            let own = &robot.links[link];
            let pose = own.pose.pose();
            let name = format!("link{link}");
            links[link] = match &own.inertial {
                Some(inertial) => builder.body(&name, carrier, pose, BodySpec { mass: properties(inertial) }),
                None => builder.frame(&name, carrier, pose),
            };
            open.extend(children(Some(link)));
        }
        let Some(k) = open.pop() else { break };
        let joint = &robot.joints[k];
        let carrier = joint.parent.map_or(NodeId::WORLD, |link| links[link]);
        joints[k] = match model_kind(joint) {
            None => builder.frame(&format!("joint{k}"), carrier, joint.pose.pose()),
            Some(kind) => {
                let spec = JointSpec { armature: joint.armature.clone(), ..JointSpec::new(kind) };
                builder.joint(&format!("joint{k}"), carrier, joint.pose.pose(), spec)
            }
        };
        stack.push((joint.child, joints[k]));
    }
    Built { builder, links, joints }
}

/// Mass 1/(J M⁻¹ Jᵀ) of a robot along a path, with the Jacobian J of its length, at zero coordinates `[kg]`; none if it
/// moves nothing, or if the robot is none that can be simulated.
pub(crate) fn tendon_mass(robot: &Robot, path: &TendonPath) -> Option<f64> {
    let Built { mut builder, links, joints } = built(robot);
    let path = match path {
        TendonPath::Through(through) => PathSpec::Points(through.iter().map(|link| (links[*link], [0.0; 3])).collect()),
        TendonPath::Joints(shares) => PathSpec::Joints(shares.iter().map(|(k, c)| (joints[*k], *c)).collect()),
    };
    let law = ForceLaw { stiffness: 1.0, damping: 0.0, preload: 0.0, nonlinear: None };
    builder.spring_damper(
        "tendon",
        SpringDamperSpec { path, free_length: None, law, tension_only: false, actuator: None },
    );
    let (model, _) = builder.build().ok()?;
    let mass = stiffest(&model, &State::new(&model))?.inertia;
    (mass.is_finite() && mass > 0.0).then_some(mass)
}

/// Inverse masses J M⁻¹ Jᵀ `[1/kg]` along the axes of the first of two frames, each on a link or in the world, and
/// inverse moments of inertia about them `[1/(kg·m²)]`, at the reference: zero coordinates of joints
/// with one degree of freedom, those at the start of others. None if the robot is none that can be simulated, or if
/// nothing moves.
pub(crate) fn frame_masses(robot: &Robot, ends: &[(Option<usize>, Placement); 2]) -> Option<[f64; 6]> {
    let Built { mut builder, links, joints } = built(robot);
    let nodes = ends.map(|(link, _)| link.map_or(NodeId::WORLD, |link| links[link]));
    let poses = ends.map(|(_, placement)| placement.pose());
    builder.bushing("bushing", BushingSpec { ends: nodes, poses, stiffness: [1.0; 6], damping: [0.0; 6] });
    let (model, _) = builder.build().ok()?;
    let mut state = State::new(&model);
    for info in model.names().joints.iter().filter(|info| info.n_q > 1) {
        let own = joints.iter().position(|node| *node == info.node).and_then(|k| robot.joints[k].initial.as_deref());
        if let Some(q) = own.filter(|q| q.len() == info.n_q) {
            state.q[info.q_idx..info.q_idx + info.n_q].copy_from_slice(q);
        }
    }
    inverse_inertias_of_bushings(&model, &state).first().copied()
}

/// Mass `[kg]` and moment of inertia `[kg·m²]` that a soft constraint of MJCF takes for the inverse ones along and
/// about three axes: those of their means, whatever the axes, zero where nothing moves. None if nothing moves at all.
pub(crate) fn mean_masses(inverse: [f64; 6]) -> Option<[f64; 2]> {
    let mean = |three: &[f64]| Some(three.iter().sum::<f64>() / 3.0).filter(|x| *x > 0.0).map_or(0.0, |x| 1.0 / x);
    let masses = [mean(&inverse[..3]), mean(&inverse[3..])];
    (masses != [0.0; 2]).then_some(masses)
}

/// Kind of a joint in a model; none for a fixed one.
fn model_kind(joint: &Joint) -> Option<ModelKind> {
    let axis = joint.axis;
    Some(match joint.kind {
        JointKind::Fixed => return None,
        JointKind::Revolute => ModelKind::Revolute { axis },
        JointKind::Prismatic => ModelKind::Prismatic { axis },
        JointKind::Screw(pitch) => ModelKind::Screw { axis, pitch },
        JointKind::Universal(axis2) => ModelKind::Universal { axis, axis2 },
        JointKind::Ball => ModelKind::Ball,
        JointKind::Planar => ModelKind::Planar,
        JointKind::Free => ModelKind::Free,
    })
}

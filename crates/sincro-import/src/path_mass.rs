//! Inertias that forces along a tendon, or between two bodies, meet, to translate soft constraints that are given by
//! their time constant.

use sincro_dynamics::actuation::ForceLaw;
use sincro_dynamics::joint::JointKind as ModelKind;
use sincro_dynamics::model::{Attached, BodySpec, JointSpec, Model, ModelBuilder, NodeId, PathSpec, SpringDamperSpec};
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::stiffness::{mean_inverse_inertias, stiffest};

use crate::policy::properties;
use crate::robot::{Joint, JointKind, Robot, TendonPath};

/// Inverse mass `[1/kg]`, or inverse moment of inertia, that counts as none; MuJoCo's `mjMINVAL`.
const LEAST: f64 = 1e-15;

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
        SpringDamperSpec { path, free_length: None, law, tension_only: false, actuator: None, activation: None },
    );
    let (model, _) = builder.build().ok()?;
    let mass = stiffest(&model, &State::new(&model))?.inertia;
    (mass.is_finite() && mass > 0.0).then_some(mass)
}

/// Mass `[kg]` and moment of inertia `[kg·m²]` of a soft constraint between points of two links, or of the world, at
/// zero coordinates, as [`masses_of`]; none if the robot is none that can be simulated.
pub(crate) fn masses_between(robot: &Robot, points: &[(Option<usize>, [f64; 3]); 2]) -> Option<[f64; 2]> {
    let Built { mut builder, links, .. } = built(robot);
    for (k, (link, point)) in points.iter().enumerate() {
        let carrier = link.map_or(NodeId::WORLD, |link| links[link]);
        builder.frame(&format!("end{k}"), carrier, Pose::translation(Vec3(*point)));
    }
    let (model, _) = builder.build().ok()?;
    let frame = |k: usize| {
        let info = model.names().frame(&format!("end{k}"))?;
        Some(Attached { link: info.link, pose: info.pose })
    };
    Some(masses_of(&model, &[frame(0)?, frame(1)?]))
}

/// Mass `[kg]` and moment of inertia `[kg·m²]` that MuJoCo takes for a soft constraint between two bodies with these
/// centres of mass: the inverse of the sum of their mean inverse ones (its `body_invweight0`), at zero coordinates,
/// wherever the anchor is. Zero where nothing moves.
pub(crate) fn masses_of(model: &Model<f64>, centres: &[Attached<f64>; 2]) -> [f64; 2] {
    let q = State::new(model).q;
    let each = centres.each_ref().map(|centre| mean_inverse_inertias(model, &q, centre));
    let inverse = |x: f64| if x.is_finite() && x > LEAST { 1.0 / x } else { 0.0 };
    [0, 1].map(|k| inverse(each[0][k] + each[1][k]))
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

//! What the builder refuses, and what it only warns of.

use super::builder::{JointSpec, ModelBuilder, Node, NodeId, NodeKind};
use super::problem::{Problem, Severity};
use super::{MassProperties, Model};
use crate::joint::JointKind;

/// Relative excess over the triangle inequality that is put down to rounding of printed figures.
const TRIANGLE_SLACK: f64 = 1e-9;

struct Findings(Vec<Problem>);

impl Findings {
    fn error(&mut self, node: NodeId, field: &'static str, message: String, help: &str) {
        self.0.push(Problem { severity: Severity::Error, node: Some(node), field, message, help: help.into() });
    }
}

/// Everything that can be said of the objects one by one, and of the tree.
pub(super) fn check(builder: &ModelBuilder) -> Vec<Problem> {
    let mut found = Findings(Vec::new());
    if builder.gravity.iter().any(|g| !g.is_finite()) {
        found.error(
            NodeId::WORLD,
            "gravity",
            format!("gravity {:?} is not finite", builder.gravity),
            "give three numbers in m/s²",
        );
    }
    for (id, node) in builder.nodes.iter().enumerate() {
        let id = NodeId(id as u32);
        check_pose(&mut found, id, node);
        match &node.kind {
            NodeKind::Joint(spec) => check_joint(&mut found, id, node, spec, builder),
            NodeKind::Body(spec) => check_mass(&mut found, id, &node.name, &spec.mass),
            NodeKind::Rotor(spec) => {
                if !(spec.density.is_finite() && spec.density >= 0.0) {
                    let message = format!(
                        "density {} kg/m³ of the air at `{}` is not a positive number",
                        spec.density, node.name
                    );
                    found.error(id, "air_density", message, "1.225 at sea level, 0 in a vacuum");
                }
            }
            NodeKind::Force(_) | NodeKind::Frame | NodeKind::World => {}
        }
    }
    found.0
}

fn check_pose(found: &mut Findings, id: NodeId, node: &Node) {
    if !node.pose.pos.0.iter().all(|x| x.is_finite()) {
        let message = format!("position {:?} of `{}` is not finite", node.pose.pos.0, node.name);
        found.error(id, "position", message, "give three numbers in m");
    }
    if !node.pose.rot.0.iter().flatten().all(|x| x.is_finite()) {
        let message = format!("rotation of `{}` is not finite", node.name);
        found.error(id, "rotation", message, "give three finite angles, or a quaternion that is not null");
    }
}

fn check_mass(found: &mut Findings, id: NodeId, name: &str, mass: &MassProperties) {
    let m = mass.mass;
    if !(m.is_finite() && m > 0.0) {
        let message = format!("mass {m} kg of `{name}` is not positive");
        found.error(id, "mass", message, "give a positive mass; an object without mass is a frame");
    }
    if !mass.center_of_mass.iter().all(|x| x.is_finite()) {
        let message = format!("centre of mass of `{name}` is not finite");
        found.error(id, "center_of_mass", message, "give three numbers in m");
    }
    if !mass.inertia.iter().all(|x| x.is_finite()) {
        let message = format!("inertia of `{name}` is not finite");
        return found.error(id, "inertia", message, "give numbers in kg·m²");
    }
    let moments = mass.principal_moments();
    if moments[0] < -1e-12 * moments[2].abs() {
        let message = format!("inertia of `{name}` has a negative principal moment, {:.6e} kg·m²", moments[0]);
        return found.error(id, "inertia", message, "every principal moment must be zero (a point) or positive");
    }
    let excess = mass.triangle_excess();
    if excess > TRIANGLE_SLACK {
        found.0.push(Problem {
            severity: Severity::Warning,
            node: Some(id),
            field: "inertia",
            message: format!(
                "no rigid body has the inertia of `{name}`: its largest principal moment {:.6e} kg·m² exceeds the sum of the \
                 others by {:.1} %",
                moments[2],
                100.0 * excess
            ),
            help: "check the figures (triangle inequality); the run goes on with them as they stand".into(),
        });
    }
}

fn check_joint(found: &mut Findings, id: NodeId, node: &Node, spec: &JointSpec, builder: &ModelBuilder) {
    let name = &node.name;
    check_axes(found, id, name, &spec.kind);
    let n = match spec.kind {
        JointKind::Fixed => 0,
        JointKind::Universal { .. } => 2,
        JointKind::Ball | JointKind::Planar => 3,
        JointKind::Free => 6,
        _ => 1,
    };
    let scalar = !matches!(spec.kind, JointKind::Ball | JointKind::Free);
    let lists = [
        ("armature", spec.armature.len(), true),
        ("spring", spec.spring.len(), scalar),
        ("damping", spec.damping.len(), true),
        ("friction", spec.friction.len(), scalar),
        ("torque", spec.torque.len(), true),
    ];
    for (field, len, allowed) in lists {
        if len != 0 && (len != n || !allowed) {
            let message = format!("`{field}` of `{name}` has {len} entries, the joint has {n} degrees of freedom");
            let help = if allowed { "give one entry a degree of freedom" } else { "a ball or free joint takes none" };
            found.error(id, field, message, help);
        }
    }
    let finite_and_not_negative =
        [("armature", &spec.armature), ("damping", &spec.damping), ("friction", &spec.friction)];
    for (field, list) in finite_and_not_negative {
        for x in list.iter().filter(|x| !(x.is_finite() && **x >= 0.0)) {
            found.error(id, field, format!("{field} {x} of `{name}` is negative or not finite"), "give zero or more");
        }
    }
    for (stiffness, rest) in &spec.spring {
        if !(stiffness.is_finite() && *stiffness >= 0.0 && rest.is_finite()) {
            let message = format!("spring of `{name}` (stiffness {stiffness}, rest {rest}) is negative or not finite");
            found.error(id, "spring", message, "stiffness is zero or more, the rest position finite");
        }
    }
    check_motor(found, id, name, spec, n);
    if !carries_a_body(builder, id) {
        let message = format!("joint `{name}` carries no body");
        found.error(id, "name", message, "hang a body on it, or make it a frame");
    }
}

fn check_motor(found: &mut Findings, id: NodeId, name: &str, spec: &JointSpec, n: usize) {
    let Some(motor) = &spec.motor else { return };
    if n != 1 {
        let message = format!("joint `{name}` has {n} degrees of freedom; a motor drives one");
        found.error(id, "motor", message, "use a chain of revolute or prismatic joints");
    }
    for (field, x) in motor.numbers() {
        if x.is_nan() || x < 0.0 {
            let message = format!("motor of `{name}`: {field} {x} is negative or not a number");
            found.error(id, "motor", message, "give zero or more");
        }
    }
}

fn check_axes(found: &mut Findings, id: NodeId, name: &str, kind: &JointKind) {
    let mut axis_of = |field: &'static str, axis: [f64; 3]| {
        let square: f64 = axis.iter().map(|x| x * x).sum();
        if !(square.is_finite() && square > 1e-24) {
            let message = format!("axis {axis:?} of `{name}` has no direction");
            found.error(id, field, message, "give three finite numbers, not all zero");
        }
    };
    match *kind {
        JointKind::Revolute { axis } | JointKind::Prismatic { axis } | JointKind::Screw { axis, .. } => {
            axis_of("axis", axis);
        }
        JointKind::Universal { axis, axis2 } => {
            axis_of("axis", axis);
            axis_of("axis2", axis2);
            let cross = crate::spatial::Vec3(axis).cross(crate::spatial::Vec3(axis2)).norm();
            if cross < 1e-9 {
                let message = format!("the two axes of `{name}` are parallel");
                found.error(id, "axis2", message, "a universal joint needs two directions");
            }
        }
        _ => {}
    }
    if let JointKind::Screw { pitch, .. } = kind
        && !pitch.is_finite()
    {
        found.error(id, "pitch", format!("pitch {pitch} of `{name}` is not finite"), "give a number in m/rad");
    }
}

fn carries_a_body(builder: &ModelBuilder, joint: NodeId) -> bool {
    let mut carried = vec![false; builder.nodes.len()];
    carried[joint.0 as usize] = true;
    (joint.0 as usize + 1..builder.nodes.len()).any(|k| {
        carried[k] = carried[builder.nodes[k].parent.0 as usize];
        carried[k] && matches!(builder.nodes[k].kind, NodeKind::Body(_))
    })
}

/// Joints along which no inertia can be felt: a point mass on its own axis, say.
pub(super) fn massless_joints(model: &Model<f64>) -> Vec<Problem> {
    let inertias = crate::aba::joint_inertias(model, &crate::state::State::new(model));
    let scale = inertias.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let mut found = Findings(Vec::new());
    for (dof, &inertia) in inertias.iter().enumerate() {
        // relative to rounding of the largest: 1e-12 kg·m² beside 1 kg·m² is a legitimate inertia, 1e-18 is not
        if inertia.is_nan() || inertia <= 1e-17 * scale {
            let joint = &model.names.joints[model.names.dof_joint[dof]];
            found.error(
                joint.node,
                "axis",
                format!("joint `{}` moves no inertia about its axis ({inertia:.3e})", joint.name),
                "give the body it carries an inertia about that axis, or the joint an armature",
            );
        }
    }
    found.0
}

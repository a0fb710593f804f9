//! Checks of the builder's objects: errors, for which no model is built, and warnings.

use crate::actuation::{Bushing, DriveKind, MotorMode, SpringDamper, Winding};
use crate::aero::rotor::RotorLaw;
use crate::joint::{Friction, JointKind};
use crate::model::builder::{
    DragSpec, JointSpec, ModelBuilder, Node, NodeId, NodeKind, PathSpec, RotorDrive, RotorSpec,
};
use crate::model::diagnostic::{Diagnostic, Severity};
use crate::model::{MassProperties, Model};
use crate::spatial::{Mat3, Vec3};

/// Relative excess over the triangle inequality that is put down to rounding of printed figures.
const TRIANGLE_SLACK: f64 = 1e-9;

struct Findings(Vec<Diagnostic>);

impl Findings {
    fn error(&mut self, node: NodeId, field: &'static str, message: String, help: &str) {
        self.0.push(Diagnostic { severity: Severity::Error, node: Some(node), field, message, help: help.into() });
    }
}

/// Everything that can be said of the objects one by one, and of the tree.
pub(super) fn check(builder: &ModelBuilder) -> Vec<Diagnostic> {
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
            NodeKind::Rotor(spec) => check_rotor(&mut found, id, node, spec, &builder.nodes),
            NodeKind::Drag(spec) => check_drag(&mut found, id, node, spec),
            NodeKind::Force(_) | NodeKind::Frame | NodeKind::World => {}
        }
    }
    for (name, spec) in &builder.spring_dampers {
        let is_line = matches!(&spec.path, PathSpec::Points(points) if points.len() == 2);
        let word = if is_line { "spring_damper" } else { "tendon" };
        let of = format!("{word} `{name}`");
        let of_activation = spec.activation.iter().flat_map(|activation| activation.problems(&of));
        for (_, message, help) in spec.problems(&of).into_iter().chain(of_activation) {
            let (severity, help) = (Severity::Error, help.into());
            found.0.push(Diagnostic { severity, node: None, field: "spring_damper", message, help });
        }
    }
    for (name, spec) in &builder.spring_dampers {
        let PathSpec::Joints(joints) = &spec.path else { continue };
        let has_one = |node: &NodeId| {
            let NodeKind::Joint(joint) = &builder.nodes[node.0 as usize].kind else { return false };
            matches!(joint.kind, JointKind::Revolute { .. } | JointKind::Prismatic { .. } | JointKind::Screw { .. })
        };
        if let Some((node, _)) = joints.iter().find(|(node, _)| !has_one(node)) {
            let message = format!("tendon `{name}` takes a coordinate of `{}`", builder.nodes[node.0 as usize].name);
            let help = "give joints with one degree of freedom".into();
            let (severity, node) = (Severity::Error, Some(*node));
            found.0.push(Diagnostic { severity, node, field: "joints", message, help });
        }
    }
    for (name, spec) in &builder.elastic_gears {
        let numbers = [
            ("ratio", spec.gear.ratio, spec.gear.ratio.is_finite() && spec.gear.ratio != 0.0),
            ("offset", spec.gear.offset, spec.gear.offset.is_finite()),
            ("stiffness", spec.stiffness, spec.stiffness.is_finite() && spec.stiffness > 0.0),
            ("damping", spec.damping, spec.damping.is_finite() && spec.damping >= 0.0),
            ("backlash", spec.backlash, spec.backlash.is_finite() && spec.backlash >= 0.0),
        ];
        for (field, x, _) in numbers.into_iter().filter(|(.., fits)| !fits) {
            let message = format!("{field} {x} of the elastic gear `{name}` is none that it can have");
            let help = "give a finite ratio other than 0, a positive stiffness, damping and backlash of zero or more";
            let (severity, help) = (Severity::Error, help.into());
            found.0.push(Diagnostic { severity, node: None, field: "coupling", message, help });
        }
    }
    for (name, spec) in &builder.bushings {
        for (_, message, help) in spec.problems(&format!("bushing `{name}`")) {
            let (severity, help) = (Severity::Error, help.into());
            found.0.push(Diagnostic { severity, node: None, field: "bushing", message, help });
        }
    }
    found.0
}

fn check_density(found: &mut Findings, id: NodeId, node: &Node, density: f64) {
    if !(density.is_finite() && density >= 0.0) {
        let message = format!("density {density} kg/m³ of the air at `{}` is not a positive number", node.name);
        found.error(id, "air_density", message, "1.225 at sea level, 0 in a vacuum");
    }
}

fn check_rotor(found: &mut Findings, id: NodeId, node: &Node, spec: &RotorSpec, nodes: &[Node]) {
    let name = &node.name;
    check_density(found, id, node, spec.density);
    if matches!(spec.law, RotorLaw::Stock(_)) && spec.drive != RotorDrive::Command {
        let message = format!("rotor `{name}` is a stock propeller, which does not turn");
        found.error(id, "stock", message, "its `speed` is the velocity of its particles; leave `lag` and `joint` out");
    }
    check_extras(found, id, name, spec);
    match spec.drive {
        RotorDrive::Command => {}
        RotorDrive::Lag { time_constant, initial } => {
            if !(time_constant.is_finite() && time_constant > 0.0) {
                let message = format!("time constant {time_constant} s of rotor `{name}` is not positive");
                found.error(
                    id,
                    "lag",
                    message,
                    "give a positive time; a rotor without `lag` follows its command at once",
                );
            }
            if !initial.is_finite() {
                let message = format!("initial speed {initial} rad/s of rotor `{name}` is not finite");
                found.error(id, "lag", message, "give a number in rad/s");
            }
        }
        RotorDrive::Joint(joint) => {
            if let Err((message, help)) = turn_of_rotor(nodes, id, joint) {
                found.error(id, "joint", message, help);
            }
        }
    }
}

/// Notes an inertia or a ground effect that the rotor cannot have.
fn check_extras(found: &mut Findings, id: NodeId, name: &str, spec: &RotorSpec) {
    let inertia = spec.inertia;
    if !(inertia.is_finite() && inertia >= 0.0) {
        let message = format!("inertia {inertia} kg·m² of rotor `{name}` is not a positive number");
        found.error(id, "inertia", message, "that of the turning part about its axis, or 0 for none");
    } else if inertia != 0.0 && matches!(spec.drive, RotorDrive::Joint(_)) {
        let message = format!("rotor `{name}` turns with a joint and has an inertia of its own");
        found.error(id, "inertia", message, "give 0: the bodies that the joint carries have it");
    } else if inertia != 0.0 && spec.law.spin().is_none() {
        let message = format!("rotor `{name}` has an inertia, but its law knows no sense of rotation");
        found.error(id, "inertia", message, "give 0, or take another law");
    }
    if spec.ground_effect && !matches!(spec.law, RotorLaw::Blade(_)) {
        let message = format!("rotor `{name}` has a ground effect, but no blades");
        found.error(id, "ground_effect", message, "leave it out: only blade elements have an induced velocity");
    }
}

/// +1 if the thrust axis of a rotor points along the axis of the joint it turns with, −1 if against it.
///
/// # Errors
///
/// That it does not turn with the joint, or not about its own axis; what is wrong, and what helps.
pub(super) fn turn_of_rotor(nodes: &[Node], rotor: NodeId, joint: NodeId) -> Result<f64, (String, &'static str)> {
    let name = &nodes[rotor.0 as usize].name;
    let joint_name = &nodes[joint.0 as usize].name;
    let NodeKind::Joint(spec) = &nodes[joint.0 as usize].kind else {
        return Err((
            format!("rotor `{name}` takes its speed from `{joint_name}`, which is no joint"),
            "name a revolute joint",
        ));
    };
    let JointKind::Revolute { axis } = spec.kind else {
        let message = format!("rotor `{name}` takes its speed from joint `{joint_name}`, which is not revolute");
        return Err((message, "a rotor turns with a revolute joint"));
    };
    // the rotor's axes in those of what the joint carries
    let (mut rot, mut at) = (nodes[rotor.0 as usize].pose.rot, nodes[rotor.0 as usize].parent);
    while at != joint {
        let node = &nodes[at.0 as usize];
        let is_fixed = match &node.kind {
            NodeKind::Joint(spec) => spec.kind == JointKind::Fixed,
            NodeKind::World => false,
            _ => true,
        };
        if !is_fixed {
            let message =
                format!("rotor `{name}` takes its speed from joint `{joint_name}`, but does not turn with it");
            return Err((message, "hang the rotor on the joint, or on a body that the joint carries"));
        }
        rot = node.pose.rot.mul(&rot);
        at = node.parent;
    }
    let thrust = Mat3::mul_vec(&rot, Vec3([0.0, 0.0, 1.0]));
    let axis = Vec3(axis);
    let along = thrust.dot(axis) / axis.norm();
    if (along.abs() - 1.0).abs() > 1e-9 {
        let message = format!("the axis of rotor `{name}` is not that of joint `{joint_name}`, which turns it");
        return Err((
            message,
            "turn the rotor so that its z axis is the joint's axis: rotation_deg, or the joint's axis",
        ));
    }
    Ok(along.signum())
}

fn check_drag(found: &mut Findings, id: NodeId, node: &Node, spec: &DragSpec) {
    check_density(found, id, node, spec.density);
    for (field, list, unit) in [("area", spec.area, "m²"), ("linear", spec.linear, "N·s/m")] {
        if !list.iter().all(|x| x.is_finite() && *x >= 0.0) {
            let message = format!("{field} {list:?} {unit} of drag `{}` is negative or not finite", node.name);
            found.error(id, field, message, "give three numbers, zero or more: drag brakes");
        }
    }
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
        found.0.push(Diagnostic {
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
    let lists = [
        ("armature", spec.armature.len()),
        // a law of its own is a second list of the same springs
        ("spring", if spec.spring.len() == n { spec.spring_law.len() } else { spec.spring.len() }),
        ("damping", spec.damping.len()),
        ("friction", spec.friction.len()),
        ("torque", spec.torque.len()),
    ];
    for (field, len) in lists {
        if len != 0 && len != n {
            let message = format!("`{field}` of `{name}` has {len} entries, the joint has {n} degrees of freedom");
            found.error(id, field, message, "give one entry a degree of freedom");
        }
    }
    let finite_and_not_negative = [("armature", &spec.armature), ("damping", &spec.damping)];
    for (field, list) in finite_and_not_negative {
        for x in list.iter().filter(|x| !(x.is_finite() && **x >= 0.0)) {
            found.error(id, field, format!("{field} {x} of `{name}` is negative or not finite"), "give zero or more");
        }
    }
    for friction in &spec.friction {
        check_friction(found, id, name, friction, &spec.kind);
    }
    for (stiffness, rest) in &spec.spring {
        if !(stiffness.is_finite() && *stiffness >= 0.0 && rest.is_finite()) {
            let message = format!("spring of `{name}` (stiffness {stiffness}, rest {rest}) is negative or not finite");
            found.error(id, "spring", message, "stiffness is zero or more, the rest position finite");
        }
    }
    if matches!(spec.kind, JointKind::Ball | JointKind::Free) && spec.spring_law.iter().any(Option::is_some) {
        let message = format!("the spring of `{name}` has a law: rotations in three directions have no deflection");
        found.error(id, "spring", message, "give `stiffness` and `rest` alone");
    }
    check_motor(found, id, name, spec, n);
    if !carries_a_body(builder, id) {
        let message = format!("joint `{name}` carries no body");
        found.error(id, "name", message, "hang a body on it, or make it a frame");
    }
}

fn check_friction(found: &mut Findings, id: NodeId, name: &str, friction: &Friction<f64>, kind: &JointKind) {
    let Friction { sliding, at_rest, stribeck_velocity, load_coefficient } = *friction;
    if !(load_coefficient.is_finite() && load_coefficient >= 0.0) {
        let message =
            format!("the load coefficient of the friction of `{name}`, {load_coefficient}, is negative or not finite");
        found.error(id, "friction", message, "give zero or more");
    }
    if load_coefficient > 0.0 && !matches!(kind, JointKind::Revolute { .. } | JointKind::Prismatic { .. }) {
        let message = format!("the friction of `{name}` cannot grow with the load of the joint");
        found.error(id, "friction", message, "only revolute and prismatic joints have a `load_coefficient`");
    }
    let is_positive = |x: f64| x.is_finite() && x >= 0.0;
    if !is_positive(sliding) || !is_positive(at_rest) {
        let x = if is_positive(sliding) { at_rest } else { sliding };
        found.error(id, "friction", format!("friction {x} of `{name}` is negative or not finite"), "give zero or more");
    } else if at_rest < sliding {
        let message = format!("friction of `{name}` is {at_rest} at rest, less than {sliding} in motion");
        found.error(id, "friction", message, "the limit at rest is at least that in motion");
    }
    if !(stribeck_velocity.is_finite() && stribeck_velocity > 0.0) {
        let message = format!("the Stribeck velocity of `{name}`, {stribeck_velocity}, is not positive and finite");
        found.error(id, "friction", message, "give the speed at which friction has fallen to its value in motion");
    }
}

fn check_motor(found: &mut Findings, id: NodeId, name: &str, spec: &JointSpec, n: usize) {
    if !spec.motor.is_empty() && spec.motor.len() != n {
        let message = format!("joint `{name}` has {n} degrees of freedom and {} motors", spec.motor.len());
        let help = "give a list with one motor for each degree of freedom, with mode `free` for those without";
        found.error(id, "motor", message, if n == 0 { "a fixed joint has none: leave it out" } else { help });
    }
    check_windings(found, id, name, spec);
    check_activations(found, id, name, spec);
    for motor in &spec.motor {
        let is_servo = matches!(motor.mode, MotorMode::Position | MotorMode::Spring);
        if is_servo && matches!(spec.kind, JointKind::Ball | JointKind::Free) {
            let message = format!("motor of `{name}`: the orientation of the joint is no list of positions");
            let help = "take mode `torque` or `velocity`, or a `spring` of the joint with a rest orientation";
            found.error(id, "motor", message, help);
        }
        for (field, x) in motor.numbers() {
            if x.is_nan() || x < 0.0 {
                let message = format!("motor of `{name}`: {field} {x} is negative or not a number");
                found.error(id, "motor", message, "give zero or more");
            }
        }
    }
}

fn check_windings(found: &mut Findings, id: NodeId, name: &str, spec: &JointSpec) {
    for (k, motor) in spec.motor.iter().enumerate() {
        let winding = spec.winding.get(k).copied().flatten();
        if (motor.mode == MotorMode::Voltage) != winding.is_some() {
            let message = format!("motor of `{name}`: a winding and mode `voltage` go together");
            found.error(id, "motor", message, "give both or neither");
        }
        for (field, x) in winding.iter().flat_map(Winding::numbers) {
            let is_positive = matches!(field, "resistance" | "torque_constant" | "gear_ratio" | "max_voltage");
            let is_bounded = x.is_finite() || (field == "max_voltage" && x > 0.0);
            if !is_bounded || x < 0.0 || (is_positive && x == 0.0) {
                let message = format!("motor of `{name}`: {field} {x} is not a number that a winding can have");
                let help = if is_positive { "give a number above zero" } else { "give zero or more" };
                found.error(id, "motor", message, help);
            }
        }
    }
}

fn check_activations(found: &mut Findings, id: NodeId, name: &str, spec: &JointSpec) {
    for (k, motor) in spec.motor.iter().enumerate() {
        let Some(activation) = spec.activation.get(k).copied().flatten() else { continue };
        if !matches!(motor.mode, MotorMode::Torque | MotorMode::Spring | MotorMode::Voltage) {
            let message = format!("motor of `{name}`: an ideal motor has no activation");
            found.error(id, "motor", message, "take mode `torque`, `spring` or `voltage`, or leave `activation` out");
        }
        for (_, message, help) in activation.problems(&format!("the motor of `{name}`")) {
            found.error(id, "motor", message, help);
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

/// Springs and dampers between points of one body, whose length never changes, and bushings between its frames.
pub(super) fn idle_lines(model: &Model<f64>) -> Vec<Diagnostic> {
    let is_idle = |(element, _): &(&SpringDamper<f64>, &String)| {
        element.shares().is_empty() && element.segments().iter().all(|s| s.ends[0].link == s.ends[1].link)
    };
    let lines = model.spring_dampers.iter().zip(&model.names.spring_dampers);
    let diagnostic = |(element, name): (&SpringDamper<f64>, &String)| {
        let what = if element.segments().len() == 1 { "both ends of spring_damper" } else { "all points of tendon" };
        Diagnostic {
            severity: Severity::Error,
            node: None,
            field: "spring_damper",
            message: format!("{what} `{name}` are fixed in one another: it moves nothing"),
            help: "join points that move against each other".into(),
        }
    };
    let bushings = model.bushings.iter().zip(&model.names.bushings);
    let idle_bushings = bushings.filter(|(element, _)| element.ends[0].link == element.ends[1].link);
    let of_bushing = |(_, name): (&Bushing<f64>, &String)| Diagnostic {
        severity: Severity::Error,
        node: None,
        field: "bushing",
        message: format!("both ends of bushing `{name}` are fixed in one another: it moves nothing"),
        help: "join frames that move against each other".into(),
    };
    lines.filter(is_idle).map(diagnostic).chain(idle_bushings.map(of_bushing)).collect()
}

/// Joints along which no inertia can be felt: a point mass on its own axis, say.
pub(super) fn massless_joints(model: &Model<f64>) -> Vec<Diagnostic> {
    let inertias = crate::recursions::aba::joint_inertias(model, &crate::state::State::new(model));
    let scale = inertias.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let mut found = Findings(Vec::new());
    let is_locked =
        |dof: usize| model.params.drives.iter().any(|drive| drive.dof == dof && drive.kind == DriveKind::Lock);
    for (dof, &inertia) in inertias.iter().enumerate().filter(|(dof, _)| !is_locked(*dof)) {
        // relative to rounding of the largest: 1e-12 kg·m² beside 1 kg·m² is a legitimate inertia, 1e-18 is not
        if inertia.is_nan() || inertia <= 1e-17 * scale {
            let joint = model.names.joint_info(model.names.dof_joint[dof]);
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

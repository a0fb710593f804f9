//! Joints of SDF: a spanning tree of the links, loop joints for the rest, gearboxes.

use std::f64::consts::TAU;

use sincro_dynamics::spatial::Vec3;
use sincro_scene::diagnostic::Diagnostic;

use super::Raw;
use super::frames::Places;
use crate::findings::Findings;
use crate::robot::{Gear, Joint, JointKind, Loop, LoopKind, Placement, Robot};
use crate::source::Element;

/// Conventions of the version of a file.
pub(super) struct Settings {
    /// Axes may be in the frame of the model.
    pub old: bool,
}

/// Reads all joints.
pub(super) fn joints(robot: &mut Robot, raw: &Raw<'_>, places: &Places, settings: &Settings, findings: &mut Findings) {
    let mut gearboxes = Vec::new();
    for (element, prefix, model) in &raw.joints {
        let made = joint(*element, (prefix, model), robot, raw, places, settings, findings);
        let Some(made) = findings.take(made) else { continue };
        match made {
            Made::Tree(joint, pose) => {
                robot.links[joint.child].pose = pose;
                robot.joints.push(*joint);
            }
            Made::Loop(closure) => {
                element.change("it closes a loop: a [[closure]]");
                robot.loops.push(*closure);
            }
            Made::Gearbox(prefix) => gearboxes.push((*element, prefix)),
        }
    }
    for (element, prefix) in gearboxes {
        match gearbox(element, &prefix, robot, raw, places) {
            Ok(gear) => {
                element.change("a gear between two joints: a [[coupling]]");
                robot.gears.push(gear);
            }
            Err(diagnostic) => {
                element.drop("the joints that it couples are not found");
                findings.warn(diagnostic);
            }
        }
    }
}

enum Made {
    /// A joint of the tree, and the child's frame in the joint's.
    Tree(Box<Joint>, Placement),
    Loop(Box<Loop>),
    Gearbox(String),
}

/// The link of a name; none for the world.
fn find(element: Element<'_>, which: &str, prefix: &str, raw: &Raw<'_>) -> Result<Option<usize>, Diagnostic> {
    let end = element.child(which).ok_or_else(|| element.error(format!("the joint has no `{which}`")))?;
    let name = end.text();
    if name == "world" {
        return Ok(None);
    }
    let full = format!("{prefix}{name}");
    let found = raw.links.iter().position(|(_, known)| *known == full);
    found.map(Some).ok_or_else(|| end.error(format!("there is no link `{name}`")))
}

fn joint(
    element: Element<'_>,
    (prefix, model): (&str, &str),
    robot: &Robot,
    raw: &Raw<'_>,
    places: &Places,
    settings: &Settings,
    findings: &mut Findings,
) -> Result<Made, Diagnostic> {
    let name = element.attribute("name").ok_or_else(|| element.error("a joint without `name`"))?;
    let word = element.attribute("type").ok_or_else(|| element.error(format!("joint `{name}` has no `type`")))?;
    let (parent, child) = (find(element, "parent", prefix, raw)?, find(element, "child", prefix, raw)?);
    let Some(child) = child else {
        return Err(element
            .error(format!("joint `{name}` has the world as its child"))
            .with_help("exchange parent and child"));
    };
    if parent == Some(child) {
        return Err(element.error(format!("joint `{name}` connects a link with itself")));
    }
    let kind = match word {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "fixed" => JointKind::Fixed,
        "ball" => JointKind::Ball,
        "universal" | "revolute2" => JointKind::Universal([0.0, 1.0, 0.0]),
        "screw" => JointKind::Screw(pitch(element)?),
        "gearbox" => return Ok(Made::Gearbox(prefix.to_owned())),
        other => return Err(element.error(format!("joint `{name}`: `{other}` is no kind of joint that is read"))),
    };
    let x_wj = places.of(&format!("{prefix}{name}"));
    let x_wc = places.of(&raw.links[child].1);
    let x_wp = parent.map_or_else(sincro_dynamics::spatial::Pose::identity, |p| places.of(&raw.links[p].1));
    let mut made = Joint {
        pose: Placement::of_pose(&x_wp.inverse().compose(&x_wj)),
        ..Joint::new(name, element.id(), kind, parent, child)
    };
    if kind.dofs() > 0 {
        axes(element, &mut made, (prefix, model), &x_wj.rot, places, settings, findings)?;
    }
    let taken = robot.joint_of(child).is_some() || reaches(robot, child, parent);
    if !taken {
        let own = Placement::of_pose(&x_wj.inverse().compose(&x_wc));
        return Ok(Made::Tree(Box::new(made), own));
    }
    let kind = match made.kind {
        JointKind::Revolute => LoopKind::Hinge(made.axis),
        JointKind::Ball => LoopKind::Point,
        JointKind::Fixed => LoopKind::Weld,
        other => {
            let message = format!("joint `{name}` closes a loop, and a {} joint cannot", other.word());
            return Err(element.error(message).with_help("revolute, ball and fixed joints close loops"));
        }
    };
    if !made.damping.is_empty() || made.spring.is_some() || made.limits.is_some() {
        element.change("spring, damping and limits of a joint that closes a loop are left out");
    }
    let ends = [(parent, made.pose), (Some(child), Placement::of_pose(&x_wc.inverse().compose(&x_wj)))];
    Ok(Made::Loop(Box::new(Loop {
        name: name.to_owned(),
        at: element.location(),
        element: element.id(),
        kind,
        softness: None,
        ends,
    })))
}

/// True if `from` carries `to` by joints already read.
fn reaches(robot: &Robot, from: usize, to: Option<usize>) -> bool {
    let mut at = to;
    for _ in 0..=robot.links.len() {
        match at {
            Some(link) if link == from => return true,
            Some(link) => at = robot.joint_of(link).and_then(|j| robot.joints[j].parent),
            None => return false,
        }
    }
    true
}

/// Advance of a screw [m/rad].
fn pitch(element: Element<'_>) -> Result<f64, Diagnostic> {
    if let Some(given) = element.child("screw_thread_pitch") {
        return Ok(given.text_numbers()?.first().copied().unwrap_or(1.0) / TAU);
    }
    match element.child("thread_pitch") {
        // the old key counts radians a metre, against the axis
        Some(given) => {
            let per_metre = given.text_numbers()?.first().copied().unwrap_or(1.0);
            if per_metre == 0.0 { Err(given.error("a pitch of zero")) } else { Ok(-1.0 / per_metre) }
        }
        None => Ok(1.0 / TAU),
    }
}

fn axes(
    element: Element<'_>,
    joint: &mut Joint,
    (prefix, model): (&str, &str),
    rot: &sincro_dynamics::spatial::Mat3<f64>,
    places: &Places,
    settings: &Settings,
    findings: &mut Findings,
) -> Result<(), Diagnostic> {
    let name = joint.name.clone();
    let direction = |axis: Element<'_>| -> Result<[f64; 3], Diagnostic> {
        let Some(xyz) = axis.child("xyz") else { return Ok([0.0, 0.0, 1.0]) };
        let n = xyz.text_numbers()?;
        let own: [f64; 3] = n.try_into().map_err(|_| xyz.error("`xyz` has three numbers"))?;
        if own == [0.0; 3] {
            return Err(xyz.error(format!("the axis of joint `{name}` is zero")));
        }
        let in_model =
            settings.old && axis.child("use_parent_model_frame").is_some_and(|u| matches!(u.text(), "1" | "true"));
        let frame = xyz.attribute("expressed_in").filter(|f| !f.is_empty()).map(|f| format!("{prefix}{f}"));
        let frame = frame.or_else(|| in_model.then(|| model.to_owned()));
        let Some(frame) = frame else { return Ok(own) };
        let turned = rot.tr_mul_vec(places.of(&frame).rot.mul_vec(Vec3(own)));
        Ok(turned.0.map(|x| if (x - x.round()).abs() < 4e-16 { x.round() + 0.0 } else { x }))
    };
    let one = joint.kind.dofs() == 1;
    let mut damping = Vec::new();
    for (k, name) in ["axis", "axis2"].into_iter().enumerate() {
        let Some(axis) = element.child(name) else { continue };
        if joint.kind == JointKind::Ball {
            axis.change("a ball joint has no axis");
        }
        match (&mut joint.kind, k) {
            (JointKind::Universal(second), 1) => *second = direction(axis)?,
            (_, 0) => joint.axis = direction(axis)?,
            _ => continue,
        }
        if let Some(dynamics) = axis.child("dynamics") {
            let get = |name: &str| -> Result<f64, Diagnostic> {
                let Some(child) = dynamics.child(name) else { return Ok(0.0) };
                Ok(child.text_numbers()?.first().copied().unwrap_or(0.0))
            };
            let (of_axis, friction) = (get("damping")?, get("friction")?);
            if of_axis < 0.0 || friction < 0.0 {
                dynamics.change_with_warning("negative damping or friction is left out: it would add energy", findings);
            }
            damping.push(of_axis.max(0.0));
            if friction > 0.0 && one {
                joint.friction = vec![friction];
            }
            let (stiffness, rest) = (get("spring_stiffness")?, get("spring_reference")?);
            if stiffness > 0.0 && one {
                joint.spring = Some([stiffness, rest]);
            }
        }
        if let Some(limit) = axis.child("limit") {
            limits(limit, joint, one, findings)?;
        }
    }
    if damping.iter().any(|d| *d > 0.0) {
        let n = joint.kind.dofs();
        joint.damping = if joint.kind == JointKind::Ball { vec![damping[0]; n] } else { damping };
        if joint.damping.len() != n {
            joint.damping.resize(n, 0.0);
        }
    }
    Ok(())
}

fn limits(limit: Element<'_>, joint: &mut Joint, one: bool, findings: &mut Findings) -> Result<(), Diagnostic> {
    let get = |name: &str, none: f64| -> Result<f64, Diagnostic> {
        let Some(child) = limit.child(name) else { return Ok(none) };
        let text = child.text();
        let x: f64 = text.parse().map_err(|_| child.error(format!("`{text}` is not a number")))?;
        Ok(if x.abs() >= 1e16 { x.signum() * f64::INFINITY } else { x })
    };
    let (lower, upper) = (get("lower", f64::NEG_INFINITY)?, get("upper", f64::INFINITY)?);
    let (effort, velocity) = (get("effort", -1.0)?, get("velocity", -1.0)?);
    if !one {
        limit.change("limits of a joint that has not one degree of freedom are left out");
        return Ok(());
    }
    joint.effort = Some(effort).filter(|x| x.is_finite() && *x > 0.0);
    joint.speed = Some(velocity).filter(|x| x.is_finite() && *x > 0.0);
    if lower.is_nan() || upper.is_nan() || (lower >= upper) {
        let words = format!("limits from {lower} to {upper} leave no room: the joint moves without them");
        limit.change_with_warning(&words, findings);
    } else if lower.is_finite() || upper.is_finite() {
        joint.limits = Some([lower, upper]);
    }
    Ok(())
}

/// A gearbox as a gear: θ₂ = −ratio·θ₁ of the angles from the reference body to the parent and to the child.
fn gearbox(
    element: Element<'_>,
    prefix: &str,
    robot: &Robot,
    raw: &Raw<'_>,
    places: &Places,
) -> Result<Gear, Diagnostic> {
    let name = element.attribute("name").unwrap_or("gearbox");
    let ends = [find(element, "parent", prefix, raw)?, find(element, "child", prefix, raw)?];
    let reference = find(element, "gearbox_reference_body", prefix, raw)?;
    let given = element.child("gearbox_ratio").map(|r| r.text_numbers()).transpose()?;
    let ratio = given.and_then(|r| r.first().copied()).unwrap_or(1.0);
    let x_wg = places.of(&format!("{prefix}{name}"));
    let mut found = Vec::new();
    for (end, key) in ends.into_iter().zip(["axis", "axis2"]) {
        let joint = robot
            .joints
            .iter()
            .position(|j| Some(j.child) == end && j.parent == reference && j.kind == JointKind::Revolute);
        let xyz = element.child(key).and_then(|axis| axis.child("xyz"));
        let axis = xyz.map(|x| x.text_numbers()).transpose()?.and_then(|n| <[f64; 3]>::try_from(n).ok());
        let (Some(joint), Some(axis)) = (joint, axis) else {
            return Err(
                element.error(format!("gearbox `{name}` is left out: its bodies do not turn on the reference body"))
            );
        };
        let x_wp = reference.map_or_else(sincro_dynamics::spatial::Pose::identity, |p| places.of(&raw.links[p].1));
        let own = x_wp.compose(&robot.joints[joint].pose.pose()).rot.mul_vec(Vec3(robot.joints[joint].axis));
        let given = x_wg.rot.mul_vec(Vec3(axis));
        let along = given.dot(own) / (given.norm() * own.norm());
        if along.is_nan() || along.abs() < 0.999 {
            return Err(
                element.error(format!("gearbox `{name}` is left out: its axes are not those of the joints it couples"))
            );
        }
        found.push((joint, along.signum()));
    }
    let (first, second) = (found[0], found[1]);
    let ratio = -ratio * first.1 * second.1;
    Ok(Gear {
        name: name.to_owned(),
        at: element.location(),
        joints: [first.0, second.0],
        ratio,
        offset: 0.0,
        higher: [0.0; 3],
    })
}

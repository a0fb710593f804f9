//! Joints, their limits and dynamics, and joints that mimic others.

use std::collections::BTreeMap;

use sincro_dynamics::spatial::{Mat3, Pose, Vec3};
use sincro_scene::diagnostic::Diagnostic;

use super::origin;
use crate::findings::Findings;
use crate::robot::{Gear, Joint, JointKind, Placement, Robot};
use crate::source::Element;

/// A limit this far away is none `[m]`, `[rad]`: prismatic joints of URDF must have limits.
const FAR: f64 = 1e9;

/// Reads all joints of the robot.
pub(super) fn joints(root: Element<'_>, links: &BTreeMap<&str, usize>, robot: &mut Robot, findings: &mut Findings) {
    let mut names = BTreeMap::new();
    let mut mimics = Vec::new();
    for element in root.children("joint") {
        let read = joint(element, links, robot, findings);
        let Some(joint) = findings.take(read) else { continue };
        if let Some(other) = robot.joint_of(joint.child) {
            let (child, other) = (&robot.links[joint.child].name, &robot.joints[other].name);
            let message = format!("link `{child}` is the child of joint `{other}` too");
            findings.error(element.error(message).with_help("URDF robots are trees; SDF and MJCF have loops"));
            continue;
        }
        if names.insert(joint.name.clone(), robot.joints.len()).is_some() {
            findings.error(element.error(format!("there are two joints `{}`", joint.name)).with_help("rename one"));
            continue;
        }
        if let Some(mimic) = element.child("mimic") {
            mimics.push((mimic, robot.joints.len()));
        }
        robot.joints.push(joint);
    }
    for (element, second) in mimics {
        let gear = mimic(element, second, &names, robot);
        robot.gears.extend(findings.take(gear).flatten());
    }
}

fn joint(
    element: Element<'_>,
    links: &BTreeMap<&str, usize>,
    robot: &mut Robot,
    findings: &mut Findings,
) -> Result<Joint, Diagnostic> {
    let name = element.attribute("name").ok_or_else(|| element.error("a joint without `name`"))?;
    let word = element.attribute("type").ok_or_else(|| element.error(format!("joint `{name}` has no `type`")))?;
    let end = |which: &str| -> Result<usize, Diagnostic> {
        let end = element.child(which).ok_or_else(|| element.error(format!("joint `{name}` has no `{which}`")))?;
        let link = end.attribute("link").ok_or_else(|| end.error(format!("`{which}` has no `link`")))?;
        let found = links.get(link.trim()).copied();
        found.ok_or_else(|| end.error(format!("joint `{name}`: there is no link `{link}`")))
    };
    let (parent, child) = (end("parent")?, end("child")?);
    if parent == child {
        return Err(element.error(format!("joint `{name}` connects a link with itself")));
    }
    let kind = match word {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "fixed" => JointKind::Fixed,
        "floating" => JointKind::Free,
        "planar" => JointKind::Planar,
        "spherical" | "ball" => JointKind::Ball,
        other => {
            let help = "revolute, continuous, prismatic, fixed, floating or planar";
            return Err(element.error(format!("joint `{name}`: `{other}` is no kind of joint")).with_help(help));
        }
    };
    let mut joint = Joint {
        pose: origin(element)?,
        axis: axis(element, kind, name)?,
        ..Joint::new(name, element.id(), kind, Some(parent), child)
    };
    if kind == JointKind::Planar {
        lay_plane(&mut joint, robot);
    }
    dynamics(element, &mut joint, findings)?;
    limits(element, word, &mut joint, findings)?;
    Ok(joint)
}

fn axis(element: Element<'_>, kind: JointKind, name: &str) -> Result<[f64; 3], Diagnostic> {
    let x = [1.0, 0.0, 0.0];
    let Some(given) = element.child("axis") else { return Ok(x) };
    if matches!(kind, JointKind::Fixed | JointKind::Free | JointKind::Ball) {
        given.attribute("xyz");
        given.drop("a joint of this kind has no axis");
        return Ok(x);
    }
    let axis = given.vector("xyz")?.unwrap_or(x);
    if axis == [0.0; 3] {
        return Err(given.error(format!("the axis of joint `{name}` is zero")).with_help("give a direction"));
    }
    Ok(axis)
}

/// Turns the frame of a planar joint so that its z axis is the normal, and the child back.
fn lay_plane(joint: &mut Joint, robot: &mut Robot) {
    let axis = Vec3(joint.axis);
    let z = axis.scale(1.0 / axis.norm());
    if z.0 == [0.0, 0.0, 1.0] {
        return;
    }
    let helper = if z[0].abs() < 0.9 { Vec3([1.0, 0.0, 0.0]) } else { Vec3([0.0, 1.0, 0.0]) };
    let x = helper - z.scale(z.dot(helper));
    let x = x.scale(1.0 / x.norm());
    let y = z.cross(x);
    let turn = Pose { rot: Mat3([x.0, y.0, z.0]).transpose(), pos: Vec3::zero() };
    joint.pose = Placement::of_pose(&joint.pose.pose().compose(&turn));
    robot.links[joint.child].pose = Placement::of_pose(&turn.inverse());
}

fn dynamics(element: Element<'_>, joint: &mut Joint, findings: &mut Findings) -> Result<(), Diagnostic> {
    let Some(given) = element.child("dynamics") else { return Ok(()) };
    let (damping, friction) = (given.number("damping")?, given.number("friction")?);
    let armature = given.number("armature")?;
    let n = joint.kind.dofs();
    for (key, value, list) in [
        ("damping", damping, &mut joint.damping),
        ("friction", friction, &mut joint.friction),
        ("armature", armature, &mut joint.armature),
    ] {
        match value {
            Some(value) if value < 0.0 => {
                given.change_with_warning(&format!("negative {key} {value} is left out: it would add energy"), findings)
            }
            Some(value) if value > 0.0 && n == 1 => *list = vec![value],
            Some(value) if value > 0.0 => {
                given.change(&format!("{key} of a joint with {n} degrees of freedom is left out"))
            }
            _ => {}
        }
    }
    Ok(())
}

fn limits(element: Element<'_>, word: &str, joint: &mut Joint, findings: &mut Findings) -> Result<(), Diagnostic> {
    let Some(given) = element.child("limit") else { return Ok(()) };
    let (lower, upper) = (given.number_or_infinite("lower")?, given.number_or_infinite("upper")?);
    joint.effort = given.number_or_infinite("effort")?.filter(|x| x.is_finite());
    if joint.effort == Some(0.0) && joint.kind != JointKind::Fixed {
        given.change("an effort of 0 is taken as none given: the motor has no limit");
    }
    joint.speed = given.number_or_infinite("velocity")?.filter(|x| x.is_finite() && *x > 0.0);
    if word == "continuous" {
        if lower.is_some() || upper.is_some() {
            given.change("a continuous joint has no limits of position");
        }
        return Ok(());
    }
    if joint.kind.dofs() != 1 {
        given.change("limits of a joint that has not one degree of freedom are left out");
        (joint.effort, joint.speed) = (None, None);
        return Ok(());
    }
    match (lower, upper) {
        (None, None) => {}
        (lower, upper) => {
            let (lower, upper) = (lower.unwrap_or(0.0), upper.unwrap_or(0.0));
            if lower <= -FAR && upper >= FAR {
                given.change("limits that nothing reaches are none");
            } else if lower < upper {
                joint.limits = Some([lower, upper]);
            } else {
                let words = format!("limits from {lower} to {upper} leave no room: the joint moves without them");
                given.change_with_warning(&words, findings);
            }
        }
    }
    Ok(())
}

fn mimic(
    element: Element<'_>,
    second: usize,
    names: &BTreeMap<String, usize>,
    robot: &Robot,
) -> Result<Option<Gear>, Diagnostic> {
    let joint = &robot.joints[second];
    let of = element.attribute("joint").ok_or_else(|| element.error("`mimic` has no `joint`"))?;
    let (ratio, offset) = (element.number("multiplier")?.unwrap_or(1.0), element.number("offset")?.unwrap_or(0.0));
    let Some(&first) = names.get(of) else {
        return Err(element.error(format!("joint `{}` mimics `{of}`, which is no joint", joint.name)));
    };
    let one = |k: usize| robot.joints[k].kind.dofs() == 1;
    if first == second || !one(first) || !one(second) {
        element.drop("it takes two joints with one degree of freedom each");
        return Ok(None);
    }
    element.change("a gear between the two joints: a [[coupling]]");
    let name = format!("{}-follows", joint.name);
    Ok(Some(Gear { name, at: element.location(), joints: [first, second], ratio, offset, higher: [0.0; 3] }))
}

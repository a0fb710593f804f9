//! Reader of the Unified Robot Description Format.
//!
//! Source: key `urdf-xml`. A link's frame is its joint's frame; the root link is fixed in the world unless the
//! importer is asked for a free base. The format knows neither motors nor contact laws: the writer chooses them and the
//! report says so.

mod geometry;
mod joint;

use std::collections::BTreeMap;

use sincro_scene::diagnostic::Diagnostic;

use crate::findings::Findings;
use crate::robot::{Inertial, Link, Placement, Robot, Sensor, SensorKind, SurfaceLaw, turned_inertia};
use crate::source::Element;

/// Reason why an element or attribute is not read.
pub(crate) fn reason(path: &[&str]) -> Option<&'static str> {
    let gazebo = "extension for Gazebo: plugins and materials of another simulator";
    match path {
        [_, "gazebo", ..] => Some(gazebo),
        [_, "transmission", .., "mechanicalReduction" | "motorTorqueConstant"] => {
            Some("the joint is driven directly: limits and torques are those of the joint")
        }
        [_, "transmission", ..] => Some("settings of ros_control"),
        [_, "ros2_control", ..] => Some("settings of ros2_control: hardware and its interfaces"),
        [.., "safety_controller"] => Some("soft limits of a controller, no property of the joint"),
        [.., "calibration"] => Some("calibration of an encoder, no property of the joint"),
        [.., "texture"] => Some("bodies have a colour each, no textures"),
        [.., "collision", "material"] => Some("what touches is not shown"),
        [.., "verbose"] => Some("no property of the robot"),
        [.., "self_filter"] => Some("settings of a perception program"),
        [.., "link", "@type"] | [.., "joint", "@dont_collapse"] => Some("hint for another program"),
        [_, "link", "contact", ..] => Some("contact law of another simulator's integrator"),
        [.., "robot", "@version"] => Some("version of the format"),
        _ => None,
    }
}

/// Reads a robot; everything wrong is noted.
pub(crate) fn read(root: Element<'_>, findings: &mut Findings) -> Robot {
    let mut robot = Robot { name: root.attribute("name").unwrap_or("robot").to_owned(), ..Robot::default() };
    root.attribute("version");
    let colors = geometry::materials(root, findings);
    let mut index = BTreeMap::new();
    for element in root.children("link") {
        let Some(name) = element.attribute("name") else {
            findings.error(element.error("a link without `name`").with_help("give it a name"));
            continue;
        };
        if index.insert(name, robot.links.len()).is_some() {
            findings.error(element.error(format!("there are two links `{name}`")).with_help("rename one of them"));
            continue;
        }
        robot.links.push(link(element, name, &colors, findings));
    }
    if robot.links.is_empty() {
        findings.error(root.error("the robot has no link").with_help("a URDF robot has one link at least"));
        return robot;
    }
    joint::joints(root, &index, &mut robot, findings);
    for element in root.children("sensor") {
        sensor(element, &index, &mut robot);
    }
    for element in root.children("gazebo") {
        friction_of_gazebo(element, &index, &mut robot, findings);
    }
    check_tree(&robot, findings);
    robot
}

/// Friction that an extension for Gazebo gives the surfaces of a link: the coefficient along its first direction.
fn friction_of_gazebo(element: Element<'_>, index: &BTreeMap<&str, usize>, robot: &mut Robot, findings: &mut Findings) {
    let link = element.attribute("reference").and_then(|name| index.get(name.trim()));
    let given = ["mu1", "mu"].into_iter().find_map(|name| element.child(name));
    let (Some(link), Some(given)) = (link, given) else {
        element.drop("extension for Gazebo: plugins and materials of another simulator");
        return;
    };
    // older files have it as an attribute
    let text = |element: Element<'_>| element.attribute("value").unwrap_or_else(|| element.text()).trim().to_owned();
    let number = |element: Element<'_>| text(element).parse::<f64>().ok().filter(|x| *x >= 0.0 && x.is_finite());
    let Some(friction) = number(given) else {
        let message = format!("`{}` is no coefficient of friction: it is left out", text(given));
        findings.warn(given.error(message).with_help("give a number of at least 0"));
        given.drop("no coefficient of friction");
        return;
    };
    if robot.links[*link].collisions.is_empty() {
        return element.drop("an extension for Gazebo on a link without shapes that touch");
    }
    element.change("an extension for Gazebo, of which the friction of the link's surfaces is taken");
    if let Some(other) = element.child("mu2").filter(|other| number(*other) != Some(friction)) {
        other.change("friction is the same in all directions here: that along the first one");
    }
    for collision in &mut robot.links[*link].collisions {
        collision.surface = Some(SurfaceLaw { friction, spinning_friction: 0.0, rolling_friction: 0.0 });
    }
}

fn link(element: Element<'_>, name: &str, colors: &geometry::Colors, findings: &mut Findings) -> Link {
    let inertial = element.child("inertial").and_then(|inertial| {
        let read = inertial_of(inertial);
        findings.take(read).flatten()
    });
    let pieces = |kind: &str, findings: &mut Findings| {
        element.children(kind).into_iter().filter_map(|e| geometry::piece(e, colors, findings)).collect::<Vec<_>>()
    };
    let visuals = pieces("visual", findings);
    let collisions = pieces("collision", findings);
    Link {
        name: name.to_owned(),
        at: element.location(),
        pose: Placement::default(),
        inertial,
        visuals,
        collisions,
        is_virtual: false,
        group: None,
    }
}

fn inertial_of(element: Element<'_>) -> Result<Option<Inertial>, Diagnostic> {
    let origin = origin(element)?;
    let mass = match element.child("mass") {
        Some(mass) => mass.number("value")?.ok_or_else(|| mass.error("`mass` has no `value`"))?,
        None => return Err(element.error("`inertial` has no `mass`").with_help("give `<mass value=\"…\"/>` [kg]")),
    };
    let mut inertia = [0.0; 6];
    if let Some(given) = element.child("inertia") {
        for (entry, name) in inertia.iter_mut().zip(["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]) {
            *entry = given.number(name)?.unwrap_or(0.0);
        }
    }
    let pose = origin.pose();
    let turned = turned_inertia(&pose.rot, inertia);
    if turned != inertia {
        element.change("the inertia matrix is turned into the axes of the link");
    }
    Ok(Some(Inertial { mass, center_of_mass: origin.position, inertia: turned }))
}

/// Placement of `origin`; none given is the identity.
pub(super) fn origin(element: Element<'_>) -> Result<Placement, Diagnostic> {
    let Some(origin) = element.child("origin") else { return Ok(Placement::default()) };
    let position = origin.vector("xyz")?.unwrap_or_default();
    let rpy = origin.vector("rpy")?.unwrap_or_default();
    Ok(Placement::new(position, rpy))
}

/// Force sensors on joints and the like; the scene has sensors on bodies.
fn sensor(element: Element<'_>, index: &BTreeMap<&str, usize>, robot: &mut Robot) {
    let name = element.attribute("name").unwrap_or("sensor").to_owned();
    let on_link = element.child("parent").and_then(|parent| parent.attribute("link")).and_then(|link| index.get(link));
    let kind = match element.attribute("type") {
        Some("imu") => Some(SensorKind::Imu),
        Some("contact") => Some(SensorKind::Contact),
        _ => None,
    };
    let pose = origin(element);
    match (on_link, kind, pose) {
        (Some(link), Some(kind), Ok(pose)) => {
            robot.sensors.push(Sensor { name, at: element.location(), link: *link, pose, kind });
        }
        _ => element.drop(
            "no sensor of the scene stands for it; `/joint.motor_torque` and `/body.contact_force` can be recorded",
        ),
    }
}

/// One root, and nothing that hangs on itself.
fn check_tree(robot: &Robot, findings: &mut Findings) {
    let roots: Vec<usize> = (0..robot.links.len()).filter(|k| robot.joint_of(*k).is_none()).collect();
    match roots[..] {
        [] => findings.error(
            Diagnostic::error(&robot.links[0].at, "every link is the child of a joint: the joints form a circle")
                .with_help("URDF robots are trees with one root link"),
        ),
        [root] => {
            let mut reached = vec![false; robot.links.len()];
            let mut stack = vec![root];
            while let Some(link) = stack.pop() {
                reached[link] = true;
                stack.extend(robot.joints.iter().filter(|j| j.parent == Some(link)).map(|j| j.child));
            }
            for (link, _) in robot.links.iter().zip(&reached).filter(|(_, reached)| !**reached) {
                findings.error(
                    Diagnostic::error(&link.at, format!("link `{}` hangs on itself by its joints", link.name))
                        .with_help("its parents must lead to the root link"),
                );
            }
        }
        [first, ..] => {
            for other in &roots[1..] {
                let (first, other) = (&robot.links[first], &robot.links[*other]);
                let message = format!("link `{}` is no child of any joint, as `{}` is not", other.name, first.name);
                findings.error(Diagnostic::error(&other.at, message).with_help("connect it by a joint, or remove it"));
            }
        }
    }
}

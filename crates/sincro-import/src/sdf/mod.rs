//! Reader of the Simulation Description Format.
//!
//! Source: key `sdformat`. Poses are resolved along `relative_to`, `attached_to` and nested models; a link that is the
//! child of a second joint closes a loop. A model moves freely unless it is static or a joint holds it to the world.

mod frames;
mod joint;
mod link;

use sincro_dynamics::spatial::Pose;
use sincro_scene::diagnostic::Diagnostic;

use crate::findings::Findings;
use crate::robot::{Joint, JointKind, Placement, Robot};
use crate::source::Element;
use frames::Frames;

/// Deepest nesting of models.
const MAX_NESTING: usize = 32;

/// Reason why an element or attribute is not read.
pub(crate) fn reason(path: &[&str]) -> Option<&'static str> {
    match path {
        [.., "plugin"] => Some("a plugin is a program of another simulator"),
        _ if path.contains(&"surface") => Some("contact law of another simulator's integrator"),
        [.., "physics" | "scene" | "gui" | "audio" | "atmosphere" | "wind"] => Some("setting of another simulator"),
        [.., "light" | "actor" | "road" | "population"] => Some("scenery of another simulator"),
        [.., "include"] => Some("files of a model database are not fetched: put the model into this file"),
        [.., "material", _] => Some("bodies have a diffuse colour each"),
        _ if path.contains(&"sensor") => Some("the sensor here has no such setting"),
        [.., "sdf", "@version"] | [.., "enable_wind" | "allow_auto_disable" | "velocity_decay"] => {
            Some("setting of another simulator")
        }
        [.., "pose", "@frame"] => Some("an empty frame of an old version"),
        _ => None,
    }
}

/// Reads the models of a file as one robot.
pub(crate) fn read(root: Element<'_>, findings: &mut Findings) -> Robot {
    let mut robot = Robot::default();
    let version = root.attribute("version").unwrap_or("1.6");
    let old = matches!(version, "1.0" | "1.2" | "1.3" | "1.4" | "1.5" | "1.6");
    let world = root.child("world");
    if let Some(world) = world {
        robot.name = world.attribute("name").unwrap_or("world").to_owned();
        if let Some(gravity) = world.child("gravity") {
            robot.gravity = findings.take(gravity.text_numbers()).and_then(|g| g.try_into().ok());
        }
    }
    let models: Vec<Element<'_>> =
        root.children("model").into_iter().chain(world.map(|w| w.children("model")).into_iter().flatten()).collect();
    if models.is_empty() {
        findings
            .error(root.error("there is no model in it").with_help("an SDF file has a `model`, in a `world` or not"));
        return robot;
    }
    for element in [Some(root), world].into_iter().flatten().chain(models.iter().copied()) {
        warn_of_includes(element, findings);
    }
    let several = models.len() > 1;
    let mut raw = Raw::default();
    for element in models {
        let name = element.attribute("name").unwrap_or("model").to_owned();
        if robot.name.is_empty() {
            robot.name.clone_from(&name);
        }
        let prefix = if several { format!("{name}::") } else { String::new() };
        findings.take(raw.frames.add(&format!("{prefix}__model__"), element, "", ""));
        model(element, &prefix, &mut robot, &mut raw, findings, 0);
    }
    let places = raw.frames.resolve(findings);
    link::place(&mut robot, &raw, &places);
    let settings = joint::Settings { old };
    joint::joints(&mut robot, &raw, &places, &settings, findings);
    free_roots(&mut robot, &raw, &places);
    link::sensors(&mut robot, &raw, findings);
    robot.may_overlap = robot.self_contact;
    robot
}

/// Elements of links and joints of all models, before their places are known.
#[derive(Default)]
struct Raw<'d> {
    frames: Frames,
    /// Element and full name of each link of the robot.
    links: Vec<(Element<'d>, String)>,
    /// Element, prefix of names, and frame of the model of each joint.
    joints: Vec<(Element<'d>, String, String)>,
    /// Links of static models.
    held: Vec<bool>,
}

/// A model whose own frame is known; names in it begin with `prefix`.
fn model<'d>(
    element: Element<'d>,
    prefix: &str,
    robot: &mut Robot,
    raw: &mut Raw<'d>,
    findings: &mut Findings,
    depth: usize,
) {
    if depth > MAX_NESTING {
        return findings.error(element.error(format!("models are nested more than {MAX_NESTING} deep")));
    }
    let own_frame = format!("{prefix}__model__");
    if let Some(collide) = element.child("self_collide") {
        robot.self_contact |= matches!(collide.text(), "1" | "true");
    }
    let is_static = element.child("static").is_some_and(|s| matches!(s.text(), "1" | "true"));
    for frame in element.children("frame") {
        frame.change("poses may refer to it; it is no object of the scene");
        let name = frame.attribute("name").unwrap_or("frame");
        let base = frame.attribute("attached_to").filter(|b| !b.is_empty());
        let base = base.map_or_else(|| own_frame.clone(), |b| format!("{prefix}{b}"));
        findings.take(raw.frames.add(&format!("{prefix}{name}"), frame, &base, prefix));
    }
    for link in element.children("link") {
        let Some(name) = link.attribute("name") else {
            findings.error(link.error("a link without `name`"));
            continue;
        };
        let full = format!("{prefix}{name}");
        if raw.links.iter().any(|(_, known)| *known == full) {
            findings.error(link.error(format!("there are two links `{full}`")));
            continue;
        }
        findings.take(raw.frames.add(&full, link, &own_frame, prefix));
        robot.links.push(link::link(link, &full, findings));
        raw.links.push((link, full));
        raw.held.push(is_static);
    }
    for joint in element.children("joint") {
        raw.joints.push((joint, prefix.to_owned(), own_frame.clone()));
        let name = joint.attribute("name").unwrap_or("joint");
        let child = joint.child("child").map_or("", |c| c.text());
        findings.take(raw.frames.add(&format!("{prefix}{name}"), joint, &format!("{prefix}{child}"), prefix));
    }
    for nested in element.children("model") {
        let name = nested.attribute("name").unwrap_or("model");
        let inner = format!("{prefix}{name}::");
        let frame = format!("{inner}__model__");
        findings.take(raw.frames.add(&frame, nested, &own_frame, prefix));
        raw.frames.alias(&format!("{prefix}{name}"), &frame);
        model(nested, &inner, robot, raw, findings, depth + 1);
    }
}

/// Warns of what is included, which is not read, in an element and in the models nested in it.
fn warn_of_includes(element: Element<'_>, findings: &mut Findings) {
    for include in element.children("include") {
        let uri = include.child("uri").map_or("", |uri| uri.text());
        let words = format!("the model `{uri}` that is included here is left out, with all that it carries");
        findings.warn(include.error(words).with_help("put the model into this file"));
    }
    for nested in element.children("model").into_iter().filter(|_| element.name() == "model") {
        warn_of_includes(nested, findings);
    }
}

/// Joints that let models move: SDF models hang on nothing unless they say so.
fn free_roots(robot: &mut Robot, raw: &Raw<'_>, places: &frames::Places) {
    for link in 0..robot.links.len() {
        if robot.joint_of(link).is_some() || raw.held[link] {
            continue;
        }
        let Pose { pos, .. } = places.of(&raw.links[link].1);
        let pose = robot.links[link].pose.pose();
        let mut q = vec![pos[0], pos[1], pos[2], 0.0, 0.0, 0.0, 0.0];
        sincro_dynamics::spatial::Quat::from_matrix(&pose.rot).write(&mut q[3..]);
        robot.links[link].pose = Placement::default();
        robot.joints.push(Joint {
            initial: Some(q),
            ..Joint::new(
                &format!("{}-base", robot.links[link].name),
                raw.links[link].0.id(),
                JointKind::Free,
                None,
                link,
            )
        });
    }
}

/// Placement in a `pose` child: x y z roll pitch yaw, or x y z and a quaternion x y z w.
fn pose_of(element: Element<'_>) -> Result<Option<Placement>, Diagnostic> {
    let Some(pose) = element.child("pose") else { return Ok(None) };
    let n = pose.text_numbers()?;
    let degrees = pose.attribute("degrees").is_some_and(|d| matches!(d, "1" | "true"));
    let quaternion = pose.attribute("rotation_format") == Some("quat_xyzw");
    match n[..] {
        [] => Ok(Some(Placement::default())),
        [x, y, z, a, b, c, d] if quaternion => {
            if a * a + b * b + c * c + d * d < 1e-12 {
                return Err(pose.error("the quaternion has no direction"));
            }
            Ok(Some(Placement { position: [x, y, z], rotation: crate::robot::Rotation::Quaternion([d, a, b, c]) }))
        }
        [x, y, z, a, b, c] => {
            let rpy = if degrees { [a, b, c].map(f64::to_radians) } else { [a, b, c] };
            Ok(Some(Placement::new([x, y, z], rpy)))
        }
        _ => Err(pose.error(format!("`pose` has {} numbers, expected six", n.len()))),
    }
}

//! Bodies, their joints and sites.

use sincro_dynamics::spatial::Quat;
use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::inertia::bounded;
use super::orientation::{placement, rotation};
use super::record::Range;
use crate::findings::Findings;
use crate::path_mass::tendon_mass;
use crate::robot::{
    Inertial, Joint, JointKind, Link, Optics, Placement, Robot, Sensor, SensorKind, TendonPath, turned_inertia,
};
use crate::source::Element;

/// Deepest nesting of bodies.
const MAX_DEPTH: usize = 200;

/// Place of a body while it is read.
#[derive(Clone, Copy)]
struct Parent {
    /// Link that carries it; none for the world.
    link: Option<usize>,
    depth: usize,
}

impl<'d> Reader<'d> {
    /// The world body: its geoms are fixed.
    pub(super) fn world(&mut self, world: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        let class = world.attribute("childclass").unwrap_or("main").to_owned();
        let mut link = empty_link("world", world);
        let children = self.parts(world, Placement::default(), &class, findings);
        for (child, frame, class) in &children {
            match child.name() {
                "geom" => drop(self.geom(*child, *frame, class, (&mut link, false), findings)),
                "site" | "body" => {}
                _ => {}
            }
        }
        let has_sites = children.iter().any(|(c, ..)| match c.name() {
            "site" => c.peek("name").is_some(),
            name => name == "camera",
        });
        if !link.collisions.is_empty() || !link.visuals.is_empty() || has_sites {
            self.tidy(&mut link);
            robot.links.push(link);
            let index = robot.links.len() - 1;
            self.add_sites(&children, index, robot, findings);
            self.add_cameras(&children, index, robot, findings);
        }
        let parent = Parent { link: None, depth: 0 };
        for (child, frame, class) in children {
            if child.name() == "body" {
                self.body(child, frame, &class, parent, robot, findings);
            }
        }
    }

    /// Children with those of `frame` elements in place, each with its frame and class.
    fn parts(
        &self,
        element: Element<'d>,
        at: Placement,
        class: &str,
        findings: &mut Findings,
    ) -> Vec<(Element<'d>, Placement, String)> {
        let mut out = Vec::new();
        // what is still to be looked at, the next one last: elements in their order, with what is in frames
        let mut rest: Vec<_> =
            self.files.elements(element).into_iter().rev().map(|e| (e, at, class.to_owned(), 0)).collect();
        while let Some((child, at, class, depth)) = rest.pop() {
            match child.name() {
                "frame" if depth < MAX_DEPTH => {
                    child.keep();
                    child.attribute("name");
                    let inner = child.attribute("childclass").unwrap_or(&class).to_owned();
                    let Some(own) = findings.take(placement(child, &inner, &self.defaults, &self.angles)) else {
                        continue;
                    };
                    let inside = self.files.elements(child).into_iter().rev();
                    rest.extend(inside.map(|e| (e, at.then(&own), inner.clone(), depth + 1)));
                }
                "plugin" | "flexcomp" | "composite" | "attach" | "replicate" => {
                    let message = format!("`{}` has no counterpart", child.name());
                    findings.error(child.error(message).with_help("save the compiled model from MuJoCo, or remove it"));
                }
                "body" | "geom" | "joint" | "freejoint" | "inertial" | "site" | "camera" => {
                    child.keep();
                    out.push((child, at, class));
                }
                _ => {}
            }
        }
        out
    }

    fn body(
        &mut self,
        element: Element<'d>,
        frame: Placement,
        class: &str,
        parent: Parent,
        robot: &mut Robot,
        findings: &mut Findings,
    ) {
        if parent.depth > MAX_DEPTH {
            return findings.error(element.error(format!("bodies are nested more than {MAX_DEPTH} deep")));
        }
        let class = element.attribute("childclass").unwrap_or(class).to_owned();
        let name = element.attribute("name").map_or_else(|| format!("body{}", robot.links.len()), str::to_owned);
        let Some(own) = findings.take(placement(element, &class, &self.defaults, &self.angles)) else { return };
        let pose = frame.then(&own);
        if findings.take(element.number("gravcomp")).flatten().is_some_and(|g| g != 0.0) {
            findings.error(element.error("gravity compensation (`gravcomp`) has no counterpart"));
        }
        let mut link = empty_link(&name, element);
        let children = self.parts(element, Placement::default(), &class, findings);
        let is_given = children.iter().any(|(child, ..)| child.name() == "inertial");
        let gives_mass = self.settings.inertia_from_geoms.unwrap_or(!is_given);
        let mut inertial = None;
        let mut masses = Vec::new();
        for (child, at, class) in &children {
            match child.name() {
                "inertial" => inertial = findings.take(self.inertial(*child)),
                "geom" => masses.extend(self.geom(*child, *at, class, (&mut link, gives_mass), findings)),
                _ => {}
            }
        }
        let from_geoms = match self.settings.inertia_from_geoms {
            // a body without geoms that give mass keeps what it is given
            Some(true) => inertial.is_none() || !masses.is_empty(),
            Some(false) => false,
            None => inertial.is_none(),
        };
        link.inertial = if from_geoms { super::geom::sum(&masses) } else { inertial };
        if link.inertial.is_none() && self.settings.bound_mass > 0.0 {
            // MuJoCo takes the numbers of its position for the centre of mass, too
            link.inertial = Some(Inertial { mass: 0.0, center_of_mass: own.position, inertia: [0.0; 6] });
            element
                .change("a body without mass: its centre of mass is where its `pos` is in its own frame, as in MuJoCo");
        }
        if let Some(inertial) = &mut link.inertial {
            let settings = &self.settings;
            inertial.mass = inertial.mass.max(settings.bound_mass);
            if settings.bound_inertia > 0.0 || settings.balances_inertia {
                inertial.inertia = bounded(inertial.inertia, settings.bound_inertia, settings.balances_inertia);
            }
        }
        self.tidy(&mut link);
        let is_mocap = element.attribute("mocap") == Some("true");
        if is_mocap {
            element.change("a mocap body: fixed in the world, where a client may move it");
        }
        let joints: Vec<_> = children.iter().filter(|(c, ..)| matches!(c.name(), "joint" | "freejoint")).collect();
        let index = self.chain(element, &joints, (pose, parent.link), link, robot, findings);
        self.bodies.insert(name, index);
        self.positions.insert(index, own.position);
        if is_mocap {
            self.mocap.insert(index);
        }
        self.add_sites(&children, index, robot, findings);
        self.add_cameras(&children, index, robot, findings);
        let inner = Parent { link: Some(index), depth: parent.depth + 1 };
        for (child, at, class) in &children {
            if child.name() == "body" {
                self.body(*child, *at, class, inner, robot, findings);
            }
        }
    }

    /// Adds a link with its joints as a chain, its frame in the link that carries it; several joints of a body have
    /// links without mass between them.
    fn chain(
        &mut self,
        element: Element<'d>,
        joints: &[&(Element<'d>, Placement, String)],
        (pose, carrier): (Placement, Option<usize>),
        mut link: Link,
        robot: &mut Robot,
        findings: &mut Findings,
    ) -> usize {
        let name = link.name.clone();
        let mut made = Vec::new();
        for (k, (joint, at, class)) in joints.iter().map(|j| (j.0, j.1, &j.2)).enumerate() {
            let wanted = joint.attribute("name");
            let named = wanted.map_or_else(
                || if joints.len() == 1 { format!("{name}-joint") } else { format!("{name}-joint{}", k + 1) },
                str::to_owned,
            );
            if let Some(joint) = findings.take(self.joint(joint, at, &named, class)) {
                made.push((joint, wanted.map(str::to_owned)));
            }
        }
        if made.is_empty() {
            link.pose = pose;
            let Some(carrier) = carrier else {
                robot.links.push(link);
                return robot.links.len() - 1;
            };
            let id = element.id();
            link.pose = Placement::default();
            robot.links.push(link);
            let index = robot.links.len() - 1;
            robot.joints.push(Joint {
                pose,
                ..Joint::new(&format!("{name}-fixed"), id, JointKind::Fixed, Some(carrier), index)
            });
            self.references.push(0.0);
            self.rests.push(0.0);
            return index;
        }
        if made.len() > 1 {
            element.change(&format!("its {} joints are a chain", made.len()));
        }
        let (mut carrier, n) = (carrier, made.len());
        let mut before = [0.0; 3];
        for (k, (made, wanted)) in made.into_iter().enumerate() {
            let JointRead { mut joint, position, reference, rest, range, tuned } = made;
            let last = k + 1 == n;
            let step: [f64; 3] = std::array::from_fn(|c| position[c] - before[c]);
            joint.pose =
                if k == 0 { pose.then(&Placement::new(position, [0.0; 3])) } else { Placement::new(step, [0.0; 3]) };
            if joint.kind == JointKind::Free {
                // where it stands is its coordinate
                let x = pose.pose();
                let mut q = vec![x.pos[0], x.pos[1], x.pos[2], 1.0, 0.0, 0.0, 0.0];
                Quat::from_matrix(&x.rot).write(&mut q[3..]);
                (joint.pose, joint.initial) = (Placement::default(), Some(q));
            }
            let next = if last {
                link.pose = Placement::new(position.map(|x| 0.0 - x), [0.0; 3]);
                link.clone()
            } else {
                Link { is_virtual: true, ..empty_link(&format!("{name}-{}", k + 1), element) }
            };
            robot.links.push(next);
            joint.parent = carrier;
            joint.child = robot.links.len() - 1;
            carrier = Some(joint.child);
            if let Some(wanted) = wanted {
                self.joints.insert(wanted, robot.joints.len());
            }
            self.order.push(robot.joints.len());
            self.references.push(reference);
            self.rests.push(rest);
            self.ranges.extend(range.map(|range| (robot.joints.len(), range)));
            self.tuned.extend(tuned.map(|tuned| (robot.joints.len(), tuned)));
            robot.joints.push(joint);
            before = position;
        }
        robot.links.len() - 1
    }

    fn joint(&self, e: Element<'d>, frame: Placement, name: &str, class: &str) -> Result<JointRead<'d>, Diagnostic> {
        let d = &self.defaults;
        let free = e.name() == "freejoint";
        let kind = match if free { Some("free") } else { d.text(e, class, "type") } {
            None | Some("hinge") => JointKind::Revolute,
            Some("slide") => JointKind::Prismatic,
            Some("ball") => JointKind::Ball,
            Some("free") => JointKind::Free,
            Some(other) => return Err(e.error(format!("joint `{name}`: `{other}` is no kind of joint"))),
        };
        e.attribute("group");
        let mut joint = Joint::new(name, e.id(), kind, None, 0);
        let x = frame.pose();
        let mut position = d.vector(e, class, "pos")?.unwrap_or_default();
        let mut axis = d.vector(e, class, "axis")?.unwrap_or([0.0, 0.0, 1.0]);
        if !frame.is_identity() {
            position = x.point(sincro_dynamics::spatial::Vec3(position)).0;
            axis = x.rot.mul_vec(sincro_dynamics::spatial::Vec3(axis)).0;
        }
        if kind == JointKind::Free {
            position = [0.0; 3];
        }
        if axis == [0.0; 3] && kind.dofs() == 1 {
            return Err(e.error(format!("the axis of joint `{name}` is zero")));
        }
        joint.axis = axis;
        if free {
            return Ok(JointRead { joint, position, reference: 0.0, rest: 0.0, range: None, tuned: None });
        }
        let angle = |x: f64| if kind == JointKind::Revolute { self.angles.radians(x) } else { x };
        let reference = angle(d.number(e, class, "ref")?.unwrap_or(0.0));
        let n = kind.dofs();
        for (key, list) in
            [("damping", &mut joint.damping), ("armature", &mut joint.armature), ("frictionloss", &mut joint.friction)]
        {
            let given = d.numbers(e, class, key)?.unwrap_or_default();
            if given.len() > 1 && given[1..].iter().any(|x| *x != 0.0) {
                return Err(
                    e.error(format!("`{key}` of joint `{name}` depends on the rate: a polynomial has no counterpart"))
                );
            }
            match given.first() {
                Some(x) if *x > 0.0 && (n == 1 || key != "frictionloss") => *list = vec![*x; n],
                Some(x) if *x > 0.0 => e.change(&format!("{key} of a joint with {n} degrees of freedom is left out")),
                _ => {}
            }
        }
        let stiffness = d.number(e, class, "stiffness")?.unwrap_or(0.0);
        let rest = angle(d.number(e, class, "springref")?.unwrap_or(0.0)) - reference;
        if stiffness > 0.0 {
            joint.spring = Some([stiffness, if n == 1 { rest } else { 0.0 }]);
        }
        let tuned = match d.numbers(e, class, "springdamper")?.as_deref() {
            Some(&[time, ratio]) if time > 0.0 && ratio > 0.0 => Some(Tuned { element: e, time, ratio, rest }),
            _ => None,
        };
        let range = self.limits(e, class, &mut joint, reference, &angle)?;
        Ok(JointRead { joint, position, reference, rest, range, tuned })
    }

    /// Gives joints with `springdamper` the stiffness and damping of their inertia at the reference.
    pub(super) fn tune(&self, robot: &mut Robot) {
        for (joint, Tuned { element, time, ratio, rest }) in &self.tuned {
            let inertia = match robot.joints[*joint].kind.dofs() {
                1 => tendon_mass(robot, &TendonPath::Joints(vec![(*joint, 1.0)])),
                _ => None,
            };
            let Some(inertia) = inertia else {
                element.change("its `springdamper` is left out: the joint has not one degree of freedom with inertia");
                continue;
            };
            let stiffness = inertia / (time * time * ratio * ratio);
            robot.joints[*joint].spring = Some([stiffness, *rest]);
            robot.joints[*joint].damping = vec![2.0 * inertia / time];
            let inertia = match robot.joints[*joint] {
                // where nothing turns, MuJoCo 4.0 takes the mass alone
                Joint { kind: JointKind::Prismatic, ref armature, .. } if armature.iter().any(|x| *x > 0.0) => {
                    "inertia of this joint and its armature, which MuJoCo leaves out for bodies of the world that only slide"
                }
                _ => "inertia of this joint",
            };
            element.change(&format!("`springdamper` as the stiffness and damping that it means with the {inertia}"));
        }
    }

    /// Gives a joint its limits; returns its range in the source's coordinates, whether it limits or not.
    fn limits(
        &self,
        e: Element<'d>,
        class: &str,
        joint: &mut Joint,
        reference: f64,
        angle: &dyn Fn(f64) -> f64,
    ) -> Result<Option<[f64; 2]>, Diagnostic> {
        let d = &self.defaults;
        let range = Range::of(d, e, class, ["range", "limited"])?;
        let limiting = match joint.kind {
            JointKind::Free => None,
            _ => self.limiting_range(e, range, "range", "limited")?,
        };
        let force = Range::of(d, e, class, ["actuatorfrcrange", "actuatorfrclimited"])?;
        if let Some([low, high]) = self.limiting_range(e, force, "actuatorfrcrange", "actuatorfrclimited")? {
            joint.effort = Some(low.abs().max(high.abs())).filter(|x| *x > 0.0);
            if low != -high {
                e.change(
                    "`actuatorfrcrange` has two ends that differ: the larger one bounds the torque in both directions",
                );
            }
        }
        match (limiting, range) {
            (Some(ends), _) if joint.kind.dofs() == 1 => joint.limits = Some(ends.map(|x| angle(x) - reference)),
            (None, Range { ends: Some(_), limits: None }) if joint.kind.dofs() == 1 => {
                e.change("its range is empty: the joint moves without limits");
            }
            (Some(_), _) => e.change("limits of a joint that has not one degree of freedom are left out"),
            _ => {}
        }
        // MuJoCo leaves degrees of a range that does not limit as they are, and takes them for radians
        Ok(range.ends.map(|ends| ends.map(|x| if limiting.is_some() { angle(x) } else { x })))
    }

    fn inertial(&self, e: Element<'d>) -> Result<Inertial, Diagnostic> {
        let position = e.vector("pos")?.unwrap_or_default();
        let rotation = rotation(e, "main", &self.defaults, &self.angles)?;
        let mass = e.number("mass")?.ok_or_else(|| e.error("`inertial` has no `mass`"))?;
        let own = match (e.numbers("fullinertia")?.as_deref(), e.vector("diaginertia")?) {
            (Some(&[xx, yy, zz, xy, xz, yz]), _) => [xx, xy, xz, yy, yz, zz],
            (Some(_), _) => return Err(e.error("`fullinertia` has six numbers")),
            (None, Some([xx, yy, zz])) => [xx, 0.0, 0.0, yy, 0.0, zz],
            (None, None) => return Err(e.error("`inertial` has no inertia")),
        };
        let pose = Placement { position, rotation }.pose();
        Ok(Inertial { mass, center_of_mass: position, inertia: turned_inertia(&pose.rot, own) })
    }

    /// Named sites as frames.
    fn add_sites(
        &mut self,
        children: &[(Element<'d>, Placement, String)],
        link: usize,
        robot: &mut Robot,
        findings: &mut Findings,
    ) {
        for (site, at, class) in children.iter().filter(|(c, ..)| c.name() == "site") {
            let Some(name) = site.attribute("name") else {
                site.drop("nothing can refer to it: it has no name");
                continue;
            };
            let Some(own) = findings.take(self.site_placement(*site, class)) else { continue };
            robot.links.push(empty_link(name, *site));
            let child = robot.links.len() - 1;
            robot.joints.push(Joint {
                pose: at.then(&own),
                ..Joint::new(&format!("{name}-site"), site.id(), JointKind::Fixed, Some(link), child)
            });
            self.references.push(0.0);
            self.rests.push(0.0);
            self.sites.insert(name.to_owned(), child);
        }
    }

    /// Cameras that ride on a link; those that follow something stand as they do at the start.
    fn add_cameras(
        &self,
        children: &[(Element<'d>, Placement, String)],
        link: usize,
        robot: &mut Robot,
        findings: &mut Findings,
    ) {
        for (camera, at, class) in children.iter().filter(|(c, ..)| c.name() == "camera") {
            let name = camera.attribute("name").map_or_else(|| format!("camera{}", robot.sensors.len()), str::to_owned);
            let Some((own, optics)) = findings.take(self.camera(*camera, class)) else { continue };
            match self.defaults.text(*camera, class, "mode") {
                None | Some("fixed") => {}
                Some(mode) => camera.change(&format!("it does not follow anything (`{mode}`): it rides on its body")),
            }
            // MuJoCo's looks along −z, with x to the right
            let turned = Placement::new([0.0; 3], [0.0, std::f64::consts::PI, 0.0]);
            let pose = at.then(&own).then(&turned);
            robot.sensors.push(Sensor { name, at: camera.location(), link, pose, kind: SensorKind::Camera(optics) });
        }
    }

    fn camera(&self, camera: Element<'d>, class: &str) -> Result<(Placement, Optics), Diagnostic> {
        let own = placement(camera, class, &self.defaults, &self.angles)?;
        let degrees = self.defaults.number(camera, class, "fovy")?.unwrap_or(45.0);
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(camera.error(format!("`fovy` is {degrees}: a field of view is between 0 and 180 degrees")));
        }
        let side = |x: f64| (x >= 1.0 && x <= f64::from(u16::MAX) && x.fract() == 0.0).then_some(x as u32);
        // one pixel is MuJoCo's way of saying nothing
        let resolution = match self.defaults.numbers(camera, class, "resolution")?.as_deref() {
            None | Some([1.0, 1.0]) => None,
            Some([w, h]) => match (side(*w), side(*h)) {
                (Some(w), Some(h)) => Some([w, h]),
                _ => return Err(camera.error(format!("`resolution` is {w} × {h}: expected two whole numbers"))),
            },
            Some(_) => return Err(camera.error("`resolution` has two numbers")),
        };
        Ok((own, Optics { field_of_view: degrees.to_radians(), resolution, range: None }))
    }

    fn site_placement(&self, site: Element<'d>, class: &str) -> Result<Placement, Diagnostic> {
        match self.defaults.numbers(site, class, "fromto")? {
            Some(ends) => {
                super::geom::between(&ends).map(|(p, _)| p).ok_or_else(|| site.error("`fromto` has six numbers"))
            }
            None => placement(site, class, &self.defaults, &self.angles),
        }
    }

    /// Leaves geometry that touches and shows in one list.
    fn tidy(&self, link: &mut Link) {
        let touching: Vec<_> = link.collisions.iter().map(|c| c.element).collect();
        if link.visuals.iter().all(|v| touching.contains(&v.element)) {
            link.visuals.clear();
        }
    }
}

/// A joint as it is read: its place in the body comes with the chain.
struct JointRead<'d> {
    joint: Joint,
    position: [f64; 3],
    reference: f64,
    /// Coordinate of its springs, zero at the reference.
    rest: f64,
    /// Range in the source's coordinates.
    range: Option<[f64; 2]>,
    tuned: Option<Tuned<'d>>,
}

/// Spring and damper of a joint as time constant and damping ratio, with the inertia at the reference.
pub(super) struct Tuned<'d> {
    element: Element<'d>,
    /// Time constant `[s]`.
    time: f64,
    /// Damping ratio.
    ratio: f64,
    /// Rest coordinate.
    rest: f64,
}

/// A link with nothing on it.
fn empty_link(name: &str, element: Element<'_>) -> Link {
    Link {
        name: name.to_owned(),
        at: element.location(),
        pose: Placement::default(),
        inertial: None,
        visuals: Vec::new(),
        collisions: Vec::new(),
        is_virtual: false,
        group: None,
    }
}

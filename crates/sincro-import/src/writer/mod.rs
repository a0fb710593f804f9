//! The scene folder of a robot: `scene.toml`, `experiment.toml` and the meshes.
//!
//! The text is written for people: objects in the order of the chain, a comment with the place in the source before
//! each body, round numbers round, defaults left out.

mod body;
mod experiment;
mod joint;
mod loops;
mod tendon;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use sincro_scene::diagnostic::Location;

use crate::mesh::{Content, Meshes};
use crate::number::{degrees, list, name, number, quoted};
use crate::policy;
use crate::resolve::Resolver;
use crate::robot::{JointKind, Link, Optics, Placement, Robot, Rotation, SensorKind, Shape};
use crate::source::{ElementStatus, Ledger};
use crate::{Motors, Options};

/// A scene folder in memory.
#[derive(Debug)]
pub(crate) struct Written {
    /// Text of `scene.toml`.
    pub scene: String,
    /// Text of `experiment.toml`.
    pub experiment: String,
    /// Further files.
    pub files: BTreeMap<String, Content>,
    /// Path in the scene of each link; none for what is no object.
    pub link_paths: Vec<Option<String>>,
    /// Choices that the source left open.
    pub choices: Vec<String>,
    /// Collision meshes that are not there, with the reason.
    pub missing_collisions: Vec<String>,
    /// Warnings: place and words.
    pub warnings: Vec<(Location, String)>,
}

/// Settings and collectors of the writer beside the robot.
pub(crate) struct Context<'a> {
    pub options: &'a Options,
    pub resolver: &'a Resolver,
    pub ledger: &'a Ledger,
    /// File of the robot, as it is shown.
    pub file: &'a Path,
    /// Name of the format.
    pub format: &'static str,
}

/// Writes a robot whose links were checked.
pub(crate) fn write(robot: &mut Robot, context: &Context<'_>) -> Written {
    let fixed = policy::fixed_in_world(robot, context.options.free_base);
    body::gather_collisions(robot, &fixed, context);
    let starts = joint::starts(robot, context);
    let mut meshes = Meshes::default();
    meshes.convert(body::mesh_uses(robot, context.resolver).into_iter());
    let mut writer = Writer {
        context,
        text: String::new(),
        meshes,
        floating: robot.floating(context.options),
        groups: groups(robot, &fixed),
        starts,
        link_paths: vec![None; robot.links.len()],
        joint_paths: vec![None; robot.joints.len()],
        tendon_paths: vec![None; robot.tendons.len()],
        taken: BTreeSet::new(),
        written: Written {
            scene: String::new(),
            experiment: String::new(),
            files: BTreeMap::new(),
            link_paths: Vec::new(),
            choices: Vec::new(),
            missing_collisions: Vec::new(),
            warnings: Vec::new(),
        },
        robot,
    };
    writer.scene();
    let experiment = experiment::text(&writer);
    let Writer { text, meshes, link_paths, written, .. } = writer;
    Written { scene: text, experiment, files: meshes.files, link_paths, ..written }
}

/// Text under construction.
struct Writer<'a> {
    context: &'a Context<'a>,
    robot: &'a Robot,
    text: String,
    meshes: Meshes,
    /// For each link, true if it belongs to what moves freely and touches ([`Robot::floating`]).
    floating: Vec<bool>,
    /// Contact group of each link: that of its tree, 0 for what is fixed in the world.
    groups: Vec<usize>,
    /// Coordinates at the start of the joints with one degree of freedom.
    starts: Vec<f64>,
    /// Path of each link that has been written.
    link_paths: Vec<Option<String>>,
    joint_paths: Vec<Option<String>>,
    /// Path of each tendon that has been written.
    tendon_paths: Vec<Option<String>>,
    /// All paths so far.
    taken: BTreeSet<String>,
    written: Written,
}

impl Writer<'_> {
    fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }

    fn scene(&mut self) {
        let file = self.context.file.file_name().map_or_else(|| "robot".into(), |n| n.to_string_lossy().into_owned());
        self.line(&format!(
            "# {}, from {} ({}); import-report.html has what became of each element.",
            one_line(&self.robot.name),
            one_line(&file),
            self.context.format
        ));
        self.line("format = 2");
        self.line("");
        if let Some(gravity) = self.robot.gravity {
            self.line(&format!("gravity = {}", list(&gravity)));
            self.line("");
        }
        if self.robot.may_overlap {
            self.line("allow_overlap = true");
            self.line("");
        }
        self.choices();
        // what stands in the world, in the order of the source
        for link in 0..self.robot.links.len() {
            match self.robot.joint_of(link) {
                None => self.root(link),
                Some(joint) if self.robot.joints[joint].parent.is_none() => self.branch(joint),
                Some(_) => {}
            }
        }
        self.sensors();
        self.forces();
        self.loops();
        self.gears();
        self.tendons();
        self.exclusions();
    }

    /// Pairs that the groups do not keep from touching.
    fn exclusions(&mut self) {
        for pair in &self.robot.excluded {
            let [a, b] = pair.map(|link| self.robot.links[link].group.unwrap_or(self.groups[link]));
            let are_one_group = a == b && a != 0 && !self.robot.self_contact;
            let touch = pair.iter().all(|link| !self.robot.links[*link].collisions.is_empty());
            let [Some(one), Some(two)] = pair.map(|link| self.link_paths[link].clone()) else { continue };
            if !are_one_group && touch && pair[0] != pair[1] {
                self.line("[[contact_pair]]");
                self.line(&format!("between = [{}, {}]", quoted(&one), quoted(&two)));
                self.line("touches = false");
                self.line("");
            }
        }
    }

    fn choices(&mut self) {
        let mut choices = Vec::new();
        let robot = self.robot;
        let has_root = (0..robot.links.len()).any(|k| robot.joint_of(k).is_none());
        if has_root && self.context.format != "MJCF" {
            choices.push(if self.context.options.free_base {
                "the base moves freely (--base free)".to_owned()
            } else if robot.has_free_root() {
                "the base moves freely, as the source says; links without a joint stand in the world".to_owned()
            } else {
                "the base is fixed in the world (--base free lets it move)".to_owned()
            });
        }
        let any_floats = self.floating.contains(&true);
        let planes = |link: &Link| link.collisions.iter().any(|c| matches!(c.shape, Shape::Plane));
        if any_floats && !robot.links.iter().any(planes) {
            choices
                .push("there is no floor: give one as a body with `shape = [{ plane = {} }]` and `contact`".to_owned());
        }
        let moves = robot.joints.iter().any(|j| j.kind.dofs() == 1);
        if !robot.has_own_motors && moves {
            choices.push(
                match self.context.options.motors {
                    Motors::Hold if any_floats => {
                        "motors hold the joints where they start; of what moves freely those with an effort are springs that \
                         reach it at 0.1 rad or 0.01 m, without a limit of speed (--motors torque or none instead)"
                    }
                    Motors::Hold => {
                        "position motors hold the joints where they start (--motors torque or none instead)"
                    }
                    Motors::Torque => "the joints have torque motors, which give no torque unless commanded",
                    Motors::None => "the joints have no motors",
                }
                .to_owned(),
            );
        }
        let touches = robot.links.iter().any(|l| !l.collisions.is_empty());
        if touches && !robot.self_contact {
            choices.push("the bodies of one mechanism do not touch each other: they are in one group".to_owned());
        }
        if touches && robot.links.iter().flat_map(|l| &l.collisions).all(|c| c.surface.is_none()) {
            choices.push(format!("contact has friction {}, which the source does not give", number(body::FRICTION)));
        }
        self.written.choices.extend(choices);
    }

    /// A link that no joint carries.
    fn root(&mut self, link: usize) {
        let mut parent = "/".to_owned();
        if self.context.options.free_base && self.context.format != "MJCF" {
            let path = self.unique("/", "base");
            self.line("[[joint]]");
            self.line(&format!("name = {}", quoted(last(&path))));
            self.line("kind = \"free\"");
            self.line("");
            parent = path;
        }
        let pose = self.robot.links[link].pose;
        self.link(link, &parent, pose, None);
        self.children(link);
    }

    /// The joints that a link carries, in the order of the source.
    fn children(&mut self, link: usize) {
        // depth first with a stack of its own: a long chain is no reason to fall over
        let of = |robot: &Robot, link: usize| -> Vec<usize> {
            (0..robot.joints.len()).rev().filter(|k| robot.joints[*k].parent == Some(link)).collect()
        };
        let mut stack = of(self.robot, link);
        while let Some(joint) = stack.pop() {
            self.joint_and_link(joint);
            stack.extend(of(self.robot, self.robot.joints[joint].child));
        }
    }

    fn branch(&mut self, joint: usize) {
        self.joint_and_link(joint);
        self.children(self.robot.joints[joint].child);
    }

    fn joint_and_link(&mut self, k: usize) {
        let joint = &self.robot.joints[k];
        let parent =
            joint.parent.map_or_else(|| "/".to_owned(), |p| self.link_paths[p].clone().unwrap_or_else(|| "/".into()));
        let own = self.robot.links[joint.child].pose;
        if joint.kind == JointKind::Fixed {
            let pose = joint.pose.then(&own);
            self.context.ledger.judge_place(
                joint.element,
                ElementStatus::Changed,
                "a fixed joint: the place of the body in its parent",
            );
            self.link(joint.child, &parent, pose, Some(k));
            return;
        }
        let path = self.joint(k, &parent);
        self.joint_paths[k] = Some(path.clone());
        self.link(joint.child, &path, own, None);
    }

    /// A path below `parent` that is not taken.
    fn unique(&mut self, parent: &str, wanted: &str) -> String {
        let wanted = name(wanted);
        let base = if parent == "/" { format!("/{wanted}") } else { format!("{parent}/{wanted}") };
        let mut path = base.clone();
        for k in 2.. {
            if self.taken.insert(path.clone()) {
                break;
            }
            path = format!("{base}-{k}");
        }
        path
    }

    /// `position` and rotation, where they are not the default.
    fn placement(&mut self, placement: &Placement) {
        for key in keys(placement) {
            self.line(&key);
        }
    }

    fn sensors(&mut self) {
        for sensor in &self.robot.sensors {
            let Some(parent) = self.link_paths[sensor.link].clone() else { continue };
            let touches = |link: usize| !self.robot.links[link].collisions.is_empty();
            if sensor.kind == SensorKind::Contact && !touches(sensor.link) {
                self.written.warnings.push((
                    sensor.at.clone(),
                    format!("sensor `{}` is left out: nothing can touch its body", sensor.name),
                ));
                continue;
            }
            let path = self.unique(&parent, &sensor.name);
            self.line(if matches!(sensor.kind, SensorKind::Camera(_)) { "[[camera]]" } else { "[[sensor]]" });
            self.line(&format!("name = {}", quoted(last(&path))));
            self.line(&format!("parent = {}", quoted(&parent)));
            self.placement(&sensor.pose);
            match sensor.kind {
                SensorKind::Imu => self.line("imu = {}"),
                SensorKind::Contact => self.line("contact = {}"),
                SensorKind::Camera(optics) => self.optics(&optics),
            }
            self.line("");
        }
    }

    /// Forces that a diagram or a client commands.
    fn forces(&mut self) {
        for force in &self.robot.forces {
            let Some(parent) = self.link_paths[force.link].clone() else { continue };
            let path = self.unique(&parent, &force.name);
            let (push, turn) = (list(&force.wrench[..3]), list(&force.wrench[3..]));
            self.line(&format!("# {}; for a control of 1: force {push} N, torque {turn} N·m", place(&force.at)));
            self.line("[[force]]");
            self.line(&format!("name = {}", quoted(last(&path))));
            self.line(&format!("parent = {}", quoted(&parent)));
            self.line("in_frame = \"body\"");
            self.line("input = true");
            self.line("");
        }
    }

    /// Optics of a camera; one with a resolution takes pictures when it is asked for one.
    fn optics(&mut self, optics: &Optics) {
        self.line(&format!("field_of_view_deg = {}", number(degrees(optics.field_of_view))));
        let Some([columns, rows]) = optics.resolution else { return };
        self.line(&format!("resolution = [{columns}, {rows}]"));
        if let Some([near, far]) = optics.range {
            self.line(&format!("near = {}", number(near)));
            self.line(&format!("far = {}", number(far)));
        }
        self.line("explicit_handling = true");
    }

    fn gears(&mut self) {
        for gear in &self.robot.gears {
            let [Some(first), Some(second)] = gear.joints.map(|j| self.joint_paths[j].clone()) else { continue };
            let path = self.unique("/", &gear.name);
            self.line(&format!("# {}", place(&gear.at)));
            self.line("[[coupling]]");
            self.line(&format!("name = {}", quoted(last(&path))));
            self.line(&format!("joints = [{}, {}]", quoted(&first), quoted(&second)));
            self.line(&format!("ratio = {}", number(gear.ratio)));
            if gear.offset != 0.0 {
                self.line(&format!("offset = {}", number(gear.offset)));
            }
            if gear.higher != [0.0; 3] {
                self.line(&format!("polynomial = {}", list(&gear.higher)));
            }
            self.line("");
        }
    }
}

/// Contact groups: the bodies of one tree do not touch each other. A robot of URDF is one tree with its base.
fn groups(robot: &Robot, fixed: &[bool]) -> Vec<usize> {
    let carriers = robot.carriers();
    let one_robot = !robot.has_own_motors;
    let mut groups = vec![0; robot.links.len()];
    let mut next = 1;
    // parents come before children
    for link in 0..robot.links.len() {
        let mut top = link;
        while let Some(parent) = carriers[top].and_then(|j| robot.joints[j].parent).filter(|p| one_robot || !fixed[*p])
        {
            top = parent;
            if top == link {
                break;
            }
        }
        if fixed[link] && !one_robot {
            continue;
        }
        if groups[top] == 0 {
            groups[top] = next;
            next += 1;
        }
        groups[link] = groups[top];
    }
    groups
}

/// `position = …` and the rotation, as far as they differ from the default.
fn keys(placement: &Placement) -> Vec<String> {
    let mut keys = Vec::new();
    if placement.position != [0.0; 3] {
        keys.push(format!("position = {}", list(&placement.position)));
    }
    match placement.rotation {
        Rotation::RollPitchYaw(rpy) if rpy == [0.0; 3] => {}
        Rotation::RollPitchYaw(rpy) => keys.push(format!("rotation_deg = {}", list(&rpy.map(crate::number::degrees)))),
        Rotation::Quaternion(q) if q[1..] == [0.0; 3] => {}
        Rotation::Quaternion(q) => keys.push(match placement.round_angles() {
            Some(degrees) => format!("rotation_deg = {}", list(&degrees)),
            None => format!("quaternion_wxyz = {}", list(&q)),
        }),
    }
    keys
}

/// Last part of a path.
fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// `arm.urdf:12`.
fn place(at: &Location) -> String {
    let file = at.source.path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    format!("{}:{}", one_line(&file), at.line_column().0)
}

/// A text in a comment.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

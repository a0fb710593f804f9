//! Scenes as robots of other formats, with a note of everything that the format cannot say.
//!
//! The tree of a scene is first brought to links: bodies, fixtures and frames, each with the joints that lead to it
//! from the link above, at zero coordinates. A writer a format does the rest.

mod mjcf;
mod mjcf_frames;
mod mjcf_tendon;
mod sdf;
mod urdf;

use std::collections::BTreeMap;

use sincro_dynamics::contact::{PairLaw, Surface, pairs};
use sincro_dynamics::joint::{Dof, JointKind};
use sincro_dynamics::model::{JointInfo, MassProperties, Shape};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::Pose;
use sincro_scene::scene::{Object, ObjectKind, Scene};

use crate::mesh::{Part, stl};
use crate::number;
pub(crate) use mjcf::UNLIMITED;
pub(crate) use mjcf_frames::PREFIX;

/// Robot description format that [`export()`] writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// URDF, the Unified Robot Description Format of ROS.
    Urdf,
    /// MJCF, the XML format of MuJoCo.
    Mjcf,
    /// SDF, the Simulation Description Format of Gazebo.
    Sdf,
}

/// Scene as a robot file of another format, in memory: the result of [`export()`].
#[derive(Clone, Debug)]
pub struct Exported {
    /// Text of the main file (XML).
    pub text: String,
    /// Content of the mesh files (STL), by their path relative to the main file.
    pub meshes: BTreeMap<String, Vec<u8>>,
    /// Notes on what the format cannot express: path of the object, and a sentence.
    pub notes: Vec<(String, String)>,
}

/// Writes the mechanism of a scene (links, joints, masses, geometry, motors) in another format; `name` is that of the
/// robot in the file.
///
/// # Errors
///
/// Joints of types that the format does not have: a sentence for each, with its path.
pub fn export(scene: &Scene, name: &str, format: Format) -> Result<Exported, Vec<String>> {
    let mut tree = Tree::new(scene, name);
    tree.note_rest(format);
    let text = match format {
        Format::Urdf => urdf::text(&mut tree)?,
        Format::Mjcf => mjcf::text(&mut tree)?,
        Format::Sdf => sdf::text(&mut tree)?,
    };
    Ok(Exported { text, meshes: tree.meshes, notes: tree.notes })
}

/// True if several links or joints hang on an object.
fn carries_several(scene: &Scene, object: usize) -> bool {
    let is_part = |o: &&Object| {
        let hangs = o.parent == Some(object);
        let is_link = matches!(o.kind, ObjectKind::Body { .. } | ObjectKind::Fixture | ObjectKind::Frame);
        hangs && (is_link || matches!(o.kind, ObjectKind::Joint { .. }))
    };
    scene.objects.iter().filter(is_part).count() > 1
}

/// A link: body, fixture or frame.
struct Link {
    /// Index among the objects of the scene.
    object: usize,
    /// Unique name.
    name: String,
    /// The link above; none for the world.
    parent: Option<usize>,
    /// Joints from the link above, outermost last.
    joints: Vec<Joint>,
    /// Its frame in that of the link above, at zero coordinates.
    pose: Pose<f64>,
    mass: Option<MassProperties>,
}

/// A joint on the way to a link.
#[derive(Clone)]
struct Joint {
    /// Path in the scene.
    path: String,
    /// Unique name.
    name: String,
    kind: JointKind,
    /// Its frame in that of the link above, at zero coordinates.
    pose: Pose<f64>,
    /// Passive properties of its degrees of freedom.
    dofs: Vec<Dof<f64>>,
    /// Limits of each degree of freedom.
    limits: Vec<[f64; 2]>,
    /// Motor of the model.
    motor: Option<sincro_dynamics::actuation::Motor<f64>>,
    /// Activation of the motor.
    activation: Option<sincro_dynamics::actuation::Activation<f64>>,
    /// Coordinates at the start.
    start: Vec<f64>,
}

impl Joint {
    fn axis(&self) -> [f64; 3] {
        match self.kind {
            JointKind::Revolute { axis } | JointKind::Prismatic { axis } | JointKind::Screw { axis, .. } => axis,
            JointKind::Universal { axis, .. } => axis,
            _ => [0.0, 0.0, 1.0],
        }
    }

    /// Limits of a degree of freedom, if it has any.
    fn limits_of(&self, dof: usize) -> Option<[f64; 2]> {
        self.limits.get(dof).copied().filter(|ends| ends.iter().any(|x| x.is_finite()))
    }

    fn is_limited(&self) -> bool {
        self.limits_of(0).is_some()
    }

    /// The number that a property has for all degrees of freedom; none if they differ.
    fn common(&self, property: impl Fn(&Dof<f64>) -> f64) -> Option<f64> {
        let first = self.dofs.first().map(&property)?;
        self.dofs.iter().all(|dof| property(dof) == first).then_some(first)
    }

    /// Words for the properties among these that are not zero, and for limits if there are any.
    fn properties_of(&self, is_left_out: impl Fn(&str) -> bool) -> Vec<&'static str> {
        let any = |property: fn(&Dof<f64>) -> f64| self.dofs.iter().any(|dof| property(dof) != 0.0);
        let all = [
            ("damping", any(|dof| dof.damping)),
            ("armature", any(|dof| dof.armature)),
            ("friction", any(|dof| dof.friction.sliding)),
            ("spring", any(|dof| dof.stiffness)),
            ("limits", (0..self.limits.len()).any(|dof| self.limits_of(dof).is_some())),
        ];
        all.into_iter().filter(|(word, has)| *has && is_left_out(word)).map(|(word, _)| word).collect()
    }
}

/// Geometry of a link.
struct Piece {
    surface: Surface,
    pose: Pose<f64>,
    color: Option<[u8; 3]>,
}

struct Tree<'a> {
    scene: &'a Scene,
    name: String,
    links: Vec<Link>,
    meshes: BTreeMap<String, Vec<u8>>,
    notes: Vec<(String, String)>,
}

impl<'a> Tree<'a> {
    fn new(scene: &'a Scene, name: &str) -> Self {
        let mut tree =
            Self { scene, name: name.to_owned(), links: Vec::new(), meshes: BTreeMap::new(), notes: Vec::new() };
        // the link that is rigid with an object, of a joint with its moving side, and the object's frame there
        let mut carrier: Vec<Option<(usize, Pose<f64>)>> = vec![None; scene.objects.len()];
        let mut names = std::collections::BTreeSet::new();
        for (k, object) in scene.objects.iter().enumerate() {
            let mass = match &object.kind {
                ObjectKind::Body { mass } => Some(*mass),
                ObjectKind::Fixture | ObjectKind::Frame => None,
                _ => continue,
            };
            let (mut chain, mut at) = (Vec::new(), object.parent);
            while let Some(p) = at.filter(|p| carrier[*p].is_none()) {
                chain.push(p);
                at = scene.objects[p].parent;
            }
            let found = at.and_then(|p| carrier[p]);
            let mut parent = found.map(|(link, _)| link);
            let mut above = found.map_or_else(Pose::identity, |(_, frame)| frame);
            let mut joints = Vec::new();
            for p in chain.into_iter().rev() {
                above = above.compose(&scene.objects[p].pose);
                joints.extend(tree.joint(&scene.objects[p], above, &mut names));
                if object.parent != Some(p) && carries_several(scene, p) {
                    // another branch goes out from here
                    carrier[p] = Some((tree.links.len(), Pose::identity()));
                    let name = unique(&mut names, &scene.objects[p]);
                    let joints = std::mem::take(&mut joints);
                    let here = tree.links.len();
                    tree.links.push(Link { object: p, name, parent, joints, pose: above, mass: None });
                    (parent, above) = (Some(here), Pose::identity());
                }
            }
            let link = tree.links.len();
            carrier[k] = Some((link, Pose::identity()));
            if let Some(p) = object.parent.filter(|p| carrier[*p].is_none()) {
                carrier[p] = Some((link, object.pose.inverse()));
            }
            let name = unique(&mut names, object);
            tree.links.push(Link { object: k, name, parent, joints, pose: above.compose(&object.pose), mass });
        }
        tree
    }

    fn joint(&self, object: &Object, pose: Pose<f64>, names: &mut std::collections::BTreeSet<String>) -> Option<Joint> {
        let ObjectKind::Joint { kind, .. } = object.kind else { return None };
        let model = &self.scene.model;
        let info: Option<&JointInfo> = model.names().joint(&object.path);
        let dofs = info.map_or_else(Vec::new, |i| model.dofs()[i.v_idx..i.v_idx + i.n_v].to_vec());
        let mut limits = vec![[f64::NEG_INFINITY, f64::INFINITY]; dofs.len()];
        for limit in &model.constraints().limits {
            if let Some(own) = info.and_then(|i| limit.dof.checked_sub(i.v_idx)).and_then(|k| limits.get_mut(k)) {
                own[usize::from(limit.sign < 0.0)] = limit.bound;
            }
        }
        let motor = info.filter(|i| i.n_v == 1).and_then(|i| i.motor);
        let activation = model.activations().iter().find(|own| motor.is_some_and(|id| own.command == id.index()));
        Some(Joint {
            path: object.path.clone(),
            name: unique(names, object),
            kind,
            pose,
            dofs,
            limits,
            motor: motor.map(|id| *model.motor(id)),
            activation: activation.copied(),
            start: info.map_or_else(Vec::new, |i| self.scene.initial.q[i.q_idx..i.q_idx + i.n_q].to_vec()),
        })
    }

    /// Notes the properties of a joint of several degrees of freedom that are left out.
    fn note_left_out(&mut self, joint: &Joint, is_left_out: impl Fn(&str) -> bool) {
        for word in joint.properties_of(is_left_out) {
            let verb = if word == "limits" { "are" } else { "is" };
            self.note(&joint.path, &format!("its {word} {verb} not written"));
        }
    }

    fn note(&mut self, path: &str, words: &str) {
        self.notes.push((path.to_owned(), words.to_owned()));
    }

    /// Notes the objects that no format takes.
    fn note_rest(&mut self, format: Format) {
        let scene = self.scene;
        for object in &scene.objects {
            let words = match object.kind {
                ObjectKind::Force => "an external force",
                ObjectKind::Rotor => "a rotor",
                ObjectKind::Drag => "a drag element",
                ObjectKind::Sensor => "a sensor",
                ObjectKind::Camera { .. } => "a camera",
                _ => continue,
            };
            self.note(&object.path, &format!("{words} is not written"));
        }
        for name in scene.model.names().spring_dampers.iter().filter(|_| format != Format::Mjcf) {
            self.note(name, "springs between points and tendons are not written");
        }
        for name in scene.model.names().bushings.iter().filter(|_| format != Format::Mjcf) {
            self.note(name, "a bushing is not written: the format has no springs between links");
        }
        for spring in scene.model.nonlinear_springs() {
            let joint = scene.model.names().dof_joint[spring.dof];
            self.note(&scene.model.names().joint_info(joint).name, "the law of its spring is not written");
        }
        for joint in scene.model.names().joints.iter().filter(|joint| joint.n_v > 1 && joint.motor.is_some()) {
            self.note(&joint.name, "motors of several axes are not written");
        }
        for own in scene.model.activations().iter().filter(|_| format != Format::Mjcf) {
            // springs between points and tendons are not written at all
            if let Some(motor) = scene.model.motors().get(own.command) {
                self.note(scene.model.names().dof_name(motor.dof), "the activation of its motor is not written");
            }
        }
        let of_motors = scene.model.motors().iter().map(|motor| scene.model.names().dof_name(motor.dof));
        for (name, command) in of_motors.zip(&scene.commands) {
            if *command != Signal::Constant(0.0) {
                self.note(name, "the command of its motor is not written");
            }
        }
        let lines = scene.model.spring_dampers().iter().zip(&scene.model.names().spring_dampers);
        for (line, name) in lines.filter(|_| format == Format::Mjcf) {
            if line.actuator.is_some_and(|own| scene.commands[own.command] != Signal::Constant(0.0)) {
                self.note(name, "the command of its actuator is not written");
            }
        }
        self.note_forces(format);
        for script in &scene.scripts {
            self.note(&script.path, "a script is not written");
        }
    }

    /// Notes forces and laws that no format takes.
    fn note_forces(&mut self, format: Format) {
        let (model, names) = (&self.scene.model, self.scene.model.names());
        for applied in model.applied() {
            self.note(names.dof_name(applied.dof), "a torque over time is not written");
        }
        for (k, dof) in model.dofs().iter().enumerate() {
            if dof.torque != 0.0 {
                self.note(names.dof_name(k), "its constant torque is not written");
            }
            let friction = dof.friction;
            if friction.at_rest != friction.sliding || friction.load_coefficient != 0.0 {
                self.note(names.dof_name(k), "its friction is written as that in motion, without load");
            }
        }
        let set = model.constraints();
        for limit in set.limits.iter().filter(|limit| limit.restitution != 0.0) {
            self.note(names.dof_name(limit.dof), "the restitution of its limits is not written");
        }
        if self.scene.initial.v.iter().any(|v| *v != 0.0) {
            self.note("/", "velocities at the start are not written");
        }
        let touching = self.scene.objects.iter().filter_map(|object| object.contact);
        let frictions: Vec<f64> = touching.map(|material| material.friction).collect();
        let law = match format {
            Format::Mjcf => Some("MuJoCo takes the larger one"),
            Format::Sdf => Some("Gazebo takes the smaller one"),
            Format::Urdf => None,
        };
        if let Some(law) = law.filter(|_| frictions.iter().any(|x| *x != frictions[0])) {
            self.note("/", &format!("the friction of two bodies is the geometric mean of theirs: {law}"));
        }
        for gear in &names.elastic_gears {
            self.note(gear, "an elastic coupling is not written");
        }
        let carries = |a: u32, b: u32| model.links()[a as usize].parent() == Some(b as usize);
        let plain = pairs(&set.colliders, |a, b| carries(a, b) || carries(b, a), |_, _| PairLaw::default());
        if plain != set.pairs {
            self.note("/", "laws of contact of pairs of bodies are not written");
        }
        if model.wind().is_some() || model.gravity_field().is_some() {
            self.note("/", "wind, and gravity that depends on the position, are not written");
        }
    }

    fn object(&self, link: usize) -> &'a Object {
        &self.scene.objects[self.links[link].object]
    }

    /// Geometry that shows, and geometry that touches.
    fn pieces(&self, link: usize) -> (Vec<Piece>, Vec<Piece>) {
        let object = self.object(link);
        let shown = object.shown().map(|s| Piece { surface: s.surface, pose: s.pose, color: s.color }).collect();
        let solids =
            object.shapes.iter().map(|s| Piece { surface: Surface::Solid(s.shape), pose: s.pose, color: s.color });
        let surfaces =
            object.surfaces.iter().map(|(surface, pose)| Piece { surface: surface.clone(), pose: *pose, color: None });
        let touching = if object.contact.is_some() { solids.chain(surfaces).collect() } else { Vec::new() };
        (shown, touching)
    }

    /// File of a mesh of a link; none for geometry that is no mesh.
    fn mesh_file(&mut self, link: usize, surface: &Surface) -> Option<String> {
        let (corners, triangles) = match surface {
            Surface::Mesh(corners, triangles) => (corners.clone(), triangles.clone()),
            Surface::Hull(points) => sincro_dynamics::geometry::polyhedron::convex_hull(points)?,
            _ => return None,
        };
        let bytes = stl(&Part { corners, triangles, color: None }, [1.0; 3]);
        if let Some((known, _)) = self.meshes.iter().find(|(_, b)| **b == bytes) {
            return Some(known.clone());
        }
        let file = format!("meshes/{}-{}.stl", self.links[link].name, self.meshes.len());
        self.meshes.insert(file.clone(), bytes);
        Some(file)
    }

    /// Gears between joints, by the names of those: first, second, and the coefficients of the powers 0 to 4 of first.
    fn gears(&self) -> Vec<(String, String, [f64; 5])> {
        let names = self.scene.model.names();
        let name = |dof: usize| {
            let path = &names.joint_info(names.dof_joint[dof]).name;
            let all = self.links.iter().flat_map(|l| &l.joints);
            all.clone().find(|j| j.path == *path).map(|j| j.name.clone())
        };
        let gears = self.scene.model.constraints().gears.iter();
        gears
            .filter_map(|g| {
                let [c2, c3, c4] = g.higher;
                Some((name(g.dofs[0])?, name(g.dofs[1])?, [g.offset, g.ratio, c2, c3, c4]))
            })
            .collect()
    }
}

/// A name that is not taken: the last part of the path, or the whole path.
fn unique(names: &mut std::collections::BTreeSet<String>, object: &Object) -> String {
    let whole = object.path.trim_start_matches('/').replace('/', ".");
    let name = if names.contains(&object.name) { whole } else { object.name.clone() };
    names.insert(name.clone());
    name
}

/// Numbers of an attribute.
fn numbers(list: &[f64]) -> String {
    list.iter().map(|x| number::plain(*x)).collect::<Vec<_>>().join(" ")
}

/// Roll, pitch and yaw of a pose.
fn rpy(pose: &Pose<f64>) -> [f64; 3] {
    match crate::robot::Placement::of_pose(pose).rotation {
        crate::robot::Rotation::RollPitchYaw(rpy) => rpy,
        crate::robot::Rotation::Quaternion(_) => sincro_dynamics::kinematics::roll_pitch_yaw(&pose.rot).0,
    }
}

/// Quaternion w, x, y, z of a pose, one that is read as exactly its rotation if there is one.
fn wxyz(pose: &Pose<f64>) -> [f64; 4] {
    match crate::robot::Placement::exactly(pose).0.rotation {
        crate::robot::Rotation::Quaternion(q) => q,
        crate::robot::Rotation::RollPitchYaw(_) => {
            let mut q = [0.0; 4];
            sincro_dynamics::spatial::Quat::from_matrix(&pose.rot).write(&mut q);
            q
        }
    }
}

/// A text in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Word and sizes of a solid that every format has.
fn solid(shape: &Shape) -> Option<(&'static str, Vec<f64>)> {
    Some(match shape {
        Shape::Cuboid { size } => ("box", size.to_vec()),
        Shape::Sphere { radius } => ("sphere", vec![*radius]),
        Shape::Cylinder { radius, length } => ("cylinder", vec![*radius, *length]),
        Shape::Capsule { radius, length } => ("capsule", vec![*radius, *length]),
        Shape::Cone { .. } | Shape::Torus { .. } => return None,
    })
}

//! Compilation of a model: from the user's tree of objects to a flat list of links.
//!
//! Every node gets a *carrier*: the link it is fixed in (or the world) and its pose there. A joint starts one new link
//! for each of its stages. The inertias of all bodies with the same carrier are summed.

mod check;

use std::sync::Arc;

use sincro_math::scalar_field::ScalarField;

use crate::actuation::bushing::LinkFrame;
use crate::actuation::spring::NonlinearSpring;
use crate::actuation::spring_damper::{JointShare, LineActuator, LinkPoint, Path, Segment};
use crate::actuation::{Activation, AppliedTorque, AppliedWrench, Bushing, ElasticGear, Motor, SpringDamper};
use crate::aero::AirDrag;
use crate::aero::rotor::{MountedRotor, RotorLaw, SpeedSource};
use crate::contact::{self, Collider, PairLaw};
use crate::ids::{BodyId, JointId, MotorId};
use crate::joint::{Dof, Friction, JointKind, Link, Shift, StageKind, WORLD};
use crate::model::Attached;
use crate::model::builder::{
    JointSpec, ModelBuilder, Node, NodeId, NodeKind, PathSpec, RotorDrive, RotorSpec, SpringDamperSpec,
};
use crate::model::diagnostic::{BuildError, Diagnostic, Severity};
use crate::model::names::{FrameInfo, JointInfo, Names};
use crate::model::parameters::link_inertia;
use crate::model::{Anchor, ConstraintSet, GearConstraint, Limit, LoopJoint};
use crate::model::{MassProperties, Model, ModelParams, Structure};
use crate::spatial::{Mat3, Pose, Vec3};

/// Directions closer than this to a coordinate axis are taken to be on it: what rotating by π/2 in floating point
/// leaves.
const ON_AXIS: f64 = 1e-15;

#[derive(Clone, Copy)]
struct Carrier {
    link: u32,
    pose: Pose<f64>,
}

impl Carrier {
    fn attached(&self) -> Attached<f64> {
        Attached { link: (self.link != WORLD).then_some(self.link as usize), pose: self.pose }
    }
}

struct Compiler<'a> {
    nodes: &'a [Node],
    carriers: Vec<Carrier>,
    structure: Structure<f64>,
    params: ModelParams<f64>,
    names: Names,
    atmosphere: Option<Arc<ScalarField>>,
}

impl ModelBuilder {
    /// Checks the objects and compiles the model; returns it with the warnings.
    ///
    /// # Errors
    ///
    /// [`BuildError`] with all diagnostics at once, warnings included, if one of them is an error: numbers that are not
    /// finite, a mass that is not positive, an inertia with a negative principal moment, a null axis, negative
    /// stiffness, damping, friction, armature or limits, lists that do not fit the joint, a joint that carries no mass,
    /// a rotor that does not turn with the joint it takes its speed from.
    pub fn build(&self) -> Result<(Model<f64>, Vec<Diagnostic>), BuildError> {
        compile(self)
    }
}

fn compile(builder: &ModelBuilder) -> Result<(Model<f64>, Vec<Diagnostic>), BuildError> {
    let mut problems = check::check(builder);
    if problems.iter().any(|p| p.severity == Severity::Error) {
        return Err(BuildError(problems));
    }
    let mut compiler = Compiler {
        nodes: &builder.nodes,
        carriers: Vec::with_capacity(builder.nodes.len()),
        structure: Structure {
            links: Vec::new(),
            dofs: Vec::new(),
            applied: Vec::new(),
            wrenches: Vec::new(),
            windings: Vec::new(),
            activations: Vec::new(),
            rotors: Vec::new(),
            drags: Vec::new(),
            spring_dampers: Vec::new(),
            elastic_gears: Vec::new(),
            bushings: Vec::new(),
            wind: builder.wind.clone(),
            gravity_field: builder.gravity_field.clone(),
            n_q: 0,
            sprung: Vec::new(),
            nonlinear_springs: Vec::new(),
            names: Arc::default(),
        },
        params: ModelParams::new(Vec3(builder.gravity)),
        names: Names::default(),
        atmosphere: builder.air_density.clone(),
    };
    for id in 0..builder.nodes.len() {
        compiler.node(id);
    }
    compiler.params.constraints = Arc::new(compiler.constraints(builder));
    mark_children(&mut compiler.structure.links);
    let model = compiler.finish(builder);
    problems.extend(check::massless_joints(&model));
    problems.extend(check::idle_lines(&model));
    if problems.iter().any(|p| p.severity == Severity::Error) {
        return Err(BuildError(problems));
    }
    Ok((model, problems))
}

/// Numbers the commands: those of motors come first, then external forces, rotors, actuators of lines.
fn number_commands(model: &mut Model<f64>) {
    let (n_motors, n_inputs) = (model.params.motors.len(), model.names.inputs.len());
    let n_before_lines = model.n_commands_before_lines(n_inputs);
    let structure = model.structure_mut();
    for input in structure.wrenches.iter_mut().filter_map(|w| w.input.as_mut()) {
        *input = n_motors + 6 * *input;
    }
    for rotor in &mut structure.rotors {
        rotor.speed.shift_command(n_motors + 6 * n_inputs);
    }
    for (k, actuator) in structure.spring_dampers.iter_mut().filter_map(|s| s.actuator.as_mut()).enumerate() {
        actuator.command = n_before_lines + k;
    }
}

/// Adds the activations of actuators along paths to those of motors, and numbers their states, from `n_states` on.
fn mount_activations(model: &mut Model<f64>, builder: &ModelBuilder, n_states: usize) {
    let structure = model.structure_mut();
    for ((_, spec), element) in builder.spring_dampers.iter().zip(&structure.spring_dampers) {
        if let (Some(activation), Some(actuator)) = (spec.activation, element.actuator) {
            structure.activations.push(Activation { command: actuator.command, ..activation });
        }
    }
    for (k, activation) in structure.activations.iter_mut().enumerate() {
        activation.state = n_states + k;
    }
}

impl Compiler<'_> {
    fn node(&mut self, id: usize) {
        let node = &self.nodes[id];
        if matches!(node.kind, NodeKind::World) {
            self.carriers.push(Carrier { link: WORLD, pose: Pose::identity() });
            return;
        }
        let at = self.carriers[node.parent.0 as usize];
        let here = Carrier { link: at.link, pose: snapped(&at.pose.compose(&node.pose)) };
        let node_id = NodeId(id as u32);
        let carrier = match &node.kind {
            NodeKind::Joint(spec) => self.joint(node_id, here, spec),
            NodeKind::Body(spec) => {
                self.frame(node_id, here, Some(spec.mass));
                here
            }
            NodeKind::Frame => {
                self.frame(node_id, here, None);
                here
            }
            NodeKind::Force(spec) => {
                if here.link != WORLD {
                    self.structure.wrenches.push(AppliedWrench {
                        link: here.link as usize,
                        pose: here.pose,
                        in_body: spec.in_body,
                        force: spec.force.clone().map(|s| vec![s]),
                        torque: spec.torque.clone().map(|s| vec![s]),
                        // motors come first; how many there are is known at the end
                        input: spec.is_input.then_some(self.names.inputs.len()),
                    });
                    if spec.is_input {
                        self.names.inputs.push(node.name.clone());
                    }
                }
                here
            }
            NodeKind::Rotor(spec) => {
                if here.link != WORLD {
                    self.rotor(node_id, here, spec);
                    self.names.rotors.push(node.name.clone());
                }
                here
            }
            NodeKind::Drag(spec) => {
                if here.link != WORLD {
                    self.structure.drags.push(AirDrag {
                        link: here.link as usize,
                        pose: here.pose,
                        area: Vec3(spec.area),
                        linear: Vec3(spec.linear),
                        density: spec.density,
                        atmosphere: self.atmosphere.clone(),
                    });
                    self.names.drags.push(node.name.clone());
                }
                here
            }
            NodeKind::World => unreachable!("handled above"),
        };
        self.carriers.push(carrier);
    }

    /// A rotor; commands are counted from that of the first one, where those begin is known at the end.
    fn rotor(&mut self, node: NodeId, at: Carrier, spec: &RotorSpec) {
        let command = self.structure.rotors.iter().filter(|r| r.speed.command().is_some()).count();
        let state = self.structure.rotors.iter().filter(|r| r.speed.state().is_some()).count();
        let speed = match spec.drive {
            RotorDrive::Command if matches!(spec.law, RotorLaw::Stock(_)) => SpeedSource::Particles { command, state },
            RotorDrive::Command => SpeedSource::Command(command),
            RotorDrive::Lag { time_constant, initial } => SpeedSource::Lag { command, state, time_constant, initial },
            RotorDrive::Joint(joint) => {
                let info = self.names.joints.iter().find(|j| j.node == joint);
                let along = check::turn_of_rotor(self.nodes, node, joint).expect("checked before");
                SpeedSource::Joint {
                    dof: info.expect("a revolute joint has a name").v_idx,
                    sign: along * spec.law.spin().map_or(1.0, |spin| spin.sign()),
                }
            }
        };
        let (link, law, atmosphere) = (at.link as usize, spec.law.clone(), self.atmosphere.clone());
        let density = if atmosphere.is_some() { 1.0 } else { spec.density };
        let RotorSpec { inertia, ground_effect, .. } = *spec;
        let pose = at.pose;
        let rotor = MountedRotor { link, pose, law, speed, density, atmosphere, inertia, ground_effect };
        self.structure.rotors.push(rotor);
    }

    fn frame(&mut self, node: NodeId, at: Carrier, mass: Option<MassProperties>) {
        let Attached { link, pose } = at.attached();
        let name = self.nodes[node.0 as usize].name.clone();
        self.names.frames.push(FrameInfo { name, node, link, pose, is_body: mass.is_some() });
        self.params.masses.push(mass);
    }

    /// The model: springs and dampers between two points, whose free length is the distance of their ends where it is
    /// not given, are the last elements.
    fn finish(self, builder: &ModelBuilder) -> Model<f64> {
        let Self { mut structure, mut params, mut names, carriers, .. } = self;
        names.spring_dampers.extend(builder.spring_dampers.iter().map(|(name, _)| name.clone()));
        params.inertias = (0..structure.links.len()).map(|l| link_inertia(&names, &params.masses, l)).collect();
        for (name, spec) in &builder.elastic_gears {
            let of = |k: usize| names.joints.iter().find(|j| j.node == spec.gear.joints[k]);
            let (Some(one), Some(two)) = (of(0), of(1)) else { continue };
            structure.elastic_gears.push(ElasticGear {
                dofs: [one.v_idx, two.v_idx],
                coordinates: [one.q_idx, two.q_idx],
                ratio: spec.gear.ratio,
                offset: spec.gear.offset,
                stiffness: spec.stiffness,
                damping: spec.damping,
                backlash: spec.backlash,
            });
            names.elastic_gears.push(name.clone());
        }
        for (name, spec) in &builder.bushings {
            let end = |k: usize| {
                let Attached { link, pose } = carriers[spec.ends[k].0 as usize].attached();
                LinkFrame { link, pose: pose.compose(&spec.poses[k]) }
            };
            structure.bushings.push(Bushing {
                ends: [end(0), end(1)],
                stiffness: spec.stiffness,
                damping: spec.damping,
            });
            names.bushings.push(name.clone());
        }
        structure.names = Arc::new(names);
        let mut n_states = structure.rotors.iter().filter(|r| r.speed.state().is_some()).count();
        for winding in &mut structure.windings {
            *winding = winding.mounted(winding.motor, winding.dof, n_states);
            n_states += usize::from(winding.state.is_some());
        }
        let mut model = Model::new(structure, params);
        let lines = spring_dampers(builder, &carriers, &model);
        model.structure_mut().spring_dampers = lines;
        number_commands(&mut model);
        mount_activations(&mut model, builder, n_states);
        model.params.drives = model.find_drives();
        model
    }

    /// Closures, couplings, limits and surfaces, with the links that carry them.
    fn constraints(&self, builder: &ModelBuilder) -> ConstraintSet {
        let anchor = |node: NodeId, pose: &Pose<f64>| {
            let at = self.carriers[node.0 as usize];
            Anchor { name: self.nodes[node.0 as usize].name.clone(), link: at.link, pose: at.pose.compose(pose) }
        };
        let loop_joints = builder.loop_joints.iter().map(|(name, spec)| LoopJoint {
            name: name.clone(),
            kind: spec.kind,
            a: anchor(spec.ends[0], &spec.poses[0]),
            b: anchor(spec.ends[1], &spec.poses[1]),
        });
        let joint = |node: NodeId| self.names.joints.iter().find(|j| j.node == node);
        let gears = builder.gears.iter().filter_map(|(name, spec)| {
            let [one, two] = [joint(spec.joints[0])?, joint(spec.joints[1])?];
            Some(GearConstraint {
                name: name.clone(),
                dofs: [one.v_idx, two.v_idx],
                coordinates: [one.q_idx, two.q_idx],
                ratio: spec.ratio,
                offset: spec.offset,
                higher: spec.higher,
            })
        });
        let mut limits = Vec::new();
        for info in &self.names.joints {
            let NodeKind::Joint(spec) = &self.nodes[info.node.0 as usize].kind else { continue };
            for (k, (lower, upper)) in spec.limits.iter().enumerate() {
                for (sign, bound) in [(1.0, *lower), (-1.0, *upper)] {
                    if bound.is_finite() {
                        let (dof, coordinate) = (info.v_idx + k, info.q_idx + k);
                        limits.push(Limit { dof, coordinate, sign, bound, restitution: spec.limit_restitution });
                    }
                }
            }
        }
        let colliders: Vec<Collider> = builder
            .colliders
            .iter()
            .map(|(node, pose, surface, material)| {
                let Anchor { name, link, pose } = anchor(*node, pose);
                let body = self.names.frames.iter().position(|f| f.node == *node).map(BodyId::new);
                Collider { name, body, link, pose, surface: surface.clone(), material: *material }
            })
            .collect();
        let parent = |link: u32| self.structure.links[link as usize].parent;
        let law = |i: usize, j: usize| {
            let nodes = [builder.colliders[i].0, builder.colliders[j].0];
            let is_meant = |ends: &[NodeId; 2]| *ends == nodes || *ends == [nodes[1], nodes[0]];
            let found = builder.contact_pairs.iter().rev().find(|(ends, _)| is_meant(ends));
            found.map_or(PairLaw::default(), |(_, law)| *law)
        };
        let pairs = contact::pairs(&colliders, |a, b| parent(a) == b || parent(b) == a, law);
        ConstraintSet {
            loop_joints: loop_joints.collect(),
            gears: gears.collect(),
            limits,
            pairs,
            colliders,
            rest_speed: builder.rest_speed,
        }
    }

    /// Adds the stages of a joint; returns what carries its child frame.
    fn joint(&mut self, node: NodeId, at: Carrier, spec: &JointSpec) -> Carrier {
        let mut stages = stages(&spec.kind);
        if spec.sensor && stages.is_empty() {
            stages.push(StageSpec { family: Family::Free, axis: Z, pitch: 0.0 });
        }
        if stages.is_empty() {
            return at;
        }
        let (q_idx, v_idx) = (self.structure.n_q, self.structure.dofs.len());
        let mut carrier = at;
        for stage in stages {
            carrier = self.stage(carrier, &stage);
        }
        let joint = JointId::new(self.names.joints.len());
        let (n_q, n_v) = (self.structure.n_q - q_idx, self.structure.dofs.len() - v_idx);
        self.names.dof_joint.extend(std::iter::repeat_n(joint, n_v));
        for k in 0..n_v {
            self.dof_properties(v_idx + k, k, spec);
        }
        let link = self.structure.links.len() - 1;
        let has_quaternion = matches!(self.structure.links[link].kind, StageKind::Ball | StageKind::Free);
        if has_quaternion && self.structure.dofs[v_idx..].iter().any(|dof| dof.stiffness != 0.0) {
            self.structure.sprung.push(link);
        }
        let first = MotorId::new(self.params.motors.len());
        let motors = spec.motor.iter().enumerate().map(|(k, motor)| Motor { dof: v_idx + k, ..*motor });
        self.params.motors.extend(motors);
        for (k, winding) in spec.winding.iter().enumerate() {
            if let Some(winding) = winding {
                self.structure.dofs[v_idx + k].armature += winding.gear_ratio.powi(2) * winding.rotor_inertia;
                self.structure.windings.push(winding.mounted(first.index() + k, v_idx + k, 0));
            }
        }
        for (k, activation) in spec.activation.iter().enumerate() {
            self.structure.activations.extend(activation.map(|own| Activation { command: first.index() + k, ..own }));
        }
        let motor = (!spec.motor.is_empty()).then_some(first);
        let name = self.nodes[node.0 as usize].name.clone();
        let (base, moving) = (at.attached(), carrier.attached());
        self.names.joints.push(JointInfo { name, node, kind: spec.kind, q_idx, n_q, v_idx, n_v, motor, base, moving });
        carrier
    }

    fn dof_properties(&mut self, dof: usize, k: usize, spec: &JointSpec) {
        let entry = &mut self.structure.dofs[dof];
        let at = |list: &[f64]| list.get(k).copied().unwrap_or(0.0);
        entry.armature = at(&spec.armature);
        entry.damping = at(&spec.damping);
        entry.friction = spec.friction.get(k).copied().unwrap_or(Friction::none());
        (entry.stiffness, entry.rest) = spec.spring.get(k).copied().unwrap_or((0.0, 0.0));
        if let Some(Some(law)) = spec.spring_law.get(k) {
            self.structure.nonlinear_springs.push(NonlinearSpring { dof, law: Arc::clone(law) });
        }
        match spec.torque.get(k) {
            None => {}
            Some(signal) => match signal.constant() {
                Some(torque) => entry.torque = torque,
                None => self.structure.applied.push(AppliedTorque { dof, signal: vec![signal.clone()] }),
            },
        }
    }

    /// One stage whose joint frame stands at `at`.
    fn stage(&mut self, at: Carrier, stage: &StageSpec) -> Carrier {
        let frame = frame_of(stage, &at.pose.rot);
        let turned = frame.base_rotation != Mat3::identity();
        let kind = frame.kind;
        let (q_idx, v_idx) = (self.structure.n_q, self.structure.dofs.len());
        self.structure.links.push(Link {
            parent: at.link,
            kind,
            turned,
            shift: if kind.is_pure_rotation() { shift_of(at.pose.pos) } else { Shift::Any },
            has_children: false,
            is_last_child: false,
            q_idx: q_idx as u32,
            v_idx: v_idx as u32,
            origin: at.pose.pos,
            base_rotation: frame.base_rotation,
            sign: frame.sign,
            axis: frame.axis,
            pitch: stage.pitch,
        });
        self.structure.n_q += kind.n_q();
        for _ in 0..kind.n_v() {
            self.structure.dofs.push(Dof {
                armature: 0.0,
                stiffness: 0.0,
                rest: 0.0,
                damping: 0.0,
                friction: Friction::none(),
                torque: 0.0,
                q_idx: if kind.n_q() == 1 { q_idx as u32 } else { WORLD },
            });
        }
        let rot = frame.base_rotation.transpose().mul(&at.pose.rot);
        let pose = snapped(&Pose { rot, pos: Vec3::zero() });
        Carrier { link: (self.structure.links.len() - 1) as u32, pose }
    }
}

/// Springs and dampers between two points; their commands are numbered last.
fn spring_dampers(builder: &ModelBuilder, carriers: &[Carrier], model: &Model<f64>) -> Vec<SpringDamper<f64>> {
    let zero = crate::state::State::new(model).q;
    let mut scratch = crate::scratch::Scratch::new(model);
    crate::recursions::kinematics::poses(model, &zero, &mut scratch);
    let point = |(node, position): &(NodeId, [f64; 3])| {
        let at = carriers[node.0 as usize];
        LinkPoint { link: at.attached().link, position: at.pose.point(Vec3(*position)) }
    };
    let place = |end: LinkPoint<f64>| match end.link {
        None => end.position,
        Some(link) => scratch.poses[link].point(end.position),
    };
    let share = |(node, coefficient): &(NodeId, f64)| {
        let joint = model.names.joints.iter().find(|j| j.node == *node).expect("a tendon is of joints of the model");
        JointShare { dof: joint.v_idx, coordinate: joint.q_idx, coefficient: *coefficient }
    };
    let element = |spec: &SpringDamperSpec| {
        let (path, length) = match &spec.path {
            PathSpec::Joints(joints) => (Path::Joints(joints.iter().map(share).collect()), 0.0),
            PathSpec::Points(points) => {
                let segment = |pair: &[(NodeId, [f64; 3])]| Segment { ends: [point(&pair[0]), point(&pair[1])] };
                let segments: Vec<_> = points.windows(2).map(segment).collect();
                let length = segments.iter().map(|s| (place(s.ends[1]) - place(s.ends[0])).norm()).sum();
                (Path::Lines(segments), length)
            }
        };
        SpringDamper {
            path,
            free_length: spec.free_length.unwrap_or(length),
            law: spec.law.clone(),
            tension_only: spec.tension_only,
            actuator: spec.actuator.map(|max_force| LineActuator { command: 0, max_force }),
        }
    };
    builder.spring_dampers.iter().map(|(_, spec)| element(spec)).collect()
}

/// On which axis of the parent a fixed offset lies.
fn shift_of(origin: Vec3<f64>) -> Shift {
    match origin.0.map(|x| x != 0.0) {
        [false, false, false] => Shift::None,
        [true, false, false] => Shift::X,
        [false, true, false] => Shift::Y,
        [false, false, true] => Shift::Z,
        _ => Shift::Any,
    }
}

/// Marks who has children, and each parent's last child.
fn mark_children(links: &mut [Link<f64>]) {
    for i in (0..links.len()).rev() {
        if let Some(parent) = links[i].parent() {
            links[i].is_last_child = !links[parent].has_children;
            links[parent].has_children = true;
        }
    }
}

/// One stage before its frame is chosen.
struct StageSpec {
    family: Family,
    /// In joint axes.
    axis: [f64; 3],
    pitch: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Family {
    Revolute,
    Prismatic,
    Screw,
    Ball,
    Free,
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// The chain of stages that a joint of `kind` is.
fn stages(kind: &JointKind) -> Vec<StageSpec> {
    let stage = |family, axis| StageSpec { family, axis, pitch: 0.0 };
    match *kind {
        JointKind::Fixed => vec![],
        JointKind::Revolute { axis } => vec![stage(Family::Revolute, axis)],
        JointKind::Prismatic { axis } => vec![stage(Family::Prismatic, axis)],
        JointKind::Screw { axis, pitch } => vec![StageSpec { family: Family::Screw, axis, pitch }],
        JointKind::Universal { axis, axis2 } => vec![stage(Family::Revolute, axis), stage(Family::Revolute, axis2)],
        JointKind::Ball => vec![stage(Family::Ball, Z)],
        JointKind::Planar => vec![stage(Family::Prismatic, X), stage(Family::Prismatic, Y), stage(Family::Revolute, Z)],
        JointKind::Free => vec![stage(Family::Free, Z)],
    }
}

struct StageFrame {
    kind: StageKind,
    base_rotation: Mat3<f64>,
    sign: f64,
    axis: Vec3<f64>,
}

/// Chooses base axes: parallel to the parent's if that lets the joint be what it is, else with z on the joint axis.
fn frame_of(stage: &StageSpec, joint_rotation: &Mat3<f64>) -> StageFrame {
    let n = joint_rotation.mul_vec(Vec3(stage.axis));
    let n = n.scale(1.0 / n.norm());
    let frame = |kind, base_rotation| StageFrame { kind, base_rotation, sign: 1.0, axis: n };
    match stage.family {
        Family::Ball => frame(StageKind::Ball, *joint_rotation),
        Family::Free => frame(StageKind::Free, *joint_rotation),
        Family::Prismatic => frame(StageKind::Prismatic, Mat3::identity()),
        Family::Screw if on_axis(n, 2) && n[2] > 0.0 => frame(StageKind::Screw, Mat3::identity()),
        Family::Screw => frame(StageKind::Screw, with_z_along(n)),
        Family::Revolute => {
            let kinds = [StageKind::RevoluteX, StageKind::RevoluteY, StageKind::RevoluteZ];
            match (0..3).find(|&k| on_axis(n, k)) {
                Some(k) => StageFrame { sign: n[k].signum(), ..frame(kinds[k], Mat3::identity()) },
                None => frame(StageKind::RevoluteZ, with_z_along(n)),
            }
        }
    }
}

fn on_axis(n: Vec3<f64>, k: usize) -> bool {
    n[(k + 1) % 3].abs() < ON_AXIS && n[(k + 2) % 3].abs() < ON_AXIS
}

/// A rotation whose third column is the unit vector `n`.
fn with_z_along(n: Vec3<f64>) -> Mat3<f64> {
    // the coordinate axis that n leans on least gives a well-conditioned x
    let k = (0..3).fold(0, |best, k| if n[k].abs() < n[best].abs() { k } else { best });
    let x = Vec3::along(k, 1.0) - n.scale(n[k]);
    let x = x.scale(1.0 / x.norm());
    Mat3([x.0, n.cross(x).0, n.0]).transpose()
}

/// Replaces rotation entries that are 0 or ±1 but for rounding, so that parallel frames stay exactly parallel.
fn snapped(pose: &Pose<f64>) -> Pose<f64> {
    let snap = |x: f64| if (x - x.round()).abs() < ON_AXIS { x.round() + 0.0 } else { x };
    Pose { rot: Mat3(pose.rot.0.map(|row| row.map(snap))), pos: pose.pos }
}

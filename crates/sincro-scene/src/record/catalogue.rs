//! Every signal that a model offers, with its unit.

use std::borrow::Cow;

use sincro_dynamics::actuation::MotorMode;
use sincro_dynamics::aero::rotor::RotorLaw;
use sincro_dynamics::ids::{JointId, MotorId};
use sincro_dynamics::joint::{Dof, JointKind};
use sincro_dynamics::model::{JointInfo, Model};

use super::{
    BushingQuantity, ContactQuantity, EnergyQuantity, FrameQuantity, GearQuantity, LineQuantity, Probe, RotorQuantity,
    WindingQuantity,
};

/// Signal that can be recorded: name, unit, and the probe that reads it; an entry of [`catalogue`].
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"
///     joint = [{ name = "slide", kind = "prismatic", axis = [1.0, 0.0, 0.0] }]
///     body = [{ name = "cart", parent = "/slide", density = 1000.0, shape = [{ sphere = { radius = 0.1 } }] }]
/// "#)?;
/// let entry: Entry = catalogue(&scene.model).into_iter().find(|entry| entry.name == "/slide.velocity").unwrap();
/// assert_eq!((&*entry.unit, entry.probe), ("m/s", Probe::Rate(0)));
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name as it is written in `record`, such as `/slide.velocity`.
    pub name: String,
    /// SI unit as text, such as `m/s`; `1` or empty if dimensionless.
    pub unit: Cow<'static, str>,
    /// Probe that reads the signal off a world.
    pub probe: Probe,
}

const XYZ: [&str; 3] = ["x", "y", "z"];
const WXYZ: [&str; 4] = ["w", "x", "y", "z"];

struct List(Vec<Entry>);

impl List {
    fn add(&mut self, name: String, unit: &'static str, probe: Probe) {
        self.0.push(Entry { name, unit: unit.into(), probe });
    }

    fn vector(&mut self, stem: &str, names: &[&str], unit: &'static str, probe: impl Fn(usize) -> Probe) {
        for (k, component) in names.iter().enumerate() {
            self.add(format!("{stem}.{component}"), unit, probe(k));
        }
    }
}

/// Returns all signals that a model offers: those of joints, bodies and frames in their order, then those of the world,
/// such as `energy.total`.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"
///     joint = [{ name = "base", kind = "free" }]
///     body = [{ name = "ball", parent = "/base", density = 1000.0, shape = [{ sphere = { radius = 0.1 } }] }]
/// "#)?;
/// let signals = catalogue(&scene.model);
/// let unit = |name: &str| signals.iter().find(|signal| signal.name == name).map(|signal| &*signal.unit);
/// assert_eq!(unit("/base/ball.position.z"), Some("m"));
/// assert_eq!((unit("energy.kinetic"), unit("energy.height")), (Some("J"), None));
/// # Ok::<(), Diagnostics>(())
/// ```
#[must_use]
pub fn catalogue(model: &Model<f64>) -> Vec<Entry> {
    let mut list = List(Vec::new());
    for joint in &model.names().joints {
        joint_signals(&mut list, joint, model);
    }
    for (k, joint) in model.names().joints.iter().enumerate().filter(|(_, joint)| joint.kind != JointKind::Fixed) {
        let (name, id) = (&joint.name, JointId::new(k));
        list.vector(&format!("{name}.reaction_force"), &XYZ, "N", |c| Probe::JointReaction(id, 3 + c));
        list.vector(&format!("{name}.reaction_torque"), &XYZ, "N·m", |c| Probe::JointReaction(id, c));
    }
    for (i, frame) in model.names().frames.iter().enumerate() {
        frame_signals(&mut list, &frame.name, i, frame.is_body);
        if model.wind().is_some() {
            list.vector(&format!("{}.wind", frame.name), &XYZ, "m/s", |k| Probe::Frame(FrameQuantity::Wind, i, k));
        }
    }
    for (k, name) in model.names().inputs.iter().enumerate() {
        let first = model.motors().len() + 6 * k;
        list.vector(&format!("{name}.force"), &XYZ, "N", |c| Probe::Command(first + c));
        list.vector(&format!("{name}.torque"), &XYZ, "N·m", |c| Probe::Command(first + 3 + c));
    }
    for (k, name) in model.names().rotors.iter().enumerate() {
        use RotorQuantity as Q;
        let rotor = &model.rotors()[k];
        // the speed of a rotor that follows at once is its command
        let unit = if matches!(rotor.law, RotorLaw::Stock(_)) { "m/s" } else { "rad/s" };
        match rotor.speed.command() {
            Some(command) if rotor.speed.follows_at_once() => {
                list.add(format!("{name}.speed"), unit, Probe::Command(command))
            }
            Some(command) => {
                list.add(format!("{name}.command"), unit, Probe::Command(command));
                list.add(format!("{name}.speed"), unit, Probe::Rotor(Q::Speed, k));
            }
            None => list.add(format!("{name}.speed"), unit, Probe::Rotor(Q::Speed, k)),
        }
        let quantities = [
            ("thrust", "N", Q::Thrust),
            ("torque", "N·m", Q::Torque),
            ("inflow", "m/s", Q::Inflow),
            ("power", "W", Q::Power),
            ("valid", "1", Q::Valid),
        ];
        for (what, unit, quantity) in quantities {
            list.add(format!("{name}.{what}"), unit, Probe::Rotor(quantity, k));
        }
    }
    for (k, name) in model.names().drags.iter().enumerate() {
        list.vector(&format!("{name}.force"), &XYZ, "N", |c| Probe::Drag(k, c));
    }
    for (k, name) in model.names().spring_dampers.iter().enumerate() {
        use LineQuantity as Q;
        for (what, unit, quantity) in [("length", "m", Q::Length), ("rate", "m/s", Q::Rate), ("force", "N", Q::Force)] {
            list.add(format!("{name}.{what}"), unit, Probe::SpringDamper(quantity, k));
        }
        if let Some(actuator) = model.spring_dampers()[k].actuator {
            let activation = activation_of(actuator.command, model);
            let unit = if activation.is_some_and(|(_, integrates)| integrates) { "N/s" } else { "N" };
            list.add(format!("{name}.command"), unit, Probe::Command(actuator.command));
            if let Some((k, _)) = activation {
                list.add(format!("{name}.activation"), "N", Probe::Activation(k));
            }
        }
    }
    for (k, name) in model.names().bushings.iter().enumerate() {
        use BushingQuantity as Q;
        let quantities = [
            ("deflection", "m", Q::Deflection),
            ("rotation", "rad", Q::Rotation),
            ("force", "N", Q::Force),
            ("torque", "N·m", Q::Torque),
        ];
        for (what, unit, quantity) in quantities {
            list.vector(&format!("{name}.{what}"), &XYZ, unit, |c| Probe::Bushing(quantity, k, c));
        }
    }
    for (k, name) in model.names().elastic_gears.iter().enumerate() {
        let second = model.names().joint_of(model.elastic_gears()[k].dofs[1]);
        let units = if matches!(second.kind, JointKind::Prismatic { .. }) { LENGTH.0 } else { ANGLE.0 };
        list.add(format!("{name}.mesh_error"), units[0], Probe::ElasticGear(GearQuantity::MeshError, k));
        list.add(format!("{name}.torque"), units[3], Probe::ElasticGear(GearQuantity::Torque, k));
    }
    if model.wind().is_some() {
        list.vector("wind", &XYZ, "m/s", Probe::Wind);
    }
    contact_signals(&mut list, model);
    let values = model.names().sensors.iter().flat_map(|s| s.values.iter().map(move |value| (&s.name, value)));
    for (k, (name, (value, unit))) in values.enumerate() {
        list.0.push(Entry { name: format!("{name}.{value}"), unit: unit.clone().into(), probe: Probe::Sensor(k) });
    }
    world_signals(&mut list);
    list.0
}

/// Units of a coordinate, its rate, its acceleration and its torque.
struct Units([&'static str; 5]);

const ANGLE: Units = Units(["rad", "rad/s", "rad/s²", "N·m", "N·m/s"]);
const LENGTH: Units = Units(["m", "m/s", "m/s²", "N", "N/s"]);

fn joint_signals(list: &mut List, joint: &JointInfo, model: &Model<f64>) {
    let name = &joint.name;
    let (q, v) = (joint.q_idx, joint.v_idx);
    match joint.kind {
        JointKind::Fixed => {
            list.vector(&format!("{name}.force"), &XYZ, "N", |k| Probe::Reaction(v + 3 + k));
            list.vector(&format!("{name}.torque"), &XYZ, "N·m", |k| Probe::Reaction(v + k));
        }
        JointKind::Revolute { .. } | JointKind::Screw { .. } => scalar(list, name, "", &ANGLE, q, v),
        JointKind::Prismatic { .. } => scalar(list, name, "", &LENGTH, q, v),
        JointKind::Universal { .. } => {
            scalar(list, name, ".1", &ANGLE, q, v);
            scalar(list, name, ".2", &ANGLE, q + 1, v + 1);
        }
        JointKind::Planar => {
            scalar(list, name, ".x", &LENGTH, q, v);
            scalar(list, name, ".y", &LENGTH, q + 1, v + 1);
            scalar(list, name, ".angle", &ANGLE, q + 2, v + 2);
        }
        JointKind::Ball => {
            list.vector(&format!("{name}.quaternion"), &WXYZ, "1", |k| Probe::Coordinate(q + k));
            list.vector(&format!("{name}.velocity"), &XYZ, "rad/s", |k| Probe::Rate(v + k));
            list.vector(&format!("{name}.acceleration"), &XYZ, "rad/s²", |k| Probe::Acceleration(v + k));
            passive(list, name, model, ("torque", "N·m"), v);
        }
        JointKind::Free => {
            list.vector(&format!("{name}.position"), &XYZ, "m", |k| Probe::Coordinate(q + k));
            list.vector(&format!("{name}.quaternion"), &WXYZ, "1", |k| Probe::Coordinate(q + 3 + k));
            list.vector(&format!("{name}.angular_velocity"), &XYZ, "rad/s", |k| Probe::Rate(v + k));
            list.vector(&format!("{name}.velocity"), &XYZ, "m/s", |k| Probe::Rate(v + 3 + k));
            list.vector(&format!("{name}.angular_acceleration"), &XYZ, "rad/s²", |k| Probe::Acceleration(v + k));
            list.vector(&format!("{name}.acceleration"), &XYZ, "m/s²", |k| Probe::Acceleration(v + 3 + k));
            passive(list, name, model, ("torque", "N·m"), v);
            passive(list, name, model, ("force", "N"), v + 3);
        }
    }
    motor_signals(list, joint, model);
}

/// Signals of the motors of a joint, components of one vector together.
fn motor_signals(list: &mut List, joint: &JointInfo, model: &Model<f64>) {
    let motors: Vec<MotorId> = joint.motors().collect();
    if motors.is_empty() {
        return;
    }
    // first degree of freedom, names of the components, true for lengths
    const SPATIAL: [&str; 3] = [".x", ".y", ".z"];
    let groups: &[(usize, &[&str], bool)] = match joint.kind {
        JointKind::Fixed | JointKind::Revolute { .. } | JointKind::Screw { .. } => &[(0, &[""], false)],
        JointKind::Prismatic { .. } => &[(0, &[""], true)],
        JointKind::Universal { .. } => &[(0, &[".1", ".2"], false)],
        JointKind::Planar => &[(0, &[".x", ".y"], true), (2, &[".angle"], false)],
        JointKind::Ball => &[(0, &SPATIAL, false)],
        JointKind::Free => &[(0, &SPATIAL, false), (3, &SPATIAL, true)],
    };
    for (first, components, is_length) in groups {
        // a free joint has both kinds along one axis: `command.x` belongs to `velocity.x`
        let (command, torque) = match (joint.kind, is_length) {
            (JointKind::Free, false) => ("angular_command", "motor_torque"),
            (JointKind::Free, true) => ("command", "motor_force"),
            _ => ("command", "motor_torque"),
        };
        let units = if *is_length { LENGTH.0 } else { ANGLE.0 };
        let of_activation = |motor: MotorId| match model.motor(motor).mode {
            MotorMode::Torque => [units[3], units[4]],
            MotorMode::Velocity => [units[1], units[2]],
            MotorMode::Position | MotorMode::Spring => [units[0], units[1]],
            MotorMode::Voltage => ["V", "V/s"],
            MotorMode::Free => ["", ""],
        };
        let of_command = |motor: MotorId| {
            let activation = activation_of(motor.index(), model);
            of_activation(motor)[usize::from(activation.is_some_and(|(_, integrates)| integrates))]
        };
        let mut add = |what: &str, unit: &dyn Fn(MotorId) -> &'static str, probe: fn(usize) -> Probe| {
            for (component, motor) in components.iter().zip(&motors[*first..]) {
                list.add(format!("{}.{what}{component}", joint.name), unit(*motor), probe(motor.index()));
            }
        };
        add(command, &of_command, Probe::Command);
        add(torque, &|_| units[3], Probe::MotorTorqueMean);
        add(&format!("{torque}_now"), &|_| units[3], Probe::MotorTorqueNow);
        for (component, motor) in components.iter().zip(&motors[*first..]) {
            winding_signals(list, &joint.name, component, *motor, model);
            if let Some((k, _)) = activation_of(motor.index(), model) {
                let name = format!("{}.activation{component}", joint.name);
                list.add(name, of_activation(*motor)[0], Probe::Activation(k));
            }
        }
    }
}

/// Activation of the actuator with that command: its index, and true for an integrator.
fn activation_of(command: usize, model: &Model<f64>) -> Option<(usize, bool)> {
    let k = model.activations().iter().position(|own| own.command == command)?;
    Some((k, model.activations()[k].time_constant().is_none()))
}

/// Signals of the winding of a motor, if it has one.
fn winding_signals(list: &mut List, joint: &str, component: &str, motor: MotorId, model: &Model<f64>) {
    use WindingQuantity as Q;
    let Some(k) = model.windings().iter().position(|w| w.motor == motor.index()) else { return };
    let quantities = [
        ("current", "A", Q::Current),
        ("voltage", "V", Q::Voltage),
        ("back_emf", "V", Q::BackEmf),
        ("electrical_power", "W", Q::ElectricalPower),
    ];
    for (what, unit, quantity) in quantities {
        list.add(format!("{joint}.{what}{component}"), unit, Probe::Winding(quantity, k));
    }
}

/// Torques or forces of the passive elements that act on three degrees of freedom of a ball or free joint, child axes.
fn passive(list: &mut List, name: &str, model: &Model<f64>, (what, unit): (&str, &'static str), v: usize) {
    let has = |acts: fn(&Dof<f64>) -> bool| model.dofs()[v..v + 3].iter().any(acts);
    if has(|dof| dof.stiffness != 0.0) {
        list.vector(&format!("{name}.spring_{what}"), &XYZ, unit, |k| Probe::SpringTorque(v + k));
    }
    if has(|dof| dof.damping != 0.0) {
        list.vector(&format!("{name}.damping_{what}"), &XYZ, unit, |k| Probe::DampingTorque(v + k));
    }
    if has(|dof| dof.friction.at_rest != 0.0) {
        list.vector(&format!("{name}.friction_{what}"), &XYZ, unit, |k| Probe::FrictionTorque(v + k));
    }
}

/// The signals of one scalar coordinate; `component` is empty for a joint that has no other.
fn scalar(list: &mut List, name: &str, component: &str, units: &Units, q: usize, v: usize) {
    let torque = units.0[3];
    let entries = [
        ("position", units.0[0], Probe::Coordinate(q)),
        ("velocity", units.0[1], Probe::Rate(v)),
        ("acceleration", units.0[2], Probe::Acceleration(v)),
        ("spring_torque", torque, Probe::SpringTorque(v)),
        ("damping_torque", torque, Probe::DampingTorque(v)),
        ("friction_torque", torque, Probe::FrictionTorque(v)),
        ("applied_torque", torque, Probe::AppliedTorque(v)),
    ];
    for (what, unit, probe) in entries {
        list.add(format!("{name}.{what}{component}"), unit, probe);
    }
}

fn frame_signals(list: &mut List, name: &str, i: usize, is_body: bool) {
    use FrameQuantity as F;
    let at = |quantity: F| move |k: usize| Probe::Frame(quantity, i, k);
    list.vector(&format!("{name}.position"), &XYZ, "m", at(F::Position));
    list.vector(&format!("{name}.quaternion"), &WXYZ, "1", at(F::Quaternion));
    list.vector(name, &["roll", "pitch", "yaw"], "rad", at(F::Angles));
    list.vector(&format!("{name}.velocity"), &XYZ, "m/s", at(F::Velocity));
    list.vector(&format!("{name}.angular_velocity"), &XYZ, "rad/s", at(F::AngularVelocity));
    list.vector(&format!("{name}.acceleration"), &XYZ, "m/s²", at(F::Acceleration));
    if is_body {
        list.vector(&format!("{name}.center_of_mass"), &XYZ, "m", at(F::CenterOfMass));
    }
}

/// Signals of every body with a contact, every joint with limits, every closure.
fn contact_signals(list: &mut List, model: &Model<f64>) {
    use ContactQuantity as Q;
    let set = model.constraints();
    for (i, frame) in model.names().frames.iter().enumerate() {
        if !set.colliders.iter().any(|c| c.body.is_some_and(|body| body.index() == i)) {
            continue;
        }
        let at = |quantity: Q| move |k: usize| Probe::Contact(quantity, i, k);
        let name = &frame.name;
        list.vector(&format!("{name}.contact_force"), &XYZ, "N", at(Q::Force));
        list.vector(&format!("{name}.contact_torque"), &XYZ, "N·m", at(Q::Torque));
        list.vector(&format!("{name}.contact_point"), &XYZ, "m", at(Q::Point));
        list.vector(&format!("{name}.contact_normal"), &XYZ, "1", at(Q::Normal));
        list.add(format!("{name}.normal_force"), "N", Probe::Contact(Q::NormalForce, i, 0));
        list.add(format!("{name}.friction_force"), "N", Probe::Contact(Q::FrictionForce, i, 0));
        list.add(format!("{name}.contacts"), "1", Probe::Contact(Q::Count, i, 0));
    }
    for joint in &model.names().joints {
        let torque = if matches!(joint.kind, JointKind::Prismatic { .. }) { "N" } else { "N·m" };
        if joint.n_v == 1 && set.limits.iter().any(|l| l.dof == joint.v_idx) {
            list.add(format!("{}.limit_torque", joint.name), torque, Probe::LimitTorque(joint.v_idx));
        }
    }
    let closures = set.loop_joints.iter().map(|c| (&c.name, "m"));
    // of a gear in the unit of its second joint
    let gears = set.gears.iter().map(|gear| {
        let second = model.names().joint_of(gear.dofs[1]);
        (&gear.name, if matches!(second.kind, JointKind::Prismatic { .. }) { "m" } else { "rad" })
    });
    for (k, (name, unit)) in closures.chain(gears).enumerate() {
        list.add(format!("{name}.opening"), unit, Probe::Opening(k));
    }
}

fn world_signals(list: &mut List) {
    use EnergyQuantity as E;
    let energies = [
        ("kinetic", E::Kinetic),
        ("potential", E::Potential),
        ("total", E::Total),
        ("work", E::Work),
        ("dissipated", E::Dissipated),
        ("balance", E::Balance),
    ];
    for (name, quantity) in energies {
        list.add(format!("energy.{name}"), "J", Probe::Energy(quantity));
    }
    list.vector("momentum.angular", &XYZ, "kg·m²/s", Probe::Momentum);
    list.vector("momentum.linear", &XYZ, "kg·m/s", |k| Probe::Momentum(3 + k));
}

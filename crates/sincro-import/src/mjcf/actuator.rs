//! Actuators: on joints gain and bias become a torque motor, a spring-damper motor, or a tendon of the joint with a
//! damper and an actuator, on tendons a tendon with an actuator, on sites a force that is commanded. Activations of
//! first order are those of motors and tendons.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::law::{Law, Transmission};
use super::record::ActuatorRecord;
use crate::findings::Findings;
use crate::number::list;
use crate::robot::{Activation, Actuator, CommandedForce, Motor, MotorLaw, Robot, Tendon, TendonPath};
use crate::source::Element;

/// Part of the robot that an actuator becomes.
enum Made {
    Motor(Motor, Unit),
    Tendon(Tendon, Unit),
    Force(CommandedForce),
}

/// Unit of commands and activations: `scale` times the control, or the activation, plus `offset`.
#[derive(Clone, Copy)]
pub(super) struct Unit {
    pub scale: f64,
    pub offset: f64,
    /// True for a command that is a rate, that of an integrator: it has no offset.
    is_rate: bool,
    /// Range that the control is clamped to.
    range: Option<[f64; 2]>,
}

impl Unit {
    fn new(law: &Law, scale: f64, offset: f64) -> Self {
        let is_rate = law.activation.is_some_and(|own| own.time_constant.is_none());
        Self { scale, offset, is_rate, range: law.control }
    }

    /// A control as it acts: the end of its range that is nearest, or the control within it.
    pub fn clamped(&self, control: f64) -> f64 {
        self.range.map_or(control, |[low, high]| control.max(low).min(high))
    }

    /// Command of a control.
    pub fn command(&self, control: f64) -> f64 {
        self.scale * self.clamped(control) + if self.is_rate { 0.0 } else { self.offset }
    }
}

/// An actuator as keyframes refer to it.
pub(super) struct KnownActuator {
    /// The actuator in the robot; none if it is left out or a force.
    pub made: Option<(Actuator, Unit)>,
    /// Number of activations that MuJoCo has of it.
    pub n_activations: usize,
    /// Number of controls that MuJoCo has of it.
    pub n_controls: usize,
    /// Activation in the robot, in the unit of its command.
    pub activation: Option<Activation>,
}

impl<'d> Reader<'d> {
    /// All actuators.
    pub(super) fn actuators(&mut self, actuators: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for element in self.files.elements(actuators) {
            if element.name() == "plugin" {
                findings.error(element.error("actuators of plugins have no counterpart"));
                continue;
            }
            element.keep();
            element.attribute("name");
            let Some(record) = findings.take(self.defaults.actuator(element)) else { continue };
            let (n_activations, n_controls) = (record.law.n_activations(), record.law.n_controls());
            let mut known = KnownActuator { made: None, n_activations, n_controls, activation: None };
            match findings.take(self.actuator(element, &record, robot)) {
                Some(Ok(Made::Motor(motor, unit))) => {
                    (known.made, known.activation) = (Some((Actuator::Motor(motor.joint), unit)), motor.activation);
                    robot.motors.push(motor);
                }
                Some(Ok(Made::Tendon(tendon, unit))) => {
                    let own = Actuator::Tendon(robot.tendons.len());
                    (known.made, known.activation) = (Some((own, unit)), tendon.activation);
                    robot.tendons.push(tendon);
                }
                Some(Ok(Made::Force(force))) => robot.forces.push(force),
                Some(Err(why)) => {
                    findings.warn(element.error(format!("actuator is left out: {why}")));
                    element.drop(&why);
                }
                None => {}
            }
            self.actuators.push(known);
        }
    }

    fn actuator(
        &self,
        e: Element<'d>,
        record: &ActuatorRecord<'d>,
        robot: &Robot,
    ) -> Result<Result<Made, String>, Diagnostic> {
        if e.peek("tendon").is_some() {
            self.on_tendon(e, record, robot)
        } else if e.peek("site").is_some() {
            self.on_site(e, record, robot)
        } else if let Some(name) = e.attribute("joint").or_else(|| e.attribute("jointinparent")) {
            self.on_joint(e, record, name, robot)
        } else {
            let on = ["body", "cranksite"].into_iter().find(|key| e.peek(key).is_some());
            Ok(Err(format!("it acts on a {}, and motors here act on joints", on.unwrap_or("thing without name"))))
        }
    }

    fn on_tendon(
        &self,
        e: Element<'d>,
        record: &ActuatorRecord<'d>,
        robot: &Robot,
    ) -> Result<Result<Made, String>, Diagnostic> {
        let Some(known) = self.tendon_of(e, "tendon")? else { return Ok(Err("it names no tendon".into())) };
        let transmission = Transmission {
            range: known.range,
            called: "its tendon".into(),
            path: known.path.clone(),
            offset: known.offset,
            gear: record.gear[0],
        };
        let law = match self.law(e, record, &transmission, robot)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        Ok(self.along(e, &law, &transmission))
    }

    fn on_joint(
        &self,
        e: Element<'d>,
        record: &ActuatorRecord<'d>,
        name: &str,
        robot: &Robot,
    ) -> Result<Result<Made, String>, Diagnostic> {
        let Some(&joint) = self.joints.get(name) else {
            return Err(e.error(format!("there is no joint `{name}`")));
        };
        if robot.joints[joint].kind.dofs() != 1 {
            return Ok(Err("its joint has not one degree of freedom".into()));
        }
        let transmission = Transmission {
            // of the parent's side there is none in MuJoCo
            range: self.ranges.get(&joint).copied().filter(|_| e.peek("joint").is_some()),
            called: format!("joint `{name}`"),
            path: Ok(TendonPath::Joints(vec![(joint, 1.0)])),
            offset: self.references[joint],
            gear: record.gear[0],
        };
        let law = match self.law(e, record, &transmission, robot)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        // a spring motor takes no command without stiffness, and no constant
        if law.bias[0] != 0.0 || (law.bias != [0.0; 3] && law.bias[1] == 0.0 && law.gain != 0.0) {
            return Ok(self.along(e, &law, &transmission));
        }
        if robot.motors.iter().any(|m| m.joint == joint) {
            return Ok(Err("a joint has one motor, and this one has it already".into()));
        }
        Ok(self.motor(e, (joint, robot.joints[joint].effort), &law, transmission.gear))
    }

    /// Motor of a joint with a law, with the largest torque that the joint takes from it.
    fn motor(
        &self,
        e: Element<'d>,
        (joint, effort): (usize, Option<f64>),
        law: &Law,
        gear: f64,
    ) -> Result<Made, String> {
        let is_servo = law.bias != [0.0; 3];
        let (force, control) = force_limits(e, law, gear, !is_servo);
        let max_torque = force.into_iter().chain(control).chain(effort).reduce(f64::min);
        let (stiffness, damping) = (-law.bias[1] * gear * gear, -law.bias[2] * gear * gear);
        let (own, unit) = if !is_servo {
            (MotorLaw::Torque, Unit::new(law, law.gain * gear, 0.0))
        } else if stiffness >= 0.0 && damping >= 0.0 {
            // without gain it has no command
            let scale = if law.gain == 0.0 { 0.0 } else { -law.gain / (law.bias[1] * gear) };
            (MotorLaw::Spring(stiffness, damping), Unit::new(law, scale, -self.references[joint]))
        } else {
            return Err(no_spring(law));
        };
        let activation = scaled_activation(e, law, unit);
        let with = if activation.is_some() { " with an activation" } else { "" };
        let scale = unit.scale;
        e.change(&match own {
            MotorLaw::Torque => format!("a torque motor{with}: its command is {scale} times the control"),
            MotorLaw::Spring(..) if scale == 0.0 => {
                "a spring motor: stiffness and damping of the joint; its gain is 0, and it has no command".into()
            }
            MotorLaw::Spring(..) => {
                let what = if activation.is_some() { "the activation is" } else { "its command is" };
                format!("a spring motor{with}: stiffness and damping of the joint, {what} the position")
            }
        });
        if let (Some([low, high]), None, true) = (law.control, activation, is_servo && scale != 0.0) {
            e.change(&format!("the range of its control, from {low} to {high}, is left out: commands have no limits"));
        }
        let command = start(e, unit);
        Ok(Made::Motor(Motor { joint, law: own, max_torque, command, activation }, unit))
    }

    /// Actuator along a path with a law: a tendon of its own, whose command is a force.
    fn along(&self, e: Element<'d>, law: &Law, transmission: &Transmission) -> Result<Made, String> {
        let path = match &transmission.path {
            Ok(path) => path.clone(),
            Err(why) => return Err(format!("its tendon has no counterpart: {why}")),
        };
        let gear = transmission.gear;
        let (force, control) = force_limits(e, law, gear, true);
        let (stiffness, damping) = (-law.bias[1] * gear * gear, -law.bias[2] * gear * gear);
        if stiffness < 0.0 || damping < 0.0 {
            return Err(no_spring(law));
        }
        let unit = Unit::new(law, law.gain * gear, 0.0);
        let activation = scaled_activation(e, law, unit);
        let is_servo = law.bias != [0.0; 3];
        let max_force = if is_servo { control } else { force.into_iter().chain(control).reduce(f64::min) };
        let what = match (e.peek("tendon"), is_servo) {
            (None, _) => format!("a [[tendon]] of {}, a spring and damper with an actuator", transmission.called),
            (_, true) => "a spring and damper with an actuator".into(),
            (_, false) => "an actuator".into(),
        };
        let without = if is_servo && force.is_some() { "; `forcerange` is left out" } else { "" };
        e.change(&format!("{what}: its command, a force, is {} times the control{without}", unit.scale));
        let on = e.peek("tendon").or(e.peek("joint")).or(e.peek("jointinparent")).unwrap_or("tendon");
        let tendon = Tendon {
            name: e.peek("name").map_or_else(|| format!("{on}-actuator"), str::to_owned),
            at: e.location(),
            path,
            stiffness,
            damping,
            preload: gear * law.bias[0],
            free_length: [-transmission.offset; 2],
            limits: None,
            actuator: Some(max_force.unwrap_or(f64::INFINITY)),
            command: start(e, unit),
            activation,
        };
        Ok(Made::Tendon(tendon, unit))
    }

    /// Actuator on a site: the force and torque along its axes that one unit of the control gives.
    fn on_site(
        &self,
        e: Element<'d>,
        record: &ActuatorRecord<'d>,
        robot: &Robot,
    ) -> Result<Result<Made, String>, Diagnostic> {
        let name = e.attribute("site").unwrap_or_default();
        let Some(&link) = self.sites.get(name) else { return Err(e.error(format!("there is no site `{name}`"))) };
        if e.peek("refsite").is_some() {
            return Ok(Err("it acts between two sites".into()));
        }
        let transmission = Transmission {
            range: None,
            called: "a site".into(),
            path: Err("a force on a site has no path".into()),
            offset: 0.0,
            gear: if record.gear == [0.0; 6] { 0.0 } else { 1.0 },
        };
        let law = match self.law(e, record, &transmission, robot)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        if law.activation.is_some() {
            return Ok(Err("its activation has no counterpart on a site".into()));
        }
        if law.bias != [0.0; 3] {
            return Ok(Err(format!("its bias {:?} has no counterpart on a site", law.bias)));
        }
        let wrench: [f64; 6] = record.gear.map(|x| law.gain * x);
        let (force, torque) = (list(&wrench[..3]), list(&wrench[3..]));
        e.change(&format!(
            "a [[force]] with input, in its axes: force {force} N, torque {torque} N·m for a control of 1"
        ));
        let control = Unit::new(&law, 1.0, 0.0).clamped(0.0);
        if control != 0.0 {
            e.change(&format!("the force starts at zero, not at that of a control of {control}, the end of its range"));
        }
        let name = e.peek("name").map_or_else(|| format!("{name}-force"), str::to_owned);
        Ok(Ok(Made::Force(CommandedForce { name, at: e.location(), link, wrench })))
    }
}

/// Largest forces: from the range of the force, and from that of the control, if that is a force: not with an
/// activation.
fn force_limits(e: Element<'_>, law: &Law, gear: f64, is_force: bool) -> (Option<f64>, Option<f64>) {
    let largest = |name: &str, range: Option<[f64; 2]>| {
        range.map(|[low, high]| {
            if low != -high {
                let words = "has two ends that differ: the larger one bounds the force in both directions";
                e.change(&format!("`{name}` {words}"));
            }
            low.abs().max(high.abs())
        })
    };
    let force = largest("forcerange", law.force).map(|force| force * gear.abs());
    let control = law.control.filter(|_| is_force && law.activation.is_none());
    let control = largest("ctrlrange", control).map(|control| (control * law.gain * gear).abs());
    (force.filter(|x| *x > 0.0), control.filter(|x| *x > 0.0))
}

/// Activation of an actuator in the unit of its command, if it has one and a command.
fn scaled_activation(e: Element<'_>, law: &Law, unit: Unit) -> Option<Activation> {
    let own = law.activation.filter(|_| unit.scale != 0.0)?.scaled(unit.scale, unit.offset);
    if own.initial != unit.offset {
        e.change("its activation starts at the end of its range, since zero is outside");
    }
    Some(own)
}

/// Command at the start: that of a control of zero.
fn start(e: Element<'_>, unit: Unit) -> f64 {
    let control = unit.clamped(0.0);
    if control != 0.0 && unit.scale != 0.0 {
        e.change(&format!("its control starts at {control}, the end of its range, since zero is outside"));
    }
    unit.command(0.0)
}

fn no_spring(law: &Law) -> String {
    format!("its bias {:?} is no spring and damper", law.bias)
}

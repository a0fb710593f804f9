//! Actuators: on joints gain and bias become a torque motor or a spring-damper motor, on tendons a tendon with an
//! actuator, on sites a force that is commanded. Activations of first order are those of motors and tendons.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::law::{Law, Target};
use crate::export::UNLIMITED;
use crate::findings::Findings;
use crate::number::list;
use crate::robot::{Actuator, CommandedForce, Motor, MotorLaw, Robot, Tendon, TendonPath};
use crate::source::Element;

/// Part of the robot that an actuator becomes.
enum Made {
    Motor(Motor, Unit),
    Tendon(Tendon, Unit),
    Force(CommandedForce),
}

/// Unit of a command: `scale` times the control, or the activation, plus `offset`; the rate of an integrator has none.
#[derive(Clone, Copy)]
pub(super) struct Unit {
    pub scale: f64,
    pub offset: f64,
}

/// An actuator as keyframes refer to it.
pub(super) struct KnownActuator {
    /// The actuator in the robot; none if it is left out or a force.
    pub made: Option<(Actuator, Unit)>,
    /// True if MuJoCo has an activation of it.
    pub is_activated: bool,
    /// Activation in the robot, in the unit of its command.
    pub activation: Option<crate::robot::Activation>,
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
            let mut known = KnownActuator { made: None, is_activated: self.is_activated(element), activation: None };
            match findings.take(self.actuator(element, robot)) {
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

    fn actuator(&self, e: Element<'d>, robot: &Robot) -> Result<Result<Made, String>, Diagnostic> {
        let d = &self.defaults;
        if e.peek("tendon").is_some() {
            let gear = d.number(e, "main", "gear")?.unwrap_or(1.0);
            let known = self.tendon_of(e, "tendon")?;
            let path = known.and_then(|tendon| tendon.path.clone().ok());
            let target = Target { range: known.and_then(|tendon| tendon.range), name: "its tendon", path, gear };
            return Ok(match self.law(e, target, robot)? {
                Ok(law) => {
                    let (force, control) = self.force_limits(e, &law, gear, true)?;
                    let unit = Unit { scale: law.gain * gear, offset: 0.0 };
                    let made = self.tendon_actuator(e, (&law, gear), (force, control))?;
                    made.map(|tendon| Made::Tendon(tendon, unit))
                }
                Err(why) => Err(why),
            });
        }
        if e.peek("site").is_some() {
            return self.on_site(e, robot);
        }
        let Some(name) = e.attribute("joint").or_else(|| e.attribute("jointinparent")) else {
            let on = ["body", "cranksite"].into_iter().find(|key| e.peek(key).is_some());
            return Ok(Err(format!(
                "it acts on a {}, and motors here act on joints",
                on.unwrap_or("thing without name")
            )));
        };
        let Some(&joint) = self.joints.get(name) else {
            return Err(e.error(format!("there is no joint `{name}`")));
        };
        if robot.joints[joint].kind.dofs() != 1 {
            return Ok(Err("its joint has not one degree of freedom".into()));
        }
        if robot.motors.iter().any(|m| m.joint == joint) {
            return Ok(Err("a joint has one motor, and this one has it already".into()));
        }
        let gear = d.number(e, "main", "gear")?.unwrap_or(1.0);
        let (range, called) = (self.ranges.get(&joint).copied(), format!("joint `{name}`"));
        let law = match self.law(
            e,
            Target { range, name: &called, path: Some(TendonPath::Joints(vec![(joint, 1.0)])), gear },
            robot,
        )? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        if gear == 0.0 || (law.gain == 0.0 && law.bias == [0.0; 3]) {
            return Ok(Err(no_force(gear).into()));
        }
        let is_servo = law.bias != [0.0; 3];
        let (force, control) = self.force_limits(e, &law, gear, !is_servo)?;
        let limit = force.into_iter().chain(control).reduce(f64::min);
        let reference = self.references[joint];
        let (stiffness, damping) = (-law.bias[1] * gear * gear, -law.bias[2] * gear * gear);
        let is_lagged = law.activation.is_some();
        // command of the motor for a control of 1
        let (made, command, scale) = if law.bias == [0.0; 3] {
            let scale = law.gain * gear;
            e.change(&format!("a torque motor{}: its command is {scale} times the control", with(is_lagged)));
            (MotorLaw::Torque, 0.0, scale)
        } else if law.bias[0] == 0.0 && stiffness >= 0.0 && damping >= 0.0 {
            if is_lagged && stiffness == 0.0 {
                return Ok(Err("it is a damper whose command has an activation".into()));
            }
            let what = if is_lagged { "the activation is" } else { "its command is" };
            let with = with(is_lagged);
            e.change(&format!("a spring motor{with}: stiffness and damping of the joint, {what} the position"));
            // a damper has no command
            let scale = if stiffness == 0.0 { 0.0 } else { -law.gain / (law.bias[1] * gear) };
            (MotorLaw::Spring(stiffness, damping), -reference, scale)
        } else {
            return Ok(Err(format!("its bias {:?} is no spring and damper", law.bias)));
        };
        let activation = law.activation.filter(|_| scale != 0.0).map(|own| own.scaled(scale, command));
        if activation.is_some_and(|own| own.initial != command) {
            e.change("its activation starts at the end of its range, since zero is outside");
        }
        if let (Some([low, high]), None, true) = (law.control, activation, is_servo) {
            e.change(&format!("the range of its control, from {low} to {high}, is left out: commands have no limits"));
        }
        let unit = Unit { scale, offset: command };
        // the command of an integrator is a rate
        let command = if activation.is_some_and(|own| own.time_constant.is_none()) { 0.0 } else { command };
        Ok(Ok(Made::Motor(Motor { joint, law: made, max_torque: limit, command, activation }, unit)))
    }

    /// Actuator on a site: the force and torque along its axes that one unit of the control gives.
    fn on_site(&self, e: Element<'d>, robot: &Robot) -> Result<Result<Made, String>, Diagnostic> {
        let name = e.attribute("site").unwrap_or_default();
        let Some(&link) = self.sites.get(name) else { return Err(e.error(format!("there is no site `{name}`"))) };
        if e.peek("refsite").is_some() {
            return Ok(Err("it acts between two sites".into()));
        }
        let law = match self.law(e, Target { range: None, name: "a site", path: None, gear: 1.0 }, robot)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        if law.gain == 0.0 {
            return Ok(Err(no_force(1.0).into()));
        }
        if law.activation.is_some() {
            return Ok(Err("its activation has no counterpart on a site".into()));
        }
        if law.bias != [0.0; 3] {
            return Ok(Err(format!("its bias {:?} has no counterpart on a site", law.bias)));
        }
        let gear = self.defaults.numbers(e, "main", "gear")?.unwrap_or_else(|| vec![1.0]);
        let wrench: [f64; 6] = std::array::from_fn(|k| law.gain * gear.get(k).copied().unwrap_or(0.0));
        let (force, torque) = (list(&wrench[..3]), list(&wrench[3..]));
        e.change(&format!(
            "a [[force]] with input, in its axes: force {force} N, torque {torque} N·m for a control of 1"
        ));
        let name = e.peek("name").map_or_else(|| format!("{name}-force"), str::to_owned);
        Ok(Ok(Made::Force(CommandedForce { name, at: e.location(), link, wrench })))
    }

    /// Largest forces: from the range of the force, and from that of the control, if that is a force: not with an
    /// activation.
    fn force_limits(
        &self,
        e: Element<'d>,
        law: &Law,
        gear: f64,
        is_force: bool,
    ) -> Result<(Option<f64>, Option<f64>), Diagnostic> {
        let largest = |name: &str, range: Option<[f64; 2]>| {
            range.map(|[low, high]| {
                if low != -high {
                    let words = "has two ends that differ: the larger one bounds the force in both directions";
                    e.change(&format!("`{name}` {words}"));
                }
                low.abs().max(high.abs())
            })
        };
        let force = largest("forcerange", self.limiting_range(e, "forcerange", "forcelimited")?);
        let control = law.control.filter(|_| is_force && law.activation.is_none());
        let control = largest("ctrlrange", control).map(|u| (u * law.gain * gear).abs());
        Ok((force.map(|f| f * gear.abs()).filter(|x| *x > 0.0), control.filter(|x| *x > 0.0)))
    }
}

/// End of a range, infinite where MuJoCo's largest number stands for none.
pub(super) fn without_limit(x: f64) -> f64 {
    if x.abs() >= UNLIMITED { x * f64::INFINITY } else { x }
}

/// Reason why an actuator exerts no force.
pub(super) fn no_force(gear: f64) -> &'static str {
    if gear == 0.0 { "its `gear` is 0: it exerts no force" } else { "its gain is 0: it exerts no force" }
}

/// Words for a motor that has an activation.
fn with(has_activation: bool) -> &'static str {
    if has_activation { " with an activation" } else { "" }
}

//! Actuators: on joints gain and bias become a torque motor or a spring-damper motor, on tendons a tendon with an
//! actuator, on sites a force that is commanded. Activations of first order are those of motors and tendons.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use crate::export::UNLIMITED;
use crate::findings::Findings;
use crate::number::list;
use crate::robot::{Activation, CommandedForce, Motor, MotorLaw, Robot, Tendon};
use crate::source::Element;

/// Force = gain·u + bias₀ + bias₁·length + bias₂·rate, with the activation in the place of the control u if there is
/// one.
pub(super) struct Law {
    pub gain: f64,
    pub bias: [f64; 3],
    pub activation: Option<Activation>,
}

/// Part of the robot that an actuator becomes.
enum Made {
    Motor(Motor),
    Tendon(Tendon),
    Force(CommandedForce),
}

impl<'d> Reader<'d> {
    /// All actuators.
    pub(super) fn actuators(&self, actuators: Element<'d>, robot: &mut Robot, findings: &mut Findings) {
        for element in self.files.elements(actuators) {
            if element.name() == "plugin" {
                findings.error(element.error("actuators of plugins have no counterpart"));
                continue;
            }
            element.keep();
            element.attribute("name");
            match findings.take(self.actuator(element, robot)) {
                Some(Ok(Made::Motor(motor))) => robot.motors.push(motor),
                Some(Ok(Made::Tendon(tendon))) => robot.tendons.push(tendon),
                Some(Ok(Made::Force(force))) => robot.forces.push(force),
                Some(Err(why)) => {
                    findings.warn(element.error(format!("actuator is left out: {why}")));
                    element.drop(&why);
                }
                None => {}
            }
        }
    }

    fn actuator(&self, e: Element<'d>, robot: &Robot) -> Result<Result<Made, String>, Diagnostic> {
        let d = &self.defaults;
        if e.peek("tendon").is_some() {
            let gear = d.number(e, "main", "gear")?.unwrap_or(1.0);
            return Ok(match self.activated_law(e, None)? {
                Ok(law) => {
                    let (force, control) = self.force_limits(e, &law, gear)?;
                    // the control of one with an activation is no force
                    let control = control.filter(|_| law.activation.is_none());
                    self.tendon_actuator(e, (&law, gear), (force, control))?.map(Made::Tendon)
                }
                Err(why) => Err(why),
            });
        }
        if e.peek("site").is_some() {
            return self.on_site(e);
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
        let law = match self.activated_law(e, robot.joints[joint].limits)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        let (force, control) = self.force_limits(e, &law, gear)?;
        let control = control.filter(|_| law.bias == [0.0; 3] && law.activation.is_none());
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
            (MotorLaw::Spring(stiffness, damping), -reference, -law.gain / (law.bias[1] * gear))
        } else {
            return Ok(Err(format!("its bias {:?} is no spring and damper", law.bias)));
        };
        let activation = law.activation.map(|own| own.scaled(scale, command));
        // the command of an integrator is a rate
        let command = if activation.is_some_and(|own| own.time_constant.is_none()) { 0.0 } else { command };
        Ok(Ok(Made::Motor(Motor { joint, law: made, max_torque: limit, command, activation })))
    }

    /// Actuator on a site: the force and torque along its axes that one unit of the control gives.
    fn on_site(&self, e: Element<'d>) -> Result<Result<Made, String>, Diagnostic> {
        let name = e.attribute("site").unwrap_or_default();
        let Some(&link) = self.sites.get(name) else { return Err(e.error(format!("there is no site `{name}`"))) };
        if e.peek("refsite").is_some() {
            return Ok(Err("it acts between two sites".into()));
        }
        let law = match self.activated_law(e, None)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
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

    /// The law with its activation, for a joint with a `range`; the reason if it has no counterpart.
    fn activated_law(&self, e: Element<'d>, range: Option<[f64; 2]>) -> Result<Result<Law, String>, Diagnostic> {
        let d = &self.defaults;
        let number = |name: &str| d.number(e, "main", name);
        let law = match self.law(e)? {
            Ok(law) => law,
            Err(why) => return Ok(Err(why)),
        };
        let time_constant = match (e.name(), d.text(e, "main", "dyntype")) {
            ("position", _) => match number("timeconst")?.filter(|time| *time > 0.0) {
                Some(time) => Some(time),
                None => return Ok(Ok(law)),
            },
            ("cylinder", _) => Some(number("timeconst")?.unwrap_or(1.0)),
            ("intvelocity", _) => None,
            ("general", Some("integrator")) => None,
            ("general", Some("filter" | "filterexact")) => {
                let all = d.numbers(e, "main", "dynprm")?;
                Some(all.and_then(|all| all.first().copied()).unwrap_or(1.0))
            }
            ("general", Some(other)) if other != "none" => {
                return Ok(Err(format!("its activation is of type `{other}`")));
            }
            _ => return Ok(Ok(law)),
        };
        if d.text(e, "main", "actearly") == Some("true") {
            e.change("`actearly` is of steps in time, and has no effect here");
        }
        let mut limits = self.limiting_range(e, "actrange", "actlimited")?;
        if let ("intvelocity", Some(share), Some([low, high])) = (e.name(), number("inheritrange")?, range)
            && share > 0.0
        {
            let (middle, half) = (0.5 * (low + high), 0.5 * share * (high - low));
            limits = Some([middle - half, middle + half]);
        }
        let input_range = self.limiting_range(e, "ctrlrange", "ctrllimited")?;
        // a time constant of zero has no lag
        let activation = match time_constant {
            Some(time) if time <= 0.0 => None,
            time_constant => Some(Activation { time_constant, input_range, range: limits, initial: 0.0 }),
        };
        Ok(Ok(Law { activation, ..law }))
    }

    fn law(&self, e: Element<'d>) -> Result<Result<Law, String>, Diagnostic> {
        let d = &self.defaults;
        let number = |name: &str| d.number(e, "main", name);
        Ok(Ok(match e.name() {
            "motor" => Law { gain: 1.0, bias: [0.0; 3], activation: None },
            "position" => {
                let kp = number("kp")?.unwrap_or(1.0);
                if number("dampratio")?.is_some_and(|r| r > 0.0) {
                    return Ok(Err("its damping is a ratio, which needs the inertia at the start".into()));
                }
                Law { gain: kp, bias: [0.0, -kp, -number("kv")?.unwrap_or(0.0)], activation: None }
            }
            "intvelocity" => {
                let kp = number("kp")?.unwrap_or(1.0);
                if number("dampratio")?.is_some_and(|r| r > 0.0) {
                    return Ok(Err("its damping is a ratio, which needs the inertia at the start".into()));
                }
                Law { gain: kp, bias: [0.0, -kp, -number("kv")?.unwrap_or(0.0)], activation: None }
            }
            "cylinder" => {
                let of_diameter = number("diameter")?.map(|d| core::f64::consts::FRAC_PI_4 * d * d);
                let area = of_diameter.or(number("area")?).unwrap_or(1.0);
                let list = d.numbers(e, "main", "bias")?.unwrap_or_default();
                let bias = std::array::from_fn(|k| list.get(k).copied().unwrap_or(0.0));
                Law { gain: area, bias, activation: None }
            }
            "velocity" => {
                let kv = number("kv")?.unwrap_or(1.0);
                e.change("a damper: its command, a velocity, is left out");
                Law { gain: kv, bias: [0.0, 0.0, -kv], activation: None }
            }
            "general" => {
                let kinds = ["gaintype", "biastype"].map(|key| d.text(e, "main", key));
                if !matches!(kinds[0], None | Some("fixed")) {
                    return Ok(Err(format!("its gain is of type `{}`", kinds[0].unwrap_or(""))));
                }
                let gain = number("gainprm")?.unwrap_or(1.0);
                let list = d.numbers(e, "main", "biasprm")?.unwrap_or_default();
                let get = |k: usize| list.get(k).copied().unwrap_or(0.0);
                match kinds[1] {
                    None | Some("none") => Law { gain, bias: [0.0; 3], activation: None },
                    Some("affine") => Law { gain, bias: [get(0), get(1), get(2)], activation: None },
                    Some(other) => return Ok(Err(format!("its bias is of type `{other}`"))),
                }
            }
            other => return Ok(Err(format!("a `{other}` has no counterpart"))),
        }))
    }

    /// Largest forces: from the range of the force, and from that of the control.
    fn force_limits(&self, e: Element<'d>, law: &Law, gear: f64) -> Result<(Option<f64>, Option<f64>), Diagnostic> {
        let largest = |name: &str, flag: &str| -> Result<Option<f64>, Diagnostic> {
            Ok(self.limiting_range(e, name, flag)?.map(|[low, high]| low.abs().max(high.abs())))
        };
        let force = largest("forcerange", "forcelimited")?.map(|f| f * gear.abs());
        let control = largest("ctrlrange", "ctrllimited")?.map(|u| (u * law.gain * gear).abs());
        Ok((force.filter(|x| *x > 0.0), control.filter(|x| *x > 0.0)))
    }

    /// The range of that name, if its `flag` says that it limits.
    fn limiting_range(&self, e: Element<'d>, name: &str, flag: &str) -> Result<Option<[f64; 2]>, Diagnostic> {
        let d = &self.defaults;
        let range = d.numbers(e, "main", name)?;
        let on = match d.text(e, "main", flag) {
            Some("true") => true,
            Some("false") => false,
            _ => self.settings.autolimits,
        };
        Ok(match range.as_deref() {
            Some(&[low, high]) if on => Some([low, high].map(without_limit)),
            _ => None,
        })
    }
}

/// End of a range, infinite where MuJoCo's largest number stands for none.
pub(super) fn without_limit(x: f64) -> f64 {
    if x.abs() >= UNLIMITED { x * f64::INFINITY } else { x }
}

/// Words for a motor that has an activation.
fn with(has_activation: bool) -> &'static str {
    if has_activation { " with an activation" } else { "" }
}

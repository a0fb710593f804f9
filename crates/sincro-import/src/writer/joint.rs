//! Joints, their start and their motors.

use super::{Context, Writer, last};
use crate::Motors;
use crate::number::{list, number, quoted};
use crate::robot::{Activation, Joint, JointKind, MotorLaw, Robot};
use crate::source::ElementStatus;

/// Velocity a unit of error of the motors that hold [1/s].
const HOLDING_GAIN: f64 = 10.0;

/// Deflection at which motors that hold as springs reach their largest torque [rad]: a smaller one is stiffer.
const YIELD_ANGLE: f64 = 0.1;

/// Deflection at which those of prismatic joints reach their largest force [m].
const YIELD_LENGTH: f64 = 0.01;

/// Damping of these motors over their stiffness [s]: what swings faster than once in 2π of it is held back by it.
const DAMPING_TIME: f64 = 0.02;

/// Coordinates at the start: zero where the limits allow it, else the middle of the range; gears as they are coupled.
pub(super) fn starts(robot: &mut Robot, context: &Context<'_>) -> Vec<f64> {
    let one = |joint: &Joint| joint.kind.dofs() == 1;
    // loops are closed at zero coordinates
    let has_loops = robot.loops.iter().any(|l| l.softness.is_none());
    let mut starts: Vec<f64> = robot
        .joints
        .iter()
        .map(|joint| match (&joint.initial, joint.limits) {
            (Some(given), _) if one(joint) => given.first().copied().unwrap_or(0.0),
            (_, Some([lower, upper])) if !has_loops && (lower > 0.0 || upper < 0.0) => middle(lower, upper),
            _ => 0.0,
        })
        .collect();
    // gears may drive gears: as many rounds as there are
    for _ in 0..robot.gears.len() {
        for gear in &robot.gears {
            starts[gear.joints[1]] = gear.second(starts[gear.joints[0]]);
        }
    }
    for (joint, start) in robot.joints.iter_mut().zip(&starts) {
        let Some([lower, upper]) = joint.limits else { continue };
        if *start < lower || *start > upper {
            let words = format!(
                "it starts at {}, outside its limits from {lower} to {upper}, which are left out",
                number(*start)
            );
            context.ledger.judge_place(joint.element, ElementStatus::Changed, &words);
            joint.limits = None;
        } else if *start != 0.0 && joint.initial.is_none() && robot.gears.iter().all(|g| joint.name != g.name) {
            let words = format!("zero is outside its limits: it starts at {}", number(*start));
            context.ledger.judge_place(joint.element, ElementStatus::Changed, &words);
        }
    }
    starts
}

fn middle(lower: f64, upper: f64) -> f64 {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => 0.5 * (lower + upper),
        (true, false) => lower,
        _ => upper,
    }
}

/// Key of an activation, as an inline table.
pub(super) fn activation(own: &Activation) -> String {
    let kind = match own.time_constant {
        Some(time_constant) => format!("kind = \"filter\", time_constant = {}", number(time_constant)),
        None => "kind = \"integrator\"".to_owned(),
    };
    let range = |key: &str, range: Option<[f64; 2]>| {
        let ends = range.map(|[lower, upper]| [("lower", lower), ("upper", upper)])?;
        let ends = ends.into_iter().filter(|(_, x)| x.is_finite()).map(|(end, x)| format!("{end} = {}", number(x)));
        Some(format!(", {key} = {{ {} }}", ends.collect::<Vec<_>>().join(", ")))
    };
    let ranges = [range("range", own.range), range("input_range", own.input_range)].into_iter().flatten();
    let initial = if own.initial == 0.0 { String::new() } else { format!(", initial = {}", number(own.initial)) };
    format!("activation = {{ {kind}{}{initial} }}", ranges.collect::<String>())
}

impl Writer<'_> {
    /// Writes joint `k`; returns its path.
    pub(super) fn joint(&mut self, k: usize, parent: &str) -> String {
        let joint = &self.robot.joints[k];
        let path = self.unique(parent, &joint.name);
        if last(&path) != joint.name {
            self.context.ledger.judge_place(
                joint.element,
                ElementStatus::Changed,
                &format!("its name is `{}`", last(&path)),
            );
        }
        self.line("[[joint]]");
        self.line(&format!("name = {}", quoted(last(&path))));
        if parent != "/" {
            self.line(&format!("parent = {}", quoted(parent)));
        }
        self.line(&format!("kind = \"{}\"", joint.kind.word()));
        match joint.kind {
            JointKind::Revolute | JointKind::Prismatic => self.line(&format!("axis = {}", list(&joint.axis))),
            JointKind::Screw(pitch) => {
                self.line(&format!("axis = {}", list(&joint.axis)));
                self.line(&format!("pitch = {}", number(pitch)));
            }
            JointKind::Universal(axis2) => {
                self.line(&format!("axis = {}", list(&joint.axis)));
                self.line(&format!("axis2 = {}", list(&axis2)));
            }
            _ => {}
        }
        self.placement(&joint.pose);
        self.properties(joint);
        self.start(k, joint);
        self.motor(k, joint);
        self.line("");
        path
    }

    fn properties(&mut self, joint: &Joint) {
        if let Some([lower, upper]) = joint.limits {
            let bound = |key: &str, x: f64| x.is_finite().then(|| format!("{key} = {}", number(x)));
            let bounds: Vec<String> = [bound("lower", lower), bound("upper", upper)].into_iter().flatten().collect();
            if !bounds.is_empty() {
                self.line(&format!("limits = {{ {} }}", bounds.join(", ")));
            }
        }
        for (key, values) in [("damping", &joint.damping), ("friction", &joint.friction), ("armature", &joint.armature)]
        {
            match values.as_slice() {
                values if values.iter().all(|x| *x == 0.0) => {}
                [x] => self.line(&format!("{key} = {}", number(*x))),
                values => self.line(&format!("{key} = {}", list(values))),
            }
        }
        if let Some([stiffness, rest]) = joint.spring {
            let rest = if rest == 0.0 { String::new() } else { format!(", rest = {}", number(rest)) };
            let one = format!("{{ stiffness = {}{rest} }}", number(stiffness));
            match joint.kind.dofs() {
                1 => self.line(&format!("spring = {one}")),
                n => self.line(&format!("spring = [{}]", vec![one; n].join(", "))),
            }
        }
    }

    fn start(&mut self, k: usize, joint: &Joint) {
        match (joint.kind.dofs(), &joint.initial) {
            (1, _) if self.starts[k] != 0.0 => {
                self.line(&format!("initial = {{ position = {} }}", number(self.starts[k])));
            }
            (n, Some(given)) if n > 1 => self.line(&format!("initial = {{ position = {} }}", list(given))),
            _ => {}
        }
    }

    fn motor(&mut self, k: usize, joint: &Joint) {
        let of_source: Vec<_> = self.robot.motors.iter().filter(|m| m.joint == k).collect();
        if let Some(motor) = of_source.first() {
            let limit = motor.max_torque.map_or_else(String::new, |x| format!(", max_torque = {}", number(x)));
            let activation = motor.activation.map_or_else(String::new, |own| format!(", {}", activation(&own)));
            match motor.law {
                MotorLaw::Torque => {
                    let command = if motor.command == 0.0 {
                        String::new()
                    } else {
                        format!(", command = {}", number(motor.command))
                    };
                    self.line(&format!("motor = {{ mode = \"torque\"{command}{limit}{activation} }}"));
                }
                MotorLaw::Spring(stiffness, damping) => {
                    let command = number(motor.command);
                    let (stiffness, damping) = (number(stiffness), number(damping));
                    self.line(&format!(
                        "motor = {{ mode = \"spring\", command = {command}, stiffness = {stiffness}, damping = {damping}{limit}{activation} }}"
                    ));
                }
            }
            return;
        }
        let follows = self.robot.gears.iter().any(|g| g.joints[1] == k);
        if self.robot.has_own_motors || follows || joint.kind.dofs() != 1 {
            return;
        }
        // a motor that can give nothing is a figure left open
        let effort =
            joint.effort.filter(|x| *x > 0.0).map_or_else(String::new, |x| format!(", max_torque = {}", number(x)));
        match self.context.options.motors {
            Motors::None => {}
            Motors::Torque => self.line(&format!("motor = {{ mode = \"torque\"{effort} }}")),
            Motors::Hold => {
                // ideal motors that give way share a load with rigid contacts in more than one way
                let limit = joint.effort.filter(|x| *x > 0.0 && self.floating[joint.child]);
                if let Some(limit) = limit {
                    let deflection = if joint.kind == JointKind::Prismatic { YIELD_LENGTH } else { YIELD_ANGLE };
                    let stiffness = limit / deflection;
                    let (command, damping) = (number(self.starts[k]), number(stiffness * DAMPING_TIME));
                    let stiffness = number(stiffness);
                    return self.line(&format!(
                        "motor = {{ mode = \"spring\", command = {command}, stiffness = {stiffness}, damping = {damping}{effort} }}"
                    ));
                }
                let speed = joint.speed.map_or_else(String::new, |x| format!(", max_velocity = {}", number(x)));
                let (command, gain) = (number(self.starts[k]), number(HOLDING_GAIN));
                self.line(&format!(
                    "motor = {{ mode = \"position\", command = {command}, kp = {gain}{speed}{effort} }}"
                ));
            }
        }
    }
}

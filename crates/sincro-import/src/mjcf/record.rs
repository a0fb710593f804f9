//! Actuator records: everything that the elements of actuators set, in a class of defaults or on an actuator.
//!
//! Source: key `mjcf`, actuator shortcuts, as MuJoCo 4.0 reads them. A class has one record. It starts as that of its
//! parent, each element of an actuator in the class changes it in the order of the file, and an actuator changes a copy
//! of that of its class. Ranges, flags and gear are overwritten where they are given. The law is, too, by a `general`;
//! a shortcut (`position`, `velocity` …) sets it anew: from its own numbers, from a record that it can inherit, the
//! nearest one of its class and the classes around it, or from the format's own defaults. It can inherit a record of
//! its own kind, and one of a `general` with its type of gain.

use sincro_scene::diagnostic::Diagnostic;

use super::defaults::Defaults;
use crate::source::Element;

/// Tags of actuators, which share their defaults.
pub(super) const ACTUATORS: [&str; 12] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "pid",
    "orientation",
    "dcmotor",
];

/// Gain, bias and activation.
#[derive(Clone, Copy)]
pub(super) struct Law<'d> {
    pub gain: f64,
    pub gain_kind: &'d str,
    /// Constant, and coefficients of length and rate; a positive last one of a servo is a damping ratio.
    pub bias: [f64; 3],
    pub bias_kind: &'d str,
    pub dynamics: &'d str,
    /// Time constant of the activation `[s]`.
    pub time: f64,
    /// Number of activations that a `general` asks for.
    pub n_wanted: Option<usize>,
    pub acts_early: bool,
    /// Control inputs, where an element names them.
    inputs: Option<&'d str>,
    /// Kind of the shortcut whose numbers are in the source in the place of these, and unknown here.
    pub foreign: Option<&'d str>,
    /// Numbers by which a `dcmotor` or `pid` has states.
    states: [f64; 5],
}

/// Range of a quantity, with its flag.
#[derive(Clone, Copy, Default)]
pub(super) struct Range {
    pub ends: Option<[f64; 2]>,
    /// True if it limits, false if it does not; none if that follows from the range.
    pub limits: Option<bool>,
}

/// Actuator of a class, or one of the model.
#[derive(Clone, Copy)]
pub(super) struct ActuatorRecord<'d> {
    /// Tag of the element that set it last.
    kind: &'d str,
    pub law: Law<'d>,
    pub control: Range,
    pub activation: Range,
    force: Range,
    pub gear: [f64; 6],
    pub armature: f64,
    /// Coefficients of the rate, and of its higher powers.
    pub damping: [f64; 3],
    /// Ratio of the range of control or activation to that of what the actuator acts on; 0 for none that is inherited.
    inherit_range: f64,
    /// True if the range of the force is in the source that of a `dcmotor`, and unknown here.
    has_motor_force: bool,
}

/// Range that is inherited from what an actuator acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum InheritedRange {
    /// That of the control, by this ratio.
    Control(f64),
    /// That of the activation, by this ratio.
    Activation(f64),
}

/// Attributes of a `dcmotor`, and the number of each that makes a state where it is not zero: current, temperature,
/// bristles, integral of the error and slewed input.
const DCMOTOR_STATES: [(&str, usize); 5] =
    [("inductance", 0), ("thermal", 0), ("lugre", 0), ("controller", 1), ("controller", 3)];

/// Those of a `pid`: integral of the error and slewed input.
const PID_STATES: [(&str, usize); 2] = [("ki", 0), ("slewmax", 0)];

/// Type of gain that a kind of actuator has.
fn gain_kind(kind: &str) -> &str {
    match kind {
        "damper" => "affine",
        "orientation" => "so3",
        "muscle" | "pid" | "dcmotor" => kind,
        _ => "fixed",
    }
}

fn first(e: Element<'_>, key: &str) -> Result<Option<f64>, Diagnostic> {
    Ok(e.numbers(key)?.and_then(|numbers| numbers.first().copied()))
}

/// First number of an attribute that must not be negative.
fn first_not_negative(e: Element<'_>, key: &str) -> Result<Option<f64>, Diagnostic> {
    match first(e, key)? {
        Some(x) if x < 0.0 => Err(e.error(format!("`{key}` is negative"))),
        own => Ok(own),
    }
}

/// Overwrites the first numbers by those of an attribute.
fn overwrite(own: &mut [f64], e: Element<'_>, key: &str) -> Result<(), Diagnostic> {
    own.iter_mut().zip(e.numbers(key)?.unwrap_or_default()).for_each(|(own, given)| *own = given);
    Ok(())
}

impl<'d> Law<'d> {
    const START: Self = Self {
        gain: 1.0,
        gain_kind: "fixed",
        bias: [0.0; 3],
        bias_kind: "none",
        dynamics: "none",
        time: 1.0,
        n_wanted: None,
        acts_early: false,
        inputs: None,
        foreign: None,
        states: [0.0; 5],
    };

    /// Takes the numbers that a `general` gives.
    fn set_general(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        self.gain_kind = e.attribute("gaintype").unwrap_or(self.gain_kind);
        self.bias_kind = e.attribute("biastype").unwrap_or(self.bias_kind);
        self.dynamics = e.attribute("dyntype").unwrap_or(self.dynamics);
        self.inputs = e.attribute("input").or(self.inputs);
        self.acts_early = e.attribute("actearly").map_or(self.acts_early, |text| text == "true");
        self.gain = first(e, "gainprm")?.unwrap_or(self.gain);
        self.time = first(e, "dynprm")?.unwrap_or(self.time);
        if let Some(n) = first(e, "actdim")? {
            self.n_wanted = (n >= 0.0).then_some(n as usize);
        }
        overwrite(&mut self.bias, e, "biasprm")
    }

    /// The law of a shortcut, from one that it inherits.
    fn of_shortcut(e: Element<'d>, inherited: &Self) -> Result<Self, Diagnostic> {
        let start = Self { gain_kind: gain_kind(e.name()), foreign: inherited.foreign, ..Self::START };
        match e.name() {
            "motor" => Ok(Self::START),
            "position" | "intvelocity" => start.servo(e, inherited),
            "velocity" => {
                let gain = first(e, "kv")?.unwrap_or(inherited.gain);
                Ok(Self { gain, bias: [0.0, 0.0, -gain], bias_kind: "affine", ..start })
            }
            "damper" => {
                first_not_negative(e, "kv")?;
                Ok(Self { gain: 0.0, ..start })
            }
            "cylinder" => start.cylinder(e, inherited),
            "adhesion" => match first(e, "gain")?.unwrap_or(inherited.gain) {
                gain if gain < 0.0 => Err(e.error("`gain` is negative")),
                gain => Ok(Self { gain, ..start }),
            },
            kind => {
                let mut own = Self { bias_kind: gain_kind(kind), foreign: Some(kind), ..start };
                own.set_foreign(e, inherited)?;
                Ok(own)
            }
        }
    }

    /// Law of a `position` or `intvelocity`.
    fn servo(self, e: Element<'d>, inherited: &Self) -> Result<Self, Diagnostic> {
        let gain = first(e, "kp")?.unwrap_or(inherited.gain);
        let rate = match (first_not_negative(e, "kv")?, first_not_negative(e, "dampratio")?) {
            (Some(_), Some(_)) => {
                return Err(e
                    .error("`kv` and `dampratio` are both given, and each is the damping")
                    .with_help("remove one of them"));
            }
            (Some(damping), None) => -damping,
            (None, ratio) => ratio.unwrap_or(inherited.bias[2]),
        };
        let servo = Self { gain, bias: [0.0, -gain, rate], bias_kind: "affine", ..self };
        if e.name() == "intvelocity" {
            return Ok(Self { dynamics: "integrator", ..servo });
        }
        let filter = Some(inherited.time).filter(|_| inherited.dynamics == "filterexact");
        Ok(match first_not_negative(e, "timeconst")?.or(filter) {
            Some(time) => Self { time, dynamics: if time > 0.0 { "filterexact" } else { "none" }, ..servo },
            None => servo,
        })
    }

    fn cylinder(self, e: Element<'d>, inherited: &Self) -> Result<Self, Diagnostic> {
        let area = first(e, "area")?.unwrap_or(inherited.gain);
        let of_diameter = first(e, "diameter")?.filter(|d| *d >= 0.0).map(|d| core::f64::consts::FRAC_PI_4 * d * d);
        let mut bias = inherited.bias;
        overwrite(&mut bias, e, "bias")?;
        let time = first(e, "timeconst")?.unwrap_or(inherited.time);
        Ok(Self { gain: of_diameter.unwrap_or(area), bias, bias_kind: "affine", dynamics: "filter", time, ..self })
    }

    /// States and inputs of a kind without counterpart.
    fn set_foreign(&mut self, e: Element<'d>, inherited: &Self) -> Result<(), Diagnostic> {
        self.inputs = e.attribute("input").or(inherited.inputs);
        self.states = inherited.states;
        let keys: &[_] = match e.name() {
            "dcmotor" => &DCMOTOR_STATES,
            "pid" => &PID_STATES,
            _ => &[],
        };
        for ((key, k), own) in keys.iter().zip(&mut self.states) {
            *own = e.numbers(key)?.and_then(|numbers| numbers.get(*k).copied()).unwrap_or(*own);
        }
        self.dynamics = match e.name() {
            "orientation" => "none",
            "pid" if self.states == [0.0; 5] => "none",
            kind => kind,
        };
        Ok(())
    }

    /// Number of activations in the source.
    pub fn n_activations(&self) -> usize {
        match (self.dynamics, self.gain_kind) {
            ("none", _) => 0,
            ("dcmotor" | "pid", _) => self.states.iter().filter(|x| **x != 0.0).count(),
            (_, "so3") => 3,
            _ => self.n_wanted.unwrap_or(1).max(1),
        }
    }

    /// Number of controls in the source.
    pub fn n_controls(&self) -> usize {
        match (self.gain_kind, self.inputs) {
            ("so3", Some("quat")) => 4,
            ("so3", _) => 3,
            ("pid", None) => 2,
            ("dcmotor", Some("none")) => 0,
            ("pid" | "dcmotor", Some(inputs)) => inputs.split_whitespace().count(),
            _ => 1,
        }
    }
}

impl Range {
    /// That of an element which is no actuator, with its defaults.
    pub fn of<'d>(
        defaults: &Defaults<'d>,
        e: Element<'d>,
        class: &str,
        [range, flag]: [&str; 2],
    ) -> Result<Self, Diagnostic> {
        let mut own = Self::default();
        if let Some(holder) = defaults.holder(e, class, range) {
            own.ends = Self::ends(holder, range)?;
        }
        own.limits = defaults.holder(e, class, flag).and_then(|holder| Self::flag(holder, flag));
        Ok(own)
    }

    fn set(&mut self, e: Element<'_>, range: &str, flag: &str) -> Result<(), Diagnostic> {
        self.ends = Self::ends(e, range)?.or(self.ends);
        if e.peek(flag).is_some() {
            self.limits = Self::flag(e, flag);
        }
        Ok(())
    }

    fn ends(e: Element<'_>, key: &str) -> Result<Option<[f64; 2]>, Diagnostic> {
        match e.numbers(key)?.as_deref() {
            Some(&[low, high]) => Ok(Some([low, high])),
            Some(_) => Err(e.error(format!("`{key}` has two numbers"))),
            None => Ok(None),
        }
    }

    fn flag(e: Element<'_>, key: &str) -> Option<bool> {
        match e.attribute(key) {
            Some("true") => Some(true),
            Some("false") => Some(false),
            _ => None,
        }
    }

    /// True if an element gave one; zeros are none.
    fn is_given(&self) -> bool {
        self.ends.is_some_and(|ends| ends != [0.0; 2])
    }
}

impl<'d> ActuatorRecord<'d> {
    pub const START: Self = Self {
        kind: "general",
        law: Law::START,
        control: Range { ends: None, limits: None },
        activation: Range { ends: None, limits: None },
        force: Range { ends: None, limits: None },
        gear: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        armature: 0.0,
        damping: [0.0; 3],
        inherit_range: 0.0,
        has_motor_force: false,
    };

    /// Changes the record by an element. `around` are the records of the classes around it, the innermost one first.
    ///
    /// # Errors
    ///
    /// The element contradicts itself or what it inherits.
    pub fn set(&mut self, e: Element<'d>, around: &[Self]) -> Result<(), Diagnostic> {
        self.control.set(e, "ctrlrange", "ctrllimited")?;
        self.control.set(e, "posrange", "ctrllimited")?;
        self.activation.set(e, "actrange", "actlimited")?;
        self.force.set(e, "forcerange", "forcelimited")?;
        self.has_motor_force &= e.peek("forcerange").is_none();
        overwrite(&mut self.gear, e, "gear")?;
        self.armature = first(e, "armature")?.unwrap_or(self.armature);
        overwrite(&mut self.damping, e, "damping")?;
        if e.name() == "general" {
            self.law.set_general(e)?;
            self.inherit_range = first(e, "inheritrange")?.unwrap_or(self.inherit_range);
        } else {
            self.set_shortcut(e, around)?;
        }
        self.kind = e.name();
        Ok(())
    }

    fn set_shortcut(&mut self, e: Element<'d>, around: &[Self]) -> Result<(), Diagnostic> {
        let kind = e.name();
        let own = *self;
        let source = std::iter::once(&own).chain(around).find(|record| record.gives(kind)).unwrap_or(&Self::START);
        self.law = Law::of_shortcut(e, &source.law)?;
        self.activation.limits = None;
        match kind {
            "position" | "intvelocity" | "pid" => {
                let (key, range) = match kind {
                    "intvelocity" => ("actrange", &mut self.activation),
                    _ => ("ctrlrange", &mut self.control),
                };
                let (own, is_given) = (first(e, "inheritrange")?, e.peek(key).is_some());
                self.inherit_range = own.unwrap_or(if is_given { 0.0 } else { source.inherit_range });
                // the one that is given here takes the place of an inherited one
                if own.is_some_and(|own| own > 0.0) && !is_given {
                    range.ends = None;
                }
                if self.inherit_range > 0.0 && range.is_given() {
                    return Err(e
                        .error(format!("`{key}` and `inheritrange` are both given, and each is the range"))
                        .with_help("remove one of them"));
                }
            }
            _ if e.peek("inheritrange").is_some() => {
                let message = format!("a `{kind}` has no `inheritrange`");
                return Err(e.error(message).with_help("only servos inherit ranges"));
            }
            "damper" | "adhesion" => {
                self.control.limits = Some(true);
                if self.control.ends.is_some_and(|ends| ends.iter().any(|x| *x < 0.0)) {
                    return Err(e.error(format!("the range of the control of a `{kind}` is negative")));
                }
            }
            "dcmotor" if e.peek("saturation").is_some() => {
                (self.force.limits, self.has_motor_force) = (Some(true), e.peek("forcerange").is_none());
            }
            _ => {}
        }
        Ok(())
    }

    /// True if a shortcut inherits the numbers of this record.
    fn gives(&self, kind: &str) -> bool {
        self.kind == kind || (self.kind == "general" && self.law.gain_kind == gain_kind(kind))
    }

    /// Reason why the record has no counterpart, if numbers of other kinds are in it.
    pub fn foreign(&self) -> Option<&'d str> {
        self.law.foreign.or(self.has_motor_force.then_some("dcmotor"))
    }

    /// Range of the force, where it is known here.
    pub fn known_force(&self) -> Range {
        if self.has_motor_force { Range::default() } else { self.force }
    }

    /// Range that the actuator inherits: as MuJoCo by what it is, whichever element said so.
    pub fn inherited_range(&self, e: Element<'d>) -> Result<Option<InheritedRange>, Diagnostic> {
        let own = &self.law;
        let is_servo = own.gain_kind == "fixed" && own.bias_kind == "affine" && own.bias[1] == -own.gain;
        if self.inherit_range <= 0.0 || !is_servo {
            return Ok(None);
        }
        match own.dynamics {
            "none" | "filterexact" => Ok(Some(InheritedRange::Control(self.inherit_range))),
            "integrator" => Ok(Some(InheritedRange::Activation(self.inherit_range))),
            other => Err(e
                .error(format!("its class gives it `inheritrange`, which its activation `{other}` does not have"))
                .with_help("only a `position` and an `intvelocity` inherit ranges")),
        }
    }
}

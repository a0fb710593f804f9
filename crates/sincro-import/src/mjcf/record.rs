//! Actuator parameters: gain, bias and activation, which elements of the format set one after the other.
//!
//! Source: key `mjcf`, actuators. All kinds of actuators set the parameters of a `general`; the defaults of a class are
//! those, too: a `position` in a class gives a `general` of it gain and bias, and the `kp` of one is the gain that a
//! `general` gave. Of another kind than `general` only the same kind takes what it has set.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use crate::source::Element;

/// Parameters of a `general` actuator.
#[derive(Clone, Copy)]
pub(super) struct ActuatorParameters<'d> {
    pub gain: f64,
    pub gain_kind: &'d str,
    /// Constant, and coefficients of length and rate; a positive last one of a servo is a damping ratio.
    pub bias: [f64; 3],
    pub bias_kind: &'d str,
    pub dynamics: &'d str,
    /// Time constant of the activation `[s]`.
    pub time: f64,
    /// Ratio of the range of control or activation to that of what the actuator acts on; 0 for none that is inherited.
    inherit_range: f64,
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

/// Parameters that elements set: without those of the last kind, and with them.
struct ActuatorDefaults<'d> {
    general: ActuatorParameters<'d>,
    current: ActuatorParameters<'d>,
    /// Last kind other than `general`, of which another kind takes nothing.
    kind: &'d str,
    /// True if there is a `ctrlrange`.
    has_control_range: bool,
    /// True if there is an `actrange`.
    has_activation_range: bool,
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

impl<'d> ActuatorParameters<'d> {
    const START: Self = Self {
        gain: 1.0,
        gain_kind: "fixed",
        bias: [0.0; 3],
        bias_kind: "none",
        dynamics: "none",
        time: 1.0,
        inherit_range: 0.0,
    };

    /// Range that the actuator inherits: as MuJoCo by what it is, whichever element said so.
    pub fn inherited_range(&self, e: Element<'d>) -> Result<Option<InheritedRange>, Diagnostic> {
        let is_servo = self.bias_kind == "affine" && self.bias[1] == -self.gain;
        if self.inherit_range <= 0.0 || !is_servo {
            return Ok(None);
        }
        match self.dynamics {
            "none" | "filterexact" => Ok(Some(InheritedRange::Control(self.inherit_range))),
            "integrator" => Ok(Some(InheritedRange::Activation(self.inherit_range))),
            other => Err(e
                .error(format!("its class gives it `inheritrange`, which its activation `{other}` does not have"))
                .with_help("only a `position` and an `intvelocity` inherit ranges")),
        }
    }

    /// Gain, bias and activation of a `position` or `intvelocity`.
    fn set_servo(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        let gain = first(e, "kp")?.unwrap_or(self.gain);
        let rate = match (first_not_negative(e, "kv")?, first_not_negative(e, "dampratio")?) {
            (Some(_), Some(_)) => {
                return Err(e
                    .error("`kv` and `dampratio` are both given, and each is the damping")
                    .with_help("remove one of them"));
            }
            (Some(damping), None) => -damping,
            (None, ratio) => ratio.unwrap_or(self.bias[2]),
        };
        (self.gain, self.bias) = (gain, [0.0, -gain, rate]);
        (self.gain_kind, self.bias_kind) = ("fixed", "affine");
        if e.name() == "intvelocity" {
            self.dynamics = "integrator";
        } else if let Some(time) = first_not_negative(e, "timeconst")? {
            (self.time, self.dynamics) = (time, if time > 0.0 { "filterexact" } else { "none" });
        }
        Ok(())
    }

    fn set_velocity(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        let gain = first(e, "kv")?.unwrap_or(self.gain);
        (self.gain, self.bias) = (gain, [0.0, 0.0, -gain]);
        (self.gain_kind, self.bias_kind) = ("fixed", "affine");
        Ok(())
    }

    fn set_cylinder(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        self.time = first(e, "timeconst")?.unwrap_or(self.time);
        self.set_bias(e, "bias")?;
        self.gain = first(e, "area")?.unwrap_or(self.gain);
        if let Some(diameter) = first(e, "diameter")?.filter(|diameter| *diameter >= 0.0) {
            self.gain = core::f64::consts::FRAC_PI_4 * diameter * diameter;
        }
        (self.gain_kind, self.bias_kind, self.dynamics) = ("fixed", "affine", "filter");
        Ok(())
    }

    fn set_general(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        self.gain_kind = e.attribute("gaintype").unwrap_or(self.gain_kind);
        self.bias_kind = e.attribute("biastype").unwrap_or(self.bias_kind);
        self.dynamics = e.attribute("dyntype").unwrap_or(self.dynamics);
        self.gain = first(e, "gainprm")?.unwrap_or(self.gain);
        self.time = first(e, "dynprm")?.unwrap_or(self.time);
        self.set_bias(e, "biasprm")
    }

    fn set_bias(&mut self, e: Element<'d>, key: &str) -> Result<(), Diagnostic> {
        for (own, given) in self.bias.iter_mut().zip(e.numbers(key)?.unwrap_or_default()) {
            *own = given;
        }
        Ok(())
    }
}

impl<'d> ActuatorDefaults<'d> {
    fn new() -> Self {
        let start = ActuatorParameters::START;
        Self { general: start, current: start, kind: "general", has_control_range: false, has_activation_range: false }
    }

    /// Takes what an element sets; the reason if it has no counterpart.
    fn set(&mut self, e: Element<'d>) -> Result<Result<(), String>, Diagnostic> {
        let kind = e.name();
        if kind != "general" && kind != self.kind {
            (self.current, self.kind) = (self.general, kind);
            self.current.dynamics = "none";
        }
        if e.peek("inheritrange").is_some() && !matches!(kind, "general" | "position" | "intvelocity") {
            return Err(e.error(format!("a `{kind}` has no `inheritrange`")).with_help("only servos inherit ranges"));
        }
        self.set_ranges(e)?;
        match kind {
            "motor" => self.current = ActuatorParameters::START,
            "position" | "intvelocity" => {
                self.current.set_servo(e)?;
                self.set_inherited(e)?;
            }
            "velocity" => self.current.set_velocity(e)?,
            "cylinder" => self.current.set_cylinder(e)?,
            "general" => {
                self.current.set_general(e)?;
                (self.general, self.kind) = (self.current, "general");
            }
            _ => {
                let own = &mut self.current;
                (own.gain_kind, own.bias_kind, own.dynamics) = (kind, kind, kind);
                return Ok(Err(format!("a `{kind}` has no counterpart")));
            }
        }
        Ok(Ok(()))
    }

    /// Notes which ranges there are; zeros are none.
    fn set_ranges(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        for (key, has) in [("ctrlrange", &mut self.has_control_range), ("actrange", &mut self.has_activation_range)] {
            if let Some(ends) = e.numbers(key)? {
                *has = ends.iter().any(|x| *x != 0.0);
            }
        }
        Ok(())
    }

    /// Takes the later one of the range that a servo inherits and the one that an element gives.
    fn set_inherited(&mut self, e: Element<'d>) -> Result<(), Diagnostic> {
        let (key, has_range) = match e.name() {
            "intvelocity" => ("actrange", &mut self.has_activation_range),
            _ => ("ctrlrange", &mut self.has_control_range),
        };
        let inherit_range = &mut self.current.inherit_range;
        match (first(e, "inheritrange")?, e.peek(key)) {
            (None, None) => {}
            (None, Some(_)) => *inherit_range = 0.0,
            (Some(own), given) => {
                *inherit_range = own;
                *has_range = *has_range && (given.is_some() || own <= 0.0);
            }
        }
        if *inherit_range > 0.0 && *has_range {
            return Err(e
                .error(format!("`{key}` and `inheritrange` are both given, and each is the range"))
                .with_help("remove one of them"));
        }
        Ok(())
    }
}

impl<'d> Reader<'d> {
    /// Parameters of an actuator after its defaults; the reason if its kind has no counterpart.
    pub(super) fn parameters(&self, e: Element<'d>) -> Result<Result<ActuatorParameters<'d>, String>, Diagnostic> {
        let mut defaults = ActuatorDefaults::new();
        for element in self.defaults.actuators(e) {
            let set = defaults.set(element)?;
            // a kind of a class that the element is not counts no more
            if let (Err(why), true) = (set, element.id() == e.id()) {
                return Ok(Err(why));
            }
        }
        Ok(Ok(defaults.current))
    }

    /// Number of activations that MuJoCo has of an actuator.
    pub(super) fn n_activations(&self, e: Element<'d>) -> usize {
        let mut defaults = ActuatorDefaults::new();
        for element in self.defaults.actuators(e) {
            // an error is one of `parameters`
            let _ = defaults.set(element);
        }
        let number = |key: &str, k: usize| {
            let numbers = self.defaults.numbers(e, "main", key).ok().flatten().unwrap_or_default();
            numbers.get(k).copied().unwrap_or(0.0)
        };
        match defaults.current.dynamics {
            "none" | "damper" | "adhesion" => 0,
            "dcmotor" => DCMOTOR_STATES.iter().filter(|(key, k)| number(key, *k) != 0.0).count(),
            _ => match number("actdim", 0) {
                given if given >= 1.0 => given as usize,
                _ => 1,
            },
        }
    }
}

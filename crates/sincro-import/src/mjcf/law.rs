//! Laws of actuators: gain, bias and activation, which elements of the format set one after the other.
//!
//! Source: key `mjcf`, actuators. All kinds of actuators set the same few numbers; the defaults of a class are those
//! numbers, too: a `position` in a class gives a `general` of it gain and bias, and the `kp` of one is the gain that a
//! `general` gave. Of another kind than `general` only the same kind takes what it has set.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::actuator::without_limit;
use crate::path_mass::tendon_mass;
use crate::robot::{Activation, Robot, TendonPath};
use crate::source::Element;

/// Force = gain·u + bias₀ + bias₁·length + bias₂·rate, with the activation in the place of the control u if there is
/// one.
pub(super) struct Law {
    pub gain: f64,
    pub bias: [f64; 3],
    pub activation: Option<Activation>,
    /// Range of the control.
    pub control: Option<[f64; 2]>,
}

/// Object that an actuator acts on.
pub(super) struct Target<'a> {
    /// Range of its coordinate or length, as MuJoCo measures it.
    pub range: Option<[f64; 2]>,
    /// Its name in messages.
    pub name: &'a str,
    /// Path along which it acts, and length of the actuator for a unit of that path's; none for forces.
    pub path: Option<TendonPath>,
    pub gear: f64,
}

/// Numbers of an actuator.
#[derive(Clone, Copy)]
struct Numbers<'d> {
    gain: f64,
    gain_kind: &'d str,
    bias: [f64; 3],
    bias_kind: &'d str,
    dynamics: &'d str,
    time: f64,
    /// Share of the range of what it acts on that its control inherits, and true if its activation does instead; 0 for
    /// none.
    share: (f64, bool),
}

/// Numbers that elements set: without those of the last kind, and with them.
struct Settings<'d> {
    base: Numbers<'d>,
    now: Numbers<'d>,
    /// Last kind other than `general`, of which another kind takes nothing.
    kind: &'d str,
}

impl<'d> Settings<'d> {
    fn new() -> Self {
        let start = Numbers {
            gain: 1.0,
            gain_kind: "fixed",
            bias: [0.0; 3],
            bias_kind: "none",
            dynamics: "none",
            time: 1.0,
            share: (0.0, false),
        };
        Self { base: start, now: start, kind: "general" }
    }

    /// Takes what an element sets; the reason if it has no counterpart.
    fn set(&mut self, e: Element<'d>) -> Result<Result<(), String>, Diagnostic> {
        let first = |key: &str| -> Result<Option<f64>, Diagnostic> {
            Ok(e.numbers(key)?.and_then(|numbers| numbers.first().copied()))
        };
        if e.name() != "general" && e.name() != self.kind {
            (self.now, self.kind) = (self.base, e.name());
            self.now.dynamics = "none";
        }
        let own = &mut self.now;
        match e.name() {
            "motor" => *own = Self::new().now,
            "position" | "intvelocity" => {
                let gain = first("kp")?.unwrap_or(own.gain);
                let damping = first("kv")?;
                if damping.is_some_and(|kv| kv < 0.0) {
                    return Err(e.error("`kv` is negative"));
                }
                // a positive one is a damping ratio
                let rate = damping.map(|kv| -kv).or(first("dampratio")?).unwrap_or(own.bias[2]);
                (own.gain, own.bias) = (gain, [0.0, -gain, rate]);
                (own.gain_kind, own.bias_kind) = ("fixed", "affine");
                own.share = (first("inheritrange")?.unwrap_or(own.share.0), e.name() == "intvelocity");
                match (e.name(), first("timeconst")?) {
                    ("intvelocity", _) => own.dynamics = "integrator",
                    (_, Some(time)) if time < 0.0 => return Err(e.error("`timeconst` is negative")),
                    (_, Some(time)) => {
                        (own.time, own.dynamics) = (time, if time > 0.0 { "filterexact" } else { "none" });
                    }
                    (_, None) => {}
                }
            }
            "velocity" => {
                let gain = first("kv")?.unwrap_or(own.gain);
                (own.gain, own.bias) = (gain, [0.0, 0.0, -gain]);
                (own.gain_kind, own.bias_kind) = ("fixed", "affine");
            }
            "cylinder" => {
                own.time = first("timeconst")?.unwrap_or(own.time);
                own.set_bias(e.numbers("bias")?);
                own.gain = first("area")?.unwrap_or(own.gain);
                if let Some(diameter) = first("diameter")?.filter(|diameter| *diameter >= 0.0) {
                    own.gain = core::f64::consts::FRAC_PI_4 * diameter * diameter;
                }
                (own.gain_kind, own.bias_kind, own.dynamics) = ("fixed", "affine", "filter");
            }
            "general" => {
                own.gain_kind = e.attribute("gaintype").unwrap_or(own.gain_kind);
                own.bias_kind = e.attribute("biastype").unwrap_or(own.bias_kind);
                own.dynamics = e.attribute("dyntype").unwrap_or(own.dynamics);
                own.gain = first("gainprm")?.unwrap_or(own.gain);
                own.time = first("dynprm")?.unwrap_or(own.time);
                own.set_bias(e.numbers("biasprm")?);
                (self.base, self.kind) = (self.now, "general");
            }
            other => {
                let kind = other;
                (own.gain_kind, own.bias_kind, own.dynamics) = (kind, kind, kind);
                return Ok(Err(format!("a `{other}` has no counterpart")));
            }
        }
        Ok(Ok(()))
    }
}

impl Numbers<'_> {
    fn set_bias(&mut self, numbers: Option<Vec<f64>>) {
        for (own, given) in self.bias.iter_mut().zip(numbers.unwrap_or_default()) {
            *own = given;
        }
    }
}

impl<'d> Reader<'d> {
    /// The law of an actuator, with its activation if it has one; the reason if it has no counterpart.
    pub(super) fn law(
        &self,
        e: Element<'d>,
        Target { range, name: target, path, gear }: Target<'_>,
        robot: &Robot,
    ) -> Result<Result<Law, String>, Diagnostic> {
        let mut settings = Settings::new();
        for element in self.defaults.actuators(e) {
            let set = settings.set(element)?;
            // a kind of a class that the element is not counts no more
            if let (Err(why), true) = (set, element.id() == e.id()) {
                return Ok(Err(why));
            }
        }
        let numbers = settings.now;
        let Numbers { gain, mut bias, time, share: (share, of_activation), .. } = numbers;
        if numbers.gain_kind != "fixed" {
            return Ok(Err(format!("its gain is of type `{}`", numbers.gain_kind)));
        }
        match numbers.bias_kind {
            "none" => bias = [0.0; 3],
            // that of a spring with the mass which MuJoCo's actuator moves
            "affine" if bias[2] > 0.0 && bias[1] == -gain => {
                let mass = path.and_then(|path| tendon_mass(robot, &path)).map(|mass| mass / (gear * gear));
                let Some(mass) = mass.filter(|mass| mass.is_finite()) else {
                    return Ok(Err("its damping is a ratio, which needs the inertia at the reference".into()));
                };
                bias[2] = -2.0 * bias[2] * (gain * mass).max(0.0).sqrt();
                e.change(&format!("its damping ratio is a damping of {:.6} with the inertia {mass:.6}", -bias[2]));
            }
            "affine" => {}
            other => return Ok(Err(format!("its bias is of type `{other}`"))),
        }
        let time_constant = match numbers.dynamics {
            "none" => None,
            "integrator" => Some(None),
            // a time constant of zero has no lag
            "filter" | "filterexact" => Some(time).filter(|time| *time > 0.0).map(Some),
            other => return Ok(Err(format!("its activation is of type `{other}`"))),
        };
        let mut control = self.limiting_range(e, "ctrlrange", "ctrllimited")?;
        let mut limits = match time_constant {
            Some(_) => self.limiting_range(e, "actrange", "actlimited")?,
            None => None,
        };
        if share > 0.0 {
            let (own, key, flag) = match of_activation {
                true => (&mut limits, "actrange", "actlimited"),
                false => (&mut control, "ctrlrange", "ctrllimited"),
            };
            let Some([low, high]) = range.filter(|[low, high]| low < high) else {
                return Err(e
                    .error(format!("`inheritrange` needs a range of {target}, which has none"))
                    .with_help(format!("give it a `range`, or the actuator a `{key}`")));
            };
            let (middle, half) = (0.5 * (low + high), 0.5 * share * (high - low));
            let is_limited = self.defaults.text(e, "main", flag) != Some("false");
            *own = is_limited.then_some([middle - half, middle + half]);
        }
        let activation = time_constant.map(|time_constant| {
            if self.defaults.text(e, "main", "actearly") == Some("true") {
                e.change("`actearly` is of steps in time, and has no effect here");
            }
            Activation { time_constant, input_range: control, range: limits, initial: 0.0 }
        });
        Ok(Ok(Law { gain, bias, activation, control }))
    }

    /// True if MuJoCo has an activation of an actuator.
    pub(super) fn is_activated(&self, e: Element<'d>) -> bool {
        let mut settings = Settings::new();
        for element in self.defaults.actuators(e) {
            let _ = settings.set(element);
        }
        !matches!(settings.now.dynamics, "none" | "damper" | "adhesion")
    }

    /// The range of that name, if its `flag` says that it limits; one that leaves no room limits nothing unless it is
    /// said to, and is an error then.
    pub(super) fn limiting_range(
        &self,
        e: Element<'d>,
        name: &str,
        flag: &str,
    ) -> Result<Option<[f64; 2]>, Diagnostic> {
        let d = &self.defaults;
        let range = d.numbers(e, "main", name)?;
        let (on, is_explicit) = match d.text(e, "main", flag) {
            Some("true") => (true, true),
            Some("false") => (false, false),
            _ => (self.settings.autolimits, false),
        };
        match range.as_deref() {
            _ if !on => Ok(None),
            Some(&[low, high]) if low < high => Ok(Some([low, high].map(without_limit))),
            None | Some([_, _]) if !is_explicit => Ok(None),
            _ => Err(e
                .error(format!("`{name}` is no range, and `{flag}` says that it limits"))
                .with_help("give two numbers, the lower one first")),
        }
    }
}

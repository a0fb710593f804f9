//! Laws of actuators: gain, bias and activation of first order from their parameters, with their ranges.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::record::{self, ActuatorRecord, InheritedRange, Range};
use crate::export::UNLIMITED;
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
    /// Range of the force.
    pub force: Option<[f64; 2]>,
}

/// Transmission of an actuator: where and how its force acts.
pub(super) struct Transmission {
    /// Range of the coordinate or length that it acts on, as MuJoCo measures it.
    pub range: Option<[f64; 2]>,
    /// Words for what it acts on in messages.
    pub called: String,
    /// Path along which it acts; the reason if it has none.
    pub path: Result<TendonPath, String>,
    /// Length of the path in the source less that here.
    pub offset: f64,
    /// Length of the actuator for a unit of that of its path; 0 if it exerts no force at all.
    pub gear: f64,
}

impl<'d> Reader<'d> {
    /// The law of an actuator that exerts a force, with its activation if it has one; the reason if it has none, or no
    /// counterpart.
    pub(super) fn law(
        &self,
        e: Element<'d>,
        record: &ActuatorRecord<'d>,
        transmission: &Transmission,
        robot: &Robot,
    ) -> Result<Result<Law, String>, Diagnostic> {
        let own = &record.law;
        let (mut control, mut activation) = (record.control, record.activation);
        match record.inherited_range(e)? {
            Some(InheritedRange::Control(ratio)) => {
                control.ends = Some(inherited(e, "ctrlrange", ratio, transmission)?);
            }
            Some(InheritedRange::Activation(ratio)) => {
                activation.ends = Some(inherited(e, "actrange", ratio, transmission)?);
            }
            None => {}
        }
        let control = self.limiting_range(e, control, "ctrlrange", "ctrllimited")?;
        let force = record.known_force();
        let force = self.limiting_range(e, force, "forcerange", "forcelimited")?;
        let range = self.limiting_range(e, activation, "actrange", "actlimited")?;
        if own.dynamics == "none" && range.is_some() {
            return Err(e
                .error("`actrange` is given, and it has no activation")
                .with_help("remove it, or give a `dyntype`"));
        }
        match (own.dynamics, own.n_wanted) {
            (_, None) | ("user" | "dcmotor" | "pid", _) => {}
            ("none", Some(0)) => {}
            (kind, Some(1)) if kind != "none" => {}
            (kind, Some(n)) => {
                return Err(e
                    .error(format!("`actdim` is {n}, and an actuator with `dyntype` `{kind}` has another number"))
                    .with_help("remove `actdim`"));
            }
        }
        if own.gain_kind != "fixed" {
            return Ok(Err(match e.name() {
                "general" => format!("its gain is of type `{}`", own.gain_kind),
                kind => format!("a `{kind}` has no counterpart"),
            }));
        }
        if let Some(kind) = record.foreign() {
            return Err(e
                .error(format!("its class gives it numbers of a `{kind}`, which has no counterpart"))
                .with_help("give it another class"));
        }
        if transmission.gear == 0.0 {
            return Ok(Err("its `gear` is 0: it exerts no force".into()));
        }
        let bias = match bias(e, own, transmission, robot) {
            Ok(bias) => bias,
            Err(why) => return Ok(Err(why)),
        };
        if own.gain == 0.0 && bias == [0.0; 3] {
            return Ok(Err("its gain is 0: it exerts no force".into()));
        }
        let time_constant = match own.dynamics {
            "none" => None,
            "integrator" => Some(None),
            "filter" | "filterexact" if own.time > 0.0 => Some(Some(own.time)),
            "filter" | "filterexact" => {
                e.change("a time constant of zero has no lag: there is no activation");
                None
            }
            other => return Ok(Err(format!("its activation is of type `{other}`"))),
        };
        let activation = time_constant.map(|time_constant| {
            if own.acts_early {
                e.change("`actearly` is of steps in time, and has no effect here");
            }
            Activation { time_constant, input_range: control, range, initial: 0.0 }
        });
        Ok(Ok(Law { gain: own.gain, bias, activation, control, force }))
    }

    /// A range, if its `flag` says that it limits; an empty range limits nothing unless it is said to, and is an error
    /// then.
    pub(super) fn limiting_range(
        &self,
        e: Element<'d>,
        range: Range,
        name: &str,
        flag: &str,
    ) -> Result<Option<[f64; 2]>, Diagnostic> {
        match (range.ends, range.limits) {
            (_, Some(false)) => Ok(None),
            (Some([low, high]), None) if (low, high) != (0.0, 0.0) && !self.settings.autolimits => Err(e
                .error(format!("`{name}` is given, and neither `{flag}` nor `autolimits` says that it limits"))
                .with_help(format!("give `{flag}`"))),
            (Some([low, high]), _) if low < high => Ok(Some([low, high].map(without_limit))),
            (_, None) => Ok(None),
            (_, Some(true)) => Err(e
                .error(format!("`{name}` is no range, and `{flag}` says that it limits"))
                .with_help("give two numbers, the lower one first")),
        }
    }
}

/// Bias with the damping that a ratio means; the reason if it has no counterpart.
fn bias(e: Element<'_>, own: &record::Law<'_>, transmission: &Transmission, robot: &Robot) -> Result<[f64; 3], String> {
    let (gain, [constant, length, rate]) = (own.gain, own.bias);
    match own.bias_kind {
        "none" => Ok([0.0; 3]),
        "affine" if rate > 0.0 && length == -gain => {
            // MuJoCo has none where nothing moves along a path
            let Ok(path) = &transmission.path else { return Ok([constant, length, 0.0]) };
            // that of a spring with the mass which MuJoCo's actuator moves
            let mass = tendon_mass(robot, path).map(|mass| mass / (transmission.gear * transmission.gear));
            let Some(mass) = mass.filter(|mass| mass.is_finite()) else {
                return Err("its damping is a ratio, and what it acts on has no inertia at the reference".into());
            };
            let damping = 2.0 * rate * (gain * mass).max(0.0).sqrt();
            e.change(&format!("its damping ratio is a damping of {damping:.6} with the inertia {mass:.6}"));
            Ok([constant, length, -damping])
        }
        "affine" => Ok(own.bias),
        other => Err(format!("its bias is of type `{other}`")),
    }
}

/// A range that is inherited by a ratio about its middle.
fn inherited(e: Element<'_>, name: &str, ratio: f64, transmission: &Transmission) -> Result<[f64; 2], Diagnostic> {
    let Some([low, high]) = transmission.range.filter(|[low, high]| low != high) else {
        return Err(e
            .error(format!("`inheritrange` needs a range of {}, which has none", transmission.called))
            .with_help(format!("give it a `range`, or the actuator a `{name}`")));
    };
    let (middle, half) = (0.5 * (low + high), 0.5 * ratio * (high - low));
    Ok([middle - half, middle + half])
}

/// End of a range, infinite where MuJoCo's largest number stands for none.
fn without_limit(x: f64) -> f64 {
    if x.abs() >= UNLIMITED { x * f64::INFINITY } else { x }
}

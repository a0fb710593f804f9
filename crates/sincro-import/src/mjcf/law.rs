//! Laws of actuators: gain, bias and activation of first order from their parameters, with their ranges.

use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::parameters::{ActuatorParameters, InheritedRange};
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
        transmission: &Transmission,
        robot: &Robot,
    ) -> Result<Result<Law, String>, Diagnostic> {
        let parameters = match self.parameters(e)? {
            Ok(parameters) => parameters,
            Err(why) => return Ok(Err(why)),
        };
        if transmission.gear == 0.0 {
            return Ok(Err("its `gear` is 0: it exerts no force".into()));
        }
        let gain = parameters.gain;
        if parameters.gain_kind != "fixed" {
            return Ok(Err(format!("its gain is of type `{}`", parameters.gain_kind)));
        }
        let bias = match bias(e, &parameters, transmission, robot) {
            Ok(bias) => bias,
            Err(why) => return Ok(Err(why)),
        };
        if gain == 0.0 && bias == [0.0; 3] {
            return Ok(Err("its gain is 0: it exerts no force".into()));
        }
        let time_constant = match parameters.dynamics {
            "none" => None,
            "integrator" => Some(None),
            // a time constant of zero has no lag
            "filter" | "filterexact" => Some(parameters.time).filter(|time| *time > 0.0).map(Some),
            other => return Ok(Err(format!("its activation is of type `{other}`"))),
        };
        let inherited = parameters.inherited_range(e)?;
        let control = match inherited {
            Some(InheritedRange::Control(ratio)) => {
                inherit(self, e, ["ctrlrange", "ctrllimited"], ratio, transmission)?
            }
            _ => self.limiting_range(e, "ctrlrange", "ctrllimited")?,
        };
        let range = match (time_constant, inherited) {
            (None, _) => {
                let range = self.limiting_range(e, "actrange", "actlimited")?;
                if parameters.dynamics == "none" && range.is_some() {
                    return Err(e
                        .error("`actrange` is given, and it has no activation")
                        .with_help("remove it, or give a `dyntype`"));
                }
                None
            }
            (_, Some(InheritedRange::Activation(ratio))) => {
                inherit(self, e, ["actrange", "actlimited"], ratio, transmission)?
            }
            _ => self.limiting_range(e, "actrange", "actlimited")?,
        };
        let activation = time_constant.map(|time_constant| {
            if self.defaults.text(e, "main", "actearly") == Some("true") {
                e.change("`actearly` is of steps in time, and has no effect here");
            }
            Activation { time_constant, input_range: control, range, initial: 0.0 }
        });
        Ok(Ok(Law { gain, bias, activation, control }))
    }

    /// The range of that name, if its `flag` says that it limits; an empty range limits nothing unless it is said to,
    /// and is an error then.
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

/// Bias with the damping that a ratio means; the reason if it has no counterpart.
fn bias(
    e: Element<'_>,
    parameters: &ActuatorParameters<'_>,
    transmission: &Transmission,
    robot: &Robot,
) -> Result<[f64; 3], String> {
    let (gain, [constant, length, rate]) = (parameters.gain, parameters.bias);
    match parameters.bias_kind {
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
        "affine" => Ok(parameters.bias),
        other => Err(format!("its bias is of type `{other}`")),
    }
}

/// A range that is inherited by a ratio about its middle, if its flag does not say that it limits nothing.
fn inherit<'d>(
    reader: &Reader<'d>,
    e: Element<'d>,
    [name, flag]: [&str; 2],
    ratio: f64,
    transmission: &Transmission,
) -> Result<Option<[f64; 2]>, Diagnostic> {
    let Some([low, high]) = transmission.range.filter(|[low, high]| low < high) else {
        return Err(e
            .error(format!("`inheritrange` needs a range of {}, which has none", transmission.called))
            .with_help(format!("give it a `range`, or the actuator a `{name}`")));
    };
    let (middle, half) = (0.5 * (low + high), 0.5 * ratio * (high - low));
    let is_limited = reader.defaults.text(e, "main", flag) != Some("false");
    Ok(is_limited.then_some([middle - half, middle + half]))
}

/// End of a range, infinite where MuJoCo's largest number stands for none.
pub(super) fn without_limit(x: f64) -> f64 {
    if x.abs() >= UNLIMITED { x * f64::INFINITY } else { x }
}

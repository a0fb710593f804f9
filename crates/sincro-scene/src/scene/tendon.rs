//! Tendons in scene files: as written, and as the builder takes them.

use std::sync::Arc;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::actuation::force_law::FreeRange;
use sincro_dynamics::actuation::{ForceLaw, NonlinearLaw};
use sincro_dynamics::model::{PathSpec, SpringDamperSpec};
use sincro_dynamics::signal::Signal;

use super::contact::Joiner;
use super::file::OneOrList;
use super::signal_file::SignalReader;
use super::spring_damper::{self, LineActuatorFile};
use crate::diagnostic::Diagnostic;

/// Spring, damper and actuator along a path through points of several bodies, or along a linear combination of joint
/// coordinates; a positive force makes it longer.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["through"]}, {"required": ["joints", "coefficients"]}])))]
pub(crate) struct TendonFile {
    /// Letters, digits, `_` and `-`; its path is `/` and the name.
    pub name: String,
    /// Spatial tendon: paths of two bodies or frames or more (or `/`), through whose origins it runs in this order.
    pub through: Option<Vec<String>>,
    /// Fixed tendon: paths of joints with one degree of freedom.
    pub joints: Option<Vec<String>>,
    /// With `joints`: length for each unit of their coordinates, in their order [m/rad] or [1].
    pub coefficients: Option<Vec<f64>>,
    /// Length without elastic force, or two for a range of them; default the length at the start [m].
    pub free_length: Option<OneOrList<f64>>,
    /// Force −stiffness·x, x the length less the free length or beyond its range [N/m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub stiffness: f64,
    /// Force −damping·v, v the rate of the length [N·s/m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub damping: f64,
    /// Constant force, positive where it makes the tendon longer [N].
    #[serde(default)]
    pub preload: f64,
    /// True for a rope, which pulls when longer than its free length and never pushes.
    #[serde(default)]
    pub tension_only: bool,
    /// Stops at a smallest and a largest length.
    pub limits: Option<TendonLimitsFile>,
    /// Actuator: its command is a force that is added.
    pub actuator: Option<LineActuatorFile>,
}

/// Stops of a tendon: beyond them a spring and damper pushes back.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct TendonLimitsFile {
    /// Smallest length; none if left out [m].
    pub lower: Option<f64>,
    /// Largest length; none if left out [m].
    pub upper: Option<f64>,
    /// Stiffness beyond them [N/m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub stiffness: f64,
    /// Damping beyond them [N·s/m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub damping: f64,
}

impl TendonFile {
    /// Length at which the deflection is zero; none: that at the start.
    pub(super) fn model_free_length(&self) -> Option<f64> {
        match &self.free_length {
            Some(OneOrList::One(length)) => Some(*length),
            // ranges are of the length itself
            Some(OneOrList::List(_)) => Some(0.0),
            None => self.limits.is_some().then_some(0.0).filter(|_| self.stiffness == 0.0),
        }
    }
}

/// The specification and the command of its actuator; none, with the reasons noted, if it cannot be.
pub(super) fn spec(
    file: &TendonFile,
    path: PathSpec,
    pointer: &str,
    signals: &mut SignalReader<'_>,
) -> Option<(SpringDamperSpec, Option<Signal>)> {
    let of = format!("tendon `{}`", file.name);
    let mut refuse = |key: &str, message: String, help: &str| {
        let at = signals.document.at(&format!("{pointer}/{key}"));
        signals.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
    };
    let free = file.model_free_length();
    let mut stiffness = file.stiffness;
    let mut ranges = Vec::new();
    if let Some(OneOrList::List(lengths)) = &file.free_length {
        let &[low, high] = lengths.as_slice() else {
            let message = format!("free_length of {of} has {} numbers, not one or two", lengths.len());
            refuse("free_length", message, "give one length [m], or the shortest and the longest without force");
            return None;
        };
        if !(low.is_finite() && high.is_finite() && low <= high) {
            refuse("free_length", format!("free_length of {of} does not increase"), "give the shorter length first");
            return None;
        }
        if file.tension_only {
            let help = "give the longer length alone";
            refuse("free_length", format!("{of} pulls only, and has a range of free lengths"), help);
            return None;
        }
        ranges.push(FreeRange { low, high, stiffness, damping: 0.0 });
        stiffness = 0.0;
    }
    if let Some(limits) = &file.limits {
        let (low, high) = (limits.lower.unwrap_or(f64::NEG_INFINITY), limits.upper.unwrap_or(f64::INFINITY));
        if low.is_nan() || high.is_nan() || low > high || (limits.lower.is_none() && limits.upper.is_none()) {
            let help = "give `lower` or `upper` [m], or both with `lower` not above `upper`";
            refuse("limits", format!("limits of {of} are no range"), help);
            return None;
        }
        if !(limits.stiffness.is_finite() && limits.damping.is_finite()) {
            refuse("limits", format!("limits of {of} are not finite"), "give a stiffness [N/m] and a damping [N·s/m]");
            return None;
        }
        let Some(offset) = free else {
            let help = "give `free_length` [m] beside `limits`";
            refuse("limits", format!("{of} has limits and a spring without a free length"), help);
            return None;
        };
        if file.tension_only && limits.lower.is_some() {
            let message = format!("{of} pulls only, but its lower limit pushes");
            refuse("limits", message, "leave `tension_only` or `limits.lower` out");
            return None;
        }
        let (stiffness, damping) = (limits.stiffness, limits.damping);
        ranges.push(FreeRange { low: low - offset, high: high - offset, stiffness, damping });
    }
    let nonlinear = (!ranges.is_empty()).then(|| Arc::new(NonlinearLaw::Ranges(ranges)));
    let has_force = nonlinear.is_some() || [stiffness, file.damping, file.preload].iter().any(|x| *x != 0.0);
    if !has_force && file.actuator.is_none() {
        let at = signals.document.title_at(pointer);
        let help = "give `stiffness` [N/m], `damping` [N·s/m], `preload` [N], `limits` or `actuator`";
        signals.diagnostics.push(Diagnostic::error(&at, format!("{of} has no force")).with_help(help));
        return None;
    }
    let command = file.actuator.as_ref().map(|actuator| actuator.signal(pointer, signals));
    let spec = SpringDamperSpec {
        path,
        free_length: free,
        law: ForceLaw { stiffness, damping: file.damping, preload: file.preload, nonlinear },
        tension_only: file.tension_only,
        actuator: file.actuator.as_ref().map(LineActuatorFile::largest_force),
        activation: file.actuator.as_ref().and_then(|actuator| actuator.activation(&of, pointer, signals)),
    };
    spring_damper::check(&spec, &of, pointer, signals).then_some((spec, command))
}

impl Joiner<'_> {
    /// Path of a tendon; notes objects that it cannot run through, and joints that are none.
    pub fn tendon(&mut self, file: &TendonFile, pointer: &str) -> Option<PathSpec> {
        match (&file.through, &file.joints, &file.coefficients) {
            (Some(through), None, None) => {
                let nodes: Vec<_> = through
                    .iter()
                    .enumerate()
                    .map(|(k, path)| self.end(path, &format!("{pointer}/through/{k}")))
                    .collect();
                let points: Option<Vec<_>> = nodes.into_iter().map(|node| Some((node?, [0.0; 3]))).collect();
                Some(PathSpec::Points(points?))
            }
            (None, Some(joints), Some(coefficients)) if joints.len() == coefficients.len() => {
                let nodes: Vec<_> = joints
                    .iter()
                    .enumerate()
                    .map(|(k, path)| self.scalar_joint(path, &format!("{pointer}/joints/{k}")))
                    .collect();
                let twice = joints.iter().enumerate().find(|(k, path)| joints[..*k].contains(path));
                if let Some((k, path)) = twice {
                    let at = self.document.at(&format!("{pointer}/joints/{k}"));
                    let message = format!("tendon `{}` names the joint `{path}` twice", file.name);
                    self.diagnostics.push(Diagnostic::error(&at, message).with_help("add its coefficients"));
                    return None;
                }
                let shares: Option<Vec<_>> = nodes.into_iter().zip(coefficients).map(|(j, c)| Some((j?, *c))).collect();
                Some(PathSpec::Joints(shares?))
            }
            (None, Some(joints), Some(coefficients)) => {
                let at = self.document.at(&format!("{pointer}/coefficients"));
                let (n, m) = (joints.len(), coefficients.len());
                let message = format!("tendon `{}` has {n} joints and {m} coefficients", file.name);
                self.diagnostics.push(Diagnostic::error(&at, message).with_help("give a coefficient for each joint"));
                None
            }
            _ => {
                let at = self.document.title_at(pointer);
                let message = format!("tendon `{}` has no path, or two", file.name);
                let help = "give `through`, a list of bodies and frames, or `joints` and `coefficients`";
                self.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
                None
            }
        }
    }
}

//! Springs, dampers and actuators between two points: as written, and as the builder takes them.

use std::sync::Arc;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::actuation::force_law::FORMULA_NAMES;
use sincro_dynamics::actuation::{Activation, ForceLaw, ForceTable, NonlinearLaw};
use sincro_dynamics::model::{Model, NodeId, PathSpec, SpringDamperSpec};
use sincro_dynamics::recursions::kinematics;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::signal::Signal;
use sincro_dynamics::state::State;
use sincro_math::expression::Expression;

use super::activation::ActivationFile;
use super::file::SceneFile;
use super::signal_file::{SignalFile, SignalReader};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// Length below which a line has no direction `[m]`.
const NO_LENGTH: f64 = 1e-12;

/// Spring, damper and actuator along the line between two points; a positive force pushes them apart.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["law", "table"]})))]
pub(crate) struct SpringDamperFile {
    /// Letters, digits, `_` and `-`; its path is `/` and the name.
    pub name: String,
    /// Paths of the two bodies or frames, or `/`, that carry its ends.
    pub between: [String; 2],
    /// The two ends in the frames of these; default their origins [m].
    #[serde(default)]
    pub points: [[f64; 3]; 2],
    /// Length without deflection; default the length at the start [m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub free_length: Option<f64>,
    /// Force −stiffness·x, x the length less the free length [N/m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub stiffness: f64,
    /// Force −damping·v, v the rate of the length [N·s/m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub damping: f64,
    /// Constant force, positive where it pushes the ends apart [N].
    #[serde(default)]
    pub preload: f64,
    /// Formula of x [m] and v [m/s] for a force that is added [N].
    pub law: Option<String>,
    /// Points (x, force) of a force that is added, linear between them and beyond [m], [N].
    pub table: Option<Vec<[f64; 2]>>,
    /// True for a rope, which pulls when longer than its free length and never pushes.
    #[serde(default)]
    pub tension_only: bool,
    /// Actuator: its command is a force that is added.
    pub actuator: Option<LineActuatorFile>,
}

/// Actuator along a line.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LineActuatorFile {
    /// Command as a signal, held over each base step; default 0. Positive where it pushes the ends apart [N].
    pub command: Option<SignalFile>,
    /// Largest force; none if left out or inf [N].
    #[cfg_attr(test, schemars(range(min = 0.0), extend("x-infinite" = true)))]
    pub max_force: Option<f64>,
    /// Activation: a state between the command and the force [N].
    pub activation: Option<ActivationFile>,
}

impl LineActuatorFile {
    /// Command of the actuator of an element at `pointer`; notes what is no signal.
    pub(super) fn signal(&self, pointer: &str, signals: &mut SignalReader<'_>) -> Signal {
        match &self.command {
            Some(command) => signals.read(command, &format!("{pointer}/actuator/command")),
            None => Signal::Constant(0.0),
        }
    }

    /// Its activation, for the builder; notes what is wrong with it. `of` is the element as messages call it.
    pub(super) fn activation(
        &self,
        of: &str,
        pointer: &str,
        signals: &mut SignalReader<'_>,
    ) -> Option<Activation<f64>> {
        self.activation.as_ref().map(|own| own.spec(of, &format!("{pointer}/actuator/activation"), signals))
    }

    /// Largest force, infinite for none `[N]`.
    pub(super) fn largest_force(&self) -> f64 {
        self.max_force.unwrap_or(f64::INFINITY)
    }
}

/// The specification, for ends that were found, and the command of its actuator; none, with the reasons noted, if it
/// cannot be.
pub(super) fn spec(
    file: &SpringDamperFile,
    ends: [NodeId; 2],
    pointer: &str,
    signals: &mut SignalReader<'_>,
) -> Option<(SpringDamperSpec, Option<Signal>)> {
    let of = format!("spring_damper `{}`", file.name);
    let nonlinear = nonlinear(file.law.as_deref(), file.table.as_deref(), &of, pointer, signals)?;
    let command = file.actuator.as_ref().map(|actuator| actuator.signal(pointer, signals));
    let spec = SpringDamperSpec {
        path: PathSpec::Points(ends.into_iter().zip(file.points).collect()),
        free_length: file.free_length,
        law: ForceLaw { stiffness: file.stiffness, damping: file.damping, preload: file.preload, nonlinear },
        tension_only: file.tension_only,
        actuator: file.actuator.as_ref().map(LineActuatorFile::largest_force),
        activation: file.actuator.as_ref().and_then(|actuator| actuator.activation(&of, pointer, signals)),
    };
    if file.law.is_none() && file.table.is_none() && command.is_none() {
        let numbers = [file.stiffness, file.damping, file.preload];
        if numbers.iter().all(|x| *x == 0.0) {
            let at = signals.document.title_at(pointer);
            let diagnostic = Diagnostic::error(&at, format!("{of} has no force"));
            let help = "give `stiffness` [N/m], `damping` [N·s/m], `preload` [N], `law`, `table` or `actuator`";
            signals.diagnostics.push(diagnostic.with_help(help));
            return None;
        }
    }
    check(&spec, &of, pointer, signals).then_some((spec, command))
}

/// Notes the faults of the numbers of an element that messages call `of`; true if there is none.
pub(super) fn check(spec: &SpringDamperSpec, of: &str, pointer: &str, signals: &mut SignalReader<'_>) -> bool {
    let problems = spec.problems(of);
    for (key, message, help) in &problems {
        let at = signals.document.at(&format!("{pointer}/{key}"));
        signals.diagnostics.push(Diagnostic::error(&at, message.clone()).with_help(*help));
    }
    problems.is_empty()
}

/// Nonlinear part of the force law of `of`, from a formula or a table; none, with the reason noted, if it cannot be.
#[allow(clippy::option_option)] // a law may be left out, or be wrong
pub(super) fn nonlinear(
    law: Option<&str>,
    table: Option<&[[f64; 2]]>,
    of: &str,
    pointer: &str,
    signals: &mut SignalReader<'_>,
) -> Option<Option<Arc<NonlinearLaw>>> {
    let (key, made) = match (law, table) {
        (None, None) => return Some(None),
        (Some(text), _) => {
            let formula = Expression::parse(text, &FORMULA_NAMES).map_err(|e| {
                let help = e.help.unwrap_or_else(|| "it is a formula of the deflection x and its rate v".into());
                (vec![e.message], help)
            });
            let law = formula.and_then(|formula| {
                NonlinearLaw::formula(formula).map_err(|e| (e.into_iter().collect(), "give a table instead".into()))
            });
            ("law", law)
        }
        (None, Some(points)) => {
            let help = || "give points [x, force] with increasing x".into();
            let table = ForceTable::new(points).map_err(|e| (e.into_iter().collect(), help()));
            ("table", table.map(NonlinearLaw::Table))
        }
    };
    match made {
        Ok(law) => Some(Some(Arc::new(law))),
        Err((reasons, help)) => {
            let at = signals.document.at(&format!("{pointer}/{key}"));
            for reason in reasons {
                let diagnostic = Diagnostic::error(&at, format!("{key} of {of}: {reason}"));
                signals.diagnostics.push(diagnostic.with_help(help.clone()));
            }
            None
        }
    }
}

/// Sets the free lengths that are left out to the lengths at the start; notes lines that have no direction there.
pub(super) fn set_free_lengths(
    model: &mut Model<f64>,
    initial: &State<f64>,
    file: &SceneFile,
    document: &Document,
    diagnostics: &mut Diagnostics,
) {
    if model.spring_dampers().is_empty() {
        return;
    }
    let mut scratch = Scratch::new(model);
    kinematics::motions(model, &initial.q, &initial.v, &initial.v, &mut scratch);
    let lines = file.spring_damper.iter().map(|own| (own.name.as_str(), own.free_length)).enumerate();
    let tendons = file.tendon.iter().map(|own| (own.name.as_str(), own.model_free_length())).enumerate();
    let lines = lines.map(|(k, own)| (own, "spring_damper", format!("/spring_damper/{k}/between")));
    let tendons = tendons.map(|(k, own)| (own, "tendon", format!("/tendon/{k}/through")));
    for ((name, free_length), word, pointer) in lines.chain(tendons) {
        let Some(k_model) = model.names().spring_dampers.iter().position(|known| known.strip_prefix('/') == Some(name))
        else {
            continue;
        };
        let element = &model.spring_dampers()[k_model];
        let motion = |link: usize| (scratch.twist(link), scratch.link_poses()[link]);
        let length = element.length(&initial.q, &initial.v, motion).length;
        let has_force =
            element.actuator.is_some() || element.law.force(length - free_length.unwrap_or(length), 0.0) != 0.0;
        let shortest = element.segments().iter().map(|segment| segment.line(motion).length).reduce(f64::min);
        if shortest.is_some_and(|x| x < NO_LENGTH) && has_force {
            let at = document.at(&pointer);
            let message = format!("two points of {word} `{name}` coincide at the start: its force has no direction");
            let help = "move one of its points, or the joints; without force there (free_length = 0) it may start so";
            diagnostics.push(Diagnostic::error(&at, message).with_help(help));
        }
        if free_length.is_none() {
            model.set_free_length(k_model, length);
        }
    }
}

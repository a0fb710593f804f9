//! The setting that helps against a finding in the run at hand: never one that it has already.

use sincro_dynamics::initial::motor_conflict;
use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;
use sincro_scene::experiment::{Experiment, SMALLEST_ACCURACY};
use sincro_scene::scene::Scene;
use sincro_scene::suggest::quoted;

use super::Finding;

/// Accuracy below which a coarser one is advised where the finer run cannot meet it.
const COARSE: f64 = 1e-9;

/// Help for a finding, for a run of this experiment by this method.
pub(crate) fn help(finding: &Finding, experiment: &Experiment, method: MethodKind) -> String {
    match finding.law.as_str() {
        "source-frequency" => source(finding, experiment),
        "penetration" if finding.time == 0.0 => {
            "move the two apart in the initial state, or give one of them a `stiffness`".to_owned()
        }
        "joint-limit" if finding.time == 0.0 => "start within the limits: set `initial.position`".to_owned(),
        "finiteness" => {
            format!("look for a division by zero or a torque without limit there; {}", finer(experiment, method))
        }
        "velocity-level-step" => format!("{}; or give surfaces that touch a `stiffness`", finer(experiment, method)),
        "error-bar" => reachable(experiment, method),
        "contact-island" | "constraint-solver" => {
            format!("{}; or give surfaces that touch a `stiffness`", finer(experiment, method))
        }
        _ => finer(experiment, method),
    }
}

/// Help for a loop that does not stay closed, where velocity motors without a torque limit contradict it whatever the
/// method; `None` where they do not.
pub(crate) fn motors_against_loops(finding: &Finding, scene: &Scene) -> Option<String> {
    if !matches!(finding.law.as_str(), "loop-position" | "loop-velocity") {
        return None;
    }
    // numbers without a relation that a loop could demand
    let commands = (0..scene.initial.commands.len()).map(|k| 1.0 + 0.618_034 * k as f64).collect();
    let state = State { commands, ..scene.initial.clone() };
    let conflict = motor_conflict(&scene.model, &state)?;
    let loops: Vec<&str> = conflict.opened.iter().map(|constraint| constraint.name.as_str()).collect();
    Some(format!(
        "the motors of {} hold their velocities exactly, and {} allows only some of them: give one of the motors a \
         `max_torque`, or commands that agree",
        quoted(&conflict.joints(&scene.model)),
        quoted(&loops)
    ))
}

/// A smaller step or sample time for a source.
pub(super) fn source(finding: &Finding, experiment: &Experiment) -> String {
    let longest = 0.5 / finding.value;
    let period = 0.5 / finding.limit;
    if period > 1.5 * experiment.step {
        return format!(
            "take a sample time below {longest:.2e} s for it, or a frequency below {:.4} Hz",
            finding.limit
        );
    }
    format!("take step = {:?}, or a frequency below {:.4} Hz", rounded(longest / 2.5), finding.limit)
}

/// A finer integration than the present one.
fn finer(experiment: &Experiment, method: MethodKind) -> String {
    if method.controls_error() && experiment.accuracy >= 1e3 * SMALLEST_ACCURACY {
        let accuracy = rounded(0.01 * experiment.accuracy).max(SMALLEST_ACCURACY);
        return format!("take accuracy = {accuracy:e} instead of {:e}, or {}", experiment.accuracy, step(experiment));
    }
    finer_steps(experiment, method)
}

/// Another method than one of fixed steps, or a smaller step.
pub(crate) fn finer_steps(experiment: &Experiment, method: MethodKind) -> String {
    if method.controls_error() {
        return format!("take {}", step(experiment));
    }
    // `auto` takes a method with error control
    format!("take integrator = \"auto\" instead of \"{}\", or {}", experiment.integrator.word(), step(experiment))
}

fn step(experiment: &Experiment) -> String {
    format!("step = {:?} instead of {:?}", rounded(0.1 * experiment.step), experiment.step)
}

/// A setting that the finer run can meet.
fn reachable(experiment: &Experiment, method: MethodKind) -> String {
    if method.controls_error() && experiment.accuracy < COARSE {
        let coarser = rounded(100.0 * experiment.accuracy);
        return format!(
            "take accuracy = {coarser:e} instead of {:e}, which the finer run can meet",
            experiment.accuracy
        );
    }
    finer(experiment, method)
}

/// Two significant digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

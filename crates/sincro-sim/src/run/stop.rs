//! Explanation of a stop: tick, joint, likely cause, and the setting that helps.

use sincro_dynamics::integrate::Failure;
use sincro_dynamics::stiffness::{RK4_LIMIT, stiffest};
use sincro_dynamics::world::{MethodKind, Stop, World};

use super::lockstep::{Halt, LockStep};
use super::method_word;
use crate::audit::finer_steps;
use crate::controller::NotFinite;
use crate::results::Status;
use sincro_scene::experiment::Experiment;

impl Halt {
    /// Explains the stop of a run as its status: tick, time, likely physical cause and remedy; for a world from the
    /// last state that was finite. `method` is the integration method of the run.
    #[must_use]
    pub fn explain(self, lockstep: &mut LockStep, experiment: &Experiment) -> Status {
        match self {
            Self::World { tick, t, cause } => explain(lockstep.world(), experiment, (tick, t, cause)),
            Self::Block { tick, t, culprit } => of_block(tick, t, &culprit),
            Self::Controller { tick, t, fault, .. } => {
                let reason = format!("{fault} (tick {tick}, t = {t:.6} s)");
                Status::Stopped { tick, time: t, reason, help: fault.help.unwrap_or_default() }
            }
        }
    }
}

/// A block that gave what is not a number.
fn of_block(tick: u64, time: f64, culprit: &NotFinite) -> Status {
    let list = |numbers: &[f64]| numbers.iter().take(6).map(number).collect::<Vec<_>>().join(", ");
    let NotFinite { block, kind, outputs, inputs, fault } = culprit;
    if let Some(fault) = fault {
        let reason = format!("block `{block}` ({kind}) failed in tick {tick} at t = {time:.6} s: {fault}");
        let help = "mend the line; what the block was given is in the signals before it".to_owned();
        return Status::Stopped { tick, time, reason, help };
    }
    let inputs_were = if inputs.is_empty() { String::new() } else { format!(" from the inputs {}", list(inputs)) };
    let reason =
        format!("block `{block}` ({kind}) gave {} in tick {tick} at t = {time:.6} s{inputs_were}", list(outputs));
    let help = match *kind {
        "divide" => "the divisor was zero: keep it away from zero with a `saturation` or `max` before the block",
        "expression" | "equations" | "function" | "sqrt" | "ln" | "power" => {
            "look for a division by zero or a root or logarithm of a negative number in it, and limit its inputs"
        }
        _ => "look at the blocks before it: something grew without bound, or a division by zero",
    };
    Status::Stopped { tick, time, reason, help: help.to_owned() }
}

/// Six digits.
fn number(x: &f64) -> String {
    if *x == 0.0 || !x.is_finite() || (1e-3..1e7).contains(&x.abs()) { format!("{x:.6}") } else { format!("{x:.6e}") }
}

/// The stop in words, from the last state that was still finite.
fn explain(world: &World, experiment: &Experiment, (tick, time, cause): (u64, f64, Stop)) -> Status {
    let method = world.method();
    let what = match cause {
        Stop::Integration(Failure::NotFinite { .. }) => "the motion stopped being finite".to_owned(),
        Stop::Integration(Failure::StepTooSmall { h, .. }) => {
            format!("`{}` found no step small enough (down to {h:.1e} s)", method_word(method))
        }
        Stop::Unsolved { residual, .. } => {
            format!("the constraint solver found no forces that fit 100,000 times (misfit up to {residual:.1e})")
        }
        Stop::Chatter { .. } => "a limited motor, a friction or a block changed too often within one step".to_owned(),
        Stop::EndlessEvents { .. } => "events of blocks follow from each other without end".to_owned(),
    };
    if let Some(rotor) = world.rotor_without_load() {
        let name = &world.model().names().rotors[rotor.index()];
        let reason = format!(
            "rotor `{name}`, the script as printed, gave what is not a number in tick {tick} at t = {time:.6} s, at {} rad/s",
            number(&world.rotor_speed(rotor))
        );
        let help = "its closed form has no root there; take `blade` in place of `printed`: the corrected model is finite everywhere";
        return Status::Stopped { tick, time, reason, help: help.to_owned() };
    }
    let suspect = suspect(world, experiment, method);
    let reason = format!("{what} in tick {tick} at t = {time:.6} s; {}", suspect.0);
    let help = help(world, experiment, method).unwrap_or(suspect.1);
    Status::Stopped { tick, time, reason, help }
}

/// The fastest joint of the last finite state, and general advice.
fn suspect(world: &World, experiment: &Experiment, method: MethodKind) -> (String, String) {
    let v = &world.state.v;
    let fastest = (0..v.len()).max_by(|a, b| v[*a].abs().total_cmp(&v[*b].abs()));
    let advice = format!("look for a torque without limit, or {}", finer_steps(experiment, method));
    match fastest {
        Some(k) => {
            (format!("joint `{}` was fastest, with a rate of {:.3e}", world.model().names().dof_name(k), v[k]), advice)
        }
        None => ("nothing moves in this scene".to_owned(), advice),
    }
}

/// The mend, if a stiff joint under an explicit method explains it.
fn help(world: &World, experiment: &Experiment, method: MethodKind) -> Option<String> {
    let s = stiffest(world.model(), &world.state)?;
    let product = s.rate * experiment.step;
    (method == MethodKind::Rk4 && product > RK4_LIMIT).then(|| {
        format!(
            "spring and damper of {} act at {:.2e} 1/s, too fast for `rk4` at {} s: use integrator = \"implicit\" or \
             \"auto\", or a step below {:.1e} s",
            s.element_name(world.model()),
            s.rate,
            experiment.step,
            RK4_LIMIT / s.rate
        )
    })
}

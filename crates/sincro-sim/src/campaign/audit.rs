//! Audit of a run with its error bars: the laws it was measured against, its inputs, its energy balance.

use super::refine::error_bar_factor;
use crate::audit::{AuditReport, Finding, energy_limit, help, motors_against_loops, sources};
use crate::load::Loaded;
use crate::run::{Simulated, finer_accuracy};

/// Audits a run of `loaded`: the laws of its mechanism and solver, its sources and its energy balance. `finer` is the
/// finer run of its error bars, if there was one; without it some laws are left out.
#[must_use]
pub fn audit(loaded: &Loaded, run: &Simulated, finer: Option<&Simulated>) -> AuditReport {
    let mut laws = run.laws.clone();
    let factor = error_bar_factor(run.method, loaded.experiment.accuracy);
    let finer_share = if run.method.controls_error() { finer_accuracy(loaded.experiment.accuracy) } else { 0.0 };
    laws.extend(finer.map(|finer| {
        if finer.status.is_good() { energy_balance(run, finer, factor, finer_share) } else { stop(run, finer) }
    }));
    laws.extend(sources(loaded));
    for law in laws.iter_mut().filter(|law| !law.holds() && law.help.is_empty()) {
        let of_motors = motors_against_loops(law, &loaded.scene);
        law.help = of_motors.unwrap_or_else(|| help(law, &loaded.experiment, run.method));
    }
    AuditReport::of(laws)
}

/// Stop of the finer run: time that it did not reach.
fn stop(run: &Simulated, finer: &Simulated) -> Finding {
    let time = finer.status.stopped_at().unwrap_or(0.0);
    Finding {
        law: "error-bar".to_owned(),
        element: "finer run".to_owned(),
        time,
        value: run.table.times().last().copied().unwrap_or(0.0) - time,
        limit: 0.0,
        unit: "s".to_owned(),
        help: String::new(),
    }
}

/// Largest energy balance of a run, against what the error bar of the balance allows: `factor` times the largest
/// difference from the finer run, which controls energies to the share `finer_share` of the largest.
fn energy_balance(run: &Simulated, finer: &Simulated, factor: f64, finer_share: f64) -> Finding {
    let (balances, times) = (&run.balances, run.table.times());
    let worst = (0..balances.len()).max_by(|a, b| balances[*a].abs().total_cmp(&balances[*b].abs())).unwrap_or(0);
    let difference = balances.iter().zip(&finer.balances).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    Finding {
        law: "energy-balance".to_owned(),
        element: "energy.balance".to_owned(),
        time: times.get(worst).copied().unwrap_or(0.0),
        value: balances.get(worst).map_or(0.0, |x| x.abs()),
        limit: energy_limit(factor * difference, run.energy_scale, finer_share, &run.statistics),
        unit: "J".to_owned(),
        help: String::new(),
    }
}

//! Audit of a run: the laws of the mechanism, the constraint solver, the energy balance, the frequencies of inputs.
//!
//! | file | content |
//! |---|---|
//! | `laws` | worst residual of each law over a run, with its time and element |
//! | `limits` | largest residuals that the accuracy asked for allows |
//! | `sources` | sines, chirps and sampled series above half the rate at which they are read |
//! | `help` | the setting that helps in the run at hand |
//!
//! Every run is audited, with or without error bars; the energy balance needs the finer run of an error bar. A value
//! beyond its limit is a [`Finding`]. `docs/accuracy.md` has every law with its formula, unit and limit.

mod help;
mod laws;
mod limits;
mod sources;

use serde::{Deserialize, Serialize};

pub(crate) use help::{finer_steps, help, motors_against_loops};
pub use laws::LawAudit;
pub(crate) use limits::energy_limit;
pub use sources::source_findings;
pub(crate) use sources::sources;

/// Law that a run was measured against, with its worst value and the limit there; an entry of [`AuditReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// Name of the law, such as `loop-position` or `energy-balance` (`docs/accuracy.md`).
    pub law: String,
    /// Path of the element, or name of the signal or solver concerned.
    pub element: String,
    /// Time at which the value occurred `[s]`.
    pub time: f64,
    /// Worst value found, in `unit`.
    #[serde(with = "crate::number")]
    pub value: f64,
    /// Largest value allowed, in `unit`.
    #[serde(with = "crate::number")]
    pub limit: f64,
    /// Unit of value and limit; empty for relative residuals and counts.
    #[serde(default)]
    pub unit: String,
    /// Remedy, such as the setting that would help; empty for a law that holds.
    #[serde(default)]
    pub help: String,
}

impl Finding {
    /// Returns true if the value is within its limit; a value that is not a number never is.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.value <= self.limit
    }

    /// Value relative to the limit, for comparison with other findings.
    fn share(&self) -> f64 {
        let share = self.value / self.limit;
        if share.is_nan() { f64::INFINITY } else { share }
    }
}

/// Audit of a run: the physical and numerical laws it was measured against, and those that it violates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AuditReport {
    /// True if no law is violated.
    pub ok: bool,
    /// Laws with a value beyond their limit, in the order of `laws`.
    pub findings: Vec<Finding>,
    /// All laws that the run was measured against, each with its worst value.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub laws: Vec<Finding>,
}

impl Default for AuditReport {
    fn default() -> Self {
        Self { ok: true, findings: Vec::new(), laws: Vec::new() }
    }
}

impl AuditReport {
    /// Creates the report of a run from the laws it was measured against, one entry for each; those that do not hold
    /// become findings.
    #[must_use]
    pub fn of(laws: Vec<Finding>) -> Self {
        let findings: Vec<Finding> = laws.iter().filter(|law| !law.holds()).cloned().collect();
        Self { ok: findings.is_empty(), findings, laws }
    }

    /// Creates the common report of several runs: of each law the entry farthest beyond (or nearest to) its limit.
    /// `runs` yields the name of each run, which is added to the element, and its report.
    #[must_use]
    pub fn worst(runs: impl IntoIterator<Item = (String, Self)>) -> Self {
        let mut laws: Vec<Finding> = Vec::new();
        for (name, report) in runs {
            for law in report.laws {
                let named = Finding { element: format!("{} ({name})", law.element), ..law };
                match laws.iter_mut().find(|known| known.law == named.law) {
                    Some(known) if known.share() < named.share() => *known = named,
                    Some(_) => {}
                    None => laws.push(named),
                }
            }
        }
        Self::of(laws)
    }
}

//! Limits of the audit: the residual of each law that a run may show. `docs/accuracy.md` explains them.

use sincro_dynamics::world::audit::{Law, LawResidual};
use sincro_dynamics::world::{MethodKind, StepStatistics};
use sincro_scene::experiment::Experiment;

/// Accuracy that stands for a method without error control: the default of the experiment file. Projection closes the
/// constraints of a fixed step, too, whatever its own error.
const FIXED_STEP_ACCURACY: f64 = 1e-9;

/// Smallest limit of a residual of the state: ten times the tolerance of the projection onto the constraints.
const SMALLEST_STATE: f64 = 1e-11;

/// Smallest limit of a residual of forces: ten times the complementarity tolerance of the solver.
const SMALLEST_FORCE: f64 = 1e-8;

/// Largest residual of an island of contacts in a step at velocity level, whose own error is of first order, relative
/// to the largest force of the island.
pub(super) const ISLAND: f64 = 5e-3;

/// Share of a balance or a difference that is rounding: of each step, relative to the energies.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Multiple of an error bar that a true error hardly ever exceeds.
const BARS: f64 = 3.0;

/// Tolerances of a run, to be multiplied by the scales of the residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Residuals of coordinates and velocities.
    state: f64,
    /// Residuals of forces, relative to the largest.
    force: f64,
    /// Distance by which a step at velocity level passes a limit or surface that it has not foreseen, over the largest
    /// acceleration [s²]; zero for methods that locate the instant.
    per_acceleration: f64,
}

impl Limits {
    /// Tolerances of a method at the accuracy of an experiment.
    pub fn new(experiment: &Experiment, method: MethodKind) -> Self {
        let accuracy = match method {
            method if method.controls_error() => experiment.accuracy,
            _ => FIXED_STEP_ACCURACY,
        };
        let h = experiment.step;
        let per_acceleration = if method == MethodKind::SemiImplicitEuler { 0.5 * h * h } else { 0.0 };
        Self { state: accuracy.max(SMALLEST_STATE), force: accuracy.max(SMALLEST_FORCE), per_acceleration }
    }

    /// Largest residual of a law of the mechanism, in its unit; `acceleration` is the largest of the run.
    pub fn of(&self, law: Law, residual: &LawResidual, acceleration: f64) -> f64 {
        let distance = residual.scale * self.per_acceleration * acceleration;
        match law {
            Law::Finiteness => 0.0,
            // contacts and limits close at a distance of 1e-9
            Law::JointLimit | Law::Penetration => self.state.max(FIXED_STEP_ACCURACY) * residual.scale + distance,
            Law::LoopPosition | Law::LoopVelocity | Law::DriveVelocity | Law::DriveMode => self.state * residual.scale,
            Law::NormalForce | Law::FrictionCone | Law::DriveForce => self.force * residual.scale,
        }
    }

    /// Largest local error of a step, relative to max(|y|, 1).
    pub fn local_error(&self) -> f64 {
        self.state
    }

    /// Largest complementarity residual of a constraint problem, relative to the largest force or rate.
    pub fn unsolved(&self) -> f64 {
        self.force
    }
}

/// Largest energy balance `[J]` that an error bar allows: of the balance itself, between the run and the finer one;
/// `scale` is the largest energy that entered, and `finer_accuracy` the share of it that a step of the finer run may
/// miss the energies by: an error below that need not differ between the two. Beyond a third of that energy no digit of
/// the energies is known, whatever the bar. Of energies without limit none is allowed.
pub(crate) fn energy_limit(bar: f64, scale: f64, finer_accuracy: f64, statistics: &StepStatistics) -> f64 {
    if !scale.is_finite() {
        return 0.0;
    }
    let bar = bar.max(finer_accuracy * scale);
    let uncertain = (BARS * (bar + statistics.event_work)).min(scale / 3.0);
    uncertain + ROUNDING * scale * (statistics.steps.max(1) as f64).sqrt()
}

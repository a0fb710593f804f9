//! Worst residual of each law over a run, with its time and element.

use sincro_dynamics::model::Model;
use sincro_dynamics::world::audit::{Law, LawResidual};
use sincro_dynamics::world::{MethodKind, Observation, World};
use sincro_scene::experiment::Experiment;

use super::Finding;
use super::limits::{ISLAND, Limits};

/// Audit of a run while it goes on: keeps the worst residual of each law of the mechanism and the solver, without
/// allocation. [`Recording`](crate::run::Recording) has one; a run driven otherwise calls [`LawAudit::observe`],
/// [`LawAudit::tick`] and at the end [`LawAudit::close`].
#[derive(Clone, Debug)]
pub struct LawAudit {
    /// For each law the worst residual and its time `[s]`.
    worst: [Option<(LawResidual, f64)>; Law::ALL.len()],
    /// Names of the elements of the worst residuals that were found in a model of another structure.
    names: [Option<String>; Law::ALL.len()],
    /// Constraint problems without convergence: their worst residual, and the time `[s]` after the step that had it.
    unsolved: (f64, f64),
    /// Largest residual of an island of contacts, and the time `[s]` after the step that had it.
    rough: (f64, f64),
    /// Ticks finished, and steps made, at velocity level because contacts or drives changed without end, decisions
    /// between modes of drives that did not end, jams, and the time `[s]` after the first.
    fallback: (u64, f64),
    /// Largest acceleration [rad/s²], [m/s²].
    acceleration: f64,
}

impl Default for LawAudit {
    fn default() -> Self {
        Self {
            worst: [None; Law::ALL.len()],
            names: [const { None }; Law::ALL.len()],
            unsolved: (0.0, 0.0),
            rough: (0.0, 0.0),
            fallback: (0, 0.0),
            acceleration: 0.0,
        }
    }
}

impl LawAudit {
    /// Goes on with a model of another structure; `former` is the one so far.
    pub fn restructured(&mut self, former: &Model<f64>) {
        for (worst, name) in self.worst.iter().zip(&mut self.names) {
            if let (Some((residual, _)), None) = (worst, &name) {
                *name = Some(residual.element.name(former));
            }
        }
    }

    /// Takes the residuals of the laws at the state observed at time `t` `[s]`; to be called at each recorded instant.
    pub fn observe(&mut self, seen: &Observation<'_>, t: f64) {
        self.acceleration = seen.accelerations.iter().fold(self.acceleration, |largest, a| largest.max(a.abs()));
        for (law, residual) in seen.law_residuals().iter() {
            let worst = &mut self.worst[law as usize];
            if worst.is_none_or(|(known, _)| residual.relative() > known.relative()) {
                *worst = Some((*residual, t));
                self.names[law as usize] = None;
            }
        }
    }

    /// Takes the solver's statistics after the step that ended at time `t` `[s]`; to be called after each step.
    pub fn tick(&mut self, world: &World, t: f64) {
        let residual = world.solver_report().map_or(0.0, |report| report.worst_residual);
        if residual > self.unsolved.0 {
            self.unsolved = (residual, t);
        }
        let rough = world.solver_report().map_or(0.0, |report| report.worst_island);
        if rough > self.rough.0 {
            self.rough = (rough, t);
        }
        let done = world.statistics();
        let jams = world.jams().count as u64;
        let steps = done.fallback_ticks + done.fallback_steps + done.undecided_modes + jams;
        self.fallback = (steps, if self.fallback.0 == 0 { t } else { self.fallback.1 });
    }

    /// Returns one finding for each law that something in the world was subject to, with its worst value and limit;
    /// `method` is the integration method of the run.
    #[must_use]
    pub fn close(&self, world: &World, experiment: &Experiment, method: MethodKind) -> Vec<Finding> {
        let limits = Limits::new(experiment, method);
        let mut laws = Vec::new();
        for law in Law::ALL {
            let Some((residual, time)) = self.worst[law as usize] else { continue };
            laws.push(Finding {
                law: word(law).to_owned(),
                element: self.names[law as usize].clone().unwrap_or_else(|| residual.element.name(world.model())),
                time,
                value: residual.value,
                limit: limits.of(law, &residual, self.acceleration),
                unit: residual.kind.unit().to_owned(),
                help: String::new(),
            });
        }
        laws.extend(world.solver_report().map(|report| Finding {
            law: "constraint-solver".to_owned(),
            element: format!("{} of {} problems", report.not_converged, report.solved),
            time: self.unsolved.1,
            value: self.unsolved.0,
            limit: limits.unsolved(),
            unit: String::new(),
            help: String::new(),
        }));
        laws.extend(world.solver_report().filter(|report| report.islands > 0).map(|report| Finding {
            law: "contact-island".to_owned(),
            element: format!("{} of {} islands above 1e-6", report.unconverged_islands, report.islands),
            time: self.rough.1,
            value: report.worst_island,
            limit: ISLAND,
            unit: String::new(),
            help: String::new(),
        }));
        laws.extend((self.fallback.0 > 0).then(|| self.velocity_level_steps(world, experiment, &limits)));
        laws
    }

    /// Local errors of all steps at velocity level, which are of first order; where modes were not decided, of a step
    /// made in sixteen of them.
    fn velocity_level_steps(&self, world: &World, experiment: &Experiment, limits: &Limits) -> Finding {
        let done = world.statistics();
        let undecided = done.undecided_modes as f64 * experiment.step * experiment.step / 16.0;
        let square = done.fallback_square + undecided;
        Finding {
            law: "velocity-level-step".to_owned(),
            element: format!("{} in {} steps", self.fallback.0, world.state.tick),
            time: self.fallback.1,
            value: 0.5 * square * self.acceleration,
            limit: limits.local_error(),
            unit: String::new(),
            help: String::new(),
        }
    }
}

/// Name of a law in files.
fn word(law: Law) -> &'static str {
    match law {
        Law::Finiteness => "finiteness",
        Law::LoopPosition => "loop-position",
        Law::LoopVelocity => "loop-velocity",
        Law::JointLimit => "joint-limit",
        Law::Penetration => "penetration",
        Law::NormalForce => "normal-force",
        Law::FrictionCone => "friction-cone",
        Law::DriveVelocity => "drive-velocity",
        Law::DriveMode => "drive-mode",
        Law::DriveForce => "drive-force",
    }
}

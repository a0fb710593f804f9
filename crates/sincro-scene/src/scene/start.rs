//! Consistency of the state that a scene starts in: open loops, positions beyond limits, overlaps, velocities that open
//! loops, and motors that contradict them.

use sincro_dynamics::initial::{self, ConstraintRate};
use sincro_dynamics::model::Model;
use sincro_dynamics::signal::Signal;
use sincro_dynamics::state::State;

use super::file::SceneFile;
use super::object::Object;
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::document::Document;
use crate::suggest;

/// A loop open by more than this at the start is an error `[m]`, `[rad]`.
const CLOSED: f64 = 1e-6;

/// Overlap at the start that is put down to rounding of figures in the file `[m]`.
const OVERLAP: f64 = 1e-9;

/// Rate of a loop at the start that is put down to rounding of figures in the file, relative to the velocities and the
/// extent of the mechanism.
const AT_REST: f64 = 1e-6;

/// Joints named in a help text at most.
const MAX_NAMED: usize = 6;

/// The scene as far as it is needed to tell where a diagnostic belongs.
pub(super) struct Start<'a> {
    pub model: &'a Model<f64>,
    pub initial: &'a State<f64>,
    pub file: &'a SceneFile,
    pub objects: &'a [Object],
    pub document: &'a Document,
}

impl Start<'_> {
    /// Looks for everything that cannot start, with these commands of the scene.
    pub fn check(&self, commands: &[Signal], diagnostics: &mut Diagnostics) {
        // of an open loop there are no velocities to speak of
        if self.check_loops(diagnostics) {
            self.check_velocities(diagnostics);
            self.check_motors(commands, diagnostics);
        }
        self.check_limits(diagnostics);
        if !self.file.allow_overlap {
            self.check_overlaps(diagnostics);
        }
    }

    /// Returns true if all loops are closed.
    fn check_loops(&self, diagnostics: &mut Diagnostics) -> bool {
        let residuals = initial::constraint_residuals(self.model, self.initial);
        let mut is_closed = true;
        for opening in residuals.into_iter().filter(|o| o.distance > CLOSED || o.angle > CLOSED) {
            is_closed = false;
            let gap = match self.unit_of_coupling(&opening.name) {
                Some(unit) => format!("its second joint is off by {:.6e} {unit}", opening.distance),
                None if opening.distance > CLOSED => format!("its ends are {:.6e} m apart", opening.distance),
                None => format!("its axes are off by {:.6e} rad", opening.angle),
            };
            let message = format!("{} is open at the start: {gap}", self.loop_words(&opening.name));
            let diagnostic = Diagnostic::error(&self.of_loop(&opening.name), message);
            diagnostics.push(diagnostic.with_help(match initial::assemble(self.model, self.initial) {
                Some(q) => format!("it closes if the joints start at {}", self.positions(&q)),
                None => "no position of the joints near the given ones closes it: check lengths and places".into(),
            }));
        }
        is_closed
    }

    fn check_limits(&self, diagnostics: &mut Diagnostics) {
        for beyond in initial::limit_violations(self.model, self.initial) {
            let message =
                format!("joint `{}` starts at {}, beyond its limit {}", beyond.joint, beyond.position, beyond.limit);
            let diagnostic = Diagnostic::error(&self.of_object(&[&beyond.joint]), message);
            diagnostics.push(diagnostic.with_help("start within the limits, or move them"));
        }
    }

    fn check_velocities(&self, diagnostics: &mut Diagnostics) {
        let rates = initial::constraint_rates(self.model, self.initial);
        for opening in rates.into_iter().filter(|opening| opening.relative > AT_REST) {
            let (words, rate) = (self.loop_words(&opening.name), self.rate_words(&opening));
            let message = format!("the initial velocities open {words}: {rate}");
            let diagnostic = Diagnostic::error(&self.of_loop(&opening.name), message);
            diagnostics.push(match initial::consistent_velocities(self.model, self.initial) {
                Some(v) => diagnostic.with_help(format!("it stays closed with the velocities {}", self.velocities(&v))),
                None => diagnostic,
            });
        }
    }

    /// Motors whose commands at the start contradict the loops.
    fn check_motors(&self, commands: &[Signal], diagnostics: &mut Diagnostics) {
        let commands = commands.iter().map(|command| command.value(0.0)).collect();
        let state = State { commands, ..self.initial.clone() };
        let Some(conflict) = initial::motor_conflict(self.model, &state) else { return };
        let motors = conflict.joints(self.model);
        let opened = conflict.opened.iter().map(|o| format!("{}: {}", self.loop_words(&o.name), self.rate_words(o)));
        let message = format!(
            "the commands of the motors of {} open {}",
            suggest::quoted(&motors),
            opened.collect::<Vec<_>>().join("; ")
        );
        let diagnostic = Diagnostic::error(&self.of_object(&motors), message);
        let help =
            "these motors hold their velocities exactly: give one of them a `max_torque`, or commands that agree";
        diagnostics.push(diagnostic.with_help(help));
    }

    fn check_overlaps(&self, diagnostics: &mut Diagnostics) {
        let overlaps = initial::penetrations(self.model, self.initial);
        for overlap in overlaps.into_iter().filter(|o| o.depth > OVERLAP) {
            let message =
                format!("`{}` and `{}` overlap at the start by {:.6e} m", overlap.a, overlap.b, overlap.depth);
            let help = "move one, give both the same `group` in `contact`, or set allow_overlap = true for the scene";
            let at = self.of_object(&[&overlap.a, &overlap.b]);
            diagnostics.push(Diagnostic::error(&at, message).with_help(help));
        }
    }

    /// Place of a closure or coupling in the file.
    fn of_loop(&self, name: &str) -> Location {
        let is_meant = |own: &str| name.strip_prefix('/') == Some(own);
        let closure = self.file.closure.iter().position(|c| is_meant(&c.name)).map(|k| format!("/closure/{k}"));
        let coupling = || self.file.coupling.iter().position(|c| is_meant(&c.name)).map(|k| format!("/coupling/{k}"));
        self.document.title_at(&closure.or_else(coupling).unwrap_or_default())
    }

    /// Unit of the second joint of a coupling; `None` for a closure.
    fn unit_of_coupling(&self, name: &str) -> Option<&'static str> {
        let gear = self.model.constraints().gears.iter().find(|gear| gear.name == name)?;
        Some(if self.model.is_translation(gear.dofs[1]) { "m" } else { "rad" })
    }

    fn loop_words(&self, name: &str) -> String {
        let kind = if self.unit_of_coupling(name).is_some() { "coupling" } else { "closure" };
        format!("{kind} `{name}`")
    }

    /// The larger of the rates at which a loop opens.
    fn rate_words(&self, rate: &ConstraintRate) -> String {
        match self.unit_of_coupling(&rate.name) {
            Some(unit) => format!("its second joint is off by {:.6e} {unit}/s", rate.speed),
            None if rate.speed >= rate.angular_speed => format!("its ends part at {:.6e} m/s", rate.speed),
            None => format!("its axes turn against each other at {:.6e} rad/s", rate.angular_speed),
        }
    }

    /// Place of the first of these objects in the file.
    fn of_object(&self, paths: &[&str]) -> Location {
        let object = self.objects.iter().find(|o| paths.contains(&o.path.as_str()));
        object.map_or_else(|| self.document.at(""), |o| o.location.clone())
    }

    /// Joints that would start at other positions than they do, and where.
    fn positions(&self, q: &[f64]) -> String {
        let joints = self.model.names().joints.iter();
        differing(joints.map(|j| (j.name.as_str(), j.q_idx, j.n_q)), &self.initial.q, q)
    }

    /// Joints that would start with other velocities than they do, and with which.
    fn velocities(&self, v: &[f64]) -> String {
        let joints = self.model.names().joints.iter();
        differing(joints.map(|j| (j.name.as_str(), j.v_idx, j.n_v)), &self.initial.v, v)
    }
}

/// Numbers that differ between two lists, by the joints that they belong to: name, first index and number of each.
fn differing<'a>(joints: impl Iterator<Item = (&'a str, usize, usize)>, given: &[f64], other: &[f64]) -> String {
    let numbers = joints.flat_map(|(name, first, n)| (first..first + n).map(move |k| (name, k)));
    let changed = numbers.filter(|(_, k)| (other[*k] - given[*k]).abs() > 1e-9 * other[*k].abs().max(1.0));
    changed.take(MAX_NAMED).map(|(name, k)| format!("{name} = {:.12}", other[k])).collect::<Vec<_>>().join(", ")
}

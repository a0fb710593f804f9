//! Wiring of a compiled diagram: which measurements of the world are read into which of its signals.

use std::sync::Arc;

use sincro_blocks::program::{Measured, Program};

use super::ports::Measurement;
use crate::record::Probe;
use crate::record::probe;

/// Measurement that a compiled diagram reads, with the place of its components among the diagram's signals; an entry of
/// [`Wiring::early`] or [`Wiring::late`].
#[derive(Clone, Debug)]
pub struct MeasuredSignals {
    /// Probes of its components, in their order.
    pub probes: Vec<Probe>,
    /// Index of the first component among the diagram's signals; the others follow.
    pub at: usize,
    /// True if continuous blocks read it, between ticks, too.
    pub is_minor: bool,
}

/// Connection of a compiled diagram to a model: which measurements are read into which signals, and which signals are
/// commands. Part of a [`ControlDiagram`](super::ControlDiagram).
#[derive(Clone, Debug)]
pub struct Wiring {
    program: Arc<Program>,
    /// Measurements that are functions of the state, read before the blocks are evaluated.
    pub early: Vec<MeasuredSignals>,
    /// Measurements that depend on accelerations, and through them on the commands.
    pub late: Vec<MeasuredSignals>,
    /// True if a measurement needs poses and twists of the links: at ticks (first entry), between ticks (second).
    pub needs_poses: [bool; 2],
}

impl Wiring {
    pub(super) fn new(program: Arc<Program>, measurements: &[Measurement]) -> Self {
        let reading = |m: &Measured| MeasuredSignals {
            probes: measurements[m.terminal].probes.clone(),
            at: m.out.start,
            is_minor: m.is_minor,
        };
        let early: Vec<MeasuredSignals> = program.early.iter().map(reading).collect();
        let late = program.late.iter().map(reading).collect();
        let needs = |r: &MeasuredSignals| r.probes.iter().any(|p| probe::needs_kinematics(*p));
        let needs_poses = [early.iter().any(needs), early.iter().any(|r| r.is_minor && needs(r))];
        Self { early, late, needs_poses, program }
    }

    /// Which measurement of the world a signal is, if it is one.
    pub(super) fn measured(&self, signal: usize) -> Option<Probe> {
        let all = self.early.iter().chain(&self.late);
        let reading = all.into_iter().find(|r| (r.at..r.at + r.probes.len()).contains(&signal))?;
        Some(reading.probes[signal - reading.at])
    }

    /// Returns the compiled diagram: blocks in their order of evaluation, with the indices of their signals.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }
}

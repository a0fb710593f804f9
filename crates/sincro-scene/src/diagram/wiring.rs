//! Wiring of a compiled diagram: which measurements of the world are read into which of its signals.

use std::sync::Arc;

use sincro_blocks::program::{Measured, Program};

use super::ports::Measurement;
use crate::record::Probe;
use crate::record::probe;

/// A measurement in use: its components and their places among the signals.
#[derive(Clone, Debug)]
pub struct MeasuredSignals {
    /// Its components.
    pub probes: Vec<Probe>,
    /// Place of the first among the signals.
    pub at: usize,
    /// True if it is read between ticks, too.
    pub is_minor: bool,
}

/// Connection of a compiled diagram to a model: its measurements and its commands.
#[derive(Clone, Debug)]
pub struct Wiring {
    program: Arc<Program>,
    /// Measurements that are functions of the state.
    pub early: Vec<MeasuredSignals>,
    /// Measurements that depend on accelerations, and with them on the commands.
    pub late: Vec<MeasuredSignals>,
    /// True if any measurement needs poses and twists: at ticks, and between them.
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

    /// Compiled diagram that is wired.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }
}

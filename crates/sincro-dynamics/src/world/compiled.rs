//! Steps and right-hand sides of a world by code that was compiled for its model.
//!
//! Compiled code has the bits of the recursions, or refuses; then these are taken. It is made for a model in which
//! nothing switches, and for its present parameters: a change of these removes it.

use std::sync::Arc;

use sincro_math::compiled::{CompiledEvaluation, CompiledFunction};

use super::{Method, World};
use crate::coupled::CoupledSystem;
use crate::mechanism::copy_any;

/// Equations of a world that are compiled; inputs: coordinates of the chart's origin (n_q), y
/// ([`Layout::dim`](crate::mechanism::layout::Layout::dim) numbers) and commands (n_commands).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CompiledKind {
    /// Step of a method with fixed steps, of length `h` `[s]`; outputs: coordinates of the chart's origin, then y.
    Step {
        /// Length of the step `[s]`.
        h: f64,
    },
    /// Right-hand side, of explicit methods; outputs: the derivative of y.
    Slope,
}

impl World {
    /// Lets compiled code evaluate the equations of this world, which it was made for, until a parameter changes. Steps
    /// under forces from outside the model, and those with a coupled system that acts, are left to the recursions.
    pub fn compile_in(&mut self, function: Arc<dyn CompiledFunction>, kind: CompiledKind) {
        let (n_q, dim) = (self.model().n_q(), self.layout().dim());
        let n_outputs = if kind == CompiledKind::Slope { dim } else { n_q + dim };
        let evaluation = CompiledEvaluation::new(function, n_q + dim + self.model().n_commands(), n_outputs);
        (self.compiled, self.compiled_kind) = (Some(Box::new(evaluation)), kind);
    }

    /// Number of evaluations by compiled code; `None` if this world has none.
    #[must_use]
    pub fn compiled_evaluations(&self) -> Option<u64> {
        self.compiled.as_ref().map(|compiled| compiled.n_evaluations())
    }

    /// Records that parameters of the model have changed: code that was compiled for the former ones is removed.
    pub(super) fn mark_model_changed(&mut self) {
        self.compiled = None;
        self.mark_changed();
    }

    /// Makes a step of length `h` `[s]` by compiled code; false, with nothing done, if there is none for it. A coupled
    /// system `acts` or does not.
    pub(super) fn compiled_step(&mut self, h: f64, acts: bool) -> bool {
        let mechanism = &mut self.mechanism;
        let (base, commands) = (mechanism.base(), &*mechanism.commands);
        let Some(compiled) = self.compiled.as_deref_mut() else { return false };
        if acts || self.compiled_kind != (CompiledKind::Step { h }) || mechanism.has_external_forces() {
            return false;
        }
        let Some(made) = compiled.evaluate([base, &self.y], commands) else { return false };
        let (base, y) = made.split_at(base.len());
        mechanism.set_base(base);
        self.y.copy_from_slice(y);
        true
    }

    /// Makes a tick of length `h` `[s]` by compiled code, from state to state, if it is one step of semi-implicit Euler
    /// in which nothing switches and nothing else acts; false, with nothing done, if it is not, or if there is no code
    /// for it.
    #[inline]
    pub(super) fn compiled_tick<A: CoupledSystem<f64>>(&mut self, h: f64, system: &A) -> bool {
        let is_one_step = matches!(self.method, Method::SemiImplicitEuler) && self.substeps == 1;
        let is_alone =
            !system.acts() && system.zero_crossing_count().is_none() && !self.mechanism.has_external_forces();
        if !(is_one_step && is_alone && self.target_velocities.is_empty() && !self.is_constrained()) {
            return false;
        }
        let (layout, zeros, state) = (self.layout(), &self.mechanism.zeros, &mut self.state);
        let Some(compiled) = self.compiled.as_deref_mut().filter(|_| self.compiled_kind == (CompiledKind::Step { h }))
        else {
            return false;
        };
        let totals: &[f64] = if layout.tracks_totals() { &state.totals } else { &[] };
        let parts = [&state.q, zeros, &state.v, totals, &state.rotors];
        let Some(made) = compiled.evaluate(parts, &state.commands) else { return false };
        let (q, y) = made.split_at(state.q.len());
        state.q.copy_from_slice(q);
        state.v.copy_from_slice(&y[layout.velocities()]);
        if layout.tracks_totals() {
            state.totals.copy_from_slice(&y[layout.totals()]);
        }
        copy_any(&mut state.rotors, &y[layout.rotor_states()]);
        state.tick += 1;
        (self.settled_at, self.statistics.steps) = (Some(state.tick), self.statistics.steps + 1);
        true
    }

    /// Lets the mechanism evaluate its right-hand side by compiled code during a step, or ends that.
    pub(super) fn exchange_slope(&mut self, acts: bool) {
        if self.compiled_kind == CompiledKind::Slope && !acts && !self.mechanism.has_external_forces() {
            core::mem::swap(&mut self.compiled, &mut self.mechanism.compiled);
        }
    }
}

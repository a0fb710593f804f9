//! A world that goes on with another model: the structure of the mechanism has changed between two steps.

use super::{Method, World};
use crate::actuation::ExternalForce;
use crate::integrate::{Control, System};
use crate::model::{Attached, Model};
use crate::state::State;

impl World {
    /// Creates the world that goes on in the place of this one with another model, in a `state` of that model, as
    /// [`transfer`](crate::transfer::transfer) gives it: with the same method, accuracy, step sizes and coupled states,
    /// and with the statistics so far. External forces go on where `link_of` gives the new place of their link; the
    /// others end.
    #[must_use]
    pub fn continued(
        &self,
        model: Model<f64>,
        state: State<f64>,
        link_of: &dyn Fn(usize) -> Option<Attached<f64>>,
    ) -> Self {
        let n_coupled = self.y.len() - self.mechanism.dim();
        let kind = self.method();
        let control = match &self.method {
            Method::Implicit(method) => method.control,
            Method::Adaptive(method) => method.control(),
            Method::SemiImplicitEuler | Method::Rk4(_) => Control::new(1e-6, self.step_size),
        };
        let tracks_totals = self.mechanism.layout().tracks_totals();
        let mut new = Self::with_coupled_states(model, state, kind, control, tracks_totals, n_coupled);
        new.substeps = self.substeps;
        new.takes_other_solutions = self.takes_other_solutions;
        (new.step_size, new.next_step) = (self.step_size, self.next_step);
        new.statistics = self.statistics;
        new.ambiguous_events = self.ambiguous_events;
        new.chattering_steps = self.chattering_steps;
        new.jams = self.jams;
        if let (Some(own), Some(before)) = (&mut new.mechanism.constraints, &self.mechanism.constraints) {
            own.solver.report = before.solver.report;
        }
        for force in self.mechanism.external_forces() {
            let Some(at) = link_of(force.link) else { continue };
            let Some(link) = at.link else { continue };
            new.mechanism.apply_external_force(ExternalForce { link, point: at.pose.point(force.point), ..*force });
        }
        new
    }
}

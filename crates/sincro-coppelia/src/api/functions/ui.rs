//! Functions: `simUI`, user interfaces; windows of V-REP 3.

use super::Function;
use crate::api::{ApiError, SimApi};
use sincro_values::widgets::{Keeper, Widgets, call, call_window};

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |sim, a| call(sim, $name, a) }),*]
    };
}

macro_rules! windows {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |sim, a| call_window(sim, $name, a) }),*]
    };
}

/// Functions of `simUI`, named without it.
pub(super) const FUNCTIONS: &[Function] = sincro_values::for_ui_functions!(table);
/// Functions of `simUI` on values of widgets, named without it.
pub(super) const KEPT: &[Function] = sincro_values::for_ui_values!(table);
/// Functions of `simUI` that only show something, named without it.
pub(super) const SHOWN: &[Function] = sincro_values::for_ui_shown!(table);
/// Functions of `sim` on windows of V-REP 3.
pub(super) const WINDOWS: &[Function] = sincro_values::for_windows!(windows);

impl Keeper for SimApi<'_> {
    fn widgets(&mut self) -> &mut Widgets {
        &mut self.registry.widgets
    }

    fn check_size(&self, bytes: usize) -> Result<(), ApiError> {
        self.registry.check_stored_size(bytes)
    }
}

//! Choice of `auto` during a run: the stiff method where springs and dampers have become fast, Dormand–Prince where
//! they are slow again.
//!
//! How fast they are changes with the pose (the inertia that they meet), with nonlinear laws, and with motors that
//! scripts and clients turn into springs. The fastest rate is estimated every [`PERIOD`] ticks, at their start, so that
//! the choice depends on the state alone and a run that is restored continues with the same bits.

use sincro_dynamics::model::Model;
use sincro_dynamics::stiffness::StiffnessProbe;
use sincro_dynamics::world::{MethodKind, World};
use sincro_scene::experiment::Integrator;

use super::{STIFF_FROM, is_stiff_otherwise};
use crate::load::Loaded;

/// Ticks from one estimate to the next: one evaluation of the mechanism in a few hundred.
const PERIOD: u64 = 32;

/// Share of the rate that asks for the stiff method at which the explicit one is taken again, so that a rate near it
/// does not change the method to and fro.
const BACK: f64 = 0.25;

/// Method of a run with `integrator = "auto"`.
#[derive(Clone, Debug)]
pub(super) struct MethodChoice {
    probe: StiffnessProbe,
    /// Base step `[s]`.
    step: f64,
    /// Changes so far.
    pub changes: MethodChanges,
}

/// Changes of the integration method during a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MethodChanges {
    /// Number of changes.
    pub count: u64,
    /// Time of the first `[s]`, and the method that it changed to.
    pub first: Option<(f64, MethodKind)>,
}

impl MethodChoice {
    /// The choice for a run that begins with `method`; `None` where the experiment names its method, or where something
    /// else than springs and dampers asks for the stiff one.
    pub fn new(loaded: &Loaded, method: MethodKind) -> Option<Self> {
        let is_auto = loaded.experiment.integrator == Integrator::Auto;
        let has_control = method.controls_error();
        // rotors with a lag and blocks stay as fast as they are
        (is_auto && has_control && !is_stiff_otherwise(loaded)).then(|| Self {
            probe: StiffnessProbe::new(&loaded.scene.model),
            step: loaded.experiment.step,
            changes: MethodChanges::default(),
        })
    }

    /// Goes on with another model.
    pub fn restructured(&mut self, model: &Model<f64>) {
        self.probe = StiffnessProbe::new(model);
    }

    /// Chooses the method at the start of tick `tick`, at time `t` `[s]`.
    pub fn choose(&mut self, tick: u64, t: f64, world: &mut World) {
        if tick == 0 || !tick.is_multiple_of(PERIOD) {
            return;
        }
        let fastest = self.probe.stiffest(world.model(), &world.state);
        let product = fastest.map_or(0.0, |s| s.rate * self.step);
        let chosen = match world.method() {
            MethodKind::DormandPrince if product > STIFF_FROM => MethodKind::Stiff,
            MethodKind::Stiff if product < BACK * STIFF_FROM => MethodKind::DormandPrince,
            _ => return,
        };
        world.set_method(chosen);
        self.changes.count += 1;
        self.changes.first.get_or_insert((t, chosen));
    }
}

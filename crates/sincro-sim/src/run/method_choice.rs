//! Choice of `auto` during a run: the stiff method where springs and dampers have become fast, Dormand–Prince where
//! they are slow again; of its two orders the one that takes fewer evaluations.
//!
//! How fast they are changes with the pose (the inertia that they meet), with nonlinear laws, and with motors that
//! scripts and clients turn into springs. The fastest rate is estimated every [`PERIOD`] ticks, at their start, so that
//! the choice depends on the state alone and a run that is restored continues with the same bits.
//!
//! The order follows from the step size that error control asks for, at the start of each tick. A step of order 8 takes
//! 12 evaluations and one of order 5 takes 7, but at a tolerance ε it is longer by about ε^(1/8 − 1/5): 3 times at
//! 1e-6, 8 times at 1e-12. Order 5 is for what one step a tick is enough for, and for mechanisms and diagrams whose
//! events are located within a step, by cubics that are closer the shorter it is.

use sincro_dynamics::integrate::Control;
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

/// Difference of 1/5 and 1/8, the exponents by which steps of both orders follow from the tolerance.
const EXPONENT: f64 = 0.075;

/// Largest tolerance of order 8: beyond it the longer steps do not make up for their evaluations.
const LOOSEST: f64 = 1e-6;

/// Share of a tick that steps of order 5 are shorter than where order 8 takes over; longer than one tick, they are
/// taken again.
const SHORT: f64 = 0.8;

/// Method of a run with `integrator = "auto"`.
#[derive(Clone, Debug)]
pub(super) struct MethodChoice {
    probe: StiffnessProbe,
    /// Base step `[s]`.
    step: f64,
    /// Changes so far.
    pub changes: MethodChanges,
}

/// Reserves the memory of both orders where they may be taken.
fn reserve(world: &mut World) {
    if may_be_of_order_8(world) {
        world.reserve_method(MethodKind::DormandPrince);
        world.reserve_method(MethodKind::DormandPrince8);
    }
}

/// Returns true if nothing of the mechanism is located within steps, and the tolerance is fine enough.
fn may_be_of_order_8(world: &World) -> bool {
    !world.switches() && world.control().is_some_and(|control| control.accuracy <= LOOSEST)
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
    /// else than springs and dampers asks for the stiff one. Memory of both orders is reserved in its `world`.
    pub fn new(loaded: &Loaded, method: MethodKind, world: &mut World) -> Option<Self> {
        let is_auto = loaded.experiment.integrator == Integrator::Auto;
        let has_control = method.controls_error();
        // rotors with a lag and blocks stay as fast as they are
        (is_auto && has_control && !is_stiff_otherwise(loaded)).then(|| {
            reserve(world);
            Self {
                probe: StiffnessProbe::new(&loaded.scene.model),
                step: loaded.experiment.step,
                changes: MethodChanges::default(),
            }
        })
    }

    /// Goes on with another model in another `world`.
    pub fn restructured(&mut self, model: &Model<f64>, world: &mut World) {
        self.probe = StiffnessProbe::new(model);
        reserve(world);
    }

    /// Chooses the method at the start of tick `tick`, at time `t` `[s]`, of a run with a diagram that
    /// `locates_events` within steps.
    pub fn choose(&mut self, (tick, t): (u64, f64), locates_events: bool, world: &mut World) {
        if tick == 0 {
            return;
        }
        self.choose_order(tick, locates_events, world);
        if !tick.is_multiple_of(PERIOD) {
            return;
        }
        let fastest = self.probe.stiffest(world.model(), &world.state);
        let product = fastest.map_or(0.0, |s| s.rate * self.step);
        let chosen = match world.method() {
            MethodKind::DormandPrince | MethodKind::DormandPrince8 if product > STIFF_FROM => MethodKind::Stiff,
            MethodKind::Stiff if product < BACK * STIFF_FROM => MethodKind::DormandPrince,
            _ => return,
        };
        world.set_method(chosen);
        self.changes.count += 1;
        self.changes.first.get_or_insert((t, chosen));
    }

    /// Chooses the order of the explicit method.
    fn choose_order(&self, tick: u64, locates_events: bool, world: &mut World) {
        let (Some(control), method) = (world.control(), world.method()) else { return };
        let longest = world.substep(self.step);
        let is_smooth = !locates_events && may_be_of_order_8(world);
        // length of a step of order 5 over that of one of order 8
        let ratio = || sincro_math::elementary::pow(control.accuracy, EXPONENT).0;
        let (chosen, h) = match method {
            MethodKind::DormandPrince if is_smooth && control.h < SHORT * longest => {
                (MethodKind::DormandPrince8, control.h / ratio())
            }
            MethodKind::DormandPrince8
                if !is_smooth
                    || control.h * ratio() > longest
                    // steps that a tick cuts short tell little of what they could be: order 5 is tried
                    || (control.h > longest && tick.is_multiple_of(PERIOD)) =>
            {
                (MethodKind::DormandPrince, control.h * ratio())
            }
            _ => return,
        };
        world.set_method(chosen);
        world.set_control(Control { h, ..control });
    }
}

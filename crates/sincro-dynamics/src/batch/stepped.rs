//! Worlds in lanes that are advanced step by step.

use core::any::Any;
use core::fmt;
use std::sync::Arc;

use sincro_math::Real;
use sincro_math::lanes::{LaneVisitor, dispatch_lanes};

use super::lane_worlds::LaneWorlds;
use super::{CompiledStep, obstacle_to_lanes};
use crate::coupled::{CoupledSystem, StateView};
use crate::model::{Model, PackError};
use crate::state::State;
use crate::world::MethodKind;

/// Worlds of one structure in the lanes of this processor ([`sincro_math::lanes::width`]), advanced step by step, for
/// training: states and commands of each lane can be set between steps. Forces must not depend on time
/// ([`is_time_invariant`](super::is_time_invariant)), since each lane has a clock of its own.
pub struct SteppedLanes {
    /// A `LaneWorlds<R>`: only the dispatch can name the type of this processor's lanes.
    worlds: Box<dyn Any + Send>,
}

impl fmt::Debug for SteppedLanes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SteppedLanes")
    }
}

/// Coupled system of all lanes, made for the lanes of this processor.
pub trait CoupledLanes<R: Real>: CoupledSystem<R> + Any + Send {}

/// Coupled system of the worlds of [`SteppedLanes`], whose type of lanes is not named: argument of
/// [`SteppedLanes::advance_with`].
pub struct LaneSystem {
    /// A `Box<dyn CoupledLanes<R>>`.
    system: Box<dyn Any + Send>,
}

impl fmt::Debug for LaneSystem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LaneSystem")
    }
}

impl LaneSystem {
    /// Wraps a system that was made within a dispatch to the lanes `R` of this processor
    /// ([`dispatch_lanes`]).
    #[must_use]
    pub fn new<R: Real>(system: impl CoupledLanes<R>) -> Self {
        let system: Box<dyn CoupledLanes<R>> = Box::new(system);
        Self { system: Box::new(system) }
    }

    /// The system, within a dispatch to the lanes `R` of this processor.
    ///
    /// # Panics
    ///
    /// If it was made with other types.
    pub fn get<R: Real, S: CoupledLanes<R>>(&mut self) -> &mut S {
        let system: &mut dyn Any = &mut **self.coupled::<R>();
        system.downcast_mut().expect("the system that it was made of")
    }

    fn coupled<R: Real>(&mut self) -> &mut Box<dyn CoupledLanes<R>> {
        self.system.downcast_mut().expect("the dispatch takes the same lanes each time")
    }
}

/// Observer of the state of all lanes, argument of [`SteppedLanes::observe`].
pub trait LaneObserver {
    /// Result type.
    type Output;

    /// Looks at the state, bundles of [`Real::LANES`] numbers, as sensors and controllers see it; its time is always 0.
    /// Must be `#[inline(always)]`, and so must what it calls, to be compiled for the instruction set that runs it.
    fn observe<R: Real>(self, view: &StateView<'_, R>) -> Self::Output;
}

impl SteppedLanes {
    /// Puts `models[k]` into lane k; the last model fills the remaining lanes. The initial state is all zeros: set each
    /// lane before the first step.
    ///
    /// # Errors
    ///
    /// [`PackError`], which names the part, if the models differ in more than numbers, or in which motors have limits.
    ///
    /// # Panics
    ///
    /// If the method `kind` has error control, if there is no model, if lanes cannot take one ([`obstacle_to_lanes`]),
    /// or if this processor has one lane only: one world alone is a [`World`](crate::world::World).
    pub fn new(models: &[&Model<f64>], kind: MethodKind) -> Result<Self, PackError> {
        Self::with_coupled_states(models, kind, 0)
    }

    /// As [`SteppedLanes::new`], with room for a coupled system with `n_states` continuous states: for
    /// [`SteppedLanes::advance_with`].
    ///
    /// # Errors
    ///
    /// As [`SteppedLanes::new`].
    ///
    /// # Panics
    ///
    /// As [`SteppedLanes::new`].
    pub fn with_coupled_states(models: &[&Model<f64>], kind: MethodKind, n_states: usize) -> Result<Self, PackError> {
        assert!(sincro_math::lanes::width() > 1, "one world alone is a `World`");
        assert!(models.iter().all(|model| obstacle_to_lanes(model, kind).is_none()), "lanes advance these models");
        Ok(Self { worlds: dispatch_lanes(New { models, kind, n_states })? })
    }

    /// Lets a compiled step, made for the same models, method and length of step, make the steps from now on.
    pub fn compile_in(&mut self, compiled: Arc<dyn CompiledStep>) {
        dispatch_lanes(CompileIn { lanes: self, compiled });
    }

    /// Sets the state of lane `lane`, 0 to the number of lanes − 1 (others: no effect): coordinates (n_q), velocities
    /// (n_v), rotor states, modes of drives and warm start of `state`, in SI units. Its commands are ignored.
    pub fn set_lane(&mut self, lane: usize, state: &State<f64>) {
        dispatch_lanes(SetLane { lanes: self, lane, state });
    }

    /// Number of steps that worlds have made by themselves, because a limit of a joint or a contact took part in
    /// them, or might have.
    pub fn steps_alone(&mut self) -> u64 {
        dispatch_lanes(StepsAlone { lanes: self })
    }

    /// Sets the commands of all lanes, held until they are set again: for each lane [`Model::n_commands`] numbers in
    /// the model's order, each in the unit of its actuator, one lane after the other; lanes beyond those given take the
    /// last one's.
    ///
    /// # Panics
    ///
    /// If `commands` has none for a lane though the model has commands.
    pub fn set_commands(&mut self, commands: &[f64]) {
        dispatch_lanes(SetCommands { lanes: self, commands });
    }

    /// Makes `n_steps` steps of length `h` `[s]` in all lanes.
    pub fn advance(&mut self, h: f64, n_steps: u64) {
        dispatch_lanes(Advance { lanes: self, h, n_steps, system: None });
    }

    /// Makes one step of length `h` `[s]` in all lanes, together with a coupled system. It sees the time since the
    /// start of the step, since each lane has a clock of its own.
    ///
    /// # Panics
    ///
    /// If the system has another number of states than the worlds were made for, or if they have limits of joints or
    /// contacts.
    pub fn advance_with(&mut self, h: f64, system: &mut LaneSystem) {
        dispatch_lanes(Advance { lanes: self, h, n_steps: 1, system: Some(system) });
    }

    /// Returns what `observer` makes of the state of all lanes; with `with_kinematics` the poses `[m]` and twists
    /// `[rad/s]`, `[m/s]` of links in its scratch are those of the state, else they are outdated.
    pub fn observe<O: LaneObserver>(&mut self, with_kinematics: bool, observer: O) -> O::Output {
        if with_kinematics {
            dispatch_lanes(UpdateKinematics { lanes: self, with_accelerations: false });
        }
        dispatch_lanes(Observe { lanes: self, observer })
    }

    /// As [`SteppedLanes::observe`] with the kinematics, and with the accelerations of links `[rad/s²]`, `[m/s²]` under
    /// the present commands in the scratch.
    pub fn observe_with_accelerations<O: LaneObserver>(&mut self, observer: O) -> O::Output {
        dispatch_lanes(UpdateKinematics { lanes: self, with_accelerations: true });
        dispatch_lanes(Observe { lanes: self, observer })
    }

    fn worlds<R: Real>(&mut self) -> &mut LaneWorlds<R> {
        self.worlds.downcast_mut().expect("the dispatch takes the same lanes each time")
    }
}

struct New<'a> {
    models: &'a [&'a Model<f64>],
    kind: MethodKind,
    n_states: usize,
}

impl LaneVisitor for New<'_> {
    type Output = Result<Box<dyn Any + Send>, PackError>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Self::Output {
        let Self { models, kind, n_states } = self;
        Ok(Box::new(LaneWorlds::<R>::with_coupled_states(models, kind, n_states)?))
    }
}

struct CompileIn<'a> {
    lanes: &'a mut SteppedLanes,
    compiled: Arc<dyn CompiledStep>,
}

impl LaneVisitor for CompileIn<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        self.lanes.worlds::<R>().compile_in(self.compiled);
    }
}

struct SetLane<'a> {
    lanes: &'a mut SteppedLanes,
    lane: usize,
    state: &'a State<f64>,
}

impl LaneVisitor for SetLane<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let Self { lanes, lane, state } = self;
        lanes.worlds::<R>().set_lane(lane, state);
    }
}

struct StepsAlone<'a> {
    lanes: &'a mut SteppedLanes,
}

impl LaneVisitor for StepsAlone<'_> {
    type Output = u64;

    #[inline(always)]
    fn visit<R: Real>(self) -> u64 {
        self.lanes.worlds::<R>().constraints.as_ref().map_or(0, |constraints| constraints.n_alone.iter().sum())
    }
}

struct SetCommands<'a> {
    lanes: &'a mut SteppedLanes,
    commands: &'a [f64],
}

impl LaneVisitor for SetCommands<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let to = &mut self.lanes.worlds::<R>().mechanism.commands;
        let n = to.len();
        for (i, command) in to.iter_mut().enumerate() {
            let last = self.commands.len() / n - 1;
            *command = R::from_lanes(|lane| self.commands[lane.min(last) * n + i]);
        }
    }
}

struct Advance<'a> {
    lanes: &'a mut SteppedLanes,
    h: f64,
    n_steps: u64,
    system: Option<&'a mut LaneSystem>,
}

impl LaneVisitor for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let Self { lanes, h, n_steps, system } = self;
        let worlds = lanes.worlds::<R>();
        match system {
            None => (0..n_steps).for_each(|_| worlds.step(0.0, h)),
            Some(system) => worlds.step_with(0.0, h, &mut **system.coupled::<R>()),
        }
    }
}

/// Kinematics of the state, with or without the accelerations under the present commands.
struct UpdateKinematics<'a> {
    lanes: &'a mut SteppedLanes,
    with_accelerations: bool,
}

impl LaneVisitor for UpdateKinematics<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let worlds = self.lanes.worlds::<R>();
        if self.with_accelerations {
            worlds.view_with_accelerations();
        } else {
            worlds.view(true);
        }
    }
}

struct Observe<'a, O> {
    lanes: &'a mut SteppedLanes,
    observer: O,
}

impl<O: LaneObserver> LaneVisitor for Observe<'_, O> {
    type Output = O::Output;

    #[inline(always)]
    fn visit<R: Real>(self) -> O::Output {
        self.observer.observe(&self.lanes.worlds::<R>().view(false))
    }
}

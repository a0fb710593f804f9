//! Many worlds of one structure, several at a time in the lanes of vector registers.
//!
//! Worlds may differ in every number of their model, in their initial state and in their inputs. World k of a batch has
//! the bits that [`World`] gives it alone: lanes do the same operations in the same order. Limits of
//! drives and dry friction are decided in each lane by itself over a step of semi-implicit Euler; what lanes cannot do
//! together is done one world at a time, and the result does not tell: an [obstacle](obstacle_to_lanes), inputs with
//! corners within a run of RK4 or an implicit method, and forces that depend on time in worlds whose clocks differ.
//!
//! Steps are fixed: semi-implicit Euler, RK4 or implicit. No threads here; `sincro-sim` deals bundles to threads.

mod constraints;
mod lane_worlds;
mod near_pairs;
mod step_modes;
mod stepped;

use core::fmt;
use std::sync::Arc;

use sincro_math::Real;
use sincro_math::lanes::{LaneVisitor, dispatch_lanes};

use crate::aero::rotor::SpeedSource;
use crate::aero::wind::Wind;
use crate::integrate::Control;
use crate::model::{Model, PackError};
use crate::signal::Signal;
use crate::state::State;
use crate::world::{MethodKind, Stop, World};
pub use lane_worlds::LaneWorlds;
use near_pairs::MAX_PAIRS;
pub use stepped::{CoupledLanes, LaneObserver, LaneSystem, SteppedLanes};

/// World of a batch: model, state, commands, and what a run of [`advance`] leaves in it.
#[derive(Clone, Debug)]
pub struct BatchWorld {
    /// Model; those of a batch differ in their numbers only.
    pub model: Model<f64>,
    /// State: the initial one before the run, the last one reached after it.
    pub state: State<f64>,
    /// Commands for every step, each in the unit of its actuator: `n_steps` rows of [`Model::n_commands`] numbers, one
    /// row after the other; empty to hold those in `state`.
    pub commands: Vec<f64>,
    /// Reason for which it stopped before the end; `None` if it did not. A world that has one makes no further steps:
    /// its state is that of the last instant reached.
    pub stop: Option<Stop>,
    /// Recorded coordinates and velocities in SI units: rows of n_q + n_v numbers, one row after the other, the first
    /// at the start, then one every `record_every` steps. A run appends to it.
    pub record: Vec<f64>,
    /// Number of steps that it made by itself, not in the lanes: all if lanes do not advance it, else those in which a
    /// limit of a joint or a contact took part, or might have. Runs add to it.
    pub steps_alone: u64,
}

impl BatchWorld {
    /// World that starts in `state` and holds the commands in it.
    #[must_use]
    pub fn new(model: Model<f64>, state: State<f64>) -> Self {
        Self { model, state, commands: Vec::new(), stop: None, record: Vec::new(), steps_alone: 0 }
    }
}

/// Method, step and length of a batch, the same for all its worlds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatchSettings {
    /// Integration method, one with a fixed step.
    pub method: MethodKind,
    /// Step size `[s]`, positive.
    pub h: f64,
    /// Number of steps.
    pub n_steps: u32,
    /// Steps from one record to the next; 0: no record.
    pub record_every: u32,
}

/// Step of the worlds of a bundle that was compiled for them, with the bits of [`LaneWorlds::step`].
pub trait CompiledStep: fmt::Debug + Send + Sync {
    /// Makes one step: `rows` has a row of lanes for each coordinate, velocity, rotor state and command, in this order.
    /// Returns false, with `rows` as they were, where the program does not have the step's bits.
    fn step(&self, rows: &mut [f64]) -> bool;
}

/// Compiled step of the bundle whose first world is the one given.
pub type StepOfBundle<'a> = &'a (dyn Fn(usize) -> Arc<dyn CompiledStep> + Sync);

/// Advances worlds by `n_steps` steps, as many at a time as the processor has lanes ([`sincro_math::lanes::width`]),
/// with the same results as one by one. Worlds that lanes cannot take run alone.
///
/// # Errors
///
/// [`PackError`] if the models differ in more than numbers; it names the part. A world that stops being finite is no
/// error of the batch: its own [`BatchWorld::stop`] says so.
///
/// # Panics
///
/// If the method is one with error control, whose worlds have no common step.
///
/// ```
/// use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance};
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -1.0], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// // eight pendulums, from 0.1 to 0.8 rad: one second with steps of 1 ms
/// let start = |k: u32| State { q: vec![0.1 * f64::from(k + 1)], ..State::new(&model) };
/// let mut worlds: Vec<_> = (0..8).map(|k| BatchWorld::new(model.clone(), start(k))).collect();
/// advance(&mut worlds, &BatchSettings { method: MethodKind::Rk4, h: 0.001, n_steps: 1000, record_every: 0 })?;
/// assert!(worlds.iter().all(|world| world.stop.is_none() && world.state.q[0] < 0.0)); // on the other side
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn advance(worlds: &mut [BatchWorld], settings: &BatchSettings) -> Result<(), PackError> {
    advance_compiled(worlds, settings, None)
}

/// As [`advance`], with the steps of bundles that lanes take made by compiled programs.
///
/// # Errors
///
/// As [`advance`].
///
/// # Panics
///
/// As [`advance`].
pub fn advance_compiled(
    worlds: &mut [BatchWorld],
    settings: &BatchSettings,
    compiled: Option<StepOfBundle<'_>>,
) -> Result<(), PackError> {
    let fixed = matches!(settings.method, MethodKind::SemiImplicitEuler | MethodKind::Rk4 | MethodKind::Implicit);
    assert!(fixed, "a batch has a fixed step");
    let width = sincro_math::lanes::width();
    for (k, bundle) in worlds.chunks_mut(width).enumerate() {
        if go_together(bundle, settings) {
            let compiled = compiled.map(|of| of(k * width));
            dispatch_lanes(Bundle { worlds: bundle, settings, compiled })?;
        } else {
            bundle.iter_mut().for_each(|w| advance_alone(w, settings));
        }
    }
    Ok(())
}

/// Returns true if lanes advance the worlds of a bundle that have not stopped, of which there is one at least.
fn go_together(bundle: &[BatchWorld], settings: &BatchSettings) -> bool {
    let Some(first) = bundle.iter().find(|w| w.stop.is_none()) else { return false };
    let suits = |w: &BatchWorld| obstacle_to_lanes(&w.model, settings.method).is_none() && !has_corners(w, settings);
    let has_time_of_first = |w: &BatchWorld| w.state.tick == first.state.tick || is_time_invariant(&w.model);
    let has_limits_of_first = |w: &BatchWorld| w.model.is_same(&first.model) || has_limits_of(&w.model, &first.model);
    bundle.iter().all(|w| has_limits_of_first(w) && (w.stop.is_some() || suits(w) && has_time_of_first(w)))
}

/// Returns true if an input has a corner within the run, at which a step of the world alone would end. Those of
/// semi-implicit Euler go on.
fn has_corners(world: &BatchWorld, settings: &BatchSettings) -> bool {
    let time_after = |n_steps: u32| (world.state.tick + u64::from(n_steps)) as f64 * settings.h;
    settings.method != MethodKind::SemiImplicitEuler
        && world.model.next_time_event(time_after(0)) <= time_after(settings.n_steps)
}

/// Returns true if the same drives of two models of one structure have limits, and their joints and surfaces the same
/// limits and materials.
fn has_limits_of(model: &Model<f64>, other: &Model<f64>) -> bool {
    let mut drives = model.drives().iter().zip(other.drives());
    drives.all(|(a, b)| model.drive_limit(a).is_some() == other.drive_limit(b).is_some())
        && model.constraints() == other.constraints()
}

/// Part of a model that lanes cannot advance together with `method`, in words for a message; `None` if there is none.
#[must_use]
pub fn obstacle_to_lanes(model: &Model<f64>, method: MethodKind) -> Option<&'static str> {
    let constraints = model.constraints();
    if !(constraints.loop_joints.is_empty() && constraints.gears.is_empty()) {
        return Some("loop joints or gears");
    }
    if constraints.pairs.iter().filter(|pair| !pair.is_ignored).count() > MAX_PAIRS {
        return Some("more than 256 pairs of surfaces that can touch");
    }
    if method != MethodKind::SemiImplicitEuler && !constraints.is_empty() {
        return Some("limits of joints or contacts, with another method than semi-implicit Euler");
    }
    if method != MethodKind::SemiImplicitEuler && model.has_limited_drives() {
        return Some("a drive with a limit or friction, with another method than semi-implicit Euler");
    }
    if model.drives().iter().any(|drive| model.load_coefficient(drive) != 0.0) {
        return Some("friction that grows with the load of its bearing");
    }
    obstacle_to_equations(model, method)
}

/// Part of a model whose step by `method` is no program without branches, in words for a message: what switches, and
/// what lanes cannot advance. `None` if there is none.
#[must_use]
pub fn obstacle_to_programs(model: &Model<f64>, method: MethodKind) -> Option<&'static str> {
    if model.has_limited_drives() {
        return Some("a drive with a limit or friction");
    }
    let constraints = "contacts, loop joints or limits of joints";
    obstacle_to_equations(model, method).or_else(|| (!model.constraints().is_empty()).then_some(constraints))
}

/// Part of the equations of motion that neither lanes nor programs evaluate with `method`.
fn obstacle_to_equations(model: &Model<f64>, method: MethodKind) -> Option<&'static str> {
    if model.gravity_field.is_some() {
        return Some("gravity that depends on the position");
    }
    if model.has_atmosphere() {
        return Some("a density of the air that depends on the position");
    }
    // particles are counted for each world
    if model.rotors.iter().any(|r| matches!(r.speed, SpeedSource::Particles { .. })) {
        return Some("a rotor of particles");
    }
    let has_lines = method != MethodKind::Rk4 && model.has_lines();
    has_lines.then_some("a spring or damper between two points, an elastic gear or a bushing, with an implicit method")
}

/// Returns true if the forces on a model do not depend on time explicitly: its signals are constant, the wind is
/// steady.
#[must_use]
pub fn is_time_invariant(model: &Model<f64>) -> bool {
    let applied = model.applied().iter().flat_map(|a| &a.signal);
    let wrenches = model.wrenches().iter().flat_map(|w| w.force.iter().chain(&w.torque).flatten());
    let is_constant = |signal: &Signal| matches!(signal, Signal::Constant(_));
    applied.chain(wrenches).all(is_constant) && model.wind().is_none_or(Wind::is_steady)
}

/// Advances one world by itself, without lanes, by `n_steps` steps of `settings`; any method. The results are those of
/// [`advance`]; if it stops early, [`BatchWorld::stop`] has the reason and `state` the last state reached.
pub fn advance_alone(world: &mut BatchWorld, settings: &BatchSettings) {
    if world.stop.is_some() {
        return;
    }
    let (n_q, n_commands) = (world.model.n_q(), world.model.n_commands());
    let control = Control::new(1.0, settings.h);
    let mut alone = World::with_totals(world.model.clone(), world.state.clone(), settings.method, control, false);
    let first = alone.state.tick;
    record(&mut world.record, &alone.state.q[..n_q], &alone.state.v, settings.record_every > 0);
    for k in 0..settings.n_steps {
        if !world.commands.is_empty() {
            alone.state.commands.copy_from_slice(&world.commands[k as usize * n_commands..][..n_commands]);
        }
        if let Err((_, stop)) = alone.advance((first + u64::from(k)) as f64 * settings.h, settings.h) {
            world.stop = Some(stop);
            break;
        }
        world.steps_alone += 1;
        let due = settings.record_every > 0 && (k + 1) % settings.record_every == 0;
        record(&mut world.record, &alone.state.q, &alone.state.v, due);
    }
    world.state = alone.state;
}

fn record(into: &mut Vec<f64>, q: &[f64], v: &[f64], due: bool) {
    if due {
        into.extend_from_slice(q);
        into.extend_from_slice(v);
    }
}

/// Worlds that go through the lanes together; a last, short bundle repeats its last world.
struct Bundle<'a> {
    worlds: &'a mut [BatchWorld],
    settings: &'a BatchSettings,
    compiled: Option<Arc<dyn CompiledStep>>,
}

impl LaneVisitor for Bundle<'_> {
    type Output = Result<(), PackError>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Self::Output {
        let Self { worlds, settings, compiled } = self;
        if R::IS_SCALAR {
            worlds.iter_mut().for_each(|w| advance_alone(w, settings));
            return Ok(());
        }
        let models: Vec<&Model<f64>> = worlds.iter().map(|w| &w.model).collect();
        let mut lanes = LaneWorlds::<R>::new(&models, settings.method)?;
        compiled.into_iter().for_each(|compiled| lanes.compile_in(compiled));
        lanes.run(worlds, settings);
        Ok(())
    }
}

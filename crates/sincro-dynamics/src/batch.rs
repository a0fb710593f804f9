//! Many worlds of one structure, several at a time in the lanes of vector registers.
//!
//! Worlds may differ in every number of their model, in their initial state and in their inputs. World k of a batch has
//! the bits that [`World`] gives it alone: lanes do the same operations in the same order. What lanes cannot do
//! together (drives with a limit, inputs with corners: each world would want its own sub-steps) is done one world at a
//! time; the result does not tell.
//!
//! Steps are fixed: semi-implicit Euler, RK4 or implicit. No threads here; `sincro-sim` deals bundles to threads.

use sincro_math::Real;
use sincro_math::lanes::{LaneVisitor, dispatch_lanes};

use crate::aero::rotor::SpeedSource;
use crate::aero::wind::Wind;
use crate::coupled::StateView;
use crate::integrate::{Control, Extrapolated, FixedStep, Rk4, SemiImplicitEuler, System};
use crate::kinematics;
use crate::mechanism::Mechanism;
use crate::model::{Model, PackError};
use crate::signal::Signal;
use crate::state::State;
use crate::world::{MethodKind, Stop, World};

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
    /// Reason for which it stopped before the end; `None` if it did not.
    pub stop: Option<Stop>,
    /// Recorded coordinates and velocities in SI units: rows of n_q + n_v numbers, one row after the other, the first
    /// at the start, then one every `record_every` steps. A run appends to it.
    pub record: Vec<f64>,
}

impl BatchWorld {
    /// World that starts in `state` and holds the commands in it.
    #[must_use]
    pub fn new(model: Model<f64>, state: State<f64>) -> Self {
        Self { model, state, commands: Vec::new(), stop: None, record: Vec::new() }
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
    let fixed = matches!(settings.method, MethodKind::SemiImplicitEuler | MethodKind::Rk4 | MethodKind::Implicit);
    assert!(fixed, "a batch has a fixed step");
    let width = sincro_math::lanes::width();
    for bundle in worlds.chunks_mut(width) {
        if bundle.iter().all(|w| suits_lanes(w, settings)) {
            dispatch_lanes(Bundle { worlds: bundle, settings })?;
        } else {
            bundle.iter_mut().for_each(|w| advance_alone(w, settings));
        }
    }
    Ok(())
}

fn suits_lanes(world: &BatchWorld, settings: &BatchSettings) -> bool {
    let end = settings.h * f64::from(settings.n_steps);
    obstacle_to_lanes(&world.model).is_none() && world.model.next_time_event(-1.0) >= end
}

/// Part of a model that lanes cannot advance together, in words for a message; `None` if there is none.
#[must_use]
pub fn obstacle_to_lanes(model: &Model<f64>) -> Option<&'static str> {
    if model.params.drives.iter().any(|d| model.drive_limit(d).is_some()) {
        return Some("a drive with a limit or friction");
    }
    // particles are counted for each world
    if model.rotors.iter().any(|r| matches!(r.speed, SpeedSource::Particles { .. })) {
        return Some("a rotor of particles");
    }
    (!model.constraints().is_empty()).then_some("contacts, loop joints or limits of joints")
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

/// Worlds of one structure in the lanes of `R`, advanced step by step, for training: states and commands of each lane
/// can be set between steps. Forces must not depend on time ([`is_time_invariant`]), since each lane has a clock of its
/// own.
#[derive(Clone, Debug)]
pub struct SteppedLanes<R> {
    lanes: LaneWorlds<R>,
    method: FixedMethod<R>,
}

/// A fixed-step method with its working memory.
#[derive(Clone, Debug)]
enum FixedMethod<R> {
    Euler(SemiImplicitEuler<R>),
    Rk4(Rk4<R>),
    Implicit(Extrapolated<R>),
}

impl<R: Real> SteppedLanes<R> {
    /// Puts `models[k]` into lane k; the last model fills the remaining lanes. The initial state is all zeros: set each
    /// lane before the first step.
    ///
    /// # Errors
    ///
    /// [`PackError`] if the models differ in more than their numbers; it names the part.
    ///
    /// # Panics
    ///
    /// If the method `kind` has error control, if there is no model, or if lanes cannot take one
    /// ([`obstacle_to_lanes`]).
    pub fn new(models: &[&Model<f64>], kind: MethodKind) -> Result<Self, PackError> {
        assert!(models.iter().all(|model| obstacle_to_lanes(model).is_none()), "lanes advance these models");
        let mechanism = Mechanism::new(Model::<R>::pack(models)?, false);
        let dim = mechanism.dim();
        let method = match kind {
            MethodKind::SemiImplicitEuler => FixedMethod::Euler(SemiImplicitEuler::new(dim)),
            MethodKind::Rk4 => FixedMethod::Rk4(Rk4::new(dim)),
            MethodKind::Implicit => FixedMethod::Implicit(Extrapolated::new(dim, 2, Control::new(1.0, 1.0))),
            MethodKind::DormandPrince | MethodKind::Stiff => panic!("lanes have a fixed step"),
        };
        let reach_target_velocities = vec![R::zero(); mechanism.model().n_v()];
        Ok(Self { lanes: LaneWorlds { y: vec![R::zero(); dim], reach_target_velocities, mechanism }, method })
    }

    /// Sets the state of lane `lane`, 0 to `R::LANES` − 1 (others: no effect): coordinates (n_q), velocities (n_v) and
    /// rotor states of `state`, in SI units. Commands and the rest of it are ignored.
    pub fn set_lane(&mut self, lane: usize, state: &State<f64>) {
        let LaneWorlds { mechanism, y, .. } = &mut self.lanes;
        let with = |old: R, new: f64| R::from_lanes(|k| if k == lane { new } else { old.lane(k) });
        let base: Vec<R> = mechanism.base().iter().zip(&state.q).map(|(old, new)| with(*old, *new)).collect();
        mechanism.set_base(&base);
        let layout = mechanism.layout();
        for (k, new) in state.v.iter().enumerate() {
            let at = layout.velocity(k);
            y[at] = with(y[at], *new);
            y[k] = with(y[k], 0.0);
        }
        for (k, new) in layout.rotor_states().zip(&state.rotors) {
            y[k] = with(y[k], *new);
        }
    }

    /// Commands of all lanes, [`Model::n_commands`] numbers in the model's order and each in the unit of its actuator,
    /// to be written before a step; held until they are written again.
    pub fn commands(&mut self) -> &mut [R] {
        &mut self.lanes.mechanism.commands
    }

    /// Makes one step of length `h` `[s]` in all lanes.
    #[inline(always)]
    pub fn step(&mut self, h: f64) {
        let Self { lanes, method } = self;
        let is_euler = matches!(method, FixedMethod::Euler(_));
        let is_driven = !lanes.mechanism.drives.is_empty();
        if is_driven {
            lanes.drive(is_euler, h);
        }
        match method {
            FixedMethod::Euler(method) => method.step(&mut lanes.mechanism, 0.0, h, &mut lanes.y),
            FixedMethod::Rk4(method) => method.step(&mut lanes.mechanism, 0.0, h, &mut lanes.y),
            FixedMethod::Implicit(method) => method.step(&mut lanes.mechanism, 0.0, h, &mut lanes.y),
        }
        if is_driven && is_euler {
            lanes.set_driven_velocities();
        }
    }

    /// State of all lanes as sensors and controllers see it; with `with_kinematics` the poses `[m]` and twists
    /// `[rad/s]`, `[m/s]` of links in its scratch are those of the state, else they are outdated. Its time is always 0.
    #[inline(always)]
    pub fn view(&mut self, with_kinematics: bool) -> StateView<'_, R> {
        let LaneWorlds { mechanism, y, reach_target_velocities: zeros } = &mut self.lanes;
        let layout = mechanism.layout();
        let (v, rotors) = (&y[layout.velocities()], &y[layout.rotor_states()]);
        if with_kinematics {
            zeros.fill(R::zero());
            kinematics::motions(&mechanism.model, &mechanism.base, v, zeros, &mut mechanism.scratch);
        }
        let (model, q, commands) = (&mechanism.model, &*mechanism.base, &*mechanism.commands);
        StateView { t: 0.0, model, q, v, rotors, commands, scratch: &mut mechanism.scratch }
    }

    /// Returns true if all coordinates and velocities of lane `lane` (0 to `R::LANES` − 1) are finite.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        self.lanes.y.iter().chain(self.lanes.mechanism.base()).all(|x| x.lane(lane).is_finite())
    }
}

/// Advances one world by itself, without lanes, by `n_steps` steps of `settings`; any method. The results are those of
/// [`advance`]; if it stops early, [`BatchWorld::stop`] has the reason and `state` the last state reached.
pub fn advance_alone(world: &mut BatchWorld, settings: &BatchSettings) {
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
}

impl LaneVisitor for Bundle<'_> {
    type Output = Result<(), PackError>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Self::Output {
        let Self { worlds, settings } = self;
        if R::LANES == 1 {
            worlds.iter_mut().for_each(|w| advance_alone(w, settings));
            return Ok(());
        }
        let models: Vec<&Model<f64>> = worlds.iter().map(|w| &w.model).collect();
        let model = Model::<R>::pack(&models)?;
        let mechanism = Mechanism::new(model, false);
        let dim = mechanism.dim();
        let reach_target_velocities = vec![R::zero(); mechanism.model().n_v()];
        let mut lanes = LaneWorlds { y: vec![R::zero(); dim], reach_target_velocities, mechanism };
        lanes.load(worlds);
        match settings.method {
            MethodKind::SemiImplicitEuler => lanes.run(&mut SemiImplicitEuler::new(dim), worlds, settings),
            MethodKind::Rk4 => lanes.run(&mut Rk4::new(dim), worlds, settings),
            _ => lanes.run(&mut Extrapolated::new(dim, 2, Control::new(1.0, settings.h)), worlds, settings),
        }
        lanes.store(worlds);
        Ok(())
    }
}

/// A bundle in lanes: unlimited drives only.
#[derive(Clone, Debug)]
struct LaneWorlds<R> {
    mechanism: Mechanism<R>,
    y: Vec<R>,
    reach_target_velocities: Vec<R>,
}

impl<R: Real> LaneWorlds<R> {
    fn load(&mut self, worlds: &[BatchWorld]) {
        let of = |k: usize| &worlds[k.min(worlds.len() - 1)].state;
        let gather = |n: usize, f: &dyn Fn(&State<f64>) -> &[f64]| -> Vec<R> {
            (0..n).map(|i| R::from_lanes(|k| f(of(k))[i])).collect()
        };
        let (n_q, n_v) = (self.mechanism.model().n_q(), self.mechanism.model().n_v());
        let layout = self.mechanism.layout();
        let q = gather(n_q, &|s| &s.q);
        self.mechanism.set_base(&q);
        self.y[layout.velocities()].copy_from_slice(&gather(n_v, &|s| &s.v));
        let rotors = layout.rotor_states();
        let n = rotors.len();
        self.y[rotors].copy_from_slice(&gather(n, &|s| &s.rotors));
        let commands = gather(self.mechanism.commands.len(), &|s| &s.commands);
        self.mechanism.commands.copy_from_slice(&commands);
    }

    fn store(&self, worlds: &mut [BatchWorld]) {
        let layout = self.mechanism.layout();
        for (k, world) in worlds.iter_mut().enumerate() {
            if world.stop.is_some() {
                continue;
            }
            for (q, lanes) in world.state.q.iter_mut().zip(self.mechanism.base()) {
                *q = lanes.lane(k);
            }
            for (v, lanes) in world.state.v.iter_mut().zip(&self.y[layout.velocities()]) {
                *v = lanes.lane(k);
            }
            for (x, lanes) in world.state.rotors.iter_mut().zip(&self.y[layout.rotor_states()]) {
                *x = lanes.lane(k);
            }
            for (c, lanes) in world.state.commands.iter_mut().zip(&self.mechanism.commands) {
                *c = lanes.lane(k);
            }
        }
    }

    #[inline(always)]
    fn run<M: FixedStep<R>>(&mut self, method: &mut M, worlds: &mut [BatchWorld], settings: &BatchSettings) {
        let first = worlds[0].state.tick;
        let is_euler = settings.method == MethodKind::SemiImplicitEuler;
        let driven = !self.mechanism.drives.is_empty();
        self.record(worlds, settings.record_every > 0);
        for k in 0..settings.n_steps {
            self.command(worlds, k as usize);
            let t = (first + u64::from(k)) as f64 * settings.h;
            if driven {
                self.drive(is_euler, settings.h);
            }
            method.step(&mut self.mechanism, t, settings.h, &mut self.y);
            if driven && is_euler {
                self.set_driven_velocities();
            }
            self.note_stops(worlds, t);
            self.record(worlds, settings.record_every > 0 && (k + 1) % settings.record_every == 0);
            for world in worlds.iter_mut().filter(|w| w.stop.is_none()) {
                world.state.tick += 1;
            }
        }
    }

    fn command(&mut self, worlds: &[BatchWorld], k: usize) {
        let n = self.mechanism.commands.len();
        for i in 0..n {
            let old = self.mechanism.commands[i];
            self.mechanism.commands[i] = R::from_lanes(|lane| {
                let commands = &worlds[lane.min(worlds.len() - 1)].commands;
                if commands.is_empty() { old.lane(lane) } else { commands[k * n + i] }
            });
        }
    }

    /// Prescribes the locked degrees of freedom for this tick: Euler reaches the target velocity within the step, the
    /// others jump first.
    #[inline(always)]
    fn drive(&mut self, is_euler: bool, h: f64) {
        let layout = self.mechanism.layout();
        self.mechanism.mark_locked();
        for i in 0..self.mechanism.drives.len() {
            let dof = self.mechanism.model.params.drives[i].dof;
            let missing = self.target_velocities(i) - self.y[layout.velocity(dof)];
            let scale = if is_euler { R::splat(h) } else { R::one() };
            self.mechanism.prescribed_acceleration[dof] = missing / scale;
        }
        if is_euler {
            return;
        }
        self.mechanism.impulse(&mut self.reach_target_velocities);
        for (v, change) in self.y[layout.velocities()].iter_mut().zip(&self.reach_target_velocities) {
            *v += *change;
        }
        self.set_driven_velocities();
        self.mechanism.mark_locked();
    }

    #[inline(always)]
    fn target_velocities(&self, i: usize) -> R {
        let drive = &self.mechanism.model.params.drives[i];
        self.mechanism.model.target_velocity(drive, self.mechanism.base(), &self.mechanism.commands)
    }

    #[inline(always)]
    fn set_driven_velocities(&mut self) {
        let layout = self.mechanism.layout();
        for i in 0..self.mechanism.drives.len() {
            self.y[layout.velocity(self.mechanism.model.params.drives[i].dof)] = self.target_velocities(i);
        }
    }

    /// A lane that stopped being finite keeps the state it had before and says so; the others are not concerned.
    #[inline(always)]
    fn note_stops(&self, worlds: &mut [BatchWorld], t: f64) {
        // 0·x is 0, or NaN where x is not finite: one look at the lanes instead of one an entry
        let mut probe = R::zero();
        for y in &self.y {
            probe += R::zero() * *y;
        }
        if probe.is_finite() {
            return;
        }
        for (k, world) in worlds.iter_mut().enumerate() {
            if world.stop.is_none() && !self.y.iter().all(|y| y.lane(k).is_finite()) {
                world.stop = Some(Stop::Integration(crate::integrate::Failure::NotFinite { t }));
            }
        }
    }

    fn record(&self, worlds: &mut [BatchWorld], due: bool) {
        if !due {
            return;
        }
        let layout = self.mechanism.layout();
        for (k, world) in worlds.iter_mut().enumerate().filter(|(_, w)| w.stop.is_none()) {
            world.record.extend(self.mechanism.base().iter().map(|q| q.lane(k)));
            world.record.extend(self.y[layout.velocities()].iter().map(|v| v.lane(k)));
        }
    }
}

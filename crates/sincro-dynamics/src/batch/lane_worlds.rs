//! Worlds of one structure in the lanes of one number type, and their step.

use std::sync::Arc;

use sincro_math::{Real, Task};

use super::constraints::LaneConstraints;
use super::step_modes::StepModes;
use super::{BatchSettings, BatchWorld, CompiledStep, advance_alone, has_limits_of};
use crate::coupled::{Coupled, CoupledSystem, StateView};
use crate::integrate::{Control, Extrapolated, Failure, FixedStep, Rk4, SemiImplicitEuler, System};
use crate::kinematics;
use crate::mechanism::Mechanism;
use crate::model::{Model, PackError};
use crate::state::State;
use crate::world::{MethodKind, Stop};

/// Worlds of one structure, one in each lane of a number of type `R`, that make their steps together: what lanes and
/// recorded numbers run. For models and methods without an [obstacle to it](super::obstacle_to_lanes); forces that
/// depend on time see the time of the step.
///
/// ```
/// use sincro_dynamics::batch::LaneWorlds;
/// use sincro_dynamics::prelude::*;
/// use sincro_math::record::record;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -1.0], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// // the step of a pendulum, 1 ms of semi-implicit Euler, as a program of its angle and rate
/// let step = record(2, 1, |x| {
///     let mut worlds = LaneWorlds::new(&[&model], MethodKind::SemiImplicitEuler).unwrap();
///     worlds.set_state(&x[..1], &x[1..], &[], &[]);
///     worlds.step(0.0, 0.001);
///     [worlds.coordinates(), worlds.velocities()].concat()
/// })?;
/// assert_eq!(step.evaluate(&[0.0, 2.0], 0), [0.002, 2.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LaneWorlds<R> {
    pub(super) mechanism: Mechanism<R>,
    /// Unknowns of the mechanism, then the states of the coupled system.
    pub(super) y: Vec<R>,
    pub(super) reach_target_velocities: Vec<R>,
    /// Time derivative of `y`, as last computed for a view with accelerations.
    slope: Vec<R>,
    /// Diagonal of −∂f/∂z of the coupled system; its length is the number of its states.
    negated_jacobian_diagonal: Vec<R>,
    /// Target velocities of the drives in the present step.
    pub(super) target_velocities: Vec<R>,
    /// Decision of the modes of limited drives; none if there are none.
    pub(super) modes: Option<Box<StepModes<R>>>,
    /// Limits of joints and contacts; none if there are none.
    pub(super) constraints: Option<Box<LaneConstraints<R>>>,
    method: FixedMethod<R>,
    compiled: Option<Arc<dyn CompiledStep>>,
    /// State and commands as the compiled step has them.
    rows: Vec<f64>,
}

/// A fixed-step method with its working memory.
#[derive(Clone, Debug)]
enum FixedMethod<R> {
    Euler(SemiImplicitEuler<R>),
    Rk4(Rk4<R>),
    Implicit(Extrapolated<R>),
}

impl<R: Real> FixedMethod<R> {
    #[inline(always)]
    fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &mut [R]) {
        match self {
            Self::Euler(method) => method.step(system, t, h, y),
            Self::Rk4(method) => method.step(system, t, h, y),
            Self::Implicit(method) => method.step(system, t, h, y),
        }
    }
}

/// One step from time `t` `[s]` of length `h` `[s]`, together with a coupled system if there is one. Drives keep their
/// laws. No closures within: these would be compiled for the baseline instruction set.
struct Step<'a, R> {
    worlds: &'a mut LaneWorlds<R>,
    system: Option<&'a mut dyn CoupledSystem<R>>,
    t: f64,
    h: f64,
}

impl<R: Real> Task for Step<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { worlds, mut system, t, h } = self;
        let has_drives = !worlds.mechanism.drives.is_empty();
        if has_drives {
            worlds.latch_target_velocities(h);
        }
        let mut modes = worlds.begin_modes();
        if has_drives && modes.is_none() {
            worlds.drive(h);
        }
        // at one place: the code of all methods is large
        loop {
            if let Some(modes) = &modes {
                worlds.prescribe(modes, h);
            }
            let LaneWorlds { mechanism, y, method, negated_jacobian_diagonal, .. } = worlds;
            match &mut system {
                None => method.step(mechanism, t, h, y),
                Some(system) => {
                    let system = &mut **system;
                    method.step(&mut Coupled { mechanism, system, negated_jacobian_diagonal }, t, h, y);
                }
            }
            let Some(modes) = &mut modes else { break };
            if worlds.have_decided(modes) {
                break;
            }
        }
        worlds.modes = modes;
        if has_drives && worlds.is_euler() {
            worlds.set_driven_velocities();
        }
    }
}

/// Computation of the accelerations in the present state under the present commands.
struct FindSlope<'a, R> {
    worlds: &'a mut LaneWorlds<R>,
}

impl<R: Real> Task for FindSlope<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let LaneWorlds { mechanism, y, slope, .. } = self.worlds;
        let own = mechanism.dim();
        mechanism.mark_locked();
        mechanism.slope(0.0, &y[..own], slope);
    }
}

impl<R: Real> LaneWorlds<R> {
    /// Puts `models[k]` into lane k; the last model fills the remaining lanes. All coordinates and velocities are zero.
    ///
    /// # Errors
    ///
    /// [`PackError`] if the models differ in more than their numbers, or in which motors have limits.
    ///
    /// # Panics
    ///
    /// If the method has error control, or if there is no model.
    pub fn new(models: &[&Model<f64>], method: MethodKind) -> Result<Self, PackError> {
        Self::with_coupled_states(models, method, 0)
    }

    /// As [`LaneWorlds::new`], with room for a coupled system with `n_states` continuous states: for
    /// [`LaneWorlds::step_with`].
    ///
    /// # Errors
    ///
    /// As [`LaneWorlds::new`].
    ///
    /// # Panics
    ///
    /// As [`LaneWorlds::new`].
    pub fn with_coupled_states(models: &[&Model<f64>], method: MethodKind, n_states: usize) -> Result<Self, PackError> {
        let mechanism = Mechanism::new(Model::<R>::pack(models)?, false);
        if !models.iter().all(|model| has_limits_of(model, models[0])) {
            return Err(PackError("set of motors with a limit"));
        }
        let own = mechanism.dim();
        let dim = own + n_states;
        let method = match method {
            MethodKind::SemiImplicitEuler => FixedMethod::Euler(SemiImplicitEuler::new(dim)),
            MethodKind::Rk4 => FixedMethod::Rk4(Rk4::new(dim)),
            MethodKind::Implicit => FixedMethod::Implicit(Extrapolated::new(dim, 2, Control::new(1.0, 1.0))),
            MethodKind::DormandPrince | MethodKind::DormandPrince8 | MethodKind::Stiff => {
                panic!("lanes have a fixed step")
            }
        };
        let reach_target_velocities = vec![R::zero(); mechanism.model().n_v()];
        let (compiled, rows) = (None, Vec::new());
        let zeros = |n: usize| vec![R::zero(); n];
        Ok(Self {
            y: zeros(dim),
            slope: zeros(own),
            negated_jacobian_diagonal: zeros(n_states),
            target_velocities: zeros(mechanism.drives.len()),
            modes: StepModes::new(&mechanism, dim).map(Box::new),
            constraints: LaneConstraints::new(models, dim).map(Box::new),
            reach_target_velocities,
            mechanism,
            method,
            compiled,
            rows,
        })
    }

    /// Lets a compiled step make the steps from now on, wherever it can.
    pub(super) fn compile_in(&mut self, compiled: Arc<dyn CompiledStep>) {
        let model = self.mechanism.model();
        let n = model.n_q() + model.n_v() + model.n_rotor_states() + model.n_commands();
        (self.compiled, self.rows) = (Some(compiled), vec![0.0; n * R::LANES]);
    }

    /// Model of the worlds.
    #[must_use]
    pub fn model(&self) -> &Model<R> {
        self.mechanism.model()
    }

    /// Sets the state of all lanes: coordinates (n_q), velocities (n_v), rotor states ([`Model::n_rotor_states`]) and
    /// commands ([`Model::n_commands`]), in the units of [`State`].
    ///
    /// # Panics
    ///
    /// If a list has another length.
    pub fn set_state(&mut self, q: &[R], v: &[R], rotors: &[R], commands: &[R]) {
        let layout = self.mechanism.layout();
        self.mechanism.set_base(q);
        self.y[layout.displacement()].fill(R::zero());
        self.y[layout.velocities()].copy_from_slice(v);
        self.y[layout.rotor_states()].copy_from_slice(rotors);
        self.mechanism.commands.copy_from_slice(commands);
    }

    /// Coordinates of all lanes (n_q) `[rad]`, `[m]`.
    #[must_use]
    pub fn coordinates(&self) -> &[R] {
        self.mechanism.base()
    }

    /// Velocities of all lanes (n_v) `[rad/s]`, `[m/s]`.
    #[must_use]
    pub fn velocities(&self) -> &[R] {
        &self.y[self.mechanism.layout().velocities()]
    }

    /// Rotor states of all lanes, in the order and units of [`State::rotors`].
    #[must_use]
    pub fn rotors(&self) -> &[R] {
        &self.y[self.mechanism.layout().rotor_states()]
    }

    /// Accelerations (n_v) `[rad/s²]`, `[m/s²]` and rates of the rotor states at time `t` `[s]` in the present state;
    /// locked drives do not accelerate.
    #[must_use]
    pub fn rates(&mut self, t: f64) -> Vec<R> {
        let layout = self.mechanism.layout();
        let mut slope = vec![R::zero(); layout.dim()];
        self.mechanism.mark_locked();
        self.mechanism.slope(t, &self.y[..layout.dim()], &mut slope);
        let states = layout.rotor_states();
        self.mechanism.model.stop_activations(&self.y[states.clone()], &mut slope[states]);
        [&slope[layout.velocities()], &slope[layout.rotor_states()]].concat()
    }

    /// State of all lanes as sensors and controllers see it, its time 0; with `with_kinematics` the poses `[m]` and
    /// twists `[rad/s]`, `[m/s]` of links in its scratch are those of the state, else they are outdated.
    #[inline(always)]
    pub fn view(&mut self, with_kinematics: bool) -> StateView<'_, R> {
        let Self { mechanism, y, reach_target_velocities: zeros, .. } = self;
        let layout = mechanism.layout();
        let (v, rotors) = (&y[layout.velocities()], &y[layout.rotor_states()]);
        if with_kinematics {
            zeros.fill(R::zero());
            kinematics::motions(&mechanism.model, &mechanism.base, v, zeros, &mut mechanism.scratch);
        }
        let (model, q, commands) = (&mechanism.model, &*mechanism.base, &*mechanism.commands);
        StateView { t: 0.0, model, q, v, rotors, commands, scratch: &mut mechanism.scratch }
    }

    /// As [`LaneWorlds::view`] with the kinematics, and with the accelerations of links `[rad/s²]`, `[m/s²]` under the
    /// present commands. A number type of one lane has zeros for these: one world alone is a
    /// [`World`](crate::world::World).
    #[inline(always)]
    pub(super) fn view_with_accelerations(&mut self) -> StateView<'_, R> {
        // one world alone is a `World`: no copy of the recursions for it
        if R::IS_SCALAR {
            return self.view(true);
        }
        R::run_hot(FindSlope { worlds: self });
        let Self { mechanism, y, slope, .. } = self;
        let layout = mechanism.layout();
        let (v, rotors) = (&y[layout.velocities()], &y[layout.rotor_states()]);
        let accelerations = &slope[layout.velocities()];
        kinematics::motions(&mechanism.model, &mechanism.base, v, accelerations, &mut mechanism.scratch);
        let (model, q, commands) = (&mechanism.model, &*mechanism.base, &*mechanism.commands);
        StateView { t: 0.0, model, q, v, rotors, commands, scratch: &mut mechanism.scratch }
    }

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
        let drives = gather(self.mechanism.drives.len(), &|s| &s.drives);
        self.mechanism.drives.copy_from_slice(&drives);
        if let Some(constraints) = &mut self.constraints {
            constraints.load(worlds);
        }
    }

    /// Writes coordinates `q`, unknowns `y` and modes of `drives` of lane `k` to the state of a world, with the present
    /// commands.
    pub(super) fn store_lane(&self, k: usize, [q, y, drives]: [&[R]; 3], state: &mut State<f64>) {
        let layout = self.mechanism.layout();
        let copy = |to: &mut [f64], from: &[R]| to.iter_mut().zip(from).for_each(|(to, from)| *to = from.lane(k));
        copy(&mut state.q, q);
        copy(&mut state.v, &y[layout.velocities()]);
        copy(&mut state.rotors, &y[layout.rotor_states()]);
        copy(&mut state.commands, &self.mechanism.commands);
        copy(&mut state.drives, drives);
        if let Some(constraints) = &self.constraints {
            state.contacts.clone_from(constraints.contacts(k));
        }
    }

    /// Advances `worlds` from their states, which it leaves where they end.
    #[inline(always)]
    pub(super) fn run(&mut self, worlds: &mut [BatchWorld], settings: &BatchSettings) {
        self.load(worlds);
        // where forces depend on time, all that have not stopped have one clock
        let first = worlds.iter().find(|w| w.stop.is_none()).map_or(0, |w| w.state.tick);
        self.record(worlds, settings.record_every > 0);
        for k in 0..settings.n_steps {
            self.command(worlds, k as usize);
            self.step((first + u64::from(k)) as f64 * settings.h, settings.h);
            if let Some(constraints) = &mut self.constraints {
                constraints.note(worlds);
            }
            self.note_stops(worlds, settings, k);
            self.record(worlds, settings.record_every > 0 && (k + 1) % settings.record_every == 0);
            for world in worlds.iter_mut().filter(|w| w.stop.is_none()) {
                world.state.tick += 1;
            }
        }
        let reached = [self.mechanism.base(), &self.y, &self.mechanism.drives];
        for (k, world) in worlds.iter_mut().enumerate().filter(|(_, w)| w.stop.is_none()) {
            self.store_lane(k, reached, &mut world.state);
        }
    }

    /// Makes one step of length `h` `[s]` from time `t` `[s]` in all lanes, compiled once for each instruction set. A
    /// number type of one lane does nothing: one world alone is a [`World`](crate::world::World).
    #[inline(always)]
    pub fn step(&mut self, t: f64, h: f64) {
        // one world alone is a `World`: no copy of the step for it
        if R::IS_SCALAR {
            return;
        }
        if self.constraints.is_some() {
            self.step_beside_constraints(t, h, |worlds| R::run_hot(Step { worlds, system: None, t, h }));
        } else if !self.compiled_step() {
            R::run_hot(Step { worlds: self, system: None, t, h });
        }
    }

    /// As [`LaneWorlds::step`], together with a coupled system that commands all lanes and whose states are integrated
    /// with them, as [`World::advance_with`](crate::world::World::advance_with) does for one world without events. It
    /// sees times from `t` on, which are the same in all lanes.
    ///
    /// # Panics
    ///
    /// If the system has another number of states than the worlds were made for, or if they have limits of joints or
    /// contacts.
    pub fn step_with(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<R>) {
        assert!(self.constraints.is_none(), "a coupled system acts on lanes all together");
        if R::IS_SCALAR {
            return;
        }
        let own = self.mechanism.dim();
        self.y[own..].copy_from_slice(system.states());
        R::run_hot(Step { worlds: self, system: Some(&mut *system), t, h });
        system.states().copy_from_slice(&self.y[own..]);
    }

    /// Makes a step by the compiled program; false if there is none, or it does not know this state.
    #[inline(always)]
    fn compiled_step(&mut self) -> bool {
        let Some(compiled) = &self.compiled else { return false };
        let layout = self.mechanism.layout();
        let (velocities, rotors) = (layout.velocities(), layout.rotor_states());
        let mut rows = self.rows.chunks_exact_mut(R::LANES);
        write_rows(self.mechanism.base(), &mut rows);
        write_rows(&self.y[velocities.clone()], &mut rows);
        write_rows(&self.y[rotors.clone()], &mut rows);
        write_rows(&self.mechanism.commands, &mut rows);
        if !compiled.step(&mut self.rows) {
            return false;
        }
        let mut rows = self.rows.chunks_exact(R::LANES);
        read_rows(self.mechanism.base_mut(), &mut rows);
        read_rows(&mut self.y[velocities], &mut rows);
        read_rows(&mut self.y[rotors], &mut rows);
        true
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

    #[inline(always)]
    fn is_euler(&self) -> bool {
        matches!(self.method, FixedMethod::Euler(_))
    }

    /// Prescribes the locked degrees of freedom for this tick: Euler reaches the target velocity within the step, the
    /// others jump first.
    #[inline(always)]
    fn drive(&mut self, h: f64) {
        let is_euler = self.is_euler();
        let layout = self.mechanism.layout();
        self.mechanism.mark_locked();
        for i in 0..self.mechanism.drives.len() {
            let dof = self.mechanism.model.params.drives[i].dof;
            let missing = self.target_velocities[i] - self.y[layout.velocity(dof)];
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

    /// Latches the target velocities of the drives for a step of length `h` `[s]`.
    #[inline(always)]
    fn latch_target_velocities(&mut self, h: f64) {
        let mechanism = &self.mechanism;
        for (drive, velocity) in mechanism.model.params.drives.iter().zip(&mut self.target_velocities) {
            let (q, commands) = (mechanism.base(), &mechanism.commands);
            *velocity = mechanism.model.target_velocity_within(drive, q, commands, h);
        }
    }

    /// Sets the velocities of locked drives to their targets.
    #[inline(always)]
    fn set_driven_velocities(&mut self) {
        let layout = self.mechanism.layout();
        for (i, target) in self.target_velocities.iter().enumerate() {
            let at = layout.velocity(self.mechanism.model.params.drives[i].dof);
            self.y[at] = self.mechanism.drives[i].abs().if_less(R::splat(0.5), *target, self.y[at]);
        }
    }

    /// A world whose lane stopped being finite in step `k` says so, in the state of its last instant; the others do not
    /// notice.
    #[inline(always)]
    fn note_stops(&self, worlds: &mut [BatchWorld], settings: &BatchSettings, k: u32) {
        // 0·x is 0, or NaN where x is not finite: one look at the lanes instead of one an entry
        let mut probe = R::zero();
        for y in &self.y {
            probe += R::zero() * *y;
        }
        if probe.is_finite() {
            return;
        }
        for (lane, world) in worlds.iter_mut().enumerate().filter(|(_, w)| w.stop.is_none()) {
            if !self.y.iter().all(|y| y.lane(lane).is_finite()) {
                stop_alone(world, settings, k);
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

/// Lets a world whose lane stopped being finite in step `k` make the steps up to there by itself, from the start of the
/// run: lanes do not keep the state before a step.
#[cold]
fn stop_alone(world: &mut BatchWorld, settings: &BatchSettings, k: u32) {
    let t = world.state.tick as f64 * settings.h;
    let steps_alone = world.steps_alone;
    // all else of the state is that of the start until the run is at its end
    world.state.tick -= u64::from(k);
    advance_alone(world, &BatchSettings { n_steps: k + 1, record_every: 0, ..*settings });
    world.steps_alone = steps_alone;
    world.stop.get_or_insert(Stop::Integration(Failure::NotFinite { t }));
}

#[inline(always)]
fn write_rows<R: Real>(from: &[R], rows: &mut core::slice::ChunksExactMut<'_, f64>) {
    for x in from {
        x.to_row(rows.next().expect("a row each"));
    }
}

#[inline(always)]
fn read_rows<R: Real>(to: &mut [R], rows: &mut core::slice::ChunksExact<'_, f64>) {
    for x in to {
        *x = R::from_row(rows.next().expect("a row each"));
    }
}

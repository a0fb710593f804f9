//! A world: one mechanism with its state and integrator, advanced from tick to tick.
//!
//! [`World::advance`] is stage 4 of the step: commands are latched before it, and it takes the state from t to t + h,
//! in as many sub-steps as the method and the events need. Three kinds of event end a sub-step: a time event of an
//! input signal, known beforehand, and two zero crossings that are located (`events`): a drive that changes between
//! locked and saturated, and a contact or joint limit that closes, opens, sticks or slips.
//!
//! After a failure the state is that of the last sub-step that could be made, everything finite.
//!
//! A world owns its state, the parameters of its model (the structure is shared), and the working memory of mechanism
//! and method.

pub mod audit;
mod builder;
mod compiled;
mod contacts;
mod continued;
mod drives;
mod events;
mod modes;
mod observation;
mod parameters;
mod step;
mod substeps;
mod switching;

pub use builder::WorldBuilder;
pub use compiled::CompiledKind;
pub use observation::Observation;
pub use step::{StepError, StepReport};

use sincro_actuation::{Kink, Kinks};
use sincro_math::compiled::CompiledEvaluation;

use crate::actuation::{ExternalForce, Motor};
use crate::aero::rotor::{RotorLaw, SpeedSource};
use crate::constraint::{ContactPoint, SolverReport};
use crate::coupled::{Coupled, CoupledSystem, NoCoupling, StateView};
use crate::ids::{MotorId, RotorId};
use crate::integrate::{Adaptive, AdaptiveKind, Control, Extrapolated, Failure, Rk4, SemiImplicitEuler, System};
use crate::mechanism::constraints::ActivationRule;
use crate::mechanism::layout::Layout;
use crate::mechanism::{Mechanism, copy_any};
use crate::model::Model;
use crate::occurrences::Occurrences;
use crate::state::State;
use events::{Crossing, MAX_CROSSINGS};
use observation::contacts_of;

/// Times closer than this are the same instant `[s]`.
const SAME_INSTANT: f64 = 1e-9;

/// Number of changes of modes in a step above which they are called chatter.
const CHATTER: u32 = 20;

/// Integration method with its working memory.
#[derive(Clone, Debug)]
enum Method {
    /// Semi-implicit Euler, fixed step, order 1: every step is one at velocity level.
    SemiImplicitEuler,
    /// Runge–Kutta, fixed step, order 4.
    Rk4(Rk4<f64>),
    /// Extrapolated implicit Euler with two rows, fixed step, order 2.
    Implicit(Extrapolated<f64>),
    /// Method with error control.
    Adaptive(Adaptive),
}

/// Integration method of a world, chosen with [`WorldBuilder::method`].
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -1.0], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// # let hinge = model.names().joint_id("hinge").unwrap();
/// // change of a pendulum's energy in 1 s with steps of 10 ms: order 4 against order 2
/// let drift = |method| -> Result<f64, Box<dyn std::error::Error>> {
///     let builder = World::builder(model.clone()).method(method).step_size(0.01);
///     let mut world = builder.coordinates(hinge, &[1.0]).build()?;
///     let before = world.energy().total();
///     for _ in 0..100 {
///         world.step()?;
///     }
///     Ok((world.energy().total() - before).abs())
/// };
/// assert!(drift(MethodKind::Rk4)? < 1e-3 * drift(MethodKind::Implicit)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MethodKind {
    /// Semi-implicit Euler, fixed step, order 1; joint dampers implicit, contacts at velocity level (Moreau–Jean).
    SemiImplicitEuler,
    /// Classical Runge–Kutta, fixed step, order 4: for smooth mechanisms.
    Rk4,
    /// Extrapolated linearly implicit Euler, fixed step, order 2: stable for any stiffness and damping of joints.
    Implicit,
    /// Dormand–Prince 5(4), error control: for smooth mechanisms.
    DormandPrince,
    /// Dormand–Prince 8(5,3), error control: for smooth mechanisms at high accuracy.
    DormandPrince8,
    /// Extrapolated linearly implicit Euler, order 2 to 8, error control: for stiff mechanisms.
    Stiff,
}

impl MethodKind {
    /// All methods.
    pub const ALL: [Self; 6] =
        [Self::SemiImplicitEuler, Self::Rk4, Self::Implicit, Self::DormandPrince, Self::Stiff, Self::DormandPrince8];

    /// Returns true if the method chooses its steps by an estimate of their error.
    #[must_use]
    pub fn controls_error(self) -> bool {
        self.adaptive().is_some()
    }

    pub(crate) fn adaptive(self) -> Option<AdaptiveKind> {
        match self {
            Self::DormandPrince => Some(AdaptiveKind::DormandPrince),
            Self::DormandPrince8 => Some(AdaptiveKind::DormandPrince8),
            Self::Stiff => Some(AdaptiveKind::Stiff),
            Self::SemiImplicitEuler | Self::Rk4 | Self::Implicit => None,
        }
    }
}

/// Reason for which a world stopped; in a [`StepError`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The integrator could not make a step.
    Integration(Failure),
    /// More constraint problems than allowed in a run were left without a solution within tolerance.
    Unsolved {
        /// Time of the stop `[s]`.
        t: f64,
        /// Largest complementarity residual, relative to the largest force or rate (dimensionless).
        residual: f64,
    },
    /// Drives changed between locked and saturated, or blocks had events, too often within one tick.
    Chatter {
        /// Time of the stop `[s]`.
        t: f64,
    },
    /// Events of the coupled system followed from each other at one instant without end.
    EndlessEvents {
        /// Time of the stop `[s]`.
        t: f64,
    },
}

/// Statistics of the steps: of [`World::statistics`] since the world was made, of a [`StepReport`] those of one base
/// step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepStatistics {
    /// Number of accepted sub-steps.
    pub steps: u64,
    /// Number of events: located changes of drives, limits and contacts, and events of the coupled system.
    pub events: u64,
    /// Number of impacts.
    pub impacts: u64,
    /// Number of ticks finished at velocity level because of Zeno behaviour.
    pub fallback_ticks: u64,
    /// Number of steps at velocity level after too many events without progress in time.
    pub fallback_steps: u64,
    /// Sum of the squares of the lengths of all steps at velocity level by a method of higher order `[s²]`: half of it
    /// times the acceleration is their error.
    pub fallback_square: f64,
    /// Number of times that the modes of drives could not be decided within the iteration limit.
    pub undecided_modes: u64,
    /// Work that events leave open `[J]`, an uncertainty of the energy balance that no finer step reduces: of contact
    /// forces over the distances at which contacts counted as closed, of impulses that remove the rates at which they
    /// counted as at rest, of limited drives within the width to which the instants are located.
    pub event_work: f64,
}

/// Simulated world: a mechanism, its state and an integration method, advanced by [`World::step`]. Made by
/// [`World::builder`].
#[derive(Clone, Debug)]
pub struct World {
    /// Present state; may be changed between steps, then see [`World::mark_changed`].
    pub state: State<f64>,
    mechanism: Mechanism<f64>,
    /// Equations that are compiled, while no parameter changes.
    compiled: Option<Box<CompiledEvaluation>>,
    compiled_kind: CompiledKind,
    method: Method,
    /// The method before the last change.
    spare_methods: Vec<Adaptive>,
    y: Vec<f64>,
    before: Vec<f64>,
    base_before: Vec<f64>,
    report_before: SolverReport,
    target_velocities: Vec<f64>,
    /// Those of the tick last made, while the forces of the next one are looked at.
    made_target_velocities: Vec<f64>,
    jumps: Vec<bool>,
    /// Limited drives whose modes are being decided.
    kinks: Kinks,
    /// Those at the present instant during a look-ahead.
    present_kinks: Vec<Kink>,
    /// Zero crossings last found.
    crossings: Vec<Crossing>,
    /// Values of the zero-crossing functions of the coupled system, last evaluated.
    coupled_crossings: Vec<f64>,
    /// y at the present instant during a look-ahead.
    present: Vec<f64>,
    accelerations: Vec<f64>,
    /// f(t, y) as last evaluated.
    slope: Vec<f64>,
    /// f(t, y) with the modes just decided, while the former ones are tried.
    decided_slope: Vec<f64>,
    /// Velocities at the end of the next step, where its forces are found over the whole of it.
    step_end_velocities: Vec<f64>,
    /// Modes of the drives before a step at velocity level is tried.
    drives_before: Vec<f64>,
    /// True if the forces of the next step have been looked at.
    knows_step_forces: bool,
    negated_jacobian_diagonal: Vec<f64>,
    attached_before: Vec<f64>,
    substeps: u32,
    /// Base step of [`World::step`] `[s]`.
    step_size: f64,
    /// Length of the next step at velocity level of a method that makes no others `[s]`.
    next_step: f64,
    /// Steps at velocity level: of semi-implicit Euler, and the fallback of the others.
    time_stepping: Option<SemiImplicitEuler<f64>>,
    statistics: StepStatistics,
    /// Events after which several sets of modes keep all laws.
    ambiguous_events: Occurrences,
    /// True if another set is taken where one is found.
    takes_other_solutions: bool,
    /// Events of the present step after which another set was sought.
    n_searches: u32,
    /// Time of the last event of the step after which modes were decided `[s]`.
    last_decision: f64,
    /// True while modes a little ahead are taken if they graze a law now.
    may_graze: bool,
    /// Changes of modes in the present step: events but for closing contacts, whose bounces may follow each other ever
    /// faster and come to rest.
    mode_changes: u32,
    chattering_steps: Occurrences,
    jams: Occurrences,
    /// Tick at whose end the laws hold; none after a change from outside.
    settled_at: Option<u64>,
}

impl World {
    /// Creates a world of `model` in `state`, to be followed by [`World::initialize`]; [`World::builder`] is the way
    /// that checks its arguments and is ready for a step.
    ///
    /// `accuracy` is the local error allowed in a step of a method with error control, relative to max(|y|, 1);
    /// `first_step` `[s]` is the first step that such a method tries, and for all methods the base step of
    /// [`World::step`].
    #[must_use]
    pub fn new(model: Model<f64>, state: State<f64>, kind: MethodKind, accuracy: f64, first_step: f64) -> Self {
        Self::with_totals(model, state, kind, Control::new(accuracy, first_step), true)
    }

    /// Creates a world as [`World::new`] does, with the accuracy and step size of `control`; if `tracks_totals` is
    /// false, no work, dissipation or motor impulse is integrated, which saves time.
    #[must_use]
    pub fn with_totals(
        model: Model<f64>,
        state: State<f64>,
        kind: MethodKind,
        control: Control,
        tracks_totals: bool,
    ) -> Self {
        Self::with_coupled_states(model, state, kind, control, tracks_totals, 0)
    }

    /// Creates a world as [`World::with_totals`] does, for a [`CoupledSystem`] with `n_states` states, to be given to
    /// [`World::advance_with`].
    #[must_use]
    pub fn with_coupled_states(
        model: Model<f64>,
        state: State<f64>,
        kind: MethodKind,
        control: Control,
        tracks_totals: bool,
        n_states: usize,
    ) -> Self {
        let n_drives = model.n_drives();
        let mut mechanism = Mechanism::new(model, tracks_totals);
        mechanism.select_loop_rows(&state.q);
        if kind.controls_error() {
            mechanism.set_contact_accuracy(control.accuracy);
        }
        let dim = mechanism.dim() + n_states;
        let method = match (kind, kind.adaptive()) {
            (_, Some(adaptive)) => Method::Adaptive(Adaptive::new(adaptive, dim, control)),
            (MethodKind::Rk4, _) => Method::Rk4(Rk4::new(dim)),
            (MethodKind::Implicit, _) => Method::Implicit(Extrapolated::new(dim, 2, control)),
            _ => Method::SemiImplicitEuler,
        };
        let switches = n_drives > 0 || !mechanism.model().constraints().is_empty();
        let time_stepping = (switches || kind == MethodKind::SemiImplicitEuler).then(|| SemiImplicitEuler::new(dim));
        let base_before = vec![0.0; mechanism.model().n_q()];
        let accelerations = vec![0.0; mechanism.model().n_v()];
        Self {
            state,
            mechanism,
            compiled: None,
            compiled_kind: CompiledKind::Slope,
            method,
            spare_methods: Vec::new(),
            y: vec![0.0; dim],
            before: vec![0.0; dim],
            slope: vec![0.0; dim],
            decided_slope: vec![0.0; dim],
            step_end_velocities: accelerations.clone(),
            drives_before: Vec::new(),
            knows_step_forces: false,
            negated_jacobian_diagonal: vec![0.0; n_states],
            attached_before: vec![0.0; n_states],
            substeps: 1,
            step_size: control.h,
            next_step: control.h,
            time_stepping,
            base_before,
            report_before: SolverReport::default(),
            target_velocities: vec![0.0; n_drives],
            made_target_velocities: vec![0.0; n_drives],
            jumps: vec![false; n_drives],
            kinks: Kinks::new(n_drives),
            present_kinks: Vec::with_capacity(n_drives),
            crossings: Vec::with_capacity(MAX_CROSSINGS),
            coupled_crossings: Vec::new(),
            present: vec![0.0; dim],
            accelerations,
            statistics: StepStatistics::default(),
            ambiguous_events: Occurrences::default(),
            takes_other_solutions: false,
            n_searches: 0,
            last_decision: f64::NEG_INFINITY,
            may_graze: true,
            mode_changes: 0,
            chattering_steps: Occurrences::default(),
            jams: Occurrences::default(),
            settled_at: None,
        }
    }

    /// Model of the world, with its present parameters.
    #[must_use]
    pub fn model(&self) -> &Model<f64> {
        self.mechanism.model()
    }

    /// Statistics of all steps since the world was made.
    #[must_use]
    pub fn statistics(&self) -> StepStatistics {
        self.statistics
    }

    /// Statistics of the constraint solver since the world was made; `None` if the model has no constraints.
    #[must_use]
    pub fn solver_report(&self) -> Option<SolverReport> {
        self.mechanism.constraints.as_ref().map(|c| c.solver.report)
    }

    /// Passages of singular positions of the loops since the world was made. Not part of the state; semi-implicit Euler
    /// does not look for them.
    #[must_use]
    pub fn passed_singularities(&self) -> Occurrences {
        self.mechanism.passed_singularities()
    }

    /// Events since the world was made after which several sets of contact and drive modes keep all laws and give
    /// different accelerations: the motion goes on with one of them, and rounding may decide which. Not part of the
    /// state; not every such event is found, and semi-implicit Euler does not look for them.
    #[must_use]
    pub fn ambiguous_events(&self) -> Occurrences {
        self.ambiguous_events
    }

    /// Steps since the world was made in which drives and contacts changed their modes more than 20 times, contacts
    /// that close not counted: what follows hangs on how each of them was decided, and a finer run need not come
    /// closer. Not part of the state; semi-implicit Euler decides modes once a step.
    #[must_use]
    pub fn chattering_steps(&self) -> Occurrences {
        self.chattering_steps
    }

    /// Instants since the world was made at which no finite forces kept the laws of contact and friction (Painlevé's
    /// paradox: a body that jams), or changed faster than any step could follow: impulses over a short step at velocity
    /// level ended it. Not part of the state.
    #[must_use]
    pub fn jams(&self) -> Occurrences {
        self.jams
    }

    /// Contact points with their forces, as of the last [`World::rates`] or [`World::observe`]; empty before.
    pub fn contacts(&self) -> impl Iterator<Item = ContactPoint> {
        contacts_of(&self.mechanism)
    }

    /// Torque `[N·m]` or force `[N]` that the locked degree of freedom `dof` (0 to n_v − 1) needed in the last
    /// [`World::rates`] or [`World::observe`]; meaningless if it is not locked.
    #[must_use]
    pub fn reaction(&self, dof: usize) -> f64 {
        self.mechanism.scratch.reaction[dof]
    }

    /// Step-size control of the method, which a snapshot must hold; `None` for methods with a fixed step.
    #[must_use]
    pub fn control(&self) -> Option<Control> {
        match &self.method {
            Method::Adaptive(m) => Some(m.control()),
            _ => None,
        }
    }

    /// Sets the step-size control, such as that of a snapshot; no effect on methods with a fixed step.
    pub fn set_control(&mut self, control: Control) {
        if let Method::Adaptive(m) = &mut self.method {
            m.set_control(control);
        }
    }

    /// Integration method.
    #[must_use]
    pub fn method(&self) -> MethodKind {
        match &self.method {
            Method::SemiImplicitEuler => MethodKind::SemiImplicitEuler,
            Method::Rk4(_) => MethodKind::Rk4,
            Method::Implicit(_) => MethodKind::Implicit,
            Method::Adaptive(m) => match m.kind() {
                AdaptiveKind::DormandPrince => MethodKind::DormandPrince,
                AdaptiveKind::DormandPrince8 => MethodKind::DormandPrince8,
                AdaptiveKind::Stiff => MethodKind::Stiff,
            },
        }
    }

    /// Changes the integration method between two base steps, from one with error control to another; accuracy and
    /// step size go on. No effect if it is the present one. Memory is allocated at the first change to each alone.
    ///
    /// # Panics
    ///
    /// If the present method or `kind` has a fixed step.
    pub fn set_method(&mut self, kind: MethodKind) {
        if kind == self.method() {
            return;
        }
        let Method::Adaptive(method) = &mut self.method else { panic!("the present method has a fixed step") };
        let new_kind = kind.adaptive().unwrap_or_else(|| panic!("{kind:?} has a fixed step"));
        let control = method.control();
        let mut new = match self.spare_methods.iter().position(|spare| spare.kind() == new_kind) {
            Some(k) => self.spare_methods.swap_remove(k),
            None => Adaptive::new(new_kind, self.y.len(), control),
        };
        new.set_control(control);
        self.spare_methods.push(std::mem::replace(method, new));
    }

    /// Divides every fixed step into `n` equal ones (0 counts as 1), and limits steps of error control to that length;
    /// commands are still latched once a tick. For error estimates by refinement.
    pub fn set_substeps(&mut self, n: u32) {
        self.substeps = n.max(1);
    }

    /// Sets whether the motion goes on with another set of contact and drive modes wherever several keep all laws
    /// ([`World::ambiguous_events`]): what such a run differs by is what the laws leave open.
    pub fn take_other_solutions(&mut self, takes: bool) {
        self.takes_other_solutions = takes;
    }

    /// Lets work and dissipation, if they are tracked, take part in error control, relative to max(`scale`, 1 J), with
    /// `scale` the size of the energies `[J]`: no accuracy of states shortens a step that an event bounds, and the
    /// energies of a finer run would be off as those of the coarser one. For error estimates by refinement.
    pub fn control_energies(&mut self, scale: f64) {
        self.mechanism.control_energies(scale);
    }

    /// Resolves drives and contacts at the start of a run, at time `t` `[s]`; velocities stay (nothing jumps before the
    /// first command). To be called once after [`World::new`].
    pub fn initialize(&mut self, t: f64) {
        self.initialize_with(t, &mut NoCoupling);
    }

    /// Resolves drives and contacts at the start of a run, at time `t` `[s]`, with the commands of a coupled system;
    /// see [`World::initialize`].
    pub fn initialize_with(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) {
        self.load(system);
        self.latch_target_velocities(self.step_size);
        if self.is_next_step_large() {
            self.find_step_forces(t, system);
        } else {
            self.resolve_impacts();
            self.resolve_modes(t, (self.step_size, false), system);
        }
        self.mechanism.store(&self.y, &mut self.state);
    }

    /// Records that state or model were changed from outside: drives and constraints are audited again
    /// ([`Observation::law_residuals`]) only after the next tick. Bodies that sleep wake; those whose state has
    /// changed, or the forces on them, do so by themselves.
    pub fn mark_changed(&mut self) {
        self.settled_at = None;
        self.mechanism.wake();
    }

    /// Bytes that this world takes on the heap, the model left out; for memory statistics.
    #[must_use]
    pub fn heap_bytes(&self) -> usize {
        let own =
            self.y.len() * 3 + self.base_before.len() + 2 * self.target_velocities.len() + self.accelerations.len();
        let method = match &self.method {
            Method::SemiImplicitEuler => self.y.len(),
            Method::Rk4(_) => 5 * self.y.len(),
            Method::Implicit(_) => 10 * self.y.len(),
            Method::Adaptive(m) => self.spare_methods.iter().chain([m]).map(|m| m.vector_count() * self.y.len()).sum(),
        };
        self.state.heap_bytes() + self.mechanism.heap_bytes() + 8 * (own + method)
    }

    /// Advances the state from time `t` `[s]` by one tick of `h` `[s]` under the latched commands, and counts the tick.
    ///
    /// # Errors
    ///
    /// Time of the last instant reached `[s]` and the reason, if the method cannot go on; the state is then that of
    /// this instant, and the tick is not counted.
    pub fn advance(&mut self, t: f64, h: f64) -> Result<(), (f64, Stop)> {
        self.advance_coupled(t, h, &mut NoCoupling)
    }

    /// Advances the state as [`World::advance`] does, together with a coupled system with as many states as the world
    /// was made for ([`World::with_coupled_states`]).
    ///
    /// # Errors
    ///
    /// As [`World::advance`]; the states of the coupled system are then those of the last instant reached, too.
    ///
    /// # Panics
    ///
    /// If the number of its states differs.
    pub fn advance_with(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) -> Result<(), (f64, Stop)> {
        self.advance_coupled(t, h, &mut { system })
    }

    fn advance_coupled<A: CoupledSystem<f64>>(&mut self, t: f64, h: f64, system: &mut A) -> Result<(), (f64, Stop)> {
        self.next_step = h / f64::from(self.substeps);
        // the time event at the end of the last tick has passed
        system.set_time_event(f64::INFINITY);
        if self.compiled.is_some() && self.compiled_tick(h, system) {
            return Ok(());
        }
        self.count_particles(h);
        self.load(system);
        self.coupled_crossings.resize(system.zero_crossing_count().unwrap_or(0), f64::NAN);
        if system.acts() {
            self.attached_before.copy_from_slice(&self.y[self.mechanism.dim()..]);
        }
        self.latch_target_velocities(h);
        let reached = if let Method::SemiImplicitEuler = self.method {
            let h = h / f64::from(self.substeps);
            (0..self.substeps).try_for_each(|k| self.velocity_level_step(t + f64::from(k) * h, h, system))
        } else {
            self.mechanism.set_time_since_event(f64::INFINITY);
            self.start_tick(t, h, system);
            (self.mode_changes, self.n_searches, self.last_decision) = (0, 0, f64::NEG_INFINITY);
            let reached = self.sub_steps(t, h, system);
            if self.mode_changes > CHATTER {
                self.chattering_steps.note(t);
            }
            reached
        };
        self.mechanism.store(&self.y, &mut self.state);
        if system.acts() {
            system.states().copy_from_slice(&self.y[self.mechanism.dim()..]);
        }
        reached?;
        self.state.tick += 1;
        self.settled_at = Some(self.state.tick);
        Ok(())
    }

    /// Id of the first rotor whose thrust or torque was not a number in the last evaluation, as the published script
    /// can give; `None` if all are finite.
    #[must_use]
    pub fn rotor_without_load(&self) -> Option<RotorId> {
        self.mechanism.rotor_without_load()
    }

    /// Speed of a rotor in the present state `[rad/s]`, of a stock propeller the velocity of its particles `[m/s]`.
    /// Panics if the model has no such rotor.
    #[must_use]
    pub fn rotor_speed(&self, rotor: RotorId) -> f64 {
        let State { v, commands, rotors, .. } = &self.state;
        self.model().rotor(rotor).speed.value(v, commands, rotors)
    }

    /// Sets the mass flow of each stock propeller for this tick.
    fn count_particles(&mut self, h: f64) {
        for rotor in &self.mechanism.model.rotors {
            if let (RotorLaw::Stock(propeller), SpeedSource::Particles { state, .. }) = (&rotor.law, rotor.speed) {
                self.state.rotors[state] = propeller.flow(self.state.tick, h);
            }
        }
    }

    /// Computes accelerations (n_v) `[rad/s²]`, `[m/s²]` and motor torques (in the order of the motors) `[N·m]`, `[N]`
    /// in the present state at time `t` `[s]`, with the drives as they now stand.
    pub fn rates(&mut self, t: f64) -> (&[f64], &[f64]) {
        self.mechanism.load(&self.state, &mut self.y);
        if self.is_next_step_large() {
            return self.step_rates(t);
        }
        // with the contact modes that looking for many contacts has cleared
        self.mechanism.load(&self.state, &mut self.y);
        self.mechanism.detect_contacts(&self.state.v, ActivationRule::Touching);
        self.mechanism.mark_modes();
        let is_semi_implicit = matches!(self.method, Method::SemiImplicitEuler);
        if let (true, Some(constraints)) = (is_semi_implicit, &mut self.mechanism.constraints) {
            // no step is made with these forces: friction is against the sliding velocity of this instant
            constraints.sub_step = 0.0;
        }
        let (own, before) = (self.mechanism.dim(), self.solver_report());
        self.mechanism.slope(t, &self.y[..own], &mut self.slope[..own]);
        let is_unsolved = before.zip(self.solver_report()).is_some_and(|(x, y)| y.not_converged > x.not_converged);
        if is_unsolved && is_semi_implicit && self.mechanism.can_sweep() {
            // there may be no forces of this instant (Painlevé), but there are impulses of the step
            before.into_iter().for_each(|before| self.discard_failures(&before));
            self.mechanism.load(&self.state, &mut self.y);
            self.detect_next_step();
            return self.step_rates(t);
        }
        self.decide_locks_now(t);
        let State { v, rotors, .. } = &self.state;
        self.mechanism.find_motor_torques((v, rotors), v, (0.0, 0.0));
        let velocities = self.layout().velocities();
        self.accelerations.copy_from_slice(&self.slope[velocities]);
        (&self.accelerations, self.mechanism.motor_torque())
    }

    /// As [`World::rates`], over the next step, whose contacts are solved as a whole.
    fn step_rates(&mut self, t: f64) -> (&[f64], &[f64]) {
        let n = self.model().n_v();
        self.made_target_velocities.copy_from_slice(&self.target_velocities);
        self.latch_target_velocities(self.next_step);
        self.find_step_forces(t, &mut NoCoupling);
        self.target_velocities.copy_from_slice(&self.made_target_velocities);
        for k in 0..n {
            self.accelerations[k] = (self.step_end_velocities[k] - self.state.v[k]) / self.next_step;
        }
        let State { v, rotors, .. } = &self.state;
        self.mechanism.find_motor_torques((v, rotors), v, (self.next_step, 0.0));
        (&self.accelerations, self.mechanism.motor_torque())
    }

    /// Announces the length of the next tick `[s]`, over which [`World::rates`] finds the forces of many contacts; by
    /// default that of the last one.
    pub fn announce_step(&mut self, h: f64) {
        self.next_step = h / f64::from(self.substeps);
    }

    /// Calls `look` with the view of the present state at time `t` `[s]`, as sensors and controllers take it, and
    /// returns its result.
    pub fn with_state_view<T>(&mut self, t: f64, look: impl FnOnce(StateView<'_, f64>) -> T) -> T {
        let (state, mechanism) = (&self.state, &mut self.mechanism);
        let State { q, v, rotors, commands, .. } = state;
        look(StateView { t, model: &mechanism.model, q, v, rotors, commands, scratch: &mut mechanism.scratch })
    }

    /// Applies an external force to a link in all steps until [`World::clear_external_forces`]; several add up. Not
    /// part of the state.
    ///
    /// # Panics
    ///
    /// In the next evaluation, if the model has no such link.
    ///
    /// ```
    /// use sincro_dynamics::actuation::ExternalForce;
    /// use sincro_dynamics::prelude::*;
    ///
    /// # let mut builder = ModelBuilder::new([0.0; 3]);
    /// # let base = builder.joint("base", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    /// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
    /// # builder.body("ball", base, Pose::identity(), BodySpec { mass });
    /// # let model = builder.build()?.0;
    /// let force = Vec3([0.0, 0.0, 2.0 * model.total_mass()]); // accelerates by 2 m/s²
    /// let mut world = World::builder(model).step_size(0.01).build()?;
    /// world.apply_external_force(ExternalForce { link: 0, point: Vec3([0.0; 3]), force, torque: Vec3([0.0; 3]) });
    /// world.step()?;
    /// assert!((world.state.v[5] - 2.0 * 0.01).abs() < 1e-12); // [m/s]
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn apply_external_force(&mut self, applied: ExternalForce<f64>) {
        self.mechanism.apply_external_force(applied);
    }

    /// Removes all forces of [`World::apply_external_force`].
    pub fn clear_external_forces(&mut self) {
        self.mechanism.clear_external_forces();
    }

    /// Replaces a motor between two steps; its joint stays, its command and the state of the other drives too. A motor
    /// that becomes a drive is locked from the next step on.
    ///
    /// # Panics
    ///
    /// If the model has no such motor.
    pub fn set_motor(&mut self, id: MotorId, motor: Motor<f64>) {
        self.mark_model_changed();
        self.mechanism.drives.copy_from_slice(&self.state.drives);
        self.mechanism.set_motor(id, motor);
        self.resize_drives();
    }

    /// Makes room for the drives of the mechanism.
    fn resize_drives(&mut self) {
        let n = self.mechanism.drives.len();
        self.state.drives.resize(n, 0.0);
        self.state.drives.copy_from_slice(&self.mechanism.drives);
        self.target_velocities.resize(n, 0.0);
        self.made_target_velocities.resize(n, 0.0);
        self.jumps.resize(n, false);
        self.kinks.resize(n);
    }

    /// Mechanism of the world, for kinematics and energies at the state; changes of its modes last until the next step.
    pub fn mechanism(&mut self) -> &mut Mechanism<f64> {
        &mut self.mechanism
    }

    /// Lays the chart at the state and writes y, the states of the coupled system included.
    fn load(&mut self, system: &mut dyn CoupledSystem<f64>) {
        self.mechanism.load(&self.state, &mut self.y);
        let own = self.mechanism.dim();
        copy_any(&mut self.y[own..], system.states());
    }

    /// f(t, y) into `self.slope`.
    fn evaluate_slope(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) {
        let mut system = Coupled {
            mechanism: &mut self.mechanism,
            system,
            negated_jacobian_diagonal: &mut self.negated_jacobian_diagonal,
        };
        system.slope(t, &self.y, &mut self.slope);
    }

    fn velocity(&self, dof: usize) -> f64 {
        self.y[self.layout().velocity(dof)]
    }

    fn layout(&self) -> Layout {
        self.mechanism.layout()
    }
}

//! Many worlds of one structure at once: lanes within a processor, threads across them, steps compiled where that pays.
//!
//! The result does not depend on the number of threads, nor on what is compiled: each world has the bits it would have
//! alone.

use std::sync::Arc;
use std::time::Duration;

use sincro_compile::native::{self, Native, NativeProgram};
use sincro_compile::{Obstacle, plant};
use sincro_dynamics::batch::{self, BatchSettings, BatchWorld, CompiledStep};
use sincro_dynamics::model::{Model, PackError};
use sincro_dynamics::state::State;
use sincro_math::record::Program;

/// Steps of worlds times their degrees of freedom from which a compilation pays: it takes a few tenths of a second, and
/// saves about 5 ns each.
const WORTH_COMPILING: f64 = 1e8;

/// Largest number of worlds that may differ in their models for a compiled step: every number of the step that differs
/// is kept for each.
const MAX_DIFFERENT: usize = 1 << 14;

/// Choice of the way in which a batch makes its steps; the results are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compile {
    /// Compiled if that can be done and pays.
    #[default]
    IfItPays,
    /// Compiled if that can be done.
    IfPossible,
    /// By the recursions.
    Never,
}

/// Way in which a batch makes its steps.
#[derive(Clone, Debug, PartialEq)]
pub enum StepsBy {
    /// A program compiled by the system's C compiler.
    Compiled {
        /// Time for compiling, loading and comparing it.
        elapsed: Duration,
        /// True if it was in the cache.
        is_cached: bool,
    },
    /// The recursions.
    Recursions {
        /// Reason why they are not compiled, in words that continue "it is not compiled: ".
        reason: String,
    },
}

/// Worlds of one structure that are advanced together, time and again; they may differ in every number of their models.
#[derive(Debug)]
pub struct Rollout {
    worlds: Vec<BatchWorld>,
    settings: BatchSettings,
    step: Option<BatchStep>,
    steps_by: StepsBy,
}

/// Compiled step of a batch: for lanes, and the program it was made from, which has the numbers of each world.
#[derive(Debug)]
struct BatchStep {
    native: Arc<NativeProgram>,
    program: Program,
}

impl BatchStep {
    /// Step of the worlds from number `first` on.
    fn of_bundle(&self, first: usize) -> BundleStep {
        let parameters = native::rows_of_parameters(&self.program, first, self.native.width());
        BundleStep { native: Arc::clone(&self.native), parameters }
    }
}

/// Compiled step of one bundle.
#[derive(Debug)]
struct BundleStep {
    native: Arc<NativeProgram>,
    parameters: Vec<f64>,
}

impl CompiledStep for BundleStep {
    fn step(&self, rows: &mut [f64]) -> bool {
        self.native.evaluate_in_place(rows, &self.parameters)
    }
}

impl Rollout {
    /// Prepares worlds, whose models must have the same structure, for steps by `settings`.
    ///
    /// ```
    /// use sincro_dynamics::batch::{BatchSettings, BatchWorld};
    /// use sincro_dynamics::prelude::*;
    /// use sincro_sim::rollout::{Compile, Rollout};
    ///
    /// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    /// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
    /// # let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -1.0], inertia: [0.0; 6] };
    /// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
    /// # let model = builder.build()?.0;
    /// let worlds = vec![BatchWorld::new(model.clone(), State::new(&model)); 64];
    /// let settings =
    ///     BatchSettings { method: MethodKind::SemiImplicitEuler, h: 0.001, n_steps: 1000, record_every: 0 };
    /// let mut rollout = Rollout::new(worlds, settings, Compile::IfItPays);
    /// for episode in 0..3 {
    ///     for k in 0..64 {
    ///         let start = State { q: vec![0.01 * k as f64], v: vec![episode as f64], ..State::new(&model) };
    ///         rollout.restart(k, &start);
    ///     }
    ///     rollout.advance(0)?;
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn new(worlds: Vec<BatchWorld>, settings: BatchSettings, compile: Compile) -> Self {
        let (step, steps_by) = match compile_step(&worlds, &settings, compile) {
            Ok((step, steps_by)) => (Some(step), steps_by),
            Err(obstacle) => (None, StepsBy::Recursions { reason: obstacle.to_string() }),
        };
        Self { worlds, settings, step, steps_by }
    }

    /// Way in which the steps are made.
    #[must_use]
    pub fn steps_by(&self) -> &StepsBy {
        &self.steps_by
    }

    /// The worlds.
    #[must_use]
    pub fn worlds(&self) -> &[BatchWorld] {
        &self.worlds
    }

    /// The worlds, after the last advance.
    #[must_use]
    pub fn into_worlds(self) -> Vec<BatchWorld> {
        self.worlds
    }

    /// Puts world `k` into a state, as if it had not run: without a reason to stop, with an empty record.
    ///
    /// # Panics
    ///
    /// If there is no such world.
    pub fn restart(&mut self, k: usize, state: &State<f64>) {
        let world = &mut self.worlds[k];
        world.state.clone_from(state);
        world.stop = None;
        world.record.clear();
    }

    /// Sets the commands of world `k` for every step; see [`BatchWorld::commands`].
    ///
    /// # Panics
    ///
    /// If there is no such world.
    pub fn set_commands(&mut self, k: usize, commands: Vec<f64>) {
        self.worlds[k].commands = commands;
    }

    /// Advances all worlds by [`BatchSettings::n_steps`] steps on `threads` threads (0: one per processor).
    ///
    /// # Errors
    ///
    /// [`PackError`] if the worlds differ in more than their numbers.
    pub fn advance(&mut self, threads: usize) -> Result<(), PackError> {
        advance(&mut self.worlds, &self.settings, self.step.as_ref(), threads)
    }
}

/// Compiles the step of a batch.
fn compile_step(
    worlds: &[BatchWorld],
    settings: &BatchSettings,
    compile: Compile,
) -> Result<(BatchStep, StepsBy), Obstacle> {
    let Some(first) = worlds.first() else { return Err(Obstacle::new("there is no world")) };
    let work = worlds.len() as f64 * f64::from(settings.n_steps) * first.model.n_v() as f64;
    if compile == Compile::Never {
        return Err(Obstacle::new("that is not wanted"));
    }
    if compile == Compile::IfItPays && work < WORTH_COMPILING {
        return Err(Obstacle::new("it would take longer than the steps"));
    }
    if worlds.len() < sincro_math::lanes::width() {
        return Err(Obstacle::new("there are fewer worlds than lanes"));
    }
    // worlds of one model need no numbers of their own
    let is_same = worlds.iter().all(|world| world.model.is_same(&first.model));
    if !is_same && worlds.len() > MAX_DIFFERENT {
        return Err(Obstacle::new(format!("there are more than {MAX_DIFFERENT} worlds with numbers of their own")));
    }
    let different = if is_same { &worlds[..1] } else { worlds };
    let models: Vec<&Model<f64>> = different.iter().map(|world| &world.model).collect();
    let program = plant::step(&models, settings.method, settings.h)?.with_folded_parameters();
    let Native { mut programs, elapsed, is_cached } = native::compile(&[&program])?;
    let native = Arc::new(programs.remove(0));
    Ok((BatchStep { native, program }, StepsBy::Compiled { elapsed, is_cached }))
}

fn advance(
    worlds: &mut [BatchWorld],
    settings: &BatchSettings,
    step: Option<&BatchStep>,
    threads: usize,
) -> Result<(), PackError> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = if threads == 0 { available } else { threads };
    let width = sincro_math::lanes::width();
    // whole bundles to each thread, so that lanes are full wherever they can be
    let bundles = worlds.len().div_ceil(width);
    let share = bundles.div_ceil(threads).max(1) * width;
    let of_part = |part: &mut [BatchWorld], first: usize| match step {
        None => batch::advance(part, settings),
        Some(step) => {
            let of_bundle = |k: usize| -> Arc<dyn CompiledStep> { Arc::new(step.of_bundle(first + k)) };
            batch::advance_compiled(part, settings, Some(&of_bundle))
        }
    };
    if share >= worlds.len() {
        return of_part(worlds, 0);
    }
    std::thread::scope(|scope| {
        let of_part = &of_part;
        let parts: Vec<_> = worlds
            .chunks_mut(share)
            .enumerate()
            .map(|(k, part)| scope.spawn(move || of_part(part, k * share)))
            .collect();
        parts.into_iter().try_for_each(|part| part.join().expect("a batch does not panic"))
    })
}

/// Advances all worlds by [`BatchSettings::n_steps`] steps, several in SIMD lanes and on `threads` threads (0: one per
/// processor), compiled if that pays: a [`Rollout`] used once. Each world's [`BatchWorld::record`] and final state are
/// filled in; they do not depend on the number of threads.
///
/// ```
/// use sincro_dynamics::batch::{BatchSettings, BatchWorld};
/// use sincro_dynamics::joint::JointKind;
/// use sincro_dynamics::model::{BodySpec, JointSpec, ModelBuilder, NodeId, Shape};
/// use sincro_dynamics::spatial::{Pose, Vec3};
/// use sincro_dynamics::state::State;
/// use sincro_dynamics::world::MethodKind;
///
/// // a hundred pendulums of different length
/// let mut worlds: Vec<BatchWorld> = (0..100)
///     .map(|k| {
///         let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
///         let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
///         let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
///         let at = Pose::translation(Vec3([0.0, 0.0, -0.5 - 0.01 * k as f64]));
///         let ball = BodySpec { mass: Shape::Sphere { radius: 0.05 }.mass_properties(1000.0) };
///         builder.body("ball", hinge, at, ball);
///         let model = builder.build().unwrap().0;
///         let mut state = State::new(&model);
///         state.q[0] = 0.3;
///         BatchWorld::new(model, state)
///     })
///     .collect();
/// let settings = BatchSettings { method: MethodKind::Rk4, h: 0.001, n_steps: 1000, record_every: 100 };
/// sincro_sim::rollout::rollout(&mut worlds, &settings, 2).unwrap();
/// assert_eq!(worlds[99].record.len(), 11 * 2);
/// ```
///
/// # Errors
///
/// [`PackError`] if the worlds differ in more than their numbers: they must have the same structure.
pub fn rollout(worlds: &mut [BatchWorld], settings: &BatchSettings, threads: usize) -> Result<(), PackError> {
    let step = compile_step(worlds, settings, Compile::IfItPays).ok().map(|(step, _)| step);
    advance(worlds, settings, step.as_ref(), threads)
}

//! Loading a scene folder: its files, and the parts of the program above the lock-step that it needs.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use sincro_dynamics::world::MethodKind;

use crate::controller::Controller;
use crate::workers::on_all_processors;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, SourceText};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::Experiment;
use sincro_scene::fmu::{FmuLoader, Loaders};
use sincro_scene::folder::Folder;
use sincro_scene::open::{Opened, open, open_in, settings_with};
use sincro_scene::overrides::Override;
use sincro_scene::scene::Scene;
use sincro_scene::script::ScriptParser;

/// Experiment with its scene, loaded and ready to run; result of [`load`].
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded: Loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// assert_eq!((loaded.scene.model.n_v(), loaded.experiment.step), (2, 0.05)); // two joints; [s]
/// // the same files with another setting
/// let heavier = loaded.with_overrides(&[Override::new("/shoulder/upper.mass", "3.0")])?;
/// assert_eq!(heavier.scene.model.total_mass() - loaded.scene.model.total_mass(), 2.0); // [kg]
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Loaded {
    /// Experiment: times, recorded signals, checks, variants.
    pub experiment: Experiment,
    /// Compiled scene with its model.
    pub scene: Arc<Scene>,
    /// Block diagram that controls the scene, if there is one.
    pub controller: Option<ControlDiagram>,
    /// Warnings about the files, in their order.
    pub warnings: Vec<Diagnostic>,
    /// Every text file that was read, for a hash of the inputs.
    pub sources: Vec<Arc<SourceText>>,
    /// Cache of the folder's files.
    pub folder: Arc<Folder>,
    /// Settings that it was loaded with, which win over the files.
    pub overrides: Vec<Override>,
    /// Extensions that it was loaded with; variants and sweeps are loaded with the same.
    pub extensions: Extensions,
    /// Factories of the program's own controllers, which are attached to each run of the scene after those of its
    /// files, in this order.
    pub controllers: Vec<Arc<dyn ControllerFactory>>,
    /// Variants, and first and last run of the sweep, that were opened on trial with this one, each with its settings:
    /// [`Loaded::with_overrides`] does not open them again, if `folder` is still theirs. Those with trials of their
    /// own are left out. Whoever changes `extensions` or the files kept in `folder` empties it.
    pub trials: Arc<[(Vec<Override>, Opened)]>,
}

/// Factory of a controller for each run of a scene: the main run, its finer run, the variants. Added to
/// [`Loaded::controllers`].
pub trait ControllerFactory: Send + Sync + fmt::Debug {
    /// Creates the controller of one run of `loaded`, in its state before the first tick.
    fn controller(&self, loaded: &Loaded) -> Box<dyn Controller>;
}

/// Function that computes the greatest moduli `[1/s]` of the poles at the start of a run with the given method: with
/// the diagram's continuous blocks in the loop, and without; `None` if there is no operating point. `sincro-analysis`
/// has it.
pub type FastestPoles = fn(&Loaded, MethodKind) -> Option<(f64, f64)>;

/// Engine of a scripting language: parses scripts when a scene is loaded, and runs them as a controller; implemented by
/// `sincro-lua` and given to [`load`] in [`Extensions`].
///
/// ```
/// use sincro_scene::script::{Script, ScriptError, ScriptParser, ScriptedLaw, ScriptedLawSpec};
/// use sincro_sim::prelude::*;
///
/// /// A language without words: accepts any script and does nothing in a run.
/// #[derive(Debug)]
/// struct Silence;
///
/// impl ScriptParser for Silence {
///     fn check(&self, _script: &Script) -> Result<(), ScriptError> {
///         Ok(())
///     }
///     fn law(&self, _spec: &ScriptedLawSpec) -> Result<Box<dyn ScriptedLaw>, String> {
///         Err("it has no laws".into())
///     }
/// }
///
/// impl ScriptEngine for Silence {
///     fn controller(&self, _loaded: &Loaded) -> Box<dyn Controller> {
///         Box::new(ClosureController::new("silence", |_: Instant<'_>, _: &mut [Option<f64>]| {}))
///     }
/// }
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/propeller-lua");
/// assert!(load(folder.as_ref(), &[], Extensions::default()).is_err()); // its scripts have no language
/// let loaded = load(folder.as_ref(), &[], Extensions { scripts: Some(&Silence), ..Extensions::default() })?;
/// assert!(!loaded.scene.scripts.is_empty());
/// # Ok(())
/// # }
/// ```
pub trait ScriptEngine: ScriptParser {
    /// Creates the controller that runs the scripts of a scene; none of them has been called yet.
    fn controller(&self, loaded: &Loaded) -> Box<dyn Controller>;
}

/// Extensions that a program gives to [`load`]: parts above this crate that a scene may need. The default has none.
///
/// ```
/// use sincro_analysis::linearize::fastest_poles;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cart-pole-lqr");
/// let extensions = Extensions { fastest_poles: Some(fastest_poles), ..Extensions::default() };
/// let loaded = load(folder.as_ref(), &[], extensions)?;
/// let (closed, open) = fastest_poles(&loaded, method_for(&loaded).0).unwrap(); // [1/s]
/// assert!(closed > 0.0 && open > 0.0);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Extensions {
    /// Engine of the scripting language; without one, a scene with scripts is refused.
    pub scripts: Option<&'static dyn ScriptEngine>,
    /// Loader of FMUs; without one, a scene with FMUs is refused.
    pub fmus: Option<&'static dyn FmuLoader>,
    /// Linearisation of the loop that a diagram closes; without it, there is no warning about poles that are too fast
    /// for a fixed step.
    pub fastest_poles: Option<FastestPoles>,
}

impl Extensions {
    fn loaders(&self) -> Loaders {
        Loaders { scripts: self.scripts.map(|engine| engine as &dyn ScriptParser), fmus: self.fmus }
    }
}

/// Loads a scene folder, or its `experiment.toml`, with the settings `overrides`, which win over the files (later ones
/// over earlier ones). `extensions` run its scripts and FMUs.
///
/// Variants and sweeps are opened on trial, so that errors in their settings show before anything runs. To run a
/// variant, see [`Loaded::with_overrides`].
///
/// # Errors
///
/// All findings about the files and the settings, warnings included, in the order of the files.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// assert_eq!(loaded.scene.initial.q, [0.1, 0.0]); // [rad]
///
/// // a setting that means nothing is refused, with a near name
/// let wrong = [Override::new("/shoulder.initial.positon", "0.3")];
/// let found = load(folder.as_ref(), &wrong, Extensions::default()).unwrap_err();
/// assert!(found.to_string().contains("position"), "{found}");
/// # Ok(())
/// # }
/// ```
pub fn load(folder: &Path, overrides: &[Override], extensions: Extensions) -> Result<Loaded, Diagnostics> {
    with(folder, overrides, extensions, true)
}

/// As [`load`], without opening variants and sweep: for a live run, whose settings need not fit the scenes of the
/// others.
///
/// # Errors
///
/// As [`load`].
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let upright = [Override::new("/upper.initial.position", "3.0")];
/// let loaded = load_without_variants(folder.as_ref(), &upright, Extensions::default())?;
/// assert_eq!(loaded.scene.initial.q[0], 3.0); // [rad]
/// # Ok(())
/// # }
/// ```
pub fn load_without_variants(
    folder: &Path,
    overrides: &[Override],
    extensions: Extensions,
) -> Result<Loaded, Diagnostics> {
    with(folder, overrides, extensions, false)
}

fn with(
    folder: &Path,
    overrides: &[Override],
    extensions: Extensions,
    with_others: bool,
) -> Result<Loaded, Diagnostics> {
    let opened = open(folder, overrides, extensions.loaders(), false)?;
    if with_others {
        with_trials(opened, overrides, extensions)
    } else {
        Ok(Loaded::new(opened, overrides, extensions))
    }
}

/// Opens on trial, on all processors, what will run with an experiment that was opened with the settings `overrides`.
fn with_trials(opened: Opened, overrides: &[Override], extensions: Extensions) -> Result<Loaded, Diagnostics> {
    let settings = opened.trials(overrides);
    if settings.is_empty() {
        return Ok(Loaded::new(opened, overrides, extensions));
    }
    let folder = opened.folder.clone();
    let open_trial = |k: usize| open_in(&folder, &settings[k], extensions.loaders(), false);
    let tried = on_all_processors(settings.len(), &open_trial, &mut || ());
    let (opened, trials) = opened.with_trials(tried)?;
    // those that have trials of their own are opened again, with these
    let known = settings.into_iter().zip(trials).filter(|(settings, trial)| trial.trials(settings).is_empty());
    Ok(Loaded { trials: known.collect(), ..Loaded::new(opened, overrides, extensions) })
}

impl Loaded {
    fn new(opened: Opened, overrides: &[Override], extensions: Extensions) -> Self {
        let Opened { experiment, scene, controller, warnings, sources, folder } = opened;
        let (scene, overrides) = (Arc::new(scene), overrides.to_vec());
        let (controllers, trials) = (Vec::new(), Arc::default());
        Self { experiment, scene, controller, warnings, sources, folder, overrides, extensions, controllers, trials }
    }

    /// Loads the same experiment with the settings that it was loaded with and `more` behind them, which win, without
    /// opening variants and sweep.
    ///
    /// # Errors
    ///
    /// As [`load`].
    pub fn with_more_overrides(&self, more: &[Override]) -> Result<Self, Diagnostics> {
        self.with_overrides_without_variants(&settings_with(&self.overrides, more))
    }

    /// As [`Loaded::with_overrides`], without opening variants and sweep.
    ///
    /// # Errors
    ///
    /// As [`load`].
    pub fn with_overrides_without_variants(&self, overrides: &[Override]) -> Result<Self, Diagnostics> {
        let opened = open_in(&self.folder, overrides, self.extensions.loaders(), false)?;
        Ok(Self { controllers: self.controllers.clone(), ..Self::new(opened, overrides, self.extensions) })
    }

    /// Loads the same experiment with other settings from the cached files. `overrides` replace those that it was
    /// loaded with; for a variant they are those of [`settings_with`].
    ///
    /// # Errors
    ///
    /// As [`load`].
    pub fn with_overrides(&self, overrides: &[Override]) -> Result<Self, Diagnostics> {
        let loaded = match self
            .trials
            .iter()
            .find(|(settings, trial)| settings == overrides && Arc::ptr_eq(&trial.folder, &self.folder))
        {
            Some((_, trial)) => {
                let opened = Opened { sources: self.folder.sources(), ..trial.clone() };
                Self::new(opened, overrides, self.extensions)
            }
            None => {
                let opened = open_in(&self.folder, overrides, self.extensions.loaders(), false)?;
                with_trials(opened, overrides, self.extensions)?
            }
        };
        Ok(Self { controllers: self.controllers.clone(), ..loaded })
    }
}

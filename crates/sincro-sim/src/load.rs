//! Loading a scene folder: its files, and the parts of the program above the lock-step that it needs.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use sincro_dynamics::world::MethodKind;

use crate::controller::Controller;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, SourceText};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::Experiment;
use sincro_scene::fmu::{FmuLoader, Loaders};
use sincro_scene::folder::Folder;
use sincro_scene::open::{Opened, open, open_in};
use sincro_scene::overrides::Override;
use sincro_scene::scene::Scene;
use sincro_scene::script::ScriptParser;

/// An experiment and its scene, ready to run.
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
    /// The experiment: signals, checks, settings.
    pub experiment: Experiment,
    /// The compiled scene.
    pub scene: Scene,
    /// The diagram that controls it, if there is one.
    pub controller: Option<ControlDiagram>,
    /// Warnings for the user.
    pub warnings: Vec<Diagnostic>,
    /// Every text file that was read: what a hash of the inputs covers.
    pub sources: Vec<Arc<SourceText>>,
    /// The folder with what was read of it.
    pub folder: Arc<Folder>,
    /// Extensions that it was loaded with: variants and sweeps are loaded with the same.
    pub extensions: Extensions,
    /// Controllers of a program, attached to each run of the scene after its own: variants and sweeps have the same.
    pub controllers: Vec<Arc<dyn ControllerFactory>>,
}

/// Maker of a controller for each run of a scene: the main run, its finer run, the variants.
pub trait ControllerFactory: Send + Sync + fmt::Debug {
    /// The controller of one run, in the state before its first tick.
    fn controller(&self, loaded: &Loaded) -> Box<dyn Controller>;
}

/// Moduli [1/s] of the fastest poles at the start of a run, with the diagram's continuous blocks in the loop and
/// without; none if there is no operating point.
pub type FastestPoles = fn(&Loaded, MethodKind) -> Option<(f64, f64)>;

/// Language of scripts: parses them when a scene is loaded, and runs them as a controller.
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
    /// The controller that runs the scripts of a scene, none of them called yet.
    fn controller(&self, loaded: &Loaded) -> Box<dyn Controller>;
}

/// Parts of the program above the lock-step that a scene may need: whoever puts the program together gives them to
/// [`load`].
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
    /// Language of scripts; without one, a scene that has scripts is refused.
    pub scripts: Option<&'static dyn ScriptEngine>,
    /// Loader of FMUs; without one, a scene that has FMUs is refused.
    pub fmus: Option<&'static dyn FmuLoader>,
    /// Linearisation of the loop that a diagram closes; without it, nobody warns of poles that are too fast for a fixed
    /// step.
    pub fastest_poles: Option<FastestPoles>,
}

impl Extensions {
    fn loaders(&self) -> Loaders {
        Loaders { scripts: self.scripts.map(|engine| engine as &dyn ScriptParser), fmus: self.fmus }
    }
}

/// Opens a scene folder, or its `experiment.toml`, with settings that win over the files.
///
/// Variants and sweeps are opened too, so that what is wrong with their settings is known before anything runs. To run
/// a variant, see [`Loaded::with_overrides`].
///
/// # Errors
///
/// Everything that is wrong with the files and the settings, warnings included, in the order of the files.
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

/// As [`load`], without opening variants and sweep: for a live run, whose settings need not fit the others' scenes.
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
    Ok(Loaded::new(open(folder, overrides, extensions.loaders(), with_others)?, extensions))
}

impl Loaded {
    fn new(opened: Opened, extensions: Extensions) -> Self {
        let Opened { experiment, scene, controller, warnings, sources, folder } = opened;
        Self { experiment, scene, controller, warnings, sources, folder, extensions, controllers: Vec::new() }
    }

    /// As [`Loaded::with_overrides`], without opening variants and sweep.
    ///
    /// # Errors
    ///
    /// As [`load`].
    pub fn with_overrides_without_variants(&self, overrides: &[Override]) -> Result<Self, Diagnostics> {
        let opened = open_in(&self.folder, overrides, self.extensions.loaders(), false)?;
        Ok(Self { controllers: self.controllers.clone(), ..Self::new(opened, self.extensions) })
    }

    /// The same experiment with other settings, from the files as they were read: nothing is read twice. `overrides`
    /// stand in place of those that it was loaded with.
    ///
    /// For a variant they are those of [`settings_with`](sincro_scene::open::settings_with).
    ///
    /// # Errors
    ///
    /// As [`load`].
    pub fn with_overrides(&self, overrides: &[Override]) -> Result<Self, Diagnostics> {
        let opened = open_in(&self.folder, overrides, self.extensions.loaders(), true)?;
        Ok(Self { controllers: self.controllers.clone(), ..Self::new(opened, self.extensions) })
    }
}

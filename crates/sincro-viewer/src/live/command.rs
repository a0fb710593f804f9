//! Commands of viewers to the engine; anything else is refused.

use serde::Deserialize;

/// Command of a viewer to the [`Engine`](super::Engine) of a live run; in JSON an object whose key `do` is the name of
/// the variant.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Command {
    /// Continues the present run.
    Play {},
    /// Pauses the present run.
    Pause {},
    /// Makes one base step and pauses.
    Step {},
    /// Sets the speed of simulated time relative to the wall clock.
    Speed {
        /// Simulated seconds per second of wall time (dimensionless), greater than zero; none: as fast as possible.
        speed: Option<f64>,
    },
    /// Begins a new run from the start with the settings of the last one.
    Restart {},
    /// Begins a new run from a frame of an earlier one.
    Branch {
        /// Number of the earlier run, from 0.
        run: usize,
        /// Simulated time `[s]`; the new run starts at the last frame of the earlier one up to here.
        t: f64,
        /// Overrides of the scene's files, path and value, in the order of setting.
        set: Vec<(String, String)>,
        /// Coordinates that are changed: index in q, and value `[rad]` or `[m]`; the run then starts at rest.
        joints: Vec<(usize, f64)>,
        /// True if the new run continues at once, false if it starts paused.
        play: bool,
    },
    /// Applies a force to an object until the next push or [`Command::Release`].
    Push {
        /// Index of the object in the scene's view.
        object: usize,
        /// Point of application `[m]`: x, y, z in the world frame.
        point: [f64; 3],
        /// Force `[N]`: x, y, z in world axes.
        force: [f64; 3],
    },
    /// Removes the force.
    Release {},
    /// Writes a run as a result, as `sincro run` writes one.
    Keep {
        /// Number of the run, from 0.
        run: usize,
    },
    /// Writes the scene's files with these settings beside the old ones.
    Save {
        /// Overrides, path and value, in the order of setting.
        set: Vec<(String, String)>,
    },
}

impl Command {
    /// Reads a command from the JSON text of a viewer's message.
    ///
    /// # Errors
    ///
    /// A sentence for the viewer: the text is no command, has unknown keys, or a number that is not finite or out of
    /// range.
    pub fn parse(text: &str) -> Result<Self, String> {
        let command: Self = serde_json::from_str(text).map_err(|e| format!("this message means nothing: {e}"))?;
        let is_finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
        let fits = match &command {
            Self::Speed { speed: Some(speed) } => speed.is_finite() && *speed > 0.0,
            Self::Branch { t, joints, .. } => t.is_finite() && joints.iter().all(|(_, q)| q.is_finite()),
            Self::Push { point, force, .. } => is_finite(point) && is_finite(force),
            _ => true,
        };
        if fits { Ok(command) } else { Err("this message has a number that is out of range".into()) }
    }
}

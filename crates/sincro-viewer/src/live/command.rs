//! Commands of viewers to the engine; anything else is refused.

use serde::Deserialize;

/// A message of a viewer. The empty braces matter: without them serde would let any other key pass.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Command {
    /// Go on.
    Play {},
    /// Stand still.
    Pause {},
    /// One base step.
    Step {},
    /// Simulated seconds a second; none: as fast as it goes.
    Speed {
        /// Greater than zero.
        speed: Option<f64>,
    },
    /// A new run from the start with the settings of the last one.
    Restart {},
    /// A new run from a frame of another.
    Branch {
        /// The other run.
        run: usize,
        /// From its last frame up to here `[s]`.
        t: f64,
        /// Everything that is set against the files, in the order of setting.
        set: Vec<(String, String)>,
        /// Coordinates that are put elsewhere, at rest.
        joints: Vec<(usize, f64)>,
        /// True if it goes on at once.
        play: bool,
    },
    /// A force on an object until the next push or [`Command::Release`].
    Push {
        /// Index of the object.
        object: usize,
        /// Point of application, world axes `[m]`.
        point: [f64; 3],
        /// World axes `[N]`.
        force: [f64; 3],
    },
    /// No force any more.
    Release {},
    /// Writes a run as a result, as a run of the command line is.
    Keep {
        /// The run.
        run: usize,
    },
    /// Writes the scene's files with these settings beside the old ones.
    Save {
        /// Everything that is set.
        set: Vec<(String, String)>,
    },
}

impl Command {
    /// Reads a command from a viewer's message.
    ///
    /// # Errors
    ///
    /// A sentence about what is wrong with it.
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

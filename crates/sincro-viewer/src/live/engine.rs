//! The engine: advances the present run by the wall clock, does what viewers ask, and writes to the live state.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, sync_channel};
use std::time::{Duration, Instant};

use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::check::{Expected, Subject};
use sincro_scene::overrides::Override;
use sincro_sim::replay::{SceneView, properties};
use sincro_sim::{Extensions, load, load_without_variants};

use super::command::Command;
use super::history::KeptRun;
use super::live_state::{LiveState, RunLog};
use super::track::{Taken, Track};
use crate::replay::{FORMAT, Replay, plots, record};
use crate::save::save_scene;

/// Commands that may wait.
const MAX_WAITING: usize = 64;
/// Memory for the snapshots of all runs: 256 MB. What does not fit is thinned in time.
const SNAPSHOT_BYTES: usize = 256 << 20;
/// Wall time of computation between two reads of commands.
const STRETCH: Duration = Duration::from_millis(8);
/// Time of sleep when it is ahead of the clock.
const NAP: Duration = Duration::from_millis(4);

/// Scene of a live run and what the engine needs beside it: the argument of [`Engine::open`].
pub struct Source {
    /// Path of the scene folder.
    pub folder: PathBuf,
    /// Overrides of the scene's files.
    pub settings: Vec<Override>,
    /// Extensions that the scene may need beyond its files: language of scripts, loader of FMUs.
    pub extensions: Extensions,
    /// Draws the block diagram of the scene as SVG for the page.
    pub draw: Box<dyn Fn(&ControlDiagram) -> String + Send>,
    /// Writes a run as a result when a viewer asks for it.
    pub keep: ResultWriter,
}

/// Function that writes a live run as a result: it returns a sentence with the path for the viewer, or one about what
/// prevents it.
pub type ResultWriter = Box<dyn Fn(&KeptRun) -> Result<String, String> + Send>;

/// Results that one engine writes; whoever has the link may ask for them, and disks are not endless.
const MAX_KEPT: usize = 100;

/// Engine of a live scene: it advances the present run by the wall clock, obeys the commands of viewers and publishes a
/// [`LiveState`].
///
/// ```
/// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
/// use sincro_viewer::live::{Command, Engine, Source};
///
/// let engine = Engine::open(Source {
///     folder: scene,
///     settings: Vec::new(),
///     extensions: Default::default(),
///     draw: Box::new(|_| String::new()),
///     keep: Box::new(|_| Err("nothing is written here".to_owned())),
/// })?;
/// let live_state = engine.live_state();
/// let commands = engine.start();
/// commands.send(Command::Step {})?;
/// assert_eq!(live_state.read().runs.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Engine {
    source: Source,
    live_state: Arc<LiveState>,
    tracks: Vec<Track>,
    /// Number of results written.
    n_kept: usize,
    playing: bool,
    speed: Option<f64>,
    /// Wall clock and simulated time when it last began to play or changed its speed.
    since: (Instant, f64),
}

impl Engine {
    /// Loads a scene with its first run, paused at the start.
    ///
    /// # Errors
    ///
    /// All problems of the scene's files and the settings, each with its place in the file.
    pub fn open(source: Source) -> Result<Self, Diagnostics> {
        let loaded = load(&source.folder, &source.settings, source.extensions)?;
        let replay = Replay {
            format: FORMAT,
            title: loaded.experiment.title.clone(),
            description: loaded.experiment.description.clone(),
            scene: source.folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            step: loaded.experiment.step,
            duration: loaded.experiment.duration,
            views: Vec::new(),
            properties: Vec::new(),
            plots: plots(&loaded),
            record: record(&loaded),
            diagram: loaded.controller.as_ref().map(|c| (source.draw)(c)),
            runs: Vec::new(),
        };
        let live_state = Arc::new(LiveState::new(replay.to_json()));
        let first = Track::new(loaded, source.settings.clone())?;
        let since = (Instant::now(), 0.0);
        let mut engine =
            Self { source, live_state, tracks: Vec::new(), n_kept: 0, playing: false, speed: Some(1.0), since };
        engine.begin(first, "main", "");
        Ok(engine)
    }

    /// Live state that the engine publishes, shared with the viewers that read it.
    #[must_use]
    pub fn live_state(&self) -> Arc<LiveState> {
        self.live_state.clone()
    }

    /// Starts the engine in a thread of its own and returns the sender of its commands; the thread ends when the last
    /// sender is dropped. 64 commands may wait.
    #[must_use]
    pub fn start(mut self) -> SyncSender<Command> {
        let (sender, receiver) = sync_channel(MAX_WAITING);
        std::thread::spawn(move || self.run(&receiver));
        sender
    }

    fn run(&mut self, commands: &Receiver<Command>) {
        loop {
            let waits = !self.playing;
            let next = if waits {
                commands.recv().map_err(|_| TryRecvError::Disconnected)
            } else {
                match commands.recv_timeout(self.play()) {
                    Ok(command) => Ok(command),
                    Err(RecvTimeoutError::Timeout) => Err(TryRecvError::Empty),
                    Err(RecvTimeoutError::Disconnected) => Err(TryRecvError::Disconnected),
                }
            };
            match next {
                Ok(command) => self.obey(command),
                Err(TryRecvError::Empty) => {}
                Err(TryRecvError::Disconnected) => return,
            }
        }
    }

    /// Computes until the clock is reached or the stretch is over; how long there is nothing to do then.
    fn play(&mut self) -> Duration {
        let begin = Instant::now();
        let target = self.speed.map(|speed| self.since.1 + (begin - self.since.0).as_secs_f64() * speed);
        loop {
            let track = self.tracks.last_mut().expect("there is a run from the start on");
            if track.is_done() {
                self.halt();
                return Duration::ZERO;
            }
            if target.is_some_and(|target| track.lockstep.t() >= target) {
                return NAP;
            }
            if track.advance() {
                let taken = track.take(false);
                self.publish(taken);
            }
            if begin.elapsed() > STRETCH {
                return Duration::ZERO;
            }
        }
    }

    /// Does what a viewer asks; refusals go to all viewers.
    fn obey(&mut self, command: Command) {
        let done = match command {
            Command::Play {} => {
                self.go();
                Ok(())
            }
            Command::Pause {} => {
                self.halt();
                Ok(())
            }
            Command::Step {} => {
                self.step();
                Ok(())
            }
            Command::Speed { speed } => {
                self.speed = speed;
                self.since = (Instant::now(), self.present().lockstep.t());
                self.stand();
                Ok(())
            }
            Command::Restart {} => self.restart(),
            Command::Branch { run, t, set, joints, play } => self.branch((run, t), &set, &joints, play),
            Command::Push { object, point, force } => {
                self.tracks.last_mut().map_or(Ok(()), |track| track.set_push(Some((object, point, force))))
            }
            Command::Release {} => self.tracks.last_mut().map_or(Ok(()), |track| track.set_push(None)),
            Command::Keep { run } => self.keep(run),
            Command::Save { set } => save_scene(&self.source.folder, &self.settings(&set), self.source.extensions)
                .map(|folder| self.live_state.say("saved", &format!("saved as {}", folder.display()))),
        };
        if let Err(message) = done {
            self.live_state.say("refused", &message);
        }
    }

    fn present(&self) -> &Track {
        self.tracks.last().expect("there is a run from the start on")
    }

    fn go(&mut self) {
        self.playing = !self.present().is_done();
        self.since = (Instant::now(), self.present().lockstep.t());
        self.stand();
    }

    fn halt(&mut self) {
        self.playing = false;
        self.take_if_new();
        self.stand();
    }

    fn step(&mut self) {
        self.playing = false;
        let track = self.tracks.last_mut().expect("there is a run from the start on");
        if !track.is_done() {
            track.advance();
        }
        self.take_if_new();
        self.stand();
    }

    /// A frame of where it stands, unless there is one.
    fn take_if_new(&mut self) {
        let track = self.tracks.last_mut().expect("there is a run from the start on");
        let t = track.lockstep.t();
        let is_new = self.live_state.read().runs.last().is_none_or(|run| run.times.last().is_none_or(|last| *last < t));
        if is_new {
            let taken = track.take(false);
            self.publish(taken);
        }
    }

    fn restart(&mut self) -> Result<(), String> {
        let settings = self.present().settings().to_vec();
        let loaded = load_without_variants(&self.source.folder, &settings, self.source.extensions)
            .map_err(|diagnostics| diagnostics.to_string())?;
        let track = Track::new(loaded, settings).map_err(|diagnostics| diagnostics.to_string())?;
        self.begin_next(track, "from the start");
        Ok(())
    }

    /// Writes a run as a result.
    fn keep(&mut self, run: usize) -> Result<(), String> {
        self.halt();
        if self.n_kept >= MAX_KEPT {
            return Err(format!("{MAX_KEPT} results have been saved from here already: start `sincro view` again"));
        }
        let track = self.tracks.get(run).ok_or_else(|| format!("there is no run {run}"))?;
        let message = (self.source.keep)(&track.kept()?)?;
        self.n_kept += 1;
        self.live_state.say("saved", &message);
        Ok(())
    }

    fn settings(&self, set: &[(String, String)]) -> Vec<Override> {
        let new = set.iter().map(|(path, value)| Override::new(path, value));
        self.source.settings.iter().cloned().chain(new).collect()
    }

    fn branch(
        &mut self,
        (run, t): (usize, f64),
        set: &[(String, String)],
        joints: &[(usize, f64)],
        play: bool,
    ) -> Result<(), String> {
        let from = self.tracks.get(run).ok_or_else(|| format!("there is no run {run}"))?;
        let settings = self.settings(set);
        let snapshot = from.snapshot_at(t).filter(|s| s.state.tick > 0 || !joints.is_empty()).cloned();
        let loaded = load_without_variants(&self.source.folder, &settings, self.source.extensions)
            .map_err(|diagnostics| diagnostics.to_string())?;
        let mut track = Track::new(loaded, settings).map_err(|diagnostics| diagnostics.to_string())?;
        if let Some(snapshot) = &snapshot {
            track = track.from(&self.tracks[run], snapshot, joints)?;
        }
        let mut words: Vec<String> = set.iter().map(|(path, value)| format!("{path} = {value}")).collect();
        let start = track.lockstep.t();
        words.push(format!("from {start:.4} s of run {run}"));
        self.begin_next(track, &words.join(", "));
        if play {
            self.go();
        }
        Ok(())
    }

    fn begin_next(&mut self, track: Track, about: &str) {
        self.playing = false;
        let name = format!("run {}", self.tracks.len());
        self.begin(track, &name, about);
    }

    /// Adds a new run to the live state.
    fn begin(&mut self, mut track: Track, name: &str, about: &str) {
        let header = header(&track, self.tracks.len(), name, about);
        let log = RunLog { header, n_columns: track.columns.len(), width: track.layout.width(), ..RunLog::default() };
        let taken = track.take(true);
        self.tracks.push(track);
        let share = SNAPSHOT_BYTES / self.tracks.len();
        self.tracks.iter_mut().for_each(|track| track.keep_snapshots(share));
        self.live_state.write(|content| content.runs.push(log));
        self.publish(taken);
        self.stand();
    }

    fn publish(&mut self, taken: Taken) {
        self.live_state.write(|content| {
            let run = content.runs.last_mut().expect("the run is in the live state");
            run.times.push(taken.t);
            run.rows.extend(taken.row);
            run.frames.extend(taken.frame);
            run.contacts.append(&taken.contacts);
            run.runtime.extend(taken.runtime);
        });
        let factor = self.factor(taken.t);
        // told ten times a second is enough
        self.live_state.read().engine.factor = factor;
    }

    fn factor(&self, t: f64) -> Option<f64> {
        let wall = self.since.0.elapsed().as_secs_f64();
        (self.playing && wall > 0.05).then(|| (t - self.since.1) / wall)
    }

    /// Tells how it stands.
    fn stand(&mut self) {
        let track = self.present();
        let (stop, done, trace) = (track.stop.clone(), track.is_done(), track.trace.to_string());
        let factor = self.factor(track.lockstep.t());
        let (run, playing, speed) = (self.tracks.len() - 1, self.playing, self.speed);
        self.live_state.write(|content| {
            content.engine = super::live_state::EngineState { run, playing, speed, factor, stop, done, trace };
        });
    }
}

/// A run's description.
fn header(track: &Track, id: usize, name: &str, about: &str) -> String {
    let checks = &track.loaded.experiment.checks;
    let references = checks.iter().filter_map(|check| match (&check.what, &check.expected) {
        (Subject::Signal(signal), Expected::Reference(r)) => Some((signal.value.as_str(), &*r.keys, &*r.values)),
        _ => None,
    });
    let view: &SceneView = &track.view;
    serde_json::json!({
        "type": "run", "id": id, "name": name, "about": about, "view": view, "columns": track.columns,
        "references": references.collect::<Vec<_>>(), "properties": properties(&track.loaded, track.settings()),
    })
    .to_string()
}

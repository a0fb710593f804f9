//! History of a live run: the runs that it was branched from and what was done to it by hand, so that it can be
//! computed again, bit for bit.

use std::path::Path;

use sincro_dynamics::actuation::ExternalForce;
use sincro_scene::overrides::Override;
use sincro_sim::controller::Message;
use sincro_sim::results::Status;
use sincro_sim::run::{LockStep, Recording, RunOptions, Simulated, method_for};
use sincro_sim::snapshot::Snapshot;
use sincro_sim::{Extensions, Loaded, load_without_variants};

/// Part of a live run between two interventions that needed the scene to be loaded anew: with one model and one set of
/// settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Overrides of the scene's files.
    pub settings: Vec<Override>,
    /// Tick at which it goes on from the state of the segment before; none: it starts as the files say.
    pub from: Option<u64>,
    /// Coordinates that were placed there: index in q, and value `[rad]` or `[m]`; the segment then starts at rest.
    pub joints: Vec<(usize, f64)>,
    /// Forces by hand: tick from which each acts, until the next; `None` for none.
    pub pushes: Vec<(u64, Option<ExternalForce<f64>>)>,
}

/// Live run that is to be written as a result: what is needed to compute it again, bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptRun {
    /// Its parts in the order of time; one, unless it was branched from another run.
    pub segments: Vec<Segment>,
    /// Tick that it has reached.
    pub end: u64,
    /// Simulated time that it has reached `[s]`; none: the duration of the experiment.
    pub duration: Option<f64>,
    /// Trace hash (hexadecimal), which the repeated run must have.
    pub trace: String,
}

impl Segment {
    /// From the start, with these settings.
    pub(super) fn new(settings: Vec<Override>) -> Self {
        Self { settings, from: None, joints: Vec::new(), pushes: Vec::new() }
    }

    /// The force by hand that acts in the step after `tick`.
    fn push_at(&self, tick: u64) -> Option<ExternalForce<f64>> {
        self.pushes.iter().rev().find(|(from, _)| *from <= tick).and_then(|(_, push)| *push)
    }

    /// Changes at its beginning, in words; `before` is the segment before.
    fn words(&self, before: Option<&Self>) -> Vec<String> {
        let known = before.map_or(&[][..], |before| &before.settings);
        let new = self.settings.iter().filter(|set| {
            !known.iter().any(|old| (&old.path.value, &old.value.value) == (&set.path.value, &set.value.value))
        });
        let mut words: Vec<String> = Vec::new();
        if before.is_some() {
            words.extend(new.map(|set| format!("{} = {} from here on", set.path.value, set.value.value)));
        }
        words.extend(self.joints.iter().map(|(k, value)| format!("coordinate {k} was placed at {value}, all at rest")));
        words
    }
}

impl KeptRun {
    /// Settings of its last part.
    ///
    /// # Panics
    ///
    /// If it has no part.
    #[must_use]
    pub fn settings(&self) -> &[Override] {
        &self.segments.last().expect("a run has a part").settings
    }

    /// Returns true if the files and settings alone give this run: it was not branched, and nothing was pulled by hand.
    #[must_use]
    pub fn is_from_files(&self) -> bool {
        matches!(&self.segments[..], [only] if only.pushes.is_empty())
    }

    /// Computes the run again, part after part, and records it from its start, with rows in the file `csv`. Returns the
    /// scene as it was in the last part, and the run; its messages tell what was done when.
    ///
    /// # Errors
    ///
    /// A sentence: the scene does not load any more, its settings changed the base step, or the file cannot be written.
    pub fn replay(&self, folder: &Path, extensions: Extensions, csv: &Path) -> Result<(Loaded, Simulated), String> {
        let loaded = self.load(folder, extensions)?;
        let last = loaded.last().expect("a run has a part");
        let options = RunOptions { csv: Some(csv), keyframes: true, ..RunOptions::default() };
        let mut run: Option<(LockStep, Recording)> = None;
        let mut messages = Vec::new();
        let mut status = Status::Completed;
        for (k, (segment, loaded)) in self.segments.iter().zip(&loaded).enumerate() {
            let (method, _) = method_for(loaded);
            let mut lockstep = LockStep::new(loaded, method, false);
            let (mut recording, started) = match run.take() {
                None => {
                    // the hash begins before the diagram is evaluated
                    let mut new = Recording::new(last, &mut lockstep, options).map_err(|error| error.to_string())?;
                    let started = lockstep.start();
                    new.start(&mut lockstep).map_err(|error| error.to_string())?;
                    (new, started)
                }
                Some((mut before, mut recording)) => {
                    let snapshot = before.snapshot(recording.trace());
                    // as the live run does: evaluated once as the files say, then where it goes on
                    let _ = lockstep.start();
                    go_on(&mut lockstep, &snapshot, &segment.joints)?;
                    let started = lockstep.start();
                    recording.resume(&mut before, &mut lockstep);
                    (recording, started)
                }
            };
            let say = |t: f64, text: String| Message { t, object: "viewer".to_owned(), text };
            let before = k.checked_sub(1).map(|k| &self.segments[k]);
            messages.extend(segment.words(before).into_iter().map(|text| say(lockstep.t(), text)));
            let end = self.segments.get(k + 1).and_then(|next| next.from).unwrap_or(self.end);
            let mut halted = started.err();
            while halted.is_none() && lockstep.tick() < end {
                let (tick, t) = (lockstep.tick(), lockstep.t());
                if let Some((_, push)) = segment.pushes.iter().rev().find(|(from, _)| *from == tick) {
                    messages.push(say(t, push_words(loaded, push.as_ref())));
                }
                halted = advance(&mut lockstep, segment.push_at(tick)).err();
                if halted.as_ref().is_none_or(sincro_sim::run::Halt::is_after_step) {
                    recording.tick(&mut lockstep, halted.is_some()).map_err(|error| error.to_string())?;
                }
            }
            if let Some(halt) = halted {
                status = halt.explain(&mut lockstep, &last.experiment);
            }
            run = Some((lockstep, recording));
        }
        let (mut lockstep, recording) = run.expect("a run has a part");
        let (method, warnings) = method_for(last);
        let mut simulated =
            recording.finish(&mut lockstep, status, method, warnings).map_err(|error| error.to_string())?;
        simulated.messages.extend(messages);
        simulated.messages.sort_by(|a, b| a.t.total_cmp(&b.t));
        Ok((loaded.into_iter().last().expect("a run has a part"), simulated))
    }

    /// The scene of each part; that of the last ends where the run does.
    fn load(&self, folder: &Path, extensions: Extensions) -> Result<Vec<Loaded>, String> {
        let mut all = Vec::with_capacity(self.segments.len());
        for (k, segment) in self.segments.iter().enumerate() {
            let mut settings = segment.settings.clone();
            if let Some(duration) = self.duration.filter(|_| k + 1 == self.segments.len()) {
                settings.push(Override::new("duration", &duration.to_string()));
            }
            all.push(load_without_variants(folder, &settings, extensions).map_err(|found| found.to_string())?);
        }
        let steps = |loaded: &Loaded| loaded.experiment.step.to_bits();
        match all.iter().all(|loaded| steps(loaded) == steps(&all[0])) {
            true => Ok(all),
            false => Err("the base step was changed on the way: run it from 0 s to save it as a result".to_owned()),
        }
    }
}

/// A force by hand in words.
fn push_words(loaded: &Loaded, push: Option<&ExternalForce<f64>>) -> String {
    let Some(push) = push else { return "let go".to_owned() };
    let names = loaded.scene.model.names();
    let name = names.frames.iter().find(|frame| frame.link == Some(push.link)).map_or("/", |frame| &frame.name);
    let [x, y, z] = push.force.0;
    format!("pulled by hand at {name} with ({x:.4}, {y:.4}, {z:.4}) N")
}

/// Makes a run go on from a state of another run, with `joints` placed and everything at rest if there are any.
///
/// # Errors
///
/// A sentence: the state is one of another scene, or has no such coordinate.
pub(super) fn go_on(lockstep: &mut LockStep, snapshot: &Snapshot, joints: &[(usize, f64)]) -> Result<(), String> {
    let own = lockstep.snapshot(snapshot.trace);
    let lengths = |s: &Snapshot| {
        let (state, diagram) = (&s.state, s.diagram.as_ref());
        let of_state = [&state.q, &state.v, &state.commands, &state.drives, &state.totals].map(Vec::len);
        (of_state, diagram.map(|d| [d.signals.len(), d.continuous.len(), d.memory.len()]))
    };
    if lengths(&own) != lengths(snapshot) {
        return Err("this change alters what the scene consists of: run it from 0 s".into());
    }
    if let Some((index, _)) = joints.iter().find(|(index, _)| *index >= snapshot.state.q.len()) {
        return Err(format!("there is no coordinate {index}"));
    }
    lockstep.restore(snapshot);
    if !joints.is_empty() {
        let mut state = lockstep.state().clone();
        joints.iter().for_each(|(index, value)| state.q[*index] = *value);
        lockstep.set_state(state, &[]);
        lockstep.stop();
    }
    Ok(())
}

/// One base step, with a force by hand.
pub(super) fn advance(lockstep: &mut LockStep, push: Option<ExternalForce<f64>>) -> Result<(), sincro_sim::run::Halt> {
    if let Some(push) = push {
        lockstep.world().apply_external_force(push);
    }
    let advanced = lockstep.advance();
    lockstep.world().clear_external_forces();
    advanced
}

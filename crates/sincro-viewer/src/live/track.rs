//! One run of the engine: the world, what is recorded of it, and a snapshot at each frame so that others can start
//! there.

use sincro_dynamics::actuation::ExternalForce;
use sincro_dynamics::spatial::Vec3;
use sincro_scene::diagnostic::{Diagnostics, Located};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::overrides::Override;
use sincro_scene::record::{Recorder, catalogue};
use sincro_sim::Loaded;
use sincro_sim::replay::{Contacts, FrameMap, Layout, RuntimeEvent, RuntimeLog, SceneView, Trajectory};
use sincro_sim::run::{Followed, LockStep, method_for};
use sincro_sim::snapshot::Snapshot;
use sincro_sim::trace::Trace;

use super::history::{KeptRun, Segment, advance, go_on};
use super::thinned::Thinned;
use crate::replay::stop_words;

/// Signals beyond which the catalogue is not offered whole: what is recorded and the diagram's remain.
const MAX_SIGNALS: usize = 400;

/// Bytes that the recorded signals of a run may take: a long run with many of them is looked at less often.
const MAX_ROW_BYTES: u64 = 256 << 20;

/// A run under way.
pub(super) struct Track {
    pub loaded: Loaded,
    pub lockstep: LockStep,
    pub trace: Trace,
    pub view: SceneView,
    pub layout: Layout,
    /// Names and units of what is recorded, `t` left out.
    pub columns: Vec<(String, String)>,
    /// Reason for which it cannot go on; empty if it can.
    pub stop: String,
    recorder: Recorder,
    every: u64,
    /// States at the frames.
    snapshots: Thinned<Snapshot>,
    push: Option<ExternalForce<f64>>,
    /// Objects that scripts have made.
    runtime: RuntimeLog,
    /// Changes of the structure that have been followed.
    followed: Followed,
    /// Places of what the frames hold, if the structure has changed.
    frame_map: Option<FrameMap>,
    /// Parts of the runs that it was branched from, in the order of time.
    before: Vec<Segment>,
    /// Its own part.
    segment: Segment,
}

/// Content that a frame adds to the live state.
pub(super) struct Taken {
    pub t: f64,
    pub row: Vec<f64>,
    pub frame: Vec<f32>,
    pub contacts: Contacts,
    pub runtime: Vec<RuntimeEvent>,
}

impl Track {
    /// From the start.
    pub fn new(loaded: Loaded, settings: Vec<Override>) -> Result<Self, Diagnostics> {
        let (method, _) = method_for(&loaded);
        let lockstep = LockStep::new(&loaded, method, false);
        let (recorder, columns) = recorder(&loaded)?;
        let model = &loaded.scene.model;
        let trajectory = Trajectory::new(model, &loaded.experiment);
        let row_bytes = 8 * columns.len() as u64 * loaded.experiment.n_steps;
        let every = trajectory.every.max(row_bytes.div_ceil(MAX_ROW_BYTES));
        let (view, layout, runtime) = (SceneView::new(&loaded.scene), trajectory.layout, trajectory.runtime);
        let trace = lockstep.trace();
        let mut new = Self {
            lockstep,
            trace,
            view,
            layout,
            columns,
            stop: String::new(),
            recorder,
            every,
            snapshots: Thinned::new(usize::MAX),
            push: None,
            runtime,
            followed: Followed::default(),
            frame_map: None,
            before: Vec::new(),
            segment: Segment::new(settings),
            loaded,
        };
        new.record();
        Ok(new)
    }

    /// From the state `snapshot` of another run. `joints` are put elsewhere, everything at rest.
    pub fn from(mut self, other: &Self, snapshot: &Snapshot, joints: &[(usize, f64)]) -> Result<Self, String> {
        go_on(&mut self.lockstep, snapshot, joints)?;
        let tick = snapshot.state.tick;
        self.before = other.before.clone();
        self.before.push(other.segment.clone());
        self.before.iter_mut().for_each(|segment| segment.pushes.retain(|(from, _)| *from < tick));
        (self.segment.from, self.segment.joints) = (Some(tick), joints.to_vec());
        self.trace = snapshot.trace;
        self.stop.clear();
        self.record();
        Ok(self)
    }

    /// Overrides of the scene's files.
    pub fn settings(&self) -> &[Override] {
        &self.segment.settings
    }

    /// Evaluates the diagram at the present state.
    fn record(&mut self) {
        if let Err(halt) = self.lockstep.start() {
            self.stop = stop_words(&halt.explain(&mut self.lockstep, &self.loaded.experiment));
        }
    }

    /// Returns the history from which this run can be computed again.
    ///
    /// # Errors
    ///
    /// A sentence: there is nothing yet.
    pub fn kept(&self) -> Result<KeptRun, String> {
        let (end, experiment) = (self.lockstep.tick(), &self.loaded.experiment);
        if end == 0 {
            return Err("nothing has been simulated yet: let it run first".into());
        }
        let duration = (end < experiment.n_steps && self.stop.is_empty()).then_some(end as f64 * experiment.step);
        let mut segments = self.before.clone();
        segments.push(self.segment.clone());
        segments.iter_mut().for_each(|segment| segment.pushes.retain(|(from, _)| *from < end));
        Ok(KeptRun { segments, end, duration, trace: self.trace.to_string() })
    }

    pub fn is_done(&self) -> bool {
        !self.stop.is_empty() || self.lockstep.tick() >= self.loaded.experiment.n_steps
    }

    /// One base step; whether a frame is due then.
    pub fn advance(&mut self) -> bool {
        let advanced = advance(&mut self.lockstep, self.push);
        let is_world_halt = matches!(advanced, Err(sincro_sim::run::Halt::World { .. }));
        if !is_world_halt {
            self.lockstep.hash_into(&mut self.trace);
        }
        if let Err(halt) = advanced {
            self.stop = stop_words(&halt.explain(&mut self.lockstep, &self.loaded.experiment));
        }
        !is_world_halt && (self.lockstep.tick().is_multiple_of(self.every) || self.is_done())
    }

    /// Everything that viewers see of the present state.
    pub fn take(&mut self, is_start: bool) -> Taken {
        let t = self.lockstep.t();
        let snapshot = self.lockstep.snapshot(self.trace);
        self.snapshots.push(snapshot);
        let mut frame = Vec::with_capacity(self.layout.width());
        self.follow();
        let (seen, signals) = self.lockstep.observe(t);
        let row = self.recorder.row(&seen, signals, t, is_start)[1..].to_vec();
        match &self.frame_map {
            Some(map) => self.layout.write_mapped(map, &seen, t, &mut frame),
            None => self.layout.write(&seen, t, &mut frame),
        }
        let mut contacts = Contacts::default();
        contacts.record(&seen, self.frame_map.as_ref());
        let poses = self.frame_map.as_ref().map(|_| seen.scratch().link_poses().to_vec());
        let lockstep = &self.lockstep;
        self.runtime.update(t, poses.as_deref(), |visit| lockstep.visit_runtime_objects(visit));
        Taken { t, row, frame, contacts, runtime: std::mem::take(&mut self.runtime.events) }
    }

    /// Goes on with the structure of the lock-step, if that has changed: frames and columns are those of the start.
    fn follow(&mut self) {
        if self.lockstep.bring_up(&mut self.recorder, &mut self.followed) {
            self.frame_map = Some(FrameMap::new(&self.layout, &self.loaded.scene, self.lockstep.scene()));
            // what was seized may be another link now
            self.push = None;
        }
    }

    /// Bounds the memory of the snapshots.
    pub fn keep_snapshots(&mut self, most_bytes: usize) {
        let one = snapshot_bytes(&self.lockstep.snapshot(self.trace));
        self.snapshots.set_most(most_bytes / one);
    }

    /// The last state that was kept up to `t` `[s]`; none before the first.
    pub fn snapshot_at(&self, t: f64) -> Option<&Snapshot> {
        let step = self.loaded.experiment.step;
        self.snapshots.last_before(|s| s.state.tick as f64 * step <= t + 1e-9 * step.max(t))
    }

    /// Seizes an object at a point of the world, which then goes with it; the force keeps its direction in the world.
    pub fn set_push(&mut self, push: Option<(usize, [f64; 3], [f64; 3])>) -> Result<(), String> {
        let tick = self.lockstep.tick();
        let Some((object, point, force)) = push else {
            if self.push.take().is_some() {
                self.segment.pushes.push((tick, None));
            }
            return Ok(());
        };
        let found = self.view.objects.get(object).ok_or_else(|| format!("there is no object {object}"))?;
        let Some(mover) = found.mover else {
            return Err(format!("`{}` is fixed in the world: no force moves it", found.path));
        };
        let t = self.lockstep.t();
        let link = match &self.frame_map {
            Some(map) => map.link(mover).ok_or_else(|| format!("`{}` has gone, or is fixed", found.path))?,
            None => self.layout.links()[mover],
        };
        let x_wl = self.lockstep.observe(t).0.scratch().link_poses()[link];
        let point = x_wl.inverse().point(Vec3(point));
        self.push = Some(ExternalForce { link, point, force: Vec3(force), torque: Vec3([0.0; 3]) });
        // of several within a step the last acts
        self.segment.pushes.retain(|(from, _)| *from < tick);
        self.segment.pushes.push((tick, self.push));
        Ok(())
    }
}

/// About how much memory a snapshot takes.
fn snapshot_bytes(snapshot: &Snapshot) -> usize {
    let diagram = snapshot.diagram.as_ref().map_or(0, |d| d.signals.len() + d.continuous.len() + d.memory.len());
    size_of::<Snapshot>() + snapshot.state.heap_bytes() + 8 * (snapshot.sensors.len() + diagram)
}

/// Everything that can be looked at, as far as it is not too much.
fn recorder(loaded: &Loaded) -> Result<(Recorder, Vec<(String, String)>), Diagnostics> {
    let (experiment, model) = (&loaded.experiment, &loaded.scene.model);
    let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
    let all = catalogue(model);
    let mut names: Vec<String> = experiment.record.iter().map(|r| r.value.clone()).collect();
    let offered = entries.iter().chain(all.iter().filter(|_| all.len() <= MAX_SIGNALS));
    for entry in offered {
        if !names.contains(&entry.name) {
            names.push(entry.name.clone());
        }
    }
    let at = experiment.record[0].at.clone();
    let located: Vec<Located<String>> = names.into_iter().map(|value| Located { value, at: at.clone() }).collect();
    let recorder = Recorder::new(&located, model, &entries)?.with_units(&experiment.units);
    let columns = recorder.columns().skip(1).map(|(name, unit)| (name.to_owned(), unit.to_owned())).collect();
    Ok((recorder, columns))
}

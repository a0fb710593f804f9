//! Replay: everything that the page shows of finished runs, as one JSON text.
//!
//! `replay.json` of a run's folder, the data in `report.html` and what `sincro view RUN` sends are the same text.
//! Numbers are little-endian bytes in base 64: frames in single precision ([`Trajectory`]), signals in double
//! precision. A replay that goes into a page is thinned to a size; what was left out is said (`every`), and
//! `signals.csv` has it.

use std::collections::BTreeMap;

use serde::Serialize;
use sincro_sim::Loaded;
use sincro_sim::campaign::{Campaign, CompletedRun};
use sincro_sim::check::Outcome;
use sincro_sim::replay::{
    CONTACT, Property, RuntimeChange, RuntimeEvent, RuntimeLog, SceneView, Trajectory, properties,
};
use sincro_sim::results::Status;
use sincro_sim::table::Table;

use crate::encoding;

/// Identifier of the format of `replay.json`; replays with another one are refused.
pub const FORMAT: &str = "sincro-film-2";

/// Bytes that the frames of all runs in a replay may have, before base 64.
const MAX_FRAME_BYTES: usize = 450_000;
/// Bytes that the signals of all runs in a replay may have, before base 64.
const MAX_SIGNAL_BYTES: usize = 450_000;
/// Numbers that the items of all drawings in a replay may have.
const MAX_DRAWN_NUMBERS: usize = 90_000;

/// Replay of finished runs: scene, frames and signals, as the page of the viewer reads them. [`Replay::of_campaign`]
/// makes it.
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    /// Identifier of the format, [`FORMAT`].
    pub format: &'static str,
    /// Title of the experiment.
    pub title: String,
    /// Description under the title.
    pub description: String,
    /// Name of the scene's folder.
    pub scene: String,
    /// Base step `[s]`.
    pub step: f64,
    /// Simulated time that the experiment asks for `[s]`.
    pub duration: f64,
    /// Scenes of the runs (objects and their shapes), each once.
    pub views: Vec<SceneView>,
    /// Numbers of the scene's files, with path and unit.
    pub properties: Vec<Property>,
    /// Titles and signals of the experiment's plots.
    pub plots: Vec<(String, Vec<String>)>,
    /// Names of the signals that the experiment records, in its order.
    pub record: Vec<String>,
    /// The diagram's drawing as SVG, if there is one.
    pub diagram: Option<String>,
    /// The runs, the main one first.
    pub runs: Vec<ReplayRun>,
}

/// Run of a [`Replay`].
#[derive(Clone, Debug, Serialize)]
pub struct ReplayRun {
    /// `main`, or the variant's name.
    pub name: String,
    /// Description of the variant; empty for the main run.
    pub about: String,
    /// Index of its scene in [`Replay::views`].
    pub view: usize,
    /// Reason for an early end; empty if there was none.
    pub stop: String,
    /// Trace hash of the run (hexadecimal).
    pub trace: String,
    /// Positions of everything that moves, at the times of the frames.
    pub frames: Frames,
    /// Recorded signals.
    pub signals: Signals,
    /// Changes of objects that clients and scripts have made, in the order of time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub runtime: Vec<RuntimeEvent>,
}

/// Frames of a [`ReplayRun`]. Lists of numbers are little-endian bytes in base 64, of 64 bits (doubles) or 32 bits
/// (singles).
#[derive(Clone, Debug, Default, Serialize)]
pub struct Frames {
    /// Number of numbers in a frame.
    pub width: usize,
    /// Times of the frames `[s]`, ascending: doubles.
    pub times: String,
    /// Frames, one after the other, each as in a [`Trajectory`]: singles.
    pub numbers: String,
    /// Number of points of contact of each frame: singles; empty if nothing ever touches.
    pub counts: String,
    /// Points of contact of all frames, [`CONTACT`] singles each: two surfaces, point `[m]`, force `[N]`, world axes.
    pub contacts: String,
}

/// Recorded signals of a [`ReplayRun`], thinned to a size. Lists of numbers are little-endian doubles in base 64.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Signals {
    /// Stride: every how many rows of `signals.csv` one is here; the last row always is.
    pub every: usize,
    /// Name, unit and error bar (in that unit) of each column, the time left out.
    pub columns: Vec<(String, String, Option<f64>)>,
    /// Times of the rows `[s]`.
    pub times: String,
    /// Values of the columns, one column after the other, in their order and units.
    pub numbers: String,
    /// Expected values of checks: name of the signal, times `[s]`, values in its unit.
    pub references: Vec<(String, String, String)>,
}

impl Replay {
    /// Creates the replay of the main run and the variants of an experiment, in this order; `diagram` is the drawing of
    /// its block diagram as SVG.
    #[must_use]
    pub fn of_campaign(loaded: &Loaded, campaign: &Campaign, diagram: Option<String>) -> Self {
        let variants = campaign.variants.iter().map(|(v, done)| (v.name.as_str(), v.description.as_str(), done));
        let all: Vec<(&str, &str, &CompletedRun)> =
            std::iter::once(("main", "", &campaign.main)).chain(variants).collect();
        let share = 1.0 / all.len() as f64;
        let mut views = Vec::new();
        let runs = all.iter().map(|(name, about, done)| replay_run(name, about, done, share, &mut views)).collect();
        Self {
            format: FORMAT,
            title: loaded.experiment.title.clone(),
            description: loaded.experiment.description.clone(),
            scene: campaign.report.scene.clone(),
            step: loaded.experiment.step,
            duration: loaded.experiment.duration,
            views,
            properties: properties(loaded, &[]),
            plots: plots(loaded),
            record: record(loaded),
            diagram,
            runs,
        }
    }

    /// Text of the replay in JSON, the content of `replay.json`.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("plain data has a JSON form")
    }
}

/// Titles and signals of the experiment's plots.
pub(crate) fn plots(loaded: &Loaded) -> Vec<(String, Vec<String>)> {
    let names = |p: &sincro_scene::experiment::Plot| p.signals.iter().map(|s| s.value.clone()).collect();
    loaded.experiment.plots.iter().map(|p| (p.title.clone(), names(p))).collect()
}

/// Signals that the experiment records.
pub(crate) fn record(loaded: &Loaded) -> Vec<String> {
    loaded.experiment.record.iter().map(|name| name.value.clone()).collect()
}

fn replay_run(name: &str, about: &str, done: &CompletedRun, share: f64, views: &mut Vec<SceneView>) -> ReplayRun {
    let view = match views.iter().position(|known| *known == done.view) {
        Some(k) => k,
        None => {
            views.push(done.view.clone());
            views.len() - 1
        }
    };
    let run = &done.simulated;
    let of_frames = (share * MAX_FRAME_BYTES as f64) as usize;
    let of_signals = (share * MAX_SIGNAL_BYTES as f64) as usize;
    let of_drawings = (share * MAX_DRAWN_NUMBERS as f64) as usize;
    let bars = done.columns.iter().skip(1).map(|c| c.error_bar).collect::<Vec<_>>();
    ReplayRun {
        name: name.to_owned(),
        about: about.to_owned(),
        view,
        stop: stop_words(&run.status),
        trace: run.trace.to_string(),
        frames: run.trajectory.as_ref().map(|trajectory| frames(trajectory, of_frames)).unwrap_or_default(),
        signals: signals(&run.table, &bars, &done.outcomes, of_signals),
        runtime: run
            .trajectory
            .as_ref()
            .map(|trajectory| runtime(trajectory, of_frames, of_drawings))
            .unwrap_or_default(),
    }
}

/// Reason for the early end of a run; empty if there was none.
pub(crate) fn stop_words(status: &Status) -> String {
    match status {
        Status::Completed => String::new(),
        Status::Ended { time, reason, .. } => format!("ended at t = {} s: {reason}", seconds(*time)),
        Status::Stopped { time, reason, .. } => format!("stopped at t = {} s: {reason}", seconds(*time)),
        Status::Interrupted { time, .. } => format!("interrupted at t = {} s", seconds(*time)),
    }
}

/// To the nanosecond: 14.2, not 14.200000000000001.
fn seconds(t: f64) -> f64 {
    (1e9 * t).round() / 1e9
}

/// Indices of what is kept of `n`, every so many, the last one always.
fn thinned(n: usize, every: usize) -> impl Iterator<Item = usize> + Clone {
    (0..n).filter(move |k| k.is_multiple_of(every) || k + 1 == n)
}

/// Number of points of contact in all frames.
fn n_points(trajectory: &Trajectory) -> usize {
    (0..trajectory.n_frames()).map(|k| trajectory.contacts.count(k)).sum()
}

/// Keyframes that a trajectory keeps in at most so many bytes.
fn kept(trajectory: &Trajectory, most_bytes: usize) -> impl Iterator<Item = usize> + Clone {
    let bytes = trajectory.n_frames() * (8 + 4 * trajectory.layout.width()) + 4 * CONTACT * n_points(trajectory);
    thinned(trajectory.n_frames(), bytes.div_ceil(most_bytes.max(1)).max(1))
}

/// Changes of objects that were made at run time: between two frames that are kept, where an object moves
/// several times, its last place. Drawings have their first `most_numbers` numbers.
fn runtime(trajectory: &Trajectory, most_bytes: usize, most_numbers: usize) -> Vec<RuntimeEvent> {
    let RuntimeLog { events, .. } = &trajectory.runtime;
    let times: Vec<f64> = kept(trajectory, most_bytes).map(|k| trajectory.times[k]).collect();
    let frame = |event: &RuntimeEvent| times.partition_point(|t| *t < event.t);
    let mut last_moves: BTreeMap<(u64, usize), usize> = BTreeMap::new();
    for (k, event) in events.iter().enumerate() {
        if matches!(event.change, RuntimeChange::Move(..)) {
            last_moves.insert((event.id, frame(event)), k);
        }
    }
    let mut n_numbers = 0;
    let stays = |(k, event): &(usize, &RuntimeEvent)| match &event.change {
        RuntimeChange::Move(..) => last_moves[&(event.id, frame(event))] == *k,
        RuntimeChange::Items(_, numbers) => {
            n_numbers += numbers.len();
            n_numbers <= most_numbers
        }
        RuntimeChange::Put(_) | RuntimeChange::Clear(()) | RuntimeChange::Gone(()) => true,
    };
    events.iter().enumerate().filter(stays).map(|(_, event)| event.clone()).collect()
}

/// Keyframes of a trajectory in at most so many bytes.
pub(crate) fn frames(trajectory: &Trajectory, most_bytes: usize) -> Frames {
    let (points, kept) = (n_points(trajectory), kept(trajectory, most_bytes));
    let counts = kept.clone().filter(|_| points > 0).map(|k| trajectory.contacts.count(k) as f32);
    Frames {
        counts: encoding::singles(&counts.collect::<Vec<_>>()),
        contacts: encoding::singles(kept.clone().flat_map(|k| trajectory.contacts.frame(k))),
        width: trajectory.layout.width(),
        times: encoding::doubles(kept.clone().map(|k| trajectory.times[k])),
        numbers: encoding::singles(kept.flat_map(|k| trajectory.frame(k))),
    }
}

/// A table and what the checks expect of it, in about so many bytes.
pub(crate) fn signals(table: &Table, bars: &[Option<f64>], outcomes: &[Outcome], most_bytes: usize) -> Signals {
    let series = outcomes.iter().filter_map(|o| Some((o.signal.as_deref()?, o.series.as_ref()?)));
    let mut expected: Vec<(&str, &sincro_sim::check::Series)> = Vec::new();
    for (signal, series) in series {
        match expected.iter_mut().find(|(known, _)| *known == signal) {
            Some((_, known)) if known.times.len() < series.times.len() => *known = series,
            Some(_) => {}
            None => expected.push((signal, series)),
        }
    }
    let n_expected: usize = expected.iter().map(|(_, s)| 2 * s.times.len()).sum();
    let bytes = 8 * (table.n_rows() * table.columns.len() + n_expected);
    let every = bytes.div_ceil(most_bytes.max(1)).max(1);
    let kept = thinned(table.n_rows(), every);
    let column = |k: usize| table.columns[k].values.as_slice();
    Signals {
        every,
        columns: (1..table.columns.len())
            .map(|k| {
                let c = &table.columns[k];
                (c.name.clone(), c.unit.clone(), bars.get(k - 1).copied().flatten())
            })
            .collect(),
        times: encoding::doubles(kept.clone().map(|row| column(0)[row])),
        numbers: encoding::doubles((1..table.columns.len()).flat_map(|k| kept.clone().map(move |row| column(k)[row]))),
        references: expected
            .into_iter()
            .map(|(signal, s)| {
                let kept = thinned(s.times.len(), every);
                let times = encoding::doubles(kept.clone().map(|k| s.times[k]));
                (signal.to_owned(), times, encoding::doubles(kept.map(|k| s.values[k])))
            })
            .collect(),
    }
}

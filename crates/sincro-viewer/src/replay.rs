//! Replay: everything that the page shows of finished runs, as one JSON text.
//!
//! `replay.json` of a run's folder, the data in `report.html` and what `sincro view RUN` sends are the same text.
//! Numbers are little-endian bytes in base 64: frames in single precision ([`Trajectory`]), signals in double
//! precision. A replay that goes into a page is thinned to a size; what was left out is said (`every`), and
//! `signals.csv` has it.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use sincro_sim::Loaded;
use sincro_sim::campaign::{Campaign, CompletedRun};
use sincro_sim::check::Outcome;
use sincro_sim::replay::{CONTACT, Property, RuntimeChange, RuntimeEvent, SceneView, Trajectory, properties};
use sincro_sim::results::Status;
use sincro_sim::table::Table;

use crate::encoding;

/// Identifier of the format of `replay.json`; replays with another one are refused.
pub const FORMAT: &str = "sincro-film-2";

/// Bytes that the frames of all runs in a replay may have, before base 64.
const MAX_FRAME_BYTES: usize = 450_000;
/// Bytes that the signals of all runs in a replay may have, before base 64.
const MAX_SIGNAL_BYTES: usize = 450_000;
/// Numbers that all objects of a replay may have that were made at run time, and their changes.
const MAX_RUNTIME_NUMBERS: usize = 150_000;

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
    /// True if some of them are left out, because there was no room.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub runtime_is_cut: bool,
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
    let of_runtime = (share * MAX_RUNTIME_NUMBERS as f64) as usize;
    let bars = done.columns.iter().skip(1).map(|c| c.error_bar).collect::<Vec<_>>();
    let (runtime, runtime_is_cut) = run.trajectory.as_ref().map_or_else(Default::default, |trajectory| {
        let times: Vec<f64> = kept(trajectory, of_frames).map(|k| trajectory.times[k]).collect();
        let (events, is_cut) = runtime(&trajectory.runtime.events, &times, of_runtime);
        (events, is_cut || trajectory.runtime.is_cut)
    });
    ReplayRun {
        name: name.to_owned(),
        about: about.to_owned(),
        view,
        stop: stop_words(&run.status),
        trace: run.trace.to_string(),
        frames: run.trajectory.as_ref().map(|trajectory| frames(trajectory, of_frames)).unwrap_or_default(),
        signals: signals(&run.table, &bars, &done.outcomes, of_signals),
        runtime,
        runtime_is_cut,
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

/// Changes of objects that were made at run time in about `most_numbers` numbers, and whether some are left out. Of
/// places that an object takes between two frames of the replay the last one stays, or between more of them where
/// objects move much; of the items of a drawing those that are still there. An object whose changes have no room stays
/// as it is until it goes.
fn runtime(events: &[RuntimeEvent], times: &[f64], most_numbers: usize) -> (Vec<RuntimeEvent>, bool) {
    let frames: Vec<usize> = events.iter().map(|event| times.partition_point(|t| *t < event.t)).collect();
    // of each object and interval its last place
    let places = |stride: usize| {
        let moves = events.iter().enumerate().filter(|(_, event)| matches!(event.change, RuntimeChange::Move(..)));
        moves.map(|(k, event)| ((event.id, frames[k].div_ceil(stride)), k)).collect::<BTreeMap<_, _>>()
    };
    let mut stride = 1;
    let mut last_places = places(stride);
    while last_places.len() * 32 > most_numbers && stride < times.len() {
        stride *= 2;
        last_places = places(stride);
    }
    // of each drawing and interval the last time that it was emptied
    let clears = events.iter().enumerate().filter(|(_, event)| event.change == RuntimeChange::Clear(()));
    let last_clears: BTreeMap<(u64, usize), usize> = clears.map(|(k, event)| ((event.id, frames[k]), k)).collect();
    let (mut n_numbers, mut cut) = (0, BTreeSet::new());
    let mut stays = |(k, event): &(usize, &RuntimeEvent)| {
        let is_outdated = match &event.change {
            RuntimeChange::Move(..) => last_places[&(event.id, frames[*k].div_ceil(stride))] != *k,
            RuntimeChange::Items(..) | RuntimeChange::Clear(()) => {
                last_clears.get(&(event.id, frames[*k])).is_some_and(|last| k < last)
            }
            RuntimeChange::Put(_) => false,
            RuntimeChange::Gone(()) => return true,
        };
        if is_outdated || cut.contains(&event.id) {
            return false;
        }
        n_numbers += event.change.size();
        if n_numbers > most_numbers {
            n_numbers -= event.change.size();
            cut.insert(event.id);
            return false;
        }
        true
    };
    let all: Vec<RuntimeEvent> =
        events.iter().enumerate().filter(|event| stays(event)).map(|(_, event)| event.clone()).collect();
    (all, !cut.is_empty())
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

#[cfg(test)]
mod tests {
    use super::*;

    fn event(t: f64, id: u64, change: RuntimeChange) -> RuntimeEvent {
        RuntimeEvent { t, id, change }
    }

    fn moved(t: f64, id: u64) -> RuntimeEvent {
        event(t, id, RuntimeChange::Move(None, [t, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    }

    fn drawn(t: f64, id: u64, n: usize) -> RuntimeEvent {
        event(t, id, RuntimeChange::Items(0, vec![t as f32; n]))
    }

    #[test]
    fn between_two_frames_the_last_place_stays() {
        let events: Vec<RuntimeEvent> = (0..=40).map(|k| moved(0.25 * f64::from(k), 1)).collect();
        let times: Vec<f64> = (0..=10).map(f64::from).collect();
        let (kept, is_cut) = runtime(&events, &times, 100_000);
        assert_eq!(kept.iter().map(|e| e.t).collect::<Vec<_>>(), times);
        assert!(!is_cut);
        // with less room at every second, fourth … frame, the last one always
        let (kept, is_cut) = runtime(&events, &times, 150);
        assert_eq!(kept.iter().map(|e| e.t).collect::<Vec<_>>(), [0.0, 4.0, 8.0, 10.0]);
        assert!(!is_cut);
    }

    #[test]
    fn a_drawing_that_is_made_anew_has_its_last_items_in_each_interval_only() {
        let anew = |t: f64| [event(t, 1, RuntimeChange::Clear(())), drawn(t, 1, 30)];
        let events: Vec<RuntimeEvent> = (0..40).flat_map(|k| anew(0.25 * f64::from(k))).collect();
        let times: Vec<f64> = (0..=10).map(f64::from).collect();
        let (kept, is_cut) = runtime(&events, &times, 100_000);
        let whole: Vec<f64> = (0..10).map(f64::from).chain([9.75]).flat_map(|t| [t, t]).collect();
        assert_eq!((kept.iter().map(|e| e.t).collect::<Vec<_>>(), is_cut), (whole, false));
    }

    #[test]
    fn what_has_no_room_stays_as_it_is_until_it_goes() {
        let mut events: Vec<RuntimeEvent> = (0..10).map(|k| drawn(f64::from(k), 1, 300)).collect();
        events.insert(5, event(4.5, 1, RuntimeChange::Clear(())));
        events.push(event(10.0, 2, RuntimeChange::Clear(())));
        events.push(event(11.0, 1, RuntimeChange::Gone(())));
        let times: Vec<f64> = (0..=12).map(f64::from).collect();
        let (kept, is_cut) = runtime(&events, &times, 1000);
        let found: Vec<(f64, u64)> = kept.iter().map(|e| (e.t, e.id)).collect();
        // three lists of 308 fit; neither the clearing nor later items may follow, another object's change may
        assert_eq!(found, [(0.0, 1), (1.0, 1), (2.0, 1), (10.0, 2), (11.0, 1)]);
        assert!(is_cut);
    }
}

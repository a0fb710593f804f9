//! Comparison of two finished runs: the first and the greatest difference of each signal.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sincro_figures::plot::number::short;
use sincro_figures::report::{ComparisonPage, DifferenceRow, comparison_html};
use sincro_sim::file::FileError;
use sincro_sim::result_folder::find_result;
use sincro_sim::results::RunReport;
use sincro_sim::table::Table;

/// Times closer than this are the same instant `[s]`.
const SAME_INSTANT: f64 = 1e-9;

/// Results of a finished run, read back from its folder for a [`Comparison`].
#[derive(Clone, Debug)]
pub struct FinishedRun {
    /// Folder that holds the files.
    pub folder: PathBuf,
    /// Settings, hashes, checks and signals of the run: the content of `run.json`.
    pub report: RunReport,
    /// Recorded signals over time: the content of `signals.csv`.
    pub table: Table,
}

impl FinishedRun {
    /// Reads `run.json` and `signals.csv` of a folder of results, or of the latest one in a folder of numbered ones.
    ///
    /// # Errors
    ///
    /// A file is absent, cannot be read, or is not of its format; the error has its path.
    pub fn read(folder: &Path) -> Result<Self, FileError> {
        let folder = find_result(folder);
        let (report, table) = (RunReport::read(&folder)?, Table::read_csv(&folder.join("signals.csv"))?);
        Ok(Self { folder, report, table })
    }
}

/// Difference of one signal between two runs, at the rows that both have.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Path of the signal: `/shoulder.position`.
    pub name: String,
    /// Unit of the signal; may be empty.
    pub unit: String,
    /// First time `[s]` at which the bits differ, then the values of the first and of the second run, in `unit`;
    /// `None`: the bits are the same everywhere.
    pub first: Option<(f64, f64, f64)>,
    /// Greatest magnitude of the difference, in `unit`, and its time `[s]`. Infinite if only one value is not a number.
    pub greatest: (f64, f64),
}

/// Comparison of two finished runs at the rows that both have.
///
/// ```
/// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
/// # let out = std::env::temp_dir().join(format!("sincro-doc-compare-{}", std::process::id()));
/// # let loaded = sincro::load(&scene, &[])?;
/// # let request = sincro::RunRequest { scene: &scene, overrides: &[], loaded: &loaded, index: None };
/// # request.run(&out, &std::sync::atomic::AtomicBool::new(false), &mut |_, _| {})?;
/// use sincro::compare::{Comparison, FinishedRun};
///
/// let run = FinishedRun::read(&out)?;
/// assert!(Comparison::of(&run, &run).is_same());
/// # std::fs::remove_dir_all(&out)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Comparison<'a> {
    first: &'a FinishedRun,
    second: &'a FinishedRun,
    /// The signals that both runs recorded, in the order of the first.
    pub signals: Vec<Difference>,
    /// Settings, hashes and versions in which the runs differ: name, value in the first, value in the second.
    pub settings: Vec<(String, String, String)>,
}

impl<'a> Comparison<'a> {
    /// Compares two runs signal by signal, at rows of the same time.
    #[must_use]
    pub fn of(first: &'a FinishedRun, second: &'a FinishedRun) -> Self {
        let signals = compare(&first.table, &second.table, &first.report);
        Self { first, second, signals, settings: facts(first, second) }
    }

    /// Returns true if the runs have the same trace, the same rows and signals, and the same bits in all of them.
    #[must_use]
    pub fn is_same(&self) -> bool {
        is_same(self.first, self.second, &self.signals)
    }

    /// Result of the comparison in one sentence, without a full stop: where the runs part first, or that they are the
    /// same.
    #[must_use]
    pub fn verdict(&self) -> String {
        verdict(self.first, self.second, &self.signals)
    }

    /// HTML page with both replays over each other and a table of the signals. The replay is left out if a folder has
    /// none, or one of another version.
    #[must_use]
    pub fn html(&self) -> String {
        let row = |d: &Difference| DifferenceRow {
            path: d.name.clone(),
            unit: d.unit.clone(),
            first: d.first.map(|first| first.0),
            greatest: d.greatest.0,
            greatest_at: d.greatest.1,
        };
        let against = |(name, x, y): &(String, String, String)| (name.clone(), format!("{x} against {y}"));
        let (a, b) = (self.first, self.second);
        let replays = [a, b].map(|run| std::fs::read_to_string(run.folder.join("replay.json")).ok());
        comparison_html(&ComparisonPage {
            title: format!("{} against {}", a.report.title, b.report.title),
            verdict: self.verdict(),
            replay: overlay(&replays, [&a.folder, &b.folder])
                .map(|replay| sincro_viewer::embed::replay(&replay))
                .unwrap_or_default(),
            signals: self.signals.iter().map(row).collect(),
            settings: self.settings.iter().map(against).collect(),
        })
    }
}

fn is_same(a: &FinishedRun, b: &FinishedRun, found: &[Difference]) -> bool {
    let names = |run: &FinishedRun| run.table.columns.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    let is_whole = a.table.n_rows() == b.table.n_rows() && names(a) == names(b);
    a.report.trace_hash == b.report.trace_hash && is_whole && found.iter().all(|d| d.first.is_none())
}

/// The signals that both have, row by row at the same times.
fn compare(a: &Table, b: &Table, report: &RunReport) -> Vec<Difference> {
    let pairs = common_rows(a.times(), b.times());
    let mut found = Vec::new();
    for column in a.columns.iter().skip(1) {
        let Some(other) = b.column(&column.name) else { continue };
        let unit = report.columns.iter().find(|c| c.path == column.name).map_or(String::new(), |c| c.unit.clone());
        let mut difference = Difference { name: column.name.clone(), unit, first: None, greatest: (0.0, 0.0) };
        for &(i, k) in &pairs {
            let (x, y, t) = (column.values[i], other.values[k], a.times()[i]);
            if x.to_bits() != y.to_bits() && difference.first.is_none() {
                difference.first = Some((t, x, y));
            }
            // what is no number on one side only is beyond all differences
            let size = if x.is_nan() && y.is_nan() { 0.0 } else { (x - y).abs() };
            let size = if size.is_nan() { f64::INFINITY } else { size };
            if size > difference.greatest.0 {
                difference.greatest = (size, t);
            }
        }
        found.push(difference);
    }
    found
}

/// Rows of both at the same instants.
fn common_rows(a: &[f64], b: &[f64]) -> Vec<(usize, usize)> {
    let same = |(i, t): (usize, &f64)| {
        let k = b.partition_point(|x| *x < t - SAME_INSTANT);
        b.get(k).is_some_and(|x| (x - t).abs() <= SAME_INSTANT).then_some((i, k))
    };
    a.iter().enumerate().filter_map(same).collect()
}

/// The first of all differences: by time, then in the order of the columns.
fn earliest(found: &[Difference]) -> Option<(&Difference, (f64, f64, f64))> {
    let with = found.iter().filter_map(|d| d.first.map(|first| (d, first)));
    with.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0))
}

fn verdict(a: &FinishedRun, b: &FinishedRun, found: &[Difference]) -> String {
    if is_same(a, b, found) {
        return "the two runs are the same, bit for bit".into();
    }
    match earliest(found) {
        Some((difference, (t, x, y))) => {
            let tick = (t / a.report.settings.step).round();
            let unit = &difference.unit;
            format!(
                "they part in tick {tick} at t = {} s: `{}` is {x} {unit} in the first and {y} {unit} in the second",
                short(t, 9),
                difference.name
            )
        }
        None if a.report.trace_hash == b.report.trace_hash => {
            "the same motion; the recordings have other rows or signals".into()
        }
        None => "the recorded signals agree where both have them, but the states differ (trace hash)".into(),
    }
}

/// Settings, hashes and versions in which two runs differ: name, first, second.
fn facts(a: &FinishedRun, b: &FinishedRun) -> Vec<(String, String, String)> {
    let (p, q) = (&a.report, &b.report);
    let (s, r) = (&p.settings, &q.settings);
    let set = |run: &RunReport| {
        run.settings.overrides.iter().map(|o| format!("{} = {}", o.path, o.value)).collect::<Vec<_>>().join(", ")
    };
    let only = |x: &FinishedRun, y: &FinishedRun| {
        let missing = x.table.columns.iter().filter(|c| y.table.column(&c.name).is_none()).map(|c| c.name.as_str());
        missing.collect::<Vec<_>>().join(", ")
    };
    let all = [
        ("scene", p.scene.clone(), q.scene.clone()),
        ("trace hash", p.trace_hash.clone(), q.trace_hash.clone()),
        ("model hash", p.model_hash.clone(), q.model_hash.clone()),
        ("integrator", s.integrator.clone(), r.integrator.clone()),
        ("base step [s]", s.step.to_string(), r.step.to_string()),
        ("accuracy", s.accuracy.to_string(), r.accuracy.to_string()),
        ("duration [s]", s.duration.to_string(), r.duration.to_string()),
        ("seed", s.seed.to_string(), r.seed.to_string()),
        ("set", set(p), set(q)),
        ("rows", a.table.n_rows().to_string(), b.table.n_rows().to_string()),
        ("signals that the other lacks", only(a, b), only(b, a)),
        ("sincro", p.sincro_version.clone(), q.sincro_version.clone()),
    ];
    let or_none = |text: String| if text.is_empty() { "none".to_owned() } else { text };
    let differing = all.into_iter().filter(|(_, x, y)| x != y);
    differing.map(|(name, x, y)| (name.to_owned(), or_none(x), or_none(y))).collect()
}

/// Both replays in one, the main runs over each other; none if one of them is missing.
fn overlay(replays: &[Option<String>; 2], folders: [&PathBuf; 2]) -> Option<String> {
    let [Some(first), Some(second)] = replays else { return None };
    let (mut replay, other): (Value, Value) = (serde_json::from_str(first).ok()?, serde_json::from_str(second).ok()?);
    // a replay of another version is left out, the numbers are compared all the same
    if [&replay, &other].iter().any(|replay| replay["format"] != sincro_viewer::replay::FORMAT) {
        return None;
    }
    let named = |run: &Value, folder: &Path, view: usize| {
        let mut run = run.clone();
        run["name"] = folder
            .file_name()
            .map_or_else(|| folder.display().to_string(), |n| n.to_string_lossy().into_owned())
            .into();
        run["about"] = folder.display().to_string().into();
        run["view"] = view.into();
        run
    };
    let view_of = |replay: &Value| replay["views"][replay["runs"][0]["view"].as_u64().unwrap_or(0) as usize].clone();
    let views = vec![view_of(&replay), view_of(&other)];
    let runs = vec![named(&replay["runs"][0], folders[0], 0), named(&other["runs"][0], folders[1], 1)];
    (replay["views"], replay["runs"], replay["overlaid"]) = (views.into(), runs.into(), true.into());
    Some(replay.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table_of(rows: &[[f64; 3]]) -> Table {
        let mut table = Table::new([("t", "s"), ("a", ""), ("b", "")], rows.len());
        rows.iter().for_each(|row| table.push_row(row));
        table
    }

    #[test]
    fn the_first_difference_is_found_by_time_then_by_column() {
        let a = table_of(&[[0.0, 1.0, 2.0], [0.1, 1.0, 2.0], [0.2, 1.0, 2.0]]);
        let b = table_of(&[[0.0, 1.0, 2.0], [0.1, 1.0, 2.5], [0.2, 4.0, 2.0]]);
        let found = compare(&a, &b, &empty_report());
        assert_eq!(found[0].first, Some((0.2, 1.0, 4.0)));
        assert_eq!((found[1].first, found[1].greatest), (Some((0.1, 2.0, 2.5)), (0.5, 0.1)));
        assert_eq!(earliest(&found).map(|(d, _)| d.name.as_str()), Some("b"));
    }

    #[test]
    fn rows_are_matched_by_their_times() {
        let a = table_of(&[[0.0, 1.0, 0.0], [0.1, 2.0, 0.0], [0.2, 3.0, 0.0]]);
        let b = table_of(&[[0.0, 1.0, 0.0], [0.2, 3.0, -0.0]]);
        let found = compare(&a, &b, &empty_report());
        assert_eq!(found[0].first, None);
        assert_eq!(found[1].first, Some((0.2, 0.0, -0.0)), "minus zero is another number");
        let broken = table_of(&[[0.0, f64::NAN, 0.0]]);
        assert_eq!(compare(&a, &broken, &empty_report())[0].greatest.0, f64::INFINITY);
    }

    fn empty_report() -> RunReport {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
        let loaded = crate::load(&scene, &[]).unwrap();
        let interrupt = std::sync::atomic::AtomicBool::new(false);
        sincro_sim::campaign::run_campaign(&scene, &[], &loaded, None, &interrupt, &mut |_, _| {}).unwrap().report
    }
}

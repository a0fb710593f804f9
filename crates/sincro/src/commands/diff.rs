//! `sincro diff`: where two finished runs part, and how far apart they come.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;
use sincro_sim::file::FileError;
use sincro_sim::results::RunReport;
use sincro_sim::table::Table;

use crate::plot::escape;
use crate::plot::number::{short, significant};
use crate::report::shell::{cell, document, paragraph, section, settings, table};
use crate::{Exit, diagnostics, present};

/// What `diff` takes.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of a finished run
    first: PathBuf,
    /// Folder of another one
    second: PathBuf,
    /// Page with both runs over each other; `-` for none
    #[arg(long, value_name = "FILE", default_value = "diff.html")]
    out: PathBuf,
}

/// Times closer than this are the same instant `[s]`.
const SAME_INSTANT: f64 = 1e-9;

/// A signal of both runs.
#[derive(Clone, Debug, PartialEq)]
struct Difference {
    name: String,
    unit: String,
    /// First time `[s]` at which the bits differ, with both values.
    first: Option<(f64, f64, f64)>,
    /// Greatest difference and its time `[s]`.
    greatest: (f64, f64),
}

/// One folder.
struct Run {
    report: RunReport,
    table: Table,
}

impl Run {
    fn read(folder: &Path) -> Result<Self, FileError> {
        Ok(Self { report: RunReport::read(folder)?, table: Table::read_csv(&folder.join("signals.csv"))? })
    }
}

/// Runs the command: 0 if both runs have the same bits, else 1.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let runs = [&arguments.first, &arguments.second].map(|folder| Run::read(folder));
    let [a, b] = match runs {
        [Ok(a), Ok(b)] => [a, b],
        [Err(error), _] | [_, Err(error)] => {
            return diagnostics::refuse(&error.to_string(), Some("name two folders that `sincro run` wrote"));
        }
    };
    let found = compare(&a.table, &b.table, &a.report);
    print(&a, &b, &found);
    let same = is_same(&a, &b, &found);
    if arguments.out.as_os_str() != "-" {
        let films = [&arguments.first, &arguments.second]
            .map(|folder| std::fs::read_to_string(folder.join("replay.json")).ok());
        let page = page(&a, &b, &found, overlay(&films, [&arguments.first, &arguments.second]));
        if let Err(error) = present::write_text(&arguments.out, &page) {
            return diagnostics::refuse_file(&error);
        }
        say!("  page {}", arguments.out.display());
    }
    if same { Exit::Holds } else { Exit::Fails }
}

fn is_same(a: &Run, b: &Run, found: &[Difference]) -> bool {
    let names = |run: &Run| run.table.columns.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
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

fn verdict(a: &Run, b: &Run, found: &[Difference]) -> String {
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

fn print(a: &Run, b: &Run, found: &[Difference]) {
    say!("{}", verdict(a, b, found));
    for (name, x, y) in facts(a, b) {
        say!("  {name}: {x} against {y}");
    }
    let mut differing: Vec<&Difference> = found.iter().filter(|d| d.first.is_some()).collect();
    differing
        .sort_by(|p, q| p.first.map(|f| f.0).partial_cmp(&q.first.map(|f| f.0)).unwrap_or(std::cmp::Ordering::Equal));
    let width = differing.iter().map(|d| d.name.chars().count()).max().unwrap_or(0);
    for d in differing {
        let (greatest, at) = d.greatest;
        let first = d.first.map_or(0.0, |f| f.0);
        say!(
            "  {:<width$}  from {} s on, at most {} {} at {} s",
            d.name,
            short(first, 6),
            significant(greatest, 3),
            d.unit,
            short(at, 6)
        );
    }
}

/// What else is not the same: name, first, second.
fn facts(a: &Run, b: &Run) -> Vec<(String, String, String)> {
    let (p, q) = (&a.report, &b.report);
    let (s, r) = (&p.settings, &q.settings);
    let set = |run: &RunReport| {
        run.settings.overrides.iter().map(|o| format!("{} = {}", o.path, o.value)).collect::<Vec<_>>().join(", ")
    };
    let only = |x: &Run, y: &Run| {
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

/// Both films in one, the main runs over each other; none if one of them is missing.
fn overlay(films: &[Option<String>; 2], folders: [&PathBuf; 2]) -> Option<String> {
    let [Some(first), Some(second)] = films else { return None };
    let (mut film, other): (Value, Value) = (serde_json::from_str(first).ok()?, serde_json::from_str(second).ok()?);
    // a replay of another version is left out, the numbers are compared all the same
    if [&film, &other].iter().any(|film| film["format"] != sincro_viewer::film::FORMAT) {
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
    let view_of = |film: &Value| film["views"][film["runs"][0]["view"].as_u64().unwrap_or(0) as usize].clone();
    let views = vec![view_of(&film), view_of(&other)];
    let runs = vec![named(&film["runs"][0], folders[0], 0), named(&other["runs"][0], folders[1], 1)];
    (film["views"], film["runs"], film["overlaid"]) = (views.into(), runs.into(), true.into());
    Some(film.to_string())
}

fn page(a: &Run, b: &Run, found: &[Difference], film: Option<String>) -> String {
    let columns = [("", "Signal"), ("num", "From"), ("num", "Greatest difference"), ("", "Unit"), ("num", "At")];
    let seconds = |t: f64| format!("{} s", short(t, 6));
    let rows: Vec<String> = found
        .iter()
        .map(|d| {
            let differs = d.first.is_some();
            let or_dash = |text: String| if differs { escape(&text) } else { "–".into() };
            [
                cell("Signal", "name", &format!("<code>{}</code>", escape(&d.name))),
                cell("From", "num", &or_dash(seconds(d.first.map_or(0.0, |f| f.0)))),
                cell(
                    "Greatest difference",
                    "num",
                    &if differs { escape(&significant(d.greatest.0, 3)) } else { "same bits".into() },
                ),
                cell("Unit", "unit", &escape(&d.unit)),
                cell("At", "num", &or_dash(seconds(d.greatest.1))),
            ]
            .concat()
        })
        .collect();
    let facts: Vec<(String, String)> =
        facts(a, b).into_iter().map(|(name, x, y)| (name, format!("{x} against {y}"))).collect();
    let title = format!("{} against {}", a.report.title, b.report.title);
    let head = format!(
        "<header>\n<h1>Two runs</h1>\n<p class=\"lead\">{}</p>\n{}</header>\n",
        escape(&title),
        paragraph("", &verdict(a, b, found))
    );
    let body = [
        head,
        section("Both runs", &film.map(|film| sincro_viewer::embed::replay(&film)).unwrap_or_default()),
        section("Signals", &table("fold", &columns, &rows)),
        section("What else is not the same", &settings(&facts)),
    ];
    document("Two runs", "report", &body.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extensions::extensions;

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
        let loaded = sincro_sim::load(&scene, &[], extensions()).unwrap();
        let interrupt = std::sync::atomic::AtomicBool::new(false);
        sincro_sim::campaign::run_campaign(&scene, &[], &loaded, None, &interrupt, &mut |_, _| {}).unwrap().report
    }
}

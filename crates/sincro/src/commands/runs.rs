//! `sincro runs`: finished runs in a list, side by side, and the oldest ones removed.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::{Args, Subcommand};
use sincro::scene_name;
use sincro_figures::plot::number::significant;
use sincro_scene::experiment::check::Sense;
use sincro_sim::file::FileError;
use sincro_sim::result_folder::{find_result, folders_in, foreign_entry, is_result, numbers};
use sincro_sim::results::{RunReport, Status, VerdictReport};

use super::console::{short, verdict_line};
use super::whole_number;
use crate::{Exit, diagnostics};

/// Folder of the results where none is named.
const RESULTS: &str = "results";
/// Folders below that one in which results are looked for.
const DEPTH: usize = 3;

/// Arguments of `runs`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// Folders to look in, with all below; a scene stands for its results
    #[arg(value_name = "FOLDER", default_value = RESULTS)]
    folders: Vec<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// List finished runs with their verdict, trace hash and settings
    List {
        /// Folders to look in, with all below; a scene stands for its results
        #[arg(value_name = "FOLDER", default_value = RESULTS)]
        folders: Vec<PathBuf>,
    },
    /// Show settings and checks of finished runs side by side
    Compare {
        /// Folders of finished runs; results/SCENE is the latest one of that scene
        #[arg(value_name = "RUN", required = true, num_args = 2..)]
        runs: Vec<PathBuf>,
    },
    /// Remove the oldest numbered runs of every scene
    Prune {
        /// Folders to look in, with all below; a scene stands for its results
        #[arg(value_name = "FOLDER", default_value = RESULTS)]
        folders: Vec<PathBuf>,
        /// Runs of each scene that stay
        #[arg(long, value_name = "N", default_value_t = 10, value_parser = whole_number::<usize>)]
        keep: usize,
        /// Say what would be removed, and remove nothing
        #[arg(long)]
        dry_run: bool,
    },
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    match &arguments.command {
        None => list(&arguments.folders),
        Some(Command::List { folders }) => list(folders),
        Some(Command::Compare { runs }) => compare(runs),
        Some(Command::Prune { folders, keep, dry_run }) => prune(folders, *keep, *dry_run),
    }
}

/// A finished run.
struct Finished {
    folder: PathBuf,
    report: RunReport,
}

fn list(folders: &[PathBuf]) -> Exit {
    let mut found = Vec::new();
    for folder in folders {
        if !folder.is_dir() {
            let message = format!("there is no folder `{}`", folder.display());
            return diagnostics::refuse(&message, Some("`sincro run SCENE` writes into results/SCENE"));
        }
        collect(&results_of(folder), DEPTH, &mut found);
    }
    if found.is_empty() {
        say!("no finished runs");
        return Exit::Holds;
    }
    let width = found.iter().map(|run| run.folder.display().to_string().chars().count()).max().unwrap_or(0);
    for Finished { folder, report } in &found {
        let settings: Vec<String> =
            report.settings.overrides.iter().map(|s| format!("{}={}", s.path, s.value)).collect();
        let line = format!(
            "{:<width$}  {}  {}  {}  {}",
            folder.display().to_string(),
            changed(folder).map_or_else(|| " ".repeat(16), date),
            report.trace_hash,
            outcome(report),
            settings.join(" ")
        );
        say!("{}", line.trim_end());
    }
    Exit::Holds
}

/// Folder in which the results of a scene are, if `folder` is one.
fn results_of(folder: &Path) -> PathBuf {
    match folder.join("experiment.toml").is_file() {
        true => Path::new(RESULTS).join(scene_name(folder)),
        false => folder.to_owned(),
    }
}

/// Results in a folder and below, a scene's in the order of their numbers.
fn collect(folder: &Path, depth: usize, found: &mut Vec<Finished>) {
    if is_result(folder) {
        found.extend(RunReport::read(folder).ok().map(|report| Finished { folder: folder.to_owned(), report }));
    }
    if depth == 0 {
        return;
    }
    folders_in(folder).iter().for_each(|path| collect(path, depth - 1, found));
}

/// Status, checks and audit in a few words.
fn outcome(report: &RunReport) -> String {
    let statuses = std::iter::once(&report.status).chain(report.variants.iter().map(|v| &v.status));
    let bad = statuses.into_iter().find(|status| !status.is_good());
    match bad {
        Some(Status::Stopped { .. }) => "stopped".into(),
        Some(Status::Interrupted { time, .. }) => format!("interrupted at {} s", short(*time)),
        _ => verdict_line(report),
    }
}

fn changed(folder: &Path) -> Option<SystemTime> {
    fs::metadata(folder.join("run.json")).and_then(|file| file.modified()).ok()
}

/// `2026-03-01 12:34`, in UTC.
fn date(time: SystemTime) -> String {
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |passed| passed.as_secs());
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = civil(days);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}", rest / 3600, rest / 60 % 60)
}

/// Year, month and day of a day after 1970-01-01, in the Gregorian calendar.
fn civil(days: u64) -> (u64, u64, u64) {
    let is_leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let (mut year, mut left) = (1970, days);
    while left >= 365 + u64::from(is_leap(year)) {
        left -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 1;
    for length in lengths {
        if left < length {
            break;
        }
        left -= length;
        month += 1;
    }
    (year, month, left + 1)
}

fn compare(folders: &[PathBuf]) -> Exit {
    let mut runs = Vec::new();
    for folder in folders {
        let folder = find_result(folder);
        match RunReport::read(&folder) {
            Ok(report) => runs.push(Finished { folder, report }),
            Err(error) => {
                let help = "name folders that `sincro run` wrote, such as results/SCENE/0001";
                return diagnostics::refuse(&error.to_string(), Some(help));
            }
        }
    }
    for (k, run) in runs.iter().enumerate() {
        say!("{}  {}  {}", letter(k), run.folder.display(), outcome(&run.report));
    }
    let rows = rows(&runs);
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0).min(64);
    let columns: Vec<usize> =
        (0..runs.len()).map(|k| rows.iter().map(|(_, values)| values[k].chars().count()).max().unwrap_or(0)).collect();
    let line = |name: &str, values: &[String]| {
        let cells: Vec<String> = values.iter().zip(&columns).map(|(v, w)| format!("{v:<w$}")).collect();
        say!("{}", format!("  {name:<width$}  {}", cells.join("  ")).trim_end());
    };
    let heads: Vec<String> = (0..runs.len()).map(letter).collect();
    line("", &heads);
    for (name, values) in &rows {
        line(name, values);
    }
    Exit::Holds
}

fn letter(k: usize) -> String {
    if k < 26 { char::from(b'A' + k as u8).to_string() } else { format!("#{}", k + 1) }
}

/// Rows of settings that differ between the runs, then of what each measured.
fn rows(runs: &[Finished]) -> Vec<(String, Vec<String>)> {
    let mut rows: Vec<(String, Vec<String>)> = Vec::new();
    let all = |value: &dyn Fn(&RunReport) -> String| runs.iter().map(|run| value(&run.report)).collect::<Vec<_>>();
    let facts: [(&str, Vec<String>); 8] = [
        ("scene", all(&|r| r.scene.clone())),
        ("integrator", all(&|r| r.settings.integrator.clone())),
        ("step [s]", all(&|r| short(r.settings.step))),
        ("duration [s]", all(&|r| short(r.settings.duration))),
        ("accuracy", all(&|r| short(r.settings.accuracy))),
        ("seed", all(&|r| r.settings.seed.to_string())),
        ("model", all(&|r| r.model_hash.clone())),
        ("trace", all(&|r| r.trace_hash.clone())),
    ];
    let differs = |values: &[String]| values.iter().any(|value| *value != values[0]);
    rows.extend(facts.into_iter().filter(|(_, values)| differs(values)).map(|(name, v)| (name.to_owned(), v)));
    let mut paths: Vec<&str> = Vec::new();
    for setting in runs.iter().flat_map(|run| &run.report.settings.overrides) {
        if !paths.contains(&setting.path.as_str()) {
            paths.push(&setting.path);
        }
    }
    for path in paths {
        let of = |r: &RunReport| {
            let last = r.settings.overrides.iter().rev().find(|s| s.path == path);
            last.map_or_else(|| "as in the file".into(), |s| s.value.clone())
        };
        rows.push((path.to_owned(), all(&of)));
    }
    rows.push(("wall time [s]".into(), all(&|r| significant(r.wall_time_s, 2))));
    let mut names: Vec<&str> = Vec::new();
    for check in runs.iter().flat_map(|run| &run.report.checks) {
        if !names.contains(&check.name.as_str()) {
            names.push(&check.name);
        }
    }
    for name in names {
        let of = |r: &RunReport| {
            let Some(check) = r.checks.iter().find(|c| c.name == name) else { return "–".into() };
            // how far a value is beyond its limit is zero for all that keep it: the values themselves are compared
            let limit = |words: &str, x: f64, most: f64| format!("{} ({words} {})", significant(x, 4), short(most));
            let value = match (check.sense, check.measured, check.expected, check.deviation) {
                (Sense::AtMost, Some(x), Some(most), _) => limit("at most", x, most),
                (Sense::AtLeast, Some(x), Some(least), _) => limit("at least", x, least),
                (_, _, _, Some(deviation)) => format!("off by {}", significant(deviation, 3)),
                _ => "not made".into(),
            };
            format!("{} {value}", if check.verdict == VerdictReport::Holds { "ok  " } else { "FAIL" })
        };
        rows.push((name.to_owned(), all(&of)));
    }
    rows
}

fn prune(folders: &[PathBuf], keep: usize, dry_run: bool) -> Exit {
    let (mut n, mut exit) = (0, Exit::Holds);
    for folder in folders {
        for parent in numbered_below(&results_of(folder), DEPTH) {
            match prune_one(&parent, keep, dry_run) {
                Ok(removed) => n += removed,
                Err(error) => exit = diagnostics::refuse_file(&error),
            }
        }
    }
    let verb = if dry_run { "would be removed" } else { "removed" };
    say!("{} {verb}", diagnostics::count(n, "run"));
    exit
}

/// Folders that have numbered runs in them.
fn numbered_below(folder: &Path, depth: usize) -> Vec<PathBuf> {
    let mut found = Vec::new();
    if !numbers(folder).is_empty() {
        found.push(folder.to_owned());
    } else if depth > 0 {
        found.extend(folders_in(folder).iter().flat_map(|path| numbered_below(path, depth - 1)));
    }
    found
}

/// Removes all numbered runs of a folder but the last `keep` and the one that `latest` leads to; a folder to which
/// something was added stays.
fn prune_one(parent: &Path, keep: usize, dry_run: bool) -> Result<usize, FileError> {
    let all = numbers(parent);
    let latest = parent.join("latest").canonicalize().ok();
    let mut n = 0;
    for number in &all[..all.len().saturating_sub(keep)] {
        let path = parent.join(format!("{number:04}"));
        if latest.is_some() && path.canonicalize().ok() == latest {
            continue;
        }
        match foreign_entry(&path) {
            Ok(None) if is_result(&path) => {}
            Ok(Some(entry)) => {
                say!("{} stays: it holds `{entry}`", path.display());
                continue;
            }
            _ => continue,
        }
        say!("{}", path.display());
        if !dry_run {
            fs::remove_dir_all(&path).map_err(|e| FileError::new("remove", &path, e))?;
        }
        n += 1;
    }
    Ok(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(civil(0), (1970, 1, 1));
        assert_eq!(civil(59), (1970, 3, 1));
        assert_eq!(civil(11_016), (2000, 2, 29));
        assert_eq!(civil(20_513), (2026, 3, 1));
        assert_eq!(date(UNIX_EPOCH + std::time::Duration::from_secs(86_400 + 3_660)), "1970-01-02 01:01");
    }
}

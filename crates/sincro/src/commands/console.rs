//! Summary of a run on the terminal.

use std::io::IsTerminal;
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use sincro::Loaded;
use sincro_figures::plot::number::{self, significant};
use sincro_scene::experiment::check::Sense;
use sincro_sim::audit::Finding;
use sincro_sim::campaign::Campaign;
use sincro_sim::controller::Message;
use sincro_sim::results::{CheckReport, RunReport, Status, VerdictReport};

use crate::diagnostics::count;

/// A number as it is typed: six digits are more than a setting has.
pub(crate) fn short(x: f64) -> String {
    number::short(x, 6)
}

/// Progress on a terminal, nothing in a pipe.
pub(crate) struct Bar(Option<ProgressBar>);

impl Bar {
    /// A bar with a title.
    pub(crate) fn new(title: &str) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(None);
        }
        let bar = ProgressBar::new(1000);
        if let Ok(style) = ProgressStyle::with_template("{prefix} {bar:30} {percent:>3} %  {eta} left  {msg}") {
            bar.set_style(style);
        }
        bar.set_prefix(title.to_owned());
        Self(Some(bar))
    }

    /// Nothing.
    pub(crate) fn none() -> Self {
        Self(None)
    }

    /// Shows the work in hand and the share of it that is done.
    pub(crate) fn show(&self, words: &str, share: f64) {
        if let Some(bar) = &self.0 {
            let position = (1000.0 * share) as u64;
            if position < bar.position() {
                // another run: the time left is that of this one
                bar.reset_eta();
            }
            bar.set_message(words.to_owned());
            bar.set_position(position);
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

/// Prints to standard error why runs stopped, where nothing else is printed.
pub(crate) fn print_stops(campaign: &Campaign) {
    let report = &campaign.report;
    let variants = report.variants.iter().map(|variant| (format!("variant {}: ", variant.name), &variant.status));
    for (name, status) in [(String::new(), &report.status)].into_iter().chain(variants) {
        if let Status::Stopped { reason, .. } = status {
            eprintln!("error: {name}stopped: {reason}");
        }
    }
}

/// The whole summary of a run.
pub(crate) fn print_summary(loaded: &Loaded, campaign: &Campaign, out: &Path) {
    let report = &campaign.report;
    say!("{}", report.title);
    say!("  {}", how(report));
    print_messages(&campaign.main.simulated.messages);
    for warning in &campaign.main.simulated.warnings {
        say!("  warning: {warning}");
    }
    print_status("  ", &report.status);
    print_checks("", &report.checks);
    if let Some(sweep) = &report.sweep {
        say!("  sweep of {} over {} runs", sweep.parameter, sweep.n_runs);
        for stop in &sweep.stops {
            say!("    at {}: {}", short(stop.value), stop.reason);
        }
        print_checks("  ", &sweep.checks);
    }
    for variant in &report.variants {
        let colon = if variant.description.is_empty() { "" } else { ": " };
        say!("  variant {}{colon}{}", variant.name, variant.description);
        for warning in &variant.warnings {
            say!("    warning: {warning}");
        }
        print_status("    ", &variant.status);
        print_checks("  ", &variant.checks);
    }
    print_error_bars(report);
    print_findings("  ", report.findings());
    say!("{}", verdict_line(report));
    let compiled = report.compile_time_s.map(|t| format!(", equations compiled in {} ms", significant(1e3 * t, 2)));
    say!(
        "  trace {}   wall time {} s, {} times real time{}",
        report.trace_hash,
        significant(report.wall_time_s, 2),
        significant(report.real_time_factor, 2),
        compiled.unwrap_or_default()
    );
    say!("  report {}", out.join("report.html").display());
    let _ = loaded;
}

/// Duration, step, integrator, size.
fn how(report: &RunReport) -> String {
    let s = &report.settings;
    let accuracy = match s.integrator.as_str() {
        "dormand-prince" | "dormand-prince-8" | "stiff" => format!(", accuracy {}", short(s.accuracy)),
        _ => String::new(),
    };
    format!(
        "{} s at a base step of {} s, {}{accuracy}; {}",
        short(s.duration),
        short(s.step),
        s.integrator,
        degrees(report.n_dof)
    )
}

/// `1 degree of freedom`, `8 degrees of freedom`.
pub(crate) fn degrees(n: usize) -> String {
    format!("{n} degree{} of freedom", if n == 1 { "" } else { "s" })
}

fn print_status(indent: &str, status: &Status) {
    match status {
        Status::Completed => {}
        Status::Ended { time, reason, .. } => say!("{indent}ended at t = {} s: {reason}", short(*time)),
        Status::Stopped { reason, help, .. } => {
            say!("{indent}stopped: {reason}");
            if !help.is_empty() {
                say!("{indent}  help: {help}");
            }
        }
        Status::Interrupted { time, .. } => say!("{indent}interrupted at t = {} s", short(*time)),
    }
}

fn print_checks(indent: &str, checks: &[CheckReport]) {
    let width = checks.iter().map(|c| c.name.chars().count()).max().unwrap_or(0).min(64);
    for check in checks {
        let sign = match check.verdict {
            VerdictReport::Holds => "ok  ",
            // what it is compared with belongs to other settings
            VerdictReport::Fails if check.reason.is_some() => "fail",
            VerdictReport::Fails => "FAIL",
            VerdictReport::NotMade => "none",
        };
        say!("{indent}  {sign}  {:<width$}  {}", check.name, figures(check));
    }
}

/// Deviation against its limit; for a failed check also the two values.
fn figures(check: &CheckReport) -> String {
    if check.verdict == VerdictReport::NotMade {
        return check.reason.clone().unwrap_or_default();
    }
    // with the space before it, if there is one
    let unit = if check.relative { " (relative)".into() } else { spaced(&check.unit) };
    let deviation = check.deviation.map_or_else(|| "not finite".into(), |d| significant(d, 2));
    let bound = match check.sense {
        Sense::Equal => None,
        Sense::AtMost => Some("at most"),
        Sense::AtLeast => Some("at least"),
    };
    if let (Some(bound), Some(measured), Some(expected)) = (bound, check.measured, check.expected) {
        let beyond =
            if check.verdict == VerdictReport::Fails { format!("; beyond by {deviation}") } else { String::new() };
        return format!("{}, {bound} {}{unit}{beyond}", significant(measured, 4), significant(expected, 4));
    }
    let mut text = format!("off by {deviation}, allowed {}{unit}", short(check.limit));
    if let Some(reason) = &check.reason {
        text += &format!(" ({reason})");
    }
    if check.verdict == VerdictReport::Fails {
        if let (Some(measured), Some(expected)) = (check.measured, check.expected) {
            text += &format!("; measured {}, expected {}", significant(measured, 8), significant(expected, 8));
        }
        if let Some(at) = check.at {
            text += &format!(" at t = {} s", short(at));
        }
    }
    text
}

/// A unit as it follows a number.
fn spaced(unit: &str) -> String {
    if matches!(unit, "" | "1") { String::new() } else { format!(" {unit}") }
}

/// Findings of the audit, each with the name of its run, and the settings that would help.
pub(crate) fn print_findings<'a>(indent: &str, findings: impl Iterator<Item = (&'a str, &'a Finding)>) {
    for (run, finding) in findings {
        let run = if run.is_empty() { String::new() } else { format!("{run}: ") };
        let unit = spaced(&finding.unit);
        say!(
            "{indent}audit: {run}{} of {} is {}{unit} at t = {} s, allowed {}{unit}",
            finding.law.replace('-', " "),
            finding.element,
            significant(finding.value, 3),
            short(finding.time),
            significant(finding.limit, 2)
        );
        if !finding.help.is_empty() {
            say!("{indent}  help: {}", finding.help);
        }
    }
}

fn print_error_bars(report: &RunReport) {
    let worst = |unit: &str| {
        let bars = report.columns.iter().filter(|c| c.unit == unit).filter_map(|c| c.error_bar);
        bars.fold(None, |worst: Option<f64>, bar| Some(worst.map_or(bar, |w| w.max(bar))))
    };
    let mut units: Vec<&str> = Vec::new();
    for column in report.columns.iter().skip(1) {
        if !units.contains(&column.unit.as_str()) {
            units.push(&column.unit);
        }
    }
    let mut bars: Vec<(&str, f64)> = units.into_iter().filter_map(|unit| Some((unit, worst(unit)?))).collect();
    if bars.iter().any(|(_, bar)| *bar > 0.0) {
        // what is known exactly says nothing beside the rest
        bars.retain(|(_, bar)| *bar != 0.0);
    }
    let bars: Vec<String> =
        bars.into_iter().map(|(unit, bar)| format!("{}{}", significant(bar, 1), spaced(unit))).collect();
    if !bars.is_empty() {
        say!("  error bars up to {}", bars.join(", "));
    }
    if let Some(energy) = &report.energy {
        say!("  energy balance off by at most {} J", significant(energy.residual, 2));
    }
}

/// `all 22 checks hold`, or how many do not; and the number of findings of the audit.
pub(crate) fn verdict_line(report: &RunReport) -> String {
    let checks = checks_line(report);
    match report.findings().count() {
        0 => checks,
        n => format!("the audit has {}; {checks}", count(n, "finding")),
    }
}

fn checks_line(report: &RunReport) -> String {
    let checks: Vec<&CheckReport> = report
        .checks
        .iter()
        .chain(report.variants.iter().flat_map(|v| &v.checks))
        .chain(report.sweep.iter().flat_map(|s| &s.checks))
        .collect();
    let of = |verdict: VerdictReport| checks.iter().filter(|c| c.verdict == verdict).count();
    let (fails, missing) = (of(VerdictReport::Fails), of(VerdictReport::NotMade));
    match (checks.len(), fails, missing) {
        (0, ..) => "no checks in this experiment".into(),
        (1, 0, 0) => "the check holds".into(),
        (1, 1, 0) => "the check fails".into(),
        (n, 0, 0) => format!("all {n} checks hold"),
        (n, 0, missing) => format!("{missing} of {} could not be made", count(n, "check")),
        (n, fails, 0) => format!("{fails} of {} fail", count(n, "check")),
        (n, fails, missing) => format!("{fails} of {} fail, {missing} could not be made", count(n, "check")),
    }
}

/// First messages of scripts.
fn print_messages(messages: &[Message]) {
    const MAX: usize = 20;
    if messages.is_empty() {
        return;
    }
    say!("scripts said");
    for Message { t, object, text } in messages.iter().take(MAX) {
        say!("  t = {} s, {object}: {text}", short(*t));
    }
    if messages.len() > MAX {
        say!("  and {} more; all of it is in run.json", messages.len() - MAX);
    }
}

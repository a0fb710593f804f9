//! `report.html` of a tuning: before and after.

use std::sync::atomic::AtomicBool;

use sincro_figures::plot::number::significant;
use sincro_figures::plot::{Axis, Figure, Panel, Role, Series, Stroke, escape, escape_raised};
use sincro_figures::report::figure;
use sincro_figures::report::shell::{PLOT_SCRIPT, cell, document, paragraph, sections, settings, table};
use sincro_sim::run::{RunMonitor, RunOptions, simulate};
use sincro_sim::table::Table;

use super::{Candidate, LoopMargin, Tuned, Tuning, number};

/// Signals whose motion before and after is drawn.
const MAX_FIGURES: usize = 6;

/// The page.
pub(super) fn html(tuning: &Tuning<'_>, tuned: &Tuned) -> String {
    let all = [
        ("Parameters", parameters(tuning, tuned)),
        ("Measures", measures(tuning, tuned)),
        ("Margins", margins(tuned)),
        ("Pareto front", front(tuning, tuned)),
        ("Before and after", motions(tuning, tuned)),
        ("Search", search(tuned)),
        ("Settings", settings(&setting_rows(tuning, tuned))),
    ]
    .map(|(heading, content)| (heading.to_owned(), content));
    let title = format!("{}, tuned", tuning.campaign.loaded.experiment.title);
    document(&title, "report", &(header(&title, tuning, tuned) + &sections(&all) + PLOT_SCRIPT))
}

fn header(title: &str, tuning: &Tuning<'_>, tuned: &Tuned) -> String {
    let is_kept = tuned.after.violation == 0.0;
    let (class, symbol) = if is_kept { ("good", "✓") } else { ("bad", "✗") };
    let limits = match (is_kept, tuning.limits.len()) {
        (true, 0) => String::new(),
        (true, _) => "; all limits are kept".to_owned(),
        (false, _) => "; a limit is broken".to_owned(),
    };
    let shown = |x: f64| escape_raised(&significant(x, 5));
    let (lead, verdict) = match &tuning.second {
        None => {
            let change = significant(100.0 * (tuned.after.goal / tuned.before.goal - 1.0), 3);
            let (before, after) = (shown(tuned.before.goal), shown(tuned.after.goal));
            let verdict = format!("the goal went from {before} to {after} ({change} %)");
            (format!("Goal: `{}`", tuning.goal.text), verdict)
        }
        Some(second) => {
            let of = |c: &Candidate| {
                format!(
                    "{} = {}, {} = {}",
                    escape(&tuning.goal.text),
                    shown(c.goal),
                    escape(&second.text),
                    shown(c.second)
                )
            };
            let n = tuned.front.len();
            let verdict =
                format!("a front of {n} candidates; chosen {}; before {}", of(&tuned.after), of(&tuned.before));
            (format!("Goals: `{}` and `{}`", tuning.goal.text, second.text), verdict)
        }
    };
    format!(
        "<header>\n<h1>{}</h1>\n{}<div class=\"banner {class}\" role=\"status\"><p class=\"verdict\"><span aria-hidden=\"true\">{symbol}</span> \
         {verdict}{limits}</p></div>\n</header>\n",
        escape(title),
        paragraph("lead", &lead),
    )
}

fn row(name: &str, before: f64, after: f64, more: &str) -> String {
    [
        cell("Name", "name", name),
        cell("Before", "num", &escape_raised(&number(before))),
        cell("After", "num", &escape_raised(&number(after))),
        cell("Bounds", "", more),
    ]
    .concat()
}

fn parameters(tuning: &Tuning<'_>, tuned: &Tuned) -> String {
    let rows: Vec<String> = tuning
        .free
        .iter()
        .enumerate()
        .map(|(k, free)| {
            let bounds = format!("{} … {}", number(free.low), number(free.high));
            let name = format!("<code>{}</code>", escape(&free.path));
            row(&name, tuned.before.values[k], tuned.after.values[k], &escape_raised(&bounds))
        })
        .collect();
    let columns = [("", "Parameter"), ("num", "Before"), ("num", "After"), ("", "Bounds")];
    table("fold", &columns, &rows)
        + &format!(
            "<p class=\"key\">Run with these values: <code>{}</code></p>\n",
            escape(&tuning.command(&tuned.after.values))
        )
}

fn measures(tuning: &Tuning<'_>, tuned: &Tuned) -> String {
    let mut rows: Vec<String> = tuning
        .limits
        .iter()
        .zip(&tuned.after.violations)
        .map(|(limit, violation)| {
            let kept = if *violation > 0.0 { "broken" } else { "kept" };
            let name = format!("<code>{}</code>", escape(&limit.text));
            row(&name, limit.left(&tuned.before.measures), limit.left(&tuned.after.measures), kept)
        })
        .collect();
    let names = &tuning.campaign.layout.measures;
    rows.extend(
        names
            .iter()
            .enumerate()
            .map(|(k, name)| row(&escape(name), tuned.before.measures[k], tuned.after.measures[k], "")),
    );
    let columns = [("", "Measure"), ("num", "Before"), ("num", "After"), ("", "Limit")];
    let several = match tuning.campaign.plan.n_runs() {
        1 => String::new(),
        n => {
            format!("<p class=\"key\">Measures are those of the first of {n} runs; the goal is over all of them.</p>\n")
        }
    };
    table("fold", &columns, &rows) + &several
}

/// Margins of the loops of the diagram.
fn margins(tuned: &Tuned) -> String {
    let (before, after) = &tuned.margins;
    if after.is_empty() {
        return String::new();
    }
    let value =
        |x: Option<f64>, unit: &str| x.map_or_else(|| "none".into(), |x| format!("{} {unit}", significant(x, 4)));
    let mut rows = Vec::new();
    for after in after {
        let before = before.iter().find(|before| before.signal == after.signal);
        let signal = escape(&after.signal);
        let of = |what: &str, before: String, after: String| {
            let name = format!("{what} at <code>{signal}</code>");
            [cell("Margin", "name", &name), cell("Before", "num", &before), cell("After", "num", &after)].concat()
        };
        let of_before = |pick: fn(&LoopMargin) -> Option<f64>| before.and_then(pick);
        rows.push(of("gain margin", value(of_before(|m| m.gain_db), "dB"), value(after.gain_db, "dB")));
        rows.push(of("phase margin", value(of_before(|m| m.phase_deg), "°"), value(after.phase_deg, "°")));
        rows.push(of("modulus margin", value(of_before(|m| Some(m.modulus)), ""), value(Some(after.modulus), "")));
    }
    table("fold", &[("", "Margin"), ("num", "Before"), ("num", "After")], &rows)
        + "<p class=\"key\">Of the loop that the diagram closes by a command, opened there at the end of the first run. The modulus margin is \
           the smallest distance of the open loop's frequency response from −1: above 0.5 is comfortable.</p>\n"
}

/// Front of two goals.
fn front(tuning: &Tuning<'_>, tuned: &Tuned) -> String {
    let Some(second) = &tuning.second else { return String::new() };
    let goals = |all: &[Candidate]| -> (Vec<f64>, Vec<f64>) { all.iter().map(|c| (c.goal, c.second)).unzip() };
    let mut panel = Panel::new(Axis::new(second.text.clone(), ""));
    let mut add = |name: &str, role, all: &[Candidate]| {
        let (x, y) = goals(all);
        panel.series.push(Series { stroke: Stroke::Points, ..Series::new(name, role, x, y) });
    };
    add("front", Role::Simulated, &tuned.front);
    add("before", Role::Variant(0), std::slice::from_ref(&tuned.before));
    add("chosen", Role::Reference, std::slice::from_ref(&tuned.after));
    let x = Axis::new(tuning.goal.text.clone(), "");
    let title = format!("{} against {}", second.text, tuning.goal.text);
    let figure = figure(&Figure { title, x, panels: vec![panel], space: None });
    let mut columns = vec![("num", tuning.goal.text.as_str()), ("num", second.text.as_str())];
    columns.extend(tuning.free.iter().map(|free| ("num", free.path.as_str())));
    // at most twenty of them, evenly along the front
    let every = tuned.front.len().div_ceil(20).max(1);
    let rows: Vec<String> = tuned
        .front
        .iter()
        .step_by(every)
        .map(|c| {
            let all = [c.goal, c.second].into_iter().chain(c.values.iter().copied());
            all.zip(&columns).map(|(x, (_, name))| cell(name, "num", &escape_raised(&significant(x, 5)))).collect()
        })
        .collect();
    figure
        + &table("fold", &columns, &rows)
        + &paragraph(
            "key",
            &format!(
                "No candidate that was tried is better than one of these {} in both goals. The chosen one is nearest to the best of both, each \
                 relative to its width on the front.",
                tuned.front.len()
            ),
        )
}

/// Motion of a candidate in the first run.
fn motion(tuning: &Tuning<'_>, candidate: &Candidate) -> Option<Table> {
    let point = tuning.campaign.plan.point(0);
    let loaded = tuning.campaign.loaded_with(&point, &tuning.settings(&candidate.values)).ok()?;
    let mut monitor = RunMonitor { interrupt: &AtomicBool::new(false), progress: &mut |_| {} };
    simulate(&loaded, RunOptions::default(), &mut monitor).ok().map(|run| run.table)
}

fn motions(tuning: &Tuning<'_>, tuned: &Tuned) -> String {
    let (Some(before), Some(after)) = (motion(tuning, &tuned.before), motion(tuning, &tuned.after)) else {
        return String::new();
    };
    let figures: String = after
        .columns
        .iter()
        .skip(1)
        .filter(|column| column.name != "energy.balance")
        .take(MAX_FIGURES)
        .filter_map(|column| {
            let old = before.column(&column.name)?;
            let label = column.name.rsplit('/').next().unwrap_or(&column.name);
            let mut panel = Panel::new(Axis::new(label, column.unit.clone()));
            let series = |name: &str, role, table: &Table, values: &[f64]| {
                Series::new(name, role, table.times().to_vec(), values.to_vec())
            };
            panel.series.push(series("before", Role::Variant(0), &before, &old.values));
            panel.series.push(series("after", Role::Simulated, &after, &column.values));
            Some(figure(&Figure { title: column.name.clone(), x: Axis::time(), panels: vec![panel], space: None }))
        })
        .collect();
    format!("<div class=\"figures\">\n{figures}</div>\n")
}

fn search(tuned: &Tuned) -> String {
    let finite = tuned.history.iter().filter(|(_, goal)| goal.is_finite());
    let (mut x, mut y): (Vec<f64>, Vec<f64>) = finite.map(|(n, goal)| (*n as f64, *goal)).unzip();
    x.push(tuned.n_candidates as f64);
    y.push(tuned.after.goal);
    let mut panel = Panel::new(Axis::new("goal", ""));
    panel.series.push(Series { stroke: Stroke::Steps, ..Series::new("best so far", Role::Simulated, x, y) });
    let title = "Goal of the best candidate".to_owned();
    figure(&Figure { title, x: Axis::new("candidates", ""), panels: vec![panel], space: None })
}

fn setting_rows(tuning: &Tuning<'_>, tuned: &Tuned) -> Vec<(String, String)> {
    vec![
        ("goal".into(), tuning.goal.text.clone()),
        ("second goal".into(), tuning.second.as_ref().map_or_else(|| "none".into(), |goal| goal.text.clone())),
        ("candidates".into(), tuned.n_candidates.to_string()),
        ("runs for each candidate".into(), tuning.campaign.plan.n_runs().to_string()),
        ("several runs as one".into(), format!("{:?}", tuning.robust).to_lowercase()),
        ("method".into(), method(tuning).into()),
        ("seed".into(), tuning.seed.to_string()),
        ("ended".into(), tuned.ended().into()),
        ("sincro".into(), env!("CARGO_PKG_VERSION").into()),
    ]
}

fn method(tuning: &Tuning<'_>) -> &'static str {
    match tuning.method {
        _ if tuning.second.is_some() => "NSGA-II",
        super::Method::Global => "CMA-ES",
        super::Method::Local => "Nelder–Mead",
    }
}

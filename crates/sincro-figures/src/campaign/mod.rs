//! Figures and page of a run with its variants, sweep and checks.

mod digits;
mod figures;
mod mechanism;

use sincro_scene::diagram::ControlDiagram;
use sincro_sim::Loaded;
use sincro_sim::audit::Finding;
use sincro_sim::campaign::Campaign;
use sincro_sim::results::{CheckReport, Status, VerdictReport};

use crate::draw::{self, Layouts, Options};
use crate::plot::{self, number};
use crate::report::{Card, CheckRow, CheckVerdict, Energy, FindingRow, Page, SignalRow, Stop};

pub use figures::all as figures;

/// Card of the results of an experiment for an index page ([`crate::report::index_html`]); `href` is the address of its
/// report relative to the index. Group, address of the replay and picture of the scene are left empty: they are the
/// caller's.
#[must_use]
pub fn card(loaded: &Loaded, campaign: &Campaign, href: &str) -> Card {
    let report = &campaign.report;
    Card {
        title: report.title.clone(),
        group: String::new(),
        source: report.scene.clone(),
        summary: loaded.experiment.description.clone(),
        href: href.to_owned(),
        replay: String::new(),
        picture: String::new(),
        figure: figures(loaded, campaign).into_iter().next(),
        checks: checks(campaign),
        n_findings: report.findings().count(),
        stop: stop(&report.status),
        run_time: format!("{} s", number::significant(report.wall_time_s, 2)),
    }
}

/// Draws the block diagram of a scene as SVG: for an HTML page of [`crate::report`] if `is_inline`, else as a
/// standalone file. `title` stands above it and may be empty; `world` labels the box of the world, usually with the
/// name of the scene.
#[must_use]
pub fn diagram(controller: &ControlDiagram, title: &str, world: &str, is_inline: bool) -> String {
    diagram_with(&mut Layouts::default(), controller, (title, world), is_inline)
}

fn diagram_with(
    layouts: &mut Layouts,
    controller: &ControlDiagram,
    (title, world): (&str, &str),
    is_inline: bool,
) -> String {
    let outputs = controller.wiring.program().steps.iter().flat_map(|step| {
        let ports = step.output_names.iter().zip(&step.node.outputs);
        ports.map(|(port, width)| (format!("{}.{port}", step.path), *width))
    });
    let options = Options { title: title.to_owned(), world: world.to_owned(), is_inline, widths: outputs.collect() };
    draw::draw(&controller.diagram, &options, layouts)
}

/// Report page of an experiment with its figures, checks, signals and settings, to be turned into HTML by
/// [`crate::report::html`]. The replay and the link to an index are left empty: they are the caller's.
#[must_use]
pub fn page(loaded: &Loaded, campaign: &Campaign) -> Page {
    let report = &campaign.report;
    let signals = report.columns.iter().skip(1).enumerate().map(|(k, column)| {
        let values = &campaign.main.simulated.table.columns[k + 1].values;
        SignalRow {
            path: column.path.clone(),
            unit: column.unit.clone(),
            largest: values.iter().copied().map(f64::abs).reduce(f64::max),
            error_bar: column.error_bar,
            method: column.error_bar_method.clone(),
        }
    });
    let energy = report.energy.map(|e| Energy {
        start: e.kinetic_start + e.potential_start,
        end: e.kinetic_end + e.potential_end,
        work: e.work,
        dissipated: e.dissipated,
        residual: e.residual,
    });
    Page {
        title: report.title.clone(),
        description: loaded.experiment.description.clone(),
        up: None,
        stop: stop(&report.status),
        warnings: warnings(campaign),
        replay: String::new(),
        mechanism: mechanism::of(loaded, campaign),
        figures: figures(loaded, campaign),
        diagrams: diagrams(loaded, campaign),
        findings: report.findings().map(finding_row).collect(),
        checks: checks(campaign),
        signals: signals.collect(),
        energy,
        settings: settings(campaign),
        messages: messages(campaign),
        notes: notes(campaign),
    }
}

/// Messages that a page shows; `run.json` has the rest.
const MAX_MESSAGES: usize = 200;

fn messages(campaign: &Campaign) -> Vec<(String, String, String)> {
    let all = &campaign.report.messages;
    let shown = all.iter().take(MAX_MESSAGES);
    let time = |t: f64| format!("{} s", (t * 1e6).round() / 1e6);
    let mut list: Vec<_> = shown.map(|m| (time(m.t), m.object.clone(), m.text.clone())).collect();
    if let Some(next) = all.get(MAX_MESSAGES) {
        let more = all.len() - MAX_MESSAGES;
        list.push((time(next.t), String::new(), format!("and {more} more: they are in run.json")));
    }
    list
}

/// The diagrams of the run and of those variants that have another one.
fn diagrams(loaded: &Loaded, campaign: &Campaign) -> Vec<(String, String)> {
    let variants = campaign.variants.iter().map(|(v, done)| (format!("variant `{}`", v.name), done));
    let mut shown: Vec<String> = Vec::new();
    let (mut drawings, mut layouts) = (Vec::new(), Layouts::default());
    for (title, done) in std::iter::once(("main run".to_owned(), &campaign.main)).chain(variants) {
        let Some(controller) = &done.controller else { continue };
        let drawing = diagram_with(&mut layouts, controller, ("", &campaign.report.scene), true);
        // what is told on hovering alone is no other picture
        let picture: String =
            drawing.split("<title>").map(|part| part.split_once("</title>").map_or(part, |p| p.1)).collect();
        if !shown.contains(&picture) {
            shown.push(picture);
            drawings.push((title, drawing));
        }
    }
    debug_assert!(loaded.controller.is_none() || !drawings.is_empty(), "the main run has the scene's diagram");
    drawings
}

/// Warnings of the scene, the run and the variants.
fn warnings(campaign: &Campaign) -> Vec<String> {
    let variants = campaign.report.variants.iter();
    let of_variants = variants.flat_map(|v| v.warnings.iter().map(move |w| format!("variant `{}`: {w}", v.name)));
    campaign.report.warnings.iter().cloned().chain(of_variants).collect()
}

fn notes(campaign: &Campaign) -> Vec<String> {
    let variants = campaign.report.variants.iter().filter(|v| !v.description.is_empty());
    let mut notes: Vec<String> = variants.map(|v| format!("Variant `{}`: {}", v.name, v.description)).collect();
    notes.push("`signals.csv` has the recorded signals with all digits, `run.json` everything on this page.".into());
    notes
}

fn stop(status: &Status) -> Option<Stop> {
    match status {
        Status::Completed => None,
        Status::Ended { time, reason, .. } => {
            let at = plot::number::short(*time, 9);
            let reason = format!("The run ended at t = {at} s as intended: {reason}.");
            Some(Stop { time: *time, reason, help: String::new(), is_good: true })
        }
        Status::Stopped { time, reason, help, .. } => {
            Some(Stop { time: *time, reason: reason.clone(), help: help.clone(), is_good: false })
        }
        Status::Interrupted { time, .. } => {
            Some(Stop { time: *time, reason: "it was interrupted".into(), ..Stop::default() })
        }
    }
}

/// The checks of the run, of the sweep, of the variants.
fn checks(campaign: &Campaign) -> Vec<CheckRow> {
    let report = &campaign.report;
    let main = report.checks.iter().map(|c| check_row(c, ""));
    let sweep = report.sweep.iter().flat_map(|s| &s.checks).map(|c| check_row(c, "sweep"));
    let variants = report.variants.iter().flat_map(|v| v.checks.iter().map(move |c| check_row(c, &v.name)));
    main.chain(sweep).chain(variants).collect()
}

fn finding_row((run, finding): (&str, &Finding)) -> FindingRow {
    let Finding { law, element, time, value, limit, unit, help } = finding.clone();
    FindingRow { run: run.to_owned(), law, element, time, value, limit, unit, help }
}

fn check_row(check: &CheckReport, run: &str) -> CheckRow {
    let mut about = check.about.clone();
    if let (VerdictReport::NotMade, Some(reason)) = (check.verdict, &check.reason) {
        about = format!("{about}: {reason}");
    }
    CheckRow {
        name: if run.is_empty() { check.name.clone() } else { format!("{run}: {}", check.name) },
        about,
        measured: check.measured,
        expected: check.expected,
        sense: check.sense,
        deviation: check.deviation.unwrap_or(f64::NAN),
        limit: check.limit,
        is_relative: check.relative,
        unit: check.unit.clone(),
        at: if run == "sweep" { None } else { check.at },
        verdict: match check.verdict {
            VerdictReport::Holds => CheckVerdict::Holds,
            VerdictReport::Fails => CheckVerdict::Fails,
            VerdictReport::NotMade => CheckVerdict::NotMade,
        },
    }
}

fn settings(campaign: &Campaign) -> Vec<(String, String)> {
    let (report, statistics) = (&campaign.report, campaign.main.simulated.statistics);
    let s = &report.settings;
    let number = |x: f64| number::short(x, 6);
    let mut rows = vec![
        ("scene".to_owned(), report.scene.clone()),
        ("degrees of freedom".to_owned(), report.n_dof.to_string()),
        ("integrator".to_owned(), s.integrator.clone()),
        ("base step".to_owned(), format!("{} s", number(s.step))),
    ];
    if matches!(s.integrator.as_str(), "dormand-prince" | "dormand-prince-8" | "stiff") {
        rows.push(("accuracy".to_owned(), number(s.accuracy)));
    }
    rows.extend([
        ("duration".to_owned(), format!("{} s", number(s.duration))),
        ("steps of the integrator".to_owned(), statistics.steps.to_string()),
        ("seed".to_owned(), s.seed.to_string()),
    ]);
    for setting in &s.overrides {
        rows.push((format!("set {}", setting.path), setting.value.clone()));
    }
    for change in &report.changes {
        let value = change.value.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", ");
        let since = if change.t > 0.0 { format!("from {} s", number(change.t)) } else { String::new() };
        let what = match change.quantity.as_str() {
            quantity @ ("added" | "removed" | "hung") => format!("{} {quantity}", change.object),
            quantity @ ("momentum" | "energy") => format!("jump of {quantity}"),
            quantity => format!("{} of {}", quantity.replace('_', " "), change.object),
        };
        let told: Vec<String> = [value, since].into_iter().filter(|text| !text.is_empty()).collect();
        let by = "by a client or script";
        rows.push((what, if told.is_empty() { by.to_owned() } else { format!("{}, {by}", told.join(" ")) }));
    }
    rows.extend([
        ("model hash".to_owned(), report.model_hash.clone()),
        ("trace hash".to_owned(), report.trace_hash.clone()),
        (
            "wall time".to_owned(),
            format!(
                "{} s, {} times real time",
                plot::number::significant(report.wall_time_s, 2),
                plot::number::significant(report.real_time_factor, 2)
            ) + &report.compile_time_s.map_or(String::new(), |t| {
                format!("; equations compiled in {} ms", plot::number::significant(1e3 * t, 2))
            }),
        ),
        ("sincro".to_owned(), report.sincro_version.clone()),
    ]);
    rows
}

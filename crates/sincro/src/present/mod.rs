//! From what came out of a run to what is shown: report, figures, card.

mod figures;

use std::path::Path;

use sincro_scene::camera::png;
use sincro_scene::scene::Camera;
use sincro_sim::Loaded;
use sincro_sim::campaign::{Campaign, Done};
use sincro_sim::file::{self, FileError};
use sincro_sim::results::{CheckReport, Status, VerdictReport};
use sincro_viewer::film::Film;

use crate::plot::{self, Figure, Size};
use crate::report::{self, Card, CheckRow, CheckVerdict, Energy, Page, SignalRow, Stop};

/// Writes `report.html`, `replay.json` and the figures as SVG files into a results folder.
///
/// # Errors
///
/// A file cannot be written.
pub(crate) fn write(
    loaded: &Loaded,
    campaign: &Campaign,
    out: &Path,
    up: Option<(String, String)>,
) -> Result<(), FileError> {
    let figures = figures::all(loaded, campaign);
    let folder = out.join("figures");
    sincro_sim::file::prepare(&folder)?;
    for (k, figure) in figures.iter().enumerate() {
        let name = format!("{:02}-{}.svg", k + 1, file_name(&figure.title));
        write_text(&folder.join(name), &plot::svg(figure, Size::wide(figure)))?;
    }
    let film = film(loaded, campaign).to_json();
    write_text(&out.join("replay.json"), &film)?;
    let replay = sincro_viewer::embed::replay(&film);
    write_text(&out.join("report.html"), &report::html(&Page { replay, ..page(loaded, campaign, figures, up) }))
}

/// Size of a picture of a run `[px]`.
const FRAME: (f64, f64) = (960.0, 540.0);
/// Pictures of a run a simulated second [1/s], and in all.
const FRAMES: (f64, usize) = (30.0, 1800);

/// Writes pictures of a run into `frames` in a results folder.
///
/// # Errors
///
/// A file cannot be written.
pub(crate) fn write_frames(done: &Done, out: &Path) -> Result<(), FileError> {
    let Some(tape) = &done.simulated.tape else { return Ok(()) };
    let folder = out.join("frames");
    sincro_sim::file::prepare(&folder)?;
    for (k, picture) in sincro_viewer::picture::strip(&done.view, tape, FRAMES, FRAME).iter().enumerate() {
        write_text(&folder.join(format!("{:04}.svg", k + 1)), picture)?;
    }
    Ok(())
}

/// Writes what a camera of the scene (its place among the objects) saw of a run into `frames` in a results folder, as PNG.
///
/// # Errors
///
/// A file cannot be written.
pub(crate) fn write_photographs(loaded: &Loaded, done: &Done, camera: usize, out: &Path) -> Result<(), FileError> {
    let Some(tape) = &done.simulated.tape else { return Ok(()) };
    let resolution = [FRAME.0 as usize, FRAME.1 as usize];
    let Some(mut camera) = Camera::of_scene(&loaded.scene, camera, resolution) else { return Ok(()) };
    let folder = out.join("frames");
    sincro_sim::file::prepare(&folder)?;
    for (n, k) in tape.spread(FRAMES.0, FRAMES.1).into_iter().enumerate() {
        let q: Vec<f64> = tape.layout.coordinates(tape.frame(k)).iter().copied().map(f64::from).collect();
        let image = camera.look(&q);
        let bytes = png::encode(image.rgb(), image.resolution(), png::Channels::Rgb);
        file::write_atomically(&folder.join(format!("{:04}.png", n + 1)), &bytes)?;
    }
    Ok(())
}

/// What the viewer shows of a campaign.
pub(crate) fn film(loaded: &Loaded, campaign: &Campaign) -> Film {
    let draw = |controller| crate::commands::draw::drawing(controller, "", &campaign.report.scene, true);
    Film::of_campaign(loaded, campaign, loaded.controller.as_ref().map(draw))
}

/// Writes a text file, whole or not at all.
///
/// # Errors
///
/// The file cannot be written.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    file::write_atomically(path, text.as_bytes())
}

/// The card of a run in the gallery; `href` leads to its report.
pub(crate) fn card(loaded: &Loaded, campaign: &Campaign, href: &str) -> Card {
    let figures = figures::all(loaded, campaign);
    let report = &campaign.report;
    Card {
        title: report.title.clone(),
        source: report.scene.clone(),
        summary: loaded.experiment.description.clone(),
        href: href.to_owned(),
        replay: format!("{href}#sincro-viewer"),
        picture: picture(campaign),
        figure: figures.into_iter().next(),
        checks: checks(campaign),
        stop: stop(&report.status),
        run_time: format!("{} s", plot::number::significant(report.wall_time_s, 2)),
    }
}

/// The scene half way through the run.
fn picture(campaign: &Campaign) -> String {
    let main = &campaign.main;
    let half = |tape: &sincro_sim::replay::Tape| {
        sincro_viewer::picture::still(&main.view, tape.frame(tape.n_frames() / 2), (320.0, 150.0))
    };
    main.simulated.tape.as_ref().filter(|tape| tape.n_frames() > 0).map(half).unwrap_or_default()
}

fn page(loaded: &Loaded, campaign: &Campaign, figures: Vec<Figure>, up: Option<(String, String)>) -> Page {
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
        up,
        stop: stop(&report.status),
        warnings: warnings(campaign),
        replay: String::new(),
        figures,
        diagrams: diagrams(loaded, campaign),
        checks: checks(campaign),
        signals: signals.collect(),
        energy,
        settings: settings(campaign),
        messages: messages(campaign),
        notes: notes(campaign),
    }
}

/// Messages that a page shows; `run.json` has the rest.
const MOST_MESSAGES: usize = 200;

fn messages(campaign: &Campaign) -> Vec<(String, String, String)> {
    let all = &campaign.report.messages;
    let shown = all.iter().take(MOST_MESSAGES);
    let time = |t: f64| format!("{} s", (t * 1e6).round() / 1e6);
    let mut list: Vec<_> = shown.map(|m| (time(m.t), m.object.clone(), m.text.clone())).collect();
    if let Some(next) = all.get(MOST_MESSAGES) {
        let more = all.len() - MOST_MESSAGES;
        list.push((time(next.t), String::new(), format!("and {more} more: they are in run.json")));
    }
    list
}

/// The diagrams of the run and of those variants that have another one.
fn diagrams(loaded: &Loaded, campaign: &Campaign) -> Vec<(String, String)> {
    let variants = campaign.variants.iter().map(|(v, done)| (format!("variant `{}`", v.name), done));
    let mut shown: Vec<String> = Vec::new();
    let mut drawings = Vec::new();
    for (title, done) in std::iter::once(("main run".to_owned(), &campaign.main)).chain(variants) {
        let Some(controller) = &done.controller else { continue };
        let drawing = crate::commands::draw::drawing(controller, "", &campaign.report.scene, true);
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
            let reason = format!("The run ended at t = {at} s as it was to: {reason}.");
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
    let (report, effort) = (&campaign.report, campaign.main.simulated.effort);
    let s = &report.settings;
    let number = crate::commands::console::short;
    let mut rows = vec![
        ("scene".to_owned(), report.scene.clone()),
        ("degrees of freedom".to_owned(), report.n_dof.to_string()),
        ("integrator".to_owned(), s.integrator.clone()),
        ("base step".to_owned(), format!("{} s", number(s.step))),
    ];
    if matches!(s.integrator.as_str(), "dormand-prince" | "stiff") {
        rows.push(("accuracy".to_owned(), number(s.accuracy)));
    }
    rows.extend([
        ("duration".to_owned(), format!("{} s", number(s.duration))),
        ("steps of the integrator".to_owned(), effort.steps.to_string()),
        ("seed".to_owned(), s.seed.to_string()),
    ]);
    for setting in &s.overrides {
        rows.push((format!("set {}", setting.path), setting.value.clone()));
    }
    for change in &report.changes {
        let value = change.value.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", ");
        let since = if change.t > 0.0 { format!(" from {} s", number(change.t)) } else { String::new() };
        rows.push((
            format!("{} of {}", change.quantity.replace('_', " "), change.object),
            format!("{value}{since}, by a client or script"),
        ));
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
            ),
        ),
        ("sincro".to_owned(), report.sincro_version.clone()),
    ]);
    rows
}

/// A title as part of a file's name.
fn file_name(title: &str) -> String {
    let mut name = String::new();
    for c in title.to_lowercase().chars() {
        if c.is_ascii_alphanumeric() {
            name.push(c);
        } else if !name.ends_with('-') {
            name.push('-');
        }
    }
    let name = name.trim_matches('-');
    name.get(..48).unwrap_or(name).trim_matches('-').to_owned()
}

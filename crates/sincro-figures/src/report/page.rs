//! `report.html`: verdict first, then pictures, then numbers, then settings.

use sincro_scene::parallel;

use super::checks::check_table;
use super::mechanism;
use super::shell::{Outcome, PLOT_SCRIPT, cell, document, list, paragraph, prose, sections, settings, table};
use super::{Energy, FindingRow, Page, SignalRow};
use crate::plot::number::{resolved, short, significant};
use crate::plot::{self, Figure, Size, escape, inline_svg};

/// The page as HTML.
pub(super) fn html(page: &Page) -> String {
    let figures = figures(&page.figures);
    let checks = check_table(&page.checks);
    let checks = if checks.is_empty() { checks } else { checks + CHECKS_KEY };
    let all = [
        ("Audit", finding_table(&page.findings)),
        ("Replay", page.replay.clone()),
        ("Figures", figures),
        ("Mechanism", page.mechanism.as_ref().map(mechanism::html).unwrap_or_default()),
        (if page.diagrams.len() > 1 { "Diagrams" } else { "Diagram" }, diagrams(&page.diagrams)),
        ("Checks", checks),
        ("Accuracy of the signals", signal_table(&page.signals)),
        ("Energy", page.energy.map(|energy| energy_line(&energy)).unwrap_or_default()),
        ("Messages", messages(&page.messages)),
        ("Settings", settings(&page.settings)),
        ("Notes", list(&page.notes)),
    ];
    let all = all.map(|(heading, content)| (heading.to_owned(), content));
    let body = [&header(page), &sections(&all), PLOT_SCRIPT].concat();
    document(&page.title, "report", &body)
}

const CHECKS_KEY: &str = "<p class=\"key\">Limit used: the share of the allowed deviation that was needed. Where a check covers \
                          a span of time, the row shows the worst instant.</p>\n";

fn header(page: &Page) -> String {
    let up = page
        .up
        .as_ref()
        .map(|(label, href)| format!("<nav><a href=\"{}\">← {}</a></nav>\n", escape(href), escape(label)));
    let outcome = Outcome::of(&page.checks, page.findings.len(), page.stop.as_ref());
    let stop = page.stop.as_ref().map(|stop| paragraph("", &stop.reason) + &paragraph("help", &stop.help));
    let warnings = match page.warnings.is_empty() {
        true => String::new(),
        false => format!("<aside class=\"warnings\">\n<h2>Warnings</h2>\n{}</aside>\n", list(&page.warnings)),
    };
    format!(
        concat!(
            "<header>\n{}<h1>{}</h1>\n{}<div class=\"banner {}\" role=\"status\">",
            "<p class=\"verdict\"><span aria-hidden=\"true\">{}</span> {}</p>{}</div>\n{}</header>\n"
        ),
        up.unwrap_or_default(),
        escape(&page.title),
        paragraph("lead", &page.description),
        outcome.class(),
        outcome.symbol(),
        outcome.sentence(),
        stop.unwrap_or_default(),
        warnings
    )
}

/// Least share of its size that a wide drawing is shrunk to; beyond, it is scrolled.
const MIN_SCALE: f64 = 0.7;

/// Drawings of the controllers.
fn diagrams(list: &[(String, String)]) -> String {
    let one = |(title, svg): &(String, String)| {
        let caption = if list.len() > 1 { paragraph("key", title) } else { String::new() };
        let width = svg.split_once("width=\"").and_then(|(_, rest)| rest.split('"').next()?.parse::<f64>().ok());
        let least = width.map_or(String::new(), |w| format!(" style=\"--least: {:.0}px\"", MIN_SCALE * w));
        format!("{caption}<div class=\"diagram\"{least}>{svg}</div>\n")
    };
    list.iter().map(one).collect()
}

/// HTML of figures, drawn on two processors.
fn figures(figures: &[Figure]) -> String {
    let all = |size: fn(&Figure) -> Size| -> Vec<String> { figures.iter().map(|f| inline_svg(f, size(f))).collect() };
    let drawn = parallel::map(2, |k| if k == 0 { all(Size::wide) } else { all(Size::narrow) });
    drawn[0].iter().zip(&drawn[1]).map(|(wide, narrow)| in_two_sizes(wide, narrow)).collect::<Vec<_>>().concat()
}

/// HTML of a figure as inline SVG in two sizes, for wide and for narrow screens, of which the style sheet of
/// [`shell::document`](super::shell::document) shows one.
#[must_use]
pub fn figure(figure: &Figure) -> String {
    in_two_sizes(&inline_svg(figure, Size::wide(figure)), &inline_svg(figure, Size::narrow(figure)))
}

fn in_two_sizes(wide: &str, narrow: &str) -> String {
    let between = "</div>\n<div class=\"narrow\">";
    ["<figure>\n<div class=\"wide\">", wide, between, narrow, "</div>\n</figure>\n"].concat()
}

/// Findings of the audit, with what would help against each.
fn finding_table(findings: &[FindingRow]) -> String {
    let columns =
        [("", "Law"), ("", "Element"), ("num", "Time"), ("num", "Value"), ("num", "Limit"), ("", "Unit"), ("", "Help")];
    let row = |finding: &FindingRow| {
        let law = finding.law.replace('-', " ");
        let run = if finding.run.is_empty() { String::new() } else { format!("{}: ", finding.run) };
        [
            cell("Law", "name", &escape(&format!("{run}{law}"))),
            cell("Element", "name", &format!("<code>{}</code>", escape(&finding.element))),
            cell("Time", "num", &plot::escape_raised(&format!("{} s", short(finding.time, 9)))),
            cell("Value", "num", &plot::escape_raised(&significant(finding.value, 3))),
            cell("Limit", "num", &plot::escape_raised(&significant(finding.limit, 2))),
            cell("Unit", "unit", &plot::escape_raised(&finding.unit)),
            cell("Help", "method", &prose(&finding.help)),
        ]
        .concat()
    };
    let rows: Vec<String> = findings.iter().map(row).collect();
    let table = table("fold", &columns, &rows);
    if table.is_empty() { table } else { table + AUDIT_KEY }
}

const AUDIT_KEY: &str = "<p class=\"key\">Largest residual of each law over the run that exceeds what the accuracy asked for \
                         allows. Residuals without a unit are relative to the largest force.</p>\n";

/// Messages of scripts and clients, in the order of time.
fn messages(messages: &[(String, String, String)]) -> String {
    let columns = [("num", "Time"), ("", "From"), ("", "Message")];
    let row = |(t, from, text): &(String, String, String)| {
        [
            cell("Time", "num", &escape(t)),
            cell("From", "name", &format!("<code>{}</code>", escape(from))),
            cell("Message", "", &escape(text)),
        ]
        .concat()
    };
    let rows: Vec<String> = messages.iter().map(row).collect();
    table("fold", &columns, &rows)
}

fn signal_table(signals: &[SignalRow]) -> String {
    let columns =
        [("", "Signal"), ("num", "Greatest magnitude"), ("num", "Error bar"), ("", "Unit"), ("", "Error estimate")];
    let rows: Vec<String> = signals.iter().map(signal_row).collect();
    table("fold", &columns, &rows)
}

fn signal_row(signal: &SignalRow) -> String {
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "<span class=\"none\">–</span>".into());
    let resolution = signal.error_bar.unwrap_or(0.0);
    let largest = |value: f64| if resolution > 0.0 { resolved(value, resolution) } else { significant(value, 4) };
    [
        cell("Signal", "name", &format!("<code>{}</code>", escape(&signal.path))),
        cell("Greatest magnitude", "num", &or_dash(signal.largest.map(|value| plot::escape_raised(&largest(value))))),
        cell(
            "Error bar",
            "num",
            &or_dash(signal.error_bar.map(|error| plot::escape_raised(&format!("± {}", significant(error, 2))))),
        ),
        cell("Unit", "unit", &plot::escape_raised(&signal.unit)),
        cell("Error estimate", "method", &escape(&signal.method)),
    ]
    .concat()
}

fn energy_line(energy: &Energy) -> String {
    let joule = |value: f64| format!("<b>{} J</b>", plot::escape_raised(&significant(value, 6)));
    let scale = [energy.start, energy.end, energy.work, energy.dissipated].iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let share = match scale > 0.0 && energy.residual.is_finite() {
        true => format!(
            ", {} of the greatest of these",
            plot::escape_raised(&significant(energy.residual.abs() / scale, 2))
        ),
        false => String::new(),
    };
    format!(
        concat!(
            "<p>{} at the start, {} at the end; motors and applied forces did {}, dampers and friction took {}. ",
            "The residual of the balance is at most <b>{} J</b>{}: zero up to integration error.</p>\n"
        ),
        joule(energy.start),
        joule(energy.end),
        joule(energy.work),
        joule(energy.dissipated),
        plot::escape_raised(&significant(energy.residual, 2)),
        share
    )
}

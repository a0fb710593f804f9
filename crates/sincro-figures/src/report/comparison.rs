//! `diff.html`: two runs beside each other, signal by signal.

use super::shell::{cell, document, paragraph, section, settings, table};
use super::{ComparisonPage, DifferenceRow};
use crate::plot::escape;
use crate::plot::number::{short, significant};

/// The page as HTML.
pub(super) fn html(page: &ComparisonPage) -> String {
    let columns = [("", "Signal"), ("num", "From"), ("num", "Greatest difference"), ("", "Unit"), ("num", "At")];
    let rows: Vec<String> = page.signals.iter().map(row).collect();
    let head = format!(
        "<header>\n<h1>Two runs</h1>\n<p class=\"lead\">{}</p>\n{}</header>\n",
        escape(&page.title),
        paragraph("", &page.verdict)
    );
    let body = [
        head,
        section("Both runs", &page.replay),
        section("Signals", &table("fold", &columns, &rows)),
        section("Other differences", &settings(&page.settings)),
    ];
    document("Two runs", "report", &body.concat())
}

fn row(d: &DifferenceRow) -> String {
    let seconds = |t: f64| format!("{} s", short(t, 6));
    let or_dash = |text: String| if d.first.is_some() { escape(&text) } else { "–".into() };
    let greatest = if d.first.is_some() { escape(&significant(d.greatest, 3)) } else { "same bits".into() };
    [
        cell("Signal", "name", &format!("<code>{}</code>", escape(&d.path))),
        cell("From", "num", &or_dash(seconds(d.first.unwrap_or(0.0)))),
        cell("Greatest difference", "num", &greatest),
        cell("Unit", "unit", &escape(&d.unit)),
        cell("At", "num", &or_dash(seconds(d.greatest_at))),
    ]
    .concat()
}

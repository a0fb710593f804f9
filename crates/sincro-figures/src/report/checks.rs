//! The table of checks: digits that show the deviation, and how much of each limit is used.

use super::shell::{cell, check_badge, table};
use super::{CheckRow, CheckVerdict, Sense};
use crate::plot::number::{fixed, resolved, short, significant};
use crate::plot::{escape, escape_raised};

/// Stands where there is no number to show.
const DASH: &str = "<span class=\"none\">–</span>";

/// The full table.
pub(super) fn check_table(checks: &[CheckRow]) -> String {
    let columns = [
        ("", "Verdict"),
        ("", "Check"),
        ("num", "Measured"),
        ("num", "Expected"),
        ("num", "Deviation"),
        ("num", "Limit"),
        ("", "Unit"),
        ("", "Limit used"),
    ];
    let rows: Vec<String> = checks.iter().map(row).collect();
    table("fold checks", &columns, &rows)
}

fn row(check: &CheckRow) -> String {
    [
        cell("Verdict", "verdict", &check_badge(check.verdict)),
        cell("Check", "name", &name(check)),
        cell("Measured", "num", &value(check, check.measured)),
        cell("Expected", "num", &expected(check)),
        cell("Deviation", "num", &deviation(check)),
        cell("Limit", "num", &limit(check)),
        cell("Unit", "unit", &escape_raised(&check.unit)),
        cell("Limit used", "margin", &margin(check)),
    ]
    .concat()
}

fn name(check: &CheckRow) -> String {
    let time = check.at.map(|t| format!("t = {} s", short(t, 9))).unwrap_or_default();
    let parts: Vec<String> = [check.about.clone(), time].into_iter().filter(|part| !part.is_empty()).collect();
    match parts.is_empty() {
        true => escape(&check.name),
        false => format!("{}<small>{}</small>", escape(&check.name), escape(&parts.join(" · "))),
    }
}

/// The expected value; a bound with its sign.
fn expected(check: &CheckRow) -> String {
    let sign = match check.sense {
        Sense::Equal => "",
        Sense::AtMost => "≤ ",
        Sense::AtLeast => "≥ ",
    };
    format!("{sign}{}", value(check, check.expected))
}

/// A bound that holds has no deviation.
fn is_within_bound(check: &CheckRow) -> bool {
    check.sense != Sense::Equal && check.deviation == 0.0
}

fn deviation(check: &CheckRow) -> String {
    let none = check.verdict == CheckVerdict::NotMade || is_within_bound(check);
    if none { DASH.into() } else { escape_raised(&significant(check.deviation, 2)) }
}

fn limit(check: &CheckRow) -> String {
    if check.sense != Sense::Equal {
        return DASH.into();
    }
    let limit = escape_raised(&short(check.limit, 3));
    if check.is_relative { format!("{limit} <small>relative</small>") } else { limit }
}

/// A value with the digits that show the deviation against its limit; a dash where there is none.
pub(super) fn value(check: &CheckRow, value: Option<f64>) -> String {
    let Some(value) = value else { return DASH.into() };
    let size = check.expected.or(check.measured).unwrap_or(value).abs();
    let resolution = if check.is_relative { check.limit * size } else { check.limit };
    if check.sense != Sense::Equal {
        return escape_raised(&significant(value, 4));
    }
    if check.expected.is_none() {
        return escape_raised(&significant(value, 3));
    }
    escape_raised(&resolved(value, resolution))
}

/// Share of the limit that is used; `None` where the two cannot be compared.
pub(super) fn share(check: &CheckRow) -> Option<f64> {
    if check.verdict == CheckVerdict::NotMade || check.sense != Sense::Equal {
        return None;
    }
    let share = if check.deviation == 0.0 && check.limit >= 0.0 { 0.0 } else { check.deviation / check.limit };
    share.is_finite().then_some(share.abs())
}

/// The share in words: `12 %`, `3.2 × limit`.
pub(super) fn share_text(share: f64) -> String {
    match share {
        0.0 => "exact".into(),
        s if s < 0.001 => "&lt; 0.1 %".into(),
        s if s < 0.0995 => format!("{} %", fixed(100.0 * s, 1)),
        s if s <= 1.0 => format!("{} %", fixed(100.0 * s, 0)),
        s => format!("{} × limit", escape_raised(&significant(s, 2))),
    }
}

/// A small bar and the same in words.
pub(super) fn margin(check: &CheckRow) -> String {
    let Some(share) = share(check) else { return DASH.into() };
    let class = if share > 1.0 { "bar over" } else { "bar" };
    let width = fixed(100.0 * share.min(1.0), 1);
    let text = share_text(share);
    format!(
        "<span class=\"{class}\" aria-hidden=\"true\"><i style=\"width:{width}%\"></i></span> <span class=\"share\">{text}</span>"
    )
}

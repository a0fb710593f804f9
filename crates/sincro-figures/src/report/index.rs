//! The index of `sincro reproduce`: one table of all experiments, then a card for each.

use super::checks::{margin, share, share_text, value};
use super::shell::{Outcome, cell, check_badge, document, list, paragraph, section, settings, table};
use super::{Card, CheckRow, CheckVerdict, IndexPage, Sense};
use crate::plot::number::short;
use crate::plot::{self, Size, escape, thumbnail};

/// Checks shown on a card.
const N_SHOWN: usize = 4;
/// Size of a thumbnail `[px]`.
const THUMBNAIL: Size = Size { width: 340.0, height: 186.0 };

/// The page as HTML.
pub(super) fn html(page: &IndexPage) -> String {
    let cards: String = page.cards.chunk_by(|a, b| a.group == b.group).map(group).collect();
    let body = [
        header(page),
        section("All experiments", &summary(&page.cards)),
        section("One by one", &cards),
        section("Made with", &settings(&page.settings)),
        section("Notes", &list(&page.notes)),
    ];
    document(&page.title, "index", &body.concat())
}

/// Cards of one group, below its heading.
fn group(cards: &[Card]) -> String {
    let heading = match cards.first().map(|card| card.group.as_str()) {
        None | Some("") => String::new(),
        Some(name) => format!("<h3 class=\"group\">{}</h3>\n", escape(name)),
    };
    format!("{heading}<div class=\"cards\">\n{}</div>\n", cards.iter().map(card).collect::<String>())
}

fn header(page: &IndexPage) -> String {
    let (class, symbol, sentence) = verdict(&page.cards);
    format!(
        concat!(
            "<header>\n<h1>{}</h1>\n{}<div class=\"banner {}\" role=\"status\">",
            "<p class=\"verdict\"><span aria-hidden=\"true\">{}</span> {}</p></div>\n</header>\n"
        ),
        escape(&page.title),
        paragraph("lead", &page.description),
        class,
        symbol,
        sentence
    )
}

/// Class, symbol and sentence for the whole gallery.
fn verdict(cards: &[Card]) -> (&'static str, &'static str, String) {
    let is_good = |card: &&Card| outcome(card).class() != "bad";
    let (n_good, n_cards) = (cards.iter().filter(is_good).count(), cards.len());
    let n_checks: usize = cards.iter().map(|card| card.checks.len()).sum();
    match (n_good, n_cards) {
        (_, 0) => ("plain", "○", "there are no experiments".into()),
        (good, all) if good == all => ("good", "✓", format!("all {all} experiments hold ({n_checks} checks)")),
        (good, all) => {
            ("bad", "✗", format!("{} of {all} experiments {} ({n_checks} checks)", all - good, fail(all - good)))
        }
    }
}

fn fail(count: usize) -> &'static str {
    if count == 1 { "fails" } else { "fail" }
}

fn outcome(card: &Card) -> Outcome {
    Outcome::of(&card.checks, card.n_findings, card.stop.as_ref())
}

fn summary(cards: &[Card]) -> String {
    let columns = [
        ("", "Verdict"),
        ("", "Experiment"),
        ("", "Source"),
        ("num", "Checks that hold"),
        ("num", "Closest to its limit"),
        ("num", "Run time"),
    ];
    let rows: Vec<String> = cards.iter().map(summary_row).collect();
    table("fold summary", &columns, &rows)
}

fn summary_row(card: &Card) -> String {
    let n_holding = card.checks.iter().filter(|check| check.verdict == CheckVerdict::Holds).count();
    let worst =
        card.checks.iter().filter_map(share).fold(None, |worst: Option<f64>, s| Some(worst.map_or(s, |w| w.max(s))));
    [
        cell("Verdict", "verdict", &outcome(card).badge()),
        cell("Experiment", "name", &link(card)),
        cell("Source", "", &escape(&card.source)),
        cell("Checks that hold", "num", &format!("{n_holding} of {}", card.checks.len())),
        cell("Closest to its limit", "num", &worst.map_or_else(|| "–".into(), share_text)),
        cell("Run time", "num", &escape(&card.run_time)),
    ]
    .concat()
}

fn link(card: &Card) -> String {
    match card.href.is_empty() {
        true => escape(&card.title),
        false => format!("<a href=\"{}\">{}</a>", escape(&card.href), escape(&card.title)),
    }
}

fn card(card: &Card) -> String {
    let outcome = outcome(card);
    let picture = card.figure.as_ref().map(|figure| thumbnail(figure, THUMBNAIL)).unwrap_or_default();
    let scene = match (card.picture.is_empty(), card.replay.is_empty()) {
        (true, _) => String::new(),
        (_, true) => format!("<div class=\"still\">{}</div>\n", card.picture),
        _ => {
            let (href, picture) = (escape(&card.replay), &card.picture);
            format!("<a class=\"still\" href=\"{href}\" title=\"see it move\">{picture}<span>▶ replay</span></a>\n")
        }
    };
    let stop = card.stop.as_ref().map(|stop| paragraph("stop", &stop.reason)).unwrap_or_default();
    format!(
        concat!(
            "<article class=\"card\">\n<div class=\"card-head\"><h3>{}</h3>{}</div>\n{}{}",
            "<figure>{}</figure>\n{}{}{}<p class=\"outcome\">{}</p>\n</article>\n"
        ),
        link(card),
        outcome.badge(),
        paragraph("source", &card.source),
        scene,
        picture,
        paragraph("", &card.summary),
        stop,
        headlines(&card.checks),
        outcome.sentence()
    )
}

/// The first few checks, measured against expected; those that do not hold come first.
fn headlines(checks: &[CheckRow]) -> String {
    let mut shown: Vec<&CheckRow> = checks.iter().collect();
    shown.sort_by_key(|check| check.verdict == CheckVerdict::Holds);
    let rows: String = shown.into_iter().take(N_SHOWN).map(headline).collect();
    if rows.is_empty() { rows } else { format!("<ul class=\"headlines\">\n{rows}</ul>\n") }
}

fn relation(sense: Sense) -> &'static str {
    match sense {
        Sense::Equal => "expected",
        Sense::AtMost => "at most",
        Sense::AtLeast => "at least",
    }
}

fn headline(check: &CheckRow) -> String {
    let failed = if check.verdict == CheckVerdict::Holds { String::new() } else { check_badge(check.verdict) + " " };
    let unit = match check.unit.is_empty() {
        true => String::new(),
        false => format!(" <small>[{}]</small>", plot::escape_raised(&check.unit)),
    };
    let expected = match check.expected {
        Some(_) => format!("<span><i>{}</i> {}</span>", relation(check.sense), value(check, check.expected)),
        None => format!("<span><i>at most</i> {}</span>", plot::escape_raised(&short(check.limit, 3))),
    };
    format!(
        concat!(
            "<li><span>{}{}{}</span><span class=\"margin\">{}</span><span class=\"values\">",
            "<span><i>measured</i> {}</span>{}</span></li>\n"
        ),
        failed,
        escape(&check.name),
        unit,
        margin(check),
        value(check, check.measured),
        expected
    )
}

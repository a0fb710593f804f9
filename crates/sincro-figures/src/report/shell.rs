//! Parts that all pages share: the document around them, the verdict, small building blocks.

use super::{CheckRow, CheckVerdict, Stop};
use crate::draw::DRAW_CSS;
use crate::plot::number::short;
use crate::plot::{self, escape, escape_raised};

/// Complete HTML document with the styles of all pages: `title` is a plain text, `class` the class of the body element,
/// `body` its content as HTML.
#[must_use]
pub fn document(title: &str, class: &str, body: &str) -> String {
    let title = escape(title);
    let (plot_css, draw_css, page_css) = (plot::PAGE_CSS, DRAW_CSS, include_str!("style.css"));
    let head = format!(
        concat!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n",
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
            "<meta name=\"color-scheme\" content=\"light dark\">\n",
            "<title>{}</title>\n<style>\n{}{}{}</style>\n</head>\n<body class=\"{}\">\n<main>\n"
        ),
        title, plot_css, draw_css, page_css, class
    );
    // pages are large: the length of the whole is known beforehand
    [&head, body, "</main>\n</body>\n</html>\n"].concat()
}

/// Outcome of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// It stopped at that time `[s]`.
    Stopped(f64),
    /// So many findings of the audit; that many of so many checks fail or could not be made.
    Found(usize, usize, usize),
    /// That many of so many checks fail or could not be made.
    Fails(usize, usize),
    /// All so many checks hold.
    Holds(usize),
    /// There was nothing to check.
    Unchecked,
}

impl Outcome {
    /// Judges a run.
    pub(super) fn of(checks: &[CheckRow], n_findings: usize, stop: Option<&Stop>) -> Self {
        let failed = checks.iter().filter(|check| check.verdict != CheckVerdict::Holds).count();
        match (stop.filter(|stop| !stop.is_good), failed, checks.len()) {
            (Some(stop), _, _) => Self::Stopped(stop.time),
            (None, failed, total) if n_findings > 0 => Self::Found(n_findings, failed, total),
            (None, 0, 0) => Self::Unchecked,
            (None, 0, total) => Self::Holds(total),
            (None, failed, total) => Self::Fails(failed, total),
        }
    }

    /// The verdict in one line.
    pub(super) fn sentence(self) -> String {
        match self {
            Self::Stopped(time) => format!("the run stopped at t = {} s", escape_raised(&short(time, 9))),
            Self::Found(n, failed, total) => {
                let plural = if n == 1 { "" } else { "s" };
                let checks = match (failed, total) {
                    (_, 0) => String::new(),
                    (0, total) => format!("; {}", Self::Holds(total).sentence()),
                    (failed, total) => format!("; {}", Self::Fails(failed, total).sentence()),
                };
                format!("the audit has {n} finding{plural}{checks}")
            }
            Self::Fails(1, 1) => "the check fails".into(),
            Self::Fails(failed @ 1, total) => format!("{failed} of {total} checks fails"),
            Self::Fails(failed, total) => format!("{failed} of {total} checks fail"),
            Self::Holds(1) => "the check holds".into(),
            Self::Holds(2) => "both checks hold".into(),
            Self::Holds(total) => format!("all {total} checks hold"),
            Self::Unchecked => "the run finished; it has no checks".into(),
        }
    }

    /// One word.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Stopped(_) => "stopped",
            Self::Found(..) | Self::Fails(..) => "fails",
            Self::Holds(_) => "holds",
            Self::Unchecked => "unchecked",
        }
    }

    /// The symbol in front of it, so that no verdict depends on colour.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Stopped(_) => "■",
            Self::Found(..) | Self::Fails(..) => "✗",
            Self::Holds(_) => "✓",
            Self::Unchecked => "○",
        }
    }

    /// The class that colours it.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Stopped(_) | Self::Found(..) | Self::Fails(..) => "bad",
            Self::Holds(_) => "good",
            Self::Unchecked => "plain",
        }
    }

    /// Symbol and word as a coloured piece of text.
    pub(super) fn badge(self) -> String {
        badge(self.class(), self.symbol(), self.word())
    }
}

/// Symbol and word as a coloured piece of text.
#[must_use]
pub(crate) fn badge(class: &str, symbol: &str, word: &str) -> String {
    format!("<span class=\"badge {class}\"><span aria-hidden=\"true\">{symbol}</span> {word}</span>")
}

/// Symbol and word of one check.
pub(super) fn check_badge(verdict: CheckVerdict) -> String {
    match verdict {
        CheckVerdict::Holds => badge("good", "✓", "holds"),
        CheckVerdict::Fails => badge("bad", "✗", "fails"),
        CheckVerdict::NotMade => badge("plain", "○", "not made"),
    }
}

/// A section with a heading; nothing if its content is empty.
#[must_use]
pub(crate) fn section(heading: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    let opening = format!("<section id=\"{}\">\n<h2>{heading}</h2>\n", anchor(heading));
    [&opening, content, "</section>\n"].concat()
}

/// Name of a section in addresses.
fn anchor(heading: &str) -> String {
    heading.to_lowercase().replace(' ', "-")
}

/// HTML of sections, each given by its heading (plain words) and its content as HTML, with links to them in front if
/// there are several; those without content are left out.
#[must_use]
pub fn sections(all: &[(String, String)]) -> String {
    let filled = || all.iter().filter(|(_, content)| !content.is_empty());
    let link = |(heading, _): &(String, String)| format!("<a href=\"#{}\">{heading}</a>\n", anchor(heading));
    let links: String = if filled().count() > 1 { filled().map(link).collect() } else { String::new() };
    let contents = match links.is_empty() {
        true => links,
        false => format!("<nav class=\"contents\" aria-label=\"Contents\">\n{links}</nav>\n"),
    };
    let written = filled().map(|(heading, content)| section(heading, content));
    std::iter::once(contents).chain(written).collect::<Vec<_>>().concat()
}

/// HTML element with the script that reads values from the figures of a page and magnifies them; put it once, behind
/// the figures.
pub const PLOT_SCRIPT: &str = concat!("<script>\n", include_str!("plot.js"), "</script>\n");

/// HTML of a table cell: `label` names the column where the table is folded on a phone, `class` may be empty, `content`
/// is HTML.
#[must_use]
pub fn cell(label: &str, class: &str, content: &str) -> String {
    let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
    format!("<td{class} data-label=\"{label}\">{content}</td>")
}

/// HTML of a table: for each column its class and heading, in the order of the cells; for each row its cells from
/// [`cell`], joined. Empty if there are no rows.
#[must_use]
pub fn table(class: &str, columns: &[(&str, &str)], rows: &[String]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let head: String =
        columns.iter().map(|(class, name)| format!("<th scope=\"col\" class=\"{class}\">{name}</th>")).collect();
    let body: String = rows.iter().map(|row| format!("<tr>{row}</tr>\n")).collect();
    format!("<table class=\"{class}\">\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>\n")
}

/// HTML of names and values (plain texts) in two columns, in their order; empty if there are none.
#[must_use]
pub fn settings(settings: &[(String, String)]) -> String {
    if settings.is_empty() {
        return String::new();
    }
    let rows: String =
        settings.iter().map(|(name, value)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(value))).collect();
    format!("<dl class=\"settings\">\n{rows}</dl>\n")
}

/// HTML of a list of sentences (plain texts, names between backticks set as code); empty if there are none.
#[must_use]
pub fn list(items: &[String]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: String = items.iter().map(|item| format!("<li>{}</li>\n", prose(item))).collect();
    format!("<ul>\n{items}</ul>\n")
}

/// HTML of a paragraph of a class from a plain text, names between backticks set as code; empty if the text is.
#[must_use]
pub fn paragraph(class: &str, text: &str) -> String {
    if text.trim().is_empty() { String::new() } else { format!("<p class=\"{class}\">{}</p>\n", prose(text)) }
}

/// Escaped text in which names between backticks are set as code, as in the messages of a terminal.
#[must_use]
pub(crate) fn prose(text: &str) -> String {
    let escaped = escape(text);
    let pieces: Vec<&str> = escaped.split('`').collect();
    if pieces.len().is_multiple_of(2) {
        return escaped;
    }
    let set =
        |(i, piece): (usize, &&str)| if i % 2 == 1 { format!("<code>{piece}</code>") } else { (*piece).to_owned() };
    pieces.iter().enumerate().map(set).collect()
}

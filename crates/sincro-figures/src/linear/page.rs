//! `report.html` of a linearised scene: what it is, how it behaves, channel by channel, then the matrices.

use super::text::{self, StateTable};
use super::{Analysis, Channel, MAX_CHANNELS, figures};
use crate::plot::number::significant;
use crate::plot::{Figure, escape, escape_raised};
use crate::report::page::figure;
use crate::report::shell::{PLOT_SCRIPT, document, list, paragraph, sections};

/// Report page of a linear system as one HTML text, with its figures inline.
#[must_use]
pub fn html(analysis: &Analysis) -> String {
    let banner = format!(
        "<header>\n<h1>{}</h1>\n{}<div class=\"banner plain\" role=\"status\"><p class=\"verdict\">{}</p></div>\n</header>\n",
        escape(&analysis.title),
        paragraph("lead", &text::summary(analysis)),
        text::stability(analysis)
    );
    let poles = table(&StateTable::poles(analysis)) + &list(&text::reach_lines(analysis));
    let map = if analysis.channels.is_empty() { figures_of(&[figures::map(analysis, None)]) } else { String::new() };
    let mut all = vec![
        ("Poles".to_owned(), poles + &map),
        ("Reduced to independent coordinates".to_owned(), list(&analysis.reduction)),
    ];
    all.extend(analysis.shown().iter().map(|channel| channel_section(analysis, channel)));
    all.push(("Channels".to_owned(), overview(analysis)));
    all.push(("Open loops".to_owned(), open_loops(analysis)));
    all.push(("Matrices".to_owned(), matrices(analysis)));
    document(&analysis.title, "report", &(banner + &sections(&all) + PLOT_SCRIPT))
}

/// Heading and content of the section about a channel.
fn channel_section(analysis: &Analysis, channel: &Channel) -> (String, String) {
    let name = analysis.name(channel);
    let name = name[..1].to_uppercase() + &name[1..];
    let shown =
        [figures::bode(analysis, channel), figures::map(analysis, Some(channel)), figures::step(analysis, channel)];
    (escape(&name), figures_of(&shown) + &paragraph("", &step_words(channel)))
}

/// Rise time, overshoot and settling time of the step response, in one sentence.
fn step_words(channel: &Channel) -> String {
    let Some(info) = channel.step.info else { return String::new() };
    let value = |x: f64| significant(x, 3);
    let overshoot = match info.overshoot {
        share if share < 1e-3 => "without overshoot".to_owned(),
        share => format!("overshoots by {} % at {} s", value(100.0 * share), value(info.peak_time)),
    };
    format!(
        "It rises from 10 % to 90 % in {} s, {overshoot}, and stays within 2 % from {} s on.",
        value(info.rise_time),
        value(info.settling_time)
    )
}

fn figures_of(shown: &[Figure]) -> String {
    let all: String = shown.iter().map(figure).collect();
    format!("<div class=\"figures\">\n{all}</div>\n")
}

fn overview(analysis: &Analysis) -> String {
    let rest = analysis.unshown();
    let rest = match rest.len() {
        0 => String::new(),
        n => paragraph(
            "key",
            &format!("The first {MAX_CHANNELS} channels are drawn; the other {n} are in `bode.csv` and `step.csv`."),
        ),
    };
    let content = table(&StateTable::channels(analysis)) + &list(&analysis.silent) + &rest;
    if analysis.channels.is_empty() { list(&analysis.silent) } else { content + MARGINS_KEY }
}

fn open_loops(analysis: &Analysis) -> String {
    if analysis.loops.is_empty() {
        return String::new();
    }
    let shown: Vec<Figure> = analysis.loops.iter().map(figures::loop_bode).collect();
    table(&StateTable::loops(analysis)) + &paragraph("key", &text::loop_notes(analysis).join(" ")) + &figures_of(&shown)
}

const MARGINS_KEY: &str = "<p class=\"key\">Margins are those of the loop closed by −1 around the channel: how much gain or phase lag it \
                           bears. A dash: the curve does not cross.</p>\n";

fn matrices(analysis: &Analysis) -> String {
    let inputs = analysis.system.inputs.iter().enumerate();
    let inputs: Vec<String> = inputs.map(|(k, input)| format!("u{} is {}", k + 1, text::named(input))).collect();
    let tables = StateTable::matrices(analysis).into_iter();
    let tables: String = tables.map(|(title, matrix)| format!("<h3>{title}</h3>\n{}", table(&matrix))).collect();
    list(&inputs) + &tables
}

/// A table that scrolls sideways if the screen is narrow.
fn table(table: &StateTable) -> String {
    let class = |k: usize| if k == 0 { "name" } else { "num" };
    let row = |cells: &[String], tag: &str| -> String {
        let cell =
            |(k, text): (usize, &String)| format!("<{tag} class=\"{}\">{}</{tag}>", class(k), escape_raised(text));
        cells.iter().enumerate().map(cell).collect()
    };
    let body: String = table.rows.iter().map(|cells| format!("<tr>{}</tr>\n", row(cells, "td"))).collect();
    format!(
        "<div class=\"scroll\">\n<table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>\n</div>\n",
        row(&table.head, "th")
    )
}

//! The report as a page of its own, without scripts.

use super::Report;
use crate::number::short;
use crate::source::ElementStatus;

const STYLE: &str = include_str!("style.css");
/// Elements that the page lists; the JSON file has all.
const MAX_ROWS: usize = 5_000;

/// Text of the page.
pub(super) fn page(report: &Report) -> String {
    let mut out = String::new();
    let robot = escaped(&report.robot);
    out += &format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>Import of {robot}</title>\n<style>\n{STYLE}</style></head>\n<body><main>\n<h1>{robot}</h1>\n\
         <p class=\"sub\">Import of <code>{}</code> ({}) by sincro {}</p>\n",
        escaped(&report.source),
        report.format,
        report.sincro
    );
    tiles(&mut out, report);
    comparison(&mut out, report);
    list(
        &mut out,
        "Repairs",
        report.repairs.iter().map(|r| {
            format!(
                "<code>--repair {}</code>, link <code>{}</code> (line {}): {}",
                r.repair,
                escaped(&r.link),
                r.line,
                words(&r.what)
            )
        }),
    );
    list(&mut out, "Collision meshes that are missing", report.missing_collision_meshes.iter().map(|m| words(m)));
    list(
        &mut out,
        "Warnings",
        report.warnings.iter().map(|w| {
            let line = w.line.map_or_else(String::new, |line| format!("line {line}: "));
            let help =
                w.help.as_ref().map_or_else(String::new, |h| format!(" <span class=\"help\">{}</span>", words(h)));
            format!("{line}{}{help}", words(&w.message))
        }),
    );
    list(&mut out, "Choices that the source leaves open", report.choices.iter().map(|c| words(c)));
    links(&mut out, report);
    elements(&mut out, report);
    out += "</main></body></html>\n";
    out
}

fn tiles(out: &mut String, report: &Report) {
    let value = |name: &str| report.comparison.iter().find(|c| c.quantity == name).map_or(0.0, |c| c.after);
    let counts = report.counts;
    *out += "<div class=\"tiles\">\n";
    for (value, words) in [
        (short(value("total mass")) + " kg", "total mass"),
        (short(value("degrees of freedom")), "degrees of freedom"),
        (short(value("reach")) + " m", "reach"),
    ] {
        *out += &format!("<div class=\"tile\"><b>{value}</b><span>{words}</span></div>\n");
    }
    for (n, class, words) in [
        (counts.kept, "kept", "elements kept"),
        (counts.changed, "changed", "changed"),
        (counts.dropped, "dropped", "dropped"),
    ] {
        *out += &format!("<div class=\"tile\"><b class=\"{class}\">{n}</b><span>{words}</span></div>\n");
    }
    *out += "</div>\n<div class=\"bar\">";
    for (n, class) in [(counts.kept, "kept"), (counts.changed, "changed"), (counts.dropped, "dropped")] {
        *out += &format!("<i class=\"{class}\" style=\"flex:{n}\"></i>");
    }
    *out += "</div>\n";
}

fn comparison(out: &mut String, report: &Report) {
    *out += "<h2>Before and after</h2>\n<div class=\"wide\"><table><tr><th>quantity</th><th class=\"n\">in the source</th>\
             <th class=\"n\">in the scene</th><th>unit</th><th></th></tr>\n";
    for row in &report.comparison {
        *out += &format!(
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td>{}</tr>\n",
            row.quantity,
            exact(row.before),
            exact(row.after),
            row.unit,
            verdict(row.equal)
        );
    }
    *out += "</table></div>\n";
}

/// Up to nine digits.
fn exact(x: f64) -> String {
    let text = format!("{x:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn verdict(equal: bool) -> &'static str {
    if equal { "<td class=\"same\">same</td>" } else { "<td class=\"differs\">differs</td>" }
}

fn list(out: &mut String, title: &str, items: impl Iterator<Item = String>) {
    let items: Vec<String> = items.map(|item| format!("<li>{item}</li>")).collect();
    if !items.is_empty() {
        *out += &format!("<h2>{title}</h2>\n<ul>\n{}\n</ul>\n", items.join("\n"));
    }
}

fn links(out: &mut String, report: &Report) {
    *out += "<h2>Mass and principal moments of the links</h2>\n<div class=\"wide\"><table><tr><th>link</th><th class=\"n\">line</th>\
             <th class=\"n\">mass [kg]</th><th class=\"n\">moments in the source [kg·m²]</th><th class=\"n\">in the scene</th><th></th></tr>\n";
    for row in &report.links {
        let mass = row.before.or(row.after).map_or_else(|| "–".to_owned(), |(m, _)| short(m));
        let mass = match (row.before, row.after) {
            (Some((m, _)), Some((n, _))) if short(m) != short(n) => format!("{} → {}", short(m), short(n)),
            _ => mass,
        };
        let moments =
            |of: &Option<(f64, [f64; 3])>| of.map_or_else(|| "–".to_owned(), |(_, i)| i.map(short).join("&ensp;"));
        *out += &format!(
            "<tr><td><code>{}</code></td><td class=\"n\">{}</td><td class=\"n\">{mass}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>{}</tr>\n",
            escaped(&row.link),
            row.line,
            moments(&row.before),
            moments(&row.after),
            verdict(row.equal)
        );
    }
    *out += "</table></div>\n";
}

fn elements(out: &mut String, report: &Report) {
    *out += "<h2>Every element of the source</h2>\n<div class=\"filter\">\
             <label><input type=\"checkbox\" id=\"show-kept\"> <span class=\"kept\">kept</span></label>\
             <label><input type=\"checkbox\" id=\"show-changed\" checked> <span class=\"changed\">changed</span></label>\
             <label><input type=\"checkbox\" id=\"show-dropped\" checked> <span class=\"dropped\">dropped</span></label></div>\n\
             <div class=\"wide\"><table><tr><th class=\"n\">line</th><th>element</th><th>fate</th><th>how, why</th></tr>\n";
    for entry in report.elements.iter().take(MAX_ROWS) {
        let (class, word) = match entry.status {
            ElementStatus::Kept => ("kept", "kept"),
            ElementStatus::Changed => ("changed", "changed"),
            ElementStatus::Dropped => ("dropped", "dropped"),
        };
        let inside = if entry.inside { " inside" } else { "" };
        *out += &format!(
            "<tr class=\"{class}{inside}\"><td class=\"n\">{}</td><td><code>{}</code></td><td><span class=\"{class}\">{word}</span></td><td>{}</td></tr>\n",
            entry.line,
            escaped(&entry.element),
            words(&entry.words)
        );
    }
    *out += "</table></div>\n";
    if report.elements.len() > MAX_ROWS {
        let more = report.elements.len() - MAX_ROWS;
        *out += &format!("<p class=\"help\">{more} more are in import-report.json.</p>\n");
    }
}

/// A message: names between backticks in their own type.
fn words(text: &str) -> String {
    let parts = escaped(text);
    let parts = parts.split('`').enumerate();
    parts.map(|(k, part)| if k % 2 == 1 { format!("<code>{part}</code>") } else { part.to_owned() }).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

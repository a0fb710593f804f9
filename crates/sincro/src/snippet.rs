//! Text of a problem for the terminal: message, place, the line of the file with a mark below, remedy.

use sincro_scene::diagnostic::Diagnostic;
use unicode_width::UnicodeWidthStr;

/// Characters of a line that are shown; of longer lines those around the mark.
const MAX_LINE: usize = 160;
/// Characters shown before the mark in a line that is cut.
const BEFORE: usize = 40;

/// Returns the text of a problem, without a line break at its end; with the control sequences of colours if
/// `has_colour`.
pub(crate) fn render(diagnostic: &Diagnostic, has_colour: bool) -> String {
    let paint = |code: &str, text: &str| match has_colour {
        true => format!("\x1b[{code}m{text}\x1b[0m"),
        false => text.to_owned(),
    };
    let (word, colour) = if diagnostic.is_error() { ("error", "1;31") } else { ("warning", "1;33") };
    let mut text = format!("{}: {}", paint(colour, word), diagnostic.message);
    let mut margin = 1;
    if let (Some(source), Some(span), Some((line, column))) =
        (&diagnostic.source, &diagnostic.span, diagnostic.line_column())
    {
        margin = (line + 1).to_string().len();
        let gap = " ".repeat(margin);
        text += &format!("\n{gap}{} {}:{line}:{column}", paint("34", "-->"), source.path.display());
        let bar = paint("34", "|");
        text += &format!("\n{gap} {bar}");
        let all: Vec<&str> = source.text.split('\n').map(|l| l.trim_end_matches('\r')).collect();
        let of = |k: usize| all.get(k.wrapping_sub(1)).copied();
        let numbered = |k: usize, content: &str| {
            format!("\n{} {bar} {content}", paint("34", &format!("{k:>margin$}"))).trim_end().to_owned()
        };
        let begin = column - 1;
        let marked = of(line).unwrap_or("");
        let n_marked = source.text.get(span.clone()).map_or(0, |t| t.split('\n').next().unwrap_or("").chars().count());
        let (shown, skipped) = cut(marked, begin);
        let head: String = shown.chars().take(begin - skipped).collect();
        let body: String = shown.chars().skip(begin - skipped).take(n_marked).collect();
        let marks = "^".repeat(body.width().max(1));
        text += &of(line - 1).map(|before| numbered(line - 1, &cut(before, 0).0)).unwrap_or_default();
        text += &numbered(line, &shown);
        text += &format!("\n{gap} {bar} {}{}", blank(&head), paint(colour, &marks));
        // the empty text behind the last line break is no line
        let after = of(line + 1).filter(|after| !after.is_empty() || line + 1 < all.len());
        text += &after.map(|after| numbered(line + 1, &cut(after, 0).0)).unwrap_or_default();
    }
    if let Some(help) = &diagnostic.help {
        let gap = " ".repeat(margin);
        let next = format!("\n{gap}         ");
        text += &format!("\n{gap} = {}: {}", paint("36", "help"), help.replace('\n', &next));
    }
    text
}

/// As wide as a text, and empty; tabs stay, since their width is the terminal's.
fn blank(text: &str) -> String {
    text.split('\t').map(|part| " ".repeat(part.width())).collect::<Vec<_>>().join("\t")
}

/// A line, or of a long one the part about character `at`, and the number of characters left out before that part.
fn cut(line: &str, at: usize) -> (String, usize) {
    if line.chars().count() <= MAX_LINE {
        return (line.to_owned(), 0);
    }
    let skipped = at.saturating_sub(BEFORE);
    (line.chars().skip(skipped).take(MAX_LINE).collect(), skipped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sincro_scene::diagnostic::{Location, SourceText};
    use std::sync::Arc;

    fn at(text: &str, marked: &str) -> Location {
        let start = text.find(marked).unwrap();
        let source = Arc::new(SourceText { path: "scene.toml".into(), text: text.into() });
        Location { source, span: start..start + marked.len() }
    }

    #[test]
    fn the_mark_stands_below_what_is_wrong() {
        let found =
            Diagnostic::error(&at("a = 1\nmass = -2 # kg\nb = 3\n", "-2"), "`mass` is -2").with_help("more\nlines");
        let expected = "error: `mass` is -2\n --> scene.toml:2:8\n  |\n1 | a = 1\n2 | mass = -2 # kg\n  |        ^^\n3 | b = 3\n  = \
                        help: more\n          lines";
        assert_eq!(render(&found, false), expected);
        // nothing but colours is added
        let coloured = render(&found, true);
        let mut plain = String::new();
        for (k, part) in coloured.split('\x1b').enumerate() {
            plain += if k == 0 { part } else { &part[part.find('m').unwrap() + 1..] };
        }
        assert_eq!(plain, expected);
    }

    #[test]
    fn marks_keep_their_place_behind_tabs_and_wide_letters() {
        let lines = |text: &str, marked: &str| {
            let text = render(&Diagnostic::error(&at(text, marked), "m").as_warning(), false);
            text.lines().skip(3).map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(lines("\tx = é1", "1"), ["1 | \tx = é1", "  | \t     ^"]);
        assert_eq!(lines("\"机器\" = 1", "1"), ["1 | \"机器\" = 1", "  |          ^"]);
        // a mark over several lines ends with its first
        assert_eq!(lines("ab\ncd", "b\nc"), ["1 | ab", "  |  ^", "2 | cd"]);
    }

    #[test]
    fn long_lines_show_the_part_about_the_mark() {
        let text = format!("list = [{}9.5, {}]", "1, ".repeat(400), "2, ".repeat(400));
        let shown = render(&Diagnostic::error(&at(&text, "9.5"), "m"), false);
        let lines: Vec<&str> = shown.lines().collect();
        let (line, mark) = (lines[3], lines[4]);
        assert!(line.len() < 200 && line[mark.find('^').unwrap()..].starts_with("9.5"), "{shown}");
    }
}

//! Text inside XML and HTML: escaping, estimated widths, wrapping, superscripts.
//!
//! [`escape`] is the one place where text of scenes and scripts is made harmless, for pictures and pages alike.

/// Escapes a text for element content and for quoted attributes, in XML and HTML. Characters that XML forbids become
/// `�`.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\0'..='\x1f' | '\x7f'..='\u{9f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
    out
}

/// Escapes a text for HTML content and sets its superscripts as `<sup>`: for numbers and units such as `10⁻⁹ m/s²`.
#[must_use]
pub fn escape_raised(text: &str) -> String {
    raised(text, |run| format!("<sup>{run}</sup>"))
}

/// Content of an SVG `<text>`: escaped, superscripts raised by hand.
pub(crate) fn rich(text: &str, font_size: f64) -> String {
    let rise = super::number::coordinate(0.36 * font_size);
    // A zero-width space carries the way back down, so that the shift ends also where nothing follows.
    raised(text, |run| {
        format!("<tspan dy=\"-{rise}\" font-size=\"72%\">{run}</tspan><tspan dy=\"{rise}\">\u{200b}</tspan>")
    })
}

/// Escapes text and gives runs of superscripts to `raise` as plain digits: many fonts lack `⁻⁹` or draw it badly.
fn raised(text: &str, raise: impl Fn(&str) -> String) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(is_superscript) {
        let run_end = rest[start..].find(|c| !is_superscript(c)).map_or(rest.len(), |length| start + length);
        let lowered: String = rest[start..run_end].chars().map(lower).collect();
        out.push_str(&escape(&rest[..start]));
        out.push_str(&raise(&lowered));
        rest = &rest[run_end..];
    }
    out.push_str(&escape(rest));
    out
}

/// Estimated width of text in a common sans-serif font `[px]`; errs on the wide side, since the reader's font is
/// unknown.
pub(crate) fn width(text: &str, font_size: f64) -> f64 {
    let ems: f64 = text.chars().map(char_width).sum();
    ems * font_size
}

/// `text`, or as much of it as fits into `available` pixels, with an ellipsis.
pub(super) fn fit(text: &str, font_size: f64, available: f64) -> String {
    if width(text, font_size) <= available {
        return text.into();
    }
    let mut kept = String::new();
    for c in text.chars() {
        kept.push(c);
        if width(&kept, font_size) + font_size > available {
            kept.pop();
            break;
        }
    }
    format!("{}…", kept.trim_end())
}

/// As [`fit`], with the ellipsis in the middle where text has a path: its end says most.
pub(super) fn fit_middle(text: &str, font_size: f64, available: f64) -> String {
    if width(text, font_size) <= available || !text.contains('/') {
        return fit(text, font_size, available);
    }
    let chars: Vec<char> = text.chars().collect();
    let room = (available - font_size).max(0.0);
    let total = |part: &[char]| part.iter().map(|c| char_width(*c)).sum::<f64>() * font_size;
    let head = (0..chars.len()).take_while(|&n| total(&chars[..n]) <= 0.3 * room).last().unwrap_or(0);
    let left = room - total(&chars[..head]);
    let tail = (0..chars.len() - head).take_while(|&n| total(&chars[chars.len() - n..]) <= left).last().unwrap_or(0);
    chars[..head].iter().chain(&['…']).chain(&chars[chars.len() - tail..]).collect()
}

/// Breaks text at spaces into at most `max_lines` lines; the last one is cut with an ellipsis if it must be.
pub(super) fn wrap(text: &str, font_size: f64, available: f64, max_lines: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let is_last = lines.len() == max_lines;
        let has_room = |line: &str| width(line, font_size) + width(word, font_size) + 0.4 * font_size <= available;
        match lines.last_mut() {
            Some(line) if is_last || has_room(line) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines.iter().map(|line| fit(line, font_size, available)).collect()
}

fn char_width(c: char) -> f64 {
    match c {
        '\u{200b}' => 0.0,
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' | '·' | '/' => 0.29,
        'f' | 't' | 'r' | 'I' | '(' | ')' | '[' | ']' | '-' => 0.37,
        _ if is_superscript(c) => 0.44,
        'm' | 'w' => 0.88,
        'M' | 'W' | '@' | '%' | '…' | '—' | '→' => 0.98,
        '\u{1100}'.. => 1.0,
        _ if c.is_uppercase() => 0.70,
        _ => 0.565,
    }
}

fn is_superscript(c: char) -> bool {
    matches!(c, '¹' | '²' | '³' | '⁰' | '⁴'..='⁹' | '⁺' | '⁻')
}

fn lower(c: char) -> char {
    match c {
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁰' => '0',
        '⁴'..='⁹' => char::from(b'4' + (c as u32 - '⁴' as u32) as u8),
        '⁺' => '+',
        _ => '−',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_names_is_escaped() {
        assert_eq!(escape(r#"<b a="1">&'x'"#), "&lt;b a=&quot;1&quot;&gt;&amp;&#39;x&#39;");
    }

    #[test]
    fn characters_forbidden_in_xml_are_replaced() {
        assert_eq!(escape("a\0b\u{1b}\u{ffff}"), "a\u{fffd}b\u{fffd}\u{fffd}");
    }

    #[test]
    fn superscripts_are_raised_and_come_down_again() {
        let text = rich("[10⁻⁹ rad]", 10.0);
        assert_eq!(text, "[10<tspan dy=\"-3.6\" font-size=\"72%\">−9</tspan><tspan dy=\"3.6\">\u{200b}</tspan> rad]");
    }

    #[test]
    fn long_text_is_wrapped_then_cut() {
        let lines = wrap("a long title that does not fit on one line nor on two of them", 10.0, 120.0, 2);
        assert_eq!(lines.len(), 2);
        assert!(lines[1].ends_with('…'));
        assert!(lines.iter().all(|line| width(line, 10.0) <= 130.0));
    }

    #[test]
    fn a_word_wider_than_the_line_is_cut() {
        assert!(fit("incomprehensibilities", 10.0, 40.0).chars().count() < 8);
    }
}

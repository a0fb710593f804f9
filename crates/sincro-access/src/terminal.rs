//! Texts of clients on a terminal.

/// Makes a text of a client safe for a terminal: control characters (tabulators excepted) and marks of writing
/// direction, which could drive the terminal or forge a line, become escapes such as `\u{1b}`.
///
/// ```
/// assert_eq!(sincro_access::printable("t = 1 s\u{1b}[2J\nforged"), "t = 1 s\\u{1b}[2J\\nforged");
/// ```
#[must_use]
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if (c.is_control() && c != '\t') || turns || matches!(c, '\u{2028}' | '\u{2029}') {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
}

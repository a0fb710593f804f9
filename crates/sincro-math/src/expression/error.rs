//! Errors of formulas.

use core::fmt;
use core::ops::Range;

/// Error of [`Expression::parse`](super::Expression::parse): description and position of the first fault in a formula.
///
/// ```
/// use sincro_math::expression::Expression;
///
/// let error = Expression::parse("2 * omga", &["omega"]).unwrap_err();
/// assert_eq!(error.to_string(), "column 5: unknown name `omga`\nhelp: did you mean `omega`?");
/// assert_eq!(error.span, 4..8);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// Description: lower case, names in backticks.
    pub message: String,
    /// Range of the bytes of the formula that are wrong, counted from 0; empty at the end of the formula where
    /// something is missing.
    pub span: Range<usize>,
    /// Position of the first wrong character, in characters counted from 1.
    pub column: usize,
    /// Suggested correction, such as a name that is spelled similarly; `None` where there is none.
    pub help: Option<String>,
}

impl ParseError {
    pub(super) fn new(text: &str, span: Range<usize>, message: String) -> Self {
        let column = 1 + text[..span.start].chars().count();
        Self { message, span, column, help: None }
    }

    pub(super) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}", self.column, self.message)?;
        match &self.help {
            Some(help) => write!(f, "\nhelp: {help}"),
            None => Ok(()),
        }
    }
}

impl core::error::Error for ParseError {}

/// The known name nearest to `name`, if it is near enough to have been meant.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let length = name.chars().count();
    if length > MAX_COMPARED {
        return None;
    }
    let reach = (length / 3).max(1);
    let distances = known.filter(|k| k.len() <= 4 * MAX_COMPARED).map(|k| (edit_distance(name, k), k));
    // a single letter is near to every other one: only a case or prime apart counts
    let near = distances.filter(|&(d, k)| d <= reach && (length > 1 || k.eq_ignore_ascii_case(name) || k.len() > 1));
    near.min_by_key(|&(d, _)| d).map(|(_, k)| k)
}

/// Longer names are not compared: the work grows with the square of the length.
const MAX_COMPARED: usize = 64;

/// Edit distance: number of letters that must be inserted, removed, replaced or swapped with their neighbour to turn
/// `a` into `b`, without regard to case.
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (letters(a), letters(b));
    // rows of the table of distances between beginnings of a and of b: the row before last, the last, the current one
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(before[j - 2] + 1);
            }
            row.push(least);
        }
        before = core::mem::replace(&mut last, row);
    }
    last[b.len()]
}

fn letters(name: &str) -> Vec<char> {
    name.chars().flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_counts_edits() {
        for (a, b, distance) in [
            ("", "abc", 3),
            ("omega", "omga", 1),
            ("Sin", "sin", 0),
            ("ab", "xy", 2),
            // neighbours swapped at the beginning, in the middle, at the end
            ("ba", "ab", 1),
            ("sni", "sin", 1),
            ("omgea", "omega", 1),
            ("torqeu", "torque", 1),
            ("stiffnses", "stiffness", 1),
        ] {
            assert_eq!(edit_distance(a, b), distance, "{a} {b}");
            assert_eq!(edit_distance(b, a), distance, "{b} {a}");
        }
    }

    #[test]
    fn only_a_near_name_is_offered() {
        let known = ["omega", "torque", "x"];
        assert_eq!(nearest("omga", known.into_iter()), Some("omega"));
        assert_eq!(nearest("troque", known.into_iter()), Some("torque"));
        assert_eq!(nearest("X", known.into_iter()), Some("x"));
        assert_eq!(nearest("y", known.into_iter()), None);
        assert_eq!(nearest("stiffness", known.into_iter()), None);
        // a single letter: another one is no offer, a longer name is; and it is one for a name of two letters
        assert_eq!(nearest("y", ["yy"].into_iter()), Some("yy"));
        assert_eq!(nearest("xy", ["x"].into_iter()), Some("x"));
        // the lengths that are compared are those of letters, not of bytes
        let long = "θ".repeat(40);
        assert_eq!(nearest(&"θ".repeat(39), [long.as_str()].into_iter()), Some(long.as_str()));
    }
}

//! The words of a Lua text, as far as [`crate::power`] needs them: where each begins and ends, and what sort it is.
//!
//! Source: Lua 5.4 reference manual, §3.1. A text that is no Lua is cut up somehow; the compiler says what is wrong
//! with it.

use std::ops::Range;

/// Sorts of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sort {
    /// A name that is no keyword.
    Name,
    /// A keyword that is a value: `nil`, `true`, `false`.
    Constant,
    /// Any other keyword.
    Keyword,
    /// A number.
    Number,
    /// A text in quotes or long brackets.
    Text,
    /// Anything else, such as `(` or `..`.
    Symbol,
}

/// A word of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Word {
    /// Its sort.
    pub sort: Sort,
    /// Its bytes.
    pub at: Range<usize>,
}

const KEYWORDS: [&str; 19] = [
    "and", "break", "do", "else", "elseif", "end", "for", "function", "goto", "if", "in", "local", "not", "or",
    "repeat", "return", "then", "until", "while",
];

/// Symbols of more than one character, the longest first.
const SYMBOLS: [&str; 11] = ["...", "..", "==", "~=", "<=", ">=", "//", "::", "<<", ">>", "="];

/// All words, comments and blanks left out.
pub(crate) fn words(text: &str) -> Vec<Word> {
    let bytes = text.as_bytes();
    let (mut out, mut at) = (Vec::new(), 0);
    // a first line that begins with # is for the shell
    if text.starts_with('#') {
        at = line_end(bytes, 0);
    }
    while at < bytes.len() {
        let start = at;
        let sort = match bytes[at] {
            b if b.is_ascii_whitespace() => {
                at += 1;
                continue;
            }
            b'-' if bytes[at..].starts_with(b"--") => {
                at = comment_end(bytes, at);
                continue;
            }
            b'"' | b'\'' => {
                at = quoted_end(bytes, at);
                Sort::Text
            }
            b'[' if long_level(bytes, at).is_some() => {
                at = long_end(bytes, at);
                Sort::Text
            }
            b if b.is_ascii_digit() || (b == b'.' && bytes.get(at + 1).is_some_and(u8::is_ascii_digit)) => {
                at = number_end(bytes, at);
                Sort::Number
            }
            b if b.is_ascii_alphabetic() || b == b'_' => {
                while bytes.get(at).is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'_') {
                    at += 1;
                }
                match &text[start..at] {
                    "nil" | "true" | "false" => Sort::Constant,
                    word if KEYWORDS.contains(&word) => Sort::Keyword,
                    _ => Sort::Name,
                }
            }
            _ => {
                let symbol = SYMBOLS.iter().find(|s| bytes[at..].starts_with(s.as_bytes()));
                at += symbol.map_or_else(|| text[at..].chars().next().map_or(1, char::len_utf8), |s| s.len());
                Sort::Symbol
            }
        };
        out.push(Word { sort, at: start..at });
    }
    out
}

fn line_end(bytes: &[u8], at: usize) -> usize {
    bytes[at..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |n| at + n)
}

fn comment_end(bytes: &[u8], at: usize) -> usize {
    if long_level(bytes, at + 2).is_some() { long_end(bytes, at + 2) } else { line_end(bytes, at) }
}

/// Number of `=` in an opening long bracket at `at`, if there is one.
fn long_level(bytes: &[u8], at: usize) -> Option<usize> {
    let rest = bytes.get(at..)?.strip_prefix(b"[")?;
    let level = rest.iter().take_while(|b| **b == b'=').count();
    (rest.get(level) == Some(&b'[')).then_some(level)
}

fn long_end(bytes: &[u8], at: usize) -> usize {
    let level = long_level(bytes, at).unwrap_or(0);
    let closing: Vec<u8> = [b"]".to_vec(), vec![b'='; level], b"]".to_vec()].concat();
    let from = at + level + 2;
    let rest = bytes.get(from..).unwrap_or_default();
    rest.windows(closing.len()).position(|w| w == closing).map_or(bytes.len(), |n| from + n + closing.len())
}

fn quoted_end(bytes: &[u8], at: usize) -> usize {
    let quote = bytes[at];
    let mut k = at + 1;
    while let Some(&b) = bytes.get(k) {
        match b {
            b'\\' => k += 2,
            b'\n' => return k,
            b if b == quote => return k + 1,
            _ => k += 1,
        }
    }
    bytes.len()
}

fn number_end(bytes: &[u8], at: usize) -> usize {
    let is_hex = bytes[at] == b'0' && matches!(bytes.get(at + 1), Some(b'x' | b'X'));
    let exponent: &[u8] = if is_hex { b"pP" } else { b"eE" };
    let mut k = at;
    while let Some(&b) = bytes.get(k) {
        let is_sign = matches!(b, b'+' | b'-') && k > at && exponent.contains(&bytes[k - 1]);
        if !(b.is_ascii_alphanumeric() || b == b'.' || b == b'_' || is_sign) {
            break;
        }
        // `1..2` joins two numbers
        if b == b'.' && bytes.get(k + 1) == Some(&b'.') {
            break;
        }
        k += 1;
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(text: &str) -> Vec<&str> {
        words(text).into_iter().map(|w| &text[w.at]).collect()
    }

    #[test]
    fn comments_and_texts_hide_what_is_in_them() {
        assert_eq!(cut("a --[[ ^ \n ]] ^ b -- ^ c"), ["a", "^", "b"]);
        assert_eq!(cut("x = 'it\\'s ^' .. [==[ ]] ^ ]==]"), ["x", "=", "'it\\'s ^'", "..", "[==[ ]] ^ ]==]"]);
    }

    #[test]
    fn numbers_have_signs_in_exponents_only() {
        assert_eq!(
            cut("1e-6-2 0x1p+4+1 .5^3 1..2"),
            ["1e-6", "-", "2", "0x1p+4", "+", "1", ".5", "^", "3", "1", "..", "2"]
        );
    }
}

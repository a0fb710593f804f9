//! A formula cut into tokens.

use core::ops::Range;

use super::error::ParseError;
use super::eval::Binary;

/// The smallest unit of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'t> {
    Number(f64),
    /// A name of a value or a function, primes included.
    Name(&'t str),
    Operator(Binary),
    Not,
    Open,
    Close,
    Comma,
    End,
}

/// Reads tokens one after the other.
pub(super) struct Lexer<'t> {
    text: &'t str,
    position: usize,
}

impl<'t> Lexer<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self { text, position: 0 }
    }

    /// The next token and where it stands; [`Token::End`] at the end, again and again.
    pub(super) fn next(&mut self) -> Result<(Token<'t>, Range<usize>), ParseError> {
        let rest = self.text[self.position..].trim_start();
        let start = self.text.len() - rest.len();
        let Some(first) = rest.chars().next() else {
            return Ok((Token::End, start..start));
        };
        let (token, length) = if first.is_ascii_digit() || first == '.' {
            number(self.text, start)?
        } else if starts_name(first) {
            let name = &rest[..name_length(rest)];
            (word(name), name.len())
        } else {
            symbol(self.text, start)?
        };
        self.position = start + length;
        Ok((token, start..self.position))
    }
}

/// Returns true if a name may begin with it.
pub(super) fn starts_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// Length in bytes of the name that `text` begins with: letters, digits, `_`, single dots inside, primes at the end.
pub(super) fn name_length(text: &str) -> usize {
    let mut length = 0;
    let mut characters = text.char_indices().peekable();
    while let Some((at, c)) = characters.next() {
        let joins = c == '.' && characters.peek().is_some_and(|&(_, next)| starts_name(next));
        if !(c.is_alphanumeric() || c == '_' || joins) {
            break;
        }
        length = at + c.len_utf8();
    }
    let primes = text[length..].len() - text[length..].trim_start_matches('\'').len();
    length + primes
}

fn word(name: &str) -> Token<'_> {
    match name {
        "and" => Token::Operator(Binary::And),
        "or" => Token::Operator(Binary::Or),
        "not" => Token::Not,
        _ => Token::Name(name),
    }
}

/// The number at `start`: digits, a fraction, an exponent.
fn number(text: &str, start: usize) -> Result<(Token<'_>, usize), ParseError> {
    let bytes = text.as_bytes();
    let digits_from = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = start + digits_from(start);
    if bytes.get(end) == Some(&b'.') {
        end += 1 + digits_from(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let signed = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let digits = digits_from(end + 1 + signed);
        if digits > 0 {
            end += 1 + signed + digits;
        }
    }
    let written = &text[start..end];
    let fail = |message: &str, end: usize| ParseError::new(text, start..end, message.to_owned());
    let Ok(value) = written.parse::<f64>() else {
        return Err(fail(&format!("`{written}` is not a number"), end));
    };
    if !value.is_finite() {
        return Err(fail(&format!("number `{written}` is too large"), end).with_help("the largest is 1.79e308"));
    }
    let next = text[end..].chars().next();
    if next.is_some_and(|c| starts_name(c) || c == '.') {
        return Err(joined_to_name(text, start, end));
    }
    Ok((Token::Number(value), end - start))
}

/// The error for `2x`, `1e`, `1.2.3`.
fn joined_to_name(text: &str, start: usize, end: usize) -> ParseError {
    let rest = &text[end..];
    let length = name_length(rest);
    let (number, name) = (&text[start..end], &rest[..length]);
    if name.is_empty() {
        return ParseError::new(text, start..end + 1, format!("`{number}.` is not a number"));
    }
    ParseError::new(text, start..end + length, format!("missing operator between `{number}` and `{name}`"))
        .with_help(format!("a product is written `{number}*{name}`"))
}

/// The operator or bracket at `start`.
fn symbol(text: &str, start: usize) -> Result<(Token<'_>, usize), ParseError> {
    let rest = &text[start..];
    let two = match rest.get(..2) {
        Some("<=") => Some(Binary::LessEqual),
        Some(">=") => Some(Binary::GreaterEqual),
        Some("==") => Some(Binary::Equal),
        Some("!=") => Some(Binary::NotEqual),
        Some(wrong @ ("**" | "&&" | "||")) => return Err(unknown_symbol(text, start, wrong)),
        _ => None,
    };
    if let Some(operator) = two {
        return Ok((Token::Operator(operator), 2));
    }
    let token = match rest.as_bytes()[0] {
        b'+' => Token::Operator(Binary::Add),
        b'-' => Token::Operator(Binary::Sub),
        b'*' => Token::Operator(Binary::Mul),
        b'/' => Token::Operator(Binary::Div),
        b'^' => Token::Operator(Binary::Pow),
        b'<' => Token::Operator(Binary::Less),
        b'>' => Token::Operator(Binary::Greater),
        b'(' => Token::Open,
        b')' => Token::Close,
        b',' => Token::Comma,
        _ => {
            let length = rest.chars().next().map_or(0, char::len_utf8);
            return Err(unknown_symbol(text, start, &rest[..length]));
        }
    };
    Ok((token, 1))
}

fn unknown_symbol(text: &str, start: usize, symbol: &str) -> ParseError {
    let shown: String = symbol.chars().flat_map(char::escape_debug).collect();
    let error = ParseError::new(text, start..start + symbol.len(), format!("unexpected `{shown}`"));
    let help = match symbol {
        "**" | "²" | "³" => "a power is written `x^2`",
        "&&" | "&" => "write `and`",
        "||" | "|" => "write `or`",
        "!" => "write `not`, or `!=` for unequal",
        "=" => "equality is written `==`",
        "≤" => "write `<=`",
        "≥" => "write `>=`",
        "≠" => "write `!=`",
        "·" | "×" => "a product is written `*`",
        "−" | "–" => "minus is written `-`",
        "÷" => "a quotient is written `/`",
        "√" => "write `sqrt(x)`",
        "[" | "]" | "{" | "}" => "only round brackets group",
        "%" => "a remainder is written `mod(x, modulus)`",
        ";" => "arguments are separated by `,`, decimals by `.`",
        _ => return error,
    };
    error.with_help(help)
}

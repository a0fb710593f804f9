//! `a ^ b` with the same bits on every machine.
//!
//! Lua's operator is the `pow` of the platform's C library, whose last bit differs from machine to machine, and no
//! metamethod can change it for numbers. So `a ^ b` becomes a call `__pow(a, b)` before the text is compiled, lines
//! staying where they are. `x ^ 2` stays: Lua itself computes it as x·x.
//!
//! Precedence (Lua 5.4 reference manual, §3.4.8): `^` binds tighter than a unary operator on its left, less than one on
//! its right, and to the right: `-a^-b^c` is `-(a^(-(b^c)))`.

use crate::lexer::{Sort, Word, words};

/// Name of the function that powers become calls of.
pub(crate) const POWER: &str = "__pow";

/// The text with its powers as calls. A text that is no Lua, or a power of something that is no plain expression, stays
/// as it is.
pub(crate) fn with_calls(text: &str) -> String {
    if !text.contains('^') {
        return text.to_owned();
    }
    let words = words(text);
    let reader = Reader { text, words: &words, partners: partners(text, &words) };
    let mut edits: Vec<(usize, String)> = Vec::new();
    for k in 0..words.len() {
        if reader.symbol(k) != Some("^") {
            continue;
        }
        let (Some(first), Some(last)) = (reader.operand_before(k), reader.operand_after(k + 1, 0)) else { continue };
        if last == k + 1 && &text[words[last].at.clone()] == "2" {
            continue;
        }
        let (start, end) = (words[first].at.start, words[last].at.end);
        edits.push((start, format!("{POWER}(")));
        edits.push((words[k].at.start, ",".to_owned()));
        edits.push((end, ")".to_owned()));
    }
    apply(text, edits)
}

/// Puts texts in; a `,` takes the place of the `^` at its position.
fn apply(text: &str, mut edits: Vec<(usize, String)>) -> String {
    // at one place: closing brackets of what ends there before what begins
    edits.sort_by_key(|(at, new)| (*at, new != ")"));
    let (mut out, mut done) = (String::with_capacity(text.len() + 16 * edits.len()), 0);
    for (at, new) in edits {
        out.push_str(&text[done..at]);
        out.push_str(&new);
        done = if new == "," { at + 1 } else { at };
    }
    out.push_str(&text[done..]);
    out
}

/// Powers of powers that are read; the compiler refuses deeper ones.
const MAX_DEPTH: usize = 200;

struct Reader<'a> {
    text: &'a str,
    words: &'a [Word],
    /// Word of the other bracket, for each word that is a bracket of a pair.
    partners: Vec<Option<usize>>,
}

/// The other bracket of each pair; brackets of any kind are pairs, the compiler says which are not.
fn partners(text: &str, words: &[Word]) -> Vec<Option<usize>> {
    let (mut partners, mut open) = (vec![None; words.len()], Vec::new());
    for (k, word) in words.iter().enumerate().filter(|(_, word)| word.sort == Sort::Symbol) {
        match &text[word.at.clone()] {
            "(" | "[" | "{" => open.push(k),
            ")" | "]" | "}" => {
                if let Some(start) = open.pop() {
                    partners[start] = Some(k);
                    partners[k] = Some(start);
                }
            }
            _ => {}
        }
    }
    partners
}

impl Reader<'_> {
    fn sort(&self, k: usize) -> Option<Sort> {
        self.words.get(k).map(|w| w.sort)
    }

    fn symbol(&self, k: usize) -> Option<&str> {
        let word = self.words.get(k)?;
        matches!(word.sort, Sort::Symbol | Sort::Keyword).then(|| &self.text[word.at.clone()])
    }

    /// First word of the expression that ends before word `k`.
    fn operand_before(&self, k: usize) -> Option<usize> {
        let mut at = k.checked_sub(1)?;
        loop {
            let previous = |at: usize| at.checked_sub(1);
            match (self.sort(at)?, self.symbol(at)) {
                (Sort::Number | Sort::Constant, _) => return Some(at),
                (Sort::Text, _) => match previous(at) {
                    // f"text" is a call
                    Some(p) if self.ends_expression(p) => at = p,
                    _ => return Some(at),
                },
                (Sort::Name, _) => match previous(at).map(|p| (p, self.symbol(p))) {
                    Some((p, Some("." | ":"))) => at = previous(p)?,
                    _ => return Some(at),
                },
                (_, Some(")" | "]" | "}")) => {
                    let is_index = self.symbol(at) == Some("]");
                    let open = self.partners[at]?;
                    match previous(open) {
                        Some(p) if self.ends_expression(p) => at = p,
                        _ if is_index => return None,
                        _ => return Some(open),
                    }
                }
                (_, Some("...")) => return Some(at),
                _ => return None,
            }
        }
    }

    /// Returns true if a call or an index may follow word `k`.
    fn ends_expression(&self, k: usize) -> bool {
        match self.sort(k) {
            Some(Sort::Name | Sort::Text) => true,
            Some(Sort::Symbol) => matches!(self.symbol(k), Some(")" | "]" | "}")),
            _ => false,
        }
    }

    /// Last word of the operand that begins at word `k`: unary operators, an expression, and a power of it.
    fn operand_after(&self, mut k: usize, depth: usize) -> Option<usize> {
        if depth > MAX_DEPTH {
            return None;
        }
        while matches!(self.symbol(k), Some("-" | "not" | "#" | "~")) {
            k += 1;
        }
        let end = match (self.sort(k)?, self.symbol(k)) {
            (Sort::Number | Sort::Constant | Sort::Text, _) | (_, Some("...")) => k,
            (Sort::Name, _) => self.suffixes_after(k)?,
            (_, Some("(")) => self.suffixes_after(self.partners[k]?)?,
            (_, Some("{")) => self.partners[k]?,
            _ => return None,
        };
        if self.symbol(end + 1) == Some("^") { self.operand_after(end + 2, depth + 1) } else { Some(end) }
    }

    /// Last word of the indices and calls that follow word `k`, or `k`.
    fn suffixes_after(&self, mut k: usize) -> Option<usize> {
        loop {
            k = match (self.sort(k + 1), self.symbol(k + 1)) {
                (_, Some("." | ":")) if self.sort(k + 2) == Some(Sort::Name) => k + 2,
                (_, Some("(" | "[" | "{")) => self.partners[k + 1]?,
                (Some(Sort::Text), _) => k + 1,
                _ => return Some(k),
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::with_calls;

    #[test]
    fn powers_become_calls_with_the_operands_of_the_grammar() {
        let cases = [
            ("x = a^b", "x = __pow(a,b)"),
            ("-a^3", "-__pow(a,3)"),
            ("a^-b^c", "__pow(a,-__pow(b,c))"),
            ("2^3^4", "__pow(2,__pow(3,4))"),
            ("(c2+s)^(1/3)", "__pow((c2+s),(1/3))"),
            ("t.a[i].b(c, d):e'f'^3 + 1", "__pow(t.a[i].b(c, d):e'f',3) + 1"),
            ("return (f)(x)^k(2)[1].y", "return __pow((f)(x),k(2)[1].y)"),
            ("x^2 + y ^ 2", "x^2 + y ^ 2"),
            ("x^2^0.5", "__pow(x,2^0.5)"),
            ("'^' --^\n..a", "'^' --^\n..a"),
            ("a\n^\n3", "__pow(a\n,\n3)"),
        ];
        for (text, expected) in cases {
            // an exponent that is a power itself is a call too
            let expected = expected.replace("2^0.5", "__pow(2,0.5)");
            assert_eq!(with_calls(text), expected, "{text}");
        }
    }

    #[test]
    fn long_texts_take_time_in_proportion() {
        // a chain of powers deeper than the compiler goes, and brackets in brackets
        let n = 100_000;
        let chain = "1^".repeat(n) + "1";
        assert!(with_calls(&chain).len() < 20 * n);
        let nested = "(".repeat(n) + "a" + &")^3".repeat(n);
        assert_eq!(with_calls(&nested).len(), nested.len() + n * "__pow()".len());
    }

    #[test]
    fn what_is_no_expression_stays() {
        for text in ["^", "a ^", "^ b", "x = )^3", "[[ ^"] {
            assert_eq!(with_calls(text), text);
        }
    }
}

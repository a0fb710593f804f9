//! `goto` as a name.
//!
//! Up to version 5.1 of Lua, which V-REP and CoppeliaSim up to 4.1 ran, `goto` was a name like any other:
//! `function goto(x, y)`. Since 5.2 it is a keyword, and such a text does not compile. A text in which it is a name,
//! and never a statement, gets another name in its place before it is compiled; lines stay where they are.

use std::borrow::Cow;

use crate::lexer::{Sort, Word, words};

/// Name that takes the place of `goto`.
pub(crate) const REPLACEMENT: &str = "__goto";

/// The keyword of Lua 5.2 that was a name before.
const KEYWORD: &str = "goto";

/// The text with `goto` renamed where it is a name. A text with a statement `goto label` stays as it is.
pub(crate) fn renamed(text: &str) -> Cow<'_, str> {
    if !text.contains(KEYWORD) {
        return Cow::Borrowed(text);
    }
    let words = words(text);
    let at = |k: usize| words.get(k).map(|word| &text[word.at.clone()]);
    let found: Vec<usize> = (0..words.len()).filter(|k| at(*k) == Some(KEYWORD)).collect();
    // in a statement the name of a label follows
    let is_statement = |k: &usize| {
        let is_after_name = k.checked_sub(1).and_then(at).is_some_and(|word| matches!(word, "." | ":" | "function"));
        !is_after_name && words.get(k + 1).is_some_and(|next| next.sort == Sort::Name)
    };
    if found.is_empty() || found.iter().any(is_statement) {
        return Cow::Borrowed(text);
    }
    let (mut out, mut done) = (String::with_capacity(text.len() + 2 * found.len()), 0);
    for Word { at, .. } in found.into_iter().map(|k| &words[k]) {
        out.push_str(&text[done..at.start]);
        out.push_str(REPLACEMENT);
        done = at.end;
    }
    out.push_str(&text[done..]);
    Cow::Owned(out)
}

/// The name under which a text that was compiled has what others call `name`.
pub(crate) fn inside(name: &str) -> &str {
    if name == KEYWORD { REPLACEMENT } else { name }
}

#[cfg(test)]
mod tests {
    use super::renamed;

    #[test]
    fn goto_is_renamed_where_it_is_a_name() {
        for (text, expected) in [
            ("function goto(x) return x end goto(2)", "function __goto(x) return x end __goto(2)"),
            ("local t = { goto = 1 }\nt.goto = t.goto + 1", "local t = { __goto = 1 }\nt.__goto = t.__goto + 1"),
            ("function M:goto() end M:goto()", "function M:__goto() end M:__goto()"),
            ("goto(1) -- goto\nsay('goto')", "__goto(1) -- goto\nsay('goto')"),
        ] {
            assert_eq!(renamed(text), expected);
        }
    }

    #[test]
    fn statements_and_texts_without_it_stay() {
        for text in ["for i = 1, 3 do goto next ::next:: end", "x = 'goto' -- goto(1)", "goto_start()", "y = 1"] {
            assert_eq!(renamed(text), text);
        }
    }
}

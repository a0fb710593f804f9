//! Levels of the paths of objects, such as `link[1]` and `wheel*`.

/// One level of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    /// Name with `*` and `?`.
    pub pattern: Vec<char>,
    /// i of `[i]`: the match that is meant among the objects of the level, counted from 0.
    pub among: Option<usize>,
}

/// `ball` of `ball12` and of `ball#12`: the name that copies of the scene language and of V-REP are numbered after.
#[must_use]
pub fn copied(name: &str) -> Option<&str> {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let stem = stem.strip_suffix('#').unwrap_or(stem);
    (!stem.is_empty() && stem.len() < name.len()).then_some(stem)
}

/// `name[3]` as its parts; none if it is no name.
#[must_use]
pub fn element(text: &str) -> Option<Element> {
    let (name, among) = match split_number(text, '[', ']') {
        Some((name, k)) => (name, Some(k)),
        None => (text, None),
    };
    (!name.is_empty()).then(|| Element { pattern: name.chars().collect(), among })
}

/// `text(3)` as `text` and 3, for the given brackets.
#[must_use]
pub fn split_number(text: &str, open: char, close: char) -> Option<(&str, usize)> {
    let (head, number) = text.strip_suffix(close)?.rsplit_once(open)?;
    Some((head, number.parse().ok()?))
}

/// Returns true if a name fits a pattern with `*` and `?`; time grows with the product of their lengths at most.
#[must_use]
pub fn fits(pattern: &[char], name: &str) -> bool {
    let name: Vec<char> = name.chars().collect();
    let (mut p, mut n, mut retry) = (0, 0, None);
    while n < name.len() {
        if p < pattern.len() && pattern[p] == '*' {
            retry = Some((p, n));
            p += 1;
        } else if p < pattern.len() && (pattern[p] == '?' || pattern[p] == name[n]) {
            (p, n) = (p + 1, n + 1);
        } else if let Some((star, at)) = retry {
            (p, n, retry) = (star + 1, at + 1, Some((star, at + 1)));
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|c| *c == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fit_patterns() {
        let fits_text = |pattern: &str, name: &str| fits(&pattern.chars().collect::<Vec<_>>(), name);
        for (pattern, name) in [("wheel*", "wheel12"), ("*", ""), ("?oint", "joint"), ("a*b*c", "a-b-b-c")] {
            assert!(fits_text(pattern, name), "{pattern} {name}");
        }
        assert!(!fits_text("wheel?", "wheel") && !fits_text("a*b", "a-b-c"));
    }

    #[test]
    fn numbers_of_levels_are_split_off() {
        let level = element("link[12]").unwrap();
        assert_eq!((level.pattern, level.among), ("link".chars().collect(), Some(12)));
        assert_eq!((element("[1]"), copied("ball12"), copied("12")), (None, Some("ball"), None));
        assert_eq!((copied("ball#0"), copied("#0")), (Some("ball"), None));
    }
}

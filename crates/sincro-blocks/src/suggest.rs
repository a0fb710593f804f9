//! Names that may have been meant.

/// A name that is nearer than this (Jaro–Winkler, 1 = the same) was probably meant.
const NEAR: f64 = 0.8;

/// Known name that `name` was probably meant to be, for error messages: the nearest with a Jaro–Winkler similarity of
/// 0.8 or more, letter case ignored; `None` if none is near.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = name.to_lowercase();
    let scored = known.into_iter().map(|k| (strsim::jaro_winkler(&wanted, &k.to_lowercase()), k));
    scored.filter(|(score, _)| *score >= NEAR).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}

/// Help text of an error message: "did you mean …?" with the nearest of the `known` names, if one is near; else
/// `otherwise`.
#[must_use]
pub fn help<'a>(name: &str, known: impl IntoIterator<Item = &'a str>, otherwise: &str) -> String {
    match nearest(name, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => otherwise.to_owned(),
    }
}

/// Returns names in backticks, separated by commas.
#[must_use]
pub fn quoted(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// Number of known names that are listed.
const LISTED: usize = 8;

/// Returns the help line of a message about the unknown name `name`: the nearest of the names `known` if one is
/// similar, and up to eight of them, nearest first. `what` names the whole set, such as `keys here` or `columns`.
#[must_use]
pub fn help_with_list(name: &str, known: &[&str], what: &str) -> String {
    let list = listing(name, known);
    match nearest(name, known.iter().copied()) {
        Some(near) if known.len() == 1 => format!("did you mean `{near}`?"),
        Some(near) => format!("did you mean `{near}`? {what}: {list}"),
        None if known.is_empty() => format!("{what}: none"),
        None => format!("{what}: {list}"),
    }
}

/// Up to eight of the names in backticks, nearest first where there are more.
fn listing(name: &str, known: &[&str]) -> String {
    let mut names: Vec<&str> = known.to_vec();
    if names.len() > LISTED {
        let score = |k: &str| strsim::jaro_winkler(name, k);
        names.sort_by(|a, b| score(b).total_cmp(&score(a)));
    }
    let shown: Vec<String> = names.iter().take(LISTED).map(|k| format!("`{k}`")).collect();
    let more = names.len().saturating_sub(LISTED);
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_offered_first() {
        let known = ["stiffness", "rest"];
        assert_eq!(
            help_with_list("stifness", &known, "keys here"),
            "did you mean `stiffness`? keys here: `stiffness`, `rest`"
        );
        assert_eq!(help_with_list("colour", &known, "keys here"), "keys here: `stiffness`, `rest`");
        assert_eq!(nearest("Mass", ["mass"]), Some("mass"));
        assert_eq!(help_with_list("x", &[], "objects"), "objects: none");
    }

    #[test]
    fn long_lists_are_cut() {
        let known: Vec<String> = (0..12).map(|k| format!("joint{k}")).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        assert!(help_with_list("velocity", &known, "joints").ends_with("and 4 more"));
    }
}

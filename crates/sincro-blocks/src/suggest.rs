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

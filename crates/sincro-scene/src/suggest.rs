//! "Did you mean": the known names nearest to an unknown one.

pub use sincro_blocks::suggest::nearest;

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
pub fn help(name: &str, known: &[&str], what: &str) -> String {
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
        assert_eq!(help("stifness", &known, "keys here"), "did you mean `stiffness`? keys here: `stiffness`, `rest`");
        assert_eq!(help("colour", &known, "keys here"), "keys here: `stiffness`, `rest`");
        assert_eq!(nearest("Mass", ["mass"]), Some("mass"));
        assert_eq!(help("x", &[], "objects"), "objects: none");
    }

    #[test]
    fn long_lists_are_cut() {
        let known: Vec<String> = (0..12).map(|k| format!("joint{k}")).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        assert!(help("velocity", &known, "joints").ends_with("and 4 more"));
    }
}

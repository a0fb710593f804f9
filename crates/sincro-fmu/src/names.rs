//! Names of variables in the structured naming convention of FMI: `/arm/elbow.position` becomes `arm.elbow.position`.

use std::collections::BTreeSet;

/// Gives structured names, each once.
#[derive(Debug, Default)]
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    /// The structured name of a signal or a path of a setting; a name that is taken gets the suffix.
    pub(crate) fn add(&mut self, name: &str, suffix: &str) -> String {
        let plain = structured(name);
        let mut candidate = plain.clone();
        let mut k = 1;
        while !self.0.insert(candidate.clone()) {
            candidate = if k == 1 { format!("{plain}{suffix}") } else { format!("{plain}{suffix}{k}") };
            k += 1;
        }
        candidate
    }
}

/// The name with its identifiers separated by dots, those that are none in quotes.
pub(crate) fn structured(name: &str) -> String {
    let flat = name.trim_start_matches('/').replace('/', ".");
    flat.split('.').filter(|part| !part.is_empty()).map(identifier).collect::<Vec<_>>().join(".")
}

/// One identifier, with the index of a component as it is.
fn identifier(part: &str) -> String {
    let (stem, index) = match part.split_once('[') {
        Some((stem, index)) if is_index(index) => part.split_at(stem.len()),
        _ => (part, ""),
    };
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if stem.chars().all(is_plain) && stem.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        return part.to_owned();
    }
    // characters that quotes may not hold are replaced: an escape would be read differently by different tools
    let may_be_quoted = |c: char| is_plain(c) || "!#$%&()*+,-/:;<>=?@[]^{}|~ ".contains(c);
    let quoted: String = stem.chars().map(|c| if may_be_quoted(c) { c } else { '_' }).collect();
    format!("'{quoted}'{index}")
}

fn is_index(text: &str) -> bool {
    text.strip_suffix(']').is_some_and(|digits| !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit()))
}

/// An identifier of the language C from any text, for the name of a library.
pub(crate) fn c_identifier(text: &str) -> String {
    let plain: String = text.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("scene_{plain}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_structured_names() {
        assert_eq!(structured("/shoulder/elbow.position"), "shoulder.elbow.position");
        assert_eq!(structured("reference[0]"), "reference[0]");
        assert_eq!(structured("/cardan.position.1"), "cardan.position.'1'");
        assert_eq!(structured("/left-hand.mass"), "'left-hand'.mass");
        assert_eq!(structured("/it's.mass"), "'it_s'.mass");
    }

    #[test]
    fn no_name_is_given_twice() {
        let mut names = Names::default();
        assert_eq!(names.add("/a.command", "_held"), "a.command");
        assert_eq!(names.add("/a.command", "_held"), "a.command_held");
        assert_eq!(names.add("/a.command", "_held"), "a.command_held2");
    }

    #[test]
    fn libraries_have_names_of_c() {
        assert_eq!(c_identifier("two-dof-position"), "two_dof_position");
        assert_eq!(c_identifier("3d"), "scene_3d");
    }
}

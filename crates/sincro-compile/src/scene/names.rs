//! Names in C, of objects and signals of a scene.

use std::collections::BTreeSet;

use sincro_dynamics::model::Model;
use sincro_scene::record::{Probe, catalogue};

/// Part of an identifier of C for a name such as `/arm/hinge.position`.
fn identifier(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_alphanumeric() {
            text.push(c);
        } else if !text.is_empty() && !text.ends_with('_') {
            text.push('_');
        }
    }
    text.trim_end_matches('_').to_owned()
}

/// Text that does not end a comment of C.
pub(super) fn comment_text(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *")
}

/// Identifiers for a list of names, all different.
pub(super) fn identifiers<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    names
        .map(|name| {
            let stem = identifier(name);
            let numbered = (2..).map(|n| format!("{stem}_{n}"));
            let free = std::iter::once(stem.clone()).chain(numbered).find(|name| taken.insert(name.clone()));
            free.expect("numbers do not end")
        })
        .collect()
}

/// Number of a state or command: name as it is recorded, and unit.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub name: String,
    pub unit: String,
}

/// Names and units of coordinates, velocities, rotor states and commands.
pub(super) fn of_state(model: &Model<f64>) -> [Vec<Named>; 4] {
    let all = catalogue(model);
    let of = |n: usize, what: &str, probe: &dyn Fn(usize) -> Probe| -> Vec<Named> {
        (0..n)
            .map(|k| match all.iter().find(|entry| entry.probe == probe(k)) {
                Some(entry) => Named { name: entry.name.clone(), unit: entry.unit.to_string() },
                None => Named { name: format!("{what} {k}"), unit: String::new() },
            })
            .collect()
    };
    let elements = (0..model.n_rotor_states()).map(|k| Named { name: format!("element {k}"), unit: String::new() });
    [
        of(model.n_q(), "coordinate", &Probe::Coordinate),
        of(model.n_v(), "velocity", &Probe::Rate),
        elements.collect(),
        of(model.n_commands(), "command", &Probe::Command),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_differ() {
        let names = ["/a/b", "/a_b", "/a/b_2", "/a b", "a.b"];
        assert_eq!(identifiers(names.into_iter()), ["a_b", "a_b_2", "a_b_2_2", "a_b_3", "a_b_4"]);
        assert_eq!(comment_text("a*/b/*c"), "a* /b/ *c");
    }
}

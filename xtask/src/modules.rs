//! Imports among the top-level modules of a crate, measured from the source text of non-test code, and the cycles among
//! them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Crates whose top-level modules form no cycle.
const ACYCLIC: [&str; 15] = [
    "sincro-math",
    "sincro-complementarity",
    "sincro-geometry",
    "sincro-contact",
    "sincro-integrate",
    "sincro-camera",
    "sincro-aero",
    "sincro-actuation",
    "sincro-motion",
    "sincro-planning",
    "sincro-vision",
    "sincro-dynamics",
    "sincro-scene",
    "sincro-sim",
    "sincro-coppelia",
];

/// Modules that each module imports, with the first file that does.
type Imports = BTreeMap<String, BTreeMap<String, String>>;

/// Reports one cycle for each crate of [`ACYCLIC`] that has any.
pub fn check(texts: &[(String, String)], found: &mut Vec<String>) {
    for name in ACYCLIC {
        if let Some(cycle) = cycle(&imports(name, texts)) {
            found.push(format!("the modules of {name} form a cycle: {cycle}"));
        }
    }
}

/// Imports among the top-level modules of crate `name`; `texts` are paths from the repository's root and contents.
fn imports(name: &str, texts: &[(String, String)]) -> Imports {
    let folder = format!("crates/{name}/src/");
    let mut imports = Imports::new();
    let lib = texts.iter().find(|(path, _)| *path == format!("{folder}lib.rs"));
    let exported = lib.map_or_else(BTreeMap::new, |(_, text)| exports(&without_tests(text)));
    for (path, text) in texts {
        let Some(inside) = path.strip_prefix(&folder) else { continue };
        let module = inside.split('/').next().unwrap_or("").trim_end_matches(".rs");
        let stem = Path::new(inside).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        if ["lib", "main", "prelude"].contains(&module) || stem.ends_with("tests") {
            continue;
        }
        let own = imports.entry(module.to_owned()).or_default();
        let used = paths(&without_tests(text)).into_iter().map(|name| exported.get(&name).cloned().unwrap_or(name));
        for used in used.filter(|used| used != module) {
            own.entry(used).or_insert_with(|| inside.to_owned());
        }
    }
    let modules: BTreeSet<String> = imports.keys().cloned().collect();
    imports.values_mut().for_each(|used| used.retain(|module, _| modules.contains(module)));
    imports
}

/// Text without comments and without the inline modules under `#[cfg(test)]`.
fn without_tests(text: &str) -> String {
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
    let code = code.join("\n");
    let mut parts = code.split("#[cfg(test)]");
    let mut out = parts.next().unwrap_or("").to_owned();
    for part in parts {
        // the item ends at its semicolon or at the brace that closes it
        let (mut depth, mut end) = (0_i32, part.len());
        for (at, c) in part.char_indices() {
            depth += i32::from(c == '{') - i32::from(c == '}');
            if depth == 0 && (c == ';' || c == '}') {
                end = at + 1;
                break;
            }
        }
        out.push_str(&part[end..]);
    }
    out
}

/// First segment of every path that begins with `crate::`, groups in braces taken apart.
fn paths(code: &str) -> BTreeSet<String> {
    let mut out = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        let is_inside_a_word = code[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_');
        if is_inside_a_word {
            continue;
        }
        let rest = &code[at + "crate::".len()..];
        let Some(group) = rest.strip_prefix('{') else {
            out.insert(first_word(rest));
            continue;
        };
        let (mut depth, mut start) = (0_i32, 0);
        for (k, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                ',' if depth == 0 => {
                    out.insert(first_word(&group[start..k]));
                    start = k + 1;
                }
                '}' if depth == 0 => {
                    out.insert(first_word(&group[start..k]));
                    break;
                }
                '}' => depth -= 1,
                _ => {}
            }
        }
    }
    out
}

/// Names that the root of a crate exports again, each with the module it comes from.
fn exports(code: &str) -> BTreeMap<String, String> {
    let mut out = BTreeMap::new();
    for statement in code.split("pub use ").skip(1) {
        let statement = statement.split(';').next().unwrap_or("");
        let module = first_word(statement);
        let words = statement[module.len()..].split(|c: char| !c.is_alphanumeric() && c != '_');
        out.extend(words.filter(|word| !word.is_empty()).map(|word| (word.to_owned(), module.clone())));
    }
    out
}

fn first_word(text: &str) -> String {
    text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// A shortest cycle, each step with the file that makes it; none if there is no cycle.
fn cycle(imports: &Imports) -> Option<String> {
    let mut shortest: Option<Vec<&str>> = None;
    for start in imports.keys() {
        if let Some(found) = way_back(imports, start)
            && shortest.as_ref().is_none_or(|known| found.len() < known.len())
        {
            shortest = Some(found);
        }
    }
    let nodes = shortest?;
    let step = |k: usize| {
        let (from, to) = (nodes[k], nodes[(k + 1) % nodes.len()]);
        format!("{from} -> {to} ({})", imports[from][to])
    };
    Some((0..nodes.len()).map(step).collect::<Vec<_>>().join(", "))
}

/// Modules on a shortest way from `start` back to it, breadth first.
fn way_back<'a>(imports: &'a Imports, start: &'a str) -> Option<Vec<&'a str>> {
    let mut ways = vec![vec![start]];
    let mut seen = BTreeSet::new();
    let mut k = 0;
    while k < ways.len() {
        let last = ways[k][ways[k].len() - 1];
        for next in imports[last].keys() {
            if next == start {
                return Some(ways[k].clone());
            }
            if seen.insert(next.as_str()) {
                let mut way = ways[k].clone();
                way.push(next);
                ways.push(way);
            }
        }
        k += 1;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(files: &[(&str, &str)]) -> Vec<(String, String)> {
        files.iter().map(|(path, text)| (format!("crates/x/src/{path}"), (*text).to_owned())).collect()
    }

    #[test]
    fn a_cycle_is_named_with_the_files_that_make_it() {
        let files = [
            ("a/mod.rs", "use crate::{b::{One, Two}, d};\n"),
            ("b.rs", "fn f() { crate::c::g() }\n"),
            ("c/deep.rs", "use crate::a::Three;\n"),
            ("d.rs", ""),
        ];
        let found = cycle(&imports("x", &texts(&files))).unwrap();
        assert_eq!(found, "a -> b (a/mod.rs), b -> c (b.rs), c -> a (c/deep.rs)");
    }

    #[test]
    fn what_the_root_exports_again_counts_as_its_module() {
        let files =
            [("lib.rs", "pub use a::{One, deep::Two};\n"), ("a.rs", "use crate::b;\n"), ("b.rs", "use crate::Two;\n")];
        assert_eq!(cycle(&imports("x", &texts(&files))).unwrap(), "a -> b (a.rs), b -> a (b.rs)");
    }

    #[test]
    fn tests_comments_and_other_crates_count_for_nothing() {
        let files = [
            ("a.rs", "use crate::b::One; // crate::a\n"),
            ("b.rs", "// see crate::a\nuse my_crate::a;\n#[cfg(test)]\nmod tests {\n    use crate::a::Two;\n}\n"),
            ("b_tests.rs", "use crate::a::Two;\n"),
        ];
        assert_eq!(cycle(&imports("x", &texts(&files))), None);
    }
}

//! Examples of what a user calls: every item of a public prelude shows its use in a Rust example, which the
//! documentation tests run.

use crate::items::{self, Entry, Module};
use std::path::Path;

/// Crates whose public prelude is checked.
const CRATES: [&str; 5] = ["sincro-dynamics", "sincro-blocks", "sincro-scene", "sincro-sim", "sincro-analysis"];

/// Flags of a fenced block that is compiled as Rust but not run, or not compiled at all.
const UNTESTED: [&str; 2] = ["ignore", "compile_fail"];

/// Flags that a fenced block of Rust may have besides its edition.
const RUST: [&str; 3] = ["rust", "no_run", "should_panic"];

/// Finds the items of the preludes that have no example, neither of their own nor at one of their methods.
pub fn check(root: &Path, found: &mut Vec<String>) {
    match items::workspace(root) {
        Ok(workspace) => CRATES.iter().for_each(|library| prelude(root, &workspace, library, found)),
        Err(problem) => found.push(problem),
    }
}

fn prelude(root: &Path, workspace: &Module, library: &str, found: &mut Vec<String>) {
    let root = root.canonicalize().unwrap_or_default();
    let path = [library.replace('-', "_"), "prelude".to_owned()];
    let exported = items::exports(workspace, &path);
    if exported.is_empty() {
        found.push(format!("{library} has no public prelude"));
    }
    for entries in exported.iter().filter(|entries| !entries.iter().any(|entry| has_example(&entry.doc))) {
        let Some(Entry { file, line, name, .. }) = entries.first() else { continue };
        let place = file.strip_prefix(&root).unwrap_or(file).display();
        let name = name.rsplit("::").next().unwrap_or(name);
        found.push(format!(
            "{place}:{line}: `{name}`, which the prelude of {library} exports, has no example: add a block of Rust \
             to its documentation or to that of one of its methods"
        ));
    }
}

/// Returns true if a documentation comment has a fenced block of Rust that the documentation tests compile.
fn has_example(doc: &str) -> bool {
    let mut is_open = false;
    doc.lines().filter_map(|line| line.trim_start().strip_prefix("```")).any(|flags| {
        is_open = !is_open;
        is_open && is_tested(flags)
    })
}

/// Returns true if a block with these flags is Rust that is compiled and may run.
fn is_tested(flags: &str) -> bool {
    let mut flags = flags.split([',', ' ']).map(str::trim).filter(|flag| !flag.is_empty());
    flags.all(|flag| !UNTESTED.contains(&flag) && (RUST.contains(&flag) || flag.starts_with("edition")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn an_item_without_an_example_is_named_with_its_place() {
        let root = std::env::temp_dir().join(format!("xtask-examples-{}", std::process::id()));
        let write = |name: &str, text: &str| {
            let path = root.join("crates/sincro-sim").join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write("Cargo.toml", "");
        write("src/lib.rs", "pub mod prelude;\nmod parts;\n#[macro_export]\nmacro_rules! bare_macro { () => {} }");
        write(
            "src/prelude.rs",
            "pub use crate::parts::{Bare, Method, Own, Toml, Other as Renamed};\npub use crate::bare_macro;",
        );
        write(
            "src/parts.rs",
            "/// Own.\n/// ```\n/// assert!(true);\n/// ```\npub struct Own;\n/// Bare.\npub struct Bare;\n\
             pub struct Method;\nimpl Method {\n/// ```no_run\n/// wait();\n/// ```\npub fn new() {}\n}\n\
             /// ```toml\n/// a = 1\n/// ```\npub struct Toml;\npub struct Other;\n",
        );
        let mut found = Vec::new();
        prelude(&root, &items::workspace(&root).unwrap(), "sincro-sim", &mut found);
        fs::remove_dir_all(&root).unwrap();
        let places: Vec<&str> = found.iter().map(|line| line.split(", which").next().unwrap()).collect();
        assert_eq!(
            places,
            [
                "crates/sincro-sim/src/parts.rs:7: `Bare`",
                "crates/sincro-sim/src/parts.rs:18: `Toml`",
                "crates/sincro-sim/src/parts.rs:19: `Other`",
                "crates/sincro-sim/src/lib.rs:4: `bare_macro`",
            ]
        );
    }

    #[test]
    fn only_rust_that_is_compiled_counts() {
        for (doc, holds) in [
            (" ```\n f();\n ```", true),
            (" ```rust,no_run\n f();\n ```", true),
            (" ```ignore\n f();\n ```", false),
            (" ```text\n f\n ```", false),
            (" ```toml\n a = 1\n ```\n\n ```\n f();\n ```", true),
            (" Calls `f`.", false),
        ] {
            assert_eq!(has_example(doc), holds, "{doc}");
        }
    }
}

//! The glossary against the source: every identifier and every file that its last column names is there.

use std::fs;
use std::path::{Path, PathBuf};

/// Checks `docs/glossary.md`; `texts` are all source files with their contents.
pub fn check(root: &Path, texts: &[(PathBuf, String)], found: &mut Vec<String>) {
    let page = fs::read_to_string(root.join("docs/glossary.md")).unwrap_or_default();
    let rows: Vec<(usize, &str)> = page
        .lines()
        .enumerate()
        .filter(|(_, line)| line.starts_with("| ") && !line.starts_with("| term"))
        .map(|(k, line)| (k + 1, line.trim_end_matches(['|', ' ']).rsplit('|').next().unwrap_or("")))
        .collect();
    if rows.len() < 60 {
        found.push(format!("docs/glossary.md has {} terms, at least 60 belong there", rows.len()));
    }
    for (line, cell) in rows {
        // every second part stands between backquotes
        for name in cell.split('`').skip(1).step_by(2) {
            if !is_there(root, texts, name) {
                found.push(format!("docs/glossary.md:{line}: `{name}` is not in the source"));
            }
        }
    }
}

/// True if a file, folder or crate of this name exists, or an identifier stands in Rust code.
fn is_there(root: &Path, texts: &[(PathBuf, String)], name: &str) -> bool {
    let is_path = name.ends_with(".rs") || name.ends_with('/');
    if is_path {
        let wanted = format!("/src/{}", name.trim_end_matches('/'));
        return texts.iter().any(|(path, _)| path.to_string_lossy().contains(&wanted));
    }
    // the last part of a path such as `State::q`
    let word = name.rsplit("::").next().unwrap_or(name);
    root.join("crates").join(name).is_dir()
        || texts
            .iter()
            .filter(|(path, _)| path.extension().is_some_and(|e| e == "rs"))
            .any(|(path, text)| !path.starts_with(root.join("xtask")) && has_word(text, word))
}

/// True if a text has a word as a whole.
fn has_word(text: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].chars().next_back().is_some_and(is_part)
            && !text[at + word.len()..].chars().next().is_some_and(is_part)
    })
}

//! `cargo xtask api-sample`: public items of the library crates, drawn at random, for a person to grade.
//!
//! The seed is the hash of the parent commit, so that nobody chooses the items and everybody draws the same. An item is
//! public if a user of its crate can name it: along public modules and re-exports. Items are types, traits, functions,
//! methods and constants; fields and variants are printed with their type.

use crate::items::{self, Entry};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Items that are drawn.
const N_ITEMS: usize = 30;
/// Lines of a type that are printed at most.
const MAX_LINES: usize = 60;

/// Prints the sample; false if the crates or the commit cannot be read.
pub fn print(root: &Path) -> bool {
    let Some(seed) = parent_commit(root) else {
        println!("the hash of the parent commit cannot be had from git");
        return false;
    };
    let all = match items::workspace(root) {
        Ok(workspace) => items::entries(&workspace),
        Err(problem) => {
            println!("{problem}");
            return false;
        }
    };
    println!("{N_ITEMS} of {} public items, seed {seed} (the parent commit)", all.len());
    println!("grade each: meaning, unit, shape, errors; an item that a user calls has an example");
    for (k, entry) in draw(all, &seed).iter().enumerate() {
        let shown = entry.file.strip_prefix(root.canonicalize().unwrap_or_default()).unwrap_or(&entry.file);
        println!("\n--- {:2}  {}   {}:{}", k + 1, entry.name, shown.display(), entry.line);
        for line in entry.doc.lines() {
            println!("    ///{line}");
        }
        let text = fs::read_to_string(&entry.file).unwrap_or_default();
        let n_lines = (entry.end + 1 - entry.line).min(MAX_LINES);
        for line in text.lines().skip(entry.line - 1).take(n_lines) {
            println!("    {line}");
        }
    }
    true
}

fn parent_commit(root: &Path) -> Option<String> {
    let output = Command::new("git").args(["rev-parse", "HEAD^"]).current_dir(root).output().ok()?;
    let hash = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && hash.len() >= 16).then_some(hash)
}

/// Draws items without replacement: Fisher–Yates with SplitMix64.
fn draw(mut all: Vec<Entry>, seed: &str) -> Vec<Entry> {
    let mut state = u64::from_str_radix(&seed[..16], 16).unwrap_or(0);
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let n = all.len().min(N_ITEMS);
    for k in 0..n {
        // the bias of a remainder is far below one item in a million
        let other = k + (next() % (all.len() - k) as u64) as usize;
        all.swap(k, other);
    }
    all.truncate(n);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::PathBuf;

    #[test]
    fn the_same_seed_draws_the_same_items() {
        let item = |line| Entry { file: PathBuf::new(), line, end: line, name: String::new(), doc: String::new() };
        let draw_with = |seed: &str| draw((0..200).map(item).collect(), seed);
        let (a, b) = (draw_with("0123456789abcdef"), draw_with("fedcba9876543210"));
        assert_eq!(a.len(), N_ITEMS);
        assert!(a == draw_with("0123456789abcdef") && a != b);
        assert_eq!(a.iter().map(|entry| entry.line).collect::<BTreeSet<_>>().len(), N_ITEMS, "none twice");
    }
}

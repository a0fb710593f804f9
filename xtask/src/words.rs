//! Prose and names of the source: openings of doc comments, width of comments, retired identifiers.
//!
//! Each check covers the folders that are not in its list of folders still to be converted; the lists only ever shrink.

use std::path::{Path, PathBuf};

/// Folders whose doc comments and comment widths are still to be converted.
const UNCONVERTED: &[&str] = &[];

/// Files whose doc comments are the descriptions in `schemas/`, which are part of the format: their openings and line breaks stay.
const SCHEMA_TEXT: &[&str] = &[
    "crates/sincro-scene/src/diagram/file.rs",
    "crates/sincro-scene/src/experiment/file.rs",
    "crates/sincro-scene/src/scene/air.rs",
    "crates/sincro-scene/src/scene/camera.rs",
    "crates/sincro-scene/src/scene/file.rs",
    "crates/sincro-scene/src/scene/proximity.rs",
    "crates/sincro-scene/src/scene/rotor.rs",
    "crates/sincro-scene/src/scene/sensor.rs",
    "crates/sincro-scene/src/scene/signal_file.rs",
];

/// Words that the first line of a doc comment does not begin with: it begins with a noun phrase or a verb.
const OPENINGS: [&str; 6] = ["What", "Whether", "How", "Of", "Why", "Where"];

/// Last column of a comment, as `max_width` in `rustfmt.toml`.
const MAX_COLUMN: usize = 120;

/// A word that is no identifier any more.
struct Retired {
    word: &'static str,
    standard: &'static str,
    /// Crates that had it. It is refused in all of the workspace as soon as none of them is in [`UNCONVERTED`].
    owners: &'static [&'static str],
}

const fn retired(word: &'static str, standard: &'static str, owners: &'static [&'static str]) -> Retired {
    Retired { word, standard, owners }
}

const DYNAMICS: &[&str] = &["sincro-dynamics"];
const SIM: &[&str] = &["sincro-sim", "sincro-scene", "sincro-coppelia"];
const COPPELIA: &[&str] = &["sincro-coppelia"];
const LUA: &[&str] = &["sincro-lua"];
const REMOTE: &[&str] = &["sincro-remote"];
const FILES: &[&str] = &["sincro-sim", "sincro-scene", "sincro-coppelia", "sincro-lua"];
const VIEWER: &[&str] = &["sincro-viewer"];

/// Identifiers that were replaced by standard terms (`docs/glossary.md`).
const RETIRED: &[Retired] = &[
    retired("Innovations", "active-set changes", DYNAMICS),
    retired("Grip", "contact mode", DYNAMICS),
    retired("Patience", "event-storm fallback", DYNAMICS),
    retired("give_way", "eliminate_dof", DYNAMICS),
    retired("Attachment", "CoupledSystem", DYNAMICS),
    retired("farthest", "support", DYNAMICS),
    retired("Effort", "StepStatistics", DYNAMICS),
    retired("airy", "wind_links", DYNAMICS),
    retired("with_attachment", "with_coupled_states", DYNAMICS),
    retired("Reach", "SubspaceRank", &["sincro-analysis"]),
    retired("StepFacts", "StepInfo", &["sincro-analysis"]),
    retired("rates_near", "perturbed_rates", &["sincro-analysis"]),
    retired("drive_whole", "find_all_commands", SIM),
    retired("slope_whole", "all_derivatives", SIM),
    retired("load_alone", "load_without_variants", SIM),
    retired("LawSpec", "ScriptedLawSpec", FILES),
    retired("wrongs", "invalid_settings", SIM),
    retired("Takes", "ValueKind", &["sincro-blocks"]),
    retired("look_late", "evaluate_late", SIM),
    retired("look_around", "update_proximity_sensors", SIM),
    retired("Eye", "ProximitySensor", SIM),
    retired("Sighting", "Detection", SIM),
    retired("Desk", "SimApi", COPPELIA),
    retired("desk", "sim", COPPELIA),
    retired("Refusal", "ApiError", COPPELIA),
    retired("Unplannable", "PlanError", COPPELIA),
    retired("Nearness", "DistanceResult", COPPELIA),
    retired("Studio", "DrawingBuffers", COPPELIA),
    retired("Tape", "Trajectory", SIM),
    retired("Problem", "Diagnostic", FILES),
    retired("Problems", "Diagnostics", FILES),
    retired("Fault", "ScriptError", FILES),
    retired("Manner", "RunOptions", &["sincro-sim", "sincro-remote"]),
    retired("Door", "Endpoint", REMOTE),
    retired("door", "endpoint", REMOTE),
    retired("Said", "CallOutcome", REMOTE),
    retired("let_silent_go", "release_silent_clients", REMOTE),
    retired("pass_on", "forward_events", REMOTE),
    retired("Doom", "StopReason", LUA),
    retired("Shelf", "ApiContext", LUA),
    retired("seven_of", "numbers_of_pose", COPPELIA),
    retired("near_bodies", "candidate_pairs", COPPELIA),
    retired("make_room", "check_stored_size", COPPELIA),
    retired("Fate", "ElementStatus", &["sincro-import"]),
    retired("Film", "Replay", VIEWER),
    retired("Board", "LiveState", VIEWER),
    retired("Reel", "ReplayRun", VIEWER),
    retired("doors", "adapters", &[]),
    retired("shelf", "category", &[]),
];

/// Beginning of constants that are limits: `MAX_` instead.
const RETIRED_PREFIX: &str = "MOST_";

/// Checks the words of every source file.
pub fn check(root: &Path, texts: &[(PathBuf, String)], found: &mut Vec<String>) {
    for (path, text) in texts {
        let name = path.strip_prefix(root).unwrap_or(path).display().to_string();
        let waits = UNCONVERTED.iter().any(|folder| name.starts_with(&format!("{folder}/")));
        if waits || !name.ends_with(".rs") || name == "xtask/src/words.rs" {
            continue;
        }
        if !SCHEMA_TEXT.contains(&name.as_str()) {
            openings(&name, text, found);
            widths(&name, text, found);
        }
        identifiers(&name, text, found);
    }
}

/// First lines of doc comments.
fn openings(name: &str, text: &str, found: &mut Vec<String>) {
    let mut before = "";
    for (k, line) in text.lines().enumerate() {
        let kind = doc_kind(line.trim_start());
        if kind != before && !kind.is_empty() {
            let first = line.trim_start()[kind.len()..].trim_start();
            let word = first.split(|c: char| !c.is_alphanumeric()).next().unwrap_or("");
            if OPENINGS.contains(&word) {
                let advice = "begin with a noun phrase or a verb";
                found.push(format!("{name}:{}: the doc comment begins with `{word}`: {advice}", k + 1));
            }
        }
        before = kind;
    }
}

/// `///` or `//!`; empty for what is no doc comment.
fn doc_kind(line: &str) -> &'static str {
    match line.as_bytes() {
        [b'/', b'/', b'/', b'/', ..] => "",
        [b'/', b'/', b'/', ..] => "///",
        [b'/', b'/', b'!', ..] => "//!",
        _ => "",
    }
}

/// Comments end at the last column; rows of tables cannot be broken.
fn widths(name: &str, text: &str, found: &mut Vec<String>) {
    for (k, line) in text.lines().enumerate() {
        let trimmed = line.trim_start();
        let is_comment = trimmed.starts_with("//") || line.contains(" // ");
        let is_table = trimmed.trim_start_matches(['/', '!', ' ']).starts_with('|');
        let columns = line.chars().count();
        if is_comment && !is_table && columns > MAX_COLUMN {
            found.push(format!("{name}:{}: the comment ends at column {columns}, beyond {MAX_COLUMN}", k + 1));
        }
    }
}

/// Retired identifiers in code; words in comments and in strings are free.
fn identifiers(name: &str, text: &str, found: &mut Vec<String>) {
    let waits = |owner: &str| UNCONVERTED.contains(&format!("crates/{owner}").as_str());
    let refused: Vec<&Retired> = RETIRED.iter().filter(|r| !r.owners.iter().any(|owner| waits(owner))).collect();
    for (k, line) in text.lines().enumerate() {
        for word in words(line) {
            if word.starts_with(RETIRED_PREFIX) {
                found.push(format!("{name}:{}: `{word}` is retired: MAX_…", k + 1));
            }
            for Retired { word, standard, .. } in refused.iter().filter(|r| r.word == word) {
                found.push(format!("{name}:{}: `{word}` is retired: {standard}", k + 1));
            }
        }
    }
}

/// Identifiers of a line of code, without those in a comment behind it and between quotes.
fn words(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or("");
    let outside = code.split('"').step_by(2);
    outside.flat_map(|part| part.split(|c: char| !c.is_alphanumeric() && c != '_')).filter(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn findings(text: &str) -> Vec<String> {
        let mut found = Vec::new();
        let path = PathBuf::from("/w/crates/sincro/src/x.rs");
        check(Path::new("/w"), &[(path, text.to_owned())], &mut found);
        found
    }

    #[test]
    fn first_lines_of_doc_comments_are_read() {
        assert_eq!(findings("//! What it is.\n\n/// Whether it is.\nfn f() {}\n").len(), 2);
        assert!(findings("/// Speed of a wheel.\n/// Whether it slips is another matter.\nfn f() {}\n").is_empty());
        assert!(findings("/// Whatever comes.\n// What is not for readers\nfn f() {}\n").is_empty());
    }

    #[test]
    fn comments_end_at_the_last_column() {
        assert_eq!(findings(&format!("// {}", "x".repeat(118))).len(), 1);
        assert!(findings(&format!("// {}", "x".repeat(117))).is_empty());
        assert!(findings(&format!("/// | {} |", "x".repeat(200))).is_empty());
    }

    #[test]
    fn retired_identifiers_are_refused_in_code_alone() {
        assert_eq!(findings("const MOST_ROUNDS: usize = 3;\nlet doors = 2;").len(), 2);
        assert!(findings("// the doors\nlet alias = \"doors\"; let indoors = 1;").is_empty());
    }
}

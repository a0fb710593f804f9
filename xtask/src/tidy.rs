//! Checks that no compiler makes: that the tree is as `ARCHITECTURE.md` says, that arrows point down, that the thinking
//! crates stay pure, that keys of references resolve.

use crate::modules;
use std::fs;
use std::path::{Path, PathBuf};

/// Lines above which a source file must be split.
const MAX_LINES: usize = 1000;

/// Crates of ours that each crate may use.
const ARROWS: &[(&str, &[&str])] = &[
    ("sincro-math", &[]),
    ("sincro-complementarity", &["sincro-math"]),
    ("sincro-geometry", &["sincro-math"]),
    ("sincro-contact", &["sincro-math", "sincro-geometry"]),
    ("sincro-integrate", &["sincro-math"]),
    ("sincro-camera", &["sincro-math", "sincro-geometry"]),
    ("sincro-aero", &["sincro-math", "sincro-geometry"]),
    ("sincro-actuation", &["sincro-math", "sincro-integrate", "sincro-geometry"]),
    ("sincro-motion", &[]),
    ("sincro-vision", &["sincro-math", "sincro-values"]),
    ("sincro-values", &[]),
    ("sincro-planning", &["sincro-math", "sincro-motion", "sincro-values"]),
    ("sincro-conventions", &["sincro-math", "sincro-geometry", "sincro-values"]),
    (
        "sincro-dynamics",
        &[
            "sincro-math",
            "sincro-complementarity",
            "sincro-geometry",
            "sincro-contact",
            "sincro-integrate",
            "sincro-aero",
            "sincro-actuation",
        ],
    ),
    ("sincro-blocks", &["sincro-math"]),
    ("sincro-scene", &["sincro-math", "sincro-camera", "sincro-dynamics", "sincro-blocks"]),
    ("sincro-compile", &["sincro-math", "sincro-dynamics", "sincro-blocks", "sincro-scene"]),
    ("sincro-sim", &["sincro-math", "sincro-dynamics", "sincro-blocks", "sincro-scene", "sincro-compile"]),
    ("sincro-analysis", &["sincro-math", "sincro-dynamics", "sincro-blocks", "sincro-scene", "sincro-sim"]),
    (
        "sincro-coppelia",
        &[
            "sincro-math",
            "sincro-motion",
            "sincro-planning",
            "sincro-vision",
            "sincro-values",
            "sincro-conventions",
            "sincro-dynamics",
            "sincro-scene",
            "sincro-sim",
        ],
    ),
    (
        "sincro-lua",
        &["sincro-math", "sincro-dynamics", "sincro-blocks", "sincro-scene", "sincro-sim", "sincro-coppelia"],
    ),
    ("sincro-access", &[]),
    ("sincro-remote", &["sincro-access", "sincro-scene", "sincro-sim", "sincro-coppelia"]),
    ("sincro-viewer", &["sincro-access", "sincro-math", "sincro-dynamics", "sincro-scene", "sincro-sim"]),
    ("sincro-fmu", &["sincro-math", "sincro-dynamics", "sincro-blocks", "sincro-scene", "sincro-sim"]),
    ("sincro-fmi", &["sincro-sim", "sincro-fmu", "sincro-lua"]),
    ("sincro-import", &["sincro-math", "sincro-dynamics", "sincro-scene"]),
    ("sincro-figures", &["sincro-math", "sincro-blocks", "sincro-scene", "sincro-sim", "sincro-analysis"]),
    (
        "sincro-campaign",
        &["sincro-math", "sincro-dynamics", "sincro-scene", "sincro-sim", "sincro-analysis", "sincro-figures"],
    ),
    (
        "sincro-bench",
        &[
            "sincro-math",
            "sincro-dynamics",
            "sincro-blocks",
            "sincro-compile",
            "sincro-scene",
            "sincro-sim",
            "sincro-analysis",
            "sincro-coppelia",
            "sincro-lua",
            "sincro-remote",
        ],
    ),
    // support of tests: no crate but as a dev-dependency uses it
    (
        "sincro-testing",
        &["sincro-scene", "sincro-sim", "sincro-analysis", "sincro-coppelia", "sincro-lua", "sincro-remote"],
    ),
    (
        "sincro",
        &[
            "sincro-math",
            "sincro-blocks",
            "sincro-scene",
            "sincro-sim",
            "sincro-analysis",
            "sincro-coppelia",
            "sincro-access",
            "sincro-fmu",
            "sincro-lua",
            "sincro-remote",
            "sincro-viewer",
            "sincro-figures",
            "sincro-campaign",
            "sincro-compile",
            "sincro-import",
            "sincro-bench",
        ],
    ),
    (
        "sincro-python",
        &[
            "sincro-math",
            "sincro-dynamics",
            "sincro-scene",
            "sincro-sim",
            "sincro-analysis",
            "sincro-figures",
            "sincro-import",
            "sincro",
        ],
    ),
];

/// The crates that compute.
const THINKING: [&str; 13] = [
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
    "sincro-blocks",
];

/// Names that must not stand in them: no files, clock, threads, unordered maps.
const IMPURE: [&str; 6] = ["std::fs", "std::time", "std::thread", "std::net", "HashMap", "HashSet"];

/// Checks everything and prints what is wrong; true if nothing is.
pub fn check(root: &Path) -> bool {
    let mut found = Vec::new();
    let sources = files(root, &["crates", "tests", "xtask", "examples"], &["rs", "py", "cpp"]);
    let texts: Vec<(PathBuf, String)> =
        sources.into_iter().filter_map(|path| fs::read_to_string(&path).ok().map(|text| (path, text))).collect();
    for (path, text) in &texts {
        source(root, path, text, &mut found);
    }
    references(root, &texts, &mut found);
    crate::words::check(root, &texts, &mut found);
    crate::glossary::check(root, &texts, &mut found);
    sizes(root, &texts, &mut found);
    crate::package::inclusions(root, &texts, &mut found);
    crate::package::manifests(root, &mut found);
    crate::examples::check(root, &mut found);
    let relative = |path: &Path| path.strip_prefix(root).unwrap_or(path).display().to_string();
    let named: Vec<(String, String)> = texts.iter().map(|(path, text)| (relative(path), text.clone())).collect();
    modules::check(&named, &mut found);
    tree(root, &mut found);
    arrows(root, &mut found);
    scenes(root, &mut found);
    for problem in &found {
        println!("tidy: {problem}");
    }
    found.is_empty()
}

/// All files below `tops` with one of the endings, in a fixed order.
fn files(root: &Path, tops: &[&str], endings: &[&str]) -> Vec<PathBuf> {
    let mut stack: Vec<PathBuf> = tops.iter().map(|top| root.join(top)).collect();
    let mut out = Vec::new();
    while let Some(path) = stack.pop() {
        if path.is_dir() {
            stack.extend(children(&path));
        } else if path.extension().is_some_and(|e| endings.iter().any(|known| e == *known)) {
            out.push(path);
        }
    }
    out.sort();
    out
}

fn children(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).map(|entries| entries.flatten().map(|e| e.path()).collect()).unwrap_or_default()
}

fn source(root: &Path, path: &Path, text: &str, found: &mut Vec<String>) {
    let name = path.strip_prefix(root).unwrap_or(path).display().to_string();
    let lines = text.lines().count();
    if lines > MAX_LINES {
        found.push(format!("{name} has {lines} lines: split it"));
    }
    let is_rust = name.ends_with(".rs");
    if is_rust && !text.starts_with("//!") && !text.starts_with("#!") {
        found.push(format!("{name} does not say what it is for in its first line"));
    }
    for (k, line) in text.lines().enumerate() {
        let at = format!("{name}:{}", k + 1);
        if line.ends_with(' ') || line.ends_with('\t') {
            found.push(format!("{at} ends in white space"));
        }
        if ["/wo", "/ro", "/ho"].iter().zip(["rk/", "ot/", "me/"]).any(|(a, b)| line.contains(&format!("{a}{b}"))) {
            found.push(format!("{at} names a folder of somebody's machine"));
        }
        if line.contains("#[ignore") && is_rust && !name.contains("tidy.rs") {
            found.push(format!("{at} ignores a test"));
        }
        let thinks = THINKING.iter().any(|crate_name| name.starts_with(&format!("crates/{crate_name}/src")));
        if thinks && !line.trim_start().starts_with("//") {
            for word in IMPURE.iter().filter(|word| line.contains(**word)) {
                found.push(format!("{at} uses {word} in a crate that only computes"));
            }
        }
    }
}

/// Lines of code that a crate may have without its tests; one that comes near is split by subject.
const MAX_CRATE_LINES: usize = 20_000;

/// Crates stay small enough to be read.
fn sizes(root: &Path, texts: &[(PathBuf, String)], found: &mut Vec<String>) {
    for (name, _) in ARROWS {
        let folder = root.join("crates").join(name).join("src");
        let is_test = |path: &Path| path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("tests"));
        let own = texts.iter().filter(|(path, _)| path.starts_with(&folder) && !is_test(path));
        let lines: usize =
            own.map(|(_, text)| text.split("#[cfg(test)]\nmod tests {").next().unwrap_or("").lines().count()).sum();
        if lines > MAX_CRATE_LINES {
            found.push(format!(
                "{name} has {lines} lines without its tests, {MAX_CRATE_LINES} at most: split it by subject"
            ));
        }
    }
}

/// Keys of the form ``key `name` `` resolve in docs/references.md.
fn references(root: &Path, texts: &[(PathBuf, String)], found: &mut Vec<String>) {
    let known = fs::read_to_string(root.join("docs/references.md")).unwrap_or_default();
    for (path, text) in texts.iter().filter(|(path, _)| !path.ends_with("tidy.rs")) {
        for part in text.split("key `").skip(1) {
            let key = part.split('`').next().unwrap_or("");
            let is_key = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
            if is_key && key.chars().any(|c| c.is_ascii_digit() || c == '-') && !known.contains(&format!("| {key} |")) {
                found.push(format!("{}: the key `{key}` is not in docs/references.md", path.display()));
            }
        }
    }
}

/// The tree in ARCHITECTURE.md has every folder of the top and every crate, and no other.
fn tree(root: &Path, found: &mut Vec<String>) {
    let page = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap_or_default();
    let drawn: Vec<String> = page
        .split("```")
        .nth(1)
        .unwrap_or("")
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .filter_map(|word| word.strip_suffix('/').map(str::to_owned))
        .collect();
    let hidden = ["target", "results"];
    let mut there: Vec<String> = Vec::new();
    for folder in children(root).into_iter().chain(children(&root.join("crates"))).filter(|p| p.is_dir()) {
        let name = folder.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        if !name.starts_with('.') && !hidden.contains(&name.as_str()) {
            there.push(name);
        }
    }
    for name in there.iter().filter(|name| !drawn.contains(name)) {
        found.push(format!("ARCHITECTURE.md does not draw `{name}/`"));
    }
    for name in drawn.iter().filter(|name| !there.contains(name)) {
        found.push(format!("ARCHITECTURE.md draws `{name}/`, which is not there"));
    }
}

/// Crates use only those of ours that stand below them.
fn arrows(root: &Path, found: &mut Vec<String>) {
    for (name, allowed) in ARROWS {
        let manifest = fs::read_to_string(root.join("crates").join(name).join("Cargo.toml")).unwrap_or_default();
        // tests may use what stands above: their scenes have scripts
        let manifest = manifest.split("[dev-dependencies]").next().unwrap_or("");
        for line in manifest.lines().filter(|line| line.starts_with("sincro")) {
            let used = line.split(['.', ' ', '=']).next().unwrap_or("");
            if !allowed.contains(&used) {
                found.push(format!("{name} uses {used}, which does not stand below it"));
            }
        }
    }
}

/// Every scene and model folder is whole. (The scene file may be that of another folder: who loads the experiment finds
/// it.) A folder of scene folders needs a `README.md`.
fn scenes(root: &Path, found: &mut Vec<String>) {
    let folders = children(&root.join("scenes")).into_iter().chain(children(&root.join("models")));
    for folder in folders.filter(|p| p.is_dir()) {
        let nested: Vec<PathBuf> = children(&folder).into_iter().filter(|p| p.is_dir()).collect();
        let is_group = nested.iter().any(|p| p.join("experiment.toml").is_file());
        whole(&folder, if is_group { &["README.md"] } else { &["README.md", "experiment.toml"] }, found);
        if is_group {
            for scene in &nested {
                whole(scene, &["README.md", "experiment.toml"], found);
            }
        }
    }
}

/// Reports the files that a folder lacks.
fn whole(folder: &Path, files: &[&str], found: &mut Vec<String>) {
    for file in files {
        if !folder.join(file).is_file() {
            found.push(format!("{} has no {file}", folder.display()));
        }
    }
}

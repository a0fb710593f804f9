//! Packaging: every crate of the workspace can be made a package that stands on its own.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// Attributes and macros that include a file at compile time.
const INCLUSIONS: [&str; 4] = ["include_str!(\"", "include_bytes!(\"", "include!(\"", "#[path = \""];

/// Sources of crates include no file from outside the crate's folder: a package would lack it.
pub fn inclusions(root: &Path, texts: &[(PathBuf, String)], found: &mut Vec<String>) {
    for (path, text) in texts {
        let Ok(name) = path.strip_prefix(root) else { continue };
        let parts: Vec<&str> = name.iter().filter_map(|part| part.to_str()).collect();
        let ["crates", krate, "src", ..] = parts.as_slice() else { continue };
        for (k, line) in text.lines().enumerate() {
            for included in INCLUSIONS.iter().filter_map(|start| line.split(start).nth(1)?.split('"').next()) {
                let target = normalized(&name.parent().unwrap_or(Path::new("")).join(included));
                if !target.starts_with(Path::new("crates").join(krate)) {
                    let place = format!("{}:{}", name.display(), k + 1);
                    found.push(format!("{place}: `{included}` is outside the crate, and not in its package"));
                }
            }
        }
    }
}

/// Crates of the workspace depend on each other with a version, and have what a registry asks for.
pub fn manifests(root: &Path, found: &mut Vec<String>) {
    let workspace = fs::read_to_string(root.join("Cargo.toml")).unwrap_or_default();
    for line in workspace.lines().filter(|line| line.starts_with("sincro") && line.contains("path = ")) {
        if !line.contains("version = ") {
            found.push(format!("Cargo.toml: `{line}` has no version"));
        }
    }
    let folders = fs::read_dir(root.join("crates")).map(|all| all.flatten().map(|e| e.path()).collect());
    let mut folders: Vec<PathBuf> = folders.unwrap_or_default();
    folders.sort();
    for folder in folders {
        let Ok(manifest) = fs::read_to_string(folder.join("Cargo.toml")) else { continue };
        let shown = folder.strip_prefix(root).unwrap_or(&folder).display();
        for key in ["description", "license", "repository"] {
            if !manifest.lines().any(|line| line.starts_with(key)) {
                found.push(format!("{shown}/Cargo.toml has no {key}"));
            }
        }
    }
}

/// A path without `..`.
fn normalized(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

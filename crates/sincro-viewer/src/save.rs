//! Saving a scene with changed numbers: a copy of its folder in which those numbers stand, comments and all.

use std::fs;
use std::path::{Path, PathBuf};

use sincro_scene::overrides::Override;
use sincro_sim::replay::edited;
use sincro_sim::{Extensions, load};

/// Files of a folder that are copied; more are no scene.
const MAX_FILES: usize = 500;

/// Writes the scene with `settings` into a folder beside it; the folder's path.
///
/// # Errors
///
/// A sentence: what does not stand in the files as a number, what cannot be read or written, what the scene would then
/// lack.
pub(crate) fn save_scene(folder: &Path, settings: &[Override], extensions: Extensions) -> Result<PathBuf, String> {
    let folder = if folder.is_file() { folder.parent().unwrap_or(folder) } else { folder };
    let loaded = load(folder, &[], extensions).map_err(|diagnostics| diagnostics.to_string())?;
    let texts = edited(&loaded, settings).map_err(|refused| refused.join("\n"))?;
    let files = files(folder)?;
    let target = free_name(folder)?;
    for file in &files {
        let inner = file.strip_prefix(folder).map_err(|_| format!("`{}` is not in the folder", file.display()))?;
        let to = target.join(inner);
        let made = to.parent().map_or(Ok(()), fs::create_dir_all);
        let written = made.and_then(|()| match texts.iter().find(|(path, _)| *path == file) {
            Some((_, text)) => fs::write(&to, text),
            None => fs::copy(file, &to).map(|_| ()),
        });
        written.map_err(|e| format!("`{}` cannot be written: {e}", to.display()))?;
    }
    load(&target, &[], extensions)
        .map_err(|diagnostics| format!("saved as `{}`, which does not load: {diagnostics}", target.display()))?;
    Ok(target)
}

/// Copies of one scene that are made; more are to be cleared away first.
const MAX_COPIES: usize = 100;

/// `arm-edited`, `arm-edited-2` …: the first one that is not there.
///
/// # Errors
///
/// There are [`MAX_COPIES`] already.
fn free_name(folder: &Path) -> Result<PathBuf, String> {
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    let name = whole.file_name().map_or_else(|| "scene".into(), |name| name.to_string_lossy().into_owned());
    let beside =
        |k: usize| whole.with_file_name(if k == 1 { format!("{name}-edited") } else { format!("{name}-edited-{k}") });
    (1..=MAX_COPIES)
        .map(beside)
        .find(|path| path.symlink_metadata().is_err())
        .ok_or_else(|| format!("there are {MAX_COPIES} copies of `{}` beside it already: delete some", whole.display()))
}

/// The files of a folder and of those in it; links are left out.
fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let (mut found, mut stack) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(at) = stack.pop() {
        let entries = fs::read_dir(&at).map_err(|e| format!("`{}` cannot be read: {e}", at.display()))?;
        for entry in entries.flatten() {
            let Ok(kind) = entry.file_type() else { continue };
            if kind.is_dir() {
                stack.push(entry.path());
            } else if kind.is_file() {
                found.push(entry.path());
            }
        }
        if found.len() > MAX_FILES {
            return Err(format!("`{}` has more than {MAX_FILES} files: copy it by hand", folder.display()));
        }
    }
    found.sort();
    Ok(found)
}

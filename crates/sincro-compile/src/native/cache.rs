//! The folder of compiled libraries.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use crate::Obstacle;

/// Libraries that are kept; the oldest go first.
const MAX_LIBRARIES: usize = 200;

/// The user's own folder for them.
pub(super) fn folder() -> Result<PathBuf, Obstacle> {
    let of = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let cache = of("XDG_CACHE_HOME").or_else(|| of("HOME").map(|home| home.join(".cache")));
    let folder = cache.ok_or_else(|| Obstacle::new("there is no folder for a cache"))?.join("sincro/compiled");
    let why = |error| Obstacle::new(format!("`{}` cannot be made: {error}", folder.display()));
    create_private(&folder).map_err(why)?;
    Ok(folder)
}

/// Creates a folder whose contents only this user may change.
fn create_private(folder: &Path) -> std::io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::{DirBuilderExt, MetadataExt};
        builder.mode(0o700).create(folder)?;
        if fs::metadata(folder)?.mode() & 0o022 != 0 {
            return Err(std::io::Error::other("others may write into it"));
        }
        Ok(())
    }
    #[cfg(not(unix))]
    builder.create(folder)
}

/// Name of the library of a text compiled with `options`.
pub(super) fn name(text: &str, options: &[&str]) -> String {
    let key = [text, &options.join(" "), &super::compiler::name()].join("\0");
    format!("{:032x}.{}", twox_hash::XxHash3_128::oneshot(key.as_bytes()), std::env::consts::DLL_EXTENSION)
}

/// File that is removed when it is dropped.
pub(super) struct Temporary(PathBuf);

impl Temporary {
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        _ = fs::remove_file(&self.0);
    }
}

/// A file of this process alone.
pub(super) fn temporary(folder: &Path) -> Temporary {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    Temporary(folder.join(format!("{}-{count}.part", std::process::id())))
}

/// Moves a library to its name, which replaces one that another process has made meanwhile; a failure costs a
/// compilation next time.
pub(super) fn publish(made: Temporary, path: &Path) {
    if fs::rename(made.path(), path).is_ok() {
        prune(path.parent().unwrap_or(path));
    }
}

/// Removes the oldest libraries beyond the limit.
fn prune(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let age = |path: &Path| fs::metadata(path).and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let mut files: Vec<(SystemTime, PathBuf)> =
        entries.filter_map(Result::ok).map(|entry| (age(&entry.path()), entry.path())).collect();
    files.sort();
    for (_, path) in files.iter().take(files.len().saturating_sub(MAX_LIBRARIES)) {
        _ = fs::remove_file(path);
    }
}

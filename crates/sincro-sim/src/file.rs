//! Writing result files so that nothing half-written looks whole.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

/// Error of writing or reading a file or folder, with its path. Its text (`Display`) is a message for the user.
#[derive(Debug)]
pub struct FileError {
    /// Path of the file or folder.
    pub path: PathBuf,
    /// Attempted action, such as `write` or `create the folder`: the message is `cannot ACTION PATH`.
    pub action: &'static str,
    /// Error of the operating system.
    pub cause: io::Error,
}

impl FileError {
    /// Creates the error of doing `action` with `path`.
    pub fn new(action: &'static str, path: &Path, cause: impl Into<io::Error>) -> Self {
        Self { path: path.to_path_buf(), action, cause: cause.into() }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot {} `{}`: {}", self.action, self.path.display(), self.cause)
    }
}

impl std::error::Error for FileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

/// Prepares a folder for results: creates it if it is absent, and tries out that it takes a file. To be called before a
/// simulation starts, so that the results are not lost at its end. Files in it stay; several processes may prepare the
/// same folder at the same time.
///
/// # Errors
///
/// [`FileError`] with the folder, if it cannot be created, is a file, or takes no files.
pub fn prepare(out_dir: &Path) -> Result<(), FileError> {
    fs::create_dir_all(out_dir).map_err(|e| FileError::new("create the results folder", out_dir, e))?;
    let trial = partial_of_process(&out_dir.join(".sincro-trial"));
    let written = fs::write(&trial, b"sincro").and_then(|()| fs::remove_file(&trial));
    written.map_err(|e| FileError::new("write into the results folder", out_dir, e))
}

/// Path of a file until it is complete: `run.json.partial`.
pub(crate) fn partial(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    PathBuf::from(name)
}

/// Returns the path of a file until it is complete, in a folder that several processes share: no other process, machine
/// or thread gets the same, and it ends with `.partial` too.
#[must_use]
pub fn partial_of_process(path: &Path) -> PathBuf {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    // containers may have equal hosts and numbers of processes
    static START: LazyLock<u128> =
        LazyLock::new(|| SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos()));
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let host: String = host.trim().chars().filter(char::is_ascii_alphanumeric).collect();
    let mut name = path.as_os_str().to_owned();
    let (process, next) = (std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
    name.push(format!(".{host}-{process}-{:x}-{next}.partial", *START));
    PathBuf::from(name)
}

/// Writes a whole file atomically: beside its place, then moved there. A reader sees the old file or the new one, never
/// a part.
///
/// # Errors
///
/// [`FileError`] with the path: the disk is full, the folder does not exist or takes no files.
pub fn write_atomically(path: &Path, content: &[u8]) -> Result<(), FileError> {
    let partial = partial(path);
    let file = File::create(&partial).and_then(|mut file| file.write_all(content).map(|()| file));
    let file = file.map_err(|e| FileError::new("write", &partial, e))?;
    put_in_place(&file, &partial, path)
}

/// Writes a whole file atomically, as [`write_atomically`] does, in a folder that several processes share: each that
/// writes this file at the same time has its own until it is complete.
///
/// # Errors
///
/// As [`write_atomically`]; the incomplete file is removed.
pub fn write_atomically_shared(path: &Path, content: &[u8]) -> Result<(), FileError> {
    let own = partial_of_process(path);
    let written = File::create(&own).and_then(|mut file| file.write_all(content).and_then(|()| file.sync_all()));
    put_in_shared_place(&own, path, written)
}

/// Gives a file of [`partial_of_process`] its name once it is `written`; removes one that could not be written.
///
/// # Errors
///
/// [`FileError`] with the path: that of `written`, or the file cannot be renamed.
pub fn put_in_shared_place(own: &Path, path: &Path, written: io::Result<()>) -> Result<(), FileError> {
    let renamed = || fs::rename(own, path).map_err(|e| FileError::new("rename a file to", path, e));
    let done = written.map_err(|e| FileError::new("write", path, e)).and_then(|()| renamed());
    if done.is_err() {
        let _ = fs::remove_file(own);
    }
    done
}

/// Waits until a whole file is on the disk (some systems report a full one only then) and gives it its name.
pub(crate) fn put_in_place(file: &File, partial: &Path, path: &Path) -> Result<(), FileError> {
    file.sync_all().map_err(|e| FileError::new("write", partial, e))?;
    fs::rename(partial, path).map_err(|e| FileError::new("rename a file to", path, e))
}

/// A fresh folder for one test.
#[cfg(test)]
pub(crate) fn test_folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("sincro-sim-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the temporary folder takes folders");
    folder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preparing_creates_the_folder_and_leaves_what_is_in_it() {
        let folder = test_folder("prepare").join("results/deep");
        prepare(&folder).unwrap();
        fs::write(folder.join("notes.txt"), "mine").unwrap();
        prepare(&folder).unwrap();
        let names: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(names, ["notes.txt"]);
    }

    #[test]
    fn many_prepare_the_same_folder_and_write_the_same_file_at_once() {
        let folder = test_folder("prepare-shared");
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..100 {
                        prepare(&folder).unwrap();
                        write_atomically_shared(&folder.join("plan.toml"), b"seed = 1").unwrap();
                    }
                });
            }
        });
        let names: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(names, ["plan.toml"]);
    }

    #[test]
    fn a_folder_that_is_a_file_is_refused_by_name() {
        let file = test_folder("prepare-file").join("results");
        fs::write(&file, "").unwrap();
        let message = prepare(&file).unwrap_err().to_string();
        assert!(
            message.starts_with("cannot create the results folder `") && message.contains("results`: "),
            "{message}"
        );
        let message = prepare(&file.join("run")).unwrap_err().to_string();
        assert!(message.contains("Not a directory") || message.contains("exists"), "{message}");
    }

    #[test]
    fn a_file_is_replaced_whole() {
        let path = test_folder("atomic").join("run.json");
        write_atomically(&path, b"a longer first text").unwrap();
        write_atomically(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert!(!partial(&path).exists());
    }
}

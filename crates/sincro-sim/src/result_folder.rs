//! Folders of results: written beside their place, locked, and published whole by a rename at the end.
//!
//! | name beside a result `0007` | meaning |
//! |---|---|
//! | `.0007.running` | files of the run that is under way |
//! | `.0007.lock` | locked by the process that makes the run; the system unlocks it when that process ends, however it ends |
//! | `.0007.earlier` | the earlier result between the two renames that replace it; put back if a process died there |
//!
//! All three are gone after [`ResultFolder::publish`] and after a drop. What a killed process leaves is removed by the
//! next run of the same folder. A folder that cannot be renamed (a mount point, the working directory, one whose parent
//! takes no files) gets its files in a folder `.running` inside it, which are then moved one by one.

use std::fmt;
use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::file::FileError;

/// Files of a result, `*.partial` of each included; folders are in [`FOLDERS`].
const FILES: [&str; 14] = [
    "run.json",
    "signals.csv",
    "signals.parquet",
    "signals.npz",
    "signals.mat",
    "streams.csv",
    "sweep.csv",
    "report.html",
    "replay.json",
    "run.mcap",
    "linearization.json",
    "bode.csv",
    "step.csv",
    "diff.html",
];

/// Folders of a result, with the extensions of the files in them; an empty list: folders of results.
const FOLDERS: [(&str, &[&str]); 5] = [
    ("figures", &["svg"]),
    ("frames", &["svg", "png"]),
    ("images", &["png", "bmp"]),
    ("files", &TEXT_FILES),
    ("variants", &[]),
];

/// Extensions of the texts that scripts write into the folder `files` of a result.
pub const TEXT_FILES: [&str; 7] = ["txt", "csv", "tsv", "dat", "log", "json", "xml"];

/// Files that file managers leave anywhere.
const IGNORED: [&str; 3] = [".DS_Store", "Thumbs.db", "desktop.ini"];

/// Numbers that are tried before giving up: so many runs may start at once.
const MAX_STARTS: u32 = 10_000;

/// Error of a folder that takes no results. Its text (`Display`) is a message for the user, [`FolderError::help`] the
/// remedy.
#[derive(Debug)]
pub enum FolderError {
    /// A file or folder cannot be written.
    File(FileError),
    /// The folder holds something that no run has written, and is left as it is.
    Foreign {
        /// Path of the folder.
        folder: PathBuf,
        /// Path of that entry, relative to the folder.
        entry: String,
    },
    /// Another process is writing results there; the folder.
    Locked(PathBuf),
}

impl fmt::Display for FolderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => write!(f, "{error}"),
            Self::Foreign { folder, entry } => {
                write!(f, "the folder `{}` holds `{entry}`, which is no part of a result", folder.display())
            }
            Self::Locked(folder) => write!(f, "another run is writing `{}`", folder.display()),
        }
    }
}

impl std::error::Error for FolderError {}

impl From<FileError> for FolderError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl FolderError {
    /// Returns the remedy in English, such as to choose another folder.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::File(_) => "choose another place with --out DIR, or make room there",
            Self::Foreign { .. } => {
                "--out names a folder that is absent, empty or an earlier result, which is then replaced whole"
            }
            Self::Locked(_) => "wait for its end, or choose another folder with --out DIR",
        }
    }
}

/// Result folder that is being written: files go into a folder beside its place, and [`ResultFolder::publish`] moves it
/// there as a whole. Dropped without that, it leaves nothing behind.
#[derive(Debug)]
pub struct ResultFolder {
    /// Its place once it is published.
    target: PathBuf,
    /// Folder of the files until then.
    running: PathBuf,
    /// True if `running` is inside the target, which cannot be renamed.
    is_inside: bool,
    lock: Lock,
    /// Folders that were made for it, the innermost first.
    made: Vec<PathBuf>,
    /// True for a numbered folder, to which `latest` then leads.
    is_numbered: bool,
}

impl ResultFolder {
    /// Begins a result at exactly `target`, which must be absent, empty, or an earlier result, which the new one
    /// replaces.
    ///
    /// # Errors
    ///
    /// [`FolderError::Foreign`]: the folder holds something else. [`FolderError::Locked`]: another run is writing it.
    /// [`FolderError::File`]: it takes no files. Nothing was changed then.
    pub fn replace(target: &Path) -> Result<Self, FolderError> {
        let target = resolved(target)?;
        refuse_foreign(&target)?;
        let made = make_parents(&target)?;
        match Self::begin(target.clone(), false) {
            Ok(Some(mut folder)) => {
                folder.made = made;
                Ok(folder)
            }
            Ok(None) => Err(FolderError::Locked(target)),
            Err(error) => {
                remove_empty(&made);
                Err(error)
            }
        }
    }

    /// Begins a result in the next numbered folder below `parent`: `0001`, `0002` …; when published, the link `latest`
    /// leads to it.
    ///
    /// # Errors
    ///
    /// [`FolderError::File`]: the folder takes no files. [`FolderError::Locked`]: other processes hold all numbers that
    /// were tried.
    pub fn numbered(parent: &Path) -> Result<Self, FolderError> {
        Self::next(parent, last_number(parent) + 1, |number| format!("{number:04}"), true)
    }

    /// Begins a result in the first free one of the folders `name(first)`, `name(first + 1)` … below `parent`; with
    /// `is_numbered` the link `latest` leads to it once it is published.
    ///
    /// # Errors
    ///
    /// As [`ResultFolder::numbered`].
    pub fn next(
        parent: &Path,
        first: u32,
        name: impl Fn(u32) -> String,
        is_numbered: bool,
    ) -> Result<Self, FolderError> {
        let made = make_parents(&parent.join("run"))?;
        for number in first..first.saturating_add(MAX_STARTS) {
            let target = parent.join(name(number));
            if target.symlink_metadata().is_ok() {
                continue;
            }
            match Self::begin(target.clone(), is_numbered) {
                // another process may have published it in the meantime
                Ok(Some(mut folder)) if target.symlink_metadata().is_err() => {
                    folder.made = made;
                    return Ok(folder);
                }
                Ok(_) => {}
                Err(error) => {
                    remove_empty(&made);
                    return Err(error);
                }
            }
        }
        Err(FolderError::Locked(parent.join(name(first))))
    }

    /// Locks the place and makes the folder for the files; none if another process has the lock.
    fn begin(target: PathBuf, is_numbered: bool) -> Result<Option<Self>, FolderError> {
        let is_inside = !is_renamable(&target);
        let beside =
            |suffix: &str| if is_inside { target.join(format!(".{suffix}")) } else { sibling(&target, suffix) };
        let (running, earlier) = (beside("running"), beside("earlier"));
        let Some(lock) = Lock::take(&beside("lock"))? else { return Ok(None) };
        if !is_inside && earlier.is_dir() {
            // a process died between the two renames, or before it removed the earlier result
            let restored = if target.exists() { remove(&earlier) } else { rename(&earlier, &target) };
            restored?;
        }
        remove(&running)?;
        fs::create_dir(&running).map_err(|e| FileError::new("create the results folder", &running, e))?;
        let folder = Self { target, running, is_inside, lock, made: Vec::new(), is_numbered };
        Ok(Some(folder))
    }

    /// Returns the path of the folder to write the files into until the result is published.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.running
    }

    /// Returns the path of the result once it is published.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Publishes the result at its target, in the place of an earlier one, and returns its path.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the folder that cannot be renamed; an earlier result is then still there.
    pub fn publish(mut self) -> Result<PathBuf, FileError> {
        self.made.clear();
        if self.is_inside {
            self.move_files()?;
        } else if self.target.is_dir() {
            let earlier = sibling(&self.target, "earlier");
            rename(&self.target, &earlier)?;
            if let Err(error) = rename(&self.running, &self.target) {
                rename(&earlier, &self.target)?;
                return Err(error);
            }
            remove(&earlier)?;
        } else {
            rename(&self.running, &self.target)?;
        }
        if self.is_numbered {
            point_latest(&self.target)?;
        }
        Ok(self.target.clone())
    }

    /// Replaces the entries of a folder that cannot be renamed itself.
    fn move_files(&self) -> Result<(), FileError> {
        let names = |folder: &Path| -> Result<Vec<std::ffi::OsString>, FileError> {
            let entries = fs::read_dir(folder).and_then(|entries| entries.map(|e| Ok(e?.file_name())).collect());
            entries.map_err(|e| FileError::new("read the folder", folder, e))
        };
        for name in names(&self.target)? {
            let path = self.target.join(&name);
            if path != self.running && path != self.lock.path {
                remove(&path)?;
            }
        }
        for name in names(&self.running)? {
            rename(&self.running.join(&name), &self.target.join(&name))?;
        }
        Ok(())
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.running);
        self.lock.release();
        remove_empty(&self.made);
    }
}

/// A lock file, removed when released. The system releases it too when the process ends.
#[derive(Debug)]
struct Lock {
    path: PathBuf,
    file: Option<File>,
}

impl Lock {
    /// The lock; none if another process holds it.
    fn take(path: &Path) -> Result<Option<Self>, FileError> {
        loop {
            let file = File::options().create(true).truncate(false).write(true).open(path);
            let file = file.map_err(|e| FileError::new("write", path, e))?;
            match file.try_lock() {
                Ok(()) if is_same_file(&file, path) => {
                    return Ok(Some(Self { path: path.to_owned(), file: Some(file) }));
                }
                // its last owner removed it while it was being locked: the next one has another file
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(error)) => return Err(FileError::new("lock", path, error)),
            }
        }
    }

    fn release(&mut self) {
        if let Some(file) = self.file.take() {
            // removed while it is locked: who opened it before sees that it is another file now
            let _ = fs::remove_file(&self.path);
            drop(file);
        }
    }
}

#[cfg(unix)]
fn is_same_file(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let of = |m: fs::Metadata| (m.dev(), m.ino());
    file.metadata().map(of).ok().zip(fs::metadata(path).map(of).ok()).is_some_and(|(a, b)| a == b)
}

#[cfg(not(unix))]
fn is_same_file(_: &File, path: &Path) -> bool {
    path.exists()
}

/// The folder that is meant, links followed, so that what stands beside it is on the same file system.
fn resolved(target: &Path) -> Result<PathBuf, FileError> {
    let failed = |e| FileError::new("create the results folder", target, e);
    match fs::metadata(target) {
        Ok(found) if found.is_dir() => target.canonicalize().map_err(failed),
        Ok(_) => Err(failed(std::io::Error::new(ErrorKind::NotADirectory, "it is a file"))),
        Err(_) if target.symlink_metadata().is_ok() => {
            Err(failed(std::io::Error::new(ErrorKind::NotFound, "it is a link that leads nowhere")))
        }
        Err(_) => Ok(target.to_owned()),
    }
}

/// Refuses a folder that holds anything but a result.
fn refuse_foreign(folder: &Path) -> Result<(), FolderError> {
    match foreign_entry(folder) {
        Ok(None) => Ok(()),
        Ok(Some(entry)) => Err(FolderError::Foreign { folder: folder.to_owned(), entry }),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(FileError::new("read the folder", folder, error).into()),
    }
}

/// Returns true if a folder is the result of a finished run: it has a `run.json` of this program.
#[must_use]
pub fn is_result(folder: &Path) -> bool {
    let text = fs::read_to_string(folder.join("run.json")).unwrap_or_default();
    serde_json::from_str::<Value>(&text).is_ok_and(|json| json.get("trace_hash").is_some())
}

/// Returns the first entry, by path relative to the folder, that no run writes; `None` if the folder is empty or a
/// result.
///
/// # Errors
///
/// The error of the operating system, if the folder cannot be read.
pub fn foreign_entry(folder: &Path) -> std::io::Result<Option<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        names.push((entry.file_name().to_string_lossy().into_owned(), entry.file_type()?.is_dir()));
    }
    names.sort();
    let of_run = [".running", ".lock", ".earlier"];
    names.retain(|(name, _)| !of_run.contains(&name.as_str()));
    for (name, is_dir) in &names {
        let inner = FOLDERS.iter().find(|(known, _)| *is_dir && known == name);
        let foreign = match inner {
            Some((_, [])) => foreign_variant(&folder.join(name))?,
            Some((_, extensions)) => {
                let has_extension = |plain: &str| plain.rsplit_once('.').is_some_and(|(_, e)| extensions.contains(&e));
                foreign_file(&folder.join(name), has_extension)?
            }
            None if !is_dir && is_of_run(name, |plain| FILES.contains(&plain)) => None,
            None => Some(String::new()),
        };
        if let Some(inner) = foreign {
            return Ok(Some(if inner.is_empty() { name.clone() } else { format!("{name}/{inner}") }));
        }
    }
    let is_known = names.is_empty() || is_result(folder) || folder.join("linearization.json").is_file();
    Ok(names.first().filter(|_| !is_known).map(|(name, _)| name.clone()))
}

/// Returns true for a file that a run writes or has begun to write (`*.partial`), and for those of file managers.
fn is_of_run(name: &str, is_known: impl Fn(&str) -> bool) -> bool {
    IGNORED.contains(&name) || is_known(name.strip_suffix(".partial").unwrap_or(name))
}

/// The first file of a folder that no run writes.
fn foreign_file(folder: &Path, is_known: impl Fn(&str) -> bool) -> std::io::Result<Option<String>> {
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if !is_of_run(&name, &is_known) {
            return Ok(Some(name));
        }
    }
    Ok(None)
}

/// Folders of variants hold the signals of one each.
fn foreign_variant(folder: &Path) -> std::io::Result<Option<String>> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if !entry.file_type()?.is_dir() {
            return Ok(Some(name));
        }
        if let Some(file) = foreign_file(&entry.path(), |plain| FILES.contains(&plain))? {
            return Ok(Some(format!("{name}/{file}")));
        }
    }
    Ok(None)
}

/// Returns the paths of the folders in `parent`, ordered by name, without hidden ones and links such as `latest`; empty
/// if it cannot be read.
#[must_use]
pub fn folders_in(parent: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(parent).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
    let mut found: Vec<PathBuf> = folders.map(|entry| entry.path()).collect();
    found.retain(|path| path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.')));
    found.sort();
    found
}

/// Returns the numbers of the numbered result folders below `parent`, ascending.
#[must_use]
pub fn numbers(parent: &Path) -> Vec<u32> {
    let number = |path: &PathBuf| {
        let name = path.file_name()?.to_str()?;
        name.parse().ok().filter(|n| name == format!("{n:04}"))
    };
    let mut found: Vec<u32> = folders_in(parent).iter().filter_map(number).collect();
    found.sort_unstable();
    found
}

fn last_number(parent: &Path) -> u32 {
    numbers(parent).last().copied().unwrap_or(0)
}

/// Returns true if the folder can be replaced by another one that takes its name.
fn is_renamable(target: &Path) -> bool {
    let Ok(parent) = parent_of(target).canonicalize() else { return true };
    if !target.is_dir() {
        return true;
    }
    let is_working_directory = std::env::current_dir().is_ok_and(|here| here.starts_with(target));
    let trial = sibling(target, "trial");
    let takes_folders = fs::create_dir(&trial).is_ok() || trial.is_dir();
    let _ = fs::remove_dir(&trial);
    takes_folders && !is_working_directory && !is_mount_point(target, &parent)
}

#[cfg(unix)]
fn is_mount_point(target: &Path, parent: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let device = |path: &Path| fs::metadata(path).map(|m| m.dev()).ok();
    device(target) != device(parent)
}

#[cfg(not(unix))]
fn is_mount_point(_: &Path, _: &Path) -> bool {
    false
}

/// Makes the folders above a result. Returns those that were not there, the innermost first.
fn make_parents(target: &Path) -> Result<Vec<PathBuf>, FileError> {
    let parent = parent_of(target);
    let absent = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
    let made: Vec<PathBuf> = parent.ancestors().take_while(absent).map(Path::to_owned).collect();
    fs::create_dir_all(parent).map_err(|e| FileError::new("create the results folder", parent, e))?;
    Ok(made)
}

fn remove_empty(made: &[PathBuf]) {
    for folder in made {
        let _ = fs::remove_dir(folder);
    }
}

fn parent_of(target: &Path) -> &Path {
    target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// `.NAME.suffix` beside a folder.
fn sibling(target: &Path, suffix: &str) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    parent_of(target).join(format!(".{name}.{suffix}"))
}

fn rename(from: &Path, to: &Path) -> Result<(), FileError> {
    fs::rename(from, to).map_err(|e| FileError::new("rename a folder to", to, e))
}

/// Removes a file or folder; one that is not there is no error.
fn remove(path: &Path) -> Result<(), FileError> {
    let removed = match path.symlink_metadata() {
        Ok(found) if found.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(_) => return Ok(()),
    };
    removed.map_err(|e| FileError::new("remove", path, e))
}

/// Lets the link `latest` beside a numbered folder lead to it. Something else of that name is left alone.
fn point_latest(target: &Path) -> Result<(), FileError> {
    let latest = target.with_file_name("latest");
    if latest.symlink_metadata().is_ok_and(|found| !found.is_symlink()) {
        return Ok(());
    }
    let name = target.file_name().unwrap_or_default();
    let new = sibling(&latest, "running");
    remove(&new)?;
    match link(Path::new(name), &new) {
        Ok(()) => rename(&new, &latest),
        // a file system without links
        Err(_) => Ok(()),
    }
}

#[cfg(unix)]
fn link(to: &Path, path: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(to, path)
}

#[cfg(windows)]
fn link(to: &Path, path: &Path) -> std::io::Result<()> {
    std::os::windows::fs::symlink_dir(to, path)
}

#[cfg(not(any(unix, windows)))]
fn link(_: &Path, _: &Path) -> std::io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

/// Returns the path of the finished run that a folder stands for: the folder itself, the one that `latest` leads to, or
/// the last numbered one in it; the folder itself if there is none.
#[must_use]
pub fn find_result(folder: &Path) -> PathBuf {
    if folder.join("run.json").is_file() || folder.join("replay.json").is_file() {
        return folder.to_owned();
    }
    let latest = folder.join("latest");
    let last = || numbers(folder).last().map(|n| folder.join(format!("{n:04}")));
    if latest.is_dir() { latest } else { last().unwrap_or_else(|| folder.to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::test_folder;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn finish(folder: ResultFolder, text: &str) -> PathBuf {
        fs::write(folder.path().join("run.json"), format!("{{\"trace_hash\": \"{text}\"}}")).unwrap();
        folder.publish().unwrap()
    }

    #[test]
    fn numbered_folders_are_never_overwritten_and_latest_leads_to_the_last() {
        let parent = test_folder("numbered").join("results/arm");
        for number in ["0001", "0002", "0003"] {
            let path = finish(ResultFolder::numbered(&parent).unwrap(), number);
            assert_eq!(path.file_name().unwrap(), number);
            assert_eq!(fs::read_link(parent.join("latest")).unwrap(), Path::new(number));
        }
        assert_eq!(names(&parent), ["0001", "0002", "0003", "latest"]);
        assert_eq!(find_result(&parent), parent.join("latest"));
        assert_eq!(numbers(&parent), [1, 2, 3]);
    }

    #[test]
    fn runs_at_once_get_numbers_of_their_own() {
        let parent = test_folder("at-once");
        let (first, second) = (ResultFolder::numbered(&parent).unwrap(), ResultFolder::numbered(&parent).unwrap());
        assert_eq!(finish(second, "b").file_name().unwrap(), "0002");
        assert_eq!(finish(first, "a").file_name().unwrap(), "0001");
        assert_eq!(names(&parent), ["0001", "0002", "latest"]);
    }

    #[test]
    fn an_earlier_result_is_replaced_whole() {
        let target = test_folder("whole").join("out");
        let first = ResultFolder::replace(&target).unwrap();
        fs::write(first.path().join("run.mcap"), "").unwrap();
        finish(first, "first");
        finish(ResultFolder::replace(&target).unwrap(), "second");
        assert_eq!(names(&target), ["run.json"]);
        assert_eq!(names(target.parent().unwrap()), ["out"]);
    }

    #[test]
    fn a_run_that_is_not_published_leaves_everything_as_it_was() {
        let root = test_folder("dropped-run");
        let target = root.join("deep/out");
        drop(ResultFolder::replace(&target).unwrap());
        assert!(names(&root).is_empty(), "{:?}", names(&root));
        finish(ResultFolder::replace(&target).unwrap(), "first");
        let second = ResultFolder::replace(&target).unwrap();
        fs::write(second.path().join("signals.csv.partial"), "t\n0").unwrap();
        drop(second);
        assert!(fs::read_to_string(target.join("run.json")).unwrap().contains("first"));
        assert_eq!((names(&root.join("deep")), names(&target)), (vec!["out".into()], vec!["run.json".into()]));
    }

    #[test]
    fn a_folder_with_anything_else_is_refused_untouched() {
        let target = test_folder("foreign");
        finish(ResultFolder::replace(&target.join("out")).unwrap(), "first");
        let out = target.join("out");
        fs::create_dir_all(out.join("figures")).unwrap();
        for foreign in ["notes.txt", "figures/mine.docx"] {
            fs::write(out.join(foreign), "mine").unwrap();
            let error = ResultFolder::replace(&out).unwrap_err().to_string();
            assert!(error.ends_with(&format!("holds `{foreign}`, which is no part of a result")), "{error}");
            fs::remove_file(out.join(foreign)).unwrap();
        }
        // names of results alone do not make one
        fs::remove_file(out.join("run.json")).unwrap();
        fs::write(out.join("signals.csv"), "mine").unwrap();
        assert!(ResultFolder::replace(&out).is_err());
        assert_eq!(names(&target), ["out"]);
    }

    #[test]
    fn one_process_writes_a_folder_at_a_time() {
        let target = test_folder("locked").join("out");
        let first = ResultFolder::replace(&target).unwrap();
        let error = ResultFolder::replace(&target).unwrap_err();
        assert!(matches!(error, FolderError::Locked(_)), "{error}");
        finish(first, "first");
        assert!(ResultFolder::replace(&target).is_ok());
    }

    #[test]
    fn what_a_killed_process_left_is_cleared() {
        let parent = test_folder("killed");
        let target = parent.join("out");
        finish(ResultFolder::replace(&target).unwrap(), "first");
        // it died between the two renames
        fs::rename(&target, parent.join(".out.earlier")).unwrap();
        fs::create_dir(parent.join(".out.running")).unwrap();
        fs::write(parent.join(".out.running/run.json"), "{").unwrap();
        fs::write(parent.join(".out.lock"), "").unwrap();
        let next = ResultFolder::replace(&target).unwrap();
        assert!(names(next.path()).is_empty() && is_result(&target));
        drop(next);
        assert_eq!(names(&parent), ["out"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_leads_to_the_folder_that_is_replaced() {
        let parent = test_folder("link");
        finish(ResultFolder::numbered(&parent).unwrap(), "first");
        finish(ResultFolder::replace(&parent.join("latest")).unwrap(), "second");
        assert!(fs::read_to_string(parent.join("0001/run.json")).unwrap().contains("second"));
        std::os::unix::fs::symlink("nowhere", parent.join("dangling")).unwrap();
        assert!(ResultFolder::replace(&parent.join("dangling")).is_err());
    }
}

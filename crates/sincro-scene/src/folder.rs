//! The folder of an experiment: reads the files in it, each once, with clear words when it cannot.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::diagnostic::{Diagnostic, Located, SourceText};
use crate::suggest;

/// Largest file that is read [bytes]: whatever is larger is not a scene, and would be read into memory whole.
const MAX_BYTES: u64 = 64 << 20;

/// Folder of a scene with a cache of its files: each is read once, and variants and points of a sweep share what was
/// read. Shared between threads by `Arc`.
#[derive(Debug, Default)]
pub struct Folder {
    path: PathBuf,
    texts: Cache<SourceText>,
    /// Files that are no texts: meshes.
    bytes: Cache<Vec<u8>>,
    /// Two columns of tables of numbers, by path of the file and names of the columns.
    pub(crate) columns: Cache<[Vec<f64>; 2], (PathBuf, [String; 2])>,
}

/// Contents of files by their path, or by a key that tells what of a file it is.
#[derive(Debug)]
pub(crate) struct Cache<T, K = PathBuf>(Mutex<BTreeMap<K, Arc<T>>>);

impl<T, K> Default for Cache<T, K> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T, K: Ord> Cache<T, K> {
    /// The content of a file, read if it is not there yet. Two threads may both read it; they get the same content.
    pub(crate) fn get<E>(&self, key: K, read: impl FnOnce(&K) -> Result<T, E>) -> Result<Arc<T>, E> {
        let known = |cache: &Self| cache.all().get(&key).cloned();
        if let Some(known) = known(self) {
            return Ok(known);
        }
        let content = Arc::new(read(&key)?);
        Ok(self.all().entry(key).or_insert(content).clone())
    }

    fn all(&self) -> std::sync::MutexGuard<'_, BTreeMap<K, Arc<T>>> {
        // a reader that panicked has put nothing half-made into the map
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Folder {
    /// Creates the cache of the folder at `path`; nothing is read yet.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), ..Self::default() }
    }

    /// Returns the path of the file `name` of the folder, as it is shown to the user; the file need not exist.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Returns the text of the file `name` of the folder, read at the first call.
    ///
    /// # Errors
    ///
    /// A diagnostic without location: the file does not exist, cannot be read, is larger than 64 MiB or is not UTF-8.
    pub fn read(&self, name: &str) -> Result<Arc<SourceText>, Diagnostic> {
        self.text(name).map_err(Diagnostic::without_location)
    }

    /// Returns the text of a file whose name, relative to the folder, was written in another file.
    ///
    /// # Errors
    ///
    /// A diagnostic at the name, with similar files as remedy: the path is absolute, or the file cannot be read as in
    /// [`Folder::read`].
    pub fn read_named(&self, name: &Located<String>) -> Result<Arc<SourceText>, Diagnostic> {
        self.named(name, |path| self.text(path))
    }

    fn named<T>(&self, name: &Located<String>, read: impl Fn(&str) -> Result<T, String>) -> Result<T, Diagnostic> {
        let path = Path::new(&name.value);
        if path.components().any(|c| matches!(c, Component::RootDir | Component::Prefix(_))) {
            let diagnostic = Diagnostic::error(&name.at, format!("the path `{}` is absolute", name.value));
            return Err(diagnostic.with_help("give it relative to the folder, so that the folder can be moved"));
        }
        read(&name.value).map_err(|message| {
            let diagnostic = Diagnostic::error(&name.at, message);
            match self.neighbours(path) {
                Some(help) => diagnostic.with_help(help),
                None => diagnostic,
            }
        })
    }

    /// Bytes of a file that is named in a file, whatever is in it.
    pub(crate) fn bytes_named(&self, name: &Located<String>) -> Result<Arc<Vec<u8>>, Diagnostic> {
        self.named(name, |path| self.bytes.get(self.path_of(path), |path| read_bytes(path)))
    }

    /// Gives the bytes of the file `name` of the folder, which are not read from there then.
    pub fn keep(&self, name: &str, bytes: Arc<Vec<u8>>) {
        self.bytes.all().insert(self.path_of(name), bytes);
    }

    /// Bytes of a file of the folder.
    pub(crate) fn bytes(&self, name: &str) -> Result<Arc<Vec<u8>>, String> {
        self.bytes.get(self.path_of(name), |path| read_bytes(path))
    }

    /// Returns every file read so far, its path and its bytes: texts, then other files, each ordered by path.
    pub fn files(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let texts = self.texts.all();
        let texts = texts.iter().map(|(path, source)| (path.clone(), source.text.clone().into_bytes()));
        let bytes = self.bytes.all();
        texts.chain(bytes.iter().map(|(path, bytes)| (path.clone(), (**bytes).clone()))).collect()
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns every text file read so far, ordered by path.
    pub fn sources(&self) -> Vec<Arc<SourceText>> {
        self.texts.all().values().cloned().collect()
    }

    fn text(&self, name: &str) -> Result<Arc<SourceText>, String> {
        self.texts.get(self.path_of(name), |path| Ok(SourceText { text: read_text(path)?, path: path.clone() }))
    }

    /// A help that names files of the same kind beside one that is not there.
    fn neighbours(&self, missing: &Path) -> Option<String> {
        let path = self.path.join(missing);
        let beside = std::fs::read_dir(path.parent()?).ok()?;
        let mut names: Vec<String> = beside
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| {
                Path::new(name).extension() == missing.extension() && path.file_name() != Some(name.as_ref())
            })
            .collect();
        names.sort();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        (!names.is_empty()).then(|| suggest::help(missing.to_str().unwrap_or(""), &names, "files there"))
    }
}

/// Reads a whole file, or says in words why not.
fn read_bytes(path: &Path) -> Result<Vec<u8>, String> {
    let shown = path.display();
    let refused = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => format!("there is no file `{shown}`"),
        ErrorKind::PermissionDenied => format!("`{shown}` may not be read (permission denied)"),
        _ => format!("`{shown}` cannot be read: {error}"),
    };
    let metadata = std::fs::metadata(path).map_err(refused)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a folder" } else { "a device or pipe" };
        return Err(format!("`{shown}` is {what}, not a file"));
    }
    let too_large = |n: u64| format!("`{shown}` has {n} bytes, more than {} MiB", MAX_BYTES >> 20);
    if metadata.len() > MAX_BYTES {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::new();
    // what grows while it is read is cut off too
    let file = std::fs::File::open(path).map_err(refused)?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(refused)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// Reads a whole UTF-8 text file.
///
/// # Errors
///
/// What is wrong, in words: there is no such file, it may not be read, is a device or pipe, too large, or not UTF-8.
pub fn read_text(path: &Path) -> Result<String, String> {
    let (bytes, shown) = (read_bytes(path)?, path.display());
    let text = String::from_utf8(bytes).map_err(|error| {
        let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|b| **b == b'\n').count();
        format!("`{shown}` is not UTF-8 text (line {line})")
    })?;
    // a byte-order mark of an editor is no part of the text
    Ok(text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned))
}

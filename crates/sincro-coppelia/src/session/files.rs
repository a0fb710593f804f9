//! Files that clients send, if the server permits it: in one folder of the session, with plain names, not
//! too many.

use std::fs;
use std::path::{Path, PathBuf};

use super::ApiError;

/// Files that may be there at once.
const MAX_FILES: usize = 200;
/// Bytes of all of them.
const MAX_BYTES: u64 = 64 << 20;
/// Longest name.
const MAX_NAME_LEN: usize = 200;

/// A folder for what clients send.
#[derive(Clone, Debug)]
pub struct Files {
    folder: PathBuf,
}

impl Files {
    /// In a folder, which is made when the first file comes.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Folder of the files.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The place of a name: the last part of what the client calls it.
    ///
    /// # Errors
    ///
    /// It is no plain name.
    pub fn place(&self, name: &str) -> Result<PathBuf, ApiError> {
        let is_plain = !name.is_empty()
            && name.len() <= MAX_NAME_LEN
            && !name.starts_with('.')
            && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | ' '));
        if is_plain {
            return Ok(self.folder.join(name));
        }
        let short: String = name.chars().take(100).collect();
        Err(ApiError(format!(
            "`{short}` is no name of a file here: letters, digits, `.`, `_`, `-` and spaces, no folders"
        )))
    }

    /// Keeps a file; one of the same name is replaced.
    ///
    /// # Errors
    ///
    /// It is no plain name, there are too many or too large ones, or it cannot be written.
    pub fn put(&self, name: &str, bytes: &[u8]) -> Result<(), ApiError> {
        let place = self.place(name)?;
        let refused = |e: std::io::Error| ApiError(format!("`{name}` cannot be written: {e}"));
        fs::create_dir_all(&self.folder).map_err(refused)?;
        let (mut n, mut total) = (0, bytes.len() as u64);
        for other in fs::read_dir(&self.folder).map_err(refused)?.flatten().filter(|other| other.path() != place) {
            n += 1;
            total += other.metadata().map_or(0, |about| about.len());
        }
        if n >= MAX_FILES || total > MAX_BYTES {
            let mib = MAX_BYTES >> 20;
            return Err(ApiError(format!("clients may send {MAX_FILES} files of {mib} MiB together: erase some")));
        }
        fs::write(place, bytes).map_err(refused)
    }

    /// Removes a file that a client has sent.
    ///
    /// # Errors
    ///
    /// There is none of that name.
    pub fn erase(&self, name: &str) -> Result<(), ApiError> {
        let place = self.place(name)?;
        fs::remove_file(place).map_err(|_| ApiError(format!("there is no file `{name}` that a client has sent")))
    }
}

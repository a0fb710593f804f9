//! Files that clients send, if the server permits it: in one folder of the session, with plain names, not
//! too many.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use sincro_scene::script::Script;

use super::ApiError;
use crate::api::functions;

/// Files that may be there at once.
const MAX_FILES: usize = 200;
/// Bytes of all of them.
const MAX_BYTES: u64 = 64 << 20;

/// Instructions that one call of a script of a sent scene may take.
const MAX_INSTRUCTIONS: u64 = 1_000_000_000;
/// Memory of a script of a sent scene [bytes].
const MAX_MEMORY: usize = 256 << 20;

/// Checks that the scripts of a scene that a client has sent ask for no more than the server lets them.
///
/// # Errors
///
/// A script has larger limits.
pub(super) fn check_limits(scripts: &[Script]) -> Result<(), ApiError> {
    let greedy = |script: &&Script| script.max_instructions > MAX_INSTRUCTIONS || script.max_memory > MAX_MEMORY;
    scripts.iter().find(greedy).map_or(Ok(()), |script| {
        Err(ApiError(format!(
            "the script of `{}` asks for too much: scenes of clients have at most {MAX_INSTRUCTIONS} instructions a call and {} MiB",
            script.path,
            MAX_MEMORY >> 20
        )))
    })
}

/// Returns true if a text in a value is a path that leads upwards.
fn leads_out(value: &toml::Value) -> bool {
    match value {
        toml::Value::String(text) => text.split(['/', '\\']).any(|part| part == ".."),
        toml::Value::Array(list) => list.iter().any(leads_out),
        toml::Value::Table(table) => table.values().any(leads_out),
        _ => false,
    }
}

/// Folder for the files that clients of a session send, if the server permits it
/// ([`Grants::files`](super::Grants::files)), with the names of those that they have sent: up to 200 files of 64 MiB
/// together. Other files in it are never read or replaced.
#[derive(Clone, Debug)]
pub struct Files {
    folder: PathBuf,
    sent: BTreeSet<PathBuf>,
}

impl Files {
    /// Creates the record of a folder, which is made when the first file arrives.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Self { folder, sent: BTreeSet::new() }
    }

    /// Folder of the files.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The place of a name: the last part of what the client calls it.
    ///
    /// # Errors
    ///
    /// It is no plain name.
    pub(crate) fn place(&self, name: &str) -> Result<PathBuf, ApiError> {
        functions::check_file_name(name)?;
        Ok(self.folder.join(name))
    }

    /// Returns true if a client has sent the file of a place.
    #[must_use]
    pub(crate) fn has(&self, place: &Path) -> bool {
        self.sent.contains(place)
    }

    /// Writes a file that a client sends; one of the same name that a client has sent before is replaced. `name` is
    /// letters, digits, `.`, `_`, `-` and spaces, 200 bytes at most, without folders.
    ///
    /// # Errors
    ///
    /// The name is not allowed, a file that no client has sent has it, the limits of number and size are exceeded, or
    /// the file cannot be written; the message says which.
    pub fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), ApiError> {
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
        if self.has(&place) {
            fs::remove_file(&place).map_err(refused)?;
        }
        // made anew: nothing that was there is written over, and no link is followed
        let mut file = fs::OpenOptions::new().write(true).create_new(true).open(&place).map_err(refused)?;
        file.write_all(bytes).map_err(refused)?;
        self.sent.insert(place);
        Ok(())
    }

    /// Checks, before any of them is opened as a scene, that no file that clients have sent names one outside the
    /// folder.
    ///
    /// # Errors
    ///
    /// A text in one of them has `..` as a part of a path.
    pub(crate) fn check_references(&self) -> Result<(), ApiError> {
        for place in &self.sent {
            let Ok(text) = fs::read_to_string(place) else { continue };
            let Ok(table) = text.parse::<toml::Table>() else { continue };
            if table.values().any(leads_out) {
                let name = place.file_name().unwrap_or_default().to_string_lossy();
                return Err(ApiError(format!("`{name}` names a file outside its folder, which no client has sent")));
            }
        }
        Ok(())
    }

    /// Removes a file that a client has sent, by the name that it was sent with.
    ///
    /// # Errors
    ///
    /// No client has sent a file of that name, or it cannot be removed.
    pub fn erase(&mut self, name: &str) -> Result<(), ApiError> {
        let place = self.place(name)?;
        if !self.sent.remove(&place) {
            return Err(ApiError(format!("there is no file `{name}` that a client has sent")));
        }
        fs::remove_file(place).map_err(|e| ApiError(format!("`{name}` cannot be erased: {e}")))
    }
}

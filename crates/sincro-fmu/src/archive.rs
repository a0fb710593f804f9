//! Archives: FMUs are zip files. Writing gives the same bytes for the same files; reading guards against hostile ones.

use std::io::{Cursor, Read, Write};
use std::path::{Component, Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Largest size of an archive's unpacked content `[bytes]`: 2 GiB.
const MAX_BYTES: u64 = 2 << 30;
/// Largest number of entries.
const MAX_ENTRIES: usize = 100_000;
/// Largest ratio of unpacked to packed size, above a size that does no harm; deflate reaches 1,032.
const MAX_RATIO: u64 = 200;
/// Unpacked size up to which the ratio does not matter `[bytes]`: 64 MiB.
const HARMLESS_BYTES: u64 = 64 << 20;

/// Compression level of deflate: the greatest.
const BEST_DEFLATE: i64 = 9;

/// File of an archive: its path inside, with `/` between the parts, and its content.
pub type ArchiveFile = (String, Vec<u8>);

/// Packs files into a zip archive, in their order; the same files give the same bytes.
///
/// ```
/// use sincro_fmu::archive::{pack, unpack};
///
/// let files = [("resources/sincro.json".to_owned(), b"{}".to_vec())];
/// assert_eq!(unpack(&pack(&files)?)?, files);
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
///
/// Two files have the same path, or one is too large for the format (the message names it).
pub fn pack(files: &[ArchiveFile]) -> Result<Vec<u8>, String> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    // no clock: the same files give the same archive
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(BEST_DEFLATE))
        .last_modified_time(zip::DateTime::default())
        .unix_permissions(0o644);
    for (name, bytes) in files {
        let packed = writer.start_file(name.as_str(), options).map_err(|error| error.to_string());
        packed
            .and_then(|()| writer.write_all(bytes).map_err(|error| error.to_string()))
            .map_err(|why| format!("`{name}` cannot be packed: {why}"))?;
    }
    let done = writer.finish().map_err(|error| format!("the archive cannot be finished: {error}"))?;
    Ok(done.into_inner())
}

/// Unpacks all files of a zip archive into memory, in its order, folders left out. Made for archives that may be
/// hostile.
///
/// # Errors
///
/// The bytes are no zip archive or damaged; an entry is a symbolic link or would lie outside the folder; there are more
/// than 100,000 entries; or they unpack to more than 2 GiB, or 200 times the archive if that is more than 64 MiB. The
/// text says which.
pub fn unpack(bytes: &[u8]) -> Result<Vec<ArchiveFile>, String> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| format!("it is no zip archive: {error}"))?;
    if archive.len() > MAX_ENTRIES {
        return Err(format!("it has {} entries, {MAX_ENTRIES} at most are unpacked", archive.len()));
    }
    let (mut files, mut total) = (Vec::new(), 0);
    let bound = MAX_BYTES.min((bytes.len() as u64).saturating_mul(MAX_RATIO).max(HARMLESS_BYTES));
    for k in 0..archive.len() {
        let entry = archive.by_index(k).map_err(|error| format!("entry {k} cannot be read: {error}"))?;
        let name = inner_path(entry.name())?;
        if entry.is_symlink() {
            return Err(format!("the entry `{name}` is a symbolic link"));
        }
        if entry.is_dir() {
            continue;
        }
        // sizes in the archive may be lies: what counts is what comes out
        let mut content = Vec::new();
        entry
            .take(bound - total + 1)
            .read_to_end(&mut content)
            .map_err(|error| format!("the entry `{name}` cannot be unpacked: {error}"))?;
        total += content.len() as u64;
        if total > bound {
            return Err(format!("it unpacks to more than {} MB", bound / 1_000_000));
        }
        files.push((name, content));
    }
    Ok(files)
}

/// A name that stays inside the folder, with `/` between its parts.
fn inner_path(name: &str) -> Result<String, String> {
    let outside = || format!("the entry `{}` would lie outside the folder", name.escape_debug());
    let flat = name.replace('\\', "/");
    if flat.contains('\0') || flat.contains(':') {
        return Err(outside());
    }
    let mut parts = Vec::new();
    for part in Path::new(&flat).components() {
        match part {
            Component::Normal(part) => parts.push(part.to_str().ok_or_else(outside)?),
            Component::CurDir => {}
            _ => return Err(outside()),
        }
    }
    Ok(parts.join("/"))
}

/// Writes unpacked files below a folder, which must exist; folders inside it are made.
///
/// # Errors
///
/// A file or folder cannot be written; the text has its path. Files before it have been written.
pub fn write_files(folder: &Path, files: &[ArchiveFile]) -> Result<(), String> {
    for (name, bytes) in files {
        let path: PathBuf = folder.join(name);
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        made.and_then(|()| std::fs::write(&path, bytes))
            .map_err(|error| format!("`{}` cannot be written: {error}", path.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str, bytes: &[u8]) -> ArchiveFile {
        (name.to_owned(), bytes.to_vec())
    }

    #[test]
    fn files_come_back_and_archives_are_reproducible() {
        let files = [file("modelDescription.xml", b"<x/>"), file("resources/a b.txt", &[7; 10_000])];
        let packed = pack(&files).unwrap();
        assert_eq!(packed, pack(&files).unwrap());
        assert_eq!(unpack(&packed).unwrap(), files);
    }

    #[test]
    fn entries_outside_the_folder_are_refused() {
        for name in ["../evil", "a/../../evil", "/etc/evil", "..\\evil", "C:evil", "a/\0b"] {
            let packed = pack(&[file(name, b"x")]).unwrap();
            let refused = unpack(&packed).unwrap_err();
            assert!(refused.contains("outside the folder"), "{name}: {refused}");
        }
    }

    #[test]
    fn bombs_are_refused() {
        let packed = pack(&[file("a", &vec![0; 80 << 20])]).unwrap();
        assert!(packed.len() < 200_000);
        assert!(unpack(&packed).unwrap_err().contains("unpacks to more than"));
    }

    #[test]
    fn damaged_archives_are_refused() {
        let packed = pack(&[file("a", &[1; 300]), file("b", b"text")]).unwrap();
        let mut seed = 1_u64;
        for k in 0..2_000 {
            let mut damaged = packed.clone();
            for _ in 0..1 + k % 4 {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let at = (seed >> 33) as usize % damaged.len();
                damaged[at] ^= 1 << (seed >> 29 & 7);
            }
            damaged.truncate(packed.len() - k % 7);
            // an error or files; no panic
            let _ = unpack(&damaged);
        }
        assert!(unpack(b"").is_err());
    }
}

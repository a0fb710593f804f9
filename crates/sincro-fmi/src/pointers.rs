//! Pointers of C as slices and texts.

use std::borrow::Cow;
use std::ffi::{CStr, c_char};
use std::path::PathBuf;

/// `n` values at a pointer; none if it is null (unless `n` is 0), not aligned, or longer than memory.
///
/// # Safety
///
/// A pointer that is not null must point to `n` values that nobody changes during `'a`.
pub(crate) unsafe fn slice<'a, T>(pointer: *const T, n: usize) -> Option<&'a [T]> {
    if n == 0 {
        return Some(&[]);
    }
    let fits = !pointer.is_null() && pointer.is_aligned() && n <= isize::MAX as usize / size_of::<T>().max(1);
    // SAFETY: not null, aligned, of a length that fits; the rest is the caller's promise
    fits.then(|| unsafe { std::slice::from_raw_parts(pointer, n) })
}

/// As [`slice`], to be written.
///
/// # Safety
///
/// As [`slice`]; nobody else may look at the values during `'a`.
pub(crate) unsafe fn slice_mut<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [T]> {
    if n == 0 {
        return Some(&mut []);
    }
    let fits = !pointer.is_null() && pointer.is_aligned() && n <= isize::MAX as usize / size_of::<T>().max(1);
    // SAFETY: as in `slice`
    fits.then(|| unsafe { std::slice::from_raw_parts_mut(pointer, n) })
}

/// Writes a result of a call; false if there is no place for it.
///
/// # Safety
///
/// A pointer that is not null must point to a place for a `T`.
pub(crate) unsafe fn write<T>(pointer: *mut T, value: T) -> bool {
    if pointer.is_null() || !pointer.is_aligned() {
        return false;
    }
    // SAFETY: not null and aligned; the rest is the caller's promise
    unsafe { pointer.write(value) };
    true
}

/// Text at a pointer; none if it is null.
///
/// # Safety
///
/// A pointer that is not null must point to a text that ends in a zero, and that nobody changes during `'a`.
pub(crate) unsafe fn text<'a>(pointer: *const c_char) -> Option<Cow<'a, str>> {
    // SAFETY: not null; the rest is the caller's promise
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy())
}

/// Path of a resource location of FMI 2: a URI such as `file:///tmp/a%20b/resources`, or a plain path.
pub(crate) fn path_of_uri(uri: &str) -> Result<PathBuf, String> {
    let Some(rest) = uri.strip_prefix("file:") else {
        if uri.contains("://") {
            return Err(format!("resources at `{uri}` cannot be read: only the scheme `file` is known"));
        }
        return Ok(PathBuf::from(uri));
    };
    let path = match rest.strip_prefix("//") {
        // the host comes before the next stroke: none, or this one
        Some(after) => match after.split_once('/') {
            Some(("" | "localhost" | "127.0.0.1", path)) => format!("/{path}"),
            _ => return Err(format!("resources at `{uri}` are on another machine")),
        },
        None => rest.to_owned(),
    };
    let path = decoded(&path).ok_or_else(|| format!("`{uri}` is no URI: a `%` without two digits"))?;
    // `/C:/…` of Windows
    let has_drive = path.as_bytes().get(2) == Some(&b':') && path.as_bytes()[1].is_ascii_alphabetic();
    Ok(PathBuf::from(if has_drive { &path[1..] } else { &path }))
}

/// A text with `%20` and the like replaced.
fn decoded(text: &str) -> Option<String> {
    let mut out = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((byte, after)) = rest.split_first() {
        rest = after;
        if *byte == b'%' {
            let (digits, after) = rest.split_first_chunk::<2>()?;
            let digits = std::str::from_utf8(digits).ok().filter(|d| d.chars().all(|c| c.is_ascii_hexdigit()))?;
            out.push(u8::from_str_radix(digits, 16).ok()?);
            rest = after;
        } else {
            out.push(*byte);
        }
    }
    String::from_utf8(out).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_become_paths() {
        let path = |uri: &str| path_of_uri(uri).unwrap().to_string_lossy().into_owned();
        assert_eq!(path("file:///tmp/a%20b/resources"), "/tmp/a b/resources");
        assert_eq!(path("file:/tmp/x"), "/tmp/x");
        assert_eq!(path("file://localhost/tmp/x"), "/tmp/x");
        assert_eq!(path("file:///C:/fmu/resources"), "C:/fmu/resources");
        assert_eq!(path("/tmp/plain"), "/tmp/plain");
        assert!(path_of_uri("https://example.org/x").is_err());
        assert!(path_of_uri("file://other/x").is_err());
        assert!(path_of_uri("file:///tmp/%2").is_err());
        assert!(path_of_uri("file:///tmp/%+1").is_err());
    }
}

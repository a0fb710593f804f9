//! Xacro macros, expanded by the program `xacro` if it is installed: they are a language of their own.

use std::path::Path;
use std::process::{Command, Stdio};

use sincro_scene::diagnostic::Diagnostic;

use crate::source::{MAX_BYTES, SourceFile};

/// The URDF text that a xacro file expands to; lines are those of the expanded text.
pub(crate) fn expanded(path: &Path) -> Result<SourceFile, Diagnostic> {
    if !path.is_file() {
        return Err(Diagnostic::without_location(format!("there is no file `{}`", path.display())));
    }
    let output = Command::new("xacro").arg(path).stdin(Stdio::null()).output().map_err(|_| {
        Diagnostic::without_location(format!(
            "`{}` is a xacro file, and there is no program `xacro` here",
            path.display()
        ))
        .with_help("pip install xacro, or expand it elsewhere and import the URDF")
    })?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr);
        let last = words.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given").to_owned();
        return Err(Diagnostic::without_location(format!("xacro refuses `{}`: {last}", path.display())));
    }
    if output.stdout.len() as u64 > MAX_BYTES {
        return Err(Diagnostic::without_location(format!(
            "`{}` expands to more than {} MiB",
            path.display(),
            MAX_BYTES >> 20
        )));
    }
    let text = String::from_utf8(output.stdout)
        .map_err(|_| Diagnostic::without_location(format!("xacro gives no UTF-8 text for `{}`", path.display())))?;
    Ok(SourceFile::of_text(path, text))
}

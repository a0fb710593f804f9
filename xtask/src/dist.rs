//! `cargo xtask dist`: the program as it is given away, and the bound on its size.

use std::path::Path;

/// Bound on the size of the program `[bytes]`: 25 MB.
const MAX_BYTES: u64 = 25_000_000;

/// Prints the size of the built program; true if it keeps the bound.
pub fn size_holds(root: &Path) -> bool {
    let program = format!("sincro{}", std::env::consts::EXE_SUFFIX);
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into);
    let path = target.join("dist").join(program);
    let Ok(metadata) = std::fs::metadata(&path) else {
        println!("`{}` was not built", path.display());
        return false;
    };
    let bytes = metadata.len();
    let holds = bytes <= MAX_BYTES;
    let verdict = if holds { "within" } else { "ABOVE" };
    println!("{}: {:.2} MB, {verdict} {:.0} MB", path.display(), bytes as f64 * 1e-6, MAX_BYTES as f64 * 1e-6);
    holds
}

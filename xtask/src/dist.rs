//! `cargo xtask dist`: the program as it is given away, and the bound on its size.

use std::path::Path;

/// Bound on the size of the program `[bytes]`: 25 MB.
const MAX_BYTES: u64 = 25_000_000;

/// Bound on the size of the library in every FMU `[bytes]`: 15 MB, less than 6 MB when packed.
const MAX_LIBRARY_BYTES: u64 = 15_000_000;

/// Prints the sizes of the built program and of the library beside it; true if they keep their bounds.
pub fn size_holds(root: &Path) -> bool {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
    let program = one_holds(root, &format!("sincro{EXE_SUFFIX}"), MAX_BYTES);
    one_holds(root, &format!("{DLL_PREFIX}sincro_fmi{DLL_SUFFIX}"), MAX_LIBRARY_BYTES) && program
}

fn one_holds(root: &Path, name: &str, bound: u64) -> bool {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into);
    let path = target.join("dist").join(name);
    let Ok(metadata) = std::fs::metadata(&path) else {
        println!("`{}` was not built", path.display());
        return false;
    };
    let bytes = metadata.len();
    let holds = bytes <= bound;
    let verdict = if holds { "within" } else { "ABOVE" };
    println!("{}: {:.2} MB, {verdict} {:.0} MB", path.display(), bytes as f64 * 1e-6, bound as f64 * 1e-6);
    holds
}

//! `cargo xtask dist`: the program as it is given away, a tar and a Debian package of it, and the bounds on sizes.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Bound on the size of the program `[bytes]`: 25 MB.
const MAX_BYTES: u64 = 25_000_000;

/// Bound on the size of the library in every FMU `[bytes]`: 15 MB, less than 6 MB when packed.
const MAX_LIBRARY_BYTES: u64 = 15_000_000;

/// Prints the sizes of the built program and of the library beside it; true if they keep their bounds.
pub fn size_holds(root: &Path) -> bool {
    let [program, library] = built(root);
    one_holds(&program, MAX_BYTES) && one_holds(&library, MAX_LIBRARY_BYTES)
}

/// Packs the built program with its library, licences and the README: `sincro-VERSION-ARCH-OS.tar.gz`, and on Linux,
/// where `ar` is there, `sincro_VERSION_ARCH.deb`. True if all of them were made.
pub fn pack(root: &Path) -> bool {
    match packages(root) {
        Ok(made) => {
            for path in made {
                let size = fs::metadata(&path).map_or(0, |file| file.len());
                println!("{}: {:.2} MB", path.display(), size as f64 * 1e-6);
            }
            true
        }
        Err(message) => {
            println!("{message}");
            false
        }
    }
}

/// Folder of the profile `dist`.
fn folder(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into).join("dist")
}

/// The program and the library of FMUs.
fn built(root: &Path) -> [PathBuf; 2] {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
    let folder = folder(root);
    [folder.join(format!("sincro{EXE_SUFFIX}")), folder.join(format!("{DLL_PREFIX}sincro_fmi{DLL_SUFFIX}"))]
}

fn one_holds(path: &Path, bound: u64) -> bool {
    let Ok(metadata) = fs::metadata(path) else {
        println!("`{}` was not built", path.display());
        return false;
    };
    let bytes = metadata.len();
    let holds = bytes <= bound;
    let verdict = if holds { "within" } else { "ABOVE" };
    println!("{}: {:.2} MB, {verdict} {:.0} MB", path.display(), bytes as f64 * 1e-6, bound as f64 * 1e-6);
    holds
}

fn packages(root: &Path) -> Result<Vec<PathBuf>, String> {
    let (target, version) = (folder(root), env!("CARGO_PKG_VERSION"));
    let (architecture, system) = (std::env::consts::ARCH, std::env::consts::OS);
    let name = format!("sincro-{version}-{architecture}-{system}");
    let tree = fresh(&target.join(&name))?;
    for file in
        built(root).iter().chain(&[root.join("README.md"), root.join("LICENSE-MIT"), root.join("LICENSE-APACHE")])
    {
        copy(file, &tree)?;
    }
    let tar = target.join(format!("{name}.tar.gz"));
    archive(&target, &tar, &[&name])?;
    let mut made = vec![tar];
    if system == "linux" && Command::new("ar").arg("--version").stdout(Stdio::null()).status().is_ok() {
        made.push(debian(root, &target, version)?);
    }
    Ok(made)
}

/// A Debian package, put together by `tar` and `ar`: `debian-binary`, `control.tar.gz`, `data.tar.gz`.
fn debian(root: &Path, target: &Path, version: &str) -> Result<PathBuf, String> {
    let architecture = match std::env::consts::ARCH {
        "x86_64" => "amd64",
        "aarch64" => "arm64",
        other => other,
    };
    let work = fresh(&target.join("debian"))?;
    let data = fresh(&work.join("data"))?;
    for (file, place) in built(root).iter().zip(["usr/bin", "usr/bin"]) {
        copy(file, &fresh_below(&data, place)?)?;
    }
    let documents = fresh_below(&data, "usr/share/doc/sincro")?;
    for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        copy(&root.join(file), &documents)?;
    }
    let bytes: u64 = built(root).iter().filter_map(|path| fs::metadata(path).ok()).map(|file| file.len()).sum();
    let control = format!(
        "Package: sincro\nVersion: {version}\nArchitecture: {architecture}\nMaintainer: the authors of sincro <sincro@localhost>\n\
         Installed-Size: {}\nDepends: libc6, libgcc-s1\nSection: science\nPriority: optional\n\
         Description: deterministic simulation of robots and their controllers in lock-step\n",
        bytes / 1024
    );
    write(&work.join("control"), &control)?;
    write(&work.join("debian-binary"), "2.0\n")?;
    archive(&work, &work.join("control.tar.gz"), &["control"])?;
    archive(&data, &work.join("data.tar.gz"), &["usr"])?;
    let package = target.join(format!("sincro_{version}_{architecture}.deb"));
    let _ = fs::remove_file(&package);
    let parts = ["debian-binary", "control.tar.gz", "data.tar.gz"];
    run(Command::new("ar").current_dir(&work).arg("rcsD").arg(&package).args(parts))?;
    Ok(package)
}

/// An empty folder.
fn fresh(path: &Path) -> Result<PathBuf, String> {
    let _ = fs::remove_dir_all(path);
    fresh_below(path, "")
}

/// A folder that may be there.
fn fresh_below(folder: &Path, place: &str) -> Result<PathBuf, String> {
    let path = folder.join(place);
    fs::create_dir_all(&path).map_err(|e| format!("`{}` cannot be made: {e}", path.display()))?;
    Ok(path)
}

fn copy(file: &Path, folder: &Path) -> Result<(), String> {
    let to = folder.join(file.file_name().unwrap_or_default());
    fs::copy(file, &to).map(|_| ()).map_err(|e| format!("`{}` cannot be copied: {e}", file.display()))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    let written = fs::File::create(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|e| format!("`{}` cannot be written: {e}", path.display()))
}

/// Packs parts of a folder; owners and times are those of no machine.
fn archive(folder: &Path, to: &Path, parts: &[&str]) -> Result<(), String> {
    let plain = ["--owner=0", "--group=0", "--numeric-owner", "--sort=name", "--mtime=@0"];
    run(Command::new("tar").current_dir(folder).args(plain).arg("-czf").arg(to).args(parts))
}

fn run(command: &mut Command) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} ended with {status}")),
        Err(error) => Err(format!("{command:?} cannot be started: {error}")),
    }
}

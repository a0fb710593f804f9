//! `cargo xtask dist`: the program as it is given away, a tar and a Debian package of it, and the bounds on sizes.
//!
//! With `--glibc VERSION` program and library run on systems with that version of the C library or a newer one,
//! whatever the machine has that builds them: `cargo-zigbuild` links against the symbols of that version.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Bound on the size of the program `[bytes]`: 25 MB.
const MAX_BYTES: u64 = 25_000_000;

/// Bound on the size of the library in every FMU `[bytes]`: 15 MB, less than 6 MB when packed.
const MAX_LIBRARY_BYTES: u64 = 15_000_000;

/// Request of `dist`: the oldest version of glibc that the packages must run with, such as `2.28`; that of this
/// machine if none is given.
#[derive(Clone, Debug, Default)]
pub struct Request {
    glibc: Option<Version>,
}

/// Version of glibc: the numbers of `2.28` or `2.2.5`.
type Version = Vec<u32>;

impl Request {
    /// Reads the arguments after `dist`.
    ///
    /// # Errors
    ///
    /// A text for the user: an argument is unknown, or a version is none.
    pub fn read(arguments: &[String]) -> Result<Self, String> {
        match arguments {
            [] => Ok(Self::default()),
            [option, text] if option == "--glibc" => {
                let glibc = version(text).filter(|v| v.len() > 1).ok_or_else(|| format!("`{text}` is no version"))?;
                Ok(Self { glibc: Some(glibc) })
            }
            _ => Err("usage: cargo xtask dist [--glibc VERSION]".to_owned()),
        }
    }

    /// Arguments for cargo that build the program and the library.
    #[must_use]
    pub fn build(&self) -> Vec<String> {
        let packages = ["--profile", "dist", "--package", "sincro", "--package", "sincro-fmi"];
        let mut arguments = vec![if self.glibc.is_some() { "zigbuild" } else { "build" }.to_owned()];
        arguments.extend(packages.map(str::to_owned));
        if let Some(glibc) = &self.glibc {
            arguments.extend(["--target".to_owned(), format!("{}.{}", triple(), shown(glibc))]);
        }
        arguments
    }

    /// Prints sizes and versions of glibc of what was built; true if they keep their bounds.
    #[must_use]
    pub fn holds(&self, root: &Path) -> bool {
        let [program, library] = self.built(root);
        size_holds(&program, MAX_BYTES)
            && size_holds(&library, MAX_LIBRARY_BYTES)
            && [program, library].iter().all(|path| self.glibc_holds(path))
    }

    /// Prints the oldest glibc that a built file runs with; true if it is no newer than asked for.
    fn glibc_holds(&self, path: &Path) -> bool {
        let Some(needed) = fs::read(path).ok().and_then(|bytes| needed_glibc(&bytes)) else {
            return true;
        };
        let holds = self.glibc.as_ref().is_none_or(|asked| needed <= *asked);
        let verdict = if holds { "" } else { ", NEWER than asked for" };
        println!("{}: glibc {} or newer{verdict}", path.display(), shown(&needed));
        holds
    }

    /// Folder of the profile `dist`.
    fn folder(&self, root: &Path) -> PathBuf {
        let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into);
        if self.glibc.is_some() { target.join(triple()).join("dist") } else { target.join("dist") }
    }

    /// The program and the library of FMUs.
    fn built(&self, root: &Path) -> [PathBuf; 2] {
        use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
        let folder = self.folder(root);
        [folder.join(format!("sincro{EXE_SUFFIX}")), folder.join(format!("{DLL_PREFIX}sincro_fmi{DLL_SUFFIX}"))]
    }
}

/// Target of this machine, as cargo names it; glibc is that of Linux alone.
fn triple() -> String {
    format!("{}-unknown-linux-gnu", std::env::consts::ARCH)
}

fn version(text: &str) -> Option<Version> {
    text.split('.').map(|part| part.parse().ok()).collect()
}

fn shown(version: &[u32]) -> String {
    version.iter().map(u32::to_string).collect::<Vec<_>>().join(".")
}

/// Newest version of glibc whose symbols a program or library names (`GLIBC_2.28`); none if it names none.
fn needed_glibc(bytes: &[u8]) -> Option<Version> {
    const PREFIX: &[u8] = b"GLIBC_";
    let is_of_version = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
    let starts = bytes.windows(PREFIX.len()).enumerate().filter(|(_, window)| *window == PREFIX);
    let versions = starts.filter_map(|(at, _)| {
        let digits: Vec<u8> = bytes[at + PREFIX.len()..].iter().take_while(is_of_version).copied().collect();
        version(std::str::from_utf8(&digits).ok()?)
    });
    versions.max()
}

/// Packs the built program with its library, licences and the README: `sincro-VERSION-ARCH-OS.tar.gz`, and on Linux,
/// where `ar` is there, `sincro_VERSION_ARCH.deb`. True if all of them were made.
pub fn pack(root: &Path, request: &Request) -> bool {
    match packages(root, request) {
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

fn size_holds(path: &Path, bound: u64) -> bool {
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

fn packages(root: &Path, request: &Request) -> Result<Vec<PathBuf>, String> {
    let (target, version) = (request.folder(root), env!("CARGO_PKG_VERSION"));
    let (architecture, system) = (std::env::consts::ARCH, std::env::consts::OS);
    let name = format!("sincro-{version}-{architecture}-{system}");
    let tree = fresh(&target.join(&name))?;
    for file in request.built(root).iter().chain(&[
        root.join("README.md"),
        root.join("LICENSE-MIT"),
        root.join("LICENSE-APACHE"),
    ]) {
        copy(file, &tree)?;
    }
    let tar = target.join(format!("{name}.tar.gz"));
    archive(&target, &tar, &[&name])?;
    let mut made = vec![tar];
    if system == "linux" && Command::new("ar").arg("--version").stdout(Stdio::null()).status().is_ok() {
        made.push(debian(root, &target, version, &request.built(root))?);
    }
    Ok(made)
}

/// A Debian package, put together by `tar` and `ar`: `debian-binary`, `control.tar.gz`, `data.tar.gz`.
fn debian(root: &Path, target: &Path, version: &str, built: &[PathBuf]) -> Result<PathBuf, String> {
    let architecture = match std::env::consts::ARCH {
        "x86_64" => "amd64",
        "aarch64" => "arm64",
        other => other,
    };
    let work = fresh(&target.join("debian"))?;
    let data = fresh(&work.join("data"))?;
    for file in built {
        copy(file, &fresh_below(&data, "usr/bin")?)?;
    }
    let documents = fresh_below(&data, "usr/share/doc/sincro")?;
    for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        copy(&root.join(file), &documents)?;
    }
    let bytes: u64 = built.iter().filter_map(|path| fs::metadata(path).ok()).map(|file| file.len()).sum();
    let glibc = built.iter().filter_map(|path| needed_glibc(&fs::read(path).ok()?)).max();
    let control = format!(
        "Package: sincro\nVersion: {version}\nArchitecture: {architecture}\nMaintainer: the authors of sincro <sincro@localhost>\n\
         Installed-Size: {}\nDepends: libc6{}, libgcc-s1\nSection: science\nPriority: optional\n\
         Description: deterministic simulation of robots and their controllers in lock-step\n",
        bytes / 1024,
        glibc.map_or_else(String::new, |version| format!(" (>= {})", shown(&version)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newest_version_counts() {
        let names = b"\0GLIBC_2.2.5\0GLIBC_2.28\0GLIBC_2.14\0GLIBC_PRIVATE\0";
        assert_eq!(needed_glibc(names), Some(vec![2, 28]));
        assert_eq!(needed_glibc(b"no library"), None);
        assert!(vec![2, 2, 5] < vec![2, 28] && vec![2, 34] > vec![2, 28]);
    }

    #[test]
    fn options_are_read() {
        let read = |words: &[&str]| Request::read(&words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>());
        let request = read(&["--glibc", "2.28"]).unwrap();
        assert_eq!(request.build()[0], "zigbuild");
        assert!(request.build().last().unwrap().ends_with("-unknown-linux-gnu.2.28"));
        assert_eq!(read(&[]).unwrap().build()[0], "build");
        assert!(read(&["--glibc", "new"]).is_err() && read(&["--musl"]).is_err());
    }
}

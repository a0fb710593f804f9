//! Files that a robot names: `package://`, `model://`, `file://` and relative paths.
//!
//! | form | searched in |
//! |---|---|
//! | `package://NAME/rest`, `package:///NAME/rest`, `model://NAME/rest` | the given package paths, `ROS_PACKAGE_PATH`, `AMENT_PREFIX_PATH` (in `share`), `GZ_SIM_RESOURCE_PATH`, the folders above the file |
//! | `rest` | the folder of the file |
//!
//! A name cannot lead out of its package, nor a relative or absolute path out of the folders that belong to the robot:
//! that of the package (with a `package.xml`, or the uppermost one with an `__init__.py`), or the second one above the
//! file.

use std::path::{Component, Path, PathBuf};

/// Folders above the file that are searched for a package.
const MAX_ABOVE: usize = 12;

/// Finds the files that a robot names.
#[derive(Clone, Debug)]
pub(crate) struct Resolver {
    folder: PathBuf,
    packages: Vec<PathBuf>,
}

impl Resolver {
    /// For a robot file in `folder`; `packages` are searched first.
    pub fn new(folder: &Path, packages: &[PathBuf]) -> Self {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf());
        let mut all: Vec<PathBuf> = packages.to_vec();
        let mut from = |variable: &str, below: &str| {
            if let Some(value) = std::env::var_os(variable) {
                all.extend(std::env::split_paths(&value).filter(|p| !p.as_os_str().is_empty()).map(|p| p.join(below)));
            }
        };
        from("ROS_PACKAGE_PATH", "");
        from("AMENT_PREFIX_PATH", "share");
        from("GZ_SIM_RESOURCE_PATH", "");
        Self { folder, packages: all }
    }

    /// The file that `uri` names; the reason if there is none.
    pub fn find(&self, uri: &str) -> Result<PathBuf, String> {
        if uri.contains('\0') || uri.is_empty() {
            return Err("its name is no path".into());
        }
        for scheme in ["package://", "model://"] {
            if let Some(rest) = uri.strip_prefix(scheme) {
                return self.in_package(rest.trim_start_matches('/'));
            }
        }
        let path = uri.strip_prefix("file://").unwrap_or(uri);
        if let Some((scheme, _)) = path.split_once("://") {
            return Err(format!("`{scheme}://` is not read: files on this machine only"));
        }
        let path = normalized(&self.folder.join(path));
        if !self.allowed().iter().any(|root| path.starts_with(root)) {
            return Err("it leads out of the folders of the robot (--package-path DIR adds one)".into());
        }
        is_file(&path)
    }

    fn in_package(&self, rest: &str) -> Result<PathBuf, String> {
        let path = Path::new(rest);
        if path.components().any(|c| !matches!(c, Component::Normal(_) | Component::CurDir)) {
            return Err("it leads out of its package".into());
        }
        let mut parts = path.components();
        let name = parts.next().map(|c| PathBuf::from(c.as_os_str())).unwrap_or_default();
        let inside = parts.as_path();
        let above: Vec<&Path> = self.folder.ancestors().take(MAX_ABOVE).collect();
        let roots = self.packages.iter().map(PathBuf::as_path).chain(above);
        for root in roots {
            let candidates = [root.join(path), root.join(inside)];
            let named = root.file_name().is_some_and(|last| last == name.as_os_str());
            for candidate in candidates.iter().take(if named { 2 } else { 1 }) {
                if candidate.is_file() {
                    return Ok(candidate.clone());
                }
            }
        }
        Err(format!(
            "there is no such file in a package `{}` (--package-path DIR says where packages are)",
            name.display()
        ))
    }

    /// Folders that relative and absolute paths may lead into.
    fn allowed(&self) -> Vec<PathBuf> {
        let package = self.folder.ancestors().take(MAX_ABOVE).find(|p| p.join("package.xml").is_file());
        // a Python package keeps its models in folders that name each other
        let python = |p: &&Path| p.join("__init__.py").is_file();
        let package = package.or_else(|| self.folder.ancestors().take(MAX_ABOVE).filter(python).last());
        let second = self.folder.ancestors().take(3).filter(|p| p.components().count() > 1).last();
        let own = package.or(second).unwrap_or(&self.folder);
        let absolute = |p: &PathBuf| normalized(&std::path::absolute(p).unwrap_or_else(|_| p.clone()));
        std::iter::once(normalized(own)).chain(self.packages.iter().map(absolute)).collect()
    }
}

fn is_file(path: &Path) -> Result<PathBuf, String> {
    if path.is_file() { Ok(path.to_path_buf()) } else { Err("there is no such file".into()) }
}

/// A path without `.` and `..`.
fn normalized(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_lead_out_of_packages_and_folders() {
        let resolver = Resolver::new(Path::new("/robots/arm/urdf"), &[]);
        for uri in ["package://arm/../../etc/passwd", "package:///../etc/passwd", "model://a/../b"] {
            assert_eq!(resolver.find(uri), Err("it leads out of its package".into()), "{uri}");
        }
        for uri in ["../../../etc/passwd", "/etc/passwd", "file:///etc/passwd"] {
            assert!(resolver.find(uri).unwrap_err().contains("leads out of the folders"), "{uri}");
        }
        assert!(resolver.find("http://host/x.stl").unwrap_err().contains("not read"));
        assert!(resolver.find("../meshes/x.stl").unwrap_err().contains("no such file"));
    }
}

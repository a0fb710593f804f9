//! Includes: the children of another file's root stand in the place of the `include`.

use std::path::{Path, PathBuf};

use sincro_scene::diagnostic::{Diagnostic, Diagnostics};

use crate::source::{Element, SourceFile};

/// Most files of a model.
const MAX_FILES: usize = 200;
/// Deepest nesting of includes.
const MAX_DEPTH: usize = 16;

/// The file of a model and all files that it includes, by their names relative to the model's folder.
///
/// # Errors
///
/// A file cannot be read or leads out of the folders of the model, or files include each other in a circle.
pub(crate) fn load(main: SourceFile) -> Result<Vec<SourceFile>, Diagnostics> {
    let folder = main.folder();
    let resolver = crate::resolve::Resolver::new(&folder, &[]);
    let mut files = vec![main];
    let mut depths = vec![0];
    let mut done = 0;
    while done < files.len() {
        let (named, at): (Vec<String>, Vec<_>) = {
            let document = files[done].parse()?;
            let includes = document.descendants().filter(|n| n.is_element() && n.tag_name().name() == "include");
            let one =
                |n: roxmltree::Node<'_, '_>| Some((n.attribute("file")?.to_owned(), files[done].location(n.range())));
            includes.filter_map(one).unzip()
        };
        for (name, at) in named.into_iter().zip(at) {
            let path = resolver
                .find(&name)
                .map_err(|why| Diagnostic::error(&at, format!("`{name}` is not included: {why}")))?;
            if files.iter().any(|file| same(&file.text.path, &path)) {
                continue;
            }
            if files.len() >= MAX_FILES || depths[done] >= MAX_DEPTH {
                return Err(Diagnostic::error(&at, "too many files are included").into());
            }
            files.push(SourceFile::read(&path)?);
            depths.push(depths[done] + 1);
        }
        done += 1;
    }
    Ok(files)
}

fn same(a: &Path, b: &Path) -> bool {
    let whole = |p: &Path| p.canonicalize().unwrap_or_else(|_| p.to_path_buf());
    whole(a) == whole(b)
}

/// Roots of all files, for putting includes in place.
pub(super) struct Files<'d> {
    roots: Vec<(PathBuf, Element<'d>)>,
    folder: PathBuf,
}

impl<'d> Files<'d> {
    pub fn new(roots: &[(PathBuf, Element<'d>)]) -> Self {
        let folder = roots.first().and_then(|(path, _)| path.parent()).unwrap_or(Path::new("")).to_path_buf();
        Self { roots: roots.to_vec(), folder }
    }

    /// Children of an element with includes put in place.
    pub fn elements(&self, element: Element<'d>) -> Vec<Element<'d>> {
        let mut out = Vec::new();
        self.collect(element, 0, &mut out);
        out
    }

    fn collect(&self, element: Element<'d>, depth: usize, out: &mut Vec<Element<'d>>) {
        for child in element.elements() {
            if child.name() != "include" {
                out.push(child);
                continue;
            }
            child.keep();
            let Some(name) = child.attribute("file") else { continue };
            let wanted = self.folder.join(name);
            let found = self.roots.iter().find(|(path, _)| same(path, &wanted));
            match found {
                Some((_, root)) if depth < MAX_DEPTH => self.collect(*root, depth + 1, out),
                _ => child.drop("files include each other in a circle"),
            }
        }
    }
}

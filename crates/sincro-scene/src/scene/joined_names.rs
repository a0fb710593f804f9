//! Names of what joins objects and is none itself: closures, couplings, springs between points, bushings, tendons.

use super::file::SceneFile;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// Notes names that are no names, and paths that two elements, or an element and an object, share.
pub(super) fn check<'a>(
    file: &SceneFile,
    objects: impl Iterator<Item = &'a str> + Clone,
    document: &Document,
    diagnostics: &mut Diagnostics,
) {
    let closures = file.closure.iter().map(|closure| closure.name.as_str()).enumerate();
    let couplings = file.coupling.iter().map(|coupling| coupling.name.as_str()).enumerate();
    let lines = file.spring_damper.iter().map(|line| line.name.as_str()).enumerate();
    let tendons = file.tendon.iter().map(|tendon| tendon.name.as_str()).enumerate();
    let mut seen: Vec<(&str, String)> = Vec::new();
    let of_kind = |kind: &'static str| move |(k, name)| (name, format!("/{kind}/{k}"));
    let all = closures.map(of_kind("closure")).chain(couplings.map(of_kind("coupling")));
    let all = all.chain(lines.map(of_kind("spring_damper")));
    let bushings = file.bushing.iter().map(|bushing| bushing.name.as_str()).enumerate();
    let all = all.chain(bushings.map(of_kind("bushing")));
    for (name, pointer) in all.chain(tendons.map(of_kind("tendon"))) {
        let at = document.at(&format!("{pointer}/name"));
        let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(is_of_name) {
            let diagnostic = Diagnostic::error(&at, format!("`{name}` is not a name"));
            diagnostics.push(diagnostic.with_help("names have letters a–z and A–Z, digits, `_` and `-`"));
        }
        let first = seen.iter().find(|(other, _)| *other == name);
        let is_object = objects.clone().any(|path| path.strip_prefix('/') == Some(name));
        if first.is_some() || is_object {
            let diagnostic = Diagnostic::error(&at, format!("there are two objects `/{name}`"));
            let help = match first {
                Some((_, first)) => {
                    let (line, _) = document.title_at(first).line_column();
                    format!("the other one is in line {line}; give one of them another name")
                }
                None => "give one of them another name".into(),
            };
            diagnostics.push(diagnostic.with_help(help));
        }
        seen.push((name, pointer));
    }
}

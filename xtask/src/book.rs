//! Preprocessor of the book (`mdbook build`): links that are right in the repository are made right in the book.
//!
//! The documents lie in `docs/` and link to scenes, models and sources beside it, which the book does not contain:
//! these links lead to the repository. `README.md` of a folder is `index.md` in the book.

use std::io::Read;
use std::path::{Component, Path};

use serde_json::Value;

/// Address of the sources.
const REPOSITORY: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main");

/// Reads context and book from standard input and prints the book with its links changed; answers the question whether
/// a renderer is supported with yes. Returns false if the input is no book.
pub fn preprocess() -> bool {
    if std::env::args().nth(2).as_deref() == Some("supports") {
        return true;
    }
    let mut text = String::new();
    let read = std::io::stdin().read_to_string(&mut text).map_err(|error| error.to_string());
    let parsed = read.and_then(|_| serde_json::from_str::<(Value, Value)>(&text).map_err(|error| error.to_string()));
    match parsed {
        Ok((_, mut book)) => {
            visit(&mut book);
            println!("{book}");
            true
        }
        Err(error) => {
            eprintln!("standard input is no book of mdBook: {error}; run `mdbook build`, which calls this");
            false
        }
    }
}

/// Changes the links of every chapter: an object with a text and a path.
fn visit(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(visit),
        Value::Object(object) => {
            if let (Some(Value::String(text)), Some(Value::String(path))) = (object.get("content"), object.get("path"))
            {
                let folder = Path::new(path).parent().unwrap_or(Path::new(""));
                let changed = with_links(text, folder);
                object.insert("content".into(), changed.into());
            }
            object.values_mut().for_each(visit);
        }
        _ => {}
    }
}

/// A text in Markdown with the targets of its links changed, those in code left as they are. `folder` is that of the
/// text, from `docs/`.
fn with_links(text: &str, folder: &Path) -> String {
    let (mut out, mut is_code) = (String::with_capacity(text.len()), false);
    for line in text.split_inclusive('\n') {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        if is_code || is_fence {
            out += line;
            continue;
        }
        let mut rest = line;
        while let Some((before, after)) = rest.split_once("](") {
            let (target, end) = after.split_at(after.find(')').unwrap_or(0));
            out += &format!("{before}]({}", in_book(target, folder));
            rest = end;
        }
        out += rest;
    }
    out
}

/// Target of a link as the book needs it.
fn in_book(target: &str, folder: &Path) -> String {
    if target.contains("://") || target.starts_with('#') || target.is_empty() {
        return target.to_owned();
    }
    let (file, place) = target.split_once('#').map_or((target, String::new()), |(f, p)| (f, format!("#{p}")));
    // from the root of the repository
    let mut parts = vec!["docs".to_owned()];
    for part in folder.join(file).components() {
        match part {
            Component::ParentDir => {
                parts.pop();
            }
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            _ => {}
        }
    }
    match parts.first().map(String::as_str) {
        Some("docs") => match file.strip_suffix("README.md") {
            Some(folder) => format!("{folder}index.md{place}"),
            None => target.to_owned(),
        },
        _ => format!("{REPOSITORY}/{}{place}", parts.join("/")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_out_of_the_book_lead_to_the_repository() {
        let text = "see [a](../scenes/arm/README.md#x), [b](how-to/README.md), [c](lua.md#y), [d](https://e.f/g)\n";
        let expected = format!(
            "see [a]({REPOSITORY}/scenes/arm/README.md#x), [b](how-to/index.md), [c](lua.md#y), [d](https://e.f/g)\n"
        );
        assert_eq!(with_links(text, Path::new("")), expected);
        // from a folder of the book, and in code
        let deeper = "[a](../lua.md) [b](../../README.md)\n```\nm[k](../../x)\n```\n";
        let expected = format!("[a](../lua.md) [b]({REPOSITORY}/README.md)\n```\nm[k](../../x)\n```\n");
        assert_eq!(with_links(deeper, Path::new("how-to")), expected);
    }
}

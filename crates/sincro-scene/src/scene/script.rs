//! Scripts of a scene file: text, object, parameters, and what their language says of the text.

use std::sync::Arc;

use super::file::{OnErrorFile, ScriptFile, ScriptKindFile, ScriptParameterFile, ScriptStyleFile};
use crate::diagnostic::{Diagnostic, Diagnostics, SourceText};
use crate::document::Document;
use crate::folder::Folder;
use crate::script::{Kind, OnError, Parameter, Script, ScriptParser, Style};
use crate::suggest;

/// The scripts that can be, in the order of the file, each with the place of its object among `objects` as its number;
/// notes what is wrong with the others.
pub(super) fn read(
    files: &[ScriptFile],
    objects: &[&str],
    document: &Document,
    folder: &Folder,
    parser: Option<&dyn ScriptParser>,
    diagnostics: &mut Diagnostics,
) -> Vec<Script> {
    let mut scripts: Vec<Script> = Vec::new();
    for (k, file) in files.iter().enumerate() {
        let pointer = format!("/script/{k}");
        let Some(script) = script(file, &pointer, objects, document, folder, diagnostics) else { continue };
        if let Some(first) = scripts.iter().find(|s| s.object == script.object && s.kind == script.kind) {
            let line = first.at.line_column().0;
            let message = format!("`{}` has two {} scripts", file.object, word(script.kind));
            let help = format!("the other one is in line {line}; put both into one, or one of them on another object");
            diagnostics.push(Diagnostic::error(&document.at(&format!("{pointer}/object")), message).with_help(help));
            continue;
        }
        scripts.push(script);
    }
    check(&scripts, parser, diagnostics);
    scripts
}

/// The scripts of a model that is loaded while a run is on, by the paths of its objects; places of objects among
/// `objects` stand for their numbers.
pub(crate) fn of_model(
    document: &Document,
    objects: &[&str],
    folder: &Folder,
    parser: Option<&dyn ScriptParser>,
    diagnostics: &mut Diagnostics,
) -> Vec<Script> {
    let Some(list) = document.get("/script") else { return Vec::new() };
    match serde_json::from_value::<Vec<ScriptFile>>(list.clone()) {
        Ok(files) => read(&files, objects, document, folder, parser, diagnostics),
        Err(error) => {
            diagnostics.push(Diagnostic::error(&document.at("/script"), error.to_string()));
            Vec::new()
        }
    }
}

fn word(kind: Kind) -> &'static str {
    match kind {
        Kind::Child => "child",
        Kind::Customization => "customization",
    }
}

/// Checks the texts with the parser of the language.
fn check(scripts: &[Script], parser: Option<&dyn ScriptParser>, diagnostics: &mut Diagnostics) {
    let Some(first) = scripts.first() else { return };
    let Some(parser) = parser else {
        let diagnostic = Diagnostic::error(&first.at, "this program cannot run Lua scripts");
        diagnostics.push(diagnostic.with_help("it was built without `sincro-lua`; use the `sincro` command"));
        return;
    };
    for fault in scripts.iter().filter_map(|script| parser.check(script).err()) {
        diagnostics.push(fault.diagnostic());
    }
}

fn script(
    file: &ScriptFile,
    pointer: &str,
    objects: &[&str],
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Option<Script> {
    let object = objects.iter().position(|path| *path == file.object);
    if object.is_none() {
        let message = format!("there is no object `{}` for the script", file.object);
        let diagnostic = Diagnostic::error(&document.at(&format!("{pointer}/object")), message);
        diagnostics.push(diagnostic.with_help(suggest::help(&file.object, objects, "objects")));
    }
    let (source, text, lines_before) = match (&file.file, &file.code) {
        (Some(_), _) => {
            let name = document.located(&format!("{pointer}/file"))?;
            let source = folder.read_named(&name).map_err(|diagnostic| diagnostics.push(diagnostic)).ok()?;
            (source.clone(), source.text.clone(), 0)
        }
        (None, Some(code)) => {
            let at = document.at(&format!("{pointer}/code"));
            // the line break after an opening ''' is no part of the text
            let opens_line = ["'''\n", "'''\r\n", "\"\"\"\n", "\"\"\"\r\n"].iter().any(|q| at.text().starts_with(q));
            let lines_before = at.line_column().0 - 1 + usize::from(opens_line);
            (at.source, code.clone(), lines_before)
        }
        (None, None) => return None,
    };
    let files = granted(file, pointer, document, folder, diagnostics);
    let object = object?;
    let parameters = file.parameters.iter().map(|(name, value)| (name.clone(), parameter(value))).collect();
    Some(Script {
        object,
        path: file.object.clone(),
        source,
        text,
        lines_before,
        parameters,
        files: files?,
        style: match file.style {
            ScriptStyleFile::Detect => Style::Detect,
            ScriptStyleFile::Old => Style::Old,
            ScriptStyleFile::New => Style::New,
        },
        kind: match file.kind {
            ScriptKindFile::Child => Kind::Child,
            ScriptKindFile::Customization => Kind::Customization,
        },
        is_threaded: file.threaded,
        on_error: match file.on_error {
            OnErrorFile::Detect => OnError::Detect,
            OnErrorFile::Stop => OnError::Stop,
            OnErrorFile::Continue => OnError::Continue,
        },
        max_memory: (file.max_memory_mib as usize) << 20,
        max_instructions: file.max_instructions,
        at: document.at(pointer),
    })
}

/// The files that a script may read; none if one of them cannot be.
fn granted(
    file: &ScriptFile,
    pointer: &str,
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<(String, Arc<SourceText>)>> {
    let mut files = Some(Vec::new());
    for (k, name) in file.files.iter().enumerate() {
        let named = document.located(&format!("{pointer}/files/{k}"))?;
        match folder.read_named(&named) {
            Ok(source) => files.as_mut().into_iter().for_each(|files| files.push((name.clone(), source.clone()))),
            Err(diagnostic) => {
                diagnostics.push(diagnostic);
                files = None;
            }
        }
    }
    files
}

fn parameter(value: &ScriptParameterFile) -> Parameter {
    match value {
        ScriptParameterFile::Number(x) => Parameter::Number(*x),
        ScriptParameterFile::Flag(truth) => Parameter::Flag(*truth),
        ScriptParameterFile::Text(text) => Parameter::Text(text.clone()),
    }
}

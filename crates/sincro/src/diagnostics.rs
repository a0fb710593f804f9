//! Problems on the terminal: the line of the file, what is wrong in it, how to mend it.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::Arc;

use sincro::{Loaded, RunFailure};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, SourceText};
use sincro_scene::document::Document;
use sincro_scene::schema::FORMAT;
use sincro_sim::file::FileError;
use sincro_sim::result_folder::FolderError;

use crate::Exit;
use crate::snippet::render;

/// Prints all problems to standard error.
pub(crate) fn print_diagnostics(diagnostics: &[Diagnostic]) {
    let has_colour = std::io::stderr().is_terminal() && !is_without_colour();
    for diagnostic in &grouped(diagnostics) {
        eprintln!("{}", render(diagnostic, has_colour));
    }
}

/// Diagnostics of one mistake as one: the first of them, with the lines of the others in its help.
fn grouped(all: &[Diagnostic]) -> Vec<Diagnostic> {
    let mut groups: Vec<(String, Diagnostic, Vec<usize>)> = Vec::new();
    for diagnostic in all {
        let path = diagnostic.source.as_ref().map(|source| source.path.display().to_string()).unwrap_or_default();
        let help = diagnostic.help.as_deref().unwrap_or("");
        let key = format!("{path} {} {} {help}", diagnostic.is_error(), without_owner(&diagnostic.message));
        let line = diagnostic.line_column().map(|(line, _)| line);
        match (groups.iter_mut().find(|(known, ..)| *known == key), line) {
            (Some((_, _, lines)), Some(line)) => lines.push(line),
            _ => groups.push((key, diagnostic.clone(), Vec::new())),
        }
    }
    let one = |(_, diagnostic, lines): (String, Diagnostic, Vec<usize>)| {
        if lines.is_empty() {
            return diagnostic;
        }
        let shown: Vec<String> = lines.iter().take(12).map(usize::to_string).collect();
        let more = if lines.len() > 12 { format!(" and {} more", lines.len() - 12) } else { String::new() };
        let places = format!("the same in line{} {}{more}", if lines.len() == 1 { "" } else { "s" }, shown.join(", "));
        let help = match &diagnostic.help {
            Some(help) => format!("{help}\n{places}"),
            None => places,
        };
        diagnostic.with_help(help)
    };
    groups.into_iter().map(one).collect()
}

/// A message without the name of the object that it is about: ` in joint `elbow``.
fn without_owner(message: &str) -> &str {
    match message.rsplit_once(" in ") {
        Some((head, owner)) if owner.ends_with('`') && owner.matches('`').count() == 2 => head,
        _ => message,
    }
}

/// Returns true if the variable `NO_COLOR` asks for no colour.
fn is_without_colour() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// Prints the problems and a summary; the command ends with bad input.
pub(crate) fn refuse_diagnostics(diagnostics: &Diagnostics) -> Exit {
    print_diagnostics(&diagnostics.0);
    let errors = diagnostics.0.iter().filter(|p| p.is_error()).count();
    eprintln!("{}; nothing was run or written", count(errors, "error"));
    Exit::Refused
}

/// Prints why a robot is not imported.
#[cfg(feature = "formats")]
pub(crate) fn refuse_import(diagnostics: &Diagnostics) -> Exit {
    print_diagnostics(&diagnostics.0);
    let errors = diagnostics.0.iter().filter(|p| p.is_error()).count();
    eprintln!("{}; the robot is not imported", count(errors, "error"));
    Exit::Refused
}

/// Prints one message without a place in a file.
pub(crate) fn refuse(message: &str, help: Option<&str>) -> Exit {
    let diagnostic = Diagnostic::without_location(message);
    print_diagnostics(&[match help {
        Some(help) => diagnostic.with_help(help),
        None => diagnostic,
    }]);
    Exit::Refused
}

/// Prints why a run was not made, or not written to its end.
pub(crate) fn refuse_run(failure: &RunFailure) -> Exit {
    match failure {
        RunFailure::Diagnostics(diagnostics) => refuse_diagnostics(diagnostics),
        RunFailure::Recording(error) => {
            refuse_file(error);
            eprintln!("the run stopped and is not kept; an earlier result is as it was");
            Exit::Stopped
        }
        RunFailure::Folder(error) => refuse_folder(error),
        RunFailure::Results(error) => refuse_file(error),
    }
}

/// Prints which file or folder cannot be written.
pub(crate) fn refuse_file(error: &FileError) -> Exit {
    refuse(&error.to_string(), Some("choose another place with --out DIR, or make room there"))
}

/// Prints one note if files of a scene are of an older format.
pub(crate) fn note_older_format(scene: &Path, loaded: &Loaded) {
    let is_older = |source: &&Arc<SourceText>| {
        let format = Document::parse(source).ok().and_then(|document| document.get("/format").and_then(|f| f.as_u64()));
        format.unwrap_or(1) < FORMAT
    };
    let is_toml = |source: &&Arc<SourceText>| {
        let name = source.path.file_name().unwrap_or_default();
        name == "experiment.toml" || source.path == loaded.experiment.scene_path
    };
    let older: Vec<String> = loaded
        .sources
        .iter()
        .filter(is_toml)
        .filter(is_older)
        .filter_map(|source| Some(source.path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    if !older.is_empty() {
        eprintln!("note: {} of an older format; `sincro convert {}` rewrites it", older.join(", "), scene.display());
    }
}

/// Prints why a folder takes no results.
pub(crate) fn refuse_folder(error: &FolderError) -> Exit {
    refuse(&error.to_string(), Some(error.help()))
}

/// Refuses a camera that the scene does not have.
pub(crate) fn refuse_camera(name: &str, cameras: &[String]) -> Exit {
    let help = match cameras {
        [] => "the scene has none: add a [[camera]] to it".to_owned(),
        _ => format!("cameras here: {}", cameras.join(", ")),
    };
    refuse(&format!("there is no camera `{name}`"), Some(&help))
}

/// `1 error`, `2 errors`.
pub(crate) fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sincro_scene::diagnostic::Location;

    #[test]
    fn one_repeated_mistake_is_one_message_with_its_lines() {
        let text = "a\nb\nc\nd\n";
        let source = Arc::new(SourceText { path: "scene.toml".into(), text: text.into() });
        let at = |k: usize| Location { source: source.clone(), span: 2 * k..2 * k + 1 };
        let unknown = |k: usize, name: &str| {
            Diagnostic::error(&at(k), format!("unknown key `x` in joint `{name}`")).with_help("leave it out")
        };
        let all = [unknown(0, "a"), unknown(1, "b"), Diagnostic::error(&at(2), "another"), unknown(3, "d")];
        let found = grouped(&all);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].help.as_deref(), Some("leave it out\nthe same in lines 2, 4"));
        assert_eq!(found[1].message, "another");
    }
}

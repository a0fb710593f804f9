//! Settings of parameters of instances, such as `/arm1.parameters.mass=2`: they must be known while the file of the
//! instance is written out, since any formula in it may depend on them.
//!
//! `/ball*.parameters.radius` reaches all copies of that form, `arm1.parameters.mass` the instance of that short name.
//! Without an instance, a parameter is one of the experiment, the scene file or the files that it includes.

use serde_json::Value;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Document, escape};
use crate::folder::Folder;
use crate::names::{anywhere, fits};
use crate::normalize::{Parameters, compute};
use crate::overrides::Override;
use crate::suggest;
use crate::tree::join;

/// Key between the path of an instance and the name of its parameter.
const KEY: &str = ".parameters.";

/// All settings, those of instances recognised.
pub(crate) struct InstanceSettings<'a> {
    settings: &'a [Override],
    /// True for settings that have reached an instance, or were refused.
    is_done: Vec<bool>,
    /// Paths of the instances, with the names of their parameters.
    known: Vec<(String, Vec<String>)>,
}

impl<'a> InstanceSettings<'a> {
    pub fn of(settings: &'a [Override]) -> Self {
        Self { settings, is_done: vec![false; settings.len()], known: Vec::new() }
    }

    /// Values of the parameters that settings give to the instance at `path`, whose file is `source`; formulas know the
    /// names `scope`. What cannot be computed is noted.
    pub fn of_instance(
        &mut self,
        path: &str,
        source: &Document,
        scope: &Parameters,
        diagnostics: &mut Diagnostics,
    ) -> Parameters {
        let table = source.get("/parameters").and_then(Value::as_object);
        let names: Vec<String> = table.into_iter().flatten().map(|(name, _)| name.clone()).collect();
        let mut given = Parameters::new();
        for (setting, is_done) in self.settings.iter().zip(&mut self.is_done) {
            let Some((_, name)) = parts(setting).filter(|(head, _)| is_meant(head, path)) else { continue };
            if !names.iter().any(|known| known == name) {
                continue;
            }
            *is_done = true;
            match compute(setting.value.value.trim_matches(['"', '\'']), scope) {
                Ok(x) => {
                    given.insert(name.to_owned(), x);
                }
                Err(why) => {
                    let message = format!("`{name}` is not a number: {why}");
                    diagnostics.push(Diagnostic::error(&setting.value.at, message));
                }
            }
        }
        self.known.push((path.to_owned(), names));
        given
    }

    /// The settings that are not of instances; those that name an instance, but none of its parameters, and those that
    /// can mean nothing else, are refused.
    pub fn others(self, diagnostics: &mut Diagnostics) -> Vec<Override> {
        let mut rest = Vec::new();
        for (setting, _) in self.settings.iter().zip(&self.is_done).filter(|(_, is_done)| !**is_done) {
            let Some((head, name)) = parts(setting) else {
                rest.push(setting.clone());
                continue;
            };
            let meant: Vec<&(String, Vec<String>)> =
                self.known.iter().filter(|(path, _)| is_meant(head, path)).collect();
            if let [(path, names), ..] = meant[..] {
                let known: Vec<&str> = names.iter().map(String::as_str).collect();
                let diagnostic =
                    Diagnostic::error(&setting.path.at, format!("the file of `{path}` has no parameter `{name}`"));
                diagnostics.push(diagnostic.with_help(suggest::help(name, &known, "parameters")));
            } else if head.starts_with('/') {
                let known: Vec<&str> = self.known.iter().map(|(path, _)| path.as_str()).collect();
                let diagnostic = Diagnostic::error(&setting.path.at, format!("there is no instance `{head}`"));
                diagnostics.push(diagnostic.with_help(suggest::help(head, &known, "instances")));
            } else {
                rest.push(setting.clone());
            }
        }
        rest
    }
}

/// Path of an instance and name of a parameter.
fn parts(setting: &Override) -> Option<(&str, &str)> {
    let (head, name) = setting.path.value.split_once(KEY)?;
    (!head.is_empty() && !head.contains('.') && !name.contains(['.', '['])).then_some((head, name))
}

/// Returns true if a setting's path, short name or pattern is that of an instance.
fn is_meant(head: &str, path: &str) -> bool {
    if head.starts_with('/') { fits(head, path) } else { fits(&anywhere(head), path) }
}

/// Adds the parameters that `settings` name, if they are neither in the experiment nor in its scene file, but in a file
/// which that includes: an experiment gives them as its own. One that only instances have is noted. Returns the
/// settings without those.
pub(crate) fn adopt_included(
    experiment: &mut Document,
    scene: &Document,
    folder: &Folder,
    settings: Vec<Override>,
    diagnostics: &mut Diagnostics,
) -> Vec<Override> {
    let mut is_known = |setting: &Override| {
        let Some(name) = setting.path.value.strip_prefix("parameters.") else { return true };
        let pointer = format!("/parameters/{}", escape(name));
        if experiment.get(&pointer).is_some() {
            return true;
        }
        match find(scene, folder, &pointer, 0) {
            Some(Found::Included(file)) => {
                if experiment.get("/parameters").is_none() {
                    let none = Value::Object(serde_json::Map::new());
                    experiment.put_silently("/parameters", none, &file.at("/parameters"));
                }
                experiment.copy_from(&pointer, &file, &pointer);
                true
            }
            Some(Found::Instance(path)) => {
                let message = format!("`{name}` is a parameter of the instance `{path}`, not of the experiment");
                let help = format!("write {path}{KEY}{name}={}", setting.value.value);
                diagnostics.push(Diagnostic::error(&setting.path.at, message).with_help(help));
                false
            }
            None => true,
        }
    };
    settings.into_iter().filter(|setting| is_known(setting)).collect()
}

/// Place of a parameter that a scene file does not have itself.
enum Found {
    Included(Box<Document>),
    /// Path of the instance.
    Instance(String),
}

/// Deepest nesting of files in which a parameter is looked for.
const MAX_DEPTH: usize = 16;

/// Looks for a parameter in the files that a scene file includes, then in its instances. Files that cannot be read are
/// told of where they are written out.
fn find(scene: &Document, folder: &Folder, pointer: &str, depth: usize) -> Option<Found> {
    let read = |at: &str| -> Option<Document> { Document::parse(&folder.read_named(&scene.located(at)?).ok()?).ok() };
    let count = |list: &str| scene.get(list).and_then(Value::as_array).map_or(0, Vec::len);
    if depth > MAX_DEPTH {
        return None;
    }
    for k in 0..count("/include") {
        let Some(file) = read(&format!("/include/{k}")) else { continue };
        if file.get(pointer).is_some() {
            return Some(Found::Included(Box::new(file)));
        }
        if let Some(found) = find(&file, folder, pointer, depth + 1) {
            return Some(found);
        }
    }
    (0..count("/instance")).find_map(|k| {
        let file = read(&format!("/instance/{k}/file"))?;
        file.get(pointer)?;
        let stem = scene.text(&format!("/instance/{k}/file"))?.rsplit('/').next()?.trim_end_matches(".toml");
        let name = scene.text(&format!("/instance/{k}/name")).unwrap_or(stem);
        let copies = if scene.get(&format!("/instance/{k}/repeat")).is_some() { "*" } else { "" };
        let parent = scene.text(&format!("/instance/{k}/parent")).unwrap_or("/");
        Some(Found::Instance(format!("{}{copies}", join(parent, name))))
    })
}

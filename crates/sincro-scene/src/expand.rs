//! Reuse in scene files: included files, defaults, instances of other scene files.
//!
//! | key | meaning |
//! |---|---|
//! | `include = ["floor.toml"]` | objects of other scene files, as if they stood here; their other keys stand where this file has none |
//! | `[[default]]` | keys of all objects of a kind that do not give them, everywhere or in a group of paths |
//! | `[[instance]]` | another scene file below a frame of its own, with parameters, once or in a line or grid |
//!
//! Everything is written out before settings are applied: an object of an instance has a path and keys as any other.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Document, escape};
use crate::folder::Folder;
use crate::instance_settings::InstanceSettings;
use crate::names::{fits, resolve_objects};
use crate::normalize::{Parameters, compute, normalize, normalize_object, parameters_of};
use crate::overrides::Override;
use crate::scene::scene_schema;
use crate::schema::validate;
use crate::tree::{JOINING, KINDS, RawObject, join, raw_objects};

/// Deepest nesting of files.
const MAX_DEPTH: usize = 16;
/// Most objects that instances inside instances may come to.
const MAX_OBJECTS: usize = 100_000;
/// Tables of objects that a default fills up key by key.
const MERGED: [&str; 6] = ["initial", "spring", "motor", "contact", "limits", "inertia"];

/// Lists of a scene file that an instance brings along.
fn brought_lists() -> impl Iterator<Item = &'static str> {
    KINDS.into_iter().chain(["contact_pair", "script"])
}

/// Writes out what a scene file reuses, with names of parameters for its formulas. Parameters of instances are set by
/// those of `settings` that name one; returns all others.
pub(crate) fn expand(
    document: &mut Document,
    folder: &Folder,
    parameters: &Parameters,
    settings: &[Override],
    diagnostics: &mut Diagnostics,
) -> Vec<Override> {
    let settings = InstanceSettings::of(settings);
    let (files, below) = (Vec::new(), String::new());
    let mut expander = Expander { folder, files, below, settings, n_objects: 0, diagnostics: Diagnostics::new() };
    expander.file(document, parameters);
    diagnostics.merge(expander.diagnostics);
    expander.settings.others(diagnostics)
}

struct Expander<'a> {
    folder: &'a Folder,
    /// Files that are being read, the outermost first.
    files: Vec<String>,
    /// Path of the instance whose file is written out; empty for the scene itself.
    below: String,
    settings: InstanceSettings<'a>,
    n_objects: usize,
    diagnostics: Diagnostics,
}

impl Expander<'_> {
    fn file(&mut self, document: &mut Document, parameters: &Parameters) {
        let scopes = self.includes(document, parameters);
        self.diagnostics.merge(normalize(document, scene_schema(), parameters));
        self.diagnostics.merge(resolve_objects(document));
        self.instances(document, parameters);
        defaults(document, &scopes, &mut self.diagnostics);
        // formulas and units of defaults are those of the objects they went to
        self.diagnostics.merge(normalize(document, scene_schema(), parameters));
        self.diagnostics.merge(resolve_objects(document));
    }

    /// Reads a file that is named at a place of the document.
    fn read(&mut self, document: &Document, pointer: &str) -> Option<Document> {
        let name = document.located(pointer)?;
        if self.files.contains(&name.value) || self.files.len() >= MAX_DEPTH {
            let message = format!("`{}` is read inside itself", name.value);
            let chain = self.files.join("`, which reads `");
            let diagnostic = Diagnostic::error(&name.at, message);
            self.diagnostics.push(diagnostic.with_help(format!("`{chain}` reads it")));
            return None;
        }
        let read = self.folder.read_named(&name).map_err(Diagnostics::from);
        match read.and_then(|source| Document::parse(&source)) {
            Ok(mut read) => {
                if let Some((folder, _)) = name.value.rsplit_once('/') {
                    files_below(folder, &mut read.root);
                }
                self.files.push(name.value);
                Some(read)
            }
            Err(found) => {
                self.diagnostics.merge(found);
                None
            }
        }
    }

    /// Adds what the included files hold. Returns the names for the formulas of each default: those of its own file.
    fn includes(&mut self, document: &mut Document, parameters: &Parameters) -> Vec<Parameters> {
        let n_defaults = document.get("/default").and_then(Value::as_array).map_or(0, Vec::len);
        let mut scopes = vec![parameters.clone(); n_defaults];
        let n = document.get("/include").and_then(Value::as_array).map_or(0, Vec::len);
        for k in 0..n {
            let Some(mut other) = self.read(document, &format!("/include/{k}")) else { continue };
            let own = with_defaults(&other, parameters, true);
            scopes.extend(self.includes(&mut other, &own));
            self.diagnostics.merge(normalize(&mut other, scene_schema(), &own));
            let keys: Vec<String> = other.root.as_object().into_iter().flatten().map(|(key, _)| key.clone()).collect();
            for key in keys.iter().filter(|key| !matches!(key.as_str(), "include" | "parameters" | "format")) {
                let pointer = format!("/{}", escape(key));
                match other.get(&pointer) {
                    Some(Value::Array(list)) if is_list(key) => {
                        let n = list.len();
                        (0..n).for_each(|k| {
                            document.append_from(&pointer, &other, &format!("{pointer}/{k}"));
                        });
                    }
                    _ if document.get(&pointer).is_none() => document.copy_from(&pointer, &other, &pointer),
                    _ => {}
                }
            }
            self.files.pop();
        }
        scopes
    }

    fn instances(&mut self, document: &mut Document, parameters: &Parameters) {
        let n = document.get("/instance").and_then(Value::as_array).map_or(0, Vec::len);
        if n == 0 {
            return;
        }
        // a finding about the instance itself is reported with the whole file
        let mut alone = document.clone();
        alone.root = Value::Object(Map::from_iter([("instance".to_owned(), document.root["instance"].clone())]));
        if validate(&alone, scene_schema()).any_error() {
            return;
        }
        let names = self.names(document, n);
        for (k, names) in names.into_iter().enumerate() {
            let pointer = format!("/instance/{k}");
            let Some(source) = self.read(document, &format!("{pointer}/file")) else { continue };
            for (name, place) in names {
                if !self.instance(document, &source, (&pointer, &name), &place, parameters) {
                    break;
                }
            }
            self.files.pop();
        }
    }

    /// Name and place of every copy of every instance. Siblings of one name get an index, counted from 1.
    fn names(&mut self, document: &Document, n: usize) -> Vec<Vec<(String, Copied)>> {
        let mut all = Vec::new();
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        let key = |pointer: &str, name: &str| {
            let parent = document.text(&format!("{pointer}/parent")).unwrap_or("/");
            join(parent, name)
        };
        for k in 0..n {
            let pointer = format!("/instance/{k}");
            let file = document.text(&format!("{pointer}/file")).unwrap_or("");
            let stem = file.rsplit('/').next().unwrap_or("").trim_end_matches(".toml");
            let name = document.text(&format!("{pointer}/name")).unwrap_or(stem).to_owned();
            let copies = copies(document, &pointer);
            *counts.entry(key(&pointer, &name)).or_default() += copies.len();
            all.push((pointer, name, copies));
        }
        let mut next: BTreeMap<String, usize> = BTreeMap::new();
        let named = |(pointer, name, copies): (String, String, Vec<Copied>)| {
            let of = key(&pointer, &name);
            let one = |copy: Copied| {
                let index = next.entry(of.clone()).or_default();
                *index += 1;
                (if counts[&of] > 1 { format!("{name}{index}") } else { name.clone() }, copy)
            };
            copies.into_iter().map(one).collect()
        };
        all.into_iter().map(named).collect()
    }

    /// Adds one copy. Returns false if there is no use in adding more.
    fn instance(
        &mut self,
        document: &mut Document,
        source: &Document,
        (pointer, name): (&str, &str),
        copy: &Copied,
        outer: &Parameters,
    ) -> bool {
        let parent = document.text(&format!("{pointer}/parent")).unwrap_or("/").to_owned();
        let path = join(&parent, name);
        let around = self.below.clone();
        self.below.push_str(&path);
        let parameters = self.parameters(document, source, pointer, copy, outer);
        let mut inner = source.clone();
        if let Some(parameters) = &parameters {
            self.file(&mut inner, parameters);
        }
        self.below = around;
        if parameters.is_none() {
            return false;
        }
        self.frame(document, pointer, name, &parent, copy);
        prefix(&mut inner, &path);
        for list in brought_lists() {
            let n = inner.get(&format!("/{list}")).and_then(Value::as_array).map_or(0, Vec::len);
            self.n_objects += n;
            for k in 0..n {
                document.append_from(&format!("/{list}"), &inner, &format!("/{list}/{k}"));
            }
        }
        if self.n_objects > MAX_OBJECTS {
            let diagnostic = Diagnostic::error(&document.at(pointer), format!("more than {MAX_OBJECTS} objects"));
            self.diagnostics.push(diagnostic.with_help("repeat fewer"));
            return false;
        }
        true
    }

    /// Numbers for the formulas of a copy: those around it, the defaults of the file, what the instance or a setting
    /// gives, and the indices of the copy. None if one cannot be computed.
    fn parameters(
        &mut self,
        document: &Document,
        source: &Document,
        pointer: &str,
        copy: &Copied,
        outer: &Parameters,
    ) -> Option<Parameters> {
        let mut scope = outer.clone();
        scope.extend([("i".to_owned(), copy.index as f64)]);
        scope.extend(["ix", "iy", "iz"].into_iter().zip(copy.cell).map(|(name, k)| (name.to_owned(), k as f64)));
        let mut own = with_defaults(source, &scope, false);
        let given = document.get(&format!("{pointer}/parameters")).and_then(Value::as_object);
        for (name, value) in given.into_iter().flatten() {
            let at = format!("{pointer}/parameters/{}", escape(name));
            if source.get(&format!("/parameters/{}", escape(name))).is_none() {
                let known = source.get("/parameters").and_then(Value::as_object);
                let known: Vec<&str> = known.into_iter().flatten().map(|(name, _)| name.as_str()).collect();
                let file = source.source.path.display();
                let diagnostic =
                    Diagnostic::error(&document.key_at(&at), format!("`{file}` has no parameter `{name}`"));
                self.diagnostics.push(diagnostic.with_help(crate::suggest::help(name, &known, "parameters")));
                return None;
            }
            let number = match value {
                Value::String(text) => compute(text, &scope),
                other => other.as_f64().ok_or_else(|| "it is no number".into()),
            };
            match number {
                Ok(x) => {
                    own.insert(name.clone(), x);
                }
                Err(why) => {
                    let message = format!("`{name}` is not a number: {why}");
                    self.diagnostics.push(Diagnostic::error(&document.at(&at), message));
                    return None;
                }
            }
        }
        let set = self.settings.of_instance(&self.below, source, &scope, &mut self.diagnostics);
        own.extend(set.clone());
        // defaults that are formulas of parameters which the instance gives
        let mut table = source.get("/parameters").cloned().unwrap_or(Value::Object(Map::new()));
        for (name, value) in table.as_object_mut().into_iter().flatten() {
            if given.is_some_and(|given| given.contains_key(name)) || set.contains_key(name) {
                *value = own[name].into();
            }
        }
        let mut filled = source.clone();
        filled.root["parameters"] = table;
        Some(with_defaults(&filled, &scope, false))
    }

    /// The frame that carries a copy.
    fn frame(&mut self, document: &mut Document, pointer: &str, name: &str, parent: &str, copy: &Copied) {
        let at = document.title_at(pointer);
        let mut frame = Map::from_iter([
            ("name".to_owned(), Value::from(name)),
            ("parent".to_owned(), Value::from(parent)),
            ("position".to_owned(), Value::from(copy.position.to_vec())),
        ]);
        for key in ["rotation_deg", "quaternion_wxyz"] {
            frame.extend(document.get(&format!("{pointer}/{key}")).map(|value| (key.to_owned(), value.clone())));
        }
        let n = document.get("/frame").and_then(Value::as_array).map_or(0, Vec::len);
        if n == 0 {
            document.put_silently("/frame", Value::Array(Vec::new()), &at);
        }
        document.push_silently("/frame", Value::Object(frame), &at);
        document.put_silently(&format!("/frame/{n}/name"), Value::from(name), &at);
    }
}

/// Names of files in a scene file that lies in a folder of its own, as seen from the folder of the scene.
fn files_below(folder: &str, value: &mut Value) {
    let below = |name: &mut Value| {
        if let Value::String(name) = name
            && !name.starts_with('/')
        {
            *name = format!("{folder}/{name}");
        }
    };
    match value {
        Value::Array(list) => list.iter_mut().for_each(|value| files_below(folder, value)),
        Value::Object(table) => {
            for (key, value) in table {
                match (key.as_str(), value) {
                    ("file", name) => below(name),
                    ("include", Value::Array(names)) => names.iter_mut().for_each(below),
                    (_, value) => files_below(folder, value),
                }
            }
        }
        _ => {}
    }
}

fn is_list(key: &str) -> bool {
    KINDS.contains(&key) || matches!(key, "script" | "instance" | "default")
}

/// Parameters around a file with its own; `outer_wins` says which of two values of one name counts.
fn with_defaults(document: &Document, outer: &Parameters, outer_wins: bool) -> Parameters {
    let mut merged = document.clone();
    if merged.get("/parameters").is_none() {
        return outer.clone();
    }
    for (name, value) in outer {
        if outer_wins || merged.get(&format!("/parameters/{}", escape(name))).is_none() {
            merged.root["parameters"][name] = (*value).into();
        }
    }
    parameters_of(&merged)
}

/// Place of one copy of an instance.
struct Copied {
    /// Number of the copy, from 0.
    index: usize,
    /// Its numbers along the three axes of the grid, from 0.
    cell: [usize; 3],
    /// `[m]`
    position: [f64; 3],
}

/// Copies of an instance, along x first.
fn copies(document: &Document, pointer: &str) -> Vec<Copied> {
    let number = |value: Option<&Value>| value.and_then(Value::as_f64).unwrap_or(0.0);
    let vector = |key: &str| -> [f64; 3] {
        let list = document.get(&format!("{pointer}/{key}"));
        std::array::from_fn(|axis| number(list.and_then(|list| list.get(axis))))
    };
    let start = vector("position");
    let step = vector("repeat/step");
    let count = document.get(&format!("{pointer}/repeat/count"));
    let one = |axis: usize| count.and_then(|c| c.get(axis)).and_then(Value::as_u64).unwrap_or(1) as usize;
    // one number: a line along `step`; three: a grid
    let line = count.and_then(Value::as_u64).map(|n| n as usize);
    let counts = if line.is_some() { [0; 3] } else { [one(0), one(1), one(2)] };
    let cells = (0..counts[2]).flat_map(|z| (0..counts[1]).flat_map(move |y| (0..counts[0]).map(move |x| [x, y, z])));
    let on_line = (0..line.unwrap_or(0)).map(|k| ([k, 0, 0], [k; 3]));
    let copied = |(index, (cell, steps)): (usize, ([usize; 3], [usize; 3]))| {
        let position = std::array::from_fn(|axis| start[axis] + steps[axis] as f64 * step[axis]);
        Copied { index, cell, position }
    };
    on_line.chain(cells.map(|cell| (cell, cell))).enumerate().map(copied).collect()
}

/// Puts all objects of a document below a path: their parents, and whatever else names an object.
fn prefix(document: &mut Document, path: &str) {
    let moved = |text: &str| if text == "/" { path.to_owned() } else { format!("{path}{text}") };
    let names: Vec<String> = raw_objects(document).into_iter().map(|o| o.path).collect();
    for list in brought_lists() {
        let n = document.get(&format!("/{list}")).and_then(Value::as_array).map_or(0, Vec::len);
        for k in 0..n {
            let pointer = format!("/{list}/{k}");
            if JOINING.contains(&list) {
                // their path is `/` and the name, wherever they stand
                let own = document.text(&format!("{pointer}/name")).unwrap_or("").to_owned();
                let flat = path.trim_start_matches('/').replace('/', "-");
                document.replace(&format!("{pointer}/name"), Value::String(format!("{flat}-{own}")));
            } else if !matches!(list, "script" | "contact_pair") && document.get(&format!("{pointer}/parent")).is_none()
            {
                let at = document.title_at(&pointer);
                document.put_silently(&format!("{pointer}/parent"), Value::from("/"), &at);
            }
        }
    }
    let mut places = Vec::new();
    crate::names::collect("", &document.root, &mut places);
    for (pointer, text) in places {
        let is_pattern = text.starts_with('/') && text.contains('*');
        if text == "/" || is_pattern || names.contains(&text) {
            document.replace(&pointer, Value::String(moved(&text)));
        }
    }
}

/// Fills up the objects with the defaults of the file; the last default that fits wins over those before. The formulas
/// of default k know the names `scopes[k]`.
fn defaults(document: &mut Document, scopes: &[Parameters], diagnostics: &mut Diagnostics) {
    let n = document.get("/default").and_then(Value::as_array).map_or(0, Vec::len);
    if n == 0 {
        return;
    }
    let objects = raw_objects(document);
    for k in (0..n).rev() {
        let pointer = format!("/default/{k}");
        let (Some(of), Some(Value::Object(keys))) =
            (document.text(&format!("{pointer}/of")).map(str::to_owned), document.get(&format!("{pointer}/keys")))
        else {
            continue;
        };
        let keys: Vec<String> = keys.keys().cloned().collect();
        let group = document.text(&format!("{pointer}/group")).unwrap_or("**").to_owned();
        let source = document.clone();
        let is_of = |object: &&RawObject| object.pointer.split('/').nth(1) == Some(of.as_str());
        let fitting: Vec<&RawObject> = objects.iter().filter(is_of).filter(|o| fits(&group, &o.path)).collect();
        if fitting.is_empty() && document.get(&format!("{pointer}/group")).is_some() {
            let at = document.at(&format!("{pointer}/group"));
            let diagnostic = Diagnostic::error(&at, format!("no {of} has a path of the form `{group}`")).as_warning();
            let help = "the default reaches nothing; `*` stands for characters within a name, `**` for any at all";
            diagnostics.push(diagnostic.with_help(help));
        }
        for object in fitting {
            for key in &keys {
                let (from, to) =
                    (format!("{pointer}/keys/{}", escape(key)), format!("{}/{}", object.pointer, escape(key)));
                fill(document, &source, &from, &to, MERGED.contains(&key.as_str()));
            }
            // before another default comes, whose formulas may know other names
            diagnostics.merge(normalize_object(document, scene_schema(), &object.pointer, &scopes[k]));
        }
    }
}

/// Copies a value to where none is; a table is filled up key by key if it is one of independent keys.
fn fill(document: &mut Document, source: &Document, from: &str, to: &str, is_merged: bool) {
    match (document.get(to), source.get(from)) {
        (None, Some(_)) => document.copy_from(to, source, from),
        (Some(Value::Object(_)), Some(Value::Object(table))) if is_merged => {
            for key in table.keys() {
                let inner = format!("/{}", escape(key));
                fill(document, source, &format!("{from}{inner}"), &format!("{to}{inner}"), false);
            }
        }
        _ => {}
    }
}

//! Settings written into the documents of a scene folder: each finds its file, its key and the schema that knows it.

use serde_json::{Map, Value};
use toml::de::DeValue;

use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::document::{Document, escape};
use crate::experiment::experiment_schema;
use crate::names::{self, Match, ending, fits, nearest_path};
use crate::overrides::Override;
use crate::scene::scene_schema;
use crate::schema::{alternatives, property, property_names};
use crate::suggest;
use crate::tree;
use crate::vocabulary::unit_suffix;

/// File of a scene folder that a setting changes; see [`Override::target`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Scene file, `scene.toml`.
    Scene,
    /// Experiment file, `experiment.toml`.
    Experiment,
    /// Diagram file, `diagram.toml`.
    Diagram,
}

impl Override {
    /// Returns the file that the setting is for, by the first key of its path: `/arm.mass` belongs to the scene,
    /// `duration` to the experiment, `block.parameter` to the diagram. The path is not checked.
    pub fn target(&self) -> Target {
        let path = &self.path.value;
        let first = path.split(['.', '[']).next().unwrap_or("");
        let knows = |schema: &Value| schema["properties"].get(first).is_some();
        // the parameters of a scene file are those of its experiment
        if path.starts_with('/') || (knows(scene_schema()) && !matches!(first, "parameters" | "format")) {
            Target::Scene
        } else if path.starts_with(OF_DIAGRAM) || (path.contains('.') && !knows(experiment_schema())) {
            Target::Diagram
        } else {
            Target::Experiment
        }
    }

    /// The finding about a setting for a diagram that is not there.
    pub(crate) fn without_diagram(&self) -> Diagnostic {
        let first = self.path.value.split(['.', '[']).next().unwrap_or("");
        let mut known: Vec<&str> = [scene_schema(), experiment_schema()]
            .into_iter()
            .flat_map(|schema| property_names(schema.as_object().expect("a schema is a table")))
            .collect();
        keep_first(&mut known);
        let diagnostic = self.error(format!("`{}`: a scene or experiment has no `{first}`", self.path.value));
        diagnostic.with_help(suggest::help(first, &known, "keys"))
    }

    /// A parameter of a block, or a key of the diagram file.
    fn apply_to_diagram(&self, document: &mut Document) -> Result<(), Diagnostic> {
        let path = self.path.value.strip_prefix(OF_DIAGRAM).unwrap_or(&self.path.value);
        let keys = steps(path);
        let names: Vec<String> = names_of_blocks(document);
        if keys.is_empty() {
            let help = "write BLOCK.PARAMETER=VALUE, such as pid.kp=3";
            return Err(self.error(format!("`{}` names nothing", self.path.value)).with_help(help));
        }
        let pointer = match names.iter().position(|name| *name == keys[0]) {
            Some(k) => format!("/block/{k}"),
            None if keys[0].contains('/') => self.inner_block(document, &keys[0])?,
            None if matches!(keys[0].as_str(), "parameters" | "sample_time") => String::new(),
            None => {
                let known: Vec<&str> = names.iter().map(String::as_str).collect();
                let diagnostic = self.error(format!("`{}`: the diagram has no block `{}`", self.path.value, keys[0]));
                return Err(diagnostic.with_help(suggest::help(&keys[0], &known, "blocks")));
            }
        };
        let rest = if pointer.is_empty() { &keys[..] } else { &keys[1..] };
        if rest.is_empty() {
            let diagnostic = self.error(format!("`{}` names a block, none of its parameters", self.path.value));
            return Err(diagnostic.with_help(format!("write {}.PARAMETER=VALUE", self.path.value)));
        }
        let (last, inner) = rest.split_last().expect("not empty");
        let mut at = pointer;
        for key in inner {
            at = format!("{at}/{}", escape(key));
            if document.get(&at).is_none() {
                document.put_silently(&at, Value::Object(Map::new()), &self.path.at);
            }
        }
        match document.get(&at) {
            Some(Value::Object(_)) => {}
            Some(Value::Array(list)) if last.parse::<usize>().is_ok_and(|k| k < list.len()) => {}
            Some(Value::Array(list)) => {
                let message = format!("`{}`: there are {} entries, no entry {last}", self.path.value, list.len());
                return Err(self.error(message).with_help("entries are counted from 0"));
            }
            _ => return Err(self.error(format!("`{}`: there is nothing inside a number", self.path.value))),
        }
        self.put(document, &format!("{at}/{}", escape(last)))
    }

    /// The block `a/b/c`: block `c` of the diagram that block `b` of the diagram `a` is. A diagram that is used more
    /// than once gets a copy for this use alone.
    fn inner_block(&self, document: &mut Document, path: &str) -> Result<String, Diagnostic> {
        let mut content = String::new();
        let mut steps = path.split('/').peekable();
        loop {
            let step = steps.next().unwrap_or("");
            let blocks = |at: &str| -> Vec<String> {
                let list = document.get(&format!("{at}/block")).and_then(Value::as_array).into_iter().flatten();
                list.map(|b| b.get("name").and_then(Value::as_str).unwrap_or("").to_owned()).collect()
            };
            let names = blocks(&content);
            let Some(k) = names.iter().position(|name| name == step) else {
                let known: Vec<&str> = names.iter().map(String::as_str).collect();
                let diagnostic = self.error(format!("`{path}`: there is no block `{step}`"));
                return Err(diagnostic.with_help(suggest::help(step, &known, "blocks there")));
            };
            let block = format!("{content}/block/{k}");
            if steps.peek().is_none() {
                return Ok(block);
            }
            let kind = document.text(&format!("{block}/type")).unwrap_or("").to_owned();
            let definitions = document.get("/diagram").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
            let of_name = |d: &Value| d.get("name").and_then(Value::as_str) == Some(kind.as_str());
            let Some(d) = definitions.iter().position(of_name) else {
                let diagnostic = self.error(format!("`{path}`: `{step}` is a `{kind}`, no diagram with blocks in it"));
                return Err(diagnostic.with_help(format!("write {step}.PARAMETER=VALUE")));
            };
            content = if n_uses(document, &kind) > 1 {
                let source = document.clone();
                let copy = document.append_from("/diagram", &source, &format!("/diagram/{d}"));
                // a name that no file can give
                let name = format!("{kind} ({path}.{d})");
                document.replace(&format!("{copy}/name"), Value::String(name.clone()));
                document.replace(&format!("{block}/type"), Value::String(name));
                copy
            } else {
                format!("/diagram/{d}")
            };
        }
    }

    /// Writes the value into the document of its file, `target` as [`Override::target`] returns it. A later value at
    /// the same path replaces an earlier one.
    ///
    /// # Errors
    ///
    /// A diagnostic at the setting, with the nearest known names: the path reaches nothing in the document, or the
    /// value is no TOML.
    pub fn apply(&self, document: &mut Document, target: Target) -> Result<(), Diagnostic> {
        let (mut walk, keys) = match target {
            Target::Diagram => return self.apply_to_diagram(document),
            Target::Experiment => (Walk::from_root(self, experiment_schema()), self.path.value.as_str()),
            Target::Scene if self.path.value.starts_with('/') => self.find_object(document)?,
            Target::Scene => (Walk::from_root(self, scene_schema()), self.path.value.as_str()),
        };
        let keys = steps(keys);
        if keys.is_empty() {
            return Err(self.error("the path names an object, none of its keys").with_help(suggest::help(
                "",
                &walk.known(),
                "keys",
            )));
        }
        for (k, key) in keys.iter().enumerate() {
            walk.enter(document, key, k + 1 == keys.len())?;
        }
        self.put(document, &walk.pointer)
    }

    fn put(&self, document: &mut Document, pointer: &str) -> Result<(), Diagnostic> {
        let text = &self.value.value;
        if let Ok(value) = DeValue::parse(text) {
            document.put(pointer, &self.path.at, &value, &self.value.at);
            return Ok(());
        }
        if text.starts_with(['[', '{', '"', '\'']) {
            let diagnostic = Diagnostic::error(&self.value.at, format!("`{text}` is not a TOML value"));
            return Err(diagnostic.with_help("numbers, [lists], { tables = 1 }, \"strings\" or bare words"));
        }
        document.put_silently(pointer, Value::String(text.clone()), &self.value.at);
        Ok(())
    }

    /// The object at the head of the path, and the keys behind it.
    fn find_object(&self, document: &Document) -> Result<(Walk<'_>, &str), Diagnostic> {
        let path = self.path.value.as_str();
        let (object, keys) = path.split_once('.').unwrap_or((path, ""));
        let objects = tree::raw_objects(document);
        let known: Vec<&str> = objects.iter().map(|o| o.path.as_str()).collect();
        let whole = match ending(object, known.iter().copied()) {
            _ if known.contains(&object) => object,
            Match::One(path) => path,
            Match::Several(all) => return Err(names::ambiguous(&self.path.at, object, &all)),
            Match::None => object,
        };
        let Some(found) = objects.iter().find(|o| o.path == whole) else {
            let diagnostic = self.error(format!("there is no object `{object}`"));
            let help = suggest::help(object, &known, "objects");
            return Err(diagnostic.with_help(match nearest_path(object, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => help,
            }));
        };
        if let Some(keys) = keys.strip_prefix("script.") {
            let scripts = document.get("/script").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
            let of_object = |s: &Value| s.get("object").and_then(Value::as_str) == Some(whole);
            let Some(k) = scripts.iter().position(of_object) else {
                return Err(self.error(format!("`{whole}` has no script")).with_help("scripts are in [[script]]"));
            };
            let schema = &scene_schema()["properties"]["script"]["items"];
            let walk = Walk { setting: self, root: scene_schema(), schema, pointer: format!("/script/{k}") };
            return Ok((walk, keys));
        }
        let list = found.pointer.split('/').nth(1).unwrap_or("");
        let schema = &scene_schema()["properties"][list]["items"];
        Ok((Walk { setting: self, root: scene_schema(), schema, pointer: found.pointer.clone() }, keys))
    }

    /// The same for another path; messages point at what was written.
    fn at(&self, path: &str) -> Self {
        Self { path: Located { value: path.to_owned(), at: self.path.at.clone() }, value: self.value.clone() }
    }

    fn error(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(&self.path.at, message)
    }
}

/// Prefix of the name of a block that is also a key of another file.
const OF_DIAGRAM: &str = "diagram.";

/// Names of the blocks of a diagram file.
pub(crate) fn names_of_blocks(document: &Document) -> Vec<String> {
    let blocks = document.get("/block").and_then(Value::as_array).into_iter().flatten();
    blocks.map(|b| b.get("name").and_then(Value::as_str).unwrap_or("").to_owned()).collect()
}

/// Blocks of a type, in the file and its diagrams.
fn n_uses(document: &Document, kind: &str) -> usize {
    let definitions = document.get("/diagram").and_then(Value::as_array).into_iter().flatten();
    let of = |table: &Value| -> usize {
        let blocks = table.get("block").and_then(Value::as_array).into_iter().flatten();
        blocks.filter(|b| b.get("type").and_then(Value::as_str) == Some(kind)).count()
    };
    of(&document.root) + definitions.map(of).sum::<usize>()
}

/// The settings with short names and wildcards written out, each for one object or block.
pub(crate) fn whole_paths(
    settings: &[Override],
    scene: Option<&Document>,
    objects: &[String],
    blocks: &[String],
    diagnostics: &mut Diagnostics,
) -> Vec<Override> {
    let mut whole = Vec::new();
    for setting in settings {
        let path = &setting.path.value;
        let (head, keys) = path.split_once('.').map_or((path.as_str(), ""), |(head, _)| (head, &path[head.len()..]));
        let is_object = path.starts_with('/') || path.starts_with("**/");
        if head.contains('*') {
            let of_blocks = blocks.iter().filter(|name| !is_object && fits(head, name));
            let mut found: Vec<&String> = of_blocks.collect();
            for pattern in [head.to_owned(), names::anywhere(head)] {
                if found.is_empty() {
                    let of_objects = objects.iter().filter(|path| fits(&pattern, path));
                    found = of_objects.filter(|path| scene.is_none_or(|scene| takes(scene, path, keys))).collect();
                }
            }
            if found.is_empty() {
                let what = if is_object { "object" } else { "block or object" };
                let diagnostic = setting.error(format!("`{head}` fits no {what}"));
                let help =
                    "`*` stands for a part of one name, `**` for anything; the key after it must be one of the object";
                diagnostics.push(diagnostic.with_help(help));
            }
            whole.extend(found.into_iter().map(|name| setting.at(&format!("{name}{keys}"))));
            continue;
        }
        let first = head.split('/').next().unwrap_or("");
        let is_block = path.starts_with(OF_DIAGRAM) || blocks.iter().any(|block| block == first);
        if setting.target() != Target::Diagram || is_block {
            whole.push(setting.clone());
            continue;
        }
        match ending(head, objects.iter().map(String::as_str)) {
            Match::One(object) => whole.push(setting.at(&format!("{object}{keys}"))),
            Match::Several(all) => diagnostics.push(names::ambiguous(&setting.path.at, head, &all)),
            Match::None => whole.push(setting.clone()),
        }
    }
    whole
}

/// Returns true if the object of a path has the first of the keys, as its schema says.
fn takes(scene: &Document, object: &str, keys: &str) -> bool {
    let Some(found) = tree::raw_objects(scene).into_iter().find(|o| o.path == object) else { return false };
    let list = found.pointer.split('/').nth(1).unwrap_or("");
    let schema = &scene_schema()["properties"][list]["items"];
    let Some(first) = steps(keys).into_iter().next() else { return true };
    if first == "script" {
        let scripts = scene.get("/script").and_then(Value::as_array).into_iter().flatten();
        return scripts.into_iter().any(|s| s.get("object").and_then(Value::as_str) == Some(object));
    }
    let plain = unit_suffix(&first).map_or(first.as_str(), |(plain, _)| plain);
    alternatives(scene_schema(), schema).iter().any(|t| property(t, &first).is_some() || property(t, plain).is_some())
}

/// The keys of a path: `axis[2]` and `axis.2` are the same.
fn steps(keys: &str) -> Vec<String> {
    let flat = keys.replace('[', ".").replace(']', "");
    flat.split('.').filter(|key| !key.is_empty()).map(str::to_owned).collect()
}

/// A walk down a document and its schema.
struct Walk<'a> {
    setting: &'a Override,
    root: &'static Value,
    schema: &'static Value,
    pointer: String,
}

impl<'a> Walk<'a> {
    fn from_root(setting: &'a Override, root: &'static Value) -> Self {
        Self { setting, root, schema: root, pointer: String::new() }
    }

    /// One step down; whatever must be there for the next step is made.
    fn enter(&mut self, document: &mut Document, key: &str, is_last: bool) -> Result<(), Diagnostic> {
        let knows = |key: &str| self.tables().find_map(|table| property(table, key));
        let meant = crate::vocabulary::key(key).filter(|meant| knows(key).is_none() && knows(meant).is_some());
        let key = meant.unwrap_or(key);
        if let Some((plain, _)) = unit_suffix(key)
            && is_last
            && knows(key).is_none()
            && knows(plain).is_some()
        {
            // converted with the rest of the document; what stood there is replaced
            let plain = format!("{}/{}", self.pointer, escape(plain));
            document.remove(&plain);
            self.pointer = format!("{}/{}", self.pointer, escape(key));
            return Ok(());
        }
        let known_to_table = knows(key);
        let index = key.parse::<usize>().ok();
        let item = index.and(self.lists().find_map(|list| list.get("items")));
        let Some(schema) = known_to_table.or(item) else { return Err(self.unknown(document, key)) };
        self.check_presence(document, key, known_to_table.is_some(), index)?;
        self.pointer = format!("{}/{}", self.pointer, escape(key));
        self.schema = schema;
        if !is_last && document.get(&self.pointer).is_none() {
            self.create(document)?;
        }
        Ok(())
    }

    /// The step must be possible in the file as it is: an entry that is there, a name that is used, a table to go into.
    fn check_presence(
        &self,
        document: &Document,
        key: &str,
        as_key: bool,
        index: Option<usize>,
    ) -> Result<(), Diagnostic> {
        let here = document.get(&self.pointer);
        match (here, index) {
            (Some(Value::Array(list)), Some(k)) if k >= list.len() => {
                let message =
                    format!("`{}` has {} entries, there is no entry {k}", self.setting.path.value, list.len());
                Err(self.setting.error(message).with_help("entries are counted from 0"))
            }
            (Some(Value::Object(table)), _) if as_key => {
                let named = self.tables().any(|t| t.get("properties").is_some_and(|p| p.get(key).is_some()));
                // an instance need not write the parameters of its file
                let of_instance = self.pointer.starts_with("/instance/") && self.pointer.ends_with("/parameters");
                if named || of_instance || table.contains_key(key) {
                    return Ok(());
                }
                let known: Vec<&str> = table.keys().map(String::as_str).collect();
                let diagnostic = self.setting.error(format!("there is no `{key}` in `{}`", last_key(&self.pointer)));
                Err(diagnostic.with_help(suggest::help(key, &known, "known")))
            }
            (Some(Value::Array(_)), Some(_)) => Ok(()),
            _ => {
                let what = last_key(&self.pointer);
                let diagnostic = self.setting.error(format!("`{what}` has no `{key}` in the file as it is"));
                Err(diagnostic.with_help(format!("set `{what}` as a whole")))
            }
        }
    }

    /// Adds a key that the file leaves out: the default of the schema, or an empty table.
    fn create(&self, document: &mut Document) -> Result<(), Diagnostic> {
        let content = match self.schema.get("default") {
            Some(default) => default.clone(),
            None if self.tables().next().is_some() => Value::Object(Map::new()),
            None => {
                let what = last_key(&self.pointer);
                let diagnostic = self.setting.error(format!("`{what}` is not in the file"));
                return Err(diagnostic.with_help(format!("set `{what}` as a whole")));
            }
        };
        document.put_silently(&self.pointer, content, &self.setting.path.at);
        Ok(())
    }

    fn unknown(&self, document: &Document, key: &str) -> Diagnostic {
        let known = self.known();
        let known: Vec<&str> = known.iter().copied().filter(|k| !matches!(*k, "name" | "parent")).collect();
        let what = if self.pointer.is_empty() { "a scene or experiment".into() } else { format!("`{}`", self.title()) };
        let diagnostic = self.setting.error(format!("`{}`: {what} has no `{key}`", self.setting.path.value));
        if self.pointer.is_empty() && document.get(&format!("/parameters/{}", escape(key))).is_some() {
            return diagnostic.with_help(format!("did you mean `parameters.{key}`?"));
        }
        if known.is_empty() && self.lists().next().is_some() {
            return diagnostic.with_help("it is a list; its entries are counted from 0");
        }
        diagnostic.with_help(suggest::help(key, &known, "keys"))
    }

    fn title(&self) -> String {
        let path = &self.setting.path.value;
        let keys = self.pointer.split('/').skip(1).filter(|s| s.parse::<usize>().is_err());
        match path.strip_prefix('/').and(path.split('.').next()) {
            Some(object) if keys.clone().count() == 1 => object.to_owned(),
            _ => last_key(&self.pointer).to_owned(),
        }
    }

    fn known(&self) -> Vec<&'static str> {
        let mut known: Vec<&str> = self.tables().flat_map(property_names).collect();
        if self.pointer.is_empty() {
            known.extend(property_names(scene_schema().as_object().expect("a schema is a table")));
        }
        keep_first(&mut known);
        known
    }

    fn tables(&self) -> impl Iterator<Item = &'static Map<String, Value>> {
        self.of_type("object")
    }

    fn lists(&self) -> impl Iterator<Item = &'static Map<String, Value>> {
        self.of_type("array")
    }

    fn of_type(&self, name: &'static str) -> impl Iterator<Item = &'static Map<String, Value>> {
        let choices = alternatives(self.root, self.schema).into_iter();
        choices.filter(move |choice| choice.get("type").and_then(Value::as_str) == Some(name))
    }
}

fn last_key(pointer: &str) -> &str {
    pointer.rsplit('/').find(|step| step.parse::<usize>().is_err()).unwrap_or("")
}

/// Applies those of `settings` that are for the file `target` to its document, in order; later ones win. Returns one
/// diagnostic for each setting that cannot be applied, as [`Override::apply`]; empty if all were.
pub fn apply_all(document: &mut Document, target: Target, settings: &[Override]) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    for setting in settings.iter().filter(|s| s.target() == target) {
        if let Err(diagnostic) = setting.apply(document, target) {
            diagnostics.push(diagnostic);
        }
    }
    diagnostics
}

/// Removes names that occur again: both files have some.
fn keep_first(names: &mut Vec<&str>) {
    let mut seen = std::collections::BTreeSet::new();
    names.retain(|name| seen.insert(*name));
}

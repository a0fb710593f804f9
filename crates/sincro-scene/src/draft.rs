//! Scene that is edited object by object and compiled again: structure that changes while a run is on.
//!
//! A draft is the list of the scene's tables with everything written out, in the order of the file. Objects keep a
//! number ([`Object::id`](crate::scene::Object)) by which they are known whatever their path becomes. The compiled
//! scene has the text of the draft as its source, so that a snapshot or a file can hold it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use serde_json::{Map, Value};
use sincro_dynamics::spatial::{Pose, Quat};

use crate::diagnostic::{Diagnostic, Diagnostics, SourceText};
use crate::document::Document;
use crate::expand::expand;
use crate::folder::Folder;
use crate::names::{collect, resolve_objects};
use crate::normalize::{Parameters, normalize};
use crate::scene::{Scene, SceneSource, compile_edited, scene_schema, scripts_of_model};
use crate::schema::validate;
use crate::script::{Script, ScriptParser};
use crate::tree::{JOINING, KINDS, join};

/// Lists of a scene file whose entries are objects of the tree.
const OBJECTS: [&str; 8] = ["joint", "body", "frame", "force", "rotor", "drag", "sensor", "camera"];
/// Keys of a scene file that have done their work once it is written out.
const SPENT: [&str; 5] = ["include", "default", "instance", "parameters", "initial_pose"];

/// True for a list of a scene file whose entries join objects, and go with them.
fn is_joining(list: &str) -> bool {
    JOINING.contains(&list) || list == "contact_pair"
}

/// Table of a scene file: an object, or what joins objects.
#[derive(Clone, Debug, PartialEq)]
struct Item {
    list: String,
    table: Map<String, Value>,
    /// Number of the object; none until the draft is compiled, and of tables that are no objects of the tree.
    id: Option<usize>,
    /// Keys that a frame had as a joint.
    parked: Option<Map<String, Value>>,
}

impl Item {
    fn name(&self) -> &str {
        self.table.get("name").and_then(Value::as_str).unwrap_or("")
    }

    fn parent(&self) -> &str {
        self.table.get("parent").and_then(Value::as_str).unwrap_or("/")
    }

    fn is_object(&self) -> bool {
        OBJECTS.contains(&self.list.as_str())
    }

    fn path(&self) -> String {
        join(self.parent(), self.name())
    }

    /// Pointers of all paths in the table, with the paths.
    fn references(&self) -> Vec<(String, String)> {
        let mut places = Vec::new();
        collect("", &Value::Object(self.table.clone()), &mut places);
        places
    }

    fn replace(&mut self, pointer: &str, text: String) {
        let mut keys = pointer.split('/').skip(1);
        let Some(first) = keys.next().and_then(|key| self.table.get_mut(key)) else { return };
        let below: String = keys.map(|key| format!("/{key}")).collect();
        if let Some(place) = first.pointer_mut(&below) {
            *place = Value::String(text);
        }
    }
}

/// Scene that is edited and compiled again. Paths are whole paths of objects, such as `/arm/link`.
///
/// ```
/// use sincro_scene::draft::SceneDraft;
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"
///     joint = [{ name = "base", kind = "free" }]
///     body = [{ name = "cube", parent = "/base", density = 1e3, shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }] }]
/// "#)?;
/// let mut draft = SceneDraft::new(&scene).unwrap();
/// let copied = draft.copy("/base", "second", "/", &sincro_dynamics::spatial::Pose::identity());
/// assert_eq!(copied[1], ("/base/cube".to_owned(), "/second/cube".to_owned()));
/// let two = draft.compile(scene.objects.len())?;
/// assert_eq!((two.model.n_v(), two.object("/second").unwrap().id), (12, 2));
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct SceneDraft {
    items: Vec<Item>,
    /// Keys of the scene file beside its lists.
    top: Map<String, Value>,
    folder: Arc<Folder>,
    seed: u64,
    /// Scripts, compiled; their paths are those that their objects have now, their numbers may not be.
    scripts: Vec<Script>,
}

impl SceneDraft {
    /// Creates a draft of a compiled scene; `None` if the scene does not know its file.
    #[must_use]
    pub fn new(scene: &Scene) -> Option<Self> {
        let SceneSource { document, folder, seed, parked } = &**scene.source.as_ref()?;
        let mut draft = Self::of_document(document, folder, *seed);
        let ids: BTreeMap<&str, usize> = scene.objects.iter().map(|o| (o.path.as_str(), o.id)).collect();
        for item in draft.items.iter_mut().filter(|item| item.is_object()) {
            item.id = ids.get(item.path().as_str()).copied();
            item.parked = item.id.and_then(|id| parked.get(&id).cloned());
        }
        // lengths that were measured at the start stay as they are
        let names = &scene.model.names().spring_dampers;
        for item in draft.items.iter_mut().filter(|item| matches!(&*item.list, "spring_damper" | "tendon")) {
            let path = format!("/{}", item.name());
            let own = names.iter().position(|name| *name == path).map(|k| scene.model.spring_dampers()[k].free_length);
            if let (Some(length), false) = (own, item.table.contains_key("free_length")) {
                item.table.insert("free_length".into(), length.into());
            }
        }
        draft.scripts.clone_from(&scene.scripts);
        Some(draft)
    }

    /// The tables of a document, in the order in which they were written.
    fn of_document(document: &Document, folder: &Arc<Folder>, seed: u64) -> Self {
        let (mut items, mut top) = (Vec::new(), Map::new());
        for (key, value) in document.root.as_object().into_iter().flatten() {
            // scripts are kept compiled
            let is_list = KINDS.contains(&key.as_str()) || matches!(key.as_str(), "contact_pair" | "script");
            if !(is_list || SPENT.contains(&key.as_str())) {
                top.insert(key.clone(), value.clone());
            }
        }
        for list in KINDS.into_iter().chain(["contact_pair"]) {
            let entries = document.get(&format!("/{list}")).and_then(Value::as_array);
            for (k, entry) in entries.into_iter().flatten().enumerate() {
                if let Value::Object(table) = entry {
                    let start = document.at(&format!("/{list}/{k}")).span.start;
                    items.push((start, Item { list: list.into(), table: table.clone(), id: None, parked: None }));
                }
            }
        }
        items.sort_by_key(|(start, _)| *start);
        let items = items.into_iter().map(|(_, item)| item).collect();
        Self { items, top, folder: folder.clone(), seed, scripts: Vec::new() }
    }

    fn place(&self, path: &str) -> Option<usize> {
        self.items.iter().position(|item| item.is_object() && item.path() == path)
    }

    /// Returns true if there is an object of that path.
    #[must_use]
    pub fn has(&self, path: &str) -> bool {
        self.place(path).is_some()
    }

    /// Returns list and table of an object, such as `body` with its keys; `None` if there is none.
    #[must_use]
    pub fn table(&self, path: &str) -> Option<(&str, &Map<String, Value>)> {
        self.place(path).map(|k| (self.items[k].list.as_str(), &self.items[k].table))
    }

    /// Returns the paths of an object and of all below it, parents before children; an empty path stands for the world.
    #[must_use]
    pub fn subtree(&self, path: &str) -> Vec<String> {
        let below = format!("{path}/");
        let own = self.items.iter().filter(|item| item.is_object()).map(Item::path);
        let mut found: Vec<String> = own.filter(|p| p == path || p.starts_with(&below)).collect();
        found.sort_by_key(|p| p.matches('/').count());
        found
    }

    /// Returns the paths of the direct children of an object.
    #[must_use]
    pub fn children(&self, path: &str) -> Vec<String> {
        self.items.iter().filter(|item| item.is_object() && item.parent() == path).map(Item::path).collect()
    }

    /// Adds an object to a list (`body`, `joint`, `frame` …) of the scene file with the keys of `table`, and returns
    /// its path. The keys are checked when the draft is compiled.
    pub fn add(&mut self, list: &str, table: Map<String, Value>) -> String {
        let item = Item { list: list.to_owned(), table, id: None, parked: None };
        let path = item.path();
        self.items.push(item);
        path
    }

    /// Gives an object the number that it has from now on.
    pub fn set_id(&mut self, path: &str, id: usize) {
        if let Some(k) = self.place(path) {
            self.items[k].id = Some(id);
        }
    }

    /// Moves an object to another list with other keys, which must name the same object: a joint becomes a frame.
    pub fn replace(&mut self, path: &str, list: &str, table: Map<String, Value>) {
        if let Some(k) = self.place(path) {
            (self.items[k].list, self.items[k].table) = (list.to_owned(), table);
        }
    }

    /// Turns a joint into a frame with other keys, which remembers the keys of the joint.
    pub fn park(&mut self, path: &str, keys: Map<String, Value>) {
        if let Some(k) = self.place(path) {
            let item = &mut self.items[k];
            item.list = "frame".to_owned();
            item.parked = Some(std::mem::replace(&mut item.table, keys));
        }
    }

    /// Turns a frame that was a joint into one again: with the keys that it had, but for those of `keys`, at its
    /// initial position.
    pub fn unpark(&mut self, path: &str, keys: Map<String, Value>) {
        if let Some(k) = self.place(path) {
            let item = &mut self.items[k];
            item.list = "joint".to_owned();
            item.table = item.parked.take().unwrap_or_default();
            item.table.remove("initial");
            item.table.remove("rotation_deg");
            item.table.extend(keys);
        }
    }

    /// Removes objects, and the closures, couplings, springs, pairs and scripts that name them. What hangs on them must
    /// be removed or hung elsewhere, too.
    pub fn remove(&mut self, paths: &BTreeSet<String>) {
        let is_gone = |text: &String| paths.contains(text);
        self.items.retain(|item| {
            let names_it = || item.references().iter().any(|(_, text)| is_gone(text));
            if item.is_object() { !is_gone(&item.path()) } else { !names_it() }
        });
        self.scripts.retain(|script| !is_gone(&script.path));
        for item in self.items.iter_mut().filter(|item| item.is_object()) {
            // lists of what a sensor looks at lose what has gone; other keys that named it are dropped
            for key in ["with", "joint", "look_at_object"] {
                match item.table.get_mut(key) {
                    Some(Value::Array(list)) => {
                        list.retain(|v| v.as_str().is_none_or(|text| !paths.contains(text)));
                    }
                    Some(Value::String(text)) if paths.contains(text.as_str()) => {
                        item.table.remove(key);
                    }
                    _ => {}
                }
            }
        }
    }

    /// Gives all paths that are `old` or lie below it the beginning `new`.
    fn rename(&mut self, old: &str, new: &str) {
        let below = format!("{old}/");
        for item in &mut self.items {
            for (pointer, text) in item.references() {
                if text == old {
                    item.replace(&pointer, new.to_owned());
                } else if let Some(rest) = text.strip_prefix(&below) {
                    item.replace(&pointer, format!("{new}/{rest}"));
                }
            }
        }
        for script in &mut self.scripts {
            if script.path == old {
                new.clone_into(&mut script.path);
            } else if let Some(rest) = script.path.strip_prefix(&below) {
                script.path = format!("{new}/{rest}");
            }
        }
    }

    /// Gives an object another name; returns its new path.
    pub fn set_name(&mut self, path: &str, name: &str) -> String {
        let Some(k) = self.place(path) else { return path.to_owned() };
        self.items[k].table.insert("name".into(), name.into());
        let new = self.items[k].path();
        self.rename(path, &new);
        new
    }

    /// Hangs an object with all below it on another parent (`/`: the world) at a pose there `[m]`; returns its new
    /// path.
    pub fn hang(&mut self, path: &str, parent: &str, pose: &Pose<f64>) -> String {
        let Some(k) = self.place(path) else { return path.to_owned() };
        self.items[k].table.insert("parent".into(), parent.into());
        self.set_pose_of(k, pose);
        let new = self.items[k].path();
        if new != path {
            self.rename(path, &new);
        }
        new
    }

    /// Puts an object at a pose in its parent `[m]`.
    pub fn set_pose(&mut self, path: &str, pose: &Pose<f64>) {
        if let Some(k) = self.place(path) {
            self.set_pose_of(k, pose);
        }
    }

    fn set_pose_of(&mut self, k: usize, pose: &Pose<f64>) {
        let table = &mut self.items[k].table;
        for key in ["rotation_deg", "look_at", "up"] {
            table.remove(key);
        }
        table.extend(pose_keys(pose));
    }

    /// Copies an object with all below it, their scripts, and what joins objects of the copy among themselves. The copy
    /// has the name `name`, hangs on `parent` and stands at `pose` there `[m]`. Returns the paths of the originals,
    /// each with that of its copy, parents before children.
    pub fn copy(&mut self, path: &str, name: &str, parent: &str, pose: &Pose<f64>) -> Vec<(String, String)> {
        let originals = self.subtree(path);
        self.copy_some(&originals, path, name, parent, pose)
    }

    /// As [`SceneDraft::copy`], of these objects alone; `paths` has the root and whatever of the objects below it.
    pub fn copy_some(
        &mut self,
        paths: &[String],
        root: &str,
        name: &str,
        parent: &str,
        pose: &Pose<f64>,
    ) -> Vec<(String, String)> {
        let new_root = join(parent, name);
        let new_path = |old: &str| format!("{new_root}{}", old.strip_prefix(root).unwrap_or(""));
        let pairs: Vec<(String, String)> = paths.iter().map(|old| (old.clone(), new_path(old))).collect();
        let is_copied = |text: &str| paths.iter().any(|path| path == text);
        let mut copies = Vec::new();
        for item in &self.items {
            let is_own = item.is_object() && is_copied(&item.path());
            let references = item.references();
            let joins = is_joining(&item.list) && references.iter().all(|(_, text)| is_copied(text));
            if !(is_own || joins) {
                continue;
            }
            let mut copy = Item { id: None, parked: None, ..item.clone() };
            let is_root = is_own && item.path() == root;
            for (pointer, text) in references.iter().filter(|(_, text)| is_copied(text)) {
                copy.replace(pointer, new_path(text));
            }
            if is_root {
                copy.table.insert("name".into(), name.into());
                copy.table.insert("parent".into(), parent.into());
            } else if joins && item.table.contains_key("name") {
                let flat = new_root.trim_start_matches('/').replace('/', "-");
                copy.table.insert("name".into(), format!("{flat}-{}", item.name()).into());
            }
            copies.push(copy);
        }
        self.items.append(&mut copies);
        let scripts = self.scripts.iter().filter(|script| is_copied(&script.path));
        let scripts: Vec<_> = scripts.map(|script| Script { path: new_path(&script.path), ..script.clone() }).collect();
        self.scripts.extend(scripts);
        if let Some(k) = self.place(&new_root) {
            self.set_pose_of(k, pose);
        }
        pairs
    }

    /// Takes the scripts of an object away.
    pub fn remove_scripts(&mut self, path: &str) {
        self.scripts.retain(|script| script.path != path);
    }

    /// Loads the objects of a scene file, or of the scene of a folder, below a new frame `name` at the world's origin,
    /// with its scripts if `parser` knows their language. Returns the paths of all objects, the frame first.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or something in it is wrong.
    pub fn load(
        &mut self,
        file: &Path,
        name: &str,
        parser: Option<&dyn ScriptParser>,
    ) -> Result<Vec<String>, Diagnostics> {
        let shown = relative(self.folder.path(), file)
            .ok_or_else(|| Diagnostic::without_location(format!("`{}` cannot be reached", file.display())))?;
        let mut instance = Map::new();
        instance.insert("file".into(), shown.into());
        instance.insert("name".into(), name.into());
        let text = format!("[[instance]]\n{}", lines_of(&instance));
        let source = Arc::new(SourceText { path: PathBuf::from("model"), text });
        let mut document = Document::parse(&source)?;
        let parameters = Parameters::new();
        let mut found = Diagnostics::default();
        expand(&mut document, &self.folder, &parameters, &[], &mut found);
        found.merge(normalize(&mut document, scene_schema(), &parameters));
        found.merge(resolve_objects(&mut document));
        if found.any_error() {
            return Err(found.sorted());
        }
        let loaded = self.take(&document, name)?;
        if parser.is_some() {
            let paths: Vec<&str> = loaded.iter().map(String::as_str).collect();
            let scripts = scripts_of_model(&document, &paths, &self.folder, parser, &mut found);
            if found.any_error() {
                return Err(found.sorted());
            }
            self.scripts.extend(scripts);
        }
        Ok(loaded)
    }

    /// Loads the objects of the text of a scene file, as [`SceneDraft::part`] gives it, below a new frame `name` at the
    /// world's origin. Files that it names are looked for in the folder of the scene. Returns the paths of all of them,
    /// the frame first.
    ///
    /// # Errors
    ///
    /// The text is no scene file, or includes others.
    pub fn load_text(&mut self, text: &str, name: &str) -> Result<Vec<String>, Diagnostics> {
        let source = Arc::new(SourceText { path: PathBuf::from("model"), text: text.to_owned() });
        let mut document = Document::parse(&source)?;
        if let Some(key) = ["include", "instance", "script"].into_iter().find(|key| document.root.get(*key).is_some()) {
            let message = format!("the text of a model has `{key}`: load it from a file");
            return Err(Diagnostic::without_location(message).into());
        }
        if leads_out(&document.root) {
            let message = "the text of a model names a file outside of the folder of the scene";
            return Err(Diagnostic::without_location(message).into());
        }
        let parameters = Parameters::new();
        let mut found = Diagnostics::default();
        expand(&mut document, &self.folder, &parameters, &[], &mut found);
        found.merge(resolve_objects(&mut document));
        found.merge(validate(&document, scene_schema()));
        if found.any_error() {
            return Err(found.sorted());
        }
        let mut other = Self::of_document(&document, &self.folder, self.seed);
        // every path of the text at once: an object of it may have the name of the frame
        let tops = other.children("/");
        let is_path = |text: &str| {
            tops.iter()
                .any(|top| text.strip_prefix(&**top).is_some_and(|rest| rest.is_empty() || rest.starts_with('/')))
        };
        let root = format!("/{name}");
        for item in &mut other.items {
            for (pointer, text) in item.references() {
                if is_path(&text) {
                    item.replace(&pointer, format!("{root}{text}"));
                }
            }
            if item.is_object() && matches!(item.parent(), "" | "/") {
                item.table.insert("parent".into(), root.clone().into());
            }
        }
        let frame = Map::from_iter([("name".to_owned(), name.into()), ("parent".to_owned(), "/".into())]);
        other.add("frame", frame);
        for item in other.items.iter_mut().filter(|item| JOINING.contains(&&*item.list)) {
            let flat = format!("{name}-{}", item.name());
            item.table.insert("name".into(), flat.into());
        }
        Ok(self.adopt(other, &root))
    }

    /// Takes the objects of a document below the frame `name` of the world; returns their paths, the frame first.
    fn take(&mut self, document: &Document, name: &str) -> Result<Vec<String>, Diagnostics> {
        let found = validate(document, scene_schema());
        if found.any_error() {
            return Err(found.sorted());
        }
        let other = Self::of_document(document, &self.folder, self.seed);
        Ok(self.adopt(other, &format!("/{name}")))
    }

    fn adopt(&mut self, other: Self, root: &str) -> Vec<String> {
        let loaded = other.subtree(root);
        // the frame comes before what it carries
        let (frame, rest): (Vec<Item>, Vec<Item>) =
            other.items.into_iter().partition(|item| item.is_object() && item.path() == *root);
        self.items.extend(frame.into_iter().chain(rest));
        loaded
    }

    /// Returns the text of a scene file that holds an object with all below it, at the world's origin; `initial` gives
    /// the coordinates of joints by their paths, in the order and units of the scene file.
    #[must_use]
    pub fn part(&self, path: &str, initial: &dyn Fn(&str) -> Option<Vec<f64>>) -> String {
        let mut part = self.clone();
        let keep: BTreeSet<String> = self.subtree(path).into_iter().collect();
        part.items.retain(|item| {
            let joins = is_joining(&item.list);
            let is_own = |text: &String| keep.contains(text);
            if item.is_object() {
                is_own(&item.path())
            } else {
                joins && item.references().iter().all(|(_, text)| is_own(text))
            }
        });
        for item in part.items.iter_mut().filter(|item| item.list == "joint") {
            item.table.remove("initial");
            if let Some(position) = initial(&item.path()) {
                let position = if let [x] = position[..] { x.into() } else { Value::from(position) };
                item.table.insert("initial".into(), Value::Object(Map::from_iter([("position".into(), position)])));
            }
        }
        part.hang(path, "/", &Pose::identity());
        part.top = Map::from_iter([("format".to_owned(), Value::from(2))]);
        part.text()
    }

    /// Compiles the draft; objects that are new get numbers from `next_id` on, in their order. The state is not
    /// checked: the scene goes on from another one.
    ///
    /// # Errors
    ///
    /// All findings about the scene; their places are in [`SceneDraft::text`].
    pub fn compile(&self, next_id: usize) -> Result<Scene, Diagnostics> {
        let (document, mut scene) = compile_written_out(self.text(), &self.folder, self.seed)?;
        let ids: BTreeMap<String, Option<usize>> =
            self.items.iter().filter(|item| item.is_object()).map(|item| (item.path(), item.id)).collect();
        let mut next = next_id;
        scene.renumber(|path| {
            ids.get(path).copied().flatten().unwrap_or_else(|| {
                next += 1;
                next - 1
            })
        });
        let scripts = self.scripts.iter().filter_map(|script| {
            let object = scene.object(&script.path)?.id;
            Some(Script { object, ..script.clone() })
        });
        scene.scripts = scripts.collect();
        let (folder, seed) = (self.folder.clone(), self.seed);
        let parked = self.items.iter().filter_map(|item| {
            let id = scene.object(&item.path()).filter(|_| item.is_object())?.id;
            Some((id, item.parked.clone()?))
        });
        let parked = parked.collect();
        scene.source = Some(Arc::new(SceneSource { document, folder, seed, parked }));
        Ok(scene)
    }

    /// Returns the text of the scene file, everything written out.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = lines_of(&self.top);
        for item in &self.items {
            let _ = write!(text, "\n[[{}]]\n{}", item.list, lines_of(&item.table));
        }
        text
    }
}

/// Compiles a text in which everything is written out.
fn compile_written_out(text: String, folder: &Folder, seed: u64) -> Result<(Document, Scene), Diagnostics> {
    let document = Document::parse(&Arc::new(SourceText { path: folder.path_of("scene.toml"), text }))?;
    let found = validate(&document, scene_schema());
    if found.any_error() {
        return Err(found);
    }
    let scene = compile_edited(&document, folder, seed)?;
    Ok((document, scene))
}

/// Compiles a text of [`SceneDraft::text`] again, as a snapshot holds it; `source` has folder and seed, `ids` the
/// numbers of the objects in their order, `parked` is the text of [`parked_text`].
///
/// # Errors
///
/// The text is no scene, or has another number of objects.
pub fn compile_text(text: &str, source: &SceneSource, ids: &[usize], parked: &str) -> Result<Scene, Diagnostics> {
    let SceneSource { folder, seed, .. } = source;
    let parked = serde_json::from_str(parked).map_err(|e| Diagnostic::without_location(e.to_string()))?;
    let (document, mut scene) = compile_written_out(text.to_owned(), folder, *seed)?;
    if scene.objects.len() != ids.len() {
        return Err(Diagnostic::without_location("the scene has another number of objects").into());
    }
    let mut next = ids.iter();
    scene.renumber(|_| next.next().copied().unwrap_or(0));
    scene.source = Some(Arc::new(SceneSource { document, folder: folder.clone(), seed: *seed, parked }));
    Ok(scene)
}

/// Returns the keys of the joints that are frames at present as text, for [`compile_text`].
#[must_use]
pub fn parked_text(source: &SceneSource) -> String {
    serde_json::to_string(&source.parked).unwrap_or_default()
}

/// Keys of a pose: position `[m]` and quaternion w, x, y, z.
#[must_use]
pub fn pose_keys(pose: &Pose<f64>) -> [(String, Value); 2] {
    let mut quaternion = [0.0; 4];
    Quat::from_matrix(&pose.rot).normalized().write(&mut quaternion);
    let position = ("position".to_owned(), Value::from(pose.pos.0.to_vec()));
    [position, ("quaternion_wxyz".to_owned(), Value::from(quaternion.to_vec()))]
}

/// Returns true if a value names a file that does not lie in the folder of the scene or below it.
fn leads_out(value: &Value) -> bool {
    let is_out =
        |name: &str| !Path::new(name).components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    match value {
        Value::Array(list) => list.iter().any(leads_out),
        Value::Object(table) => table.iter().any(|(key, value)| match (key.as_str(), value) {
            ("file", Value::String(name)) => is_out(name),
            (_, value) => leads_out(value),
        }),
        _ => false,
    }
}

/// A table as lines `key = value`.
fn lines_of(table: &Map<String, Value>) -> String {
    let line = |(key, value): (&String, &Value)| format!("{} = {}\n", key_of(key), inline(value));
    table.iter().map(line).collect()
}

fn key_of(key: &str) -> String {
    let is_bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_bare { key.to_owned() } else { Value::from(key).to_string() }
}

/// A value of JSON as TOML; null stands for a number that is infinite.
fn inline(value: &Value) -> String {
    match value {
        Value::Null => "inf".into(),
        // JSON's escapes are TOML's, but for the delete character
        Value::String(_) => value.to_string().replace('\u{7f}', "\\u007F"),
        Value::Array(list) => format!("[{}]", list.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let entry = |(key, value): (&String, &Value)| format!("{} = {}", key_of(key), inline(value));
            format!("{{ {} }}", table.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

/// Path of a file as seen from a folder.
fn relative(folder: &Path, file: &Path) -> Option<String> {
    let (folder, file) = (folder.canonicalize().ok()?, file.canonicalize().ok()?);
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (folder.components().collect(), file.components().collect());
    let n = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), from.len() - n);
    let down = to[n..].iter().map(|c| c.as_os_str().to_string_lossy().into_owned());
    Some(up.chain(down).collect::<Vec<_>>().join("/"))
}

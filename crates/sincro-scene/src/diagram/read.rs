//! From the diagram file to a [`Diagram`]: parameters to blocks, texts to wires, definitions to inner diagrams.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use serde_json::Value as Json;
use sincro_blocks::diagram::{Content, Diagram, Wire};
use sincro_blocks::endpoint::{Endpoint, EndpointError};
use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::Kind;
use sincro_blocks::library;
use sincro_blocks::reader::{Files, NoFiles, ParameterError, Reader, Value};

use super::file::{BlockFile, DefinitionFile, DiagramFile};
use super::robot;
use super::robot_model::{Models, Request};
use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location};
use crate::document::{Document, NonJson, escape};
use crate::folder::Folder;
use crate::overrides::Override;
use crate::series;
use crate::suggest;

/// Names of numbers that formulas know.
pub(super) type Scope = BTreeMap<String, f64>;

/// Deepest nesting of diagrams.
const MAX_DEPTH: usize = 256;

/// Most blocks that definitions inside definitions may come to.
const MAX_BLOCKS: usize = 100_000;

/// Locations of a diagram, its blocks and its wires in the file.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    /// JSON pointer to the table that has `block` and `wires`.
    pub pointer: String,
    /// For each wire of the [`Diagram`]: number of its text, and bytes of its source and target in it.
    pub wires: Vec<(usize, core::ops::Range<usize>, core::ops::Range<usize>)>,
    /// For each entry: where the diagram in it stands, if it is one.
    pub inner: BTreeMap<String, Origin>,
}

/// Reads diagrams, noting what is wrong.
pub(super) struct DiagramReader<'a> {
    pub document: &'a Document,
    pub folder: &'a Folder,
    pub file: &'a DiagramFile,
    pub robot: &'a robot::Context,
    pub diagnostics: Diagnostics,
    /// Definitions around what is being read, outermost first.
    pub around: Vec<usize>,
    /// Blocks read so far, those of every use of a definition counted.
    pub n_blocks: usize,
    /// Models other than the scene's.
    models: Models<'a>,
    /// File, place and words of the problems.
    said: BTreeSet<(Option<PathBuf>, usize, String)>,
}

impl<'a> DiagramReader<'a> {
    /// Before reading.
    pub fn new(
        document: &'a Document,
        folder: &'a Folder,
        file: &'a DiagramFile,
        robot: &'a robot::Context,
        models: Models<'a>,
    ) -> Self {
        Self {
            document,
            folder,
            file,
            robot,
            diagnostics: Diagnostics::new(),
            around: Vec::new(),
            n_blocks: 0,
            models,
            said: BTreeSet::new(),
        }
    }

    /// The whole file.
    pub fn diagram(&mut self, outer: &Scope) -> (Diagram, Origin, Option<f64>) {
        self.check_definitions();
        let mut scope = outer.clone();
        let given = self.file_parameters();
        self.fill_scope(&mut scope, &given);
        let sample_time = self.number("/sample_time", &scope);
        let (diagram, origin) = self.content("", &self.file.block, &self.file.wires, &scope);
        self.check_unused();
        (diagram, origin, sample_time)
    }

    /// Definitions that no block uses are looked over with their defaults: what is wrong in them should not wait for
    /// their first use.
    fn check_unused(&mut self) {
        let of_definitions = self.file.diagram.iter().flat_map(|d| &d.block);
        let used: Vec<&str> = self.file.block.iter().chain(of_definitions).map(|b| b.kind.as_str()).collect();
        for (k, definition) in self.file.diagram.iter().enumerate() {
            if used.contains(&definition.name.as_str()) {
                continue;
            }
            let mut scope = Scope::new();
            for name in definition.parameters.keys() {
                let value = self.number(&format!("/diagram/{k}/parameters/{}", escape(name)), &Scope::new());
                scope.insert(name.clone(), value.unwrap_or(1.0));
            }
            self.around.push(k);
            self.content(&format!("/diagram/{k}"), &definition.block, &definition.wires, &scope);
            self.around.pop();
        }
    }

    /// Keys of the file's parameters in the order in which they stand there: each may use those before.
    fn file_parameters(&self) -> Vec<(String, String)> {
        let table = self.document.get("/parameters").and_then(Json::as_object);
        let mut list: Vec<(String, String)> =
            table.into_iter().flatten().map(|(k, _)| (k.clone(), format!("/parameters/{}", escape(k)))).collect();
        list.sort_by_key(|(_, pointer)| self.document.at(pointer).span.start);
        list
    }

    fn fill_scope(&mut self, scope: &mut Scope, parameters: &[(String, String)]) {
        for (name, pointer) in parameters {
            self.check_parameter_name(name, pointer);
            if let Some(x) = self.number(pointer, scope) {
                scope.insert(name.clone(), x);
            }
        }
    }

    fn check_parameter_name(&mut self, name: &str, pointer: &str) {
        let help = if !sincro_math::expression::is_name(name) || name == "t" || name == "pi" {
            "letters, digits and `_`, beginning with a letter; `t` and `pi` have a meaning of their own"
        } else if pointer.starts_with("/diagram/") && matches!(name, "name" | "type" | "sample_time" | "unit") {
            "every block has a key of that name"
        } else {
            return;
        };
        let message = format!("`{name}` cannot be the name of a parameter");
        self.push(Diagnostic::error(&self.document.key_at(pointer), message).with_help(help));
    }

    /// Notes a problem once, however often a definition is used.
    fn push(&mut self, diagnostic: Diagnostic) {
        let start = diagnostic.span.as_ref().map_or(0, |span| span.start);
        let path = diagnostic.source.as_ref().map(|source| source.path.clone());
        if self.said.insert((path, start, diagnostic.message.clone())) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// The number or formula at a pointer, none if nothing is there.
    fn number(&mut self, pointer: &str, scope: &Scope) -> Option<f64> {
        let json = self.document.get(pointer)?;
        let given = BTreeMap::from([("gain".to_owned(), self.value(json, pointer))]);
        let n_problems = self.diagnostics.0.len();
        // any block with one number will do: the reader turns formulas into numbers and says what is wrong with them
        let kind = library::find("gain").expect("the library has a gain").kind;
        let mut reader = Reader::new(kind, &given, scope, &NoFiles);
        let x = reader.number("gain");
        let key = pointer.rsplit('/').next().unwrap_or("");
        for fault in reader.finish() {
            let message = fault.message.replacen("`gain`", &format!("`{key}`"), 1);
            self.fault_at(pointer, ParameterError { path: Vec::new(), message, ..fault }, None);
        }
        // what has been noted is not noted again wherever it is used
        (x.is_finite() || self.diagnostics.0.len() > n_problems).then_some(if x.is_finite() { x } else { 1.0 })
    }

    fn check_definitions(&mut self) {
        for (k, definition) in self.file.diagram.iter().enumerate() {
            let at = self.document.at(&format!("/diagram/{k}/name"));
            let is_block = library::find(&definition.name).is_some() || robot::find(&definition.name).is_some();
            let is_second = self.file.diagram[..k].iter().any(|d| d.name == definition.name);
            if is_block || is_second {
                let what = if is_block { "a block of the library" } else { "another diagram of this file" };
                let diagnostic = Diagnostic::error(&at, format!("`{}` is {what}", definition.name));
                self.diagnostics.push(diagnostic.with_help("give the diagram another name"));
            }
        }
    }

    /// The blocks and wires of one table.
    fn content(&mut self, pointer: &str, blocks: &[BlockFile], wires: &[String], scope: &Scope) -> (Diagram, Origin) {
        let mut diagram = Diagram::new();
        let mut origin = Origin { pointer: pointer.to_owned(), wires: Vec::new(), inner: BTreeMap::new() };
        for (k, block) in blocks.iter().enumerate() {
            let at = format!("{pointer}/block/{k}");
            self.n_blocks += 1;
            if self.n_blocks > MAX_BLOCKS {
                self.too_many_blocks(&at);
                break;
            }
            let sample_time = self.number(&format!("{at}/sample_time"), scope);
            let Some(((what, own), inner)) = self.what(block, &at, scope) else {
                continue;
            };
            // a definition's own sample time stands unless the block gives another
            diagram.add(&block.name, what, sample_time.or(own));
            if let Some(entry) = diagram.entries.last_mut() {
                entry.unit = block.unit.iter().flat_map(|unit| unit.texts()).cloned().collect();
            }
            if let Some(inner) = inner {
                origin.inner.insert(block.name.clone(), inner);
            }
        }
        for (k, text) in wires.iter().enumerate() {
            self.wire(&format!("{pointer}/wires/{k}"), k, text, &mut diagram, &mut origin);
        }
        (diagram, origin)
    }

    fn too_many_blocks(&mut self, at: &str) {
        let message = format!("the diagram has more than {MAX_BLOCKS} blocks");
        if self.diagnostics.0.iter().all(|p| p.message != message) {
            let diagnostic = Diagnostic::error(&self.document.title_at(at), message);
            self.diagnostics.push(diagnostic.with_help("count what the definitions inside definitions come to"));
        }
    }

    /// Resolves the type of a block: of the library, about the robot, or a diagram of this file.
    #[allow(clippy::type_complexity)]
    fn what(&mut self, block: &BlockFile, at: &str, scope: &Scope) -> Option<((Content, Option<f64>), Option<Origin>)> {
        if let Some(k) = self.file.diagram.iter().position(|d| d.name == block.kind) {
            let (inner, origin, sample_time) = self.instance(k, block, at, scope)?;
            let what = Content::Diagram(block.kind.clone(), Box::new(inner));
            return Some(((what, sample_time), Some(origin)));
        }
        let template = self.library_block(block, at, scope)?;
        Some(((Content::Block(template), None), None))
    }

    fn library_block(&mut self, block: &BlockFile, at: &str, scope: &Scope) -> Option<Box<dyn DynBlock>> {
        let given: BTreeMap<String, Value> = block
            .parameters
            .iter()
            .map(|(key, json)| (key.clone(), self.value(json, &format!("{at}/{}", escape(key)))))
            .collect();
        let files = FolderFiles(self.folder);
        let (template, faults) = if let Some(item) = library::find(&block.kind) {
            let mut reader = Reader::new(item.kind, &given, scope, &files);
            ((item.read)(&mut reader), reader.finish())
        } else if let Some(item) = robot::find(&block.kind) {
            let mut reader = Reader::new(item.kind, &given, scope, &files);
            match self.own_model(&mut reader, item.kind, at) {
                Some(context) => ((item.read)(&mut reader, &context), reader.finish()),
                None => return None,
            }
        } else {
            self.unknown_kind(block, at);
            return None;
        };
        let is_given = |fault: &ParameterError| fault.path.first().is_some_and(|key| given.contains_key(key));
        for (k, fault) in faults.iter().enumerate() {
            // the same of two parameters, such as a file that is not there: said where something is written
            let mut others = faults.iter().enumerate().filter(|(i, other)| *i != k && other.message == fault.message);
            if is_given(fault) || others.all(|(_, other)| !is_given(other)) {
                self.fault_at(at, fault.clone(), Some(&block.name));
            }
        }
        Some(template)
    }

    /// The context of a block that uses the model: with that of its `model` and `set`, if it has them; none if that
    /// model cannot be compiled.
    fn own_model(&mut self, reader: &mut Reader<'_>, kind: &Kind, at: &str) -> Option<robot::Context> {
        let takes = |key: &str| kind.parameters.iter().any(|p| p.name == key);
        let is_given = ["model", "set"].map(|key| takes(key) && reader.has(key));
        if !is_given.contains(&true) {
            return Some(self.robot.clone());
        }
        let file = is_given[0].then(|| reader.text("model"));
        let file = file.map(|value| Located { value, at: self.document.at(&format!("{at}/model")) });
        let set = if is_given[1] { reader.named_numbers("set") } else { Vec::new() };
        let setting = |(path, x): (String, f64)| {
            let pointer = format!("{at}/set/{}", escape(&path));
            let value = Located { value: format!("{x:?}"), at: self.document.at(&pointer) };
            Override { path: Located { value: path, at: self.document.key_at(&pointer) }, value }
        };
        let request = Request { file, set: set.into_iter().map(setting).collect() };
        match self.models.get(&request) {
            Ok(model) => Some(robot::Context { model, ..self.robot.clone() }),
            Err(found) => {
                found.0.into_iter().for_each(|diagnostic| self.push(diagnostic));
                None
            }
        }
    }

    fn unknown_kind(&mut self, block: &BlockFile, at: &str) {
        let kinds = library::all().map(|item| item.kind.name).chain(robot::all().map(|item| item.kind.name));
        let known: Vec<&str> = kinds.chain(self.file.diagram.iter().map(|d| d.name.as_str())).collect();
        let help = match suggest::nearest(&block.kind, known) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`sincro blocks` lists every block with its parameters".into(),
        };
        let message = format!("there is no block type `{}` (block `{}`)", block.kind, block.name);
        self.push(Diagnostic::error(&self.document.at(&format!("{at}/type")), message).with_help(help));
    }

    /// A diagram of this file with the parameters of a block.
    fn instance(
        &mut self,
        k: usize,
        block: &BlockFile,
        at: &str,
        outer: &Scope,
    ) -> Option<(Diagram, Origin, Option<f64>)> {
        let definition: &'a DefinitionFile = &self.file.diagram[k];
        let pointer = format!("/diagram/{k}");
        if self.around.contains(&k) || self.around.len() >= MAX_DEPTH {
            self.too_deep(k, at);
            return None;
        }
        let mut scope = Scope::new();
        for name in definition.parameters.keys() {
            let default = format!("{pointer}/parameters/{}", escape(name));
            self.check_parameter_name(name, &default);
            let value = match block.parameters.contains_key(name) {
                true => self.number(&format!("{at}/{}", escape(name)), outer),
                false => self.number(&default, &Scope::new()),
            };
            scope.insert(name.clone(), value.unwrap_or(1.0));
        }
        for key in block.parameters.keys().filter(|key| !definition.parameters.contains_key(*key)) {
            let known: Vec<&str> = definition.parameters.keys().map(String::as_str).collect();
            let message = format!("the diagram `{}` has no parameter `{key}`", definition.name);
            let at = self.document.key_at(&format!("{at}/{}", escape(key)));
            self.push(Diagnostic::error(&at, message).with_help(suggest::help(key, &known, "parameters")));
        }
        let sample_time = self.number(&format!("{pointer}/sample_time"), &scope);
        self.around.push(k);
        let (diagram, origin) = self.content(&pointer, &definition.block, &definition.wires, &scope);
        self.around.pop();
        let ports = Diagram { inputs: definition.inputs.clone(), outputs: definition.outputs.clone(), ..diagram };
        Some((ports, origin, sample_time))
    }

    /// A definition inside itself, or too many inside each other; `at` is the block that would go one deeper.
    fn too_deep(&mut self, k: usize, at: &str) {
        let place = self.document.at(&format!("{at}/type"));
        let diagnostic = match self.around.iter().position(|&i| i == k) {
            Some(first) => {
                let circle = self.around[first..].iter().chain([&k]).map(|&i| self.file.diagram[i].name.as_str());
                let circle = circle.collect::<Vec<_>>().join(" -> ");
                let message = format!("the diagram `{}` contains itself: {circle}", self.file.diagram[k].name);
                Diagnostic::error(&place, message).with_help("break the circle of definitions")
            }
            None => {
                let message = format!("more than {MAX_DEPTH} diagrams are nested in each other");
                Diagnostic::error(&place, message).with_help("put some of them side by side")
            }
        };
        self.push(diagnostic);
    }

    /// A text such as `a -> b.u1 -> c`: a wire for every arrow.
    fn wire(&mut self, pointer: &str, k: usize, text: &str, diagram: &mut Diagram, origin: &mut Origin) {
        let parts: Vec<(usize, &str)> = {
            let mut start = 0;
            let split = text.split("->").map(|part| {
                let at = start;
                start += part.len() + 2;
                (at, part)
            });
            split.collect()
        };
        if parts.len() < 2 {
            let diagnostic = Diagnostic::error(&self.document.at(pointer), format!("`{text}` is no wire"));
            self.push(diagnostic.with_help("write \"FROM -> TO\", such as \"error -> pid -> /motor1\""));
            return;
        }
        for pair in parts.windows(2) {
            let ((from_at, from), (to_at, to)) = (pair[0], pair[1]);
            let source = Endpoint::parse_list(from);
            let target = if to.trim_start().starts_with('[') {
                let start = to.len() - to.trim_start().len();
                let message = "a wire ends at one port; write a wire for each".to_owned();
                Err(EndpointError { span: start..to.trim_end().len(), message })
            } else {
                Endpoint::parse(to)
            };
            for (at, error) in [(from_at, source.as_ref().err()), (to_at, target.as_ref().err())] {
                if let Some(error) = error {
                    let span = at + error.span.start..at + error.span.end;
                    let place = within(&self.document.at(pointer), &span);
                    let help =
                        "ends of wires are `block`, `block.port`, `block.port[0]`, or `/joint.position` of the world";
                    self.push(Diagnostic::error(&place, error.message.clone()).with_help(help));
                }
            }
            if let (Ok(from_ends), Ok(to_end)) = (source, target) {
                let trimmed = |at: usize, part: &str| {
                    let begin = at + part.len() - part.trim_start().len();
                    begin..begin + part.trim().len()
                };
                origin.wires.push((k, trimmed(from_at, from), trimmed(to_at, to)));
                diagram.wires.push(Wire { from: from_ends, to: to_end });
            }
        }
    }

    /// A JSON value as a parameter.
    fn value(&self, json: &Json, pointer: &str) -> Value {
        match json {
            Json::Null => match self.document.non_json(pointer) {
                Some(NonJson::Infinite { positive: true }) => Value::Number(f64::INFINITY),
                Some(NonJson::Infinite { positive: false }) => Value::Number(f64::NEG_INFINITY),
                Some(NonJson::NotANumber) => Value::Number(f64::NAN),
                // a date, or an integer beyond 64 bits: fits nowhere
                _ => Value::Table(Vec::new()),
            },
            Json::Bool(flag) => Value::Flag(*flag),
            Json::Number(x) => Value::Number(x.as_f64().unwrap_or(f64::NAN)),
            Json::String(text) => Value::Text(text.clone()),
            Json::Array(list) => {
                Value::List(list.iter().enumerate().map(|(k, x)| self.value(x, &format!("{pointer}/{k}"))).collect())
            }
            Json::Object(table) => {
                let inner = |key: &str| format!("{pointer}/{}", escape(key));
                let mut list: Vec<(String, Value)> =
                    table.iter().map(|(key, x)| (key.clone(), self.value(x, &inner(key)))).collect();
                list.sort_by_key(|(key, _)| self.document.at(&inner(key)).span.start);
                Value::Table(list)
            }
        }
    }

    fn fault_at(&mut self, pointer: &str, fault: ParameterError, block: Option<&str>) {
        let inner = fault.path.iter().fold(pointer.to_owned(), |p, step| format!("{p}/{}", escape(step)));
        let is_unknown = fault.message.contains("has no parameter");
        let at = match (fault.path.is_empty(), is_unknown) {
            (true, _) if block.is_none() => self.document.at(&inner),
            (true, _) => self.document.title_at(&inner),
            // about a parameter that is left out
            _ if fault
                .path
                .first()
                .is_some_and(|key| self.document.get(&format!("{pointer}/{}", escape(key))).is_none()) =>
            {
                self.document.title_at(pointer)
            }
            (_, true) => self.document.key_at(&inner),
            _ => self.document.at(&inner),
        };
        let at = fault.span.as_ref().map_or_else(|| at.clone(), |span| within(&at, span));
        let message = match block {
            Some(name) => format!("block `{name}`: {}", fault.message),
            None => fault.message,
        };
        let diagnostic = Diagnostic::error(&at, message);
        let diagnostic = if fault.help.is_empty() { diagnostic } else { diagnostic.with_help(fault.help) };
        self.push(diagnostic);
    }
}

/// Bytes inside a string of the file; the whole string if it is not written plainly.
pub(super) fn within(string: &Location, span: &core::ops::Range<usize>) -> Location {
    let text = string.text();
    let is_plain = text.len() >= 2 && !text.contains('\\') && !text.starts_with("\"\"\"") && !text.starts_with("'''");
    if !is_plain || !text.starts_with(['"', '\'']) {
        return string.clone();
    }
    let start = string.span.start + 1;
    let end = string.span.end - 1;
    // an empty stretch points at the character where something is missing
    let (from, to) = (start + span.start, start + span.end.max(span.start + 1));
    Location { source: string.source.clone(), span: from.min(end)..to.min(end.max(from.min(end))) }
}

/// CSV files of the scene's folder.
struct FolderFiles<'a>(&'a Folder);

impl Files for FolderFiles<'_> {
    fn column(&self, file: &str, column: &str) -> Result<Vec<f64>, String> {
        series::column(self.0, file, column)
    }

    fn text(&self, file: &str) -> Result<String, String> {
        check_relative(file)?;
        self.0.read(file).map(|source| source.text.clone()).map_err(|diagnostic| diagnostic.message)
    }

    fn bytes(&self, file: &str) -> Result<Vec<u8>, String> {
        check_relative(file)?;
        self.0.bytes(file).map(|bytes| (*bytes).clone())
    }
}

fn check_relative(file: &str) -> Result<(), String> {
    if std::path::Path::new(file).is_absolute() {
        return Err(format!("the path `{file}` is absolute: give it relative to the scene folder"));
    }
    Ok(())
}

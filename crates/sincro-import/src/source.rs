//! Source documents, and the ledger of everything in them.
//!
//! A reader sees a document through [`Element`]. Each element, attribute and text that it asks for is marked in the
//! [`Ledger`]; it may add that the content was changed or dropped, and why. All that nobody asked for ends as dropped.
//! No element can be forgotten, because an element that was forgotten was not asked for.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use roxmltree::{Document, Node, NodeType, ParsingOptions};
use sincro_scene::diagnostic::{Diagnostic, Location, SourceText};

use crate::findings::Findings;

/// Largest robot file that is read [bytes].
pub(crate) const MAX_BYTES: u64 = 64 << 20;
/// Most elements, attributes and texts of a document.
const MAX_NODES: u32 = 2_000_000;
/// Deepest nesting of elements: the parser descends by recursion.
const MAX_DEPTH: usize = 256;

/// A text of XML.
#[derive(Clone, Debug)]
pub(crate) struct SourceFile {
    /// Path and text.
    pub text: Arc<SourceText>,
}

impl SourceFile {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Self, Diagnostic> {
        let shown = path.display();
        let refuse = |message: String| Diagnostic::without_location(message);
        let metadata = std::fs::metadata(path).map_err(|e| refuse(format!("`{shown}` cannot be read: {e}")))?;
        if !metadata.is_file() {
            return Err(refuse(format!("`{shown}` is not a file")));
        }
        if metadata.len() > MAX_BYTES {
            return Err(refuse(format!("`{shown}` has {} MiB, more than {}", metadata.len() >> 20, MAX_BYTES >> 20)));
        }
        let bytes = std::fs::read(path).map_err(|e| refuse(format!("`{shown}` cannot be read: {e}")))?;
        let text = String::from_utf8(bytes).map_err(|_| refuse(format!("`{shown}` is not UTF-8 text")))?;
        Ok(Self::of_text(path, text))
    }

    /// A text that stands for the file `path`.
    pub fn of_text(path: &Path, text: String) -> Self {
        let text = text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned);
        Self { text: Arc::new(SourceText { path: path.to_owned(), text }) }
    }

    /// The folder of the file.
    pub fn folder(&self) -> PathBuf {
        self.text.path.parent().map_or_else(PathBuf::new, Path::to_path_buf)
    }

    /// Parses the text. Document types are refused: their entities could expand without bound.
    pub fn parse(&self) -> Result<Document<'_>, Diagnostic> {
        let text = &self.text.text;
        if let Some(byte) = too_deep(text) {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            return Err(Diagnostic::error(&self.location(byte..byte + 1), message));
        }
        let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        Document::parse_with_options(text, options).map_err(|error| {
            let at = byte_at(text, error.pos());
            let diagnostic = Diagnostic::error(&self.location(at..(at + 1).min(text.len())), format!("XML: {error}"));
            match error {
                roxmltree::Error::DtdDetected => {
                    diagnostic.with_help("remove the document type: robots need no entities")
                }
                _ => diagnostic,
            }
        })
    }

    /// A stretch of the text.
    pub fn location(&self, span: std::ops::Range<usize>) -> Location {
        Location { source: self.text.clone(), span }
    }
}

/// The byte of a line and column.
fn byte_at(text: &str, position: roxmltree::TextPos) -> usize {
    let line: usize = text.split_inclusive('\n').take(position.row.saturating_sub(1) as usize).map(str::len).sum();
    let rest = text.get(line..).unwrap_or("");
    line + rest.chars().take(position.col.saturating_sub(1) as usize).map(char::len_utf8).sum::<usize>()
}

/// The byte where nesting gets too deep, counted from the tags alone.
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(next) = bytes.get(at..).and_then(|rest| rest.iter().position(|b| *b == b'<')) {
        at += next;
        let rest = &bytes[at..];
        let skip = |end: &[u8]| rest.windows(end.len()).position(|w| w == end).map_or(rest.len(), |k| k + end.len());
        if rest.starts_with(b"<!--") {
            at += skip(b"-->");
        } else if rest.starts_with(b"<![CDATA[") {
            at += skip(b"]]>");
        } else if rest.starts_with(b"<?") || rest.starts_with(b"<!") {
            at += skip(b">");
        } else {
            let length = tag_length(rest);
            if rest.starts_with(b"</") {
                depth = depth.saturating_sub(1);
            } else if length < 2 || rest[length - 2] != b'/' {
                depth += 1;
            }
            if depth > MAX_DEPTH {
                return Some(at);
            }
            at += length;
        }
    }
    None
}

/// Length of a tag; a `>` between quotes does not end it.
fn tag_length(rest: &[u8]) -> usize {
    let mut quote = None;
    for (k, byte) in rest.iter().enumerate() {
        match (quote, byte) {
            (None, b'>') => return k + 1,
            (None, b'"' | b'\'') => quote = Some(*byte),
            (Some(open), byte) if open == *byte => quote = None,
            _ => {}
        }
    }
    rest.len()
}

/// First bytes of the lines of a text.
struct Lines(Vec<usize>);

impl Lines {
    fn new(text: &str) -> Self {
        Self(
            std::iter::once(0)
                .chain(text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(k, _)| k + 1))
                .collect(),
        )
    }

    /// Line of a byte, counted from 1.
    fn of(&self, byte: usize) -> usize {
        self.0.partition_point(|start| *start <= byte)
    }
}

/// Status of an element or attribute of the source after an import.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ElementStatus {
    /// It is in the scene as it stands in the source.
    Kept,
    /// It is in the scene in another form; the words say which.
    Changed,
    /// It is not in the scene; the words say why.
    Dropped,
}

/// Marks of one element.
#[derive(Clone, Debug, Default)]
struct Mark {
    attributes: Vec<String>,
    text: bool,
    status: Option<ElementStatus>,
    words: Vec<String>,
}

/// Marks of all elements that were asked for, by document and node.
#[derive(Debug, Default)]
pub(crate) struct Ledger(RefCell<BTreeMap<(usize, u32), Mark>>);

impl Ledger {
    fn mark(&self, key: (usize, u32), change: impl FnOnce(&mut Mark)) {
        change(self.0.borrow_mut().entry(key).or_default());
    }

    /// Adds to the status of an element: a change or drop outweighs that it was kept.
    pub fn judge_place(&self, key: (usize, u32), status: ElementStatus, words: &str) {
        self.mark(key, |mark| {
            mark.status = Some(mark.status.map_or(status, |old| old.max(status)));
            if !words.is_empty() && !mark.words.iter().any(|w| w == words) {
                mark.words.push(words.to_owned());
            }
        });
    }

    /// The fates of everything in the documents, in their order. `reason` tells why a path is not read, if that is
    /// known.
    pub fn entries(&self, documents: &[Document<'_>], files: &[SourceFile], reason: Reason) -> Vec<Entry> {
        let marks = self.0.borrow();
        let mut entries = Vec::new();
        for (file, document) in documents.iter().enumerate() {
            let lines = Lines::new(&files[file].text.text);
            let name = files[file].text.path.display().to_string();
            let mut dropped_above: Vec<(Node<'_, '_>, String)> = Vec::new();
            for node in document.descendants().filter(Node::is_element) {
                while dropped_above.last().is_some_and(|(top, _)| !node.ancestors().any(|a| a == *top)) {
                    dropped_above.pop();
                }
                let inside = dropped_above.last().map(|(_, name)| name.clone());
                let key = (file, node.id().get());
                let mark = marks.get(&key);
                let entry = entry_of(node, mark, (&name, &lines), inside, reason);
                if entry.status == ElementStatus::Dropped && dropped_above.is_empty() {
                    dropped_above.push((node, entry.element.clone()));
                }
                let is_read = entry.status != ElementStatus::Dropped;
                entries.push(entry);
                if is_read {
                    entries.extend(unread_attributes(node, mark, (&name, &lines), reason));
                }
            }
        }
        entries
    }
}

/// Reason why the element or attribute (`@name`) of a path of element names is not read.
pub(crate) type Reason = fn(&[&str]) -> Option<&'static str>;

/// Element of the source, or attribute that is not read, with its status: a row of the import
/// [`Report`](crate::Report).
#[derive(Clone, Debug, serde::Serialize)]
pub struct Entry {
    /// Path of the source file.
    pub file: String,
    /// Line in the source file, from 1.
    pub line: usize,
    /// Path of the element, names in brackets; attributes begin with `@`.
    pub element: String,
    /// Status after the import.
    pub status: ElementStatus,
    /// Form in the scene, or reason of the loss; empty for what is kept.
    pub words: String,
    /// True inside an element that is dropped as a whole.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub inside: bool,
}

fn entry_of(
    node: Node<'_, '_>,
    mark: Option<&Mark>,
    (file, lines): (&str, &Lines),
    inside: Option<String>,
    reason: Reason,
) -> Entry {
    let (status, words) = match (mark, &inside) {
        (_, Some(above)) => (ElementStatus::Dropped, format!("with `{above}`")),
        (None, None) => (ElementStatus::Dropped, reason_of(node, None, reason)),
        (Some(mark), None) => {
            let text = node.children().any(|c| c.is_text() && c.text().is_some_and(|t| !t.trim().is_empty()));
            let status = mark.status.unwrap_or(ElementStatus::Kept);
            let mut words = mark.words.clone();
            if text && !mark.text && status == ElementStatus::Kept {
                words.push("its text is not read".into());
                (ElementStatus::Changed, words.join("; "))
            } else {
                (status, words.join("; "))
            }
        }
    };
    Entry {
        file: file.to_owned(),
        line: lines.of(node.range().start),
        element: path_of(node),
        status,
        words,
        inside: inside.is_some(),
    }
}

fn unread_attributes(
    node: Node<'_, '_>,
    mark: Option<&Mark>,
    (file, lines): (&str, &Lines),
    reason: Reason,
) -> Vec<Entry> {
    let read = mark.map(|mark| mark.attributes.as_slice()).unwrap_or_default();
    let unread = node.attributes().filter(|a| !read.iter().any(|name| name == a.name()));
    let entry = |a: roxmltree::Attribute<'_, '_>| Entry {
        file: file.to_owned(),
        line: lines.of(a.range().start),
        element: format!("{}/@{}", path_of(node), a.name()),
        status: ElementStatus::Dropped,
        words: reason_of(node, Some(a.name()), reason),
        inside: false,
    };
    unread.map(entry).collect()
}

fn reason_of(node: Node<'_, '_>, attribute: Option<&str>, reason: Reason) -> String {
    let mut names: Vec<&str> =
        node.ancestors().filter(|n| n.node_type() == NodeType::Element).map(|n| n.tag_name().name()).collect();
    names.reverse();
    let at = attribute.map(|name| format!("@{name}"));
    names.extend(at.as_deref());
    let known = reason(&names);
    known
        .unwrap_or(if attribute.is_some() { "no attribute that is read here" } else { "no element that is read here" })
        .into()
}

/// `robot/link[base]/visual`.
fn path_of(node: Node<'_, '_>) -> String {
    let mut parts: Vec<String> = node
        .ancestors()
        .filter(Node::is_element)
        .map(|n| match n.attribute("name").or_else(|| n.attribute("link").filter(|_| n.tag_name().name() == "child")) {
            Some(name) if n.parent().is_some_and(|p| p.is_element()) => format!("{}[{name}]", n.tag_name().name()),
            _ => n.tag_name().name().to_owned(),
        })
        .collect();
    parts.reverse();
    parts.join("/")
}

/// An element as the readers see it.
#[derive(Clone, Copy)]
pub(crate) struct Element<'d> {
    node: Node<'d, 'd>,
    index: usize,
    file: &'d SourceFile,
    ledger: &'d Ledger,
}

impl<'d> Element<'d> {
    /// The root of document `index`, marked as read.
    pub fn root(document: &'d Document<'d>, index: usize, file: &'d SourceFile, ledger: &'d Ledger) -> Self {
        Self { node: document.root_element(), index, file, ledger }.read()
    }

    fn key(&self) -> (usize, u32) {
        (self.index, self.node.id().get())
    }

    fn read(self) -> Self {
        self.ledger.mark(self.key(), |_| {});
        self
    }

    fn of(&self, node: Node<'d, 'd>) -> Self {
        Self { node, ..*self }
    }

    /// Its name without prefix.
    pub fn name(&self) -> &'d str {
        self.node.tag_name().name()
    }

    /// Its file.
    pub fn file(&self) -> &'d SourceFile {
        self.file
    }

    /// Identity within all documents.
    pub fn id(&self) -> (usize, u32) {
        self.key()
    }

    /// Its tag in the text.
    pub fn location(&self) -> Location {
        let range = self.node.range();
        let rest = self.file.text.text.as_bytes().get(range.clone()).unwrap_or_default();
        self.file.location(range.start..range.start + tag_length(rest))
    }

    /// Value of an attribute, marked as read.
    pub fn attribute(&self, name: &str) -> Option<&'d str> {
        let value = self.node.attribute(name)?;
        self.ledger.mark(self.key(), |mark| mark.attributes.push(name.to_owned()));
        Some(value)
    }

    /// Value of an attribute, not marked: for looking ahead.
    pub fn peek(&self, name: &str) -> Option<&'d str> {
        self.node.attribute(name)
    }

    /// An error at this element.
    pub fn error(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(&self.location(), message)
    }

    /// Its text, marked as read.
    pub fn text(&self) -> &'d str {
        self.ledger.mark(self.key(), |mark| mark.text = true);
        self.node.text().unwrap_or("").trim()
    }

    /// First child of that name, marked as read.
    pub fn child(&self, name: &str) -> Option<Self> {
        let node = self.node.children().find(|n| n.is_element() && n.tag_name().name() == name)?;
        Some(self.of(node).read())
    }

    /// All children of that name, marked as read.
    pub fn children(&self, name: &str) -> Vec<Self> {
        let all = self.node.children().filter(|n| n.is_element() && n.tag_name().name() == name);
        all.map(|node| self.of(node).read()).collect()
    }

    /// All children; those that the reader knows are marked by [`Element::keep`].
    pub fn elements(&self) -> Vec<Self> {
        self.node.children().filter(Node::is_element).map(|node| self.of(node)).collect()
    }

    /// Notes that it is read.
    pub fn keep(&self) {
        self.ledger.judge_place(self.key(), ElementStatus::Kept, "");
    }

    /// Notes that it is in the scene in another form.
    pub fn change(&self, words: &str) {
        self.ledger.judge_place(self.key(), ElementStatus::Changed, words);
    }

    /// As [`Element::change`], with a warning, too: the source is probably wrong.
    pub fn change_with_warning(&self, words: &str, findings: &mut Findings) {
        self.change(words);
        findings.warn(self.error(words));
    }

    /// Notes that it is not in the scene.
    pub fn drop(&self, words: &str) {
        self.ledger.judge_place(self.key(), ElementStatus::Dropped, words);
    }

    /// Numbers of an attribute, separated by white space.
    pub fn numbers(&self, name: &str) -> Result<Option<Vec<f64>>, Diagnostic> {
        self.attribute(name).map(|text| parse_numbers(text).map_err(|word| self.bad_number(name, &word))).transpose()
    }

    /// Number of an attribute.
    pub fn number(&self, name: &str) -> Result<Option<f64>, Diagnostic> {
        let Some(numbers) = self.numbers(name)? else { return Ok(None) };
        match numbers[..] {
            [x] => Ok(Some(x)),
            _ => Err(self.error(format!("`{name}` has {} numbers, expected one", numbers.len()))),
        }
    }

    /// Number of an attribute that may be infinite.
    pub fn number_or_infinite(&self, name: &str) -> Result<Option<f64>, Diagnostic> {
        let infinite =
            self.node.attribute(name).and_then(|text| text.trim().parse::<f64>().ok()).filter(|x| x.is_infinite());
        match infinite {
            Some(x) => {
                self.attribute(name);
                Ok(Some(x))
            }
            None => self.number(name),
        }
    }

    /// Three numbers of an attribute.
    pub fn vector(&self, name: &str) -> Result<Option<[f64; 3]>, Diagnostic> {
        let Some(numbers) = self.numbers(name)? else { return Ok(None) };
        let n = numbers.len();
        let three = <[f64; 3]>::try_from(numbers);
        three.map(Some).map_err(|_| self.error(format!("`{name}` has {n} numbers, expected three")))
    }

    /// Numbers of its text.
    pub fn text_numbers(&self) -> Result<Vec<f64>, Diagnostic> {
        parse_numbers(self.text()).map_err(|word| self.error(format!("`{word}` is not a number")))
    }

    fn bad_number(&self, name: &str, word: &str) -> Diagnostic {
        let diagnostic = self.error(format!("`{word}` in `{name}` is not a number"));
        if word.contains("${") { diagnostic.with_help("this is a xacro file: name it FILE.xacro") } else { diagnostic }
    }
}

/// Finite numbers in a text; the first word that is none.
pub(crate) fn parse_numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(word.to_owned()),
    };
    text.split_whitespace().map(number).collect()
}

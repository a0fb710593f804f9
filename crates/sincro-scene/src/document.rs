//! A TOML text as a JSON tree that remembers where everything was written.
//!
//! Positions are kept beside the tree, by JSON pointer (`/joint/0/spring/stiffness`), so that findings about structure
//! and findings about physics are placed alike. What JSON cannot hold (inf, nan, dates) is null in the tree and listed
//! beside it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};

/// A value of TOML that JSON cannot hold.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NonJson {
    /// `inf`, `-inf`, or a number too large.
    Infinite {
        /// Greater than zero.
        positive: bool,
    },
    /// `nan`.
    NotANumber,
    /// A date or time.
    Date,
    /// An integer beyond 64 bits.
    TooLarge,
}

/// Locations of an entry of a [`Document`] in its text.
#[derive(Clone, Debug)]
pub struct Place {
    /// Location of the key; `None` for elements of lists.
    pub key: Option<Location>,
    /// Location of the value.
    pub value: Location,
}

/// Parsed TOML text as a JSON tree that knows the location of every key and value, so that settings can be written into
/// it and messages point at the text. Entries are named by JSON pointers, such as `/joint/0/spring/stiffness`.
#[derive(Clone, Debug)]
pub struct Document {
    /// Text that was parsed.
    pub source: Arc<SourceText>,
    /// Content as JSON; always an object. Values that JSON cannot hold (infinite, not a number, dates) are null.
    pub root: Value,
    places: BTreeMap<String, Place>,
    odd: BTreeMap<String, NonJson>,
}

impl Document {
    /// Parses a TOML text.
    ///
    /// # Errors
    ///
    /// One error with its location for each place at which the text is no TOML.
    pub fn parse(source: &Arc<SourceText>) -> Result<Self, Diagnostics> {
        let (root, errors) = DeTable::parse_recoverable(&source.text);
        if !errors.is_empty() {
            return Err(Diagnostics(errors.iter().map(|e| syntax_diagnostic(source, e)).collect()).sorted());
        }
        let mut reader = Reader { source, shift: 0, places: BTreeMap::new(), odd: BTreeMap::new() };
        let content = reader.table(root.get_ref(), "");
        let whole = Location { source: source.clone(), span: 0..0 };
        reader.places.insert(String::new(), Place { key: None, value: whole });
        Ok(Self { source: source.clone(), root: content, places: reader.places, odd: reader.odd })
    }

    /// Returns the value at a JSON pointer such as `/joint/0/name`; `None` if there is none.
    #[must_use]
    pub fn get(&self, pointer: &str) -> Option<&Value> {
        self.root.pointer(pointer)
    }

    /// Returns the string at a JSON pointer; `None` if there is no value or it is no string.
    #[must_use]
    pub fn text(&self, pointer: &str) -> Option<&str> {
        self.get(pointer)?.as_str()
    }

    /// Returns the string at a JSON pointer with its location; `None` if there is no value or it is no string.
    #[must_use]
    pub fn located(&self, pointer: &str) -> Option<Located<String>> {
        Some(Located { value: self.text(pointer)?.to_owned(), at: self.at(pointer) })
    }

    /// Returns the location of the value at a JSON pointer; if it is absent, that of the nearest table or list around
    /// it.
    #[must_use]
    pub fn at(&self, pointer: &str) -> Location {
        let mut pointer = pointer;
        loop {
            if let Some(place) = self.places.get(pointer) {
                return place.value.clone();
            }
            pointer = pointer.rfind('/').map_or("", |end| &pointer[..end]);
        }
    }

    /// Location of the key at a pointer; of its value if it has no key.
    #[must_use]
    pub(crate) fn key_at(&self, pointer: &str) -> Location {
        match self.places.get(pointer) {
            Some(Place { key: Some(key), .. }) => key.clone(),
            _ => self.at(pointer),
        }
    }

    /// Location that stands for a table: the value of its `name`, or its first line.
    #[must_use]
    pub(crate) fn title_at(&self, pointer: &str) -> Location {
        self.places.get(&format!("{pointer}/name")).map_or_else(|| self.at(pointer), |place| place.value.clone())
    }

    /// Part of the value at a pointer that JSON cannot hold.
    #[must_use]
    pub(crate) fn non_json(&self, pointer: &str) -> Option<&NonJson> {
        self.odd.get(pointer)
    }

    /// Puts a value where another was or none was; the parent must be there. `value` is TOML written at `at`.
    pub(crate) fn put(&mut self, pointer: &str, key: &Location, value: &Spanned<DeValue<'_>>, at: &Location) {
        self.forget(pointer);
        let mut reader =
            Reader { source: &at.source, shift: at.span.start, places: BTreeMap::new(), odd: BTreeMap::new() };
        let content = reader.value(value, pointer, Some(key.clone()));
        self.places.append(&mut reader.places);
        self.odd.append(&mut reader.odd);
        self.insert(pointer, content);
    }

    /// Puts a value that no text stands for, such as a default that is about to be changed in part.
    pub(crate) fn put_silently(&mut self, pointer: &str, content: Value, at: &Location) {
        self.forget(pointer);
        self.places.insert(pointer.to_owned(), Place { key: Some(at.clone()), value: at.clone() });
        self.insert(pointer, content);
    }

    /// Adds an entry to a list that is there.
    pub(crate) fn push_silently(&mut self, list: &str, content: Value, at: &Location) {
        let Some(Value::Array(entries)) = self.root.pointer_mut(list) else { return };
        let pointer = format!("{list}/{}", entries.len());
        entries.push(content);
        self.places.insert(pointer, Place { key: None, value: at.clone() });
    }

    /// Puts a value in the place of another one, whose positions it takes.
    pub(crate) fn replace(&mut self, pointer: &str, content: Value) {
        let place = self.places.get(pointer).cloned();
        self.forget(pointer);
        if let Some(place) = place {
            self.places.insert(pointer.to_owned(), place);
        }
        self.insert(pointer, content);
    }

    /// Gives a key of a table another name; the new one must be free.
    pub(crate) fn rename(&mut self, pointer: &str, key: &str) {
        let (parent, last) = pointer.rsplit_once('/').expect("a pointer into a document starts with `/`");
        let new = format!("{parent}/{}", escape(key));
        let Some(Value::Object(table)) = self.root.pointer_mut(parent) else { return };
        let Some(value) = table.remove(&unescape(last)) else { return };
        table.insert(key.to_owned(), value);
        let (places, odd) = (inside(&self.places, pointer), inside(&self.odd, pointer));
        self.forget(pointer);
        self.places.extend(moved(places, pointer, &new));
        self.odd.extend(moved(odd, pointer, &new));
    }

    /// Takes a key out of a table.
    pub(crate) fn remove(&mut self, pointer: &str) -> Option<Value> {
        self.forget(pointer);
        let (parent, last) = pointer.rsplit_once('/')?;
        self.root.pointer_mut(parent)?.as_object_mut()?.remove(&unescape(last))
    }

    /// Adds an entry to the list at a pointer: that of another document, with its positions. The list is made if there
    /// is none.
    pub(crate) fn append_from(&mut self, list: &str, other: &Self, pointer: &str) -> String {
        if self.get(list).is_none() {
            self.insert(list, Value::Array(Vec::new()));
        }
        let content = other.get(pointer).cloned().unwrap_or(Value::Null);
        let Some(Value::Array(entries)) = self.root.pointer_mut(list) else { return String::new() };
        let new = format!("{list}/{}", entries.len());
        entries.push(content);
        self.places.extend(moved(inside(&other.places, pointer), pointer, &new));
        self.odd.extend(moved(inside(&other.odd, pointer), pointer, &new));
        new
    }

    /// Adds a key to a table: the value of another document, with its positions.
    pub(crate) fn copy_from(&mut self, pointer: &str, other: &Self, from: &str) {
        self.forget(pointer);
        let content = other.get(from).cloned().unwrap_or(Value::Null);
        self.places.extend(moved(inside(&other.places, from), from, pointer));
        self.odd.extend(moved(inside(&other.odd, from), from, pointer));
        self.insert(pointer, content);
    }

    fn insert(&mut self, pointer: &str, content: Value) {
        let (parent, last) = pointer.rsplit_once('/').expect("a pointer into a document starts with `/`");
        let last = unescape(last);
        match self.root.pointer_mut(parent) {
            Some(Value::Object(table)) => {
                table.insert(last, content);
            }
            Some(Value::Array(list)) => {
                let index: usize = last.parse().expect("an index into a list is a number");
                list[index] = content;
            }
            _ => unreachable!("`{parent}` is a table or a list"),
        }
    }

    fn forget(&mut self, pointer: &str) {
        for key in inside(&self.places, pointer).into_keys() {
            self.places.remove(&key);
        }
        for key in inside(&self.odd, pointer).into_keys() {
            self.odd.remove(&key);
        }
    }
}

/// Entries at a pointer and below.
fn inside<T: Clone>(all: &BTreeMap<String, T>, pointer: &str) -> BTreeMap<String, T> {
    let below = format!("{pointer}/");
    let own = all.get_key_value(pointer);
    let inner = all.range(below.clone()..).take_while(|(key, _)| key.starts_with(&below));
    own.into_iter().chain(inner).map(|(key, value)| (key.clone(), value.clone())).collect()
}

/// The same with what stands at `from` and below moved to `to`.
fn moved<T>(all: BTreeMap<String, T>, from: &str, to: &str) -> BTreeMap<String, T> {
    let below = format!("{from}/");
    let place = |key: String| match key.strip_prefix(from) {
        Some(rest) if key == from || key.starts_with(&below) => format!("{to}{rest}"),
        _ => key,
    };
    all.into_iter().map(|(key, value)| (place(key), value)).collect()
}

/// Escapes a key as a step of a JSON pointer: `~` becomes `~0` and `/` becomes `~1`.
#[must_use]
pub fn escape(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

/// A step of a JSON pointer as a key.
#[must_use]
pub(crate) fn unescape(step: &str) -> String {
    step.replace("~1", "/").replace("~0", "~")
}

fn syntax_diagnostic(source: &Arc<SourceText>, error: &toml::de::Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    Diagnostic::error(&Location { source: source.clone(), span }, error.message())
        .with_help("the file is TOML: https://toml.io/en/v1.1.0")
}

/// Turns TOML values into JSON, noting where they were.
struct Reader<'a> {
    source: &'a Arc<SourceText>,
    /// Start of the parsed text in the source.
    shift: usize,
    places: BTreeMap<String, Place>,
    odd: BTreeMap<String, NonJson>,
}

impl Reader<'_> {
    fn location(&self, span: &Range<usize>) -> Location {
        Location { source: self.source.clone(), span: span.start + self.shift..span.end + self.shift }
    }

    fn table(&mut self, table: &DeTable<'_>, pointer: &str) -> Value {
        let mut content = Map::new();
        for (key, value) in table {
            let name = key.get_ref().as_ref();
            let inner = format!("{pointer}/{}", escape(name));
            let key_at = self.location(&key.span());
            content.insert(name.to_owned(), self.value(value, &inner, Some(key_at)));
        }
        Value::Object(content)
    }

    fn value(&mut self, value: &Spanned<DeValue<'_>>, pointer: &str, key: Option<Location>) -> Value {
        let place = Place { key, value: self.location(&value.span()) };
        self.places.insert(pointer.to_owned(), place);
        match value.get_ref() {
            DeValue::String(text) => Value::String(text.clone().into_owned()),
            DeValue::Boolean(truth) => Value::Bool(*truth),
            DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
                Ok(number) => number.into(),
                Err(_) => self.non_json(pointer, NonJson::TooLarge),
            },
            DeValue::Float(digits) => self.float(digits.as_str(), pointer),
            DeValue::Datetime(_) => self.non_json(pointer, NonJson::Date),
            DeValue::Array(list) => {
                let items = list.iter().enumerate();
                items.map(|(k, item)| self.value(item, &format!("{pointer}/{k}"), None)).collect()
            }
            DeValue::Table(table) => self.table(table, pointer),
        }
    }

    fn float(&mut self, digits: &str, pointer: &str) -> Value {
        let number: f64 = digits.parse().unwrap_or(f64::NAN);
        if number.is_nan() {
            return self.non_json(pointer, NonJson::NotANumber);
        }
        match serde_json::Number::from_f64(number) {
            Some(number) => Value::Number(number),
            None => self.non_json(pointer, NonJson::Infinite { positive: number > 0.0 }),
        }
    }

    fn non_json(&mut self, pointer: &str, odd: NonJson) -> Value {
        self.odd.insert(pointer.to_owned(), odd);
        Value::Null
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Arc<SourceText> {
        Arc::new(SourceText { path: "a.toml".into(), text: text.into() })
    }

    #[test]
    fn every_key_and_value_knows_its_place() {
        let doc = Document::parse(&source("a = 1\n[[joint]]\nname = \"x\"\nlist = [1, 0x10]\n")).unwrap();
        assert_eq!(doc.get("/joint/0/list/1"), Some(&Value::from(16)));
        assert_eq!(doc.at("/joint/0/list/1").to_string(), "a.toml:4:12");
        assert_eq!(doc.key_at("/joint/0/list").to_string(), "a.toml:4:1");
        assert_eq!(doc.at("/joint/0").to_string(), "a.toml:2:1");
        assert_eq!(doc.at("/joint/0/absent/deep").to_string(), "a.toml:2:1");
        assert_eq!(doc.title_at("/joint/0").to_string(), "a.toml:3:8");
    }

    #[test]
    fn what_json_cannot_hold_is_kept_apart() {
        let doc =
            Document::parse(&source("a = [inf, -inf, nan, 1e999]\nd = 2020-01-01\ni = 99999999999999999999")).unwrap();
        assert_eq!(doc.get("/a/0"), Some(&Value::Null));
        assert_eq!(doc.non_json("/a/0"), Some(&NonJson::Infinite { positive: true }));
        assert_eq!(doc.non_json("/a/1"), Some(&NonJson::Infinite { positive: false }));
        assert_eq!(doc.non_json("/a/2"), Some(&NonJson::NotANumber));
        assert_eq!(doc.non_json("/a/3"), Some(&NonJson::Infinite { positive: true }));
        assert_eq!(doc.non_json("/d"), Some(&NonJson::Date));
        assert_eq!(doc.non_json("/i"), Some(&NonJson::TooLarge));
    }

    #[test]
    fn syntax_errors_are_all_reported() {
        let diagnostics = Document::parse(&source("a = \nb = 1\nb = 2\n[c\n")).unwrap_err();
        let places: Vec<_> = diagnostics.0.iter().map(|p| p.line_column().unwrap()).collect();
        assert!(places.len() >= 3, "{diagnostics}");
        assert_eq!(places[0].0, 1);
    }
}

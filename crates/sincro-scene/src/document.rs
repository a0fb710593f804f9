//! A TOML text as a JSON tree that remembers where everything was written.
//!
//! Positions are kept beside the tree, by JSON pointer (`/joint/0/spring/stiffness`), so that findings about structure
//! and findings about physics are placed alike. What JSON cannot hold (inf, nan, dates) is null in the tree and listed
//! in [`Document::odd`].

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};

/// A value of TOML that JSON cannot hold.
#[derive(Clone, Debug, PartialEq)]
pub enum NonJson {
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

/// Position of an entry in the text.
#[derive(Clone, Debug)]
pub struct Place {
    /// The key, none for elements of lists.
    pub key: Option<Location>,
    /// The value.
    pub value: Location,
}

/// A parsed TOML text that knows the place of every key and value.
#[derive(Clone, Debug)]
pub struct Document {
    /// The text.
    pub source: Arc<SourceText>,
    /// Its content; always a table.
    pub root: Value,
    places: BTreeMap<String, Place>,
    odd: BTreeMap<String, NonJson>,
}

impl Document {
    /// Reads a TOML text.
    ///
    /// # Errors
    ///
    /// Everything that is not TOML, with positions.
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

    /// The value at a JSON pointer.
    #[must_use]
    pub fn get(&self, pointer: &str) -> Option<&Value> {
        self.root.pointer(pointer)
    }

    /// The string at a JSON pointer.
    #[must_use]
    pub fn text(&self, pointer: &str) -> Option<&str> {
        self.get(pointer)?.as_str()
    }

    /// The string at a JSON pointer with its place.
    #[must_use]
    pub fn located(&self, pointer: &str) -> Option<Located<String>> {
        Some(Located { value: self.text(pointer)?.to_owned(), at: self.at(pointer) })
    }

    /// Location of the value at a pointer; if it is absent, of the nearest value around it.
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
    pub fn key_at(&self, pointer: &str) -> Location {
        match self.places.get(pointer) {
            Some(Place { key: Some(key), .. }) => key.clone(),
            _ => self.at(pointer),
        }
    }

    /// Location that stands for a table: the value of its `name`, or its first line.
    #[must_use]
    pub fn title_at(&self, pointer: &str) -> Location {
        self.places.get(&format!("{pointer}/name")).map_or_else(|| self.at(pointer), |place| place.value.clone())
    }

    /// Part of the value at a pointer that JSON cannot hold.
    #[must_use]
    pub fn non_json(&self, pointer: &str) -> Option<&NonJson> {
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
        let inside = format!("{pointer}/");
        let gone = |known: &str| known == pointer || known.starts_with(&inside);
        self.places.retain(|known, _| !gone(known));
        self.odd.retain(|known, _| !gone(known));
    }
}

/// A key as a step of a JSON pointer.
#[must_use]
pub fn escape(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

/// A step of a JSON pointer as a key.
#[must_use]
pub fn unescape(step: &str) -> String {
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

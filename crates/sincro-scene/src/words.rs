//! Words in the texts of files, by which a file names blocks and objects.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::document::Document;

/// Keys whose texts are for people, and `name`, which names the thing itself.
const SILENT: [&str; 3] = ["name", "title", "description"];

/// Words of all texts of some files: names of blocks and objects, and parts of patterns.
#[derive(Debug, Default)]
pub(crate) struct Words {
    /// The words.
    pub words: BTreeSet<String>,
    /// True if there is a pattern with `*` among the texts.
    pub has_pattern: bool,
}

impl Words {
    /// Words of the texts of `documents`.
    pub fn of<'a>(documents: impl IntoIterator<Item = &'a Document>) -> Self {
        let mut words = Self::default();
        documents.into_iter().for_each(|document| words.read(&document.root));
        words
    }

    fn read(&mut self, value: &Value) {
        match value {
            Value::String(text) => self.text(text),
            Value::Array(list) => list.iter().for_each(|value| self.read(value)),
            Value::Object(table) => {
                for (key, value) in table.iter().filter(|(key, _)| !SILENT.contains(&key.as_str())) {
                    // a key may be the path of a setting
                    if key.contains(['.', '/']) {
                        self.text(key);
                    }
                    self.read(value);
                }
            }
            _ => {}
        }
    }

    /// Adds the words of a text.
    pub fn text(&mut self, text: &str) {
        self.has_pattern |= text.contains('*');
        let is_of_name = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        self.words.extend(text.split(|c| !is_of_name(c)).filter(|word| !word.is_empty()).map(str::to_owned));
    }
}

/// Returns true if a word of some text of the file is `name`.
pub(crate) fn is_named(document: &Document, name: &str) -> bool {
    Words::of([document]).words.contains(name)
}

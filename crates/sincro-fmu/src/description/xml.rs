//! A writer of XML: elements with attributes, indented.

use std::fmt::Write;

/// Text of a document under way.
#[derive(Debug)]
pub(super) struct Xml {
    text: String,
    open: Vec<&'static str>,
}

/// An attribute; none is left out.
pub(super) type Attribute<'a> = (&'a str, Option<String>);

/// An attribute with a text.
pub(super) fn text(name: &str, value: impl Into<String>) -> Attribute<'_> {
    (name, Some(value.into()))
}

/// An attribute with a number, in the shortest form that gives the same bits.
pub(super) fn number(name: &str, value: f64) -> Attribute<'_> {
    (name, Some(format!("{value:?}")))
}

/// An attribute that is left out where it is false.
pub(super) fn flag(name: &str, value: bool) -> Attribute<'_> {
    (name, value.then(|| "true".to_owned()))
}

impl Xml {
    pub(super) fn new() -> Self {
        Self { text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".into(), open: Vec::new() }
    }

    fn tag(&mut self, name: &str, attributes: &[Attribute<'_>], end: &str) {
        let indent = "  ".repeat(self.open.len());
        let _ = write!(self.text, "{indent}<{name}");
        for (key, value) in attributes {
            if let Some(value) = value {
                let _ = write!(self.text, " {key}=\"{}\"", escaped(value));
            }
        }
        self.text.push_str(end);
    }

    /// An element with elements inside.
    pub(super) fn begin(&mut self, name: &'static str, attributes: &[Attribute<'_>]) {
        self.tag(name, attributes, ">\n");
        self.open.push(name);
    }

    /// Ends the innermost element.
    pub(super) fn end(&mut self) {
        let name = self.open.pop().expect("an element is open");
        let indent = "  ".repeat(self.open.len());
        let _ = writeln!(self.text, "{indent}</{name}>");
    }

    /// An element without content.
    pub(super) fn element(&mut self, name: &str, attributes: &[Attribute<'_>]) {
        self.tag(name, attributes, "/>\n");
    }

    pub(super) fn finish(self) -> String {
        assert!(self.open.is_empty(), "all elements are closed");
        self.text
    }
}

/// Text of an attribute; control characters, which XML cannot hold, become spaces.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

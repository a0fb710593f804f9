//! Protocol buffers, as far as recordings need them: messages described in text, as a descriptor that readers decode
//! with, and as bytes.
//!
//! Source of the wire format and of the descriptor's numbers: key `protobuf` (encoding; `descriptor.proto`).

use serde_json::Value;

/// Message type that the file does not define itself.
const TIMESTAMP: &str = ".google.protobuf.Timestamp";
const DURATION: &str = ".google.protobuf.Duration";

/// Messages of one package.
#[derive(Clone, Debug)]
pub(super) struct Package {
    name: String,
    messages: Vec<Message>,
}

#[derive(Clone, Debug)]
struct Message {
    name: String,
    fields: Vec<Field>,
    /// Names of an enumeration within it, with their values.
    choices: Vec<(String, u64)>,
}

#[derive(Clone, Debug)]
struct Field {
    number: u64,
    name: String,
    kind: Kind,
    is_repeated: bool,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Double,
    Fixed32,
    Bool,
    Text,
    Bytes,
    /// By the full name of its type.
    Enum(String),
    /// By the full name of its type.
    Message(String),
}

impl Package {
    /// Reads a definition with one statement a line.
    ///
    /// # Panics
    ///
    /// If the text, which is ours, is none.
    pub fn parse(text: &str) -> Self {
        let mut new = Self { name: String::new(), messages: Vec::new() };
        let mut is_enum = false;
        for line in text.lines().map(str::trim) {
            let words: Vec<&str> = line.trim_end_matches(';').split_whitespace().collect();
            match words.as_slice() {
                ["package", name] => (*name).clone_into(&mut new.name),
                ["message", name, "{"] => {
                    let name = (*name).to_owned();
                    new.messages.push(Message { name, fields: Vec::new(), choices: Vec::new() });
                }
                ["enum", "Type", "{"] => is_enum = true,
                ["}"] => is_enum = false,
                [name, "=", number] if is_enum => {
                    let choice = ((*name).to_owned(), number.parse().expect("a number"));
                    new.messages.last_mut().expect("within a message").choices.push(choice);
                }
                ["repeated", kind, name, "=", number] => new.field(kind, name, number, true),
                [kind, name, "=", number] if *kind != "syntax" => new.field(kind, name, number, false),
                _ => {}
            }
        }
        new
    }

    fn field(&mut self, kind: &str, name: &str, number: &str, is_repeated: bool) {
        let package = &self.name;
        let message = self.messages.last_mut().expect("within a message");
        let kind = match kind {
            "double" => Kind::Double,
            "fixed32" => Kind::Fixed32,
            "bool" => Kind::Bool,
            "string" => Kind::Text,
            "bytes" => Kind::Bytes,
            "Timestamp" => Kind::Message(TIMESTAMP.into()),
            "Duration" => Kind::Message(DURATION.into()),
            "Type" => Kind::Enum(format!(".{package}.{}.Type", message.name)),
            own => Kind::Message(format!(".{package}.{own}")),
        };
        let number = number.parse().expect("a number");
        message.fields.push(Field { number, name: name.to_owned(), kind, is_repeated });
    }

    /// One message of numbers.
    pub fn of_numbers(package: &str, name: &str, fields: impl Iterator<Item = String>) -> Self {
        let field = |(number, name)| Field { number, name, kind: Kind::Double, is_repeated: false };
        let fields = (1..).zip(fields).map(field).collect();
        let message = Message { name: name.to_owned(), fields, choices: Vec::new() };
        Self { name: package.to_owned(), messages: vec![message] }
    }

    /// Set of file descriptors with which readers decode.
    pub fn descriptor(&self) -> Vec<u8> {
        let mut set = Vec::new();
        for (name, of) in [("timestamp", "Timestamp"), ("duration", "Duration")] {
            let mut file = Vec::new();
            text(&mut file, 1, &format!("google/protobuf/{name}.proto"));
            text(&mut file, 2, "google.protobuf");
            let mut message = Vec::new();
            text(&mut message, 1, of);
            // int64 and int32
            for (number, (field, kind)) in (1..).zip([("seconds", 3), ("nanos", 5)]) {
                part(&mut message, 2, &descriptor_of_field(field, number, (1, kind), None));
            }
            part(&mut file, 4, &message);
            text(&mut file, 12, "proto3");
            part(&mut set, 1, &file);
        }
        let mut file = Vec::new();
        text(&mut file, 1, &format!("{}.proto", self.name));
        text(&mut file, 2, &self.name);
        text(&mut file, 3, "google/protobuf/timestamp.proto");
        text(&mut file, 3, "google/protobuf/duration.proto");
        self.messages.iter().for_each(|message| part(&mut file, 4, &message.descriptor()));
        text(&mut file, 12, "proto3");
        part(&mut set, 1, &file);
        set
    }

    /// Bytes of a message of this package from an object with its fields; times have `sec` and `nsec`.
    pub fn encode(&self, name: &str, value: &Value) -> Vec<u8> {
        let message = self.messages.iter().find(|m| m.name == name).expect("messages are of this package");
        let mut out = Vec::new();
        for field in &message.fields {
            match value.get(&field.name) {
                None => {}
                Some(Value::Array(list)) if field.kind == Kind::Fixed32 => {
                    let numbers = list.iter().filter_map(Value::as_u64);
                    let packed: Vec<u8> = numbers.flat_map(|n| (n as u32).to_le_bytes()).collect();
                    part(&mut out, field.number, &packed);
                }
                Some(Value::Array(list)) => list.iter().for_each(|entry| self.one(&mut out, field, entry)),
                Some(one) => self.one(&mut out, field, one),
            }
        }
        out
    }

    fn one(&self, out: &mut Vec<u8>, field: &Field, value: &Value) {
        match &field.kind {
            Kind::Double => double(out, field.number, value.as_f64().unwrap_or(f64::NAN)),
            Kind::Bool => number(out, field.number, u64::from(value.as_bool().unwrap_or(false))),
            Kind::Enum(_) => number(out, field.number, value.as_u64().unwrap_or(0)),
            Kind::Text => text(out, field.number, value.as_str().unwrap_or("")),
            Kind::Bytes | Kind::Fixed32 => unreachable!("no message of ours has one"),
            Kind::Message(of) if of == TIMESTAMP || of == DURATION => {
                let mut time = Vec::new();
                number(&mut time, 1, value["sec"].as_u64().unwrap_or(0));
                number(&mut time, 2, value["nsec"].as_u64().unwrap_or(0));
                part(out, field.number, &time);
            }
            Kind::Message(of) => {
                let name = of.rsplit('.').next().expect("a name");
                part(out, field.number, &self.encode(name, value));
            }
        }
    }
}

/// Bytes of a message of numbers, in the order of its fields.
pub(super) fn numbers(values: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut out = Vec::new();
    (1..).zip(values).for_each(|(k, value)| double(&mut out, k, value));
    out
}

impl Message {
    fn descriptor(&self) -> Vec<u8> {
        let mut out = Vec::new();
        text(&mut out, 1, &self.name);
        for field in &self.fields {
            let (kind, of) = match &field.kind {
                Kind::Double => (1, None),
                Kind::Fixed32 => (7, None),
                Kind::Bool => (8, None),
                Kind::Text => (9, None),
                Kind::Message(of) => (11, Some(of)),
                Kind::Bytes => (12, None),
                Kind::Enum(of) => (14, Some(of)),
            };
            let label = if field.is_repeated { 3 } else { 1 };
            part(&mut out, 2, &descriptor_of_field(&field.name, field.number, (label, kind), of));
        }
        if !self.choices.is_empty() {
            let mut of = Vec::new();
            text(&mut of, 1, "Type");
            for (name, value) in &self.choices {
                let mut choice = Vec::new();
                text(&mut choice, 1, name);
                number(&mut choice, 2, *value);
                part(&mut of, 2, &choice);
            }
            part(&mut out, 4, &of);
        }
        out
    }
}

fn descriptor_of_field(name: &str, at: u64, (label, kind): (u64, u64), of: Option<&String>) -> Vec<u8> {
    let mut out = Vec::new();
    text(&mut out, 1, name);
    number(&mut out, 3, at);
    number(&mut out, 4, label);
    number(&mut out, 5, kind);
    of.iter().for_each(|of| text(&mut out, 6, of));
    out
}

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn number(out: &mut Vec<u8>, field: u64, value: u64) {
    varint(out, field << 3);
    varint(out, value);
}

fn double(out: &mut Vec<u8>, field: u64, value: f64) {
    varint(out, field << 3 | 1);
    out.extend(value.to_le_bytes());
}

fn part(out: &mut Vec<u8>, field: u64, bytes: &[u8]) {
    varint(out, field << 3 | 2);
    varint(out, bytes.len() as u64);
    out.extend_from_slice(bytes);
}

fn text(out: &mut Vec<u8>, field: u64, text: &str) {
    part(out, field, text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_the_encoding_guide() {
        let mut out = Vec::new();
        number(&mut out, 1, 150);
        text(&mut out, 2, "testing");
        assert_eq!(out, [0x08, 0x96, 0x01, 0x12, 0x07, 0x74, 0x65, 0x73, 0x74, 0x69, 0x6e, 0x67]);
    }

    #[test]
    fn a_definition_is_read_whole() {
        let package = Package::parse(super::super::FOXGLOVE);
        let of = |name: &str| package.messages.iter().find(|m| m.name == name).unwrap();
        assert_eq!((package.name.as_str(), package.messages.len()), ("foxglove", 19));
        assert_eq!(of("SceneEntity").fields.len(), 14);
        assert_eq!(of("LinePrimitive").choices.len(), 3);
        let triangles = package.encode("TriangleListPrimitive", &serde_json::json!({ "indices": [1, 2] }));
        assert_eq!(triangles, [5 << 3 | 2, 8, 1, 0, 0, 0, 2, 0, 0, 0]);
    }
}

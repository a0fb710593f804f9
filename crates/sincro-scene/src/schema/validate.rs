//! Walks a document against its schema and reports everything at once, each finding where it stands.
//!
//! It knows the part of JSON Schema that the generator writes: types, ranges, lengths, enumerations, required and
//! unknown keys, and tables in which one of several keys is given.

use serde_json::{Map, Value};

use super::describe::{self, expected, found};
use super::{alternatives, exclusive_keys, property, property_names};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Document, NonJson, escape, unescape};
use crate::suggest::{self, quoted};
use crate::vocabulary::{self, SUFFIXES, unit_of_suffix, unit_suffix};

/// Units that keys may carry as a suffix, wherever they come from.
const UNITS: [&str; 14] =
    ["_deg", "_rad", "_rpm", "_deg_s", "_rad_s", "_hz", "_ms", "_us", "_mm", "_cm", "_m", "_s", "_kg", "_g"];

/// Validates a document against the schema of its kind of file and returns everything that does not fit, each at its
/// location, in the order of the text; empty if it is valid.
pub fn validate(document: &Document, schema: &Value) -> Diagnostics {
    let mut walker = Walker { document, root: schema, diagnostics: Diagnostics::new() };
    walker.value("", &document.root, schema);
    walker.diagnostics.sorted()
}

struct Walker<'a> {
    document: &'a Document,
    root: &'a Value,
    diagnostics: Diagnostics,
}

impl<'a> Walker<'a> {
    fn value(&mut self, pointer: &str, value: &Value, schema: &'a Value) {
        let choices = alternatives(self.root, schema);
        if choices.is_empty() {
            return; // `true`: anything goes
        }
        if value.is_null() && self.may_be_infinite(pointer, schema) {
            return;
        }
        let Some(choice) = choices.into_iter().find(|choice| type_fits(choice, value)) else {
            return self.mismatch(pointer, value, schema);
        };
        match value {
            Value::Number(number) => self.range(pointer, number.as_f64().unwrap_or(f64::NAN), schema, choice),
            Value::String(text) => self.text(pointer, text, schema, choice),
            Value::Array(list) => self.list(pointer, list, schema, choice),
            Value::Object(table) => self.table(pointer, table, choice),
            Value::Null | Value::Bool(_) => {}
        }
    }

    fn may_be_infinite(&self, pointer: &str, schema: &Value) -> bool {
        let allowed = schema.get("x-infinite").is_some_and(|x| *x == Value::Bool(true));
        allowed && self.document.non_json(pointer) == Some(&NonJson::Infinite { positive: true })
    }

    fn mismatch(&mut self, pointer: &str, value: &Value, schema: &Value) {
        let found = found(value, self.document.non_json(pointer));
        let expected = match self.document.non_json(pointer) {
            Some(NonJson::Infinite { .. } | NonJson::NotANumber) => {
                expected(self.root, schema).replacen("a number", "a finite number", 1)
            }
            _ => expected(self.root, schema),
        };
        let message = format!("`{}` is {found}, expected {expected}", shown(pointer));
        self.error_at_value(pointer, message, self.help_of(schema));
    }

    fn range(&mut self, pointer: &str, x: f64, outer: &Value, choice: &Map<String, Value>) {
        // a limit may stand beside the reference or choice, or in the type itself
        let limit = |key: &str| outer.get(key).or_else(|| choice.get(key)).and_then(Value::as_f64);
        let wanted = match (limit("exclusiveMinimum"), limit("minimum")) {
            (Some(low), _) if x <= low => format!("greater than {low}"),
            (_, Some(low)) if x < low => format!("at least {low}"),
            _ => return,
        };
        let expected = expected(self.root, outer);
        let message = format!("`{}` is {x}, expected {expected}, {wanted}", shown(pointer));
        self.error_at_value(pointer, message, self.help_of(outer));
    }

    fn text(&mut self, pointer: &str, text: &str, schema: &Value, choice: &Map<String, Value>) {
        let Some(words) = describe::words(choice) else { return };
        if !words.contains(&text) {
            let near = suggest::nearest(text, words.iter().copied()).or_else(|| vocabulary::near_word(text, &words));
            let help = near.map_or_else(|| self.help_of(schema), |near| Some(format!("did you mean `{near}`?")));
            let message = format!("`{}` is {text:?}, expected one of {}", shown(pointer), quoted(&words));
            self.error_at_value(pointer, message, help);
        }
    }

    fn list(&mut self, pointer: &str, list: &[Value], schema: &'a Value, choice: &'a Map<String, Value>) {
        let length = |key: &str| choice.get(key).or_else(|| schema.get(key)).and_then(Value::as_u64);
        let n = list.len() as u64;
        if length("minItems").is_some_and(|min| n < min) || length("maxItems").is_some_and(|max| n > max) {
            let message = match describe::fixed_length(choice) {
                Some(_) => format!("`{}` has {n} entries, expected {}", shown(pointer), expected(self.root, schema)),
                None => format!("`{}` is empty, expected at least one entry", shown(pointer)),
            };
            self.error_at_value(pointer, message, self.help_of(schema));
        }
        let Some(items) = choice.get("items") else { return };
        for (k, item) in list.iter().enumerate() {
            self.value(&format!("{pointer}/{k}"), item, items);
        }
    }

    fn table(&mut self, pointer: &str, table: &Map<String, Value>, choice: &'a Map<String, Value>) {
        for (key, value) in table {
            let inner = format!("{pointer}/{}", escape(key));
            match property(choice, key) {
                Some(schema) => self.value(&inner, value, schema),
                None => self.unknown_key(&inner, key, choice),
            }
        }
        for key in choice.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str) {
            if !table.contains_key(key) {
                let of = property(choice, key).map(|schema| describe::description(self.root, schema));
                self.missing(pointer, &format!("`{key}` is missing"), of.map(|d| format!("`{key}`: {d}")));
            }
        }
        let together = choice.get("allOf").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_object);
        for rule in std::iter::once(choice).chain(together) {
            self.exclusive(pointer, table, rule);
        }
    }

    /// Exactly one of several keys (`oneOf`), or not two at once (`not`).
    fn exclusive(&mut self, pointer: &str, table: &Map<String, Value>, rule: &Map<String, Value>) {
        if let Some(keys) = rule.get("oneOf").and_then(exclusive_keys) {
            let given: Vec<&str> = keys.iter().copied().filter(|k| table.contains_key(*k)).collect();
            // a misspelt one has been reported as an unknown key
            let misspelt = table.keys().any(|k| suggest::nearest(k, keys.iter().copied()).is_some());
            if given.is_empty() && !misspelt {
                self.missing(pointer, &format!("one of {} is missing", quoted(&keys)), None);
            } else if given.len() > 1 {
                self.too_many(pointer, &given);
            }
        }
        let forbidden = rule.get("not").and_then(|n| n.get("required")).and_then(Value::as_array);
        let forbidden: Vec<&str> = forbidden.into_iter().flatten().filter_map(Value::as_str).collect();
        if !forbidden.is_empty() && forbidden.iter().all(|k| table.contains_key(*k)) {
            self.too_many(pointer, &forbidden);
        }
    }

    fn too_many(&mut self, pointer: &str, given: &[&str]) {
        let at = self.document.key_at(&format!("{pointer}/{}", given[1]));
        let message = format!("{} exclude each other", quoted(given).replacen(", ", " and ", given.len()));
        self.diagnostics.push(Diagnostic::error(&at, message).with_help("leave all but one out"));
    }

    fn missing(&mut self, pointer: &str, what: &str, help: Option<String>) {
        let at = self.document.title_at(pointer);
        let message = match owner(self.document, pointer) {
            Some(owner) => format!("{what} in {owner}"),
            None => what.to_owned(),
        };
        let diagnostic = Diagnostic::error(&at, message);
        self.diagnostics.push(match help {
            Some(help) => diagnostic.with_help(help),
            None => diagnostic,
        });
    }

    fn unknown_key(&mut self, pointer: &str, key: &str, choice: &Map<String, Value>) {
        let parent = &pointer[..pointer.rfind('/').unwrap_or(0)];
        let message = match owner(self.document, parent) {
            Some(owner) => format!("unknown key `{key}` in {owner}"),
            None => format!("unknown key `{key}`"),
        };
        let diagnostic = Diagnostic::error(&self.document.key_at(pointer), message);
        self.diagnostics.push(diagnostic.with_help(self.help_for_key(key, choice)));
    }

    /// Advice on an unknown key. A key of another unit is never offered as the same thing.
    fn help_for_key(&self, key: &str, choice: &Map<String, Value>) -> String {
        let known = property_names(choice);
        if let Some(advice) = vocabulary::advice(key, &known) {
            return advice.to_owned();
        }
        if let Some(near) = self.near_with_suffix(key, choice) {
            return format!("did you mean `{near}`?");
        }
        if let Some(near) = self.near_to_suffixed(key, choice) {
            return format!("did you mean `{near}`?");
        }
        let suffix = |key: &str| UNITS.iter().find(|unit| key.ends_with(**unit)).copied();
        let near = suggest::nearest(key, known.iter().copied()).filter(|near| suffix(near) != suffix(key));
        let Some(near) = near else { return suggest::help(key, &known, "keys here") };
        let of_key = property(choice, near).map(|schema| describe::description(self.root, schema)).unwrap_or_default();
        let unit = describe::units(of_key).join(" or ");
        if unit.is_empty() { format!("there is `{near}`") } else { format!("there is `{near}`, in {unit}") }
    }

    /// The key near to one with the suffix of a unit, with that suffix, if it may have it: `position_deg` for
    /// `positon_deg`.
    fn near_with_suffix(&self, key: &str, choice: &Map<String, Value>) -> Option<String> {
        let (plain, suffix) = unit_suffix(key)?;
        let near = suggest::nearest(plain, property_names(choice))?;
        let units = describe::units(describe::description(self.root, property(choice, near)?));
        units.contains(&unit_of_suffix(suffix)).then(|| format!("{near}{suffix}"))
    }

    /// The key with the suffix of a unit that it may have, if that is nearer than all keys: `position_deg` for
    /// `position_dg`.
    fn near_to_suffixed(&self, key: &str, choice: &Map<String, Value>) -> Option<String> {
        if unit_suffix(key).is_some() {
            return None;
        }
        let known = property_names(choice);
        let with_suffix = |name: &&str| -> Vec<String> {
            let schema = property(choice, name).expect("it is one of its properties");
            let units = describe::units(describe::description(self.root, schema));
            let fitting = SUFFIXES.iter().filter(|(_, unit, ..)| units.contains(unit));
            fitting.map(|(suffix, ..)| format!("{name}{suffix}")).collect()
        };
        let variants: Vec<String> = known.iter().flat_map(with_suffix).collect();
        let all = known.iter().copied().chain(variants.iter().map(String::as_str));
        suggest::nearest(key, all).and_then(|near| variants.iter().find(|v| *v == near).cloned())
    }

    fn help_of(&self, schema: &Value) -> Option<String> {
        let description = describe::description(self.root, schema);
        (!description.is_empty()).then(|| description.to_owned())
    }

    fn error_at_value(&mut self, pointer: &str, message: String, help: Option<String>) {
        let diagnostic = Diagnostic::error(&self.document.at(pointer), message);
        self.diagnostics.push(match help {
            Some(help) => diagnostic.with_help(help),
            None => diagnostic,
        });
    }
}

fn type_fits(choice: &Map<String, Value>, value: &Value) -> bool {
    let type_name = choice.get("type").and_then(Value::as_str);
    match value {
        Value::Null => false,
        Value::Bool(_) => type_name == Some("boolean"),
        Value::Number(n) => type_name == Some("number") || (type_name == Some("integer") && !n.is_f64()),
        Value::String(_) => type_name == Some("string") || describe::words(choice).is_some(),
        Value::Array(_) => type_name == Some("array"),
        Value::Object(_) => type_name == Some("object"),
    }
}

/// Last steps of a pointer as a user would write them: `mass`, `axis[1]`.
fn shown(pointer: &str) -> String {
    let steps: Vec<String> = pointer.split('/').skip(1).map(unescape).collect();
    let first = steps.iter().rposition(|s| s.parse::<usize>().is_err()).unwrap_or(0);
    let mut text = steps.get(first).cloned().unwrap_or_default();
    for index in steps.iter().skip(first + 1) {
        text.push_str(&format!("[{index}]"));
    }
    text
}

/// The table at `pointer` in words, such as "joint `shoulder`" or "`spring`"; none for the whole file.
fn owner(document: &Document, pointer: &str) -> Option<String> {
    if pointer.is_empty() {
        return None;
    }
    let name = document.text(&format!("{pointer}/name"));
    let kind = pointer.split('/').rev().find(|step| step.parse::<usize>().is_err()).unwrap_or("");
    Some(match name {
        Some(name) => format!("{kind} `{name}`"),
        None => format!("`{}`", shown(pointer)),
    })
}

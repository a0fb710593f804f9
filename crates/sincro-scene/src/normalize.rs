//! Documents as people write them, rewritten into what the schema knows: units in the name of a key, formulas in the
//! place of numbers, and other names of keys and words.
//!
//! | written | read as |
//! |---|---|
//! | `position_deg = 30` | `position = 0.5235987755982988`, where the unit of `position` is rad |
//! | `velocity_rpm = 60`, `velocity_deg_s = 360` | `velocity = 6.283185307179586`, where its unit is rad/s |
//! | `mass = "2*m"` | the value of the formula, with the parameters of the experiment |
//! | `ixx = 1`, `kind = "hinge"` | `xx = 1`, `kind = "revolute"` |
//!
//! A document is rewritten after settings and before validation; positions stay those of what was written.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use serde_json::{Map, Value};
use sincro_math::expression::Expression;

use crate::diagnostic::{Diagnostic, Diagnostics, SourceText};
use crate::document::{Document, escape};
use crate::schema::describe::{description, units, words};
use crate::schema::{FORMAT, alternatives, property};
use crate::suggest;
use crate::vocabulary::{self, SUFFIXES, unit_suffix};

/// Parameters of an experiment, for formulas in its files: name and value.
pub type Parameters = BTreeMap<String, f64>;

/// Keys of signals that are values; times and rates of change are not in degrees.
const SIGNAL_VALUES: [&str; 9] = ["constant", "from", "to", "slope", "amplitude", "offset", "low", "high", "values"];

/// Rewrites a document for its schema; notes formulas that cannot be computed and units that a key does not have.
pub(crate) fn normalize(document: &mut Document, schema: &Value, parameters: &Parameters) -> Diagnostics {
    let mut walker = Walker { document, root: schema, parameters, diagnostics: Diagnostics::new(), edits: Vec::new() };
    walker.value("", schema);
    walker.diagnostics
}

/// As [`normalize`], of the object at `pointer` in one of the document's lists alone.
pub(crate) fn normalize_object(
    document: &mut Document,
    schema: &Value,
    pointer: &str,
    parameters: &Parameters,
) -> Diagnostics {
    let list = pointer.split('/').nth(1).unwrap_or("");
    let mut walker = Walker { document, root: schema, parameters, diagnostics: Diagnostics::new(), edits: Vec::new() };
    walker.value(pointer, &schema["properties"][list]["items"]);
    walker.diagnostics
}

/// Converts the text of a file to the present format: outdated names of keys and words are replaced by those of
/// `schema`, and `format` stands at its head. Comments, spaces and all else stay. `schema` is the one of that kind of
/// file, such as [`scene_schema`](crate::scene::scene_schema).
///
/// # Errors
///
/// Diagnostics at their places: the text is no TOML, or is of a newer format.
pub fn convert(source: &Arc<SourceText>, schema: &Value) -> Result<String, Diagnostics> {
    let mut document = Document::parse(source)?;
    if let Some(newer) = newer_format(&document) {
        return Err(newer.into());
    }
    let format = document.get("/format").map(|_| document.at("/format").span);
    let parameters = parameters_of(&document);
    let mut walker = Walker {
        document: &mut document,
        root: schema,
        parameters: &parameters,
        diagnostics: Diagnostics::new(),
        edits: Vec::new(),
    };
    walker.value("", schema);
    let mut edits = walker.edits;
    match format {
        Some(span) => edits.push((span, FORMAT.to_string())),
        None => {
            let at = head_of(&source.text);
            edits.push((at..at, format!("format = {FORMAT}\n")));
        }
    }
    edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = source.text.clone();
    for (span, new) in edits {
        text.replace_range(span, &new);
    }
    Ok(text)
}

/// First byte behind the comments that a text begins with.
fn head_of(text: &str) -> usize {
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        if !line.starts_with('#') {
            break;
        }
        at += line.len();
    }
    at
}

/// The finding about a file of a newer format.
pub(crate) fn newer_format(document: &Document) -> Option<Diagnostic> {
    let format = document.get("/format").and_then(Value::as_u64).filter(|format| *format > FORMAT)?;
    let message = format!("the file has format {format}, this program reads up to {FORMAT}");
    Some(Diagnostic::error(&document.at("/format"), message).with_help("use a newer sincro"))
}

/// The parameters of an experiment; formulas among them may use the others. What cannot be computed is left out: the
/// formula is noted where the document is rewritten.
pub(crate) fn parameters_of(document: &Document) -> Parameters {
    let mut known = Parameters::new();
    let Some(table) = document.get("/parameters").and_then(Value::as_object) else { return known };
    // each round computes at least one more, or nothing can be computed any more
    for _ in 0..table.len() {
        let before = known.len();
        for (name, value) in table {
            let number = match value {
                Value::Number(number) => number.as_f64(),
                Value::String(text) if !known.contains_key(name) => compute(text, &known).ok(),
                _ => None,
            };
            known.extend(number.map(|x| (name.clone(), x)));
        }
        if known.len() == before {
            break;
        }
    }
    known
}

/// The value of a formula.
pub(crate) fn compute(text: &str, parameters: &Parameters) -> Result<f64, String> {
    let names: Vec<&str> = parameters.keys().map(String::as_str).collect();
    let values: Vec<f64> = parameters.values().copied().collect();
    let formula = Expression::parse(text, &names).map_err(|e| e.to_string())?;
    let value = formula.eval(&values, &mut formula.scratch());
    if value.is_finite() { Ok(value) } else { Err("its value is not finite".into()) }
}

struct Walker<'a> {
    document: &'a mut Document,
    root: &'a Value,
    parameters: &'a Parameters,
    diagnostics: Diagnostics,
    /// Words of the schema in the place of others: bytes of the text, and what they become.
    edits: Vec<(Range<usize>, String)>,
}

impl<'a> Walker<'a> {
    fn value(&mut self, pointer: &str, schema: &'a Value) {
        let choices = alternatives(self.root, schema);
        let of_type =
            |name: &str| choices.iter().copied().find(|c| c.get("type").and_then(Value::as_str) == Some(name));
        match self.document.get(pointer) {
            Some(Value::String(text)) => {
                let text = text.clone();
                self.text(pointer, &text, &choices);
            }
            Some(Value::Array(list)) => {
                let n = list.len();
                let Some(items) = of_type("array").and_then(|choice| choice.get("items")) else { return };
                for k in 0..n {
                    self.value(&format!("{pointer}/{k}"), items);
                }
            }
            Some(Value::Object(_)) => {
                if let Some(choice) = of_type("object") {
                    self.table(pointer, choice);
                }
            }
            _ => {}
        }
    }

    /// A formula where numbers stand and no strings, or another word for one of a list.
    fn text(&mut self, pointer: &str, text: &str, choices: &[&'a Map<String, Value>]) {
        let is = |name: &str| choices.iter().any(|c| c.get("type").and_then(Value::as_str) == Some(name));
        if let Some(known) = choices.iter().find_map(|choice| words(choice)) {
            let meant = vocabulary::words(text).find(|word| known.contains(word));
            if let Some(meant) = meant.filter(|_| !known.contains(&text)) {
                self.edits.push((self.document.at(pointer).span, format!("\"{meant}\"")));
                self.document.replace(pointer, Value::String(meant.into()));
            }
        } else if (is("number") || is("integer")) && !is("string") {
            match compute(text, self.parameters) {
                Ok(value) if is("number") => self.document.replace(pointer, value.into()),
                Ok(value) if value.fract() == 0.0 && value.abs() < 9e15 => {
                    self.document.replace(pointer, (value as i64).into());
                }
                Ok(value) => self.refuse(pointer, &format!("`{text}` is {value}, not a whole number"), ""),
                Err(why) => {
                    let names: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
                    let help = if names.is_empty() {
                        "a number, or a formula such as \"pi/6\"; [parameters] of the experiment give it names".into()
                    } else {
                        suggest::help(text, &names, "a number, or a formula of the parameters")
                    };
                    // the key of the list, for an entry of one
                    let key = pointer.rsplit('/').find(|step| step.parse::<usize>().is_err()).unwrap_or("");
                    self.refuse(pointer, &format!("`{key}`: `{text}` is not a number: {why}"), &help);
                }
            }
        }
    }

    fn table(&mut self, pointer: &str, choice: &'a Map<String, Value>) {
        let keys: Vec<String> = match self.document.get(pointer) {
            Some(Value::Object(table)) => table.keys().cloned().collect(),
            _ => return,
        };
        for key in keys {
            let inner = format!("{pointer}/{}", escape(&key));
            if let Some(schema) = property(choice, &key) {
                self.value(&inner, schema);
                continue;
            }
            if let Some((plain, suffix)) = unit_suffix(&key)
                && let Some(schema) = property(choice, plain)
            {
                self.with_unit(pointer, &inner, &key, (plain, suffix), schema);
                continue;
            }
            let Some(meant) = vocabulary::key(&key) else { continue };
            let Some(schema) = property(choice, meant) else { continue };
            let target = format!("{pointer}/{}", escape(meant));
            if self.document.get(&target).is_none() {
                self.edits.push((self.document.key_at(&inner).span, meant.to_owned()));
                self.document.rename(&inner, meant);
                self.value(&target, schema);
            }
        }
    }

    /// A key with the suffix of another unit.
    fn with_unit(&mut self, pointer: &str, inner: &str, key: &str, (plain, suffix): (&str, &str), schema: &'a Value) {
        let target = format!("{pointer}/{}", escape(plain));
        let text = description(self.root, schema);
        let wanted = SUFFIXES.iter().find(|(known, ..)| *known == suffix);
        let Some((_, unit, factor)) = wanted else { return };
        let units = units(text);
        let is_signal = alternatives(self.root, schema).iter().any(|c| c.get("oneOf").is_some());
        let is_command = units.is_empty() && is_signal && plain == "command";
        if !units.contains(unit) && !is_command {
            let has = if units.is_empty() { "no unit".to_owned() } else { format!("the unit {}", units.join(" or ")) };
            let message = format!("`{key}`: `{plain}` has {has}, not that of the suffix `{suffix}`");
            return self.refuse_key(
                inner,
                &message,
                "`_deg` is for angles [rad], `_rpm` and `_deg_s` for speeds [rad/s]",
            );
        }
        if let Some(kind) = self.kind_without_angle(pointer) {
            let message = format!("`{key}` has no meaning for a {kind} joint: its coordinates are not all angles");
            return self.refuse_key(inner, &message, &format!("give `{plain}` in {}", units.join(" or ")));
        }
        if self.document.get(&target).is_some() {
            let message = format!("`{plain}` and `{key}` say the same thing");
            return self.refuse_key(inner, &message, "leave one of them out");
        }
        self.document.rename(inner, plain);
        self.value(&target, schema);
        self.scale(&target, *factor);
    }

    /// The kind of the joint that a table belongs to, if some of its coordinates are no angles.
    fn kind_without_angle(&self, pointer: &str) -> Option<&'static str> {
        let mut steps = pointer.split('/').skip(1);
        let (list, index) = (steps.next()?, steps.next()?);
        let kind = self.document.text(&format!("/{list}/{index}/kind")).filter(|_| list == "joint")?;
        let meant = vocabulary::words(kind).find(|word| *word == "prismatic" || *word == "free").unwrap_or(kind);
        ["prismatic", "free", "ball", "planar", "fixed"].into_iter().find(|known| *known == meant)
    }

    /// Multiplies a number, the numbers of a list, or the values of a signal.
    fn scale(&mut self, pointer: &str, factor: f64) {
        match self.document.get(pointer) {
            Some(Value::Number(number)) => {
                let scaled = number.as_f64().unwrap_or(f64::NAN) * factor;
                self.document.replace(pointer, scaled.into());
            }
            Some(Value::Array(list)) => (0..list.len()).for_each(|k| self.scale(&format!("{pointer}/{k}"), factor)),
            Some(Value::Object(table)) => {
                let mut keys: Vec<String> = table.keys().cloned().collect();
                let signals = ["constant", "step", "ramp", "sine", "pulse", "table"];
                if pointer.ends_with("/pulse") && !table.contains_key("high") {
                    // its default is 1, in the unit of the suffix
                    let at = self.document.at(pointer);
                    self.document.put_silently(&format!("{pointer}/high"), 1.0.into(), &at);
                    keys.push("high".into());
                }
                let is_kind = keys.iter().any(|key| signals.contains(&key.as_str()));
                keys.retain(|key| is_kind || SIGNAL_VALUES.contains(&key.as_str()));
                if keys.iter().any(|key| key == "values") || self.document.get(&format!("{pointer}/file")).is_none() {
                    keys.iter().for_each(|key| self.scale(&format!("{pointer}/{}", escape(key)), factor));
                } else {
                    let message = "a table of a file has the unit of the file".to_owned();
                    self.refuse(pointer, &message, "give the key without suffix, and `scale` in the table");
                }
            }
            _ => {}
        }
    }

    fn refuse(&mut self, pointer: &str, message: &str, help: &str) {
        let diagnostic = Diagnostic::error(&self.document.at(pointer), message);
        self.diagnostics.push(if help.is_empty() { diagnostic } else { diagnostic.with_help(help) });
        // validated no further
        self.document.replace(pointer, 1.0.into());
    }

    fn refuse_key(&mut self, pointer: &str, message: &str, help: &str) {
        self.diagnostics.push(Diagnostic::error(&self.document.key_at(pointer), message).with_help(help));
        self.document.remove(pointer);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::experiment_schema;
    use crate::scene::scene_schema;
    use crate::schema::validate;

    fn source(text: &str) -> Arc<SourceText> {
        Arc::new(SourceText { path: "a.toml".into(), text: text.into() })
    }

    fn scene(text: &str, parameters: &[(&str, f64)]) -> (Document, String) {
        let mut document = Document::parse(&source(text)).unwrap();
        let parameters = parameters.iter().map(|(name, x)| ((*name).to_owned(), *x)).collect();
        let mut found = normalize(&mut document, scene_schema(), &parameters);
        found.merge(validate(&document, scene_schema()));
        (document, found.to_string())
    }

    #[test]
    fn units_formulas_and_words_are_understood() {
        let text = "[[joint]]\nname = \"j\"\nkind = \"hinge\"\ninitial = { position_deg = 180, velocity_rpm = \"30*k\" }\n\
                    motor = { mode = \"position\", kp = \"2*k\", command_deg = { step = { time = 1.0, to = 90 } } }\n";
        let (document, found) = scene(text, &[("k", 2.0)]);
        assert_eq!(found, "");
        let number = |pointer: &str| document.get(pointer).unwrap().as_f64().unwrap();
        let pi = std::f64::consts::PI;
        assert_eq!(document.text("/joint/0/kind"), Some("revolute"));
        assert!((number("/joint/0/initial/position") - pi).abs() < 1e-15);
        assert!((number("/joint/0/initial/velocity") - 2.0 * pi).abs() < 1e-15);
        assert!((number("/joint/0/motor/command/step/to") - pi / 2.0).abs() < 1e-15);
        assert_eq!((number("/joint/0/motor/command/step/time"), number("/joint/0/motor/kp")), (1.0, 4.0));
        assert_eq!(document.at("/joint/0/initial/position").to_string(), "a.toml:4:28");
    }

    #[test]
    fn degrees_are_refused_where_nothing_turns() {
        let (_, found) = scene("[[joint]]\nname = \"j\"\nkind = \"slide\"\ninitial = { position_deg = 3 }\n", &[]);
        assert!(found.contains("`position_deg` has no meaning for a prismatic joint"), "{found}");
        let (_, found) = scene("[[body]]\nname = \"b\"\nmass_deg = 3\n", &[]);
        assert!(found.contains("`mass_deg`: `mass` has the unit kg, not that of the suffix `_deg`"), "{found}");
        let text = "[[joint]]\nname = \"j\"\nkind = \"revolute\"\ninitial = { position_deg = 3, position = 0.1 }\n";
        assert!(scene(text, &[]).1.contains("`position` and `position_deg` say the same thing"));
    }

    #[test]
    fn a_suggestion_never_changes_the_unit() {
        let (_, found) = scene("[[body]]\nname = \"b\"\nmass_g = 300\n", &[]);
        assert!(found.contains("help: there is `mass`, in kg") && !found.contains("did you mean"), "{found}");
        let (_, found) = scene("[[frame]]\nname = \"b\"\nrotation = [0, 0, 1.57]\n", &[]);
        assert!(found.contains("help: write `rotation_deg = [roll, pitch, yaw]`, in degrees"), "{found}");
    }

    #[test]
    fn a_formula_that_cannot_be_computed_names_what_it_lacks() {
        let (_, found) = scene("[[body]]\nname = \"b\"\nmass = \"2*k\"\n", &[("kp", 1.0)]);
        assert!(found.contains("`2*k` is not a number") && found.contains("`kp`"), "{found}");
        let (_, found) = scene("[[body]]\nname = \"b\"\nposition = [0, \"2*k\", 0]\n", &[]);
        assert!(found.contains("`position`: `2*k` is not a number"), "{found}");
    }

    #[test]
    fn converting_keeps_comments_and_replaces_words() {
        let text = "#:schema x\n# a robot\n\n[[joint]]\nname = \"j\"\nkind = \"hinge\" # turns\n\n[[body]]\nname = \"b\"\n\
                    mass = 1.0\ninertia = { ixx = 0.1, iyy = 0.1, izz = 0.1 }\n";
        let converted = convert(&source(text), scene_schema()).unwrap();
        assert_eq!(
            converted,
            "#:schema x\n# a robot\nformat = 2\n\n[[joint]]\nname = \"j\"\nkind = \"revolute\" # turns\n\n[[body]]\n\
             name = \"b\"\nmass = 1.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n"
        );
        assert_eq!(convert(&source(&converted), scene_schema()).unwrap(), converted);
        let found = convert(&source("format = 3\n"), experiment_schema()).unwrap_err().to_string();
        assert!(found.contains("the file has format 3, this program reads up to 2"), "{found}");
    }
}

//! Short names, vectors and wildcards in the place of whole paths.
//!
//! | written | meant |
//! |---|---|
//! | `/hinge1`, `elbow` | the one object whose path ends so: `/base/arm/hinge1` |
//! | `elbow.position` | the signal of that object |
//! | `/base/tip.position` | a vector: its components `.x`, `.y`, `.z` |
//! | `/rotor*.speed` | all signals of that form; `*` stands for any characters within one name, `**` for any at all |
//!
//! A whole path always means itself, a pattern the objects of that form below `/`, and only if there are none those
//! deeper down: `/rotor*` may stand for `/air/quadrotor/rotor1` and its siblings. A short name that several objects
//! share is refused, with all of them.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::document::Document;
use crate::tree::{self, join};

/// Keys of a scene whose values are paths of objects.
const PATH_KEYS: [&str; 8] = ["parent", "object", "joint", "between", "through", "joints", "with", "frame"];

/// Result of looking for a short name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Match<'a> {
    /// Nothing ends so.
    None,
    /// The only one.
    One(&'a str),
    /// Several do.
    Several(Vec<&'a str>),
}

/// Looks for the only path that ends in `/short`; a leading `/` of the short name is not counted.
pub(crate) fn ending<'a>(short: &str, known: impl IntoIterator<Item = &'a str>) -> Match<'a> {
    let tail = short.strip_prefix('/').unwrap_or(short);
    if tail.is_empty() {
        return Match::None;
    }
    let ends = |path: &&str| path.strip_suffix(tail).is_some_and(|head| head.ends_with('/'));
    let mut found: Vec<&str> = known.into_iter().filter(ends).collect();
    found.dedup();
    match found[..] {
        [] => Match::None,
        [one] => Match::One(one),
        _ => Match::Several(found),
    }
}

/// Returns true if a name has the form of a pattern: `*` stands for any characters but `/` and `.`, `**` for any.
pub(crate) fn fits(pattern: &str, name: &str) -> bool {
    let Some(star) = pattern.find('*') else { return pattern == name };
    let (head, rest) = pattern.split_at(star);
    let Some(tail) = name.strip_prefix(head) else { return false };
    let (rest, is_any) = match rest.strip_prefix("**") {
        Some(rest) => (rest, true),
        None => (&rest[1..], false),
    };
    let stops = tail.char_indices().find(|(_, c)| !is_any && matches!(c, '/' | '.')).map_or(tail.len(), |(k, _)| k);
    let mut ends = tail.char_indices().map(|(k, _)| k).chain([tail.len()]).take_while(|end| *end <= stops);
    ends.any(|end| fits(rest, &tail[end..]))
}

/// The pattern as a short name, whose objects may be anywhere; a leading `/` is not counted.
pub(crate) fn anywhere(pattern: &str) -> String {
    format!("**/{}", pattern.strip_prefix('/').unwrap_or(pattern))
}

/// Replaces short names of parents and other objects by whole paths. What is not found is left for the checks of the
/// scene.
pub(crate) fn resolve_objects(document: &mut Document) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    resolve_parents(document);
    let objects: BTreeSet<String> = tree::raw_objects(document).into_iter().map(|o| o.path).collect();
    let mut places = Vec::new();
    collect("", &document.root, &mut places);
    for (pointer, text) in places {
        if text == "/" || objects.contains(&text) {
            continue;
        }
        match ending(&text, objects.iter().map(String::as_str)) {
            Match::One(path) => document.replace(&pointer, Value::String(path.to_owned())),
            Match::Several(all) => diagnostics.push(ambiguous(&document.at(&pointer), &text, &all)),
            Match::None => {}
        }
    }
    diagnostics
}

/// The finding about a short name that several things share.
pub(crate) fn ambiguous(at: &Location, short: &str, all: &[&str]) -> Diagnostic {
    let list: Vec<String> = all.iter().take(8).map(|path| format!("`{path}`")).collect();
    let more = if all.len() > 8 { format!(" and {} more", all.len() - 8) } else { String::new() };
    Diagnostic::error(at, format!("`{short}` may mean {}{more}", list.join(", "))).with_help("write the whole path")
}

/// Strings below keys that hold paths, with their pointers.
pub(crate) fn collect(pointer: &str, value: &Value, places: &mut Vec<(String, String)>) {
    match value {
        Value::Object(table) => {
            for (key, inner) in table {
                let below = format!("{pointer}/{}", crate::document::escape(key));
                let is_path = PATH_KEYS.contains(&key.as_str());
                match inner {
                    Value::String(text) if is_path => places.push((below, text.clone())),
                    Value::Array(list) if is_path && list.iter().all(Value::is_string) => {
                        let texts = list.iter().filter_map(Value::as_str).enumerate();
                        places.extend(texts.map(|(k, text)| (format!("{below}/{k}"), text.to_owned())));
                    }
                    _ => collect(&below, inner, places),
                }
            }
        }
        Value::Array(list) => {
            for (k, inner) in list.iter().enumerate() {
                collect(&format!("{pointer}/{k}"), inner, places);
            }
        }
        _ => {}
    }
}

/// Objects that hang on the world so far.
#[derive(Default)]
struct Placed {
    paths: BTreeSet<String>,
    /// Whole paths by their last component.
    by_name: BTreeMap<String, Vec<String>>,
    /// Objects that wait for a parent of this path: name and place in the document.
    waiting: BTreeMap<String, Vec<(String, String)>>,
}

impl Placed {
    /// Places an object with all that waits for it.
    fn place(&mut self, path: String) {
        let mut stack = vec![path];
        while let Some(path) = stack.pop() {
            for (name, _) in self.waiting.remove(&path).unwrap_or_default() {
                stack.push(join(&path, &name));
            }
            self.by_name.entry(last(&path).to_owned()).or_default().push(path.clone());
            self.paths.insert(path);
        }
    }
}

fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or("")
}

/// Whole paths of parents that are given by short names: an object's path depends on its parent's, so that the tree is
/// walked from the world outwards.
fn resolve_parents(document: &mut Document) {
    let mut placed = Placed::default();
    let mut roots = Vec::new();
    for kind in tree::KINDS {
        let list = document.root.get(kind).and_then(Value::as_array);
        for (k, object) in list.into_iter().flatten().enumerate() {
            let Some(name) = object.get("name").and_then(Value::as_str) else { continue };
            let parent = object.get("parent").and_then(Value::as_str).unwrap_or("/");
            if parent == "/" {
                roots.push(join("/", name));
            } else {
                let list = placed.waiting.entry(parent.to_owned()).or_default();
                list.push((name.to_owned(), format!("/{kind}/{k}")));
            }
        }
    }
    roots.into_iter().for_each(|path| placed.place(path));
    loop {
        // a short name counts only if no object that is still to be placed may be meant as well
        let names: BTreeSet<String> = placed.waiting.values().flatten().map(|(name, _)| name.clone()).collect();
        let found = placed.waiting.keys().find_map(|parent| {
            let known = placed.by_name.get(last(parent)).filter(|_| !names.contains(last(parent)))?;
            match ending(parent, known.iter().map(String::as_str)) {
                Match::One(path) => Some((parent.clone(), path.to_owned())),
                _ => None,
            }
        });
        let Some((short, path)) = found else { break };
        for (name, pointer) in placed.waiting.remove(&short).unwrap_or_default() {
            document.replace(&format!("{pointer}/parent"), Value::String(path.clone()));
            placed.place(join(&path, &name));
        }
    }
}

/// Names of the components of a vector, if a name is one.
fn components<'a>(name: &str, known: &'a [String]) -> Vec<&'a str> {
    let of = |suffixes: &[&str]| -> Vec<&'a str> {
        let one = |suffix: &&str| known.iter().map(String::as_str).find(|k| k.strip_prefix(name) == Some(suffix));
        suffixes.iter().map_while(one).collect()
    };
    let sets: [&[&str]; 3] = [&[".w", ".x", ".y", ".z"], &[".x", ".y", ".z"], &[".roll", ".pitch", ".yaw"]];
    let named = sets.iter().map(|set| (set.len(), of(set))).find(|(n, found)| *n == found.len());
    if let Some((_, found)) = named {
        return found;
    }
    let is_index = |rest: &str| {
        let digits = rest.strip_prefix('[').and_then(|r| r.strip_suffix(']')).or_else(|| rest.strip_prefix('.'));
        digits.is_some_and(|d| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit()))
    };
    known.iter().map(String::as_str).filter(|k| k.strip_prefix(name).is_some_and(is_index)).collect()
}

/// Signals that are meant by a name: itself, a vector's components, all that have the form of a pattern, or the one
/// that a short name means. Empty if nothing is known of it.
fn meant<'a>(name: &str, known: &'a [String]) -> Meant<'a> {
    if let Some(same) = known.iter().find(|k| *k == name) {
        return Meant::These(vec![same]);
    }
    if name.contains('*') {
        let of = |pattern: &str| -> Vec<&str> {
            let whole: Vec<&str> = known.iter().map(String::as_str).filter(|k| fits(pattern, k)).collect();
            if !whole.is_empty() {
                return whole;
            }
            let of_vector = |k: &&str| k.rsplit_once('.').is_some_and(|(stem, _)| fits(pattern, stem));
            known.iter().map(String::as_str).filter(of_vector).collect()
        };
        let whole = of(name);
        return Meant::These(if whole.is_empty() { of(&anywhere(name)) } else { whole });
    }
    let whole = components(name, known);
    if !whole.is_empty() {
        return Meant::These(whole);
    }
    let Some((object, what)) = name.split_once('.') else { return Meant::These(Vec::new()) };
    let stems: BTreeSet<&str> = known.iter().filter_map(|k| Some(k.split_once('.')?.0)).collect();
    match ending(object, stems) {
        Match::None => Meant::These(Vec::new()),
        Match::Several(all) => Meant::Several(all.into_iter().map(str::to_owned).collect()),
        Match::One(path) => {
            let full = format!("{path}.{what}");
            match known.iter().find(|k| **k == full) {
                Some(same) => Meant::These(vec![same]),
                None => Meant::These(components(&full, known)),
            }
        }
    }
}

/// Signals that are meant by a name.
enum Meant<'a> {
    These(Vec<&'a str>),
    /// Objects that the short name may mean.
    Several(Vec<String>),
}

/// Replaces short names, vectors and wildcards of an experiment by names of signals. `known` are those of the scene;
/// what begins with the name of one of the `blocks` of the diagram is left to the diagram.
pub(crate) fn resolve_signals(document: &mut Document, known: &[String], blocks: &[String]) -> Diagnostics {
    let mut resolver = Resolver { document, known, blocks, diagnostics: Diagnostics::new() };
    resolver.list("/record", true);
    resolver.checks("/check");
    resolver.checks("/sweep/check");
    for k in 0..resolver.length("/variant") {
        resolver.checks(&format!("/variant/{k}/check"));
    }
    for k in 0..resolver.length("/stop_when") {
        resolver.one(&format!("/stop_when/{k}/signal"));
    }
    for k in 0..resolver.length("/plot") {
        let is_path = resolver.document.text(&format!("/plot/{k}/kind")) == Some("path");
        resolver.list(&format!("/plot/{k}/signals"), !is_path);
    }
    resolver.values("/task/signals");
    for k in 0..resolver.length("/task/random") {
        resolver.one(&format!("/task/random/{k}/signal"));
    }
    for k in 0..resolver.length("/task/action") {
        resolver.one(&format!("/task/action/{k}/command"));
    }
    resolver.diagnostics
}

struct Resolver<'a> {
    document: &'a mut Document,
    known: &'a [String],
    blocks: &'a [String],
    diagnostics: Diagnostics,
}

impl Resolver<'_> {
    fn length(&self, pointer: &str) -> usize {
        self.document.get(pointer).and_then(Value::as_array).map_or(0, Vec::len)
    }

    fn checks(&mut self, list: &str) {
        for k in 0..self.length(list) {
            self.one(&format!("{list}/{k}/signal"));
            self.values(&format!("{list}/{k}/signals"));
        }
    }

    /// A table whose values are names.
    fn values(&mut self, table: &str) {
        let found = self.document.get(table).and_then(Value::as_object);
        let keys: Vec<String> = found.into_iter().flatten().map(|(key, _)| key.clone()).collect();
        for key in keys {
            self.one(&format!("{table}/{}", crate::document::escape(&key)));
        }
    }

    /// A name where one signal stands.
    fn one(&mut self, pointer: &str) {
        let Some(text) = self.document.text(pointer).map(str::to_owned) else { return };
        match self.signals(&text) {
            Some(Meant::These(found)) if found.len() == 1 => {
                let name = found[0].to_owned();
                self.document.replace(pointer, Value::String(name));
            }
            Some(Meant::Several(all)) => self.refuse(pointer, &text, &all),
            _ => {}
        }
    }

    /// A list of names; vectors and patterns become several.
    fn list(&mut self, pointer: &str, with_vectors: bool) {
        let Some(Value::Array(list)) = self.document.get(pointer) else { return };
        if !list.iter().all(Value::is_string) {
            return;
        }
        let texts: Vec<String> = list.iter().filter_map(Value::as_str).map(str::to_owned).collect();
        let mut entries: Vec<(String, Location, bool)> = Vec::new();
        for (k, text) in texts.iter().enumerate() {
            let inner = format!("{pointer}/{k}");
            let at = self.document.at(&inner);
            // `NAME:SIGNAL` is the signal of a variant
            let (variant, name) = match text.split_once(':') {
                Some((variant, name)) => (format!("{variant}:"), name),
                None => (String::new(), text.as_str()),
            };
            match self.signals(name) {
                Some(Meant::These(found)) if !found.is_empty() && (with_vectors || found.len() == 1) => {
                    let is_alone = found.len() == 1;
                    entries.extend(found.into_iter().map(|name| (format!("{variant}{name}"), at.clone(), is_alone)));
                }
                // a path in space is named by its vector
                Some(Meant::These(found)) if !found.is_empty() => {
                    let stem = found[0].strip_suffix(".x").unwrap_or(name);
                    entries.push((format!("{variant}{stem}"), at, true));
                }
                Some(Meant::Several(all)) => {
                    self.refuse(&inner, text, &all);
                    entries.push((text.clone(), at, true));
                }
                _ => entries.push((text.clone(), at, true)),
            }
        }
        // what a pattern finds beside what is named itself is not there twice
        let alone: Vec<String> = entries.iter().filter(|(.., alone)| *alone).map(|(name, ..)| name.clone()).collect();
        let mut seen = BTreeSet::new();
        entries.retain(|(name, _, is_alone)| *is_alone || (!alone.contains(name) && seen.insert(name.clone())));
        let names = entries.iter().map(|(name, ..)| Value::String(name.clone())).collect();
        self.document.replace(pointer, Value::Array(names));
        for (k, (name, at, _)) in entries.into_iter().enumerate() {
            self.document.put_silently(&format!("{pointer}/{k}"), Value::String(name), &at);
        }
    }

    /// Signals of the scene that a name means; none if it is the diagram's.
    fn signals(&self, name: &str) -> Option<Meant<'_>> {
        let first = name.split(['.', '/', '[']).next().unwrap_or("");
        let is_block = !name.starts_with('/') && self.blocks.iter().any(|block| block == first);
        (!is_block).then(|| meant(name, self.known))
    }

    fn refuse(&mut self, pointer: &str, text: &str, all: &[String]) {
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        self.diagnostics.push(ambiguous(&self.document.at(pointer), text, &all));
    }
}

/// Known name nearest to a path: the last component counts most, then that of the object.
pub(crate) fn nearest_path<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let parts = |text: &str| -> (String, String) {
        let (object, what) = match text.split_once('.') {
            Some((object, what)) => (object.to_lowercase(), what.to_lowercase()),
            None => (text.to_lowercase(), String::new()),
        };
        (object.rsplit('/').next().unwrap_or("").to_owned(), what)
    };
    let wanted = parts(name);
    let score = |k: &str| {
        let (object, what) = parts(k);
        let last = if wanted.1.is_empty() && what.is_empty() { 1.0 } else { strsim::jaro_winkler(&wanted.1, &what) };
        let of_object = strsim::jaro_winkler(&wanted.0, &object);
        let whole = strsim::jaro_winkler(name, k);
        (last > 0.8 && of_object > 0.75).then_some(2.0 * last + 2.0 * of_object + 0.5 * whole)
    };
    let scored = known.into_iter().filter_map(|k| Some((score(k)?, k)));
    scored.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::SourceText;
    use std::sync::Arc;

    fn document(text: &str) -> Document {
        Document::parse(&Arc::new(SourceText { path: "a.toml".into(), text: text.into() })).unwrap()
    }

    #[test]
    fn stars_stay_within_one_name() {
        assert!(fits("/rotor*.speed", "/rotor12.speed") && fits("/air/*/tip.*", "/air/arm/tip.x"));
        assert!(!fits("/rotor*.speed", "/rotor/hub.speed") && fits("/rotor**.speed", "/rotor/hub.speed"));
        assert!(fits("**/tip.x", "/a/b/tip.x") && !fits("/a*", "/b"));
    }

    #[test]
    fn patterns_are_short_names_where_nothing_below_the_root_has_their_form() {
        let known = ["/air/rotor1.speed", "/air/rotor2.speed", "/arm/tip.x", "/tip.x"].map(str::to_owned);
        let found = |pattern: &str| match meant(pattern, &known) {
            Meant::These(found) => found.join(" "),
            Meant::Several(_) => unreachable!("patterns mean all"),
        };
        assert_eq!(found("/rotor*.speed"), "/air/rotor1.speed /air/rotor2.speed");
        assert_eq!(found("rotor*.speed"), found("/rotor*.speed"));
        assert_eq!(found("/t*.x"), "/tip.x");
        assert_eq!(found("**/t*.x"), "/arm/tip.x /tip.x");
        assert_eq!(found("/wheel*.speed"), "");
    }

    #[test]
    fn parents_may_be_short_in_any_order() {
        let mut document = document(
            "[[body]]\nname = \"hand\"\nparent = \"elbow\"\n[[joint]]\nname = \"elbow\"\nparent = \"/upper\"\n\
             [[body]]\nname = \"upper\"\nparent = \"/shoulder\"\n[[joint]]\nname = \"shoulder\"\n",
        );
        assert!(!resolve_objects(&mut document).any_error());
        assert_eq!(document.text("/body/0/parent"), Some("/shoulder/upper/elbow"));
        assert_eq!(document.text("/joint/0/parent"), Some("/shoulder/upper"));
    }

    #[test]
    fn a_short_name_of_two_objects_is_refused_with_both() {
        let text = "[[joint]]\nname = \"a\"\n[[joint]]\nname = \"b\"\n[[body]]\nname = \"tip\"\nparent = \"/a\"\n\
                    [[body]]\nname = \"tip\"\nparent = \"/b\"\n[[closure]]\nname = \"c\"\nbetween = [\"tip\", \"/\"]\n";
        let found = resolve_objects(&mut document(text)).to_string();
        assert!(found.contains("a.toml:13:12: error: `tip` may mean `/a/tip`, `/b/tip`"), "{found}");
    }

    #[test]
    fn vectors_and_patterns_become_signals() {
        let known: Vec<String> =
            ["/a/tip.position.x", "/a/tip.position.y", "/a/tip.position.z", "/j1.speed", "/j2.speed"]
                .map(String::from)
                .into();
        let mut document = document("record = [\"tip.position\", \"/j*.speed\", \"/j1.speed\"]\n");
        assert!(!resolve_signals(&mut document, &known, &[]).any_error());
        let names: Vec<&str> =
            document.get("/record").unwrap().as_array().unwrap().iter().filter_map(Value::as_str).collect();
        assert_eq!(names, ["/a/tip.position.x", "/a/tip.position.y", "/a/tip.position.z", "/j2.speed", "/j1.speed"]);
        let mut short = super::tests::document("record = [\"j*.speed\", \"*ip.position\"]\n");
        resolve_signals(&mut short, &known, &[]);
        assert_eq!(short.get("/record").unwrap().as_array().unwrap().len(), 5);
        assert_eq!(document.at("/record/1").to_string(), "a.toml:1:11");
    }

    #[test]
    fn the_last_component_decides_what_is_near() {
        let known = ["/upper/elbow.position", "/upper/elbow.velocity", "/upper/shoulder.velocity"];
        assert_eq!(nearest_path("/elbow.velocty", known), Some("/upper/elbow.velocity"));
        assert_eq!(nearest_path("/mass.total", known), None);
    }
}

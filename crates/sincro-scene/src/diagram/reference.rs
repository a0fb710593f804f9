//! The reference of all blocks, from what they say of themselves: `docs/blocks.md` and `sincro blocks`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::{Category, Kind, Parameter, ValueKind};
use sincro_blocks::library;
use sincro_blocks::reader::{NoFiles, Reader, Value};
use sincro_dynamics::model::Model;

use super::robot;

/// Returns the descriptions of all kinds of blocks, category by category; for help texts.
#[must_use]
pub fn kinds() -> Vec<&'static Kind> {
    let of_library = library::all().map(|item| item.kind);
    let mut kinds: Vec<&'static Kind> = of_library.chain(robot::all().map(|item| item.kind)).collect();
    kinds.sort_by_key(|kind| kind.category);
    kinds
}

/// Returns the block reference `docs/blocks.md` as Markdown: a section for each category, in it one for each block.
#[must_use]
pub fn reference() -> String {
    let mut text = String::from(
        "# The blocks\n\nGenerated from the blocks themselves; `sincro blocks NAME` prints the same. How diagrams are written stands in \
         [diagrams.md](diagrams.md).\n\nEvery block also takes `unit` and, but for those of the continuous category, `sample_time`. Wherever a number stands, a formula of the parameters may \
         stand in quotes. Most blocks work component by component: their inputs and parameters are single numbers, which then stand for all \
         components, or vectors of one length.\n",
    );
    let mut category: Option<Category> = None;
    for kind in kinds() {
        if category != Some(kind.category) {
            category = Some(kind.category);
            let _ = write!(text, "\n## {}\n", kind.category.title());
        }
        text.push_str(&section(kind));
    }
    text
}

fn section(kind: &'static Kind) -> String {
    let mut text = format!("\n### {}\n\n{}\n\n`{}`\n", kind.name, kind.summary, kind.equation);
    if let Some((inputs, outputs)) = ports(kind) {
        let _ = write!(text, "\nInputs: {inputs}. Outputs: {outputs}.\n");
    }
    if !kind.parameters.is_empty() {
        text.push_str("\n| parameter | takes | meaning | default |\n|---|---|---|---|\n");
        for p in kind.parameters {
            let default = default(p)
                .map_or_else(|| "must be given".into(), |d| if d.is_empty() { "—".into() } else { format!("`{d}`") });
            let meaning = p.meaning().replace('|', "\\|");
            let _ = writeln!(text, "| `{}` | {} | {meaning} | {default} |", p.name, takes(p.takes));
        }
    }
    text
}

/// Returns the reference of one kind of block as plain text for the terminal, with an example for a diagram file.
#[must_use]
pub fn page(kind: &'static Kind) -> String {
    let mut text = format!("{} ({})\n  {}\n  {}\n", kind.name, kind.category.title(), kind.summary, kind.equation);
    if let Some((inputs, outputs)) = ports(kind) {
        let _ = write!(text, "ports\n  inputs: {}\n  outputs: {}\n", inputs.replace('`', ""), outputs.replace('`', ""));
    }
    text.push_str("parameters\n");
    let width = kind.parameters.iter().map(|p| p.name.len()).chain(["sample_time".len()]).max().unwrap_or(0);
    for p in kind.parameters {
        let default = match default(p).as_deref() {
            None => ", must be given".to_owned(),
            Some("") => String::new(),
            Some(default) => format!(", default {default}"),
        };
        let _ = writeln!(text, "  {:<width$}  {}: {}{default}", p.name, takes(p.takes), p.meaning());
    }
    if kind.category != Category::Continuous {
        let _ =
            writeln!(text, "  {:<width$}  number: time between two samples, a multiple of the step [s]", "sample_time");
    }
    let _ = writeln!(
        text,
        "  {:<width$}  text, or a list of one for each component: unit of its outputs, such as N·m",
        "unit"
    );
    let _ = write!(text, "example\n{}", example(kind));
    text
}

/// A block as it stands in a file, with what must be given.
fn example(kind: &Kind) -> String {
    let mut text = format!("  [[block]]\n  name = \"{}1\"\n  type = \"{}\"\n", kind.name.replace('-', "_"), kind.name);
    for p in kind.parameters.iter().filter(|p| p.default.is_none()) {
        let _ = writeln!(text, "  {} = {}", p.name, written(p));
    }
    text
}

/// Something that a parameter could be.
fn written(parameter: &Parameter) -> String {
    match parameter.takes {
        ValueKind::Choice(words) => format!("\"{}\"", words[0]),
        ValueKind::Number | ValueKind::Positive | ValueKind::Numbers => "1.0".into(),
        ValueKind::Count => "1".into(),
        ValueKind::Matrix => "[[1.0]]".into(),
        ValueKind::Flag => "true".into(),
        ValueKind::Text => "\"…\"".into(),
        ValueKind::Texts => "[\"…\"]".into(),
        ValueKind::Names | ValueKind::NumberLists => "{ x = 1.0 }".into(),
        ValueKind::File => "\"table.csv\"".into(),
    }
}

/// Names of inputs and outputs with as few parameters as can be given; none where that does not say it.
fn ports(kind: &'static Kind) -> Option<(String, String)> {
    let template = least(kind)?;
    let ports = template.ports();
    let list = |names: &[String]| match names {
        [] => "none".to_owned(),
        names => names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", "),
    };
    Some((list(&ports.inputs), list(&ports.outputs)))
}

/// The block with as few parameters as it needs.
fn least(kind: &'static Kind) -> Option<Box<dyn DynBlock>> {
    let value = |p: &Parameter| match p.takes {
        ValueKind::Choice(words) => Value::from(words[0]),
        ValueKind::Flag => Value::Flag(true),
        ValueKind::Text | ValueKind::File => Value::from("u"),
        ValueKind::Texts => vec!["u"].into(),
        ValueKind::Names | ValueKind::NumberLists => Value::Table(Vec::new()),
        ValueKind::Matrix => Value::List(vec![vec![1.0].into()]),
        _ => Value::Number(1.0),
    };
    let required = kind.parameters.iter().filter(|p| p.default.is_none());
    let mut given: BTreeMap<String, Value> = required.map(|p| (p.name.to_owned(), value(p))).collect();
    // where one of several must be given
    let pair = || Value::from(vec![0.0, 1.0]);
    let more: Vec<(&str, Value)> = match kind.name {
        "sine" => vec![("frequency_hz", 1.0.into())],
        "table" => vec![("times", pair()), ("values", pair())],
        "expression" => vec![("expression", "u".into())],
        "lua" => vec![("code", "function output(t, u, memory) return u.u end".into())],
        "lookup-table" => vec![("breakpoints", pair()), ("values", pair())],
        _ => Vec::new(),
    };
    given.extend(more.into_iter().map(|(key, value)| (key.to_owned(), value)));
    let scope = BTreeMap::new();
    let mut reader = Reader::new(kind, &given, &scope, &NoFiles);
    let template = match library::find(kind.name) {
        Some(item) => (item.read)(&mut reader),
        None => {
            let context = robot::Context { parser: None, fmus: None, model: Arc::new(one_joint()?) };
            (robot::find(kind.name)?.read)(&mut reader, &context)
        }
    };
    // a frame that is not there does not change the ports; anything else may
    (reader.finish().is_empty() || matches!(kind.category, Category::Robot | Category::Scripts)).then_some(template)
}

/// A model for blocks that need one.
fn one_joint() -> Option<Model<f64>> {
    let text = "joint = [{ name = \"j\", kind = \"revolute\" }]\n\
                body = [{ name = \"b\", parent = \"/j\", mass = 1, inertia = { xx = 1, yy = 1, zz = 1 } }]";
    let scene = crate::scene::from_text(text).ok()?;
    Some((*scene.model).clone())
}

/// The default as it is shown; empty if it means that nothing is given, none if the parameter must be given.
fn default(parameter: &Parameter) -> Option<String> {
    parameter.default.map(|text| match text {
        "none" if !matches!(parameter.takes, ValueKind::Choice(_)) => String::new(),
        "" | "[]" => String::new(),
        text => text.to_owned(),
    })
}

fn takes(takes: ValueKind) -> String {
    match takes {
        ValueKind::Number => "number".into(),
        ValueKind::Positive => "number > 0".into(),
        ValueKind::Count => "whole number".into(),
        ValueKind::Numbers => "number or list".into(),
        ValueKind::Matrix => "rows of numbers".into(),
        ValueKind::Flag => "true or false".into(),
        ValueKind::Text => "text".into(),
        ValueKind::Texts => "list of texts".into(),
        ValueKind::Names => "names and values".into(),
        ValueKind::NumberLists => "names and numbers or lists".into(),
        ValueKind::Choice(words) => words.join(", "),
        ValueKind::File => "CSV file".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// The committed reference must be the one the blocks give; `SINCRO_BLESS=1` rewrites it.
    #[test]
    fn committed_reference_is_that_of_the_blocks() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/blocks.md");
        if std::env::var_os("SINCRO_BLESS").is_some() {
            std::fs::write(&path, reference()).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == reference(), "{} is out of date: run the tests with SINCRO_BLESS=1", path.display());
    }

    #[test]
    fn every_block_has_a_page_with_an_example() {
        for kind in kinds() {
            let page = page(kind);
            assert!(page.contains(&format!("type = \"{}\"", kind.name)) && page.contains(kind.summary), "{page}");
        }
    }
}

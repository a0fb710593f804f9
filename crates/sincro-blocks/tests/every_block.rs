//! Properties of every block of the library: its description, its parameters, its values on dual numbers and in lanes.

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use common::assert_same_bits_in_lanes;
use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::{Content, Diagram};
use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::{Kind, ValueKind};
use sincro_blocks::library::sources::Constant;
use sincro_blocks::library::{Item, all};
use sincro_blocks::reader::{Files, ParameterError, Reader, Value};
use sincro_blocks::runner::Runner;
use sincro_math::Dual;

/// A scene folder in which every column of every file has three numbers.
struct AnyFile;

impl Files for AnyFile {
    fn column(&self, _: &str, _: &str) -> Result<Vec<f64>, String> {
        Ok(vec![0.0, 1.0, 2.0])
    }
}

/// A plausible value of a parameter.
fn plausible(takes: ValueKind) -> Value {
    match takes {
        ValueKind::Number | ValueKind::Positive | ValueKind::Numbers | ValueKind::Matrix => Value::Number(0.5),
        ValueKind::Count => Value::Number(1.0),
        ValueKind::Flag => Value::Flag(true),
        ValueKind::Text => "u1".into(),
        ValueKind::Texts => vec!["u1"].into(),
        ValueKind::Names | ValueKind::NumberLists => Value::Table(vec![("a".into(), Value::Number(1.0))]),
        ValueKind::Choice(words) => words[0].into(),
        ValueKind::File => "data.csv".into(),
    }
}

/// Parameters that a block needs beside the required ones: one of several that exclude each other, or a special number.
fn beside(name: &str) -> Vec<(&'static str, Value)> {
    match name {
        "sine" => vec![("frequency_hz", 2.0.into())],
        "table" => vec![("times", vec![0.0, 1.0].into()), ("values", vec![2.0, 3.0].into())],
        "expression" => vec![("expression", "2*u1 - u2^2".into())],
        "demux" => vec![("sizes", vec![2.0, 1.0].into())],
        "selector" => vec![("indices", vec![2.0, 0.0].into())],
        _ => Vec::new(),
    }
}

fn required(kind: &Kind) -> BTreeMap<String, Value> {
    let required = kind.parameters.iter().filter(|p| p.default.is_none());
    let mut given: BTreeMap<String, Value> = required.map(|p| (p.name.to_owned(), plausible(p.takes))).collect();
    given.extend(beside(kind.name).into_iter().map(|(key, value)| (key.to_owned(), value)));
    given
}

fn read(item: &Item, given: &BTreeMap<String, Value>) -> (Box<dyn DynBlock>, Vec<ParameterError>) {
    let scope = BTreeMap::new();
    let mut reader = Reader::new(item.kind, given, &scope, &AnyFile);
    let block = (item.read)(&mut reader);
    (block, reader.finish())
}

/// The categories whose blocks this file knows how to feed.
fn is_own(kind: &Kind) -> bool {
    use sincro_blocks::kind::Category::{Logic, Maths, Routing, Sinks, Sources};
    matches!(kind.category, Sources | Maths | Routing | Logic | Sinks)
}

#[test]
fn every_block_is_described() {
    let mut names = BTreeSet::new();
    for item in all() {
        let kind = item.kind;
        let is_kebab = kind.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
            && kind.name.starts_with(|c: char| c.is_ascii_lowercase())
            && !kind.name.ends_with('-');
        assert!(is_kebab, "{}", kind.name);
        assert!(names.insert(kind.name), "two blocks are called {}", kind.name);
        assert!(kind.summary.ends_with('.') && kind.summary.len() > 5, "{}", kind.name);
        assert!(!kind.equation.is_empty(), "{}", kind.name);
        let mut keys = BTreeSet::new();
        for parameter in kind.parameters {
            assert!(!parameter.meaning().is_empty(), "{}: {}", kind.name, parameter.name);
            assert!(keys.insert(parameter.name), "{}: two parameters {}", kind.name, parameter.name);
            if let (ValueKind::Choice(words), Some(default)) = (parameter.takes, parameter.default) {
                assert!(words.contains(&default), "{}: {default}", kind.name);
            }
        }
    }
}

#[test]
fn every_block_can_be_made_from_its_required_parameters() {
    for item in all() {
        let (block, faults) = read(item, &required(item.kind));
        assert!(!is_own(item.kind) || faults.is_empty(), "{}: {faults:?}", item.kind.name);
        if faults.is_empty() {
            let ports = block.ports();
            let names: BTreeSet<&String> = ports.inputs.iter().collect();
            assert_eq!(names.len(), ports.inputs.len(), "{}: inputs of one name", item.kind.name);
            assert_eq!(block.units(&vec![None; ports.inputs.len()]).unwrap().len(), ports.outputs.len());
        }
    }
}

#[test]
fn no_parameter_is_read_without_an_answer() {
    // every parameter once with something that it does not take, and none at all: faults, never a panic
    for item in all() {
        let (_, faults) = read(item, &BTreeMap::new());
        let needs = item.kind.parameters.iter().filter(|p| p.default.is_none()).count();
        assert!(faults.len() >= needs, "{}: {faults:?}", item.kind.name);
        for parameter in item.kind.parameters.iter().filter(|_| is_own(item.kind)) {
            let mut given = required(item.kind);
            given.insert(parameter.name.into(), Value::Table(vec![("x".into(), Value::Flag(true))]));
            let (_, faults) = read(item, &given);
            assert!(!faults.is_empty(), "{} takes anything for {}", item.kind.name, parameter.name);
        }
    }
}

#[test]
fn an_unknown_parameter_is_a_fault() {
    for item in all() {
        let mut given = required(item.kind);
        given.insert("colour_of_the_box".into(), "red".into());
        let (_, faults) = read(item, &given);
        let expected = format!("`{}` has no parameter `colour_of_the_box`", item.kind.name);
        assert!(faults.iter().any(|f| f.message == expected), "{}: {faults:?}", item.kind.name);
    }
}

/// The block with constants at its inputs, as wide as it takes them.
fn fed(item: &Item, width: usize) -> Option<(Diagram, Vec<String>)> {
    let (block, _) = read(item, &required(item.kind));
    let ports = block.ports();
    if block.widths(&vec![Some(width); ports.inputs.len()]).is_err() {
        return None;
    }
    let mut d = Diagram::new();
    d.add("block", Content::Block(block), None);
    for (k, port) in ports.inputs.iter().enumerate() {
        // within the domain of every function, and a whole number for selectors
        let value = (0..width).map(|i| if k == 0 && width == 1 { 1.0 } else { 0.3 + 0.2 * (k + i) as f64 }).collect();
        let name = format!("input-{k}");
        d.block(&name, Constant { value }).wire(&name, &format!("block.{port}"));
    }
    let outputs = match &ports.outputs[..] {
        [_] => vec!["block".to_owned()],
        many => many.iter().map(|port| format!("block.{port}")).collect(),
    };
    Some((d, outputs))
}

#[test]
fn values_on_dual_numbers_have_the_bits_of_plain_ones() {
    for item in all().filter(|item| is_own(item.kind)) {
        let Some((d, outputs)) = [1, 3].iter().find_map(|width| fed(item, *width)) else {
            // the matrix of one by one takes a scalar: everything of these categories can be fed
            panic!("{} cannot be fed", item.kind.name);
        };
        let program =
            Arc::new(compile(&d, &Interface::new(0.01)).unwrap_or_else(|e| panic!("{}: {e:?}", item.kind.name)));
        let (mut plain, mut dual) = (Runner::<f64>::new(program.clone()), Runner::<Dual<1>>::new(program.clone()));
        for tick in 0..5 {
            let t = tick as f64 * 0.01;
            plain.evaluate(tick, t);
            dual.evaluate(tick, t);
            for (name, range, _) in program.outputs().filter(|(name, ..)| outputs.contains(name)) {
                for k in range {
                    let (x, z) = (plain.signals()[k], dual.signals()[k]);
                    assert_eq!(x.to_bits(), z.value.to_bits(), "{} {name}: {x} {z:?}", item.kind.name);
                    assert!(x.is_finite(), "{} {name}: {x}", item.kind.name);
                }
            }
            plain.update(tick, t);
            dual.update(tick, t);
        }
    }
}

#[test]
fn lanes_have_the_bits_of_each_run_alone() {
    for item in all().filter(|item| is_own(item.kind)) {
        let (block, _) = read(item, &required(item.kind));
        let n_inputs = block.ports().inputs.len();
        let width = [1, 3].into_iter().find(|width| block.widths(&vec![Some(*width); n_inputs]).is_ok());
        let width = width.unwrap_or_else(|| panic!("{} cannot be fed", item.kind.name));
        assert_same_bits_in_lanes(item.kind.name, block, &vec![width; n_inputs]);
    }
}

//! Helpers of the library's tests: blocks from parameters, given samples, a generator of numbers.
#![allow(dead_code)] // every test file takes what it needs

use std::collections::BTreeMap;

use sincro_blocks::block::{At, Block, Ports, SampleTimeKind};
use sincro_blocks::diagram::{Content, Diagram};
use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::{Category, Described, Kind};
use sincro_blocks::library;
use sincro_blocks::library::sources::Constant;
use sincro_blocks::reader::{Files, ParameterError, Reader, Value};
use sincro_blocks::simulator::Simulator;
use sincro_math::Real;

/// A file `table.csv` with the columns `x` = 0, 1, 3 and `y` = 0, 10, −10.
struct OneFile;

impl Files for OneFile {
    fn column(&self, file: &str, column: &str) -> Result<Vec<f64>, String> {
        match (file, column) {
            ("table.csv", "x") => Ok(vec![0.0, 1.0, 3.0]),
            ("table.csv", "y") => Ok(vec![0.0, 10.0, -10.0]),
            _ => Err(format!("`{file}` has no column `{column}`")),
        }
    }
}

/// A block of the library, made from parameters as a file gives them.
pub fn made(kind: &str, parameters: &[(&str, Value)]) -> Result<Box<dyn DynBlock>, Vec<ParameterError>> {
    let item = library::find(kind).unwrap_or_else(|| panic!("no block `{kind}`"));
    let given: BTreeMap<String, Value> = parameters.iter().map(|(key, x)| ((*key).to_owned(), x.clone())).collect();
    let scope = BTreeMap::new();
    let mut reader = Reader::new(item.kind, &given, &scope, &OneFile);
    let block = (item.read)(&mut reader);
    let faults = reader.finish();
    if faults.is_empty() { Ok(block) } else { Err(faults) }
}

/// As [`made`], for parameters without faults.
pub fn block(kind: &str, parameters: &[(&str, Value)]) -> Box<dyn DynBlock> {
    made(kind, parameters).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

/// Everything that is wrong with parameters, in one text.
pub fn faults(kind: &str, parameters: &[(&str, Value)]) -> String {
    let faults = made(kind, parameters).expect_err("faults");
    faults.iter().map(|f| format!("{}: {} ({})\n", f.path.join("."), f.message, f.help)).collect()
}

/// A list of numbers as a parameter.
pub fn list(numbers: &[f64]) -> Value {
    numbers.to_vec().into()
}

/// Rows of numbers as a parameter.
pub fn rows(rows: &[&[f64]]) -> Value {
    Value::List(rows.iter().map(|row| list(row)).collect())
}

/// Names with values as a parameter.
pub fn table(entries: &[(&str, Value)]) -> Value {
    Value::Table(entries.iter().map(|(name, x)| ((*name).to_owned(), x.clone())).collect())
}

/// Adds a block made by [`block`].
pub fn add(d: &mut Diagram, name: &str, block: Box<dyn DynBlock>) {
    d.add(name, Content::Block(block), None);
}

/// A diagram with a constant `u` and a block `y` that it is wired to.
pub fn driven(u: &[f64], block: Box<dyn DynBlock>) -> Diagram {
    let mut d = Diagram::new();
    d.block("u", Constant { value: u.to_vec() });
    add(&mut d, "y", block);
    d.wire("u", "y");
    d
}

/// Outputs of a block for samples of its only input, one a tick of `step` `[s]`; the first component.
pub fn answer(samples: &[f64], step: f64, block: Box<dyn DynBlock>) -> Vec<f64> {
    let mut d = Diagram::new();
    d.block("u", Samples { values: samples.to_vec() });
    add(&mut d, "y", block);
    d.wire("u", "y");
    Simulator::new(&d, step).unwrap().record("y", samples.len() - 1)
}

/// Output of a block for a constant vector.
pub fn value(u: &[f64], block: Box<dyn DynBlock>) -> Vec<f64> {
    Simulator::new(&driven(u, block), 0.01).unwrap().output("y").to_vec()
}

/// A source with a given value at every tick; the last one stays.
#[derive(Clone, Debug)]
pub struct Samples {
    /// By tick.
    pub values: Vec<f64>,
}

impl Described for Samples {
    const KIND: &'static Kind =
        &Kind { name: "samples", category: Category::Sources, summary: "", equation: "", parameters: &[] };

    fn read(_: &mut Reader<'_>) -> Self {
        Self { values: vec![0.0] }
    }
}

impl Block for Samples {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(1)])
    }

    fn sample_time_kind(&self) -> SampleTimeKind {
        SampleTimeKind::Discrete
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y[0] = R::splat(self.values[(at.tick as usize).min(self.values.len() - 1)]);
    }
}

/// Numbers without a pattern, the same in every run: a linear congruential generator (Knuth's multiplier, MMIX).
pub struct Random(pub u64);

impl Random {
    /// Between −1 and 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// So many of them.
    pub fn list(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

//! Helpers of the library's tests: blocks from parameters, given samples, a generator of numbers.
#![allow(dead_code)] // every test file takes what it needs

use std::collections::BTreeMap;
use std::sync::Arc;

use sincro_blocks::block::{At, Block, Ports, SampleTimeKind};
use sincro_blocks::compile::{Interface, Terminal, compile};
use sincro_blocks::diagram::{Content, Diagram};
use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::{Category, Described, Kind};
use sincro_blocks::lanes::{Clock, LaneRunner};
use sincro_blocks::library;
use sincro_blocks::library::sources::Constant;
use sincro_blocks::program::Program;
use sincro_blocks::reader::{Files, ParameterError, Reader, Value};
use sincro_blocks::runner::Runner;
use sincro_blocks::simulator::Simulator;
use sincro_math::Real;
use sincro_math::lanes::{LaneVisitor, dispatch_lanes};

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

/// Asserts that a block with inputs of the widths `inputs` has in each lane the bits that it has alone: with inputs,
/// clocks and lanes that stay of a pattern of their own.
pub fn assert_same_bits_in_lanes(kind: &str, block: Box<dyn DynBlock>, inputs: &[usize]) {
    let mut interface = Interface::new(0.01);
    let mut d = Diagram::new();
    let ports = block.ports().inputs;
    add(&mut d, "block", block);
    for (k, (port, width)) in ports.iter().zip(inputs).enumerate() {
        let name = format!("/input{k}");
        d.wire(&name, &format!("block.{port}"));
        interface.measurements.push(Terminal { names: vec![name], width: *width, unit: None, is_special: false });
    }
    let program = Arc::new(compile(&d, &interface).unwrap_or_else(|e| panic!("{kind}: {e:?}")));
    dispatch_lanes(InLanes { kind, program: &program });
}

struct InLanes<'a> {
    kind: &'a str,
    program: &'a Arc<Program>,
}

impl LaneVisitor for InLanes<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let Self { kind, program } = self;
        // one lane fewer than there are
        let n = R::LANES.max(2) - 1;
        if n > R::LANES {
            return;
        }
        let (mut lanes, mut random) = (LaneRunner::<R>::new(program, n), Random(5));
        let mut alone: Vec<Runner<f64>> = (0..n).map(|_| Runner::new(program.clone())).collect();
        let (mut rates, mut diagonal) = (vec![R::zero(); program.n_states], vec![R::zero(); program.n_states]);
        let (mut own_rates, mut own_diagonal) = (vec![0.0; program.n_states], vec![0.0; program.n_states]);
        for step in 0..40 {
            let clock = |k: usize| {
                let (tick, is_active) = (step + 5 * k as u64, step < 20 || !(step + k as u64).is_multiple_of(3));
                Clock { tick, t: tick as f64 * 0.01, time_event: f64::INFINITY, is_active }
            };
            let mut clocks: Vec<Clock> = (0..n).map(clock).collect();
            let mut measure = |lanes: &mut LaneRunner<R>, alone: &mut [Runner<f64>]| {
                for measured in &program.early {
                    let n_out = measured.out.len();
                    for (i, at) in measured.out.clone().enumerate() {
                        // near the unit matrix, so that matrices may be taken for rotations
                        let mean = if n_out == 9 && i % 4 == 0 { 0.9 } else { 0.3 - 0.1 * i as f64 };
                        let x = random.list(R::LANES);
                        // the first inputs are whole now and then, for selectors and switches
                        let is_whole = step % 2 == 0 && n_out == 1;
                        let value = |k: usize| if is_whole { (x[k] + 1.0).round() } else { mean + 0.3 * x[k] };
                        lanes.signals[at] = R::from_lanes(value);
                        for (k, alone) in alone.iter_mut().enumerate() {
                            alone.signals_mut()[at] = value(k);
                        }
                    }
                }
            };
            measure(&mut lanes, &mut alone);
            lanes.evaluate(&clocks);
            lanes.update(&clocks);
            for (alone, clock) in alone.iter_mut().zip(&clocks).filter(|(_, clock)| clock.is_active) {
                alone.evaluate(clock.tick, clock.t);
                alone.update(clock.tick, clock.t);
            }
            assert_same(kind, &lanes, &alone);
            measure(&mut lanes, &mut alone);
            clocks.iter_mut().for_each(|clock| clock.t += 0.004);
            lanes.minor(&clocks);
            lanes.derivatives(&clocks, &mut rates);
            lanes.neg_jacobian_diagonal(&clocks, &mut diagonal);
            for (x, rate) in lanes.continuous.iter_mut().zip(&rates) {
                *x += R::splat(0.01) * *rate;
            }
            for (k, (alone, clock)) in alone.iter_mut().zip(&clocks).enumerate().filter(|(_, (_, c))| c.is_active) {
                alone.minor(clock.tick, clock.t, f64::INFINITY);
                alone.derivatives(clock.tick, clock.t, f64::INFINITY, &mut own_rates);
                alone.neg_jacobian_diagonal(clock.tick, clock.t, &mut own_diagonal);
                for (i, (x, rate)) in alone.state.continuous.iter_mut().zip(&own_rates).enumerate() {
                    *x += 0.01 * rate;
                    assert_eq!(own_diagonal[i].to_bits(), diagonal[i].lane(k).to_bits(), "{kind}");
                }
            }
            assert_same(kind, &lanes, &alone);
        }
    }
}

fn assert_same<R: Real>(kind: &str, lanes: &LaneRunner<R>, alone: &[Runner<f64>]) {
    // a NaN may differ in sign and payload
    let bits = |list: &[f64]| -> Vec<u64> { list.iter().map(|x| if x.is_nan() { 0 } else { x.to_bits() }).collect() };
    for (k, alone) in alone.iter().enumerate() {
        let (in_lane, alone) = (lanes.save(k), alone.save());
        assert_eq!(bits(&in_lane.signals), bits(&alone.signals), "{kind}: outputs of lane {k}");
        assert_eq!(bits(&in_lane.continuous), bits(&alone.continuous), "{kind}: states of lane {k}");
        assert_eq!(bits(&in_lane.memory), bits(&alone.memory), "{kind}: memory of lane {k}");
    }
}

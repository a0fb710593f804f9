//! Routing, logic and sinks over time: inputs are held tables, one number a tick.

mod common;

use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::Diagram;
use sincro_blocks::instance::DynBlock;
use sincro_blocks::library::logic::{
    Compare, Comparison, Counter, Direction, Dominant, Edge, IntervalTest, Latch, Logic, Operator,
};
use sincro_blocks::library::routing::{Demux, Merge, MultiportSwitch, Selector, Switch};
use sincro_blocks::library::sinks::{Scope, Terminator};
use sincro_blocks::library::sources::{Constant, Table};
use sincro_blocks::simulator::Simulator;

const STEP: f64 = 0.1;

/// A block, and at each of its inputs a number for every tick.
fn driven(block: impl DynBlock + 'static, inputs: &[&[f64]]) -> Diagram {
    let ports = DynBlock::ports(&block).inputs;
    assert_eq!(ports.len(), inputs.len());
    let mut d = Diagram::new();
    d.block("block", block);
    for (k, (port, values)) in ports.iter().zip(inputs).enumerate() {
        let times: Vec<f64> = (0..values.len()).map(|k| k as f64 * STEP).collect();
        let name = format!("input-{k}");
        d.block(&name, Table { hold: true, ..Table::new(&times, values) }).wire(&name, &format!("block.{port}"));
    }
    d
}

fn over_time(block: impl DynBlock + 'static, inputs: &[&[f64]]) -> Vec<f64> {
    Simulator::new(&driven(block, inputs), STEP).unwrap().record("block", inputs[0].len() - 1)
}

/// A block with constant vectors at its inputs.
fn fed(block: impl DynBlock + 'static, inputs: &[&[f64]]) -> Diagram {
    let ports = DynBlock::ports(&block).inputs;
    let mut d = Diagram::new();
    d.block("block", block);
    for (k, (port, value)) in ports.iter().zip(inputs).enumerate() {
        let name = format!("input-{k}");
        d.block(&name, Constant { value: value.to_vec() }).wire(&name, &format!("block.{port}"));
    }
    d
}

fn refusal(d: &Diagram) -> String {
    compile(d, &Interface::new(STEP)).unwrap_err()[0].message.clone()
}

const NAN: f64 = f64::NAN;

fn same(found: &[f64], expected: &[f64]) {
    let bits = |list: &[f64]| {
        list.iter().map(|x| if x.is_nan() { "NaN".into() } else { format!("{x:?}") }).collect::<Vec<_>>()
    };
    assert_eq!(bits(found), bits(expected));
}

#[test]
fn comparisons_are_true_on_the_right_side() {
    let (u1, u2): (&[f64], &[f64]) = (&[1.0, 2.0, 3.0, NAN, 1.0], &[2.0, 2.0, 2.0, 1.0, NAN]);
    for (operator, expected) in [
        (Comparison::Less, [1., 0., 0.]),
        (Comparison::LessEqual, [1., 1., 0.]),
        (Comparison::Greater, [0., 0., 1.]),
        (Comparison::GreaterEqual, [0., 1., 1.]),
        (Comparison::Equal, [0., 1., 0.]),
        (Comparison::NotEqual, [1., 0., 1.]),
    ] {
        let found = over_time(Compare::new(operator), &[u1, u2]);
        assert_eq!(found[..3], expected, "{operator:?}");
        assert!(found[3].is_nan() && found[4].is_nan());
        assert_eq!(over_time(Compare::with(operator, 2.0), &[u1])[..3], expected);
    }
}

#[test]
fn comparing_radians_with_degrees_is_refused() {
    let mut d = fed(Compare::new(Comparison::Less), &[&[1.0], &[2.0]]);
    d.entries[1].unit = vec!["rad".into()];
    d.entries[2].unit = vec!["deg".into()];
    assert!(refusal(&d).contains("rad and deg are not the same"));
}

#[test]
fn logic_has_its_truth_tables() {
    let (u1, u2): (&[f64], &[f64]) = (&[0.0, 0.0, 2.0, 2.0, NAN], &[0.0, -1.0, 0.0, 1.0, 1.0]);
    for (operator, expected) in [
        (Operator::And, [0., 0., 0., 1., NAN]),
        (Operator::Or, [0., 1., 1., 1., NAN]),
        (Operator::Xor, [0., 1., 1., 0., NAN]),
        (Operator::Nand, [1., 1., 1., 0., NAN]),
        (Operator::Nor, [1., 0., 0., 0., NAN]),
    ] {
        same(&over_time(Logic::new(operator), &[u1, u2]), &expected);
    }
    same(&over_time(Logic::new(Operator::Not), &[u1]), &[1., 1., 0., 0., NAN]);
    let odd = Logic { operator: Operator::Xor, inputs: 3 };
    same(&over_time(odd, &[&[1., 1., 0.], &[1., 1., 0.], &[1., 0., 1.]]), &[1., 0., 1.]);
    let all = Logic { operator: Operator::And, inputs: 1 };
    assert_eq!(Simulator::new(&fed(all, &[&[1.0, 3.0, 0.0]]), STEP).unwrap().output("block"), [0.0]);
}

#[test]
fn an_interval_has_its_bounds() {
    let test = IntervalTest::new(-1.0, 2.0);
    same(&over_time(test, &[&[-1.1, -1.0, 0.0, 2.0, 2.1, NAN]]), &[0., 1., 1., 1., 0., NAN]);
}

#[test]
fn an_edge_lasts_one_sample() {
    let u: &[f64] = &[1.0, 1.0, 0.0, 0.0, 1.0];
    same(&over_time(Edge::new(Direction::Rising), &[u]), &[1., 0., 0., 0., 1.]);
    same(&over_time(Edge::new(Direction::Falling), &[u]), &[0., 0., 1., 0., 0.]);
    same(&over_time(Edge { initial: true, ..Edge::new(Direction::Either) }, &[u]), &[0., 0., 1., 0., 1.]);
}

#[test]
fn a_latch_remembers_and_answers_at_once() {
    let (set, reset): (&[f64], &[f64]) = (&[0., 1., 0., 0., 0., 1., 0.], &[0., 0., 0., 1., 0., 1., 0.]);
    same(&over_time(Latch::new(), &[set, reset]), &[0., 1., 1., 0., 0., 0., 0.]);
    same(&over_time(Latch { dominant: Dominant::Set, initial: true }, &[set, reset]), &[1., 1., 1., 0., 0., 1., 1.]);
}

#[test]
fn a_counter_counts_rises_until_it_is_reset() {
    let u: &[f64] = &[1., 1., 0., 1., 0., 1., 0., 1.];
    same(&over_time(Counter::new(), &[u]), &[1., 1., 1., 2., 2., 3., 3., 4.]);
    let reset: &[f64] = &[0., 0., 0., 0., 0., 1., 0., 0.];
    same(&over_time(Counter { initial: 5, reset: true }, &[u, reset]), &[6., 6., 6., 7., 7., 0., 0., 1.]);
}

#[test]
fn a_vector_is_cut_and_rearranged() {
    let simulator = Simulator::new(&fed(Demux::new(&[1, 2]), &[&[1.0, 2.0, 3.0]]), STEP).unwrap();
    assert_eq!((simulator.output("block.y1"), simulator.output("block.y2")), (&[1.0][..], &[2.0, 3.0][..]));
    assert!(refusal(&fed(Demux::new(&[1, 1]), &[&[1.0, 2.0, 3.0]])).contains("the sizes add up to 2"));
    let simulator = Simulator::new(&fed(Selector::new(&[2, 0, 2]), &[&[1.0, 2.0, 3.0]]), STEP).unwrap();
    assert_eq!(simulator.output("block"), [3.0, 1.0, 3.0]);
    assert!(refusal(&fed(Selector::new(&[3]), &[&[1.0, 2.0, 3.0]])).contains("there is no component 3"));
}

#[test]
fn a_switch_is_on_just_above_its_threshold() {
    let inputs: [&[f64]; 3] = [&[1.0; 5], &[-1.0, 0.0, 1.0, NAN, 2.0], &[5.0, 5.0, 5.0, 5.0, NAN]];
    same(&over_time(Switch::new(0.0), &inputs), &[5., 5., 1., NAN, 1.]);
    let at_least = Switch { criterion: Comparison::GreaterEqual, threshold: 0.0 };
    same(&over_time(at_least, &inputs), &[5., 1., 1., NAN, 1.]);
    let other = Switch { criterion: Comparison::NotEqual, threshold: 0.0 };
    same(&over_time(other, &inputs), &[1., 5., 1., NAN, 1.]);
}

#[test]
fn a_selector_beyond_the_inputs_stops_the_run_at_its_switch() {
    let inputs: [&[f64]; 3] = [&[1.0, 2.0, 1.5, 0.0, 3.0, NAN], &[10.0; 6], &[20.0; 6]];
    same(&over_time(MultiportSwitch::new(2), &inputs), &[10., 20., NAN, NAN, NAN, NAN]);
    let mut d = fed(MultiportSwitch::new(2), &[&[3.0], &[1.0], &[2.0]]);
    d.block("end", Terminator).wire("block", "end");
    let simulator = Simulator::new(&d, STEP).unwrap();
    assert_eq!(simulator.runner.not_finite().unwrap().0.path, "block");
}

#[test]
fn merging_follows_whoever_spoke_last() {
    let inputs: [&[f64]; 2] = [&[1., 1., 1., 2., 2., 4., 4.], &[5., 5., 6., 6., 6., 7., 7.]];
    same(&over_time(Merge::new(2), &inputs), &[1., 1., 6., 2., 2., 4., 4.]);
    assert!(refusal(&fed(Merge::new(2), &[&[1.0], &[1.0, 2.0]])).contains("all inputs have the same size"));
}

#[test]
fn sinks_take_anything_and_change_nothing() {
    let mut d = Diagram::new();
    d.block("a", Constant::new(1.0)).block("b", Constant { value: vec![2.0, 3.0] });
    d.block("scope", Scope::new(2)).wire("a", "scope.u1").wire("b", "scope.u2");
    d.block("end", Terminator).wire("b", "end");
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    simulator.record("a", 3);
    assert_eq!((simulator.output("a"), simulator.output("b")), (&[1.0][..], &[2.0, 3.0][..]));
}

#[test]
fn a_mux_has_as_many_inputs_as_its_parameter_says() {
    for n in [1, 999, 1001, 10_000] {
        let mux = common::block("mux", &[("inputs", (n as f64).into())]);
        assert_eq!(mux.ports().inputs.len(), n);
    }
    assert!(common::faults("mux", &[("inputs", 10_001.0.into())]).contains("a block has at most 10000"));
    assert!(common::faults("mux", &[("inputs", 0.0.into())]).contains("it must be 1 or more"));
}

//! Inference of sample times.
//!
//! A block with a sample time runs at its ticks. One without takes the pace of its inputs: continuous if any of them
//! is, constant if all are, else at every tick at which one of them may change.

use super::{Diagnostic, EARLY, Element, Flat, FlatNode, LATE, Place};
use crate::block::SampleTimeKind;
use crate::program::Rate;

pub(super) fn infer(flat: &Flat, order: &[usize], step: f64) -> Result<Vec<Rate>, Vec<Diagnostic>> {
    let mut rates = vec![Rate::Continuous; flat.nodes.len()];
    let mut problems = Vec::new();
    for &n in order {
        if n == EARLY || n == LATE {
            continue;
        }
        match rate(flat, n, &rates, step) {
            Ok(rate) => rates[n] = rate,
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() { Ok(rates) } else { Err(problems) }
}

fn rate(flat: &Flat, n: usize, rates: &[Rate], step: f64) -> Result<Rate, Diagnostic> {
    let node = &flat.nodes[n];
    let template = node.template.as_ref().expect("a block, not the world");
    let given = node.sample_time.map(|(ts, inherited)| (multiple(node, ts, step), inherited));
    match (template.sample_time_kind(), given) {
        (SampleTimeKind::Constant, _) => Ok(Rate::Constant),
        (SampleTimeKind::Continuous, Some((_, inherited))) => Err(continuous_with_sample_time(node, inherited)),
        (SampleTimeKind::Continuous | SampleTimeKind::TimeVarying, None) => Ok(Rate::Continuous),
        (_, Some((every, _))) => Ok(Rate::Sampled(every?)),
        (SampleTimeKind::Discrete, None) => Ok(Rate::Sampled(1)),
        (SampleTimeKind::Inherited, None) => Ok(inherited(flat, n, rates)),
    }
}

/// The pace of the inputs.
fn inherited(flat: &Flat, n: usize, rates: &[Rate]) -> Rate {
    let node = &flat.nodes[n];
    if node.inputs.is_empty() {
        return Rate::Continuous;
    }
    let mut rate = Rate::Constant;
    for input in &node.inputs {
        rate = match (rate, rates[input.node]) {
            (Rate::Continuous, _) | (_, Rate::Continuous) => Rate::Continuous,
            (Rate::Sampled(a), Rate::Sampled(b)) => Rate::Sampled(greatest_common_divisor(a, b)),
            (Rate::Constant, other) | (other, Rate::Constant) => other,
        };
    }
    rate
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// The sample time in base steps.
fn multiple(node: &FlatNode, ts: f64, step: f64) -> Result<u64, Diagnostic> {
    if ts <= 0.0 {
        let message = format!("the sample time {ts} s of `{}` is not greater than 0", node.path);
        let help = format!("use a multiple of the base step {step} s, or leave it out");
        return Err(Diagnostic { place: sample_place(node), message, help });
    }
    let n = (ts / step).round();
    if n >= 1.0 && (n * step - ts).abs() <= 1e-9 * ts && n < 1e15 {
        return Ok(n as u64);
    }
    let message = format!("the sample time {ts} s of `{}` is no multiple of the base step {step} s", node.path);
    let help = if ts > step {
        let (low, high) = ((ts / step).floor().max(1.0), (ts / step).ceil());
        format!("use {} s or {} s, or another `step` in the experiment", short(low * step), short(high * step))
    } else {
        format!("use {step} s or more, or a smaller `step` in the experiment")
    };
    Err(Diagnostic { place: sample_place(node), message, help })
}

/// A number without the last digits, which are rounding.
fn short(x: f64) -> String {
    let text = format!("{x:.12}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn continuous_with_sample_time(node: &FlatNode, inherited: bool) -> Diagnostic {
    let kind = node.template.as_ref().map_or("", |t| t.kind().name);
    let message = format!("`{}` is a continuous block ({kind}) and cannot have a sample time", node.path);
    let help = if inherited {
        "its diagram has one: leave the diagram's sample time out, or use a block of the discrete category"
    } else {
        "leave `sample_time` out, or use a block of the discrete category"
    };
    Diagnostic { place: sample_place(node), message, help: help.into() }
}

fn sample_place(node: &FlatNode) -> Place {
    match &node.place.element {
        Element::Entry(name) => {
            Place { diagram: node.place.diagram.clone(), element: Element::SampleTime(name.clone()) }
        }
        _ => node.place.clone(),
    }
}

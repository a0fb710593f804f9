//! Inference of signal widths: from what is known to what follows, until nothing changes; what is then still open is a
//! scalar.

use core::ops::Range;
use std::collections::BTreeSet;

use super::{Diagnostic, EARLY, Flat, Input, LATE, Place};

/// Most components of a signal: more is a mistake, such as vectors put together of themselves.
const MAX_COMPONENTS: usize = 1_000_000;

pub(super) fn infer(flat: &mut Flat) -> Result<(), Vec<Diagnostic>> {
    let mut users: Vec<Vec<usize>> = vec![Vec::new(); flat.nodes.len()];
    for n in LATE + 1..flat.nodes.len() {
        flat.nodes[n].inputs.iter().for_each(|input| users[input.node].push(n));
    }
    let mut due: BTreeSet<usize> = (LATE + 1..flat.nodes.len()).collect();
    let mut open = LATE + 1;
    loop {
        while !due.is_empty() {
            due = sweep(flat, due, &users)?;
        }
        // a loop of blocks of any width, such as a delay that feeds itself: a scalar
        let is_open = |n: &usize| flat.nodes[*n].out_widths.contains(&None);
        let Some(n) = (open..flat.nodes.len()).find(is_open) else { break };
        flat.nodes[n].out_widths.iter_mut().for_each(|w| *w = Some(w.unwrap_or(1)));
        due.insert(n);
        due.extend(&users[n]);
        open = n;
    }
    let problems: Vec<Diagnostic> = (0..flat.nodes.len()).flat_map(|n| ranges(flat, n)).collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let problems: Vec<Diagnostic> = commands(flat);
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// One pass over the blocks that are due, in their order; those that are due in the next one.
fn sweep(flat: &mut Flat, mut due: BTreeSet<usize>, users: &[Vec<usize>]) -> Result<BTreeSet<usize>, Vec<Diagnostic>> {
    let (mut next, mut problems) = (BTreeSet::new(), Vec::new());
    while let Some(n) = due.pop_first() {
        match visit(flat, n) {
            Ok(true) => users[n].iter().for_each(|&user| {
                if user > n {
                    due.insert(user)
                } else {
                    next.insert(user)
                };
            }),
            Ok(false) => {}
            Err(found) => problems.extend(found),
        }
    }
    if problems.is_empty() { Ok(next) } else { Err(problems) }
}

/// The widths of a block as far as they follow; whether anything became known.
fn visit(flat: &mut Flat, n: usize) -> Result<bool, Vec<Diagnostic>> {
    let found: Vec<Diagnostic> = ranges(flat, n);
    if !found.is_empty() {
        return Err(found);
    }
    let inputs: Vec<Option<usize>> = flat.nodes[n].inputs.iter().map(|i| width(flat, i)).collect();
    let template = flat.nodes[n].template.as_ref().expect("a block, not the world");
    let outputs = template.widths(&inputs).map_err(|words| vec![misfit(flat, n, &inputs, &words)])?;
    let (mut changed, mut problems) = (false, Vec::new());
    let node = &mut flat.nodes[n];
    for (old, new) in node.out_widths.iter_mut().zip(outputs) {
        let wrong = match (*old, new) {
            (_, Some(w)) if w > MAX_COMPONENTS => {
                let help =
                    "look for a vector that is put together of itself again and again, or a number that is too large";
                Some((format!("`{}` gives {w} components; at most {MAX_COMPONENTS} are possible", node.path), help))
            }
            (None, Some(w)) => {
                (*old, changed) = (Some(w), true);
                None
            }
            (Some(a), Some(b)) if a != b => {
                let help = "give its parameters the width of the signal";
                Some((format!("`{}` gives {b} components where {a} were inferred", node.path), help))
            }
            _ => None,
        };
        if let Some((message, help)) = wrong {
            problems.push(Diagnostic { place: node.place.clone(), message, help: help.to_owned() });
        }
    }
    node.in_widths = inputs;
    if problems.is_empty() { Ok(changed) } else { Err(problems) }
}

fn width(flat: &Flat, input: &Input) -> Option<usize> {
    match &input.range {
        Some(range) => Some(range.len()),
        None => flat.nodes[input.node].out_widths[input.port],
    }
}

/// Components that are chosen of a signal that does not have them.
fn ranges(flat: &Flat, n: usize) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for input in &flat.nodes[n].inputs {
        let whole = flat.nodes[input.node].out_widths[input.port];
        if let (Some(range), Some(whole)) = (&input.range, whole)
            && range.end > whole
        {
            let name = flat.output_name(input.node, input.port);
            problems.push(beyond(&name, whole, range, input.place.clone()));
        }
    }
    problems
}

/// The problem of components `range` that a signal of `width` components does not have.
pub(super) fn beyond(name: &str, width: usize, range: &Range<usize>, place: Place) -> Diagnostic {
    let components = if width == 1 { "1 component" } else { &format!("{width} components") };
    let message = format!("`{name}` has {components}: there is no [{}]", range.end - 1);
    let help = match width {
        0 | 1 => format!("write `{name}`"),
        _ => format!("components are counted from 0 to {}", width - 1),
    };
    Diagnostic { place, message, help }
}

/// Inputs that do not fit each other: every one with its size and where it comes from.
fn misfit(flat: &Flat, n: usize, inputs: &[Option<usize>], words: &str) -> Diagnostic {
    let node = &flat.nodes[n];
    let ends = node.inputs.iter().zip(inputs).enumerate().filter_map(|(k, (input, width))| {
        let from = flat.output_name(input.node, input.port);
        width.map(|w| format!("`{}` gets {w} from `{from}`", node.input_names[k]))
    });
    let message = format!("sizes do not fit in `{}`: {words} ({})", node.path, ends.collect::<Vec<_>>().join(", "));
    let help = "choose components with `[i]` or `[i:j]`, put signals together with `[a, b]`, or change the parameters";
    Diagnostic { place: node.place.clone(), message, help: help.into() }
}

/// Checks that commands have the width that the world takes.
fn commands(flat: &Flat) -> Vec<Diagnostic> {
    let world = &flat.nodes[LATE];
    let mut problems = Vec::new();
    for (k, input) in world.inputs.iter().enumerate() {
        let (given, taken) = (width(flat, input), world.in_widths[k]);
        if given != taken {
            let name = flat.output_name(input.node, input.port);
            let (given, taken) = (given.unwrap_or(0), taken.unwrap_or(0));
            let message = format!("`{name}` has {given} components, `{}` takes {taken}", flat.input_name(LATE, k));
            let help = format!("choose one: `{name}[0]`");
            problems.push(Diagnostic { place: input.place.clone(), message, help });
        }
    }
    debug_assert!(flat.nodes[EARLY].inputs.is_empty(), "measurements of the state have no inputs");
    problems
}

//! Inference and check of units: carried along wires as far as they are known, and compared wherever two meet. What is
//! still unknown then and commands the world is in the unit that the world takes.

use super::{Diagnostic, EARLY, Element, Flat, FlatNode, Input, LATE, Place};
use crate::unit::Unit;

/// Units of all outputs, as far as they are known, noted in the nodes.
pub(super) fn infer(flat: &mut Flat, order: &[usize]) -> Result<(), Vec<Diagnostic>> {
    let mut units: Vec<Vec<Option<Unit>>> = flat.nodes.iter().map(|n| vec![None; n.output_names.len()]).collect();
    units[EARLY].clone_from(&flat.nodes[EARLY].out_units);
    units[LATE].clone_from(&flat.nodes[LATE].out_units);
    // what is fed back is known in the second pass; only that one reports
    let _ = pass(flat, order, &mut units);
    let mut problems = pass(flat, order, &mut units);
    problems.extend(commands(flat, &units));
    from_commands(flat, &mut units);
    for (node, units) in flat.nodes.iter_mut().zip(units) {
        node.out_units = units;
    }
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

fn pass(flat: &Flat, order: &[usize], units: &mut [Vec<Option<Unit>>]) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for &n in order.iter().filter(|&&n| n != EARLY && n != LATE) {
        let node = &flat.nodes[n];
        let inputs: Vec<Option<Unit>> = node.inputs.iter().map(|i| units[i.node][i.port].clone()).collect();
        let template = node.template.as_ref().expect("a block, not the world");
        match template.units(&inputs) {
            Ok(outputs) => units[n] = outputs,
            Err(words) => {
                let ends = node.inputs.iter().enumerate().filter_map(|(k, input)| {
                    let from = flat.output_name(input.node, input.port);
                    inputs[k].as_ref().map(|u| format!("`{}` gets {u} from `{from}`", node.input_names[k]))
                });
                let ends = ends.collect::<Vec<_>>().join(", ");
                let message = format!("units do not fit in `{}`: {words} ({ends})", node.path);
                let help = "convert one of them with a `gain` and declare its `unit`".to_owned();
                problems.push(Diagnostic { place: node.place.clone(), message, help });
            }
        }
        let Some(text) = &node.unit else { continue };
        match Unit::parse(text) {
            Err(message) => {
                let help = "units are products such as N·m/rad, m/s^2, kg·m²".to_owned();
                problems.push(Diagnostic { place: unit_place(node), message, help });
            }
            Ok(declared) => {
                for unit in &mut units[n] {
                    if let Some(found) = unit
                        && !found.is_same(&declared)
                    {
                        let message = format!("`{}` is declared in {declared}, its signal is in {found}", node.path);
                        let help = format!("declare unit = \"{found}\", or leave it out");
                        problems.push(Diagnostic { place: unit_place(node), message, help });
                    }
                    *unit = Some(declared.clone());
                }
            }
        }
    }
    problems
}

fn unit_place(node: &FlatNode) -> Place {
    match &node.place.element {
        Element::Entry(name) => Place { diagram: node.place.diagram.clone(), element: Element::Unit(name.clone()) },
        _ => node.place.clone(),
    }
}

/// Checks that commands are in the unit that the world takes.
fn commands(flat: &Flat, units: &[Vec<Option<Unit>>]) -> Vec<Diagnostic> {
    let world = &flat.nodes[LATE];
    let mut problems = Vec::new();
    for (k, input) in world.inputs.iter().enumerate() {
        if let (Some(given), Some(taken)) = (&units[input.node][input.port], &world.in_units[k])
            && !given.is_same(taken)
        {
            let (from, to) = (flat.output_name(input.node, input.port), flat.input_name(LATE, k));
            let message = format!("`{from}` is in {given}, `{to}` takes {taken}");
            let help = "convert it with a `gain` and declare its `unit`".to_owned();
            problems.push(Diagnostic { place: input.place.clone(), message, help });
        }
    }
    problems
}

/// Gives outputs of blocks whose unit is not known that of the commands which they feed, if all of those agree.
fn from_commands(flat: &Flat, units: &mut [Vec<Option<Unit>>]) {
    let world = &flat.nodes[LATE];
    let unknown: Vec<bool> = world.inputs.iter().map(|i| units[i.node][i.port].is_none()).collect();
    for (k, input) in world.inputs.iter().enumerate().filter(|(k, i)| unknown[*k] && i.node != EARLY && i.node != LATE)
    {
        let is_shared = |other: &Input| (other.node, other.port) == (input.node, input.port);
        let mut taken = world.inputs.iter().zip(&world.in_units).filter(|(other, _)| is_shared(other)).map(|(_, u)| u);
        let agree = taken.all(|u| u.as_ref().zip(world.in_units[k].as_ref()).is_some_and(|(a, b)| a.is_same(b)));
        if agree {
            units[input.node][input.port].clone_from(&world.in_units[k]);
        }
    }
}

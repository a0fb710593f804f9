//! Inference and check of units: carried along wires as far as they are known, and compared wherever two meet. What is
//! still unknown then is deduced for display (`deduced_units.rs`).

use super::deduced_units::{ComponentUnits, deduce};
use super::{Diagnostic, EARLY, Element, Flat, FlatNode, LATE, Place};
use crate::unit::Unit;

/// Number of signal components above which no units are shown, to bound time and memory.
const MAX_COMPONENTS: usize = 1 << 16;

/// Units of the components of all outputs, as far as they are known, noted in the nodes.
pub(super) fn infer(flat: &mut Flat, order: &[usize]) -> Result<(), Vec<Diagnostic>> {
    let mut problems = Vec::new();
    let declared = flat.nodes.iter().map(|node| declared(node, &mut problems)).collect::<Vec<_>>();
    let mut units: Vec<Vec<Option<Unit>>> = flat.nodes.iter().map(|n| vec![None; n.output_names.len()]).collect();
    units[EARLY].clone_from(&flat.nodes[EARLY].out_units);
    units[LATE].clone_from(&flat.nodes[LATE].out_units);
    // what is fed back is known in the second pass; only that one reports
    let _ = pass(flat, order, &declared, &mut units);
    problems.extend(pass(flat, order, &declared, &mut units));
    problems.extend(commands(flat, &units));
    if !problems.is_empty() {
        return Err(problems);
    }
    let n_components: usize = flat.nodes.iter().flat_map(|n| &n.out_widths).flatten().sum();
    if n_components <= MAX_COMPONENTS {
        let found = deduce(flat, order, by_component(flat, declared, &units));
        flat.nodes.iter_mut().zip(found).for_each(|(node, units)| node.component_units = units);
    }
    Ok(())
}

/// Declared units of the components of all outputs of a node, one after the other; empty if none is declared.
fn declared(node: &FlatNode, problems: &mut Vec<Diagnostic>) -> Vec<Unit> {
    let mut units = Vec::new();
    let mut problem = |message: String, help: String| {
        problems.push(Diagnostic { place: unit_place(node), message, help });
    };
    for text in &node.unit {
        match Unit::parse(text) {
            Ok(unit) => units.push(unit),
            Err(message) => problem(message, "units are products such as N·m/rad, m/s^2, kg·m²".into()),
        }
    }
    let n_components = node.out_widths.iter().map(|width| width.unwrap_or(0)).sum();
    match units.len() {
        0 => {}
        1 => units = vec![units[0].clone(); n_components],
        n if n != n_components && n == node.unit.len() => {
            let message = format!("`{}` has {n} units for {n_components} components", node.path);
            problem(message, "give one unit for all components, or a list with one for each".into());
            units.clear();
        }
        _ => {}
    }
    units
}

/// Units of the components: those declared, then those of the ports.
fn by_component(flat: &Flat, declared: Vec<Vec<Unit>>, units: &[Vec<Option<Unit>>]) -> ComponentUnits {
    let of_ports = |n: usize| -> Vec<Option<Unit>> {
        let ports = flat.nodes[n].out_widths.iter().zip(&units[n]);
        ports.flat_map(|(width, unit)| vec![unit.clone(); width.unwrap_or(0)]).collect()
    };
    let of_node = |(n, declared): (usize, Vec<Unit>)| match declared.is_empty() {
        true => of_ports(n),
        false => declared.into_iter().map(Some).collect(),
    };
    declared.into_iter().enumerate().map(of_node).collect()
}

fn pass(flat: &Flat, order: &[usize], declared: &[Vec<Unit>], units: &mut [Vec<Option<Unit>>]) -> Vec<Diagnostic> {
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
        let mut of_components = declared[n].iter();
        for (unit, width) in units[n].iter_mut().zip(&node.out_widths).filter(|_| !declared[n].is_empty()) {
            let declared: Vec<&Unit> = of_components.by_ref().take(width.unwrap_or(0)).collect();
            let wrong = declared.iter().find(|d| unit.as_ref().is_some_and(|found| !found.is_same(d)));
            if let (Some(wrong), Some(found)) = (wrong, &*unit) {
                let message = format!("`{}` is declared in {wrong}, its signal is in {found}", node.path);
                let help = format!("declare unit = \"{found}\", or leave it out");
                problems.push(Diagnostic { place: unit_place(node), message, help });
            }
            let is_one = declared.windows(2).all(|pair| pair[0].is_same(pair[1]));
            *unit = declared.first().filter(|_| is_one).map(|&unit| unit.clone());
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

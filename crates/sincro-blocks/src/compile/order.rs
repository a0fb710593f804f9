//! Order of evaluation and algebraic loops: every block after those to whose outputs it has direct feedthrough;
//! otherwise as written. A cycle of blocks with direct feedthrough is an algebraic loop.

use std::collections::BTreeSet;

use super::{Diagnostic, EARLY, Flat, LATE};

/// Numbers of all nodes in the order of evaluation, the world's late measurements (if there are any) as late as
/// possible.
pub(super) fn order(flat: &Flat) -> Result<Vec<usize>, Vec<Diagnostic>> {
    let n = flat.nodes.len();
    let needs: Vec<Vec<usize>> = (0..n).map(|node| needed(flat, node)).collect();
    let mut needed_by: Vec<Vec<usize>> = vec![Vec::new(); n];
    let mut waits_for: Vec<usize> = vec![0; n];
    for (node, sources) in needs.iter().enumerate() {
        waits_for[node] = sources.len();
        sources.iter().for_each(|&source| needed_by[source].push(node));
    }
    let mut ready: BTreeSet<usize> = (0..n).filter(|&k| waits_for[k] == 0).collect();
    let mut done = vec![false; n];
    let mut order = Vec::with_capacity(n);
    // the world last of those that are ready: everything that does not depend on its accelerations comes before it
    while let Some(&next) = ready.iter().find(|&&k| k != LATE).or(ready.first()) {
        ready.remove(&next);
        done[next] = true;
        order.push(next);
        for &node in &needed_by[next] {
            waits_for[node] -= 1;
            if waits_for[node] == 0 {
                ready.insert(node);
            }
        }
    }
    if order.len() == n { Ok(order) } else { Err(loops(flat, &needs, done)) }
}

/// Nodes whose outputs a node's outputs depend on at once.
fn needed(flat: &Flat, node: usize) -> Vec<usize> {
    if node == LATE && flat.nodes[LATE].output_names.is_empty() {
        return Vec::new();
    }
    let inputs = flat.nodes[node].inputs.iter().enumerate();
    inputs.filter(|(k, _)| flat.has_direct_feedthrough(node, *k)).map(|(_, input)| input.node).collect()
}

/// One loop for each knot of blocks that wait for each other.
fn loops(flat: &Flat, needs: &[Vec<usize>], mut done: Vec<bool>) -> Vec<Diagnostic> {
    leave_out_followers(needs, &mut done);
    let done = &done[..];
    let mut seen = done.to_vec();
    let mut problems = Vec::new();
    for start in 0..needs.len() {
        if seen[start] {
            continue;
        }
        if let Some(cycle) = shortest_cycle(start, needs, done)
            && !cycle.iter().any(|&k| seen[k])
        {
            cycle.iter().for_each(|&k| seen[k] = true);
            problems.push(describe(flat, &cycle));
        }
    }
    problems
}

/// Removes nodes that only wait for a loop: again and again those that no waiting node needs.
fn leave_out_followers(needs: &[Vec<usize>], done: &mut [bool]) {
    let mut n_users = vec![0; needs.len()];
    let waiting = (0..needs.len()).filter(|&k| !done[k]);
    waiting.for_each(|k| needs[k].iter().for_each(|&source| n_users[source] += 1));
    let mut unused: Vec<usize> = (0..needs.len()).filter(|&k| !done[k] && n_users[k] == 0).collect();
    while let Some(node) = unused.pop() {
        done[node] = true;
        for &source in needs[node].iter().filter(|&&s| !done[s]) {
            n_users[source] -= 1;
            if n_users[source] == 0 && !done[source] {
                unused.push(source);
            }
        }
    }
}

/// The shortest way from a node back to itself against the wires, given in the direction of the wires.
fn shortest_cycle(start: usize, needs: &[Vec<usize>], done: &[bool]) -> Option<Vec<usize>> {
    let mut reached_from: Vec<Option<usize>> = vec![None; needs.len()];
    let mut queue = std::collections::VecDeque::from([start]);
    while let Some(node) = queue.pop_front() {
        for &source in needs[node].iter().filter(|&&s| !done[s] && s != EARLY) {
            if source == start {
                let mut cycle = vec![start];
                let mut at = node;
                while at != start {
                    cycle.push(at);
                    at = reached_from[at].expect("reached from somewhere");
                }
                return Some(cycle);
            }
            if reached_from[source].is_none() {
                reached_from[source] = Some(node);
                queue.push_back(source);
            }
        }
    }
    None
}

fn describe(flat: &Flat, cycle: &[usize]) -> Diagnostic {
    let first = cycle.iter().copied().min_by_key(|&k| if k == LATE { usize::MAX } else { k }).unwrap_or(cycle[0]);
    let turn = cycle.iter().position(|&k| k == first).unwrap_or(0);
    let names = cycle[turn..]
        .iter()
        .chain(&cycle[..=turn])
        .map(|&k| if k == LATE { "world's accelerations" } else { &flat.nodes[k].path });
    let names: Vec<&str> = names.collect();
    let message = format!("algebraic loop: {}", names.join(" -> "));
    let help = "each of these needs the output of the one before it at the same instant. Break the loop with a block that does not \
                pass its input on at once: `unit-delay` (one sample), or `low-pass` or `integrator` (continuous)";
    Diagnostic { place: flat.nodes[first].place.clone(), message, help: help.into() }
}

//! Columns: which wires are feedback, and how far right each node stands.
//!
//! Wires that leave the world for what leads back to it are feedback; of the cycles that remain, the wires that close
//! them in a depth-first search from the sources. All others go right, by at least one column, and are together as
//! short as possible.

use super::graph::{Graph, Shape};
use super::settle::{Gap, Pull, settle};

/// Columns of the nodes.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    /// By node.
    pub layer: Vec<usize>,
    /// By net, by target: goes back.
    pub is_feedback: Vec<Vec<bool>>,
}

impl Layers {
    pub fn new(graph: &Graph) -> Self {
        let is_feedback = feedback(graph);
        let n = graph.nodes.len();
        let mut gaps = Vec::new();
        let mut pulls = Vec::new();
        for (net, backs) in graph.nets.iter().zip(&is_feedback) {
            for (to, _) in net.to.iter().zip(backs).filter(|(_, back)| !**back) {
                let (a, b) = (net.from.node, to.node);
                gaps.push(Gap { a, b, least: 1 });
                // bars stand close to what they feed
                let weight = if graph.nodes[a].shape == Shape::Bar { 8 } else { 2 };
                pulls.push(Pull { a, b, rest: 1, weight });
            }
        }
        let mut layer = vec![0; n];
        // longest paths: at most one round for each node
        for _ in 0..n {
            for gap in &gaps {
                layer[gap.b] = layer[gap.b].max(layer[gap.a] + gap.least);
            }
        }
        settle(&mut layer, &pulls, &gaps);
        let first = layer.iter().copied().min().unwrap_or(0);
        let last = layer.iter().copied().max().unwrap_or(0);
        for (node, layer) in graph.nodes.iter().zip(&mut layer) {
            // ports of the diagram stand at its edges
            if node.shape == Shape::Terminal {
                *layer = if node.inputs.is_empty() { first } else { last };
            }
        }
        let is_lone =
            |k: usize| graph.nodes[k].shape != Shape::Terminal && !gaps.iter().any(|gap| gap.a == k || gap.b == k);
        for k in (0..n).filter(|&k| is_lone(k)) {
            layer[k] = first;
        }
        Self { layer: layer.iter().map(|l| (l - first) as usize).collect(), is_feedback }
    }
}

fn feedback(graph: &Graph) -> Vec<Vec<bool>> {
    let n = graph.nodes.len();
    let mut is_back: Vec<Vec<bool>> = graph.nets.iter().map(|net| vec![false; net.to.len()]).collect();
    // nets that leave a node
    let mut leaving = vec![Vec::new(); n];
    for (k, net) in graph.nets.iter().enumerate() {
        leaving[net.from.node].push(k);
    }
    if let Some(world) = graph.nodes.iter().position(|node| node.shape == Shape::World) {
        let leads = leads_to(graph, world);
        for &net in &leaving[world] {
            for (to, back) in graph.nets[net].to.iter().zip(&mut is_back[net]) {
                *back = leads[to.node];
            }
        }
    }
    let mut is_fed = vec![false; n];
    for (net, backs) in graph.nets.iter().zip(&is_back) {
        for (to, _) in net.to.iter().zip(backs).filter(|(_, back)| !**back) {
            is_fed[to.node] = true;
        }
    }
    let mut search = Search { graph, leaving: &leaving, is_back, mark: vec![Mark::New; n] };
    let sources = (0..n).filter(|&k| !is_fed[k]);
    for k in sources.chain(0..n) {
        search.visit(k);
    }
    search.is_back
}

/// Nodes from which wires lead to a node, itself among them.
fn leads_to(graph: &Graph, node: usize) -> Vec<bool> {
    let mut leads = vec![false; graph.nodes.len()];
    leads[node] = true;
    for _ in 0..graph.nodes.len() {
        for net in &graph.nets {
            leads[net.from.node] |= net.to.iter().any(|to| leads[to.node]);
        }
    }
    leads
}

#[derive(Clone, Copy, PartialEq)]
enum Mark {
    New,
    Open,
    Done,
}

struct Search<'a> {
    graph: &'a Graph,
    leaving: &'a [Vec<usize>],
    is_back: Vec<Vec<bool>>,
    mark: Vec<Mark>,
}

impl Search<'_> {
    fn visit(&mut self, node: usize) {
        if self.mark[node] != Mark::New {
            return;
        }
        self.mark[node] = Mark::Open;
        for &net in &self.leaving[node] {
            for (k, to) in self.graph.nets[net].to.iter().enumerate() {
                if self.mark[to.node] == Mark::Open {
                    self.is_back[net][k] = true;
                } else if !self.is_back[net][k] {
                    self.visit(to.node);
                }
            }
        }
        self.mark[node] = Mark::Done;
    }
}

//! Heights: sides of the circles' inputs, the ways of feedback wires, and as straight wires as there can be.

use super::graph::{Graph, Shape};
use super::layers::Layers;
use super::order::{Link, Sketch};
use super::settle::{Gap, Pull, settle};
use super::size::{Extent, HEADING, ROW, Side};

/// Room between two things in a column, and beside a wire that passes.
const BETWEEN: i64 = 16;
const BESIDE: i64 = 11;

/// Heights of all cells.
#[derive(Clone, Debug)]
pub(super) struct Heights {
    /// Upper edge of the outline, by cell.
    pub top: Vec<i64>,
    /// By node.
    pub extents: Vec<Extent>,
    /// By net: its feedback runs above the blocks.
    pub is_above: Vec<bool>,
}

impl Heights {
    pub fn new(graph: &mut Graph, layers: &Layers, sketch: &mut Sketch) -> Self {
        order_world(graph, layers, sketch);
        let is_above = (0..graph.nets.len()).map(|net| runs_above(graph, layers, sketch, net)).collect::<Vec<_>>();
        let extents = (0..graph.nodes.len())
            .map(|node| Extent::new(graph, node, &sides(graph, sketch, &is_above, node)))
            .collect();
        let mut heights = Self { top: vec![0; sketch.cells.len()], extents, is_above };
        heights.settle(graph, sketch);
        heights
    }

    /// Height of an end of a link.
    pub fn output(&self, cell: usize, port: usize) -> i64 {
        self.top[cell] + self.extents.get(cell).map_or(0, |extent| extent.outputs[port])
    }

    pub fn input(&self, cell: usize, port: usize) -> i64 {
        self.top[cell] + self.extents.get(cell).map_or(0, |extent| extent.inputs[port].1)
    }

    /// Upper and lower end of what a cell keeps free.
    pub fn span(&self, cell: usize) -> (i64, i64) {
        let (above, below) = self.extents.get(cell).map_or((0, 0), Extent::span);
        (self.top[cell] + above, self.top[cell] + below)
    }

    fn settle(&mut self, graph: &Graph, sketch: &Sketch) {
        let mut gaps = Vec::new();
        let mut pulls = Vec::new();
        for pair in sketch.columns.iter().flat_map(|column| column.windows(2)) {
            let (upper, lower) = (self.span(pair[0]).1, self.span(pair[1]).0);
            let passes = pair.iter().any(|&cell| sketch.cells[cell].node.is_none());
            let room = if passes { BESIDE } else { BETWEEN };
            let gap = Gap { a: pair[0], b: pair[1], least: upper - lower + room };
            gaps.push(gap);
            // a little, so that what has no wire between does not drift apart
            pulls.push(Pull { a: gap.a, b: gap.b, rest: gap.least, weight: 1 });
        }
        let mut start = vec![0; sketch.cells.len()];
        for gap in &gaps {
            start[gap.b] = start[gap.a] + gap.least;
        }
        let world = graph.nodes.iter().position(|node| node.shape == Shape::World);
        if let Some(world) = world {
            self.free_ports(world, sketch, &mut start, &mut pulls, &mut gaps);
        }
        for link in &sketch.links {
            let weight = self.weight(sketch, link);
            if Some(link.to) == world {
                // the way to the plant is the main one: where an output feeds several, this one is straight
                let weight = weight + 15;
                let b = sketch.cells.len() + link.in_port;
                pulls.push(Pull { a: link.from, b, rest: self.output(link.from, link.out_port), weight });
            } else {
                let rest = self.output(link.from, link.out_port) - self.input(link.to, link.in_port);
                pulls.push(Pull { a: link.from, b: link.to, rest, weight });
            }
        }
        settle(&mut start, &pulls, &gaps);
        let ports = start.split_off(sketch.cells.len());
        self.top = start;
        if let Some(world) = world {
            let inputs: Vec<i64> = ports.iter().map(|y| y - self.top[world]).collect();
            self.extents[world].stretch(&inputs);
            if !sketch.links.iter().any(|link| link.from == world) {
                self.extents[world].spread_outputs();
            }
        }
    }

    /// The world's inputs may move apart, so that wires come straight: things of their own behind the cells.
    fn free_ports(
        &self,
        world: usize,
        sketch: &Sketch,
        start: &mut Vec<i64>,
        pulls: &mut Vec<Pull>,
        gaps: &mut Vec<Gap>,
    ) {
        let n_ports = self.extents[world].inputs.len();
        let column = &sketch.columns[sketch.cells[world].column];
        let below = column.iter().skip_while(|cell| **cell != world).nth(1).copied();
        for port in 0..n_ports {
            let b = sketch.cells.len() + port;
            let (a, least) = if port == 0 { (world, HEADING + ROW / 2 - 4) } else { (b - 1, ROW) };
            gaps.push(Gap { a, b, least });
            pulls.push(Pull { a, b, rest: least, weight: 3 });
            start.push(start[a] + least);
        }
        if let Some(below) = below.filter(|_| n_ports > 0) {
            let least = ROW / 2 + self.extents[world].below + BETWEEN - self.span(below).0;
            let last = sketch.cells.len() + n_ports - 1;
            let shift = (start[last] + least - start[below]).max(0);
            gaps.push(Gap { a: last, b: below, least });
            for cell in column.iter().skip_while(|cell| **cell != below) {
                start[*cell] += shift;
            }
        }
    }

    /// Weight of a link's straightness: greatest for those that pass columns, least for those that bend anyway.
    fn weight(&self, sketch: &Sketch, link: &Link) -> i64 {
        let passes = [link.from, link.to].iter().filter(|&&cell| sketch.cells[cell].node.is_none()).count();
        let entry = sketch.cells[link.to].node.map(|node| (self.extents[node].inputs[link.in_port].0, node));
        match entry {
            Some((Side::Above | Side::Below, _)) => 4,
            Some((_, node)) if self.extents[node].inputs.len() == 1 => [46, 60][passes.min(1)],
            Some(_) => [40, 42][passes.min(1)],
            None => [36, 36, 80][passes],
        }
    }
}

/// Lists the world's ports in the order of what they are wired to.
fn order_world(graph: &mut Graph, layers: &Layers, sketch: &mut Sketch) {
    let Some(world) = graph.nodes.iter().position(|node| node.shape == Shape::World) else { return };
    let rank = sketch.ranks();
    let n_in = graph.nodes[world].inputs.len();
    let mut inputs: Vec<usize> = (0..n_in).collect();
    inputs.sort_by_key(|port| {
        let link = sketch.links.iter().find(|link| link.to == world && link.in_port == *port);
        link.map(|link| (rank[link.from], link.out_port))
    });
    let mut outputs: Vec<usize> = (0..graph.nodes[world].outputs.len()).collect();
    outputs.sort_by_key(|port| {
        let net = graph.nets.iter().find(|net| net.from.node == world && net.from.port == *port);
        net.and_then(|net| net.to.iter().map(|to| (layers.layer[to.node], rank[to.node], to.port)).min())
    });
    let place = |order: &[usize], port: usize| order.iter().position(|old| *old == port).unwrap_or(port);
    for net in &mut graph.nets {
        if net.from.node == world {
            net.from.port = place(&outputs, net.from.port);
        }
        for to in net.to.iter_mut().filter(|to| to.node == world) {
            to.port = place(&inputs, to.port);
        }
    }
    for link in &mut sketch.links {
        if link.from == world {
            link.out_port = place(&outputs, link.out_port);
        }
        if link.to == world {
            link.in_port = place(&inputs, link.in_port);
        }
    }
    let node = &mut graph.nodes[world];
    node.inputs = inputs.iter().map(|&port| node.inputs[port].clone()).collect();
    node.outputs = outputs.iter().map(|&port| node.outputs[port].clone()).collect();
}

/// Feedback runs above if all that it feeds is uppermost in a column of several, and below else.
fn runs_above(graph: &Graph, layers: &Layers, sketch: &Sketch, net: usize) -> bool {
    let is_uppermost = |node: usize| {
        let column = &sketch.columns[layers.layer[node]];
        let mut nodes = column.iter().filter(|cell| sketch.cells[**cell].node.is_some());
        column.first() == Some(&node) && nodes.next() == Some(&node) && nodes.next().is_some()
    };
    let net_ref = &graph.nets[net];
    let is_first_exit = graph.nodes[net_ref.from.node].outputs.len() > 1 && net_ref.from.port == 0;
    let source_column = &sketch.columns[layers.layer[net_ref.from.node]];
    let is_source_first = source_column.first() == Some(&net_ref.from.node);
    let mut backs = net_ref.to.iter().zip(&layers.is_feedback[net]).filter(|(_, back)| **back).peekable();
    backs.peek().is_some()
        && is_source_first
        && (is_first_exit || source_column.len() > 1)
        && backs.all(|(to, _)| is_uppermost(to.node))
}

/// Sides at which the inputs of a node enter: all at the left, but of circles.
fn sides(graph: &Graph, sketch: &Sketch, is_above: &[bool], node: usize) -> Vec<Side> {
    let n = graph.nodes[node].inputs.len();
    let mut sides = vec![Side::Left; n];
    if !matches!(graph.nodes[node].shape, Shape::Sum | Shape::Product) || !(2..=3).contains(&n) {
        return sides;
    }
    let rank = sketch.ranks();
    // where each input comes from: heights of sources from above to below, feedback outermost
    let mut comes: Vec<(i64, usize)> = (0..n)
        .map(|port| {
            let link = sketch.links.iter().find(|link| link.to == node && link.in_port == port);
            let forward = link.map(|link| (rank[link.from] * 1000 + link.out_port) as i64);
            let net = graph.nets.iter().position(|net| net.to.iter().any(|to| (to.node, to.port) == (node, port)));
            let back = net.map_or(500_000, |net| if is_above[net] { -1_000_000 } else { 1_000_000 });
            (forward.unwrap_or(back), port)
        })
        .collect();
    comes.sort_unstable();
    let is_back = |height: i64| height.abs() == 1_000_000;
    match comes[..] {
        [(first, a), (_, b)] if (b == 0 && !is_back(comes[1].0)) || is_back(first) => {
            sides[a] = Side::Above;
            sides[b] = if is_back(comes[1].0) && is_back(first) { Side::Below } else { Side::Left };
        }
        [_, (_, b)] => sides[b] = Side::Below,
        [(_, a), _, (_, c)] => {
            sides[a] = Side::Above;
            sides[c] = Side::Below;
        }
        _ => {}
    }
    sides
}

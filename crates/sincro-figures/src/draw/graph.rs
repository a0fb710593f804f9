//! Graph of one diagram: nodes with ports, and nets from one output to all inputs that it feeds.
//!
//! Wires from several sources become a small bar in front of their target. Components of an output, such as `q[1]`,
//! leave through an exit of their own. Ends that name nothing get a dashed box, so that an unfinished diagram can be
//! looked at too.

use std::ops::Range;

use sincro_blocks::diagram::{Content, Diagram, Entry};
use sincro_blocks::endpoint::{Endpoint, WORLD};

/// Nodes and nets of one diagram.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Graph {
    pub nodes: Vec<Node>,
    pub nets: Vec<Net>,
}

/// Something with an outline.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    pub shape: Shape,
    /// Stands inside.
    pub label: String,
    /// Stands below, or above where a wire comes in from below; may be empty.
    pub name: String,
    pub inputs: Vec<Port>,
    pub outputs: Vec<Port>,
}

/// A place where wires end or begin.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Port {
    pub name: String,
    /// Components that leave here, if not all.
    pub range: Option<Range<usize>>,
}

/// Outlines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Box,
    /// A circle with signs at its inputs.
    Sum,
    Product,
    /// A triangle.
    Gain,
    /// A black bar that joins or splits vectors.
    Bar,
    Scope,
    Saturation,
    World,
    /// A diagram inside: double border.
    Inner,
    /// A port of the diagram itself.
    Terminal,
    /// A name that nothing has.
    Missing,
}

/// An end of a wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pin {
    pub node: usize,
    pub port: usize,
}

/// One output and the inputs that it feeds, in the order of the wires.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Net {
    pub from: Pin,
    pub to: Vec<Pin>,
}

impl Graph {
    /// Graph of a diagram; `world` labels the box of the world.
    pub fn new(diagram: &Diagram, world: &str) -> Self {
        let mut graph = Self::default();
        let terminal = |name: &String, has_input: bool| Node {
            inputs: vec![Port::default(); usize::from(has_input)],
            outputs: vec![Port::default(); usize::from(!has_input)],
            ..Node::new(Shape::Terminal, name, "")
        };
        graph.nodes.extend(diagram.inputs.iter().map(|name| terminal(name, false)));
        graph.nodes.extend(diagram.entries.iter().map(Node::of));
        graph.nodes.extend(diagram.outputs.iter().map(|name| terminal(name, true)));
        let mut finder = Finder { diagram, world, graph };
        for wire in &diagram.wires {
            let to = finder.input(&wire.to);
            let from: Vec<Pin> = wire.from.iter().map(|end| finder.output(end)).collect();
            match from[..] {
                [one] => finder.graph.connect(one, to),
                _ => finder.graph.connect_all(&from, to),
            }
        }
        (0..finder.graph.nodes.len()).for_each(|node| finder.graph.sort_outputs(node));
        finder.graph
    }

    /// Components stand where their port stood, instead of it if nothing takes the whole.
    fn sort_outputs(&mut self, node: usize) {
        let old = self.nodes[node].outputs.clone();
        let is_used = |port: usize| self.nets.iter().any(|net| net.from == Pin { node, port });
        let has_parts = |port: usize| old.iter().any(|other| other.name == old[port].name && other.range.is_some());
        let mut order: Vec<usize> = (0..old.len()).filter(|&port| is_used(port) || !has_parts(port)).collect();
        let base = |port: usize| old.iter().position(|other| other.name == old[port].name);
        order.sort_by_key(|&port| (base(port), old[port].range.as_ref().map(|range| (range.start, range.end))));
        for net in self.nets.iter_mut().filter(|net| net.from.node == node) {
            net.from.port = order.iter().position(|port| *port == net.from.port).unwrap_or(0);
        }
        self.nodes[node].outputs = order.iter().map(|&port| old[port].clone()).collect();
    }

    fn connect(&mut self, from: Pin, to: Pin) {
        match self.nets.iter_mut().find(|net| net.from == from) {
            Some(net) => net.to.push(to),
            None => self.nets.push(Net { from, to: vec![to] }),
        }
    }

    fn connect_all(&mut self, from: &[Pin], to: Pin) {
        let node = self.nodes.len();
        let inputs = vec![Port::default(); from.len()];
        self.nodes.push(Node { inputs, outputs: vec![Port::default()], ..Node::new(Shape::Bar, "", "") });
        for (port, &source) in from.iter().enumerate() {
            self.connect(source, Pin { node, port });
        }
        self.connect(Pin { node, port: 0 }, to);
    }
}

impl Node {
    fn new(shape: Shape, label: &str, name: &str) -> Self {
        Self { shape, label: label.into(), name: name.into(), inputs: Vec::new(), outputs: Vec::new() }
    }

    fn of(entry: &Entry) -> Self {
        let ports = |names: Vec<String>| names.into_iter().map(|name| Port { name, range: None }).collect();
        match &entry.content {
            Content::Diagram(definition, inner) => Self {
                inputs: ports(inner.inputs.clone()),
                outputs: ports(inner.outputs.clone()),
                ..Self::new(Shape::Inner, definition, &entry.name)
            },
            Content::Block(block) => {
                let (kind, label, found) = (block.kind().name, block.label(), block.ports());
                let label = if label.is_empty() { kind } else { &label };
                Self {
                    inputs: ports(found.inputs),
                    outputs: ports(found.outputs),
                    ..Self::new(Shape::of(kind, label), label, &entry.name)
                }
            }
        }
    }
}

impl Shape {
    fn of(kind: &str, label: &str) -> Self {
        match kind {
            "sum" => Self::Sum,
            "product" | "multiply" => Self::Product,
            "gain" if label.chars().count() <= 12 => Self::Gain,
            "mux" | "demux" => Self::Bar,
            "scope" => Self::Scope,
            "saturation" => Self::Saturation,
            _ => Self::Box,
        }
    }
}

/// Finds the ends of wires, and makes what is not there.
struct Finder<'a> {
    diagram: &'a Diagram,
    world: &'a str,
    graph: Graph,
}

impl Finder<'_> {
    fn input(&mut self, end: &Endpoint) -> Pin {
        let node = self.node(end, true);
        let shape = self.graph.nodes[node].shape;
        let port = port(&mut self.graph.nodes[node].inputs, &end.port, shape == Shape::World);
        Pin { node, port }
    }

    fn output(&mut self, end: &Endpoint) -> Pin {
        let node = self.node(end, false);
        let node_ref = &mut self.graph.nodes[node];
        let whole = port(&mut node_ref.outputs, &end.port, node_ref.shape == Shape::World);
        let wanted = Port { range: end.range.clone(), ..node_ref.outputs[whole].clone() };
        let port = match node_ref.outputs.iter().position(|port| *port == wanted) {
            Some(at) => at,
            None => {
                node_ref.outputs.push(wanted);
                node_ref.outputs.len() - 1
            }
        };
        Pin { node, port }
    }

    fn node(&mut self, end: &Endpoint, takes: bool) -> usize {
        let (n_in, n_entries) = (self.diagram.inputs.len(), self.diagram.entries.len());
        let at = |names: &[String]| names.iter().position(|name| *name == end.block);
        let entry = self.diagram.entries.iter().position(|entry| entry.name == end.block).map(|k| n_in + k);
        let terminal = match takes {
            true => at(&self.diagram.outputs).map(|k| n_in + n_entries + k),
            false => at(&self.diagram.inputs),
        };
        if let Some(found) = if end.block == WORLD { None } else { entry.or(terminal) } {
            return found;
        }
        let (shape, label, name) = match end.block == WORLD {
            true => (Shape::World, self.world, ""),
            false => (Shape::Missing, "?", end.block.as_str()),
        };
        let made = self.graph.nodes.iter().position(|node| node.shape == shape && node.name == name);
        made.unwrap_or_else(|| {
            self.graph.nodes.push(Node::new(shape, label, name));
            self.graph.nodes.len() - 1
        })
    }
}

/// The port of a name, made if there is none; without a name the first, except of the world.
fn port(ports: &mut Vec<Port>, name: &str, is_world: bool) -> usize {
    let found = if name.is_empty() && !is_world && !ports.is_empty() {
        Some(0)
    } else {
        ports.iter().position(|port| port.name == name && (port.range.is_none() || is_world))
    };
    found.unwrap_or_else(|| {
        ports.push(Port { name: name.into(), range: None });
        ports.len() - 1
    })
}

//! Size of each node and places of its ports. Pixels, from the upper left corner of the outline.

use super::graph::{Graph, Node, Shape};
use crate::plot::text_width;

/// Font sizes `[px]`.
pub(super) const LABEL: f64 = 13.0;
pub(super) const NAME: f64 = 11.0;
pub(super) const SMALL: f64 = 9.5;

/// Diameter of a circle.
pub(super) const ROUND: i64 = 36;
/// Height of the world's heading, and distance of its ports.
pub(super) const HEADING: i64 = 30;
pub(super) const ROW: i64 = 24;
/// Distance from a circle at which a wire turns towards its top or bottom.
const APPROACH: i64 = 14;
/// Longer texts are cut in the middle.
const LONGEST: usize = 28;

/// An outline, the room that its texts need around it, and its ports.
#[derive(Clone, Debug, Default)]
pub(super) struct Extent {
    pub width: i64,
    pub height: i64,
    /// Room beside the outline.
    pub left: i64,
    pub right: i64,
    pub above: i64,
    pub below: i64,
    /// By input: side, and height at which its wire arrives.
    pub inputs: Vec<(Side, i64)>,
    /// By output: height.
    pub outputs: Vec<i64>,
    /// The name stands above.
    pub is_name_above: bool,
}

/// Side at which a wire enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Above,
    Below,
}

/// Width of text, rounded up.
pub(super) fn text(text: &str, font: f64) -> i64 {
    text_width(text, font).ceil() as i64
}

/// A text that is not too long: cut in the middle.
pub(super) fn short(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    if chars.len() <= LONGEST {
        return text.into();
    }
    let head: String = chars[..LONGEST / 2].iter().collect();
    let tail: String = chars[chars.len() - LONGEST / 2 + 1..].iter().collect();
    format!("{head}…{tail}")
}

/// Label beside the beginning of a wire of which only components leave.
pub(super) fn note(node: &Node, port: usize) -> String {
    match &node.outputs[port].range {
        None => String::new(),
        Some(range) if range.len() == 1 => format!("[{}]", range.start),
        Some(range) => format!("[{}:{}]", range.start, range.end),
    }
}

/// Names of ports are shown where there are several of different names, and always of the world and inner diagrams.
pub(super) fn shows_ports(node: &Node, of_outputs: bool) -> bool {
    let ports = if of_outputs { &node.outputs } else { &node.inputs };
    match node.shape {
        Shape::World | Shape::Inner => true,
        Shape::Box | Shape::Missing => ports.iter().any(|port| port.name != ports[0].name),
        _ => false,
    }
}

impl Extent {
    /// Extent of a node whose inputs enter at these sides.
    pub fn new(graph: &Graph, node: usize, sides: &[Side]) -> Self {
        let node = &graph.nodes[node];
        let (width, height) = outline(node);
        let mut extent = Self { width, height, ..Self::default() };
        extent.is_name_above = sides.contains(&Side::Below);
        extent.place_inputs(node, sides);
        let top = if node.shape == Shape::World { HEADING } else { 0 };
        extent.outputs = spread(node.outputs.len(), top, height);
        extent.reserve(node, sides);
        extent
    }

    fn place_inputs(&mut self, node: &Node, sides: &[Side]) {
        let top = if node.shape == Shape::World { HEADING } else { 0 };
        let n_left = sides.iter().filter(|side| **side == Side::Left).count();
        let mut left = spread(n_left, top, self.height).into_iter();
        self.inputs = sides
            .iter()
            .map(|side| match side {
                Side::Left => (*side, left.next().unwrap_or(0)),
                Side::Above => (*side, -APPROACH),
                Side::Below => (*side, self.height + APPROACH),
            })
            .collect();
    }

    /// Room for name, notes and wires that enter from above or below.
    fn reserve(&mut self, node: &Node, sides: &[Side]) {
        let notes = (0..node.outputs.len()).map(|port| text(&note(node, port), SMALL)).max().unwrap_or(0);
        let over = (text(&short(&node.name), NAME) + 4 - self.width).max(0);
        self.left = over / 2;
        self.right = (over - over / 2).max(if notes > 0 { notes + 6 } else { 0 });
        (self.above, self.below) = (4, 4);
        if !node.name.is_empty() {
            *(if self.is_name_above { &mut self.above } else { &mut self.below }) = 18;
        }
        if sides.contains(&Side::Above) {
            // the name, if above too, stands beside the wire
            self.above = self.above.max(APPROACH + 6);
            if self.is_name_above {
                self.above = APPROACH + 6;
                self.right = self.right.max(text(&short(&node.name), NAME) + 6 - self.width / 2);
            }
        }
        if sides.contains(&Side::Below) {
            self.below = APPROACH + 6;
        }
    }

    /// Puts the inputs at these heights, and makes room for them and the outputs.
    pub fn stretch(&mut self, inputs: &[i64]) {
        self.height = self.height.max(inputs.last().map_or(0, |y| y + ROW / 2));
        self.inputs = inputs.iter().map(|y| (Side::Left, *y)).collect();
    }

    /// Puts the outputs evenly below the heading, as far apart as the height allows.
    pub fn spread_outputs(&mut self) {
        self.outputs = spread(self.outputs.len(), HEADING, self.height);
    }

    /// Height that one must keep free, from the outline's top: negative above it.
    pub fn span(&self) -> (i64, i64) {
        (-self.above, self.height + self.below)
    }
}

/// Width and height of the outline.
fn outline(node: &Node) -> (i64, i64) {
    let label = text(&short(&node.label), LABEL);
    let n = node.inputs.len().max(node.outputs.len()) as i64;
    match node.shape {
        Shape::Sum if node.inputs.len() > 3 => (ROUND, 20 * n + 8),
        Shape::Product if node.inputs.len() > 3 => (ROUND, 20 * n + 8),
        Shape::Sum | Shape::Product => (ROUND, ROUND),
        Shape::Gain => (((label + 12) * 100 / 68).max(48), 48),
        Shape::Bar => (6, (18 * n).max(30)),
        Shape::Terminal => (label + 22, 24),
        Shape::Scope | Shape::Saturation => (46, (20 * n).max(40)),
        Shape::World => {
            let heading = text(&node.label, LABEL) + 24;
            ((port_room(node) + 20).max(heading).max(90), HEADING + ROW * n.max(1))
        }
        Shape::Box | Shape::Inner | Shape::Missing => {
            let inside = if port_room(node) > 0 { port_room(node) + 12 } else { 24 };
            let extra = if node.shape == Shape::Inner { 8 } else { 0 };
            ((label + inside + extra).max(52), (22 * n + 8).max(40))
        }
    }
}

/// Width of the names of ports, both sides together.
fn port_room(node: &Node) -> i64 {
    let widest = |of_outputs: bool| {
        let ports = if of_outputs { &node.outputs } else { &node.inputs };
        let widths = ports.iter().map(|port| text(&short(&port.name), SMALL + 0.5) + 10);
        if shows_ports(node, of_outputs) { widths.max().unwrap_or(0) } else { 0 }
    };
    widest(false) + widest(true)
}

/// Heights of `n` ports, evenly between top and bottom.
fn spread(n: usize, top: i64, bottom: i64) -> Vec<i64> {
    let n = n as i64;
    (0..n).map(|k| top + (bottom - top) * (2 * k + 1) / (2 * n)).collect()
}

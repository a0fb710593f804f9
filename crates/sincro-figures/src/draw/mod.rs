//! Block diagrams as SVG text: laid out like a figure in a control textbook, from the diagram alone.
//!
//! Layered after Sugiyama, Tagawa and Toda (*Methods for Visual Understanding of Hierarchical System Structures*,
//! 1981), pass by pass: `graph` (nodes and nets), `layers` (feedback and columns), `order` (few crossings),
//! `place` (heights), `route` with `track` (wires), then `shape` and `wire` write. `settle` solves columns
//! and heights exactly. Own code, not a crate: those there are draw curves between boxes, where ports, trunks, lanes
//! and upright tracks are the point here.
//!
//! The same diagram gives the same bytes: whole pixels, no maps in hash order.

mod canvas;
mod graph;
mod layers;
mod order;
mod place;
mod route;
mod settle;
mod shape;
mod size;
#[cfg(test)]
mod tests;
mod track;
mod wire;

use std::collections::BTreeMap;

use sincro_blocks::diagram::{Content, Diagram};

use self::canvas::Canvas;
use self::graph::Graph;
use self::place::Heights;
use self::route::Layout;
use crate::plot::{escape, with_light_colors};

/// Rules for diagrams within a page; they use the variables of `plot::PAGE_CSS`, which the page must have too.
pub(crate) const DRAW_CSS: &str = include_str!("draw.css");

/// Options of a drawing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Options {
    /// Stands above the picture, and is read out for it; may be empty.
    pub title: String,
    /// Label of the world's box, such as the scene's name; `World` if empty.
    pub world: String,
    /// For a page that carries [`DRAW_CSS`], not a file of its own.
    pub is_inline: bool,
    /// Widths of outputs by `block.port`, in figures within by `path/block.port`; wires of more than one number are
    /// drawn thicker.
    pub widths: BTreeMap<String, usize>,
}

/// Font size of titles and the height of a row with one.
const TITLE: f64 = 15.0;
const TITLE_ROW: i64 = 30;

/// A figure of one diagram: what stands above it, and what is under its names.
struct Figure<'a> {
    title: String,
    /// Path of names in front of those of its blocks.
    path: String,
    diagram: &'a Diagram,
}

/// Layouts of the diagrams drawn so far: most diagrams of variants look like that of the main run.
#[derive(Debug, Default)]
pub(crate) struct Layouts(Vec<Placed>);

/// A diagram with all its places.
#[derive(Debug)]
struct Placed {
    /// The graph of the diagram, before its ports were put in order.
    unordered: Graph,
    graph: Graph,
    layout: Layout,
    heights: Heights,
}

impl Layouts {
    fn of(&mut self, unordered: Graph) -> &Placed {
        let known = self.0.iter().position(|placed| placed.unordered == unordered);
        let at = known.unwrap_or_else(|| {
            let mut graph = unordered.clone();
            let (layout, heights) = Layout::new(&mut graph);
            self.0.push(Placed { unordered, graph, layout, heights });
            self.0.len() - 1
        });
        &self.0[at]
    }
}

/// Draws a diagram, and below it each diagram that stands inside, once for each definition. Layouts that are known are
/// not found again.
#[must_use]
pub(crate) fn draw(diagram: &Diagram, options: &Options, layouts: &mut Layouts) -> String {
    let mut canvas = Canvas::default();
    let (mut width, mut height) = (0, 0);
    for figure in figures(diagram, options) {
        let world = if options.world.is_empty() { "World" } else { &options.world };
        let Placed { graph, layout, heights, .. } = layouts.of(Graph::new(figure.diagram, world));
        let heading = if figure.title.is_empty() { 0 } else { TITLE_ROW };
        if heading > 0 {
            canvas.text.push_str("<g font-weight=\"600\">\n");
            canvas.words((14.0, height as f64 + 20.0), "start", TITLE, "", &figure.title);
            canvas.close();
            width = width.max(size::text(&figure.title, TITLE * 1.06) + 28);
        }
        canvas.text.push_str(&format!("<g transform=\"translate(0 {})\">\n", height + heading));
        for (net, run) in graph.nets.iter().zip(&layout.runs) {
            let is_wide = is_wide(graph, net, &figure.path, options);
            if options.is_inline {
                canvas.text.push_str(&carrier(graph, net, &figure.path, run.start));
                wire::draw(&mut canvas, run, is_wide);
                canvas.close();
            } else {
                wire::draw(&mut canvas, run, is_wide);
            }
        }
        for ((node, outline), extent) in graph.nodes.iter().zip(&layout.outlines).zip(&heights.extents) {
            shape::draw(&mut canvas, node, outline, extent);
        }
        canvas.close();
        (width, height) = (width.max(layout.width), height + heading + layout.height);
    }
    document(&canvas.text, width, height, options)
}

/// The diagram itself, then those inside in the order in which they are met.
fn figures<'a>(diagram: &'a Diagram, options: &Options) -> Vec<Figure<'a>> {
    let mut all = vec![Figure { title: options.title.clone(), path: String::new(), diagram }];
    let mut seen: Vec<&str> = Vec::new();
    let mut next = 0;
    while next < all.len() {
        let (outer, path) = (all[next].diagram, all[next].path.clone());
        for entry in &outer.entries {
            if let Content::Diagram(definition, inner) = &entry.content
                && !seen.contains(&definition.as_str())
            {
                seen.push(definition);
                all.push(Figure { title: definition.clone(), path: format!("{path}{}/", entry.name), diagram: inner });
            }
        }
        next += 1;
    }
    all
}

/// Opens the group of a wire within a page: which signal it carries (`block.port`, or `block` where it has one output),
/// and where it starts.
fn carrier(graph: &Graph, net: &graph::Net, path: &str, (x, y): route::Point) -> String {
    let node = &graph.nodes[net.from.node];
    let port = &node.outputs[net.from.port].name;
    let (signal, block) = match node.shape {
        graph::Shape::World => (port.clone(), String::new()),
        _ => (format!("{path}{}.{port}", node.name), format!("{path}{}", node.name)),
    };
    let part = node.outputs[net.from.port].range.as_ref();
    let part = part.map_or(String::new(), |part| format!(" data-part=\"{} {}\"", part.start, part.end));
    format!("<g data-signal=\"{}\" data-block=\"{}\" data-at=\"{x} {y}\"{part}>\n", escape(&signal), escape(&block))
}

fn is_wide(graph: &Graph, net: &graph::Net, path: &str, options: &Options) -> bool {
    let node = &graph.nodes[net.from.node];
    let port = &node.outputs[net.from.port];
    match &port.range {
        Some(range) => range.len() > 1,
        // what joins several is wide by itself
        None if node.shape == graph::Shape::Bar && node.name.is_empty() => true,
        None if node.shape == graph::Shape::World => options.widths.get(&port.name).is_some_and(|width| *width > 1),
        None => {
            let full = format!("{path}{}.{}", node.name, port.name);
            let alone = format!("{path}{}", node.name);
            let width = options.widths.get(&full).or_else(|| options.widths.get(&alone));
            width.is_some_and(|width| *width > 1)
        }
    }
}

fn document(content: &str, width: i64, height: i64, options: &Options) -> String {
    let title = escape(if options.title.is_empty() { "block diagram" } else { &options.title });
    let size = format!("width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\"");
    if options.is_inline {
        return format!("<svg class=\"sd\" role=\"img\" aria-label=\"{title}\" {size}>\n{content}</svg>\n");
    }
    let css = with_light_colors(DRAW_CSS);
    format!(
        concat!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"sd\" role=\"img\" {} ",
            "font-family=\"Helvetica, Arial, sans-serif\">\n<title>{}</title>\n<style>\n{}\n</style>\n",
            "<rect class=\"sd-paper\" width=\"100%\" height=\"100%\"/>\n{}</svg>\n"
        ),
        size, title, css, content
    )
}

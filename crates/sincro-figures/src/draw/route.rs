//! Routing: outlines, and wires as vertical and horizontal pieces.
//!
//! Wires turn in the channels between columns only. Feedback leaves to the right, runs back in a lane below all that it
//! passes (or above), and rises in the channel in front of its target, or straight under a circle if nothing stands
//! there.

use super::graph::{Graph, Shape};
use super::layers::Layers;
use super::order::Sketch;
use super::place::Heights;
use super::size::Side;
use super::track::{Strand, assign};

/// Distance of tracks, and of lanes.
const PITCH: i64 = 12;
/// Room between the tracks of a channel and the columns; the right one holds the arrow heads.
const BEFORE: i64 = 10;
const BEHIND: i64 = 18;
/// Around the picture.
const MARGIN: i64 = 14;

/// A place.
pub(super) type Point = (i64, i64);

/// An outline, with the room that its texts take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outline {
    pub x: i64,
    pub y: i64,
    pub width: i64,
    pub height: i64,
    /// Left, upper, right and lower end of what it keeps free.
    pub room: (i64, i64, i64, i64),
}

/// A net as it is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Run {
    /// Pieces from place to place, upright or level.
    pub pieces: Vec<(Point, Point)>,
    pub start: Point,
    /// Heads of arrows and where they come from, by target.
    pub heads: Vec<(Point, Side)>,
}

/// A diagram with all its places.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub outlines: Vec<Outline>,
    pub runs: Vec<Run>,
    pub width: i64,
    pub height: i64,
}

/// The way back of a net.
#[derive(Clone, Debug)]
struct Lane {
    net: usize,
    y: i64,
    /// Channels of the source and of the leftmost target.
    source: usize,
    first: usize,
}

impl Layout {
    pub fn new(graph: &mut Graph) -> (Self, Heights) {
        let layers = Layers::new(graph);
        let mut sketch = Sketch::new(graph, &layers);
        let heights = Heights::new(graph, &layers, &mut sketch);
        let mut router = Router::new(graph, &layers, &sketch, &heights);
        let layout = router.layout();
        (layout, heights)
    }
}

struct Router<'a> {
    graph: &'a Graph,
    layers: &'a Layers,
    sketch: &'a Sketch,
    heights: &'a Heights,
    lanes: Vec<Lane>,
    /// By channel; channel `k` is left of column `k`.
    strands: Vec<Vec<Strand>>,
    /// Left end of each channel, and of each column.
    channel_x: Vec<i64>,
    /// Left edge of each outline.
    x: Vec<i64>,
}

impl<'a> Router<'a> {
    fn new(graph: &'a Graph, layers: &'a Layers, sketch: &'a Sketch, heights: &'a Heights) -> Self {
        let strands = vec![Vec::new(); sketch.columns.len() + 1];
        Self { graph, layers, sketch, heights, lanes: Vec::new(), strands, channel_x: Vec::new(), x: Vec::new() }
    }

    fn layout(&mut self) -> Layout {
        self.find_lanes();
        self.find_strands();
        let n_tracks: Vec<usize> = self.strands.iter_mut().map(assign).collect();
        self.find_columns(&n_tracks);
        let mut runs: Vec<Run> = (0..self.graph.nets.len()).map(|net| self.run(net)).collect();
        let mut outlines: Vec<Outline> = (0..self.graph.nodes.len()).map(|node| self.outline(node)).collect();
        let (width, height) = shift_into_view(&mut outlines, &mut runs);
        Layout { outlines, runs, width, height }
    }

    /// Targets that a net goes back to.
    fn backs(&self, net: usize) -> impl Iterator<Item = (usize, usize)> {
        let targets = self.graph.nets[net].to.iter().zip(&self.layers.is_feedback[net]);
        targets.filter(|(_, back)| **back).map(|(to, _)| (to.node, to.port))
    }

    /// Returns true if feedback comes straight from its lane to a circle.
    fn is_direct(&self, net: usize, node: usize, port: usize) -> bool {
        let mut column: Vec<usize> = self.sketch.columns[self.layers.layer[node]].clone();
        column.retain(|&cell| self.sketch.cells[cell].node.is_some());
        let end = if self.heights.is_above[net] { column.first() } else { column.last() };
        let wanted = if self.heights.is_above[net] { Side::Above } else { Side::Below };
        self.heights.extents[node].inputs[port].0 == wanted && end == Some(&node)
    }

    /// Lanes, shortest first, each as near to the blocks as it can be.
    fn find_lanes(&mut self) {
        let n = self.sketch.columns.len();
        let mut lanes: Vec<Lane> = Vec::new();
        for (net, of_net) in self.graph.nets.iter().enumerate() {
            if let Some(first) = self.backs(net).map(|(node, _)| self.layers.layer[node]).min() {
                lanes.push(Lane { net, y: 0, source: self.layers.layer[of_net.from.node] + 1, first });
            }
        }
        lanes.sort_by_key(|lane| {
            let from = self.graph.nets[lane.net].from;
            let y = self.heights.output(from.node, from.port);
            (lane.source - lane.first, if self.heights.is_above[lane.net] { y } else { -y })
        });
        let ends = |column: &Vec<usize>| {
            let spans: Vec<(i64, i64)> = column.iter().map(|&cell| self.heights.span(cell)).collect();
            (spans.iter().map(|s| s.0).min().unwrap_or(0), spans.iter().map(|s| s.1).max().unwrap_or(0))
        };
        let mut skyline: Vec<(i64, i64)> = self.sketch.columns.iter().map(ends).collect();
        for lane in &mut lanes {
            // the neighbours' wires reach into the outermost channels
            let passed = lane.first.saturating_sub(1)..(lane.source + 1).min(n);
            let here = &mut skyline[passed];
            if self.heights.is_above[lane.net] {
                lane.y = here.iter().map(|ends| ends.0).min().unwrap_or(0) - PITCH;
                here.iter_mut().for_each(|ends| ends.0 = lane.y);
            } else {
                lane.y = here.iter().map(|ends| ends.1).max().unwrap_or(0) + PITCH;
                here.iter_mut().for_each(|ends| ends.1 = lane.y);
            }
        }
        self.lanes = lanes;
    }

    fn find_strands(&mut self) {
        let mut pins: Vec<(usize, usize, bool, i64)> = Vec::new();
        for link in &self.sketch.links {
            let channel = self.sketch.cells[link.to].column;
            pins.push((channel, link.net, true, self.heights.output(link.from, link.out_port)));
            pins.push((channel, link.net, false, self.heights.input(link.to, link.in_port)));
        }
        for lane in &self.lanes {
            let from = self.graph.nets[lane.net].from;
            pins.push((lane.source, lane.net, true, self.heights.output(from.node, from.port)));
            pins.push((lane.source, lane.net, true, lane.y));
            for (node, port) in self.backs(lane.net).filter(|&(node, port)| !self.is_direct(lane.net, node, port)) {
                let channel = self.layers.layer[node];
                pins.push((channel, lane.net, false, lane.y));
                pins.push((channel, lane.net, false, self.heights.input(node, port)));
                if channel > lane.first {
                    pins.push((channel, lane.net, true, lane.y));
                }
            }
        }
        for (channel, net, is_left, y) in pins {
            let here = &mut self.strands[channel];
            let at = here.iter().position(|strand| strand.net == net).unwrap_or_else(|| {
                here.push(Strand::new(net));
                here.len() - 1
            });
            let side = if is_left { &mut here[at].left } else { &mut here[at].right };
            if !side.contains(&y) {
                side.push(y);
            }
        }
    }

    fn find_columns(&mut self, n_tracks: &[usize]) {
        let mut x = 0;
        self.x = vec![0; self.graph.nodes.len()];
        let room = |node: usize| {
            let extent = &self.heights.extents[node];
            extent.left + extent.width + extent.right
        };
        for (column, cells) in self.sketch.columns.iter().enumerate() {
            self.channel_x.push(x);
            x += BEFORE + BEHIND + PITCH * (n_tracks[column] as i64 - 1).max(0);
            let nodes = || cells.iter().filter_map(|&cell| self.sketch.cells[cell].node);
            let widest = nodes().map(room).max().unwrap_or(0);
            for node in nodes() {
                let is_port = self.graph.nodes[node].shape == Shape::Terminal;
                let is_bar = self.graph.nodes[node].shape == Shape::Bar && self.graph.nodes[node].name.is_empty();
                let spare = widest - room(node);
                let shift = match is_port || is_bar {
                    true if self.graph.nodes[node].inputs.is_empty() || is_bar => spare,
                    true => 0,
                    false => spare / 2,
                };
                self.x[node] = x + shift + self.heights.extents[node].left;
            }
            x += widest;
        }
        self.channel_x.push(x);
    }

    fn track_x(&self, channel: usize, strand: &Strand) -> i64 {
        self.channel_x[channel] + BEFORE + PITCH * strand.track as i64
    }

    /// Entry of a wire into a node: the place on the outline, and the one where it arrives in the column.
    fn entry(&self, node: usize, port: usize) -> (Point, Side) {
        let (extent, top) = (&self.heights.extents[node], self.heights.top[node]);
        let middle = self.x[node] + extent.width / 2;
        match extent.inputs[port] {
            (Side::Left, y) => ((self.x[node], top + y), Side::Left),
            (Side::Above, _) => ((middle, top), Side::Above),
            (Side::Below, _) => ((middle, top + extent.height), Side::Below),
        }
    }

    fn run(&self, net: usize) -> Run {
        let from = self.graph.nets[net].from;
        let exit = self.x[from.node] + self.heights.extents[from.node].width;
        let start = (exit, self.heights.output(from.node, from.port));
        let mut run = Run { start, ..Run::default() };
        self.draw_strands(net, &mut run);
        for link in self.sketch.links.iter().filter(|link| link.net == net) {
            self.draw_link(link.from, link.out_port, link.to, link.in_port, net, &mut run);
        }
        if let Some(lane) = self.lanes.iter().find(|lane| lane.net == net) {
            self.draw_lane(lane, &mut run);
        }
        for to in &self.graph.nets[net].to {
            run.heads.push(self.entry(to.node, to.port));
        }
        run.pieces.retain(|(a, b)| a != b);
        run
    }

    /// Upright pieces, and the level ones between split strands.
    fn draw_strands(&self, net: usize, run: &mut Run) {
        for (channel, strands) in self.strands.iter().enumerate() {
            let own: Vec<&Strand> = strands.iter().filter(|strand| strand.net == net).collect();
            for strand in &own {
                let ((top, bottom), x) = (strand.span(), self.track_x(channel, strand));
                run.pieces.push(((x, top), (x, bottom)));
            }
            // split strands follow one another
            for pair in own.windows(2) {
                let level = pair[1].left[0];
                run.pieces.push(((self.track_x(channel, pair[0]), level), (self.track_x(channel, pair[1]), level)));
            }
        }
    }

    /// Level pieces from a cell to the tracks of its net and from there to the next cell.
    fn draw_link(&self, from: usize, out_port: usize, to: usize, in_port: usize, net: usize, run: &mut Run) {
        let channel = self.sketch.cells[to].column;
        let own: Vec<&Strand> = self.strands[channel].iter().filter(|strand| strand.net == net).collect();
        let (Some(first), Some(last)) = (own.first(), own.last()) else { return };
        let y = self.heights.output(from, out_port);
        let left = match self.sketch.cells[from].node {
            Some(node) => self.x[node] + self.heights.extents[node].width,
            None => self.channel_x[channel],
        };
        run.pieces.push(((left, y), (self.track_x(channel, first), y)));
        let y = self.heights.input(to, in_port);
        let x = self.track_x(channel, last);
        match self.sketch.cells[to].node {
            Some(node) => self.draw_entry(node, in_port, (x, y), run),
            None => run.pieces.push(((x, y), (self.channel_x[channel + 1], y))),
        }
    }

    fn draw_entry(&self, node: usize, port: usize, from: Point, run: &mut Run) {
        let (head, side) = self.entry(node, port);
        if side == Side::Left {
            run.pieces.push((from, head));
        } else {
            run.pieces.push((from, (head.0, from.1)));
            run.pieces.push(((head.0, from.1), head));
        }
    }

    fn draw_lane(&self, lane: &Lane, run: &mut Run) {
        let strand_x = |channel: usize, is_last: bool| {
            let mut own = self.strands[channel].iter().filter(|strand| strand.net == lane.net);
            let strand = if is_last { own.next_back() } else { own.next() };
            strand.map_or(self.channel_x[channel], |strand| self.track_x(channel, strand))
        };
        let source = strand_x(lane.source, false);
        let y_start = run.start.1;
        run.pieces.push((run.start, (source, y_start)));
        let mut end = source;
        for (node, port) in self.backs(lane.net) {
            let (head, _) = self.entry(node, port);
            if self.is_direct(lane.net, node, port) {
                run.pieces.push(((head.0, lane.y), head));
                end = end.min(head.0);
            } else {
                let x = strand_x(self.layers.layer[node], true);
                self.draw_entry(node, port, (x, self.heights.input(node, port)), run);
                end = end.min(x);
            }
        }
        run.pieces.push(((source, lane.y), (end, lane.y)));
    }

    fn outline(&self, node: usize) -> Outline {
        let (extent, x, y) = (&self.heights.extents[node], self.x[node], self.heights.top[node]);
        let (top, bottom) = self.heights.span(node);
        let room = (x - extent.left, top, x + extent.width + extent.right, bottom);
        Outline { x, y, width: extent.width, height: extent.height, room }
    }
}

/// Moves everything so that it begins at the margin, and tells how large it is.
fn shift_into_view(outlines: &mut [Outline], runs: &mut [Run]) -> (i64, i64) {
    let corners = outlines.iter().flat_map(|o| [(o.room.0, o.room.1), (o.room.2, o.room.3)]);
    let places: Vec<Point> = corners.chain(runs.iter().flat_map(|r| &r.pieces).flat_map(|p| [p.0, p.1])).collect();
    let least = |of: fn(&Point) -> i64| places.iter().map(of).min().unwrap_or(0);
    let most = |of: fn(&Point) -> i64| places.iter().map(of).max().unwrap_or(0);
    let (dx, dy) = (MARGIN - least(|p| p.0), MARGIN - least(|p| p.1));
    let size = (most(|p| p.0) + dx + MARGIN, most(|p| p.1) + dy + MARGIN);
    let shift = |p: &mut Point| *p = (p.0 + dx, p.1 + dy);
    for outline in outlines {
        (outline.x, outline.y) = (outline.x + dx, outline.y + dy);
        let room = &mut outline.room;
        *room = (room.0 + dx, room.1 + dy, room.2 + dx, room.3 + dy);
    }
    for run in runs {
        shift(&mut run.start);
        run.pieces.iter_mut().for_each(|(a, b)| {
            shift(a);
            shift(b);
        });
        run.heads.iter_mut().for_each(|(p, _)| shift(p));
    }
    size
}

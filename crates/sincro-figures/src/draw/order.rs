//! Who stands above whom in a column: few crossings, by barycentre sweeps and swaps of neighbours.
//!
//! Wires over several columns pass each column between in a cell of their own; all targets of a net share these cells.

use super::graph::{Graph, Shape};
use super::layers::Layers;

/// Cells in columns, from top to bottom, and links between neighbouring columns.
#[derive(Clone, Debug)]
pub(super) struct Sketch {
    pub cells: Vec<Cell>,
    /// Cells of each column, from top to bottom.
    pub columns: Vec<Vec<usize>>,
    pub links: Vec<Link>,
}

/// A node (the cell of the same number), or where a net passes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub node: Option<usize>,
    pub column: usize,
}

/// A piece of a net from a column to the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub net: usize,
    pub from: usize,
    pub out_port: usize,
    pub to: usize,
    pub in_port: usize,
}

/// Passes over all columns, both ways.
const N_SWEEPS: usize = 24;

impl Sketch {
    pub fn new(graph: &Graph, layers: &Layers) -> Self {
        let n_columns = layers.layer.iter().map(|l| l + 1).max().unwrap_or(0);
        let cells = layers.layer.iter().enumerate().map(|(k, &column)| Cell { node: Some(k), column }).collect();
        let mut sketch = Self { cells, columns: vec![Vec::new(); n_columns], links: Vec::new() };
        for net in 0..graph.nets.len() {
            sketch.link(graph, layers, net);
        }
        for (k, cell) in sketch.cells.iter().enumerate() {
            sketch.columns[cell.column].push(k);
        }
        sketch.sort(graph);
        sketch
    }

    /// The pieces of a net.
    fn link(&mut self, graph: &Graph, layers: &Layers, net: usize) {
        let from = graph.nets[net].from;
        // where the net leaves each column, from the source's on
        let mut trunk = vec![(from.node, from.port)];
        let start = layers.layer[from.node];
        for (to, _) in graph.nets[net].to.iter().zip(&layers.is_feedback[net]).filter(|(_, back)| !**back) {
            let length = layers.layer[to.node] - start;
            while trunk.len() < length {
                let (last, out_port) = trunk[trunk.len() - 1];
                let cell = self.cells.len();
                self.cells.push(Cell { node: None, column: start + trunk.len() });
                self.links.push(Link { net, from: last, out_port, to: cell, in_port: 0 });
                trunk.push((cell, 0));
            }
            let (from, out_port) = trunk[length - 1];
            self.links.push(Link { net, from, out_port, to: to.node, in_port: to.port });
        }
    }

    fn sort(&mut self, graph: &Graph) {
        let mut best = (self.crossings(graph), self.columns.clone());
        for sweep in 0..N_SWEEPS {
            let n = self.columns.len();
            let goes_right = sweep % 2 == 0;
            for step in 1..n {
                let column = if goes_right { step } else { n - 1 - step };
                self.by_barycentre(graph, column, goes_right);
            }
            self.swap_neighbours(graph);
            let crossings = self.crossings(graph);
            if crossings < best.0 {
                best = (crossings, self.columns.clone());
            }
        }
        self.columns = best.1;
    }

    /// Place of each cell in its column.
    pub fn ranks(&self) -> Vec<usize> {
        let mut rank = vec![0; self.cells.len()];
        for column in &self.columns {
            for (k, &cell) in column.iter().enumerate() {
                rank[cell] = k;
            }
        }
        rank
    }

    /// Heights of both ends of a link, as far as ranks and ports tell: the world's ports are in no order yet.
    fn ends(&self, graph: &Graph, rank: &[usize], link: &Link) -> (usize, usize) {
        let port = |cell: usize, port: usize| match self.cells[cell].node {
            Some(node) if graph.nodes[node].shape != Shape::World => port.min(998),
            _ => 0,
        };
        (rank[link.from] * 1000 + port(link.from, link.out_port), rank[link.to] * 1000 + port(link.to, link.in_port))
    }

    fn by_barycentre(&mut self, graph: &Graph, column: usize, goes_right: bool) {
        let rank = self.ranks();
        let mut sums = vec![(0, 0); self.cells.len()];
        for link in &self.links {
            let (from, to) = self.ends(graph, &rank, link);
            let (cell, other) = if goes_right { (link.to, from) } else { (link.from, to) };
            sums[cell].0 += other;
            sums[cell].1 += 1;
        }
        let mut cells = self.columns[column].clone();
        // cells without neighbours stay where they are; the others share the remaining places
        let places: Vec<usize> = (0..cells.len()).filter(|&k| sums[cells[k]].1 > 0).collect();
        let mut movers: Vec<usize> = places.iter().map(|&k| cells[k]).collect();
        movers.sort_by_key(|&cell| sums[cell].0 * 1000 / sums[cell].1);
        for (place, cell) in places.into_iter().zip(movers) {
            cells[place] = cell;
        }
        self.columns[column] = cells;
    }

    fn swap_neighbours(&mut self, graph: &Graph) {
        for column in 0..self.columns.len() {
            for k in 1..self.columns[column].len() {
                let before = self.crossings_at(graph, column);
                self.columns[column].swap(k - 1, k);
                if self.crossings_at(graph, column) >= before {
                    self.columns[column].swap(k - 1, k);
                }
            }
        }
    }

    fn crossings_at(&self, graph: &Graph, column: usize) -> usize {
        let rank = self.ranks();
        let left = if column > 0 { self.crossings_after(graph, &rank, column - 1) } else { 0 };
        left + self.crossings_after(graph, &rank, column)
    }

    fn crossings(&self, graph: &Graph) -> usize {
        let rank = self.ranks();
        (0..self.columns.len()).map(|column| self.crossings_after(graph, &rank, column)).sum()
    }

    /// Crossings between a column and the next one.
    fn crossings_after(&self, graph: &Graph, rank: &[usize], column: usize) -> usize {
        let here = self.links.iter().filter(|link| self.cells[link.from].column == column);
        let ends: Vec<(usize, usize)> = here.map(|link| self.ends(graph, rank, link)).collect();
        let crosses = |a: (usize, usize), b: (usize, usize)| (a.0 < b.0 && a.1 > b.1) || (a.0 > b.0 && a.1 < b.1);
        (0..ends.len()).map(|k| ends[..k].iter().filter(|other| crosses(ends[k], **other)).count()).sum()
    }
}

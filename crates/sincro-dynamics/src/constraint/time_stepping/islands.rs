//! Islands: constraints that act on each other, directly or through others.
//!
//! Two constraints belong to one island if both act on a tree of the mechanism (a free body is one), or are connected
//! through others. Islands and the constraints in them come in the order of their first constraint, which depends on
//! the model alone and not on how the sets were joined.

use sincro_complementarity::UnilateralConstraint;
use sincro_math::Real;

use crate::constraint::row::Row;
use crate::joint::WORLD;

/// Constraints by island. An item is a bilateral row, or the number of these plus the index of a unilateral constraint.
#[derive(Clone, Debug, Default)]
pub(in crate::constraint) struct Islands {
    /// Parent of each tree in its set.
    parent: Vec<u32>,
    /// Island of each root.
    island: Vec<u32>,
    /// Items in the order of islands, and the first of each island.
    items: Vec<usize>,
    first: Vec<usize>,
    /// Island of each item.
    of_item: Vec<u32>,
    next: Vec<usize>,
}

const NONE: u32 = u32::MAX;

impl Islands {
    /// Finds the islands; `trees` gives the trees that a row acts on, by the index of their first link.
    pub fn find<R: Real>(
        &mut self,
        rows: &[Row<R>],
        blocks: &[UnilateralConstraint<R>],
        n_free: usize,
        trees: impl Fn(&Row<R>) -> [u32; 2],
    ) {
        // the last row of a constraint is that of a drive, whose first one acts on nothing
        let last_row = |block: &UnilateralConstraint<R>| {
            block.groups[0].as_ref().filter(|_| block.is_drive()).map_or(block.row, |group| group.row)
        };
        let item_rows = || (0..n_free).chain(blocks.iter().map(last_row));
        self.parent.clear();
        for row in item_rows() {
            let [one, two] = trees(&rows[row]);
            for tree in [one, two].into_iter().filter(|tree| *tree != WORLD) {
                let known = self.parent.len() as u32;
                self.parent.extend(known..known.max(tree + 1));
            }
            if one != WORLD && two != WORLD {
                let (one, two) = (self.root(one), self.root(two));
                self.parent[one.max(two) as usize] = one.min(two);
            }
        }
        self.island.clear();
        self.island.resize(self.parent.len(), NONE);
        self.of_item.clear();
        self.first.clear();
        for row in item_rows() {
            let [one, two] = trees(&rows[row]);
            let island = if one == WORLD && two == WORLD {
                // a constraint that moves nothing is an island of its own
                self.first.len() as u32
            } else {
                let root = self.root(if one == WORLD { two } else { one }) as usize;
                if self.island[root] == NONE {
                    self.island[root] = self.first.len() as u32;
                }
                self.island[root]
            };
            if island as usize == self.first.len() {
                self.first.push(0);
            }
            self.first[island as usize] += 1;
            self.of_item.push(island);
        }
        // counts become starts
        let mut start = 0;
        for first in &mut self.first {
            (*first, start) = (start, start + *first);
        }
        self.next.clone_from(&self.first);
        self.items.clear();
        self.items.resize(self.of_item.len(), 0);
        for (item, island) in self.of_item.iter().enumerate() {
            let next = &mut self.next[*island as usize];
            self.items[*next] = item;
            *next += 1;
        }
    }

    /// Root of the set of a tree; ways are shortened.
    fn root(&mut self, mut tree: u32) -> u32 {
        while self.parent[tree as usize] != tree {
            let above = self.parent[self.parent[tree as usize] as usize];
            self.parent[tree as usize] = above;
            tree = above;
        }
        tree
    }

    /// Number of islands.
    pub fn len(&self) -> usize {
        self.first.len()
    }

    /// Items of an island, in increasing order.
    pub fn items(&self, island: usize) -> impl Iterator<Item = usize> {
        let end = self.first.get(island + 1).copied().unwrap_or(self.items.len());
        self.items[self.first[island]..end].iter().copied()
    }
}

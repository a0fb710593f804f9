//! Islands: constraints that act on each other, directly or through others.
//!
//! Two constraints belong to one island if both act on a tree of the mechanism (a free body is one), or are connected
//! through others. Islands and the constraints in them come in the order of their first constraint, which depends on
//! the model alone and not on how the sets were joined.

use super::disjoint_sets::DisjointSets;

/// In the place of a tree: none, the world.
pub const NO_TREE: u32 = u32::MAX;

/// Constraints by island.
#[derive(Clone, Debug, Default)]
pub struct Islands {
    /// Trees that belong together.
    trees: DisjointSets,
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
    /// Finds the islands of constraints, the `items`, each given by the trees that it acts on, by the index of their
    /// first link; [`NO_TREE`] for none.
    pub fn find(&mut self, items: impl Iterator<Item = [u32; 2]> + Clone) {
        self.trees.clear();
        for [one, two] in items.clone() {
            for tree in [one, two].into_iter().filter(|tree| *tree != NO_TREE) {
                self.trees.extend_to(tree as usize + 1);
            }
            if one != NO_TREE && two != NO_TREE {
                self.trees.join(one, two);
            }
        }
        self.island.clear();
        self.island.resize(self.trees.len(), NONE);
        self.of_item.clear();
        self.first.clear();
        for [one, two] in items {
            let island = if one == NO_TREE && two == NO_TREE {
                // a constraint that moves nothing is an island of its own
                self.first.len() as u32
            } else {
                let root = self.trees.root(if one == NO_TREE { two } else { one }) as usize;
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

    /// Tree that stands for the set of another one; `None` if no constraint acts on it.
    fn known_root(&self, tree: u32) -> Option<u32> {
        self.trees.known_root(tree).filter(|root| self.island[*root as usize] != NONE)
    }

    /// Island of a tree, given by the index of its first link; `None` if no constraint acts on it.
    #[must_use]
    pub fn of_tree(&self, tree: u32) -> Option<usize> {
        Some(self.island[self.known_root(tree)? as usize] as usize)
    }

    /// The first of the trees that belong to the island of a tree.
    #[must_use]
    pub fn first_tree(&self, tree: u32) -> u32 {
        self.known_root(tree).unwrap_or(tree)
    }

    /// Number of islands.
    #[must_use]
    pub fn len(&self) -> usize {
        self.first.len()
    }

    /// Returns true if there are no constraints.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Items of an island, in increasing order.
    pub fn items(&self, island: usize) -> impl Iterator<Item = usize> {
        let end = self.first.get(island + 1).copied().unwrap_or(self.items.len());
        self.items[self.first[island]..end].iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_that_touch_through_others_are_one_island() {
        let none = NO_TREE;
        let items = [[3, none], [1, 2], [5, none], [2, 3], [none, 4], [1, none], [none, none]];
        let mut islands = Islands::default();
        // twice, so that nothing is left of the first time
        for _ in 0..2 {
            islands.find(items.into_iter());
            let found: Vec<Vec<usize>> = (0..islands.len()).map(|k| islands.items(k).collect()).collect();
            assert_eq!(found, [vec![0, 1, 3, 5], vec![2], vec![4], vec![6]]);
            assert_eq!([0, 1, 3, 4, 9].map(|tree| islands.of_tree(tree)), [None, Some(0), Some(0), Some(2), None]);
            assert_eq!([2, 3, 5].map(|tree| islands.first_tree(tree)), [1, 1, 5]);
        }
    }
}

//! Disjoint sets of numbers, joined one pair after another; the smallest number of a set stands for it.

/// Sets of the numbers from 0 on.
#[derive(Clone, Debug, Default)]
pub(super) struct DisjointSets {
    /// Another number of the same set, itself if it stands for it.
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Forgets all numbers.
    pub fn clear(&mut self) {
        self.parent.clear();
    }

    /// Knows the numbers below `n`; new ones are sets of their own.
    pub fn extend_to(&mut self, n: usize) {
        let known = self.parent.len();
        self.parent.extend(known as u32..known.max(n) as u32);
    }

    /// Number of numbers known.
    pub fn len(&self) -> usize {
        self.parent.len()
    }

    /// Joins the sets of two numbers.
    pub fn join(&mut self, one: u32, two: u32) {
        let (one, two) = (self.root(one), self.root(two));
        self.parent[one.max(two) as usize] = one.min(two);
    }

    /// Number that stands for the set of another one; ways are shortened.
    pub fn root(&mut self, mut number: u32) -> u32 {
        while self.parent[number as usize] != number {
            let above = self.parent[self.parent[number as usize] as usize];
            self.parent[number as usize] = above;
            number = above;
        }
        number
    }

    /// The same without a change; `None` if the number is not known.
    pub fn known_root(&self, mut number: u32) -> Option<u32> {
        while *self.parent.get(number as usize)? != number {
            number = self.parent[number as usize];
        }
        Some(number)
    }
}

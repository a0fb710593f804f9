//! A list in bounded memory: when it is full, every second entry goes. A live run keeps its snapshots in one.

/// Entries in the order in which they came; the first and the last are always there.
#[derive(Debug)]
pub(super) struct Thinned<T> {
    kept: Vec<T>,
    /// Every how many of those that came are kept for good.
    every: usize,
    n_came: usize,
    most: usize,
}

impl<T> Thinned<T> {
    /// For at most so many entries, three at least.
    pub fn new(most: usize) -> Self {
        Self { kept: Vec::new(), every: 1, n_came: 0, most: most.max(3) }
    }

    /// Takes one. The one before it goes, if it was only kept as the last.
    pub fn push(&mut self, entry: T) {
        if self.n_came > 0 && !(self.n_came - 1).is_multiple_of(self.every) {
            self.kept.pop();
        }
        self.kept.push(entry);
        self.n_came += 1;
        self.fit();
    }

    /// Another bound.
    pub fn set_most(&mut self, most: usize) {
        self.most = most.max(3);
        self.fit();
    }

    fn fit(&mut self) {
        while self.kept.len() > self.most {
            let (mut k, last) = (0_usize, self.kept.len() - 1);
            self.kept.retain(|_| {
                k += 1;
                (k - 1).is_multiple_of(2) || k - 1 == last
            });
            self.every *= 2;
        }
    }

    /// The last one of those for which `is_before` holds; they come first.
    pub fn last_before(&self, is_before: impl FnMut(&T) -> bool) -> Option<&T> {
        let n = self.kept.partition_point(is_before);
        n.checked_sub(1).map(|k| &self.kept[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_keeps_the_first_the_last_and_an_even_spread() {
        let mut list = Thinned::new(10);
        for k in 0..1000_usize {
            list.push(k);
            assert!(list.kept.len() <= 10, "{:?}", list.kept);
            assert_eq!((list.kept[0], *list.kept.last().unwrap()), (0, k));
            let inner = &list.kept[..list.kept.len() - 1];
            assert!(inner.windows(2).all(|pair| pair[1] - pair[0] == list.every), "{:?}", list.kept);
        }
        assert_eq!(list.last_before(|k| *k <= 300), Some(&256));
        list.set_most(3);
        assert_eq!(list.kept, [0, 512, 999]);
    }

    #[test]
    fn what_fits_stays_whole() {
        let mut list = Thinned::new(100);
        (0..100).for_each(|k| list.push(k));
        assert_eq!(list.kept, (0..100).collect::<Vec<_>>());
        assert_eq!(list.last_before(|k| *k < 0), None);
    }
}

//! Who runs where between two columns: the upright pieces of wires, each on a track of its own.
//!
//! A strand is what one net has in one channel: heights where it comes from the left and where it goes to the right.
//! Their order from left to right is chosen for few crossings; where no order keeps two strands off each other, one of
//! them is split in two.

/// A net in a channel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strand {
    pub net: usize,
    /// Heights where it touches the left side of the channel, and the right one.
    pub left: Vec<i64>,
    pub right: Vec<i64>,
    /// From the left.
    pub track: usize,
}

/// Clear height between two strands on one track.
const CLEAR: i64 = 10;
/// Cost of two wires on one line, in crossings.
const SHARED: i64 = 100_000;

impl Strand {
    pub fn new(net: usize) -> Self {
        Self { net, left: Vec::new(), right: Vec::new(), track: 0 }
    }

    /// Upper and lower end.
    pub fn span(&self) -> (i64, i64) {
        let all = || self.left.iter().chain(&self.right).copied();
        (all().min().unwrap_or(0), all().max().unwrap_or(0))
    }

    pub fn is_straight(&self) -> bool {
        let (top, bottom) = self.span();
        top == bottom
    }

    /// Crossings if this one stands left of another.
    fn cost_left_of(&self, other: &Self) -> i64 {
        if self.net == other.net {
            // the parts of a split strand stand in the order in which they follow one another
            return i64::from(self.left.iter().any(|y| other.right.contains(y))) * 3;
        }
        let within = |y: &&i64, (top, bottom): (i64, i64)| top < **y && **y < bottom;
        let crossings = self.right.iter().filter(|y| within(y, other.span())).count()
            + other.left.iter().filter(|y| within(y, self.span())).count();
        let shared = self.right.iter().flat_map(|a| other.left.iter().map(move |b| (a - b).abs()));
        let shared: i64 = shared.map(|d| if d == 0 { SHARED } else { i64::from(d < 5) * 3 }).sum();
        crossings as i64 + shared
    }

    fn overlaps(&self, other: &Self) -> bool {
        let ((a, b), (c, d)) = (self.span(), other.span());
        a < d + CLEAR && c < b + CLEAR
    }
}

/// Gives all strands of a channel their tracks and returns how many tracks there are.
pub(super) fn assign(strands: &mut Vec<Strand>) -> usize {
    loop {
        let order = best_order(strands);
        let Some((upright, other)) = first_shared(strands, &order) else {
            return number(strands, &order);
        };
        let level = free_level(strands, strands[upright].span());
        let right = std::mem::replace(&mut strands[upright].right, vec![level]);
        debug_assert!(upright != other, "a strand does not share a line with itself");
        // right behind its other half, so that the parts of a net stand in their order
        strands.insert(upright + 1, Strand { left: vec![level], right, ..Strand::new(strands[upright].net) });
    }
}

/// Strands that stand upright, from left to right.
fn best_order(strands: &[Strand]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..strands.len()).filter(|&k| !strands[k].is_straight()).collect();
    // first with the way they go: those that go down from the lowest on, those that go up from the uppermost on
    order.sort_by_key(|&k| {
        let (from, to) = (strands[k].left.iter().min(), strands[k].right.iter().max());
        if to > from { (0, -from.copied().unwrap_or(0)) } else { (1, from.copied().unwrap_or(0)) }
    });
    let cost: Vec<Vec<i64>> = strands.iter().map(|a| strands.iter().map(|b| a.cost_left_of(b)).collect()).collect();
    for _ in 0..12 {
        let mut is_better = false;
        for k in 0..order.len() {
            let strand = order.remove(k);
            // crossings with the others at each place, as a difference to the place at the left end
            let mut best = (0, 0);
            let mut change = 0;
            let mut at_k = 0;
            for place in 1..=order.len() {
                let passed = order[place - 1];
                change += cost[passed][strand] - cost[strand][passed];
                at_k = if place == k { change } else { at_k };
                if change < best.0 {
                    best = (change, place);
                }
            }
            let place = if best.0 < at_k { best.1 } else { k };
            is_better |= place != k;
            order.insert(place, strand);
        }
        if !is_better {
            break;
        }
    }
    order
}

/// Two strands that would share a line: the one at the right must be split.
fn first_shared(strands: &[Strand], order: &[usize]) -> Option<(usize, usize)> {
    for (k, &left) in order.iter().enumerate() {
        for &right in &order[k + 1..] {
            if strands[left].right.iter().any(|y| strands[right].left.contains(y))
                && strands[left].net != strands[right].net
            {
                return Some((right, left));
            }
        }
    }
    None
}

/// A height near the middle of a span that no strand touches.
fn free_level(strands: &[Strand], (top, bottom): (i64, i64)) -> i64 {
    let is_free = |y: i64, clear: i64| {
        strands.iter().flat_map(|s| s.left.iter().chain(&s.right)).all(|pin| (pin - y).abs() >= clear)
    };
    let middle = (top + bottom) / 2;
    let near = |clear: i64| (0..2000).flat_map(|d| [middle + d, middle - d]).find(|&y| is_free(y, clear));
    near(6).or_else(|| near(1)).unwrap_or(middle)
}

fn number(strands: &mut [Strand], order: &[usize]) -> usize {
    let mut n_tracks = 0;
    for (k, &strand) in order.iter().enumerate() {
        let before = order[..k].iter().filter(|&&other| {
            let (a, b) = (&strands[other], &strands[strand]);
            a.overlaps(b)
        });
        let track = before.map(|&other| strands[other].track + 1).max().unwrap_or(0);
        strands[strand].track = track;
        n_tracks = n_tracks.max(track + 1);
    }
    n_tracks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wires_that_change_places_are_split() {
        let strand = |net, a, b| Strand { left: vec![a], right: vec![b], ..Strand::new(net) };
        let mut strands = vec![strand(0, 10, 50), strand(1, 50, 10)];
        assert!(assign(&mut strands) >= 3);
        assert_eq!(strands.len(), 3);
    }
}

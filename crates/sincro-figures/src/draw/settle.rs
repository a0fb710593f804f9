//! Places things on a line, as short and as straight as can be: exact, for both columns and heights.
//!
//! Minimises Σ weight·|p_b − p_a − rest| subject to p_b − p_a ≥ least, over whole numbers, from a start that keeps all
//! distances. The sum is L♮-convex, so that where no set of things can be shifted together by one to a better sum, the
//! sum is the least there is; the best set to shift is a minimum cut. Shifts begin large and are halved, which takes
//! few steps (Murota, *Discrete Convex Analysis*, 2003, chapter 10). Layered drawings usually take the network simplex
//! for it; this is as exact and shorter.

/// Costs `weight · |p_b − p_a − rest|`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    pub a: usize,
    pub b: usize,
    pub rest: i64,
    pub weight: i64,
}

/// Keeps `p_b − p_a ≥ least`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    pub a: usize,
    pub b: usize,
    pub least: i64,
}

/// More than all weights together.
const NEVER: i64 = 1 << 40;

/// Moves `p` from a place that keeps all gaps to one of least cost.
pub(super) fn settle(p: &mut [i64], pulls: &[Pull], gaps: &[Gap]) {
    debug_assert!(gaps.iter().all(|gap| p[gap.b] - p[gap.a] >= gap.least), "the start keeps all gaps");
    let mut step = 512;
    while step > 0 {
        while shift(p, pulls, gaps, step) || shift(p, pulls, gaps, -step) {}
        step /= 2;
    }
}

/// Shifts the best set by `step`, if that is any better.
fn shift(p: &mut [i64], pulls: &[Pull], gaps: &[Gap], step: i64) -> bool {
    let n = p.len();
    let (source, sink) = (n, n + 1);
    let mut cut = Cut::new(n + 2);
    let mut alone = vec![0; n];
    for pull in pulls {
        let cost = |stretch: i64| pull.weight * (stretch - pull.rest).abs();
        let stretch = p[pull.b] - p[pull.a];
        let only_a = cost(stretch - step) - cost(stretch);
        let only_b = cost(stretch + step) - cost(stretch);
        alone[pull.a] += only_a;
        alone[pull.b] -= only_a;
        // b moves and a stays
        cut.arc(pull.b, pull.a, only_a + only_b);
    }
    for gap in gaps {
        let slack = p[gap.b] - p[gap.a] - gap.least;
        if slack < step.abs() {
            let (mover, other) = if step > 0 { (gap.a, gap.b) } else { (gap.b, gap.a) };
            cut.arc(mover, other, NEVER);
        }
    }
    let mut gain = 0;
    for (k, &cost) in alone.iter().enumerate() {
        if cost < 0 {
            cut.arc(source, k, -cost);
            gain -= cost;
        } else {
            cut.arc(k, sink, cost);
        }
    }
    if gain == 0 || cut.flow(source, sink) >= gain {
        return false;
    }
    let moves = cut.reached(source);
    for k in 0..n {
        p[k] += if moves[k] < NONE { step } else { 0 };
    }
    true
}

const NONE: usize = usize::MAX;

/// Minimum cut by maximum flow (Dinic).
struct Cut {
    /// Arcs by node; arc `k ^ 1` is the reverse of arc `k`.
    leaving: Vec<Vec<usize>>,
    head: Vec<usize>,
    room: Vec<i64>,
}

impl Cut {
    fn new(n: usize) -> Self {
        Self { leaving: vec![Vec::new(); n], head: Vec::new(), room: Vec::new() }
    }

    fn arc(&mut self, from: usize, to: usize, room: i64) {
        if room > 0 {
            for (a, b, room) in [(from, to, room), (to, from, 0)] {
                self.leaving[a].push(self.head.len());
                self.head.push(b);
                self.room.push(room);
            }
        }
    }

    fn flow(&mut self, source: usize, sink: usize) -> i64 {
        let mut total = 0;
        loop {
            let level = self.reached(source);
            if level[sink] == NONE {
                return total;
            }
            let mut next = vec![0; self.leaving.len()];
            loop {
                let pushed = self.push(source, sink, NEVER, &level, &mut next);
                if pushed == 0 {
                    break;
                }
                total += pushed;
            }
        }
    }

    /// Pushes flow along one path through rising levels.
    fn push(&mut self, at: usize, sink: usize, most: i64, level: &[usize], next: &mut [usize]) -> i64 {
        if at == sink {
            return most;
        }
        while next[at] < self.leaving[at].len() {
            let arc = self.leaving[at][next[at]];
            let to = self.head[arc];
            if self.room[arc] > 0 && level[to] == level[at] + 1 {
                let pushed = self.push(to, sink, most.min(self.room[arc]), level, next);
                if pushed > 0 {
                    self.room[arc] -= pushed;
                    self.room[arc ^ 1] += pushed;
                    return pushed;
                }
            }
            next[at] += 1;
        }
        0
    }

    /// Count of arcs with room from the source to each node; [`NONE`] where there is no way.
    fn reached(&self, source: usize) -> Vec<usize> {
        let mut level = vec![NONE; self.leaving.len()];
        level[source] = 0;
        let mut queue = vec![source];
        let mut done = 0;
        while done < queue.len() {
            let at = queue[done];
            done += 1;
            for &arc in &self.leaving[at] {
                let to = self.head[arc];
                if self.room[arc] > 0 && level[to] == NONE {
                    level[to] = level[at] + 1;
                    queue.push(to);
                }
            }
        }
        level
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_becomes_straight_where_distances_allow() {
        let mut p = vec![0, 40, 300, 340];
        let pull = |a, b| Pull { a, b, rest: 0, weight: 1 };
        let gaps = [Gap { a: 0, b: 1, least: 40 }, Gap { a: 2, b: 3, least: 60 }];
        settle(&mut p, &[pull(0, 2), pull(1, 3)], &[gaps[0], Gap { least: 40, ..gaps[1] }]);
        assert_eq!((p[2] - p[0], p[3] - p[1]), (0, 0));
        let mut p = vec![0, 40, 300, 400];
        settle(&mut p, &[pull(0, 2), Pull { weight: 3, ..pull(1, 3) }], &gaps);
        assert_eq!((p[3] - p[1], p[2] - p[0]), (0, 0), "{p:?}");
        assert!(p[3] - p[2] >= 60, "{p:?}");
    }
}

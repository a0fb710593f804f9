//! RRT-Connect, and what makes its paths short and even.

use sincro_math::random::SplitMix64;

use crate::space::Space;

/// States of the trees of one search together.
pub const MAX_STATES: usize = 10_000;
/// Points of a path.
pub const MAX_POINTS: usize = 100_000;
/// Length of a step of a tree, as a share of the largest distance.
const STEP: f64 = 0.2;
/// Distances that take about as long as a check.
const DISTANCES_PER_CHECK: usize = 200;
/// Attempts in a row to make a path shorter that may fail.
const MAX_FAILURES: usize = 50;

/// State of a tree with its parent.
struct Node {
    state: Vec<f64>,
    parent: Option<usize>,
}

/// Place that a tree got to.
enum Reached {
    No,
    Closer(usize),
    Target(usize),
}

/// Search within a limit of its effort, with its random numbers.
pub struct Planner<'a> {
    space: &'a Space,
    random: SplitMix64,
    /// Longest piece of a straight line that is not checked, as a share of the largest distance.
    resolution: f64,
    checks_left: usize,
    n_checks: usize,
}

impl<'a> Planner<'a> {
    /// A planner in a space with the seed of its random numbers; it checks `max_checks` states at most, to which the
    /// distances of states that it looks at are added. Straight lines are checked at 1 % of the largest distance.
    #[must_use]
    pub fn new(space: &'a Space, seed: u64, max_checks: usize) -> Self {
        Self { space, random: SplitMix64::new(seed), resolution: 0.01, checks_left: max_checks, n_checks: 0 }
    }

    /// Sets the distance of the states that are checked on a straight line, as a share of the largest distance, and
    /// gives the planner back. It is positive.
    #[must_use]
    pub fn with_resolution(mut self, resolution: f64) -> Self {
        self.resolution = resolution;
        self
    }

    /// Effort so far, in checked states.
    #[must_use]
    pub fn n_checks(&self) -> usize {
        self.n_checks
    }

    /// Counts an effort; false if it is too much.
    fn spend(&mut self, n: usize) -> bool {
        let is_possible = n <= self.checks_left;
        let spent = n.min(self.checks_left);
        self.checks_left -= spent;
        self.n_checks += spent;
        is_possible
    }

    fn is_valid<E>(&mut self, state: &[f64], check: &mut impl FnMut(&[f64]) -> Result<bool, E>) -> Result<bool, E> {
        Ok(self.spend(1) && check(state)?)
    }

    /// Returns true if all states between a valid one and another are valid, that one included.
    ///
    /// # Errors
    ///
    /// Those of the check.
    pub fn is_clear<E>(
        &mut self,
        from: &[f64],
        to: &[f64],
        check: &mut impl FnMut(&[f64]) -> Result<bool, E>,
    ) -> Result<bool, E> {
        let n = self.space.n_pieces(from, to, self.resolution);
        if !self.is_valid(to, check)? {
            return Ok(false);
        }
        for k in 1..n {
            let state = self.space.interpolate(from, to, k as f64 / n as f64);
            if !self.is_valid(&state, check)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Nearest state of a tree.
    fn nearest(&mut self, tree: &[Node], to: &[f64]) -> usize {
        self.spend(tree.len() / DISTANCES_PER_CHECK);
        let mut best = (0, f64::INFINITY);
        for (k, node) in tree.iter().enumerate() {
            let distance = self.space.distance(&node.state, to);
            if distance < best.1 {
                best = (k, distance);
            }
        }
        best.0
    }

    /// One step of a tree towards a state.
    fn extend<E>(
        &mut self,
        tree: &mut Vec<Node>,
        parent: usize,
        to: &[f64],
        check: &mut impl FnMut(&[f64]) -> Result<bool, E>,
    ) -> Result<Reached, E> {
        let from = &tree[parent].state;
        let (distance, step) = (self.space.distance(from, to), STEP * self.space.extent());
        let is_last = distance <= step;
        let state = if is_last { to.to_vec() } else { self.space.interpolate(from, to, step / distance) };
        if !self.is_clear(from, &state, check)? {
            return Ok(Reached::No);
        }
        tree.push(Node { state, parent: Some(parent) });
        Ok(if is_last { Reached::Target(tree.len() - 1) } else { Reached::Closer(tree.len() - 1) })
    }

    /// A path from a start to one of some goals, both included, by two trees that grow towards random states and each
    /// other. None if the start or all goals are invalid, or the limits of effort or of [`MAX_STATES`] were reached.
    ///
    /// # Errors
    ///
    /// Those of the check.
    pub fn connect<E>(
        &mut self,
        start: &[f64],
        goals: &[Vec<f64>],
        check: &mut impl FnMut(&[f64]) -> Result<bool, E>,
    ) -> Result<Option<Vec<Vec<f64>>>, E> {
        let root = |state: &[f64]| Node { state: state.to_vec(), parent: None };
        if !self.is_valid(start, check)? {
            return Ok(None);
        }
        let mut trees = [vec![root(start)], Vec::new()];
        for goal in goals {
            if self.is_valid(goal, check)? {
                trees[1].push(root(goal));
            }
        }
        if trees[1].is_empty() {
            return Ok(None);
        }
        // the straight line first: then no path is made of detours where there is nothing
        for k in 0..trees[1].len() {
            let goal = trees[1][k].state.clone();
            if self.is_clear(start, &goal, check)? {
                return Ok(Some(vec![start.to_vec(), goal]));
            }
        }
        for turn in 0.. {
            if self.checks_left == 0 || trees[0].len() + trees[1].len() >= MAX_STATES {
                break;
            }
            let (a, b) = (turn % 2, 1 - turn % 2);
            let random = self.space.sample(&mut self.random);
            let near = self.nearest(&trees[a], &random);
            let (Reached::Closer(tip) | Reached::Target(tip)) = self.extend(&mut trees[a], near, &random, check)?
            else {
                continue;
            };
            let target = trees[a][tip].state.clone();
            let mut parent = self.nearest(&trees[b], &target);
            while trees[b].len() < MAX_STATES {
                match self.extend(&mut trees[b], parent, &target, check)? {
                    Reached::No => break,
                    Reached::Closer(next) => parent = next,
                    Reached::Target(end) => {
                        let ends = if a == 0 { [tip, end] } else { [end, tip] };
                        return Ok(Some(joined(&trees, ends)));
                    }
                }
            }
        }
        Ok(None)
    }

    /// Makes a path shorter: leaves out states that are not needed, then joins random points of it by straight lines,
    /// as long as that helps and the effort lasts.
    ///
    /// # Errors
    ///
    /// Those of the check.
    pub fn shorten<E>(
        &mut self,
        path: &mut Vec<Vec<f64>>,
        check: &mut impl FnMut(&[f64]) -> Result<bool, E>,
    ) -> Result<(), E> {
        let mut from = 0;
        while from + 2 < path.len() {
            for to in (from + 2..path.len()).rev() {
                if self.checks_left == 0 {
                    return Ok(());
                }
                if self.is_clear(&path[from].clone(), &path[to].clone(), check)? {
                    path.drain(from + 1..to);
                    break;
                }
            }
            from += 1;
        }
        let mut n_failed = 0;
        while path.len() > 2 && n_failed < MAX_FAILURES && self.checks_left > 0 {
            let total = self.length(path);
            let mut ends = [self.random.unit() * total, self.random.unit() * total];
            ends.sort_by(f64::total_cmp);
            let [(i, a), (j, b)] = ends.map(|s| self.at(path, s));
            let between = total.min(ends[1] - ends[0]);
            // a straight line is a shortcut only around a corner
            if i == j || self.space.distance(&a, &b) > between * (1.0 - 1e-6) || !self.is_clear(&a, &b, check)? {
                n_failed += 1;
                continue;
            }
            // both pieces that are left lie on checked lines; their states are checked at other places now
            let (before, after) = (path[i].clone(), path[j + 1].clone());
            if !self.is_clear(&before, &a, check)? || !self.is_clear(&b, &after, check)? {
                n_failed += 1;
                continue;
            }
            path.splice(i + 1..=j, [a, b]);
            path.dedup();
            n_failed = 0;
            if self.length(path) > total * (1.0 - 1e-3) {
                n_failed = MAX_FAILURES / 2;
            }
        }
        Ok(())
    }

    /// Length of a path, the sum of the distances of its states.
    #[must_use]
    pub fn length(&self, path: &[Vec<f64>]) -> f64 {
        path.windows(2).map(|ends| self.space.distance(&ends[0], &ends[1])).sum()
    }

    /// State at a length along a path, with the number of its piece.
    fn at(&self, path: &[Vec<f64>], mut s: f64) -> (usize, Vec<f64>) {
        let last = path.len() - 2;
        for k in 0..=last {
            let length = self.space.distance(&path[k], &path[k + 1]);
            if s <= length || k == last {
                let share = if length > 0.0 { (s / length).min(1.0) } else { 0.0 };
                return (k, self.space.interpolate(&path[k], &path[k + 1], share));
            }
            s -= length;
        }
        unreachable!("the last piece returns")
    }

    /// Puts states between those of a path: as many on each piece as are checked, or, for an `n` that is not 0, so that
    /// there are at least `n` in all, at distances as even as can be; [`MAX_POINTS`] at most.
    #[must_use]
    pub fn interpolate(&self, path: &[Vec<f64>], n: usize) -> Vec<Vec<f64>> {
        let Some(last) = path.last() else { return Vec::new() };
        let total = self.length(path);
        let mut left = n.min(MAX_POINTS).saturating_sub(path.len());
        let mut length_left = total;
        let mut out = Vec::with_capacity(n.min(MAX_POINTS).max(path.len()));
        for ends in path.windows(2) {
            let length = self.space.distance(&ends[0], &ends[1]);
            let pieces = match n {
                0 => self.space.n_pieces(&ends[0], &ends[1], self.resolution),
                _ if length_left > 0.0 => 1 + (((left as f64) * length / length_left).round() as usize).min(left),
                // a path of one place
                _ => 1 + left,
            };
            left = left.saturating_sub(pieces - 1);
            length_left -= length;
            let pieces = pieces.min(MAX_POINTS.saturating_sub(out.len()).max(1));
            out.push(ends[0].clone());
            let inner = (1..pieces).map(|k| self.space.interpolate(&ends[0], &ends[1], k as f64 / pieces as f64));
            out.extend(inner);
        }
        out.push(last.clone());
        out
    }
}

/// Way from the root of the first tree through the two ends to the root of the second.
fn joined(trees: &[Vec<Node>; 2], ends: [usize; 2]) -> Vec<Vec<f64>> {
    let way = |tree: &[Node], end: usize| -> Vec<Vec<f64>> {
        std::iter::successors(Some(end), |k| tree[*k].parent).map(|k| tree[k].state.clone()).collect()
    };
    let mut path = way(&trees[0], ends[0]);
    path.reverse();
    path.extend(way(&trees[1], ends[1]));
    // both trees have the state where they meet
    path.dedup();
    path
}

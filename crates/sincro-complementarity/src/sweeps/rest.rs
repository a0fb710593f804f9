//! Sleeping: islands of bodies that have come to rest are held, and left out of the steps until something changes.
//!
//! An island is *quiet* in a step if its residual is within the tolerance and all velocities of its trees, in rad/s and
//! m/s, are below the share [`QUIET`] of what gravity gives in the step, at its start and at its end; they are then set
//! to zero. Without gravity nothing rests. A body that does not move stays where
//! it is, so that the next step poses the same problem, and starts from the forces of this one: once these obey the
//! laws without a sweep, the island *rests*. From then on nothing about it changes by itself, and it is left out of
//! detection and solution. What is left out is exactly what would be found again:
//!
//! | looked at in every step | to the last bit |
//! |---|---|
//! | coordinates of its trees, length of the step, strongest gravity | those for which it was found at rest |
//! | their velocities | zero |
//! | their accelerations without contacts, all forces but those of contacts included | the same |
//! | warm start of its contacts, part of the state | the same |
//! | other trees | do not touch it |
//!
//! An island of which one of these is not so wakes as a whole, in the same step. With and without sleeping the states
//! are the same to the last bit.
//!
//! Trees with drives, joint limits, gears or loop joints are always awake.

use sincro_math::Real;

use super::islands::{Islands, NO_TREE};
use super::{Stillness, Sweeper};

/// Share of the velocity that gravity gives in a step which counts as none: the tolerance of the forces leaves more.
pub const QUIET: f64 = 2e-7;

const NONE: u32 = u32::MAX;

/// Trees of a mechanism, each by the index of its first link.
#[derive(Clone, Debug)]
pub struct Trees {
    /// Tree of each link.
    pub of_link: Vec<u32>,
    /// Tree of each degree of freedom (n_v).
    pub of_dof: Vec<u32>,
    /// Tree of each coordinate (n_q).
    pub of_coordinate: Vec<u32>,
}

/// State of rest of the trees of a mechanism, by the index of their first link.
#[derive(Clone, Debug)]
pub struct Rest<R> {
    trees: Trees,
    can_rest: Vec<bool>,
    /// Island of a tree that rests, by its first tree; `NONE` while awake.
    island: Vec<u32>,
    /// True for trees left out of the present step.
    is_left_out: Vec<bool>,
    /// True for trees whose velocities the step that was made sets to zero.
    is_quiet: Vec<bool>,
    /// Coordinates for which contacts were last detected.
    detected: Vec<R>,
    /// Velocity that gravity gives in the step [m/s], and that in which islands were found at rest.
    fall: f64,
    fall_at_rest: f64,
    /// Coordinates, accelerations without contacts and length of the step for which islands were found at rest.
    q: Vec<R>,
    free: Vec<R>,
    h: f64,
    /// Islands that are awake, or that move, while they are looked at.
    is_awake: Vec<bool>,
    /// Stillness of each island of the problem.
    stillness: Vec<Stillness>,
    /// True if the model may have changed.
    is_stale: bool,
    /// True while velocities may be set to zero: steps of semi-implicit Euler.
    pub is_allowed: bool,
    /// True if everything solved in the last step rests.
    pub is_all_at_rest: bool,
    /// True if an acceleration was another one than at rest: the step has to be made again.
    pub has_woken: bool,
}

impl<R: Real> Rest<R> {
    /// Everything awake. None may rest before [`Rest::allow`].
    #[must_use]
    pub fn new(trees: Trees) -> Self {
        let [n, n_q, n_v] = [&trees.of_link, &trees.of_coordinate, &trees.of_dof].map(Vec::len);
        let zeros = |n| vec![R::zero(); n];
        Self {
            trees,
            can_rest: vec![false; n],
            island: vec![NONE; n],
            is_left_out: vec![false; n],
            is_quiet: vec![false; n],
            detected: zeros(n_q),
            fall: 0.0,
            fall_at_rest: 0.0,
            q: zeros(n_q),
            free: zeros(n_v),
            h: 0.0,
            is_awake: vec![false; n],
            stillness: vec![Stillness::Awake; n],
            is_stale: true,
            is_allowed: false,
            is_all_at_rest: false,
            has_woken: false,
        }
    }

    /// Wakes everything: the model may have changed.
    pub fn forget(&mut self) {
        self.is_stale = true;
        self.island.fill(NONE);
    }

    /// Velocity that counts as none [rad/s], [m/s].
    #[must_use]
    pub fn quiet_speed(&self) -> f64 {
        QUIET * self.fall
    }

    /// Returns true if anything is left out.
    #[must_use]
    pub fn leaves_any_out(&self) -> bool {
        self.is_left_out.contains(&true)
    }

    /// Returns true if the trees that may rest are not known: see [`Rest::allow`].
    #[must_use]
    pub fn is_stale(&self) -> bool {
        self.is_stale
    }

    /// Lets all trees rest but those of these links and degrees of freedom.
    pub fn allow(&mut self, but_links: impl Iterator<Item = u32>, but_dofs: impl Iterator<Item = usize>) {
        self.is_stale = false;
        self.can_rest.fill(true);
        for dof in but_dofs {
            self.can_rest[self.trees.of_dof[dof] as usize] = false;
        }
        for link in but_links.filter(|link| *link != NO_TREE) {
            self.can_rest[self.trees.of_link[link as usize] as usize] = false;
        }
    }

    /// Begins the detection of contacts at the coordinates `q`, with nothing left out; what rests stays known. Gravity
    /// gives bodies the velocity `fall` [m/s] in the step.
    pub fn begin(&mut self, q: &[R], fall: f64) {
        self.fall = fall;
        self.is_left_out.fill(false);
        self.has_woken = false;
        self.detected.copy_from_slice(q);
    }

    /// Finds the islands to be left out of a step of length `h` `[s]` at the velocities `v`; their contacts have the
    /// warm start that they fell asleep with.
    pub fn leave_out(&mut self, v: &[R], h: f64) {
        if h != self.h || self.fall.to_bits() != self.fall_at_rest.to_bits() {
            return;
        }
        self.is_awake.fill(false);
        let same = |x: &R, y: &R| x.lane(0).to_bits() == y.lane(0).to_bits();
        let coordinates = self.detected.iter().zip(&self.q);
        let moved = self.trees.of_coordinate.iter().zip(coordinates).filter(|(_, (q, then))| !same(q, then));
        let moving = self.trees.of_dof.iter().zip(v).filter(|(_, v)| v.lane(0) != 0.0);
        for tree in moved.map(|(tree, _)| *tree).chain(moving.map(|(tree, _)| *tree)) {
            let island = self.island[tree as usize];
            if island != NONE {
                self.is_awake[island as usize] = true;
            }
        }
        for (is_left_out, island) in self.is_left_out.iter_mut().zip(&self.island) {
            *is_left_out = *island != NONE && !self.is_awake[*island as usize];
        }
    }

    /// Returns true if all of these links are left out of the step; the world always is.
    #[must_use]
    pub fn leaves_out<const N: usize>(&self, links: [u32; N]) -> bool {
        links.iter().all(|link| *link == NO_TREE || self.is_link_left_out(*link))
    }

    fn is_link_left_out(&self, link: u32) -> bool {
        self.is_left_out[self.trees.of_link[link as usize] as usize]
    }

    /// Wakes the island that a closed contact between two links touches from outside; returns true if it does.
    pub fn wake_touched(&mut self, links: [u32; 2]) -> bool {
        let [one, two] = links;
        if one == NO_TREE || two == NO_TREE || self.is_link_left_out(one) == self.is_link_left_out(two) {
            return false;
        }
        let sleeper = if self.is_link_left_out(one) { one } else { two };
        self.wake(self.trees.of_link[sleeper as usize]);
        true
    }

    /// Wakes the island of a tree.
    fn wake(&mut self, tree: u32) {
        let woken = self.island[tree as usize];
        for (island, is_left_out) in self.island.iter().zip(&mut self.is_left_out) {
            *is_left_out &= *island != woken;
        }
    }

    /// Holds the trees left out for their accelerations `v_dot` without contacts; one that has another acceleration
    /// than at rest wakes. Returns the number of islands left out.
    pub fn hold(&mut self, v_dot: &mut [R]) -> u64 {
        self.is_quiet.fill(false);
        for (k, (v_dot, free)) in v_dot.iter_mut().zip(&self.free).enumerate() {
            let tree = self.trees.of_dof[k] as usize;
            if self.is_left_out[tree] {
                self.has_woken |= v_dot.lane(0).to_bits() != free.lane(0).to_bits();
                *v_dot = R::zero();
                self.is_quiet[tree] = true;
            }
        }
        let left_out = self.is_left_out.iter().zip(&self.island).enumerate();
        left_out.filter(|(tree, (is_left_out, island))| **is_left_out && **island == *tree as u32).count() as u64
    }

    /// Keeps the accelerations without contacts of the trees that a solution looks at, and finds the islands all of
    /// whose trees have no velocity.
    pub fn begin_solution(&mut self, v: &[R], v_dot: &[R], islands: &Islands) {
        for (k, (free, v_dot)) in self.free.iter_mut().zip(v_dot).enumerate() {
            if !self.is_left_out[self.trees.of_dof[k] as usize] {
                *free = *v_dot;
            }
        }
        let n = islands.len().max(self.island.len());
        self.is_awake.clear();
        self.is_awake.resize(n, false);
        self.stillness.clear();
        self.stillness.resize(n, if self.is_allowed { Stillness::Still } else { Stillness::Awake });
        for (tree, v) in self.trees.of_dof.iter().zip(v) {
            let Some(k) = islands.of_tree(*tree) else { continue };
            if !self.can_rest[*tree as usize] {
                self.stillness[k] = Stillness::Awake;
            } else if v.lane(0) != 0.0 && self.stillness[k] == Stillness::Still {
                self.stillness[k] = Stillness::CanRest;
            }
        }
    }

    /// Stillness of an island, as found by [`Rest::begin_solution`].
    #[must_use]
    pub fn stillness(&self, island: usize) -> Stillness {
        self.stillness[island]
    }

    /// Finds the quiet islands of a solution, whose accelerations `v_dot` then end their motion, and those at rest.
    pub fn settle(&mut self, (v, h): (&[R], f64), islands: &Islands, sweeper: &Sweeper, v_dot: &mut [R]) {
        if !self.is_allowed {
            self.is_all_at_rest = false;
            return;
        }
        let n = islands.len();
        self.is_awake.fill(false);
        let quiet = self.quiet_speed();
        let Self { trees: Trees { of_dof, .. }, is_awake, can_rest, is_left_out, is_quiet, island, .. } = self;
        let known = |tree: u32| islands.of_tree(tree).filter(|_| !is_left_out[tree as usize]);
        let loud = |x: R| x.lane(0).abs() >= quiet || x.lane(0).is_nan();
        for (tree, (v, v_dot)) in of_dof.iter().zip(v.iter().zip(&*v_dot)) {
            if let Some(k) = known(*tree) {
                is_awake[k] |= !can_rest[*tree as usize] || loud(*v) || loud(*v + R::splat(h) * *v_dot);
            }
        }
        for k in 0..n {
            is_awake[k] |= !sweeper.is_solved(k);
        }
        for tree in 0..island.len() {
            if is_left_out[tree] {
                continue;
            }
            let of = islands.of_tree(tree as u32).filter(|k| !is_awake[*k]);
            is_quiet[tree] = of.is_some();
            island[tree] = match of {
                Some(k) if sweeper.was_at_rest(k) => islands.first_tree(tree as u32),
                _ => NONE,
            };
        }
        for (k, (v, v_dot)) in v.iter().zip(v_dot.iter_mut()).enumerate() {
            if is_quiet[of_dof[k] as usize] {
                *v_dot = if v.lane(0) == 0.0 { R::zero() } else { -*v * R::splat(1.0 / h) };
            }
        }
        self.is_all_at_rest = (0..n).all(|k| !self.is_awake[k] && sweeper.was_at_rest(k));
        self.q.copy_from_slice(&self.detected);
        (self.h, self.fall_at_rest) = (h, self.fall);
    }

    /// Returns true if everything that these links move rests, and has not woken since; the world does.
    #[must_use]
    pub fn rests(&self, links: [u32; 2]) -> bool {
        let rests = |link: u32| self.island[self.trees.of_link[link as usize] as usize] != NONE;
        links.into_iter().all(|link| link == NO_TREE || rests(link))
    }

    /// Returns true if anything rests.
    #[must_use]
    pub fn has_sleepers(&self) -> bool {
        self.island.iter().any(|island| *island != NONE)
    }

    /// Ends the motion of quiet islands after a step from the coordinates `before`: theirs are the same in `q`, to the
    /// last bit, and their velocities are zero.
    pub fn stop(&self, before: &[R], q: &mut [R], v: &mut [R]) {
        for ((tree, before), q) in self.trees.of_coordinate.iter().zip(before).zip(q) {
            if self.is_quiet[*tree as usize] {
                *q = *before;
            }
        }
        for (tree, v) in self.trees.of_dof.iter().zip(v) {
            if self.is_quiet[*tree as usize] {
                *v = R::zero();
            }
        }
    }
}

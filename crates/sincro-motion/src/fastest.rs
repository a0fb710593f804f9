//! To a position and velocity in the least time.
//!
//! Let the acceleration at the start be a₀ ≤ 0 (else everything is mirrored) and v_r = v₀ − a₀²/2J the velocity left
//! when it is taken to zero at once. The motions that can be the fastest, from the one that leads farthest forward to
//! the one that leads farthest back, are
//!
//! | family | motion | its number |
//! |---|---|---|
//! | ahead | to the velocity v_c ≥ v_r, v_f; there for a while if v_c is the largest allowed; to v_f | v_c, downwards |
//! | between (if v_f < v_r) | the acceleration is raised to a₁ ≤ 0, then to the velocity v_f | a₁, from 0 to a₀ |
//! | behind | to the velocity v_c ≤ v_r, v_f; there for a while if v_c is the lowest allowed; to v_f | v_c, downwards |
//!
//! Where one family ends the next begins with the same motion, so what is covered is a continuous function of where one
//! is in this list, from −∞ to ∞: some motion covers what is asked for. With v_f = 0 the function grows all the way
//! (the velocity of a motion farther ahead is nowhere lower), so there is one such motion; else there may be several,
//! of which the shortest is taken.

use crate::profile::{Limits, Pieces, Point, Profile};
use crate::ramp::{into_limits, to_velocity};

/// Sections in which a smooth piece of a family is looked through when there may be several solutions. Two solutions
/// within one section are not found: a search for them changed no duration of 60,000 random motions.
const SECTIONS: usize = 16;
/// Halvings of an interval: beyond this a double has no more digits.
pub(super) const HALVINGS: usize = 110;

/// The problem without what has to be done first, with a₀ ≤ 0.
struct Search {
    from: Point,
    /// Displacement to be covered.
    way: f64,
    v_end: f64,
    limits: Limits,
}

/// A place in the list of motions.
#[derive(Clone, Copy)]
enum Place {
    /// By √(v_c − base).
    Ahead(f64),
    Between(f64),
    /// By √(base − v_c).
    Behind(f64),
}

/// The fastest motion to a position and a velocity within the limits.
pub(super) fn fastest(start: Point, goal: (f64, f64), limits: &Limits) -> Profile {
    let all = candidates(start, goal, limits);
    let shortest = |best: Profile, next: Profile| if next.duration() < best.duration() { next } else { best };
    all.into_iter().reduce(shortest).expect("some motion covers what is asked for")
}

/// Every motion of the list above that leads there.
pub(super) fn candidates(start: Point, goal: (f64, f64), limits: &Limits) -> Vec<Profile> {
    let mut first = into_limits(start, limits);
    let from = first.end(start);
    let from = Point { a: from.a.clamp(limits.min_acceleration, limits.max_acceleration), ..from };
    let is_mirrored = from.a > 0.0;
    if is_mirrored {
        first = first.scaled(-1.0);
    }
    let mirror = |x: Point| if is_mirrored { x.mirrored() } else { x };
    let (start, from) = (mirror(start), mirror(from));
    let end = mirror(Point { p: goal.0, v: goal.1, a: 0.0 });
    let limits = if is_mirrored { limits.mirrored() } else { *limits };
    let search = Search { from, way: end.p - from.p, v_end: end.v, limits };
    let found = search.solutions().into_iter().map(|rest| {
        let mut pieces = first;
        pieces.extend(&rest);
        let profile = Profile::new(start, pieces, end);
        if is_mirrored { profile.mirrored() } else { profile }
    });
    found.collect()
}

impl Search {
    fn rest(&self) -> f64 {
        self.from.rest_velocity(self.limits.max_jerk)
    }

    /// The lowest velocity of `Ahead`, the highest of `Behind`.
    fn base(&self, is_ahead: bool) -> f64 {
        let v = if is_ahead { self.rest().max(self.v_end) } else { self.rest().min(self.v_end) };
        v.clamp(self.limits.min_velocity, self.limits.max_velocity)
    }

    fn via(&self, v: f64, stay: f64) -> Pieces {
        let mut pieces = to_velocity(self.from, v, &self.limits);
        pieces.push(stay, 0.0);
        pieces.extend(&to_velocity(Point { p: 0.0, v, a: 0.0 }, self.v_end, &self.limits));
        pieces
    }

    fn motion(&self, place: Place) -> Pieces {
        let Limits { min_velocity, max_velocity, max_jerk, .. } = self.limits;
        match place {
            Place::Ahead(y) => self.via((self.base(true) + y * y).min(max_velocity), 0.0),
            Place::Behind(y) => self.via((self.base(false) - y * y).max(min_velocity), 0.0),
            Place::Between(a) => {
                let mut pieces = Pieces::default();
                pieces.push((a - self.from.a) / max_jerk, max_jerk);
                let raised = Point { a, ..pieces.end(self.from) };
                pieces.extend(&to_velocity(raised, self.v_end, &self.limits));
                pieces
            }
        }
    }

    /// Displacement covered beyond the required one.
    fn excess(&self, place: Place) -> f64 {
        self.motion(place).end(Point { p: 0.0, ..self.from }).p - self.way
    }

    /// Numbers of a family at which its form changes, from the first to the last: where a ramp reaches its largest
    /// acceleration.
    fn corners(&self) -> Vec<Vec<Place>> {
        let Limits { min_velocity, max_velocity, min_acceleration: low, max_acceleration: high, max_jerk: j } =
            self.limits;
        let Point { v, a, .. } = self.from;
        let number = |v_c: f64, is_ahead: bool| {
            let above = if is_ahead { v_c - self.base(true) } else { self.base(false) - v_c };
            if above > 0.0 { above.sqrt() } else { 0.0 }
        };
        let sorted = |mut list: Vec<f64>, last: f64| {
            list.iter_mut().for_each(|y| *y = y.min(last));
            list.extend([0.0, last]);
            list.sort_by(f64::total_cmp);
            list.dedup();
            list
        };
        let half = a * a / 2.0;
        let ahead = vec![number(v + (high * high - half) / j, true), number(self.v_end + low * low / j, true)];
        let ahead = sorted(ahead, number(max_velocity, true));
        let behind = vec![number(v - (low * low - half) / j, false), number(self.v_end - high * high / j, false)];
        let behind = sorted(behind, number(min_velocity, false));
        let mut families = vec![ahead.into_iter().rev().map(Place::Ahead).collect::<Vec<_>>()];
        if self.v_end < self.rest() {
            let square = low * low - j * (v - self.v_end) + half;
            let corner = -square.clamp(0.0, a * a).sqrt();
            families.push([0.0, corner, a].map(Place::Between).to_vec());
        }
        families.push(behind.into_iter().map(Place::Behind).collect());
        families
    }

    /// Everything that leads there.
    fn solutions(&self) -> Vec<Pieces> {
        let Limits { min_velocity, max_velocity, .. } = self.limits;
        let sections = if self.v_end == 0.0 { 1 } else { SECTIONS };
        let (mut found, mut last) = (Vec::new(), None::<(Place, f64)>);
        for family in self.corners() {
            let samples: Vec<(Place, f64)> =
                refined(&family, sections).into_iter().map(|place| (place, self.excess(place))).collect();
            if let (Some(before), Some(first)) = (last, samples.first()) {
                // the same motion but for rounding
                if before.1 != 0.0 && first.1 != 0.0 && (before.1 > 0.0) != (first.1 > 0.0) {
                    found.push(self.motion(first.0));
                }
            }
            self.within(&samples, &mut found);
            last = samples.last().copied();
        }
        let beyond = -self.excess(Place::Ahead(max_velocity_number(self)));
        if beyond > 0.0 {
            found.push(self.via(max_velocity, beyond / max_velocity));
        }
        let behind = -self.excess(Place::Behind(min_velocity_number(self)));
        if behind < 0.0 {
            found.push(self.via(min_velocity, behind / min_velocity));
        }
        found
    }

    /// Solutions between samples of one family.
    fn within(&self, samples: &[(Place, f64)], found: &mut Vec<Pieces>) {
        found.extend(samples.iter().filter(|(_, f)| *f == 0.0).map(|(place, _)| self.motion(*place)));
        for pair in samples.windows(2) {
            if (pair[0].1 > 0.0 && pair[1].1 < 0.0) || (pair[0].1 < 0.0 && pair[1].1 > 0.0) {
                found.push(self.motion(self.halve(pair[0], pair[1])));
            }
        }
    }

    /// Between a sample ahead of what is asked for and one behind it.
    fn halve(&self, (mut from, excess): (Place, f64), (mut to, _): (Place, f64)) -> Place {
        let is_over = excess > 0.0;
        for _ in 0..HALVINGS {
            let mid = between(from, to, 0.5);
            if mid.number() == from.number() || mid.number() == to.number() {
                break;
            }
            if (self.excess(mid) > 0.0) == is_over { from = mid } else { to = mid }
        }
        if self.excess(from).abs() <= self.excess(to).abs() { from } else { to }
    }
}

fn max_velocity_number(search: &Search) -> f64 {
    (search.limits.max_velocity - search.base(true)).max(0.0).sqrt()
}

fn min_velocity_number(search: &Search) -> f64 {
    (search.base(false) - search.limits.min_velocity).max(0.0).sqrt()
}

impl Place {
    fn number(self) -> f64 {
        match self {
            Self::Ahead(x) | Self::Between(x) | Self::Behind(x) => x,
        }
    }
}

/// A share of the way between two places of one family.
fn between(from: Place, to: Place, share: f64) -> Place {
    let x = from.number() + share * (to.number() - from.number());
    match from {
        Place::Ahead(_) => Place::Ahead(x),
        Place::Between(_) => Place::Between(x),
        Place::Behind(_) => Place::Behind(x),
    }
}

/// Corners with samples between them.
fn refined(corners: &[Place], sections: usize) -> Vec<Place> {
    let mut list: Vec<Place> = Vec::with_capacity(corners.len() * sections);
    for pair in corners.windows(2) {
        list.extend((0..sections).map(|k| between(pair[0], pair[1], k as f64 / sections as f64)));
    }
    list.extend(corners.last());
    list
}

//! Pairs of colliders: which can touch, by which algorithm, at how many points.

use super::{Collider, Material, PairLaw, Surface, WORLD, discs};
use sincro_geometry::Shape;
use sincro_geometry::sat::Polytope;

/// Maximum number of points of a contact manifold between two solids.
const MANIFOLD: usize = 8;

/// Pair of colliders that can collide, from [`pairs`]; each of its slots can hold one contact point.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Index of the collider whose points touch.
    pub a: usize,
    /// Index of the collider that is touched.
    pub b: usize,
    /// Contact law of the pair.
    pub material: Material,
    /// True if the two pass through each other.
    pub is_ignored: bool,
    /// Index of its first slot among those of contacts; in all slots those of limits come before.
    pub first: usize,
    /// Number of slots: the most contact points that the pair can have.
    pub slots: usize,
    pub(crate) kind: PairKind,
}

/// Narrow-phase algorithm of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PairKind {
    /// Rounded points of a against the plane b.
    PointsOnPlane,
    /// A cylinder, cone or torus a on the plane b.
    DiscsOnPlane,
    /// A cylinder, cone or torus a and the cuboid b: on one of its faces, else by the general algorithm.
    DiscsOnCuboid,
    /// Ball against ball.
    Balls,
    /// Ball a against cuboid b.
    BallOnCuboid,
    /// Two convex polytopes.
    Polytopes,
    /// By the general algorithm.
    General,
}

impl Pair {
    /// Returns true if each slot stands for one point of the surfaces all the time; else for one of those found.
    #[inline]
    #[must_use]
    pub fn has_fixed_points(&self) -> bool {
        use PairKind::{BallOnCuboid, Balls, DiscsOnPlane, PointsOnPlane};
        matches!(self.kind, PointsOnPlane | DiscsOnPlane | Balls | BallOnCuboid)
    }

    /// Number of rows of a contact point: its normal, and two, two and one of its friction groups.
    #[inline]
    #[must_use]
    pub fn rows_per_point(&self) -> usize {
        let Material { friction, rolling_friction, spinning_friction, .. } = self.material;
        let rows = |dim: usize, coefficient: f64| if coefficient > 0.0 { dim } else { 0 };
        1 + rows(2, friction) + rows(2, rolling_friction) + rows(1, spinning_friction)
    }
}

/// Index of the pair that has `slot` among its slots, or the number of pairs if none has.
///
/// Most pairs of a scene have the same number of slots: the search begins at the slot's share of all slots, and goes on
/// in steps that double. Of 80,000 pairs a binary search would read seventeen from all over the memory.
#[must_use]
pub fn pair_of_slot(pairs: &[Pair], slot: usize) -> usize {
    let ends_before = |k: usize| pairs[k].first + pairs[k].slots <= slot;
    let n_slots = pairs.last().map_or(0, |last| last.first + last.slots);
    if slot >= n_slots {
        return pairs.len();
    }
    let start = slot * pairs.len() / n_slots;
    let (mut low, mut high, mut step) = (start, start, 1);
    while low > 0 && !ends_before(low - 1) {
        (high, low, step) = (low - 1, low.saturating_sub(step), 2 * step);
    }
    step = 1;
    while ends_before(high) {
        (low, high, step) = (high + 1, (high + step).min(pairs.len() - 1), 2 * step);
    }
    low + pairs[low..high].partition_point(|pair| pair.first + pair.slots <= slot)
}

/// Pairs of the colliders that can touch, by increasing indices; `joined` says of two links whether a joint joins them
/// directly, `law` gives the law of two colliders that have one of their own.
#[must_use]
pub fn pairs(
    colliders: &[Collider],
    joined: impl Fn(u32, u32) -> bool,
    law: impl Fn(usize, usize) -> PairLaw,
) -> Vec<Pair> {
    let mut pairs: Vec<Pair> = Vec::new();
    let is_polytope: Vec<bool> = colliders.iter().map(|c| Polytope::new(&c.surface, &c.pose).is_some()).collect();
    for i in 0..colliders.len() {
        for j in i + 1..colliders.len() {
            let (x, y) = (&colliders[i], &colliders[j]);
            let same_group = x.material.group != 0 && x.material.group == y.material.group;
            // a joint to the world does not keep what it carries off the floor
            let adjacent = x.link != WORLD && y.link != WORLD && joined(x.link, y.link);
            let law = law(i, j);
            if x.link == y.link || same_group || adjacent || law.is_excluded {
                continue;
            }
            let Some((a, b, kind, slots)) = arrange(colliders, &is_polytope, i, j) else { continue };
            let first = pairs.last().map_or(0, |p| p.first + p.slots);
            pairs.push(Pair {
                a,
                b,
                material: law.replace(x.material.with(&y.material)),
                is_ignored: false,
                first,
                slots,
                kind,
            });
        }
    }
    pairs
}

/// Roles of two colliders, their narrow-phase algorithm and number of slots; none if they cannot touch.
fn arrange(
    colliders: &[Collider],
    is_polytope: &[bool],
    i: usize,
    j: usize,
) -> Option<(usize, usize, PairKind, usize)> {
    let fixed = |k: usize| !matches!(colliders[k].surface, Surface::Solid(_) | Surface::Hull(_));
    if fixed(i) && fixed(j) {
        return None;
    }
    let (a, b) = if fixed(i) { (j, i) } else { (i, j) };
    let is = |k: usize, test: fn(&Surface) -> bool| test(&colliders[k].surface);
    let cuboid: fn(&Surface) -> bool = |s| matches!(s, Surface::Solid(Shape::Cuboid { .. }));
    if is(b, |s| matches!(s, Surface::HalfSpace)) {
        return Some(match discs::slots(&colliders[a].surface) {
            Some(slots) => (a, b, PairKind::DiscsOnPlane, slots),
            None => (a, b, PairKind::PointsOnPlane, colliders[a].points().0.len()),
        });
    }
    for (a, b) in [(a, b), (b, a)] {
        if discs::slots(&colliders[a].surface).is_some() && is(b, cuboid) {
            return Some((a, b, PairKind::DiscsOnCuboid, MANIFOLD));
        }
    }
    Some(match (colliders[a].ball().is_some(), colliders[b].ball().is_some()) {
        (true, true) => (a, b, PairKind::Balls, 1),
        (true, false) if is(b, cuboid) => (a, b, PairKind::BallOnCuboid, 1),
        (false, true) if is(a, cuboid) => (b, a, PairKind::BallOnCuboid, 1),
        (false, true) => (b, a, PairKind::General, MANIFOLD),
        _ if is_polytope[a] && is_polytope[b] => (a, b, PairKind::Polytopes, MANIFOLD),
        _ => (a, b, PairKind::General, MANIFOLD),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slot_has_the_pair_that_a_binary_search_finds() {
        // pairs with one slot before or behind those with many or none; behind one with very many the search begins far
        // above, before one far below
        for (few, is_first) in [0, 1, 3, 70, 100].into_iter().flat_map(|few| [(few, true), (few, false)]) {
            let mut pairs: Vec<Pair> = Vec::new();
            for k in 0..100_usize {
                let (is_one_of_few, is_large) = if is_first { (k < few, k == 99) } else { (k >= 100 - few, k == 0) };
                let slots = match k {
                    _ if is_large => 1000,
                    _ if is_one_of_few => 1,
                    _ => k * k % 9,
                };
                let first = pairs.last().map_or(0, |last| last.first + last.slots);
                let material = Material::default();
                pairs.push(Pair { a: 0, b: 1, material, is_ignored: false, first, slots, kind: PairKind::General });
            }
            let n_slots = pairs.last().map_or(0, |last| last.first + last.slots);
            for slot in 0..n_slots + 3 {
                let wanted = pairs.partition_point(|pair| pair.first + pair.slots <= slot);
                assert_eq!(pair_of_slot(&pairs, slot), wanted, "slot {slot} of {n_slots}");
            }
        }
        assert_eq!(pair_of_slot(&[], 0), 0);
    }
}

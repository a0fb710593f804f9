//! Contact detection from the poses of the links: broad phase by bounding spheres, then the narrow phase of each pair.

use super::broad_phase::{BroadPhase, Margin, are_close, center};
use super::candidate::{ContactCandidate, Edge, Feature};
use super::candidate_list::{CandidateList, SlotCandidate};
use super::manifold::{Manifolds, is_convex};
use super::{Collider, Pair, PairKind, Surface, discs};
use crate::WORLD;
use sincro_geometry::Shape;
use sincro_geometry::sat::{ContactKind, FaceClipper, Place, PointOnPlane, Polytope};
use sincro_geometry::spatial::{Pose, Vec3};

/// Distances within which the candidate of one slot is looked for, one after the other `[m]`; of convex surfaces within
/// the last alone.
const LOCATED: [f64; 2] = [1e-3, 0.1];

/// Contact detector; its memory grows to the largest manifold it has seen.
#[derive(Clone, Debug)]
pub struct Detector {
    points: Vec<(Vec<Vec3<f64>>, f64)>,
    broad_phase: BroadPhase,
    manifolds: Manifolds,
    polytopes: Vec<Option<Polytope>>,
    clipper: FaceClipper,
    /// Candidates of one pair.
    slots: Vec<Option<ContactCandidate>>,
}

impl Detector {
    /// Makes the detector of these colliders and their [`pairs`](crate::pairs).
    #[must_use]
    pub fn new(colliders: &[Collider], pairs: &[Pair]) -> Self {
        Self {
            points: colliders.iter().map(Collider::points).collect(),
            broad_phase: BroadPhase::new(colliders, pairs),
            manifolds: Manifolds::new(colliders, pairs),
            polytopes: polytopes(colliders, pairs),
            clipper: FaceClipper::default(),
            slots: Vec::new(),
        }
    }

    /// Finds the contact candidates of every pair whose surfaces are not farther apart than its `margin`, in the order
    /// of their slots; `poses` are those of the links in the world, `velocity` gives the velocity of a collider at a
    /// point of the world [m/s] and its angular speed [rad/s], `former` the [`ContactCandidate::id`] of a feature that
    /// a pair touched with so far, or 0. Pairs both surfaces of which are left out are passed
    /// over.
    #[allow(clippy::too_many_arguments)]
    pub fn detect(
        &mut self,
        (colliders, pairs): (&[Collider], &[Pair]),
        poses: &[Pose<f64>],
        margin: Margin,
        velocity: impl Fn(&Collider, Vec3<f64>) -> (Vec3<f64>, f64),
        former: impl Fn(&Pair) -> u32,
        is_left_out: impl Fn(&Collider) -> bool,
        found: &mut CandidateList,
    ) {
        self.broad_phase.find((colliders, pairs), poses, margin, velocity, is_left_out);
        found.clear();
        for n in 0..self.broad_phase.near.len() {
            let k = self.broad_phase.near[n] as usize;
            let pair = &pairs[k];
            if pair.is_ignored {
                continue;
            }
            let reach = (self.broad_phase.margin(pair, margin), margin.time > 0.0);
            self.push_candidates((k, pair), colliders, poses, ContactKind::of(former(pair)), reach, found);
        }
    }

    /// Contact candidate of `slot`, which is one of pair `k`, wherever its surfaces are not farther apart than 0.1 m:
    /// as [`Detector::detect`] finds it with that margin for all pairs and no feature touched so far. Of meshes and
    /// height fields the parts within a millimetre are looked at first: there may be hundreds within the whole
    /// distance. The pair's candidates are left in `found`.
    pub fn candidate_of_slot(
        &mut self,
        (colliders, pairs): (&[Collider], &[Pair]),
        (k, slot): (usize, usize),
        poses: &[Pose<f64>],
        found: &mut CandidateList,
    ) -> Option<ContactCandidate> {
        let pair = &pairs[k];
        let (a, b) = (&colliders[pair.a], &colliders[pair.b]);
        let margins = if is_convex(a) && is_convex(b) { &LOCATED[1..] } else { &LOCATED };
        margins.iter().find_map(|margin| {
            found.clear();
            if !pair.is_ignored && self.is_near(pair, (a, b), poses, *margin) {
                self.push_candidates((k, pair), colliders, poses, ContactKind::of(0), (*margin, false), found);
            }
            found.get(slot).copied()
        })
    }

    /// Adds the candidates of pair `k` to those found.
    fn push_candidates(
        &mut self,
        (k, pair): (usize, &Pair),
        colliders: &[Collider],
        poses: &[Pose<f64>],
        former: ContactKind,
        reach: (f64, bool),
        found: &mut CandidateList,
    ) {
        self.slots.clear();
        self.slots.resize(pair.slots, None);
        self.detect_pair((k, pair), colliders, poses, former, reach);
        for (slot, candidate) in (pair.first..).zip(&self.slots) {
            if let Some(candidate) = candidate {
                found.push(SlotCandidate { slot: slot as u32, pair: k as u32, candidate: *candidate });
            }
        }
    }

    /// Narrow phase of pair `k`: writes its candidates to `slots`; `is_step` for those of a whole step.
    fn detect_pair(
        &mut self,
        (k, pair): (usize, &Pair),
        colliders: &[Collider],
        poses: &[Pose<f64>],
        former: ContactKind,
        (margin, is_step): (f64, bool),
    ) {
        let slots = &mut self.slots[..];
        let (a, b) = (&colliders[pair.a], &colliders[pair.b]);
        let at = |c: &Collider| if c.link == WORLD { c.pose } else { poses[c.link as usize].compose(&c.pose) };
        match pair.kind {
            PairKind::PointsOnPlane => points_on_plane(&self.points[pair.a], a, b, slots),
            PairKind::DiscsOnPlane => discs::over_half_space((a, b), (&at(a), &at(b)), is_step, slots),
            PairKind::DiscsOnCuboid => {
                let poses = (&at(a), &at(b));
                if !discs::over_cuboid((a, b), poses, (margin, is_step), slots) {
                    self.manifolds.find(k, (pair.a, pair.b), (a, b), poses, margin, slots);
                }
            }
            PairKind::Balls => slots[0] = Some(balls(a, b)),
            PairKind::BallOnCuboid => slots[0] = Some(ball_on_cuboid(a, b, (&at(a), &at(b)))),
            PairKind::Polytopes => {
                let (Some(one), Some(two)) = (&self.polytopes[pair.a], &self.polytopes[pair.b]) else { return };
                let of = |c: &Collider| if c.link == WORLD { Pose::identity() } else { poses[c.link as usize] };
                let (max_points, mut free) = (slots.len(), slots.iter_mut());
                self.clipper.find(one, two, &of(a).inverse().compose(&of(b)), former, margin, max_points, |found| {
                    if let Some(slot) = free.next() {
                        *slot = Some(point_on_plane(&found, a, b));
                    }
                });
            }
            PairKind::General => {
                self.manifolds.find(k, (pair.a, pair.b), (a, b), (&at(a), &at(b)), margin, slots);
            }
        }
    }

    /// Bounding sphere of surface `k`: centre in the world and radius `[m]`.
    #[inline]
    #[must_use]
    pub fn ball(&self, k: usize, c: &Collider, poses: &[Pose<f64>]) -> (Vec3<f64>, f64) {
        (center(c, poses), self.broad_phase.radius(k))
    }

    /// Returns true if the bounding spheres of the two surfaces are closer than `margin` `[m]`.
    #[inline]
    #[must_use]
    pub fn is_near(&self, pair: &Pair, (a, b): (&Collider, &Collider), poses: &[Pose<f64>], margin: f64) -> bool {
        are_close(self.ball(pair.a, a, poses), b, self.ball(pair.b, b, poses), margin)
    }
}

fn polytopes(colliders: &[Collider], pairs: &[Pair]) -> Vec<Option<Polytope>> {
    let mut wanted = vec![false; colliders.len()];
    for pair in pairs.iter().filter(|pair| pair.kind == PairKind::Polytopes) {
        (wanted[pair.a], wanted[pair.b]) = (true, true);
    }
    let polytope = |(c, wanted): (&Collider, bool)| wanted.then(|| Polytope::new(&c.surface, &c.pose)).flatten();
    colliders.iter().zip(wanted).map(polytope).collect()
}

fn plane_of(b: &Collider) -> Feature {
    Feature::Plane { origin: b.pose.pos, normal: b.pose.rot.col(2) }
}

fn candidate(a: &Collider, b: &Collider, point: Vec3<f64>, radius: f64, feature: Feature) -> ContactCandidate {
    ContactCandidate { a: a.link, b: b.link, point, radius, radius_a: radius, edge: None, feature, id: 0 }
}

/// Contact candidate of a point that face clipping or crossing edges gave.
fn point_on_plane(found: &PointOnPlane, a: &Collider, b: &Collider) -> ContactCandidate {
    let (a, b) = if found.is_on_first { (a, b) } else { (b, a) };
    let plane = Feature::Plane { origin: found.origin, normal: found.normal };
    let (edge, feature) = match found.place {
        Place::Vertex => (None, plane),
        Place::CutEdge { edge, side } => (Some(Edge::Cut { direction: edge, side }), plane),
        Place::OverVertex { face } => (Some(Edge::OverVertex { face }), plane),
        Place::Crossing { edge, other } => {
            let crossing = Edge::Crossing { direction: edge, curvature: Vec3::zero() };
            (Some(crossing), Feature::Line { origin: found.origin, direction: other })
        }
    };
    ContactCandidate { id: found.feature, edge, ..candidate(a, b, found.point, 0.0, feature) }
}

fn points_on_plane(points: &(Vec<Vec3<f64>>, f64), a: &Collider, b: &Collider, slots: &mut [Option<ContactCandidate>]) {
    let (points, radius) = points;
    for (slot, point) in slots.iter_mut().zip(points) {
        *slot = Some(candidate(a, b, *point, *radius, plane_of(b)));
    }
}

fn balls(a: &Collider, b: &Collider) -> ContactCandidate {
    let (ra, rb) = (a.ball().unwrap_or(0.0), b.ball().unwrap_or(0.0));
    let feature = Feature::Point { origin: b.pose.pos };
    ContactCandidate { radius_a: ra, ..candidate(a, b, a.pose.pos, ra + rb, feature) }
}

/// Face, edge or vertex of the cuboid that is closest to the sphere's centre; from inside, the nearest face.
fn ball_on_cuboid(a: &Collider, b: &Collider, (at_a, at_b): (&Pose<f64>, &Pose<f64>)) -> ContactCandidate {
    let radius = a.ball().unwrap_or(0.0);
    let Surface::Solid(Shape::Cuboid { size }) = b.surface else { unreachable!("the pair is a ball on a cuboid") };
    let c = at_b.rot.tr_mul_vec(at_a.pos - at_b.pos);
    let half = size.map(|s| 0.5 * s);
    let outside = |k: usize| c[k].abs() > half[k];
    let side = |k: usize| if c[k] < 0.0 { -half[k] } else { half[k] };
    let nearest = Vec3(std::array::from_fn(|k| if outside(k) { side(k) } else { c[k] }));
    let in_link = |p: Vec3<f64>| b.pose.point(p);
    let feature = match (0..3).filter(|k| outside(*k)).count() {
        3 => Feature::Point { origin: in_link(nearest) },
        2 => {
            let along = (0..3).find(|k| !outside(*k)).unwrap_or(0);
            Feature::Line { origin: in_link(nearest), direction: b.pose.rot.col(along) }
        }
        _ => {
            let depth = |k: usize| half[k] - c[k].abs();
            let k = (0..3)
                .find(|k| outside(*k))
                .unwrap_or_else(|| (1..3).fold(0, |best, k| if depth(k) < depth(best) { k } else { best }));
            let sign = if c[k] < 0.0 { -1.0 } else { 1.0 };
            Feature::Plane { origin: in_link(Vec3::along(k, side(k))), normal: b.pose.rot.col(k).scale(sign) }
        }
    };
    candidate(a, b, a.pose.pos, radius, feature)
}

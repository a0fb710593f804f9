//! GJK: distance and closest points of two convex sets, each known by its support mapping alone. For distances and
//! proximity sensors; a few hundred nanoseconds for boxes.
//!
//! v(k+1) is the point closest to the origin of a simplex of at most four points of A − B; the next point is the
//! support point of A − B along −v. The iteration ends when v·(v − w) vanishes: |v| then equals the distance to within
//! that. The closest part of the simplex is found by trying all its faces, which no rounding error can mislead. Source:
//! E. G. Gilbert, D. W. Johnson, S. S. Keerthi, 1988; key `ericson2004`, section 9.5.
//!
//! | symbol | meaning |
//! |---|---|
//! | w = a − b | a point of A − B with the points of A and B that it comes from |
//! | v | the point of the simplex closest to the origin |
//! | λ | its barycentric coordinates |

use crate::spatial::Vec3;

/// Relative error of a distance at which the iteration ends; curved sets converge point by point, polytopes end before.
const ENOUGH: f64 = 1e-14;
/// Iteration limit; boxes need about 5, cylinders on their rims about 30.
const MAX_ITERATIONS: usize = 300;
/// Distance, relative to the size of the sets, that is rounding: they overlap. A point deep inside a set can lie on a
/// face of the simplex, where the iteration ends.
const OVERLAPS: f64 = 16.0 * f64::EPSILON;
/// Gram determinants below this, by the squares of their edges, are those of simplices without extent.
const FLAT: f64 = 1e-26;

/// Tolerance between the two expressions for the closest point of a simplex, relative to its size.
const SOUND: f64 = 1e-13;

/// Convex set with its support mapping.
pub(super) trait Convex {
    /// Support mapping: the point of the set farthest along `d`, of any length but zero.
    fn support(&self, d: Vec3<f64>) -> Vec3<f64>;
    /// A point in the set or near it, for the first direction.
    fn interior_point(&self) -> Vec3<f64>;
}

/// Closest points of two sets; one common point if they overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Separation {
    /// Distance `[m]`, 0 if the sets overlap.
    pub distance: f64,
    /// Points on the first and the second set; the same if they overlap.
    pub points: [Vec3<f64>; 2],
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    w: Vec3<f64>,
    a: Vec3<f64>,
    b: Vec3<f64>,
}

/// A simplex with the weights of its point that is closest to the origin.
struct Simplex {
    corners: [Corner; 4],
    weights: [f64; 4],
    n: usize,
    /// Closest point; not from the weights, because it must be perpendicular to the simplex even where that is tiny.
    v: Vec3<f64>,
}

/// The closest points of two convex sets.
pub(super) fn gjk(a: &impl Convex, b: &impl Convex) -> Separation {
    let corner = |d: Vec3<f64>| {
        let (a, b) = (a.support(-d), b.support(d));
        Corner { w: a - b, a, b }
    };
    let mut start = a.interior_point() - b.interior_point();
    if start.dot(start) == 0.0 {
        start = Vec3([1.0, 0.0, 0.0]);
    }
    let first = corner(start);
    let mut simplex = Simplex { corners: [first; 4], weights: [1.0, 0.0, 0.0, 0.0], n: 1, v: first.w };
    let (mut v, mut largest) = (first.w, 0.0_f64);
    for _ in 0..MAX_ITERATIONS {
        let square = v.dot(v);
        if square == 0.0 {
            return simplex.meeting();
        }
        let next = corner(v);
        let size = next.a.norm().max(next.b.norm());
        largest = largest.max(size);
        let excess = square - v.dot(next.w);
        if excess <= ENOUGH * square || excess <= f64::EPSILON * square.sqrt() * size {
            break;
        }
        if simplex.corners[..simplex.n].iter().any(|c| c.w == next.w) {
            break;
        }
        let Some(nearer) = simplex.take(next) else { return simplex.meeting() };
        let closer = nearer.v;
        if closer.dot(closer) >= square {
            break;
        }
        v = closer;
        simplex = nearer;
        if v.norm() <= OVERLAPS * largest {
            return simplex.meeting();
        }
    }
    if v.norm() <= OVERLAPS * largest {
        return simplex.meeting();
    }
    Separation { distance: v.norm(), points: simplex.points() }
}

impl Simplex {
    fn points(&self) -> [Vec3<f64>; 2] {
        [self.sum(|c| c.a), self.sum(|c| c.b)]
    }

    fn sum(&self, of: impl Fn(&Corner) -> Vec3<f64>) -> Vec3<f64> {
        let parts = self.corners[..self.n].iter().zip(&self.weights);
        parts.fold(Vec3::zero(), |sum, (c, weight)| sum + of(c).scale(*weight))
    }

    /// Common point of overlapping sets.
    fn meeting(&self) -> Separation {
        let [a, b] = self.points();
        Separation { distance: 0.0, points: [(a + b).scale(0.5); 2] }
    }

    /// Smallest face of this simplex and one more vertex that contains the point closest to the origin; none if the
    /// origin is inside all four: the weights are then those of the origin.
    fn take(&mut self, new: Corner) -> Option<Self> {
        let n = self.n;
        let mut best: Option<(f64, Self)> = None;
        for part in 0..1_usize << n {
            let mut found = Self { corners: [new; 4], weights: [0.0; 4], n: 1, v: new.w };
            for k in (0..n).filter(|k| part >> k & 1 == 1) {
                found.corners[found.n] = self.corners[k];
                found.n += 1;
            }
            if !(found.find_weights() && found.is_sound()) {
                continue;
            }
            if found.n == 4 {
                *self = found;
                return None;
            }
            let square = found.v.dot(found.v);
            if best.as_ref().is_none_or(|(least, _)| square < *least) {
                best = Some((square, found));
            }
        }
        best.map(|(_, found)| found)
    }

    /// Returns true if the weights give the point that the simplex's direction gives: vertices that coincide but for
    /// rounding have no direction.
    fn is_sound(&self) -> bool {
        let size = self.corners[..self.n].iter().fold(0.0_f64, |size, c| size.max(c.w.norm()));
        (self.sum(|c| c.w) - self.v).norm() <= SOUND * size
    }

    /// Reorders the vertices of a triangle: where two nearly coincide, as on curved sets, its normal is as accurate as
    /// the edge between them.
    fn begin_with_shortest_edge(&mut self) {
        let length = |i: usize, j: usize| {
            let edge = self.corners[i].w - self.corners[j].w;
            edge.dot(edge)
        };
        let (first, second, third) = (length(0, 1), length(1, 2), length(2, 0));
        if second <= first && second <= third {
            self.corners.swap(0, 2);
        } else if third < first {
            self.corners.swap(1, 2);
        }
    }

    /// Finds the barycentric coordinates of the point of the affine hull closest to the origin; returns true if all are
    /// positive.
    fn find_weights(&mut self) -> bool {
        if self.n == 3 {
            self.begin_with_shortest_edge();
        }
        let w0 = self.corners[0].w;
        let e = [1, 2, 3].map(|k| self.corners[k].w - w0);
        let weights = match self.n {
            1 => {
                self.v = w0;
                [0.0; 3]
            }
            2 => {
                let square = e[0].dot(e[0]);
                if square == 0.0 {
                    return false;
                }
                self.v = e[0].cross(w0.cross(e[0])).scale(1.0 / square);
                [-e[0].dot(w0) / square, 0.0, 0.0]
            }
            3 => {
                // areas lose fewer digits than the Gram matrix
                let normal = e[0].cross(e[1]);
                let det = normal.dot(normal);
                if det <= FLAT * e[0].dot(e[0]) * e[1].dot(e[1]) {
                    return false;
                }
                self.v = normal.scale(normal.dot(w0) / det);
                [normal.dot(e[1].cross(w0)) / det, normal.dot(w0.cross(e[0])) / det, 0.0]
            }
            _ => {
                let det = e[0].dot(e[1].cross(e[2]));
                let size = e[0].norm() * e[1].norm() * e[2].norm();
                if det.abs() <= 1e-13 * size {
                    return false;
                }
                self.v = Vec3::zero();
                let o = -w0;
                let volume = |x: Vec3<f64>, y: Vec3<f64>, z: Vec3<f64>| x.dot(y.cross(z)) / det;
                [volume(o, e[1], e[2]), volume(e[0], o, e[2]), volume(e[0], e[1], o)]
            }
        };
        let sum: f64 = weights.iter().sum();
        self.weights = [1.0 - sum, weights[0], weights[1], weights[2]];
        self.weights[..self.n].iter().all(|x| *x > 0.0)
    }
}

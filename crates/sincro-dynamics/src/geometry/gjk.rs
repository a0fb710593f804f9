//! The gap between two convex sets: their points that are closest to each other, known by nothing but the farthest point of each in any
//! direction. For distances and proximity sensors; a few hundred nanoseconds for boxes.
//!
//! v(k+1) is the point of the simplex of at most four points of A − B that is closest to the origin (Gilbert, Johnson, Keerthi 1988); the next point
//! is the farthest one against v. The end is where v·(v − w) is nothing any more: |v| is then within that of the distance. The simplex is searched
//! for its closest part by trying all of them, which no rounding can lead astray.
//!
//! | symbol | meaning |
//! |---|---|
//! | w = a − b | a point of A − B with the points of A and B that it comes from |
//! | v | the point of the simplex closest to the origin |
//! | λ | its weights |

use crate::spatial::Vec3;

/// Relative error of a distance at which the search ends; curved sets are approached point by point, polytopes end before.
const ENOUGH: f64 = 1e-14;
/// Steps after which the search ends whatever is reached; boxes need about 5, cylinders on their rims about 30.
const MAX_ITERATIONS: usize = 300;
/// Gram determinants below this, by the squares of their edges, are those of simplices without extent.
const FLAT: f64 = 1e-26;

/// How far apart the two ways to the closest point of a simplex may be, by its size, for it to count.
const SOUND: f64 = 1e-13;

/// A convex set that knows its farthest point in a direction.
pub(super) trait Convex {
    /// The point farthest along `d`, of any length but zero.
    fn support(&self, d: Vec3<f64>) -> Vec3<f64>;
    /// A point that is in it or near it.
    fn interior_point(&self) -> Vec3<f64>;
}

/// Two points closest to each other: none of them, but one of both sets, if the sets meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Separation {
    /// `[m]`, 0 if the sets meet.
    pub distance: f64,
    /// On the first and the second set; the same if they meet.
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
    /// That point; not from the weights, because it must be at right angles to the simplex even where it is tiny.
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
    let mut v = first.w;
    for _ in 0..MAX_ITERATIONS {
        let square = v.dot(v);
        if square == 0.0 {
            return simplex.meeting();
        }
        let next = corner(v);
        let size = next.a.norm().max(next.b.norm());
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
        if v.norm() <= f64::EPSILON * size {
            return simplex.meeting();
        }
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

    /// The sets meet where the two points are.
    fn meeting(&self) -> Separation {
        let [a, b] = self.points();
        Separation { distance: 0.0, points: [(a + b).scale(0.5); 2] }
    }

    /// The smallest part of this simplex and one more corner that holds the point closest to the origin; none if the origin is inside all
    /// four: their weights are then those of the origin.
    fn take(&mut self, new: Corner) -> Option<Self> {
        let n = self.n;
        let mut best: Option<(f64, Self)> = None;
        for part in 0..1_usize << n {
            let mut found = Self { corners: [new; 4], weights: [0.0; 4], n: 1, v: new.w };
            for k in (0..n).filter(|k| part >> k & 1 == 1) {
                found.corners[found.n] = self.corners[k];
                found.n += 1;
            }
            if !(found.set_mass_properties() && found.is_sound()) {
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

    /// Whether the weights give the point that the simplex's direction gives: corners that coincide but for rounding have no direction.
    fn is_sound(&self) -> bool {
        let size = self.corners[..self.n].iter().fold(0.0_f64, |size, c| size.max(c.w.norm()));
        (self.sum(|c| c.w) - self.v).norm() <= SOUND * size
    }

    /// Where two corners nearly coincide, as on curved sets, the normal of a triangle is as exact as the edge between them.
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

    /// Weights of the point of the affine hull that is closest to the origin; whether all of them are positive.
    fn set_mass_properties(&mut self) -> bool {
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

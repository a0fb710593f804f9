//! Bounding volume hierarchy: triangles in a binary tree of axis-aligned boxes, traversed nearest first. Source: key
//! `ericson2004`, chapter 6.

use super::gjk::gjk;
use super::support::{Core, ON, POINT, Placed};
use crate::spatial::{Pose, Vec3};

/// Maximum number of triangles in a leaf.
const LEAF: usize = 4;

/// Triangles and the boxes that bound them.
#[derive(Clone, Debug, Default)]
pub(super) struct Bvh {
    triangles: Vec<[Vec3<f64>; 3]>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3<f64>,
    high: Vec3<f64>,
    /// Triangles below it.
    first: u32,
    n: u32,
    /// Its second child; the first one comes right after it. 0: it is a leaf.
    second: u32,
}

impl Bvh {
    /// Builds the hierarchy of triangles, divided at the median along the longest axis.
    pub fn new(mut triangles: Vec<[Vec3<f64>; 3]>) -> Self {
        let mut nodes = Vec::new();
        let n = triangles.len();
        if n > 0 {
            divide(&mut triangles, 0, &mut nodes);
        }
        Self { triangles, nodes }
    }

    /// All triangles.
    pub fn triangles(&self) -> &[[Vec3<f64>; 3]] {
        &self.triangles
    }

    /// Visits all triangles whose box is nearer to `center` than `reach` plus a bound, which begins with `max_distance`
    /// and becomes the smallest distance that `look` returned.
    pub fn visit(
        &self,
        center: Vec3<f64>,
        reach: f64,
        max_distance: f64,
        look: &mut impl FnMut(&[Vec3<f64>; 3], f64) -> Option<f64>,
    ) {
        if !self.nodes.is_empty() {
            let mut max_distance = max_distance;
            self.descend(0, center, reach, &mut max_distance, look);
        }
    }

    fn descend(
        &self,
        k: usize,
        center: Vec3<f64>,
        reach: f64,
        max_distance: &mut f64,
        look: &mut impl FnMut(&[Vec3<f64>; 3], f64) -> Option<f64>,
    ) {
        let node = &self.nodes[k];
        if node.distance(center) - reach > *max_distance {
            return;
        }
        if node.second == 0 {
            for triangle in &self.triangles[node.first as usize..][..node.n as usize] {
                if let Some(found) = look(triangle, *max_distance) {
                    *max_distance = max_distance.min(found);
                }
            }
            return;
        }
        let (a, b) = (k + 1, node.second as usize);
        let turned = self.nodes[b].distance(center) < self.nodes[a].distance(center);
        for child in if turned { [b, a] } else { [a, b] } {
            self.descend(child, center, reach, max_distance, look);
        }
    }

    /// Normal of the triangle at a point; of several, the one that faces `towards` most.
    pub fn normal_near(&self, p: Vec3<f64>, towards: Vec3<f64>) -> Vec3<f64> {
        let point = Placed { core: POINT, radius: 0.0, pose: Pose::translation(p) };
        let off = |triangle: &[Vec3<f64>; 3]| {
            gjk(&point, &Placed { core: Core::Triangle(*triangle), radius: 0.0, pose: Pose::identity() }).distance
        };
        let mut least = f64::INFINITY;
        self.visit(p, 0.0, f64::INFINITY, &mut |triangle, max_distance| {
            least = least.min(off(triangle));
            Some(least.min(max_distance))
        });
        let mut best = (f64::NEG_INFINITY, Vec3([0.0, 0.0, 1.0]));
        self.visit(p, 0.0, least + ON, &mut |triangle, max_distance| {
            if off(triangle) <= max_distance {
                let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
                let normal = normal.scale(1.0 / normal.norm().max(f64::MIN_POSITIVE));
                if normal.dot(towards) > best.0 {
                    best = (normal.dot(towards), normal);
                }
            }
            None
        });
        best.1
    }
}

impl Node {
    /// Distance of a point from the box `[m]`.
    fn distance(&self, p: Vec3<f64>) -> f64 {
        let off: Vec3<f64> = Vec3(std::array::from_fn(|k| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0)));
        off.norm()
    }
}

/// Appends the node of some triangles, the first of which has index `first` in the whole, and all nodes below it.
fn divide(triangles: &mut [[Vec3<f64>; 3]], first: usize, nodes: &mut Vec<Node>) {
    let corners = || triangles.iter().flatten();
    let bound = |k: usize, f: fn(f64, f64) -> f64, start: f64| corners().map(|c| c[k]).fold(start, f);
    let low = Vec3(std::array::from_fn(|k| bound(k, f64::min, f64::INFINITY)));
    let high = Vec3(std::array::from_fn(|k| bound(k, f64::max, f64::NEG_INFINITY)));
    let (own, n) = (nodes.len(), triangles.len());
    nodes.push(Node { low, high, first: first as u32, n: n as u32, second: 0 });
    if n <= LEAF {
        return;
    }
    let size = high - low;
    let axis = (1..3).fold(0, |widest, k| if size[k] > size[widest] { k } else { widest });
    let middle = |t: &[Vec3<f64>; 3]| t[0][axis] + t[1][axis] + t[2][axis];
    triangles.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    let (one, two) = triangles.split_at_mut(n / 2);
    divide(one, first, nodes);
    nodes[own].second = nodes.len() as u32;
    divide(two, first + n / 2, nodes);
}

//! In which pixels a piece can be: the rectangle of the box about it.

use sincro_geometry::Shape;
use sincro_geometry::Surface;
use sincro_geometry::spatial::{Mat3, Pose, Vec3};

use crate::{Lens, Optics};

/// A box about a surface, in the surface's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Extent {
    /// A ball about the origin.
    Ball(f64),
    /// Least and greatest coordinates.
    Box([f64; 3], [f64; 3]),
    /// No end.
    Endless,
}

/// Columns and rows, ends not among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub columns: (usize, usize),
    pub rows: (usize, usize),
}

impl Extent {
    pub fn of(surface: &Surface) -> Self {
        let about = |half: [f64; 3]| Self::Box(half.map(|x| -x), half);
        match surface {
            Surface::Solid(Shape::Sphere { radius }) => Self::Ball(*radius),
            Surface::Solid(Shape::Cuboid { size }) => about(size.map(|x| 0.5 * x)),
            Surface::Solid(Shape::Cylinder { radius, length }) => about([*radius, *radius, 0.5 * length]),
            Surface::Solid(Shape::Capsule { radius, length }) => about([*radius, *radius, 0.5 * length + radius]),
            Surface::Solid(Shape::Torus { major_radius: a, tube_radius: r }) => about([a + r, a + r, *r]),
            Surface::Solid(Shape::Cone { radius, length }) => {
                Self::Box([-radius, -radius, -0.25 * length], [*radius, *radius, 0.75 * length])
            }
            Surface::HalfSpace => Self::Endless,
            Surface::Hull(points) | Surface::Mesh(points, _) => Self::of_points(points),
            Surface::HeightField { heights, size, .. } => {
                let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
                let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                Self::Box([-0.5 * size[0], -0.5 * size[1], low], [0.5 * size[0], 0.5 * size[1], high])
            }
        }
    }

    fn of_points(points: &[[f64; 3]]) -> Self {
        let bound =
            |of: fn(f64, f64) -> f64, start: f64| std::array::from_fn(|k| points.iter().map(|p| p[k]).fold(start, of));
        Self::Box(bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY))
    }

    /// Rectangle of the image that may show it; none if it is outside. `x_cp` is the pose of the piece against the
    /// camera.
    pub fn rectangle(&self, x_cp: &Pose<f64>, optics: &Optics) -> Option<Rectangle> {
        let [columns, rows] = optics.resolution;
        let (low, high, x_cp) = match self {
            Self::Endless => return Some(Rectangle { columns: (0, columns), rows: (0, rows) }),
            // a ball has no axes: the camera's are the tightest
            Self::Ball(radius) => ([-radius; 3], [*radius; 3], &Pose { rot: Mat3::identity(), ..*x_cp }),
            Self::Box(low, high) => (*low, *high, x_cp),
        };
        let corner = |k: usize| {
            let pick = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
            x_cp.point(Vec3([pick(0), pick(1), pick(2)]))
        };
        let corners: [Vec3<f64>; 8] = std::array::from_fn(corner);
        let mut range = Range::new(optics);
        if corners.iter().all(|p| p[2] > optics.far) {
            return None;
        }
        for (k, p) in corners.iter().enumerate() {
            if p[2] >= optics.near {
                range.add(*p);
            }
            // where an edge comes through the near plane
            for axis in (0..3).filter(|axis| k >> axis & 1 == 0) {
                let q = corners[k | 1 << axis];
                if (p[2] < optics.near) != (q[2] < optics.near) {
                    let share = (optics.near - p[2]) / (q[2] - p[2]);
                    let through = *p + (q - *p).scale(share);
                    range.add(Vec3([through[0], through[1], optics.near]));
                }
            }
        }
        range.rectangle(optics)
    }
}

/// Extent of points in an image, in pixels from the lower left corner.
struct Range {
    is_perspective: bool,
    pixel: f64,
    low: [f64; 2],
    high: [f64; 2],
}

impl Range {
    fn new(optics: &Optics) -> Self {
        let is_perspective = matches!(optics.lens, Lens::Perspective(_));
        Self { is_perspective, pixel: optics.pixel(), low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] }
    }

    /// A point before the camera.
    fn add(&mut self, p: Vec3<f64>) {
        let scale = self.pixel * if self.is_perspective { p[2] } else { 1.0 };
        for (k, x) in [-p[0] / scale, p[1] / scale].into_iter().enumerate() {
            self.low[k] = self.low[k].min(x);
            self.high[k] = self.high[k].max(x);
        }
    }

    fn rectangle(&self, optics: &Optics) -> Option<Rectangle> {
        let side = |k: usize| {
            let n = optics.resolution[k] as f64;
            // the middle of pixel i is at i + ½ − n/2; one pixel of grace on each side for rounding
            let start = (self.low[k] + 0.5 * n - 1.5).floor().clamp(0.0, n) as usize;
            let end = (self.high[k] + 0.5 * n + 1.5).ceil().clamp(0.0, n) as usize;
            (start < end).then_some((start, end))
        };
        Some(Rectangle { columns: side(0)?, rows: side(1)? })
    }
}

//! Contents of octrees and point clouds: cubes of one size by their place, and points, each with a colour.
//!
//! Places are in the frame of the octree or point cloud `[m]`.

use std::collections::BTreeMap;

use super::work::check_operations;
use super::{ApiError, MAX_LENGTH};

/// Voxels of an octree, or points of a point cloud, at most.
pub const MAX_ITEMS: usize = 20_000;

/// Voxels of an octree: cubes of one size whose edges lie along the axes, a corner of one of them in the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Voxels {
    size: f64,
    /// Colour and tag of the voxel `[i, j, k]`, from `i·size` to `(i + 1)·size` along x.
    cells: BTreeMap<[i32; 3], ([u8; 3], i64)>,
}

impl Voxels {
    /// Creates an empty octree with voxels of that size `[m]`.
    ///
    /// # Errors
    ///
    /// The size is not positive, or more than [`MAX_LENGTH`].
    pub fn new(size: f64) -> Result<Self, ApiError> {
        if !(size > 0.0 && size <= MAX_LENGTH) {
            return Err(ApiError(format!("voxels of {size} m: expected more than 0, at most {MAX_LENGTH}")));
        }
        Ok(Self { size, cells: BTreeMap::new() })
    }

    /// Size of a voxel `[m]`.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Number of voxels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Returns true if there are no voxels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The voxel that a point `[m]` is in.
    fn cell(&self, point: [f64; 3]) -> Result<[i32; 3], ApiError> {
        check_place(point)?;
        let mut cell = [0; 3];
        for (index, x) in cell.iter_mut().zip(point) {
            let place = (x / self.size).floor();
            if !(-1e9..=1e9).contains(&place) {
                return Err(ApiError(format!("a point at {x} m is too far away for voxels of {} m", self.size)));
            }
            *index = place as i32;
        }
        Ok(cell)
    }

    /// Adds the voxel that a point `[m]` is in, or gives it another colour and tag. Returns its centre `[m]` if it is
    /// new.
    ///
    /// # Errors
    ///
    /// The point is too far away, or there are [`MAX_ITEMS`] voxels already.
    pub fn insert(&mut self, point: [f64; 3], color: [u8; 3], tag: i64) -> Result<Option<[f64; 3]>, ApiError> {
        let cell = self.cell(point)?;
        let is_new = !self.cells.contains_key(&cell);
        if is_new && self.cells.len() >= MAX_ITEMS {
            return Err(ApiError(format!("an octree has {MAX_ITEMS} voxels at most: take larger ones")));
        }
        self.cells.insert(cell, (color, tag));
        Ok(is_new.then(|| self.center(&cell)))
    }

    /// Removes the voxel that a point `[m]` is in; nothing if there is none.
    ///
    /// # Errors
    ///
    /// The point is too far away.
    pub fn remove(&mut self, point: [f64; 3]) -> Result<(), ApiError> {
        let cell = self.cell(point)?;
        self.cells.remove(&cell);
        Ok(())
    }

    /// Removes all voxels.
    pub fn clear(&mut self) {
        self.cells.clear();
    }

    /// Tag of the voxel that a point `[m]` is in; none if there is none.
    ///
    /// # Errors
    ///
    /// The point is too far away.
    pub fn tag_at(&self, point: [f64; 3]) -> Result<Option<i64>, ApiError> {
        Ok(self.cells.get(&self.cell(point)?).map(|(_, tag)| *tag))
    }

    /// Adds the voxels that a triangle `[m]` meets, or gives them another colour and tag. Returns the number of voxels
    /// that were looked at, those in the box about the triangle.
    ///
    /// # Errors
    ///
    /// A corner is too far away, the box has too many voxels, or there are [`MAX_ITEMS`] voxels already.
    pub fn insert_triangle(&mut self, corners: [[f64; 3]; 3], color: [u8; 3], tag: i64) -> Result<u64, ApiError> {
        let (met, n) = self.cells_of(corners)?;
        met.into_iter().try_for_each(|cell| self.insert(self.center(&cell), color, tag).map(|_| ()))?;
        Ok(n)
    }

    /// Removes the voxels that a triangle `[m]` meets. Returns the number of voxels that were looked at.
    ///
    /// # Errors
    ///
    /// A corner is too far away, or the box about the triangle has too many voxels.
    pub fn remove_triangle(&mut self, corners: [[f64; 3]; 3]) -> Result<u64, ApiError> {
        let (met, n) = self.cells_of(corners)?;
        for cell in met {
            self.cells.remove(&cell);
        }
        Ok(n)
    }

    /// The voxels that a triangle meets, and the number of those in the box about it.
    fn cells_of(&self, corners: [[f64; 3]; 3]) -> Result<(Vec<[i32; 3]>, u64), ApiError> {
        let cells = [self.cell(corners[0])?, self.cell(corners[1])?, self.cell(corners[2])?];
        let low = [0, 1, 2].map(|k| cells.iter().map(|cell| cell[k]).min().unwrap_or(0));
        let high = [0, 1, 2].map(|k| cells.iter().map(|cell| cell[k]).max().unwrap_or(0));
        let n = (0..3).fold(1_u64, |n, k| n.saturating_mul(u64::from(high[k].abs_diff(low[k])) + 1));
        check_operations(n, "comparisons of voxels", "take larger voxels")?;
        let mut met = Vec::new();
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for k in low[2]..=high[2] {
                    if triangle_meets_cube(corners, self.center(&[i, j, k]), 0.5 * self.size) {
                        met.push([i, j, k]);
                    }
                }
            }
        }
        Ok((met, n))
    }

    fn center(&self, cell: &[i32; 3]) -> [f64; 3] {
        cell.map(|k| (f64::from(k) + 0.5) * self.size)
    }

    /// Centres `[m]` and colours of all voxels, in the order of their places.
    pub fn items(&self) -> impl Iterator<Item = ([f64; 3], [u8; 3])> {
        self.cells.iter().map(|(cell, (color, _))| (self.center(cell), *color))
    }
}

/// Returns true if a triangle and a cube of half the edge `half` along the axes have a point in common: no axis
/// separates them, of the cube, the triangle, and edge by edge (T. Akenine-Möller, "Fast 3D Triangle-Box Overlap
/// Testing", 2001).
fn triangle_meets_cube(corners: [[f64; 3]; 3], center: [f64; 3], half: f64) -> bool {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let points = corners.map(|corner| minus(corner, center));
    let edges = [minus(points[1], points[0]), minus(points[2], points[1]), minus(points[0], points[2])];
    let separates = |axis: [f64; 3]| {
        let reach = half * (axis[0].abs() + axis[1].abs() + axis[2].abs());
        let along = points.map(|p| axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2]);
        along.iter().all(|x| *x > reach) || along.iter().all(|x| *x < -reach)
    };
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let is_separated = axes.iter().any(|axis| separates(*axis))
        || separates(cross(edges[0], edges[1]))
        || axes.iter().any(|axis| edges.iter().any(|edge| separates(cross(*axis, *edge))));
    !is_separated
}

/// Points of a point cloud, in the order in which they were added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    points: Vec<([f64; 3], [u8; 3])>,
}

impl Points {
    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Returns true if there are no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Adds a point `[m]`, unless one is nearer than `tolerance` `[m]`. Returns true if it was added.
    ///
    /// # Errors
    ///
    /// A coordinate of the point is beyond [`MAX_LENGTH`], or there are [`MAX_ITEMS`] points already.
    pub fn insert(&mut self, point: [f64; 3], color: [u8; 3], tolerance: f64) -> Result<bool, ApiError> {
        check_place(point)?;
        if tolerance > 0.0 && self.points.iter().any(|(other, _)| is_within(*other, point, tolerance)) {
            return Ok(false);
        }
        if self.points.len() >= MAX_ITEMS {
            return Err(ApiError(format!("a point cloud has {MAX_ITEMS} points at most: give a duplicate tolerance")));
        }
        self.points.push((point, color));
        Ok(true)
    }

    /// Removes the points that are nearer to a place `[m]` than `tolerance` `[m]`.
    pub fn remove(&mut self, place: [f64; 3], tolerance: f64) {
        self.points.retain(|(point, _)| !is_within(*point, place, tolerance));
    }

    /// Keeps only the points that are nearer than `tolerance` `[m]` to one of some places `[m]`.
    pub fn keep(&mut self, places: &[[f64; 3]], tolerance: f64) {
        self.points.retain(|(point, _)| places.iter().any(|place| is_within(*point, *place, tolerance)));
    }

    /// Removes the points that are in voxels of an octree.
    ///
    /// # Errors
    ///
    /// A point is too far away for the voxels.
    pub fn remove_in(&mut self, voxels: &Voxels) -> Result<(), ApiError> {
        let mut stays = Vec::with_capacity(self.points.len());
        for item in &self.points {
            if voxels.tag_at(item.0)?.is_none() {
                stays.push(*item);
            }
        }
        self.points = stays;
        Ok(())
    }

    /// Removes all points.
    pub fn clear(&mut self) {
        self.points.clear();
    }

    /// Places `[m]` and colours of all points.
    pub fn items(&self) -> impl Iterator<Item = ([f64; 3], [u8; 3])> {
        self.points.iter().copied()
    }
}

fn check_place(point: [f64; 3]) -> Result<(), ApiError> {
    match point.iter().find(|x| !(-MAX_LENGTH..=MAX_LENGTH).contains(*x)) {
        Some(x) => Err(ApiError(format!("a point at {x} m: expected -{MAX_LENGTH} to {MAX_LENGTH}"))),
        None => Ok(()),
    }
}

fn is_within(a: [f64; 3], b: [f64; 3], distance: f64) -> bool {
    let [x, y, z]: [f64; 3] = std::array::from_fn(|k| a[k] - b[k]);
    x * x + y * y + z * z <= distance * distance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_one_cube_are_one_voxel() {
        let mut voxels = Voxels::new(0.5).unwrap();
        assert_eq!(voxels.insert([0.1, 0.1, 0.1], [255, 0, 0], 7).unwrap(), Some([0.25; 3]));
        assert_eq!(voxels.insert([0.4, 0.4, 0.4], [0, 255, 0], 8).unwrap(), None);
        assert_eq!(voxels.insert([-0.1, 0.4, 0.4], [0, 0, 255], 9).unwrap(), Some([-0.25, 0.25, 0.25]));
        assert_eq!((voxels.len(), voxels.tag_at([0.2; 3]).unwrap()), (2, Some(8)));
        voxels.remove([0.49; 3]).unwrap();
        assert_eq!(voxels.items().collect::<Vec<_>>(), [([-0.25, 0.25, 0.25], [0, 0, 255])]);
        assert!(voxels.insert([f64::NAN, 0.0, 0.0], [0; 3], 0).is_err() && Voxels::new(0.0).is_err());
    }

    #[test]
    fn a_triangle_fills_the_voxels_that_it_meets() {
        let mut voxels = Voxels::new(1.0).unwrap();
        let flat = [[0.1, 0.1, 0.5], [2.5, 0.1, 0.5], [0.1, 2.5, 0.5]];
        assert_eq!(voxels.insert_triangle(flat, [0; 3], 3).unwrap(), 9);
        // the long side is x + y = 2.6: of the nine, three lie beyond it
        let met: Vec<[f64; 2]> = voxels.items().map(|([x, y, _], _)| [x, y]).collect();
        assert_eq!(met, [[0.5, 0.5], [0.5, 1.5], [0.5, 2.5], [1.5, 0.5], [1.5, 1.5], [2.5, 0.5]]);
        // x + y + z = 3.5: the box about it has the voxel at the origin, which the triangle does not meet
        let oblique = [[0.0, 0.0, 3.5], [3.5, 0.0, 0.0], [0.0, 3.5, 0.0]];
        let mut others = Voxels::new(1.0).unwrap();
        others.insert_triangle(oblique, [0; 3], 0).unwrap();
        assert_eq!((others.tag_at([0.1; 3]).unwrap(), others.tag_at([1.2, 0.9, 0.5]).unwrap()), (None, Some(0)));
        let mut points = Points::default();
        points.insert([0.1; 3], [0; 3], 0.0).unwrap();
        points.insert([1.2, 0.9, 0.5], [0; 3], 0.0).unwrap();
        points.remove_in(&others).unwrap();
        assert_eq!(points.len(), 1);
        voxels.remove_triangle(flat).unwrap();
        assert!(voxels.is_empty());
        let far = [[0.0; 3], [1e6, 1e6, 0.0], [1e6, 0.0, 1e6]];
        assert!(voxels.insert_triangle(far, [0; 3], 0).unwrap_err().0.contains("larger voxels"));
    }

    #[test]
    fn a_point_near_another_one_is_not_added() {
        let mut points = Points::default();
        assert!(points.insert([0.0; 3], [0; 3], 0.01).unwrap());
        assert!(!points.insert([0.005, 0.0, 0.0], [0; 3], 0.01).unwrap());
        assert!(points.insert([0.005, 0.0, 0.0], [0; 3], 0.0).unwrap());
        points.remove([0.0; 3], 0.001);
        assert_eq!(points.items().next(), Some(([0.005, 0.0, 0.0], [0; 3])));
        points.keep(&[[1.0; 3]], 0.1);
        assert!(points.is_empty());
    }

    #[test]
    fn voxels_and_points_are_as_near_as_shapes() {
        let mut voxels = Voxels::new(MAX_LENGTH).unwrap();
        let mut points = Points::default();
        voxels.insert([MAX_LENGTH, -MAX_LENGTH, 0.0], [0; 3], 0).unwrap();
        points.insert([MAX_LENGTH, -MAX_LENGTH, 0.0], [0; 3], 0.0).unwrap();
        for x in [1.000_001 * MAX_LENGTH, -1.000_001 * MAX_LENGTH, f64::INFINITY, f64::NAN] {
            let why = [
                voxels.insert([0.0, x, 0.0], [0; 3], 0).unwrap_err().0,
                points.insert([0.0, x, 0.0], [0; 3], 0.0).unwrap_err().0,
            ];
            assert!(why.iter().all(|why| why.contains("expected -1000000 to 1000000")), "{why:?}");
            assert!(voxels.remove([x; 3]).is_err() && voxels.tag_at([x; 3]).is_err());
            assert!(Voxels::new(x).is_err());
        }
        assert_eq!((voxels.len(), points.len()), (1, 1));
    }

    #[test]
    fn contents_have_a_limit() {
        let mut points = Points::default();
        for k in 0..MAX_ITEMS {
            points.insert([k as f64, 0.0, 0.0], [0; 3], 0.0).unwrap();
        }
        assert!(points.insert([-1.0; 3], [0; 3], 0.0).is_err());
    }
}

//! Functions: octrees and point clouds. Voxels are cubes, points small balls: sensors, distances and pictures see them
//! as they see shapes; they have no mass and touch nothing.

use sincro_dynamics::contact::Surface;
use sincro_dynamics::model::Shape;
use sincro_dynamics::spatial::Vec3;
use sincro_values::clouds::{Points, Voxels};
use sincro_values::work::check_operations;

use super::{Function, Outcome, handle, one};
use crate::api::registry::Kind;
use crate::api::{ApiError, Arguments, Handle, Reference, SimApi, Value};

/// Radius of the ball that a point is `[m]`.
const POINT_RADIUS: f64 = 0.0025;
/// Comparisons of points in the time in which a voxel or point is copied or shown.
const PER_ITEM: u64 = 32;
/// Comparisons with which a voxel is found among the others.
const PER_VOXEL: usize = 16;
/// Option: points are given in the frame of the octree or point cloud, not in the world.
const IS_LOCAL: i64 = 1;
/// Option: each point has a colour of its own.
const HAS_COLORS: i64 = 2;
/// Operations that are counted, and advice where they are too many.
const WORK: &str = "comparisons of points";
const HELP: &str = "give fewer points in one call, or fill several octrees or point clouds";

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "createOctree",
        tip: "int handle=sim.createOctree(float voxelSize,int options=0,float pointSize=1)",
        run: |sim, a| {
            let voxels = Voxels::new(a.real(0)?)?;
            let own = sim.create_shape("Octree", Vec::new())?;
            sim.registry.octrees.insert(own, voxels);
            one(own)
        },
    },
    Function {
        name: "insertVoxelsIntoOctree",
        tip: "int totalVoxelCnt=sim.insertVoxelsIntoOctree(int octreeHandle,int options,float[] pts,int[] color=nil,int[] tag=nil)",
        run: insert_voxels,
    },
    Function {
        name: "insertObjectIntoOctree",
        tip: "int totalVoxelCnt=sim.insertObjectIntoOctree(int octreeHandle,int objectHandle,int options,int[3] color=nil,int tag=0)",
        run: |sim, a| {
            let (own, mut voxels) = octree(sim, a)?;
            let (color, tag) = (color(a, 3)?, a.int_or(4, 0)?);
            voxelize(sim, own, handle(sim, a, 1)?, |n, item| match item {
                Item::Point(point) => voxels.insert(point, color, tag).map(|_| ()),
                Item::Triangle(corners) => voxels.insert_triangle(corners, color, tag).map(|more| *n += more),
            })?;
            show_voxels(sim, own, voxels)
        },
    },
    Function {
        name: "subtractObjectFromOctree",
        tip: "int totalVoxelCnt=sim.subtractObjectFromOctree(int octreeHandle,int objectHandle,int options)",
        run: |sim, a| {
            let (own, mut voxels) = octree(sim, a)?;
            voxelize(sim, own, handle(sim, a, 1)?, |n, item| match item {
                Item::Point(point) => voxels.remove(point),
                Item::Triangle(corners) => voxels.remove_triangle(corners).map(|more| *n += more),
            })?;
            show_voxels(sim, own, voxels)
        },
    },
    Function {
        name: "removeVoxelsFromOctree",
        tip: "int totalVoxelCnt=sim.removeVoxelsFromOctree(int octreeHandle,int options,float[] pts=nil)",
        run: |sim, a| {
            let (own, mut voxels) = octree(sim, a)?;
            if a.has(2) {
                let given = points(sim, a, (own, 2))?;
                count(sim, given.len(), PER_VOXEL)?;
                given.into_iter().try_for_each(|point| voxels.remove(point))?;
            } else {
                voxels.clear();
            }
            show_voxels(sim, own, voxels)
        },
    },
    Function {
        name: "getOctreeVoxels",
        tip: "float[] voxels=sim.getOctreeVoxels(int octreeHandle)",
        run: |sim, a| super::list(octree(sim, a)?.1.items().flat_map(|(center, _)| center)),
    },
    Function {
        name: "checkOctreePointOccupancy",
        tip: "int result,int tag=sim.checkOctreePointOccupancy(int octreeHandle,int options,float[] points)",
        run: |sim, a| {
            let (own, voxels) = octree(sim, a)?;
            let given = points(sim, a, (own, 2))?;
            count(sim, given.len(), PER_VOXEL)?;
            let tags = given.into_iter().map(|point| voxels.tag_at(point)).collect::<Result<Vec<_>, ApiError>>()?;
            // of several points, whether one is inside
            let tag = tags.into_iter().flatten().next();
            Ok(vec![i64::from(tag.is_some()).into(), tag.unwrap_or(0).into()])
        },
    },
    Function {
        name: "createPointCloud",
        tip: "int handle=sim.createPointCloud(float maxVoxelSize,int maxPtCntPerVoxel,int options=0,float pointSize=1)",
        run: |sim, _| {
            let own = sim.create_shape("PointCloud", Vec::new())?;
            sim.registry.clouds.insert(own, Points::default());
            one(own)
        },
    },
    Function {
        name: "insertPointsIntoPointCloud",
        tip: "int totalPointCnt=sim.insertPointsIntoPointCloud(int pointCloudHandle,int options,float[] pts,int[] color=nil,float duplicateTolerance=0)",
        run: insert_points,
    },
    Function {
        name: "insertObjectIntoPointCloud",
        tip: "int totalPointCnt=sim.insertObjectIntoPointCloud(int pointCloudHandle,int objectHandle,int options,float gridSize,int[3] color=nil,float duplicateTolerance=0)",
        run: |sim, a| {
            let (own, mut cloud) = cloud(sim, a)?;
            let (color, tolerance) = (color(a, 4)?, distance(a, 5)?);
            let grid = on_grid(sim, own, handle(sim, a, 1)?, a.real(3)?)?;
            if tolerance > 0.0 {
                count(sim, grid.len(), cloud.len() + grid.len())?;
            }
            grid.items().try_for_each(|(point, _)| cloud.insert(point, color, tolerance).map(|_| ()))?;
            show_points(sim, own, cloud)
        },
    },
    Function {
        name: "subtractObjectFromPointCloud",
        tip: "int totalPointCnt=sim.subtractObjectFromPointCloud(int pointCloudHandle,int objectHandle,int options,float tolerance)",
        run: |sim, a| {
            let (own, mut cloud) = cloud(sim, a)?;
            let grid = on_grid(sim, own, handle(sim, a, 1)?, a.real(3)?)?;
            count(sim, cloud.len(), PER_VOXEL)?;
            cloud.remove_in(&grid)?;
            show_points(sim, own, cloud)
        },
    },
    Function {
        name: "removePointsFromPointCloud",
        tip: "int totalPointCnt=sim.removePointsFromPointCloud(int pointCloudHandle,int options,float[] pts,float distanceTolerance)",
        run: |sim, a| {
            let (own, mut cloud) = cloud(sim, a)?;
            if a.has(2) {
                let tolerance = distance(a, 3)?;
                let given = points(sim, a, (own, 2))?;
                count(sim, given.len(), cloud.len())?;
                given.into_iter().for_each(|point| cloud.remove(point, tolerance));
            } else {
                cloud.clear();
            }
            show_points(sim, own, cloud)
        },
    },
    Function {
        name: "intersectPointsWithPointCloud",
        tip: "int totalPointCnt=sim.intersectPointsWithPointCloud(int pointCloudHandle,int options,float[] pts,float distanceTolerance)",
        run: |sim, a| {
            let (own, mut cloud) = cloud(sim, a)?;
            let (given, tolerance) = (points(sim, a, (own, 2))?, distance(a, 3)?);
            count(sim, given.len(), cloud.len())?;
            cloud.keep(&given, tolerance);
            show_points(sim, own, cloud)
        },
    },
    Function {
        name: "getPointCloudPoints",
        tip: "float[] points=sim.getPointCloudPoints(int pointCloudHandle)",
        run: |sim, a| super::list(cloud(sim, a)?.1.items().flat_map(|(point, _)| point)),
    },
];

/// The octree of the first argument, with a copy of its voxels.
fn octree(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<(Handle, Voxels), ApiError> {
    let own = handle(sim, a, 0)?;
    let path = &sim.registry.entry(own)?.path;
    let wrong = || ApiError(format!("`{path}` is no octree: sim.createOctree makes one"));
    let voxels = sim.registry.octrees.get(&own).cloned().ok_or_else(wrong)?;
    sim.add_operations(PER_ITEM * voxels.len() as u64);
    Ok((own, voxels))
}

/// The point cloud of the first argument, with a copy of its points.
fn cloud(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<(Handle, Points), ApiError> {
    let own = handle(sim, a, 0)?;
    let path = &sim.registry.entry(own)?.path;
    let wrong = || ApiError(format!("`{path}` is no point cloud: sim.createPointCloud makes one"));
    let points = sim.registry.clouds.get(&own).cloned().ok_or_else(wrong)?;
    sim.add_operations(PER_ITEM * points.len() as u64);
    Ok((own, points))
}

/// Points of argument `k` in the frame of an octree or point cloud `[m]`.
fn points(sim: &mut SimApi<'_>, a: Arguments<'_>, (own, k): (Handle, usize)) -> Result<Vec<[f64; 3]>, ApiError> {
    let given = super::shapes::threes(a, k)?;
    if a.int(1)? & IS_LOCAL != 0 {
        return Ok(given);
    }
    let x_cw = sim.pose(own, Reference::World)?.inverse();
    Ok(given.into_iter().map(|point| x_cw.point(Vec3(point)).0).collect())
}

/// A tolerance, argument `k` `[m]`.
fn distance(a: Arguments<'_>, k: usize) -> Result<f64, ApiError> {
    let x = if a.has(k) { a.real(k)? } else { 0.0 };
    if x.is_finite() && x >= 0.0 { Ok(x) } else { Err(ApiError(format!("a tolerance of {x} m: expected 0 or more"))) }
}

/// Part of an object in the frame of an octree or point cloud `[m]`.
enum Item {
    Point([f64; 3]),
    Triangle([[f64; 3]; 3]),
}

/// Passes the parts of an object to `each`, in the frame of the octree or point cloud `own`: the triangles of a body or
/// shape, the centres of voxels, the points of a point cloud, the place of a dummy. `each` adds to the number of
/// comparisons that it has made.
fn voxelize(
    sim: &mut SimApi<'_>,
    own: Handle,
    object: Handle,
    mut each: impl FnMut(&mut u64, Item) -> Result<(), ApiError>,
) -> Result<(), ApiError> {
    let x_co = sim.pose(own, Reference::World)?.inverse().compose(&sim.pose(object, Reference::World)?);
    let place = |p: [f64; 3]| x_co.point(Vec3(p)).0;
    let registry = &sim.registry;
    let points: Option<Vec<[f64; 3]>> = if let Some(voxels) = registry.octrees.get(&object) {
        Some(voxels.items().map(|(center, _)| center).collect())
    } else if let Some(cloud) = registry.clouds.get(&object) {
        Some(cloud.items().map(|(point, _)| point).collect())
    } else if matches!(registry.entry(object)?.kind, Kind::Dummy | Kind::Frame) {
        Some(vec![[0.0; 3]])
    } else {
        None
    };
    let mut n = 0;
    if let Some(points) = points {
        n += points.len() as u64;
        points.into_iter().try_for_each(|point| each(&mut n, Item::Point(place(point))))?;
    } else {
        for part in sim.meshes(object)? {
            let (corners, triangles) = part.mesh;
            for triangle in triangles {
                each(&mut n, Item::Triangle(triangle.map(|k| place(corners[k as usize]))))?;
                check_operations(n, WORK, HELP)?;
            }
        }
    }
    sim.add_operations(n);
    Ok(())
}

/// Voxels of the size of a grid `[m]` that an object meets, in the frame of the point cloud `own`.
fn on_grid(sim: &mut SimApi<'_>, own: Handle, object: Handle, size: f64) -> Result<Voxels, ApiError> {
    let mut grid = Voxels::new(size)?;
    voxelize(sim, own, object, |n, item| match item {
        Item::Point(point) => grid.insert(point, [0; 3], 0).map(|_| ()),
        Item::Triangle(corners) => grid.insert_triangle(corners, [0; 3], 0).map(|more| *n += more),
    })?;
    Ok(grid)
}

/// Colour of argument `k`, from 0 to 255; red if there is none.
fn color(a: Arguments<'_>, k: usize) -> Result<[u8; 3], ApiError> {
    let given = if a.has(k) { a.reals(k)? } else { [255.0, 0.0, 0.0] };
    Ok(given.map(|x| x.clamp(0.0, 255.0).round() as u8))
}

/// Colours of argument 4, from 0 to 255: one for all points, or one for each of `n`.
fn colors(a: Arguments<'_>, n: usize) -> Result<Vec<[u8; 3]>, ApiError> {
    if !a.has(3) {
        return Ok(vec![[255, 0, 0]; n]);
    }
    let given = super::shapes::threes(a, 3)?;
    let byte = |x: f64| x.clamp(0.0, 255.0).round() as u8;
    let all: Vec<[u8; 3]> = given.into_iter().map(|color| color.map(byte)).collect();
    match (a.int(1)? & HAS_COLORS != 0, all.len()) {
        (true, m) if m == n => Ok(all),
        (false, 1..) => Ok(vec![all[0]; n]),
        (is_own, m) => {
            let expected = if is_own { n } else { 1 };
            Err(ApiError(format!(
                "{m} colours, expected {expected} of red, green, blue (option 2: one for each point)"
            )))
        }
    }
}

/// Counts comparisons of points that are given with those that are there, before they are made.
fn count(sim: &mut SimApi<'_>, n_given: usize, n_there: usize) -> Result<(), ApiError> {
    let n = (n_given as u64).saturating_mul(n_there as u64);
    check_operations(n, WORK, HELP)?;
    sim.add_operations(n);
    Ok(())
}

fn insert_voxels(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, mut voxels) = octree(sim, a)?;
    let given = points(sim, a, (own, 2))?;
    count(sim, given.len(), PER_VOXEL)?;
    let colors = colors(a, given.len())?;
    let tags: Vec<i64> = match a.get(4) {
        Value::Nil => Vec::new(),
        tags => tags
            .as_reals()
            .ok_or_else(|| ApiError::new("argument 5 is no list of tags"))?
            .iter()
            .map(|x| *x as i64)
            .collect(),
    };
    for (k, (point, color)) in given.into_iter().zip(colors).enumerate() {
        let tag = tags.get(k).or(tags.first()).copied().unwrap_or(0);
        voxels.insert(point, color, tag)?;
    }
    show_voxels(sim, own, voxels)
}

fn insert_points(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, mut cloud) = cloud(sim, a)?;
    let (given, tolerance) = (points(sim, a, (own, 2))?, distance(a, 4)?);
    let colors = colors(a, given.len())?;
    let mut n = 0;
    let result = given.into_iter().zip(colors).try_for_each(|(point, color)| {
        // with a tolerance a point is compared with all that are there by then
        n += if tolerance > 0.0 { cloud.len() as u64 } else { 1 };
        check_operations(n, WORK, HELP)?;
        cloud.insert(point, color, tolerance).map(|_| ())
    });
    sim.add_operations(n);
    result?;
    show_points(sim, own, cloud)
}

/// Keeps the voxels of an octree and shows them; returns their number.
fn show_voxels(sim: &mut SimApi<'_>, own: Handle, voxels: Voxels) -> Outcome {
    let cube = Surface::Solid(Shape::Cuboid { size: [voxels.size(); 3] });
    sim.show_items(own, cube, voxels.items())?;
    let n = voxels.len();
    sim.registry.octrees.insert(own, voxels);
    one(n as i64)
}

/// Keeps the points of a point cloud and shows them; returns their number.
fn show_points(sim: &mut SimApi<'_>, own: Handle, cloud: Points) -> Outcome {
    sim.show_items(own, Surface::Solid(Shape::Sphere { radius: POINT_RADIUS }), cloud.items())?;
    let n = cloud.len();
    sim.registry.clouds.insert(own, cloud);
    one(n as i64)
}

impl SimApi<'_> {
    /// Shows one surface at some places of an object `[m]`, in place of what it showed before, which stays if that is
    /// refused.
    fn show_items(
        &mut self,
        own: Handle,
        surface: Surface,
        items: impl Iterator<Item = ([f64; 3], [u8; 3])>,
    ) -> Result<(), ApiError> {
        let items: Vec<_> = items.collect();
        self.add_operations(PER_ITEM * items.len() as u64);
        self.finish_pictures();
        let frame = self.registry.entry(own)?.frame;
        self.registry.senses.replace_parts(own, &frame, surface, &items)
    }
}

//! Shapes that clients and scripts make: seen by sensors, measured by distances, moved where they are put; they weigh
//! nothing and touch nothing.

use std::path::{Component, Path};
use std::sync::Arc;

use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::model::Shape;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::registry::{Handle, Kind, WORLD};
use super::senses::handle_of;
use super::{ApiError, Reference, SimApi};
use sincro_scene::scene::Triangles;
use sincro_values::MAX_LENGTH;

/// Triangles of one mesh.
const MAX_TRIANGLES: usize = 200_000;

/// Properties of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShapeInfo {
    /// True if it has several parts.
    pub is_compound: bool,
    /// `sim.primitiveshape_…`; 0 for meshes and hulls.
    pub primitive: i64,
    /// Lengths along x, y, z `[m]`.
    pub size: [f64; 3],
}

impl SimApi<'_> {
    /// Makes a shape in the world's origin of parts, each with its pose in the shape `[m]`.
    ///
    /// # Errors
    ///
    /// There are too many objects or corners, or a part has no extent.
    pub(crate) fn create_shape(&mut self, name: &str, parts: Vec<(Surface, Pose<f64>)>) -> Result<Handle, ApiError> {
        let ready = parts.into_iter().map(|(surface, place)| Ok((self.registry.senses.prepare(surface)?, place)));
        let ready = ready.collect::<Result<Vec<_>, ApiError>>()?;
        let handle = self.registry.create(name, Kind::Shape, WORLD)?;
        self.finish_pictures();
        for (geometry, place) in ready {
            self.registry.senses.add(handle, &WORLD, geometry, place);
        }
        Ok(handle)
    }

    /// Makes a mesh of corners in the world and triangles: its frame is in the middle of the box that holds them.
    ///
    /// # Errors
    ///
    /// A triangle names no corner, a number is not finite, or there are too many.
    pub(crate) fn create_mesh(&mut self, corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Handle, ApiError> {
        let (low, high) = bounds(corners)?;
        if triangles.is_empty() || triangles.len() > MAX_TRIANGLES {
            let n = triangles.len();
            return Err(ApiError(format!("a mesh of {n} triangles: expected one to {MAX_TRIANGLES}")));
        }
        if let Some(k) = triangles.iter().flatten().find(|k| **k as usize >= corners.len()) {
            return Err(ApiError(format!("there is no corner {k}: there are {}, counted from 0", corners.len())));
        }
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        let around = corners.iter().map(|p| std::array::from_fn(|k| p[k] - middle[k])).collect();
        let surface = Surface::Mesh(around, triangles.to_vec());
        let handle = self.create_shape("Shape", vec![(surface, Pose::identity())])?;
        self.set_pose(handle, &Pose::translation(Vec3(middle)), Reference::World)?;
        Ok(handle)
    }

    /// Makes ground of heights `[m]`, rows along x, the first one at the least y; `size` along x `[m]`, squares.
    ///
    /// # Errors
    ///
    /// The heights do not fill the rows, or are not finite.
    pub(crate) fn create_height_field(
        &mut self,
        columns: usize,
        rows: usize,
        size: f64,
        heights: Vec<f64>,
    ) -> Result<Handle, ApiError> {
        if columns < 2 || rows < 2 || columns.checked_mul(rows) != Some(heights.len()) {
            let n = heights.len();
            return Err(ApiError(format!(
                "{n} heights for {columns} by {rows} points: expected two rows of two at least, all filled"
            )));
        }
        length(size)?;
        if let Some(bad) = heights.iter().find(|h| !is_near(**h)) {
            return Err(ApiError(format!("a height of {bad}")));
        }
        let size = [size, size * (rows - 1) as f64 / (columns - 1) as f64];
        self.create_shape("Heightfield", vec![(Surface::HeightField { columns, heights, size }, Pose::identity())])
    }

    /// The corners and triangles of a mesh file in the scene's folder, STL or OBJ, scaled.
    ///
    /// # Errors
    ///
    /// It lies elsewhere, cannot be read, or is no mesh.
    pub(super) fn read_mesh(&self, name: &str, scale: f64) -> Result<Triangles, ApiError> {
        length(scale)?;
        let path = Path::new(name);
        if name.is_empty() || !path.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir)) {
            return Err(ApiError(format!("`{name}` is no file of the scene's folder: give a path inside it")));
        }
        let folder = Path::new(&self.registry.scene_path).parent().unwrap_or(Path::new("."));
        let whole = folder.join(path).canonicalize();
        let whole = whole.map_err(|e| ApiError(format!("`{name}` cannot be read: {e}")))?;
        if !folder.canonicalize().is_ok_and(|folder| whole.starts_with(folder)) {
            return Err(ApiError(format!("`{name}` lies outside the scene's folder")));
        }
        let mut mesh = sincro_scene::scene::mesh_of_file(&whole).map_err(|why| ApiError(format!("`{name}`: {why}")))?;
        for x in mesh.corners.iter_mut().flatten() {
            *x *= scale;
        }
        Ok(mesh)
    }

    /// Refuses octrees and point clouds, where a shape is expected.
    pub(super) fn check_shape(&self, handle: Handle) -> Result<(), ApiError> {
        let (what, help) = if self.registry.octrees.contains_key(&handle) {
            ("an octree", "its voxels are changed with sim.insertVoxelsIntoOctree and sim.removeVoxelsFromOctree")
        } else if self.registry.clouds.contains_key(&handle) {
            ("a point cloud", "its points are changed with sim.insertPointsIntoPointCloud and the functions like it")
        } else {
            return Ok(());
        };
        Err(ApiError(format!("`{}` is {what}, no shape: {help}", self.registry.entry(handle)?.path)))
    }

    /// The shape of a handle, a runtime object.
    fn runtime_shape(&self, handle: Handle) -> Result<Handle, ApiError> {
        let entry = self.registry.entry(handle)?;
        if entry.kind == Kind::Shape {
            self.check_shape(entry.handle)?;
            return Ok(entry.handle);
        }
        let path = &entry.path;
        Err(ApiError(match entry.kind {
            Kind::Body(_) if self.registry.added.contains(&handle) => {
                format!("`{path}` was made dynamic or respondable, it is a body now: scale it and take it apart before")
            }
            Kind::Body(_) => format!("`{path}` is a body of the scene: its shapes are changed there"),
            _ => format!("`{path}` is no shape"),
        }))
    }

    /// Returns true if shapes that wait to become bodies are the same body if they are grouped before: solids of closed
    /// form, all fixed or none, of no mass but that of water, on which nothing hangs and which hang on nothing. The
    /// role of the first is that of all.
    fn are_one_before_bodies(&mut self, first: Handle, others: &[Handle]) -> bool {
        let Some(role) = self.role(first).copied() else { return false };
        let is_alike = |sim: &mut Self, shape: Handle| {
            let of_shape = sim.role(shape).copied();
            let is_alone = sim.registry.tree(shape).len() == 1
                && sim.registry.entry(shape).is_ok_and(|entry| entry.parent.is_none());
            let has_mass = sim.registry.masses.contains_key(&shape);
            let is_solid = sim
                .registry
                .senses
                .parts_of(shape)
                .iter()
                .all(|(p, _)| matches!(p.geometry.surface(), Surface::Solid(_)));
            is_solid
                && is_alone
                && !has_mass
                && of_shape.is_some_and(|own| own.is_static == role.is_static && own.mass.is_none())
        };
        std::iter::once(first).chain(others.iter().copied()).all(|shape| is_alike(self, shape))
    }

    /// One shape of several: the first one keeps its frame and name, the others are removed. Bodies that were made at
    /// run time become one body.
    ///
    /// # Errors
    ///
    /// There are fewer than two, one belongs to the scene, or bodies move against each other.
    pub(crate) fn group_shapes(&mut self, shapes: &[Handle]) -> Result<Handle, ApiError> {
        let [first, others @ ..] = shapes else { return Err(ApiError::new("give two shapes at least")) };
        if others.is_empty() || (1..shapes.len()).any(|k| shapes[..k].contains(&shapes[k])) {
            return Err(ApiError::new("give two shapes at least, each once"));
        }
        if !self.are_one_before_bodies(*first, others) {
            self.make_bodies()?;
        }
        let is_body = |sim: &Self, shape: &Handle| {
            sim.registry.entry(*shape).is_ok_and(|entry| matches!(entry.kind, Kind::Body(_)))
        };
        if shapes.iter().any(|shape| is_body(self, shape)) {
            return self.group_bodies(*first, others);
        }
        for shape in shapes {
            self.runtime_shape(*shape)?;
        }
        self.finish_pictures();
        if shapes.iter().any(|shape| self.registry.masses.contains_key(shape)) {
            let masses: Vec<f64> = shapes.iter().map(|shape| self.shape_mass(*shape)).collect::<Result<_, _>>()?;
            self.registry.masses.insert(*first, masses.iter().sum());
        }
        let frame = self.registry.entry(*first)?.frame;
        let x_wf = self.pose(*first, Reference::World)?;
        for other in others {
            let x_fo = x_wf.inverse().compose(&self.pose(*other, Reference::World)?);
            for (piece, place) in self.registry.senses.parts_of(*other) {
                self.registry.senses.add(*first, &frame, piece.geometry, x_fo.compose(&place));
                let color = piece.color;
                self.registry.senses.paint_last(color);
            }
            self.registry.remove(*other)?;
        }
        Ok(*first)
    }

    /// Takes a shape of several parts apart: one shape for each, the first keeps the frame's handle.
    ///
    /// # Errors
    ///
    /// It belongs to the scene or is no shape, or there would be too many objects: nothing is changed then.
    pub(crate) fn ungroup_shape(&mut self, shape: Handle) -> Result<Vec<Handle>, ApiError> {
        self.runtime_shape(shape)?;
        let parts = self.registry.senses.parts_of(shape);
        self.registry.check_room(parts.len())?;
        self.finish_pictures();
        let (x_ws, parent) = (self.pose(shape, Reference::World)?, self.registry.entry(shape)?.parent);
        let mut all = Vec::new();
        for (piece, place) in &parts {
            let made = self.registry.create("Shape", Kind::Shape, WORLD)?;
            self.registry.senses.add(made, &WORLD, piece.geometry.clone(), Pose::identity());
            self.registry.senses.paint_last(piece.color);
            self.set_pose(made, &x_ws.compose(place), Reference::World)?;
            self.set_parent(made, parent, true)?;
            all.push(made);
        }
        self.registry.remove(shape)?;
        Ok(all)
    }

    /// Scales a shape along its axes, about its own origin, by dimensionless factors; a mass that it was given, by
    /// their product, as that of a body of the same density. Planes of the scene through the origin of their body that
    /// are the same afterwards are left as they are.
    ///
    /// # Errors
    ///
    /// It belongs to the scene, a factor is not positive, or a part has no form that can be scaled so.
    pub(crate) fn scale_shape(&mut self, shape: Handle, factors: [f64; 3]) -> Result<(), ApiError> {
        for factor in factors {
            length(factor)?;
        }
        if self.is_plane_at_any_scale(shape, factors)? {
            return Ok(());
        }
        self.runtime_shape(shape)?;
        let (parts, frame) = (self.registry.senses.parts_of(shape), self.registry.entry(shape)?.frame);
        let scaled = parts.iter().map(|(piece, place)| {
            let surface = stretched_at(piece.geometry.surface(), place, factors).ok_or_else(|| {
                let form = "capsules, and parts that stand askew and are no meshes";
                ApiError(format!("{form}, are scaled the same way in all directions: make a new one"))
            })?;
            let geometry = Geometry::new(surface).ok_or_else(|| ApiError::new("it would have no extent"))?;
            let pos = Vec3(std::array::from_fn(|k| factors[k] * place.pos.0[k]));
            Ok((Arc::new(geometry), Pose { pos, ..*place }, piece.color))
        });
        let scaled = scaled.collect::<Result<Vec<_>, ApiError>>()?;
        self.finish_pictures();
        if let Some(mass) = self.registry.masses.get_mut(&shape) {
            *mass *= factors[0] * factors[1] * factors[2];
        }
        self.registry.senses.forget_parts(shape);
        for (geometry, place, color) in scaled {
            self.registry.senses.add(shape, &frame, geometry, place);
            self.registry.senses.paint_last(color);
        }
        Ok(())
    }

    /// Returns true if an object is a body of the scene with planes alone, each through its origin and the same when it
    /// is scaled.
    fn is_plane_at_any_scale(&self, shape: Handle, factors: [f64; 3]) -> Result<bool, ApiError> {
        let own = self.registry.entry(shape)?;
        let x_ow = own.frame.pose.inverse();
        let mut planes = self.registry.senses.pieces().filter(|piece| handle_of(piece) == own.handle).peekable();
        let is_body = matches!(own.kind, Kind::Body(_)) && planes.peek().is_some();
        Ok(is_body
            && planes.all(|piece| {
                let x_op = x_ow.compose(&piece.at.pose);
                let normal: [f64; 3] = std::array::from_fn(|k| x_op.rot.0[k][2]);
                let height: f64 = (0..3).map(|k| normal[k] * x_op.pos.0[k]).sum();
                let mut along = (0..3).filter(|k| normal[*k].abs() > 1e-12).map(|k| factors[k].to_bits());
                let first = along.next();
                matches!(piece.geometry.surface(), Surface::HalfSpace)
                    && height.abs() <= 1e-12
                    && along.all(|factor| Some(factor) == first)
            }))
    }

    /// Colour of the first part of an object's shape: red, green, blue from 0 to 1.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or has no shape.
    pub fn color(&mut self, handle: Handle) -> Result<[f64; 3], ApiError> {
        let entry = self.registry.entry(handle)?;
        let (own, path) = (entry.handle, entry.path.clone());
        let piece = self.registry.senses.pieces().find(|piece| handle_of(piece) == own);
        let rgb = piece.map(|piece| piece.color.map(|x| f64::from(x) / 255.0));
        rgb.ok_or_else(|| ApiError(format!("`{path}` has no shape: there is no colour to tell")))
    }

    /// Sets the colour that vision sensors see of an object: red, green, blue (dimensionless); values outside 0 to 1
    /// are clamped.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or a number is not finite.
    pub fn paint(&mut self, handle: Handle, color: [f64; 3]) -> Result<(), ApiError> {
        let own = self.registry.entry(handle)?.handle;
        if color.iter().any(|x| x.is_nan()) {
            return Err(ApiError::new("a colour has numbers that are none"));
        }
        self.finish_pictures();
        self.registry.senses.paint(own, color.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8));
        Ok(())
    }

    /// Bounding box of a shape or body in its own axes: lowest and highest corner `[m]`.
    ///
    /// # Errors
    ///
    /// There is no such object, it has no shape, or one without end (a plane).
    pub(crate) fn shape_box(&self, handle: Handle) -> Result<[[f64; 3]; 2], ApiError> {
        let own = self.registry.entry(handle)?;
        let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let x_wo = own.frame.pose;
        for piece in self.registry.senses.pieces().filter(|p| handle_of(p) == own.handle) {
            let x_op = x_wo.inverse().compose(&piece.at.pose);
            for k in 0..3 {
                let direction = Vec3(std::array::from_fn(|i| x_op.rot.0[k][i]));
                let reach = |d: Vec3<f64>| piece.geometry.surface().reach_along(d.0);
                let (Some(up), Some(down)) = (reach(direction), reach(direction.scale(-1.0))) else {
                    return Err(ApiError(format!("`{}` has no end: a plane has no box", own.path)));
                };
                corners[0][k] = corners[0][k].min(x_op.pos.0[k] - down);
                corners[1][k] = corners[1][k].max(x_op.pos.0[k] + up);
            }
        }
        if corners[0][0] > corners[1][0] {
            return Err(ApiError(format!("`{}` has no shape", own.path)));
        }
        Ok(corners)
    }

    /// Geometry of a shape or body.
    ///
    /// # Errors
    ///
    /// There is no such object, or it has no shape.
    pub(crate) fn shape_info(&self, handle: Handle) -> Result<ShapeInfo, ApiError> {
        let own = self.registry.entry(handle)?;
        let pieces: Vec<&Surface> = self
            .registry
            .senses
            .pieces()
            .filter(|p| handle_of(p) == own.handle)
            .map(|p| p.geometry.surface())
            .collect();
        let Some(first) = pieces.first() else { return Err(ApiError(format!("`{}` has no shape", own.path))) };
        let (primitive, size) = if pieces.len() > 1 { (0, [0.0; 3]) } else { primitive(first) };
        Ok(ShapeInfo { is_compound: pieces.len() > 1, primitive, size })
    }
}

/// A primitive shape by its number, with full lengths along x, y and z `[m]`, its frame in the middle of its box.
///
/// # Errors
///
/// There is none of that number, or it cannot have these lengths. Balls, cylinders and cones that are not round are
/// convex hulls.
pub(crate) fn primitive_of(kind: i64, size: [f64; 3]) -> Result<(&'static str, Surface, Pose<f64>), ApiError> {
    let [x, y, z] = size;
    let used = match kind {
        1 | 2 => 2,
        _ => 3,
    };
    for x in &size[..used] {
        length(*x)?;
    }
    let round = |what: &str, n: usize| {
        if size[1..n].iter().all(|other| (other - x).abs() <= 1e-9 * x) {
            return Ok(());
        }
        Err(ApiError(format!("a {what} with the lengths {size:?} is not round: make a mesh with createMeshShape")))
    };
    let plain = Pose::identity();
    let solid = Surface::Solid;
    Ok(match kind {
        1 => ("Plane", solid(Shape::Cuboid { size: [x, y, 0.0] }), plain),
        2 => {
            round("disc", 2)?;
            ("Disc", solid(Shape::Cylinder { radius: 0.5 * x, length: 0.0 }), plain)
        }
        3 => ("Cuboid", solid(Shape::Cuboid { size }), plain),
        4 if round("ball", 3).is_err() => ("Sphere", Surface::ellipsoid(size), plain),
        4 => {
            round("ball", 3)?;
            ("Sphere", solid(Shape::Sphere { radius: 0.5 * x }), plain)
        }
        5 if round("cylinder", 2).is_err() => ("Cylinder", Surface::elliptic_cylinder(size), plain),
        6 if round("cone", 2).is_err() => ("Cone", Surface::elliptic_cone(size), plain),
        5 => {
            round("cylinder", 2)?;
            ("Cylinder", solid(Shape::Cylinder { radius: 0.5 * x, length: z }), plain)
        }
        6 => {
            round("cone", 2)?;
            let middle = Pose::translation(Vec3([0.0, 0.0, -0.25 * z]));
            ("Cone", solid(Shape::Cone { radius: 0.5 * x, length: z }), middle)
        }
        8 => {
            round("capsule", 2)?;
            if z < x {
                return Err(ApiError(format!("a capsule with the lengths {size:?} is shorter than it is wide")));
            }
            ("Capsule", solid(Shape::Capsule { radius: 0.5 * x, length: z - x }), plain)
        }
        _ => {
            let known = "plane 1, disc 2, cuboid 3, spheroid 4, cylinder 5, cone 6, capsule 8";
            return Err(ApiError(format!("{kind} is no primitive shape: {known}")));
        }
    })
}

/// Number and lengths of a surface that is a primitive shape.
fn primitive(surface: &Surface) -> (i64, [f64; 3]) {
    match surface {
        Surface::Solid(Shape::Cuboid { size }) => (if size[2] == 0.0 { 1 } else { 3 }, *size),
        Surface::Solid(Shape::Sphere { radius }) => (4, [2.0 * radius; 3]),
        Surface::Solid(Shape::Cylinder { radius, length }) => {
            (if *length == 0.0 { 2 } else { 5 }, [2.0 * radius, 2.0 * radius, *length])
        }
        Surface::Solid(Shape::Cone { radius, length }) => (6, [2.0 * radius, 2.0 * radius, *length]),
        Surface::Solid(Shape::Capsule { radius, length }) => (8, [2.0 * radius, 2.0 * radius, length + 2.0 * radius]),
        Surface::HeightField { size, .. } => (7, [size[0], size[1], 0.0]),
        Surface::HalfSpace => (1, [0.0; 3]),
        // the API has no tori
        Surface::Hull(_) | Surface::Mesh(..) | Surface::Solid(Shape::Torus { .. }) => (0, [0.0; 3]),
    }
}

/// A part with its pose in its shape, scaled by factors along the axes of the shape: in its own axes. None where it has
/// no such form.
fn stretched_at(surface: &Surface, place: &Pose<f64>, k: [f64; 3]) -> Option<Surface> {
    if k[0].to_bits() == k[1].to_bits() && k[0].to_bits() == k[2].to_bits() {
        return Some(surface.scaled(k[0]));
    }
    let r = &place.rot.0;
    let m: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|a| r[a][i] * k[a] * r[a][j]).sum()));
    let is_straight = (0..3).all(|i| (0..3).all(|j| i == j || m[i][j].abs() <= 1e-12 * k[0].max(k[1]).max(k[2])));
    if is_straight {
        return stretched(surface, [m[0][0], m[1][1], m[2][2]]);
    }
    let points = |list: &[[f64; 3]]| {
        list.iter().map(|p| std::array::from_fn(|i| (0..3).map(|j| m[i][j] * p[j]).sum())).collect()
    };
    match surface {
        Surface::Hull(list) => Some(Surface::Hull(points(list))),
        Surface::Mesh(list, triangles) => Some(Surface::Mesh(points(list), triangles.clone())),
        _ => None,
    }
}

/// A surface with its lengths along x, y and z times `k` (dimensionless), about the origin of its frame; none where
/// there is no surface of that form. Balls, cylinders and cones that are not round any more are convex hulls.
fn stretched(surface: &Surface, k: [f64; 3]) -> Option<Surface> {
    let [x, y, z] = k;
    let is_round = (x - y).abs() <= 1e-12 * x;
    let points = |list: &[[f64; 3]]| list.iter().map(|p| std::array::from_fn(|i| k[i] * p[i])).collect();
    let lengths = |radius: f64, length: f64| [2.0 * x * radius, 2.0 * y * radius, z * length];
    let solid = Surface::Solid;
    Some(match surface {
        Surface::Solid(Shape::Cuboid { size }) => {
            solid(Shape::Cuboid { size: std::array::from_fn(|i| k[i] * size[i]) })
        }
        Surface::Solid(Shape::Sphere { radius }) => Surface::ellipsoid(k.map(|k| 2.0 * k * radius)),
        Surface::Solid(Shape::Cylinder { radius, length }) if is_round => {
            solid(Shape::Cylinder { radius: x * radius, length: z * length })
        }
        Surface::Solid(Shape::Cylinder { radius, length }) => Surface::elliptic_cylinder(lengths(*radius, *length)),
        Surface::Solid(Shape::Cone { radius, length }) if is_round => {
            solid(Shape::Cone { radius: x * radius, length: z * length })
        }
        Surface::Solid(Shape::Cone { radius, length }) => {
            // its frame is in the centre of mass, a quarter above the base
            let Surface::Hull(list) = Surface::elliptic_cone(lengths(*radius, *length)) else { return None };
            Surface::Hull(list.into_iter().map(|[px, py, pz]| [px, py, pz + 0.25 * z * length]).collect())
        }
        Surface::Hull(list) => Surface::Hull(points(list)),
        Surface::Mesh(list, triangles) => Surface::Mesh(points(list), triangles.clone()),
        Surface::HeightField { columns, heights, size } => Surface::HeightField {
            columns: *columns,
            heights: heights.iter().map(|h| z * h).collect(),
            size: [x * size[0], y * size[1]],
        },
        Surface::Solid(Shape::Capsule { .. } | Shape::Torus { .. }) | Surface::HalfSpace => return None,
    })
}

fn length(x: f64) -> Result<(), ApiError> {
    if x > 0.0 && x <= MAX_LENGTH {
        return Ok(());
    }
    Err(ApiError(format!("{x} is no length or factor here: expected more than 0, at most {MAX_LENGTH}")))
}

/// Neither far away nor no number.
fn is_near(x: f64) -> bool {
    x.abs() <= MAX_LENGTH
}

/// The box that holds some corners.
fn bounds(corners: &[[f64; 3]]) -> Result<([f64; 3], [f64; 3]), ApiError> {
    if corners.is_empty() || corners.iter().flatten().any(|x| !is_near(*x)) {
        return Err(ApiError::new("corners are missing, not finite, or too far away"));
    }
    let bound = |f: fn(f64, f64) -> f64| {
        corners[1..].iter().fold(corners[0], |all, p| std::array::from_fn(|k| f(all[k], p[k])))
    };
    Ok((bound(f64::min), bound(f64::max)))
}

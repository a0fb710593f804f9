//! Meshes that are computed or written: convex hulls, frames of shapes turned and moved against their surfaces, files.

use sincro_dynamics::geometry::polyhedron::convex_hull;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_scene::scene::Triangles as MeshFile;
use sincro_values::mesh_files::{Format, Mesh};
use sincro_values::work::check_operations;

use super::registry::{Handle, Kind};
use super::{ApiError, Reference, SimApi};

/// Points of which a hull is computed at most, and operations that each counts as.
const MAX_HULL: (usize, u64) = (1_000_000, 256);

impl SimApi<'_> {
    /// Corners and triangles of the convex hull of some points `[m]`; none if they lie in a plane, or are fewer than
    /// four.
    ///
    /// # Errors
    ///
    /// The points are too many, or not finite.
    pub(crate) fn hull(&mut self, points: &[[f64; 3]]) -> Result<Option<MeshFile>, ApiError> {
        let (max, per_point) = MAX_HULL;
        if points.len() > max || points.iter().flatten().any(|x| !x.is_finite()) {
            return Err(ApiError(format!("a hull is computed of {max} points at most, all finite")));
        }
        let n = per_point * points.len() as u64;
        check_operations(n, "operations on points", "give fewer points")?;
        self.add_operations(n);
        Ok(convex_hull(points).map(|(corners, triangles)| MeshFile { corners, triangles }))
    }

    /// Turns the frame of a runtime shape and puts it in the middle of the box about the shape in its axes; the surface
    /// stays where it is. Children stay where they are, too.
    ///
    /// # Errors
    ///
    /// It is a body, whose frame is that of its mass and joints, no shape, or has no end.
    pub(crate) fn reorient(&mut self, handle: Handle, reference: Reference) -> Result<(), ApiError> {
        let x_wr = match reference {
            Reference::World => Pose::identity(),
            Reference::Parent => match self.registry.entry(handle)?.parent {
                Some(parent) => self.pose(parent, Reference::World)?,
                None => Pose::identity(),
            },
            Reference::Object(other) | Reference::JointBase(other) => self.pose(other, Reference::World)?,
        };
        let x_wo = self.pose(handle, Reference::World)?;
        // turned about its origin first, then moved into the middle of what has become its box
        self.reframe(handle, &Pose { pos: x_wo.pos, rot: x_wr.rot })?;
        let [low, high] = self.shape_box(handle)?;
        let middle = Vec3([0, 1, 2].map(|k| 0.5 * (low[k] + high[k])));
        let x_wo = self.pose(handle, Reference::World)?;
        self.reframe(handle, &Pose { pos: x_wo.point(middle), rot: x_wo.rot })
    }

    /// Gives the frame of a runtime shape another pose in the world; its surface and its children stay where they are.
    ///
    /// # Errors
    ///
    /// It is no runtime shape.
    pub(crate) fn reframe(&mut self, handle: Handle, x_wn: &Pose<f64>) -> Result<(), ApiError> {
        self.check_shape(handle)?;
        let entry = self.registry.entry(handle)?;
        if entry.kind != Kind::Shape {
            let path = &entry.path;
            return Err(ApiError(format!(
                "the frame of `{path}` stays: it is that of a body, in which its mass and joints are; shapes that are made at run time and are no bodies can have another one"
            )));
        }
        let own = entry.handle;
        let x_wo = self.pose(own, Reference::World)?;
        let x_no = x_wn.inverse().compose(&x_wo);
        self.finish_pictures();
        let children: Vec<Handle> =
            self.registry.entries().filter(|e| e.parent == Some(own)).map(|e| e.handle).collect();
        let places =
            children.iter().map(|child| self.pose(*child, Reference::World)).collect::<Result<Vec<_>, ApiError>>()?;
        let (parts, frame) = (self.registry.senses.parts_of(own), self.registry.entry(own)?.frame);
        self.registry.senses.forget_parts(own);
        for (piece, place) in parts {
            self.registry.senses.add(own, &frame, piece.geometry, x_no.compose(&place));
            self.registry.senses.paint_last(piece.color);
        }
        self.set_pose(own, x_wn, Reference::World)?;
        for (child, place) in children.iter().zip(&places) {
            self.set_pose(*child, place, Reference::World)?;
        }
        Ok(())
    }

    /// Keeps a mesh file with the run that a script makes it in, or, of a client, has it written into the folder for
    /// files of clients. Corners are multiplied by `scale`. The name gets the extension of the format.
    ///
    /// # Errors
    ///
    /// The name is none of a file in a folder, a triangle names no corner, or files cannot be kept now.
    pub(crate) fn export_meshes(
        &mut self,
        format: Format,
        name: &str,
        scale: f64,
        meshes: &[MeshFile],
    ) -> Result<(), ApiError> {
        let mut scaled = Vec::with_capacity(meshes.len());
        for MeshFile { corners, triangles } in meshes {
            if let Some(k) = triangles.iter().flatten().find(|k| **k as usize >= corners.len()) {
                return Err(ApiError(format!("there is no corner {k}: there are {}, counted from 0", corners.len())));
            }
            scaled.push(corners.iter().map(|p| p.map(|x| x * scale)).collect::<Vec<_>>());
        }
        let all: Vec<Mesh<'_>> =
            scaled.iter().zip(meshes).map(|(corners, mesh)| Mesh { corners, triangles: &mesh.triangles }).collect();
        let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
        let extension = format.extension();
        let has_it = last.rsplit_once('.').is_some_and(|(_, own)| own.eq_ignore_ascii_case(extension));
        let name = if has_it { last.to_owned() } else { format!("{last}.{extension}") };
        super::functions::check_file_name(&name)?;
        self.keep_file(name, format.write(&all))
    }

    /// Keeps a file of a script with its run, or asks for that of a client to be written into the folder for files of
    /// clients.
    ///
    /// # Errors
    ///
    /// Clients may write no files, or there are many already.
    pub(crate) fn keep_file(&mut self, name: String, bytes: Vec<u8>) -> Result<(), ApiError> {
        if self.own.is_some() && self.is_running() {
            return self.registry.keep_image(&name, bytes);
        }
        if self.registry.sent_folder.is_none() {
            return Err(ApiError(format!(
                "`{name}` is not written: in a run scripts save files, clients with `sincro serve --grant files`"
            )));
        }
        self.registry.ask_to_save_image(name, bytes)
    }
}

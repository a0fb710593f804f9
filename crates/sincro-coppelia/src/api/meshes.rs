//! Triangle meshes of bodies and shapes, as `sim.getShapeMesh` gives them.

use sincro_dynamics::geometry::polyhedron::Triangles;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::senses::handle_of;
use super::{ApiError, Handle, SimApi};

/// Part of a body or shape: its mesh in the axes of the object, and its colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshPart {
    /// Corners `[m]` and triangles.
    pub mesh: Triangles,
    /// Red, green, blue (dimensionless, 0 to 1).
    pub color: [f64; 3],
}

impl SimApi<'_> {
    /// Triangle meshes of the parts of a body or shape, in the axes of its frame.
    ///
    /// # Errors
    ///
    /// There is no such object, it has no shape, or one without end (a plane).
    pub(crate) fn meshes(&self, handle: Handle) -> Result<Vec<MeshPart>, ApiError> {
        let own = self.registry.entry(handle)?;
        let x_ow = own.frame.pose.inverse();
        let mut parts = Vec::new();
        for piece in self.registry.senses.pieces().filter(|piece| handle_of(piece) == own.handle) {
            let Some((corners, triangles)) = piece.geometry.surface().triangles() else {
                return Err(ApiError(format!("`{}` has no end: a plane has no mesh", own.path)));
            };
            let x_op: Pose<f64> = x_ow.compose(&piece.at.pose);
            let corners = corners.into_iter().map(|p| x_op.point(Vec3(p)).0).collect();
            let color = piece.color.map(|c| f64::from(c) / 255.0);
            parts.push(MeshPart { mesh: (corners, triangles), color });
        }
        if parts.is_empty() {
            return Err(ApiError(format!("`{}` has no shape", own.path)));
        }
        Ok(parts)
    }
}

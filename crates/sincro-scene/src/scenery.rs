//! Visible geometry of a scene: every solid and surface of its bodies, its frame and its colour. Proximity and vision
//! sensors (distances, images) and clients ask it; no step does.

use std::sync::Arc;

use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::scratch::Scratch;

use crate::camera::VisiblePiece;

/// Piece of the visible geometry of a scene: one solid or surface with its frame and colour, for images, distances and
/// the viewer.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Number of its object ([`Object::id`](crate::scene::Object)).
    pub object: usize,
    /// Link (or the world) that carries the piece, and its pose there `[m]`.
    pub at: Attached<f64>,
    /// Geometry in the piece's own frame `[m]`.
    pub geometry: Arc<Geometry>,
    /// Colour: red, green, blue, 0 to 255.
    pub color: [u8; 3],
}

/// Visible geometry of a scene; see [`Scene::scenery`](crate::scene::Scene::scenery).
#[derive(Clone, Debug, Default)]
pub struct Scenery {
    /// Pieces, in the order of the objects that they belong to.
    pub pieces: Vec<Piece>,
}

/// Returns the pieces as a [`Renderer`](crate::camera::Renderer) takes them, in the order of `pieces`. `scratch` must
/// hold the poses of the links ([`kinematics::poses`]).
pub fn visible<'a>(
    pieces: impl Iterator<Item = &'a Piece>,
    scratch: &Scratch<f64>,
) -> impl Iterator<Item = VisiblePiece<'a>> {
    pieces.map(|piece| VisiblePiece {
        geometry: &piece.geometry,
        color: piece.color,
        pose: kinematics::frame_pose(scratch, &piece.at),
    })
}

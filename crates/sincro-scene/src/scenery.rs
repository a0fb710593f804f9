//! Visible geometry of a scene: every solid and surface of its bodies, its frame and its colour. Proximity and vision
//! sensors (distances, images) and clients ask it; no step does.

use std::sync::Arc;

use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::Pose;

/// A solid or surface where it hangs.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Index of its body among the objects of the scene.
    pub object: usize,
    /// Link or world frame to which its frame is fixed.
    pub at: Attached<f64>,
    /// Its kind.
    pub geometry: Arc<Geometry>,
    /// Red, green, blue.
    pub color: [u8; 3],
}

/// All pieces of a scene.
#[derive(Clone, Debug, Default)]
pub struct Scenery {
    /// In the order of the objects.
    pub pieces: Vec<Piece>,
}

/// Pieces with their poses in the world `[m]`, after `scratch` has the poses of the links.
pub fn placed<'a>(
    pieces: impl Iterator<Item = &'a Piece>,
    scratch: &Scratch<f64>,
) -> impl Iterator<Item = (&'a Piece, Pose<f64>)> {
    pieces.map(|piece| (piece, kinematics::frame_pose(scratch, &piece.at)))
}

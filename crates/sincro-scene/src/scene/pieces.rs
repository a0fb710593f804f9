//! The pieces of a scene that can be seen, from its objects.

use std::sync::Arc;

use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::Names;
use sincro_dynamics::spatial::Pose;

use super::{Object, ObjectKind, Scene, ShownSurface};
use crate::scenery::{Piece, Scenery};

/// Red, green and blue of bodies that have no colour of their own, by turns, as the page has them.
const PLAIN: [[u8; 3]; 6] = [
    [0x5b, 0x7f, 0x9e],
    [0xc9, 0x8a, 0x3c],
    [0x5f, 0x9e, 0x83],
    [0xa8, 0x74, 0x8f],
    [0x8a, 0x8f, 0x98],
    [0xb5, 0xa6, 0x42],
];
/// Default colour of planes.
const FLOOR: [u8; 3] = [0xf1, 0xf3, 0xf5];

/// Scenery of a scene, which keeps it: [`Scene::scenery`].
pub(super) fn scenery_of(scene: &Scene) -> Scenery {
    let names = scene.model.names();
    let mut n_bodies = 0;
    let mut pieces = Vec::new();
    for (k, object) in scene.objects.iter().enumerate() {
        pieces.extend(pieces_of(&scene.objects, names, k, PLAIN[n_bodies % PLAIN.len()]));
        n_bodies += usize::from(matches!(object.kind, ObjectKind::Body { .. }));
    }
    Scenery { pieces }
}

/// The pieces of object `k`; `plain` is the colour of what has none.
fn pieces_of(objects: &[Object], names: &Names, k: usize, plain: [u8; 3]) -> Vec<Piece> {
    let frame = attached(objects, names, k);
    let piece = |ShownSurface { surface, pose, color }| {
        let plain = if surface == Surface::HalfSpace { FLOOR } else { plain };
        let geometry = Arc::new(Geometry::new(surface)?);
        let at = Attached { pose: frame.pose.compose(&pose), ..frame };
        Some(Piece { object: objects[k].id, at, geometry, color: color.unwrap_or(plain) })
    };
    objects[k].shown().filter_map(piece).collect()
}

/// Returns the link (or the world) that carries the frame of object `k` of a scene, and the frame's pose there `[m]`.
///
/// # Panics
///
/// If `k` is not below the number of the scene's objects.
#[must_use]
pub fn frame_of(scene: &Scene, k: usize) -> Attached<f64> {
    attached(&scene.objects, scene.model.names(), k)
}

/// Frame of an object, attached to its link or to the world.
fn attached(objects: &[Object], names: &Names, k: usize) -> Attached<f64> {
    let object = &objects[k];
    if let Some(joint) = names.joint(&object.path) {
        return joint.moving;
    }
    if let Some(frame) = names.frame(&object.path) {
        return Attached { link: frame.link, pose: frame.pose };
    }
    let world = Attached { link: None, pose: Pose::identity() };
    let parent = object.parent.map_or(world, |p| attached(objects, names, p));
    Attached { pose: parent.pose.compose(&object.pose), ..parent }
}

//! What of a scene can be seen: every solid and surface of its bodies, where it hangs and what colour it has. Sensors that look (distances,
//! images) and clients ask it; no step does.

use std::sync::Arc;

use sincro_dynamics::geometry::{Geometry, Hit, Ray};
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::model::{Model, Names};
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::Pose;

use crate::scene::{Object, ObjectKind, Scene};

/// Red, green and blue of bodies that have no colour of their own, by turns, as the page has them.
const PLAIN: [[u8; 3]; 6] = [
    [0x5b, 0x7f, 0x9e],
    [0xc9, 0x8a, 0x3c],
    [0x5f, 0x9e, 0x83],
    [0xa8, 0x74, 0x8f],
    [0x8a, 0x8f, 0x98],
    [0xb5, 0xa6, 0x42],
];
/// Of planes without one.
const FLOOR: [u8; 3] = [0xf1, 0xf3, 0xf5];

/// A solid or surface where it hangs.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Index of its body among the objects of the scene.
    pub object: usize,
    /// Where its frame is fixed.
    pub at: Attached<f64>,
    /// What it is.
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

/// The pieces at one instant.
#[derive(Clone, Debug)]
pub struct Sight<'a> {
    pieces: &'a [Piece],
    /// Of each piece, in the world.
    poses: Vec<Pose<f64>>,
}

impl Scenery {
    /// Of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let names = scene.model.names();
        let mut n_bodies = 0;
        let mut pieces = Vec::new();
        for (k, object) in scene.objects.iter().enumerate() {
            pieces.extend(pieces_of(&scene.objects, names, k, PLAIN[n_bodies % PLAIN.len()]));
            n_bodies += usize::from(matches!(object.kind, ObjectKind::Body { .. }));
        }
        Self { pieces }
    }

    /// Where everything is, after `scratch` has the poses of the links.
    #[must_use]
    pub fn sight(&self, scratch: &Scratch<f64>) -> Sight<'_> {
        let poses = self.pieces.iter().map(|piece| kinematics::frame_pose(scratch, &piece.at));
        Sight { pieces: &self.pieces, poses: poses.collect() }
    }

    /// Where everything is at coordinates `q`.
    #[must_use]
    pub fn at(&self, model: &Model<f64>, q: &[f64], scratch: &mut Scratch<f64>) -> Sight<'_> {
        kinematics::poses(model, q, scratch);
        self.sight(scratch)
    }
}

impl<'a> Sight<'a> {
    /// Every piece and its pose in the world.
    pub fn iter(&self) -> impl Iterator<Item = (&'a Piece, &Pose<f64>)> {
        self.pieces.iter().zip(&self.poses)
    }

    /// The first piece that a ray in the world meets within `most` `[m]`, among those that `sees` admits: its index, and where.
    #[must_use]
    pub fn hit(&self, ray: &Ray, most: f64, sees: impl Fn(&Piece) -> bool) -> Option<(usize, Hit)> {
        let mut nearest: Option<(usize, Hit)> = None;
        for (k, (piece, pose)) in self.iter().enumerate() {
            let limit = nearest.map_or(most, |(_, hit)| hit.distance);
            if !sees(piece) {
                continue;
            }
            let local = Ray {
                origin: pose.rot.tr_mul_vec(ray.origin - pose.pos),
                direction: pose.rot.tr_mul_vec(ray.direction),
            };
            if let Some(hit) = piece.geometry.hit(&local, limit) {
                nearest = Some((k, Hit { normal: pose.rot.mul_vec(hit.normal), ..hit }));
            }
        }
        nearest
    }
}

/// The pieces of object `k`; `plain` is the colour of what has none.
fn pieces_of(objects: &[Object], names: &Names, k: usize, plain: [u8; 3]) -> Vec<Piece> {
    let object = &objects[k];
    if object.shapes.is_empty() && object.surfaces.is_empty() {
        return Vec::new();
    }
    let frame = attached(objects, names, k);
    let solids = object.shapes.iter().map(|s| (sincro_dynamics::contact::Surface::Solid(s.shape), s.pose, s.color));
    let surfaces = object
        .surfaces
        .iter()
        .enumerate()
        .map(|(i, (surface, pose))| (surface.clone(), *pose, object.surface_colors.get(i).copied().flatten()));
    let piece = |(surface, pose, color): (_, Pose<f64>, Option<[u8; 3]>)| {
        let plain = if surface == sincro_dynamics::contact::Surface::HalfSpace { FLOOR } else { plain };
        let geometry = Arc::new(Geometry::new(surface)?);
        let at = Attached { pose: frame.pose.compose(&pose), ..frame };
        Some(Piece { object: k, at, geometry, color: color.unwrap_or(plain) })
    };
    solids.chain(surfaces).filter_map(piece).collect()
}

/// Where the frame of object `k` of a scene is fixed: at its link, or in the world.
#[must_use]
pub fn frame_of(scene: &Scene, k: usize) -> Attached<f64> {
    attached(&scene.objects, scene.model.names(), k)
}

/// Where an object's frame is fixed: at its link, or in the world.
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

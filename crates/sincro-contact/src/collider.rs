//! Colliders: surfaces fixed in links or in the world.

use super::{BodyId, Material, Surface};
use sincro_geometry::Shape;
use sincro_geometry::spatial::{Pose, Vec3};

/// Index of the world among links.
pub const WORLD: u32 = u32::MAX;

/// Collider: a surface fixed in a link or the world, an entry of the list that [`pairs`](crate::pairs) and
/// [`Detector`](crate::Detector) take.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// Name of the body or frame that carries it.
    pub name: String,
    /// Id of that body or frame; `None` for the world.
    pub body: Option<BodyId>,
    /// Index of the link in the poses given to [`Detector::detect`](crate::Detector::detect); [`WORLD`] for none.
    pub link: u32,
    /// Pose of the surface's frame in the link, or in the world `[m]`.
    pub pose: Pose<f64>,
    /// Geometry, in the surface's own frame.
    pub surface: Surface,
    /// Contact properties.
    pub material: Material,
}

impl Collider {
    /// Rounded points that represent the surface over a plane, in the link: vertices, ends of a capsule; none for
    /// others.
    pub(crate) fn points(&self) -> (Vec<Vec3<f64>>, f64) {
        let at = |p: [f64; 3]| self.pose.point(Vec3(p));
        match &self.surface {
            Surface::Solid(Shape::Sphere { radius }) => (vec![at([0.0; 3])], *radius),
            Surface::Solid(Shape::Capsule { radius, length }) => {
                (vec![at([0.0, 0.0, -0.5 * length]), at([0.0, 0.0, 0.5 * length])], *radius)
            }
            Surface::Solid(Shape::Cuboid { size }) => {
                let corner = |k: usize| {
                    at(std::array::from_fn(|c| if k >> c & 1 == 0 { -0.5 * size[c] } else { 0.5 * size[c] }))
                };
                ((0..8).map(corner).collect(), 0.0)
            }
            Surface::Hull(points) => (points.iter().map(|p| at(*p)).collect(), 0.0),
            _ => (Vec::new(), 0.0),
        }
    }

    /// Radius of a sphere `[m]`; none of other surfaces.
    pub(crate) fn ball(&self) -> Option<f64> {
        match self.surface {
            Surface::Solid(Shape::Sphere { radius }) => Some(radius),
            _ => None,
        }
    }
}

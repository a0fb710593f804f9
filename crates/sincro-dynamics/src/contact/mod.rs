//! Contact detection: colliders with their materials, pairs of them, and contact candidates.
//!
//! A shape takes part in contact if it has a [`Material`]. Two such shapes form a pair unless they are fixed to one
//! another, joined directly by a joint, or in the same group. A pair has a fixed number of slots, the most contact
//! points it may have; a point is known by its slot, and states hold the loaded ones.
//!
//! Broad phase: bounding spheres of the pair against a margin (`broad_phase`). Narrow phase, by kind of pair: closed
//! forms for points, cylinders and spheres against planes and cuboids (`detect`), separating axes and face clipping for
//! convex polytopes ([`crate::geometry`], `sat`), contact manifolds of the collision library for the rest (`manifold`).
//! Every contact candidate is a rounded point of one body against a plane, line or point of the other (`candidate`),
//! which gives signed distance, normal and their rates exactly, curvature included.
//!
//! The contact law of a pair combines two materials: the geometric mean of the friction coefficients (nothing sticks to
//! a frictionless surface), the larger restitution, the larger lengths of rolling and spinning friction, the sum of the
//! compliances. A [`PairLaw`] of the two bodies replaces any of these.

mod broad_phase;
pub(crate) mod candidate;
pub(crate) mod candidate_list;
mod detect;
mod manifold;

pub use crate::geometry::Surface;
use crate::geometry::sat::Polytope;
pub(crate) use broad_phase::Margin;
pub(crate) use detect::Detector;

use crate::geometry::Shape;
use crate::ids::BodyId;
use crate::joint::WORLD;
use crate::spatial::{Pose, Vec3};

/// Contact properties of one surface, given to [`ModelBuilder::collider`](crate::model::ModelBuilder::collider); those
/// of a pair follow from [`Material::with`].
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let steel = Material { friction: 0.4, restitution: 0.6, stiffness: 2e6, ..Material::default() };
/// let rubber = Material { friction: 0.9, restitution: 0.3, stiffness: 1e5, ..Material::default() };
/// // the law of the pair: geometric mean of the friction, compliances add up
/// let pair = steel.with(&rubber);
/// assert!((pair.friction - 0.6).abs() < 1e-15 && pair.restitution == 0.6);
/// assert!((1.0 / pair.stiffness - (1.0 / 2e6 + 1.0 / 1e5)).abs() < 1e-18); // [m/N]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coefficient of Coulomb friction μ (dimensionless).
    pub friction: f64,
    /// Coefficient of restitution (Newton): speed of separation over speed of approach, 0 to 1.
    pub restitution: f64,
    /// Coefficient of rolling friction `[m]`: the torque is at most this times the normal force.
    pub rolling_friction: f64,
    /// Coefficient of spinning friction `[m]`: the torque about the normal is at most this times the normal force.
    pub spinning_friction: f64,
    /// Stiffness, normal force over penetration `[N/m]`; infinite for a rigid surface.
    pub stiffness: f64,
    /// Dissipation of a compliant contact [s/m]: force k·δ·(1 + dissipation·δ̇).
    pub dissipation: f64,
    /// Collision group: colliders of the same group, other than 0, do not collide with each other.
    pub group: u32,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            friction: 0.0,
            restitution: 0.0,
            rolling_friction: 0.0,
            spinning_friction: 0.0,
            stiffness: f64::INFINITY,
            dissipation: 0.0,
            group: 0,
        }
    }
}

impl Material {
    /// Coefficients in the order of the fields: friction, restitution, rolling and spinning friction `[m]`, stiffness
    /// [N/m], dissipation [s/m].
    pub(crate) fn coefficients(&self) -> [f64; 6] {
        let Self { friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation, group: _ } =
            *self;
        [friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation]
    }

    /// This material with other [`Material::coefficients`].
    pub(crate) fn with_coefficients(self, coefficients: [f64; 6]) -> Self {
        let [friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation] = coefficients;
        Self { friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation, ..self }
    }

    /// Contact law of a pair of surfaces: geometric mean of the friction coefficients, sum of the compliances 1/k, the
    /// larger of the two for all else; the group of the result is 0.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            friction: (self.friction * other.friction).sqrt(),
            restitution: self.restitution.max(other.restitution),
            rolling_friction: self.rolling_friction.max(other.rolling_friction),
            spinning_friction: self.spinning_friction.max(other.spinning_friction),
            stiffness: 1.0 / (1.0 / self.stiffness + 1.0 / other.stiffness),
            dissipation: self.dissipation.max(other.dissipation),
            group: 0,
        }
    }
}

/// Contact law of the surfaces of two bodies, in place of the combination of their materials, for
/// [`ModelBuilder::contact_pair`](crate::model::ModelBuilder::contact_pair). Fields that are `None` are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairLaw {
    /// True if the two do not collide with each other.
    pub is_excluded: bool,
    /// Coefficient of Coulomb friction μ (dimensionless).
    pub friction: Option<f64>,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: Option<f64>,
    /// Coefficient of rolling friction `[m]`.
    pub rolling_friction: Option<f64>,
    /// Coefficient of spinning friction `[m]`.
    pub spinning_friction: Option<f64>,
    /// Stiffness, normal force over penetration `[N/m]`; infinite for a rigid contact.
    pub stiffness: Option<f64>,
    /// Dissipation of a compliant contact [s/m].
    pub dissipation: Option<f64>,
}

impl PairLaw {
    /// The contact law, from the combination of the two materials.
    fn replace(&self, combined: Material) -> Material {
        Material {
            friction: self.friction.unwrap_or(combined.friction),
            restitution: self.restitution.unwrap_or(combined.restitution),
            rolling_friction: self.rolling_friction.unwrap_or(combined.rolling_friction),
            spinning_friction: self.spinning_friction.unwrap_or(combined.spinning_friction),
            stiffness: self.stiffness.unwrap_or(combined.stiffness),
            dissipation: self.dissipation.unwrap_or(combined.dissipation),
            group: 0,
        }
    }
}

/// Collider: a surface fixed in a link or the world, listed in
/// [`ConstraintSet::colliders`](crate::model::ConstraintSet).
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// Name of the body or frame that carries it.
    pub name: String,
    /// Id of that body or frame; `None` for the world.
    pub body: Option<BodyId>,
    /// The link, `WORLD` for none.
    pub(crate) link: u32,
    /// Pose of the surface's frame in the link, or in the world `[m]`.
    pub pose: Pose<f64>,
    /// Geometry, in the surface's own frame.
    pub surface: Surface,
    /// Contact properties.
    pub material: Material,
}

/// Pair of colliders that can collide, listed in [`ConstraintSet::pairs`](crate::model::ConstraintSet); each of its
/// slots can hold one contact point.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Index of the collider whose points touch.
    pub a: usize,
    /// Index of the collider that is touched.
    pub b: usize,
    /// Contact law of the pair.
    pub material: Material,
    /// True if the two pass through each other.
    pub is_ignored: bool,
    /// Index of its first slot among those of contacts; in all slots those of limits come before.
    pub first: usize,
    /// Number of slots: the most contact points that the pair can have.
    pub slots: usize,
    kind: PairKind,
}

/// Narrow-phase algorithm of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PairKind {
    /// Rounded points of a against the plane b.
    PointsOnPlane,
    /// A cylinder or torus on a plane.
    DiscsOnPlane,
    /// Ball against ball.
    Balls,
    /// Ball a against cuboid b.
    BallOnCuboid,
    /// Two convex polytopes.
    Polytopes,
    /// By the general algorithm.
    General,
}

impl Pair {
    /// Number of rows of a contact point: its normal, and two, two and one of its friction groups.
    pub(crate) fn rows_per_point(&self) -> usize {
        let Material { friction, rolling_friction, spinning_friction, .. } = self.material;
        let rows = |dim: usize, coefficient: f64| if coefficient > 0.0 { dim } else { 0 };
        1 + rows(2, friction) + rows(2, rolling_friction) + rows(1, spinning_friction)
    }
}

/// Maximum number of points of a contact manifold between two solids.
const MANIFOLD: usize = 8;

impl Collider {
    /// Rounded points that represent the surface over a plane, in the link: vertices, ends of a capsule; none for
    /// others.
    fn points(&self) -> (Vec<Vec3<f64>>, f64) {
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

    fn ball(&self) -> Option<f64> {
        match self.surface {
            Surface::Solid(Shape::Sphere { radius }) => Some(radius),
            _ => None,
        }
    }
}

/// The pairs of a set of surfaces; `joined` says of two links whether a joint joins them directly, `law` gives the law
/// of two colliders that have one of their own.
pub(crate) fn pairs(
    colliders: &[Collider],
    joined: impl Fn(u32, u32) -> bool,
    law: impl Fn(usize, usize) -> PairLaw,
) -> Vec<Pair> {
    let mut pairs: Vec<Pair> = Vec::new();
    let is_polytope: Vec<bool> = colliders.iter().map(|c| Polytope::new(&c.surface, &c.pose).is_some()).collect();
    for i in 0..colliders.len() {
        for j in i + 1..colliders.len() {
            let (x, y) = (&colliders[i], &colliders[j]);
            let same_group = x.material.group != 0 && x.material.group == y.material.group;
            // a joint to the world does not keep what it carries off the floor
            let adjacent = x.link != WORLD && y.link != WORLD && joined(x.link, y.link);
            let law = law(i, j);
            if x.link == y.link || same_group || adjacent || law.is_excluded {
                continue;
            }
            let Some((a, b, kind, slots)) = arrange(colliders, &is_polytope, i, j) else { continue };
            let first = pairs.last().map_or(0, |p| p.first + p.slots);
            pairs.push(Pair {
                a,
                b,
                material: law.replace(x.material.with(&y.material)),
                is_ignored: false,
                first,
                slots,
                kind,
            });
        }
    }
    pairs
}

/// Roles of two colliders, their narrow-phase algorithm and number of slots; none if they cannot touch.
fn arrange(
    colliders: &[Collider],
    is_polytope: &[bool],
    i: usize,
    j: usize,
) -> Option<(usize, usize, PairKind, usize)> {
    let fixed = |k: usize| !matches!(colliders[k].surface, Surface::Solid(_) | Surface::Hull(_));
    if fixed(i) && fixed(j) {
        return None;
    }
    let (a, b) = if fixed(i) { (j, i) } else { (i, j) };
    let is = |k: usize, test: fn(&Surface) -> bool| test(&colliders[k].surface);
    let cuboid: fn(&Surface) -> bool = |s| matches!(s, Surface::Solid(Shape::Cuboid { .. }));
    if is(b, |s| matches!(s, Surface::HalfSpace)) {
        let slots = match &colliders[a].surface {
            Surface::Solid(Shape::Cylinder { .. }) => return Some((a, b, PairKind::DiscsOnPlane, 8)),
            Surface::Solid(Shape::Torus { .. }) => return Some((a, b, PairKind::DiscsOnPlane, 4)),
            Surface::Solid(Shape::Cone { .. }) => return Some((a, b, PairKind::General, MANIFOLD)),
            _ => colliders[a].points().0.len(),
        };
        return Some((a, b, PairKind::PointsOnPlane, slots));
    }
    Some(match (colliders[a].ball().is_some(), colliders[b].ball().is_some()) {
        (true, true) => (a, b, PairKind::Balls, 1),
        (true, false) if is(b, cuboid) => (a, b, PairKind::BallOnCuboid, 1),
        (false, true) if is(a, cuboid) => (b, a, PairKind::BallOnCuboid, 1),
        (false, true) => (b, a, PairKind::General, MANIFOLD),
        _ if is_polytope[a] && is_polytope[b] => (a, b, PairKind::Polytopes, MANIFOLD),
        _ => (a, b, PairKind::General, MANIFOLD),
    })
}

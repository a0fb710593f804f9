//! Distances and collisions of objects and collections, now: of bodies with shapes, of shapes made at run time, and of
//! points.

use std::sync::{Arc, OnceLock};

use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::Shape;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::flags::{COLLIDABLE, MEASURABLE};
use super::senses::handle_of;
use super::{ApiError, Entity, Handle, Kind, SimApi};

/// Result of a distance query of two entities: the closest pair of points, as [`SimApi::distance`] finds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceResult {
    /// Distance of the two points `[m]`; 0 if the surfaces meet or overlap.
    pub distance: f64,
    /// Closest point of the first entity and of the second `[m]`: x, y, z in the world frame.
    pub points: [Vec3<f64>; 2],
    /// Handles of the objects that the two points lie on, first and second.
    pub objects: [Handle; 2],
}

/// A surface where it is.
pub(super) struct Part {
    pub object: Handle,
    geometry: Arc<Geometry>,
    pub at: Pose<f64>,
}

impl SimApi<'_> {
    /// Everything of an entity that has a place and this flag: surfaces, and points of single objects that have none.
    fn parts(&mut self, entity: Entity, flag: i64) -> Result<Vec<Part>, ApiError> {
        let members = self.members(entity)?;
        let found: Vec<(Handle, Arc<Geometry>, Attached<f64>)> = {
            let registry = &*self.registry;
            let is_member = |own: Handle| members.binary_search(&own).is_ok() && registry.counts(entity, own, flag);
            let pieces = registry.senses.pieces().filter(|p| is_member(handle_of(p)));
            pieces.map(|p| (handle_of(p), p.geometry.clone(), p.at)).collect()
        };
        let mut parts = Vec::with_capacity(found.len());
        for (object, geometry, at) in found {
            parts.push(Part { object, geometry, at: self.place(&at) });
        }
        if let Entity::Object(object) = entity
            && parts.is_empty()
            && self.registry.takes_part(object, flag)
        {
            let entry = self.registry.entry(object)?;
            if !matches!(entry.kind, Kind::Frame | Kind::Sensor | Kind::Dummy) {
                return Err(ApiError(format!("`{}` has no shape that a distance could be measured from", entry.path)));
            }
            let frame = entry.frame;
            parts.push(Part { object, geometry: point(), at: self.place(&frame) });
        }
        parts.iter_mut().for_each(|part| self.shift(part));
        Ok(parts)
    }

    /// Minimum distance of two entities at the present instant; none if it exceeds `most` `[m]`, or if nothing of one
    /// is measurable. [`Entity::All`] stands
    /// for everything that has a shape and does not belong to the other entity.
    ///
    /// # Errors
    ///
    /// An entity was removed, or is an object without shape that is no point either (a joint, a force).
    pub fn distance(&mut self, one: Entity, two: Entity, most: f64) -> Result<Option<DistanceResult>, ApiError> {
        self.distance_of([one, two], most, MEASURABLE)
    }

    /// Minimum distance of what has a flag of two entities.
    pub(super) fn distance_of(
        &mut self,
        [one, two]: [Entity; 2],
        most: f64,
        flag: i64,
    ) -> Result<Option<DistanceResult>, ApiError> {
        let (mut first, mut second) = (self.parts(one, flag)?, self.parts(two, flag)?);
        match (one, two) {
            (_, Entity::All) => {
                let own = self.members(one)?;
                second.retain(|part| one == Entity::All || own.binary_search(&part.object).is_err());
            }
            (Entity::All, _) => {
                let own = self.members(two)?;
                first.retain(|part| own.binary_search(&part.object).is_err());
            }
            _ => {}
        }
        let mut best: Option<DistanceResult> = None;
        for a in &first {
            for b in second.iter().filter(|b| b.object != a.object) {
                let limit = best.map_or(most, |best| best.distance);
                let apart = (a.at.pos - b.at.pos).norm() - a.geometry.reach() - b.geometry.reach();
                if apart > limit {
                    continue;
                }
                let x_ab = a.at.inverse().compose(&b.at);
                if let Some(found) = a.geometry.closest(&b.geometry, &x_ab, limit)
                    && best.is_none_or(|best| found.distance < best.distance)
                {
                    let points = found.points.map(|p| a.at.point(p));
                    best = Some(DistanceResult { distance: found.distance, points, objects: [a.object, b.object] });
                }
                if best.is_some_and(|best| best.distance == 0.0) {
                    return Ok(best);
                }
            }
        }
        Ok(best)
    }

    /// Finds two collidable objects, one of each entity and in this order, that press on each other or whose surfaces
    /// meet; none if there are none.
    ///
    /// # Errors
    ///
    /// An entity was removed, or is an object without shape.
    pub fn collision(&mut self, one: Entity, two: Entity) -> Result<Option<[Handle; 2]>, ApiError> {
        for entity in [one, two] {
            if let Entity::Object(object) = entity
                && !self.registry.senses.pieces().any(|piece| handle_of(piece) == object)
            {
                let path = &self.registry.entry(object)?.path;
                return Err(ApiError(format!("`{path}` has no shape: it meets nothing")));
            }
        }
        let (first, second) = (self.members(one)?, self.members(two)?);
        let points = self.contact_points();
        let registry = &*self.registry;
        let is_of = |members: &[Handle], entity: Entity, body: Handle| {
            members.binary_search(&body).is_ok() && registry.counts(entity, body, COLLIDABLE)
        };
        let (of_first, of_second) = (|body: Handle| is_of(&first, one, body), |body: Handle| is_of(&second, two, body));
        let pressing = points.into_iter().map(|contact| contact.bodies).find_map(|[a, b]| {
            if of_first(a) && of_second(b) { Some([a, b]) } else { (of_first(b) && of_second(a)).then_some([b, a]) }
        });
        if pressing.is_some() {
            return Ok(pressing);
        }
        Ok(self.distance_of([one, two], 0.0, COLLIDABLE)?.map(|found| found.objects))
    }
}

/// A point as a surface.
fn point() -> Arc<Geometry> {
    static POINT: OnceLock<Arc<Geometry>> = OnceLock::new();
    let new = || Geometry::new(Surface::Solid(Shape::Sphere { radius: 0.0 })).expect("a point has a place");
    POINT.get_or_init(|| Arc::new(new())).clone()
}

//! Visible pieces of a registry, of the scene and of runtime objects, with its proximity sensors and collections.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::collections::{Collection, Entity};
use super::{ApiError, Entry, Handle, Kind, ObjectRegistry};
use sincro_scene::scene::Scene;
use sincro_scene::scenery::{Piece, Scenery};
use sincro_sim::proximity::{Detection, ProximitySensor};
use sincro_sim::runtime_object::RuntimePart;

/// Corners and heights of everything that clients and scripts make together.
const MAX_CORNERS: usize = 2_000_000;
/// Colour of what is made without one.
const PLAIN: [u8; 3] = [0xc9, 0xa1, 0x5b];

/// Visible pieces, proximity sensors and collections.
#[derive(Clone, Debug, Default)]
pub(super) struct Senses {
    /// Pieces of the scene.
    pub scenery: Scenery,
    /// Pieces of runtime objects, at their present poses.
    runtime: Vec<Piece>,
    /// Pose of each of them in its object.
    places: Vec<Pose<f64>>,
    /// Proximity sensors.
    pub proximity: BTreeMap<Handle, ProximityEntry>,
    /// By their handles.
    pub collections: BTreeMap<Handle, Collection>,
    /// Objects whose colour was set.
    painted: BTreeSet<usize>,
}

/// A proximity sensor and what it saw last.
#[derive(Clone, Debug)]
pub(super) struct ProximityEntry {
    pub sensor: ProximitySensor,
    /// True if it is handled explicitly.
    pub is_explicit: bool,
    /// True if it belongs to the scene, which samples it.
    pub is_of_scene: bool,
    /// Minimum distance: anything nearer blinds the sensor `[m]`.
    pub blind_below: f64,
    /// Latest reading; none before the first.
    pub saw: Option<Option<Detection>>,
    /// Entity that a client or script has it detect; all by default.
    pub entity: Entity,
}

impl Senses {
    /// Pieces and sensors of a scene.
    pub fn new(scene: &Scene) -> Self {
        let object_of = |path: &str| scene.object(path).map(|o| o.id);
        let mut proximity = BTreeMap::new();
        for spec in &scene.sensors {
            let (Some(sensor), Some(own)) = (ProximitySensor::of(spec, scene), object_of(&spec.path)) else { continue };
            proximity.insert(
                Handle(own as i32 + 1),
                ProximityEntry {
                    sensor,
                    is_explicit: false,
                    is_of_scene: true,
                    blind_below: 0.0,
                    saw: None,
                    entity: Entity::All,
                },
            );
        }
        Self { scenery: scene.scenery().clone(), proximity, ..Self::default() }
    }

    /// Every piece, the scene's first.
    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.scenery.pieces.iter().chain(&self.runtime)
    }

    /// Pieces of a runtime object, each with its pose in the object.
    pub fn parts_of(&self, own: Handle) -> Vec<(Piece, Pose<f64>)> {
        let parts = self.runtime.iter().zip(&self.places).filter(|(piece, _)| handle_of(piece) == own);
        parts.map(|(piece, place)| (piece.clone(), *place)).collect()
    }

    /// Pieces of all runtime objects, for pictures.
    pub fn parts_by_object(&self) -> BTreeMap<Handle, Vec<RuntimePart>> {
        let mut parts: BTreeMap<Handle, Vec<RuntimePart>> = BTreeMap::new();
        for (piece, place) in self.runtime.iter().zip(&self.places) {
            let part = RuntimePart { geometry: piece.geometry.clone(), place: *place, color: piece.color };
            parts.entry(handle_of(piece)).or_default().push(part);
        }
        parts
    }

    /// Returns true if a runtime object can be seen.
    pub fn has_runtime_pieces(&self, own: Handle) -> bool {
        self.runtime.iter().any(|piece| handle_of(piece) == own)
    }

    /// Removes a runtime object.
    pub fn forget(&mut self, own: Handle) {
        self.forget_parts(own);
        self.proximity.remove(&own);
        self.detect_all_for(Entity::Object(own));
        for collection in self.collections.values_mut() {
            collection.forget(own);
        }
    }

    /// Proximity sensors that were to detect an entity that has gone detect all.
    pub fn detect_all_for(&mut self, entity: Entity) {
        self.proximity
            .values_mut()
            .filter(|sensor| sensor.entity == entity)
            .for_each(|sensor| sensor.entity = Entity::All);
    }

    /// A run has ended: proximity sensors detect the entities of `before` it, and are handled as then.
    pub fn end_run(&mut self, before: &Self) {
        for (own, sensor) in &mut self.proximity {
            if let Some(before) = before.proximity.get(own) {
                (sensor.entity, sensor.is_explicit) = (before.entity, before.is_explicit);
            }
        }
    }

    /// Takes away the pieces of a runtime object.
    pub fn forget_parts(&mut self, own: Handle) {
        let stays: Vec<bool> = self.runtime.iter().map(|piece| handle_of(piece) != own).collect();
        let mut stay = stays.iter();
        self.runtime.retain(|_| *stay.next().expect("one for each"));
        let mut stay = stays.iter();
        self.places.retain(|_| *stay.next().expect("one for each"));
    }

    /// Colours the part that was added last.
    pub fn paint_last(&mut self, color: [u8; 3]) {
        if let Some(last) = self.runtime.last_mut() {
            last.color = color;
        }
    }

    /// Adds a part to a runtime object.
    pub fn add(&mut self, own: Handle, frame: &Attached<f64>, geometry: Arc<Geometry>, place: Pose<f64>) {
        let at = Attached { pose: frame.pose.compose(&place), ..*frame };
        self.runtime.push(Piece { object: own.0 as usize - 1, at, geometry, color: PLAIN });
        self.places.push(place);
    }

    /// The object has moved to another frame.
    pub fn moved(&mut self, own: Handle, frame: &Attached<f64>) {
        for (piece, place) in self.runtime.iter_mut().zip(&self.places).filter(|(piece, _)| handle_of(piece) == own) {
            piece.at = Attached { pose: frame.pose.compose(place), ..*frame };
        }
    }

    /// Colours everything of an object.
    pub fn paint(&mut self, own: Handle, color: [u8; 3]) {
        self.painted.insert(own.0 as usize - 1);
        for piece in self.scenery.pieces.iter_mut().chain(&mut self.runtime).filter(|piece| handle_of(piece) == own) {
            piece.color = color;
        }
    }

    /// Returns true if the colour of an object was set.
    pub fn is_painted(&self, object: usize) -> bool {
        self.painted.contains(&object)
    }

    /// A surface ready to be looked at; refused if it has no extent, or if there would be too many corners.
    pub fn prepare(&self, surface: Surface) -> Result<Arc<Geometry>, ApiError> {
        check_corners(self.n_corners(|_| true) + corners(&surface))?;
        geometry(surface)
    }

    /// Shows a surface at some places of a runtime object `[m]`, each with a colour, in place of its pieces. If they
    /// become more and have too many corners, or the surface has no extent, it is refused and the pieces stay.
    pub fn replace_parts(
        &mut self,
        own: Handle,
        frame: &Attached<f64>,
        surface: Surface,
        items: &[([f64; 3], [u8; 3])],
    ) -> Result<(), ApiError> {
        let n = items.len() * corners(&surface);
        if n > self.n_corners(|other| other == own) {
            check_corners(self.n_corners(|other| other != own) + n)?;
        }
        let geometry = geometry(surface)?;
        self.forget_parts(own);
        for (place, color) in items {
            self.add(own, frame, geometry.clone(), Pose::translation(Vec3(*place)));
            self.paint_last(*color);
        }
        Ok(())
    }

    /// Refuses the copy of a runtime object with which there would be too many corners.
    pub fn check_copy(&self, own: Handle) -> Result<(), ApiError> {
        check_corners(self.n_corners(|_| true) + self.n_corners(|other| other == own))
    }

    /// Number of corners of some runtime objects.
    fn n_corners(&self, is_counted: impl Fn(Handle) -> bool) -> usize {
        let pieces = self.runtime.iter().filter(|piece| is_counted(handle_of(piece)));
        pieces.map(|piece| corners(piece.geometry.surface())).sum()
    }
}

/// The object of a piece.
pub(super) fn handle_of(piece: &Piece) -> Handle {
    Handle(piece.object as i32 + 1)
}

fn geometry(surface: Surface) -> Result<Arc<Geometry>, ApiError> {
    let geometry = Geometry::new(surface);
    geometry.map(Arc::new).ok_or_else(|| ApiError::new("the surface has no extent, or its triangles are none"))
}

fn check_corners(n: usize) -> Result<(), ApiError> {
    if n <= MAX_CORNERS {
        return Ok(());
    }
    let help = "remove some, or take larger voxels and fewer points";
    Err(ApiError(format!("what is made at run time may have {MAX_CORNERS} corners together, not {n}: {help}")))
}

fn corners(surface: &Surface) -> usize {
    match surface {
        Surface::Hull(points) | Surface::Mesh(points, _) => points.len(),
        Surface::HeightField { heights, .. } => heights.len(),
        _ => 8,
    }
}

impl ObjectRegistry {
    /// Pieces of what clients and scripts have made.
    pub(crate) fn runtime_pieces(&self) -> &[Piece] {
        &self.senses.runtime
    }

    /// Sensors that are to look at an entity that has gone look at all.
    pub(super) fn settle_entities(&mut self) {
        let of_proximity = self.senses.proximity.values().map(|sensor| sensor.entity);
        let entities: Vec<Entity> = of_proximity.chain(self.vision.entities()).collect();
        for entity in entities {
            let is_there = match entity {
                Entity::All => true,
                Entity::Object(own) => self.entry(own).is_ok(),
                Entity::Collection(own) => self.is_collection(own),
            };
            if !is_there {
                self.forget_entity(entity);
            }
        }
    }

    /// Sensors that were to look at an entity that has gone look at all.
    pub(super) fn forget_entity(&mut self, entity: Entity) {
        self.senses.detect_all_for(entity);
        self.vision.show_all_for(entity);
    }

    /// No proximity sensor has looked yet.
    pub(super) fn reset_looks(&mut self) {
        self.senses.proximity.values_mut().for_each(|entry| entry.saw = None);
    }

    /// A run has ended: nobody has looked, shapes and sensors that were made in it, beyond the first `n_before`
    /// objects, are gone with it, as in V-REP, and the others are where their objects are.
    pub(super) fn settle_senses(&mut self, n_before: usize) {
        self.reset_looks();
        let is_new = |e: &&Entry| {
            e.handle.0 as usize > n_before && matches!(e.kind, Kind::Shape | Kind::Proximity | Kind::Vision(_))
        };
        let new: Vec<Handle> = self.entries().filter(is_new).map(|e| e.handle).collect();
        for handle in new {
            self.remove(handle).expect("it was made");
        }
        let made: Vec<(Handle, Attached<f64>)> =
            self.entries().filter(|e| e.is_runtime).map(|e| (e.handle, e.frame)).collect();
        for (handle, frame) in made {
            self.senses.moved(handle, &frame);
        }
    }

    /// Another object gets the pieces and sensors of a runtime object, and its voxels or points.
    pub(super) fn copy_senses(&mut self, from: Handle, to: Handle) {
        let Ok(frame) = self.entry(to).map(|e| e.frame) else { return };
        for (piece, place) in self.senses.parts_of(from) {
            self.senses.add(to, &frame, piece.geometry, place);
            self.senses.paint_last(piece.color);
        }
        if let Some(entry) = self.senses.proximity.get(&from).cloned() {
            self.senses.proximity.insert(to, ProximityEntry { saw: None, ..entry });
        }
        if let Some(voxels) = self.octrees.get(&from).cloned() {
            self.octrees.insert(to, voxels);
        }
        if let Some(points) = self.clouds.get(&from).cloned() {
            self.clouds.insert(to, points);
        }
    }

    /// A proximity sensor of the scene has taken a sample; one with explicit handling keeps its last reading.
    pub(crate) fn sampled(&mut self, sensor: Handle, saw: Option<Detection>) {
        if self.senses.proximity.get(&sensor).is_some_and(|entry| !entry.is_explicit) {
            self.tell(sensor, saw);
        }
    }

    /// Stores the reading of a proximity sensor.
    pub(crate) fn tell(&mut self, sensor: Handle, saw: Option<Detection>) {
        if let Some(entry) = self.senses.proximity.get_mut(&sensor) {
            entry.saw = Some(saw);
        }
    }
}

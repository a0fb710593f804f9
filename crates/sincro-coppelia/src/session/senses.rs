//! What a table knows of what can be seen: the scene's pieces, what clients and scripts have made, their proximity sensors, their collections.

use std::collections::BTreeMap;
use std::sync::Arc;

use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::Geometry;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::spatial::Pose;

use super::collections::Collection;
use super::{Entry, Handle, Kind, Refusal, Table};
use sincro_scene::scene::Scene;
use sincro_scene::scenery::{Piece, Scenery};
use sincro_sim::proximity::{Detection, ProximitySensor};

/// Corners and heights of everything that clients and scripts make together.
const MOST_CORNERS: usize = 2_000_000;
/// Colour of what is made without one.
const PLAIN: [u8; 3] = [0xc9, 0xa1, 0x5b];

/// See the head of this file.
#[derive(Clone, Debug, Default)]
pub(super) struct Senses {
    /// Of the scene.
    pub scenery: Scenery,
    /// Of what was made, where it is now.
    made: Vec<Piece>,
    /// Where each of them stands in its object.
    places: Vec<Pose<f64>>,
    /// Proximity sensors.
    pub looks: BTreeMap<Handle, Look>,
    /// By their handles.
    pub collections: BTreeMap<Handle, Collection>,
}

/// A proximity sensor and what it saw last.
#[derive(Clone, Debug)]
pub(super) struct Look {
    pub eye: ProximitySensor,
    /// Whether it looks only when it is told to.
    pub is_explicit: bool,
    /// Whether it belongs to the scene, which samples it.
    pub is_of_scene: bool,
    /// What is nearer than this makes it blind `[m]`.
    pub blind_below: f64,
    /// What it saw when it looked last; none if it has not looked yet.
    pub saw: Option<Option<Detection>>,
}

impl Senses {
    /// Of a scene.
    pub fn new(scene: &Scene) -> Self {
        let object_of = |path: &str| scene.objects.iter().position(|o| o.path == path);
        let mut looks = BTreeMap::new();
        for spec in &scene.sensors {
            let (Some(eye), Some(own)) = (ProximitySensor::of(spec, scene), object_of(&spec.path)) else { continue };
            looks.insert(
                Handle(own as i32 + 1),
                Look { eye, is_explicit: false, is_of_scene: true, blind_below: 0.0, saw: None },
            );
        }
        Self { scenery: scene.scenery().clone(), looks, ..Self::default() }
    }

    /// Every piece, the scene's first.
    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.scenery.pieces.iter().chain(&self.made)
    }

    /// What an object that was made consists of, each with its place in the object.
    pub fn parts_of(&self, own: Handle) -> Vec<(Piece, Pose<f64>)> {
        let parts = self.made.iter().zip(&self.places).filter(|(piece, _)| handle_of(piece) == own);
        parts.map(|(piece, place)| (piece.clone(), *place)).collect()
    }

    /// Whether an object that was made can be seen.
    pub fn has_made(&self, own: Handle) -> bool {
        self.made.iter().any(|piece| handle_of(piece) == own)
    }

    /// An object that was made is gone.
    pub fn forget(&mut self, own: Handle) {
        self.forget_parts(own);
        self.looks.remove(&own);
        for collection in self.collections.values_mut() {
            collection.forget(own);
        }
    }

    /// Takes away what an object that was made consists of.
    pub fn forget_parts(&mut self, own: Handle) {
        let stays: Vec<bool> = self.made.iter().map(|piece| handle_of(piece) != own).collect();
        let mut stay = stays.iter();
        self.made.retain(|_| *stay.next().expect("one for each"));
        let mut stay = stays.iter();
        self.places.retain(|_| *stay.next().expect("one for each"));
    }

    /// Colours the part that was added last.
    pub fn paint_last(&mut self, color: [u8; 3]) {
        if let Some(last) = self.made.last_mut() {
            last.color = color;
        }
    }

    /// Adds a part to an object that was made.
    pub fn add(&mut self, own: Handle, frame: &Attached<f64>, geometry: Arc<Geometry>, place: Pose<f64>) {
        let at = Attached { pose: frame.pose.compose(&place), ..*frame };
        self.made.push(Piece { object: own.0 as usize - 1, at, geometry, color: PLAIN });
        self.places.push(place);
    }

    /// The object has moved to another frame.
    pub fn moved(&mut self, own: Handle, frame: &Attached<f64>) {
        for (piece, place) in self.made.iter_mut().zip(&self.places).filter(|(piece, _)| handle_of(piece) == own) {
            piece.at = Attached { pose: frame.pose.compose(place), ..*frame };
        }
    }

    /// Colours everything of an object.
    pub fn paint(&mut self, own: Handle, color: [u8; 3]) {
        for piece in self.scenery.pieces.iter_mut().chain(&mut self.made).filter(|piece| handle_of(piece) == own) {
            piece.color = color;
        }
    }

    /// A surface ready to be looked at; refused if it has no extent, or if there would be too many corners.
    pub fn prepare(&self, surface: Surface) -> Result<Arc<Geometry>, Refusal> {
        let there: usize = self.made.iter().map(|piece| corners(piece.geometry.surface())).sum();
        if there + corners(&surface) > MOST_CORNERS {
            return Err(Refusal(format!("what is made at run time may have {MOST_CORNERS} corners together")));
        }
        let geometry = Geometry::new(surface)
            .ok_or_else(|| Refusal::new("the surface has no extent, or its triangles are none"))?;
        Ok(Arc::new(geometry))
    }
}

/// The object of a piece.
pub(super) fn handle_of(piece: &Piece) -> Handle {
    Handle(piece.object as i32 + 1)
}

fn corners(surface: &Surface) -> usize {
    match surface {
        Surface::Hull(points) | Surface::Mesh(points, _) => points.len(),
        Surface::HeightField { heights, .. } => heights.len(),
        _ => 8,
    }
}

impl Table {
    /// Pieces of what clients and scripts have made.
    pub(crate) fn made_pieces(&self) -> &[Piece] {
        &self.senses.made
    }

    /// No proximity sensor has looked yet.
    pub(super) fn reset_looks(&mut self) {
        self.senses.looks.values_mut().for_each(|look| look.saw = None);
    }

    /// A run has ended: nobody has looked, shapes and sensors that were made in it, beyond the first `n_before` objects, are gone with it, as in V-REP, and
    /// the others are where their objects are.
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
            self.entries().filter(|e| e.is_made).map(|e| (e.handle, e.frame)).collect();
        for (handle, frame) in made {
            self.senses.moved(handle, &frame);
        }
    }

    /// Another object gets what one that was made has to be seen by, or to see with.
    pub(super) fn copy_senses(&mut self, from: Handle, to: Handle) {
        let Ok(frame) = self.entry(to).map(|e| e.frame) else { return };
        for (piece, place) in self.senses.parts_of(from) {
            self.senses.add(to, &frame, piece.geometry, place);
            self.senses.paint_last(piece.color);
        }
        if let Some(look) = self.senses.looks.get(&from).cloned() {
            self.senses.looks.insert(to, Look { saw: None, ..look });
        }
    }

    /// What a proximity sensor has seen.
    pub(crate) fn tell(&mut self, sensor: Handle, saw: Option<Detection>) {
        if let Some(look) = self.senses.looks.get_mut(&sensor) {
            look.saw = Some(saw);
        }
    }
}

//! Objects that clients and scripts make while a run is on, as pictures show them: what appeared, moved, changed or
//! went, and when.

use std::collections::BTreeMap;

use serde::Serialize;
use sincro_dynamics::geometry::FieldOfView;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::spatial::Pose;

use super::scene::{ShapeView, hex, seven, shape_view};
use super::volume::{self, Edge};
use crate::runtime_object::{Drawing, DrawingStyle, RuntimeObject, RuntimePart};

/// Numbers that the log of a run may take, about 32 MB.
const MAX_NUMBERS: usize = 4_000_000;

/// Object made at run time as it is drawn; a change of anything but pose and items gives a new view.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RuntimeView {
    /// Path of the object.
    pub path: String,
    /// Kind in English, such as `dummy`, `shape`, `proximity sensor`, `drawing`.
    pub kind: &'static str,
    /// Index of the mover that carries it; `None` if it is fixed in the world.
    pub mover: Option<usize>,
    /// Pose of its frame in that of its mover, or in the world: position x, y, z `[m]`, quaternion x, y, z, w.
    pub pose: [f64; 7],
    /// Visible shapes.
    pub shapes: Vec<ShapeView>,
    /// Edges of the volume of a proximity sensor, in its frame `[m]`; empty for all else.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub volume: Vec<Edge>,
    /// Look of a drawing; `None` for all else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawing: Option<DrawingView>,
}

/// Look of a drawing, as the page takes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawingView {
    /// Figure of an item: `points`, `balls`, `lines`, `line_strip`, `triangles` or `particles`.
    pub kind: &'static str,
    /// Number of entries of an item.
    pub width: usize,
    /// Diameter of a ball or particle `[m]`, of a point `[pixel]`, or width of a line `[pixel]`.
    pub size: f64,
    /// Colour as `#rrggbb`.
    pub color: String,
    /// Time for which a particle is seen `[s]`.
    pub lifetime: f64,
    /// True if particles fall with the gravity of the world.
    pub falls: bool,
}

/// Change of an object that was made at run time.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RuntimeChange {
    /// It is there from now on, or looks different; a drawing has no items yet.
    Put(Box<RuntimeView>),
    /// It is carried by this mover (`None`: the world), at this pose there, as in [`RuntimeView`].
    Move(Option<usize>, [f64; 7]),
    /// Items of a drawing, from this index on: they replace those that were there. Entries as in the units of
    /// [`DrawingKind`](crate::runtime_object::DrawingKind).
    Items(usize, Vec<f32>),
    /// All items of a drawing have gone.
    Clear(()),
    /// The object has gone.
    Gone(()),
}

impl RuntimeChange {
    /// Returns about how many numbers it takes, in memory and in a file.
    #[must_use]
    pub fn size(&self) -> usize {
        let of_shape = |shape: &ShapeView| 32 + 3 * (shape.vertices.len() + shape.triangles.len());
        match self {
            Self::Put(view) => 32 + view.shapes.iter().map(of_shape).sum::<usize>() + 6 * view.volume.len(),
            Self::Move(..) => 16,
            Self::Items(_, numbers) => 8 + numbers.len(),
            Self::Clear(()) | Self::Gone(()) => 8,
        }
    }
}

/// Entry of a [`RuntimeLog`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RuntimeEvent {
    /// Time from which it holds `[s]`.
    pub t: f64,
    /// Number of the object in the run.
    pub id: u64,
    /// Its change.
    #[serde(flatten)]
    pub change: RuntimeChange,
}

/// Log of the objects that controllers have made in a run: [`RuntimeLog::update`] compares them with what it knows.
#[derive(Clone, Debug, Default)]
pub struct RuntimeLog {
    /// Link of each mover.
    links: Vec<usize>,
    known: BTreeMap<u64, Known>,
    /// Everything that has happened, in the order of time.
    pub events: Vec<RuntimeEvent>,
    /// Numbers that the events take.
    n_numbers: usize,
    /// True if something was left out, because there was no room for it: such an object stays as it was until it goes.
    pub is_cut: bool,
}

impl PartialEq for RuntimeLog {
    fn eq(&self, other: &Self) -> bool {
        self.events == other.events
    }
}

/// Latest state of an object.
#[derive(Clone, Debug)]
struct Known {
    path: String,
    at: Attached<f64>,
    parts: Vec<RuntimePart>,
    field: Option<FieldOfView>,
    style: Option<DrawingStyle>,
    /// Version of its items.
    version: (u64, u64),
    /// Present in the update that goes on.
    is_there: bool,
    /// A change of it was left out: the later ones are, too.
    is_cut: bool,
}

impl RuntimeLog {
    /// Creates an empty log; `links` has the link of each mover, as [`Layout::links`](super::Layout::links).
    #[must_use]
    pub fn new(links: &[usize]) -> Self {
        Self { links: links.to_vec(), ..Self::default() }
    }

    /// Adds what has changed up to time `t` `[s]`. `visit_all` calls its argument with each object that is there, and
    /// with the index of the controller that has made it, as
    /// [`LockStep::visit_runtime_objects`](crate::run::LockStep::visit_runtime_objects) does. `poses` has the poses of
    /// the links in a run whose structure has changed, where links are no movers any more: objects then stand in the
    /// world.
    pub fn update(
        &mut self,
        t: f64,
        poses: Option<&[Pose<f64>]>,
        visit_all: impl FnOnce(&mut dyn FnMut(usize, &RuntimeObject<'_>)),
    ) {
        self.known.values_mut().for_each(|known| known.is_there = false);
        visit_all(&mut |controller, object| {
            let id = (controller as u64) << 32 | u64::from(object.id);
            match (poses, object.at.link) {
                (Some(poses), Some(link)) => {
                    let at = Attached { link: None, pose: poses[link].compose(&object.at.pose) };
                    self.visit(t, id, &RuntimeObject { at, ..object.clone() });
                }
                _ => self.visit(t, id, object),
            }
        });
        let gone: Vec<u64> = self.known.iter().filter(|(_, known)| !known.is_there).map(|(id, _)| *id).collect();
        for id in gone {
            self.events.push(RuntimeEvent { t, id, change: RuntimeChange::Gone(()) });
            self.known.remove(&id);
        }
    }

    fn visit(&mut self, t: f64, id: u64, object: &RuntimeObject<'_>) {
        let style = object.drawing.map(|drawing| drawing.style);
        let is_same = |known: &Known| {
            (known.path.as_str(), known.field, known.style) == (object.path, object.field, style)
                && known.parts == object.parts
        };
        match self.known.get_mut(&id).filter(|known| is_same(known)) {
            Some(known) => {
                known.is_there = true;
                if (known.at.link, known.at.pose) != (object.at.link, object.at.pose) {
                    known.at = object.at;
                    let (mover, pose) = (self.mover(&object.at), seven(&object.at.pose));
                    self.push(t, id, RuntimeChange::Move(mover, pose));
                }
            }
            None => {
                let known = Known {
                    path: object.path.to_owned(),
                    at: object.at,
                    parts: object.parts.clone(),
                    field: object.field,
                    style,
                    version: (0, 0),
                    is_there: true,
                    is_cut: false,
                };
                let version = object.drawing.map_or((0, 0), |drawing| (drawing.version().0, 0));
                self.known.insert(id, Known { version, ..known });
                let view = self.view(object);
                self.push(t, id, RuntimeChange::Put(Box::new(view)));
            }
        }
        if let Some(drawing) = object.drawing {
            self.items(t, id, drawing);
        }
    }

    fn items(&mut self, t: f64, id: u64, drawing: &Drawing) {
        let (version, known) = (drawing.version(), self.known.get_mut(&id).expect("it was visited"));
        let (cleared, mut written) = known.version;
        known.version = version;
        if cleared != version.0 {
            written = 0;
            self.push(t, id, RuntimeChange::Clear(()));
        }
        for (from, numbers) in drawing.since(written) {
            self.push(t, id, RuntimeChange::Items(from, numbers.to_vec()));
        }
    }

    fn push(&mut self, t: f64, id: u64, change: RuntimeChange) {
        let is_cut = &mut self.known.get_mut(&id).expect("it was visited").is_cut;
        *is_cut |= self.n_numbers + change.size() > MAX_NUMBERS;
        self.is_cut |= *is_cut;
        if !*is_cut {
            self.n_numbers += change.size();
            self.events.push(RuntimeEvent { t, id, change });
        }
    }

    fn mover(&self, at: &Attached<f64>) -> Option<usize> {
        at.link.and_then(|link| self.links.iter().position(|l| *l == link))
    }

    fn view(&self, object: &RuntimeObject<'_>) -> RuntimeView {
        let shape = |part: &RuntimePart| shape_view(part.geometry.surface(), &part.place, Some(part.color));
        let drawing = object.drawing.map(|drawing| drawing.style).map(|style| DrawingView {
            kind: style.kind.word(),
            width: style.kind.width(),
            size: style.size,
            color: hex(style.color),
            lifetime: style.lifetime,
            falls: style.falls,
        });
        RuntimeView {
            path: object.path.to_owned(),
            kind: object.kind,
            mover: self.mover(&object.at),
            pose: seven(&object.at.pose),
            shapes: object.parts.iter().map(shape).collect(),
            volume: object.field.map(|f| volume::edges(f.volume(), f.offset(), f.range())).unwrap_or_default(),
            drawing,
        }
    }
}

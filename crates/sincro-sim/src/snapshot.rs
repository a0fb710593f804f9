//! Snapshots: everything a run needs to continue bit for bit, as bytes.
//!
//! Little endian, in this order: magic and version, hash of the model it belongs to, tick, trace hash, the integration
//! method and its error control, the seven vectors of [`State`] with their lengths, that of the sensors, the
//! parameters of the model (none if they are those of the scene), the three of the diagram's state and the bytes that
//! blocks keep elsewhere (if there is a diagram), the structure if it is not that of the start (text of its scene,
//! numbers of its objects, coordinates after its last change), and a checksum of all that.

use std::fmt;
use std::hash::Hasher;
use std::sync::Arc;

use sincro_dynamics::integrate::Control;
use sincro_dynamics::model::ModelParams;
use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;
use sincro_scene::draft;
use sincro_scene::script::Script;
use twox_hash::XxHash3_64;

use crate::load::Loaded;
use crate::structure::Structure;
use crate::trace::{Trace, plant_hash};

const MAGIC: &[u8; 8] = b"sincro09";

/// Snapshot of a run: everything needed to go on from there bit for bit. Made by
/// [`LockStep::snapshot`](crate::run::LockStep::snapshot).
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
/// run.start()?;
/// run.advance()?;
/// let bytes = run.snapshot(run.trace()).to_bytes(&loaded);
/// // another process goes on from there
/// let mut other = LockStep::new(&loaded, method_for(&loaded).0, false);
/// other.start()?;
/// other.restore(&Snapshot::from_bytes(&bytes, &loaded)?);
/// run.advance()?;
/// other.advance()?;
/// assert_eq!(other.state(), run.state()); // the same bits
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// State of the world.
    pub state: State<f64>,
    /// Parameters of the model, if clients or scripts have changed them; `None` for those of the scene.
    pub params: Option<Box<ModelParams<f64>>>,
    /// Hash of all states up to here.
    pub trace: Trace,
    /// Integration method: `auto` may have changed it.
    pub method: MethodKind,
    /// State of the integrator's error control; `None` for fixed steps.
    pub control: Option<Control>,
    /// Last values of all sensors, in their order and units.
    pub sensors: Vec<f64>,
    /// State of the diagram: signals, continuous states, memory; `None` without a diagram.
    pub diagram: Option<sincro_blocks::runner::State<f64>>,
    /// Structure, if it is not that of the start; `None` for that of the scene.
    pub structure: Option<Structure>,
}

/// Error of reading a snapshot by [`Snapshot::from_bytes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SnapshotError {
    /// The bytes are no snapshot, or one of another version of the format.
    NotASnapshot,
    /// The bytes are cut short or altered.
    Damaged,
    /// The snapshot is of another model.
    OtherModel,
}

impl fmt::Display for SnapshotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotASnapshot => "these bytes are not a snapshot of this version of sincro",
            Self::Damaged => "the snapshot is cut short or was altered",
            Self::OtherModel => {
                "the snapshot belongs to another model: load the scene with the settings it was run with"
            }
        })
    }
}

impl std::error::Error for SnapshotError {}

impl Snapshot {
    /// Returns the snapshot as bytes for a file, with the hash of the scene `loaded` that it belongs to.
    #[must_use]
    pub fn to_bytes(&self, loaded: &Loaded) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(plant_hash(loaded).as_bytes());
        bytes.extend(self.state.tick.to_le_bytes());
        bytes.extend(self.trace.0.to_le_bytes());
        bytes.extend(code(self.method).to_le_bytes());
        let control = self.control.unwrap_or(Control { accuracy: f64::NAN, h: 0.0, last_error: 0.0 });
        for x in [control.accuracy, control.h, control.last_error] {
            bytes.extend(x.to_le_bytes());
        }
        let params = self.params.as_ref().map_or_else(Vec::new, |params| params.to_numbers());
        let s = &self.state;
        let of_diagram = self.diagram.iter().flat_map(|d| [&d.signals, &d.continuous, &d.memory]);
        for vector in [&s.q, &s.v, &s.commands, &s.drives, &s.contacts, &s.totals, &s.rotors, &self.sensors, &params]
            .into_iter()
            .chain(of_diagram)
        {
            bytes.extend((vector.len() as u64).to_le_bytes());
            vector.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        if let Some(diagram) = &self.diagram {
            bytes.extend((diagram.outside.len() as u64).to_le_bytes());
            for (step, outside) in &diagram.outside {
                bytes.extend((*step as u64).to_le_bytes());
                bytes.extend((outside.len() as u64).to_le_bytes());
                bytes.extend(outside);
            }
        }
        write_structure(self.structure.as_ref(), &mut bytes);
        let sum = checksum(&bytes);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    /// Reads a snapshot of the scene `loaded` from the bytes of [`Snapshot::to_bytes`].
    ///
    /// # Errors
    ///
    /// [`SnapshotError::NotASnapshot`], [`SnapshotError::Damaged`], or [`SnapshotError::OtherModel`] if it belongs to
    /// another scene or other settings.
    pub fn from_bytes(bytes: &[u8], loaded: &Loaded) -> Result<Self, SnapshotError> {
        let (body, sum) = bytes.split_last_chunk::<8>().ok_or(SnapshotError::NotASnapshot)?;
        let mut reader = Reader(body);
        if reader.take(8)? != MAGIC {
            return Err(SnapshotError::NotASnapshot);
        }
        if checksum(body) != u64::from_le_bytes(*sum) {
            return Err(SnapshotError::Damaged);
        }
        if reader.take(16)? != plant_hash(loaded).as_bytes() {
            return Err(SnapshotError::OtherModel);
        }
        let tick = reader.integer()?;
        let trace = Trace(reader.integer()?);
        let method = MethodKind::ALL.into_iter().nth(reader.integer()? as usize).ok_or(SnapshotError::Damaged)?;
        let [accuracy, h, last_error] = [reader.number()?, reader.number()?, reader.number()?];
        let control = (!accuracy.is_nan()).then_some(Control { accuracy, h, last_error });
        let state = State {
            q: reader.vector()?,
            v: reader.vector()?,
            commands: reader.vector()?,
            drives: reader.vector()?,
            contacts: reader.vector()?,
            totals: reader.vector()?,
            rotors: reader.vector()?,
            tick,
        };
        let sensors = reader.vector()?;
        let numbers = reader.vector()?;
        let diagram = match loaded.controller {
            None => None,
            Some(_) => Some(sincro_blocks::runner::State {
                signals: reader.vector()?,
                continuous: reader.vector()?,
                memory: reader.vector()?,
                outside: reader.byte_strings()?,
            }),
        };
        let structure = read_structure(&mut reader, loaded)?;
        let model = structure.as_ref().map_or(&loaded.scene.model, |structure| &structure.scene.model);
        let params = match numbers.is_empty() {
            true => None,
            false => Some(Box::new(model.params_from_numbers(&numbers).ok_or(SnapshotError::Damaged)?)),
        };
        Ok(Self { state, params, trace, method, control, sensors, diagram, structure })
    }
}

/// Place of a method among all.
fn code(method: MethodKind) -> u64 {
    MethodKind::ALL.into_iter().position(|known| known == method).expect("every method has a code") as u64
}

/// Writes the structure: number of its changes (0: that of the start), its hash and energy, the texts of the scene, the
/// numbers of the objects and the coordinates after the last change.
fn write_structure(structure: Option<&Structure>, bytes: &mut Vec<u8>) {
    bytes.extend(structure.map_or(0, |structure| structure.count).to_le_bytes());
    let Some(structure) = structure else { return };
    bytes.extend(structure.hash.to_le_bytes());
    bytes.extend(structure.energy_added.to_le_bytes());
    let text = structure.scene.source.as_ref().map_or("", |source| source.document.source.text.as_str());
    let parked = structure.scene.source.as_ref().map_or_else(String::new, |source| draft::parked_text(source));
    for text in [text, &parked] {
        bytes.extend((text.len() as u64).to_le_bytes());
        bytes.extend(text.as_bytes());
    }
    bytes.extend((structure.scene.objects.len() as u64).to_le_bytes());
    structure.scene.objects.iter().for_each(|object| bytes.extend((object.id as u64).to_le_bytes()));
    bytes.extend((structure.scene.initial.q.len() as u64).to_le_bytes());
    structure.scene.initial.q.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
}

fn read_structure(reader: &mut Reader<'_>, loaded: &Loaded) -> Result<Option<Structure>, SnapshotError> {
    let damaged = SnapshotError::Damaged;
    let count = reader.integer()?;
    if count == 0 {
        return Ok(None);
    }
    let (hash, energy_added) = (reader.integer()?, reader.number()?);
    let mut text = || {
        let n = usize::try_from(reader.integer()?).map_err(|_| damaged)?;
        std::str::from_utf8(reader.take(n)?).map_err(|_| damaged)
    };
    let (text, parked) = (text()?, text()?);
    let n = usize::try_from(reader.integer()?).map_err(|_| damaged)?;
    let ids = (0..n).map(|_| reader.integer().map(|id| id as usize)).collect::<Result<Vec<_>, _>>()?;
    let q = reader.vector()?;
    let source = loaded.scene.source.as_ref().ok_or(SnapshotError::OtherModel)?;
    let mut scene = draft::compile_text(text, source, &ids, parked).map_err(|_| SnapshotError::OtherModel)?;
    let present = |script: &Script| {
        let object = scene.objects.iter().find(|object| object.id == script.object)?;
        Some(Script { path: object.path.clone(), ..script.clone() })
    };
    scene.scripts = loaded.scene.scripts.iter().filter_map(present).collect();
    if scene.initial.q.len() != q.len() {
        return Err(damaged);
    }
    scene.initial.q = q;
    Ok(Some(Structure { scene: Arc::new(scene), hash, energy_added, count }))
}

fn checksum(bytes: &[u8]) -> u64 {
    let mut hasher = XxHash3_64::with_seed(1);
    hasher.write(bytes);
    hasher.finish()
}

struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Result<&'a [u8], SnapshotError> {
        let (head, tail) = self.0.split_at_checked(n).ok_or(SnapshotError::Damaged)?;
        self.0 = tail;
        Ok(head)
    }

    fn integer(&mut self) -> Result<u64, SnapshotError> {
        let bytes = self.take(8)?.try_into().map_err(|_| SnapshotError::Damaged)?;
        Ok(u64::from_le_bytes(bytes))
    }

    fn number(&mut self) -> Result<f64, SnapshotError> {
        self.integer().map(f64::from_bits)
    }

    fn vector(&mut self) -> Result<Vec<f64>, SnapshotError> {
        let n = usize::try_from(self.integer()?).map_err(|_| SnapshotError::Damaged)?;
        if n > self.0.len() / 8 {
            return Err(SnapshotError::Damaged);
        }
        (0..n).map(|_| self.number()).collect()
    }

    /// Indices, each with bytes.
    fn byte_strings(&mut self) -> Result<Vec<(usize, Vec<u8>)>, SnapshotError> {
        let size = |n: u64| usize::try_from(n).map_err(|_| SnapshotError::Damaged);
        let n = size(self.integer()?)?;
        if n > self.0.len() / 16 {
            return Err(SnapshotError::Damaged);
        }
        (0..n)
            .map(|_| {
                let (index, len) = (size(self.integer()?)?, size(self.integer()?)?);
                Ok((index, self.take(len)?.to_vec()))
            })
            .collect()
    }
}

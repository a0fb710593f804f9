//! The object registry, as clients and scripts know them: handles, names, what they hold. Plain data; what needs the
//! world is in [`super::SimApi`].

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::Map;

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Mat3, Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::World;

use super::added_scripts::AddedScript;
use super::drawings::Drawings;
use super::flags::Flags;
use super::graphs::Graphs;
use super::joint_modes::StaticMode;
use super::motions::JointMotion;
use super::pairs::{self, Pair};
use super::scene_objects::handle_of_id;
use super::senses::Senses;
use super::structure::{Belt, Link, Material, Needed, Role};
use super::vision::Vision;
use super::{ApiError, Phase};
use sincro_scene::scene::{Object, Scene};
use sincro_scene::script::{Kind as ScriptKind, Script, ScriptParser};
use sincro_sim::controller::{Change, Commands};
use sincro_sim::load::Loaded;
use sincro_sim::notes::Notes;
use sincro_sim::restructure::Restructured;
pub use sincro_values::Handle;
use sincro_values::clouds::{Points, Voxels};
use sincro_values::radio::Radio;
use sincro_values::stored::Stored;
use sincro_values::tubes::Tubes;
use sincro_values::widgets::Widgets;
use sincro_values::{LegacyPorts, PortRequest, Signals};
use sincro_vision::textures::Textures;

/// Bytes that clients and scripts may store: string signals, data with objects, named parameters.
const MAX_BYTES: usize = 256 << 20;
/// Lines of the log that are kept until somebody takes them.
const MAX_LINES: usize = 1_000;
/// Files of models that may wait to be written.
const MAX_SAVES: usize = 16;
/// Pictures and files of scripts that are kept with a run, and bytes of all of them.
const MAX_IMAGES: (usize, usize) = (1_000, 64 << 20);

/// Type of an object of the registry, with what its functions need to know of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A joint, with its index among the joints with one coordinate; none if it has no or several coordinates.
    Joint(Option<usize>),
    /// A body: mass `[kg]`, centre of mass `[m]` and inertia `[kg·m²]` in the body's axes.
    Body(MassProperties),
    /// A named frame of the scene.
    Frame,
    /// A sensor of the scene that is no proximity sensor, or a camera whose pictures are not read.
    Sensor,
    /// An external force or a drag of the scene.
    Force,
    /// A rotor, with its index among the model's: to clients and scripts a joint that turns at its commanded speed.
    Rotor(usize),
    /// A force sensor: a fixed joint of six held degrees of freedom, with the index of the first among the model's;
    /// none if it was made at run time and carries nothing yet.
    ForceSensor(Option<usize>),
    /// A vision sensor: a camera whose pictures are read, with its index among the registry's.
    Vision(usize),
    /// A dummy: a named frame made by a client or script.
    Dummy,
    /// A shape made by a client or script: seen and measured, without mass and contact.
    Shape,
    /// A proximity sensor, of the scene or made by a client or script.
    Proximity,
}

/// Object of the scene or runtime object, as clients and scripts find it in the [`ObjectRegistry`].
#[derive(Clone, Debug)]
pub struct Entry {
    /// Handle, by which all functions name the object.
    pub handle: Handle,
    /// Name: the last part of the path.
    pub name: String,
    /// Path in the scene; of a runtime object, that of its parent, `/` and its name.
    pub path: String,
    /// Type of the object.
    pub kind: Kind,
    /// True if a client or script has made it.
    pub is_runtime: bool,
    /// Handle of the parent object; none: the world.
    pub parent: Option<Handle>,
    /// Frame of the object, fixed to a link, position in `[m]`; of a joint, the one on its parent's side, z along its
    /// axis.
    pub frame: Attached<f64>,
    /// Frame in which children stand: of a joint, the one that moves; else the same as `frame`.
    pub moving: Attached<f64>,
}

/// Joint with one coordinate: where it stands in the state, its motor, and the setpoints of clients and scripts.
#[derive(Clone, Debug)]
pub struct JointEntry {
    /// Handle of the joint's object.
    pub handle: Handle,
    /// Joint type, with its axis in the joint's frame.
    pub kind: JointKind,
    /// Index of its position in the generalized coordinates q.
    pub q_idx: usize,
    /// Index of its velocity in the generalized velocities v.
    pub v_idx: usize,
    /// Index of its motor among the model's; none without motor.
    pub motor: Option<usize>,
    /// Parameters of the motor as they are now, in SI units; none without motor.
    pub drive: Option<Motor<f64>>,
    /// Mode of the motor in the scene file; none without motor.
    pub scene_mode: Option<MotorMode>,
    /// Velocity setpoint of a client or script `[rad/s]` or `[m/s]`; none if nobody has set one.
    pub target_velocity: Option<f64>,
    /// Position setpoint of a client or script `[rad]` or `[m]`; none if nobody has set one.
    pub target_position: Option<f64>,
    /// Effort setpoint of a client or script in torque mode `[N·m]` or `[N]`; none if nobody has set one.
    pub target_force: Option<f64>,
}

/// Message for the operator of the simulator, as [`ObjectRegistry::take_log`] gives it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogLine {
    /// Verbosity level as in V-REP: 200 error, 300 warning, 450 message of a script, 500 information.
    pub level: i64,
    /// Text of the message, one line or several, 10,000 bytes at most.
    pub text: String,
}

/// Request that is carried out between two steps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// Start, or resume after a pause.
    Start,
    /// Pause.
    Pause,
    /// Stop.
    Stop,
    /// Load another scene.
    Load(String),
    /// Close the scene.
    Close,
    /// Write a model into the folder for files of clients: name and text.
    Save(String, String),
    /// Write a picture into the folder for files of clients: name and bytes.
    SaveImage(String, Vec<u8>),
}

/// Objects of a scene and runtime objects by handle, with signals, setpoints and everything else that clients and
/// scripts store. Plain data, cloned with a run; [`SimApi`](super::SimApi) joins it with the world.
#[derive(Clone, Debug)]
pub struct ObjectRegistry {
    /// Handle 1 is the first; a hole where an object was removed.
    pub(super) entries: Vec<Option<Entry>>,
    pub(super) n_created: usize,
    /// Number of objects of each name.
    pub(super) names: BTreeMap<String, usize>,
    /// First number that may be free behind a name that is taken.
    pub(super) numbers: BTreeMap<String, usize>,
    pub(super) joints: Vec<JointEntry>,
    /// Joint of each handle, where there is one.
    pub(super) joint_of: BTreeMap<Handle, usize>,
    /// Commands held from outside: they win over the scene's signals and the diagram.
    pub(super) held: Vec<Option<f64>>,
    pub(super) commands: Vec<Signal>,
    /// Commands of scene and diagram for the step that begins, while scripts act; empty at other times.
    pub(super) upcoming: Vec<f64>,
    /// Base step `[s]`.
    pub(super) step: f64,
    sample_ticks: u64,
    pub(super) impulse: Vec<f64>,
    has_stepped: bool,
    /// True once the state that the run starts with is recorded: what changes it from then on counts as work.
    pub(crate) has_begun: bool,
    /// Whole-number signals of scripts and clients, by name.
    pub integers: Signals<i64>,
    /// Real signals, by name.
    pub floats: Signals<f64>,
    /// String signals (texts or bytes), by name.
    pub strings: Signals<Vec<u8>>,
    /// Parameters of scripts as text, by the object that carries the script and the name.
    pub script_parameters: BTreeMap<(Handle, String), String>,
    /// Data that clients and scripts stored with objects.
    pub(crate) data: BTreeMap<(Handle, String), Stored>,
    /// Parameters by name.
    pub(crate) named: BTreeMap<String, Vec<u8>>,
    log: VecDeque<LogLine>,
    notes: Notes,
    requests: Vec<Request>,
    /// State of the simulation: stopped, running or paused.
    pub phase: Phase,
    /// Path of the scene file.
    pub scene_path: String,
    /// Number of requests to stop the run, counted since the registry was made.
    pub stop_requests: i64,
    /// Vision sensors.
    pub(super) vision: Vision,
    /// Environments of inverse kinematics.
    pub(super) environments: Vec<Option<super::ik::Environment>>,
    /// Tasks of path planning.
    pub(super) planning: sincro_planning::Tasks,
    /// Collision and distance objects.
    pub(super) calculations: sincro_planning::Calculations,
    pub(super) zero: Vec<f64>,
    /// Differences from the scene.
    pub(super) changes: Vec<Change>,
    /// True while the world's external forces are those of the step that has ended: sensors show what they do, and the
    /// next step begins without them.
    pub(crate) are_forces_spent: bool,
    /// True if the model was changed while stopped, and the next run must be made of it.
    pub(crate) is_model_changed: bool,
    /// Pairs of surfaces, in the model's order.
    pub(super) pairs: Vec<Pair>,
    /// Bodies that pass through all others.
    pub(super) passing: BTreeSet<Handle>,
    /// Mass properties of the solids of bodies at density 1, where all of a body is solids of closed form.
    pub(super) solids: BTreeMap<Handle, MassProperties>,
    /// Streams of graphs.
    pub(crate) graphs: Graphs,
    /// Motions of numbers.
    pub(super) motions: sincro_planning::Motions,
    /// Targets of motors that are on their way.
    pub(super) joint_motions: BTreeMap<Handle, JointMotion>,
    /// Visible pieces and the sensors that detect them.
    pub(super) senses: Senses,
    /// Drawings and particles.
    pub(super) drawings: Drawings,
    /// Frames of the scene that clients or scripts have moved.
    pub(super) moved_frames: BTreeSet<Handle>,
    /// Textures, and the shapes that have them.
    pub(super) textures: Textures,
    /// Tubes between scripts and clients.
    pub(super) tubes: Tubes,
    /// Interfaces, with the values of their widgets.
    pub(super) widgets: Widgets,
    /// Frames of the scene that recorded signals are about.
    pub(super) recorded_frames: BTreeSet<Handle>,
    /// Free joints, and frames that were free joints: clients do not see them as parents.
    pub(super) left_out: BTreeSet<Handle>,
    /// First body on each of these.
    pub(super) body_on: BTreeMap<Handle, Handle>,
    /// Flags of objects that were set.
    pub(super) flags: Flags,
    /// TCP ports of the legacy remote API; none if no clients are served.
    pub legacy_ports: Option<LegacyPorts>,
    /// Ports of the legacy API that scripts want to be open.
    port_requests: Vec<PortRequest>,
    /// Scene that the world is of now.
    pub(super) scene: Arc<Scene>,
    /// Objects of the scene that clients and scripts have added to it.
    pub(super) added: BTreeSet<Handle>,
    /// Joints that were made and move nothing yet, with their keys in a scene file: they are no part of the model.
    pub(super) parked: BTreeMap<Handle, Map<String, serde_json::Value>>,
    /// Shapes that become bodies of the model at the next compilation, in the order in which they were told to.
    pub(super) roles: Vec<(Handle, Role)>,
    /// Voxels of shapes that are octrees.
    pub(super) octrees: BTreeMap<Handle, Voxels>,
    /// Points of shapes that are point clouds.
    pub(super) clouds: BTreeMap<Handle, Points>,
    /// Friction and restitution of objects that touch nothing, for the time when they do.
    pub(super) materials: BTreeMap<Handle, Material>,
    /// Masses of shapes that are no bodies, for the time when they are `[kg]`.
    pub(super) masses: BTreeMap<Handle, f64>,
    /// Needs of the diagram.
    pub(super) needed: Arc<Needed>,
    /// Changes of the structure that the lock-step has not taken yet.
    pub(super) restructured: Option<Restructured>,
    /// True if the last of these only put objects elsewhere.
    pub(super) is_last_placement: bool,
    /// Pictures and texts that scripts have saved in this run, by the names of their files.
    pub(crate) images: BTreeMap<String, Vec<u8>>,
    /// Velocities that bodies begin with when their dynamics are reset, component by component.
    pub(super) initial_velocities: BTreeMap<Handle, [Option<f64>; 6]>,
    /// Tick at which the dynamics of a body were reset last in this run, with the velocity that was set for it by then.
    pub(super) resets: BTreeMap<Handle, (u64, [f64; 6])>,
    /// Folder for files of clients, from which models may be loaded; none if they may send none.
    pub(crate) sent_folder: Option<PathBuf>,
    /// Random numbers that clients and scripts were given in this run.
    pub(super) n_random: u64,
    /// Searches for configurations of V-REP's groups in this run.
    pub(super) n_searches: u64,
    /// Objects that clients and scripts have selected, in their order.
    pub(super) selection: Vec<Handle>,
    /// Wireless data on their way.
    pub(super) radio: Radio,
    /// True once somebody was told in this run that the step of clients and scripts stays as it is.
    pub(super) is_told_of_step: bool,
    /// Scripts that were added, in their order.
    pub(super) added_scripts: Vec<AddedScript>,
    /// Scripts that are to begin anew, by their objects and kinds.
    pub(super) script_restarts: BTreeSet<(Handle, ScriptKind)>,
    /// Respondable masks of bodies and shapes that were set.
    pub(super) respondable_masks: BTreeMap<Handle, i64>,
    /// Numbers of what shapes look like in windows, by object and parameter.
    pub(super) looks: BTreeMap<(Handle, i64), f64>,
    /// Colours that were set of components that no picture shows, by object and component.
    pub(super) component_colors: BTreeMap<(Handle, i64), [f64; 3]>,
    /// Links of dummies.
    pub(super) dummy_links: BTreeMap<Handle, Link>,
    /// Static bodies that carry others along.
    pub(super) belts: BTreeMap<Handle, Belt>,
    /// Bodies that a client or script has made static, whatever they hang on.
    pub(super) statics: BTreeSet<Handle>,
    /// Objects to be removed with the next change of the structure, each with true if all below it goes, too.
    pub(super) doomed: Vec<(Handle, bool)>,
    /// Joints whose mode is not dynamic.
    pub(super) joint_modes: BTreeMap<Handle, StaticMode>,
    /// Parts of the step that are switched off, by the numbers of their truth values.
    pub(super) switched_off: BTreeSet<i64>,
    /// Force sensors that were broken in this run.
    pub(super) broken: BTreeSet<Handle>,
    /// True if clients may give scripts texts.
    pub(crate) takes_script_texts: bool,
    /// Parser of the scripts of models that are loaded; none if no scripts can be run.
    pub(super) script_parser: Option<&'static dyn ScriptParser>,
}

impl ObjectRegistry {
    /// Creates the registry of a loaded scene, stopped. A step of clients and scripts lasts `sample_ticks` base steps;
    /// 0 counts as 1.
    #[must_use]
    pub fn new(loaded: &Loaded, sample_ticks: u64) -> Self {
        let scene = &loaded.scene;
        let mut new = Self {
            entries: Vec::with_capacity(scene.objects.len()),
            n_created: 0,
            names: BTreeMap::new(),
            numbers: BTreeMap::new(),
            joints: Vec::new(),
            joint_of: BTreeMap::new(),
            held: vec![None; scene.model.n_commands()],
            commands: scene.commands.clone(),
            upcoming: Vec::new(),
            step: loaded.experiment.step,
            sample_ticks: sample_ticks.max(1),
            impulse: vec![0.0; scene.model.motors().len()],
            has_stepped: false,
            has_begun: false,
            integers: Signals::default(),
            floats: Signals::default(),
            strings: Signals::default(),
            script_parameters: BTreeMap::new(),
            data: BTreeMap::new(),
            named: BTreeMap::new(),
            log: VecDeque::new(),
            notes: Notes::default(),
            requests: Vec::new(),
            phase: Phase::Stopped,
            scene_path: loaded.experiment.scene_path.display().to_string(),
            stop_requests: 0,
            vision: Vision::default(),
            environments: Vec::new(),
            planning: sincro_planning::Tasks::default(),
            calculations: sincro_planning::Calculations::default(),
            zero: vec![0.0; scene.model.n_v()],
            changes: Vec::new(),
            are_forces_spent: false,
            is_model_changed: false,
            pairs: Vec::new(),
            passing: BTreeSet::new(),
            solids: BTreeMap::new(),
            graphs: Graphs::default(),
            motions: sincro_planning::Motions::default(),
            joint_motions: BTreeMap::new(),
            senses: Senses::new(scene),
            drawings: Drawings::default(),
            moved_frames: BTreeSet::new(),
            tubes: Tubes::default(),
            widgets: Widgets::default(),
            recorded_frames: BTreeSet::new(),
            n_random: 0,
            n_searches: 0,
            selection: Vec::new(),
            radio: Radio::default(),
            is_told_of_step: false,
            left_out: BTreeSet::new(),
            body_on: BTreeMap::new(),
            flags: Flags::default(),
            legacy_ports: None,
            port_requests: Vec::new(),
            scene: Arc::clone(scene),
            added: BTreeSet::new(),
            parked: BTreeMap::new(),
            roles: Vec::new(),
            materials: BTreeMap::new(),
            octrees: BTreeMap::new(),
            clouds: BTreeMap::new(),
            masses: BTreeMap::new(),
            needed: Arc::new(Needed::new(loaded)),
            restructured: None,
            is_last_placement: false,
            images: BTreeMap::new(),
            initial_velocities: BTreeMap::new(),
            resets: BTreeMap::new(),
            sent_folder: None,
            added_scripts: Vec::new(),
            takes_script_texts: false,
            script_restarts: BTreeSet::new(),
            respondable_masks: BTreeMap::new(),
            looks: BTreeMap::new(),
            component_colors: BTreeMap::new(),
            textures: Textures::default(),
            dummy_links: BTreeMap::new(),
            belts: BTreeMap::new(),
            statics: BTreeSet::new(),
            doomed: Vec::new(),
            joint_modes: BTreeMap::new(),
            switched_off: BTreeSet::new(),
            broken: BTreeSet::new(),
            script_parser: loaded.extensions.scripts.map(|engine| engine as &dyn ScriptParser),
        };
        new.take_objects(scene, &scene.model);
        new.pairs = pairs::pairs_of(scene, &new);
        let is_recorded = |e: &&Entry| {
            let names = loaded.experiment.record.iter().map(|name| &*name.value);
            e.kind == Kind::Frame
                && names.clone().any(|name| name.strip_prefix(&*e.path).is_some_and(|s| s.starts_with('.')))
        };
        new.recorded_frames = new.entries().filter(is_recorded).map(|e| e.handle).collect();
        scene.scripts.iter().for_each(|script| new.take_parameters(script, None));
        new
    }

    /// Takes the parameters of a script: those that the script on `original` has now, for none those of the scene file.
    pub(super) fn take_parameters(&mut self, script: &Script, original: Option<Handle>) {
        let object = handle_of_id(script.object);
        let texts: Vec<_> = match original {
            Some(original) => {
                let own = self.script_parameters.iter().filter(|((object, _), _)| *object == original);
                own.map(|((_, name), text)| ((object, name.clone()), text.clone())).collect()
            }
            None => script.parameters.iter().map(|(name, value)| ((object, name.clone()), value.to_string())).collect(),
        };
        self.script_parameters.extend(texts);
    }

    pub(super) fn next_handle(&self) -> Handle {
        Handle(self.entries.len() as i32 + 1)
    }

    /// All objects, parents before children, siblings in the order of the file; runtime objects come last, in the order
    /// of their creation.
    pub fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().flatten()
    }

    /// Returns the object of a handle.
    ///
    /// # Errors
    ///
    /// The number is no handle of an object, or the object was removed.
    pub fn entry(&self, handle: Handle) -> Result<&Entry, ApiError> {
        let found = usize::try_from(handle.0 - 1).ok().and_then(|k| self.entries.get(k)?.as_ref());
        found.ok_or_else(|| ApiError(format!("there is no object with the handle {}", handle.0)))
    }

    /// The entry of a handle that was found.
    pub(super) fn entry_mut(&mut self, handle: Handle) -> &mut Entry {
        self.entries[handle.0 as usize - 1].as_mut().expect("it was found")
    }

    /// Direct children of an object, or of the world for none, in the order of [`ObjectRegistry::entries`]; empty if
    /// there are none, or no such parent.
    pub fn children(&self, parent: Option<Handle>) -> impl Iterator<Item = &Entry> {
        self.entries().filter(move |e| e.parent == parent)
    }

    /// Handles of an object and of all objects below it; the object itself comes first, whether it exists or not.
    #[must_use]
    pub fn tree(&self, base: Handle) -> Vec<Handle> {
        let mut found = vec![base];
        // parents have smaller handles than their children, unless a dummy was hung elsewhere: go on until nothing is
        // added
        loop {
            let n = found.len();
            let more = self.entries().filter(|e| e.parent.is_some_and(|p| found.contains(&p)));
            let more: Vec<Handle> = more.map(|e| e.handle).filter(|h| !found.contains(h)).collect();
            found.extend(more);
            if found.len() == n {
                return found;
            }
        }
    }

    /// Returns true if an object can stand anywhere: a runtime object, a vision sensor, or a frame of the scene, with
    /// nothing below it that the model moves.
    #[must_use]
    pub(crate) fn is_loose(&self, handle: Handle) -> bool {
        let is_point = |entry: &Entry| {
            entry.is_runtime
                || matches!(entry.kind, Kind::Vision(_))
                || entry.kind == Kind::Frame && !self.carries_spring(entry)
        };
        self.tree(handle).into_iter().all(|h| self.entry(h).is_ok_and(is_point))
    }

    /// Returns true if a frame of the scene carries an end of a spring between points, of a tendon or of a bushing: the
    /// model changes with it.
    fn carries_spring(&self, entry: &Entry) -> bool {
        let model = &self.scene().model;
        if model.spring_dampers().is_empty() && model.bushings().is_empty() {
            return false;
        }
        let object = self.scene().objects.iter().find(|object| object.id as i32 + 1 == entry.handle.0);
        let (Some(object), Some(source)) = (object, &self.scene().source) else { return false };
        let names = [("spring_damper", "between"), ("bushing", "between"), ("tendon", "through")];
        names.iter().any(|(kind, key)| {
            let elements = source.document.get(&format!("/{kind}")).and_then(|list| list.as_array());
            let ends = elements.into_iter().flatten().filter_map(|element| element.get(key)?.as_array()).flatten();
            ends.filter_map(|end| end.as_str()).any(|end| end == object.path)
        })
    }

    /// All joints that have one coordinate.
    #[must_use]
    pub(crate) fn joints(&self) -> &[JointEntry] {
        &self.joints
    }

    /// Returns the joint of a handle, if it has exactly one coordinate.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or is no joint with one coordinate; the message names the object.
    pub fn joint(&self, handle: Handle) -> Result<&JointEntry, ApiError> {
        let entry = self.entry(handle)?;
        match entry.kind {
            Kind::Joint(Some(k)) => Ok(&self.joints[k]),
            Kind::Joint(None) => Err(ApiError(format!("joint `{}` has no single coordinate", entry.path))),
            Kind::Rotor(_) => {
                Err(ApiError(format!("`{}` is a rotor: it has a speed and a target velocity only", entry.path)))
            }
            _ => Err(ApiError(format!("`{}` is no joint", entry.path))),
        }
    }

    pub(super) fn joint_mut(&mut self, handle: Handle) -> Result<&mut JointEntry, ApiError> {
        let motor = self.joint(handle)?.handle;
        let k = self.joint_of[&motor];
        Ok(&mut self.joints[k])
    }

    /// Duration of one step of clients and scripts `[s]`: a whole number of base steps.
    #[must_use]
    pub fn sample_time(&self) -> f64 {
        self.sample_ticks as f64 * self.step
    }

    /// Base steps of one step of clients and scripts.
    #[must_use]
    pub(crate) fn sample_ticks(&self) -> u64 {
        self.sample_ticks
    }

    /// Base step `[s]`.
    #[must_use]
    pub(crate) fn base_step(&self) -> f64 {
        self.step
    }

    /// Sets the step of clients and scripts `[s]`.
    ///
    /// # Errors
    ///
    /// It is no whole multiple of the base step.
    pub(crate) fn set_sample_time(&mut self, dt: f64) -> Result<(), ApiError> {
        let ticks = (dt / self.step).round();
        let fits = (ticks * self.step - dt).abs() <= 1e-6 * dt;
        if !(fits && (1.0..1e9).contains(&ticks)) {
            let step = self.step;
            return Err(ApiError(format!(
                "a time step of {dt} s is no whole multiple of the scene's base step, {step} s"
            )));
        }
        self.sample_ticks = ticks as u64;
        Ok(())
    }

    /// Returns true if a step of clients and scripts begins at a tick.
    #[must_use]
    pub(crate) fn is_due(&self, tick: u64) -> bool {
        tick.is_multiple_of(self.sample_ticks)
    }

    /// Sets the command with an index among the model's, in its unit, over what scene and diagram give, until it is set
    /// to none.
    ///
    /// # Panics
    ///
    /// `command` is not below the model's number of commands.
    pub fn hold(&mut self, command: usize, value: Option<f64>) {
        self.held[command] = value;
    }

    /// Value in the command's unit that was set from outside; none if scene or diagram give it.
    #[must_use]
    pub(crate) fn held(&self, command: usize) -> Option<f64> {
        self.held[command]
    }

    /// The scene's own command at a time `[s]`.
    pub(super) fn scene_command(&self, command: usize, t: f64) -> f64 {
        self.commands[command].value(t)
    }

    /// Before a base step: impulses of motors are kept where a step of clients begins, to tell mean torques afterwards.
    pub(crate) fn begin_tick(&mut self, tick: u64, totals: &[f64]) {
        self.has_begun = true;
        if self.is_due(tick) {
            self.impulse.copy_from_slice(&totals[2..]);
            self.has_stepped = true;
        }
    }

    /// Takes note of the commands of scene and diagram for the step that begins; none when it has begun.
    pub(crate) fn preview(&mut self, commands: &[f64]) {
        self.upcoming.clear();
        self.upcoming.extend_from_slice(commands);
    }

    /// Command `command` for the step that begins if scripts are acting, else as it was last latched, or
    /// before the first step that of the scene; without what clients and scripts hold.
    pub(super) fn present_command(&self, command: usize, state: &State<f64>) -> f64 {
        let latched = || if state.tick == 0 { self.scene_command(command, 0.0) } else { state.commands[command] };
        self.upcoming.get(command).copied().unwrap_or_else(latched)
    }

    /// Removes the external forces of the step that has ended from the world, if they are still there.
    pub(crate) fn drop_spent_forces(&mut self, world: &mut World) {
        if std::mem::take(&mut self.are_forces_spent) {
            world.clear_external_forces();
        }
    }

    /// Commands that are held from outside, over those of the scene.
    pub(crate) fn latch(&self, commands: &mut Commands<'_>) {
        for (command, held) in self.held.iter().enumerate() {
            if let Some(x) = held {
                commands.set(command, *x);
            }
        }
    }

    /// Impulse of a motor at the start of the last step; none before the first.
    pub(super) fn impulse_before(&self, motor: usize) -> Option<f64> {
        self.has_stepped.then(|| self.impulse[motor])
    }

    /// Checks that `n` further bytes of signals, stored data, tubes and widgets, names included, stay within the 256
    /// MiB that clients and scripts may store together.
    ///
    /// # Errors
    ///
    /// They would not; nothing is stored, and clearing some makes room.
    pub fn check_stored_size(&self, n: usize) -> Result<(), ApiError> {
        let signals = self.integers.names_size() + self.floats.names_size() + self.strings.names_size();
        let data = self.data.iter().map(|((_, tag), data)| tag.len() + data.bytes.len()).sum::<usize>();
        let named = self.named.iter().map(|(name, bytes)| name.len() + bytes.len()).sum::<usize>();
        let widgets = self.widgets.size();
        let stored = self.strings.total() + signals + self.tubes.total() + self.radio.total() + data + named + widgets;
        if stored + n > MAX_BYTES {
            let mib = MAX_BYTES >> 20;
            return Err(ApiError(format!("signals and data of clients would take more than {mib} MiB: clear some")));
        }
        Ok(())
    }

    /// Adds a message for the operator of the simulator, with its level (see [`LogLine`]); the text is cut off at
    /// 10,000 bytes. Of 1,000 messages that nobody takes the oldest are dropped.
    pub fn log(&mut self, level: i64, text: impl Into<String>) {
        if self.log.len() == MAX_LINES {
            self.log.pop_front();
        }
        let mut text = text.into();
        text.truncate(text.floor_char_boundary(10_000));
        self.log.push_back(LogLine { level, text });
    }

    /// Messages that are kept with the run.
    pub(crate) fn notes(&self) -> &Notes {
        &self.notes
    }

    /// Keeps a message with the run that is on.
    pub(crate) fn note(&mut self, t: f64, object: &str, text: &str) {
        if self.phase.is_on() {
            self.notes.add(t, object, text);
        }
    }

    /// Takes the messages for the operator that have gathered since the last call, the oldest first.
    pub fn take_log(&mut self) -> Vec<LogLine> {
        self.log.drain(..).collect()
    }

    /// Asks for something that can happen only between two steps.
    pub(crate) fn ask(&mut self, request: Request) {
        if request == Request::Stop {
            self.stop_requests += 1;
        }
        self.requests.push(request);
    }

    /// Asks for a file of a model to be written; the last text of a name counts.
    ///
    /// # Errors
    ///
    /// Many files wait to be written.
    pub(crate) fn ask_to_save(&mut self, name: &str, text: String) -> Result<(), ApiError> {
        self.requests.retain(|request| !matches!(request, Request::Save(known, _) if known == name));
        let waiting = self.requests.iter().filter(|request| matches!(request, Request::Save(..))).count();
        if waiting >= MAX_SAVES {
            return Err(ApiError::new("16 models wait to be written: let the simulation step in between"));
        }
        self.requests.push(Request::Save(name.to_owned(), text));
        Ok(())
    }

    /// Asks for the file of a picture to be written into the folder for files of clients.
    ///
    /// # Errors
    ///
    /// Many files wait to be written.
    pub(crate) fn ask_to_save_image(&mut self, name: String, bytes: Vec<u8>) -> Result<(), ApiError> {
        let waiting = self.requests.iter().filter(|request| matches!(request, Request::SaveImage(..))).count();
        if waiting >= MAX_SAVES {
            return Err(ApiError::new("16 pictures wait to be written: let the simulation step in between"));
        }
        self.requests.push(Request::SaveImage(name, bytes));
        Ok(())
    }

    /// Keeps a picture of a script with the run; the last one of a name counts.
    ///
    /// # Errors
    ///
    /// There are many already, or they are large.
    pub(crate) fn keep_image(&mut self, name: &str, bytes: Vec<u8>) -> Result<(), ApiError> {
        self.check_saved(name, bytes.len())?;
        self.images.insert(name.to_owned(), bytes);
        Ok(())
    }

    /// Keeps what a script writes into a file with the run: behind what the file has, or in its place.
    ///
    /// # Errors
    ///
    /// The name is none of a file in a folder, there are many already, or they are large.
    pub fn keep_text(&mut self, name: &str, text: &[u8], is_behind: bool) -> Result<(), ApiError> {
        super::functions::check_file_name(name)?;
        let before = if is_behind { self.images.get(name).map_or(0, Vec::len) } else { 0 };
        self.check_saved(name, before + text.len())?;
        let file = self.images.entry(name.to_owned()).or_default();
        file.truncate(before);
        file.extend_from_slice(text);
        Ok(())
    }

    /// Text that scripts have written into a file in this run; none if there is no such file.
    #[must_use]
    pub fn kept_text(&self, name: &str) -> Option<&[u8]> {
        self.images.get(name).map(Vec::as_slice)
    }

    fn check_saved(&self, name: &str, n_bytes: usize) -> Result<(), ApiError> {
        let others = self.images.iter().filter(|(known, _)| *known != name);
        let (n, total) = others.fold((1, n_bytes), |(n, total), (_, other)| (n + 1, total + other.len()));
        let (max_n, max_total) = MAX_IMAGES;
        if n > max_n || total > max_total {
            let mib = max_total >> 20;
            let what = "pictures and files";
            return Err(ApiError(format!("scripts save {max_n} {what} of {mib} MiB together in a run, no more")));
        }
        Ok(())
    }

    /// Takes the change of the structure that was made since the last call, of all changes one.
    pub(crate) fn take_restructured(&mut self) -> Option<Restructured> {
        self.is_last_placement = false;
        self.restructured.take()
    }

    /// Goes on with a structure that another controller has made, or that comes with a snapshot.
    pub(crate) fn adopt_structure(&mut self, change: &Restructured) {
        if !Arc::ptr_eq(&self.scene, &change.scene) {
            let known: BTreeSet<usize> = self.scene.objects.iter().map(|object| object.id).collect();
            let new = change.scene.objects.iter().filter(|object| !known.contains(&object.id));
            self.added.extend(new.map(|object| Handle(object.id as i32 + 1)));
            let model = change.scene.model.clone();
            self.follow(change, &model);
        }
    }

    /// The same objects, compiled with other numbers.
    pub(crate) fn set_scene(&mut self, scene: &Arc<Scene>) {
        self.scene = Arc::clone(scene);
    }

    /// Scene that the world is of now.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Objects that clients and scripts have selected, in their order, of those that are there.
    #[must_use]
    pub fn selected(&self) -> Vec<Handle> {
        self.selection.iter().copied().filter(|own| self.entry(*own).is_ok()).collect()
    }

    /// Takes what was asked for.
    pub(crate) fn take_requests(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.requests)
    }

    /// Requests a TCP port of the legacy remote API for a script; it is opened between two steps. A port that is open
    /// already is accepted. Without `has_trigger` (V-REP's `preEnableTrigger`) clients of the port do not step.
    ///
    /// # Errors
    ///
    /// No clients are served in this run, the legacy API is not, the port is below 1024, or scripts have eight ports
    /// already.
    pub fn ask_port(&mut self, port: u16, has_trigger: bool) -> Result<(), ApiError> {
        let served = self.legacy_ports.as_mut();
        let ports = served.ok_or_else(|| ApiError::new("nothing is served in this run (`sincro serve` opens it)"))?;
        let request = ports.add(port, has_trigger)?;
        self.port_requests.push(request);
        Ok(())
    }

    /// Takes the TCP ports that scripts have requested since the last call, in the order of the requests; the server
    /// opens them.
    pub fn take_port_requests(&mut self) -> Vec<PortRequest> {
        std::mem::take(&mut self.port_requests)
    }

    /// A run begins: what the last one left is forgotten.
    pub(crate) fn begin_run(&mut self) {
        self.integers.forget_run();
        self.floats.forget_run();
        self.strings.forget_run();
        self.graphs.forget_run();
        (self.tubes, self.radio) = (Tubes::default(), Radio::default());
        self.images.clear();
        self.notes = Notes::default();
        (self.has_stepped, self.has_begun, self.is_told_of_step) = (false, false, false);
        (self.n_random, self.n_searches) = (0, 0);
        self.vision.forget();
        self.reset_looks();
    }

    /// A step of clients and scripts has been made: vision sensors that are not handled explicitly are handled.
    pub(crate) fn sense(&mut self, q: &[f64]) {
        self.vision.handle(q);
    }

    /// A run has ended: the commands of joints are as they were `before` it, the rest stays.
    pub(crate) fn end_run(&mut self, before: Self) {
        self.restructured = None;
        self.doomed.clear();
        self.is_last_placement = false;
        (self.initial_velocities, self.resets) = (BTreeMap::new(), BTreeMap::new());
        (self.roles, self.masses, self.materials) = (Vec::new(), before.masses.clone(), before.materials.clone());
        if !Arc::ptr_eq(&self.scene, &before.scene) {
            self.end_restructured_run(before);
            return;
        }
        self.joints = before.joints;
        self.held = before.held;
        (self.motions, self.joint_motions) = (before.motions, before.joint_motions);
        self.vision.end_run(before.vision);
        self.script_parameters = before.script_parameters;
        (self.changes, self.passing) = (before.changes, before.passing);
        self.belts = before.belts;
        self.dummy_links = before.dummy_links;
        (self.looks, self.component_colors) = (before.looks, before.component_colors);
        self.textures = before.textures;
        (self.respondable_masks, self.joint_modes) = (before.respondable_masks, before.joint_modes);
        (self.added_scripts, self.switched_off) = (before.added_scripts, before.switched_off);
        (self.broken, self.statics) = (before.broken, before.statics);
        (self.has_stepped, self.has_begun) = (false, false);
        self.widgets = before.widgets;
        self.recorded_frames = before.recorded_frames;
        self.moved_frames = before.moved_frames;
        self.drawings.end_run();
        let n_before = before.entries.len();
        for (now, then) in self.entries.iter_mut().zip(before.entries) {
            if let (Some(now), Some(then)) = (now.as_mut(), then) {
                (now.frame, now.moving, now.parent) = (then.frame, then.moving, then.parent);
                now.path = then.path;
                now.kind = then.kind;
            }
        }
        self.senses.end_run(&before.senses);
        self.flags = before.flags;
        self.settle_senses(n_before);
        self.settle_entities();
    }
}

impl ObjectRegistry {
    /// A run has ended whose structure was changed: all objects are those of before it.
    fn end_restructured_run(&mut self, before: Self) {
        let mut new = before;
        std::mem::swap(&mut self.log, &mut new.log);
        std::mem::swap(&mut self.integers, &mut new.integers);
        std::mem::swap(&mut self.floats, &mut new.floats);
        std::mem::swap(&mut self.strings, &mut new.strings);
        std::mem::swap(&mut self.named, &mut new.named);
        std::mem::swap(&mut self.notes, &mut new.notes);
        std::mem::swap(&mut self.requests, &mut new.requests);
        std::mem::swap(&mut self.graphs, &mut new.graphs);
        std::mem::swap(&mut self.tubes, &mut new.tubes);
        std::mem::swap(&mut self.radio, &mut new.radio);
        std::mem::swap(&mut self.legacy_ports, &mut new.legacy_ports);
        std::mem::swap(&mut self.port_requests, &mut new.port_requests);
        new.stop_requests = self.stop_requests;
        new.vision.forget();
        new.reset_looks();
        *self = new;
    }
}

/// The world as something to hang on.
pub(super) const WORLD: Attached<f64> = Attached {
    link: None,
    pose: Pose { rot: Mat3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), pos: Vec3([0.0; 3]) },
};

/// Mass properties of a body's solids at density 1; none if there are none, or something that is no solid of closed
/// form.
pub(super) fn unit_mass(object: &Object) -> Option<MassProperties> {
    if object.shapes.is_empty() || !object.surfaces.is_empty() {
        return None;
    }
    let parts = object.shapes.iter().map(|s| s.shape.mass_properties(1.0).placed(&s.pose.rot, s.pose.pos));
    Some(MassProperties::sum(&parts.collect::<Vec<_>>()))
}

/// The axis of a joint with one coordinate, in its own frame.
pub(super) fn axis_of(kind: &JointKind) -> Option<[f64; 3]> {
    match *kind {
        JointKind::Revolute { axis } | JointKind::Prismatic { axis } | JointKind::Screw { axis, .. } => Some(axis),
        _ => None,
    }
}

pub(super) fn turned(at: Attached<f64>, rot: &Mat3<f64>) -> Attached<f64> {
    Attached { pose: Pose { rot: at.pose.rot.mul(rot), ..at.pose }, ..at }
}

//! From a scene file to a compiled model: a tree of named objects, checked as a whole.
//!
//! The types of `file.rs` are what is written; `compile` orders the tree, makes the builder's specifications of joints,
//! bodies and forces, and brings what the builder finds back to lines of the file. All problems are reported at once.

mod activation;
mod air;
mod body;
mod bushing;
mod camera;
mod contact;
mod field;
mod file;
mod height_field;
mod initial;
mod joined_names;
mod joint;
mod mesh;
mod object;
mod pieces;
mod placement;
mod pose_start;
mod proximity;
mod reuse_file;
mod rotor;
mod schema;
mod script;
mod sensor;
mod signal_file;
mod source;
mod spring_damper;
mod start;
mod stills;
mod tendon;
mod text;
mod tree;
mod visual;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use sincro_dynamics::contact::Surface;
use sincro_dynamics::model::{BodySpec, DragSpec, ElasticGearSpec, ForceSpec, JointSpec, ModelBuilder, NodeId};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::Pose;
use sincro_dynamics::state::State;

pub(crate) use file::SceneFile;
pub use sincro_dynamics::initial::Mobility;
pub use sincro_dynamics::model::Model;

pub use camera::VisionSensor;
pub(crate) use camera::looking;
pub use mesh::{Triangles, mesh_of_file};
pub use object::{Object, ObjectKind, ShapeInstance, ShownSurface};
pub use pieces::frame_of;
pub use schema::scene_schema;
pub(crate) use script::of_model as scripts_of_model;
pub use source::SceneSource;
pub use stills::Camera;
pub use text::from_text;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::folder::Folder;
use crate::parallel;
use crate::scenery::Scenery;
use crate::script::{Script, ScriptParser};
use crate::sensor::SensorSpec;
use crate::words::is_named;
use file::{ForceFile, InFrameFile};
use signal_file::SignalReader;
use start::Start;
use tree::Entry;

/// Scene that is compiled and ready to run: the model with its initial state, and everything around it. Part of an
/// opened folder ([`crate::open::open`]), or made of a text by [`from_text`].
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"
///     [[joint]]
///     name = "hinge"
///     kind = "revolute"
///     axis = [0.0, 1.0, 0.0]
///     initial = { position = 0.3, velocity = -1.0 }
///
///     [[body]]
///     name = "rod"
///     parent = "/hinge"
///     density = 7800.0
///     shape = [{ cylinder = { radius = 0.01, length = 1.0 } }]
/// "#)?;
/// assert_eq!((&scene.initial.q[..], &scene.initial.v[..]), (&[0.3][..], &[-1.0][..])); // [rad], [rad/s]
/// assert_eq!(scene.objects.len(), 2);
/// let mass = scene.model.total_mass(); // [kg]
/// assert!((mass - 7800.0 * std::f64::consts::PI * 1e-4).abs() < 1e-12);
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    /// Compiled model; its names are the paths of the objects.
    pub model: Arc<Model<f64>>,
    /// Initial state of the model.
    pub initial: State<f64>,
    /// Commands over time, in the order of the model's command vector and in the units of the actuators: of motors, of
    /// forces that take them (none of their own), speeds of rotors, forces of springs and dampers.
    pub commands: Vec<Signal>,
    /// Sensors, in the order in which their values are kept.
    pub sensors: Vec<SensorSpec>,
    /// All objects, parents before children, children in the order of the file.
    pub objects: Vec<Object>,
    /// Scripts, in the order of the file.
    pub scripts: Vec<Script>,
    /// Warnings about the scene file, in its order.
    pub warnings: Vec<Diagnostic>,
    /// File that it was compiled from, everything in it written out; `None` if that was not kept.
    pub source: Option<Arc<SceneSource>>,
    /// Made when somebody looks first.
    scenery: OnceLock<Scenery>,
}

impl Scene {
    /// Returns the visible geometry of all bodies; made at the first call.
    #[must_use]
    pub fn scenery(&self) -> &Scenery {
        self.scenery.get_or_init(|| pieces::scenery_of(self))
    }

    /// Returns the degrees of freedom (mobility) in the initial state, with closed loops counted.
    #[must_use]
    pub fn freedom(&self) -> Mobility {
        sincro_dynamics::initial::mobility(&self.model, &self.initial)
    }

    /// Returns the object of a path such as `/arm/link`; `None` if there is none.
    #[must_use]
    pub fn object(&self, path: &str) -> Option<&Object> {
        self.objects.iter().find(|object| object.path == path)
    }

    /// Gives the objects other numbers, by their paths.
    pub(crate) fn renumber(&mut self, mut id_of: impl FnMut(&str) -> usize) {
        self.objects.iter_mut().for_each(|object| object.id = id_of(&object.path));
        self.scenery = OnceLock::new();
    }
}

/// Specification of an object for the builder.
enum Spec {
    Joint(JointSpec, Vec<Signal>),
    Body(BodySpec, Vec<ShapeInstance>, contact::Skin),
    Fixture(Vec<ShapeInstance>, contact::Skin),
    Frame,
    Force(ForceSpec),
    Rotor(Box<rotor::RotorMade>, Signal),
    Drag(DragSpec),
    Sensor(Option<SensorSpec>),
    Camera(f64, Option<VisionSensor>),
}

/// Compiles a document that fits the schema; `seed` is that of the turbulence.
pub(crate) fn compile(
    document: &Document,
    folder: &Folder,
    seed: u64,
    parser: Option<&dyn ScriptParser>,
) -> Result<Scene, Diagnostics> {
    compile_from(document, folder, (seed, parser), true)
}

/// As [`compile`], of a scene without scripts that goes on from the state of another one: its own initial state is not
/// checked.
pub(crate) fn compile_edited(document: &Document, folder: &Folder, seed: u64) -> Result<Scene, Diagnostics> {
    compile_from(document, folder, (seed, None), false)
}

fn compile_from(
    document: &Document,
    folder: &Folder,
    (seed, parser): (u64, Option<&dyn ScriptParser>),
    is_start: bool,
) -> Result<Scene, Diagnostics> {
    let file: SceneFile = serde_json::from_value(document.root.clone())
        .map_err(|e| Diagnostic::error(&document.at(""), format!("the scene cannot be read: {e}")))?;
    let entries = tree::entries(&file);
    let mut diagnostics = Diagnostics::new();
    let order = tree::order(&entries, document, &mut diagnostics);
    let air_density = file.air_density.uniform();
    let mut made = made(&entries, (document, folder), air_density, &mut diagnostics);
    let mut maker = Maker { document, folder, air_density, diagnostics: &mut diagnostics };
    let joints: Vec<&str> =
        entries.iter().filter(|e| matches!(e.file, tree::AnyFile::Joint(_))).map(|e| e.path.as_str()).collect();
    for entry in &entries {
        if let tree::AnyFile::Rotor(file) = entry.file {
            rotor::check_joint(file, &entry.pointer, &joints, &mut maker.signals());
        }
    }
    let wind = file.wind.as_ref().and_then(|wind| air::wind(wind, seed, document, &mut diagnostics));
    let gravity_field = file.gravity.field(document, &mut diagnostics);
    let air_density = file.air_density.field(document, &mut diagnostics);
    if diagnostics.any_error() {
        return Err(diagnostics.sorted());
    }
    let mut assembly = Assembly::new(file.gravity.uniform());
    if let Some(field) = gravity_field {
        assembly.builder.set_gravity_field(field);
    }
    if let Some(field) = air_density {
        assembly.builder.set_air_density(field);
    }
    if let Some(wind) = wind {
        assembly.builder.wind(wind);
    }
    for place in &order {
        let (spec, pose, visuals) =
            std::mem::replace(&mut made[place.entry], (Spec::Frame, Pose::identity(), Vec::new()));
        assembly.add(&entries[place.entry], place, spec, pose, document);
        assembly.objects.last_mut().expect("the object was added").visuals = visuals;
    }
    assembly.join(&file, document, &mut diagnostics);
    assembly.join_by_springs(&file, document, folder, &mut diagnostics);
    contact::warn_of_idle(&file, document, &mut diagnostics);
    let paths: Vec<&str> = assembly.objects.iter().map(|object| object.path.as_str()).collect();
    let scripts = script::read(&file.script, &paths, document, folder, parser, &mut diagnostics);
    assembly.finish(&entries, &file, (scripts, is_start), document, diagnostics)
}

/// Specification, pose in its parent and visuals of an entry.
type Made = (Spec, Pose<f64>, Vec<ShownSurface>);

/// Makes all entries, in their order; on several threads where meshes are read.
fn made(
    entries: &[Entry<'_>],
    (document, folder): (&Document, &Folder),
    air_density: f64,
    diagnostics: &mut Diagnostics,
) -> Vec<Made> {
    let make = |k: usize| {
        let (entry, mut own) = (&entries[k], Diagnostics::new());
        let mut maker = Maker { document, folder, air_density, diagnostics: &mut own };
        ((maker.spec(entry), maker.pose(entry), maker.visuals(entry)), own)
    };
    let has_meshes = entries.iter().any(|entry| match entry.file {
        tree::AnyFile::Body(file) => {
            file.shape.iter().any(|s| s.mesh.is_some()) || file.visual.iter().any(|v| v.mesh.is_some())
        }
        tree::AnyFile::Frame(file) => file.visual.iter().any(|v| v.mesh.is_some()),
        _ => false,
    });
    let all = if has_meshes { parallel::map(entries.len(), make) } else { (0..entries.len()).map(make).collect() };
    let note = |(made, own): (Made, Diagnostics)| {
        diagnostics.0.extend(own.0);
        made
    };
    all.into_iter().map(note).collect()
}

/// Makes specifications, noting what is wrong.
struct Maker<'a> {
    document: &'a Document,
    folder: &'a Folder,
    /// [kg/m³]
    air_density: f64,
    diagnostics: &'a mut Diagnostics,
}

impl Maker<'_> {
    fn spec(&mut self, entry: &Entry<'_>) -> Spec {
        match entry.file {
            tree::AnyFile::Joint(file) => {
                let (spec, command) = joint::spec(file, &entry.pointer, &mut self.signals());
                Spec::Joint(spec, command)
            }
            tree::AnyFile::Body(file) => {
                let shapes = body::shapes(file, &entry.pointer, self.document, self.diagnostics);
                let meshes = mesh::meshes(file, &entry.pointer, self.document, self.folder, self.diagnostics);
                let skin = contact::skin(file, &meshes, &entry.pointer, self.document, self.folder, self.diagnostics);
                if body::is_fixture(file) {
                    return Spec::Fixture(shapes, skin);
                }
                let mass = body::mass(file, &shapes, &meshes, &entry.pointer, self.document, self.diagnostics);
                Spec::Body(BodySpec { mass }, shapes, skin)
            }
            tree::AnyFile::Frame(_) => Spec::Frame,
            tree::AnyFile::Rotor(file) => rotor::spec(file, &entry.pointer, self.air_density, &mut self.signals()),
            tree::AnyFile::Drag(file) => {
                let (density, document) = (self.air_density, self.document);
                Spec::Drag(air::drag(file, &entry.pointer, density, document, self.diagnostics))
            }
            tree::AnyFile::Sensor(file) => {
                let (path, pointer) = (&entry.path, &entry.pointer);
                Spec::Sensor(sensor::spec(file, path, pointer, self.document, self.diagnostics))
            }
            tree::AnyFile::Camera(file) => {
                let sensor = camera::sensor(file, &entry.pointer, self.document, self.diagnostics);
                Spec::Camera(file.field_of_view_deg, sensor)
            }
            tree::AnyFile::Force(file) => Spec::Force(force(file, &entry.pointer, &mut self.signals())),
        }
    }

    fn visuals(&mut self, entry: &Entry<'_>) -> Vec<ShownSurface> {
        let files = match entry.file {
            tree::AnyFile::Body(file) => &file.visual,
            tree::AnyFile::Frame(file) => &file.visual,
            _ => return Vec::new(),
        };
        visual::visuals(files, &entry.pointer, self.document, self.folder, self.diagnostics)
    }

    fn signals(&mut self) -> SignalReader<'_> {
        SignalReader { document: self.document, folder: self.folder, diagnostics: self.diagnostics }
    }

    fn pose(&mut self, entry: &Entry<'_>) -> Pose<f64> {
        if let tree::AnyFile::Camera(file) = entry.file {
            return camera::pose(file, &entry.pointer, self.document, self.diagnostics);
        }
        placement::pose(&entry.placement(), &entry.pointer, self.document, self.diagnostics)
    }
}

fn force(file: &ForceFile, pointer: &str, signals: &mut SignalReader<'_>) -> ForceSpec {
    let mut three = |list: &[signal_file::SignalFile; 3], key: &str| {
        std::array::from_fn(|k| signals.read(&list[k], &format!("{pointer}/{key}/{k}")))
    };
    ForceSpec {
        force: three(&file.force, "force"),
        torque: three(&file.torque, "torque"),
        in_body: file.in_frame == InFrameFile::Body,
        is_input: file.input,
    }
}

/// Property of a surface that requires a body fixed in the world, with advice.
fn only_fixed(surface: &Surface) -> Option<(&'static str, &'static str)> {
    match surface {
        Surface::HalfSpace => Some(("a plane", "planes are fixed in the world; use a cuboid, or hang the body on `/`")),
        Surface::HeightField { .. } => {
            Some(("a height field", "height fields are fixed in the world; hang the body on `/`"))
        }
        Surface::Mesh(..) => Some((
            "a mesh that may be hollow",
            "convex = true takes the hull of the mesh; or build it of several convex ones, or hang the body on `/`",
        )),
        _ => None,
    }
}

/// The builder, and what must be known to find the way back from it.
struct Assembly {
    builder: ModelBuilder,
    nodes: Vec<NodeId>,
    objects: Vec<Object>,
    /// Commands of the motors of the joint, or speed of the rotor, that is object k.
    commands: BTreeMap<usize, Vec<Signal>>,
    /// Commands of springs and dampers with an actuator, by their paths.
    line_commands: BTreeMap<String, Signal>,
    sensors: Vec<SensorSpec>,
    /// Entry that is object k.
    entry_of: Vec<usize>,
}

impl Assembly {
    fn new(gravity: [f64; 3]) -> Self {
        Self {
            builder: ModelBuilder::new(gravity),
            nodes: Vec::new(),
            objects: Vec::new(),
            commands: BTreeMap::new(),
            line_commands: BTreeMap::new(),
            sensors: Vec::new(),
            entry_of: Vec::new(),
        }
    }

    fn add(&mut self, entry: &Entry<'_>, place: &tree::PlaceInTree, spec: Spec, pose: Pose<f64>, document: &Document) {
        let parent = place.parent.map_or(NodeId::WORLD, |k| self.nodes[k]);
        let path = place.path.clone();
        let (mut shapes, mut skin) = (Vec::new(), contact::Skin::default());
        let (node, kind) = match spec {
            Spec::Joint(spec, commands) => {
                let kind = ObjectKind::Joint { kind: spec.kind, motor: None };
                self.commands.insert(self.objects.len(), commands);
                (self.builder.joint(&path, parent, pose, spec), kind)
            }
            Spec::Fixture(of_body, of_skin) => {
                (shapes, skin) = (of_body, of_skin);
                (self.builder.frame(&path, parent, pose), ObjectKind::Fixture)
            }
            Spec::Body(spec, of_body, of_skin) => {
                (shapes, skin) = (of_body, of_skin);
                let kind = ObjectKind::Body { mass: spec.mass };
                (self.builder.body(&path, parent, pose, spec), kind)
            }
            Spec::Sensor(spec) => {
                self.sensors.extend(spec);
                (self.builder.frame(&path, parent, pose), ObjectKind::Sensor)
            }
            Spec::Frame => (self.builder.frame(&path, parent, pose), ObjectKind::Frame),
            // nothing hangs on a camera, and the model knows none
            Spec::Camera(field_of_view_deg, sensor) => (parent, ObjectKind::Camera { field_of_view_deg, sensor }),
            Spec::Force(spec) => (self.builder.force(&path, parent, spec), ObjectKind::Force),
            Spec::Drag(spec) => (self.builder.drag(&path, parent, pose, spec), ObjectKind::Drag),
            Spec::Rotor(made, speed) => {
                self.commands.insert(self.objects.len(), vec![speed]);
                let joint = made.joint.as_ref().and_then(|path| self.objects.iter().position(|o| o.path == *path));
                let spec = made.spec(joint.map(|k| self.nodes[k]));
                (self.builder.rotor(&path, parent, pose, spec), ObjectKind::Rotor)
            }
        };
        let name = entry.name.to_owned();
        let location = document.title_at(&entry.pointer);
        skin.add_to(&mut self.builder, node, &shapes);
        let contact::Skin { material: contact, surfaces, colors: surface_colors } = skin;
        let parent = place.parent;
        self.objects.push(Object {
            id: self.objects.len(),
            path,
            name,
            kind,
            parent,
            pose,
            contact,
            surfaces,
            surface_colors,
            shapes,
            visuals: Vec::new(),
            location,
        });
        self.nodes.push(node);
        self.entry_of.push(place.entry);
    }

    /// Closures, couplings and pairs of surfaces, which name objects by their paths.
    fn join(&mut self, file: &SceneFile, document: &Document, diagnostics: &mut Diagnostics) {
        self.builder.set_rest_speed(file.rest_speed);
        joined_names::check(file, self.objects.iter().map(|o| o.path.as_str()), document, diagnostics);
        let mut joiner = contact::Joiner { objects: &self.objects, nodes: &self.nodes, document, diagnostics };
        for (k, closure) in file.closure.iter().enumerate() {
            if let Some(spec) = joiner.closure(closure, &format!("/closure/{k}")) {
                self.builder.loop_joint(&format!("/{}", closure.name), spec);
            }
        }
        for (k, coupling) in file.coupling.iter().enumerate() {
            if let Some(spec) = joiner.coupling(coupling, &format!("/coupling/{k}")) {
                let name = format!("/{}", coupling.name);
                let Some(stiffness) = coupling.stiffness else {
                    self.builder.gear(&name, spec);
                    continue;
                };
                let (damping, backlash) = (coupling.damping.unwrap_or(0.0), coupling.backlash.unwrap_or(0.0));
                self.builder.elastic_gear(&name, ElasticGearSpec { gear: spec, stiffness, damping, backlash });
            }
        }
        for (k, pair) in file.contact_pair.iter().enumerate() {
            for (bodies, law) in joiner.contact_pair(pair, &format!("/contact_pair/{k}")) {
                self.builder.contact_pair(bodies, law);
            }
        }
    }

    /// Springs and dampers between points of objects, bushings and tendons, which name objects by their paths.
    fn join_by_springs(
        &mut self,
        file: &SceneFile,
        document: &Document,
        folder: &Folder,
        diagnostics: &mut Diagnostics,
    ) {
        for (k, own) in file.spring_damper.iter().enumerate() {
            let pointer = format!("/spring_damper/{k}");
            let (objects, nodes) = (&self.objects, &self.nodes);
            let ends = contact::Joiner { objects, nodes, document, diagnostics }.ends(&own.between, &pointer);
            let mut signals = SignalReader { document, folder, diagnostics };
            let made = ends.and_then(|ends| spring_damper::spec(own, ends, &pointer, &mut signals));
            let Some((spec, command)) = made else { continue };
            let path = format!("/{}", own.name);
            self.builder.spring_damper(&path, spec);
            self.line_commands.extend(command.map(|command| (path, command)));
        }
        for (k, own) in file.bushing.iter().enumerate() {
            let pointer = format!("/bushing/{k}");
            let (objects, nodes) = (&self.objects, &self.nodes);
            let ends = contact::Joiner { objects, nodes, document, diagnostics }.ends(&own.between, &pointer);
            if let Some(spec) = ends.and_then(|ends| bushing::spec(own, ends, &pointer, document, diagnostics)) {
                self.builder.bushing(&format!("/{}", own.name), spec);
            }
        }
        for (k, own) in file.tendon.iter().enumerate() {
            let pointer = format!("/tendon/{k}");
            let (objects, nodes) = (&self.objects, &self.nodes);
            let path = contact::Joiner { objects, nodes, document, diagnostics }.tendon(own, &pointer);
            let mut signals = SignalReader { document, folder, diagnostics };
            let made = path.and_then(|path| tendon::spec(own, path, &pointer, &mut signals));
            let Some((spec, command)) = made else { continue };
            let path = format!("/{}", own.name);
            self.builder.spring_damper(&path, spec);
            self.line_commands.extend(command.map(|command| (path, command)));
        }
    }

    fn finish(
        mut self,
        entries: &[Entry<'_>],
        file: &SceneFile,
        (scripts, is_start): (Vec<Script>, bool),
        document: &Document,
        mut diagnostics: Diagnostics,
    ) -> Result<Scene, Diagnostics> {
        let (model, found) = match self.builder.build() {
            Ok((model, warnings)) => (Some(model), warnings),
            Err(found) => (None, found.into()),
        };
        for diagnostic in found {
            diagnostics.push(self.place(diagnostic, entries, document));
        }
        let Some(mut model) = model else { return Err(diagnostics.sorted()) };
        crate::sensor::register(&mut model, &self.sensors);
        sensor::find_bodies(&mut self.sensors, &self.objects, &mut diagnostics);
        proximity::find_bodies(&mut self.sensors, &self.objects, &mut diagnostics);
        let mut starts = Vec::new();
        for (object, &entry) in self.objects.iter().zip(&self.entry_of) {
            if let tree::AnyFile::Joint(file) = entries[entry].file {
                starts.push((object.path.as_str(), entries[entry].pointer.as_str(), &file.initial));
            }
        }
        let mut initial = initial::state(&model, &starts, document, &mut diagnostics);
        if let Some(poses) = &file.initial_pose {
            let is_list = matches!(poses, file::OneOrList::List(_));
            let pointer = |k: usize| if is_list { format!("/initial_pose/{k}") } else { "/initial_pose".into() };
            pose_start::solve(&model, poses.as_slice(), pointer, &mut initial, document, &mut diagnostics);
        }
        spring_damper::set_free_lengths(&mut model, &initial, file, document, &mut diagnostics);
        if is_start {
            field::check(&model, &initial, document, &mut diagnostics);
        }
        self.check_fixtures(&model, &mut diagnostics);
        let commands = self.motors(&model);
        if is_start {
            let start = Start { model: &model, initial: &initial, file, objects: &self.objects, document };
            start.check(&commands, &mut diagnostics);
        }
        self.warn_of_idle_forces(&model, &mut diagnostics);
        self.warn_of_fixed_bodies(&model, document, !scripts.is_empty(), &mut diagnostics);
        contact::warn_of_excluded(&model, file, document, &mut diagnostics);
        if model.wind().is_some() && model.rotors().is_empty() && model.drags().is_empty() {
            let diagnostic =
                Diagnostic::error(&document.at("/wind"), "nothing in this scene feels the wind").as_warning();
            diagnostics.push(diagnostic.with_help("rotors and drag elements do: add a [[drag]] to a body"));
        }
        if diagnostics.any_error() {
            return Err(diagnostics.sorted());
        }
        let warnings = diagnostics.sorted().0;
        Ok(Scene {
            model: Arc::new(model),
            initial,
            commands,
            sensors: self.sensors,
            objects: self.objects,
            scripts,
            warnings,
            source: None,
            scenery: OnceLock::new(),
        })
    }

    /// Commands in the model's order; tells joints the index of their motors.
    fn motors(&mut self, model: &Model<f64>) -> Vec<Signal> {
        let mut commands = vec![Signal::Constant(0.0); model.n_commands()];
        for (rotor, name) in model.rotors().iter().zip(&model.names().rotors) {
            let speed = self.objects.iter().position(|o| o.path == *name).and_then(|k| self.commands.remove(&k));
            if let Some(command) = rotor.speed.command() {
                commands[command] =
                    speed.and_then(|mut speed| speed.pop()).expect("a rotor that takes a command has one");
            }
        }
        for (line, name) in model.spring_dampers().iter().zip(&model.names().spring_dampers) {
            if let Some(actuator) = line.actuator {
                commands[actuator.command] = self.line_commands.remove(name).expect("an actuator has a command");
            }
        }
        for joint in &model.names().joints {
            let Some(index) = self.objects.iter().position(|o| o.path == joint.name) else { continue };
            if let (Some(motor), ObjectKind::Joint { motor: known, .. }) =
                (joint.motor.map(sincro_dynamics::ids::MotorId::index), &mut self.objects[index].kind)
            {
                *known = Some(motor);
                let own = self.commands.remove(&index).expect("a joint with motors has commands");
                commands[motor..motor + own.len()].clone_from_slice(&own);
            }
        }
        commands
    }

    /// A body without mass can only stand in the world.
    fn check_fixtures(&self, model: &Model<f64>, diagnostics: &mut Diagnostics) {
        for object in self.objects.iter().filter(|o| o.kind == ObjectKind::Fixture || !o.surfaces.is_empty()) {
            let moves = model.names().frame(&object.path).is_some_and(|f| f.link.is_some());
            let only_fixed = object.surfaces.iter().find_map(|(s, _)| only_fixed(s));
            if moves && object.kind == ObjectKind::Fixture {
                let diagnostic = Diagnostic::error(&object.location, format!("body `{}`: it has no mass", object.path));
                let help =
                    "give `density` and shapes, or `mass` and `inertia`; only what is fixed in the world needs none";
                diagnostics.push(diagnostic.with_help(help));
            } else if let Some((what, help)) = only_fixed.filter(|_| moves && object.contact.is_some()) {
                let diagnostic =
                    Diagnostic::error(&object.location, format!("body `{}` moves and has {what}", object.path));
                diagnostics.push(diagnostic.with_help(help));
            }
        }
    }

    fn warn_of_idle_forces(&self, model: &Model<f64>, diagnostics: &mut Diagnostics) {
        for object in
            self.objects.iter().filter(|o| matches!(o.kind, ObjectKind::Force | ObjectKind::Rotor | ObjectKind::Drag))
        {
            let carrier = object.parent.and_then(|k| model.names().frame(&self.objects[k].path));
            if carrier.is_some_and(|frame| frame.link.is_none()) {
                let word = object.kind.word();
                let message = format!("{word} `{}` acts on something that is fixed in the world", object.path);
                let diagnostic = Diagnostic::error(&object.location, message).as_warning();
                diagnostics.push(diagnostic.with_help("it moves nothing; hang its parent on a joint"));
            }
        }
    }

    /// Warns of bodies whose mass has no effect: they are fixed in the world, and nothing hangs on them or can touch
    /// them.
    fn warn_of_fixed_bodies(
        &self,
        model: &Model<f64>,
        document: &Document,
        has_scripts: bool,
        diagnostics: &mut Diagnostics,
    ) {
        // scenery may be there to be seen, or to be found by scripts
        let is_seen = |o: &Object| matches!(o.kind, ObjectKind::Sensor | ObjectKind::Camera { sensor: Some(_), .. });
        if has_scripts || self.objects.iter().any(is_seen) {
            return;
        }
        for (k, object) in self.objects.iter().enumerate() {
            let ObjectKind::Body { mass } = &object.kind else { continue };
            let is_fixed = model.names().frame(&object.path).is_some_and(|frame| frame.link.is_none());
            let is_alone = object.contact.is_none() && self.objects.iter().all(|child| child.parent != Some(k));
            // closures, springs and sensors of distances name it
            if is_fixed && is_alone && mass.mass > 0.0 && !is_named(document, &object.name) {
                let message = format!("body `{}` has mass and is fixed in the world: it never moves", object.path);
                let diagnostic = Diagnostic::error(&object.location, message).as_warning();
                diagnostics.push(diagnostic.with_help(
                    "hang it on a joint (`kind = \"free\"` lets it fall); scenery needs no mass, only shapes",
                ));
            }
        }
    }

    /// A finding of the builder, at the key of the file that it is about.
    fn place(
        &self,
        found: sincro_dynamics::model::Diagnostic,
        entries: &[Entry<'_>],
        document: &Document,
    ) -> Diagnostic {
        let object = found.node.and_then(|node| self.nodes.iter().position(|n| *n == node));
        let at = match object {
            Some(k) => {
                let pointer = &entries[self.entry_of[k]].pointer;
                let mut keys = keys_of_field(found.field).into_iter().map(|key| format!("{pointer}/{key}"));
                let written = keys.find(|p| document.get(p).is_some());
                written.map_or_else(|| document.title_at(pointer), |p| document.at(&p))
            }
            None => document.at(&format!("/{}", found.field)),
        };
        Diagnostic { severity: found.severity, ..Diagnostic::error(&at, found.message) }.with_help(found.help)
    }
}

/// Keys of the file that a field of the builder may come from, the likeliest first.
fn keys_of_field(field: &'static str) -> Vec<&'static str> {
    match field {
        "mass" => vec!["mass", "density", "shape"],
        "center_of_mass" => vec!["center_of_mass", "shape"],
        "inertia" => vec!["inertia", "shape"],
        "rotation" => vec!["rotation_deg", "quaternion_wxyz"],
        other => vec![other],
    }
}

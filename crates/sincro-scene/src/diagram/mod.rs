//! Block diagrams of a scene folder: the file, its errors, and the diagram in one step with the world.
//!
//! `file.rs` is what is written; `read.rs` turns it into a [`Diagram`]; `ports.rs` says what the world gives and takes;
//! `wiring.rs` connects both; `reference.rs` describes all blocks; `robot/` has the blocks that use the model.

mod file;
mod fmu;
mod lua;
mod ports;
mod read;
pub mod reference;
pub mod robot;
mod robot_model;
mod schema;
mod wiring;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use sincro_blocks::compile::{Element, Interface, Place, compile};
use sincro_blocks::diagram::{Content, Diagram};
use sincro_blocks::program::Program;
use sincro_blocks::runner::Runner;
use sincro_dynamics::model::Model;

pub(crate) use file::DiagramFile;
pub use ports::is_known_at_ticks_only;
use read::{DiagramReader, Origin};
pub use reference::reference;
use robot_model::Models;
pub use schema::diagram_schema;
#[cfg(test)]
pub(crate) use schema::with_blocks;
pub use wiring::{MeasuredSignals, Wiring};

use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::document::Document;
use crate::fmu::Loaders;
use crate::folder::Folder;
use crate::record::{Entry, Probe, catalogue};

/// Block diagram that is compiled for a model and connected to its measurements and commands. Read from `diagram.toml`
/// with the scene, or made in code by [`ControlDiagram::new`].
#[derive(Clone, Debug)]
pub struct ControlDiagram {
    /// Diagram as it was drawn: blocks and wires by their names.
    pub diagram: Diagram,
    /// Compiled diagram, connected to the model.
    pub wiring: Arc<Wiring>,
}

/// Context in which a diagram is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setting<'a> {
    pub model: &'a Arc<Model<f64>>,
    /// The scene file that the model was compiled from, settings applied.
    pub scene: Option<&'a Document>,
    /// Base step `[s]`.
    pub step: f64,
    pub seed: u64,
    /// The experiment's parameters: formulas know them.
    pub parameters: &'a BTreeMap<String, f64>,
    /// Language of laws that are written in a script's language, and FMUs.
    pub loaders: Loaders,
}

/// Reads and compiles a document that fits the schema.
pub(crate) fn open(document: &Document, folder: &Folder, setting: Setting<'_>) -> Result<ControlDiagram, Diagnostics> {
    let file: DiagramFile = serde_json::from_value(document.root.clone())
        .map_err(|e| Diagnostic::error(&document.at(""), format!("the diagram cannot be read: {e}")))?;
    let robot =
        robot::Context { parser: setting.loaders.scripts, fmus: setting.loaders.fmus, model: setting.model.clone() };
    let models = Models::new(folder, setting.scene, setting.parameters, setting.loaders.scripts);
    let mut reader = DiagramReader::new(document, folder, &file, &robot, models);
    let (mut diagram, origin, sample_time) = reader.diagram(setting.parameters);
    if reader.diagnostics.any_error() {
        return Err(shortened(reader.diagnostics));
    }
    if let Some(sample_time) = sample_time {
        for entry in &mut diagram.entries {
            entry.sample_time.get_or_insert(sample_time);
        }
    }
    ControlDiagram::new(diagram.clone(), setting.model, setting.step, setting.seed).map_err(|found| {
        let (mut diagnostics, mut said) = (Diagnostics::new(), BTreeSet::new());
        for diagnostic in found {
            let at = locate(document, &origin, &diagram, &diagnostic.place);
            // what is wrong in a definition is said once, however often it is used
            if said.insert((at.span.start, diagnostic.message.clone())) {
                diagnostics.push(Diagnostic::error(&at, diagnostic.message).with_help(diagnostic.help));
            }
        }
        shortened(diagnostics)
    })
}

/// Sorted, and of very many the first: who has mended those will see the next.
fn shortened(diagnostics: Diagnostics) -> Diagnostics {
    const MAX_DIAGNOSTICS: usize = 200;
    let mut diagnostics = diagnostics.sorted();
    let n_more = diagnostics.0.len().saturating_sub(MAX_DIAGNOSTICS);
    if n_more > 0 {
        diagnostics.0.truncate(MAX_DIAGNOSTICS);
        diagnostics.push(Diagnostic::without_location(format!("{n_more} more problems of the diagram are not shown")));
    }
    diagnostics
}

impl ControlDiagram {
    /// Compiles a diagram for a model; `step` is the base step of the experiment `[s]`, `seed` that of all random
    /// blocks. Wires to and from names such as `/hinge.position` connect it to the model.
    ///
    /// ```
    /// use sincro_blocks::diagram::Diagram;
    /// use sincro_blocks::library::maths::Gain;
    /// use sincro_scene::diagram::ControlDiagram;
    ///
    /// let scene = r#"
    /// joint = [{ name = "hinge", kind = "revolute", axis = [0, 1, 0], motor = { mode = "torque" } }]
    /// [[body]]
    /// name = "arm"
    /// parent = "/hinge"
    /// mass = 1
    /// center_of_mass = [0, 0, -0.5]
    /// inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }
    /// "#;
    /// let scene = sincro_scene::scene::from_text(scene).unwrap();
    /// let mut diagram = Diagram::new();
    /// diagram.block("spring", Gain::new(-20.0)).wire("/hinge.position", "spring").wire("spring", "/hinge");
    /// let controller = ControlDiagram::new(diagram, &scene.model, 0.001, 0).unwrap();
    /// assert_eq!(controller.entries()[0].name, "spring");
    /// ```
    ///
    /// # Errors
    ///
    /// [`CompileError`](sincro_blocks::compile::CompileError) with everything that is wrong with the diagram: ports
    /// that do not exist, widths and units that do not fit, algebraic loops.
    pub fn new(
        diagram: Diagram,
        model: &Arc<Model<f64>>,
        step: f64,
        seed: u64,
    ) -> Result<Self, sincro_blocks::compile::CompileError> {
        let measurements = ports::measurements(model);
        let interface = Interface {
            step,
            seed,
            measurements: measurements.iter().map(|m| m.terminal.clone()).collect(),
            commands: ports::commands(model),
        };
        let program = Arc::new(compile(&diagram, &interface)?);
        let wiring = Arc::new(Wiring::new(program, &measurements));
        Ok(Self { diagram, wiring })
    }

    /// Returns the path of the block whose continuous state decays fastest at the start, and its decay rate `[1/s]`;
    /// `None` if no state decays. For the choice of the integration method.
    #[must_use]
    pub fn fastest_decay(&self) -> Option<(String, f64)> {
        let program = self.wiring.program();
        let mut runner = Runner::<f64>::new(program.clone());
        let mut decay = vec![0.0; program.n_states];
        runner.neg_jacobian_diagonal(0, 0.0, &mut decay);
        let k = (0..decay.len()).max_by(|a, b| decay[*a].total_cmp(&decay[*b]))?;
        let step = program.steps.iter().find(|s| s.states.contains(&k))?;
        (decay[k] > 0.0).then(|| (step.path.clone(), decay[k]))
    }

    /// Returns the scopes of the diagram in their order: title, and the names of the recorded signals that they show.
    /// `model` is the one that the diagram was compiled for.
    #[must_use]
    pub fn scopes(&self, model: &Model<f64>) -> Vec<(String, Vec<String>)> {
        let program = self.wiring.program();
        let entries = self.entries();
        let of_world = catalogue(model);
        let name = |signal: usize| {
            let own = entries.iter().find(|e| e.probe == Probe::Signal(signal));
            own.or_else(|| of_world.iter().find(|e| Some(e.probe) == self.wiring.measured(signal)))
                .map(|e| e.name.clone())
        };
        let scopes = program.steps.iter().filter(|step| step.template.kind().name == "scope");
        scopes
            .map(|step| {
                let signals = step.ports.iter().flat_map(|&(at, len)| at as usize..(at + len) as usize);
                let names = signals.filter_map(|k| name(source_of(program, k))).collect();
                let title = match step.template.label() {
                    title if title.is_empty() => step.path.clone(),
                    title => title,
                };
                (title, names)
            })
            .collect()
    }

    /// Returns the diagram's signals as they can be recorded, with their units: `block`, `block.port`, components of
    /// vectors as `block[0]`.
    #[must_use]
    pub fn entries(&self) -> Vec<Entry> {
        entries(&self.wiring)
    }
}

/// The signal that a component of a bundle `[a, b]` is taken from; any other signal is its own.
fn source_of(program: &Program, signal: usize) -> usize {
    let bundle = program.steps.iter().find(|s| s.out.contains(&signal) && s.path.contains('['));
    let Some(step) = bundle else { return signal };
    let mut within = signal - step.out.start;
    for &(at, len) in &step.ports {
        if within < len as usize {
            return source_of(program, at as usize + within);
        }
        within -= len as usize;
    }
    signal
}

/// See [`ControlDiagram::entries`].
fn entries(wiring: &Wiring) -> Vec<Entry> {
    let mut list = Vec::new();
    for (name, range, units) in wiring.program().outputs().filter(|(name, ..)| !name.contains('[')) {
        let is_vector = range.len() > 1;
        list.extend(range.zip(units).enumerate().map(|(k, (signal, unit))| Entry {
            name: if is_vector { format!("{name}[{k}]") } else { name.clone() },
            unit: unit.as_ref().map_or(Cow::Borrowed(""), |u| Cow::Owned(u.to_string())),
            probe: Probe::Signal(signal),
        }));
    }
    list
}

/// Location in the file of a diagnostic of the compiler.
fn locate(document: &Document, origin: &Origin, diagram: &Diagram, place: &Place) -> Location {
    let (mut origin, mut diagram) = (origin, diagram);
    // where sample times may be given, outermost first
    let mut times = vec!["/sample_time".to_owned()];
    for name in &place.diagram {
        let Some(inner) = origin.inner.get(name) else { break };
        times.push(format!("{}/sample_time", inner.pointer));
        if let Some(k) = diagram.entries.iter().rposition(|e| e.name == *name) {
            times.push(format!("{}/block/{k}/sample_time", origin.pointer));
        }
        origin = inner;
        if let Some(Content::Diagram(_, content)) = diagram.entry(name).map(|e| &e.content) {
            diagram = content;
        }
    }
    let pointer = &origin.pointer;
    let block = |name: &str| {
        let k = diagram.entries.iter().rposition(|e| e.name == *name)?;
        Some(format!("{pointer}/block/{k}"))
    };
    match &place.element {
        Element::Entry(name) => block(name).map_or_else(|| document.at(pointer), |p| document.title_at(&p)),
        Element::SampleTime(name) => {
            times.extend(block(name).map(|p| format!("{p}/sample_time")));
            let found = times.into_iter().rev().find(|p| document.get(p).is_some());
            found.map_or_else(
                || block(name).map_or(document.at(pointer), |p| document.title_at(&p)),
                |p| document.at(&p),
            )
        }
        Element::Unit(name) => block(name).map_or_else(
            || document.at(pointer),
            |p| {
                let unit = format!("{p}/unit");
                if document.get(&unit).is_some() { document.at(&unit) } else { document.title_at(&p) }
            },
        ),
        Element::From(k) | Element::To(k) => match origin.wires.get(*k) {
            Some((text, from, to)) => {
                let span = if matches!(place.element, Element::From(_)) { from } else { to };
                read::within(&document.at(&format!("{pointer}/wires/{text}")), span)
            }
            None => document.at(&format!("{pointer}/wires")),
        },
        Element::Port(_) => document.at(&format!("{pointer}/outputs")),
    }
}

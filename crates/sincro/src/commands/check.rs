//! `sincro check`: a scene looked over, nothing run; with `--mutate` its checks put to the test.

use std::path::PathBuf;

use clap::Args;
use sincro::Loaded;
#[cfg(feature = "formats")]
use sincro::export_c::{Compilable, compilable};
use sincro_blocks::program::Rate;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::record::catalogue;
use sincro_scene::scene::{Mobility, Model, Object, ObjectKind, Scene};
use sincro_scene::script::Kind;
use sincro_sim::audit::source_findings;
use sincro_sim::run::{method_for, method_word};
use sincro_sim::trace::model_hash;

use super::console::{degrees, print_findings, short};
use super::mutate;
use super::robot_file::OpenedScene;
use crate::run::unstable_loop;
use crate::{Exit, diagnostics};

/// Arguments of `check`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file (URDF, SDF, MJCF)
    scene: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// List every signal that can be recorded, with its unit
    #[arg(long)]
    signals: bool,
    /// Change each number by this share in turn, such as 1e-3, run all checks, and say which changes none notices
    #[arg(long, value_name = "SHARE", conflicts_with = "signals")]
    mutate: Option<f64>,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let OpenedScene { source: _source, set, loaded } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    if let Some(share) = arguments.mutate {
        return mutate::run(&loaded, &set, share);
    }
    print(&loaded);
    if arguments.signals {
        say!("signals");
        let of_diagram = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        for entry in catalogue(&loaded.scene.model).into_iter().chain(of_diagram) {
            say!("  {:<48} {}", entry.name, entry.unit);
        }
    }
    diagnostics::print_diagnostics(&loaded.warnings);
    diagnostics::note_older_format(&arguments.scene, &loaded);
    let findings = source_findings(&loaded);
    print_findings("", findings.iter().map(|finding| ("", finding)));
    if findings.is_empty() { Exit::Holds } else { Exit::Fails }
}

fn print(loaded: &Loaded) {
    let (scene, experiment) = (&loaded.scene, &loaded.experiment);
    say!("{}", experiment.title);
    if !scene.objects.is_empty() {
        say!("objects");
        print_children(scene, None, 1);
    }
    print_scripts(loaded);
    let model = &scene.model;
    let freedom = scene.freedom();
    say!("model");
    say!(
        "  {}, {}, {} kg",
        degrees(freedom.dofs()),
        diagnostics::count(model.links().len(), "moving link"),
        short(model.total_mass())
    );
    print_constraints(model, &freedom);
    say!("  hash {}", model_hash(model));
    if let Some(controller) = &loaded.controller {
        print_diagram(controller, experiment.step);
    }
    let (method, warnings) = method_for(loaded);
    say!("run");
    say!(
        "  {} s at {} s: {} steps, {} recorded signals",
        short(experiment.duration),
        short(experiment.step),
        experiment.n_steps,
        experiment.record.len()
    );
    say!("  integrator {} (asked for: {})", method_word(method), experiment.integrator.word());
    #[cfg(feature = "formats")]
    print_compilable(&compilable(loaded));
    say!(
        "  {}, {}{}",
        diagnostics::count(experiment.checks.len(), "check"),
        diagnostics::count(experiment.variants.len(), "variant"),
        experiment.sweep.as_ref().map_or(String::new(), |s| format!(
            ", sweep of {} over {} values",
            s.parameter.value,
            s.values.len()
        ))
    );
    for warning in warnings.into_iter().chain(unstable_loop(loaded)) {
        say!("warning: {warning}");
    }
}

/// Parts of the scene that batches compile, and why not the rest.
#[cfg(feature = "formats")]
fn print_compilable(compilable: &Compilable) {
    let plant = match compilable {
        Compilable { step: Ok(()), .. } => "the steps of the mechanism".to_owned(),
        Compilable { rates: Ok(()), step: Err(why), .. } => format!("the accelerations, not the steps: {why}"),
        Compilable { rates: Err(why), .. } => format!("nothing of the mechanism: {why}"),
    };
    say!("  compilable: {plant}");
    match &compilable.diagram {
        Some(Ok(())) => say!("  compilable: the diagram"),
        Some(Err(why)) => say!("  compilable: not the diagram: {why}"),
        None => {}
    }
}

/// The scripts in the order of the file: on what, from where, how often.
fn print_scripts(loaded: &Loaded) {
    let scripts = &loaded.scene.scripts;
    if scripts.is_empty() {
        return;
    }
    let every = loaded.experiment.step * loaded.experiment.simulation_ticks as f64;
    say!("scripts, called every {} s", short(every));
    for script in scripts {
        let kind = match script.kind {
            Kind::Child => "child",
            Kind::Customization => "customization",
        };
        let parameters = diagnostics::count(script.parameters.len(), "parameter");
        say!("  {} {kind} script, {}, {parameters}", script.path, script.source.path.display());
    }
}

/// Loops, limits and contacts, if there are any.
fn print_constraints(model: &Model<f64>, freedom: &Mobility) {
    let set = model.constraints();
    if freedom.loops > 0 {
        say!(
            "  {} of the tree, {} with {}, {} redundant",
            freedom.tree_dofs,
            diagnostics::count(freedom.loops, "loop"),
            diagnostics::count(freedom.equations, "equation"),
            freedom.redundant
        );
    }
    if !set.limits.is_empty() {
        say!("  {}", diagnostics::count(set.limits.len(), "joint limit"));
    }
    if !set.pairs.is_empty() {
        say!(
            "  {}, {} of them that can touch, in up to {}",
            diagnostics::count(set.colliders.len(), "surface"),
            diagnostics::count(set.pairs.len(), "pair"),
            diagnostics::count(set.n_contacts(), "point")
        );
    }
}

/// The blocks in the order of evaluation: when each is evaluated, how many states it has.
fn print_diagram(controller: &ControlDiagram, step: f64) {
    let program = controller.wiring.program();
    let count = |n: usize, one: &str, many: &str| format!("{n} {}", if n == 1 { one } else { many });
    say!(
        "diagram: {}, {}, {} in memory",
        count(program.steps.len(), "block", "blocks"),
        count(program.n_states, "continuous state", "continuous states"),
        count(program.n_memory, "number", "numbers")
    );
    say!("  order of evaluation");
    let width = program.steps.iter().map(|s| s.path.chars().count()).max().unwrap_or(0).min(40);
    let kinds = program.steps.iter().map(|s| s.template.kind().name.len()).max().unwrap_or(0);
    for (k, block) in program.steps.iter().enumerate() {
        if k == program.n_early && !program.late.is_empty() {
            say!("       world: accelerations under these commands");
        }
        let rate = match block.rate {
            Rate::Constant => "constant".to_owned(),
            Rate::Continuous => "continuous".to_owned(),
            Rate::Sampled(every) => format!("every {} s", short(every as f64 * step)),
        };
        let states = match block.states.len() {
            0 => String::new(),
            n => format!(", {}", count(n, "state", "states")),
        };
        let kind = block.template.kind().name;
        say!("  {:>3}  {:<width$}  {kind:<kinds$}  {rate}{states}", k + 1, block.path);
    }
}

fn print_children(scene: &Scene, parent: Option<usize>, depth: usize) {
    for (i, object) in scene.objects.iter().enumerate().filter(|(_, o)| o.parent == parent) {
        say!(
            "{:indent$}{:<width$} {}",
            "",
            object.name,
            words(object),
            indent = 2 * depth,
            width = 24 - 2 * depth.min(10)
        );
        print_children(scene, Some(i), depth + 1);
    }
}

/// Kind and properties of an object, in one line.
fn words(object: &Object) -> String {
    match &object.kind {
        ObjectKind::Body { mass } => {
            let [a, b, c] = mass.principal_moments();
            format!("body, {} kg, principal moments {} {} {} kg·m²", short(mass.mass), short(a), short(b), short(c))
        }
        ObjectKind::Joint { motor: Some(_), .. } => format!("{} with motor", object.kind.word()),
        ObjectKind::Camera { sensor: Some(sensor), .. } => {
            let [columns, rows] = sensor.optics.resolution;
            format!("vision sensor, {columns} × {rows} pixels")
        }
        other => other.word().to_owned(),
    }
}

//! `sincro trim`: equilibria of a scene.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Map, Value, json};
use sincro::Loaded;
use sincro::results::write_text;
use sincro_analysis::linear::Axis;
use sincro_analysis::linearize::{Trim, TrimRequest, operating_point, trim};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located};

use super::linearize::located;
use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Arguments of `trim`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file (URDF, SDF, MJCF)
    scene: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Start of the search: the state of the run at this time in seconds, brought to rest
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    from: f64,
    /// A command that may be changed: a motor (`/joint`) or a force's component; the others are as the scene gives them
    #[arg(long = "free", value_name = "NAME")]
    free: Vec<String>,
    /// A signal and the value that it must have, such as /shoulder.position=0.5
    #[arg(long = "want", value_name = "SIGNAL=VALUE")]
    want: Vec<String>,
    /// With the continuous blocks of the diagram in the loop
    #[arg(long)]
    closed_loop: bool,
    /// File to write as JSON
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print JSON instead of the summary
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let scene = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(scene) => scene,
        Err(exit) => return exit,
    };
    match compute(arguments, &scene.loaded) {
        Ok(found) => show(arguments, &found),
        Err(diagnostics) => diagnostics::refuse_diagnostics(&diagnostics),
    }
}

fn compute(arguments: &Arguments, loaded: &Loaded) -> Result<Trim, Diagnostics> {
    let wanted: Result<Vec<_>, Diagnostic> = arguments.want.iter().map(|text| wanted(text)).collect();
    let request = TrimRequest {
        free: arguments.free.iter().map(|name| located("--free", name)).collect(),
        wanted: wanted?,
        is_closed: arguments.closed_loop,
    };
    let at = operating_point(loaded, arguments.from)?;
    Ok(trim(loaded, &at, &request)?.trim)
}

fn wanted(text: &str) -> Result<(Located<String>, f64), Diagnostic> {
    let whole = located("--want", text);
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    match value.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok((Located { value: name.trim().to_owned(), at: whole.at }, x)),
        _ => Err(Diagnostic::error(&whole.at, format!("`{text}` is no signal with a value"))
            .with_help("write SIGNAL=NUMBER, such as /shoulder.position=0.5")),
    }
}

fn show(arguments: &Arguments, found: &Trim) -> Exit {
    let text = format!("{:#}", as_json(found));
    if let Some(out) = &arguments.out
        && let Err(error) = write_text(out, &format!("{text}\n"))
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.json {
        say!("{text}");
        return Exit::Holds;
    }
    let rates =
        if found.residual == 0.0 { "all rates are zero".into() } else { format!("rates up to {:.1e}", found.residual) };
    say!("equilibrium after {} steps of Newton's method; {rates}", found.iterations);
    for (title, list) in [("state", &found.states), ("commands", &found.inputs), ("wanted", &found.outputs)] {
        if !list.is_empty() {
            say!("{title}");
        }
        let width = list.iter().map(|(axis, _)| axis.name.chars().count()).max().unwrap_or(0);
        for (axis, value) in list {
            // no minus before a zero
            let value = if value.abs() < 5e-10 { 0.0 } else { *value };
            say!("  {:<width$}  {value:>16.9} {}", axis.name, axis.unit);
        }
    }
    // orientations are no states but displacements from themselves
    let lists: Vec<_> = found.initial.iter().filter(|(_, q)| q.len() > 3).collect();
    if !lists.is_empty() {
        say!("positions, as `initial` takes them");
    }
    for (joint, q) in lists {
        let numbers: Vec<String> = q.iter().map(|x| format!("{x:.9}")).collect();
        say!("  {joint}  [{}]", numbers.join(", "));
    }
    Exit::Holds
}

fn as_json(found: &Trim) -> Value {
    let table = |list: &[(Axis, f64)]| -> Value {
        let entries = list.iter().map(|(axis, x)| (axis.name.clone(), json!({"value": x, "unit": axis.unit})));
        Value::Object(entries.collect::<Map<_, _>>())
    };
    let initial = found.initial.iter().map(|(joint, q)| {
        let position = if let [one] = q[..] { json!(one) } else { json!(q) };
        (joint.clone(), json!({ "position": position }))
    });
    json!({
        "states": table(&found.states),
        "initial": Value::Object(initial.collect::<Map<_, _>>()),
        "commands": table(&found.inputs),
        "wanted": table(&found.outputs),
        "largest_rate": found.residual,
        "iterations": found.iterations,
    })
}

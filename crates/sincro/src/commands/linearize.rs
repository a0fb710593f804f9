//! `sincro linearize`: A, B, C, D of a scene, and what follows from them.

use std::path::{Path, PathBuf};

use clap::Args;
use sincro::{Loaded, linearization};
use sincro_analysis::linear::{DMatrix, lqr};
use sincro_analysis::linearize::{
    Linearization, Request, TrimRequest, linearize, linearize_sampled, open_loops, openable_signals, operating_point,
    trim,
};
use sincro_figures::linear::{Analysis, text};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};

use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Names listed at most.
const MAX_NAMED: usize = 8;

/// Arguments of `linearize`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file (URDF, SDF, MJCF)
    scene: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Time of the operating point, in seconds: the run goes there first
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    at: f64,
    /// Find an equilibrium near that point first, commands as they are (`sincro trim` can do more)
    #[arg(long)]
    equilibrium: bool,
    /// An input: a motor (`/joint`), a force's component, or with --closed-loop a signal of the diagram; all free
    /// commands unless given
    #[arg(long = "input", value_name = "NAME")]
    inputs: Vec<String>,
    /// An output: any recorded signal that depends on the state; all coordinates unless given
    #[arg(long = "output", value_name = "NAME")]
    outputs: Vec<String>,
    /// With the continuous blocks of the diagram in the loop; else the commands are held
    #[arg(long)]
    closed_loop: bool,
    /// The whole of the scene with its sampled controller, from one period of all sample times to the next: discrete
    /// poles
    #[arg(long, conflicts_with_all = ["inputs", "outputs", "closed_loop", "lqr_q"])]
    sampled: bool,
    /// With --sampled: margins of the loop that is opened at this signal, which a block of the diagram gives at ticks,
    /// or at this motor; may be repeated
    #[arg(long = "loop", value_name = "SIGNAL", requires = "sampled")]
    loops: Vec<String>,
    /// Weights of the states: design a linear-quadratic regulator with them and --lqr-r
    #[arg(long, value_name = "Q1,Q2,…", value_delimiter = ',', requires = "lqr_r")]
    lqr_q: Vec<f64>,
    /// Weights of the inputs
    #[arg(long, value_name = "R1,…", value_delimiter = ',', requires = "lqr_q")]
    lqr_r: Vec<f64>,
    /// Folder for linearization.json, bode.csv, step.csv, figures and report.html; nothing is written unless given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print linearization.json on standard output instead of the summary
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let OpenedScene { source: _source, loaded, .. } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    if arguments.sampled {
        return sampled(arguments, &loaded);
    }
    let found = match compute(arguments, &loaded) {
        Ok(found) => found,
        Err(diagnostics) => return diagnostics::refuse_diagnostics(&diagnostics),
    };
    // before anything is written
    let words = match regulator(arguments, &found) {
        Ok(words) => words,
        Err(diagnostic) => return diagnostics::refuse_diagnostics(&diagnostic.into()),
    };
    let title = format!("{}, linearised", loaded.experiment.title);
    let analysis = Analysis::of(title, &found.system).with_reduction(found.reduction.words());
    if let Some(out) = &arguments.out
        && let Err(error) = linearization::write(&analysis, Some(&found.reduction), out)
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.json {
        say!("{}", linearization::json(&analysis, Some(&found.reduction)));
    } else {
        print(&analysis, &found, arguments.out.as_deref());
    }
    if !arguments.json && !words.is_empty() {
        say!("{words}");
    }
    Exit::Holds
}

/// Linearises the sampled loop as a whole, and shows or writes it.
fn sampled(arguments: &Arguments, loaded: &Loaded) -> Exit {
    let start = || -> Result<_, Diagnostics> {
        let at = operating_point(loaded, arguments.at)?;
        let at = if arguments.equilibrium { trim(loaded, &at, &TrimRequest::default())?.at } else { at };
        let names: Vec<Located<String>> = arguments.loops.iter().map(|name| located("--loop", name)).collect();
        let loops = open_loops(loaded, &at, &names)?;
        Ok((linearize_sampled(loaded, &at)?, loops, openable_signals(loaded, &at)))
    };
    let (found, loops, openable) = match start() {
        Ok(found) => found,
        Err(diagnostics) => return diagnostics::refuse_diagnostics(&diagnostics),
    };
    let analysis = Analysis::of(format!("{}, sampled loop", loaded.experiment.title), &found.system).with_loops(&loops);
    if let Some(out) = &arguments.out
        && let Err(error) = linearization::write(&analysis, None, out)
    {
        return diagnostics::refuse_file(&error);
    }
    if arguments.json {
        say!("{}", linearization::json(&analysis, None));
        return Exit::Holds;
    }
    say!("{}", text(&analysis).trim_end());
    let ticks = if found.period == 1 { "one base step".into() } else { format!("{} base steps", found.period) };
    say!("\noperating point at {} s, period {ticks}", found.system.t);
    match found.drift {
        drift if drift < 1e-8 => say!("  an equilibrium: no state changes by more than {drift:.1e} in a period"),
        drift => say!("  no equilibrium: states change by up to {drift:.4} in a period"),
    }
    if loops.is_empty() && !openable.is_empty() {
        say!("  margins: open a loop with --loop at one of {}", quoted(&openable));
    }
    if let Some(out) = &arguments.out {
        say!("report {}", out.join("report.html").display());
    }
    Exit::Holds
}

/// Names in backticks, the first few of many.
fn quoted(names: &[String]) -> String {
    let list = names.iter().take(MAX_NAMED).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    if names.len() > MAX_NAMED { format!("{list} and {} more", names.len() - MAX_NAMED) } else { list }
}

fn compute(arguments: &Arguments, loaded: &Loaded) -> Result<Linearization, Diagnostics> {
    let mut at = operating_point(loaded, arguments.at)?;
    if arguments.equilibrium {
        at = trim(loaded, &at, &TrimRequest { is_closed: arguments.closed_loop, ..TrimRequest::default() })?.at;
    }
    let request = Request {
        inputs: arguments.inputs.iter().map(|name| located("--input", name)).collect(),
        outputs: arguments.outputs.iter().map(|name| located("--output", name)).collect(),
        is_closed: arguments.closed_loop,
    };
    linearize(loaded, &at, &request)
}

/// A text of the command line, for messages that point at it.
pub(super) fn located(flag: &str, text: &str) -> Located<String> {
    let source = std::sync::Arc::new(SourceText { path: flag.into(), text: text.to_owned() });
    Located { value: text.to_owned(), at: Location { source, span: 0..text.len() } }
}

fn print(analysis: &Analysis, found: &Linearization, out: Option<&Path>) {
    say!("{}", text(analysis).trim_end());
    say!("\noperating point at {} s", found.system.t);
    let all = [("x", &found.system.states, &found.state), ("u", &found.system.inputs, &found.input)];
    for (letter, axes, values) in all {
        for (k, (axis, value)) in axes.iter().zip(values).enumerate() {
            say!("  {letter}{} {} = {value:.6} {}", k + 1, axis.name, axis.unit);
        }
    }
    match found.drift() {
        0.0 => say!("  an equilibrium: all rates are zero"),
        drift if drift < 1e-8 => say!("  an equilibrium: no rate is above {drift:.1e}"),
        _ if found.is_steady() => say!("  a steady motion: only states with a pole at zero change"),
        drift => say!(
            "  no equilibrium: rates up to {drift:.4}. The matrices hold along the motion; --equilibrium finds a rest"
        ),
    }
    for note in &found.notes {
        say!("note: {note}");
    }
    if let Some(out) = out {
        say!("report {}", out.join("report.html").display());
    }
}

/// The gains of a regulator for the weights that are given; empty if none are.
fn regulator(arguments: &Arguments, found: &Linearization) -> Result<String, Diagnostic> {
    if arguments.lqr_q.is_empty() {
        return Ok(String::new());
    }
    let diagonal =
        |weights: &[f64]| DMatrix::from_diagonal(&sincro_analysis::linear::DVector::from_column_slice(weights));
    let system = &found.system;
    for (flag, given, wanted) in
        [("--lqr-q", arguments.lqr_q.len(), system.n_states()), ("--lqr-r", arguments.lqr_r.len(), system.n_inputs())]
    {
        if given != wanted {
            let diagnostic = Diagnostic::without_location(format!("{flag} has {given} weights for {wanted}"));
            return Err(diagnostic.with_help("give one for each state (--lqr-q) and each input (--lqr-r)"));
        }
    }
    for (flag, weights) in [("--lqr-q", &arguments.lqr_q), ("--lqr-r", &arguments.lqr_r)] {
        if let Some(weight) = weights.iter().find(|weight| !weight.is_finite()) {
            let diagnostic = Diagnostic::without_location(format!("{flag} has the weight {weight}"));
            return Err(diagnostic.with_help("weights are finite numbers"));
        }
    }
    let design = lqr(&system.a, &system.b, &diagonal(&arguments.lqr_q), &diagonal(&arguments.lqr_r))
        .map_err(|e| Diagnostic::without_location(format!("there is no regulator: {e}")))?;
    let mut words = String::from("\nlinear-quadratic regulator u = −K·x");
    for (i, input) in system.inputs.iter().enumerate() {
        let row: Vec<String> = design.k.row(i).iter().map(|x| format!("{x:?}")).collect();
        words += &format!("\n  {}: [{}]", input.name, row.join(", "));
    }
    let poles: Vec<String> = design.poles.iter().map(|m| format!("{:.4}{:+.4}i", m.re, m.im)).collect();
    words += &format!("\n  poles of the closed loop: {}", poles.join(", "));
    Ok(words)
}

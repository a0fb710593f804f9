//! `sincro dynamics`: mass matrix, inverse and forward dynamics of a scene at given states.

use std::io::BufRead;
use std::path::PathBuf;

use clap::Args;
use serde::{Deserialize, Serialize};
use sincro_analysis::dynamics::{EvaluationPoint, equation_terms};

use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Arguments of `dynamics`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file
    scene: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Read states from standard input, one JSON object a line: {"q": […], "v": […], "a": […], "tau": […]}, lists
    /// that are left out are zero; without this, the terms at the start of the scene
    #[arg(long)]
    stdin: bool,
}

/// A state as it is read.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct StateLine {
    #[serde(default)]
    q: Vec<f64>,
    #[serde(default)]
    v: Vec<f64>,
    #[serde(default)]
    a: Vec<f64>,
    #[serde(default)]
    tau: Vec<f64>,
}

/// First line of the output: the coordinates and their order.
#[derive(Debug, Serialize)]
struct Coordinates<'a> {
    n_q: usize,
    n_v: usize,
    joints: Vec<JointLine<'a>>,
}

#[derive(Debug, Serialize)]
struct JointLine<'a> {
    joint: &'a str,
    q: [usize; 2],
    v: [usize; 2],
}

/// Terms at a state, as they are printed.
#[derive(Debug, Serialize)]
struct TermsLine<'a> {
    mass_matrix: Vec<&'a [f64]>,
    inverse_dynamics: &'a [f64],
    forward_dynamics: &'a [f64],
    passive: &'a [f64],
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let OpenedScene { source: _source, loaded, .. } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    let model = &loaded.scene.model;
    let joints = model.names().joints.iter().map(|j| JointLine {
        joint: &j.name,
        q: [j.q_idx, j.q_idx + j.n_q],
        v: [j.v_idx, j.v_idx + j.n_v],
    });
    print(&Coordinates { n_q: model.n_q(), n_v: model.n_v(), joints: joints.collect() });
    if !arguments.stdin {
        let initial = &loaded.scene.initial;
        return evaluated(model, StateLine { q: initial.q.clone(), v: initial.v.clone(), ..StateLine::default() });
    }
    for line in std::io::stdin().lock().lines() {
        let Ok(line) = line else { return diagnostics::refuse("standard input cannot be read", None) };
        if line.trim().is_empty() {
            continue;
        }
        let state = match serde_json::from_str(&line) {
            Ok(state) => state,
            Err(error) => return diagnostics::refuse(&format!("a line is no state: {error}"), None),
        };
        let exit = evaluated(model, state);
        if exit != Exit::Holds {
            return exit;
        }
    }
    Exit::Holds
}

fn evaluated(model: &sincro_scene::scene::Model<f64>, state: StateLine) -> Exit {
    let at = EvaluationPoint { q: state.q, v: state.v, v_dot: state.a, torque: state.tau };
    let terms = match equation_terms(model, &at) {
        Ok(terms) => terms,
        Err(message) => return diagnostics::refuse(&message, Some("the first line of the output has the order")),
    };
    print(&TermsLine {
        mass_matrix: terms.mass_matrix.chunks(model.n_v().max(1)).collect(),
        inverse_dynamics: &terms.inverse_dynamics,
        forward_dynamics: &terms.forward_dynamics,
        passive: &terms.passive,
    });
    Exit::Holds
}

fn print(line: &impl Serialize) {
    say!("{}", serde_json::to_string(line).unwrap_or_default());
}

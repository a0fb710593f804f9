//! `sincro export fmu`: a scene for tools that import functional mock-up units.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sincro::export::{FmiVersion, FmuRequest, Kinds, Outputs, export_fmu};
use sincro::scene_name;

use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Arguments of `export fmu`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or its experiment.toml
    scene: PathBuf,
    /// Version of the standard
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: Version,
    /// Interface type: co-simulation, model exchange, or both
    #[arg(long, default_value = "cs")]
    kind: Kind,
    /// Give every signal of the scene as an output, not the recorded ones alone
    #[arg(long)]
    all: bool,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Shared library of FMUs, of this or another platform; may be repeated [default: the one beside this program]
    #[arg(long, value_name = "FILE")]
    binary: Vec<PathBuf>,
    /// FMU of the same scene and options, exported on another platform, whose libraries are taken over; may be repeated
    #[arg(long, value_name = "FMU")]
    merge: Vec<PathBuf>,
    /// File to write [default: SCENE.fmu]
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Version {
    #[value(name = "2")]
    V2,
    #[value(name = "3")]
    V3,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Kind {
    Cs,
    Me,
    Both,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let OpenedScene { source, set, loaded } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    diagnostics::print_diagnostics(&loaded.warnings);
    let name = scene_name(source.folder());
    let request = FmuRequest {
        loaded: &loaded,
        overrides: &set,
        name: &name,
        version: match arguments.fmi {
            Version::V2 => FmiVersion::V2,
            Version::V3 => FmiVersion::V3,
        },
        kinds: Kinds {
            co_simulation: !matches!(arguments.kind, Kind::Me),
            model_exchange: !matches!(arguments.kind, Kind::Cs),
        },
        outputs: if arguments.all { Outputs::All } else { Outputs::Recorded },
        binaries: &arguments.binary,
        merged: &arguments.merge,
    };
    let exported = match export_fmu(&request) {
        Ok(exported) => exported,
        Err(refused) => return diagnostics::refuse(&refused.message, refused.help.as_deref()),
    };
    let path = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.fmu")));
    if let Err(error) = sincro_sim::file::write_atomically(&path, &exported.bytes) {
        return diagnostics::refuse_file(&error);
    }
    let [parameters, inputs, outputs] = exported.counts();
    say!(
        "{}  {:.1} MB  {}  {parameters} parameters, {inputs} inputs, {outputs} outputs",
        path.display(),
        exported.bytes.len() as f64 * 1e-6,
        exported.platforms.join(", ")
    );
    Exit::Holds
}

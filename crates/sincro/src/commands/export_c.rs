//! `sincro export c`: a scene as C99, for microcontrollers and other programs.

use std::path::PathBuf;

use clap::Args;
use sincro::export_c::{Obstacle, export_c};
use sincro::scene_name;

use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Arguments of `export c`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file
    scene: PathBuf,
    /// Folder to write into [default: SCENE-c]
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// First part of the names of files and functions [default: name of the scene]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Set a number first, as in `run`; may be repeated. The step needs a method with fixed steps: integrator=rk4
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let OpenedScene { source, loaded, .. } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    diagnostics::print_diagnostics(&loaded.warnings);
    let name = arguments.name.clone().unwrap_or_else(|| scene_name(source.folder()));
    let exported = match export_c(&loaded, &name) {
        Ok(exported) => exported,
        Err(why) => {
            let message = format!("nothing of `{name}` can be compiled: {why}");
            return diagnostics::refuse(&message, Some("nothing was written"));
        }
    };
    let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}-c")));
    if let Err(error) = std::fs::create_dir_all(&folder) {
        return diagnostics::refuse(&format!("`{}` cannot be made: {error}", folder.display()), None);
    }
    for (file, text) in &exported.files {
        if let Err(error) = sincro_sim::file::write_atomically(&folder.join(file), text.as_bytes()) {
            return diagnostics::refuse_file(&error);
        }
    }
    for (part, n) in &exported.parts {
        say!("  {part:<36} {n:>7} operations");
    }
    for (part, why) in &exported.missing {
        say!("  {part:<36} not exported: {why}");
    }
    let has_error_control = |why: &Obstacle| why.to_string().contains("error control");
    if exported.missing.iter().any(|(part, why)| *part == "step" && has_error_control(why)) {
        say!("help: a step of fixed length is exported with `--set integrator=rk4` (or semi-implicit-euler)");
    }
    let steps = match exported.n_test_steps {
        0 => String::new(),
        n => format!(" over {n} steps"),
    };
    say!("{}  C99, self-test{steps} expects {:016x}", folder.display(), exported.hash);
    Exit::Holds
}

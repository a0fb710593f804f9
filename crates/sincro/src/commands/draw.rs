//! `sincro draw`: the diagram of a scene as SVG.

use std::path::PathBuf;

use clap::Args;
use sincro::results::write_text;
use sincro::scene_name;
use sincro_figures::campaign::diagram;

use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Arguments of `draw`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file (URDF, SDF, MJCF)
    scene: PathBuf,
    /// Set a number first, as in `run`; `diagram=other.toml` draws another diagram. May be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// File to write; `-` for standard output
    #[arg(long, value_name = "FILE", default_value = "diagram.svg")]
    out: PathBuf,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let OpenedScene { source, loaded, .. } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    let Some(controller) = &loaded.controller else {
        let help = "name a diagram in `experiment.toml`: diagram = \"diagram.toml\"";
        return diagnostics::refuse("the scene has no diagram", Some(help));
    };
    let svg = diagram(controller, &loaded.experiment.title, &scene_name(source.folder()), false);
    if arguments.out.as_os_str() == "-" {
        say!("{svg}");
        return Exit::Holds;
    }
    if let Err(error) = write_text(&arguments.out, &svg) {
        return diagnostics::refuse_file(&error);
    }
    say!("{}", arguments.out.display());
    Exit::Holds
}

//! `sincro draw`: the diagram of a scene as SVG.

use std::path::PathBuf;

use clap::Args;
use sincro::results::write_text;
use sincro::{load, scene_name};
use sincro_figures::campaign::diagram;

use super::run::parse_settings;
use crate::{Exit, diagnostics};

/// Arguments of `draw`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, or its experiment.toml
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
    let loaded = match parse_settings(&arguments.set).and_then(|set| load(&arguments.scene, &set)) {
        Ok(loaded) => loaded,
        Err(diagnostics) => return diagnostics::refuse_diagnostics(&diagnostics),
    };
    let Some(controller) = &loaded.controller else {
        let help = "name a diagram in `experiment.toml`: diagram = \"diagram.toml\"";
        return diagnostics::refuse("the scene has no diagram", Some(help));
    };
    let svg = diagram(controller, &loaded.experiment.title, &scene_name(&arguments.scene), false);
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

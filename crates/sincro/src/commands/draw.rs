//! `sincro draw`: the diagram of a scene as SVG.

use std::path::PathBuf;

use crate::extensions::extensions;
use clap::Args;
use sincro_scene::diagram::ControlDiagram;
use sincro_sim::load;

use super::run::{parse_settings, scene_name};
use crate::draw::{self, Options};
use crate::present::write_text;
use crate::{Exit, diagnostics};

/// What `draw` takes.
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
    let loaded = match parse_settings(&arguments.set).and_then(|set| load(&arguments.scene, &set, extensions())) {
        Ok(loaded) => loaded,
        Err(problems) => return diagnostics::refuse_problems(&problems),
    };
    let Some(controller) = &loaded.controller else {
        let help = "name a diagram in `experiment.toml`: diagram = \"diagram.toml\"";
        return diagnostics::refuse("the scene has no diagram", Some(help));
    };
    let svg = drawing(controller, &loaded.experiment.title, &scene_name(&arguments.scene), false);
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

/// A diagram as SVG: a file of its own, or for a page.
pub(crate) fn drawing(controller: &ControlDiagram, title: &str, world: &str, is_inline: bool) -> String {
    let outputs = controller.wiring.program().steps.iter().flat_map(|step| {
        let ports = step.output_names.iter().zip(&step.node.outputs);
        ports.map(|(port, width)| (format!("{}.{port}", step.path), *width))
    });
    let options = Options { title: title.to_owned(), world: world.to_owned(), is_inline, widths: outputs.collect() };
    draw::draw(&controller.diagram, &options)
}

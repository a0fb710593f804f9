//! `sincro export urdf`, `mjcf`, `sdf`: the mechanism of a scene as a robot of another format.

use std::path::PathBuf;

use clap::Args;
use sincro::scene_name;
use sincro_import::export::{Format, export};

use super::robot_file::OpenedScene;
use crate::{Exit, diagnostics};

/// Arguments of the formats of robots.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder of the scene, its experiment.toml, or a robot file
    scene: PathBuf,
    /// File to write; meshes go to `meshes` beside it
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Set a number first, as in `run`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments, format: Format) -> Exit {
    let OpenedScene { source, loaded, .. } = match OpenedScene::open(&arguments.scene, &arguments.set) {
        Ok(opened) => opened,
        Err(exit) => return exit,
    };
    let exported = match export(&loaded.scene, &scene_name(source.folder()), format) {
        Ok(exported) => exported,
        Err(reasons) => return diagnostics::refuse(&reasons.join("\n"), Some("nothing was written")),
    };
    let folder = arguments.out.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(".".as_ref());
    let written = std::fs::create_dir_all(folder).and_then(|()| {
        for (name, bytes) in &exported.meshes {
            let path = folder.join(name);
            std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
            std::fs::write(path, bytes)?;
        }
        std::fs::write(&arguments.out, &exported.text)
    });
    if let Err(error) = written {
        return diagnostics::refuse(&format!("`{}` cannot be written: {error}", arguments.out.display()), None);
    }
    for (object, words) in &exported.notes {
        say!("  {object}: {words}");
    }
    say!("{}, {} not said in it", arguments.out.display(), diagnostics::count(exported.notes.len(), "thing"));
    Exit::Holds
}

//! `sincro new`: a scene folder to start from.

use std::fs;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sincro_sim::file::FileError;

use crate::{Exit, diagnostics};

/// Arguments of `new`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder to be made
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Scene that it starts with
    #[arg(long, value_enum, default_value_t = Template::Arm)]
    template: Template,
}

/// Scenes to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Template {
    /// A planar arm with two servos.
    Arm,
    /// A pole on a cart, with a diagram that holds it upright.
    CartPole,
    /// A quadrotor that hovers.
    Quadrotor,
    /// A robot on two wheels.
    Mobile,
    /// A ball on a floor.
    Empty,
}

/// A file of a template: name and text.
type File = (&'static str, &'static str);

macro_rules! template {
    ($folder:literal, $($name:literal),+) => {
        &[$(($name, include_str!(concat!("../../templates/", $folder, "/", $name)))),+]
    };
}

impl Template {
    fn files(self) -> &'static [File] {
        match self {
            Self::Arm => template!("arm", "experiment.toml", "scene.toml"),
            Self::CartPole => template!("cart-pole", "experiment.toml", "scene.toml", "controller.toml"),
            Self::Quadrotor => template!("quadrotor", "experiment.toml", "scene.toml"),
            Self::Mobile => template!("mobile", "experiment.toml", "scene.toml"),
            Self::Empty => template!("empty", "experiment.toml", "scene.toml"),
        }
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    let folder = &arguments.folder;
    let is_used = fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
    if is_used {
        let message = format!("the folder `{}` is not empty", folder.display());
        return diagnostics::refuse(&message, Some("name a folder that is not there yet"));
    }
    let made = fs::create_dir_all(folder).map_err(|e| FileError::new("create the folder", folder, e));
    if let Err(error) = made {
        return diagnostics::refuse(&error.to_string(), Some("name another folder"));
    }
    for (name, text) in arguments.template.files() {
        let path = folder.join(name);
        if let Err(error) = fs::write(&path, text) {
            let error = FileError::new("write", &path, error);
            return diagnostics::refuse(&error.to_string(), Some("name another folder"));
        }
        say!("{}", path.display());
    }
    let shown = folder.display();
    say!("run it: sincro run {shown}");
    say!("look at it: sincro view {shown}");
    Exit::Holds
}

//! `sincro schema`, `sincro completions` and `sincro man`: what editors, shells and `man` know of sincro.

use std::fs;
use std::path::PathBuf;

use clap::Args;
#[cfg(feature = "cli")]
use clap::Command;
#[cfg(feature = "cli")]
use clap_complete::Shell;
use sincro_scene::diagram::diagram_schema;
use sincro_scene::experiment::experiment_schema;
use sincro_scene::scene::scene_schema;
use sincro_scene::schema::for_editors;
use sincro_sim::file::{FileError, write_atomically};

use crate::{Exit, diagnostics};

/// Arguments of `schema`.
#[derive(Debug, Args)]
pub(crate) struct SchemaArguments {
    /// Folder of your scenes: gets `schemas` and a `.taplo.toml`, which editors with a TOML extension look for
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
    /// Print one schema instead: scene, experiment or diagram
    #[arg(long, value_name = "FILE", value_parser = ["scene", "experiment", "diagram"])]
    print: Option<String>,
}

#[cfg(feature = "cli")]
/// Arguments of `completions`.
#[derive(Debug, Args)]
pub(crate) struct CompletionArguments {
    /// Shell that completes
    shell: Shell,
}

#[cfg(feature = "cli")]
/// Arguments of `man`.
#[derive(Debug, Args)]
pub(crate) struct ManArguments {
    /// Folder to write the pages of all commands into; without it, the page of `sincro` is printed
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// Rules by which editors choose a schema.
const RULES: &str = r#"# Schemas of sincro, written by `sincro schema`.
[[rule]]
include = ["**/experiment.toml"]
[rule.schema]
path = "schemas/experiment.schema.json"

[[rule]]
include = ["**/scene.toml"]
[rule.schema]
path = "schemas/scene.schema.json"

[[rule]]
include = ["**/controller.toml", "**/diagram.toml"]
[rule.schema]
path = "schemas/diagram.schema.json"
"#;

/// Writes the schemas, or prints one.
pub(crate) fn schema(arguments: &SchemaArguments) -> Exit {
    let all = [("scene", scene_schema()), ("experiment", experiment_schema()), ("diagram", diagram_schema())];
    let text = |schema| format!("{:#}\n", for_editors(schema));
    if let Some(name) = &arguments.print {
        for (_, schema) in all.iter().filter(|(known, _)| known == name) {
            say!("{}", text(schema).trim_end());
        }
        return Exit::Holds;
    }
    let folder = arguments.folder.join("schemas");
    let write = || -> Result<(), FileError> {
        fs::create_dir_all(&folder).map_err(|e| FileError::new("create the folder", &folder, e))?;
        for (name, schema) in all {
            let path = folder.join(format!("{name}.schema.json"));
            write_atomically(&path, text(schema).as_bytes())?;
            say!("{}", path.display());
        }
        let rules = arguments.folder.join(".taplo.toml");
        // one that is there belongs to somebody
        let is_own = fs::read_to_string(&rules).is_ok_and(|text| text.starts_with("# Schemas of sincro"));
        if !rules.exists() || is_own {
            write_atomically(&rules, RULES.as_bytes())?;
            say!("{}", rules.display());
        }
        Ok(())
    };
    match write() {
        Ok(()) => Exit::Holds,
        Err(error) => diagnostics::refuse(&error.to_string(), Some("name another folder")),
    }
}

#[cfg(feature = "cli")]
/// Prints the completions of a shell.
pub(crate) fn completions(arguments: &CompletionArguments, mut command: Command) -> Exit {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "sincro", &mut text);
    say!("{}", String::from_utf8_lossy(&text).trim_end());
    Exit::Holds
}

#[cfg(feature = "cli")]
/// Prints the manual page, or writes those of all commands.
pub(crate) fn man(arguments: &ManArguments, command: Command) -> Exit {
    let Some(folder) = &arguments.folder else {
        let mut text = Vec::new();
        return match clap_mangen::Man::new(command).render(&mut text) {
            Ok(()) => {
                say!("{}", String::from_utf8_lossy(&text).trim_end());
                Exit::Holds
            }
            Err(error) => diagnostics::refuse(&error.to_string(), None),
        };
    };
    let written = fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(command, folder));
    match written {
        Ok(()) => {
            say!("{}", folder.join("sincro.1").display());
            Exit::Holds
        }
        Err(error) => {
            diagnostics::refuse(&FileError::new("write", folder, error).to_string(), Some("name another folder"))
        }
    }
}

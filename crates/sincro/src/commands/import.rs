//! `sincro import`: a robot from another format as a scene folder, with the report of every element.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use sincro_import::{Imported, Motors, Options, Repair, Report, import};

use super::console::short;
use crate::{Exit, diagnostics};

/// Arguments of `import`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Robot: FILE.urdf, FILE.urdf.xacro, FILE.sdf, FILE.xml (MJCF)
    file: PathBuf,
    /// Folder of the scene; it must be absent, empty, or one that was imported before
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Folder in which packages are searched, before ROS_PACKAGE_PATH and AMENT_PREFIX_PATH; may be repeated
    #[arg(long, value_name = "DIR")]
    package_path: Vec<PathBuf>,
    /// Base of the robot: fixed in the world, or free to move
    #[arg(long, value_enum, default_value = "fixed")]
    base: Base,
    /// Drives of joints where the source names no actuators
    #[arg(long, value_enum, default_value = "hold")]
    motors: MotorsArgument,
    /// Repair what no robot can have; may be repeated
    #[arg(long, value_enum, value_name = "NAME")]
    repair: Vec<RepairArgument>,
    /// Make links on fixed joints parts of the bodies that carry them; frames of their names stay
    #[arg(long)]
    merge_fixed: bool,
    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    json: bool,
}

/// Base of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Base {
    /// Fixed in the world
    Fixed,
    /// With six degrees of freedom
    Free,
}

/// Drives of joints.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum MotorsArgument {
    /// Position motors that hold the joints where they start
    Hold,
    /// Torque motors
    Torque,
    /// No motors
    None,
}

/// Repairs.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum RepairArgument {
    /// Gives moving links without mass or inertia a small one
    MinInertia,
    /// Raises principal moments that are not positive
    PositiveInertia,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Exit {
    if let Some(refused) = occupied(&arguments.out) {
        return refused;
    }
    let options = Options {
        package_paths: arguments.package_path.clone(),
        free_base: arguments.base == Base::Free,
        motors: match arguments.motors {
            MotorsArgument::Hold => Motors::Hold,
            MotorsArgument::Torque => Motors::Torque,
            MotorsArgument::None => Motors::None,
        },
        repairs: arguments
            .repair
            .iter()
            .map(|repair| match repair {
                RepairArgument::MinInertia => Repair::MinInertia,
                RepairArgument::PositiveInertia => Repair::PositiveInertia,
            })
            .collect(),
        merge_fixed: arguments.merge_fixed,
    };
    let imported = match import(&arguments.file, &options) {
        Ok(imported) => imported,
        Err(found) => return diagnostics::refuse_import(&found),
    };
    if let Err(error) = clear(&arguments.out).and_then(|()| imported.write(&arguments.out)) {
        return diagnostics::refuse(&format!("`{}` cannot be written: {error}", arguments.out.display()), None);
    }
    if arguments.json {
        say!("{}", imported.report.json());
    } else {
        diagnostics::print_diagnostics(&imported.warnings);
        summarize(&imported, &arguments.out);
    }
    Exit::Holds
}

/// Refuses a folder that holds anything but an import.
fn occupied(out: &Path) -> Option<Exit> {
    let mut entries = match std::fs::read_dir(out) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return None,
        Err(error) => return Some(diagnostics::refuse(&format!("`{}` is no folder: {error}", out.display()), None)),
    };
    let is_import = out.join("import-report.json").is_file();
    (entries.next().is_some() && !is_import).then(|| {
        let message = format!("the folder `{}` holds something else than an import", out.display());
        diagnostics::refuse(&message, Some("name a folder that is absent or empty"))
    })
}

/// Removes the files of an earlier import.
fn clear(out: &Path) -> std::io::Result<()> {
    if !out.join("import-report.json").is_file() {
        return Ok(());
    }
    for name in ["scene.toml", "experiment.toml", "import-report.html", "import-report.json"] {
        let path = out.join(name);
        if path.is_file() {
            std::fs::remove_file(path)?;
        }
    }
    let meshes = out.join("meshes");
    if meshes.is_dir() { std::fs::remove_dir_all(meshes) } else { Ok(()) }
}

fn summarize(imported: &Imported, out: &Path) {
    let Report { robot, counts, comparison, repairs, choices, missing_collision_meshes, .. } = &imported.report;
    let value = |name: &str| comparison.iter().find(|c| c.quantity == name).map_or(0.0, |c| c.after);
    say!(
        "{robot}: {}, {}, {} kg, reach {} m",
        diagnostics::count(value("links") as usize, "link"),
        super::console::degrees(value("degrees of freedom") as usize),
        short(value("total mass")),
        short(value("reach"))
    );
    say!("  {} elements kept, {} changed, {} dropped", counts.kept, counts.changed, counts.dropped);
    for repair in repairs {
        say!("  repaired ({}): link `{}`, {}", repair.repair, repair.link, repair.what);
    }
    for choice in choices {
        say!("  {choice}");
    }
    for difference in imported.report.differences() {
        say!("  differs from the source: {difference}");
    }
    for missing in missing_collision_meshes {
        say!("  missing collision mesh: {missing}");
    }
    say!("  scene {}, report {}", out.display(), out.join("import-report.html").display());
}

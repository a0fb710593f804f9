//! Robots from URDF, SDF and MJCF files as scene folders, with a report of every element.
//!
//! Nothing is lost in silence: an element that no reader asks for is reported as dropped, a repair is made only if it
//! is
//! asked for, and the report compares mass, degrees of freedom, inertia and reach of the source with those of the scene
//! that was written and read again.
//!
//! | module | content |
//! |---|---|
//! | `source` | documents, and the ledger of what was read of them |
//! | `robot` | the intermediate description that every reader fills |
//! | `urdf`, `sdf`, `mjcf` | readers |
//! | `merge` | links on fixed joints as parts of what carries them, on request |
//! | `policy` | mass properties that no robot can have |
//! | `mesh`, `resolve` | meshes, and where they are |
//! | `writer` | the scene folder |
//! | [`report`] | the import report |
//! | [`export`] | scenes as URDF, MJCF and SDF |
//!
//! ```
//! # let folder = std::env::temp_dir().join(format!("sincro-import-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! let file = folder.join("pendulum.urdf");
//! std::fs::write(&file, r#"<robot name="pendulum">
//!   <link name="base"/>
//!   <link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
//!     <inertia ixx="0.2" iyy="0.2" izz="0.01"/></inertial></link>
//!   <joint name="pivot" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint>
//! </robot>"#)?;
//! let imported = sincro_import::import(&file, &sincro_import::Options::default())?;
//! imported.write(&folder.join("scene"))?;
//! assert_eq!(imported.report.counts.dropped, 0);
//! assert!(imported.report.differences().is_empty());
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod color;
pub mod export;
mod findings;
mod merge;
mod mesh;
mod mjcf;
mod number;
mod path_mass;
mod policy;
pub mod report;
mod resolve;
mod robot;
mod sdf;
mod source;

mod urdf;
mod verify;
mod writer;
mod xacro;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::parallel;

pub use report::Report;
pub use source::{ElementStatus, Entry};

use findings::Findings;
use mesh::Content;
use report::{Counts, Warning};
use resolve::Resolver;
use source::{Element, Ledger, SourceFile};

/// Most links, joints and geoms of a file: what is larger is no robot.
const MAX_LINKS: usize = 20_000;

/// Motors that an import gives the joints where the source names no actuators.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motors {
    /// Position motors that hold the joints at their initial positions.
    #[default]
    Hold,
    /// Torque motors, whose command is zero.
    Torque,
    /// No motors: the joints move freely.
    None,
}

/// Repair of mass properties that no rigid body has; made only if [`Options::repairs`] asks for it, and reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repair {
    /// Gives moving links without mass or inertia a small one, so that the mass matrix is regular.
    MinInertia,
    /// Raises principal moments of inertia that are not positive to small positive ones.
    PositiveInertia,
}

impl Repair {
    /// All repairs, in the order of the command line's help.
    pub const ALL: [Self; 2] = [Self::MinInertia, Self::PositiveInertia];

    /// Name of the repair on the command line, for `--repair`: `min-inertia`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::MinInertia => "min-inertia",
            Self::PositiveInertia => "positive-inertia",
        }
    }
}

/// Options of [`import`]. By default the base is fixed, joints are held and nothing is repaired.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Folders in which `package://` addresses of meshes are searched, in this order, before those of the environment.
    pub package_paths: Vec<PathBuf>,
    /// True if the base link moves freely, by a joint of six degrees of freedom; else it is fixed in the world.
    pub free_base: bool,
    /// Motors of joints for which the source names no actuator.
    pub motors: Motors,
    /// Repairs of mass properties that may be made; without them such a robot is refused.
    pub repairs: Vec<Repair>,
    /// True if links on fixed joints become parts of the bodies that carry them; frames of their names stay.
    pub merge_fixed: bool,
}

/// Robot as a scene folder in memory with the report of its import: the result of [`import`].
#[derive(Debug)]
pub struct Imported {
    /// Status of every element of the source, comparison with the scene, warnings.
    pub report: Report,
    /// Warnings with their places in the source, in its order.
    pub warnings: Vec<Diagnostic>,
    scene: String,
    experiment: String,
    files: BTreeMap<String, Content>,
}

/// Returns true for a file that [`import`] reads, by the ending of its name: `.urdf`, `.xacro`, `.sdf`, `.world`,
/// `.mjcf` or `.xml`, in any case.
#[must_use]
pub fn is_robot_file(path: &Path) -> bool {
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().to_lowercase());
    [".urdf", ".xacro", ".sdf", ".xml", ".mjcf", ".world"].iter().any(|ending| name.ends_with(ending))
}

/// Reads a robot from a URDF, xacro, SDF or MJCF file and makes a scene folder of it, in memory; [`Imported::write`]
/// writes it. The head of this crate has an example.
///
/// # Errors
///
/// Everything that keeps the robot from being a scene, each with its file and line: the file cannot be read, is no
/// robot, refers to what is not there, or has mass properties that no body has.
pub fn import(path: &Path, options: &Options) -> Result<Imported, Diagnostics> {
    let main = if path.to_string_lossy().to_lowercase().ends_with(".xacro") {
        xacro::expanded(path)?
    } else {
        SourceFile::read(path)?
    };
    let files = if main.parse()?.root_element().has_tag_name("mujoco") { mjcf::load(main)? } else { vec![main] };
    let documents = files.iter().map(SourceFile::parse).collect::<Result<Vec<_>, _>>()?;
    for (document, file) in documents.iter().zip(&files) {
        let is_link = |n: &roxmltree::Node<'_, '_>| matches!(n.tag_name().name(), "link" | "body" | "joint" | "geom");
        if let Some(one) = document.descendants().filter(is_link).nth(MAX_LINKS) {
            let message = format!("more than {MAX_LINKS} links and joints");
            return Err(Diagnostic::error(&file.location(one.range().start..one.range().start + 1), message).into());
        }
    }
    let ledger = Ledger::default();
    let mut findings = Findings::default();
    let root = Element::root(&documents[0], 0, &files[0], &ledger);
    let (format, mut robot, reason) = match root.name() {
        "robot" => ("URDF", urdf::read(root, &mut findings), urdf::reason as source::Reason),
        "sdf" => ("SDF", sdf::read(root, &mut findings), sdf::reason as source::Reason),
        "mujoco" => {
            let roots = files
                .iter()
                .enumerate()
                .map(|(k, file)| (file.text.path.clone(), Element::root(&documents[k], k, file, &ledger)));
            let roots: Vec<_> = roots.collect();
            ("MJCF", mjcf::read(root, &roots, &mut findings), mjcf::reason as source::Reason)
        }
        other => {
            let help = "robots are `robot` (URDF), `sdf` (SDF) or `mujoco` (MJCF)";
            return Err(root.error(format!("`{other}` is no robot")).with_help(help).into());
        }
    };
    if findings.0.any_error() {
        return Err(findings.0.sorted());
    }
    let merged = if options.merge_fixed { merge::merge_fixed(&mut robot, &ledger) } else { Vec::new() };
    let source_robot = robot.clone();
    let repairs = policy::check(&mut robot, options, &mut findings);
    if findings.0.any_error() {
        return Err(findings.0.sorted());
    }
    let resolver = Resolver::new(&files[0].folder(), &options.package_paths);
    let context = writer::Context { options, resolver: &resolver, ledger: &ledger, file: path, format };
    let written = writer::write(&mut robot, &context);
    for (at, words) in &written.warnings {
        findings.warn(Diagnostic::error(at, words.clone()));
    }
    let elements = ledger.entries(&documents, &files, reason);
    let warnings = findings.0.sorted().0;
    let report = Report {
        sincro: env!("CARGO_PKG_VERSION"),
        source: path.display().to_string(),
        format,
        robot: robot.name.clone(),
        counts: Counts::of(&elements),
        comparison: Vec::new(),
        links: Vec::new(),
        repairs,
        choices: choices(&written.choices, &merged),
        warnings: warnings.iter().map(Warning::from).collect(),
        missing_collision_meshes: written.missing_collisions.clone(),
        elements,
    };
    let (scene, experiment, files) = (written.scene, written.experiment, written.files);
    let mut imported = Imported { report, warnings, scene, experiment, files };
    verify::compare(&mut imported, &source_robot, &written.link_paths, options)?;
    Ok(imported)
}

/// Choices of the writer, and what was merged on request.
fn choices(of_writer: &[String], merged: &[String]) -> Vec<String> {
    let of_merging = match merged {
        [] => None,
        [one] => Some(format!("link `{one}` is merged into the body that carries it; a frame stays (--merge-fixed)")),
        many => Some(format!(
            "{} links are merged into the bodies that carry them; frames stay (--merge-fixed): `{}`",
            many.len(),
            many.join("`, `")
        )),
    };
    of_writer.iter().cloned().chain(of_merging).collect()
}

impl Imported {
    /// Text of the scene file, `scene.toml`.
    #[must_use]
    pub fn scene(&self) -> &str {
        &self.scene
    }

    /// Writes the scene folder (scene, experiment, meshes) with the import report as JSON and HTML; the folder is made
    /// if it does not exist, files of these names are replaced.
    ///
    /// # Errors
    ///
    /// A file cannot be written or copied; others are there.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        self.write_scene(folder)?;
        std::fs::write(folder.join("import-report.json"), self.report.json())?;
        std::fs::write(folder.join("import-report.html"), self.report.html())
    }

    /// Writes the texts of the scene folder.
    fn write_texts(&self, folder: &Path) -> io::Result<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join("scene.toml"), &self.scene)?;
        std::fs::write(folder.join("experiment.toml"), &self.experiment)
    }

    /// Writes what a run needs.
    fn write_scene(&self, folder: &Path) -> io::Result<()> {
        self.write_texts(folder)?;
        for name in self.files.keys() {
            std::fs::create_dir_all(folder.join(name).parent().unwrap_or(folder))?;
        }
        let files: Vec<_> = self.files.iter().collect();
        let written = parallel::map(files.len(), |k| {
            let (name, content) = files[k];
            match content {
                Content::Bytes(bytes) => std::fs::write(folder.join(name), &**bytes),
                Content::Copy(from) => std::fs::copy(from, folder.join(name)).map(|_| ()),
            }
        });
        written.into_iter().collect()
    }
}

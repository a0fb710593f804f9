//! Exporting a scene as an FMU: with the shared library beside this program, and a page of documentation.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sincro_fmu::archive::{ArchiveFile, unpack};
use sincro_fmu::variables::Role;
use sincro_fmu::{Catalogue, ExportRequest, export};
use sincro_scene::overrides::Override;
use sincro_sim::Loaded;

pub use sincro_fmu::{Exported, FmiVersion, Kinds, Outputs};

/// Scene to be exported as an FMU, with the choices of the export: the argument of [`export_fmu`].
#[derive(Debug)]
pub struct FmuRequest<'a> {
    /// Loaded scene, from [`load`](crate::load).
    pub loaded: &'a Loaded,
    /// Overrides that the scene was loaded with.
    pub overrides: &'a [Override],
    /// Name of the model, usually [`scene_name`](crate::scene_name).
    pub name: &'a str,
    /// Version of the FMI standard.
    pub version: FmiVersion,
    /// Interface types that the FMU offers: co-simulation, model exchange or both.
    pub kinds: Kinds,
    /// Signals that become outputs.
    pub outputs: Outputs,
    /// Paths of the shared libraries of `sincro-fmi`, one for each platform; empty for the one beside this program.
    pub binaries: &'a [PathBuf],
    /// Paths of FMUs whose libraries are packed too, to serve several platforms.
    pub merged: &'a [PathBuf],
}

/// Refusal of an export by [`export_fmu`]; nothing is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// Reason, with the file or element concerned.
    pub message: String,
    /// Advice on what to change, if there is any.
    pub help: Option<String>,
}

impl From<String> for Refused {
    fn from(message: String) -> Self {
        Self { message, help: None }
    }
}

/// Packs a scene as an FMU in memory ([`Exported::bytes`] is the content of the `.fmu` file), with a page of
/// documentation.
///
/// # Errors
///
/// There is no shared library beside this program and none is named, a file cannot be read, a library is of an unknown
/// or a repeated platform, or model exchange is asked for and the scene switches.
pub fn export_fmu(request: &FmuRequest<'_>) -> Result<Exported, Refused> {
    let FmuRequest { loaded, overrides, name, version, kinds, outputs, .. } = *request;
    let mut libraries = Vec::new();
    for path in request.binaries {
        libraries.push(read(path)?);
    }
    if request.binaries.is_empty() {
        libraries.push(own_library()?);
    }
    for path in request.merged {
        let files = unpack(&read(path)?).map_err(|why| format!("`{}`: {why}", path.display()))?;
        libraries.extend(files.into_iter().filter(|(name, _)| name.starts_with("binaries/")).map(|(_, bytes)| bytes));
    }
    let catalogue =
        Catalogue::new(loaded, overrides, outputs, kinds.model_exchange).map_err(|found| found.to_string())?;
    let documentation: [ArchiveFile; 1] = [("index.html".into(), page(loaded, name, &catalogue).into_bytes())];
    let libraries = &libraries;
    let documentation = &documentation;
    let request = ExportRequest { loaded, overrides, name, version, kinds, outputs, libraries, documentation };
    Ok(export(&request)?)
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("`{}` cannot be read: {error}", path.display()))
}

/// The shared library beside this program.
fn own_library() -> Result<Vec<u8>, Refused> {
    let name = format!("{}sincro_fmi{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let program = std::env::current_exe().ok();
    let folder = program.as_deref().and_then(Path::parent).unwrap_or(Path::new("."));
    // programs in `deps` are tests
    let places = [folder.join(&name), folder.join("..").join(&name)];
    let found = places.iter().find(|path| path.is_file());
    found.map_or_else(
        || {
            Err(Refused {
                message: format!("the shared library of FMUs, `{name}`, is not beside this program"),
                help: Some("`cargo build --release -p sincro-fmi` builds it; or name one with --binary".to_owned()),
            })
        },
        |path| Ok(read(path)?),
    )
}

/// Page of documentation: title, picture of the start, variables.
fn page(loaded: &Loaded, name: &str, catalogue: &Catalogue) -> String {
    let escape = sincro_figures::plot::escape;
    let experiment = &loaded.experiment;
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{0}</title>\n<style>body{{font:16px sans-serif;\
         max-width:60em;margin:2em auto;padding:0 1em}}table{{border-collapse:collapse}}td,th{{border:1px solid #bbb;\
         padding:.2em .6em;text-align:left}}</style>\n<h1>{0}</h1>\n<p>{1}</p>\n",
        escape(&experiment.title),
        escape(&experiment.description)
    );
    if let Some(picture) = picture(loaded) {
        let _ = writeln!(html, "<p>{picture}</p>");
    }
    let _ = writeln!(
        html,
        "<p>Model <code>{}</code>, exported by sincro {}. Base step {} s: communication steps are whole multiples of it.</p>",
        escape(name),
        env!("CARGO_PKG_VERSION"),
        experiment.step
    );
    html.push_str("<table><tr><th>variable</th><th>kind</th><th>unit</th><th>start</th><th>description</th></tr>\n");
    for variable in &catalogue.variables {
        let kind = match variable.role {
            Role::Time => "time",
            Role::Fixed(_) => "parameter",
            Role::Tunable(..) => "tunable parameter",
            Role::Input(_) => "input",
            Role::Output(_) => "output",
            Role::State(_) => "state",
            Role::Derivative(_) => "derivative",
        };
        let start = variable.start.map_or_else(String::new, |x| format!("{x}"));
        let _ = writeln!(
            html,
            "<tr><td><code>{}</code></td><td>{kind}</td><td>{}</td><td>{start}</td><td>{}</td></tr>",
            escape(&variable.name),
            escape(&variable.unit),
            escape(&variable.description)
        );
    }
    html.push_str("</table>\n</html>\n");
    html
}

/// Picture of the scene at the start, as SVG; none if nothing of it can be seen.
fn picture(loaded: &Loaded) -> Option<String> {
    let model = &loaded.scene.model;
    let mut lockstep = sincro_sim::run::LockStep::new(loaded, sincro_sim::run::method_for(loaded).0, false);
    let mut trajectory = sincro_sim::replay::Trajectory::new(model, &loaded.experiment);
    trajectory.record(&lockstep.observe(0.0).0, 0, 0.0, None);
    let view = sincro_sim::replay::SceneView::new(&loaded.scene);
    let size = (640.0, 400.0);
    (trajectory.n_frames() > 0).then(|| sincro_viewer::picture::still(&view, trajectory.frame(0), size))
}

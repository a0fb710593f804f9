//! The scene that was written, read again by the scene reader, and compared with the source.

use std::sync::Arc;

use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::fmu::Loaders;
use sincro_scene::folder::Folder;
use sincro_scene::scene::{Object, ObjectKind, Scene};

use crate::mesh::Content;
use crate::report::{Comparison, LinkComparison};
use crate::robot::Robot;
use crate::{Imported, Options, policy};

/// Reads the scene again from a temporary folder, and fills the report's comparison.
///
/// # Errors
///
/// The scene is refused.
pub(crate) fn compare(
    imported: &mut Imported,
    source: &Robot,
    link_paths: &[Option<String>],
    options: &Options,
) -> Result<(), Diagnostics> {
    let folder = Temporary::new().map_err(|e| Diagnostic::without_location(format!("no temporary folder: {e}")))?;
    imported
        .write_texts(&folder.0)
        .map_err(|e| Diagnostic::without_location(format!("the scene cannot be written: {e}")))?;
    let files = Arc::new(Folder::new(&folder.0));
    for (name, content) in &imported.files {
        let bytes = match content {
            Content::Bytes(bytes) => bytes.clone(),
            Content::Copy(from) => Arc::new(std::fs::read(from).map_err(|e| {
                Diagnostic::without_location(format!("the mesh `{}` cannot be read: {e}", from.display()))
            })?),
        };
        if name.ends_with(".csv") {
            // heights are text, which is read from the folder
            let path = folder.0.join(name);
            let parent = path.parent().map_or(Ok(()), std::fs::create_dir_all);
            parent
                .and_then(|()| std::fs::write(&path, &**bytes))
                .map_err(|e| Diagnostic::without_location(format!("the heights `{name}` cannot be written: {e}")))?;
            continue;
        }
        files.keep(name, bytes);
    }
    let opened = sincro_scene::open::open_in(&files, &[], Loaders::default(), true).map_err(refused)?;
    let scene = &opened.scene;
    let report = &mut imported.report;
    let dofs = source.joints.iter().map(|j| j.kind.dofs()).sum::<usize>();
    let roots = (0..source.links.len()).filter(|k| source.joint_of(*k).is_none()).count();
    let dofs = dofs + if options.free_base && report.format != "MJCF" { 6 * roots } else { 0 };
    let before: f64 = source.links.iter().filter_map(|l| l.inertial).map(|i| i.mass).sum();
    let after: f64 = scene.objects.iter().filter_map(mass_of).map(|(m, _)| m).sum();
    report.comparison = vec![
        Comparison::new("total mass", "kg", before, after),
        Comparison::new("degrees of freedom", "", dofs as f64, scene.model.n_v() as f64),
        Comparison::new("reach", "m", source_reach(source), scene_reach(scene, link_paths)),
        Comparison::new("links", "", named(source), written_links(source, link_paths, scene)),
    ];
    for (link, path) in source.links.iter().zip(link_paths).filter(|(link, _)| !link.is_virtual) {
        let before = link.inertial.map(|i| (i.mass, policy::properties(&i).principal_moments()));
        let before = before.filter(|(m, i)| *m != 0.0 || *i != [0.0; 3]);
        let after = path.as_ref().and_then(|path| scene.object(path)).and_then(mass_of);
        report.links.push(LinkComparison::new(&link.name, &link.at, before, after));
    }
    Ok(())
}

/// The robot is refused by what the scene reader says, in words of the source.
fn refused(found: Diagnostics) -> Diagnostics {
    let only_errors = found.0.into_iter().filter(Diagnostic::is_error);
    Diagnostics(
        only_errors
            .map(|diagnostic| {
                let massless = diagnostic.message.contains("moves no inertia");
                let help = if massless {
                    Some("give its link an inertia, or let `--repair min-inertia` do it".to_owned())
                } else {
                    diagnostic.help.clone()
                };
                let message = format!("the scene of this robot is refused: {}", diagnostic.message);
                Diagnostic { help, ..Diagnostic::without_location(message) }
            })
            .collect(),
    )
}

fn named(source: &Robot) -> f64 {
    source.links.iter().filter(|l| !l.is_virtual).count() as f64
}

fn written_links(source: &Robot, paths: &[Option<String>], scene: &Scene) -> f64 {
    let all = source.links.iter().zip(paths).filter(|(link, _)| !link.is_virtual);
    all.filter(|(_, path)| path.as_ref().is_some_and(|path| scene.object(path).is_some())).count() as f64
}

fn mass_of(object: &Object) -> Option<(f64, [f64; 3])> {
    match &object.kind {
        ObjectKind::Body { mass } => Some((mass.mass, mass.principal_moments())),
        _ => None,
    }
}

/// Longest sum of the distances between the frames of a chain, at zero coordinates `[m]`.
fn source_reach(source: &Robot) -> f64 {
    let mut reach = vec![f64::NAN; source.links.len()];
    let joint_of = source.carriers();
    for start in 0..source.links.len() {
        let mut chain = vec![start];
        while let Some(parent) = joint_of[*chain.last().unwrap_or(&start)].and_then(|j| source.joints[j].parent) {
            if !reach[parent].is_nan() || chain.len() > source.links.len() {
                break;
            }
            chain.push(parent);
        }
        for link in chain.into_iter().rev() {
            let own = norm(source.links[link].pose.position);
            let joint = joint_of[link].map(|j| &source.joints[j]);
            let fixed = joint.is_some_and(|j| j.kind.dofs() == 0);
            let before = joint.and_then(|j| j.parent).map_or(0.0, |p| reach[p]);
            reach[link] = before
                + match joint {
                    // the place of a fixed joint and that of its link are one
                    Some(j) if fixed => norm(j.pose.then(&source.links[link].pose).position),
                    Some(j) => norm(j.pose.position) + own,
                    None => own,
                };
        }
    }
    reach.into_iter().fold(0.0, f64::max)
}

fn scene_reach(scene: &Scene, link_paths: &[Option<String>]) -> f64 {
    let mut reach: Vec<f64> = Vec::with_capacity(scene.objects.len());
    for object in &scene.objects {
        let before = object.parent.map_or(0.0, |p| reach[p]);
        reach.push(before + norm(object.pose.pos.0));
    }
    let is_link = |object: &Object| link_paths.iter().flatten().any(|path| *path == object.path);
    let of_links = scene.objects.iter().zip(&reach).filter(|(object, _)| is_link(object));
    of_links.fold(0.0, |most, (_, x)| f64::max(most, *x))
}

fn norm([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// A folder that is removed when it is let go.
#[derive(Debug)]
struct Temporary(std::path::PathBuf);

impl Temporary {
    fn new() -> std::io::Result<Self> {
        use std::sync::atomic::{AtomicU64, Ordering};
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("sincro-import-{}-{count}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

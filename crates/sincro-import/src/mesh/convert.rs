//! Conversion of mesh files for their uses, several files at a time; the result does not depend on how many.

use std::path::{Path, PathBuf};

use sincro_dynamics::geometry::polyhedron;
use sincro_scene::parallel;

use super::hull::reduced_hull;
use super::{MAX_BYTES, Part, extension, is_native, read, stl, stl_size};
use crate::number;

/// Corners of a file beyond which its hull is written in its place.
const SMALL: usize = 512;

/// Mesh for one use, before its files have names.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Converted {
    /// STL files that stand for it, with the colours of their materials; none if a copy of the file does.
    pub pieces: Vec<(Vec<u8>, Option<[u8; 3]>)>,
    /// Ending of their names' stem.
    pub suffix: &'static str,
    /// Description of the conversion; none for a copy.
    pub change: Option<String>,
}

/// Uses of a file: true if it shows, false if its hull touches, and its factors.
pub(super) type Uses = (PathBuf, Vec<(bool, [f64; 3])>);

/// Converts files, each read once: for each of them the results of its uses, in their order.
pub(super) fn files(files: &[Uses]) -> Vec<Vec<Result<Converted, String>>> {
    parallel::map(files.len(), |k| file(&files[k].0, &files[k].1))
}

/// Converts one file for each of its uses.
fn file(path: &Path, uses: &[(bool, [f64; 3])]) -> Vec<Result<Converted, String>> {
    let parts = read(path);
    let converted = uses.iter().map(|&(shows, scale)| {
        if !scale.iter().all(|x| x.is_finite() && *x != 0.0) {
            return Err(format!("its scale {scale:?} is not finite or zero"));
        }
        let parts = parts.as_ref().map_err(String::clone)?;
        if shows { shown(path, scale, parts) } else { hull(path, scale, parts) }
    });
    converted.collect()
}

/// The file as it shows: one STL for each colour, unless the scene reads it as it is.
fn shown(path: &Path, scale: [f64; 3], parts: &[Part]) -> Result<Converted, String> {
    let mirrored = scale.iter().any(|x| *x < 0.0);
    if is_native(path) && !mirrored {
        return Ok(Converted { pieces: Vec::new(), suffix: "", change: None });
    }
    if let Some(part) = parts.iter().find(|part| stl_size(part) > MAX_BYTES) {
        let n = part.triangles.len();
        return Err(format!("its {n} triangles of one colour take more than {} MiB as STL", MAX_BYTES >> 20));
    }
    let (suffix, signs) = if mirrored { ("-mirrored", scale.map(f64::signum)) } else { ("", [1.0; 3]) };
    let pieces: Vec<_> = parts.iter().map(|part| (stl(part, signs), part.color)).collect();
    let is_document = matches!(extension(path).as_str(), "dae" | "gltf" | "glb");
    let mut change = String::from(if is_document { "converted to STL, z up, in metres" } else { "converted to STL" });
    if mirrored {
        change = format!("mirrored, its triangles turned; {change}");
    }
    if pieces.len() > 1 {
        change += &format!(", {} files of one colour each", pieces.len());
    }
    Ok(Converted { pieces, suffix, change: Some(change) })
}

/// The convex hull of the file; the reason if it has none.
fn hull(path: &Path, scale: [f64; 3], parts: &[Part]) -> Result<Converted, String> {
    let corners: Vec<[f64; 3]> = parts.iter().flat_map(|p| p.corners.iter().copied()).collect();
    let mirrored = scale.iter().any(|x| *x < 0.0);
    if is_native(path) && !mirrored && corners.len() <= SMALL {
        if polyhedron::convex_hull(&corners).is_none() {
            return Err("its convex hull has no volume".into());
        }
        return Ok(Converted { pieces: Vec::new(), suffix: "", change: Some("its convex hull touches".into()) });
    }
    let (part, n, outside) = reduced_hull(&corners).ok_or("its convex hull has no volume")?;
    let signs = if mirrored { scale.map(f64::signum) } else { [1.0; 3] };
    let suffix = if mirrored { "-mirrored-hull" } else { "-hull" };
    let kept = part.corners.len();
    let change = if outside > 0.0 {
        let size = scale.iter().fold(0.0, |size: f64, s| size.max(s.abs()));
        let outside = number::short(outside * size * 1e3);
        format!("its convex hull touches, made of {kept} of {n} corners: up to {outside} mm too small")
    } else {
        "its convex hull touches".into()
    };
    Ok(Converted { pieces: vec![(stl(&part, signs), None)], suffix, change: Some(change) })
}

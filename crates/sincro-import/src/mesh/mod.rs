//! Meshes of a robot: copied as they are where the scene reads them, else converted to binary STL.
//!
//! | source | visual | collision |
//! |---|---|---|
//! | STL, OBJ | a copy | a copy if its hull has few corners, else its hull |
//! | MSH of MuJoCo | STL | its hull |
//! | COLLADA | one STL for each colour, in metres, z up | its hull |
//! | any, with a mirrored scale | converted, triangles turned | its hull |

mod dae;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sincro_dynamics::geometry::polyhedron;
use sincro_dynamics::spatial::Vec3;
use sincro_scene::scene::mesh_of_file;

use crate::number;

/// Largest mesh file that is read [bytes].
const MAX_BYTES: u64 = 64 << 20;
/// Corners of a hull that is made; each may touch.
const HULL_CORNERS: usize = 128;
/// Points that a hull is made of, before its corners are chosen.
const CANDIDATES: usize = 500;
/// Corners of a file beyond which its hull is written in its place.
const SMALL: usize = 512;

/// Triangles of one colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Part {
    /// Corners `[m]`.
    pub corners: Vec<[f64; 3]>,
    /// Corners of each triangle, by index.
    pub triangles: Vec<[u32; 3]>,
    /// Colour of its material.
    pub color: Option<[u8; 3]>,
}

/// A file of the scene folder that stands for a mesh, or for a part of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshUse {
    /// Path in the scene folder.
    pub file: String,
    /// Factors along x, y and z, all positive.
    pub scale: [f64; 3],
    /// Colour of its material.
    pub color: Option<[u8; 3]>,
}

/// A mesh in the scene, and what was changed on the way.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placed {
    /// Files that together show or touch as the mesh does.
    pub uses: Vec<MeshUse>,
    /// Description of the conversion; none for a copy.
    pub change: Option<String>,
}

/// Content of a file of the scene folder.
#[derive(Clone, Debug)]
pub(crate) enum Content {
    /// Bytes to be written.
    Bytes(Vec<u8>),
    /// A file to be copied.
    Copy(PathBuf),
}

/// Purpose and factors of a use of a mesh, the factors as bits.
type UseKey = (PathBuf, bool, [u64; 3]);

/// Meshes of the scene folder, each written once.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    /// Files by their path in the folder.
    pub files: BTreeMap<String, Content>,
    names: BTreeSet<String>,
    known: BTreeMap<UseKey, Result<Placed, String>>,
    read: BTreeMap<PathBuf, Result<std::rc::Rc<Vec<Part>>, String>>,
}

impl Meshes {
    /// The files that show a mesh.
    pub fn visual(&mut self, path: &Path, scale: [f64; 3]) -> Result<Placed, String> {
        self.once(path, scale, true)
    }

    /// The file whose convex hull touches as that of a mesh.
    pub fn collision(&mut self, path: &Path, scale: [f64; 3]) -> Result<Placed, String> {
        self.once(path, scale, false)
    }

    fn once(&mut self, path: &Path, scale: [f64; 3], shows: bool) -> Result<Placed, String> {
        if !scale.iter().all(|x| x.is_finite() && *x != 0.0) {
            return Err(format!("its scale {scale:?} is not finite or zero"));
        }
        let key = (path.to_path_buf(), shows, scale.map(f64::to_bits));
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let parts = self.parts(path);
        let made = parts.and_then(|parts| match shows {
            true => self.shown(path, scale, &parts),
            false => self.hull(path, scale, &parts),
        });
        self.known.insert(key, made.clone());
        made
    }

    /// The triangles of a file, read once.
    fn parts(&mut self, path: &Path) -> Result<std::rc::Rc<Vec<Part>>, String> {
        if let Some(known) = self.read.get(path) {
            return known.clone();
        }
        let read = read(path).map(std::rc::Rc::new);
        // what is large and done with is not kept: memory stays in proportion to the files
        let size: usize = read.as_ref().map_or(0, |parts| parts.iter().map(|p| p.triangles.len()).sum());
        if size < 20_000 {
            self.read.insert(path.to_path_buf(), read.clone());
        }
        read
    }

    fn shown(&mut self, path: &Path, scale: [f64; 3], parts: &[Part]) -> Result<Placed, String> {
        let mirrored = scale.iter().any(|x| *x < 0.0);
        if is_native(path) && !mirrored {
            let file = self.copy(path);
            return Ok(Placed { uses: vec![MeshUse { file, scale, color: None }], change: None });
        }
        let mut uses = Vec::new();
        for part in parts {
            let signs = if mirrored { scale.map(f64::signum) } else { [1.0; 3] };
            let file = self.new_name(path, if mirrored { "-mirrored" } else { "" }, "stl");
            self.files.insert(file.clone(), Content::Bytes(stl(part, signs)));
            uses.push(MeshUse { file, scale: scale.map(f64::abs), color: part.color });
        }
        let mut change = if extension(path) != "dae" {
            String::from("converted to STL")
        } else {
            String::from("converted to STL, z up, in metres")
        };
        if mirrored {
            change = format!("mirrored, its triangles turned; {change}");
        }
        if uses.len() > 1 {
            change += &format!(", {} files of one colour each", uses.len());
        }
        Ok(Placed { uses, change: Some(change) })
    }

    fn hull(&mut self, path: &Path, scale: [f64; 3], parts: &[Part]) -> Result<Placed, String> {
        let corners: Vec<[f64; 3]> = parts.iter().flat_map(|p| p.corners.iter().copied()).collect();
        let mirrored = scale.iter().any(|x| *x < 0.0);
        if is_native(path) && !mirrored && corners.len() <= SMALL {
            if polyhedron::convex_hull(&corners).is_none() {
                return Err("its convex hull has no volume".into());
            }
            let file = self.copy(path);
            let change = Some("its convex hull touches".into());
            return Ok(Placed { uses: vec![MeshUse { file, scale, color: None }], change });
        }
        let (part, n, outside) = reduced_hull(&corners).ok_or("its convex hull has no volume")?;
        let signs = if mirrored { scale.map(f64::signum) } else { [1.0; 3] };
        let file = self.new_name(path, if mirrored { "-mirrored-hull" } else { "-hull" }, "stl");
        let kept = part.corners.len();
        self.files.insert(file.clone(), Content::Bytes(stl(&part, signs)));
        let change = if outside > 0.0 {
            let size = scale.iter().fold(0.0, |size: f64, s| size.max(s.abs()));
            let outside = number::short(outside * size * 1e3);
            format!("its convex hull touches, made of {kept} of {n} corners: up to {outside} mm too small")
        } else {
            "its convex hull touches".into()
        };
        Ok(Placed { uses: vec![MeshUse { file, scale: scale.map(f64::abs), color: None }], change: Some(change) })
    }

    /// A ball of radius 1 m, to be scaled to an ellipsoid.
    pub fn ellipsoid(&mut self) -> String {
        let file = String::from("meshes/unit-ball.stl");
        if self.names.insert(file.clone()) {
            self.files.insert(file.clone(), Content::Bytes(stl(&ball(), [1.0; 3])));
        }
        file
    }

    fn copy(&mut self, path: &Path) -> String {
        let known = self.files.iter().find(|(_, c)| matches!(c, Content::Copy(from) if from == path));
        if let Some((name, _)) = known {
            return name.clone();
        }
        let ending = extension(path);
        let file = self.new_name(path, "", &ending);
        self.files.insert(file.clone(), Content::Copy(path.to_path_buf()));
        file
    }

    /// A path in the folder that no file has yet.
    fn new_name(&mut self, path: &Path, suffix: &str, ending: &str) -> String {
        let stem = path.file_stem().map_or_else(|| "mesh".into(), |s| number::name(&s.to_string_lossy()));
        for k in 1.. {
            let count = if k == 1 { String::new() } else { format!("-{k}") };
            let file = format!("meshes/{stem}{suffix}{count}.{ending}");
            // names that differ in case alone are one file on some systems
            if self.names.insert(file.to_lowercase()) {
                return file;
            }
        }
        unreachable!("some count is free")
    }
}

fn extension(path: &Path) -> String {
    path.extension().map_or_else(String::new, |e| e.to_string_lossy().to_lowercase())
}

/// Formats that the scene reads itself.
fn is_native(path: &Path) -> bool {
    matches!(extension(path).as_str(), "stl" | "obj")
}

/// The triangles of a mesh file.
pub(crate) fn read(path: &Path) -> Result<Vec<Part>, String> {
    match extension(path).as_str() {
        "stl" | "obj" => {
            let mesh = mesh_of_file(path)?;
            if mesh.triangles.is_empty() {
                return Err("it has no triangles".into());
            }
            Ok(vec![Part { corners: mesh.corners, triangles: mesh.triangles, color: None }])
        }
        "dae" => {
            let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
            if size > MAX_BYTES {
                return Err(format!("a file of {} MiB is larger than {} MiB", size >> 20, MAX_BYTES >> 20));
            }
            let text = std::fs::read(path).map_err(|e| e.to_string())?;
            dae::read(std::str::from_utf8(&text).map_err(|_| "it is not UTF-8 text")?)
        }
        "msh" => {
            let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
            if size > MAX_BYTES {
                return Err(format!("a file of {} MiB is larger than {} MiB", size >> 20, MAX_BYTES >> 20));
            }
            msh(&std::fs::read(path).map_err(|e| e.to_string())?).ok_or("it is no mesh of MuJoCo".into())
        }
        other => Err(format!("meshes `.{other}` are not read: STL, OBJ, DAE and MSH are")),
    }
}

/// MuJoCo's older binary format: numbers of corners, normals, texture coordinates and faces, then their values.
fn msh(bytes: &[u8]) -> Option<Vec<Part>> {
    let word = |k: usize| -> Option<[u8; 4]> { bytes.get(4 * k..4 * k + 4)?.try_into().ok() };
    let count = |k: usize| usize::try_from(i32::from_le_bytes(word(k)?)).ok();
    let (n, normals, coordinates, faces) = (count(0)?, count(1)?, count(2)?, count(3)?);
    let first_face = 4 + 3 * n + 3 * normals + 2 * coordinates;
    if bytes.len() != 4 * (first_face + 3 * faces) || faces == 0 {
        return None;
    }
    let float = |k: usize| Some(f64::from(f32::from_le_bytes(word(k)?))).filter(|x| x.is_finite());
    let corner = |k: usize| Some([float(4 + 3 * k)?, float(5 + 3 * k)?, float(6 + 3 * k)?]);
    let index = |k: usize| Some(u32::from_le_bytes(word(first_face + k)?)).filter(|i| (*i as usize) < n);
    let triangle = |k: usize| Some([index(3 * k)?, index(3 * k + 1)?, index(3 * k + 2)?]);
    let corners = (0..n).map(corner).collect::<Option<Vec<_>>>()?;
    let triangles = (0..faces).map(triangle).collect::<Option<Vec<_>>>()?;
    Some(vec![Part { corners, triangles, color: None }])
}

/// Binary STL of a part, its axes turned over where a sign is negative.
pub(crate) fn stl(part: &Part, signs: [f64; 3]) -> Vec<u8> {
    let flips = signs.iter().filter(|s| **s < 0.0).count() % 2 == 1;
    let mut bytes = vec![0_u8; 80];
    bytes[..6].copy_from_slice(b"sincro");
    bytes.extend((part.triangles.len() as u32).to_le_bytes());
    bytes.reserve(50 * part.triangles.len());
    for triangle in &part.triangles {
        let mut corners = triangle.map(|k| part.corners[k as usize]);
        if flips {
            corners.swap(1, 2);
        }
        bytes.extend([0_u8; 12]);
        for p in corners {
            (0..3).for_each(|c| bytes.extend(((p[c] * signs[c]) as f32).to_le_bytes()));
        }
        bytes.extend([0_u8; 2]);
    }
    bytes
}

/// Ball of radius 1 m: an icosahedron, its triangles split twice.
fn ball() -> Part {
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners: Vec<[f64; 3]> = Vec::new();
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        corners.extend([[a, b, 0.0], [0.0, a, b], [b, 0.0, a]]);
    }
    let unit = |p: [f64; 3]| {
        let norm = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        p.map(|x| x / norm)
    };
    let hull = |points: Vec<[f64; 3]>| polyhedron::convex_hull(&points).unwrap_or_default();
    let mut mesh = hull(corners.into_iter().map(unit).collect());
    for _ in 0..2 {
        let (corners, triangles) = mesh;
        let middle = |a: u32, b: u32| unit(std::array::from_fn(|c| corners[a as usize][c] + corners[b as usize][c]));
        let between = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let new = between.filter(|(a, b)| a < b).map(|(a, b)| middle(a, b));
        mesh = hull(corners.iter().copied().chain(new.collect::<Vec<_>>()).collect());
    }
    Part { corners: mesh.0, triangles: mesh.1, color: None }
}

/// Convex hull with few corners, those farthest in directions spread evenly; how many points it was made of, and how
/// far these are outside of it at most `[m]`, 0 if it is exact.
fn reduced_hull(corners: &[[f64; 3]]) -> Option<(Part, usize, f64)> {
    let distinct: BTreeSet<[u64; 3]> = corners.iter().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
    let points: Vec<[f64; 3]> = distinct.into_iter().map(|p| p.map(f64::from_bits)).collect();
    // far more points than corners: first those that are extreme in many directions. The time of a hull grows with the
    // square of the points on one of its faces, as on the rim of a cylinder or a fan.
    let is_thinned = points.len() > CANDIDATES;
    let thinned = is_thinned.then(|| support(&points, CANDIDATES));
    let (hull, triangles) = polyhedron::convex_hull(thinned.as_ref().unwrap_or(&points))?;
    let part = if hull.len() <= HULL_CORNERS {
        Part { corners: hull, triangles, color: None }
    } else {
        let (corners, triangles) = polyhedron::convex_hull(&support(&hull, HULL_CORNERS))?;
        Part { corners, triangles, color: None }
    };
    let outside = outside(&points, &part);
    Some((part, points.len(), outside))
}

/// Largest distance of points from the nearest face plane that they are beyond `[m]`; rounding counts as 0.
fn outside(points: &[[f64; 3]], hull: &Part) -> f64 {
    let extent = hull.corners.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    let mut largest = 0.0;
    for triangle in &hull.triangles {
        let [a, b, c] = triangle.map(|k| Vec3(hull.corners[k as usize]));
        let normal = (b - a).cross(c - a);
        let norm = normal.norm();
        if norm <= f64::MIN_POSITIVE {
            continue;
        }
        let normal = normal.scale(1.0 / norm);
        let offset = normal.dot(a);
        largest = points.iter().fold(largest, |largest: f64, p| largest.max(normal.dot(Vec3(*p)) - offset));
    }
    if largest > 1e-9 * extent { largest } else { 0.0 }
}

/// The points that are farthest in `n` directions of a spiral over the sphere, each once.
fn support(points: &[[f64; 3]], n: usize) -> Vec<[f64; 3]> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let extreme = |k: usize| {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / n as f64;
        let (s, c) = sincro_math::elementary::sin_cos(golden * k as f64);
        let r = (1.0 - z * z).sqrt();
        let d = [r * c, r * s, z];
        let along = |p: &[f64; 3]| p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
        let mut best = 0;
        for (k, p) in points.iter().enumerate() {
            if along(p) > along(&points[best]) {
                best = k;
            }
        }
        best
    };
    let chosen: BTreeSet<usize> = (0..n).map(extreme).collect();
    chosen.into_iter().map(|k| points[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Part {
        let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Part { corners, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], color: None }
    }

    #[test]
    fn a_mirrored_mesh_still_encloses_its_volume() {
        let folder = std::env::temp_dir().join(format!("sincro-import-mesh-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("t.stl");
        std::fs::write(&path, stl(&tetrahedron(), [1.0, -1.0, 1.0])).unwrap();
        let mesh = mesh_of_file(&path).unwrap();
        assert_eq!(polyhedron::defects(&mesh.corners, &mesh.triangles), []);
        let volume = polyhedron::mass_properties(&mesh.corners, &mesh.triangles, 6.0).mass;
        assert!((volume - 1.0).abs() < 1e-12, "{volume}");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn hulls_with_many_corners_are_reduced() {
        let n = 3_000;
        let ball: Vec<[f64; 3]> = support(&tetrahedron().corners, 4).into_iter().collect();
        assert!(ball.len() <= 4);
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let point = |k: usize| {
            let z = 1.0 - 2.0 * (k as f64 + 0.5) / n as f64;
            let r = (1.0 - z * z).sqrt();
            let (s, c) = sincro_math::elementary::sin_cos(golden * k as f64);
            [r * c, r * s, z]
        };
        let points: Vec<[f64; 3]> = (0..n).map(point).collect();
        let (hull, before, outside) = reduced_hull(&points).unwrap();
        assert_eq!(before, n);
        assert!(outside > 1e-3 && outside < 0.04, "{outside}");
        assert!(hull.corners.len() <= HULL_CORNERS);
        let volume = polyhedron::mass_properties(&hull.corners, &hull.triangles, 1.0).mass;
        assert!(volume > 0.93 * 4.0 / 3.0 * std::f64::consts::PI, "{volume}");
    }

    #[test]
    fn the_hull_of_many_points_on_one_circle_and_of_a_fine_box() {
        let n = 5_000;
        let rim = |k: usize| {
            let (s, c) = sincro_math::elementary::sin_cos(2.0 * std::f64::consts::PI * k as f64 / n as f64);
            [0.1 * c, 0.1 * s, 0.0]
        };
        let fan: Vec<[f64; 3]> = (0..n).map(rim).chain([[0.0, 0.0, 0.1]]).collect();
        let (hull, _, outside) = reduced_hull(&fan).unwrap();
        assert_eq!(polyhedron::defects(&hull.corners, &hull.triangles), []);
        assert!(outside > 0.0 && outside < 1e-3, "{outside}");
        let grid = |k: usize| [(k % 20) as f64 / 19.0, (k / 20 % 20) as f64 / 19.0, (k / 400) as f64 / 19.0];
        let cube: Vec<[f64; 3]> = (0..8_000).map(grid).collect();
        let (hull, _, outside) = reduced_hull(&cube).unwrap();
        assert_eq!((hull.corners.len(), outside), (8, 0.0));
    }
}

//! Meshes of a robot: copied as they are where the scene reads them, else converted to binary STL.
//!
//! | source | visual | collision |
//! |---|---|---|
//! | STL, OBJ | a copy | a copy if its hull has few corners, else its hull |
//! | MSH of MuJoCo | STL | its hull |
//! | COLLADA, glTF | one STL for each colour, in metres, z up | its hull |
//! | any, with a mirrored scale | converted, triangles turned | its hull |

mod convert;
mod dae;
mod gltf;
mod hull;
mod matrix;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sincro_scene::scene::mesh_of_file;

use crate::number;
use convert::{Converted, Uses};

/// Largest mesh file that is read [bytes].
const MAX_BYTES: u64 = 64 << 20;
/// Deepest nesting of the nodes of a document, which may also place each other.
const MAX_DEPTH: usize = 64;
/// Limit of the triangles of a document, and of their corners: nodes may place a mesh of many corners and few triangles
/// again and again.
const MAX_TRIANGLES: usize = 5_000_000;
const MAX_CORNERS: usize = 5_000_000;
/// Limit of the elements and words of a document that are read, as often as they are: nodes may place each other.
const MAX_WORK: usize = 50_000_000;
/// Bytes of a binary STL before its triangles, and of each of them.
const STL_HEAD: usize = 84;
const STL_TRIANGLE: usize = 50;

/// Elements and words of a document that may still be read.
#[derive(Debug)]
struct Work(usize);

impl Work {
    fn new() -> Self {
        Self(MAX_WORK)
    }

    /// Takes `n` of them.
    fn take(&mut self, n: usize) -> Result<(), String> {
        self.0 = self.0.checked_sub(n).ok_or("its nodes place each other, or its meshes, again and again")?;
        Ok(())
    }
}

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

impl Part {
    /// Counts further corners among `n_corners`.
    fn count_corners(n_corners: &mut usize, more: usize) -> Result<(), String> {
        *n_corners += more;
        if *n_corners > MAX_CORNERS { Err(format!("it has more than {MAX_CORNERS} corners")) } else { Ok(()) }
    }

    /// The part with this colour, a new one if there is none.
    fn of_color(parts: &mut Vec<Self>, color: Option<[u8; 3]>) -> &mut Self {
        let k = parts.iter().position(|part| part.color == color).unwrap_or(parts.len());
        if k == parts.len() {
            parts.push(Self { color, ..Self::default() });
        }
        &mut parts[k]
    }
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
    Bytes(Arc<Vec<u8>>),
    /// A file to be copied.
    Copy(PathBuf),
}

/// Use of a mesh in a robot: its file, true if it shows and false if its hull touches, and the bits of its factors.
type UseKey = (PathBuf, bool, [u64; 3]);

/// Meshes of the scene folder, each written once.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    /// Files by their path in the folder.
    pub files: BTreeMap<String, Content>,
    names: BTreeSet<String>,
    /// Those that were converted and have no names yet.
    converted: BTreeMap<UseKey, Result<Converted, String>>,
    known: BTreeMap<UseKey, Result<Placed, String>>,
    /// Height fields that were written, with their files.
    fields: Vec<(Heights, String)>,
    /// Heights of all uses of height fields.
    n_heights: usize,
}

/// Rows of heights along x, from the least y on `[m]`.
type Heights = Arc<Vec<Vec<f64>>>;

/// Heights of all uses of height fields in a robot at most: each use has its own in a scene.
const MAX_HEIGHTS: usize = 1 << 20;

impl Meshes {
    /// Converts the meshes of these uses ahead, several files at a time: path, true if it shows, and factors. Names are
    /// given later, in the order of the scene.
    pub fn convert(&mut self, uses: impl Iterator<Item = (PathBuf, bool, [f64; 3])>) {
        let keys: BTreeSet<UseKey> = uses.map(|(path, shows, scale)| (path, shows, scale.map(f64::to_bits))).collect();
        let mut files: Vec<Uses> = Vec::new();
        for (path, shows, scale) in keys {
            let purpose = (shows, scale.map(f64::from_bits));
            match files.last_mut() {
                Some((last, purposes)) if *last == path => purposes.push(purpose),
                _ => files.push((path, vec![purpose])),
            }
        }
        for ((path, purposes), all) in files.iter().zip(convert::files(&files)) {
            for ((shows, scale), converted) in purposes.iter().zip(all) {
                self.converted.insert((path.clone(), *shows, scale.map(f64::to_bits)), converted);
            }
        }
    }

    /// The files that show a mesh.
    pub fn visual(&mut self, path: &Path, scale: [f64; 3]) -> Result<Placed, String> {
        self.once(path, scale, true)
    }

    /// The file whose convex hull touches as that of a mesh.
    pub fn collision(&mut self, path: &Path, scale: [f64; 3]) -> Result<Placed, String> {
        self.once(path, scale, false)
    }

    fn once(&mut self, path: &Path, scale: [f64; 3], shows: bool) -> Result<Placed, String> {
        let key = (path.to_path_buf(), shows, scale.map(f64::to_bits));
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        if !self.converted.contains_key(&key) {
            self.convert(std::iter::once((path.to_path_buf(), shows, scale)));
        }
        let converted = self.converted.remove(&key).unwrap_or_else(|| unreachable!("it was converted"));
        let made = converted.map(|converted| self.placed(path, scale, converted));
        self.known.insert(key, made.clone());
        made
    }

    /// Gives the files of a mesh their names.
    fn placed(&mut self, path: &Path, scale: [f64; 3], converted: Converted) -> Placed {
        let mut uses = Vec::new();
        if converted.pieces.is_empty() {
            uses.push(MeshUse { file: self.copy(path), scale, color: None });
        }
        for (bytes, color) in converted.pieces {
            let file = self.new_name(path, converted.suffix, "stl");
            self.files.insert(file.clone(), Content::Bytes(Arc::new(bytes)));
            uses.push(MeshUse { file, scale: scale.map(f64::abs), color });
        }
        Placed { uses, change: converted.change }
    }

    /// A ball of radius 1 m, to be scaled to an ellipsoid.
    pub fn ellipsoid(&mut self) -> String {
        let file = String::from("meshes/unit-ball.stl");
        if self.names.insert(file.clone()) {
            self.files.insert(file.clone(), Content::Bytes(Arc::new(stl(&hull::ball(), [1.0; 3]))));
        }
        file
    }

    /// File of heights, which is written once however often they are used; the reason if there are too many.
    pub fn heights(&mut self, name: &str, rows: &Heights) -> Result<String, String> {
        let n = self.n_heights + rows.iter().map(Vec::len).sum::<usize>();
        if n > MAX_HEIGHTS {
            return Err(format!("all uses of height fields together have more than {MAX_HEIGHTS} heights"));
        }
        self.n_heights = n;
        if let Some((_, file)) = self.fields.iter().find(|(known, _)| Arc::ptr_eq(known, rows)) {
            return Ok(file.clone());
        }
        let line = |row: &Vec<f64>| row.iter().map(|x| number::plain(*x)).collect::<Vec<_>>().join(",") + "\n";
        let text: String = rows.iter().map(line).collect();
        let file = self.new_name(Path::new(&format!("{}.csv", number::name(name))), "", "csv");
        self.files.insert(file.clone(), Content::Bytes(Arc::new(text.into_bytes())));
        self.fields.push((rows.clone(), file.clone()));
        Ok(file)
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
            let text = bytes_of(path)?;
            dae::read(std::str::from_utf8(&text).map_err(|_| "it is not UTF-8 text")?)
        }
        "gltf" | "glb" => gltf::read(&bytes_of(path)?, path.parent().unwrap_or(Path::new(""))),
        "msh" => msh(&bytes_of(path)?).ok_or("it is no mesh of MuJoCo".into()),
        other => Err(format!("meshes `.{other}` are not read: STL, OBJ, DAE, glTF and MSH are")),
    }
}

/// Bytes of a file that is not too large.
fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
    if size > MAX_BYTES {
        return Err(format!("a file of {} MiB is larger than {} MiB", size >> 20, MAX_BYTES >> 20));
    }
    std::fs::read(path).map_err(|e| e.to_string())
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

/// Bytes of the binary STL of a part.
fn stl_size(part: &Part) -> u64 {
    (STL_HEAD + STL_TRIANGLE * part.triangles.len()) as u64
}

/// Binary STL of a part, its axes turned over where a sign is negative.
pub(crate) fn stl(part: &Part, signs: [f64; 3]) -> Vec<u8> {
    let flips = signs.iter().filter(|s| **s < 0.0).count() % 2 == 1;
    let mut bytes = vec![0_u8; STL_HEAD + STL_TRIANGLE * part.triangles.len()];
    bytes[..6].copy_from_slice(b"sincro");
    bytes[80..STL_HEAD].copy_from_slice(&(part.triangles.len() as u32).to_le_bytes());
    for (triangle, record) in part.triangles.iter().zip(bytes[STL_HEAD..].chunks_exact_mut(STL_TRIANGLE)) {
        let [a, b, c] = *triangle;
        // after a normal of zeros, which the corners tell
        let mut at = 12;
        for k in if flips { [a, c, b] } else { [a, b, c] } {
            let p = &part.corners[k as usize];
            for axis in 0..3 {
                record[at..at + 4].copy_from_slice(&((p[axis] * signs[axis]) as f32).to_le_bytes());
                at += 4;
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use sincro_dynamics::geometry::polyhedron;

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
}

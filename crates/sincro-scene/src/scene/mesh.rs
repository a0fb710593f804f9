//! Triangle meshes from files: STL, binary and text, and Wavefront OBJ; what of them makes a solid.

use std::path::Path;
use std::str::SplitAsciiWhitespace;
use std::sync::Arc;

use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::polyhedron::{self, MeshDefect};
pub use sincro_dynamics::geometry::weld::Triangles;
use sincro_dynamics::geometry::weld::Weld;
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::Pose;

use super::body;
use super::file::{BodyFile, MeshFile, OneOrList, VisualMeshFile};
use super::placement::{self, Placement};
use crate::diagnostic::{Diagnostic, Diagnostics, Located, Location, SourceText};
use crate::document::Document;
use crate::folder::Folder;

/// Flaws of one mesh that are told one by one.
const MAX_REPORTED: usize = 4;

/// Corners of a hull beyond which contact would take too long: each may touch.
const MAX_HULL: usize = 512;

/// Bytes of a binary STL before its triangles, and of each of them.
const STL_HEAD: usize = 84;
const STL_TRIANGLE: usize = 50;

/// A mesh of a body.
#[derive(Clone, Debug)]
pub(super) struct MeshInstance {
    mesh: Triangles,
    is_convex: bool,
    /// In the body's frame.
    pub pose: Pose<f64>,
    /// [kg/m³], if it has one.
    pub density: Option<f64>,
    /// In pictures.
    pub color: Option<[u8; 3]>,
}

impl MeshInstance {
    /// In the body's frame.
    pub fn mass_properties(&self, density: f64) -> MassProperties {
        let own = polyhedron::mass_properties(&self.mesh.corners, &self.mesh.triangles, density);
        own.placed(&self.pose.rot, self.pose.pos)
    }

    /// Contact surface.
    pub fn surface(&self) -> Surface {
        if self.is_convex {
            return Surface::Hull(self.mesh.corners.clone());
        }
        Surface::Mesh(self.mesh.corners.clone(), self.mesh.triangles.clone())
    }
}

/// The meshes of a body; those that enclose no volume are refused.
pub(super) fn meshes(
    file: &BodyFile,
    pointer: &str,
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Vec<MeshInstance> {
    let mut list = Vec::new();
    for (k, shape) in file.shape.iter().enumerate() {
        let Some(mesh) = &shape.mesh else { continue };
        let pointer = format!("{pointer}/shape/{k}");
        let named = Located { value: mesh.file.clone(), at: document.at(&format!("{pointer}/mesh/file")) };
        let placement = Placement::new(shape.position, shape.rotation_deg, shape.quaternion_wxyz);
        let pose = placement::pose(&placement, &pointer, document, diagnostics);
        let scale = mesh.scale.as_ref().map_or(&[1.0][..], OneOrList::as_slice);
        if !matches!(scale.len(), 1 | 3) || !scale.iter().all(|x| *x > 0.0) {
            let at = document.at(&format!("{pointer}/mesh/scale"));
            diagnostics.push(scale_refused(&at, &mesh.file, scale));
            continue;
        }
        match read(&named, mesh, scale, folder) {
            Ok(found) => {
                let density = shape.density.or(file.density);
                let color = shape.color.as_ref().and_then(|text| body::color_of(text, &pointer, document, diagnostics));
                list.push(MeshInstance { mesh: found, is_convex: mesh.convex, pose, density, color });
            }
            Err(found) => found.into_iter().for_each(|p| diagnostics.push(p)),
        }
    }
    list
}

/// Triangles that only show, scaled; they need not enclose a volume.
pub(super) fn shown(
    file: &VisualMeshFile,
    pointer: &str,
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Option<Triangles> {
    let named = Located { value: file.file.clone(), at: document.at(&format!("{pointer}/mesh/file")) };
    let scale = file.scale.as_ref().map_or(&[1.0][..], OneOrList::as_slice);
    if !matches!(scale.len(), 1 | 3) || !scale.iter().all(|x| *x > 0.0) {
        let at = document.at(&format!("{pointer}/mesh/scale"));
        diagnostics.push(scale_refused(&at, &file.file, scale));
        return None;
    }
    let found = triangles_named(&named, scale, folder);
    found.map_err(|diagnostic| diagnostics.push(diagnostic)).ok()
}

fn scale_refused(at: &Location, file: &str, scale: &[f64]) -> Diagnostic {
    let diagnostic = Diagnostic::error(at, format!("`scale` of the mesh `{file}` is {scale:?}"));
    diagnostic.with_help("give a positive number, or one for x, y and z; 0.001 for millimetres")
}

/// The mesh of a file, scaled; its hull if that is asked for.
fn read(
    named: &Located<String>,
    file: &MeshFile,
    scale: &[f64],
    folder: &Folder,
) -> Result<Triangles, Vec<Diagnostic>> {
    let found = triangles_named(named, scale, folder).map_err(|p| vec![p])?;
    if file.convex { convex(&found, named) } else { closed(found, named) }
}

/// The triangles of a file, scaled.
fn triangles_named(named: &Located<String>, scale: &[f64], folder: &Folder) -> Result<Triangles, Diagnostic> {
    let bytes = folder.bytes_named(named)?;
    let found = triangles_of(&bytes, &folder.path_of(&named.value));
    // what has no place of its own in the file stands where the file is named
    let mut found = found.map_err(|p| match p.source {
        Some(_) => p,
        None => {
            Diagnostic { help: p.help, ..Diagnostic::error(&named.at, format!("`{}`: {}", named.value, p.message)) }
        }
    })?;
    for p in &mut found.corners {
        (0..3).for_each(|c| p[c] *= scale[c.min(scale.len() - 1)]);
    }
    Ok(found)
}

/// The triangles of a file's bytes; its name tells what it is.
fn triangles_of(bytes: &[u8], path: &Path) -> Result<Triangles, Diagnostic> {
    let source = |text: &str| Arc::new(SourceText { path: path.to_path_buf(), text: text.to_owned() });
    let lower = path.to_string_lossy().to_lowercase();
    if lower.ends_with(".stl") {
        stl(bytes, &source)
    } else if lower.ends_with(".obj") {
        text_of(bytes).and_then(|text| obj(text, &source(text)))
    } else {
        Err(Diagnostic::without_location("a mesh is an STL or an OBJ file")
            .with_help("name a file that ends in .stl or .obj"))
    }
}

/// Largest mesh file that is read for clients and scripts.
const MAX_BYTES: u64 = 64 << 20;

/// Reads the triangle mesh of an STL or OBJ file, by the ending of its name.
///
/// # Errors
///
/// A message in English: the file cannot be read, is larger than 64 MiB, or is no mesh.
pub fn mesh_of_file(path: &Path) -> Result<Triangles, String> {
    let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
    if size > MAX_BYTES {
        return Err(format!("a file of {} MiB is larger than {} MiB", size >> 20, MAX_BYTES >> 20));
    }
    let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
    triangles_of(&bytes, path).map_err(|diagnostic| diagnostic.message)
}

fn convex(mesh: &Triangles, named: &Located<String>) -> Result<Triangles, Vec<Diagnostic>> {
    let refuse = |message: String, help: &str| Err(vec![Diagnostic::error(&named.at, message).with_help(help)]);
    match polyhedron::convex_hull(&mesh.corners) {
        None => refuse(
            format!("the convex hull of `{}` has no volume", named.value),
            "its corners are finite, and do not all lie in one plane",
        ),
        Some((corners, _)) if corners.len() > MAX_HULL => refuse(
            format!("the convex hull of `{}` has {} corners, more than {MAX_HULL}", named.value, corners.len()),
            "each corner may touch: simplify the mesh, or use a sphere, capsule or cylinder",
        ),
        Some((corners, triangles)) => Ok(Triangles { corners, triangles }),
    }
}

fn closed(mesh: Triangles, named: &Located<String>) -> Result<Triangles, Vec<Diagnostic>> {
    let flaws = polyhedron::defects(&mesh.corners, &mesh.triangles);
    if flaws.is_empty() {
        return Ok(mesh);
    }
    let told = flaws.iter().take(MAX_REPORTED).map(|flaw| {
        let (message, help) = words(flaw);
        Diagnostic::error(&named.at, format!("the mesh `{}` {message}", named.value)).with_help(help)
    });
    let mut diagnostics: Vec<Diagnostic> = told.collect();
    if let Some(last) = diagnostics.last_mut().filter(|_| flaws.len() > MAX_REPORTED) {
        last.message += &format!(" (and {} flaws more)", flaws.len() - MAX_REPORTED);
    }
    Err(diagnostics)
}

/// Triangles are counted from 1, in the order of the file.
fn words(flaw: &MeshDefect) -> (String, &'static str) {
    let run = |[a, b]: &[[f64; 3]; 2]| format!("from {} to {}", triple(a), triple(b));
    match flaw {
        MeshDefect::NotFinite { corner } => {
            (format!("is not finite: corner {}", corner + 1), "every coordinate is a finite number")
        }
        MeshDefect::TooFew => ("has fewer than four triangles".into(), "a closed mesh has four triangles at least"),
        MeshDefect::Flat { triangle } => (
            format!("has a triangle without area: number {}", triangle + 1),
            "remove it, and join the corners that coincide",
        ),
        MeshDefect::Open { triangle, edge } => (
            format!("is not closed: no other triangle has the edge of triangle {} {}", triangle + 1, run(edge)),
            "every edge belongs to two triangles: fill the hole, or take the hull with convex = true",
        ),
        MeshDefect::Twice { triangles: [a, b], edge } => (
            format!("is not closed: triangles {} and {} run along the edge {} the same way", a + 1, b + 1, run(edge)),
            "all triangles are counter-clockwise seen from outside: turn one of them over, or separate what touches in an edge",
        ),
        MeshDefect::InsideOut { volume } => (
            format!("is inside out: its volume is {volume} m³"),
            "all triangles are counter-clockwise seen from outside: turn them all over (recalculate the normals)",
        ),
    }
}

fn triple(p: &[f64; 3]) -> String {
    format!("({}, {}, {})", p[0], p[1], p[2])
}

fn text_of(bytes: &[u8]) -> Result<&str, Diagnostic> {
    let refused =
        |_| Diagnostic::without_location("it is not UTF-8 text").with_help("an OBJ file is text; export it again");
    std::str::from_utf8(bytes).map_err(refused)
}

fn stl(bytes: &[u8], source: &dyn Fn(&str) -> Arc<SourceText>) -> Result<Triangles, Diagnostic> {
    let count = bytes.get(80..STL_HEAD).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    if let Some(n) = count.filter(|n| bytes.len() == STL_HEAD + n * STL_TRIANGLE) {
        return Ok(binary_stl(&bytes[STL_HEAD..], n));
    }
    match std::str::from_utf8(bytes) {
        Ok(text) if text.trim_start().starts_with("solid") => text_stl(text, &source(text)),
        _ => Err(Diagnostic::without_location(match count {
            Some(n) => format!(
                "it is no STL file: its head tells of {n} triangles, which take {} bytes, and it has {}",
                STL_HEAD + n * STL_TRIANGLE,
                bytes.len()
            ),
            None => format!("it is no STL file: {} bytes", bytes.len()),
        })
        .with_help("export it again, as binary STL, text STL or OBJ")),
    }
}

fn binary_stl(bytes: &[u8], n: usize) -> Triangles {
    let mut weld = Weld::default();
    weld.mesh.triangles.reserve_exact(n);
    for record in bytes.chunks_exact(STL_TRIANGLE).take(n) {
        // after the normal, which says nothing that the corners do not
        let number = |k: usize| f64::from(f32::from_le_bytes(record[k..k + 4].try_into().unwrap_or_default()));
        let mut corner = |k: usize| weld.corner([number(k), number(k + 4), number(k + 8)]);
        let triangle = [corner(12), corner(24), corner(36)];
        weld.mesh.triangles.push(triangle);
    }
    weld.mesh
}

/// A line of a text: its first word and the rest, for what is wrong in it.
struct Line<'a> {
    source: &'a Arc<SourceText>,
    start: usize,
    text: &'a str,
    first: &'a str,
    rest: SplitAsciiWhitespace<'a>,
}

impl Line<'_> {
    fn refuse<T>(&self, message: String, help: &str) -> Result<T, Diagnostic> {
        let at = Location { source: self.source.clone(), span: self.start..self.start + self.text.len() };
        Err(Diagnostic::error(&at, message).with_help(help))
    }

    /// Three numbers after the first word.
    fn point(&self) -> Result<[f64; 3], Diagnostic> {
        let (mut p, mut words) = ([f64::NAN; 3], self.rest.clone());
        for x in &mut p {
            let Some(word) = words.next() else {
                return self.refuse(format!("`{}` has fewer than three numbers", self.first), "give x, y and z");
            };
            let Ok(number) = word.parse() else {
                return self.refuse(format!("`{word}` is not a number"), "give x, y and z as decimal numbers");
            };
            *x = number;
        }
        Ok(p)
    }
}

fn lines<'a>(text: &'a str, source: &'a Arc<SourceText>) -> impl Iterator<Item = Line<'a>> {
    let mut start = 0;
    text.split_inclusive('\n').filter_map(move |line| {
        let at = start;
        start += line.len();
        let text = line.trim_ascii_start();
        let (before, text) = (line.len() - text.len(), text.trim_ascii_end());
        let mut rest = text.split_ascii_whitespace();
        Some(Line { source, start: at + before, text, first: rest.next()?, rest })
    })
}

fn text_stl(text: &str, source: &Arc<SourceText>) -> Result<Triangles, Diagnostic> {
    let (mut weld, mut loop_of) = (Weld::default(), Vec::new());
    for line in lines(text, source) {
        match line.first {
            "vertex" => {
                let p = line.point()?;
                loop_of.push(weld.corner(p));
            }
            "endloop" => match loop_of[..] {
                [a, b, c] => {
                    weld.mesh.triangles.push([a, b, c]);
                    loop_of.clear();
                }
                _ => return line.refuse(format!("a loop of {} corners", loop_of.len()), "facets are triangles"),
            },
            "solid" | "facet" | "outer" | "endfacet" | "endsolid" => {}
            other => return line.refuse(format!("`{other}` is no word of an STL file"), "export the file again"),
        }
    }
    Ok(weld.mesh)
}

fn obj(text: &str, source: &Arc<SourceText>) -> Result<Triangles, Diagnostic> {
    let (mut mesh, mut face) = (Triangles::default(), Vec::<u32>::new());
    for line in lines(text, source) {
        match line.first {
            "v" => mesh.corners.push(line.point()?),
            "f" => {
                face.clear();
                for word in line.rest.clone() {
                    face.push(face_corner(word, mesh.corners.len(), &line)?);
                }
                if face.len() < 3 {
                    return line
                        .refuse(format!("a face of {} corners", face.len()), "a face has three corners or more");
                }
                mesh.triangles.extend((1..face.len() - 1).map(|k| [face[0], face[k], face[k + 1]]));
            }
            // names, materials, smoothing, texture and normals change no shape, and points and lines have no surface
            "vn" | "vt" | "o" | "g" | "s" | "usemtl" | "mtllib" | "l" | "p" => {}
            word if word.starts_with('#') => {}
            other => {
                return line.refuse(format!("`{other}` is not read"), "export triangles or polygons only: `v` and `f`");
            }
        }
    }
    Ok(mesh)
}

/// A corner of a face, `7`, `7/1`, `7//3` or, counted from the last one, `-1`.
fn face_corner(word: &str, n: usize, line: &Line<'_>) -> Result<u32, Diagnostic> {
    let index = word.split('/').next().unwrap_or("").parse::<i64>().ok();
    let known =
        index.and_then(|k| if k < 0 { usize::try_from(n as i64 + k).ok() } else { usize::try_from(k - 1).ok() });
    match known.filter(|k| *k < n) {
        Some(k) => Ok(k as u32),
        None => line.refuse(format!("there is no corner `{word}`"), &format!("{n} corners stand above this line")),
    }
}

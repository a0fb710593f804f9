//! Triangle meshes as files: OBJ, STL (text and binary) and PLY (text).

use std::fmt::Write;

use crate::ApiError;

/// Triangle mesh: corners `[m]` and triangles of their numbers, counted from 0.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// Corners `[m]`.
    pub corners: &'a [[f64; 3]],
    /// Triangles, counter-clockwise from the outside.
    pub triangles: &'a [[u32; 3]],
}

/// Format of a mesh file, by the numbers of `sim.exportMesh`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// STL as text.
    TextStl,
    /// STL, binary.
    BinaryStl,
    /// PLY as text.
    TextPly,
}

impl Format {
    /// Format of a number of `sim.exportMesh`: 0 OBJ, 3 and 4 STL as text and binary, 6 PLY as text.
    ///
    /// # Errors
    ///
    /// Files of that number are not written.
    pub fn of(number: i64) -> Result<Self, ApiError> {
        Ok(match number {
            0 => Self::Obj,
            3 => Self::TextStl,
            4 => Self::BinaryStl,
            6 => Self::TextPly,
            _ => {
                return Err(ApiError(format!(
                    "meshes are not written in the format {number}: 0 OBJ, 3 STL as text, 4 STL, 6 PLY as text"
                )));
            }
        })
    }

    /// Extension of the names of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::TextStl | Self::BinaryStl => "stl",
            Self::TextPly => "ply",
        }
    }

    /// Bytes of a file with some meshes, those of OBJ as groups `mesh0`, `mesh1` …
    ///
    /// # Panics
    ///
    /// A triangle names a corner that is not there.
    #[must_use]
    pub fn write(self, meshes: &[Mesh<'_>]) -> Vec<u8> {
        match self {
            Self::Obj => obj(meshes).into_bytes(),
            Self::TextStl => text_stl(meshes).into_bytes(),
            Self::BinaryStl => binary_stl(meshes),
            Self::TextPly => text_ply(meshes).into_bytes(),
        }
    }
}

fn obj(meshes: &[Mesh<'_>]) -> String {
    let (mut text, mut first) = (String::new(), 1_u64);
    for (k, mesh) in meshes.iter().enumerate() {
        let _ = writeln!(text, "g mesh{k}");
        for [x, y, z] in mesh.corners {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for triangle in mesh.triangles {
            let [a, b, c] = triangle.map(|corner| first + u64::from(corner));
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        first += mesh.corners.len() as u64;
    }
    text
}

/// Corners of each triangle and its normal; zero where it has no area.
fn facets<'a>(meshes: &'a [Mesh<'_>]) -> impl Iterator<Item = ([f64; 3], [[f64; 3]; 3])> + 'a {
    meshes.iter().flat_map(|mesh| {
        mesh.triangles.iter().map(|triangle| {
            let corners = triangle.map(|k| mesh.corners[k as usize]);
            (normal(&corners), corners)
        })
    })
}

fn normal([a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let edge = |to: &[f64; 3]| [0, 1, 2].map(|k| to[k] - a[k]);
    let (u, v) = (edge(b), edge(c));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { n.map(|x| x / length) } else { [0.0; 3] }
}

fn text_stl(meshes: &[Mesh<'_>]) -> String {
    let mut text = "solid mesh\n".to_owned();
    for ([nx, ny, nz], corners) in facets(meshes) {
        let _ = writeln!(text, "facet normal {nx} {ny} {nz}\nouter loop");
        for [x, y, z] in corners {
            let _ = writeln!(text, "vertex {x} {y} {z}");
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid mesh\n");
    text
}

fn binary_stl(meshes: &[Mesh<'_>]) -> Vec<u8> {
    let n: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let mut file = vec![0; 80];
    file.extend((n as u32).to_le_bytes());
    for (normal, corners) in facets(meshes) {
        for x in normal.iter().chain(corners.iter().flatten()) {
            file.extend((*x as f32).to_le_bytes());
        }
        file.extend([0, 0]);
    }
    file
}

fn text_ply(meshes: &[Mesh<'_>]) -> String {
    let n_corners: usize = meshes.iter().map(|mesh| mesh.corners.len()).sum();
    let n_triangles: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {n_corners}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {n_triangles}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    for [x, y, z] in meshes.iter().flat_map(|mesh| mesh.corners) {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    let mut first = 0;
    for mesh in meshes {
        for triangle in mesh.triangles {
            let [a, b, c] = triangle.map(|corner| first + u64::from(corner));
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        first += mesh.corners.len() as u64;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.5]];
    const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn two() -> [Mesh<'static>; 2] {
        let mesh = Mesh { corners: &CORNERS, triangles: &TRIANGLES };
        [mesh, mesh]
    }

    #[test]
    fn corners_of_later_meshes_are_counted_on() {
        let obj = String::from_utf8(Format::Obj.write(&two())).unwrap();
        assert_eq!(obj.lines().filter(|line| line.starts_with('v')).count(), 8);
        assert!(obj.starts_with("g mesh0\nv 0 0 0\nv 1 0 0\n") && obj.ends_with("f 5 6 7\nf 5 7 8\n"), "{obj}");
        let ply = String::from_utf8(Format::TextPly.write(&two())).unwrap();
        assert!(ply.contains("element vertex 8\n") && ply.ends_with("3 4 5 6\n3 4 6 7\n"), "{ply}");
    }

    #[test]
    fn stl_has_the_normal_of_each_triangle() {
        let text = String::from_utf8(Format::TextStl.write(&two()[..1])).unwrap();
        assert!(text.contains("facet normal 0 0 1\n") && text.contains("facet normal 1 0 0\n"), "{text}");
        let binary = Format::BinaryStl.write(&two());
        assert_eq!((binary.len(), binary[80]), (84 + 4 * 50, 4));
        let z_of_the_first_normal = f32::from_le_bytes(binary[92..96].try_into().unwrap());
        assert_eq!(z_of_the_first_normal.to_bits(), 1.0_f32.to_bits());
    }

    #[test]
    fn formats_have_the_numbers_of_the_api() {
        let known = [0, 3, 4, 6].map(|number| Format::of(number).unwrap().extension());
        assert_eq!(known, ["obj", "stl", "stl", "ply"]);
        assert!(Format::of(5).is_err());
    }
}

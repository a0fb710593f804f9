//! Triangles and colours of glTF documents, as text with buffers (`.gltf`) or in one binary file (`.glb`).
//!
//! Read are triangles, strips and fans of the meshes that the scene places, with the transforms of their nodes, and the
//! base colour of each material. glTF has y up and the result z up, as RViz and Drake take it. Textures, skins,
//! animations and morph targets are not read; sparse and compressed positions are refused.
//! Source: key `gltf`, sections 3.5 (nodes), 3.6 (buffers, accessors), 3.7 (meshes), 4.4 (binary files).

use std::borrow::Cow;
use std::path::{Component, Path};

use serde::Deserialize;
use sincro_math::Real;
use sincro_math::elementary::Binary;

use super::matrix::{IDENTITY, Matrix, Y_TO_Z_UP, determinant, moved, product};
use super::{MAX_BYTES, MAX_DEPTH, MAX_TRIANGLES, Part, Work};

/// First word of a binary file, and types of its chunks.
const MAGIC: u32 = 0x4654_6c67;
const JSON: u32 = 0x4e4f_534a;
const BIN: u32 = 0x004e_4942;
/// Types of components of accessors.
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
/// Modes of primitives.
const TRIANGLES: u32 = 4;
const TRIANGLE_STRIP: u32 = 5;
const TRIANGLE_FAN: u32 = 6;

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Document {
    scene: Option<usize>,
    scenes: Vec<SceneNodes>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<BufferView>,
    buffers: Vec<Buffer>,
    materials: Vec<Material>,
    extensions_required: Vec<String>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct SceneNodes {
    nodes: Vec<usize>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Node {
    mesh: Option<usize>,
    children: Vec<usize>,
    /// Column after column.
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    /// Unit quaternion (x, y, z, w).
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
    material: Option<usize>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    kind: String,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct BufferView {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize)]
struct Buffer {
    uri: Option<String>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Material {
    pbr_metallic_roughness: Option<Roughness>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Roughness {
    /// Linear red, green, blue, and alpha.
    base_color_factor: Option<[f64; 4]>,
}

/// Reads a document; its other files are in `folder` or below.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Vec<Part>, String> {
    let (json, binary) = chunks(bytes)?;
    let document: Document = serde_json::from_slice(json).map_err(|e| format!("it is no glTF: {e}"))?;
    let is_needed = |name: &&String| !name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_");
    if let Some(name) = document.extensions_required.iter().find(is_needed) {
        return Err(format!("its extension `{name}` is not read"));
    }
    let buffers = read_buffers(&document, binary, folder)?;
    let mut reader =
        Reader { document: &document, buffers, parts: Vec::new(), n_triangles: 0, n_corners: 0, work: Work::new() };
    match document.scenes.get(document.scene.unwrap_or(0)) {
        Some(scene) => scene.nodes.iter().try_for_each(|node| reader.node(*node, &Y_TO_Z_UP, 0))?,
        // a document without a scene: all meshes as they stand
        None => (0..document.meshes.len()).try_for_each(|mesh| reader.mesh(mesh, &Y_TO_Z_UP))?,
    }
    reader.parts.retain(|part| !part.triangles.is_empty());
    if reader.parts.is_empty() { Err("it has no triangles".into()) } else { Ok(reader.parts) }
}

/// The text of a document and the binary data that comes with it.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    if word(bytes, 0) != Some(MAGIC) {
        return Ok((bytes, None));
    }
    if word(bytes, 4) != Some(2) {
        return Err("it is a binary glTF of another version than 2".into());
    }
    let (mut json, mut binary, mut at) = (None, None, 12);
    while let (Some(length), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) {
        let chunk = bytes.get(at + 8..at + 8 + length as usize).ok_or("it ends within a chunk")?;
        match kind {
            JSON if json.is_none() => json = Some(chunk),
            BIN if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at += 8 + length as usize;
    }
    Ok((json.ok_or("it has no text")?, binary))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

/// Bytes of all buffers: those of the binary file, which the first one may be, and of others.
fn read_buffers<'d>(
    document: &Document,
    binary: Option<&'d [u8]>,
    folder: &Path,
) -> Result<Vec<Cow<'d, [u8]>>, String> {
    let (mut buffers, mut left) = (Vec::new(), MAX_BYTES);
    for (k, buffer) in document.buffers.iter().enumerate() {
        let bytes = match (&buffer.uri, binary) {
            (None, Some(binary)) if k == 0 => Cow::Borrowed(binary),
            (None, _) => return Err("a buffer is missing".into()),
            (Some(uri), _) => {
                let bytes = contents(uri, folder)?;
                let too_large = || format!("its buffers are larger than {} MiB", MAX_BYTES >> 20);
                left = left.checked_sub(bytes.len() as u64).ok_or_else(too_large)?;
                Cow::Owned(bytes)
            }
        };
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Bytes of a buffer: those of a data URI, or of a file in `folder`.
fn contents(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, text) = data.split_once(";base64,").ok_or("the data of a buffer are not in base 64")?;
        return base64(text).ok_or("the data of a buffer are not in base 64".into());
    }
    let path = Path::new(uri);
    if path.components().any(|c| !matches!(c, Component::Normal(_) | Component::CurDir)) {
        return Err(format!("its buffer `{uri}` leads out of its folder"));
    }
    let (path, refuse) = (folder.join(path), |e: std::io::Error| format!("its buffer `{uri}` cannot be read: {e}"));
    let size = std::fs::metadata(&path).map_err(refuse)?.len();
    if size > MAX_BYTES {
        return Err(format!("its buffer `{uri}` of {} MiB is larger than {} MiB", size >> 20, MAX_BYTES >> 20));
    }
    std::fs::read(path).map_err(refuse)
}

/// Bytes of a text in base 64.
fn base64(text: &str) -> Option<Vec<u8>> {
    let digit = |c: u8| {
        Some(match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        })
    };
    let digits = text.trim_end_matches('=').bytes().map(digit).collect::<Option<Vec<u8>>>()?;
    let four = |four: &[u8]| {
        let bits = four.iter().fold(0_u32, |bits, d| bits << 6 | u32::from(*d)) << (6 * (4 - four.len()));
        bits.to_be_bytes()[1..four.len()].to_vec()
    };
    Some(digits.chunks(4).flat_map(four).collect())
}

struct Reader<'d> {
    document: &'d Document,
    buffers: Vec<Cow<'d, [u8]>>,
    parts: Vec<Part>,
    n_triangles: usize,
    n_corners: usize,
    work: Work,
}

impl Reader<'_> {
    fn node(&mut self, index: usize, above: &Matrix, depth: usize) -> Result<(), String> {
        if depth > MAX_DEPTH {
            return Err(format!("its nodes are nested more than {MAX_DEPTH} deep"));
        }
        let node = self.document.nodes.get(index).ok_or("a node is missing")?;
        self.work.take(1 + node.children.len())?;
        let at = product(above, &transform(node)?);
        if let Some(mesh) = node.mesh {
            self.mesh(mesh, &at)?;
        }
        node.children.iter().try_for_each(|child| self.node(*child, &at, depth + 1))
    }

    fn mesh(&mut self, index: usize, at: &Matrix) -> Result<(), String> {
        let mesh = self.document.meshes.get(index).ok_or("a mesh is missing")?;
        self.work.take(mesh.primitives.len())?;
        mesh.primitives.iter().try_for_each(|primitive| self.primitive(primitive, at))
    }

    fn primitive(&mut self, primitive: &Primitive, at: &Matrix) -> Result<(), String> {
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        if !matches!(mode, TRIANGLES | TRIANGLE_STRIP | TRIANGLE_FAN) {
            return Ok(());
        }
        let positions = self.positions(primitive.attributes.position.ok_or("it has no positions")?)?;
        let indices = match primitive.indices {
            Some(indices) => self.indices(indices)?,
            None => (0..positions.len() as u32).collect(),
        };
        self.work.take(positions.len() + indices.len())?;
        if indices.iter().any(|i| *i as usize >= positions.len()) {
            return Err("an index is out of range".into());
        }
        self.n_triangles += if mode == TRIANGLES { indices.len() / 3 } else { indices.len().saturating_sub(2) };
        if self.n_triangles > MAX_TRIANGLES {
            return Err(format!("it has more than {MAX_TRIANGLES} triangles"));
        }
        Part::count_corners(&mut self.n_corners, positions.len())?;
        let part = Part::of_color(&mut self.parts, self.document.color(primitive.material));
        let first = part.corners.len() as u32;
        part.corners.extend(positions.iter().map(|p| moved(at, p)));
        let is_mirrored = determinant(at) < 0.0;
        let mut add = |[a, b, c]: [u32; 3]| {
            let triangle = if is_mirrored { [a, c, b] } else { [a, b, c] };
            part.triangles.push([first + triangle[0], first + triangle[1], first + triangle[2]]);
        };
        match mode {
            TRIANGLE_STRIP => indices.windows(3).enumerate().for_each(|(k, w)| {
                add(if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] });
            }),
            TRIANGLE_FAN => (2..indices.len()).for_each(|k| add([indices[0], indices[k - 1], indices[k]])),
            _ => indices.chunks_exact(3).for_each(|t| add([t[0], t[1], t[2]])),
        }
        Ok(())
    }

    fn positions(&self, accessor: usize) -> Result<Vec<[f64; 3]>, String> {
        let (accessor, bytes, stride) = self.elements(accessor, "VEC3", &[(FLOAT, 12)])?;
        let number = |at: usize| word(bytes, at).map_or(f64::NAN, |word| f64::from(f32::from_bits(word)));
        let point = |k: usize| [0, 4, 8].map(|c| number(k * stride + c));
        let points: Vec<_> = (0..accessor.count).map(point).collect();
        if points.iter().flatten().all(|x| x.is_finite()) { Ok(points) } else { Err("a position is not finite".into()) }
    }

    fn indices(&self, accessor: usize) -> Result<Vec<u32>, String> {
        let kinds = [(UNSIGNED_BYTE, 1), (UNSIGNED_SHORT, 2), (UNSIGNED_INT, 4)];
        let (accessor, bytes, stride) = self.elements(accessor, "SCALAR", &kinds)?;
        let width = kinds.iter().find(|(kind, _)| *kind == accessor.component_type).map_or(4, |(_, width)| *width);
        let index = |k: usize| {
            let bytes = &bytes[k * stride..k * stride + width];
            bytes.iter().rev().fold(0_u32, |index, byte| index << 8 | u32::from(*byte))
        };
        Ok((0..accessor.count).map(index).collect())
    }

    /// An accessor of this type with one of these types of components (and bytes of an element), its bytes from its
    /// first element on, and the bytes from one element to the next; all elements are there.
    fn elements(&self, index: usize, kind: &str, types: &[(u32, usize)]) -> Result<(&Accessor, &[u8], usize), String> {
        let accessor = self.document.accessors.get(index).ok_or("an accessor is missing")?;
        let width = types.iter().find(|(component, _)| *component == accessor.component_type).map(|(_, width)| *width);
        let Some(width) = width.filter(|_| accessor.kind == kind) else {
            let (kind, component) = (&accessor.kind, accessor.component_type);
            return Err(format!("accessor {index} of type {kind} and component type {component} is not read"));
        };
        let view = accessor.buffer_view.and_then(|view| self.document.buffer_views.get(view));
        let (Some(view), None) = (view, &accessor.sparse) else {
            return Err(format!("accessor {index} is sparse or has no data"));
        };
        let buffer = self.buffers.get(view.buffer).ok_or("a buffer is missing")?;
        let end = view.byte_offset.saturating_add(view.byte_length);
        let bytes = buffer.get(view.byte_offset..end).and_then(|bytes| bytes.get(accessor.byte_offset..));
        let stride = view.byte_stride.unwrap_or(width).max(width);
        let needed = accessor.count.saturating_sub(1).checked_mul(stride).and_then(|n| n.checked_add(width));
        let needed = if accessor.count == 0 { Some(0) } else { needed };
        match (bytes, needed) {
            (Some(bytes), Some(needed)) if needed <= bytes.len() => Ok((accessor, bytes, stride)),
            _ => Err(format!("accessor {index} leads out of its buffer")),
        }
    }
}

impl Document {
    /// Base colour of a material, in the nonlinear values of pictures.
    fn color(&self, material: Option<usize>) -> Option<[u8; 3]> {
        let material = self.materials.get(material?)?;
        let linear = material.pbr_metallic_roughness.as_ref()?.base_color_factor?;
        // transfer function of sRGB
        let encoded = |x: f64| match x {
            x if x <= 0.003_130_8 => 12.92 * x,
            x => 1.055 * x.binary(Binary::Pow, 1.0 / 2.4) - 0.055,
        };
        crate::color::rgb(&linear.map(encoded))
    }
}

/// Transform of a node.
fn transform(node: &Node) -> Result<Matrix, String> {
    let mut m = IDENTITY;
    if let Some(n) = node.matrix {
        m = std::array::from_fn(|i| std::array::from_fn(|j| n[4 * j + i]));
    } else {
        let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let scale = node.scale.unwrap_or([1.0; 3]);
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        for i in 0..3 {
            (0..3).for_each(|j| m[i][j] = rotation[i][j] * scale[j]);
            m[i][3] = node.translation.map_or(0.0, |t| t[i]);
        }
    }
    if m.iter().flatten().all(|x| x.is_finite()) { Ok(m) } else { Err("a transform is not finite".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square in the plane of x and y as a strip, its node 2 m along y and twice as wide along x.
    fn document(buffer: &str, required: &str) -> String {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": [{required}], "scene": 0, "scenes": [{{"nodes": [0]}}],
  "nodes": [{{"children": [1], "translation": [0, 2, 0]}}, {{"mesh": 0, "scale": [2, 1, 1]}}],
  "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "mode": 5, "material": 0}}]}}],
  "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [1, 0.2158605, 0, 1]}}}}],
  "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
    {{"bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR"}}],
  "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 8}}],
  "buffers": [{{"byteLength": 56{buffer}}}]}}"#
        )
    }

    fn data() -> Vec<u8> {
        let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let corners = corners.iter().flatten().flat_map(|x| x.to_le_bytes());
        corners.chain([0_u16, 1, 2, 3].iter().flat_map(|k| k.to_le_bytes())).collect()
    }

    fn binary(json: &str) -> Vec<u8> {
        let mut json = json.as_bytes().to_vec();
        json.resize(json.len().next_multiple_of(4), b' ');
        let data = data();
        let mut bytes = Vec::new();
        for word in [MAGIC, 2, (28 + json.len() + data.len()) as u32, json.len() as u32, JSON] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(&json);
        bytes.extend((data.len() as u32).to_le_bytes().iter().chain(&BIN.to_le_bytes()));
        bytes.extend(data);
        bytes
    }

    #[test]
    fn a_strip_is_placed_by_its_nodes_with_z_up() {
        let parts = read(&binary(&document("", "")), Path::new("")).unwrap();
        assert_eq!(parts.len(), 1);
        // y is up there, z here
        assert_eq!(parts[0].corners, [[0.0, 0.0, 2.0], [2.0, 0.0, 2.0], [0.0, 0.0, 3.0], [2.0, 0.0, 3.0]]);
        assert_eq!(parts[0].triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(parts[0].color, Some([255, 128, 0]));
    }

    #[test]
    fn buffers_in_base_64_are_read_as_those_of_the_file() {
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::new();
        for three in data().chunks(3) {
            let bits = three.iter().fold(0_u32, |bits, byte| bits << 8 | u32::from(*byte)) << (8 * (3 - three.len()));
            let digits = (0..=three.len()).map(|k| char::from(DIGITS[(bits >> (18 - 6 * k) & 63) as usize]));
            text.extend(digits.chain(std::iter::repeat_n('=', 3 - three.len())));
        }
        let uri = format!(", \"uri\": \"data:application/octet-stream;base64,{text}\"");
        let found = read(document(&uri, "").as_bytes(), Path::new("")).unwrap();
        assert_eq!(found, read(&binary(&document("", "")), Path::new("")).unwrap());
    }

    #[test]
    fn what_cannot_be_read_is_refused() {
        let refused = |bytes: &[u8]| read(bytes, Path::new("/nowhere")).unwrap_err();
        assert!(refused(b"{").contains("it is no glTF"));
        assert!(refused(document("", "").as_bytes()).contains("a buffer is missing"));
        let draco = document("", "\"KHR_draco_mesh_compression\"");
        assert!(refused(draco.as_bytes()).contains("KHR_draco_mesh_compression"));
        let out = document(", \"uri\": \"../../etc/passwd\"", "");
        assert!(refused(out.as_bytes()).contains("leads out of its folder"));
        let long =
            document("", "").replace("\"count\": 4, \"type\": \"VEC3\"", "\"count\": 5000000000, \"type\": \"VEC3\"");
        assert!(refused(&binary(&long)).contains("leads out of its buffer"));
        let range = document("", "").replace("\"count\": 4, \"type\": \"VEC3\"", "\"count\": 3, \"type\": \"VEC3\"");
        assert!(refused(&binary(&range)).contains("out of range"));
        let cycle = document("", "").replace("{\"mesh\": 0, \"scale\": [2, 1, 1]}", "{\"children\": [0, 0]}");
        assert!(refused(&binary(&cycle)).contains("nested"));
        let second = document("", "").replace("\"buffers\": [", "\"buffers\": [{\"byteLength\": 56}, ");
        assert!(refused(&binary(&second)).contains("a buffer is missing"), "the first one alone is in the file");
        let whole = binary(&document("", ""));
        for end in 0..whole.len() {
            assert!(read(&whole[..end], Path::new("")).is_err(), "{end}");
        }
    }
}

//! Triangles and colours of COLLADA documents.
//!
//! Read are triangles, `polylist` and `polygons` (split from their first corner) of all geometries that the visual
//! scene
//! places, with their matrices, the unit and the up-axis of the document (the result has z up), and the diffuse colour
//! of each material. Lines, skins, animations and textures are not.

use std::collections::BTreeMap;
use std::rc::Rc;

use roxmltree::{Document, Node, NodeId, ParsingOptions};

use super::matrix::{IDENTITY, Matrix, Y_TO_Z_UP, determinant, moved, product};
use super::{MAX_DEPTH, MAX_TRIANGLES, Part, Work};

/// Reads a document.
pub(super) fn read(text: &str) -> Result<Vec<Part>, String> {
    let options = ParsingOptions { allow_dtd: false, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|e| format!("XML: {e}"))?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err("it is no COLLADA document".into());
    }
    let ids: BTreeMap<&str, Node<'_, '_>> =
        root.descendants().filter_map(|n| n.attribute("id").map(|id| (id, n))).collect();
    let mut reader =
        Reader { ids, parts: Vec::new(), n_triangles: 0, n_corners: 0, work: Work::new(), last_positions: None };
    let upright = upright(root);
    let scenes = root.descendants().filter(|n| n.has_tag_name(tag(root, "visual_scene")));
    for scene in scenes.take(1) {
        for node in named(scene, "node") {
            reader.node(node, &upright, 0)?;
        }
    }
    if reader.parts.iter().all(|part| part.triangles.is_empty()) {
        // a document without a scene: all geometries as they stand
        let geometries: Vec<_> = root.descendants().filter(|n| n.tag_name().name() == "geometry").collect();
        for geometry in geometries {
            reader.geometry(geometry, &upright, &BTreeMap::new())?;
        }
    }
    reader.parts.retain(|part| !part.triangles.is_empty());
    if reader.parts.is_empty() { Err("it has no triangles".into()) } else { Ok(reader.parts) }
}

/// A tag name in the namespace of the document.
fn tag<'a>(root: Node<'a, '_>, name: &'a str) -> roxmltree::ExpandedName<'a, 'a> {
    match root.tag_name().namespace() {
        Some(namespace) => (namespace, name).into(),
        None => name.into(),
    }
}

/// Scale to metres and rotation to z up.
fn upright(root: Node<'_, '_>) -> Matrix {
    let asset = named(root, "asset").next();
    let unit = asset.and_then(|a| named(a, "unit").next()).and_then(|u| u.attribute("meter"));
    let unit = unit.and_then(|text| text.parse::<f64>().ok()).filter(|x| x.is_finite() && *x > 0.0).unwrap_or(1.0);
    let axis = asset.and_then(|a| named(a, "up_axis").next()).and_then(|u| u.text()).unwrap_or("Y_UP").trim();
    let mut m = match axis {
        "Z_UP" => IDENTITY,
        "X_UP" => [[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [1.0, 0.0, 0.0, 0.0], IDENTITY[3]],
        _ => Y_TO_Z_UP,
    };
    m[..3].iter_mut().flatten().for_each(|x| *x *= unit);
    m
}

fn named<'a, 'd>(node: Node<'a, 'd>, name: &'static str) -> impl Iterator<Item = Node<'a, 'd>> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == name)
}

/// Limit of the elements of an effect that are looked at for its colour.
const MAX_OF_EFFECT: usize = 1000;

/// Positions of a mesh.
type Points = Rc<Vec<[f64; 3]>>;

struct Reader<'a, 'd> {
    ids: BTreeMap<&'a str, Node<'a, 'd>>,
    parts: Vec<Part>,
    n_triangles: usize,
    n_corners: usize,
    work: Work,
    /// Positions of the source that was read last: primitives of one mesh share them.
    last_positions: Option<(NodeId, Points)>,
}

impl<'a, 'd> Reader<'a, 'd> {
    fn target(&self, url: Option<&str>) -> Option<Node<'a, 'd>> {
        self.ids.get(url?.trim_start_matches('#')).copied()
    }

    fn node(&mut self, node: Node<'a, 'd>, above: &Matrix, depth: usize) -> Result<(), String> {
        if depth > MAX_DEPTH {
            return Err(format!("its nodes are nested more than {MAX_DEPTH} deep"));
        }
        // an element takes as long as some words
        self.work.take(8 * node.descendants().count())?;
        let mut at = *above;
        for child in node.children().filter(Node::is_element) {
            if let Some(m) = transform(child)? {
                at = product(&at, &m);
            }
        }
        for child in node.children().filter(Node::is_element) {
            match child.tag_name().name() {
                "node" => self.node(child, &at, depth + 1)?,
                "instance_node" => {
                    if let Some(target) = self.target(child.attribute("url")) {
                        self.node(target, &at, depth + 1)?;
                    }
                }
                "instance_geometry" => {
                    let materials = self.bindings(child);
                    if let Some(target) = self.target(child.attribute("url")) {
                        self.geometry(target, &at, &materials)?;
                    }
                }
                "instance_controller" => {
                    let controller = self.target(child.attribute("url"));
                    let skin = controller.and_then(|c| named(c, "skin").next());
                    let materials = self.bindings(child);
                    if let Some(target) = self.target(skin.and_then(|s| s.attribute("source"))) {
                        self.geometry(target, &at, &materials)?;
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Colours of the symbols of an instance.
    fn bindings(&self, instance: Node<'a, 'd>) -> BTreeMap<&'a str, [u8; 3]> {
        let all = instance.descendants().filter(|n| n.tag_name().name() == "instance_material");
        all.filter_map(|n| Some((n.attribute("symbol")?, self.color(n.attribute("target"))?))).collect()
    }

    /// Diffuse colour of a material.
    fn color(&self, material: Option<&str>) -> Option<[u8; 3]> {
        let effect = self.target(material).and_then(|m| named(m, "instance_effect").next())?;
        let effect = self.target(effect.attribute("url"))?;
        let diffuse = effect.descendants().take(MAX_OF_EFFECT).find(|n| n.tag_name().name() == "diffuse")?;
        let color = named(diffuse, "color").next()?;
        let rgba: Vec<f64> = color.text()?.split_whitespace().filter_map(|w| w.parse().ok()).collect();
        crate::color::rgb(&rgba)
    }

    fn geometry(
        &mut self,
        geometry: Node<'a, 'd>,
        at: &Matrix,
        materials: &BTreeMap<&str, [u8; 3]>,
    ) -> Result<(), String> {
        let Some(mesh) = named(geometry, "mesh").next() else { return Ok(()) };
        // a word has some characters
        self.work.take(mesh.descendants().map(|n| 1 + n.text().map_or(0, str::len) / 4).sum())?;
        for primitive in mesh.children().filter(Node::is_element) {
            let kind = primitive.tag_name().name();
            if !matches!(kind, "triangles" | "polylist" | "polygons") {
                continue;
            }
            let symbol = primitive.attribute("material");
            let color = symbol.and_then(|s| materials.get(s).copied().or_else(|| self.color(Some(s))));
            let (stride, offset, positions) = self.positions(primitive)?;
            let faces = faces(primitive, kind, (stride, offset))?;
            self.add(&faces, &positions, at, color)?;
        }
        Ok(())
    }

    /// Indices a corner, offset of the position among them, and the positions.
    fn positions(&mut self, primitive: Node<'a, 'd>) -> Result<(usize, usize, Points), String> {
        let inputs: Vec<_> = named(primitive, "input").collect();
        let offset = |n: &Node<'_, '_>| n.attribute("offset").and_then(|o| o.parse::<usize>().ok()).unwrap_or(0);
        let stride = inputs.iter().map(offset).max().unwrap_or(0).saturating_add(1).min(64);
        let vertex = inputs.iter().find(|n| n.attribute("semantic") == Some("VERTEX")).ok_or("it has no vertices")?;
        let vertices = self.target(vertex.attribute("source")).ok_or("its vertices are missing")?;
        let position = named(vertices, "input").find(|n| n.attribute("semantic") == Some("POSITION"));
        let source = self.target(position.and_then(|n| n.attribute("source"))).ok_or("its positions are missing")?;
        let offset = offset(vertex).min(stride - 1);
        if let Some((_, positions)) = self.last_positions.as_ref().filter(|(id, _)| *id == source.id()) {
            return Ok((stride, offset, positions.clone()));
        }
        let array = named(source, "float_array").next().and_then(|n| n.text()).unwrap_or("");
        let step = source.descendants().find(|n| n.tag_name().name() == "accessor");
        let step = step.and_then(|n| n.attribute("stride")).and_then(|s| s.parse().ok()).unwrap_or(3_usize).max(3);
        let mut positions = Vec::with_capacity(array.len() / 9 / step);
        let mut p = [0.0; 3];
        for (k, word) in array.split_ascii_whitespace().enumerate() {
            let x: f64 = word.parse().map_err(|_| "a position is no number")?;
            if !x.is_finite() {
                return Err("a position is not finite".into());
            }
            if k % step < 3 {
                p[k % step] = x;
            }
            if k % step == step - 1 {
                positions.push(p);
            }
        }
        let positions = Rc::new(positions);
        self.last_positions = Some((source.id(), positions.clone()));
        Ok((stride, offset, positions))
    }

    fn add(
        &mut self,
        faces: &Faces,
        positions: &[[f64; 3]],
        at: &Matrix,
        color: Option<[u8; 3]>,
    ) -> Result<(), String> {
        Part::count_corners(&mut self.n_corners, positions.len())?;
        let part = Part::of_color(&mut self.parts, color);
        let first = part.corners.len() as u32;
        part.triangles.reserve(faces.n_triangles());
        part.corners.extend(positions.iter().map(|p| moved(at, p)));
        let mirrored = determinant(at) < 0.0;
        let mut start = 0_usize;
        for n in &faces.corners {
            let corner = |k: usize| -> Result<u32, String> {
                let index = faces.indices.get(start + k).copied();
                let index = index.filter(|i| (*i as usize) < positions.len()).ok_or("an index is out of range")?;
                Ok(first + index)
            };
            for k in 1..n.saturating_sub(1) {
                let mut triangle = [corner(0)?, corner(k)?, corner(k + 1)?];
                if mirrored {
                    triangle.swap(1, 2);
                }
                part.triangles.push(triangle);
                self.n_triangles += 1;
            }
            start += n;
        }
        if self.n_triangles > MAX_TRIANGLES {
            Err(format!("it has more than {MAX_TRIANGLES} triangles"))
        } else {
            Ok(())
        }
    }
}

/// Number of corners of each face, and the positions of all of them, by index.
struct Faces {
    corners: Vec<usize>,
    indices: Vec<u32>,
}

impl Faces {
    /// Number of triangles that they are split into, as far as there are indices for them.
    fn n_triangles(&self) -> usize {
        let all = self.corners.iter().fold(0_usize, |sum, n| sum.saturating_add(n.saturating_sub(2)));
        all.min(self.indices.len())
    }
}

/// Faces of a primitive whose corners have `stride` indices, that of the position at `offset`.
fn faces(primitive: Node<'_, '_>, kind: &str, (stride, offset): (usize, usize)) -> Result<Faces, String> {
    let index = |word: &str| word.parse::<u32>().map_err(|_| format!("`{word}` is no index"));
    let mut faces = Faces { corners: Vec::new(), indices: Vec::new() };
    for list in named(primitive, "p") {
        let (text, first) = (list.text().unwrap_or(""), faces.indices.len());
        // indices have four digits or so
        faces.indices.reserve(text.len() / (5 * stride));
        let mut n_words = 0;
        for word in text.split_ascii_whitespace() {
            if n_words % stride == offset {
                faces.indices.push(index(word)?);
            }
            n_words += 1;
        }
        let n = n_words / stride;
        faces.indices.truncate(first + n);
        match kind {
            "triangles" => faces.corners.extend(std::iter::repeat_n(3, n / 3)),
            "polygons" => faces.corners.push(n),
            _ => {}
        }
    }
    if kind == "polylist" {
        let counts = named(primitive, "vcount").next().and_then(|n| n.text()).unwrap_or("");
        let counts = counts.split_ascii_whitespace().map(|word| index(word).map(|n| n as usize));
        faces.corners = counts.collect::<Result<_, _>>()?;
    }
    Ok(faces)
}

/// Matrix of an element that moves its node.
fn transform(element: Node<'_, '_>) -> Result<Option<Matrix>, String> {
    let kind = element.tag_name().name();
    if !matches!(kind, "matrix" | "translate" | "rotate" | "scale") {
        return Ok(None);
    }
    let text = element.text().unwrap_or("");
    let n: Vec<f64> = text.split_whitespace().filter_map(|w| w.parse().ok()).filter(|x: &f64| x.is_finite()).collect();
    let mut m = IDENTITY;
    match (kind, n.as_slice()) {
        ("matrix", n) if n.len() == 16 => m = std::array::from_fn(|i| std::array::from_fn(|j| n[4 * i + j])),
        ("translate", &[x, y, z]) => [m[0][3], m[1][3], m[2][3]] = [x, y, z],
        ("scale", &[x, y, z]) => [m[0][0], m[1][1], m[2][2]] = [x, y, z],
        ("rotate", &[x, y, z, degrees]) => {
            let norm = (x * x + y * y + z * z).sqrt();
            if norm > 0.0 {
                m = rotation([x / norm, y / norm, z / norm], degrees.to_radians());
            }
        }
        _ => return Err(format!("`{kind}` has {} numbers", n.len())),
    }
    Ok(Some(m))
}

fn rotation([x, y, z]: [f64; 3], angle: f64) -> Matrix {
    let (s, c) = sincro_math::elementary::sin_cos(angle);
    let d = 1.0 - c;
    [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0.0],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0.0],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0.0],
        IDENTITY[3],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = r##"<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="0.01"/><up_axis>Y_UP</up_axis></asset>
  <library_effects><effect id="fx"><profile_COMMON><technique sid="t"><phong>
    <diffuse><color>1 0 0 1</color></diffuse></phong></technique></profile_COMMON></effect></library_effects>
  <library_materials><material id="red"><instance_effect url="#fx"/></material></library_materials>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
      <technique_common><accessor source="#pa" count="4" stride="3"/></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <polylist material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#p" offset="1"/>
      <vcount>4</vcount><p>0 0 1 0 2 0 3 0</p></polylist></mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node><translate>0 0 10</translate><scale>SCALE 1 1</scale>
    <instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="m" target="#red"/></technique_common>
    </bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
</COLLADA>"##;

    #[test]
    fn units_axes_and_colours_are_those_of_the_document() {
        let parts = read(&SQUARE.replace("SCALE", "2")).unwrap();
        assert_eq!((parts.len(), parts[0].color), (1, Some([255, 0, 0])));
        // y of the document is up: (2, 1, 10) cm stands at x = 2 cm, y = -10 cm, z = 1 cm
        assert_eq!(parts[0].corners[2].map(|x| (x * 1e6).round() / 1e6), [0.02, -0.1, 0.01]);
        assert_eq!(parts[0].triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn mirrored_nodes_turn_their_triangles() {
        let parts = read(&SQUARE.replace("SCALE", "-2")).unwrap();
        assert_eq!(parts[0].triangles, [[0, 2, 1], [0, 3, 2]]);
    }

    #[test]
    fn documents_that_lie_are_refused() {
        assert!(read("<COLLADA/>").unwrap_err().contains("no triangles"));
        assert!(read(&SQUARE.replace("SCALE", "1").replace("0 0 1 0 2 0 3 0", "0 0 1 0 9 0 3 0")).is_err());
        let circle = "<COLLADA><library_visual_scenes><visual_scene><node id=\"a\"><instance_node url=\"#a\"/></node>\
                      </visual_scene></library_visual_scenes></COLLADA>";
        assert!(read(circle).unwrap_err().contains("nested"));
    }

    #[test]
    fn nodes_that_place_each_other_end() {
        let node = |k: usize| {
            let next = format!("<instance_node url=\"#n{}\"/>", k + 1);
            format!("<node id=\"n{k}\">{next}{next}</node>")
        };
        let nodes: String = (0..40).map(node).collect();
        let text = format!(
            "<COLLADA><library_visual_scenes><visual_scene>{nodes}</visual_scene></library_visual_scenes></COLLADA>"
        );
        assert!(read(&text).unwrap_err().contains("again and again"));
        // few nodes with much in each
        let much = text
            .replace("<node id=\"n39\">", &("<node id=\"n39\">".to_owned() + &"<scale>1 1 1</scale>".repeat(20_000)));
        assert!(read(&much).unwrap_err().contains("again and again"));
    }

    #[test]
    fn a_stride_beyond_all_numbers_gives_no_positions() {
        let text = SQUARE.replace("SCALE", "1").replace("stride=\"3\"", &format!("stride=\"{}\"", usize::MAX));
        assert_ne!(text, SQUARE.replace("SCALE", "1"));
        assert!(read(&text).is_err());
    }
}

//! Visual and collision geometry of links, and their colours.

use std::collections::BTreeMap;

use sincro_scene::diagnostic::Diagnostic;

use super::origin;
use crate::color::rgb;
use crate::findings::Findings;
use crate::robot::{Geometry, Shape};
use crate::source::Element;

/// Colours of materials by their names.
pub(super) type Colors = BTreeMap<String, Option<[u8; 3]>>;

/// Materials of the robot.
pub(super) fn materials(root: Element<'_>, findings: &mut Findings) -> Colors {
    let mut colors = Colors::new();
    for element in root.children("material") {
        let name = element.attribute("name").unwrap_or_default().to_owned();
        let color = findings.take(color_of(element)).flatten();
        colors.insert(name, color);
    }
    colors
}

/// Colour of a material element.
fn color_of(element: Element<'_>) -> Result<Option<[u8; 3]>, Diagnostic> {
    let Some(color) = element.child("color") else { return Ok(None) };
    let Some(rgba) = color.numbers("rgba")? else { return Ok(None) };
    if let [_, _, _, alpha] = rgba[..]
        && alpha < 1.0
    {
        color.change("bodies are opaque: its transparency is left out");
    }
    Ok(rgb(&rgba))
}

/// A `visual` or `collision`.
pub(super) fn piece(element: Element<'_>, colors: &Colors, findings: &mut Findings) -> Option<Geometry> {
    element.attribute("name");
    let pose = findings.take(origin(element))?;
    let Some(geometry) = element.child("geometry") else {
        findings.warn(element.error(format!("`{}` has no geometry", element.name())).with_help("it is left out"));
        element.drop("it has no geometry");
        return None;
    };
    geometry.attribute("name");
    let shape = match findings.take(shape(geometry))? {
        Ok(shape) => shape,
        Err(why) => {
            findings.warn(geometry.error(format!("geometry is left out: {why}")));
            element.drop(&why);
            return None;
        }
    };
    let mut color = None;
    if element.name() == "visual"
        && let Some(material) = element.child("material")
    {
        let own = findings.take(color_of(material)).flatten();
        color = own.or_else(|| material.attribute("name").and_then(|name| colors.get(name).copied().flatten()));
        material.attribute("name");
    }
    Some(Geometry { at: element.location(), element: element.id(), pose, shape, color, surface: None })
}

/// The shape in a `geometry`; the reason if the scene has none for it.
fn shape(geometry: Element<'_>) -> Result<Result<Shape, String>, Diagnostic> {
    let Some(element) = geometry.elements().into_iter().next() else {
        return Ok(Err("it is empty".into()));
    };
    let positive = |name: &str| -> Result<f64, Diagnostic> {
        element.number(name)?.ok_or_else(|| element.error(format!("`{}` has no `{name}`", element.name())))
    };
    let shape = match element.name() {
        "box" => Shape::Cuboid(element.vector("size")?.ok_or_else(|| element.error("`box` has no `size`"))?),
        "sphere" => Shape::Sphere(positive("radius")?),
        "cylinder" => Shape::Cylinder(positive("radius")?, positive("length")?),
        "capsule" => Shape::Capsule(positive("radius")?, positive("length")?),
        "mesh" => {
            let Some(uri) = element.attribute("filename") else {
                return Err(element.error("`mesh` has no `filename`"));
            };
            let scale = match element.numbers("scale")?.as_deref() {
                None => [1.0; 3],
                Some([x]) => [*x; 3],
                Some([x, y, z]) => [*x, *y, *z],
                Some(list) => return Err(element.error(format!("`scale` has {} numbers, expected three", list.len()))),
            };
            Shape::Mesh { uri: uri.trim().to_owned(), scale }
        }
        other => return Ok(Err(format!("`{other}` is no geometry of the scene"))),
    };
    element.keep();
    Ok(Ok(shape))
}

//! Geometry that only shows, of bodies and frames: solids and triangles without mass and contact.

use sincro_dynamics::contact::Surface;
use sincro_dynamics::model::Shape;

use super::file::VisualFile;
use super::object::ShownSurface;
use super::placement::{self, Placement};
use super::{body, mesh};
use crate::diagnostic::Diagnostics;
use crate::document::Document;
use crate::folder::Folder;

/// The visuals of an object; those whose files cannot be read are noted and left out.
pub(super) fn visuals(
    files: &[VisualFile],
    pointer: &str,
    document: &Document,
    folder: &Folder,
    diagnostics: &mut Diagnostics,
) -> Vec<ShownSurface> {
    let mut list = Vec::new();
    for (k, file) in files.iter().enumerate() {
        let pointer = format!("{pointer}/visual/{k}");
        let placement = Placement::new(file.position, file.rotation_deg, file.quaternion_wxyz);
        let pose = placement::pose(&placement, &pointer, document, diagnostics);
        let color = file.color.as_ref().and_then(|text| body::color_of(text, &pointer, document, diagnostics));
        let surface = match (&file.mesh, solid(file)) {
            (Some(of_file), _) => {
                let Some(triangles) = mesh::shown(of_file, &pointer, document, folder, diagnostics) else { continue };
                Surface::Mesh(triangles.corners, triangles.triangles)
            }
            (None, Some(shape)) => Surface::Solid(shape),
            (None, None) => unreachable!("the schema wants one kind of shape"),
        };
        list.push(ShownSurface { surface, pose, color });
    }
    list
}

fn solid(file: &VisualFile) -> Option<Shape> {
    Some(match file {
        VisualFile { cuboid: Some(c), .. } => Shape::Cuboid { size: c.size },
        VisualFile { cylinder: Some(c), .. } => Shape::Cylinder { radius: c.radius, length: c.length },
        VisualFile { capsule: Some(c), .. } => Shape::Capsule { radius: c.radius, length: c.length },
        VisualFile { cone: Some(c), .. } => Shape::Cone { radius: c.radius, length: c.length },
        VisualFile { torus: Some(t), .. } => Shape::Torus { major_radius: t.major_radius, tube_radius: t.tube_radius },
        VisualFile { sphere: Some(s), .. } => Shape::Sphere { radius: s.radius },
        _ => return None,
    })
}

//! Bodies: solids and their mass.
//!
//! | given | mass and inertia |
//! |---|---|
//! | `density` (of the body or of each shape) and shapes | of the shapes at that density |
//! | `mass` and shapes | of the shapes, scaled to that mass |
//! | `mass`, `inertia` (and `center_of_mass`) | as given; shapes only show |

use sincro_dynamics::model::{MassProperties, Shape};

use super::file::{BodyFile, ShapeFile};
use super::mesh::MeshInstance;
use super::object::ShapeInstance;
use super::placement::{self, Placement};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::document::Document;

/// Stands in for the mass of a body that has been refused, so that the rest can still be checked.
const UNIT: MassProperties =
    MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };

/// Returns true if a body has contact shapes and no mass properties: it must then be fixed in the world.
pub(super) fn is_fixture(file: &BodyFile) -> bool {
    let weighs = file.mass.is_some() || file.density.is_some() || file.inertia.is_some();
    let densities = file.shape.iter().any(|s| s.density.is_some());
    file.contact.is_some() && !file.shape.is_empty() && !weighs && !densities
}

/// The solids of a body.
pub(super) fn shapes(
    file: &BodyFile,
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Vec<ShapeInstance> {
    let solids = file.shape.iter().enumerate().filter(|(_, s)| is_solid(s));
    let one = |(k, shape): (usize, &ShapeFile)| {
        let pointer = format!("{pointer}/shape/{k}");
        if let Some(torus) = shape.torus.as_ref().filter(|torus| torus.tube_radius > torus.major_radius) {
            let message = format!(
                "the tube of the torus is wider, {}, than its circle, {}",
                torus.tube_radius, torus.major_radius
            );
            let diagnostic = Diagnostic::error(&document.at(&format!("{pointer}/torus/tube_radius")), message);
            diagnostics.push(diagnostic.with_help("give a `tube_radius` up to `major_radius`; a ball is a `sphere`"));
        }
        let placement = Placement::new(shape.position, shape.rotation_deg, shape.quaternion_wxyz);
        ShapeInstance {
            shape: solid(shape),
            pose: placement::pose(&placement, &pointer, document, diagnostics),
            density: shape.density.or(file.density),
            color: shape.color.as_ref().and_then(|text| color_of(text, &pointer, document, diagnostics)),
        }
    };
    solids.map(one).collect()
}

fn is_solid(file: &ShapeFile) -> bool {
    file.plane.is_none() && file.hull.is_none() && file.mesh.is_none() && file.height_field.is_none()
}

fn solid(file: &ShapeFile) -> Shape {
    match file {
        ShapeFile { cuboid: Some(c), .. } => Shape::Cuboid { size: c.size },
        ShapeFile { cylinder: Some(c), .. } => Shape::Cylinder { radius: c.radius, length: c.length },
        ShapeFile { capsule: Some(c), .. } => Shape::Capsule { radius: c.radius, length: c.length },
        ShapeFile { cone: Some(c), .. } => Shape::Cone { radius: c.radius, length: c.length },
        ShapeFile { torus: Some(t), .. } => Shape::Torus { major_radius: t.major_radius, tube_radius: t.tube_radius },
        ShapeFile { sphere, .. } => {
            Shape::Sphere { radius: sphere.as_ref().expect("the schema wants one kind of shape").radius }
        }
    }
}

/// Red, green and blue of the `color` of a table; notes what is none.
pub(super) fn color_of(
    text: &str,
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Option<[u8; 3]> {
    color(text, &document.at(&format!("{pointer}/color")), diagnostics)
}

/// Red, green and blue of `#rrggbb`; notes what is none.
pub(super) fn color(text: &str, at: &Location, diagnostics: &mut Diagnostics) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()));
    let Some(digits) = digits else {
        let diagnostic = Diagnostic::error(at, format!("`{text}` is not a colour"));
        diagnostics.push(diagnostic.with_help("write \"#rrggbb\", such as \"#8a5a2b\""));
        return None;
    };
    let number = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = number.to_be_bytes();
    Some([r, g, b])
}

/// Mass properties of a body; notes combinations that make no sense.
pub(super) fn mass(
    file: &BodyFile,
    shapes: &[ShapeInstance],
    meshes: &[MeshInstance],
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> MassProperties {
    let solids = shapes.iter().map(Solid::Shape).chain(meshes.iter().map(Solid::Mesh)).collect();
    if meshes.len() < file.shape.iter().filter(|s| s.mesh.is_some()).count() {
        // one of them was refused, and no more can be said
        return UNIT;
    }
    let mut judge = Judge { file, solids, pointer, document, diagnostics };
    judge.mass().unwrap_or(UNIT)
}

/// Solid that encloses a volume.
enum Solid<'a> {
    Shape(&'a ShapeInstance),
    Mesh(&'a MeshInstance),
}

impl Solid<'_> {
    fn density(&self) -> Option<f64> {
        match self {
            Self::Shape(shape) => shape.density,
            Self::Mesh(mesh) => mesh.density,
        }
    }

    /// In the body's frame; of density 1 where none is given.
    fn mass_properties(&self) -> MassProperties {
        let density = self.density().unwrap_or(1.0);
        match self {
            Self::Shape(s) => s.shape.mass_properties(density).placed(&s.pose.rot, s.pose.pos),
            Self::Mesh(mesh) => mesh.mass_properties(density),
        }
    }
}

struct Judge<'a> {
    file: &'a BodyFile,
    solids: Vec<Solid<'a>>,
    pointer: &'a str,
    document: &'a Document,
    diagnostics: &'a mut Diagnostics,
}

impl Judge<'_> {
    fn mass(&mut self) -> Option<MassProperties> {
        let BodyFile { mass, inertia, density, .. } = self.file;
        match (mass, inertia, density) {
            (Some(_), _, Some(_)) => {
                self.refuse("density", "`mass` and `density` both say what it weighs", "leave one of them out")
            }
            (Some(mass), Some(inertia), None) => {
                self.warn_of_idle_densities();
                let center_of_mass = self.file.center_of_mass.unwrap_or([0.0; 3]);
                let inertia = [inertia.xx, inertia.xy, inertia.xz, inertia.yy, inertia.yz, inertia.zz];
                Some(MassProperties { mass: *mass, center_of_mass, inertia })
            }
            (Some(mass), None, None) => self.distributed(*mass),
            (None, Some(_), _) => self.refuse("inertia", "`inertia` without `mass`", "give the mass too [kg]"),
            (None, None, _) => self.at_density(),
        }
    }

    /// Shapes say how a given mass is distributed.
    fn distributed(&mut self, mass: f64) -> Option<MassProperties> {
        self.no_center_of_mass()?;
        if self.solids.is_empty() {
            let help = "give `inertia` too, or shapes that say how the mass is distributed";
            return self.refuse("mass", "`mass` without `inertia` and without shapes", help);
        }
        let given = self.solids.iter().filter(|s| s.density().is_some()).count();
        if given != 0 && given != self.solids.len() {
            let help = "give every shape a density (they are scaled to `mass`) or none";
            return self.refuse("mass", "some shapes have a density and some have none", help);
        }
        let sum = self.sum();
        let factor = mass / sum.mass;
        Some(MassProperties { mass, inertia: sum.inertia.map(|i| i * factor), ..sum })
    }

    fn at_density(&mut self) -> Option<MassProperties> {
        self.no_center_of_mass()?;
        if self.solids.is_empty() {
            return match self.file.density {
                Some(_) => self.refuse("density", "`density` without shapes", "give shapes, or `mass` and `inertia`"),
                None => {
                    let help = "give `density` and shapes, or `mass` and `inertia`; what has no mass is a frame";
                    self.refuse("name", "it has no mass", help)
                }
            };
        }
        let weighs = |s: &ShapeFile| is_solid(s) || s.mesh.is_some();
        let without = |s: &ShapeFile| weighs(s) && s.density.or(self.file.density).is_none();
        if let Some(k) = self.file.shape.iter().position(without) {
            let help = "give `density` for the body or for each shape [kg/m³], or `mass` [kg]";
            return self.refuse(&format!("shape/{k}"), "a shape has no density", help);
        }
        Some(self.sum())
    }

    /// Mass properties of all shapes; of density 1 where none is given.
    fn sum(&self) -> MassProperties {
        let parts: Vec<MassProperties> = self.solids.iter().map(Solid::mass_properties).collect();
        MassProperties::sum(&parts)
    }

    fn no_center_of_mass(&mut self) -> Option<()> {
        if self.file.center_of_mass.is_none() {
            return Some(());
        }
        let help = "it goes with `mass` and `inertia`; else the shapes say where it is";
        self.refuse("center_of_mass", "`center_of_mass` without `mass` and `inertia`", help).map(|_| ())
    }

    fn warn_of_idle_densities(&mut self) {
        for (k, shape) in self.file.shape.iter().enumerate() {
            if shape.density.is_some() {
                let at = self.document.key_at(&format!("{}/shape/{k}/density", self.pointer));
                let message = format!("the density of a shape of `{}` has no effect", self.file.name);
                let diagnostic = Diagnostic::error(&at, message).as_warning();
                self.diagnostics.push(diagnostic.with_help("`mass` and `inertia` are given, shapes only show"));
            }
        }
    }

    fn refuse(&mut self, key: &str, message: &str, help: &str) -> Option<MassProperties> {
        let pointer = format!("{}/{key}", self.pointer);
        let at = if key.contains('/') { self.document.at(&pointer) } else { self.document.key_at(&pointer) };
        let at = if key == "name" { self.document.title_at(self.pointer) } else { at };
        let diagnostic = Diagnostic::error(&at, format!("body `{}`: {message}", self.file.name));
        self.diagnostics.push(diagnostic.with_help(help));
        None
    }
}

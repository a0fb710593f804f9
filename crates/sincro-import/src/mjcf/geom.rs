//! Geoms: what shows, what touches, and the mass they give their body. Assets: meshes and colours.

use std::cell::RefCell;
use std::collections::BTreeMap;

use sincro_dynamics::geometry::polyhedron;
use sincro_dynamics::model::{MassProperties, Shape as Solid};
use sincro_dynamics::spatial::Vec3;
use sincro_scene::diagnostic::Diagnostic;

use super::Reader;
use super::orientation::{placement, rotation_of, z_along};
use crate::color::rgb;
use crate::findings::Findings;
use crate::robot::{Geometry, Inertial, Link, Placement, Rotation, Shape, SurfaceLaw};
use crate::source::Element;

/// Density where a geom gives neither mass nor density [kg/m³].
const DENSITY: f64 = 1000.0;
/// Groups of geoms above this one are hidden.
const SHOWN_GROUPS: f64 = 2.0;

/// A mesh of the assets.
#[derive(Clone, Debug)]
pub(super) struct MeshAsset {
    /// Its file, relative to the model's folder; none if its vertices are in the model.
    file: Option<String>,
    scale: [f64; 3],
    /// Reference frame that is taken off.
    reference: Placement,
    inertia: MeshInertia,
}

/// Mass properties of meshes by file, bits of their factors and rule.
pub(super) type MeshMasses = RefCell<BTreeMap<(String, [u64; 3], MeshInertia), MassProperties>>;

/// Rules by which a mesh gives mass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum MeshInertia {
    /// That of the volume that it encloses.
    Exact,
    /// That of its convex hull.
    Convex,
    /// That of its triangles, as thin as paper: the density is that of an area.
    Shell,
    /// That of all tetrahedra between its triangles and a centre, each counted as positive.
    Legacy,
}

impl<'d> Reader<'d> {
    /// Meshes and materials.
    pub(super) fn assets(&mut self, asset: Element<'d>, findings: &mut Findings) {
        for element in self.files.elements(asset) {
            match element.name() {
                "mesh" => {
                    element.keep();
                    let read = self.mesh_asset(element);
                    if let Some((name, mesh)) = findings.take(read) {
                        self.meshes.insert(name, mesh);
                    }
                }
                "hfield" => {
                    element.keep();
                    let read = self.height_field(element);
                    if let Some((name, field)) = findings.take(read) {
                        self.fields.insert(name, field);
                    }
                }
                "material" => {
                    element.keep();
                    element.attribute("class");
                    let color = findings.take(self.defaults.numbers(element, "main", "rgba")).flatten();
                    if let (Some(name), Some(color)) = (element.attribute("name"), color.and_then(|c| rgb(&c))) {
                        self.materials.insert(name.to_owned(), color);
                    }
                }
                _ => {}
            }
        }
    }

    /// Path of the file of a mesh or height field; none if it names none.
    pub(super) fn asset_file(&self, e: Element<'d>) -> Option<String> {
        e.attribute("file").map(|file| {
            let file = if self.settings.strip_path { file.rsplit(['/', '\\']).next().unwrap_or(file) } else { file };
            let folder = &self.settings.mesh_folder;
            if folder.is_empty() || file.starts_with('/') {
                file.to_owned()
            } else {
                format!("{}/{file}", folder.trim_end_matches('/'))
            }
        })
    }

    fn mesh_asset(&self, e: Element<'d>) -> Result<(String, MeshAsset), Diagnostic> {
        let file = self.asset_file(e);
        let name = asset_name(e, file.as_deref());
        let scale = self.defaults.vector(e, "main", "scale")?.unwrap_or([1.0; 3]);
        let position = e.vector("refpos")?.unwrap_or_default();
        let rotation = match e.numbers("refquat")?.as_deref() {
            Some(&[w, x, y, z]) => Rotation::Quaternion([w, x, y, z]),
            _ => Rotation::RollPitchYaw([0.0; 3]),
        };
        let inertia = match self.defaults.text(e, "main", "inertia") {
            None | Some("legacy") => MeshInertia::Legacy,
            Some("exact") => MeshInertia::Exact,
            Some("convex") => MeshInertia::Convex,
            Some("shell") => MeshInertia::Shell,
            Some(other) => return Err(e.error(format!("the inertia `{other}` of a mesh is not computed"))),
        };
        Ok((name, MeshAsset { file, scale, reference: Placement { position, rotation }, inertia }))
    }

    /// Adds a geom to a link; returns the mass it gives the body, if bodies have theirs from geoms here.
    pub(super) fn geom(
        &self,
        e: Element<'d>,
        frame: Placement,
        class: &str,
        (link, gives_mass): (&mut Link, bool),
        findings: &mut Findings,
    ) -> Option<MassProperties> {
        e.attribute("name");
        let (shape, own) = match findings.take(self.shape(e, class))? {
            Ok(found) => found,
            Err(why) => {
                if gives_mass && findings.take(self.has_mass(e, class))? {
                    let words = format!("a geom gives its body mass, and cannot be read: {why}");
                    findings.error(e.error(words).with_help("give the body an `inertial`"));
                } else {
                    findings.warn(e.error(format!("a geom is left out: {why}")));
                    e.drop(&why);
                }
                return None;
            }
        };
        let pose = frame.then(&own);
        let read = self.surface(e, class);
        let (touches, shows, color, surface) = findings.take(read)?;
        let piece = Geometry { at: e.location(), element: e.id(), pose, shape: shape.clone(), color, surface };
        if touches {
            link.collisions.push(piece.clone());
        }
        if shows && (shape != Shape::Plane || touches) {
            link.visuals.push(piece);
        }
        if !touches && !shows {
            e.change("it neither touches nor shows: its mass alone counts");
        }
        if !gives_mass {
            return None;
        }
        let mass = findings.take(self.mass(e, class, &shape))?;
        mass.map(|mass| {
            let x = pose.pose();
            mass.placed(&x.rot, x.pos)
        })
    }

    #[allow(clippy::type_complexity)]
    fn surface(
        &self,
        e: Element<'d>,
        class: &str,
    ) -> Result<(bool, bool, Option<[u8; 3]>, Option<SurfaceLaw>), Diagnostic> {
        let d = &self.defaults;
        let mask = |name: &str| d.number(e, class, name).map(|x| x.unwrap_or(1.0) != 0.0);
        let touches = mask("contype")? | mask("conaffinity")?;
        let shows = d.number(e, class, "group")?.unwrap_or(0.0) <= SHOWN_GROUPS;
        let material = d.text(e, class, "material").and_then(|m| self.materials.get(m).copied());
        let own = d.numbers(e, class, "rgba")?;
        let invisible = own.as_deref().is_some_and(|c| c.get(3) == Some(&0.0));
        let color = own.and_then(|c| rgb(&c)).or(material);
        let friction = d.numbers(e, class, "friction")?.unwrap_or_default();
        let get = |k: usize, default: f64| friction.get(k).copied().unwrap_or(default);
        // torsional and rolling friction act in contacts of these dimensions only
        let dimension = d.number(e, class, "condim")?.unwrap_or(3.0);
        let surface = SurfaceLaw {
            friction: if dimension > 1.0 { get(0, 1.0) } else { 0.0 },
            spinning_friction: if dimension > 3.0 { get(1, 0.005) } else { 0.0 },
            rolling_friction: if dimension > 4.0 { get(2, 0.0001) } else { 0.0 },
        };
        Ok((touches, shows && !invisible, color, touches.then_some(surface)))
    }

    /// Shape and placement; the reason if the scene has none for it.
    fn shape(&self, e: Element<'d>, class: &str) -> Result<Result<(Shape, Placement), String>, Diagnostic> {
        let d = &self.defaults;
        let size = d.numbers(e, class, "size")?.unwrap_or_default();
        let kind = d.text(e, class, "type").unwrap_or(if e.peek("mesh").is_some() { "mesh" } else { "sphere" });
        if let Some(ends) = d.numbers(e, class, "fromto")? {
            let (pose, length) = between(&ends).ok_or_else(|| e.error("`fromto` has six numbers, two points apart"))?;
            let r = *size.first().ok_or_else(|| e.error("a geom has no `size`"))?;
            return Ok(Ok((
                match kind {
                    "capsule" => Shape::Capsule(r, length),
                    "cylinder" => Shape::Cylinder(r, length),
                    "box" => Shape::Cuboid([2.0 * r, 2.0 * size.get(1).copied().unwrap_or(r), length]),
                    "ellipsoid" => Shape::Ellipsoid([r, size.get(1).copied().unwrap_or(r), 0.5 * length]),
                    other => return Err(e.error(format!("`fromto` for a {other}"))),
                },
                pose,
            )));
        }
        let pose = placement(e, class, d, &self.angles)?;
        let get = |k: usize| {
            size.get(k).copied().ok_or_else(|| e.error(format!("`size` of a {kind} has {} numbers", size.len())))
        };
        let shape = match kind {
            "plane" => Shape::Plane,
            "sphere" => Shape::Sphere(get(0)?),
            "capsule" => Shape::Capsule(get(0)?, 2.0 * get(1)?),
            "cylinder" => Shape::Cylinder(get(0)?, 2.0 * get(1)?),
            "ellipsoid" => Shape::Ellipsoid([get(0)?, get(1)?, get(2)?]),
            "box" => Shape::Cuboid([2.0 * get(0)?, 2.0 * get(1)?, 2.0 * get(2)?]),
            "mesh" => {
                let name = d.text(e, class, "mesh").unwrap_or("");
                let Some(asset) = self.meshes.get(name) else {
                    return Err(e.error(format!("there is no mesh `{name}`")));
                };
                let Some(file) = &asset.file else {
                    return Ok(Err("meshes with vertices in the model are not read".into()));
                };
                let inverse = Placement::of_pose(&asset.reference.pose().inverse());
                let pose = if asset.reference.is_identity() { pose } else { pose.then(&inverse) };
                return Ok(Ok((Shape::Mesh { uri: file.clone(), scale: asset.scale }, pose)));
            }
            "hfield" => {
                let name = d.text(e, class, "hfield").unwrap_or("");
                let Some(field) = self.fields.get(name) else {
                    return Err(e.error(format!("there is no height field `{name}`")));
                };
                return Ok(field.clone().map(|shape| (shape, pose)));
            }
            other => return Ok(Err(format!("a `{other}` has no counterpart"))),
        };
        Ok(Ok((shape, pose)))
    }

    /// Returns true if a geom has mass that counts.
    fn has_mass(&self, e: Element<'d>, class: &str) -> Result<bool, Diagnostic> {
        let number = |name: &str| self.defaults.number(e, class, name);
        let group = number("group")?.unwrap_or(0.0) as i64;
        let [low, high] = self.settings.inertia_groups;
        let factor = number("mass")?.or(number("density")?).unwrap_or(DENSITY);
        Ok((low..=high).contains(&group) && factor != 0.0)
    }

    /// Mass in the frame of the geom.
    fn mass(&self, e: Element<'d>, class: &str, shape: &Shape) -> Result<Option<MassProperties>, Diagnostic> {
        let d = &self.defaults;
        let given = d.number(e, class, "mass")?;
        let density = d.number(e, class, "density")?.unwrap_or(DENSITY);
        let shell = d.text(e, class, "shellinertia") == Some("true");
        if !self.has_mass(e, class)? {
            return Ok(None);
        }
        let Some(unit) = self.unit_mass(e, class, shape)? else { return Ok(None) };
        if shell {
            return Err(e
                .error("the inertia of shells (`shellinertia`) is not computed")
                .with_help("give the body an `inertial`"));
        }
        let factor = given.map_or(density, |mass| mass / unit.mass);
        Ok(Some(MassProperties { mass: unit.mass * factor, inertia: unit.inertia.map(|i| i * factor), ..unit }))
    }

    /// Mass properties at density 1.
    fn unit_mass(&self, e: Element<'d>, class: &str, shape: &Shape) -> Result<Option<MassProperties>, Diagnostic> {
        let solid = match shape {
            Shape::Cuboid(size) => Solid::Cuboid { size: *size },
            Shape::Sphere(radius) => Solid::Sphere { radius: *radius },
            Shape::Cylinder(radius, length) => Solid::Cylinder { radius: *radius, length: *length },
            Shape::Capsule(radius, length) => Solid::Capsule { radius: *radius, length: *length },
            Shape::Plane | Shape::HeightField { .. } => return Ok(None),
            Shape::Ellipsoid([a, b, c]) => {
                let mass = 4.0 / 3.0 * std::f64::consts::PI * a * b * c;
                let moment = |p: &f64, q: &f64| mass / 5.0 * (p * p + q * q);
                let inertia = [moment(b, c), 0.0, 0.0, moment(a, c), 0.0, moment(a, b)];
                return Ok(Some(MassProperties { mass, center_of_mass: [0.0; 3], inertia }));
            }
            Shape::Mesh { uri, scale } => return self.mesh_mass((e, class), uri, *scale).map(Some),
        };
        let mass = solid.mass_properties(1.0);
        if mass.mass > 0.0 && mass.mass.is_finite() { Ok(Some(mass)) } else { Err(e.error("a geom has no volume")) }
    }

    fn mesh_mass(
        &self,
        (e, class): (Element<'d>, &str),
        uri: &str,
        scale: [f64; 3],
    ) -> Result<MassProperties, Diagnostic> {
        // several assets may read one file, each by a rule of its own
        let asset = self.defaults.text(e, class, "mesh").and_then(|name| self.meshes.get(name));
        let rule = asset.map_or(MeshInertia::Legacy, |asset| asset.inertia);
        let key = (uri.to_owned(), scale.map(f64::to_bits), rule);
        if let Some(known) = self.mesh_masses.borrow().get(&key) {
            return Ok(*known);
        }
        let mass = self.read_mesh_mass(e, uri, scale, rule)?;
        self.mesh_masses.borrow_mut().insert(key, mass);
        Ok(mass)
    }

    fn read_mesh_mass(
        &self,
        e: Element<'d>,
        uri: &str,
        scale: [f64; 3],
        rule: MeshInertia,
    ) -> Result<MassProperties, Diagnostic> {
        let path = crate::resolve::Resolver::new(&self.folder, &[]).find(uri);
        let parts = path.and_then(|path| crate::mesh::read(&path));
        let parts = parts.map_err(|why| {
            e.error(format!("the mesh `{uri}` gives its body mass, and it is missing: {why}"))
                .with_help("give the body an `inertial`")
        })?;
        let mut all = Vec::new();
        for part in &parts {
            let corners: Vec<[f64; 3]> =
                part.corners.iter().map(|p| std::array::from_fn(|c| p[c] * scale[c])).collect();
            all.push(match rule {
                MeshInertia::Exact => polyhedron::mass_properties(&corners, &part.triangles, 1.0),
                MeshInertia::Legacy => legacy(&corners, &part.triangles),
                MeshInertia::Shell => shell(&corners, &part.triangles),
                MeshInertia::Convex => {
                    let (corners, triangles) = polyhedron::convex_hull(&corners)
                        .ok_or_else(|| e.error(format!("the mesh `{uri}` has no convex hull")))?;
                    polyhedron::mass_properties(&corners, &triangles, 1.0)
                }
            });
        }
        let sum = MassProperties::sum(&all);
        let flipped = if sum.mass < 0.0 { -1.0 } else { 1.0 };
        let sum = MassProperties { mass: sum.mass * flipped, inertia: sum.inertia.map(|i| i * flipped), ..sum };
        if sum.mass > 0.0 && sum.mass.is_finite() {
            Ok(sum)
        } else {
            Err(e.error(format!("the mesh `{uri}` has no volume")))
        }
    }
}

/// Name of an asset: its own, or that of its file without the ending.
pub(super) fn asset_name(e: Element<'_>, file: Option<&str>) -> String {
    let stem = |file: &str| {
        let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
        last.rsplit_once('.').map_or(last, |(stem, _)| stem).to_owned()
    };
    e.attribute("name").map(str::to_owned).or_else(|| file.map(stem)).unwrap_or_default()
}

/// Mass properties at density 1 by MuJoCo's older rule: tetrahedra from a centre to the triangles, each counted as
/// positive; the centre is first the mean of the faces, then the centre of mass that this gives.
fn legacy(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> MassProperties {
    let at = |k: u32| Vec3(corners[k as usize]);
    let face = |t: &[u32; 3]| {
        let (a, b, c) = (at(t[0]), at(t[1]), at(t[2]));
        let normal = (b - a).cross(c - a);
        (a, b, c, normal, (a + b + c).scale(1.0 / 3.0))
    };
    let (mut area, mut centre) = (0.0, Vec3::zero());
    for (.., normal, middle) in triangles.iter().map(face) {
        area += normal.norm();
        centre += middle.scale(normal.norm());
    }
    let centre = centre.scale(1.0 / area);
    let (mut volume, mut com) = (0.0, Vec3::zero());
    for (.., normal, middle) in triangles.iter().map(face) {
        let part = (normal.dot(middle - centre) / 6.0).abs();
        volume += part;
        com += (middle.scale(0.75) + centre.scale(0.25)).scale(part);
    }
    let com = com.scale(1.0 / volume);
    let parts = triangles.iter().map(face).map(|(a, b, c, normal, middle)| {
        let part = (normal.dot(middle - com) / 6.0).abs();
        (part, part / 20.0, [a - com, b - com, c - com])
    });
    gathered(parts, com)
}

/// Mass properties of the triangles of a mesh as a thin shell of density 1 kg/m².
fn shell(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> MassProperties {
    let face = |t: &[u32; 3]| t.map(|k| Vec3(corners[k as usize]));
    let area = |[a, b, c]: [Vec3<f64>; 3]| 0.5 * (b - a).cross(c - a).norm();
    let total: f64 = triangles.iter().map(|t| area(face(t))).sum();
    let weighted = triangles.iter().map(|t| {
        let [a, b, c] = face(t);
        (a + b + c).scale(area([a, b, c]) / 3.0)
    });
    let com = weighted.fold(Vec3::zero(), |sum, x| sum + x).scale(1.0 / total);
    let parts = triangles.iter().map(|t| (area(face(t)), area(face(t)) / 12.0, face(t).map(|v| v - com)));
    gathered(parts, com)
}

/// Mass properties of simplices about a centre: the mass of each, the factor of its second moments, and the corners
/// that are not the centre.
fn gathered(parts: impl Iterator<Item = (f64, f64, [Vec3<f64>; 3])>, com: Vec3<f64>) -> MassProperties {
    let (mut mass, mut p) = (0.0, [[0.0; 3]; 3]);
    for (part, factor, corners) in parts {
        mass += part;
        let sum = corners[0] + corners[1] + corners[2];
        for (i, row) in p.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let squares: f64 = corners.iter().map(|v| v[i] * v[j]).sum();
                *entry += factor * (squares + sum[i] * sum[j]);
            }
        }
    }
    let inertia = [p[1][1] + p[2][2], -p[0][1], -p[0][2], p[0][0] + p[2][2], -p[1][2], p[0][0] + p[1][1]];
    MassProperties { mass, center_of_mass: com.0, inertia }
}

/// Placement and length of a geom between two points, its z axis along them.
pub(super) fn between(ends: &[f64]) -> Option<(Placement, f64)> {
    let [a, b, c, d, e, f] = *ends else { return None };
    let (from, to) = (Vec3([a, b, c]), Vec3([d, e, f]));
    let along = from - to;
    let rot = z_along(along)?;
    let middle = (from + to).scale(0.5);
    Some((Placement { position: middle.0, rotation: rotation_of(&rot) }, along.norm()))
}

/// Mass properties of all geoms of a body.
pub(super) fn sum(masses: &[MassProperties]) -> Option<Inertial> {
    if masses.is_empty() {
        return None;
    }
    let MassProperties { mass, center_of_mass, inertia } = MassProperties::sum(masses);
    (mass > 0.0).then_some(Inertial { mass, center_of_mass, inertia })
}

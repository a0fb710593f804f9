//! Links of SDF: mass, geometry and sensors.

use sincro_scene::diagnostic::Diagnostic;

use super::frames::Places;
use super::{Raw, pose_of};
use crate::color::rgb;
use crate::findings::Findings;
use crate::robot::{
    Geometry, Inertial, Link, Optics, Placement, Robot, Rotation, Sensor, SensorKind, Shape, SurfaceLaw, turned_inertia,
};
use crate::source::Element;

/// A link; its place comes later.
pub(super) fn link(element: Element<'_>, name: &str, findings: &mut Findings) -> Link {
    let inertial = element.child("inertial").and_then(|e| findings.take(inertial(e)));
    let mut pieces = |kind: &str| -> Vec<Geometry> {
        element.children(kind).into_iter().filter_map(|e| piece(e, findings)).collect()
    };
    let (visuals, collisions) = (pieces("visual"), pieces("collision"));
    if inertial.is_none() {
        element.change("without inertial; the mass of 1 kg that the format implies is not assumed");
    }
    Link {
        name: name.to_owned(),
        at: element.location(),
        pose: Placement::default(),
        inertial,
        visuals,
        collisions,
        is_virtual: false,
        group: None,
    }
}

/// Places of the links that nothing carries; joints place the others.
pub(super) fn place(robot: &mut Robot, raw: &Raw<'_>, places: &Places) {
    for (link, (_, name)) in robot.links.iter_mut().zip(&raw.links) {
        link.pose = Placement::of_pose(&places.of(name));
    }
}

fn number_of(element: Element<'_>, name: &str) -> Result<Option<f64>, Diagnostic> {
    let Some(child) = element.child(name) else { return Ok(None) };
    match child.text_numbers()?[..] {
        [x] => Ok(Some(x)),
        _ => Err(child.error(format!("`{name}` is one number"))),
    }
}

fn inertial(element: Element<'_>) -> Result<Inertial, Diagnostic> {
    let pose = pose_of(element)?.unwrap_or_default();
    let mass = number_of(element, "mass")?.unwrap_or(1.0);
    let mut inertia = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0];
    if let Some(given) = element.child("inertia") {
        for (entry, name) in inertia.iter_mut().zip(["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]) {
            *entry = number_of(given, name)?.unwrap_or(*entry);
        }
    }
    let turned = turned_inertia(&pose.pose().rot, inertia);
    if turned != inertia {
        element.change("the inertia matrix is turned into the axes of the link");
    }
    Ok(Inertial { mass, center_of_mass: pose.position, inertia: turned })
}

fn piece(element: Element<'_>, findings: &mut Findings) -> Option<Geometry> {
    element.attribute("name");
    let pose = findings.take(pose_of(element))?.unwrap_or_default();
    let geometry = element.child("geometry")?;
    let (shape, correction) = match findings.take(shape(geometry))? {
        Ok(shape) => shape,
        Err(why) => {
            findings.warn(geometry.error(format!("geometry is left out: {why}")));
            element.drop(&why);
            return None;
        }
    };
    let pose = pose.then(&correction);
    let color = element.child("material").and_then(|material| {
        let color = material.child("diffuse").or_else(|| material.child("ambient"))?;
        rgb(&findings.take(color.text_numbers())?)
    });
    let friction = element.child("surface").and_then(|s| s.child("friction")).and_then(|f| f.child("ode"));
    let friction = friction.and_then(|ode| findings.take(number_of(ode, "mu")).flatten());
    let surface = friction.map(|friction| SurfaceLaw { friction, spinning_friction: 0.0, rolling_friction: 0.0 });
    Some(Geometry { at: element.location(), element: element.id(), pose, shape, color, surface })
}

/// The shape and its own placement; the reason if the scene has none for it.
fn shape(geometry: Element<'_>) -> Result<Result<(Shape, Placement), String>, Diagnostic> {
    let Some(element) = geometry.elements().into_iter().next() else { return Ok(Err("it is empty".into())) };
    let vector = |name: &str| -> Result<[f64; 3], Diagnostic> {
        let child =
            element.child(name).ok_or_else(|| element.error(format!("`{}` has no `{name}`", element.name())))?;
        let n = child.text_numbers()?;
        n.try_into().map_err(|_| child.error(format!("`{name}` has three numbers")))
    };
    let positive = |name: &str| -> Result<f64, Diagnostic> {
        number_of(element, name)?.ok_or_else(|| element.error(format!("`{}` has no `{name}`", element.name())))
    };
    let plain = |shape| (shape, Placement::default());
    let made = match element.name() {
        "box" => plain(Shape::Cuboid(vector("size")?)),
        "sphere" => plain(Shape::Sphere(positive("radius")?)),
        "cylinder" => plain(Shape::Cylinder(positive("radius")?, positive("length")?)),
        "capsule" => plain(Shape::Capsule(positive("radius")?, positive("length")?)),
        "ellipsoid" => plain(Shape::Ellipsoid(vector("radii")?)),
        "plane" => {
            let normal = if element.child("normal").is_some() { vector("normal")? } else { [0.0, 0.0, 1.0] };
            if normal[0] != 0.0 || normal[1] != 0.0 {
                return Ok(Err("only planes with their normal along z are read".into()));
            }
            element.change("a plane without bounds");
            plain(Shape::Plane)
        }
        "mesh" => {
            let Some(uri) = element.child("uri") else { return Err(element.error("`mesh` has no `uri`")) };
            let scale = if element.child("scale").is_some() { vector("scale")? } else { [1.0; 3] };
            plain(Shape::Mesh { uri: uri.text().to_owned(), scale })
        }
        "empty" => return Ok(Err("it is empty".into())),
        other => return Ok(Err(format!("`{other}` is no geometry of the scene"))),
    };
    element.keep();
    Ok(Ok(made))
}

/// Sensors of the links.
pub(super) fn sensors(robot: &mut Robot, raw: &Raw<'_>, findings: &mut Findings) {
    for (k, (element, _)) in raw.links.iter().enumerate() {
        for sensor in element.children("sensor") {
            let name = sensor.attribute("name").unwrap_or("sensor").to_owned();
            let kind = match sensor.attribute("type") {
                Some("imu") => SensorKind::Imu,
                Some("contact") => SensorKind::Contact,
                Some("camera" | "depth_camera" | "depth" | "rgbd_camera") => match findings.take(optics(sensor)) {
                    Some(optics) => SensorKind::Camera(optics),
                    None => continue,
                },
                Some(other) => {
                    sensor.drop(&format!("there is no sensor of kind `{other}`"));
                    continue;
                }
                None => continue,
            };
            let Some(pose) = findings.take(pose_of(sensor)) else { continue };
            let (mut pose, at) = (pose.unwrap_or_default(), sensor.location());
            if matches!(kind, SensorKind::Camera(_)) {
                let own = sensor.child("camera").and_then(|c| findings.take(pose_of(c)).flatten());
                // Gazebo's looks along x, with z up and y to the left
                let turned = Placement { position: [0.0; 3], rotation: Rotation::Quaternion([0.5; 4]) };
                pose = pose.then(&own.unwrap_or_default()).then(&turned);
            }
            robot.sensors.push(Sensor { name, at, link: k, pose, kind });
        }
    }
}

/// Optics of a camera: SDF gives the angle between the left and the right edge.
fn optics(sensor: Element<'_>) -> Result<Optics, Diagnostic> {
    let Some(camera) = sensor.child("camera") else {
        return Ok(Optics { field_of_view: 1.047, resolution: None, range: None });
    };
    let number = |element: Option<Element<'_>>, name: &str, default: f64| -> Result<f64, Diagnostic> {
        let Some(child) = element.and_then(|e| e.child(name)) else { return Ok(default) };
        let [x] = child.text_numbers()?[..] else { return Err(child.error(format!("`{name}` is one number"))) };
        Ok(x)
    };
    let image = camera.child("image");
    let (width, height) = (number(image, "width", 320.0)?, number(image, "height", 240.0)?);
    let horizontal = number(Some(camera), "horizontal_fov", 1.047)?;
    let is_side = |x: f64| x >= 1.0 && x <= f64::from(u16::MAX) && x.fract() == 0.0;
    if !(is_side(width) && is_side(height)) {
        return Err(camera.error(format!("a picture of {width} × {height}: expected whole numbers")));
    }
    if !(horizontal > 0.0 && horizontal < std::f64::consts::PI) {
        return Err(camera.error(format!("`horizontal_fov` is {horizontal} rad: expected more than 0, less than π")));
    }
    let clip = camera.child("clip");
    let range = match clip {
        None => None,
        Some(_) => Some([number(clip, "near", 0.1)?, number(clip, "far", 100.0)?]),
    };
    let (sine, cosine) = sincro_math::elementary::sin_cos(0.5 * horizontal);
    let field_of_view = 2.0 * sincro_math::elementary::atan2(sine * height, cosine * width).0;
    Ok(Optics { field_of_view, resolution: Some([width as u32, height as u32]), range })
}

//! Keys that tables of a scene file have for a shape and for the mass of a body.

use serde_json::{Map, Value};
use sincro_dynamics::contact::Surface;
use sincro_dynamics::model::{MassProperties, Shape};
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};

/// Keys of a table.
fn table<const N: usize>(keys: [(&str, Value); N]) -> Map<String, Value> {
    keys.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// Keys of mass `[kg]`, centre of mass `[m]` and inertia about it `[kg·m²]` of a body.
#[must_use]
pub fn mass_keys(mass: &MassProperties) -> Map<String, Value> {
    let [xx, xy, xz, yy, yz, zz] = mass.inertia;
    let inertia = [("xx", xx), ("xy", xy), ("xz", xz), ("yy", yy), ("yz", yz), ("zz", zz)];
    let inertia = inertia.map(|(key, value)| (key, Value::from(value)));
    table([
        ("mass", mass.mass.into()),
        ("center_of_mass", Value::from(mass.center_of_mass.to_vec())),
        ("inertia", Value::Object(table(inertia))),
    ])
}

/// Keys of a shape that has the form of a surface; meshes are their convex hulls. None for a surface without volume.
#[must_use]
pub fn shape_keys(surface: &Surface) -> Option<Map<String, Value>> {
    let round = |radius: f64, length: f64| Value::Object(table([("radius", radius.into()), ("length", length.into())]));
    let points = |list: &[[f64; 3]]| {
        let list: Vec<Value> = list.iter().map(|p| Value::from(p.to_vec())).collect();
        table([("hull", Value::Object(table([("points", Value::Array(list))])))])
    };
    Some(match surface {
        Surface::Solid(Shape::Cuboid { size }) if size.iter().all(|x| *x > 0.0) => {
            table([("cuboid", Value::Object(table([("size", Value::from(size.to_vec()))])))])
        }
        Surface::Solid(Shape::Sphere { radius }) => {
            table([("sphere", Value::Object(table([("radius", (*radius).into())])))])
        }
        Surface::Solid(Shape::Cylinder { radius, length }) if *length > 0.0 => {
            table([("cylinder", round(*radius, *length))])
        }
        Surface::Solid(Shape::Cone { radius, length }) => table([("cone", round(*radius, *length))]),
        Surface::Solid(Shape::Capsule { radius, length }) => table([("capsule", round(*radius, *length))]),
        Surface::Hull(list) | Surface::Mesh(list, _) => points(list),
        _ => return None,
    })
}

/// Pose that `position` and `quaternion_wxyz` of a table give.
#[must_use]
pub fn pose_of(keys: &Map<String, Value>) -> Pose<f64> {
    let numbers = |key: &str| -> Option<Vec<f64>> { keys.get(key)?.as_array()?.iter().map(Value::as_f64).collect() };
    let pos = numbers("position").and_then(|list| list.try_into().ok()).map_or(Vec3([0.0; 3]), Vec3);
    let quaternion = numbers("quaternion_wxyz").and_then(|list| <[f64; 4]>::try_from(list).ok());
    let rot = quaternion.map_or_else(Mat3::identity, |q| Quat::from_slice(&q).normalized().matrix());
    Pose { rot, pos }
}

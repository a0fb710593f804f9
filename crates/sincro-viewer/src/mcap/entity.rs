//! Entities of Foxglove's `SceneUpdate`: the shapes of the bodies.

use mcap::McapError;
use serde_json::{Value, json};
use sincro_sim::replay::{ObjectView, SceneView, ShapeView};

use super::{Recording, stamp, xyz, xyzw};

/// Least half edge of a plane's piece `[m]`.
const LEAST_PIECE: f64 = 2.0;

/// An entity that stays until the next one of that name.
pub(super) fn entity(t: f64, frame: &str, id: &str, what: &[(&str, Vec<Value>)]) -> Value {
    let mut entity = json!({
        "timestamp": stamp(t), "frame_id": frame, "id": id, "lifetime": stamp(0.0), "frame_locked": true,
    });
    for (kind, list) in what {
        entity[*kind] = Value::Array(list.clone());
    }
    entity
}

/// The shapes of the bodies, each in the frame of its body.
pub(super) fn shapes(out: &mut Recording, view: &SceneView) -> Result<(), McapError> {
    let id = out.channel("/scene", "SceneUpdate")?;
    let reach = extent(view);
    let with_shapes = view.objects.iter().filter(|o| !o.shapes.is_empty());
    let entities: Vec<Value> = with_shapes.map(|o| of_object(o, reach)).collect();
    out.send(id, (0, 0.0), "SceneUpdate", &json!({ "entities": entities }))
}

/// About how large a scene is `[m]`: what its offsets and shapes span.
pub(super) fn extent(view: &SceneView) -> f64 {
    let length = |p: &[f64]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
    let of_object = |o: &ObjectView| {
        let offset = length(o.joint.as_ref().map_or(&o.pose, |joint| &joint.base_pose)[..3].as_ref());
        let radius = o.rotor.as_ref().and_then(|rotor| rotor.radius).unwrap_or(0.0);
        let shapes = o.shapes.iter().filter(|s| s.kind != "plane").map(|s| length(&s.pose[..3]) + length(&s.size));
        shapes.fold(offset + radius, f64::max)
    };
    let largest = view.objects.iter().map(of_object).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

fn of_object(object: &ObjectView, reach: f64) -> Value {
    let (mut cubes, mut spheres, mut cylinders, mut triangles) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for shape in &object.shapes {
        let (pose, color) = (pose(&shape.pose), color_of(shape));
        let size = |x: f64, y: f64, z: f64| json!({ "x": x, "y": y, "z": z });
        let at = |k: usize| shape.size.get(k).copied().unwrap_or(0.0);
        let (a, b) = (at(0), at(1));
        match shape.kind {
            "cuboid" => cubes.push(json!({ "pose": pose, "size": size(a, b, at(2)), "color": color })),
            "sphere" => spheres.push(json!({ "pose": pose, "size": size(2.0 * a, 2.0 * a, 2.0 * a), "color": color })),
            "mesh" => triangles.push(mesh(&pose, &shape.vertices, &shape.triangles, &color)),
            "plane" => {
                let half = (3.0 * reach).max(LEAST_PIECE) as f32;
                let corners = [[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]];
                triangles.push(mesh(&pose, &corners, &[[0, 1, 2], [0, 2, 3]], &color));
            }
            kind => {
                // a cone stands a quarter of its length above its centre of mass
                let pose = if kind == "cone" { raised(shape, 0.25 * b) } else { pose };
                let top = if kind == "cone" { 0.0 } else { 1.0 };
                cylinders.push(json!({ "pose": pose, "size": size(2.0 * a, 2.0 * a, b), "bottom_scale": 1.0, "top_scale": top, "color": color }));
                if kind == "capsule" {
                    let end = |by: f64| json!({ "pose": raised(shape, by), "size": size(2.0 * a, 2.0 * a, 2.0 * a), "color": color });
                    spheres.extend([end(-0.5 * b), end(0.5 * b)]);
                }
            }
        }
    }
    let all = [("cubes", cubes), ("spheres", spheres), ("cylinders", cylinders), ("triangles", triangles)];
    entity(0.0, &object.path, &object.path, &all)
}

fn mesh(pose: &Value, corners: &[[f32; 3]], triangles: &[[u32; 3]], color: &Value) -> Value {
    let points: Vec<Value> = corners.iter().map(|p| xyz(&p.map(f64::from))).collect();
    let indices: Vec<u32> = triangles.iter().flatten().copied().collect();
    json!({ "pose": pose, "points": points, "color": color, "indices": indices })
}

/// A pose as Foxglove writes it.
pub(super) fn pose(at: &[f64; 7]) -> Value {
    json!({ "position": xyz(at), "orientation": xyzw(&at[3..]) })
}

/// The pose of a shape moved along its own z axis.
fn raised(shape: &ShapeView, by: f64) -> Value {
    let [px, py, pz, x, y, z, w] = shape.pose;
    let axis = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)];
    pose(&[px + by * axis[0], py + by * axis[1], pz + by * axis[2], x, y, z, w])
}

fn color_of(shape: &ShapeView) -> Value {
    color(shape.color.as_deref().unwrap_or(if shape.kind == "plane" { "#d9dde2" } else { "#5b7f9e" }))
}

/// A colour from `#rrggbb`.
pub(super) fn color(text: &str) -> Value {
    let part = |k: usize| text.get(k..k + 2).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(128);
    let share = |k: usize| f64::from(part(k)) / 255.0;
    json!({ "r": share(1), "g": share(3), "b": share(5), "a": 1.0 })
}

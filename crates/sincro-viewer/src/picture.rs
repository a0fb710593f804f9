//! A still picture of a scene as SVG: what the gallery shows before anybody presses play, drawn without a browser or a graphics card.
//!
//! Solids become flat faces, seen from far away from the viewer's own first camera, painted from back to front and lit by one light. The same
//! scene and frame give the same bytes.

use sincro_math::elementary;
use sincro_sim::replay::{ObjectView, SceneView, ShapeView};

/// Where the camera stands, seen from what it looks at: as in the page.
const CAMERA: [f64; 3] = [0.55, -1.0, 0.42];
/// Where the light comes from.
const LIGHT: [f64; 3] = [0.35, -0.55, 0.76];
/// Sides of what is round.
const N_SIDES: usize = 20;
/// Colours of bodies without one of their own: as in the page.
const COLORS: [&str; 6] = ["#5b7f9e", "#c98a3c", "#5f9e83", "#a8748f", "#8a8f98", "#b5a642"];

type V = [f64; 3];

/// A flat face, or a line if it has two corners.
struct Face {
    corners: Vec<V>,
    color: [f64; 3],
    opacity: f64,
}

/// The scene in one frame (poses of its movers first), `width` × `height` `[px]`; empty if there is nothing to see.
#[must_use]
pub fn still(view: &SceneView, frame: &[f32], (width, height): (f64, f64)) -> String {
    let mut faces = Vec::new();
    let mut n_bodies = 0;
    for object in &view.objects {
        let color = COLORS[n_bodies % COLORS.len()];
        n_bodies += usize::from(object.kind == "body");
        let x_wo = compose(&mover(object.mover, frame), &object.pose);
        for shape in &object.shapes {
            solid(shape, &compose(&x_wo, &shape.pose), rgb(shape.color.as_deref().unwrap_or(color)), &mut faces);
        }
        rest(view, object, (&x_wo, frame), rgb(color), &mut faces);
    }
    if faces.is_empty() { String::new() } else { paint(&faces, width, height) }
}

/// What shows an object without shapes: the box of its inertia, a rotor's disc, a stick to what carries it.
fn rest(
    view: &SceneView,
    object: &ObjectView,
    (x_wo, frame): (&[f64; 7], &[f32]),
    color: [f64; 3],
    faces: &mut Vec<Face>,
) {
    if let (Some((mass, center, inertia)), true) = (&object.mass, object.shapes.is_empty()) {
        let moments = [inertia[0], inertia[3], inertia[5]];
        let total: f64 = moments.iter().sum();
        let edges = moments.map(|m| (6.0 * (total - 2.0 * m) / mass.max(1e-12)).max(0.0).sqrt());
        let longest = edges.iter().fold(1e-6, |a: f64, b| a.max(*b));
        let [x, y, z] = center;
        let at = compose(x_wo, &[*x, *y, *z, 0.0, 0.0, 0.0, 1.0]);
        cuboid(edges.map(|e| e.max(0.04 * longest)), &at, color, faces);
    }
    if let Some(rotor) = &object.rotor {
        let radius = rotor.radius.unwrap_or(0.1);
        let disc = ring(radius, 0.0).map(|p| point(x_wo, p)).collect();
        faces.push(Face { corners: disc, color: rgb("#2f6f9f"), opacity: 0.35 });
    }
    let Some(parent) = object.parent.map(|k| &view.objects[k]) else { return };
    let is_bare =
        parent.shapes.is_empty() && !view.objects.iter().any(|o| o.parent == object.parent && !o.shapes.is_empty());
    let is_free = object.joint.as_ref().is_some_and(|j| j.axes.is_empty());
    if is_bare && !is_free && !matches!(object.kind.as_str(), "force" | "frame") {
        let from = compose(&mover(parent.mover, frame), &parent.pose);
        faces.push(Face { corners: vec![origin(&from), origin(x_wo)], color: rgb("#7d8590"), opacity: 1.0 });
    }
}

fn mover(index: Option<usize>, frame: &[f32]) -> [f64; 7] {
    let at = index.and_then(|m| frame.get(7 * m..7 * m + 7));
    at.map_or([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], |f| std::array::from_fn(|k| f64::from(f[k])))
}

fn solid(shape: &ShapeView, at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    let (a, b) = (shape.size[0], shape.size[1]);
    match shape.kind {
        "cuboid" => cuboid([a, b, shape.size[2]], at, color, faces),
        "cylinder" => turned(&[(0.0, -b / 2.0), (a, -b / 2.0), (a, b / 2.0), (0.0, b / 2.0)], at, color, faces),
        "cone" => turned(&[(0.0, -b / 4.0), (a, -b / 4.0), (0.0, 0.75 * b)], at, color, faces),
        // a sphere is a capsule without a middle
        kind => turned(&meridian(a, if kind == "capsule" { b / 2.0 } else { 0.0 }), at, color, faces),
    }
}

/// Radius and height along half a circle that is pulled apart by 2·`half`.
fn meridian(radius: f64, half: f64) -> Vec<(f64, f64)> {
    const N: u32 = 12;
    let corner = |k: u32| {
        let (sin, cos) = elementary::sin_cos(std::f64::consts::PI * f64::from(k) / f64::from(N));
        (radius * sin, -radius * cos + if 2 * k <= N { -half } else { half })
    };
    (0..=N).map(corner).collect()
}

fn cuboid(size: V, at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    let corner =
        |k: usize| -> V { std::array::from_fn(|i| if k >> i & 1 == 1 { size[i] / 2.0 } else { -size[i] / 2.0 }) };
    for corners in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        faces.push(Face { corners: corners.iter().map(|k| point(at, corner(*k))).collect(), color, opacity: 1.0 });
    }
}

fn ring(radius: f64, z: f64) -> impl Iterator<Item = V> {
    (0..N_SIDES).map(move |k| {
        let (sin, cos) = elementary::sin_cos(2.0 * std::f64::consts::PI * k as f64 / N_SIDES as f64);
        [radius * cos, radius * sin, z]
    })
}

/// A profile of (radius, height) turned about z.
fn turned(profile: &[(f64, f64)], at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    for pair in profile.windows(2) {
        let (low, high): (Vec<V>, Vec<V>) =
            (ring(pair[0].0, pair[0].1).collect(), ring(pair[1].0, pair[1].1).collect());
        if pair[0].1 == pair[1].1 {
            // an end: one face, its corners in the order in which it is seen from outside
            let (mut end, is_lower) = if pair[0].0 > pair[1].0 { (low, false) } else { (high, true) };
            if is_lower {
                end.reverse();
            }
            faces.push(Face { corners: end.into_iter().map(|p| point(at, p)).collect(), color, opacity: 1.0 });
            continue;
        }
        for k in 0..N_SIDES {
            let next = (k + 1) % N_SIDES;
            let corners = [low[k], low[next], high[next], high[k]].map(|p| point(at, p));
            faces.push(Face { corners: corners.to_vec(), color, opacity: 1.0 });
        }
    }
}

fn paint(faces: &[Face], width: f64, height: f64) -> String {
    let back = unit(CAMERA);
    let right = unit(cross([0.0, 0.0, 1.0], back));
    let up = cross(back, right);
    let flat = |p: &V| (dot(*p, right), -dot(*p, up));
    let all: Vec<(f64, f64)> = faces.iter().flat_map(|f| f.corners.iter().map(flat)).collect();
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = all.iter().map(of);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((x0, x1), (y0, y1)) = (range(|p| p.0), range(|p| p.1));
    let scale = 0.86 * (width / (x1 - x0).max(1e-9)).min(height / (y1 - y0).max(1e-9));
    let place = |p: &V| {
        let (x, y) = flat(p);
        (width / 2.0 + scale * (x - (x0 + x1) / 2.0), height / 2.0 + scale * (y - (y0 + y1) / 2.0))
    };
    let mut drawn: Vec<(f64, String)> = faces.iter().filter_map(|face| element(face, back, &place)).collect();
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    let content: String = drawn.into_iter().map(|(_, text)| text).collect();
    format!(
        "<svg class=\"picture\" role=\"img\" aria-label=\"the scene\" viewBox=\"0 0 {width} {height}\">{content}</svg>"
    )
}

/// A face that looks at the reader, with its depth.
fn element(face: &Face, back: V, place: &dyn Fn(&V) -> (f64, f64)) -> Option<(f64, String)> {
    let n = face.corners.len() as f64;
    let depth = face.corners.iter().map(|p| dot(*p, back)).sum::<f64>() / n;
    let data: Vec<String> = face.corners.iter().map(place).map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    let hex = |shade: f64| {
        let part = |k: usize| (255.0 * (face.color[k] * shade).clamp(0.0, 1.0)).round() as u8;
        format!("#{:02x}{:02x}{:02x}", part(0), part(1), part(2))
    };
    if face.corners.len() == 2 {
        let color = hex(1.0);
        return Some((
            depth,
            format!(
                "<path d=\"M{}L{}\" stroke=\"{color}\" stroke-width=\"2.4\" stroke-linecap=\"round\"/>",
                data[0], data[1]
            ),
        ));
    }
    // the corners' own area vector: right for faces with any number of corners, some of them in one place
    let first = face.corners[0];
    let pairs = face.corners.windows(2).skip(1);
    let area = pairs.fold([0.0; 3], |sum: V, p| add(sum, cross(sub(p[0], first), sub(p[1], first))));
    let length = dot(area, area).sqrt();
    if length <= 0.0 {
        return None;
    }
    let normal = area.map(|x| x / length);
    let is_glass = face.opacity < 1.0;
    if !is_glass && dot(normal, back) <= 0.0 {
        return None;
    }
    let shade = if is_glass { 1.0 } else { 0.62 + 0.5 * dot(normal, unit(LIGHT)).max(0.0) };
    let color = hex(shade);
    let look = if is_glass {
        format!("fill=\"{color}\" fill-opacity=\"{}\" stroke=\"{color}\"", face.opacity)
    } else {
        // the same stroke closes the seams between faces
        format!("fill=\"{color}\" stroke=\"{color}\" stroke-width=\"0.6\"")
    };
    Some((depth, format!("<path d=\"M{}z\" {look}/>", data.join("L"))))
}

fn rgb(hex: &str) -> [f64; 3] {
    std::array::from_fn(|k| {
        let part = hex.get(1 + 2 * k..3 + 2 * k).and_then(|digits| u8::from_str_radix(digits, 16).ok());
        f64::from(part.unwrap_or(128)) / 255.0
    })
}

fn origin(pose: &[f64; 7]) -> V {
    [pose[0], pose[1], pose[2]]
}

/// A point of a frame in the world: p + R(q)·x.
fn point(pose: &[f64; 7], x: V) -> V {
    add(origin(pose), rotate(pose, x))
}

fn rotate(pose: &[f64; 7], x: V) -> V {
    let (u, w) = ([pose[3], pose[4], pose[5]], pose[6]);
    let t = cross(u, x).map(|c| 2.0 * c);
    add(add(x, t.map(|c| w * c)), cross(u, t))
}

/// Pose of C in A from those of B in A and of C in B.
fn compose(ab: &[f64; 7], bc: &[f64; 7]) -> [f64; 7] {
    let p = point(ab, origin(bc));
    let (a, b) = (&ab[3..], &bc[3..]);
    let (u, v) = ([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
    let q = add(add(v.map(|c| a[3] * c), u.map(|c| b[3] * c)), cross(u, v));
    [p[0], p[1], p[2], q[0], q[1], q[2], a[3] * b[3] - dot(u, v)]
}

fn add(a: V, b: V) -> V {
    std::array::from_fn(|k| a[k] + b[k])
}

fn sub(a: V, b: V) -> V {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_shows_three_of_its_faces() {
        let mut faces = Vec::new();
        cuboid([1.0; 3], &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.5; 3], &mut faces);
        assert_eq!(paint(&faces, 100.0, 100.0).matches("<path").count(), 3);
    }

    #[test]
    fn poses_cancel() {
        let half = 0.5_f64.sqrt();
        // a quarter turn about z, then 1 m along the new x, which is the old y
        let turned = compose(&[0.0, 0.0, 0.0, 0.0, 0.0, half, half], &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let p = point(&turned, [0.0, 2.0, 0.0]);
        assert!((p[0] + 2.0).abs() < 1e-12 && (p[1] - 1.0).abs() < 1e-12, "{p:?}");
    }

    #[test]
    fn round_solids_are_closed_and_look_outwards() {
        for profile in [meridian(1.0, 0.0), meridian(1.0, 0.5), vec![(0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0)]]
        {
            let mut faces = Vec::new();
            turned(&profile, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.5; 3], &mut faces);
            for face in &faces {
                let first = face.corners[0];
                let pairs = face.corners.windows(2).skip(1);
                let area = pairs.fold([0.0; 3], |sum: V, p| add(sum, cross(sub(p[0], first), sub(p[1], first))));
                let middle = face.corners.iter().fold([0.0; 3], |sum: V, p| add(sum, *p));
                assert!(dot(area, middle) > 0.0, "{:?}", face.corners);
            }
        }
    }
}

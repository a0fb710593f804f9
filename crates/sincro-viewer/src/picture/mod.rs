//! A still picture of a scene as SVG: what the gallery shows before anybody presses play, drawn without a browser or a
//! graphics card.
//!
//! Solids become flat faces, seen through the scene's first camera or, without one, from far away where the viewer's
//! own first camera stands; they are painted from back to front and lit by one light. The same scene and frame give the
//! same bytes.
//!
//! A third renderer beside the page (WebGL) and the cameras of scenes (ray casts into pixels), and kept: it is the only
//! one whose output is a vector graphic, a few kilobytes that an index page of fifty runs can hold and a printer draws
//! at any size; frames of a film (`run --frames`) are of the same kind.

mod sketch;
mod solid;
mod viewpoint;

pub use sketch::sketch;

use sincro_sim::replay::{ObjectView, SceneView, Trajectory};

use crate::vector::{V, add, compose, cross, dot, origin, point, sub, unit};
use solid::{Face, cuboid, plane, ring, solid};
use viewpoint::Viewpoint;

/// Direction of the light.
const LIGHT: [f64; 3] = [0.35, -0.55, 0.76];
/// Colours of bodies without one of their own: as in the page.
const COLORS: [&str; 6] = ["#5b7f9e", "#c98a3c", "#5f9e83", "#a8748f", "#8a8f98", "#b5a642"];
/// Default colour of planes.
const FLOOR: &str = "#d9dde2";

/// Draws a scene in one frame as SVG, `size` wide and high `[px]`, through its first camera or from far away; empty if
/// there is nothing to see. `frame` is one of a [`Trajectory`] of the scene.
#[must_use]
pub fn still(view: &SceneView, frame: &[f32], size: (f64, f64)) -> String {
    let (faces, viewpoint) = (faces(view, frame), viewpoint(view, frame));
    if faces.is_empty() {
        return String::new();
    }
    let below = planes(view, frame, bounds(&faces));
    paint(&below, &faces, &viewpoint, (framing(&faces, &viewpoint, size), size))
}

/// Draws a run as SVG files, `size` wide and high `[px]`, in the order of their times and all framed alike: at most
/// `rate` pictures per simulated second, and `most` in all.
#[must_use]
pub fn strip(view: &SceneView, trajectory: &Trajectory, (rate, most): (f64, usize), size: (f64, f64)) -> Vec<String> {
    // the whole run is in view from the first picture on
    let mut all = Vec::new();
    for k in (0..trajectory.n_frames()).step_by(trajectory.n_frames().div_ceil(200)) {
        all.extend(faces(view, trajectory.frame(k)));
    }
    if all.is_empty() {
        return Vec::new();
    }
    let (whole, first) = (bounds(&all), viewpoint(view, trajectory.frame(0)));
    let framing = framing(&all, &first, size);
    drop(all);
    let one = |k: usize| {
        let frame = trajectory.frame(k);
        let picture = paint(&planes(view, frame, whole), &faces(view, frame), &viewpoint(view, frame), (framing, size));
        let (width, height) = size;
        let head = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"");
        picture.replacen("<svg", &head, 1).replacen('>', "><rect width=\"100%\" height=\"100%\" fill=\"#f7f8fa\"/>", 1)
    };
    trajectory.evenly_spaced(rate, most).into_iter().map(one).collect()
}

/// Everything but planes.
fn faces(view: &SceneView, frame: &[f32]) -> Vec<Face> {
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
    faces
}

/// The scene's first camera, or far away.
fn viewpoint(view: &SceneView, frame: &[f32]) -> Viewpoint {
    let through = view.objects.iter().find_map(|o| Some((o, o.camera.as_ref()?)));
    through.map_or_else(Viewpoint::far, |(object, camera)| {
        Viewpoint::camera(&compose(&mover(object.mover, frame), &object.pose), camera.field_of_view_deg)
    })
}

/// Least and greatest coordinates of all corners.
fn bounds(faces: &[Face]) -> (V, V) {
    let corners = || faces.iter().flat_map(|face| &face.corners);
    let bound = |of: fn(f64, f64) -> f64| -> V {
        std::array::from_fn(|k| corners().map(|p| p[k]).reduce(of).expect("there are faces"))
    };
    (bound(f64::min), bound(f64::max))
}

/// The pieces of planes below the rest, which is painted over them.
fn planes(view: &SceneView, frame: &[f32], bounds: (V, V)) -> Vec<Face> {
    let mut made = Vec::new();
    for object in &view.objects {
        for shape in object.shapes.iter().filter(|shape| shape.kind == "plane") {
            let at = compose(&compose(&mover(object.mover, frame), &object.pose), &shape.pose);
            plane(&at, bounds, rgb(shape.color.as_deref().unwrap_or(FLOOR)), &mut made);
        }
    }
    made
}

/// Drawing of an object without shapes: the box of its inertia, a rotor's disc, a line to the link that carries it.
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
    if is_bare && !is_free && !matches!(object.kind.as_str(), "force" | "frame" | "drag" | "sensor" | "camera") {
        let from = compose(&mover(parent.mover, frame), &parent.pose);
        faces.push(Face { corners: vec![origin(&from), origin(x_wo)], color: rgb("#7d8590"), opacity: 1.0 });
    }
}

fn mover(index: Option<usize>, frame: &[f32]) -> [f64; 7] {
    let at = index.and_then(|m| frame.get(7 * m..7 * m + 7));
    at.map_or([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], |f| std::array::from_fn(|k| f64::from(f[k])))
}

/// Paints `below` first, as it comes, then the faces from back to front.
fn paint(
    below: &[Face],
    faces: &[Face],
    viewpoint: &Viewpoint,
    ((scale, middle), (width, height)): (Framing, (f64, f64)),
) -> String {
    let place = |p: &V| {
        let (x, y) = viewpoint.flat(*p)?;
        Some((width / 2.0 + scale * (x - middle.0), height / 2.0 + scale * (y - middle.1)))
    };
    let under: String =
        below.iter().filter_map(|face| element(face, viewpoint, &place)).map(|(_, text)| text).collect();
    let mut drawn: Vec<(f64, String)> = faces.iter().filter_map(|face| element(face, viewpoint, &place)).collect();
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    let content: String = drawn.into_iter().map(|(_, text)| text).collect();
    format!(
        "<svg class=\"picture\" role=\"img\" aria-label=\"the scene\" viewBox=\"0 0 {width} {height}\">{under}{content}</svg>"
    )
}

/// Scale and middle of the picture.
type Framing = (f64, (f64, f64));

/// A camera has its own; from far away all faces are in the picture.
fn framing(faces: &[Face], viewpoint: &Viewpoint, (width, height): (f64, f64)) -> Framing {
    if let Some(tall) = viewpoint.tall() {
        return (height / tall, (0.0, 0.0));
    }
    let all = || faces.iter().flat_map(|f| f.corners.iter().filter_map(|p| viewpoint.flat(*p)));
    let range = |of: fn((f64, f64)) -> f64| {
        let values = all().map(of);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((x0, x1), (y0, y1)) = (range(|p| p.0), range(|p| p.1));
    let scale = 0.86 * (width / (x1 - x0).max(1e-9)).min(height / (y1 - y0).max(1e-9));
    (scale, ((x0 + x1) / 2.0, (y0 + y1) / 2.0))
}

/// A face that looks at the reader, with its depth.
fn element(face: &Face, viewpoint: &Viewpoint, place: &dyn Fn(&V) -> Option<(f64, f64)>) -> Option<(f64, String)> {
    let n = face.corners.len() as f64;
    let depth = face.corners.iter().map(|p| viewpoint.depth(*p)).sum::<f64>() / n;
    let flat: Option<Vec<(f64, f64)>> = face.corners.iter().map(place).collect();
    let data: Vec<String> = flat?.into_iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    let hex = |shade: f64| {
        let part = |k: usize| (255.0 * (face.color[k] * shade).clamp(0.0, 1.0)).round() as u8;
        format!("#{:02x}{:02x}{:02x}", part(0), part(1), part(2))
    };
    if face.corners.len() == 2 {
        let (color, line) = (hex(1.0), format!("M{}L{}", data[0], data[1]));
        let thick = if face.opacity < 1.0 { 0.8 } else { 2.4 };
        let path = format!("<path d=\"{line}\" stroke=\"{color}\" stroke-width=\"{thick}\" stroke-linecap=\"round\"/>");
        return Some((depth, path));
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
    if !is_glass && dot(normal, viewpoint.towards(first)) <= 0.0 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use sincro_sim::Extensions;

    const STILL: [f64; 7] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

    fn cube() -> Vec<Face> {
        let mut faces = Vec::new();
        cuboid([1.0; 3], &STILL, [0.5; 3], &mut faces);
        faces
    }

    fn picture(viewpoint: &Viewpoint) -> String {
        let size = (300.0, 300.0);
        paint(&[], &cube(), viewpoint, (framing(&cube(), viewpoint, size), size))
    }

    #[test]
    fn a_cube_shows_three_of_its_faces() {
        assert_eq!(picture(&Viewpoint::far()).matches("<path").count(), 3);
    }

    #[test]
    fn a_camera_shows_what_is_before_it_at_its_size() {
        // 1.5 m from the front face, which looks down on it; half the picture's height there is 1.5 m
        let ahead = Viewpoint::camera(&[0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 1.0], 90.0);
        let picture_ahead = picture(&ahead);
        assert_eq!(picture_ahead.matches("<path").count(), 1, "{picture_ahead}");
        assert!(picture_ahead.contains("100.0 100.0") && picture_ahead.contains("200.0 200.0"), "{picture_ahead}");
        let behind = Viewpoint::camera(&[0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0], 90.0);
        assert_eq!(picture(&behind).matches("<path").count(), 0);
    }

    #[test]
    fn pictures_of_a_run_are_framed_alike() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/two-dof-open-loop");
        let loaded = sincro_sim::load(&folder, &[], Extensions::default()).unwrap();
        let interrupt = std::sync::atomic::AtomicBool::new(false);
        let campaign =
            sincro_sim::campaign::run_campaign(&folder, &[], &loaded, None, &interrupt, &mut |_, _| {}).unwrap();
        let trajectory = campaign.main.simulated.trajectory.as_ref().unwrap();
        let span = trajectory.times.last().unwrap() - trajectory.times[0];
        let pictures = strip(&campaign.main.view, trajectory, (4.0, 1000), (400.0, 300.0));
        assert_eq!(pictures.len(), (4.0 * span) as usize + 1);
        assert_eq!(strip(&campaign.main.view, trajectory, (4.0, 7), (400.0, 300.0)).len(), 7);
        assert!(pictures.iter().all(|picture| picture.starts_with("<svg xmlns=")));
        assert!(pictures[0] != pictures[1], "something moves");
        // whatever moves, no corner leaves the picture
        let numbers = |picture: &str| -> Vec<f64> {
            let paths = picture.split(" d=\"").skip(1).map(|rest| rest.split('"').next().unwrap_or("").to_owned());
            paths
                .flat_map(|d| d.split(['M', 'L', 'z', ' ']).filter_map(|x| x.parse().ok()).collect::<Vec<f64>>())
                .collect()
        };
        for picture in &pictures {
            let inside = |pair: &[f64]| (0.0..=400.0).contains(&pair[0]) && (0.0..=300.0).contains(&pair[1]);
            let numbers = numbers(picture);
            assert!(numbers.len() > 20 && numbers.chunks_exact(2).all(inside), "{picture}");
        }
    }
}

//! Labels of a sketch: names of joints and bodies beside them, coordinates, axes and positive senses of the joints,
//! directions of the world.

use sincro_math::elementary;
use sincro_sim::replay::{ObjectView, SceneView};

use super::viewpoint::Viewpoint;
use super::{bounds, faces, framing, mover, paint, planes, viewpoint};
use crate::vector::{V, add, compose, cross, dot, origin, point, rotate, scale, sub, unit};

/// Size of the labels `[px]`.
const FONT: f64 = 13.0;
/// Estimated width of a character, in sizes of the font.
const CHARACTER: f64 = 0.58;
/// Labels of one sketch, at most: joints come first.
const MAX_LABELS: usize = 40;
/// Directions in which a label is tried, and distances of its nearest corner from what it names `[px]`.
const DIRECTIONS: [(f64, f64); 8] =
    [(1.0, -0.5), (1.0, 0.6), (-1.0, -0.5), (-1.0, 0.6), (0.2, -1.0), (0.2, 1.0), (1.0, -1.4), (-1.0, -1.4)];
const DISTANCES: [f64; 4] = [12.0, 30.0, 52.0, 80.0];

/// Draws a scene in one frame as [`still`](super::still) does, `size` wide and high `[px]`, with the names of joints
/// and bodies, coordinates, axes and positive senses of joints, and axes of the world; empty if there is nothing to
/// see. Lines have the colour of the text of the page around it.
#[must_use]
pub fn sketch(view: &SceneView, frame: &[f32], size: (f64, f64)) -> String {
    let (faces, viewpoint) = (faces(view, frame), viewpoint(view, frame));
    if faces.is_empty() {
        return String::new();
    }
    let bounds = bounds(&faces);
    let framing = framing(&faces, &viewpoint, size);
    let picture = paint(&planes(view, frame, bounds), &faces, &viewpoint, (framing, size));
    let (factor, middle) = framing;
    let place = |p: V| {
        let (x, y) = viewpoint.flat(p)?;
        Some((size.0 / 2.0 + factor * (x - middle.0), size.1 / 2.0 + factor * (y - middle.1)))
    };
    let diagonal = sub(bounds.1, bounds.0);
    let length = 0.07 * dot(diagonal, diagonal).sqrt();
    let mut labels = Labels { size, taken: Vec::new(), text: triad(&viewpoint, size) };
    labels.taken.push([0.0, size.1 - 74.0, 84.0, size.1]);
    let joints = || view.objects.iter().filter(|o| o.joint.as_ref().is_some_and(|j| j.n_v > 0));
    for object in joints() {
        let x_wo = compose(&mover(object.mover, frame), &object.pose);
        for axis in object.joint.iter().flat_map(|joint| &joint.axes) {
            let half = scale(unit(rotate(&x_wo, *axis)), length);
            if let (Some(a), Some(b)) = (place(sub(origin(&x_wo), half)), place(add(origin(&x_wo), half))) {
                labels.text += &format!(
                    "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"currentColor\" stroke-width=\"1.2\" stroke-dasharray=\"9 3 2 3\"/>",
                    a.0, a.1, b.0, b.1
                );
            }
            labels.text += &sense(object, origin(&x_wo), half, &place);
        }
    }
    let bodies = view.objects.iter().filter(|o| o.kind == "body" || o.rotor.is_some());
    for object in joints().chain(bodies).take(MAX_LABELS) {
        let x_wo = compose(&mover(object.mover, frame), &object.pose);
        let at = object.mass.map_or_else(|| origin(&x_wo), |(_, center, _)| point(&x_wo, center));
        if let Some(at) = place(at) {
            labels.add(&(name(view, object) + &symbol(object)), at, object.joint.is_some());
        }
    }
    picture.replacen("</svg>", &format!("<g class=\"labels\">{}</g></svg>", labels.text), 1)
}

/// Points of the arc of an angle, and its extent [rad].
const ARC: (usize, f64) = (24, 4.4);

/// Positive sense of a joint about or along an axis, `half` long from its origin: an arc with an arrow about a revolute
/// axis, an arrow at the end of a prismatic one; nothing for others.
fn sense(object: &ObjectView, at: V, half: V, place: &impl Fn(V) -> Option<(f64, f64)>) -> String {
    let points: Vec<V> = match object.kind.as_str() {
        "revolute joint" => {
            let axis = unit(half);
            let across = if axis[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
            let u = scale(unit(cross(across, axis)), 0.45 * dot(half, half).sqrt());
            let v = cross(axis, u);
            let middle = add(at, scale(half, 0.75));
            let angle = |k: usize| -0.6 + ARC.1 * k as f64 / ARC.0 as f64;
            let on_arc = |k: usize| {
                let (sin, cos) = elementary::sin_cos(angle(k));
                add(middle, add(scale(u, cos), scale(v, sin)))
            };
            (0..=ARC.0).map(on_arc).collect()
        }
        "prismatic joint" => vec![add(at, scale(half, 0.7)), add(at, half)],
        _ => return String::new(),
    };
    let Some(flat) = points.into_iter().map(place).collect::<Option<Vec<_>>>() else { return String::new() };
    let [.., before, end] = flat.as_slice() else { return String::new() };
    let (dx, dy) = (end.0 - before.0, end.1 - before.1);
    let length = dx.hypot(dy).max(1e-9);
    let (dx, dy) = (6.0 * dx / length, 6.0 * dy / length);
    let path: String = flat
        .iter()
        .enumerate()
        .map(|(k, p)| format!("{}{:.1} {:.1}", if k == 0 { 'M' } else { 'L' }, p.0, p.1))
        .collect();
    format!(
        "<path d=\"{path}M{:.1} {:.1}L{:.1} {:.1}L{:.1} {:.1}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.2\"/>",
        end.0 - dx - 0.5 * dy,
        end.1 - dy + 0.5 * dx,
        end.0,
        end.1,
        end.0 - dx + 0.5 * dy,
        end.1 - dy - 0.5 * dx,
    )
}

/// Coordinates of a joint after its name: ` q0`, or ` q0…q6`; empty for all else.
fn symbol(object: &ObjectView) -> String {
    match object.joint.as_ref().map(|joint| (joint.q_idx, joint.n_q)) {
        None | Some((_, 0)) => String::new(),
        Some((first, 1)) => format!(" q{first}"),
        Some((first, n)) => format!(" q{first}…q{}", first + n - 1),
    }
}

/// Name of an object, with its parent's where others have the same.
fn name(view: &SceneView, object: &ObjectView) -> String {
    let is_unique = view.objects.iter().filter(|other| other.name == object.name).count() == 1;
    let depth = if is_unique { 1 } else { 2 };
    let parts: Vec<&str> = object.path.rsplit('/').take(depth).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}

/// Directions of the world's axes in the lower left corner.
fn triad(viewpoint: &Viewpoint, (_, height): (f64, f64)) -> String {
    let (x0, y0) = (34.0, height - 30.0);
    let axes =
        [("x", [1.0, 0.0, 0.0], "#c0392b"), ("y", [0.0, 1.0, 0.0], "#1e8449"), ("z", [0.0, 0.0, 1.0], "#2471a3")];
    let one = |(name, axis, color): (&str, V, &str)| {
        let (dx, dy) = viewpoint.direction(axis);
        let (x, y) = (x0 + 24.0 * dx, y0 + 24.0 * dy);
        let (tx, ty) = (x0 + 33.0 * dx - 3.5, y0 + 33.0 * dy + 4.0);
        format!(
            "<path d=\"M{x0:.1} {y0:.1}L{x:.1} {y:.1}\" stroke=\"{color}\" stroke-width=\"2\"/>\
             <text x=\"{tx:.1}\" y=\"{ty:.1}\" font-size=\"12\" fill=\"currentColor\">{name}</text>"
        )
    };
    axes.into_iter().map(one).collect()
}

/// Labels placed so far.
struct Labels {
    size: (f64, f64),
    /// Left, top, right, bottom.
    taken: Vec<[f64; 4]>,
    text: String,
}

impl Labels {
    /// Writes a name beside a place, with a line to it; nothing where there is no room.
    fn add(&mut self, name: &str, at: (f64, f64), is_joint: bool) {
        let (width, height) = (CHARACTER * FONT * name.chars().count() as f64, FONT + 3.0);
        let boxes =
            DISTANCES.iter().flat_map(|distance| DIRECTIONS.iter().map(move |(dx, dy)| (distance * dx, distance * dy)));
        let found = boxes
            .map(|(dx, dy)| {
                let left = at.0 + if dx < 0.0 { dx - width } else { dx };
                let top = at.1 + dy - 0.5 * height;
                [left, top, left + width, top + height]
            })
            .find(|b| self.is_free(b));
        let Some([left, top, right, bottom]) = found else { return };
        self.taken.push([left, top, right, bottom]);
        self.taken.push([at.0 - 5.0, at.1 - 5.0, at.0 + 5.0, at.1 + 5.0]);
        let near = (at.0.clamp(left - 3.0, right + 3.0), at.1.clamp(top + 4.0, bottom - 4.0));
        let mark = if is_joint {
            format!(
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.6\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.6\"/>",
                at.0, at.1
            )
        } else {
            format!("<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.2\" fill=\"currentColor\"/>", at.0, at.1)
        };
        let name = name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        self.text += &format!(
            "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"currentColor\" stroke-width=\"0.8\"/>{mark}\
             <text class=\"label\" x=\"{left:.1}\" y=\"{:.1}\" font-size=\"{FONT}\" fill=\"currentColor\">{name}</text>",
            at.0,
            at.1,
            near.0,
            near.1,
            bottom - 4.5,
        );
    }

    fn is_free(&self, [left, top, right, bottom]: &[f64; 4]) -> bool {
        let is_inside = *left >= 2.0 && *top >= 2.0 && *right <= self.size.0 - 2.0 && *bottom <= self.size.1 - 2.0;
        let is_apart = |b: &[f64; 4]| *right < b[0] || *left > b[2] || *bottom < b[1] || *top > b[3];
        is_inside && self.taken.iter().all(is_apart)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_do_not_cover_one_another() {
        let mut labels = Labels { size: (400.0, 300.0), taken: Vec::new(), text: String::new() };
        for _ in 0..8 {
            labels.add("shoulder", (200.0, 150.0), true);
        }
        let boxes: Vec<[f64; 4]> = labels.taken.iter().copied().filter(|b| b[2] - b[0] > 20.0).collect();
        assert!(boxes.len() >= 6, "{}", boxes.len());
        for (k, a) in boxes.iter().enumerate() {
            assert!(boxes[..k].iter().all(|b| a[2] < b[0] || a[0] > b[2] || a[3] < b[1] || a[1] > b[3]));
        }
    }

    #[test]
    fn a_sketch_names_joints_and_bodies() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/two-dof-open-loop");
        let loaded = sincro_sim::load(&folder, &[], sincro_sim::Extensions::default()).unwrap();
        let view = SceneView::new(&loaded.scene);
        let still: Vec<f32> = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0].repeat(view.n_movers);
        let text = sketch(&view, &still, (640.0, 360.0));
        for object in view.objects.iter().filter(|o| o.kind == "revolute joint") {
            let q_idx = object.joint.as_ref().unwrap().q_idx;
            assert!(text.contains(&format!(">{} q{q_idx}</text>", object.name)), "{}", object.name);
        }
        assert_eq!(text, sketch(&view, &still, (640.0, 360.0)));
    }
}

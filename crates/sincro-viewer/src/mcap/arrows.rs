//! Forces and wind as arrows in the world: contact, external, drag and thrust forces, wind. An arrow is half as long as
//! the scene is large where its kind is greatest in the run.

use mcap::McapError;
use serde_json::{Value, json};
use sincro_sim::replay::{CONTACT, SceneView, Trajectory};

use super::Recording;
use super::entity::{color, entity, extent, pose};
use crate::vector::{V, compose, dot, origin, rotate};

/// Name, colour, and the arrows of a frame: from where, and how much.
struct Kind<'a> {
    id: &'static str,
    color: &'static str,
    of: Box<dyn Fn(usize) -> Vec<(V, V)> + 'a>,
}

/// One message a frame.
pub(super) fn write(out: &mut Recording, view: &SceneView, trajectory: &Trajectory) -> Result<(), McapError> {
    let kinds = kinds(view, trajectory);
    let largest = |kind: &Kind<'_>| {
        let sizes = (0..trajectory.n_frames()).flat_map(|k| (kind.of)(k)).map(|(_, vector)| norm(vector));
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    };
    let sizes: Vec<f64> = kinds.iter().map(largest).collect();
    if sizes.iter().all(|size| *size <= 0.0) {
        return Ok(());
    }
    let id = out.channel("/arrows", "SceneUpdate")?;
    let longest = 0.5 * extent(view);
    for k in 0..trajectory.n_frames() {
        let t = trajectory.times[k];
        let of_kind = |(kind, most): (&Kind<'_>, &f64)| {
            let all = (kind.of)(k).into_iter();
            let arrows = all.filter_map(|(from, vector)| arrow(from, vector, longest / most, kind.color)).collect();
            entity(t, "world", kind.id, &[("arrows", arrows)])
        };
        let entities: Vec<Value> = kinds.iter().zip(&sizes).filter(|(_, most)| **most > 0.0).map(of_kind).collect();
        out.send(id, (k, t), "SceneUpdate", &json!({ "entities": entities }))?;
    }
    Ok(())
}

fn kinds<'a>(view: &'a SceneView, trajectory: &'a Trajectory) -> [Kind<'a>; 5] {
    let three = |frame: &[f32], at: usize| -> V { std::array::from_fn(|k| f64::from(frame[at + k])) };
    let at = move |k: usize, object: usize| place(view, object, trajectory.frame(k));
    let contacts = move |k: usize| {
        let points = trajectory.contacts.frame(k).chunks_exact(CONTACT);
        points.map(|p| (three(p, 2), three(p, 5))).collect()
    };
    let forces = move |k: usize| {
        let found = view.objects.iter().enumerate().filter_map(|(o, object)| Some((o, object.force?)));
        found.map(|(o, force)| (at(k, o).0, three(trajectory.frame(k), view.force_at(force)))).collect()
    };
    let drags = move |k: usize| {
        let found = view.objects.iter().enumerate().filter_map(|(o, object)| Some((o, object.drag?)));
        found.map(|(o, drag)| (at(k, o).0, three(trajectory.frame(k), view.drag_at(drag)))).collect()
    };
    let thrust = move |k: usize| {
        let found = view.objects.iter().enumerate().filter_map(|(o, object)| Some((o, object.rotor.as_ref()?.index)));
        let along = |o: usize, rotor: usize| {
            let (hub, z) = at(k, o);
            let thrust = f64::from(trajectory.frame(k)[view.rotor_at(rotor) + 1]);
            (hub, z.map(|x| thrust * x))
        };
        found.map(|(o, rotor)| along(o, rotor)).collect()
    };
    let wind = move |k: usize| {
        let movers = view.winds.iter().enumerate();
        movers.map(|(w, m)| (three(trajectory.frame(k), 7 * m), three(trajectory.frame(k), view.wind_at(w)))).collect()
    };
    [
        Kind { id: "contact forces", color: "#a5127d", of: Box::new(contacts) },
        Kind { id: "external forces", color: "#d55e00", of: Box::new(forces) },
        Kind { id: "drag", color: "#8a6d00", of: Box::new(drags) },
        Kind { id: "thrust", color: "#009e73", of: Box::new(thrust) },
        Kind { id: "wind", color: "#56b4e9", of: Box::new(wind) },
    ]
}

/// Position of an object in the world, and its z axis.
fn place(view: &SceneView, object: usize, frame: &[f32]) -> (V, V) {
    let object = &view.objects[object];
    let of = |m: usize| std::array::from_fn(|k| f64::from(frame[7 * m + k]));
    let at = object.mover.map_or(object.pose, |m| compose(&of(m), &object.pose));
    (origin(&at), rotate(&at, [0.0, 0.0, 1.0]))
}

fn norm(v: V) -> f64 {
    dot(v, v).sqrt()
}

/// An arrow along a vector; none if it is too short to be seen.
fn arrow(from: V, vector: V, scale: f64, hex: &str) -> Option<Value> {
    let size = norm(vector);
    let length = scale * size;
    if length.is_nan() || length <= 1e-6 {
        return None;
    }
    let [dx, dy, dz] = vector.map(|x| x / size);
    // the shortest turn from x, along which arrows are drawn, to the vector
    let (q, w) = if dx < -0.999_999 { ([0.0, 0.0, 1.0], 0.0) } else { ([0.0, -dz, dy], 1.0 + dx) };
    let n = (q.iter().map(|x| x * x).sum::<f64>() + w * w).sqrt();
    let [px, py, pz] = from;
    let at = pose(&[px, py, pz, q[0] / n, q[1] / n, q[2] / n, w / n]);
    let thick = 0.04 * length;
    Some(json!({
        "pose": at, "shaft_length": 0.8 * length, "shaft_diameter": thick, "head_length": 0.2 * length, "head_diameter": 2.2 * thick,
        "color": color(hex),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_point_along_their_vectors() {
        for v in [[1.0, 2.0, -3.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 5.0], [-1.0, 1e-3, 0.0]] {
            let arrow = arrow([0.0; 3], v, 1.0, "#000000").unwrap();
            let part = |k: &str| arrow["pose"]["orientation"][k].as_f64().unwrap();
            let x = rotate(&[0.0, 0.0, 0.0, part("x"), part("y"), part("z"), part("w")], [1.0, 0.0, 0.0]);
            let size = norm(v);
            (0..3).for_each(|k| assert!((x[k] - v[k] / size).abs() < 2e-3, "{v:?}: {x:?}"));
        }
        assert!(arrow([0.0; 3], [f64::NAN, 0.0, 0.0], 1.0, "#000000").is_none());
    }
}

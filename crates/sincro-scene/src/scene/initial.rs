//! Initial state of a scene: coordinates and velocities of its joints.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{JointInfo, Model};
use sincro_dynamics::state::State;

use super::file::{InitialFile, OneOrList};
use super::placement::normalized;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// A quaternion whose length is farther from 1 than this was not meant as one.
const UNIT_SLACK: f64 = 1e-6;

/// The initial state. `starts` has path, pointer and `initial` of every joint.
pub(super) fn state(
    model: &Model<f64>,
    starts: &[(&str, &str, &InitialFile)],
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> State<f64> {
    let mut state = State::new(model);
    for (path, pointer, file) in starts {
        let lists = [("position", &file.position), ("velocity", &file.velocity)];
        for (key, list) in lists.into_iter().filter_map(|(key, list)| Some((key, list.as_ref()?))) {
            let inner = format!("{pointer}/initial/{key}");
            match fill(&mut state, model.names().joint(path), key, list) {
                Ok(()) => {}
                Err((message, help)) => {
                    let message = format!("initial {key} of joint `{path}`: {message}");
                    diagnostics.push(Diagnostic::error(&document.at(&inner), message).with_help(help));
                }
            }
        }
    }
    state
}

fn fill(
    state: &mut State<f64>,
    joint: Option<&JointInfo>,
    key: &str,
    list: &OneOrList<f64>,
) -> Result<(), (String, String)> {
    let Some(joint) = joint else {
        return Err(("a fixed joint does not move".into(), "leave `initial` out".into()));
    };
    let (all, first, n) = match key {
        "position" => (&mut state.q, joint.q_idx, joint.n_q),
        _ => (&mut state.v, joint.v_idx, joint.n_v),
    };
    let given = list.as_slice();
    if given.len() != n {
        return Err((format!("{} given, expected {n}", numbers(given.len())), layout(&joint.kind, key)));
    }
    let place = &mut all[first..first + n];
    place.copy_from_slice(given);
    let quaternion = match joint.kind {
        JointKind::Ball if key == "position" => &mut place[..],
        JointKind::Free if key == "position" => &mut place[3..],
        _ => return Ok(()),
    };
    normalize(quaternion)
}

fn normalize(quaternion: &mut [f64]) -> Result<(), (String, String)> {
    let q: [f64; 4] = quaternion.try_into().expect("a quaternion has four coordinates");
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    match normalized(q) {
        Some(unit) if (norm - 1.0).abs() <= UNIT_SLACK => {
            unit.write(quaternion);
            Ok(())
        }
        Some(unit) => {
            let mut unit_q = [0.0; 4];
            unit.write(&mut unit_q);
            Err((format!("the quaternion {q:?} has length {norm}, expected 1"), format!("did you mean {unit_q:?}?")))
        }
        None => {
            Err((format!("the quaternion {q:?} has no direction"), "no rotation is [1, 0, 0, 0]: w, x, y, z".into()))
        }
    }
}

fn numbers(n: usize) -> String {
    if n == 1 { "1 number".into() } else { format!("{n} numbers") }
}

/// Description of the coordinates of a joint.
fn layout(kind: &JointKind, key: &str) -> String {
    let words = match (kind, key) {
        (JointKind::Universal { .. }, "position") => "the two angles [rad]",
        (JointKind::Universal { .. }, _) => "the two rates [rad/s]",
        (JointKind::Planar, "position") => "x, y [m], angle [rad]",
        (JointKind::Planar, _) => "x, y [m/s], angle [rad/s]",
        (JointKind::Ball, "position") => "quaternion w, x, y, z",
        (JointKind::Ball, _) => "angular velocity x, y, z in child axes [rad/s]",
        (JointKind::Free, "position") => "position x, y, z [m], then quaternion w, x, y, z",
        (JointKind::Free, _) => "angular velocity x, y, z [rad/s], then velocity x, y, z [m/s], in child axes",
        (JointKind::Prismatic { .. }, _) => "one number in m or m/s",
        _ => "one number in rad or rad/s",
    };
    format!("give {words}")
}

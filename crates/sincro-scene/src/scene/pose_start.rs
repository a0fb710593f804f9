//! Start of joints by poses of frames: inverse kinematics at load.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::model::Model;
use sincro_dynamics::spatial::Vec3;
use sincro_dynamics::state::State;

use super::placement::{self, Placement};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;
use crate::inverse_kinematics::{PoseTarget, pose_coordinates};
use crate::suggest;

/// Error of a pose that is reached `[m]`, `[rad]`.
const REACHED: f64 = 1e-9;

/// Pose of a frame at the start: the joints that carry it are put there, from their `initial` on.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]})))]
pub(crate) struct InitialPoseFile {
    /// Path of the body or frame.
    pub frame: String,
    /// Position of its origin in the world; any if left out [m].
    pub position: Option<[f64; 3]>,
    /// Roll, pitch and yaw in the world, R = Rz(yaw)·Ry(pitch)·Rx(roll); any if left out [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation in the world as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
}

/// Moves the joints of `initial` to the poses of a scene; notes what cannot be reached.
pub(super) fn solve(
    model: &Model<f64>,
    poses: &[InitialPoseFile],
    pointer: impl Fn(usize) -> String,
    initial: &mut State<f64>,
    document: &Document,
    diagnostics: &mut Diagnostics,
) {
    let mut targets = Vec::new();
    for (k, file) in poses.iter().enumerate() {
        let at = pointer(k);
        let Some(frame) = model.names().frame(&file.frame) else {
            let known: Vec<&str> = model.names().frames.iter().map(|f| f.name.as_str()).collect();
            let message = format!("there is no body or frame `{}`", file.frame);
            let diagnostic = Diagnostic::error(&document.at(&format!("{at}/frame")), message);
            diagnostics.push(diagnostic.with_help(suggest::help(&file.frame, &known, "bodies and frames")));
            continue;
        };
        let turned = file.rotation_deg.is_some() || file.quaternion_wxyz.is_some();
        if !turned && file.position.is_none() {
            let diagnostic = Diagnostic::error(&document.at(&at), format!("the pose of `{}` says nothing", file.frame));
            diagnostics.push(diagnostic.with_help("give `position` [m], `rotation_deg`, or both"));
            continue;
        }
        let placement = Placement::new([0.0; 3], file.rotation_deg, file.quaternion_wxyz);
        let rotation = turned.then(|| placement::pose(&placement, &at, document, diagnostics).rot);
        targets.push(PoseTarget {
            frame: Attached { link: frame.link, pose: frame.pose },
            position: file.position.map(Vec3),
            rotation,
        });
    }
    if targets.is_empty() || targets.len() < poses.len() {
        return;
    }
    let found = pose_coordinates(model, initial, &targets);
    initial.q.copy_from_slice(&found.q);
    let [linear, angular] = found.errors;
    if linear <= REACHED && angular <= REACHED {
        return;
    }
    let message = format!("the initial pose cannot be reached: {linear:.3e} m and {angular:.3e} rad are left");
    let diagnostic = Diagnostic::error(&document.at(&pointer(0)), message);
    diagnostics.push(diagnostic.with_help(
        "joints that turn or slide between the world and the frame are moved: start them nearer with `initial`, or ask for less",
    ));
}

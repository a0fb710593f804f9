//! Cameras of a scene: where one looks from. They ride on what carries them and are no part of the model.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use sincro_dynamics::spatial::{Mat3, Pose, Vec3};

use super::body;
use super::placement::{self, Placement};
use crate::camera::{self, Lens, Optics};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// A camera: looks along z of its frame, y is up in the picture. The first one of a scene is the one that pictures and the viewer begin with.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("allOf" = [
    {"not": {"required": ["rotation_deg", "quaternion_wxyz"]}},
    {"not": {"required": ["look_at", "rotation_deg"]}},
    {"not": {"required": ["look_at", "quaternion_wxyz"]}},
    {"not": {"required": ["field_of_view_deg", "orthographic_height"]}}
])))]
pub(crate) struct CameraFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body, joint or frame that carries it; `/` is the world.
    #[serde(default = "world")]
    pub parent: String,
    /// Where it stands in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Point of the parent frame that it looks at; the parent's z is up in the picture [m].
    pub look_at: Option<[f64; 3]>,
    /// Roll, pitch and yaw of its axes in the parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of its axes in the parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Angle between the upper and the lower edge of the picture [deg].
    #[serde(default = "field_of_view")]
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub field_of_view_deg: f64,
    /// Columns and rows of its pictures: it is then a vision sensor, whose pictures clients and scripts read.
    pub resolution: Option<[u32; 2]>,
    /// Distance along its z at which the pictures of a vision sensor begin; default 0.01 [m].
    pub near: Option<f64>,
    /// Distance along its z at which the pictures of a vision sensor end; default 100 [m].
    pub far: Option<f64>,
    /// Height of the pictures of a vision sensor that looks along parallel lines [m].
    pub orthographic_height: Option<f64>,
    /// What a vision sensor sees where nothing is: `#rrggbb`.
    pub background: Option<String>,
    /// A vision sensor takes pictures only when a client or script asks for one (`handleVisionSensor`), not in every step.
    pub explicit_handling: Option<bool>,
    /// A vision sensor takes no pictures: clients and scripts write them (`setVisionSensorImg`).
    pub external_input: Option<bool>,
}

/// Settings of the images of a vision sensor: a camera of a scene whose images clients and scripts can read.
#[derive(Clone, Debug, PartialEq)]
pub struct VisionSensor {
    /// Resolution, depth range and projection.
    pub optics: Optics,
    /// Background colour: red, green, blue, 0 to 255.
    pub background: [u8; 3],
    /// True if images are taken only when a client or script asks for one, not in every step.
    pub is_explicit: bool,
    /// True if no images are taken: clients and scripts write them.
    pub is_external: bool,
}

fn world() -> String {
    "/".into()
}

fn field_of_view() -> f64 {
    38.0
}

/// Settings of its images, if it has any; reports those that are not valid.
pub(super) fn sensor(
    file: &CameraFile,
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Option<VisionSensor> {
    let name = &file.name;
    let Some(resolution) = file.resolution else {
        let keys = ["near", "far", "orthographic_height", "background", "explicit_handling", "external_input"];
        let given = [
            file.near.is_some(),
            file.far.is_some(),
            file.orthographic_height.is_some(),
            file.background.is_some(),
            file.explicit_handling.is_some(),
            file.external_input.is_some(),
        ];
        for (key, _) in keys.into_iter().zip(given).filter(|(_, is_given)| *is_given) {
            let at = document.at(&format!("{pointer}/{key}"));
            let diagnostic = Diagnostic::error(&at, format!("camera `{name}` has `{key}`, but no `resolution`"));
            diagnostics.push(diagnostic.with_help("`resolution = [256, 256]` makes it a vision sensor"));
        }
        return None;
    };
    let optics = Optics {
        resolution: resolution.map(|n| n as usize),
        near: file.near.unwrap_or(camera::NEAR),
        far: file.far.unwrap_or(camera::FAR),
        lens: match file.orthographic_height {
            Some(height) => Lens::Orthographic(height),
            None => Lens::Perspective(file.field_of_view_deg.to_radians()),
        },
    };
    // a wrong field of view is said of every camera
    for wrong in optics.invalid_settings().into_iter().filter(|wrong| wrong.key != "field_of_view_deg") {
        let at = document.at(&format!("{pointer}/{}", wrong.key));
        let diagnostic = Diagnostic::error(&at, format!("camera `{name}` has {}", wrong.found));
        diagnostics.push(diagnostic.with_help(format!("expected {}", wrong.expected)));
    }
    let at = document.at(&format!("{pointer}/background"));
    let background = file.background.as_ref().and_then(|text| body::color(text, &at, diagnostics));
    Some(VisionSensor {
        optics,
        background: background.unwrap_or(camera::BACKGROUND),
        is_explicit: file.explicit_handling.unwrap_or_default(),
        is_external: file.external_input.unwrap_or_default(),
    })
}

/// Its frame in its parent's; notes what cannot be.
pub(super) fn pose(file: &CameraFile, pointer: &str, document: &Document, diagnostics: &mut Diagnostics) -> Pose<f64> {
    if file.field_of_view_deg >= 170.0 {
        let at = document.at(&format!("{pointer}/field_of_view_deg"));
        let message = format!("camera `{}` has a field of view of {}°", file.name, file.field_of_view_deg);
        diagnostics.push(Diagnostic::error(&at, message).with_help("expected more than 0° and less than 170°"));
    }
    let Some(target) = file.look_at else {
        let placement = Placement::new(file.position, file.rotation_deg, file.quaternion_wxyz);
        return placement::pose(&placement, pointer, document, diagnostics);
    };
    let pos = Vec3(file.position);
    let rot = looking(Vec3(target) - pos).unwrap_or_else(|| {
        let at = document.at(&format!("{pointer}/look_at"));
        let diagnostic = Diagnostic::error(&at, format!("camera `{}` stands where it looks at", file.name));
        diagnostics.push(diagnostic.with_help("give a `position` away from `look_at`"));
        Mat3::identity()
    });
    Pose { rot, pos }
}

/// Axes of a camera that looks along `ahead`, z up in the picture; straight up or down: y.
pub(crate) fn looking(ahead: Vec3<f64>) -> Option<Mat3<f64>> {
    let length = ahead.norm();
    if length < 1e-9 || !length.is_finite() {
        return None;
    }
    let z = ahead.scale(1.0 / length);
    let is_steep = z[0] * z[0] + z[1] * z[1] < 1e-12;
    let up = Vec3(if is_steep { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] });
    let across = up.cross(z);
    let x = across.scale(1.0 / across.norm());
    let y = z.cross(x);
    Some(Mat3(std::array::from_fn(|row| [x[row], y[row], z[row]])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_above_is_above_in_the_picture() {
        for ahead in [[1.0, 0.0, 0.0], [0.3, -0.4, 2.0], [0.0, 2.0, -0.1]] {
            let rot = looking(Vec3(ahead)).unwrap();
            assert!((rot.col(0).cross(rot.col(1)).dot(rot.col(2)) - 1.0).abs() < 1e-12);
            let along = rot.mul_vec(Vec3([0.0, 0.0, 1.0]));
            assert!(along.cross(Vec3(ahead)).norm() < 1e-12 && along.dot(Vec3(ahead)) > 0.0);
            let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|axis| rot.mul_vec(Vec3(axis)));
            assert!(x[2].abs() < 1e-12 && y[2] > 0.0, "{ahead:?}: level, upright");
        }
        // from above the world's y is up
        assert_eq!(looking(Vec3([0.0, 0.0, -1.0])).unwrap().mul_vec(Vec3([0.0, 1.0, 0.0])).0, [0.0, 1.0, 0.0]);
        assert!(looking(Vec3([0.0; 3])).is_none());
    }
}

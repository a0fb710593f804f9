//! Viewpoint of a picture: from far away, fitted to the scene, or through a camera of the scene.

use sincro_math::elementary;

use crate::vector::{V, cross, dot, origin, rotate, scale, sub, unit};

/// From where the page's own first camera stands, seen from what it looks at.
const FAR: [f64; 3] = [0.55, -1.0, 0.42];

/// Axes of the view; for a camera its position, and the height of its picture at a distance of one metre.
pub(super) struct Viewpoint {
    right: V,
    up: V,
    back: V,
    camera: Option<(V, f64)>,
}

impl Viewpoint {
    /// Far away: lines that are parallel stay so.
    pub fn far() -> Self {
        let back = unit(FAR);
        let right = unit(cross([0.0, 0.0, 1.0], back));
        Self { right, up: cross(back, right), back, camera: None }
    }

    /// A camera at a pose, with its field of view `[deg]`.
    pub fn camera(pose: &[f64; 7], field_of_view_deg: f64) -> Self {
        let axis = |a: V| rotate(pose, a);
        let (sin, cos) = elementary::sin_cos(0.5 * field_of_view_deg.to_radians());
        let tall = 2.0 * sin / cos;
        // it looks along its z; its x points to the left
        Self {
            right: axis([-1.0, 0.0, 0.0]),
            up: axis([0.0, 1.0, 0.0]),
            back: axis([0.0, 0.0, -1.0]),
            camera: Some((origin(pose), tall)),
        }
    }

    /// Returns true if the picture's size is the camera's own.
    pub fn tall(&self) -> Option<f64> {
        self.camera.map(|(_, tall)| tall)
    }

    /// In the picture, y down; none for what is not in front of a camera.
    pub fn flat(&self, p: V) -> Option<(f64, f64)> {
        let Some((at, _)) = self.camera else { return Some((dot(p, self.right), -dot(p, self.up))) };
        let d = sub(p, at);
        let ahead = -dot(d, self.back);
        (ahead > 1e-3).then(|| (dot(d, self.right) / ahead, -dot(d, self.up) / ahead))
    }

    /// Direction of the world in the picture, y down.
    pub fn direction(&self, axis: V) -> (f64, f64) {
        (dot(axis, self.right), -dot(axis, self.up))
    }

    /// Increases towards the viewpoint.
    pub fn depth(&self, p: V) -> f64 {
        match self.camera {
            None => dot(p, self.back),
            Some((at, _)) => -dot(sub(p, at), sub(p, at)).sqrt(),
        }
    }

    /// Unit vector from a point to the viewpoint.
    pub fn towards(&self, p: V) -> V {
        match self.camera {
            None => self.back,
            Some((at, _)) => {
                let d = sub(at, p);
                scale(d, 1.0 / dot(d, d).sqrt().max(1e-12))
            }
        }
    }
}

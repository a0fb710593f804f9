//! A camera of a scene that takes one picture after the other, outside of any run.

use std::sync::Arc;

use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::{ObjectKind, Scene, VisionSensor, frame_of, looking};
use crate::camera::{BACKGROUND, FAR, Image, Lens, NEAR, Optics, Renderer};
use crate::scenery::{Scenery, placed};

/// A camera with all it needs; what it takes is used again for the next picture.
pub struct Camera {
    model: Arc<Model<f64>>,
    sensor: VisionSensor,
    frame: Attached<f64>,
    scenery: Scenery,
    scratch: Scratch<f64>,
    renderer: Renderer,
    image: Image,
}

impl Camera {
    /// Object `k` of a scene; none if it is no camera. One that is no vision sensor takes pictures of `resolution`.
    #[must_use]
    pub fn of_scene(scene: &Scene, k: usize, resolution: [usize; 2]) -> Option<Self> {
        let ObjectKind::Camera { field_of_view_deg, sensor } = &scene.objects.get(k)?.kind else { return None };
        let lens = Lens::Perspective(field_of_view_deg.to_radians());
        let plain = || VisionSensor {
            optics: Optics { resolution, near: NEAR, far: FAR, lens },
            background: BACKGROUND,
            is_explicit: false,
            is_external: false,
        };
        Some(Self::new(scene, sensor.clone().unwrap_or_else(plain), frame_of(scene, k)))
    }

    /// A camera of one's own, which stands in the world and looks at a point `[m]`, z up in the picture; none if it
    /// stands there.
    #[must_use]
    pub fn looking_at(scene: &Scene, optics: Optics, from: [f64; 3], at: [f64; 3]) -> Option<Self> {
        let pos = Vec3(from);
        let pose = Pose { rot: looking(Vec3(at) - pos)?, pos };
        let sensor = VisionSensor { optics, background: BACKGROUND, is_explicit: false, is_external: false };
        Some(Self::new(scene, sensor, Attached { link: None, pose }))
    }

    /// Creates a camera that no file describes, fixed to a frame at its pose `[m]`.
    #[must_use]
    pub fn new(scene: &Scene, sensor: VisionSensor, frame: Attached<f64>) -> Self {
        let image = Image::new(&sensor.optics);
        let (scenery, scratch) = (scene.scenery().clone(), Scratch::new(&scene.model));
        Self { model: scene.model.clone(), sensor, frame, scenery, scratch, renderer: Renderer::new(), image }
    }

    /// Optics of the camera.
    #[must_use]
    pub fn optics(&self) -> &Optics {
        &self.sensor.optics
    }

    /// Renders the image at coordinates `q` (n_q) `[rad]`, `[m]`.
    pub fn render(&mut self, q: &[f64]) -> &Image {
        kinematics::poses(&self.model, q, &mut self.scratch);
        let x_wc = kinematics::frame_pose(&self.scratch, &self.frame);
        let pieces = placed(self.scenery.pieces.iter(), &self.scratch);
        self.renderer.draw(pieces, (&x_wc, &self.sensor.optics), self.sensor.background, &mut self.image);
        &self.image
    }
}

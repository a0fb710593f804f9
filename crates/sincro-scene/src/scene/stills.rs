//! A camera of a scene that takes one picture after the other, outside of any run.

use std::sync::Arc;

use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::{ObjectKind, Scene, VisionSensor, frame_of, looking};
use crate::camera::{BACKGROUND, FAR, Image, Lens, NEAR, Optics, Renderer};
use crate::scenery::{Scenery, visible};

/// Camera that renders images of a scene at given coordinates, outside of any run; it keeps its buffers from image to
/// image.
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
    /// Creates the camera that is object `k` of a scene; `None` if `k` is no object or no camera. A vision sensor has
    /// its own optics; any other camera renders `resolution` columns and rows.
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

    /// Creates a camera that stands at the point `from` of the world and looks at the point `at`, both x, y, z `[m]`,
    /// with the world's z up in the image (y if it looks straight up or down); `None` if the two points are the same.
    #[must_use]
    pub fn looking_at(scene: &Scene, optics: Optics, from: [f64; 3], at: [f64; 3]) -> Option<Self> {
        let pos = Vec3(from);
        let pose = Pose { rot: looking(Vec3(at) - pos)?, pos };
        let sensor = VisionSensor { optics, background: BACKGROUND, is_explicit: false, is_external: false };
        Some(Self::new(scene, sensor, Attached { link: None, pose }))
    }

    /// Creates a camera with the settings `sensor`, fixed to the link or world frame `frame` at its pose there `[m]`;
    /// it looks along z of that pose.
    #[must_use]
    pub fn new(scene: &Scene, sensor: VisionSensor, frame: Attached<f64>) -> Self {
        let image = Image::new(&sensor.optics);
        let (scenery, scratch) = (scene.scenery().clone(), Scratch::new(&scene.model));
        Self { model: scene.model.clone(), sensor, frame, scenery, scratch, renderer: Renderer::new(), image }
    }

    /// Returns the optics of the camera.
    #[must_use]
    pub fn optics(&self) -> &Optics {
        &self.sensor.optics
    }

    /// Renders the image at the coordinates `q`, `n_q` numbers `[rad]`, `[m]` in the order of the model's state; it
    /// stays valid until the next call.
    ///
    /// # Panics
    ///
    /// If `q` is shorter than `n_q`.
    pub fn render(&mut self, q: &[f64]) -> &Image {
        kinematics::poses(&self.model, q, &mut self.scratch);
        let x_wc = kinematics::frame_pose(&self.scratch, &self.frame);
        let pieces = visible(self.scenery.pieces.iter(), &self.scratch);
        self.renderer.draw(pieces, (&x_wc, &self.sensor.optics), self.sensor.background, &mut self.image);
        &self.image
    }
}

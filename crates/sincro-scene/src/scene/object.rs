//! Objects of a scene as the user named them: for trees, viewers and paths.

use sincro_dynamics::contact::{Material, Surface};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{MassProperties, Shape};
use sincro_dynamics::spatial::Pose;

use super::camera::VisionSensor;
use crate::diagnostic::Location;

/// Object of a scene: joint, body, frame, force, rotor, drag element, sensor or camera, as the tree of the scene shows
/// it; an entry of [`Scene::objects`](super::Scene::objects).
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"frame = [
///     { name = "mast", position = [0.0, 0.0, 2.0] },
///     { name = "tip", parent = "/mast", position = [0.5, 0.0, 0.0] },
/// ]"#)?;
/// let tip: &Object = scene.object("/mast/tip").unwrap();
/// let mast = &scene.objects[tip.parent.unwrap()];
/// assert_eq!((mast.path.as_str(), tip.name.as_str()), ("/mast", "tip"));
/// assert_eq!(mast.pose.compose(&tip.pose).pos.0, [0.5, 0.0, 2.0]); // in the world [m]
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Object {
    /// Number that it keeps when the scene is edited ([`crate::draft`]); in a scene of a file its index.
    pub id: usize,
    /// Path: that of the parent, `/`, and the name.
    pub path: String,
    /// Name, the last part of the path.
    pub name: String,
    /// Its kind.
    pub kind: ObjectKind,
    /// Index of its parent among the objects of the scene; `None` for children of the world.
    pub parent: Option<usize>,
    /// Pose of its frame in its parent's frame `[m]`; of what a joint carries at zero coordinates.
    pub pose: Pose<f64>,
    /// Contact material of a body that can touch others; `None` for all else.
    pub contact: Option<Material>,
    /// Surfaces of a body that enclose no solid with mass, such as planes and meshes, each with its pose in the body's
    /// frame `[m]`.
    pub surfaces: Vec<(Surface, Pose<f64>)>,
    /// Colours of `surfaces`, one for each: red, green, blue, 0 to 255; `None` where it has none of its own.
    pub surface_colors: Vec<Option<[u8; 3]>>,
    /// Solids of a body.
    pub shapes: Vec<ShapeInstance>,
    /// Geometry that is shown in the place of shapes and surfaces; empty: those are shown.
    pub visuals: Vec<ShownSurface>,
    /// Location of its name in the scene file.
    pub location: Location,
}

impl Object {
    /// Returns the visible geometry in the object's frame: the visuals, or shapes and surfaces where there are none.
    pub fn shown(&self) -> impl Iterator<Item = ShownSurface> {
        let own = self.visuals.is_empty();
        let solids =
            self.shapes.iter().map(|s| ShownSurface { surface: Surface::Solid(s.shape), pose: s.pose, color: s.color });
        let surfaces = self.surfaces.iter().enumerate().map(|(k, (surface, pose))| ShownSurface {
            surface: surface.clone(),
            pose: *pose,
            color: self.surface_colors.get(k).copied().flatten(),
        });
        self.visuals.iter().cloned().chain(solids.chain(surfaces).filter(move |_| own))
    }
}

/// Visible geometry of an object, with pose and colour; see [`Object::shown`].
#[derive(Clone, Debug, PartialEq)]
pub struct ShownSurface {
    /// Surface, in its own frame.
    pub surface: Surface,
    /// Pose of that frame in the object's frame `[m]`.
    pub pose: Pose<f64>,
    /// Colour: red, green, blue, 0 to 255; `None`: chosen by the viewer.
    pub color: Option<[u8; 3]>,
}

/// Kind of an [`Object`], with what belongs to this kind alone.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"
///     joint = [{ name = "base", kind = "free" }]
///     body = [{ name = "cube", parent = "/base", density = 1e3, shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }] }]
/// "#)?;
/// let ObjectKind::Body { mass } = scene.object("/base/cube").unwrap().kind else { panic!("a cube is a body") };
/// assert!((mass.mass - 1.0).abs() < 1e-15); // [kg]
/// assert_eq!(scene.object("/base").unwrap().kind.word(), "free joint");
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum ObjectKind {
    /// Joint, fixed ones included.
    Joint {
        /// Kind of its motion.
        kind: JointKind,
        /// Index of its motor among the model's motors, if it has one; of the first one, if it has several.
        motor: Option<usize>,
    },
    /// Body with mass.
    Body {
        /// Mass properties `[kg]`, `[m]`, `[kg·m²]` in the body's frame.
        mass: MassProperties,
    },
    /// Body without mass, fixed in the world: a floor, a wall.
    Fixture,
    /// Named frame without mass.
    Frame,
    /// External force on its parent.
    Force,
    /// Rotor on its parent, with its thrust along z of its frame.
    Rotor,
    /// Drag element on its parent, along the axes of its frame.
    Drag,
    /// Sensor on its parent.
    Sensor,
    /// Camera, which looks along z of its frame; no part of the model.
    Camera {
        /// Angle between the upper and the lower edge of its image `[deg]`.
        field_of_view_deg: f64,
        /// Settings of its images, if it is a vision sensor.
        sensor: Option<VisionSensor>,
    },
}

impl ObjectKind {
    /// Returns the kind in English for messages and lists, such as `revolute joint` or `body`.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Joint { kind, .. } => match kind {
                JointKind::Fixed => "fixed joint",
                JointKind::Revolute { .. } => "revolute joint",
                JointKind::Prismatic { .. } => "prismatic joint",
                JointKind::Screw { .. } => "screw joint",
                JointKind::Universal { .. } => "universal joint",
                JointKind::Ball => "ball joint",
                JointKind::Planar => "planar joint",
                JointKind::Free => "free joint",
            },
            Self::Body { .. } => "body",
            Self::Fixture => "fixture",
            Self::Frame => "frame",
            Self::Force => "force",
            Self::Rotor => "rotor",
            Self::Drag => "drag",
            Self::Sensor => "sensor",
            Self::Camera { .. } => "camera",
        }
    }
}

/// Solid of a body, with pose, density and colour; an entry of [`Object::shapes`].
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeInstance {
    /// Solid with its dimensions `[m]`.
    pub shape: Shape,
    /// Pose of the solid's frame in the body's frame `[m]`.
    pub pose: Pose<f64>,
    /// Density `[kg/m³]`, its own or the body's; `None` if the body's mass is given directly.
    pub density: Option<f64>,
    /// Colour: red, green, blue, 0 to 255; `None`: chosen by the viewer.
    pub color: Option<[u8; 3]>,
}

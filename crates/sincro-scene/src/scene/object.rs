//! Objects of a scene as the user named them: for trees, viewers and paths.

use sincro_dynamics::contact::{Material, Surface};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{MassProperties, Shape};
use sincro_dynamics::spatial::Pose;

use super::camera::VisionSensor;
use crate::diagnostic::Location;

/// A joint, body, frame or force.
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
    /// Parent's path, `/` and name.
    pub path: String,
    /// Last part of the path.
    pub name: String,
    /// Its kind.
    pub kind: ObjectKind,
    /// Index of its parent among the objects; none for children of the world.
    pub parent: Option<usize>,
    /// Pose of its frame in its parent's (at zero coordinates, if it is carried by a joint).
    pub pose: Pose<f64>,
    /// Contact material of a body; beside its shapes there are surfaces that enclose nothing, such as planes.
    pub contact: Option<Material>,
    /// Surfaces of a body that are not solids with mass.
    pub surfaces: Vec<(Surface, Pose<f64>)>,
    /// Colours of the surfaces, as far as they have one.
    pub surface_colors: Vec<Option<[u8; 3]>>,
    /// Shapes of a body.
    pub shapes: Vec<ShapeInstance>,
    /// Geometry that shows in the place of shapes and surfaces, if there is any.
    pub visuals: Vec<ShownSurface>,
    /// Its name in the file.
    pub location: Location,
}

impl Object {
    /// Visible geometry: the visuals, or shapes and surfaces where there are none.
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

/// Geometry as it shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownSurface {
    /// Geometry in its own frame.
    pub surface: Surface,
    /// Pose in the object's frame.
    pub pose: Pose<f64>,
    /// Red, green, blue.
    pub color: Option<[u8; 3]>,
}

/// Kind of an object.
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
    /// Joint; fixed ones too.
    Joint {
        /// Kind of motion.
        kind: JointKind,
        /// Index of its motor among the model's, if it has one.
        motor: Option<usize>,
    },
    /// Body.
    Body {
        /// In its own frame.
        mass: MassProperties,
    },
    /// Body without mass, fixed in the world: a floor, a wall.
    Fixture,
    /// Named point.
    Frame,
    /// External force on its parent.
    Force,
    /// Rotor on its parent; thrust along its z.
    Rotor,
    /// Drag of its parent, along its own axes.
    Drag,
    /// Sensor on its parent.
    Sensor,
    /// Camera; no part of the model.
    Camera {
        /// Angle between the upper and the lower edge of its picture `[deg]`.
        field_of_view_deg: f64,
        /// Settings of its images, if clients and scripts can read them.
        sensor: Option<VisionSensor>,
    },
}

impl ObjectKind {
    /// The word for it, such as `revolute joint` or `body`.
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

/// A solid of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeInstance {
    /// The solid.
    pub shape: Shape,
    /// Pose in the body's frame.
    pub pose: Pose<f64>,
    /// [kg/m³], if it has one: its own or the body's.
    pub density: Option<f64>,
    /// Red, green, blue.
    pub color: Option<[u8; 3]>,
}

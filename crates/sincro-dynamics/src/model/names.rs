//! Names: from the user's joints, bodies and frames to links and coordinates.

use super::NodeId;
use crate::ids::{BodyId, JointId, MotorId, RotorId};
use crate::joint::JointKind;
use crate::spatial::Pose;

/// A frame fixed in a link (`None`: in the world) at a pose.
#[derive(Clone, Copy, Debug)]
pub struct Attached<R> {
    /// The link, none for the world.
    pub link: Option<usize>,
    /// Pose of the frame in the link or the world.
    pub pose: Pose<R>,
}

/// A joint as the user built it.
#[derive(Clone, Debug)]
pub struct JointInfo {
    /// Name given by the user (a path in a scene).
    pub name: String,
    /// Node in the builder.
    pub node: NodeId,
    /// Kind.
    pub kind: JointKind,
    /// First coordinate in q.
    pub q_idx: usize,
    /// Number of coordinates.
    pub n_q: usize,
    /// First degree of freedom in v.
    pub v_idx: usize,
    /// Number of degrees of freedom.
    pub n_v: usize,
    /// Its motor, if it has one.
    pub motor: Option<MotorId>,
    /// Its frame on the side of its parent, where the joint starts from.
    pub base: Attached<f64>,
    /// Its frame on the side of what hangs on it: the same at zero coordinates.
    pub moving: Attached<f64>,
}

/// A body or frame as the user built it.
#[derive(Clone, Debug)]
pub struct FrameInfo {
    /// Name given by the user (a path in a scene).
    pub name: String,
    /// Node in the builder.
    pub node: NodeId,
    /// The link that carries it, none if it is fixed in the world.
    pub link: Option<usize>,
    /// Its pose in that link, or in the world.
    pub pose: Pose<f64>,
    /// True if it is a body: [`Model::mass_properties`](super::Model::mass_properties) has its mass.
    pub is_body: bool,
}

/// A sensor on a frame: what its values are called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SensorInfo {
    /// Name given by the user (a path in a scene).
    pub name: String,
    /// Names of its values and their units, in their order.
    pub values: Vec<(String, String)>,
}

/// All names of a model.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0; 3]);
/// let mut elbow = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// elbow.motor = Some(Motor::new(MotorMode::Torque));
/// let elbow = builder.joint("elbow", NodeId::WORLD, Pose::identity(), elbow);
/// let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// builder.body("forearm", elbow, Pose::identity(), BodySpec { mass });
/// let (model, _warnings) = builder.build()?;
/// let names = model.names();
/// let elbow: JointId = names.joint_id("elbow").unwrap();
/// assert_eq!((names.joint_info(elbow).v_idx, names.dof_name(0)), (0, "elbow"));
/// assert_eq!(names.motor_id("elbow").map(MotorId::index), Some(0));
/// assert!(names.body_id("upper arm").is_none());
/// # Ok::<(), BuildError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Joints in the order they were added, fixed ones left out.
    pub joints: Vec<JointInfo>,
    /// Bodies and frames in the order they were added.
    pub frames: Vec<FrameInfo>,
    /// External forces that take commands, in the order of those.
    pub inputs: Vec<String>,
    /// Rotors, in the order of [`super::Model::rotors`].
    pub rotors: Vec<String>,
    /// Drag elements, in the order of [`super::Model::drags`].
    pub drags: Vec<String>,
    /// Springs and dampers between two points, in the order of the model's.
    pub spring_dampers: Vec<String>,
    /// Sensors, which are frames too; the model does not measure, it only knows what they are called.
    pub sensors: Vec<SensorInfo>,
    /// For each degree of freedom, the joint it belongs to.
    pub dof_joint: Vec<JointId>,
}

impl Names {
    /// The joint of that name.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<&JointInfo> {
        self.joints.iter().find(|j| j.name == name)
    }

    /// The body or frame of that name.
    #[must_use]
    pub fn frame(&self, name: &str) -> Option<&FrameInfo> {
        self.frames.iter().find(|f| f.name == name)
    }

    /// Id of the joint of that name; none if there is none, or if it is fixed.
    #[must_use]
    pub fn joint_id(&self, name: &str) -> Option<JointId> {
        self.joints.iter().position(|j| j.name == name).map(JointId::new)
    }

    /// Id of the body or frame of that name.
    #[must_use]
    pub fn body_id(&self, name: &str) -> Option<BodyId> {
        self.frames.iter().position(|f| f.name == name).map(BodyId::new)
    }

    /// Id of the motor of the joint of that name.
    #[must_use]
    pub fn motor_id(&self, joint: &str) -> Option<MotorId> {
        self.joint(joint)?.motor
    }

    /// Id of the rotor of that name.
    #[must_use]
    pub fn rotor_id(&self, name: &str) -> Option<RotorId> {
        self.rotors.iter().position(|r| r == name).map(RotorId::new)
    }

    /// Joint of that id.
    ///
    /// # Panics
    ///
    /// If the model has no such joint.
    #[must_use]
    pub fn joint_info(&self, id: JointId) -> &JointInfo {
        &self.joints[id.index()]
    }

    /// Body or frame of that id.
    ///
    /// # Panics
    ///
    /// If the model has no such body.
    #[must_use]
    pub fn body_info(&self, id: BodyId) -> &FrameInfo {
        &self.frames[id.index()]
    }

    /// Name of the joint that degree of freedom `dof` belongs to.
    #[must_use]
    pub fn dof_name(&self, dof: usize) -> &str {
        &self.joints[self.dof_joint[dof].index()].name
    }
}

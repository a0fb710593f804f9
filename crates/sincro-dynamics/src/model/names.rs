//! Names: from the user's joints, bodies and frames to links and coordinates.

use super::NodeId;
use crate::ids::{BodyId, JointId, MotorId, RotorId};
use crate::joint::JointKind;
use crate::spatial::Pose;

/// Frame fixed in a link or in the world, argument of the functions of [`kinematics`](crate::kinematics).
#[derive(Clone, Copy, Debug)]
pub struct Attached<R> {
    /// Index of the link in [`Model::links`](super::Model::links); `None` for the world.
    pub link: Option<usize>,
    /// Pose of the frame in the link, or in the world `[m]`.
    pub pose: Pose<R>,
}

/// Joint as the user built it, with its place in q and v; entry of [`Names::joints`].
#[derive(Clone, Debug)]
pub struct JointInfo {
    /// Name given by the user (a path in a scene).
    pub name: String,
    /// Id in the builder.
    pub node: NodeId,
    /// Kind and axes.
    pub kind: JointKind,
    /// Index in q of its first coordinate.
    pub q_idx: usize,
    /// Number of its coordinates, which are consecutive in q.
    pub n_q: usize,
    /// Index in v of its first degree of freedom.
    pub v_idx: usize,
    /// Number of its degrees of freedom, which are consecutive in v.
    pub n_v: usize,
    /// Id of the motor of its first degree of freedom; `None` without motors. See [`JointInfo::motors`].
    pub motor: Option<MotorId>,
    /// Joint frame on the side of the parent.
    pub base: Attached<f64>,
    /// Joint frame on the side of the child; coincides with `base` at zero coordinates.
    pub moving: Attached<f64>,
}

impl JointInfo {
    /// Ids of its motors, one for each degree of freedom; none for a joint without motors.
    pub fn motors(&self) -> impl Iterator<Item = MotorId> {
        let first = self.motor.into_iter();
        first.flat_map(|first| (0..self.n_v).map(move |k| MotorId::new(first.index() + k)))
    }
}

/// Body or frame as the user built it; entry of [`Names::frames`].
#[derive(Clone, Debug)]
pub struct FrameInfo {
    /// Name given by the user (a path in a scene).
    pub name: String,
    /// Id in the builder.
    pub node: NodeId,
    /// Index of the link that carries it in [`Model::links`](super::Model::links); `None` if it is fixed in the world.
    pub link: Option<usize>,
    /// Pose in that link, or in the world `[m]`.
    pub pose: Pose<f64>,
    /// True if it is a body: [`Model::mass_properties`](super::Model::mass_properties) has its mass.
    pub is_body: bool,
}

/// Sensor on a frame, for recordings and interfaces: the names and units of its values. The model does not measure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SensorInfo {
    /// Name given by the user (a path in a scene), that of its frame.
    pub name: String,
    /// Name and unit of each value, in the order in which the sensor gives them.
    pub values: Vec<(String, String)>,
}

/// Names of the objects of a model as the user built it, and their ids; from [`Model::names`](super::Model::names).
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0; 3]);
/// let mut elbow = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// elbow.motor = vec![Motor::new(MotorMode::Torque)];
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
    /// Joints in the order they were added, fixed ones left out; the order of [`JointId`].
    pub joints: Vec<JointInfo>,
    /// Bodies and frames in the order they were added; the order of [`BodyId`].
    pub frames: Vec<FrameInfo>,
    /// Names of the external forces that take commands, in the order of their commands.
    pub inputs: Vec<String>,
    /// Names of the rotors, in the order of [`super::Model::rotors`].
    pub rotors: Vec<String>,
    /// Names of the drag elements, in the order of [`super::Model::drags`].
    pub drags: Vec<String>,
    /// Names of the springs and dampers between two points, in the order of [`super::Model::spring_dampers`].
    pub spring_dampers: Vec<String>,
    /// Names of the elastic gears, in the order of [`Model::elastic_gears`](super::Model::elastic_gears).
    pub elastic_gears: Vec<String>,
    /// Names of the bushings, in the order of [`Model::bushings`](super::Model::bushings).
    pub bushings: Vec<String>,
    /// Sensors, each with a frame of the same name.
    pub sensors: Vec<SensorInfo>,
    /// Id of the joint of each degree of freedom (n_v).
    pub dof_joint: Vec<JointId>,
}

impl Names {
    /// Joint of that name; `None` if there is none, or if it is fixed.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<&JointInfo> {
        self.joints.iter().find(|j| j.name == name)
    }

    /// Body or frame of that name; `None` if there is none.
    #[must_use]
    pub fn frame(&self, name: &str) -> Option<&FrameInfo> {
        self.frames.iter().find(|f| f.name == name)
    }

    /// Id of the joint of that name; `None` if there is none, or if it is fixed.
    #[must_use]
    pub fn joint_id(&self, name: &str) -> Option<JointId> {
        self.joints.iter().position(|j| j.name == name).map(JointId::new)
    }

    /// Id of the body or frame of that name; `None` if there is none.
    #[must_use]
    pub fn body_id(&self, name: &str) -> Option<BodyId> {
        self.frames.iter().position(|f| f.name == name).map(BodyId::new)
    }

    /// Id of the motor of the joint of that name, of its first degree of freedom if it has several; `None` if there is
    /// no such joint, or if it has no motor.
    #[must_use]
    pub fn motor_id(&self, joint: &str) -> Option<MotorId> {
        self.joint(joint)?.motor
    }

    /// Id of the rotor of that name; `None` if there is none.
    #[must_use]
    pub fn rotor_id(&self, name: &str) -> Option<RotorId> {
        self.rotors.iter().position(|r| r == name).map(RotorId::new)
    }

    /// Joint of that id, with its place in q and v.
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

    /// Joint of a degree of freedom.
    ///
    /// # Panics
    ///
    /// If the model has no such degree of freedom.
    #[must_use]
    pub fn joint_of(&self, dof: usize) -> &JointInfo {
        &self.joints[self.dof_joint[dof].index()]
    }

    /// Name of the joint to which degree of freedom `dof` belongs. Panics if there is no such degree of freedom.
    #[must_use]
    pub fn dof_name(&self, dof: usize) -> &str {
        &self.joints[self.dof_joint[dof].index()].name
    }
}

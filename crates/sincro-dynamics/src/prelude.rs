//! The types that a program with a world of its own needs: `use sincro_dynamics::prelude::*;`.

pub use crate::actuation::{Motor, MotorMode};
pub use crate::contact::Material;
pub use crate::energy::Energy;
pub use crate::geometry::{MassProperties, Shape, Surface};
pub use crate::ids::{BodyId, JointId, MotorId, RotorId};
pub use crate::joint::JointKind;
pub use crate::model::{BodySpec, BuildError, JointSpec, Model, ModelBuilder, NodeId};
pub use crate::spatial::{Mat3, Pose, Quat, Vec3};
pub use crate::state::State;
pub use crate::world::{MethodKind, StepError, StepReport, World, WorldBuilder};

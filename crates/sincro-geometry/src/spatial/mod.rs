//! Spatial algebra in 3×3 blocks: six-vectors as (angular, linear) pairs, inertias without a dense 6×6 anywhere.
//!
//! Everything is generic over [`Real`](sincro_math::Real) and inlined, so that one source serves scalars, lanes and
//! duals. Source: key `featherstone2008`, chapter 2; angular part first, as there.

mod inertia;
mod mat3;
mod motion;
mod pose;
mod quat;
mod sym3;
mod vec3;

pub use inertia::{ArticulatedInertia, RigidInertia};
pub use mat3::Mat3;
pub use motion::{Force, Motion};
pub use pose::Pose;
pub use quat::{Quat, rotation_between};
pub use sym3::Sym3;
pub use vec3::Vec3;

//! The API of V-REP and CoppeliaSim: objects by handle, typed functions, functions by name.
//!
//! | type | role |
//! |---|---|
//! | [`ObjectRegistry`] | the objects with their handles and names, signals, held commands: plain data, lives in the lock-step |
//! | [`SimApi`] | a registry with its world, created for one call or phase: the typed functions of the API |
//! | [`functions`] | the same functions by name, as `sim.getJointPosition`: [`Value`]s in, [`Value`]s out; what Lua and ZeroMQ share |
//!
//! Nothing here has a clock, a thread or a socket.

mod added_scripts;
mod bodies;
mod change;
mod collections;
mod contacts;
mod distances;
mod drawings;
mod filters;
mod find;
mod flags;
pub mod functions;
mod graphs;
mod ik;
mod ik_objects;
mod ik_search;
mod joint_modes;
mod joints;
mod lens;
mod meshes;
mod meshing;
mod motions;
mod pairs;
mod parameters;
mod placing;
mod planning;
mod program;
mod proximity;
mod registry;
mod rotors;
mod runtime_objects;
mod scene_objects;
mod senses;
mod shapes;
mod sim_api;
mod structure;
mod textures;
mod tree;
mod vision;

pub use collections::Entity;
pub(crate) use collections::Item;
pub use contacts::ContactPoint;
pub use distances::DistanceResult;
pub use filters::{VisionInput, VisionReading, check_packets};
pub use find::Search;
pub use pairs::ContactOverride;
pub(crate) use registry::Request;
pub use registry::{Entry, Handle, JointEntry, Kind, LogLine, ObjectRegistry};
pub use sim_api::{Reference, SimApi};
pub(crate) use sincro_planning::Motion;

pub use sincro_conventions::{constants, poses as convention};
pub use sincro_dynamics::spatial::{Pose, Vec3};
pub use sincro_planning as paths;
pub use sincro_values::stored::check_name;
pub use sincro_values::{ApiError, Arguments, LegacyPorts, PortRequest, Signals, Value, cbor, topics};
use sincro_values::{radio, stored};

/// State of the simulation of a session, as clients and scripts ask for it; [`ObjectRegistry::phase`] holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// No run: time is 0, the scene can be changed.
    Stopped,
    /// A run that advances as soon as all clients that step have asked for the next step.
    Running,
    /// A run that waits to be started again.
    Paused,
}

//! The API of V-REP and CoppeliaSim: objects by handle, typed functions, functions by name.
//!
//! | type | role |
//! |---|---|
//! | [`ObjectRegistry`] | the objects with their handles and names, signals, held commands: plain data, lives in the lock-step |
//! | [`SimApi`] | a registry with its world, created for one call or phase: the typed functions of the API |
//! | [`functions`] | the same functions by name, as `sim.getJointPosition`: [`Value`]s in, [`Value`]s out; what Lua and ZeroMQ share |
//!
//! Nothing here has a clock, a thread or a socket.

mod bodies;
pub mod cbor;
mod change;
mod collections;
pub mod constants;
mod contacts;
pub mod convention;
mod distances;
mod error;
mod find;
pub mod functions;
mod graphs;
pub mod ik;
mod ik_search;
mod joints;
mod lens;
mod motions;
mod note;
mod pairs;
mod parameters;
mod ports;
mod program;
mod proximity;
mod registry;
mod rotors;
mod runtime_objects;
mod senses;
pub mod shapes;
mod signals;
mod sim_api;
mod stored;
mod tubes;
mod unpack;
mod value;
mod vision;

pub use collections::{Collection, Entity, Item};
pub use contacts::ContactPoint;
pub use distances::DistanceResult;
pub use error::ApiError;
pub use find::Search;
pub use graphs::{Graphs, Stream};
pub use motions::{Motion, MotionStep};
pub use pairs::ContactOverride;
pub use ports::LegacyPorts;
pub use registry::{Entry, Handle, JointEntry, Kind, LogLine, ObjectRegistry, Request};
pub use signals::Signals;
pub use sim_api::{Reference, SimApi};
pub use stored::{Form, Stored, check_name};
pub use value::{Arguments, Value};
pub use vision::Sensors;

pub use sincro_dynamics::spatial::{Pose, Vec3};

/// State of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// No run.
    Stopped,
    /// A run advances as soon as its controllers allow it.
    Running,
    /// A run that waits to be started again.
    Paused,
}

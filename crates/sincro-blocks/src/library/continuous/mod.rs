//! Continuous: states that are integrated together with the world.

mod derivative;
mod equations;
mod integrator;
mod linear_system;
mod low_pass;
mod pid;
pub(in crate::library) mod pid_law;
mod rational;
mod state_space;
mod transfer_function;
mod transport_delay;

pub use derivative::Derivative;
pub use equations::Equations;
pub use integrator::Integrator;
pub use linear_system::LinearSystem;
pub use low_pass::LowPass;
pub use pid::Pid;
pub use pid_law::{AntiWindup, PidLaw};
pub use rational::Rational;
pub(in crate::library) use rational::superscripts;
pub use state_space::StateSpace;
pub use transfer_function::TransferFunction;
pub use transport_delay::TransportDelay;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[
    item::<Integrator>(),
    item::<TransferFunction>(),
    item::<StateSpace>(),
    item::<LowPass>(),
    item::<Derivative>(),
    item::<Pid>(),
    item::<TransportDelay>(),
    item::<Equations>(),
];

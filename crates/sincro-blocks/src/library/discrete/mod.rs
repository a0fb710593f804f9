//! Discrete: memory that changes at ticks.

mod command_filter;
mod delay;
mod discrete_derivative;
mod discrete_integrator;
mod discrete_low_pass;
mod discrete_pid;
mod discrete_state_space;
mod discrete_transfer_function;
mod fir_filter;
mod iir_filter;
mod method;
mod rate_transition;
mod unit_delay;
mod zero_order_hold;

pub use command_filter::CommandFilter;
pub use delay::Delay;
pub use discrete_derivative::DiscreteDerivative;
pub use discrete_integrator::DiscreteIntegrator;
pub use discrete_low_pass::DiscreteLowPass;
pub use discrete_pid::DiscretePid;
pub use discrete_state_space::DiscreteStateSpace;
pub use discrete_transfer_function::DiscreteTransferFunction;
pub use fir_filter::FirFilter;
pub use iir_filter::IirFilter;
pub use method::Method;
pub use rate_transition::RateTransition;
pub use unit_delay::UnitDelay;
pub use zero_order_hold::ZeroOrderHold;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[
    item::<UnitDelay>(),
    item::<Delay>(),
    item::<ZeroOrderHold>(),
    item::<RateTransition>(),
    item::<DiscreteIntegrator>(),
    item::<DiscreteDerivative>(),
    item::<DiscreteTransferFunction>(),
    item::<DiscreteStateSpace>(),
    item::<DiscreteLowPass>(),
    item::<CommandFilter>(),
    item::<DiscretePid>(),
    item::<FirFilter>(),
    item::<IirFilter>(),
];

/// `z⁻³` for three samples.
fn power_of_delay(samples: usize) -> String {
    format!("z⁻{}", crate::library::continuous::superscripts(samples))
}

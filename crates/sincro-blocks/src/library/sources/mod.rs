//! Sources: functions of time.

mod chirp;
mod clock;
mod constant;
mod cycle;
mod noise;
mod pulse;
mod ramp;
pub mod random;
mod sawtooth;
mod sine;
mod step;
mod table;

pub use chirp::Chirp;
pub use clock::Clock;
pub use constant::Constant;
pub use noise::{Distribution, Noise};
pub use pulse::Pulse;
pub use ramp::Ramp;
pub use sawtooth::Sawtooth;
pub use sine::Sine;
pub use step::Step;
pub use table::Table;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[
    item::<Constant>(),
    item::<Step>(),
    item::<Ramp>(),
    item::<Sine>(),
    item::<Chirp>(),
    item::<Pulse>(),
    item::<Sawtooth>(),
    item::<Table>(),
    item::<Noise>(),
    item::<Clock>(),
];

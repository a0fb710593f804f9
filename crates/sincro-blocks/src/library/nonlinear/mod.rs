//! Nonlinear: corners, bounds, hystereses, tables.

mod backlash;
mod coulomb_friction;
mod dead_zone;
mod lookup_table;
mod lookup_table_2d;
mod quantizer;
mod rate_limiter;
mod relay;
mod saturation;
mod single_precision;
mod table;

pub use backlash::Backlash;
pub use coulomb_friction::CoulombFriction;
pub use dead_zone::DeadZone;
pub use lookup_table::{Interpolation, LookupTable};
pub use lookup_table_2d::LookupTable2d;
pub use quantizer::Quantizer;
pub use rate_limiter::RateLimiter;
pub use relay::Relay;
pub use saturation::Saturation;
pub use single_precision::SinglePrecision;
pub use table::Extrapolation;

use super::{Item, item};
use crate::reader::Reader;

pub(super) static BLOCKS: &[Item] = &[
    item::<Saturation>(),
    item::<RateLimiter>(),
    item::<DeadZone>(),
    item::<Quantizer>(),
    item::<SinglePrecision>(),
    item::<Backlash>(),
    item::<Relay>(),
    item::<CoulombFriction>(),
    item::<LookupTable>(),
    item::<LookupTable2d>(),
];

/// A fault if a lower limit is above its upper one.
pub(in crate::library) fn check_limits(p: &mut Reader<'_>, lower: &[f64], upper: &[f64]) {
    let at = |list: &[f64], i: usize| list.get(if list.len() == 1 { 0 } else { i }).copied();
    for i in 0..lower.len().max(upper.len()) {
        if let (Some(lower), Some(upper)) = (at(lower, i), at(upper, i))
            && lower > upper
        {
            p.fault("lower", format!("`lower` {lower} is above `upper` {upper}"), "exchange them");
        }
    }
}

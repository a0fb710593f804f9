//! Motion on command: how joints, or any numbers, get from one state of motion to another as fast as limits on
//! velocity, acceleration and jerk let them, alone or together.
//!
//! | file | has |
//! |---|---|
//! | `profile.rs` | [`Profile`]: pieces of constant jerk, what they give at a time |
//! | `ramp.rs` | from one velocity to another; back into the limits |
//! | `fastest.rs` | to a position and velocity in the least time |
//! | `timed.rs` | the same in a given time |
//! | `together.rs` | [`plan`]: several axes, each for itself, at the same time, or on one straight line |
//!
//! Accelerations are zero at the goal. The fastest motion with bounded jerk runs at a bound of the jerk, of the
//! acceleration or of the velocity all the time; so it is known up to one number, which is searched for. Sources: keys
//! `haschke2008` (the search along the velocity in between) and `berscheid2021` (Ruckig: what is asked for,
//! synchronisation, motion back into the limits).
//!
//! Ours deviates in how the number is found: not as a root of polynomials of degree four to six, whose formulas take
//! cube roots and cosines that are not the same on every platform, but by halving intervals of a continuous function.
//! Only + − × ÷ and √ are used: the bits are the same everywhere.

mod fastest;
mod profile;
mod ramp;
mod timed;
mod together;

pub use profile::{Limits, Point, Profile};
pub use together::{Axis, Goal, PlanError, Synchronization, plan};

//! Path planning: ways between states of joints and poses on which a check holds, and the tasks of `simOMPL`.
//!
//! | file | has |
//! |---|---|
//! | `space.rs` | [`Space`]: distance, straight line, bounds and random states of joints and poses put together |
//! | `planner.rs` | [`Planner`]: RRT-Connect, shortcuts, states at even distances along a path |
//! | `goal.rs` | states near enough to a goal that is not given as a state |
//! | `task.rs` | [`Task`]: what a client or script has said of one problem, and its solution |
//! | `call.rs` | [`call`]: the functions of `simOMPL` on a [`Scene`] |
//! | `functions.rs` | [`for_functions`]: names and call tips of these functions |
//! | `calculations.rs`, `calculate.rs` | collision and distance objects of V-REP 3, and [`calculate`]: their functions |
//! | `motions.rs` | [`Motions`]: numbers on their way within limits of velocity, acceleration and jerk |
//! | `names.rs` | numbers of algorithms and kinds of spaces |
//!
//! Source: key `kuffner2000` (two trees that grow towards each other). There is no clock: an effort, counted in checked
//! states, takes the place of a time limit, and random numbers come from a seed, so the bits are the same in every run.

mod calculate;
mod calculations;
mod call;
mod functions;
mod goal;
mod motions;
pub mod names;
mod planner;
mod space;
mod task;

pub use calculate::calculate;
pub use calculations::Calculations;
pub use call::{Scene, call, collision_pairs, ends};
pub use goal::descend;
pub use motions::{Motion, MotionStep, Motions};
pub use planner::{MAX_POINTS, MAX_STATES, Planner};
pub use space::{Kind, MAX_BOUND, MAX_WEIGHT, Part, Space};
pub use task::{Component, Region, Task, Tasks, checks_in};

#![doc = include_str!("../README.md")]
//!
//! | file | content |
//! |---|---|
//! | `cone` | unilateral constraints, friction groups, contact modes |
//! | `solver` | solution of one problem: active set first, then ADMM |
//! | `active_set` | linear system of the current active set |
//! | `dense` | elimination that reveals the rank |
//! | `load_share` | least multipliers of redundant constraints |
//! | `engage` | solution in which all redundant contacts take part |
//! | `held` | solution with held contact modes; laws that it may violate |
//! | `admm` | ADMM for the same problem, without an active set |
//! | `gauss_seidel` | projected Gauss–Seidel for the same problem, where both fail |
//! | `uniqueness` | search for a second solution |
//! | `warm_start` | multipliers and contact modes kept between solutions, by slot; fallback for Zeno behaviour |
//! | `sweeps` | problem of a whole step at velocity level with many contacts; islands and what sleeps |

mod active_set;
mod admm;
mod cone;
mod dense;
mod engage;
mod gauss_seidel;
mod held;
mod load_share;
mod solver;
pub mod sweeps;
#[cfg(test)]
mod tests;
mod uniqueness;
mod warm_start;

pub use active_set::ContactProblem;
pub use cone::{ContactMode, FrictionGroup, NO_SLOT, SlowSliding, UnilateralConstraint};
pub use dense::PROJECTION_RANK;
pub use held::{ConstraintId, HeldLaw, Load, Solution, is_observable};
pub use solver::{HELD_RATE, Solver, SolverReport};
pub use warm_start::{RESERVED_SLOTS, SLOT_LEN, WarmStart, ZenoFallback};

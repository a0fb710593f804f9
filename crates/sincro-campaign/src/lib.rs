//! Campaigns of simulated runs: which runs there are, how they are made on many processors and machines, and what
//! follows from them.
//!
//! | module | holds |
//! |---|---|
//! | [`design`] | counter-based random numbers, Sobol' sequence, distributions |
//! | [`plan`] | plan files: parameters, designs, measures; run `k` as a function of `k` |
//! | [`campaign`] | a plan with its scene; one run of it |
//! | [`engine`] | the runs of a shard on all processors, restartable |
//! | [`store`] | the folder of a campaign: parts, description, collecting |
//! | [`statistics`], [`report`] | intervals, moments, ranks; the page of a campaign |
//! | [`fit`] | identification: parameters from measured data |
//! | [`tune`] | parameters for the least value of a goal within limits |

pub mod campaign;
pub mod design;
pub mod engine;
pub mod fit;
pub mod measure;
pub mod plan;
pub mod report;
pub mod row;
pub mod statistics;
pub mod store;
pub mod tune;

pub use campaign::Campaign;
pub use engine::{Shard, run_shard};
pub use plan::Plan;
pub use store::{Store, collect};

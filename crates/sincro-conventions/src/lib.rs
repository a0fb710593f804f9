//! Conventions of the API of V-REP and CoppeliaSim.
//!
//! | file | has |
//! |---|---|
//! | `poses.rs` | positions, Euler angles, quaternions and matrices as the API has them |
//! | `constants.rs`, `constants.txt` | constants of clients and scripts with their numbers |
//! | `simulator.rs` | parameters of the simulator: numbers, names, answers that are always the same |
//! | `paths.rs` | paths of configurations |
//! | `names.rs` | old names of functions |

pub mod constants;
pub mod names;
pub mod paths;
pub mod poses;
pub mod simulator;

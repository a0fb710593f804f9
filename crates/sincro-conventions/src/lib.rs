//! Conventions of the API of V-REP and CoppeliaSim.
//!
//! | file | has |
//! |---|---|
//! | `poses.rs` | positions, Euler angles, quaternions and matrices as the API has them |
//! | `constants.rs`, `constants.txt` | constants of clients and scripts with their numbers |
//! | `simulator.rs` | parameters of the simulator: numbers, names, answers that are always the same |
//! | `ik_objects.rs` | dummies and joints of environments of `simIK` |
//! | `ik_names.rs` | constants and older names of `simIK` |
//! | `path_shapes.rs` | points of paths between control points |
//! | `paths.rs`, `path_functions.rs` | paths of configurations, and the functions on them |
//! | `names.rs` | old names of functions |
//! | `properties.rs` | properties that are functions under another name |
//! | `absent.rs`, `absent.txt` | functions that are not offered, and why |
//! | `object_paths.rs` | levels of the paths of objects |

pub mod absent;
pub mod constants;
pub mod ik_names;
pub mod ik_objects;
pub mod names;
pub mod object_paths;
pub mod path_functions;
pub mod path_shapes;
pub mod paths;
pub mod poses;
pub mod properties;
pub mod simulator;

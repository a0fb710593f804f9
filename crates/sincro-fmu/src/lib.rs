//! Functional mock-up units: scenes of sincro exported as FMUs of FMI 2.0 and 3.0.
//!
//! [`export()`] packs a loaded scene: the model description, the shared library of the crate `sincro-fmi`, the scene's
//! files as resources. An [`Instance`] is such an FMU at work; the shared library is a thin layer of C functions over
//! it. Both make their list of [`variables`] from the scene in the same way.
//!
//! | modules | hold |
//! |---|---|
//! | [`variables`], [`tunable`] | variables of a scene: parameters, inputs, outputs |
//! | [`description`], [`platform`], [`archive`] | the model description, platforms of libraries, zip files |
//! | [`export`](mod@export) | a scene as an FMU |
//! | [`instance`] | an FMU at work, and its saved states |
//! | [`import`] | FMUs of other tools, loaded for co-simulation |
//! | [`switching`] | scenes that model exchange cannot follow |

pub mod archive;
mod continuous;
pub mod description;
pub mod export;
pub mod import;
pub mod instance;
mod manifest;
mod names;
mod numbers;
pub mod platform;
pub mod switching;
pub mod tunable;
mod units;
pub mod variables;

pub use description::{FmiVersion, Kinds};
pub use export::{ExportRequest, Exported, export};
pub use instance::Instance;
pub use variables::{Catalogue, Outputs};

//! Scene, experiment and diagram files: read, checked against their schemas, and compiled.
//!
//! [`open::open`] opens a scene folder and reports every problem in it at once; [`scene::from_text`] compiles the text
//! of a scene file alone. Nothing here advances a world: that is `sincro-sim`.
//!
//! | modules | hold |
//! |---|---|
//! | [`diagnostic`], [`document`], [`folder`], [`tree`], [`series`], [`suggest`] | findings with their place, parsed TOML with its spans, files of a folder, paths of objects, columns of CSV files, near names |
//! | [`schema`] | JSON Schemas from the types, and the checker that walks a file against them |
//! | [`overrides`], [`apply_overrides`] | settings (`--set`, variants), and where they are written |
//! | [`script`], [`sensor`], [`scenery`], [`camera`] | parts of a scene: scripts, sensors, visible pieces, rendered pictures |
//! | [`scene`], [`record`], [`experiment`], [`diagram`] | the three files, and the catalogue of signals between them |
//! | [`open`] | a folder with all of them |

pub mod apply_overrides;
pub mod camera;
pub mod diagnostic;
pub mod diagram;
pub mod document;
pub mod experiment;
pub mod folder;
pub mod open;
pub mod overrides;
pub mod record;
pub mod scene;
pub mod scenery;
pub mod schema;
pub mod script;
pub mod sensor;
pub mod series;
pub mod suggest;
pub mod tree;

//! Scene, experiment and diagram files: read, checked against their schemas, and compiled.
//!
//! [`open::open`] opens a scene folder and reports every problem in it at once; [`scene::from_text`] compiles the text
//! of a scene file alone. Nothing here advances a world: that is `sincro-sim`.
//!
//! ```
//! use sincro_scene::prelude::*;
//!
//! let pendulum = r#"
//!     [[joint]]
//!     name = "hinge"
//!     kind = "revolute"
//!     axis = [0.0, 1.0, 0.0]
//!     initial = { position = 0.5 }
//!
//!     [[body]]
//!     name = "rod"
//!     parent = "/hinge"
//!     position = [0.0, 0.0, -0.25]
//!     density = 1000.0
//!     shape = [{ cylinder = { radius = 0.05, length = 0.5 } }]
//! "#;
//! let scene = from_text(pendulum)?;
//! assert_eq!(scene.initial.q, [0.5]);
//! let ObjectKind::Body { mass } = scene.object("/hinge/rod").unwrap().kind else { panic!("a rod is a body") };
//! assert!((mass.mass - 1000.0 * 0.05 * 0.05 * std::f64::consts::PI * 0.5).abs() < 1e-12); // [kg]
//!
//! // the signals that a run of it can record, with their units
//! let signals = catalogue(&scene.model);
//! assert!(signals.iter().any(|signal| signal.name == "/hinge.velocity" && signal.unit == "rad/s"));
//!
//! // everything that is wrong is reported at once, with its place and advice
//! let wrong = from_text(&pendulum.replace("axis", "axes").replace("density = 1000.0", "density = -1.0")).unwrap_err();
//! assert!(wrong.to_string().contains("scene.toml:5:5: error: unknown key `axes`"), "{wrong}");
//! assert!(wrong.to_string().contains("did you mean `axis`?"));
//! # Ok::<(), Diagnostics>(())
//! ```
//!
//! | modules | hold |
//! |---|---|
//! | [`diagnostic`], [`document`], [`folder`], [`tree`], [`suggest`] | findings with their place, parsed TOML with its spans, files of a folder, paths of objects, near names |
//! | [`schema`] | JSON Schemas from the types, and the checker that walks a file against them |
//! | [`overrides`], [`apply_overrides`] | settings (`--set`, variants), and where they are written |
//! | [`script`], [`fmu`], [`sensor`], [`scenery`], [`camera`] | parts of a scene: scripts, FMUs, sensors, visible pieces; rendered pictures: the crate `sincro-camera` |
//! | [`scene`], [`record`], [`experiment`], [`diagram`] | the three files, and the catalogue of signals between them |
//! | [`open`], [`numbers`] | a folder with all of them; every number in it that a setting reaches |
//! | [`draft`] | a compiled scene that is edited object by object, and compiled again |
//! | [`inverse_kinematics`] | coordinates at which frames have given poses |
//! | [`keys`] | keys that tables of a scene file have for shapes and masses |
//! | [`parallel`] | independent work on several threads |

pub mod apply_overrides;
pub mod diagnostic;
pub mod diagram;
pub mod document;
pub mod draft;
mod expand;
pub mod experiment;
pub mod fmu;
pub mod folder;
mod instance_settings;
pub mod inverse_kinematics;
pub mod keys;
mod names;
pub mod normalize;
pub mod numbers;
pub mod open;
pub mod overrides;
pub mod parallel;
pub mod prelude;
pub mod record;
pub mod scene;
pub mod scenery;
pub mod schema;
pub mod script;
pub mod sensor;
pub(crate) mod series;
pub mod suggest;
pub mod tree;
mod unused;
mod vocabulary;
mod words;

pub use sincro_camera as camera;

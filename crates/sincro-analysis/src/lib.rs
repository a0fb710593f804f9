//! Linear analysis of simulated systems.
//!
//! A scene is linearised about its state at t = 0, and its poles are read off:
//!
//! ```
//! use sincro_analysis::prelude::*;
//! use sincro_sim::{Extensions, load};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = std::env::temp_dir().join(format!("sincro-analysis-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! std::fs::write(folder.join("scene.toml"), r#"
//!     [[joint]]
//!     name = "hinge"
//!     kind = "revolute"
//!     axis = [0.0, 1.0, 0.0]
//!     motor = { mode = "torque" }
//!
//!     [[body]]
//!     name = "bob"
//!     parent = "/hinge"
//!     mass = 2.0
//!     center_of_mass = [0.0, 0.0, -1.0]
//!     inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
//! "#)?;
//! std::fs::write(folder.join("experiment.toml"), r#"
//!     title = "Pendulum"
//!     duration = 2.0
//!     step = 0.01
//!     record = ["/hinge.position", "energy.balance"]
//! "#)?;
//! let loaded = load(&folder, &[], Extensions::default())?;
//! let at_rest = operating_point(&loaded, 0.0).map_err(|diagnostic| diagnostic.to_string())?;
//! let found = linearize(&loaded, &at_rest, &Request::default())?;
//! assert_eq!(found.drift(), 0.0); // it hangs: an equilibrium
//!
//! // q'' = −(m g l/J) q + τ/J, J = 0.01 kg·m² + m l²: two poles at ±i √(m g l/J)
//! let (mgl, inertia) = (2.0 * 9.81 * 1.0, 0.01 + 2.0);
//! let system = &found.system;
//! assert!((system.a[(1, 0)] + mgl / inertia).abs() < 1e-12 && (system.b[(1, 0)] - 1.0 / inertia).abs() < 1e-12);
//! let pole = system.poles()[0];
//! assert!(pole.damping_ratio.abs() < 1e-9);
//! assert!((pole.natural_frequency - f64::sqrt(mgl / inertia)).abs() < 1e-9); // [rad/s]
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok(())
//! # }
//! ```
//!
//! | modules | hold |
//! |---|---|
//! | [`linearize`](mod@linearize) | linearisation and trim of a scene at an operating point, by dual numbers |
//! | [`dynamics`] | terms of the equations of motion at given states |
//! | [`linear`] | linear systems: poles, zeros, frequency and step response, Lyapunov equations, LQR |

pub mod dynamics;
pub mod linear;
pub mod linearize;
pub mod prelude;

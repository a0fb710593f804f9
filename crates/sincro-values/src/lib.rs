//! Data that clients and scripts exchange by the API of V-REP and CoppeliaSim.
//!
//! | file | has |
//! |---|---|
//! | `handle.rs`, `value.rs`, `error.rs` | [`Handle`], [`Value`] and [`Arguments`], [`ApiError`]: what functions take and give |
//! | `cbor.rs`, `unpack.rs` | values as bytes and back |
//! | `bits.rs` | bits of whole numbers |
//! | `buffers.rs` | functions that pack numbers and tables as bytes |
//! | `coercion.rs` | numbers as text and texts as numbers, by the parameters of call tips |
//! | `numbers.rs` | types of numbers in buffers |
//! | `graphs.rs` | streams of graphs |
//! | `fields.rs` | maps that functions take and give back |
//! | `stored.rs` | data under tags |
//! | `signals.rs`, `tubes.rs`, `radio.rs` | signals; bytes between the ends of a tube; wireless packets |
//! | `mesh_files.rs` | meshes as OBJ, STL and PLY files |
//! | `topics.rs` | topics with publishers and subscribers |
//! | `clouds.rs` | contents of octrees and point clouds |
//! | `widgets.rs`, `widget_tips.rs` | interfaces without windows: what is set is kept |
//! | `work.rs` | limit of the work of one call |
//! | `ports.rs` | TCP ports that scripts ask for |

pub mod bits;
pub mod buffers;
pub mod cbor;
pub mod clouds;
pub mod coercion;
mod error;
pub mod fields;
pub mod graphs;
mod handle;
pub mod mesh_files;
pub mod numbers;
mod ports;
pub mod radio;
mod signals;
pub mod stored;
pub mod topics;
pub mod tubes;
pub mod unpack;
mod value;
mod widget_tips;
pub mod widgets;
pub mod work;

pub use error::ApiError;
pub use handle::Handle;
pub use ports::{LegacyPorts, PortRequest};
pub use signals::Signals;
pub use value::{Arguments, Value};

/// Largest length and coordinate of anything that is made at run time `[m]`.
pub const MAX_LENGTH: f64 = 1e6;

//! The scene that most tests serve: an arm of two links in a vertical plane, a free ball, a camera.

use sincro_remote::Options;
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, ServedSession, scenes};

pub use sincro_testing::{finished, options};

/// A session of the arm.
pub fn session() -> OpenSession {
    scenes::two_link_arm("").session(Extensions::default(), None)
}

/// Serves the arm.
pub fn serve() -> ServedSession {
    serve_with(&options())
}

/// Serves the arm with options.
pub fn serve_with(options: &Options) -> ServedSession {
    session().serve(options)
}

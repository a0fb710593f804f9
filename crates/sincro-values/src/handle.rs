//! Handles of objects.

/// Number by which clients and scripts name an object: 1 for the first object of the scene, then in the order of the
/// file; runtime objects follow. Negative numbers have meanings of their own (−1 `sim.handle_world`, −2
/// `sim.handle_all` …).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Handle(pub i32);

#![doc = include_str!("../README.md")]
//! # From surfaces to contact candidates
//!
//! A shape takes part in contact if it has a [`Material`]. Two such shapes form a pair unless they are fixed to one
//! another, joined directly by a joint, or in the same group. A pair has a fixed number of slots, the most contact
//! points it may have; a point is known by its slot, and states hold the loaded ones.
//!
//! Broad phase: bounding spheres of the pair against a margin (`broad_phase`). Narrow phase, by kind of pair: closed
//! forms for points and spheres against planes and cuboids (`detect`), for bodies with rims on planes and faces of
//! cuboids (`discs`), separating axes and face clipping for convex polytopes ([`sincro_geometry::sat`]), contact
//! manifolds of the collision library for the rest (`manifold`). A contact candidate is a rounded point, an edge or a
//! rim of one body against a plane, line, point or circle of the other ([`candidate`]): signed distance, normal and
//! contact point with the rates at which they change as both bodies move.
//!
//! The contact law of a pair combines two materials: the geometric mean of the friction coefficients (nothing sticks to
//! a frictionless surface), the larger restitution, the larger lengths of rolling and spinning friction, the sum of the
//! compliances. A [`PairLaw`] of the two bodies replaces any of these.

mod body_id;
mod broad_phase;
pub mod candidate;
pub mod candidate_list;
mod collider;
mod detect;
mod discs;
mod manifold;
mod material;
mod pair;

pub use body_id::BodyId;
pub use broad_phase::Margin;
pub use collider::{Collider, WORLD};
pub use detect::Detector;
pub use material::{Material, PairLaw};
pub use pair::{Pair, pair_of_slot, pairs};
pub use sincro_geometry::Surface;

use pair::PairKind;

//! Pairs without a closed form of their own: manifolds of the collision library.

use super::feature::Spot;
use super::{Collider, Pair};
use crate::spatial::Pose;

/// The library's shapes and manifolds.
#[derive(Clone, Debug)]
pub(crate) struct Manifolds;

impl Manifolds {
    pub fn new(_: &[Collider], _: &[Pair]) -> Self {
        Self
    }

    /// The spots of pair `k`.
    pub fn find(
        &mut self,
        _k: usize,
        _: (&Collider, &Collider),
        _: (&Pose<f64>, &Pose<f64>),
        _margin: f64,
        _slots: &mut [Option<Spot>],
    ) {
    }
}

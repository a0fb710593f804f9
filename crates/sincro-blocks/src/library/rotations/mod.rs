//! Rotations: Euler angles, quaternions (w, x, y, z), matrices.

use super::Item;

pub(super) const SHELF: &[Item] = &[];

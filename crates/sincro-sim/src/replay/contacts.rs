//! Points of contact, frame by frame: as many as there are in each.
//!
//! | number | what | unit |
//! |---|---|---|
//! | 0, 1 | indices of the two surfaces among the model's | 1 |
//! | 2–4 | where, world axes | m |
//! | 5–7 | force on the first surface, world axes | N |

use sincro_dynamics::world::Observation;

use super::frame_map::FrameMap;

/// Number of entries per contact point in [`Contacts::frame`]: indices of the two surfaces, position x, y, z in the
/// world `[m]`, force x, y, z on the first surface in world axes `[N]`.
pub const CONTACT: usize = 8;

/// Contact points of the frames of a trajectory, any number in each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contacts {
    /// For each frame: how many points there are up to and with it.
    ends: Vec<usize>,
    numbers: Vec<f32>,
}

impl Contacts {
    /// Appends a frame with the contact points of the observed world, as many as there are; `map` gives the surfaces at
    /// the start of a run whose structure has changed.
    pub fn record(&mut self, seen: &Observation<'_>, map: Option<&FrameMap>) {
        for point in seen.contacts() {
            // indices below 2²⁴ are exact in single precision; a model has far fewer surfaces
            let surfaces = point.surfaces.map(|k| map.map_or(k, |map| map.surfaces[k]));
            self.numbers.extend(surfaces.map(|k| k as f32));
            self.numbers.extend(point.point.0.iter().chain(&point.force.0).map(|x| *x as f32));
        }
        self.ends.push(self.numbers.len() / CONTACT);
    }

    /// Appends all frames of `other` behind those of this list, in their order.
    pub fn append(&mut self, other: &Self) {
        let before = self.numbers.len() / CONTACT;
        self.ends.extend(other.ends.iter().map(|end| before + end));
        self.numbers.extend_from_slice(&other.numbers);
    }

    /// Returns the contact points of frame `k` (from 0), [`CONTACT`] numbers each, one point after the other.
    ///
    /// # Panics
    ///
    /// If there is no such frame.
    #[must_use]
    pub fn frame(&self, k: usize) -> &[f32] {
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.numbers[CONTACT * start..CONTACT * self.ends[k]]
    }

    /// Returns the number of contact points of frame `k` (from 0).
    ///
    /// # Panics
    ///
    /// If there is no such frame.
    #[must_use]
    pub fn count(&self, k: usize) -> usize {
        self.frame(k).len() / CONTACT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_keep_their_points() {
        let one = Contacts { ends: vec![1, 1], numbers: vec![1.0; CONTACT] };
        let mut all = Contacts { ends: vec![0, 2], numbers: vec![2.0; 2 * CONTACT] };
        all.append(&one);
        assert_eq!([0, 1, 2, 3].map(|k| all.count(k)), [0, 2, 1, 0]);
        assert_eq!(all.frame(2), [1.0; CONTACT]);
    }
}

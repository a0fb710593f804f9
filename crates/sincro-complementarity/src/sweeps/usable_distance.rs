//! Distances of a step at velocity level that contacts may use up, and penetrations that it reduces.
//!
//! A distance is used up within the step; a penetration beyond `DEAD_ZONE` is reduced by `CORRECTION` a step. Over
//! the points of a face both is linear in the distance, as the motion of a rigid body is: else four points would
//! contradict each other, and the sweeps would shift load between them without end.

/// Distance from contact within which it counts as closed `[m]`: corrections of rounding would make the distances of a
/// face contradict each other.
const DEAD_ZONE: f64 = 1e-6;

/// Share of a penetration beyond the dead zone that a step removes.
const CORRECTION: f64 = 0.2;

/// Distances that the points of two surfaces may use up within a step, or have to gain: `usable` for the nearest and
/// the farthest of them, and in between linear in the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UsableDistance {
    least: f64,
    of_least: f64,
    slope: f64,
}

impl UsableDistance {
    /// For points at these distances; corrections below `least_correction` `[m]` are not made.
    #[must_use]
    pub fn of(distances: impl Iterator<Item = f64>, least_correction: f64) -> Self {
        let (least, most) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), d| (a.min(d), b.max(d)));
        let (of_least, of_most) = (usable(least, least_correction), usable(most, least_correction));
        let slope = if most > least { (of_most - of_least) / (most - least) } else { 0.0 };
        Self { least, of_least, slope }
    }

    /// Usable distance of the point at `distance` `[m]`.
    #[must_use]
    pub fn at(self, distance: f64) -> f64 {
        self.of_least + self.slope * (distance - self.least)
    }
}

/// Distance that a single point at `distance` may use up within a step `[m]`; below zero it has to separate. One below
/// `least_correction` is zero: bodies at rest would not move for it.
fn usable(distance: f64, least_correction: f64) -> f64 {
    let beyond = distance - distance.clamp(-DEAD_ZONE, DEAD_ZONE);
    let usable = if beyond < 0.0 { CORRECTION * beyond } else { beyond };
    if usable.abs() > least_correction { usable } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_face_use_up_their_distances_as_a_rigid_body_can() {
        let within = 0.5 * DEAD_ZONE;
        for [least, most] in [[-1e-3, 2e-3], [-within, within], [0.0, 1e-3], [1e-3, 2e-3], [-2e-3, -1e-3], [1e-4, 1e-4]]
        {
            // four corners of a face, the last two of them on one diagonal
            let middle = 0.3 * least + 0.7 * most;
            let corners = [least, most, middle, least + most - middle];
            let usable = UsableDistance::of(corners.iter().copied(), 1e-10);
            let of = corners.map(|distance| usable.at(distance));
            // heights over a plane add up alike along both diagonals
            assert!((of[0] + of[1] - of[2] - of[3]).abs() < 1e-15, "{corners:?}: {of:?}");
            for (distance, usable) in [(least, of[0]), (most, of[1])] {
                let wanted = match distance {
                    d if d > DEAD_ZONE => d - DEAD_ZONE,
                    d if d < -DEAD_ZONE => CORRECTION * (d + DEAD_ZONE),
                    _ => 0.0,
                };
                assert!((usable - wanted).abs() < 1e-15, "{distance}: {usable} for {wanted}");
            }
        }
    }
}

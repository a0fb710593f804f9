//! Open limits and surfaces that are passed and left again within a sub-step, whose end shows nothing of it: found from
//! distances and rates at both ends.

use crate::constraint::{CLOSED_DISTANCE, Constraints, Parting};
use crate::contact::Margin;
use crate::contact::candidate_list::SlotCandidate;
use crate::integrate::{dip, distance_dip};
use crate::mechanism::Mechanism;

/// Interval at which a sub-step is looked at where a body may have passed right through another one, relative to its
/// length.
const THROUGH_STEP: f64 = 1.0 / 16.0;

/// Instants of a sub-step to look at, from `first` on, `interval` apart `[s]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Looks {
    /// First instant after the start; infinite for none.
    pub first: f64,
    /// Interval.
    pub interval: f64,
}

impl Looks {
    /// Instants of both.
    pub fn and(self, other: Self) -> Self {
        Self { first: self.first.min(other.first), interval: self.interval.min(other.interval) }
    }
}

impl Mechanism<f64> {
    /// Earliest time within a sub-step of length `h` at which an open limit was passed `[s]`, by coordinates and
    /// velocities `(q, v)` at the start and velocities `v_end` at the end, the state last evaluated; infinite for none.
    pub(crate) fn limit_passage(&self, h: f64, (q, v): (&[f64], &[f64]), v_end: &[f64]) -> f64 {
        let Some(c) = self.constraints.as_deref() else { return f64::INFINITY };
        let limits = self.model.params.constraints.limits.iter().enumerate();
        let open = limits.filter(|(slot, _)| !c.memory.is_closed(*slot) && !c.open_inside.contains(slot));
        let of_limit = open.map(|(_, limit)| {
            let at =
                |q: &[f64], v: &[f64]| (limit.sign * (q[limit.coordinate] - limit.bound), limit.sign * v[limit.dof]);
            dip(h, -CLOSED_DISTANCE, at(q, v), at(&self.q, v_end))
        });
        of_limit.fold(f64::INFINITY, f64::min)
    }

    /// Notes the points of open surfaces that part in the state last evaluated, the end of a sub-step of length `h`
    /// `[s]`, and are so close that they may have touched within it. Returns true if there are any.
    pub(crate) fn find_parting(&mut self, h: f64) -> bool {
        let Some(c) = self.constraints.as_deref_mut() else { return false };
        let set = &*self.model.params.constraints;
        c.parting.clear();
        if set.pairs.is_empty() {
            return false;
        }
        c.detect_moving(set, &self.scratch.poses, Margin { base: 1e-6, time: h });
        let Constraints { later_candidates, memory, open_inside, motions, parting, .. } = c;
        for SlotCandidate { slot, pair, candidate } in later_candidates.iter() {
            let at = candidate.kinematics(&motions.at(&self.scratch));
            let rate = candidate.normal_rate(|link| motions.twist_of(link), &at);
            // a body that came from behind the other one was there by more than an interval
            if !(rate > 0.0 && at.distance - (1.0 - THROUGH_STEP) * h * rate < -CLOSED_DISTANCE) {
                continue;
            }
            let (slot, pair) = (set.limits.len() + *slot as usize, &set.pairs[*pair as usize]);
            if !memory.is_any_closed(set.limits.len() + pair.first, pair.slots) && !open_inside.contains(&slot) {
                parting.push(Parting { candidate: *candidate, end: (at.distance, rate) });
            }
        }
        !parting.is_empty()
    }

    /// Instants at which surfaces that part at the end of a sub-step of length `h` seem to have touched in it, in the
    /// state at its start, last evaluated.
    pub(crate) fn surface_passages(&self, h: f64, mut looks: Looks) -> Looks {
        let Some(c) = self.constraints.as_deref() else { return looks };
        for Parting { candidate, end } in &c.parting {
            let at = candidate.kinematics(&c.motions.at(&self.scratch));
            let start = (at.distance, candidate.normal_rate(|link| c.motions.twist_of(link), &at));
            if !candidate.is_signed() {
                let whole = |(distance, rate)| (distance + candidate.radius, rate);
                let closest = candidate.radius - CLOSED_DISTANCE;
                looks.first = looks.first.min(distance_dip(h, closest, whole(start), whole(*end)));
            } else if start.0 < -CLOSED_DISTANCE {
                // at its end it has left by the other side
                looks = looks.and(Looks { first: THROUGH_STEP * h, interval: THROUGH_STEP * h });
            } else {
                looks.first = looks.first.min(dip(h, -CLOSED_DISTANCE, start, *end));
            }
        }
        looks
    }
}

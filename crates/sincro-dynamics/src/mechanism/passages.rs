//! Open limits and surfaces that are passed and left again within a sub-step, whose end shows nothing of it: found by
//! the cubic through distances and rates at both ends.

use crate::constraint::{CLOSED_DISTANCE, Constraints, Parting};
use crate::contact::Margin;
use crate::contact::candidate_list::SlotCandidate;
use crate::mechanism::Mechanism;
use crate::mechanism::constraints::normal_rate;
use crate::mechanism::hermite::Hermite;

/// Share of the time that two points that part may have needed for their distance, at their rate: half of it, where the
/// acceleration is constant, and what it may change by.
const TURNED_WITHIN: f64 = 0.75;

/// Time of the first instant, within a sub-step of length `h` `[s]`, at which a distance is below what counts as
/// closed, by its value and rate at the start and at the end; infinite for none.
fn passage(h: f64, (distance, rate): (f64, f64), (distance_end, rate_end): (f64, f64)) -> f64 {
    if !(rate < 0.0 && rate_end > 0.0) {
        return f64::INFINITY;
    }
    let cubic = Hermite::new((distance, h * rate), (distance_end, h * rate_end));
    let passed = cubic.extrema().into_iter().filter(|s| cubic.value(*s) < -CLOSED_DISTANCE);
    passed.map(|s| s * h).fold(f64::INFINITY, f64::min)
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
            passage(h, at(q, v), at(&self.q, v_end))
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
        c.detect_moving(set, &self.scratch.poses, Margin { base: 1e-6, time: TURNED_WITHIN * h });
        let Constraints { later_candidates, memory, open_inside, motions, parting, .. } = c;
        for SlotCandidate { slot, pair, candidate } in later_candidates.iter() {
            let at = candidate.kinematics(&motions.at(&self.scratch));
            let rate = normal_rate(motions, candidate, &at);
            if !(rate > 0.0 && at.distance - TURNED_WITHIN * h * rate < -CLOSED_DISTANCE) {
                continue;
            }
            let (slot, pair) = (set.limits.len() + *slot as usize, &set.pairs[*pair as usize]);
            if !memory.is_any_closed(set.limits.len() + pair.first, pair.slots) && !open_inside.contains(&slot) {
                parting.push(Parting { candidate: *candidate, end: (at.distance, rate) });
            }
        }
        !parting.is_empty()
    }

    /// Earliest time within a sub-step of length `h` at which surfaces that part at its end had touched `[s]`, in the
    /// state at its start, last evaluated; infinite for none.
    pub(crate) fn surface_passage(&mut self, h: f64) -> f64 {
        let Some(c) = self.constraints.as_deref() else { return f64::INFINITY };
        let of_point = c.parting.iter().map(|Parting { candidate, end }| {
            let at = candidate.kinematics(&c.motions.at(&self.scratch));
            passage(h, (at.distance, normal_rate(&c.motions, candidate, &at)), *end)
        });
        of_point.fold(f64::INFINITY, f64::min)
    }
}

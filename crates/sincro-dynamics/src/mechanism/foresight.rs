//! Foresight of steps at velocity level: what a step would pass because of a blow within it.
//!
//! Such a step closes the contacts and limits that are approached at its start. A blow within it accelerates bodies
//! that were at rest, or turns them, and they would pass what lies in their new way: up to 25 mm at 5 m/s and 5 ms. A
//! step is therefore tried first; what it passes counts as closed in the next try.

use sincro_math::Real;

use crate::constraint::{ConstraintSet, Constraints};
use crate::contact::candidate_list::SlotCandidate;
use crate::joint::WORLD;
use crate::mechanism::Mechanism;
use crate::mechanism::constraints::ActivationRule;
use crate::spatial::Pose;

/// Distance beyond which a step passes an open limit or contact, with what gravity adds within it `[m]` or `[rad]`.
const PASSED: f64 = 1e-6;

/// Distance below which a step of length `h` `[s]` has passed an open limit or contact, under the strongest `gravity`
/// [m/s²].
#[inline(always)]
pub(crate) fn passed<R: Real>(h: f64, gravity: R) -> R {
    R::splat(-PASSED) - R::splat(h * h) * gravity
}

impl Mechanism<f64> {
    /// Forgets what a former step would have passed.
    pub(crate) fn forget_foreseen(&mut self) {
        if let Some(c) = &mut self.constraints {
            c.foresight.clear();
        }
    }

    /// Looks for limits and contacts that were open in the step of length `h` last tried and are passed at the
    /// velocities `v` of its end: they count as closed in the detections at velocity level that follow. Returns true if
    /// there are any that were not known.
    pub(crate) fn foresee(&mut self, v: &[f64], h: f64) -> bool {
        let Some(c) = self.constraints.as_deref_mut() else { return false };
        let (model, poses) = (&self.model, &self.scratch.poses);
        let set = &*model.params.constraints;
        let gravity = model.strongest_gravity(poses);
        let passed = passed(h, gravity);
        let rule = ActivationRule::Within(h);
        let mut slots = core::mem::take(&mut c.foresight.slots);
        let known = slots.len();
        for (slot, limit) in set.limits.iter().enumerate() {
            let end = limit.sign * (self.base[limit.coordinate] - limit.bound);
            if end < passed && limit.sign * v[limit.dof] < 0.0 && !c.memory.is_closed(slot) {
                slots.push(slot);
            }
        }
        c.motions.place_velocities(model, v);
        let is_struck = c.note_struck(set, poses, h, rule.margin(gravity).base);
        c.later_candidates.clear();
        if is_struck {
            c.detect_struck(set, poses, rule.margin(gravity));
        }
        let is_detected_anew = |link: u32| is_struck && c.foresight.twist_of(link).is_some();
        let is_known = |SlotCandidate { candidate, .. }: &SlotCandidate| {
            !is_detected_anew(candidate.a) && !is_detected_anew(candidate.b)
        };
        debug_assert_eq!(c.candidates.iter().count(), c.kinematics.len(), "each candidate has been classified");
        let known_candidates = c.candidates.iter().zip(&c.kinematics).filter(|(found, _)| is_known(found));
        let known_candidates = known_candidates.map(|(found, at)| (found, Some(at)));
        let later_candidates = c.later_candidates.iter().map(|found| (found, None));
        for (&SlotCandidate { slot, pair, ref candidate }, at) in known_candidates.chain(later_candidates) {
            let slot = set.limits.len() + slot as usize;
            if set.pairs[pair as usize].material.stiffness.is_finite() || slots[..known].contains(&slot) {
                continue;
            }
            let at = at.copied().unwrap_or_else(|| candidate.kinematics(&c.motions.at(&self.scratch)));
            let end_rate = candidate.normal_rate(|link| c.motions.placed_twist_of(link), &at);
            if at.distance + h * end_rate < passed
                && !rule.closes(
                    (at.distance, candidate.normal_rate(|link| c.motions.twist_of(link), &at)),
                    gravity,
                    c.zero_speed,
                )
            {
                slots.push(slot);
            }
        }
        let is_new = slots.len() > known;
        slots.sort_unstable();
        c.foresight.slots = slots;
        is_new
    }
}

impl Constraints<f64> {
    /// Notes the links that a step of length `h`, whose end velocities are placed, accelerates beyond the `base` of the
    /// margin `[m]` of the last detection; returns true if there are any.
    fn note_struck(&mut self, set: &ConstraintSet, poses: &[Pose<f64>], h: f64, base: f64) -> bool {
        let mut is_struck = false;
        for (k, collider) in set.colliders.iter().enumerate().filter(|(_, collider)| collider.link != WORLD) {
            let link = collider.link;
            let end = self.motions.placed_twist_of(link);
            let detected = self.foresight.twist_of(link).unwrap_or_else(|| self.motions.twist_of(link));
            let (lin, ang) = (end.lin - detected.lin, end.ang - detected.ang);
            let (center, radius) = self.detector.ball(k, collider, poses);
            // each of two surfaces may use up half of the margin
            if h * ((lin + ang.cross(center)).norm() + ang.norm() * radius) > 0.5 * base {
                self.foresight.strike(link, end);
                is_struck = true;
            }
        }
        is_struck
    }
}

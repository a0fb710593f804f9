//! Operations of a constrained mechanism between integration steps: contact detection, impacts, projection, zero
//! crossings of contacts.

use sincro_complementarity::WarmStart;
use sincro_complementarity::sweeps::GivenForces;
use sincro_math::Real;

use crate::constraint::foresight::Foresight;
use crate::constraint::row::Motions;
use crate::constraint::{
    CLOSED_DISTANCE, ConstraintSet, Constraints, DIRECT_ROWS, HeldLaw, LEAST_ZERO_SPEED, LOCATED_DISTANCE,
    MAX_ZERO_SPEED, ModeRule, SETTLING_SPEED, pair_of,
};
use crate::contact::candidate_list::{CandidateList, SlotCandidate};
use crate::contact::{Collider, Detector, Margin, Pair};
use crate::energy::energy_at;
use crate::integrate::{Sample, System};
use crate::mechanism::{Mechanism, PROJECTION_TOLERANCE};
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::{Pose, Vec3};

/// Projection tolerance of positions and rates `[m]`, [m/s], of a mechanism of 1 m or more.
const PROJECTED: f64 = PROJECTION_TOLERANCE;

/// Projection tolerance after steps at velocity level, which are of first order.
const PROJECTED_ROUGHLY: f64 = 1e-10;

/// Iteration limit of a projection of positions.
const MAX_PROJECTIONS: usize = 12;

/// Excess over a law, relative to the largest force or rate, up to which a contact may be at the change of its mode.
const GRAZING: f64 = 1e-4;

/// Zero crossing of a contact or limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactEvent {
    /// The held modes violate a law.
    Law(HeldLaw),
    /// Sliding of a group (slot and group) reverses.
    Reversal(usize, usize),
    /// A compliant contact opens: index of the constraint.
    Opening(usize),
    /// An open contact of fixed points, or an open limit, closes: slot.
    Closing(usize),
    /// Features of two bodies that did not touch at the start of the sub-step do: pair.
    Meeting(usize),
}

/// Result of contact detection at the start of a sub-step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ContactStatus {
    /// True if a closed rigid contact or limit approaches faster than rest: an impact is due.
    pub has_impact: bool,
}

/// Result of a projection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Projected {
    /// Size of the change of potential energy by a projection that removes the distances at which contacts and limits
    /// have closed `[J]`.
    pub closing_work: f64,
    /// Size of the work of the impulses that removed the rates of closed constraints `[J]`.
    pub rate_work: f64,
    /// True if velocities were changed; the scratch then has the impulses of locked drives as reactions.
    pub has_impulses: bool,
}

/// Rows that a projection keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ProjectedRows {
    /// All closed ones; the rates of sticking contacts too.
    Sticking,
    /// Bilateral rows and penetrating contacts.
    Penetrating,
    /// Bilateral rows.
    Bilateral,
}

/// Rule by which a contact or limit counts as closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ActivationRule {
    /// Closed and not separating.
    Touching,
    /// Closed, for an impact.
    All,
    /// Closed now or possibly within a step `[s]` at velocity level.
    Within(f64),
}

impl ActivationRule {
    /// Returns true if a contact or limit at `distance` with this `rate` counts as closed, under the strongest
    /// `gravity` [m/s²] and with a speed that counts as none.
    pub(super) fn closes(self, (distance, rate): (f64, f64), gravity: f64, zero_speed: f64) -> bool {
        match self {
            Self::Touching => distance <= CLOSED_DISTANCE && rate <= zero_speed,
            Self::All => distance <= CLOSED_DISTANCE,
            Self::Within(h) => distance <= Self::reach(h, rate, gravity),
        }
    }

    /// Distance up to which a contact or limit with this `rate` may close within a step of `h` `[s]`, under the
    /// strongest `gravity` [m/s²].
    #[inline(always)]
    pub(crate) fn reach<R: Real>(h: f64, rate: R, gravity: R) -> R {
        R::splat(CLOSED_DISTANCE) + R::splat(2.0 * h) * (-rate).max(R::zero()) + R::splat(4.0 * h * h) * gravity
    }

    /// Margin within which candidates of a step of length `h` `[s]` are looked for: a distance `[m]`, and a time `[s]`
    /// over which velocities add to it.
    #[inline(always)]
    pub(crate) fn margin_of_step<R: Real>(h: f64, gravity: R) -> [R; 2] {
        [R::splat(1e-3) + R::splat(4.0 * h * h) * gravity, R::splat(4.0 * h)]
    }

    /// Margin within which candidates are looked for.
    pub(super) fn margin(self, gravity: f64) -> Margin {
        match self {
            Self::Within(h) => {
                let [base, time] = Self::margin_of_step(h, gravity);
                Margin { base, time }
            }
            _ => Margin::of(1e-6),
        }
    }
}

impl Mechanism<f64> {
    /// Detects contacts at the chart's origin for velocities `v`, and classifies every slot.
    pub(crate) fn detect_contacts(&mut self, v: &[f64], closing: ActivationRule) -> ContactStatus {
        self.detect_awake_contacts(v, closing, false)
    }

    /// Detects contacts as [`Mechanism::detect_contacts`] does; islands at rest may be left out.
    pub(crate) fn detect_awake_contacts(
        &mut self,
        v: &[f64],
        closing: ActivationRule,
        may_leave_out: bool,
    ) -> ContactStatus {
        let Some(c) = self.constraints.as_deref_mut() else { return ContactStatus::default() };
        let (model, scratch) = (&self.model, &mut self.scratch);
        kinematics::poses(model, &self.base, scratch);
        c.motions.place(model, scratch, v);
        let set = &*model.params.constraints;
        let gravity = model.strongest_gravity(&scratch.poses);
        let margin = closing.margin(gravity);
        let fall = if let ActivationRule::Within(h) = closing { h * gravity } else { 0.0 };
        c.rest.begin(&self.base, fall);
        if c.rest.is_stale() {
            let of_loops = set.loop_joints.iter().flat_map(|joint| [joint.a.link, joint.b.link]);
            let of_gears = set.gears.iter().flat_map(|gear| gear.dofs);
            let of_limits = set.limits.iter().map(|limit| limit.dof);
            c.rest.allow(of_loops, model.params.drives.iter().map(|drive| drive.dof).chain(of_gears).chain(of_limits));
        }
        if let (true, ActivationRule::Within(h)) = (may_leave_out && c.memory.rests(), closing) {
            c.rest.leave_out(v, h);
        }
        loop {
            c.detect(set, &scratch.poses, margin);
            let touch = c.classify(set, scratch, (&self.base, v), closing, gravity);
            if !c.wake_touched(set) {
                return touch;
            }
            c.memory.undo_classification();
        }
    }

    /// Wakes what is at rest: the model may have changed.
    pub(crate) fn wake(&mut self) {
        if let Some(c) = &mut self.constraints {
            c.rest.forget();
        }
    }

    /// Says whether bodies may come to rest in the steps at velocity level that follow.
    pub(crate) fn allow_rest(&mut self, is_allowed: bool) {
        if let Some(c) = &mut self.constraints {
            c.rest.is_allowed = is_allowed;
        }
    }

    /// Returns true if everything that the last problem solved by sweeps looked at is at rest.
    pub(crate) fn is_all_at_rest(&self) -> bool {
        self.constraints.as_ref().is_some_and(|c| c.rest.is_all_at_rest)
    }

    /// Returns true if something left out of the last step has been accelerated.
    pub(crate) fn has_woken(&self) -> bool {
        self.constraints.as_ref().is_some_and(|c| c.rest.has_woken)
    }

    /// Ends the motion of what has come to rest in the last step, which was solved by sweeps and began at the
    /// coordinates `before` (n_q); `v` are the velocities (n_v).
    pub(crate) fn stop_quiet_motion(&mut self, before: &[f64], v: &mut [f64]) {
        if let Some(c) = &self.constraints {
            c.rest.stop(before, &mut self.base, v);
        }
    }

    /// Returns true if islands are left out of the step for which contacts were last detected.
    pub(crate) fn leaves_islands_out(&self) -> bool {
        self.constraints.as_ref().is_some_and(|c| c.rest.leaves_any_out())
    }

    /// Goes back to what was known of contacts before they were last detected.
    pub(crate) fn undo_classification(&mut self) {
        if let Some(c) = &mut self.constraints {
            c.memory.undo_classification();
        }
    }

    /// Returns true if problems at velocity level can be solved by sweeps, which know no forces of lines at the new
    /// state.
    pub(crate) fn can_sweep(&self) -> bool {
        self.constraints.is_some() && !self.model.has_lines()
    }

    /// Returns true if the constraints last classified as closed make a problem that is solved by sweeps.
    pub(crate) fn is_large_contact_problem(&self) -> bool {
        self.can_sweep() && self.constraints.as_ref().is_some_and(|c| c.is_large(&self.model))
    }

    /// Returns true if contacts and limits can be so many that a problem at velocity level is solved by sweeps.
    pub(crate) fn can_have_many_contacts(&self) -> bool {
        self.can_sweep() && self.model.params.constraints.max_rows() > DIRECT_ROWS
    }

    /// Sets whether problems at velocity level are solved by sweeps in the evaluations that follow.
    pub(crate) fn set_sweeps(&mut self, sweeps: bool) {
        let sweeps = sweeps && self.can_sweep();
        self.constraints.iter_mut().for_each(|c| c.sweeps = sweeps);
    }

    /// Sets what the contact forces last found by sweeps are for the problems that follow.
    pub(crate) fn set_given_forces(&mut self, given: GivenForces) {
        self.constraints.iter_mut().for_each(|c| c.given_forces = given);
    }

    /// Sets the treatment of contact modes in the evaluations that follow.
    pub(crate) fn set_mode_rule(&mut self, rule: ModeRule) {
        if let Some(c) = &mut self.constraints {
            c.mode_rule = rule;
        }
    }

    /// Tells the time from the event before to that of the present instant `[s]`; infinite if it is none.
    pub(crate) fn set_time_since_event(&mut self, time: f64) {
        if let Some(c) = &mut self.constraints {
            c.time_since_event = time;
        }
    }

    /// Tells whether the instant of a violation is being located.
    pub(crate) fn set_locating(&mut self, is_locating: bool) {
        if let Some(c) = &mut self.constraints {
            c.is_locating = is_locating;
        }
    }

    /// Zero crossings of contacts and limits that have happened in the state last evaluated, with held modes, one of
    /// each kind: a law that they violate, a reversal of sliding, a compliant contact that has opened, a distance that
    /// has closed.
    pub(crate) fn contact_events(&mut self, v: &[f64]) -> [Option<ContactEvent>; 4] {
        let Some(c) = self.constraints.as_deref() else { return [None; 4] };
        let distance = |k: &usize| c.residual[c.blocks[*k].row];
        let opened = (0..c.blocks.len()).filter(|k| c.blocks[*k].given.is_some() && distance(k) > 0.0);
        let opened = opened.max_by(|j, k| distance(j).total_cmp(&distance(k)));
        [
            c.violation.map(ContactEvent::Law),
            c.memory.reversal().map(|(slot, group)| ContactEvent::Reversal(slot, group)),
            opened.map(ContactEvent::Opening),
            self.find_closing(v),
        ]
    }

    /// Zero crossing in the state last evaluated, at velocities `v`: its value is above zero where it has happened.
    pub(crate) fn contact_event_sample(&mut self, event: ContactEvent, v: &[f64]) -> Sample {
        let Some(c) = self.constraints.as_deref() else { return f64::NAN.into() };
        match event {
            ContactEvent::Law(law) => c.excess(law).into(),
            ContactEvent::Reversal(slot, group) => {
                Sample { value: -c.memory.along_start(slot, group), rate: -c.sliding_rate(slot, group) }
            }
            ContactEvent::Opening(block) => c.blocks.get(block).map_or(f64::NAN, |b| c.residual[b.row]).into(),
            ContactEvent::Closing(slot) => {
                let (distance, rate) = self.gap_of(slot, v);
                Sample { value: -distance, rate: -rate }
            }
            ContactEvent::Meeting(pair) => self.meeting_of(pair),
        }
    }

    /// Value of a zero crossing that is as good as zero, far below the distance or speed that counts as none.
    pub(crate) fn contact_event_resolution(&self, event: ContactEvent) -> f64 {
        let small = match event {
            ContactEvent::Law(_) => 1e-11,
            ContactEvent::Reversal(..) => 1e-3 * self.constraints.as_ref().map_or(LEAST_ZERO_SPEED, |c| c.zero_speed),
            ContactEvent::Opening(_) | ContactEvent::Closing(_) | ContactEvent::Meeting(_) => LOCATED_DISTANCE,
        };
        small * self.projection_scale
    }

    /// Open contact or limit that has closed in the state last evaluated and approaches, or was outside at the start of
    /// the sub-step and is beyond what counts as closed, whatever its rate is by now; the deepest one.
    fn find_closing(&mut self, v: &[f64]) -> Option<ContactEvent> {
        let c = self.constraints.as_deref_mut()?;
        let set = &*self.model.params.constraints;
        c.detect_later(set, &self.scratch.poses, Margin::of(1e-6));
        let (zero_speed, open_inside, memory) = (c.zero_speed, &c.open_inside, &c.memory);
        let has_passed = |slot: usize, distance: f64, rate: f64, touched: bool| {
            let is_inside = distance < -CLOSED_DISTANCE;
            if is_inside && !touched && !open_inside.contains(&slot) {
                return true;
            }
            // what did not touch and has come to rest there passed the surface before
            rate < if !memory.is_closed(slot) && is_inside { zero_speed } else { -zero_speed }
        };
        let mut deepest: (Option<ContactEvent>, f64) = (None, 0.0);
        for (slot, limit) in set.limits.iter().enumerate() {
            let distance = limit.sign * (self.q[limit.coordinate] - limit.bound);
            if !memory.was_closed(slot)
                && distance < deepest.1
                && has_passed(slot, distance, limit.sign * v[limit.dof], memory.is_closed(slot))
            {
                deepest = (Some(ContactEvent::Closing(slot)), distance);
            }
        }
        for found in c.later_candidates.iter().filter(|found| !c.was_closed(set, found)) {
            let SlotCandidate { slot, pair: k, candidate } = found;
            let (slot, pair) = (set.limits.len() + *slot as usize, &set.pairs[*k as usize]);
            let at = candidate.kinematics(&c.motions.at(&self.scratch));
            // points of surfaces that touch come and go, with distances that jump
            let touched = memory.is_any_closed(set.limits.len() + pair.first, pair.slots);
            let rate = || candidate.normal_rate(|link| c.motions.twist_of(link), &at);
            if at.distance < deepest.1
                && (pair.material.stiffness.is_finite() || has_passed(slot, at.distance, rate(), touched))
            {
                let (of_slot, of_pair) = (ContactEvent::Closing(slot), ContactEvent::Meeting(*k as usize));
                deepest = (Some(if pair.has_fixed_points() { of_slot } else { of_pair }), at.distance);
            }
        }
        deepest.0
    }

    /// Least distance of the features of a pair that did not touch at the start of the sub-step, in the state last
    /// evaluated, as a zero crossing; NaN if there are none.
    fn meeting_of(&mut self, k: usize) -> Sample {
        let Some(c) = self.constraints.as_deref_mut() else { return f64::NAN.into() };
        let set = &*self.model.params.constraints;
        let (of_all, at) = ((&set.colliders[..], &set.pairs[..]), (k, set.pairs[k].first));
        c.detector.candidate_of_slot(of_all, at, &self.scratch.poses, &mut c.later_candidates);
        let mut least: Option<Sample> = None;
        for found in c.later_candidates.iter().filter(|found| !c.was_closed(set, found)) {
            let at = found.candidate.kinematics(&c.motions.at(&self.scratch));
            if !at.distance.is_nan() && least.is_none_or(|least| -at.distance > least.value) {
                let rate = found.candidate.normal_rate(|link| c.motions.twist_of(link), &at);
                least = Some(Sample { value: -at.distance, rate: -rate });
            }
        }
        least.unwrap_or(f64::NAN.into())
    }

    /// Signed distance of a slot in the state last evaluated `[m]` or `[rad]`, and its rate; NaN if there is no
    /// candidate.
    fn gap_of(&mut self, slot: usize, v: &[f64]) -> (f64, f64) {
        let Some(c) = self.constraints.as_deref_mut() else { return (f64::NAN, f64::NAN) };
        let set = &*self.model.params.constraints;
        if let Some(limit) = set.limits.get(slot) {
            return (limit.sign * (self.q[limit.coordinate] - limit.bound), limit.sign * v[limit.dof]);
        }
        let (of_all, contact) = ((&set.colliders[..], &set.pairs[..]), slot - set.limits.len());
        let (at, found) = ((pair_of(set, contact), contact), &mut c.later_candidates);
        let candidate = c.detector.candidate_of_slot(of_all, at, &self.scratch.poses, found);
        let Some(candidate) = candidate else { return (f64::NAN, f64::NAN) };
        let at = candidate.kinematics(&c.motions.at(&self.scratch));
        (at.distance, candidate.normal_rate(|link| c.motions.twist_of(link), &at))
    }

    /// Applies an impact at the chart's origin: changes `v` and returns the energy lost `[J]`. Prescribed degrees of
    /// freedom are those marked; the scratch has their impulses as reactions.
    pub(crate) fn apply_impact(&mut self, v: &mut [f64]) -> f64 {
        self.detect_contacts(v, ActivationRule::All);
        self.factor();
        let Some(c) = self.constraints.as_deref_mut() else { return 0.0 };
        kinematics::chain_poses(&self.model, &mut self.scratch);
        c.motions.place(&self.model, &self.scratch, v);
        c.assemble(&self.model, &self.base, v, &self.scratch, false);
        if c.rows.is_empty() {
            return 0.0;
        }
        self.scratch.reaction.fill(0.0);
        c.impact(&self.model, v, &mut self.scratch, !self.drives.is_empty())
    }

    /// Projection: removes the drift of positions (`y` begins with the chart's zero displacement) until the residuals
    /// of all closed constraints vanish, then that of rates. The closed constraints are those of the last evaluation.
    pub(crate) fn project(&mut self, y: &mut [f64], rows: ProjectedRows) -> Projected {
        let layout = self.layout();
        let set = &self.model.params.constraints;
        let has_bilateral = !(set.loop_joints.is_empty() && set.gears.is_empty());
        if rows == ProjectedRows::Bilateral && !has_bilateral {
            return Projected::default();
        }
        let sticking = rows == ProjectedRows::Sticking;
        let enough = self.projection_scale * if sticking { PROJECTED } else { PROJECTED_ROUGHLY };
        let (mut last, mut projected) = (f64::INFINITY, Projected::default());
        let mut before_closing = None;
        for k in 0..MAX_PROJECTIONS {
            if !self.prepare(y, k == 0) {
                return projected;
            }
            let c = self.constraints.as_deref_mut().expect("prepared");
            if k == 0 && c.take_closed() {
                before_closing = Some(self.potential_energy(&y[layout.velocities()]));
            }
            let c = self.constraints.as_deref_mut().expect("prepared");
            if rows == ProjectedRows::Bilateral {
                c.keep_loop_joints();
            } else {
                // a sticking contact has no position to keep, only a zero rate
                c.keep_equations(false, !sticking);
            }
            let worst = c.worst(&y[layout.velocities()]).0;
            // close to a singular position there may be a residual that must not be removed
            if worst <= enough || worst > 0.5 * last {
                break;
            }
            last = worst;
            self.factor();
            let mut change = core::mem::take(&mut self.constraint_change);
            let c = self.constraints.as_deref_mut().expect("prepared");
            c.project(&self.model, &mut self.scratch, None, &mut change);
            y[layout.displacement()].copy_from_slice(&change);
            self.constraint_change = change;
            self.rechart(y);
        }
        if let Some(before) = before_closing {
            projected.closing_work = (self.potential_energy(&y[layout.velocities()]) - before).abs();
        }
        if !sticking && !has_bilateral {
            return projected;
        }
        self.prepare(y, false);
        let c = self.constraints.as_deref_mut().expect("prepared");
        if sticking {
            c.keep_equations(true, false);
        } else {
            // at velocity level restitution has set the rates already
            c.keep_loop_joints();
        }
        if c.worst(&y[layout.velocities()]).1 <= PROJECTED * self.projection_scale {
            return projected;
        }
        self.factor();
        let mut change = core::mem::take(&mut self.constraint_change);
        let c = self.constraints.as_deref_mut().expect("prepared");
        c.project(&self.model, &mut self.scratch, Some(&y[layout.velocities()]), &mut change);
        projected.rate_work = c.rate_work();
        for (v, change) in y[layout.velocities()].iter_mut().zip(&change) {
            *v += *change;
        }
        self.constraint_change = change;
        projected.has_impulses = !self.drives.is_empty();
        projected
    }

    /// Potential energy at the chart's origin `[J]`, for velocities `v` of the kinematics that the scratch then has.
    fn potential_energy(&mut self, v: &[f64]) -> f64 {
        energy_at(&self.model, &self.base, v, &mut self.scratch).potential
    }

    /// Assembles the rows at the chart's origin; returns false if there are none.
    fn prepare(&mut self, y: &[f64], first: bool) -> bool {
        let layout = self.layout();
        let Some(c) = self.constraints.as_deref_mut() else { return false };
        let v = &y[layout.velocities()];
        if !first || self.q != self.base {
            kinematics::poses(&self.model, &self.base, &mut self.scratch);
        }
        c.motions.place(&self.model, &self.scratch, v);
        c.assemble(&self.model, &self.base, v, &self.scratch, true);
        !c.rows.is_empty()
    }

    /// Records contact modes and slip directions, as last evaluated.
    pub(crate) fn mark_start(&mut self) {
        if let Some(c) = &mut self.constraints {
            c.memory.mark_start();
        }
    }

    /// Sets the speeds that count as none for the accuracy of the integration.
    pub(crate) fn set_contact_accuracy(&mut self, accuracy: f64) {
        if let Some(c) = &mut self.constraints {
            c.zero_speed = (10.0 * accuracy).clamp(LEAST_ZERO_SPEED, MAX_ZERO_SPEED);
            c.settling_speed = c.zero_speed.max(SETTLING_SPEED).min(10.0 * c.zero_speed);
        }
    }

    /// Working memory of contact modes and multipliers.
    pub(crate) fn contact_memory(&mut self) -> Option<&mut WarmStart<f64>> {
        self.constraints.as_mut().map(|c| &mut c.memory)
    }

    /// Returns true if the held modes violate the laws by no more than what a force or rate that passes zero does.
    pub(crate) fn is_grazing(&self) -> bool {
        let Some(c) = self.constraints.as_deref() else { return true };
        !c.lost_modes && c.violation.is_none_or(|law| c.excess(law) <= GRAZING)
    }

    /// Returns true if the held modes have a solution and violate no law.
    pub(crate) fn keeps_laws(&self) -> bool {
        self.constraints.as_deref().is_none_or(|c| !c.lost_modes && c.violation.is_none())
    }

    /// Returns true if the contact problem last solved has another solution, with other accelerations; `takes` it then.
    pub(crate) fn has_other_solution(&mut self, takes: bool) -> bool {
        self.constraints.as_deref_mut().is_some_and(|c| c.has_other_solution(takes))
    }

    /// Goes back to the contact modes and multipliers at [`Mechanism::mark_start`].
    pub(crate) fn return_to_start(&mut self) {
        if let Some(c) = &mut self.constraints {
            c.memory.return_to_start();
        }
    }
}

impl<R: Real> Mechanism<R> {
    /// Factors the mass matrix at the chart's origin for impulses: forward dynamics at rest without forces, prescribed
    /// degrees of freedom as marked.
    pub(crate) fn factor(&mut self) {
        self.prescribed_acceleration.fill(R::zero());
        let mut change = core::mem::take(&mut self.constraint_change);
        self.impulse_under(!self.drives.is_empty(), &mut change);
        self.constraint_change = change;
    }

    /// Assembles the rows of the loops, and nothing else, at the chart's origin for velocities `v`; the mass matrix is
    /// factored.
    pub(crate) fn place_loops(&mut self, v: &[R]) {
        kinematics::poses(&self.model, &self.base, &mut self.scratch);
        self.factor();
        kinematics::chain_poses(&self.model, &mut self.scratch);
        let c = self.constraints.as_deref_mut().expect("there are loops");
        c.motions.place(&self.model, &self.scratch, v);
        c.assemble_loops(&self.model, &self.base, v, &self.scratch);
        c.keep_loop_joints();
    }
}

impl Constraints<f64> {
    /// Upper bound of the speed of any point of surface `k` [m/s], after the motions were placed.
    pub(crate) fn speed(&self, k: usize, collider: &Collider, poses: &[Pose<f64>]) -> f64 {
        let (at, reach) = self.detector.ball(k, collider, poses);
        let spin = self.motions.twist_of(collider.link).ang.norm();
        // a fixed surface may be unbounded
        let around = if spin > 0.0 { spin * reach } else { 0.0 };
        self.motions.velocity_of(collider.link, at).norm() + around
    }

    /// Classifies every slot of what is not left out, for the coordinates `q` and velocities `v`.
    fn classify(
        &mut self,
        set: &ConstraintSet,
        scratch: &Scratch<f64>,
        (q, v): (&[f64], &[f64]),
        closing: ActivationRule,
        gravity: f64,
    ) -> ContactStatus {
        let mut touch = ContactStatus::default();
        let zero_speed = self.zero_speed;
        self.open_inside.clear();
        let foresight = matches!(closing, ActivationRule::Within(_)).then_some(&self.foresight);
        let closes = |slot: usize, distance: f64, rate: f64| {
            closing.closes((distance, rate), gravity, zero_speed)
                || foresight.is_some_and(|foresight| foresight.closes(slot))
        };
        let rest = &self.rest;
        self.memory.begin_classification(|slot| {
            let contact = slot.checked_sub(set.limits.len());
            contact.is_some_and(|contact| rest.leaves_out(set.links_of(&set.pairs[pair_of(set, contact)])))
        });
        for (slot, limit) in set.limits.iter().enumerate() {
            let distance = limit.sign * (q[limit.coordinate] - limit.bound);
            let rate = limit.sign * v[limit.dof];
            let closed = closes(slot, distance, rate);
            self.memory.classify(slot, closed, [false; 3]);
            self.open_inside.extend((!closed && distance < -CLOSED_DISTANCE).then_some(slot));
            touch.has_impact |= distance <= CLOSED_DISTANCE && rate < -zero_speed;
        }
        let candidates = core::mem::take(&mut self.candidates);
        self.kinematics.clear();
        for of_pair in candidates.by_pair() {
            let (first_slot, pair) = (set.limits.len(), &set.pairs[of_pair[0].pair as usize]);
            let slots = first_slot + pair.first..first_slot + pair.first + pair.slots;
            self.memory.begin_pair(slots, of_pair.iter().map(|found| found.candidate.id));
            for SlotCandidate { slot, candidate, .. } in of_pair {
                let slot = first_slot + *slot as usize;
                let at = candidate.kinematics(&self.motions.at(scratch));
                self.kinematics.push(at);
                let rate = candidate.normal_rate(|link| self.motions.twist_of(link), &at);
                let slides = || candidate.slides(|link| self.motions.twist_of(link), &at, &pair.material, zero_speed);
                if pair.material.stiffness.is_finite() {
                    self.memory.classify(slot, at.distance < 0.0, slides());
                    continue;
                }
                let closed = closes(slot, at.distance, rate);
                self.memory.classify(slot, closed, if closed { slides() } else { [false; 3] });
                self.open_inside.extend((!closed && at.distance < -CLOSED_DISTANCE).then_some(slot));
                touch.has_impact |= at.distance <= CLOSED_DISTANCE && rate < -zero_speed;
            }
        }
        self.memory.end_classification();
        self.candidates = candidates;
        touch
    }

    /// Wakes the islands at rest that others touch; returns true if there are any.
    fn wake_touched(&mut self, set: &ConstraintSet) -> bool {
        let mut woken = false;
        if self.rest.leaves_any_out() {
            for SlotCandidate { slot, candidate, .. } in self.candidates.iter() {
                if self.memory.is_closed(set.limits.len() + *slot as usize) {
                    woken |= self.rest.wake_touched([candidate.a, candidate.b]);
                }
            }
        }
        woken
    }

    /// Detects the contact candidates at the motions last placed, and at those that blows lead to.
    fn detect(&mut self, set: &ConstraintSet, poses: &[Pose<f64>], margin: Margin) {
        let rest = &self.rest;
        let found = &mut self.candidates;
        let motions = (&self.motions, &self.foresight);
        find_candidates(
            &mut self.detector,
            &self.memory,
            motions,
            (set, poses, margin),
            |link| rest.leaves_out([link]),
            found,
        );
    }

    /// Detects those of the links that blows accelerate, as candidates of a later instant.
    pub(super) fn detect_struck(&mut self, set: &ConstraintSet, poses: &[Pose<f64>], margin: Margin) {
        let foresight = &self.foresight;
        let found = &mut self.later_candidates;
        let motions = (&self.motions, foresight);
        let leaves_out = |link: u32| foresight.twist_of(link).is_none();
        find_candidates(&mut self.detector, &self.memory, motions, (set, poses, margin), leaves_out, found);
    }

    /// Detects the contact candidates of a later instant at the motions last placed.
    pub(super) fn detect_moving(&mut self, set: &ConstraintSet, poses: &[Pose<f64>], margin: Margin) {
        core::mem::swap(&mut self.candidates, &mut self.later_candidates);
        self.detect(set, poses, margin);
        core::mem::swap(&mut self.candidates, &mut self.later_candidates);
    }

    /// Returns true if a feature of a pair that was found later touched at the start of the sub-step: of the points of
    /// the same features now, it is the nearest to one that did.
    fn was_closed(&self, set: &ConstraintSet, later: &SlotCandidate) -> bool {
        let of_slot = |slot: u32| self.memory.was_closed(set.limits.len() + slot as usize);
        if set.pairs[later.pair as usize].has_fixed_points() {
            return of_slot(later.slot);
        }
        let closed = self.candidates.of_pair(later.pair).filter(|start| of_slot(start.slot));
        closed.map(|start| &start.candidate).any(|start| {
            let now = self.later_candidates.of_pair(later.pair).filter(|now| now.candidate.has_features_of(start));
            let distance = |now: &&SlotCandidate| (now.candidate.point - start.point).norm();
            now.min_by(|one, two| distance(one).total_cmp(&distance(two))).is_some_and(|now| now.slot == later.slot)
        })
    }

    /// Detects the contact candidates of a later instant.
    pub(super) fn detect_later(&mut self, set: &ConstraintSet, poses: &[Pose<f64>], margin: Margin) {
        let at_rest = |_: &Collider, _| (Vec3::zero(), 0.0);
        let (later, none) = (&mut self.later_candidates, |_: &Collider| false);
        self.detector.detect((&set.colliders, &set.pairs), poses, margin, at_rest, |_| 0, none, later);
    }
}

/// Contact candidates at the motions placed, and at those that blows lead to; pairs of links that are both left out are
/// passed over.
fn find_candidates(
    detector: &mut Detector,
    memory: &WarmStart<f64>,
    (motions, foresight): (&Motions<f64>, &Foresight),
    (set, poses, margin): (&ConstraintSet, &[Pose<f64>], Margin),
    is_left_out: impl Fn(u32) -> bool,
    found: &mut CandidateList,
) {
    let velocity = |c: &Collider, p: Vec3<f64>| {
        let twist = foresight.twist_of(c.link).unwrap_or_else(|| motions.twist_of(c.link));
        (twist.lin + twist.ang.cross(p), twist.ang.norm())
    };
    let first_slot = set.limits.len();
    let former = |pair: &Pair| memory.feature_among(first_slot + pair.first..first_slot + pair.first + pair.slots);
    let leaves_out = |c: &Collider| is_left_out(c.link);
    detector.detect((&set.colliders, &set.pairs), poses, margin, velocity, former, leaves_out, found);
}

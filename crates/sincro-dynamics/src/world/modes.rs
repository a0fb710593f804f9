//! Modes of limited drives and contacts at the start of a sub-step.
//!
//! Where contacts or limits are closed, limited drives at their kink are constraints of the same complementarity
//! problem ([`crate::constraint::kink`]), and one solution decides all modes. Elsewhere the drives are decided among
//! themselves ([`super::switching`]).

use sincro_actuation::Kink;
use sincro_complementarity::WarmStart;
use sincro_complementarity::sweeps::GivenForces;

use super::World;
use super::switching::Law;
use crate::constraint::ModeRule;
use crate::coupled::CoupledSystem;

/// Relative difference of accelerations above which solutions are different motions.
const OTHER_MOTION: f64 = 1e-9;

/// Multiple of the look-ahead that is tried where the problem there is not solved exactly: of what begins to move, the
/// forces may still be at their bounds to within the tolerance of the solver.
const FURTHER_AHEAD: f64 = 100.0;

/// Maximum number of events of one step after which another solution is sought, however close to the last one: a search
/// costs as much as an event.
const MAX_SEARCHES: u32 = 16;

/// Time since the last event, relative to the step, after which one is sought in any case.
const SEARCH_PAUSE: f64 = 0.01;

impl World {
    /// Decides the modes of limited drives, contacts and limits at the start of a sub-step of about `h`, `after_event`
    /// those a little later, and records them. Returns false if no forces keep the laws.
    pub(super) fn resolve_modes(
        &mut self,
        t: f64,
        (h, after_event): (f64, bool),
        system: &mut dyn CoupledSystem<f64>,
    ) -> bool {
        self.mechanism.couple_drives_with_loops(false);
        let mut is_coupled = self.mechanism.couples_drives() && self.has_limited_drives();
        if !is_coupled {
            self.resolve_actuator_modes(t, h, system);
            is_coupled = self.contradict_loops(t, system);
            self.mechanism.couple_drives_with_loops(is_coupled);
        }
        let unchanged = if is_coupled {
            self.collect_kinks()
        } else {
            // decided among themselves
            self.kinks.list.clear();
            true
        };
        let before = self.solver_report();
        if self.is_constrained() {
            self.decide_with_contacts(t, (h, after_event, unchanged), system);
        }
        let (Some(before), Some(after)) = (before, self.solver_report()) else { return true };
        let is_solved = after.not_converged == before.not_converged;
        self.discard_failures(&before);
        is_solved
    }

    /// Returns true if the limited drives that are locked, as prescribed accelerations, contradict loops: their forces
    /// would open these, where as constraints beside the loops the weaker ones give way.
    fn contradict_loops(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) -> bool {
        let is_locked = self.kinks.list.iter().any(|kink| kink.saturation == 0.0);
        if !is_locked || self.model().params.constraints.n_bilateral() == 0 {
            return false;
        }
        self.evaluate_slope(t, system);
        self.mechanism.contradicts_loops()
    }

    /// Goes back from the modes just decided to those of the last sub-step if they keep all laws and give other
    /// accelerations: of several solutions, the one that the motion came with continues until an event. Returns true if
    /// it went back.
    fn prefer_former_modes(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) -> bool {
        let (velocities, report) = (self.layout().velocities(), self.solver_report());
        self.decided_slope.copy_from_slice(&self.slope);
        self.mechanism.contact_memory().into_iter().for_each(WarmStart::set_aside);
        self.evaluate_checked(t, system);
        let (former, decided) = (&self.slope[velocities.clone()], &self.decided_slope[velocities]);
        let largest = decided.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let differ = former.iter().zip(decided).any(|(x, y)| (x - y).abs() > OTHER_MOTION * largest);
        let goes_back = self.mechanism.keeps_laws() && differ;
        if !goes_back {
            self.mechanism.contact_memory().into_iter().for_each(WarmStart::take_set_aside);
        }
        report.into_iter().for_each(|before| self.discard_failures(&before));
        goes_back
    }

    /// Decides contacts together with the drives at their kink, at the start of a sub-step of about `h`, and records
    /// the modes: those a little later after an event, and where a drive has changed. A force reaches its bound
    /// continuously, so that at the event itself rounding decides between the modes on both sides of it.
    fn decide_with_contacts(
        &mut self,
        t: f64,
        (h, after_event, unchanged): (f64, bool, bool),
        system: &mut dyn CoupledSystem<f64>,
    ) {
        self.present_kinks.clone_from(&self.kinks.list);
        self.decide_kinks(t, system);
        let has_left = self.mechanism.contact_memory().is_some_and(|memory| memory.has_left_modes());
        if !after_event && unchanged && (has_left || self.has_other_kinks()) {
            std::mem::swap(&mut self.kinks.list, &mut self.present_kinks);
            self.pose_kinks();
            if !self.prefer_former_modes(t, system) {
                std::mem::swap(&mut self.kinks.list, &mut self.present_kinks);
            } else {
                self.present_kinks.clone_from(&self.kinks.list);
            }
        }
        self.mechanism.mark_start();
        if after_event || !unchanged || self.has_other_kinks() {
            self.look_ahead_at_contacts(t, h, system);
        }
        self.write_modes();
        self.mechanism.mark_modes();
    }

    /// Decides the kinks together with the contacts.
    fn decide_kinks(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) {
        self.pose_kinks();
        self.evaluate_slope(t, system);
        self.mechanism.read_kinks(&mut self.kinks.list);
    }

    /// Makes the kinks constraints of the next evaluations, whatever their modes.
    fn pose_kinks(&mut self) {
        self.release_kinks();
        self.mechanism.mark_locked();
        self.mechanism.pose_kinks(self.kinks.list.iter());
    }

    /// Lets the drives of the kinks apply no torque of their own.
    fn release_kinks(&mut self) {
        let drives = self.mechanism.drives.iter_mut().enumerate();
        let of_kinks = drives.filter(|(i, _)| self.kinks.saturation_of(*i).is_some());
        of_kinks.for_each(|(_, saturation)| *saturation = 0.0);
    }

    /// Decides all limited drives together with the contacts over a step of length `h` at velocity level, which `step`
    /// makes, and makes it with these modes.
    pub(super) fn solve_coupled_step_modes(&mut self, h: f64, mut step: impl FnMut(&mut Self)) {
        self.release_kinks();
        self.mark_targets(h);
        self.mechanism.pose_kinks(self.kinks.list.iter());
        step(self);
        if self.has_unsolved_try() {
            // modes that are none: the whole step is made again by sweeps
            return;
        }
        self.mechanism.read_kinks(&mut self.kinks.list);
        self.mechanism.contact_memory().into_iter().for_each(WarmStart::set_aside);
        self.step_in_modes(h, &mut step);
        if self.keeps_step_modes() {
            return;
        }
        // sweeps hold no modes
        if self.mark_infeasible(Law::Velocity) > 0 || !self.mechanism.was_swept() {
            // the contacts have another solution under these torques, in which the drives move on: hold the first one
            self.mechanism.contact_memory().into_iter().for_each(WarmStart::take_set_aside);
            self.mechanism.mark_start();
            self.mechanism.set_mode_rule(ModeRule::Held);
            step(self);
            self.mechanism.set_mode_rule(ModeRule::Decided);
        }
        if !self.keeps_step_modes() && self.lock_passed_kinks() {
            self.step_in_modes(h, &mut step);
            if !self.keeps_step_modes() {
                self.kinks.list.clone_from(&self.present_kinks);
                self.step_in_modes(h, &mut step);
            }
        }
        if self.mark_slipped() {
            for k in 0..self.kinks.list.len() {
                let Kink { dof, target, infeasible, .. } = self.kinks.list[k];
                if infeasible {
                    self.kinks.list[k].saturation = (target - self.velocity(dof)).signum();
                }
            }
            self.write_modes();
        }
    }

    /// Returns true if the step last made keeps the modes of the kinks: saturated ones have not passed their targets,
    /// locked ones are held at theirs.
    fn keeps_step_modes(&mut self) -> bool {
        self.mark_infeasible(Law::Velocity) == 0 && !self.mark_slipped()
    }

    /// Marks as infeasible the kinks, locked and posed, that the step last made has not brought to their targets: a
    /// contact was stronger. Returns true if there are any.
    fn mark_slipped(&mut self) -> bool {
        let mut posed = 0;
        for k in 0..self.kinks.list.len() {
            let Kink { dof, target, saturation, .. } = self.kinks.list[k];
            let is_short = self.mechanism.velocity_band().error(target, self.velocity(dof)) != 0.0;
            self.kinks.list[k].infeasible = saturation == 0.0 && is_short && self.mechanism.posed_kink_slips(posed);
            posed += usize::from(saturation == 0.0);
        }
        self.kinks.list.iter().any(|kink| kink.infeasible)
    }

    /// Locks the kinks that are saturated but by rounding and have passed their targets: a little less than the limit
    /// holds them. Keeps the former modes in `present_kinks`; returns false if there is none.
    fn lock_passed_kinks(&mut self) -> bool {
        self.present_kinks.clone_from(&self.kinks.list);
        let passed = self.kinks.list.iter_mut().filter(|kink| kink.infeasible && kink.saturation != 0.0);
        let count = passed.map(|kink| kink.saturation = 0.0).count();
        if count > 0 {
            self.separate_kinks();
        }
        count > 0
    }

    /// Makes a step with the modes of the kinks, beside the contact forces last found where these are swept.
    fn step_in_modes(&mut self, h: f64, step: &mut impl FnMut(&mut Self)) {
        self.write_modes();
        self.mark_targets(h);
        self.mechanism.pose_kinks(self.kinks.list.iter().filter(|kink| kink.saturation == 0.0));
        self.mechanism.set_given_forces(GivenForces::Solution);
        step(self);
        self.mechanism.set_given_forces(GivenForces::Start);
    }

    /// Returns true if the modes of the kinks differ from those at the present instant.
    fn has_other_kinks(&self) -> bool {
        self.kinks.list.iter().zip(&self.present_kinks).any(|(kink, present)| kink.saturation != present.saturation)
    }

    /// Moves the state a little ahead of `t`, for a step of `h`, with the kinks at their targets, and decides the kinks
    /// there; the state at `t` is kept in `present`.
    fn decide_ahead(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) {
        let ahead = self.move_ahead(t, h);
        let layout = self.layout();
        for kink in &self.kinks.list {
            self.y[layout.velocity(kink.dof)] = kink.target;
        }
        self.decide_kinks(ahead, system);
    }

    /// Takes the modes a little later than `t` for those at `t`, where they hold as well but for the change of a mode
    /// that is due; state and time stay.
    fn look_ahead_at_contacts(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) {
        let report = self.solver_report();
        self.present_kinks.clone_from(&self.kinks.list);
        self.decide_ahead(t, h, system);
        if self.mechanism.constraints.as_ref().is_some_and(|c| c.solver.is_approximate) {
            self.y.copy_from_slice(&self.present);
            self.kinks.list.clone_from(&self.present_kinks);
            self.decide_ahead(t, FURTHER_AHEAD * h, system);
        }
        self.n_searches += 1;
        let is_apart = t - self.last_decision > SEARCH_PAUSE * self.next_step;
        self.last_decision = t;
        let first = self.takes_other_solutions.then(|| self.kinks.list.clone());
        if first.is_some() {
            self.mechanism.contact_memory().into_iter().for_each(WarmStart::set_aside);
        }
        let meets_other = (is_apart || self.n_searches <= MAX_SEARCHES)
            && self.mechanism.has_other_solution(self.takes_other_solutions);
        if meets_other {
            self.ambiguous_events.note(t);
            self.mechanism.read_kinks(&mut self.kinks.list);
        }
        self.y.copy_from_slice(&self.present);
        if !self.take_modes_ahead(t, system)
            && let Some(first) = first.filter(|_| meets_other)
        {
            // the other solution holds a little later only
            self.mechanism.contact_memory().into_iter().for_each(WarmStart::take_set_aside);
            self.kinks.list = first;
            self.take_modes_ahead(t, system);
        }
        report.into_iter().for_each(|before| self.discard_failures(&before));
    }

    /// Takes the modes last decided, a little later than `t`, for those at `t`; returns false if they do not hold
    /// there, and stays with the present ones.
    fn take_modes_ahead(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) -> bool {
        let contacts_differ = self.mechanism.contact_memory().is_some_and(|memory| memory.has_other_modes());
        if !contacts_differ && !self.has_other_kinks() {
            return true;
        }
        self.mechanism.contact_memory().into_iter().for_each(WarmStart::propose_modes);
        self.pose_kinks();
        self.evaluate_checked(t, system);
        let is_possible = if self.may_graze { self.mechanism.is_grazing() } else { self.mechanism.keeps_laws() };
        if !is_possible {
            self.mechanism.contact_memory().into_iter().for_each(WarmStart::reject_modes);
            self.kinks.list.clone_from(&self.present_kinks);
        }
        is_possible
    }
}

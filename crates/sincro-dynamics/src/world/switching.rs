//! Modes of limited drives: which are locked and which saturated, decided for all of them together.
//!
//! A velocity motor with a limit and the Coulomb friction of a joint have one set-valued force law, −(v − v*) ∈ N_C(τ)
//! with C = [−L, L]. The drives at the *kink* of their law, v = v*, form a linear complementarity problem with bounds:
//! each is either locked, v̇ = v̇* with |τ| ≤ L, or saturated, τ = ±L with (v̇* − v̇)·τ ≥ 0. Its matrix is the Delassus
//! matrix of their degrees of freedom, and forward dynamics with a trial set of locked drives (contacts and loop joints
//! included) is one principal solution. Principal pivoting changes all infeasible drives at once while that helps, then
//! only the one of the highest index, which ends for every positive definite matrix. Sources: keys `judice1994` (block
//! pivoting), `murty1974` (least index), `acary2008` (chapter 3, set-valued laws).
//!
//! **Look ahead.** A force reaches its bound continuously: where a drive is released its relative acceleration is zero
//! and the sign of it is rounding. After an event the problem is therefore solved again a little later, on a copy of
//! the state moved by [`LOOK_AHEAD`] of a step with all drives of the problem kept at their kinks, and the modes found
//! there are taken; the state is not moved.
//!
//! **Dead band.** A reaction is beyond its limit, an acceleration beyond zero, only by more than the rounding of the
//! terms that it is the sum of.

use sincro_actuation::{Kink, Pivoting};

use super::{Method, World};
use crate::coupled::{CoupledSystem, NoCoupling};

/// Distance of a velocity from its target, relative to 1 + |v|, within which drives reach their targets at one event.
const SIMULTANEOUS: f64 = 1e-13;

/// Time by which modes are decided ahead, relative to the step.
const LOOK_AHEAD: f64 = 1e-5;

/// Least time of the look-ahead in units of rounding of the time.
const LOOK_AHEAD_ULPS: f64 = 1e3;

/// Maximum number of kinks whose modes are all tried.
const MAX_ENUMERATED: usize = 5;

/// Level at which the problem is posed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Law {
    /// Accelerations, for drives at their kink.
    Acceleration,
    /// Velocities at the end of a step, for all limited drives.
    Velocity,
}

impl World {
    /// Resolves the modes of the limited drives in the present state: those off their kink saturate towards it, those
    /// on it are decided together. Modes that stand are kept.
    pub(super) fn resolve_actuator_modes(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) {
        if !self.has_limited_drives() {
            // those of motors that were limited before a change are none any more
            self.kinks.list.clear();
            self.mechanism.mark_locked();
            return;
        }
        let report = self.solver_report();
        self.decide_modes(t, h, system);
        // there may be no forces that fit modes which were tried
        report.into_iter().for_each(|before| self.discard_failures(&before));
    }

    fn decide_modes(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) {
        let unchanged = self.collect_kinks();
        self.mechanism.mark_locked();
        if self.kinks.list.is_empty() {
            return;
        }
        self.evaluate_slope(t, system);
        if unchanged && self.mark_infeasible(Law::Acceleration) == 0 {
            return;
        }
        self.solve_modes(t, system);
        self.look_ahead(t, h, system);
    }

    /// Collects the limited drives at their kink, with their present modes; saturates the others. Returns true if no
    /// mode was changed by that.
    pub(super) fn collect_kinks(&mut self) -> bool {
        self.kinks.list.clear();
        let mut unchanged = true;
        for i in 0..self.target_velocities.len() {
            self.kinks.release(i);
            if self.is_unlimited(i) {
                continue;
            }
            let (missing, before) = (self.velocity_error(i), self.mechanism.drives[i]);
            if missing != 0.0 {
                self.mechanism.drives[i] = missing.signum();
            } else if self.model().is_held(self.mechanism.model.params.drives[i].dof) {
                self.mechanism.drives[i] = 0.0;
            } else {
                let dof = self.mechanism.model.params.drives[i].dof;
                let known = self.kinks.list.iter().position(|kink| kink.dof == dof);
                self.add_to_kink(i, known);
                if self.is_constrained() {
                    let velocity = self.layout().velocity(dof);
                    self.y[velocity] = self.target_velocities[i];
                }
            }
            unchanged &= before == self.mechanism.drives[i];
        }
        unchanged
    }

    /// Adds limited drive `i` to a kink, or a new one with its mode; it takes the mode of the kink.
    fn add_to_kink(&mut self, i: usize, known: Option<usize>) {
        let drive = self.mechanism.model.params.drives[i];
        let model = &self.mechanism.model;
        let limit = model.saturated_torque(&drive, self.velocity(drive.dof), 0.0).unwrap_or(f64::INFINITY);
        let load_coefficient = model.load_coefficient(&drive);
        let (target, saturation) = (self.target_velocities[i], self.mechanism.drives[i]);
        let new = Kink { target, saturation, ..Kink::locked(drive.dof) };
        self.mechanism.drives[i] = self.kinks.add(i, known, new, (limit, load_coefficient));
    }

    /// Writes the modes of the kinks to their drives.
    pub(super) fn write_modes(&mut self) {
        for (i, drive) in self.mechanism.drives.iter_mut().enumerate() {
            *drive = self.kinks.saturation_of(i).unwrap_or(*drive);
        }
        self.mechanism.mark_locked();
    }

    /// Solves the complementarity problem of the kinks by principal pivoting, from their present modes. Returns false
    /// if no modes were found that fit.
    fn solve_modes(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) -> bool {
        let mut pivoting = Pivoting::default();
        for _ in 0..self.kinks.max_tries() {
            self.write_modes();
            self.evaluate_slope(t, system);
            let infeasible = self.mark_infeasible(Law::Acceleration);
            if infeasible == 0 {
                return true;
            }
            self.pivot(infeasible, &mut pivoting);
        }
        let is_decided = self.enumerate_modes(t, system);
        self.statistics.undecided_modes += u64::from(!is_decided);
        is_decided
    }

    /// Tries all modes of the kinks if they are few, and leaves those with the fewest infeasible drives: where contacts
    /// change with the drives, pivoting need not end. Returns true if none is infeasible.
    fn enumerate_modes(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) -> bool {
        if self.kinks.list.len() > MAX_ENUMERATED {
            return false;
        }
        let (mut best, mut fewest) = (0, usize::MAX);
        for code in 0..3_usize.pow(self.kinks.list.len() as u32) {
            let infeasible = self.try_modes(code, t, system);
            if infeasible < fewest {
                (best, fewest) = (code, infeasible);
            }
            if infeasible == 0 {
                return true;
            }
        }
        self.try_modes(best, t, system);
        false
    }

    /// Number of infeasible drives under the modes with a ternary `code`.
    fn try_modes(&mut self, mut code: usize, t: f64, system: &mut dyn CoupledSystem<f64>) -> usize {
        for kink in &mut self.kinks.list {
            kink.saturation = [0.0, 1.0, -1.0][code % 3];
            code /= 3;
        }
        self.write_modes();
        self.evaluate_slope(t, system);
        self.mark_infeasible(Law::Acceleration)
    }

    /// Changes the modes of infeasible drives.
    fn pivot(&mut self, infeasible: usize, pivoting: &mut Pivoting) {
        self.kinks.pivot(infeasible, pivoting, |dof| self.mechanism.scratch.reaction[dof]);
    }

    /// Marks the kinks whose modes contradict their law in the last evaluation, and counts them.
    pub(super) fn mark_infeasible(&mut self, law: Law) -> usize {
        let (layout, rounding) = (self.layout(), self.mechanism.rounding());
        let mut count = 0;
        for k in 0..self.kinks.list.len() {
            let kink = self.kinks.list[k];
            let infeasible = if kink.saturation != 0.0 && law == Law::Acceleration {
                let scale = self.mechanism.acceleration_scale(kink.dof);
                self.slope[layout.velocity(kink.dof)] * kink.saturation > rounding * scale
            } else {
                self.mechanism.contradicts_step(&kink, self.velocity(kink.dof), 0)
            };
            self.kinks.list[k].infeasible = infeasible;
            count += usize::from(infeasible);
        }
        count
    }

    /// Keeps the present state in `present` and moves it a little ahead of `t` along its slope, for a step of `h`.
    /// Returns the time there `[s]`.
    pub(super) fn move_ahead(&mut self, t: f64, h: f64) -> f64 {
        let step = (LOOK_AHEAD * h).max(LOOK_AHEAD_ULPS * f64::EPSILON * t.abs());
        self.present.copy_from_slice(&self.y);
        for (y, slope) in self.y.iter_mut().zip(&self.slope) {
            *y += step * slope;
        }
        t + step
    }

    /// Decides the modes of the kinks a little later than `t`; state and time stay.
    fn look_ahead(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) {
        let ahead = self.move_ahead(t, h);
        let layout = self.layout();
        for kink in &self.kinks.list {
            self.y[layout.velocity(kink.dof)] = kink.target;
        }
        self.solve_modes(ahead, system);
        self.y.copy_from_slice(&self.present);
        self.write_modes();
    }

    /// Velocity error of a drive, target minus present velocity, zero within rounding.
    pub(super) fn velocity_error(&self, i: usize) -> f64 {
        let v = self.velocity(self.mechanism.model.params.drives[i].dof);
        self.mechanism.velocity_band().error(self.target_velocities[i], v)
    }

    /// Returns true if a saturated drive has passed its target velocity.
    pub(super) fn has_passed_target(&self, i: usize) -> bool {
        !self.is_unlimited(i) && self.mechanism.drives[i] != 0.0 && self.target_passage(i) > 0.0
    }

    /// Velocity of a saturated drive beyond its target and rounding [rad/s] or [m/s].
    pub(super) fn target_passage(&self, i: usize) -> f64 {
        let v = self.velocity(self.mechanism.model.params.drives[i].dof);
        self.mechanism.velocity_band().passage(self.target_velocities[i], v, self.mechanism.drives[i])
    }

    /// Returns true if a saturated drive is so close to its target velocity, in the state last evaluated, that it
    /// reaches it within the resolution of time `[s]`: its own limit and what accelerates it now are an impulse then.
    pub(super) fn reaches_target(&self, i: usize, resolution: f64) -> bool {
        let drive = self.mechanism.model.params.drives[i];
        let (target, v) = (self.target_velocities[i], self.velocity(drive.dof));
        let Some(limit) = self.mechanism.limit(&drive).filter(|_| self.mechanism.drives[i] != 0.0) else {
            return false;
        };
        let acceleration =
            self.slope[self.layout().velocity(drive.dof)].abs() + limit / self.mechanism.inertia(drive.dof);
        target != v && (target - v).abs() <= SIMULTANEOUS * (1.0 + v.abs()) + 4.0 * resolution * acceleration
    }

    /// The locked drive that is overloaded most in the last evaluation, of those that are no constraints.
    pub(super) fn find_overload(&self) -> Option<usize> {
        let overload = |i: &usize| self.mechanism.drive_overload(*i);
        let is_locked = |i: &usize| self.mechanism.is_locked(self.mechanism.model.params.drives[*i].dof);
        let locked = (0..self.target_velocities.len()).filter(|i| self.mechanism.drives[*i] == 0.0 && is_locked(i));
        locked.filter(|i| overload(i) > 0.0).max_by(|i, j| overload(i).total_cmp(&overload(j)))
    }

    /// Decides the modes over a step at velocity level by trial steps: each limited drive either ends at its target
    /// velocity or is saturated; with closed contacts or loops they are decided together. `step` makes a trial step of
    /// length `h` with the present modes.
    pub(super) fn solve_step_modes(&mut self, h: f64, mut step: impl FnMut(&mut Self)) {
        self.collect_all_limited();
        if self.mechanism.couples_step_drives() {
            self.solve_coupled_step_modes(h, step);
            return;
        }
        let (mut pivoting, mut left) = (Pivoting::default(), self.kinks.max_tries());
        loop {
            self.mark_targets(h);
            step(self);
            let infeasible = self.mark_infeasible(Law::Velocity);
            left -= 1;
            if infeasible == 0 {
                return;
            }
            if left == 0 {
                // the modes of the step that was made stay
                break;
            }
            self.pivot(infeasible, &mut pivoting);
            self.separate_kinks();
        }
        self.statistics.undecided_modes += 1;
    }

    /// Decides anew which of the drives that were locked over a step at velocity level are so at its end, time `t`, in
    /// the state last evaluated; slope and forces are then those of the new modes, the modes of the step stay in the
    /// state. Such a step keeps the laws of its drives in the mean, and a load that grows may be beyond the limit of a
    /// lock at its end. Beside closed contacts the evaluation decides that itself.
    pub(super) fn decide_locks_now(&mut self, t: f64) {
        if !matches!(self.method, Method::SemiImplicitEuler) || self.mechanism.couples_drives() {
            return;
        }
        self.kinks.list.clear();
        for i in 0..self.target_velocities.len() {
            self.kinks.release(i);
            let dof = self.mechanism.model.params.drives[i].dof;
            if self.mechanism.drives[i] == 0.0 && !self.is_unlimited(i) && !self.model().is_held(dof) {
                let known = self.kinks.list.iter().position(|kink| kink.dof == dof);
                self.add_to_kink(i, known);
            }
        }
        if self.kinks.list.is_empty() || self.mark_infeasible(Law::Acceleration) == 0 {
            return;
        }
        let (undecided, report) = (self.statistics.undecided_modes, self.solver_report());
        self.solve_modes(t, &mut NoCoupling);
        // nothing of the run depends on it
        self.statistics.undecided_modes = undecided;
        report.into_iter().for_each(|before| self.discard_failures(&before));
    }

    /// Collects all limited drives, with their present modes.
    pub(super) fn collect_all_limited(&mut self) {
        self.kinks.list.clear();
        for i in 0..self.target_velocities.len() {
            self.kinks.release(i);
            let dof = self.mechanism.model.params.drives[i].dof;
            if !self.is_unlimited(i) && !self.model().is_held(dof) {
                let target = self.target_velocities[i];
                let known = self.kinks.list.iter().position(|kink| kink.dof == dof && kink.target == target);
                self.add_to_kink(i, known);
            }
        }
        self.separate_kinks();
    }

    /// Saturates all but one of several kinks of one degree of freedom that are locked at different velocities.
    pub(super) fn separate_kinks(&mut self) {
        let layout = self.layout();
        self.kinks.separate(|dof| self.before[layout.velocity(dof)]);
        self.write_modes();
    }
}

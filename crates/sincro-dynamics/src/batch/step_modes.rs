//! Modes of limited drives and dry friction over a step of semi-implicit Euler, decided in every lane by itself.
//!
//! Each lane does what [`World`](crate::world::World) does alone: it tries its modes over the whole step, and changes
//! those that contradict their laws until none does. A try is made in all lanes at once; lanes whose modes are decided
//! make the same step again, with the same bits.

use sincro_actuation::{Kink, Kinks, Pivoting};
use sincro_math::Real;

use super::lane_worlds::LaneWorlds;
use crate::mechanism::Mechanism;

/// Decision of the modes in all lanes, with the state from which the step is tried.
#[derive(Clone, Debug)]
pub(super) struct StepModes<R> {
    /// True for each drive that has a limit and is not held by one that has none.
    is_limited: Vec<bool>,
    lanes: Vec<Decision>,
    y: Vec<R>,
    base: Vec<R>,
}

/// Decision of the modes in one lane.
#[derive(Clone, Debug)]
struct Decision {
    kinks: Kinks,
    pivoting: Pivoting,
    /// Number of sets of modes that are still tried; 0 once the modes stand.
    left: usize,
}

impl<R: Real> StepModes<R> {
    /// Working memory for a mechanism and a state of `dim` numbers; `None` if no drive has a limit.
    pub fn new(mechanism: &Mechanism<R>, dim: usize) -> Option<Self> {
        let model = mechanism.model();
        let drives = model.drives();
        if R::IS_SCALAR || !model.has_limited_drives() {
            return None;
        }
        let is_limited =
            drives.iter().map(|drive| model.drive_limit(drive).is_some() && !model.is_held(drive.dof)).collect();
        let decision = Decision { kinks: Kinks::new(drives.len()), pivoting: Pivoting::default(), left: 0 };
        let zeros = |n: usize| vec![R::zero(); n];
        let (lanes, base) = (vec![decision; R::LANES], zeros(model.n_q()));
        Some(Self { is_limited, lanes, y: zeros(dim), base })
    }

    /// Begins a step from the present state with the present modes.
    #[inline(always)]
    fn begin(&mut self, mechanism: &mut Mechanism<R>, y: &[R], target_velocities: &[R]) {
        self.y.copy_from_slice(y);
        self.base.copy_from_slice(mechanism.base());
        let layout = mechanism.layout();
        self.lanes.iter_mut().for_each(|lane| lane.kinks.list.clear());
        for (i, is_limited) in self.is_limited.iter().enumerate() {
            let drive = mechanism.model.params.drives[i];
            let limit = match mechanism.model.saturated_torque(&drive, y[layout.velocity(drive.dof)], R::zero()) {
                Some(limit) if *is_limited => limit,
                _ => {
                    self.lanes.iter_mut().for_each(|lane| lane.kinks.release(i));
                    continue;
                }
            };
            for (k, Decision { kinks, .. }) in self.lanes.iter_mut().enumerate() {
                let (target, saturation) = (target_velocities[i].lane(k), mechanism.drives[i].lane(k));
                let known = kinks.list.iter().position(|kink| kink.dof == drive.dof && kink.target == target);
                let new = Kink { target, saturation, ..Kink::locked(drive.dof) };
                kinks.add(i, known, new, (limit.lane(k), 0.0));
            }
        }
        for (k, lane) in self.lanes.iter_mut().enumerate() {
            lane.kinks.separate(|dof| y[layout.velocity(dof)].lane(k));
            (lane.pivoting, lane.left) = (Pivoting::default(), lane.kinks.max_tries());
        }
        self.write(mechanism);
    }

    /// Writes the modes to the drives.
    #[inline(always)]
    fn write(&self, mechanism: &mut Mechanism<R>) {
        for (i, drive) in mechanism.drives.iter_mut().enumerate() {
            let of_lane = |k: usize| self.lanes[k].kinks.saturation_of(i).unwrap_or(drive.lane(k));
            *drive = R::from_lanes(of_lane);
        }
    }

    /// Looks at the step last tried, and changes the modes of the lanes in which they contradict their laws. Returns
    /// true if there is none.
    #[inline(always)]
    fn decide(&mut self, mechanism: &mut Mechanism<R>, y: &[R]) -> bool {
        let layout = mechanism.layout();
        let mut are_decided = true;
        for (k, Decision { kinks, pivoting, left }) in self.lanes.iter_mut().enumerate().filter(|(_, l)| l.left > 0) {
            let mut infeasible = 0;
            for kink in &mut kinks.list {
                kink.infeasible = mechanism.contradicts_step(kink, y[layout.velocity(kink.dof)].lane(k), k);
                infeasible += usize::from(kink.infeasible);
            }
            *left = if infeasible == 0 { 0 } else { *left - 1 };
            if *left > 0 {
                kinks.pivot(infeasible, pivoting, |dof| mechanism.scratch.reaction[dof].lane(k));
                kinks.separate(|dof| self.y[layout.velocity(dof)].lane(k));
                are_decided = false;
            }
        }
        if !are_decided {
            self.write(mechanism);
        }
        are_decided
    }
}

impl<R: Real> LaneWorlds<R> {
    /// Makes a step of length `h` `[s]`, which `step` tries from the present state, in the modes in which the laws of
    /// the limited drives hold over it. The target velocities are known.
    #[inline(always)]
    pub(super) fn step_in_modes(&mut self, h: f64, mut step: impl FnMut(&mut Self)) {
        let Some(mut modes) = self.modes.take() else { return };
        modes.begin(&mut self.mechanism, &self.y, &self.target_velocities);
        loop {
            self.prescribe(&modes.y, h);
            step(self);
            if modes.decide(&mut self.mechanism, &self.y) {
                break;
            }
            self.y.copy_from_slice(&modes.y);
            self.mechanism.set_base(&modes.base);
        }
        self.modes = Some(modes);
    }

    /// Prescribes the accelerations by which locked drives reach their target velocities within `h` `[s]` from the
    /// state `y`.
    #[inline(always)]
    fn prescribe(&mut self, y: &[R], h: f64) {
        let (layout, half) = (self.mechanism.layout(), R::splat(0.5));
        self.mechanism.mark_locked();
        for i in 0..self.target_velocities.len() {
            let dof = self.mechanism.model.params.drives[i].dof;
            let needed = (self.target_velocities[i] - y[layout.velocity(dof)]) / R::splat(h);
            let old = self.mechanism.prescribed_acceleration[dof];
            self.mechanism.prescribed_acceleration[dof] = self.mechanism.drives[i].abs().if_less(half, needed, old);
        }
    }
}

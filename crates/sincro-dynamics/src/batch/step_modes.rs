//! Modes of limited drives and dry friction over a step of semi-implicit Euler, decided in every lane by itself.
//!
//! Each lane does what [`World`](crate::world::World) does alone: it tries its modes over the whole step, and changes
//! those that contradict their laws until none does. A try is made in all lanes at once; lanes whose modes are decided
//! make the same step again, with the same bits. Most steps keep the modes of the last one: whether they do is seen in
//! all lanes together, by a test without room for rounding; only where one fails the lanes are looked at one by one.

use sincro_actuation::{Kink, Kinks, Pivoting};
use sincro_math::Real;

use super::lane_worlds::LaneWorlds;
use crate::mechanism::Mechanism;

/// Decision of the modes in all lanes, with the state from which the step is tried.
#[derive(Clone, Debug)]
pub(super) struct StepModes<R> {
    /// True for each drive that has a limit and is not held by one that has none.
    is_limited: Vec<bool>,
    /// Pairs of limited drives of one degree of freedom, each in both orders.
    pairs: Vec<[usize; 2]>,
    /// Torque of each limited drive when saturated in the present step, together with those of the same degree of
    /// freedom and target.
    limits: Vec<R>,
    lanes: Vec<Decision>,
    /// True if each lane looks at its modes by itself in the present step.
    are_collected: bool,
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
        let is_limited: Vec<bool> =
            drives.iter().map(|drive| model.drive_limit(drive).is_some() && !model.is_held(drive.dof)).collect();
        let limited = || (0..drives.len()).filter(|i| is_limited[*i]);
        let others = |i: usize| limited().filter(move |j| *j != i && drives[*j].dof == drives[i].dof);
        let pairs = limited().flat_map(|i| others(i).map(move |j| [i, j])).collect();
        let decision = Decision { kinks: Kinks::new(drives.len()), pivoting: Pivoting::default(), left: 0 };
        let zeros = |n: usize| vec![R::zero(); n];
        let (lanes, base) = (vec![decision; R::LANES], zeros(model.n_q()));
        let limits = zeros(drives.len());
        Some(Self { is_limited, pairs, limits, lanes, are_collected: false, y: zeros(dim), base })
    }

    /// Begins a step from the present state. Returns true if each lane can try its present modes: the drives of a
    /// degree of freedom that have one target have one mode, and are not locked at different ones.
    #[inline(always)]
    fn begin(&mut self, mechanism: &Mechanism<R>, y: &[R], target_velocities: &[R]) -> bool {
        self.y.copy_from_slice(y);
        self.base.copy_from_slice(mechanism.base());
        for (i, limit) in self.limits.iter_mut().enumerate() {
            *limit = of_saturated(mechanism, y, i).unwrap_or(R::zero());
        }
        let (zero, one) = (R::zero(), R::one());
        let mut differ = zero;
        for &[i, j] in &self.pairs {
            let [a, b] = [i, j].map(|k| target_velocities[k]);
            let (first, second) = (mechanism.drives[i], mechanism.drives[j]);
            let has_other_target = a.if_less(b, one, b.if_less(a, one, zero));
            // modes are 0, 1 and −1
            let are_locked = one - (first * first).max(second * second);
            let has_other_mode = (first - second).abs();
            differ = differ.max(has_other_target * are_locked).max((one - has_other_target) * has_other_mode);
            let own = of_saturated(mechanism, y, j).unwrap_or(zero);
            self.limits[i] += (one - has_other_target) * own;
        }
        (0..R::LANES).all(|k| differ.lane(k) == 0.0)
    }

    /// Returns true if the modes of no lane can contradict their laws in the step last tried.
    #[inline(always)]
    fn stand(&self, mechanism: &Mechanism<R>, y: &[R], target_velocities: &[R]) -> bool {
        let (zero, half, layout) = (R::zero(), R::splat(0.5), mechanism.layout());
        let mut worst = zero;
        for i in (0..self.limits.len()).filter(|i| self.is_limited[*i]) {
            let dof = mechanism.model.params.drives[i].dof;
            let overload = mechanism.scratch.reaction[dof].abs() - self.limits[i];
            let passage = (y[layout.velocity(dof)] - target_velocities[i]) * mechanism.drives[i];
            worst = worst.max(mechanism.drives[i].abs().if_less(half, overload, passage));
        }
        (0..R::LANES).all(|k| worst.lane(k) <= 0.0)
    }

    /// Collects the limited drives of all lanes, with their present modes, at the start of the step.
    #[inline(always)]
    fn collect(&mut self, mechanism: &mut Mechanism<R>, target_velocities: &[R]) {
        let (y, layout) = (&self.y, mechanism.layout());
        self.lanes.iter_mut().for_each(|lane| lane.kinks.list.clear());
        for (i, is_limited) in self.is_limited.iter().enumerate() {
            let dof = mechanism.model.params.drives[i].dof;
            let limit = match of_saturated(mechanism, y, i) {
                Some(limit) if *is_limited => limit,
                _ => {
                    self.lanes.iter_mut().for_each(|lane| lane.kinks.release(i));
                    continue;
                }
            };
            for (k, Decision { kinks, .. }) in self.lanes.iter_mut().enumerate() {
                let (target, saturation) = (target_velocities[i].lane(k), mechanism.drives[i].lane(k));
                let known = kinks.list.iter().position(|kink| kink.dof == dof && kink.target == target);
                kinks.add(i, known, Kink { target, saturation, ..Kink::locked(dof) }, (limit.lane(k), 0.0));
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

/// Torque of drive `i` when it is saturated at the velocities of the state `y`; none without a limit.
#[inline(always)]
fn of_saturated<R: Real>(mechanism: &Mechanism<R>, y: &[R], i: usize) -> Option<R> {
    let drive = mechanism.model.params.drives[i];
    mechanism.model.saturated_torque(&drive, y[mechanism.layout().velocity(drive.dof)], R::zero())
}

impl<R: Real> LaneWorlds<R> {
    /// Begins the decision of the modes in which the laws of the limited drives hold over a step from the present
    /// state; `None` if there are no such drives. The target velocities are known.
    #[inline(always)]
    pub(super) fn begin_modes(&mut self) -> Option<Box<StepModes<R>>> {
        let mut modes = self.modes.take()?;
        modes.are_collected = !modes.begin(&self.mechanism, &self.y, &self.target_velocities);
        if modes.are_collected {
            modes.collect(&mut self.mechanism, &self.target_velocities);
        }
        Some(modes)
    }

    /// Returns true if the modes of the step last tried stand; else it goes back to the state before, in other modes.
    #[inline(always)]
    pub(super) fn have_decided(&mut self, modes: &mut StepModes<R>) -> bool {
        if !modes.are_collected {
            if modes.stand(&self.mechanism, &self.y, &self.target_velocities) {
                return true;
            }
            modes.collect(&mut self.mechanism, &self.target_velocities);
            modes.are_collected = true;
        }
        if modes.decide(&mut self.mechanism, &self.y) {
            return true;
        }
        self.y.copy_from_slice(&modes.y);
        self.mechanism.set_base(&modes.base);
        false
    }

    /// Prescribes the accelerations by which drives locked in the next try of a step of length `h` `[s]` reach their
    /// target velocities within it.
    #[inline(always)]
    pub(super) fn prescribe(&mut self, modes: &StepModes<R>, h: f64) {
        let (layout, half) = (self.mechanism.layout(), R::splat(0.5));
        self.mechanism.mark_locked();
        for i in 0..self.target_velocities.len() {
            let dof = self.mechanism.model.params.drives[i].dof;
            let needed = (self.target_velocities[i] - modes.y[layout.velocity(dof)]) / R::splat(h);
            let old = self.mechanism.prescribed_acceleration[dof];
            self.mechanism.prescribed_acceleration[dof] = self.mechanism.drives[i].abs().if_less(half, needed, old);
        }
    }
}

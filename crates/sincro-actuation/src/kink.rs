//! Limited drives at the kinks of their laws, and the decision of their modes by pivoting.
//!
//! A limited motor, and the dry friction of a joint, have a law with a kink at a target velocity: there the drive is
//! *locked*, with any torque up to its limit; elsewhere it is *saturated*, with its limit as torque. Which of them are
//! locked is a linear complementarity problem, of which whoever has the dynamics evaluates one set of modes after the
//! other. Sources: keys `judice1994` (block pivoting), `murty1974` (least index).

use core::cmp::Ordering;

/// Block changes without progress before single ones.
const BLOCK_CHANGES: u32 = 3;

/// Kink of a drive that is at none.
const NO_KINK: usize = usize::MAX;

/// Limited drives of one degree of freedom at one kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink {
    /// Degree of freedom.
    pub dof: usize,
    /// Sum of the limits without load [N·m] or `[N]`.
    pub limit: f64,
    /// Sum of the load coefficients of its friction.
    pub load_coefficient: f64,
    /// Force that the bearing of the joint transmits, where friction grows with it `[N]`.
    pub load: f64,
    /// Target velocity [rad/s] or [m/s].
    pub target: f64,
    /// Mode: 0 locked, ±1 saturated.
    pub saturation: f64,
    /// True if the mode contradicts the law in the last evaluation.
    pub infeasible: bool,
}

impl Kink {
    /// Kink of a degree of freedom at target velocity zero, locked, without drives.
    #[must_use]
    pub fn locked(dof: usize) -> Self {
        Self { dof, limit: 0.0, load_coefficient: 0.0, load: 0.0, target: 0.0, saturation: 0.0, infeasible: false }
    }

    /// Adds a drive with these numbers.
    pub fn add(&mut self, limit: f64, load_coefficient: f64) {
        self.limit += limit;
        self.load_coefficient += load_coefficient;
    }

    /// Sum of the limits under the force `load` `[N]` of the bearing [N·m] or `[N]`.
    #[must_use]
    pub fn limit_under(&self, load: f64) -> f64 {
        self.limit + self.load_coefficient * load
    }
}

/// Kinks whose modes are decided together, and the kink of each drive.
///
/// ```
/// use sincro_actuation::{Kink, Kinks, Pivoting};
///
/// // two motors of 3 N·m on a shaft that needs 5 N·m to stand still, one kink; and one of 1 N·m beside it
/// let mut kinks = Kinks::new(3);
/// let shaft = kinks.add(0, None, Kink::locked(0), (3.0, 0.0));
/// kinks.add(1, Some(0), Kink::locked(0), (3.0, 0.0));
/// kinks.add(2, None, Kink::locked(1), (1.0, 0.0));
/// assert_eq!((shaft, kinks.list.len(), kinks.list[0].limit), (0.0, 2, 6.0));
/// let needed = [5.0_f64, -4.0];
/// kinks.list.iter_mut().for_each(|kink| kink.infeasible = needed[kink.dof].abs() > kink.limit);
/// kinks.pivot(1, &mut Pivoting::default(), |dof| needed[dof]);
/// assert_eq!([0, 1, 2].map(|drive| kinks.saturation_of(drive)), [Some(0.0), Some(0.0), Some(-1.0)]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Kinks {
    /// The kinks, in the order in which they were added.
    pub list: Vec<Kink>,
    of_drives: Vec<usize>,
}

/// Progress of pivoting.
#[derive(Clone, Copy, Debug)]
pub struct Pivoting {
    fewest: usize,
    left: u32,
}

impl Default for Pivoting {
    fn default() -> Self {
        Self { fewest: usize::MAX, left: BLOCK_CHANGES }
    }
}

impl Kinks {
    /// No kinks, of a number of drives.
    #[must_use]
    pub fn new(n_drives: usize) -> Self {
        Self { list: Vec::with_capacity(n_drives), of_drives: vec![NO_KINK; n_drives] }
    }

    /// Changes the number of drives; new ones are at no kink.
    pub fn resize(&mut self, n_drives: usize) {
        self.of_drives.resize(n_drives, NO_KINK);
    }

    /// Notes that a drive is at no kink, before kinks are collected anew.
    pub fn release(&mut self, drive: usize) {
        self.of_drives[drive] = NO_KINK;
    }

    /// Adds a drive with its limit and load coefficient to kink `known`, or to a new one; returns the mode of the kink.
    pub fn add(&mut self, drive: usize, known: Option<usize>, new: Kink, (limit, load_coefficient): (f64, f64)) -> f64 {
        let k = known.unwrap_or(self.list.len());
        if known.is_none() {
            self.list.push(new);
        }
        self.list[k].add(limit, load_coefficient);
        self.of_drives[drive] = k;
        self.list[k].saturation
    }

    /// Mode of the kink of a drive; `None` if it is at none.
    #[must_use]
    pub fn saturation_of(&self, drive: usize) -> Option<f64> {
        self.list.get(self.of_drives[drive]).map(|kink| kink.saturation)
    }

    /// Maximum number of sets of modes that are tried.
    #[must_use]
    pub fn max_tries(&self) -> usize {
        16 + 16 * self.list.len()
    }

    /// Changes the modes of infeasible kinks, of which there are `n`: of all of them, or after some changes without
    /// progress of the last one alone. `reaction` is the torque that a locked drive needs [N·m] or `[N]`.
    pub fn pivot(&mut self, n: usize, pivoting: &mut Pivoting, reaction: impl Fn(usize) -> f64) {
        if n < pivoting.fewest {
            (pivoting.fewest, pivoting.left) = (n, BLOCK_CHANGES);
        } else if pivoting.left > 0 {
            pivoting.left -= 1;
        }
        for kink in self.list.iter_mut().rev().filter(|kink| kink.infeasible) {
            kink.saturation = if kink.saturation == 0.0 { reaction(kink.dof).signum() } else { 0.0 };
            if pivoting.left == 0 {
                break;
            }
        }
    }

    /// Saturates all but one of several kinks of one degree of freedom that are locked at different velocities over a
    /// step: the one nearest to the velocity `v` at the start of the step stays.
    pub fn separate(&mut self, v: impl Fn(usize) -> f64) {
        for k in 0..self.list.len() {
            let kink = self.list[k];
            let v = v(kink.dof);
            let distance = |other: &Kink| (other.target - v).abs();
            let is_nearer = |(j, other): (usize, &Kink)| {
                let order = (distance(other), j).partial_cmp(&(distance(&kink), k));
                j != k && other.dof == kink.dof && other.saturation == 0.0 && order == Some(Ordering::Less)
            };
            if kink.saturation == 0.0 && self.list.iter().enumerate().any(is_nearer) {
                self.list[k].saturation = (kink.target - v).signum();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_targets_of_one_joint_the_nearer_one_is_locked() {
        let mut kinks = Kinks::new(2);
        for (drive, target) in [(0, 1.0), (1, 3.0)] {
            kinks.add(drive, None, Kink { target, ..Kink::locked(4) }, (1.0, 0.0));
        }
        kinks.separate(|_| 2.5);
        assert_eq!([0, 1].map(|drive| kinks.saturation_of(drive)), [Some(-1.0), Some(0.0)]);
        kinks.release(1);
        assert_eq!(kinks.saturation_of(1), None);
    }

    #[test]
    fn without_progress_one_kink_is_changed_at_a_time() {
        let mut kinks = Kinks::new(2);
        for drive in 0..2 {
            kinks.add(drive, None, Kink { infeasible: true, ..Kink::locked(drive) }, (1.0, 0.0));
        }
        let mut pivoting = Pivoting::default();
        let modes = |kinks: &Kinks| [kinks.list[0].saturation, kinks.list[1].saturation];
        for wanted in [[1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [1.0, 1.0]] {
            kinks.pivot(2, &mut pivoting, |_| 2.0);
            assert_eq!(modes(&kinks), wanted);
        }
    }
}

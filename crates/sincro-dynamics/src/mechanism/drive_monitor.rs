//! Laws of limited drives at one evaluation: overload of a locked drive, passage of a saturated one through its target
//! velocity, each beyond the rounding of its terms; and a monitor of them, and of the laws of contacts, at the stages
//! of a step, which notices a law that is violated within the step and holds again at its end.

use sincro_actuation::{Kink, VelocityBand};
use sincro_math::Real;

use super::Mechanism;
use crate::actuation::Drive;
use crate::integrate::Hermite;
use crate::spatial::Vec3;

/// Relative excess of a reaction over its limit that counts as rounding.
const SAME_FORCE: f64 = 1e-12;

/// Rounding of a sum, relative to the sum of the magnitudes of its terms.
const ROUNDING: f64 = 1e-13;

/// The same where constraints contribute: the solution of their linear system amplifies rounding.
const ROUNDING_CONSTRAINED: f64 = 1e-11;

/// Monitor of the limited drives over the stages of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct DriveMonitor {
    /// True while a step is made with limited drives.
    pub is_active: bool,
    /// Target velocity of each drive [rad/s] or [m/s].
    pub targets: Vec<f64>,
    band: VelocityBand,
    /// Earliest stage after the first one at which a law was violated `[s]`; infinite for none.
    pub violated: f64,
    /// Time of the first stage `[s]`.
    from: f64,
    /// Velocity and acceleration of each drive's joint at the first stage.
    start: Vec<(f64, f64)>,
}

impl DriveMonitor {
    /// Begins a step.
    pub fn begin(&mut self, targets: &[f64], band: VelocityBand) {
        self.band = band;
        self.targets.clear();
        self.targets.extend_from_slice(targets);
        self.start.clear();
        (self.is_active, self.violated, self.from) = (true, f64::INFINITY, f64::NAN);
    }

    /// Begins a trial step: violations of one that was not accepted do not count.
    pub fn begin_trial(&mut self) {
        self.violated = f64::INFINITY;
    }

    /// Earliest time within a step of length `h` at which the velocity of a saturated drive is beyond its target
    /// `[s]`, by the cubic through velocities and accelerations at both ends; infinite for none. `drive` gives the
    /// saturation of a drive, and velocity and acceleration of its joint at the end.
    pub fn passage(&self, h: f64, drive: impl Fn(usize) -> (f64, f64, f64)) -> f64 {
        let mut earliest = f64::INFINITY;
        for (i, ((v0, a0), target)) in self.start.iter().zip(&self.targets).enumerate() {
            let (saturation, v1, a1) = drive(i);
            let cubic = Hermite::new((*v0, h * a0), (v1, h * a1));
            for s in cubic.extrema() {
                let v = cubic.value(s);
                if self.band.is_beyond(*target, v, saturation) {
                    earliest = earliest.min(s * h);
                }
            }
        }
        earliest
    }

    /// Ends a step; returns the time of the earliest violation in it `[s]`, infinite for none.
    pub fn end(&mut self) -> f64 {
        self.is_active = false;
        self.violated
    }
}

impl<R: Real> Mechanism<R> {
    /// Terms of the reaction on a degree of freedom in the last evaluation, sum of their magnitudes [N·m] or `[N]`: its
    /// rounding is relative to this.
    pub(crate) fn reaction_scale(&self, dof: usize) -> f64 {
        self.reaction_scale_in(0, dof)
    }

    /// As [`Mechanism::reaction_scale`], in lane `lane`.
    fn reaction_scale_in(&self, lane: usize, dof: usize) -> f64 {
        let link = self.model.links.iter().rposition(|link| link.v_idx as usize <= dof).unwrap_or(0);
        let (a, of_dof) = (&self.scratch.links[link].a, &self.scratch.dofs[dof]);
        let product = |a: &Vec3<R>, u: &Vec3<R>| (0..3).map(|k| (a[k] * u[k]).lane(lane).abs()).sum::<f64>();
        product(&a.ang, &of_dof.u.ang)
            + product(&a.lin, &of_dof.u.lin)
            + of_dof.force.lane(lane).abs()
            + self.scratch.reaction[dof].lane(lane).abs()
    }

    /// Terms of the acceleration of a degree of freedom in the last evaluation, sum of their magnitudes [rad/s²] or
    /// [m/s²].
    pub(crate) fn acceleration_scale(&self, dof: usize) -> f64 {
        self.reaction_scale(dof) / self.inertia(dof)
    }

    /// Articulated inertia of a degree of freedom in the last evaluation, those nearer to the base held [kg·m²] or
    /// `[kg]`.
    pub(crate) fn inertia(&self, dof: usize) -> f64 {
        self.scratch.dofs[dof].d.lane(0)
    }

    /// Width within which the velocity of a drive counts as its target.
    pub(crate) fn velocity_band(&self) -> VelocityBand {
        if self.is_constrained { VelocityBand::CONSTRAINED } else { VelocityBand::default() }
    }

    /// Rounding of the last evaluation, relative to the sum of the magnitudes of its terms.
    pub(crate) fn rounding(&self) -> f64 {
        if self.is_constrained { ROUNDING_CONSTRAINED } else { ROUNDING }
    }

    /// Returns true if the mode of a kink contradicts its law over the step at velocity level last made in lane `lane`,
    /// at whose end its joint has the velocity `v`: a locked one needs more than its limit, a saturated one has passed
    /// its target.
    #[inline(always)]
    pub(crate) fn contradicts_step(&self, kink: &Kink, v: f64, lane: usize) -> bool {
        if kink.saturation != 0.0 {
            return self.velocity_band().is_beyond(kink.target, v, kink.saturation);
        }
        let limit = kink.limit_under(self.loads[kink.dof].lane(lane));
        self.overload_in(lane, kink.dof, limit) > 0.0
    }

    /// Reaction on a degree of freedom in the last evaluation beyond `limit` and rounding [N·m] or `[N]`.
    fn overload(&self, dof: usize, limit: f64) -> f64 {
        self.overload_in(0, dof, limit)
    }

    /// As [`Mechanism::overload`], in lane `lane`.
    fn overload_in(&self, lane: usize, dof: usize, limit: f64) -> f64 {
        let reaction = self.scratch.reaction[dof].lane(lane).abs();
        reaction - (limit * (1.0 + SAME_FORCE)).max(limit + self.rounding() * self.reaction_scale_in(lane, dof))
    }

    /// Torque limit of a drive under the loads of the last evaluation [N·m] or `[N]`; none without a limit.
    #[inline(always)]
    pub(crate) fn limit(&self, drive: &Drive) -> Option<R> {
        self.model.limit_under(drive, self.loads[drive.dof])
    }

    /// Returns true if the reaction on locked drive `i`, in the last evaluation, is more than the drives that lock its
    /// joint can give together.
    pub(crate) fn is_drive_overloaded(&self, i: usize) -> bool {
        self.drive_overload(i) > 0.0
    }

    /// Reaction on locked drive `i`, in the last evaluation, beyond what the drives that lock its joint can give
    /// together, and beyond rounding [N·m] or `[N]`.
    pub(crate) fn drive_overload(&self, i: usize) -> f64 {
        let dof = self.model.params.drives[i].dof;
        let locked =
            self.model.params.drives.iter().zip(&self.drives).filter(|(d, s)| d.dof == dof && s.lane(0) == 0.0);
        let limit = locked.map(|(drive, _)| self.limit(drive).map_or(f64::INFINITY, |limit| limit.lane(0))).sum();
        self.overload(dof, limit)
    }

    /// Notes whether the law of a limited drive is violated at a stage, for velocities `v`, after the evaluation.
    pub(super) fn monitor_drives(&mut self, t: f64, v: &[R], v_dot: &[R]) {
        if self.drive_monitor.start.is_empty() {
            let of_joint = self.model.params.drives.iter().map(|d| (v[d.dof].lane(0), v_dot[d.dof].lane(0)));
            self.drive_monitor.start.extend(of_joint);
        }
        if self.drive_monitor.from.is_nan() {
            self.drive_monitor.from = t;
        }
        if t >= self.drive_monitor.violated || t == self.drive_monitor.from {
            return;
        }
        let is_contact = self.constraints.as_ref().is_some_and(|c| c.violation.is_some());
        let violated = is_contact
            || (0..self.model.params.drives.len()).any(|i| {
                let (drive, saturation) = (&self.model.params.drives[i], self.drives[i].lane(0));
                match self.model.drive_limit(drive) {
                    None => false,
                    // contacts see to those that are constraints
                    Some(_) if saturation == 0.0 => self.is_locked(drive.dof) && self.is_drive_overloaded(i),
                    Some(_) => {
                        let monitor = &self.drive_monitor;
                        monitor.band.is_beyond(monitor.targets[i], v[drive.dof].lane(0), saturation)
                    }
                }
            });
        if violated {
            self.drive_monitor.violated = t;
        }
    }
}

//! Drives of a model: the list of them, their torque limits and target velocities.

use sincro_math::Real;

use super::Model;
use crate::actuation::motor::LEFT_TO_LIMIT;
use crate::actuation::{Drive, DriveKind};
use crate::ids::MotorId;
use crate::joint::JointKind;

impl<R: Real> Model<R> {
    /// Torque limit of a drive at its target velocity [N·m] or `[N]`; none if no lane has a limit.
    #[inline(always)]
    pub(crate) fn drive_limit(&self, drive: &Drive) -> Option<R> {
        let limit = match drive.kind {
            DriveKind::Lock => return None,
            DriveKind::Friction => self.dofs[drive.dof].friction.at_rest,
            DriveKind::Motor(i) => self.motor(i).max_torque,
        };
        limit.is_finite().then_some(limit)
    }

    /// Returns true if a drive has a limit, of motors or of dry friction.
    #[must_use]
    pub fn has_limited_drives(&self) -> bool {
        self.params.drives.iter().any(|drive| self.drive_limit(drive).is_some())
    }

    /// Returns true if a drive without limit holds a degree of freedom.
    pub(crate) fn is_held(&self, dof: usize) -> bool {
        self.params.drives.iter().any(|drive| drive.dof == dof && self.drive_limit(drive).is_none())
    }

    /// As [`Model::drive_limit`], while the bearing of the joint transmits the force `load` `[N]`.
    #[inline(always)]
    pub(crate) fn limit_under(&self, drive: &Drive, load: R) -> Option<R> {
        match drive.kind {
            DriveKind::Friction => Some(self.dofs[drive.dof].friction.under(load).at_rest),
            DriveKind::Motor(_) | DriveKind::Lock => self.drive_limit(drive),
        }
    }

    /// Load coefficient of a drive: of friction that grows with the load of its bearing, else zero.
    pub(crate) fn load_coefficient(&self, drive: &Drive) -> R {
        match drive.kind {
            DriveKind::Friction => self.dofs[drive.dof].friction.load_coefficient,
            DriveKind::Motor(_) | DriveKind::Lock => R::zero(),
        }
    }

    /// Torque of a saturated drive at rate `v`, without its sign [N·m] or `[N]`: its limit, or less for friction in
    /// motion, while the bearing of the joint transmits the force `load` `[N]`; none if no lane has a limit.
    #[inline(always)]
    pub(crate) fn saturated_torque(&self, drive: &Drive, v: R, load: R) -> Option<R> {
        match drive.kind {
            DriveKind::Friction => Some(self.dofs[drive.dof].friction.under(load).limit_at(v)),
            DriveKind::Motor(_) | DriveKind::Lock => self.drive_limit(drive),
        }
    }

    /// Target velocity of a drive [rad/s] or [m/s] for latched commands and coordinates at the tick.
    #[inline(always)]
    pub(crate) fn target_velocity(&self, drive: &Drive, q: &[R], commands: &[R]) -> R {
        match drive.kind {
            DriveKind::Friction | DriveKind::Lock => R::zero(),
            DriveKind::Motor(i) => {
                let q = self.dofs[drive.dof].coordinate_in(q);
                self.motor(i).target_velocity(q, commands[i.index()])
            }
        }
    }

    /// Target velocity as of [`Model::target_velocity`], of an ideal motor such that its joint stops short of its
    /// limits within a tick of length `h` `[s]`: whatever torque a stop has, such a motor has more.
    #[inline(always)]
    pub(crate) fn target_velocity_within(&self, drive: &Drive, q: &[R], commands: &[R], h: f64) -> R {
        let target = self.target_velocity(drive, q, commands);
        let DriveKind::Motor(i) = drive.kind else { return target };
        let mut within = target;
        for limit in self.params.constraints.limits.iter().filter(|limit| limit.dof == drive.dof) {
            let sign = R::splat(limit.sign);
            let distance = sign * (q[limit.coordinate] - R::splat(limit.bound));
            let left = (distance - R::splat(LEFT_TO_LIMIT)).max(R::zero());
            within = sign * (sign * within).max(-(left * R::splat(1.0 / h)));
        }
        R::splat(f64::MAX).if_less(self.motor(i).max_torque, within, target)
    }

    /// Drives that follow from joints and motors: friction first, then motors, then locked degrees of freedom.
    pub(crate) fn find_drives(&self) -> Vec<Drive> {
        let friction = self.dofs.iter().enumerate().filter(|(_, d)| !d.friction.is_none());
        let friction = friction.map(|(dof, _)| Drive { dof, kind: DriveKind::Friction });
        let motors = self.params.motors.iter().enumerate().filter(|(_, m)| m.is_drive());
        let motors = motors.map(|(i, m)| Drive { dof: m.dof, kind: DriveKind::Motor(MotorId::new(i)) });
        let sensors = self.names.joints.iter().filter(|j| j.kind == JointKind::Fixed);
        let locked = sensors.flat_map(|j| (j.v_idx..j.v_idx + j.n_v).map(|dof| Drive { dof, kind: DriveKind::Lock }));
        friction.chain(motors).chain(locked).collect()
    }
}

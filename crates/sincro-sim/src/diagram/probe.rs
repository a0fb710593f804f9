//! Measurements on any kind of number: what a diagram sees between ticks, and what is linearised.

use sincro_dynamics::attachment::{Response, Seen};
use sincro_dynamics::energy::{energy, momentum};
use sincro_dynamics::force::{damper, spring};
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_math::Real;

use crate::record::{EnergyQuantity, FrameQuantity, Probe};

/// Whether a probe needs the poses and twists of links.
pub(super) fn needs_kinematics(probe: Probe) -> bool {
    matches!(probe, Probe::Frame(..) | Probe::Energy(_) | Probe::Momentum(_))
}

/// A measurement that the state alone decides; after kinematics, if it needs them. None for what is known at ticks only.
pub(crate) fn of_state<R: Real>(seen: &Seen<'_, R>, probe: Probe) -> Option<R> {
    let model = seen.model;
    Some(match probe {
        Probe::Coordinate(i) => seen.q[i],
        Probe::Rate(k) => seen.v[k],
        Probe::SpringTorque(k) => {
            let dof = &model.dofs()[k];
            spring::torque(dof, seen.q[dof.coordinate().expect("a scalar joint")])
        }
        Probe::DampingTorque(k) => damper::torque(&model.dofs()[k], seen.v[k]),
        Probe::AppliedTorque(k) => model.applied_torque(k, seen.t),
        Probe::Frame(quantity, frame, component) => of_frame(seen, quantity, frame, component),
        Probe::Energy(EnergyQuantity::Kinetic) => energy(model, seen.q, seen.v, seen.scratch).kinetic,
        Probe::Energy(EnergyQuantity::Potential) => energy(model, seen.q, seen.v, seen.scratch).potential,
        Probe::Energy(EnergyQuantity::Total) => energy(model, seen.q, seen.v, seen.scratch).total(),
        Probe::Momentum(k) if k < 3 => momentum(model, seen.scratch).ang[k],
        Probe::Momentum(k) => momentum(model, seen.scratch).lin[k - 3],
        _ => return None,
    })
}

/// A measurement that depends on the commands; after kinematics with the accelerations.
pub(crate) fn of_response<R: Real>(seen: &Seen<'_, R>, response: Response<'_, R>, probe: Probe) -> Option<R> {
    Some(match probe {
        Probe::Acceleration(k) => response.accelerations[k],
        Probe::MotorTorqueNow(m) => response.motor_torque[m],
        Probe::Frame(FrameQuantity::Acceleration, frame, k) => {
            kinematics::frame_acceleration(seen.scratch, &attached(seen, frame)).lin[k]
        }
        _ => return None,
    })
}

fn attached<R: Real>(seen: &Seen<'_, R>, frame: usize) -> Attached<R> {
    let info = &seen.model.names().frames[frame];
    let rot = Mat3(info.pose.rot.0.map(|row| row.map(R::splat)));
    Attached { link: info.link, pose: Pose { rot, pos: Vec3(info.pose.pos.0.map(R::splat)) } }
}

fn of_frame<R: Real>(seen: &Seen<'_, R>, quantity: FrameQuantity, frame: usize, component: usize) -> R {
    let at = attached(seen, frame);
    let pose = || kinematics::frame_pose(seen.scratch, &at);
    match quantity {
        FrameQuantity::Position => pose().pos[component],
        FrameQuantity::Quaternion => {
            let q = Quat::from_matrix(&pose().rot);
            [q.w, q.xyz[0], q.xyz[1], q.xyz[2]][component]
        }
        FrameQuantity::Angles => kinematics::roll_pitch_yaw(&pose().rot)[component],
        FrameQuantity::Velocity => kinematics::frame_velocity(seen.scratch, &at).lin[component],
        FrameQuantity::AngularVelocity => kinematics::frame_velocity(seen.scratch, &at).ang[component],
        FrameQuantity::Acceleration => kinematics::frame_acceleration(seen.scratch, &at).lin[component],
        FrameQuantity::CenterOfMass => {
            let com = seen.model.names().frames[frame].body.map_or([0.0; 3], |(com, _)| com);
            pose().point(Vec3(com.map(R::splat)))[component]
        }
    }
}

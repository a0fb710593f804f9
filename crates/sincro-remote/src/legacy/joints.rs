//! Commands of the legacy API: joints.

use sincro_coppelia::api::SimApi;
use sincro_coppelia::api::convention::{matrix_of, pose_of_matrix};

use super::functions::{Call, Reply, after, reals};

pub(super) fn position(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals([sim.joint_position(call.handle()?)?])
}

pub(super) fn set_position(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_joint_position(call.handle()?, call.float(0)?))
}

pub(super) fn set_target_velocity(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_target_velocity(call.handle()?, call.float(0)?))
}

pub(super) fn set_target_position(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_target_position(call.handle()?, call.float(0)?))
}

pub(super) fn force(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    // as V-REP: 0 before the first step, and for a joint whose motor is off or missing
    reals([sim.joint_force(call.handle()?)?.unwrap_or(0.0)])
}

pub(super) fn target_force(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals([sim.target_force(call.handle()?)?])
}

pub(super) fn set_target_force(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_target_force(call.handle()?, call.float(0)?, false))
}

pub(super) fn matrix(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(matrix_of(&sim.joint_pose(call.handle()?)?))
}

pub(super) fn set_matrix(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let mut matrix = [0.0; 12];
    for (k, x) in matrix.iter_mut().enumerate() {
        *x = call.float(k)?;
    }
    after(sim.turn_ball_joint(call.handle()?, &pose_of_matrix(&matrix)))
}

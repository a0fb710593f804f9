//! Programs of a model's dynamics: step, rates, forward and inverse dynamics, Jacobians.

use sincro_dynamics::aba::{self, Input};
use sincro_dynamics::batch::{LaneWorlds, is_time_invariant, obstacle_to_programs};
use sincro_dynamics::ids::BodyId;
use sincro_dynamics::integrate::{Control, Extrapolated, FixedStep, Rk4, SemiImplicitEuler, System};
use sincro_dynamics::kinematics;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::mechanism::layout::Layout;
use sincro_dynamics::model::Model;
use sincro_dynamics::rnea;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{CompiledKind, MethodKind};
use sincro_math::Real;
use sincro_math::record::{Program, Recorded, record};
use sincro_scene::record::probe;

use crate::Obstacle;

/// Checks that the dynamics of `model` can be compiled for the fixed-step method `method`.
///
/// # Errors
///
/// [`Obstacle`] with the part of the model that switches or depends on time, or with a method that has no fixed step.
pub fn check(model: &Model<f64>, method: MethodKind) -> Result<(), Obstacle> {
    let unless = |part: Option<&str>| match part {
        Some(part) => Err(Obstacle::new(format!("the model has {part}"))),
        None => Ok(()),
    };
    // what no other method would mend comes first
    unless(obstacle_to_programs(model, MethodKind::Rk4))?;
    if !is_time_invariant(model) {
        return Err(Obstacle::new("a force or the wind depends on time"));
    }
    if method.controls_error() {
        return Err(Obstacle::new("the steps of a method with error control differ in length"));
    }
    unless(obstacle_to_programs(model, method))
}

/// Numbers of inputs of the programs of a model's step and rates, in their order: coordinates, velocities, rotor
/// states, commands.
#[must_use]
pub fn state_sizes(model: &Model<f64>) -> [usize; 4] {
    [model.n_q(), model.n_v(), model.n_rotor_states(), model.n_commands()]
}

/// Parts of a list of inputs, of the given sizes.
pub(crate) fn parts<R, const N: usize>(mut inputs: &[R], sizes: [usize; N]) -> [&[R]; N] {
    sizes.map(|n| {
        let (part, rest) = inputs.split_at(n);
        inputs = rest;
        part
    })
}

/// Records one step of length `h` `[s]` of worlds whose models differ in numbers alone. Inputs: see [`state_sizes`];
/// outputs: coordinates, velocities and rotor states after the step.
///
/// # Errors
///
/// [`Obstacle`]: [`check`] finds one, the models differ in more than numbers, or their step branches.
///
/// # Panics
///
/// If there is no model.
pub fn step(models: &[&Model<f64>], method: MethodKind, h: f64) -> Result<Program, Obstacle> {
    worlds(models, method, 0, |worlds, _| {
        worlds.step(0.0, h);
        [worlds.coordinates(), worlds.velocities(), worlds.rotors()].concat()
    })
}

/// Records the rates of change of one model's state: accelerations, then rates of the rotor states. Inputs: see
/// [`state_sizes`].
///
/// # Errors
///
/// As [`step`], for a method with fixed steps that takes springs at the present state.
pub fn rates(model: &Model<f64>) -> Result<Program, Obstacle> {
    worlds(&[model], MethodKind::Rk4, 0, |worlds, _| worlds.rates(0.0))
}

/// Records what `act` makes of worlds whose models differ in numbers alone: it gets them in the state of the inputs
/// ([`state_sizes`]), and the `n_more` inputs that follow.
///
/// # Errors
///
/// As [`step`], of what `act` does with the worlds.
///
/// # Panics
///
/// If there is no model.
pub fn worlds(
    models: &[&Model<f64>],
    method: MethodKind,
    n_more: usize,
    act: impl FnOnce(&mut LaneWorlds<Recorded>, &[Recorded]) -> Vec<Recorded>,
) -> Result<Program, Obstacle> {
    models.iter().try_for_each(|model| check(model, method))?;
    let sizes = state_sizes(models[0]);
    let mut different = None;
    let n_state: usize = sizes.iter().sum();
    let program = record(n_state + n_more, models.len(), |inputs| {
        let (state, more) = inputs.split_at(n_state);
        let [q, v, rotors, commands] = parts(state, sizes);
        match LaneWorlds::new(models, method) {
            Ok(mut worlds) => {
                worlds.set_state(q, v, rotors, commands);
                act(&mut worlds, more)
            }
            Err(error) => {
                different = Some(error);
                Vec::new()
            }
        }
    });
    match different {
        Some(error) => Err(Obstacle::new(error.to_string())),
        None => Ok(program?),
    }
}

/// Records the equations of a single world, with work, dissipation and motor impulses if it `tracks_totals`. Inputs and
/// outputs: see [`CompiledKind`].
///
/// # Errors
///
/// As [`step`]. A right-hand side is that of any explicit method.
pub fn equations(
    model: &Model<f64>,
    method: MethodKind,
    kind: CompiledKind,
    tracks_totals: bool,
) -> Result<Program, Obstacle> {
    match (kind, method) {
        (CompiledKind::Slope, MethodKind::Stiff | MethodKind::Implicit | MethodKind::SemiImplicitEuler) => {
            return Err(Obstacle::new("its method is implicit, and takes no right-hand side"));
        }
        (CompiledKind::Slope, _) => check(model, MethodKind::Rk4)?,
        (CompiledKind::Step { .. }, _) => check(model, method)?,
    }
    if method == MethodKind::SemiImplicitEuler && model.n_drives() > 0 {
        return Err(Obstacle::new("a drive reaches its velocity within a step of semi-implicit Euler"));
    }
    let dim = Layout::new(model, tracks_totals).dim();
    let n_inputs = model.n_q() + dim + model.n_commands();
    let program = record(n_inputs, 1, |inputs| {
        let model = Model::<Recorded>::pack(&[model]).expect("a model has its own structure");
        let [q, unknowns, commands] = parts(inputs, [model.n_q(), dim, model.n_commands()]);
        let mut mechanism = Mechanism::new(model, tracks_totals);
        let mut state = State::new(mechanism.model());
        state.q.copy_from_slice(q);
        state.commands.copy_from_slice(commands);
        let (mut y, displacement) = (vec![Recorded::zero(); dim], mechanism.layout().displacement());
        mechanism.load(&state, &mut y);
        mechanism.mark_locked();
        y.copy_from_slice(unknowns);
        let CompiledKind::Step { h } = kind else {
            let mut slope = vec![Recorded::zero(); dim];
            mechanism.slope(0.0, &y, &mut slope);
            return slope;
        };
        y[displacement].fill(Recorded::zero());
        match method {
            MethodKind::SemiImplicitEuler => SemiImplicitEuler::new(dim).step(&mut mechanism, 0.0, h, &mut y),
            MethodKind::Rk4 => Rk4::new(dim).step(&mut mechanism, 0.0, h, &mut y),
            // two rows, as a world has them; the control is that of variable steps
            _ => Extrapolated::new(dim, 2, Control::new(1.0, h)).step(&mut mechanism, 0.0, h, &mut y),
        }
        mechanism.store(&y, &mut state);
        [state.q, y].concat()
    });
    Ok(program?)
}

/// Records the forward dynamics of the bare mechanism: accelerations (n_v) of coordinates (n_q), velocities (n_v) and
/// joint torques (n_v), under gravity, without springs, dampers, motors and air; motors' armature counts.
///
/// # Errors
///
/// [`Obstacle`] if the recursion branches.
pub fn forward_dynamics(model: &Model<f64>) -> Result<Program, Obstacle> {
    mechanism(model, model.n_q() + 2 * model.n_v(), bare_forward_dynamics)
}

/// Records the inverse dynamics of the bare mechanism: joint torques (n_v) of coordinates (n_q), velocities (n_v) and
/// accelerations (n_v); the inverse of [`forward_dynamics`].
///
/// # Errors
///
/// [`Obstacle`] if the recursion branches.
pub fn inverse_dynamics(model: &Model<f64>) -> Result<Program, Obstacle> {
    mechanism(model, model.n_q() + 2 * model.n_v(), bare_inverse_dynamics)
}

/// Records the pose of a body's or frame's origin: position `[m]` (3), then rotation matrix (9, row by row), then its
/// Jacobian (6 rows of n_v: angular, then linear velocity in world axes), of coordinates (n_q).
///
/// # Errors
///
/// [`Obstacle`] if the recursion branches.
///
/// # Panics
///
/// If the model has no such body.
pub fn frame(model: &Model<f64>, frame: BodyId) -> Result<Program, Obstacle> {
    mechanism(model, model.n_q(), |model, q| pose_and_jacobian(model, q, frame))
}

/// Algorithm of [`forward_dynamics`], on any kind of number.
pub(crate) fn bare_forward_dynamics<R: Real>(model: &Model<R>, inputs: &[R]) -> Vec<R> {
    let [q, v, torque] = parts(inputs, [model.n_q(), model.n_v(), model.n_v()]);
    let diagonal: Vec<R> = model.dofs().iter().map(|dof| dof.armature).collect();
    let input = Input { q, v, torque, diagonal: &diagonal, prescribed: None, external: None, gravity: true };
    let mut v_dot = vec![R::zero(); model.n_v()];
    aba::forward_dynamics(model, &input, &mut Scratch::new(model), &mut v_dot);
    v_dot
}

/// Algorithm of [`inverse_dynamics`], on any kind of number.
pub(crate) fn bare_inverse_dynamics<R: Real>(model: &Model<R>, inputs: &[R]) -> Vec<R> {
    let [q, v, v_dot] = parts(inputs, [model.n_q(), model.n_v(), model.n_v()]);
    let mut torque = vec![R::zero(); model.n_v()];
    rnea::inverse_dynamics(model, q, v, v_dot, None, &mut Scratch::new(model), &mut torque);
    for ((torque, dof), v_dot) in torque.iter_mut().zip(model.dofs()).zip(v_dot) {
        *torque += dof.armature * *v_dot;
    }
    torque
}

/// Algorithm of [`frame`], on any kind of number.
pub(crate) fn pose_and_jacobian<R: Real>(model: &Model<R>, q: &[R], frame: BodyId) -> Vec<R> {
    let attached = probe::attached(model, frame.index());
    let mut scratch = Scratch::new(model);
    kinematics::poses(model, q, &mut scratch);
    let pose = kinematics::frame_pose(&scratch, &attached);
    let mut rows = vec![R::zero(); 6 * model.n_v()];
    kinematics::jacobian(model, q, &attached, &mut scratch, &mut rows);
    [&pose.pos.0[..], &pose.rot.0.concat(), &rows].concat()
}

/// Records `algorithm` on `model` and `n_inputs` numbers.
pub(crate) fn mechanism(
    model: &Model<f64>,
    n_inputs: usize,
    algorithm: impl FnOnce(&Model<Recorded>, &[Recorded]) -> Vec<Recorded>,
) -> Result<Program, Obstacle> {
    let program = record(n_inputs, 1, |inputs| {
        let model = Model::<Recorded>::pack(&[model]).expect("a model has its own structure");
        algorithm(&model, inputs)
    });
    Ok(program?)
}

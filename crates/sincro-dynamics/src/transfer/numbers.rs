//! Parameters, coordinates, velocities, modes, currents and totals, by the names of what they belong to.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Origin;
use crate::actuation::{Drive, DriveKind};
use crate::ids::{BodyId, MotorId};
use crate::model::{JointInfo, Model};
use crate::state::State;

/// Correspondence of the parts of the new model to those of the former one.
pub(super) struct Correspondence {
    /// Joint, and true if it is the same one.
    pub joints: Vec<Option<(usize, bool)>>,
    /// Body or frame, and true if it is the same one.
    pub frames: Vec<Option<(usize, bool)>>,
    /// Motor.
    pub motors: Vec<Option<usize>>,
    /// Command.
    pub commands: Vec<Option<usize>>,
    /// Rotor, and true if it is the same one.
    rotors: Vec<Option<(usize, bool)>>,
}

impl Correspondence {
    pub fn new(former: &Model<f64>, model: &Model<f64>, origin: &dyn Fn(&str) -> Option<Origin>) -> Self {
        let (old, new) = (former.names(), model.names());
        let places = |names: Vec<&str>| -> BTreeMap<String, usize> {
            names.into_iter().enumerate().map(|(k, name)| (name.to_owned(), k)).collect()
        };
        let of = |known: &BTreeMap<String, usize>, name: &str| {
            let origin = origin(name)?;
            known.get(&origin.name).map(|k| (*k, origin.is_same))
        };
        let old_joints = places(old.joints.iter().map(|j| j.name.as_str()).collect());
        let old_frames = places(old.frames.iter().map(|f| f.name.as_str()).collect());
        let old_rotors = places(old.rotors.iter().map(String::as_str).collect());
        let same_kind = |joint: &JointInfo, k: usize| {
            let other = &old.joints[k];
            (joint.n_q, joint.n_v) == (other.n_q, other.n_v)
                && std::mem::discriminant(&joint.kind) == std::mem::discriminant(&other.kind)
        };
        let joint_of = |joint: &JointInfo| of(&old_joints, &joint.name).filter(|(k, _)| same_kind(joint, *k));
        let joints: Vec<Option<(usize, bool)>> = new.joints.iter().map(joint_of).collect();
        let frames = new.frames.iter().map(|frame| of(&old_frames, &frame.name)).collect();
        let rotors: Vec<Option<(usize, bool)>> = new.rotors.iter().map(|name| of(&old_rotors, name)).collect();
        let mut motors = vec![None; model.motors().len()];
        for (joint, found) in new.joints.iter().zip(&joints) {
            let Some((k, _)) = *found else { continue };
            for (own, other) in joint.motors().zip(old.joints[k].motors()) {
                motors[own.index()] = Some(other.index());
            }
        }
        let commands = commands(former, model, origin, &motors, &rotors);
        Self { joints, frames, motors, commands, rotors }
    }
}

/// Former command of each command.
fn commands(
    former: &Model<f64>,
    model: &Model<f64>,
    origin: &dyn Fn(&str) -> Option<Origin>,
    motors: &[Option<usize>],
    rotors: &[Option<(usize, bool)>],
) -> Vec<Option<usize>> {
    let mut commands = vec![None; model.n_commands()];
    commands[..motors.len()].copy_from_slice(motors);
    let place = |list: &[String], name: &str| {
        let origin = origin(name)?;
        list.iter().position(|known| *known == origin.name)
    };
    let first_input = |model: &Model<f64>| model.motors().len();
    for (k, name) in model.names().inputs.iter().enumerate() {
        if let Some(old) = place(&former.names().inputs, name) {
            for c in 0..6 {
                commands[first_input(model) + 6 * k + c] = Some(first_input(former) + 6 * old + c);
            }
        }
    }
    for (rotor, found) in model.rotors().iter().zip(rotors) {
        if let (Some(command), Some((old, _))) = (rotor.speed.command(), *found) {
            commands[command] = former.rotors()[old].speed.command();
        }
    }
    for (line, name) in model.spring_dampers().iter().zip(&model.names().spring_dampers) {
        let old = place(&former.names().spring_dampers, name);
        if let (Some(actuator), Some(old)) = (line.actuator, old) {
            commands[actuator.command] = former.spring_dampers()[old].actuator.map(|actuator| actuator.command);
        }
    }
    commands
}

/// Motors, masses, gravity, limits and gears are as they were last set.
pub(super) fn transfer_params(former: &Model<f64>, model: &mut Model<f64>, names: &Correspondence) {
    model.params.gravity = former.params.gravity;
    for (k, old) in names.motors.iter().enumerate() {
        if let Some(old) = old {
            model.set_motor(MotorId::new(k), former.motors()[*old]);
        }
    }
    for (k, old) in names.frames.iter().enumerate() {
        if let Some((old, _)) = old
            && let Some(mass) = former.params.masses[*old]
            && model.params.masses[k].is_some_and(|own| own != mass)
        {
            model.set_mass_properties(BodyId::new(k), mass);
        }
    }
    let dof_of = |dof: usize| former_dof(former, model, names, dof);
    let mut set = (*model.params.constraints).clone();
    for limit in &mut set.limits {
        let same = |old: &&crate::model::Limit| Some(old.dof) == dof_of(limit.dof) && old.sign == limit.sign;
        if let Some(old) = former.constraints().limits.iter().find(same) {
            limit.bound = old.bound;
        }
    }
    for gear in &mut set.gears {
        let dofs = gear.dofs.map(dof_of);
        // another polynomial is another law: its ratio and offset go with its higher powers
        let same = |old: &&crate::model::GearConstraint| old.dofs.map(Some) == dofs && old.higher == gear.higher;
        if let Some(old) = former.constraints().gears.iter().find(same) {
            (gear.ratio, gear.offset) = (old.ratio, old.offset);
        }
    }
    if set != *model.params.constraints {
        model.params.constraints = Arc::new(set);
    }
}

/// Degree of freedom of the former model that one of the new model was.
fn former_dof(former: &Model<f64>, model: &Model<f64>, names: &Correspondence, dof: usize) -> Option<usize> {
    let joint = model.names().dof_joint.get(dof)?.index();
    let (old, _) = names.joints[joint]?;
    Some(former.names().joints[old].v_idx + dof - model.names().joints[joint].v_idx)
}

/// State of the new model: of what it shares with the former one as it was there, else `initial`.
pub(super) fn transfer_state(
    (former, before): (&Model<f64>, &State<f64>),
    (model, initial): (&Model<f64>, State<f64>),
    names: &Correspondence,
) -> State<f64> {
    let mut state = initial;
    state.tick = before.tick;
    for (joint, found) in model.names().joints.iter().zip(&names.joints) {
        let Some((old, is_same)) = *found else { continue };
        let other = &former.names().joints[old];
        state.q[joint.q_idx..][..joint.n_q].copy_from_slice(&before.q[other.q_idx..][..joint.n_q]);
        let v = &mut state.v[joint.v_idx..][..joint.n_v];
        if is_same {
            v.copy_from_slice(&before.v[other.v_idx..][..joint.n_v]);
        } else {
            v.fill(0.0);
        }
    }
    for (k, old) in names.commands.iter().enumerate() {
        if let Some(old) = old {
            state.commands[k] = before.commands[*old];
        }
    }
    state.drives = model.drives().iter().map(|drive| former_mode(drive, (former, before), model, names)).collect();
    state.totals = vec![0.0; 2 + model.motors().len()];
    state.totals[..2].copy_from_slice(&before.totals[..2]);
    for (k, old) in names.motors.iter().enumerate() {
        state.totals[2 + k] = old.map_or(0.0, |old| before.totals[2 + old]);
    }
    for (rotor, found) in model.rotors().iter().zip(&names.rotors) {
        let Some((old, true)) = *found else { continue };
        if let (Some(own), Some(other)) = (rotor.speed.state(), former.rotors()[old].speed.state()) {
            state.rotors[own] = before.rotors[other];
        }
    }
    for winding in model.windings() {
        let old = names.motors[winding.motor];
        let other = former.windings().iter().find(|w| Some(w.motor) == old);
        if let (Some(own), Some(other)) = (winding.state, other.and_then(|w| w.state)) {
            state.rotors[own] = before.rotors[other];
        }
    }
    for activation in model.activations() {
        let old = names.commands[activation.command];
        if let Some(other) = former.activations().iter().find(|other| Some(other.command) == old) {
            state.rotors[activation.state] = activation.saturated(before.rotors[other.state]);
        }
    }
    state
}

/// Mode of a drive as it was; locked if it is new.
fn former_mode(
    drive: &Drive,
    (former, before): (&Model<f64>, &State<f64>),
    model: &Model<f64>,
    names: &Correspondence,
) -> f64 {
    let Some(dof) = former_dof(former, model, names, drive.dof) else { return 0.0 };
    let kind = match drive.kind {
        DriveKind::Motor(motor) => match names.motors[motor.index()] {
            Some(old) => DriveKind::Motor(MotorId::new(old)),
            None => return 0.0,
        },
        other => other,
    };
    let place = former.drives().iter().position(|old| *old == Drive { dof, kind });
    place.and_then(|k| before.drives.get(k).copied()).unwrap_or(0.0)
}

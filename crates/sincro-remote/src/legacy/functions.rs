//! Commands of the legacy API: simulation, joints, signals, parameters.

use sincro_coppelia::session::{ApiError, Handle, Search, SimApi};

use super::message::{float, int, text};
use super::{files, group, objects, seeing, sensing};
use crate::hub::SessionGuard;

/// `simxGetObjectHandle`
pub(super) const GET_HANDLE: u16 = 0x3001;

/// A command as a function sees it.
#[derive(Clone, Copy)]
pub(super) struct Call<'a> {
    pub function: u16,
    pub ident: &'a [u8],
    pub data: &'a [u8],
}

/// Data of a reply.
pub(super) type Reply = Result<Vec<u8>, ApiError>;

impl<'a> Call<'a> {
    /// The object that the identification begins with.
    pub fn handle(&self) -> Result<Handle, ApiError> {
        Ok(Handle(self.ident_int(0)?))
    }

    pub fn ident_int(&self, k: usize) -> Result<i32, ApiError> {
        int(self.ident, 4 * k).ok_or_else(|| ApiError::new("the identification is shorter than it should be"))
    }

    pub fn name(&self) -> Result<&'a str, ApiError> {
        text(self.ident).map(|(text, _)| text).ok_or_else(|| ApiError::new("the name is not UTF-8"))
    }

    pub fn int(&self, at: usize) -> Result<i32, ApiError> {
        int(self.data, at).ok_or_else(short)
    }

    pub fn float(&self, at: usize) -> Result<f64, ApiError> {
        float(self.data, at).ok_or_else(short)
    }

    pub fn floats<const N: usize>(&self, at: usize) -> Result<[f64; N], ApiError> {
        super::message::floats(self.data, at).ok_or_else(short)
    }
}

fn short() -> ApiError {
    ApiError::new("the data is shorter than it should be")
}

pub(super) fn done() -> Reply {
    Ok(Vec::new())
}

pub(super) fn ints(list: impl IntoIterator<Item = i32>) -> Reply {
    Ok(list.into_iter().flat_map(i32::to_le_bytes).collect())
}

pub(super) fn reals(list: impl IntoIterator<Item = f64>) -> Reply {
    Ok(list.into_iter().flat_map(|x| (x as f32).to_le_bytes()).collect())
}

/// A handle list with its length before it.
pub(super) fn counted(list: &[Handle]) -> Reply {
    ints([list.len() as i32].into_iter().chain(list.iter().map(|h| h.0)))
}

/// Runs a function.
pub(super) fn run(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    match call.function {
        0x1007 => simulation(guard, call),
        function if files::COMMANDS.contains(&function) => files::run(guard, call),
        0x3401 => super::script::run(guard, call),
        0x0005 => {
            guard.act(sincro_coppelia::session::Session::stop)?;
            done()
        }
        _ => on_sim_api(&mut guard.session.sim(), call),
    }
}

fn simulation(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let what = call.ident_int(0)?;
    guard.act(|session| match what {
        0 => session.start(),
        1 => session.pause(),
        2 => {
            session.registry().stop_requests += 1;
            session.stop()
        }
        _ => Err(ApiError(format!("{what} is neither start 0 nor pause 1 nor stop 2"))),
    })?;
    done()
}

fn on_sim_api(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    if let Some(reply) = sensing::run(sim, call) {
        return reply;
    }
    if let Some(reply) = seeing::run(sim, call) {
        return reply;
    }
    match call.function {
        0x0001..=0x0fff
        | 0x1012
        | 0x1018..=0x101c
        | 0x1028
        | 0x102a
        | 0x102f
        | 0x1036
        | 0x1801
        | 0x200b..=0x200e
        | 0x2801
        | GET_HANDLE
        | 0x1034
        | 0x1035
        | 0x2007..=0x200a
        | 0x1037
        | 0x3019 => {
            if call.function == 0x200c {
                group::run(sim, call)
            } else {
                objects::run(sim, call)
            }
        }
        0x1001..0x1010 | 0x1038 => joint(sim, call),
        0x101d..=0x1025 => parameter(sim, call),
        0x300d..=0x3018 => signal(sim, call),
        0x3008 => {
            sim.log(450, call.name()?);
            done()
        }
        other => Err(ApiError(format!("command 0x{other:04x} is not offered here"))),
    }
}

fn joint(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let joint = call.handle()?;
    match call.function {
        0x1001 => reals([sim.joint_position(joint)?]),
        0x1002 => sim.set_joint_position(joint, call.float(0)?).and_then(|()| done()),
        0x1008 => sim.set_target_velocity(joint, call.float(0)?).and_then(|()| done()),
        0x100c => sim.set_target_position(joint, call.float(0)?).and_then(|()| done()),
        0x100d => {
            let force = sim.joint_force(joint)?;
            reals([force.ok_or_else(|| ApiError::new("there is no force before the first step, nor without a motor"))?])
        }
        0x1038 => reals([sim.target_force(joint)?]),
        0x100e => sim.set_target_force(joint, call.float(0)?, false).and_then(|()| done()),
        0x100a => {
            let pose = sim.joint_pose(joint)?;
            reals(sincro_coppelia::session::convention::matrix_of(&pose))
        }
        other => Err(ApiError(format!("command 0x{other:04x} is not offered here"))),
    }
}

fn parameter(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let id = i64::from(call.ident_int(0)?);
    match call.function {
        0x1021 => ints([i32::try_from(sim.int_parameter(id)?).unwrap_or(i32::MAX)]),
        // what belongs to windows: taken, and of no effect here
        0x1022 => call.int(0).and_then(|_| sim.set_int_parameter(id)).and_then(|()| done()),
        0x1023 => reals([sim.float_parameter(id)?]),
        // what a client means by a float is the nearest number that the base step has a multiple of
        0x1024 => sim.set_float_parameter(id, call.float(0)?).and_then(|()| done()),
        0x101f => ints([i32::from(sim.bool_parameter(id)?)]),
        // display and real time: taken, and of no effect here
        0x1020 => sim.bool_parameter(id).and_then(|_| call.int(0)).and_then(|_| done()),
        0x101d => reals(sim.array_parameter(id)?),
        0x101e => sim.set_array_parameter(id, call.floats(0)?).and_then(|()| done()),
        0x1025 => {
            let mut text = sim.string_parameter(id)?.into_bytes();
            text.push(0);
            Ok(text)
        }
        other => Err(ApiError(format!("command 0x{other:04x} is not offered here"))),
    }
}

fn signal(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (name, of_run) = (call.name()?, sim.is_running());
    let unset = || ApiError(format!("there is no signal `{name}`"));
    let registry = &mut *sim.registry;
    if matches!(call.function, 0x3015 | 0x3016) {
        registry.make_room(call.data.len())?;
    }
    match call.function {
        0x3010 => reals([*registry.floats.get(name).ok_or_else(unset)?]),
        0x3013 => registry.floats.set(name, call.float(0)?, of_run).and_then(|()| done()),
        0x300d => clear(registry.floats.clear(name)),
        0x3011 => {
            let x = *registry.integers.get(name).ok_or_else(unset)?;
            ints([x.clamp(i32::MIN.into(), i32::MAX.into()) as i32])
        }
        0x3014 => registry.integers.set(name, call.int(0)?.into(), of_run).and_then(|()| done()),
        0x300e => clear(registry.integers.clear(name)),
        0x3012 => registry.strings.get(name).cloned().ok_or_else(unset),
        0x3015 => registry.strings.set(name, call.data.to_vec(), of_run).and_then(|()| done()),
        0x300f => clear(registry.strings.clear(name)),
        0x3016 => registry.strings.append(name, call.data, of_run).and_then(|()| done()),
        0x3017 => {
            let bytes = registry.strings.get(name).cloned().ok_or_else(unset)?;
            registry.strings.clear(name);
            Ok(bytes)
        }
        _ => {
            let bytes = registry.strings.get(name).cloned().unwrap_or_default();
            if !bytes.is_empty() {
                registry.strings.clear(name);
            }
            Ok(bytes)
        }
    }
}

fn clear(_n: usize) -> Reply {
    done()
}

/// The object of a name or path.
pub(super) fn find(sim: &SimApi<'_>, name: &str) -> Result<Handle, ApiError> {
    sim.registry.find(name, Search::default())
}

//! Commands of the legacy API: objects, their poses and their tree.

use sincro_coppelia::session::convention::{euler_of, quaternion_of, rotation_of_euler, rotation_of_quaternion};
use sincro_coppelia::session::{ApiError, Handle, Reference, SimApi};
use sincro_coppelia::session::{Pose, Vec3};

use super::functions::{Call, GET_HANDLE, Reply, counted, done, find, ints, reals};

/// Runs a function.
pub(super) fn run(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    match call.function {
        GET_HANDLE => ints([find(sim, call.name()?)?.0]),
        // a collection by name, or an int signal of that name
        0x3019 => {
            let name = call.name()?;
            let known = sim.registry.collection_named(name.strip_suffix('#').unwrap_or(name)).map(|h| h.0);
            let known = known.or_else(|| sim.registry.integers.get(name).map(|n| *n as i32));
            ints([known.ok_or_else(|| ApiError::new("there is no such collection"))?])
        }
        0x0006 => counted(&[]),
        0x102f => done(),
        0x0009 => ints([sim.registry.create_dummy("Dummy")?.0]),
        0x1028 | 0x1037 => sim.remove(call.handle()?).and_then(|()| done()),
        0x1012 => ints([sim.registry.entry(call.handle()?)?.parent.map_or(-1, |h| h.0)]),
        0x200b => child(sim, call),
        0x101c => {
            let parent = call.int(0)?;
            let keep = call.data.get(4).is_none_or(|b| *b != 0);
            sim.set_parent(call.handle()?, (parent != -1).then_some(Handle(parent)), keep)?;
            done()
        }
        0x102a => counted(&sim.objects_of_type(call.ident_int(0)?.into())),
        0x1034 => sim.registry.entry(call.handle()?).and_then(|_| ints([0])),
        0x2007 => reals([sim.object_float(call.handle()?, call.ident_int(1)?.into())?]),
        0x2009 => sim.set_object_float(call.handle()?, call.ident_int(1)?.into(), call.float(0)?).and_then(|()| done()),
        0x2008 => ints([sim.object_int(call.handle()?, call.ident_int(1)?.into())? as i32]),
        0x200a => {
            sim.set_object_int(call.handle()?, call.ident_int(1)?.into(), call.int(0)?.into())?;
            done()
        }
        0x1036 => {
            let (linear, angular) = sim.velocity(call.handle()?)?;
            reals(linear.into_iter().chain(angular))
        }
        0x200d | 0x200e | 0x2801 | 0x1018 | 0x1019 => pose(sim, call),
        0x101a | 0x101b | 0x1801 => set_pose(sim, call),
        other => Err(ApiError(format!("command 0x{other:04x} is not offered here"))),
    }
}

/// Reference frame of −1, −11 or a handle.
pub(super) fn reference(number: i32) -> Reference {
    match number {
        -1 => Reference::World,
        -11 => Reference::Parent,
        handle => Reference::Object(Handle(handle)),
    }
}

fn child(sim: &SimApi<'_>, call: &Call<'_>) -> Reply {
    let (parent, index) = (call.handle()?, call.ident_int(1)?);
    sim.registry.entry(parent)?;
    let index = usize::try_from(index).map_err(|_| ApiError::new("the index is negative"))?;
    ints([sim.registry.children(Some(parent)).nth(index).map_or(-1, |e| e.handle.0)])
}

fn pose(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let old = matches!(call.function, 0x1018 | 0x1019);
    let against = if old { call.int(0)? } else { call.ident_int(1)? };
    let pose = sim.pose(call.handle()?, reference(against))?;
    match call.function {
        0x200e | 0x1019 => reals(pose.pos.0),
        0x200d | 0x1018 => reals(euler_of(&pose.rot)),
        _ => reals(quaternion_of(&pose.rot)),
    }
}

fn set_pose(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (object, against) = (call.handle()?, reference(call.int(0)?));
    let before = sim.pose(object, against)?;
    let pose = match call.function {
        0x101b => Pose { pos: Vec3(call.floats(4)?), ..before },
        0x101a => Pose { rot: rotation_of_euler(call.floats(4)?), ..before },
        _ => {
            let rot = rotation_of_quaternion(call.floats(4)?);
            Pose { rot: rot.ok_or_else(|| ApiError::new("the quaternion has no direction"))?, ..before }
        }
    };
    sim.set_pose(object, &pose, against)?;
    done()
}

//! What the commands of the legacy API do: objects, their poses and their tree.

use sincro_coppelia::session::convention::{euler_of, quaternion_of, rotation_of_euler, rotation_of_quaternion};
use sincro_coppelia::session::{Desk, Handle, Reference, Refusal};
use sincro_coppelia::session::{Pose, Vec3};

use super::functions::{Call, GET_HANDLE, Reply, counted, done, find, ints, reals};

/// Runs a function.
pub(super) fn run(desk: &mut Desk<'_>, call: &Call<'_>) -> Reply {
    match call.function {
        GET_HANDLE => ints([find(desk, call.name()?)?.0]),
        // a collection by name, or an int signal of that name
        0x3019 => {
            let name = call.name()?;
            let known = desk.table.collection_named(name.strip_suffix('#').unwrap_or(name)).map(|h| h.0);
            let known = known.or_else(|| desk.table.integers.get(name).map(|n| *n as i32));
            ints([known.ok_or_else(|| Refusal::new("there is no such collection"))?])
        }
        0x0006 => counted(&[]),
        0x102f => done(),
        0x0009 => ints([desk.table.create_dummy("Dummy")?.0]),
        0x1028 | 0x1037 => desk.remove(call.handle()?).and_then(|()| done()),
        0x1012 => ints([desk.table.entry(call.handle()?)?.parent.map_or(-1, |h| h.0)]),
        0x200b => child(desk, call),
        0x101c => {
            let parent = call.int(0)?;
            let keep = call.data.get(4).is_none_or(|b| *b != 0);
            desk.set_parent(call.handle()?, (parent != -1).then_some(Handle(parent)), keep)?;
            done()
        }
        0x102a => counted(&desk.objects_of_type(call.ident_int(0)?.into())),
        0x1034 => desk.table.entry(call.handle()?).and_then(|_| ints([0])),
        0x2007 => reals([desk.object_float(call.handle()?, call.ident_int(1)?.into())?]),
        0x2009 => {
            desk.set_object_float(call.handle()?, call.ident_int(1)?.into(), call.float(0)?).and_then(|()| done())
        }
        0x2008 => ints([desk.object_int(call.handle()?, call.ident_int(1)?.into())? as i32]),
        0x200a => {
            desk.set_object_int(call.handle()?, call.ident_int(1)?.into(), call.int(0)?.into())?;
            done()
        }
        0x1036 => {
            let (linear, angular) = desk.velocity(call.handle()?)?;
            reals(linear.into_iter().chain(angular))
        }
        0x200d | 0x200e | 0x2801 | 0x1018 | 0x1019 => pose(desk, call),
        0x101a | 0x101b | 0x1801 => set_pose(desk, call),
        other => Err(Refusal(format!("command 0x{other:04x} is not offered here"))),
    }
}

/// What −1, −11 and handles mean.
pub(super) fn reference(number: i32) -> Reference {
    match number {
        -1 => Reference::World,
        -11 => Reference::Parent,
        handle => Reference::Object(Handle(handle)),
    }
}

fn child(desk: &Desk<'_>, call: &Call<'_>) -> Reply {
    let (parent, index) = (call.handle()?, call.ident_int(1)?);
    desk.table.entry(parent)?;
    let index = usize::try_from(index).map_err(|_| Refusal::new("the index is negative"))?;
    ints([desk.table.children(Some(parent)).nth(index).map_or(-1, |e| e.handle.0)])
}

fn pose(desk: &mut Desk<'_>, call: &Call<'_>) -> Reply {
    let old = matches!(call.function, 0x1018 | 0x1019);
    let against = if old { call.int(0)? } else { call.ident_int(1)? };
    let pose = desk.pose(call.handle()?, reference(against))?;
    match call.function {
        0x200e | 0x1019 => reals(pose.pos.0),
        0x200d | 0x1018 => reals(euler_of(&pose.rot)),
        _ => reals(quaternion_of(&pose.rot)),
    }
}

fn set_pose(desk: &mut Desk<'_>, call: &Call<'_>) -> Reply {
    let (object, against) = (call.handle()?, reference(call.int(0)?));
    let before = desk.pose(object, against)?;
    let pose = match call.function {
        0x101b => Pose { pos: Vec3(call.floats(4)?), ..before },
        0x101a => Pose { rot: rotation_of_euler(call.floats(4)?), ..before },
        _ => {
            let rot = rotation_of_quaternion(call.floats(4)?);
            Pose { rot: rot.ok_or_else(|| Refusal::new("the quaternion has no direction"))?, ..before }
        }
    };
    desk.set_pose(object, &pose, against)?;
    done()
}

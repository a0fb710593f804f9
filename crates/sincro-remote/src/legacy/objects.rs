//! Commands of the legacy API: objects, their poses and their tree.

use sincro_coppelia::api::convention::{euler_of, quaternion_of, rotation_of_euler, rotation_of_quaternion};
use sincro_coppelia::api::{ApiError, Handle, Reference, Search, SimApi};
use sincro_coppelia::api::{Pose, Vec3};

use super::functions::{Call, Reply, after, counted, done, ints, reals};

pub(super) fn handle(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    ints([sim.registry.find(call.name()?, Search::default())?.0])
}

/// A collection by name, or an int signal of that name.
pub(super) fn collection(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    let known = sim.registry.collection_named(name.strip_suffix('#').unwrap_or(name)).map(|h| h.0);
    let known = known.or_else(|| sim.registry.integers.get(name).map(|n| *n as i32));
    ints([known.ok_or_else(|| ApiError::new("there is no such collection"))?])
}

/// Objects of a type.
pub(super) fn of_type(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    counted(&sim.objects_of_type(call.ident_int(0)?.into()))
}

/// Objects that are selected.
pub(super) fn selection(sim: &mut SimApi<'_>, _: &Call<'_>) -> Reply {
    counted(&sim.registry.selected())
}

/// Takes a selection, without effect.
pub(super) fn select(_: &mut SimApi<'_>, _: &Call<'_>) -> Reply {
    done()
}

pub(super) fn create_dummy(sim: &mut SimApi<'_>, _: &Call<'_>) -> Reply {
    ints([sim.registry.create_dummy("Dummy")?.0])
}

/// Copies of objects.
pub(super) fn copies(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let handles = (0..call.data.len() / 4).map(|k| call.int(4 * k).map(Handle)).collect::<Result<Vec<_>, _>>()?;
    let copies = sim.copy_objects(&handles, false)?;
    counted(&copies)
}

pub(super) fn remove(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.remove_objects(&[call.handle()?], false))
}

/// An object with all below it.
pub(super) fn remove_model(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.remove_objects(&[call.handle()?], true))
}

pub(super) fn parent(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let own = sim.registry.entry(call.handle()?)?.handle;
    ints([sim.registry.visible_parent(own).map_or(-1, |h| h.0)])
}

pub(super) fn set_parent(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let parent = call.int(0)?;
    let keep = call.data.get(4).is_none_or(|b| *b != 0);
    after(sim.set_parent(call.handle()?, (parent != -1).then_some(Handle(parent)), keep))
}

pub(super) fn child(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (parent, index) = (call.handle()?, call.ident_int(1)?);
    sim.registry.entry(parent)?;
    let index = usize::try_from(index).map_err(|_| ApiError::new("the index is negative"))?;
    ints([sim.registry.visible_children(Some(parent)).nth(index).map_or(-1, |e| e.handle.0)])
}

pub(super) fn model_property(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    ints([sim.registry.model_property(call.handle()?)? as i32])
}

pub(super) fn set_model_property(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_model_property(call.handle()?, call.int(0)?.into()))
}

pub(super) fn float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals([sim.object_float(call.handle()?, call.ident_int(1)?.into())?])
}

pub(super) fn set_float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_object_float(call.handle()?, call.ident_int(1)?.into(), call.float(0)?))
}

pub(super) fn int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    ints([sim.object_int(call.handle()?, call.ident_int(1)?.into())? as i32])
}

pub(super) fn set_int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_object_int(call.handle()?, call.ident_int(1)?.into(), call.int(0)?.into()))
}

pub(super) fn velocity(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (linear, angular) = sim.velocity(call.handle()?)?;
    reals(linear.into_iter().chain(angular))
}

/// Reference frame of −1, −11 or a handle.
pub(super) fn reference(number: i32) -> Reference {
    match number {
        -1 => Reference::World,
        -11 => Reference::Parent,
        handle => Reference::Object(Handle(handle)),
    }
}

/// Pose with the reference frame in the identification.
fn pose(sim: &mut SimApi<'_>, call: &Call<'_>) -> Result<Pose<f64>, ApiError> {
    let against = call.ident_int(1)?;
    sim.pose(call.handle()?, reference(against))
}

/// Pose with the reference frame in the data, as older clients ask for it.
fn old_pose(sim: &mut SimApi<'_>, call: &Call<'_>) -> Result<Pose<f64>, ApiError> {
    let against = call.int(0)?;
    sim.pose(call.handle()?, reference(against))
}

pub(super) fn position(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(pose(sim, call)?.pos.0)
}

pub(super) fn old_position(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(old_pose(sim, call)?.pos.0)
}

pub(super) fn orientation(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(euler_of(&pose(sim, call)?.rot))
}

pub(super) fn old_orientation(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(euler_of(&old_pose(sim, call)?.rot))
}

pub(super) fn quaternion(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(quaternion_of(&pose(sim, call)?.rot))
}

pub(super) fn set_position(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    set_pose(sim, call, |before| Ok(Pose { pos: Vec3(call.floats(4)?), ..before }))
}

pub(super) fn set_orientation(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    set_pose(sim, call, |before| Ok(Pose { rot: rotation_of_euler(call.floats(4)?), ..before }))
}

pub(super) fn set_quaternion(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    set_pose(sim, call, |before| {
        let rot = rotation_of_quaternion(call.floats(4)?);
        Ok(Pose { rot: rot.ok_or_else(|| ApiError::new("the quaternion has no direction"))?, ..before })
    })
}

/// Changes a pose in the reference frame that the data begins with.
fn set_pose(
    sim: &mut SimApi<'_>,
    call: &Call<'_>,
    change: impl FnOnce(Pose<f64>) -> Result<Pose<f64>, ApiError>,
) -> Reply {
    let (object, against) = (call.handle()?, reference(call.int(0)?));
    let pose = change(sim.pose(object, against)?)?;
    after(sim.set_pose(object, &pose, against))
}

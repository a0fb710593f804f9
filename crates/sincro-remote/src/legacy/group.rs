//! `simxGetObjectGroupData`: one kind of data of all objects of a type.

use sincro_coppelia::api::convention::{euler_of, quaternion_of};
use sincro_coppelia::api::{ApiError, Entry, Handle, Kind, Reference, SimApi};

use super::functions::{Call, Reply};

/// Collected values of a group.
#[derive(Default)]
struct Gathered {
    handles: Vec<i32>,
    ints: Vec<i32>,
    floats: Vec<f64>,
    texts: Vec<String>,
}

/// Runs the function.
pub(super) fn run(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (objects, what) = (call.ident_int(0)?, call.ident_int(1)?);
    let mut all = Gathered::default();
    let handles = match Handle(objects) {
        collection if sim.registry.is_collection(collection) => sim.registry.collected(collection)?,
        _ => sim.objects_of_type(objects.into()),
    };
    for handle in handles {
        all.handles.push(handle.0);
        add(sim, handle, what, &mut all)?;
    }
    let counts = [all.handles.len(), all.ints.len(), all.floats.len(), all.texts.len()];
    let mut data: Vec<u8> = counts.into_iter().flat_map(|n| (n as i32).to_le_bytes()).collect();
    data.extend(all.handles.iter().chain(&all.ints).flat_map(|x| x.to_le_bytes()));
    data.extend(all.floats.iter().flat_map(|x| (*x as f32).to_le_bytes()));
    for text in all.texts {
        data.extend(text.bytes());
        data.push(0);
    }
    Ok(data)
}

fn add(sim: &mut SimApi<'_>, handle: Handle, what: i32, all: &mut Gathered) -> Result<(), ApiError> {
    let entry: Entry = sim.registry.entry(handle)?.clone();
    let against = if what % 2 == 1 { Reference::World } else { Reference::Parent };
    match what {
        0 | 20 => all.texts.push(entry.name),
        21 => all.texts.push(sim.registry.visible_path(handle)),
        1 => all.ints.push(sim.type_of(&entry) as i32),
        2 => all.ints.push(sim.registry.visible_parent(handle).map_or(-1, |h| h.0)),
        3..=12 => {
            let pose = sim.pose(handle, against)?;
            if matches!(what, 3 | 4 | 9..=12) {
                all.floats.extend(pose.pos.0);
            }
            if matches!(what, 5 | 6 | 9 | 10) {
                all.floats.extend(euler_of(&pose.rot));
            }
            if matches!(what, 7 | 8 | 11 | 12) {
                all.floats.extend(quaternion_of(&pose.rot));
            }
        }
        15 => match entry.kind {
            Kind::Joint(Some(_)) => {
                all.floats.push(sim.joint_position(handle)?);
                all.floats.push(sim.joint_force(handle)?.unwrap_or(0.0));
            }
            _ => all.floats.extend([0.0; 2]),
        },
        13 => {
            let (state, object, numbers) = match entry.kind {
                Kind::Proximity => super::sensing::seen(sim, handle)?,
                _ => (0, -1, [0.0; 6]),
            };
            all.ints.extend([state, object]);
            all.floats.extend(numbers);
        }
        14 => match entry.kind {
            Kind::ForceSensor(_) => {
                let (force, torque) = sim.force_sensor(handle)?;
                all.ints.push(1);
                all.floats.extend(force.into_iter().chain(torque));
            }
            _ => {
                all.ints.push(0);
                all.floats.extend([0.0; 6]);
            }
        },
        16 => match entry.kind {
            Kind::Joint(Some(_)) => {
                let (is_cyclic, [low, range]) = sim.joint_interval(handle)?;
                all.ints.extend([sim.joint_type(handle)? as i32, 5]);
                all.floats.extend(if is_cyclic { [0.0, -1.0] } else { [low, range] });
            }
            Kind::Rotor(_) => {
                all.ints.extend([10, 5]);
                all.floats.extend([0.0, -1.0]);
            }
            _ => {
                all.ints.extend([-1; 2]);
                all.floats.extend([0.0; 2]);
            }
        },
        17..=19 => {
            let (linear, angular) = sim.velocity(handle)?;
            if what != 18 {
                all.floats.extend(linear);
            }
            if what != 17 {
                all.floats.extend(angular);
            }
        }
        _ => return Err(ApiError(format!("there is no group data {what} here"))),
    }
    Ok(())
}

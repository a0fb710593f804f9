//! Same scene, same bits: twice, in any number of threads, and across a snapshot.

use std::path::Path;

use sincro_dynamics::batch::{BatchSettings, BatchWorld};
use sincro_dynamics::world::{MethodKind, World};
use sincro_sim::load;
use sincro_sim::rollout::rollout;
use sincro_sim::run::{Trace, choose_method, world_of};
use sincro_sim::snapshot::{Snapshot, SnapshotError};

fn scene(name: &str) -> sincro_sim::Loaded {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name), &[]).unwrap()
}

/// Advances with the scene's commands from tick `from` to tick `to`.
fn advance(loaded: &sincro_sim::Loaded, world: &mut World, trace: &mut Trace, from: u64, to: u64) {
    let step = loaded.experiment.step;
    for tick in from..to {
        let t = tick as f64 * step;
        for (command, signal) in world.state.commands.iter_mut().zip(&loaded.scene.commands) {
            *command = signal.value(t);
        }
        world.advance(t, step).unwrap();
        trace.add(&world.state);
    }
}

#[test]
fn a_saved_run_continues_with_the_same_hash() {
    for name in ["flexible-velocity-step", "free-body", "motor-ramp", "alexandros-release"] {
        let loaded = scene(name);
        let (method, _) = choose_method(&loaded.scene, &loaded.experiment);
        let mut world = world_of(&loaded.scene, &loaded.experiment, method, false);
        let mut trace = Trace::start(&world.state);
        advance(&loaded, &mut world, &mut trace, 0, 30);
        let snapshot = Snapshot { state: world.state.clone(), trace, control: world.control() };
        let bytes = snapshot.to_bytes(&loaded.scene.model);
        advance(&loaded, &mut world, &mut trace, 30, 40);

        let restored = Snapshot::from_bytes(&bytes, &loaded.scene.model).unwrap();
        assert_eq!(restored, snapshot, "{name}");
        let mut resumed = world_of(&loaded.scene, &loaded.experiment, method, false);
        resumed.state = restored.state;
        if let Some(control) = restored.control {
            resumed.set_control(control);
        }
        let mut continued = restored.trace;
        advance(&loaded, &mut resumed, &mut continued, 30, 40);
        assert_eq!((continued, &resumed.state), (trace, &world.state), "{name}");
    }
}

#[test]
fn a_damaged_or_foreign_snapshot_is_refused() {
    let (loaded, other) = (scene("free-body"), scene("double-pendulum"));
    let world = world_of(&loaded.scene, &loaded.experiment, MethodKind::Rk4, false);
    let snapshot = Snapshot { state: world.state.clone(), trace: Trace(1), control: None };
    let bytes = snapshot.to_bytes(&loaded.scene.model);
    let read = |bytes: &[u8]| Snapshot::from_bytes(bytes, &loaded.scene.model);
    assert_eq!(Snapshot::from_bytes(&bytes, &other.scene.model), Err(SnapshotError::OtherModel));
    assert_eq!(read(b"anything at all, long enough"), Err(SnapshotError::NotASnapshot));
    for k in 0..bytes.len() {
        assert!(read(&bytes[..k]).is_err(), "cut at {k}");
        let mut altered = bytes.clone();
        altered[k] ^= 0x10;
        assert!(read(&altered).is_err(), "altered at {k}");
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let loaded = scene("double-pendulum");
    let worlds: Vec<BatchWorld> = (0..53)
        .map(|k| {
            let mut state = loaded.scene.initial.clone();
            state.q[0] += 0.01 * f64::from(k);
            BatchWorld::new((*loaded.scene.model).clone(), state)
        })
        .collect();
    let settings = BatchSettings { method: MethodKind::Rk4, h: 0.002, n_steps: 200, record_every: 10 };
    let result = |threads: usize| {
        let mut worlds = worlds.clone();
        rollout(&mut worlds, &settings, threads).unwrap();
        worlds.iter().flat_map(|w| w.record.iter().map(|x| x.to_bits())).collect::<Vec<u64>>()
    };
    let one = result(1);
    for threads in [2, 3, 7, 64] {
        assert!(result(threads) == one, "{threads} threads");
    }
}

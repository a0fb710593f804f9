//! Same scene, same bits: twice, in any number of threads, and across a snapshot.

use sincro_dynamics::batch::{BatchSettings, BatchWorld};
use sincro_dynamics::world::MethodKind;
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_sim::rollout::rollout;
use sincro_sim::run::{LockStep, choose_method};
use sincro_sim::snapshot::{Snapshot, SnapshotError};
use sincro_sim::trace::Trace;

fn scene(name: &str) -> sincro_sim::Loaded {
    load(&sincro_testing::repository_scene(name), &[], Extensions::default()).unwrap()
}

/// Advances by `n` ticks.
fn advance(lockstep: &mut LockStep, trace: &mut Trace, n: usize) {
    for _ in 0..n {
        lockstep.advance().unwrap();
        lockstep.hash_into(trace);
    }
}

#[test]
fn a_saved_run_continues_with_the_same_hash() {
    for name in ["flexible-velocity-step", "free-body", "motor-ramp", "alexandros-release", "two-dof-position"] {
        let loaded = scene(name);
        let (method, _) = choose_method(&loaded.scene, &loaded.experiment);
        let mut lockstep = LockStep::new(&loaded, method, false);
        lockstep.start().unwrap();
        let mut trace = lockstep.trace();
        advance(&mut lockstep, &mut trace, 30);
        let snapshot = lockstep.snapshot(trace);
        let bytes = snapshot.to_bytes(&loaded);
        advance(&mut lockstep, &mut trace, 10);

        let restored = Snapshot::from_bytes(&bytes, &loaded).unwrap();
        assert_eq!(restored, snapshot, "{name}");
        let mut resumed = LockStep::new(&loaded, method, false);
        resumed.restore(&restored);
        let mut continued = restored.trace;
        advance(&mut resumed, &mut continued, 10);
        assert_eq!((continued, resumed.snapshot(trace)), (trace, lockstep.snapshot(trace)), "{name}");
    }
}

#[test]
fn a_damaged_or_foreign_snapshot_is_refused() {
    let (loaded, other) = (scene("free-body"), scene("double-pendulum"));
    let snapshot = LockStep::new(&loaded, MethodKind::Rk4, false).snapshot(Trace(1));
    let bytes = snapshot.to_bytes(&loaded);
    let read = |bytes: &[u8]| Snapshot::from_bytes(bytes, &loaded);
    assert_eq!(Snapshot::from_bytes(&bytes, &other), Err(SnapshotError::OtherModel));
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

//! Same scene, same bits: twice, in any number of threads, and across a snapshot.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::batch::{BatchSettings, BatchWorld};
use sincro_dynamics::contact::Material;
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::Vec3;
use sincro_dynamics::world::MethodKind;
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_sim::rollout::rollout;
use sincro_sim::run::{LockStep, choose_method};
use sincro_sim::snapshot::{Snapshot, SnapshotError};
use sincro_sim::trace::Trace;
use sincro_testing::SceneFolder;

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

/// Two carts on a slide that are geared to each other, one with a motor and limits, and a ball above a floor.
const CHANGEABLE: &str = r#"
format = 2
gravity = [0.3, 0.0, -9.81]
[[joint]]
name = "left"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
limits = { lower = -1.0, upper = 0.5 }
motor = { mode = "torque", command = 0.4, max_torque = 5.0 }
[[body]]
name = "cart"
parent = "/left"
mass = 2.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
[[joint]]
name = "right"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
[[body]]
name = "cart"
parent = "/right"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
[[coupling]]
name = "gear"
joints = ["/left", "/right"]
ratio = 0.5
[[joint]]
name = "air"
kind = "free"
initial = { position = [3.0, 0.0, 0.6, 1.0, 0.0, 0.0, 0.0], velocity = [0.0, 3.0, 0.0, 0.5, 0.0, 0.0] }
[[body]]
name = "ball"
parent = "/air"
density = 500.0
shape = [{ sphere = { radius = 0.1 } }]
contact = { friction = 0.4, restitution = 0.6 }
[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = 0.4, restitution = 0.6 }
"#;

#[test]
fn a_snapshot_holds_what_was_changed_during_the_run() {
    let folder = SceneFolder::of(
        CHANGEABLE,
        "format = 2\ntitle = \"Changes\"\nstep = 0.005\nduration = 2.0\nrecord = [\"/left.position\"]\n",
    );
    let loaded = folder.load(&[]).unwrap();
    let method = choose_method(&loaded.scene, &loaded.experiment).0;
    let mut changed = LockStep::new(&loaded, method, false);
    changed.start().unwrap();
    let mut trace = changed.trace();
    advance(&mut changed, &mut trace, 20);
    let world = changed.world();
    let names = world.model().names();
    let (ball, motor) = (names.body_id("/air/ball").unwrap(), names.motor_id("/left").unwrap());
    let dof = names.joint("/left").unwrap().v_idx;
    let mass = *world.model().mass_properties(ball).unwrap();
    let material = world.model().constraints().pairs[0].material;
    world.set_gravity(Vec3([0.1, 0.2, -3.7]));
    world.set_mass_properties(ball, MassProperties { mass: 3.0, center_of_mass: [0.0, 0.01, 0.0], ..mass });
    world.set_motor(motor, Motor { max_torque: 0.5, ..Motor::new(MotorMode::Velocity) });
    assert!(world.set_limits(dof, [Some(-1.0), Some(0.05)]));
    world.set_gear(0, -2.0, 0.0);
    world.set_pair(0, false, Material { friction: 0.05, restitution: 0.2, ..material });
    advance(&mut changed, &mut trace, 10);

    let snapshot = changed.snapshot(trace);
    let restored = Snapshot::from_bytes(&snapshot.to_bytes(&loaded), &loaded).unwrap();
    assert_eq!(restored, snapshot);
    let mut resumed = LockStep::new(&loaded, method, false);
    resumed.restore(&restored);
    let mut continued = restored.trace;
    advance(&mut changed, &mut trace, 300);
    advance(&mut resumed, &mut continued, 300);
    assert_eq!((resumed.state(), continued), (changed.state(), trace));

    // each of the changes matters: without it the run is another; the mode of the motor decides how many modes of
    // drives the state has, and is compared above
    let mode = 3 + 3 * 10;
    let of_scene = loaded.scene.model.params();
    let changes = restored.params.as_deref().expect("numbers were changed");
    for k in 0..of_scene.to_numbers().len() {
        let mut numbers = changes.to_numbers();
        if k == mode || numbers[k] == of_scene.to_numbers()[k] {
            continue;
        }
        numbers[k] = of_scene.to_numbers()[k];
        let Some(params) = loaded.scene.model.params_from_numbers(&numbers) else { panic!("number {k}") };
        let mut other = LockStep::new(&loaded, method, false);
        other.restore(&Snapshot { params: Some(Box::new(params)), ..restored.clone() });
        let mut trace = restored.trace;
        advance(&mut other, &mut trace, 300);
        assert_ne!(trace, continued, "number {k} is not used");
    }
    // what was not changed takes no room
    assert_eq!(LockStep::new(&loaded, method, false).snapshot(Trace(0)).params, None);
    assert!(loaded.scene.model.params_from_numbers(&[1.0; 7]).is_none());
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

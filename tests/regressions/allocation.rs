//! No allocation in a step after the first, whatever the integrator, and none in recording a row.

use std::path::Path;

use sincro_dynamics::world::MethodKind;
use sincro_sim::diagram::Controller;
use sincro_sim::load;
use sincro_sim::overrides::Override;
use sincro_sim::record::Recorder;
use sincro_sim::run::LockStep;

const METHODS: [MethodKind; 5] = [
    MethodKind::SemiImplicitEuler,
    MethodKind::Rk4,
    MethodKind::Implicit,
    MethodKind::DormandPrince,
    MethodKind::Stiff,
];

/// With a step at which the explicit methods are stable, too.
const PID: &[(&str, &str)] = &[
    ("diagram", "pid.toml"),
    ("/shoulder.motor.mode", "torque"),
    ("/shoulder/elbow.motor.mode", "torque"),
    ("step", "0.00025"),
];

#[test]
fn a_step_and_a_row_allocate_nothing() {
    // jumps of motors every tick, limits and events, quaternions, external signals
    for (name, set) in [
        ("motor-ramp", &[][..]),
        ("flexible-velocity-step", &[]),
        ("alexandros-release", &[]),
        ("free-body", &[]),
        ("two-dof-open-loop", &[]),
        // sampled blocks on ideal motors, continuous ones on torque motors
        ("two-dof-position", &[]),
        ("two-dof-position", PID),
        // impacts, sticking, sliding, rolling; closed loops; motors that jump through them
        ("bouncing-ball", &[]),
        ("incline", &[]),
        ("rolling-sphere", &[]),
        ("slider-crank", &[]),
        ("four-bar", &[]),
    ] {
        let set: Vec<Override> = set.iter().map(|(path, value)| Override::new(path, value)).collect();
        let loaded = load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name), &set).unwrap();
        for method in METHODS {
            let mut lockstep = LockStep::new(&loaded, method, false);
            let signals = loaded.controller.as_ref().map(Controller::entries).unwrap_or_default();
            let mut recorder = Recorder::new(&loaded.experiment.record, &loaded.scene.model, &signals).unwrap();
            lockstep.start().unwrap();
            let mut tick = |start: bool| {
                lockstep.advance().unwrap();
                let t = lockstep.t();
                let (seen, signals) = lockstep.observe(t);
                recorder.row(&seen, signals, t, start).len()
            };
            tick(true);
            let count = allocation_counter::measure(|| {
                (1..30).for_each(|_| {
                    tick(false);
                });
            });
            assert_eq!(count.count_total, 0, "{name} {method:?}");
        }
    }
}

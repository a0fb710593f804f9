//! No allocation in a step after the first, whatever the integrator, and none in recording a row.

use sincro_dynamics::world::MethodKind;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::overrides::Override;
use sincro_scene::record::Recorder;
use sincro_sim::Extensions;
use sincro_sim::audit::LawAudit;
use sincro_sim::load;
use sincro_sim::run::{LockStep, method_word};

/// With a step at which the explicit methods are stable, too.
const PID: &[(&str, &str)] = &[
    ("diagram", "pid.toml"),
    ("/shoulder.motor.mode", "torque"),
    ("/shoulder/elbow.motor.mode", "torque"),
    ("step", "0.00025"),
];

/// Rotors with a lag of their own, drag, and wind of every kind.
const ROUGH: &[(&str, &str)] = &[
    ("/air/quadrotor/rotor1.lag", "{ time_constant = 0.1, initial = 700.0 }"),
    ("/air/quadrotor/rotor3.lag", "{ time_constant = 0.2, initial = 700.0 }"),
    ("drag", "[{ name = \"hull\", parent = \"/air/quadrotor\", area = [0.1, 0.1, 0.2] }]"),
    ("wind.mean", "[3.0, 1.0, 0.0]"),
    ("wind.profile", "{ linear = { reference = 5.0 } }"),
    ("wind.gust", "[{ start = 0.1, rise = 0.2, peak = [0.0, 0.0, 1.0] }]"),
    ("wind.turbulence", "{ low_altitude = { wind_at_20_feet = 5.0, height = 10.0 } }"),
    ("step", "0.01"),
];

/// With a formula, a table and a rope between points, one of them in a loop, and a bushing.
const LINES: &[(&str, &str)] = &[
    (
        "spring_damper",
        "[{ name = \"a\", between = [\"/\", \"/shoulder/elbow/forearm\"], points = [[0.0, 0.3, 2.0], [0.0, 0.0, 0.0]], \
          law = \"-20*x - 5*abs(x)*x - v\", actuator = { command = 0.5 } }, \
         { name = \"b\", between = [\"/\", \"/shoulder/upper_arm\"], points = [[0.5, 0.0, 1.0], [0.0, 0.0, 0.0]], \
          tension_only = true, table = [[0.0, 0.0], [0.1, -2.0], [0.3, -9.0]] }]",
    ),
    (
        "bushing",
        "[{ name = \"c\", between = [\"/shoulder/upper_arm\", \"/shoulder/elbow/forearm\"], stiffness = 2.0, \
          rotational_stiffness = [1.0, 4.0, 3.0], rotational_damping = 0.1 }]",
    ),
];

/// With an IMU, and a step at which the explicit methods are stable.
const FLIGHT: &[(&str, &str)] = &[
    (
        "sensor",
        "[{ name = \"imu\", parent = \"/air/quadrotor\", sample_time = 0.01, imu = { gyro_noise_density = 1e-3 } }]",
    ),
    ("step", "0.0025"),
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
        ("two-dof-open-loop", LINES),
        // sampled blocks on ideal motors, continuous ones on torque motors
        ("two-dof-position", &[]),
        ("two-dof-position", PID),
        ("quadrotor-open-loop", ROUGH),
        ("stock-propeller", &[]),
        // rotors, a sub-diagram with everything sampled, a sensor
        ("quadrotor-flight-1", FLIGHT),
        // impacts, sticking, sliding, rolling; closed loops; motors that jump through them
        ("bouncing-ball", &[]),
        ("incline", &[]),
        ("rolling-sphere", &[]),
        ("slider-crank", &[]),
        ("four-bar", &[]),
    ] {
        for method in MethodKind::ALL {
            // by name: `auto` would change it
            let integrator = format!("\"{}\"", method_word(method));
            let all = set.iter().copied().chain([("integrator", integrator.as_str())]);
            let set: Vec<Override> = all.map(|(path, value)| Override::new(path, value)).collect();
            let loaded = load(&sincro_testing::repository_scene(name), &set, Extensions::default()).unwrap();
            let mut lockstep = LockStep::new(&loaded, method, false);
            let signals = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
            let mut recorder = Recorder::new(&loaded.experiment.record, &loaded.scene.model, &signals).unwrap();
            lockstep.start().unwrap();
            let mut audit = LawAudit::default();
            let mut tick = |start: bool| {
                lockstep.advance().unwrap();
                let t = lockstep.t();
                audit.tick(lockstep.world(), t);
                let (seen, signals) = lockstep.observe(t);
                audit.observe(&seen, t);
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

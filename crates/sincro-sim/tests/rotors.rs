//! Rotors in scene files: every law, lag, joints; what is measured, what is counted, what stops, what is refused.

use sincro_analysis::linearize::{Request, linearize};
use sincro_sim::Loaded;
use sincro_sim::results::Status;
use sincro_sim::run::{LockStep, Simulated, method_for};
use sincro_sim::snapshot::Snapshot;
use sincro_testing::{SceneFolder, scenes};

const BLADE: &str = "{ radius = 0.2, chord = 0.025, n_blades = 4, lift_slope = 5.7, collective_pitch = 0.14, cd0 = 0.0087, k_cd = 0.4 }";

const SCENE: &str = r#"gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "air"
kind = "free"

[[body]]
name = "craft"
parent = "/air"
mass = 2.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[rotor]]
name = "rotor"
parent = "/air/craft"
spin = "ccw"
LAW
speed = 640.0
"#;

const EXPERIMENT: &str = r#"title = "Rotor"
duration = 1.0
step = 0.01
record = ["/air.velocity.z", "/air/craft/rotor.speed", "/air/craft/rotor.thrust", "/air/craft/rotor.valid", "energy.balance"]
"#;

fn folder(law: &str) -> SceneFolder {
    let folder = scenes::sprung_arm();
    folder.write("scene.toml", &SCENE.replace("LAW", law));
    folder.write("experiment.toml", EXPERIMENT);
    folder
}

fn blade() -> String {
    format!("blade = {BLADE}")
}

fn run(loaded: &Loaded) -> Simulated {
    sincro_testing::run(loaded)
}

fn column<'a>(run: &'a Simulated, name: &str) -> &'a [f64] {
    &run.table.column(name).unwrap_or_else(|| panic!("no {name}")).values
}

#[test]
fn a_lag_is_recorded_saved_and_linearised() {
    let folder = folder(&format!("{}\nlag = {{ time_constant = 0.1, initial = 500.0 }}", blade()));
    let loaded = folder.load(&["accuracy=1e-10"]).unwrap();
    let out = run(&loaded);
    for (t, speed) in out.table.times().iter().zip(column(&out, "/air/craft/rotor.speed")) {
        assert!((speed - (640.0 - 140.0 * sincro_math::elementary::exp(-t / 0.1).0)).abs() < 1e-6, "{t} {speed}");
    }
    assert!(column(&out, "energy.balance").iter().all(|e| e.abs() < 1e-7));

    // a saved run goes on as if nothing had been
    let advanced = |n: u32| {
        let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
        lockstep.start().unwrap();
        (0..n).for_each(|_| lockstep.advance().unwrap());
        lockstep
    };
    let half = advanced(20);
    let bytes = half.snapshot(half.trace()).to_bytes(&loaded);
    let mut resumed = advanced(3);
    resumed.restore(&Snapshot::from_bytes(&bytes, &loaded).unwrap());
    (0..20).for_each(|_| resumed.advance().unwrap());
    assert_eq!(resumed.state(), advanced(40).state());

    // Ω' = (u − Ω)/τ among the states
    let mut at = advanced(0);
    at.latch();
    let linear = linearize(&loaded, &at, &Request::default()).unwrap().system;
    let k = linear.states.iter().position(|axis| axis.name == "/air/craft/rotor.speed").unwrap();
    assert_eq!((linear.states.len(), linear.inputs[0].name.as_str()), (13, "/air/craft/rotor.command"));
    assert!((linear.a[(k, k)] + 10.0).abs() < 1e-12 && (linear.b[(k, 0)] - 10.0).abs() < 1e-12);
    let climb = linear.states.iter().position(|axis| axis.name == "/air.velocity.z").unwrap();
    // more speed, more lift
    assert!(linear.a[(climb, k)] > 0.0);
}

#[test]
fn a_short_lag_is_stable_whatever_the_method() {
    let folder = folder(&format!("{}\nlag = {{ time_constant = 1e-6 }}", blade()));
    assert_eq!(method_for(&folder.load(&[]).unwrap()).0, sincro_dynamics::world::MethodKind::Stiff);
    for integrator in ["auto", "implicit", "semi-implicit-euler", "stiff"] {
        let loaded = folder.load(&[&format!("integrator={integrator}")]).unwrap();
        let out = run(&loaded);
        assert_eq!(out.status, Status::Completed);
        let speed = column(&out, "/air/craft/rotor.speed").last().copied().unwrap();
        assert!((speed - 640.0).abs() < 1e-3, "{integrator} {speed}");
    }
    let warned = |integrator: &str| method_for(&folder.load(&[&format!("integrator={integrator}")]).unwrap()).1;
    assert!(warned("rk4")[0].starts_with("the lag of rotor `/air/craft/rotor` (1.000e-6 s) is too short for `rk4`"));
    assert!(warned("dormand-prince")[0].contains("sub-steps"));
}

#[test]
fn a_rotor_turns_with_the_joint_that_carries_it() {
    let folder = folder("");
    let scene = SCENE.split("[[rotor]]").next().unwrap().to_owned()
        + &format!(
            r#"
[[joint]]
name = "shaft"
parent = "/air/craft"
kind = "revolute"
motor = {{ mode = "torque", command = 0.05 }}

[[body]]
name = "propeller"
parent = "/air/craft/shaft"
mass = 0.02
inertia = {{ xx = 1e-5, yy = 1e-5, zz = 2e-5 }}

[[rotor]]
name = "disc"
parent = "/air/craft/shaft"
spin = "ccw"
blade = {BLADE}
joint = "/air/craft/shaft"
"#
        );
    folder.write("scene.toml", &scene);
    let record =
        r#"record = ["/air/craft/shaft.velocity", "/air/craft/shaft/disc.speed", "/air/craft/shaft/disc.torque", "#;
    folder.change("experiment.toml", "record = [", record);
    folder.change(
        "experiment.toml",
        "\"/air/craft/rotor.speed\", \"/air/craft/rotor.thrust\", \"/air/craft/rotor.valid\", ",
        "",
    );
    let loaded = folder.load(&["accuracy=1e-10", "duration=2.0"]).unwrap_or_else(|e| panic!("{e}"));
    let out = run(&loaded);
    assert_eq!(column(&out, "/air/craft/shaft.velocity"), column(&out, "/air/craft/shaft/disc.speed"));
    // it spins up until the air takes what the motor gives
    let torque = column(&out, "/air/craft/shaft/disc.torque").last().copied().unwrap();
    assert!((torque + 0.05).abs() < 1e-3, "{torque}");
    assert!(column(&out, "energy.balance").iter().all(|e| e.abs() < 1e-6));
}

#[test]
fn a_table_of_coefficients_comes_from_a_file() {
    let folder = folder("table = { file = \"propeller.csv\", diameter = 0.25, torque = \"cq\" }");
    folder.write("propeller.csv", "J,c_T,cq\n0.0,0.11,0.006\n0.5,0.07,0.005\n");
    let out = run(&folder.load(&["duration=0.1"]).unwrap_or_else(|e| panic!("{e}")));
    let turns = 640.0 / std::f64::consts::TAU;
    // the first row has the start's command, none; at the end of the first step it has climbed a little
    let thrust = column(&out, "/air/craft/rotor.thrust")[1];
    assert!((thrust / (1.225 * turns * turns * 0.25_f64.powi(4) * 0.11) - 1.0).abs() < 1e-2, "{thrust}");
    // sinking, it is outside the table: said, and counted
    assert!(out.warnings.iter().any(|w| w.contains("(outside its table)")), "{:?}", out.warnings);
}

#[test]
fn a_stock_propeller_throws_whole_particles() {
    let folder = folder("stock = {}");
    folder.change("scene.toml", "spin = \"ccw\"\n", "");
    let loaded = folder.load(&["/air/craft/rotor.speed=20.0", "step=0.05"]).unwrap_or_else(|e| panic!("{e}"));
    let out = run(&loaded);
    let mass = 8500.0 * std::f64::consts::PI * 0.005_f64.powi(3) / 6.0;
    let counts: Vec<u64> =
        column(&out, "/air/craft/rotor.thrust")[1..].iter().map(|f| (f * 0.05 / 20.0 / mass).round() as u64).collect();
    assert_eq!(counts[..4], [21, 22, 21, 22]);
    assert_eq!(counts.iter().sum::<u64>(), 430);
    // the mean is exact after whole cycles, whatever the integrator's sub-steps
    let v = column(&out, "/air.velocity.z").last().copied().unwrap();
    assert!((v - (430.0 * mass * 20.0 / 2.0 - 9.81)).abs() < 1e-9, "{v}");
}

#[test]
fn the_printed_script_flies_until_it_is_not_a_number() {
    let folder = folder(&format!("printed = {BLADE}"));
    folder.change("scene.toml", "spin = \"ccw\"\n", "");
    // upwards it flies; along it loses its root
    assert_eq!(run(&folder.load(&["/air/craft/rotor.speed=800.0", "duration=0.2"]).unwrap()).status, Status::Completed);
    let sideways = "/air.initial.velocity=[0, 0, 0, 12, 0, 0]";
    let out = run(&folder.load(&["/air/craft/rotor.speed=300.0", sideways]).unwrap());
    let Status::Stopped { reason, help, .. } = &out.status else { panic!("{:?}", out.status) };
    assert!(
        reason.starts_with("rotor `/air/craft/rotor`, the script as printed, gave what is not a number in tick "),
        "{reason}"
    );
    assert!(help.contains("take `blade` in place of `printed`"), "{help}");
}

#[test]
fn leaving_the_theory_is_counted_with_its_times() {
    // too slow to carry: it sinks through its own wake
    let folder = folder(&blade());
    let out = run(&folder.load(&["/air/craft/rotor.speed=300.0"]).unwrap());
    let valid = column(&out, "/air/craft/rotor.valid");
    let outside: Vec<usize> = (1..valid.len()).filter(|&k| valid[k] == 0.0).collect();
    let steep = &out.outside[0];
    assert_eq!((steep.rotor.as_str(), steep.reason.word()), ("/air/craft/rotor", "steep descent"));
    assert_eq!(steep.steps as usize, outside.len());
    assert!(outside.len() > 10 && outside.len() < 100);
    let time = |k: usize| out.table.times()[k];
    assert_eq!((steep.first, steep.last), (time(outside[0]), time(*outside.last().unwrap())));
    assert!((steep.duration - 0.01 * outside.len() as f64).abs() < 1e-12);
    assert!(
        out.warnings[0]
            .starts_with("rotor `/air/craft/rotor` was outside what the theory holds for (steep descent) in ")
    );
    // in hover nothing is said
    let out = run(&folder.load(&["/air/craft/rotor.speed=640.0", "gravity=[0, 0, 0]"]).unwrap());
    assert!(out.outside.is_empty() && out.warnings.is_empty());
}

#[test]
fn a_diagram_measures_rotors() {
    for (law, lag) in [(blade(), ""), (blade(), "\nlag = { time_constant = 0.1, initial = 600.0 }")] {
        let folder = folder(&format!("{law}{lag}"));
        folder.write(
            "diagram.toml",
            r#"
wires = ["/air/craft/rotor.thrust -> thrust", "/air/craft/rotor.speed -> speed", "/air/craft/rotor.power -> power"]

[[block]]
name = "thrust"
type = "gain"
gain = 1.0

[[block]]
name = "power"
type = "integrator"

[[block]]
name = "speed"
type = "gain"
gain = 1.0
"#,
        );
        if lag.is_empty() {
            // without a lag the speed is a command: not a measurement
            folder.change("diagram.toml", "\"/air/craft/rotor.speed -> speed\", ", "");
            folder.change("diagram.toml", "[[block]]\nname = \"speed\"\ntype = \"gain\"\ngain = 1.0\n", "");
        }
        folder.change(
            "experiment.toml",
            "record = [",
            "diagram = \"diagram.toml\"\nrecord = [\"thrust\", \"power\", \"/air/craft/rotor.power\", ",
        );
        let loaded = folder.load(&["accuracy=1e-10"]).unwrap_or_else(|e| panic!("{e}"));
        let out = run(&loaded);
        let (mine, theirs) = (column(&out, "thrust"), column(&out, "/air/craft/rotor.thrust"));
        // a tick's commands act from the tick on: the diagram sees their effect at once, the row the end of the step
        // before
        for k in 1..mine.len() {
            assert!((mine[k] - theirs[k]).abs() < 1e-9 * theirs[k], "{k}: {} {}", mine[k], theirs[k]);
        }
        let power = column(&out, "/air/craft/rotor.power");
        let from = if lag.is_empty() { 1 } else { 0 };
        let trapezes: f64 = (from..100).map(|k| 0.005 * (power[k] + power[k + 1])).sum();
        let work = column(&out, "power")[100] - column(&out, "power")[from];
        assert!((work - trapezes).abs() < 1e-3 * work, "{work} {trapezes}");
    }
}

/// Law, what is replaced in the scene, by what, and what is said.
fn refused() -> Vec<(String, &'static str, &'static str, &'static str)> {
    let blade = blade();
    let case = |from, to, said| (blade.clone(), from, to, said);
    vec![
        case(
            "n_blades = 4",
            "n_blades = 0",
            "scene.toml:17:51: error: rotor `rotor`: `n_blades` is 0: a rotor has at least one blade",
        ),
        case(
            "radius = 0.2",
            "radius = -0.2",
            "scene.toml:17:20: error: rotor `rotor`: `radius` is -0.2 m: expected a number from 0.000001 to 1000000 m",
        ),
        case(
            "spin = \"ccw\"",
            "spin = 0",
            r#"scene.toml:16:8: error: `spin` is the number 0, expected one of `ccw`, `cw`
  help: Which way it turns at positive speed, seen from above; of all but `stock` and `printed`, which know none."#,
        ),
        case(
            "spin = \"ccw\"\n",
            "",
            r#"scene.toml:14:8: error: `spin` is missing in rotor `rotor`
  help: `spin`: "ccw" or "cw", seen from above"#,
        ),
        case(
            ", cd0 = 0.0087",
            "",
            r#"scene.toml:17:9: error: `cd0` is missing in `blade`
  help: `cd0`: Drag coefficient at zero incidence: c_d = cd0 + k_cd·α²."#,
        ),
        case(
            "speed = 640.0",
            "speed = nan",
            "scene.toml:18:9: error: `speed` is not a number, expected a finite number in rad/s or a table with one of `constant`, `step`, `ramp`, `sine`, `pulse`, `table`\n  help: Speed over time, default 0; a diagram may give it through the port PATH [rad/s].",
        ),
        case(
            "speed = 640.0",
            "lag = { time_constant = 0.0 }",
            r#"scene.toml:18:25: error: `time_constant` is 0, expected a number in s, greater than 0
  help: Time to 63 % of a step [s]."#,
        ),
        case(
            "speed = 640.0",
            "speed = 640.0\njoint = \"/air\"",
            r#"scene.toml:18:1: error: `joint` and `speed` exclude each other
  help: leave all but one out"#,
        ),
        case(
            "speed = 640.0",
            "joint = \"/aire\"",
            r#"scene.toml:18:9: error: there is no joint `/aire` to turn rotor `/air/craft/rotor`
  help: did you mean `/air`?"#,
        ),
        case(
            "speed = 640.0",
            "joint = \"/air\"",
            r#"scene.toml:18:9: error: rotor `/air/craft/rotor` takes its speed from joint `/air`, which is not revolute
  help: a rotor turns with a revolute joint"#,
        ),
        case(
            "spin = \"ccw\"\nblade",
            "spin = \"ccw\"\nconstant = { thrust = 1e-5, torque = 1e-7 }\nblade",
            r#"scene.toml:17:1: error: `blade` and `constant` exclude each other
  help: leave all but one out"#,
        ),
        case(
            "blade = {",
            "blad = {",
            r#"scene.toml:17:1: error: unknown key `blad` in rotor `rotor`
  help: did you mean `blade`? keys here: `blade`, `lag`, `name`, `speed`, `table`, `parent`, `constant`, `rotation_deg` and 8 more"#,
        ),
        (
            "stock = { density = -1.0 }".into(),
            "speed = 640.0",
            "lag = { time_constant = 0.1 }",
            r#"scene.toml:16:1: error: `spin` has no meaning with `stock`
  help: leave it out: that law knows no sense of rotation
scene.toml:17:21: error: rotor `rotor`: `density` is -1 kg/m³: expected a number from 0 to 1000000000 kg/m³"#,
        ),
        (
            "stock = {}".into(),
            "spin = \"ccw\"\nstock = {}\nspeed = 640.0",
            "stock = {}\nlag = { time_constant = 0.1 }",
            r#"scene.toml:16:9: error: rotor `/air/craft/rotor` is a stock propeller, which does not turn
  help: its `speed` is the velocity of its particles; leave `lag` and `joint` out"#,
        ),
        (
            "table = { file = \"falling.csv\", diameter = 0.25 }".into(),
            "speed = 640.0",
            "",
            r#"falling.csv:3:1: error: `J` -0.5 does not come after 0
  help: rows are ordered, each later than the one before"#,
        ),
        (
            "table = { file = \"falling.csv\", diameter = 0.25, thrust = \"cT\" }".into(),
            "speed = 640.0",
            "",
            r#"scene.toml:17:59: error: `falling.csv` has no column `cT`
  help: columns: `J`, `c_T`, `c_Q`"#,
        ),
    ]
}

#[test]
fn wrong_rotors_are_refused_at_their_place() {
    let mut wrong = Vec::new();
    for (law, from, to, said) in refused() {
        let folder = folder(&law);
        folder.write("falling.csv", "J,c_T,c_Q\n0,0.1,0.01\n-0.5,0.1,0.01\n");
        folder.change("scene.toml", from, to);
        let message = folder.load(&[]).map_or_else(|message| message, |_| "loads".into());
        wrong.extend((message != said).then(|| format!("{message}\n--- expected\n{said}\n")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_rotor_on_a_fixed_body_is_told() {
    let folder = folder(&blade());
    folder.change("scene.toml", "kind = \"free\"", "kind = \"fixed\"");
    folder.write("experiment.toml", "title = \"Fixed\"\nduration = 1.0\nstep = 0.1\nrecord = [\"energy.total\"]\n");
    let loaded = folder.load(&[]).unwrap_or_else(|e| panic!("{e}"));
    let said: Vec<String> = loaded.warnings.iter().map(|w| folder.short(&w.to_string())).collect();
    assert_eq!(
        said,
        [
            "scene.toml:14:8: warning: rotor `/air/craft/rotor` acts on something that is fixed in the world\n  help: it moves nothing; hang its parent on a joint"
        ]
    );
}

/// −ω × h turns the angular velocity of a ball about the rotor's axis at h/I, and takes no energy.
#[test]
fn a_rotor_with_inertia_precesses() {
    let record = "record = [\"/air.angular_velocity.x\", \"/air.angular_velocity.y\", ";
    for (spin, sign) in [("ccw", 1.0), ("cw", -1.0)] {
        let folder = folder("constant = { thrust = 0.0, torque = 0.0 }\ninertia = 1e-3");
        folder.change("scene.toml", "gravity = [0.0, 0.0, -9.81]", "gravity = [0.0, 0.0, 0.0]");
        folder.change("scene.toml", "speed = 640.0", "speed = 1000.0");
        folder.change(
            "scene.toml",
            "kind = \"free\"",
            "kind = \"free\"\ninitial = { velocity = [0.1, 0, 0, 0, 0, 0] }",
        );
        folder.change("scene.toml", "spin = \"ccw\"", &format!("spin = \"{spin}\""));
        folder.change("experiment.toml", "record = [", record);
        let done = run(&folder.load(&["accuracy=1e-12"]).unwrap());
        let (x, y) = (column(&done, "/air.angular_velocity.x"), column(&done, "/air.angular_velocity.y"));
        for (k, t) in done.table.times().iter().enumerate() {
            let (sin, cos) = sincro_math::elementary::sin_cos(10.0 * sign * t);
            assert!(
                (x[k] - 0.1 * cos).abs() < 1e-9 && (y[k] - 0.1 * sin).abs() < 1e-9,
                "{spin} {t}: {} {}",
                x[k],
                y[k]
            );
        }
        assert!(column(&done, "energy.balance").iter().all(|x| x.abs() < 1e-12));
    }
}

/// Descending on its thrust, a craft is held up by the ground.
#[test]
fn the_ground_holds_a_rotor_up() {
    let thrust = |ground: &str, height: f64| {
        let folder = folder(&format!("{}\n{ground}", blade()));
        let initial = format!("initial = {{ position = [0, 0, {height}, 1, 0, 0, 0] }}");
        folder.change("scene.toml", "kind = \"free\"", &format!("kind = \"free\"\n{initial}"));
        column(&run(&folder.load(&["duration=0.01"]).unwrap()), "/air/craft/rotor.thrust")[1]
    };
    let (far, near) = (thrust("ground_effect = true", 50.0), thrust("ground_effect = true", 0.2));
    let free = thrust("", 0.2);
    assert!((far / free - 1.0).abs() < 1e-5 && near > 1.01 * free, "{free} {far} {near}");
}

#[test]
fn an_inertia_or_a_ground_effect_that_the_law_cannot_have_is_refused() {
    let refused = |law: &str| folder(law).load(&[]).unwrap_err();
    assert!(refused(&format!("{}\ninertia = -1.0", blade())).contains("inertia"));
    let constant = "constant = { thrust = 1e-5, torque = 1e-7 }\nground_effect = true";
    assert!(refused(constant).contains("`ground_effect` belongs to `blade`"));
    let folder = folder("stock = {}\ninertia = 1e-5");
    folder.change("scene.toml", "spin = \"ccw\"\n", "");
    assert!(folder.load(&[]).unwrap_err().contains("`inertia` has no meaning with `stock` or `printed`"));
}

//! Wind and drag in scene files: what is felt, what is recorded and measured, what is refused.

use sincro_sim::Loaded;
use sincro_sim::run::{LockStep, method_for};
use sincro_testing::{SceneFolder, scenes};

const SCENE: &str = r#"gravity = [0.0, 0.0, 0.0]
air_density = 1.2

[wind]
mean = [4.0, -3.0, 0.0]
profile = { linear = { reference = 10.0 } }
gust = [{ start = 0.5, rise = 0.25, peak = [0.0, 0.0, 2.0] }]
turbulence = { low_altitude = { wind_at_20_feet = 5.0, height = 20.0 } }

[[joint]]
name = "air"
kind = "free"
initial = { position = [0.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0] }

[[body]]
name = "kite"
parent = "/air"
mass = 2.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[drag]]
name = "sail"
parent = "/air/kite"
area = [1.0, 1.0, 1.0]
linear = [0.0, 0.0, 0.5]

[[rotor]]
name = "rotor"
parent = "/air/kite"
spin = "ccw"
constant = { thrust = 0.0, torque = 0.0 }
"#;

const EXPERIMENT: &str = r#"title = "Kite"
duration = 1.0
step = 0.01
record = ["/air.velocity.x", "/air/kite.wind.x", "wind.x", "/air/kite/sail.force.z", "energy.balance"]
"#;

fn folder() -> SceneFolder {
    SceneFolder::of(SCENE, EXPERIMENT)
}

fn ran(loaded: &Loaded, n: u32) -> LockStep {
    let mut lockstep = LockStep::new(loaded, method_for(loaded).0, false);
    lockstep.start().unwrap();
    (0..n).for_each(|_| lockstep.advance().unwrap());
    lockstep
}

#[test]
fn the_experiments_seed_chooses_the_turbulence() {
    let folder = folder();
    let wind = |settings: &[&str]| {
        let loaded = folder.load(settings).unwrap();
        loaded.scene.model.wind().unwrap().velocity::<f64>(0.3, 10.0).0
    };
    assert_eq!(wind(&[]), wind(&["seed=0"]));
    assert_ne!(wind(&[]), wind(&["seed=1"]));
    assert_eq!(wind(&["seed=7"]), wind(&["seed=7"]));
    let trace = |settings: &[&str]| ran(&folder.load(settings).unwrap(), 50).trace();
    assert_eq!(trace(&["seed=3"]), trace(&["seed=3"]));
    assert_ne!(trace(&["seed=3"]), trace(&["seed=4"]));
}

#[test]
fn a_kite_is_carried_along_and_the_energy_is_balanced() {
    let folder = folder();
    let loaded = folder.load(&["accuracy=1e-11"]).unwrap();
    let run = sincro_testing::run(&loaded);
    let column = |name: &str| &run.table.columns.iter().find(|c| c.name == name).unwrap().values;
    assert!(column("energy.balance").iter().all(|e| e.abs() < 1e-8));
    assert!(column("/air.velocity.x").last().unwrap() > &0.1);
    // at half the reference height the mean is half; the rest is turbulence, the same at both heights
    let (here, above) = (column("/air/kite.wind.x"), column("wind.x"));
    assert!((here[0] - above[0] + 2.0).abs() < 1e-12, "{} {}", here[0], above[0]);
}

#[test]
fn a_diagram_measures_the_wind_and_the_drag() {
    let folder = folder();
    folder.write(
        "diagram.toml",
        r#"
wires = ["/air/kite.wind -> held", "world.wind -> above", "/air/kite/sail.force -> push"]

[[block]]
name = "held"
type = "gain"
gain = 1.0

[[block]]
name = "above"
type = "gain"
gain = 1.0

[[block]]
name = "push"
type = "gain"
gain = 1.0
"#,
    );
    let record = r#"record = ["held[0]", "above[1]", "push[2]", "#;
    folder.change("experiment.toml", "record = [", &format!("diagram = \"diagram.toml\"\n{record}"));
    let loaded = folder.load(&[]).unwrap_or_else(|e| panic!("{e}"));
    let mut lockstep = ran(&loaded, 20);
    let t = lockstep.t();
    let mut recorder = sincro_scene::record::Recorder::new(
        &loaded.experiment.record,
        &loaded.scene.model,
        &loaded.controller.as_ref().unwrap().entries(),
    )
    .unwrap();
    let (seen, signals) = lockstep.observe(t);
    let row = recorder.row(&seen, signals, t, true).to_vec();
    // t, held, above, push, velocity, wind here, wind above, force
    assert_eq!((row[1], row[3]), (row[5], row[7]));
    assert!(row[2] != 0.0 && row[3] != 0.0);
}

/// Replaced text, replacement, and expected message.
const REFUSED: &[(&str, &str, &str)] = &[
    (
        "mean = [4.0, -3.0, 0.0]",
        "mean = [4.0, nan, 0.0]",
        "scene.toml:5:14: error: `mean[1]` is not a number, expected a finite number",
    ),
    (
        "rise = 0.25",
        "rise = 0.0",
        r#"scene.toml:7:31: error: `rise` is 0, expected a number in s, greater than 0
  help: Time to the peak [s]."#,
    ),
    (
        "turbulence = { low_altitude = { wind_at_20_feet = 5.0, height = 20.0 } }",
        "turbulence = { deviation = [1.0, 1.0, 0.5] }",
        r#"scene.toml:8:14: error: `length` is missing in `turbulence`
  help: `length`: three lengths [m] that go with the deviations, or take `low_altitude`"#,
    ),
    (
        "turbulence = { low_altitude = { wind_at_20_feet = 5.0, height = 20.0 } }",
        "turbulence = { airspeed = 3.0 }",
        "scene.toml:8:14: error: one of `low_altitude`, `deviation` is missing in `turbulence`",
    ),
    (
        "turbulence = { low_altitude = { wind_at_20_feet = 5.0, height = 20.0 } }",
        "turbulence = { deviation = [1.0, 1.0, 0.5], length = [1.0, 0.0, 1.0] }",
        "scene.toml:8:54: error: wind: `length` is [1.0, 0.0, 1.0] m: expected three numbers from 0.001 to 1000000 m",
    ),
    (
        "height = 20.0 } }",
        "height = 20.0 }, airspeed = 3.0, convected = true }",
        "scene.toml:8:84: error: wind: `airspeed` is 3 m/s, but the mean wind carries a convected field past at 5 m/s: leave it out",
    ),
    (
        "mean = [4.0, -3.0, 0.0]\nprofile = { linear = { reference = 10.0 } }\ngust = [{ start = 0.5, rise = 0.25, peak = [0.0, 0.0, 2.0] }]\nturbulence = {",
        "mean = [0.0, 0.0, 2.0]\nprofile = { linear = { reference = 10.0 } }\nturbulence = { convected = true,",
        "scene.toml:7:28: error: wind: `convected` needs a horizontal mean wind: without it nothing carries the field past",
    ),
    (
        "height = 20.0",
        "height = 1.0",
        "scene.toml:8:65: error: wind: `height` is 1 m: the spectra hold from 3.048 to 304.8 m",
    ),
    (
        "mean = [4.0, -3.0, 0.0]\nprofile",
        "profile",
        r#"scene.toml:7:14: error: `airspeed` is missing in `turbulence`, and there is no mean wind to take it from
  help: `airspeed`: velocity [m/s] at which the vehicle crosses the turbulence"#,
    ),
    (
        "profile = { linear = { reference = 10.0 } }",
        "profile = { logarithmic = { reference = 0.1, roughness = 0.5 } }",
        "scene.toml:6:41: error: wind: `reference` is 0.1 m: expected a height above the roughness",
    ),
    (
        "area = [1.0, 1.0, 1.0]",
        "area = [1.0, -1.0, 1.0]",
        "scene.toml:24:14: error: `area[1]` is -1, expected a number, at least 0",
    ),
    (
        "area = [1.0, 1.0, 1.0]\nlinear = [0.0, 0.0, 0.5]",
        "",
        r#"scene.toml:22:8: error: drag `/air/kite/sail` has neither `area` nor `linear`
  help: give drag areas [m²], linear coefficients [N·s/m], or both"#,
    ),
    (
        r#"parent = "/air/kite"
area"#,
        r#"parent = "/"
area"#,
        r#"scene.toml:23:10: error: drag `/sail` acts on `/`, which is no body and no frame
  help: the parent of a drag is a body or a frame"#,
    ),
    (
        "air_density = 1.2",
        "air_density = -1.2",
        r#"scene.toml:2:15: error: `air_density` is -1.2, expected a number in kg/m³ or a table of `formula`, at least 0
  help: Density of the air, for rotors and drag [kg/m³]; or a table with a formula of the position."#,
    ),
    (
        "gust = [",
        "gusts = [",
        r#"scene.toml:7:1: error: unknown key `gusts` in `wind`
  help: did you mean `gust`? keys here: `gust`, `mean`, `profile`, `turbulence`"#,
    ),
];

#[test]
fn wrong_air_is_refused_at_its_place() {
    let mut wrong = Vec::new();
    for (from, to, said) in REFUSED {
        let folder = folder();
        folder.change("scene.toml", from, to);
        match folder.load(&[]) {
            Ok(_) => panic!("{to:?} loads"),
            Err(message) => wrong.extend((message != *said).then(|| format!("{message}\n--- expected\n{said}\n"))),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn wind_that_nothing_feels_is_told() {
    let folder = scenes::sprung_arm();
    folder.change("scene.toml", "[[joint]]", "[wind]\nmean = [1.0, 0.0, 0.0]\n\n[[joint]]");
    let loaded = folder.load(&[]).unwrap();
    let said: Vec<String> = loaded.warnings.iter().map(|w| folder.short(&w.to_string())).collect();
    assert_eq!(
        said,
        [
            "scene.toml:3:1: warning: nothing in this scene feels the wind\n  help: rotors and drag elements do: add a [[drag]] to a body"
        ]
    );
}

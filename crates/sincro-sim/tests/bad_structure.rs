//! Violations of the schema are reported with their location, the value found and the value expected.
//!
//! Each case changes one thing in the folder of the sprung arm and states the whole message.

use sincro_testing::scenes::refused;

/// File, what is replaced, by what, and what is said.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        "scene.toml",
        "damping = 0.5",
        "dampng = 0.5",
        r#"scene.toml:8:1: error: unknown key `dampng` in joint `shoulder`
  help: did you mean `damping`? keys here: `damping`, `spring`, `name`, `parent`, `armature`, `position`, `rotation_deg`, `quaternion_wxyz` and 10 more"#,
    ),
    (
        "scene.toml",
        "rest = 0.0 }",
        "rset = 0.0 }",
        r#"scene.toml:7:30: error: unknown key `rset` in `spring`
  help: did you mean `rest`? keys here: `law`, `rest`, `stiffness`, `table`"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute"
axis"#,
        "axis",
        r#"scene.toml:4:8: error: `kind` is missing in joint `shoulder`
  help: `kind`: How it moves."#,
    ),
    (
        "scene.toml",
        "stiffness = 30.0, ",
        "",
        r#"scene.toml:7:10: error: `stiffness` is missing in `spring`
  help: give `stiffness` [N·m/rad] or [N/m] to the spring of `shoulder`, or a `law` or `table`"#,
    ),
    (
        "scene.toml",
        "density = 1000.0",
        r#"density = [1000]"#,
        r#"scene.toml:14:11: error: `density` is a list of 1, expected a number in kg/m³
  help: Of its shapes, from which mass and inertia are computed [kg/m³]."#,
    ),
    (
        "scene.toml",
        "axis = [0.0, 1.0, 0.0]",
        "axis = [0.0, 1.0]",
        r#"scene.toml:6:8: error: `axis` has 2 entries, expected a list of 3 numbers
  help: Axis in the joint frame, of any length but zero. Revolute, prismatic and screw: default z; universal: the first axis, default x."#,
    ),
    (
        "scene.toml",
        "axis = [0.0, 1.0, 0.0]",
        "axis = [0.0, true, 0.0]",
        "scene.toml:6:14: error: `axis[1]` is true, expected a number",
    ),
    (
        "scene.toml",
        r#"kind = "revolute""#,
        r#"kind = "revolut""#,
        r#"scene.toml:5:8: error: `kind` is "revolut", expected one of `fixed`, `revolute`, `prismatic`, `screw`, `universal`, `ball`, `planar`, `free`
  help: did you mean `revolute`?"#,
    ),
    (
        "scene.toml",
        r#"mode = "velocity""#,
        r#"mode = "servo""#,
        r#"scene.toml:26:18: error: `mode` is "servo", expected one of `free`, `torque`, `velocity`, `position`, `spring`, `voltage`
  help: What it does with its command."#,
    ),
    (
        "scene.toml",
        "damping = 0.5",
        "damping = nan",
        r#"scene.toml:8:11: error: `damping` is not a number, expected a finite number in N·m·s/rad or N·s/m or a list of numbers in N·m·s/rad or N·s/m
  help: Viscous coefficient: τ = −damping·q̇; a list for several degrees of freedom [N·m·s/rad] or [N·s/m]."#,
    ),
    (
        "scene.toml",
        "mass = 0.5",
        "mass = inf",
        r#"scene.toml:31:8: error: `mass` is infinite, expected a finite number in kg
  help: With `inertia`, or with shapes that say how it is distributed [kg]."#,
    ),
    (
        "scene.toml",
        "mass = 0.5",
        "mass = 2020-01-01",
        r#"scene.toml:31:8: error: `mass` is a date, expected a number in kg
  help: With `inertia`, or with shapes that say how it is distributed [kg]."#,
    ),
    (
        "scene.toml",
        "mass = 0.5",
        "mass = 0",
        r#"scene.toml:31:8: error: `mass` is 0, expected a number in kg, greater than 0
  help: With `inertia`, or with shapes that say how it is distributed [kg]."#,
    ),
    (
        "scene.toml",
        "stiffness = 30.0",
        "stiffness = -1.0",
        r#"scene.toml:7:24: error: `stiffness` is -1, expected a number in N·m/rad or N/m, at least 0
  help: Torque a radian, or force a metre; default 0 with a `law` or a `table` [N·m/rad] or [N/m]."#,
    ),
    (
        "scene.toml",
        "radius = 0.05",
        "radius = 0.0",
        r#"scene.toml:15:35: error: `radius` is 0, expected a number in m, greater than 0
  help: Radius [m]."#,
    ),
    (
        "scene.toml",
        "{ slope = 1.0 }",
        "{ slope = 1.0 }, sine = { amplitude = 1.0, frequency_hz = 1.0 }",
        r#"scene.toml:26:66: error: `ramp` and `sine` exclude each other
  help: leave all but one out"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        "{ }",
        "scene.toml:26:40: error: one of `constant`, `step`, `ramp`, `sine`, `pulse`, `table` is missing in `command`",
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        "{ rampp = { slope = 1.0 } }",
        r#"scene.toml:26:42: error: unknown key `rampp` in `command`
  help: did you mean `ramp`? keys here: `constant`, `pulse`, `ramp`, `sine`, `step`, `table`"#,
    ),
    (
        "scene.toml",
        "cylinder = { radius",
        "sphere = { radius = 1.0 }, cylinder = { radius",
        r#"scene.toml:15:13: error: `cylinder` and `sphere` exclude each other
  help: leave all but one out"#,
    ),
    (
        "scene.toml",
        "spring = {",
        "spring = 3 #",
        r#"scene.toml:7:10: error: `spring` is the number 3, expected a table of `law`, `rest`, `stiffness`, `table` or a list of tables
  help: Spring: τ = −stiffness·(q − rest); a list for several degrees of freedom."#,
    ),
    (
        "scene.toml",
        r#"[[frame]]
name = "tip""#,
        r#"[[frame]]
name = "tip"
rotation_deg = [0, 0, 0]
quaternion_wxyz = [1, 0, 0, 0]"#,
        r#"scene.toml:20:1: error: `rotation_deg` and `quaternion_wxyz` exclude each other
  help: leave all but one out"#,
    ),
    (
        "scene.toml",
        "[[frame]]",
        "[[frme]]",
        r#"scene.toml:17:3: error: unknown key `frme`
  help: did you mean `frame`? keys here: `frame`, `force`, `format`, `parameters`, `camera`, `rest_speed`, `air_density`, `drag` and 18 more"#,
    ),
    (
        "experiment.toml",
        r#"record = ["/shoulder.position", "energy.total"]"#,
        "record = []",
        r#"experiment.toml:5:10: error: `record` is empty, expected at least one entry
  help: Names of the signals to be recorded, such as `/shoulder.position` or `energy.total`."#,
    ),
    (
        "experiment.toml",
        "step = 0.01",
        "step = 0.0",
        r#"experiment.toml:4:8: error: `step` is 0, expected a number in s, greater than 0
  help: Base step: commands are held over it, rows are recorded at its ends [s]."#,
    ),
    (
        "experiment.toml",
        "duration = 1.0",
        "duration = -1.0",
        r#"experiment.toml:3:12: error: `duration` is -1, expected a number in s, greater than 0
  help: How long is simulated: a whole number of steps [s]."#,
    ),
    (
        "experiment.toml",
        r#"duration = 1.0
"#,
        r#"duration = 1.0
accuracy = 0.0
"#,
        r#"experiment.toml:4:12: error: `accuracy` is 0, expected a number, greater than 0
  help: Local tolerance of the variable-step methods."#,
    ),
    (
        "experiment.toml",
        r#"duration = 1.0
"#,
        r#"duration = 1.0
record_every = 2.5
"#,
        r#"experiment.toml:4:16: error: `record_every` is the number 2.5, expected a whole number
  help: Base steps for each recorded row."#,
    ),
    (
        "experiment.toml",
        r#"duration = 1.0
"#,
        r#"duration = 1.0
integrator = "RK4"
"#,
        r#"experiment.toml:4:14: error: `integrator` is "RK4", expected one of `auto`, `semi-implicit-euler`, `rk4`, `implicit`, `dormand-prince`, `dormand-prince-8`, `stiff`
  help: did you mean `rk4`?"#,
    ),
    (
        "experiment.toml",
        r#"duration = 1.0
"#,
        "",
        r#"experiment.toml:1:1: error: `duration` is missing
  help: `duration`: How long is simulated: a whole number of steps [s]."#,
    ),
    (
        "experiment.toml",
        r#"value = "2*k"
tolerance = 1e-6"#,
        r#"value = "2*k""#,
        r#"experiment.toml:11:8: error: `tolerance` is missing in check `angle`
  help: it is the largest difference that holds; `at_most` needs none"#,
    ),
    (
        "experiment.toml",
        r#"value = "2*k"
tolerance = 1e-6"#,
        r#"value = "2*k"
tolerance = -1.0"#,
        r#"experiment.toml:15:13: error: `tolerance` is -1, expected a number, at least 0
  help: With `value` or `reference`: largest difference that holds, in the unit of what is checked (without unit if `relative`)."#,
    ),
    (
        "experiment.toml",
        r#"value = "2*k"
tolerance = 1e-6"#,
        r#"at_most = "2*k"
tolerance = 1e-6"#,
        r#"experiment.toml:15:1: error: `tolerance` has no meaning with `at_most`
  help: leave it out: `at_most` is exact"#,
    ),
    (
        "experiment.toml",
        r#"value = "2*k"
tolerance = 1e-6"#,
        r#"value = "2*k"
tolerance = 1e-6
target = 1.0"#,
        r#"experiment.toml:16:1: error: `target` has no meaning for the measure `error`
  help: it belongs to `overshoot`, `rise-time` and `settling-time`"#,
    ),
    (
        "experiment.toml",
        r#"value = "2*k"
"#,
        "",
        "experiment.toml:11:8: error: one of `value`, `reference`, `at_most`, `at_least`, `diverges` is missing in check `angle`",
    ),
    (
        "experiment.toml",
        r#"signal = "/shoulder.position"
at"#,
        "at",
        "experiment.toml:24:8: error: one of `signal`, `signals` is missing in check `at half time`",
    ),
    (
        "experiment.toml",
        "at = 0.5",
        r#"at = 0.5
window = [0.0, 1.0]"#,
        r#"experiment.toml:27:1: error: `at` and `window` exclude each other
  help: leave all but one out"#,
    ),
    (
        "experiment.toml",
        "range = {",
        r#"values = [1.0]
range = {"#,
        r#"experiment.toml:39:1: error: `range` and `values` exclude each other
  help: leave all but one out"#,
    ),
    (
        "experiment.toml",
        r#"title = "Test""#,
        r#"title = "Test"#,
        r#"experiment.toml:1:14: error: invalid basic string, expected `"`
  help: the file is TOML: https://toml.io/en/v1.1.0"#,
    ),
];

#[test]
fn structure_is_checked() {
    for (file, from, to, said) in CASES {
        assert_eq!(refused(file, from, to), *said, "{from:?} replaced by {to:?}");
    }
}

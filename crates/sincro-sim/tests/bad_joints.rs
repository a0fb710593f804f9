//! Joints, motors and signals.
//!
//! Each case changes one thing in the folder of the sprung arm and states the whole message.

use sincro_testing::scenes::refused;

/// File, what is replaced, by what, and what is said.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        "scene.toml",
        "axis = [0.0, 1.0, 0.0]",
        "axis = [0.0, 0.0, 0.0]",
        r#"scene.toml:6:8: error: axis [0.0, 0.0, 0.0] of `/shoulder` has no direction
  help: give three finite numbers, not all zero"#,
    ),
    (
        "scene.toml",
        "axis = [0.0, 1.0, 0.0]",
        "axis2 = [0.0, 1.0, 0.0]",
        r#"scene.toml:6:1: error: `axis2` has no meaning for a revolute joint
  help: leave it out"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute""#,
        r#"kind = "screw""#,
        r#"scene.toml:4:8: error: `pitch` is missing in joint `shoulder`
  help: a screw joint needs its advance, `pitch` [m/rad]"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute""#,
        r#"kind = "ball"
#"#,
        r#"scene.toml:7:1: error: `axis` has no meaning for a ball joint
  help: leave it out"#,
    ),
    (
        "scene.toml",
        "command = { ramp",
        "max_torque = 0.0, command = { ramp",
        r#"scene.toml:26:43: error: `max_torque` is 0, expected a number in N·m or N, greater than 0
  help: Largest torque or force, above 0; none if left out or inf [N·m] or [N]. A joint that nothing drives has mode `free`."#,
    ),
    (
        "scene.toml",
        "command = { ramp",
        "max_torque = -2.0, command = { ramp",
        r#"scene.toml:26:43: error: `max_torque` is -2, expected a number in N·m or N, greater than 0
  help: Largest torque or force, above 0; none if left out or inf [N·m] or [N]. A joint that nothing drives has mode `free`."#,
    ),
    (
        "scene.toml",
        "command = { ramp",
        "max_torque = nan, command = { ramp",
        r#"scene.toml:26:43: error: `max_torque` is not a number, expected a finite number in N·m or N
  help: Largest torque or force, above 0; none if left out or inf [N·m] or [N]. A joint that nothing drives has mode `free`."#,
    ),
    (
        "scene.toml",
        "damping = 0.5",
        "damping = [0.5, 0.5]",
        r#"scene.toml:8:11: error: `damping` of `/shoulder` has 2 entries, the joint has 1 degrees of freedom
  help: give one entry a degree of freedom"#,
    ),
    (
        "scene.toml",
        "damping = 0.5",
        "damping = -0.5",
        r#"scene.toml:8:11: error: damping -0.5 of `/shoulder` is negative or not finite
  help: give zero or more"#,
    ),
    (
        "scene.toml",
        "initial = { position = 0.1 }",
        "initial = { position = [0.1, 0.2] }",
        r#"scene.toml:9:24: error: initial position of joint `/shoulder`: 2 numbers given, expected 1
  help: give one number in rad or rad/s"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute"
motor"#,
        r#"kind = "ball"
initial = { position = [1, 0, 0, 0.1] }
# motor"#,
        r#"scene.toml:26:24: error: initial position of joint `/shoulder/rod/tip/wrist`: the quaternion [1.0, 0.0, 0.0, 0.1] has length 1.004987562112089, expected 1
  help: did you mean [0.9950371902099893, 0.0, 0.0, 0.09950371902099893]?"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute"
motor"#,
        r#"kind = "ball"
initial = { position = [0, 0, 0, 0] }
# motor"#,
        r#"scene.toml:26:24: error: initial position of joint `/shoulder/rod/tip/wrist`: the quaternion [0.0, 0.0, 0.0, 0.0] has no direction
  help: no rotation is [1, 0, 0, 0]: w, x, y, z"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute"
motor"#,
        r#"kind = "ball"
motor"#,
        r#"scene.toml:26:9: error: joint `/shoulder/rod/tip/wrist` has 3 degrees of freedom and 1 motors
  help: give a list with one motor for each degree of freedom, with mode `free` for those without"#,
    ),
    (
        "scene.toml",
        r#"kind = "revolute"
motor"#,
        r#"kind = "fixed"
initial = { velocity = 1 }
# motor"#,
        r#"scene.toml:26:24: error: initial velocity of joint `/shoulder/rod/tip/wrist`: a fixed joint does not move
  help: leave `initial` out"#,
    ),
    (
        "scene.toml",
        r#"mode = "velocity", "#,
        r#"mode = "velocity", kp = 3.0, "#,
        r#"scene.toml:26:30: error: `kp` has no meaning for a motor in mode `velocity`
  help: leave it out"#,
    ),
    (
        "scene.toml",
        r#"mode = "velocity", "#,
        r#"mode = "position", "#,
        r#"scene.toml:26:18: error: `kp` is missing: mode `position` needs it
  help: give `kp` [1/s]"#,
    ),
    (
        "scene.toml",
        "slope = 1.0",
        "slope = 1.0, start = 2.0, until = 1.0",
        r#"scene.toml:26:85: error: the ramp ends at 1 s, before it starts at 2 s
  help: `until` is a time after `start`"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        "{ pulse = { period = 1.0, width = 2.0 } }",
        r#"scene.toml:26:74: error: pulses of 2 s do not fit in a period of 1 s
  help: `width` is at most `period`"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        "{ table = { times = [0.0, 1.0, 1.0], values = [0.0, 1.0, 2.0] } }",
        r#"scene.toml:26:71: error: time 1 s does not come after 1 s
  help: times increase"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        "{ table = { times = [0.0, 1.0], values = [0.0] } }",
        r#"scene.toml:26:81: error: 1 values for 2 times
  help: give one value for each of `times`"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        r#"{ table = { file = "reference.csv", column = "y" } }"#,
        r#"scene.toml:26:85: error: `reference.csv` has no column `y`
  help: columns: `t`, `x`"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        r#"{ table = { file = "refrence.csv", column = "x" } }"#,
        r#"scene.toml:26:59: error: there is no file `refrence.csv`
  help: did you mean `reference.csv`?"#,
    ),
    (
        "scene.toml",
        "{ ramp = { slope = 1.0 } }",
        r#"{ table = { file = "reference.csv" } }"#,
        r#"scene.toml:26:50: error: `column` is missing in `table`
  help: `column` names the column of values in the file"#,
    ),
];

#[test]
fn joints_are_checked() {
    for (file, from, to, said) in CASES {
        assert_eq!(refused(file, from, to), *said, "{from:?} replaced by {to:?}");
    }
}

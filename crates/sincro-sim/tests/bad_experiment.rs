//! Times, checks, references, sweeps and variants.
//!
//! Each case changes one thing in the folder of the sprung arm and states the whole message.

use sincro_testing::scenes::refused;

/// File, what is replaced, by what, and what is said.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        "experiment.toml",
        "duration = 1.0",
        "duration = 1.005",
        r#"experiment.toml:3:12: error: duration 1.005 s is not a whole number of steps of 0.01 s
  help: use 1 or 1.01, or another step"#,
    ),
    (
        "experiment.toml",
        "step = 0.01",
        "step = 2.0",
        r#"experiment.toml:3:12: error: duration 1 s is shorter than one step of 2 s
  help: use 2 s or more, or a smaller step
experiment.toml:26:6: error: no row is recorded at 0.5 s
  help: use 0 or 2
experiment.toml:33:10: error: no row is recorded from 0.5 s to 1 s
  help: rows are recorded at 0 s and 2 s"#,
    ),
    (
        "experiment.toml",
        r#""energy.total"]"#,
        r#""/shoulder.position"]"#,
        r#"experiment.toml:5:33: error: `/shoulder.position` is recorded twice
  help: first in line 5, column 11"#,
    ),
    (
        "experiment.toml",
        "window = [0.5, 1.0]",
        "window = [0.5, 1.5]",
        r#"experiment.toml:33:10: error: the window from 0.5 s to 1.5 s is not inside the run, which lasts 1 s
  help: use times from 0 to 1"#,
    ),
    (
        "experiment.toml",
        "window = [0.5, 1.0]",
        "window = [0.9, 0.5]",
        r#"experiment.toml:33:10: error: the window ends at 0.5, before it begins at 0.9
  help: give the earlier end first"#,
    ),
    (
        "experiment.toml",
        "window = [0.5, 1.0]",
        "window = [0.501, 0.502]",
        r#"experiment.toml:33:10: error: no row is recorded from 0.501 s to 0.502 s
  help: rows are recorded at 0.5 s and 0.51 s"#,
    ),
    (
        "experiment.toml",
        "at = 0.5",
        "at = 0.505",
        r#"experiment.toml:26:6: error: no row is recorded at 0.505 s
  help: use 0.5 or 0.51"#,
    ),
    (
        "experiment.toml",
        "at = 0.5",
        "at = 5.0",
        r#"experiment.toml:26:6: error: 5 s is outside of the run, which lasts 1 s
  help: use a time within the run, or a longer duration"#,
    ),
    (
        "experiment.toml",
        r#""k*x + 0""#,
        r#""k*y + 0""#,
        r#"experiment.toml:13:14: error: formula: unknown name `y`
  help: it knows `x`, `t`, `k`"#,
    ),
    ("experiment.toml", r#""k*x + 0""#, r#""k*(x + 0""#, "experiment.toml:13:14: error: formula: `(` is never closed"),
    (
        "experiment.toml",
        r#""2*k""#,
        r#""2*siin(k)""#,
        r#"experiment.toml:14:12: error: formula: unknown function `siin`
  help: did you mean `sin`?"#,
    ),
    (
        "experiment.toml",
        r#"formula = "k*x + 0"
"#,
        "",
        r#"experiment.toml:12:1: error: `formula` is missing in check `angle`
  help: `signals` names what a formula is made of; `signal` is checked as it is"#,
    ),
    (
        "experiment.toml",
        "signals = { x =",
        "signals = { k =",
        r#"experiment.toml:12:13: error: `k` cannot stand for a signal
  help: a parameter has that name; give the signal another one
experiment.toml:13:14: error: formula: unknown name `x`
  help: it knows `k`, `t`"#,
    ),
    (
        "experiment.toml",
        "k = 30.0",
        "t = 30.0",
        r#"experiment.toml:8:1: error: `t` cannot be the name of a parameter
  help: `t` has a meaning of its own in formulas
experiment.toml:13:12: error: formula: unknown name `k`
  help: it knows `x`, `t`
experiment.toml:14:12: error: formula: unknown name `k`
  help: it knows `x`, `t`"#,
    ),
    (
        "experiment.toml",
        "k = 30.0",
        r#"k = 30.0
"2k" = 3"#,
        r#"experiment.toml:9:1: error: `2k` cannot be the name of a parameter
  help: formulas know names of letters, digits and `_` that begin with a letter"#,
    ),
    (
        "experiment.toml",
        r#"file = "reference.csv""#,
        r#"file = "missing.csv""#,
        r#"experiment.toml:20:22: error: there is no file `missing.csv`
  help: files there: `reference.csv`"#,
    ),
    (
        "experiment.toml",
        r#"file = "reference.csv""#,
        r#"file = "/etc/passwd""#,
        r#"experiment.toml:20:22: error: the path `/etc/passwd` is absolute
  help: give it relative to the folder, so that the folder can be moved"#,
    ),
    (
        "experiment.toml",
        r#"column = "x""#,
        r#"column = "X1""#,
        r#"experiment.toml:20:48: error: `reference.csv` has no column `X1`
  help: did you mean `x`? columns: `t`, `x`"#,
    ),
    (
        "experiment.toml",
        r#"column = "x""#,
        r#"column = "x", parameter = "K""#,
        r#"experiment.toml:20:53: error: `parameter` has no meaning here
  help: rows are lined up by `time`"#,
    ),
    (
        "reference.csv",
        "0.5,1",
        "0.5,one",
        r#"reference.csv:3:5: error: `one` in column `x` is not a finite number
  help: numbers have a decimal point, columns are separated by commas"#,
    ),
    (
        "reference.csv",
        "0.5,1",
        "0,1",
        r#"reference.csv:3:1: error: `t` 0 does not come after 0
  help: rows are ordered, each later than the one before"#,
    ),
    (
        "experiment.toml",
        r#"name = "reference""#,
        r#"name = "angle""#,
        r#"experiment.toml:18:8: error: there are two checks `angle`
  help: the other one is in line 11"#,
    ),
    (
        "experiment.toml",
        "to = 30.0",
        "to = 35.0",
        r#"experiment.toml:39:29: error: from 10 to 35 is not a whole number of steps of 10
  help: use 30, or another step"#,
    ),
    (
        "experiment.toml",
        "step = 10.0",
        "step = -10.0",
        r#"experiment.toml:39:42: error: steps of -10 do not lead from 10 to 30
  help: the step is not zero and goes from `from` towards `to`"#,
    ),
    (
        "experiment.toml",
        r#"parameter = "/shoulder.spring.stiffness""#,
        r#"parameter = "/shoulder.spring.stifness""#,
        r#"experiment.toml:38:13: error: `/shoulder.spring.stifness`: `spring` has no `stifness`
  help: did you mean `stiffness`? keys: `law`, `rest`, `stiffness`, `table`"#,
    ),
    (
        "experiment.toml",
        r#"set = { "/shoulder.spring.stiffness" = 10.0"#,
        r#"set = { "/shoulder.spring.stiffness" = -10.0"#,
        r#"experiment.toml:43:40: error: `stiffness` is -10, expected a number in N·m/rad or N/m, at least 0
  help: Torque a radian, or force a metre; default 0 with a `law` or a `table` [N·m/rad] or [N/m]."#,
    ),
    (
        "experiment.toml",
        r#"set = { "/shoulder.spring.stiffness" = 10.0"#,
        r#"set = { "/elbow.spring.stiffness" = 10.0"#,
        r#"experiment.toml:43:9: error: there is no object `/elbow`
  help: objects: `/shoulder`, `/shoulder/rod/tip/wrist`, `/shoulder/rod`, `/shoulder/rod/tip/wrist/hand`, `/shoulder/rod/tip`"#,
    ),
    (
        "experiment.toml",
        r#""integrator" = "rk4""#,
        r#""integrator" = "rk5""#,
        r#"experiment.toml:43:61: error: `integrator` is "rk5", expected one of `auto`, `semi-implicit-euler`, `rk4`, `implicit`, `dormand-prince`, `dormand-prince-8`, `stiff`
  help: did you mean `rk4`?"#,
    ),
    (
        "experiment.toml",
        r#"name = "soft""#,
        r#"name = "a/b""#,
        r#"experiment.toml:42:8: error: `a/b` is not a name of a variant
  help: names have letters a–z and A–Z, digits, `_`, `-` and `.`"#,
    ),
    (
        "experiment.toml",
        r#"name = "late""#,
        r#"name = "late"
floor = 1.0"#,
        r#"experiment.toml:32:1: error: `floor` without `relative = true`
  help: it is the least divisor of a relative difference"#,
    ),
    (
        "experiment.toml",
        r#"duration = 1.0
"#,
        r#"duration = 1.0
record_every = 3
"#,
        r#"experiment.toml:4:16: warning: the end of the run is not recorded: 100 steps, one row every 3
  help: let `record_every` divide the number of steps
experiment.toml:27:6: error: no row is recorded at 0.5 s
  help: use 0.48 or 0.51"#,
    ),
    (
        "experiment.toml",
        r#"scene = "scene.toml""#,
        r#"scene = "secne.toml""#,
        r#"experiment.toml:2:9: error: there is no file `secne.toml`
  help: did you mean `scene.toml`? files there: `experiment.toml`, `scene.toml`"#,
    ),
    (
        "experiment.toml",
        r#"set = { "/shoulder"#,
        r#"inherit_checks = true
set = { "duration" = 0.25, "/shoulder"#,
        r#"experiment.toml:26:6: error: in variant `soft` 0.5 s is outside of the run, which lasts 0.25 s
  help: use a time within the run, or a longer duration
experiment.toml:33:10: error: in variant `soft` the window from 0.5 s to 1 s is not inside the run, which lasts 0.25 s
  help: use times from 0 to 0.25"#,
    ),
];

#[test]
fn experiments_are_checked() {
    for (file, from, to, said) in CASES {
        assert_eq!(refused(file, from, to), *said, "{from:?} replaced by {to:?}");
    }
}

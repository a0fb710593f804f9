//! Who hangs on whom.
//!
//! Each case changes one thing in the folder of the sprung arm and states the whole message.

use sincro_testing::scenes::refused;

/// File, what is replaced, by what, and what is said.
const CASES: &[(&str, &str, &str, &str)] = &[
    (
        "scene.toml",
        r#"parent = "/shoulder/rod"
"#,
        r#"parent = "/sholder/rod"
"#,
        r#"scene.toml:19:10: error: there is no object `/sholder/rod` to hang `tip` on
  help: did you mean `/shoulder/rod`?"#,
    ),
    (
        "scene.toml",
        r#"parent = "/shoulder/rod"
"#,
        r#"parent = "/shoulder/rodd"
"#,
        r#"scene.toml:19:10: error: there is no object `/shoulder/rodd` to hang `tip` on
  help: did you mean `/shoulder/rod`? objects: `/shoulder`, `/shoulder/rod/tip/wrist`, `/shoulder/rod`, `/shoulder/rod/tip/wrist/hand`"#,
    ),
    (
        "scene.toml",
        r#"name = "shoulder""#,
        r#"name = "shoulder"
parent = "/hand""#,
        r#"scene.toml:25:10: error: `wrist` hangs on itself: wrist on tip on rod on shoulder on hand on wrist
  help: one of them must hang on something that hangs on the world, `/`"#,
    ),
    (
        "scene.toml",
        r#"name = "shoulder""#,
        r#"name = "shoulder"
parent = "/shoulder""#,
        r#"scene.toml:5:10: error: `shoulder` hangs on itself: shoulder on shoulder
  help: one of them must hang on something that hangs on the world, `/`"#,
    ),
    (
        "scene.toml",
        r#"name = "shoulder""#,
        r#"name = "left shoulder""#,
        r#"scene.toml:4:8: error: `left shoulder` is not a name
  help: names have letters a–z and A–Z, digits, `_` and `-`; `#` and a number may end them, as of copies of V-REP 3
scene.toml:13:10: error: there is no object `/shoulder` to hang `rod` on
  help: did you mean `/shoulder/rod/tip`? objects: `/left shoulder`, `/shoulder/rod/tip/wrist`, `/shoulder/rod/tip/wrist/hand`, `/shoulder/rod/tip`"#,
    ),
    (
        "scene.toml",
        r#"[[frame]]
name = "tip""#,
        r#"[[frame]]
name = "tip"
parent = "/shoulder/rod"

[[frame]]
name = "tip""#,
        r#"scene.toml:22:8: error: there are two objects `/shoulder/rod/tip`
  help: the other one is in line 18; give one of them another name or parent"#,
    ),
    (
        "scene.toml",
        r#"name = "hand"
parent = "/shoulder/rod/tip/wrist""#,
        r#"name = "hand"
parent = "/shoulder""#,
        r#"scene.toml:23:8: error: joint `/shoulder/rod/tip/wrist` carries no body
  help: hang a body on it, or make it a frame"#,
    ),
    (
        "scene.toml",
        "[[frame]]",
        r#"[[force]]
name = "push"
parent = "/shoulder"

[[frame]]"#,
        r#"scene.toml:19:10: error: force `/shoulder/push` acts on `/shoulder`, which is no body and no frame
  help: the parent of a force is a body or a frame"#,
    ),
    (
        "scene.toml",
        "[[frame]]",
        r#"[[body]]
name = "base"
mass = 1.0
inertia = { xx = 1, yy = 1, zz = 1 }

[[force]]
name = "push"
parent = "/base"
force = [1, 0, 0]

[[frame]]"#,
        r#"loads
scene.toml:23:8: warning: force `/base/push` acts on something that is fixed in the world
  help: it moves nothing; hang its parent on a joint"#,
    ),
];

#[test]
fn the_tree_is_checked() {
    for (file, from, to, said) in CASES {
        assert_eq!(refused(file, from, to), *said, "{from:?} replaced by {to:?}");
    }
}

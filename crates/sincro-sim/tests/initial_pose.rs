//! Starts by poses of frames: joints found by inverse kinematics at load, and what is refused.

use sincro_testing::SceneFolder;

/// An arm of six revolute joints, links of 0.4, 0.3 and 0.2 m, with a tool.
const SCENE: &str = r#"initial_pose = { frame = "tool", position = [0.35, 0.2, 0.45], rotation_deg = [20.0, 110.0, -15.0] }

[[joint]]
name = "j1"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
initial = { position = 0.2, velocity = 0.5 }
[[body]]
name = "a"
parent = "/j1"
density = 1000.0
shape = [{ cylinder = { radius = 0.04, length = 0.1 } }]

[[joint]]
name = "j2"
parent = "/j1/a"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, 0.2]
initial = { position = 0.4 }
[[body]]
name = "b"
parent = "/j1/a/j2"
position = [0.0, 0.0, 0.2]
density = 1000.0
shape = [{ cylinder = { radius = 0.03, length = 0.4 } }]

[[joint]]
name = "j3"
parent = "/j1/a/j2/b"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, 0.2]
initial = { position = 0.9 }
[[body]]
name = "c"
parent = "/j1/a/j2/b/j3"
position = [0.0, 0.0, 0.15]
density = 1000.0
shape = [{ cylinder = { radius = 0.02, length = 0.3 } }]

[[joint]]
name = "wrist"
parent = "/j1/a/j2/b/j3/c"
kind = "universal"
axis = [0.0, 0.0, 1.0]
axis2 = [0.0, 1.0, 0.0]
position = [0.0, 0.0, 0.15]
initial = { position = [0.1, 0.5] }
[[body]]
name = "d"
parent = "/j1/a/j2/b/j3/c/wrist"
density = 1000.0
shape = [{ sphere = { radius = 0.03 } }]

[[joint]]
name = "j6"
parent = "/j1/a/j2/b/j3/c/wrist/d"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
[[body]]
name = "hand"
parent = "/j1/a/j2/b/j3/c/wrist/d/j6"
position = [0.0, 0.0, 0.05]
density = 1000.0
shape = [{ cylinder = { radius = 0.02, length = 0.1 } }]
[[frame]]
name = "tool"
parent = "/j1/a/j2/b/j3/c/wrist/d/j6/hand"
position = [0.0, 0.0, 0.05]
"#;

const EXPERIMENT: &str = "title = \"Arm\"\nduration = 0.01\nstep = 0.01\nrecord = [\"tool.position.x\", \"tool.position.y\", \"tool.position.z\", \"tool.roll\", \"tool.pitch\", \"tool.yaw\", \"/j1.velocity\"]\n";

fn start(folder: &SceneFolder, settings: &[&str]) -> Result<Vec<f64>, String> {
    let loaded = folder.load(settings)?;
    let simulated = sincro_testing::run(&loaded);
    Ok(simulated.table.columns.iter().skip(1).map(|c| c.values[0]).collect())
}

#[test]
fn the_tool_starts_where_it_is_asked_to() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    let found = start(&folder, &[]).unwrap();
    // pitch 110° is roll and yaw turned by 180° and a pitch of 70°
    let expected =
        [0.35, 0.2, 0.45, (20.0_f64 - 180.0).to_radians(), 70_f64.to_radians(), (180.0_f64 - 15.0).to_radians(), 0.5];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    // a position alone
    let found = start(
        &folder,
        &["initial_pose={ frame = \"/j1/a/j2/b/j3/c/wrist/d/j6/hand/tool\", position = [-0.3, 0.3, 0.5] }"],
    )
    .unwrap();
    assert!((found[0] + 0.3).abs() < 1e-9 && (found[1] - 0.3).abs() < 1e-9 && (found[2] - 0.5).abs() < 1e-9);
    // two frames at once
    let two = "initial_pose=[{ frame = \"/j1/a/j2/b/j3/c/wrist/d\", position = [0.3, 0.1, 0.55] }, { frame = \"/j1/a/j2/b/j3/c/wrist/d/j6/hand/tool\", position = [0.36, 0.1, 0.47] }]";
    let found = start(&folder, &[two]).unwrap();
    assert!((found[0] - 0.36).abs() < 1e-9 && (found[2] - 0.47).abs() < 1e-9);
}

/// Setting and parts of the message.
const REFUSED: &[(&str, &[&str])] = &[
    ("{ frame = \"tool\", position = [2.0, 0.0, 0.5] }", &["the initial pose cannot be reached: 1.", "e0 m"]),
    ("{ frame = \"tol\", position = [0.3, 0.0, 0.5] }", &["`tol`", "tool"]),
    ("{ frame = \"tool\" }", &["the pose of `/j1/a/j2/b/j3/c/wrist/d/j6/hand/tool` says nothing"]),
    ("{ frame = \"tool\", position = [0.3, nan, 0.5] }", &["position[1]"]),
    ("{ frame = \"tool\", positon = [0.3, 0.0, 0.5] }", &["unknown key `positon`"]),
    ("{ position = [0.3, 0.0, 0.5] }", &["`frame` is missing"]),
    ("{ frame = \"/j1\", position = [0.3, 0.0, 0.5] }", &["there is no body or frame `/j1`"]),
];

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    for (pose, expected) in REFUSED {
        let folder = SceneFolder::of(SCENE, EXPERIMENT);
        let given = SCENE.lines().next().unwrap();
        folder.change("scene.toml", given, &format!("initial_pose = {pose}"));
        let message = folder.load(&[]).err().unwrap_or_else(|| panic!("{pose} is not refused"));
        assert!(message.starts_with("scene.toml:1"), "{message}");
        for part in *expected {
            assert!(message.contains(part), "{pose}: {message}");
        }
    }
}

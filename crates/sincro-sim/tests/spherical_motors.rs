//! Motors of joints with several axes in scene files: commands, signals, diagrams, messages.

use sincro_testing::{SceneFolder, last};

const SCENE: &str = r#"
format = 2
gravity = [0, 0, 0]

[[joint]]
name = "eye"
kind = "ball"
motor = [
  { mode = "velocity", command = 0.3 },
  { mode = "torque", command = { step = { time = 0.5, to = 0.2 } }, max_torque = 1.0 },
  { mode = "free" },
]

[[body]]
name = "ball"
parent = "/eye"
mass = 2.0
inertia = { xx = 0.4, yy = 0.4, zz = 0.4 }
"#;

const EXPERIMENT: &str = r#"
format = 2
title = "An eye"
duration = 1.0
step = 0.01
record = ["/eye.command.x", "/eye.velocity", "/eye.motor_torque_now.y"]
"#;

fn folder(scene: &str) -> SceneFolder {
    SceneFolder::of(scene, EXPERIMENT)
}

#[test]
fn each_axis_follows_its_own_command() {
    let run = sincro_testing::run(&folder(SCENE).load(&[]).unwrap_or_else(|e| panic!("{e}")));
    assert_eq!((last(&run, "/eye.command.x"), last(&run, "/eye.velocity.x")), (0.3, 0.3));
    // about y 0.2 N·m for half a second on 0.4 kg·m²; x is held, and a sphere couples nothing
    assert!((last(&run, "/eye.velocity.y") - 0.25).abs() < 1e-12);
    assert_eq!(last(&run, "/eye.motor_torque_now.y"), 0.2);
    assert!(last(&run, "/eye.velocity.z").abs() < 1e-15);
}

#[test]
fn a_diagram_commands_the_axes_of_a_ball_joint() {
    let folder = folder(SCENE);
    folder.write(
        "diagram.toml",
        "wires = [\"rate -> /eye.command.x\", \"/eye.velocity -> seen\"]\n\n\
         [[block]]\nname = \"rate\"\ntype = \"constant\"\nvalue = -0.7\n\n\
         [[block]]\nname = \"seen\"\ntype = \"gain\"\ngain = 1.0\n",
    );
    folder.change("experiment.toml", "duration", "diagram = \"diagram.toml\"\nduration");
    let run = sincro_testing::run(&folder.load(&[]).unwrap_or_else(|e| panic!("{e}")));
    assert_eq!((last(&run, "/eye.command.x"), last(&run, "/eye.velocity.x")), (-0.7, -0.7));
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let cases = [
        (("  { mode = \"free\" },\n", ""), "joint `/eye` has 3 degrees of freedom and 2 motors"),
        (
            ("{ mode = \"free\" }", "{ mode = \"free\", command = 1.0 }"),
            "`command` has no meaning for a motor in mode `free`",
        ),
        (("{ mode = \"free\" }", "{ mode = \"position\", kp = 2.0 }"), "no list of positions"),
        (("command = 0.3", "command = 0.3, max_torque = -1.0"), "`max_torque` is -1"),
        (("command = 0.3", "command_rpm = 3.0"), "its coordinates are not all angles"),
    ];
    for ((from, to), expected) in cases {
        let scene = SCENE.replacen(from, to, 1);
        assert_ne!(scene, SCENE);
        let message = folder(&scene).load(&[]).map(|_| ()).unwrap_err();
        assert!(message.contains(expected), "{message}");
    }
}

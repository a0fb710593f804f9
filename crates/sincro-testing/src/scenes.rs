//! Scenes that several crates test with, as texts of their files.

use crate::folder::SceneFolder;

/// A rod on a sprung and damped shoulder, a hand on a driven wrist: something of everything that a scene file has.
pub const SPRUNG_ARM: &str = r##"gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
spring = { stiffness = 30.0, rest = 0.0 }
damping = 0.5
initial = { position = 0.1 }

[[body]]
name = "rod"
parent = "/shoulder"
density = 1000.0
shape = [ { cylinder = { radius = 0.05, length = 0.5 }, position = [0.0, 0.0, 0.25], color = "#8a5a2b" } ]

[[frame]]
name = "tip"
parent = "/shoulder/rod"
position = [0.0, 0.0, 0.5]

[[joint]]
name = "wrist"
parent = "/shoulder/rod/tip"
kind = "revolute"
motor = { mode = "velocity", command = { ramp = { slope = 1.0 } } }

[[body]]
name = "hand"
parent = "/shoulder/rod/tip/wrist"
mass = 0.5
inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }
"##;

/// Experiment of [`SPRUNG_ARM`] with checks of every kind, a sweep, a variant and a plot; it reads `reference.csv`.
pub const SPRUNG_ARM_EXPERIMENT: &str = r#"title = "Test"
scene = "scene.toml"
duration = 1.0
step = 0.01
record = ["/shoulder.position", "energy.total"]

[parameters]
k = 30.0

[[check]]
name = "angle"
signals = { x = "/shoulder.position" }
formula = "k*x + 0"
value = "2*k"
tolerance = 1e-6

[[check]]
name = "reference"
signal = "/shoulder.position"
reference = { file = "reference.csv", column = "x" }
tolerance = 1e-6

[[check]]
name = "at half time"
signal = "/shoulder.position"
at = 0.5
value = 1.0
tolerance = 1e-6

[[check]]
name = "late"
signal = "/shoulder.position"
window = [0.5, 1.0]
value = 1.0
tolerance = 1e-6

[sweep]
parameter = "/shoulder.spring.stiffness"
range = { from = 10.0, to = 30.0, step = 10.0 }

[[variant]]
name = "soft"
set = { "/shoulder.spring.stiffness" = 10.0, "integrator" = "rk4" }

[[plot]]
title = "Angle"
signals = ["/shoulder.position"]
"#;

/// Folder of [`SPRUNG_ARM`], to be changed by tests of what files may say.
#[must_use]
pub fn sprung_arm() -> SceneFolder {
    SceneFolder::of(SPRUNG_ARM, SPRUNG_ARM_EXPERIMENT).with("reference.csv", "t,x\n0,0\n0.5,1\n1,2\n")
}

/// Diagnostics of the folder of [`SPRUNG_ARM`] with one change in one file; `loads` and the warnings if it loads.
#[must_use]
pub fn refused(file: &str, from: &str, to: &str) -> String {
    let folder = sprung_arm();
    folder.change(file, from, to);
    match folder.load(&[]) {
        Ok(loaded) => {
            let warnings: Vec<String> = loaded.warnings.iter().map(|w| folder.short(&w.to_string())).collect();
            format!("loads\n{}", warnings.join("\n"))
        }
        Err(message) => message,
    }
}

/// An arm of two links in a vertical plane with velocity motors, a free ball, and a camera.
pub const TWO_LINK_ARM: &str = r#"
[[joint]]
name = "joint1"
kind = "revolute"
axis = [0.0, -1.0, 0.0]
motor = { mode = "velocity" }
[[body]]
name = "link1"
parent = "/joint1"
mass = 1.0
center_of_mass = [0.25, 0.0, 0.0]
inertia = { xx = 0.001, yy = 0.02, zz = 0.02 }
[[joint]]
name = "joint2"
parent = "/joint1/link1"
kind = "revolute"
axis = [0.0, -1.0, 0.0]
position = [0.5, 0.0, 0.0]
motor = { mode = "velocity" }
[[body]]
name = "link2"
parent = "/joint1/link1/joint2"
mass = 1.0
center_of_mass = [0.25, 0.0, 0.0]
inertia = { xx = 0.001, yy = 0.02, zz = 0.02 }
[[joint]]
name = "loose"
kind = "free"
[[body]]
name = "ball"
parent = "/loose"
density = 1000.0
shape = [{ sphere = { radius = 0.1 } }]
[[camera]]
name = "eye"
position = [0.0, -2.0, 0.0]
look_at = [0.0, 0.0, 0.0]
resolution = [16, 12]
near = 0.5
far = 4.5
"#;

/// Experiment of [`TWO_LINK_ARM`]: 2 s in steps of 5 ms, 50 ms for clients.
pub const TWO_LINK_ARM_EXPERIMENT: &str = r#"
title = "Arm"
duration = 2.0
step = 0.005
simulation_step = 0.05
record = ["/joint1.position", "/joint1/link1/joint2.position"]
"#;

/// Folder of [`TWO_LINK_ARM`]; `more` is put before the keys of the experiment.
#[must_use]
pub fn two_link_arm(more: &str) -> SceneFolder {
    SceneFolder::of(TWO_LINK_ARM, &format!("{more}{TWO_LINK_ARM_EXPERIMENT}"))
}

/// A box of 1 kg with edges of 0.1 m, free, whose centre is `height` `[m]` above a rough floor: at 0.05 it lies there.
#[must_use]
pub fn box_above_floor(height: f64) -> String {
    format!(
        r#"
[[body]]
name = "floor"
shape = [{{ plane = {{}} }}]
contact = {{ friction = 0.5 }}

[[joint]]
name = "box_joint"
kind = "free"
initial = {{ position = [0.0, 0.0, {height}, 1.0, 0.0, 0.0, 0.0] }}

[[body]]
name = "box"
parent = "/box_joint"
density = 1000.0
shape = [{{ cuboid = {{ size = [0.1, 0.1, 0.1] }} }}]
contact = {{ friction = 0.5 }}
"#
    )
}

/// A pendulum on a motor that takes torques, with a tip.
pub const MOTOR_PENDULUM: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
initial = { position = 0.5 }
motor = { mode = "torque" }

[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.0, 0.0, -0.5]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }

[[frame]]
name = "tip"
parent = "/hinge/arm"
position = [0.0, 0.0, -1.0]
"#;

/// Experiment of [`MOTOR_PENDULUM`]: five steps.
pub const MOTOR_PENDULUM_EXPERIMENT: &str = r#"
title = "test"
duration = 0.05
step = 0.01
error_bar = "none"
record = ["/hinge.position", "/hinge.motor_torque_now"]
"#;

/// A rod that swings on a hinge, released at 1 rad.
pub const ROD_PENDULUM: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
initial = { position = 1.0 }

[[body]]
name = "rod"
parent = "/hinge"
position = [0.0, 0.0, -0.25]
density = 1000.0
shape = [{ cylinder = { radius = 0.05, length = 0.5 } }]
"#;

/// A box on a floor, a load on a force sensor, a driven slide geared to a wheel, and a driven arm between limits.
pub const TOUCHING: &str = r#"
[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = 0.5 }

[[joint]]
name = "loose"
kind = "free"
initial = { position = [0.0, 0.0, 0.05, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "box"
parent = "/loose"
density = 1000.0
shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }]
contact = { friction = 0.5 }

[[joint]]
name = "scale"
kind = "fixed"
position = [1.0, 0.0, 1.0]
force_sensor = true
[[body]]
name = "load"
parent = "/scale"
mass = 2.0
center_of_mass = [0.1, 0.0, 0.0]
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[joint]]
name = "first"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
position = [-1.0, 0.0, 1.0]
limits = { lower = -0.5, upper = 1.0 }
motor = { mode = "velocity" }
[[body]]
name = "slide"
parent = "/first"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[joint]]
name = "second"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
position = [-2.0, 0.0, 1.0]
[[body]]
name = "wheel"
parent = "/second"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[coupling]]
name = "gear"
joints = ["/first", "/second"]
ratio = 4.0

[[joint]]
name = "arm"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
position = [-3.0, 0.0, 1.0]
limits = { lower = -0.5, upper = 1.0 }
motor = { mode = "velocity" }
[[body]]
name = "bar"
parent = "/arm"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"#;

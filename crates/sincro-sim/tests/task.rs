//! Tasks: episodes depend on their seeds alone; a diagram leaves the commands of controllers alone.

use std::path::{Path, PathBuf};

use sincro_blocks::library::sources::random::uniform;
use sincro_math::random::splitmix64;
use sincro_sim::prelude::*;
use sincro_sim::rollout::{Compile, StepsBy};
use sincro_sim::task::{Autoreset, Plan, Step, TaskWorlds};

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

/// Mark of a world that cannot go on.
const STOPPED: u64 = 77;

/// Everything that `n_steps` of `n` worlds give, world by world, whose actions are drawn from the world and the step.
fn episodes(worlds: &mut TaskWorlds, autoreset: Autoreset, n_steps: u64) -> Vec<Vec<u64>> {
    let (n, n_actions, n_observations) = (worlds.n_worlds(), worlds.plan().n_actions(), worlds.plan().n_observations());
    let seeds: Vec<Option<u64>> = (0..n as u64).map(|k| Some(7 + k)).collect();
    let mut step = Step::new(n, n_observations);
    worlds.reset(&seeds, &vec![true; n], &mut step.observations);
    let mut seen = vec![Vec::new(); n];
    let note = |seen: &mut Vec<Vec<u64>>, observations: &[f64]| {
        for (seen, row) in seen.iter_mut().zip(observations.chunks_exact(n_observations)) {
            seen.extend(row.iter().map(|x| x.to_bits()));
        }
    };
    note(&mut seen, &step.observations);
    let mut is_over = vec![false; n];
    for k in 0..n_steps {
        let action = |world: u64, i: u64| 12.0 * uniform(splitmix64(world, k), i) - 6.0;
        let actions: Vec<f64> =
            (0..n as u64).flat_map(|world| (0..n_actions as u64).map(move |i| action(world, i))).collect();
        worlds.step(&actions, autoreset, &mut step);
        for (world, seen) in seen.iter_mut().enumerate() {
            let row = world * n_observations..(world + 1) * n_observations;
            let flags = [step.terminated[world], step.truncated[world]].map(u64::from);
            let flags = flags.into_iter().chain([STOPPED * u64::from(step.stopped[world])]);
            let numbers = step.observations[row.clone()].iter().chain([&step.rewards[world]]);
            seen.extend(numbers.map(|x| x.to_bits()).chain(flags));
            let ended = step.terminated[world] || step.truncated[world];
            if ended && autoreset == Autoreset::SameStep {
                seen.extend(step.final_observations[row].iter().map(|x| x.to_bits()));
            }
            is_over[world] |= ended;
        }
        // worlds under way begin again, by other seeds
        if k % 41 == 40 {
            let mask: Vec<bool> = (0..n).map(|world| world % 5 == 1).collect();
            let seeds: Vec<Option<u64>> =
                (0..n as u64).map(|world| (world % 2 == 0).then_some(100 * k + world)).collect();
            worlds.reset(&seeds, &mask, &mut step.observations);
            note(&mut seen, &step.observations);
            is_over.iter_mut().zip(&mask).for_each(|(is_over, begun)| *is_over &= !begun);
        }
        // of those that wait, some begin anew
        if autoreset == Autoreset::Disabled && k % 7 == 6 {
            let mask: Vec<bool> = (0..n).map(|world| is_over[world] && world % 3 != 0).collect();
            worlds.reset(&vec![None; n], &mask, &mut step.observations);
            note(&mut seen, &step.observations);
            is_over.iter_mut().zip(&mask).for_each(|(is_over, begun)| *is_over &= !begun);
        }
    }
    seen
}

/// Asserts that all worlds gave the same bits.
fn assert_same(found: &[Vec<u64>], expected: &[Vec<u64>], context: &str) {
    assert_eq!(found.len(), expected.len());
    for (world, (found, expected)) in found.iter().zip(expected).enumerate() {
        let differs = found.iter().zip(expected).position(|(a, b)| a != b);
        let of = |k: usize| (k, f64::from_bits(found[k]), f64::from_bits(expected[k]));
        assert_eq!(differs.map(of), None, "{context}, world {world}");
        assert_eq!(found.len(), expected.len(), "{context}, world {world}");
    }
}

const TASKS: [&str; 5] = ["cart-pole-balance", "cart-pole-swing-up", "acrobot", "reacher-springs", "quadrotor-hover"];

#[test]
fn episodes_depend_on_their_seeds_alone() {
    for name in TASKS {
        let loaded = load(&scene(name), &[], Extensions::default()).unwrap();
        let of = |n: usize, threads: usize| {
            episodes(&mut TaskWorlds::new(&loaded, n, threads).unwrap(), Autoreset::SameStep, 120)
        };
        let (many, few) = (of(21, 3), of(2, 1));
        assert_eq!(many[..2], few[..], "{name}");
        assert_ne!(many[0], many[1], "{name}: seeds differ");
    }
}

/// A cart and pole with a task of its own, in a folder that is removed when it is dropped.
struct OwnTask(PathBuf);

impl OwnTask {
    fn new(name: &str, experiment: &str, diagram: &str) -> Self {
        Self::with_scene(name, experiment, diagram, |text| text)
    }

    /// With a scene that is changed further.
    fn with_scene(name: &str, experiment: &str, diagram: &str, change: impl Fn(String) -> String) -> Self {
        let folder = std::env::temp_dir().join(format!("sincro-task-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let text = std::fs::read_to_string(scene("cart-pole-balance").join("scene.toml")).unwrap();
        // a motor at the hinge, too
        let text =
            text.replace("parent = \"/rail/cart\"\n", "parent = \"/rail/cart\"\nmotor = { mode = \"torque\" }\n");
        std::fs::write(folder.join("scene.toml"), change(text)).unwrap();
        std::fs::write(folder.join("experiment.toml"), experiment).unwrap();
        std::fs::write(folder.join("control.toml"), diagram).unwrap();
        Self(folder)
    }
}

impl Drop for OwnTask {
    fn drop(&mut self) {
        _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Commands by formulas of signals, time and random numbers; formulas that are not compiled; a reward that is not
/// finite now and then.
const ODD_TASK: &str = r#"
title = "Odd"
duration = 1.0
step = 0.01
integrator = "rk4"
record = ["/rail.position"]

[task]
period = 0.05
time_limit = 0.6
signals = { x = "/rail.position", q = "/rail/cart/hinge.position", w = "/rail/cart/hinge.velocity", f = "/rail.command", e = "energy.kinetic" }
observations = ["x", "cos(q)", "f", "t", "push", "exp(-x^2)", "noise", "e", "if(w > 0, w, -2*w)"]
reward = "sqrt(0.08 - abs(q)) + x"
terminated = "w > 0.5 or hypot(x, q) > 0.079"

[task.commands]
"/rail" = "0.3*push + 5*x + t + noise + 0.01*f + exp(-x^2)*tanh(w) + atan2(q, 1 + floor(x))"

[[task.action]]
name = "push"
range = [-4.0, 5.0]

[[task.random]]
name = "noise"
normal = [0.0, 0.3]

[[task.random]]
signal = "/rail/cart/hinge.position"
range = [-0.05, 0.05]
"#;

/// The same with a diagram that holds the pole, at two rates and with memory of all kinds, and may fail.
fn task_with_diagram() -> String {
    ODD_TASK
        .replace("step = 0.01", "step = 0.01\ndiagram = \"control.toml\"")
        .replace("period = 0.05", "period = 0.04")
        .replace("f = \"/rail.command\"", "f = \"/rail/cart/hinge.command\", p = \"pid\", d = \"late\"")
        .replace("\"noise\", ", "\"noise\", \"p\", \"d\", ")
        .replace("0.08 - abs(q)", "0.02 - abs(q)")
}

const DIAGRAM: &str = r#"
sample_time = 0.01
wires = [
  "/rail/cart/hinge.position -> slow -> pid",
  "/rail/cart/hinge.velocity -> late -> both.v",
  "pid -> both.p",
  "/rail.position -> both.x",
  "both -> /rail/cart/hinge",
]

[[block]]
name = "slow"
type = "rate-limiter"
rising = 0.5

[[block]]
name = "pid"
type = "discrete-pid"
sample_time = 0.02
kp = -3.0
ki = -2.0
kd = -0.2
upper = 0.4

[[block]]
name = "late"
type = "unit-delay"
sample_time = 0.04
initial = 0.01

[[block]]
name = "both"
type = "expression"
inputs = ["p", "v", "x"]
expression = "if(x > 0.3, sqrt(0.31 - x), p - 0.1*v)"
"#;

#[test]
fn compiled_actions_have_the_bits_of_other_steps() {
    let width = sincro_math::lanes::width();
    let odd = OwnTask::new("odd", ODD_TASK, "");
    // starts that cannot be judged
    let late = OwnTask::new("late", &ODD_TASK.replace("+ x\"", "+ x + 0.001/t\""), "");
    let controlled = OwnTask::new("controlled", &task_with_diagram(), DIAGRAM);
    // actions too long for one program
    let long = |task: &str| task.replace("step = 0.01", "step = 0.0005");
    let long_odd = OwnTask::new("long", &long(ODD_TASK), "");
    let long_controlled = OwnTask::new("long-controlled", &long(&task_with_diagram()), DIAGRAM);
    let own = [&odd, &late, &controlled, &long_odd, &long_controlled];
    let scenes: Vec<PathBuf> = TASKS.iter().map(|name| scene(name)).chain(own.map(|own| own.0.clone())).collect();
    let mut n_compiled = 0;
    for path in &scenes {
        let loaded = load(path, &[], Extensions::default()).unwrap_or_else(|found| panic!("{found}"));
        let worlds = |compile| TaskWorlds::with_steps(&loaded, 3 * width + 1, 2, compile).unwrap();
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep, Autoreset::Disabled] {
            let mut compiled = worlds(Compile::IfPossible);
            if let StepsBy::Recursions { reason } = compiled.steps_by() {
                println!("{}: {reason}", path.display());
            }
            n_compiled += usize::from(matches!(compiled.steps_by(), StepsBy::Compiled { .. }));
            let expected = episodes(&mut worlds(Compile::Never), autoreset, 150);
            let found = episodes(&mut compiled, autoreset, 150);
            assert_same(&found, &expected, &format!("{}, {autoreset:?}", path.display()));
            if !TASKS.iter().any(|name| path.ends_with(name)) {
                let n = expected.iter().flatten().filter(|x| **x == STOPPED).count();
                assert!(n > 5, "worlds that cannot go on in {}: {n}", path.display());
            }
        }
    }
    let has_compiler = std::process::Command::new("cc").arg("--version").output().is_ok();
    if width > 1 && has_compiler && std::env::var_os("SINCRO_COMPILE").is_none() {
        assert_eq!(n_compiled, 9 * 3, "all but the quadrotor, whose rotors iterate");
    }
}

/// Worlds of the cart and pole that were stepped with `Autoreset::Disabled` until each second one is over.
fn half_over(compile: Compile) -> (TaskWorlds, Step, Vec<bool>) {
    let loaded = load(&scene("cart-pole-balance"), &[], Extensions::default()).unwrap();
    let n = 4 * sincro_math::lanes::width();
    let mut worlds = TaskWorlds::with_steps(&loaded, n, 1, compile).unwrap();
    let mut step = Step::new(n, worlds.plan().n_observations());
    worlds.reset(&(0..n as u64).map(Some).collect::<Vec<_>>(), &vec![true; n], &mut step.observations);
    let mut is_over = vec![false; n];
    for k in 0..30 {
        // pushes to one side, or to both in turns
        let actions: Vec<f64> = (0..n).map(|world| if world % 2 == 0 || k % 2 == 0 { 10.0 } else { -10.0 }).collect();
        worlds.step(&actions, Autoreset::Disabled, &mut step);
        is_over.iter_mut().zip(&step.terminated).for_each(|(is_over, ended)| *is_over |= ended);
    }
    (worlds, step, is_over)
}

#[test]
fn finished_worlds_stay_where_they_ended() {
    for compile in [Compile::IfPossible, Compile::Never] {
        let (mut worlds, mut step, is_over) = half_over(compile);
        let n = worlds.n_worlds();
        assert!((0..n).any(|k| is_over[k]) && (0..n).any(|k| !is_over[k]));
        let before: Vec<Vec<f64>> = (0..n).map(|k| worlds.coordinates(k)).collect();
        for _ in 0..3 {
            worlds.step(&vec![10.0; n], Autoreset::Disabled, &mut step);
        }
        for k in 0..n {
            assert_eq!(worlds.coordinates(k) == before[k], is_over[k], "{compile:?}, world {k}");
        }
    }
}

#[test]
fn finished_and_reset_worlds_leave_their_neighbours_compiled() {
    let (mut worlds, mut step, is_over) = half_over(Compile::IfPossible);
    let (n, StepsBy::Compiled { .. }) = (worlds.n_worlds(), worlds.steps_by().clone()) else { return };
    assert_eq!(worlds.n_compiled(), n);
    // some that are over, and one under way
    let mask: Vec<bool> = (0..n).map(|k| is_over[k] && k % 3 == 0 || k == 1).collect();
    worlds.reset(&vec![None; n], &mask, &mut step.observations);
    worlds.step(&vec![10.0; n], Autoreset::Disabled, &mut step);
    assert_eq!(worlds.n_compiled(), n);
}

#[test]
fn a_continuous_diagram_leaves_commands_of_controllers_alone() {
    let loaded = load(&scene("cart-pole-lqr"), &[], Extensions::default()).unwrap();
    let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
    lockstep.attach(Box::new(ClosureController::new("push", |_: Instant<'_>, held: &mut [Option<f64>]| {
        held[0] = Some(2.0)
    })));
    lockstep.start().unwrap();
    lockstep.advance().unwrap();
    assert_eq!(lockstep.state().commands[0], 2.0);
    // from rest, under 2 N alone: the gravity of the tilted pole takes part, the regulator's 8 N do not
    let v = lockstep.state().v[0];
    assert!((0.02..0.045).contains(&v), "{v}");
}

/// Sensors of every kind that the motion alone decides, at different rates.
const SENSORS: &str = r#"
[[sensor]]
name = "imu"
parent = "/rail/cart/hinge/pole"
position = [0.02, 0.01, 0.7]
rotation_deg = [20.0, 10.0, -30.0]
sample_time = 0.02
imu = { accelerometer_bias = [0.1, 0.0, -0.2], accelerometer_noise_density = 0.02, gyro_noise_density = 1e-3 }

[[sensor]]
name = "tip"
parent = "/rail/cart/hinge/pole"
position = [0.0, 0.0, 1.0]
sample_time = 0.03
pose = { position_noise = 0.01, angle_noise = 0.005 }

[[sensor]]
name = "doppler"
parent = "/rail/cart"
velocity = { noise = 0.02 }

[[sensor]]
name = "altimeter"
parent = "/rail/cart/hinge/pole"
position = [0.0, 0.0, 1.0]
sample_time = 0.07
height = { bias = 0.25, noise = 0.003 }
"#;

/// A task that observes noisy samples, and whose reward and end depend on them.
const NOISY_TASK: &str = r#"
title = "Noisy"
duration = 1.0
step = 0.01
seed = 5
integrator = "rk4"
record = ["/rail.position"]

[task]
period = 0.05
time_limit = 0.6
observations = ["ax", "wy", "tip", "pitch", "v", "h", "x", "q", "f", "g", "noise"]
reward = "sqrt(1.256 - h) + x"
terminated = "wy > 1.5 or abs(tip) > 0.4"

[task.signals]
ax = "/rail/cart/hinge/pole/imu.accelerometer.x"
wy = "/rail/cart/hinge/pole/imu.gyro.y"
tip = "/rail/cart/hinge/pole/tip.measured_position.x"
pitch = "/rail/cart/hinge/pole/tip.measured_pitch"
v = "/rail/cart/doppler.measured_velocity.x"
h = "/rail/cart/hinge/pole/altimeter.measured_height"
x = "/rail.position"
q = "/rail/cart/hinge.position"
f = "/rail.command"
g = "/rail/cart/hinge.command"

[task.commands]
"/rail" = "0.3*push + 2*tip + noise - 0.4*wy"

[[task.action]]
name = "push"
range = [-4.0, 5.0]

[[task.random]]
name = "noise"
normal = [0.0, 0.3]

[[task.random]]
signal = "/rail/cart/hinge.position"
range = [-0.05, 0.05]
"#;

/// A number of the scene that is drawn for each episode, always the same: worlds of its task are stepped one by one.
const ONE_BY_ONE: &str = r#"
[[task.random]]
path = "/rail/cart/hinge/pole.mass"
range = [0.1, 0.1]
"#;

/// A diagram that reads noisy samples at ticks, two of its rates, a source that changes with time and noise of its own;
/// a block of it may fail.
const NOISY_DIAGRAM: &str = r#"
sample_time = 0.01
wires = [
  "/rail/cart/hinge/pole/imu.gyro.y -> late -> both.w",
  "/rail/cart/hinge/pole/tip.measured_pitch -> both.p",
  "/rail/cart/doppler.measured_velocity.x -> both.v",
  "/rail/cart/hinge.position -> both.q",
  "dither -> both.d",
  "hiss -> both.n",
  "both -> /rail/cart/hinge",
]

[[block]]
name = "hiss"
type = "noise"
sample_time = 0.02
std = 0.01

[[block]]
name = "late"
type = "unit-delay"
sample_time = 0.03
initial = 0.01

[[block]]
name = "dither"
type = "sine"
sample_time = 0.01
amplitude = 0.05
angular_frequency = 9.0

[[block]]
name = "both"
type = "expression"
inputs = ["w", "p", "v", "q", "d", "n"]
expression = "sqrt(0.06 - q) - 2*p - 0.1*w - 0.05*v + d + n"
"#;

/// The scene of [`NOISY_TASK`]; without a diagram, the command of the motor at the hinge is a signal that
/// changes with time.
fn noisy_scene(text: &str, has_diagram: bool, mode: &str) -> String {
    let hinge = |motor: &str| format!("parent = \"/rail/cart\"\nmotor = {{ {motor} }}");
    let wave = "command = { sine = { amplitude = 0.2, angular_frequency = 7.0, offset = 0.1 } }";
    let motor = if has_diagram { format!("mode = \"{mode}\"") } else { format!("mode = \"{mode}\", {wave}") };
    text.replace(&hinge("mode = \"torque\""), &hinge(&motor)) + SENSORS
}

#[test]
fn worlds_with_noisy_sensors_run_in_lanes_as_one_by_one() {
    let n = 64 + 3;
    let with_diagram = NOISY_TASK.replace("step = 0.01", "step = 0.01\ndiagram = \"control.toml\"");
    let euler = NOISY_TASK.replace("rk4", "semi-implicit-euler");
    let implicit = with_diagram.replace("rk4", "implicit");
    let tasks = [
        ("sensors", NOISY_TASK, ""),
        ("sensors-euler", &euler, ""),
        ("sensors-driven", &NOISY_TASK.replace("1.256 - h", "0.05 - q"), ""),
        ("sensors-diagram", &with_diagram, NOISY_DIAGRAM),
        ("sensors-implicit", &implicit, NOISY_DIAGRAM),
    ];
    for (name, task, diagram) in tasks {
        let mode = if name == "sensors-driven" { "velocity" } else { "torque" };
        let scene = |text: String| noisy_scene(&text, !diagram.is_empty(), mode);
        let lanes = OwnTask::with_scene(name, task, diagram, scene);
        let alone = OwnTask::with_scene(&format!("{name}-alone"), &(task.to_owned() + ONE_BY_ONE), diagram, scene);
        let [lanes, alone] = [&lanes, &alone]
            .map(|own| load(&own.0, &[], Extensions::default()).unwrap_or_else(|found| panic!("{name}: {found}")));
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep, Autoreset::Disabled] {
            let mut worlds = TaskWorlds::new(&alone, n, 2).unwrap();
            assert!(worlds.plan().lanes_refused().is_some_and(|why| why.contains("drawn")), "{name}");
            let expected = episodes(&mut worlds, autoreset, 60);
            for threads in [1, 2] {
                let mut worlds = TaskWorlds::new(&lanes, n, threads).unwrap();
                if sincro_math::lanes::width() > 1 {
                    assert_eq!(worlds.plan().lanes_refused(), None, "{name}");
                }
                let found = episodes(&mut worlds, autoreset, 60);
                assert_same(&found, &expected, &format!("{name}, {autoreset:?}, {threads} threads"));
            }
            let n_stopped = expected.iter().flatten().filter(|x| **x == STOPPED).count();
            assert!(n_stopped > 5, "{name}: worlds that cannot go on: {n_stopped}");
        }
    }
}

/// A rotor that follows its command on the pole, a drag element, and a spring and damper to the world.
const ELEMENTS: &str = r#"
[[rotor]]
name = "prop"
parent = "/rail/cart/hinge/pole"
position = [0.0, 0.0, 0.5]
spin = "ccw"
blade = { radius = 0.05, chord = 0.01, n_blades = 2, lift_slope = 5.7, collective_pitch = 0.14, cd0 = 0.0087, k_cd = 0.4 }
speed = 0.0
lag = { time_constant = 0.1, initial = 60.0 }

[[drag]]
name = "sail"
parent = "/rail/cart/hinge/pole"
position = [0.0, 0.0, 0.8]
area = [0.01, 0.01, 0.01]

[[frame]]
name = "hook"
position = [0.3, 0.0, 1.2]

[[frame]]
name = "eye"
parent = "/rail/cart/hinge/pole"
position = [0.0, 0.0, 0.9]

[[spring_damper]]
name = "line"
between = ["/hook", "/rail/cart/hinge/pole/eye"]
stiffness = 3.0
damping = 0.1
free_length = 0.2
"#;

/// A task that observes measurements of every kind that the state decides.
const MEASURED_TASK: &str = r#"
title = "Measured"
duration = 1.0
step = 0.01
integrator = "rk4"
record = ["/rail.position"]

[task]
period = 0.05
time_limit = 0.6
observations = ["valid", "speed", "thrust", "torque", "power", "drag", "kinetic", "total", "px", "ly", "qw", "yaw", "wx", "length", "rate", "force"]
reward = "valid"
terminated = "abs(q) > 1.5"

[task.signals]
valid = "prop.valid"
speed = "prop.speed"
thrust = "prop.thrust"
torque = "prop.torque"
power = "prop.power"
drag = "sail.force.x"
kinetic = "energy.kinetic"
total = "energy.total"
px = "momentum.linear.x"
ly = "momentum.angular.y"
qw = "pole.quaternion.w"
yaw = "pole.pitch"
wx = "pole.angular_velocity.y"
length = "line.length"
rate = "line.rate"
force = "line.force"
q = "hinge.position"

[task.commands]
"/rail" = "2*push"
"/rail/cart/hinge/pole/prop" = "60 + 8*push"

[[task.action]]
name = "push"
range = [-4.0, 5.0]

[[task.random]]
signal = "hinge.position"
range = [-0.5, 0.5]
"#;

#[test]
fn measurements_in_lanes_are_those_of_each_world() {
    let n = 32 + 3;
    let scene = |text: String| text + ELEMENTS;
    let lanes = OwnTask::with_scene("measured", MEASURED_TASK, "", scene);
    let alone = OwnTask::with_scene("measured-alone", &(MEASURED_TASK.to_owned() + ONE_BY_ONE), "", scene);
    let [lanes, alone] =
        [&lanes, &alone].map(|own| load(&own.0, &[], Extensions::default()).unwrap_or_else(|found| panic!("{found}")));
    let expected = episodes(&mut TaskWorlds::new(&alone, n, 1).unwrap(), Autoreset::SameStep, 60);
    let mut worlds = TaskWorlds::new(&lanes, n, 1).unwrap();
    if sincro_math::lanes::width() > 1 {
        assert_eq!(worlds.plan().lanes_refused(), None);
    }
    let found = episodes(&mut worlds, Autoreset::SameStep, 60);
    assert_same(&found, &expected, "measured");
    // what is observed first, and the reward, is 1 where the theory of the rotor holds: not in all worlds at once
    let n_valid = |world: usize| expected[world].iter().filter(|x| **x == 1.0_f64.to_bits()).count();
    assert!((1..n).any(|world| n_valid(world) != n_valid(0)), "all rotors are valid at the same instants");
}

/// Settings of the experiment hold in episodes for which numbers of the scene are drawn.
#[test]
fn drawn_numbers_stand_beside_the_settings_of_the_experiment() {
    let set = [Override::new("/rail/cart.mass", "3.0"), Override::new("step", "0.005")];
    let scene = |text: String| noisy_scene(&text, false, "torque");
    let plain = OwnTask::with_scene("set", NOISY_TASK, "", scene);
    let drawn = OwnTask::with_scene("set-drawn", &(NOISY_TASK.to_owned() + ONE_BY_ONE), "", scene);
    let of = |own: &OwnTask, set: &[Override]| {
        let loaded = load(&own.0, set, Extensions::default()).unwrap();
        episodes(&mut TaskWorlds::new(&loaded, 5, 1).unwrap(), Autoreset::SameStep, 20)
    };
    assert_eq!(of(&drawn, &set), of(&plain, &set));
    assert_ne!(of(&plain, &set), of(&plain, &[]));
}

#[test]
fn noise_of_sensors_differs_from_world_to_world_and_from_episode_to_episode() {
    let own = OwnTask::with_scene("noise", NOISY_TASK, "", |text| noisy_scene(&text, false, "torque"));
    let loaded = load(&own.0, &[], Extensions::default()).unwrap_or_else(|found| panic!("{found}"));
    let mut worlds = TaskWorlds::new(&loaded, 2, 1).unwrap();
    let n = worlds.plan().n_observations();
    // the velocity of the cart, which is at rest
    let mut first = |seeds: [Option<u64>; 2]| {
        let mut observations = vec![0.0; 2 * n];
        worlds.reset(&seeds, &[true; 2], &mut observations);
        [observations[4], observations[n + 4]]
    };
    let (one, other, again) = (first([Some(1), Some(2)]), first([None, None]), first([Some(1), Some(2)]));
    assert_eq!(one, again);
    assert!(one[0] != one[1] && one[0] != other[0], "{one:?} {other:?}");
}

/// A diagram that acts between ticks: states of all kinds, functions of time, what is sampled and held, a command that
/// the task sets itself, and a block that may fail.
const CONTINUOUS_DIAGRAM: &str = r#"
wires = [
  "/rail/cart/hinge.position -> lag -> both.q",
  "/rail/cart/hinge/pole/tip.measured_pitch -> held -> both.p",
  "/rail/cart/doppler.measured_velocity.x -> both.v",
  "/rail/cart/hinge/pole.velocity.x -> second -> both.w",
  "wave -> both.s",
  "push -> both.j",
  "both -> /rail/cart/hinge",
  "both -> total -> late",
  "late -> both.l",
  "lag -> force -> /rail",
]

[[block]]
name = "force"
type = "gain"
unit = "N"
gain = 0.5

[[block]]
name = "lag"
type = "low-pass"
time_constant = 0.02
initial = 0.01

[[block]]
name = "held"
type = "zero-order-hold"
sample_time = 0.02

[[block]]
name = "second"
type = "state-space"
a = [[0.0, 1.0], [-400.0, -30.0]]
b = [0.0, 400.0]
c = [[1.0, 0.0]]

[[block]]
name = "wave"
type = "sine"
amplitude = 0.05
angular_frequency = 9.0

[[block]]
name = "push"
type = "step"
time = JUMP
to = 0.1

[[block]]
name = "total"
type = "integrator"
initial = 0.1
upper = 0.104

[[block]]
name = "late"
type = "unit-delay"
sample_time = 0.03

[[block]]
name = "both"
type = "expression"
inputs = ["q", "p", "v", "w", "s", "j", "l"]
expression = "sqrt(0.06 - q) - 2*p - 0.1*w - 0.05*v + s + j + l + 0.01*atan2(w, 1 + q)"
"#;

#[test]
fn continuous_diagrams_run_in_lanes_as_one_by_one() {
    let n = 24 + 3;
    let task = NOISY_TASK
        .replace("step = 0.01", "step = 0.01\ndiagram = \"control.toml\"")
        .replace("observations = [", "observations = [\"lag\", \"both\", \"total\", \"late\", ")
        .replace(
            "[task.signals]",
            "[task.signals]\nlag = \"lag\"\nboth = \"both\"\ntotal = \"total\"\nlate = \"late\"",
        );
    // semi-implicit Euler does not end its steps at jumps: there it is between ticks
    let tasks = [
        ("rk4", "torque", "0.16"),
        ("rk4", "velocity", "0.16"),
        ("implicit", "torque", "0.16"),
        ("implicit", "velocity", "0.16"),
        ("semi-implicit-euler", "torque", "0.163"),
        ("semi-implicit-euler", "velocity", "0.163"),
    ];
    for (method, mode, jump) in tasks {
        let name = format!("continuous-{method}-{mode}");
        let scene = |text: String| noisy_scene(&text, true, mode);
        let (task, diagram) = (task.replace("rk4", method), CONTINUOUS_DIAGRAM.replace("JUMP", jump));
        let lanes = OwnTask::with_scene(&name, &task, &diagram, scene);
        let alone = OwnTask::with_scene(&format!("{name}-alone"), &(task.clone() + ONE_BY_ONE), &diagram, scene);
        let [lanes, alone] = [&lanes, &alone]
            .map(|own| load(&own.0, &[], Extensions::default()).unwrap_or_else(|found| panic!("{name}: {found}")));
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep, Autoreset::Disabled] {
            let mut worlds = TaskWorlds::new(&alone, n, 1).unwrap();
            assert!(worlds.plan().lanes_refused().is_some_and(|why| why.contains("drawn")), "{name}");
            let expected = episodes(&mut worlds, autoreset, 60);
            let mut worlds = TaskWorlds::new(&lanes, n, 1).unwrap();
            if sincro_math::lanes::width() > 1 {
                assert_eq!(worlds.plan().lanes_refused(), None, "{name}");
            }
            let found = episodes(&mut worlds, autoreset, 60);
            assert_same(&found, &expected, &format!("{name}, {autoreset:?}"));
            let n_stopped = expected.iter().flatten().filter(|x| **x == STOPPED).count();
            assert!(n_stopped > 5, "{name}: worlds that cannot go on: {n_stopped}");
        }
    }
}

#[test]
fn diagrams_whose_steps_end_between_ticks_are_refused_in_lanes_by_name() {
    let refused = |method: &str, diagram: &str| {
        let task = NOISY_TASK.replace("step = 0.01", "step = 0.01\ndiagram = \"control.toml\"").replace("rk4", method);
        let own = OwnTask::with_scene("refused", &task, diagram, |text| noisy_scene(&text, true, "torque"));
        let loaded = load(&own.0, &[], Extensions::default()).unwrap_or_else(|found| panic!("{found}"));
        Plan::new(&loaded).unwrap().lanes_refused().unwrap_or_default().to_owned()
    };
    let none = if sincro_math::lanes::width() > 1 { "" } else { "a processor without AVX2" };
    let jump = |time: &str| CONTINUOUS_DIAGRAM.replace("JUMP", time);
    for method in ["rk4", "implicit"] {
        assert_eq!(
            refused(method, &jump("0.163")),
            "block `push` of the diagram, whose jump or corner at t = 0.163 s does not fall exactly on a tick"
        );
        // after the end of the longest episode, of 0.6 s
        assert_eq!(refused(method, &jump("0.603")), none);
    }
    assert_eq!(refused("semi-implicit-euler", &jump("0.163")), none);
}

/// A task with a motor that its limit stops, dry friction and joints that reach their limits, some at the start.
const SWITCHING_TASK: &str = r#"
title = "Switching"
duration = 1.0
step = 0.01
integrator = "semi-implicit-euler"
record = ["/rail.position"]

[task]
period = 0.05
time_limit = 0.6
signals = { x = "/rail.position", q = "/rail/cart/hinge.position", w = "/rail/cart/hinge.velocity", e = "energy.kinetic" }
observations = ["x", "q", "w", "e", "push"]
reward = "x"
terminated = "abs(w) > 4"

[task.commands]
"/rail" = "if(t > 0.4, 0, 0.5*push)"

[[task.action]]
name = "push"
range = [-3.0, 3.0]

[[task.random]]
signal = "/rail.position"
range = [-0.1, 0.1]

[[task.random]]
signal = "/rail.velocity"
range = [-1.0, 1.0]

[[task.random]]
signal = "/rail/cart/hinge.position"
range = [-0.3, 0.3]
"#;

/// Commands of the motor at the hinge at ticks.
const SWITCHING_DIAGRAM: &str = r#"
sample_time = 0.02
wires = ["/rail/cart/hinge.position -> spring -> /rail/cart/hinge"]

[[block]]
name = "spring"
type = "gain"
gain = -5.0
"#;

/// The cart with these limits: of the motor at the hinge `[N·m]`, or none that acts, and ranges of the joints.
/// With `has_post` the pole can touch a post.
fn switching_scene(text: &str, has_ranges: bool, has_post: bool) -> String {
    let range = |range: &str| if has_ranges { format!("limits = {range}\n") } else { String::new() };
    let rail = "kind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nmotor = { mode = \"torque\" }";
    let driven = "kind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nmotor = { mode = \"velocity\", max_torque = 6.0 }\nfriction = 0.4\n";
    let hinge = "parent = \"/rail/cart\"\nmotor = { mode = \"torque\" }";
    assert!(text.contains(rail) && text.contains(hinge));
    let text = text.replace(rail, &(driven.to_owned() + &range("{ lower = -0.1, upper = 0.12, restitution = 0.3 }")));
    let friction = "friction = { sliding = 0.02, static = 0.03, stribeck_velocity = 0.1 }";
    let text = text.replace(hinge, &format!("{hinge}\n{friction}\n{}", range("{ lower = -0.4, upper = 0.4 }")));
    if !has_post {
        return text;
    }
    let pole = "parent = \"/rail/cart/hinge\"\nmass";
    assert!(text.contains(pole));
    text.replace(pole, "parent = \"/rail/cart/hinge\"\ncontact = { friction = 0.3 }\nmass") + POST
}

/// A post beside the pole.
const POST: &str = r#"
[[body]]
name = "post"
position = [0.35, 0.0, 0.8]
shape = [ { sphere = { radius = 0.1 } } ]
contact = { friction = 0.3, restitution = 0.4 }
"#;

#[test]
fn worlds_with_limits_and_friction_run_in_lanes_as_one_by_one() {
    let n = 64 + 3;
    for (name, has_ranges, has_post) in [("limited", false, false), ("ranges", true, false), ("post", false, true)] {
        let scene = |text: String| switching_scene(&text, has_ranges, has_post);
        let task = SWITCHING_TASK.replace("step = 0.01", "step = 0.01\ndiagram = \"control.toml\"");
        let lanes = OwnTask::with_scene(name, &task, SWITCHING_DIAGRAM, scene);
        let alone = OwnTask::with_scene(&format!("{name}-alone"), &(task + ONE_BY_ONE), SWITCHING_DIAGRAM, scene);
        let [lanes, alone] = [&lanes, &alone]
            .map(|own| load(&own.0, &[], Extensions::default()).unwrap_or_else(|found| panic!("{name}: {found}")));
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep, Autoreset::Disabled] {
            let mut worlds = TaskWorlds::new(&alone, n, 2).unwrap();
            assert!(worlds.plan().lanes_refused().is_some_and(|why| why.contains("drawn")), "{name}");
            let expected = episodes(&mut worlds, autoreset, 60);
            for threads in [1, 2] {
                let mut worlds = TaskWorlds::new(&lanes, n, threads).unwrap();
                let found = episodes(&mut worlds, autoreset, 60);
                if sincro_math::lanes::width() > 1 {
                    assert_eq!(worlds.plan().lanes_refused(), None, "{name}");
                    let is_constrained = has_ranges || has_post;
                    assert_eq!(worlds.steps_alone() > 1000, is_constrained, "{}", worlds.steps_alone());
                }
                assert_same(&found, &expected, &format!("{name}, {autoreset:?}, {threads} threads"));
            }
        }
    }
}

//! The same control law through a diagram and in Rust gives the same bits.

use sincro_blocks::diagram::Diagram;
use sincro_blocks::library::discrete::UnitDelay;
use sincro_blocks::library::maths::{Gain, Sum};
use sincro_blocks::library::sources::Step;
use sincro_dynamics::world::MethodKind;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::overrides::Override;
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_sim::run::{LockStep, world_of};
use sincro_sim::trace::Trace;

const TICKS: u64 = 1600;

fn scene(set: &[(&str, &str)]) -> sincro_sim::Loaded {
    let set: Vec<Override> = set.iter().map(|(path, value)| Override::new(path, value)).collect();
    load(&sincro_testing::repository_scene("two-dof-position"), &set, Extensions::default()).unwrap()
}

/// The hash of a run of the scene with its diagram.
fn hash_of(loaded: &sincro_sim::Loaded, method: MethodKind) -> Trace {
    let mut run = LockStep::new(loaded, method, false);
    run.start().unwrap();
    let mut trace = run.trace();
    for _ in 0..TICKS {
        run.advance().unwrap();
        run.hash_into(&mut trace);
    }
    trace
}

#[test]
fn a_diagram_and_the_same_law_in_rust_give_the_same_bits() {
    for method in [MethodKind::DormandPrince, MethodKind::SemiImplicitEuler, MethodKind::Implicit] {
        let loaded = scene(&[]);
        let mut world = world_of(&loaded.scene, &loaded.experiment, method, false);
        let mut trace = Trace::start(&world.state);
        // u[k] = 2 (r[k] − q[k−1]), every 5 ms
        let mut q_before = [0.0; 2];
        for tick in 0..TICKS {
            let t = tick as f64 * loaded.experiment.step;
            let r = if t < 4.0 - 1e-9 { [1.0, -0.5] } else { [0.2, 0.8] };
            for i in 0..2 {
                world.state.commands[i] = 2.0 * (r[i] - q_before[i]);
            }
            q_before = [world.state.q[0], world.state.q[1]];
            world.advance(t, loaded.experiment.step).unwrap();
            trace.add(&world.state);
        }
        assert_eq!(hash_of(&loaded, method), trace, "{method:?}");
    }
}

#[test]
fn a_diagram_in_rust_and_in_toml_are_the_same() {
    let mut loaded = scene(&[]);
    let in_toml = hash_of(&loaded, MethodKind::DormandPrince);
    let mut d = Diagram::new();
    d.sampled("reference", 0.005, Step { time: 4.0, from: vec![1.0, -0.5], to: vec![0.2, 0.8] });
    d.sampled("delay", 0.005, UnitDelay::new(0.0)).sampled("error", 0.005, Sum::new("+-"));
    d.sampled("speed", 0.005, Gain::new(2.0));
    d.wire("reference", "error.u1").wire("[/shoulder.position, /shoulder/elbow.position]", "delay");
    d.wire("delay", "error.u2").wire("error", "speed");
    d.wire("speed[0]", "/shoulder").wire("speed[1]", "/shoulder/elbow");
    loaded.controller = Some(ControlDiagram::new(d, &loaded.scene.model, loaded.experiment.step, 0).unwrap());
    assert_eq!(hash_of(&loaded, MethodKind::DormandPrince), in_toml);
}

/// Damping written as a continuous block and as a property of the joint: the same motion, to the tolerance of the
/// integrator.
#[test]
fn a_continuous_block_is_integrated_with_the_world() {
    let run = |set: &[(&str, &str)], damped: bool| -> Vec<f64> {
        let torque = [("/shoulder.motor.mode", "torque"), ("/shoulder/elbow.motor.mode", "torque")];
        let all: Vec<(&str, &str)> = torque.iter().chain(set).copied().collect();
        let mut loaded = scene(&all);
        let mut d = Diagram::new();
        if damped {
            d.block("damper", Gain::new(-0.7)).wire("/shoulder.velocity", "damper").wire("damper", "/shoulder");
        }
        loaded.controller = Some(ControlDiagram::new(d, &loaded.scene.model, loaded.experiment.step, 0).unwrap());
        let mut run = LockStep::new(&loaded, MethodKind::DormandPrince, false);
        run.start().unwrap();
        (0..400).for_each(|_| run.advance().unwrap());
        run.state().q.iter().chain(&run.state().v).copied().collect()
    };
    let moving = ("/shoulder/elbow.initial", "{ position = 0.5, velocity = 2.0 }");
    let in_diagram = run(&[moving], true);
    let in_joint = run(&[moving, ("/shoulder.damping", "0.7")], false);
    for (a, b) in in_diagram.iter().zip(&in_joint) {
        assert!((a - b).abs() < 1e-8, "{in_diagram:?} {in_joint:?}");
    }
}

/// A force that a diagram gives and one that the scene gives move a free body alike, to the bit.
#[test]
fn a_force_from_a_diagram_is_that_of_the_scene() {
    let scene = |force: &str| {
        let text = format!(
            "gravity = [0, 0, 0]\n\
             joint = [{{ name = \"free\", kind = \"free\" }}]\n\
             body = [{{ name = \"brick\", parent = \"/free\", mass = 2.0, inertia = {{ xx = 0.1, yy = 0.2, zz = 0.25 }} }}]\n\
             force = [{{ name = \"push\", parent = \"/free/brick\", in_frame = \"body\", {force} }}]"
        );
        sincro_scene::scene::from_text(&text).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
    };
    let run = |force: &str, diagram: Option<Diagram>| -> Vec<u64> {
        let mut loaded = self::scene(&[]);
        loaded.scene = scene(force).into();
        loaded.controller = diagram.map(|d| ControlDiagram::new(d, &loaded.scene.model, 0.005, 0).unwrap());
        let mut run = LockStep::new(&loaded, MethodKind::Rk4, false);
        run.start().unwrap();
        (0..200).for_each(|_| run.advance().unwrap());
        run.state().q.iter().map(|x| x.to_bits()).collect()
    };
    let mut d = Diagram::new();
    d.block("f", sincro_blocks::library::sources::Constant::new(3.0)).wire("f", "/free/brick/push.force.x");
    d.block("m", sincro_blocks::library::sources::Constant::new(0.5)).wire("m", "/free/brick/push.torque.y");
    let by_scene = run("force = [3, 0, 0], torque = [0, 0.5, 0]", None);
    assert_eq!(run("input = true", Some(d)), by_scene);
    assert_ne!(run("input = true", Some(Diagram::new())), by_scene);
}

/// An acceleration is measured under all commands, those of forces too, and they are put back afterwards.
#[test]
fn an_acceleration_is_measured_under_a_force_from_the_diagram() {
    let text = "gravity = [0, 0, 0]\n\
                joint = [{ name = \"free\", kind = \"free\" }]\n\
                body = [{ name = \"brick\", parent = \"/free\", mass = 2.0, inertia = { xx = 0.1, yy = 0.2, zz = 0.25 } }]\n\
                force = [{ name = \"push\", parent = \"/free/brick\", input = true }]";
    let mut loaded = scene(&[]);
    loaded.scene = sincro_scene::scene::from_text(text).unwrap().into();
    let mut d = Diagram::new();
    d.block("f", sincro_blocks::library::sources::Constant::new(3.0)).wire("f", "/free/brick/push.force.x");
    d.block("a", Gain::new(1.0)).wire("/free/brick.acceleration.x", "a");
    loaded.controller = Some(ControlDiagram::new(d, &loaded.scene.model, 0.005, 0).unwrap());
    let mut run = LockStep::new(&loaded, MethodKind::Rk4, false);
    run.start().unwrap();
    let control = run.control().unwrap();
    let (_, a, _) = control.wiring().program().outputs().find(|(name, ..)| name == "a").unwrap();
    assert_eq!(control.signals()[a], [1.5]);
    assert!(run.state().commands.iter().all(|c| *c == 0.0), "not latched yet");
}

//! Diagrams between ticks: late measurements that are held, jumps at a tick after a restore, what is left when a step
//! fails.

use sincro_dynamics::world::MethodKind;
use sincro_sim::Loaded;
use sincro_sim::run::LockStep;
use sincro_testing::{SceneFolder, scenes};

/// The folder of the sprung arm with a torque motor and a diagram.
fn load(joint: &str, wires: &str, blocks: &str) -> (SceneFolder, Loaded) {
    let folder = scenes::sprung_arm();
    folder.change("scene.toml", "damping = 0.5", &format!("damping = 0.5\nmotor = {{ mode = \"torque\" }}\n{joint}"));
    let experiment = "title = \"T\"\nscene = \"scene.toml\"\ndiagram = \"diagram.toml\"\nduration = 1.0\nstep = 0.01\n\
                      error_bar = \"none\"\nrecord = [\"/shoulder.position\"]\n";
    folder.write("experiment.toml", experiment);
    folder.write("diagram.toml", &format!("wires = [{wires}]\n{blocks}"));
    let loaded = folder.load(&[]).unwrap();
    (folder, loaded)
}

fn started(loaded: &Loaded, method: MethodKind) -> LockStep {
    let mut run = LockStep::new(loaded, method, false);
    run.start().unwrap();
    run
}

fn continuous(run: &LockStep) -> Vec<f64> {
    run.control().unwrap().runner.state.continuous.clone()
}

#[test]
fn what_follows_a_held_acceleration_and_a_velocity_is_seen_between_ticks() {
    let wires = r#""/shoulder.acceleration -> held -> both.a", "/shoulder.velocity -> both.v", "both -> x""#;
    let blocks = "[[block]]\nname = \"held\"\ntype = \"zero-order-hold\"\nsample_time = 10.0\n\
                  [[block]]\nname = \"both\"\ntype = \"expression\"\ninputs = [\"a\", \"v\"]\nexpression = \"a + v\"\n[[block]]\nname = \"x\"\ntype = \"integrator\"\n";
    let (_folder, loaded) = load("", wires, blocks);
    for method in [MethodKind::Rk4, MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let mut run = started(&loaded, method);
        let held = run.observe(0.0).0.accelerations[0];
        let start = run.state().q[0];
        for _ in 0..100 {
            run.advance().unwrap();
        }
        // ∫(a₀ + q̇) dt = a₀ t + q − q₀; the tolerance is that of the coarsest of these methods
        let expected = held * run.t() + run.state().q[0] - start;
        let x = continuous(&run)[0];
        assert!((x - expected).abs() < 1e-6, "{method:?}: {x} against {expected}");
    }
}

#[test]
fn a_restored_run_goes_on_bit_for_bit_from_a_jump() {
    let wires = r#""push -> /shoulder""#;
    let blocks = "[[block]]\nname = \"push\"\ntype = \"step\"\ntime = 0.5\nto = 20.0\n";
    let (_folder, loaded) = load("friction = 8.0", wires, blocks);
    for method in MethodKind::ALL {
        let mut first = started(&loaded, method);
        for _ in 0..50 {
            first.advance().unwrap();
        }
        let mut second = started(&loaded, method);
        second.restore(&first.snapshot(first.trace()));
        for k in 50..60 {
            first.advance().unwrap();
            second.advance().unwrap();
            assert_eq!(first.state(), second.state(), "{method:?} tick {k}");
        }
    }
}

#[test]
fn a_step_that_fails_leaves_the_states_of_the_diagram_as_they_were() {
    let wires = r#""clock -> f -> x""#;
    let blocks = "[[block]]\nname = \"clock\"\ntype = \"clock\"\n[[block]]\nname = \"x\"\ntype = \"integrator\"\n\
                  [[block]]\nname = \"f\"\ntype = \"expression\"\ninputs = [\"u\"]\nexpression = \"sqrt(0.252 - u)\"\n";
    let (_folder, loaded) = load("", wires, blocks);
    for method in [MethodKind::Rk4, MethodKind::Implicit] {
        let mut run = started(&loaded, method);
        let (mut before, mut world) = (continuous(&run), run.state().clone());
        while run.advance().is_ok() {
            (before, world) = (continuous(&run), run.state().clone());
        }
        assert_eq!(&world.q, &run.state().q, "{method:?}");
        assert_eq!(before, continuous(&run), "{method:?}");
    }
}

//! The same law through Rust, a diagram, a block in Lua and a script gives the same bits.

use sincro_coppelia::api::ObjectRegistry;
use sincro_coppelia::api_controller::ApiController;
use sincro_dynamics::world::MethodKind;
use sincro_sim::Loaded;
use sincro_sim::results::Status;
use sincro_sim::run::LockStep;
use sincro_sim::trace::Trace;

use super::world::{EXPERIMENT, PENDULUM, open, run};

const TICKS: usize = 400;

/// The hash of a run; `law` may act before each step.
fn trace(loaded: &Loaded, mut law: impl FnMut(&mut LockStep)) -> Trace {
    let mut run = LockStep::new(loaded, MethodKind::DormandPrince, false);
    let mut trace = run.trace();
    run.start().unwrap();
    for _ in 0..TICKS {
        law(&mut run);
        run.advance().unwrap();
        run.hash_into(&mut trace);
    }
    assert!(run.state().q[0].abs() < 0.1, "the law does nothing");
    trace
}

fn with_diagram(diagram: &str) -> Loaded {
    let experiment = format!("diagram = \"law.toml\"\n{EXPERIMENT}");
    let files = [("scene.toml", PENDULUM), ("experiment.toml", experiment.as_str()), ("law.toml", diagram)];
    open(&files).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn one_law_through_every_door_gives_one_hash() {
    let plain = open(&[("scene.toml", PENDULUM), ("experiment.toml", EXPERIMENT)]).unwrap();
    let mut registry = Some(Box::new(ObjectRegistry::new(&plain, 1)));
    let rust = trace(&plain, |run| {
        if let Some(registry) = registry.take() {
            ApiController::set_registry(run, *registry);
        }
        let (q, v) = (run.state().q[0], run.state().v[0]);
        ApiController::sim(run).unwrap().registry.hold(0, Some(-20.0 * q - 4.0 * v));
    });

    let diagram = with_diagram(
        "sample_time = 0.01\nwires = [\"/hinge.position -> law.q\", \"/hinge.velocity -> law.v\", \"law -> /hinge\"]\n\
         [[block]]\nname = \"law\"\ntype = \"expression\"\nexpression = \"-20*q - 4*v\"\n",
    );
    assert_eq!(trace(&diagram, |_| {}), rust);

    let block = with_diagram(
        "wires = [\"/hinge.position -> law.q\", \"/hinge.velocity -> law.v\", \"law -> /hinge\"]\n\
         [[block]]\nname = \"law\"\ntype = \"lua\"\ninputs = [\"q\", \"v\"]\ncode = '''\n\
         function output(t, u)\n  return -20*u.q - 4*u.v\nend\n'''\n",
    );
    assert_eq!(trace(&block, |_| {}), rust);

    let new = "function sysCall_init() joint = sim.getObject('..') end
        function sysCall_actuation()
            sim.setJointTargetForce(joint, -20*sim.getJointPosition(joint) - 4*sim.getJointVelocity(joint))
        end";
    let old = "if sim_call_type == sim_childscriptcall_initialization then joint = simGetObjectHandle('hinge') end
        if sim_call_type == sim_childscriptcall_actuation then
            simSetJointForce(joint, -20*simGetJointPosition(joint) - 4*simGetJointVelocity(joint))
        end";
    for code in [new, old] {
        let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"law.lua\"\n");
        let files = [("scene.toml", scene.as_str()), ("experiment.toml", EXPERIMENT), ("law.lua", code)];
        let script = open(&files).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(trace(&script, |_| {}), rust, "{code}");
    }
}

#[test]
fn a_script_sees_what_the_diagram_commands_for_its_step() {
    let code = "function sysCall_actuation()
            local joint = sim.getObject('..')
            local told = -20*sim.getJointPosition(joint) - 4*sim.getJointVelocity(joint)
            assert(sim.getJointTargetForce(joint) == told, sim.getJointTargetForce(joint) .. ' is not ' .. told)
        end";
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"look.lua\"\n");
    let experiment = format!("diagram = \"law.toml\"\n{EXPERIMENT}");
    let law = "sample_time = 0.01\nwires = [\"/hinge.position -> law.q\", \"/hinge.velocity -> law.v\", \"law -> /hinge\"]\n\
         [[block]]\nname = \"law\"\ntype = \"expression\"\nexpression = \"-20*q - 4*v\"\n";
    let files = [("scene.toml", &*scene), ("experiment.toml", &*experiment), ("law.toml", law), ("look.lua", code)];
    let loaded = open(&files).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(run(&loaded).status, Status::Completed);
}

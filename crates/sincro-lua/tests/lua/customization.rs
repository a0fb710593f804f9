//! Customization scripts of a session: they live while it is stopped, and from run to run.

use sincro_coppelia::api::{Handle, Phase, Search, Value};
use sincro_coppelia::session::Session;
use sincro_scene::script::Kind;
use sincro_testing::{OpenSession, with_scripts};

use super::world::{EXPERIMENT, PENDULUM, folder, open, run};

/// A session of the pendulum with a customization script on its hinge and, if it is not empty, a child script.
fn session(code: &str, child: &str) -> OpenSession {
    let mut scene =
        format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nkind = \"customization\"\nfile = \"a.lua\"\n");
    if !child.is_empty() {
        scene += "[[script]]\nobject = \"/hinge\"\nfile = \"b.lua\"\n";
    }
    folder(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code), ("b.lua", child)])
        .session(with_scripts(), None)
}

fn told(session: &mut Session) -> Vec<String> {
    session.registry().take_log().into_iter().map(|line| line.text).collect()
}

fn hinge(session: &mut Session) -> Handle {
    session.registry().find("/hinge", Search::default()).unwrap()
}

/// Says each call, with a count that goes on from call to call.
const TELLING: &str = "
    n = 0
    local function tell(name) n = n + 1 print(name, n, sim.getSimulationState()) end
    for _, name in ipairs { 'init', 'nonSimulation', 'beforeSimulation', 'actuation', 'afterSimulation', 'cleanup' } do
        _G['sysCall_' .. name] = function() tell(name) end
    end
    function ask(x) return x + n end";

#[test]
fn all_customization_scripts_begin_before_one_is_told_of_a_run() {
    let script = |object: &str, name: &str| {
        let code = format!(
            "function sysCall_init() print('{name} begins') end function sysCall_beforeSimulation() print('{name} runs') end"
        );
        format!("[[script]]\nobject = \"{object}\"\nkind = \"customization\"\ncode = \"\"\"\n{code}\n\"\"\"\n")
    };
    let scene = format!("{PENDULUM}\n{}{}", script("/hinge/arm", "arm"), script("/hinge", "hinge"));
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT)]).unwrap();
    let said: Vec<String> = run(&loaded).messages.into_iter().map(|message| message.text).collect();
    assert_eq!(said.len(), 4, "{said:?}");
    assert!(said[..2].iter().all(|text| text.ends_with("begins")), "{said:?}");
}

#[test]
fn a_customization_script_lives_while_stopped_and_through_runs() {
    let mut session = session(TELLING, "n = (n or 0) + 1 function sysCall_init() print('child', n) end");
    session.idle().unwrap();
    session.idle().unwrap();
    assert_eq!(told(&mut session), ["init\t1\t0", "nonSimulation\t2\t0", "nonSimulation\t3\t0"]);
    for first in [4, 8] {
        session.start().unwrap();
        session.idle().unwrap();
        session.step().unwrap();
        session.stop().unwrap();
        session.idle().unwrap();
        let line = |name: &str, k: i32, state: i32| format!("{name}\t{}\t{state}", first + k);
        let mut said = told(&mut session);
        said.retain(|line| !line.starts_with("child"));
        assert_eq!(said.len(), 4, "{said:?}");
        assert_eq!(said[0], line("beforeSimulation", 0, 16));
        assert!(said[1].starts_with(&format!("actuation\t{}", first + 1)), "{said:?}");
        assert!(said[2].starts_with(&format!("afterSimulation\t{}", first + 2)), "{said:?}");
        assert_eq!(said[3], line("nonSimulation", 3, 0));
    }
    session.close().unwrap();
    session.close().unwrap();
    assert_eq!(told(&mut session), ["cleanup\t12\t0"]);
}

#[test]
fn child_scripts_begin_anew_in_each_run_beside_them() {
    let mut session = session(
        "x = 1",
        "n = (n or 0) + 1 function sysCall_init() print('child', n, sim.getScript(sim.scripttype_childscript, sim.getObject('/hinge'))) end",
    );
    let mut said = Vec::new();
    for _ in 0..2 {
        session.start().unwrap();
        session.step().unwrap();
        session.stop().unwrap();
        said.extend(told(&mut session));
    }
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].starts_with("child\t1\t"));
    assert_eq!(said[0], said[1], "the script has its handle in each run");
}

#[test]
fn a_client_calls_functions_of_a_customization_script_while_stopped() {
    let mut session = session(TELLING, "function ask() return 1 end");
    let hinge = hinge(&mut session);
    let mut ask = |kind| session.call_script(hinge, kind, "ask", &[Value::Int(10)]);
    assert_eq!(ask(Some(Kind::Customization)).unwrap(), [Value::Int(11)]);
    assert_eq!(ask(None).unwrap(), [Value::Int(11)]);
    let why = ask(Some(Kind::Child)).unwrap_err().to_string();
    assert!(why.contains("once the simulation is started"), "{why}");
}

#[test]
fn a_customization_script_may_start_the_simulation_and_move_objects_before() {
    let code = "
        function sysCall_nonSimulation()
            sim.setJointPosition(sim.getObject('/hinge'), 0.25)
            sim.startSimulation()
        end
        function sysCall_actuation() print(sim.getJointPosition(sim.getObject('/hinge'))) end";
    let mut session = session(code, "");
    session.idle().unwrap();
    assert_eq!(session.phase(), Phase::Running);
    session.step().unwrap();
    assert_eq!(told(&mut session), ["0.25"]);
}

#[test]
fn an_old_customization_script_is_called_as_a_whole() {
    let code = "
        local names = { [sim_customizationscriptcall_initialization] = 'init', [sim_customizationscriptcall_nonsimulation] = 'non',
            [sim_customizationscriptcall_lastbeforesimulation] = 'before', [sim_customizationscriptcall_simulationactuation] = 'acts',
            [sim_customizationscriptcall_firstaftersimulation] = 'after', [sim_customizationscriptcall_cleanup] = 'cleanup' }
        if names[sim_call_type] then print(names[sim_call_type]) end";
    let mut session = session(code, "");
    session.idle().unwrap();
    session.start().unwrap();
    session.step().unwrap();
    session.stop().unwrap();
    assert_eq!(told(&mut session), ["init", "non", "before", "acts", "after"]);
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nkind = \"customization\"\nfile = \"a.lua\"\n");
    let short = EXPERIMENT.replace("0.05", "0.01");
    let once = run(&open(&[("scene.toml", &scene), ("experiment.toml", &short), ("a.lua", code)]).unwrap());
    let said: Vec<&str> = once.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(said, ["init", "before", "acts", "after", "cleanup"], "a run by itself is whole");
}

#[test]
fn one_that_fails_while_stopped_is_not_called_there_again() {
    let mut failing = session("function sysCall_nonSimulation()\n  error('no')\nend", "");
    let why = failing.idle().unwrap_err().to_string();
    assert!(why.contains("a.lua:2") && why.contains("no"), "{why}");
    failing.idle().unwrap();
    failing.start().unwrap();
    failing.step().unwrap();
    let mut refused = session("function sysCall_init() error('never') end", "");
    assert!(refused.start().unwrap_err().to_string().contains("never"));
    assert!(refused.start().unwrap_err().to_string().contains("never"), "each time");
    assert_eq!(refused.phase(), Phase::Stopped);
}

#[test]
fn a_run_has_the_same_trace_by_itself_and_in_each_run_of_a_session() {
    let code =
        "function sysCall_actuation() sim.setJointTargetVelocity(sim.getObject('/hinge'), sim.getSimulationTime()) end";
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nkind = \"customization\"\nfile = \"a.lua\"\n");
    let once = run(&open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap());
    let mut session = session(code, "");
    for _ in 0..2 {
        session.idle().unwrap();
        session.start().unwrap();
        (0..5).for_each(|_| session.step().unwrap());
        session.stop().unwrap();
        assert_eq!(session.take_finished().remove(0).simulated.trace, once.trace);
    }
}

#[test]
fn one_that_reached_a_limit_does_not_hold_back_later_runs() {
    let endless = "
        function sysCall_nonSimulation() while true do end end
        function sysCall_beforeSimulation() print('begins') end
        function sysCall_actuation() if endless then while true do end end end
        function turn() endless = not endless end";
    let mut session = session(endless, "");
    session.idle().unwrap_err();
    for _ in 0..2 {
        session.start().unwrap();
        session.step().unwrap();
        session.stop().unwrap();
    }
    let hinge = hinge(&mut session);
    session.call_script(hinge, Some(Kind::Customization), "turn", &[]).unwrap();
    session.start().unwrap();
    session.step().unwrap_err();
    session.call_script(hinge, Some(Kind::Customization), "turn", &[]).unwrap();
    session.start().unwrap();
    session.step().unwrap();
    let begun = told(&mut session).iter().filter(|line| *line == "begins").count();
    assert_eq!(begun, 4);
}

#[test]
fn one_that_fails_while_stopped_leaves_the_others_alone() {
    let scene = format!(
        "{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nkind = \"customization\"\nfile = \"a.lua\"\n\
         [[script]]\nobject = \"/hinge/arm\"\nkind = \"customization\"\nfile = \"b.lua\"\n"
    );
    let fails = "function sysCall_nonSimulation() error('out of order') end";
    let lives = "function sysCall_nonSimulation() print('alive') end";
    let files = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("a.lua", fails), ("b.lua", lives)];
    let mut session = folder(&files).session(with_scripts(), None);
    assert!(session.idle().unwrap_err().0.contains("out of order"));
    session.idle().unwrap();
    assert_eq!(told(&mut session).iter().filter(|line| *line == "alive").count(), 2);
    // each run is a new beginning
    session.start().unwrap();
    session.stop().unwrap();
    assert!(session.idle().is_err());
}

#[test]
fn a_thread_that_waits_across_runs_waits_for_the_rest() {
    // the pendulum's step is 0.01 s: three steps of the first run and two of the second are waited for
    let code = "function sysCall_thread() sim.wait(1) end
        function sysCall_init() end";
    let waiting = code.replace("sim.wait(1)", "sim.step() sim.wait(0.05) print('done', sim.getSimulationTime())");
    let mut session = session(&waiting, "");
    session.start().unwrap();
    (0..4).for_each(|_| session.step().unwrap());
    session.stop().unwrap();
    session.start().unwrap();
    (0..4).for_each(|_| session.step().unwrap());
    assert_eq!(told(&mut session), ["done\t0.03"]);
}

//! When scripts are called: both styles, threads, the order among objects.

use sincro_sim::results::Status;

use super::world::{EXPERIMENT, PENDULUM, open, run, said, with_script};

#[test]
fn an_old_script_is_run_as_a_whole_for_every_phase_and_keeps_its_globals() {
    let code = "
        calls = (calls or 0) + 1
        local mine = (mine or 0) + 1
        if sim_call_type == sim_childscriptcall_initialization then print('init', calls, mine) end
        if sim_call_type == sim_childscriptcall_actuation then print('actuation', calls, mine, simGetSimulationTime()) end
        if sim_call_type == sim_childscriptcall_sensing then print('sensing', calls, mine, simGetSimulationTime()) end
        if sim_call_type == sim_childscriptcall_cleanup then print('cleanup', calls, mine) end";
    let said = said(code);
    assert_eq!(
        said[..5],
        ["init\t1\t1", "actuation\t2\t1\t0.0", "sensing\t3\t1\t0.0", "actuation\t4\t1\t0.01", "sensing\t5\t1\t0.01"]
    );
    assert_eq!((said.len(), said.last().unwrap().as_str()), (12, "cleanup\t12\t1"));
}

#[test]
fn a_new_script_is_called_by_its_functions() {
    let code = "
        sim = require 'sim'
        print('read', sim_call_type)
        function sysCall_init() print('init', sim_call_type) end
        function sysCall_actuation() print('actuation', sim.getSimulationTime()) end
        function sysCall_dyn(info) print('dyn', info.afterStep, info.dynStepSize) end
        function sysCall_sensing() print('sensing', sim.getSimulationTime()) end
        function sysCall_cleanup() print('cleanup') end";
    let said = said(code);
    let first = [
        "read\t0",
        "init\tnil",
        "actuation\t0.0",
        "dyn\tfalse\t0.01",
        "dyn\ttrue\t0.01",
        "sensing\t0.0",
        "actuation\t0.01",
    ];
    assert_eq!(said[..7], first);
    assert_eq!(said.last().unwrap(), "cleanup");
}

#[test]
fn a_thread_goes_on_where_it_waited() {
    let code = "
        function sysCall_thread()
            print(sim.getSimulationTime())
            sim.wait(0.02)
            print(sim.getSimulationTime())
            sim.step()
            print(sim.getSimulationTime())
        end
        function sysCall_actuation() print('a') end";
    assert_eq!(said(code), ["0.0", "a", "a", "0.02", "a", "0.03", "a", "a"]);
}

#[test]
fn an_old_thread_runs_its_text_once_also_through_pcall() {
    let code = "
        threadFunction = function()
            while simGetSimulationState() ~= sim_simulation_advancing_abouttostop do
                print(simGetSimulationTime())
                simSwitchThread()
            end
        end
        print(xpcall(threadFunction, function(err) return debug.traceback(err) end))";
    let loaded = with_script(code, "threaded = true").unwrap();
    let run = run(&loaded);
    assert_eq!(run.status, Status::Completed);
    let said: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(said, ["0.0", "0.01", "0.02", "0.03", "0.04"]);
}

/// A text of V-REP 3.6 to 4.2 that waits outside of functions, and its main function.
const WAITING_TEXT: &str = "
        function sysCall_threadmain() print('main', sim.getSimulationTime()) sim.wait(0.01) print('end', sim.getSimulationTime()) end
        function sysCall_cleanup() print('cleanup') end
        print('text', sim.getSimulationTime())
        sim.wait(0.02)
        print('text', sim.getSimulationTime())";

#[test]
fn the_text_of_a_script_with_a_thread_may_wait_before_its_main_function() {
    let wanted = ["text\t0.0", "text\t0.02", "main\t0.02", "end\t0.03", "cleanup"];
    let messages = |more: &str| {
        let run = run(&with_script(WAITING_TEXT, more).unwrap());
        assert_eq!(run.status, Status::Completed);
        run.messages.into_iter().map(|m| m.text).collect::<Vec<_>>()
    };
    assert_eq!(messages("threaded = true"), wanted);
    // the first wait is left at the first step after the initialization
    assert_eq!(messages(""), wanted);
}

#[test]
fn a_text_that_waits_to_the_end_of_the_run_is_cleaned_up() {
    let code = "
        function sysCall_threadmain() print('never') end
        function sysCall_cleanup() print('cleanup', n) end
        n = 0
        while true do n = n + 1 sim.wait(0.01) end";
    assert_eq!(said(code), ["cleanup\t5"]);
}

#[test]
fn a_main_function_that_is_only_mentioned_leaves_an_old_script_as_it_is() {
    let code = "-- sysCall_threadmain is for threads
        if sim_call_type == sim_childscriptcall_initialization then print('init') end
        if sim_call_type == sim_childscriptcall_cleanup then print('cleanup') end";
    assert_eq!(said(code), ["init", "cleanup"]);
}

#[test]
fn a_thread_that_never_waits_is_made_to() {
    let code = "
        function sysCall_thread() while true do n = (n or 0) + 1 end end
        function sysCall_cleanup() print(n > 0) end";
    assert_eq!(said(code), ["true"]);
}

#[test]
fn descendants_are_called_before_ancestors_and_siblings_in_their_order() {
    let script = |object: &str, more: &str| {
        let code = format!("function sysCall_actuation() print('{object}{more}') end");
        format!(
            "[[script]]\nobject = \"{object}\"\ncode = \"{code}\"\n{}\n",
            if more.is_empty() { "" } else { "kind = \"customization\"" }
        )
    };
    let frame = "[[frame]]\nname = \"second\"\nparent = \"/hinge/arm\"\n";
    let scripts = ["/hinge", "/hinge/arm/second", "/hinge/arm/tip", "/hinge/arm"].map(|object| script(object, ""));
    let scene = format!("{PENDULUM}\n{frame}\n{}{}", script("/hinge/arm", " c"), scripts.concat());
    let experiment = EXPERIMENT.replace("0.05", "0.01");
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", &experiment)]).unwrap_or_else(|p| panic!("{p}"));
    let said: Vec<String> = run(&loaded).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said, ["/hinge/arm/tip", "/hinge/arm/second", "/hinge/arm", "/hinge/arm c", "/hinge"]);
}

#[test]
fn scripts_may_be_called_less_often_than_the_world_steps() {
    let code = "function sysCall_actuation() print(sim.getSimulationTime(), sim.getSimulationTimeStep()) end
        function sysCall_sensing() print(sim.getSimulationTime()) end";
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nfile = \"a.lua\"\n");
    let experiment = format!("simulation_step = 0.02\n{EXPERIMENT}");
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", &experiment), ("a.lua", code)]).unwrap();
    let said: Vec<String> = run(&loaded).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said, ["0.0\t0.02", "0.0", "0.02\t0.02", "0.02", "0.04\t0.02"]);
    let experiment = experiment.replace("0.02", "0.015");
    let problems = open(&[("scene.toml", &scene), ("experiment.toml", &experiment), ("a.lua", code)]).unwrap_err();
    assert!(
        problems.to_string().contains("`simulation_step` is 0.015 s, no whole multiple of the base step, 0.01 s"),
        "{problems}"
    );
}

#[test]
fn a_script_that_stops_the_simulation_ends_the_run_there() {
    let code = "function sysCall_sensing() if sim.getSimulationTime() > 0.015 then sim.stopSimulation() end end";
    let simulated = run(&with_script(code, "").unwrap());
    assert!(matches!(simulated.status, Status::Stopped { tick: 3, .. }), "{:?}", simulated.status);
    assert_eq!(simulated.table.times().len(), 4);
}

#[test]
fn lines_that_v_rep_wrote_around_older_scripts_keep_their_meaning() {
    let code = "
        if sim_call_type == sim_childscriptcall_initialization then
            print(simSetScriptAttribute(sim_handle_self, sim_childscriptattribute_automaticcascadingcalls, false))
        end
        if sim_call_type == sim_childscriptcall_sensing then print(simHandleChildScripts(sim_call_type)) end
        if sim_call_type == sim_childscriptcall_actuation then
            first = first or 0
            simSetScriptAttribute(sim_handle_self, sim_scriptattribute_executioncount, first)
            first = first + 1
            if simGetScriptExecutionCount() == 0 then print('first') end
            print(simGetScriptExecutionCount(), simGetScriptAttribute(sim_handle_self, sim_scriptattribute_executioncount))
        end";
    assert_eq!(said(code)[..6], ["1", "first", "0\t0", "0", "1\t1", "0"]);
}

#[test]
fn calls_of_an_old_script_are_counted() {
    let counted = said("print(simGetScriptExecutionCount(), simHandleChildScripts(sim_call_type, 1))");
    assert_eq!(counted[1], "0\t-1");
    assert!(counted[0].contains("calls nothing: the step calls the scripts below"), "{counted:?}");
    assert_eq!(counted[3], "1\t-1");
    let refused = said("print(pcall(sim.setScriptAttribute, sim.handle_self, sim.scriptattribute_executionorder, 0))");
    assert!(refused[0].contains("there is no attribute 1: "), "{refused:?}");
}

#[test]
fn a_script_that_is_disabled_is_not_called_any_more() {
    let code =
        "function sysCall_init() n = 0 print(sim.getScriptAttribute(sim.handle_self, sim.scriptattribute_enabled)) end
        function sysCall_actuation()
            n = n + 1
            print(n, sim.getScriptAttribute(sim.handle_self, sim.scriptattribute_scripttype))
            if n == 2 then simSetScriptAttribute(sim.handle_self, sim.scriptattribute_enabled, false) end
        end
        function sysCall_cleanup() print('gone') end";
    assert_eq!(said(code), ["true", "1\t1", "2\t1"]);
}

#[test]
fn a_customization_script_may_be_left_out_of_runs() {
    let code = "if sim_call_type == sim_customizationscriptcall_initialization then
            n = 0
            simSetScriptAttribute(sim_handle_self, sim_customizationscriptattribute_activeduringsimulation, false)
            print(simGetScriptAttribute(sim_handle_self, sim_customizationscriptattribute_activeduringsimulation))
        end
        if sim_call_type == sim_customizationscriptcall_simulationactuation then n = n + 1 end
        if sim_call_type == sim_customizationscriptcall_cleanup then print(n) end";
    let run = run(&with_script(code, "kind = \"customization\"").unwrap());
    assert_eq!(run.messages.iter().map(|m| m.text.as_str()).collect::<Vec<_>>(), ["false", "0"]);
}

/// Messages of scripts on `/hinge`, `/hinge/arm`, `/hinge/arm/tip` and `/hinge/arm/other` in one step.
fn said_by(codes: [&str; 4]) -> Vec<String> {
    let script = |object: &str, code: &str| match code {
        "" => String::new(),
        code => format!("[[script]]\nobject = \"{object}\"\ncode = \"\"\"{code}\"\"\"\n"),
    };
    let objects = ["/hinge", "/hinge/arm", "/hinge/arm/tip", "/hinge/arm/other"];
    said_in_a_step(&objects.iter().zip(codes).map(|(object, code)| script(object, code)).collect::<String>())
}

/// Messages in one step of scripts, as the scene file has them.
fn said_in_a_step(scripts: &str) -> Vec<String> {
    let scene = format!("{PENDULUM}\n[[frame]]\nname = \"other\"\nparent = \"/hinge/arm\"\n{scripts}");
    let experiment = EXPERIMENT.replace("0.05", "0.01");
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", &experiment)]).unwrap_or_else(|p| panic!("{p}"));
    let run = run(&loaded);
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run.messages.into_iter().map(|m| m.text).collect()
}

/// A script that calls those below it in actuation, with arguments, and in sensing without.
const CALLS: &str = "
    if sim_call_type == sim_childscriptcall_initialization then
        simSetScriptAttribute(sim_handle_self, sim_childscriptattribute_automaticcascadingcalls, false)
    end
    if sim_call_type == sim_childscriptcall_actuation then
        print('before')
        print(simHandleChildScripts(sim_call_type, 7, 'go', {1, 2}))
    end
    if sim_call_type == sim_childscriptcall_sensing then simHandleChildScripts(sim_call_type) end";

/// A script that prints its arguments.
const SAYS: &str = "
    local number, word, list = ...
    if sim_call_type == sim_childscriptcall_actuation then print(number, word, list and #list) end
    if sim_call_type == sim_childscriptcall_sensing then print('sensing', number) end";

#[test]
fn a_script_hands_arguments_to_those_below_it() {
    assert_eq!(
        said_by(["", CALLS, SAYS, SAYS]),
        ["before", "7\tgo\t2", "7\tgo\t2", "2", "sensing\tnil", "sensing\tnil"]
    );
}

#[test]
fn the_cascade_goes_on_below_scripts_that_leave_it_automatic() {
    let new = "function sysCall_actuation(...) print('arm', ...) end";
    let said = said_by([&CALLS.replace(", {1, 2}", ""), new, SAYS, ""]);
    assert_eq!(said, ["before", "arm\t7\tgo", "7\tgo\tnil", "1", "sensing\tnil"]);
}

#[test]
fn scripts_below_one_that_calls_nothing_are_not_called() {
    let silent = "function sysCall_init()
            sim.setScriptAttribute(sim.handle_self, sim.childscriptattribute_automaticcascadingcalls, false)
        end
        function sysCall_actuation() print(sim.getScriptAttribute(sim.handle_self, 3)) end";
    assert_eq!(said_by([silent, SAYS, SAYS, SAYS]), ["false"]);
}

#[test]
fn a_script_of_v_rep_3_1_2_calls_another_one_by_its_handle_and_gets_its_results() {
    let above = "
        if simGetScriptExecutionCount() == 0 then tip = simGetScriptAssociatedWithObject(simGetObjectHandle('tip')) end
        print('above', simHandleChildScript(tip, 20, 1))
        print(simHandleChildScript(sim_handle_all_except_explicit, 5))";
    let below = "local a, b = ... print('below', a, b, simGetScriptExecutionCount()) return a and b and a + b, 'sum'";
    let other = "simGetScriptExecutionCount() print('other', ...)";
    let said = said_by(["", above, below, other]);
    assert_eq!(said, ["below\t20\t1\t0", "above\t21\tsum", "other\t5", "1"]);
}

#[test]
fn a_fault_in_a_script_below_names_it() {
    let calls = CALLS
        .replace("print(simHandle", "print(pcall(simHandle")
        .replace("Scripts(sim_call_type, 7, 'go', {1, 2})", "Scripts, sim_call_type)");
    let said = said_by(["", &calls, "if sim_call_type == sim_childscriptcall_actuation then error('no leg') end", ""]);
    assert!(said[1].contains("script of `/hinge/arm/tip`: no leg"), "{said:?}");
}

/// Scripts of V-REP up to 3.1.2 that print their arguments.
const OLDEST: [&str; 3] = [
    "simGetScriptExecutionCount() print('arm', ...)",
    "simGetScriptExecutionCount() print('tip', ...)",
    "simGetScriptExecutionCount() print('other', ...)",
];

#[test]
fn a_script_of_v_rep_3_1_2_calls_also_those_below_the_ones_that_call_none() {
    let [arm, tip, other] = OLDEST;
    let all = said_by(["print(simHandleChildScript(sim_handle_all, 5))", arm, tip, other]);
    assert_eq!(all, ["arm\t5", "tip\t5", "other\t5", "1"]);
    let by_handle = "print(simHandleChildScript(simGetScriptAssociatedWithObject(simGetObjectHandle('arm')), 6))";
    assert_eq!(said_by([by_handle, arm, tip, other]), ["arm\t6", "tip\t6", "other\t6", "nil"]);
    let with_one_explicit = "
        simHandleChildScript(simGetScriptAssociatedWithObject(simGetObjectHandle('tip')), 7)
        print(simHandleChildScript(sim_handle_all_except_explicit, 8))";
    assert_eq!(said_by([with_one_explicit, arm, tip, other]), ["tip\t7", "arm\t8", "other\t8", "1"]);
    let itself = format!("{arm} simHandleChildScript(sim_handle_all, 9)");
    let called_once = said_by(["simHandleChildScript(sim_handle_all, 5)", &itself, tip, other]);
    assert_eq!(called_once, ["arm\t5", "tip\t9", "other\t9"]);
}

#[test]
fn a_thread_that_is_called_by_its_handle_is_left_to_the_step() {
    let script = |object: &str, code: &str| format!("[[script]]\nobject = \"{object}\"\ncode = \"{code}\"\n");
    let calls = "print(simHandleChildScript(simGetScriptAssociatedWithObject(simGetObjectHandle('tip'))))";
    let waits = "print('begins') simSwitchThread() print('never')";
    let scripts = script("/hinge/arm", calls) + &script("/hinge/arm/tip", waits) + "threaded = true\n";
    assert_eq!(said_in_a_step(&scripts), ["begins", "nil"]);
}

#[test]
fn calls_in_comments_in_quotes_and_in_new_scripts_leave_those_below_to_the_step() {
    let below = "function sysCall_actuation() print('below') end";
    for above in [
        "-- formerly: simHandleChildScript(sim_handle_all)\nfunction sysCall_init() end",
        "--[[ simHandleChildScript(sim_handle_all)\n ]] word = 'simHandleChildScript(sim_handle_all)'",
        "function sysCall_init() if word then simHandleChildScript(sim_handle_all) end end",
    ] {
        assert_eq!(said_by([above, "", below, ""]), ["below"], "{above}");
    }
    assert_eq!(said_by(["if word then simHandleChildScript (sim_handle_all) end", "", below, ""]), [""; 0]);
}

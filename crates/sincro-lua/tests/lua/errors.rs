//! Errors of scripts: those for V-REP up to 3.4 are called again, others stop the run unless they say otherwise.

use sincro_sim::results::Status;
use sincro_sim::run::Simulated;

use super::world::{EXPERIMENT, PENDULUM, open, run, stop, with_script};

/// An old script that fails in every second actuation, in two ways.
const FAILS: &str = "
if sim_call_type == sim_childscriptcall_initialization then n = 0 end
if sim_call_type == sim_childscriptcall_sensing then simSetFloatSignal('seen', n) end
if sim_call_type == sim_childscriptcall_actuation then
    n = n + 1
    if n % 4 == 2 then simGetObjectHandle('nothing') end
    if n % 4 == 0 then local x = missing + 1 end
    simSetFloatSignal('done', n)
end";

fn simulated(code: &str, keys: &str) -> Simulated {
    run(&with_script(code, keys).unwrap_or_else(|problems| panic!("{problems}")))
}

fn texts(run: &Simulated) -> Vec<&str> {
    run.messages.iter().map(|m| m.text.as_str()).collect()
}

/// Number of failed calls, time of the first one and what helps; none if the audit has no such finding.
fn finding(run: &Simulated) -> Option<(f64, f64, String)> {
    let found = run.laws.iter().find(|law| law.law == "script-errors")?;
    assert!(!found.holds() && found.element == "/hinge/arm", "{found:?}");
    Some((found.value, found.time, found.help.clone()))
}

#[test]
fn an_old_script_is_called_again_and_the_audit_tells() {
    let run = simulated(FAILS, "");
    assert_eq!(run.status, Status::Completed);
    let texts = texts(&run);
    assert_eq!(texts.len(), 2, "each error is told once: {texts:?}");
    assert!(
        texts[0].starts_with("error: the script of `/hinge/arm` failed at ") && texts[0].contains("a.lua:6, "),
        "{texts:?}"
    );
    assert!(texts[0].ends_with("it is called again in the next step, as in V-REP"), "{texts:?}");
    assert!(texts[1].contains("a.lua:7, ") && texts[1].contains("nil value (global 'missing')"), "{texts:?}");
    let (count, first, help) = finding(&run).unwrap();
    let steps = run.table.times().len() as f64 - 1.0;
    assert_eq!(count, (steps / 2.0).floor());
    let step = run.table.times()[1];
    assert!((first - step).abs() < 1e-12, "the second step: {first}");
    assert!(help.contains("on_error = \"stop\"") && help.contains("a.lua:6"), "{help}");
}

#[test]
fn an_old_script_that_stops_the_run_says_so_in_the_scene() {
    let run = simulated(FAILS, "on_error = \"stop\"");
    assert!(matches!(&run.status, Status::Stopped { reason, .. } if reason.contains("nothing")), "{:?}", run.status);
    assert_eq!(finding(&run), None);
}

#[test]
fn an_old_script_that_fails_at_its_start_is_called_in_the_steps() {
    let code = "if sim_call_type == sim_childscriptcall_initialization then simGetObjectHandle('nothing') end
        if sim_call_type == sim_childscriptcall_actuation and simGetSimulationTime() == 0 then print('called') end";
    let run = simulated(code, "");
    assert_eq!((run.status.clone(), texts(&run).len(), texts(&run)[1]), (Status::Completed, 2, "called"));
    assert_eq!(finding(&run).unwrap().0, 1.0);
}

#[test]
fn an_old_thread_ends_with_its_error() {
    let code = "print('begins') simSwitchThread() simGetObjectHandle('nothing') print('never')";
    let run = simulated(code, "threaded = true");
    assert_eq!((run.status.clone(), texts(&run).len(), texts(&run)[0]), (Status::Completed, 2, "begins"));
    assert_eq!(finding(&run).unwrap().0, 1.0);
}

#[test]
fn a_new_script_stops_the_run_unless_the_scene_says_otherwise() {
    let code = "function sysCall_actuation()
        print('called')
        if sim.getSimulationTime() > 0 then sim.getObject('/nothing') end
    end
    function sysCall_cleanup() print('cleanup') end";
    assert!(stop(code).0.contains("a.lua:3"));
    let run = simulated(code, "on_error = \"continue\"");
    assert_eq!(run.status, Status::Completed);
    let texts = texts(&run);
    assert_eq!((texts.len(), texts[0], texts[1]), (3, "called", "called"), "{texts:?}");
    assert!(texts[2].ends_with("it is not called any more in this run, as in CoppeliaSim"), "{texts:?}");
    assert_eq!(finding(&run).unwrap().0, 1.0);
}

#[test]
fn names_of_the_present_api_make_a_script_new() {
    for code in [
        "simSetFloatSignal('a', 1) sim.getObject('/nothing')",
        "function sysCall_init() simGetObjectHandle('nothing') end",
        "error('no name of either')",
    ] {
        let run = simulated(code, "");
        assert!(matches!(run.status, Status::Stopped { .. }), "{code}: {:?}", run.status);
    }
    // in comments and texts names do not count
    let run = simulated("-- sim.getObject\nprint('sim.x') simGetObjectHandle('nothing')", "");
    assert_eq!(run.status, Status::Completed);
}

#[test]
fn a_limit_stops_the_run_of_any_script() {
    let keys = "max_instructions = 100000\non_error = \"continue\"";
    let run = simulated("if sim_call_type == sim_childscriptcall_actuation then while true do end end", keys);
    assert!(
        matches!(&run.status, Status::Stopped { reason, .. } if reason.contains("instructions")),
        "{:?}",
        run.status
    );
    let memory = "if sim_call_type == sim_childscriptcall_actuation then s = ('x'):rep(2^20):rep(100) end";
    let run = simulated(memory, "max_memory_mib = 8");
    assert!(matches!(&run.status, Status::Stopped { reason, .. } if reason.contains("memory")), "{:?}", run.status);
}

#[test]
fn a_number_that_is_not_finite_stops_the_run_of_any_script() {
    let run = simulated(
        "if sim_call_type == sim_childscriptcall_actuation then simSetFloatSignal('a', 0/0) simSetJointTargetVelocity(simGetObjectHandle('hinge'), 0/0) end",
        "",
    );
    assert!(matches!(&run.status, Status::Stopped { .. }), "{:?}", run.status);
}

#[test]
fn a_number_that_is_not_finite_from_a_callback_stops_the_run() {
    for answer in ["{ velocity = 0/0 }", "{ velocity = 1, force = 1/0 }"] {
        let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nfile = \"a.lua\"\non_error = \"continue\"\n");
        let code = format!("function sysCall_joint() return {answer} end");
        let files = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("a.lua", &*code)];
        let run = run(&open(&files).unwrap_or_else(|problems| panic!("{problems}")));
        assert!(matches!(&run.status, Status::Stopped { .. }), "{answer}: {:?}", run.status);
    }
}

#[test]
fn a_refusal_of_a_number_that_is_caught_is_over() {
    let refuse = "local ok, why = pcall(sim.setJointTargetVelocity, sim.getObject('/hinge'), 0/0)";
    let run_of = |then: &str| {
        simulated(&format!("function sysCall_actuation() {refuse} {then} end"), "on_error = \"continue\"").status
    };
    assert_eq!(run_of("local x = missing + 1"), Status::Completed);
    assert!(matches!(run_of("error(why)"), Status::Stopped { .. }), "raised again");
}

#[test]
fn long_errors_are_cut() {
    let run = simulated("function sysCall_actuation() error(('x'):rep(100000)) end", "on_error = \"continue\"");
    assert_eq!(run.status, Status::Completed);
    let (_, _, help) = finding(&run).unwrap();
    assert!(help.len() < 11_000, "{}", help.len());
}

#[test]
fn parameters_that_an_object_does_not_have_are_no_errors_to_old_scripts() {
    let code = "if sim_call_type == sim_childscriptcall_initialization then
        local arm, hinge = simGetObjectHandle('arm'), simGetObjectHandle('hinge')
        print(simGetObjectIntParameter(hinge, 999), simGetObjectFloatParameter(arm, 2002))
        print(simSetObjectIntParameter(hinge, 999, 1), simGetObjectIntParameter(hinge, 999))
        print(simGetObjectIntParameter(hinge, 2000))
    end";
    let run = simulated(code, "");
    assert_eq!((run.status.clone(), finding(&run)), (Status::Completed, None));
    let texts = texts(&run);
    let (told, printed): (Vec<&str>, Vec<&str>) = texts.iter().partition(|text| text.ends_with("as in V-REP"));
    assert_eq!(printed, ["0\t0", "0\t0", "1\t1"], "{texts:?}");
    assert_eq!(told.len(), 3, "each is told once: {told:?}");
    let (reason, _) = stop("function sysCall_init() sim.getObjectIntParameter(sim.getObject('/hinge'), 999) end");
    assert!(reason.contains("parameter 999"), "{reason}");
}

//! Coroutines that scripts make themselves: as CoppeliaSim 4.1 to 4.5 converted threads.

use sincro_sim::results::Status;

use super::world::{run, said, stop, with_script};

/// Callbacks that resume `coroutineMain` in actuation, as the converted scripts do.
const RESUMED: &str = "
    function sysCall_init() corout = coroutine.create(coroutineMain) end
    function sysCall_actuation()
        if coroutine.status(corout) ~= 'dead' then
            local ok, message = coroutine.resume(corout)
            if message then error(debug.traceback(corout, message), 2) end
        end
    end";

fn resumed(body: &str) -> Vec<String> {
    said(&format!("function coroutineMain()\n{body}\nend\n{RESUMED}"))
}

#[test]
fn a_coroutine_that_never_yields_is_made_to_once_a_step() {
    let said = resumed(
        "local last = -1
        while true do
            if sim.getSimulationTime() ~= last then
                last = sim.getSimulationTime()
                print(last)
            end
        end",
    );
    assert_eq!(said, ["0.0", "0.01", "0.02", "0.03", "0.04"]);
}

#[test]
fn a_coroutine_without_calls_is_made_to_yield() {
    let counted = resumed("n = 0 while true do n = n + 1 if n % 250000 == 0 then print(n) end end");
    assert!((2..=4).contains(&counted.len()), "{counted:?}");
}

#[test]
fn functions_that_wait_yield_out_of_a_coroutine() {
    let said = resumed(
        "sim.switchThread()
        print(sim.getSimulationTime())
        sim.wait(0.02)
        print(sim.getSimulationTime())
        sim.setInt32Signal('go', 1)
        print(sim.waitForSignal('go'))
        sim.step()
        print(sim.getSimulationTime())",
    );
    assert_eq!(said, ["0.01", "0.03", "1", "0.04"]);
}

#[test]
fn a_motion_in_a_coroutine_takes_steps() {
    let said = resumed(
        "local arm = sim.getObject('/hinge')
        sim.moveToConfig { joints = { arm }, targetPos = { 0.501 }, maxVel = { 1 }, maxAccel = { 10 }, maxJerk = { 1000 } }
        print(sim.getSimulationTime() > 0)",
    );
    assert_eq!(said, ["true"]);
}

#[test]
fn a_coroutine_is_resumed_in_sensing_too_and_through_wrap() {
    let code = "
        local busy = coroutine.wrap(function()
            while true do
                local t = sim.getSimulationTime()
                if t ~= last then last = t print(t) end
            end
        end)
        function sysCall_sensing() busy() end";
    assert_eq!(said(code), ["0.0", "0.01", "0.02", "0.03", "0.04"]);
}

#[test]
fn an_iterator_in_a_busy_coroutine_is_not_interrupted() {
    // the coroutine's own slice comes to its end while the iterator is at work, many times
    let said = resumed(
        "local function numbers(n)
            return coroutine.wrap(function()
                for k = 1, n do
                    for _ = 1, 3000 do end
                    coroutine.yield(k)
                end
            end)
        end
        local n = 0
        for k in numbers(900) do
            n = n + 1
            if k ~= n then print('lost', n) end
        end
        print(n, sim.getSimulationTime() > 0)",
    );
    assert_eq!(said, ["900\ttrue"]);
}

#[test]
fn an_iterator_outside_of_any_thread_may_take_long() {
    let code = "function sysCall_init()
        local n, sum = 0, 0
        local numbers = coroutine.wrap(function() for k = 1, 100 do for _ = 1, 50000 do end coroutine.yield(k) end end)
        for k in numbers do n, sum = n + 1, sum + k end
        print(n, sum)
    end";
    assert_eq!(said(code), ["100\t5050"]);
}

#[test]
fn a_coroutine_that_forbids_switching_ends_at_its_limit() {
    let body = "function coroutineMain() sim.setThreadAutomaticSwitch(false) while true do end end";
    let (reason, _) = stop(&format!("{body}\n{RESUMED}"));
    assert!(reason.contains("one call took more than 20000000 instructions"), "{reason}");
}

#[test]
fn a_coroutine_inside_a_callback_of_a_library_yields_after_it() {
    let said = resumed(
        "local t = {}
        for k = 1, 200 do t[k] = (k * 7919) % 211 end
        table.sort(t, function(a, b) for _ = 1, 2000 do end return a < b end)
        print(t[1] < t[2], sim.getSimulationTime())
        for _ = 1, 2000 do end
        print(sim.getSimulationTime())",
    );
    assert_eq!(said, ["true\t0.0", "0.01"]);
}

#[test]
fn an_error_in_a_coroutine_is_told_with_its_line() {
    let (reason, _) = stop(&format!("function coroutineMain()\n  sim.switchThread()\n  nothing()\nend\n{RESUMED}"));
    assert!(reason.contains("nothing") && reason.contains("a.lua:3"), "{reason}");
}

#[test]
fn busy_coroutines_give_the_same_bits_in_every_run() {
    let code = format!(
        "function coroutineMain()
            local hinge, n = sim.getObject('/hinge'), 0
            while true do
                n = n + 1
                sim.setJointTargetVelocity(hinge, math.sin(n))
                sim.setFloatSignal('n', n)
            end
        end\n{RESUMED}"
    );
    let hash = || {
        let simulated = run(&with_script(&code, "").unwrap());
        assert_eq!(simulated.status, Status::Completed);
        simulated.trace
    };
    assert_eq!(hash(), hash());
}

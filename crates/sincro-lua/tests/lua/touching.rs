//! Contacts, force sensors and joint limits from scripts; `sysCall_joint`; float signals and messages in what is kept
//! of a run.

use sincro_sim::results::Status;
use sincro_sim::run::Simulated;
use sincro_testing::scenes::TOUCHING;

use super::world::{EXPERIMENT, PENDULUM, open, run, said, with_script};

/// [`TOUCHING`] with a script on its box.
fn scene() -> String {
    format!("{TOUCHING}\n[[script]]\nobject = \"/loose/box\"\nfile = \"a.lua\"\n")
}

/// Runs a script on the box, with `more` at the end of the scene file.
fn with_box(code: &str, record: &str, more: &str) -> Simulated {
    let experiment = EXPERIMENT.replace("record = [\"/hinge.position\", \"/hinge.motor_torque_now\"]", record);
    let scene = scene() + more;
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", &experiment), ("a.lua", code), ("b.lua", JOINT)]);
    run(&loaded.unwrap_or_else(|problems| panic!("{problems}")))
}

fn texts(run: &Simulated) -> Vec<&str> {
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run.messages.iter().map(|m| m.text.as_str()).collect()
}

const JOINT: &str = "function sysCall_joint(joint)
    if joint.first then print(joint.revolute, joint.lowLimit, joint.highLimit, joint.dynStepSize, joint.targetPos, joint.velUpperLimit) end
    return { velocity = 2 * (0.3 - joint.currentPos) }
end";

#[test]
fn contacts_force_sensors_and_stops_are_seen() {
    let code = "function sysCall_sensing()
        if sim.getSimulationTime() < 0.035 then return end
        local lift, n = 0, 0
        while true do
            local bodies, point, force, normal = sim.getContactInfo(sim.handle_all, sim.handle_self, n)
            if not bodies then break end
            local sign = bodies[1] == sim.getObject('.') and 1 or -1
            lift = lift + sign * force[3]
            n = n + 1
        end
        local floor = sim.getObject('/floor')
        print(n >= 3, math.abs(lift - 9.81) < 1e-6, sim.checkCollision(floor, sim.handle_self))
        local state, force, torque = simReadForceSensor(simGetObjectHandle('scale'))
        print(state, math.abs(force[3] + 19.62) < 1e-9, math.abs(torque[1]) < 1e-9)
        local cyclic, interval = sim.getJointInterval(sim.getObject('/first'))
        print(cyclic, interval[1], interval[2], sim.getJointDependency(sim.getObject('/second')))
        print(pcall(sim.setShapeMaterial, 1, 2))
        print(select(2, pcall(sim.checkCollision, floor, sim.getObject('/load'))))
    end";
    let run = with_box(code, "record = [\"/loose.position.z\"]", "");
    let said = texts(&run);
    assert!(said[0].starts_with("true\ttrue\t1\t"), "{said:?}");
    assert_eq!(said[1..3], ["1\ttrue\ttrue", "false\t-0.5\t1.5\t6\t0.0\t4.0"]);
    assert!(said[3].contains("sim.setShapeMaterial is not offered: the parameters of Bullet"));
    assert!(said[4].contains("`/scale/load` has no shape: it meets nothing"), "{said:?}");
}

#[test]
fn a_force_sensor_transmits_the_push_of_a_script() {
    let code = "function sysCall_actuation()
            sim.addForceAndTorque(sim.getObject('/load'), {3, 0, 5}, {0, 0, 0.5})
        end
        function sysCall_sensing()
            local _, force, torque = simReadForceSensor(simGetObjectHandle('scale'))
            local seen = math.abs(force[1] - 3) + math.abs(force[3] - 5 + 19.62) + math.abs(torque[3] - 0.5)
            assert(seen < 1e-9, force[1] .. ' ' .. force[3] .. ' ' .. torque[3])
        end";
    let run = with_box(code, "record = [\"/scale.force.z\"]", "");
    assert_eq!(run.status, Status::Completed);
    let held = &run.table.column("/scale.force.z").unwrap().values;
    assert!(held[1..].iter().all(|f| (f - 14.62).abs() < 1e-9), "the parent on the child: {held:?}");
}

#[test]
fn a_script_on_a_joint_says_how_fast_its_motor_is() {
    let more = "[[script]]\nobject = \"/first\"\nfile = \"b.lua\"\n";
    let run = with_box("x = 1", "record = [\"/first.position\"]", more);
    assert_eq!(texts(&run), ["false\t-0.5\t1.0\t0.01\t0.0\tinf"]);
    let q = &run.table.column("/first.position").unwrap().values;
    // q += h·2·(0.3 − q) at each step of 0.01 s
    let mut expected = 0.0;
    for x in q {
        assert!((x - expected).abs() < 1e-12, "{q:?}");
        expected += 0.01 * 2.0 * (0.3 - expected);
    }
    let old = "function sysCall_jointCallback(joint) return 100, 0.3 end
        function sysCall_cleanup() print(sim.getJointTargetForce(joint or sim.getObject('.')), sim.getJointTargetVelocity(sim.getObject('.'))) end";
    let scene = scene() + more;
    let experiment = EXPERIMENT.replace("/hinge.position\", \"/hinge.motor_torque_now", "/first.position");
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", &experiment), ("a.lua", "x = 1"), ("b.lua", old)]);
    assert_eq!(texts(&super::world::run(&loaded.unwrap())), ["100.0\t0.3"], "force, then velocity");
    let wrong = with_script("function sysCall_joint() return 'fast' end", "").unwrap();
    let Status::Stopped { reason, .. } = super::world::run(&wrong).status else { panic!("it went on") };
    assert!(reason.contains("is no joint"), "{reason}");
}

#[test]
fn float_signals_and_messages_are_kept_with_the_run() {
    let code = "function sysCall_actuation()
            local t = sim.getSimulationTime()
            if t > 0.015 then sim.setFloatSignal('thrust', 10 * t) end
            if t > 0.035 then sim.clearFloatSignal('thrust') end
        end
        function sysCall_sensing()
            sim.addStatusbarMessage('status ' .. sim.getSimulationTime())
            simAddLog(sim_verbosity_warnings, 'careful')
            print('printed')
        end";
    let run = with_box(code, "record = [\"float_signal.thrust\", \"/loose.position.z\", \"float_signal.never\"]", "");
    let thrust = &run.table.column("float_signal.thrust").unwrap().values;
    let told: Vec<String> = thrust.iter().map(|x| format!("{x:.1}")).collect();
    assert_eq!(told, ["NaN", "NaN", "NaN", "0.2", "0.3", "NaN"], "from the end of the step in which it was set");
    assert!(run.table.column("float_signal.never").unwrap().values.iter().all(|x| x.is_nan()));
    let said = texts(&run);
    assert_eq!(
        (said.len(), said[..4].contains(&"status 0.0"), said.contains(&"careful")),
        (15, true, true),
        "{said:?}"
    );
    assert!(run.messages.iter().all(|m| m.object == "/loose/box"));
    assert!(run.messages.windows(2).all(|pair| pair[0].t <= pair[1].t));
}

#[test]
fn what_is_said_too_often_is_counted() {
    let code = "function sysCall_actuation() for k = 1, 3000 do sim.addLog(450, 'x') end end";
    let run = with_box(code, "record = [\"/loose.position.z\"]", "");
    assert_eq!(run.messages.len(), 10_000);
    assert!(run.warnings.iter().any(|w| w.contains("said 5000 more things than are kept")), "{:?}", run.warnings);
}

#[test]
fn a_customization_script_comes_before_everything_else_of_the_step() {
    let code = "function sysCall_beforeMainScript() print('before') end
        function sysCall_actuation() print('acts') end";
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge\"\nkind = \"customization\"\nfile = \"a.lua\"\n");
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap();
    let run = run(&loaded);
    assert_eq!(texts(&run)[..2], ["before", "acts"]);
}

/// Every function of `sim`, with arguments of many kinds: a result or an error that says why.
#[test]
fn every_function_answers_any_arguments() {
    let code = "function sysCall_init()
        local three, twelve = { 0.1, 0.2, 0.3 }, { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 }
        local kinds = { {}, { 1 }, { 1, -1 }, { 2, three, -1 }, { 2, three, three }, { twelve, twelve, 0.5 }, { 'name', 1.5 }, { three, 3 },
            { 0 / 0, 0 / 0, 0 / 0 }, { -1 << 63, ~(-1 << 63) }, { true, {}, { {} } }, { '\\255\\0', 'x' }, { print, print }, { 'x', 4, { x = 1 } },
            { string.rep('x', 5000), string.rep('y', 5000) }, { { 1 / 0, -1 / 0 }, { 1e308 } } }
        -- these wait, or call what they are given
        local skip = { wait = 1, step = 1, switchThread = 1, yield = 1, waitForSignal = 1, handleExtCalls = 1, stopSimulation = 1, closeScene = 1,
            loadScene = 1, testCB = 1, setThreadAutomaticSwitch = 1, setStepping = 1 }
        local names = {}
        for name, f in pairs(sim) do if type(f) == 'function' and not skip[name] then names[#names + 1] = name end end
        local done, reasons = 0, 0
        for _, name in ipairs(names) do
            for _, arguments in ipairs(kinds) do
                local ok, why = pcall(sim[name], table.unpack(arguments))
                if ok then done = done + 1 else
                    reasons = reasons + 1
                    assert(#tostring(why) > 15 and not tostring(why):find('panic'), name .. ': ' .. tostring(why))
                end
            end
        end
        print(#names > 250, done > 500, reasons > 2000)
    end";
    let said = said(code);
    assert!(said.iter().any(|line| line == "true\ttrue\ttrue"), "{said:?}");
}

//! Inverse kinematics of `simIK`: an arm of three joints is brought to where closed forms put it.

use super::world::{EXPERIMENT, open, run};

const ARM: &str = r#"
[[joint]]
name = "turn"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
motor = { mode = "position", kp = 20.0 }
[[body]]
name = "tower"
parent = "/turn"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[joint]]
name = "shoulder"
parent = "/turn"
kind = "revolute"
axis = [0.0, -1.0, 0.0]
motor = { mode = "position", kp = 20.0 }
initial = { position = 0.3 }
[[body]]
name = "upper"
parent = "/turn/shoulder"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[joint]]
name = "elbow"
parent = "/turn/shoulder/upper"
kind = "revolute"
axis = [0.0, -1.0, 0.0]
position = [0.5, 0.0, 0.0]
limits = { lower = -2.5, upper = 0.0 }
motor = { mode = "position", kp = 20.0 }
initial = { position = -0.4 }
[[body]]
name = "fore"
parent = "/turn/shoulder/upper/elbow"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[frame]]
name = "tip"
parent = "/turn/shoulder/upper/elbow/fore"
position = [0.4, 0.0, 0.0]
[[frame]]
name = "start"
[[script]]
object = "/start"
file = "a.lua"
"#;

fn said(code: &str) -> Vec<String> {
    let experiment = EXPERIMENT
        .replace("record = [\"/hinge.position\", \"/hinge.motor_torque_now\"]", "record = [\"/turn.position\"]")
        .replace("duration = 0.05", "duration = 0.01");
    let loaded = open(&[("scene.toml", ARM), ("experiment.toml", &experiment), ("a.lua", code)]);
    let run = run(&loaded.unwrap_or_else(|problems| panic!("{problems}")));
    run.messages.into_iter().map(|m| m.text).collect()
}

const SET_UP: &str = "
    simIK = require 'simIK'
    target = sim.createDummy(0.01)
    tip = sim.getObject('/tip')
    joints = { sim.getObject('/turn'), sim.getObject('/shoulder'), sim.getObject('/elbow') }
    env = simIK.createEnvironment()
    group = simIK.createGroup(env)
    simIK.setGroupCalculation(env, group, simIK.method_damped_least_squares, 0.01, 200)
";

#[test]
fn a_position_is_reached_and_told_to_the_motors() {
    let code = format!(
        "function sysCall_init() {SET_UP}
        local element = simIK.addElementFromScene(env, group, -1, tip, target, simIK.constraint_position)
        simIK.setElementPrecision(env, group, element, {{ 1e-9, 0.1 }})
        sim.setObjectPosition(target, {{ 0.3, 0.4, 0.2 }}, -1)
        print(simIK.handleGroup(env, group))
        print(sim.getJointTargetPosition(joints[1]) == 0)
        local result, flags, errors = simIK.handleGroup(env, group, {{ syncWorlds = true }})
        print(result == simIK.result_success, flags, errors[1] < 1e-9)
        -- in the vertical plane through the target: law of cosines
        local r, z = 0.5, 0.2
        local c = (r * r + z * z - 0.25 - 0.16) / (2 * 0.5 * 0.4)
        local elbow = -math.acos(c)
        local shoulder = math.atan2(z, r) - math.atan2(0.4 * math.sin(elbow), 0.5 + 0.4 * math.cos(elbow))
        for k, wanted in ipairs {{ math.atan2(0.4, 0.3), shoulder, elbow }} do
            print(math.abs(sim.getJointTargetPosition(joints[k]) - wanted) < 1e-7, sim.getJointPosition(joints[k]) == ({{ 0, 0.3, -0.4 }})[k])
        end
    end"
    );
    let said = said(&code);
    assert!(said[0].starts_with("1\t0\t"), "{said:?}");
    assert_eq!(said[1..], ["true", "true\t0\ttrue", "true\ttrue", "true\ttrue", "true\ttrue"]);
}

#[test]
fn what_cannot_be_reached_says_so_and_limits_hold() {
    let code = format!(
        "function sysCall_init() {SET_UP}
        simIK.addElementFromScene(env, group, -1, tip, target, simIK.constraint_position)
        sim.setObjectPosition(target, {{ 2, 0, 0 }}, -1)
        local result, flags, errors = simIK.handleGroup(env, group, {{ syncWorlds = true }})
        print(result == simIK.result_fail, flags & simIK.calc_notwithintolerance ~= 0, math.abs(errors[1] - 1.1) < 1e-3)
        print(sim.getJointTargetPosition(joints[2]))
        simIK.handleGroup(env, group, {{ syncWorlds = true, allowError = true }})
        print(sim.getJointTargetPosition(joints[3]) <= 0, sim.getJointTargetPosition(joints[3]) > -0.2)
        -- the axis of the tip's z is brought to the target's, which points along x and down
        local other = simIK.createGroup(env)
        simIK.setGroupCalculation(env, other, simIK.method_pseudo_inverse, 0, 100)
        simIK.addElementFromScene(env, other, -1, tip, target, simIK.constraint_alpha_beta)
        sim.setObjectOrientation(target, {{ 0, math.pi / 3, 0 }}, -1)
        print(simIK.handleGroup(env, other))
        for _, call in ipairs {{
            function() simIK.handleGroup(env, 7) end, function() simIK.createGroup(9) end, function() simIK.handleGroup(env, simIK.createGroup(env)) end,
            function() simIK.addElementFromScene(env, group, -1, target, tip, 7) end, function() simIK.addElementFromScene(env, group, -1, tip, target, 16) end,
            function() simIK.setGroupCalculation(env, group, 2, 0.1, 3) end, function() simIK.handleGroup(env, group, {{ sync = true }}) end,
            function() require 'simOMPL' end }} do
            print(select(2, pcall(call)))
        end
    end"
    );
    let said = said(&code);
    assert_eq!(said[0], "true\ttrue\ttrue", "{said:?}");
    assert_eq!(said[2], "true\ttrue", "{said:?}");
    assert!(said[3].starts_with("1\t0\t"), "{said:?}");
    let reasons = [
        "there is no group 7",
        "there is no environment 9",
        "the group has no elements",
        "no joint that turns or slides lies between base and tip",
        "constraints 16, expected a sum of",
        "method 2: pseudo-inverse 0",
        "there is no option `sync`",
        "there is no module 'simOMPL'",
    ];
    for (reason, text) in reasons.iter().zip(&said[4..]) {
        assert!(text.contains(reason), "{text}");
    }
    assert!(said[4].contains("(in function 'simIK.handleGroup')"), "{said:?}");
}

#[test]
fn groups_with_names_are_handled_as_those_of_old() {
    let code = format!(
        "function sysCall_init() {SET_UP}
        group = simIK.createIkGroup(env, 'reach')
        simIK.setIkGroupCalculation(env, group, simIK.method_damped_least_squares, 0.01, 200)
        local element = simIK.addIkElementFromScene(env, group, -1, tip, target, simIK.constraint_position)
        simIK.setIkElementPrecision(env, group, element, {{ 1e-9, 0.1 }})
        sim.setObjectPosition(target, {{ 0.3, 0.4, 0.2 }}, -1)
        local h = simGetIkGroupHandle('reach#')
        print(simIK.getGroupHandle(env, 'reach') == group)
        local result, places = simCheckIkGroup(h, {{ joints[3], joints[1] }})
        print(result == sim_ikresult_success, #places, sim.getJointTargetPosition(joints[1]) == 0)
        print(simHandleIkGroup(h), simHandleIkGroup(sim_handle_all))
        print(math.abs(sim.getJointTargetPosition(joints[3]) - places[1]) < 1e-9, math.abs(places[2] - math.atan2(0.4, 0.3)) < 1e-7)
        sim.setObjectPosition(target, {{ 2, 0, 0 }}, -1)
        print(simHandleIkGroup(h) == sim.ikresult_fail)
        for _, call in ipairs {{ function() simGetIkGroupHandle('other') end, function() simHandleIkGroup(group) end,
            function() simIK.createGroup(env, 'reach') end, function() simCheckIkGroup(h, 3) end, function() simHandleIkGroup(h + 1) end }} do
            print(select(2, pcall(call)))
        end
    end"
    );
    let said = said(&code);
    assert_eq!(said[..5], ["true", "true\t2\ttrue", "1\t1", "true\ttrue", "true"]);
    let reasons = [
        "there is no group `other` of inverse kinematics: groups have the names",
        "1 is no handle of a group",
        "a group has a name of its own",
        "argument 2 is no list of handles",
        "there is no group 2",
    ];
    for (reason, text) in reasons.iter().zip(&said[5..]) {
        assert!(text.contains(reason), "{text}");
    }
    assert_eq!(said.len(), 10);
}

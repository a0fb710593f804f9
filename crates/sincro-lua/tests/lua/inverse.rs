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
            function() require 'simConvex' end }} do
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
        "there is no module 'simConvex'",
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

/// Group whose tip is to reach a target on a circle of the arm.
const ELEMENT: &str = "
    base = sim.getObject('/start')
    element, to_ik, to_sim = simIK.addElementFromScene(env, group, -1, tip, target, simIK.constraint_position)
";

#[test]
fn an_environment_keeps_its_own_positions_until_the_scene_is_taken_over() {
    let code = format!(
        "function sysCall_init() {SET_UP}{ELEMENT}
        sim.setObjectPosition(target, {{ 0.5, 0.3, 0.4 }})
        print(element, to_ik[tip] == tip, to_sim[target] == target, simIK.doesGroupExist(env, 'none'))
        local before = sim.getJointPosition(joints[2])
        print(simIK.handleGroup(env, group))
        local solved = simIK.getJointPosition(env, joints[2])
        print(sim.getJointPosition(joints[2]) == before, math.abs(solved - before) > 0.01)
        simIK.syncFromSim(env, {{ group }})
        print(simIK.getJointPosition(env, joints[2]) == before)
        simIK.handleGroup(env, group)
        simIK.syncToSim(env, {{ group }})
        print(sim.getJointTargetPosition(joints[2]) == solved)
        local gap = simIK.applyIkEnvironmentToScene(env, group, true)
        print(gap == simIK.result_success)
        simIK.setGroupFlags(env, group, 0)
        print(simIK.handleGroup(env, group) == simIK.result_not_performed)
        end"
    );
    let said = said(&code);
    assert_eq!(said[0], "0\ttrue\ttrue\tfalse");
    assert!(said[1].starts_with("1\t0\t"), "{said:?}");
    assert_eq!(said[2..], ["true\ttrue", "true", "true", "true", "true"]);
}

#[test]
fn configurations_reach_the_target_within_limits_and_a_callback_chooses() {
    let code = format!(
        "function sysCall_init() {SET_UP}{ELEMENT}
        sim.setObjectPosition(target, {{ 0.5, 0.3, 0.4 }})
        local function reaches(q)
            local r = 0.5 * math.cos(q[2]) + 0.4 * math.cos(q[2] + q[3])
            local z = 0.5 * math.sin(q[2]) + 0.4 * math.sin(q[2] + q[3])
            local x, y = r * math.cos(q[1]), r * math.sin(q[1])
            return math.abs(x - 0.5) < 1e-3 and math.abs(y - 0.3) < 1e-3 and math.abs(z - 0.4) < 1e-3
        end
        local all = simIK.findConfigs(env, group, joints, {{ maxTime = 0.5, findMultiple = true }})
        local good, inside = 0, 0
        for _, q in ipairs(all) do
            if reaches(q) then good = good + 1 end
            if q[3] >= -2.5 and q[3] <= 0 then inside = inside + 1 end
        end
        print(#all >= 2, good == #all, inside == #all)
        local one = simIK.findConfig(env, group, joints)
        print(one[1] == all[1][1] and one[2] == all[1][2])
        local other = simIK.findConfig(env, group, joints, 0.1, 0.5, {{ 1, 1, 1, 0.1 }}, function(q) return math.abs(q[1]) > 2 end)
        print(math.abs(other[1]) > 2 and reaches(other))
        sim.setObjectPosition(target, {{ 5, 0, 0 }})
        print(simIK.findConfig(env, group, joints), #simIK.findConfigs(env, group, joints))
        end"
    );
    assert_eq!(said(&code), ["true\ttrue\ttrue", "true", "true", "nil\t0"]);
}

#[test]
fn a_path_is_straight_and_the_jacobian_is_that_of_the_arm() {
    let code = format!(
        "function sysCall_init() {SET_UP}{ELEMENT}
        local p = sim.getObjectPosition(tip, -1)
        sim.setObjectPosition(target, {{ p[1] - 0.1, p[2] + 0.2, p[3] + 0.1 }})
        local path = simIK.generatePath(env, group, joints, tip, 5)
        local worst = 0
        for k = 0, 4 do
            local q = {{ path[3 * k + 1], path[3 * k + 2], path[3 * k + 3] }}
            local r = 0.5 * math.cos(q[2]) + 0.4 * math.cos(q[2] + q[3])
            local z = 0.5 * math.sin(q[2]) + 0.4 * math.sin(q[2] + q[3])
            local s = k / 4
            worst = math.max(worst, math.abs(r * math.cos(q[1]) - p[1] + 0.1 * s), math.abs(r * math.sin(q[1]) - p[2] - 0.2 * s),
                math.abs(z - p[3] - 0.1 * s))
        end
        print(#path, worst < 1e-3)
        local J, size = simIK.getJacobian(env, group)
        local q2, q3 = sim.getJointPosition(joints[2]), sim.getJointPosition(joints[3])
        local r = 0.5 * math.cos(q2) + 0.4 * math.cos(q2 + q3)
        -- with the first joint at zero: its column is along y
        print(size[1], size[2], math.abs(J[4] - r) < 1e-12, math.abs(J[1]) < 1e-12)
        local a, b = 0.5, 0.4
        print(math.abs(simIK.getManipulability(env, group) - math.abs(a * b * math.sin(q3) * r)) < 1e-12)
        end"
    );
    assert_eq!(said(&code), ["15\ttrue", "3\t3\ttrue\ttrue", "true"]);
}

#[test]
fn the_step_solves_groups_that_are_not_explicit_and_motors_of_hybrid_joints_follow() {
    let code = format!(
        "function sysCall_init() {SET_UP}{ELEMENT}
            old = sim.getIkGroupHandle('arm')
            for _, joint in ipairs(joints) do sim.setJointMode(joint, sim.jointmode_ik, 1) end
            local p = sim.getObjectPosition(tip, -1)
            sim.setObjectPosition(target, -1, {{ p[1], p[2] + 0.02, p[3] }})
            print(sim.getJointMode(joints[1]))
            print(sim.getExplicitHandling(old))
            sim.setExplicitHandling(old, 0)
        end
        function sysCall_sensing()
            local q = sim.getJointTargetPosition(joints[1])
            print(q > 0.02 and q < 0.04, sim.getJointPosition(joints[1]) < q, sim.getJointPosition(joints[1]) > 0)
            for _, joint in ipairs(joints) do sim.setJointMode(joint, sim.jointmode_force, 0) end
            print(sim.getJointMode(joints[1]))
        end"
    );
    let code = code.replace("simIK.createGroup(env)", "simIK.createGroup(env, 'arm')");
    assert_eq!(said(&code), ["2\t1", "1", "true\ttrue\ttrue", "5\t0"]);
}

#[test]
fn groups_and_elements_are_changed_as_in_v_rep_3() {
    let code = format!(
        "function sysCall_init() {SET_UP}
        group = simIK.createIkGroup(env, 'reach')
        simIK.addIkElementFromScene(env, group, -1, tip, target, simIK.constraint_position)
        local h = simGetIkGroupHandle('reach')
        print(simSetIkGroupProperties(h, sim_ik_damped_least_squares_method, 200, 0.01))
        print(simSetIkElementProperties(h, tip, sim_ik_x_constraint + sim_ik_y_constraint, {{ 1e-9, 0.1 }}, {{ 0.5, 1 }}))
        print(simIK.getElementConstraints(env, group, 0), simIK.getElementWeights(env, group, 0)[1], simIK.getElementFlags(env, group, 0))
        print(simSetIkElementProperties(h, tip, 0), simIK.getElementConstraints(env, group, 0), simIK.getElementFlags(env, group, 0))
        print(simSetIkElementProperties(h, tip, sim_ik_x_constraint), simIK.getElementFlags(env, group, 0))
        print(select(2, pcall(simSetIkElementProperties, h, target, 1)))
        print(select(2, pcall(simSetIkGroupProperties, 7, 1, 1, 1)))
    end"
    );
    let said = said(&code);
    assert_eq!(said[..5], ["1", "1", "3\t0.5\t1", "1\t3\t0", "1\t1"]);
    assert!(said[5].contains("the group has no element with that tip"), "{said:?}");
    assert!(said[6].contains("7 is no handle of a group"), "{said:?}");
}

#[test]
fn an_environment_has_dummies_and_joints_of_its_own() {
    let code = "function sysCall_init()
        simIK = require 'simIK'
        local tip = sim.getObject('/tip')
        local joints = { sim.getObject('/turn'), sim.getObject('/shoulder'), sim.getObject('/elbow') }
        local before, scene_tip = sim.getJointPosition(joints[2]), sim.getObjectPosition(tip, -1)
        local env = simIK.createEnvironment()
        local base = simIK.createDummy(env)
        local parent, own = base, {}
        for i, joint in ipairs(joints) do
            own[i] = simIK.createJoint(env, simIK.jointtype_revolute)
            simIK.setJointMode(env, own[i], simIK.jointmode_ik)
            simIK.setJointInterval(env, own[i], sim.getJointInterval(joint))
            simIK.setJointPosition(env, own[i], sim.getJointPosition(joint))
            simIK.setObjectMatrix(env, own[i], -1, sim.getObjectMatrix(joint, -1))
            simIK.setObjectParent(env, own[i], parent, true)
            parent = own[i]
        end
        local own_tip, goal = simIK.createDummy(env, 'tip of its own'), simIK.createDummy(env)
        simIK.setObjectMatrix(env, own_tip, -1, sim.getObjectMatrix(tip, -1))
        simIK.setObjectParent(env, own_tip, parent, true)
        simIK.setLinkedDummy(env, own_tip, goal)
        local group = simIK.createIkGroup(env)
        simIK.setIkGroupCalculation(env, group, simIK.method_damped_least_squares, 0.01, 200)
        local element = simIK.addIkElement(env, group, own_tip)
        simIK.setIkElementBase(env, group, element, base)
        simIK.setIkElementConstraints(env, group, element, simIK.constraint_position)
        simIK.setObjectPose(env, goal, -1, { 0.5, 0.3, 0.4, 0, 0, 0, 1 })
        print(simIK.handleIkGroup(env, group) == simIK.result_success)
        local function error_of(pose) return math.abs(pose[1] - 0.5) + math.abs(pose[2] - 0.3) + math.abs(pose[3] - 0.4) end
        print(error_of(simIK.getObjectPose(env, own_tip, -1)) < 2e-3)
        local now = sim.getObjectPosition(tip, -1)
        print(sim.getJointPosition(joints[2]) == before, now[1] == scene_tip[1], pcall(sim.getObjectPosition, own_tip, -1))
        for i, joint in ipairs(joints) do sim.setJointPosition(joint, simIK.getJointPosition(env, own[i])) end
        print(error_of(sim.getObjectPosition(tip, -1)) < 2e-3)
        for i = 1, 3 do simIK.setJointPosition(env, own[i], 0) end
        local q = simIK.getConfigForTipPose(env, group, own, 0.65, 1000, { 1, 1, 1, 0.1 }, '')
        print(#q, simIK.getJointPosition(env, own[1]))
        for i = 1, 3 do simIK.setJointPosition(env, own[i], q[i]) end
        print(error_of(simIK.getObjectPose(env, own_tip)) < 2e-3, simIK.getObjectHandle(env, 'tip of its own') == own_tip)
        print(simIK.getObjectParent(env, own[2]) == own[1], simIK.getTargetDummy(env, own_tip) == goal)
        print(select(2, pcall(simIK.setObjectParent, env, base, own_tip)))
        simIK.eraseObject(env, own_tip)
        print(select(2, pcall(simIK.handleIkGroup, env, group)))
        simIK.eraseEnvironment(env)
        end";
    let said = said(code);
    assert_eq!(said[..2], ["true", "true"]);
    assert!(said[2].starts_with("true\ttrue\tfalse\t") && said[2].contains("there is no object"), "{said:?}");
    assert_eq!(said[3..7], ["true", "3\t0.0", "true\ttrue", "true\ttrue"], "{said:?}");
    assert!(said[7].contains("cannot hang below itself") && said[8].contains("there is no object"), "{said:?}");
}

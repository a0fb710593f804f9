//! Path planning of `simOMPL`: around a wall, with an arm, by collision pairs and by a function of the script.

use super::world::{EXPERIMENT, open, run};

const ROOM: &str = r#"
[[body]]
name = "wall"
density = 500.0
shape = [ { cuboid = { size = [0.1, 1.0, 0.4] }, position = [0.5, 0.0, 0.0] } ]
[[joint]]
name = "puck_free"
kind = "free"
[[body]]
name = "puck"
parent = "/puck_free"
density = 500.0
shape = [ { sphere = { radius = 0.05 } } ]
[[joint]]
name = "turn"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
position = [-2.0, 0.0, 0.0]
motor = { mode = "position", kp = 20.0 }
[[body]]
name = "upper"
parent = "/turn"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
shape = [ { cuboid = { size = [0.4, 0.04, 0.04] }, position = [0.2, 0.0, 0.0] } ]
[[joint]]
name = "elbow"
parent = "/turn/upper"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
position = [0.4, 0.0, 0.0]
motor = { mode = "position", kp = 20.0 }
[[body]]
name = "fore"
parent = "/turn/upper/elbow"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
shape = [ { cuboid = { size = [0.4, 0.04, 0.04] }, position = [0.2, 0.0, 0.0] } ]
[[frame]]
name = "tip"
parent = "/turn/upper/elbow/fore"
position = [0.4, 0.0, 0.0]
[[body]]
name = "post"
density = 500.0
shape = [ { sphere = { radius = 0.05 } , position = [-1.5, 0.5, 0.0] } ]
[[frame]]
name = "goal"
position = [-2.0, 0.6, 0.0]
[[frame]]
name = "start"
[[script]]
object = "/start"
file = "a.lua"
"#;

/// A task for the puck, and what the tests measure.
const PUCK: &str = "
    local puck, wall = sim.getObject('/puck'), sim.getObject('/wall')
    local function plan(kind, low, high)
        local task = simOMPL.createTask('around')
        local space = simOMPL.createStateSpace('2d', kind or simOMPL.StateSpaceType.position2d, puck,
            low or {-0.2, -1}, high or {1.2, 1}, 1)
        simOMPL.setStateSpace(task, {space})
        simOMPL.setAlgorithm(task, simOMPL.Algorithm.RRTConnect)
        return task
    end
    local function length(path, n)
        local sum = 0
        for k = n + 1, #path, n do
            sum = sum + math.sqrt((path[k] - path[k - n])^2 + (path[k + 1] - path[k - n + 1])^2)
        end
        return sum
    end
";

fn said(code: &str) -> Vec<String> {
    let experiment = EXPERIMENT
        .replace("record = [\"/hinge.position\", \"/hinge.motor_torque_now\"]", "record = [\"/turn.position\"]")
        .replace("duration = 0.05", "duration = 0.01");
    let code = format!("{PUCK}\n{code}");
    let code = format!("function sysCall_init()\n{code}\nend");
    let loaded = open(&[("scene.toml", ROOM), ("experiment.toml", &experiment), ("a.lua", &code)]);
    let run = run(&loaded.unwrap_or_else(|problems| panic!("{problems}")));
    run.messages.into_iter().map(|m| m.text).collect()
}

#[test]
fn a_path_goes_around_a_wall_and_the_scene_stays_as_it_was() {
    let code = "
        local task = plan()
        simOMPL.setCollisionPairs(task, {puck, wall})
        simOMPL.setStartState(task, {0, 0})
        simOMPL.setGoalState(task, {1, 0})
        simOMPL.setStateValidityCheckingResolution(task, 0.005)
        simOMPL.setup(task)
        local before = sim.getObjectPose(puck)
        local solved, path = simOMPL.compute(task, 4, -1, 200)
        local after = sim.getObjectPose(puck)
        for k = 1, 7 do assert(before[k] == after[k]) end
        -- the shortest way touches two corners of the wall at the radius of the puck
        local shortest = 2 * math.sqrt(0.45^2 + 0.5^2) + 0.1
        local found = length(path, 2)
        print(solved, #path >= 400, found > shortest and found < 1.2 * shortest)
        print(path[1], path[2], path[#path - 1], path[#path])
        local n = 0
        for k = 1, #path, 2 do
            simOMPL.writeState(task, {path[k], path[k + 1]})
            if sim.checkCollision(puck, wall) > 0 then n = n + 1 end
        end
        print(n, simOMPL.hasExactSolution(task), simOMPL.hasApproximateSolution(task))
        print(simOMPL.isStateValid(task, {0.5, 0.2}), simOMPL.isStateValid(task, {0.5, 0.8}), simOMPL.isStateValid(task, {3, 0}))
        simOMPL.destroyTask(task)
        print(select(2, pcall(simOMPL.getPath, task)))";
    let expected = [
        "true\ttrue\ttrue",
        "0.0\t0.0\t1.0\t0.0",
        "0\ttrue\tfalse",
        "false\ttrue\tfalse",
        "script:44: there is no planning task 1: simOMPL.createTask gives the handles (in function 'simOMPL.getPath')",
    ];
    assert_eq!(said(code), expected);
    assert_eq!(said(code), expected);
}

#[test]
fn solving_step_by_step_and_the_names_of_v_rep_give_the_same() {
    let code = "
        local task = plan(simOMPL.StateSpaceType.pose2d)
        simOMPL.setCollisionPairs(task, {puck, sim.handle_all})
        simOMPL.setStartState(task, {0, 0, 0})
        simOMPL.setGoalState(task, {1, 0, 1.5})
        print(simOMPL.solve(task, 3))
        simOMPL.simplifyPath(task)
        simOMPL.interpolatePath(task, 50)
        local path = simOMPL.getPath(task)
        print(simOMPL.getPathStateCount(task, path) >= 50, path[#path], #simOMPL.drawPath(task, path))
        local old = simExtOMPL_createTask('old')
        local space = simExtOMPL_createStateSpace('2d', sim_ompl_statespacetype_pose2d, puck, {-0.2, -1}, {1.2, 1}, 1)
        print(simExtOMPL_setStateSpace(old, {space}), simExtOMPL_setAlgorithm(old, sim_ompl_algorithm_BiTRRT))
        simExtOMPL_setCollisionPairs(old, {puck, sim_handle_all})
        simExtOMPL_setStartState(old, {0, 0, 0})
        simExtOMPL_setGoalState(old, {1, 0, 1.5})
        local result, states = simExtOMPL_compute(old, 3, -1, 50)
        local same = #states == #path
        for k = 1, #path do same = same and states[k] == path[k] end
        print(result, same)
        simExtOMPL_setGoalState(old, {0.5, 0, 0})
        print(simExtOMPL_compute(old, 1, -1, 50))
        print(simExtOMPL_isStateValid(old, {0, 0, 0}))";
    assert_eq!(said(code), ["true", "true\t1.5\t1", "1\t1", "1\ttrue", "0\tnil", "1"]);
}

#[test]
fn a_function_of_the_script_says_which_states_are_good() {
    let code = "
        local task = plan()
        local n = 0
        function isGood(state)
            n = n + 1
            sim.setObjectPosition(puck, {state[1], state[2], 0})
            return state[2] < -0.7 or math.abs(state[1] - 0.5) > 0.1
        end
        simOMPL.setStateValidationCallback(task, 'isGood')
        simOMPL.setStartState(task, {0, 0})
        simOMPL.setGoalState(task, {1, 0})
        local solved, path = simOMPL.compute(task, 4)
        local lowest = 0
        for k = 2, #path, 2 do lowest = math.min(lowest, path[k]) end
        print(solved, lowest < -0.7, n > 100, sim.getObjectPosition(puck)[1], simOMPL.isStateValid(task, {0.5, 0.2}))
        simOMPL.setStateValidationCallback(task, function(state) error('no more') end)
        print(pcall(simOMPL.solve, task, 1))";
    let found = said(code);
    assert_eq!(found[0], "true\ttrue\ttrue\t0.0\tfalse");
    assert!(found[1].starts_with("false\t") && found[1].contains("no more"), "{}", found[1]);
}

#[test]
fn an_arm_passes_a_post_to_a_pair_of_frames() {
    let code = "
        local joints = { sim.getObject('/turn'), sim.getObject('/elbow') }
        local arm = sim.createCollection(0)
        sim.addItemToCollection(arm, sim.handle_tree, joints[1], 0)
        local spaces = {}
        for k, joint in ipairs(joints) do
            spaces[k] = simOMPL.createStateSpace('j' .. k, simOMPL.StateSpaceType.joint_position, joint, {-3}, {3}, k)
        end
        local task = simOMPL.createTask('arm')
        simOMPL.setStateSpace(task, spaces)
        simOMPL.setCollisionPairs(task, {arm, sim.getObject('/post')})
        simOMPL.setStartState(task, simOMPL.readState(task))
        simOMPL.setGoal(task, sim.getObject('/tip'), sim.getObject('/goal'), 0.001, {1, 1, 1, 0})
        local solved, path = simOMPL.compute(task, 5)
        print(solved, #path % 2, sim.getJointPosition(joints[1]), sim.getJointPosition(joints[2]))
        local met = 0
        for k = 1, #path, 2 do
            simOMPL.writeState(task, {path[k], path[k + 1]})
            met = met + sim.checkCollision(arm, sim.getObject('/post'))
        end
        local tip, goal = sim.getObjectPosition(sim.getObject('/tip')), sim.getObjectPosition(sim.getObject('/goal'))
        print(met, math.abs(tip[1] - goal[1]) + math.abs(tip[2] - goal[2]) < 0.002)";
    assert_eq!(said(code), ["true\t0\t0.0\t0.0", "0\ttrue"]);
}

#[test]
fn mistakes_say_what_to_do() {
    let cases = [
        ("simOMPL.solve(plan(), 1)", "the task has no goal: call simOMPL.setGoalState or setGoal before"),
        ("simOMPL.setStartState(plan(), {1})", "a state of 1 numbers, expected 2 that are finite"),
        (
            "simOMPL.setStartState(simOMPL.createTask('t'), {1})",
            "the task has no state space: call simOMPL.setStateSpace",
        ),
        ("plan(simOMPL.StateSpaceType.dubins)", "the state space dubins is not offered: take pose2d"),
        ("plan(nil, {0, 0}, {1})", "the state space position2d needs lower and upper bounds of each position"),
        ("plan(simOMPL.StateSpaceType.joint_position, {0}, {1})", "`/puck_free/puck` is no joint"),
        ("simOMPL.setAlgorithm(plan(), 5)", "5 is no algorithm"),
        ("simOMPL.setCollisionPairs(plan(), {puck})", "1 handles of collision pairs, expected two of each pair"),
        ("simOMPL.setGoalCallback(plan(), 'f')", "simOMPL.setGoalCallback is not offered: goals are states or pairs"),
        ("simOMPL.setStateValidationCallback(plan(), 'nobody')", "there is no function `nobody` to call back"),
    ];
    for (call, expected) in cases {
        let found = said(&format!("print(select(2, pcall(function() {call} end)))"));
        assert!(found[0].contains(expected), "{call}: {found:?}");
    }
}

#[test]
fn a_search_without_end_is_work_that_a_script_pays_for() {
    // a closed room: only the limit ends the search
    let code = "
        local task = plan()
        simOMPL.setStateValidationCallback(task, function(s) return math.abs(s[1] - 0.5) > 0.1 end)
        simOMPL.setStartState(task, {0, 0})
        simOMPL.setGoalState(task, {1, 0})
        local solved, path = simOMPL.compute(task, 1)
        print(solved, #path)";
    assert_eq!(said(code), ["false\t0"]);
}

#[test]
fn paths_among_random_obstacles_in_a_turned_frame_meet_none_and_move_nothing() {
    let code = "
        local frame = sim.createDummy(0.01)
        local n_solved, n_states, n_bad, n_moved, gap = 0, 0, 0, 0, 0
        for round, kind in ipairs({ 'position2d', 'pose2d', 'pose3d' }) do
            sim.setObjectPose(frame, { 5, 6, 0, 0, 0, math.sin(round), math.cos(round) })
            local function place(h, x, y, turn)
                local inside = { x, y, 0.2, 0, 0, math.sin(turn), math.cos(turn) }
                sim.setObjectPose(h, sim.multiplyPoses(sim.getObjectPose(frame), inside))
            end
            local robot = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 0.3, 0.1, 0.1 }, 0)
            place(robot, -0.8, -0.8, 0)
            local obstacles = sim.createCollection(0)
            for _ = 1, 6 do
                local box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 0.3, 0.2, 0.3 }, 0)
                place(box, 1.2 * math.random() - 0.6, 1.2 * math.random() - 0.6, 3 * math.random())
                sim.addItemToCollection(obstacles, sim.handle_single, box, 0)
            end
            local task, low, high = simOMPL.createTask('t'), { -1, -1 }, { 1, 1 }
            if kind == 'pose3d' then low[3], high[3] = 0.1, 0.5 end
            local type = simOMPL.StateSpaceType[kind]
            simOMPL.setStateSpace(task, { simOMPL.createStateSpace('s', type, robot, low, high, 1, 1, frame) })
            simOMPL.setStateValidityCheckingResolution(task, 0.002)
            simOMPL.setCollisionPairs(task, { robot, obstacles })
            local start = simOMPL.readState(task)
            local goal = { table.unpack(start) }
            goal[1], goal[2] = 0.8, 0.8
            simOMPL.setGoalState(task, goal)
            local before = sim.getObjectPose(robot)
            local solved, path = simOMPL.compute(task, 20, 1, 60)
            if solved then n_solved = n_solved + 1 end
            for k, x in ipairs(sim.getObjectPose(robot)) do
                if x ~= before[k] then n_moved = n_moved + 1 end
            end
            for k = 1, simOMPL.getPathStateCount(task, path) do
                local state = simOMPL.getPathState(task, path, k)
                simOMPL.writeState(task, state)
                gap = math.max(gap, math.abs(simOMPL.stateDistance(task, simOMPL.readState(task), state)))
                n_states = n_states + 1
                if sim.checkCollision(robot, obstacles) > 0 then n_bad = n_bad + 1 end
            end
        end
        print(n_solved, n_states, n_bad, n_moved, gap < 1e-6)";
    assert_eq!(said(code), ["3\t180\t0\t0\ttrue"]);
}

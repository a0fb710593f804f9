//! Motions on command from scripts: `sim.moveToConfig`, `sim.moveToPose`, Ruckig's and Reflexxes's names, targets that
//! go within limits.

use sincro_motion::{Axis, Goal, Limits, Point, Profile, Synchronization, plan};
use sincro_sim::results::Status;
use sincro_sim::run::Simulated;

use super::world::{open, run};

/// Two joints in line without gravity, the first with a motor in position mode, the second in velocity mode; a free
/// ball; a point on the world.
const SCENE: &str = r#"
gravity = [0.0, 0.0, 0.0]
[[joint]]
name = "a"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
limits = { lower = -7.0, upper = 7.0 }
motor = { mode = "position", kp = 1000.0 }
[[body]]
name = "upper"
parent = "/a"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[joint]]
name = "b"
parent = "/a/upper"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
position = [0.5, 0.0, 0.0]
motor = { mode = "velocity" }
[[body]]
name = "fore"
parent = "/a/upper/b"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[joint]]
name = "loose"
kind = "free"
[[body]]
name = "ball"
parent = "/loose"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[frame]]
name = "here"
[[script]]
object = "/here"
file = "a.lua"
"#;

const EXPERIMENT: &str = r#"
title = "test"
duration = 3.0
step = 0.001
simulation_step = 0.05
error_bar = "none"
record = ["/a.position", "/a/upper/b.position", "/a.command", "/a/upper/b.command"]
"#;

fn simulated(code: &str) -> Simulated {
    let loaded = open(&[("scene.toml", SCENE), ("experiment.toml", EXPERIMENT), ("a.lua", code)]);
    run(&loaded.unwrap_or_else(|problems| panic!("{problems}")))
}

fn finished(code: &str) -> (Vec<String>, Simulated) {
    let run = simulated(code);
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    (run.messages.iter().map(|m| m.text.clone()).collect(), run)
}

fn said(code: &str) -> Vec<String> {
    finished(code).0
}

fn profile(start: Point, limits: Limits, goal: Goal) -> Profile {
    plan(&[Axis { start, limits, goal }], Synchronization::None).unwrap()[0]
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text}"))
}

#[test]
fn a_configuration_is_reached_in_the_time_of_its_profile() {
    let code = "
        sim = require 'sim'
        function sysCall_thread()
            local a, b = sim.getObject('/a'), sim.getObject('/b')
            local seen = {}
            local data = sim.moveToConfig {
                joints = { a, b }, targetPos = { 1.0, -0.5 }, maxVel = { 1, 1 }, maxAccel = 2, maxJerk = { 10, 10 },
            }
            print(sim.getSimulationTime())
            print(data.pos[1]) print(data.pos[2]) print(data.vel[1]) print(data.ruckigObj)
            print(sim.getJointPosition(b))
        end";
    let said = said(code);
    let motion = profile(Point::default(), Limits::symmetric(1.0, 2.0, 10.0), Goal::Position(1.0, 0.0));
    let steps = (motion.duration() / 0.05).ceil();
    assert!((number(&said[0]) - 0.05 * steps).abs() < 1e-12, "{said:?} {}", motion.duration());
    assert_eq!(
        said[1..],
        ["1.0", "-0.5", "0.0", "nil", "-0.5"],
        "there, exactly, and the joint in velocity mode is put there"
    );
}

#[test]
fn a_motor_is_told_the_points_of_the_profile() {
    let code = "
        function sysCall_thread()
            sim.moveToConfig { joints = { sim.getObject('/a') }, targetPos = { 1.0 }, maxVel = 1, maxAccel = 2, maxJerk = 10 }
        end";
    let (_, run) = finished(code);
    let motion = profile(Point::default(), Limits::symmetric(1.0, 2.0, 10.0), Goal::Position(1.0, 0.0));
    let told = run.table.column("/a.command").unwrap();
    for (t, told) in run.table.times().iter().zip(&told.values).skip(1) {
        // held over a step of scripts: told at its start is where it is to be at its end
        let end = ((t - 1e-9) / 0.05).floor() * 0.05 + 0.05;
        assert!((told - motion.at(end).p).abs() < 1e-12, "{t}: {told}");
    }
}

#[test]
fn callbacks_see_every_point_and_can_stop() {
    let code = "
        function sysCall_thread()
            local n = 0
            local function cb(data)
                n = n + 1
                print(data.pos[1], data.auxData.name, type(data.auxData.f))
                return n == 3
            end
            local data = sim.moveToConfig {
                pos = { 0.25 }, targetPos = { 1.0 }, maxVel = 1, maxAccel = 2, maxJerk = 10, callback = cb,
                auxData = { name = 'mine', f = print },
            }
            print(n, sim.getSimulationTime(), data.auxData.name)
            -- as before 4.7: positions, velocities, accelerations, data
            local pos, vel, accel, left = sim.moveToConfig(-1, { 0 }, nil, nil, { 1 }, { 2 }, { 10 }, { 0.001 }, nil, function(p, v, a, x)
                print(#p, #v, #a, x)
            end, 'aux', nil, 0)
            print(pos[1], vel[1], accel[1])
            local m = sim.moveToPose(-1, { 0, 0, 0, 0, 0, 0, 1 }, { 1, 1, 1, 1 }, { 2, 2, 2, 2 }, { 10, 10, 10, 10 },
                { 0.001, 0, 0, 0, 0, 0, 1 }, function(pose, v, a, x) print(#pose, #v, x) end, 'too')
            print(#m, m[4])
        end";
    let said = said(code);
    let motion =
        profile(Point { p: 0.25, ..Point::default() }, Limits::symmetric(1.0, 2.0, 10.0), Goal::Position(1.0, 0.0));
    for k in 0..3 {
        let parts: Vec<&str> = said[k].split('\t').collect();
        assert!((number(parts[0]) - motion.at(0.05 * (k as f64 + 1.0)).p).abs() < 1e-12, "{said:?}");
        assert_eq!(parts[1..], ["mine", "function"]);
    }
    assert_eq!(said[3].split('\t').collect::<Vec<_>>()[..2], ["3", "0.15"], "{said:?}");
    assert!(said[4..].contains(&"1\t1\t1\taux".to_owned()) && said.contains(&"0.001\t0.0\t0.0".to_owned()), "{said:?}");
    assert!(said.contains(&"7\t4\ttoo".to_owned()) && said.contains(&"12\t0.001".to_owned()), "{said:?}");
}

#[test]
fn an_object_goes_along_a_line_as_v_rep_had_it() {
    let code = "
        function sysCall_threadmain()
            local here, dummy = sim.getObjectHandle('here'), sim.createDummy(0.01)
            sim.setObjectPosition(dummy, -1, { 0, 0, 0.5 })
            -- 0.3 m at 0.25 m/s after 0.5 m/s²: 0.5 s to speed up, 0.5 s to slow down, 0.7 s between
            print(simMoveToPosition(dummy, here, { 0.3, 0, 0.5 }, nil, 0.25, 0.5))
            print(sim.getSimulationTime(), table.concat(sim.getObjectPosition(dummy, here), ' '))
            -- a turn alone, at once: 0.5 rad count as 0.05 m
            sim.moveToPosition(dummy, -1, nil, { 0, 0, 0.5 }, 0.1)
            print(sim.getSimulationTime(), sim.getObjectOrientation(dummy, -1)[3])
            print(pcall(sim.moveToPosition, dummy, -1, nil, nil, 0.1, 0.1, { 1, 1 }))
        end";
    let said = said(code);
    let place: Vec<f64> = said[1].split(['\t', ' ']).map(number).collect();
    assert!(said[0].starts_with('1'), "{said:?}");
    assert!((1.7..1.76).contains(&place[0]), "{said:?}");
    assert!((place[1] - 0.3).abs() < 1e-12 && place[2].abs() < 1e-12 && (place[3] - 0.5).abs() < 1e-12, "{said:?}");
    let turned: Vec<f64> = said[2].split('\t').map(number).collect();
    assert!((turned[0] - place[0] - 0.5).abs() < 0.06 && (turned[1] - 0.5).abs() < 1e-12, "{said:?}");
    assert!(said[3].contains("argument 7"), "{said:?}");
}

#[test]
fn no_limits_of_a_target_are_as_none() {
    let (_, run) = finished(
        "function sysCall_init()
            sim.setJointTargetPosition(sim.getObject('/a'), 0.5, { 0, 0, 0 })
            sim.setJointTargetVelocity(sim.getObject('/b'), 0.25, { 0, 0 })
        end",
    );
    let second = |name: &str| run.table.column(name).unwrap().values[1];
    let [a, b] = ["/a.command", "/a/upper/b.command"].map(second);
    assert_eq!((a, b), (0.5, 0.25));
}

#[test]
fn what_changes_nothing_is_taken() {
    let said = said(
        "function sysCall_init()
            local ball = sim.getObject('/ball')
            print(pcall(sim.setObjectInt32Param, ball, sim.shapeintparam_respondable, 0))
            print(pcall(sim.setBoolProperty, ball, 'respondable', false))
            print(pcall(sim.setBoolProperty, ball, 'respondable', true))
            print(pcall(sim.setLightParameters, 0, 1))
        end",
    );
    assert!(said[0].starts_with("true") && said[1].starts_with("true") && said[3].starts_with("true"), "{said:?}");
    assert!(said[2].starts_with("false") && said[2].contains("no shape to touch others with"), "{said:?}");
}

#[test]
fn a_pose_is_reached_on_a_line_or_axis_by_axis() {
    let code = "
        function sysCall_thread()
            local ball = sim.getObject('/loose/ball')
            local half = math.sqrt(0.5)
            local goal = { 0.2, -0.1, 0.3, half, 0, 0, half }
            sim.moveToPose { object = ball, targetPose = goal, maxVel = { 1, 1, 1, 2 }, maxAccel = { 2, 2, 2, 4 }, maxJerk = { 10, 10, 10, 20 } }
            local p = sim.getObjectPose(ball)
            print(p[1], p[2], p[3], sim.getSimulationTime())
            print(math.abs(p[4] - half) < 1e-15, math.abs(p[7] - half) < 1e-15)
            local straight = true
            local data = sim.moveToPose { pose = goal, targetPose = { 0, 0, 0, 0, 0, 0, 1 }, metric = { 1, 1, 1, 0.1 }, maxVel = 1, maxAccel = 2,
                maxJerk = 10, callback = function(d)
                    local s = d.pose[1] / 0.2
                    straight = straight and math.abs(d.pose[2] + 0.1 * s) < 1e-12 and math.abs(d.pose[3] - 0.3 * s) < 1e-12
                end }
            print(straight, data.pose[1], data.pose[7])
            -- nowhere to go
            local same = sim.moveToPose { pose = goal, targetPose = goal, metric = { 1, 1, 1, 0.1 } }
            print(same.dist)
        end";
    let said = said(code);
    assert!(said[0].starts_with("0.2\t-0.1\t0.3\t"), "{said:?}");
    assert_eq!(said[1], "true\ttrue");
    assert_eq!(said[2..], ["true\t0.0\t1.0", "0.0"]);
}

#[test]
fn single_steps_are_the_script_s_own() {
    let code = "
        function sysCall_init()
            n = 0
            motion = sim.moveToConfig_init { pos = { 0 }, targetPos = { 0.1 }, maxVel = 1, maxAccel = 2, maxJerk = 10, timeStep = 0.1 }
        end
        function sysCall_actuation()
            if not motion then return end
            local res, data = sim.moveToConfig_step(motion)
            n = n + 1
            if res ~= 0 then
                print(res, n, data.pos[1], data == motion)
                sim.moveToConfig_cleanup(motion)
                print(motion.ruckigObj)
                motion = nil
            end
        end";
    let motion = profile(Point::default(), Limits::symmetric(1.0, 2.0, 10.0), Goal::Position(0.1, 0.0));
    let n = (motion.duration() / 0.1).ceil();
    assert_eq!(said(code), [format!("1\t{n}\t0.1\ttrue"), "nil".to_owned()]);
}

#[test]
fn ruckig_and_reflexxes_are_one() {
    let code = "
        function sysCall_init()
            local h = sim.ruckigPos(2, 0.0001, sim.ruckig_phasesync | sim.ruckig_minvel | sim.ruckig_minaccel,
                { 0, 1, 0, 0, 0, 0 }, { 1, 1, 2, 2, 10, 10, -1, -1, -2, -2 }, { 1, 1 }, { 1, 0.5, 0, 0 })
            local g = simRMLPos(2, 0.0001, sim.rml_phase_sync_if_possible, { 0, 1, 0, 0, 0, 0 }, { 1, 1, 2, 2, 10, 10 }, { 1, 1 }, { 1, 0.5, 0, 0 })
            local res, x, left
            repeat
                res, x, left = sim.ruckigStep(h, 0.05)
                local other, y = simRMLStep(g, 0.05)
                if other ~= res or y[1] ~= x[1] or y[6] ~= x[6] then print('not one', y[1], x[1]) end
                -- on a straight line
                if math.abs((x[2] - 1) + 0.5 * x[1]) > 1e-12 then print('off', x[1], x[2]) end
            until res ~= 0
            print(res, x[1], x[2], x[3], x[5], left <= 0)
            res, x = sim.ruckigStep(h, 0.05)
            print(res, x[1])
            sim.ruckigRemove(h)
            sim.rmlRemove(g)
            local v = sim.ruckigVel(1, 0.0001, -1, { 0, 0, 0 }, { 2, 10 }, { 1 }, { 0.5 })
            repeat res, x, left = sim.ruckigStep(v, 0.05) until res == 1
            print(x[2], x[3])
            -- one that is not selected goes on as it was
            local free = sim.ruckigPos(2, 0.0001, -1, { 0, 1, 0, 2, 0, 0 }, { 1, 1, 2, 2, 10, 10 }, { 1, 0 }, { 1, 0.5, 0, 0 })
            res, x = sim.ruckigStep(free, 0.5)
            print(x[2], x[4])
        end";
    let said = said(code);
    assert_eq!(said, ["1\t1.0\t0.5\t0.0\t0.0\ttrue", "1\t1.0", "0.5\t0.0", "2.0\t2.0"]);
}

#[test]
fn v_reps_own_motions_are_there() {
    let code = "
        function sysCall_threadmain()
            local a, ball = simGetObjectHandle('a'), simGetObjectHandle('ball')
            local r, pos, vel, accel, left = simRMLMoveToJointPositions({ a }, -1, nil, nil, { 1 }, { 2 }, { 10 }, { 0.2 }, nil)
            print(r, pos[1], vel[1], accel[1])
            local r, pos, quat = simRMLMoveToPosition(ball, -1, -1, nil, nil, { 1, 1, 1, 1 }, { 2, 2, 2, 2 }, { 10, 10, 10, 10 }, { 0.1, 0, 0 }, nil, nil)
            print(r, pos[1], pos[2], #quat, quat[4], simGetObjectPosition(ball, -1)[1])
        end";
    assert_eq!(said(code), ["1\t0.2\t0.0\t0.0", "1\t0.1\t0.0\t4\t1.0\t0.1"]);
}

#[test]
fn joints_without_end_take_the_way_that_is_said() {
    let code = "
        function sysCall_threadmain()
            local b = sim.getObject('/b')
            local limits = { { 9 }, { 90 }, { 900 } }
            local function go(target, direction)
                local r, pos = sim.rmlMoveToJointPositions({ b }, -1, nil, nil, limits[1], limits[2], limits[3], { target }, nil, direction)
                print(string.format('%.3f %.3f', pos[1], sim.getJointPosition(b)))
            end
            go(3, nil) go(-3, nil) go(-3 + 0.1, { 1 }) go(-3, { -2 })
            local d = sim.moveToConfig { pos = { 3 }, targetPos = { -3 }, cyclicJoints = { true }, maxVel = 9, maxAccel = 90, maxJerk = 900 }
            print(string.format('%.3f', d.pos[1]))
        end";
    let tau = std::f64::consts::TAU;
    let near = |x: f64| format!("{x:.3}");
    let expected = [
        "3.000 3.000".to_owned(),
        format!("{} -3.000", near(tau - 3.0)),
        "-2.900 -2.900".to_owned(),
        format!("{} -3.000", near(-3.0 - tau)),
        near(tau - 3.0),
    ];
    assert_eq!(said(code), expected);
}

#[test]
fn targets_go_within_limits_and_can_be_turned_round_on_the_way() {
    let code = "
        function sysCall_init()
            a, b = sim.getObject('/a'), sim.getObject('/b')
            sim.setJointTargetPosition(a, 1.0, { 1, 2, 10 })
            sim.setJointTargetVelocity(b, 0.5, { 2, 10 })
            print(sim.getJointTargetPosition(a), sim.getJointTargetVelocity(b))
        end
        function sysCall_actuation()
            if math.abs(sim.getSimulationTime() - 0.5) < 1e-9 then sim.setJointTargetPosition(a, -0.5, { 1, 2, 10 }) end
            if math.abs(sim.getSimulationTime() - 2.5) < 1e-9 then sim.setJointTargetVelocity(b, -0.25) end
        end";
    let (said, run) = finished(code);
    assert_eq!(said, ["1.0\t0.5"], "the target is told, not what the motor is");
    let limits = Limits::symmetric(1.0, 2.0, 10.0);
    let first = profile(Point::default(), limits, Goal::Position(1.0, 0.0));
    let turned = profile(first.at(0.5), limits, Goal::Position(-0.5, 0.0));
    let velocity = profile(Point::default(), Limits::symmetric(1.0, 2.0, 10.0), Goal::Velocity(0.5));
    let (a, b) = (run.table.column("/a.command").unwrap(), run.table.column("/a/upper/b.command").unwrap());
    for ((t, a), b) in run.table.times().iter().zip(&a.values).zip(&b.values).skip(1) {
        let target = if *t < 0.5 + 1e-9 { first.at(*t).p } else { turned.at(t - 0.5).p };
        assert!((a - target).abs() < 1e-9, "{t}: {a} {target}");
        let speed = if *t < 2.5 + 1e-9 { velocity.at(*t).v } else { -0.25 };
        assert!((b - speed).abs() < 1e-9, "{t}: {b} {speed}");
    }
}

#[test]
fn what_cannot_be_done_is_refused_in_words() {
    let cases = [
        ("sim.moveToConfig {}", "sim.moveToConfig waits for the simulation: call it in a thread (sysCall_thread)"),
        ("sim.moveToConfig_init {}", "either `joints` or `pos` is needed"),
        ("sim.moveToConfig_init { joints = {}, targetPos = {} }", "nothing is to be moved"),
        ("sim.moveToConfig_init { pos = { 0 } }", "`targetPos` is missing, expected a list of one number"),
        (
            "sim.moveToConfig_init { pos = { 0 }, targetPos = { 1, 2 } }",
            "`targetPos` is a list of 2, expected a list of one number",
        ),
        (
            "sim.moveToConfig_init { pos = { 0 }, targetPos = { 0 / 0 } }",
            "degree of freedom 1: its target position is NaN",
        ),
        (
            "sim.moveToConfig_init { pos = { 0 }, targetPos = { 1 }, maxVel = -1 }",
            "degree of freedom 1: its largest velocity is -1, expected a number above 0",
        ),
        (
            "sim.moveToConfig_init { pos = { 0 }, targetPos = { 1 }, maxVel = 'fast' }",
            "`maxVel` is text, expected a number, or a list of",
        ),
        ("sim.moveToConfig_init { pos = { 0 }, targetPos = { 1 }, timeStep = -1 }", "`timeStep` is -1 s"),
        (
            "sim.moveToConfig_init { joints = { sim.getObject('/ball') }, targetPos = { 1 } }",
            "`/loose/ball` is no joint",
        ),
        ("sim.moveToConfig_init { joints = { 99 }, targetPos = { 1 } }", "there is no object with the handle 99"),
        ("sim.moveToConfig_step { ruckigObj = 5 }", "there is no motion with the handle 5"),
        ("sim.moveToPose_init { targetPose = { 0, 0, 0, 0, 0, 0, 1 } }", "one of `object`, `pose` and `ik` is needed"),
        (
            "sim.moveToPose_init { object = sim.getObject('/ball') }",
            "`targetPose` is missing, expected a list of 7 numbers",
        ),
        (
            "sim.moveToPose_init { object = sim.getObject('/ball'), targetPose = { 0, 0, 0, 0, 0, 0, 0 } }",
            "`targetPose` has a quaternion without direction",
        ),
        (
            "sim.ruckigPos(0, 0.0001, -1, {}, {}, {}, {})",
            "argument 1 is no number of degrees of freedom, expected 1 to 100",
        ),
        (
            "sim.ruckigPos(1, 0.0001, -1, { 0, 0 }, { 1, 1, 1 }, { 1 }, { 1, 0 })",
            "argument 4 has 2 numbers, expected 3: positions",
        ),
        (
            "sim.ruckigPos(1, 0.0001, sim.ruckig_minvel, { 0, 0, 0 }, { 1, 1, 1 }, { 1 }, { 1, 0 })",
            "argument 5 has 3 numbers, expected 4: largest velocities, accelerations and jerks, lowest velocities",
        ),
        ("sim.ruckigPos(1, 0.0001, -1, { 0, 0, 0 }, { 1, 1, 0 }, { 1 }, { 1, 0 })", "its largest jerk is 0, expected"),
        (
            "sim.ruckigPos(1, 0.0001, -1, { 0, 0, 0 }, { 1, 1, 1 }, { 1 }, { 1, 5 })",
            "its target velocity 5 is not within its limits",
        ),
        (
            "sim.ruckigStep(sim.ruckigPos(1, 0.0001, -1, { 0, 0, 0 }, { 1, 1, 1 }, { 1 }, { 1, 0 }), 0)",
            "the cycle time is 0 s",
        ),
        ("sim.ruckigRemove(0)", "there is no motion with the handle 0"),
        (
            "for k = 1, 1001 do sim.ruckigPos(1, 0.0001, -1, { 0, 0, 0 }, { 1, 1, 1 }, { 1 }, { 1, 0 }) end",
            "there are 1000 motions already",
        ),
        (
            "sim.setJointTargetPosition(sim.getObject('/a'), 1, { 1, 2 })",
            "argument 3 has 2 numbers, expected 3: largest velocity",
        ),
        (
            "sim.setJointTargetPosition(sim.getObject('/a'), 1, { 1, -2, 3 })",
            "its largest acceleration is -2, expected",
        ),
        (
            "sim.setJointTargetVelocity(sim.getObject('/b'), 0 / 0, { 1, 2 })",
            "its target velocity is NaN, expected a finite number",
        ),
        ("sim.followPath()", "waits for the simulation"),
        ("sim.generateTimeOptimalTrajectory()", "paths are not timed here"),
    ];
    for (text, expected) in cases {
        let run = simulated(&format!("function sysCall_actuation()\n{text}\nend"));
        let Status::Stopped { reason, .. } = &run.status else { panic!("{text}: {:?}", run.status) };
        assert!(reason.contains(expected), "{text}: {reason}");
    }
}

//! Structure that a script changes: the same bits as by a client, and by a run that goes on from a snapshot.

use sincro_coppelia::api::{Search, Value};
use sincro_sim::Extensions;
use sincro_sim::prelude::*;
use sincro_testing::scenes::box_above_floor;
use sincro_testing::{OpenSession, SceneFolder};

use super::world::{open, run, said};

const EXPERIMENT: &str = r#"
title = "Structure"
duration = 0.5
step = 0.005
record = ["/box_joint/box.position.z"]
error_bar = "none"
"#;

/// Copies the box at 0.1 s, hangs the copy on the box at 0.2 s, parts them at 0.3 s.
const SPAWNER: &str = "
local function is(t) return math.abs(sim.getSimulationTime() - t) < 1e-9 end
function sysCall_init() box = sim.getObject('/box') end
function sysCall_actuation()
    if is(0.1) then
        copy = sim.copyPasteObjects({ box }, 0)[1]
        sim.setObjectPosition(copy, -1, { 0.3, 0, 0.2 })
        sim.setObjectAlias(copy, 'second')
    end
    if is(0.2) then sim.setObjectParent(sim.getObject('/second'), box, true) end
    if is(0.3) then sim.setObjectParent(sim.getObject('/second'), -1, true) end
end";

fn scripted() -> Loaded {
    let scene = format!("{}\n[[script]]\nobject = \"/floor\"\nfile = \"a.lua\"\n", box_above_floor(0.1));
    open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", SPAWNER)]).unwrap()
}

#[test]
fn a_script_and_a_client_that_change_the_structure_give_the_same_trace() {
    let of_script = run(&scripted());
    assert_eq!(of_script.status, Status::Completed);
    let mut session =
        OpenSession::open(SceneFolder::of(&box_above_floor(0.1), EXPERIMENT), &[], Extensions::default(), None);
    session.start().unwrap();
    let find = |session: &mut OpenSession, path: &str| -> Value {
        i64::from(session.registry().find(path, Search::default()).unwrap().0).into()
    };
    let body = find(&mut session, "/box");
    for tick in 0..100 {
        match tick {
            20 => {
                let list = Value::List(vec![body.clone()]);
                let copies = session.call("sim.copyPasteObjects", &[list, Value::Int(0)]).unwrap().remove(0);
                let Value::List(copies) = copies else { panic!("{copies:?}") };
                let place = Value::reals([0.3, 0.0, 0.2]);
                session.call("sim.setObjectPosition", &[copies[0].clone(), Value::Int(-1), place]).unwrap();
                session.call("sim.setObjectAlias", &[copies[0].clone(), Value::from("second")]).unwrap();
            }
            40 | 60 => {
                let parent = if tick == 40 { body.clone() } else { Value::Int(-1) };
                let second = find(&mut session, "/second");
                session.call("sim.setObjectParent", &[second, parent, Value::Bool(true)]).unwrap();
            }
            _ => {}
        }
        session.step().unwrap();
    }
    session.stop().unwrap();
    let of_client = session.take_finished().remove(0).simulated;
    assert_eq!(of_client.trace, of_script.trace);
    assert_eq!(of_client.changes, of_script.changes);
    assert_eq!(run(&scripted()).trace, of_script.trace, "and each time");
}

#[test]
fn models_are_found_by_whole_paths_in_the_folder_of_the_scene() {
    let code = "function sysCall_init()
            local folder = sim.getStringParameter(sim.stringparam_scene_path)
            local own = sim.loadModel(folder .. '/part.toml')
            print(sim.getObjectName(own), pcall(sim.loadModel, folder .. 'x/none.toml'))
        end";
    let scene = format!("{}\n[[script]]\nobject = \"/floor\"\nfile = \"a.lua\"\n", box_above_floor(0.1));
    let part = "[[body]]\nname = \"peg\"\ndensity = 500.0\nshape = [{ sphere = { radius = 0.1 } }]\n";
    let folder = SceneFolder::of(&scene, EXPERIMENT).with("a.lua", code).with("part.toml", part);
    let done = run(&load(&folder, &[], sincro_testing::with_scripts()).unwrap());
    assert_eq!(done.status, Status::Completed, "{:?}", done.messages);
    assert!(done.messages[0].text.starts_with("part\tfalse"), "{:?}", done.messages);
}

#[test]
fn what_a_script_removes_as_it_ends_leaves_a_report() {
    // the worst penetration is that of a pair which the last model lacks
    let code = "function sysCall_init()
            for k = 1, 3 do
                own = sim.createPureShape(0, 8, { 0.1, 0.1, 0.1 }, 1, nil)
                sim.setObjectPosition(own, -1, { k, 1, 0.05 })
            end
        end
        function sysCall_cleanup() for k = 0, 2 do sim.removeObject(own - k) end end";
    let scene = format!("{}\n[[script]]\nobject = \"/floor\"\nfile = \"a.lua\"\n", box_above_floor(0.1));
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap();
    let done = run(&loaded);
    assert_eq!(done.status, Status::Completed);
    let touching = done.laws.iter().find(|law| law.law == "penetration").unwrap();
    assert!(touching.element.contains(" on "), "{}", touching.element);
}

#[test]
fn a_run_with_scripts_goes_on_from_a_snapshot_after_a_change() {
    let loaded = scripted();
    let lockstep = || {
        let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
        lockstep.start().unwrap();
        lockstep
    };
    for tick in [30, 45, 70] {
        let (mut whole, mut other) = (lockstep(), lockstep());
        let mut trace = whole.trace();
        while whole.tick() < tick {
            whole.advance().unwrap();
            whole.hash_into(&mut trace);
        }
        let bytes = whole.snapshot(trace).to_bytes(&loaded);
        let read = Snapshot::from_bytes(&bytes, &loaded).unwrap();
        other.restore(&read);
        let mut others = read.trace;
        while whole.tick() < 100 {
            whole.advance().unwrap();
            other.advance().unwrap();
            whole.hash_into(&mut trace);
            other.hash_into(&mut others);
            assert_eq!(whole.state(), other.state(), "tick {} after {tick}", whole.tick());
        }
        assert_eq!(trace, others, "from tick {tick}");
    }
}

/// Scene with a box that its own script holds up by the parameter `lift`, in newtons, and a script on the floor.
fn lifted(of_floor: &str) -> Loaded {
    let scene = format!(
        "{}
[[script]]
object = \"/box_joint/box\"
file = \"lift.lua\"
parameters = {{ lift = 0.0 }}
[[script]]
object = \"/floor\"
file = \"floor.lua\"
",
        box_above_floor(0.1)
    );
    let lift = "
function sysCall_init()
    own = sim.getObject('.')
    name = sim.getObjectAlias(own)
    print('begins')
end
function sysCall_actuation()
    local lift = sim.getScriptSimulationParameter(sim.handle_self, 'lift')
    sim.addForceAndTorque(own, { 0, 0, lift }, { 0, 0, 0 })
    if sim.getInt32Signal('leave') == own then sim.removeObjects({ own }) end
end
function sysCall_sensing() sim.setFloatSignal(name, sim.getObjectPosition(own, -1)[3]) end
function sysCall_cleanup() print('ends at ' .. string.format('%.3f', sim.getSimulationTime())) end
function height() return sim.getObjectPosition(own, -1)[3] end
";
    open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("lift.lua", lift), ("floor.lua", of_floor)])
        .unwrap_or_else(|problems| panic!("{problems}"))
}

fn texts(run: &Simulated, object: &str) -> Vec<(f64, String)> {
    run.messages.iter().filter(|m| m.object == object).map(|m| (m.t, m.text.clone())).collect()
}

#[test]
fn a_copy_runs_a_script_of_its_own_until_it_is_removed() {
    let floor = "
local function is(t) return math.abs(sim.getSimulationTime() - t) < 1e-9 end
function sysCall_init()
    box = sim.getObject('/box')
    mass = sim.getShapeMass(box)
end
function sysCall_actuation()
    if is(0.1) then
        sim.setScriptSimulationParameter(sim.getScript(sim.scripttype_childscript, box), 'lift', 2 * 9.81 * mass)
        copy = sim.copyPasteObjects({ box }, 0)[1]
        sim.setObjectPosition(copy, -1, { 0.3, 0, 0.2 })
        sim.setScriptSimulationParameter(sim.getScript(sim.scripttype_childscript, box), 'lift', 0)
    end
    if is(0.3) then
        local script = sim.getScript(sim.scripttype_childscript, copy)
        print(string.format('%.3f', sim.callScriptFunction('height', script)))
        sim.removeObjects({ copy })
        print(sim.getScript(sim.scripttype_childscript, copy))
    end
end";
    let run = run(&lifted(floor));
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    let begins = |t: f64| (t, "begins".to_owned());
    let original = texts(&run, "/box_joint/box");
    assert_eq!(original, [begins(0.0), (0.5, "ends at 0.500".to_owned())]);
    let copy = run.messages.iter().find(|m| m.text == "begins" && m.t > 0.0).expect("the copy's script begins");
    let copy = texts(&run, &copy.object.clone());
    assert_eq!(copy.len(), 2, "{copy:?}");
    assert!(copy[0].0 >= 0.1 && copy[0].0 < 0.106, "{copy:?}");
    assert!(copy[1].1 == "ends at 0.300" && copy[1].0 < 0.306, "{copy:?}");
    // it was given twice its weight: 0.2 m + g t²/2 after 0.195 s, since its script acts from the next step on
    let floor: Vec<String> = texts(&run, "/floor").into_iter().map(|(_, text)| text).collect();
    let height: f64 = floor[0].parse().unwrap();
    let fell = 0.005;
    let (v, s) = (-9.81 * fell, 0.2 - 0.5 * 9.81 * fell * fell);
    let t: f64 = 0.2 - fell;
    assert!((height - (s + v * t + 0.5 * 9.81 * t * t)).abs() < 2e-3, "{height}");
    assert_eq!(floor[1], "-1", "{floor:?}");
}

#[test]
fn a_script_may_remove_its_own_object() {
    let floor = "
function sysCall_actuation()
    if math.abs(sim.getSimulationTime() - 0.2) < 1e-9 then sim.setInt32Signal('leave', sim.getObject('/box')) end
end";
    let run = run(&lifted(floor));
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    let own = texts(&run, "/box_joint/box");
    assert_eq!(own.len(), 2, "{own:?}");
    assert!(own[1].0 < 0.21, "{own:?}");
}

/// Model with a script that turns its wheel, and a client that loads it into a scene without scripts.
#[test]
fn the_scripts_of_a_loaded_model_run() {
    let folder = SceneFolder::of(&box_above_floor(0.1), EXPERIMENT);
    let model = r#"
[[joint]]
name = "axle"
kind = "revolute"
position = [0.0, 0.0, 1.0]
axis = [0.0, 0.0, 1.0]
motor = { mode = "velocity" }
[[body]]
name = "wheel"
parent = "/axle"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[script]]
object = "/axle/wheel"
file = "turn.lua"
parameters = { speed = 2.5 }
"#;
    let turn = "
function sysCall_actuation()
    local axle = sim.getObjectParent(sim.getObject('.'))
    sim.setJointTargetVelocity(axle, sim.getScriptSimulationParameter(sim.handle_self, 'speed'))
end";
    std::fs::create_dir(folder.join("turner")).unwrap();
    std::fs::write(folder.join("turner/scene.toml"), model).unwrap();
    std::fs::write(folder.join("turner/turn.lua"), turn).unwrap();
    let mut session = OpenSession::open(folder, &[], sincro_testing::with_scripts(), None);
    session.start().unwrap();
    session.step().unwrap();
    let mut axles = Vec::new();
    for _ in 0..2 {
        let base = session.call("sim.loadModel", &[Value::from("turner")]).unwrap().remove(0);
        let Value::Int(base) = base else { panic!("{base:?}") };
        let tree = session.registry().tree(sincro_coppelia::api::Handle(base as i32));
        axles.push(Value::Int(i64::from(tree[1].0)));
    }
    (0..20).for_each(|_| session.step().unwrap());
    for axle in axles {
        let angle = session.call("sim.getJointPosition", &[axle]).unwrap().remove(0);
        let Value::Real(angle) = angle else { panic!("{angle:?}") };
        assert!((angle - 2.5 * 20.0 * 0.005).abs() < 1e-9, "{angle}");
    }
}

#[test]
fn a_copy_of_a_body_does_not_run_the_script_of_the_joint_that_carries_it() {
    let scene = format!("{}\n[[script]]\nobject = \"/box_joint\"\nfile = \"a.lua\"\n", box_above_floor(0.1));
    let script = "
function sysCall_init() print('begins') end
function sysCall_actuation()
    if math.abs(sim.getSimulationTime() - 0.1) < 1e-9 then sim.copyPasteObjects({ sim.getObject('/box') }, 0) end
end";
    let run = run(&open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", script)]).unwrap());
    assert_eq!(run.status, Status::Completed);
    assert_eq!(run.messages.len(), 1, "{:?}", run.messages);
    assert!(run.changes.iter().any(|c| c.quantity == "added"));
}

/// Messages of a run of the box above the floor, with a script on the floor.
fn said_on_floor(code: &str) -> Vec<String> {
    let scene = format!("{}\n[[script]]\nobject = \"/floor\"\nfile = \"a.lua\"\n", box_above_floor(0.5));
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap();
    let run = run(&loaded);
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run.messages.into_iter().map(|message| message.text).collect()
}

#[test]
fn a_script_that_is_added_runs_from_the_next_phase_on() {
    let said = said_on_floor(
        "function sysCall_init() n = 0 end
        function sysCall_actuation()
            n = n + 1
            if n == 2 then
                script = sim.addScript(sim.scripttype_childscript)
                sim.associateScriptWithObject(script, sim.getObject('/box'))
                sim.setScriptText(script, [[
                    function sysCall_init() print('begins', sim.getObjectAlias(sim.getObject('.'))) calls = 0 end
                    function sysCall_actuation() calls = calls + 1 end
                    function sysCall_cleanup() print('ends', calls) end
                    function count(more) return calls + more end]])
                print(sim.getScriptName(script), pcall(sim.callScriptFunction, 'count', script, 1))
            end
            if n == 5 then print('counts', sim.callScriptFunction('count', script, 100)) end
            if n == 6 then sim.initScript(script) end
            if n == 8 then print('again', sim.callScriptFunction('count', script, 100)) end
            if n == 9 then sim.removeScript(script) print(pcall(sim.callScriptFunction, 'count', script, 1)) end
        end",
    );
    assert!(said[0].starts_with("box\tfalse\t") && said[0].contains("there is no script"), "{said:?}");
    assert_eq!(said[1..6], ["begins\tbox", "counts\t102", "ends\t4", "begins\tbox", "again\t101"]);
    assert!(said[6].starts_with("false\t") && said[7] == "ends\t3", "{said:?}");
}

#[test]
fn the_text_of_a_script_of_the_scene_can_be_changed() {
    let said = said_on_floor(
        "function sysCall_init() n = 0 end
        function sysCall_sensing()
            n = n + 1
            if n == 3 then
                print(pcall(sim.setScriptText, sim.handle_self, 'function ('))
                sim.setScriptText(sim.handle_self, 'function sysCall_init() print(\"new\", n) end')
            end
        end
        function sysCall_cleanup() print('old ends', n) end",
    );
    assert!(said[0].starts_with("false\t"), "{said:?}");
    assert_eq!(said[1..], ["old ends\t3", "new\tnil"]);
}

#[test]
fn a_script_may_be_put_on_an_object_that_was_made() {
    let said = said_on_floor(
        "function sysCall_init()
            local point = sim.createDummy(0.01)
            local script = sim.createScript(sim.scripttype_childscript, \"function sysCall_cleanup() print('ends') end\")
            sim.setObjectParent(script, point)
            sim.initScript(script)
            local kept = sim.copyPasteObjects({ sim.getObject('/box') }, 0)
        end",
    );
    assert_eq!(said, ["ends"]);
}

/// A text that says where it begins, and that it ends.
const TELLS: &str = "
    function sysCall_init() print('begins', sim.getObjectAlias(sim.getObject('.'))) end
    function sysCall_cleanup() print('ends') end";

#[test]
fn an_added_script_is_on_one_object_at_a_time() {
    let said = said_on_floor(&format!(
        "function sysCall_init()
            n, box, point = 0, sim.getObject('/box'), sim.createDummy(0.01)
            sim.setObjectAlias(point, 'point')
            script = sim.createScript(sim.scripttype_childscript, [[{TELLS}]])
        end
        function sysCall_actuation()
            n = n + 1
            if n == 2 then sim.associateScriptWithObject(script, box) end
            if n == 4 then sim.associateScriptWithObject(script, point) end
            if n == 6 then sim.associateScriptWithObject(script, -1) end
            if n == 8 then print('off') sim.associateScriptWithObject(script, box) end
            if n == 10 then sim.removeObjects({{ box }}) end
            if n == 12 then print('without box') end
        end"
    ));
    let wanted = ["begins\tbox", "ends", "begins\tpoint", "ends", "off", "begins\tbox", "ends", "without box"];
    assert_eq!(said, wanted);
}

#[test]
fn a_script_of_the_scene_is_moved_and_taken_off() {
    let said = said_on_floor(&format!(
        "{TELLS}
        function sysCall_actuation()
            n = (n or 0) + 1
            local floor, box = sim.getObject('/floor'), sim.getObject('/box')
            local is_first = sim.getObject('.') == floor
            if n == 2 and is_first then print(sim.associateScriptWithObject(sim.handle_self, box)) end
            if n == 2 and not is_first then print(sim.associateScriptWithObject(sim.handle_self, -1)) end
        end"
    ));
    assert_eq!(said, ["begins\tfloor", "1", "ends", "begins\tbox", "1", "ends"]);
}

#[test]
fn a_script_of_the_scene_that_was_taken_off_can_be_put_back() {
    let said = said_on_floor(&format!(
        "{TELLS}
        local box = sim.getObject('/box')
        if not sim.getInt32Signal('made') then
            sim.setInt32Signal('made', 1)
            sim.associateScriptWithObject(sim.createScript(sim.scripttype_childscript, [[
                function sysCall_init() n, floor = 0, sim.getObject('/floor') end
                function sysCall_actuation()
                    n = n + 1
                    if n == 2 then sim.associateScriptWithObject(floor, -1) end
                    if n == 4 then print('off') sim.associateScriptWithObject(floor, floor) end
                end]]), box)
        end"
    ));
    assert_eq!(said, ["begins\tfloor", "ends", "off", "begins\tfloor", "ends"]);
}

#[test]
fn an_added_script_is_named_by_its_object() {
    let said = said_on_floor(&format!(
        "function sysCall_init()
            n, box, point = 0, sim.getObject('/box'), sim.createDummy(0.01)
            sim.setObjectAlias(point, 'point')
            sim.associateScriptWithObject(sim.createScript(sim.scripttype_childscript, [[{TELLS}]]), box)
        end
        function sysCall_actuation()
            n = n + 1
            if n == 2 then sim.initScript(box) end
            if n == 4 then sim.removeScript(box) end
            if n == 6 then print(pcall(sim.initScript, box)) end
        end"
    ));
    assert_eq!(said[..4], ["begins\tbox", "ends", "begins\tbox", "ends"]);
    assert!(said[4].contains("there is no script") && said.len() == 5, "{said:?}");
}

#[test]
fn an_object_has_one_added_script_of_a_kind() {
    let said = said_on_floor(
        "function sysCall_init()
            local box = sim.getObject('/box')
            local a, b = sim.addScript(sim.scripttype_childscript), sim.addScript(sim.scripttype_childscript)
            sim.associateScriptWithObject(b, box)
            print(pcall(sim.associateScriptWithObject, a, box))
            sim.removeScript(b)
            sim.associateScriptWithObject(a, box)
            sim.setScriptText(a, \"function sysCall_init() print('a runs') end\")
            sim.associateScriptWithObject(sim.addScript(sim.scripttype_customizationscript), box)
        end",
    );
    assert!(said[0].contains("false") && said[0].contains("has a script of that kind already"), "{said:?}");
    assert_eq!(said[1..], ["a runs"]);
}

#[test]
fn texts_that_are_refused_use_up_no_scripts() {
    let said = said_on_floor(
        "function sysCall_init()
            for _ = 1, 1001 do pcall(sim.createScript, sim.scripttype_childscript, 'function (') end
            print(pcall(sim.createScript, sim.scripttype_childscript, 'x = 1'))
        end",
    );
    assert!(said.len() == 1 && said[0].starts_with("true\t"), "{said:?}");
}

#[test]
fn what_is_hung_beside_an_object_of_its_name_gets_a_number() {
    let code = "function sysCall_sensing()
            if done then return end
            done = true
            local bodies = {}
            for k = 1, 3 do
                bodies[k] = sim.createPureShape(0, 8, { 0.1, 0.1, 0.1 }, 1, nil)
                sim.setObjectPosition(bodies[k], -1, { k, 5, 1 })
                local lid = sim.createPureShape(0, 8, { 0.05, 0.05, 0.05 }, 1, nil)
                sim.setObjectPosition(lid, -1, { k, 5, 1.1 })
                sim.setObjectParent(lid, bodies[k], true)
            end
            local all = sim.groupShapes(bodies)
            local names = {}
            for k = 0, 2 do names[k + 1] = sim.getObjectName(sim.getObjectChild(all, k)) end
            print(#names, names[1] ~= names[2], names[2] ~= names[3])
            print(sim.loadModel and sim.setShapeColor(all, nil, sim.colorcomponent_transparency, { 0.2 }))
        end";
    assert_eq!(said(code), ["3\ttrue\ttrue", "1"]);
}

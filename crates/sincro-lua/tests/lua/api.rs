//! The functions of `sim` that only scripts have, names of all of them.

use super::world::{EXPERIMENT, PENDULUM, open, run, said, with_script};

#[test]
fn every_function_has_its_old_name() {
    let code = "function sysCall_init()
        local n = 0
        for name, f in pairs(sim) do
            if type(f) == 'function' then
                local old = 'sim' .. name:sub(1, 1):upper() .. name:sub(2)
                assert(_G[old] == f, old)
                n = n + 1
            else
                assert(_G['sim_' .. name] == f, name)
            end
        end
        print(n > 150, simJointGetForce == sim.getJointForce, simGetIntegerSignal == sim.getInt32Signal)
    end";
    assert_eq!(said(code), ["true\ttrue\ttrue"]);
}

#[test]
fn parameters_are_texts_that_read_as_values() {
    let code = "function sysCall_init()
        local get = function(name, text) return sim.getScriptSimulationParameter(sim.handle_self, name, text) end
        print(get('gain'), get('count'), get('on'), get('name'), get('nothing'), get('none'), get('gain', true))
        simSetScriptSimulationParameter(sim_handle_self, 'gain', 3.5)
        print(get('gain'), simGetObjectAssociatedWithScript(sim_handle_self) == sim.getObject('.'))
    end";
    let loaded =
        with_script(code, "parameters = { gain = 0.1, count = 4, on = true, name = \"x y\", nothing = \"nil\" }")
            .unwrap();
    let said: Vec<String> = run(&loaded).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said, ["0.1\t4\ttrue\tx y\tnil\tnil\t0.1", "3.5\ttrue"]);
}

#[test]
fn a_variable_of_a_thread_that_is_set_before_it_starts_is_not_lost() {
    let arm = "given = -1
        function sysCall_threadmain() print(given) end";
    let hinge = "function sysCall_init()
            sim.setScriptVariable('given', sim.getScriptHandle('arm'), 7)
        end";
    let scene = format!(
        "{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"arm.lua\"\nthreaded = true\n[[script]]\nobject = \"/hinge\"\nfile = \"hinge.lua\"\n"
    );
    let loaded =
        open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("arm.lua", arm), ("hinge.lua", hinge)]);
    let said: Vec<String> = run(&loaded.unwrap()).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said, ["7"]);
}

#[test]
fn scripts_share_signals_and_call_each_other() {
    let arm = "function twice(x, list) return 2 * x, list[2] end
        limits = {}
        function both() return given, limits.low end
        function sysCall_init() sim.setFloatSignal('from arm', 1.5) end";
    let hinge = "function sysCall_init()
            print(sim.getFloatSignal('from arm'), sim.getInt32Signal('nothing'))
        end
        function sysCall_actuation()
            local script = sim.getScript(sim.scripttype_childscript, sim.getObject('/hinge/arm'))
            print(sim.callScriptFunction('twice', script, 4, { 5, 6 }))
            print(simCallScriptFunction('twice@arm', sim_scripttype_childscript, 0.5, { 5, 6 }))
            print(select(2, pcall(sim.callScriptFunction, 'thrice', script)))
            print(sim.setScriptVariable('given', script, { 7, 8 }))
            simSetScriptVariable('limits.low@arm', sim_scripttype_childscript, -1.5)
            local given, low = sim.callScriptFunction('both', script)
            print(given[2], low)
            print(select(2, pcall(sim.setScriptVariable, 'given', 12345, 1)))
        end";
    let scene = format!(
        "{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"arm.lua\"\n[[script]]\nobject = \"/hinge\"\nfile = \"hinge.lua\"\n"
    );
    let experiment = EXPERIMENT.replace("0.05", "0.01");
    let loaded =
        open(&[("scene.toml", &scene), ("experiment.toml", &experiment), ("arm.lua", arm), ("hinge.lua", hinge)]);
    let said: Vec<String> = run(&loaded.unwrap()).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said[..3], ["1.5", "8\t6", "1.0\t6"]);
    assert!(said[3].contains("the script of `/hinge/arm` has no function `thrice`"), "{said:?}");
    assert_eq!(said[4..6], ["0", "8\t-1.5"]);
    assert!(said[6].contains("there is no script 12345"), "{said:?}");
}

#[test]
fn a_name_without_suffix_takes_that_of_the_scripts_own_object() {
    let joint = |k: usize| {
        format!(
            "[[frame]]\nname = \"mount{k}\"\n[[joint]]\nname = \"motor\"\nkind = \"revolute\"\nparent = \"/mount{k}\"\nmotor = {{ mode = \"velocity\" }}\n\
             [[body]]\nname = \"wheel\"\nparent = \"/mount{k}/motor\"\nmass = 1.0\ninertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n\
             [[script]]\nobject = \"/mount{k}/motor/wheel\"\ncode = \"print(simGetObjectHandle('motor') == sim.getObject('..'), simGetObjectHandle('motor#') == sim.getObject('/mount1/motor'))\"\nstyle = \"new\"\n"
        )
    };
    let scene: String = (1..=3).map(joint).collect();
    let experiment =
        EXPERIMENT.replace("\"/hinge.position\", \"/hinge.motor_torque_now\"", "\"/mount1/motor.position\"");
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", &experiment)]).unwrap_or_else(|p| panic!("{p}"));
    let said: Vec<String> = run(&loaded).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said, ["true\ttrue"; 3]);
}

#[test]
fn matrices_and_buffers_are_as_in_vrep() {
    let code = "function sysCall_init()
        local m = sim.buildMatrix({ 1, 2, 3 }, { 0, 0, math.pi / 2 })
        local p = sim.multiplyVector(m, { 1, 0, 0 })
        print(string.format('%.3f %.3f %.3f', p[1], p[2], p[3]))
        simInvertMatrix(m)
        p = sim.multiplyVector(m, p)
        print(string.format('%.3f %.3f %.3f', p[1], p[2], p[3]))
        print(unpack(sim.unpackFloatTable(sim.packFloatTable({ 0.5, 2, -1 }))))
        print(#simPackInts({ 1, 2, 3 }), unpack(simUnpackInts(simPackInts({ 7, 8, 9 }), 1, 1)))
        local t = sim.unpackTable(sim.packTable({ a = 1, b = { 2.5, 'x', true }, c = { d = -3 } }))
        print(t.a, t.b[1], t.b[2], t.b[3], t.c.d)
        print(#sim.getObjectMatrix(sim.getObject('/hinge/arm/tip'), -1), sim.getObjectPosition(sim.getObject('./tip'), sim.getObject('.'))[3])
    end";
    assert_eq!(
        said(code),
        ["1.000 3.000 3.000", "1.000 0.000 0.000", "0.5\t2.0\t-1.0", "12\t8", "1\t2.5\tx\ttrue\t-3", "12\t-1.0"]
    );
}

#[test]
fn rotations_go_about_their_axis() {
    let code = "function sysCall_init()
        local a, b = sim.buildMatrix({ 0, 0, 0 }, { 0, 0, 0.2 }), sim.buildMatrix({ 2, 0, 4 }, { 0, 0, 1.2 })
        local axis, angle = sim.getRotationAxis(a, b)
        print(string.format('%.6f %.6f', axis[3], angle))
        local half = sim.interpolateMatrices(a, b, 0.5)
        print(string.format('%.6f %.6f %.6f', half[4], half[12], sim.getEulerAnglesFromMatrix(half)[3]))
        local turned = sim.rotateAroundAxis(a, { 0, 0, 2 }, { 1, 0, 0 }, math.pi / 2)
        print(string.format('%.6f %.6f %.6f', turned[4], turned[8], sim.getEulerAnglesFromMatrix(turned)[3]))
        print(#sim.rotateAroundAxis(sim.matrixToPose(a), { 1, 0, 0 }, { 0, 0, 0 }, 1), (pcall(sim.rotateAroundAxis, a, { 0, 0, 0 }, { 0, 0, 0 }, 1)))
    end";
    let expected = ["1.000000 1.000000", "1.000000 2.000000 0.700000", "1.000000 -1.000000 1.770796", "7\tfalse"];
    assert_eq!(said(code), expected);
}

#[test]
fn calls_of_old_scripts_are_answered_as_they_were() {
    let code = "function sysCall_init()
        local own = sim.getObjectHandle(sim.handle_self)
        print(own == sim.getObject('.'), simGetObjectHandle(sim_handle_self) == own)
        local before = sim.getSystemTimeInMs(-1)
        print(before, simGetSystemTimeInMilliseconds() == before, sim.getSystemTimeInMs(before))
        local joint = sim.getObject('/hinge')
        print(sim.getObjectInt32Param(joint, 2000), simGetObjectInt32Parameter(joint, 2000))
    end
    function sysCall_cleanup() print(sim.getSystemTimeInMs(-1) > 0, sim.getSystemTimeInMs(1) > 0) end";
    assert_eq!(said(code), ["true\ttrue", "0\ttrue\t0", "1\t1\t1", "true\ttrue"]);
}

#[test]
fn numbered_objects_are_found_by_an_index() {
    let scene = format!(
        "{PENDULUM}\n[[frame]]\nname = \"eye1\"\nparent = \"/hinge/arm\"\n[[frame]]\nname = \"eye2\"\n\
         parent = \"/hinge/arm\"\n[[frame]]\nname = \"eye3\"\nparent = \"/hinge/arm\"\n[[script]]\n\
         object = \"/hinge/arm\"\nfile = \"a.lua\"\n"
    );
    let code = "function sysCall_init()
        local names = {}
        for k = 0, 2 do names[#names + 1] = sim.getObjectAlias(sim.getObject('./eye', { index = k })) end
        names[#names + 1] = sim.getObjectAlias(sim.getObject('/eye{1}'))
        names[#names + 1] = sim.getObject('/eye', { index = 3, noError = true })
        print(table.concat(names, ' '))
    end";
    let loaded = open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)]).unwrap();
    assert_eq!(run(&loaded).messages[0].text, "eye1 eye2 eye3 eye2 -1");
}

#[test]
fn a_run_whose_motors_change_their_mode_is_audited_to_its_end() {
    let scene = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
motor = { mode = "velocity", max_torque = 3.0 }
[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.5, 0.0, 0.0]
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[script]]
object = "/hinge/arm"
file = "a.lua"
"#;
    for mode in ["force", "free", "spring"] {
        let code = format!(
            "function sysCall_actuation()
                if math.abs(sim.getSimulationTime() - 0.03) < 1e-9 then
                    sim.setObjectInt32Param(
                        sim.getObject('/hinge'), sim.jointintparam_dynctrlmode, sim.jointdynctrl_{mode})
                end
            end"
        );
        let loaded = open(&[("scene.toml", scene), ("experiment.toml", EXPERIMENT), ("a.lua", &code)]).unwrap();
        let run = run(&loaded);
        assert_eq!(run.status, sincro_sim::results::Status::Completed, "{mode}: {:?}", run.messages);
    }
}

#[test]
fn a_script_is_found_below_its_object() {
    let arm = "function twice(x) return 2 * x end";
    let hinge = "function sysCall_init()
            local script = sim.getObject('/hinge/arm/Script')
            print(sim.callScriptFunction('twice', script, 21), script == sim.getObject('/hinge/arm'))
            print(sim.getObject('./Script[0]') == sim.getObject('.'))
            print(pcall(sim.getObject, '/base/Script'))
        end";
    let scene = format!(
        "{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"arm.lua\"\n[[script]]\nobject = \"/hinge\"\nfile = \"hinge.lua\"\n"
    );
    let loaded =
        open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("arm.lua", arm), ("hinge.lua", hinge)]);
    let said: Vec<String> = run(&loaded.unwrap()).messages.into_iter().map(|m| m.text).collect();
    assert_eq!(said[..2], ["42\ttrue", "true"]);
    assert!(said[2].starts_with("false"), "{said:?}");
}

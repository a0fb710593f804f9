//! Paths as objects and lists, wireless data between scripts, properties of windows.

use super::world::{EXPERIMENT, PENDULUM, open, run, said};

#[test]
fn a_path_has_points_that_round_off_its_control_points() {
    let code = "
        function sysCall_init()
            local square = { 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1 }
            local path = sim.createPath(square, 2, 401, 0)
            local points = sim.unpackDoubleTable(sim.readCustomDataBlock(path, 'PATH'))
            local m = Matrix(#points // 7, 7, points)
            local positions = m:slice(1, 1, m:rows(), 3):data()
            local lengths, total = sim.getPathLengths(positions, 3)
            print(m:rows(), string.format('%.6f', total))
            local p = sim.getPathInterpolatedConfig(positions, lengths, 1.5)
            print(string.format('%.3f %.3f %.3f', p[1], p[2], p[3]))
            print(string.format('%.3f', sim.getClosestPosOnPath(positions, lengths, { 1.2, 0.25, 0 })))
            -- rounded off: corners are cut, sides are touched
            local round = sim.unpackDoubleTable(sim.readCustomDataBlock(sim.createPath(square, 2, 401, 1), 'PATH'))
            local most, least = 0, 1
            for k = 1, #round, 7 do
                local from_corner = math.sqrt((round[k] - 1) ^ 2 + (round[k + 1] - 1) ^ 2)
                most, least = math.max(most, round[k]), math.min(least, from_corner)
            end
            print(string.format('%.3f %.3f', most, least))
            print(pcall(sim.createPath, { 1, 2 }))
        end";
    let said = said(code);
    // a quadratic curve from side's middle to side's middle comes a quarter of their diagonal, √2/8 m, near the corner
    assert_eq!(said[..4], ["401\t4.000000", "1.000 0.500 0.000", "1.250", "1.000 0.177"]);
    assert!(said[4].contains("control points"), "{said:?}");
}

#[test]
fn orientations_follow_a_path_if_they_are_asked_to() {
    let code = "
        function sysCall_init()
            local line = { 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 0, 1 }
            local points = sim.unpackDoubleTable(sim.readCustomDataBlock(sim.createPath(line, 16, 3, 0, 0, { 0, 0, 1 }), 'PATH'))
            -- x along the path, y up
            local m = sim.poseToMatrix({ table.unpack(points, 8, 14) })
            print(string.format('%.3f %.3f %.3f, %.3f', m[1], m[5], m[9], m[10]))
            local half = sim.getPathInterpolatedConfig({ 0, 0, 0, 1, 0, 0, 1, 0 }, { 0, 1 }, 0.5, nil, { 2, 2, 2, 2 })
            print(string.format('%.4f %.4f', half[3], half[4]))
            print(string.format('%.4f', sim.getPathInterpolatedConfig({ 3, -3 }, { 0, 1 }, 0.5, nil, { 1 })[1]))
            print(#sim.resamplePath({ 0, 0, 1, 1 }, { 0, 1.5 }, 5))
        end";
    assert_eq!(said(code), ["0.000 1.000 0.000, 1.000", "0.7071 0.7071", "3.1416", "10"]);
}

#[test]
fn paths_of_v_rep_3_have_control_points_put_in_and_are_gone_along() {
    let code = "
        function sysCall_init()
            local path = sim.createPath(1)
            sim.setObjectPosition(path, -1, { 0, 0, 1 })
            sim.insertPathCtrlPoints(path, 0, 0, 2, { 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0 })
            local p, o = sim.getPositionOnPath(path, 0.25), sim.getOrientationOnPath(path, 0.5)
            print(sim.getPathLength(path), p[1], p[3], string.format('%.3f', o[3]))
            print(sim.getClosestPositionOnPath(path, { 1.5, 4, 1 }))
            sim.setPathPosition(path, 0.7)
            print(sim.getPathPosition(path))
            sim.cutPathCtrlPoints(path, -1, 0)
            print(pcall(sim.getPathLength, path))
            print(pcall(sim.getPathLength, sim.getObject('/hinge')))
        end";
    let said = said(code);
    assert_eq!(said[..3], ["2.0\t0.5\t1.0\t0.500", "0.75", "0.7"]);
    assert!(said[3].contains("has no points") && said[4].contains("is no path"), "{said:?}");
}

#[test]
fn wireless_data_are_received_once_within_range() {
    let scene = format!(
        "{PENDULUM}\n[[frame]]\nname = \"far\"\nposition = [100.0, 0.0, 0.0]\n[[script]]\nobject = \"/hinge\"\nfile = \"a.lua\"\n[[script]]\nobject = \"/far\"\nfile = \"b.lua\"\n"
    );
    let sends = "
        function sysCall_init() k = 0 end
        function sysCall_actuation()
            k = k + 1
            if k == 1 then
                sim.sendData(sim.handle_all, 3, 'near', 'lost', sim.handle_self, 5)
                sim.sendData(sim.handle_all, 3, 'wide', 'one', sim.handle_self, 1000)
                sim.sendData(sim.handle_all, 4, 'wide', 'two', -1)
            end
        end";
    let receives = "
        function sysCall_actuation()
            while true do
                local data, sender, header, name = sim.receiveData(-1)
                if not data then break end
                print(string.format('%.2f', sim.getSimulationTime()), data, header, name, sim.getObjectAlias(sender))
            end
        end";
    let files = [("scene.toml", &*scene), ("experiment.toml", EXPERIMENT), ("a.lua", sends), ("b.lua", receives)];
    let run = run(&open(&files).unwrap_or_else(|p| panic!("{p}")));
    let said: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(said, ["0.00\tone\t3\twide\thinge", "0.00\ttwo\t4\twide\thinge"]);
}

#[test]
fn properties_of_windows_are_kept_and_visibility_is_that_of_the_layer() {
    let code = "
        function sysCall_init()
            local arm = sim.getObject('/hinge/arm')
            for _, name in ipairs { 'depthInvisible', 'selectable', 'collapsed', 'ignoreViewFitting' } do
                sim.setBoolProperty(arm, name, true)
                assert(sim.getBoolProperty(arm, name))
                sim.setBoolProperty(arm, name, false)
                assert(not sim.getBoolProperty(arm, name))
            end
            sim.setBoolProperty(arm, 'visible', false)
            print(sim.getBoolProperty(arm, 'visible'), sim.getObjectInt32Param(arm, 10))
            print(pcall(sim.setBoolProperty, arm, 'nothing', true))
        end";
    let said = said(code);
    assert_eq!(said[0], "false\t0");
    assert!(said[1].contains("depthInvisible"), "{said:?}");
}

#[test]
fn a_selection_is_a_list_of_objects() {
    let code = "
        function sysCall_init()
            local hinge, arm = sim.getObject('/hinge'), sim.getObject('/hinge/arm')
            print(#sim.getObjectSelection())
            sim.addObjectToSelection(nil)
            sim.addObjectToSelection(sim.handle_tree, hinge)
            print(#sim.getObjectSel() >= 2, sim.getObjectSel()[1] == hinge, sim.isObjectInSelection(arm))
            sim.removeObjectFromSelection(sim.handle_all, -1)
            sim.addObjectToSelection({ arm, arm })
            print(sim.getObjectSelectionSize(), sim.getObjectLastSelection() == arm)
            local a, b = sim.getFloatParam(sim.floatparam_rand), sim.getFloatParam(sim.floatparam_rand)
            print(a ~= b, a >= 0 and a < 1)
        end";
    assert_eq!(said(code), ["0", "true\ttrue\t1", "1\ttrue", "true\ttrue"]);
}

#[test]
fn a_script_is_meant_by_its_object_too() {
    let scene = format!(
        "{PENDULUM}\n[[frame]]\nname = \"Script\"\n[[script]]\nobject = \"/hinge\"\nfile = \"a.lua\"\n[[script]]\nobject = \"/Script\"\nfile = \"b.lua\"\n"
    );
    let calls = "
        function sysCall_init() done = false end
        function sysCall_actuation()
            if not done then
                done = true
                local other = sim.getObject('/Script')
                print(sim.callScriptFunction('twice', other, 4), sim.callScriptFunction(other, 'twice', 5))
                print(pcall(sim.callScriptFunction, 'twice', sim.getObject('/hinge/arm')))
            end
        end";
    let files = [
        ("scene.toml", &*scene),
        ("experiment.toml", EXPERIMENT),
        ("a.lua", calls),
        ("b.lua", "function sysCall_init() end function twice(x) return 2 * x end"),
    ];
    let run = run(&open(&files).unwrap_or_else(|p| panic!("{p}")));
    let said: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!(said[0], "8\t10");
    assert!(said[1].contains("there is no script"), "{said:?}");
}

#[test]
fn the_box_around_a_shape_is_told_side_by_side() {
    let code = "
        function sysCall_init()
            local cube = sim.createPureShape(0, 16, { 0.2, 0.4, 0.6 }, 1)
            local r, low = sim.getObjectFloatParameter(cube, sim.objfloatparam_objbbox_min_y)
            print(r, low, sim.getObjectFloatParam(cube, sim.objfloatparam_objbbox_max_z))
        end";
    assert_eq!(said(code), ["1\t-0.2\t0.3"]);
}

#[test]
fn an_object_follows_a_path_in_a_thread() {
    let code = "
        function sysCall_thread()
            local path, point = sim.createPath({ 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 0, 1 }, 0, 10, 0), sim.createDummy(0.01)
            sim.followPath(point, path, 3, 0, 100)
            print(sim.getSimulationTime(), sim.getObjectPosition(point, -1)[1])
        end";
    assert_eq!(said(code), ["0.03\t3.0"]);
    let back = code
        .replace("0, 100)", "2 / 3, -100)")
        .replace("sim.followPath", "print(pcall(sim.followPath, point, path, 3, 0, 0)) sim.followPath");
    assert_eq!(said(&back), ["false\tsim.followPath: the velocity is 0", "0.02\t0.0"]);
}

//! Functions of V-REP 3 that later versions have dropped.

use super::world::{EXPERIMENT, PENDULUM, open, run, said};

#[test]
fn names_that_are_not_there_are_errors_unless_a_script_says_otherwise() {
    let code = "function sysCall_init()
            local mode = sim.getInt32Parameter(sim.intparam_error_report_mode)
            print(mode, pcall(sim.getObjectHandle, 'none') and 'found' or 'error')
            sim.setInt32Parameter(sim.intparam_error_report_mode, 0)
            print(simGetObjectHandle('none'), sim.getObjectHandle('arm') > 0, simGetIntegerParameter(0))
            sim.setInt32Parameter(sim.intparam_error_report_mode, mode)
            print(sim.getObjectHandle('none@silentError'), pcall(sim.getObjectHandle, 'none') and 'found' or 'error')
        end";
    assert_eq!(said(code), ["1\terror", "-1\ttrue\t0", "-1\terror"]);
}

#[test]
fn joints_move_together_to_positions() {
    let code = "function sysCall_thread()
            local joint = sim.getObject('/hinge')
            sim.setJointMode(joint, sim.jointmode_kinematic, 0)
            local from, t = sim.getJointPosition(joint), sim.getSimulationTime()
            simMoveToJointPositions({ joint }, { from + 0.1 }, 0.2)
            print(string.format('%.6f', sim.getJointPosition(joint) - from), sim.getSimulationTime() > t)
            local dummy, goal = sim.createDummy(0.01), sim.createDummy(0.01)
            sim.setObjectPose(goal, { 0.02, 0, 0, 0, 0, 0, 1 }, -1)
            print(select(2, pcall(simMoveToObject, dummy, goal, 3, nil, 0.5, 0)))
            simMoveToObject(dummy, goal, 3, nil, 0.5, -10)
            print(string.format('%.6f', sim.getObjectPosition(dummy, -1)[1]))
        end";
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n");
    let experiment = EXPERIMENT.replace("duration = 0.05", "duration = 1.0");
    let files = [("scene.toml", &*scene), ("experiment.toml", &*experiment), ("a.lua", code)];
    let run = run(&open(&files).unwrap_or_else(|problems| panic!("{problems}")));
    let messages: Vec<&str> = run.messages.iter().map(|m| m.text.as_str()).collect();
    assert_eq!((messages[0], messages[2]), ("0.100000\ttrue", "0.020000"));
    assert!(messages[1].contains("sim.moveToObject: the acceleration is 0"), "{messages:?}");
}

#[test]
fn colors_and_user_parameters_are_told() {
    let messages = said(
        "function sysCall_init()
            local box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 0.1, 0.1, 0.1 })
            sim.setShapeColor(box, nil, sim.colorcomponent_ambient_diffuse, { 1, 0, 0.2 })
            local result, rgb = sim.getShapeColor(box, nil, sim.colorcomponent_ambient_diffuse)
            print(result, rgb[1], rgb[2], rgb[3], sim.getObjectColor(box, 0, 0)[1])
            sim.setShapeColor(box, nil, sim.colorcomponent_emission, { 0.5, 0, 0 })
            print(sim.getObjectColor(box, 0, sim.colorcomponent_emission)[1], sim.getObjectColor(box, 0, 2)[1])
            print(sim.getUserParameter(box, 'speed'))
            sim.setUserParameter(box, 'speed', 0.5)
            simSetUserParameter(box, 'name', 'front')
            print(simGetUserParameter(box, 'speed'), sim.getUserParameter(box, 'name'))
            print(sim.msgBox(0, 0, 'title', 'text'), pcall(sim.getShapeColor, sim.createDummy(0.1), nil, 0))
        end",
    );
    assert_eq!(messages[0], "1\t1.0\t0.0\t0.2\t1.0");
    assert_eq!(messages[1..4], ["0.5\t0.0", "nil", "0.5\tfront"]);
    let rest = messages[4..].join("; ");
    assert!(rest.contains("title: text") && rest.contains("3\tfalse") && rest.contains("has no shape"), "{rest}");
}

#[test]
fn configurations_and_tables_are_copied() {
    let messages = said(
        "function sysCall_init()
            local joint = sim.getObject('/hinge')
            sim.setJointMode(joint, sim.jointmode_kinematic, 0)
            sim.setJointPosition(joint, 0.25)
            local tree, own = sim.getConfigurationTree(joint), simGetObjectConfiguration(joint)
            sim.setJointPosition(joint, 1)
            print(sim.setConfigurationTree(tree), sim.getJointPosition(joint))
            sim.setJointPosition(joint, 1)
            print(simSetObjectConfiguration(own), sim.getJointPosition(joint))
            local a = { 1, { x = 2 } }
            a.self = a
            local b = sim.copyTable(a)
            b[2].x = 3
            print(a[2].x, b[2].x, b.self == b, #simCopyMatrix(sim.buildIdentityMatrix()))
        end",
    );
    assert_eq!(messages, ["1\t0.25", "1\t0.25", "2\t3\ttrue\t12"]);
}

#[test]
fn shapes_that_are_not_round_are_hulls() {
    let messages = said(
        "function sysCall_init()
            for kind = 1, 3 do
                local shape = simCreatePureShape(kind, 8, { 0.2, 0.1, 0.4 }, 2)
                local inertia = sim.getShapeInertia(shape)
                local low, high = sim.getObjectFloatParam(shape, 15), sim.getObjectFloatParam(shape, 18)
                print(string.format('%.4f %.4f %.6f', sim.getShapeMass(shape), high - low, inertia[9]))
            end
            local mesh = sim.createMeshShape(0, 0, { 0,0,0, 1,0,0, 0,1,0, 0,0,1 }, { 0,2,1, 0,1,3, 0,3,2, 1,2,3 })
            sim.setObjectInt32Param(mesh, sim.shapeintparam_respondable, 1)
            sim.setObjectInt32Param(mesh, sim.shapeintparam_static, 0)
            print(string.format('%.4f', sim.getShapeMass(mesh)))
            print(pcall(sim.createPrimitiveShape, sim.primitiveshape_disc, { 0.2, 0.1, 0 }))
        end",
    );
    // m (a² + b²)/5 of an ellipsoid, /4 of a cylinder, 3/20 of a cone, with its half axes, but for the chords
    let square = 0.1 * 0.1 + 0.05 * 0.05;
    for (got, share) in messages.iter().zip([0.2, 0.25, 0.15]) {
        let numbers: Vec<f64> = got.split(' ').map(|number| number.parse().unwrap()).collect();
        assert!((numbers[0] - 2.0).abs() < 1e-9 && (numbers[1] - 0.2).abs() < 1e-4, "{messages:?}");
        assert!((numbers[2] - 2.0 * share * square).abs() < 0.03 * numbers[2], "{messages:?}");
    }
    // of water
    assert_eq!(messages[3], "166.6667");
    assert!(messages[4].starts_with("false") && messages[4].contains("a disc"), "{messages:?}");
}

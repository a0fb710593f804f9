//! Proximity sensors and distances in scripts: the law of `stop-at-wall` in Lua gives the bits of its diagram.

use sincro_sim::load;
use sincro_sim::results::Status;
use sincro_testing::{repository_scene, with_scripts};

use super::world::{folder, run, said};

const LAW: &str = r#"
function sysCall_init()
    nose, rail = sim.getObject('./nose'), sim.getObject('..')
    robot = sim.createCollection(0)
    sim.addItemToCollection(robot, sim.handle_tree, rail, 0)
    wall = sim.getObject('/wall')
end

function sysCall_actuation()
    local result, d = sim.readProximitySensor(nose)
    if result < 1 then d = 1.5 end
    local speed = math.min(math.max(2.03 * (d - 0.3), 0), 0.5)
    sim.setJointTargetVelocity(rail, math.floor(speed * 1024 + 0.5) / 1024)
end

function sysCall_sensing()
    -- the sensors were handled before: what they saw is where things are now
    local result, d, point, object, normal = sim.readProximitySensor(nose)
    local near, data, pair = sim.checkDistance(robot, wall)
    assert(near == 1 and pair[2] == wall)
    if result == 1 then
        assert(object == wall and normal[3] == -1 and math.abs(data[7] - d) < 1e-12 and math.abs(point[3] - d) < 1e-12)
    else
        assert(result == 0 and d == 0 and object == -1 and data[7] > 1.5 - 1e-9)
    end
end
"#;

#[test]
fn the_cart_stops_before_the_wall_by_a_script_with_the_same_bits() {
    let scene = repository_scene("stop-at-wall");
    let by_diagram = run(&load(&scene, &[], with_scripts()).unwrap_or_else(|p| panic!("{p}"))).trace;
    let read = |name: &str| std::fs::read_to_string(scene.join(name)).unwrap();
    let with_script = format!("{}\n[[script]]\nobject = \"/rail/cart\"\ncode = '''{LAW}'''\n", read("scene.toml"));
    // a script wins over the diagram: one that drives backwards
    let diagram = read("stop.toml").replace("upper = \"v_max\"", "upper = 0.0");
    let (experiment, reference) = (read("experiment.toml"), read("reference.csv"));
    let files = [
        ("scene.toml", with_script.as_str()),
        ("stop.toml", diagram.as_str()),
        ("experiment.toml", experiment.as_str()),
        ("reference.csv", reference.as_str()),
    ];
    let folder = folder(&files);
    let scripted = run(&load(&folder, &[], with_scripts()).unwrap_or_else(|p| panic!("{p}")));
    assert_eq!(scripted.status, Status::Completed, "{:?}", scripted.messages);
    assert_eq!(scripted.trace, by_diagram);
}

#[test]
fn scripts_of_older_versions_get_one_result_where_nothing_is_detected() {
    let old = said("
        function sysCall_init()
            sensor = sim.createProximitySensor(sim.proximitysensor_ray_subtype, 16, 1, {3, 3, 2, 2, 1, 1, 0, 0}, {0, 1, 0, 0, 0, 0, 0, 0, 0, 0})
            print(sim.getObjectHandle('arm') > 0, select('#', sim.handleProximitySensor(sensor)))
            sim.setObjectPosition(sim.createPrimitiveShape(sim.primitiveshape_spheroid, {0.1, 0.1, 0.1}), -1, {0, 0, 0.5})
            print(select('#', sim.checkProximitySensor(sensor, sim.handle_all)))
            print(simGetNameSuffix('wheel#3'))
            print(simGetNameSuffix('wheel'))
        end");
    assert_eq!(old, ["true\t1", "5", "3\twheel", "-1\twheel"]);
    let new = said("
        function sysCall_init()
            sensor = sim.createProximitySensor(sim.proximitysensor_ray_subtype, 16, 1, {3, 3, 2, 2, 1, 1, 0, 0}, {0, 1, 0, 0, 0, 0, 0, 0, 0, 0})
            print(sim.getObject('/hinge/arm') > 0, select('#', sim.handleProximitySensor(sensor)))
        end");
    assert_eq!(new, ["true\t5"]);
}

#[test]
fn windows_of_v_rep_3_keep_what_is_set_and_nothing_is_pressed() {
    let code = "
        if sim_call_type == sim_childscriptcall_initialization then
            local ui = simGetUIHandle('UI')
            print(simGetUIEventButton(ui), simSetUIButtonLabel(ui, 3, 'go'), simGetUIButtonLabel(ui, 3), simGetUISlider(ui, 4))
            print(ui == simGetUIHandle('UI'), pcall(simGetUIEventButton, 17))
            local window = simExtCustomUI_create('<ui></ui>')
            simExtCustomUI_setSliderValue(window, 1, 30)
            print(simExtCustomUI_getSliderValue(window, 1))
        end";
    let said = said(code);
    assert_eq!(said[0], "-1\t1\tgo\t0");
    assert!(said[1].starts_with("true\tfalse\t") && said[1].contains("there is no window 17"), "{said:?}");
    assert_eq!(said[2], "30");
}

#[test]
fn parameters_of_several_scripts_come_in_a_list() {
    let code = "
        function sysCall_init()
            sim.setScriptSimulationParameter(sim.handle_self, 'count', 3)
            local all = sim.getScriptSimulationParameter(sim.handle_all, 'count')
            print(#all, all[1] + 1, sim.getScriptSimulationParameter(sim.handle_all, 'none'))
            simAddObjectCustomData(sim.getObject('/hinge/arm'), 125487, 0)
            print(simGetObjectCustomData(sim.getObject('/hinge/arm'), 125487))
        end";
    assert_eq!(said(code), ["1\t4\tnil", "0"]);
}

//! Scripts of vision sensors: filters on their pictures, packets of their readings.

use sincro_coppelia::api::Search;
use sincro_math::elementary::{atan, tan};
use sincro_sim::load;
use sincro_sim::results::Status;
use sincro_testing::{OpenSession, SceneFolder, run, with_scripts};

/// An eye that looks at a red and a green ball before a dark wall, and a body with another script.
const SCENE: &str = r##"
[[body]]
name = "red"
position = [-0.5, 0.0, 1.0]
density = 500.0
shape = [{ sphere = { radius = 0.2 }, color = "#ff0000" }]
[[body]]
name = "green"
position = [0.5, 0.0, 1.5]
density = 500.0
shape = [{ sphere = { radius = 0.1 }, color = "#00ff00" }]
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 5.0, 0.0]
[[body]]
name = "arm"
parent = "/hinge"
density = 500.0
shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }]
[[camera]]
name = "eye"
position = [0.0, -2.0, 1.0]
look_at = [0.0, 0.0, 1.0]
resolution = [64, 48]
near = 0.5
far = 4.5
field_of_view_deg = 60.0
background = "#000000"
EXPLICIT
[[script]]
object = "/eye"
file = "eye.lua"
[[script]]
object = "/hinge/arm"
file = "arm.lua"
"##;

const EXPERIMENT: &str = r#"
title = "Eyes"
scene = "scene.toml"
duration = 0.02
step = 0.01
record = ["/hinge.position"]
"#;

fn status_of(eye: &str, arm: &str, keys: &str) -> (Status, Vec<String>) {
    let folder =
        SceneFolder::of(&SCENE.replace("EXPLICIT", keys), EXPERIMENT).with("eye.lua", eye).with("arm.lua", arm);
    let simulated = run(&load(&folder, &[], with_scripts()).unwrap_or_else(|problems| panic!("{problems}")));
    (simulated.status, simulated.messages.into_iter().map(|m| m.text).collect())
}

/// Messages of both scripts; the run must complete.
fn said(eye: &str, arm: &str, keys: &str) -> Vec<String> {
    let (status, messages) = status_of(eye, arm, keys);
    assert_eq!(status, Status::Completed, "{messages:?}");
    messages
}

/// Numbers of a message, separated by blanks.
fn numbers(message: &str) -> Vec<f64> {
    message.split_whitespace().map(|word| word.parse().unwrap_or_else(|_| panic!("{message}"))).collect()
}

/// As CoppeliaSim has made it of the filters of older scenes.
const RED: &str = "
function sysCall_vision(inData)
    local retVal = { trigger = false, packedPackets = {} }
    simVision.sensorImgToWorkImg(inData.handle)
    simVision.selectiveColorOnWorkImg(inData.handle, {0.6,0.0,0.0}, {0.5,0.2,0.2}, true, true, false)
    simVision.workImgToSensorImg(inData.handle)
    local trig, packedPacket = simVision.blobDetectionOnWorkImg(inData.handle, 0.05, 0.0, false)
    if trig then retVal.trigger = true end
    if packedPacket then retVal.packedPackets[#retVal.packedPackets+1] = packedPacket end
    return retVal
end";

#[test]
fn a_script_finds_blobs_that_others_read() {
    let arm = "
    function sysCall_sensing()
        local result, statistics, blobs = sim.readVisionSensor(sim.getObject('/eye'))
        print(table.concat({ result, #statistics, table.unpack(blobs) }, ' '))
        local image = sim.getVisionSensorImg(sim.getObject('/eye'))
        local green = 0
        for k = 2, #image, 3 do green = math.max(green, image:byte(k)) end
        print(green .. ' ' .. string.format('%.3f', statistics[8]))
    end";
    let messages = said(RED, arm, "");
    let first = numbers(&messages[0]);
    assert_eq!((first[0], first[1], first[2], first[3]), (0.0, 15.0, 1.0, 6.0), "{messages:?}");
    // 0.2 m of 2 m, where half the width is 4/3 tan 30°: a circle of its share of the pixels, in the left half
    let half = [4.0 / 3.0, 1.0].map(|ratio| ratio * tan(30_f64.to_radians()).0);
    let center = [0.5 - 0.25 / (2.0 * half[0]), 0.5];
    let radius = 0.1 / (1.0_f64 - 0.01).sqrt();
    let share = std::f64::consts::PI * radius * radius / (4.0 * half[0] * half[1]);
    assert!((first[4] - share).abs() < 0.2 * share, "{first:?} {share}");
    assert!((first[6] - center[0]).abs() < 0.02 && (first[7] - center[1]).abs() < 0.02, "{first:?} {center:?}");
    // the picture has nothing green any more, its statistics are those before
    let second = numbers(&messages[1]);
    assert!(second[0] < 40.0 && second[1] > 0.5, "{second:?}");
    assert_eq!(messages[2], messages[0], "the next step sees the same");
}

#[test]
fn a_sensor_is_told_what_it_is_and_may_trigger() {
    let eye = "
    function sysCall_vision(inData)
        print(table.concat({ inData.handle == sim.getObject('/eye') and 1 or 0, inData.resolution[1],
            inData.resolution[2], inData.clippingPlanes[1], inData.clippingPlanes[2], inData.viewAngle }, ' '))
        simVision.sensorImgToWorkImg(sim.handle_self)
        local trigger, packet = simVision.binaryWorkImg(inData.handle, 0.1, 0.1, 1, 0.5, 1, 0.5, 1, 0, 3.2, 1, true)
        return { trigger = trigger, packedPackets = { packet, sim.packFloatTable({ 7, 8 }) } }
    end
    function sysCall_trigger(inData) print('triggered ' .. #inData.packets .. ' ' .. inData.packets[2][2]) end";
    let arm = "
    function sysCall_sensing()
        local result, _, moments, own = sim.readVisionSensor(sim.getObject('/eye'))
        print(result .. ' ' .. #moments .. ' ' .. own[1] .. ' ' .. own[2])
    end";
    let messages = said(eye, arm, "");
    let input = numbers(&messages[0]);
    assert_eq!(input[..5], [1.0, 64.0, 48.0, 0.5, 4.5]);
    assert!((input[5] - 2.0 * atan(4.0 / 3.0 * tan(30_f64.to_radians()).0).0).abs() < 1e-9, "{input:?}");
    assert_eq!((messages[1].as_str(), messages[2].as_str()), ("triggered 2 8.0", "1 5 7.0 8.0"));
}

#[test]
fn a_sensor_that_is_handled_explicitly_filters_when_it_is_handled() {
    let eye = "n = 0
    function sysCall_vision(inData)
        n = n + 1
        return { packedPackets = { sim.packFloatTable({ n }) } }
    end";
    let arm = "
    function sysCall_actuation()
        local eye = sim.getObject('/eye')
        local result, _, count = sim.handleVisionSensor(eye)
        local _, _, again = sim.readVisionSensor(eye)
        print(result .. ' ' .. count[1] .. ' ' .. again[1])
    end";
    assert_eq!(said(eye, arm, "explicit_handling = true"), ["0 1.0 1.0", "0 2.0 2.0"]);
    let endless = "function sysCall_vision(inData) sim.handleVisionSensor(inData.handle) end";
    let (status, _) = status_of(endless, "", "");
    assert!(
        matches!(&status, Status::Stopped { reason, .. } if reason.contains("handled within each other")),
        "{status:?}"
    );
}

#[test]
fn a_sensor_that_a_client_handles_is_filtered_by_its_script() {
    let eye = "n = 0
    function sysCall_vision(inData)
        n = n + 1
        return { packedPackets = { sim.packFloatTable({ n }) } }
    end";
    let scene = SCENE.replace("EXPLICIT", "explicit_handling = true");
    let folder = SceneFolder::of(&scene, EXPERIMENT).with("eye.lua", eye).with("arm.lua", "");
    let mut session = OpenSession::open(folder, &[], with_scripts(), None);
    let eye = session.registry().find("/eye", Search::default()).unwrap();
    let count = |session: &mut OpenSession, name: &str| {
        let reading = session.call(name, &[i64::from(eye.0).into()]).unwrap();
        reading.get(2).and_then(|packet| packet.as_reals()).map(|packet| packet[0])
    };
    // scripts of a run have not begun
    assert_eq!(count(&mut session, "sim.handleVisionSensor"), None);
    session.start().unwrap();
    session.step().unwrap();
    assert_eq!(count(&mut session, "sim.handleVisionSensor"), Some(1.0));
    assert_eq!(count(&mut session, "sim.readVisionSensor"), Some(1.0));
    assert_eq!(count(&mut session, "simHandleVisionSensor"), Some(2.0));
}

#[test]
fn points_of_depths_are_packed() {
    let eye = "
    function sysCall_vision(inData)
        simVision.sensorDepthMapToWorkImg(inData.handle)
        local _, packet = simVision.coordinatesFromWorkImg(inData.handle, {5, 3}, true)
        local _, abs = simVision.coordinatesFromWorkImg(inData.handle | sim.handleflag_abscoords, {1, 1}, false)
        return { packedPackets = { packet, abs } }
    end";
    let arm = "
    function sysCall_sensing()
        local _, _, points, one = sim.readVisionSensor(sim.getObject('/eye'))
        print(#points .. ' ' .. points[1] .. ' ' .. points[2] .. ' ' .. table.concat(one, ' '))
    end";
    let got = numbers(&said(eye, arm, "")[0]);
    assert_eq!(got[..3], [62.0, 5.0, 3.0]);
    // the background is at the far plane, 4.5 m before the eye at y = −2
    assert!((got[6] - 2.5).abs() < 1e-6 && (got[8] - 4.5).abs() < 1e-6, "{got:?}");
}

#[test]
fn mistakes_are_told() {
    for (eye, why) in [
        ("simVision.binaryWorkImg(inData.handle, 0.5)", "argument 3 is nothing, expected a number"),
        (
            "simVision.edgeDetectionOnWorkImg(inData.handle, 0.2)",
            "there is no work image: call simVision.sensorImgToWorkImg",
        ),
        (
            "simVision.resizeWorkImg(inData.handle, {0.5, 0.5})",
            "simVision.resizeWorkImg is not offered: work images are not",
        ),
        ("return { packedPackets = { 'abc' } }", "packedPackets has 3 bytes in a text, expected whole floats"),
        ("return { packedPackets = { { 1 } } }", "packedPackets has a table, expected texts"),
        ("simVision.sensorImgToWorkImg(sim.getObject('/red'))", "`/red` is no vision sensor"),
        (
            "simVision.sensorImgToWorkImg(inData.handle) simVision.coordinatesFromWorkImg(inData.handle, {0, 5}, true)",
            "0 × 5 points: expected at least one each way",
        ),
        (
            "simVision.sensorImgToWorkImg(inData.handle) simVision.matrix3x3OnWorkImg(inData.handle, 1e4, 1)",
            "10000 passes",
        ),
        // 64 MB of texts would be 16 GB of numbers
        (
            "local s = ('x'):rep(2^22) local t = {} for k = 1, 999 do t[k] = s end return { packedPackets = t }",
            "a reading has up to 1000 packets of 4194304 numbers together",
        ),
        ("local t = {} for k = 1, 1001 do t[k] = '' end return { packedPackets = t }", "up to 1000 packets"),
    ] {
        let (status, _) = status_of(&format!("function sysCall_vision(inData)\n{eye}\nend"), "", "");
        assert!(matches!(&status, Status::Stopped { reason, .. } if reason.contains(why)), "{why}: {status:?}");
    }
    let elsewhere = said("", "function sysCall_vision() end", "");
    assert_eq!(elsewhere, ["sysCall_vision is not called: it is for scripts on vision sensors"]);
}

#[test]
fn every_filter_takes_its_arguments() {
    let eye = "
    local calls = {
        { 'workImgToBuffer1' }, { 'workImgToBuffer2' }, { 'swapBuffers' }, { 'buffer1ToWorkImg' }, { 'buffer2ToWorkImg' },
        { 'swapWorkImgWithBuffer1' }, { 'addWorkImgToBuffer1' }, { 'subtractWorkImgFromBuffer1' },
        { 'addBuffer1ToWorkImg' }, { 'subtractBuffer1FromWorkImg' }, { 'multiplyWorkImgWithBuffer1' },
        { 'horizontalFlipWorkImg' }, { 'verticalFlipWorkImg' }, { 'normalizeWorkImg' }, { 'sharpenWorkImg' },
        { 'uniformImgToWorkImg', { 0.1, 0.2, 0.3 } }, { 'colorSegmentationOnWorkImg', 0.1 },
        { 'intensityScaleOnWorkImg', 0.1, 0.9, false }, { 'scaleAndOffsetWorkImg', {0,0,0}, {1,1,1}, {0,0,0}, false },
        { 'shiftWorkImg', { 0.1, 0 }, true }, { 'circularCutWorkImg', 0.5, true },
        { 'rectangularCutWorkImg', { 0.5, 0.5 }, true }, { 'matrix3x3OnWorkImg', 2, 1 },
        { 'matrix5x5OnWorkImg', 1, 1 }, { 'changedPixelsOnWorkImg', 0.1 },
        { 'velodyneDataFromWorkImg', { 10, 4 }, 0.4, true }, { 'workImgToSensorImg', false }, { 'releaseBuffers' },
    }
    function sysCall_vision(inData)
        simVision.sensorImgToWorkImg(inData.handle)
        for _, call in ipairs(calls) do
            local trigger = simVision[call[1]](inData.handle, table.unpack(call, 2))
            assert(trigger == false, call[1])
        end
        print('all')
    end";
    assert_eq!(said(eye, "", ""), ["all", "all"]);
}

#[test]
fn another_way_to_draw_is_told_and_not_taken() {
    let eye = "function sysCall_init()
        sim.setObjectInt32Param(sim.getObject('/eye'), sim.visionintparam_render_mode, 0)
        sim.setObjectInt32Param(sim.getObject('/eye'), sim.visionintparam_render_mode, 1)
        print(sim.getObjectInt32Param(sim.getObject('/eye'), sim.visionintparam_render_mode))
    end";
    let messages = said(eye, "", "");
    assert_eq!(messages.len(), 2, "{messages:?}");
    assert!(messages.iter().any(|text| text.contains("render mode 1 of `/eye` is not taken")), "{messages:?}");
}

#[test]
fn filters_are_counted_as_instructions() {
    let eye = "function sysCall_vision(inData)
        simVision.sensorImgToWorkImg(inData.handle)
        for k = 1, 10 do simVision.matrix5x5OnWorkImg(inData.handle, 100, 1) end
    end";
    // 64 × 48 pixels, 25 weights, 100 passes: about a million instructions each
    let scene = SCENE.replace("EXPLICIT", "").replace("\"eye.lua\"", "\"eye.lua\"\nmax_instructions = 5000000");
    let folder = SceneFolder::of(&scene, EXPERIMENT).with("eye.lua", eye).with("arm.lua", "");
    let status = run(&load(&folder, &[], with_scripts()).unwrap_or_else(|problems| panic!("{problems}"))).status;
    assert!(matches!(&status, Status::Stopped { reason, .. } if reason.contains("5000000 instructions")), "{status:?}");
    let large = "function sysCall_init()
        local options = { 1180, 1180, 0, 0 }
        local eye = sim.createVisionSensor(1, options, { 0.1, 5, 1, 0.1, 0, 0, 0, 0, 0, 0, 0 })
        simVision.sensorImgToWorkImg(eye)
        print(select(2, pcall(simVision.matrix5x5OnWorkImg, eye, 100, 1)))
    end";
    let messages = said("", large, "");
    assert!(messages[0].contains("takes 3481000000 operations on pixels"), "{messages:?}");
}

#[test]
fn sensors_are_handled_by_any_number_and_all_at_once() {
    let eye = "n = 0
    function sysCall_vision(inData) n = n + 1 return { packedPackets = { sim.packFloatTable({ n }) } } end";
    let arm = "function sysCall_actuation()
        local eye = sim.getObject('/eye')
        local result, _, count = sim.handleVisionSensor(eye / 1)
        print(result .. ' ' .. count[1])
        sim.handleVisionSensor(sim.handle_all_except_explicit)
        sim.handleVisionSensor(sim.handle_all)
        print(select(3, sim.readVisionSensor(eye))[1])
    end";
    assert_eq!(said(eye, arm, "explicit_handling = true"), ["0 1.0", "2.0", "0 3.0", "4.0"]);
}

#[test]
fn sensors_that_handle_each_other_come_to_an_end() {
    let eye = "depth, deepest = 0, 0
    function sysCall_vision(inData)
        depth = depth + 1
        deepest = math.max(deepest, depth)
        if n == nil or n < 100 then n = (n or 0) + 1 for k = 1, 2 do pcall(sim.handleVisionSensor, inData.handle) end end
        depth = depth - 1
        if depth == 0 then print(deepest) n = 0 end
    end";
    // the call of the step, and eight within it
    assert_eq!(said(eye, "", "")[0], "9");
}

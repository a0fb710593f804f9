//! Vision sensors in a session: whose pictures they are, of what instant, and that looking changes nothing.

use sincro_coppelia::api::{Handle, Search, Value};
use sincro_coppelia::session::{Files, Grants, Session};
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, SceneFolder, repository_scene, with_scripts};

/// A ball that falls past two eyes, one of them asked for its pictures, and a screen for pictures of clients.
const SCENE: &str = r##"
[[joint]]
name = "loose"
kind = "free"
initial = { position = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "ball"
parent = "/loose"
density = 1000.0
shape = [{ sphere = { radius = 0.1 }, color = "#ff0000" }]
[[body]]
name = "wall"
position = [0.0, 1.0, 0.5]
density = 500.0
shape = [{ cuboid = { size = [4.0, 0.2, 4.0] }, color = "#00ff00" }]
[[camera]]
name = "eye"
position = [0.0, -2.0, 1.0]
look_at = [0.0, 0.0, 1.0]
resolution = [32, 24]
near = 0.5
far = 4.5
[[camera]]
name = "lazy"
position = [0.0, -2.0, 1.0]
look_at = [0.0, 0.0, 1.0]
resolution = [32, 24]
explicit_handling = true
[[camera]]
name = "screen"
resolution = [4, 2]
external_input = true
background = "#102030"
"##;

const EXPERIMENT: &str = r#"
title = "Eyes"
scene = "scene.toml"
duration = 0.5
step = 0.005
record = ["/loose.position.z"]
"#;

fn open() -> OpenSession {
    SceneFolder::of(SCENE, EXPERIMENT).session(Extensions::default(), Some(0.05))
}

fn find(session: &mut Session, name: &str) -> Value {
    session.sim().registry.find(name, Search::default()).unwrap().into()
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refused(session: &mut Session, name: &str, arguments: &[Value]) -> String {
    session.call(name, arguments).expect_err(name).0
}

/// The picture of a sensor: red, green, blue of all pixels.
fn image(session: &mut Session, sensor: &Value) -> Vec<u8> {
    let results = call(session, "sim.getVisionSensorImg", std::slice::from_ref(sensor));
    results[0].as_bytes().unwrap().to_vec()
}

/// Mean row of what is red.
fn height(image: &[u8], columns: usize) -> f64 {
    let red = image.chunks(3).enumerate().filter(|(_, p)| p[0] > 100 && p[1] == 0);
    let rows: Vec<f64> = red.map(|(k, _)| (k / columns) as f64).collect();
    assert!(!rows.is_empty(), "the ball is in the picture");
    rows.iter().sum::<f64>() / rows.len() as f64
}

#[test]
fn a_picture_is_that_of_the_last_step_whenever_it_is_read() {
    let (mut late, mut early) = (open(), open());
    for session in [&mut late, &mut early] {
        session.start().unwrap();
        session.step().unwrap();
    }
    let eye = find(&mut late, "/eye");
    let at_once = image(&mut early, &eye);
    // half a metre up, after the step was made
    let ball = find(&mut late, "/ball");
    call(&mut late, "sim.setObjectPosition", &[ball, Value::reals([0.0, 0.0, 1.5])]);
    assert_eq!(image(&mut late, &eye), at_once);
    assert_eq!(image(&mut late, &eye), at_once, "read twice");
    for session in [&mut late, &mut early] {
        session.step().unwrap();
    }
    let next = image(&mut early, &eye);
    assert!(height(&next, 32) < height(&at_once, 32), "it falls");
    // 0.05 s and 0.1 s of fall: 12 mm and 49 mm, 2 m away, pixels of 2 m·2·tan 19°/24 = 57 mm
    assert!(height(&at_once, 32) - height(&next, 32) < 1.0);
}

#[test]
fn what_is_made_at_run_time_is_in_the_pictures_as_it_was_at_their_instant() {
    let blue = |image: &[u8]| image.chunks(3).filter(|p| p[2] > 100 && p[0] == 0 && p[1] == 0).count();
    let (mut late, mut early) = (open(), open());
    let eye = find(&mut late, "/eye");
    let mut shapes = Vec::new();
    for session in [&mut late, &mut early] {
        let shape =
            call(session, "sim.createPrimitiveShape", &[Value::Int(3), Value::reals([0.3, 0.1, 0.3])]).remove(0);
        call(session, "sim.setObjectPosition", &[shape.clone(), Value::reals([0.6, 0.0, 1.0])]);
        call(session, "sim.setShapeColor", &[shape.clone(), Value::Nil, Value::Int(0), Value::reals([0.0, 0.0, 1.0])]);
        session.start().unwrap();
        session.step().unwrap();
        shapes.push(shape);
    }
    let at_once = image(&mut early, &eye);
    assert!(blue(&at_once) > 12, "{} pixels are blue", blue(&at_once));
    // moved, coloured anew, joined by another one and taken away after the step: the picture is the step's
    let (shape, white) = (shapes[0].clone(), Value::reals([1.0; 3]));
    call(&mut late, "sim.setObjectPosition", &[shape.clone(), Value::reals([-0.6, 0.0, 1.0])]);
    call(&mut late, "sim.setShapeColor", &[shape.clone(), Value::Nil, Value::Int(0), white]);
    call(&mut late, "sim.createPrimitiveShape", &[Value::Int(3), Value::reals([9.0; 3])]);
    call(&mut late, "sim.removeObject", &[shape]);
    assert_eq!(image(&mut late, &eye), at_once);
    // another one is drawn from what there is at the next step
    call(&mut early, "sim.removeObject", &[shapes[1].clone()]);
    assert_eq!(image(&mut early, &eye), at_once);
    early.step().unwrap();
    assert_eq!(blue(&image(&mut early, &eye)), 0);
}

#[test]
fn looking_changes_no_hash() {
    let traces = [false, true].map(|looks| {
        let mut session = open();
        session.start().unwrap();
        for _ in 0..10 {
            session.step().unwrap();
            if looks {
                let (eye, lazy) = (find(&mut session, "/eye"), find(&mut session, "/lazy"));
                image(&mut session, &eye);
                call(&mut session, "sim.readVisionSensor", std::slice::from_ref(&eye));
                call(&mut session, "sim.handleVisionSensor", &[lazy]);
                call(&mut session, "sim.checkVisionSensor", &[eye, Value::Int(-2)]);
            }
        }
        session.trace().unwrap().to_string()
    });
    assert_eq!(traces[0], traces[1]);
}

#[test]
fn a_sensor_that_was_not_handled_has_nothing_to_tell() {
    let mut session = open();
    let (eye, lazy) = (find(&mut session, "/eye"), find(&mut session, "/lazy"));
    let state = |session: &mut Session, sensor: &Value| {
        let results = call(session, "sim.readVisionSensor", std::slice::from_ref(sensor));
        (results[0].as_int().unwrap(), results.len())
    };
    // its picture shows what it would see now all the same
    assert_eq!(height(&image(&mut session, &eye), 32), 11.5);
    assert_eq!(state(&mut session, &eye), (-1, 1));
    session.start().unwrap();
    // in a run it tells what it sees, as proximity sensors do, but for one that scripts handle
    assert_eq!((state(&mut session, &eye), state(&mut session, &lazy)), ((0, 2), (-1, 1)));
    session.step().unwrap();
    assert_eq!((state(&mut session, &eye), state(&mut session, &lazy)), ((0, 2), (-1, 1)));
    let before = image(&mut session, &lazy);
    let results = call(&mut session, "sim.handleVisionSensor", std::slice::from_ref(&lazy));
    assert_eq!((results.len(), results[1].as_reals().unwrap().len()), (2, 15));
    assert_eq!(state(&mut session, &lazy), (0, 2));
    for _ in 0..4 {
        session.step().unwrap();
    }
    // an explicit one keeps its picture until it is asked again, or all are
    assert_eq!(image(&mut session, &lazy), before);
    call(&mut session, "sim.handleVisionSensor", &[Value::Int(-3)]);
    assert_eq!(image(&mut session, &lazy), before);
    call(&mut session, "sim.handleVisionSensor", &[Value::Int(-2)]);
    assert!(image(&mut session, &lazy) != before);
    call(&mut session, "sim.resetVisionSensor", &[Value::Int(-3)]);
    assert_eq!((state(&mut session, &eye), state(&mut session, &lazy)), ((-1, 1), (0, 2)));
    session.step().unwrap();
    session.stop().unwrap();
    assert_eq!((state(&mut session, &eye), state(&mut session, &lazy)), ((-1, 1), (-1, 1)));
}

#[test]
fn packets_and_parts_are_those_of_the_pixels() {
    let mut session = open();
    session.start().unwrap();
    session.step().unwrap();
    let eye = find(&mut session, "/eye");
    let rgb = image(&mut session, &eye);
    assert_eq!(rgb.len(), 3 * 32 * 24);
    let grey = call(&mut session, "sim.getVisionSensorImg", &[eye.clone(), Value::Int(1)]);
    assert_eq!(grey[1], Value::List(vec![Value::Int(32), Value::Int(24)]));
    for (grey, p) in grey[0].as_bytes().unwrap().iter().zip(rgb.chunks(3)) {
        assert_eq!(u32::from(*grey), (u32::from(p[0]) + u32::from(p[1]) + u32::from(p[2])) / 3);
    }
    let ints = |x: i64, y: i64| Value::List(vec![Value::Int(x), Value::Int(y)]);
    let cut = [eye.clone(), Value::Int(2), Value::Real(0.5), ints(10, 8), ints(12, 8)];
    let cut = call(&mut session, "sim.getVisionSensorImg", &cut);
    let cut = cut[0].as_bytes().unwrap();
    assert_eq!(cut.len(), 4 * 12 * 8);
    for (k, p) in cut.chunks(4).enumerate() {
        let at = 3 * ((8 + k / 12) * 32 + 10 + k % 12);
        assert_eq!(p[..3], rgb[at..at + 3]);
        // the ball is nearer than the middle of 0.5 m … 4.5 m, the wall behind it
        assert_eq!(p[3] == 255, p[0] > 0, "pixel {k}: {p:?}");
    }
    let depths = |session: &mut Session, option: i64| -> Vec<f64> {
        let results = call(session, "sim.getVisionSensorDepth", &[eye.clone(), Value::Int(option)]);
        let bytes = results[0].as_bytes().unwrap().to_vec();
        bytes.chunks(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap()))).collect()
    };
    let (metres, shares) = (depths(&mut session, 1), depths(&mut session, 0));
    for (m, s) in metres.iter().zip(&shares) {
        assert!((0.5 + 4.0 * s - m).abs() < 1e-6);
    }
    let nearest = metres.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((1.9..1.92).contains(&nearest) && metres.iter().all(|m| *m < 2.91), "{nearest}");
    let packet = call(&mut session, "sim.readVisionSensor", std::slice::from_ref(&eye))[1].as_reals().unwrap();
    let channel = |c: usize| rgb.iter().skip(c).step_by(3).map(|x| f64::from(*x) / 255.0);
    for c in 0..3 {
        assert_eq!(packet[1 + c], channel(c).fold(1.0, f64::min));
        assert_eq!(packet[6 + c], channel(c).fold(0.0, f64::max));
        assert!((packet[11 + c] - channel(c).sum::<f64>() / 768.0).abs() < 1e-12);
    }
    assert!((packet[4] - (nearest - 0.5) / 4.0).abs() < 1e-6 && packet[14] < packet[9]);
    for (position, size) in [([25, 0], [8, 1]), ([0, 24], [1, 1]), ([-1, 0], [1, 1]), ([0, 0], [0, 3])] {
        let arguments =
            [eye.clone(), Value::Int(0), Value::Real(0.0), ints(position[0], position[1]), ints(size[0], size[1])];
        let words = refused(&mut session, "sim.getVisionSensorImg", &arguments);
        assert!(words.contains("is not in a picture of 32 × 24"), "{words}");
    }
    let ball = find(&mut session, "/ball");
    let words = refused(&mut session, "sim.getVisionSensorImg", &[ball]);
    assert!(words.contains("`/loose/ball` is no vision sensor: give a [[camera]]"), "{words}");
}

#[test]
fn a_sensor_sees_one_object_alone_when_asked() {
    let mut session = open();
    let (eye, ball, wall) = (find(&mut session, "/eye"), find(&mut session, "/ball"), find(&mut session, "/wall"));
    let kept = image(&mut session, &eye);
    let seen = |session: &mut Session, what: &Value| {
        let results = call(session, "sim.checkVisionSensor", &[eye.clone(), what.clone()]);
        (results[0].as_int().unwrap(), results[1].as_reals().unwrap()[4])
    };
    // the wall's front is 2.9 m away, the ball's 1.9 m
    let (is_seen, depth) = seen(&mut session, &wall);
    assert!(is_seen == 1 && (depth - 0.6).abs() < 1e-12, "{depth}");
    let (is_seen, depth) = seen(&mut session, &ball);
    // the nearest pixels are 28 mm beside its front point on either side: 8 mm behind it
    assert!(is_seen == 1 && (0.35..0.3525).contains(&depth), "{depth}");
    let frame = find(&mut session, "/lazy");
    assert_eq!(seen(&mut session, &frame), (0, 1.0));
    let alone = call(&mut session, "sim.checkVisionSensorEx", &[eye.clone(), ball, Value::Bool(true)]);
    assert_eq!(alone[0].as_reals().unwrap().len(), 3 * 32 * 24);
    assert_eq!(image(&mut session, &eye), kept);
}

#[test]
fn clients_write_pictures() {
    let mut session = open();
    let (eye, screen) = (find(&mut session, "/eye"), find(&mut session, "/screen"));
    assert_eq!(image(&mut session, &screen), [0x10, 0x20, 0x30].repeat(8));
    session.start().unwrap();
    let bytes: Vec<u8> = (0..24).collect();
    call(&mut session, "sim.setVisionSensorImg", &[screen.clone(), Value::Bytes(bytes.clone())]);
    let words = refused(&mut session, "sim.setVisionSensorImg", &[screen.clone(), Value::Bytes(vec![0; 23])]);
    assert!(words.contains("there are 23 bytes, expected 24"), "{words}");
    let ones = Value::List(vec![Value::Int(1), Value::Int(1)]);
    let grey = [screen.clone(), Value::Bytes(vec![200]), Value::Int(1), ones.clone(), ones];
    call(&mut session, "sim.setVisionSensorImg", &grey);
    call(&mut session, "sim.setVisionSensorImg", &[eye.clone(), Value::Bytes(vec![7; 3 * 32 * 24])]);
    assert_eq!(image(&mut session, &eye), [7; 3 * 32 * 24]);
    session.step().unwrap();
    // what looks by itself is drawn over, what clients write stays
    assert!(image(&mut session, &eye) != [7; 3 * 32 * 24]);
    let mut expected = bytes;
    expected[15..18].fill(200);
    assert_eq!(image(&mut session, &screen), expected);
    let state = call(&mut session, "sim.readVisionSensor", std::slice::from_ref(&screen));
    assert_eq!(state[0], Value::Int(0));
    session.stop().unwrap();
    assert_eq!(image(&mut session, &screen), [0x10, 0x20, 0x30].repeat(8));
}

#[test]
fn sensors_are_made_moved_and_removed() {
    let mut session = open();
    let mut floats = vec![0.1, 20.0, 60_f64.to_radians(), 0.05, 0.0, 0.0, 0.2, 0.4, 1.0, 0.0, 0.0];
    let make = |session: &mut Session, options: i64, sides: [i64; 2], floats: &[f64]| {
        let ints = Value::List([sides[0], sides[1], 0, 0].map(Value::Int).to_vec());
        session.call("sim.createVisionSensor", &[Value::Int(options), ints, Value::reals(floats.iter().copied())])
    };
    // explicit, perspective, a background of its own
    let sensor = make(&mut session, 1 + 2 + 128, [20, 10], &floats).unwrap().remove(0);
    assert_eq!(call(&mut session, "sim.getObjectType", std::slice::from_ref(&sensor))[0], Value::Int(9));
    assert_eq!(image(&mut session, &sensor)[..3], [51, 102, 255], "nothing is above the origin but the ball");
    // from the eye's place: what the eye sees, at another size
    let eye = find(&mut session, "/eye");
    let pose = call(&mut session, "sim.getObjectPose", &[eye.clone(), Value::Int(-1)]).remove(0);
    call(&mut session, "sim.setObjectPose", &[sensor.clone(), pose, Value::Int(-1)]);
    assert_eq!(height(&image(&mut session, &sensor), 20), 4.5);
    let words = make(&mut session, 2, [0, 10], &floats).unwrap_err().0;
    assert!(words.contains("a resolution of 0 × 10 pixels cannot be: expected 1 to 4096 columns"), "{words}");
    assert!(make(&mut session, 2, [100_000, 100_000], &floats).is_err());
    floats[2] = f64::NAN;
    assert!(make(&mut session, 2, [4, 4], &floats).unwrap_err().0.contains("a view angle of NaN rad cannot be"));
    assert!(make(&mut session, 0, [4, 4], &floats).is_err());
    floats[2] = 0.5;
    floats[0] = f64::NAN;
    assert!(make(&mut session, 2, [4, 4], &floats).is_err());
    floats[0] = 0.1;
    // 4 Mi pixels each, 16 Mi in all
    let large: Vec<Value> = (0..3).map(|_| make(&mut session, 2, [2048, 2048], &floats).unwrap().remove(0)).collect();
    let words = make(&mut session, 2, [2048, 2048], &floats).unwrap_err().0;
    assert!(words.contains("all vision sensors together would have more than 16777216 pixels"), "{words}");
    call(&mut session, "sim.removeObject", std::slice::from_ref(&large[0]));
    assert!(make(&mut session, 2, [2048, 2048], &floats).is_ok());
    call(&mut session, "sim.removeObject", &[eye]);
    assert!(refused(&mut session, "sim.copyPasteObjects", &[Value::List(vec![sensor])]).contains("is not copied"));
}

#[test]
fn parameters_of_a_sensor_are_those_of_its_lens_and_come_back_after_a_run() {
    let mut session = open();
    let eye = find(&mut session, "/eye");
    let float = |session: &mut Session, id: i64| {
        call(session, "sim.getObjectFloatParam", &[eye.clone(), Value::Int(id)])[0].as_real().unwrap()
    };
    let int = |session: &mut Session, id: i64| {
        call(session, "sim.getObjectInt32Param", &[eye.clone(), Value::Int(id)])[0].as_int().unwrap()
    };
    assert_eq!((float(&mut session, 1000), float(&mut session, 1001)), (0.5, 4.5));
    assert_eq!([1002, 1003, 1018].map(|id| int(&mut session, id)), [32, 24, 1]);
    // over the longer side, as V-REP has it
    let angle =
        2.0 * sincro_math::elementary::atan(32.0 / 24.0 * sincro_math::elementary::tan(19_f64.to_radians()).0).0;
    assert!((float(&mut session, 1004) - angle).abs() < 1e-12);
    session.start().unwrap();
    let set = |session: &mut Session, name: &str, id: i64, value: Value| {
        session.call(name, &[eye.clone(), Value::Int(id), value])
    };
    set(&mut session, "sim.setObjectFloatParam", 1004, Value::Real(0.7)).unwrap();
    set(&mut session, "sim.setObjectFloatParam", 1001, Value::Real(50.0)).unwrap();
    set(&mut session, "sim.setObjectInt32Param", 1002, Value::Int(64)).unwrap();
    assert!((float(&mut session, 1004) - 0.7).abs() < 1e-12, "the angle over the longer side stays");
    assert_eq!(image(&mut session, &eye).len(), 3 * 64 * 24);
    for (id, value) in [(1001, 0.4), (1000, f64::NAN), (1004, 3.2), (1004, f64::NAN)] {
        assert!(set(&mut session, "sim.setObjectFloatParam", id, Value::Real(value)).is_err(), "{id} {value}");
    }
    assert!(set(&mut session, "sim.setObjectInt32Param", 1003, Value::Int(-5)).is_err());
    assert_eq!(float(&mut session, 1001), 50.0, "as it was");
    set(&mut session, "sim.setObjectInt32Param", 1018, Value::Int(0)).unwrap();
    set(&mut session, "sim.setObjectFloatParam", 1005, Value::Real(3.0)).unwrap();
    assert_eq!((float(&mut session, 1005), int(&mut session, 1018)), (3.0, 0));
    call(&mut session, "sim.setObjectPosition", &[eye.clone(), Value::reals([9.0, 9.0, 9.0])]);
    session.stop().unwrap();
    assert_eq!([1002, 1003, 1018].map(|id| int(&mut session, id)), [32, 24, 1]);
    let position = call(&mut session, "sim.getObjectPosition", &[eye.clone(), Value::Int(-1)]);
    assert_eq!(position[0].as_reals().unwrap(), [0.0, -2.0, 1.0]);
}

#[test]
fn older_functions_give_the_same_pictures() {
    let mut session = open();
    session.start().unwrap();
    session.step().unwrap();
    let eye = find(&mut session, "/eye");
    let flagged = |flag: i64| Value::Int(eye.as_int().unwrap() + flag);
    let rgb = image(&mut session, &eye);
    let old = call(&mut session, "simGetVisionSensorCharImage", std::slice::from_ref(&eye));
    assert_eq!(old, [Value::Bytes(rgb.clone()), Value::Int(32), Value::Int(24)]);
    let numbers = call(&mut session, "simGetVisionSensorImage", std::slice::from_ref(&eye))[0].as_reals().unwrap();
    assert!(numbers.iter().zip(&rgb).all(|(x, byte)| (255.0 * x - f64::from(*byte)).abs() < 1e-9));
    let part = [flagged(0x40_0000), Value::Int(3), Value::Int(4), Value::Int(5), Value::Int(6)];
    assert_eq!(call(&mut session, "simGetVisionSensorCharImage", &part)[0].as_bytes().unwrap().len(), 30);
    let metres = call(&mut session, "simGetVisionSensorDepthBuffer", &[flagged(0x80_0000)]);
    let packed = call(&mut session, "simGetVisionSensorDepthBuffer", &[flagged(0x40_0000)]);
    assert_eq!((metres[0].as_reals().unwrap().len(), packed[0].as_bytes().unwrap().len()), (768, 4 * 768));
    let sides = call(&mut session, "simGetVisionSensorResolution", std::slice::from_ref(&eye));
    assert_eq!(sides, [Value::List(vec![Value::Int(32), Value::Int(24)])]);
    let screen = find(&mut session, "/screen");
    call(&mut session, "simSetVisionSensorImage", &[screen.clone(), Value::reals([1.0; 24])]);
    assert_eq!(image(&mut session, &screen), [255; 24]);
    call(&mut session, "simSetVisionSensorCharImage", &[screen.clone(), Value::Bytes(vec![3; 24])]);
    assert_eq!(image(&mut session, &screen), [3; 24]);
}

#[test]
fn pictures_are_turned_scaled_and_packed() {
    let mut session = open();
    let bytes = |results: Vec<Value>| results[0].as_bytes().unwrap().to_vec();
    let two = |x: i64, y: i64| Value::List(vec![Value::Int(x), Value::Int(y)]);
    // two columns, two rows: a b / c d
    let picture = Value::Bytes(vec![1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4]);
    let turned = |session: &mut Session, options: i64| {
        bytes(call(session, "sim.transformImage", &[picture.clone(), two(2, 2), Value::Int(options)]))
    };
    assert_eq!(turned(&mut session, 2), [2, 2, 2, 1, 1, 1, 4, 4, 4, 3, 3, 3]);
    assert_eq!(turned(&mut session, 4), [3, 3, 3, 4, 4, 4, 1, 1, 1, 2, 2, 2]);
    let large = [picture.clone(), two(2, 2), two(8, 4), Value::Int(16 + 2)];
    let large = call(&mut session, "sim.getScaledImage", &large);
    assert_eq!((large[0].as_bytes().unwrap().len(), large[1].clone()), (4 * 32, two(8, 4)));
    assert_eq!(large[0].as_bytes().unwrap()[16..20], [2, 2, 2, 255]);
    let kept = call(&mut session, "sim.getScaledImage", &[picture.clone(), two(2, 2), two(8, 4), Value::Int(4)]);
    assert_eq!(kept[1], two(4, 4));
    let same = call(&mut session, "sim.getScaledImage", &[picture.clone(), two(2, 2), two(2, 2), Value::Int(0)]);
    assert_eq!(same[0], picture);
    let save = |name: &str| [picture.clone(), two(2, 2), Value::Int(0), Value::from(name), Value::Int(-1)];
    let png = bytes(call(&mut session, "sim.saveImage", &save(".png")));
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    let words = refused(&mut session, "sim.saveImage", &save("/tmp/x.png"));
    assert!(words.contains("`sincro serve --grant files`"), "{words}");
    let floats: Vec<u8> = [0.5_f32, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let changed = [Value::Bytes(floats), Value::Int(6), Value::Real(100.0), Value::Real(1.0), Value::Int(0)];
    assert_eq!(bytes(call(&mut session, "sim.transformBuffer", &changed)), [51, 101]);
    let words = refused(&mut session, "sim.transformImage", &[picture.clone(), two(3, 2), Value::Int(0)]);
    assert!(words.contains("the picture has 12 bytes, expected 3·2·3 = 18"), "{words}");
    assert!(
        refused(&mut session, "sim.getScaledImage", &[picture, two(2, 2), two(1, 1 << 40), Value::Int(0)])
            .contains("cannot be")
    );
}

#[test]
fn a_client_saves_pictures_where_files_are_granted() {
    let around = SceneFolder::new();
    let mut session = open();
    session.grant(Grants { files: Some(Files::new(around.join("received"))), evaluation: false });
    let picture = Value::Bytes(vec![7; 12]);
    let save =
        |name: &str| [picture.clone(), Value::reals([2.0, 2.0]), Value::Int(0), Value::from(name), Value::Int(-1)];
    assert_eq!(call(&mut session, "sim.saveImage", &save("/tmp/seen.png")), [Value::Int(1)]);
    let file = std::fs::read(around.join("received").join("seen.png")).unwrap();
    assert!(file.starts_with(b"\x89PNG"));
    assert!(refused(&mut session, "sim.saveImage", &save("a/..")).contains("not written as"));
}

#[test]
fn the_sensor_of_the_example_scene_has_a_handle_that_is_its_own() {
    let folder = repository_scene("camera-stream");
    let mut session = Session::open(&folder, &[], with_scripts(), None).unwrap();
    let handles = ["/VisionSensor", "/PassiveVisionSensor"]
        .map(|name| session.sim().registry.find(name, Search::default()).unwrap());
    assert_eq!(session.sim().objects_of_type(9), handles);
    assert_eq!(handles, [Handle(1), Handle(2)]);
}

#[test]
fn a_sensor_shows_the_entity_that_it_has_and_no_hidden_objects() {
    let mut session = open();
    let (eye, ball, wall) = (find(&mut session, "/eye"), find(&mut session, "/ball"), find(&mut session, "/wall"));
    let whole = image(&mut session, &eye);
    let show = |session: &mut Session, entity: &Value| {
        call(session, "sim.setObjectInt32Param", &[eye.clone(), 1008_i64.into(), entity.clone()]);
        let shown = call(session, "sim.getObjectInt32Param", &[eye.clone(), 1008_i64.into()]);
        assert_eq!(shown, std::slice::from_ref(entity));
        image(session, &eye)
    };
    let (alone, wall_alone) = (show(&mut session, &ball), show(&mut session, &wall));
    assert!(alone != whole && wall_alone != whole && alone != wall_alone);
    assert_eq!(show(&mut session, &Value::Int(-1)), whole);
    // hidden by its flag, its layer, its model
    let layer = |session: &mut Session, value: i64| {
        call(session, "sim.setObjectInt32Param", &[ball.clone(), 10_i64.into(), value.into()]);
    };
    call(&mut session, "sim.setBoolProperty", &[ball.clone(), "renderable".into(), false.into()]);
    assert_eq!(image(&mut session, &eye), wall_alone);
    call(&mut session, "sim.setBoolProperty", &[ball.clone(), "renderable".into(), true.into()]);
    assert_eq!(image(&mut session, &eye), whole);
    for hidden in [0, 0x100] {
        layer(&mut session, hidden);
        assert_eq!(image(&mut session, &eye), wall_alone);
    }
    layer(&mut session, 1);
    assert_eq!(call(&mut session, "sim.getIntProperty", &[ball.clone(), "layer".into()]), [Value::Int(1)]);
    call(&mut session, "sim.setModelProperty", &[ball.clone(), 0x100_i64.into()]);
    assert_eq!(image(&mut session, &eye), wall_alone);
    let words = refused(&mut session, "sim.setObjectInt32Param", &[eye.clone(), 1008_i64.into(), 55_555_i64.into()]);
    assert!(words.contains("no object or collection"), "{words}");
}

//! Behaviour over the wire that programs of V-REP and CoppeliaSim rely on.

use std::net::TcpStream;

use sincro_coppelia::api::Value;
use sincro_testing::clients::legacy::{Client as Legacy, ints};
use sincro_testing::clients::zmq::{Client as Zmq, field};
use sincro_testing::{free_port, options, scenes, with_scripts};

use super::scene::serve;

#[test]
fn the_force_of_a_joint_is_zero_before_the_first_step_and_without_a_motor() {
    let folder = scenes::two_link_arm("");
    let free = "[[joint]]\nname = \"free\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n\n[[body]]\nname = \"rod\"\nparent = \"/free\"\nmass = 1.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n";
    folder.write("scene.toml", &format!("{}\n{free}", scenes::TWO_LINK_ARM));
    let server = folder.session(sincro_sim::Extensions::default(), None).serve(&options());
    let mut client = Legacy::connect(server.ports().legacy[0]);
    for joint in ["joint1", "joint2", "free"] {
        let handle = client.handle(joint);
        assert_eq!(client.call(0x100d, &ints(&[handle]), &[]).unwrap().float(0), 0.0, "{joint}");
    }
    client.start();
    client.trigger().unwrap();
    let joint = client.handle("joint1");
    assert!((client.call(0x100d, &ints(&[joint]), &[]).unwrap().float(0) + 9.81).abs() < 1e-5);
}

#[test]
fn relative_paths_of_clients_begin_at_the_world() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("a"));
    assert_eq!(client.object("./ball"), client.object("/ball"));
    assert_eq!(client.object("./joint1/link1"), client.object("/link1"));
    assert!(client.call("sim.getObject", &["./nothing".into()]).unwrap_err().contains("does not exist"));
    assert!(client.call("sim.getObject", &[".".into()]).unwrap_err().contains("none asks"));
}

#[test]
fn strings_reach_clients_of_version_1_as_text_and_images_as_bytes() {
    let server = serve();
    let address = server.ports().zmq.unwrap();
    let mut second = Zmq::connect(address, Some("b"));
    second.call("sim.setStringSignal", &["s".into(), "words".into()]).unwrap();
    let mut first = Zmq::connect(address, None);
    let text = first.exchange("sim.getStringSignal", &["s".into()]);
    assert_eq!(field(&text, "ret"), Some(&Value::List(vec!["words".into()])));
    let packed = first.exchange("sim.packUInt8Table", &[Value::List(vec![Value::Int(65)])]);
    assert_eq!(field(&packed, "ret"), Some(&Value::List(vec![Value::Bytes(b"A".to_vec())])));
    let eye = second.object("/eye");
    let image = first.exchange("sim.getVisionSensorImg", &[eye]);
    assert!(matches!(field(&image, "ret"), Some(Value::List(list)) if matches!(list[0], Value::Bytes(_))));
    second.call("sim.setStringSignal", &["s".into(), Value::Bytes(vec![0xff, 0])]).unwrap();
    let bytes = first.exchange("sim.getStringSignal", &["s".into()]);
    assert_eq!(field(&bytes, "ret"), Some(&Value::List(vec![Value::Bytes(vec![0xff, 0])])));
    assert_eq!(second.call("sim.getStringSignal", &["s".into()]).unwrap(), [Value::Bytes(vec![0xff, 0])]);
}

#[test]
fn callbacks_of_motions_have_no_arguments_that_nobody_gave() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("c"));
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    let two = |x: f64| Value::reals([x, x]);
    let given = |data: Value| {
        let callback = Value::from("moved@func");
        let [zero, limit] = [two(0.0), two(5.0)];
        vec![
            Value::Int(-1),
            zero.clone(),
            zero.clone(),
            zero,
            limit.clone(),
            limit.clone(),
            limit,
            two(1.0),
            two(0.0),
            callback,
            data,
        ]
    };
    for (data, n) in [(Value::Nil, 3), (Value::Int(7), 4)] {
        let answer = client.exchange("sim.moveToConfig", &given(data));
        let Some(Value::List(arguments)) = field(&answer, "args") else { panic!("{answer:?}") };
        assert_eq!(arguments.len(), n);
        // true stops the motion
        let answer = client.exchange("_*executed*_", &[Value::Bool(true)]);
        assert!(field(&answer, "ret").is_some(), "{answer:?}");
    }
}

#[test]
fn modules_are_told_and_maps_of_handles_have_numbers_as_keys() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("d"));
    let info = client.call("zmqRemoteApi.info", &["simUI".into()]).unwrap().remove(0);
    assert!(field(&info, "create").is_some() && field(&info, "setLabelText").is_some());
    let ui = client.call("simUI.create", &["<ui></ui>".into()]).unwrap().remove(0);
    client.call("simUI.setSpinboxValue", &[ui.clone(), Value::Int(3), Value::Real(2.5)]).unwrap();
    assert_eq!(client.call("simUI.getSpinboxValue", &[ui, Value::Int(3)]).unwrap(), [Value::Real(2.5)]);
    let (tip, ball) = (client.object("/link2"), client.object("/ball"));
    let env = client.call("simIK.createEnvironment", &[]).unwrap().remove(0);
    let group = client.call("simIK.createGroup", std::slice::from_ref(&env)).unwrap().remove(0);
    let element = [env, group, Value::Int(-1), tip.clone(), ball, Value::Int(7)];
    let results = client.call("simIK.addElementFromScene", &element).unwrap();
    let key = tip.as_int().unwrap().to_string();
    assert_eq!(field(&results[1], &key), Some(&tip), "{results:?}");
}

#[test]
fn a_script_has_a_port_of_the_legacy_api_opened() {
    let port = free_port();
    let folder = scenes::two_link_arm("");
    let script = format!(
        "[[script]]\nobject = \"/joint1\"\ncode = '''\nfunction sysCall_init()\n  print('answers', simRemoteApi.start({port}), simExtRemoteApiStart(80), (simRemoteApi.status({port})), (simRemoteApi.status(80)), simRemoteApi.stop({port}))\nend\n'''\n"
    );
    folder.write("scene.toml", &format!("{}\n{script}", scenes::TWO_LINK_ARM));
    let server = folder.session(with_scripts(), None).serve(&options());
    assert!(TcpStream::connect(("127.0.0.1", port)).is_err(), "nobody has asked yet");
    let mut client = Legacy::connect(server.ports().legacy[0]);
    client.start();
    client.trigger().unwrap();
    let mut other = Legacy::connect(([127, 0, 0, 1], port).into());
    assert_eq!(other.ping(), 40_501);
    assert!(other.handle("joint1") > 0);
    client.simulation(2);
    let lines: Vec<String> = server
        .events()
        .try_iter()
        .filter_map(|event| match event {
            sincro_remote::hub::Event::Log(_, line) => Some(line),
            sincro_remote::hub::Event::Finished(_) => None,
        })
        .collect();
    assert!(
        lines.iter().any(|line| line.contains(&format!("port {port}")) && line.contains("was opened")),
        "{lines:?}"
    );
    assert!(lines.iter().any(|line| line.contains("answers\t1\t-1\t1\t-1\t-1")), "{lines:?}");
    assert!(lines.iter().any(|line| line.contains("port 80") && line.contains("is not opened")), "{lines:?}");
}

#[test]
fn clients_of_a_port_without_a_trigger_do_not_step() {
    let (plain, triggered) = (free_port(), free_port());
    let folder = scenes::two_link_arm("");
    let script = format!(
        "[[script]]\nobject = \"/joint1\"\ncode = '''\nfunction sysCall_init()\n  simRemoteApi.start({plain})\n  simRemoteApi.start({triggered}, 1300, false, true)\nend\n'''\n"
    );
    folder.write("scene.toml", &format!("{}\n{script}", scenes::TWO_LINK_ARM));
    let server = folder.session(with_scripts(), None).serve(&options());
    let mut first = Legacy::connect(server.ports().legacy[0]);
    first.start();
    first.trigger().unwrap();
    let mut stepping = Legacy::connect(([127, 0, 0, 1], triggered).into());
    stepping.call(0x0001, &[], &[]).unwrap();
    let mut free = Legacy::connect(([127, 0, 0, 1], plain).into());
    assert!(free.call(0x0001, &[], &[]).is_err() && free.trigger().is_err());
    let why = free.last_errors();
    assert!(why.iter().all(|line| line.contains("started without a trigger")) && why.len() == 2, "{why:?}");
    // nothing waits for it: the one that steps goes on
    first.call(0x0002, &[], &[]).unwrap();
    let before = stepping.trigger().unwrap().time;
    assert!(stepping.trigger().unwrap().time > before);
}

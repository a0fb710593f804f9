//! Contacts, force sensors, stops, files: a box on a floor, a load on a force sensor, an arm between stops.

use sincro_coppelia::api::{Search, Value};
use sincro_coppelia::session::{Files, Grants, Session};
use sincro_sim::Extensions;

use super::scene::options;
use sincro_testing::clients::legacy::{Client, ints, text};
use sincro_testing::clients::zmq::Client as Zmq;
use sincro_testing::scenes::TOUCHING;
use sincro_testing::{OpenSession, SceneFolder, ServedSession};

const EXPERIMENT: &str = r#"
title = "Touching"
duration = 1.0
step = 0.005
record = ["/loose.position.z", "float_signal.thrust"]
"#;

fn session() -> OpenSession {
    SceneFolder::of(TOUCHING, EXPERIMENT).session(Extensions::default(), None)
}

fn serve(grants: Grants) -> ServedSession {
    let mut session = session();
    session.grant(grants);
    session.serve(&options())
}

/// The whole weight of the box [N].
const WEIGHT: f64 = 9.81;

#[test]
fn what_touches_is_told_to_clients() {
    let server = serve(Grants::default());
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("touch"));
    let [floor, box_, scale, arm, load] = ["/floor", "/box", "/scale", "/arm", "/load"].map(|p| client.object(p));
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    client.call("sim.step", &[Value::Int(20)]).unwrap();

    let (mut lift, mut n) = (0.0, 0);
    loop {
        let args = [Value::Int(-2), box_.clone(), Value::Int(n)];
        let contact = client.call("sim.getContactInfo", &args).unwrap();
        let Value::List(bodies) = &contact[0] else { break };
        let [force, normal] = [2, 3].map(|k: usize| contact[k].as_reals().unwrap());
        let sign = if bodies[0] == box_ { 1.0 } else { -1.0 };
        lift += sign * force[2];
        assert!((sign * normal[2] - 1.0).abs() < 1e-9, "the normal goes from the second body to the first");
        assert!(contact[1].as_reals().unwrap()[2].abs() < 1e-6, "on the floor");
        n += 1;
    }
    assert!(n >= 3 && (lift - WEIGHT).abs() < 1e-6, "{n} contacts carry {lift} N");
    let touch = |client: &mut Zmq, a: &Value, b: &Value| client.call("sim.checkCollision", &[a.clone(), b.clone()]);
    assert_eq!(touch(&mut client, &floor, &box_).unwrap()[0], Value::Int(1));
    assert_eq!(touch(&mut client, &box_, &Value::Int(-2)).unwrap()[0], Value::Int(1));
    assert!(touch(&mut client, &floor, &load).unwrap_err().contains("`/scale/load` has no shape"), "nothing to meet");

    // what it carries pulls it down, and tips it about y
    let reading = client.call("sim.readForceSensor", std::slice::from_ref(&scale)).unwrap();
    let [force, torque] = [1, 2].map(|k: usize| reading[k].as_reals().unwrap());
    assert!((force[2] + 2.0 * 9.81).abs() < 1e-9 && (torque[1] - 0.1 * 2.0 * 9.81).abs() < 1e-9, "{reading:?}");
    assert_eq!(client.call("sim.getObjectType", &[scale]).unwrap(), [Value::Int(12)]);
    assert!(
        client.call("sim.readForceSensor", std::slice::from_ref(&arm)).unwrap_err().contains("force_sensor = true")
    );

    let interval = client.call("sim.getJointInterval", std::slice::from_ref(&arm)).unwrap();
    assert_eq!(interval, [Value::Bool(false), Value::reals([-0.5, 1.5])]);
    let dependency = client.call("sim.getJointDependency", &[arm]).unwrap();
    assert_eq!(dependency, [Value::Int(-1), Value::Real(0.0), Value::Real(1.0)]);
    client.call("sim.setFloatSignal", &[Value::from("thrust"), Value::Real(2.5)]).unwrap();
    client.call("sim.addLog", &[Value::Int(300), Value::from("client says")]).unwrap();
    client.call("sim.step", &[Value::Int(2)]).unwrap();
    client.call("sim.stopSimulation", &[]).unwrap();
    let run = super::scene::finished(&server).simulated;
    let thrust = &run.table.column("float_signal.thrust").unwrap().values;
    assert!(thrust[..21].iter().all(|x| x.is_nan()) && thrust[21..] == [2.5; 2], "{thrust:?}");
    let said: Vec<(&str, &str)> = run.messages.iter().map(|m| (m.object.as_str(), m.text.as_str())).collect();
    assert_eq!(said, [("client", "client says")]);
}

#[test]
fn what_touches_is_told_to_legacy_clients() {
    let server = serve(Grants::default());
    let mut client = Client::connect(server.ports().legacy[0]);
    let [floor, box_, scale, load] = ["floor", "box", "scale", "load"].map(|name| client.handle(name));
    client.start();
    for _ in 0..20 {
        client.trigger().unwrap();
    }
    assert_eq!(client.call(0x200f, &ints(&[floor, box_]), &[]).unwrap().int(0), 1);
    assert!(client.call(0x200f, &ints(&[floor, load]), &[]).is_err());
    let reading = client.call(0x100f, &ints(&[scale]), &[]).unwrap().data;
    let number = |at: usize| f32::from_le_bytes(reading[at..at + 4].try_into().unwrap());
    assert_eq!((reading.len(), reading[0]), (25, 1));
    assert!((number(9) + 19.62).abs() < 1e-5 && (number(17) - 1.962).abs() < 1e-5, "force z, torque y");
    let group = client.call(0x200c, &ints(&[12, 14]), &[]).unwrap();
    assert_eq!([0, 4, 8, 12, 16].map(|at| group.int(at)), [1, 1, 6, 0, scale], "one force sensor");
    let limits = client.call(0x200c, &ints(&[1, 16]), &[]).unwrap();
    let at = 16 + 4 * (limits.int(0) + limits.int(4)) as usize;
    assert_eq!((limits.float(at / 4), limits.float(at / 4 + 1)), (-0.5, 1.5));
    // a copy of a point, and of the scene's own
    let point = client.call(0x0009, &[], &[0; 17]).unwrap().int(0);
    let copy = client.call(0x102e, &ints(&[1]), &ints(&[point])).unwrap();
    assert_eq!(copy.int(0), 1);
    assert_ne!(copy.int(4), point);
    let copy = client.call(0x102e, &ints(&[1]), &ints(&[box_])).unwrap().int(4);
    assert!(client.call(0x1028, &ints(&[copy]), &[]).is_ok());
    assert!(client.call(0x1028, &ints(&[copy]), &[]).is_err());
    client.last_errors();
    // a model that is not visible, and none that is not dynamic
    client.call(0x1035, &ints(&[box_]), &ints(&[0x100])).unwrap();
    assert_eq!(client.call(0x1034, &ints(&[box_]), &[]).unwrap().int(0), 0x100);
    assert!(client.call(0x1035, &ints(&[box_]), &ints(&[0x20])).is_err());
    assert!(client.last_errors()[0].contains("not dynamic"));
    let refused = [
        (0x1003, "vision"),
        (0x1004, "vision"),
        (0x1005, "vision"),
        (0x1006, "vision"),
        (0x1009, "proximity"),
        (0x100b, "is no spherical joint"),
        (0x1011, "vision"),
        (0x1017, "vision"),
        (0x101e, "vector parameter"),
        (0x1026, "no collision object"),
        (0x1027, "no distance object"),
        (0x1029, "user interfaces"),
        (0x102b, "dialog"),
        (0x102c, "dialog"),
        (0x102d, "dialog"),
        (0x2001, "user interfaces"),
        (0x2006, "user interfaces"),
        (0x2010, "no shape"),
        (0x3003, "there is no model"),
        (0x3004, "--grant files"),
        (0x3005, "user interfaces"),
        (0x3006, "--grant files"),
        (0x3007, "user interfaces"),
        (0x300a, "sim.createCollisionObject"),
        (0x300b, "sim.createDistanceObject"),
        (0x300c, "dialog"),
        (0x3019, "no such collection"),
    ];
    for (function, why) in refused {
        let ident = if function >= 0x3000 { text("x") } else { ints(&[scale, scale]) };
        assert!(client.call(function, &ident, &[0; 64]).is_err(), "0x{function:04x}");
        let errors = client.last_errors();
        assert!(errors.len() == 1 && errors[0].contains(why), "0x{function:04x}: {errors:?}");
    }
    // consoles are taken without effect
    let console = client.call(0x3009, &text("console"), &[0; 32]).unwrap().int(0);
    for function in [0x1014, 0x1015, 0x1016] {
        client.call(function, &ints(&[console]), &[0; 8]).unwrap();
    }
    assert!(client.call(0x1010, &ints(&[floor]), &[]).is_err());
    assert!(client.last_errors()[0].contains("is no force sensor"));
    assert!(client.call(0x1010, &ints(&[scale]), &[]).is_ok());
    assert_eq!(client.ping(), 40_501, "the connection lives on");
}

#[test]
fn files_are_sent_where_that_is_granted_and_nowhere_else() {
    let around = SceneFolder::new();
    let received = around.join("received");
    let grants = Grants { files: Some(Files::new(received.clone())), evaluation: false };
    let server = serve(grants);
    let mut client = Client::connect(server.ports().legacy[0]);
    client.call(0x3004, &text("notes.txt"), b"hello").unwrap();
    assert_eq!(std::fs::read(received.join("notes.txt")).unwrap(), b"hello");
    client.call(0x3004, &text("C:\\temp\\..\\far/notes.txt"), b"again").unwrap();
    assert_eq!(std::fs::read(received.join("notes.txt")).unwrap(), b"again", "the last part of a path is its name");
    client.call(0x3006, &text("notes.txt"), &[]).unwrap();
    assert!(client.call(0x3006, &text("notes.txt"), &[]).is_err());
    for name in ["..", "", ".hidden", "a\u{1}b", "/etc/.."] {
        assert!(client.call(0x3004, &text(name), b"x").is_err(), "{name:?}");
        assert!(client.call(0x3006, &text(name), b"x").is_err(), "{name:?}");
    }
    assert!(!received.parent().unwrap().join("hidden").exists());

    // what somebody else has put there is neither erased nor written over, and no link is followed
    std::fs::write(received.join("mine.txt"), "precious").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(received.join("mine.txt"), received.join("link.txt")).unwrap();
    for name in ["mine.txt", "link.txt"] {
        assert!(client.call(0x3004, &text(name), b"x").is_err() && client.call(0x3006, &text(name), b"x").is_err());
    }
    assert_eq!(std::fs::read(received.join("mine.txt")).unwrap(), b"precious");
    for name in ["mine.txt", "link.txt"] {
        std::fs::remove_file(received.join(name)).unwrap();
    }
    // a scene that names a file outside is refused before anything of that file could be told
    around.write("secret.toml", "API_KEY = sk-12345");
    client.call(0x3004, &text("scene.toml"), TOUCHING.as_bytes()).unwrap();
    for diagram in ["../secret.toml", "./\\u002e./secret.toml", "a/../../secret.toml"] {
        let experiment = format!("diagram = \"{diagram}\"\n{EXPERIMENT}");
        client.call(0x3004, &text("experiment.toml"), experiment.as_bytes()).unwrap();
        assert!(client.call(0x3002, &text("experiment.toml"), &[]).is_err(), "{diagram}");
        let errors = client.last_errors();
        let told = errors.iter().any(|e| e.contains("which no client has sent"));
        assert!(told && !errors.iter().any(|e| e.contains("API_KEY")), "{diagram}: {errors:?}");
    }

    // a scene that was sent is loaded; one that takes what was not sent is not, nor one of V-REP
    client.call(0x3004, &text("scene.toml"), TOUCHING.replace("arm", "leg").as_bytes()).unwrap();
    client.call(0x3004, &text("experiment.toml"), EXPERIMENT.as_bytes()).unwrap();
    client.call(0x3002, &text("experiment.toml"), &[]).unwrap();
    client.handle("leg");
    let served = server.folder().file_name().unwrap().to_str().unwrap();
    let outside = format!("scene = \"../../{served}/scene.toml\"\n{EXPERIMENT}");
    client.call(0x3004, &text("experiment.toml"), outside.as_bytes()).unwrap();
    assert!(client.call(0x3002, &text("experiment.toml"), &[]).is_err());
    client.call(0x3004, &text("REMOTE_API_TEMPFILE_0001.ttt"), b"VREP\0\x01binary").unwrap();
    assert!(client.call(0x3002, &text("REMOTE_API_TEMPFILE_0001.ttt"), &[]).is_err());
    let errors = client.last_errors();
    assert!(errors.iter().any(|e| e.contains("which no client has sent")), "{errors:?}");
    client.handle("leg");
    for k in 0..300 {
        let sent = client.call(0x3004, &text(&format!("{k}.txt")), b"x");
        assert_eq!(sent.is_ok(), k < 197, "file {k}: 200 with the three that are there");
    }
}

#[test]
fn looking_at_contacts_and_force_sensors_changes_nothing() {
    let trace = |looks: bool| {
        let mut session = session();
        let find = |session: &mut Session, name: &str| session.registry().find(name, Search::default()).unwrap();
        let [body, scale] = ["/box", "/scale"].map(|name| find(&mut session, name));
        session.start().unwrap();
        for k in 0..150 {
            // it slides, tips a little, comes to rest
            let force = if k < 60 { [8.0, 1.0, 0.5] } else { [0.0; 3] };
            session.sim().add_force_and_torque(body, force, [0.02, 0.0, 0.01]).unwrap();
            if looks && k % 3 != 1 {
                assert!(session.sim().contact_points().len() <= 8);
                session.sim().force_sensor(scale).unwrap();
            }
            session.step().unwrap();
        }
        session.trace().unwrap()
    };
    assert_eq!(trace(false), trace(true));
}

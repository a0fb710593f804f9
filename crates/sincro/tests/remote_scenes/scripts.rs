//! Clients and the scripts of a scene: functions that are called, texts that are run where that is granted, inverse
//! kinematics.

use sincro_coppelia::api::Value;
use sincro_coppelia::session::{Files, Grants};
use sincro_remote::Server;
use sincro_testing::clients::zmq::Client as Zmq;
use sincro_testing::{OpenSession, SceneFolder, ServedSession, finished, options, with_scripts};

const SCENE: &str = r#"
[[joint]]
name = "first"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
motor = { mode = "position", kp = 20.0 }
[[body]]
name = "arm"
parent = "/first"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[joint]]
name = "second"
parent = "/first/arm"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
position = [0.5, 0.0, 0.0]
motor = { mode = "position", kp = 20.0 }
initial = { position = 0.5 }
[[body]]
name = "hand"
parent = "/first/arm/second"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[frame]]
name = "tip"
parent = "/first/arm/second/hand"
position = [0.5, 0.0, 0.0]
[[script]]
object = "/first/arm"
max_instructions = 100000
code = """
secret = 42
function sysCall_sensing() sim.setFloatSignal('angle', sim.getJointPosition(sim.getObject('/first'))) end
function twice(x) return 2 * x end
function endless() while true do end end
"""
"#;

const EXPERIMENT: &str = r#"
title = "Scripts and clients"
duration = 5.0
step = 0.01
record = ["/first.position", "float_signal.angle"]
"#;

fn session() -> OpenSession {
    SceneFolder::of(SCENE, EXPERIMENT).session(with_scripts(), None)
}

fn serve(evaluation: bool) -> ServedSession {
    let mut session = session();
    session.grant(Grants { files: None, evaluation });
    session.serve(&options())
}

fn client(server: &Server) -> Zmq {
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("scripts"));
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    client
}

#[test]
fn texts_of_clients_are_run_only_where_that_is_granted() {
    let server = serve(false);
    let mut other = client(&server);
    let arm = other.object("/arm");
    let refused = other.call("sim.executeScriptString", &[Value::from("return secret"), arm]).unwrap_err();
    assert!(refused.contains("--grant scripts"), "{refused}");

    let server = serve(true);
    let mut client = client(&server);
    let arm = client.object("/arm");
    let mut run = |text: &str| client.call("sim.executeScriptString", &[Value::from(text), arm.clone()]);
    assert_eq!(run("return secret, twice(4), 2 ^ 10").unwrap(), [Value::Int(42), Value::Int(8), Value::Real(1024.0)]);
    run("secret = 43; print('from outside')").unwrap();
    assert_eq!(run("return secret").unwrap(), [Value::Int(43)]);
    assert!(run("return os.execute('true')").unwrap_err().contains("not allowed"));
    assert!(run("return io.open('/etc/passwd')").unwrap_err().contains("not allowed"));
    assert!(run("this is no Lua").is_err());
    assert!(run("while true do end").unwrap_err().contains("instructions"));
    assert!(run("pcall(function() while true do end end) return 1").is_err(), "pcall does not catch it");
    // texts that compile texts within each other, as deep as Lua lets them: the thread's stack holds them
    let nested = "local function f(n) return load(function() f(n + 1) return nil end) end f(0) return 7";
    assert!(run(nested).is_ok() || run(nested).unwrap_err().contains("stack overflow"));
    // the compiler is quadratic in what it has to jump over
    let jumps = "return load('local a = 1 return ' .. string.rep('a and ', 170000) .. 'a') == nil";
    assert!(run(jumps).unwrap_err().contains("instructions"));
    assert_eq!(run("return secret").unwrap(), [Value::Int(43)], "the script lives on");
    let named = [Value::from("return secret@arm"), Value::Int(1)];
    assert_eq!(client.call("sim.executeScriptString", &named).unwrap(), [Value::Int(43)]);
    let missing = client.call("sim.executeScriptString", &[Value::from("x = 1"), Value::Int(1)]).unwrap_err();
    assert!(missing.contains("there is no script on that object"), "{missing}");
    let twice = client.call("sim.callScriptFunction", &[Value::from("twice"), arm.clone(), Value::Int(21)]).unwrap();
    assert_eq!(twice, [Value::Int(42)]);
    let endless = [Value::from("endless"), arm];
    assert!(client.call("sim.callScriptFunction", &endless).unwrap_err().contains("instructions"));
    client.call("sim.step", &[Value::Int(3)]).unwrap();
    client.call("sim.stopSimulation", &[]).unwrap();
    let run = finished(&server).simulated;
    assert!(run.messages.iter().any(|m| m.object == "/first/arm" && m.text == "from outside"), "{:?}", run.messages);
    let (joint, signal) =
        (&run.table.column("/first.position").unwrap().values, &run.table.column("float_signal.angle").unwrap().values);
    assert!(signal[0].is_nan() && signal[1..] == joint[1..], "{signal:?}");
}

#[test]
fn a_sent_scene_has_scripts_only_where_these_are_granted_and_within_the_limits_of_the_server() {
    let script =
        |more: &str| format!("[[script]]\nobject = \"/first\"\n{more}\ncode = \"function sysCall_init() end\"\n");
    let plain = SCENE.split("[[script]]").next().unwrap();
    for (evaluation, more, refusal) in [
        (false, "", Some("script")),
        (true, "", None),
        (true, "max_instructions = 9000000000000000000", Some("asks for too much")),
        (true, "max_memory_mib = 1000000", Some("asks for too much")),
    ] {
        let around = SceneFolder::new();
        let mut session = session();
        session.grant(Grants { files: Some(Files::new(around.join("sent"))), evaluation });
        session.files().unwrap().put("scene.toml", format!("{plain}{}", script(more)).as_bytes()).unwrap();
        session.files().unwrap().put("experiment.toml", EXPERIMENT.as_bytes()).unwrap();
        let loaded = session.load("experiment.toml");
        match refusal {
            None => assert!(loaded.is_ok(), "{loaded:?}"),
            Some(words) => assert!(loaded.unwrap_err().0.contains(words), "{more}"),
        }
    }
}

#[test]
fn a_client_solves_inverse_kinematics() {
    let server = serve(false);
    let mut client = client(&server);
    client.call("zmqRemoteApi.require", &[Value::from("simIK")]).unwrap();
    let info = client.call("zmqRemoteApi.info", &[Value::from("simIK")]).unwrap();
    let Value::Map(members) = &info[0] else { panic!("{info:?}") };
    for name in ["handleGroup", "createIkEnvironment", "constraint_x"] {
        assert!(members.iter().any(|(member, _)| member == name), "{name}");
    }
    let tip = client.object("/tip");
    let target = client.call("sim.createDummy", &[Value::Real(0.01)]).unwrap().remove(0);
    let at = [target.clone(), Value::reals([0.3, 0.6, 0.0])];
    client.call("sim.setObjectPosition", &at).unwrap();
    let env = client.call("simIK.createEnvironment", &[]).unwrap().remove(0);
    let group = client.call("simIK.createGroup", std::slice::from_ref(&env)).unwrap().remove(0);
    let how = [env.clone(), group.clone(), Value::Int(0), Value::Real(0.0), Value::Int(100)];
    client.call("simIK.setGroupCalculation", &how).unwrap();
    let add = [env.clone(), group.clone(), Value::Int(-1), tip.clone(), target, Value::Int(3)];
    client.call("simIK.addElementFromScene", &add).unwrap();
    let options = Value::Map(vec![("syncWorlds".into(), Value::Bool(true))]);
    let solved = client.call("simIK.handleGroup", &[env, group.clone(), options]).unwrap();
    assert_eq!(solved[0], Value::Int(1), "{solved:?}");
    // the motors go there
    client.call("sim.step", &[Value::Int(100)]).unwrap();
    let p = client.call("sim.getObjectPosition", &[tip]).unwrap()[0].as_reals().unwrap();
    assert!((p[0] - 0.3).abs() < 1e-3 && (p[1] - 0.6).abs() < 1e-3, "{p:?}");
    let wrong = client.call("simIK.handleGroup", &[Value::Int(5), group]).unwrap_err();
    assert!(wrong.contains("there is no environment 5") && wrong.contains("simIK.handleGroup"), "{wrong}");
    assert!(client.call("simIK.nothing", &[]).unwrap_err().contains("No such function: simIK.nothing"));
}

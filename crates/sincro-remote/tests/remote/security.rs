//! Attacks on the ports, from pages and from programs: who is refused, who is closed, and that a client that steps
//! notices nothing. Each line of the tables in `docs/security.md` that concerns the remote APIs has its test here.

use std::io::{Read, Write};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use sincro_coppelia::api::Value;
use sincro_remote::limits::{Deadlines, PER_ADDRESS};
use sincro_remote::{Options, Server};

use super::scene::{finished, options, serve, serve_with, session};
use sincro_testing::clients::legacy::Client as Legacy;
use sincro_testing::clients::ws::Client as Ws;
use sincro_testing::clients::zmq::Client as Zmq;
use sincro_testing::{SceneFolder, scenes, with_scripts};

/// Deadlines that a test can wait for.
const SHORT: Deadlines = Deadlines {
    handshake: Duration::from_millis(600),
    read: Duration::from_millis(600),
    write: Duration::from_millis(600),
    idle: Duration::from_millis(1200),
};

/// The answer to a raw request.
fn ask(address: SocketAddr, request: &str) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let _ = stream.write_all(request.as_bytes());
    let mut answer = vec![0; 4096];
    let n = stream.read(&mut answer).unwrap_or(0);
    String::from_utf8_lossy(&answer[..n]).into_owned()
}

/// The request of a WebSocket handshake.
fn handshake(path: &str, host: &str, more: &str) -> String {
    format!(
        "GET {path} HTTP/1.1\r\nHost: {host}\r\n{more}Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
}

/// True once the server has closed a connection; what it sent before is dropped. Fails after 20 s.
fn is_closed(stream: &mut TcpStream) -> bool {
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let mut bytes = [0; 1024];
    loop {
        match stream.read(&mut bytes) {
            Ok(0) => return true,
            Ok(_) => {}
            Err(e) => return e.kind() == std::io::ErrorKind::ConnectionReset,
        }
    }
}

/// Sends a byte every 100 ms until the server closes the connection; the time that took.
fn drip(address: SocketAddr, start: &[u8], drop: u8) -> Duration {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    stream.write_all(start).unwrap();
    let begin = Instant::now();
    let mut bytes = [0; 1024];
    while begin.elapsed() < Duration::from_secs(20) {
        if stream.write_all(&[drop]).is_err() {
            break;
        }
        match stream.read(&mut bytes) {
            Ok(0) => break,
            Err(e) if e.kind() == std::io::ErrorKind::ConnectionReset => break,
            _ => {}
        }
    }
    begin.elapsed()
}

#[test]
fn a_page_without_the_token_is_refused() {
    let server = serve();
    let address = server.ports().ws.unwrap();
    let query = server.ws_link().unwrap().split_once('/').unwrap().1.split_once("/?").unwrap().1.to_owned();
    let host = address.to_string();
    let origins = [
        "null",
        "file://",
        "http://evil.test:8088",
        "http://localhost:8088",
        "http://127.0.0.1:8088",
        "https://x.test",
    ];
    for origin in origins {
        let more = format!("Origin: {origin}\r\n");
        for path in ["/", "/?token=", "/?token=00000000000000000000000000000000", "/?a=b"] {
            let answer = ask(address, &handshake(path, &host, &more));
            assert!(
                answer.starts_with("HTTP/1.1 403") && answer.contains("needs the token"),
                "{origin} {path}: {answer}"
            );
        }
        let answer = ask(address, &handshake(&format!("/?{query}"), &host, &more));
        assert!(answer.starts_with("HTTP/1.1 101"), "{origin} with the token: {answer}");
    }
    // a program is no page; key and answer are the example of RFC 6455, section 1.3
    let accepted = ask(address, &handshake("/", &host, ""));
    assert!(
        accepted.to_lowercase().contains("sec-websocket-accept: ") && accepted.contains("s3pPLMBiTxaQ9kYGzzhZRbK+xOo=")
    );
    let plain = ask(address, &format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n"));
    assert!(!plain.contains(" 101 ") && !plain.contains(" 200 "), "a request that is no handshake: {plain}");
}

#[test]
fn a_name_that_was_pointed_at_this_machine_is_refused_even_with_the_token() {
    let server = serve();
    let address = server.ports().ws.unwrap();
    let link = server.ws_link().unwrap();
    let query = link.split_once("/?").unwrap().1;
    let port = address.port();
    for host in
        [format!("evil.test:{port}"), "evil.test".into(), format!("127.0.0.1.evil.test:{port}"), "127.0.0.1".into()]
    {
        for more in [String::new(), format!("Origin: http://{host}\r\n")] {
            let answer = ask(address, &handshake(&format!("/?{query}"), &host, &more));
            assert!(answer.starts_with("HTTP/1.1 403") && answer.contains("is not this server"), "{host}: {answer}");
        }
    }
    let nameless = handshake("/", "x", "").replace("Host: x\r\n", "");
    assert!(!ask(address, &nameless).contains("101"), "a handshake without Host");
    for host in [format!("localhost:{port}"), format!("127.0.0.1:{port}")] {
        assert!(ask(address, &handshake("/", &host, "")).starts_with("HTTP/1.1 101"), "{host}");
    }
}

#[test]
fn cross_site_requests_to_the_other_ports_do_nothing() {
    let server = serve();
    let ports = server.ports().clone();
    let body = "func=sim.startSimulation";
    for address in [ports.legacy[0], ports.zmq.unwrap(), ports.zmq_steps.unwrap(), ports.ws.unwrap()] {
        for method in ["GET", "POST", "OPTIONS"] {
            let n = body.len();
            let mut stream = TcpStream::connect(address).unwrap();
            let request = format!(
                "{method} / HTTP/1.1\r\nHost: {address}\r\nOrigin: null\r\nContent-Type: text/plain\r\nContent-Length: {n}\r\n\r\n{body}"
            );
            let _ = stream.write_all(request.as_bytes());
            let _ = stream.shutdown(std::net::Shutdown::Write);
            assert!(is_closed(&mut stream), "{method} {address}");
        }
    }
    assert_eq!(server.hub().enter().n_clients(), 0);
    assert_eq!(server.hub().enter().session.phase(), sincro_coppelia::api::Phase::Stopped);
}

#[test]
fn beyond_loopback_the_ports_without_password_want_a_flag() {
    let all: IpAddr = Ipv4Addr::UNSPECIFIED.into();
    for options in [
        Options { bind: all, zmq: None, ..options() },
        Options { bind: all, legacy: Vec::new(), ..options() },
        Options { bind: all, ..options() },
    ] {
        let error = session().try_serve(&options).err().expect("it is refused");
        assert!(error.message.contains("have no password") && error.help.contains("--unauthenticated"), "{error}");
    }
    let open = session().serve(&Options { bind: all, unauthenticated: true, ..options() });
    let port = open.ports().ws.unwrap().port();
    drop(open);
    let options = Options { bind: all, legacy: Vec::new(), zmq: None, ws: Some(port), ..options() };
    let server = session().serve(&options);
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, server.ports().ws.unwrap().port()));
    let link = server.ws_link().unwrap();
    assert!(Ws::connect_to(address, &format!("ws://{address}/")).is_err(), "a program without the token");
    let mut client = Ws::connect_to(address, &link).unwrap();
    assert_eq!(client.json("sim.getSimulationState", &[])["ret"][0], 0);
}

#[test]
fn a_byte_now_and_then_puts_no_deadline_off() {
    let server = serve_with(&Options { deadlines: SHORT, ..options() });
    let ports = server.ports().clone();
    let [ws, zmq, steps, legacy] = [ports.ws.unwrap(), ports.zmq.unwrap(), ports.zmq_steps.unwrap(), ports.legacy[0]];
    let long_head = format!("GET / HTTP/1.1\r\nHost: {ws}\r\nX: ");
    let greeting = [0xff_u8, 0, 0, 0, 0, 0, 0, 0, 1, 0x7f, 3];
    let cases: [(&str, SocketAddr, &[u8], u8); 4] = [
        ("the head of a WebSocket", ws, long_head.as_bytes(), b'x'),
        ("the greeting of ZeroMQ", zmq, &greeting, 0),
        ("the greeting of a subscriber", steps, &greeting, 0),
        ("a packet of the legacy API", legacy, &[1, 0, 0xff, 0x7f, 0, 0], 0),
    ];
    std::thread::scope(|scope| {
        for (name, address, start, byte) in cases {
            scope.spawn(move || {
                let took = drip(address, start, byte);
                assert!(took < Duration::from_secs(10), "{name} was read for {took:?}");
            });
        }
        // a message over an open WebSocket: a frame of 1 MB that never ends
        scope.spawn(move || {
            let mut client = Ws::connect(ws);
            client.throw(&[0x82, 0xff, 0, 0, 0, 0, 0, 16, 0, 0, 1, 2, 3, 4]);
            let begin = Instant::now();
            while client.stream().write_all(&[0]).is_ok() && begin.elapsed() < Duration::from_secs(20) {
                std::thread::sleep(Duration::from_millis(100));
            }
            assert!(begin.elapsed() < Duration::from_secs(10));
        });
    });
    wait_until(|| server.hub().connections().is_empty());
}

#[test]
fn pings_put_off_no_deadline_of_a_message() {
    let server = serve_with(&Options { deadlines: SHORT, ..options() });
    let mut client = Ws::connect(server.ports().ws.unwrap());
    // pings alone keep a connection: it is in use
    let ping = sincro_testing::clients::ws::frame(0x89, b"");
    let begin = Instant::now();
    while begin.elapsed() < 2 * SHORT.idle {
        client.throw(&ping);
        std::thread::sleep(Duration::from_millis(100));
    }
    // a message in pieces of a byte, a ping between any two
    client.throw(&sincro_testing::clients::ws::frame(0x02, b"x"));
    let begin = Instant::now();
    let piece = [ping, sincro_testing::clients::ws::frame(0x00, b"x")].concat();
    while client.stream().write_all(&piece).is_ok() {
        assert!(begin.elapsed() < Duration::from_secs(10), "the message never ends");
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(begin.elapsed() > SHORT.read / 2, "it was open until then");
}

#[test]
fn clients_change_no_scripts_without_the_grant() {
    let script = "[[script]]\nobject = \"/joint1/link1\"\ncode = \"\"\"
        function sysCall_init() sim.setInt32Signal('begun', (sim.getInt32Signal('begun') or 0) + 1) end
        function sysCall_actuation() sim.setInt32Signal('steps', (sim.getInt32Signal('steps') or 0) + 1) end\"\"\"\n";
    let scene = format!("{}\n{script}", scenes::TWO_LINK_ARM);
    let folder = SceneFolder::of(&scene, scenes::TWO_LINK_ARM_EXPERIMENT);
    let server = folder.session(with_scripts(), None).serve(&options());
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("scripts"));
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    let (link, other) = (client.object("/link1"), client.object("/joint2"));
    let (child, text) = (Value::Int(1), Value::from("function sysCall_init() end"));
    let tries = [
        ("sim.addScript", vec![child.clone()]),
        ("sim.createScript", vec![child, text.clone()]),
        ("sim.setScriptText", vec![link.clone(), text]),
        ("sim.associateScriptWithObject", vec![link.clone(), other]),
        ("sim.associateScriptWithObject", vec![link.clone(), Value::Int(-1)]),
        ("sim.initScript", vec![link.clone()]),
        ("sim.removeScript", vec![link.clone()]),
    ];
    for (name, arguments) in &tries {
        let refused = client.call(name, arguments).expect_err(name);
        assert!(refused.contains("--grant scripts"), "{name}: {refused}");
        client.call("sim.step", &[]).unwrap();
    }
    // nor by way of the script itself
    for (name, arguments) in tries {
        let through = [vec![Value::from(name), link.clone()], arguments].concat();
        let refused = client.call("sim.callScriptFunction", &through).expect_err(name);
        assert!(refused.contains("is no function that the script"), "{name}: {refused}");
    }
    let mut signal = |name: &str| client.call("sim.getInt32Signal", &[Value::from(name)]).unwrap().remove(0);
    assert_eq!((signal("begun"), signal("steps")), (Value::Int(1), Value::Int(7)));
}

/// Waits for something that happens soon.
fn wait_until(mut holds: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !holds() {
        assert!(begin.elapsed() < Duration::from_secs(20));
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn idle_connections_are_closed_and_used_ones_are_not() {
    let server = serve_with(&Options { deadlines: SHORT, ..options() });
    let ports = server.ports().clone();
    let mut used = Zmq::connect(ports.zmq.unwrap(), Some("used"));
    let mut idle = Zmq::connect(ports.zmq.unwrap(), Some("idle"));
    used.call("sim.getSimulationTime", &[]).unwrap();
    idle.call("sim.setStepping", &[sincro_coppelia::api::Value::Bool(true)]).unwrap();
    let mut silent = TcpStream::connect(ports.legacy[0]).unwrap();
    let mut browser = Ws::connect(ports.ws.unwrap());
    let is_over = &AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(move || {
            while !is_over.load(Ordering::Relaxed) {
                used.call("sim.getSimulationTime", &[]).unwrap();
                std::thread::sleep(Duration::from_millis(100));
            }
        });
        assert!(is_closed(&mut idle.stream) && is_closed(&mut silent) && is_closed(browser.stream()));
        is_over.store(true, Ordering::Relaxed);
    });
    // with its connection the client is gone, and what it held
    wait_until(|| server.hub().enter().n_clients() == 0);
}

#[test]
fn a_subscriber_is_kept_while_it_is_sent_to() {
    let server = serve_with(&Options { deadlines: SHORT, ..options() });
    let mut listener = TcpStream::connect(server.ports().zmq_steps.unwrap()).unwrap();
    sincro_testing::clients::zmq::shake_hands(&mut listener, "SUB");
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("steps"));
    client.call("sim.setStepping", &[sincro_coppelia::api::Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    let begin = Instant::now();
    let mut told = sincro_testing::clients::zmq::frame(&mut listener).1;
    while begin.elapsed() < 3 * SHORT.idle {
        client.call("sim.step", &[]).unwrap();
        told = sincro_testing::clients::zmq::frame(&mut listener).1;
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(told[0] > 5, "{told:?}");
    client.call("sim.stopSimulation", &[]).unwrap();
    assert!(is_closed(&mut listener), "when nothing is sent any more it is closed");
}

#[test]
fn a_client_that_takes_no_answers_is_closed() {
    let server = serve_with(&Options { deadlines: SHORT, ..options() });
    let mut client = Ws::connect(server.ports().ws.unwrap());
    let request = r#"{"func":"wsRemoteApi.info","args":["sim"]}"#;
    // answers of some 20 kB, far more together than the system keeps for a connection
    let begin = Instant::now();
    while client.socket.send(tungstenite::Message::text(request)).is_ok() {
        assert!(begin.elapsed() < Duration::from_secs(20), "it was never closed");
    }
    wait_until(|| server.hub().connections().is_empty());
}

#[test]
fn connections_that_say_nothing_keep_nobody_out() {
    let server = serve();
    let ports = server.ports().clone();
    let mut good = Zmq::connect(ports.zmq.unwrap(), Some("good"));
    good.call("sim.setStepping", &[sincro_coppelia::api::Value::Bool(true)]).unwrap();
    good.call("sim.startSimulation", &[]).unwrap();
    let addresses = [ports.legacy[0], ports.ws.unwrap(), ports.zmq.unwrap()];
    let silent: Vec<TcpStream> =
        (0..2 * PER_ADDRESS).filter_map(|k| TcpStream::connect(addresses[k % 3]).ok()).collect();
    assert!(silent.len() > PER_ADDRESS);
    good.call("sim.step", &[]).unwrap();
    let mut newcomer = Zmq::connect(ports.zmq.unwrap(), Some("newcomer"));
    assert_eq!(newcomer.real("sim.getSimulationTime", &[]), 0.05);
    assert!(server.hub().connections().len() <= PER_ADDRESS);
    good.call("sim.step", &[]).unwrap();
}

/// The run of a client that steps 40 times; the trace hash.
fn stepped(server: &Server) -> String {
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("stepper"));
    client.call("sim.setStepping", &[sincro_coppelia::api::Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    let joint = client.object("/joint1");
    for k in 0..40 {
        let speed = sincro_coppelia::api::Value::Real(f64::from(k % 7) / 8.0);
        client.call("sim.setJointTargetVelocity", &[joint.clone(), speed]).unwrap();
        client.call("sim.step", &[]).unwrap();
    }
    client.call("sim.stopSimulation", &[]).unwrap();
    finished(server).simulated.trace.to_string()
}

#[test]
fn a_client_that_steps_has_the_same_trace_while_all_attacks_run() {
    let quiet = stepped(&serve());
    let server = serve_with(&Options { deadlines: SHORT, ..options() });
    let ports = server.ports().clone();
    let is_over = AtomicBool::new(false);
    let attacked = std::thread::scope(|scope| {
        let until = |attack: &dyn Fn()| {
            while !is_over.load(Ordering::Relaxed) {
                attack();
            }
        };
        let ws = ports.ws.unwrap();
        scope.spawn(move || until(&|| drop(ask(ws, &handshake("/", &ws.to_string(), "Origin: null\r\n")))));
        scope.spawn(move || {
            until(&|| drop(ask(ws, &handshake("/", "evil.test:23050", "Origin: http://evil.test\r\n"))))
        });
        for address in [ports.legacy[0], ports.zmq.unwrap(), ports.zmq_steps.unwrap()] {
            scope.spawn(move || {
                until(&|| drop(ask(address, "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\n\r\nx")))
            });
            scope.spawn(move || {
                until(&|| {
                    drip(address, &[1], 0);
                })
            });
        }
        scope.spawn(move || {
            until(&|| {
                let silent: Vec<_> = (0..40).filter_map(|_| TcpStream::connect(ws).ok()).collect();
                std::thread::sleep(Duration::from_millis(20));
                drop(silent);
            });
        });
        // another client that may enter looks on, and dies in the middle of a message
        let legacy = ports.legacy[0];
        scope.spawn(move || {
            until(&|| {
                let mut client = Legacy::connect(legacy);
                let _ = client.stream().write_all(&[1, 0, 9, 0]);
            });
        });
        let trace = stepped(&server);
        is_over.store(true, Ordering::Relaxed);
        trace
    });
    assert_eq!(attacked, quiet);
}

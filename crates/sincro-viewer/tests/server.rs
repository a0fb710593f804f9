//! The server from outside: who is let in, what is refused, and that nobody who looks changes or slows a run.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_testing::SceneFolder;
use sincro_viewer::live::{Command, Engine, LiveState, Source};
use sincro_viewer::server::{Server, ViewerContent};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

fn scene(name: &str) -> PathBuf {
    sincro_testing::repository_scene(name)
}

fn engine(name: &str) -> (Arc<LiveState>, SyncSender<Command>) {
    let source = Source {
        folder: scene(name),
        settings: Vec::new(),
        extensions: Extensions::default(),
        draw: Box::new(|_| String::new()),
        keep: Box::new(|kept| Ok(format!("kept {:?} {}", kept.duration, kept.trace))),
    };
    let engine = Engine::open(source).unwrap();
    (engine.live_state(), engine.start())
}

/// A server that ends with the test's process: where it listens, and the query with its token.
#[derive(Clone)]
struct Served {
    address: SocketAddr,
    token: String,
    single_use_url: String,
}

/// A server on loopback.
fn serve(show: ViewerContent) -> Served {
    let server = Server::bind(SocketAddr::from(([127, 0, 0, 1], 0)), show).unwrap();
    let (url, single_use_url) = (server.url(), server.single_use_url());
    std::thread::spawn(move || server.run());
    let (address, token) = url.strip_prefix("http://").unwrap().split_once("/?").unwrap();
    Served { address: address.parse().unwrap(), token: token.to_owned(), single_use_url }
}

/// The first line and the body of the answer to a raw request.
fn ask(address: SocketAddr, request: &str) -> (String, String) {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let text = String::from_utf8_lossy(&answer).into_owned();
    let status = text.lines().next().unwrap_or("").to_owned();
    (status, text.split_once("\r\n\r\n").map_or(String::new(), |(_, body)| body.to_owned()))
}

/// Asks for a path with the token.
fn get(served: &Served, path: &str, more: &str) -> (String, String) {
    let Served { address, token, .. } = served;
    ask(*address, &format!("GET {path}?{token} HTTP/1.1\r\nHost: {address}\r\n{more}Connection: close\r\n\r\n"))
}

type Line = WebSocket<MaybeTlsStream<TcpStream>>;

fn connect(served: &Served) -> Line {
    let Served { address, token, .. } = served;
    let (line, _) = tungstenite::connect(format!("ws://{address}/live?{token}")).unwrap();
    if let MaybeTlsStream::Plain(stream) = line.get_ref() {
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    }
    line
}

/// The next text of a kind.
fn next(line: &mut Line, kind: &str) -> serde_json::Value {
    loop {
        if let Message::Text(text) = line.read().unwrap() {
            let value: serde_json::Value = serde_json::from_str(&text).unwrap();
            if value["type"] == kind {
                return value;
            }
        }
    }
}

/// Waits until the present run has come to its end; its hash.
fn finish(live_state: &LiveState, run: usize) -> String {
    let begin = Instant::now();
    loop {
        let engine = live_state.read().engine.clone();
        if engine.run == run && engine.done && !engine.playing {
            return engine.trace;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "{engine:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn send(commands: &SyncSender<Command>, text: &str) {
    commands.send(Command::parse(text).unwrap()).unwrap();
}

fn hash_of(name: &str) -> String {
    let loaded = load(&scene(name), &[], Extensions::default()).unwrap();
    sincro_testing::run(&loaded).trace.to_string()
}

#[test]
fn only_this_page_is_let_in() {
    let served = serve(ViewerContent::Replay("{\"format\":\"sincro-film-2\"}".into()));
    let Served { address, token, .. } = &served;
    assert!(get(&served, "/", "").0.contains("200"));
    assert!(get(&served, "/film.json", "").1.contains("sincro-film-2"));
    assert!(get(&served, "/film.json", &format!("Origin: http://{address}\r\n")).0.contains("200"));
    for origin in ["http://evil.example", "null", "file://", "https://127.0.0.1"] {
        let (status, body) = get(&served, "/film.json", &format!("Origin: {origin}\r\n"));
        assert!(status.contains("403") && !body.contains("sincro-film"), "{origin}: {status}");
    }
    for host in [format!("evil.example:{}", address.port()), "127.0.0.1".into(), String::new()] {
        let request = format!("GET /film.json?{token} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        let (status, body) = ask(*address, &request);
        assert!(!status.contains("200") && !body.contains("sincro-film"), "{host}: {status}");
    }
}

#[test]
fn another_user_of_the_machine_lacks_the_token() {
    let served = serve(ViewerContent::Replay("{\"format\":\"sincro-film-2\"}".into()));
    for token in ["", "token=", "token=00000000000000000000000000000000", "ticket=", "ticket=0"] {
        let guessed = Served { token: token.to_owned(), ..served.clone() };
        for path in ["/", "/film.json", "/live"] {
            let (status, body) = get(&guessed, path, "");
            assert!(status.contains("403") && body.contains("lacks its token"), "{path} {token}: {status} {body}");
        }
    }
    // the page's program is the same for everybody
    assert!(get(&Served { token: String::new(), ..served.clone() }, "/viewer.js", "").0.contains("200"));
    // the link in the argument list of a browser opens the page once
    let ticket = served.single_use_url.split_once('?').unwrap().1.to_owned();
    let by_ticket = Served { token: ticket, ..served.clone() };
    let request =
        format!("GET /?{} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", by_ticket.token, served.address);
    let mut stream = TcpStream::connect(served.address).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 303") && answer.contains(&format!("/?{}", served.token)), "{answer}");
    assert!(get(&by_ticket, "/", "").0.contains("403"), "a second time");
}

#[test]
fn heads_that_do_not_come_and_silent_connections_keep_nobody_out() {
    let served = serve(ViewerContent::Replay("{}".into()));
    let silent: Vec<TcpStream> = (0..200).filter_map(|_| TcpStream::connect(served.address).ok()).collect();
    assert!(silent.len() > 100);
    assert!(get(&served, "/", "").0.contains("200"));
    let mut slow = TcpStream::connect(served.address).unwrap();
    slow.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    slow.write_all(format!("GET / HTTP/1.1\r\nHost: {}\r\nX: ", served.address).as_bytes()).unwrap();
    let (begin, mut bytes) = (Instant::now(), [0; 512]);
    // a byte now and then does not put the deadline of ten seconds off
    while slow.write_all(b"x").is_ok() && !matches!(slow.read(&mut bytes), Ok(0)) {
        assert!(begin.elapsed() < Duration::from_secs(30), "the head is still being read");
    }
    drop(silent);
}

#[test]
fn who_lacks_the_token_locks_nobody_out() {
    let served = serve(ViewerContent::Replay("{}".into()));
    let style = format!("GET /viewer.css HTTP/1.1\r\nHost: {}\r\n\r\n", served.address);
    // as many connections as one address may have, each of them kept alive by what needs no token
    let mut strangers: Vec<TcpStream> = (0..64).map(|_| TcpStream::connect(served.address).unwrap()).collect();
    for stranger in &mut strangers {
        stranger.write_all(style.as_bytes()).unwrap();
        assert!(stranger.read(&mut [0; 64]).unwrap() > 0);
    }
    for _ in 0..4 {
        assert!(get(&served, "/", "").0.contains("200"));
    }
}

#[test]
fn a_reader_that_takes_nothing_is_closed() {
    let served = serve(ViewerContent::Replay("{}".into()));
    let mut slow = TcpStream::connect(served.address).unwrap();
    slow.set_write_timeout(Some(Duration::from_secs(1))).unwrap();
    let script = format!("GET /viewer.js HTTP/1.1\r\nHost: {}\r\n\r\n", served.address);
    let begin = Instant::now();
    // it asks for far more than the system keeps for a connection, and reads a byte now and then
    slow.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    for k in 0.. {
        let asked = if k < 100 { slow.write_all(script.as_bytes()) } else { Ok(()) };
        let closed =
            |e: &std::io::Error| !matches!(e.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut);
        if asked.is_err_and(|e| closed(&e)) {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
        match slow.read(&mut [0; 1]) {
            Ok(0) => break,
            Err(e) if closed(&e) => break,
            _ => assert!(begin.elapsed() < Duration::from_secs(60), "it is still open"),
        }
        // what it has not taken is dropped with the connection; a peer that is gone is seen by what it is sent
        if slow.peer_addr().is_err() || slow.take_error().ok().flatten().is_some() {
            break;
        }
    }
}

#[test]
fn what_could_be_read_in_two_ways_is_refused() {
    let served = serve(ViewerContent::Replay("{}".into()));
    let Served { address, token, .. } = &served;
    for head in [
        format!("GET /?{token} HTTP/1.1\r\nHost: {address}\r\nHost: evil.example\r\n"),
        format!(
            "GET /?{token} HTTP/1.1\r\nHost: {address}\r\nOrigin: http://{address}\r\nOrigin: http://evil.example\r\n"
        ),
        format!("GET http://evil.example/?{token} HTTP/1.1\r\nHost: {address}\r\n"),
    ] {
        let mut stream = TcpStream::connect(address).unwrap();
        stream.write_all(format!("{head}Connection: close\r\n\r\n").as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with("HTTP/1.1 40"), "{head}: {answer}");
        let lower = answer.to_lowercase();
        assert!(!answer.starts_with("HTTP/1.1 403") || lower.contains("content-security-policy"), "{answer}");
    }
}

#[test]
fn no_path_leads_to_a_file() {
    let served = serve(ViewerContent::Replay("{}".into()));
    for path in [
        "/Cargo.toml",
        "/../Cargo.toml",
        "/%2e%2e/Cargo.toml",
        "/..%2fCargo.toml",
        "//etc/passwd",
        "/viewer.js/../../Cargo.toml",
        "/live",
    ] {
        let (status, body) = get(&served, path, "");
        assert!(!status.contains("200") && !body.contains("[package]") && !body.contains("root:"), "{path}: {status}");
    }
    assert!(ask(served.address, "POST /film.json HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").0.contains("40"));
}

#[test]
fn a_live_line_is_refused_to_other_sites() {
    let (live_state, commands) = engine("free-body");
    let Served { address, token, .. } = serve(ViewerContent::Live(live_state, commands));
    let upgrade = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n";
    let attempts = [
        (format!("/live?{token}"), "Origin: http://evil.example\r\n"),
        (format!("/live?{token}"), "Origin: null\r\n"),
        ("/live".to_owned(), ""),
    ];
    for (path, origin) in attempts {
        let request = format!("GET {path} HTTP/1.1\r\nHost: {address}\r\n{origin}{upgrade}\r\n");
        let mut stream = TcpStream::connect(address).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = [0; 12];
        stream.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"HTTP/1.1 403", "{path} {origin}");
    }
}

#[test]
fn malformed_messages_are_refused_and_the_run_goes_on() {
    let (live_state, commands) = engine("motor-step");
    let served = serve(ViewerContent::Live(live_state.clone(), commands.clone()));
    let mut line = connect(&served);
    for text in
        ["", "play", "{\"do\":\"fly\"}", "{\"do\":\"play\",\"now\":1}", "{\"do\":\"speed\",\"speed\":-1}", "[1e999]"]
    {
        line.send(Message::text(text)).unwrap();
        assert_eq!(next(&mut line, "refused")["type"], "refused", "{text}");
    }
    line.send(Message::binary(vec![0_u8; 64])).unwrap();
    next(&mut line, "refused");
    line.send(Message::text("{\"do\":\"branch\",\"run\":7,\"t\":0,\"set\":[],\"joints\":[],\"play\":false}")).unwrap();
    assert!(next(&mut line, "refused")["message"].as_str().unwrap().contains("no run 7"));
    let nonsense = r#"{"do":"branch","run":0,"t":0,"set":[["/nobody.mass","1"]],"joints":[],"play":false}"#;
    line.send(Message::text(nonsense)).unwrap();
    assert!(next(&mut line, "refused")["message"].as_str().unwrap().contains("/nobody"));
    send(&commands, r#"{"do":"speed","speed":null}"#);
    send(&commands, r#"{"do":"play"}"#);
    assert_eq!(finish(&live_state, 0), hash_of("motor-step"));
}

#[test]
fn viewers_neither_change_nor_slow_a_run() {
    let name = "two-dof-position";
    let expected = hash_of(name);
    for n_viewers in [0, 1, 5] {
        let (live_state, commands) = engine(name);
        let served = serve(ViewerContent::Live(live_state.clone(), commands.clone()));
        // one of them reads, the others stop after the handshake
        let mut lines: Vec<Line> = (0..n_viewers).map(|_| connect(&served)).collect();
        let begin = Instant::now();
        send(&commands, r#"{"do":"speed","speed":null}"#);
        send(&commands, r#"{"do":"play"}"#);
        assert_eq!(finish(&live_state, 0), expected, "{n_viewers} viewers");
        // far more than the lines of those who do not read can hold
        for k in 1..=8 * n_viewers {
            send(&commands, r#"{"do":"restart"}"#);
            send(&commands, r#"{"do":"play"}"#);
            assert_eq!(finish(&live_state, k), expected, "{n_viewers} viewers, run {k}");
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "{n_viewers} viewers");
        if let Some(line) = lines.first_mut() {
            let last = loop {
                let state = next(line, "state");
                if state["done"] == true && state["run"] == 8 * n_viewers {
                    break state;
                }
            };
            assert_eq!(last["trace"], expected.as_str());
        }
    }
}

#[test]
fn a_branch_without_a_change_is_the_same_run() {
    for name in ["two-dof-position", "quadrotor-open-loop", "flexible-position"] {
        let (live_state, commands) = engine(name);
        send(&commands, r#"{"do":"speed","speed":null}"#);
        send(&commands, r#"{"do":"play"}"#);
        let whole = finish(&live_state, 0);
        send(&commands, r#"{"do":"branch","run":0,"t":0.7,"set":[],"joints":[],"play":true}"#);
        assert_eq!(finish(&live_state, 1), whole, "{name}");
        assert!(live_state.read().runs[1].times[0] > 0.5, "{name}: it starts where the other one was");
    }
}

#[test]
fn a_changed_number_makes_another_run_and_the_first_one_stays() {
    let (live_state, commands) = engine("quadrotor-open-loop");
    send(&commands, r#"{"do":"speed","speed":null}"#);
    send(&commands, r#"{"do":"play"}"#);
    let first = finish(&live_state, 0);
    let heavier = r#"{"do":"branch","run":0,"t":2.0,"set":[["/air/quadrotor.mass","12"]],"joints":[],"play":true}"#;
    send(&commands, heavier);
    assert_ne!(finish(&live_state, 1), first);
    let content = live_state.read();
    let end = |run: usize| content.runs[run].times.len();
    assert!(end(0) > end(1) && content.runs[1].times[0] >= 1.9);
}

#[test]
fn a_saved_scene_has_the_new_numbers_and_the_old_comments() {
    let top = SceneFolder::new();
    let copy = top.join("quadrotor");
    std::fs::create_dir_all(&copy).unwrap();
    for file in std::fs::read_dir(scene("quadrotor-open-loop")).unwrap().flatten() {
        std::fs::copy(file.path(), copy.join(file.file_name())).unwrap();
    }
    let engine = Engine::open(Source {
        folder: copy,
        settings: Vec::new(),
        extensions: Extensions::default(),
        draw: Box::new(|_| String::new()),
        keep: Box::new(|kept| Ok(format!("kept {:?} {}", kept.duration, kept.trace))),
    })
    .unwrap();
    let (live_state, commands) = (engine.live_state(), engine.start());
    let mut changes = live_state.watch();
    changes.mark_unchanged();
    for set in [
        r#"[["/air/quadrotor.mass","12"]]"#,
        r#"[["/air/quadrotor.mass","12"],["duration","2"]]"#,
        r#"[["scene","x.toml"]]"#,
    ] {
        send(&commands, &format!(r#"{{"do":"save","set":{set}}}"#));
    }
    let begin = Instant::now();
    while live_state.read().last_words() < 3 {
        assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", live_state.read().words);
        std::thread::sleep(Duration::from_millis(5));
    }
    let text = std::fs::read_to_string(top.join("quadrotor-edited/scene.toml")).unwrap();
    assert!(text.contains("mass = 12 ") && text.contains("# [kg] [T]"), "{text}");
    let second = std::fs::read_to_string(top.join("quadrotor-edited-2/experiment.toml")).unwrap();
    assert!(second.contains("duration = 2 ") && second.contains("# Ts [s] [T]"), "{second}");
    assert!(!top.join("quadrotor-edited-3").exists(), "what is no number is refused");
    assert!(live_state.read().words[2].1.contains("refused"));
}

/// A signal of a run at its frames.
fn signal(live_state: &LiveState, run: usize, name: &str) -> Vec<f64> {
    let content = live_state.read();
    let log = &content.runs[run];
    let header: serde_json::Value = serde_json::from_str(&log.header).unwrap();
    let columns = header["columns"].as_array().unwrap();
    let k = columns.iter().position(|column| column[0] == name).unwrap();
    log.rows.iter().skip(k).step_by(log.n_columns).copied().collect()
}

#[test]
fn a_hand_pulls_a_body_while_it_holds_it() {
    let (live_state, commands) = engine("quadrotor-open-loop");
    send(&commands, r#"{"do":"push","object":1,"point":[0,0,0],"force":[30,0,0]}"#);
    send(&commands, r#"{"do":"step"}"#);
    send(&commands, r#"{"do":"release"}"#);
    send(&commands, r#"{"do":"step"}"#);
    send(&commands, r#"{"do":"step"}"#);
    let begin = Instant::now();
    while live_state.read().runs[0].times.len() < 4 {
        assert!(begin.elapsed() < Duration::from_secs(20));
        std::thread::sleep(Duration::from_millis(2));
    }
    // F·h/m after one step, and no more afterwards
    let v = signal(&live_state, 0, "/air.velocity.x");
    assert!((v[1] - 30.0 * 0.05 / 10.305).abs() < 1e-9, "{v:?}");
    assert!((v[3] - v[1]).abs() < 1e-9, "{v:?}");
    send(&commands, r#"{"do":"push","object":99,"point":[0,0,0],"force":[1,0,0]}"#);
    while live_state.read().last_words() == 0 {
        assert!(begin.elapsed() < Duration::from_secs(20));
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_joint_is_placed_where_the_reader_puts_it() {
    let (live_state, commands) = engine("two-dof-open-loop");
    send(&commands, r#"{"do":"branch","run":0,"t":0,"set":[],"joints":[[0,0.5]],"play":false}"#);
    let begin = Instant::now();
    while live_state.read().runs.len() < 2 || live_state.read().runs[1].times.is_empty() {
        assert!(begin.elapsed() < Duration::from_secs(20));
        std::thread::sleep(Duration::from_millis(2));
    }
    assert_eq!(signal(&live_state, 1, "/shoulder.position")[0], 0.5);
    assert_eq!(signal(&live_state, 1, "/shoulder.velocity")[0], 0.0);
}

/// The numbers of the first message of frames that has some of them.
fn next_frames(line: &mut Line) -> Vec<u8> {
    loop {
        if let Message::Binary(bytes) = line.read().unwrap() {
            return bytes.to_vec();
        }
    }
}

#[test]
fn points_of_contact_travel_with_their_frames() {
    let (live_state, commands) = engine("gripper");
    let served = serve(ViewerContent::Live(live_state, commands.clone()));
    let mut line = connect(&served);
    let run = next(&mut line, "run");
    let surfaces = run["view"]["surfaces"].as_array().unwrap().clone();
    let paths: Vec<&str> = surfaces
        .iter()
        .map(|k| run["view"]["objects"][k.as_u64().unwrap() as usize]["path"].as_str().unwrap())
        .collect();
    assert_eq!(paths, ["/left/pad", "/right/pad", "/thing/box"]);
    next_frames(&mut line);
    send(&commands, "{\"do\":\"step\"}");
    let bytes = next_frames(&mut line);
    let int = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let single = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let [kind, id, n, m, points, _]: [usize; 6] = std::array::from_fn(|k| int(4 * k));
    assert_eq!((kind, id, n, points), (2, 0, 1, 8));
    let from = bytes.len() - 4 * 8 * points;
    assert_eq!(int(from - 4), points, "how many there are in the one frame");
    assert!(bytes.len() > 24 + 8 * n * (1 + m) + 4 * n + 4 * 8 * points, "with room for the frame itself");
    // the box is pressed by 20 N from both sides, and carried
    let box_at = paths.iter().position(|path| *path == "/thing/box").unwrap();
    let mut force = [0.0; 3];
    let mut pressed = 0.0;
    for k in 0..points {
        let at = |c: usize| single(from + 4 * (8 * k + c));
        let sign = if at(0) as usize == box_at { 1.0 } else { -1.0 };
        assert!(at(0) as usize == box_at || at(1) as usize == box_at);
        assert!(at(2).abs() > 0.029 && at(4) > 0.2, "a point on a side of the box");
        (0..3).for_each(|c| force[c] += sign * at(5 + c));
        pressed += at(5).abs();
    }
    assert!(force[0].abs() < 1e-3 && (force[2] - 9.81).abs() < 1e-3, "{force:?}");
    assert!((pressed - 40.0).abs() < 1e-3, "{pressed}");
}

/// The words that the engine says next.
fn words_of(state: &LiveState, n_before: u64) -> String {
    let limit = Instant::now() + Duration::from_secs(30);
    loop {
        if let Some((_, text)) = state.read().words.iter().find(|(n, _)| *n > n_before) {
            return text.clone();
        }
        assert!(Instant::now() < limit, "the engine says nothing");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_run_is_kept_from_its_start_on_whatever_was_done_to_it() {
    let (state, sender) = engine("double-pendulum");
    sender.send(Command::Keep { run: 0 }).unwrap();
    assert!(words_of(&state, 0).contains("nothing has been simulated yet"));
    for _ in 0..3 {
        sender.send(Command::Step {}).unwrap();
    }
    sender.send(Command::Keep { run: 0 }).unwrap();
    let words = words_of(&state, 1);
    assert!(words.contains("\"saved\"") && words.contains("kept Some("), "{words}");
    let branch = Command::Branch { run: 0, t: 0.0, set: Vec::new(), joints: vec![(0, 0.3)], play: false };
    sender.send(branch).unwrap();
    sender.send(Command::Step {}).unwrap();
    sender.send(Command::Keep { run: 1 }).unwrap();
    let words = words_of(&state, 2);
    assert!(words.contains("\"saved\"") && words.contains("kept Some("), "{words}");
}

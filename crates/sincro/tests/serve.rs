//! `sincro serve` as a program: what its flags refuse and open, what it leaves on disk, and that it can be ended.

use std::fs;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use sincro_testing::scenes::ROD_PENDULUM;
use sincro_testing::{CommandLine, Exit, SceneFolder, free_port};
use tungstenite::{Message, WebSocket};

const SINCRO: CommandLine = CommandLine::new(env!("CARGO_BIN_EXE_sincro"));

const EXPERIMENT: &str = r#"
title = "A pendulum for clients"
scene = "scene.toml"
duration = 0.5
step = 0.01
record = ["/hinge.position"]
"#;

/// A script that answers clients, and one that never returns once a client asks for it.
const SCRIPT: &str = r#"
[[script]]
object = "/hinge"
max_instructions = 1000000000000
code = '''
function sysCall_init() end
function sysCall_actuation() while sim.getInt32Signal('stuck') == 1 do end end
'''
"#;

/// Folder of the pendulum; `more` is put behind its scene.
fn pendulum(more: &str) -> SceneFolder {
    SceneFolder::of(&format!("{ROD_PENDULUM}{more}"), EXPERIMENT)
}

/// The program, served on free ports, with a client that has the token.
struct Served {
    child: Child,
    client: WebSocket<TcpStream>,
}

impl Served {
    fn start(folder: &Path, more: &[&str]) -> Self {
        Self::with(folder, &[&["--no-legacy"], more].concat())
    }

    /// With the legacy API, unless it is left out.
    fn with(folder: &Path, more: &[&str]) -> Self {
        let mut child = SINCRO
            .command(&["serve", folder.to_str().unwrap(), "--no-zmq", "--ws-port", "0"])
            .args(more)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let link = loop {
            let line = lines.next().expect("it prints its link").unwrap();
            if let Some((_, link)) = line.split_once("from a web page") {
                break link.trim().to_owned();
            }
        };
        // what it prints later is read, so that it can go on
        std::thread::spawn(move || lines.for_each(drop));
        let host = link.strip_prefix("ws://").unwrap().split('/').next().unwrap().to_owned();
        let (client, _) = tungstenite::client(link, TcpStream::connect(host).unwrap()).unwrap();
        Self { child, client }
    }

    fn call(&mut self, function: &str, arguments: &str) -> String {
        self.send(function, arguments);
        self.client.read().unwrap().to_string()
    }

    fn send(&mut self, function: &str, arguments: &str) {
        let text = format!(r#"{{"func":"{function}","args":[{arguments}]}}"#);
        self.client.send(Message::text(text)).unwrap();
    }

    /// Runs of ten steps each.
    fn runs(&mut self, n: usize) {
        for _ in 0..n {
            self.call("setStepping", "true");
            self.call("sim.startSimulation", "");
            (0..10).for_each(|_| drop(self.call("step", "")));
            self.call("sim.stopSimulation", "");
        }
    }

    /// Ends the program as Ctrl-C does; its exit status and how long that took.
    fn interrupt(mut self) -> (Option<i32>, Duration) {
        let begin = Instant::now();
        let sent = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let status = self.child.wait().unwrap();
        (status.code(), begin.elapsed())
    }
}

fn size(path: &Path) -> u64 {
    if !path.is_dir() {
        return fs::metadata(path).map_or(0, |file| file.len());
    }
    fs::read_dir(path).unwrap().flatten().map(|entry| size(&entry.path())).sum()
}

fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<String> = entries.flatten().map(|e| e.file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn refused(arguments: &[&str]) -> String {
    let folder = pendulum("");
    let Exit { stderr, status, .. } = SINCRO.call(&[&["serve", folder.to_str().unwrap()], arguments].concat());
    assert_eq!(status, 2, "{arguments:?}: {stderr}");
    stderr
}

#[cfg(unix)]
#[test]
fn runs_take_as_much_disk_as_was_asked_for() {
    let folder = pendulum("");
    for (record, n_files) in [("none", 0), ("signals", 2), ("full", 4)] {
        let out = folder.join(record);
        let mut served = Served::start(&folder, &["--record", record, "--keep", "3", "--out", out.to_str().unwrap()]);
        served.runs(5);
        assert_eq!(served.interrupt().0, Some(0));
        let kept: Vec<String> = names(&out).into_iter().filter(|name| name.starts_with("run-")).collect();
        if n_files == 0 {
            assert!(!out.exists(), "{:?}", names(&out));
            continue;
        }
        assert_eq!(kept, ["run-3", "run-4", "run-5"], "{record}");
        let run = out.join("run-5");
        assert!(names(&run).len() >= n_files && run.join("run.json").is_file() && run.join("signals.csv").is_file());
        assert_eq!(run.join("report.html").is_file(), record == "full");
        // ten rows: the program that shows replays stands once beside the runs
        assert!(size(&run) < 100_000, "{record}: {} bytes, {:?}", size(&run), names(&run));
    }
    let report = fs::read_to_string(folder.join("full/run-5/report.html")).unwrap();
    assert!(report.contains("src=\"../viewer.js\"") && folder.join("full/viewer.js").is_file());
}

#[cfg(unix)]
#[test]
fn folders_that_were_there_are_left_as_they_are() {
    let folder = pendulum("");
    let (out, outside) = (folder.join("out"), folder.join("outside"));
    for path in [out.join("run-1"), outside.clone()] {
        fs::create_dir_all(path).unwrap();
    }
    fs::write(out.join("run-1/my-notes.txt"), "mine").unwrap();
    std::os::unix::fs::symlink(&outside, out.join("run-3")).unwrap();
    let mut served = Served::start(&folder, &["--record", "signals", "--keep", "1", "--out", out.to_str().unwrap()]);
    served.runs(3);
    assert_eq!(served.interrupt().0, Some(0));
    assert_eq!(names(&out), ["run-1", "run-3", "run-5"]);
    assert_eq!(names(&out.join("run-1")), ["my-notes.txt"]);
    assert!(names(&outside).is_empty());
}

#[test]
fn ports_without_password_stay_on_loopback_unless_that_is_asked_for() {
    let said = refused(&["--bind", "0.0.0.0", "--legacy-port", "0", "--zmq-port", "0", "--ws-port", "0"]);
    assert!(said.contains("have no password") && said.contains("--unauthenticated"), "{said}");
    let said = refused(&["--no-legacy", "--no-zmq", "--no-ws"]);
    assert!(said.contains("no port is left"), "{said}");
    for (flags, words) in [
        (["--keep", "0"], "expected a whole number from 1 on"),
        (["--zmq-port", "65535"], "leaves none after it"),
        (["--record", "most"], "possible values: none, signals, full"),
        (["--idle-timeout", "0"], "give seconds above 0"),
        (["--idle-timeout", "nan"], "give seconds above 0"),
        (["--client-timeout", "-1"], "-1"),
    ] {
        let said = refused(&flags);
        assert!(said.contains(words), "{flags:?}: {said}");
    }
}

#[cfg(unix)]
#[test]
fn the_first_interrupt_ends_the_server_while_a_script_does_not_return() {
    let folder = pendulum(SCRIPT);
    let out = folder.join("out");
    let mut served = Served::start(&folder, &["--out", out.to_str().unwrap()]);
    served.call("setStepping", "true");
    served.call("sim.startSimulation", "");
    served.call("step", "");
    served.call("sim.setInt32Signal", "\"stuck\",1");
    served.send("step", "");
    std::thread::sleep(Duration::from_millis(500));
    assert!(served.child.try_wait().unwrap().is_none());
    let (_, took) = served.interrupt();
    // not a measurement: without the abort it would take the hours of 10¹² instructions
    assert!(took < Duration::from_secs(60), "{took:?}");
    assert!(out.join("run-1/run.json").is_file(), "what was recorded is kept");
}

#[test]
fn a_run_that_starts_with_the_server_may_open_ports() {
    let port = free_port();
    let code =
        format!("function sysCall_init() opened = simRemoteApi.start({port}) end\nfunction told() return opened end");
    let folder = pendulum(&format!("[[frame]]\nname = \"s\"\n[[script]]\nobject = \"/s\"\ncode = '''\n{code}\n'''\n"));
    let mut served = Served::with(&folder, &["--legacy-port", "0", "--record", "none", "--start"]);
    let handle = served.call("sim.getObject", "\"/s\"");
    let handle: String = handle.chars().filter(char::is_ascii_digit).collect();
    let told = served.call("sim.callScriptFunction", &format!("\"told\",{handle}"));
    assert!(told.contains("[1]"), "{told}");
    TcpStream::connect(("127.0.0.1", port)).unwrap();
    served.child.kill().unwrap();
}

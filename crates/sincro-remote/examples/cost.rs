//! Cost of a message for the server: round trips over loopback, beside those of a server that only echoes.
//!
//! `cargo run --release -p sincro-remote --example cost [SCENE]`

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::time::Instant;

use sincro_coppelia::api::Value;
use sincro_coppelia::session::Session;
use sincro_remote::zmq::wire;
use sincro_remote::{Options, Server, cbor};
use sincro_sim::Extensions;

const N: usize = 20_000;

/// Median of the round trips of `request`, answers of `n` bytes `[µs]`.
fn round_trips(stream: &mut TcpStream, request: &[u8], n: usize) -> f64 {
    let mut answer = vec![0; n];
    let mut times: Vec<f64> = (0..N)
        .map(|_| {
            let start = Instant::now();
            stream.write_all(request).expect("the server takes it");
            stream.read_exact(&mut answer).expect("the server answers");
            start.elapsed().as_secs_f64() * 1e6
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[N / 2]
}

fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).expect("the server listens");
    stream.set_nodelay(true).expect("a socket has options");
    stream
}

/// A server that answers requests of `n` bytes with `m` bytes.
fn echo(n: usize, m: usize) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").expect("there is a free port");
    let address = listener.local_addr().expect("a listener has an address");
    std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a client connects");
        stream.set_nodelay(true).expect("a socket has options");
        let (mut request, answer) = (vec![0; n], vec![0; m]);
        while stream.read_exact(&mut request).is_ok() && stream.write_all(&answer).is_ok() {}
    });
    address
}

/// Prints the cost of a request beyond that of the sockets.
fn measure(name: &str, stream: &mut TcpStream, request: &[u8], n: usize) {
    let bare = round_trips(&mut connect(echo(request.len(), n)), request, n);
    let whole = round_trips(stream, request, n);
    println!("{name:<44} {whole:>6.1} µs, echo {bare:>6.1} µs: server {:>5.1} µs", whole - bare);
}

/// A legacy message of blocking commands: function, identification, data.
fn legacy(commands: &[(i32, Vec<i32>, Vec<f32>)]) -> Vec<u8> {
    let mut message = vec![0, 0, 11];
    message.extend([0; 15]);
    for (function, ident, data) in commands {
        let size = 26 + 4 * (ident.len() + data.len()) as i32;
        message.extend(size.to_le_bytes());
        message.extend(size.to_le_bytes());
        message.extend((4 * ident.len() as u16).to_le_bytes());
        message.extend([0; 4]);
        message.extend((function | 0x1_0000).to_le_bytes());
        message.extend([0; 8]);
        ident.iter().for_each(|x| message.extend(x.to_le_bytes()));
        data.iter().for_each(|x| message.extend(x.to_le_bytes()));
    }
    let mut packet = vec![1, 0];
    packet.extend((message.len() as i16).to_le_bytes());
    packet.extend([0, 0]);
    [packet, message].concat()
}

/// A ZeroMQ request.
fn zmq(name: &str, arguments: Vec<Value>) -> Vec<u8> {
    let fields = [("func", Value::from(name)), ("args", Value::List(arguments)), ("uuid", Value::from("cost"))];
    let mut body = Vec::new();
    cbor::encode(&Value::Map(fields.map(|(key, value)| (key.to_owned(), value)).to_vec()), &mut body);
    let mut out = vec![1, 0];
    wire::write_frame(0, &body, &mut out);
    out
}

/// Resident memory of this process, if the system tells it.
fn resident() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find_map(|l| l.strip_prefix("VmRSS:")).unwrap_or("unknown").trim().to_owned()
}

fn main() {
    let scene = std::env::args()
        .nth(1)
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes/two-dof-remote"), PathBuf::from);
    let session = Session::open(&scene, &[], Extensions::default(), None).expect("the scene is sound");
    let options = Options { legacy: vec![0], zmq: Some(0), ws: None, ..Options::default() };
    let server = Server::start(session, &options).expect("there are free ports");
    let ports = server.ports().clone();

    let mut client = connect(ports.legacy[0]);
    measure("legacy, empty message", &mut client, &legacy(&[]), 24);
    measure("legacy, simxGetJointPosition", &mut client, &legacy(&[(0x1001, vec![1], vec![])]), 24 + 34);
    round_trips_once(&mut client, &legacy(&[(0x0001, vec![], vec![]), (0x1007, vec![0], vec![])]), 24 + 56);
    let step = legacy(&[(0x1008, vec![1], vec![0.0]), (0x0003, vec![], vec![]), (0x1001, vec![1], vec![])]);
    measure("legacy, set + trigger + get, step included", &mut client, &step, 24 + 30 + 26 + 34);
    let answer = round_trips_once(&mut client, &legacy(&[(0x1007, vec![2], vec![])]), 24 + 30);
    let stopped = server.hub().enter().steps();
    assert!(stopped >= N as u64 && answer[24 + 24] == 0, "every trigger was a step: {stopped}");

    let mut client = connect(ports.zmq.expect("it was asked for"));
    client.write_all(&[&wire::greeting()[..], &wire::ready("REQ")].concat()).expect("the server takes it");
    client.read_exact(&mut [0; 64 + 27]).expect("the server shakes hands");
    measure("ZeroMQ, sim.getJointPosition", &mut client, &zmq("sim.getJointPosition", vec![Value::Int(1)]), 19);
    round_trips_once(&mut client, &zmq("sim.setStepping", vec![Value::Bool(true)]), 11);
    round_trips_once(&mut client, &zmq("sim.startSimulation", vec![]), 11);
    measure("ZeroMQ, sim.step, step included", &mut client, &zmq("sim.step", vec![]), 10);
    let before = resident();
    let start = Instant::now();
    round_trips_once(&mut client, &zmq("sim.step", vec![Value::Int(1_000_000)]), 10);
    println!(
        "10⁶ steps in one call: {:.2} s; memory {before} before, {} after",
        start.elapsed().as_secs_f64(),
        resident()
    );
}

/// Sends a request and gives its answer of `n` bytes.
fn round_trips_once(stream: &mut TcpStream, request: &[u8], n: usize) -> Vec<u8> {
    let mut answer = vec![0; n];
    stream.write_all(request).expect("the server takes it");
    stream.read_exact(&mut answer).expect("the server answers");
    answer
}

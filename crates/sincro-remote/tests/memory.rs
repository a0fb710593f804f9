//! Lengths that clients make up take no memory: every allocation of the process is counted. (A process of its own:
//! no other test allocates in it.)
#![allow(unsafe_code, reason = "an allocator that counts")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use sincro_coppelia::api::Value;
use sincro_remote::zmq::wire;
use sincro_sim::Extensions;
use sincro_testing::clients::legacy::{Client as Legacy, Command, STREAM, ints};
use sincro_testing::clients::{ws, zmq};
use sincro_testing::{options, scenes};

/// The system's allocator with the bytes in use and their maximum.
struct Counting;

static IN_USE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn add(n: usize) {
    PEAK.fetch_max(IN_USE.fetch_add(n, Ordering::SeqCst) + n, Ordering::SeqCst);
}

// SAFETY: every call goes to the system's allocator as it came
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size(), Ordering::SeqCst);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Most bytes in use at once while something is done, beyond those in use before.
fn taken(act: impl FnOnce()) -> usize {
    let before = IN_USE.load(Ordering::SeqCst);
    PEAK.store(before, Ordering::SeqCst);
    act();
    PEAK.load(Ordering::SeqCst).saturating_sub(before)
}

/// Sends bytes and waits a while for an answer or the end.
fn throw(address: SocketAddr, bytes: &[u8]) {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_millis(300))).unwrap();
    // it may be closed while we write
    let _ = stream.write_all(bytes);
    let _ = stream.read(&mut [0; 4096]);
    let _ = stream.read(&mut [0; 4096]);
}

#[test]
fn lengths_that_are_made_up_take_no_memory() {
    const KIB: usize = 1 << 10;
    let server = scenes::two_link_arm("").session(Extensions::default(), None).serve(&options());
    let ports = server.ports().clone();
    let (legacy, zmq_port, ws_port) = (ports.legacy[0], ports.zmq.unwrap(), ports.ws.unwrap());
    // what every connection takes once
    Legacy::connect(legacy).ping();
    zmq::Client::connect(zmq_port, Some("first")).call("sim.getSimulationTime", &[]).unwrap();
    ws::Client::connect(ws_port).json("sim.getSimulationTime", &[]);

    // ZeroMQ frames of 2⁶³ bytes, just above the limit, and just below it, of which one byte comes
    let hello = [&wire::greeting()[..], &wire::ready("REQ")].concat();
    for n in [u64::MAX >> 1, (16 << 20) + 1, (16 << 20) - 1] {
        let frames = [&hello[..], &[1, 0, 2], &n.to_be_bytes(), &[0]].concat();
        let bytes = taken(|| throw(zmq_port, &frames));
        assert!(bytes < 256 * KIB, "a ZeroMQ frame of {n} bytes took {bytes}");
    }

    // lists, texts and maps of many values in requests, and lists inside each other
    for head in [0x9b, 0x7b, 0x5b, 0xbb] {
        for n in [u64::MAX, 1 << 40, 1 << 30, 1 << 24] {
            let body = [&[head][..], &n.to_be_bytes()].concat();
            let bytes = taken(|| {
                let mut client = zmq::Client::connect(zmq_port, Some("b"));
                client.send_bytes(&body);
                client.receive();
                let mut client = ws::Client::connect(ws_port);
                client.send_bytes(&body);
                client.bytes();
            });
            assert!(bytes < 512 * KIB, "CBOR 0x{head:x} of {n} values took {bytes}");
        }
    }
    let bytes = taken(|| {
        let mut client = zmq::Client::connect(zmq_port, Some("c"));
        client.send_bytes(&[0x81; 5000]);
        client.receive();
        assert!(client.call("sim.getSimulationTime", &[]).is_ok(), "the connection lives on");
    });
    assert!(bytes < 512 * KIB, "nested lists took {bytes}");

    // WebSocket frames
    for n in [u64::MAX, (16 << 20) + 1, (16 << 20) - 1] {
        let frame = [&[0x82, 0xff][..], &n.to_be_bytes(), &[0; 5]].concat();
        let bytes = taken(|| {
            let mut client = ws::Client::connect(ws_port);
            client.stream().set_read_timeout(Some(Duration::from_millis(300))).unwrap();
            client.throw(&frame);
            let _ = client.stream().read(&mut [0; 4096]);
        });
        // within the limit the library reserves the frame at once; beyond it nothing
        let reserved = if n < 16 << 20 { 16 * 1024 * KIB } else { 0 };
        assert!(bytes < reserved + 512 * KIB, "a WebSocket frame of {n} bytes took {bytes}");
    }

    // legacy packets that announce thousands more, and commands whose sizes are not theirs
    let packet = [&[1, 0, 0xff, 0x7f, 0xff, 0x7f][..], &[0; 100]].concat();
    let bytes = taken(|| throw(legacy, &packet));
    assert!(bytes < 256 * KIB, "a legacy packet took {bytes}");
    for size in [i32::MAX, -1, 0] {
        let mut message = vec![0; 18];
        message.extend(
            Command { piece: Some((size, size)), ..Command::new(0x1001, STREAM, &ints(&[1]), &[0; 8]) }.bytes(),
        );
        let bytes = taken(|| {
            let mut client = Legacy::connect(legacy);
            client.send_packets(&message, 1294);
            client.receive();
        });
        assert!(bytes < 256 * KIB, "a command of {size} bytes took {bytes}");
    }
    // counts of a call of a script, and of a call by name
    let counts = ints(&[i32::MAX, i32::MAX, i32::MAX, i32::MAX]);
    let ident = [ints(&[1]), b"x\0f\0".to_vec()].concat();
    let bytes = taken(|| {
        let mut client = Legacy::connect(legacy);
        assert!(client.call(0x3401, &ident, &counts).is_err());
    });
    assert!(bytes < 256 * KIB, "counts of a call took {bytes}");
    let mut client = zmq::Client::connect(zmq_port, Some("d"));
    assert_eq!(client.call("sim.getSimulationState", &[]).unwrap(), [Value::Int(0)]);
}

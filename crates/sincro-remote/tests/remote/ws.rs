//! The WebSocket remote API.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use super::scene::serve;

fn send(stream: &mut TcpStream, code: u8, body: &[u8]) {
    let mut out = vec![0x80 | code, 0x80 | body.len() as u8, 1, 2, 3, 4];
    out.extend(body.iter().zip([1, 2, 3, 4].iter().cycle()).map(|(b, m)| b ^ m));
    stream.write_all(&out).unwrap();
}

fn receive(stream: &mut TcpStream) -> (u8, Vec<u8>) {
    let mut head = [0; 2];
    stream.read_exact(&mut head).unwrap();
    let mut long = [0; 2];
    let n = if head[1] == 126 {
        stream.read_exact(&mut long).unwrap();
        u16::from_be_bytes(long).into()
    } else {
        usize::from(head[1])
    };
    let mut body = vec![0; n];
    stream.read_exact(&mut body).unwrap();
    (head[0] & 15, body)
}

#[test]
fn a_browser_steps_the_simulation_in_json_and_cbor() {
    let server = serve("ws");
    let mut stream = TcpStream::connect(server.ports().ws.unwrap()).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let request =
        "GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    stream.write_all(request.as_bytes()).unwrap();
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        head.push(byte[0]);
    }
    assert!(String::from_utf8(head).unwrap().contains("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"));
    let mut call = |text: &str| {
        send(&mut stream, 1, text.as_bytes());
        let (code, body) = receive(&mut stream);
        assert_eq!(code, 1);
        String::from_utf8(body).unwrap()
    };
    assert_eq!(call(r#"{"func":"setStepping","args":[true],"id":7}"#), r#"{"id":7,"ret":[],"success":true}"#);
    call(r#"{"func":"sim.startSimulation"}"#);
    call(r#"{"func":"step"}"#);
    assert_eq!(call(r#"{"func":"sim.getSimulationTime","args":[]}"#), r#"{"ret":[0.05],"success":true}"#);
    assert!(call(r#"{"func":"sim.getObject","args":["/x"]}"#).contains(r#""success":false"#));
    assert!(call(r#"{"func":3}"#).contains("the request has no `func`"));
    assert!(call(r"{").contains("no JSON"));
    assert!(call(r#"{"func":"wsRemoteApi.info","args":["simOMPL"]}"#).contains("no module"));
    send(&mut stream, 2, b"\xa1\x64func\x78\x19sim.getSimulationTimeStep");
    let (code, body) = receive(&mut stream);
    assert_eq!((code, body[0] >> 5), (2, 5), "CBOR is answered in CBOR");
    send(&mut stream, 9, b"ping");
    assert_eq!(receive(&mut stream), (10, b"ping".to_vec()));
    send(&mut stream, 8, &[3, 0xe8]);
    assert_eq!(receive(&mut stream).0, 8);
    let mut byte = [0];
    assert_eq!(stream.read(&mut byte).unwrap(), 0);
}

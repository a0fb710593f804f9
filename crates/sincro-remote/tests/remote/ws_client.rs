//! A WebSocket client, in JSON and in CBOR.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use serde_json::{Value as Json, json};
use sincro_coppelia::session::Value;
use sincro_remote::cbor;

pub struct Client {
    pub stream: TcpStream,
}

impl Client {
    pub fn connect(address: SocketAddr) -> Self {
        let mut stream = TcpStream::connect(address).unwrap();
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
        Self { stream }
    }

    /// A masked frame, the last of its message.
    pub fn send(&mut self, code: u8, body: &[u8]) {
        self.stream.write_all(&frame(0x80 | code, body)).unwrap();
    }

    pub fn receive(&mut self) -> (u8, Vec<u8>) {
        let mut head = [0; 2];
        self.stream.read_exact(&mut head).unwrap();
        let mut long = [0; 8];
        let n = match head[1] {
            126 => {
                self.stream.read_exact(&mut long[6..]).unwrap();
                u64::from_be_bytes(long)
            }
            127 => {
                self.stream.read_exact(&mut long).unwrap();
                u64::from_be_bytes(long)
            }
            short => short.into(),
        };
        let mut body = vec![0; n as usize];
        self.stream.read_exact(&mut body).unwrap();
        (head[0] & 15, body)
    }

    /// A call in JSON: the whole answer.
    pub fn json(&mut self, name: &str, arguments: &[Value]) -> Json {
        let arguments: Vec<Json> = arguments.iter().map(json_of).collect();
        self.send(1, json!({ "func": name, "args": arguments }).to_string().as_bytes());
        let (code, body) = self.receive();
        assert_eq!(code, 1, "{name}");
        serde_json::from_slice(&body).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// A call in CBOR: the whole answer.
    pub fn cbor(&mut self, name: &str, arguments: &[Value]) -> Value {
        let request = [("func".to_owned(), Value::from(name)), ("args".to_owned(), Value::List(arguments.to_vec()))];
        let mut bytes = Vec::new();
        cbor::encode(&Value::Map(request.to_vec()), &mut bytes);
        self.send(2, &bytes);
        let (code, body) = self.receive();
        assert_eq!(code, 2, "{name}");
        cbor::decode(&body).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

/// A masked frame with this first byte.
pub fn frame(first: u8, body: &[u8]) -> Vec<u8> {
    let mut out = vec![first];
    match body.len() {
        n @ 0..126 => out.push(0x80 | n as u8),
        n @ 126..0x1_0000 => {
            out.push(0x80 | 126);
            out.extend((n as u16).to_be_bytes());
        }
        n => {
            out.push(0x80 | 127);
            out.extend((n as u64).to_be_bytes());
        }
    }
    out.extend([1, 2, 3, 4]);
    out.extend(body.iter().zip([1, 2, 3, 4].iter().cycle()).map(|(b, m)| b ^ m));
    out
}

/// As a browser has it: bytes are a list, what is not finite is null.
fn json_of(value: &Value) -> Json {
    match value {
        Value::Nil => Json::Null,
        Value::Bool(x) => (*x).into(),
        Value::Int(x) => (*x).into(),
        Value::Real(x) => json!(x),
        Value::Text(text) => text.as_str().into(),
        Value::Bytes(bytes) => bytes.iter().copied().map(Json::from).collect(),
        Value::List(list) => list.iter().map(json_of).collect(),
        Value::Map(map) => Json::Object(map.iter().map(|(key, value)| (key.clone(), json_of(value))).collect()),
    }
}

//! A WebSocket client, in JSON and in CBOR.

use std::io::Write;
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use serde_json::{Value as Json, json};
use sincro_coppelia::api::Value;
use sincro_remote::cbor;
use tungstenite::protocol::frame::coding::{Data, OpCode};
use tungstenite::protocol::frame::{Frame, FrameHeader};
use tungstenite::{Message, WebSocket};

/// A connection.
pub struct Client {
    /// The WebSocket.
    pub socket: WebSocket<TcpStream>,
}

impl Client {
    /// Connects without a token.
    pub fn connect(address: SocketAddr) -> Self {
        Self::connect_to(address, &format!("ws://{address}/")).unwrap()
    }

    /// Connects to an address with a link, whose host goes into the handshake.
    ///
    /// # Errors
    ///
    /// The handshake is refused.
    pub fn connect_to(address: SocketAddr, link: &str) -> Result<Self, String> {
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        let (socket, _) = tungstenite::client(link, stream).map_err(|e| e.to_string())?;
        Ok(Self { socket })
    }

    /// The stream below, for bytes that are no frames.
    pub fn stream(&mut self) -> &mut TcpStream {
        self.socket.get_mut()
    }

    /// Sends a text message.
    pub fn send_text(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    /// Sends a binary message.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        self.socket.send(Message::binary(bytes.to_vec())).unwrap();
    }

    /// Receives a text message.
    pub fn text(&mut self) -> String {
        match self.socket.read().unwrap() {
            Message::Text(text) => text.to_string(),
            other => panic!("{other:?}"),
        }
    }

    /// Receives a binary message.
    pub fn bytes(&mut self) -> Vec<u8> {
        match self.socket.read().unwrap() {
            Message::Binary(bytes) => bytes.to_vec(),
            other => panic!("{other:?}"),
        }
    }

    /// Sends bytes that need not be frames; the server may close while they are written.
    pub fn throw(&mut self, bytes: &[u8]) {
        let _ = self.stream().write_all(bytes);
    }

    /// A call in JSON: the whole answer.
    pub fn json(&mut self, name: &str, arguments: &[Value]) -> Json {
        let arguments: Vec<Json> = arguments.iter().map(json_of).collect();
        self.send_text(&json!({ "func": name, "args": arguments }).to_string());
        serde_json::from_str(&self.text()).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// A call in CBOR: the whole answer.
    pub fn cbor(&mut self, name: &str, arguments: &[Value]) -> Value {
        let request = [("func".to_owned(), Value::from(name)), ("args".to_owned(), Value::List(arguments.to_vec()))];
        let mut bytes = Vec::new();
        cbor::encode(&Value::Map(request.to_vec()), &mut bytes);
        self.send_bytes(&bytes);
        cbor::decode(&self.bytes()).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

/// A masked frame with this first byte, which need not be one that the protocol has.
pub fn frame(first: u8, body: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mask = Some([1, 2, 3, 4]);
    let header = FrameHeader { opcode: OpCode::Data(Data::Binary), mask, ..FrameHeader::default() };
    Frame::from_payload(header, body.to_vec().into()).format(&mut out).unwrap();
    out[0] = first;
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
        Value::Numbered(map) => {
            Json::Object(map.iter().map(|(key, value)| (key.to_string(), json_of(value))).collect())
        }
        Value::Map(map) => Json::Object(map.iter().map(|(key, value)| (key.clone(), json_of(value))).collect()),
    }
}

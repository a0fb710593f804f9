//! A client of the ZeroMQ remote API at the level of its wire: ZMTP and CBOR maps.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use sincro_coppelia::api::Value;
use sincro_remote::cbor;

/// A connection.
pub struct Client {
    /// The socket, for bytes that are no calls.
    pub stream: TcpStream,
    uuid: Option<String>,
}

/// Both sides' greeting and READY.
pub fn shake_hands(stream: &mut TcpStream, kind: &str) {
    stream.set_nodelay(true).unwrap();
    // only so that a test that waits for nothing ends: a call may ask for many steps, on a busy machine
    stream.set_read_timeout(Some(Duration::from_secs(300))).unwrap();
    // as libzmq 4.3.5 does it: version 3.1
    let mut greeting = [0_u8; 64];
    greeting[..12].copy_from_slice(&[0xff, 0, 0, 0, 0, 0, 0, 0, 1, 0x7f, 3, 1]);
    greeting[12..16].copy_from_slice(b"NULL");
    stream.write_all(&greeting).unwrap();
    let mut theirs = [0; 64];
    stream.read_exact(&mut theirs).unwrap();
    assert_eq!((theirs[0], theirs[9], theirs[10], &theirs[12..17]), (0xff, 0x7f, 3, &b"NULL\0"[..]));
    let mut body = b"\x05READY\x0bSocket-Type\0\0\0\x03".to_vec();
    body.extend(kind.as_bytes());
    body.extend(b"\x08Identity\0\0\0\0");
    stream.write_all(&[&[4, body.len() as u8][..], &body].concat()).unwrap();
    let (flags, ready) = frame(stream);
    assert!(flags == 4 && ready.starts_with(b"\x05READY\x0bSocket-Type"));
}

/// Flags and body of the next frame.
pub fn frame(stream: &mut TcpStream) -> (u8, Vec<u8>) {
    let mut head = [0; 2];
    stream.read_exact(&mut head[..1]).unwrap();
    let n = if head[0] & 2 == 0 {
        stream.read_exact(&mut head[1..]).unwrap();
        u64::from(head[1])
    } else {
        let mut long = [0; 8];
        stream.read_exact(&mut long).unwrap();
        u64::from_be_bytes(long)
    };
    let mut body = vec![0; n as usize];
    stream.read_exact(&mut body).unwrap();
    (head[0], body)
}

/// A map of fields.
pub fn map(fields: &[(&str, Value)]) -> Value {
    Value::Map(fields.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect())
}

/// A field of a map.
pub fn field<'a>(value: &'a Value, name: &str) -> Option<&'a Value> {
    let Value::Map(map) = value else { panic!("{value:?} is no map") };
    map.iter().find(|(key, _)| key == name).map(|(_, value)| value)
}

impl Client {
    /// Connects as a client of version 2 with a `uuid`, else of version 1.
    pub fn connect(address: SocketAddr, uuid: Option<&str>) -> Self {
        let mut stream = TcpStream::connect(address).unwrap();
        shake_hands(&mut stream, "REQ");
        Self { stream, uuid: uuid.map(str::to_owned) }
    }

    /// Sends a request with a body.
    pub fn send_bytes(&mut self, body: &[u8]) {
        let mut out = vec![1, 0];
        match u8::try_from(body.len()) {
            Ok(n) => out.extend([0, n]),
            Err(_) => {
                out.push(2);
                out.extend((body.len() as u64).to_be_bytes());
            }
        }
        out.extend(body);
        self.stream.write_all(&out).unwrap();
    }

    /// Receives an answer.
    pub fn receive(&mut self) -> Value {
        assert_eq!(frame(&mut self.stream), (1, vec![]), "an empty frame comes first");
        let (flags, body) = frame(&mut self.stream);
        assert_eq!(flags & 1, 0);
        cbor::decode(&body).unwrap()
    }

    /// Sends a call.
    pub fn send(&mut self, name: &str, args: &[Value]) {
        let mut fields = vec![("func", Value::from(name)), ("args", Value::List(args.to_vec()))];
        if let Some(uuid) = &self.uuid {
            fields.extend([
                ("argsL", Value::Int(args.len() as i64)),
                ("uuid", Value::from(uuid.as_str())),
                ("ver", Value::Int(2)),
            ]);
        }
        let mut body = Vec::new();
        cbor::encode(&map(&fields), &mut body);
        self.send_bytes(&body);
    }

    /// Calls a function; the whole answer.
    pub fn exchange(&mut self, name: &str, args: &[Value]) -> Value {
        self.send(name, args);
        self.receive()
    }

    /// Calls a function; its results.
    ///
    /// # Errors
    ///
    /// The text of the error that the server reports.
    pub fn call(&mut self, name: &str, args: &[Value]) -> Result<Vec<Value>, String> {
        let answer = self.exchange(name, args);
        let error = field(&answer, "err").or(field(&answer, "error"));
        match (field(&answer, "ret"), error) {
            (Some(Value::List(list)), None) => Ok(list.clone()),
            (None, Some(error)) => Err(error.as_text().unwrap().to_owned()),
            _ => panic!("neither result nor error: {answer:?}"),
        }
    }

    /// Calls a function whose result is one float.
    pub fn real(&mut self, name: &str, args: &[Value]) -> f64 {
        match self.call(name, args).unwrap()[..] {
            [Value::Real(x)] => x,
            ref other => panic!("{name} gave {other:?}, expected a float"),
        }
    }

    /// Handle of an object by its path.
    pub fn object(&mut self, path: &str) -> Value {
        self.call("sim.getObject", &[Value::from(path)]).unwrap().remove(0)
    }
}

//! The WebSocket remote API: for browsers. A text or binary message with JSON or CBOR (told by its first byte) `{func, args, id?}`, answered in the same
//! form with `{id?, success, ret}` or `{id?, success: false, error}`.
//!
//! Source of the framing: RFC 6455. Messages of clients are masked; pieces are put together; pings are answered.

use std::io::{self, ErrorKind, Write};
use std::sync::Arc;

use serde_json::Value as Json;
use sincro_coppelia::session::{Refusal, Value};

use crate::cbor;
use crate::hub::Hub;
use crate::limits;
use crate::listen::Connection;
use crate::zmq::{Door, Said, info};

/// Longest request that asks for the protocol.
const LONGEST_HEAD: usize = 8 << 10;
/// Added to a client's key to prove that the protocol is spoken (RFC 6455, section 1.3).
const GUID: &str = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

const TEXT: u8 = 1;
const BINARY: u8 = 2;
const CLOSE: u8 = 8;
const PING: u8 = 9;
const PONG: u8 = 10;

/// Serves one connection until it ends.
pub(crate) fn serve(mut connection: Connection, hub: &Arc<Hub>) {
    if shake_hands(&mut connection).is_err() {
        return;
    }
    let id = hub.enter().attach(&format!("ws {}", connection.peer()));
    let door = Door { hub: hub.clone(), id };
    while let Ok(Some((kind, message))) = receive(&mut connection) {
        let answer = answer(&door, &message);
        if send(connection.stream(), kind, &answer).is_err() {
            break;
        }
    }
    hub.detach(id);
}

/// Answers a message in its own form.
fn answer(door: &Door, message: &[u8]) -> Vec<u8> {
    let is_json = message.first() == Some(&b'{');
    let request = if is_json {
        serde_json::from_slice::<Json>(message).map(of_json).map_err(|e| Refusal(format!("no JSON: {e}")))
    } else {
        cbor::decode(message).map_err(|e| Refusal(format!("no CBOR: {e}")))
    };
    let mut fields = match &request {
        Ok(Value::Map(map)) => map.iter().filter(|(key, _)| key == "id").cloned().collect(),
        _ => Vec::new(),
    };
    match request.and_then(|request| call(door, &request)) {
        Ok(results) => fields.extend([("success".into(), Value::Bool(true)), ("ret".into(), Value::List(results))]),
        Err(Refusal(e)) => fields.extend([("success".into(), Value::Bool(false)), ("error".into(), Value::Text(e))]),
    }
    let answer = Value::Map(fields);
    if is_json {
        return to_json(&answer).to_string().into_bytes();
    }
    let mut out = Vec::new();
    cbor::encode(&answer, &mut out);
    out
}

fn call(door: &Door, request: &Value) -> Result<Vec<Value>, Refusal> {
    let Value::Map(fields) = request else {
        return Err(Refusal(format!("the request is {}, expected a map", request.word())));
    };
    let field = |name: &str| fields.iter().find(|(key, _)| key == name).map(|(_, value)| value);
    let name = field("func").and_then(Value::as_text).ok_or_else(|| Refusal::new("the request has no `func`"))?;
    let arguments = match field("args") {
        None | Some(Value::Nil) => &[][..],
        Some(Value::List(list)) => list,
        Some(other) => return Err(Refusal(format!("`args` is {}, expected a list", other.word()))),
    };
    let module = || arguments.first().and_then(Value::as_text).unwrap_or_default();
    match name {
        "wsRemoteApi.info" => return Ok(vec![info(module())?]),
        "wsRemoteApi.require" => return info(module()).map(|_| vec![Value::Nil]),
        "setStepping" => {
            let on = arguments.first().and_then(Value::as_bool).unwrap_or(true);
            let mut floor = door.hub.enter();
            floor.stop_stepping(door.id);
            if on {
                floor.set_stepping(door.id, true);
            }
            drop(floor);
            door.hub.wake();
            return Ok(Vec::new());
        }
        _ => {}
    }
    match door.call(name, arguments)? {
        Said::Done(results) => Ok(results),
        Said::Callback { after, .. } => Err(door.decline(after, "there are no callbacks over WebSocket")),
    }
}

fn of_json(json: Json) -> Value {
    match json {
        Json::Null => Value::Nil,
        Json::Bool(x) => Value::Bool(x),
        Json::Number(x) => x.as_i64().map_or_else(|| Value::Real(x.as_f64().unwrap_or(f64::NAN)), Value::Int),
        Json::String(text) => Value::Text(text),
        Json::Array(list) => Value::List(list.into_iter().map(of_json).collect()),
        Json::Object(map) => Value::Map(map.into_iter().map(|(key, value)| (key, of_json(value))).collect()),
    }
}

/// JSON has no bytes: they go as a list of numbers; and no NaN: it goes as null.
fn to_json(value: &Value) -> Json {
    match value {
        Value::Nil => Json::Null,
        Value::Bool(x) => (*x).into(),
        Value::Int(x) => (*x).into(),
        Value::Real(x) => serde_json::Number::from_f64(*x).map_or(Json::Null, Json::Number),
        Value::Text(text) => text.as_str().into(),
        Value::Bytes(bytes) => bytes.iter().map(|b| Json::from(*b)).collect(),
        Value::List(list) => list.iter().map(to_json).collect(),
        Value::Map(map) => Json::Object(map.iter().map(|(key, value)| (key.clone(), to_json(value))).collect()),
    }
}

/// Reads the request for the protocol, and agrees.
fn shake_hands(connection: &mut Connection) -> io::Result<()> {
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        if head.len() == LONGEST_HEAD {
            return Err(ErrorKind::InvalidData.into());
        }
        let mut byte = [0];
        connection.fill(&mut byte, head.is_empty())?;
        head.push(byte[0]);
    }
    let head = String::from_utf8_lossy(&head);
    let field = |wanted: &str| {
        let fields = head.lines().filter_map(|line| line.split_once(':'));
        fields.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(wanted)).map(|(_, value)| value.trim())
    };
    if field("origin").is_some_and(|origin| !is_friend(origin, field("host").unwrap_or_default())) {
        connection.stream().write_all(b"HTTP/1.1 403 Forbidden\r\nConnection: close\r\n\r\npage of another host\n")?;
        return Err(ErrorKind::PermissionDenied.into());
    }
    let Some(key) = field("sec-websocket-key") else {
        connection.stream().write_all(b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\nWebSocket only\n")?;
        return Err(ErrorKind::InvalidData.into());
    };
    let accept = base64(&sha1(format!("{}{GUID}", key).as_bytes()));
    let answer = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}\r\n\r\n"
    );
    connection.stream().write_all(answer.as_bytes())
}

/// Whether a page may connect: one from this machine or from the host that it connects to. Any page that a browser has open could else
/// drive the simulation behind its user's back.
fn is_friend(origin: &str, host: &str) -> bool {
    let name = |text: &str| {
        let text = text.split_once("://").map_or(text, |(_, rest)| rest);
        let end = if text.starts_with('[') { text.find(']').map(|k| k + 1) } else { text.find([':', '/']) };
        text[..end.unwrap_or(text.len())].to_owned()
    };
    let page = name(origin);
    origin == "null" || ["localhost", "127.0.0.1", "[::1]"].contains(&&*page) || page == name(host)
}

/// The next message; none when the client says goodbye.
fn receive(connection: &mut Connection) -> io::Result<Option<(u8, Vec<u8>)>> {
    let (mut message, mut kind) = (Vec::new(), None);
    loop {
        let mut head = [0; 2];
        connection.fill(&mut head, kind.is_none())?;
        let (is_last, code) = (head[0] & 0x80 != 0, head[0] & 15);
        let length = match head[1] & 0x7f {
            126 => u64::from(u16::from_be_bytes(read(connection)?)),
            127 => u64::from_be_bytes(read(connection)?),
            short => short.into(),
        };
        // clients mask; reserved bits belong to extensions that were not agreed on
        let is_valid = head[1] & 0x80 != 0 && head[0] & 0x70 == 0;
        if !is_valid || length.saturating_add(message.len() as u64) > limits::MESSAGE as u64 {
            return Err(ErrorKind::InvalidData.into());
        }
        let mask: [u8; 4] = read(connection)?;
        let mut part = Vec::new();
        connection.take(length as usize, &mut part)?;
        part.iter_mut().zip(mask.iter().cycle()).for_each(|(byte, mask)| *byte ^= mask);
        match (code, kind) {
            (CLOSE, _) => {
                send(connection.stream(), CLOSE, &part)?;
                return Ok(None);
            }
            (PING, _) => send(connection.stream(), PONG, &part)?,
            (PONG, _) => {}
            (TEXT | BINARY, None) => {
                kind = Some(code);
                message = part;
            }
            (0, Some(_)) => message.extend(part),
            _ => return Err(ErrorKind::InvalidData.into()),
        }
        if let (Some(kind), true) = (kind, is_last && code < CLOSE) {
            return Ok(Some((kind, message)));
        }
    }
}

fn read<const N: usize>(connection: &mut Connection) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    connection.fill(&mut bytes, false)?;
    Ok(bytes)
}

fn send(stream: &mut impl Write, code: u8, body: &[u8]) -> io::Result<()> {
    let mut out = vec![0x80 | code];
    match body.len() {
        n @ 0..126 => out.push(n as u8),
        n @ 126..0x1_0000 => {
            out.push(126);
            out.extend((n as u16).to_be_bytes());
        }
        n => {
            out.push(127);
            out.extend((n as u64).to_be_bytes());
        }
    }
    out.extend(body);
    stream.write_all(&out)
}

/// SHA-1 (FIPS 180-4), for the handshake only: it proves nothing but that the protocol is spoken.
fn sha1(message: &[u8]) -> [u8; 20] {
    let mut h: [u32; 5] = [0x6745_2301, 0xefcd_ab89, 0x98ba_dcfe, 0x1032_5476, 0xc3d2_e1f0];
    let mut padded = message.to_vec();
    padded.push(0x80);
    padded.resize((padded.len() + 8).div_ceil(64) * 64 - 8, 0);
    padded.extend((message.len() as u64 * 8).to_be_bytes());
    for block in padded.chunks_exact(64) {
        let mut w = [0_u32; 80];
        for (k, bytes) in block.chunks_exact(4).enumerate() {
            w[k] = u32::from_be_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        }
        for k in 16..80 {
            w[k] = (w[k - 3] ^ w[k - 8] ^ w[k - 14] ^ w[k - 16]).rotate_left(1);
        }
        let [mut a, mut b, mut c, mut d, mut e] = h;
        for (k, word) in w.into_iter().enumerate() {
            let (f, constant) = match k {
                0..20 => ((b & c) | (!b & d), 0x5a82_7999),
                20..40 => (b ^ c ^ d, 0x6ed9_eba1),
                40..60 => ((b & c) | (b & d) | (c & d), 0x8f1b_bcdc),
                _ => (b ^ c ^ d, 0xca62_c1d6_u32),
            };
            let sum = a.rotate_left(5).wrapping_add(f).wrapping_add(e).wrapping_add(constant).wrapping_add(word);
            (e, d, c, b, a) = (d, c, b.rotate_left(30), a, sum);
        }
        for (h, x) in h.iter_mut().zip([a, b, c, d, e]) {
            *h = h.wrapping_add(x);
        }
    }
    let mut out = [0; 20];
    for (k, word) in h.into_iter().enumerate() {
        out[4 * k..4 * k + 4].copy_from_slice(&word.to_be_bytes());
    }
    out
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for three in bytes.chunks(3) {
        let n = three.iter().fold(0_u32, |n, b| n << 8 | u32::from(*b)) << (8 * (3 - three.len()));
        for k in 0..4 {
            let letter = LETTERS[(n >> (18 - 6 * k)) as usize & 63] as char;
            out.push(if k <= three.len() { letter } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_handshake_of_the_standard_is_given() {
        // RFC 6455, section 1.3
        let accept = base64(&sha1(format!("dGhlIHNhbXBsZSBub25jZQ=={GUID}").as_bytes()));
        assert_eq!(accept, "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
    }

    #[test]
    fn pages_of_other_hosts_are_not_let_in() {
        assert!(is_friend("http://localhost:8000", "127.0.0.1:23050") && is_friend("null", "x"));
        assert!(is_friend("https://lab.example", "lab.example:23050") && is_friend("http://[::1]:80", "x"));
        assert!(
            !is_friend("https://evil.example", "127.0.0.1:23050") && !is_friend("http://localhost.evil.example", "x")
        );
    }

    #[test]
    fn json_and_values_are_each_others() {
        let text = r#"{"args":[1,2.5,"x",null,true],"func":"f"}"#;
        assert_eq!(to_json(&of_json(serde_json::from_str(text).unwrap())).to_string(), text);
    }
}

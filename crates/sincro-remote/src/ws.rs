//! The WebSocket remote API: for browsers. A text or binary message with JSON or CBOR (distinguished by the first byte)
//! `{func, args, id?}`, answered in the same form with `{id?, success, ret}` or `{id?, success: false, error}`.
//!
//! Handshake and framing (RFC 6455): crate `tungstenite`. Who may connect: [`sincro_access::guard`].

use std::sync::Arc;

use serde_json::Value as Json;
use sincro_access::{Guard, guard};
use sincro_coppelia::api::{ApiError, Value};
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{StatusCode, header};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Message, WebSocket, accept_hdr_with_config};

use crate::cbor;
use crate::hub::Hub;
use crate::limits;
use crate::listen::Connection;
use crate::zmq::{Endpoint, info};

/// Serves one connection until it ends.
pub(crate) fn serve(connection: Connection, hub: &Arc<Hub>, guard: &Guard) {
    let peer = connection.peer();
    let Some(mut socket) = shake_hands(connection, guard) else { return };
    let id = hub.enter().attach(&format!("ws {peer}"));
    let endpoint = Endpoint { hub: hub.clone(), id };
    while let Some(message) = receive(&mut socket) {
        if socket.send(answer(&endpoint, &message)).is_err() {
            break;
        }
    }
    hub.detach(id);
}

/// Does the handshake of the protocol with a client that may enter.
fn shake_hands(connection: Connection, guard: &Guard) -> Option<WebSocket<Connection>> {
    let config = WebSocketConfig::default()
        .max_message_size(Some(limits::MESSAGE))
        .max_frame_size(Some(limits::MESSAGE))
        .write_buffer_size(0);
    #[expect(clippy::result_large_err, reason = "the type that the handshake wants")]
    let decide = |request: &Request, response: Response| match admit(request, guard) {
        Ok(()) => Ok(response),
        Err(refused) => {
            let mut answer = ErrorResponse::new(Some(format!("{refused}\n")));
            *answer.status_mut() = StatusCode::FORBIDDEN;
            Err(answer)
        }
    };
    accept_hdr_with_config(connection, decide, Some(config)).ok()
}

fn admit(request: &Request, guard: &Guard) -> Result<(), guard::Refused> {
    let text = |name: header::HeaderName| request.headers().get(name).map(|value| value.to_str().unwrap_or("?"));
    guard.check(&guard::Request {
        host: text(header::HOST),
        origin: text(header::ORIGIN),
        query: request.uri().query(),
    })
}

/// Bytes of a masked control frame without its payload.
const CONTROL_HEAD: usize = 6;

/// The next message with content; none when the client has gone or broken the protocol. Pings are answered on the way.
fn receive(socket: &mut WebSocket<Connection>) -> Option<Message> {
    socket.get_mut().next_message();
    loop {
        match socket.read().ok()? {
            message @ (Message::Text(_) | Message::Binary(_)) => {
                socket.get_mut().end_message();
                return Some(message);
            }
            Message::Close(_) => {
                // the answer to it is queued
                let _ = socket.flush();
                return None;
            }
            Message::Ping(payload) | Message::Pong(payload) => {
                socket.flush().ok()?;
                socket.get_mut().pass_control_frame(CONTROL_HEAD + payload.len());
            }
            Message::Frame(_) => {}
        }
    }
}

/// Answers a message in its own form: a text is JSON, bytes are JSON if they begin with `{`, else CBOR.
fn answer(endpoint: &Endpoint, message: &Message) -> Message {
    let (bytes, is_text) = (message.clone().into_data(), message.is_text());
    let is_json = is_text || bytes.first() == Some(&b'{');
    let request = if is_json {
        serde_json::from_slice::<Json>(&bytes).map(of_json).map_err(|e| ApiError(format!("no JSON: {e}")))
    } else {
        cbor::decode(&bytes).map_err(|e| ApiError(format!("no CBOR: {e}")))
    };
    let mut fields = match &request {
        Ok(Value::Map(map)) => map.iter().filter(|(key, _)| key == "id").cloned().collect(),
        _ => Vec::new(),
    };
    match request.and_then(|request| call(endpoint, &request)) {
        Ok(results) => fields.extend([("success".into(), Value::Bool(true)), ("ret".into(), Value::List(results))]),
        Err(ApiError(e)) => fields.extend([("success".into(), Value::Bool(false)), ("error".into(), Value::Text(e))]),
    }
    let answer = Value::Map(fields);
    if is_text {
        return Message::text(to_json(&answer).to_string());
    }
    if is_json {
        return Message::binary(to_json(&answer).to_string());
    }
    let mut out = Vec::new();
    cbor::encode(&answer, &mut out);
    Message::binary(out)
}

fn call(endpoint: &Endpoint, request: &Value) -> Result<Vec<Value>, ApiError> {
    let Value::Map(fields) = request else {
        return Err(ApiError(format!("the request is {}, expected a map", request.word())));
    };
    let field = |name: &str| fields.iter().find(|(key, _)| key == name).map(|(_, value)| value);
    let name = field("func").and_then(Value::as_text).ok_or_else(|| ApiError::new("the request has no `func`"))?;
    let arguments = match field("args") {
        None | Some(Value::Nil) => &[][..],
        Some(Value::List(list)) => list,
        Some(other) => return Err(ApiError(format!("`args` is {}, expected a list", other.word()))),
    };
    let module = || arguments.first().and_then(Value::as_text).unwrap_or_default();
    match name {
        "wsRemoteApi.info" => return Ok(vec![info(module())?]),
        "wsRemoteApi.require" => return info(module()).map(|_| vec![Value::Nil]),
        "setStepping" => {
            let on = arguments.first().and_then(Value::as_bool).unwrap_or(true);
            let mut guard = endpoint.hub.enter();
            guard.stop_stepping(endpoint.id);
            if on {
                guard.set_stepping(endpoint.id, true);
            }
            drop(guard);
            endpoint.hub.wake();
            return Ok(Vec::new());
        }
        _ => {}
    }
    endpoint.call_without_callbacks(name, arguments, "there are no callbacks over WebSocket")
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
        Value::Numbered(map) => {
            Json::Object(map.iter().map(|(key, value)| (key.to_string(), to_json(value))).collect())
        }
        Value::Map(map) => Json::Object(map.iter().map(|(key, value)| (key.clone(), to_json(value))).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_and_values_are_each_others() {
        let text = r#"{"args":[1,2.5,"x",null,true],"func":"f"}"#;
        assert_eq!(to_json(&of_json(serde_json::from_str(text).unwrap())).to_string(), text);
    }
}

//! Requests and answers of one connection.

use std::sync::Arc;

use sincro_coppelia::api::{ApiError, Value};

use super::functions::{self, After, CallOutcome, Endpoint};
use super::steps::Publisher;
use crate::cbor;
use crate::hub::Hub;
use crate::limits;

/// Longest identity of a client.
const MAX_UUID_LEN: usize = 256;

/// One connection, and what it has not been answered yet.
pub(super) struct Conversation {
    hub: Arc<Hub>,
    publisher: Publisher,
    /// The client that the connection is of, once it has said so.
    endpoint: Option<(String, Endpoint)>,
    /// Callbacks that the client is running, the last one first: it may call while it runs one.
    callbacks: Vec<Callback>,
}

/// A callback that the client is running.
struct Callback {
    name: String,
    arguments: Vec<Value>,
    after: After,
}

/// A request, taken apart.
struct Request {
    function: String,
    arguments: Vec<Value>,
    uuid: Option<String>,
}

impl Conversation {
    pub fn new(hub: Arc<Hub>, publisher: Publisher) -> Self {
        Self { hub, publisher, endpoint: None, callbacks: Vec::new() }
    }

    /// Answers a request.
    pub fn answer(&mut self, request: &[u8]) -> Vec<u8> {
        let answer = match parse(request) {
            Ok(request) if request.uuid.is_none() => self.first_version(&request),
            Ok(request) => {
                self.second_version(&request).unwrap_or_else(|ApiError(e)| map([("err", Value::Text(line(&e)))]))
            }
            Err(ApiError(e)) => map([("err", Value::Text(line(&e)))]),
        };
        let mut out = Vec::new();
        cbor::encode(&answer, &mut out);
        out
    }

    /// The client of an identity; the connection becomes one of its.
    fn endpoint(&mut self, key: String) -> &Endpoint {
        if self.endpoint.as_ref().is_none_or(|(known, _)| *known != key) {
            self.leave();
            let id = self.hub.enter().attach(&key);
            self.endpoint = Some((key, Endpoint { hub: self.hub.clone(), id }));
        }
        &self.endpoint.as_ref().expect("it was just opened").1
    }

    fn leave(&mut self) {
        let callbacks = std::mem::take(&mut self.callbacks);
        if let Some((_, endpoint)) = self.endpoint.take() {
            for callback in callbacks {
                endpoint.decline(callback.after, "the client is gone");
            }
            self.publisher.forget(endpoint.id);
            self.hub.detach(endpoint.id);
        }
    }

    fn second_version(&mut self, request: &Request) -> Result<Value, ApiError> {
        let key = format!("zmq {}", request.uuid.as_deref().unwrap_or_default());
        match request.function.as_str() {
            "_*end*_" => {
                self.leave();
                return Ok(Value::Map(Vec::new()));
            }
            "_*executed*_" => return self.executed(&request.arguments),
            "zmqRemoteApi.require" => {
                self.endpoint(key);
                return functions::require(text(&request.arguments)?).map(ret);
            }
            "zmqRemoteApi.info" => {
                self.endpoint(key);
                return functions::info(text(&request.arguments)?).map(|info| ret(vec![info]));
            }
            _ => {}
        }
        let outcome = self.endpoint(key).call(&request.function, &request.arguments)?;
        self.reply(outcome)
    }

    fn reply(&mut self, outcome: CallOutcome) -> Result<Value, ApiError> {
        match outcome {
            CallOutcome::Done(results) => Ok(ret(results)),
            CallOutcome::Callback { name, arguments, after } => {
                if self.callbacks.len() >= limits::CALLBACKS {
                    return Err(ApiError(format!("{} callbacks have not been answered", limits::CALLBACKS)));
                }
                let answer = run(&name, &arguments);
                self.callbacks.push(Callback { name, arguments, after });
                Ok(answer)
            }
        }
    }

    /// The client has run a callback, or has waited.
    fn executed(&mut self, results: &[Value]) -> Result<Value, ApiError> {
        let (Some(Callback { name, arguments, after }), Some((_, endpoint))) = (self.callbacks.pop(), &self.endpoint)
        else {
            return Ok(ret(Vec::new()));
        };
        let outcome = endpoint.answer(&name, &arguments, after, results)?;
        self.reply(outcome)
    }

    fn first_version(&mut self, request: &Request) -> Value {
        match self.first_version_call(request) {
            Ok(results) => map([("success", Value::Bool(true)), ("ret", Value::List(results))]),
            Err(ApiError(e)) => map([("success", Value::Bool(false)), ("error", Value::Text(line(&e)))]),
        }
    }

    fn first_version_call(&mut self, request: &Request) -> Result<Vec<Value>, ApiError> {
        let given = &request.arguments;
        let uuid = |k: usize| given.get(k).and_then(Value::as_text).unwrap_or("shared").chars().take(MAX_UUID_LEN);
        let key = |k: usize| format!("zmq 1 {}", uuid(k).collect::<String>());
        match request.function.as_str() {
            "zmqRemoteApi.info" => functions::info(text(given)?).map(|info| vec![info]),
            "zmqRemoteApi.require" => functions::require(text(given)?),
            "setStepping" => {
                let on = given.first().and_then(Value::as_bool).unwrap_or(true);
                let id = self.endpoint(key(1)).id;
                let mut guard = self.hub.enter();
                guard.stop_stepping(id);
                if on {
                    guard.set_stepping(id, true);
                }
                drop(guard);
                self.hub.wake();
                Ok(Vec::new())
            }
            // answered at once: the client waits for the counter
            "step" => {
                let id = self.endpoint(key(0)).id;
                self.publisher.expect_subscriber(id);
                let mut guard = self.hub.enter();
                guard.ask_step(id);
                let advanced = guard.advance_if_ready();
                drop(guard);
                self.hub.wake();
                advanced.map(|()| Vec::new())
            }
            name => {
                let endpoint = match &self.endpoint {
                    Some((_, endpoint)) => endpoint,
                    None => self.endpoint(key(usize::MAX)),
                };
                let why = "version 1 of the client has no callbacks";
                endpoint.call_without_callbacks(name, given, why).map(|results| as_text(name, results))
            }
        }
    }
}

impl Drop for Conversation {
    fn drop(&mut self) {
        self.leave();
    }
}

/// Strings as the first version gave them: what is text arrives as text, but for images and packed numbers.
fn as_text(name: &str, mut results: Vec<Value>) -> Vec<Value> {
    let is_binary = |word: &&str| name.contains(*word);
    if ["Vision", "Image", "image", "pack", "Buffer"].iter().any(is_binary) {
        return results;
    }
    for result in &mut results {
        if let Value::Bytes(bytes) = result
            && let Ok(text) = String::from_utf8(std::mem::take(bytes)).map_err(|error| *bytes = error.into_bytes())
        {
            *result = Value::Text(text);
        }
    }
    results
}

fn parse(bytes: &[u8]) -> Result<Request, ApiError> {
    let value = cbor::decode(bytes).map_err(|e| ApiError(format!("the request cannot be read: {e}")))?;
    let Value::Map(fields) = value else {
        return Err(ApiError(format!("the request is {}, expected a map", value.word())));
    };
    let (mut function, mut arguments, mut uuid, mut count) = (None, Vec::new(), None, None);
    for (key, value) in fields {
        match (key.as_str(), value) {
            ("func", Value::Text(name)) => function = Some(name),
            ("args", Value::List(list)) => arguments = list,
            // Lua has one empty table
            ("args", Value::Map(list)) if list.is_empty() => {}
            ("args", other) => return Err(ApiError(format!("`args` is {}, expected a list", other.word()))),
            ("uuid", value) => uuid = value.as_text().filter(|text| text.len() <= MAX_UUID_LEN).map(str::to_owned),
            ("argsL", value) => count = value.as_int().and_then(|n| usize::try_from(n).ok()),
            ("eval", _) => return Err(ApiError::new("Lua text is not evaluated for clients")),
            _ => {}
        }
    }
    let nil = |value: &Value| value.as_text() == Some("_*NIL*_");
    arguments.iter_mut().filter(|value| nil(value)).for_each(|value| *value = Value::Nil);
    if let Some(count) = count.filter(|n| (arguments.len()..=arguments.len() + 64).contains(n)) {
        arguments.resize(count, Value::Nil);
    }
    let function = function.ok_or_else(|| ApiError::new("the request has no `func`"))?;
    Ok(Request { function, arguments, uuid })
}

fn text(arguments: &[Value]) -> Result<&str, ApiError> {
    arguments.first().and_then(Value::as_text).ok_or_else(|| ApiError::new("the name of a module is expected"))
}

fn map<const N: usize>(fields: [(&str, Value); N]) -> Value {
    Value::Map(fields.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

fn ret(results: Vec<Value>) -> Value {
    map([("ret", Value::List(results))])
}

fn run(name: &str, arguments: &[Value]) -> Value {
    map([("func", Value::from(name)), ("args", Value::List(arguments.to_vec()))])
}

/// Errors have one line: some clients print the marks of others raw.
fn line(message: &str) -> String {
    message.replace(['\n', '\t', '\r'], " ")
}

//! The legacy remote API (`simx…`): TCP, a strict ping-pong of messages made of commands.
//!
//! | file | has |
//! |---|---|
//! | `packet.rs` | messages cut into packets and put together |
//! | `message.rs` | headers, commands, replies |
//! | `client.rs` | operation modes: streaming, splitting, discontinuing |
//! | `commands.rs` | table of the commands: number, name, function |
//! | `functions.rs` | arguments of a call, data of its reply |
//! | `joints.rs`, `objects.rs`, `signals.rs`, `parameters.rs`, `group.rs`, `sensing.rs`, `seeing.rs`, `files.rs`, `script.rs` | functions by subject |
//!
//! Everything in a message is executed before it is answered, the trigger of a synchronous step last, and what is
//! streamed after that: values read with a trigger are those after the step.

mod client;
mod commands;
mod files;
mod functions;
mod group;
mod joints;
pub mod message;
mod objects;
pub mod packet;
mod parameters;
mod script;
mod seeing;
mod sensing;
mod signals;

use std::sync::Arc;

use crate::hub::Hub;
use crate::listen::Connection;
use client::Client;

/// Functions of the client library of the legacy API (`simx…`), each once, for the table of `docs/compatibility.md`:
/// the name, and the reason where the function is refused.
#[must_use]
pub fn functions() -> Vec<(&'static str, Option<&'static str>)> {
    let mut all: Vec<(&str, Option<&str>)> = Vec::new();
    for row in commands::COMMANDS.iter().filter(|row| row.name.starts_with("simx")) {
        let why = match row.function {
            commands::Function::Refused(why) => Some(why),
            _ => None,
        };
        if !all.iter().any(|(name, _)| *name == row.name) {
            all.push((row.name, why));
        }
    }
    all
}

/// Serves one connection until it ends.
pub(crate) fn serve(mut connection: Connection, hub: &Arc<Hub>) {
    let key = format!("legacy {}", connection.peer());
    // there is no handshake: a client may connect and say nothing for a while
    connection.next_message();
    let id = hub.enter().attach_legacy(&key, connection.local_port());
    let mut client = Client::new(hub.clone(), id);
    let (mut incoming, mut outgoing) = (Vec::new(), Vec::new());
    while packet::receive(&mut connection, &mut incoming).is_ok() {
        let Ok(goes_on) = client.answer(&incoming, &mut outgoing) else { break };
        if packet::send(&mut connection, &outgoing).is_err() || !goes_on {
            break;
        }
        connection.next_message();
    }
    hub.detach(id);
}

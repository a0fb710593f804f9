//! The ZeroMQ remote API of CoppeliaSim: one CBOR map each way, versions 2 and 1 distinguished by whether a request has
//! a `uuid`.
//!
//! | file | has |
//! |---|---|
//! | `wire.rs` | ZMTP 3.0, as far as REP and PUB need it |
//! | `rpc.rs` | requests, answers, callbacks |
//! | `functions.rs` | functions of the endpoint itself: stepping, waiting, locks, information |
//! | `moves.rs` | motions that last, with callbacks of the client |
//! | `steps.rs` | the step counter that clients of version 1 wait for |

mod functions;
mod moves;
mod rpc;
mod steps;
pub mod wire;

use std::sync::Arc;

use crate::hub::Hub;
use crate::listen::Connection;
pub use functions::present_names;
pub(crate) use functions::{Endpoint, info, kind_of};
pub(crate) use steps::Publisher;

/// Serves one connection until it ends.
pub(crate) fn serve(connection: Connection, hub: &Arc<Hub>, publisher: &Publisher) {
    let Ok(mut socket) = wire::Socket::accept(connection, "REP") else { return };
    let mut conversation = rpc::Conversation::new(hub.clone(), publisher.clone());
    while let Ok((envelope, request)) = socket.receive_request() {
        let answer = conversation.answer(&request);
        if socket.send_answer(&envelope, &answer).is_err() {
            break;
        }
    }
}

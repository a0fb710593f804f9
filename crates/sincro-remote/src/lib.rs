//! Server of the remote APIs of V-REP and CoppeliaSim: a network client is a controller of a live session.
//!
//! | port | protocol | where |
//! |---|---|---|
//! | 19997, 19999 | legacy remote API (`simx…`) | [`legacy`] |
//! | 23000, 23001 | ZeroMQ remote API, versions 2 and 1 | [`zmq`] |
//! | 23050 | WebSocket remote API, JSON or CBOR | [`ws`] |
//!
//! All of them act on one [`hub`]: a session behind a lock, and the rule for when it steps. Every connection has a
//! thread of its own that reads a message, takes the lock, does what is asked – the step included, if all that step
//! together are ready – and answers at once: a value read in the same message as a step is that after it. A connection
//! that sends what cannot be read is closed; nobody else notices.

pub mod cbor;
pub mod hub;
pub mod legacy;
pub mod limits;
mod listen;
mod server;
pub mod ws;
pub mod zmq;

pub use server::{Options, Ports, ServeError, Server};

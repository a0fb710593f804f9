//! Clients of the remote APIs at the level of their wires, one for each protocol.

pub mod legacy;
pub mod ws;
pub mod zmq;

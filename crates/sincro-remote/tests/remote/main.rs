//! Clients of every protocol against a server on loopback, ports of the system's choice. The clients are our own and
//! speak what the real ones do.

mod all_names;
mod arguments;
mod compatibility;
mod fuzz;
mod legacy;
mod many;
mod moving;
mod names;
mod page;
mod parity;
mod scene;
mod security;
mod seeing;
mod senses;
mod touching;
mod ws;
mod ws_names;
mod zmq;

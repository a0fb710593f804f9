//! Clients of every protocol against a server on loopback, ports of the system's choice. The clients are our own and speak what the real ones do.

mod all_names;
mod fuzz;
mod legacy;
mod legacy_client;
mod many;
mod parity;
mod scene;
mod touching;
mod ws;
mod zmq;
mod zmq_client;

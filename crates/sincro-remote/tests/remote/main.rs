//! Clients of every protocol against a server on loopback, ports of the system's choice. The clients are our own and speak what the real ones do.

mod fuzz;
mod legacy;
mod legacy_client;
mod parity;
mod scene;
mod ws;
mod zmq;
mod zmq_client;

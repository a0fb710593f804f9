//! The step counter: clients of version 1 wait for it after each step.

use std::io::Write;
use std::net::TcpStream;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::wire;
use crate::listen::Connection;

/// Time that a subscriber may take to take twelve bytes; then it is dropped.
const WRITE: Duration = Duration::from_millis(50);

/// Publisher of the counter of steps to its subscribers (ZeroMQ PUB).
#[derive(Clone, Debug, Default)]
pub struct Publisher(Arc<Mutex<Subscribers>>);

#[derive(Debug, Default)]
struct Subscribers {
    streams: Vec<TcpStream>,
    /// Instant of the last number that was sent.
    last: Option<Instant>,
}

impl Publisher {
    /// Sends the number of the step, 32 bits little endian.
    pub fn publish(&self, step: u64) {
        let mut frame = Vec::new();
        wire::write_frame(0, &(step as u32).to_le_bytes(), &mut frame);
        let mut all = self.lock();
        all.last = Some(Instant::now());
        all.streams.retain_mut(|stream| stream.write_all(&frame).is_ok());
    }

    /// Keeps a subscriber until it goes, or until nothing was sent either way for the idle time-out of the server.
    pub(crate) fn serve(&self, connection: Connection, idle_timeout: Duration) {
        let Ok(mut socket) = wire::Socket::accept(connection, "PUB") else { return };
        let Ok(stream) = socket.connection().try_clone_stream() else { return };
        if stream.set_write_timeout(Some(WRITE)).is_err() {
            return;
        }
        let address = stream.peer_addr().ok();
        self.lock().streams.push(stream);
        loop {
            socket.connection().end_message();
            socket.connection().next_message();
            // what it subscribes to does not matter: there is one thing only
            let is_served = || self.lock().last.is_some_and(|last| last.elapsed() < idle_timeout);
            if socket.drop_frame().is_err() && !(socket.connection().is_timed_out() && is_served()) {
                break;
            }
        }
        self.lock().streams.retain(|other| other.peer_addr().ok() != address);
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Subscribers> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

//! The step counter: clients of version 1 wait for it after each step.

use std::io::Write;
use std::net::TcpStream;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::wire;
use crate::listen::Connection;

/// How long a subscriber may take to take twelve bytes; then it is gone.
const PATIENCE: Duration = Duration::from_millis(50);

/// Everybody who listens to the counter.
#[derive(Clone, Debug, Default)]
pub struct Publisher(Arc<Mutex<Vec<TcpStream>>>);

impl Publisher {
    /// Tells the number of the step, 32 bits little endian.
    pub fn publish(&self, step: u64) {
        let mut frame = Vec::new();
        wire::write_frame(0, &(step as u32).to_le_bytes(), &mut frame);
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain_mut(|stream| stream.write_all(&frame).is_ok());
    }

    /// Keeps a subscriber until it goes.
    pub(crate) fn serve(&self, connection: Connection) {
        let Ok(mut socket) = wire::Socket::accept(connection, "PUB") else { return };
        let stream = socket.connection().stream();
        let Ok(copy) = stream.try_clone() else { return };
        if stream.set_write_timeout(Some(PATIENCE)).is_err() {
            return;
        }
        let address = stream.peer_addr().ok();
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(copy);
        // what it subscribes to does not matter: there is one thing only
        while socket.drop_frame().is_ok() {}
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|other| other.peer_addr().ok() != address);
    }
}

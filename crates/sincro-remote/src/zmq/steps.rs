//! The step counter: clients of version 1 wait for it after each step.

use std::collections::BTreeSet;
use std::io::Write;
use std::net::TcpStream;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::wire;
use crate::hub::ClientId;
use crate::listen::Connection;

/// Time that a subscriber may take to take twelve bytes; then it is dropped.
const WRITE: Duration = Duration::from_millis(50);

/// Time that the subscription of a client that steps is waited for; a client without one steps after it.
const SUBSCRIPTION: Duration = Duration::from_secs(3);

/// Publisher of the counter of steps to its subscribers (ZeroMQ PUB).
#[derive(Clone, Debug, Default)]
pub(crate) struct Publisher(Arc<(Mutex<Subscribers>, Condvar)>);

#[derive(Debug, Default)]
struct Subscribers {
    streams: Vec<TcpStream>,
    /// Clients that have asked for a step.
    stepping: BTreeSet<ClientId>,
    /// Instant of the last number that was sent.
    last: Option<Instant>,
}

impl Publisher {
    /// Sends the number of the step, 32 bits little endian.
    pub(crate) fn publish(&self, step: u64) {
        let mut frame = Vec::new();
        wire::write_frame(0, &(step as u32).to_le_bytes(), &mut frame);
        let mut all = self.lock();
        all.last = Some(Instant::now());
        all.streams.retain_mut(|stream| stream.write_all(&frame).is_ok());
    }

    /// Waits, before the first step of a client, until there are as many subscribers as clients that step: a client
    /// connects to the counter while it sends its first requests, and would miss a step that is counted before.
    pub(super) fn expect_subscriber(&self, client: ClientId) {
        let mut all = self.lock();
        if all.stepping.insert(client) {
            let is_missing = |all: &mut Subscribers| all.streams.len() < all.stepping.len();
            // if the lock is poisoned, the step goes on without
            drop(self.0.1.wait_timeout_while(all, SUBSCRIPTION, is_missing));
        }
    }

    /// Forgets a client that is gone.
    pub(super) fn forget(&self, client: ClientId) {
        self.lock().stepping.remove(&client);
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
        self.0.1.notify_all();
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
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

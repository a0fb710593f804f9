//! Limits of a client's requests. Larger ones are refused, or end the connection that sends them; memory stays bounded.

use std::time::Duration;

/// Connections at once, all protocols together: an asyncio client opens fifty of its own.
pub const CONNECTIONS: usize = 512;
/// Connections at once from one address.
pub const PER_ADDRESS: usize = 256;
/// Idle time after which a connection makes room for a newcomer when no slot is free.
pub const IDLE_UNDER_PRESSURE: Duration = Duration::from_secs(60);
/// Bytes of one message, put together.
pub const MESSAGE: usize = 16 << 20;
/// Depth to which lists and maps may be nested.
pub const DEPTH: usize = 32;
/// Commands in one message of the legacy API.
pub const COMMANDS: usize = 4_096;
/// Commands that one client of the legacy API may have repeated.
pub const STREAMS: usize = 4_096;
/// Bytes of unfinished split transfers of one client of the legacy API.
pub const SPLIT: usize = 64 << 20;
/// Steps in one call of `sim.step(n)`.
pub const STEPS: i64 = 1_000_000;
/// Callbacks of a client within each other.
pub const CALLBACKS: usize = 16;
/// Deadlines of a connection.
#[derive(Clone, Copy, Debug)]
pub struct Deadlines {
    /// From the beginning of a connection to the end of its handshake.
    pub handshake: Duration,
    /// From the first byte of a message to its last.
    pub read: Duration,
    /// From the first byte of an answer to its last: how long a client may take to take it.
    pub write: Duration,
    /// Between two messages; then the connection is closed.
    pub idle: Duration,
}

impl Default for Deadlines {
    fn default() -> Self {
        Self {
            handshake: Duration::from_secs(10),
            read: Duration::from_secs(30),
            write: Duration::from_secs(10),
            idle: Duration::from_secs(3600),
        }
    }
}
